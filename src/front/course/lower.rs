//! Lowers the declaration to the IR, piece by piece as it is decoded, and records the span of every
//! value.

use super::assets::{PendingAsset, PendingMaterial};
use super::camera;
use super::decode::{Decode, DecodeContext, SharedNode, ValueKey};
use super::glass::Glass;
use super::ineffective::DependentKeys;
use super::object::sizing::MeshSizing;
use super::object::torus::AmbiguousTorus;
use super::record::FieldResult;
use super::settings::Scene;
use super::syntax;
use super::texture::NamedFiles;
use crate::FrontOptions;
use rtc_diag::{Diagnostic, DiagnosticSink, clip, codes};
use rtc_ir::{
    self as ir, EntityField, EntityKind, LoweredScene, MaterialId, SourceSpans, ValuePath,
};
use rtc_source::tree::NodeContent;
use rtc_source::tree::yaml::{self, YamlError};
use rtc_source::{FileId, SourceMap, Span};
use std::collections::BTreeMap;

/// Parses the text of a scene and lowers it, without loading the files that it names. `None` if the
/// text is no scene; every mistake is reported.
///
/// Invalid parts are omitted, and an invalid camera is replaced by a valid one, so that the
/// validator can find the mistakes in the rest.
pub fn lower(
    file: FileId,
    map: &SourceMap,
    options: &FrontOptions,
    sink: &mut DiagnosticSink,
) -> Option<UnfinishedScene> {
    let report = &mut |mistake: YamlError<'_>| sink.push(syntax::diagnostic(mistake));
    let tree = match map.tree(file) {
        Some(tree) => tree,
        None => yaml::parse(file, map.bytes(file), report)?,
    };
    match tree.shape(tree.root()) {
        NodeContent::Map => {}
        NodeContent::Word("" | "~" | "null" | "Null" | "NULL") => {
            sink.push(
                Diagnostic::new(&codes::EMPTY_FILE, "the file contains no scene")
                    .at(tree.span(tree.root()), "empty"),
            );
            return None;
        }
        NodeContent::Word(_) | NodeContent::Text(_) | NodeContent::List => {
            let hint = "it starts like `Camera:`, with a colon and a space after each key";
            sink.push(
                Diagnostic::new(
                    &codes::NOT_A_SCENE,
                    "a scene must be a map of keys and values",
                )
                .at(tree.span(tree.root()), "not a map")
                .hint(hint),
            );
            return None;
        }
    }
    let mut context = DecodeContext::new(&tree, options, map.budget(), sink);
    let mut lowering = Lowering::new();
    lowering.scene(&mut context);
    report_spellings(&mut context);
    record_case(&mut context);
    // The spans are sorted after the tree is freed, which lowers the peak of memory.
    drop(tree);
    Some(lowering.finish())
}

/// A scene as lowered from its text; its files are not loaded yet.
#[derive(Clone, Debug)]
pub struct UnfinishedScene {
    /// The scene, with an image of one pixel or an empty mesh for each file.
    pub lowered: LoweredScene,
    /// The files, each once.
    pub pending_assets: Vec<PendingAsset>,
    /// The sizings of meshes, to be applied after loading.
    pub(super) sizings: Vec<MeshSizing>,
    /// The source of each mesh's material.
    pub(super) pending_materials: Vec<PendingMaterial>,
}

impl UnfinishedScene {
    /// A scene with these pending files.
    #[must_use]
    pub fn new(lowered: LoweredScene, pending_assets: Vec<PendingAsset>) -> Self {
        Self {
            lowered,
            pending_assets,
            sizings: Vec::new(),
            pending_materials: Vec::new(),
        }
    }
}

