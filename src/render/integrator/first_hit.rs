//! Depth buffers: the distance from the eye to the first hit, along the ray through the centre of
//! each pixel.

use super::Integrator;
use crate::camera::grid::SampleGrid;
use crate::film::heartbeat::{Heartbeat, PixelObserver};
use crate::film::pixel::{PixelAccumulator, PixelSum, SampleId};
use crate::film::{RayCounts, SamplingSeeds};
use crate::shape::geometry::Intersect;
use crate::world::World;
use rtc_math::Vec3;
use rtc_plan::Effect;

/// Finds distances.
pub(crate) struct DepthIntegrator<'run, S> {
    world: &'run World<S>,
    heartbeat: Heartbeat<'run>,
    counts: RayCounts,
}

impl<'run, S: Intersect> DepthIntegrator<'run, S> {
    pub(crate) fn new(world: &'run World<S>, on_pixel: &'run PixelObserver<'run>) -> Self {
        Self {
            world,
            heartbeat: Heartbeat::new(on_pixel),
            counts: RayCounts::default(),
        }
    }
}

impl<'run, S: Intersect> Integrator<'run> for DepthIntegrator<'run, S> {
    type Sample = Option<f64>;

    fn sample(&mut self, id: &SampleId) -> Option<f64> {
        let camera = self.world.camera.of(id.pixel);
        let middle = SampleGrid::MIDDLE.cell(camera, id.pixel, [0; 2], SamplingSeeds::NONE);
        self.counts.camera += 1;
        self.counts.add(Effect::DepthBuffer);
        let hit = self.world.closest_hit(&middle.ray(camera, 0))?;
        self.counts.hits += 1;
        Some(hit.t)
    }

    fn counts(&self) -> &RayCounts {
        &self.counts
    }

    fn heartbeat(&mut self) -> &mut Heartbeat<'run> {
        &mut self.heartbeat
    }

    #[inline]
    fn should_continue(&mut self) -> bool {
        self.heartbeat.should_continue(&self.counts)
    }
}

/// Keeps the one distance of a pixel.
#[derive(Default)]
pub(crate) struct PixelDistance(PixelSum);

impl PixelAccumulator for PixelDistance {
    type Sample = Option<f64>;
    type PixelState = PixelSum;

    fn add(&mut self, _: &SampleId, distance: Option<f64>) {
        self.0 = PixelSum {
            radiance: Vec3::splat(distance.unwrap_or(0.0)),
            hits: distance.is_some().into(),
            samples: 1,
        };
    }

    fn close(self) -> PixelSum {
        self.0
    }
}
