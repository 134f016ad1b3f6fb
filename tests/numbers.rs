//! Numbers that give way: directions of any length, shapes and scenes of extreme size, and what no
//! file can hold.

#![expect(clippy::unwrap_used, reason = "a test stops at the first surprise")]

use crate::small::bits;
use rtc::internals::diag::DiagnosticSink;
use rtc::internals::math::ldexp;
use rtc::internals::pipeline::{self, Options};
use rtc::internals::plan::{Plan, RuleSet};
use rtc::internals::render::{Film, RenderSelection, Values};
use rtc::internals::source::SourceMap;
use rtc::internals::valid::ValidScene;

/// Three numbers as a list, times 2^k.
fn list(v: [f64; 3], k: i32) -> String {
    let [x, y, z] = v.map(|component| ldexp(component, k));
    format!("[{x:e}, {y:e}, {z:e}]")
}

/// The scene of a text, and what is found in it.
fn read(text: &str) -> (Option<ValidScene>, DiagnosticSink) {
    let (mut map, mut sink, options) = (
        SourceMap::default(),
        DiagnosticSink::default(),
        Options::default(),
    );
    let file = map.add("text.yaml", text.as_bytes().to_vec());
    let lowered = pipeline::load(file, &mut map, &options, &mut sink).unwrap();
    (pipeline::validate(&lowered, &options, &mut sink), sink)
}

fn job() -> RenderSelection<'static> {
    RenderSelection {
        values: Values::Linear,
        ..RenderSelection::default()
    }
}

fn validated(text: &str) -> ValidScene {
    let (scene, sink) = read(text);
    scene.unwrap_or_else(|| panic!("{:?}\n{text}", sink.kept()))
}

fn film(scene: &ValidScene, rules: RuleSet) -> Film {
    pipeline::render(scene, &Plan::new(scene, rules), &job(), 2, &|_| true)
        .unwrap()
        .unwrap()
}

/// That the scene is drawn with and without the rules alike, and the bits of its picture.
fn lawful(text: &str) -> Vec<u64> {
    let scene = validated(text);
    let pruned = film(&scene, RuleSet::ALL);
    assert!(
        bits(&pruned) == bits(&film(&scene, RuleSet::NONE)),
        "a rule changes the picture of\n{text}"
    );
    let verified = pipeline::verify(&scene, &Plan::new(&scene, RuleSet::ALL), &job(), 2, &|_| {
        true
    });
    let verified = verified.unwrap().unwrap();
    assert!(verified.is_ok(), "{:?}", verified.err());
    bits(&pruned)
}

const STAGE: &str =
    "Camera: {eye: [0.5, 3, 7], center: [0, 1, 0], up: [0, 0.12, 0], viewSize: [32, 28]}\n";
const MATERIAL: &str = "material: {color: [0.8, 0.5, 0.3], ka: 0.2, kd: 0.6, ks: 0.3, n: 20}";
const CLOTHES: &str = "material: {texture: uv, ka: 0.2, kd: 0.6, ks: 0, n: 20}";

/// A scene with an object on a floor, a point light and shadows.
fn object(keys: &str) -> String {
    format!(
        "{STAGE}Shadows: true\nMaxRecursionDepth: 1\nLights: [{{position: [-4, 6, 5], color: [0.9, 0.8, 0.7]}}]\n\
         Objects:\n- {{{keys}}}\n- {{type: sphere, position: [0, -40, 0], radius: 40, {MATERIAL}}}\n"
    )
}

/// A scene with a direction in some key.
type Directed = fn(&str) -> String;

/// Every key that is a direction alone, each in a scene with a direction in that key.
const KEYS: [(&str, Directed); 12] = [
    ("cylinder", |v| {
        object(&format!(
            "type: cylinder, position: [0, 0.4, 0], direction: {v}, height: 1.4, radius: 0.6, {MATERIAL}"
        ))
    }),
    ("torus", |v| {
        object(&format!(
            "type: torus, position: [0, 1, 0], direction: {v}, radius: 0.9, alpha: 0.3, {MATERIAL}"
        ))
    }),
    ("plane", |v| {
        object(&format!(
            "type: plane, position: [0, 0.5, 0], normal: {v}, {MATERIAL}"
        ))
    }),
    ("plane at a distance", |v| {
        object(&format!(
            "type: plane, normal: {v}, distance: 0.5, {MATERIAL}"
        ))
    }),
    ("plane of an edge", |v| {
        object(&format!(
            "type: plane, position: [0, 0.5, 0], up: {v}, side: [1, 0.1, 0.2], {MATERIAL}"
        ))
    }),
    ("plane of another edge", |v| {
        object(&format!(
            "type: plane, position: [0, 0.5, 0], up: [1, 0.1, 0.2], side: {v}, {MATERIAL}"
        ))
    }),
    ("disc", |v| {
        object(&format!(
            "type: circle, center: [0, 1, 0], normal: {v}, radius: 1.1, {MATERIAL}"
        ))
    }),
    ("bounded plane", |v| {
        object(&format!(
            "type: bplane, typ: circle, center: [0, 1, 0], normal: {v}, radius: 1.1, {MATERIAL}"
        ))
    }),
    ("axis of a sphere", |v| {
        object(&format!(
            "type: sphere, position: [0, 1, 0], radius: 1, axis: {v}, angle: 40, {CLOTHES}"
        ))
    }),
    ("axis beside a radius", |v| {
        object(&format!(
            "type: sphere, position: [0, 1, 0], radius: [1, {v}], angle: 40, {CLOTHES}"
        ))
    }),
    ("sun", |v| {
        object(&format!(
            "type: torus, position: [0, 1, 0], radius: 0.9, alpha: 0.3, {MATERIAL}"
        ))
        .replace(
            "position: [-4, 6, 5], color: [0.9, 0.8, 0.7]",
            &format!("type: sun, direction: {v}, irradiance: 3"),
        )
    }),
    ("up beside fov", |v| {
        object(&format!(
            "type: torus, position: [0, 1, 0], radius: 0.9, alpha: 0.3, {MATERIAL}"
        ))
        .replace("up: [0, 0.12, 0]", &format!("up: {v}, fov: 40"))
    }),
];

