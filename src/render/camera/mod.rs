//! Cameras: a sample of a pixel to a ray.
//!
//! [`image_point`] maps a position in the picture to the plane of focus, [`camera_ray`] makes the
//! ray through it, from a point of the lens ([`vogel`] distributes these) or, for an orthographic
//! [`Projection`], parallel to the axis. `grid` arranges the sub-samples of a pixel and the lens
//! samples of each, for the integrators other than path tracing.

pub(crate) mod grid;

use crate::lanes::{LANES, Ray4, splat};
use crate::ray::Ray;
use crate::sampler::PathVertexKey;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f64x4};
use rtc_math::{Vec3, cos_sin_revolutions, golden_revolutions};

/// A camera as its rays see it.
#[derive(Clone, Debug)]
pub struct Camera {
    /// Where rays start.
    pub eye: Vec3,
    /// The middle of the image.
    pub center: Vec3,
    /// The step to the right neighbour of a pixel.
    pub right: Vec3,
    /// The step to the upper neighbour; at a right angle to `right`.
    pub up: Vec3,
    /// The width and the height of the image in pixels, each at least 1.
    pub size: [u32; 2],
    /// The radius of the lens; 0 for a pinhole.
    pub lens_radius: f64,
    /// The points of the lens for each sub-sample; 1 for a pinhole.
    pub lens_samples: u32,
    /// The projection of the rays.
    pub projection: Projection,
    /// The left and the right eye of a stereoscopic camera.
    pub eyes: Option<Box<Eyes>>,
}

/// The two eyes of a stereoscopic camera. They see two images side by side: that of the left eye
/// begins at column 0.
#[derive(Clone, Debug)]
pub struct Eyes {
    /// The left and the right one.
    pub cameras: [Camera; 2],
    /// The column where the image of the right eye begins: the middle of the picture, or, for an
    /// anaglyph, its width.
    pub right_begins: u32,
}

impl Camera {
    /// The two eyes of a camera, each half of a distance to the side of its own. They see the same
    /// rectangle of the image plane: off-axis stereo (Hodges & McAllister, "Computing Stereoscopic
    /// Views", Stereo Computer Graphics, 1993). It is half of the image for two eyes side by side,
    /// and all of it for an anaglyph.
    pub(crate) fn with_eyes(self, distance: f64, is_anaglyph: bool) -> Self {
        let width = self.size[0];
        let side = self.right.normalize() * (distance / 2.0);
        let (right_begins, shifts) = match f64::from(width) {
            whole if is_anaglyph => (width, [0.0, whole]),
            whole => (width / 2, [-whole / 4.0, whole / 4.0]),
        };
        let eye = |sign: f64, shift: f64| Self {
            eye: self.eye + side * sign,
            center: self.center - self.right * shift,
            ..self.clone()
        };
        let eyes = Eyes {
            cameras: [eye(-1.0, shifts[0]), eye(1.0, shifts[1])],
            right_begins,
        };
        let eyes = Some(Box::new(eyes));
        Self { eyes, ..self }
    }

    /// Whether each pixel shows what both eyes see.
    pub(crate) fn is_anaglyph(&self) -> bool {
        let eyes = self.eyes.as_ref();
        eyes.is_some_and(|eyes| eyes.right_begins == self.size[0])
    }

    /// The camera that sees a pixel.
    #[inline(always)]
    #[must_use]
    pub(crate) fn of(&self, [x, _]: [u32; 2]) -> &Self {
        match &self.eyes {
            Some(eyes) => &eyes.cameras[usize::from(x >= eyes.right_begins)],
            None => self,
        }
    }
}

/// The projection of a camera.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Projection {
    /// From the lens through the point of the image.
    Perspective,
    /// Parallel, along the line from the eye to the middle of the image.
    Orthographic,
}

/// The point of the image plane at an offset within pixel (x, y), each coordinate in [0, 1] from
/// the left and upper edge: `center + (x + place₀ − width/2)·right + (height/2 − y −
/// place₁)·up`.
#[must_use]
pub fn image_point(camera: &Camera, [x, y]: [u32; 2], place: [f64; 2]) -> Vec3 {
    let across = f64::from(x) + place[0] - f64::from(camera.size[0]) / 2.0;
    let upward = f64::from(camera.size[1]) / 2.0 - f64::from(y) - place[1];
    camera.center + camera.right * across + camera.up * upward
}

/// The ray from a point of the lens through a point of the image plane, with a unit direction.
#[must_use]
pub fn camera_ray(origin: Vec3, image_point: Vec3) -> Ray {
    Ray {
        origin,
        direction: (image_point - origin).normalize(),
    }
}

/// The camera ray through a point of the lens and a point of the image plane; the rays of an
/// orthographic camera are parallel.
#[must_use]
pub(crate) fn ray_through(camera: &Camera, lens_point: Vec3, image_point: Vec3) -> Ray {
    match camera.projection {
        Projection::Perspective => camera_ray(lens_point, image_point),
        Projection::Orthographic => {
            camera_ray(lens_point + (image_point - camera.center), image_point)
        }
    }
}

