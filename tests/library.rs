//! The library beside pictures: progress, exports, what accuracy costs, the texts of codes.

#![expect(
    clippy::unwrap_used,
    clippy::disallowed_methods,
    reason = "a test stops at the first surprise and reads what it checks"
)]

#[path = "../examples/animate.rs"]
#[expect(dead_code, reason = "the test calls what main does")]
mod animate;
#[path = "../examples/golden.rs"]
#[expect(dead_code, reason = "the test calls what main does")]
mod golden;

use crate::builder::build;
use rtc::{
    Cost, Diagnostic, Effort, Error, Mesh, Options, Phong, Progress, Reading, Scene, Shape,
    Texture, Transform,
};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Command;
use std::sync::{Arc, Mutex};
use std::time::Duration;
use tempfile::TempDir;

/// The files of a folder and of the folders in it, by their paths.
fn files_in(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut files = BTreeMap::new();
    let mut open = vec![folder.to_owned()];
    while let Some(next) = open.pop() {
        for entry in fs::read_dir(&next).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                open.push(path);
                continue;
            }
            let name = path.strip_prefix(folder).unwrap().to_str().unwrap();
            files.insert(name.to_owned(), fs::read(&path).unwrap());
        }
    }
    files
}

#[test]
fn exports_are_those_of_the_command_line() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    for (scene, names) in [
        (
            "scenes/ball.obj",
            &["a.json", "a.rtir", "a.glb", "a.gltf", "a.xml", "a.pbrt"][..],
        ),
        (
            "scenes/five-spheres.yaml",
            &["a.json", "a.yaml", "a.xml", "a.pbrt", "a.pov", "a.gltf"],
        ),
    ] {
        let opened = Scene::open(root.join(scene)).unwrap();
        for name in names {
            let [ours, theirs] = [(); 2].map(|()| TempDir::new().unwrap());
            let export = opened.export(name).unwrap();
            export.save(ours.path()).unwrap();
            let mut command = Command::new(env!("CARGO_BIN_EXE_rtc"));
            let to = theirs.path().join(name);
            command
                .arg("compile")
                .arg(root.join(scene))
                .arg("-o")
                .arg(to);
            let said = command.output().unwrap();
            assert!(said.status.success(), "{said:?}");
            let [ours, theirs] = [&ours, &theirs].map(|folder| files_in(folder.path()));
            assert!(
                ours == theirs,
                "{scene} as {name}: {:?} {:?}",
                ours.keys(),
                theirs.keys()
            );
            assert_eq!(export.files().count(), ours.len() - 1);
        }
    }
}

