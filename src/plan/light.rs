//! The terms of each light, and the possible occluders between it and each surface.

use super::body::{Body, Extent, Hull};
use super::rules::Rule;
use super::space::{Flat, MARGIN, Margins, Sides};
use super::visibility::Visibility;
use super::{Facts, LightPlan, MAX_PAIRS};
use rtc_math::{Bounds, Vec3};
use rtc_valid::{Ambient, CourseLight, Mode};

/// What is left of the lights.
pub(super) struct LightFindings {
    /// Per light.
    pub(super) plans: Vec<LightPlan>,
    /// Per light, the rule that left out its direct terms.
    pub(super) rules: Vec<Option<Rule>>,
    /// Per surface, whether it may cast a shadow.
    pub(super) casts: Vec<bool>,
    /// A light, and a surface that may hide it from another.
    pub(super) shadow: Option<Shadow>,
    /// Whether all omitted shadow rays start on surfaces that are alone.
    pub(super) alone: bool,
    /// Whether there were too many lights and surfaces to test all pairs.
    pub(super) capped: bool,
}

/// A possible shadow.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shadow {
    pub(super) light: usize,
    pub(super) caster: usize,
    pub(super) receiver: usize,
}

impl LightFindings {
    pub(super) fn new(facts: &Facts<'_>, visibility: &Visibility) -> Self {
        let lights = &facts.sources;
        let (plans, rules) = lights
            .iter()
            .map(|light| facts.light(light, visibility))
            .unzip();
        let casts = vec![false; facts.bodies.len()];
        let mut all = Self {
            plans,
            rules,
            casts,
            shadow: None,
            alone: true,
            capped: false,
        };
        if facts.scene.settings().shadows && matches!(facts.scene.settings().mode, Mode::Phong) {
            all.find_shadows(facts, visibility);
        }
        all
    }

    /// Finds possible occluders for each light and each surface it may light.
    fn find_shadows(&mut self, facts: &Facts<'_>, visibility: &Visibility) {
        let count = facts.bodies.len();
        let receives =
            |surface: &usize| visibility.reached[*surface] && facts.summaries[*surface].is_lit();
        let receivers = (0..count).filter(receives).collect::<Vec<_>>();
        let lights = (0..self.plans.len())
            .filter(|light| self.plans[*light].direct)
            .collect::<Vec<_>>();
        let casters = facts.casters().collect::<Vec<_>>();
        let (Some(light), Some(receiver)) = (lights.first(), receivers.first()) else {
            return;
        };
        let pairs = receivers.len().saturating_mul(lights.len());
        if let (true, Some(caster)) = (
            pairs.saturating_mul(casters.len()) > MAX_PAIRS,
            casters.last(),
        ) {
            self.capped = true;
            casters.iter().for_each(|caster| self.casts[*caster] = true);
            self.shadow = Some(Shadow {
                light: *light,
                caster: *caster,
                receiver: *receiver,
            });
            return;
        }
        self.alone = casters.len() == 1 && receivers == casters;
        for light in lights {
            let source = &facts.sources[light];
            let is_dark =
                |surface: usize| facts.is_dark(surface, visibility.sides[surface], source);
            for receiver in &receivers {
                let is_behind = facts.rules.contains(Rule::LightBehind) && is_dark(*receiver);
                let pair = Pair {
                    light,
                    source: extent(source),
                    receiver: *receiver,
                };
                self.plans[light].shadowed[*receiver] =
                    !is_behind && self.find_casters(facts, visibility, &pair);
            }
        }
    }

    /// Whether anything may hide a light from a surface. Records the occluder.
    fn find_casters(&mut self, facts: &Facts<'_>, visibility: &Visibility, pair: &Pair) -> bool {
        let Pair {
            light,
            source,
            receiver,
        } = *pair;
        let mut falls = false;
        for caster in facts.casters() {
            let may_cast = if caster == receiver {
                !facts.spares_itself(receiver, visibility.sides[receiver], &source)
            } else {
                !facts.rules.contains(Rule::ShadowPair)
                    || facts.bodies[receiver].may_be_hidden_by(&facts.bodies[caster], &source)
            };
            if may_cast {
                self.casts[caster] = true;
                falls = true;
                self.shadow.get_or_insert(Shadow {
                    light,
                    caster,
                    receiver,
                });
            }
            if let Some(bits) = self.plans[light].casters.get_mut(receiver)
                && facts.is_clear(may_cast, caster, receiver, &source)
            {
                *bits &= !(1 << caster);
            }
        }
        falls
    }
}

/// A light and a surface that it may light.
struct Pair {
    light: usize,
    source: Bounds,
    receiver: usize,
}

/// The box of all points of a light.
fn extent(light: &CourseLight) -> Bounds {
    Bounds::about(light.position, Vec3::splat(light.radius.get()))
}

