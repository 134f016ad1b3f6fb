//! Numbers of BSDFs that textures vary: opacities, weights and heights.

use super::Lowering;
use super::bsdf::checkerboard_colors;
use super::plugins::TEXTURES;
use super::xml::PluginNode;
use crate::exchange::checkerboard::checkerboard;
use crate::exchange::number::{NumberCoding, NumberSource, in_channel, linear_colors};
use crate::over_limit;
use rtc_color::luminance;
use rtc_diag::DiagnosticSink;
use rtc_ir::{EntityKind, Image, ImageId, Map, Scene, Texture, TextureId};
use rtc_source::{Budget, LimitExceeded, Span};
use std::collections::BTreeMap;

/// How the texture of a number is read.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct NumberUse {
    /// Whether v points down.
    pub(super) flip: bool,
    /// Whether a number counts as 1 less itself.
    pub(super) is_inverted: bool,
    /// The only channel of the map that has the number; `None` for all.
    pub(super) channel: Option<usize>,
}

impl NumberUse {
    pub(super) fn of(flip: bool) -> Self {
        Self {
            flip,
            ..Self::default()
        }
    }
}

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
    /// As [`Self::number_or_map`], of one of several textures: by its name alone.
    pub(super) fn number_or_map_named(
        &mut self,
        node: &'run PluginNode,
        name: &str,
        default: f64,
        how: NumberUse,
    ) -> NumberOrMap {
        if node.get(name).is_none() && node.child(name).is_none() {
            let number = default;
            return NumberOrMap { number, map: None };
        }
        self.number_or_map(node, name, default, how)
    }

    /// A number of a BSDF: a property or a texture.
    pub(super) fn number_or_map(
        &mut self,
        node: &'run PluginNode,
        name: &str,
        default: f64,
        how: NumberUse,
    ) -> NumberOrMap {
        let NumberUse {
            flip,
            is_inverted,
            channel,
        } = how;
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
        let mut children = node.children.iter();
        let texture = texture.or_else(|| {
            let child = children
                .find(|child| child.tag == "texture" || self.refers_to(child, "texture"))?;
            self.resolve(child)
        });
        let Some(texture) = texture else {
            return constant(default);
        };
        if let Some(color) = texture.constant() {
            return constant(luminance(color));
        }
        let map = match TEXTURES.known(&texture.plugin.text) {
            "bitmap" => self.numbers_of_bitmap(texture, how),
            "checkerboard" => {
                let (colors, squares) = checkerboard_colors(texture, flip);
                let greys = colors.map(|color| in_channel(signed(luminance(color)), channel));
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

    fn numbers_of_bitmap(&mut self, texture: &'run PluginNode, how: NumberUse) -> Option<Map> {
        let map = self.texture(texture, how.flip)?;
        self.numbers.push(NumberTexture {
            texture: map.texture,
            coding: NumberCoding {
                source: NumberSource::Luminance,
                is_linear: texture.flag("raw") == Some(true),
                is_inverted: how.is_inverted,
                channel: how.channel,
            },
            span: texture.span,
        });
        Some(map)
    }
}

/// Gives textures whose colours are raw the images of these, when the pictures are loaded.
pub(super) fn read_raw_colors(
    scene: &mut Scene,
    raw: &[(TextureId, Span)],
    budget: &Budget,
    sink: &mut DiagnosticSink,
) {
    let textures = raw.iter().map(|(texture, span)| (*texture, (), *span));
    let made = replace_images(scene, textures, |image, ()| linear_colors(image, budget));
    report_limit(made, sink);
}

/// Gives textures of numbers the images of these, when the pictures are loaded.
pub(super) fn read_numbers(
    scene: &mut Scene,
    numbers: &[NumberTexture],
    budget: &Budget,
    sink: &mut DiagnosticSink,
) {
    let textures = (numbers.iter()).map(|number| (number.texture, number.coding, number.span));
    let made = replace_images(scene, textures, |image, coding| {
        coding.image(image, budget).map(Some)
    });
    report_limit(made, sink);
}

/// Gives textures other images, each made once for an image and a coding; `None` keeps the
/// image.
fn replace_images<K: Copy + Ord>(
    scene: &mut Scene,
    textures: impl Iterator<Item = (TextureId, K, Span)>,
    make: impl Fn(&Image, K) -> Result<Option<Image>, LimitExceeded>,
) -> Result<(), (LimitExceeded, Span)> {
    let mut made: BTreeMap<(u32, K), ImageId> = BTreeMap::new();
    for (texture, coding, span) in textures {
        let Some(Texture::Sampled(sampled)) = scene.textures.get(texture.0 as usize) else {
            continue;
        };
        let from = sampled.image;
        let Some(image) = scene.images.get(from.0 as usize) else {
            continue;
        };
        let id = match made.get(&(from.0, coding)) {
            Some(id) => *id,
            None => match make(image, coding).map_err(|limit| (limit, span))? {
                Some(image) => scene.add_image(image),
                None => from,
            },
        };
        made.insert((from.0, coding), id);
        if let Some(Texture::Sampled(sampled)) = scene.textures.get_mut(texture.0 as usize) {
            sampled.image = id;
        }
    }
    Ok(())
}

fn report_limit(made: Result<(), (LimitExceeded, Span)>, sink: &mut DiagnosticSink) {
    if let Err((limit, span)) = made {
        sink.push(over_limit("the texture", &limit).at(span, ""));
    }
}
