//! The sky and the sun over a horizon (Hosek and Wilkie, "An analytic model for full spectral
//! sky-dome radiance", SIGGRAPH 2012, and "Adding a solar-radiance function to the Hošek-Wilkie
//! skylight model", 2013), and the place of the sun (Blanco-Muriel et al., "Computing the solar
//! vector", Solar Energy 70, 2001).
//!
//! `sky.bin` has the authors' tables for Rec. 709 (`sky-license.txt`) in little-endian floats: the
//! coefficients `[turbidity][albedo 0 or 1][control point][channel][9]`, the radiances
//! `[turbidity][albedo][control point][channel]`, and of the sun, as a mean over its disc, the cubics
//! `[turbidity][segment of the elevation][channel][power]`.

use rtc_math::{acos, atan2, cos, exp, pow, sin};
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::sync::LazyLock;

/// The sky of a place of the sun; z points up.
pub(crate) struct Sky {
    sun: [f64; 3],
    coefficients: [[f64; COEFFICIENTS]; 3],
    /// The factor of each channel.
    radiance: [f64; 3],
}

const TURBIDITIES: usize = 10;
const CONTROL_POINTS: usize = 6;
const COEFFICIENTS: usize = 9;
const SEGMENTS: usize = 45;

/// The number of floats of the coefficients and of the radiances.
const SKY_FLOATS: usize = TURBIDITIES * 2 * CONTROL_POINTS * 3 * COEFFICIENTS;
const RADIANCE_FLOATS: usize = TURBIDITIES * 2 * CONTROL_POINTS * 3;

/// Light is measured as Mitsuba does: radiance in W/(m²·sr·nm), over the integral of ȳ.
const CIE_Y_INTEGRAL: f64 = 106.750_259_4;
/// The factor of the sun's table for that measure.
const SUN_FACTOR: f64 = 467.069_280_386;

static TABLES: LazyLock<Vec<f64>> = LazyLock::new(|| {
    let (floats, _) = include_bytes!("sky.bin").as_chunks();
    let float = |bytes: &[u8; 4]| f64::from(f32::from_le_bytes(*bytes));
    floats.iter().map(float).collect()
});

/// A number of a table; 0 behind its end.
fn entry(index: usize) -> f64 {
    TABLES.get(index).copied().unwrap_or(0.0)
}

/// The two turbidities around one, with the weight of the second.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped to the table"
)]
fn around(turbidity: f64) -> ([usize; 2], f64) {
    let place = turbidity.clamp(1.0, 10.0) - 1.0;
    let first = (place as usize).min(TURBIDITIES - 1);
    (
        [first, (first + 1).min(TURBIDITIES - 1)],
        place - first as f64,
    )
}

/// A linear blend of two values.
fn between([a, b]: [f64; 2], share: f64) -> f64 {
    a + (b - a) * share
}

impl Sky {
    /// The sky of a turbidity (1 to 10), over a ground of an albedo, with the sun in a direction: a
    /// unit vector.
    pub(crate) fn new(turbidity: f64, albedo: [f64; 3], sun: [f64; 3]) -> Self {
        let elevation = FRAC_PI_2 - acos(sun[2].clamp(0.0, 1.0));
        let x = pow(elevation / FRAC_PI_2, 1.0 / 3.0);
        let (turbidities, share) = around(turbidity);
        // Interpolate a table whose entries are `of` the control point and what comes before it.
        let interpolated = |albedo: f64, at: &dyn Fn(usize, usize, usize) -> f64| {
            let of_turbidity = |turbidity: usize| {
                let of_albedo = |ground: usize| bezier(x, |k| at(turbidity, ground, k));
                between([of_albedo(0), of_albedo(1)], albedo.clamp(0.0, 1.0))
            };
            between(turbidities.map(of_turbidity), share)
        };
        let point = |turbidity: usize, ground: usize, k: usize, channel: usize| {
            ((turbidity * 2 + ground) * CONTROL_POINTS + k) * 3 + channel
        };
        let coefficients = [0, 1, 2].map(|channel: usize| {
            std::array::from_fn(|i| {
                interpolated(albedo[channel], &|t, g, k| {
                    entry(point(t, g, k, channel) * COEFFICIENTS + i)
                })
            })
        });
        let radiance = [0, 1, 2].map(|channel: usize| {
            let of = interpolated(albedo[channel], &|t, g, k| {
                entry(SKY_FLOATS + point(t, g, k, channel))
            });
            of / CIE_Y_INTEGRAL
        });
        Self {
            sun,
            coefficients,
            radiance,
        }
    }

