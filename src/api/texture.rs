//! Textures and environments of scenes that are built in code.

use super::{Filter, Wrap};
use rtc_ir::{self as ir, Pixels};
use rtc_math::{GradientNoise, TextureMapping, TexturePattern, Vec3, rotated_to_z};

/// A texture: an image in memory, a pattern, or the texture coordinates as colours.
///
/// A pattern blends two linear colours, each channel at least 0, and has `scale` cells (above 0)
/// per unit of the texture coordinates, or with [`Texture::in_world`] per scene unit.
///
/// An image is sampled as in glTF: (0, 0) is its upper left corner, it repeats, and is interpolated
/// linearly. A map of a material says which of its channels count and how they are coded.
///
/// ```
/// use rtc::{Camera, Filter, Phong, SceneBuilder, Shape, Texture};
///
/// let mut builder = SceneBuilder::new(Camera::look_at([0.0, 0.0, 5.0], [0.0; 3]));
/// let board = [[255; 3], [0; 3], [0; 3], [255; 3]].concat();
/// let board = builder.texture(Texture::rgb8(2, 2, board).filter(Filter::Nearest));
/// builder.add(Shape::sphere([0.0; 3], 1.0), Phong::default().color_map(board));
/// let tiles = builder.texture(Texture::checker([[0.9; 3], [0.2; 3]], 2.0).in_world());
/// let floor = Shape::plane([0.0, -1.0, 0.0], [0.0, 1.0, 0.0]);
/// builder.add(floor, Phong::default().color_map(tiles));
/// assert!(builder.build().is_ok());
/// ```
#[derive(Clone, Debug, PartialEq)]
#[must_use = "a texture is not seen before it is part of a scene"]
pub struct Texture {
    source: Source,
    wrap: [Wrap; 2],
    filter: Filter,
    /// Whether it is sampled as in scene texts.
    is_of_text: bool,
}

/// The source of the values of a texture.
#[derive(Clone, Debug, PartialEq)]
enum Source {
    Uv,
    Image(ir::Image),
    Pattern(ir::Procedural),
}

impl Texture {
    /// The colour (u, 0, v), which shows the texture coordinates.
    pub fn uv() -> Self {
        Self::of(Source::Uv)
    }

    /// A pattern of cubes.
    pub fn checker(colors: [[f64; 3]; 2], scale: f64) -> Self {
        Self::pattern(TexturePattern::Checker, colors, scale)
    }

    /// A pattern of slabs across the first axis.
    pub fn stripes(colors: [[f64; 3]; 2], scale: f64) -> Self {
        Self::pattern(TexturePattern::Stripes, colors, scale)
    }

    /// Gradient noise of 1 to 16 octaves; another seed gives other noise.
    pub fn noise(colors: [[f64; 3]; 2], scale: f64, octaves: u32, seed: u32) -> Self {
        let noise = GradientNoise { seed, octaves };
        Self::pattern(TexturePattern::Noise(noise), colors, scale)
    }

    /// The distance to the nearest of random points; another seed gives other points.
    pub fn worley(colors: [[f64; 3]; 2], scale: f64, seed: u32) -> Self {
        Self::pattern(TexturePattern::Worley { seed }, colors, scale)
    }

    fn pattern(pattern: TexturePattern, colors: [[f64; 3]; 2], scale: f64) -> Self {
        Self::of(Source::Pattern(ir::Procedural {
            pattern,
            colors,
            scale,
            mapping: TextureMapping::Uv,
        }))
    }

    fn of(source: Source) -> Self {
        Self {
            source,
            wrap: [Wrap::Repeat; 2],
            filter: Filter::Linear,
            is_of_text: false,
        }
    }

    /// An image of three bytes a pixel: red, green, blue; rows from the top.
    pub fn rgb8(width: u32, height: u32, pixels: impl Into<Vec<u8>>) -> Self {
        Self::image([width, height], Pixels::Rgb8, pixels.into())
    }

    /// An image of four bytes a pixel: red, green, blue, alpha; rows from the top.
    pub fn rgba8(width: u32, height: u32, pixels: impl Into<Vec<u8>>) -> Self {
        Self::image([width, height], Pixels::Rgba8, pixels.into())
    }

    /// An image of linear red, green and blue, each at least 0; rows from the top.
    pub fn rgb32f(width: u32, height: u32, pixels: &[[f32; 3]]) -> Self {
        Self::image([width, height], Pixels::Rgb32f, bytes_of(pixels))
    }

