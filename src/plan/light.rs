//! The remaining terms of each light, and the possible occluders between each light and surface.

use super::dark::Dark;
use super::margin::{BoxMargins, MARGIN, OrientedPlane, VisibleSides};
use super::rules::Rule;
use super::surface_bounds::{ShapeClass, SurfaceBounds, SurfaceExtent};
use super::visibility::VisibleSurfaces;
use super::{LightPlan, MAX_PAIRS, SceneFacts};
use rtc_math::{Bounds, IdTable, Vec3};
use rtc_valid::{CourseLight, CourseLightId, Mode};

/// The results of the rules about lights and shadows.
pub(super) struct LightRuleResults {
    /// Per light.
    pub(super) plans: IdTable<CourseLight, LightPlan>,
    /// For each light, the rule that removed its direct terms.
    pub(super) rules: IdTable<CourseLight, Option<Rule>>,
    /// For each surface, whether it may cast a shadow.
    pub(super) occludes: Vec<bool>,
    /// One possible shadow, as an example.
    pub(super) shadow: Option<PossibleShadow>,
    /// Whether the scene has one shadow caster, which is also the only receiver.
    pub(super) single_surface: bool,
    /// Whether there are too many lights and surfaces to test all pairs.
    pub(super) capped: bool,
}

/// A possible shadow.
#[derive(Clone, Copy, Debug)]
pub(super) struct PossibleShadow {
    pub(super) light: CourseLightId,
    pub(super) occluder: usize,
    pub(super) receiver: usize,
}

impl LightRuleResults {
    pub(super) fn new(facts: &SceneFacts<'_>, visibility: &VisibleSurfaces) -> Self {
        let lights = &facts.sources;
        let count = facts.surface_bounds.len();
        let plan = |light| {
            let mut plan = LightPlan::full(count);
            let dark = Dark::of(light, facts, visibility);
            let rule = dark.map(|dark| plan.drop_light(dark));
            (plan, rule)
        };
        let (plans, rules): (Vec<_>, Vec<_>) = lights.iter().map(plan).unzip();
        let mut all = Self {
            plans: plans.into(),
            rules: rules.into(),
            occludes: vec![false; count],
            shadow: None,
            single_surface: true,
            capped: false,
        };
        if facts.scene.settings().shadows && matches!(facts.scene.settings().mode, Mode::Phong) {
            all.find_shadows(facts, visibility);
        }
        all
    }

    /// Finds the possible occluders for each light and each surface that it may illuminate.
    fn find_shadows(&mut self, facts: &SceneFacts<'_>, visibility: &VisibleSurfaces) {
        // List the receivers, the lights and the occluders.
        let count = facts.surface_bounds.len();
        let receives = |surface: &usize| {
            visibility.visible[*surface] && facts.summaries[*surface].is_illuminated()
        };
        let receivers = (0..count).filter(receives).collect::<Vec<_>>();
        let lights = (self.plans.ids())
            .filter(|light| self.plans[*light].direct)
            .collect::<Vec<_>>();
        let occluders = facts.occluders().collect::<Vec<_>>();
        let (Some(light), Some(receiver)) = (lights.first(), receivers.first()) else {
            return;
        };
        // Give up if there are too many combinations: every occluder may cast a shadow.
        let pairs = receivers.len().saturating_mul(lights.len());
        if let (true, Some(occluder)) = (
            pairs.saturating_mul(occluders.len()) > MAX_PAIRS,
            occluders.last(),
        ) {
            self.capped = true;
            occluders
                .iter()
                .for_each(|occluder| self.occludes[*occluder] = true);
            self.shadow = Some(PossibleShadow {
                light: *light,
                occluder: *occluder,
                receiver: *receiver,
            });
            return;
        }
        // Test all combinations.
        self.single_surface = occluders.len() == 1 && receivers == occluders;
        for light in lights {
            let source = &facts.sources[light];
            let adds_no_direct =
                |surface: usize| facts.adds_no_direct(surface, visibility.sides[surface], source);
            for receiver in &receivers {
                let is_behind =
                    facts.rules.contains(Rule::LightBehind) && adds_no_direct(*receiver);
                let pair = LightPair {
                    light,
                    source: extent(source),
                    receiver: *receiver,
                };
                self.plans[light].shadowed[*receiver] =
                    !is_behind && self.find_occluders(facts, visibility, &pair);
            }
        }
    }

