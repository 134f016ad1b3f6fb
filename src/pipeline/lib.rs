//! Joins the stages: bytes to scene, scene to [`ValidScene`], valid scene to film, film to file.
//! Nothing here prints, exits or reads the environment.
//!
//! # Overview
//! - [`Input`] reads a scene, lowers it ([`load`]), applies overrides ([`stage`]) and validates it
//!   ([`validate`]), and collects the diagnostics of all stages in a sink.
//! - [`PictureSetup`] has the options of a render: overrides, arithmetic, [`OutputTransform`]
//!   (format, tone map, exposure, background, layers). It renders a [`RenderSubject`], which is a
//!   valid scene with its [`Renderer`].
//! - [`Renderer`] is a prepared world with its threads.
//! - [`RayCounter`] limits the rays of a render, deterministically.
//! - [`ShardPlan`] divides a picture among several renders; each makes a [`RenderShard`], which can
//!   be saved, resumed and merged.
//! - [`PictureAudit`] and [`RenderShard::audit`] render some tiles of a picture, or of a part of
//!   one, again, and compare.
//! - [`fix()`] applies suggested fixes; [`Input::format_text`] formats a text.
//! - [`CacheFolder`] keeps finished results by the hash of what they depend on.
//! - [`AtomicFile`] writes files atomically; no other code writes files.
//! - [`trial`] has the entry points of the fuzz targets.
//!
//! # Guarantees
//! - Errors in a scene are diagnostics in the sink, never `Err`; [`RenderError`] is for renders
//!   that can't be made.
//! - A picture has the same bytes for any number of threads, in strips, and merged from shards.

mod audit;
#[cfg(not(target_family = "wasm"))]
mod cache;
mod denoise;
mod explanation;
mod export;
mod exposure;
#[cfg(not(target_family = "wasm"))]
mod file;
mod fix;
mod input;
mod lamps;
mod layout;
mod light;
mod measured;
mod output_transform;
mod picture_diagnostics;
mod ray_counter;
mod setup;
mod shard;
mod shard_plan;
mod strips;
pub mod trial;

pub use audit::{
    AuditFinding, AuditResult, AuditSubject, ODDS as AUDIT_ODDS, PictureAudit, TileDraw,
};
#[cfg(not(target_family = "wasm"))]
pub use cache::{CacheFolder, CacheKey, CacheMiss, scene_digest};
pub use denoise::Traced;
pub use explanation::{explain_code, explanation};
pub use export::{ExportFormat, ExportedFiles, sidecar_folder};
pub use exposure::LightMeasurement;
#[cfg(not(target_family = "wasm"))]
pub use file::{AtomicFile, AtomicFolder, FolderIdentity, WriteObserver};
pub use fix::{DiagnosticRef, FixFilter, FixedText, diagnostic_ref, fix};
pub use input::{Input, LoadedScene, Provenance, ValidatedScene};
pub use layout::{FormatTextError, SourceKind, is_scene};
pub use output_transform::{Exposure, OutputTransform, ResolvedOutputTransform};
pub use ray_counter::RayCounter;
pub use setup::{PictureSetup, RenderError, RenderObserver, RenderSubject, Rounds};
pub use shard::{MAX_SHARES as MAX_SHARDS, RenderShard, ShardError, hash_of_file};
pub use shard_plan::{ShardDivision, ShardPlan};

use rayon::{ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder};
use rtc_codec as codec;
use rtc_diag::{Diagnostic, DiagnosticLevels, DiagnosticSink, clip, codes};
use rtc_front as front;
use rtc_front::course::assets::{self, AssetTarget};
use rtc_front::{course, gltf, mitsuba, pbrt, usd};
use rtc_image::PixelLayers;
use rtc_ir::{EntityField, EntityKind, LoweredScene, Scene, SourceSpans, StoredTree, ValuePath};
use rtc_math::CameraBasisError;
use rtc_passes::{AppliedViewAndLight, SceneKind, ViewAndLight};
use rtc_plan::{self as plan, Plan, RuleSet};
use rtc_render::{
    self as render, AnyWorld, Aov, Film, FilmError, PartialFilm, PixelObserver, PlanMismatch,
    RenderSelection, SimdLevel,
};
use rtc_source::{EditedFiles, FileId, SourceMap};
use rtc_study::{
    self as study, CheckpointSink, RenderCallbacks, RenderRequest, Stopped, TargetResult,
};
use rtc_valid::{self as valid, Surface, ValidScene};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

