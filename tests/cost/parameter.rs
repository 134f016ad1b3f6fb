//! The parameters of a scene, and the cost of its effects and arithmetics.

use super::error::{film, picture};
use super::*;

#[test]
fn knobs_that_change_nothing_say_why() {
    let reason =
        |changes: &[(&str, &str)], parameter| study::not_applicable(parameter, &scene(changes));
    assert_eq!(
        reason(&[], Parameter::Aperture).unwrap(),
        "the lens has no radius"
    );
    assert_eq!(
        reason(&[], Parameter::Lights).unwrap(),
        "no light has a radius"
    );
    assert_eq!(
        reason(&[], Parameter::Glossy).unwrap(),
        "no material is glossy"
    );
    assert_eq!(reason(&[], Parameter::Depth), None);
    assert!(reason(&[("\"ks\": 0.5", "\"ks\": 0")], Parameter::Depth).is_some());
    assert!(reason(&[("\"phong\",", "\"zbuffer\",")], Parameter::Supersampling).is_some());
    assert!(reason(&[("\"phong\",", "\"normal\",")], Parameter::Depth).is_some());
    let soft_and_black = [("[1, 1, 1]}}]", "[0, 0, 0], \"radius\": 3}}]")];
    assert_eq!(
        reason(&soft_and_black, Parameter::Lights).unwrap(),
        "soft light: its colour is 0 (E-LIGHT-BLACK)"
    );
    let table = study::table(&WHOLE);
    assert!(
        table.contains("aperture samples: not used by this scene: the lens has no radius"),
        "{table}"
    );
}

/// If a parameter does not apply, the picture is the same for all its values.
#[test]
fn idle_knobs_change_no_bit() {
    let mut one_ball = scene(&[]);
    one_ball.surfaces.truncate(1);
    assert!(
        study::not_applicable(Parameter::Depth, &one_ball)
            .is_some_and(|reason| reason.contains("E-REFL-CONVEX"))
    );
    let changed = [
        scene(&[("\"ks\": 0.5", "\"ks\": 0")]),
        scene(&[("\"phong\",", "\"normal\",")]),
    ];
    let scenes = [scene(&[]), one_ball].into_iter().chain(changed);
    for scene in scenes {
        let picture_with = |overrides: Overrides| {
            let mut scene = scene.clone();
            overrides.apply(&mut scene);
            film(&scene)
        };
        let plain = film(&scene);
        for parameter in Parameter::ALL
            .into_iter()
            .filter(|parameter| study::not_applicable(*parameter, &scene).is_some())
        {
            let other = Setting::of(&scene).with(parameter, 7);
            assert!(picture(&scene, other) == plain, "{parameter:?}");
        }
        assert!(
            picture_with(Overrides {
                supersampling: Some(3),
                ..Overrides::default()
            }) != plain
        );
    }
}

#[test]
fn effects_are_what_the_scene_has() {
    let of = |study: &'static Study, kind| {
        let costs = study.effects.iter().filter(move |cost| cost.kind == kind);
        costs.collect::<Vec<_>>()
    };
    let effects = of(&WHOLE, Ablation::Effect);
    let names: Vec<_> = effects.iter().map(|cost| cost.effect.as_str()).collect();
    assert_eq!(
        names,
        [
            "shadows",
            "mirrors and refraction",
            "highlights and mirrors"
        ]
    );
    for cost in &effects {
        assert!(cost.ray_ratio < 1.0 && cost.difference > 1.0, "{cost:?}");
        assert!(cost.noise_ratio < 1.05, "{cost:?}");
    }
    assert!(
        effects[0].rays.shadow == 0 && effects[1].rays.mirror == 0,
        "{effects:?}"
    );
    let camera = |cost: &&EffectCost| cost.rays.camera;
    let parts = of(&PART, Ablation::Effect);
    let blurred = parts.iter().find(|cost| cost.effect == "shadows").unwrap();
    let sharp = parts
        .iter()
        .find(|cost| cost.effect == "depth of field")
        .unwrap();
    assert_eq!(camera(sharp) * 4, camera(blurred));
}

