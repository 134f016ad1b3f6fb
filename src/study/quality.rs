//! The quality of each pixel of a picture that grew towards a goal, and its layers.

use rtc_image::PixelLayers;
use rtc_render::Aov;

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