/// Options of reading and checking a scene.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Options of the front ends.
    pub front: front::FrontOptions,
    /// Options of the validation.
    pub valid: valid::ValidationOptions,
    /// Severity overrides of diagnostics.
    pub levels: DiagnosticLevels,
    /// Texts that replace files to which scenes refer.
    pub edited: EditedFiles,
    /// Whether the source map keeps a record of what is read, for a cache.
    pub is_recorded: bool,
}

impl Options {
    /// An empty sink.
    fn sink(&self) -> DiagnosticSink {
        DiagnosticSink::within(&self.valid.limits).with_levels(self.levels.clone())
    }
}

/// Reads a scene of any [kind](SourceKind), detected by its name and content. The files to which it
/// refers are added to the map.
pub fn load(
    file: FileId,
    map: &mut SourceMap,
    options: &Options,
    sink: &mut DiagnosticSink,
) -> Option<LoweredScene> {
    // Reject formats that are recognised but not supported.
    if let Some(diagnostic) = front::foreign(map.name(file), map.bytes(file)) {
        sink.push(diagnostic);
        return None;
    }
    // Detect the format and lower the scene.
    let kind = SourceKind::of(map.name(file), map.bytes(file));
    if !matches!(kind, SourceKind::Scene | SourceKind::Gltf | SourceKind::Usd) {
        report_unused_choices(&options.front, false, sink);
    }
    if kind != SourceKind::Mitsuba && !options.front.define.is_empty() {
        let message = "the parameters of the command line have no effect";
        let ignored = Diagnostic::new(&codes::MITSUBA_IGNORED, message);
        sink.push(ignored.hint("only a scene of Mitsuba has parameters"));
    }
    match kind {
        SourceKind::Ir(encoding) => {
            let scene = codec::decode(encoding, file, map, sink)?;
            map.release(file, 0);
            Some(LoweredScene {
                scene,
                source_spans: SourceSpans::default(),
            })
        }
        SourceKind::Gltf => {
            let lowered = gltf::lower(file, map, &options.front, sink)?;
            gltf::release(file, map);
            Some(lowered)
        }
        SourceKind::Mesh => {
            let lowered = assets::lower_standalone_mesh(file, &options.front, map, sink)?;
            map.release(file, 0);
            Some(lowered)
        }
        SourceKind::Mitsuba => mitsuba::lower(file, map, &options.front, sink),
        SourceKind::Pbrt => pbrt::lower(file, map, &options.front, sink),
        SourceKind::Usd => usd::lower(file, map, &options.front, sink),
        SourceKind::Scene => {
            let draft = course::lower(file, map, &options.front, sink)?;
            let has_assets = draft
                .pending_assets
                .iter()
                .any(|pending| matches!(pending.target, AssetTarget::Gltf(_)));
            report_unused_choices(&options.front, has_assets, sink);
            Some(assets::load(draft, file, &options.front, map, sink))
        }
    }
}

/// Reports choices of animation, variant or camera that have no effect, because the scene has no
/// glTF asset; a time without an asset gets a note.
fn report_unused_choices(
    options: &front::FrontOptions,
    has_assets: bool,
    sink: &mut DiagnosticSink,
) {
    let front::FrontOptions {
        camera,
        animation,
        variant,
        time,
        ..
    } = options;
    if time.is_some() && !has_assets {
        let remark = Diagnostic::new(&codes::GLTF_STILL, "the scene is the same at all times");
        sink.push(remark.hint("only a glTF asset or a USD stage has animations"));
    }
    let (gltf, any) = ("a glTF asset", "a glTF asset or a USD stage");
    let parts = [("animation", animation, gltf), ("variant", variant, any)]
        .into_iter()
        .filter(|_| !has_assets);
    for (entity, name, owner) in parts.chain([("camera", camera, any)]) {
        let Some(name) = name else { continue };
        let mismatch = Diagnostic::new(
            &codes::GLTF_CHOSEN,
            format!("the scene has no {entity} called `{}`", clip(name)),
        );
        sink.push(mismatch.hint(format!("only {owner} has {entity}s to choose from")));
    }
}

