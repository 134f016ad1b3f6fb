//! Lowering: the declaration, piece by piece as it is decoded, to the IR, with the place of every value.

use super::camera;
use super::decode::{Context, Key, Value};
use super::record::Found;
use super::settings::Scene;
use super::tree::{self, NodeId, Shape};
use crate::diag::{Diagnostic, Sink, codes};
use crate::front::Options;
use crate::ir::{self, Field, Lowered, MaterialId, Noun, Origins, Place};
use crate::source::{FileId, SourceMap, Span};
use std::collections::BTreeMap;

/// Reads a scene text and lowers it. `None` if the text is no scene at all; every mistake is in the sink.
///
/// What can't be read is left out, and a camera that can't be read is replaced by a sound one, so that the proof can
/// find the mistakes of the rest; the sink has an error for each.
pub fn lower(file: FileId, map: &SourceMap, options: &Options, sink: &mut Sink) -> Option<Lowered> {
    let tree = tree::parse(file, map.bytes(file), sink)?;
    match tree.shape(tree.root()) {
        Shape::Map => {}
        Shape::Word("" | "~" | "null" | "Null" | "NULL") => {
            sink.push(
                Diagnostic::new(&codes::EMPTY_FILE, "this file holds no scene").at(tree.span(tree.root()), "empty"),
            );
            return None;
        }
        Shape::Word(_) | Shape::Text(_) | Shape::List => {
            let hint = "it starts like `Camera:`, with a colon and a space after each key";
            sink.push(
                Diagnostic::new(&codes::NOT_A_SCENE, "a scene is a map of keys and values")
                    .at(tree.span(tree.root()), "this is not")
                    .hint(hint),
            );
            return None;
        }
    }
    let mut context = Context::new(&tree, options, sink);
    let mut lowering = Lowering::new();
    lowering.scene(&mut context);
    note_spellings(&mut context);
    // The places are sorted after the tree is gone: together they would be the peak of memory.
    drop(tree);
    Some(lowering.finish())
}

/// A scene in the making.
pub(super) struct Lowering {
    pub(super) scene: ir::Scene,
    /// The materials by their nodes: aliases may name them again.
    pub(super) shared: BTreeMap<NodeId, MaterialId>,
    origins: Origins,
}

impl Lowering {
    fn new() -> Self {
        let settings = ir::Settings {
            mode: ir::Mode::Phong,
            shadows: false,
            max_depth: 0,
            supersampling: 1,
            pattern: ir::Pattern::Grid,
            light_samples: 1,
        };
        let scene = ir::Scene {
            camera: camera::placeholder(),
            settings,
            lights: Vec::new(),
            images: Vec::new(),
            textures: Vec::new(),
            meshes: Vec::new(),
            materials: Vec::new(),
            surfaces: Vec::new(),
        };
        Self { scene, shared: BTreeMap::new(), origins: Origins::default() }
    }

    /// Remembers where a value was written; a default was written nowhere.
    pub(super) fn origin(&mut self, noun: Noun, index: usize, field: Field, span: Option<Span>) {
        self.origins.record(Place::new(noun, index, field), span);
    }

    fn scene(&mut self, context: &mut Context<'_>) {
        let root = context.tree.root();
        context.key = Key { text: "the file", span: None };
        let Some(scene) = Scene::decode(root, context) else { return };
        self.view(&scene, context);
        self.settings(&scene, context);
        scene.lights.value.decode_each(context, "Lights", |_, light| self.light(&light));
        scene.objects.value.decode_each(context, "Objects", |context, object| self.object(&object.value, context));
    }

    /// Chooses between the two cameras.
    fn view(&mut self, scene: &Scene, context: &mut Context<'_>) {
        match (&scene.camera, &scene.eye) {
            (Found::Absent, Found::Absent) => no_camera(context),
            (Found::Absent, Found::Read(eye)) => self.eye(*eye),
            (Found::Absent, Found::Broken) => {}
            (camera, eye) => {
                if let Found::Read(camera) = camera {
                    self.camera(camera, context);
                }
                if let Found::Read(eye) = eye {
                    ignored_eye(eye.span, context);
                }
            }
        }
    }

    fn finish(mut self) -> Lowered {
        self.origins.finish();
        Lowered { scene: self.scene, origins: self.origins }
    }
}

fn no_camera(context: &mut Context<'_>) {
    let span = context.head(context.tree.root());
    let message = || "the scene has no `Camera`".to_owned();
    context.report(&codes::NO_CAMERA, span, message, |d| {
        d.at(span, "this scene").hint("add `Camera:` with `eye`, `center`, `up` and `viewSize`; old files have `Eye:`")
    });
}

fn ignored_eye(span: Option<Span>, context: &mut Context<'_>) {
    let severity = context.unread();
    if let Some(span) = span {
        let message = || "the scene has both `Camera` and `Eye`".to_owned();
        context.report(&codes::TWO_CAMERAS, span, message, |d| {
            d.at(span, "ignored: `Camera` is used").severity(severity).hint("remove `Eye`")
        });
    }
}

/// Says once which spellings of the file are not the canonical ones.
fn note_spellings(context: &mut Context<'_>) {
    let spellings = std::mem::take(&mut context.spellings);
    let Some((_, _, first)) = spellings.first().copied() else { return };
    let pairs: Vec<_> = spellings.iter().map(|(written, meant, _)| format!("`{written}` for `{meant}`")).collect();
    context.report(
        &codes::SPELLING,
        first,
        || format!("other spellings: {}", pairs.join(", ")),
        |d| d.at(first, "the first of them").hint("`rtc compile --emit yaml` writes the canonical ones"),
    );
}
