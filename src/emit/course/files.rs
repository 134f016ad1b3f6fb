//! The files that a text names: those that images and meshes came from, or new ones beside the text.

use super::quoted;
use crate::{beside, ply};
use rtc_image::{FileFormat, Image as Radiances, Picture, png_bytes};
use rtc_ir::{Image, ImageId, Material, Mesh, MeshId, Pixels, Scene};
use std::collections::BTreeMap;
use xxhash_rust::xxh3::{Xxh3, xxh3_64};

/// The word that stands for the uv of the surface in place of a file.
const UV: &str = "UV";

/// A file that a text names.
#[derive(Debug)]
pub struct Attachment<'s> {
    /// Its path from the folder of the text, with `/`.
    pub name: String,
    content: Content<'s>,
}

#[derive(Clone, Copy, Debug)]
enum Content<'s> {
    Mesh(&'s Mesh),
    Image(&'s Image),
}

impl Attachment<'_> {
    /// The bytes of the file; the same every time.
    ///
    /// # Errors
    /// The reason, in words, why there is no such file.
    pub fn bytes(&self) -> Result<Vec<u8>, String> {
        match self.content {
            Content::Mesh(mesh) => Ok(ply::encode(mesh)),
            Content::Image(image) => encode(image),
        }
    }
}

/// How images and meshes are named.
pub(super) struct FileNames<'s> {
    /// Whether files that images and meshes came from are named.
    names_known: bool,
    /// The folder of new files.
    folder: Option<String>,
    new: BTreeMap<String, Attachment<'s>>,
    /// The names so far, in quotes: a mesh of many instances is hashed once.
    of_images: BTreeMap<u32, String>,
    of_meshes: BTreeMap<u32, String>,
}

impl<'s> FileNames<'s> {
    /// By the files that they came from.
    pub(super) fn known() -> Self {
        Self {
            names_known: true,
            folder: None,
            new: BTreeMap::new(),
            of_images: BTreeMap::new(),
            of_meshes: BTreeMap::new(),
        }
    }

    /// By new files in a folder, unless the scene is of the course alone, whose images and meshes came
    /// from files.
    pub(super) fn beside(scene: &Scene, folder: Option<&str>) -> Self {
        let is_course = |material: &Material| material.phong().is_some();
        Self {
            names_known: scene.materials.iter().all(is_course),
            folder: folder.map(str::to_owned),
            ..Self::known()
        }
    }

    pub(super) fn into_files(self) -> Vec<Attachment<'s>> {
        self.new.into_values().collect()
    }

    /// The name of an image in quotes.
    pub(super) fn image(
        &mut self,
        scene: &'s Scene,
        ImageId(id): ImageId,
    ) -> Result<String, String> {
        if let Some(name) = self.of_images.get(&id) {
            return Ok(name.clone());
        }
        let image = scene
            .images
            .get(id as usize)
            .ok_or("an image is referred to that does not exist")?;
        let name = self.name(&image.name, Content::Image(image))?;
        self.of_images.insert(id, name.clone());
        Ok(name)
    }

    /// The name of the file of a mesh in quotes, and the part of it that it is.
    pub(super) fn mesh(
        &mut self,
        scene: &'s Scene,
        MeshId(id): MeshId,
    ) -> Result<(String, Option<&'s str>), String> {
        let mesh = scene
            .meshes
            .get(id as usize)
            .ok_or("a surface refers to a mesh that does not exist")?;
        if mesh.triangles.is_empty() && !self.names_known {
            return Err("a mesh has no triangles, and no file holds such a mesh".to_owned());
        }
        let part = mesh.part.as_deref().filter(|_| self.names_known);
        if let Some(name) = self.of_meshes.get(&id) {
            return Ok((name.clone(), part));
        }
        let name = self.name(&mesh.name, Content::Mesh(mesh))?;
        self.of_meshes.insert(id, name.clone());
        Ok((name, part))
    }

    fn name(&mut self, known: &str, content: Content<'s>) -> Result<String, String> {
        let known_file = file_name(known);
        if self.names_known && (known_file.is_ok() || self.folder.is_none()) {
            return known_file;
        }
        let Some(folder) = &self.folder else {
            let message = "its meshes and images are to be files beside the text: give `-o FILE`";
            return Err(message.to_owned());
        };
        let (word, extension, hash) = match content {
            Content::Mesh(mesh) => ("mesh", "ply", xxh3_64(&ply::encode(mesh))),
            Content::Image(image) => ("image", extension(image), hash(image)),
        };
        let name = beside::path(folder, known, word, hash, extension);
        let quoted = quoted(&name);
        self.new
            .entry(name.clone())
            .or_insert(Attachment { name, content });
        Ok(quoted)
    }
}

/// The name of a file in quotes, if it names one.
pub(super) fn file_name(name: &str) -> Result<String, String> {
    if name.is_empty() || name.eq_ignore_ascii_case(UV) || name.contains('\\') {
        return Err(format!(
            "an image or mesh of the name `{}` comes from no file",
            name.escape_debug()
        ));
    }
    Ok(quoted(name))
}

fn extension(image: &Image) -> &'static str {
    match image.kind {
        Pixels::Rgb8 | Pixels::Rgba8 => "png",
        Pixels::Rgb32f => "exr",
    }
}

/// The hash of what an image shows.
fn hash(image: &Image) -> u64 {
    let mut hasher = Xxh3::new();
    hasher.update(&image.width.to_le_bytes());
    hasher.update(&image.height.to_le_bytes());
    hasher.update(&(image.kind.bytes() as u64).to_le_bytes());
    hasher.update(&image.pixels);
    hasher.digest()
}

/// The pixels of an image in a file that keeps them all: PNG, or OpenEXR of 32-bit floats.
fn encode(image: &Image) -> Result<Vec<u8>, String> {
    let Image {
        name: _,
        width,
        height,
        kind,
        pixels,
    } = image;
    let size = [*width, *height];
    let wanted = (u64::from(*width) * u64::from(*height)).saturating_mul(kind.bytes() as u64);
    if pixels.len() as u64 != wanted || wanted == 0 {
        return Err("an image has not the pixels that it should have".to_owned());
    }
    let encoded = match kind {
        Pixels::Rgb8 => Ok(png_bytes(size, false, pixels)),
        Pixels::Rgba8 => Ok(png_bytes(size, true, pixels)),
        Pixels::Rgb32f => {
            let channels = pixels.as_chunks::<4>().0.iter();
            let channels: Vec<f64> = channels
                .map(|bytes| f64::from(f32::from_le_bytes(*bytes)))
                .collect();
            let picture = Picture::opaque(Radiances {
                width: *width,
                height: *height,
                pixels: channels.as_chunks::<3>().0.to_vec(),
            });
            picture.encode(FileFormat::Exr)
        }
    };
    encoded.map_err(|fault| fault.to_string())
}
