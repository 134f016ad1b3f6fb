//! Scenes written as .glb and read back.

use super::{emitted, is_near, open, read, read_text, scene, with_files, write};
use crate::suite::{absent, files, name, root, shared, trial, trial_if};
use libtest_mimic::Trial;
use rtc::internals::diag::{DiagnosticSink, Severity};
use rtc::internals::ir::{
    Camera, Environment, Filter, Image, Light, LoweredScene, Map, Material, Mesh, Pixels, Punctual,
    PunctualKind, Sampled, Scene, Shape, Surface, Texture, TextureId, VertexColumn, Wrap,
};
use rtc::internals::pipeline::{self, Options};
use serde_json::Value;
use std::path::{Path, PathBuf};

pub(crate) fn trials() -> Vec<Trial> {
    let own = files(&root("scenes"), &["yaml", "glb"]);
    let mut trials: Vec<Trial> = own.iter().map(|path| text_of(path)).collect();
    trials.extend(of_files("scenes", &root("scenes"), own));
    let assets = files(&root("tests/gltf/assets"), &["glb"]);
    trials.extend(of_files("assets", &root("tests/gltf/assets"), assets));
    for (folder, extensions) in [
        ("course/scenes", &["yaml"][..]),
        ("wild", &["yaml", "yml"]),
        ("gltf/assets", &["glb", "gltf"]),
    ] {
        match shared(folder) {
            Some(path) => trials.extend(of_files(folder, &path, files(&path, extensions))),
            None => trials.push(absent(format!("to glTF: {folder}"), folder)),
        }
    }
    trials.extend([
        trial("to glTF: every light comes back", lights_come_back),
        trial("to glTF: every camera comes back", cameras_come_back),
        trial(
            "to glTF: tangents of a surface come back",
            tangents_come_back,
        ),
        trial(
            "to glTF: what is left out is told",
            what_is_left_out_is_told,
        ),
        trial("to glTF: surroundings come back", surroundings_come_back),
        trial(
            "to glTF: pixels that are no rows are refused",
            odd_pixels_are_refused,
        ),
        trial(
            "to glTF: settings and shadows come back",
            settings_come_back,
        ),
    ]);
    trials
}

fn text_of(path: &Path) -> Trial {
    let path = path.to_owned();
    let name = format!("to glTF: text/{}", name(&path, &root("scenes")));
    trial(name, move || comes_back_from_text(&open(&path).unwrap()))
}

fn of_files(what: &str, folder: &Path, paths: Vec<PathBuf>) -> Vec<Trial> {
    let test = |path: PathBuf| {
        let name = format!("to glTF: {what}/{}", name(&path, folder));
        trial_if(name, move || {
            comes_back(&open(&path).ok_or("what is no scene has no other form")?);
            Ok(())
        })
    };
    paths.into_iter().map(test).collect()
}

/// A scene is written without an error, twice the same, and is itself again.
fn comes_back(lowered: &LoweredScene) {
    let (bytes, sink) = write(lowered, None);
    let told: Vec<_> = sink
        .kept()
        .iter()
        .filter(|finding| finding.severity == Severity::Error)
        .collect();
    let bytes = bytes.unwrap_or_else(|| panic!("{told:#?}"));
    assert_eq!(Some(&bytes), write(lowered, None).0.as_ref(), "same bytes");
    let (before, after) = (&lowered.scene, &read(&bytes).scene);
    same_surroundings(before, after);
    assert_eq!(before.settings, after.settings);
    assert_eq!(before.display, after.display);
    same_camera(&before.camera, &after.camera);
    assert_eq!(before.lights.len(), after.lights.len());
    for (before, after) in before.lights.iter().zip(&after.lights) {
        same_light(before, after);
    }
    same_surfaces(before, after);
}

/// As a text with files beside it a scene is what it is as one file.
fn comes_back_from_text(lowered: &LoweredScene) {
    let asset = emitted(lowered, None, Some(FOLDER)).0.unwrap();
    let from_text = read_text(&super::bytes(&asset), &asset).scene;
    let from_one = read(&write(lowered, None).0.unwrap()).scene;
    assert!(from_text == from_one, "with files beside it");
}

/// A name that a URI escapes.
const FOLDER: &str = "a scene.files";

fn same_surroundings(before: &Scene, after: &Scene) {
    let parts = |scene: &Scene| {
        let own = scene.environment.as_ref()?;
        let image = own
            .image
            .map(|image| scene.images[image.0 as usize].clone());
        Some((own.radiance, own.image_from_world, image))
    };
    assert!(
        parts(before) == parts(after),
        "{:?} {:?}",
        before.environment,
        after.environment
    );
}

