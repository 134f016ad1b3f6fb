//! What the rows of `tests/hashes.txt` are hashes of: the scenes of the repo, and scenes of one
//! shape and one effect each.

use crate::small::{WHOLE, bits, film, paths, reduced};
use rtc::internals::ir::Scene;
use rtc::internals::pipeline::Options;
use rtc::internals::source::{Loader, MemoryFiles, SourceMap};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use xxhash_rust::xxh3::xxh3_64;

/// One shape each, for which the made-up scenes are named; the room is about 10 across.
const SHAPES: [(&str, &str); 12] = [
    ("sphere", "position: [0, 1, 0], radius: 1"),
    ("plane", "position: [0, 0.5, 0], normal: [0.1, 1, 0.2]"),
    (
        "triangle",
        "v0: [-1, 0.1, 1], v1: [1.3, 0.2, 0.4], v2: [0.2, 2.1, -0.6]",
    ),
    (
        "quad",
        "curved: true, v0: [-1, 0.1, 1], v1: [1.2, 0.1, 0.6], v2: [1.2, 2, 0.1], v3: [-1, 1.4, -1.3]",
    ),
    (
        "circle",
        "center: [0, 1, 0], normal: [0.3, 0.2, 1], radius: 1.1",
    ),
    (
        "cylinder",
        "p1: [-0.7, 0.4, 0.3], p2: [0.8, 1.6, -0.4], radius: 0.6",
    ),
    (
        "cone",
        "position: [0, 0.1, 0], up: [0.4, 2, 0.3], radius: 1",
    ),
    (
        "torus",
        "position: [0, 1, 0], radius: 0.9, alpha: 0.3, direction: [0.3, 1, 0.6]",
    ),
    (
        "box",
        "position: [0, 1, 0], dimension: [1.2, 1.4, 1.1], rotation: [0.3, 0.7, 0.1]",
    ),
    (
        "tetrahedron",
        "v0: [-1, 0.1, 0.6], v1: [0.1, 0.1, 1.4], v2: [1, 0.1, 0.5], v3: [0.2, 1.9, 0.4]",
    ),
    (
        "prism",
        "v0: [-1, 0.1, 0.8], v1: [0.9, 0.1, 0.9], v2: [0.1, 1.7, 0.7], up: [0.2, 0.1, -1.4]",
    ),
    (
        "mesh",
        "file: icosahedron.obj, position: [0, 1, 0], radius: 1",
    ),
];

/// One effect each: keys of the scene, and of the materials.
const EFFECTS: [(&str, &str, &str); 12] = [
    ("plain", "", "ks: 0.2, n: 20"),
    ("shadows", "Shadows: true", "ks: 0.2, n: 20"),
    ("mirrors", "MaxRecursionDepth: 4", "ks: 0.6, n: 200"),
    (
        "glass",
        "MaxRecursionDepth: 6",
        "ks: 0.1, n: 50, kt: 0.8, eta: 1.5",
    ),
    (
        "glossy",
        "MaxRecursionDepth: 1",
        "ks: 0.5, n: 60, glossySamples: 5",
    ),
    (
        "soft light",
        "Shadows: true\nLightSamples: 5",
        "ks: 0.2, n: 20",
    ),
    ("lens", "", "ks: 0.2, n: 20"),
    (
        "jitter",
        "SuperSampling: {factor: 2, pattern: jitter}",
        "ks: 0.2, n: 20",
    ),
    (
        "random",
        "SuperSampling: {factor: 2, pattern: random}",
        "ks: 0.2, n: 20",
    ),
    ("normals", "RenderMode: normal", "ks: 0.2, n: 20"),
    ("zbuffer", "RenderMode: zbuffer", "ks: 0.2, n: 20"),
    ("gooch", "RenderMode: gooch", "ks: 0.2, n: 20"),
];

/// A scene of one shape on a sphere for a floor, with one effect.
fn made(shape: (&str, &str), effect: (&str, &str, &str)) -> Scene {
    let (kind, numbers) = shape;
    let (name, keys, material) = effect;
    let radius = if name == "soft light" {
        ", radius: 0.8"
    } else {
        ""
    };
    let lens = if name == "lens" {
        "\n  apertureRadius: 0.2\n  apertureSamples: 4"
    } else {
        ""
    };
    let material = format!("material: {{color: [0.8, 0.5, 0.3], ka: 0.2, kd: 0.6, {material}}}");
    let text = format!(
        "Camera:\n  eye: [0.5, 3, 7]\n  center: [0, 1, 0]\n  up: [0, 0.08, 0]\n  viewSize: [48, 40]{lens}\n{keys}\n\
         Lights:\n- {{position: [-4, 6, 5], color: [0.9, 0.8, 0.7]{radius}}}\nObjects:\n\
         - {{type: {kind}, {numbers}, {material}}}\n- {{type: sphere, position: [0, -40, 0], radius: 40, {material}}}\n"
    );
    let mut options = Options::default();
    options.front.strict = true;
    in_memory(
        "made.yaml",
        Some(("made.yaml".to_owned(), text.into_bytes())),
        &options,
    )
}

/// The scene of this name among the files of the repo's scenes, which are held in memory with one
/// more: not every machine has folders as the loader knows them.
fn in_memory(name: &str, more: Option<(String, Vec<u8>)>, options: &Options) -> Scene {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let files = folder.read_dir().unwrap().map(|entry| {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        (name, std::fs::read(path).unwrap())
    });
    let files = Arc::new(MemoryFiles::new(files.chain(more)));
    let mut map = SourceMap::default();
    let file = Loader.memory(name, &files, &mut map).unwrap();
    reduced(file, &mut map, options)
}

/// What a row is the hash of.
#[derive(Clone)]
pub(crate) enum Source {
    File(PathBuf),
    /// A shape and an effect, by their indices.
    Made(usize, usize),
}

impl Source {
    pub(crate) fn name(&self) -> String {
        match self {
            Self::File(path) => path.file_stem().unwrap().to_string_lossy().into_owned(),
            Self::Made(shape, effect) => format!("{}, {}", SHAPES[*shape].0, EFFECTS[*effect].0),
        }
    }

    pub(crate) fn scene(&self) -> Scene {
        match self {
            Self::File(path) => {
                let name = path.file_name().unwrap().to_string_lossy();
                in_memory(&name, None, &Options::default())
            }
            Self::Made(shape, effect) => made(SHAPES[*shape], EFFECTS[*effect]),
        }
    }
}

/// Every row: the files of the repo, then each shape with some effect and each effect with some
/// shape, so that all meet several of the others.
pub(crate) fn sources() -> Vec<Source> {
    let made = (0..SHAPES.len())
        .flat_map(|k| [0, 1, 5].map(|step| Source::Made(k, (k + step) % EFFECTS.len())));
    paths().into_iter().map(Source::File).chain(made).collect()
}

/// The hash of the values of a picture, made on so many threads.
pub(crate) fn hash(scene: &Scene, threads: usize) -> u64 {
    let bytes: Vec<u8> = bits(&film(scene, &WHOLE, threads))
        .iter()
        .flat_map(|bits| bits.to_le_bytes())
        .collect();
    xxh3_64(&bytes)
}
