//! Lowers a valid asset to the IR: one scene, at one time, in world coordinates, in one material
//! variant.
//!
//! `pose` evaluates the animation: the local transforms of nodes, the weights of morph targets, and
//! properties that animation pointers change. `transform` multiplies local transforms to world
//! transforms, and lists the nodes of the scene and their instances. For each node with a mesh,
//! `shape` finds its morph weights and joint matrices, `deform` applies them, and `mesh` builds
//! the IR mesh with `topology` (strips and fans to triangles), `uv` (two of the texture
//! coordinate sets) and `tangent` (MikkTSpace). `stroke` turns points and lines into meshes,
//! `splat` Gaussian splats.
//! `sweep` finds what an animation shows at all its times, for the view of an asset without a
//! camera.
//! `material` and `texture` lower materials once each. `light` and `camera` follow, and
//! `settings` reads the render settings that `rtc` writes into `extras.rtc`.

mod camera;
mod deform;
mod light;
mod material;
mod mesh;
mod pattern;
mod pose;
mod settings;
mod shape;
mod splat;
mod stroke;
mod sweep;
mod tangent;
mod texture;
mod topology;
mod transform;
mod uv;

pub(crate) use camera::{looking_at, pixel};

use super::document::Document;
use super::field::ObjectFields;
use super::primitive::Primitive;
use super::report::AssetReport;
use crate::FrontOptions;
use crate::UpAxis;
use glam::DAffine3;
use material::ImportedMaterials;
use mesh::ImportedMeshes;
use rtc_diag::codes;
use rtc_ir::{
    self as ir, EntityField, EntityKind, LoweredScene, MaterialId, Scene, SourceSpans, ValuePath,
};
use rtc_math::Vec3;
use rtc_source::Resource;
use rtc_source::tree::NodeId;
use shape::Deformations;
use splat::{SplatMeshes, is_splatted};
use std::collections::BTreeMap;
use stroke::{StrokeMeshes, is_stroked};
use transform::InstanceTransforms;

/// The bytes of a surface besides its name: in the scene, in the validated scene, and in the
/// transforms of its instances.
pub(crate) const SURFACE: u64 = 768;

/// The inputs of lowering an asset.
struct Lowering<'l, 'r, 's> {
    doc: &'l Document<'s>,
    report: &'l mut AssetReport<'r, 's>,
    scene: Scene,
    source_spans: SourceSpans,
    materials: ImportedMaterials,
    meshes: ImportedMeshes<'l>,
    strokes: StrokeMeshes,
    splats: SplatMeshes,
    shapes: Deformations,
    /// The material of each lowered primitive, in the variant.
    chosen: BTreeMap<NodeId, MaterialId>,
    /// The requested material variant.
    variant: Option<usize>,
    /// The cameras found so far.
    cameras: Vec<camera::CameraUse>,
}

/// Lowers an asset without errors.
pub(super) fn lower<'s>(
    doc: &Document<'s>,
    options: &FrontOptions,
    report: &mut AssetReport<'_, 's>,
) -> LoweredScene {
    let variant = options
        .variant
        .as_deref()
        .and_then(|name| find_variant(name, report));
    let animation = pose::chosen(doc, options, report);
    let mut pose = pose::pose(doc, (animation, options.time.unwrap_or(0.0)), report);
    let mut lowering = Lowering {
        doc,
        report,
        scene: empty(),
        source_spans: SourceSpans::default(),
        materials: ImportedMaterials::new(doc, std::mem::take(&mut pose.animated)),
        meshes: ImportedMeshes::new(),
        strokes: StrokeMeshes::default(),
        splats: SplatMeshes::default(),
        shapes: Deformations::default(),
        chosen: BTreeMap::new(),
        variant,
        cameras: Vec::new(),
    };
    let axes = options.up_axis.map(UpAxis::scene_from_file);
    let worlds = transform::worlds(doc, &pose, axes);
    let shown = transform::shown(doc);
    if shown.iter().all(|node| lowering.charge(*node)) {
        shown
            .into_iter()
            .for_each(|node| lowering.node(node, &pose, &worlds));
    }
    let strokes = &lowering.strokes;
    strokes.set_radius(&mut lowering.scene, options.point_size);
    let has_camera = lowering.camera(options.camera.as_deref());
    // Pictures of different times have one view.
    let is_framed = options.time.is_some() && !has_camera && !lowering.report.has_errors();
    let animation = animation.filter(|_| is_framed);
    let swept = animation.and_then(|animation| lowering.swept(animation, axes));
    lowering.source_spans.swept = swept.map(Box::new);
    lowering.finish()
}

