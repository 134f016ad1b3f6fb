//! Every two features of a scene together: no rule changes a bit of the picture or adds a ray, and
//! nothing that is told absent or left out is simulated.
//!
//! The features are read off the schema of the IR: variants, optional fields, and the parameters of
//! materials and settings. Each has a row in `features/table.txt`, or a reason there why it has
//! none; so a new field of the IR is crossed before it is merged. Scenes of many features each are
//! made greedily until no pair is left (Cohen, Dalal, Fredman, Patton, "The AETG system", IEEE
//! Transactions on Software Engineering 23, 1997). Shapes, textures and maps meet all three at
//! once. `RTC_SCENES=20 cargo test --test suites plan::features` goes round 20 times, with other
//! values and other companions; `RTC_UPDATE=1` writes what is crossed to `features/crossed.txt`.

use super::dice::Dice;
use super::path_rules::white;
use super::root;
use super::scenes::{base_scene, diffuse};
use crate::ray_counts::{contradictions, difference, film};
use rtc::internals::diag::DiagnosticSink;
use rtc::internals::ir::{self, LoweredScene, Material, Scene, SourceSpans, Standard, Texture};
use rtc::internals::pipeline::{self, Options};
use rtc::internals::plan::{Effect, EffectState, Plan, RuleSet};
use rtc::internals::render::{RenderSelection, verify};
use rtc::internals::valid::ValidScene;
use serde_json::{Map, Value, json};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::{env, fs};

/// The most features of a scene, and of those that show a shape.
const MOST: [usize; 2] = [26, 4];

/// Records of which every field is a feature, required ones too.
const PARAMETERS: [&str; 6] = ["Gooch", "Lens", "Path", "Phong", "Settings", "Standard"];

/// A feature of a scene.
#[derive(Debug, Default)]
struct Feature {
    id: String,
    /// What it chooses where a scene has one of a kind.
    choices: Vec<(String, String)>,
    /// Where it edits the scene, and the values of which one is taken.
    edits: Vec<(String, Vec<Value>)>,
}

impl Feature {
    fn shows_shape(&self) -> bool {
        let mut edits = self.edits.iter();
        edits.any(|(target, _)| target == "shape" || target == "operand")
    }

    /// Why no scene has both.
    fn excluded_by(&self, other: &Self) -> Option<&str> {
        let differs = |(kind, choice): &&(String, String)| {
            let mut others = other.choices.iter();
            others.any(|(another, chosen)| kind == another && choice != chosen)
        };
        self.choices
            .iter()
            .find(differs)
            .map(|(kind, _)| kind.as_str())
    }
}

/// The rows of the table.
struct Features {
    crossed: Vec<Feature>,
    /// The reason for each that is not crossed.
    never: BTreeMap<String, String>,
}

/// The schema of scenes.
fn schema() -> Value {
    serde_json::to_value(schemars::schema_for!(Scene)).unwrap()
}

/// The name of the record or enum that a schema refers to, if it does.
fn reference(schema: &Value) -> Option<&str> {
    let direct = schema["$ref"].as_str();
    let mut any = schema["anyOf"].as_array().into_iter().flatten();
    let name = direct.or_else(|| any.find_map(|schema| schema["$ref"].as_str()))?;
    name.rsplit('/').next()
}