/// Applies overrides of view and light to a scene, and adds the studio to a scene without light.
/// `None` if that is impossible; the sink has the error.
pub fn stage(
    lowered: &mut LoweredScene,
    stage: &ViewAndLight,
    kind: SceneKind,
    sink: &mut DiagnosticSink,
) -> Option<AppliedViewAndLight> {
    let mismatch = match stage.apply(lowered, kind) {
        Ok(staged) => {
            if staged.lacks_light {
                let note = Diagnostic::new(
                    &codes::STUDIO,
                    "the scene has no light, so the studio lights it",
                );
                sink.push(note.hint(
                    "light it by `--env`, `--env-color` or `--sun`; `--env-color 0,0,0` is \
                    darkness",
                ));
            }
            return Some(staged);
        }
        Err(CameraBasisError::ZeroGaze) => (
            &codes::EYE_IS_CENTER,
            "the requested eye is at the requested centre",
        ),
        Err(CameraBasisError::ZeroUp) => {
            (&codes::ZERO_UP, "the requested upward direction is zero")
        }
        Err(CameraBasisError::Parallel) => (
            &codes::UP_PARALLEL,
            "the requested upward direction is along the view",
        ),
    };
    sink.push(Diagnostic::new(mismatch.0, mismatch.1));
    None
}

/// Validates a scene and warns about objects that no ray hits. `None` if it or an earlier stage has
/// errors; the sink has them.
pub fn validate(
    lowered: &LoweredScene,
    options: &Options,
    sink: &mut DiagnosticSink,
) -> Option<ValidScene> {
    let valid_scene = valid::validate(&lowered.scene, &lowered.source_spans, &options.valid, sink);
    let valid_scene = valid_scene.filter(|_| !sink.has_errors())?;
    unseen(&valid_scene, lowered, sink);
    untextured(&valid_scene, lowered, sink);
    focused(&valid_scene, lowered, sink);
    unsampled(&valid_scene, lowered, sink);
    Some(valid_scene)
}

/// Warns about objects that no ray hits. An object is all surfaces with one span.
fn unseen(scene: &ValidScene, lowered: &LoweredScene, sink: &mut DiagnosticSink) {
    let unseen = plan::invisible_surfaces(scene);
    if unseen.is_empty() {
        return;
    }
    let path = |index: usize| ValuePath::new(EntityKind::Surface, index, EntityField::Whole);
    let object = |index: usize| match lowered.source_spans.span(path(index)) {
        Some(span) => Ok(span),
        None => Err(index),
    };
    let is_unseen: BTreeSet<_> = unseen.into_iter().collect();
    let mut objects = BTreeMap::new();
    for Surface { index, .. } in scene.surfaces() {
        let is_hidden = objects.entry(object(*index)).or_insert((*index, true));
        is_hidden.1 &= is_unseen.contains(index);
    }
    let objects: Vec<_> = objects
        .into_values()
        .filter(|(_, is_hidden)| *is_hidden)
        .collect();
    let more = objects.len().saturating_sub(MAX_UNSEEN);
    for (at, (index, _)) in objects.iter().take(MAX_UNSEEN).enumerate() {
        let message = "no ray of any pixel hits this object";
        let mut diagnostic = Diagnostic::new(&codes::NEVER_SEEN, message);
        if more > 0 && at + 1 == MAX_UNSEEN {
            diagnostic = diagnostic.hint(format!("and {more} more like it"));
        }
        let diagnostic = diagnostic.at(
            lowered.source_spans.span(path(*index)),
            "not in the picture",
        );
        sink.push(diagnostic.pointer(path(*index).to_string()));
    }
}

/// Warns about textures that a surface does not show, because it has no texture coordinates.
fn untextured(scene: &ValidScene, lowered: &LoweredScene, sink: &mut DiagnosticSink) {
    // The reader of glTF reports the primitives of an asset that lack texture coordinates.
    let reported: BTreeSet<_> = sink
        .kept()
        .iter()
        .filter(|reported| reported.alias == Some(TOO_FEW_TEXCOORDS))
        .filter_map(|reported| Some(reported.primary.as_ref()?.span.file))
        .collect();
    for map in plan::hidden_maps(scene) {
        let texture = ValuePath::new(EntityKind::Material, map.material.index(), map.field);
        let surface = ValuePath::new(EntityKind::Surface, map.surface, EntityField::Whole);
        let surface_or_part = if map.is_partial {
            "a part of a surface"
        } else {
            "a surface"
        };
        let span = lowered.source_spans.span(texture);
        if map.is_mesh && span.is_some_and(|span| reported.contains(&span.file)) {
            continue;
        }
        let hint = if map.is_mesh {
            "a mesh needs texture coordinates for images and patterns"
        } else {
            "a pattern with `mapping: world` needs no texture coordinates"
        };
        let message = format!(
            "{surface_or_part} has no texture coordinates, and is shown without its texture"
        );
        let diagnostic = Diagnostic::new(&codes::UNTEXTURED, message)
            .at(span, "the texture")
            .also(lowered.source_spans.span(surface), "a surface without it")
            .hint(hint);
        sink.push(diagnostic.pointer(texture.to_string()));
    }
}

