//! Light that paths find by chance alone, as no points of its surface are sampled.

use crate::facts;
use crate::shape::shape_facts;
use rtc_math::{IdTable, Vec3};
use rtc_valid::{Mode, Shape, Surface, ValidScene};

/// The first CSG solid of a path-traced scene, as an IR index, that shines on infinite faces: no
/// point of these is sampled. `None` if there is none.
#[must_use]
pub fn unsampled_solid(scene: &ValidScene) -> Option<usize> {
    let Mode::Path(_) = scene.settings().mode else {
        return None;
    };
    let is_infinite = |shape: &Shape| matches!(shape, Shape::Plane(_) | Shape::InfiniteCylinder(_));
    let is_unsampled = |surface: &&Surface| {
        let Shape::Csg(csg) = &surface.shape else {
            return false;
        };
        let operands = csg.operands.iter().enumerate();
        let mut shown = operands.filter(|(operand, _)| csg.faces >> operand & 1 == 1);
        let standard = facts::material::standard(&scene.materials()[surface.material]);
        shown.any(|(_, operand)| is_infinite(operand))
            && shape_facts(&surface.shape)
                .bounds(&IdTable::default())
                .aabb()
                .is_none()
            && !standard.unlit
            && standard.emissive != Vec3::ZERO
    };
    let mut surfaces = scene.surfaces().iter();
    surfaces.find(is_unsampled).map(|surface| surface.index)
}
