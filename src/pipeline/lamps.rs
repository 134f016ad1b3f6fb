//! Lamps inside of closed rooms.
//!
//! Camera rays pass back faces of single-sided materials, so they look into a room whose walls face
//! inwards; light does not pass them, and the room is black. Lamps stand where camera rays cross
//! the room.

use super::Renderer;
use super::exposure::SIDE;
use rtc_ir::{Camera, Light, Projection, Punctual, PunctualKind};
use rtc_math::{Vec3, exp, ln, pow};
use rtc_render::{Ray, SeenBehind};
use std::f64::consts::PI;

/// The least fraction of the picture that shows rooms without light.
const MIN_DARK: f64 = 0.02;
/// The radiance of a white surface in the light of the lamps alone, at an exposure of 0. What the
/// walls reflect makes it two to three times as bright, as it is in the studio.
const WHITE: f64 = 0.25;
/// The most lamps, and the least fraction of the dark points that one of them lights.
const MOST_LAMPS: usize = 8;
const MIN_SHARE: f64 = 0.04;
/// The numbers of places for lamps that are tried, and of points that they are to light.
const PLACES: usize = 48;
const POINTS: usize = 256;
/// Of the places that light at least this fraction of the points of the best one, the one that is
/// farthest from all points counts.
const NEARLY: f64 = 0.9;

/// A pixel of the small picture, and what it sees behind back faces.
pub(super) type PixelBehind = (usize, SeenBehind);

/// Whether so many pixels of the small picture are more than chance.
fn matters(pixels: usize) -> bool {
    pixels as f64 >= MIN_DARK * f64::from(SIDE * SIDE)
}

/// A place for a lamp, and what it lights.
struct LampPlace {
    position: Vec3,
    /// The irradiance on each point in the light of an intensity of 1; 0 in shadow.
    irradiance: Vec<f64>,
    /// The squared distance to the nearest lit point.
    clearance: f64,
}

impl Renderer {
    /// What the middles of the pixels of the small picture see behind back faces; nothing if there
    /// is too little of it to matter.
    pub(super) fn seen_behind(&self, camera: &Camera) -> Vec<PixelBehind> {
        let pixels = (0..SIDE * SIDE).map(|pixel| (pixel, [pixel % SIDE, pixel / SIDE]));
        let seen = pixels.filter_map(|(index, pixel)| {
            let seen = self.world.seen_behind(view_ray(camera, pixel))?;
            Some((index as usize, seen))
        });
        let seen: Vec<PixelBehind> = seen.collect();
        if matters(seen.len()) {
            seen
        } else {
            Vec::new()
        }
    }

    /// The lamps for points that no light reaches, of a picture with an exposure of `stops`; `None`
    /// if the points are too few to matter.
    pub(super) fn lamps(&self, dark: &[SeenBehind], stops: f64) -> Option<Vec<Light>> {
        if !matters(dark.len()) {
            return None;
        }
        let points: Vec<SeenBehind> = thinned(dark, POINTS).collect();
        let places = thinned(dark, PLACES)
            .map(|seen| self.place(seen.passed + (seen.point - seen.passed) / 2.0, &points));
        let places: Vec<LampPlace> = places.collect();
        let lamps = intensities(&places, points.len(), PI * WHITE * pow(2.0, -stops));
        let lamps = lamps.into_iter().map(|(place, intensity)| {
            let kind = PunctualKind::Point {
                position: place.position.to_array(),
                range: None,
            };
            Light::Punctual(Punctual::new(kind, [intensity; 3]))
        });
        Some(lamps.collect())
    }

    fn place(&self, position: Vec3, points: &[SeenBehind]) -> LampPlace {
        let mut clearance = f64::INFINITY;
        let irradiance = points.iter().map(|SeenBehind { point, normal, .. }| {
            let to_lamp = position - point;
            let square = to_lamp.length_squared();
            let irradiance = normal.dot(to_lamp) / (square * square.sqrt());
            let is_lit = irradiance > 0.0 && irradiance.is_finite();
            if !is_lit || self.world.occluded(*point, position) {
                return 0.0;
            }
            clearance = clearance.min(square);
            irradiance
        });
        LampPlace {
            irradiance: irradiance.collect(),
            position,
            clearance,
        }
    }
}