/// The ids of all features in the schema.
fn ids(schema: &Value) -> BTreeSet<String> {
    let definitions = schema["$defs"].as_object().unwrap();
    let variants = |name: &str| {
        let definition = &definitions[name];
        let all = definition["oneOf"].as_array();
        all.or_else(|| definition["anyOf"].as_array())
    };
    let of_fields = |of: String, record: &Value, all: bool| {
        let required = record["required"].as_array().cloned().unwrap_or_default();
        let fields = record["properties"].as_object().into_iter().flatten();
        let is_own = move |(name, field): &(&String, &Value)| {
            let has_variants = reference(field).is_some_and(|name| variants(name).is_some());
            !has_variants && (all || !required.contains(&json!(name)))
        };
        let fields = fields.filter(is_own);
        fields
            .map(|(name, _)| format!("{of}.{name}"))
            .collect::<Vec<_>>()
    };
    let mut ids = BTreeSet::from_iter(of_fields("Scene".to_owned(), schema, false));
    for (name, definition) in definitions {
        let is_parameters = PARAMETERS.contains(&name.as_str());
        ids.extend(of_fields(name.clone(), definition, is_parameters));
        for variant in variants(name).into_iter().flatten() {
            ids.extend(variant["const"].as_str().map(|key| format!("{name}.{key}")));
            let keys = variant["enum"].as_array().into_iter().flatten();
            ids.extend(keys.filter_map(|key| Some(format!("{name}.{}", key.as_str()?))));
            for (key, record) in variant["properties"].as_object().into_iter().flatten() {
                ids.insert(format!("{name}.{key}"));
                ids.extend(of_fields(format!("{name}.{key}"), record, false));
            }
        }
    }
    ids
}

/// The features that the schema doesn't know: whether a texture has one value, and which parts of a
/// surface show it.
const BESIDE: [&str; 5] = [
    "texels.constant",
    "texels.varying",
    "presence.never",
    "presence.somewhere",
    "presence.everywhere",
];

fn edit(text: &str) -> (String, Vec<Value>) {
    let (target, values) = text.trim().split_once(' ').unwrap();
    let values = serde_json::from_str(values).unwrap_or_else(|error| panic!("{text}: {error}"));
    (target.to_owned(), values)
}

fn features() -> Features {
    let (mut crossed, mut never) = (Vec::new(), BTreeMap::new());
    let lines = include_str!("features/table.txt").lines();
    for line in lines.filter(|line| !line.is_empty() && !line.starts_with('#')) {
        if let Some((id, reason)) = line.split_once(" never ") {
            never.insert(id.to_owned(), reason.to_owned());
            continue;
        }
        let [id, choices, edits] = line.splitn(3, '|').collect::<Vec<_>>()[..] else {
            panic!("{line}");
        };
        let choices = choices.split_whitespace().filter_map(|choice| {
            let (kind, choice) = choice.split_once('=')?;
            Some((kind.to_owned(), choice.to_owned()))
        });
        let edits = edits.split(" ; ").filter(|edit| !edit.trim().is_empty());
        crossed.push(Feature {
            id: id.trim().to_owned(),
            choices: choices.collect(),
            edits: edits.map(edit).collect(),
        });
    }
    Features { crossed, never }
}

/// Puts a value where a JSON pointer says, through records that are made on the way.
fn put(scene: &mut Value, pointer: &str, value: Value) {
    let mut at = scene;
    for key in pointer.split('/').skip(1) {
        if at.is_null() {
            *at = json!({});
        }
        if let Value::Array(list) = at {
            if key == "-" {
                list.push(Value::Null);
            }
            let last = list.len() - 1;
            at = &mut list[key.parse().unwrap_or(last)];
        } else {
            let record = at.as_object_mut().unwrap();
            at = record.entry(key).or_insert(Value::Null);
        }
    }
    *at = value;
}

/// The key of a variant with values.
fn variant(value: &Value) -> Option<&String> {
    value.as_object()?.keys().next()
}

/// Moves a shape, or the operands of a solid.
fn shift(shape: &mut Value, by: [f64; 3]) {
    let add = |point: &mut Value| {
        let moved = [0, 1, 2].map(|k| point[k].as_f64().unwrap() + by[k]);
        *point = json!(moved);
    };
    for (key, value) in shape
        .as_object_mut()
        .unwrap()
        .values_mut()
        .flat_map(|of| of.as_object_mut().unwrap())
    {
        match (key.as_str(), value) {
            ("center" | "base", point) => add(point),
            ("vertices", Value::Array(points)) => points.iter_mut().for_each(add),
            ("worldFromObject", matrix) => add(&mut matrix[3]),
            ("operands", Value::Array(operands)) => {
                operands.iter_mut().for_each(|operand| shift(operand, by));
            }
            _ => {}
        }
    }
}

