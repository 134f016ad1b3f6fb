//! Four samples of a pixel at once, one per lane, for scenes whose ray trees do not branch.
//!
//! Each lane does the operations of [`WhittedTracer::radiance`] for its ray in the same order, so
//! the bytes are the same. Operations without a four-lane form run lane by lane. At the
//! scalar level rays are traced one by one (`docs/book/src/decisions/0006`).

mod shade;

use super::WhittedTracer;
use crate::accel::simd::at_level;
use crate::camera::pinhole_rays;
use crate::film::SamplingSeeds;
use crate::film::pixel::{PixelSample, SampleId, SampleStream};
use crate::integrator::Integrator;
use crate::lanes::{ALL, FourVectors, LANES, Ray4, four_interactions, four_rays, lanes_of, splat};
use crate::ray::Interactions;
use crate::shape::geometry::Intersect;
use crate::shape::tie::CLOSE;
use crate::world::settings::Mode;
use crate::world::small_scene::SmallScene;
use crate::world::{Hit, SurfaceId, World};
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f64x4, mask64x4};
use rtc_math::Vec3;
use rtc_plan::WhittedFeatures;

/// What four rays hit first.
struct FourHits<V: Simd> {
    /// Infinite for none.
    t: f64x4<V>,
    surfaces: [SurfaceId; LANES],
    prims: [u32; LANES],
    /// The lanes that hit something.
    hit_lanes: u64,
}

/// Points as their viewers see them.
struct FourPoints<V: Simd> {
    at: Interactions<f64x4<V>>,
    /// The normal on the side of the viewer.
    normal: FourVectors<V>,
    to_viewer: FourVectors<V>,
    color: FourVectors<V>,
    ka: f64x4<V>,
    kd: f64x4<V>,
    ks: f64x4<V>,
    kr: f64x4<V>,
    n: f64x4<V>,
    /// The index of the surface in the scene.
    surfaces: [usize; LANES],
    /// The lanes that have a point.
    hit_lanes: u64,
}

