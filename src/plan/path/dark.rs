//! The punctual lights that certainly illuminate nothing, and what is left of the lights.
//!
//! Only the proofs in this module make a [`DarkLight`], without which no light is dropped.

use super::builder::{PathPlanBuilder, RemainingLight};
use crate::margin::MARGIN;
use crate::surface_bounds::SurfaceBounds;
use rtc_math::{Bounds, IdTable, Vec3};
use rtc_valid::{Falloff, Punctual, PunctualId};
use std::ops::Deref;

/// What is left of each punctual light.
#[derive(Clone)]
pub(super) struct KeptLights(IdTable<Punctual, RemainingLight>);

impl KeptLights {
    /// All of so many lights.
    pub(super) fn all(count: usize) -> Self {
        Self(vec![RemainingLight::All; count].into())
    }

    /// Drops a light, or all but its index.
    pub(super) fn drop_light(&mut self, dark: DarkLight) {
        self.0[dark.light] = dark.rest;
    }
}

impl Deref for KeptLights {
    type Target = IdTable<Punctual, RemainingLight>;

    fn deref(&self) -> &IdTable<Punctual, RemainingLight> {
        &self.0
    }
}

/// The proof that a light illuminates nothing, and what must be left of it all the same.
pub(super) struct DarkLight {
    light: PunctualId,
    rest: RemainingLight,
}

impl DarkLight {
    /// The light.
    pub(super) fn light(&self) -> PunctualId {
        self.light
    }

    /// The lights of intensity 0.
    pub(super) fn by_intensity(builder: &PathPlanBuilder<'_>) -> Vec<Self> {
        Self::of(builder, RemainingLight::Nothing, has_zero_intensity)
    }

    /// The lights whose range or cone ends before all surfaces. Their indices are left.
    pub(super) fn by_reach(builder: &PathPlanBuilder<'_>) -> Vec<Self> {
        if builder.has_media() {
            return Vec::new();
        }
        Self::of(builder, RemainingLight::OnlyIndex, |light| {
            let mut surfaces = builder.surface_bounds.iter().zip(&*builder.surfaces);
            surfaces.all(|(bounds, is_in_world)| !is_in_world || is_out_of_range(light, bounds))
        })
    }

    fn of(
        builder: &PathPlanBuilder<'_>,
        rest: RemainingLight,
        is_dark: impl Fn(&Punctual) -> bool,
    ) -> Vec<Self> {
        let is_left = |light: &PunctualId| builder.lights[*light] == RemainingLight::All;
        let left = builder.lights.ids().filter(is_left);
        left.filter(|light| is_dark(&builder.punctual[*light]))
            .map(|light| Self { light, rest })
            .collect()
    }
}

/// Whether a light has intensity 0 in all directions.
fn has_zero_intensity(light: &Punctual) -> bool {
    match light {
        Punctual::Directional(sun) => sun.irradiance == Vec3::ZERO,
        Punctual::Point(light) => light.intensity == Vec3::ZERO || light.profile.is_dark(),
    }
}

/// Whether a surface is certainly outside the range or the cone of a light.
fn is_out_of_range(light: &Punctual, bounds: &SurfaceBounds) -> bool {
    let (Some(aabb), Punctual::Point(light)) = (bounds.aabb(), light) else {
        return false;
    };
    let margin = 8.0 * MARGIN * (aabb.reach() + light.position.abs().max_element());
    let is_beyond = match light.falloff {
        Falloff::Ranged(range) => aabb.distance(light.position) > range.get() + margin,
        Falloff::None | Falloff::Square => false,
    };
    let cone = light.profile.bounding_cone();
    is_beyond || cone.is_some_and(|cone| is_outside_cone(aabb, light.position, cone, margin))
}

/// A bound far above the rounding error of the cosine of an angle.
const SLACK: f64 = 1e-12;

