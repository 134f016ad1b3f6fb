//! The display transform: it turns a film of linear values into a picture by exposure, tone map and
//! background.

use super::{Image, Picture, PixelLayers};
use rtc_color::Tone;
use serde::{Deserialize, Serialize};

/// The background.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub enum BackgroundFill {
    /// The background of the film.
    #[default]
    Film,
    /// Nothing.
    Transparent,
    /// A colour, in the values that the file is to hold.
    Color([f64; 3]),
}

/// The association of colours and opacity in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AlphaAssociation {
    /// Colours are not multiplied by the opacity, as in PNG.
    Straight,
    /// Colours are multiplied by the opacity, as in EXR.
    Associated,
}

/// The conversion of a film into a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DisplayTransform {
    /// The exposure in stops: values are multiplied by two to this power, at most 2^±64.
    pub stops: f64,
    /// The tone map.
    pub tone: Tone,
    /// The background. Except for [`BackgroundFill::Film`], the film must be rendered without a
    /// background.
    pub background: BackgroundFill,
}

/// What values are multiplied by at an exposure in stops, at most 2^±64.
#[must_use]
pub fn exposure(stops: f64) -> f64 {
    libm::exp2(stops.clamp(-64.0, 64.0))
}

impl DisplayTransform {
    /// The picture of a film, with the coverage of its pixels.
    #[must_use]
    pub fn develop(
        &self,
        mut film: Image,
        coverage: Vec<f32>,
        association: AlphaAssociation,
    ) -> Picture {
        let exposure = exposure(self.stops);
        for (pixel, alpha) in film.pixels.iter_mut().zip(&coverage) {
            let alpha = f64::from(*alpha);
            let weight = if self.background == BackgroundFill::Film {
                1.0
            } else {
                alpha
            };
            // What covers the pixel in part is toned as if it covered it whole.
            let scale = if weight > 0.0 { exposure / weight } else { 0.0 };
            let shown = self.tone.display(pixel.map(|v| v * scale));
            *pixel = match (self.background, association) {
                (BackgroundFill::Film, _)
                | (BackgroundFill::Transparent, AlphaAssociation::Straight) => shown,
                (BackgroundFill::Transparent, AlphaAssociation::Associated) => {
                    shown.map(|v| v * alpha)
                }
                (BackgroundFill::Color(color), _) => {
                    [0, 1, 2].map(|k| shown[k] * alpha + color[k] * (1.0 - alpha))
                }
            };
        }
        let alpha = (self.background == BackgroundFill::Transparent).then_some(coverage);
        Picture {
            image: film,
            alpha,
            layers: PixelLayers::default(),
            tiles: Vec::new(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Pixels covered not at all, to a quarter, and wholly, by radiance 0.5 of red and 2 of blue.
    fn film() -> (Image, Vec<f32>) {
        let coverage = vec![0.0, 0.25, 1.0];
        let pixels = coverage
            .iter()
            .map(|alpha| [0.5, 0.0, 2.0].map(|v| v * f64::from(*alpha)))
            .collect();
        (
            Image {
                width: 3,
                height: 1,
                pixels,
            },
            coverage,
        )
    }

    fn develop(
        stops: f64,
        tone: Tone,
        background: BackgroundFill,
        association: AlphaAssociation,
    ) -> Picture {
        let (image, coverage) = film();
        DisplayTransform {
            stops,
            tone,
            background,
        }
        .develop(image, coverage, association)
    }

    #[test]
    fn without_a_look_a_film_is_its_picture() {
        let picture = develop(
            0.0,
            Tone::None,
            BackgroundFill::Film,
            AlphaAssociation::Straight,
        );
        assert_eq!((picture.image, picture.alpha), (film().0, None));
    }

    #[test]
    fn a_stop_is_a_factor_of_two_before_the_tone_map() {
        let picture = develop(
            -1.0,
            Tone::Srgb,
            BackgroundFill::Film,
            AlphaAssociation::Straight,
        );
        assert_eq!(
            picture.image.pixels[2],
            Tone::Srgb.display([0.25, 0.0, 1.0])
        );
    }

    #[test]
    fn straight_colours_do_not_fade_with_their_opacity_and_associated_ones_do() {
        let straight = develop(
            1.0,
            Tone::Agx,
            BackgroundFill::Transparent,
            AlphaAssociation::Straight,
        );
        let whole = Tone::Agx.display([1.0, 0.0, 4.0]);
        assert_eq!(straight.image.pixels[1..], [whole; 2]);
        assert_eq!(straight.alpha, Some(film().1));
        let linear = develop(
            1.0,
            Tone::None,
            BackgroundFill::Transparent,
            AlphaAssociation::Associated,
        );
        assert_eq!(
            linear.image.pixels,
            [[0.0; 3], [0.25, 0.0, 1.0], [1.0, 0.0, 4.0]]
        );
    }

    #[test]
    fn a_colour_behind_is_what_a_page_of_that_colour_shows_through() {
        let color = [0.25, 0.5, 1.0];
        let picture = develop(
            0.0,
            Tone::Srgb,
            BackgroundFill::Color(color),
            AlphaAssociation::Straight,
        );
        let whole = Tone::Srgb.display([0.5, 0.0, 2.0]);
        let mixed = [0, 1, 2].map(|k| 0.25 * whole[k] + 0.75 * color[k]);
        assert_eq!(
            (picture.image.pixels, picture.alpha),
            (vec![color, mixed, whole], None)
        );
    }
}
