//! The studio: light for scenes without light. An environment map of three softboxes in a dim room.
//!
//! The radiance of a white diffuse surface is 0.12 if it faces down, 0.75 if it faces the front
//! (+z), and at most 1.2, if it faces up; so a reflectance of 0.8 is never overexposed. The mean
//! radiance of the studio is 0.57.

use rtc_ir::{Environment, Image, Pixels, Scene};
use rtc_math::{Vec3, acos, atan2, cos, pow, sin};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// The size of the environment map: a pixel spans less than 6°, about half of the soft edge of a
/// softbox.
const SIZE: [u32; 2] = [64, 32];
/// The radiance of the room, above and below.
const ROOM: [f64; 2] = [0.3, 0.12];
/// The width of the transition at the horizon and at the edge of a softbox, in degrees.
const HORIZON: f64 = 30.0;
const EDGE: f64 = 10.0;
/// The brightness of the studio as a fill light.
const FILL: f64 = 0.5;

/// A softbox: the azimuth (from +z towards +x) and elevation of its centre, half its width and
/// height, in degrees, and its radiance.
struct SoftBox {
    middle: [f64; 2],
    half: [f64; 2],
    radiance: f64,
}

/// The key light from the left and above, a fill light from the right, and a rim light from behind.
const BOXES: [SoftBox; 3] = [
    SoftBox {
        middle: [-35.0, 45.0],
        half: [30.0, 20.0],
        radiance: 5.0,
    },
    SoftBox {
        middle: [70.0, 20.0],
        half: [20.0, 30.0],
        radiance: 1.5,
    },
    SoftBox {
        middle: [170.0, 50.0],
        half: [35.0, 15.0],
        radiance: 2.5,
    },
];

impl SoftBox {
    fn at(&self, [azimuth, elevation]: [f64; 2]) -> f64 {
        let across = (azimuth - self.middle[0] + 540.0).rem_euclid(360.0) - 180.0;
        let offsets = [across, elevation - self.middle[1]];
        let falloff =
            |axis: usize| 1.0 - smooth((offsets[axis].abs() - self.half[axis]) / EDGE + 0.5);
        self.radiance * falloff(0) * falloff(1)
    }
}

/// The smoothstep from 0 to 1.
pub(super) fn smooth(x: f64) -> f64 {
    let x = x.clamp(0.0, 1.0);
    x * x * (3.0 - 2.0 * x)
}

/// The radiance of the studio in a direction (a unit vector).
fn radiance(direction: Vec3) -> f64 {
    let azimuth = atan2(direction.x, direction.z).to_degrees();
    let elevation = (FRAC_PI_2 - acos(direction.y.clamp(-1.0, 1.0))).to_degrees();
    let room = ROOM[1] + (ROOM[0] - ROOM[1]) * smooth(elevation / HORIZON + 0.5);
    room + BOXES
        .iter()
        .map(|one| one.at([azimuth, elevation]))
        .sum::<f64>()
}

/// The direction to the centre of the key light (a unit vector).
pub(super) fn key_light_direction() -> Vec3 {
    let [azimuth, elevation] = BOXES[0].middle.map(f64::to_radians);
    Vec3::new(
        sin(azimuth) * cos(elevation),
        sin(elevation),
        cos(azimuth) * cos(elevation),
    )
}

/// The direction of a pixel of the environment map: the centre of the map is −z, +y is up.
fn direction(x: u32, y: u32) -> Vec3 {
    let longitude = ((f64::from(x) + 0.5) / f64::from(SIZE[0]) - 0.5) * TAU;
    let colatitude = (f64::from(y) + 0.5) / f64::from(SIZE[1]) * PI;
    Vec3::new(
        sin(colatitude) * sin(longitude),
        cos(colatitude),
        -sin(colatitude) * cos(longitude),
    )
}

/// The environment map of the studio.
fn picture() -> Image {
    let pixels = (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| direction(x, y)));
    #[expect(
        clippy::cast_possible_truncation,
        reason = "rounds to the nearest float"
    )]
    let bytes: Vec<u8> = pixels
        .flat_map(|direction| [(radiance(direction) as f32).to_le_bytes(); 3].concat())
        .collect();
    Image {
        name: String::new(),
        width: SIZE[0],
        height: SIZE[1],
        kind: Pixels::Rgb32f,
        pixels: bytes.into(),
    }
}

/// Sets the studio as the environment of a scene, scaled by a factor.
pub(super) fn install(scene: &mut Scene, factor: f64) {
    let image = scene.add_image(picture());
    scene.environment = Some(Environment {
        radiance: [factor; 3],
        image: Some(image),
        image_from_world: None,
    });
}

/// Sets the studio as a fill light for a picture with an exposure of `stops`.
pub fn fill(scene: &mut Scene, stops: f64) {
    install(scene, FILL * pow(2.0, -stops));
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The radiance of a white diffuse surface with this normal in the studio.
    fn reflected_radiance(normal: Vec3) -> f64 {
        let [width, height] = SIZE.map(f64::from);
        let pixels = (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| (y, direction(x, y))));
        let sum: f64 = pixels
            .map(|(y, from)| {
                radiance(from) * normal.dot(from).max(0.0) * sin((f64::from(y) + 0.5) / height * PI)
            })
            .sum();
        sum * (PI / height) * (TAU / width) / PI
    }

    #[test]
    fn white_has_the_promised_radiance_in_the_studio() {
        let (front, below) = (reflected_radiance(Vec3::Z), reflected_radiance(Vec3::NEG_Y));
        assert!(
            (front - 0.75).abs() < 0.02 && (below - 0.12).abs() < 0.02,
            "{front} {below}"
        );
        let normals = (0..8).flat_map(|y| (0..16).map(move |x| direction(4 * x, 4 * y)));
        let most = normals.map(reflected_radiance).fold(0.0, f64::max);
        assert!((1.1..1.25).contains(&most), "{most}");
    }

    #[test]
    fn the_key_light_is_where_it_is_brightest() {
        let brightest = (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| direction(x, y)));
        let brightest = brightest
            .max_by(|a, b| radiance(*a).total_cmp(&radiance(*b)))
            .unwrap();
        assert!(
            brightest.dot(key_light_direction()) > 0.9 && radiance(key_light_direction()) > 5.0
        );
    }
}
