//! `rtc render`: a scene to a picture. What was typed becomes a [`RenderSetup`] before anything is read.

mod light;
mod shot;

use super::Failure;
use super::args;
use super::findings;
use super::input::{self, Input, Proven, Provenance};
use super::interrupt::Interrupt;
use super::look::OutputLook;
use super::output::{self, Output};
use super::simd;
use super::talk::{self, Talk};
use super::turntable::{self, Turntable};
use crate::diag::Diagnostic;
use crate::image::{BackgroundFill, Layers, Lost, Origin};
use crate::ir::{Mode, Scene};
use crate::passes::{self, Framing, Overrides};
use crate::pipeline::Renderer;
use crate::plan::{self, Rule, Rules};
use crate::render::{Crop, SimdLevel};
use crate::study::Goal;
use crate::valid::Proof;
use light::FirstView;
use std::path::{Path, PathBuf};

/// A render as it will be done.
struct RenderSetup {
    output: PathBuf,
    look: OutputLook,
    overrides: Overrides,
    set: Vec<(String, String)>,
    arithmetic: plan::Arithmetic,
    crop: Option<Crop>,
    goal: Goal,
    threads: usize,
    simd: SimdLevel,
    rules: Rules,
    verify: bool,
    /// Views around the scene, if more than its own.
    turntable: Option<u32>,
    up: Option<[f64; 3]>,
    /// The studio fills in beside the light of the scene.
    is_filled: bool,
}

/// What pictures are taken of: a proven scene, and its renderer from the first picture on.
struct Subject {
    proven: Proven,
    renderer: Option<Renderer>,
}

/// Renders the scene and writes the picture.
pub(super) fn run(args: &args::Render) -> Result<(), Failure> {
    let mut plan = RenderSetup::new(args)?;
    let mut talk = Talk::beside_result(&args.talk);
    let mut input = Input::staged(&args.file, &args.reading, &args.stage)?;
    input.use_threads(plan.threads);
    input.restage(|stage| {
        stage.all_around = args.turntable.is_some();
        if args.look.background == BackgroundFill::Transparent {
            stage.ground = stage.ground.or(Some(false));
        }
    });
    let outcome = plan.carry_out(&mut input, &mut talk);
    talk.finish()?;
    outcome
}

impl RenderSetup {
    fn new(args: &args::Render) -> Result<Self, Failure> {
        let output = match &args.output {
            Some(output) => output.clone(),
            None => beside_here(&args.file, args.reading.stdin_name.as_deref())?,
        };
        if args.turntable.is_some() && output.as_os_str() == "-" {
            return Err(Failure::Trouble(
                "a turntable is many pictures; give `-o NAME-%04d.png`".to_owned(),
            ));
        }
        output::refuse_terminal(&output)?;
        let goal = Goal {
            error: args.target_error,
            time: args.time_budget,
        };
        Ok(Self {
            look: OutputLook::new(&args.look, &output)?,
            output,
            overrides: Overrides {
                size: args.size,
                supersampling: args.supersampling,
                aperture_samples: args.aperture_samples,
                light_samples: args.light_samples,
                glossy_samples: args.glossy_samples,
                depth: args.depth,
                spp: args.spp,
            },
            set: args.set.clone(),
            arithmetic: args.arithmetic.into(),
            crop: args.crop,
            goal,
            threads: args.threads.map_or(0, usize::from),
            simd: simd::level()?,
            rules: rules(&args.pruning, goal),
            verify: args.pruning.verify_effects,
            turntable: args.turntable,
            up: args.stage.up,
            is_filled: false,
        })
    }

