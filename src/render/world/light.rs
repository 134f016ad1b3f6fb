//! The lights of a world, in the form that its integrator needs.

use super::texture::Textures;
use super::{Surface, World};
use crate::integrator::anaglyph;
use crate::light::course::CourseLight;
use crate::light::environment::Environment;
use crate::light::punctual::{DirectionalLight, Falloff, PointLight, ProjectedTexture, Punctual};
use crate::shape::geometry::Intersect;
use crate::texture::sampled::ColorSpace;
use rtc_math::{Bounds, IdTable};
use rtc_plan::{PathPlan, Plan, RemainingEnvironment, facts};
use rtc_valid::{self as valid, ValidScene};

/// The lights of a world. There are two kinds of lists; the one that the integrator does not use is
/// empty.
#[derive(Clone)]
pub(crate) struct LightList {
    /// The lights of Whitted's integrator, in the order in which their terms are summed.
    pub(crate) course: IdTable<valid::CourseLight, CourseLight>,
    /// The lights without extent of paths.
    pub(crate) punctual: IdTable<valid::Punctual, Punctual>,
    /// The environment of paths.
    pub(crate) environment: Environment,
}

impl<S: Intersect> World<S> {
    /// See [`AnyWorld::brightest`](super::any::AnyWorld::brightest).
    pub(super) fn brightest(&self) -> f64 {
        let paths = self.plan.paths.as_ref();
        let is_unbounded =
            |paths: &PathPlan| paths.caustics.is_some() || paths.has_unbounded_caustics();
        if paths.is_some_and(is_unbounded) {
            return f64::INFINITY;
        }
        let environment = self.lights.environment.brightest();
        let seen = paths.map_or(environment, |_| {
            environment.max(self.brightest_surface()) * self.gain_of_bodies()
        });
        match self.camera.is_anaglyph() {
            true => seen * anaglyph::gain(),
            false => seen,
        }
    }

    /// How much brighter the outside may look to a camera in a body: n² of its index, of nested
    /// ones all together. One may be behind a surface without an inside, too.
    fn gain_of_bodies(&self) -> f64 {
        let eye = self.camera.eye;
        let gain = |surface: &Surface<S>| {
            let material = &self.standards[surface.material];
            let index = material.refractive_index(None);
            let holds = |bounds: Bounds| {
                let is_flat = (bounds.max - bounds.min).min_element() <= 0.0;
                is_flat || bounds.distance(eye) == 0.0
            };
            let may_hold = material.bounds_a_volume && surface.shape.bounds().is_none_or(holds);
            may_hold.then_some(index * index)
        };
        self.surfaces.iter().filter_map(gain).product()
    }
}

pub(super) fn lights_for(scene: &ValidScene, plan: &Plan, textures: &Textures) -> LightList {
    match &plan.paths {
        Some(paths) => {
            let is_constant = paths.environment == RemainingEnvironment::Constant;
            let punctuals = facts::light::punctual(scene.lights()).into_iter();
            LightList {
                course: IdTable::default(),
                punctual: punctuals.map(|light| punctual(light, textures)).collect(),
                environment: environment(scene.environment(), is_constant, textures),
            }
        }
        None => {
            let lights = facts::light::course(scene.lights()).into_iter();
            LightList {
                course: lights.map(course).collect(),
                punctual: IdTable::default(),
                environment: environment(&valid::Environment::DARK, false, textures),
            }
        }
    }
}

fn course(light: valid::CourseLight) -> CourseLight {
    let valid::CourseLight {
        position,
        color,
        radius,
    } = light;
    CourseLight {
        position,
        color,
        radius,
    }
}

fn punctual(light: valid::Punctual, textures: &Textures) -> Punctual {
    match light {
        valid::Punctual::Directional(valid::DirectionalLight {
            direction,
            irradiance,
        }) => Punctual::Directional(DirectionalLight {
            direction,
            irradiance,
        }),
        valid::Punctual::Point(light) => Punctual::Point(point(light, textures)),
    }
}

fn point(light: valid::PointLight, textures: &Textures) -> PointLight {
    let valid::PointLight {
        position,
        intensity,
        profile,
        falloff,
        projected,
    } = light;
    PointLight {
        position,
        intensity,
        profile,
        falloff: match falloff {
            valid::Falloff::None => Falloff::None,
            valid::Falloff::Square => Falloff::Square,
            valid::Falloff::Ranged(range) => Falloff::Ranged(range.get() * range.get()),
        },
        projected: projected.map(|projected| {
            Box::new(ProjectedTexture {
                map: textures.map(&projected.map, ColorSpace::Srgb),
                uv_from_direction: projected.uv_from_direction,
                irradiance_axis: projected.irradiance_axis,
            })
        }),
    }
}

fn environment(
    environment: &valid::Environment,
    is_constant: bool,
    textures: &Textures,
) -> Environment {
    let valid::Environment {
        radiance,
        image,
        image_from_world,
    } = *environment;
    let image = image.map(|image| textures.image(image));
    Environment::new(radiance, image, image_from_world, is_constant)
}