/// A solid of an operand and a ball.
fn solid(operand: &Value, step: &str) -> Value {
    let ball = json!({"sphere": {"center": [0.3, 0.3, 0.4], "radius": 0.6}});
    let steps = ["operand", "operand", step];
    json!({"csg": {"operands": [operand, ball], "steps": steps, "faces": [0, 1]}})
}

/// The scene to which features are added: a material to blend with, and one of each model.
fn base() -> Value {
    let mut scene = base_scene();
    scene.materials = vec![
        Material::Standard(Box::new(Standard {
            base_color: [0.9, 0.2, 0.1, 1.0],
            ..white()
        })),
        Material::Standard(Box::default()),
        Material::Phong(diffuse()),
    ];
    scene.images = vec![image(None, None)];
    scene.textures = vec![Texture::Image(ir::ImageId(0))];
    scene.meshes = vec![ir::Mesh {
        positions: vec![
            [-1.0, -1.0, 0.0],
            [1.0, -1.0, 0.5],
            [1.0, 1.0, 0.0],
            [-1.0, 1.0, 0.5],
        ]
        .into(),
        triangles: vec![[0, 1, 2], [0, 2, 3]].into(),
        ..ir::Mesh::default()
    }];
    serde_json::to_value(scene).unwrap()
}

/// The colours of constant textures.
const COLORS: [[u8; 4]; 4] = [
    [0, 0, 0, 255],
    [255; 4],
    [200, 40, 90, 128],
    [128, 128, 255, 0],
];

/// An image of one colour, or of many.
fn image(kind: Option<&str>, color: Option<[u8; 4]>) -> ir::Image {
    let texel =
        |k: u8| color.unwrap_or([0, 1, 2, 3].map(|channel| (4 * k + channel).wrapping_mul(37)));
    let texels = (0..16).map(texel);
    let (kind, pixels): (_, Vec<u8>) = match kind {
        Some("rgba8") => (ir::Pixels::Rgba8, texels.flatten().collect()),
        Some("rgb32f") => {
            let number = |byte: u8| (f32::from(byte) / 128.0).to_le_bytes();
            let texels = texels.flat_map(|[r, g, b, _]| [r, g, b].map(number));
            (ir::Pixels::Rgb32f, texels.flatten().collect())
        }
        _ => {
            let texels = texels.flat_map(|[r, g, b, _]| [r, g, b]);
            (ir::Pixels::Rgb8, texels.collect())
        }
    };
    ir::Image {
        name: "texels".to_owned(),
        width: 4,
        height: 4,
        kind,
        pixels: pixels.into(),
    }
}

/// What the features choose where a scene has one of a kind.
fn choice<'f>(features: &[&'f Feature], kind: &str) -> Option<&'f str> {
    let mut choices = features.iter().flat_map(|feature| &feature.choices);
    let (_, choice) = choices.find(|(of, _)| of == kind)?;
    Some(choice)
}

/// A shape in one of the places of a scene, which are in rows of four.
fn placed(shape: &Value, place: usize) -> Value {
    let (number, mut shape) = (place as f64, shape.clone());
    let column = number % 4.0;
    let row = (number - column) / 4.0;
    shift(
        &mut shape,
        [1.4 * column - 2.1, 1.2 - 1.2 * row, 0.3 * (number % 3.0)],
    );
    shape
}

