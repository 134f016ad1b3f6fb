//! Writes the IR as glTF 2.0, as one binary file or as several files.
//!
//! # Steps
//! 1. `tessellate` tessellates shapes into meshes.
//! 2. [`GltfWriter`] adds surfaces (`mesh`, `material`, `texture`), lights, the camera and
//!    settings to the [`document`].
//! 3. `finish` adds the buffer and makes a [`GltfAsset`], which can be written.
//!
//! The Phong model is approximated by the metallic-roughness model. Values that glTF can't express
//! go to `extras.rtc`, which only rtc reads; each such value is reported.

mod camera;
mod document;
mod light;
mod material;
mod mesh;
mod pattern;
mod settings;
mod texture;
mod writer;

use super::reporter::ExportReporter;
use super::tessellate::{TargetFormat, with_meshes};
use document::{Asset, Buffer, GltfIndex};
use rtc_diag::{DiagnosticSink, codes};
use rtc_ir::{EntityField, EntityKind, Scene, SourceSpans, ValuePath};
use rtc_source::{Budget, Resource};
use std::collections::BTreeMap;
use std::io::{self, Write};
use writer::GltfWriter;

/// An asset that is ready to be written.
pub struct GltfAsset {
    /// The document as JSON.
    json: Vec<u8>,
    /// The binary chunk: vertices and images; empty if there are none or they are in other files.
    bin: Vec<u8>,
    /// Sidecar files with vertices and images, by their paths relative to the asset.
    files: BTreeMap<String, Vec<u8>>,
    is_binary: bool,
}

const FORMAT: TargetFormat = TargetFormat {
    name: "glTF",
    approximated: &codes::GLTF_APPROXIMATED,
    has: |_, _| false,
};

/// Converts a valid scene to glTF. `tolerance` is the maximum distance between a mesh and its shape
/// in scene units; by default it is a thousandth of the radius of each shape. With `folder`, a path
/// relative to the asset, vertices and images become files there and the asset is JSON text.
///
/// `None` if the scene can't be written; the sink has the error. It also has a note for each value
/// that is approximated or written to `extras.rtc`, and a warning for each that is dropped.
pub fn emit(
    scene: &Scene,
    source_spans: &SourceSpans,
    tolerance: Option<f64>,
    folder: Option<&str>,
    budget: &Budget,
    sink: &mut DiagnosticSink,
) -> Option<GltfAsset> {
    let mut reporter = ExportReporter::new(source_spans, sink);
    let scene = with_meshes(scene, &FORMAT, tolerance, budget, &mut reporter)?;
    charge_pictures(&scene, budget, &mut reporter)?;
    let mut writer = GltfWriter::new(&scene, folder, budget, reporter);
    for index in 0..scene.surfaces.len() {
        writer.surface(index)?;
    }
    writer.lights();
    writer.camera();
    writer.settings();
    writer.finish()
}

/// Charges the images of textures as if none were compressed; `None` if they exceed the budget,
/// which is reported.
fn charge_pictures(
    scene: &Scene,
    budget: &Budget,
    reporter: &mut ExportReporter<'_>,
) -> Option<()> {
    for (index, image) in scene.images.iter().enumerate() {
        if let Err(error) = budget.charge(Resource::Memory, image.pixels.len() as u64) {
            let message = format!("the picture takes too much as a PNG: {error}");
            let path = ValuePath::new(EntityKind::Image, index, EntityField::Whole);
            reporter.report_error(&codes::OVER_LIMIT, &message, path);
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
            GltfIndex::push(&mut self.root.buffers, Buffer { byte_length, uri });
        }
        let text = match self.folder {
            Some(_) => serde_json::to_vec_pretty(&self.root),
            None => serde_json::to_vec(&self.root),
        };
        let Ok(json) = text else {
            unreachable!("a valid scene has only finite numbers");
        };
        if u32::try_from(json.len() + self.bin.len() + HEADS).is_err() {
            let message = "the scene takes more than the 4 GiB that a .glb holds";
            let path = ValuePath::new(EntityKind::Settings, 0, EntityField::Whole);
            self.reporter
                .report_error(&codes::GLTF_UNSAID, message, path);
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

/// The size of the .glb header, chunk headers and padding, in bytes.
const HEADS: usize = 12 + 8 + 8 + 6;

impl GltfAsset {
    /// The sidecar files, by their paths relative to the asset, with `/`.
    pub fn files(&self) -> impl Iterator<Item = (&str, &[u8])> {
        let files = self.files.iter();
        files.map(|(name, bytes)| (name.as_str(), bytes.as_slice()))
    }

    /// Writes the asset without its sidecar files.
    ///
    /// # Errors
    /// The fields of `out`.
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
        out.write_all(&u32_bytes(12 + total)?)?;
        for (kind, bytes, padding) in chunks {
            out.write_all(&u32_bytes(padded(bytes))?)?;
            out.write_all(*kind)?;
            out.write_all(bytes)?;
            out.write_all(&vec![*padding; padded(bytes) - bytes.len()])?;
        }
        Ok(())
    }
}

/// A length as a u32 of a .glb.
fn u32_bytes(length: usize) -> io::Result<[u8; 4]> {
    let length = u32::try_from(length).map_err(io::Error::other)?;
    Ok(length.to_le_bytes())
}
