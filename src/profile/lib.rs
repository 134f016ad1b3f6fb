//! Angular distributions of the intensity of lights without extent.
//!
//! # Overview
//!
//! A [`LightProfile`] is a factor of the intensity by direction:
//!
//! - [`LightProfile::Uniform`]: the same in all directions;
//! - [`LightProfile::Cone`]: a cone with a smooth edge, as the spot light of glTF
//!   (`KHR_lights_punctual`);
//! - [`LightProfile::Measured`]: a measured distribution ([`IesProfile`]), a table over vertical
//!   and horizontal angles ([`IesAngles`]), as in IES files, with bilinear interpolation.
//!
//! # Data flow
//!
//! Front ends read the angles; `valid` checks them and builds the profile ([`LightProfile::cone`],
//! [`LightProfile::measured`]). `plan` uses [`LightProfile::is_dark`] and
//! [`LightProfile::bounding_cone`] to remove lights that illuminate nothing. `render` evaluates
//! [`LightProfile::factor`] per shadow ray, and weights a light by [`LightProfile::solid_angle`],
//! the integral of its factor.
//!
//! A new kind of distribution is added here only: no other room matches on the variants.
//!
//! # Guarantees
//!
//! - Factors are finite and at least 0.
//! - [`LightProfile::bounding_cone`] contains every direction with a factor above 0.

use rtc_math::{Vec3, acos, atan2, cos, unit};
use std::f64::consts::{FRAC_PI_2, TAU};
use std::sync::Arc;

/// The distribution of intensity over directions, as factors of the light's own intensity.
#[derive(Clone, Debug, PartialEq)]
pub enum LightProfile {
    /// The same in all directions.
    Uniform,
    /// All of it inside a cone, none outside of a wider one.
    Cone {
        /// The unit axis, away from the light.
        axis: Vec3,
        /// The cosine of the inner angle.
        inner: f64,
        /// The cosine of the outer angle, less than that of the inner one.
        outer: f64,
    },
    /// Measured at a grid of angles.
    Measured(Arc<IesProfile>),
}

/// A distribution measured in planes around an axis (type C of LM-63-2002), in between linear in
/// both angles.
#[derive(Clone, Debug, PartialEq)]
pub struct IesProfile {
    /// The unit axis: vertical angle 0.
    axis: Vec3,
    /// The unit directions across the axis of the horizontal angles 0° and 90°.
    across: [Vec3; 2],
    /// In degrees.
    angles: IesAngles,
    /// Row by row: all vertical angles for each horizontal one.
    values: Vec<f64>,
}

/// The grid of a measured distribution, in degrees.
#[derive(Clone, Debug, PartialEq)]
pub struct IesAngles {
    /// From the axis, ascending within 0 to 180; beyond them it is dark.
    pub vertical: Vec<f64>,
    /// About the axis, ascending from 0 to 360; or 0 alone for a distribution that is the same all
    /// around.
    pub horizontal: Vec<f64>,
}

impl LightProfile {
    /// The profile of a spot light: a unit axis, and the angles from it in radians.
    ///
    /// # Errors
    /// The error in the angles, unless 0 ≤ inner < outer ≤ π/2, up to rounding.
    pub fn cone(axis: Vec3, inner: f64, outer: f64) -> Result<Self, String> {
        if !(0.0 <= inner && inner < outer && outer <= FRAC_PI_2 * (1.0 + 1e-6)) {
            return Err(format!(
                "a spot light has an inner angle of {inner} and an outer one of {outer}: 0 ≤ inner \
                 < outer ≤ π/2 is needed"
            ));
        }
        Ok(Self::Cone {
            axis,
            inner: cos(inner),
            outer: cos(outer),
        })
    }

