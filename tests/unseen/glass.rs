//! Glass with a refractive index of 1 is invisible, in any shape.

use super::{film, scene, smooth};
use rtc::internals::ir::{Material, Scene};
use rtc::internals::plan::RuleSet;

/// Every shape of the course, and meshes with normals.
const SHAPES: [(&str, f64); 15] = [
    ("sphere, position: [0, 1, 0], radius: 1", 0.0),
    ("plane, position: [0, 0.5, 0], normal: [0.1, 1, 0.2]", 0.0),
    (
        "triangle, v0: [-1, 0.1, 1], v1: [1.3, 0.2, 0.4], v2: [0.2, 2.1, -0.6]",
        0.0,
    ),
    (
        "quad, v0: [-1, 0.1, 1], v1: [1.2, 0.1, 0.6], v2: [1.2, 2, 0.1], v3: [-1, 1.4, -1.3]",
        0.0,
    ),
    (
        "quad, v0: [-1, 0.1, 1], v1: [1, 0.1, 1], v2: [1, 2, 0], v3: [-1, 2, 0]",
        0.0,
    ),
    (
        "circle, center: [0, 1, 0], normal: [0.3, 0.2, 1], radius: 1.1",
        0.0,
    ),
    (
        "cylinder, p1: [-0.7, 0.4, 0.3], p2: [0.8, 1.6, -0.4], radius: 0.6",
        0.0,
    ),
    (
        "cone, position: [0, 0.1, 0], up: [0.4, 2, 0.3], radius: 1",
        0.0,
    ),
    (
        "torus, position: [0, 1, 0], radius: 0.9, alpha: 0.3, direction: [0.3, 1, 0.6]",
        0.0,
    ),
    (
        "box, position: [0, 1, 0], dimension: [1.2, 1.4, 1.1], rotation: [0.3, 0.7, 0.1]",
        0.0,
    ),
    (
        "tetrahedron, v0: [-1, 0.1, 0.6], v1: [0.1, 0.1, 1.4], v2: [1, 0.1, 0.5], v3: [0.2, 1.9, \
         0.4]",
        0.0,
    ),
    (
        "prism, v0: [-1, 0.1, 0.8], v1: [0.9, 0.1, 0.9], v2: [0.1, 1.7, 0.7], up: [0.2, 0.1, -1.4]",
        0.0,
    ),
    (
        "mesh, file: icosahedron.obj, position: [0, 1, 0], radius: 1",
        0.001,
    ),
    (
        "mesh, file: ball.obj, position: [0, 1, 0], radius: 1",
        0.001,
    ),
    ("mesh, file: ball.obj, position: [0, 1, 0], radius: 1", 0.9),
];

/// An optional shape before two spheres, under a light that it does not occlude from any visible
/// point.
fn glass(shape: Option<(&str, f64)>, eta: f64, shadows: bool) -> Scene {
    let shape_of = |(numbers, _)| {
        format!(
            "- {{type: {numbers}, material: {{color: [1, 1, 1], ka: 0, kd: 0, ks: 0, n: 1, kt: 1, \
             eta: 1}}}}\n"
        )
    };
    let mut scene = scene(&format!(
        "Camera: {{eye: [0.5, 3, 7], center: [0, 1, 0], up: [0, 1, 0], viewSize: [100, 100], fov: \
         25}}\n\
         MaxRecursionDepth: 40\nShadows: {shadows}\nLights:\n- {{position: [1, 9, -4], color: \
         [0.9, 0.8, 0.7]}}\nObjects:\n\
         - {{type: sphere, position: [0, -60, -30], radius: 60, material: \
         {{color: [0.8, 0.5, 0.3], ka: 0.2, kd: 0.6, ks: 0.2, n: 20}}}}\n\
         - {{type: sphere, position: [0, 3, -25], radius: 20, material: \
         {{color: [0.2, 0.5, 0.9], ka: 0.2, kd: 0.8, ks: 0, n: 20}}}}\n{}",
        shape.map(shape_of).unwrap_or_default()
    ));
    if let Some((_, tilt)) = shape
        && tilt > 0.0
    {
        smooth(&mut scene, tilt);
    }
    for material in &mut scene.materials {
        if let Material::Phong(phong) = material
            && phong.kt > 0.0
        {
            phong.ior = eta;
        }
    }
    scene
}

