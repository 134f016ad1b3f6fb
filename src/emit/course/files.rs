//! The files to which a text refers: the original files of images and meshes, or new sidecar files.

use super::quoted;
use crate::export::joined;
use crate::{ply, sidecar};
use rtc_image::{FileFormat, Image as Radiances, Picture, png_bytes};
use rtc_ir::{Image, ImageId, Material, Mesh, MeshId, Photometry, Pixels, Scene};
use std::collections::BTreeMap;
use xxhash_rust::xxh3::{Xxh3, xxh3_64};

/// The name of the texture of surface coordinates, which is not a file.
const UV: &str = "UV";

/// A file to which a text refers.
#[derive(Debug)]
pub struct SidecarFile<'s> {
    /// Its path relative to the folder of the text, with `/`.
    pub name: String,
    content: SidecarContent<'s>,
}

#[derive(Clone, Copy, Debug)]
enum SidecarContent<'s> {
    Mesh(&'s Mesh),
    Image(&'s Image),
    Photometry(&'s Photometry),
}

impl SidecarFile<'_> {
    /// The bytes of the file; always the same.
    ///
    /// # Errors
    /// A message, if there is no such file.
    pub fn bytes(&self) -> Result<Vec<u8>, String> {
        match self.content {
            SidecarContent::Mesh(mesh) => Ok(ply::encode(mesh)),
            SidecarContent::Image(image) => encode(image),
            SidecarContent::Photometry(photometry) => Ok(profile(photometry).into_bytes()),
        }
    }
}

/// The names of the files of images, meshes and lamps.
pub(super) struct FileNames<'s> {
    /// Whether the original file names are used.
    uses_original_names: bool,
    /// The folder of new files.
    folder: Option<String>,
    new: BTreeMap<String, SidecarFile<'s>>,
    /// The quoted names so far: a mesh with many instances is hashed once.
    of_images: BTreeMap<u32, String>,
    of_meshes: BTreeMap<u32, String>,
}

impl<'s> FileNames<'s> {
    /// Uses the original files.
    pub(super) fn original() -> Self {
        Self {
            uses_original_names: true,
            folder: None,
            new: BTreeMap::new(),
            of_images: BTreeMap::new(),
            of_meshes: BTreeMap::new(),
        }
    }

    /// Writes new files to a folder, unless the scene has Phong materials only: then its images and
    /// meshes come from files.
    pub(super) fn with_new_files(scene: &Scene, folder: Option<&str>) -> Self {
        let is_course = |material: &Material| material.phong().is_some();
        Self {
            uses_original_names: scene.materials.iter().all(is_course),
            folder: folder.map(str::to_owned),
            ..Self::original()
        }
    }

    /// Writes new files to a folder for all images and meshes.
    pub(super) fn all_new(folder: &str) -> Self {
        Self {
            uses_original_names: false,
            folder: Some(folder.to_owned()),
            ..Self::original()
        }
    }

    pub(super) fn into_files(self) -> Vec<SidecarFile<'s>> {
        self.new.into_values().collect()
    }

    /// The quoted name of an image.
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
        let name = self.name(&image.name, SidecarContent::Image(image))?;
        self.of_images.insert(id, name.clone());
        Ok(name)
    }

    /// The quoted file name of a mesh, and the part of the file.
    pub(super) fn mesh(
        &mut self,
        scene: &'s Scene,
        MeshId(id): MeshId,
    ) -> Result<(String, Option<&'s str>), String> {
        let mesh = scene
            .meshes
            .get(id as usize)
            .ok_or("a surface refers to a mesh that does not exist")?;
        if mesh.triangles.is_empty() && !self.uses_original_names {
            return Err("a mesh has no triangles, and no file holds such a mesh".to_owned());
        }
        let part = mesh.part.as_deref().filter(|_| self.uses_original_names);
        if let Some(name) = self.of_meshes.get(&id) {
            return Ok((name.clone(), part));
        }
        let name = self.name(&mesh.name, SidecarContent::Mesh(mesh))?;
        self.of_meshes.insert(id, name.clone());
        Ok((name, part))
    }

    /// The quoted file name of the profile of a lamp.
    pub(super) fn photometry(&mut self, photometry: &'s Photometry) -> Result<String, String> {
        self.name(&photometry.name, SidecarContent::Photometry(photometry))
    }

    fn name(&mut self, original: &str, content: SidecarContent<'s>) -> Result<String, String> {
        let original_file = file_name(original);
        if self.uses_original_names && (original_file.is_ok() || self.folder.is_none()) {
            return original_file;
        }
        let Some(folder) = &self.folder else {
            let message = "its meshes and images are files beside the text: give `-o FILE`";
            return Err(message.to_owned());
        };
        let (fallback, extension, hash) = match content {
            SidecarContent::Mesh(mesh) => ("mesh", "ply", xxh3_64(&ply::encode(mesh))),
            SidecarContent::Image(image) => ("image", extension(image), hash(image)),
            SidecarContent::Photometry(photometry) => {
                ("lamp", "ies", xxh3_64(profile(photometry).as_bytes()))
            }
        };
        let name = sidecar::path(folder, original, fallback, hash, extension);
        let quoted = quoted(&name);
        self.new
            .entry(name.clone())
            .or_insert(SidecarFile { name, content });
        Ok(quoted)
    }
}

/// A file name in quotes, if it is one.
fn file_name(name: &str) -> Result<String, String> {
    if name.is_empty() || name.eq_ignore_ascii_case(UV) || name.contains('\\') {
        return Err(format!(
            "an image, mesh or lamp of the name `{}` comes from no file",
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

/// The hash of the content of an image.
fn hash(image: &Image) -> u64 {
    let mut hasher = Xxh3::new();
    hasher.update(&image.width.to_le_bytes());
    hasher.update(&image.height.to_le_bytes());
    hasher.update(&(image.kind.bytes() as u64).to_le_bytes());
    hasher.update(&image.pixels);
    hasher.digest()
}

/// A photometric profile as an IES file (LM-63-2002, type C) of one lamp, in candela.
fn profile(photometry: &Photometry) -> String {
    let Photometry {
        name: _,
        vertical,
        horizontal,
        candela,
    } = photometry;
    let [rows, columns] = [vertical.len(), horizontal.len()];
    let list = |numbers: &[f64]| joined(numbers.iter().copied(), "\n");
    let [vertical, horizontal, candela] =
        [vertical, horizontal, candela].map(|list_of| list(list_of));
    format!(
        "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 {rows} {columns} 1 2 0 0 0\n1 1 0\n{vertical}\n\
         {horizontal}\n{candela}\n"
    )
}

/// An image as a file without loss: PNG, or OpenEXR with 32-bit floats.
fn encode(image: &Image) -> Result<Vec<u8>, String> {
    let Image {
        name: _,
        width,
        height,
        kind,
        pixels,
    } = image;
    let size = [*width, *height];
    let expected = (u64::from(*width) * u64::from(*height)).saturating_mul(kind.bytes() as u64);
    if pixels.len() as u64 != expected || expected == 0 {
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
    encoded.map_err(|error| error.to_string())
}
