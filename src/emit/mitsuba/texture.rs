//! Writes the values of materials that textures may vary: bitmaps beside the scene, with the factor
//! of each in their pixels.

use super::MitsubaWriter;
use crate::export::joined;
use crate::picture::{Coding, TexturePicture};
use crate::sidecar;
use rtc_diag::codes;
use rtc_ir::{Filter, Map, Standard, ValuePath, Wrap};
use rtc_math::shortest;
use xxhash_rust::xxh3::xxh3_64;

/// A value of a material: a factor, times a texture if there is one.
#[derive(Clone, Copy)]
pub(super) struct TexturedFactor<'m> {
    pub(super) factor: [f64; 3],
    pub(super) map: Option<&'m Map>,
    pub(super) channel: Channel,
}

/// What is taken of a texture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Channel {
    /// Its colour.
    Color,
    /// The colours of the corners of the mesh, which hold the factor already.
    Corners,
    /// The opacity of the corners of the mesh, which holds the factor already.
    CornerOpacity,
    Red,
    Green,
    Blue,
    Alpha,
    /// 1 where alpha is at least this, else 0.
    AlphaCut(f64),
    /// A direction, of whose red and green this much counts.
    Normal(f64),
}

impl<'m> TexturedFactor<'m> {
    /// The base colour of a material.
    pub(super) fn color(material: &'m Standard, has_colors: bool) -> Self {
        let [r, g, b, _] = material.base_color;
        let map = material.base_color_map.as_ref();
        Self {
            factor: [r, g, b],
            map,
            channel: match has_colors && map.is_none() {
                true => Channel::Corners,
                false => Channel::Color,
            },
        }
    }
}

impl Channel {
    fn coding(self) -> Coding {
        let is_color = matches!(self, Self::Color | Self::Corners);
        if is_color {
            Coding::Srgb
        } else {
            Coding::Linear
        }
    }

    /// A texel as a pixel of the bitmap.
    fn pixel(self, factor: [f64; 3], [r, g, b, a]: [f64; 4]) -> [f64; 3] {
        match self {
            Self::Color | Self::Corners => [r * factor[0], g * factor[1], b * factor[2]],
            Self::Red => [r * factor[0]; 3],
            Self::Green => [g * factor[0]; 3],
            Self::Blue => [b * factor[0]; 3],
            Self::Alpha | Self::CornerOpacity => [a * factor[0]; 3],
            Self::AlphaCut(cutoff) => [f64::from(u8::from(a * factor[0] >= cutoff)); 3],
            Self::Normal(scale) => {
                let part = |value: f64| (value * 2.0 - 1.0) * scale / 2.0 + 0.5;
                [part(r), part(g), b]
            }
        }
    }
}

impl MitsubaWriter<'_> {
    /// Writes a value; `None` if its picture exceeds the budget, which is reported.
    pub(super) fn slot(
        &mut self,
        depth: usize,
        name: &str,
        slot: TexturedFactor<'_>,
        path: ValuePath,
    ) -> Option<()> {
        // A slot holds a bitmap, a vertex attribute, a colour or a number.
        match slot {
            TexturedFactor { map: Some(map), .. } => {
                return self.bitmap(depth, name, map, slot, path);
            }
            TexturedFactor {
                channel: channel @ (Channel::Corners | Channel::CornerOpacity),
                ..
            } => {
                let is_color = channel == Channel::Corners;
                let attribute = if is_color {
                    "vertex_color"
                } else {
                    "vertex_opacity"
                };
                self.line(
                    depth,
                    &format!(r#"<texture type="mesh_attribute" name="{name}">"#),
                );
                self.value(depth + 1, "string", "name", attribute);
                self.line(depth, "</texture>");
            }
            TexturedFactor {
                factor,
                channel: Channel::Color,
                ..
            } => self.rgb(depth, name, factor),
            TexturedFactor {
                factor, channel, ..
            } => {
                let [value, ..] = channel.pixel(factor, [1.0; 4]);
                self.value(depth, "float", name, &shortest(value));
            }
        }
        Some(())
    }

    fn bitmap(
        &mut self,
        depth: usize,
        name: &str,
        map: &Map,
        TexturedFactor {
            factor, channel, ..
        }: TexturedFactor<'_>,
        path: ValuePath,
    ) -> Option<()> {
        // Encode each texture and channel once.
        let picture = TexturePicture::new(self.scene, map.texture);
        let key = format!("{} {channel:?} {factor:?}", map.texture.0);
        let file = match self.bitmaps.get(&key) {
            Some(file) => file.clone(),
            None => {
                self.reporter.charge(picture.cost(), self.budget, path)?;
                let change = |texel| channel.pixel(factor, texel);
                let encoded = picture.encode(channel.coding(), change);
                let encoded = encoded.map_err(|fault| fault.to_string());
                self.beside(picture.name(), encoded, path)?
            }
        };
        self.bitmaps.insert(key, file.clone());
        // Write the sampler.
        self.line(depth, &format!(r#"<texture type="bitmap" name="{name}">"#));
        self.value(depth + 1, "string", "filename", &file);
        if channel.coding() == Coding::Linear {
            self.value(depth + 1, "boolean", "raw", "true");
        }
        if picture.filter == Filter::Nearest || matches!(channel, Channel::AlphaCut(_)) {
            self.value(depth + 1, "string", "filter_type", "nearest");
        }
        let [u, v] = picture.wrap;
        if u != v {
            let message = "a texture goes on in two ways beyond its edges: Mitsuba's in one";
            self.reporter.unsupported(message, path);
        }
        match u {
            Wrap::Repeat => {}
            Wrap::Mirror => self.value(depth + 1, "string", "wrap_mode", "mirror"),
            Wrap::Clamp => self.value(depth + 1, "string", "wrap_mode", "clamp"),
        }
        // Write the transform of the coordinates.
        let [[a, b, c], [d, e, f]] = picture.rows(map);
        if [[a, b, c], [d, e, f]] != [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]] {
            let rows = [
                [a, b, 0.0, c],
                [d, e, 0.0, f],
                [0.0, 0.0, 1.0, 0.0],
                [0.0, 0.0, 0.0, 1.0],
            ];
            self.line(depth + 1, r#"<transform name="to_uv">"#);
            let matrix = joined(rows.into_iter().flatten(), " ");
            self.line(depth + 2, &format!(r#"<matrix value="{matrix}"/>"#));
            self.line(depth + 1, "</transform>");
        }
        self.line(depth, "</texture>");
        Some(())
    }

    /// Puts a file beside the scene, by its bytes and extension; returns its name.
    pub(super) fn beside(
        &mut self,
        source_name: &str,
        encoded: Result<(Vec<u8>, &'static str), String>,
        path: ValuePath,
    ) -> Option<String> {
        let (bytes, extension) = encoded
            .map_err(|fault| {
                let message = format!("the picture cannot be written: {fault}");
                self.reporter.report_error(&codes::NO_TWIN, &message, path);
            })
            .ok()?;
        let name = sidecar::path(
            self.folder,
            source_name,
            "picture",
            xxh3_64(&bytes),
            extension,
        );
        self.files.insert(name.clone(), bytes);
        Some(name)
    }
}
