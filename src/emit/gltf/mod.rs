//! The IR to glTF 2.0, as one binary file or as several.
//!
//! Shapes become meshes, Phong's model the nearest metallic-roughness material. What glTF has no
//! words for goes into `extras.rtc`, value by value; each such place is told.

mod camera;
mod chunk;
mod document;
mod form;
mod light;
mod material;
mod mesh;
mod phong;
mod settings;
mod texture;
mod told;
mod writer;

use super::told::Told;
use document::{Asset, Buffer, Index};
use rtc_diag::{Sink, codes};
use rtc_ir::{EntityKind, Field, Scene, SourceSpans, ValuePath};
use rtc_source::{Budget, Resource};
use std::collections::BTreeMap;
use std::io::{self, Write};
use writer::GltfWriter;

/// An asset, ready to be written.
pub struct GltfAsset {
    /// The document, as JSON.
    json: Vec<u8>,
    /// The vertices and pictures in the same file; empty if they are in others, or there are none.
    bin: Vec<u8>,
    /// The vertices and pictures in files of their own, by their paths from the folder of the asset.
    files: BTreeMap<String, Vec<u8>>,
    is_binary: bool,
}

/// Makes an asset of a proven scene. `tolerance` is the farthest that a mesh may be from the shape
/// it stands for, in scene units; without one it is a thousandth of the radius of each shape. With a
/// folder, named as the asset is to name it, vertices and pictures become files there, and the asset
/// a text.
///
/// `None` if the scene can't be written; the sink says why. It also has a note for each value that
/// is written nearly, or in words that only rtc reads, and a warning for each that is left out.
pub fn emit(
    scene: &Scene,
    source_spans: &SourceSpans,
    tolerance: Option<f64>,
    folder: Option<&str>,
    budget: &Budget,
    sink: &mut Sink,
) -> Option<GltfAsset> {
    let mut told = Told::new(source_spans, sink);
    let scene = form::only_meshes(scene, tolerance, budget, &mut told)?;
    charge_pictures(&scene, budget, &mut told)?;
    let mut writer = GltfWriter::new(&scene, folder, budget, told);
    for index in 0..scene.surfaces.len() {
        writer.surface(index)?;
    }
    writer.lights();
    writer.camera();
    writer.settings();
    writer.finish()
}

/// Charges the pictures of textures as if none became smaller; `None` if that is too much, which is
/// told.
fn charge_pictures(scene: &Scene, budget: &Budget, told: &mut Told<'_>) -> Option<()> {
    for (index, image) in scene.images.iter().enumerate() {
        if let Err(fault) = budget.charge(Resource::Memory, image.pixels.len() as u64) {
            let message = format!("the picture takes too much as a PNG: {fault}");
            let place = ValuePath::new(EntityKind::Image, index, Field::Whole);
            told.refuse(&codes::OVER_LIMIT, &message, place);
            return None;
        }
    }
    Some(())
}

impl GltfWriter<'_> {
    fn finish(mut self) -> Option<GltfAsset> {
        self.root.asset = Asset {
            generator: concat!("rtc ", env!("CARGO_PKG_VERSION")),
            version: "2.0",
        };
        if !self.bin.is_empty() {
            let byte_length = self.bin.len();
            let uri = self.folder.map(|folder| {
                let bytes = std::mem::take(&mut self.bin);
                self.file(folder, ("", "buffer", "bin"), bytes)
            });
            Index::push(&mut self.root.buffers, Buffer { byte_length, uri });
        }
        let text = match self.folder {
            Some(_) => serde_json::to_vec_pretty(&self.root),
            None => serde_json::to_vec(&self.root),
        };
        let Ok(json) = text else {
            unreachable!("a proven scene holds finite numbers, which JSON can say");
        };
        if u32::try_from(json.len() + self.bin.len() + HEADS).is_err() {
            let message = "the scene takes more than the 4 GiB that a .glb holds";
            let place = ValuePath::new(EntityKind::Settings, 0, Field::Whole);
            self.told.refuse(&codes::GLTF_UNSAID, message, place);
            return None;
        }
        Some(GltfAsset {
            json,
            bin: self.bin,
            files: self.files,
            is_binary: self.folder.is_none(),
        })
    }
}

/// Bytes of the header of a .glb and those of its chunks, and of what fills them up.
const HEADS: usize = 12 + 8 + 8 + 6;

impl GltfAsset {
    /// The files that it names, by their paths from its folder, with `/`.
    pub fn files(&self) -> impl Iterator<Item = (&str, &[u8])> {
        let files = self.files.iter();
        files.map(|(name, bytes)| (name.as_str(), bytes.as_slice()))
    }

    /// Writes it, but for those files.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write(&self, out: &mut dyn Write) -> io::Result<()> {
        if !self.is_binary {
            out.write_all(&self.json)?;
            return out.write_all(b"\n");
        }
        let chunks = [(b"JSON", &self.json, b' '), (b"BIN\0", &self.bin, 0)];
        let chunks = chunks.iter().filter(|(_, bytes, _)| !bytes.is_empty());
        let padded = |bytes: &[u8]| bytes.len().next_multiple_of(4);
        let total: usize = chunks.clone().map(|(_, bytes, _)| 8 + padded(bytes)).sum();
        out.write_all(b"glTF")?;
        out.write_all(&2_u32.to_le_bytes())?;
        out.write_all(&word(12 + total)?)?;
        for (kind, bytes, padding) in chunks {
            out.write_all(&word(padded(bytes))?)?;
            out.write_all(*kind)?;
            out.write_all(bytes)?;
            out.write_all(&vec![*padding; padded(bytes) - bytes.len()])?;
        }
        Ok(())
    }
}

/// A length as a .glb holds it, of 32 bits.
fn word(length: usize) -> io::Result<[u8; 4]> {
    let length = u32::try_from(length).map_err(io::Error::other)?;
    Ok(length.to_le_bytes())
}
