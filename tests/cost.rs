//! What a study says of accuracy and time, with a clock that ticks once a ray: no machine is too
//! busy for these.

#![expect(clippy::unwrap_used, reason = "a test stops at the first surprise")]

use rtc::codec;
use rtc::diag::Sink;
use rtc::image::Image;
use rtc::ir::Scene;
use rtc::passes::Overrides;
use rtc::pipeline::{self, Options};
use rtc::plan::{Arithmetic, Plan, Rules};
use rtc::render::{Job, Step, render};
use rtc::source::SourceMap;
use rtc::study::{self, About, Bench, Clock, Effort, Knob, PowerLaw, Row, Setting, Stopped, Study};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{LazyLock, Mutex};
use std::time::Duration;

/// A mirror ball and a dull one above a floor, with shadows.
const BALLS: &str = r#"{
  "irVersion": 1,
  "camera": {"eye": [0, 10, 60], "center": [0, 2, 0], "right": [0.8, 0, 0], "up": [0, 0.8, 0], "size": [48, 32],
    "lens": {"radius": 0, "samples": 1}},
  "settings": {"mode": "phong", "shadows": true, "maxDepth": 1, "supersampling": 2},
  "lights": [{"point": {"position": [30, 50, 40], "color": [1, 1, 1]}}],
  "materials": [
    {"phong": {"color": [1, 0.2, 0.1], "ka": 0.2, "kd": 0.5, "ks": 0.5, "n": 16, "kt": 0, "eta": 1, "glossySamples": 1}},
    {"phong": {"color": [0.5, 0.6, 0.7], "ka": 0.3, "kd": 0.6, "ks": 0, "n": 1, "kt": 0, "eta": 1, "glossySamples": 1}}],
  "surfaces": [
    {"shape": {"sphere": {"center": [-7, 0, 0], "radius": 6}}, "material": 0},
    {"shape": {"sphere": {"center": [7, 0, 3], "radius": 6}}, "material": 0},
    {"shape": {"plane": {"center": [0, -6, 0], "normal": [0, 1, 0]}}, "material": 1}]
}"#;

fn scene(changes: &[(&str, &str)]) -> Scene {
    let mut text = BALLS.to_owned();
    for (old, new) in changes {
        assert!(text.contains(old), "{old}");
        text = text.replace(old, new);
    }
    let (mut map, mut sink) = (SourceMap::default(), Sink::default());
    let file = map.add("balls", text.into_bytes());
    codec::decode(codec::Form::Text, file, &map, &mut sink)
        .unwrap_or_else(|| panic!("{:?}", sink.kept()))
}

/// A study by a clock that ticks once a ray.
fn study_of(scene: &Scene, rays: u64, threads: usize) -> Study {
    study_by(scene, rays, threads, || 1.0)
}

/// A study by a clock that ticks so often a ray, another number each time it is read.
fn study_by(
    scene: &Scene,
    rays: u64,
    threads: usize,
    mut pace: impl FnMut() -> f64 + Send,
) -> Study {
    let traced = AtomicU64::new(0);
    let mut read = (0, 0.0);
    let tick = Mutex::new(move |now: u64| {
        read = (now, read.1 + (now - read.0) as f64 * pace());
        Duration::from_secs_f64(read.1 * 1e-6)
    });
    let clock = || tick.lock().unwrap()(traced.load(Ordering::Relaxed));
    let proceed = |step: Step| {
        traced.fetch_add(step.rays, Ordering::Relaxed);
        true
    };
    let bench = Bench::new(
        threads,
        Clock {
            cpu: &clock,
            wall: &clock,
        },
        &proceed,
    )
    .unwrap();
    let about = About {
        scene: "<balls> & \"floor\"".to_owned(),
        ..About::default()
    };
    study::study(scene, about, Effort(rays), 1, &bench).unwrap()
}

static WHOLE: LazyLock<Study> = LazyLock::new(|| study_of(&scene(&[]), 8_000_000, 0));

/// With depth of field, and so large that only a part can be looked at.
static PART: LazyLock<Study> = LazyLock::new(|| {
    let wide = [
        ("\"size\": [48, 32]", "\"size\": [120, 80]"),
        ("0.8", "0.32"),
        (
            "{\"radius\": 0, \"samples\": 1}",
            "{\"radius\": 2, \"samples\": 4}",
        ),
    ];
    study_of(&scene(&wide), 24_000_000, 0)
});

fn dominates(a: &Row, b: &Row) -> bool {
    let no_worse = a.errors.rmse <= 1.001 * b.errors.rmse && a.rays.all() <= b.rays.all();
    no_worse && (a.errors.rmse, a.rays) != (b.errors.rmse, b.rays)
}

/// Whether each row of the front has less error than those of the front before it.
fn falls(study: &Study) -> bool {
    study
        .rows
        .iter()
        .filter(|row| row.front)
        .is_sorted_by(|a, b| a.errors.rmse > b.errors.rmse)
}