/// The scene of some features, in their order in the table.
fn scene(features: &[&Feature], seed: u64) -> Scene {
    let mut dice = Dice::new(seed);
    let mut scene = base();
    let (mut shapes, mut operands) = (Vec::new(), Vec::new());
    let (mut of_surface, mut of_maps) = (Map::new(), Map::new());
    let edits = features.iter().flat_map(|feature| &feature.edits);
    for (target, values) in edits {
        let value = values[dice.roll(values.len() as u32) as usize].clone();
        if target == "shape" {
            shapes.push(value);
        } else if target == "operand" {
            operands.push(value);
        } else if let Some(field) = target.strip_prefix("surface/") {
            of_surface.insert(field.to_owned(), value);
        } else if let Some(field) = target.strip_prefix("map/") {
            of_maps.insert(field.to_owned(), value);
        } else if let Some(pointer) = target.strip_prefix('~') {
            if scene.pointer(pointer).and_then(variant) != variant(&value) {
                put(&mut scene, pointer, value);
            }
        } else {
            put(&mut scene, target, value);
        }
    }
    // Show each shape twice, with either material.
    let step = choice(features, "step").unwrap_or("difference");
    shapes.extend(operands.iter().map(|operand| solid(operand, step)));
    if shapes.is_empty() {
        shapes.push(json!({"sphere": {"center": [0, 0, 0], "radius": 0.7}}));
    }
    for place in 0..2 * shapes.len() {
        let turn = place / shapes.len();
        let shape = placed(&shapes[place % shapes.len()], place);
        let mut surface = json!({"shape": shape, "material": 1 + (place + turn) % 2});
        if place < 2 {
            surface.as_object_mut().unwrap().extend(of_surface.clone());
        }
        put(&mut scene, "/surfaces/-", surface);
    }
    let standard = scene["materials"][1]["standard"].as_object_mut();
    for (_, map) in standard
        .into_iter()
        .flatten()
        .filter(|(name, _)| name.ends_with("Map"))
    {
        map.as_object_mut().unwrap().extend(of_maps.clone());
    }
    let mut scene: Scene = serde_json::from_value(scene).unwrap_or_else(|error| {
        let ids: Vec<_> = features.iter().map(|feature| &feature.id).collect();
        panic!("{error}: {ids:?}");
    });
    let is_constant = choice(features, "texels") == Some("constant");
    let color = is_constant.then(|| dice.pick(&COLORS));
    scene.images = vec![image(choice(features, "pixels"), color)];
    if let (Texture::Procedural(texture), true) = (&mut scene.textures[0], is_constant) {
        texture.colors[1] = texture.colors[0];
    }
    scene
}

/// For every two features, whether they still have to meet.
struct OpenPairs(Vec<Vec<bool>>);

impl OpenPairs {
    fn of(features: &[Feature]) -> Self {
        let meets = |a: &Feature, b: &Feature| a.id != b.id && a.excluded_by(b).is_none();
        let row = |a| features.iter().map(|b| meets(a, b)).collect();
        Self(features.iter().map(row).collect())
    }

    fn count(&self) -> usize {
        let open = self.0.iter().flatten().filter(|is_open| **is_open);
        open.count() / 2
    }

    /// A scene of features that meet, and close their pairs.
    fn next(&mut self, features: &[Feature], dice: &mut Dice) -> Option<Vec<usize>> {
        let start = dice.roll(features.len() as u32) as usize;
        let mut order = (start..features.len()).chain(0..start);
        let is_open = |other: &bool| *other;
        let first = order.find(|feature| self.0[*feature].iter().any(is_open))?;
        let mut chosen = vec![first];
        let fits = |chosen: &[usize], new: usize| {
            let shapes = chosen
                .iter()
                .filter(|k| features[**k].shows_shape())
                .count();
            let mut chosen = chosen.iter().map(|k| &features[*k]);
            let is_full = features[new].shows_shape() && shapes >= MOST[1];
            !is_full
                && chosen.all(|old| {
                    old.id != features[new].id && old.excluded_by(&features[new]).is_none()
                })
        };
        while chosen.len() < MOST[0] {
            let gain = |new: &usize| chosen.iter().filter(|old| self.0[**old][*new]).count();
            let candidates = (0..features.len()).map(|k| (start + k) % features.len());
            let candidates = candidates.filter(|new| fits(&chosen, *new));
            match candidates.max_by_key(gain) {
                Some(new) if gain(&new) > 0 => chosen.push(new),
                _ => break,
            }
        }
        for (a, b) in chosen
            .iter()
            .flat_map(|a| chosen.iter().map(move |b| (*a, *b)))
        {
            self.0[a][b] = false;
        }
        chosen.sort_unstable();
        Some(chosen)
    }
}

