//! One case rendered as `rtc render` does it: read, put under its light, proven, planned, rendered,
//! developed, encoded.

use super::options::Options;
use libtest_mimic::Failed;
use rtc::internals::color::Tone;
use rtc::internals::diag::DiagnosticSink;
use rtc::internals::front::pixels;
use rtc::internals::image::{
    AlphaAssociation, BackgroundFill, DisplayTransform, FileFormat, Image, Picture, PixelLayers,
};
use rtc::internals::ir::LoweredScene;
use rtc::internals::passes::{EnvironmentOverride, SceneKind, ViewAndLight};
use rtc::internals::pipeline::{self, Renderer};
use rtc::internals::plan::{Plan, RuleSet};
use rtc::internals::render::{AnyWorld, Aov, Background, RenderSelection, Values};
use rtc::internals::source::{Loader, SourceMap};
use rtc::internals::valid::{Mode, ValidScene};
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

/// A picture as a file, and how many levels another one may be off it.
pub(super) struct Shot {
    pub(super) png: Vec<u8>,
    pub(super) tolerance: u8,
}

pub(super) fn shoot(case: &Path) -> Result<Shot, Failed> {
    let mut options = Options::read(case)?;
    let scene = validate(case, &mut options)?;
    let plan = Plan::with_arithmetic(options.arithmetic, &scene, RuleSet::ALL);
    let renderer = Renderer::new(&scene, &plan, options.threads)?;
    let picture = match options.aov {
        Some((aov, range)) => layer(&renderer, &scene, aov, range),
        None => colors(&renderer, &scene, &options),
    };
    Ok(Shot {
        png: picture
            .encode(FileFormat::Png8)
            .map_err(|error| error.to_string())?,
        tolerance: match scene.settings().mode {
            Mode::Path(_) => 1,
            Mode::Phong | Mode::Depth | Mode::Normal | Mode::Gooch(_) => 0,
        },
    })
}

/// The proven scene of a case, in which no more is found than it says.
fn validate(case: &Path, options: &mut Options) -> Result<ValidScene, Failed> {
    let (mut map, mut sink) = (SourceMap::default(), DiagnosticSink::default());
    let file = Loader.file(case, &mut map).map_err(|e| format!("{e:?}"))?;
    let reading = pipeline::Options {
        front: options.front.clone(),
        ..pipeline::Options::default()
    };
    let lowered = pipeline::load(file, &mut map, &reading, &mut sink);
    let validated = lowered.map(|mut lowered| -> Result<_, Failed> {
        stage(&mut lowered, case, options, &map, &mut sink)?;
        options.overrides.apply(&mut lowered.scene);
        if let Some(color) = lowered.scene.settings.background {
            options.background = BackgroundFill::Color(color);
        }
        Ok(pipeline::validate(&lowered, &reading, &mut sink))
    });
    let validated = validated.transpose()?.flatten();
    let codes = sink.kept().iter().map(|finding| finding.code.id.to_owned());
    let codes: BTreeSet<_> = codes.collect();
    match validated {
        Some(scene) if codes == options.finds.iter().cloned().collect() => Ok(scene),
        _ => {
            let found = sink.kept().iter();
            let found: Vec<_> = found
                .map(|finding| format!("{}: {}", finding.code, finding.message))
                .collect();
            Err(format!("found in it: {}", found.join("\n")).into())
        }
    }
}

/// Puts a scene into the light of its options; one without light comes into the studio.
fn stage(
    lowered: &mut LoweredScene,
    case: &Path,
    options: &Options,
    map: &SourceMap,
    sink: &mut DiagnosticSink,
) -> Result<(), Failed> {
    let mut environment = options.env_color.map(EnvironmentOverride::Color);
    if let Some(name) = &options.env {
        let bytes = fs::read(case.with_file_name(name))?;
        let image = pixels::environment(name, &bytes, map.budget())
            .map_err(|fault| pixels::environment_rejection(&fault, name).message)?;
        environment = Some(EnvironmentOverride::Picture(image));
    }
    let stage = ViewAndLight {
        view: options.view,
        integrator: options.integrator,
        environment,
        suns: options.suns.clone(),
        without_lights: false,
        ..ViewAndLight::default()
    };
    let is_asset = |own| own == "gltf" || own == "glb";
    let kind = match case.extension().is_some_and(is_asset) {
        true => SceneKind::Asset,
        false => SceneKind::Text,
    };
    pipeline::stage(lowered, &stage, kind, sink);
    Ok(())
}

fn colors(renderer: &Renderer, scene: &ValidScene, options: &Options) -> Picture {
    let mode = &scene.settings().mode;
    let tone = options.tone.unwrap_or(mode.tone());
    let is_plain = options.stops == 0.0 && options.tone.unwrap_or(Tone::None) == Tone::None;
    let job = RenderSelection {
        values: if is_plain && mode.tone() == Tone::None {
            Values::Display
        } else {
            Values::Linear
        },
        background: if options.background == BackgroundFill::Film {
            Background::Environment
        } else {
            Background::Nothing
        },
        ..RenderSelection::default()
    };
    let film = match *mode {
        Mode::Path(path) if options.denoise => {
            let world = AnyWorld::prepare(scene, &Plan::new(scene, RuleSet::ALL));
            let picture = world.denoised(path.samples.get(), &job, &|_| true, &|| ());
            picture.unwrap().film
        }
        Mode::Path(_) | Mode::Phong | Mode::Depth | Mode::Normal | Mode::Gooch(_) => {
            renderer.render(&job, &|_| true).unwrap()
        }
    };
    let look = DisplayTransform {
        stops: options.stops,
        tone,
        background: options.background,
    };
    look.develop(film.image, film.coverage, AlphaAssociation::Straight)
}

/// A layer as colours: its values from the first of a range, black, to the last, white.
fn layer(renderer: &Renderer, scene: &ValidScene, aov: Aov, [low, high]: [f64; 2]) -> Picture {
    let camera = scene.camera();
    let (width, height) = (camera.width.get(), camera.height.get());
    let PixelLayers { names, values } = renderer
        .layers(&[aov], &RenderSelection::default(), &|| true)
        .unwrap();
    assert_eq!(names, aov.channels());
    let shade = |value: &f32| ((f64::from(*value) - low) / (high - low)).clamp(0.0, 1.0);
    let color = |values: &[f32]| match values {
        [x] => [shade(x); 3],
        [u, v] => [shade(u), shade(v), 0.0],
        [x, y, z] => [shade(x), shade(y), shade(z)],
        _ => unreachable!("a layer has at most three channels"),
    };
    Picture::opaque(Image {
        width,
        height,
        pixels: values.chunks_exact(names.len()).map(color).collect(),
    })
}