/// What Khronos calls a glTF primitive without the texture coordinates of its material.
const TOO_FEW_TEXCOORDS: &str = "MESH_PRIMITIVE_TOO_FEW_TEXCOORDS";

/// Notes that the caustics of a small light are not estimated.
fn focused(scene: &ValidScene, lowered: &LoweredScene, sink: &mut DiagnosticSink) {
    let is_estimated = matches!(&scene.settings().mode, valid::Mode::Path(path) if path.caustics);
    if is_estimated {
        return;
    }
    let Some(plan::FocusedLight { light, caster }) = plan::focused_light(scene) else {
        return;
    };
    let surface = ValuePath::new(EntityKind::Surface, caster, EntityField::Whole);
    let message = if light.entity == EntityKind::Light {
        "light that no path finds may be focused by a smooth surface"
    } else {
        "light that few paths find may be focused by a smooth surface"
    };
    let note = Diagnostic::new(&codes::CAUSTICS, message)
        .at(
            lowered.source_spans.span(surface),
            "this surface focuses it",
        )
        .also(lowered.source_spans.span(light), "the light")
        .hint("`--set caustics=true` estimates it; `rtc cost` measures whether that pays");
    sink.push(note.pointer(light.to_string()));
}

/// Notes that light of infinite faces is found by chance.
fn unsampled(scene: &ValidScene, lowered: &LoweredScene, sink: &mut DiagnosticSink) {
    let Some(surface) = plan::unsampled_solid(scene) else {
        return;
    };
    let path = ValuePath::new(EntityKind::Surface, surface, EntityField::Whole);
    let message = "the light of infinite faces of a solid is found by chance";
    let note = Diagnostic::new(&codes::UNSAMPLED, message)
        .at(lowered.source_spans.span(path), "this solid shines")
        .hint("faces of a bounded solid are sampled: intersect it with a large sphere");
    sink.push(note.pointer(path.to_string()));
}

/// The maximum number of objects with their own warning.
const MAX_UNSEEN: usize = 10;

/// A prepared scene and the threads that render it.
pub struct Renderer {
    world: AnyWorld,
    threads: RenderThreads,
}

impl Renderer {
    /// Prepares a valid scene for `threads` threads, 0 for one per core.
    ///
    /// # Errors
    /// If the threads can't be started.
    pub fn new(
        scene: &ValidScene,
        plan: &Plan,
        threads: usize,
    ) -> Result<Self, ThreadPoolBuildError> {
        Self::at_level(scene, plan, threads, SimdLevel::best())
    }

    /// As [`Renderer::new`], for a SIMD level; it does not change pictures.
    ///
    /// # Errors
    /// If the threads can't be started.
    pub fn at_level(
        scene: &ValidScene,
        plan: &Plan,
        threads: usize,
        simd: SimdLevel,
    ) -> Result<Self, ThreadPoolBuildError> {
        let threads = RenderThreads::new(threads)?;
        let world = threads.install(|| AnyWorld::prepare_at(scene, plan, simd));
        Ok(Self { world, threads })
    }

    /// The hierarchy over the meshes of the scene, to be stored with it; `None` if it is small or
    /// there is none over all of them.
    #[must_use]
    pub fn tree_to_store(&self) -> Option<StoredTree> {
        self.world.tree_to_store()
    }

    /// Replaces the scene by one that differs only in camera and settings.
    pub fn change(&mut self, scene: ValidScene) {
        self.threads.install(|| self.world.change(scene));
    }

    /// Whether `bytes` of memory can be allocated; they are freed at once. Checked before a picture
    /// is rendered, because running out of memory later aborts the process.
    #[must_use]
    pub fn has_memory(&self, bytes: usize) -> bool {
        // Each thread allocates its arena with its first allocation.
        self.threads
            .each(|| drop(std::hint::black_box(Box::new(0_u8))));
        Vec::<u8>::new().try_reserve_exact(bytes).is_ok()
    }

