//! Errors: what a study says of them, and of its reference, is what finer renders show.

use super::*;

#[test]
fn error_follows_the_laws_of_sampling() {
    let law = |study: &Study, knob| {
        study
            .knobs
            .iter()
            .find(|report| report.knob == knob)
            .and_then(|report| report.law)
    };
    let edges = law(&WHOLE, Knob::Supersampling).unwrap().p;
    assert!(
        0.6 < edges.value && edges.value < 0.95,
        "edges under a grid: {edges:?}"
    );
    let blurred = scene(&[(
        "{\"radius\": 0, \"samples\": 1}",
        "{\"radius\": 2, \"samples\": 1}",
    )]);
    let coarse = Setting::of(&blurred).with(Knob::Supersampling, 1);
    let at = |points| [picture(&blurred, coarse.with(Knob::Aperture, points))];
    let truth = at(1024);
    let lens = PowerLaw::fit(&[4, 16, 64].map(|n| (f64::from(n), study::rmse(&at(n), &truth))))
        .unwrap()
        .p
        .value;
    println!("edges {:.3}, lens {lens:.3}", edges.value);
    assert!((0.5..1.0).contains(&lens), "a spiral on the lens: {lens}");
}

#[test]
fn the_model_foresees_the_error_of_settings_together() {
    for study in [&*WHOLE, &*PART] {
        for row in study
            .rows
            .iter()
            .filter(|row| row.judged && row.setting.aperture != 2)
        {
            let off = row.model / row.errors.rmse - 1.0;
            assert!(off.abs() < 0.3, "{}", study::table(study));
        }
    }
}

#[test]
fn rows_that_the_reference_cannot_judge_say_so() {
    for study in [&*WHOLE, &*PART] {
        let floor = study.reference.floor;
        assert!(floor > 0.0);
        assert!(
            study
                .rows
                .iter()
                .all(|row| row.judged == (floor <= 0.2 * row.errors.rmse))
        );
    }
    let poor = study_of(&scene(&[]), 400_000, 0);
    assert!(
        poor.rows.iter().any(|row| !row.judged) && study::table(&poor).contains('≤'),
        "{}",
        study::table(&poor)
    );
}

/// The reference is right: it is where renders with ever more samples go.
#[test]
fn the_error_told_is_the_distance_to_a_finer_render() {
    let scene = scene(&[]);
    let own = Setting::of(&scene);
    let fine = own.with(Knob::Supersampling, 32).with(Knob::Depth, 8);
    let (coarse, fine) = (picture(&scene, own), picture(&scene, fine));
    let told = WHOLE.own().unwrap().errors.rmse;
    let error = study::rmse(&[coarse], &[fine]);
    assert!((told / error - 1.0).abs() < 0.02, "{told} for {error}");
}

pub(super) fn picture(scene: &Scene, setting: Setting) -> Image {
    let mut scene = scene.clone();
    setting.apply(&mut scene);
    film(&scene)
}

pub(super) fn film(scene: &Scene) -> Image {
    let lowered = rtc::internals::ir::Lowered {
        scene: scene.clone(),
        origins: rtc::internals::ir::Origins::default(),
    };
    let mut sink = Sink::default();
    let valid = pipeline::prove(&lowered, &Options::default(), &mut sink)
        .unwrap_or_else(|| panic!("{:?}", sink.kept()));
    render(
        &valid,
        &Plan::new(&valid, Rules::ALL),
        &Job::default(),
        &|_| true,
    )
    .unwrap()
    .image
}

/// A grid that is not centred would look so: more samples stop to help.
#[test]
fn a_planted_defect_shows_as_a_floor() {
    let scene = scene(&[]);
    let truth = [picture(
        &scene,
        Setting::of(&scene).with(Knob::Supersampling, 24),
    )];
    let mut shifted = scene.clone();
    shifted.camera.center[0] += 0.1 * shifted.camera.right[0];
    let errors = |scene: &Scene, factors: [u32; 3]| {
        factors.map(|factor| {
            let samples = f64::from(factor) * f64::from(factor);
            (
                samples,
                study::rmse(
                    &[picture(
                        scene,
                        Setting::of(scene).with(Knob::Supersampling, factor),
                    )],
                    &truth,
                ),
            )
        })
    };
    let law = |scene, factors| PowerLaw::fit(&errors(scene, factors)).unwrap().p.value;
    assert!(law(&scene, [1, 2, 4]) > 0.5, "the grid as it is");
    assert!(
        law(&shifted, [4, 6, 8]).abs() < 0.1,
        "a grid off its place by a tenth of a pixel"
    );
}

#[test]
fn what_is_left_out_of_the_depth_ends_where_paths_do() {
    let depth = WHOLE
        .knobs
        .iter()
        .find(|report| report.knob == Knob::Depth)
        .unwrap();
    let errors: Vec<_> = depth.levels.iter().map(|level| level.error).collect();
    assert!(
        errors.len() > 2 && errors.is_sorted_by(|a, b| a > b) && errors.last() == Some(&0.0),
        "{errors:?}"
    );
}

/// Two balls under a disc that shines and a sky, by paths.
#[test]
fn paths_have_a_ladder_and_a_law_of_their_own() {
    let (mut map, mut sink) = (SourceMap::default(), Sink::default());
    let file = map.add(
        "paths.json",
        include_bytes!("../honest/paths.json").to_vec(),
    );
    let scene = codec::decode(codec::Form::Text, file, &map, &mut sink)
        .unwrap_or_else(|| panic!("{:?}", sink.kept()));
    let study = study_of(&scene, 3_000_000, 0);
    let table = study::table(&study);
    assert_eq!(
        study.used(),
        [Knob::Paths, Knob::Depth, Knob::Precision],
        "{table}"
    );
    let law = study
        .knobs
        .iter()
        .find(|report| report.knob == Knob::Paths)
        .and_then(|report| report.law)
        .unwrap();
    assert!(
        (0.4..1.0).contains(&law.p.value),
        "noise falls as 1/√n or faster: {table}"
    );
    assert!(
        study.own().unwrap().setting.paths == 16
            && study.rows.iter().any(|row| row.setting.paths > 16),
        "{table}"
    );
    for row in study.rows.iter().filter(|row| row.judged) {
        assert!((row.model / row.errors.rmse - 1.0).abs() < 0.3, "{table}");
    }
    assert!(
        study::html(&study).contains(">spp<"),
        "the page has the column"
    );
}
