//! The doors the stages are joined by: bytes to scene, scene to proof, proof to film. Nothing here
//! prints or exits.

mod denoise;
mod exposure;
#[cfg(not(target_family = "wasm"))]
mod file;
mod findings;
mod fix;
mod goal;
mod input;
mod layer;
mod layout;
mod light;
mod look;
mod meter;
mod part;
mod setup;
mod share;
mod strips;
pub mod trial;

pub use denoise::Traced;
pub use exposure::OwnLight;
#[cfg(not(target_family = "wasm"))]
pub use file::{NewFile, NewFolder, WriteObserver};
pub use fix::{DiagnosticRef, FixFilter, FixedText, complaint, fix};
pub use input::{Input, Loaded, Proven, Provenance};
pub use layout::{LaidOutFault, SourceKind};
pub use look::{Exposure, OutputTransform, ResolvedOutputTransform};
pub use meter::RayCounter;
pub use part::{MOST as MOST_SHARES, PartError, PicturePart, hash_of_file};
pub use setup::{Observer, PictureSetup, RenderError, RenderSubject};
pub use share::{ShardPlan, SharedBy};

use rayon::{ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder};
use rtc_codec as codec;
use rtc_diag::{Diagnostic, FindingLevels, Sink, clip, codes};
use rtc_front as front;
use rtc_front::course::assets::{self, AssetTarget};
use rtc_front::{course, gltf, mesh, mitsuba};
use rtc_image::Layers;
use rtc_ir::{EntityKind, Field, Lowered, Scene, SourceSpans, ValuePath};
use rtc_math::BasisFault;
use rtc_passes::{AppliedViewAndLight, SceneKind, ViewAndLight};
use rtc_plan::{self as plan, Plan};
use rtc_render::{
    self as render, AnyWorld, Aov, Film, FilmError, Job, Mismatch, OnPixel, PartialFilm, SimdLevel,
};
use rtc_source::{EditedFiles, FileId, SourceMap};
use rtc_study::{self as study, CheckpointSink, Order, Stopped, TargetResult, Watch};
use rtc_valid::{self as valid, Surface, ValidScene};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

/// How strict the check is.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// What the front end lets pass.
    pub front: front::FrontOptions,
    /// What the proof lets pass.
    pub valid: valid::ValidationOptions,
    /// What is made of findings.
    pub levels: FindingLevels,
    /// What is read in place of files that scenes name.
    pub edited: EditedFiles,
}

impl Options {
    /// An empty sink.
    fn sink(&self) -> Sink {
        Sink::within(&self.valid.limits).with_levels(self.levels.clone())
    }
}

/// Reads a scene in any form: the course's YAML, glTF, a mesh, or the text or binary form of the IR,
/// told apart by content. The files a YAML names come into the map.
pub fn load(
    file: FileId,
    map: &mut SourceMap,
    options: &Options,
    sink: &mut Sink,
) -> Option<Lowered> {
    if let Some(finding) = front::foreign(map.name(file), map.bytes(file)) {
        sink.push(finding);
        return None;
    }
    match codec::detect_format(map.bytes(file)) {
        Some(encoding) => {
            refuse_choices(&options.front, false, sink);
            let scene = codec::decode(encoding, file, map, sink)?;
            map.release(file, 0);
            Some(Lowered {
                scene,
                source_spans: SourceSpans::default(),
            })
        }
        None if gltf::recognise(map.name(file), map.bytes(file)) => {
            let lowered = gltf::lower(file, map, &options.front, sink)?;
            gltf::release(file, map);
            Some(lowered)
        }
        None if mesh::recognise(map.name(file), map.bytes(file)) => {
            refuse_choices(&options.front, false, sink);
            let lowered = assets::lower_standalone_mesh(file, &options.front, map, sink)?;
            map.release(file, 0);
            Some(lowered)
        }
        None if mitsuba::is_mitsuba(map.bytes(file)) => {
            refuse_choices(&options.front, false, sink);
            mitsuba::lower(file, map, &options.front, sink)
        }
        None => {
            let draft = course::lower(file, map, &options.front, sink)?;
            let has_assets = draft
                .pending_assets
                .iter()
                .any(|pending| matches!(pending.target, AssetTarget::Gltf(_)));
            refuse_choices(&options.front, has_assets, sink);
            Some(assets::load(draft, file, &options.front, map, sink))
        }
    }
}

