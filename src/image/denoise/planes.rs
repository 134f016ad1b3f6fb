//! What the models of a picture are made of, as planes with a border, so that every pixel has all
//! neighbours. Pixels of the border count nothing.

use super::curve::compress;
use super::{DenoisingGuide, GUIDES, NoisyHalf};

/// The pixels of the border.
const BORDER: usize = 8;

/// Numbers of all pixels, several of each.
pub(super) type PixelPlanes<const N: usize> = [Vec<f32>; N];

/// One half of the samples.
pub(super) struct SampleHalf {
    pub(super) color: PixelPlanes<3>,
    /// As colours are compared.
    pub(super) shown: PixelPlanes<3>,
    pub(super) guides: PixelPlanes<GUIDES>,
}

/// The numbers of a picture, row by row.
pub(super) struct ValuePlanes {
    /// The pixels of a row and of a column, without the border.
    pub(super) size: [usize; 2],
    /// The numbers of a row.
    pub(super) stride: usize,
    pub(super) halves: [SampleHalf; 2],
    pub(super) exact: PixelPlanes<GUIDES>,
    /// The variance of the shown colours of a half.
    pub(super) variance: PixelPlanes<3>,
    /// 1 inside the picture.
    pub(super) inside: Vec<f32>,
}

impl ValuePlanes {
    pub(super) fn new(halves: [NoisyHalf<'_>; 2], exact: &[DenoisingGuide]) -> Self {
        // Pad each row so that filters read past its ends.
        let image = halves[0].image;
        let size = [image.width as usize, image.height as usize];
        let stride = (size[0] + 2 * BORDER).next_multiple_of(super::solve::LANES) + BORDER;
        let shape = PlaneShape { size, stride };
        // Copy each half into planes of colour and guides.
        let [a, b] = halves.map(|NoisyHalf { image, guides }| SampleHalf {
            color: shape.planes(|index| image.pixels[index].map(|value| value as f32)),
            shown: shape.planes(|index| image.pixels[index].map(|value| compress(value) as f32)),
            guides: shape.planes(|index| guides[index].map(|value| value as f32)),
        });
        // Half the squared difference of the halves estimates the variance of a pixel.
        let squares: PixelPlanes<3> = std::array::from_fn(|c| {
            let pairs = a.shown[c].iter().zip(&b.shown[c]);
            pairs.map(|(a, b)| (a - b) * (a - b) * 0.5).collect()
        });
        // Average it over 3 x 3 pixels inside the picture.
        let [inside] = shape.planes(|_| [1.0]);
        let variance = shape.planes(|index| {
            let near = shape.at(index);
            let sum = |plane: &[f32]| -> f32 {
                let rows = [near - stride, near, near + stride];
                rows.iter()
                    .map(|row| plane[row - 1..=row + 1].iter().sum::<f32>())
                    .sum()
            };
            let count = sum(&inside);
            std::array::from_fn(|c| sum(&squares[c]) / count)
        });
        Self {
            size,
            stride,
            halves: [a, b],
            exact: shape.planes(|index| exact[index].map(|value| value as f32)),
            variance,
            inside,
        }
    }

    /// The place of a pixel in each plane.
    pub(super) fn at(&self, [x, y]: [usize; 2]) -> usize {
        place([x, y], self.stride)
    }
}

/// The shape of planes.
#[derive(Clone, Copy)]
struct PlaneShape {
    size: [usize; 2],
    stride: usize,
}

impl PlaneShape {
    fn at(&self, index: usize) -> usize {
        place([index % self.size[0], index / self.size[0]], self.stride)
    }

    /// Planes of the numbers of each pixel.
    fn planes<const N: usize>(&self, of: impl Fn(usize) -> [f32; N]) -> PixelPlanes<N> {
        let rows = self.size[1] + 2 * BORDER + 8;
        let mut planes: PixelPlanes<N> = std::array::from_fn(|_| vec![0.0; rows * self.stride]);
        for index in 0..self.size[0] * self.size[1] {
            let at = self.at(index);
            for (plane, value) in planes.iter_mut().zip(of(index)) {
                plane[at] = value;
            }
        }
        planes
    }
}

/// The place of a pixel in planes whose rows have so many numbers.
fn place([x, y]: [usize; 2], stride: usize) -> usize {
    (y + BORDER) * stride + x + BORDER
}
