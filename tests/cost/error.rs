//! Errors: those that a study reports, also for its reference, agree with finer renders.

use super::*;

#[test]
fn error_follows_the_laws_of_sampling() {
    let law = |study: &Study, parameter| {
        study
            .parameters
            .iter()
            .find(|report| report.parameter == parameter)
            .and_then(|report| report.law)
    };
    let edges = law(&WHOLE, Parameter::Supersampling).unwrap().p;
    assert!(
        0.6 < edges.value && edges.value < 0.95,
        "edges under a grid: {edges:?}"
    );
    let blurred = scene(&[(
        "{\"radius\": 0, \"samples\": 1}",
        "{\"radius\": 2, \"samples\": 1}",
    )]);
    let coarse = Setting::of(&blurred).with(Parameter::Supersampling, 1);
    let at = |points| [picture(&blurred, coarse.with(Parameter::Aperture, points))];
    let reference = at(1024);
    let lens = PowerLaw::fit(&[4, 16, 64].map(|n| (f64::from(n), study::rmse(&at(n), &reference))))
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
            .filter(|row| row.is_resolved && row.setting.aperture != 2)
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
                .all(|row| row.is_resolved == (floor <= 0.2 * row.errors.rmse))
        );
    }
    let poor = study_of(&scene(&[]), 400_000, 0);
    assert!(
        poor.rows.iter().any(|row| !row.is_resolved) && study::table(&poor).contains('≤'),
        "{}",
        study::table(&poor)
    );
}

/// The reference is correct: renders with more and more samples converge to it.
#[test]
fn the_error_told_is_the_distance_to_a_finer_render() {
    let scene = scene(&[]);
    let own = Setting::of(&scene);
    let fine = own.with(Parameter::Supersampling, 32);
    let (coarse, fine) = (picture(&scene, own), picture(&scene, fine));
    let reported = WHOLE.scene_row().unwrap().errors.rmse;
    let error = study::rmse(&[coarse], &[fine]);
    assert!(
        (reported / error - 1.0).abs() < 0.02,
        "{reported} for {error}"
    );
}

pub(super) fn picture(scene: &Scene, setting: Setting) -> Image {
    let mut scene = scene.clone();
    setting.apply(&mut scene);
    film(&scene)
}

pub(super) fn film(scene: &Scene) -> Image {
    let lowered = rtc::internals::ir::LoweredScene {
        scene: scene.clone(),
        source_spans: rtc::internals::ir::SourceSpans::default(),
    };
    let mut sink = DiagnosticSink::default();
    let valid = pipeline::validate(&lowered, &Options::default(), &mut sink)
        .unwrap_or_else(|| panic!("{:?}", sink.kept()));
    render(
        &valid,
        &Plan::new(&valid, RuleSet::ALL),
        &RenderSelection::default(),
        &|_| true,
    )
    .unwrap()
    .image
}