/// With an index of exactly 1, everywhere. With 1 ± 10⁻¹², Snell's law itself refracts grazing rays
/// more than that: on outlines.
#[test]
fn an_index_of_one_is_invisible_for_every_shape() {
    for shadows in [false, true] {
        let empty = film(&glass(None, 1.0, shadows), RuleSet::ALL).image;
        // A plane occludes the light from half of the space.
        for shape in SHAPES
            .into_iter()
            .filter(|(numbers, _)| !(shadows && numbers.starts_with("plane")))
        {
            for eta in [1.0, 1.0 + 1e-12, 1.0 - 1e-12] {
                let film = film(&glass(Some(shape), eta, shadows), RuleSet::ALL);
                assert!(
                    film.counts.refracted > 500,
                    "{}: the shape is looked through",
                    shape.0
                );
                let worst = |(seen, wanted): (&[f64; 3], &[f64; 3])| {
                    let off =
                        |k: usize| (seen[k] - wanted[k]).abs() / wanted[k].max(f64::MIN_POSITIVE);
                    off(0).max(off(1)).max(off(2))
                };
                let worst = film
                    .image
                    .pixels
                    .iter()
                    .zip(&empty.pixels)
                    .map(worst)
                    .collect::<Vec<_>>();
                let outlines = worst.iter().filter(|worst| **worst > 1e-9).count();
                let largest = worst.iter().copied().fold(0.0, f64::max);
                let (most, allowed) = if eta == 1.0 { (0, 1e-9) } else { (10, 1e-6) };
                let told = format!(
                    "{shape:?}, eta {eta:?}, shadows {shadows}: {outlines} pixels, {largest:e} at \
                     most"
                );
                assert!(outlines <= most && largest <= allowed, "{told}");
            }
        }
    }
}

/// A pane of index 1.5 between a white wall behind the eye and a black one: the pixel in the middle
/// shows the part that Schlick's approximation reflects, by the angle; the wall in front, white in
/// place of the other, shows the rest.
#[test]
fn fresnel_divides_kt_between_the_mirror_image_and_what_is_behind() {
    let seen = |turn: f64, [behind, ahead]: [u8; 2]| {
        let (sin, cos) = (turn.sin(), turn.cos());
        let wall = |z: i32, towards: i32, white: u8| {
            format!(
                "- {{type: circle, center: [0, 0, {z}], normal: [0, 0, {towards}], radius: 900, \
                 material: {{color: [{white}, {white}, {white}], ka: 1, kd: 0, ks: 0, n: 1}}}}\n"
            )
        };
        let text = format!(
            "Camera: {{eye: [0, 0, 5], center: [0, 0, 0], up: [0, 1, 0], viewSize: [1, 1], fov: \
             1}}\nMaxRecursionDepth: 1\nLights:\n- {{position: [0, 9, 9], color: [1, 1, 1]}}\n\
             Objects:\n- {{type: circle, center: [0, 0, 0], normal: [{sin}, 0, {cos}], radius: 3, \
             material: {{color: [1, 1, 1], ka: 0, kd: 0, ks: 0, n: 1, kt: 0.8, eta: 1.5, fresnel: \
             true}}}}\n{}{}",
            wall(7, -1, behind),
            wall(-7, 1, ahead)
        );
        film(&scene(&text), RuleSet::ALL).image.pixels[0][0]
    };
    for turn in [0.0, 0.2, 0.6] {
        let cosine = f64::cos(turn);
        let reflected = 0.04 + 0.96 * (1.0 - cosine).powi(5);
        let [mirror, through] = [seen(turn, [1, 0]), seen(turn, [0, 1])];
        assert!((mirror - 0.8 * reflected).abs() < 1e-12, "{turn}: {mirror}");
        let rest = 0.8 * (1.0 - reflected);
        assert!((through - rest).abs() < 1e-12, "{turn}: {through}");
    }
}
