//! The curved shapes of the course show neither acne nor cracks.

use super::scenes::{at, course, validated, whole};
use crate::suite::trial;
use libtest_mimic::Trial;
use rtc::internals::image::Image;
use rtc::internals::ir::Scene;
use rtc::internals::render::{Film, RayCounts};

const CURVED: [&str; 5] = [
    "tori.yaml",
    "torus.yaml",
    "cylinder.yaml",
    "circle.yaml",
    "olympic.yaml",
];

pub(crate) fn trials() -> Vec<Trial> {
    let mut trials = vec![trial("pictures: one wrong pixel is counted", || {
        one_wrong_pixel_is_counted();
    })];
    trials.extend(CURVED.map(|name| course("pictures", name, shows_neither_acne_nor_cracks)));
    trials
}

/// Pixels that differ by more than a quarter of the range from eight neighbours that agree: acne
/// and cracks.
fn outliers(film: &Film) -> usize {
    const LARGE: f64 = 0.25;
    const SMALL: f64 = 0.1;
    let (width, height) = (film.image.width as usize, film.image.height as usize);
    let pixel = |x: usize, y: usize| film.image.pixels[y * width + x];
    let differ = |a: [f64; 3], b: [f64; 3], limit: f64| (0..3).any(|k| (a[k] - b[k]).abs() > limit);
    let alone = |x: usize, y: usize| {
        let around = || {
            (0..9)
                .filter(|k| *k != 4)
                .map(|k| pixel(x + k % 3 - 1, y + k / 3 - 1))
        };
        let first = pixel(x - 1, y - 1);
        around().all(|other| !differ(other, first, SMALL)) && differ(pixel(x, y), first, LARGE)
    };
    (1..height - 1)
        .flat_map(|y| (1..width - 1).map(move |x| (x, y)))
        .filter(|(x, y)| alone(*x, *y))
        .count()
}

fn shows_neither_acne_nor_cracks(scene: Scene) {
    let [width, height] = scene.camera.size;
    // Reflections of the rings in themselves are finer than a pixel; nine rays tell such a line
    // from acne.
    let scene = at(scene, [800, 800 * height / width], 3);
    assert_eq!(outliers(&whole(&validated(scene))), 0, "isolated pixels");
}

fn one_wrong_pixel_is_counted() {
    let image = Image {
        width: 5,
        height: 5,
        pixels: vec![[0.5; 3]; 25],
    };
    let mut film = Film {
        image,
        coverage: vec![1.0; 25],
        counts: RayCounts::default(),
    };
    assert_eq!(outliers(&film), 0);
    film.image.pixels[12] = [0.5, 0.0, 0.5];
    assert_eq!(outliers(&film), 1);
}
