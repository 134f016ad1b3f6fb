//! Shapes: spheres and discs as they are, others as meshes.

use super::Lowering;
use super::one_sided::OneSided;
use super::plugins::SHAPES;
use super::xml::PluginNode;
use crate::exchange::transform::AffineTransform;
use crate::exchange::{SURFACE_BYTES, round, tessellate};
use crate::mesh::PlyColors;
use rtc_ir::{EntityKind, Material, MaterialId, Mesh, MeshId, Scene, Shape, Surface, VertexColumn};
use rtc_math::Vec3;
use rtc_source::Resource;
use std::collections::{BTreeMap, BTreeSet};

/// The deepest nesting of shape groups.
const MAX_DEPTH: usize = 8;

impl<'run> Lowering<'run> {
    /// A shape of the scene, placed by `outer`.
    pub(super) fn shape(&mut self, node: &'run PluginNode, outer: AffineTransform) {
        self.shape_at(node, &outer, 0);
    }

    fn shape_at(&mut self, node: &'run PluginNode, outer: &AffineTransform, depth: usize) {
        // Charge each visit and what it looks through, as groups of groups multiply.
        let parts = (node.children.len() + node.properties.len()) as u64;
        let charges = [
            (Resource::Surfaces, 1),
            (Resource::Memory, SURFACE_BYTES),
            (Resource::Nodes, parts),
        ];
        let is_charged = charges
            .into_iter()
            .all(|(resource, amount)| self.charge(resource, amount, node.span).is_some());
        if !is_charged {
            return;
        }
        let to_world = outer.after(&node.transform("to_world"));
        match SHAPES.known(&node.plugin.text) {
            // A group is shown where an instance refers to it.
            "shapegroup" => {}
            "instance" => self.instance(node, &to_world, depth),
            _ => self.surface(node, to_world),
        }
    }

    fn instance(&mut self, node: &'run PluginNode, to_world: &AffineTransform, depth: usize) {
        let group = node
            .children
            .iter()
            .find_map(|child| match child.tag.as_str() {
                "ref" => self.resolve(child),
                "shape" => Some(child),
                _ => None,
            });
        let group = group.filter(|group| group.plugin.text == "shapegroup");
        let Some(group) = group.filter(|_| depth < MAX_DEPTH) else {
            return self.unsupported(node, "it refers to no shape group, and is left out");
        };
        for shape in group.children.iter().filter(|child| child.tag == "shape") {
            if self.is_exhausted {
                return;
            }
            self.shape_at(shape, to_world, depth + 1);
        }
    }

    fn surface(&mut self, node: &'run PluginNode, to_world: AffineTransform) {
        let emitter = self.area_emitter(node);
        let plugin = SHAPES.known(&node.plugin.text);
        let is_similar = to_world.similarity().is_some();
        // Mitsuba flips the v of OBJ files, so that v points down as in its pictures; the v of its
        // spheres points down, too.
        let flip = plugin == "obj" && node.flag("flip_tex_coords").unwrap_or(true)
            || plugin == "ply" && node.flag("flip_tex_coords").unwrap_or(false)
            || plugin == "sphere" && is_similar;
        // A mesh that is reflected has its front where its triangles run counterclockwise.
        let is_reflected = to_world.determinant() < 0.0;
        let is_flipped = node.flag("flip_normals") == Some(true);
        let bsdf = self.bsdf_of(node);
        let has_one_side = bsdf.is_none_or(|bsdf| !self.has_two_sides(bsdf));
        // The front of a sphere cannot be inside: it gets a cover.
        let is_turned = is_flipped && !is_reflected && has_one_side && plugin != "sphere";
        let is_seen_behind = is_reflected || is_flipped && !is_turned;
        let media = self.media_of(node, is_seen_behind);
        let Some(material) = self.material(node, emitter, [flip, is_seen_behind], media) else {
            if emitter.is_some() {
                self.approximate(node.span, "a light whose BSDF is `null` is left out");
            }
            return;
        };
        let has_maps = match self.scene.materials.get(material.0 as usize) {
            Some(Material::Standard(standard)) => standard.maps().next().is_some(),
            _ => false,
        };
        let geometry = match plugin {
            "sphere" => self.sphere(node, &to_world, has_maps),
            "disk" => self.disk(node, &to_world, has_maps),
            "rectangle" => self.built("rectangle", tessellate::rectangle, &to_world),
            "cube" => self.built("cube", tessellate::cube, &to_world),
            "cylinder" => self.cylinder(node, &to_world),
            "obj" | "ply" | "serialized" => self.mesh(node, &to_world),
            _ => {
                self.unsupported(node, "it is left out");
                None
            }
        };
        let Some(mut shape) = geometry else { return };
        match &mut shape {
            Shape::Disc(disc) if is_turned => {
                disc.normal = disc.normal.map(|coordinate| -coordinate);
            }
            Shape::Instance(_) if is_turned => {
                self.turned.insert(self.scene.surfaces.len());
            }
            _ => {}
        }
        let material = self.face_forward(node, material);
        if node.flag("face_normals") == Some(true) {
            self.flat.insert(self.scene.surfaces.len());
        }
        let is_inside = is_flipped && has_one_side && plugin == "sphere";
        if emitter.is_some() || is_inside {
            let back = self.back_material(node, flip);
            self.one_sided.push(OneSided {
                surface: self.scene.surfaces.len(),
                back,
                to_world,
                is_flipped,
                is_turned,
                span: node.span,
            });
        }
        self.record(EntityKind::Surface, self.scene.surfaces.len(), node.span);
        self.scene.surfaces.push(Surface::new(shape, material));
    }