#[test]
fn a_built_scene_is_read_again_from_its_exports() {
    let picture = |scene: &Scene| {
        let options = Options::new().size(32, 24);
        scene.render(&options).unwrap().rgba8()
    };
    let same = |scene: &Scene, name: &str| {
        let export = scene.export(name).unwrap();
        let files = export.files().chain([(name, export.bytes())]);
        let files = files.map(|(name, bytes)| (name.to_owned(), bytes.to_vec()));
        let again = Reading::new().from_files(name, files).unwrap();
        assert!(
            picture(&again) == picture(scene),
            "{name}: {:?}",
            again.check()
        );
    };
    let scene = build::scene().unwrap();
    same(&scene, "a.json");
    same(&scene, "a.rtir");
    // A scene text has textures sampled in its own way, and meshes and images as files.
    let mut text =
        Scene::open(Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/five-spheres.yaml"));
    let text = text.as_mut().unwrap();
    text.edit(|builder| {
        let pixels = [[250, 20, 20], [20, 250, 20]].concat();
        let stripes = builder.texture(Texture::rgb8(2, 1, pixels).as_in_texts());
        let corners = [[0.0, 0.0, 300.0], [200.0, 0.0, 300.0], [0.0, 200.0, 300.0]];
        let mesh = Mesh::new(&corners, &[[0, 1, 2]]);
        let mesh = builder.mesh(mesh.uvs(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]));
        let shape = Shape::instance(mesh, Transform::new());
        builder.add(shape, Phong::default().color_map(stripes).ka(0.5));
    })
    .unwrap();
    let plain = Scene::open(Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/five-spheres.yaml"));
    assert!(
        picture(text) != picture(&plain.unwrap()),
        "the mesh is seen"
    );
    same(text, "a.yaml");
    let refused = scene.export("a.docx").unwrap_err();
    assert!(matches!(&refused, Error::Refused(_)), "{refused}");
    let broken = Scene::from_files("a.yaml", [("a.yaml".to_owned(), b"Camera: 3".to_vec())]);
    let refused = broken.unwrap().export("a.glb").unwrap_err();
    assert!(
        matches!(&refused, Error::Invalid(found) if !found.is_empty()),
        "{refused}"
    );
}

#[test]
fn the_frames_of_a_film_move_and_come_round() {
    let folder = TempDir::new().unwrap();
    animate::film(folder.path(), &Options::new().size(24, 18)).unwrap();
    let frames = files_in(folder.path());
    let pixels = |file: &Vec<u8>| image::load_from_memory(file).unwrap().to_rgb8();
    let frames: Vec<_> = frames.values().map(pixels).collect();
    assert_eq!(frames.len(), 24);
    assert!(frames.windows(2).all(|pair| pair[0] != pair[1]), "it moves");
    // The ball rises as it falls.
    let is_near = |frame: usize| {
        let pairs = frames[frame].iter().zip(frames[24 - frame].iter());
        pairs.into_iter().all(|(a, b)| a.abs_diff(*b) < 3)
    };
    assert!((1..12).all(is_near));
}

#[test]
fn a_golden_picture_is_that_of_its_mesh_alone() {
    let golden = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/golden.png");
    golden::assert_picture(&golden::picture(&golden::octasphere(3)), &golden);
    let folder = TempDir::new().unwrap();
    let copy = folder.path().join("golden.png");
    fs::copy(&golden, &copy).unwrap();
    let coarse = golden::picture(&golden::octasphere(2));
    let failed = std::panic::catch_unwind(|| golden::assert_picture(&coarse, &copy));
    assert!(failed.is_err());
    let actual = fs::read(folder.path().join("golden.actual.png")).unwrap();
    assert!(actual == coarse.encode().unwrap());
}

/// A row of a study from its JSON.
fn own_error(cost: &Cost) -> f64 {
    let json: serde_json::Value = serde_json::from_str(&cost.json()).unwrap();
    let rows = json["rows"].as_array().unwrap();
    let own = rows.iter().find(|row| row["own"] == true).unwrap();
    own["errors"]["rmse"].as_f64().unwrap()
}

#[test]
fn the_cost_is_measured_and_its_rows_render() {
    let mut scene = build::scene().unwrap();
    scene
        .edit(|builder| builder.set_camera(builder.camera().size(16, 12)))
        .unwrap();
    let cost = scene.cost(Effort::Quick).unwrap();
    let own: Vec<_> = cost.rows().iter().filter(|row| row.is_own).collect();
    assert_eq!(own.len(), 1);
    assert!(own[0].error == own_error(&cost) && own[0].error > 0.5);
    let chosen = cost.recommended().unwrap();
    assert!(chosen.is_on_front && chosen.error < own[0].error && !cost.advice().is_empty());
    // The picture of a setting is nearer to that of the best by as much as its error is less.
    let pixels = |options: &Options| scene.render(options).unwrap().pixels().to_vec();
    let best = cost
        .rows()
        .iter()
        .min_by(|a, b| a.error.total_cmp(&b.error))
        .unwrap();
    let distance = |options: &Options| {
        let (a, b) = (pixels(options), pixels(&best.options));
        let pairs = a.as_flattened().iter().zip(b.as_flattened());
        pairs.map(|(a, b)| (a - b) * (a - b)).sum::<f64>()
    };
    assert!(pixels(&own[0].options) == pixels(&Options::new()));
    assert!(distance(&chosen.options) < distance(&Options::new()));
    let stopped = scene.cost_until(Effort::Thorough, &|| true).unwrap_err();
    assert!(matches!(stopped, Error::Stopped), "{stopped}");
}

#[test]
fn every_public_type_has_an_example() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/api");
    let (mut types, mut bare) = (0, Vec::new());
    for (name, bytes) in files_in(&root) {
        let text = String::from_utf8(bytes).unwrap();
        let mut has_example = false;
        for line in text.lines() {
            let is_type = ["pub struct ", "pub enum ", "pub use rtc_"]
                .iter()
                .any(|start| line.starts_with(start));
            if is_type {
                types += 1;
                bare.extend((!has_example).then(|| format!("{name}: {line}")));
            }
            let is_about_it = line.starts_with("///") || line.starts_with("#[");
            has_example = is_about_it && (has_example || line.starts_with("/// ```"));
        }
    }
    assert!(
        types > 40 && bare.is_empty(),
        "{types} types, without: {bare:?}"
    );
}

