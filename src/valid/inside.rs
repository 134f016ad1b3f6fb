//! Lints for a light or an eye inside a solid.
//!
//! A solid is a curved shape with an inside, or the closed surface of one object: the triangles of
//! a box, a prism or a tetrahedron, or a mesh. For the latter the generalised winding number
//! (Jacobson, Kavan, Sorkine-Hornung 2013, "Robust inside-outside segmentation using generalized
//! winding numbers", eq. 5) decides: it is ±1 inside a closed surface, 0 outside, and in between
//! for an open one.

#![expect(
    clippy::wildcard_enum_match_arm,
    reason = "every shape that is not flat is a solid of its own kind"
)]

use super::check::Checker;
use rtc_diag::{Diagnostic, codes};
use rtc_ir::{self as ir, EntityField, EntityKind, Shape, ValuePath};
use rtc_math::{Vec3, atan2};
use std::f64::consts::TAU;
use std::ops::Range;

/// The maximum number of points times primitives; beyond it the lint is skipped.
const MAX_PAIRS: usize = 1_000_000;

/// A solid of the scene.
struct Solid {
    /// Its surfaces.
    surfaces: Range<usize>,
    /// Its kind, for a message.
    name: &'static str,
}

/// The solids of a scene, and the mesh bounds that the test of a point needs.
pub(super) struct Solids<'s> {
    scene: &'s ir::Scene,
    mesh_boxes: Vec<[Vec3; 2]>,
    solids: Vec<Solid>,
}

impl<'s> Solids<'s> {
    /// Groups the surfaces. Surfaces that one object of the text was lowered to have one span.
    pub(super) fn new(scene: &'s ir::Scene, check: &Checker<'_>) -> Self {
        let span = |index| {
            check.span(ValuePath::new(
                EntityKind::Surface,
                index,
                EntityField::Whole,
            ))
        };
        let is_flat = |index: usize| is_flat(&scene.surfaces[index].shape);
        let mut solids = Vec::new();
        let mut start = 0;
        while start < scene.surfaces.len() {
            let object = is_flat(start).then(|| span(start)).flatten();
            let is_same =
                |index: &usize| object.is_some() && is_flat(*index) && span(*index) == object;
            let end = (start + 1..scene.surfaces.len()).find(|index| !is_same(index));
            let surfaces = start..end.unwrap_or(scene.surfaces.len());
            let shape = &scene.surfaces[start].shape;
            let name = match (shape, surfaces.len()) {
                (Shape::Triangle(_) | Shape::Quad(_), 2..) => Some("solid"),
                (Shape::Instance(_), _) => Some("mesh"),
                (Shape::Triangle(_) | Shape::Quad(_) | Shape::Plane(_) | Shape::Disc(_), _) => None,
                _ => Some(shape.kind().name()),
            };
            start = surfaces.end;
            solids.extend(name.map(|name| Solid { surfaces, name }));
        }
        Self {
            scene,
            mesh_boxes: scene.mesh_boxes(),
            solids,
        }
    }

    /// The number of primitives that one point is tested against.
    fn cost(&self) -> usize {
        let primitives = |surface: &ir::Surface| match &surface.shape {
            Shape::Instance(instance) => self
                .scene
                .meshes
                .get(instance.mesh.0 as usize)
                .map_or(0, |mesh| mesh.triangles.len()),
            _ => 1,
        };
        let surfaces = self.solids.iter().flat_map(|solid| self.surfaces(solid));
        surfaces.map(primitives).sum()
    }

    fn surfaces(&self, solid: &Solid) -> &'s [ir::Surface] {
        &self.scene.surfaces[solid.surfaces.clone()]
    }

    /// Whether a point is inside a solid.
    fn contains(&self, solid: &Solid, point: Vec3) -> bool {
        let surfaces = self.surfaces(solid);
        let shape = &surfaces[0].shape;
        if !is_flat(shape) {
            return shape.contains(point);
        }
        let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        for surface in surfaces {
            surface
                .shape
                .corners_around(&self.mesh_boxes, &mut |corner| {
                    (low, high) = (low.min(corner), high.max(corner));
                });
        }
        if point.cmple(low).any() || point.cmpge(high).any() {
            return false;
        }
        let mut angle = 0.0;
        for surface in surfaces {
            self.triangles(&surface.shape, &mut |corners| {
                angle += solid_angle(corners.map(|corner| corner - point));
            });
        }
        // From inside a closed surface the solid angle is that of the sphere, 4π.
        (angle.abs() - 2.0 * TAU).abs() < TAU / 2.0
    }

    /// Visits the triangles of a flat shape or of a mesh.
    fn triangles(&self, shape: &Shape, visit: &mut dyn FnMut([Vec3; 3])) {
        match shape {
            Shape::Triangle(triangle) => visit(triangle.vertices.map(Vec3::from_array)),
            Shape::Quad(quad) => {
                let [a, b, c, d] = quad.vertices.map(Vec3::from_array);
                visit([a, b, c]);
                visit([a, c, d]);
            }
            Shape::Instance(instance) => {
                let Some(mesh) = self.scene.meshes.get(instance.mesh.0 as usize) else {
                    return;
                };
                let [x, y, z, origin] = instance.world_from_object.map(Vec3::from_array);
                let positions: Vec<Vec3> = mesh
                    .positions
                    .iter()
                    .map(|[u, v, w]| x * u + y * v + z * w + origin)
                    .collect();
                let corner = |index: u32| positions.get(index as usize).copied();
                for [a, b, c] in mesh.triangles.iter().copied() {
                    if let (Some(a), Some(b), Some(c)) = (corner(a), corner(b), corner(c)) {
                        visit([a, b, c]);
                    }
                }
            }
            _ => {}
        }
    }
}