    /// The radiance from a direction, a unit vector; black below the horizon.
    pub(crate) fn radiance(&self, direction: [f64; 3]) -> [f64; 3] {
        let [x, y, z] = direction;
        if z < 0.0 {
            return [0.0; 3];
        }
        let cosine = (x * self.sun[0] + y * self.sun[1] + z * self.sun[2]).clamp(-1.0, 1.0);
        let angle = acos(cosine);
        let square = cosine * cosine;
        // Equation 8 of the paper; the code of the authors has G and H at the ends.
        [0, 1, 2].map(|channel: usize| {
            let [a, b, c, d, e, f, g, i, h] = self.coefficients[channel];
            let width = 1.0 + h * h - 2.0 * h * cosine;
            let aureole = (1.0 + square) / (width * width.sqrt());
            let horizon = 1.0 + a * exp(b / (z + 0.01));
            let around_sun = c + d * exp(e * angle) + f * square + g * aureole + i * z.sqrt();
            (horizon * around_sun * self.radiance[channel]).max(0.0)
        })
    }
}

/// A curve of Bézier of degree 5 at x in [0, 1].
fn bezier(x: f64, point: impl Fn(usize) -> f64) -> f64 {
    const BINOMIALS: [f64; CONTROL_POINTS] = [1.0, 5.0, 10.0, 10.0, 5.0, 1.0];
    let rest = 1.0 - x;
    let mut sum = 0.0;
    for (k, binomial) in BINOMIALS.into_iter().enumerate() {
        let mut term = binomial * point(k);
        for _ in 0..k {
            term *= x;
        }
        for _ in k..CONTROL_POINTS - 1 {
            term *= rest;
        }
        sum += term;
    }
    sum
}

/// The mean radiance of the disc of the sun at an elevation in radians.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped to the table"
)]
pub(crate) fn sun_radiance(turbidity: f64, elevation: f64) -> [f64; 3] {
    let share = (elevation / FRAC_PI_2).clamp(0.0, 1.0);
    let segment = (pow(share, 1.0 / 3.0) * SEGMENTS as f64) as usize;
    let segment = segment.min(SEGMENTS - 1);
    let begin = segment as f64 / SEGMENTS as f64;
    let x = elevation.max(0.0) - begin * begin * begin * FRAC_PI_2;
    let (turbidities, weight) = around(turbidity);
    [0, 1, 2].map(|channel: usize| {
        let of_turbidity = |turbidity: usize| {
            let row = ((turbidity * SEGMENTS + segment) * 3 + channel) * 4;
            let power = |k: usize| entry(SKY_FLOATS + RADIANCE_FLOATS + row + k);
            power(0) + x * (power(1) + x * (power(2) + x * power(3)))
        };
        let mean = between(turbidities.map(of_turbidity), weight);
        (mean * SUN_FACTOR / CIE_Y_INTEGRAL).max(0.0)
    })
}

/// A time and a place on Earth: the hours are those of a clock `timezone` hours before UTC, angles
/// are in degrees to the north and to the east.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TimeAndPlace {
    /// Year, month and day.
    pub(crate) date: [f64; 3],
    /// Hours, with their fraction.
    pub(crate) hours: f64,
    pub(crate) timezone: f64,
    pub(crate) latitude: f64,
    pub(crate) longitude: f64,
}

