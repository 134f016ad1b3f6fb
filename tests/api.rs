//! The library as its callers see it: by its public names alone.

#![expect(
    clippy::unwrap_used,
    clippy::disallowed_methods,
    reason = "a test stops at the first surprise and reads what it checks"
)]

#[path = "../examples/check.rs"]
#[expect(dead_code, reason = "the test calls what main does")]
mod check;
#[path = "../examples/custom_light.rs"]
#[expect(dead_code, reason = "the test calls what main does")]
mod custom_light;
#[path = "../examples/render.rs"]
#[expect(dead_code, reason = "the test calls what main does")]
mod render;

use rtc::{
    Aov, EffectState, Error, Format, Light, Options, Picture, Reading, Scene, Severity, Tone,
};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;
use tempfile::TempDir;

/// A ball, and a light on it.
const BALL: &str = "\
Camera: {eye: [20, 20, 100], center: [20, 20, 0], up: [0, 1, 0], viewSize: [40, 40]}
Lights:
- {position: [-20, 60, 150], color: [1, 1, 1]}
Objects:
- {type: sphere, position: [20, 20, 0], radius: 14, material: {color: [1, 0.5, 0.2], ka: 0.2, kd: 0.8, ks: 0, n: 1}}
";

fn ball() -> Scene {
    Scene::from_files("ball.yaml", [("ball.yaml".to_owned(), BALL.into())]).unwrap()
}

fn path(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(name)
}

fn text(path: &Path) -> String {
    path.to_str().unwrap().to_owned()
}

/// The bytes that the command line writes for the same.
fn by_command(scene: &Path, picture: &str, arguments: &[&str]) -> Vec<u8> {
    let folder = TempDir::new().unwrap();
    let picture = folder.path().join(picture);
    let mut command = Command::new(env!("CARGO_BIN_EXE_rtc"));
    command.arg("render").arg(scene).arg("-o").arg(&picture);
    let said = command.args(arguments).output().unwrap();
    assert!(said.status.success(), "{said:?}");
    fs::read(picture).unwrap()
}

#[test]
fn pictures_are_those_of_the_command_line() {
    let globe = path("scenes/globe.yaml");
    let small = Options::new().size(24, 20).supersampling(1).threads(2);
    let arguments = ["--size", "24x20", "--supersampling", "1"];
    let rendered = |scene: &Path, options: &Options| {
        let picture = Scene::open(scene).unwrap().render(options).unwrap();
        picture.encode().unwrap()
    };
    assert_eq!(
        rendered(&globe, &small),
        by_command(&globe, "a.png", &arguments)
    );
    let linear = small.format(Format::Exr).layer(Aov::Depth);
    let wide = [&arguments[..], &["--aov", "depth"]].concat();
    assert_eq!(
        rendered(&globe, &linear),
        by_command(&globe, "a.exr", &wide)
    );
    // An asset: framed, in the studio, toned.
    let asset = path("tests/render/asset/binary.glb");
    let toned = Options::new()
        .size(20, 20)
        .samples(4)
        .tonemap(Tone::Agx)
        .transparent();
    let arguments = "--size 20x20 --spp 4 --tonemap agx --background transparent";
    let arguments: Vec<_> = arguments.split(' ').collect();
    assert_eq!(
        rendered(&asset, &toned),
        by_command(&asset, "a.png", &arguments)
    );
}

#[test]
fn the_examples_do_what_they_say() {
    let folder = TempDir::new().unwrap();
    let picture = folder.path().join("a.png");
    render::render(&text(&path("scenes/grey-ball.yaml")), &text(&picture)).unwrap();
    let first = fs::read(&picture).unwrap();
    let sun = Light::sun([1.0, 0.4, 0.6], [3.0, 1.6, 0.8]);
    let relit = |light| {
        custom_light::relight(
            &text(&path("scenes/grey-ball.yaml")),
            &text(&picture),
            light,
        )
    };
    relit(sun).unwrap();
    assert_ne!(fs::read(&picture).unwrap(), first, "it is replaced");
    let error = relit(Light::sun([0.0; 3], [1.0; 3])).unwrap_err();
    assert!(
        matches!(&error, Error::Invalid(found) if found.len() == 1),
        "{error}"
    );
    let left: Vec<_> = fs::read_dir(folder.path()).unwrap().collect();
    assert_eq!(left.len(), 1, "no draft stays behind");
    let lines = check::check(&text(&path("tests/diagnostics/SC001/misspelt.yaml"))).unwrap();
    let edits: Vec<_> = lines
        .iter()
        .filter(|line| line.starts_with("  bytes"))
        .collect();
    assert!(
        lines[0].contains("misspelt.yaml:12:3: warning[SC001]"),
        "{lines:?}"
    );
    assert!(edits[0].ends_with("become `radius`"), "{lines:?}");
}

