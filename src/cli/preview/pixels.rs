//! What a pixel of the finished picture shows: its value, which surface is met there and how far away,
//! and the line that says it.

use crate::image::{Image, Layers};
use crate::ir::{Field, Noun, Place};
use crate::pipeline::{Input, Proven};
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// The numbers of all pixels.
pub(super) struct PixelTable {
    size: [u32; 2],
    values: Vec<[f32; 3]>,
    /// The number of the surface and its distance, for each pixel.
    hits: Vec<(u32, f32)>,
    /// The place of each surface that is seen, as `file:line`.
    lines: BTreeMap<u32, String>,
}

impl PixelTable {
    /// That of a picture, by its values before the tone map and its layers `instance.X` and `depth.Z`.
    pub(super) fn new(image: &Image, layers: &Layers, proven: &Proven, input: &Input) -> Self {
        let hit = |pair: &[f32; 2]| (pair[0] as u32, pair[1]);
        let (pairs, _) = layers.values.as_chunks::<2>();
        let hits: Vec<_> = pairs.iter().map(hit).collect();
        let mut lines = BTreeMap::new();
        for (number, _) in &hits {
            let Some(index) = number.checked_sub(1) else {
                continue;
            };
            lines.entry(*number).or_insert_with(|| {
                let place = Place::new(Noun::Surface, index as usize, Field::Whole);
                let span = proven.lowered.origins.span(place);
                let line = span.map(|span| input.line(span));
                line.map_or_else(String::new, |(file, line)| format!("{file}:{line}"))
            });
        }
        let value = |pixel: &[f64; 3]| pixel.map(|channel| channel as f32);
        Self {
            size: [image.width, image.height],
            values: image.pixels.iter().map(value).collect(),
            hits,
            lines,
        }
    }

    /// What is said of a pixel; none of one outside.
    pub(super) fn told(&self, x: u32, y: u32) -> Option<Value> {
        let [width, height] = self.size;
        if x >= width || y >= height {
            return None;
        }
        let index = y as usize * width as usize + x as usize;
        let value = self.values.get(index)?;
        let (number, depth) = self.hits.get(index).copied().unwrap_or_default();
        let is_hit = number > 0;
        Some(json!({
            "x": x,
            "y": y,
            "value": value,
            "surface": is_hit.then_some(number),
            "depth": is_hit.then_some(depth),
            "line": self.lines.get(&number).filter(|line| !line.is_empty()),
        }))
    }
}