/// The places of lamps and their intensities, so that this is the irradiance on the points that
/// they light, in the geometric mean. Each lamp lights points that are dark without it.
fn intensities(places: &[LampPlace], points: usize, wanted: f64) -> Vec<(&LampPlace, f64)> {
    let mut total = vec![0.0; points];
    let mut lamps = Vec::new();
    while lamps.len() < MOST_LAMPS {
        let Some(best) = best(places, &total) else {
            break;
        };
        let intensity = 1.0 / geometric_mean(best.lit(&total));
        for (total, irradiance) in total.iter_mut().zip(&best.irradiance) {
            *total += intensity * irradiance;
        }
        lamps.push((best, intensity));
    }
    // Lamps of one room add up.
    let lit = total.iter().copied().filter(|total| *total > 0.0);
    let factor = wanted / geometric_mean(lit);
    let scaled = lamps
        .into_iter()
        .map(|(place, intensity)| (place, factor * intensity));
    scaled
        .filter(|(_, intensity)| *intensity > 0.0 && intensity.is_finite())
        .collect()
}

fn geometric_mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), value| {
        (sum + ln(value), count + 1.0)
    });
    exp(sum / count)
}

impl LampPlace {
    /// The irradiance on the points that only it lights, of those that have a total so far.
    fn lit<'p>(&'p self, total: &'p [f64]) -> impl Iterator<Item = f64> + 'p {
        let points = self.irradiance.iter().zip(total);
        points.filter_map(|(irradiance, total)| {
            (*total == 0.0 && *irradiance > 0.0).then_some(*irradiance)
        })
    }
}

/// The place that lights the most dark points; `None` if each lights too few of them.
fn best<'p>(places: &'p [LampPlace], total: &[f64]) -> Option<&'p LampPlace> {
    let counts = places.iter().map(|place| place.lit(total).count());
    let counts: Vec<usize> = counts.collect();
    let most = counts.iter().copied().max().unwrap_or(0) as f64;
    let is_enough = most > 0.0 && most >= MIN_SHARE * total.len() as f64;
    let rivals = places.iter().zip(&counts);
    rivals
        .filter(|(_, count)| is_enough && **count as f64 >= NEARLY * most)
        .map(|(place, _)| place)
        .max_by(|a, b| a.clearance.total_cmp(&b.clearance))
}

/// At most `count` of some points, evenly chosen.
fn thinned(points: &[SeenBehind], count: usize) -> impl Iterator<Item = SeenBehind> {
    points
        .iter()
        .copied()
        .step_by(points.len().div_ceil(count).max(1))
}

/// The ray through the middle of a pixel of the small picture.
fn view_ray(camera: &Camera, pixel: [u32; 2]) -> Ray {
    let [eye, center, right, up] =
        [camera.eye, camera.center, camera.right, camera.up].map(Vec3::from_array);
    let [x, y] = pixel.map(|at| (f64::from(at) + 0.5) / f64::from(SIDE) - 0.5);
    let [width, height] = camera.size.map(f64::from);
    let aside = right * (x * width) - up * (y * height);
    match camera.projection {
        Projection::Perspective => Ray {
            origin: eye,
            direction: center + aside - eye,
        },
        Projection::Orthographic => Ray {
            origin: eye + aside,
            direction: center - eye,
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn place(x: f64, irradiance: &[f64], clearance: f64) -> LampPlace {
        LampPlace {
            position: Vec3::new(x, 0.0, 0.0),
            irradiance: irradiance.to_vec(),
            clearance,
        }
    }

    #[test]
    fn the_best_place_lights_the_most_and_of_equals_is_the_farthest() {
        let places = [
            place(0.0, &[1.0, 1.0, 0.0, 0.0], 9.0),
            place(1.0, &[1.0, 1.0, 1.0, 0.0], 1.0),
            place(2.0, &[0.0, 1.0, 1.0, 1.0], 2.0),
        ];
        let best = |total: [f64; 4]| best(&places, &total).map(|place| place.position.x);
        assert_eq!(best([0.0; 4]), Some(2.0));
        assert_eq!(best([0.0, 1.0, 1.0, 1.0]), Some(0.0));
        assert_eq!(best([1.0; 4]), None);
    }

    #[test]
    fn lamps_have_the_irradiance_that_is_wanted_in_the_geometric_mean() {
        let places = [
            place(0.0, &[4.0, 0.25, 7.0, 0.0], 1.0),
            place(1.0, &[0.0, 0.0, 2.0, 8.0], 1.0),
        ];
        let lamps = intensities(&places, 4, 0.5);
        assert_eq!(lamps.len(), 2);
        let total = (0..4).map(|point| {
            let lights = lamps
                .iter()
                .map(|(place, intensity)| intensity * place.irradiance[point]);
            lights.sum()
        });
        assert!((geometric_mean(total) - 0.5).abs() < 1e-12);
        assert!(intensities(&[], 4, 0.5).is_empty());
    }
}
