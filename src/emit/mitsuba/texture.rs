//! Writes the values of materials that textures may vary: bitmaps beside the scene, with the factor
//! of each in their pixels.

use super::MitsubaWriter;
use crate::export::joined;
use crate::path_tracer::{TextureChannel, TexturedFactor};
use crate::picture::ColorCoding;
use rtc_ir::{Filter, Map, ValuePath, Wrap};
use rtc_math::shortest;

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
        if let Some(map) = slot.map {
            return self.bitmap(depth, name, map, slot, path);
        }
        match slot.channel {
            TextureChannel::Corners => self.attribute(depth, name, "vertex_color"),
            TextureChannel::CornerOpacity => self.attribute(depth, name, "vertex_opacity"),
            TextureChannel::Color => self.rgb(depth, name, slot.factor),
            TextureChannel::Red
            | TextureChannel::Green
            | TextureChannel::GreenSquared
            | TextureChannel::Blue
            | TextureChannel::Alpha
            | TextureChannel::AlphaCut(_)
            | TextureChannel::RedCut(_)
            | TextureChannel::Normal(_) => {
                self.value(depth, "float", name, &shortest(slot.number()));
            }
        }
        Some(())
    }

    /// Writes a value of the corners of a mesh, by the name of the attribute.
    fn attribute(&mut self, depth: usize, name: &str, attribute: &str) {
        self.line(
            depth,
            &format!(r#"<texture type="mesh_attribute" name="{name}">"#),
        );
        self.value(depth + 1, "string", "name", attribute);
        self.line(depth, "</texture>");
    }

    fn bitmap(
        &mut self,
        depth: usize,
        name: &str,
        map: &Map,
        slot: TexturedFactor<'_>,
        path: ValuePath,
    ) -> Option<()> {
        let bitmap = self.beside.bitmap(map, slot, path)?;
        // Write the sampler.
        self.line(depth, &format!(r#"<texture type="bitmap" name="{name}">"#));
        self.value(depth + 1, "string", "filename", &bitmap.file);
        if bitmap.coding == ColorCoding::Linear {
            self.value(depth + 1, "boolean", "raw", "true");
        }
        if bitmap.filter == Filter::Nearest {
            self.value(depth + 1, "string", "filter_type", "nearest");
        }
        match bitmap.wrap {
            Wrap::Repeat => {}
            Wrap::Mirror => self.value(depth + 1, "string", "wrap_mode", "mirror"),
            Wrap::Clamp => self.value(depth + 1, "string", "wrap_mode", "clamp"),
        }
        // Write the transform of the coordinates.
        let [[a, b, c], [d, e, f]] = bitmap.rows;
        if bitmap.rows != [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]] {
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
}
