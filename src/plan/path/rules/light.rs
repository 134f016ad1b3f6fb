//! Rules on lights, light sampling and shadows.

use super::PathRule;
use crate::margin::{MARGIN, OrientedPlane, VisibleSides};
use crate::path::builder::{
    PathPlanBuilder, RemainingEnvironment, RemainingLight, is_transmissive,
};
use crate::path::facts::is_delta;
use crate::surface_bounds::{ShapeClass, SurfaceBounds};
use rtc_image::Texels;
use rtc_ir::{EntityField, EntityKind, ValuePath};
use rtc_math::{Bounds, Vec3};
use rtc_valid::{Alpha, Falloff, ImageId, Punctual, PunctualId};

fn light_path(light: PunctualId) -> ValuePath {
    ValuePath::new(EntityKind::Light, light.index(), EntityField::Whole)
}

pub(crate) const ZERO_INTENSITY: PathRule = PathRule {
    name: "P-LIGHT-ZERO",
    text: "A light of intensity 0 has the sampling probability 0: it is removed from the light \
           distribution.",
    reason: "all lights have intensity 0",
    apply: |builder| {
        let lights = builder.punctual;
        let is_black = |light: &PunctualId| has_zero_intensity(&lights[*light]);
        reduce_lights(builder, RemainingLight::Nothing, is_black)
    },
};

pub(crate) const BLACK_ENVIRONMENT: PathRule = PathRule {
    name: "P-ENV-ZERO",
    text: "An environment with radiance 0 in all directions contributes 0 to a path that leaves \
           the scene.",
    reason: "the environment is black",
    apply: |builder| {
        reduce_environment(builder, RemainingEnvironment::Nothing, |builder, image| {
            is_black(&builder.scene.images()[image].texels)
        })
    },
};

pub(crate) const CONSTANT_ENVIRONMENT: PathRule = PathRule {
    name: "P-ENV-CONST",
    text: "If all texels of the environment image are equal, it has this value in all directions: \
           filtering equal texels gives the same value. The value is read once, when the scene is \
           prepared. Directions are still sampled from its table, so that the use of random \
           numbers does not change.",
    reason: "all texels of the environment's image are equal",
    apply: |builder| {
        reduce_environment(builder, RemainingEnvironment::Constant, |builder, image| {
            builder.textures.is_constant_image(image)
        })
    },
};