/// Powers of two that leave directions of about 1 with normal components, those where squares leave
/// the range among them.
const POWERS: [i32; 14] = [
    -1010, -900, -600, -540, -530, -515, -340, -1, 1, 340, 511, 515, 600, 1015,
];

#[test]
fn a_direction_has_no_length() {
    for (name, text) in KEYS {
        for v in [[0.31, 1.7, -0.62], [-0.8, 1.07, 1e-3]] {
            let picture = lawful(&text(&list(v, 0)));
            for k in POWERS {
                assert!(lawful(&text(&list(v, k))) == picture, "{name}: {v:?}·2^{k}");
            }
        }
    }
}

/// A cylinder whose direction has a square that vanishes, lit from the eye.
#[test]
fn a_rule_for_convex_solids_holds_for_a_tiny_direction() {
    let text = |direction: &str| {
        format!(
            "{STAGE}Shadows: true\nLights: [{{position: [0.5, 3, 7], color: [1, 1, 1]}}]\nObjects:\n\
             - {{type: cylinder, position: [0, 1, 0], direction: {direction}, height: 2, radius: 1.5, {MATERIAL}}}\n"
        )
    };
    let tiny = lawful(&text("[-8e-163, -1.7e-162, 1e-161]"));
    assert!(tiny.iter().any(|value| *value != tiny[0]), "it shows");
    lawful(&text("[-8e+160, -1.7e+161, 1e+162]"));
}

/// A scene of one shape on a floor, all of it times 2^k, seen by the light of a point in the shade
/// of the shape.
fn scaled(shape: Shape, k: i32) -> String {
    let (vector, length) = (
        |v: [f64; 3]| list(v, k),
        |x: f64| format!("{:e}", ldexp(x, k)),
    );
    let [eye, center, up] = [[0.5, 3.0, 7.0], [0.0, 1.0, 0.0], [0.0, 0.12, 0.0]].map(vector);
    let (light, floor) = (vector([-4.0, 6.0, 5.0]), vector([0.0, -40.0, 0.0]));
    format!(
        "Camera: {{eye: {eye}, center: {center}, up: {up}, viewSize: [32, 28]}}\nShadows: true\nMaxRecursionDepth: 2\n\
         Lights: [{{position: {light}, color: [0.9, 0.8, 0.7]}}]\nObjects:\n- {{{}, {MATERIAL}}}\n\
         - {{type: sphere, position: {floor}, radius: {}, {MATERIAL}}}\n",
        shape(&vector, &length),
        length(40.0)
    )
}

/// What writes a shape, given what writes its vectors and its lengths.
type Shape = fn(&dyn Fn([f64; 3]) -> String, &dyn Fn(f64) -> String) -> String;

/// Shapes, each by its numbers times a power of two.
const SHAPES: [Shape; 8] = [
    |v, _| {
        let corners = [
            [-1.0, 0.1, 1.0],
            [1.2, 0.1, 0.6],
            [1.2, 2.0, 0.1],
            [-1.0, 1.4, -1.3],
        ]
        .map(v);
        format!(
            "type: quad, curved: true, v0: {}, v1: {}, v2: {}, v3: {}",
            corners[0], corners[1], corners[2], corners[3]
        )
    },
    |v, _| {
        format!(
            "type: quad, position: {}, up: {}, side: {}",
            v([-1.0, 0.1, 0.0]),
            v([0.3, 2.0, 0.1]),
            v([2.0, 0.1, 0.6])
        )
    },
    |v, l| {
        format!(
            "type: sphere, position: {}, radius: {}",
            v([0.0, 1.0, 0.0]),
            l(1.1)
        )
    },
    |v, l| {
        format!(
            "type: cone, position: {}, up: {}, radius: {}",
            v([0.0, 0.1, 0.0]),
            v([0.4, 2.0, 0.3]),
            l(1.0)
        )
    },
    |v, l| {
        format!(
            "type: cone, position: {}, up: {}, radius: {}",
            v([0.0, 1.0, 0.0]),
            v([4e-6, 2e-5, 3e-6]),
            l(1.0)
        )
    },
    |v, l| {
        format!(
            "type: torus, position: {}, radius: {}, alpha: {}, direction: [0.3, 1, 0.6]",
            v([0.0, 1.0, 0.0]),
            l(0.9),
            l(0.3)
        )
    },
    |v, l| {
        format!(
            "type: cylinder, p1: {}, p2: {}, radius: {}",
            v([-0.7, 0.4, 0.3]),
            v([0.8, 1.6, -0.4]),
            l(0.6)
        )
    },
    |v, _| {
        format!(
            "type: prism, v0: {}, v1: {}, v2: {}, up: {}",
            v([-1.0, 0.1, 0.8]),
            v([0.9, 0.1, 0.9]),
            v([0.1, 1.7, 0.7]),
            v([0.2, 0.1, -1.4])
        )
    },
];