    /// Whether anything may occlude a light from a surface. Records the occluders.
    fn find_occluders(
        &mut self,
        facts: &SceneFacts<'_>,
        visibility: &VisibleSurfaces,
        pair: &LightPair,
    ) -> bool {
        let LightPair {
            light,
            source,
            receiver,
        } = *pair;
        let mut is_shadowed = false;
        for occluder in facts.occluders() {
            // A surface may shadow itself, or one behind it as seen from the light.
            let may_cast = if occluder == receiver {
                !facts.cannot_self_shadow(receiver, visibility.sides[receiver], &source)
            } else {
                !facts.rules.contains(Rule::ShadowPair)
                    || facts.surface_bounds[receiver]
                        .may_be_occluded_by(&facts.surface_bounds[occluder], &source)
            };
            // Note the shadow and its first proof.
            if may_cast {
                self.occludes[occluder] = true;
                is_shadowed = true;
                self.shadow.get_or_insert(PossibleShadow {
                    light,
                    occluder,
                    receiver,
                });
            }
            // Clear the bit of a surface that cannot occlude.
            if let Some(bits) = self.plans[light].occluders.get_mut(receiver)
                && facts.is_clear(may_cast, occluder, receiver, &source)
            {
                *bits &= !(1 << occluder);
            }
        }
        is_shadowed
    }
}

/// A light and a surface that it may illuminate.
struct LightPair {
    light: CourseLightId,
    source: Bounds,
    receiver: usize,
}

/// The bounding box of a light.
fn extent(light: &CourseLight) -> Bounds {
    Bounds::about(light.position, Vec3::splat(light.radius.get()))
}