/// Scenes in which every two features meet, each by its features.
fn covering(features: &[Feature], round: u64) -> Vec<Vec<usize>> {
    let (mut open, mut dice) = (OpenPairs::of(features), Dice::new(round));
    let scenes = std::iter::from_fn(|| open.next(features, &mut dice)).collect();
    assert_eq!(open.count(), 0, "pairs that never meet");
    scenes
}

/// Scenes in which every shape, texture, and map meet, in both integrators: a fault of one of these
/// needs all of them, and few others that would hide it.
fn triples(features: &[Feature]) -> Vec<Vec<usize>> {
    let of = |is: fn(&Feature) -> bool| {
        let all = features.iter().enumerate();
        all.filter(|(_, feature)| is(feature))
            .map(|(k, _)| k)
            .collect::<Vec<_>>()
    };
    let modes = of(|feature| ["Mode.phong", "Mode.path"].contains(&feature.id.as_str()));
    let textures = of(|feature| feature.id.starts_with("Texture."));
    let texels = of(|feature| feature.id.starts_with("texels."));
    let maps = of(|feature| feature.id.ends_with("Map") || feature.id == "Phong.bump");
    let shapes = of(Feature::shows_shape);
    let mut scenes = Vec::new();
    for (mode, texture) in modes
        .iter()
        .flat_map(|mode| textures.iter().map(move |t| (mode, t)))
    {
        for (texels, shapes) in texels
            .iter()
            .flat_map(|texels| shapes.chunks(MOST[1]).map(move |shapes| (texels, shapes)))
        {
            for part in 0..3 {
                let maps = maps.iter().skip(part).step_by(3);
                let mut scene: Vec<_> = [mode, texture, texels]
                    .into_iter()
                    .chain(shapes)
                    .chain(maps)
                    .copied()
                    .collect();
                scene.sort_unstable();
                scenes.push(scene);
            }
        }
    }
    scenes
}

fn valid(scene: Scene) -> Result<ValidScene, String> {
    let (mut sink, options) = (DiagnosticSink::default(), Options::default());
    let lowered = LoweredScene {
        scene,
        source_spans: SourceSpans::default(),
    };
    let valid = pipeline::validate(&lowered, &options, &mut sink);
    valid.ok_or_else(|| format!("not valid: {:?}", sink.kept()))
}

/// The first law that a scene breaks.
fn broken(scene: Scene) -> Option<String> {
    let scene = match valid(scene) {
        Ok(scene) => scene,
        Err(faults) => return Some(faults),
    };
    let unpruned = film(&scene, RuleSet::NONE);
    if let Some(difference) = difference(&scene, &unpruned, RuleSet::ALL) {
        let plan = Plan::new(&scene, RuleSet::ALL);
        let verified = verify(&scene, &plan, &RenderSelection::default(), &|_| true);
        return Some(format!("{difference}: {:?}", verified.unwrap().map(drop)));
    }
    let mut told = contradictions(&scene, &film(&scene, RuleSet::ALL).counts);
    // Equal vertex normals are still looked up and counted.
    let is_told = |effect: Effect| effect != Effect::NormalInterpolation;
    told.retain(|(effect, state, _)| *state != EffectState::Needed && is_told(*effect));
    (!told.is_empty()).then(|| format!("simulated, but told otherwise: {told:?}"))
}

/// The fault of a scene and the few features that it takes.
fn fault(features: &[&Feature], seed: u64) -> Option<String> {
    broken(scene(features, seed))?;
    let mut few = features.to_vec();
    let mut at = 0;
    while at < few.len() {
        let mut fewer = few.clone();
        fewer.remove(at);
        if broken(scene(&fewer, seed)).is_some() {
            few = fewer;
        } else {
            at += 1;
        }
    }
    let ids: Vec<_> = few.iter().map(|feature| feature.id.as_str()).collect();
    Some(format!("{ids:?}: {}", broken(scene(&few, seed))?))
}

