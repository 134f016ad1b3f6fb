//! Shapes: spheres and discs as they are, others as meshes.

use super::Lowering;
use super::one_sided::OneSided;
use super::plugins::SHAPES;
use super::xml::PluginNode;
use crate::exchange::transform::AffineTransform;
use crate::exchange::{round, tessellate};
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
        // Charge each visit, as groups of groups multiply.
        if self.charge(Resource::Surfaces, node.span).is_none() {
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
        let is_seen_behind = is_reflected || node.flag("flip_normals") == Some(true);
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
        let Some(shape) = geometry else { return };
        let material = self.face_forward(node, material);
        if node.flag("face_normals") == Some(true) {
            self.flat.insert(self.scene.surfaces.len());
        }
        if emitter.is_some() {
            let back = self.back_material(node, flip);
            self.one_sided.push(OneSided {
                surface: self.scene.surfaces.len(),
                back,
                to_world,
                is_flipped: node.flag("flip_normals") == Some(true),
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
        self.ignored(node);
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
        let attribute = |node: &&PluginNode| node.plugin.text == "mesh_attribute";
        let name = match self.attributes.get(&bsdf.span) {
            Some(known) => *known,
            None => {
                let texture = self.reachable(bsdf).into_iter().find(attribute);
                let name = texture.and_then(|texture| texture.string("name"));
                let name = name.map(|name| name.text.as_str());
                self.attributes.insert(bsdf.span, name);
                name
            }
        };
        match name? {
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
        self.ignored(node);
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
        self.ignored(node);
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
        self.ignored(node);
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

/// Removes the vertex normals of the meshes of some surfaces. A mesh that other surfaces share is
/// copied.
pub(super) fn flatten(scene: &mut Scene, flat: &BTreeSet<usize>) {
    // Find the meshes that smooth surfaces share.
    let mesh_of = |surface: &Surface| match &surface.shape {
        Shape::Instance(instance) => Some(instance.mesh),
        _ => None,
    };
    let smooth: BTreeSet<u32> = scene
        .surfaces
        .iter()
        .enumerate()
        .filter(|(index, _)| !flat.contains(index))
        .filter_map(|(_, surface)| mesh_of(surface).map(|mesh| mesh.0))
        .collect();
    // Remove the normals of flat surfaces.
    let mut copies = BTreeMap::new();
    for index in flat {
        let Some(MeshId(mesh)) = scene.surfaces.get(*index).and_then(mesh_of) else {
            continue;
        };
        let Some(found) = scene.meshes.get_mut(mesh as usize) else {
            continue;
        };
        if found.normals.is_empty() {
            continue;
        }
        // A mesh that is smooth elsewhere is copied first.
        if !smooth.contains(&mesh) {
            found.normals = VertexColumn::default();
            continue;
        }
        let copy = Mesh {
            normals: VertexColumn::default(),
            ..found.clone()
        };
        let id = *copies.entry(mesh).or_insert_with(|| {
            scene.meshes.push(copy);
            MeshId(u32::try_from(scene.meshes.len() - 1).unwrap_or(u32::MAX))
        });
        if let Shape::Instance(instance) = &mut scene.surfaces[*index].shape {
            instance.mesh = id;
        }
    }
}
