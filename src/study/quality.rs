//! The quality of each pixel of a picture, and its layers.

use super::target::RenderRequest;
use rtc_image::PixelLayers;
use rtc_render::{AnyWorld, Aov, MeanOfSamples, PartialFilm};

/// The statistics of a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PixelQuality {
    /// The standard error of each channel, of display values, for a white of 1.
    pub error: [f32; 3],
    /// The number of samples, those of the pilot included.
    pub samples: u64,
    /// A bound, in multiples of white, on the light that no sample may have hit, with a probability
    /// of 95 %; 1 where there is no bound.
    pub undersampled: f32,
}

impl PixelQuality {
    /// The values of the channels of a layer; `None` for layers of first hits.
    #[expect(clippy::cast_precision_loss, reason = "rounds to the nearest float")]
    fn values(&self, aov: Aov) -> Vec<f32> {
        match aov {
            Aov::Error => self.error.to_vec(),
            Aov::Samples => vec![self.samples as f32],
            Aov::Undersampled => vec![self.undersampled],
            Aov::Albedo | Aov::Normal | Aov::Depth | Aov::Uv | Aov::Instance | Aov::Position => {
                Vec::new()
            }
        }
    }
}

/// The quality of the pixels of a path-traced picture, row by row: the one film has some of the
/// samples of its tiles, the other the rest. Pixels of other tiles have no samples, and no bound.
///
/// The standard error of a mean of n₁ + n₂ samples is estimated from the difference d of the
/// displayed means of n₁ and n₂ of them: |d| √(n₁n₂) / (n₁ + n₂), which is |d|/2 for halves.
#[must_use]
#[expect(
    clippy::cast_possible_truncation,
    reason = "rounds to the nearest float"
)]
pub fn quality_of_halves(
    world: &AnyWorld,
    order: &RenderRequest,
    halves: [&PartialFilm; 2],
) -> Vec<PixelQuality> {
    let undersampled = order.undersampled(world);
    let (tone, exposure) = order.display;
    let of = |[a, b]: [MeanOfSamples; 2]| {
        let counts = [a.samples, b.samples].map(f64::from);
        let all = counts[0] + counts[1];
        let weight = (counts[0] * counts[1]).sqrt() / all.max(1.0);
        let [a, b] = [a, b].map(|half| tone.display(half.mean.map(|value| value * exposure)));
        let samples = all as u64;
        PixelQuality {
            error: std::array::from_fn(|c| (weight * (a[c] - b[c]).abs()) as f32),
            samples,
            undersampled: undersampled.changed(samples).min(1.0) as f32,
        }
    };
    let none = PixelQuality {
        error: [0.0; 3],
        samples: 0,
        undersampled: 1.0,
    };
    let mut quality = vec![none; order.crop.pixels()];
    for (tile, area) in halves[0].held_tiles() {
        let [first, second] = halves.map(|film| film.means_of_tile(tile));
        let mut pairs = first.into_iter().zip(second);
        for y in area.y - order.crop.y..area.y + area.height - order.crop.y {
            let start = y as usize * order.crop.width as usize + (area.x - order.crop.x) as usize;
            let row = &mut quality[start..start + area.width as usize];
            row.iter_mut()
                .zip(&mut pairs)
                .for_each(|(pixel, (a, b))| *pixel = of([a, b]));
        }
    }
    quality
}

/// Adds the requested layers of statistics to other layers of the same pixels.
#[must_use]
pub fn with_quality(layers: PixelLayers, wanted: &[Aov], quality: &[PixelQuality]) -> PixelLayers {
    let wanted = || wanted.iter().filter(|aov| aov.is_of_samples());
    let PixelLayers { mut names, values } = layers;
    if wanted().next().is_none() {
        return PixelLayers { names, values };
    }
    let width = names.len();
    names.extend(wanted().flat_map(|aov| aov.channels()));
    let mut joined = Vec::with_capacity(quality.len() * names.len());
    for (index, pixel) in quality.iter().enumerate() {
        joined.extend_from_slice(&values[index * width..][..width]);
        joined.extend(wanted().flat_map(|aov| pixel.values(*aov)));
    }
    PixelLayers {
        names,
        values: joined,
    }
}
