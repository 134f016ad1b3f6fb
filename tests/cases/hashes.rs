//! The table of pictures: for each scene the hash of its values, the same for 1, 2 and 7 threads,
//! in debug and release, and on every machine. `RTC_UPDATE=1 cargo test --test cases hashes/`
//! rewrites `tests/hashes.txt`.
//!
//! On another architecture, under emulation: `rustup target add aarch64-unknown-linux-musl`, then
//! `cargo test --test cases hashes/ --target aarch64-unknown-linux-musl` with
//! `CARGO_TARGET_AARCH64_UNKNOWN_LINUX_MUSL_LINKER=rust-lld` and
//! `CARGO_TARGET_AARCH64_UNKNOWN_LINUX_MUSL_RUNNER=qemu-aarch64`.

use super::small::{WHOLE, bits, film, paths, reduced, small};
use super::suite::{root, trial, updates};
use libtest_mimic::Trial;
use rtc::internals::ir::Scene;
use rtc::internals::pipeline::Options;
use rtc::internals::source::SourceMap;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
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
        "v0: [-1, 0.1, 1], v1: [1.2, 0.1, 0.6], v2: [1.2, 2, 0.1], v3: [-1, 1.4, -1.3]",
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
    let mut map = SourceMap::default();
    let file = map.add(format!("{kind}, {name}"), text.into_bytes());
    let mut options = Options::default();
    options.front.strict = true;
    options.front.asset_root = Some(Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes"));
    reduced(file, &mut map, &options)
}

/// What a row is the hash of.
#[derive(Clone)]
enum Source {
    File(PathBuf),
    /// A shape and an effect, by their indices.
    Made(usize, usize),
}

impl Source {
    fn name(&self) -> String {
        match self {
            Self::File(path) => path.file_stem().unwrap().to_string_lossy().into_owned(),
            Self::Made(shape, effect) => format!("{}, {}", SHAPES[*shape].0, EFFECTS[*effect].0),
        }
    }

    fn scene(&self) -> Scene {
        match self {
            Self::File(path) => small(path),
            Self::Made(shape, effect) => made(SHAPES[*shape], EFFECTS[*effect]),
        }
    }
}

/// Every row: the files of the repo, then each shape with some effect and each effect with some
/// shape, so that all meet several of the others.
fn sources() -> Vec<Source> {
    let made = (0..SHAPES.len())
        .flat_map(|k| [0, 1, 5].map(|step| Source::Made(k, (k + step) % EFFECTS.len())));
    paths().into_iter().map(Source::File).chain(made).collect()
}

pub(crate) fn trials() -> Vec<Trial> {
    let sources = sources();
    let names: Vec<String> = sources.iter().map(Source::name).collect();
    let mut trials: Vec<_> = sources
        .into_iter()
        .map(|source| {
            let names = names.clone();
            trial(format!("hashes/{}", source.name()), move || {
                check(&source, &names);
            })
        })
        .collect();
    trials.push(trial("hashes: a row for each scene", move || {
        let rows: Vec<_> = table().into_iter().map(|(name, _)| name).collect();
        assert!(updates() || rows == names, "{rows:?} instead of {names:?}");
    }));
    trials
}

fn path() -> PathBuf {
    root("tests/hashes.txt")
}

/// The rows of the table, names with their hashes.
fn table() -> Vec<(String, String)> {
    let text = std::fs::read_to_string(path()).unwrap_or_default();
    let rows = text.lines().filter_map(|row| row.split_once(' '));
    rows.map(|(hash, name)| (name.to_owned(), hash.to_owned()))
        .collect()
}

/// Writes a row into the table, in which only scenes that there are stay.
fn update(names: &[String], name: &str, hash: &str) {
    static TABLE: Mutex<()> = Mutex::new(());
    let _alone = TABLE.lock().unwrap();
    let mut rows: BTreeMap<String, String> = table().into_iter().collect();
    rows.insert(name.to_owned(), hash.to_owned());
    let row = |name: &String| Some(format!("{} {name}\n", rows.get(name)?));
    let text: String = names.iter().filter_map(row).collect();
    std::fs::write(path(), text).unwrap();
}

fn check(source: &Source, names: &[String]) {
    let (name, scene) = (source.name(), source.scene());
    // A picture that is all one value would have a hash as well.
    let mut values = bits(&film(&scene, &WHOLE, 0));
    values.sort_unstable();
    values.dedup();
    assert!(values.len() > 50, "only {} values", values.len());
    let one = hash(&scene, 1);
    for threads in [2, 7] {
        assert_eq!(hash(&scene, threads), one, "on {threads} threads");
    }
    let found = format!("{one:016x}");
    if updates() {
        return update(names, &name, &found);
    }
    let kept = table().into_iter().find(|row| row.0 == name);
    assert_eq!(Some((name, found)), kept, "now, and in tests/hashes.txt");
}

fn hash(scene: &Scene, threads: usize) -> u64 {
    let bytes: Vec<u8> = bits(&film(scene, &WHOLE, threads))
        .iter()
        .flat_map(|bits| bits.to_le_bytes())
        .collect();
    xxh3_64(&bytes)
}
