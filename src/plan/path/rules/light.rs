//! Rules on lights, light sampling and shadows.

use super::PathRule;
use crate::facts::material::is_transmissive;
use crate::margin::{MARGIN, OrientedPlane, VisibleSides};
use crate::path::builder::{PathPlanBuilder, RemainingEnvironment};
use crate::path::dark::DarkLight;
use crate::path::facts::is_delta;
use crate::surface_bounds::ShapeClass;
use rtc_image::Texels;
use rtc_ir::{EntityField, EntityKind, ValuePath};
use rtc_math::{Bounds, Vec3};
use rtc_valid::{Alpha, ImageId, Punctual};

pub(crate) const ZERO_INTENSITY: PathRule = PathRule {
    name: "P-LIGHT-ZERO",
    text: "A light of intensity 0 has the sampling probability 0: it is removed from the light \
           distribution.",
    reason: "all lights have intensity 0",
    apply: |builder| {
        let dark = DarkLight::by_intensity(builder);
        builder.drop_lights(dark)
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
        let dark = DarkLight::by_reach(builder);
        builder.drop_lights(dark)
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

#[cfg(test)]
mod tests {
    use super::*;
    use rtc_valid::DirectionalLight;

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
