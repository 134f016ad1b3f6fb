//! Lights as each integrator uses them: the Whitted integrator uses the course's point lights, the
//! path integrator uses physical lights.

use rtc_math::IdTable;
use rtc_profile::LightProfile;
use rtc_valid::{CourseLight, Falloff, Light, PointLight, Punctual};
use std::f64::consts::PI;

/// The lights of the Whitted integrator: the course's point lights, in scene order.
#[must_use]
pub fn course(lights: &[Light]) -> IdTable<CourseLight> {
    let course = |light: &Light| match light {
        Light::Course(light) => Some(*light),
        Light::Punctual(_) => None,
    };
    lights.iter().filter_map(course).collect()
}

/// The lights of the path integrator: all lights. A course light gets the intensity with which a
/// facing white Lambertian surface has the light's colour as radiance.
#[must_use]
pub fn punctual(lights: &[Light]) -> IdTable<Punctual> {
    let physical = |light: &Light| match light {
        Light::Punctual(light) => light.clone(),
        Light::Course(light) => Punctual::Point(PointLight {
            position: light.position,
            intensity: light.color * PI,
            profile: LightProfile::Uniform,
            falloff: Falloff::None,
            projected: None,
        }),
    };
    lights.iter().map(physical).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rtc_math::{NonNegative, Vec3};
    use rtc_valid::{CourseLight, DirectionalLight};

    #[test]
    fn each_integrator_sees_its_lights_in_the_order_of_the_scene() {
        let course_light = |x: f64| {
            Light::Course(CourseLight {
                position: Vec3::X * x,
                color: Vec3::ONE,
                radius: NonNegative::ZERO,
            })
        };
        let sun = Light::Punctual(Punctual::Directional(DirectionalLight {
            direction: Vec3::Z,
            irradiance: Vec3::ONE,
        }));
        let lights = [course_light(1.0), sun, course_light(2.0)];
        let places = course(&lights)
            .iter()
            .map(|light| light.position.x)
            .collect::<Vec<_>>();
        assert_eq!(places, [1.0, 2.0]);
        let [
            Punctual::Point(first),
            Punctual::Directional(_),
            Punctual::Point(second),
        ] = &*punctual(&lights)
        else {
            panic!("three lights of their kinds")
        };
        assert_eq!((first.position.x, second.position.x), (1.0, 2.0));
        assert_eq!(
            (first.intensity, first.falloff),
            (Vec3::splat(PI), Falloff::None)
        );
    }
}
