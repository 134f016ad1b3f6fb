//! Writes surfaces: spheres, cylinders, discs and meshes; shapes with corners become one mesh per
//! material.

use super::MitsubaWriter;
use super::material::{MEDIA, MitsubaPlugin};
use crate::export::{called, joined};
use crate::path_tracer::{
    CornerColor, PathTracerShape, SurfaceMaterial, basic_shapes, media, radiance,
};
use rtc_ir::{Alpha, Disc, EntityField, EntityKind, Instance, Sphere, Standard, ValuePath};
use rtc_math::{OrthonormalBasis, Vec3, shortest, unit};

impl MitsubaWriter<'_> {
    /// Writes all surfaces; `None` if a mesh exceeds the budget, which is reported.
    pub(super) fn surfaces(&mut self) -> Option<()> {
        let scene = self.scene;
        for (material, shape) in basic_shapes(scene, "Mitsuba", &mut self.beside.reporter) {
            self.surface(material, &shape)?;
        }
        for (material, triangle_soup) in std::mem::take(&mut self.triangle_soups) {
            let name = self.beside.triangles(triangle_soup, material.material)?;
            self.mesh(&name, true, None, material)?;
        }
        Some(())
    }

    fn surface(&mut self, material: SurfaceMaterial, shape: &PathTracerShape<'_>) -> Option<()> {
        if let Some(triangles) = shape.triangles() {
            let triangle_soup = self.triangle_soups.entry(material).or_default();
            triangle_soup.append(triangles);
        }
        match shape {
            PathTracerShape::Sphere(sphere) => self.sphere(sphere, material),
            PathTracerShape::Tube { ends, radius } => self.tube(*ends, *radius, material),
            PathTracerShape::Disc(disc) => self.disc(disc, material),
            PathTracerShape::Instance(instance) => self.instance(instance, material),
            // Triangles are collected, and meshes replace ellipsoids.
            PathTracerShape::Quad(_)
            | PathTracerShape::Triangle(_)
            | PathTracerShape::Ellipsoid(_) => Some(()),
        }
    }

    /// Writes a shape: its own values, then material, emission and what it bounds.
    fn shape(
        &mut self,
        kind: &str,
        variant: SurfaceMaterial,
        write_parameters: impl FnOnce(&mut Self),
    ) -> Option<()> {
        self.line(1, &format!(r#"<shape type="{kind}">"#));
        write_parameters(self);
        let (id, material) = (variant.id(), variant.standard(self.scene));
        self.line(2, &format!(r#"<ref id="{id}"/>"#));
        let sides = media(&material).into_iter().zip(["interior", "exterior"]);
        for ((medium, side), letter) in sides.zip(MEDIA) {
            if medium.is_some() {
                self.line(2, &format!(r#"<ref name="{side}" id="{id}{letter}"/>"#));
            }
        }
        if let Some(radiance) = radiance(&material, variant.has_colors) {
            self.shines = true;
            let index = variant.material as usize;
            let path = ValuePath::new(EntityKind::Material, index, EntityField::Whole);
            self.line(2, r#"<emitter type="area">"#);
            self.slot(3, "radiance", radiance, path)?;
            self.line(2, "</emitter>");
        }
        self.line(1, "</shape>");
        Some(())
    }

    fn sphere(&mut self, sphere: &Sphere, material: SurfaceMaterial) -> Option<()> {
        self.shape("sphere", material, |text| {
            text.value(2, "point", "center", &joined(sphere.center, ", "));
            text.value(2, "float", "radius", &shortest(sphere.radius));
        })
    }

    fn tube(&mut self, ends: [Vec3; 2], radius: f64, material: SurfaceMaterial) -> Option<()> {
        self.shape("cylinder", material, |text| {
            for (name, end) in ["p0", "p1"].into_iter().zip(ends) {
                text.value(2, "point", name, &joined(end.to_array(), ", "));
            }
            text.value(2, "float", "radius", &shortest(radius));
        })
    }

    /// Mitsuba's disc has radius 1 and the z axis as its normal.
    fn disc(&mut self, disc: &Disc, material: SurfaceMaterial) -> Option<()> {
        let normal = unit(Vec3::from_array(disc.normal)).unwrap_or(Vec3::Z);
        let basis = OrthonormalBasis::around(normal);
        let columns = [
            basis.tangent * disc.radius,
            basis.bitangent * disc.radius,
            normal,
            Vec3::from_array(disc.center),
        ];
        self.shape("disk", material, |text| text.placed(columns))
    }

    fn instance(&mut self, instance: &Instance, variant: SurfaceMaterial) -> Option<()> {
        let Instance {
            mesh: id,
            world_from_object,
        } = instance;
        let mesh = &self.scene.meshes[id.0 as usize];
        if mesh.triangles.is_empty() {
            return Some(());
        }
        // Mitsuba applies vertex colours or a texture.
        let material = variant.standard(self.scene);
        let is_colored = variant.has_colors || variant.has_opacity;
        let shows_colors = is_colored && material.base_color_map.is_none();
        if is_colored && !shows_colors {
            let message = format!(
                "{} is written without the colours of the corners of a mesh, beside its texture",
                called(&material.name)
            );
            let index = variant.material as usize;
            let path = ValuePath::new(EntityKind::Material, index, EntityField::Whole);
            self.beside.reporter.unsupported(&message, path);
        }
        let corner = |color| corner(&material, color);
        let corner_color = shows_colors.then_some(&corner as CornerColor<'_>);
        let name = self.beside.mesh(*id, variant, &material, corner_color)?;
        let columns = world_from_object.map(Vec3::from_array);
        self.mesh(&name, mesh.normals.is_empty(), Some(columns), variant)
    }

    fn mesh(
        &mut self,
        name: &str,
        is_flat: bool,
        world: Option<[Vec3; 4]>,
        material: SurfaceMaterial,
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
}

/// The colour of a corner under a material, with the opacity.
fn corner(material: &Standard, color: [f64; 4]) -> [f64; 4] {
    let base = material.base_color;
    let [r, g, b, a] = [0, 1, 2, 3].map(|channel| color[channel] * base[channel]);
    let color = MitsubaPlugin::of(material).0.color(material, [r, g, b]);
    let opacity = match material.alpha {
        Alpha::Mask(cutoff) => f64::from(u8::from(a >= cutoff)),
        Alpha::Blend | Alpha::Opaque => a,
    };
    [color[0], color[1], color[2], opacity]
}
