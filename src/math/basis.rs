//! The camera basis from an eye, a centre and an up vector.

use super::{Vec3, cross, dot, ldexp, length, unit_scale};

/// The smallest angle between `up` and the view, in radians, that still says which way is up.
const MIN_ANGLE: f64 = 1e-9;

/// Why three vectors give no camera.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CameraBasisError {
    /// Eye and centre are the same point.
    ZeroGaze,
    /// `up` is the zero vector.
    ZeroUp,
    /// `up` points along the view, to within 1e-9 rad.
    Parallel,
}

/// The steps from a pixel to its right and upper neighbours: `right = ‖up‖·(g × up)/‖g × up‖` and
/// `up' = ‖up‖·(right × g)/‖right × g‖` with g = center − eye.
///
/// # Errors
/// If the three give no camera; see [`CameraBasisError`].
pub fn camera_basis(eye: Vec3, center: Vec3, up: Vec3) -> Result<(Vec3, Vec3), CameraBasisError> {
    let view_dir = center - eye;
    let (unit_gaze, _) = unit_scale(view_dir).ok_or(CameraBasisError::ZeroGaze)?;
    let (unit_up, _) = unit_scale(up).ok_or(CameraBasisError::ZeroUp)?;
    let sine = cross(unit_gaze, unit_up).length() / (unit_gaze.length() * unit_up.length());
    if sine < MIN_ANGLE {
        return Err(CameraBasisError::Parallel);
    }
    view_basis(view_dir, up)
}

/// As [`camera_basis`] for a view direction, but rejects only exactly parallel vectors.
///
/// Every component is right to within 8 u·‖up‖ for any length of either vector, subnormal ones
/// included: the cross products are Kahan's, on vectors scaled by powers of two.
///
/// # Errors
/// If the two give no camera; see [`CameraBasisError`].
pub fn view_basis(view_dir: Vec3, up: Vec3) -> Result<(Vec3, Vec3), CameraBasisError> {
    let (view_dir, _) = unit_scale(view_dir).ok_or(CameraBasisError::ZeroGaze)?;
    let (up, exponent) = unit_scale(up).ok_or(CameraBasisError::ZeroUp)?;
    let right = direction(cross(view_dir, up)).ok_or(CameraBasisError::Parallel)?;
    let above = direction(cross(right, view_dir)).ok_or(CameraBasisError::Parallel)?;
    let pixel = dot(up, up).sqrt();
    let step = |direction: Vec3| {
        let step = direction * pixel;
        Vec3::new(
            ldexp(step.x, exponent),
            ldexp(step.y, exponent),
            ldexp(step.z, exponent),
        )
    };
    Ok((step(right), step(above)))
}

/// The world axis that says best which way is up for a view: among y, z, x, in that order, the one
/// that makes the largest angle with `view_dir`, with the length of `up`.
#[must_use]
pub fn fallback_up(view_dir: Vec3, up: Vec3) -> Vec3 {
    let along = view_dir.abs();
    let mut best = (along.y, Vec3::Y);
    for candidate in [(along.z, Vec3::Z), (along.x, Vec3::X)] {
        if candidate.0 < best.0 {
            best = candidate;
        }
    }
    best.1 * if up == Vec3::ZERO { 1.0 } else { length(up) }
}

fn direction(v: Vec3) -> Option<Vec3> {
    let (v, _) = unit_scale(v)?;
    Some(v / dot(v, v).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_course_camera_is_exact() {
        let basis = camera_basis(
            Vec3::new(200.0, 200.0, 1000.0),
            Vec3::new(200.0, 200.0, 0.0),
            Vec3::Y,
        );
        assert_eq!(basis, Ok((Vec3::X, Vec3::Y)));
    }

    #[test]
    fn what_gives_no_camera_is_named() {
        let at = |center, up| camera_basis(Vec3::ZERO, center, up).unwrap_err();
        assert_eq!(at(Vec3::ZERO, Vec3::Y), CameraBasisError::ZeroGaze);
        assert_eq!(at(Vec3::Z, Vec3::ZERO), CameraBasisError::ZeroUp);
        assert_eq!(
            at(Vec3::Z, Vec3::new(5e-10, 0.0, 1.0)),
            CameraBasisError::Parallel
        );
        assert!(camera_basis(Vec3::ZERO, Vec3::Z, Vec3::new(2e-9, 0.0, 1.0)).is_ok());
    }

    #[test]
    fn the_fallback_prefers_y_then_z_then_x() {
        assert_eq!(fallback_up(Vec3::Z, Vec3::Z * 3.0), Vec3::Y * 3.0);
        assert_eq!(fallback_up(Vec3::Y, Vec3::Y), Vec3::Z);
        assert_eq!(fallback_up(Vec3::new(0.1, 1.0, 1.0), Vec3::Y), Vec3::X);
    }
}
