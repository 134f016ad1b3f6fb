//! What files of different years of the course mean: ambient light in JSON and YAML, glass, and
//! keys that need another one.

use crate::small::{WHOLE, film};
use rtc::internals::diag::DiagnosticSink;
use rtc::internals::ir::{Ambient, Scene};
use rtc::internals::pipeline::{self, Options};
use rtc::internals::source::SourceMap;

/// The scene of a text, and the codes of its findings.
fn loaded(text: &str) -> (Scene, Vec<&'static str>) {
    let mut map = SourceMap::default();
    let file = map.add("scene", text.as_bytes().to_vec());
    let mut sink = DiagnosticSink::default();
    let lowered = pipeline::load(file, &mut map, &Options::default(), &mut sink);
    let codes = sink.kept().iter().map(|finding| finding.code.id).collect();
    (lowered.unwrap().scene, codes)
}

/// The middle pixel of an image of 400 × 400, in bytes.
fn middle(scene: &Scene) -> [f64; 3] {
    let film = film(scene, &WHOLE, 1);
    film.image.pixels[200 * 400 + 200].map(|value| (value.min(1.0) * 255.0).floor())
}

const CLAY: &str = r#"{
    "Eye": [200, 200, 900],
    "Lights": [
        {"position": [-150, 500, 1200], "color": [0.9, 0.5, 0.6]},
        {"position": [550, 350, 1100], "color": [0.6, 0.7, 0.9]},
        {"position": [200, -300, 1000], "color": [0.5, 0.8, 0.5]}
    ],
    "Objects": [
        {"type": "sphere", "position": [200, 200, 50], "radius": 120,
         "material": {"color": [0.5, 0.4, 0.3], "ka": 0.4, "kd": 0.1, "ks": 0, "n": 1}}
    ]
}"#;

/// The same as YAML, whose keys stand without quotes.
fn as_yaml(json: &str) -> String {
    let value: serde_json::Value = serde_json::from_str(json).unwrap();
    serde_yaml::to_string(&value).unwrap()
}

#[test]
fn ambient_light_is_added_once_in_json_and_for_each_light_in_yaml() {
    let (scene, codes) = loaded(CLAY);
    assert_eq!(middle(&scene), [74.0, 59.0, 44.0]);
    assert!(codes.contains(&"SC013"), "{codes:?}");
    let (scene, codes) = loaded(&as_yaml(CLAY));
    assert_eq!(middle(&scene), [125.0, 99.0, 75.0]);
    assert!(!codes.contains(&"SC013"), "{codes:?}");
}

#[test]
fn the_key_says_how_often_ambient_light_is_added_whatever_the_form() {
    for (word, expected) in [
        ("once", [74.0, 59.0, 44.0]),
        ("perLight", [125.0, 99.0, 75.0]),
    ] {
        let json = CLAY.replacen('{', &format!("{{\"Ambient\": \"{word}\","), 1);
        for text in [as_yaml(&json), json] {
            let (scene, codes) = loaded(&text);
            assert_eq!(middle(&scene), expected, "{text}");
            assert!(!codes.contains(&"SC013"), "{codes:?}");
        }
    }
}

#[test]
fn of_one_white_light_both_readings_are_one() {
    let one = r#"{"Eye": [200, 200, 900], "Lights": [{"position": [-150, 500, 1200], "color": [1, 1, 1]}],
        "Objects": [{"type": "sphere", "position": [200, 200, 50], "radius": 120,
        "material": {"color": [0.5, 0.4, 0.3], "ka": 0.4, "kd": 0.1, "ks": 0, "n": 1}}]}"#;
    let (scene, codes) = loaded(one);
    let (other, _) = loaded(&as_yaml(one));
    assert_eq!(scene.settings.ambient, Ambient::Once);
    assert_eq!((middle(&scene), codes), (middle(&other), vec![]));
}

