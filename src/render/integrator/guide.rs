//! Denoiser guides of a pixel: the fraction of camera rays that hit, and the albedo, normal and
//! distance of the first hits, summed over all rays (a miss adds zero).

use super::aov::{CameraHit, FirstHitSums};
use crate::camera::Camera;
use crate::film::pixel::{PixelAccumulator, SampleId};
use rtc_image::DenoisingGuide;

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

impl PixelAccumulator for GuideSums<'_> {
    type Sample = CameraHit;
    type PixelState = DenoisingGuide;

    fn add(&mut self, _: &SampleId, CameraHit { direction, first }: CameraHit) {
        self.sums.add(direction, first);
    }

    /// The distance is in units of the scene.
    fn close(self) -> DenoisingGuide {
        self.sums.guide(self.camera)
    }
}
