//! Writes surfaces: spheres, cylinders, discs and meshes; shapes with corners become one mesh per
//! material.

use super::MitsubaWriter;
use super::material::standard;
use crate::export::joined;
use crate::flat::{around, finite, side, split, square};
use crate::{ply, sidecar};
use rtc_ir::{
    BoundingSphere, Column, Cylinder, Disc, EntityKind, Field, Instance, Mesh, MeshId, Shape,
    Sphere, Surface, ValuePath,
};
use rtc_math::{Basis, Vec3, is_flat, shortest, to_u32, unit};
use xxhash_rust::xxh3::xxh3_64;

/// Bytes of a PLY header, and of a triangle.
const HEAD: u64 = 512;
const TRIANGLE: u64 = 13;

/// Whether a shape is written exactly, or as Mitsuba's closest; other shapes are tessellated.
pub(super) fn is_written(shape: &Shape) -> bool {
    match shape {
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
            let path = ValuePath::new(EntityKind::Material, material as usize, Field::Whole);
            let name = self.ply("triangles", &mesh, path)?;
            self.mesh(&name, true, None, material);
        }
        Some(())
    }

    fn surface(
        &mut self,
        surface: &Surface,
        around: BoundingSphere,
        path: ValuePath,
    ) -> Option<()> {
        let material = surface.material.0;
        match &surface.shape {
            Shape::Sphere(sphere) => self.sphere(sphere, material),
            Shape::Cylinder(cylinder) => self.cylinder(cylinder, material),
            Shape::Disc(disc) => self.disc(disc, material),
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
            Shape::Instance(instance) => return self.instance(instance, material, path),
            Shape::InfiniteCylinder(cylinder) => {
                let finite = finite(cylinder, around);
                let height = shortest(finite.height);
                let message =
                    format!("Mitsuba has no infinite cylinder: one {height} long replaces it");
                self.reporter.unsupported(&message, path);
                self.cylinder_side(&finite, material);
            }
            // These are tessellated.
            Shape::Quad(_)
            | Shape::Cone(_)
            | Shape::Paraboloid(_)
            | Shape::Torus(_)
            | Shape::Ellipsoid(_)
            | Shape::Csg(_) => return Some(()),
        }
        self.report_two_sided_emission(material, path);
        Some(())
    }

    /// Reports an emissive surface, which in rtc emits on both sides.
    fn report_two_sided_emission(&mut self, material: u32, path: ValuePath) {
        if self.emitted(material) != [0.0; 3] {
            let message = "Mitsuba's emitters shine to the front alone, or outwards: this one \
            shines \
                           both ways";
            self.reporter.unsupported(message, path);
        }
    }

    fn emitted(&self, material: u32) -> [f64; 3] {
        standard(&self.scene.materials[material as usize]).emissive
    }

    fn corners(&mut self, corners: &[Vec3], triangles: &[[u32; 3]], material: u32) {
        let triangle_soup = self.triangle_soups.entry(material).or_default();
        triangle_soup.add(corners, triangles);
    }

    /// Writes a shape: its own values, then material and emission.
    fn shape(&mut self, kind: &str, material: u32, write_parameters: impl FnOnce(&mut Self)) {
        self.line(1, &format!(r#"<shape type="{kind}">"#));
        write_parameters(self);
        self.line(2, &format!(r#"<ref id="m{material}"/>"#));
        let emitted = self.emitted(material);
        if emitted != [0.0; 3] {
            self.line(2, r#"<emitter type="area">"#);
            self.rgb(3, "radiance", emitted);
            self.line(2, "</emitter>");
        }
        self.line(1, "</shape>");
    }

    fn sphere(&mut self, sphere: &Sphere, material: u32) {
        self.shape("sphere", material, |text| {
            text.value(2, "point", "center", &joined(sphere.center, ", "));
            text.value(2, "float", "radius", &shortest(sphere.radius));
        });
    }

    /// Mitsuba's cylinder has no caps, so they are discs.
    fn cylinder(&mut self, cylinder: &Cylinder, material: u32) {
        let [base, top] = self.cylinder_side(cylinder, material);
        let axis = unit(Vec3::from_array(cylinder.axis)).unwrap_or(Vec3::Z);
        for (center, normal) in [(base, -axis), (top, axis)] {
            let cap = Disc {
                center: center.to_array(),
                normal: normal.to_array(),
                radius: cylinder.radius,
            };
            self.disc(&cap, material);
        }
    }

    /// Writes the side of a cylinder; returns the centres of its ends.
    fn cylinder_side(&mut self, cylinder: &Cylinder, material: u32) -> [Vec3; 2] {
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
        });
        [base, top]
    }

    /// Mitsuba's disc has radius 1 and the z axis as its normal.
    fn disc(&mut self, disc: &Disc, material: u32) {
        let normal = unit(Vec3::from_array(disc.normal)).unwrap_or(Vec3::Z);
        let basis = Basis::around(normal);
        let columns = [
            basis.tangent * disc.radius,
            basis.bitangent * disc.radius,
            normal,
            Vec3::from_array(disc.center),
        ];
        self.shape("disk", material, |text| text.placed(columns));
    }

    fn instance(&mut self, instance: &Instance, material: u32, path: ValuePath) -> Option<()> {
        let Instance {
            mesh: id,
            world_from_object,
        } = instance;
        let mesh = &self.scene.meshes[id.0 as usize];
        if mesh.triangles.is_empty() {
            return Some(());
        }
        if !mesh.colors.is_empty() {
            let message = "the colours of the corners of a mesh are left out";
            self.reporter.unsupported(message, path);
        }
        let name = self.file_of(*id)?;
        let columns = world_from_object.map(Vec3::from_array);
        self.mesh(&name, mesh.normals.is_empty(), Some(columns), material);
        self.report_two_sided_emission(material, path);
        Some(())
    }

    fn mesh(&mut self, name: &str, is_flat: bool, world: Option<[Vec3; 4]>, material: u32) {
        self.shape("ply", material, |text| {
            text.value(2, "string", "filename", name);
            if is_flat {
                text.value(2, "boolean", "face_normals", "true");
            }
            if let Some(columns) = world {
                text.placed(columns);
            }
        });
    }

    /// The file of a mesh, which is written once.
    fn file_of(&mut self, id: MeshId) -> Option<String> {
        if let Some(name) = self.meshes.get(&id.0) {
            return Some(name.clone());
        }
        let mesh = &self.scene.meshes[id.0 as usize];
        let bare = Mesh {
            positions: mesh.positions.clone(),
            normals: mesh.normals.clone(),
            triangles: mesh.triangles.clone(),
            ..Mesh::default()
        };
        let path = ValuePath::new(EntityKind::Mesh, id.0 as usize, Field::Whole);
        let name = self.ply(&mesh.name, &bare, path)?;
        self.meshes.insert(id.0, name.clone());
        Some(name)
    }

    fn ply(&mut self, of: &str, mesh: &Mesh, path: ValuePath) -> Option<String> {
        let columns = mesh.positions.bytes() + mesh.normals.bytes();
        let bytes = columns as u64 + TRIANGLE * mesh.triangles.len() as u64 + HEAD;
        self.reporter.charge(bytes, self.budget, path)?;
        let bytes = ply::encode(mesh);
        let name = sidecar::path(self.folder, of, "mesh", xxh3_64(&bytes), "ply");
        self.files.insert(name.clone(), bytes);
        Some(name)
    }
}