#[test]
fn a_shape_times_a_power_of_two_makes_the_same_picture() {
    for shape in SHAPES {
        let picture = lawful(&scaled(shape, 0));
        for k in [-180, -90, -1, 90, 180] {
            let other = lawful(&scaled(shape, k));
            let differing = picture.iter().zip(&other).filter(|(a, b)| a != b).count();
            assert!(
                differing == 0,
                "{differing} values differ at 2^{k}:\n{}",
                scaled(shape, 0)
            );
        }
    }
}

/// A cone so flat that nothing is left of its height is the disc of its base, from above, from
/// below and edge on.
#[test]
fn a_flat_cone_is_no_wider_than_its_base() {
    let axis = [0.2, 1.0, 0.1];
    for eye in ["[0.5, 3, 7]", "[0.3, -2, 6]", "[-4, 1.3, 2]", "[0, 9, 0.5]"] {
        let seen = |keys: &str| {
            let text = format!(
                "Camera: {{eye: {eye}, center: [0, 1, 0], up: [0, 0.12, 0.01], viewSize: [64, 56]}}\nShadows: true\n\
                 Lights: [{{position: [-4, 6, 5], color: [0.9, 0.8, 0.7]}}]\nObjects:\n\
                 - {{{keys}, radius: 1.25, {MATERIAL}}}\n- {{type: sphere, position: [0, -40, 0], radius: 40, {MATERIAL}}}\n"
            );
            lawful(&text)
                .into_iter()
                .map(f64::from_bits)
                .collect::<Vec<_>>()
        };
        let disc = seen(&format!(
            "type: circle, center: [0.1, 1, 0.2], normal: {}",
            list(axis, 0)
        ));
        for height in [1e-12, 1e-14, 1e-17, 1e-20, 1e-40, 1e-58] {
            let up = list(axis.map(|component| component * height), 0);
            let cone = seen(&format!("type: cone, position: [0.1, 1, 0.2], up: {up}"));
            let differing = disc
                .iter()
                .zip(&cone)
                .filter(|(a, b)| (*a - *b).abs() > 1e-9)
                .count();
            assert!(
                differing <= 6,
                "{differing} values differ from {eye} at height {height:e}"
            );
        }
    }
}

/// Objects with a vector whose length means something.
const LONG: [&str; 4] = [
    "type: cone, position: [0, 0.1, 0], up: VECTOR, radius: 1",
    "type: prism, v0: [-1, 0.1, 0.8], v1: [0.9, 0.1, 0.9], v2: [0.1, 1.7, 0.7], up: VECTOR",
    "type: box, position: [0, 0.1, 0], up: VECTOR, side: [1, 0, 0.1], depth: [0.1, 0.2, 1]",
    "type: quad, position: [0, 0.1, 0], up: VECTOR, side: [1, 0, 0.1]",
];

/// Lengths far beyond those that a scene may have: a lawful picture of finite values, or a finding
/// that says so at its place.
#[test]
fn lengths_beyond_the_range_are_told() {
    let view = object(&format!(
        "type: sphere, position: [0, 1, 0], radius: 1, {MATERIAL}"
    ));
    let view = view.replace("up: [0, 0.12, 0]", "up: VECTOR");
    let texts = LONG
        .map(|keys| object(&format!("{keys}, {MATERIAL}")))
        .into_iter()
        .chain([view]);
    for text in texts {
        for k in [-900, -500, -200, -190, 190, 200, 500, 900] {
            let text = text.replace("VECTOR", &list([0.1, 0.4, 0.3], k));
            let (scene, sink) = read(&text);
            if scene.is_some() {
                assert!(
                    lawful(&text)
                        .into_iter()
                        .all(|bits| f64::from_bits(bits).is_finite()),
                    "{text}"
                );
                continue;
            }
            for finding in sink.kept() {
                assert!(
                    finding.message.contains("to compute with"),
                    "{text}\n{}",
                    finding.message
                );
                assert!(finding.primary.is_some(), "{text}\n{}", finding.message);
            }
        }
    }
}
