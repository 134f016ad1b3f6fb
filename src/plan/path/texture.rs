//! The values of a texture within a rectangle of texture coordinates.

use rtc_image::Texel;
use rtc_math::IdTable;
use rtc_valid::{Image, ImageId, Map, Texture, ValidScene, Wrap};
use std::cell::OnceCell;
use std::ops::Range;

/// A rectangle of texture coordinates, from minimum to maximum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct UvRect([[f64; 2]; 2]);

/// The margin in texels, for rounding and for the neighbours that filtering reads.
const MARGIN: f64 = 2.0;

/// An area with more repetitions than this counts as the whole image.
const MAX_REPEATS: f64 = 1e6;

impl UvRect {
    /// The empty area.
    pub(crate) const NONE: Self = Self([[f64::INFINITY, f64::NEG_INFINITY]; 2]);

    /// The unit square.
    pub(crate) const UNIT: Self = Self([[0.0, 1.0]; 2]);

    /// The bounding rectangle of points.
    pub(crate) fn of(points: impl Iterator<Item = [f64; 2]>) -> Self {
        points.fold(Self::NONE, |area, [u, v]| {
            area.around(Self([[u, u], [v, v]]))
        })
    }

    /// The union with another area.
    pub(crate) fn around(self, Self(other): Self) -> Self {
        let Self(area) = self;
        Self([0, 1].map(|axis| {
            let ([low, high], [other_low, other_high]) = (area[axis], other[axis]);
            [low.min(other_low), high.max(other_high)]
        }))
    }

    /// The bounds of the area after an affine map with the rows `(a, b, c)` for `a·u + b·v + c`.
    fn mapped(self, rows: &[[f64; 3]; 2]) -> Self {
        let Self([[u0, u1], [v0, v1]]) = self;
        let corners = [[u0, v0], [u1, v0], [u0, v1], [u1, v1]];
        let place = |[u, v]: [f64; 2]| rows.map(|[a, b, c]| a * u + b * v + c);
        Self::of(corners.into_iter().map(place))
    }
}

/// The values of the textures of a scene. Answers about whole images are cached, and each scan
/// stops at the first texel that decides.
pub(super) struct TextureValues<'scene> {
    scene: &'scene ValidScene,
    /// For each image, whether all texels are equal.
    constant: IdTable<Image, OnceCell<bool>>,
    /// For each image and channel, the value of all texels, if they are equal.
    values: IdTable<Image, [OnceCell<Option<f64>>; 4]>,
}

impl<'scene> TextureValues<'scene> {
    pub(super) fn new(scene: &'scene ValidScene) -> Self {
        let count = scene.images().len();
        Self {
            scene,
            constant: vec![OnceCell::new(); count].into(),
            values: vec![std::array::from_fn(|_| OnceCell::new()); count].into(),
        }
    }

    /// The scene.
    pub(super) fn scene(&self) -> &'scene ValidScene {
        self.scene
    }

    /// Whether a map is constant.
    pub(super) fn is_constant(&self, map: &Map) -> bool {
        let texture = &self.scene.textures()[map.texture];
        image_of(texture).is_some_and(|image| self.is_constant_image(image))
    }

    /// Whether all texels of an image are equal.
    pub(super) fn is_constant_image(&self, image: ImageId) -> bool {
        let is_constant = || self.scene.images()[image].texels.are_even();
        *self.constant[image].get_or_init(is_constant)
    }

    /// The value of a channel (red, green, blue, alpha) of a map on an area, if it is constant
    /// there; colours are not decoded, bytes are divided by 255. Filtering equal texels gives that
    /// value.
    pub(super) fn value(&self, map: &Map, area: UvRect, channel: usize) -> Option<f64> {
        let texture = &self.scene.textures()[map.texture];
        let Some(image) = image_of(texture) else {
            return constant_channel(texture, channel);
        };
        let region = self.region(texture, image, area.mapped(&map.texture_from_surface));
        if region.is_entire() {
            *self.values[image][channel].get_or_init(|| region.value(channel))
        } else {
            region.value(channel)
        }
    }

    /// Whether a channel has a property in all texels that a lookup on an area may read.
    pub(super) fn all(
        &self,
        map: &Map,
        area: UvRect,
        channel: usize,
        holds: impl Fn(f64) -> bool,
    ) -> bool {
        let texture = &self.scene.textures()[map.texture];
        match image_of(texture) {
            None => constant_channel(texture, channel).is_some_and(holds),
            Some(image) => self
                .region(texture, image, area.mapped(&map.texture_from_surface))
                .channel(channel)
                .all(holds),
        }
    }

    /// The texels that a lookup of a texture on an area may read.
    fn region(
        &self,
        texture: &Texture,
        image: ImageId,
        UvRect([us, vs]): UvRect,
    ) -> ImageRegion<'scene> {
        let image = &self.scene.images()[image];
        let [width, height] = [image.width.get(), image.height.get()];
        let (columns, rows) = match texture {
            Texture::Uv | Texture::Image(_) | Texture::Procedural(_) => (0..width, 0..height),
            Texture::Sampled(sampled) => (
                texels(us, width, sampled.wrap[0]),
                texels(vs, height, sampled.wrap[1]),
            ),
        };
        ImageRegion {
            image,
            columns,
            rows,
        }
    }
}

