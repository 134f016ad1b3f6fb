//! Faults that only a hand-made IR can have: each is refused with its code and the pointer of the
//! culprit.

#![expect(clippy::unwrap_used, reason = "a test stops at the first surprise")]

use rtc::internals::diag::DiagnosticSink;
use rtc::internals::pipeline::{self, Options};
use rtc::internals::source::SourceMap;
use serde_json::{Value, json};

/// A sound scene with one of everything that faults are made in.
fn sound() -> Value {
    json!({
        "irVersion": rtc::internals::ir::VERSION,
        "camera": {"eye": [0.0, 0.0, 9.0], "center": [0.0, 0.0, 0.0], "right": [1.0, 0.0, 0.0], "up": [0.0, 1.0, 0.0],
                   "size": [4, 4], "lens": {"radius": 0.0, "samples": 1}},
        "settings": {"mode": "phong", "shadows": false, "maxDepth": 0, "supersampling": 1},
        "lights": [{"punctual": {"emitter": {"sun": {"direction": [0.0, 1.0, 0.0]}}, "intensity": [1.0, 1.0, 1.0]}}],
        "environment": {"radiance": [1.0, 1.0, 1.0]},
        "images": [{"width": 1, "height": 1, "pixels": "AAAA"}],
        "textures": [{"image": 0}],
        "meshes": [{"positions": [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
                    "uvs": [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]], "triangles": [[0, 1, 2]]}],
        "materials": [{"phong": {"color": [1.0, 1.0, 1.0], "ka": 0.2, "kd": 0.7, "ks": 0.0, "n": 1.0, "kt": 0.0,
                                 "eta": 1.0, "glossySamples": 1, "colorMap": 0}},
                      {"standard": {"metallic": 0.5, "baseColorMap": {"texture": 0}}}],
        "surfaces": [
            {"shape": {"sphere": {"center": [0.0, 0.0, 0.0], "radius": 1.0,
                                  "textureFromWorld": [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]}}, "material": 0},
            {"shape": {"instance": {"mesh": 0, "worldFromObject":
                [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 0.0]]}}, "material": 0},
        ],
    })
}

/// The codes and pointers of the errors.
fn errors(document: &Value) -> Vec<(&'static str, String)> {
    let (mut map, mut sink, options) = (
        SourceMap::default(),
        DiagnosticSink::default(),
        Options::default(),
    );
    let file = map.add("scene.json", document.to_string().into_bytes());
    let lowered = pipeline::load(file, &mut map, &options, &mut sink)
        .unwrap_or_else(|| panic!("{:?}", sink.kept()));
    let proof = pipeline::validate(&lowered, &options, &mut sink);
    assert_eq!(proof.is_none(), sink.has_errors());
    sink.kept()
        .iter()
        .map(|finding| (finding.code.id, finding.pointer.clone().unwrap()))
        .collect()
}

#[test]
fn a_sound_scene_is_proven() {
    assert_eq!(errors(&sound()), []);
}

