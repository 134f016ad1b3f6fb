//! Validates the environment.

use super::check::Checker;
use super::image::ImageId;
use rtc_diag::{Diagnostic, codes};
use rtc_ir::{self as ir, EntityField, EntityKind, ValuePath};
use rtc_math::Vec3;

/// The radiance along rays that hit no surface.
#[derive(Clone, Copy, Debug)]
pub struct Environment {
    /// The radiance, each channel at least 0; a factor of the image if there is one.
    pub radiance: Vec3,
    /// An equirectangular image of all directions.
    pub image: Option<ImageId>,
    /// The rows of the rotation from world directions to image directions.
    pub image_from_world: [Vec3; 3],
}

impl Environment {
    /// The black environment of a scene without one.
    pub const DARK: Self = Self {
        radiance: Vec3::ZERO,
        image: None,
        image_from_world: [Vec3::X, Vec3::Y, Vec3::Z],
    };
}

/// The tolerance for rotation matrices.
const ROTATION: f64 = 1e-9;

pub(super) fn environment(
    environment: Option<&ir::Environment>,
    images: usize,
    check: &mut Checker<'_>,
) -> Option<Environment> {
    let Some(ir::Environment {
        radiance,
        image,
        image_from_world,
    }) = environment
    else {
        return Some(Environment::DARK);
    };
    let at = ValuePath::new(EntityKind::Environment, 0, EntityField::Whole);
    // Radiance and image.
    let of_radiance = ValuePath::new(EntityKind::Environment, 0, EntityField::Color);
    let radiance = check.color(*radiance, of_radiance);
    let image = check.optional(image.as_ref(), |check, image| {
        check.handle(image.0, images, "image", at)
    });
    // Rotation.
    let rows = image_from_world.map_or(Environment::DARK.image_from_world, |rows| {
        rows.map(Vec3::from_array)
    });
    let [x, y, z] = rows;
    let is_rotation = (x.cross(y) - z).length() < ROTATION
        && (x.length() - 1.0).abs() < ROTATION
        && x.dot(y).abs() < ROTATION;
    if !is_rotation {
        let message = "the environment's rotation is not a rotation matrix";
        check.report(at, "", Diagnostic::new(&codes::BAD_ROTATION, message));
    }
    let (radiance, image) = (radiance?, image?);
    is_rotation.then_some(Environment {
        radiance,
        image,
        image_from_world: rows,
    })
}
