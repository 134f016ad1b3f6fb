//! Phong's model in four lanes, with its shadow rays.

use super::FourPoints;
use crate::bsdf::optics::highlight;
use crate::integrator::whitted::WhittedTracer;
use crate::lanes::pow::powers;
use crate::lanes::{FourVectors, LANES, Ray4, lanes_of, splat};
use crate::shape::geometry::Intersect;
use crate::world::CourseLightId;
use crate::world::END;
use crate::world::small_scene::SmallScene;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f64x4, mask64x4};
use rtc_math::Vec3;
use rtc_plan::{Effect, WhittedFeatures};

impl<S: Intersect, const F: u32> WhittedTracer<'_, S, F> {
    /// As [`WhittedTracer::phong`].
    #[inline(always)]
    pub(super) fn phong_of<V: Simd>(&mut self, simd: V, points: &FourPoints<V>) -> FourVectors<V> {
        let world = self.world;
        let zero = splat(simd, Vec3::ZERO);
        let ambient = points.color * points.ka;
        let (mut sum, ambient) = match world.settings.ambient_light {
            Some(light) => (splat(simd, light).times_each(ambient), zero),
            None => (zero, ambient),
        };
        for (index, light) in world.lights.course.entries() {
            let plan = &world.plan.lights[index];
            if !plan.is_used {
                continue;
            }
            let mut term = ambient;
            if Self::can(WhittedFeatures::LIGHT) && plan.direct {
                term = self.with_direct(simd, points, term, index);
            }
            sum = sum + splat(simd, light.color).times_each(term);
        }
        sum
    }

    /// As `WhittedTracer::direct`, added to `term`.
    #[inline(always)]
    fn with_direct<V: Simd>(
        &mut self,
        simd: V,
        points: &FourPoints<V>,
        term: FourVectors<V>,
        light: CourseLightId,
    ) -> FourVectors<V> {
        let number = |x: f64| f64x4::splat(simd, x);
        let zero = number(0.0);
        let place = self.world.lights.course[light].position;
        let diffuse = points.color * points.kd;
        let is_black = diffuse.x.simd_eq(zero) & diffuse.y.simd_eq(zero) & diffuse.z.simd_eq(zero);
        let mut shines = points.ks.simd_gt(zero).to_bitmask();
        if !Self::can(WhittedFeatures::HIGHLIGHT) {
            shines = 0;
        }
        // Exclude lanes that reflect no light.
        let mut lit = points.hit_lanes & !(is_black.to_bitmask() & !shines);
        self.counts
            .add_several(Effect::DirectLight, lit.count_ones());

        // Exclude lanes that face away from the light, or are in its shadow.
        let to_light = splat(simd, place) - points.at.point;
        let (has_way, to_light) = to_light.try_normalize();
        let n_dot_l = points.normal.dot(to_light);
        let is_before = n_dot_l.simd_gt(zero);
        lit &= has_way.to_bitmask();
        if self.world.settings.shadows {
            lit &= is_before.to_bitmask();
            if Self::can(WhittedFeatures::SHADOW) && lit != 0 {
                lit = self.unshadowed(simd, points, light, lit);
            }
        }
        if lit == 0 {
            return term;
        }
        // Add the diffuse term.
        let cosine = is_before.select(n_dot_l, zero);
        let mut direct = points.color * (points.kd * cosine);
        // Add the highlight.
        shines &= lit;
        if shines != 0 {
            self.counts
                .add_several(Effect::Highlight, shines.count_ones());
            let reflected = points.normal * (number(2.0) * n_dot_l) - to_light;
            let gloss = points.ks * highlights(reflected.dot(points.to_viewer), points.n, shines);
            let shines = mask64x4::from_bitmask(simd, shines);
            direct = direct.map(|channel| channel + gloss).select(shines, direct);
        }
        (term + direct).select(mask64x4::from_bitmask(simd, lit), term)
    }

    /// As `WhittedTracer::towards`, from the points of some lanes.
    #[inline(always)]
    fn towards_each<V: Simd>(
        &mut self,
        small_scene: &SmallScene,
        light: CourseLightId,
        from: FourVectors<V>,
        active: u64,
    ) -> [u64; LANES] {
        let lights = &self.world.lights.course;
        let place = [self.bounces as usize, light.index(), lights.len()];
        let target = || lights[light].ball();
        self.bundles
            .towards_each(&small_scene.balls, place, from, active, target)
    }

    /// The lanes, of some, whose point sees a light.
    #[inline(always)]
    fn unshadowed<V: Simd>(
        &mut self,
        simd: V,
        points: &FourPoints<V>,
        light: CourseLightId,
        active: u64,
    ) -> u64 {
        let world = self.world;
        let Some(small_scene) = &world.small_scene else {
            return active;
        };
        // Collect the possible occluders of each lane.
        let plan = &world.plan.lights[light];
        let (mut hiding, mut all, mut doubted) = ([0; LANES], 0, 0);
        for lane in lanes_of(active) {
            let surface = points.surfaces[lane];
            if plan.shadowed[surface] {
                self.counts.shadow += 1;
                hiding[lane] = small_scene.hiding(light, surface);
                doubted |= u64::from(hiding[lane] != 0) << lane;
            }
        }
        if doubted == 0 {
            return active;
        }
        // Keep those that the cone of shadow rays may hit.
        let between = self.towards_each(small_scene, light, points.at.point, doubted);
        for lane in lanes_of(doubted) {
            hiding[lane] &= between[lane];
            all |= hiding[lane];
            doubted &= !(u64::from(hiding[lane] == 0) << lane);
        }
        if doubted == 0 {
            return active;
        }
        // Trace the shadow rays against the remaining occluders.
        let target = world.lights.course[light].position;
        let to = splat(simd, target);
        let origin = points.at.start(to - points.at.point);
        let direction = to - origin;
        let rays = Ray4 { origin, direction };
        let mut hidden = 0;
        // Rays that need scaling are traced one by one.
        for lane in lanes_of(doubted) {
            if !rays.lane(lane).is_scaled() {
                doubted &= !(1 << lane);
                let is_hidden = world.occluded(origin.lane(lane), target);
                hidden |= u64::from(is_hidden) << lane;
            }
        }
        // Test each occluder against the lanes that need it.
        let end = ends(simd, &rays, to);
        while let Some(surface) = SmallScene::pop(&mut all) {
            let of_surface = |lane: &usize| hiding[*lane] >> surface.index() & 1 == 1;
            let lanes = lanes_of(doubted & !hidden).filter(of_surface);
            let lanes = lanes.fold(0, |bits, lane| bits | 1 << lane);
            if lanes == 0 {
                continue;
            }
            let shape = &world.surfaces[surface].shape;
            let t = match shape.shape4() {
                Some(shape) => shape.intersect(&rays, mask64x4::from_bitmask(simd, lanes)),
                None => first_roots(shape, &rays, lanes),
            };
            hidden |= t.simd_lt(end).to_bitmask() & lanes;
        }
        active & !hidden
    }
}

