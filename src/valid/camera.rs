//! Validates the camera: the eye is off the image plane, the steps are perpendicular, the image has
//! pixels.

use super::check::{Checker, SMALLEST};
use rtc_diag::Diagnostic;
use rtc_diag::codes;
use rtc_ir::{self as ir, EntityField, EntityKind, ValuePath};
use rtc_math::{NonNegative, Vec3};
use std::num::NonZeroU32;

/// The largest cosine of the angle between `right` and `up` that counts as a right angle.
const RIGHT_ANGLE: f64 = 1e-9;

/// A camera whose image has pixels and whose eye is off the image plane.
#[derive(Clone, Debug)]
pub struct Camera {
    /// The origin of the rays.
    pub eye: Vec3,
    /// The centre of the image.
    pub center: Vec3,
    /// The vector to the right neighbour of a pixel.
    pub right: Vec3,
    /// The vector to the upper neighbour of a pixel; perpendicular to `right`.
    pub up: Vec3,
    /// Width in pixels.
    pub width: NonZeroU32,
    /// Height in pixels.
    pub height: NonZeroU32,
    /// The aperture.
    pub lens: Lens,
    /// The projection.
    pub projection: Projection,
}

/// A lens with at least one sample.
#[derive(Clone, Copy, Debug)]
pub struct Lens {
    /// The radius of the aperture.
    pub radius: NonNegative,
    /// Aperture samples of each sub-sample.
    pub samples: NonZeroU32,
}

/// The projection of a camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// Rays start at the eye.
    Perspective,
    /// Rays start at two eyes.
    Stereo(Stereo),
    /// Parallel rays: each passes through its point of the image in the direction from the eye to
    /// the image centre, and starts at the distance of the eye before the image.
    Orthographic,
}

/// Two eyes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stereo {
    /// The distance between them in scene units, above 0.
    pub distance: f64,
    /// Whether both see the whole image, in one picture for red and cyan glasses; otherwise each
    /// sees it in its half of the picture.
    pub is_anaglyph: bool,
}

impl Stereo {
    pub(super) fn of(settings: &ir::Settings) -> Self {
        Self {
            distance: settings.stereo,
            is_anaglyph: settings.stereo_view == ir::StereoView::Anaglyph,
        }
    }
}

pub(super) fn camera(
    camera: &ir::Camera,
    stereo: Stereo,
    check: &mut Checker<'_>,
) -> Option<Camera> {
    let ir::Camera {
        eye,
        center,
        right,
        up,
        size,
        lens,
        projection,
    } = camera;
    let ir::Lens { radius, samples } = lens;
    // Check each value; all errors are reported.
    let eye = check.vector(*eye, at(EntityField::Eye));
    let center = check.vector(*center, at(EntityField::Center));
    let right = step(*right, EntityField::Right, check);
    let up = step(*up, EntityField::Up, check);
    let size = image_size(*size, check);
    let radius = check.non_negative(*radius, "apertureRadius", at(EntityField::LensRadius));
    let samples = check.count(*samples, "apertureSamples", at(EntityField::LensSamples));
    let projection = valid_projection(*projection, stereo, check);
    // Check the frustum.
    let (eye, center, right, up) = (eye?, center?, right?, up?);
    frustum(eye, center, right, up, check)?;
    let (width, height) = size?;
    let lens = Lens {
        radius: radius?,
        samples: samples?,
    };
    Some(Camera {
        eye,
        center,
        right,
        up,
        width,
        height,
        lens,
        projection: projection?,
    })
}

fn valid_projection(
    projection: ir::Projection,
    stereo: Stereo,
    check: &mut Checker<'_>,
) -> Option<Projection> {
    let path = ValuePath::new(EntityKind::Settings, 0, EntityField::Stereo);
    let distance = check.non_negative(stereo.distance, "stereo", path)?.get();
    match projection {
        ir::Projection::Perspective if distance == 0.0 => Some(Projection::Perspective),
        ir::Projection::Perspective => Some(Projection::Stereo(stereo)),
        ir::Projection::Orthographic => Some(Projection::Orthographic),
    }
}

fn at(field: EntityField) -> ValuePath {
    ValuePath::new(EntityKind::Camera, 0, field)
}

/// A step between pixels: a vector of nonzero length.
fn step(value: [f64; 3], field: EntityField, check: &mut Checker<'_>) -> Option<Vec3> {
    let vector = check.vector(value, at(field))?;
    if vector.abs().max_element() < SMALLEST {
        let what = if vector == Vec3::ZERO {
            "have no size"
        } else {
            "are too small to compute with"
        };
        let diagnostic =
            Diagnostic::new(&codes::CAMERA_BASIS, format!("the camera's pixels {what}"));
        check.report(
            at(field),
            "this step between pixels is shorter than 1e-60",
            diagnostic,
        );
        return None;
    }
    Some(vector)
}

fn frustum(eye: Vec3, center: Vec3, right: Vec3, up: Vec3, check: &mut Checker<'_>) -> Option<()> {
    let cosine = right.normalize().dot(up.normalize());
    if cosine.abs() > RIGHT_ANGLE {
        let message = format!(
            "the camera's `right` and `up` are not at a right angle: their cosine is {cosine:.3e}"
        );
        check.report(
            at(EntityField::Up),
            "",
            Diagnostic::new(&codes::CAMERA_BASIS, message),
        );
        return None;
    }
    let normal = rtc_math::cross(right.normalize(), up.normalize());
    if rtc_math::dot(normal, center - eye) == 0.0 {
        let diagnostic = Diagnostic::new(
            &codes::EYE_IN_IMAGE_PLANE,
            "the eye lies in the image plane",
        );
        let diagnostic = diagnostic.also(
            check.span(at(EntityField::Center)),
            "the plane goes through this point",
        );
        check.report(
            at(EntityField::Eye),
            "every ray would run inside the image",
            diagnostic.hint("move the eye off the plane"),
        );
        return None;
    }
    Some(())
}

fn image_size(size: [u32; 2], check: &mut Checker<'_>) -> Option<(NonZeroU32, NonZeroU32)> {
    match (NonZeroU32::new(size[0]), NonZeroU32::new(size[1])) {
        (Some(width), Some(height)) => Some((width, height)),
        _ => {
            let message = format!("the image has no pixels: {} × {}", size[0], size[1]);
            let diagnostic = Diagnostic::new(&codes::EMPTY_IMAGE, message);
            check.report(at(EntityField::Size), "both must be at least 1", diagnostic);
            None
        }
    }
}