/// Refuses to choose by name where there is no choice: outside glTF assets, of which a scene may
/// hold some. A time to be chosen there shows nothing else.
fn refuse_choices(options: &front::FrontOptions, has_assets: bool, sink: &mut Sink) {
    let front::FrontOptions {
        camera,
        animation,
        variant,
        time,
        ..
    } = options;
    if time.is_some() && !has_assets {
        let remark = Diagnostic::new(&codes::GLTF_STILL, "the scene is the same at all times");
        sink.push(remark.hint("only a glTF asset has animations"));
    }
    let parts = [("animation", animation), ("variant", variant)]
        .into_iter()
        .filter(|_| !has_assets);
    for (entity, name) in parts.chain([("camera", camera)]) {
        let Some(name) = name else { continue };
        let mismatch = Diagnostic::new(
            &codes::GLTF_CHOSEN,
            format!("the scene has no {entity} called `{}`", clip(name)),
        );
        sink.push(mismatch.hint(format!("only a glTF asset has {entity}s to choose from")));
    }
}

/// Puts view and light into a scene that was read, and what has no light into the studio. `None` if
/// that is not possible; the sink says why.
pub fn stage(
    lowered: &mut Lowered,
    stage: &ViewAndLight,
    kind: SceneKind,
    sink: &mut Sink,
) -> Option<AppliedViewAndLight> {
    let mismatch = match stage.apply(lowered, kind) {
        Ok(staged) => {
            if staged.lacks_light {
                let note = Diagnostic::new(
                    &codes::STUDIO,
                    "the scene has no light, so it stands in the studio",
                );
                sink.push(note.hint(
                    "light it by `--env`, `--env-color` or `--sun`; `--env-color 0,0,0` is darkness",
                ));
            }
            return Some(staged);
        }
        Err(BasisFault::ZeroGaze) => (
            &codes::EYE_IS_CENTER,
            "the view asked for is from the point that it looks at",
        ),
        Err(BasisFault::ZeroUp) => (
            &codes::ZERO_UP,
            "the upward direction asked for has no length",
        ),
        Err(BasisFault::Parallel) => (
            &codes::UP_PARALLEL,
            "the upward direction asked for is along the view",
        ),
    };
    sink.push(Diagnostic::new(mismatch.0, mismatch.1));
    None
}

/// Proves a scene, and warns of what no ray meets. `None` if it or what was read before has errors;
/// the sink says which.
pub fn validate(lowered: &Lowered, options: &Options, sink: &mut Sink) -> Option<ValidScene> {
    let proof = valid::validate(&lowered.scene, &lowered.source_spans, &options.valid, sink);
    let proof = proof.filter(|_| !sink.has_errors())?;
    unseen(&proof, lowered, sink);
    Some(proof)
}

/// Warns of the objects that no ray meets. An object is all surfaces written at one place.
fn unseen(scene: &ValidScene, lowered: &Lowered, sink: &mut Sink) {
    let unseen = plan::invisible_surfaces(scene);
    if unseen.is_empty() {
        return;
    }
    let place = |index: usize| ValuePath::new(EntityKind::Surface, index, Field::Whole);
    let object = |index: usize| match lowered.source_spans.span(place(index)) {
        Some(span) => Ok(span),
        None => Err(index),
    };
    let is_unseen: BTreeSet<_> = unseen.into_iter().collect();
    let mut objects = BTreeMap::new();
    for Surface { index, .. } in scene.surfaces() {
        let hidden = objects.entry(object(*index)).or_insert((*index, true));
        hidden.1 &= is_unseen.contains(index);
    }
    let objects: Vec<_> = objects
        .into_values()
        .filter(|(_, hidden)| *hidden)
        .collect();
    let more = objects.len().saturating_sub(MAX_UNSEEN);
    for (at, (index, _)) in objects.iter().take(MAX_UNSEEN).enumerate() {
        let message = "no ray of any pixel meets this object";
        let mut finding = Diagnostic::new(&codes::NEVER_SEEN, message);
        if more > 0 && at + 1 == MAX_UNSEEN {
            finding = finding.hint(format!("and {more} more like it"));
        }
        let finding = finding.at(
            lowered.source_spans.span(place(*index)),
            "not in the picture",
        );
        sink.push(finding.pointer(place(*index).to_string()));
    }
}

/// No more objects than this that no ray meets have a warning of their own.
const MAX_UNSEEN: usize = 10;

/// A scene prepared as planned, and the threads that render it.
pub struct Renderer {
    world: AnyWorld,
    threads: Threads,
}

impl Renderer {
    /// Prepares a proven scene, for `threads` threads, 0 for one per core.
    ///
    /// # Errors
    /// If the system gives no threads.
    pub fn new(
        scene: &ValidScene,
        plan: &Plan,
        threads: usize,
    ) -> Result<Self, ThreadPoolBuildError> {
        Self::at_level(scene, plan, threads, SimdLevel::best())
    }

    /// As [`Renderer::new`], with the vector instructions of a level: pictures are the same bytes.
    ///
    /// # Errors
    /// If the system gives no threads.
    pub fn at_level(
        scene: &ValidScene,
        plan: &Plan,
        threads: usize,
        simd: SimdLevel,
    ) -> Result<Self, ThreadPoolBuildError> {
        let threads = Threads::new(threads)?;
        let world = threads.install(|| AnyWorld::prepare_at(scene, plan, simd));
        Ok(Self { world, threads })
    }

