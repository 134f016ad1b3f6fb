//! Surfaces as shapes that path tracers have.

use super::surface_material::{SurfaceMaterial, other_material, standard};
use crate::flat::{around, finite, side, split, square};
use crate::reporter::ExportReporter;
use rtc_ir::{
    BoundingSphere, Cylinder, Disc, Ellipsoid, EntityField, EntityKind, Instance, Mesh, Scene,
    Shape, Sphere, Surface, ValuePath, VertexColumn,
};
use rtc_math::{Vec3, is_flat, shortest, to_u32, unit};

/// A shape of a path tracer.
pub(crate) enum PathTracerShape<'s> {
    Sphere(&'s Sphere),
    Ellipsoid(&'s Ellipsoid),
    /// A cylinder without caps, from the first point to the second.
    Tube {
        ends: [Vec3; 2],
        radius: f64,
    },
    Disc(Disc),
    /// A quadrilateral, by its corners in order around it.
    Quad([Vec3; 4]),
    Triangle([Vec3; 3]),
    Instance(&'s Instance),
}

impl PathTracerShape<'_> {
    /// The corners and triangles of a shape with corners.
    pub(crate) fn triangles(&self) -> Option<TriangleSoup> {
        let mut soup = TriangleSoup::default();
        match self {
            Self::Quad(corners) => soup.add(corners, &split(*corners)),
            Self::Triangle(corners) => soup.add(corners, &[[0, 1, 2]]),
            Self::Sphere(_)
            | Self::Ellipsoid(_)
            | Self::Tube { .. }
            | Self::Disc(_)
            | Self::Instance(_) => return None,
        }
        Some(soup)
    }
}

/// A triangle soup in world coordinates.
#[derive(Default)]
pub(crate) struct TriangleSoup {
    corners: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
}

impl TriangleSoup {
    fn add(&mut self, corners: &[Vec3], triangles: &[[u32; 3]]) {
        let corners = corners.iter().map(Vec3::to_array).collect();
        self.append(Self {
            corners,
            triangles: triangles.to_vec(),
        });
    }

    pub(crate) fn append(&mut self, other: Self) {
        let first = to_u32(self.corners.len());
        self.corners.extend(other.corners);
        let moved = other
            .triangles
            .into_iter()
            .map(|corners| corners.map(|corner| first.saturating_add(corner)));
        self.triangles.extend(moved);
    }

    pub(super) fn mesh(self) -> Mesh {
        Mesh {
            positions: VertexColumn::from(self.corners),
            triangles: self.triangles.into(),
            ..Mesh::default()
        }
    }
}

/// All surfaces of a scene as basic shapes, with their materials. What is infinite becomes finite,
/// which is reported; shapes that meshes replace are left out.
pub(crate) fn basic_shapes<'s>(
    scene: &'s Scene,
    renderer: &str,
    reporter: &mut ExportReporter<'_>,
) -> Vec<(SurfaceMaterial, PathTracerShape<'s>)> {
    let around = around(scene);
    let mut shapes = Vec::with_capacity(scene.surfaces.len());
    for (index, surface) in scene.surfaces.iter().enumerate() {
        let path = ValuePath::new(EntityKind::Surface, index, EntityField::Whole);
        report_finite(&surface.shape, around, (renderer, path), reporter);
        let found = parts(&surface.shape, around);
        let material = SurfaceMaterial::of(scene, surface);
        shapes.extend(found.into_iter().map(|shape| (material, shape)));
    }
    shapes
}

fn report_finite(
    shape: &Shape,
    around: BoundingSphere,
    (renderer, path): (&str, ValuePath),
    reporter: &mut ExportReporter<'_>,
) {
    let size = shortest(2.0 * side(around));
    if matches!(shape, Shape::Plane(_)) {
        let message = format!("{renderer} has no plane: a square {size} wide replaces it");
        reporter.unsupported(&message, path);
    } else if matches!(shape, Shape::InfiniteCylinder(_)) {
        let message = format!("{renderer} has no infinite cylinder: one {size} long replaces it");
        reporter.unsupported(&message, path);
    }
}

/// The basic shapes of a shape: of a cylinder its side and its caps.
fn parts(shape: &Shape, around: BoundingSphere) -> Vec<PathTracerShape<'_>> {
    match shape {
        Shape::Sphere(sphere) => vec![PathTracerShape::Sphere(sphere)],
        Shape::Ellipsoid(ellipsoid) => vec![PathTracerShape::Ellipsoid(ellipsoid)],
        Shape::Cylinder(cylinder) => {
            let [base, top] = ends(cylinder);
            let axis = unit(top - base).unwrap_or(Vec3::Z);
            let caps = [(base, -axis), (top, axis)].map(|(center, normal)| {
                PathTracerShape::Disc(Disc {
                    center: center.to_array(),
                    normal: normal.to_array(),
                    radius: cylinder.radius,
                })
            });
            [tube(cylinder)].into_iter().chain(caps).collect()
        }
        Shape::InfiniteCylinder(cylinder) => vec![tube(&finite(cylinder, around))],
        Shape::Disc(disc) => vec![PathTracerShape::Disc(disc.clone())],
        Shape::Plane(plane) => vec![PathTracerShape::Quad(square(plane, around))],
        Shape::Triangle(triangle) => {
            let corners = triangle.vertices.map(Vec3::from_array);
            vec![PathTracerShape::Triangle(corners)]
        }
        Shape::Quad(quad) => vec![PathTracerShape::Quad(quad.vertices.map(Vec3::from_array))],
        Shape::Instance(instance) => vec![PathTracerShape::Instance(instance)],
        Shape::Cone(_) | Shape::Paraboloid(_) | Shape::Torus(_) | Shape::Csg(_) => Vec::new(),
    }
}

/// The side of a cylinder.
fn tube(cylinder: &Cylinder) -> PathTracerShape<'static> {
    PathTracerShape::Tube {
        ends: ends(cylinder),
        radius: cylinder.radius,
    }
}

/// The centres of the ends of a cylinder.
fn ends(cylinder: &Cylinder) -> [Vec3; 2] {
    let base = Vec3::from_array(cylinder.base);
    let axis = unit(Vec3::from_array(cylinder.axis)).unwrap_or(Vec3::Z);
    [base, base + axis * cylinder.height]
}

/// Whether all path tracers have the shape of a surface. Their own shapes have texture coordinates
/// of their own, so a mesh replaces one whose material looks up a texture.
pub(crate) fn is_basic(scene: &Scene, surface: &Surface) -> bool {
    match &surface.shape {
        Shape::Instance(_) => true,
        _ if has_maps(scene, surface) => false,
        Shape::Quad(quad) => is_flat(quad.vertices.map(Vec3::from_array)),
        Shape::Sphere(_)
        | Shape::Cylinder(_)
        | Shape::InfiniteCylinder(_)
        | Shape::Disc(_)
        | Shape::Plane(_)
        | Shape::Triangle(_) => true,
        Shape::Ellipsoid(_)
        | Shape::Cone(_)
        | Shape::Paraboloid(_)
        | Shape::Torus(_)
        | Shape::Csg(_) => false,
    }
}

/// Whether the material of a surface looks up a texture.
pub(crate) fn has_maps(scene: &Scene, surface: &Surface) -> bool {
    let material = standard(&scene.materials[surface.material.0 as usize]);
    let mut next = Some(material.into_owned());
    while let Some(part) = next {
        if part.maps().next().is_some() {
            return true;
        }
        next = other_material(scene, &part);
    }
    false
}
