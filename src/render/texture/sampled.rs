//! Texture sampling by the rules of glTF: texture coordinates and colour spaces.

use super::footprint::{TexelFootprint, TexelLayout, single};
use super::{Filter, Image, Texture, Wrap};
use rtc_color::srgb_decoded;
use rtc_image::Texels;
use rtc_math::{Lanes, TextureMapping, Vec3};
use std::cell::Cell;
use std::sync::LazyLock;

/// The colour space of a texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ColorSpace {
    /// Colours; bytes are encoded with sRGB.
    Srgb,
    /// Numbers, without an encoding.
    Linear,
}

/// The two sets of texture coordinates at a point, `None` for a missing set, and the point.
pub(crate) struct UvSets {
    sets: [Option<[f64; 2]>; 2],
    /// In world coordinates.
    point: Vec3,
    /// The last footprint: the maps of a material mostly have the same one.
    last: Cell<Option<(TexelLayout, TexelFootprint)>>,
}

impl UvSets {
    /// The sets at a point in world coordinates.
    pub(crate) const fn new(sets: [Option<[f64; 2]>; 2], point: Vec3) -> Self {
        let last = Cell::new(None);
        Self { sets, point, last }
    }

    /// The sets at a point moved by an offset of one of them and of the point.
    fn moved(&self, set: usize, [du, dv]: [f64; 2], by: Vec3) -> Self {
        let mut sets = self.sets;
        if let Some([u, v]) = &mut sets[set] {
            (*u, *v) = (*u + du, *v + dv);
        }
        Self::new(sets, self.point + by)
    }

    /// The first set.
    pub(crate) fn first(&self) -> Option<[f64; 2]> {
        self.sets[0]
    }

    /// The footprint of a layout, at the coordinates of its set.
    #[inline]
    fn footprint(&self, layout: TexelLayout, uv: [f64; 2]) -> TexelFootprint {
        if let Some((last, footprint)) = self.last.get()
            && last == layout
        {
            return footprint;
        }
        let footprint = TexelFootprint::new(&layout, uv);
        self.last.set(Some((layout, footprint)));
        footprint
    }
}

/// A texture in a glTF material: its texture coordinates and its colour space.
#[derive(Clone, Debug)]
pub(crate) struct Map {
    pub(crate) texture: Texture,
    /// The index into [`UvSets`].
    pub(crate) set: usize,
    /// The rows of the affine map from the surface's coordinates to the texture's; `None` for the
    /// identity.
    pub(crate) texture_from_surface: Option<[[f64; 3]; 2]>,
    pub(crate) color_space: ColorSpace,
}

impl Map {
    /// Looks the texture up: red, green, blue and alpha, in [0, 1] except for float images. `None`
    /// without texture coordinates.
    pub(crate) fn look_up(&self, uvs: &UvSets) -> Option<[f64; 4]> {
        if let Texture::Procedural(texture) = &self.texture {
            let uv = uvs.sets[self.set].map(|uv| self.mapped(uv));
            let color = texture.color_at(uv, uvs.point)?;
            return Some(color.extend(1.0).to_array());
        }
        let [u, v] = uvs.sets[self.set]?;
        if let (
            Texture::Sampled {
                image,
                wrap,
                filter,
            },
            None,
        ) = (&self.texture, &self.texture_from_surface)
        {
            let layout = TexelLayout {
                set: self.set,
                size: [image.width, image.height],
                wrap: *wrap,
                filter: *filter,
            };
            let footprint = uvs.footprint(layout, [u, v]);
            return Some(mean(&footprint, image, self.color_space));
        }
        let uv = self.mapped([u, v]);
        let value = match &self.texture {
            Texture::Uv => [uv[0].clamp(0.0, 1.0), 0.0, uv[1].clamp(0.0, 1.0), 1.0],
            // In the course, v grows upwards.
            Texture::Image(image) => {
                let uv = [uv[0], 1.0 - uv[1]];
                sample(
                    image,
                    uv,
                    [Wrap::Repeat; 2],
                    Filter::Linear,
                    self.color_space,
                )
            }
            Texture::Sampled {
                image,
                wrap,
                filter,
            } => sample(image, uv, *wrap, *filter, self.color_space),
            Texture::Procedural(_) => return None,
        };
        Some(value)
    }

    /// Whether it is a pattern in space.
    pub(crate) fn is_in_space(&self) -> bool {
        match &self.texture {
            Texture::Procedural(texture) => texture.mapping == TextureMapping::World,
            Texture::Uv | Texture::Image(_) | Texture::Sampled { .. } => false,
        }
    }

