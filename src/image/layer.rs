//! Layers as pictures for people: display colours, directions and positions as colours, distances
//! from white to black, surfaces in distinct colours.

use super::{Image, Picture};
use rtc_color::srgb_encoded;

/// Distances from so far on are those of no surface.
const FAR: f32 = 1e10;

/// A layer as a picture. Errors and numbers of samples are shown from 0 to the greatest of them.
#[derive(Clone, Debug, PartialEq)]
pub struct LayerPicture {
    /// The displayed value, in [0, 1].
    pub image: Image,
    /// Whether it shows colours; else numbers as colours.
    pub is_color: bool,
    /// The values shown as 0 and 1, for distances, positions, errors and numbers of samples: the
    /// minimum and the maximum of each channel.
    pub ranges: Vec<[f32; 2]>,
}

impl Picture {
    /// A layer as a picture, by the names of its channels; none if it is not there.
    #[must_use]
    pub fn layer_picture(&self, channels: &[&str]) -> Option<LayerPicture> {
        let width = self.layers.names.len();
        let first = channels.first()?;
        let start = self.layers.names.iter().position(|name| name == first)?;
        let kind = first.split('.').next()?;
        let pixels = self.layers.values.chunks_exact(width);
        let values = pixels.map(|pixel| &pixel[start..start + channels.len()]);
        let ranges = match kind {
            "depth" | "position" => ranges(values.clone(), channels.len()),
            "error" | "samples" => vec![[0.0, greatest(values.clone())]; channels.len()],
            _ => Vec::new(),
        };
        Some(LayerPicture {
            image: Image {
                width: self.image.width,
                height: self.image.height,
                pixels: values.map(|values| shown(kind, values, &ranges)).collect(),
            },
            is_color: kind == "albedo",
            ranges,
        })
    }
}

/// The minimum and the maximum of each channel where a surface is hit, for positions without the
/// outermost fiftieth on either side, since a ground may be wide; [0, 0] if there is none.
fn ranges<'v>(pixels: impl Iterator<Item = &'v [f32]>, channels: usize) -> Vec<[f32; 2]> {
    let surfaces: Vec<_> = pixels.filter(|values| is_surface(values)).collect();
    let range = |channel: usize| {
        let mut values: Vec<f32> = surfaces.iter().map(|values| values[channel]).collect();
        values.sort_unstable_by(f32::total_cmp);
        let out = if channels > 1 { values.len() / 50 } else { 0 };
        let least = values.get(out).copied();
        least.zip(values.iter().rev().nth(out).copied())
    };
    let ranges = (0..channels).map(range);
    ranges
        .map(|range| range.map_or([0.0; 2], <[f32; 2]>::from))
        .collect()
}

/// The greatest finite value of all channels; 0 without one.
fn greatest<'v>(pixels: impl Iterator<Item = &'v [f32]>) -> f32 {
    let values = pixels.flatten().copied();
    values.filter(|value| value.is_finite()).fold(0.0, f32::max)
}

/// Whether these are values of a surface: a finite distance, or a position other than that of a
/// miss.
fn is_surface(values: &[f32]) -> bool {
    let is_finite = values.iter().all(|value| value.is_finite());
    is_finite && values[0].abs() < FAR && (values.len() == 1 || values.iter().any(|v| *v != 0.0))
}

/// The colour of some values of a kind of layer.
fn shown(kind: &str, values: &[f32], ranges: &[[f32; 2]]) -> [f64; 3] {
    let value = |at: usize| values.get(at).map_or(0.0, |value| f64::from(*value));
    let within = |at: usize| {
        let [least, most] = ranges[at].map(f64::from);
        let span = if most > least { most - least } else { 1.0 };
        ((value(at) - least) / span).clamp(0.0, 1.0)
    };
    let all = [0, 1, 2];
    match kind {
        "albedo" => all.map(|at| srgb_encoded(value(at).clamp(0.0, 1.0))),
        "normal" => all.map(|at| 0.5 * value(at) + 0.5),
        "error" => all.map(within),
        "samples" => [within(0); 3],
        "unmet" => [value(0).clamp(0.0, 1.0); 3],
        "uv" => all.map(|at| value(at) - value(at).floor()),
        "position" if is_surface(values) => all.map(within),
        "depth" if is_surface(values) => [nearness(value(0), ranges[0].map(f64::from)); 3],
        "instance" => own_color(value(0)),
        _ => [0.0; 3],
    }
}

