//! AOVs for denoisers and compositors: the first hits of the camera rays of a pixel, averaged over
//! the rays that hit. The rays are the same as for the colours.

use super::Integrator;
use crate::camera::Camera;
use crate::film::RayCounts;
use crate::film::heartbeat::Heartbeat;
use crate::film::pixel::{PixelAccumulator, SampleId};
use rtc_image::DenoisingGuide;
use rtc_math::Vec3;
use serde::{Deserialize, Serialize};

/// A layer. All are zero without a hit, except the depth.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub enum Aov {
    /// The base colour, maps included, linear, in [0, 1]; C·kd of Phong's model.
    Albedo,
    /// The shading normal in the world, maps included, on the side of the viewer; shorter than 1
    /// where normals differ.
    Normal,
    /// The distance from the eye along the axis of view, in units of the scene; 1e10 without a hit.
    Depth,
    /// The first texture coordinates, if there are any.
    Uv,
    /// The number of the surface in the scene, from 1, that the first ray hits: an integer, exact
    /// below 2²⁴.
    Instance,
    /// The position in the world.
    Position,
    /// The standard error of each channel, of display values: half the difference of the two
    /// replicates of pictures to a target error or within a time, and of two halves of the samples
    /// of other path-traced pictures (at least 17 samples).
    Error,
    /// The number of samples, those of a pilot included; of the same pictures.
    Samples,
    /// A bound, in multiples of white, on the change of the pixel by light that no sample may have
    /// hit (95 %): 1 where there is no bound; of the same pictures.
    #[serde(rename = "unmet")]
    Undersampled,
}

/// The depth without a hit, as in other renderers.
const FAR: f64 = 1e10;

impl Aov {
    /// All of them.
    pub const ALL: [Self; 9] = [
        Self::Albedo,
        Self::Normal,
        Self::Depth,
        Self::Uv,
        Self::Instance,
        Self::Position,
        Self::Error,
        Self::Samples,
        Self::Undersampled,
    ];

    /// Its name, which the names of its channels begin with.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Albedo => "albedo",
            Self::Normal => "normal",
            Self::Depth => "depth",
            Self::Uv => "uv",
            Self::Instance => "instance",
            Self::Position => "position",
            Self::Error => "error",
            Self::Samples => "samples",
            Self::Undersampled => "unmet",
        }
    }

    /// The names of the channels, as denoisers and compositors expect them.
    #[must_use]
    pub fn channels(self) -> &'static [&'static str] {
        match self {
            Self::Albedo => &["albedo.R", "albedo.G", "albedo.B"],
            Self::Normal => &["normal.X", "normal.Y", "normal.Z"],
            Self::Depth => &["depth.Z"],
            Self::Uv => &["uv.U", "uv.V"],
            Self::Instance => &["instance.X"],
            Self::Position => &["position.X", "position.Y", "position.Z"],
            Self::Error => &["error.R", "error.G", "error.B"],
            Self::Samples => &["samples.X"],
            Self::Undersampled => &["unmet.X"],
        }
    }

    /// Whether it is a statistic of the samples of a progressive pixel, not of first hits.
    #[must_use]
    pub fn is_of_samples(self) -> bool {
        matches!(self, Self::Error | Self::Samples | Self::Undersampled)
    }
}

/// The first hit of a camera ray, in detail.
#[derive(Clone, Copy)]
pub(crate) struct FirstHitDetails {
    pub(crate) albedo: Vec3,
    /// On either side.
    pub(crate) normal: Vec3,
    pub(crate) point: Vec3,
    pub(crate) uv: Option<[f64; 2]>,
    /// The index of the surface in the scene.
    pub(crate) surface: usize,
}

/// The first hit of a camera ray.
#[derive(Clone, Copy)]
pub(crate) struct CameraHit {
    /// The direction of the ray.
    pub(crate) direction: Vec3,
    /// The first hit, if there is one.
    pub(crate) first: Option<FirstHitDetails>,
}

/// An integrator that can find the first hit of a camera ray without following it further.
pub(crate) trait FindFirstHit<'run>: Integrator<'run> {
    /// The first hit of the camera ray of a sample.
    fn first_hit(&mut self, id: &SampleId) -> CameraHit;
}

/// Finds first hits alone, along the camera rays of another integrator.
pub(crate) struct FirstHitFinder<I>(pub(crate) I);

impl<'run, I: FindFirstHit<'run>> Integrator<'run> for FirstHitFinder<I> {
    type Sample = CameraHit;

    fn sample(&mut self, id: &SampleId) -> CameraHit {
        self.0.first_hit(id)
    }

    fn counts(&self) -> &RayCounts {
        self.0.counts()
    }

    fn heartbeat(&mut self) -> &mut Heartbeat<'run> {
        self.0.heartbeat()
    }

    fn should_continue(&mut self) -> bool {
        self.0.should_continue()
    }
}