impl SceneFacts<'_> {
    /// The surfaces that cast shadows.
    pub(super) fn occluders(&self) -> impl Iterator<Item = usize> {
        let surfaces = self.scene.surfaces();
        (0..surfaces.len()).filter(|surface| surfaces[*surface].casts_shadow)
    }

    /// Whether a light adds no direct term to a surface: the coefficients are 0, or the light is
    /// behind the surface.
    ///
    /// The light and all viewpoints have a distance of [`MARGIN`] times the coordinates from the
    /// plane of the surface, so N·L < −2⁻³³, far beyond its rounding error.
    pub(super) fn adds_no_direct(
        &self,
        surface: usize,
        seen_from: VisibleSides,
        light: &CourseLight,
    ) -> bool {
        let (bounds, summary) = (&self.surface_bounds[surface], &self.summaries[surface]);
        let is_zero_behind = self.scene.settings().shadows || !summary.is_specular;
        let behind = || match bounds.class {
            ShapeClass::Planar(plane)
                if is_zero_behind
                    && !summary.has_shading_normals()
                    && seen_from != VisibleSides::BOTH =>
            {
                plane.sides(&extent(light)) == seen_from.opposite()
            }
            ShapeClass::Planar(_)
            | ShapeClass::Sphere(..)
            | ShapeClass::Convex
            | ShapeClass::Other => false,
        };
        !summary.is_illuminated() || behind()
    }

    /// Whether a surface certainly does not shadow itself where N·L > 0.
    fn cannot_self_shadow(&self, surface: usize, seen_from: VisibleSides, light: &Bounds) -> bool {
        let (bounds, summary) = (&self.surface_bounds[surface], &self.summaries[surface]);
        let is_convex_or_off_plane = match bounds.class {
            ShapeClass::Planar(plane) => plane.sides(light) != VisibleSides::BOTH,
            ShapeClass::Sphere(..) | ShapeClass::Convex => {
                seen_from == VisibleSides::FRONT
                    && !summary.has_shading_normals()
                    && bounds.is_disjoint_from(light)
            }
            ShapeClass::Other => false,
        };
        is_convex_or_off_plane && self.rules.contains(Rule::ShadowConvex)
    }

    /// Whether shadow rays from a surface need not be tested against an occluder, given whether it
    /// may cast a shadow there.
    ///
    /// Only a sphere and an axis-aligned plane skip the test against themselves: at grazing angles,
    /// rounding of a triangle's plane may let the triangle occlude itself.
    fn is_clear(&self, may_cast: bool, occluder: usize, receiver: usize, light: &Bounds) -> bool {
        let (bounds, other) = (
            &self.surface_bounds[receiver],
            &self.surface_bounds[occluder],
        );
        match (&bounds.extent, &other.extent) {
            (SurfaceExtent::Plane(plane), SurfaceExtent::Plane(_)) if occluder == receiver => {
                self.rules.contains(Rule::ShadowConvex)
                    && are_axis_parallel(plane, plane)
                    && plane.sides(light) != VisibleSides::BOTH
            }
            (SurfaceExtent::Plane(plane), SurfaceExtent::Plane(other)) => {
                self.rules.contains(Rule::ShadowPair)
                    && are_axis_parallel(plane, other)
                    && are_on_one_side(other, &Bounds::about(plane.point, Vec3::ZERO), light)
            }
            _ if occluder == receiver => {
                !may_cast && matches!(bounds.class, ShapeClass::Sphere(..))
            }
            _ => !may_cast,
        }
    }
}

impl SurfaceBounds {
    /// Whether `occluder` may hide a light from this surface.
    fn may_be_occluded_by(&self, occluder: &Self, light: &Bounds) -> bool {
        let Some(aabb) = self.aabb() else {
            return true;
        };
        match &occluder.extent {
            SurfaceExtent::Within(other) => {
                aabb.segment_may_hit(light, other)
                    && SphereBound::of(self)
                        .segment_may_hit(&SphereBound::around(light), &SphereBound::of(occluder))
            }
            SurfaceExtent::Plane(plane) => !are_on_one_side(plane, aabb, light),
            SurfaceExtent::Anywhere => true,
        }
    }
}

/// A bounding sphere (centre, radius), or `None` if there is none.
#[derive(Clone, Copy)]
struct SphereBound(Option<(Vec3, f64)>);

impl SphereBound {
    fn of(bounds: &SurfaceBounds) -> Self {
        match bounds.class {
            ShapeClass::Sphere(center, radius) => Self(Some((center, radius))),
            ShapeClass::Planar(_) | ShapeClass::Convex | ShapeClass::Other => Self(None),
        }
    }

    /// The inscribed sphere of a cube.
    fn around(cube: &Bounds) -> Self {
        Self(Some((
            cube.min * 0.5 + cube.max * 0.5,
            0.5 * (cube.max.x - cube.min.x),
        )))
    }

    /// Whether a segment from this sphere to `end` may hit `other`.
    ///
    /// At the parameter τ all segments are in the sphere of radius `r + τ·(ρ − r)` around `c + τ·(l
    /// − c)`. It intersects the other sphere where `Q(τ) = |c + τ·(l − c) − o|² − (R + r + τ·(ρ −
    /// r))² ≤ 0`.
    fn segment_may_hit(self, end: &Self, other: &Self) -> bool {
        let (Some((c, r)), Some((l, rho)), Some((o, big))) = (self.0, end.0, other.0) else {
            return true;
        };
        let size = (c.abs() + l.abs() + o.abs()).element_sum() + r + rho + big;
        let (f, d) = (c - o, l - c);
        let (sum, growth) = (big + r + 8.0 * MARGIN * size, rho - r);
        let square = d.dot(d) - growth * growth;
        let linear = f.dot(d) - sum * growth;
        let start = f.dot(f) - sum * sum;
        let value = |tau: f64| (square * tau + 2.0 * linear) * tau + start;
        let slack = MARGIN * size * size;
        // Where Q is not convex, its minimum is at an end of the interval.
        let min = (-linear / square).clamp(0.0, 1.0);
        [0.0, min, 1.0].into_iter().any(|tau| value(tau) <= slack)
    }
}

