//! The schema of the IR text is current, and it agrees with the decoder on frozen files, scenes and
//! mutants.
//!
//! The decoder takes any number of the right type; the ranges the schema names are the proof's
//! business. Only the decoder knows: keys written twice, numbers no float holds, and `1.0` where an
//! integer stands. And it alone takes two spellings it never writes: a list of its fields for a
//! map, and a map to null for a bare word.

#![expect(
    clippy::unwrap_used,
    clippy::disallowed_methods,
    reason = "a test stops at the first surprise and reads what it checks"
)]
use rtc::internals::codec::{self, Encoding};
use rtc::internals::diag::DiagnosticSink;
use rtc::internals::ir::VERSION;
use rtc::internals::source::SourceMap;
use serde_json::{Value, json};
use std::path::Path;

const MUTANTS: u64 = 5_000;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// A frozen file, in the words of the current version.
fn frozen() -> Value {
    let frozen = std::fs::read(root().join("tests/codec/v1/scene.json")).unwrap();
    let mut document: Value = serde_json::from_slice(&frozen).unwrap();
    document["irVersion"] = VERSION.into();
    document
}

/// The document as the decoder understands it.
fn decoded(document: &Value) -> Option<Value> {
    let (mut map, mut sink) = (SourceMap::default(), DiagnosticSink::default());
    let file = map.add("mutant", document.to_string().into_bytes());
    let scene = codec::decode(Encoding::Json, file, &map, &mut sink)?;
    serde_json::from_slice(&codec::encode(Encoding::Json, &scene).unwrap()).unwrap()
}

/// True if both trees have the same maps, lists and leaves, whatever the leaves are.
fn same_form(a: &Value, b: &Value) -> bool {
    match (a, b) {
        (Value::Array(a), Value::Array(b)) => {
            a.len() == b.len() && a.iter().zip(b).all(|(a, b)| same_form(a, b))
        }
        (Value::Object(a), Value::Object(b)) => {
            a.len() == b.len()
                && a.iter()
                    .all(|(key, a)| b.get(key).is_some_and(|b| same_form(a, b)))
        }
        (a, b) => std::mem::discriminant(a) == std::mem::discriminant(b),
    }
}

#[test]
fn the_file_in_the_schema_folder_is_current() {
    let path = root().join("schema/ir.schema.json");
    let schema = format!("{:#}\n", codec::schema());
    if std::env::var_os("RTC_UPDATE").is_some() {
        std::fs::write(&path, &schema).unwrap();
    }
    let file = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(
        file == schema,
        "schema/ir.schema.json is out of date; RTC_UPDATE=1 cargo test --test suites ir_schema writes it"
    );
}

/// A small generator (splitmix64): the same mutants every time.
struct Dice(u64);

impl Dice {
    fn roll(&mut self, sides: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        usize::try_from((z ^ (z >> 31)) % sides as u64).unwrap()
    }
}

/// Changes one place of the tree, each level with the same chance to be it.
fn mutate(tree: &mut Value, dice: &mut Dice) {
    let stop = dice.roll(4) == 0;
    match tree {
        Value::Object(members) if !members.is_empty() && !stop => {
            let at = dice.roll(members.len());
            mutate(members.values_mut().nth(at).unwrap(), dice);
        }
        Value::Array(items) if !items.is_empty() && !stop => {
            let at = dice.roll(items.len());
            mutate(&mut items[at], dice);
        }
        Value::Object(members) if dice.roll(2) == 0 && !members.is_empty() => {
            let key = members
                .keys()
                .nth(dice.roll(members.len()))
                .unwrap()
                .clone();
            let member = members.shift_remove(&key).unwrap();
            if dice.roll(2) == 0 {
                members.insert(
                    ["radius", "sphere", "phong", "zoom"][dice.roll(4)].to_owned(),
                    member,
                );
            }
        }
        Value::Array(items) if dice.roll(2) == 0 => match items.pop() {
            Some(item) if dice.roll(2) == 0 => items.extend([item.clone(), item]),
            _ => {}
        },
        Value::Null
        | Value::Bool(_)
        | Value::Number(_)
        | Value::String(_)
        | Value::Array(_)
        | Value::Object(_) => *tree = replacement(dice),
    }
}