    /// A measured profile: its unit axis, the direction of the horizontal angle 0, of which only
    /// the part across the axis matters, and the values, row by row.
    ///
    /// # Errors
    /// The error in the angles or the values, as a message.
    pub fn measured(
        axis: Vec3,
        horizontal: Vec3,
        angles: IesAngles,
        values: Vec<f64>,
    ) -> Result<Self, String> {
        angles.check()?;
        let count = angles.vertical.len() * angles.horizontal.len();
        if values.len() != count {
            let found = values.len();
            return Err(format!(
                "the profile of a lamp has {found} values instead of {count}"
            ));
        }
        if let Some(value) = values
            .iter()
            .find(|value| !(0.0..=GREATEST).contains(*value))
        {
            return Err(format!(
                "the profile of a lamp has the value {value}: 0 to {GREATEST:e} is possible"
            ));
        }
        let horizontal = unit(horizontal).unwrap_or(Vec3::ZERO);
        let part = horizontal - axis * horizontal.dot(axis);
        let zero = if angles.horizontal.len() == 1 {
            // The same all around, any direction across will do.
            axis.any_orthonormal_vector()
        } else if part.length() > PARALLEL {
            part.normalize()
        } else {
            return Err("the horizontal angle 0 of a lamp is along its axis".to_owned());
        };
        // Seen from where the lamp hangs, horizontal angles run counterclockwise.
        let across = [zero, zero.cross(axis)];
        Ok(Self::Measured(Arc::new(IesProfile {
            axis,
            across,
            angles,
            values,
        })))
    }

    /// The factor in a unit direction away from the light: 0 to 1, of a measured profile the value.
    #[inline]
    #[must_use]
    pub fn factor(&self, direction: Vec3) -> f64 {
        match self {
            Self::Uniform => 1.0,
            Self::Cone { axis, inner, outer } => {
                // KHR_lights_punctual: the square of a ramp between the cosines.
                let ramp = ((direction.dot(*axis) - outer) / (inner - outer)).clamp(0.0, 1.0);
                ramp * ramp
            }
            Self::Measured(measured) => measured.value(direction),
        }
    }

    /// About the integral of the factors over all directions, in steradians.
    #[must_use]
    pub fn solid_angle(&self) -> f64 {
        match self {
            Self::Uniform => 2.0 * TAU,
            Self::Cone { outer, .. } => TAU * (1.0 - outer),
            Self::Measured(measured) => measured.integral(),
        }
    }

    /// Whether it is 0 in all directions.
    #[must_use]
    pub fn is_dark(&self) -> bool {
        match self {
            Self::Uniform | Self::Cone { .. } => false,
            Self::Measured(measured) => measured.values.iter().all(|value| *value == 0.0),
        }
    }

    /// A cone outside of which all factors are 0: its unit axis, and the cosine of its half angle,
    /// at least 0.
    #[must_use]
    pub fn bounding_cone(&self) -> Option<(Vec3, f64)> {
        match self {
            Self::Uniform => None,
            Self::Cone { axis, outer, .. } => Some((*axis, *outer)),
            Self::Measured(measured) => measured.bounding_cone(),
        }
    }
}

/// The greatest value of a measured profile.
const GREATEST: f64 = 1e60;

/// The sine of the least angle between the axis and the horizontal angle 0.
const PARALLEL: f64 = 1e-9;

impl IesAngles {
    fn check(&self) -> Result<(), String> {
        let (vertical, horizontal) = (&self.vertical[..], &self.horizontal[..]);
        let is_ascending = |angles: &[f64]| angles.windows(2).all(|pair| pair[0] < pair[1]);
        let is_within = match vertical {
            [first, .., last] => *first >= 0.0 && *last <= 180.0,
            _ => false,
        };
        if !(is_within && is_ascending(vertical)) {
            return Err(
                "the vertical angles of a lamp do not ascend within 0° and 180°".to_owned(),
            );
        }
        match horizontal {
            [first] if *first == 0.0 => Ok(()),
            [first, .., last] if [*first, *last] == [0.0, 360.0] && is_ascending(horizontal) => {
                Ok(())
            }
            _ => Err("the horizontal angles of a lamp do not ascend from 0° to 360°".to_owned()),
        }
    }
}

