//! Lights and eyes inside solids, which hide from them what is outside, or them from it.

use super::check::{Check, place};
use rtc_diag::{Diagnostic, codes};
use rtc_ir::{self as ir, EntityKind, Field};
use rtc_math::{Vec3, unit};

/// The limit on lights times surfaces: beyond it the quadratic search is left out.
const MAX_PAIRS: usize = 1_000_000;

/// Warns of each light inside a solid: with shadows the solid hides it from everything outside.
/// What holds the eye too is a room.
pub(super) fn lights(scene: &ir::Scene, check: &mut Check<'_>) {
    let ir::Scene {
        camera,
        settings,
        lights,
        surfaces,
        ..
    } = scene;
    if !settings.shadows || lights.len().saturating_mul(surfaces.len()) > MAX_PAIRS {
        return;
    }
    let eye = Vec3::from_array(camera.eye);
    for (index, light) in lights.iter().enumerate() {
        let Some(light) = light.point() else { continue };
        let light = Vec3::from_array(light.position);
        let is_around = |surface: &ir::Surface| {
            !surface.casts_no_shadow && holds(&surface.shape, light) && !holds(&surface.shape, eye)
        };
        let Some(solid) = surfaces.iter().position(is_around) else {
            continue;
        };
        let word = surfaces[solid].shape.kind().word();
        let message = format!("a light stands inside a {word}");
        let finding = Diagnostic::new(&codes::LIGHT_INSIDE, message);
        let span = check.span(place(EntityKind::Surface, solid, Field::Whole));
        check.report(
            place(EntityKind::Light, index, Field::Position),
            &format!("with shadows on, nothing outside the {word} sees this light"),
            finding.also(span, format!("this {word}")),
        );
    }
}

/// Warns of an eye inside a solid without glass that all other objects are outside of.
pub(super) fn eye(scene: &ir::Scene, check: &mut Check<'_>) {
    let ir::Scene {
        camera, surfaces, ..
    } = scene;
    let eye = Vec3::from_array(camera.eye);
    let is_around = |surface: &ir::Surface| {
        let material = scene.materials.get(surface.material.0 as usize);
        let is_opaque = material
            .and_then(ir::Material::phong)
            .is_some_and(|phong| phong.kt == 0.0);
        is_opaque && holds(&surface.shape, eye)
    };
    let Some(solid) = surfaces.iter().position(is_around) else {
        return;
    };
    let shape = &surfaces[solid].shape;
    let boxes = scene.mesh_boxes();
    let mut is_alone = true;
    let others = surfaces.iter().enumerate().filter(|(at, _)| *at != solid);
    for (_, other) in others.clone() {
        // An infinite plane goes through everything, and what reaches in is seen.
        let mut has_end = false;
        other.shape.corners_around(&boxes, &mut |corner| {
            has_end = true;
            is_alone &= !holds(shape, corner);
        });
        is_alone &= has_end;
    }
    if !is_alone || others.count() == 0 {
        return;
    }
    let word = shape.kind().word();
    let message = format!("the eye stands inside a {word} that hides all other objects");
    let span = check.span(place(EntityKind::Surface, solid, Field::Whole));
    let finding = Diagnostic::new(&codes::EYE_INSIDE, message).also(span, format!("this {word}"));
    check.report(
        place(EntityKind::Camera, 0, Field::Eye),
        "every ray starts in there",
        finding,
    );
}

/// Whether a point lies inside a solid; what has no inside that one formula tells holds nothing.
fn holds(shape: &ir::Shape, point: Vec3) -> bool {
    match shape {
        ir::Shape::Sphere(sphere) => {
            point.distance(Vec3::from_array(sphere.center)) < sphere.radius
        }
        ir::Shape::Cylinder(cylinder) => {
            let ir::Cylinder {
                base,
                axis,
                height,
                radius,
            } = cylinder;
            let way = unit(Vec3::from_array(*axis)).map(|axis| axis * *height);
            let from_base = point - Vec3::from_array(*base);
            along(from_base, way).is_some_and(|(_, off)| off < *radius)
        }
        ir::Shape::Cone(ir::Cone { base, up, radius }) => {
            let from_base = point - Vec3::from_array(*base);
            let place = along(from_base, Some(Vec3::from_array(*up)));
            place.is_some_and(|(share, off)| off < radius * (1.0 - share))
        }
        ir::Shape::Paraboloid(ir::Paraboloid { base, up, radius }) => {
            let from_base = point - Vec3::from_array(*base);
            let place = along(from_base, Some(Vec3::from_array(*up)));
            place.is_some_and(|(share, off)| off < radius * (1.0 - share).sqrt())
        }
        ir::Shape::Torus(torus) => {
            let ir::Torus {
                center,
                axis,
                major,
                minor,
            } = torus;
            let Some(axis) = unit(Vec3::from_array(*axis)) else {
                return false;
            };
            let from_center = point - Vec3::from_array(*center);
            let above = axis.dot(from_center);
            let off = (from_center - axis * above).length();
            Vec3::new(off - major, above, 0.0).length() < *minor
        }
        ir::Shape::Plane(_)
        | ir::Shape::Triangle(_)
        | ir::Shape::Quad(_)
        | ir::Shape::Disc(_)
        | ir::Shape::Instance(_) => false,
    }
}

/// Where a point is beside the way from the base of a solid to its top: after which share of it,
/// and how far off; none if it is below or above.
fn along(from_base: Vec3, way: Option<Vec3>) -> Option<(f64, f64)> {
    let way = way?;
    let (axis, height) = (unit(way)?, way.length());
    let above = axis.dot(from_base);
    (above > 0.0 && above < height).then(|| (above / height, (from_base - axis * above).length()))
}
