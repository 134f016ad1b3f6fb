//! Stages of USD (`.usda`, `.usdc`, `.usdz`) lowered to the IR.
//!
//! ```text
//! bytes ─ text, binary, package ─▶ Layer ─ stage ─▶ Prim ─ mesh, shape, light, … ─▶ LoweredScene
//! ```
//!
//! - [`text`], [`binary`] (of values that are [`packed`]) and [`package`] read a layer of each form
//!   as one [`layer`].
//! - [`stage`] composes prims of the layers: sublayers, inherits, variants, references, payloads
//!   and specializes. [`attribute`] finds values at one time.
//! - [`mesh`], [`shape`], [`light`], [`camera`] and [`material`] with [`texture`] and [`udim`]
//!   lower one kind of prim each, in the world of the scene: metres, y up.
//! - [`files`] finds and reads the files that a layer names. Without one the picture is made, too,
//!   and a warning says what it lacks.
//!
//! A stage without a camera or a light is shown as a glTF asset is.

mod attribute;
mod binary;
mod camera;
mod files;
mod layer;
mod light;
mod material;
mod mesh;
mod package;
mod packed;
mod shape;
mod stage;
mod text;
mod texture;
mod udim;
mod xform;

use crate::exchange::texture::SampledTextures;
use crate::exchange::transform::AffineTransform;
use crate::{FrontOptions, UpAxis, over_limit};
use layer::{Layer, PrimSpec};
use rtc_diag::{Diagnostic, DiagnosticSink, clip, clip_path, codes};
use rtc_ir::{
    EntityField, EntityKind, ImageId, LoweredScene, MaterialId, MeshId, Scene, SourceSpans,
    ValuePath,
};
use rtc_source::{FileId, LimitExceeded, Resource, SourceMap, Span};
use shape::StageShape;
use stage::ComposedPrim;
use std::cell::OnceCell;
use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;

/// The deepest nesting of composed prims.
const MAX_DEPTH: usize = 2 * layer::MAX_DEPTH;

/// The deepest nesting of instancers in prototypes.
const MAX_PROTOTYPES: usize = 16;

/// The nodes of the budget that the reading of a prototype counts as.
const PROTOTYPE: u64 = 64;

/// Prims that are not drawn, with all that they hold.
const HIDDEN: [&str; 20] = [
    "Material",
    "Shader",
    "NodeGraph",
    "GeomSubset",
    "Skeleton",
    "SkelAnimation",
    "BlendShape",
    "RenderSettings",
    "RenderProduct",
    "RenderVar",
    "RenderPass",
    "PhysicsScene",
    "PhysicsCollisionGroup",
    "Backdrop",
    "SpatialAudio",
    "LightFilter",
    "PackedJointAnimation",
    "OpenVDBAsset",
    "GenerativeProcedural",
    "CoordSys",
];

/// The ends of the names of layers and packages.
const EXTENSIONS: [&str; 4] = ["usd", "usda", "usdc", "usdz"];

/// Whether bytes begin a layer or a package.
fn begins_layer(bytes: &[u8]) -> bool {
    let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    text.starts_with(b"#usda") || binary::is_binary(bytes) || package::is_package(bytes)
}

/// Whether a file is a stage or a layer of USD: by its name, or by its first bytes. A layer without
/// its first line is one, too, and then has a mistake.
#[must_use]
pub fn is_usd(name: &str, bytes: &[u8]) -> bool {
    let extension = name
        .rsplit_once('.')
        .map(|(_, last)| last.to_ascii_lowercase());
    extension.is_some_and(|extension| EXTENSIONS.contains(&extension.as_str()))
        || match package::is_package(bytes) {
            true => crate::foreign::is_usdz(bytes),
            false => begins_layer(bytes),
        }
}

/// Lowers a stage at one time. Layers come into the map; pictures are loaded.
///
/// `None` if the file is no layer, or exceeds the budget; the sink says why.
pub fn lower(
    file: FileId,
    map: &mut SourceMap,
    options: &FrontOptions,
    sink: &mut DiagnosticSink,
) -> Option<LoweredScene> {
    let mut lowering = Lowering::new(file, map, options, sink);
    if let Some(root) = lowering.open_root(file) {
        let root = Rc::new(lowering.pseudo_root(root));
        lowering.root = Some(Rc::clone(&root));
        lowering.stage(&root);
        lowering.finish();
    }
    if let Some((fault, span)) = lowering.exceeded.get() {
        lowering
            .sink
            .push(over_limit("the stage", fault).at(*span, ""));
        return None;
    }
    lowering.root.as_ref()?;
    let mut lowered = LoweredScene {
        scene: lowering.scene,
        source_spans: lowering.source_spans,
    };
    lowered.source_spans.finish();
    Some(lowered)
}

