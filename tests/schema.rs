//! The schema of scenes: the committed file is current, and it takes exactly what the decoder takes
//! under `--strict`.
//!
//! Agreement is tried on every fixture and scene and on seeded mutants of them. With `RTC_UPDATE=1`
//! the file is rewritten.

#![expect(
    clippy::unwrap_used,
    clippy::disallowed_methods,
    reason = "a test stops at the first surprise and reads what it checks"
)]
use crate::repo::{files, root};
use rtc::internals::diag::{DiagnosticSink, Severity};
use rtc::internals::front::{self, ForeignFormat, course, gltf, support_page};
use rtc::internals::pipeline;
use rtc::internals::source::{SourceMap, budget};
use serde_json::{Value, json};
use std::fs;
use std::path::{Path, PathBuf};

/// Codes of errors that no schema can state: relations between values, and limits on the work.
/// Beside them, those of the files a scene names.
const DECODER_ONLY: &[&str] = &[
    "SC007", "VA001", "VA002", "VA003", "VA009", "VA010", "VA012", "VA013", "VA015", "VA016",
    "VA019", "VA021", "VA104", "VA105", "VA106", "VA107", "VA110",
];

const MUTANTS: u32 = 8_000;

#[test]
fn the_committed_schema_and_page_are_current() {
    let schema = format!("{:#}\n", course::schema());
    let pages = [
        ("scene.schema.json", schema),
        ("course-format.md", course::page()),
        ("limits.md", budget::page()),
        ("gltf-extensions.md", gltf::extensions()),
        ("support.md", support_page(&ForeignFormat::ALL)),
    ];
    for (name, current) in pages {
        let path = root("schema").join(name);
        if std::env::var_os("RTC_UPDATE").is_some() {
            fs::write(&path, &current).unwrap();
        }
        assert_eq!(
            fs::read_to_string(&path).unwrap(),
            current,
            "run again with RTC_UPDATE=1"
        );
    }
}

#[test]
fn every_property_says_what_it_is() {
    let schema = course::schema();
    for (name, record) in schema["$defs"].as_object().unwrap() {
        // An object and an operand are lists of rules over the records.
        for (key, property) in record["properties"].as_object().into_iter().flatten() {
            let silent = property != &Value::Bool(false)
                && property["description"].as_str().is_none_or(str::is_empty);
            assert!(!silent, "`{key}` of {name} has no description");
        }
    }
    let camera = &schema["$defs"]["camera"]["properties"];
    assert_eq!(camera["apertureSamples"]["default"], json!(1));
    assert_eq!(
        camera["viewSize"]["anyOf"][0]["items"]["maximum"],
        json!(65_535)
    );
}

/// The scenes of the repository and all fixtures that a YAML reader takes, as JSON.
fn documents() -> Vec<(String, Value)> {
    let folders = ["scenes", "tests/diagnostics", "tests/render/record"].into_iter();
    let paths = folders.flat_map(|folder| files(&root(folder), &["yaml"]));
    let read = |path: PathBuf| as_json(&path).map(|value| (path.display().to_string(), value));
    let mut found: Vec<_> = paths.filter_map(read).collect();
    found.sort_by(|a, b| a.0.cmp(&b.0));
    found
}

/// The document as JSON; nothing for texts JSON can't say (not UTF-8, `.nan`, duplicate keys, keys
/// that are lists).
fn as_json(path: &Path) -> Option<Value> {
    let text = String::from_utf8(fs::read(path).unwrap()).ok()?;
    let mut yaml: serde_yaml::Value = serde_yaml::from_str(&text).ok()?;
    yaml.apply_merge().ok()?;
    let json = serde_json::to_value(&yaml).ok()?;
    // What is not finite becomes null on the way.
    (!text.contains(".inf") && !text.contains(".nan") && !text.contains("1e400")).then_some(json)
}

/// The codes of the errors found in a document under `--strict`.
fn errors(document: &Value) -> Vec<&'static str> {
    let mut map = SourceMap::default();
    let file = map.add("document", document.to_string().into_bytes());
    let mut sink = DiagnosticSink::default();
    let strict = front::FrontOptions {
        strict: true,
        ..front::FrontOptions::default()
    };
    let options = pipeline::Options {
        front: strict,
        ..pipeline::Options::default()
    };
    if let Some(lowered) = pipeline::load(file, &mut map, &options, &mut sink) {
        let _ = pipeline::validate(&lowered, &options, &mut sink);
    }
    sink.kept()
        .iter()
        .filter(|d| d.severity == Severity::Error)
        .map(|d| d.code.id)
        .collect()
}

/// What is wrong with the agreement on a document, if anything.
fn disagreement(validator: &jsonschema::Validator, document: &Value) -> Option<String> {
    let errors = errors(document);
    let stated = errors
        .iter()
        .any(|code| !code.starts_with("RE") && !DECODER_ONLY.contains(code));
    let valid = validator.is_valid(document);
    let first = || {
        validator
            .iter_errors(document)
            .next()
            .map(|error| format!("{error} at {}", error.instance_path()))
    };
    match (valid, stated) {
        // The schema may state what only the proof finds elsewhere, as a radius of 0.
        (false, false) if errors.is_empty() => {
            Some(format!("only the schema refuses: {:?}", first()))
        }
        (true, true) => Some(format!("only the decoder refuses: {errors:?}")),
        (true, false) | (false, _) => None,
    }
}

#[test]
fn schema_and_decoder_agree_on_every_document() {
    let validator = jsonschema::validator_for(&course::schema()).unwrap();
    let documents = documents();
    assert!(documents.len() > 50, "the fixtures are there");
    for (name, document) in documents {
        let fault = disagreement(&validator, &document);
        assert!(fault.is_none(), "{name}: {}", fault.unwrap());
    }
}

