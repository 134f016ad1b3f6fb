//! The readout of a pixel of the finished picture: its value, the surface hit there with its
//! distance and name, and the line of its source.

use super::findings::ServedFolder;
use rtc_image::{Image, PixelLayers};
use rtc_ir::{EntityField, EntityKind, ValuePath};
use rtc_pipeline::{Input, ValidatedScene};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::path::Path;

/// The numbers of all pixels.
pub(super) struct PixelTable {
    size: [u32; 2],
    values: Vec<[f32; 3]>,
    /// The number of the surface and its distance, for each pixel.
    hits: Vec<(u32, f32)>,
    /// The name, or the shape, of each visible surface, and its source as `file:line`: relative to
    /// the scene, and as the terminal names it.
    surfaces: BTreeMap<u32, [String; 3]>,
}

impl PixelTable {
    /// The readout of a picture, from its values before the tone map and its layers `instance.X`
    /// and `depth.Z`.
    pub(super) fn new(
        image: &Image,
        layers: &PixelLayers,
        validated: &ValidatedScene,
        input: &Input,
    ) -> Self {
        let hit = |pair: &[f32; 2]| (pair[0] as u32, pair[1]);
        let (pairs, _) = layers.values.as_chunks::<2>();
        let hits: Vec<_> = pairs.iter().map(hit).collect();
        let mut surfaces = BTreeMap::new();
        for (number, _) in &hits {
            if let Some(index) = number.checked_sub(1) {
                let reported = || surface(index as usize, validated, input);
                surfaces.entry(*number).or_insert_with(reported);
            }
        }
        let value = |pixel: &[f64; 3]| pixel.map(|channel| channel as f32);
        Self {
            size: [image.width, image.height],
            values: image.pixels.iter().map(value).collect(),
            hits,
            surfaces,
        }
    }

    /// The readout of a pixel; `None` outside of the picture.
    pub(super) fn reported(&self, x: u32, y: u32) -> Option<Value> {
        let [width, height] = self.size;
        if x >= width || y >= height {
            return None;
        }
        let index = y as usize * width as usize + x as usize;
        let value = self.values.get(index)?;
        let (number, depth) = self.hits.get(index).copied().unwrap_or_default();
        let is_hit = number > 0;
        let message = self.surfaces.get(&number);
        let [name, line, place] =
            [0, 1, 2].map(|at| message.map(|own| &own[at]).filter(|own| !own.is_empty()));
        Some(json!({
            "x": x,
            "y": y,
            "value": value,
            "surface": is_hit.then_some(number),
            "depth": is_hit.then_some(depth),
            "name": name,
            "line": line,
            "place": place,
        }))
    }
}

/// The name of a surface, or else its shape; and its source.
fn surface(index: usize, validated: &ValidatedScene, input: &Input) -> [String; 3] {
    let scene = &validated.lowered.scene;
    let name = scene.names.get(index).filter(|name| !name.is_empty());
    let shape = scene.surfaces.get(index).map(|own| own.shape.kind().name());
    let path = ValuePath::new(EntityKind::Surface, index, EntityField::Whole);
    let span = validated.lowered.source_spans.span(path);
    let place = span.map(|span| input.line(span));
    let place = place.map_or_else(String::new, |(file, line)| format!("{file}:{line}"));
    [
        name.cloned()
            .or(shape.map(str::to_owned))
            .unwrap_or_default(),
        ServedFolder::of(Path::new(input.name())).relative(&place),
        place,
    ]
}