/// A scene without anything, that is rendered as glTF means it.
pub(crate) fn empty() -> Scene {
    let camera = camera::looking_at(ir::BoundingSphere {
        center: Vec3::ZERO,
        radius: 1.0,
    });
    Scene::new(camera, ir::Settings::paths())
}

/// The index of the variant of this name.
fn find_variant(name: &str, report: &mut AssetReport<'_, '_>) -> Option<usize> {
    let root = ObjectFields::new(report.json, report.json.root());
    let variants = root.extension("KHR_materials_variants");
    let names: Vec<String> = variants
        .iter()
        .flat_map(|fields| fields.objects("variants"))
        .map(|one| one.name())
        .collect();
    let found = names.iter().position(|candidate| candidate == name);
    if found.is_none() {
        missing("variant", name, &names, report);
    }
    found
}

/// Reports that the command line names something that does not exist.
fn missing(entity: &str, name: &str, names: &[String], report: &mut AssetReport<'_, '_>) {
    let names: Vec<String> = names
        .iter()
        .map(|name| format!("`{}`", super::report::shown(name)))
        .collect();
    let hint = if names.is_empty() {
        "it has none".to_owned()
    } else {
        format!("it has {}", names.join(", "))
    };
    let root = report.json.root();
    let message = format!("the asset has no {entity} `{}`", super::report::shown(name));
    report.add_with_hint(&codes::GLTF_CHOSEN, "", root, message, hint);
}

