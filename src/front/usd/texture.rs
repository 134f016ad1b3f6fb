//! Pictures of materials: channels of files, scaled as `UsdUVTexture` says, become the pictures
//! that the standard material looks up.

use super::Lowering;
use super::stage::ComposedPrim;
use crate::exchange::SpannedText;
use crate::exchange::color::encoded;
use crate::pixels;
use rtc_color::{nearest8, srgb_decoded};
use rtc_diag::codes;
use rtc_image::{OpacityUse, Pixels, is_radiance};
use rtc_ir::{self as ir, EntityKind, Filter, Image, ImageId, Map, Sampled, TextureId, Wrap};
use rtc_source::{FileKind, Resource, Span};
use std::collections::BTreeMap;

/// What takes the place of a picture.
pub(super) const INSTEAD: &str = "its fallback takes its place";

/// The formats of textures; those that are not read are told.
pub(super) const TEXTURES: FileKind = FileKind {
    extensions: &[
        "png", "jpg", "jpeg", "webp", "ktx2", "exr", "hdr", "tga", "tif", "tiff", "bmp", "avif",
    ],
    begins: |_| true,
};

/// One channel of a picture that is made: a channel of a file with its scale and bias, or a
/// constant.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum SourceChannel {
    Constant(u8),
    File {
        path: String,
        layer: usize,
        channel: usize,
        is_srgb: bool,
        scale: u64,
        bias: u64,
    },
}

/// What distinguishes pictures: their channels, and whether their colours are coded as sRGB.
pub(super) type ChannelsKey = (Vec<SourceChannel>, bool);

/// How a material looks a picture up.
#[derive(Clone, Debug)]
pub(super) struct TextureLookup {
    pub(super) path: SpannedText,
    pub(super) layer: usize,
    /// The channel that is used; none for all colours.
    pub(super) channel: Option<usize>,
    pub(super) scale: [f64; 4],
    pub(super) bias: [f64; 4],
    pub(super) fallback: [f64; 4],
    /// Whether the colours are coded as sRGB, if the material says so.
    pub(super) is_srgb: Option<bool>,
    pub(super) wrap: [Wrap; 2],
    /// The texture coordinates by their primvar, and their map.
    pub(super) primvar: String,
    pub(super) rows: [[f64; 3]; 2],
}

impl TextureLookup {
    /// The value of a channel without the file.
    pub(super) fn fallback(&self, channel: usize) -> f64 {
        self.fallback[channel] * self.scale[channel] + self.bias[channel]
    }

    /// Channels of the file for the picture that is made: its values times `scale`, plus `bias`.
    pub(super) fn file(
        &self,
        channel: usize,
        is_color: bool,
        scale: f64,
        bias: f64,
    ) -> SourceChannel {
        let is_srgb = self.is_srgb.unwrap_or(is_color) && channel < 3;
        SourceChannel::File {
            path: self.path.text.clone(),
            layer: self.layer,
            channel,
            is_srgb,
            scale: (self.scale[channel] * scale).to_bits(),
            bias: (self.bias[channel] * scale + bias).to_bits(),
        }
    }

    /// The rows for texture coordinates whose v runs down, as those of meshes do.
    fn flipped(&self) -> Option<[[f64; 3]; 2]> {
        let [[a, b, c], [d, e, f]] = self.rows;
        let rows = [[a, -b, b + c], [-d, e, 1.0 - e - f]].map(|row| row.map(|number| number + 0.0));
        (rows != [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]).then_some(rows)
    }
}

