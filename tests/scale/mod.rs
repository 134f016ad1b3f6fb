//! Scenes made larger or smaller, for suites that state laws of scale.

use rtc::ir::{self, Scene, Shape};

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
        }
    }
    scene
        .surfaces
        .iter_mut()
        .for_each(|surface| scale_shape(&mut surface.shape, factor));
    scene
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
    match &mut punctual.emitter {
        ir::Emitter::Sun { direction: _ } => {}
        ir::Emitter::Point { position, range }
        | ir::Emitter::Spot {
            position,
            direction: _,
            inner_angle: _,
            outer_angle: _,
            range,
        } => {
            scale(position, factor);
            *range = range.map(|range| range * factor);
            punctual.intensity = punctual.intensity.map(|channel| channel * factor * factor);
        }
    }
}

/// Every length of a shape times a factor.
pub(crate) fn scale_shape(shape: &mut Shape, factor: f64) {
    match shape {
        Shape::Sphere(ir::Sphere {
            center,
            radius,
            texture_from_world: _,
        })
        | Shape::Disc(ir::Disc {
            center,
            normal: _,
            radius,
        }) => {
            scale(center, factor);
            *radius *= factor;
        }
        Shape::Plane(ir::Plane { center, normal: _ }) => scale(center, factor),
        Shape::Triangle(ir::Triangle { vertices, uvs: _ }) => {
            vertices.iter_mut().for_each(|v| scale(v, factor))
        }
        Shape::Quad(ir::Quad { vertices }) => vertices.iter_mut().for_each(|v| scale(v, factor)),
        Shape::Cylinder(ir::Cylinder {
            base,
            axis: _,
            height,
            radius,
        }) => {
            scale(base, factor);
            *height *= factor;
            *radius *= factor;
        }
        Shape::Cone(ir::Cone { base, up, radius }) => {
            scale(base, factor);
            scale(up, factor);
            *radius *= factor;
        }
        Shape::Torus(ir::Torus {
            center,
            axis: _,
            major,
            minor,
        }) => {
            scale(center, factor);
            *major *= factor;
            *minor *= factor;
        }
        Shape::Instance(ir::Instance {
            mesh: _,
            world_from_object,
        }) => {
            world_from_object
                .iter_mut()
                .for_each(|column| scale(column, factor));
        }
    }
}
