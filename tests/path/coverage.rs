//! How much of each pixel is covered, and that what is behind changes nothing else.

use super::*;

fn film(scene: &Scene, background: Background) -> Film {
    let proof = validate(scene);
    let job = RenderSelection { background, ..JOB };
    rtc::internals::render::render(&proof, &Plan::new(&proof, RuleSet::ALL), &job, &|_| true)
        .unwrap()
}

#[test]
fn an_edge_through_pixels_covers_the_share_on_its_side() {
    let mut scene = scene(64);
    let unlit = Standard {
        unlit: true,
        base_color: [0.5, 0.25, 1.0, 1.0],
        ..Standard::default()
    };
    // The square ends in the middle of the fourth pixel from each edge.
    add_square(&mut scene, 0.0, 0.5625, unlit);
    scene.environment = sky(7.0);
    let film = film(&scene, Background::Nothing);
    let at = |x: usize, y: usize| film.coverage[y * 16 + x];
    // 64 points of the sequence are 32 in each half, and 16 in each quarter.
    assert_eq!(
        [at(8, 8), at(3, 8), at(8, 12), at(3, 3), at(2, 8), at(0, 0)],
        [1.0, 0.5, 0.5, 0.25, 0.0, 0.0]
    );
    for (pixel, share) in film.image.pixels.iter().zip(&film.coverage) {
        assert_eq!(*pixel, [0.5, 0.25, 1.0].map(|v| v * f64::from(*share)));
    }
}

#[test]
fn a_veil_covers_by_its_opacity() {
    let mut scene = scene(1024);
    let veil = Standard {
        alpha: Alpha::Blend,
        base_color: [1.0, 1.0, 1.0, 0.25],
        ..lambert([1.0; 3])
    };
    add_square(&mut scene, 0.0, 1.5, veil);
    let covered = film(&scene, Background::Nothing).coverage;
    let mean = covered.iter().sum::<f32>() / covered.len() as f32;
    // 2¹⁸ independent rays: five standard deviations are 0.0042.
    assert!((mean - 0.25).abs() < 0.0042, "{mean}");
}

#[test]
fn what_is_behind_is_seen_past_surfaces_alone() {
    let mut scene = scene(16);
    add_square(&mut scene, 0.0, 0.5, lambert([0.8; 3]));
    add_sphere(
        &mut scene,
        [0.0, 0.0, 1.0],
        0.25,
        Standard {
            metallic: 1.0,
            roughness: 0.0,
            ..Standard::default()
        },
    );
    scene.environment = sky(0.75);
    let (shown, hidden) = (
        film(&scene, Background::Environment),
        film(&scene, Background::Nothing),
    );
    assert_eq!(shown.coverage, hidden.coverage);
    for ((shown, hidden), share) in shown
        .image
        .pixels
        .iter()
        .zip(&hidden.image.pixels)
        .zip(&shown.coverage)
    {
        let background = 0.75 * (1.0 - f64::from(*share));
        assert!(
            (0..3).all(|k| (shown[k] - hidden[k] - background).abs() < 1e-12),
            "{shown:?} {hidden:?} {share}"
        );
    }
}