#[test]
fn findings_say_what_and_where_and_errors_hold_them() {
    let broken = "Eye: [0, 0, 9]\nObjects:\n- {type: sphere, position: [0, 0, 0], raduis: 1}\n";
    let files = [("a/b.yaml".to_owned(), broken.as_bytes().to_vec())];
    let scene = Scene::from_files("a/b.yaml", files).unwrap();
    let findings = scene.check();
    let typo = findings.iter().find(|found| found.code == "SC001").unwrap();
    let place = &typo.primary.as_ref().unwrap().location;
    assert_eq!(
        (place.file.as_str(), place.line, place.column),
        ("a/b.yaml", Some(3), Some(39))
    );
    assert_eq!(broken.get(place.bytes.clone()), Some("raduis"));
    assert!(typo.to_string().contains("did you mean `radius`"), "{typo}");
    let error = scene.render(&Options::new()).unwrap_err();
    assert!(
        error
            .diagnostics()
            .iter()
            .any(|found| found.severity == Severity::Error)
    );
    assert!(error.to_string().contains("a/b.yaml:3"), "{error}");
    let missing = Scene::open("no/such/scene.yaml").err().unwrap();
    assert_eq!(missing.diagnostics()[0].code, "IO001", "{missing}");
}

#[test]
fn what_is_found_does_not_add_up() {
    let mut scene = ball();
    assert_eq!(scene.check(), []);
    scene.add_light(Light::point([0.0; 3], [-1.0; 3]));
    assert_eq!((scene.lights(), scene.check().len()), (2, 1));
    assert_eq!(scene.check().len(), 1);
    scene.remove_lights();
    assert_eq!((scene.lights(), scene.check()), (0, vec![]));
}

#[test]
fn effects_are_those_of_the_scene_as_it_is_asked_for() {
    let scene = ball();
    let states = |options: &Options| {
        let effects = scene.effects(options).unwrap();
        let state = |name: &str| {
            let mut all = effects.iter();
            let own = all.find(|own| own.name == name && own.of.is_none());
            (own.unwrap().state, own.unwrap().rule)
        };
        ["supersampling", "direct light", "shadows"].map(state)
    };
    let [sharp, direct, shadows] = states(&Options::new());
    assert_eq!(sharp, (EffectState::Absent, Some("E-SS")));
    assert_eq!(direct, (EffectState::Needed, None));
    assert_ne!(shadows.0, EffectState::Needed);
    let [smooth, ..] = states(&Options::new().supersampling(2));
    assert_eq!(smooth.0, EffectState::Needed);
    let mut broken = Scene::from_files("a.yaml", [("a.yaml".to_owned(), b"Lights: 3".to_vec())]);
    let error = broken.as_mut().unwrap().effects(&Options::new());
    assert!(matches!(error, Err(Error::Invalid(findings)) if !findings.is_empty()));
}

/// The files that a scene with a mesh and a texture is of.
fn files(names: &[&str]) -> Vec<(String, Vec<u8>)> {
    let read = |name: &&str| {
        let bytes = fs::read(path("scenes").join(name)).unwrap();
        (format!("deep/in/{name}"), bytes)
    };
    names.iter().map(read).collect()
}

#[test]
fn a_scene_in_memory_is_that_on_disk_and_reads_no_other_file() {
    for (name, others) in [
        ("globe.yaml", ["tiles.png"]),
        ("terminator.yaml", ["ball.obj"]),
        ("vases.yaml", ["vase.glb"]),
    ] {
        let options = Options::new().size(16, 12).supersampling(1).samples(1);
        let on_disk = Scene::open(path("scenes").join(name)).unwrap();
        let rendered = |scene: Scene| scene.render(&options).unwrap().encode().unwrap();
        let all = files(&[&[name][..], &others].concat());
        let main = format!("deep/in/{name}");
        let in_memory = Scene::from_files(&main, all).unwrap();
        assert!(rendered(in_memory) == rendered(on_disk), "{name}");
        // What is not among the files is not there, wherever the process runs.
        let alone = Scene::from_files(&main, files(&[name])).unwrap().check();
        assert!(
            alone.iter().any(|found| found.code.starts_with("RE")),
            "{alone:?}"
        );
    }
    let secret = BALL.replace("color: [1, 0.5, 0.2]", "texture: /etc/hostname");
    let files = [("ball.yaml".to_owned(), secret.into_bytes())];
    let found = Scene::from_files("ball.yaml", files).unwrap().check();
    assert!(
        found.iter().any(|found| found.code.starts_with("RE")),
        "{found:?}"
    );
}