fn replacement(dice: &mut Dice) -> Value {
    let values = [
        json!(null),
        json!(true),
        json!("phong"),
        json!("zbuffer"),
        json!("Phong"),
        json!({}),
        json!([]),
        json!([1, 2, 3]),
        json!([1.5, 2, -3e300]),
        json!([4, 4]),
        json!({"sphere": {"center": [0, 0, 0], "radius": 1}}),
        json!({"gooch": {"b": 0.5, "y": 0.5, "alpha": 0.5, "beta": 0.5}}),
        json!({"phong": null}),
        json!(7),
        json!(0),
        json!(-7),
        json!(0.5),
        json!(4_294_967_295_u32),
        json!(4_294_967_296_u64),
        json!(u64::MAX),
        json!(1e308),
    ];
    values[dice.roll(values.len())].clone()
}

/// Removes the ranges only the proof knows; those of the integer types stay.
fn without_ranges(schema: &mut Value) {
    match schema {
        Value::Array(items) => items.iter_mut().for_each(without_ranges),
        Value::Object(members) => {
            members.shift_remove("exclusiveMinimum");
            if members.get("type") == Some(&json!("integer")) {
                members.insert("minimum".to_owned(), json!(0));
            } else if members.get("type") == Some(&json!("number")) {
                members.shift_remove("minimum");
            }
            members.values_mut().for_each(without_ranges);
        }
        Value::Null | Value::Bool(_) | Value::Number(_) | Value::String(_) => {}
    }
}

#[test]
fn schema_and_decoder_agree_on_mutants() {
    let mut schema = codec::schema();
    assert!(jsonschema::is_valid(&schema, &frozen()));
    without_ranges(&mut schema);
    let schema = jsonschema::validator_for(&schema).unwrap();
    let (mut dice, mut accepted) = (Dice(1), 0);
    for _ in 0..MUTANTS {
        let mut mutant = frozen();
        for _ in 0..=dice.roll(2) {
            mutate(&mut mutant, &mut dice);
        }
        // Older versions are read too; the schema is that of the current one.
        if mutant["irVersion"]
            .as_u64()
            .is_some_and(|version| version < VERSION.into())
        {
            continue;
        }
        let decoded = decoded(&mutant).filter(|decoded| same_form(decoded, &mutant));
        accepted += u64::from(decoded.is_some());
        assert_eq!(
            schema.is_valid(&mutant),
            decoded.is_some(),
            "schema against decoder: {mutant}"
        );
    }
    assert!(
        accepted > MUTANTS / 20 && accepted < MUTANTS * 19 / 20,
        "{accepted} accepted: the mutants test nothing"
    );
}

/// The ranges the schema names, one value each just outside.
#[test]
fn the_schema_names_the_ranges() {
    let schema = jsonschema::validator_for(&codec::schema()).unwrap();
    let outside = [
        ("/irVersion", json!(VERSION + 1)),
        ("/camera/size/0", json!(0)),
        ("/camera/lens/radius", json!(-0.1)),
        ("/camera/lens/samples", json!(0)),
        ("/settings/supersampling", json!(0)),
        ("/lights/0/point/color/2", json!(-1)),
        ("/materials/0/phong/n", json!(-1)),
        ("/materials/0/phong/eta", json!(0)),
        ("/materials/0/phong/glossySamples", json!(0)),
        ("/surfaces/0/shape/sphere/radius", json!(0)),
        ("/settings/maxDepth", json!(4_294_967_296_u64)),
    ];
    for (pointer, value) in outside {
        let mut document = frozen();
        *document.pointer_mut(pointer).unwrap() = value;
        assert!(!schema.is_valid(&document), "{pointer}");
    }
}