/// The ends of rays to one point, as [`crate::world::segment`] says; 0 where both ends are equal
/// within rounding.
#[inline(always)]
fn ends<V: Simd>(simd: V, rays: &Ray4<V>, to: FourVectors<V>) -> f64x4<V> {
    let number = |x: f64| f64x4::splat(simd, x);
    let size = (rays.origin.abs() + to.abs()).sum();
    let length = rays.direction.length();
    number(1.0) - number(END) * (number(1.0) + size / length)
}

/// As [`highlight`] in some lanes, 0 in the others.
#[inline(always)]
fn highlights<V: Simd>(r_dot_v: f64x4<V>, n: f64x4<V>, lanes: u64) -> f64x4<V> {
    let zero = f64x4::splat(n.simd, 0.0);
    let is_dark = r_dot_v.simd_le(zero) & n.simd_gt(zero);
    let lit = lanes & !is_dark.to_bitmask();
    if lit == 0 {
        return zero;
    }
    let (known, power) = powers(n.simd, r_dot_v, n);
    let known = mask64x4::from_bitmask(n.simd, lit) & known;
    let mut all = known.select(power, zero);
    let others = lit & !known.to_bitmask();
    if others != 0 {
        for lane in lanes_of(others) {
            all[lane] = highlight(r_dot_v[lane], n[lane]);
        }
    }
    all
}

/// The roots before 1 of a shape that has no form in lanes.
fn first_roots<V: Simd, S: Intersect>(shape: &S, rays: &Ray4<V>, lanes: u64) -> f64x4<V> {
    let mut roots = f64x4::splat(rays.origin.x.simd, f64::INFINITY);
    for lane in lanes_of(lanes) {
        let ray = rays.lane(lane);
        let watertight = SmallScene::shear_of(shape, &ray);
        if let Some((t, _)) = shape.intersect(&ray, &watertight, 1.0) {
            roots[lane] = t;
        }
    }
    roots
}
