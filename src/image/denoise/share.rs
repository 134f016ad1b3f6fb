//! How much of what models change is kept: what brings one half of the samples nearer to the other,
//! in the mean of a neighbourhood. The noise of one half does not know that of the other, so the
//! share that this regression finds is about that of least error.

use super::Image;
use super::around;
use super::curve::compress;
use rayon::prelude::*;

/// Pixels on each side that a share is measured over; twice, so that it has no seams.
const NEAR: usize = 2;

/// Colours count as equal below this.
const LEAST: f64 = 1e-9;

/// The share of each pixel, in [0, 1]; 0 where models have no value.
pub(super) fn shares(halves: [&Image; 2], models: &[Vec<[f32; 3]>; 2]) -> Vec<f64> {
    let size = [halves[0].width as usize, halves[0].height as usize];
    // Regress the difference of the other half on what the model of each half changes.
    let products = |index: usize| {
        let [a, b] = halves.map(|image| image.pixels[index].map(compress));
        let [x, y] = [0, 1].map(|half: usize| models[half][index].map(|v| compress(v.into())));
        let (mut wanted, mut changed) = (0.0, 0.0);
        for c in 0..3 {
            let changes = [x[c] - a[c], y[c] - b[c]];
            wanted += (changes[0] - changes[1]) * (b[c] - a[c]);
            changed += changes[0] * changes[0] + changes[1] * changes[1];
        }
        let mut values = models.iter().flat_map(|model| model[index]);
        match values.all(f32::is_finite) {
            true => [wanted, changed],
            false => [0.0; 2],
        }
    };
    let pixels = 0..size[0] * size[1];
    let once: Vec<_> = pixels.clone().into_par_iter().map(products).collect();
    let sum = |products: &[[f64; 2]], index: usize| {
        around(index, size, NEAR).fold([0.0; 2], |sum, near| {
            [0, 1].map(|k: usize| sum[k] + products[near][k])
        })
    };
    let twice: Vec<_> = pixels
        .clone()
        .into_par_iter()
        .map(|index| sum(&once, index))
        .collect();
    let share = |index: usize| {
        let values = [0, 1].map(|half: usize| models[half][index]);
        let [wanted, changed] = sum(&twice, index);
        match values.iter().flatten().all(|value| value.is_finite()) {
            true => (wanted / (changed + LEAST)).clamp(0.0, 1.0),
            false => 0.0,
        }
    };
    pixels.into_par_iter().map(share).collect()
}