impl Lowering<'_> {
    /// The map of a picture of some channels; `set` is that of the texture coordinates. `None`
    /// without its file, which is reported once.
    pub(super) fn picture_map(
        &mut self,
        look: &TextureLookup,
        channels: Vec<SourceChannel>,
        is_color: bool,
        set: u32,
    ) -> Option<Map> {
        let key = (channels, is_color);
        let image = match self.images.get(&key) {
            Some(known) => *known,
            None => {
                let image = self.read_image(look, &key);
                self.images.insert(key, image);
                image
            }
        }?;
        let texture = self.sampled_texture(image, look.wrap, look.path.span);
        Some(Map {
            texture,
            set,
            texture_from_surface: look.flipped(),
        })
    }

    /// Makes a picture of the channels of its files.
    fn read_image(
        &mut self,
        look: &TextureLookup,
        (channels, is_color): &ChannelsKey,
    ) -> Option<ImageId> {
        let mut files = BTreeMap::new();
        let span = look.path.span;
        for channel in channels {
            let SourceChannel::File { path, layer, .. } = channel else {
                continue;
            };
            // Layers in different folders may give different files one name.
            let key = (*layer, path.clone());
            if files.contains_key(&key) {
                continue;
            }
            let text = SpannedText {
                text: path.clone(),
                span,
            };
            if let Some(grid) = self.tile_grid(&text, *layer) {
                files.insert(key, self.tiled(&grid, *layer, span)?);
                continue;
            }
            let bytes = self.file(&text, *layer, &TEXTURES, INSTEAD)?;
            if is_radiance(&bytes) {
                return self.float_image(&text, &bytes);
            }
            files.insert(key, self.decoded(&text, &bytes)?);
        }
        let width = files.values().map(|file| file.width).max()?;
        let height = files.values().map(|file| file.height).max()?;
        let bytes = channels.len() as u64 * u64::from(width) * u64::from(height);
        self.charge(Resource::Textures, bytes, span)?;
        let (columns, rows) = (width as usize, height as usize);
        let mut made = vec![0; channels.len() * columns * rows];
        for (at, channel) in channels.iter().enumerate() {
            let targets = made.iter_mut().skip(at).step_by(channels.len());
            match channel {
                SourceChannel::Constant(byte) => targets.for_each(|target| *target = *byte),
                SourceChannel::File {
                    path,
                    layer,
                    channel,
                    is_srgb,
                    scale,
                    bias,
                } => {
                    let file = &files[&(*layer, path.clone())];
                    let table = table(*is_srgb, [*scale, *bias], *is_color && at < 3);
                    let (w, h) = (file.width as usize, file.height as usize);
                    let size = file.bytes.len() / (w * h);
                    for (index, target) in targets.enumerate() {
                        let (x, y) = (index % columns * w / columns, index / columns * h / rows);
                        let texel = &file.bytes[(y * w + x) * size..][..size];
                        let byte = texel.get(*channel).copied().unwrap_or(255);
                        *target = table[usize::from(byte)];
                    }
                }
            }
        }
        let image = Image {
            name: look.path.text.clone(),
            width,
            height,
            kind: if channels.len() == 4 {
                ir::Pixels::Rgba8
            } else {
                ir::Pixels::Rgb8
            },
            pixels: made.into(),
        };
        Some(self.add_picture(image, span))
    }

    /// The pixels of a file; `None` if it cannot be read, which is reported.
    pub(super) fn decoded(&mut self, path: &SpannedText, bytes: &[u8]) -> Option<Pixels> {
        let decoded = pixels::decode(bytes, OpacityUse::Kept, self.map.budget());
        let reject = |fault| {
            let what = format!("the image `{}`", rtc_diag::clip_path(&path.text));
            let formats = "textures are PNG, JPEG, WebP, EXR or HDR";
            let diagnostic = pixels::rejection(&fault, &what, formats);
            self.without(diagnostic, path.span, INSTEAD);
        };
        decoded.map_err(reject).ok()
    }

    /// A picture of radiance as it is.
    fn float_image(&mut self, path: &SpannedText, bytes: &[u8]) -> Option<ImageId> {
        match pixels::environment(&path.text, bytes, self.map.budget()) {
            Ok(image) => Some(self.add_picture(image, path.span)),
            Err(fault) => {
                let what = format!("the image `{}`", rtc_diag::clip_path(&path.text));
                let diagnostic = pixels::rejection(&fault, &what, "");
                self.without(diagnostic, path.span, INSTEAD);
                None
            }
        }
    }

    fn add_picture(&mut self, image: Image, span: Span) -> ImageId {
        let id = self.scene.add_image(image);
        self.record(EntityKind::Image, id.0 as usize, span);
        id
    }

    /// The texture of an image, one for each way in which it is looked up.
    fn sampled_texture(&mut self, image: ImageId, wrap: [Wrap; 2], span: Span) -> TextureId {
        let sampled = Sampled {
            image,
            wrap,
            filter: Filter::Linear,
        };
        let into = (&mut self.scene, &mut self.source_spans);
        self.textures.add(sampled, span, into)
    }

    /// What a `UsdUVTexture` says of its picture; `None` without a file.
    pub(super) fn texture_look(
        &mut self,
        texture: &ComposedPrim,
        output: &str,
    ) -> Option<TextureLookup> {
        // Find the image file.
        let (file, name) = self.value_source(texture, "inputs:file")?;
        let (path, layer) = self
            .asset(&file, &name)
            .filter(|(path, _)| !path.text.is_empty())?;
        // Read how texel values are scaled and decoded.
        let four = |lowering: &Self, name: &str, default: [f64; 4]| {
            lowering.vector::<4>(texture, name).unwrap_or(default)
        };
        let (scale, bias) = (
            four(self, "inputs:scale", [1.0; 4]),
            four(self, "inputs:bias", [0.0; 4]),
        );
        let fallback = four(self, "inputs:fallback", [0.0, 0.0, 0.0, 1.0]);
        let space = self.text(texture, "inputs:sourceColorSpace");
        let space = space.or_else(|| self.text(texture, "inputs:isSRGB"));
        let is_srgb = match space.as_deref() {
            Some("sRGB" | "srgb") => Some(true),
            Some("raw") => Some(false),
            _ => None,
        };
        // Read how the image goes on beyond its edges.
        let wrap = ["inputs:wrapS", "inputs:wrapT"].map(|name| {
            match self.text(texture, name).as_deref() {
                Some("clamp") => Wrap::Clamp,
                Some("mirror") => Wrap::Mirror,
                Some("black") => {
                    let span = self.property_span(texture, name);
                    let message =
                        "beyond its edges the picture is not black: its last texels go on";
                    self.report(&codes::USD_APPROXIMATE, span, message);
                    Wrap::Clamp
                }
                _ => Wrap::Repeat,
            }
        });
        // Read the texture coordinates and the output channel.
        let (primvar, mut rows) = self.texture_coordinates(texture);
        let mut wrap = wrap;
        if let Some(grid) = self.tile_grid(&path, layer) {
            rows = after(grid.rows(), rows);
            wrap = [Wrap::Clamp; 2];
        }
        let channel = "rgba"
            .find(output.strip_prefix("outputs:").unwrap_or(output))
            .filter(|_| {
                matches!(
                    output,
                    "outputs:r" | "outputs:g" | "outputs:b" | "outputs:a"
                )
            });
        Some(TextureLookup {
            path,
            layer,
            channel,
            scale,
            bias,
            fallback,
            is_srgb,
            wrap,
            primvar,
            rows,
        })
    }

    /// The primvar of the texture coordinates, and the map from it to them.
    fn texture_coordinates(&mut self, texture: &ComposedPrim) -> (String, [[f64; 3]; 2]) {
        let mut rows = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let mut node = self.node(texture, "inputs:st").map(|(node, _)| node);
        for _ in 0..4 {
            let Some(prim) = node else { break };
            match self.shader_id(&prim).as_deref() {
                Some("UsdTransform2d") => {
                    rows = after(rows, self.transform_2d(&prim));
                    node = self.node(&prim, "inputs:in").map(|(node, _)| node);
                }
                Some("UsdPrimvarReader_float2") => {
                    let source = self.value_source(&prim, "inputs:varname");
                    let name = source.and_then(|(prim, name)| self.text(&prim, &name));
                    return (name.unwrap_or_else(|| "st".to_owned()), rows);
                }
                id => {
                    let id = rtc_diag::clip(id.unwrap_or("")).into_owned();
                    let what = format!("the texture coordinates by `{id}`");
                    self.unsupported(&prim, &what, "`st` takes their place");
                    break;
                }
            }
        }
        ("st".to_owned(), rows)
    }

    /// Scale, then turn, then move.
    fn transform_2d(&self, prim: &ComposedPrim) -> [[f64; 3]; 2] {
        let [sx, sy] = self.vector::<2>(prim, "inputs:scale").unwrap_or([1.0; 2]);
        let [tx, ty] = self
            .vector::<2>(prim, "inputs:translation")
            .unwrap_or([0.0; 2]);
        let angle = self
            .number(prim, "inputs:rotation")
            .unwrap_or(0.0)
            .to_radians();
        let (s, c) = (rtc_math::sin(angle), rtc_math::cos(angle));
        [[c * sx, -s * sy, tx], [s * sx, c * sy, ty]]
    }
}

/// The rows of an affine map after another one.
fn after(outer: [[f64; 3]; 2], [x, y]: [[f64; 3]; 2]) -> [[f64; 3]; 2] {
    outer.map(|[a, b, c]| {
        let sum = |at: usize| a * x[at] + b * y[at];
        [sum(0), sum(1), sum(2) + c]
    })
}

/// What each byte of a file becomes.
fn table(is_srgb: bool, [scale, bias]: [u64; 2], encodes: bool) -> [u8; 256] {
    std::array::from_fn(|byte| {
        let value = byte as f64 / 255.0;
        let value = if is_srgb { srgb_decoded(value) } else { value };
        let value = value * f64::from_bits(scale) + f64::from_bits(bias);
        match encodes {
            true => encoded(value),
            false => nearest8(value),
        }
    })
}