#[test]
fn a_name_that_leads_up_finds_what_lies_there_in_memory() {
    let text = String::from_utf8(fs::read(path("scenes/globe.yaml")).unwrap()).unwrap();
    let text = text.replace("tiles.png", "../maps/tiles.png");
    let tiles = fs::read(path("scenes/tiles.png")).unwrap();
    let files = [
        ("./scenes/globe.yaml".to_owned(), text.into_bytes()),
        ("maps/tiles.png".to_owned(), tiles),
    ];
    let scene = Reading::new()
        .from_files("scenes/globe.yaml", files)
        .unwrap();
    let found = scene.check();
    assert!(
        found.iter().all(|found| found.severity == Severity::Note),
        "{found:?}"
    );
}

#[test]
fn a_denoised_picture_says_its_error() {
    let scene = ball();
    let options = Options::new().size(40, 40).trace_paths(true).samples(4);
    let plain = scene.render(&options).unwrap();
    let denoised = scene.render(&options.clone().denoise(true)).unwrap();
    assert_eq!(plain.error(), None);
    assert!(denoised.error().is_some_and(|error| error > 0.0));
    assert!(denoised.pixels() != plain.pixels());
    let good = scene.render(&options.clone().denoise(true).target_error(0.5));
    let good = good.unwrap();
    assert!(good.error().is_some_and(|error| error <= 0.5));
    assert!(good.statistics().rays > denoised.statistics().rays);
    let hasty = options.denoise(true).time_budget(Duration::from_secs(1));
    assert!(refusal(&hasty).contains("no time budget"));
}

#[test]
fn a_target_error_is_reached_and_said() {
    let scene = path("scenes/mirrors.yaml");
    let options = Options::new().size(40, 40).target_error(2.0);
    let picture = Scene::open(&scene).unwrap().render(&options).unwrap();
    assert!(
        picture
            .error()
            .is_some_and(|error| error > 0.0 && error <= 2.0)
    );
    let words = ["--size", "40", "--target-error", "2"];
    assert!(picture.encode().unwrap() == by_command(&scene, "x.png", &words));
    assert_eq!(ball().render(&Options::new()).unwrap().error(), None);
    assert!(refusal(&Options::new().layer(Aov::Error)).contains("`error`"));
    let denoised = Options::new().layer(Aov::Samples).denoise(true);
    assert!(refusal(&denoised).contains("`--denoise`"));
    assert!(refusal(&Options::new().target_error(0.0)).contains("above 0"));
}

/// The layers add up to what is said of the whole picture.
#[test]
fn the_error_of_each_pixel_is_a_layer() {
    let layers = [Aov::Depth, Aov::Error, Aov::Samples, Aov::Undersampled];
    let options = Options::new().size(40, 40).target_error(2.0);
    let options = layers.into_iter().fold(options, Options::layer);
    let scene = Scene::open(path("scenes/mirrors.yaml")).unwrap();
    let picture = scene.render(&options).unwrap();
    let [depth, error, samples, unmet] = layers.map(|aov| picture.layer(aov).unwrap());
    // The mean square of the errors is the noise, which the bound covers.
    let squares = error
        .iter()
        .map(|error| f64::from(*error) * f64::from(*error));
    let noise = 255.0 * (squares.sum::<f64>() / error.len() as f64).sqrt();
    let bound = picture.error().unwrap();
    assert!(noise > 0.3 * bound && noise <= bound, "{noise} {bound}");
    // Three hits are missed in 5 % of all pictures (the rule of three); no sample is above white.
    assert_eq!([depth.len(), samples.len(), unmet.len()], [1600; 3]);
    for (samples, unmet) in samples.iter().zip(&unmet) {
        assert!(
            *unmet >= 3.0 / samples && *unmet <= 3.75 / samples,
            "{samples} {unmet}"
        );
    }
    assert!(samples.iter().any(|count| *count > samples[0]) || samples[0] > 8.0);
}

