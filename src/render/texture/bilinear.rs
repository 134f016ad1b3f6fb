//! Texture lookup, normal maps and bump maps by the rules of the course.

use super::sampled::{ColorSpace, sample};
use super::{Image, Texture, TextureLookupPoint};
use rtc_math::{SolidTexture, TextureMapping, Vec3, cross};

/// A height field over a surface.
#[derive(Clone, Debug)]
pub(crate) struct Bump {
    pub(crate) texture: Texture,
    /// The height of white above black, as a fraction of the width of a texel or of a cell of a
    /// pattern.
    pub(crate) height: f64,
}

/// The step of the differences of a pattern, as a share of a cell.
const STEP: f64 = 1.0 / 64.0;

impl Bump {
    /// The unit normal of the height field over a surface of unit normal `normal`; `None` if it
    /// needs texture coordinates or a `tangent`, the direction of u, and there is none.
    pub(crate) fn normal(
        &self,
        normal: Vec3,
        tangent: Option<Vec3>,
        place: &TextureLookupPoint,
    ) -> Option<Vec3> {
        if let Texture::Procedural(texture) = &self.texture
            && texture.mapping == TextureMapping::World
        {
            return Some(self.bumped_in_space(texture, normal, place.point));
        }
        Some(TextureFrame::new(normal, tangent?)?.bumped(self, place.uv?))
    }

    /// The normal of a height field in space, by the part of its gradient along the surface.
    fn bumped_in_space(&self, texture: &SolidTexture, normal: Vec3, point: Vec3) -> Vec3 {
        let step = STEP / texture.scale.get();
        let height = |offset: Vec3| mean_channel(texture.color(point + offset));
        let slope = |axis: Vec3| height(axis * step) - height(-axis * step);
        let gradient =
            Vec3::new(slope(Vec3::X), slope(Vec3::Y), slope(Vec3::Z)) * (0.5 / STEP * self.height);
        let along_surface = gradient - normal * normal.dot(gradient);
        (normal - along_surface).normalize_or(normal)
    }
}

fn mean_channel(color: Vec3) -> f64 {
    color.element_sum() / 3.0
}

/// Looks a texture up, each channel of an image in [0, 1]; `None` without the texture coordinates
/// that it needs.
pub(crate) fn look_up(texture: &Texture, place: &TextureLookupPoint) -> Option<Vec3> {
    if let Texture::Procedural(texture) = texture {
        return texture.color_at(place.uv, place.point);
    }
    place.uv.map(|uv| value(texture, uv))
}

/// The value of a texture at texture coordinates.
fn value(texture: &Texture, uv: [f64; 2]) -> Vec3 {
    match texture {
        Texture::Uv => Vec3::new(uv[0], 0.0, uv[1]),
        Texture::Image(image) => bilinear(image, uv),
        Texture::Sampled {
            image,
            wrap,
            filter,
        } => {
            let [r, g, b, _] = sample(image, uv, *wrap, *filter, ColorSpace::Linear);
            Vec3::new(r, g, b)
        }
        Texture::Procedural(texture) => texture.color(Vec3::new(uv[0], uv[1], 0.0)),
    }
}

/// Interpolates bilinearly between four texels. The unit square spans from the center of the first
/// texel to the center of the last; v = 1 is the top row; the image repeats.
fn bilinear(image: &Image, [u, v]: [f64; 2]) -> Vec3 {
    let (column, x) = split(repeated(u) * f64::from(image.width - 1), image.width);
    let (row, y) = split(
        (1.0 - repeated(v)) * f64::from(image.height - 1),
        image.height,
    );
    let texel = |column: usize, row: usize| image.texel(column, row).color();
    let (right, below) = (
        (column + 1).min(image.width as usize - 1),
        (row + 1).min(image.height as usize - 1),
    );
    let top = between(texel(column, row), texel(right, row), x);
    let bottom = between(texel(column, below), texel(right, below), x);
    between(top, bottom, y) / 255.0
}