    fn carry_out(&mut self, input: &mut Input, talk: &mut Talk) -> Result<(), Failure> {
        let (mut set, mut first, mut fitted) = (Ok(()), None, None);
        let proven = input::require(input, talk, |lowered, provenance| {
            let is_traced = matches!(lowered.scene.settings.mode, Mode::Path(_));
            first = Some(FirstView {
                camera: lowered.scene.camera.clone(),
                is_lit_asset: provenance.is_lit_asset && is_traced,
                fill: provenance.fill,
            });
            if provenance.is_asset && is_traced && !provenance.is_unlit {
                self.look.show_asset();
            }
            fitted = resize(&mut lowered.scene, self.overrides.size, provenance);
            self.overrides.apply(&mut lowered.scene);
            set = self.set.iter().try_for_each(|(name, value)| {
                passes::set(&mut lowered.scene.settings, name, value)
            });
        })?;
        set.map_err(|words| Failure::Trouble(format!("--set: {words}")))?;
        self.window(&proven.lowered.scene)?;
        let imprecise = findings::imprecise(&proven, self.arithmetic);
        imprecise
            .into_iter()
            .chain(fitted)
            .for_each(|finding| input.push(finding));
        let interrupt = Interrupt::listen()?;
        let mut subject = Subject {
            proven,
            renderer: None,
        };
        if let Some(view) = first {
            self.light(&mut subject, &view, input, &interrupt)?;
        }
        input.tell(talk)?;
        let Some(count) = self.turntable else {
            return self.shoot(&mut subject, &self.output, input, talk, &interrupt);
        };
        let table = Turntable::new(&subject.proven.lowered.scene, self.up, count);
        (0..count).try_for_each(|frame| {
            Output::open(&turntable::name(&self.output, frame), input).map(drop)
        })?;
        for frame in 0..count {
            table.turn(&mut subject.proven, frame)?;
            if let Some(renderer) = &mut subject.renderer {
                renderer.change(subject.proven.scene.clone());
            }
            self.shoot(
                &mut subject,
                &turntable::name(&self.output, frame),
                input,
                talk,
                &interrupt,
            )?;
        }
        Ok(())
    }

    /// Renders one picture and writes it.
    fn shoot(
        &self,
        subject: &mut Subject,
        path: &Path,
        input: &mut Input,
        talk: &mut Talk,
        interrupt: &Interrupt,
    ) -> Result<(), Failure> {
        let window = self.window(&subject.proven.lowered.scene)?;
        self.find_room(subject, window)?;
        let output = Output::open(path, input)?;
        let (quiet, verbose) = (talk.is_quiet(), talk.is_verbose());
        let shot = match self.goal {
            Goal {
                error: None,
                time: None,
            } => self.trace(subject, (window, input.rays()), interrupt, quiet)?,
            Goal { error: _, time: _ } => {
                self.approach(subject, (window, input.rays()), interrupt, quiet)?
            }
        };
        let shot = match shot {
            Ok(shot) => shot,
            Err(finding) => {
                input.push(*finding);
                return input.tell(talk);
            }
        };
        if self.crop.is_none() && shot.counts.hits == 0 {
            input.push(findings::nothing_in_view(&subject.proven));
            input.tell(talk)?;
        }
        let summary = shot.summary(path, &self.light_told(), verbose);
        // Where samples are clamped, and where a tone map follows, no more is seen of what is no
        // number.
        let unnumbered = shot.image.unnumbered().max(shot.counts.unnumbered);
        let mut picture = self.look.develop(
            shot.image,
            shot.coverage,
            &subject.proven.scene.settings().mode,
        );
        picture.layers = self.layers(subject, window, interrupt)?;
        let lost = self.look.lost(&picture);
        let findings = findings::unholdable(
            &Lost {
                unnumbered: lost.unnumbered.max(unnumbered),
                ..lost
            },
            self.arithmetic,
        );
        if !findings.is_empty() {
            findings.into_iter().for_each(|finding| input.push(finding));
            input.tell(talk)?;
        }
        let bytes = self
            .look
            .encode(&picture, || self.origin(&subject.proven.lowered.scene))?;
        output.commit(&bytes, interrupt)?;
        if !quiet {
            talk::say(&summary);
        }
        Ok(())
    }

    /// The part of the picture that is rendered.
    fn window(&self, scene: &Scene) -> Result<Crop, Failure> {
        let [width, height] = scene.camera.size;
        let window = self.crop.map_or(
            Crop {
                x: 0,
                y: 0,
                width,
                height,
            },
            |crop| crop.within(width, height),
        );
        if window.width == 0 || window.height == 0 {
            return Err(Failure::Trouble(format!(
                "the crop lies outside the picture of {width}×{height} pixels"
            )));
        }
        Ok(window)
    }