/// The value of a channel of a texture without an image, if it is constant.
fn constant_channel(texture: &Texture, channel: usize) -> Option<f64> {
    match texture {
        Texture::Uv => [None, Some(0.0), None, Some(1.0)][channel],
        Texture::Image(_) | Texture::Sampled(_) => None,
        Texture::Procedural(texture) => {
            let [first, second] = texture.colors.map(|color| color.extend(1.0));
            (first[channel] == second[channel]).then_some(first[channel])
        }
    }
}

/// The image of a texture, if it has one.
fn image_of(texture: &Texture) -> Option<ImageId> {
    match texture {
        Texture::Uv | Texture::Procedural(_) => None,
        Texture::Image(image) => Some(*image),
        Texture::Sampled(sampled) => Some(sampled.image),
    }
}

/// A rectangle of texels of an image.
struct ImageRegion<'scene> {
    image: &'scene Image,
    columns: Range<u32>,
    rows: Range<u32>,
}

impl ImageRegion<'_> {
    fn is_entire(&self) -> bool {
        self.columns.len() == self.image.width.get() as usize
            && self.rows.len() == self.image.height.get() as usize
    }

    /// The values of a channel.
    fn channel(&self, channel: usize) -> impl Iterator<Item = f64> {
        let width = self.image.width.get() as usize;
        let row = move |row: u32| {
            let texel = move |column: u32| row as usize * width + column as usize;
            self.columns.clone().map(texel)
        };
        self.rows
            .clone()
            .flat_map(row)
            .map(move |texel| value(self.image.texels.at(texel), channel))
    }

    /// The value of a channel, if it is constant.
    fn value(&self, channel: usize) -> Option<f64> {
        let mut values = self.channel(channel);
        let first = values.next()?;
        values.all(|value| value == first).then_some(first)
    }
}

/// The value of a channel, as texture sampling reads it.
fn value(texel: Texel, channel: usize) -> f64 {
    match (texel, channel) {
        (Texel::Rgb8(_) | Texel::Rgb32f(_), 3..) => 1.0,
        (Texel::Rgb8(bytes), _) => f64::from(f32::from(bytes[channel]) / 255.0),
        (Texel::Rgba8(bytes), _) => f64::from(f32::from(bytes[channel]) / 255.0),
        (Texel::Rgb32f(values), _) => f64::from(values[channel]),
    }
}

/// The columns or rows that lookups at coordinates from `low` to `high` may read; all if that is
/// uncertain.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped to the image"
)]
fn texels([low, high]: [f64; 2], count: u32, wrap: Wrap) -> Range<u32> {
    let size = f64::from(count);
    let is_near = low.abs() < MAX_REPEATS && high.abs() < MAX_REPEATS && low <= high;
    let (low, high) = match wrap {
        _ if !is_near => return 0..count,
        Wrap::Repeat => (low - low.floor(), high - low.floor()),
        Wrap::Mirror | Wrap::Clamp => (low, high),
    };
    let (first, last) = (low * size - MARGIN, high * size + MARGIN);
    if wrap != Wrap::Clamp && (first < 0.0 || last > size) {
        return 0..count;
    }
    // Outside the unit square, a clamped image repeats its outermost texels.
    let first = first.clamp(0.0, size - 1.0).floor() as u32;
    let last = last.clamp(1.0, size).ceil() as u32;
    first..last
}