impl Facts<'_> {
    /// The surfaces that shadow rays may meet.
    pub(super) fn casters(&self) -> impl Iterator<Item = usize> {
        let surfaces = self.scene.surfaces();
        (0..surfaces.len()).filter(|surface| surfaces[*surface].casts_shadow)
    }

    /// The remaining terms of a light, and the rule that removed the others.
    fn light(&self, light: &CourseLight, visibility: &Visibility) -> (LightPlan, Option<Rule>) {
        let surfaces = || (0..self.bodies.len()).filter(|surface| visibility.reached[*surface]);
        let shadowed = vec![true; self.bodies.len()];
        let rule = match self.scene.settings().mode {
            Mode::Gooch(_) | Mode::Path(_) => None,
            Mode::Normal | Mode::Zbuffer => self.allowed(Rule::Mode),
            Mode::Phong if light.color == Vec3::ZERO && self.rules.contains(Rule::LightBlack) => {
                Some(Rule::LightBlack)
            }
            Mode::Phong if surfaces().all(|surface| !self.summaries[surface].is_lit()) => {
                self.allowed(Rule::LightUnreached)
            }
            Mode::Phong
                if surfaces()
                    .all(|surface| self.is_dark(surface, visibility.sides[surface], light)) =>
            {
                self.allowed(Rule::LightBehind)
            }
            Mode::Phong => None,
        };
        let ambient = self.scene.settings().ambient == Ambient::PerLight
            && surfaces().any(|surface| self.summaries[surface].ambient);
        let kept = match rule {
            None => true,
            Some(Rule::LightBlack | Rule::Mode) => false,
            Some(_) => ambient || !self.rules.contains(Rule::LightUnreached),
        };
        (
            LightPlan {
                kept,
                direct: rule.is_none(),
                shadowed,
                casters: match self.bodies.len() {
                    count @ 0..=64 => vec![u64::MAX; count],
                    _ => Vec::new(),
                },
            },
            rule,
        )
    }

    /// Whether a light adds no direct term to a surface: its terms are 0, or the light is behind it.
    ///
    /// The light and all viewpoints are off the plane of the surface by [`super::space::MARGIN`] of
    /// all coordinates, so N·L < −2⁻³³, far beyond its rounding.
    pub(super) fn is_dark(&self, surface: usize, seen_from: Sides, light: &CourseLight) -> bool {
        let (body, summary) = (&self.bodies[surface], &self.summaries[surface]);
        let gated = self.scene.settings().shadows || !summary.shines;
        let behind = || match body.form {
            Hull::Flat(flat) if gated && !summary.is_bent() && seen_from != Sides::BOTH => {
                flat.sides(&extent(light)) == seen_from.opposite()
            }
            Hull::Flat(_) | Hull::Ball(..) | Hull::Convex | Hull::Other => false,
        };
        !summary.is_lit() || behind()
    }

    /// Whether a surface certainly does not hide a light with N·L > 0 from itself.
    fn spares_itself(&self, surface: usize, seen_from: Sides, light: &Bounds) -> bool {
        let (body, summary) = (&self.bodies[surface], &self.summaries[surface]);
        let spares = match body.form {
            Hull::Flat(flat) => flat.sides(light) != Sides::BOTH,
            Hull::Ball(..) | Hull::Convex => {
                seen_from == Sides::FRONT && !summary.is_bent() && body.is_clear_of(light)
            }
            Hull::Other => false,
        };
        spares && self.rules.contains(Rule::ShadowConvex)
    }

    /// Whether shadow rays from a surface need not ask a caster, given whether it may cast a shadow
    /// there.
    ///
    /// Of itself only a ball and a plane along an axis are not asked: the rounding of a triangle's
    /// own plane may hide a light from it where the light grazes it.
    fn is_clear(&self, may_cast: bool, caster: usize, receiver: usize, light: &Bounds) -> bool {
        let (body, other) = (&self.bodies[receiver], &self.bodies[caster]);
        match (&body.extent, &other.extent) {
            (Extent::Plane(flat), Extent::Plane(_)) if caster == receiver => {
                self.rules.contains(Rule::ShadowConvex)
                    && share_an_axis(flat, flat)
                    && flat.sides(light) != Sides::BOTH
            }
            (Extent::Plane(flat), Extent::Plane(other)) => {
                self.rules.contains(Rule::ShadowPair)
                    && share_an_axis(flat, other)
                    && is_beside(other, &Bounds::about(flat.point, Vec3::ZERO), light)
            }
            _ if caster == receiver => !may_cast && matches!(body.form, Hull::Ball(..)),
            _ => !may_cast,
        }
    }
}