/// Whether the normals of two planes are exactly parallel to the same axis, so that the unbounded
/// planes are exactly parallel.
fn are_axis_parallel(first: &OrientedPlane, second: &OrientedPlane) -> bool {
    let is_axis = |normal: Vec3| Vec3::AXES.contains(&normal.abs());
    is_axis(first.normal) && first.normal.abs() == second.normal.abs()
}

/// Whether two boxes are on the same side of a plane.
fn are_on_one_side(plane: &OrientedPlane, first: &Bounds, second: &Bounds) -> bool {
    let side = plane.sides(first);
    side != VisibleSides::BOTH && side == plane.sides(second)
}

#[cfg(test)]
mod tests {
    use super::super::margin::tests::{has_margin, span};
    use super::*;

    fn ball(x: f64, y: f64, radius: f64) -> SphereBound {
        SphereBound(Some((Vec3::new(x, y, 0.0), radius)))
    }

    #[test]
    fn the_inscribed_sphere_of_a_cube_touches_its_sides() {
        let Some((center, radius)) =
            SphereBound::around(&span([1.0, -2.0, 4.0], [3.0, 0.0, 6.0])).0
        else {
            panic!("a sphere")
        };
        assert_eq!((center, radius), (Vec3::new(2.0, -1.0, 5.0), 1.0));
    }

    #[test]
    fn a_sphere_beside_the_segments_between_equal_spheres_is_missed_by_a_margin() {
        let (start, end) = (ball(0.0, 0.0, 1.0), ball(10.0, 0.0, 1.0));
        let is_clear = |gap: f64| !start.segment_may_hit(&end, &ball(5.0, 3.0 + gap, 2.0));
        // The sum of coordinates and radii is 22: eight times that, and its square over twice the
        // distance of 3.
        has_margin((8.0 * 22.0 + 22.0 * 22.0 / 6.0) * MARGIN, is_clear);
    }

    #[test]
    fn segments_between_unequal_spheres_form_a_cone() {
        let (small, large) = (ball(0.0, 0.0, 0.5), ball(10.0, 0.0, 2.0));
        // The sine of the cone is 0.15, its cosine √0.9775; its radius half-way is 1.25.
        let touching = (1.0 + 1.25) / 0.9775_f64.sqrt();
        for (start, end) in [(small, large), (large, small)] {
            let is_clear = |height: f64| !start.segment_may_hit(&end, &ball(5.0, height, 1.0));
            assert!(!is_clear(touching) && is_clear(touching + 400.0 * MARGIN));
            let is_clear = |x: f64| !start.segment_may_hit(&end, &ball(x, 0.0, 1.0));
            assert!(!is_clear(13.0) && is_clear(13.0 + 1e-6), "past the end");
            assert!(!is_clear(-1.5) && is_clear(-1.5 - 1e-6), "before the start");
        }
    }

    #[test]
    fn segments_to_a_sphere_around_the_start_fill_that_sphere() {
        let is_clear =
            |x: f64| !ball(0.0, 0.0, 1.0).segment_may_hit(&ball(1.0, 0.0, 5.0), &ball(x, 0.0, 1.0));
        assert!(!is_clear(7.0) && is_clear(7.0 + 1e-6));
        assert!(!is_clear(-5.0) && is_clear(-5.0 - 1e-6));
    }
}
