//! Denoiser guides of a pixel: the fraction of camera rays that hit, and the albedo, normal and
//! distance of the first hits, summed over all rays (a miss adds zero).

use super::aov::{CameraHit, FirstHitSums};
use crate::camera::Camera;
use crate::film::pixel::{BlockAccumulator, PixelAccumulator, PixelSample, PixelSum, SampleId};
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

/// Adds up the radiance and the guide of a pixel.
pub(crate) struct GuidedAccumulator<'run> {
    radiance: BlockAccumulator,
    guide: GuideSums<'run>,
}

impl<'run> GuidedAccumulator<'run> {
    pub(crate) fn new(camera: &'run Camera) -> Self {
        Self {
            radiance: BlockAccumulator::default(),
            guide: GuideSums::new(camera),
        }
    }
}

impl PixelAccumulator for GuidedAccumulator<'_> {
    type Sample = (PixelSample, CameraHit);
    type PixelState = (PixelSum, DenoisingGuide);

    fn add(&mut self, id: &SampleId, (sample, hit): Self::Sample) {
        self.radiance.add(id, sample);
        self.guide.add(id, hit);
    }

    fn close(self) -> Self::PixelState {
        (self.radiance.close(), self.guide.close())
    }
}
