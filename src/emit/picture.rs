//! Textures as picture files for renderers that know bitmaps only: factors are multiplied in,
//! channels picked, patterns drawn.

use super::texture_area::TextureAreas;
use rtc_color::{nearest8, srgb_decoded, srgb_encoded};
use rtc_image::{EncodeError, FileFormat, Image as Radiances, Picture, png_bytes};
use rtc_ir::{self as ir, Filter, Pixels, Sampled, Scene, TextureId, Wrap};
use rtc_math::{TextureMapping, TexturePattern, Vec3};

/// The least and the greatest side in pixels of the picture of a pattern that has no period, and
/// the pixels across one of its cells in between.
const PATTERN_SIDES: [f64; 2] = [512.0, 2048.0];
const CELL: f64 = 64.0;
/// The side in pixels of the picture of the colours (u, 0, v).
const UV_SIDE: u32 = 256;

/// The unit square of texture coordinates, by its corner and its size.
const UNIT: [[f64; 2]; 2] = [[0.0; 2], [1.0; 2]];
/// The rows of the map that changes no coordinates.
pub(super) const IDENTITY: [[f64; 3]; 2] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

/// How the values of a picture are coded.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum ColorCoding {
    /// Colours; bytes are encoded with sRGB.
    Srgb,
    /// Numbers, without an encoding.
    Linear,
}

impl ColorCoding {
    /// A linear value as a byte; what exceeds 1 becomes 1.
    pub(super) fn byte(self, value: f64) -> u8 {
        match self {
            Self::Srgb => nearest8(srgb_encoded(value)),
            Self::Linear => nearest8(value),
        }
    }
}

/// A texture of which a picture is made.
pub(super) struct TexturePicture<'s> {
    source: TextureValueSource<'s>,
    pub(super) size: [u32; 2],
    pub(super) wrap: [Wrap; 2],
    pub(super) filter: Filter,
    /// Whether v grows upwards.
    is_upward: bool,
    /// The least coordinates of the texture that it shows, and its size in them.
    area: [[f64; 2]; 2],
}