/// The state of lowering one scene.
pub(super) struct Lowering {
    pub(super) scene: ir::Scene,
    /// The materials by their nodes, which aliases may repeat.
    pub(super) shared: BTreeMap<SharedNode, MaterialId>,
    /// The material of objects without one, once it is used.
    pub(super) grey: Option<MaterialId>,
    /// The textures and meshes so far.
    pub(super) files: NamedFiles,
    /// The materials that transmit light.
    pub(super) glass: Vec<Glass>,
    /// The sizings of meshes, to be applied after loading.
    pub(super) sizings: Vec<MeshSizing>,
    /// The source of each mesh's material.
    pub(super) pending_materials: Vec<PendingMaterial>,
    /// The keys whose effect depends on other settings.
    pub(super) dependent: DependentKeys,
    /// The tori whose radii are interpreted by the entities around them.
    pub(super) ambiguous_tori: Vec<AmbiguousTorus>,
    /// The spans of sizes of 0.
    pub(super) invisible: Vec<Span>,
    source_spans: SourceSpans,
}

impl Lowering {
    fn new() -> Self {
        let scene = ir::Scene::new(ir::Camera::default(), ir::Settings::default());
        let (shared, files, sizings) = (BTreeMap::new(), NamedFiles::default(), Vec::new());
        Self {
            scene,
            shared,
            grey: None,
            files,
            glass: Vec::new(),
            sizings,
            pending_materials: Vec::new(),
            dependent: DependentKeys::default(),
            ambiguous_tori: Vec::new(),
            invisible: Vec::new(),
            source_spans: SourceSpans::default(),
        }
    }

    /// Records the span of a value; a default has none.
    pub(super) fn record_span(
        &mut self,
        entity: EntityKind,
        index: usize,
        field: EntityField,
        span: Option<Span>,
    ) {
        self.source_spans
            .record(ValuePath::new(entity, index, field), span);
    }

    /// Forgets the spans of the surfaces from an index on.
    pub(super) fn forget_surfaces(&mut self, first: usize) {
        self.source_spans.forget_from(EntityKind::Surface, first);
        self.scene.names.truncate(first);
    }

    fn scene(&mut self, context: &mut DecodeContext<'_>) {
        let root = context.tree.root();
        context.key = ValueKey {
            text: "the file",
            span: None,
        };
        let Some(scene) = Scene::decode(root, context) else {
            return;
        };
        // Camera and settings.
        self.choose_camera(&scene, context);
        self.report_unused_sizes(&scene, context);
        self.settings(&scene, context);
        if let FieldResult::Read(environment) = &scene.environment {
            self.environment(environment, context);
        }
        if let FieldResult::Read(medium) = &scene.medium {
            self.medium(medium);
        }
        scene
            .lights
            .value
            .decode_each(context, "Lights", |context, light| {
                self.light(&light, context)
            });
        if self.scene.lights.is_empty() {
            let path = scene.lights.span.unwrap_or_else(|| context.head(root));
            self.record_span(EntityKind::Light, 0, EntityField::Whole, Some(path));
        }
        self.resolve_soft_lights(&scene, context);
        // Objects.
        let count = scene.objects.value.len(context);
        scene
            .objects
            .value
            .decode_each(context, "Objects", |context, object| {
                if self.scene.surfaces.is_empty() {
                    // Growing the list by doubling would move the surfaces and double the memory.
                    self.scene.surfaces.reserve_exact(count);
                }
                self.object(&object.value, context);
            });
        // Decisions that need all entities.
        self.resolve_tori(context);
        self.report_invisible(context);
        if !self.scene.names.is_empty() {
            // Every surface has a name, if only an empty one.
            let count = self.scene.surfaces.len();
            self.scene.names.resize(count, String::new());
        }
        self.resolve_mode(&scene);
        self.ambient(&scene, context);
        self.glass(context);
        self.report_ineffective(&scene, context);
        self.show_uv(&scene);
    }