/// Whether the bounding sphere of a box is outside a cone by a margin. The cone is given by its
/// apex, its axis and the cosine of its half angle.
fn is_outside_cone(aabb: &Bounds, apex: Vec3, (axis, cosine): (Vec3, f64), margin: f64) -> bool {
    // Widen the cone: where it is narrow, a small error of the cosine is a large error of the
    // angle.
    let cosine = cosine - SLACK;
    let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
    // Compute the distance of the centre from the cone's lateral surface, a lower bound of the
    // distance from the cone.
    let center = aabb.min * 0.5 + aabb.max * 0.5;
    let to = center - apex;
    let along = to.dot(axis);
    let across = (to.length_squared() - along * along).max(0.0).sqrt();
    let outside = across * cosine - along * sine;
    outside > (aabb.max - center).length() + margin
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface_bounds::{ShapeClass, SurfaceExtent};
    use rtc_math::{Positive, cos, sin};
    use rtc_profile::LightProfile;
    use rtc_valid::PointLight;

    #[test]
    fn a_box_is_beside_a_cone_where_the_ball_around_it_is() {
        // The sphere of radius 0.1·√3, four units from the apex, touches a cone of 30° at 32.48°.
        let cosine = cos(30_f64.to_radians());
        for (degrees, is_outside) in [(0.0, false), (32.0, false), (33.0, true), (120.0, true)] {
            let angle = f64::to_radians(degrees);
            let apex = Vec3::new(1.0, -2.0, 3.0);
            let center = apex + Vec3::new(sin(angle), 0.0, cos(angle)) * 4.0;
            let aabb = Bounds::about(center, Vec3::splat(0.1));
            let is_outside_cone = is_outside_cone(&aabb, apex, (Vec3::Z, cosine), 0.0);
            assert_eq!(is_outside_cone, is_outside, "{degrees}°");
        }
    }

    #[test]
    fn the_narrowest_cone_has_an_angle_that_its_cosine_can_not_tell() {
        for (angle, is_outside) in [(1e-7, false), (1e-5, true)] {
            let aabb = Bounds::about(Vec3::new(4.0 * angle, 0.0, 4.0), Vec3::splat(1e-12));
            let is_outside_cone = is_outside_cone(&aabb, Vec3::ZERO, (Vec3::Z, 1.0), 0.0);
            assert_eq!(is_outside_cone, is_outside, "{angle}");
        }
    }

    #[test]
    fn a_box_beside_a_cone_keeps_a_margin_from_it() {
        // A half-space, half a unit before a box with a bounding sphere of radius 1/8.
        let aabb = Bounds::about(Vec3::new(0.0, 0.0, -0.5), Vec3::X * 0.125);
        let is_outside_cone = |margin| is_outside_cone(&aabb, Vec3::ZERO, (Vec3::Z, SLACK), margin);
        assert!(!is_outside_cone(0.375) && is_outside_cone(0.3749));
    }

    #[test]
    fn a_range_ends_before_a_box_by_a_margin_that_grows_with_both_coordinates() {
        let bounds = SurfaceBounds {
            extent: SurfaceExtent::Within(Bounds {
                min: Vec3::new(0.0625, -0.125, -0.125),
                max: Vec3::splat(0.125),
            }),
            class: ShapeClass::Other,
        };
        let is_out = |margin: f64, outer: f64| {
            let cone = LightProfile::Cone {
                axis: Vec3::Z,
                inner: 1.0,
                outer,
            };
            [LightProfile::Uniform, cone].map(|profile| {
                let light = PointLight {
                    position: Vec3::X * -0.125,
                    intensity: Vec3::ONE,
                    profile,
                    falloff: Falloff::Ranged(Positive::new(0.1875 - margin).unwrap()),
                    projected: None,
                };
                is_out_of_range(&Punctual::Point(light), &bounds)
            })
        };
        let margin = 8.0 * MARGIN * (0.125 + 0.125);
        assert_eq!(is_out(margin, 0.0), [false, false]);
        assert_eq!(is_out(1.01 * margin, 0.0), [true, true]);
        // The spot's cone misses the box.
        assert_eq!(is_out(0.0, 0.99), [false, true]);
    }
}