fn same_camera(before: &Camera, after: &Camera) {
    let parts = |camera: &Camera| [camera.eye, camera.center, camera.right, camera.up];
    let reach = before
        .eye
        .iter()
        .chain(&before.center)
        .fold(0.0_f64, |reach, number| reach.max(number.abs()));
    let pixel = before
        .up
        .iter()
        .fold(0.0_f64, |size, step| size.max(step.abs()));
    for (at, (a, b)) in parts(before).into_iter().zip(parts(after)).enumerate() {
        let size = if at < 2 { reach } else { pixel };
        let near = a.into_iter().zip(b).all(|(a, b)| is_near(a, b, size));
        assert!(near, "{before:?}\n{after:?}");
    }
    assert_eq!(
        (before.size, &before.lens, before.projection),
        (after.size, &after.lens, after.projection)
    );
}

fn same_light(before: &Light, after: &Light) {
    let (Light::Punctual(a), Light::Punctual(b)) = (before, after) else {
        assert_eq!(before, after);
        return;
    };
    assert_eq!(a.intensity, b.intensity);
    let direction = |light: &Punctual| light.emitter.direction();
    for (a, b) in direction(a).into_iter().zip(direction(b)) {
        let length = a.iter().map(|part| part * part).sum::<f64>().sqrt();
        let near = a
            .into_iter()
            .zip(b)
            .all(|(a, b)| is_near(a / length, b, 1.0));
        assert!(near, "{a:?} {b:?}");
    }
    assert_eq!(a.emitter.position(), b.emitter.position());
    assert_eq!(a.emitter.range(), b.emitter.range());
    assert_eq!(
        std::mem::discriminant(&a.emitter),
        std::mem::discriminant(&b.emitter)
    );
    if let (
        PunctualKind::Photometric { photometry: a, .. },
        PunctualKind::Photometric { photometry: b, .. },
    ) = (&a.emitter, &b.emitter)
    {
        assert_eq!(a, b);
    }
}

/// Each surface is itself, or a mesh in its place, and is made of the same.
fn same_surfaces(before: &Scene, after: &Scene) {
    let is_shown = |surface: &&Surface| {
        let Shape::Instance(own) = &surface.shape else {
            return true;
        };
        !before.meshes[own.mesh.0 as usize].triangles.is_empty()
    };
    let shown: Vec<_> = before.surfaces.iter().filter(is_shown).collect();
    assert_eq!(shown.len(), after.surfaces.len());
    for (a, b) in shown.into_iter().zip(&after.surfaces) {
        assert_eq!(a.casts_no_shadow, b.casts_no_shadow);
        assert_eq!(a.velocity, b.velocity);
        let Shape::Instance(mesh) = &b.shape else {
            panic!("{:?} is no mesh", b.shape)
        };
        let made = &after.meshes[mesh.mesh.0 as usize];
        same_material(
            &before.materials[a.material.0 as usize],
            &after.materials[b.material.0 as usize],
            !made.uvs.is_empty(),
        );
        if let Shape::Instance(own) = &a.shape {
            assert_eq!(own.world_from_object, mesh.world_from_object);
            same_mesh(&before.meshes[own.mesh.0 as usize], made);
        }
    }
}

/// Materials have the same factors; of maps there are the same, where the mesh can have any.
fn same_material(before: &Material, after: &Material, has_uvs: bool) {
    let (mut a, mut b) = (
        serde_json::to_value(before).unwrap(),
        serde_json::to_value(after).unwrap(),
    );
    let maps = [&mut a, &mut b].map(take_maps);
    assert_eq!(a, b);
    if has_uvs {
        assert_eq!(maps[0], maps[1]);
    }
}

/// Takes the maps out of a material; their names.
fn take_maps(material: &mut Value) -> Vec<String> {
    let model = material.as_object_mut().unwrap().values_mut().next();
    let model = model.unwrap().as_object_mut().unwrap();
    let is_map = |name: &String| name.ends_with("Map") || name == "bump";
    let names: Vec<String> = model.keys().filter(|name| is_map(name)).cloned().collect();
    names.iter().for_each(|name| drop(model.remove(name)));
    names
}

