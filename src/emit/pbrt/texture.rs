//! Writes the values of materials that textures may vary: bitmaps beside the scene, with the factor
//! of each in their pixels.

use super::{PbrtWriter, numbers, string};
use crate::path_tracer::{BitmapTexture, TexturedFactor};
use crate::picture::ColorCoding;
use rtc_ir::{Filter, Map, ValuePath, Wrap};

impl PbrtWriter<'_> {
    /// A value as a parameter, after the directive of its texture; `None` if its picture exceeds
    /// the budget, which is reported.
    pub(super) fn slot(
        &mut self,
        name: &str,
        slot: TexturedFactor<'_>,
        path: ValuePath,
    ) -> Option<String> {
        let is_color = slot.channel.coding() == ColorCoding::Srgb;
        let Some(map) = slot.map else {
            return Some(match is_color {
                true => numbers("rgb", name, slot.factor),
                false => numbers("float", name, [slot.number()]),
            });
        };
        let texture = self.texture(map, slot, is_color, path)?;
        Some(string("texture", name, &texture))
    }

    /// The name of the texture of a bitmap, which is written once.
    fn texture(
        &mut self,
        map: &Map,
        slot: TexturedFactor<'_>,
        is_color: bool,
        path: ValuePath,
    ) -> Option<String> {
        let bitmap = self.beside.bitmap(map, slot, path)?;
        self.report_lookup(&bitmap, path);
        // In pbrt v grows upwards, in images and in the meshes that are written for it.
        let [[u, turned, du], [_, v, dv]] = bitmap.rows;
        let mapping = [
            ("uscale", u, 1.0),
            ("vscale", v, 1.0),
            ("udelta", du + turned, 0.0),
            ("vdelta", 1.0 - v - dv, 0.0),
        ];
        let changed = mapping
            .into_iter()
            .filter(|(_, value, default)| value != default);
        let mapping: String = changed
            .map(|(name, value, _)| numbers("float", name, [value]))
            .collect();
        let kind = if is_color { "spectrum" } else { "float" };
        let parts = [
            format!(r#""{kind}" "imagemap""#),
            string("string", "filename", &bitmap.file),
            match bitmap.coding {
                ColorCoding::Srgb => String::new(),
                ColorCoding::Linear => string("string", "encoding", "linear"),
            },
            match bitmap.filter {
                Filter::Linear => String::new(),
                Filter::Nearest => string("string", "filter", "point"),
            },
            match bitmap.wrap {
                Wrap::Repeat => String::new(),
                Wrap::Mirror | Wrap::Clamp => string("string", "wrap", "clamp"),
            },
            mapping,
        ];
        // Write each texture once.
        let directive = parts.concat();
        if let Some(name) = self.textures.get(&directive) {
            return Some(name.clone());
        }
        let name = format!("t{}", self.textures.len());
        self.line(&format!(r#"Texture "{name}" {directive}"#));
        self.textures.insert(directive, name.clone());
        Some(name)
    }

    /// The heights of a material as a parameter: a texture times the scale.
    pub(super) fn displacement(
        &mut self,
        slot: TexturedFactor<'_>,
        scale: f64,
        path: ValuePath,
    ) -> Option<String> {
        let texture = self.texture(slot.map?, slot, false, path)?;
        let directive = [
            r#""float" "scale""#.to_owned(),
            string("texture", "tex", &texture),
            numbers("float", "scale", [scale]),
        ];
        let directive = directive.concat();
        let name = match self.textures.get(&directive) {
            Some(name) => name.clone(),
            None => {
                let name = format!("t{}", self.textures.len());
                self.line(&format!(r#"Texture "{name}" {directive}"#));
                self.textures.insert(directive, name.clone());
                name
            }
        };
        Some(string("texture", "displacement", &name))
    }

    /// The map of normals of a material as a parameter: a file without a transform.
    pub(super) fn normal_map(
        &mut self,
        slot: TexturedFactor<'_>,
        path: ValuePath,
    ) -> Option<String> {
        let Some(map) = slot.map else {
            return Some(String::new());
        };
        let bitmap = self.beside.bitmap(map, slot, path)?;
        let is_plain = bitmap.rows == [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        if !is_plain || bitmap.wrap != Wrap::Repeat || bitmap.filter != Filter::Linear {
            let message = "pbrt's maps of normals repeat over the unit square, without a transform";
            self.beside.reporter.unsupported(message, path);
        }
        Some(string("string", "normalmap", &bitmap.file))
    }

    fn report_lookup(&mut self, bitmap: &BitmapTexture, path: ValuePath) {
        let [[_, turned, _], [tilted, _, _]] = bitmap.rows;
        if turned != 0.0 || tilted != 0.0 {
            let message = "the rotation of a texture is left out: pbrt scales and shifts only";
            self.beside.reporter.unsupported(message, path);
        }
        if bitmap.wrap == Wrap::Mirror {
            let message = "a texture that is mirrored beyond its edges goes on with their colours";
            self.beside.reporter.unsupported(message, path);
        }
    }
}
