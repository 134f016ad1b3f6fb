//! The stages on untrusted bytes: the entry points of the fuzz targets, also run by the test suite
//! on regression inputs.
//!
//! No function may panic for any bytes. The other guarantees of a stage are asserted here.

use super::{FixFilter, Input, Options, RenderShard, load, render, validate};
use arbitrary::{Arbitrary, Unstructured};
use rtc_codec::{self as codec, Encoding};
use rtc_color::Tone;
use rtc_diag::{self as diag, DiagnosticPrinter, DiagnosticSink, Format, Severity};
use rtc_emit as emit;
use rtc_front::course;
use rtc_ir::{LoweredScene, Material, Mode, Scene, SourceSpans};
use rtc_plan::{Plan, RuleSet};
use rtc_render::{Background, RenderSelection, Values};
use rtc_source::{Budget, FileId, Loader, SourceMap};
use rtc_study::{ProgressiveRender, RenderGoal, RenderRequest};
use rtc_valid as valid;
use std::path::Path;

/// The limit on counts of a scene that is rendered here.
const TINY: u32 = 4;

/// Lowers a text of the course and formats it.
///
/// # Panics
/// If the text is rejected without an error, or formatting is not idempotent.
pub fn lower(bytes: &[u8]) {
    let (map, file) = source(bytes);
    if let Ok(text) = course::format_text(file, &map, &mut DiagnosticSink::default()) {
        let (map, file) = source(text.as_bytes());
        let again = course::format_text(file, &map, &mut DiagnosticSink::default());
        assert_eq!(again, Ok(text), "a layout is laid out already");
    }
    let mut sink = DiagnosticSink::default();
    let lowered = course::lower(file, &map, &Options::default().front, &mut sink);
    assert!(
        lowered.is_some() || sink.has_errors(),
        "a text is refused with an error"
    );
}

/// Reads and validates a scene of any format.
///
/// # Panics
/// If there is neither a valid scene nor an error, or both, or encoding and decoding changes a
/// valid scene.
pub fn check(bytes: &[u8]) {
    check_as("trial", bytes);
}

/// The same for a glTF asset as JSON.
///
/// # Panics
/// As [`check`].
pub fn gltf(bytes: &[u8]) {
    check_as("trial.gltf", bytes);
}

/// The same for a binary glTF asset.
///
/// # Panics
/// As [`check`].
pub fn glb(bytes: &[u8]) {
    check_as("trial.glb", bytes);
}

fn check_as(name: &str, bytes: &[u8]) {
    let mut map = SourceMap::default();
    let file = map.add(name, bytes.to_vec());
    is_valid_or_rejected(file, &mut map);
}

/// Reads and validates a scene file with the files it refers to, renders a few pixels, and prints
/// its diagnostics.
///
/// # Panics
/// As [`check`] and [`picture`], or if printed text contains control characters.
pub fn file(path: &Path) {
    let mut map = SourceMap::default();
    let Ok(file) = Loader.file(path, &mut map) else {
        return;
    };
    let (sink, scene) = is_valid_or_rejected(file, &mut map);
    let name = map.name(file).to_owned();
    // SARIF has the content of JSON after a long constant table.
    for format in [Format::Human, Format::Short, Format::Json, Format::Github] {
        let options = diag::PrintOptions {
            color: false,
            width: 100,
            least: Severity::Note,
            max: 100,
        };
        let mut printer = DiagnosticPrinter::new(format, options);
        let text = printer.file(&name, sink.clone(), &map) + &printer.finish();
        assert!(
            !text.contains(|c: char| c.is_control() && c != '\n'),
            "{format:?} is harmless text: {text:?}"
        );
    }
    scene.into_iter().for_each(is_picture);
}

/// The diagnostics, and the scene if it is valid.
fn is_valid_or_rejected(file: FileId, map: &mut SourceMap) -> (DiagnosticSink, Option<Scene>) {
    let (mut sink, options) = (DiagnosticSink::default(), Options::default());
    let lowered = load(file, map, &options, &mut sink);
    let validated = lowered
        .as_ref()
        .and_then(|lowered| validate(lowered, &options, &mut sink));
    assert_eq!(
        validated.is_none(),
        sink.has_errors(),
        "a proof or an error, never both"
    );
    let scene = lowered
        .filter(|_| validated.is_some())
        .map(|lowered| lowered.scene);
    scene.iter().for_each(round_trips);
    (sink, scene)
}

