//! Writes surfaces: spheres, cylinders, discs and meshes; shapes with corners become one mesh per
//! material.

use super::MitsubaWriter;
use super::material::{MaterialVariant, Plugin, absorption, standard, uv_set};
use super::texture::{Channel, TexturedFactor};
use crate::export::joined;
use crate::flat::{around, finite, side, split, square};
use crate::{ply, sidecar};
use rtc_ir::{
    Alpha, BoundingSphere, Column, Cylinder, Disc, EntityKind, Field, Instance, Mesh, MeshId,
    Scene, Shape, Sphere, Standard, Surface, ValuePath,
};
use rtc_math::{Basis, Vec3, is_flat, shortest, to_u32, unit};
use xxhash_rust::xxh3::xxh3_64;

/// Bytes of a PLY header, and of a triangle.
const HEAD: u64 = 512;
const TRIANGLE: u64 = 13;

/// Whether a shape is written as it is, or as Mitsuba's nearest; a mesh stands for others, and for
/// those with textures, as Mitsuba's have coordinates of their own.
pub(super) fn is_written(scene: &Scene, surface: &Surface) -> bool {
    let material = standard(&scene.materials[surface.material.0 as usize]);
    if material.maps().next().is_some() {
        return matches!(surface.shape, Shape::Instance(_));
    }
    match &surface.shape {
        Shape::Quad(quad) => is_flat(quad.vertices.map(Vec3::from_array)),
        Shape::Sphere(_)
        | Shape::Cylinder(_)
        | Shape::InfiniteCylinder(_)
        | Shape::Disc(_)
        | Shape::Plane(_)
        | Shape::Triangle(_)
        | Shape::Instance(_) => true,
        Shape::Cone(_)
        | Shape::Paraboloid(_)
        | Shape::Torus(_)
        | Shape::Ellipsoid(_)
        | Shape::Csg(_) => false,
    }
}

/// What distinguishes the file of a mesh.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct MeshFileKey {
    mesh: u32,
    /// The set of texture coordinates that is written, if any.
    set: Option<u32>,
    /// The material whose base colour multiplies the colours that are written, if any.
    colored_for: Option<u32>,
}

/// A triangle soup in world coordinates.
#[derive(Default)]
pub(super) struct TriangleSoup {
    corners: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
}

impl TriangleSoup {
    fn add(&mut self, corners: &[Vec3], triangles: &[[u32; 3]]) {
        let first = to_u32(self.corners.len());
        self.corners.extend(corners.iter().map(Vec3::to_array));
        let moved = triangles
            .iter()
            .map(|corners| corners.map(|corner| first.saturating_add(corner)));
        self.triangles.extend(moved);
    }
}

