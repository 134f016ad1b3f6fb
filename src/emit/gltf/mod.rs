//! The IR to glTF 2.0, as one binary file or as several, in the types of `gltf::json`.
//!
//! Shapes become meshes, Phong's model the nearest metallic-roughness material. What glTF has no
//! words for goes into `extras.rtc`, value by value; each such place is told.

mod camera;
mod chunk;
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
use crate::diag::{Sink, codes};
use crate::ir::{Field, Noun, Origins, Place, Scene};
use crate::source::{Budget, Resource};
use gltf::binary::{Glb, Header};
use gltf::json;
use json::validation::USize64;
use std::borrow::Cow;
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
    origins: &Origins,
    tolerance: Option<f64>,
    folder: Option<&str>,
    budget: &Budget,
    sink: &mut Sink,
) -> Option<GltfAsset> {
    let mut told = Told::new(origins, sink);
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
            let place = Place::new(Noun::Image, index, Field::Whole);
            told.refuse(&codes::OVER_LIMIT, &message, place);
            return None;
        }
    }
    Some(())
}

impl GltfWriter<'_> {
    fn finish(mut self) -> Option<GltfAsset> {
        let nodes = std::mem::take(&mut self.nodes);
        let scene = json::Scene {
            extensions: None,
            extras: None,
            name: None,
            nodes,
        };
        self.root.scene = Some(self.root.push(scene));
        self.root.asset.generator = Some(concat!("rtc ", env!("CARGO_PKG_VERSION")).to_owned());
        self.root.extensions_used = self.used.iter().map(|name| (*name).to_owned()).collect();
        if !self.bin.is_empty() {
            let byte_length = USize64::from(self.bin.len());
            let uri = self.folder.map(|folder| {
                let bytes = std::mem::take(&mut self.bin);
                self.file(folder, ("", "buffer", "bin"), bytes)
            });
            self.root.push(json::Buffer {
                byte_length,
                name: None,
                uri,
                extensions: None,
                extras: None,
            });
        }
        let text = self.root.to_value().and_then(|mut document| {
            for (pointer, number) in self.exact.drain(..) {
                if let Some(place) = document.pointer_mut(&pointer) {
                    *place = number;
                }
            }
            match self.folder {
                Some(_) => serde_json::to_vec_pretty(&document),
                None => serde_json::to_vec(&document),
            }
        });
        let Ok(json) = text else {
            unreachable!("a proven scene holds finite numbers, which JSON can say");
        };
        if u32::try_from(json.len() + self.bin.len() + HEADS).is_err() {
            let message = "the scene takes more than the 4 GiB that a .glb holds";
            let place = Place::new(Noun::Settings, 0, Field::Whole);
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
        let glb = Glb {
            header: Header {
                magic: *b"glTF",
                version: 2,
                length: 0,
            },
            json: Cow::Borrowed(&self.json),
            bin: (!self.bin.is_empty()).then_some(Cow::Borrowed(&self.bin)),
        };
        glb.to_writer(out).map_err(io::Error::other)
    }
}