/// Reads a shard, as it is and with corrected checksums.
///
/// # Panics
/// If saving and reading changes it.
pub fn part(bytes: &[u8]) {
    /// Larger pictures would take too long.
    const MOST: u64 = 1 << 12;
    for bytes in [bytes.to_vec(), super::shard::with_valid_checksums(bytes)] {
        let Ok(part) = RenderShard::load(&bytes, MOST) else {
            continue;
        };
        let saved = part.save();
        let again = RenderShard::load(&saved, MOST).map(|part| part.save());
        assert!(again.as_ref() == Ok(&saved), "what is saved can be read");
        let _ = part.develop();
        let _ = part.command(1);
        has_grown(part);
    }
}

/// Checks that the progressive state survives reading and saving.
fn has_grown(mut part: RenderShard) {
    let order = RenderRequest {
        goal: RenderGoal::default(),
        crop: part.window(),
        background: Background::default(),
        values: Values::default(),
        display: (Tone::Srgb, 1.0),
        keep_lights: false,
        seed: 0,
    };
    let growth = part.take_growth();
    if let Ok(grown) = ProgressiveRender::load(&growth, &order) {
        assert!(grown.save() == growth, "it has grown as far as it had");
    }
}

/// Decodes bytes in both encodings of the IR.
///
/// # Panics
/// If there is neither a scene nor an error, or encoding and decoding changes a scene.
pub fn decode(bytes: &[u8]) {
    let (map, file) = source(bytes);
    for encoding in [Encoding::Json, Encoding::Binary] {
        let mut sink = DiagnosticSink::default();
        let scene = codec::decode(encoding, file, &map, &mut sink);
        assert_eq!(
            scene.is_none(),
            sink.has_errors(),
            "a scene or an error, never both"
        );
        scene.iter().for_each(round_trips);
    }
}

/// Validates the scene that `Arbitrary` makes from the bytes.
///
/// # Panics
/// If there is neither a valid scene nor an error, or both.
pub fn validate_any(bytes: &[u8]) {
    let Ok(scene) = Scene::arbitrary(&mut Unstructured::new(bytes)) else {
        return;
    };
    let mut sink = DiagnosticSink::default();
    let validated = valid::validate(
        &scene,
        &SourceSpans::default(),
        &Options::default().valid,
        &mut sink,
    );
    assert_eq!(
        validated.is_none(),
        sink.has_errors(),
        "a proof or an error, never both"
    );
}

/// Exports a scene of any format, and the scene that `Arbitrary` makes from the bytes, to the
/// formats that can be read again.
///
/// # Panics
/// As [`is_written`].
pub fn written(bytes: &[u8]) {
    let (mut map, file) = source(bytes);
    let lowered = load(
        file,
        &mut map,
        &Options::default(),
        &mut DiagnosticSink::default(),
    );
    let scene = Scene::arbitrary(&mut Unstructured::new(bytes)).ok();
    let scenes = lowered
        .map(|lowered| lowered.scene)
        .into_iter()
        .chain(scene);
    scenes.for_each(is_written);
}

/// Exports a valid scene as glTF and, if it needs no sidecar files, as text of the course.
///
/// # Panics
/// If the result is rejected when read, or there is neither a result nor an error, or exporting the
/// text again changes it.
pub fn is_written(scene: Scene) {
    let source_spans = SourceSpans::default();
    let lowered = LoweredScene {
        scene,
        source_spans,
    };
    let (options, mut sink) = (Options::default(), DiagnosticSink::default());
    if validate(&lowered, &options, &mut sink).is_none() {
        return;
    }
    let LoweredScene {
        scene,
        source_spans,
    } = &lowered;
    let budget = Budget::default();
    match emit::gltf::emit(scene, source_spans, None, None, &budget, &mut sink) {
        None => assert!(sink.has_errors(), "a failed export has an error"),
        Some(asset) => {
            let mut bytes = Vec::new();
            let write = asset.write(&mut bytes);
            write.expect("memory takes all");
            is_accepted("trial.glb", bytes);
        }
    }
    let needs_files = !scene.images.is_empty() || !scene.meshes.is_empty();
    if let (false, Ok(text)) = (needs_files, emit::course::emit(scene)) {
        let again = is_accepted("trial.yaml", text.clone().into_bytes());
        assert_eq!(emit::course::emit(&again).as_ref(), Ok(&text));
    }
}