#[test]
fn the_front_falls_and_dominates_all_else() {
    for study in [&*WHOLE, &*PART] {
        let front: Vec<_> = study.rows.iter().filter(|row| row.front).collect();
        assert!(front.len() >= 4 && falls(study), "{}", study::table(study));
        assert!(
            front.is_sorted_by_key(|row| row.seconds.value),
            "{}",
            study::table(study)
        );
        for row in study.rows.iter().filter(|row| !row.front) {
            assert!(
                front.iter().any(|best| dominates(best, row)),
                "{}",
                study::table(study)
            );
        }
    }
}

#[test]
fn time_is_told_as_the_clock_has_it() {
    for row in &WHOLE.rows {
        let ticks = row.rays.all() as f64 * 1e-6;
        assert!(
            (row.seconds.value - ticks).abs() <= 1e-9 && row.seconds.relative() < 1e-9,
            "{row:?}"
        );
    }
    assert_eq!(WHOLE.own().unwrap().ratio.value, 1.0);
    for row in &PART.rows {
        let ticks = row.rays.all() as f64 * 1e-6 / PART.part.share;
        assert!(
            (row.seconds.value / ticks - 1.0).abs() < 1e-9,
            "the time is that of the whole picture: {row:?}"
        );
    }
}

#[test]
fn a_study_is_the_same_on_any_number_of_threads() {
    let scene = scene(&[]);
    let [one, three] = [1, 3].map(|threads| study::json(&study_of(&scene, 1_000_000, threads)));
    assert!(one == three);
}

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

fn picture(scene: &Scene, setting: Setting) -> Image {
    let mut scene = scene.clone();
    setting.apply(&mut scene);
    film(&scene)
}