/// The camera rays from the eye through four points of a pixel: the steps of [`image_point`] and
/// [`ray_through`] on all at once.
#[inline(always)]
pub(crate) fn pinhole_rays<S: Simd>(
    simd: S,
    camera: &Camera,
    [x, y]: [u32; 2],
    places: [[f64; 2]; LANES],
) -> Ray4<S> {
    let number = |x: f64| f64x4::splat(simd, x);
    let vector = |v: Vec3| splat(simd, v);
    let [left, top] = [0, 1].map(|axis| f64x4::simd_from(simd, places.map(|place| place[axis])));
    let across = number(f64::from(x)) + left - number(f64::from(camera.size[0]) / 2.0);
    let upward = number(f64::from(camera.size[1]) / 2.0) - number(f64::from(y)) - top;
    let target = vector(camera.center) + vector(camera.right) * across + vector(camera.up) * upward;
    let eye = vector(camera.eye);
    let origin = match camera.projection {
        Projection::Perspective => eye,
        Projection::Orthographic => eye + (target - vector(camera.center)),
    };
    let (_, direction) = (target - origin).try_normalize();
    Ray4 { origin, direction }
}

/// Point k of Vogel's spiral on the lens, in steps of `right` and `up`: `r = R·√(k/n)/‖up‖`, `θ =
/// k·π(3 − √5)`.
///
/// All points lie within R of the eye, and each represents the same area (Vogel, "A better way to
/// construct the sunflower head", Mathematical Biosciences 44 (1979)).
#[must_use]
pub fn vogel(k: u32, n: u32, radius: f64, pixel: f64) -> [f64; 2] {
    CranleyPatterson::NONE.vogel(k, n, radius, pixel)
}

/// A random rotation and radial shift of the spiral: a Cranley-Patterson rotation on the lens.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CranleyPatterson {
    /// In units of 2⁻⁶⁴ turns.
    rotation: u64,
    /// In [0, 1), as a fraction of the area of one point; a uniform shift makes the spiral
    /// unbiased.
    shift: f64,
}

impl CranleyPatterson {
    /// No rotation, no shift.
    const NONE: Self = Self {
        rotation: 0,
        shift: 0.0,
    };

    /// The rotation of a sub-sample; seed 0 gives [`Self::NONE`].
    #[must_use]
    #[inline]
    pub(crate) fn new(seed: u64, key: impl Fn() -> PathVertexKey) -> Self {
        if seed == 0 {
            return Self::NONE;
        }
        let key = key().child(LENS).seeded(seed);
        Self {
            rotation: key.bits(0),
            shift: key.uniform(1),
        }
    }

    fn vogel(self, k: u32, n: u32, radius: f64, pixel: f64) -> [f64; 2] {
        let r = radius * ((f64::from(k) + self.shift) / f64::from(n)).sqrt() / pixel;
        let (cosine, sine) =
            cos_sin_revolutions(golden_revolutions(u64::from(k)).wrapping_add(self.rotation));
        [r * cosine, r * sine]
    }
}

/// Makes the random numbers of the lens independent of those of sub-samples and paths.
const LENS: u64 = u64::MAX - 1;

/// Maps a point of the unit square uniformly to the lens; a pinhole ignores it.
#[must_use]
#[inline]
pub(crate) fn lens_at(camera: &Camera, point: impl FnOnce() -> [f64; 2]) -> Vec3 {
    /// 2⁶⁴.
    const TURN: f64 = 18_446_744_073_709_551_616.0;
    let radius = camera.lens_radius;
    if radius == 0.0 {
        return camera.eye;
    }
    let [fraction, turn] = point();
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a share of a turn, below one"
    )]
    let (cosine, sine) = cos_sin_revolutions((turn * TURN) as u64);
    let r = radius * fraction.sqrt() / camera.up.length();
    camera.eye + camera.right * (r * cosine) + camera.up * (r * sine)
}

/// The origin of ray k of a sub-sample.
#[inline(always)]
#[must_use]
pub(crate) fn lens_point(camera: &Camera, k: u32, rotated: CranleyPatterson) -> Vec3 {
    let n = camera.lens_samples;
    if n == 1 && rotated == CranleyPatterson::NONE {
        return camera.eye;
    }
    let [across, upward] = rotated.vogel(k, n, camera.lens_radius, camera.up.length());
    camera.eye + camera.right * across + camera.up * upward
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_eye_sees_the_image_in_its_half_of_the_picture() {
        let camera = |width: u32| Camera {
            eye: Vec3::new(1.0, 2.0, 9.0),
            center: Vec3::new(1.0, 0.0, 0.0),
            right: Vec3::new(0.5, 0.0, 0.0),
            up: Vec3::new(0.0, 0.5, 0.0),
            size: [width, 6],
            lens_radius: 0.0,
            lens_samples: 1,
            projection: Projection::Perspective,
            eyes: None,
        };
        let one = camera(8);
        for two in [
            camera(16).with_eyes(3.0, false),
            camera(8).with_eyes(3.0, true),
        ] {
            for (x, y) in (0..8).flat_map(|x| (0..6).map(move |y| (x, y))) {
                let seen = image_point(&one, [x, y], [0.25, 0.5]);
                for (left, eye) in [(0, -0.5), (8, 2.5)] {
                    let pixel = [left + x, y];
                    let half = two.of(pixel);
                    assert_eq!(half.eye, Vec3::new(eye, 2.0, 9.0));
                    assert_eq!(image_point(half, pixel, [0.25, 0.5]), seen);
                }
            }
        }
    }
}