/// Reads an exported scene, which must be valid.
fn is_accepted(name: &str, bytes: Vec<u8>) -> Scene {
    let (mut map, mut sink, options) = (
        SourceMap::default(),
        DiagnosticSink::default(),
        Options::default(),
    );
    let file = map.add(name, bytes);
    let lowered = load(file, &mut map, &options, &mut sink);
    let validated = lowered.filter(|lowered| validate(lowered, &options, &mut sink).is_some());
    let is_error = |diagnostic: &&diag::Diagnostic| diagnostic.severity == Severity::Error;
    let errors: Vec<_> = sink.kept().iter().filter(is_error).collect();
    validated
        .unwrap_or_else(|| panic!("{name}: {errors:#?}"))
        .scene
}

/// Applies the suggested fixes of a text, without and with guesses.
///
/// # Panics
/// If it has more errors afterwards.
pub fn fix(bytes: &[u8]) {
    // The folder does not exist, so no other file is found.
    let (path, options) = (Path::new("nowhere/trial.yaml"), Options::default());
    let Ok(text) = std::str::from_utf8(bytes) else {
        return;
    };
    let errors = |text: &str| {
        let mut input = Input::edited(path, text.as_bytes().to_vec(), options.clone());
        if let Some(loaded) = input.load() {
            input.validate(loaded, |_, _| ());
        }
        let sink = input.take_diagnostics();
        let is_error = |diagnostic: &&diag::Diagnostic| diagnostic.severity == Severity::Error;
        sink.kept().iter().filter(is_error).count()
    };
    for guesses in [false, true] {
        let wish = FixFilter {
            guesses,
            only: None,
        };
        let fixed = super::fix(path, text, &options, &wish);
        let is_worse = fixed.changes > 0 && errors(&fixed.text) > errors(text);
        assert!(!is_worse, "{}", fixed.text);
    }
}

/// Renders a few pixels of a scene of any format.
///
/// # Panics
/// If a pixel is not in [0, 1].
pub fn picture(bytes: &[u8]) {
    let (mut map, file) = source(bytes);
    let lowered = load(
        file,
        &mut map,
        &Options::default(),
        &mut DiagnosticSink::default(),
    );
    lowered
        .into_iter()
        .for_each(|lowered| is_picture(lowered.scene));
}

fn is_picture(mut scene: Scene) {
    make_tiny(&mut scene);
    let lowered = LoweredScene {
        scene,
        source_spans: SourceSpans::default(),
    };
    let Some(validated) = validate(
        &lowered,
        &Options::default(),
        &mut DiagnosticSink::default(),
    ) else {
        return;
    };
    let film = render(
        &validated,
        &Plan::new(&validated, RuleSet::ALL),
        &RenderSelection::default(),
        1,
        &|_| true,
    )
    .expect("the system gives one thread");
    let image = film.expect("nobody said stop").image;
    let inside = |channel: &f64| (0.0..=1.0).contains(channel);
    assert!(
        image.pixels.iter().flatten().all(inside),
        "every channel is in [0, 1]: {:?}",
        image.pixels
    );
}

fn source(bytes: &[u8]) -> (SourceMap, FileId) {
    let mut map = SourceMap::default();
    let file = map.add("trial", bytes.to_vec());
    (map, file)
}

fn round_trips(scene: &Scene) {
    for encoding in [Encoding::Json, Encoding::Binary] {
        let bytes =
            codec::encode(encoding, scene).expect("a scene that was read holds finite numbers");
        assert_eq!(
            codec::detect_format(&bytes),
            Some(encoding),
            "what was encoded is recognised"
        );
        let (map, file) = source(&bytes);
        let mut sink = DiagnosticSink::default();
        let back = codec::decode(encoding, file, &map, &mut sink);
        assert_eq!(back.as_ref(), Some(scene), "{encoding:?}: {sink:?}");
    }
}

/// Bounds the work of a picture, and keeps the view.
fn make_tiny(scene: &mut Scene) {
    let Scene {
        camera,
        settings,
        lights,
        images: _,
        textures: _,
        meshes: _,
        materials,
        surfaces,
        names,
        environment: _,
        medium: _,
        display: _,
        trees: _,
    } = scene;
    camera.size = camera.size.map(|pixels| pixels.min(2 * TINY));
    camera.lens.samples = camera.lens.samples.min(TINY);
    settings.max_depth = settings.max_depth.min(TINY);
    settings.supersampling = settings.supersampling.min(2);
    settings.light_samples = settings.light_samples.min(TINY);
    lights.truncate(TINY as usize);
    surfaces.truncate(8 * TINY as usize);
    names.clear();
    if let Mode::Path(path) = &mut settings.mode {
        path.samples = path.samples.min(TINY);
    }
    for material in materials.iter_mut().filter_map(Material::phong_mut) {
        material.glossy_samples = material.glossy_samples.min(TINY / 2);
    }
}