fn film(scene: &Scene) -> Image {
    let lowered = rtc::ir::Lowered {
        scene: scene.clone(),
        origins: rtc::ir::Origins::default(),
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
    let errors: Vec<_> = depth.rungs.iter().map(|rung| rung.error).collect();
    assert!(
        errors.len() > 2 && errors.is_sorted_by(|a, b| a > b) && errors.last() == Some(&0.0),
        "{errors:?}"
    );
}

#[test]
fn knobs_that_change_nothing_say_why() {
    let reason = |changes: &[(&str, &str)], knob| study::idle(knob, &scene(changes));
    assert_eq!(
        reason(&[], Knob::Aperture).unwrap(),
        "the lens has no radius"
    );
    assert_eq!(reason(&[], Knob::Lights).unwrap(), "no light has a radius");
    assert_eq!(reason(&[], Knob::Glossy).unwrap(), "no material is glossy");
    assert_eq!(reason(&[], Knob::Depth), None);
    assert!(reason(&[("\"ks\": 0.5", "\"ks\": 0")], Knob::Depth).is_some());
    assert!(reason(&[("\"phong\",", "\"zbuffer\",")], Knob::Supersampling).is_some());
    assert!(reason(&[("\"phong\",", "\"normal\",")], Knob::Depth).is_some());
    let soft_and_black = [("[1, 1, 1]}}]", "[0, 0, 0], \"radius\": 3}}]")];
    assert_eq!(
        reason(&soft_and_black, Knob::Lights).unwrap(),
        "soft light: its colour is 0 (E-LIGHT-BLACK)"
    );
    let table = study::table(&WHOLE);
    assert!(
        table.contains("aperture samples: not used by this scene: the lens has no radius"),
        "{table}"
    );
}

/// If a knob is idle the picture is the same for all its values.
#[test]
fn idle_knobs_change_no_bit() {
    let mut one_ball = scene(&[]);
    one_ball.surfaces.truncate(1);
    assert!(
        study::idle(Knob::Depth, &one_ball).is_some_and(|reason| reason.contains("E-REFL-CONVEX"))
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
        for knob in Knob::ALL
            .into_iter()
            .filter(|knob| study::idle(*knob, &scene).is_some())
        {
            let other = Setting::of(&scene).with(knob, 7);
            assert!(picture(&scene, other) == plain, "{knob:?}");
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
    let names: Vec<_> = WHOLE
        .effects
        .iter()
        .map(|cost| cost.effect.as_str())
        .collect();
    assert_eq!(
        names,
        [
            "shadows",
            "mirrors and refraction",
            "highlights and mirrors"
        ]
    );
    assert!(
        WHOLE
            .effects
            .iter()
            .all(|cost| cost.ray_ratio < 1.0 && cost.difference > 1.0),
        "{:?}",
        WHOLE.effects
    );
    assert!(
        WHOLE.effects[0].rays.shadow == 0 && WHOLE.effects[1].rays.mirror == 0,
        "{:?}",
        WHOLE.effects
    );
    assert!(
        PART.effects
            .iter()
            .any(|cost| cost.effect == "depth of field"
                && cost.rays.camera * 4 <= PART.own().unwrap().rays.camera)
    );
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

/// Rows are by a plainer arithmetic only where the plan expects nothing to show, and the error
/// stays what it was.
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
                .all(|cost| cost.borne == is_borne(cost.arithmetic)),
            "{table}"
        );
        let by = |arithmetic| {
            study
                .rows
                .iter()
                .filter(move |row| row.setting.precision == arithmetic)
        };
        assert!(
            by(least).count() > 2 && by(Arithmetic::F32).all(|row| is_borne(row.setting.precision)),
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
fn json_and_csv_come_back() {
    for study in [&*WHOLE, &*PART] {
        let json = study::json(study);
        let back: Study = serde_json::from_str(&json).unwrap();
        assert!(study::json(&back) == json && back.rows.len() == study.rows.len());
        let csv = study::csv(study);
        let mut lines = csv
            .split_terminator("\r\n")
            .map(|line| line.split(',').collect::<Vec<_>>());
        let names = lines.next().unwrap();
        let column = |name| names.iter().position(|other| *other == name).unwrap();
        for (line, row) in lines.by_ref().zip(&study.rows) {
            assert_eq!(line.len(), names.len());
            let number = |name| line[column(name)].parse::<f64>().unwrap().to_bits();
            assert_eq!(number("rmse"), row.errors.rmse.to_bits());
            assert_eq!(number("seconds_high"), row.seconds.high.to_bits());
            assert_eq!(line[column("camera_rays")], row.rays.camera.to_string());
            assert_eq!(line[column("precision")], row.setting.precision.name());
        }
        assert!(lines.next().is_none());
    }
}

#[test]
fn the_table_fits_a_terminal() {
    for study in [&*WHOLE, &*PART] {
        let table = study::table(study);
        assert!(
            table.lines().all(|line| line.chars().count() <= 80),
            "{table}"
        );
        assert!(table.contains("own") && table.contains('*'), "{table}");
    }
}

#[test]
fn the_page_needs_nobody_else() {
    let page = study::html(&PART);
    let without_names = page.replace("xmlns=\"http://www.w3.org/2000/svg\"", "");
    for foreign in ["http:", "https:", "<script", "<link", "@import", "url("] {
        assert!(!without_names.contains(foreign), "{foreign}");
    }
    assert!(
        page.contains("name=\"viewport\"") && page.contains("prefers-color-scheme")
            || page.contains("color-scheme: light dark")
    );
    assert!(
        page.contains("What accuracy costs: &lt;balls&gt; &amp; &quot;floor&quot;")
            && !page.contains("<balls>")
    );
    assert!(
        page.matches("<svg").count() >= 3 && page.matches("data:image/png;base64,").count() >= 5
    );
    assert!(page.contains("<text"), "text of plots stays text");
}

#[test]
fn advice_names_a_row_and_judges_the_scenes_own() {
    let first = &WHOLE.advice[0];
    assert!(
        first.contains("error") && first.contains(" for "),
        "{first}"
    );
    assert!(
        WHOLE
            .advice
            .iter()
            .any(|line| line.starts_with("The scene's own setting, 2×2, depth 1, is "))
    );
}

/// Twenty studies by clocks that are off by up to a half recommend the same row, as they would by a
/// clock that is right, and none has a front that rises.
#[test]
fn advice_keeps_still_on_a_noisy_clock() {
    let recommended = |study: &Study| study.advice[0].split(':').next().unwrap().to_owned();
    let right = recommended(&study_of(&scene(&[]), 1_000_000, 0));
    let mut state = 1_u64;
    let mut noise = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        1.0 + (state >> 11) as f64 / (1_u64 << 54) as f64
    };
    let studies: Vec<_> = (0..20)
        .map(|_| study_by(&scene(&[]), 1_000_000, 0, &mut noise))
        .collect();
    assert!(studies.iter().all(falls));
    let other: Vec<_> = studies
        .iter()
        .map(recommended)
        .filter(|words| *words != right)
        .collect();
    assert!(other.len() <= 1, "{right}, but {other:?}");
}

#[test]
fn a_scene_without_knobs_has_one_row_without_error() {
    let study = study_of(&scene(&[("\"phong\",", "\"zbuffer\",")]), 1_000_000, 0);
    assert_eq!(study.rows.len(), 1, "{}", study::table(&study));
    assert!(study.rows[0].front && study.rows[0].own && study.rows[0].errors.rmse == 0.0);
    assert!(study::html(&study).contains("</html>"));
}

#[test]
fn a_study_can_be_stopped() {
    let clock = || Duration::ZERO;
    let bench = Bench::new(
        1,
        Clock {
            cpu: &clock,
            wall: &clock,
        },
        &|_| false,
    )
    .unwrap();
    assert_eq!(
        study::study(&scene(&[]), About::default(), Effort::QUICK, 1, &bench).unwrap_err(),
        Stopped
    );
}

/// Two balls under a disc that shines and a sky, by paths.
#[test]
fn paths_have_a_ladder_and_a_law_of_their_own() {
    let (mut map, mut sink) = (SourceMap::default(), Sink::default());
    let file = map.add("paths.json", include_bytes!("honest/paths.json").to_vec());
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
