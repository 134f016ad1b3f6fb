//! Lights as path tracers have them.

use crate::export::{NOT_PROJECTED, mean_over_directions};
use crate::reporter::ExportReporter;
use rtc_ir::{
    EntityField, EntityKind, Light, Photometry, PointLight, Punctual, PunctualKind, Scene,
    ValuePath,
};
use rtc_math::{Vec3, cos, unit};
use rtc_profile::LightProfile;

/// A light without extent.
pub(crate) enum PathTracerLight {
    /// Parallel light.
    Distant {
        /// The direction to the light, a unit vector.
        to_light: Vec3,
        /// On a surface across the light.
        irradiance: [f64; 3],
    },
    Point {
        position: [f64; 3],
        intensity: [f64; 3],
    },
    Spot(SpotLight),
}

/// A spot: angles are in radians from its axis.
pub(crate) struct SpotLight {
    pub(crate) position: [f64; 3],
    /// The axis, a unit vector.
    pub(crate) direction: Vec3,
    pub(crate) inner_angle: f64,
    pub(crate) outer_angle: f64,
    pub(crate) intensity: [f64; 3],
    /// The factor of the intensity by direction.
    pub(crate) profile: LightProfile,
    pub(crate) edge: SpotEdge,
}

/// How the intensity of a spot falls from the inner to the outer angle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum SpotEdge {
    /// By the square of a linear function of the cosine, as in glTF.
    Squared,
    /// Linearly in the angle, as in Mitsuba.
    Linear,
    /// By a smooth step of the cosine, as in pbrt.
    SmoothStep,
}

/// The lights that emit, with their paths. Reports how they differ in a renderer.
pub(crate) fn lights(
    scene: &Scene,
    renderer: &str,
    reporter: &mut ExportReporter<'_>,
) -> Vec<(PathTracerLight, ValuePath)> {
    let emitting = scene.lights.iter().enumerate();
    let emitting = emitting.filter(|(_, light)| light.emits());
    let written = emitting.map(|(index, light)| {
        let path = ValuePath::new(EntityKind::Light, index, EntityField::Whole);
        let light = match light {
            Light::Point(light) => with_falloff(scene, light, reporter, path),
            Light::Punctual(light) => match photometric_spot(light) {
                Some(spot) => {
                    if light.projected.is_some() {
                        reporter.unsupported(NOT_PROJECTED, path);
                    }
                    spot
                }
                None => {
                    reporter.simplified_light(light, renderer, path);
                    punctual(light)
                }
            },
        };
        (light, path)
    });
    written.collect()
}

/// A light without falloff as one with it.
fn with_falloff(
    scene: &Scene,
    light: &PointLight,
    reporter: &mut ExportReporter<'_>,
    path: ValuePath,
) -> PathTracerLight {
    let message = "a light without falloff is written as a point light that is equally bright \
                   at the centre of the scene";
    reporter.unsupported(message, path);
    let middle = scene.bounding_sphere();
    let middle = middle.map_or(Vec3::ZERO, |sphere| sphere.center);
    PathTracerLight::Point {
        position: light.position,
        intensity: light.intensity_at(middle.to_array()),
    }
}

fn punctual(light: &Punctual) -> PathTracerLight {
    let Punctual {
        emitter, intensity, ..
    } = light;
    let direction_of = |direction: &[f64; 3]| unit(Vec3::from_array(*direction));
    match emitter {
        PunctualKind::Sun { direction } => PathTracerLight::Distant {
            to_light: direction_of(direction).unwrap_or(Vec3::Z),
            irradiance: *intensity,
        },
        PunctualKind::Point { position, range: _ } => PathTracerLight::Point {
            position: *position,
            intensity: *intensity,
        },
        PunctualKind::Spot {
            position,
            direction,
            inner_angle,
            outer_angle,
            range: _,
        } => PathTracerLight::Spot(SpotLight {
            position: *position,
            direction: direction_of(direction).unwrap_or(Vec3::Z),
            inner_angle: *inner_angle,
            outer_angle: *outer_angle,
            intensity: *intensity,
            profile: emitter.profile().unwrap_or(LightProfile::Uniform),
            edge: SpotEdge::Squared,
        }),
        PunctualKind::Photometric { position, .. } => {
            let mean = mean_over_directions(emitter);
            PathTracerLight::Point {
                position: *position,
                intensity: intensity.map(|channel| channel * mean),
            }
        }
    }
}

/// A photometric light that is the spot of a path tracer.
fn photometric_spot(light: &Punctual) -> Option<PathTracerLight> {
    let PunctualKind::Photometric {
        position,
        direction,
        photometry,
        ..
    } = &light.emitter
    else {
        return None;
    };
    let ([inner, outer], edge) = falloff(photometry)?;
    Some(PathTracerLight::Spot(SpotLight {
        position: *position,
        direction: unit(Vec3::from_array(*direction)).unwrap_or(Vec3::Z),
        inner_angle: inner.to_radians(),
        outer_angle: outer.to_radians(),
        intensity: light.intensity,
        profile: light.emitter.profile().ok()?,
        edge,
    }))
}

/// The angles in degrees between which a light falls off from 1 to 0 as a spot does.
fn falloff(photometry: &Photometry) -> Option<([f64; 2], SpotEdge)> {
    /// The fewest angles that show the form of an edge.
    const LEAST_ANGLES: usize = 8;
    /// The largest difference between a table and the smooth step that it stands for.
    const TOLERANCE: f64 = 1e-6;
    if let Some(angles) = photometry.linear_falloff() {
        return Some((angles, SpotEdge::Linear));
    }
    let (angles, factors) = (&photometry.vertical, &photometry.candela);
    let is_round = photometry.horizontal == [0.0] && angles.len() == factors.len();
    if !is_round || angles.len() < LEAST_ANGLES {
        return None;
    }
    let full = factors.iter().take_while(|factor| **factor == 1.0).count();
    let inner = *angles.get(full.checked_sub(1)?)?;
    let outer = *angles.last()?;
    let [start, end] = [inner, outer].map(|angle| cos(angle.to_radians()));
    let is_smooth = angles.iter().zip(factors).all(|(angle, factor)| {
        let x = ((cos(angle.to_radians()) - end) / (start - end)).clamp(0.0, 1.0);
        (x * x * (3.0 - 2.0 * x) - factor).abs() <= TOLERANCE
    });
    is_smooth.then_some(([inner, outer], SpotEdge::SmoothStep))
}