/// What a prim has from those above it.
#[derive(Clone)]
struct PrimState {
    to_world: AffineTransform,
    is_shown: bool,
    purpose: Rc<str>,
    material: Option<MaterialBinding>,
    /// The prims whose primvars it has.
    primvars: Option<Rc<PrimvarScope>>,
}

/// The material that a prim and those below it have.
#[derive(Clone)]
struct MaterialBinding {
    path: Rc<str>,
    /// Where it is bound.
    span: Span,
    /// Whether it comes before the bindings of the prims below.
    is_strong: bool,
}

/// A prim with primvars, and the next one above.
struct PrimvarScope {
    prim: Rc<ComposedPrim>,
    above: Option<Rc<Self>>,
}

/// A camera of the stage.
struct PlacedCamera {
    prim: Rc<ComposedPrim>,
    to_world: AffineTransform,
}

/// A stage while it is lowered.
struct Lowering<'run> {
    scene: Scene,
    source_spans: SourceSpans,
    options: &'run FrontOptions,
    map: &'run mut SourceMap,
    sink: &'run mut DiagnosticSink,
    /// The file of the stage, and its first bytes.
    root: Option<Rc<ComposedPrim>>,
    root_file: FileId,
    root_span: Span,
    layers: Vec<Rc<Layer>>,
    layer_origins: Vec<files::LayerOrigin>,
    layer_keys: BTreeMap<String, Option<usize>>,
    /// The files of the map by what distinguishes them.
    loaded: BTreeMap<String, Option<FileId>>,
    /// The layers by the paths that other ones name.
    named_layers: BTreeMap<(usize, String), Option<usize>>,
    packages: BTreeMap<FileId, Option<Rc<package::UsdzPackage>>>,
    stacks: Vec<Rc<stage::LayerStack>>,
    stack_of: BTreeMap<usize, usize>,
    /// The targets of the arcs that are followed.
    open_arcs: Vec<(usize, String)>,
    /// The nodes of the prim that is composed.
    nodes: u64,
    /// The arcs that were reported.
    reported: BTreeSet<(FileId, u32, String)>,
    prims: BTreeMap<String, Option<Rc<ComposedPrim>>>,
    /// The time of the picture, in time codes.
    time: f64,
    /// The length of a unit in metres.
    unit: f64,
    used_variant: bool,
    lookups: usize,
    materials: BTreeMap<String, Rc<material::BoundMaterial>>,
    placed_materials: BTreeMap<material::ShownMaterialKey, MaterialId>,
    images: BTreeMap<texture::ChannelsKey, Option<ImageId>>,
    textures: SampledTextures,
    /// The tiles of pictures, by the layer and the path that names them.
    tile_grids: BTreeMap<(usize, String), Option<Rc<udim::TileGrid>>>,
    meshes: BTreeMap<mesh::PartMeshKey, Option<MeshId>>,
    built: BTreeMap<String, MeshId>,
    cameras: Vec<PlacedCamera>,
    /// The shapes of a prototype that is read.
    prototype: Option<Vec<StageShape>>,
    /// The prototypes of instancers that are read.
    open_prototypes: Vec<String>,
    /// The limit that the stage exceeds, and where: nothing more is read.
    exceeded: OnceCell<(LimitExceeded, Span)>,
    /// The first binary layer with a value that is damaged.
    unread: OnceCell<FileId>,
}

impl<'run> Lowering<'run> {
    fn new(
        file: FileId,
        map: &'run mut SourceMap,
        options: &'run FrontOptions,
        sink: &'run mut DiagnosticSink,
    ) -> Self {
        // All tables are empty before the root layer is read.
        Self {
            scene: crate::gltf::empty(),
            source_spans: SourceSpans::default(),
            options,
            map,
            sink,
            root: None,
            root_file: file,
            root_span: Span::new(file, 0, 0),
            layers: Vec::new(),
            layer_origins: Vec::new(),
            layer_keys: BTreeMap::new(),
            loaded: BTreeMap::new(),
            named_layers: BTreeMap::new(),
            packages: BTreeMap::new(),
            stacks: Vec::new(),
            stack_of: BTreeMap::new(),
            open_arcs: Vec::new(),
            nodes: 0,
            reported: BTreeSet::new(),
            prims: BTreeMap::new(),
            time: 0.0,
            unit: 1.0,
            used_variant: false,
            lookups: 0,
            materials: BTreeMap::new(),
            placed_materials: BTreeMap::new(),
            images: BTreeMap::new(),
            textures: SampledTextures::default(),
            meshes: BTreeMap::new(),
            built: BTreeMap::new(),
            cameras: Vec::new(),
            prototype: None,
            open_prototypes: Vec::new(),
            tile_grids: BTreeMap::new(),
            exceeded: OnceCell::new(),
            unread: OnceCell::new(),
        }
    }