#[cfg(test)]
mod tests {
    use super::*;
    use rtc_image::Texels;
    use std::cell::Cell;
    use std::num::NonZeroU32;

    #[test]
    fn an_area_shows_its_texels_and_their_neighbours() {
        assert_eq!(texels([0.5, 0.5], 64, Wrap::Repeat), 30..34);
        assert_eq!(
            texels([7.5, 7.5], 64, Wrap::Repeat),
            30..34,
            "seven images on"
        );
        assert_eq!(texels([0.5, 1.0], 64, Wrap::Clamp), 30..64);
        assert_eq!(
            texels([3.0, 4.0], 64, Wrap::Clamp),
            63..64,
            "the edge alone"
        );
        assert_eq!(texels([-4.0, -3.0], 64, Wrap::Clamp), 0..1);
    }

    #[test]
    fn an_area_up_to_the_edge_does_not_wrap_around() {
        assert_eq!(texels([0.5, 0.75], 8, Wrap::Repeat), 2..8);
        assert_eq!(texels([0.25, 0.5], 8, Wrap::Repeat), 0..6);
    }

    #[test]
    fn an_area_that_may_wrap_around_reads_all_texels() {
        assert_eq!(texels([0.0, 0.5], 64, Wrap::Repeat), 0..64);
        assert_eq!(texels([0.5, 1.5], 64, Wrap::Repeat), 0..64);
        assert_eq!(texels([1.4, 1.5], 64, Wrap::Mirror), 0..64);
        assert_eq!(texels([1e7, 1e7], 64, Wrap::Clamp), 0..64);
        assert_eq!(texels([-MAX_REPEATS, 0.0], 64, Wrap::Clamp), 0..64);
        assert_eq!(texels([0.5, MAX_REPEATS], 64, Wrap::Clamp), 0..64);
        let UvRect([none, _]) = UvRect::NONE;
        assert_eq!(texels(none, 64, Wrap::Clamp), 0..64, "no place known");
    }

    #[test]
    fn an_affine_map_rotates_and_translates_an_area() {
        let turned = UvRect::UNIT.mapped(&[[0.0, 2.0, 1.0], [-1.0, 0.0, 0.0]]);
        assert_eq!(turned, UvRect([[1.0, 3.0], [-1.0, 0.0]]));
    }

    fn image(width: u32, texels: &[[u8; 3]]) -> Image {
        let count = |count: u32| NonZeroU32::new(count).unwrap();
        Image {
            width: count(width),
            height: count(texels.len() as u32 / width),
            texels: Texels::Rgb8(texels.concat().into()),
        }
    }

    #[test]
    fn a_region_is_constant_where_its_texels_are_equal() {
        let image = image(2, &[[1, 0, 9], [2, 0, 9], [3, 0, 9], [3, 0, 9]]);
        let values = |columns, rows| {
            let region = ImageRegion {
                image: &image,
                columns,
                rows,
            };
            [0, 1, 2, 3].map(|channel| region.value(channel))
        };
        let byte = |byte: u8| Some(f64::from(f32::from(byte) / 255.0));
        let (zero, nine, one) = (Some(0.0), byte(9), Some(1.0));
        assert_eq!(values(0..2, 0..2), [None, zero, nine, one]);
        assert_eq!(values(0..2, 1..2), [byte(3), zero, nine, one]);
        assert_eq!(values(1..2, 0..1), [byte(2), zero, nine, one]);
        let is_entire = |columns, rows| {
            let image = &image;
            ImageRegion {
                image,
                columns,
                rows,
            }
            .is_entire()
        };
        assert!(is_entire(0..2, 0..2) && !is_entire(0..2, 1..2) && !is_entire(1..2, 0..2));
    }

    #[test]
    fn no_texel_is_read_after_the_one_that_decides() {
        let image = image(3, &[[1; 3], [2; 3], [3; 3], [4; 3], [5; 3], [6; 3]]);
        let region = ImageRegion {
            image: &image,
            columns: 1..3,
            rows: 0..2,
        };
        let read = Cell::new(0);
        let mut values = region.channel(0).inspect(|_| read.set(read.get() + 1));
        assert!(!values.all(|value| value * 255.0 < 2.5));
        assert_eq!(read.get(), 2, "the second texel is 3");
    }
}