/// A small generator (SplitMix64), so that the same mutants are tried everywhere.
struct Random(u64);

impl Random {
    fn below(&mut self, limit: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        usize::try_from((z ^ (z >> 31)) % limit as u64).unwrap()
    }

    fn pick<T: Clone>(&mut self, list: &[T]) -> T {
        list[self.below(list.len())].clone()
    }
}

/// Keys and values that mutants are made of.
fn material() -> (Vec<&'static str>, Vec<Value>) {
    let keys = "type position center O a b c N n normal distance d v0 v1 v2 v3 p0 p1 p2 position1 radius r material \
                color texture bump ka kd ks kt refract eta index glossySamples eye up viewSize apertureRadius \
                apertureSamples Camera Eye RenderMode renderMode Shadows shadow MaxRecursionDepth MaxIterations \
                SuperSampling AntiAlias GoochParameters alpha factor Lights Objects $schema other p3 p4 a d angle axis \
                rotation side depth min max dimension direction height h ends p1 center1 center2 uv0 uv1 uv2 uv3 typ file \
                path scale size normalMap specularMap pattern AA Reflections LightSamples CameraEye CameraLookPoint \
                CameraUpVector Environment irradiance fov ImageSize Resolution AspectRatio SoftShadows \
                AntiAliasing width x y nt isTransparent intensity range innerAngle outerAngle projection matrix transform label \
                ToneMap Exposure PathParameters samples baseColor baseColorMap roughness alpha ior wrap filter set";
    let values = json!([
        null, true, 0, 1, -1, 3, 0.5, -0.5, 2.0, 4.0, 70_000, 5e9, 1e-3, "text", "phong", "Z-Buffer", "gooch", "sphere",
        "plane", "triangle", "torus", "quad", "circle", "disk", "cylinder", "cone", "box", "mesh", "model", "bplane",
        "tetrahedron", "prism", "gltf", "sun", "point", "path", "jitter", "earth.png", [3, [0, 1, 0]], [3, 4], [0.5, 0.5], "", "1", "true", [], {}, [1, 2, 3], [0, 0, 1], [0.5, 1, 2], [1, 2], [1, 2, 3, 4],
        [1, "2", 3], [-1, 0, 0], [40, 30], [0, 5], [1.5, 2], { "factor": 2 }, { "factor": 0 }, { "b": 0.4 }, "On", "off", "refraction",
        { "x": 40, "y": 30 }, [{ "width": 40 }, { "height": 30 }], [{ "w": 40, "h": 30 }], "standard",
        "spot", "blend", "clamp", "orthographic", ["repeat", "mirror"], { "mask": 0.5 }, { "file": "earth.png", "set": 1 },
        { "samples": 3 }, { "type": "standard" }, [1, 0, 0, 0, 1, 0, 0, 0, 1], [1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0]
    ]);
    (
        keys.split_whitespace().collect(),
        values.as_array().unwrap().clone(),
    )
}

/// All places of a document, as JSON pointers.
fn places(value: &Value, at: &str, found: &mut Vec<String>) {
    found.push(at.to_owned());
    match value {
        Value::Object(map) => map
            .iter()
            .for_each(|(key, value)| places(value, &format!("{at}/{key}"), found)),
        Value::Array(list) => {
            list.iter()
                .enumerate()
                .for_each(|(index, value)| places(value, &format!("{at}/{index}"), found));
        }
        Value::Null | Value::Bool(_) | Value::Number(_) | Value::String(_) => {}
    }
}

/// Replaces a value, or removes, adds or renames a key or item.
fn mutate(document: &mut Value, random: &mut Random) {
    let (keys, values) = material();
    let mut found = Vec::new();
    places(document, "", &mut found);
    let Some(place) = document.pointer_mut(&random.pick(&found)) else {
        return;
    };
    match (random.below(4), place) {
        (0, place) => *place = random.pick(&values),
        (1, Value::Object(map)) if !map.is_empty() => {
            let key = map.keys().nth(random.below(map.len())).unwrap().clone();
            map.remove(&key);
        }
        (2, Value::Object(map)) => {
            map.insert(random.pick(&keys).to_owned(), random.pick(&values));
        }
        (3, Value::Object(map)) if !map.is_empty() => {
            let key = map.keys().nth(random.below(map.len())).unwrap().clone();
            let value = map.remove(&key).unwrap();
            map.insert(random.pick(&keys).to_owned(), value);
        }
        (1, Value::Array(list)) if !list.is_empty() => {
            list.remove(random.below(list.len()));
        }
        (_, Value::Array(list)) => list.push(random.pick(&values)),
        (_, place) => *place = random.pick(&values),
    }
}

#[test]
fn schema_and_decoder_agree_on_mutants() {
    let validator = jsonschema::validator_for(&course::schema()).unwrap();
    let documents = documents();
    let mut random = Random(1);
    let mut sound = 0;
    for number in 0..MUTANTS {
        let (name, mut document) = random.pick(&documents);
        for _ in 0..=random.below(3) {
            mutate(&mut document, &mut random);
        }
        let fault = disagreement(&validator, &document);
        assert!(
            fault.is_none(),
            "mutant {number} of {name}: {}\n{document:#}",
            fault.unwrap()
        );
        sound += u32::from(validator.is_valid(&document));
    }
    assert!(
        sound > MUTANTS / 100 && sound < MUTANTS / 2,
        "the mutants are of both kinds: {sound} sound ones"
    );
}