    /// Refuses a picture that there is no memory for.
    fn find_room(&self, subject: &mut Subject, window: Crop) -> Result<(), Failure> {
        /// A pixel of a film, with what is counted of it; and of one that grows.
        const FILM: [usize; 2] = [40, 320];
        let Crop { width, height, .. } = window;
        let pixel = FILM[usize::from(self.goal != Goal::default())] + self.look.memory();
        let bytes = (width as usize)
            .saturating_mul(height as usize)
            .saturating_mul(pixel);
        let (_, renderer) = self.renderer(subject).map_err(no_threads)?;
        if renderer.has_room(bytes) {
            return Ok(());
        }
        let size = bytes.div_ceil(1 << 20);
        let message = format!(
            "there is no memory for a picture of {width}×{height} pixels: it takes up to {size} MiB"
        );
        Err(Failure::Trouble(message))
    }

    /// The layers beside the colours.
    fn layers(
        &self,
        subject: &mut Subject,
        window: Crop,
        interrupt: &Interrupt,
    ) -> Result<Layers, Failure> {
        if self.look.aovs.is_empty() {
            return Ok(Layers::default());
        }
        let (_, renderer) = self.renderer(subject).map_err(no_threads)?;
        renderer
            .layers(&self.look.aovs, window, &|| !interrupt.is_raised())
            .ok_or(Failure::Interrupted)
    }

    /// What a scene needs for its picture.
    fn plan(&self, scene: &Proof) -> plan::Plan {
        plan::Plan::by(self.arithmetic, scene, self.rules)
    }

    /// A scene and its renderer, which is made when it is first asked for.
    fn renderer<'s>(
        &self,
        subject: &'s mut Subject,
    ) -> Result<(&'s Proven, &'s mut Renderer), rayon::ThreadPoolBuildError> {
        let Subject { proven, renderer } = subject;
        let made = match renderer.take() {
            Some(made) => made,
            None => {
                let plan = self.plan(&proven.scene);
                Renderer::at_level(&proven.scene, &plan, self.threads, self.simd)?
            }
        };
        Ok((proven, renderer.insert(made)))
    }

    /// Enough to make the same picture again: which rtc, which scene, which part of it.
    fn origin(&self, scene: &Scene) -> Origin {
        let mut settings = serde_json::json!({
            "size": scene.camera.size,
            "lens": scene.camera.lens,
            "settings": scene.settings,
            "crop": self.crop.map(|Crop { x, y, width, height }| [x, y, width, height]),
        });
        if let Some(levels) = self.goal.error {
            settings["targetError"] = levels.into();
        }
        if let Some(time) = self.goal.time {
            settings["timeBudget"] = time.as_secs_f64().into();
        }
        self.look.describe(&mut settings);
        Origin {
            software: concat!("rtc ", env!("CARGO_PKG_VERSION")).to_owned(),
            scene: input::hash(scene),
            settings: settings.to_string(),
        }
    }
}

/// The rules that may leave something out.
fn rules(args: &args::Pruning, goal: Goal) -> Rules {
    // The error that is promised counts no other one.
    let is_exact = !args.approx || goal != Goal::default();
    let all = if is_exact {
        Rules::ALL
    } else {
        Rules::ALL.with(Rule::Cut)
    };
    match args.no_prune.as_deref() {
        None => all,
        Some([]) => Rules::NONE,
        Some(named) => named.iter().fold(all, |rules, rule| rules.without(*rule)),
    }
}

/// Gives the view of an asset a picture of another size: it shows no less than before; what is to be
/// said of that. Other scenes keep their height.
fn resize(
    scene: &mut Scene,
    size: Option<[u32; 2]>,
    provenance: &Provenance,
) -> Option<Diagnostic> {
    match (size, provenance.framing) {
        (Some(_), Some(framing)) => Framing { size, ..framing }.apply(scene),
        (Some(size), None) if provenance.is_asset => {
            let before = scene.camera.size;
            scene.camera.fit(size);
            return findings::fitted(before, size);
        }
        _ => {}
    }
    None
}

fn no_threads(fault: rayon::ThreadPoolBuildError) -> Failure {
    Failure::Trouble(format!("can't start threads: {fault}"))
}

/// The name of the scene with `.png`, in the current folder.
fn beside_here(file: &Path, stdin_name: Option<&str>) -> Result<PathBuf, Failure> {
    let name = if file.as_os_str() == "-" {
        stdin_name.map(Path::new)
    } else {
        Some(file)
    };
    let stem = name.and_then(Path::file_stem);
    let stem =
        stem.ok_or_else(|| Failure::Trouble("no name for the picture; give `-o FILE`".to_owned()))?;
    Ok(PathBuf::from(stem).with_added_extension("png"))
}
