//! Worlds out of shapes, by the same way every scene takes: IR, proof, world.

use super::truth::{number, vector};
use rtc::internals::diag::DiagnosticSink;
use rtc::internals::ir;
use rtc::internals::plan::{Plan, RuleSet};
use rtc::internals::render::World;
use rtc::internals::valid::{self, ValidScene};
use serde_json::Value;

/// A white Phong material that is lit, shines and mirrors.
pub(crate) fn white() -> ir::Material {
    ir::Material::Phong(ir::Phong::MATT)
}

/// A scene of shapes, each white, seen from afar.
pub(crate) fn scene(shapes: impl IntoIterator<Item = ir::Shape>) -> ir::Scene {
    let surface = |shape| ir::Surface::new(shape, ir::MaterialId(0));
    ir::Scene {
        camera: ir::Camera {
            eye: [0.0, 0.0, 10.0],
            center: [0.0; 3],
            right: [1.0, 0.0, 0.0],
            up: [0.0, 1.0, 0.0],
            size: [1, 1],
            lens: ir::Lens {
                radius: 0.0,
                samples: 1,
            },
            projection: ir::Projection::Perspective,
        },
        settings: ir::Settings {
            mode: ir::Mode::Phong,
            shadows: true,
            max_depth: 0,
            ..ir::Settings::default()
        },
        images: Vec::new(),
        textures: Vec::new(),
        meshes: Vec::new(),
        lights: Vec::new(),
        materials: vec![white()],
        surfaces: shapes.into_iter().map(surface).collect(),
        names: Vec::new(),
        environment: None,
        medium: None,
        display: ir::Display::default(),
        trees: Vec::new(),
    }
}

/// The proof of a scene; what the proof says otherwise is the panic's message.
pub(crate) fn validated(scene: &ir::Scene) -> ValidScene {
    check(scene).unwrap_or_else(|codes| panic!("refused: {codes:?}"))
}

/// The proof, or the codes of the errors.
pub(crate) fn check(scene: &ir::Scene) -> Result<ValidScene, Vec<&'static str>> {
    let mut sink = DiagnosticSink::default();
    let proof = valid::validate(
        scene,
        &ir::SourceSpans::default(),
        &valid::ValidationOptions::default(),
        &mut sink,
    );
    proof.ok_or_else(|| sink.kept().iter().map(|finding| finding.code.id).collect())
}

pub(crate) fn world(shapes: impl IntoIterator<Item = ir::Shape>) -> World {
    prepare(&scene(shapes))
}

pub(crate) fn prepare(scene: &ir::Scene) -> World {
    let scene = validated(scene);
    World::prepare(&scene, &Plan::new(&scene, RuleSet::NONE))
}

pub(crate) fn sphere(center: [f64; 3], radius: f64) -> ir::Shape {
    ir::Shape::Sphere(ir::Sphere {
        center,
        radius,
        texture_from_world: None,
    })
}

pub(crate) fn plane(center: [f64; 3], normal: [f64; 3]) -> ir::Shape {
    ir::Shape::Plane(ir::Plane { center, normal })
}

pub(crate) fn triangle(vertices: [[f64; 3]; 3]) -> ir::Shape {
    ir::Shape::Triangle(ir::Triangle {
        vertices,
        uvs: None,
    })
}

/// The shape of a case, or `None` for one that this version does not have.
pub(crate) fn shape(value: &Value) -> Option<ir::Shape> {
    let point = |key: &str| vector(&value[key]).to_array();
    let length = |key: &str| number(&value[key]);
    let vertices = |k: usize| vector(&value["v"][k]).to_array();
    Some(match value["type"].as_str().unwrap() {
        "sphere" => sphere(point("center"), length("radius")),
        "plane" => plane(point("center"), point("normal")),
        "triangle" => triangle([0, 1, 2].map(vertices)),
        "disc" => disc(point("center"), point("normal"), length("radius")),
        "cylinder" => cylinder(
            point("base"),
            point("axis"),
            length("height"),
            length("radius"),
        ),
        "cone" => {
            let axis = vector(&value["axis"]);
            cone(
                point("base"),
                (axis * (length("height") / axis.length())).to_array(),
                length("radius"),
            )
        }
        "torus" => torus(point("center"), point("axis"), length("R"), length("r")),
        "quad" => {
            let (origin, u, v) = (
                vector(&value["origin"]),
                vector(&value["u"]),
                vector(&value["v"]),
            );
            ir::Shape::Quad(ir::Quad {
                vertices: [origin, origin + u, origin + u + v, origin + v].map(|p| p.to_array()),
            })
        }
        _ => return None,
    })
}

pub(crate) fn disc(center: [f64; 3], normal: [f64; 3], radius: f64) -> ir::Shape {
    ir::Shape::Disc(ir::Disc {
        center,
        normal,
        radius,
    })
}

pub(crate) fn cylinder(base: [f64; 3], axis: [f64; 3], height: f64, radius: f64) -> ir::Shape {
    ir::Shape::Cylinder(ir::Cylinder {
        base,
        axis,
        height,
        radius,
    })
}

pub(crate) fn cone(base: [f64; 3], up: [f64; 3], radius: f64) -> ir::Shape {
    ir::Shape::Cone(ir::Cone { base, up, radius })
}

pub(crate) fn paraboloid(base: [f64; 3], up: [f64; 3], radius: f64) -> ir::Shape {
    ir::Shape::Paraboloid(ir::Paraboloid { base, up, radius })
}

pub(crate) fn torus(center: [f64; 3], axis: [f64; 3], major: f64, minor: f64) -> ir::Shape {
    ir::Shape::Torus(ir::Torus {
        center,
        axis,
        major,
        minor,
    })
}