enum TextureValueSource<'s> {
    Image(&'s ir::Image),
    Pattern(&'s ir::Procedural),
    Uv,
}

impl<'s> TexturePicture<'s> {
    pub(super) fn new(scene: &'s Scene, areas: &TextureAreas, texture: TextureId) -> Self {
        let image = |id: ir::ImageId| &scene.images[id.0 as usize];
        let of_image = |image: &'s ir::Image, wrap, filter, is_upward| Self {
            source: TextureValueSource::Image(image),
            size: [image.width, image.height],
            wrap,
            filter,
            is_upward,
            area: UNIT,
        };
        match &scene.textures[texture.0 as usize] {
            ir::Texture::Uv => Self {
                source: TextureValueSource::Uv,
                size: [UV_SIDE; 2],
                wrap: [Wrap::Clamp; 2],
                filter: Filter::Linear,
                is_upward: true,
                area: UNIT,
            },
            ir::Texture::Image(id) => of_image(image(*id), [Wrap::Repeat; 2], Filter::Linear, true),
            ir::Texture::Sampled(Sampled {
                image: id,
                wrap,
                filter,
            }) => of_image(image(*id), *wrap, *filter, false),
            ir::Texture::Procedural(pattern) => Self::of_pattern(pattern, areas, texture),
        }
    }

    /// One period of a pattern, with a pixel for each cell; all that is seen of one without a
    /// period; the mean of one in space.
    fn of_pattern(pattern: &'s ir::Procedural, areas: &TextureAreas, texture: TextureId) -> Self {
        let periodic = |size| Self {
            source: TextureValueSource::Pattern(pattern),
            size,
            wrap: [Wrap::Repeat; 2],
            filter: Filter::Nearest,
            is_upward: true,
            area: [[0.0; 2], [2.0 / pattern.scale; 2]],
        };
        match (pattern.mapping, pattern.pattern) {
            (TextureMapping::World, _) => periodic([1, 1]),
            (TextureMapping::Uv, TexturePattern::Checker) => periodic([2, 2]),
            (TextureMapping::Uv, TexturePattern::Stripes) => periodic([2, 1]),
            (TextureMapping::Uv, TexturePattern::Noise(_) | TexturePattern::Worley { .. }) => {
                let area = areas.of_texture(texture);
                Self {
                    size: area[1].map(|side| pattern_side(side * pattern.scale)),
                    wrap: [Wrap::Clamp; 2],
                    filter: Filter::Linear,
                    area,
                    ..periodic([1, 1])
                }
            }
        }
    }

    /// What the picture lacks of its texture.
    pub(super) fn loss(&self) -> Option<&'static str> {
        match self.source {
            TextureValueSource::Pattern(pattern) if pattern.mapping == TextureMapping::World => {
                Some("a pattern in space becomes the mean of its colours")
            }
            TextureValueSource::Pattern(_) if self.filter == Filter::Linear => {
                Some("a pattern becomes a picture of it")
            }
            TextureValueSource::Uv => Some("the colours (u, 0, v) become a picture of them"),
            TextureValueSource::Pattern(_) | TextureValueSource::Image(_) => None,
        }
    }

    /// The name of its file, if it has one.
    pub(super) fn name(&self) -> &'s str {
        match self.source {
            TextureValueSource::Image(image) => &image.name,
            TextureValueSource::Pattern(_) | TextureValueSource::Uv => "",
        }
    }

    /// Bytes of memory that its picture takes.
    pub(super) fn cost(&self) -> u64 {
        let is_float =
            matches!(self.source, TextureValueSource::Image(image) if image.kind == Pixels::Rgb32f);
        let each = if is_float { 40 } else { 4 };
        u64::from(self.size[0]) * u64::from(self.size[1]) * each
    }

    /// The rows of the map to the coordinates of the picture, v downwards, from those of the
    /// surface.
    pub(super) fn rows(&self, map: &ir::Map) -> [[f64; 3]; 2] {
        let rows = map.texture_from_surface.unwrap_or(IDENTITY);
        let [least, size] = self.area;
        let [u, [a, b, c]] = [0, 1].map(|axis| {
            let [a, b, c] = rows[axis];
            [a, b, c - least[axis]].map(|number| number / size[axis])
        });
        match self.is_upward {
            true => [u, [-a, -b, 1.0 - c]],
            false => [u, [a, b, c]],
        }
    }

    /// The picture of its texels changed by a function: red, green, blue, alpha of a texel, linear
    /// by `coding`, to the colour in the picture. A PNG, or an EXR where a value exceeds 1; the
    /// bytes and the extension.
    pub(super) fn encode(
        &self,
        coding: ColorCoding,
        change: impl Fn([f64; 4]) -> [f64; 3],
    ) -> Result<(Vec<u8>, &'static str), EncodeError> {
        let [width, height] = self.size;
        let pixels = || {
            let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
            places.map(|(x, y)| change(self.texel(x, y, coding)))
        };
        if pixels().flatten().all(|value| value <= 1.0) {
            let bytes: Vec<u8> = pixels().flatten().map(|value| coding.byte(value)).collect();
            return Ok((png_bytes(self.size, false, &bytes), "png"));
        }
        let picture = Picture::opaque(Radiances {
            width,
            height,
            pixels: pixels().collect(),
        });
        Ok((picture.encode(FileFormat::Exr)?, "exr"))
    }

    /// The PNG of its colours, and whether some are brighter than white, which they become.
    pub(super) fn png(&self, coding: ColorCoding) -> (Vec<u8>, bool) {
        let [width, height] = self.size;
        let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        let mut is_clipped = false;
        let bytes = places.flat_map(|(x, y)| {
            let [r, g, b, _] = self.texel(x, y, coding);
            is_clipped |= r.max(g).max(b) > 1.0;
            [r, g, b].map(|value| coding.byte(value))
        });
        let bytes: Vec<u8> = bytes.collect();
        (png_bytes(self.size, false, &bytes), is_clipped)
    }

    /// The PNG of its texels changed by a function to colours with an opacity, coded as sRGB: a
    /// texel
    /// as a colour, and as numbers.
    pub(super) fn png_with_alpha(
        &self,
        change: impl Fn([f64; 4], [f64; 4]) -> [f64; 4],
    ) -> Vec<u8> {
        let [width, height] = self.size;
        let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        let bytes = places.flat_map(|(x, y)| {
            let [color, raw] =
                [ColorCoding::Srgb, ColorCoding::Linear].map(|coding| self.texel(x, y, coding));
            let [r, g, b, alpha] = change(color, raw);
            let [r, g, b] = [r, g, b].map(|value| ColorCoding::Srgb.byte(value));
            [r, g, b, ColorCoding::Linear.byte(alpha)]
        });
        let bytes: Vec<u8> = bytes.collect();
        png_bytes(self.size, true, &bytes)
    }

    /// The mean colour, linear by `coding`.
    pub(super) fn mean(&self, coding: ColorCoding) -> [f64; 3] {
        let [width, height] = self.size;
        let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        let colors = places.map(|(x, y)| {
            let [r, g, b, _] = self.texel(x, y, coding);
            Vec3::new(r, g, b)
        });
        let sum: Vec3 = colors.sum();
        (sum / (f64::from(width) * f64::from(height))).to_array()
    }

    /// A texel, counted from the top left.
    fn texel(&self, x: u32, y: u32, coding: ColorCoding) -> [f64; 4] {
        let [least, size] = self.area;
        let [u, v] = [
            (f64::from(x) + 0.5) / f64::from(self.size[0]),
            1.0 - (f64::from(y) + 0.5) / f64::from(self.size[1]),
        ];
        let [u, v] = [least[0] + size[0] * u, least[1] + size[1] * v];
        match self.source {
            TextureValueSource::Uv => [u, 0.0, v, 1.0],
            TextureValueSource::Pattern(pattern) => {
                let color = pattern.solid().map_or(Vec3::ZERO, |solid| {
                    match pattern.mapping == TextureMapping::World {
                        true => solid.mean(),
                        false => solid.color(Vec3::new(u, v, 0.0)),
                    }
                });
                color.extend(1.0).to_array()
            }
            TextureValueSource::Image(image) => {
                let index = y as usize * image.width as usize + x as usize;
                stored(image, index, coding)
            }
        }
    }
}