/// Meshes have the same triangles, corner by corner, to 32 bits.
fn same_mesh(before: &Mesh, after: &Mesh) {
    assert_eq!(
        (&before.name, before.triangles.len()),
        (&after.name, after.triangles.len())
    );
    let corners = |mesh: &Mesh| mesh.triangles.iter().flatten().copied().collect::<Vec<_>>();
    let (a, b) = (corners(before), corners(after));
    same_column(&before.positions, &after.positions, (&a, &b));
    same_column(&before.uvs, &after.uvs, (&a, &b));
    same_column(&before.second_uvs, &after.second_uvs, (&a, &b));
    same_column(&before.colors, &after.colors, (&a, &b));
    let unit = |mesh: &Mesh| -> VertexColumn<3> {
        let unit = |normal: [f64; 3]| {
            let length = normal.iter().map(|part| part * part).sum::<f64>().sqrt();
            normal.map(|part| part / length)
        };
        mesh.normals.iter().map(unit).collect()
    };
    same_column(&unit(before), &unit(after), (&a, &b));
    if !before.tangents.is_empty() {
        same_column(&before.tangents, &after.tangents, (&a, &b));
    }
}

fn same_column<const N: usize>(
    before: &VertexColumn<N>,
    after: &VertexColumn<N>,
    (a, b): (&[u32], &[u32]),
) {
    assert_eq!(before.is_empty(), after.is_empty());
    if before.is_empty() {
        return;
    }
    for (a, b) in a.iter().zip(b) {
        let (a, b) = (before.at(*a as usize), after.at(*b as usize));
        let near = a
            .into_iter()
            .zip(b)
            .all(|(a, b)| is_near(a, b, 1e-30) || !a.is_finite());
        assert!(near, "{a:?} {b:?}");
    }
}

/// A scene with something in it to look at.
fn with(keys: &str) -> LoweredScene {
    let ball = "{type: sphere, position: [0, 0, 0], radius: 1, material: {color: [1, 0, 0], ka: 0.1, kd: 0.5, ks: 0.25, n: 30}}";
    scene(&format!("{keys}\nObjects: [{ball}]\n"))
}

const EYE: &str = "Eye: [0, 1, 10]";

fn lights_come_back() {
    let lights = with(&format!(
        "{EYE}\nRenderMode: path\nLights:\n  - {{position: [3, 4, 5], color: [0.3, 0.7, 2.5]}}\n  - {{position: [0, 4, 0], color: [1, 1, 1], radius: 0.5}}\n  - {{type: sun, direction: [1, 2, 3], irradiance: [3, 2.5, 0.1]}}\n"
    ));
    assert_eq!(lights.scene.lights.len(), 3);
    comes_back(&lights);
}

fn cameras_come_back() {
    for camera in [
        "Eye: [1, 2, 30]",
        "Camera: {eye: [1, 2, 3], center: [0, 0.5, 0], up: [0, 0.01, 0], viewSize: [40, 30], apertureRadius: 0.1, apertureSamples: 9}",
        "Camera: {eye: [1, 2, 3], center: [0, 0.5, 0], up: [0, 0.01, 0], right: [0.02, 0, 0], viewSize: [40, 30]}",
    ] {
        comes_back(&with(camera));
    }
}

/// A surface without tangents has those along its own texture coordinates, however a normal map is
/// transformed.
fn tangents_come_back() {
    let text = format!(
        "{EYE}\nRenderMode: path\nObjects: [{{type: quad, v0: [0, 0, 0], v1: [1, 0, 0], v2: [1, 1, 0], \
         v3: [0, 1, 0], material: {{type: standard}}}}]\n"
    );
    let tangents = |texture_from_surface| {
        let mut lowered = scene(&text);
        let image = lowered.scene.add_image(Image {
            name: "bumps".to_owned(),
            width: 2,
            height: 1,
            kind: Pixels::Rgb8,
            pixels: vec![128, 128, 255, 90, 128, 240].into(),
        });
        lowered.scene.textures.push(Texture::Sampled(Sampled {
            image,
            wrap: [Wrap::Repeat; 2],
            filter: Filter::Linear,
        }));
        let Material::Standard(standard) = &mut lowered.scene.materials[0] else {
            panic!("a material of glTF");
        };
        standard.normal_map = Some(Map {
            texture_from_surface,
            ..Map::from(TextureId(0))
        });
        let back = read(&write(&lowered, None).0.unwrap());
        let tangents = &back.scene.meshes[0].tangents;
        assert!(!tangents.is_empty());
        tangents.iter().collect::<Vec<_>>()
    };
    let plain = tangents(None);
    for rows in [
        [[-1.0, 0.0, 1.0], [0.0, 1.0, 0.0]],
        [[0.0, 1.0, 0.0], [1.0, 0.0, 0.0]],
        [[2.0, 0.0, 0.0], [0.0, 3.0, 0.5]],
    ] {
        assert_eq!(tangents(Some(rows)), plain, "{rows:?}");
    }
}

