//! The proof of the shapes: radii above 0, normals with a direction, triangles with an area.

use super::check::{Check, SMALLEST, place};
use crate::diag::Diagnostic;
use crate::diag::codes;
use crate::ir::{self, Field, Noun};
use crate::math::{Positive, Vec3, cross, unit_scale};

/// A shape and the index of its material.
#[derive(Clone, Debug)]
pub struct Surface {
    /// Its form and place.
    pub shape: Shape,
    /// An index into [`super::ValidScene::materials`], in range.
    pub material: usize,
}

/// A shape of any kind.
#[derive(Clone, Debug)]
pub enum Shape {
    /// A sphere.
    Sphere(Sphere),
    /// An infinite plane.
    Plane(Plane),
    /// A triangle with an area.
    Triangle(Triangle),
}

/// A sphere.
#[derive(Clone, Copy, Debug)]
pub struct Sphere {
    /// Its centre.
    pub center: Vec3,
    /// Its radius.
    pub radius: Positive,
}

/// An infinite plane.
#[derive(Clone, Copy, Debug)]
pub struct Plane {
    /// A point of it.
    pub center: Vec3,
    /// Its normal, of any length but 0.
    pub normal: Vec3,
}

/// A triangle whose corners are not in line.
#[derive(Clone, Copy, Debug)]
pub struct Triangle {
    /// The corners; the normal is (v1 − v0) × (v2 − v0).
    pub vertices: [Vec3; 3],
}

/// `Some(None)` for a triangle without an area: nothing can hit it, so it is warned about and left out.
pub(super) fn surface(
    surface: &ir::Surface,
    index: usize,
    materials: usize,
    check: &mut Check<'_>,
) -> Option<Option<Surface>> {
    let ir::Surface { shape, material } = surface;
    let material = handle(material.0, index, materials, check);
    let shape = match shape {
        ir::Shape::Sphere(shape) => sphere(shape, index, check).map(Some),
        ir::Shape::Plane(shape) => plane(shape, index, check).map(Some),
        ir::Shape::Triangle(shape) => triangle(shape, index, check),
    };
    let material = material?;
    Some(shape?.map(|shape| Surface { shape, material }))
}

fn handle(material: u32, index: usize, materials: usize, check: &mut Check<'_>) -> Option<usize> {
    let found = usize::try_from(material).ok().filter(|material| *material < materials);
    if found.is_none() {
        let message = format!("material {material} does not exist: the scene has {materials}");
        let finding = Diagnostic::new(&codes::BAD_HANDLE, message);
        check.report(place(Noun::Surface, index, Field::Material), "", finding);
    }
    found
}

fn sphere(sphere: &ir::Sphere, index: usize, check: &mut Check<'_>) -> Option<Shape> {
    let ir::Sphere { center, radius } = sphere;
    let center = check.vector(*center, place(Noun::Surface, index, Field::SphereCenter));
    let radius = check.length(*radius, place(Noun::Surface, index, Field::SphereRadius), &codes::RADIUS, "radius");
    Some(Shape::Sphere(Sphere { center: center?, radius: radius? }))
}

fn plane(plane: &ir::Plane, index: usize, check: &mut Check<'_>) -> Option<Shape> {
    let ir::Plane { center, normal } = plane;
    let center = check.vector(*center, place(Noun::Surface, index, Field::PlaneCenter));
    let at_normal = place(Noun::Surface, index, Field::PlaneNormal);
    let normal = check.finite_vector(*normal, at_normal)?;
    if normal == Vec3::ZERO {
        let finding = Diagnostic::new(&codes::ZERO_NORMAL, "the normal of a plane is the zero vector");
        check.report(at_normal, "it has no direction", finding.hint("a floor has the normal `[0, 1, 0]`"));
        return None;
    }
    Some(Shape::Plane(Plane { center: center?, normal }))
}

fn triangle(triangle: &ir::Triangle, index: usize, check: &mut Check<'_>) -> Option<Option<Shape>> {
    const FIELDS: [Field; 3] = [Field::TriangleVertex0, Field::TriangleVertex1, Field::TriangleVertex2];
    let ir::Triangle { vertices } = triangle;
    let corner = |k: usize, check: &mut Check<'_>| check.vector(vertices[k], place(Noun::Surface, index, FIELDS[k]));
    let (a, b, c) = (corner(0, check), corner(1, check), corner(2, check));
    let vertices = [a?, b?, c?];
    if has_area(vertices) {
        return Some(Some(Shape::Triangle(Triangle { vertices })));
    }
    let finding = Diagnostic::new(&codes::DEGENERATE_TRIANGLE, "a triangle has no area, so nothing shows of it");
    let finding = finding.hint("give it three corners that are not in line, or remove it");
    check.report(place(Noun::Surface, index, Field::Whole), "its corners are in line", finding);
    Some(None)
}

fn has_area([a, b, c]: [Vec3; 3]) -> bool {
    let (first, second) = (b - a, c - a);
    let Some((first, p)) = unit_scale(first) else { return false };
    let Some((second, q)) = unit_scale(second) else { return false };
    // Edges so short that their products leave the range of f64 count as none.
    let shortest = f64::from(p.min(q)) > f64::from(libm::ilogb(SMALLEST));
    shortest && cross(first, second) != Vec3::ZERO
}