impl Lowering<'_, '_, '_> {
    /// Charges the surfaces that one node shows. False if that is too much.
    fn charge(&mut self, index: usize) -> bool {
        let (doc, node) = (self.doc, &self.doc.nodes[index]);
        let Some(mesh) = node.mesh.and_then(|mesh| doc.meshes.get(mesh)) else {
            return true;
        };
        let places = node.instances.as_ref().filter(|_| node.skin.is_none());
        let count = places.map_or(1, |instances| {
            InstanceTransforms::many(doc, DAffine3::IDENTITY, instances).count()
        });
        let count = (count as u64).saturating_mul(mesh.primitives.len() as u64);
        let memory = count.saturating_mul(SURFACE + node.name.len() as u64);
        self.report
            .charge(Resource::Surfaces, count, node.at, "the node")
            && self
                .report
                .charge(Resource::Memory, memory, node.at, "the node")
    }

    /// Records the camera and lowers the light of a node with the transform `world`.
    fn camera_and_light(&mut self, index: usize, world: DAffine3) {
        let node = &self.doc.nodes[index];
        if let Some(camera) = node.camera {
            self.cameras.push(camera::CameraUse {
                camera,
                node: index,
                world,
            });
        }
        if let Some(light) = node.light.and_then(|light| self.doc.lights.get(light)) {
            self.light(*light, world);
        }
    }

    /// Lowers the mesh of one node.
    fn node(&mut self, index: usize, pose: &pose::ScenePose, worlds: &[DAffine3]) {
        let (doc, node, world) = (self.doc, &self.doc.nodes[index], worlds[index]);
        self.camera_and_light(index, world);
        let Some(mesh) = node.mesh.and_then(|mesh| doc.meshes.get(mesh)) else {
            return;
        };
        // Find the deformation and the instances of the mesh.
        let is_skinned = mesh.is_skinned() == Some(true);
        let skin = node
            .skin
            .filter(|skin| *skin < doc.skins.len() && is_skinned);
        let Some(shape) = self
            .shapes
            .of_node(doc, (index, skin), (pose, worlds), self.report)
        else {
            return;
        };
        let places = InstanceTransforms::of_node(doc, node, skin, world);
        // Lower each primitive, and place it at each instance.
        for primitive in &mesh.primitives {
            if is_splatted(primitive) {
                self.splats(primitive, &places, (&node.name, node.at));
                continue;
            }
            let material = self.material(primitive);
            let is_stroked = is_stroked(primitive);
            let tangents = self
                .materials
                .tangent_coords(material, &self.scene)
                .filter(|_| !is_stroked);
            let uv_sets = self.materials.uv_sets(material);
            let shape = (shape, self.shapes.get(shape));
            let made = mesh::RequestedMesh {
                primitive,
                name: &mesh.name,
                shape,
                tangents,
                uv_sets,
            };
            if is_stroked {
                let target = (&mut self.scene, &mut self.source_spans);
                let made = (&made, self.meshes.key(&made));
                let made = self.strokes.make(doc, made, &places, target, self.report);
                let material = self.point_and_line_material(primitive, material);
                for (id, world) in made {
                    self.surface(id, world, material, &node.name, node.at);
                }
                continue;
            }
            let Some(id) = self.meshes.make(
                doc,
                &made,
                &mut self.scene,
                &mut self.source_spans,
                self.report,
            ) else {
                continue;
            };
            for at in 0..places.count() {
                self.surface(id, places.at(at), material, &node.name, node.at);
            }
        }
    }

    /// Places a mesh, unless its transform is singular: then it is invisible.
    fn surface(
        &mut self,
        mesh: ir::MeshId,
        world: DAffine3,
        material: MaterialId,
        name: &str,
        at: NodeId,
    ) {
        if !transform::has_volume(world) {
            let message = "the node is scaled to zero, so it is invisible".to_owned();
            let hint = "raise the scale above 0, or remove the node".to_owned();
            let code = &codes::GLTF_REMARK;
            return self.report.add_with_hint(code, "", at, message, hint);
        }
        let world_from_object = world.to_cols_array_2d();
        let shape = ir::Shape::Instance(ir::Instance {
            mesh,
            world_from_object,
        });
        let place = ValuePath::new(
            EntityKind::Surface,
            self.scene.surfaces.len(),
            EntityField::Whole,
        );
        self.source_spans.record(place, self.report.json.span(at));
        let extras = ObjectFields::new(self.report.json, at).rtc_extras();
        self.scene.surfaces.push(ir::Surface {
            shape,
            material,
            casts_no_shadow: extras.is_some_and(|extras| extras.boolean("castsNoShadow")),
            velocity: extras
                .map_or([0.0; 3], |extras| extras.vector_or("velocity", [0.0; 3]))
                .into(),
        });
        self.scene.names.push(name.to_owned());
    }

    fn material(&mut self, primitive: &Primitive) -> MaterialId {
        if let Some(known) = self.chosen.get(&primitive.at) {
            return *known;
        }
        let material =
            material::chosen(primitive, self.variant, self.report.json).or(primitive.material);
        let material = material.filter(|material| *material < self.doc.materials.len());
        let made = self.materials.make(
            self.doc,
            material,
            &mut self.scene,
            &mut self.source_spans,
            self.report,
        );
        self.chosen.insert(primitive.at, made);
        made
    }

    /// The material of points or lines: seen from all sides, and without normals unlit (glTF 2.0,
    /// section 3.9.6).
    fn point_and_line_material(
        &mut self,
        primitive: &Primitive,
        material: MaterialId,
    ) -> MaterialId {
        let is_lit = primitive.find("NORMAL").is_some();
        let (id, loses_light) =
            self.materials
                .point_and_line_material(material, is_lit, &mut self.scene);
        if loses_light {
            let message =
                "points and lines without normals show their colour; their emission is ignored";
            let (code, hint) = (&codes::GLTF_MATERIAL_ODD, "add normals to the primitive");
            self.report
                .add_with_hint(code, "", primitive.at, message.to_owned(), hint.to_owned());
        }
        id
    }

    fn finish(mut self) -> LoweredScene {
        self.settings_extras();
        if self.scene.names.iter().all(String::is_empty) {
            self.scene.names.clear();
        }
        self.source_spans.finish();
        LoweredScene {
            scene: self.scene,
            source_spans: self.source_spans,
        }
    }
}