/// The number of channels of all layers together.
pub(crate) const CHANNELS: usize = 16;

/// Adds up layers of a pixel.
pub(crate) struct AovAccumulator<'run> {
    wanted: &'run [Aov],
    camera: &'run Camera,
    sums: FirstHitSums,
}

impl<'run> AovAccumulator<'run> {
    pub(crate) fn new(wanted: &'run [Aov], camera: &'run Camera) -> Self {
        Self {
            wanted,
            camera,
            sums: FirstHitSums::default(),
        }
    }
}

impl PixelAccumulator for AovAccumulator<'_> {
    type Sample = CameraHit;
    type PixelState = arrayvec::ArrayVec<f32, CHANNELS>;

    fn add(&mut self, _: &SampleId, CameraHit { direction, first }: CameraHit) {
        self.sums.add(direction, first);
    }

    /// The values of all requested channels in sequence.
    #[expect(
        clippy::cast_possible_truncation,
        reason = "rounds to the nearest float, or to infinity"
    )]
    fn close(self) -> Self::PixelState {
        let values = |aov: &Aov| {
            let values = self.sums.values(*aov, self.camera);
            values.into_iter().take(aov.channels().len())
        };
        self.wanted
            .iter()
            .flat_map(values)
            .map(|value| value as f32)
            .collect()
    }
}

/// The sums over the rays of a pixel.
#[derive(Default)]
pub(crate) struct FirstHitSums {
    rays: u32,
    hits: u32,
    albedo: Vec3,
    normal: Vec3,
    point: Vec3,
    uv: Vec3,
    hits_with_uv: u32,
    /// The number of the surface that the first ray hit.
    instance: usize,
}

impl FirstHitSums {
    /// Adds the first hit of a ray in this direction.
    pub(super) fn add(&mut self, direction: Vec3, first: Option<FirstHitDetails>) {
        self.rays += 1;
        let Some(FirstHitDetails {
            albedo,
            normal,
            point,
            uv,
            surface,
        }) = first
        else {
            return;
        };
        if self.rays == 1 {
            self.instance = surface + 1;
        }
        self.hits += 1;
        self.albedo += albedo.clamp(Vec3::ZERO, Vec3::ONE);
        self.normal += if normal.dot(direction) > 0.0 {
            -normal
        } else {
            normal
        };
        self.point += point;
        if let Some([u, v]) = uv {
            self.uv += Vec3::new(u, v, 0.0);
            self.hits_with_uv += 1;
        }
    }

    /// The guide of a denoiser: all means are over all rays.
    pub(super) fn guide(&self, camera: &Camera) -> DenoisingGuide {
        let mean = |sum: Vec3| sum / f64::from(self.rays.max(1));
        let coverage = f64::from(self.hits) / f64::from(self.rays.max(1));
        let (albedo, normal) = (mean(self.albedo), mean(self.normal));
        let distance = if self.hits == 0 {
            0.0
        } else {
            coverage * depth(camera, self.point / f64::from(self.hits))
        };
        [
            coverage, albedo.x, albedo.y, albedo.z, normal.x, normal.y, normal.z, distance,
        ]
    }

    /// The values of the channels of a layer.
    fn values(&self, aov: Aov, camera: &Camera) -> [f64; 3] {
        let mean = |sum: Vec3, count: u32| sum / f64::from(count.max(1));
        match aov {
            Aov::Albedo => mean(self.albedo, self.hits).to_array(),
            Aov::Normal => mean(self.normal, self.hits).to_array(),
            Aov::Depth if self.hits == 0 => [FAR; 3],
            Aov::Depth => [depth(camera, mean(self.point, self.hits)); 3],
            Aov::Uv => mean(self.uv, self.hits_with_uv).to_array(),
            Aov::Instance => [self.instance as f64; 3],
            Aov::Position => mean(self.point, self.hits).to_array(),
            Aov::Error | Aov::Samples | Aov::Undersampled => [0.0; 3],
        }
    }
}

/// The distance of a point from the eye along the normal of the image plane.
fn depth(camera: &Camera, point: Vec3) -> f64 {
    let [right, up] = [camera.right, camera.up].map(Vec3::normalize_or_zero);
    let normal = up.cross(right).normalize_or_zero();
    let forward = if normal.dot(camera.center - camera.eye) < 0.0 {
        -normal
    } else {
        normal
    };
    (point - camera.eye).dot(forward)
}
