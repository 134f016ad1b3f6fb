//! Validates the textures and texture maps: the images and textures they refer to exist.

use super::check::{Checker, EntityCounts};
use super::image::ImageId;
use rtc_diag::{Diagnostic, codes};
use rtc_ir::{self as ir, EntityField, EntityKind, ValuePath};
use rtc_math::{GradientNoise, Id, SolidTexture, TextureMapping, TexturePattern};

/// The id of a texture of a [`ValidScene`](crate::ValidScene).
pub type TextureId = Id<Texture>;

/// A texture of any kind.
#[derive(Clone, Copy, Debug)]
pub enum Texture {
    /// The colour (u, 0, v).
    Uv,
    /// An image with the texture coordinates of the course, v = 1 at its top row.
    Image(ImageId),
    /// An image as glTF samples it, v = 0 at its top row.
    Sampled(Sampled),
    /// A pattern in closed form.
    Procedural(SolidTexture),
}

/// An image with its sampler.
#[derive(Clone, Copy, Debug)]
pub struct Sampled {
    /// The image.
    pub image: ImageId,
    /// The wrap modes along u and v.
    pub wrap: [Wrap; 2],
    /// The filter.
    pub filter: Filter,
}

/// The wrap mode: how an image continues outside the unit square.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wrap {
    /// It repeats.
    Repeat,
    /// It repeats, mirrored at each edge.
    Mirror,
    /// With the texels of the edge.
    Clamp,
}

/// The filter between texels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Filter {
    /// Bilinear, between the four nearest.
    Linear,
    /// The nearest texel.
    Nearest,
}

/// A texture with an affine map from surface to texture coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Map {
    /// The texture.
    pub texture: TextureId,
    /// The set of texture coordinates of the surface.
    pub set: UvSet,
    /// The rows of the affine map from surface to texture coordinates, `(a, b, c)` for `a·u + b·v +
    /// c`.
    pub texture_from_surface: [[f64; 3]; 2],
}

/// One of the two sets of texture coordinates of a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UvSet {
    /// The first set.
    First,
    /// The second set.
    Second,
}

impl UvSet {
    /// Its number, from 0.
    #[must_use]
    pub fn index(self) -> usize {
        self as usize
    }
}

impl Map {
    /// The identity map.
    pub const IDENTITY: [[f64; 3]; 2] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
}

pub(super) fn texture(
    texture: &ir::Texture,
    index: usize,
    images: usize,
    check: &mut Checker<'_>,
) -> Option<Texture> {
    let at = ValuePath::new(EntityKind::Texture, index, EntityField::Whole);
    let mut exists = |image: ir::ImageId| check.handle(image.0, images, "image", at);
    match texture {
        ir::Texture::Uv => Some(Texture::Uv),
        ir::Texture::Image(image) => exists(*image).map(Texture::Image),
        ir::Texture::Sampled(ir::Sampled {
            image,
            wrap,
            filter,
        }) => Some(Texture::Sampled(Sampled {
            image: exists(*image)?,
            wrap: wrap.map(|wrap| match wrap {
                ir::Wrap::Repeat => Wrap::Repeat,
                ir::Wrap::Mirror => Wrap::Mirror,
                ir::Wrap::Clamp => Wrap::Clamp,
            }),
            filter: match filter {
                ir::Filter::Linear => Filter::Linear,
                ir::Filter::Nearest => Filter::Nearest,
            },
        })),
        ir::Texture::Procedural(texture) => procedural(texture, at, check).map(Texture::Procedural),
    }
}

fn procedural(
    texture: &ir::Procedural,
    at: ValuePath,
    check: &mut Checker<'_>,
) -> Option<SolidTexture> {
    let ir::Procedural {
        pattern,
        colors: [first, second],
        scale,
        mapping,
    } = texture;
    let colors = [check.color(*first, at), check.color(*second, at)];
    let scale = check.length(*scale, at, &codes::BAD_FACTOR, "scale of a texture");
    let is_sound = match pattern {
        TexturePattern::Noise(noise) => (1..=GradientNoise::MAX_OCTAVES).contains(&noise.octaves),
        TexturePattern::Checker | TexturePattern::Stripes | TexturePattern::Worley { .. } => true,
    };
    if !is_sound {
        let message = format!("noise has 1 to {} octaves", GradientNoise::MAX_OCTAVES);
        check.report(at, "", Diagnostic::new(&codes::BAD_FACTOR, message));
    }
    let [Some(first), Some(second)] = colors else {
        return None;
    };
    let texture = SolidTexture {
        pattern: *pattern,
        colors: [first, second],
        scale: scale?,
        mapping: *mapping,
    };
    is_sound.then_some(texture)
}

impl Texture {
    /// Whether the texture is evaluated at texture coordinates of the surface, which not every
    /// surface has.
    #[must_use]
    pub fn needs_uv(&self) -> bool {
        match self {
            Self::Uv | Self::Image(_) | Self::Sampled(_) => true,
            Self::Procedural(texture) => texture.mapping == TextureMapping::Uv,
        }
    }
}

/// Validates the texture map of a material.
pub(super) fn map(
    map: &ir::Map,
    counts: &EntityCounts,
    at: ValuePath,
    check: &mut Checker<'_>,
) -> Option<Map> {
    let ir::Map {
        texture,
        set,
        texture_from_surface,
    } = map;
    let texture = check.handle(texture.0, counts.textures, "texture", at);
    let valid_set = match set {
        0 => Some(UvSet::First),
        1 => Some(UvSet::Second),
        _ => None,
    };
    if valid_set.is_none() {
        let message =
            format!("a map uses set {set} of texture coordinates, but only sets 0 and 1 exist");
        check.report(at, "", Diagnostic::new(&codes::BAD_FACTOR, message));
    }
    let rows = texture_from_surface.unwrap_or(Map::IDENTITY);
    let finite = rows.iter().flatten().fold(true, |valid, number| {
        valid & check.number(*number, at).is_some()
    });
    let (texture, set) = (texture?, valid_set?);
    finite.then_some(Map {
        texture,
        set,
        texture_from_surface: rows,
    })
}