    fn is_exhausted(&self) -> bool {
        self.exceeded.get().is_some()
    }

    fn record(&mut self, entity: EntityKind, index: usize, span: Span) {
        let path = ValuePath::new(entity, index, EntityField::Whole);
        self.source_spans.record(path, span);
    }

    /// Warns of a prim that is left out or replaced.
    fn unsupported(&mut self, prim: &ComposedPrim, what: &str, instead: &str) {
        let message = format!(
            "{what} of `{}` is not supported: {instead}",
            clip_path(&prim.path)
        );
        let span = self.span_of(prim);
        self.report(&codes::USD_UNSUPPORTED, span, message);
    }

    /// Warns of a prim that is shown approximately.
    fn approximate(&mut self, prim: &ComposedPrim, what: &str) {
        let message = format!("`{}`: {what}", clip_path(&prim.path));
        let span = self.span_of(prim);
        self.report(&codes::USD_APPROXIMATE, span, message);
    }

    /// Lowers all prims below the root.
    fn stage(&mut self, root: &ComposedPrim) {
        let metadata = &self.layers[0].metadata;
        let up = metadata.up_axis.clone();
        let rate = metadata
            .time_codes_per_second
            .or(metadata.frames_per_second)
            .filter(|rate| *rate > 0.0)
            .unwrap_or(24.0);
        let start = metadata.start_time_code.unwrap_or(0.0);
        self.unit = metadata
            .meters_per_unit
            .filter(|unit| unit.is_normal() && *unit > 0.0)
            .unwrap_or(0.01);
        self.time = start + self.options.time.unwrap_or(0.0) * rate;
        if let Some(up) = up.filter(|up| !matches!(up.text.as_str(), "Y" | "Z")) {
            let message = "`upAxis` is neither `Y` nor `Z`; `Y` is assumed";
            self.report(&codes::USD_UNSUPPORTED, up.span, message);
        }
        let state = PrimState {
            to_world: self.base(),
            is_shown: true,
            purpose: "default".into(),
            material: None,
            primvars: None,
        };
        self.children(root, &state);
    }

    /// Lowers what is below a prim, one after the other.
    fn children(&mut self, prim: &ComposedPrim, state: &PrimState) {
        // Prims with those below them that are still to come, in reverse.
        let mut pending = vec![];
        let above = |lowering: &Self, prim: &ComposedPrim| {
            let mut names = lowering.child_names(prim);
            names.reverse();
            names
        };
        pending.push((None, state.clone(), above(self, prim)));
        while let Some((parent, state, mut names)) = pending.pop() {
            let Some(name) = names.pop().filter(|_| !self.is_exhausted()) else {
                continue;
            };
            let child = self
                .child(parent.as_deref().unwrap_or(prim), &name)
                .map(Rc::new);
            pending.push((parent, state.clone(), names));
            let Some(child) = child.filter(|child| self.is_defined(child)) else {
                continue;
            };
            if pending.len() >= MAX_DEPTH {
                self.unsupported(
                    &child,
                    "the place",
                    "prims are nested too deep, it is left out",
                );
                continue;
            }
            let Some(state) = self.prim(&child, &state) else {
                continue;
            };
            let names = above(self, &child);
            pending.push((Some(child), state, names));
        }
    }

    /// Lowers one prim; `None` if those below it are not drawn.
    fn prim(&mut self, prim: &Rc<ComposedPrim>, above: &PrimState) -> Option<PrimState> {
        let kind = self.type_name(prim).to_owned();
        if HIDDEN.contains(&kind.as_str()) {
            return None;
        }
        let state = self.state(prim, above)?;
        match kind.as_str() {
            "" | "Xform" | "Scope" => {}
            "SkelRoot" => self.approximate(prim, "what a skeleton moves is shown at rest"),
            "Mesh" => {
                if self.has(prim, "inputs:intensity") {
                    self.unsupported(prim, "the light", "the mesh gives none");
                }
                self.mesh(prim, &state);
            }
            "PointInstancer" => {
                self.instancer(prim, &state);
                return None;
            }
            "Camera" if self.prototype.is_some() => {}
            "Camera" => {
                let (prim, to_world) = (Rc::clone(prim), state.to_world);
                self.cameras.push(PlacedCamera { prim, to_world });
            }
            _ if light::KINDS.contains(&kind.as_str()) => self.light(prim, &kind, &state),
            _ if shape::KINDS.contains(&kind.as_str()) => self.solid(prim, &kind, &state),
            _ => self.unsupported(
                prim,
                &format!("the type `{}`", clip(&kind)),
                "it is left out",
            ),
        }
        Some(state)
    }