impl<S: Intersect, const F: u32> WhittedTracer<'_, S, F> {
    /// Whether the integrator has all its features in lanes.
    const HAS_SHAPE4: bool = {
        let others = WhittedFeatures::MAPS
            .with(WhittedFeatures::UNPRUNED)
            .with(WhittedFeatures::SAMPLED)
            .with(WhittedFeatures::GOOCH);
        S::HAS_SHAPE4 && Self::can(WhittedFeatures::CAMERA) && F & others.0 == 0
    };

    /// Whether samples of a world are taken four at a time.
    pub(super) fn goes_by_four(world: &World<S>) -> bool {
        Self::HAS_SHAPE4
            && world.small_scene.is_some()
            && matches!(world.settings.mode, Mode::Phong)
            && world.phongs.iter().all(|phong| phong.kt.get() == 0.0)
    }

    /// The next four samples of a picture.
    pub(super) fn four_samples(&mut self, id: &SampleId) -> Option<[PixelSample; LANES]> {
        if !Self::HAS_SHAPE4 || !self.by_four || self.pixel.is_uniform {
            return None;
        }
        let SampleStream::Picture(seeds) = id.stream else {
            return None;
        };
        at_level!(self.world.simd, simd => {
            let rays = self.rays_of_picture(simd, id.pixel, seeds);
            Some(self.radiances(simd, rays))
        }, scalar => None)
    }

    /// The rays of the next four samples.
    #[inline(always)]
    fn rays_of_picture<V: Simd>(
        &mut self,
        simd: V,
        pixel: [u32; 2],
        seeds: SamplingSeeds,
    ) -> Ray4<V> {
        let camera = self.world.camera.of(pixel);
        if !self.grid.starts_at_eye(camera, seeds) {
            // Written out: `map` of an array is not inlined here.
            let mut next = || self.ray_of_picture(pixel, seeds);
            return four_rays(simd, &[next(), next(), next(), next()]);
        }
        let grid = self.grid;
        let mut next = || {
            let [column, row, _] = self.next_place();
            grid.place_in(pixel, [column, row], seeds)
        };
        let places = [next(), next(), next(), next()];
        pinhole_rays(simd, camera, pixel, places)
    }

    /// What four camera rays see.
    #[inline(always)]
    fn radiances<V: Simd>(&mut self, simd: V, mut rays: Ray4<V>) -> [PixelSample; LANES] {
        let depth = self.world.plan.max_depth;
        let number = |x: f64| f64x4::splat(simd, x);
        let mut sum = splat(simd, Vec3::ZERO);
        let (mut beta, mut active, mut first) = (number(1.0), ALL, 0);
        self.counts.camera += LANES as u64;
        for bounce in 0..=depth {
            if bounce > 0 && !self.should_continue() {
                break;
            }
            self.bounces = bounce;
            // Find the closest hits and their surface points.
            let hits = self.hits(simd, &rays, active);
            if bounce == 0 {
                first = hits.hit_lanes;
                self.counts.hits += u64::from(first.count_ones());
            }
            let Some(points) = self.points(simd, &rays, &hits) else {
                break;
            };
            // Add the local shading, weighted by the path.
            let value = self.phong_of(simd, &points) * beta;
            let hit_lanes = mask64x4::from_bitmask(simd, hits.hit_lanes);
            sum = (sum + value).select(hit_lanes, sum);
            if !Self::can(WhittedFeatures::BOUNCE) || bounce == depth {
                break;
            }
            // Weight the mirrored rays; lanes without weight end.
            let weight = beta * points.kr;
            let weight = weight
                .simd_lt(number(f64::MAX))
                .select(weight, number(f64::MAX));
            active = hits.hit_lanes & weight.simd_gt(number(0.0)).to_bitmask();
            if active == 0 {
                break;
            }
            self.counts.mirror += u64::from(active.count_ones());
            rays = mirrored(simd, &rays, &points);
            beta = weight;
        }
        let sample = |lane: usize| PixelSample {
            radiance: sum.lane(lane),
            hit: first >> lane & 1 == 1,
        };
        let samples = [sample(0), sample(1), sample(2), sample(3)];
        let unnumbered = samples.iter().filter(|sample| sample.radiance.is_nan());
        self.counts.unnumbered += unnumbered.count() as u64;
        samples
    }

    /// The closest hits of the rays of some lanes.
    #[inline(always)]
    fn hits<V: Simd>(&mut self, simd: V, rays: &Ray4<V>, active: u64) -> FourHits<V> {
        let world = self.world;
        let none = f64x4::splat(simd, f64::INFINITY);
        let mut hits = FourHits {
            t: none,
            surfaces: [SurfaceId::NONE; LANES],
            prims: [0; LANES],
            hit_lanes: 0,
        };
        let Some(small_scene) = &world.small_scene else {
            return hits;
        };
        // Look up the candidates of all rays in the ray-cone cache.
        let bounce = self.bounces as usize;
        let (bundled, mut items) =
            self.bundles
                .along_each(simd, &small_scene.balls, bounce, rays, active);
        let cone_lanes = mask64x4::from_bitmask(simd, bundled);
        // Keep the nearest root of each lane, and the second one for ties.
        let mut next = none;
        while let Some(surface) = SmallScene::pop(&mut items) {
            let shape = &world.surfaces[surface].shape;
            let t = match shape.shape4() {
                Some(shape) => shape.intersect(rays, cone_lanes),
                None => roots(shape, rays, &mut hits, bundled),
            };
            let closer = t.simd_lt(hits.t);
            next = closer.select(hits.t, t.simd_lt(next).select(t, next));
            hits.t = closer.select(t, hits.t);
            for lane in lanes_of(closer.to_bitmask()) {
                hits.surfaces[lane] = surface;
            }
        }
        hits.hit_lanes = hits.t.simd_lt(none).to_bitmask();
        // Resolve ties, and rays outside of the cone, one by one.
        let tied = next
            .simd_le(hits.t * f64x4::splat(simd, CLOSE))
            .to_bitmask()
            & hits.hit_lanes;
        let odd = active & !bundled;
        if tied | odd != 0 {
            for lane in lanes_of(tied | odd) {
                let hit = if odd >> lane & 1 == 1 {
                    world.closest_hit(&rays.lane(lane))
                } else {
                    world.resolved(&rays.lane(lane), hits.t[lane])
                };
                hits.put(lane, hit);
            }
        }
        hits
    }

    /// The points that rays hit, if any.
    #[inline(always)]
    fn points<V: Simd>(
        &self,
        simd: V,
        rays: &Ray4<V>,
        hits: &FourHits<V>,
    ) -> Option<FourPoints<V>> {
        let number = |x: f64| f64x4::splat(simd, x);
        let mut rest = hits.hit_lanes;
        let mut all: Option<FourPoints<V>> = None;
        while rest != 0 {
            // Take the lanes that hit one surface together.
            let surface = hits.surfaces[rest.trailing_zeros() as usize];
            let same = lanes_of(rest).filter(|lane| hits.surfaces[*lane] == surface);
            let same = same.fold(0, |bits, lane| bits | 1 << lane);
            rest &= !same;
            let surface = &self.world.surfaces[surface];
            let material = &self.world.phongs[surface.material];
            let shape = &surface.shape;
            // Compute the surface points and the material of these lanes.
            let at = match shape.shape4() {
                Some(shape) => shape.interactions(rays, hits.t),
                None => interactions(simd, shape, rays, hits, same),
            };
            let is_back = rays.direction.dot(at.normal).simd_gt(number(0.0));
            let of_surface = FourPoints {
                at,
                normal: (-at.normal).select(is_back, at.normal),
                to_viewer: -rays.direction,
                color: splat(simd, material.color),
                ka: number(material.ka.get()),
                kd: number(material.kd.get()),
                ks: number(material.ks.get()),
                kr: number(material.kr.unwrap_or(material.ks).get()),
                n: number(material.n.get()),
                surfaces: [surface.index; LANES],
                hit_lanes: hits.hit_lanes,
            };
            all = Some(match all {
                None => of_surface,
                Some(others) => of_surface.select(simd, same, others),
            });
        }
        all
    }
}