impl IesProfile {
    /// The value in a unit direction away from the light.
    fn value(&self, direction: Vec3) -> f64 {
        let IesAngles {
            vertical,
            horizontal,
        } = &self.angles;
        // Convert the direction to angles.
        let angle = acos(direction.dot(self.axis).clamp(-1.0, 1.0)).to_degrees();
        let Some((row, t)) = interval(vertical, angle) else {
            return 0.0;
        };
        let along = |column: usize| {
            let values = &self.values[column * vertical.len()..];
            values[row] + t * (values[row + 1] - values[row])
        };
        let [x, y] = self.across.map(|across| direction.dot(across));
        let around = atan2(y, x).to_degrees();
        let around = if around < 0.0 { around + 360.0 } else { around };
        // Interpolate linearly in both angles.
        match interval(horizontal, around) {
            None => along(0),
            Some((column, s)) => {
                let (before, after) = (along(column), along(column + 1));
                before + s * (after - before)
            }
        }
    }

    /// The integral over all directions, each cell of the grid by the mean of its corners.
    fn integral(&self) -> f64 {
        let rows = self.angles.vertical.len();
        let edges: Vec<f64> = self
            .angles
            .vertical
            .iter()
            .map(|angle| cos(angle.to_radians()))
            .collect();
        let band = |column: usize| -> f64 {
            let values = &self.values[column * rows..][..rows];
            let pairs = values.windows(2).zip(edges.windows(2));
            pairs
                .map(|(v, c)| 0.5 * (v[0] + v[1]) * (c[0] - c[1]))
                .sum()
        };
        if self.angles.horizontal.len() == 1 {
            return TAU * band(0);
        }
        let widths = self.angles.horizontal.windows(2).enumerate();
        widths
            .map(|(column, angles)| {
                let mean = 0.5 * (band(column) + band(column + 1));
                mean * (angles[1] - angles[0]).to_radians()
            })
            .sum()
    }

    /// A cone around the axis, or against it, of at most a right angle, that contains all light.
    fn bounding_cone(&self) -> Option<(Vec3, f64)> {
        let vertical = &self.angles.vertical;
        let is_lit = |row: usize| {
            let mut values = self.values.iter().skip(row).step_by(vertical.len());
            values.any(|value| *value > 0.0)
        };
        let lit: Vec<usize> = (0..vertical.len()).filter(|row| is_lit(*row)).collect();
        // Between a row that is lit and the next there is light.
        let first = vertical[lit.first()?.saturating_sub(1)];
        let last = vertical[(lit.last()? + 1).min(vertical.len() - 1)];
        if last <= 90.0 {
            Some((self.axis, cos(last.to_radians())))
        } else if first >= 90.0 {
            Some((-self.axis, cos((180.0 - first).to_radians())))
        } else {
            None
        }
    }
}