/// A scene in a picture of 4 × 2 pixels, each with a value of its own.
fn surrounded(kind: Pixels) -> LoweredScene {
    let mut lowered = with(&format!("{EYE}\nRenderMode: path"));
    let pixels: Vec<u8> = match kind {
        Pixels::Rgb8 | Pixels::Rgba8 => (0..8 * kind.bytes())
            .map(|k| u8::try_from(k).unwrap())
            .collect(),
        Pixels::Rgb32f => (0_u8..24)
            .flat_map(|k| (f32::from(k) * 0.1).to_le_bytes())
            .collect(),
    };
    let image = lowered.scene.add_image(Image {
        name: "sky".to_owned(),
        width: 4,
        height: 2,
        kind,
        pixels: pixels.into(),
    });
    lowered.scene.environment = Some(Environment {
        radiance: [0.1, 2.0, 3.5],
        image: Some(image),
        image_from_world: Some([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]),
    });
    lowered
}

fn surroundings_come_back() {
    for kind in [Pixels::Rgb8, Pixels::Rgba8, Pixels::Rgb32f] {
        let mut lowered = surrounded(kind);
        comes_back(&lowered);
        comes_back_from_text(&lowered);
        let own = lowered.scene.environment.as_mut().unwrap();
        own.image_from_world = None;
        comes_back(&lowered);
        lowered.scene.environment.as_mut().unwrap().image = None;
        comes_back(&lowered);
    }
}

fn odd_pixels_are_refused() {
    let asset = emitted(&surrounded(Pixels::Rgb32f), None, Some(FOLDER))
        .0
        .unwrap();
    let text = String::from_utf8(super::bytes(&asset)).unwrap();
    let wrong = text.replace("\"width\": 4", "\"width\": 3");
    assert_ne!(text, wrong);
    let (mut map, file) = with_files(wrong.as_bytes(), &asset);
    let (options, mut sink) = (Options::default(), DiagnosticSink::default());
    pipeline::load(file, &mut map, &options, &mut sink);
    let codes: Vec<_> = sink.kept().iter().map(|finding| finding.code.id).collect();
    assert!(codes.contains(&"GL026"), "{codes:?}");
}

fn settings_come_back() {
    for mode in ["phong", "zbuffer", "normal", "path"] {
        comes_back(&with(&format!(
            "{EYE}\nRenderMode: {mode}\nShadows: true\nMaxRecursionDepth: 3\nSuperSampling: {{factor: 2, pattern: jitter}}\n"
        )));
    }
    for words in [
        "Exposure: -1.5",
        "ToneMap: pbr-neutral",
        "Exposure: 2\nToneMap: none",
    ] {
        comes_back(&with(&format!("{EYE}\nRenderMode: path\n{words}\n")));
    }
    let mut lowered = with(EYE);
    lowered.scene.surfaces[0].casts_no_shadow = true;
    lowered.scene.surfaces[0].velocity = [1.0, -2.0, 0.5].into();
    lowered.scene.settings.shutter = [-0.5, 0.25];
    comes_back(&lowered);
}

fn what_is_left_out_is_told() {
    let lowered = with(EYE);
    let (_, sink) = write(&lowered, Some(0.01));
    let codes: std::collections::BTreeSet<_> =
        sink.kept().iter().map(|finding| finding.code.id).collect();
    assert_eq!(codes.into_iter().collect::<Vec<_>>(), ["GL050", "GL051"]);
    let mut far = with(EYE);
    let column = vec![[0.0, 0.0, 0.0], [1e39, 0.0, 0.0], [0.0, 1.0, 0.0]];
    far.scene.meshes.push(Mesh {
        positions: VertexColumn::from(column),
        triangles: vec![[0, 1, 2]].into(),
        ..Mesh::default()
    });
    far.scene.surfaces[0].shape = Shape::Instance(rtc::internals::ir::Instance {
        mesh: rtc::internals::ir::MeshId(0),
        world_from_object: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0; 3]],
    });
    let (bytes, sink) = write(&far, None);
    let refused = sink
        .kept()
        .iter()
        .find(|finding| finding.code.id == "GL052");
    assert!(bytes.is_none() && refused.unwrap().severity == Severity::Error);
}