    /// Shows another scene, which differs from the one before in its camera and settings alone.
    pub fn change(&mut self, scene: ValidScene) {
        self.threads.install(|| self.world.change(scene));
    }

    /// Whether there is memory for so many bytes: they are asked for, and given back at once. A
    /// picture is asked for so before it is made, for who runs out of memory on the way can say
    /// nothing any more.
    #[must_use]
    pub fn has_room(&self, bytes: usize) -> bool {
        // A thread that takes its first byte takes room for more.
        self.threads
            .each(|| drop(std::hint::black_box(Box::new(0_u8))));
        Vec::<u8>::new().try_reserve_exact(bytes).is_ok()
    }

    /// Renders a picture. `None` if `on_pixel` said stop.
    ///
    /// `on_pixel` is called from all threads, after each pixel and within long ones.
    #[must_use]
    pub fn render(&self, job: &Job, on_pixel: &OnPixel<'_>) -> Option<Film> {
        self.threads.install(|| self.world.render(job, on_pixel))
    }

    /// Renders the scene that it was made of until a goal is reached, and keeps what is done on the way
    /// where that is asked for.
    ///
    /// # Errors
    /// If someone said stop.
    pub fn approach(
        &mut self,
        scene: &Scene,
        order: &Order,
        watch: &Watch<'_>,
        keep: Option<CheckpointSink<'_>>,
    ) -> Result<TargetResult, Stopped> {
        let Self { world, threads } = self;
        threads.install(|| study::approach_keeping(world, scene, order, watch, keep))
    }

    /// Renders a part of a picture: the tiles of the job, and of traced paths only the range of
    /// samples given, if any. `None` if `on_pixel` said stop.
    ///
    /// # Errors
    /// If the samples are not whole blocks, or no paths are traced.
    pub fn render_part(
        &self,
        job: &Job,
        samples: Option<Range<u32>>,
        on_pixel: &OnPixel<'_>,
    ) -> Result<Option<PartialFilm>, FilmError> {
        self.threads
            .install(|| self.world.render_part(job, samples, on_pixel))
    }

    /// Renders layers of the pixels that a job asks for. `None` if `on_pixel` said stop.
    #[must_use]
    pub fn layers(
        &self,
        wanted: &[Aov],
        job: &Job,
        on_pixel: &(dyn Fn() -> bool + Sync),
    ) -> Option<Layers> {
        self.threads
            .install(|| self.world.layers(wanted, job, &|_| on_pixel()))
    }
}

/// Renders one picture of a proven scene; see [`Renderer::render`].
///
/// # Errors
/// If the system gives no threads.
pub fn render(
    scene: &ValidScene,
    plan: &Plan,
    job: &Job,
    threads: usize,
    on_pixel: &OnPixel<'_>,
) -> Result<Option<Film>, ThreadPoolBuildError> {
    Ok(Renderer::new(scene, plan, threads)?.render(job, on_pixel))
}

/// Renders on `threads` threads as planned and once more with everything that was left out, and
/// compares.
///
/// # Errors
/// If the system gives no threads; within, if something that was left out would show.
pub fn verify(
    scene: &ValidScene,
    plan: &Plan,
    job: &Job,
    threads: usize,
    on_pixel: &OnPixel<'_>,
) -> Result<Option<Result<Film, Mismatch>>, ThreadPoolBuildError> {
    Ok(Threads::new(threads)?.install(|| render::verify(scene, plan, job, on_pixel)))
}

/// The hash of a proven scene's IR, by which a picture or a report says what it is of: that of its
/// `.rtir` file, but for how values are shown.
///
/// # Panics
/// If a number of the scene is not finite, so never if it is proven.
#[must_use]
pub fn hash(scene: &Scene) -> String {
    let hash = codec::hash(scene).expect("a proven scene holds finite numbers only");
    format!("xxh3:{hash:032x}")
}

/// The threads that render; where the system has none to give, as in a browser, the calling one.
struct Threads(Option<ThreadPool>);

impl Threads {
    /// So many threads, 0 for one per core.
    fn new(threads: usize) -> Result<Self, ThreadPoolBuildError> {
        if cfg!(target_family = "wasm") {
            return Ok(Self(None));
        }
        let pool = ThreadPoolBuilder::new().num_threads(threads).build()?;
        Ok(Self(Some(pool)))
    }

    /// Does a piece of work on them.
    fn install<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        match &self.0 {
            Some(pool) => pool.install(work),
            None => work(),
        }
    }

    /// Does the same on each of them.
    fn each(&self, work: impl Fn() + Sync) {
        match &self.0 {
            Some(pool) => drop(pool.broadcast(|_| work())),
            None => work(),
        }
    }
}
