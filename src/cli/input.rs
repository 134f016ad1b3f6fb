//! The input of a command: a scene from a file or standard input, with what was found about it.

use super::Failure;
use super::args::{self, GroundArg, Reading};
use super::talk::Talk;
use crate::diag::{Diagnostic, Sink, codes};
use crate::front::{gltf, mesh, pixels};
use crate::ir::{Field, Light, Lowered, Noun, Place, Scene};
use crate::passes::{self, EnvironmentOverride, FillLight, Framing, Stage, StudioChoice, View};
use crate::pipeline::{self, Options};
use crate::source::{FileId, LoadError, Loader, Resource, SourceMap, Span};
use crate::valid::Proof;
use crate::{codec, front, valid};
use std::io;
use std::path::Path;

/// The largest picture of surroundings that is read, in bytes: one of 32-bit floats with every
/// pixel allowed.
const MAX_ENVIRONMENT: u64 = 1 << 29;

/// A scene that was read, or could not be.
pub(super) struct Input {
    /// The name of the scene in messages.
    name: String,
    map: SourceMap,
    sink: Sink,
    file: Option<FileId>,
    options: Options,
    /// Its view and light; none for a scene that is not to be shown.
    stage: Option<Stage>,
}

/// A scene that was proven, and that from which it was.
pub(super) struct Proven {
    /// The scene and where its values were written.
    pub(super) lowered: Lowered,
    /// The proof.
    pub(super) scene: Proof,
}

/// Where a scene comes from, and what was chosen for it.
pub(super) struct Provenance {
    /// It is an asset: glTF, or a mesh.
    pub(super) is_asset: bool,
    /// It is one with lights of its own, and they are not left out.
    pub(super) is_lit_asset: bool,
    /// It is one of colours that no light changes.
    pub(super) is_unlit: bool,
    /// Whether the studio is still to fill in, beside its own light.
    pub(super) fill: FillLight,
    /// How its view was found, if it has none of its own.
    pub(super) framing: Option<Framing>,
}

impl Input {
    /// Reads the file at `path`, or standard input if it is `-`.
    pub(super) fn read(path: &Path, reading: &Reading) -> Self {
        let Reading {
            stdin_name,
            strict,
            lenient,
            asset_root,
            time,
            animation,
            variant,
            camera,
            limit: _,
            allow_huge: _,
        } = reading;
        let limits = reading.limits();
        let options = Options {
            front: front::FrontOptions {
                strict: *strict,
                lenient: *lenient,
                asset_root: asset_root.clone(),
                home: std::env::home_dir(),
                time: *time,
                animation: animation.clone(),
                variant: variant.clone(),
                camera: camera.clone(),
                threads: 0,
            },
            valid: valid::ProofOptions { limits },
        };
        let (mut map, mut sink) = (SourceMap::with_limits(limits), Sink::within(&limits));
        let from_stdin = path.as_os_str() == "-";
        let name = if from_stdin {
            stdin_name.clone().unwrap_or_else(|| "<stdin>".to_owned())
        } else {
            path.display().to_string()
        };
        let read = if from_stdin {
            Loader.reader(&name, io::stdin().lock(), &mut map)
        } else {
            Loader.file(path, &mut map)
        };
        let file = read
            .map_err(|error| sink.push(unreadable(&name, &error)))
            .ok();
        Self {
            name,
            map,
            sink,
            file,
            options,
            stage: None,
        }
    }

    /// Reads the file at `path`, or standard input if it is `-`, to be shown in the view and the
    /// light given.
    pub(super) fn staged(
        path: &Path,
        reading: &Reading,
        stage: &args::StageArgs,
    ) -> Result<Self, Failure> {
        let args::StageArgs {
            eye,
            center,
            up,
            yfov,
            orbit,
            env,
            env_color,
            sun,
            no_scene_lights,
            studio,
            ground,
            integrator,
        } = stage;
        let mut input = Self::read(path, reading);
        let picture = match env {
            Some(path) => input.environment(path)?,
            None => env_color.map(EnvironmentOverride::Color),
        };
        input.stage = Some(Stage {
            view: View {
                eye: *eye,
                center: *center,
                up: *up,
                yfov: *yfov,
                orbit: *orbit,
            },
            integrator: integrator.map(Into::into),
            environment: picture,
            suns: sun.clone(),
            without_lights: *no_scene_lights,
            all_around: false,
            studio: studio.map_or_else(StudioChoice::default, Into::into),
            ground: ground.map(|ground| ground == GroundArg::On),
        });
        Ok(input)
    }

    /// Loads it with so many threads, 0 for one per core.
    pub(super) fn use_threads(&mut self, threads: usize) {
        self.options.front.threads = threads;
    }

    /// Changes how it is shown.
    pub(super) fn restage(&mut self, change: impl FnOnce(&mut Stage)) {
        self.stage.as_mut().map(change);
    }

    /// The surroundings in a file; what is wrong in it is a finding.
    fn environment(&mut self, path: &Path) -> Result<Option<EnvironmentOverride>, Failure> {
        let name = path.display().to_string();
        let bytes = Loader.bytes(path, MAX_ENVIRONMENT, &self.map);
        let bytes =
            bytes.map_err(|error| Failure::Trouble(format!("can't read `{name}`: {error}")))?;
        // Where the file lies is no part of the scene.
        let file = path.file_name().unwrap_or_default().to_string_lossy();
        let picture = pixels::environment(&file, &bytes, self.map.budget());
        Ok(picture
            .map_err(|fault| self.push(pixels::no_environment(&fault, &name)))
            .map(EnvironmentOverride::Picture)
            .ok())
    }