    /// What holds for a prim and those below it; `None` if they are hidden.
    fn state(&mut self, prim: &Rc<ComposedPrim>, above: &PrimState) -> Option<PrimState> {
        let (local, resets) = self.local(prim);
        let mut state = above.clone();
        let base = self.base();
        state.to_world = if resets {
            base.after(&local)
        } else {
            above.to_world.after(&local)
        };
        if self.text(prim, "visibility").as_deref() == Some("invisible") {
            return None;
        }
        if let Some(purpose) = self.text(prim, "purpose")
            && &*above.purpose == "default"
        {
            state.purpose = purpose.into();
        }
        state.is_shown = matches!(&*state.purpose, "default" | "render");
        let names = [
            "material:binding:preview",
            "material:binding",
            "material:binding:full",
        ];
        let bound = names.iter().find_map(|name| self.binding(prim, name));
        let is_open = state.material.as_ref().is_none_or(|above| !above.is_strong);
        state.material = bound.filter(|_| is_open).or(state.material);
        if self.has_some(prim, "material:binding:collection") {
            self.unsupported(
                prim,
                "the binding of a collection",
                "what it holds keeps its own material",
            );
        }
        let says = |is: fn(&PrimSpec) -> bool| {
            let mut specs = prim.opinions.iter().map(|opinion| self.spec(opinion));
            specs.any(is)
        };
        let lost = [
            (
                says(|spec| spec.has_clips),
                "the value clips",
                "they are left out",
            ),
            (
                says(|spec| spec.has_relocates),
                "the relocation",
                "prims stay where they are",
            ),
        ];
        for (_, what, instead) in lost.into_iter().filter(|(is_lost, ..)| *is_lost) {
            self.unsupported(prim, what, instead);
        }
        if self.has_some(prim, "primvars:") {
            state.primvars = Some(Rc::new(PrimvarScope {
                prim: Rc::clone(prim),
                above: state.primvars,
            }));
        }
        Some(state)
    }

    /// The material that a relationship of a prim binds.
    fn binding(&self, prim: &ComposedPrim, name: &str) -> Option<MaterialBinding> {
        let path = self.targets(prim, name).into_iter().next()?;
        let mut strengths = prim.opinions.iter().filter_map(|opinion| {
            let property = self.spec(opinion).properties.get(name)?;
            property.is_stronger_than_descendants
        });
        Some(MaterialBinding {
            path: path.into(),
            span: self.property_span(prim, name),
            is_strong: strengths.next().unwrap_or(false),
        })
    }

    /// The map from the stage to the scene: y up, and metres.
    fn base(&self) -> AffineTransform {
        let metadata = &self.layers[0].metadata;
        let is_z = metadata.up_axis.as_ref().is_some_and(|up| up.text == "Z");
        let axis = self
            .options
            .up_axis
            .unwrap_or(if is_z { UpAxis::Z } else { UpAxis::Y });
        let [x, y, z] = axis.scene_from_file().map(|axis| axis * self.unit);
        AffineTransform([x, y, z, rtc_math::Vec3::ZERO])
    }

    /// Chooses the camera, and reports what was asked for and is not there.
    fn finish(&mut self) {
        self.finish_camera();
        if let Some(file) = self.unread.get().copied() {
            let name = clip_path(self.map.name(file)).into_owned();
            let message = format!("a value of the layer `{name}` is damaged: it is left out");
            let diagnostic = Diagnostic::new(&codes::USD_DAMAGED, message);
            let diagnostic = diagnostic.severity(rtc_diag::Severity::Warning);
            self.sink.push(diagnostic.at(Span::new(file, 0, 0), ""));
        }
        let animation = self.options.animation.as_deref();
        let variant = self
            .options
            .variant
            .as_deref()
            .filter(|_| !self.used_variant);
        for (entity, name) in [("animation", animation), ("variant", variant)] {
            let Some(name) = name else { continue };
            let message = format!("the stage has no {entity} called `{}`", clip(name));
            let hint = match entity {
                "variant" => "a variant of USD is chosen by `SET=NAME`",
                _ => "a stage of USD has one animation: choose its time",
            };
            self.sink
                .push(Diagnostic::new(&codes::GLTF_CHOSEN, message).hint(hint));
        }
    }