/// The place in the sound scene, what is put there, and the code and pointer of the error.
type Fault = (&'static str, Value, &'static str, &'static str);

#[expect(clippy::too_many_lines, reason = "a table, one row a fault")]
fn faults() -> Vec<Fault> {
    vec![
        ("/camera/up", json!([0.5, 1.0, 0.0]), "VA012", "/camera/up"),
        (
            "/camera/right",
            json!([0.0, 0.0, 0.0]),
            "VA012",
            "/camera/right",
        ),
        (
            "/camera/eye",
            json!([3.0, 4.0, 0.0]),
            "VA013",
            "/camera/eye",
        ),
        (
            "/materials/1/standard/metallic",
            json!(1.5),
            "VA020",
            "/materials/1/standard/metallic",
        ),
        (
            "/materials/1/standard/ior",
            json!(0.5),
            "VA020",
            "/materials/1/standard/ior",
        ),
        (
            "/materials/1/standard/baseColorMap/set",
            json!(2),
            "VA020",
            "/materials/1/standard/baseColorMap",
        ),
        (
            "/materials/1/standard/baseColorMap/texture",
            json!(1),
            "VA014",
            "/materials/1/standard/baseColorMap",
        ),
        (
            "/environment/radiance",
            json!([0.0, -1.0, 0.0]),
            "VA005",
            "/environment/radiance",
        ),
        (
            "/lights/0/punctual/emitter/sun/direction",
            json!([0.0, 0.0, 0.0]),
            "VA003",
            "/lights/0",
        ),
        (
            "/lights/0/punctual/emitter",
            json!({"spot": {"position": [0.0, 0.0, 0.0], "direction": [0.0, 1.0, 0.0], "innerAngle": 1.0, "outerAngle": 0.5}}),
            "VA021",
            "/lights/0",
        ),
        (
            "/lights/0/punctual/emitter",
            json!({"point": {"position": [0.0, 0.0, 0.0], "range": 0.0}}),
            "VA021",
            "/lights/0",
        ),
        (
            "/surfaces/0/material",
            json!(2),
            "VA014",
            "/surfaces/0/material",
        ),
        (
            "/surfaces/1/shape/instance/mesh",
            json!(7),
            "VA014",
            "/surfaces/1/shape/instance/mesh",
        ),
        ("/textures/0/image", json!(1), "VA014", "/textures/0"),
        (
            "/materials/0/phong/colorMap",
            json!(2),
            "VA014",
            "/materials/0/phong/colorMap",
        ),
        ("/images/0/pixels", json!("AAAAAAAA"), "VA017", "/images/0"),
        ("/images/0/width", json!(u32::MAX), "VA017", "/images/0"),
        (
            "/meshes/0/triangles/0",
            json!([0, 1, 3]),
            "VA018",
            "/meshes/0",
        ),
        (
            "/meshes/0/positions/1",
            json!([1e61, 0.0, 0.0]),
            "VA018",
            "/meshes/0",
        ),
        ("/meshes/0/uvs", json!([[0.0, 0.0]]), "VA018", "/meshes/0"),
        (
            "/meshes/0/normals",
            json!([[0.0, 0.0, 1.0]]),
            "VA018",
            "/meshes/0",
        ),
        (
            "/materials/1/standard/blendWith",
            json!(1),
            "VA014",
            "/materials/1/standard/blendWith",
        ),
        (
            "/surfaces/0/shape/sphere/textureFromWorld/0",
            json!([0.0, 2.0, 0.0]),
            "VA019",
            "/surfaces/0",
        ),
        (
            "/surfaces/1/shape/instance/worldFromObject/2",
            json!([1.0, 1.0, 0.0]),
            "VA019",
            "/surfaces/1/shape/instance/worldFromObject",
        ),
    ]
}

#[test]
fn each_fault_is_named_at_its_place() {
    for (place, value, code, pointer) in faults() {
        let mut document = sound();
        let (parent, key) = place.rsplit_once('/').unwrap();
        let parent = document.pointer_mut(parent).unwrap();
        if let Value::Array(items) = parent {
            items[key.parse::<usize>().unwrap()] = value;
        } else {
            parent[key] = value;
        }
        assert_eq!(errors(&document), [(code, pointer.to_owned())], "{place}");
    }
}

#[test]
fn a_blend_of_more_than_16_materials_is_refused() {
    let mut document = sound();
    for other in 1..17 {
        let blend = json!({"standard": {"blendWith": other, "blendWeight": 0.5}});
        document["materials"].as_array_mut().unwrap().push(blend);
    }
    let last = document["materials"].as_array_mut().unwrap();
    let too_long = last.pop().unwrap();
    assert_eq!(errors(&document), []);
    document["materials"].as_array_mut().unwrap().push(too_long);
    let [(_, pointer)] = &errors(&document)[..] else {
        panic!("{:?}", errors(&document));
    };
    assert_eq!(pointer, "/materials/17");
}
