//! Numbers of BSDFs that textures vary: opacities, weights and heights.

use super::Lowering;
use super::bsdf::checkerboard_colors;
use super::xml::PluginNode;
use crate::exchange::checkerboard::checkerboard;
use crate::exchange::number::{NumberCoding, NumberSource};
use crate::over_limit;
use rtc_color::luminance;
use rtc_diag::DiagnosticSink;
use rtc_ir::{EntityKind, ImageId, Map, Scene, Texture, TextureId};
use rtc_source::{Budget, Span};
use std::collections::BTreeMap;

/// A number that is a constant, times the red of a map.
pub(super) struct NumberOrMap {
    pub(super) number: f64,
    pub(super) map: Option<Map>,
}

/// A texture whose image is read as numbers, when it is loaded.
pub(super) struct NumberTexture {
    texture: TextureId,
    coding: NumberCoding,
    span: Span,
}

impl<'run> Lowering<'run> {
    /// A number of a BSDF: a property or a texture. With `is_inverted` it counts as 1 less itself.
    pub(super) fn number_or_map(
        &mut self,
        node: &'run PluginNode,
        name: &str,
        default: f64,
        (flip, is_inverted): (bool, bool),
    ) -> NumberOrMap {
        let signed = |number: f64| if is_inverted { 1.0 - number } else { number };
        let constant = |number: f64| NumberOrMap {
            number: signed(number),
            map: None,
        };
        // A property.
        if let Some(number) = node
            .number(name)
            .or_else(|| node.color(name).map(luminance))
        {
            return constant(number);
        }
        // A texture, by its name or as the only one.
        let texture = node.child(name).and_then(|child| self.resolve(child));
        let is_texture = |child: &&&PluginNode| child.tag == "texture";
        let texture = texture.or_else(|| node.children.iter().find(|child| is_texture(&child)));
        let Some(texture) = texture else {
            return constant(default);
        };
        let map = match texture.plugin.text.as_str() {
            "uniform" | "srgb" => {
                let value = texture.color("value").or_else(|| texture.color("color"));
                return constant(value.map_or(default, luminance));
            }
            "bitmap" => self.numbers_of_bitmap(texture, flip, is_inverted),
            "checkerboard" => {
                let (colors, squares) = checkerboard_colors(texture, flip);
                let greys = colors.map(|color| [signed(luminance(color)); 3]);
                self.record(EntityKind::Texture, self.scene.textures.len(), texture.span);
                Some(checkerboard(greys, squares, &mut self.scene))
            }
            _ => {
                let name = &node.plugin.text;
                let consequence = format!("it is left out of `{name}`");
                self.unsupported(texture, &consequence);
                return constant(default);
            }
        };
        match map {
            None => constant(default),
            Some(_) => NumberOrMap { number: 1.0, map },
        }
    }

    fn numbers_of_bitmap(
        &mut self,
        texture: &'run PluginNode,
        flip: bool,
        is_inverted: bool,
    ) -> Option<Map> {
        let map = self.texture(texture, flip)?;
        self.numbers.push(NumberTexture {
            texture: map.texture,
            coding: NumberCoding {
                source: NumberSource::Luminance,
                is_linear: texture.flag("raw") == Some(true),
                is_inverted,
            },
            span: texture.span,
        });
        Some(map)
    }
}

/// Gives textures of numbers the images of these, when the pictures are loaded.
pub(super) fn read_numbers(
    scene: &mut Scene,
    numbers: &[NumberTexture],
    budget: &Budget,
    sink: &mut DiagnosticSink,
) {
    let mut made: BTreeMap<(u32, NumberCoding), ImageId> = BTreeMap::new();
    for NumberTexture {
        texture,
        coding,
        span,
    } in numbers
    {
        let Some(Texture::Sampled(sampled)) = scene.textures.get(texture.0 as usize) else {
            continue;
        };
        let key = (sampled.image.0, *coding);
        let known = made.get(&key).copied();
        let Some(image) = scene.images.get(sampled.image.0 as usize) else {
            continue;
        };
        let id = match known {
            Some(id) => id,
            None => match coding.image(image, budget) {
                Ok(image) => scene.add_image(image),
                Err(limit) => {
                    sink.push(over_limit("the texture", &limit).at(*span, ""));
                    return;
                }
            },
        };
        made.insert(key, id);
        if let Some(Texture::Sampled(sampled)) = scene.textures.get_mut(texture.0 as usize) {
            sampled.image = id;
        }
    }
}