impl TimeAndPlace {
    /// The angle of the sun from the zenith, and its azimuth from north to east, in radians.
    pub(crate) fn sun(&self) -> [f64; 2] {
        // The days since noon of 1 January 2000.
        let [year, month, day] = self.date.map(f64::trunc);
        let hours = self.hours - self.timezone;
        let turn = ((month - 14.0) / 12.0).trunc();
        let days = (1461.0 * (year + 4800.0 + turn) / 4.0).trunc()
            + (367.0 * (month - 2.0 - 12.0 * turn) / 12.0).trunc()
            - (3.0 * ((year + 4900.0 + turn) / 100.0).trunc() / 4.0).trunc()
            + day
            - 32_075.0;
        let elapsed = days - 0.5 + hours / 24.0 - 2_451_545.0;
        // The ecliptic coordinates of the sun.
        let node = 2.1429 - 0.001_039_459_4 * elapsed;
        let anomaly = 6.240_060_0 + 0.017_201_969_9 * elapsed;
        let longitude = 4.895_063_0
            + 0.017_202_791_698 * elapsed
            + 0.033_416_07 * sin(anomaly)
            + 0.000_348_94 * sin(2.0 * anomaly)
            - 0.000_113_4
            - 0.000_020_3 * sin(node);
        let obliquity = 0.409_092_8 - 6.214_0e-9 * elapsed + 0.000_039_6 * cos(node);
        // The celestial coordinates.
        let ascension = atan2(cos(obliquity) * sin(longitude), cos(longitude));
        let declination = FRAC_PI_2 - acos((sin(obliquity) * sin(longitude)).clamp(-1.0, 1.0));
        // The horizontal coordinates.
        let greenwich = 6.697_424_324_2 + 0.065_709_828_3 * elapsed + hours;
        let hour_angle = (greenwich * 15.0 + self.longitude).to_radians() - ascension;
        let latitude = self.latitude.to_radians();
        let height =
            cos(latitude) * cos(hour_angle) * cos(declination) + sin(declination) * sin(latitude);
        let zenith = acos(height.clamp(-1.0, 1.0));
        let north =
            sin(declination) / cos(declination) * cos(latitude) - sin(latitude) * cos(hour_angle);
        let azimuth = atan2(-sin(hour_angle), north);
        // The parallax: the radius of Earth over the distance of the sun.
        let parallax = 6371.01 / 149_597_890.0 * sin(zenith);
        [zenith + parallax, azimuth.rem_euclid(TAU)]
    }
}

/// The solid angle of the disc of the sun for its aperture, in degrees.
pub(crate) fn solid_angle(aperture: f64) -> f64 {
    let half = (aperture / 2.0).to_radians();
    // 1 − cos(x) = 2·sin²(x/2) does not cancel.
    let root = sin(half / 2.0);
    4.0 * PI * root * root
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_near(found: [f64; 3], known: [f64; 3], share: f64) {
        for (found, known) in found.into_iter().zip(known) {
            assert!((found / known - 1.0).abs() < share, "{found}, not {known}");
        }
    }

    fn at(elevation: f64) -> [f64; 3] {
        let angle = elevation.to_radians();
        [cos(angle), 0.0, sin(angle)]
    }

    #[test]
    fn the_zenith_and_the_horizon_are_those_of_mitsuba() {
        // Of its plugin `sunsky` (3.9.1) with the albedo 0.3.
        let sky = |turbidity, elevation| Sky::new(turbidity, [0.3; 3], at(elevation));
        let zenith = [0.0, 0.0, 1.0];
        let known = [0.023_749_32, 0.041_515_99, 0.084_094_2];
        assert_near(sky(3.0, 45.0).radiance(zenith), known, 1e-4);
        let known = [0.130_012_83, 0.136_826_14, 0.150_392_04];
        assert_near(sky(10.0, 45.0).radiance(zenith), known, 1e-4);
        assert_eq!(sky(3.0, 45.0).radiance([0.6, 0.0, -0.8]), [0.0; 3]);
    }

    #[test]
    fn the_sun_is_that_of_mitsuba_and_redder_when_it_is_low() {
        let known = [21_369.158, 17_551.52, 12_928.001];
        assert_near(sun_radiance(3.0, 45_f64.to_radians()), known, 5e-3);
        let known = [14_494.26, 8_789.176, 3_141.136];
        assert_near(sun_radiance(3.0, 10_f64.to_radians()), known, 2e-2);
    }

    #[test]
    fn the_sun_of_a_summer_afternoon_in_tokyo_is_in_the_west() {
        let tokyo = TimeAndPlace {
            date: [2010.0, 7.0, 10.0],
            hours: 15.0,
            timezone: 9.0,
            latitude: 35.689,
            longitude: 139.6917,
        };
        let [zenith, azimuth] = tokyo.sun().map(f64::to_degrees);
        assert!((zenith - 43.9207).abs() < 1e-3, "{zenith}");
        assert!((azimuth - 265.7527).abs() < 1e-3, "{azimuth}");
    }
}