/// How near a distance is: 1 the nearest, 0.1 the farthest, between by the reciprocal, as a ground
/// may reach the horizon; where distances are not all in front of the eye, in proportion.
fn nearness(distance: f64, [near, far]: [f64; 2]) -> f64 {
    let scale = |d: f64| if near > 0.0 { 1.0 / d } else { -d };
    let span = scale(near) - scale(far);
    let nearness = if span > 0.0 {
        (scale(distance) - scale(far)) / span
    } else {
        1.0
    };
    0.1 + 0.9 * nearness
}

/// A colour for a surface by its number: hues a golden angle apart, so that neighbours differ;
/// black for a miss.
fn own_color(number: f64) -> [f64; 3] {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    if number < 1.0 {
        return [0.0; 3];
    }
    let hue = 6.0 * (number * GOLDEN - (number * GOLDEN).floor());
    // The distance on the circle of hues from red, green and blue (HSV, value and saturation 1).
    [0.0, 2.0, 4.0].map(|pure: f64| {
        let difference = (hue - pure).abs();
        (2.0 - difference.min(6.0 - difference)).clamp(0.15, 1.0)
    })
}

#[cfg(test)]
mod tests {
    use super::super::PixelLayers;
    use super::*;

    fn with(names: &[&'static str], values: &[f32]) -> Picture {
        let width = u32::try_from(values.len() / names.len()).unwrap();
        Picture {
            image: Image {
                width,
                height: 1,
                pixels: vec![[0.0; 3]; width as usize],
            },
            alpha: None,
            layers: PixelLayers {
                names: names.to_vec(),
                values: values.to_vec(),
            },
            tiles: Vec::new(),
        }
    }

    #[test]
    fn near_is_white_far_is_dark_and_nothing_is_black() {
        let picture = with(
            &["uv.U", "uv.V", "depth.Z"],
            &[0.0, 0.0, 2.0, 0.0, 0.0, 6.0, 0.0, 0.0, 1e10, 0.0, 0.0, 4.0],
        );
        let layer = picture.layer_picture(&["depth.Z"]).unwrap();
        let greys: Vec<f64> = layer.image.pixels.iter().map(|pixel| pixel[1]).collect();
        assert_eq!(greys, [1.0, 0.1, 0.0, 0.1 + 0.9 * 0.25]);
        assert_eq!((layer.ranges, layer.is_color), (vec![[2.0, 6.0]], false));
        assert!(picture.layer_picture(&["normal.X"]).is_none());
    }

    #[test]
    fn directions_colours_and_coordinates_have_their_usual_codes() {
        let of = |names: &[&'static str], values: &[f32]| {
            with(names, values)
                .layer_picture(names)
                .unwrap()
                .image
                .pixels[0]
        };
        let normal = ["normal.X", "normal.Y", "normal.Z"];
        assert_eq!(of(&normal, &[1.0, 0.0, -1.0]), [1.0, 0.5, 0.0]);
        assert_eq!(of(&["uv.U", "uv.V"], &[2.25, -0.25]), [0.25, 0.75, 0.0]);
        let albedo = of(&["albedo.R", "albedo.G", "albedo.B"], &[0.0, 0.5, 2.0]);
        assert_eq!((albedo[0], albedo[2]), (0.0, 1.0));
        assert!((albedo[1] - 0.735).abs() < 0.001);
    }

    #[test]
    fn surfaces_beside_each_other_have_colours_that_differ() {
        let numbers: Vec<f32> = (0..40_u8).map(f32::from).collect();
        let layer = with(&["instance.X"], &numbers).layer_picture(&["instance.X"]);
        let colors = layer.unwrap().image.pixels;
        assert_eq!(colors[0], [0.0; 3]);
        let difference =
            |a: [f64; 3], b: [f64; 3]| (0..3).map(|k| (a[k] - b[k]).abs()).sum::<f64>();
        assert!(
            colors
                .windows(2)
                .all(|pair| difference(pair[0], pair[1]) > 0.3)
        );
    }
}
