//! Scenes that had light of nothing, or too much of it inside of glass.

use super::scenes::{at, read, validated, whole};
use crate::suite::needs;
use libtest_mimic::Trial;
use rtc::internals::ir::{Mode, Scene};
use rtc::internals::math::Vec3;
use std::path::Path;

pub(crate) fn trials() -> Vec<Trial> {
    let furnace = |name: &'static str, least: f64| {
        let path = format!("round-4/promises/{name}.yaml");
        needs(format!("energy/{name}"), &path, move |path| {
            is_in_its_furnace(path, least);
        })
    };
    let glass = "round-4/mitsuba/mi-light-inside-glass-2.25x.xml";
    vec![
        furnace("half-transmitting-volume-creates-light", 0.97),
        furnace("plastic-with-diffuse-transmission-creates-light", 0.75),
        furnace("brushed-rough-glass-loses-half-of-the-light", 0.95),
        needs("energy/a lamp inside glass", glass, a_lamp_inside_glass),
    ]
}

fn samples(mut scene: Scene, samples: u32) -> Scene {
    if let Mode::Path(settings) = &mut scene.settings.mode {
        settings.samples = samples;
    }
    scene
}

fn pixels(scene: Scene) -> Vec<Vec3> {
    let film = whole(&validated(scene));
    film.image
        .pixels
        .into_iter()
        .map(Vec3::from_array)
        .collect()
}

fn mean(pixels: &[Vec3]) -> Vec3 {
    pixels.iter().copied().sum::<Vec3>() / pixels.len() as f64
}

/// A ball in a sky of radiance 1 is at most as bright, and as good as.
fn is_in_its_furnace(path: &Path, least: f64) {
    let found = mean(&pixels(samples(read(path), 256)));
    assert!(
        found.min_element() >= least && found.max_element() <= 1.01,
        "{found}"
    );
}

/// As Mitsuba 3.9.1 has it at 1024 samples a pixel.
fn a_lamp_inside_glass(path: &Path) {
    let known = Vec3::new(0.072_63, 0.068_22, 0.066_03);
    let scene = samples(at(read(path), [24, 24], 1), 256);
    let found = mean(&pixels(scene));
    let error = (found / known - Vec3::ONE).abs().max_element();
    assert!(error < 0.03, "{found}, not {known}");
}