/// a + (b − a)·s: exactly `a` where both are equal.
fn between(a: Vec3, b: Vec3, s: f64) -> Vec3 {
    a + (b - a) * s
}

/// Wraps a coordinate to [0, 1]; 1 stays 1.
fn repeated(coordinate: f64) -> f64 {
    if (0.0..=1.0).contains(&coordinate) {
        coordinate
    } else {
        coordinate - coordinate.floor()
    }
}

/// The texel below a coordinate, and the interpolation weight of the next.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the place is within the image"
)]
fn split(place: f64, count: u32) -> (usize, f64) {
    let texel = place.floor().clamp(0.0, f64::from(count - 1));
    (texel as usize, place - texel)
}

/// The texture frame of a surface: the directions of u and v, and the unit normal.
pub(crate) struct TextureFrame {
    pub(crate) along_u: Vec3,
    pub(crate) along_v: Vec3,
    pub(crate) normal: Vec3,
}

impl TextureFrame {
    /// The frame of a unit normal and a direction of u; `None` if they are parallel.
    pub(crate) fn new(normal: Vec3, tangent: Vec3) -> Option<Self> {
        let along_u = (tangent - normal * normal.dot(tangent)).try_normalize()?;
        Some(Self {
            along_u,
            along_v: cross(normal, along_u),
            normal,
        })
    }

    /// The normal that a colour of a normal map encodes.
    pub(crate) fn mapped(&self, color: Vec3) -> Vec3 {
        let local = color * 2.0 - 1.0;
        (self.along_u * local.x + self.along_v * local.y + self.normal * local.z)
            .normalize_or(self.normal)
    }

    /// The normal of a height field, by central differences over a texel or a part of a cell.
    fn bumped(&self, bump: &Bump, [u, v]: [f64; 2]) -> Vec3 {
        let ([du, dv], per_step) = match &bump.texture {
            Texture::Uv => ([1e-3; 2], 0.5),
            Texture::Image(image) | Texture::Sampled { image, .. } => (
                [1.0 / f64::from(image.width), 1.0 / f64::from(image.height)],
                0.5,
            ),
            Texture::Procedural(texture) => ([STEP / texture.scale.get(); 2], 0.5 / STEP),
        };
        let height = |u: f64, v: f64| mean_channel(value(&bump.texture, [u, v]));
        let slope_u = per_step * (height(u + du, v) - height(u - du, v)) * bump.height;
        let slope_v = per_step * (height(u, v + dv) - height(u, v - dv)) * bump.height;
        (self.normal - self.along_u * slope_u - self.along_v * slope_v).normalize_or(self.normal)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rtc_image::Texels;

    #[test]
    fn an_image_of_one_value_is_that_value_everywhere() {
        let pixels = [1, 77, 254].repeat(9).into();
        let image = Image {
            width: 3,
            height: 3,
            texels: Texels::Rgb8(pixels),
        };
        let value = Vec3::new(1.0, 77.0, 254.0) / 255.0;
        for k in 0..100 {
            let uv = [f64::from(k) * 0.037, f64::from(k) * 0.0713];
            assert_eq!(bilinear(&image, uv), value);
        }
    }

    #[test]
    fn the_corners_of_the_unit_square_are_the_middles_of_the_corner_texels() {
        let pixels = [[255, 0, 0], [0, 255, 0], [0, 0, 255], [255; 3]]
            .concat()
            .into();
        let image = Image {
            width: 2,
            height: 2,
            texels: Texels::Rgb8(pixels),
        };
        assert_eq!(bilinear(&image, [0.0, 1.0]), Vec3::X);
        assert_eq!(bilinear(&image, [1.0, 1.0]), Vec3::Y);
        assert_eq!(bilinear(&image, [0.0, 0.0]), Vec3::Z);
        assert_eq!(bilinear(&image, [1.0, 0.0]), Vec3::ONE);
        assert_eq!(bilinear(&image, [0.5, 1.0]), Vec3::new(0.5, 0.5, 0.0));
        assert_eq!(bilinear(&image, [2.5, 1.0]), Vec3::new(0.5, 0.5, 0.0));
    }
}
