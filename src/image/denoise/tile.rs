//! The models of all pixels, tile by tile.

use super::GUIDES;
use super::planes::ValuePlanes;
use super::solve::{LANES, Lane, NormalEquations};
use rayon::prelude::*;
use std::array::from_fn;

/// Pixels on each side of a pixel that its model is fitted to.
const REACH: usize = 3;
/// The pixels that a model is fitted to.
const FITTED: usize = (2 * REACH + 1) * (2 * REACH + 1);
/// The pixels of a tile.
const WIDTH: usize = 32;
const HEIGHT: usize = 8;
/// How fast weights fall with the square of the distance of guides.
const GUIDE_FALL: f32 = 2.0;
/// The ridge on the slopes of a model.
const RIDGE: f32 = 1e-2;
/// The least variance of a colour that is compared.
const LEAST_VARIANCE: f32 = 1e-5;

/// The weights of pixels around those of a tile.
type TileWeights = [[f32; WIDTH * HEIGHT]; FITTED];

/// The values of the models of each half, of all pixels; not finite where there is none.
pub(super) fn models(planes: &ValuePlanes) -> [Vec<[f32; 3]>; 2] {
    let [width, height] = planes.size;
    let [across, down] = [width.div_ceil(WIDTH), height.div_ceil(HEIGHT)];
    let tiles = (0..across * down).into_par_iter().map(|tile| {
        let corner = [tile % across * WIDTH, tile / across * HEIGHT];
        [[0, 1], [1, 0]].map(|[fitted, weighing]| model(planes, corner, fitted, weighing))
    });
    let tiles: Vec<_> = tiles.collect();
    [0, 1].map(|half| {
        let value = |index: usize| {
            let (x, y) = (index % width, index / width);
            let tile = &tiles[y / HEIGHT * across + x / WIDTH][half];
            tile[y % HEIGHT * WIDTH + x % WIDTH]
        };
        (0..width * height).map(value).collect()
    })
}

/// The values of the models of one half in a tile, weighed by the other.
fn model(
    planes: &ValuePlanes,
    corner: [usize; 2],
    fitted: usize,
    weighing: usize,
) -> Vec<[f32; 3]> {
    let weights = weights(planes, corner, weighing);
    let half = &planes.halves[fitted];
    let mut values = vec![[f32::NAN; 3]; WIDTH * HEIGHT];
    for first in (0..WIDTH * HEIGHT).step_by(LANES) {
        let [x, y] = [corner[0] + first % WIDTH, corner[1] + first / WIDTH];
        if x >= planes.size[0] || y >= planes.size[1] {
            continue;
        }
        let here = planes.at([x, y]);
        let exact: [Lane; GUIDES] = from_fn(|k| lane(&planes.exact[k], here));
        let mut terms = NormalEquations::default();
        for (near, weights) in weights.iter().enumerate() {
            let there = beside(planes, here, near);
            let place = from_fn(|k| {
                let guide = lane(&half.guides[k], there);
                from_fn(|l| guide[l] - exact[k][l])
            });
            let value = from_fn(|c| lane(&half.color[c], there));
            terms.add(&lane(weights, first), &place, &value);
        }
        let solved = terms.solve(RIDGE);
        for l in 0..LANES {
            // Radiance is not negative.
            values[first + l] = from_fn(|c| {
                if solved[c][l] < 0.0 {
                    0.0
                } else {
                    solved[c][l]
                }
            });
        }
    }
    values
}

/// The numbers of some pixels.
#[inline(always)]
fn lane(numbers: &[f32], first: usize) -> Lane {
    let numbers = &numbers[first..first + LANES];
    from_fn(|l| numbers[l])
}

/// The place of the k-th pixel around one.
#[inline]
fn beside(planes: &ValuePlanes, place: usize, k: usize) -> usize {
    let (x, y) = (k % (2 * REACH + 1), k / (2 * REACH + 1));
    place + y * planes.stride + x - REACH * planes.stride - REACH
}

/// How much the pixels around those of a tile count, by their guides and one half of the samples.
fn weights(planes: &ValuePlanes, corner: [usize; 2], weighing: usize) -> Box<TileWeights> {
    let mut weights = vec![[0.0; WIDTH * HEIGHT]; FITTED];
    let corner = planes.at(corner);
    for (k, weights) in weights.iter_mut().enumerate() {
        let distances = distances(planes, corner, k, weighing);
        for y in 0..HEIGHT {
            let here = corner + y * planes.stride;
            let there = beside(planes, here, k);
            let mut guide = [0.0; WIDTH];
            for plane in &planes.exact {
                let (here, there) = (&plane[here..here + WIDTH], &plane[there..there + WIDTH]);
                for x in 0..WIDTH {
                    guide[x] += (here[x] - there[x]) * (here[x] - there[x]);
                }
            }
            let inside = &planes.inside[there..there + WIDTH];
            for x in 0..WIDTH {
                let color = (0..3).map(|row| {
                    let row = &distances[(y + row) * SPAN + x..][..3];
                    row[0] + row[1] + row[2]
                });
                let color = color.sum::<f32>() / 27.0;
                let distance = guide[x] * GUIDE_FALL + color.max(0.0);
                weights[y * WIDTH + x] = fall(distance) * inside[x];
            }
        }
    }
    weights.into_boxed_slice().try_into().expect("as many")
}

/// The numbers of a row of distances: a pixel more on each side.
const SPAN: usize = WIDTH + 2;

/// The distance of the colours of pixels from those beside them, beyond what their noise explains
/// (Rousselle et al., "Adaptive rendering with non-local means filtering", 2012, equation 4): the
/// sums over the channels.
fn distances(
    planes: &ValuePlanes,
    corner: usize,
    k: usize,
    weighing: usize,
) -> [f32; SPAN * (HEIGHT + 2)] {
    let mut sums = [0.0; SPAN * (HEIGHT + 2)];
    for y in 0..HEIGHT + 2 {
        let here = corner + y * planes.stride - planes.stride - 1;
        let there = beside(planes, here, k);
        let sums = &mut sums[y * SPAN..][..SPAN];
        for c in 0..3 {
            let rows = |plane: &'_ [f32]| -> [[f32; SPAN]; 2] {
                [here, there].map(|at| plane[at..at + SPAN].try_into().expect("as many"))
            };
            let [p, q] = rows(&planes.halves[weighing].shown[c]);
            let [v, w] = rows(&planes.variance[c]);
            let [inside, other] = rows(&planes.inside);
            for x in 0..SPAN {
                let difference = p[x] - q[x];
                let beyond = difference * difference - v[x] - v[x].min(w[x]);
                sums[x] += inside[x] * other[x] * beyond / (LEAST_VARIANCE + v[x] + w[x]);
            }
        }
    }
    sums
}

/// About e to the power of −x, and 0 from 8 on.
#[inline(always)]
fn fall(x: f32) -> f32 {
    let fraction = (1.0 - x * 0.125).max(0.0);
    let square = fraction * fraction;
    let fourth = square * square;
    fourth * fourth
}