/// Reduces an environment whose image has a property; returns its path if that changed it.
fn reduce_environment(
    builder: &mut PathPlanBuilder<'_>,
    rest: RemainingEnvironment,
    has: impl Fn(&PathPlanBuilder<'_>, ImageId) -> bool,
) -> Vec<ValuePath> {
    let image = builder.scene.environment().image;
    let is_all = builder.environment == RemainingEnvironment::All;
    if !(is_all && image.is_some_and(|image| has(builder, image))) {
        return Vec::new();
    }
    builder.environment = rest;
    vec![ValuePath::new(
        EntityKind::Environment,
        0,
        EntityField::Whole,
    )]
}

pub(crate) const OUT_OF_RANGE: PathRule = PathRule {
    name: "P-LIGHT-REACH",
    text: "A light whose range or cone ends before the bounding boxes of all surfaces does not \
           illuminate them, nor any medium, if there is none. It keeps its index in the light distribution, so that the use of \
           random numbers does not change, but it is not evaluated and has no shadow ray.",
    reason: "no surface is within the range or the cone of a light",
    apply: |builder| {
        if builder.has_media() {
            return Vec::new();
        }
        let lights = builder.punctual;
        let (surface_bounds, left) = (builder.surface_bounds, builder.surfaces.clone());
        let is_out = |light: &PunctualId| {
            let mut surface_bounds = surface_bounds
                .iter()
                .zip(&left)
                .filter(|(_, is_in_world)| **is_in_world);
            surface_bounds.all(|(bounds, _)| is_out_of_range(&lights[*light], bounds))
        };
        reduce_lights(builder, RemainingLight::OnlyIndex, is_out)
    },
};

pub(crate) const DELTA_ONLY: PathRule = PathRule {
    name: "P-DELTA",
    text: "If all lobes of all materials are delta lobes, the BSDF has the value 0 in a direction \
           sampled from a light: no light is sampled, and no MIS weights are needed. The rule does \
           not apply in media.",
    reason: "all materials are mirrors or clear glass",
    apply: |builder| {
        let multiple = builder.path.multiple_scattering;
        let nee = |material: &rtc_valid::Standard| !material.unlit && !is_delta(material, multiple);
        if !builder.nee
            || builder.has_media()
            || builder.used_materials().any(|(_, material)| nee(material))
        {
            return Vec::new();
        }
        builder.nee = false;
        builder
            .used_materials()
            .map(|(material, _)| {
                ValuePath::new(EntityKind::Material, material.index(), EntityField::Whole)
            })
            .collect()
    },
};

pub(crate) const SINGLE_CONVEX: PathRule = PathRule {
    name: "P-SHADOW-ALONE",
    text: "If the only surface is a convex opaque solid seen from outside, it lies behind its \
           tangent plane at any point and does not occlude a light in front of that plane. If the \
           only surface is flat, it does not occlude a light off its plane. An environment with \
           an image has directions within the plane, so a flat surface may occlude it. The rule does not apply in media.",
    reason: "the only surface is convex and does not shadow itself",
    apply: |builder| {
        let mut left = (0..builder.surfaces.len()).filter(|surface| builder.surfaces[*surface]);
        let (Some(surface), None) = (left.next(), left.next()) else {
            return Vec::new();
        };
        if !builder.shadows || builder.has_media() || !casts_no_self_shadow(builder, surface) {
            return Vec::new();
        }
        builder.shadows = false;
        let index = builder.scene.surfaces()[surface].index;
        vec![ValuePath::new(
            EntityKind::Surface,
            index,
            EntityField::Whole,
        )]
    },
};

/// Reduces lights; returns the paths of the changed ones.
fn reduce_lights(
    builder: &mut PathPlanBuilder<'_>,
    rest: RemainingLight,
    which: impl Fn(&PunctualId) -> bool,
) -> Vec<ValuePath> {
    let left = |light: &PunctualId| builder.lights[*light] == RemainingLight::All;
    let out: Vec<_> = (builder.lights.ids()).filter(left).filter(which).collect();
    out.iter().for_each(|light| builder.lights[*light] = rest);
    out.into_iter().map(light_path).collect()
}

/// Whether the only surface of a scene certainly does not shadow itself.
fn casts_no_self_shadow(builder: &PathPlanBuilder<'_>, surface: usize) -> bool {
    let (bounds, material) = (
        &builder.surface_bounds[surface],
        &builder.materials[builder.scene.surfaces()[surface].material],
    );
    let eye = Bounds::about(
        builder.scene.camera().eye,
        Vec3::splat(builder.scene.camera().lens.radius.get()),
    );
    let is_opaque = !is_transmissive(material) && material.alpha == Alpha::Opaque;
    let has_no_emission = material.emissive == Vec3::ZERO;
    let is_perspective = builder.scene.camera().projection == rtc_valid::Projection::Perspective;
    let is_unshadowed = match bounds.class {
        ShapeClass::Planar(plane) => {
            let mut lights = builder.punctual.iter();
            !builder.has_extended_light() && lights.all(|light| is_off_plane(light, &plane))
        }
        ShapeClass::Sphere(..) | ShapeClass::Convex => {
            let mut positions = builder.punctual.iter().filter_map(position);
            bounds.is_disjoint_from(&eye) && positions.all(|at| bounds.is_disjoint_from(&point(at)))
        }
        // A closed convex mesh may shadow itself: a ray that starts near an edge starts a few
        // rounding errors off its face, and the edge functions of the next face have errors of the
        // same size, larger at grazing angles.
        ShapeClass::Other => false,
    };
    is_opaque && has_no_emission && is_perspective && is_unshadowed
}

/// Whether a light is certainly off a plane. A ray within the plane may be rounded to either side.
fn is_off_plane(light: &Punctual, plane: &OrientedPlane) -> bool {
    match light {
        Punctual::Directional(sun) => sun.direction.dot(plane.normal).abs() > 4.0 * MARGIN,
        Punctual::Point(light) => plane.sides(&point(light.position)) != VisibleSides::BOTH,
    }
}

/// Whether all texels are black.
fn is_black(texels: &Texels) -> bool {
    match texels {
        Texels::Rgb8(bytes) | Texels::Rgb32f(bytes) => bytes.iter().all(|byte| *byte == 0),
        // The alpha of an environment image has no meaning.
        Texels::Rgba8(bytes) => bytes.chunks(4).all(|texel| texel[..3] == [0; 3]),
    }
}

/// Whether a light has intensity 0 in all directions.
fn has_zero_intensity(light: &Punctual) -> bool {
    match light {
        Punctual::Directional(sun) => sun.irradiance == Vec3::ZERO,
        Punctual::Point(light) => light.intensity == Vec3::ZERO || light.profile.is_dark(),
    }
}

/// The position of a light, unless it is infinitely far away.
fn position(light: &Punctual) -> Option<Vec3> {
    match light {
        Punctual::Directional(_) => None,
        Punctual::Point(light) => Some(light.position),
    }
}

fn point(at: Vec3) -> Bounds {
    Bounds::about(at, Vec3::ZERO)
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
    use crate::surface_bounds::SurfaceExtent;
    use rtc_math::{Positive, cos, sin};
    use rtc_profile::LightProfile;
    use rtc_valid::{DirectionalLight, PointLight};

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

    #[test]
    fn a_sun_is_off_a_plane_beyond_the_error_of_its_direction() {
        let plane = OrientedPlane {
            point: Vec3::ZERO,
            normal: Vec3::Z,
        };
        let is_off_plane = |height: f64| {
            let direction = Vec3::new(1.0, 0.0, height);
            let irradiance = Vec3::ONE;
            let sun = DirectionalLight {
                direction,
                irradiance,
            };
            is_off_plane(&Punctual::Directional(sun), &plane)
        };
        assert!(!is_off_plane(4.0 * MARGIN) && is_off_plane(4.1 * MARGIN) && is_off_plane(-1.0));
    }
}