/// Whether a shape consists of triangles.
fn is_flat(shape: &Shape) -> bool {
    matches!(
        shape,
        Shape::Triangle(_) | Shape::Quad(_) | Shape::Instance(_)
    )
}

/// The signed solid angle of a triangle as seen from the origin, in steradians (van Oosterom,
/// Strackee 1983, "The solid angle of a plane triangle", eq. 8).
fn solid_angle([a, b, c]: [Vec3; 3]) -> f64 {
    let [la, lb, lc] = [a, b, c].map(Vec3::length);
    let volume = a.dot(b.cross(c));
    let scale = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
    2.0 * atan2(volume, scale)
}

/// Reports each light inside a solid: with shadows, the solid blocks all its light to the outside.
/// A solid that also contains the eye is a room.
pub(super) fn lights(solids: &Solids<'_>, check: &mut Checker<'_>) {
    let scene = solids.scene;
    if !scene.settings.shadows {
        return;
    }
    // Skip scenes that would take too long.
    if scene.lights.len().saturating_mul(solids.cost()) > MAX_PAIRS {
        return;
    }
    let eye = Vec3::from_array(scene.camera.eye);
    // Find a solid that encloses the light but not the eye.
    for (index, light) in scene.lights.iter().enumerate() {
        let Some(light) = light.point() else { continue };
        let light = Vec3::from_array(light.position);
        let blocks = |solid: &&Solid| {
            let casts_shadow = |surface: &ir::Surface| !surface.casts_no_shadow;
            solids.surfaces(solid).iter().all(casts_shadow)
                && solids.contains(solid, light)
                && !solids.contains(solid, eye)
        };
        let Some(solid) = solids.solids.iter().find(blocks) else {
            continue;
        };
        // Report it.
        let name = solid.name;
        let message = format!("a light is inside a {name}");
        let diagnostic = Diagnostic::new(&codes::LIGHT_INSIDE, message);
        let span = check.span(ValuePath::new(
            EntityKind::Surface,
            solid.surfaces.start,
            EntityField::Whole,
        ));
        check.report(
            ValuePath::new(EntityKind::Light, index, EntityField::Position),
            &format!("with shadows, nothing outside the {name} receives this light"),
            diagnostic.also(span, format!("the {name}")),
        );
    }
}

/// Reports an eye inside an opaque solid that contains no other object.
pub(super) fn eye(solids: &Solids<'_>, check: &mut Checker<'_>) {
    let scene = solids.scene;
    // Find an opaque solid that encloses the eye.
    if solids.cost() > MAX_PAIRS {
        return;
    }
    let eye = Vec3::from_array(scene.camera.eye);
    let is_opaque = |surface: &ir::Surface| {
        let material = scene.materials.get(surface.material.0 as usize);
        let phong = material.and_then(ir::Material::phong);
        phong.is_some_and(|phong| phong.kt == 0.0)
    };
    let encloses = |solid: &&Solid| {
        solids.surfaces(solid).iter().all(is_opaque) && solids.contains(solid, eye)
    };
    let Some(solid) = solids.solids.iter().find(encloses) else {
        return;
    };
    // It must not contain any other object.
    let outside = |(at, _): &(usize, _)| !solid.surfaces.contains(at);
    let others = scene.surfaces.iter().enumerate().filter(outside);
    if solids.cost().saturating_mul(others.clone().count()) > MAX_PAIRS {
        return;
    }
    let mut is_alone = true;
    for (_, other) in others.clone() {
        // A plane has no bounds: it passes through the whole scene, and its part inside is visible.
        let mut is_bounded = false;
        other
            .shape
            .corners_around(&solids.mesh_boxes, &mut |corner| {
                is_bounded = true;
                is_alone = is_alone && !solids.contains(solid, corner);
            });
        is_alone &= is_bounded;
    }
    if !is_alone || others.count() == 0 {
        return;
    }
    // Report it.
    let name = solid.name;
    let message = format!("the eye is inside a {name} that hides all other objects");
    let span = check.span(ValuePath::new(
        EntityKind::Surface,
        solid.surfaces.start,
        EntityField::Whole,
    ));
    let diagnostic = Diagnostic::new(&codes::EYE_INSIDE, message).also(span, format!("the {name}"));
    check.report(
        ValuePath::new(EntityKind::Camera, 0, EntityField::Eye),
        "every ray starts in there",
        diagnostic,
    );
}