/// The interval of an ascending grid that contains a number, and its relative position in it, 0 to
/// 1.
fn interval(grid: &[f64], at: f64) -> Option<(usize, f64)> {
    let [first, .., last] = grid else {
        return None;
    };
    if !(*first..=*last).contains(&at) {
        return None;
    }
    let index = grid.partition_point(|edge| *edge <= at).min(grid.len() - 1) - 1;
    let (from, to) = (grid[index], grid[index + 1]);
    Some((index, (at - from) / (to - from)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use rtc_math::sin;

    fn measured(
        vertical: &[f64],
        horizontal: &[f64],
        value: impl Fn(f64, f64) -> f64,
    ) -> LightProfile {
        let angles = IesAngles {
            vertical: vertical.to_vec(),
            horizontal: horizontal.to_vec(),
        };
        let row = |around: &f64| {
            vertical
                .iter()
                .map(|angle| value(*angle, *around))
                .collect::<Vec<_>>()
        };
        let values = horizontal.iter().flat_map(row).collect();
        LightProfile::measured(-Vec3::Z, Vec3::X + Vec3::Z, angles, values)
            .expect("a sound profile")
    }

    /// Away from a lamp that hangs at the top of +z: at an angle from straight down, and around.
    fn direction(angle: f64, around: f64) -> Vec3 {
        let (angle, around) = (angle.to_radians(), around.to_radians());
        Vec3::new(
            sin(angle) * cos(around),
            sin(angle) * sin(around),
            -cos(angle),
        )
    }

    #[test]
    fn a_measured_profile_is_linear_in_both_angles() {
        let lamp = measured(
            &[0.0, 30.0, 90.0],
            &[0.0, 90.0, 270.0, 360.0],
            |angle, around| 5.0 + angle + if around == 90.0 { angle } else { 0.0 },
        );
        for (angle, around, expected) in [
            (0.0, 0.0, 5.0),
            (30.0, 90.0, 65.0),
            (45.0, 45.0, 5.0 + 45.0 + 22.5),
            (60.0, 180.0, 5.0 + 60.0 + 30.0),
            (60.0, 300.0, 65.0),
            (89.999, 359.999, 95.0),
            (90.1, 10.0, 0.0),
        ] {
            let found = lamp.factor(direction(angle, around));
            assert!(
                (found - expected).abs() < 2e-2,
                "{angle}°, {around}°: {found}"
            );
        }
    }

    /// The flux of a Lambertian source of intensity cos γ is π, of a uniform one 4π.
    #[test]
    fn a_measured_profile_has_the_flux_of_its_source() {
        let degrees: Vec<f64> = (0..=180).map(f64::from).collect();
        let lambert = measured(&degrees[..=90], &[0.0], |angle, _| cos(angle.to_radians()));
        let flux = lambert.solid_angle();
        assert!((flux - TAU / 2.0).abs() < 1e-3, "{flux}");
        let uniform = measured(&degrees, &[0.0, 100.0, 360.0], |_, _| 1.0);
        assert!((uniform.solid_angle() - LightProfile::Uniform.solid_angle()).abs() < 1e-9);
    }

    #[test]
    fn a_measured_profile_knows_where_it_is_dark() {
        let grid = [0.0, 30.0, 60.0, 120.0, 150.0, 180.0];
        let cone = |range: std::ops::RangeInclusive<f64>| {
            let value = |angle, _| if range.contains(&angle) { 2.0 } else { 0.0 };
            let lamp = measured(&grid, &[0.0], value);
            assert!(!lamp.is_dark());
            lamp.bounding_cone()
                .map(|(axis, cosine)| (axis, acos(cosine).to_degrees().round()))
        };
        assert_eq!(cone(0.0..=30.0), Some((-Vec3::Z, 60.0)));
        assert_eq!(cone(0.0..=60.0), None);
        assert_eq!(cone(150.0..=180.0), Some((Vec3::Z, 60.0)));
        let dark = measured(&grid, &[0.0], |_, _| 0.0);
        assert!(dark.is_dark() && dark.bounding_cone().is_none());
    }

    #[test]
    fn what_is_no_profile_is_refused() {
        let fault = |vertical: &[f64], horizontal: &[f64], values: &[f64], zero| {
            let angles = IesAngles {
                vertical: vertical.to_vec(),
                horizontal: horizontal.to_vec(),
            };
            LightProfile::measured(-Vec3::Z, zero, angles, values.to_vec()).unwrap_err()
        };
        let (two, around) = ([0.0, 90.0], [0.0, 360.0]);
        for vertical in [
            &[0.0][..],
            &[0.0, 0.0],
            &[-1.0, 90.0],
            &[0.0, 181.0],
            &[0.0, f64::NAN],
        ] {
            assert!(fault(vertical, &[0.0], &[1.0, 1.0], Vec3::X).contains("vertical"));
        }
        for horizontal in [&[][..], &[1.0], &[0.0, 90.0], &[0.0, 200.0, 100.0, 360.0]] {
            assert!(fault(&two, horizontal, &[1.0, 1.0], Vec3::X).contains("horizontal"));
        }
        assert!(fault(&two, &[0.0], &[1.0], Vec3::X).contains("1 values instead of 2"));
        for value in [-1.0, f64::INFINITY, f64::NAN] {
            assert!(fault(&two, &[0.0], &[1.0, value], Vec3::X).contains("the value"));
        }
        assert!(fault(&two, &around, &[1.0; 4], Vec3::Z).contains("along its axis"));
    }
}