    /// Places the shapes of prototypes at points (`UsdGeomPointInstancer`).
    fn instancer(&mut self, prim: &ComposedPrim, state: &PrimState) {
        if self.varies_by_instance(prim) {
            let instead = "all instances have those of their prototype";
            self.unsupported(prim, "the variation by instance", instead);
        }
        let prototypes = self.targets(prim, "prototypes");
        let indices = self.indices(prim, "protoIndices").unwrap_or_default();
        let positions = self.numbers(prim, "positions").unwrap_or_default();
        let scales = self.numbers(prim, "scales").unwrap_or_default();
        let turns = self
            .numbers(prim, "orientationsf")
            .filter(|turns| !turns.is_empty());
        let turns = turns
            .or_else(|| self.numbers(prim, "orientations"))
            .unwrap_or_default();
        let ids = self.indices(prim, "ids");
        let mut hidden: BTreeSet<usize> = self
            .indices(prim, "invisibleIds")
            .unwrap_or_default()
            .into_iter()
            .collect();
        hidden.extend(self.indices(prim, "inactiveIds").unwrap_or_default());
        let place = |at: usize| -> Option<AffineTransform> {
            let position: [f64; 3] = positions.get(3 * at..3 * at + 3)?.try_into().ok()?;
            let turn: Option<[f64; 4]> = turns
                .get(4 * at..4 * at + 4)
                .and_then(|turn| turn.try_into().ok());
            let turn = turn.and_then(xform::turned).unwrap_or_default();
            let scale: Option<[f64; 3]> = scales
                .get(3 * at..3 * at + 3)
                .and_then(|scale| scale.try_into().ok());
            let scale = AffineTransform::scale(scale.unwrap_or([1.0; 3]));
            let all = AffineTransform::translation(position)
                .after(&turn)
                .after(&scale);
            all.0.iter().all(|column| column.is_finite()).then_some(all)
        };
        // The instances of each prototype.
        let mut instances = vec![Vec::new(); prototypes.len()];
        for (at, index) in indices.iter().enumerate() {
            let id = ids.as_ref().and_then(|ids| ids.get(at).copied());
            if let Some(of_one) = instances.get_mut(*index)
                && !hidden.contains(&id.unwrap_or(at))
            {
                of_one.push(at);
            }
        }
        for (path, instances) in prototypes.iter().zip(instances) {
            let shapes = self.prototype_shapes(path, prim, state);
            for at in instances {
                let Some(local) = place(at) else { continue };
                let outer = state.to_world.after(&local);
                for shape in &shapes {
                    if self.place(shape, &outer).is_none() {
                        return;
                    }
                }
            }
        }
    }

    /// The shapes of a prototype in the coordinates of its instances.
    fn prototype_shapes(
        &mut self,
        path: &str,
        instancer: &ComposedPrim,
        state: &PrimState,
    ) -> Vec<StageShape> {
        if self.open_prototypes.iter().any(|open| open == path) {
            self.unsupported(
                instancer,
                "a prototype that holds the instancer",
                "it is left out",
            );
            return Vec::new();
        }
        let Some(prim) = self.prim_at(path) else {
            self.unsupported(instancer, "a prototype that is not there", "it is left out");
            return Vec::new();
        };
        if self.open_prototypes.len() >= MAX_PROTOTYPES {
            self.unsupported(
                instancer,
                "a prototype within too many others",
                "it is left out",
            );
            return Vec::new();
        }
        // A prototype is read for each instancer that names it.
        if self
            .charge(Resource::Nodes, PROTOTYPE, self.root_span)
            .is_none()
        {
            return Vec::new();
        }
        self.open_prototypes.push(path.to_owned());
        let outer = self.prototype.replace(Vec::new());
        let own = PrimState {
            to_world: AffineTransform::IDENTITY,
            ..state.clone()
        };
        if let Some(state) = self.prim(&prim, &own) {
            self.children(&prim, &state);
        }
        self.open_prototypes.pop();
        std::mem::replace(&mut self.prototype, outer).unwrap_or_default()
    }

    /// Charges a surface or a light.
    fn charge_surface(&mut self, span: Span) -> Option<()> {
        self.charge(Resource::Surfaces, 1, span)?;
        self.charge(Resource::Memory, crate::gltf::SURFACE, span)
    }
}