impl Body {
    /// Whether `caster` may hide a light from this surface.
    fn may_be_hidden_by(&self, caster: &Self, light: &Bounds) -> bool {
        let Some(space) = self.space() else {
            return true;
        };
        match &caster.extent {
            Extent::Within(other) => {
                space.may_see_through(light, other)
                    && BoundingBall::of(self)
                        .may_see_through(&BoundingBall::around(light), &BoundingBall::of(caster))
            }
            Extent::Plane(flat) => !is_beside(flat, space, light),
            Extent::Anywhere => true,
        }
    }
}

/// A bounding ball; `None` if there is none.
#[derive(Clone, Copy)]
struct BoundingBall(Option<(Vec3, f64)>);

impl BoundingBall {
    fn of(body: &Body) -> Self {
        match body.form {
            Hull::Ball(center, radius) => Self(Some((center, radius))),
            Hull::Flat(_) | Hull::Convex | Hull::Other => Self(None),
        }
    }

    /// The ball in a cube.
    fn around(cube: &Bounds) -> Self {
        Self(Some((
            cube.min * 0.5 + cube.max * 0.5,
            0.5 * (cube.max.x - cube.min.x),
        )))
    }

    /// Whether a segment from this ball to `end` may meet `other`.
    ///
    /// At the fraction τ of the way all segments are in a ball of radius `r + τ·(ρ − r)` around
    /// `c + τ·(l − c)`. It meets the other where
    /// `Q(τ) = |c + τ·(l − c) − o|² − (R + r + τ·(ρ − r))² ≤ 0`.
    fn may_see_through(self, end: &Self, other: &Self) -> bool {
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
        // Where Q is not convex, its minimum is at an end.
        let min = (-linear / square).clamp(0.0, 1.0);
        [0.0, min, 1.0].into_iter().any(|tau| value(tau) <= slack)
    }
}

/// Whether the normals of two planes lie along one axis, exactly: the planes are parallel however
/// far they reach.
fn share_an_axis(first: &Flat, second: &Flat) -> bool {
    let is_axis = |normal: Vec3| Vec3::AXES.contains(&normal.abs());
    is_axis(first.normal) && first.normal.abs() == second.normal.abs()
}

/// Whether two boxes lie on the same side of a plane.
fn is_beside(flat: &Flat, first: &Bounds, second: &Bounds) -> bool {
    let side = flat.sides(first);
    side != Sides::BOTH && side == flat.sides(second)
}

#[cfg(test)]
mod tests {
    use super::super::space::tests::{has_margin, span};
    use super::*;

    fn ball(x: f64, y: f64, radius: f64) -> BoundingBall {
        BoundingBall(Some((Vec3::new(x, y, 0.0), radius)))
    }

    #[test]
    fn the_ball_in_a_cube_touches_its_sides() {
        let Some((center, radius)) =
            BoundingBall::around(&span([1.0, -2.0, 4.0], [3.0, 0.0, 6.0])).0
        else {
            panic!("a ball")
        };
        assert_eq!((center, radius), (Vec3::new(2.0, -1.0, 5.0), 1.0));
    }

    #[test]
    fn what_touches_the_way_between_equal_balls_is_off_it_by_room() {
        let (start, end) = (ball(0.0, 0.0, 1.0), ball(10.0, 0.0, 1.0));
        let is_clear = |gap: f64| !start.may_see_through(&end, &ball(5.0, 3.0 + gap, 2.0));
        // All coordinates and radii sum up to 22: eightfold, and its square over twice the distance
        // of 3.
        has_margin((8.0 * 22.0 + 22.0 * 22.0 / 6.0) * MARGIN, is_clear);
    }

    #[test]
    fn the_way_between_unequal_balls_is_a_cone() {
        let (small, large) = (ball(0.0, 0.0, 0.5), ball(10.0, 0.0, 2.0));
        // The cone's sine is 0.15, its cosine √0.9775; half-way it is 1.25 wide.
        let touching = (1.0 + 1.25) / 0.9775_f64.sqrt();
        for (start, end) in [(small, large), (large, small)] {
            let is_clear = |height: f64| !start.may_see_through(&end, &ball(5.0, height, 1.0));
            assert!(!is_clear(touching) && is_clear(touching + 400.0 * MARGIN));
            let is_clear = |x: f64| !start.may_see_through(&end, &ball(x, 0.0, 1.0));
            assert!(!is_clear(13.0) && is_clear(13.0 + 1e-6), "past the end");
            assert!(!is_clear(-1.5) && is_clear(-1.5 - 1e-6), "before the start");
        }
    }

    #[test]
    fn the_way_to_a_ball_around_the_start_is_that_ball() {
        let is_clear =
            |x: f64| !ball(0.0, 0.0, 1.0).may_see_through(&ball(1.0, 0.0, 5.0), &ball(x, 0.0, 1.0));
        assert!(!is_clear(7.0) && is_clear(7.0 + 1e-6));
        assert!(!is_clear(-5.0) && is_clear(-5.0 - 1e-6));
    }
}
