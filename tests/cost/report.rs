//! The reports of a study, and its advice.

use super::*;

#[test]
fn json_and_csv_come_back() {
    for study in [&*WHOLE, &*PART] {
        let json = study.json();
        let back: Study = serde_json::from_str(&json).unwrap();
        assert!(back.json() == json && back.rows.len() == study.rows.len());
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

/// The error of random samples differs between renders; the error of a grid does not, so the report
/// has no columns for it.
#[test]
fn errors_are_told_over_renders_where_renders_differ() {
    for row in &WHOLE.rows {
        let ErrorSpread {
            renders,
            expected,
            deviation,
        } = row.spread;
        assert!(renders >= 3 && deviation == 0.0, "{:?}", row.spread);
        assert!((expected - row.errors.rmse).abs() < 1e-9, "{row:?}");
    }
    assert!(!study::table(&WHOLE).contains("σ%"));

    let jitter = [(
        "\"supersampling\": 2",
        "\"supersampling\": 2, \"pattern\": \"jitter\"",
    )];
    let study = study_of(&scene(&jitter), 8_000_000, 0);
    for row in &study.rows {
        let (
            ErrorSpread {
                expected,
                deviation,
                ..
            },
            rmse,
        ) = (row.spread, row.errors.rmse);
        assert!(
            deviation > 0.0 && deviation < 0.5 * expected,
            "{:?}",
            row.spread
        );
        assert!(
            (rmse - expected).abs() < 5.0 * deviation,
            "{rmse}: {:?}",
            row.spread
        );
    }
    let (table, page) = (study::table(&study), study::html(&study));
    assert!(table.contains("σ%: the standard") && page.contains("<dt>over renders</dt>"));
    assert!(page.contains(" renders ("), "{page}");
    let csv = study::csv(&study);
    assert!(
        csv.lines()
            .next()
            .unwrap()
            .ends_with(",renders,expected_rmse,rmse_deviation")
    );
}

/// Each mark of the plot of the front shows its values on hover and on keyboard focus.
#[test]
fn marks_of_plots_say_their_values() {
    let page = study::html(&WHOLE);
    let (_, plot) = page.split_once("<div class=\"plot\">").unwrap();
    let (plot, _) = plot.split_once("</svg>").unwrap();
    let shown = WHOLE
        .rows
        .iter()
        .filter(|row| row.errors.rmse > 0.0)
        .count();
    let marks = plot.matches("<circle class=\"mark\"").count();
    assert_eq!(
        (marks, plot.matches("tabindex=\"0\"").count()),
        (shown, shown)
    );
    // Renders without random numbers are identical, so their spread is not mentioned.
    assert!(
        plot.contains(" grey levels (") && !plot.contains(" renders ("),
        "{plot}"
    );
}

/// Each column of the table is explained below it and in the HTML report, and the best setting
/// within a time is a row of the front that takes at most that time.
#[test]
fn columns_are_explained_and_times_buy_rows() {
    for study in [&*WHOLE, &*PART] {
        let (table, page) = (study::table(study), study::html(study));
        let lines: Vec<_> = table.lines().collect();
        let head = lines.iter().position(|line| line.contains("×own")).unwrap();
        let words = lines[head + 1..].join(" ");
        for column in lines[head].split_whitespace() {
            assert!(words.contains(&format!("{column}: ")), "{column}: {table}");
        }
        let (_, explained) = page.split_once("<dl>").unwrap();
        let (explained, _) = explained.split_once("</dl>").unwrap();
        for name in [
            "time",
            "error",
            "× own",
            "FLIP",
            "pixels off",
            "expected",
            "largest",
        ] {
            assert!(explained.contains(&format!("<dt>{name}</dt>")), "{name}");
        }
        assert!(words.contains("in ") && page.contains("<li class=\"at\">in "));
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
        page.contains("The cost of accuracy: &lt;balls&gt; &amp; &quot;floor&quot;")
            && !page.contains("<balls>")
    );
    assert!(
        page.matches("<svg").count() >= 3 && page.matches("data:image/png;base64,").count() >= 5
    );
    assert!(page.contains("<text"), "text of plots stays text");
}

/// Maps have the size of the picture, are hatched grey outside the rendered tiles, and have the
/// same scale for both settings; the rays of all pixels sum to those of the row.
#[test]
fn maps_have_the_size_of_the_picture_and_mark_the_tiles() {
    for study in [&*WHOLE, &*PART] {
        let maps = study::maps(study);
        let names: Vec<_> = maps.iter().map(|map| map.name.as_str()).collect();
        assert!(
            names
                == [
                    "rays-own",
                    "rays-recommended",
                    "error-own",
                    "error-recommended"
                ],
            "{names:?}"
        );
        assert!(maps[0].most == maps[1].most && maps[2].most == maps[3].most);
        for map in &maps {
            assert_eq!([map.image.width, map.image.height], study.part.size);
            let is_grey = |pixel: &&[f64; 3]| pixel[0] == pixel[1] && pixel[1] == pixel[2];
            let hatched = map.image.pixels.iter().filter(is_grey).count() as u64;
            let all = u64::from(study.part.size[0]) * u64::from(study.part.size[1]);
            assert_eq!(hatched, all - study.part.pixels, "{}", map.name);
        }
        let page = study::maps_page(study);
        assert!(page.contains("grey levels") && page.contains(" and more"));
        assert_eq!(page.contains("Hatched grey"), study.part.tiles > 0);
        assert!(study::html(study).contains("Maps of rays and of errors"));
    }
    let read: Study = serde_json::from_str(&WHOLE.json()).unwrap();
    assert!(
        study::maps(&read).is_empty(),
        "a study that was read has no pictures"
    );
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

/// The command of the main advice names what differs from the scene, and is one line of the table
/// and of the HTML report.
#[test]
fn the_recommended_setting_has_a_command() {
    let command = WHOLE.command.as_ref().unwrap();
    let own = WHOLE.scene_row().unwrap().setting;
    let words = command.strip_prefix("rtc render SCENE ").unwrap();
    let mut setting = own;
    for flag in words.split_whitespace().collect::<Vec<_>>().chunks(2) {
        let parameter = Parameter::ALL
            .into_iter()
            .find(|parameter| parameter.flag() == flag[0])
            .unwrap();
        let value = (0..200)
            .find(|value| parameter.cell(*value) == flag[1])
            .unwrap();
        assert!(own.get(parameter) != value, "{command}");
        setting = setting.with(parameter, value);
    }
    let used = WHOLE.used();
    assert!(
        WHOLE.advice[0].starts_with(&format!("{}:", setting.label(&used))),
        "{command}"
    );
    assert!(
        study::table(&WHOLE)
            .lines()
            .any(|line| line.trim() == command)
    );
    assert!(study::html(&WHOLE).contains(&format!("<code>{command}</code>")));
}

/// Twenty studies with clocks that are off by up to a half recommend the same row as an exact
/// clock, and their fronts decrease.
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

/// A recommended setting is reported as on the front, although the row of the front has another
/// arithmetic: their difference may be noise.
#[test]
fn what_is_recommended_is_never_told_to_be_off_the_front() {
    let mut study = WHOLE.clone();
    for row in &mut study.rows {
        row.front = false;
    }
    let own = study
        .rows
        .iter()
        .find(|row| row.is_scene_setting)
        .unwrap()
        .clone();
    let mut other_row = own.clone();
    (other_row.is_scene_setting, other_row.front) = (false, true);
    other_row.setting.precision = Arithmetic::Plain;
    study.rows.push(other_row);
    assert_eq!(study::recommended(&study).unwrap().setting, own.setting);
    let reported = study::advice(&study).join("\n");
    assert!(
        reported.contains("is on the front") && !reported.contains("off the front"),
        "{reported}"
    );
}