/// Tries every second scene of some, each with values of its own.
fn obey_the_laws(features: &[Feature], scenes: &[Vec<usize>], half: usize) {
    let mut faults = Vec::new();
    for (seed, scene) in scenes.iter().enumerate().skip(half).step_by(2) {
        let chosen: Vec<_> = scene.iter().map(|k| &features[*k]).collect();
        faults.extend(fault(&chosen, seed as u64));
    }
    assert!(
        faults.is_empty(),
        "{}:\n{}",
        faults.len(),
        faults.join("\n")
    );
}

fn every_two_features_obey_the_laws(half: usize) {
    let features = features().crossed;
    let rounds = env::var("RTC_SCENES").map_or(1, |count| count.parse().unwrap());
    for round in 0..rounds {
        obey_the_laws(&features, &covering(&features, round), half);
    }
}

#[test]
fn every_two_features_obey_the_laws_in_even_scenes() {
    every_two_features_obey_the_laws(0);
}

#[test]
fn every_two_features_obey_the_laws_in_odd_scenes() {
    every_two_features_obey_the_laws(1);
}

#[test]
fn every_shape_texture_and_map_obey_the_laws_in_even_scenes() {
    let features = features().crossed;
    obey_the_laws(&features, &triples(&features), 0);
}

#[test]
fn every_shape_texture_and_map_obey_the_laws_in_odd_scenes() {
    let features = features().crossed;
    obey_the_laws(&features, &triples(&features), 1);
}

#[test]
fn each_feature_of_the_schema_is_crossed_or_has_a_reason_not_to_be() {
    let schema = schema();
    let Features { crossed, never } = features();
    let mut known: BTreeSet<_> = crossed.into_iter().map(|feature| feature.id).collect();
    for id in never.into_keys() {
        assert!(known.insert(id.clone()), "{id} is crossed");
    }
    let mut all = ids(&schema);
    all.extend(BESIDE.map(str::to_owned));
    let [missing, unknown] = [all.difference(&known), known.difference(&all)]
        .map(|ids| ids.cloned().collect::<Vec<_>>());
    assert!(
        missing.is_empty() && unknown.is_empty(),
        "no row: {missing:?}, no feature: {unknown:?}"
    );
}

/// The table of what is crossed.
fn crossed() -> String {
    let Features { crossed, never } = features();
    let (scenes, pairs) = (covering(&crossed, 0).len(), OpenPairs::of(&crossed).count());
    let triples = triples(&crossed).len();
    let all = crossed.len() * (crossed.len() - 1) / 2;
    let mut text = format!(
        "{} features make {all} pairs, of which {} exclude each other.\n\
         Crossed pairs: {pairs}, in {scenes} scenes; open pairs: 0.\n\
         Scenes in which every shape, texture and map meet: {triples}.\n\n\
         Crossed, each with so many others:\n",
        crossed.len(),
        all - pairs,
    );
    let mut kinds = BTreeMap::<_, BTreeSet<_>>::new();
    for feature in &crossed {
        let others = crossed
            .iter()
            .filter(|other| other.id != feature.id && feature.excluded_by(other).is_none());
        let _ = writeln!(text, "{} {}", feature.id, others.count());
        for (kind, choice) in &feature.choices {
            kinds.entry(kind).or_default().insert(choice.as_str());
        }
    }
    text += "\nExclusive, as a scene has one of each kind:\n";
    for (kind, choices) in kinds {
        let choices: Vec<_> = choices.into_iter().collect();
        let _ = writeln!(text, "{kind}: {}", choices.join(", "));
    }
    text += "\nNever:\n";
    for (id, reason) in never {
        let _ = writeln!(text, "{id}: {reason}");
    }
    text
}

#[test]
#[expect(clippy::disallowed_methods, reason = "it keeps its table")]
fn what_is_crossed_is_written_down() {
    let path = root("tests/plan/features/crossed.txt");
    let crossed = crossed();
    if env::var_os("RTC_UPDATE").is_some() {
        fs::write(&path, &crossed).unwrap();
    }
    assert_eq!(
        fs::read_to_string(path).unwrap(),
        crossed,
        "run again with RTC_UPDATE=1"
    );
}
