//! No light enters closed meshes, whatever their vertex normals are.

use super::{film, scene, smooth};
use rtc::internals::ir::Scene;
use rtc::internals::plan::RuleSet;
use rtc::internals::render::Film;

/// The inside of a closed mesh with lights outside, one of them in the plane of a face of the
/// icosahedron.
fn inside(file: &str, tilt: f64, keys: &str, material: &str) -> Scene {
    let mut scene = scene(&format!(
        "Camera: {{eye: [0.1, 0.05, -0.02], center: [0.5, 0.3, 0.4], up: [0, 1, 0], viewSize: \
         [50, 50], fov: 100}}\n\
         Shadows: true\n{keys}\nLights:\n- {{position: [3, 4, 5], color: [1, 1, 1]}}\n\
         - {{position: [-3, -4, 2], color: [1, 1, 1]}}\n- {{position: [0, 1.1, -1], color: [1, 1, \
         1]}}\nObjects:\n\
         - {{type: mesh, file: {file}, position: [0, 0, 0], radius: 1, material: {{color: [1, 1, \
         1], {material}}}}}\n"
    ));
    smooth(&mut scene, tilt);
    scene
}

/// Each ray hits the mesh, however often it is reflected, and has only its ambient term: that of
/// three lights times 2⁻¹⁰.
#[test]
fn no_light_enters_a_closed_smooth_mesh() {
    let mirrors = "ka: 0.0009765625, kd: 0.5, ks: 1, n: 4";
    let cases = [
        ("", "ka: 0.0009765625, kd: 0.5, ks: 0, n: 1", 1),
        ("MaxRecursionDepth: 50", mirrors, 51),
        (
            "MaxRecursionDepth: 3",
            &format!("{mirrors}, glossySamples: 4"),
            4,
        ),
    ];
    for (file, tilt) in [
        ("icosahedron.obj", 0.0),
        ("ball.obj", 0.0),
        ("icosahedron.obj", 0.9),
        ("ball.obj", 0.9),
    ] {
        for (keys, material, corners) in cases {
            let scene = inside(file, tilt, keys, material);
            let film = film(&scene, RuleSet::ALL);
            let wanted = f64::from(corners) * 3.0 / 1024.0;
            let seen = film.image.pixels.iter().flatten();
            // A lobe below the surface contributes nothing.
            let is_dark = |value: &&f64| {
                if corners == 4 {
                    **value > wanted * 1.001
                } else {
                    **value != wanted
                }
            };
            let count = seen.filter(is_dark).count();
            assert_eq!(count, 0, "{file}, normals tilted by {tilt}, {material}");
            let bits = |film: &Film| {
                film.image
                    .pixels
                    .iter()
                    .flatten()
                    .map(|value| value.to_bits())
                    .collect::<Vec<_>>()
            };
            let unpruned = super::film(&scene, RuleSet::NONE);
            assert!(
                bits(&unpruned) == bits(&film),
                "{file}, {tilt}, {material}: the rules show"
            );
        }
    }
}

/// Without shadows only the shading normal decides what is illuminated, as in the course.
#[test]
fn without_shadows_the_geometric_normal_says_nothing() {
    let mut scene = inside("icosahedron.obj", 0.0, "", "ka: 0, kd: 0.5, ks: 0, n: 1");
    scene.settings.shadows = false;
    let lit = film(&scene, RuleSet::ALL)
        .image
        .pixels
        .iter()
        .filter(|pixel| pixel[0] > 0.0)
        .count();
    assert!(lit > 25, "{lit} pixels");
}