/// The pixels of a picture across this many cells of a pattern.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "brought into a range of positive numbers"
)]
fn pattern_side(cells: f64) -> u32 {
    let [least, greatest] = PATTERN_SIDES;
    (CELL * cells).clamp(least, greatest) as u32
}

/// A pixel of an image.
fn stored(image: &ir::Image, index: usize, coding: ColorCoding) -> [f64; 4] {
    let size = image.kind.bytes();
    let bytes = &image.pixels[index * size..][..size];
    let color = |byte: u8| match coding {
        ColorCoding::Srgb => srgb_decoded(f64::from(byte) / 255.0),
        ColorCoding::Linear => f64::from(byte) / 255.0,
    };
    match image.kind {
        Pixels::Rgb8 => [color(bytes[0]), color(bytes[1]), color(bytes[2]), 1.0],
        Pixels::Rgba8 => {
            let alpha = f64::from(bytes[3]) / 255.0;
            [color(bytes[0]), color(bytes[1]), color(bytes[2]), alpha]
        }
        Pixels::Rgb32f => {
            let [r, g, b] = floats(bytes);
            [r, g, b, 1.0]
        }
    }
}

/// Three little-endian floats.
fn floats(bytes: &[u8]) -> [f64; 3] {
    let parts = bytes.as_chunks::<4>().0;
    [0, 1, 2].map(|channel| f64::from(f32::from_le_bytes(parts[channel])))
}

/// The value of an environment map, linear between its pixels: v downwards, both in [0, 1]; the
/// left edge continues at the right one.
pub(super) fn environment_at(image: &ir::Image, [u, v]: [f64; 2]) -> Vec3 {
    let [width, height] = [image.width, image.height].map(f64::from);
    let (x, y) = (u * width - 0.5, v * height - 0.5);
    let (left, top) = (x.floor(), y.floor().clamp(0.0, height - 1.0));
    let (dx, dy) = (x - left, (y - top).clamp(0.0, 1.0));
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "texels within the image"
    )]
    let at = |column: f64, row: f64| {
        let column = column.rem_euclid(width) as usize;
        let row = row.min(height - 1.0) as usize;
        let [r, g, b, _] = stored(
            image,
            row * image.width as usize + column,
            ColorCoding::Srgb,
        );
        Vec3::new(r, g, b)
    };
    let row = |row: f64| at(left, row) * (1.0 - dx) + at(left + 1.0, row) * dx;
    row(top) * (1.0 - dy) + row(top + 1.0) * dy
}

/// The rows below which an environment map is written with twice as many.
const FEW_ROWS: u32 = 512;

/// An environment map, times a factor, for renderers whose first and last row are the poles
/// themselves: a row at every half, so that what is linear between the rows stays as it is. Maps of
/// many rows are written as they are.
pub(super) fn environment(image: &ir::Image, factor: [f64; 3]) -> Result<Vec<u8>, EncodeError> {
    let [width, height] = [image.width, image.height];
    let at = |x: u32, y: u32| {
        let row = y as usize * width as usize;
        let [r, g, b, _] = stored(image, row + x as usize, ColorCoding::Srgb);
        Vec3::new(r, g, b) * Vec3::from_array(factor)
    };
    let rows = if height < FEW_ROWS {
        2 * height + 1
    } else {
        height
    };
    let pixel = |x: u32, y: u32| match rows == height {
        true => at(x, y),
        false => (at(x, y.saturating_sub(1) / 2) + at(x, (y / 2).min(height - 1))) / 2.0,
    };
    let places = (0..rows).flat_map(|y| (0..width).map(move |x| (x, y)));
    let picture = Picture::opaque(Radiances {
        width,
        height: rows,
        pixels: places.map(|(x, y)| pixel(x, y).to_array()).collect(),
    });
    picture.encode(FileFormat::Exr)
}
