//! Denoiser guides of a pixel: the fraction of camera rays that hit, and the albedo, normal and
//! distance of the first hits, summed over all rays (a miss adds zero).

use super::aov::{CameraHit, FirstHitSums};
use crate::camera::Camera;
use crate::film::pixel::{Accumulator, SampleId};
use rtc_image::Guide;

/// Adds up the guide of a pixel.
pub(crate) struct GuideSums<'run> {
    camera: &'run Camera,
    sums: FirstHitSums,
}

impl<'run> GuideSums<'run> {
    pub(crate) fn new(camera: &'run Camera) -> Self {
        Self {
            camera,
            sums: FirstHitSums::default(),
        }
    }
}

impl Accumulator for GuideSums<'_> {
    type Sample = CameraHit;
    type PixelState = Guide;

    fn add(&mut self, _: &SampleId, CameraHit { direction, first }: CameraHit) {
        self.sums.add(direction, first);
    }

    /// The distance is in units of the scene.
    fn close(self) -> Guide {
        self.sums.guide(self.camera)
    }
}