    /// The derivatives of red by u and v of the surface: central differences over an eighth of a
    /// texel, or a 32nd of a cell of a pattern. `None` without texture coordinates.
    pub(crate) fn gradient(&self, uvs: &UvSets) -> Option<[f64; 2]> {
        let [[a, b, _], [d, e, _]] = self
            .texture_from_surface
            .unwrap_or([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
        // The texels or cells along u and v of the surface.
        let [width, height] = match &self.texture {
            Texture::Image(image) | Texture::Sampled { image, .. } => {
                [image.width, image.height].map(f64::from)
            }
            Texture::Procedural(texture) => [4.0 * texture.scale.get(); 2],
            Texture::Uv => [1.0; 2],
        };
        let counts = [
            (width * a).abs().max((height * d).abs()),
            (width * b).abs().max((height * e).abs()),
        ];
        let mut slopes = [0.0; 2];
        for (axis, slope) in slopes.iter_mut().enumerate() {
            let step = SHARE / counts[axis].max(f64::MIN_POSITIVE);
            let red = |side: f64| {
                let mut offset = [0.0; 2];
                offset[axis] = side * step;
                let moved = uvs.moved(self.set, offset, Vec3::ZERO);
                Some(self.look_up(&moved)?[0])
            };
            let difference = red(1.0)? - red(-1.0)?;
            *slope = if step.is_finite() {
                difference / (2.0 * step)
            } else {
                0.0
            };
        }
        Some(slopes)
    }

    /// The gradient of red in space, of a pattern there.
    pub(crate) fn gradient_in_space(&self, uvs: &UvSets) -> Vec3 {
        let scale = match &self.texture {
            Texture::Procedural(texture) => texture.scale.get(),
            Texture::Uv | Texture::Image(_) | Texture::Sampled { .. } => 1.0,
        };
        let step = SHARE / (4.0 * scale);
        let red = |by: Vec3| {
            let value = self.look_up(&uvs.moved(self.set, [0.0; 2], by));
            value.map_or(0.0, |[red, ..]| red)
        };
        let slope = |axis: Vec3| (red(axis * step) - red(-axis * step)) / (2.0 * step);
        Vec3::new(slope(Vec3::X), slope(Vec3::Y), slope(Vec3::Z))
    }

    /// The coordinates of the texture for those of the surface.
    fn mapped(&self, [u, v]: [f64; 2]) -> [f64; 2] {
        match self.texture_from_surface {
            None => [u, v],
            Some([[a, b, c], [d, e, f]]) => [a * u + b * v + c, d * u + e * v + f],
        }
    }
}

/// The step of differences, as a share of a texel.
const SHARE: f64 = 1.0 / 16.0;

/// Samples an image: v = 0 is its top edge, texel centers lie half a texel inside.
pub(crate) fn sample(
    image: &Image,
    uv: [f64; 2],
    wrap: [Wrap; 2],
    filter: Filter,
    color_space: ColorSpace,
) -> [f64; 4] {
    let layout = TexelLayout {
        set: 0,
        size: [image.width, image.height],
        wrap,
        filter,
    };
    mean(&TexelFootprint::new(&layout, uv), image, color_space)
}

/// The mean of the texels of a footprint by their weights: red, green, blue and alpha.
fn mean(footprint: &TexelFootprint, image: &Image, color_space: ColorSpace) -> [f64; 4] {
    let tables: &[[f32; 256]; 2] = &DECODED;
    let linear = &tables[ColorSpace::Linear as usize];
    let color = &tables[color_space as usize];
    let decoded = |[r, g, b]: [u8; 3], alpha| {
        let [r, g, b] = [r, g, b].map(|byte| color[usize::from(byte)]);
        Lanes::new(r, g, b, alpha)
    };
    // Decode texels by the format of the image, which is checked once.
    let value = match &image.texels {
        Texels::Rgb8(bytes) => footprint.blend(bytes.as_chunks().0, |color| decoded(color, 1.0)),
        Texels::Rgba8(bytes) => footprint.blend(bytes.as_chunks().0, |[r, g, b, a]| {
            decoded([r, g, b], linear[usize::from(a)])
        }),
        Texels::Rgb32f(bytes) => {
            footprint.blend(bytes.as_chunks().0.as_chunks().0, |color: [[u8; 4]; 3]| {
                let [r, g, b] = color.map(f32::from_le_bytes);
                Lanes::new(r, g, b, 1.0)
            })
        }
    };
    value.as_dvec4().to_array()
}

/// The value of each byte, by its [`ColorSpace`].
static DECODED: LazyLock<[[f32; 256]; 2]> = LazyLock::new(|| {
    let encoded: [f64; 256] = std::array::from_fn(|byte| byte as f64 / 255.0);
    let linear = std::array::from_fn(|byte| byte as f32 / 255.0);
    [encoded.map(|byte| single(srgb_decoded(byte))), linear]
});

#[cfg(test)]
mod tests {
    use super::*;

    fn row() -> Image {
        Image {
            width: 2,
            height: 1,
            texels: Texels::Rgb8(vec![255, 0, 0, 0, 255, 0].into()),
        }
    }

    fn red(u: f64, wrap: Wrap, filter: Filter) -> f64 {
        sample(&row(), [u, 0.5], [wrap; 2], filter, ColorSpace::Linear)[0]
    }

    #[test]
    fn texels_have_their_middles_inside() {
        assert_eq!(red(0.25, Wrap::Repeat, Filter::Linear), 1.0);
        assert_eq!(red(0.75, Wrap::Repeat, Filter::Linear), 0.0);
        assert_eq!(red(0.5, Wrap::Repeat, Filter::Linear), 0.5);
        assert_eq!(red(0.49, Wrap::Repeat, Filter::Nearest), 1.0);
        assert_eq!(red(0.51, Wrap::Repeat, Filter::Nearest), 0.0);
    }

    #[test]
    fn what_lies_beyond_is_repeated_mirrored_or_the_edge() {
        for (wrap, before, after, far) in [
            (Wrap::Repeat, 0.5, 0.5, 0.0),
            (Wrap::Mirror, 1.0, 0.0, 0.0),
            (Wrap::Clamp, 1.0, 0.0, 0.0),
        ] {
            assert_eq!(red(0.0, wrap, Filter::Linear), before, "{wrap:?}");
            assert_eq!(red(1.0, wrap, Filter::Linear), after, "{wrap:?}");
            assert_eq!(
                red(-5.25, wrap, Filter::Linear),
                if wrap == Wrap::Clamp { 1.0 } else { far },
                "{wrap:?}"
            );
        }
    }

    #[test]
    fn maps_after_others_show_what_they_show_alone() {
        let image = |width: u8| Image {
            width: width.into(),
            height: 2,
            texels: Texels::Rgb8((0..6 * width).collect::<Vec<_>>().into()),
        };
        let map = |width, set, wrap, filter| Map {
            texture: Texture::Sampled {
                image: image(width).into(),
                wrap: [wrap; 2],
                filter,
            },
            set,
            texture_from_surface: None,
            color_space: ColorSpace::Linear,
        };
        let maps = [
            map(4, 0, Wrap::Repeat, Filter::Linear),
            map(4, 0, Wrap::Repeat, Filter::Linear),
            map(4, 1, Wrap::Repeat, Filter::Linear),
            map(8, 1, Wrap::Repeat, Filter::Linear),
            map(8, 1, Wrap::Mirror, Filter::Linear),
            map(8, 1, Wrap::Mirror, Filter::Nearest),
        ];
        let uvs = || UvSets::new([Some([0.3, 0.7]), Some([1.8, 0.2])], Vec3::ZERO);
        let (shared, mut seen) = (uvs(), Vec::new());
        for map in &maps {
            let alone = map.look_up(&uvs());
            assert_eq!(map.look_up(&shared), alone);
            seen.extend(alone);
        }
        seen.dedup();
        assert_eq!(
            seen.len(),
            maps.len() - 1,
            "the layouts tell apart: {seen:?}"
        );
    }

    #[test]
    fn only_colours_are_decoded_and_alpha_never_is() {
        let image = Image {
            width: 1,
            height: 1,
            texels: Texels::Rgba8(vec![128; 4].into()),
        };
        let value = |color_space| {
            sample(
                &image,
                [0.5; 2],
                [Wrap::Repeat; 2],
                Filter::Linear,
                color_space,
            )
        };
        let [r, _, _, a] = value(ColorSpace::Srgb);
        assert!((r - 0.215_860_5).abs() < 1e-6 && a == f64::from(128.0_f32 / 255.0));
        assert_eq!(value(ColorSpace::Linear), [f64::from(128.0_f32 / 255.0); 4]);
    }
}
