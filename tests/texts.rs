//! Scenes written as texts with files beside them, and read again from those alone.

use rtc::internals::codec;
use rtc::internals::diag::DiagnosticSink;
use rtc::internals::emit::course::{WrittenScene, emit_with_files};
use rtc::internals::ir::{ImageId, Material, MaterialId, MeshId, Scene, Shape, Texture, TextureId};
use rtc::internals::pipeline::{self, Options};
use rtc::internals::source::{Loader, SourceMap};
use std::fs;

/// Asserts that a scene comes back from a text, in a folder that holds nothing else but the files
/// that it names.
pub(crate) fn assert_comes_back(scene: &Scene) {
    let (expected, back) = (canonical(scene), canonical(&there_and_back(scene)));
    // Told part by part: all of it would be many pages.
    assert_eq!(expected.camera, back.camera);
    assert_eq!(expected.settings, back.settings);
    assert_eq!(expected.display, back.display);
    assert_eq!(expected.lights, back.lights);
    assert_eq!(expected.environment, back.environment);
    assert_eq!(expected.materials, back.materials);
    assert_eq!(expected.textures, back.textures);
    assert_eq!(expected.surfaces, back.surfaces);
    assert!(expected == back, "an image, a mesh or a name differs");
    let hash = |scene| codec::hash(scene).map_err(|_| ()).unwrap();
    assert_eq!(hash(&expected), hash(&back), "the sign of a zero differs");
}

/// The scene that its text is.
fn there_and_back(scene: &Scene) -> Scene {
    let folder = tempfile::tempdir().unwrap();
    let WrittenScene { text, files } = emit_with_files(scene, Some("it.files")).unwrap();
    for file in &files {
        let path = folder.path().join(&file.name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, file.bytes().unwrap()).unwrap();
    }
    let path = folder.path().join("it.yaml");
    fs::write(&path, text).unwrap();
    let (mut map, mut sink) = (SourceMap::default(), DiagnosticSink::default());
    let file = Loader.file(&path, &mut map).unwrap();
    let lowered = pipeline::load(file, &mut map, &Options::default(), &mut sink).unwrap();
    assert!(sink.kept().is_empty(), "{:?}", sink.kept());
    lowered.scene
}

/// The scene with its materials, textures, images and meshes in the order in which its surfaces
/// come to them, without those that none comes to, equal ones once, images and meshes without
/// names; what has no name has an empty one.
fn canonical(scene: &Scene) -> Scene {
    let mut own = Scene {
        materials: Vec::new(),
        textures: Vec::new(),
        images: Vec::new(),
        meshes: Vec::new(),
        ..scene.clone()
    };
    // The materials so far, by their indices in the scene.
    let mut known = Vec::new();
    let mut surfaces = std::mem::take(&mut own.surfaces);
    for surface in &mut surfaces {
        if let Shape::Instance(instance) = &mut surface.shape {
            let mut mesh = scene.meshes[instance.mesh.0 as usize].clone();
            (mesh.name, mesh.part) = (String::new(), None);
            instance.mesh = MeshId(place(&mut own.meshes, mesh));
        }
        let MaterialId(before) = surface.material;
        let at = place(&mut known, before);
        if at as usize == own.materials.len() {
            let mut material = scene.materials[before as usize].clone();
            renumber(&mut material, scene, &mut own);
            own.materials.push(material);
        }
        surface.material = MaterialId(at);
    }
    own.surfaces = surfaces;
    if !own.names.is_empty() {
        own.names.resize(own.surfaces.len(), String::new());
    }
    if let Some(image) = scene.environment.as_ref().and_then(|around| around.image) {
        let image = image_of(image, scene, &mut own);
        own.environment.as_mut().unwrap().image = Some(image);
    }
    own
}

/// Has a material look at the textures of another scene, which come there.
fn renumber(material: &mut Material, scene: &Scene, own: &mut Scene) {
    let mut texture = |TextureId(id): &mut TextureId| {
        let texture = match scene.textures[*id as usize].clone() {
            texture @ (Texture::Uv | Texture::Procedural(_)) => texture,
            Texture::Image(image) => Texture::Image(image_of(image, scene, own)),
            Texture::Sampled(mut sampled) => {
                sampled.image = image_of(sampled.image, scene, own);
                Texture::Sampled(sampled)
            }
        };
        *id = place(&mut own.textures, texture);
    };
    match material {
        Material::Standard(standard) => {
            standard
                .maps_mut()
                .for_each(|map| texture(&mut map.texture));
        }
        Material::Phong(phong) => {
            let maps = [
                &mut phong.color_map,
                &mut phong.specular_map,
                &mut phong.normal_map,
            ];
            maps.into_iter().flatten().for_each(&mut texture);
            phong
                .bump
                .iter_mut()
                .for_each(|bump| texture(&mut bump.texture));
        }
    }
}

fn image_of(ImageId(id): ImageId, scene: &Scene, own: &mut Scene) -> ImageId {
    let mut image = scene.images[id as usize].clone();
    image.name.clear();
    ImageId(place(&mut own.images, image))
}

/// The index of an item in a list, where it is put if it is not there.
fn place<T: PartialEq>(list: &mut Vec<T>, item: T) -> u32 {
    let at = list.iter().position(|own| *own == item);
    index(at.unwrap_or_else(|| {
        list.push(item);
        list.len() - 1
    }))
}

fn index(at: usize) -> u32 {
    u32::try_from(at).unwrap()
}