impl MitsubaWriter<'_> {
    /// Writes all surfaces; `None` if a mesh exceeds the budget, which is reported.
    pub(super) fn surfaces(&mut self) -> Option<()> {
        let (scene, around) = (self.scene, around(self.scene));
        for (index, surface) in scene.surfaces.iter().enumerate() {
            let path = ValuePath::new(EntityKind::Surface, index, Field::Whole);
            self.surface(surface, around, path)?;
        }
        for (material, TriangleSoup { corners, triangles }) in
            std::mem::take(&mut self.triangle_soups)
        {
            let mesh = Mesh {
                positions: Column::from(corners),
                triangles: triangles.into(),
                ..Mesh::default()
            };
            let index = material.material as usize;
            let path = ValuePath::new(EntityKind::Material, index, Field::Whole);
            let name = self.ply("triangles", &mesh, Vec::new(), path)?;
            self.mesh(&name, true, None, material)?;
        }
        Some(())
    }

    fn surface(
        &mut self,
        surface: &Surface,
        around: BoundingSphere,
        path: ValuePath,
    ) -> Option<()> {
        let material = MaterialVariant::of(self.scene, surface);
        match &surface.shape {
            Shape::Sphere(sphere) => self.sphere(sphere, material)?,
            Shape::Cylinder(cylinder) => self.cylinder(cylinder, material)?,
            Shape::Disc(disc) => self.disc(disc, material)?,
            Shape::Plane(plane) => {
                let width = shortest(2.0 * side(around));
                let message = format!("Mitsuba has no plane: a square {width} wide replaces it");
                self.reporter.unsupported(&message, path);
                self.corners(&square(plane, around), &[[0, 1, 2], [0, 2, 3]], material);
            }
            Shape::Triangle(triangle) => {
                let corners = triangle.vertices.map(Vec3::from_array);
                self.corners(&corners, &[[0, 1, 2]], material);
            }
            Shape::Quad(quad) if is_flat(quad.vertices.map(Vec3::from_array)) => {
                let corners = quad.vertices.map(Vec3::from_array);
                self.corners(&corners, &split(corners), material);
            }
            Shape::Instance(instance) => self.instance(instance, material, path)?,
            Shape::InfiniteCylinder(cylinder) => {
                let finite = finite(cylinder, around);
                let height = shortest(finite.height);
                let message =
                    format!("Mitsuba has no infinite cylinder: one {height} long replaces it");
                self.reporter.unsupported(&message, path);
                self.cylinder_side(&finite, material)?;
            }
            // Meshes stand for these.
            Shape::Quad(_)
            | Shape::Cone(_)
            | Shape::Paraboloid(_)
            | Shape::Torus(_)
            | Shape::Ellipsoid(_)
            | Shape::Csg(_) => {}
        }
        Some(())
    }

    fn corners(&mut self, corners: &[Vec3], triangles: &[[u32; 3]], material: MaterialVariant) {
        let triangle_soup = self.triangle_soups.entry(material).or_default();
        triangle_soup.add(corners, triangles);
    }

    /// Writes a shape: its own values, then material, emission and what it bounds.
    fn shape(
        &mut self,
        kind: &str,
        variant: MaterialVariant,
        write_parameters: impl FnOnce(&mut Self),
    ) -> Option<()> {
        self.line(1, &format!(r#"<shape type="{kind}">"#));
        write_parameters(self);
        let (id, material) = (variant.id(), variant.standard(self.scene));
        self.line(2, &format!(r#"<ref id="{id}"/>"#));
        if absorption(&material).is_some() {
            self.line(2, &format!(r#"<ref name="interior" id="{id}v"/>"#));
        }
        let radiance = match material.unlit {
            true => TexturedFactor::color(&material, variant.has_colors),
            false => TexturedFactor {
                factor: material.emissive,
                map: material.emissive_map.as_ref(),
                channel: Channel::Color,
            },
        };
        if radiance.factor != [0.0; 3] {
            self.shines = true;
            let index = variant.material as usize;
            let path = ValuePath::new(EntityKind::Material, index, Field::Whole);
            self.line(2, r#"<emitter type="area">"#);
            self.slot(3, "radiance", radiance, path)?;
            self.line(2, "</emitter>");
        }
        self.line(1, "</shape>");
        Some(())
    }

    fn sphere(&mut self, sphere: &Sphere, material: MaterialVariant) -> Option<()> {
        self.shape("sphere", material, |text| {
            text.value(2, "point", "center", &joined(sphere.center, ", "));
            text.value(2, "float", "radius", &shortest(sphere.radius));
        })
    }

    /// Mitsuba's cylinder has no caps, so they are discs.
    fn cylinder(&mut self, cylinder: &Cylinder, material: MaterialVariant) -> Option<()> {
        let [base, top] = self.cylinder_side(cylinder, material)?;
        let axis = unit(Vec3::from_array(cylinder.axis)).unwrap_or(Vec3::Z);
        for (center, normal) in [(base, -axis), (top, axis)] {
            let cap = Disc {
                center: center.to_array(),
                normal: normal.to_array(),
                radius: cylinder.radius,
            };
            self.disc(&cap, material)?;
        }
        Some(())
    }

    /// Writes the side of a cylinder; returns the centres of its ends.
    fn cylinder_side(
        &mut self,
        cylinder: &Cylinder,
        material: MaterialVariant,
    ) -> Option<[Vec3; 2]> {
        let Cylinder {
            base,
            axis,
            height,
            radius,
        } = cylinder;
        let base = Vec3::from_array(*base);
        let axis = unit(Vec3::from_array(*axis)).unwrap_or(Vec3::Z);
        let top = base + axis * *height;
        self.shape("cylinder", material, |text| {
            text.value(2, "point", "p0", &joined(base.to_array(), ", "));
            text.value(2, "point", "p1", &joined(top.to_array(), ", "));
            text.value(2, "float", "radius", &shortest(*radius));
        })?;
        Some([base, top])
    }

    /// Mitsuba's disc has radius 1 and the z axis as its normal.
    fn disc(&mut self, disc: &Disc, material: MaterialVariant) -> Option<()> {
        let normal = unit(Vec3::from_array(disc.normal)).unwrap_or(Vec3::Z);
        let basis = Basis::around(normal);
        let columns = [
            basis.tangent * disc.radius,
            basis.bitangent * disc.radius,
            normal,
            Vec3::from_array(disc.center),
        ];
        self.shape("disk", material, |text| text.placed(columns))
    }

    fn instance(
        &mut self,
        instance: &Instance,
        material: MaterialVariant,
        path: ValuePath,
    ) -> Option<()> {
        let Instance {
            mesh: id,
            world_from_object,
        } = instance;
        let mesh = &self.scene.meshes[id.0 as usize];
        if mesh.triangles.is_empty() {
            return Some(());
        }
        let name = self.file_of(*id, material, path)?;
        let columns = world_from_object.map(Vec3::from_array);
        self.mesh(&name, mesh.normals.is_empty(), Some(columns), material)
    }

    fn mesh(
        &mut self,
        name: &str,
        is_flat: bool,
        world: Option<[Vec3; 4]>,
        material: MaterialVariant,
    ) -> Option<()> {
        self.shape("ply", material, |text| {
            text.value(2, "string", "filename", name);
            if is_flat {
                text.value(2, "boolean", "face_normals", "true");
            }
            if let Some(columns) = world {
                text.placed(columns);
            }
        })
    }

    /// The file of a mesh, which is written once for each set of texture coordinates and each
    /// factor of its colours.
    fn file_of(&mut self, id: MeshId, variant: MaterialVariant, path: ValuePath) -> Option<String> {
        // Choose the texture coordinates that the material uses.
        let mesh = &self.scene.meshes[id.0 as usize];
        let material = variant.standard(self.scene);
        let set = uv_set(&material);
        let uvs = match (material.maps().next(), set) {
            (None, _) => &Column::default(),
            (Some(_), 0) => &mesh.uvs,
            (Some(_), _) => &mesh.second_uvs,
        };
        // Mitsuba applies vertex colours or a texture.
        let is_colored = variant.has_colors || variant.has_opacity;
        let shows_colors = is_colored && material.base_color_map.is_none();
        if is_colored && !shows_colors {
            let message = "the colours of the corners of a mesh are left out beside a texture";
            self.reporter.unsupported(message, path);
        }
        // Equal attributes share a file.
        let key = MeshFileKey {
            mesh: id.0,
            set: (!uvs.is_empty()).then_some(set),
            colored_for: shows_colors.then_some(variant.material),
        };
        if let Some(name) = self.meshes.get(&key) {
            return Some(name.clone());
        }
        // Write the attributes as PLY.
        let colored = (0..mesh.colors.len()).map(|at| corner(&material, mesh.colors.at(at)));
        let colors = if shows_colors {
            colored.collect()
        } else {
            Vec::new()
        };
        let bare = Mesh {
            positions: mesh.positions.clone(),
            normals: mesh.normals.clone(),
            triangles: mesh.triangles.clone(),
            uvs: uvs.clone(),
            ..Mesh::default()
        };
        let path = ValuePath::new(EntityKind::Mesh, id.0 as usize, Field::Whole);
        let name = self.ply(&mesh.name, &bare, colors, path)?;
        self.meshes.insert(key, name.clone());
        Some(name)
    }

    /// Puts a mesh beside the scene; Mitsuba calls values of these names `vertex_color` and
    /// `vertex_opacity`.
    fn ply(
        &mut self,
        of: &str,
        mesh: &Mesh,
        colors: Vec<[f64; 4]>,
        path: ValuePath,
    ) -> Option<String> {
        let colors = Column::from(colors);
        let columns = mesh.positions.bytes() + mesh.normals.bytes();
        let columns = columns + mesh.uvs.bytes() + colors.bytes();
        let bytes = columns as u64 + TRIANGLE * mesh.triangles.len() as u64 + HEAD;
        self.reporter.charge(bytes, self.budget, path)?;
        let bytes = ply::encode_with(mesh, &colors, ["r", "g", "b", "opacity_x"]);
        let name = sidecar::path(self.folder, of, "mesh", xxh3_64(&bytes), "ply");
        self.files.insert(name.clone(), bytes);
        Some(name)
    }
}

/// The colour of a corner under a material, with the opacity.
fn corner(material: &Standard, color: [f64; 4]) -> [f64; 4] {
    let base = material.base_color;
    let [r, g, b, a] = [0, 1, 2, 3].map(|channel| color[channel] * base[channel]);
    let color = Plugin::of(material).0.color(material, [r, g, b]);
    let opacity = match material.alpha {
        Alpha::Mask(cutoff) => f64::from(u8::from(a >= cutoff)),
        Alpha::Blend | Alpha::Opaque => a,
    };
    [color[0], color[1], color[2], opacity]
}