/// The errors told of a fixed number of paths are those from a picture of far more.
#[test]
fn the_error_of_each_pixel_is_known_without_a_target() {
    let scene = Scene::open(path("tests/render/camera/anaglyph-paths.yaml")).unwrap();
    let layers = [Aov::Error, Aov::Samples, Aov::Undersampled];
    let plain = Options::new().samples(32);
    let options = layers
        .into_iter()
        .fold(Options::new().samples(32), Options::layer);
    let picture = scene.render(&options).unwrap();
    assert!(picture.pixels() == scene.render(&plain).unwrap().pixels());
    let [error, samples, unmet] = layers.map(|aov| picture.layer(aov).unwrap());
    let converged = scene.render(&Options::new().samples(1024)).unwrap();
    let pairs = || picture.pixels().iter().zip(converged.pixels());
    let off = |c: usize| pairs().map(move |(a, b)| (a[c] - b[c]) * (a[c] - b[c]));
    let off: f64 = (0..3).flat_map(off).sum();
    let told: f64 = error.iter().map(|error| f64::from(*error).powi(2)).sum();
    let ratio = (told / off).sqrt();
    assert!((0.8..2.0).contains(&ratio), "{ratio}");
    assert!(samples.iter().all(|count| *count == 32.0));
    // A blue sky may be brighter than white in an anaglyph, as the matrices say.
    assert!(
        unmet
            .iter()
            .all(|unmet| (*unmet - 3.0 * 1.2264 / 32.0).abs() < 1e-5),
        "{unmet:?}"
    );
}

#[test]
fn a_render_is_stopped_and_limited() {
    let scene = ball();
    let stopped = scene.render_until(&Options::new(), &|| true).unwrap_err();
    assert!(matches!(stopped, Error::Stopped), "{stopped}");
    let error = scene.render(&Options::new().max_rays(10)).unwrap_err();
    assert!(matches!(error, Error::TooManyRays(_)), "{error}");
    let picture = scene.render(&Options::new()).unwrap();
    let statistics = picture.statistics();
    assert!(statistics.hits > 0 && statistics.hits < statistics.camera_rays);
    assert!(statistics.camera_rays <= 1600);
}

fn refusal(options: &Options) -> String {
    match ball().render(options) {
        Err(Error::Refused(words)) => words,
        Err(error) => panic!("{error}"),
        Ok(_) => panic!("it is rendered"),
    }
}

#[test]
fn options_that_do_not_fit_are_refused() {
    let new = Options::new;
    let linear = || new().format(Format::Exr);
    for options in [
        new().size(0, 4),
        new().samples(0),
        new().exposure(f64::NAN),
        linear().auto_exposure(),
        linear().tonemap(Tone::Agx),
        new().background([f64::INFINITY; 3]),
        new().environment([-1.0; 3]),
        new().look_at([f64::NAN; 3], [0.0; 3]),
        new().crop([90, 90], [4, 4]),
    ] {
        assert!(!refusal(&options).contains("--"), "{}", refusal(&options));
    }
}

#[test]
fn a_picture_is_saved_by_its_kind_or_not_at_all() {
    let folder = TempDir::new().unwrap();
    let to = |name: &str| folder.path().join(name);
    let picture = ball().render(&Options::new()).unwrap();
    let error = picture.save(to("a.exr")).unwrap_err();
    assert!(matches!(error, Error::Refused(_)), "{error}");
    assert!(
        error
            .to_string()
            .ends_with("render it with the format `exr`"),
        "{error}"
    );
    let error = picture.save(to("none/a.png")).unwrap_err();
    assert!(matches!(error, Error::Unwritable { .. }), "{error}");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    picture.save(to("a.png")).unwrap();
    assert_eq!(fs::read(to("a.png")).unwrap(), picture.encode().unwrap());
}

/// The middle of the picture, and its first corner.
fn two(picture: &Picture) -> [[u8; 4]; 2] {
    let bytes = picture.rgba8();
    let at = |index: usize| bytes[4 * index..4 * index + 4].try_into().unwrap();
    [at(20 * 40 + 20), at(0)]
}

#[test]
fn bytes_are_those_of_the_file_and_values_those_of_the_scene() {
    let scene = ball();
    let rendered = |options: Options| scene.render(&options).unwrap();
    let shown = rendered(Options::new());
    assert_eq!(
        (shown.width(), shown.height(), shown.alpha()),
        (40, 40, None)
    );
    let [middle, corner] = two(&shown);
    let value = shown.pixels()[20 * 40 + 20];
    assert_eq!(middle[0], (255.0 * value[0]) as u8);
    assert_eq!(corner, [0, 0, 0, 255]);
    let clear = rendered(Options::new().transparent());
    assert_eq!(two(&clear), [middle, [0; 4]]);
    let linear = Options::new()
        .format(Format::Exr)
        .layer(Aov::Depth)
        .transparent();
    let linear = rendered(linear);
    let depth = linear.layer(Aov::Depth).unwrap();
    assert!((depth[20 * 40 + 20] - 86.0).abs() < 0.1 && depth[0] == 1e10);
    assert_eq!(linear.layer(Aov::Albedo), None);
    assert_eq!(two(&linear)[1], [0; 4]);
    assert!(two(&linear)[0][0] >= middle[0], "coded by sRGB");
}