impl<V: Simd> FourHits<V> {
    /// Replaces the hit of a lane.
    fn put(&mut self, lane: usize, hit: Option<Hit>) {
        let bit = 1 << lane;
        self.hit_lanes = if hit.is_some() {
            self.hit_lanes | bit
        } else {
            self.hit_lanes & !bit
        };
        if let Some(Hit {
            t,
            surface,
            prim_id,
        }) = hit
        {
            self.t[lane] = t;
            (self.surfaces[lane], self.prims[lane]) = (surface, prim_id);
        }
    }
}

impl<V: Simd> FourPoints<V> {
    /// Selects `self` in some lanes, and `others` elsewhere.
    #[inline(always)]
    fn select(self, simd: V, lanes: u64, others: Self) -> Self {
        let mask = mask64x4::from_bitmask(simd, lanes);
        let mut surfaces = others.surfaces;
        for lane in lanes_of(lanes) {
            surfaces[lane] = self.surfaces[lane];
        }
        Self {
            at: self.at.select(mask, others.at),
            normal: self.normal.select(mask, others.normal),
            to_viewer: self.to_viewer,
            color: self.color.select(mask, others.color),
            ka: mask.select(self.ka, others.ka),
            kd: mask.select(self.kd, others.kd),
            ks: mask.select(self.ks, others.ks),
            kr: mask.select(self.kr, others.kr),
            n: mask.select(self.n, others.n),
            surfaces,
            hit_lanes: self.hit_lanes,
        }
    }
}

/// The rays reflected at points where the shading normal is the geometric normal.
#[inline(always)]
fn mirrored<V: Simd>(simd: V, rays: &Ray4<V>, points: &FourPoints<V>) -> Ray4<V> {
    let number = |x: f64| f64x4::splat(simd, x);
    let (d, n) = (rays.direction, points.normal);
    let along = d - n * (number(2.0) * d.dot(n));
    let direction = along * (number(1.0) / along.length());
    Ray4 {
        origin: points.at.start(direction),
        direction,
    }
}

/// The roots of a shape that has no form in lanes, and their primitives where they are closer.
fn roots<V: Simd, S: Intersect>(
    shape: &S,
    rays: &Ray4<V>,
    hits: &mut FourHits<V>,
    lanes: u64,
) -> f64x4<V> {
    let mut roots = f64x4::splat(hits.t.simd, f64::INFINITY);
    for lane in lanes_of(lanes) {
        let ray = rays.lane(lane);
        let watertight = SmallScene::shear_of(shape, &ray);
        if let Some((t, prim_id)) = shape.closest_hit(&ray, &watertight, hits.t[lane] * CLOSE) {
            roots[lane] = t;
            if t < hits.t[lane] {
                hits.prims[lane] = prim_id;
            }
        }
    }
    roots
}

/// The interactions with a shape that has no form in lanes.
fn interactions<V: Simd, S: Intersect>(
    simd: V,
    shape: &S,
    rays: &Ray4<V>,
    hits: &FourHits<V>,
    lanes: u64,
) -> Interactions<f64x4<V>> {
    let at = |lane: usize| shape.interaction(&rays.lane(lane), hits.t[lane], hits.prims[lane]);
    let mut all = [at(lanes.trailing_zeros() as usize); LANES];
    for lane in lanes_of(lanes & (lanes - 1)) {
        all[lane] = at(lane);
    }
    four_interactions(simd, &all)
}