/// Ambient light that is added once needs no light.
#[test]
fn a_json_scene_without_light_shows_its_ambient_light() {
    let dark = r#"{"Eye": [200, 200, 900],
        "Objects": [{"type": "sphere", "position": [200, 200, 50], "radius": 120,
        "material": {"color": [0.5, 0.4, 0.3], "ka": 0.4, "kd": 0.1, "ks": 0, "n": 1}}]}"#;
    let (scene, codes) = loaded(dark);
    assert_eq!(middle(&scene), [51.0, 40.0, 30.0]);
    assert!(!codes.contains(&"VA022"), "{codes:?}");
}

/// A ball of glass as some files say it, before a wall or nothing.
fn ball(depth: &str, glass: &str) -> String {
    format!(
        r#"{{"Eye": [200, 200, 900], {depth} "Lights": [{{"position": [200, 200, 1200], "color": [1, 1, 1]}}],
        "Objects": [{{"type": "sphere", "position": [200, 200, 100], "radius": 90,
        "material": {{"color": [0.2, 0.6, 0.8], "ka": 0.25, "kd": 0.5, "ks": 0, "n": 3, {glass}}}}}]}}"#
    )
}

#[test]
fn glass_through_which_nothing_is_followed_shows_its_own_colour_and_is_told() {
    let words = [
        r#""isTransparent": true, "nt": 1.2"#,
        r#""type": "refraction", "nt": 1.2"#,
        r#""refract": 0.8, "eta": 1.2"#,
    ];
    for glass in words {
        for depth in ["", "\"MaxRecursionDepth\": 0,"] {
            let (scene, codes) = loaded(&ball(depth, glass));
            assert_eq!(middle(&scene), [38.0, 114.0, 152.0], "{glass} {depth}");
            assert!(codes.contains(&"SC011"), "{glass} {depth}: {codes:?}");
        }
        let (_, codes) = loaded(&ball(
            "\"MaxRecursionDepth\": 3,",
            r#""isTransparent": true, "nt": 1.2"#,
        ));
        assert!(!codes.contains(&"SC011"), "{codes:?}");
    }
}

#[test]
fn what_is_transparent_keeps_its_own_ambient_and_diffuse_light() {
    let deep = "\"MaxRecursionDepth\": 3,";
    let (scene, _) = loaded(&ball(deep, r#""isTransparent": true, "nt": 1.2"#));
    let [red, green, blue] = middle(&scene);
    assert!(
        red >= 38.0 && green >= 114.0 && blue >= 152.0,
        "{red} {green} {blue}"
    );
    // The word of the course's framework is for glass without a colour.
    let (scene, codes) = loaded(&ball(deep, r#""type": "refraction", "nt": 1.2"#));
    assert_eq!(middle(&scene), [0.0; 3]);
    assert!(codes.contains(&"SC011"), "{codes:?}");
}

#[test]
fn keys_are_silent_if_the_settings_that_they_need_are_there() {
    const SCENE: &str = "Camera: {eye: [0, 0, 10], center: [0, 0, 0], up: [0, 1, 0], \
        viewSize: [8, 8], fov: 40, apertureRadius: 0.5, apertureSamples: 4}\n\
        Shadows: true\nMaxRecursionDepth: 2\nLightSamples: 9\nLights:\n\
        - {position: [0, 9, 9], color: [1, 1, 1], radius: 1}\nObjects:\n\
        - {type: sphere, position: [0, 0, 0], radius: 1, shadow: false, material: \
        {color: [1, 0, 0], ka: 0.2, kd: 0.8, ks: 0.5, n: 8, glossySamples: 9, specularMap: UV}}\n";
    assert!(!loaded(SCENE).1.contains(&"SC011"));
    for (needed, other) in [
        ("Shadows: true", "Shadows: false"),
        ("Depth: 2", "Depth: 0"),
        (", radius: 1}", "}"),
        ("apertureRadius: 0.5", "apertureRadius: 0"),
        ("apertureSamples: 4", "apertureSamples: 1"),
        ("ks: 0.5", "ks: 0"),
    ] {
        let codes = loaded(&SCENE.replace(needed, other)).1;
        assert!(codes.contains(&"SC011"), "{other}: {codes:?}");
    }
}
