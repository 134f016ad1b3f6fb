//! Writes surfaces: spheres, cylinders, disks, bilinear patches and meshes; triangles become one
//! mesh per material. A mesh that is shown several times is an object with instances.

use super::material::medium_names;
use super::{PbrtWriter, numbers, string};
use crate::path_tracer::{
    PathTracerShape, SurfaceMaterial, TexturedFactor, basic_shapes, is_null, opacity, radiance,
};
use crate::picture::TexturePicture;
use rtc_ir::{Disc, Ellipsoid, EntityField, EntityKind, Instance, Sphere, Standard, ValuePath};
use rtc_math::{OrthonormalBasis, Vec3, unit};
use std::collections::BTreeMap;

/// How often a mesh is shown with a material.
type InstanceCounts = BTreeMap<(u32, SurfaceMaterial), usize>;

impl PbrtWriter<'_> {
    /// Writes all surfaces; `None` if a mesh exceeds the budget, which is reported.
    pub(super) fn surfaces(&mut self) -> Option<()> {
        let shapes = basic_shapes(self.scene, "pbrt", &mut self.beside.reporter);
        let mut counts = InstanceCounts::new();
        for (material, shape) in &shapes {
            if let PathTracerShape::Instance(instance) = shape {
                *counts.entry((instance.mesh.0, *material)).or_default() += 1;
            }
        }
        for (material, shape) in &shapes {
            self.surface(*material, shape, &counts)?;
        }
        for (material, triangle_soup) in std::mem::take(&mut self.triangle_soups) {
            let name = self.beside.triangles(triangle_soup, material.material)?;
            self.shape(material, None, &mesh(&name))?;
        }
        Some(())
    }

    fn surface(
        &mut self,
        material: SurfaceMaterial,
        shape: &PathTracerShape<'_>,
        counts: &InstanceCounts,
    ) -> Option<()> {
        match shape {
            PathTracerShape::Sphere(sphere) => self.sphere(sphere, material),
            PathTracerShape::Ellipsoid(ellipsoid) => self.ellipsoid(ellipsoid, material),
            PathTracerShape::Tube { ends, radius } => self.tube(*ends, *radius, material),
            PathTracerShape::Disc(disc) => self.disc(disc, material),
            PathTracerShape::Quad([a, b, c, d]) => {
                // The corners of pbrt's patches are (0, 0), (1, 0), (0, 1) and (1, 1).
                let corners = [a, b, d, c]
                    .into_iter()
                    .flat_map(|corner| corner.to_array());
                let corners = numbers("point3", "P", corners);
                self.shape(material, None, &format!(r#""bilinearmesh"{corners}"#))
            }
            PathTracerShape::Triangle(_) => {
                let triangle_soup = self.triangle_soups.entry(material).or_default();
                triangle_soup.append(shape.triangles().unwrap_or_default());
                Some(())
            }
            PathTracerShape::Instance(instance) => self.instance(instance, material, counts),
        }
    }

    /// Writes a shape with its material, emission, interior and transform.
    fn shape(
        &mut self,
        variant: SurfaceMaterial,
        world_from_object: Option<[Vec3; 4]>,
        shape: &str,
    ) -> Option<()> {
        let material = self.shown(variant);
        let opacity = self.opacity(variant, &material)?;
        let radiance = radiance(&material, false);
        self.shines |= radiance.is_some();
        let emitted = radiance.map(|radiance| {
            let color = numbers("rgb", "L", self.mean(radiance));
            format!(r#"AreaLightSource "diffuse"{color} "bool twosided" true"#)
        });
        self.attributes(|writer| {
            writer.state(variant, &material);
            if let Some(emitted) = emitted {
                writer.line(&emitted);
            }
            if let Some(columns) = world_from_object {
                writer.placed(columns);
            }
            writer.line(&format!("Shape {shape}{opacity}"));
        });
        Some(())
    }

    /// The material and the interior of the shapes that follow.
    fn state(&mut self, variant: SurfaceMaterial, material: &Standard) {
        let id = variant.id();
        self.line(&format!(r#"NamedMaterial "{id}""#));
        let [interior, exterior] = medium_names(variant, material);
        if !(interior.is_empty() && exterior.is_empty()) {
            self.line(&format!(r#"MediumInterface "{interior}" "{exterior}""#));
        }
    }

    /// The opacity as a parameter of the shape.
    fn opacity(&mut self, variant: SurfaceMaterial, material: &Standard) -> Option<String> {
        let Some(opacity) = opacity(material, false).filter(|_| !is_null(material)) else {
            return Some(String::new());
        };
        let index = variant.material as usize;
        let path = ValuePath::new(EntityKind::Material, index, EntityField::Whole);
        self.slot("alpha", opacity, path)
    }

    /// The mean of a colour.
    fn mean(&self, slot: TexturedFactor<'_>) -> [f64; 3] {
        let Some(map) = slot.map else {
            return slot.factor;
        };
        let picture = TexturePicture::new(self.scene, &self.beside.areas, map.texture);
        let mean = picture.mean(slot.channel.coding());
        std::array::from_fn(|channel| slot.factor[channel] * mean[channel])
    }

    fn sphere(&mut self, sphere: &Sphere, material: SurfaceMaterial) -> Option<()> {
        let center = Vec3::from_array(sphere.center);
        let columns = [Vec3::X, Vec3::Y, Vec3::Z, center];
        let radius = numbers("float", "radius", [sphere.radius]);
        self.shape(material, Some(columns), &format!(r#""sphere"{radius}"#))
    }

    fn ellipsoid(&mut self, ellipsoid: &Ellipsoid, material: SurfaceMaterial) -> Option<()> {
        let [x, y, z] = ellipsoid.axes.map(Vec3::from_array);
        let columns = [x, y, z, Vec3::from_array(ellipsoid.center)];
        let radius = numbers("float", "radius", [1.0]);
        self.shape(material, Some(columns), &format!(r#""sphere"{radius}"#))
    }

    fn disc(&mut self, disc: &Disc, material: SurfaceMaterial) -> Option<()> {
        let normal = unit(Vec3::from_array(disc.normal)).unwrap_or(Vec3::Z);
        let columns = along(normal, Vec3::from_array(disc.center));
        let radius = numbers("float", "radius", [disc.radius]);
        self.shape(material, Some(columns), &format!(r#""disk"{radius}"#))
    }

    fn tube(&mut self, [base, top]: [Vec3; 2], radius: f64, of: SurfaceMaterial) -> Option<()> {
        let axis = unit(top - base).unwrap_or(Vec3::Z);
        let parameters = [
            numbers("float", "radius", [radius]),
            numbers("float", "zmin", [0.0]),
            numbers("float", "zmax", [(top - base).length()]),
        ];
        let shape = format!(r#""cylinder"{}"#, parameters.concat());
        self.shape(of, Some(along(axis, base)), &shape)
    }

    /// A mesh; one that is shown several times is an object, unless it emits light, which objects
    /// do not.
    fn instance(
        &mut self,
        instance: &Instance,
        variant: SurfaceMaterial,
        counts: &InstanceCounts,
    ) -> Option<()> {
        if self.scene.meshes[instance.mesh.0 as usize]
            .triangles
            .is_empty()
        {
            return Some(());
        }
        let material = self.shown(variant);
        let file = self.beside.mesh(instance.mesh, variant, &material, None)?;
        let columns = instance.world_from_object.map(Vec3::from_array);
        let is_alone = counts
            .get(&(instance.mesh.0, variant))
            .is_none_or(|count| *count == 1);
        if is_alone || radiance(&material, false).is_some() {
            return self.shape(variant, Some(columns), &mesh(&file));
        }
        let object = self.object(file, variant, &material)?;
        self.attributes(|writer| {
            writer.placed(columns);
            writer.line(&format!(r#"ObjectInstance "{object}""#));
        });
        Some(())
    }

    /// The name of the object of a mesh file with a material, which is written once.
    fn object(
        &mut self,
        file: String,
        variant: SurfaceMaterial,
        material: &Standard,
    ) -> Option<String> {
        let key = (file, variant);
        if let Some(name) = self.objects.get(&key) {
            return Some(name.clone());
        }
        let opacity = self.opacity(variant, material)?;
        let name = format!("o{}", self.objects.len());
        self.line(&format!(r#"ObjectBegin "{name}""#));
        self.state(variant, material);
        self.line(&format!("Shape {}{opacity}", mesh(&key.0)));
        self.line("ObjectEnd");
        self.objects.insert(key, name.clone());
        Some(name)
    }
}

/// A mesh of a file.
fn mesh(file: &str) -> String {
    format!(r#""plymesh"{}"#, string("string", "filename", file))
}

/// The transform of a shape about +z: the direction of that axis, and the origin.
fn along(axis: Vec3, origin: Vec3) -> [Vec3; 4] {
    let basis = OrthonormalBasis::around(axis);
    [basis.tangent, basis.bitangent, axis, origin]
}