#[test]
fn every_code_that_is_found_has_a_text() {
    let text = "Camera: {eye: [0, 0, 9]}\nObjects: [{type: sphere, radius: -1}]\n";
    let scene = Scene::from_files("a.yaml", [("a.yaml".to_owned(), text.into())]).unwrap();
    let found: Vec<Diagnostic> = scene.check();
    assert!(!found.is_empty());
    for code in found.iter().map(|found| found.code) {
        assert!(rtc::explain(code).unwrap().contains(code));
    }
    let effects = build::scene().unwrap().effects(&Options::new()).unwrap();
    let rules: Vec<_> = effects.iter().filter_map(|effect| effect.rule).collect();
    assert!(!rules.is_empty());
    assert!(rules.iter().all(|rule| rtc::explain(rule).is_some()));
}

/// What `see` tells of each report of a render.
fn seen<T: Send + 'static>(
    scene: &Scene,
    options: Options,
    see: impl Fn(Progress<'_>) -> T + Send + Sync + 'static,
) -> (Vec<T>, rtc::Picture) {
    let reports = Arc::new(Mutex::new(Vec::new()));
    let list = Arc::clone(&reports);
    let options = options.on_progress(move |progress| list.lock().unwrap().push(see(progress)));
    let picture = scene.render(&options).unwrap();
    let reports = std::mem::take(&mut *reports.lock().unwrap());
    (reports, picture)
}

/// The share and the rays of a report.
struct Report {
    done: f64,
    rays: u64,
}

fn reports(scene: &Scene, options: Options) -> (Vec<Report>, rtc::Picture) {
    seen(scene, options, |progress| Report {
        done: progress.done,
        rays: progress.rays,
    })
}

#[test]
fn progress_rises_to_one() {
    let scene = build::scene().unwrap();
    let all = [
        Options::new().size(40, 40),
        Options::new().size(40, 40).target_error(1.0),
        Options::new()
            .size(16, 16)
            .trace_paths(true)
            .samples(4)
            .denoise(true),
        Options::new().size(3, 1),
        Options::new()
            .size(40, 40)
            .time_budget(Duration::from_millis(50)),
    ];
    for options in all {
        let (reports, picture) = reports(&scene, options.clone());
        let rises = reports.is_sorted_by(|a, b| a.done <= b.done && a.rays <= b.rays);
        assert!(rises, "{options:?}");
        let ends = reports
            .iter()
            .filter(|progress| progress.done == 1.0)
            .count();
        assert_eq!(ends, 1, "{options:?}");
        let last = reports.last().unwrap();
        assert!(
            last.done == 1.0 && last.rays >= picture.statistics().rays,
            "{options:?}"
        );
    }
    let (reports, _) = reports(&scene, Options::new().size(40, 40));
    let middle = reports
        .iter()
        .filter(|progress| progress.done > 0.2 && progress.done < 0.8);
    assert!(
        middle.count() > 20 && reports.len() <= 102,
        "{}",
        reports.len()
    );
}

#[test]
fn a_picture_that_is_asked_for_has_the_final_bytes_in_its_finished_tiles() {
    const SIDE: u32 = 40;
    /// The pixels of the largest tile: those that are done in a tile that is not.
    const TILE: f64 = 256.0;
    let scene = build::scene().unwrap();
    let plain = || Options::new().size(SIDE, SIDE).threads(1);
    let traced = || plain().trace_paths(true).samples(1);
    for (threads, options) in [
        (1.0, plain()),
        (1.0, traced().transparent()),
        (1.0, traced().format(rtc::Format::Exr)),
        (2.0, plain().threads(2)),
    ] {
        let asked = seen(&scene, options.clone(), |progress| {
            (progress.done, progress.picture())
        });
        let (pictures, last) = asked;
        assert_eq!(
            last.encode().unwrap(),
            scene.render(&options).unwrap().encode().unwrap()
        );
        let last = last.rgba8();
        let mut counts = Vec::new();
        for (done, picture) in pictures {
            let Some(picture) = picture else {
                assert_eq!(done, 1.0, "{options:?}");
                continue;
            };
            let bytes = picture.rgba8();
            let pairs = || bytes.as_chunks::<4>().0.iter().zip(last.as_chunks().0);
            assert!(
                pairs().all(|(now, last)| now == last || *now == [0; 4]),
                "{options:?}"
            );
            let equal = pairs().filter(|(now, last)| now == last).count() as f64;
            let pixels = (done * f64::from(SIDE * SIDE)).round();
            assert!(
                equal >= pixels - threads * TILE,
                "{options:?}: {equal} at {done}"
            );
            counts.push(equal);
        }
        assert!(
            counts.len() > 50 && counts.is_sorted(),
            "{options:?}: {counts:?}"
        );
    }
    // Pictures without final pixels before the end.
    for options in [traced().samples(4).denoise(true), plain().target_error(9.0)] {
        let (pictures, _) = seen(&scene, options, |progress| progress.picture().is_none());
        assert!(pictures.iter().all(|is_none| *is_none));
    }
}