    /// Renders a picture. `None` if `on_pixel` stopped it.
    ///
    /// All threads call `on_pixel`, after each pixel and during long ones.
    #[must_use]
    pub fn render(&self, job: &RenderSelection, on_pixel: &PixelObserver<'_>) -> Option<Film> {
        self.threads.install(|| self.world.render(job, on_pixel))
    }

    /// Renders the scene until a target is reached; `keep` receives checkpoints.
    ///
    /// # Errors
    /// If it was stopped.
    pub fn approach(
        &mut self,
        scene: &Scene,
        order: &RenderRequest,
        watch: &RenderCallbacks<'_>,
        keep: Option<CheckpointSink<'_>>,
    ) -> Result<TargetResult, Stopped> {
        let Self { world, threads } = self;
        threads.install(|| study::approach_keeping(world, scene, order, watch, keep))
    }

    /// Renders a shard of a picture: the tiles of the job, and for path tracing only the given
    /// range of samples. `None` if `on_pixel` stopped it.
    ///
    /// # Errors
    /// If the samples are not whole blocks, or the scene is not path-traced.
    pub fn render_part(
        &self,
        job: &RenderSelection,
        samples: Option<Range<u32>>,
        on_pixel: &PixelObserver<'_>,
    ) -> Result<Option<PartialFilm>, FilmError> {
        self.threads
            .install(|| self.world.render_part(job, samples, on_pixel))
    }

    /// Renders layers for the pixels of a job. `None` if `on_pixel` stopped it.
    #[must_use]
    pub fn layers(
        &self,
        aovs: &[Aov],
        job: &RenderSelection,
        on_pixel: &(dyn Fn() -> bool + Sync),
    ) -> Option<PixelLayers> {
        self.threads
            .install(|| self.world.layers(aovs, job, &|_| on_pixel()))
    }
}

/// Stores the hierarchy over the meshes of a scene in its IR, if there is one, as its render by all
/// rules builds it.
///
/// # Errors
/// If the threads can't be started.
pub fn store_tree(validated: &mut ValidatedScene) -> Result<(), RenderError> {
    let plan = Plan::new(&validated.scene, RuleSet::ALL);
    let renderer = Renderer::new(&validated.scene, &plan, 0)?;
    validated.lowered.scene.trees = renderer.tree_to_store().into_iter().collect();
    Ok(())
}

/// Renders one picture of a valid scene; see [`Renderer::render`].
///
/// # Errors
/// If the threads can't be started.
pub fn render(
    scene: &ValidScene,
    plan: &Plan,
    job: &RenderSelection,
    threads: usize,
    on_pixel: &PixelObserver<'_>,
) -> Result<Option<Film>, ThreadPoolBuildError> {
    Ok(Renderer::new(scene, plan, threads)?.render(job, on_pixel))
}

/// Renders with the plan and again without omissions, and compares.
///
/// # Errors
/// If the threads can't be started; the inner error if an omission changes the picture.
pub fn verify(
    scene: &ValidScene,
    plan: &Plan,
    job: &RenderSelection,
    threads: usize,
    on_pixel: &PixelObserver<'_>,
) -> Result<Option<Result<Film, PlanMismatch>>, ThreadPoolBuildError> {
    Ok(RenderThreads::new(threads)?.install(|| render::verify(scene, plan, job, on_pixel)))
}

/// The hash of the IR of a valid scene, which identifies it in pictures and reports: that of its
/// `.rtir` file with default display settings.
///
/// # Panics
/// If a number is not finite, which a valid scene excludes.
#[must_use]
pub fn hash(scene: &Scene) -> String {
    let hash = codec::hash(scene).expect("a valid scene has only finite numbers");
    format!("xxh3:{hash:032x}")
}

/// The threads that render; the calling thread where the system has none, as in a browser.
struct RenderThreads(Option<ThreadPool>);

impl RenderThreads {
    /// Starts threads, 0 for one per core.
    fn new(threads: usize) -> Result<Self, ThreadPoolBuildError> {
        if cfg!(target_family = "wasm") {
            return Ok(Self(None));
        }
        let pool = ThreadPoolBuilder::new().num_threads(threads).build()?;
        Ok(Self(Some(pool)))
    }

    /// Runs `work` on the threads.
    fn install<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        match &self.0 {
            Some(pool) => pool.install(work),
            None => work(),
        }
    }

    /// Runs `work` once on each thread.
    fn each(&self, work: impl Fn() + Sync) {
        match &self.0 {
            Some(pool) => drop(pool.broadcast(|_| work())),
            None => work(),
        }
    }
}
