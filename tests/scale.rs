//! Scenes made larger or smaller, for suites that state laws of scale.

use rtc::internals::ir::{self, Scene, Shape};
use serde_json::Value;

/// Every length of the scene times a factor; what is a direction or a colour stays.
pub(crate) fn scaled(scene: &Scene, factor: f64) -> Scene {
    let mut scene = scene.clone();
    let ir::Camera {
        eye,
        center,
        right,
        up,
        size: _,
        lens,
        projection: _,
    } = &mut scene.camera;
    for vector in [eye, center, right, up] {
        scale(vector, factor);
    }
    lens.radius *= factor;
    scene
        .lights
        .iter_mut()
        .for_each(|light| scale_light(light, factor));
    for material in &mut scene.materials {
        if let ir::Material::Standard(standard) = material {
            standard.attenuation_distance = standard
                .attenuation_distance
                .map(|distance| distance * factor);
            for medium in [&mut standard.interior, &mut standard.exterior] {
                medium.iter_mut().for_each(|medium| thin(medium, factor));
            }
        }
    }
    scene
        .medium
        .iter_mut()
        .for_each(|medium| thin(medium, factor));
    for surface in &mut scene.surfaces {
        scale_shape(&mut surface.shape, factor);
        let mut velocity = surface.velocity.get();
        scale(&mut velocity, factor);
        surface.velocity = velocity.into();
    }
    scene
}

/// A medium in a scene that is scaled: the same part of the light arrives.
fn thin(medium: &mut ir::Medium, factor: f64) {
    let ir::Medium {
        sigma_a,
        sigma_s,
        g: _,
    } = medium;
    scale(sigma_a, 1.0 / factor);
    scale(sigma_s, 1.0 / factor);
}

fn scale(v: &mut [f64; 3], factor: f64) {
    *v = v.map(|component| component * factor);
}

/// A light with falloff is as bright in the scaled scene as in the one before.
fn scale_light(light: &mut ir::Light, factor: f64) {
    let punctual = match light {
        ir::Light::Point(light) => {
            scale(&mut light.position, factor);
            light.radius *= factor;
            return;
        }
        ir::Light::Punctual(punctual) => punctual,
    };
    let is_far = punctual.emitter.position().is_none();
    let place = |position: [f64; 3]| position.map(|component| component * factor);
    punctual
        .emitter
        .transform(place, |direction| direction, factor);
    if !is_far {
        punctual.intensity = punctual.intensity.map(|channel| channel * factor * factor);
    }
}

/// Every length of a shape times a factor: all numbers but those of directions, of textures, and of
/// references.
pub(crate) fn scale_shape(shape: &mut Shape, factor: f64) {
    const UNSCALED: [&str; 5] = ["axis", "normal", "uvs", "textureFromWorld", "mesh"];
    let mut tree = serde_json::to_value(&*shape).expect("a shape is numbers");
    let values = tree
        .as_object_mut()
        .and_then(|kinds| kinds.values_mut().next());
    let values = values
        .and_then(Value::as_object_mut)
        .expect("a shape has values");
    for (name, value) in values.iter_mut() {
        if !UNSCALED.contains(&name.as_str()) {
            scale_numbers(value, factor);
        }
    }
    *shape = serde_json::from_value(tree).expect("the same values, scaled");
}

fn scale_numbers(value: &mut Value, factor: f64) {
    if let Some(number) = value.as_f64() {
        *value = (number * factor).into();
    } else if let Some(items) = value.as_array_mut() {
        items
            .iter_mut()
            .for_each(|item| scale_numbers(item, factor));
    }
}
