//! Patterns of white on black in the image plane, as fine as its pixels: the value of each pixel is
//! known.

use super::scenes::lowered;
use rtc::internals::image::Image;
use rtc::internals::ir::Scene;
use rtc::internals::study::{LEVELS, SplitMix64, TargetResult};
use std::fmt::Write as _;

/// A scene, and its picture without noise.
pub(crate) struct Pattern {
    pub(crate) scene: Scene,
    /// The grey of each pixel, row by row.
    reference: Vec<f64>,
}

impl Pattern {
    /// The error of a picture of it in grey levels.
    pub(crate) fn error(&self, reached: &TargetResult) -> f64 {
        let Image { pixels, .. } = &reached.image;
        let squares = pixels.iter().zip(&self.reference);
        let sum = squares.flat_map(|(pixel, reference)| {
            pixel.map(|value| (value - reference) * (value - reference))
        });
        (sum.sum::<f64>() / (3 * pixels.len()) as f64).sqrt() * LEVELS
    }

    /// A scene of objects in the image plane, with pixels of side 1 and the origin in the centre.
    pub(crate) fn new(side: u32, objects: &str, reference: impl Fn(u32, u32) -> f64) -> Self {
        let text = format!(
            "Camera: {{eye: [0, 0, 100], center: [0, 0, 0], up: [0, 1, 0], viewSize: [{side}, \
             {side}]}}\n\
             Lights:\n- {{position: [0, 0, 50], color: [1, 1, 1]}}\nObjects:\n{objects}"
        );
        let pixels = (0..side).flat_map(|y| (0..side).map(move |x| (x, y)));
        Self {
            scene: lowered("pattern", text),
            reference: pixels.map(|(x, y)| reference(x, y)).collect(),
        }
    }
}

/// A white quad from a corner along two edges, as a line of a scene.
pub(crate) fn quad(text: &mut String, corner: [f64; 2], across: [f64; 2], along: [f64; 2]) {
    let ([x, y], [a, b], [c, d]) = (corner, across, along);
    let _ = writeln!(
        text,
        "- {{type: quad, position: [{x}, {y}, 0], side: [{a}, {b}, 0], up: [{c}, {d}, 0], {WHITE}}}"
    );
}

/// A material that is white from all sides.
const WHITE: &str = "material: {color: [1, 1, 1], ka: 1, kd: 0, ks: 0, n: 1}";

/// In each column of pixels a quad of the same width, so far from the left edge.
pub(crate) fn grid(side: u32, width: f64, offset: f64) -> Pattern {
    let (mut text, half) = (String::new(), f64::from(side) / 2.0);
    for column in 0..side {
        let corner = [f64::from(column) - half + offset, -half - 1.0];
        let along = [0.0, 2.0 * half + 2.0];
        quad(&mut text, corner, [width, 0.0], along);
    }
    Pattern::new(side, &text, |_, _| width)
}

/// White discs of a radius, each somewhere within a pixel, in a fraction of the pixels.
pub(crate) fn grains(side: u32, radius: f64, share: f64) -> Pattern {
    let mut rng = SplitMix64::new(7);
    let mut uniform = || rng.below(1 << 20) as f64 / f64::from(1 << 20);
    let (mut text, half) = (String::new(), f64::from(side) / 2.0);
    let mut has = Vec::new();
    for index in 0..side * side {
        let [u, v] = [uniform(), uniform()].map(|place| radius + (1.0 - 2.0 * radius) * place);
        has.push(uniform() < share);
        if has.last() == Some(&true) {
            let (x, y) = (f64::from(index % side), f64::from(index / side));
            let _ = writeln!(
                text,
                "- {{type: disc, position: [{}, {}, 0], normal: [0, 0, 1], radius: {radius}, \
                 {WHITE}}}",
                x + u - half,
                half - y - v
            );
        }
    }
    let area = std::f64::consts::PI * radius * radius;
    let white = |x: u32, y: u32| has[(y * side + x) as usize];
    Pattern::new(side, &text, |x, y| if white(x, y) { area } else { 0.0 })
}