/// A grid that is not centred would not converge.
#[test]
fn a_planted_defect_shows_as_a_floor() {
    let scene = scene(&[]);
    let reference = [picture(
        &scene,
        Setting::of(&scene).with(Parameter::Supersampling, 24),
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
                        Setting::of(scene).with(Parameter::Supersampling, factor),
                    )],
                    &reference,
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
fn what_is_left_out_of_the_depth_ends_at_the_scenes_own() {
    let depth = WHOLE
        .parameters
        .iter()
        .find(|report| report.parameter == Parameter::Depth)
        .unwrap();
    let errors: Vec<_> = depth.levels.iter().map(|level| level.error).collect();
    assert!(
        errors.len() == 2 && errors[0] > 1.0 && errors[1] == 0.0,
        "{errors:?}"
    );
}

/// A scene without bounces has no error for that: the effect of more bounces is reported
/// separately.
#[test]
fn the_scenes_own_depth_is_no_error() {
    let flat = scene(&[("\"maxDepth\": 1", "\"maxDepth\": 0")]);
    let study = study_of(&flat, 2_000_000, 0);
    let table = study::table(&study);
    let own = Setting::of(&flat);
    let fine = own.with(Parameter::Supersampling, 16);
    let error = study::rmse(&[picture(&flat, own)], &[picture(&flat, fine)]);
    let reported = study.scene_row().unwrap().errors.rmse;
    assert!(
        (reported / error - 1.0).abs() < 0.05,
        "{reported} for {error}"
    );
    assert!(
        study.rows.iter().all(|row| row.setting.depth == 0),
        "{table}"
    );
    for study in [&study, &*WHOLE] {
        let bounces = study.bounces.as_ref().unwrap();
        let most = bounces.deeper.last().unwrap();
        let at = |depth| [picture(&flat, fine.with(Parameter::Depth, depth))];
        let difference = study::rmse(&at(bounces.scene_depth), &at(most.depth));
        assert!(
            bounces.end == DepthEnd::Exact && (most.difference / difference - 1.0).abs() < 0.2,
            "{bounces:?}, but {difference}"
        );
        assert!(study::table(study).contains("more bounces"), "{table}");
        assert!(study::html(study).contains("The effect of more bounces"));
    }
    assert!(
        study
            .advice
            .iter()
            .any(|line| line.contains("another picture")),
        "{:?}",
        study.advice
    );
}

/// Forty studies of random tiles of a picture with errors at a few outlines: the true error lies in
/// at least nine of ten intervals.
#[test]
fn the_interval_of_a_part_holds_the_error_of_the_whole() {
    const SIZE: [u32; 2] = [240, 160];
    const LOOKS: u64 = 40;
    let wide = scene(&[
        ("\"size\": [48, 32]", "\"size\": [240, 160]"),
        ("0.8", "0.32"),
    ]);
    let own = Setting::of(&wide).with(Parameter::Supersampling, 1);
    let pictures = [1, 4].map(|factor| picture(&wide, own.with(Parameter::Supersampling, factor)));
    let [columns, rows] = SIZE.map(|side| side / Tiles::SIDE);
    let places = (0..rows).flat_map(|y| (0..columns).map(move |x| [x, y]));
    let places: Vec<_> = places.collect();
    let whole = study::rmse(&pictures[..1], &pictures[1..]);
    let errors = |places: &[[u32; 2]]| {
        let of = |image: &Image| places.iter().map(|place| tile(image, *place)).collect();
        let [test, reference]: [Vec<Image>; 2] = pictures.each_ref().map(of);
        PictureErrors::of(
            &test,
            &reference,
            places.len() as f64 / f64::from(columns * rows),
        )
    };
    let each = places.iter().map(|place| errors(&[*place]).rmse);
    let clean = each.filter(|error| *error < 0.1 * whole).count();
    assert!(
        4 * clean > 3 * places.len(),
        "unevenly: {clean} without error"
    );
    for count in [24, 40] {
        let held = (0..LOOKS).filter(|seed| {
            let mut order = places.clone();
            order.sort_by_key(|place| Tiles::rank(*seed, *place));
            let errors = errors(&order[..count]);
            errors.rmse_low <= whole && whole <= errors.rmse_high
        });
        let held = held.count() as u64;
        println!("{held} of {LOOKS} looks at {count} tiles");
        assert!(10 * held >= 9 * LOOKS, "{held} of {LOOKS} at {count} tiles");
    }
    assert_eq!(errors(&places).rmse_high, errors(&places).rmse);
}

/// The tile at a column and row of tiles.
fn tile(image: &Image, [x, y]: [u32; 2]) -> Image {
    let side = Tiles::SIDE as usize;
    let row = |row: usize| &image.pixels[row * image.width as usize + x as usize * side..][..side];
    let top = y as usize * side;
    Image {
        width: Tiles::SIDE,
        height: Tiles::SIDE,
        pixels: (top..top + side).flat_map(row).copied().collect(),
    }
}

/// With 16 paths there is one denoised row, with four paths, less noise than without denoising, and
/// the rays of the guide images.
fn a_quarter_of_the_paths_is_denoised(study: &Study) {
    let table = study::table(study);
    let (denoised, plain): (Vec<_>, Vec<_>) =
        study.rows.iter().partition(|row| row.setting.denoise);
    let [denoised] = denoised[..] else {
        panic!("{table}");
    };
    let mut plain = plain.iter().filter(|row| row.setting.paths == 4);
    let plain = plain.next().unwrap();
    assert!(
        denoised.setting.paths == 4
            && denoised.errors.rmse < 0.8 * plain.errors.rmse
            && denoised.rays.camera > plain.rays.camera,
        "{table}"
    );
}

/// Two spheres under an emissive disc and an environment, path-traced.
#[test]
fn paths_have_a_ladder_and_a_law_of_their_own() {
    let scene = decoded(include_str!("../honest/paths.json").to_owned());
    let study = study_of(&scene, 60_000_000, 0);
    let table = study::table(&study);
    assert_eq!(
        study.used(),
        [
            Parameter::Paths,
            Parameter::Denoise,
            Parameter::Depth,
            Parameter::Precision
        ],
        "{table}"
    );
    let law = study
        .parameters
        .iter()
        .find(|report| report.parameter == Parameter::Paths)
        .and_then(|report| report.law)
        .unwrap();
    assert!(
        (0.4..1.0).contains(&law.p.value),
        "noise falls as 1/√n or faster: {table}"
    );
    assert!(
        study.scene_row().unwrap().setting.paths == 16
            && study.rows.iter().any(|row| row.setting.paths > 16),
        "{table}"
    );
    a_quarter_of_the_paths_is_denoised(&study);
    let is_plain = |row: &&study::StudyRow| !row.setting.denoise;
    for row in study
        .rows
        .iter()
        .filter(|row| row.is_resolved)
        .filter(is_plain)
    {
        assert!((row.model / row.errors.rmse - 1.0).abs() < 0.3, "{table}");
    }
    assert!(
        study::html(&study).contains(">spp<"),
        "the page has the column"
    );
    let line = study
        .advice
        .iter()
        .find(|line| line.contains("1 ΔE"))
        .unwrap();
    let (_, wanted) = line.split_once("`--spp ").unwrap();
    let wanted: f64 = wanted.split('`').next().unwrap().parse().unwrap();
    let own = study.scene_row().unwrap().setting;
    for row in &study.rows {
        let paths = f64::from(row.setting.paths);
        if row.setting == own.with(Parameter::Paths, row.setting.paths) && row.is_resolved {
            let delta = row.errors.delta_e;
            assert!(
                paths > 0.5 * wanted || delta > 1.0,
                "{line} {paths} have {delta}"
            );
            assert!(
                paths < 2.0 * wanted || delta < 1.0,
                "{line} {paths} have {delta}"
            );
        }
    }
}