/// Lights, objects and materials are removed one at a time, the largest first.
#[test]
fn parts_of_the_scene_have_their_costs() {
    let named = |kind| {
        let costs = WHOLE.effects.iter().filter(move |cost| cost.kind == kind);
        costs
            .map(|cost| (cost.effect.as_str(), cost))
            .collect::<Vec<_>>()
    };
    let names = |costs: &[(&'static str, _)]| costs.iter().map(|cost| cost.0).collect::<Vec<_>>();
    let (lights, objects) = (named(Ablation::Light), named(Ablation::Object));
    assert_eq!(names(&lights), ["light 1"]);
    assert_eq!(lights[0].1.rays.shadow, 0, "no light, no shadow rays");
    assert_eq!(names(&objects), ["plane 3", "sphere 2", "sphere 1"]);
    assert!(
        objects.iter().all(|(_, cost)| cost.difference > 1.0),
        "{objects:?}"
    );
    // The floor is not reflective; both spheres have the reflective material.
    let materials = named(Ablation::Material);
    assert_eq!(names(&materials), ["material 1, matt instead"]);
    assert!(materials[0].1.rays.mirror == 0 && materials[0].1.difference > 1.0);
}

/// Consecutive surfaces with the same name are one object; surfaces after the last name are
/// unnamed.
#[test]
fn objects_go_by_their_names() {
    let mut scene = scene(&[]);
    scene.names = vec!["pair".to_owned(); 2];
    let study = study_of(&scene, 8_000_000, 0);
    let objects = study
        .effects
        .iter()
        .filter(|cost| cost.kind == Ablation::Object);
    let names: Vec<_> = objects.map(|cost| cost.effect.as_str()).collect();
    assert_eq!(names, ["plane 3", "`pair`"]);
}

#[test]
fn precision_is_told_against_the_robust_arithmetic() {
    let names: Vec<_> = WHOLE
        .precision
        .iter()
        .map(|cost| cost.arithmetic.name())
        .collect();
    assert_eq!(names, ["robust", "plain", "f32"]);
    let off: Vec<_> = WHOLE
        .precision
        .iter()
        .map(|cost| cost.difference.rmse)
        .collect();
    assert!(off[0] == 0.0 && off[1] < 1e-6 && off[2] > 1e-6, "{off:?}");
    assert_eq!(WHOLE.precision[0].ratio.value, 1.0);
}

/// Each arithmetic traces the same paths to the same lights, emissive triangles among them:
/// pictures differ by the arithmetic, not by noise.
#[test]
fn precision_is_told_without_noise() {
    let disc = "{\"disc\": {\"center\": [1, 5, 1], \"normal\": [0, -1, 0], \"radius\": 2}}";
    let triangle = "{\"triangle\": {\"vertices\": [[-1, 5, 3], [1, 5, -2], [3, 5, 3]]}}";
    let text = include_str!("../honest/paths.json");
    assert!(text.contains(disc));
    let scene = decoded(text.replace(disc, triangle));
    let study = study_of(&scene, 300_000, 0);
    let plain = study.precision[1].difference;
    println!("plain differs by {plain:?}");
    assert!(
        study.scene_row().unwrap().errors.rmse > 1.0 && plain.rmse < 0.05,
        "{}",
        study::table(&study)
    );
}

/// A row uses a non-robust arithmetic only where no visible loss is expected, and the error stays
/// the same. A quick study has one, in the setting of the scene.
#[test]
fn precision_is_turned_where_that_adds_no_error() {
    let dull = [
        ("\"shadows\": true", "\"shadows\": false"),
        ("\"ks\": 0.5", "\"ks\": 0"),
    ];
    let dull = study_of(&scene(&dull), 1_000_000, 0);
    for (study, least) in [
        (&*WHOLE, Arithmetic::Plain),
        (&*PART, Arithmetic::Plain),
        (&dull, Arithmetic::F32),
    ] {
        let table = study::table(study);
        let is_borne =
            |arithmetic: Arithmetic| arithmetic != Arithmetic::F32 || least == Arithmetic::F32;
        assert!(
            study
                .precision
                .iter()
                .all(|cost| cost.is_tolerated == is_borne(cost.arithmetic)),
            "{table}"
        );
        let by = |arithmetic| {
            study
                .rows
                .iter()
                .filter(move |row| row.setting.precision == arithmetic)
        };
        let rows = if study.effort > Effort::QUICK { 3 } else { 1 };
        assert!(
            by(least).count() >= rows
                && by(Arithmetic::F32).all(|row| is_borne(row.setting.precision)),
            "{table}"
        );
        for row in by(Arithmetic::Plain).chain(by(Arithmetic::F32)) {
            let robust = Setting {
                precision: Arithmetic::Robust,
                ..row.setting
            };
            let beside = by(Arithmetic::Robust)
                .find(|row| row.setting == robust)
                .unwrap();
            assert!(
                (row.errors.rmse / beside.errors.rmse - 1.0).abs() < 0.02,
                "{table}"
            );
        }
    }
}

#[test]
fn a_scene_without_knobs_has_one_row_without_error() {
    let study = study_of(&scene(&[("\"phong\",", "\"zbuffer\",")]), 1_000_000, 0);
    assert_eq!(study.rows.len(), 1, "{}", study::table(&study));
    assert!(
        study.rows[0].front && study.rows[0].is_scene_setting && study.rows[0].errors.rmse == 0.0
    );
    assert!(study::html(&study).contains("</html>"));
}

/// Rows with and without estimated caustics; the reference has them.
#[test]
fn estimated_caustics_are_a_row_beside_those_by_chance() {
    let text = include_str!("../../docs/book/src/reference/examples/scene/caustics.yaml");
    let read = |text: String| {
        let (mut map, mut sink) = (SourceMap::default(), DiagnosticSink::default());
        let file = map.add("caustics.yaml", text.into_bytes());
        let loaded = pipeline::load(file, &mut map, &Options::default(), &mut sink);
        loaded.unwrap().scene
    };
    let wide = read(text.replace("radius: 0.02", "radius: 2"));
    let reason = study::not_applicable(Parameter::Caustics, &wide).unwrap();
    assert!(reason.contains("small light"), "{reason}");
    let mut scene = read(text.replace("[160, 120]", "[12, 9]"));
    let Mode::Path(paths) = &mut scene.settings.mode else {
        panic!("paths are traced");
    };
    paths.caustics = false;
    let study = study_of(&scene, 600_000, 0);
    let table = study::table(&study);
    assert!(study.reference.setting.caustics, "{table}");
    let error = |caustics: bool, factor: u32| {
        let own = study.scene_row().unwrap().setting;
        let wanted = |row: &&study::StudyRow| {
            row.setting.caustics == caustics
                && row.setting.paths == factor * own.paths
                && row.setting.depth == own.depth
                && !row.setting.denoise
        };
        study.rows.iter().find(wanted).unwrap().errors.rmse
    };
    assert!(error(true, 1) < 0.7 * error(false, 1), "{table}");
    assert!(error(true, 1) < error(false, 4), "{table}");
    let command = study.command.unwrap();
    assert!(command.contains("--set caustics=true"), "{command}");
}