    /// `face_normals` and `flip_normals` do not change two-sided surfaces.
    fn face_forward(&mut self, node: &PluginNode, material: MaterialId) -> MaterialId {
        let is_flipped = node.flag("flip_normals") == Some(true);
        let transmits = match self.scene.materials.get(material.0 as usize) {
            Some(Material::Standard(standard)) => standard.transmission > 0.0,
            _ => false,
        };
        if is_flipped && transmits {
            self.approximate(node.span, "`flip_normals` of glass has no effect");
        }
        material
    }

    fn mesh(&mut self, node: &'run PluginNode, to_world: &AffineTransform) -> Option<Shape> {
        let Some(path) = node.string("filename") else {
            self.unsupported(node, "it names no file, and is left out");
            return None;
        };
        let mesh = match node.plugin.text.as_str() {
            "serialized" => self.serialized_mesh(path, node.count("shape_index").unwrap_or(0))?,
            "ply" => match self.mesh_colors(node) {
                Some(colors) => self.colored_mesh(path, colors)?,
                None => self.mesh_file(path),
            },
            _ => self.mesh_file(path),
        };
        Some(to_world.instance(mesh))
    }

    /// Which colours of its mesh a texture of the BSDF of a shape shows.
    fn mesh_colors(&mut self, shape: &'run PluginNode) -> Option<PlyColors> {
        let bsdf = self.bsdf_of(shape)?;
        match self.contents(bsdf, 0).attribute? {
            "vertex_color" => Some(PlyColors::Vertices),
            "face_color" => Some(PlyColors::Faces),
            _ => None,
        }
    }

    /// A shape that is a mesh made here, once for all its uses.
    fn built(
        &mut self,
        name: &'static str,
        make: fn() -> Mesh,
        to_world: &AffineTransform,
    ) -> Option<Shape> {
        let mesh = match self.built.get(name) {
            Some(id) => *id,
            None => {
                let id = self.add_mesh(make());
                self.built.insert(name, id);
                id
            }
        };
        Some(to_world.instance(mesh))
    }

    /// A sphere, or an ellipsoid; one that is scaled unevenly and textured is a mesh.
    fn sphere(
        &mut self,
        node: &'run PluginNode,
        to_world: &AffineTransform,
        has_maps: bool,
    ) -> Option<Shape> {
        let center = node.vector("center").unwrap_or([0.0; 3]);
        let radius = node.number("radius").unwrap_or(1.0);
        if has_maps && to_world.similarity().is_none() {
            self.approximate(node.span, "the sphere is shown as a mesh of 4096 triangles");
            let local =
                AffineTransform::translation(center).after(&AffineTransform::scale([radius; 3]));
            return self.built("sphere", tessellate::sphere, &to_world.after(&local));
        }
        let placed = to_world.after(&AffineTransform::translation(center));
        Some(round::sphere(radius, &placed))
    }