    /// Lowers one of the cameras and reports the others.
    fn choose_camera(&mut self, scene: &Scene, context: &mut DecodeContext<'_>) {
        let Scene {
            camera,
            eye,
            look,
            image_size,
            ..
        } = scene;
        let size = image_size
            .ok()
            .map_or(camera::DEFAULT_SIZE, |size| size.value);
        // `Camera` wins over `CameraEye` and its companions, and these over `Eye`.
        match (camera, look, eye) {
            (FieldResult::Absent, FieldResult::Absent, FieldResult::Absent) => {
                report_no_camera(context)
            }
            (FieldResult::Read(camera), ..) => self.camera(camera, context),
            (FieldResult::Absent, FieldResult::Read(look), _) => {
                self.camera_from_keys(look, size, context)
            }
            (FieldResult::Absent, FieldResult::Absent, FieldResult::Read(eye)) => {
                self.old_eye_camera(*eye, size, context)
            }
            (FieldResult::Broken, ..) | (_, FieldResult::Broken, _) | (.., FieldResult::Broken) => {
            }
        }
        // Report the keys that lose.
        if let (false, FieldResult::Read(look)) = (camera.is_absent(), look) {
            report_ignored_camera("CameraEye", "Camera", look[0].span, context);
        }
        match (camera.is_absent(), look.is_absent(), eye) {
            (false, _, FieldResult::Read(eye)) => {
                report_ignored_camera("Eye", "Camera", eye.span, context)
            }
            (true, false, FieldResult::Read(eye)) => {
                report_ignored_camera("Eye", "CameraEye", eye.span, context)
            }
            _ => {}
        }
    }

    fn finish(self) -> UnfinishedScene {
        let Self {
            scene,
            shared: _,
            grey: _,
            glass: _,
            files: NamedFiles { pending_assets, .. },
            sizings,
            pending_materials,
            dependent: _,
            ambiguous_tori: _,
            invisible: _,
            mut source_spans,
        } = self;
        // Record the origin of the assets that are still to be read.
        for PendingAsset {
            target,
            path: _,
            span,
        } in &pending_assets
        {
            if let Some(path) = target.value_path() {
                source_spans.record(path, *span);
            }
        }
        // Hand on the scene with what later steps complete.
        source_spans.finish();
        UnfinishedScene {
            lowered: LoweredScene {
                scene,
                source_spans,
            },
            pending_assets,
            sizings,
            pending_materials,
        }
    }
}

fn report_no_camera(context: &mut DecodeContext<'_>) {
    let span = context.head(context.tree.root());
    let message = || "the scene has no `Camera`".to_owned();
    let cause = context.typo_for(&["Camera", "Eye"], 0);
    let cause = cause.filter(|cause| *cause != span);
    context.report(&codes::NO_CAMERA, span, message, |d| {
        d.at(span, "the scene")
            .caused_by(cause, "perhaps this is the cause")
            .hint("add `Camera:` with `eye`, `center`, `up` and `viewSize`; old files have `Eye:`")
    });
}

fn report_ignored_camera(
    ignored: &str,
    used: &str,
    span: Option<Span>,
    context: &mut DecodeContext<'_>,
) {
    let severity = context.unknown_key_severity();
    if let Some(span) = span {
        let message = || format!("the scene has both `{used}` and `{ignored}`");
        context.report(&codes::TWO_CAMERAS, span, message, |d| {
            d.at(span, format!("ignored: `{used}` is used"))
                .severity(severity)
                .hint(format!("remove `{ignored}`"))
        });
    }
}

/// Reports once which spellings are not canonical.
fn report_spellings(context: &mut DecodeContext<'_>) {
    let spellings = std::mem::take(&mut context.spellings);
    let Some((_, _, first)) = spellings.first().copied() else {
        return;
    };
    let pairs: Vec<_> = spellings
        .iter()
        .map(|(written, canonical, _)| format!("`{written}` for `{canonical}`"))
        .collect();
    context.report(
        &codes::SPELLING,
        first,
        || format!("other spellings: {}", pairs.join(", ")),
        |d| {
            d.at(first, "the first of them")
                .hint("`rtc compile --emit yaml` writes the canonical ones")
        },
    );
}

/// Reports once that keys differ in case from the declared ones.
fn record_case(context: &mut DecodeContext<'_>) {
    let Some((written, canonical, span)) = context.other_case else {
        return;
    };
    let message = || {
        format!(
            "the case of letters in keys: `{}` for `{canonical}`",
            clip(written)
        )
    };
    context.report(&codes::SPELLING, span, message, |d| {
        d.at(span, "the first of them")
            .hint("`--strict` takes keys only as the format writes them")
    });
}