    /// Lowers the scene, sets the stage, lets `change` change it, and proves it.
    pub(super) fn prove(
        &mut self,
        change: impl FnOnce(&mut Lowered, &Provenance),
    ) -> Option<Proven> {
        // What a file is, is seen from all of it, and loading may release some.
        let is_asset = self.is_asset();
        let mut lowered = pipeline::load(self.file?, &mut self.map, &self.options, &mut self.sink)?;
        let mut provenance = Provenance {
            is_asset,
            is_lit_asset: is_asset && lowered.scene.lights.iter().any(Light::shines),
            is_unlit: is_asset && lowered.scene.is_unlit(),
            fill: FillLight::Never,
            framing: None,
        };
        if let Some(stage) = &self.stage {
            // An asset without a camera is seen by one that we choose.
            let camera = lowered
                .origins
                .span(Place::new(Noun::Camera, 0, Field::Whole));
            let is_bare = provenance.is_asset && camera.is_none();
            provenance.is_lit_asset &= !stage.without_lights;
            if let Some(staged) = pipeline::stage(&mut lowered, stage, is_bare, &mut self.sink) {
                // A scene that says how it is lit is shown as it says.
                let is_meant = staged.fill == FillLight::IfDim && !provenance.is_asset;
                provenance.fill = if is_meant {
                    FillLight::Never
                } else {
                    staged.fill
                };
                provenance.framing = staged.framing;
            }
        }
        change(&mut lowered, &provenance);
        let scene = pipeline::prove(&lowered, &self.options, &mut self.sink)?;
        Some(Proven { lowered, scene })
    }

    /// Whether the input is an asset by itself, glTF or a mesh.
    fn is_asset(&self) -> bool {
        let recognise = |file| {
            let (name, bytes) = (self.map.name(file), self.map.bytes(file));
            gltf::recognise(name, bytes) || mesh::recognise(name, bytes)
        };
        self.file.is_some_and(recognise)
    }

    /// Tells what was found since the last time, and whether the input is fit for use.
    pub(super) fn tell(&mut self, talk: &mut Talk) -> Result<(), Failure> {
        let sink = std::mem::replace(&mut self.sink, Sink::within(&self.options.valid.limits));
        let verdict = match self.file {
            None => Err(Failure::Unreadable),
            Some(_) if sink.has_errors() => Err(Failure::Findings),
            Some(_) => Ok(()),
        };
        talk.file(&self.name, sink, &self.map)?;
        verdict
    }

    /// Adds a finding.
    pub(super) fn push(&mut self, diagnostic: Diagnostic) {
        self.sink.push(diagnostic);
    }

    /// How many rays a picture may take.
    pub(super) fn rays(&self) -> u64 {
        self.options.valid.limits.of(Resource::Rays, 0)
    }

    /// Lets pictures take any number of rays.
    pub(super) fn lift_rays(&mut self) {
        self.options.valid.limits.set(Resource::Rays, u64::MAX);
    }

    /// The file and the line at which a span begins.
    pub(super) fn line(&self, span: Span) -> (&str, u32) {
        (
            self.map.name(span.file),
            self.map.line_column(span.file, span.start).line,
        )
    }

    /// Whether the file at a path was read: the scene, or what it names.
    pub(super) fn has_read(&self, path: &Path) -> bool {
        self.map.has_read(path)
    }

    /// The name of the scene in messages.
    pub(super) fn name(&self) -> &str {
        &self.name
    }
}

/// Proves a scene for a command that needs it, and tells what was found.
pub(super) fn require(
    input: &mut Input,
    talk: &mut Talk,
    change: impl FnOnce(&mut Lowered, &Provenance),
) -> Result<Proven, Failure> {
    let proven = input.prove(change);
    input.tell(talk)?;
    Ok(proven.expect("what is refused has an error in the sink, and `tell` has returned it"))
}

/// Lets the studio fill in beside the light of a scene if that is asked for, for commands that do not
/// look what its own light shows.
pub(super) fn fill(lowered: &mut Lowered, provenance: &Provenance) {
    if provenance.fill == FillLight::Always {
        passes::fill(&mut lowered.scene, 0.0);
    }
}

/// The hash of a proven scene's IR, by which a picture or a report says what it is of.
pub(super) fn hash(scene: &Scene) -> String {
    let hash = codec::hash(scene).expect("a proven scene holds finite numbers only");
    format!("xxh3:{hash:032x}")
}

fn unreadable(name: &str, error: &LoadError) -> Diagnostic {
    match error {
        LoadError::Io(error) => {
            Diagnostic::new(&codes::CANNOT_READ, format!("can't read `{name}`: {error}"))
        }
        LoadError::TooLarge { limit } => {
            let limit = limit >> 20;
            Diagnostic::new(
                &codes::TOO_LARGE,
                format!("`{name}` is larger than {limit} MiB"),
            )
        }
    }
}