    /// A disc; one that becomes an ellipse, or is textured, is a mesh.
    fn disk(
        &mut self,
        node: &'run PluginNode,
        to_world: &AffineTransform,
        has_maps: bool,
    ) -> Option<Shape> {
        match round::disc(0.0, 1.0, to_world).filter(|_| !has_maps) {
            Some(disc) => Some(Shape::Disc(disc)),
            None => {
                self.approximate(node.span, "the disk is shown as a mesh of 128 triangles");
                self.built("disk", tessellate::disk, to_world)
            }
        }
    }

    /// A cylinder from `p0` to `p1`, open at both ends.
    fn cylinder(&mut self, node: &'run PluginNode, to_world: &AffineTransform) -> Option<Shape> {
        self.approximate(
            node.span,
            "the cylinder is shown as a mesh of 256 triangles",
        );
        let point = |name, default| Vec3::from_array(node.vector(name).unwrap_or(default));
        let (p0, p1) = (point("p0", [0.0; 3]), point("p1", [0.0, 0.0, 1.0]));
        let radius = node.number("radius").unwrap_or(1.0);
        let local = tessellate::along(p0, p1, radius)?;
        self.built("cylinder", tessellate::cylinder, &to_world.after(&local))
    }
}

/// Removes the vertex normals of the meshes of some surfaces.
pub(super) fn flatten(scene: &mut Scene, flat: &BTreeSet<usize>) {
    change_meshes(scene, flat, |mesh| {
        (!mesh.normals.is_empty()).then(|| Mesh {
            normals: VertexColumn::default(),
            ..mesh.clone()
        })
    });
}

/// Makes the backs of the meshes of some surfaces their fronts.
pub(super) fn turn_round(scene: &mut Scene, turned: &BTreeSet<usize>) {
    change_meshes(scene, turned, |mesh| {
        let normals = mesh.normals.iter().map(|normal| normal.map(|part| -part));
        let triangles = mesh.triangles.iter().map(|[a, b, c]| [*a, *c, *b]);
        Some(Mesh {
            // It is no longer that of its file.
            name: String::new(),
            normals: VertexColumn::rounded(normals),
            triangles: triangles.collect::<Vec<_>>().into(),
            ..mesh.clone()
        })
    });
}

/// Changes the meshes of some surfaces. A mesh that other surfaces share is copied.
fn change_meshes(
    scene: &mut Scene,
    changed: &BTreeSet<usize>,
    change: impl Fn(&Mesh) -> Option<Mesh>,
) {
    // Find the meshes that other surfaces share.
    let mesh_of = |surface: &Surface| match &surface.shape {
        Shape::Instance(instance) => Some(instance.mesh),
        _ => None,
    };
    let others: BTreeSet<u32> = scene
        .surfaces
        .iter()
        .enumerate()
        .filter(|(index, _)| !changed.contains(index))
        .filter_map(|(_, surface)| mesh_of(surface).map(|mesh| mesh.0))
        .collect();
    let mut made: BTreeMap<u32, MeshId> = BTreeMap::new();
    for index in changed {
        let Some(MeshId(mesh)) = scene.surfaces.get(*index).and_then(mesh_of) else {
            continue;
        };
        let id = match made.get(&mesh) {
            Some(known) => *known,
            None => {
                let Some(new) = scene.meshes.get(mesh as usize).and_then(&change) else {
                    continue;
                };
                let id = match others.contains(&mesh) {
                    true => MeshId(rtc_math::to_u32(scene.meshes.len())),
                    false => MeshId(mesh),
                };
                match scene.meshes.get_mut(id.0 as usize) {
                    Some(own) => *own = new,
                    None => scene.meshes.push(new),
                }
                made.insert(mesh, id);
                id
            }
        };
        if let Shape::Instance(instance) = &mut scene.surfaces[*index].shape {
            instance.mesh = id;
        }
    }
}