    fn image([width, height]: [u32; 2], kind: Pixels, pixels: Vec<u8>) -> Self {
        Self::of(Source::Image(image([width, height], kind, pixels)))
    }

    /// Gives a pattern world coordinates instead of texture coordinates; other textures keep
    /// theirs.
    pub fn in_world(mut self) -> Self {
        if let Source::Pattern(pattern) = &mut self.source {
            pattern.mapping = TextureMapping::World;
        }
        self
    }

    /// The continuation of an image outside the unit square, along u and along v.
    pub fn wrap(mut self, u: Wrap, v: Wrap) -> Self {
        self.wrap = [u, v];
        self
    }

    /// The interpolation of the texels of an image.
    pub fn filter(mut self, filter: Filter) -> Self {
        self.filter = filter;
        self
    }

    /// Samples the image as scene texts do: (0, 0) is its lower left corner, the outermost texel
    /// centres lie on the edges, and it repeats.
    pub fn as_in_texts(mut self) -> Self {
        self.is_of_text = true;
        self
    }

    /// The texture of a scene, to which its image is added.
    pub(super) fn lower(self, scene: &mut ir::Scene) -> ir::Texture {
        let Self {
            source,
            wrap,
            filter,
            is_of_text,
        } = self;
        match source {
            Source::Uv => ir::Texture::Uv,
            Source::Pattern(pattern) => ir::Texture::Procedural(pattern),
            Source::Image(image) if is_of_text => ir::Texture::Image(scene.add_image(image)),
            Source::Image(image) => ir::Texture::Sampled(ir::Sampled {
                image: scene.add_image(image),
                wrap,
                filter,
            }),
        }
    }
}

/// The light that arrives from infinity, for path tracing.
///
/// ```
/// use rtc::{Camera, Environment, SceneBuilder, Shape, Standard};
///
/// let mut builder = SceneBuilder::new(Camera::look_at([0.0, 0.0, 5.0], [0.0; 3]));
/// builder.environment(Environment::uniform([0.4, 0.5, 0.7]));
/// builder.add(Shape::sphere([0.0; 3], 1.0), Standard::default().metallic(0.0));
/// assert!(builder.build().is_ok());
/// ```
#[derive(Clone, Debug, PartialEq)]
#[must_use = "an environment lights nothing without a scene"]
pub struct Environment {
    radiance: [f64; 3],
    image: Option<ir::Image>,
    image_from_world: Option<[[f64; 3]; 3]>,
}

impl Environment {
    /// The same linear radiance from everywhere, each channel at least 0.
    pub fn uniform(radiance: [f64; 3]) -> Self {
        Self {
            radiance,
            image: None,
            image_from_world: None,
        }
    }

    /// An equirectangular image of all directions: linear red, green and blue, each at least 0;
    /// longitude across, latitude down, +y up, its centre towards −z.
    pub fn image(width: u32, height: u32, pixels: &[[f32; 3]]) -> Self {
        let pixels = bytes_of(pixels);
        Self {
            image: Some(image([width, height], Pixels::Rgb32f, pixels)),
            ..Self::uniform([1.0; 3])
        }
    }

    /// Multiplies an image by a colour, each channel at least 0.
    pub fn tint(mut self, factor: [f64; 3]) -> Self {
        self.radiance = factor;
        self
    }

    /// Turns an image by an angle in degrees about +y, counterclockwise as seen from above.
    pub fn turned(mut self, degrees: f64) -> Self {
        // Rows of a turn about z, whose axes are z, x, y of the world.
        let rows =
            rotated_to_z(Vec3::Z, degrees).map(|[[xx, xy, xz], [yx, yy, yz], [zx, zy, zz]]| {
                [[yy, yz, yx], [zy, zz, zx], [xy, xz, xx]]
            });
        self.image_from_world = rows;
        self
    }

    /// The environment of a scene, to which its image is added.
    pub(super) fn lower(self, scene: &mut ir::Scene) -> ir::Environment {
        let Self {
            radiance,
            image,
            image_from_world,
        } = self;
        ir::Environment {
            radiance,
            image: image.map(|image| scene.add_image(image)),
            image_from_world,
        }
    }
}

fn image([width, height]: [u32; 2], kind: Pixels, pixels: Vec<u8>) -> ir::Image {
    ir::Image {
        name: String::new(),
        width,
        height,
        kind,
        pixels: pixels.into(),
    }
}

fn bytes_of(pixels: &[[f32; 3]]) -> Vec<u8> {
    pixels
        .iter()
        .flatten()
        .flat_map(|channel| channel.to_le_bytes())
        .collect()
}
