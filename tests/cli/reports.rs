//! What `rtc` reports of a scene: what accuracy costs, and what the picture needs.

use super::{code, command, folder, names, rtc, scene_with, stderr};
use std::fs;

#[test]
fn a_study_is_written_in_the_form_asked_for() {
    let folder = folder();
    fs::write(
        folder.path().join("depth.json"),
        scene_with("\"phong\",", "\"zbuffer\","),
    )
    .unwrap();
    let table = rtc(
        &folder,
        &[
            "cost",
            "depth.json",
            "--effort",
            "quick",
            "--html",
            "page.html",
        ],
    );
    assert_eq!(code(&table), 0, "{}", stderr(&table));
    assert!(
        String::from_utf8(table.stdout)
            .unwrap()
            .starts_with("depth.json, xxh3:")
            && table.stderr.is_empty()
    );
    assert!(
        fs::read_to_string(folder.path().join("page.html"))
            .unwrap()
            .ends_with("</html>\n")
    );
    let csv = rtc(&folder, &["cost", "depth.json", "--format", "csv"]);
    assert_eq!(String::from_utf8(csv.stdout).unwrap().lines().count(), 2);
    assert_eq!(
        code(&rtc(
            &folder,
            &["cost", "depth.json", "--format", "json", "-o", "cost.json"]
        )),
        0
    );
    let json: serde_json::Value =
        serde_json::from_slice(&fs::read(folder.path().join("cost.json")).unwrap()).unwrap();
    assert_eq!(
        (json["schema"].as_str(), json["about"]["scene"].as_str()),
        (Some("rtc-cost/3"), Some("depth.json"))
    );
    assert_eq!(code(&rtc(&folder, &["cost", "bad.json"])), 1);
}

#[test]
fn a_study_asks_for_the_vector_instructions_that_a_render_asks_for() {
    let folder = folder();
    for verb in ["render", "cost"] {
        let mut asked = command(folder.path(), &[verb, "ball.json", "-o", "x"]);
        let output = asked.env("RTC_SIMD", "sse9").output().unwrap();
        assert_eq!(code(&output), 2, "{verb}: {}", stderr(&output));
        assert!(stderr(&output).contains("no `sse9`"), "{verb}");
    }
}

#[test]
fn a_plan_is_explained_to_people_and_to_programs() {
    let folder = folder();
    let table = rtc(&folder, &["compile", "ball.json", "--explain"]);
    let text = String::from_utf8(table.stdout.clone()).unwrap();
    assert_eq!(code(&table), 0);
    assert!(
        text.lines().all(|line| line.chars().count() <= 80),
        "{text}"
    );
    assert!(
        text.contains("shadows") && text.contains("E-REFR") && text.contains("kernel: "),
        "{text}"
    );
    let json = rtc(&folder, &["compile", "ball.json", "--explain=json"]);
    let json: serde_json::Value = serde_json::from_slice(&json.stdout).unwrap();
    let effects = json["effects"].as_array().unwrap();
    let shadows = effects
        .iter()
        .find(|row| row["effect"] == "shadows")
        .unwrap();
    assert_eq!(shadows["verdict"], "needed");
    assert!(
        shadows["rays"].as_u64() > Some(0)
            && json["rays"].as_u64() <= json["raysUnpruned"].as_u64()
    );
    assert_eq!(names(folder.path()).len(), 3, "no IR is written");
    assert_eq!(
        code(&rtc(
            &folder,
            &["compile", "ball.json", "--explain", "-o", "ir.json"]
        )),
        0
    );
    assert!(folder.path().join("ir.json").exists());
}

#[test]
fn rules_can_be_switched_off_and_change_no_byte() {
    let folder = folder();
    let render = |name: &str, extra: &[&str]| {
        let output = rtc(
            &folder,
            &[&["render", "ball.json", "-o", name], extra].concat(),
        );
        assert_eq!(code(&output), 0, "{extra:?}: {}", stderr(&output));
        fs::read(folder.path().join(name)).unwrap()
    };
    let planned = render("planned.png", &[]);
    assert_eq!(render("naive.png", &["--no-prune"]), planned);
    assert_eq!(render("some.png", &["--no-prune=E-SPEC,e-cull"]), planned);
    assert_eq!(render("verified.png", &["--verify-effects"]), planned);
    // The metadata name what may change pixels.
    let approx = render("approx.png", &["--approx", "--no-metadata"]);
    assert_eq!(approx, render("bare.png", &["--no-metadata"]));
    for arithmetic in ["plain", "f32"] {
        let by = ["--arithmetic", arithmetic, "--verify-effects"];
        assert_eq!(
            render("verified.png", &by),
            render("planned.png", &by[..2]),
            "{arithmetic}"
        );
    }
    assert_eq!(
        code(&rtc(&folder, &["render", "ball.json", "--no-prune=E-NONE"])),
        2
    );
    let rule = rtc(&folder, &["explain", "E-SPEC"]);
    assert!(String::from_utf8(rule.stdout).unwrap().contains("ks is 0"));
}

/// A scene against its reference: what is told, and what gates make of it.
#[test]
fn a_scene_is_held_against_another() {
    let folder = folder();
    let dark = scene_with("\"color\": [1, 1, 1]", "\"color\": [0.5, 0.5, 0.5]");
    fs::write(folder.path().join("dark.json"), dark).unwrap();
    let cost = |args: &[&str]| rtc(&folder, &[&["cost", "--effort", "quick"], args].concat());
    let same = cost(&["ball.json", "ball.json", "--gate", "error<=0,rays<=1x"]);
    assert_eq!(code(&same), 0, "{}", stderr(&same));
    let reported = String::from_utf8(same.stdout).unwrap();
    assert!(reported.contains("same, to the last bit"), "{reported}");
    let other = cost(&[
        "dark.json",
        "ball.json",
        "--gate",
        "error<=1",
        "--format",
        "json",
    ]);
    assert_eq!(code(&other), 1, "{}", stderr(&other));
    let report: serde_json::Value = serde_json::from_slice(&other.stdout).unwrap();
    assert_eq!(report["schema"], "rtc-versus/1");
    assert_eq!(report["gates"][0]["isMet"], false);
    assert!(report["error"]["low"].as_f64().unwrap() > 1.0, "{report}");
    assert!(!report["different"].as_array().unwrap().is_empty());
    let wide = scene_with("[40, 30]", "[50, 30]");
    fs::write(folder.path().join("wide.json"), wide).unwrap();
    for (args, end, words) in [
        (&["wide.json", "ball.json"][..], 1, "50 × 30"),
        (&["ball.json", "--gate", "time<=2x"], 2, "and its reference"),
        (
            &["ball.json", "ball.json", "--format", "csv"],
            2,
            "one scene",
        ),
        (
            &["ball.json", "ball.json", "--maps", "maps"],
            2,
            "`--maps` is for the study of one scene",
        ),
        (
            &["ball.json", "ball.json", "--gate", "rmse<=2"],
            2,
            "measures are error",
        ),
        (&["-", "-"], 2, "standard input is one scene"),
    ] {
        let output = cost(args);
        assert_eq!(code(&output), end, "{args:?}");
        assert!(stderr(&output).contains(words), "{}", stderr(&output));
    }
}

/// A render that talks in objects ends in one of its picture.
#[test]
fn a_picture_is_told_as_an_object() {
    let folder = folder();
    let render = |more: &[&str]| {
        let args = [
            "render",
            "ball.json",
            "-o",
            "a.png",
            "--message-format",
            "json",
        ];
        let output = rtc(&folder, &[&args[..], more].concat());
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        stderr(&output)
    };
    let last = |said: String| -> serde_json::Value {
        let object: serde_json::Value = serde_json::from_str(said.lines().last().unwrap()).unwrap();
        object["rendered"].clone()
    };
    let plain = last(render(&[]));
    assert_eq!(plain["output"], "a.png");
    assert_eq!(plain["size"], serde_json::json!([40, 30]));
    assert!(plain["rays"].as_u64().unwrap() >= 40 * 30, "{plain}");
    assert!(
        plain["quality"].is_null() && plain["simulated"].is_object(),
        "{plain}"
    );
    let good = last(render(&["--target-error", "2"]));
    let bound = good["quality"]["bound"].as_f64().unwrap();
    assert!(bound > 0.0 && bound <= 2.0, "{good}");
    assert!(
        good["quality"]["samples"]["mean"].as_f64().unwrap() >= 1.0,
        "{good}"
    );
    let by_word = last(render(&["--quality", "good"]));
    let by_number = last(render(&["--target-error", "1.5"]));
    assert_eq!(by_word["quality"], by_number["quality"]);
    assert!(
        by_word["quality"]["bound"].as_f64().unwrap() <= 1.5,
        "{by_word}"
    );
    assert_eq!(render(&["-q"]), "");
    let denoised = last(render(&["--integrator", "path", "--spp", "4", "--denoise"]));
    let quality = &denoised["quality"];
    let [met, reported] = ["metError", "toldError"].map(|key| quality[key].as_f64().unwrap());
    assert!(
        denoised["denoised"] == true && met >= reported,
        "{denoised}"
    );
    // A sixteenth of 1200 pixels, and 256 that are drawn, or some of them more than once.
    let probes = serde_json::json!({ "pixels": 331, "samples": 8 });
    assert_eq!(quality["probes"], probes, "{denoised}");
    // Towards a target it takes the paths that it needs.
    let paths = |more: &[&str]| {
        last(render(
            &[&["--integrator", "path", "--denoise"], more].concat(),
        ))
    };
    let [good, reference] = ["good", "reference"].map(|word| paths(&["--quality", word]));
    let error = |made: &serde_json::Value| made["quality"]["metError"].as_f64().unwrap();
    assert!(
        error(&good) <= 1.5 && error(&reference) <= 0.5,
        "{good} {reference}"
    );
    assert!(reference["rays"].as_u64() > good["rays"].as_u64());
    assert_eq!(reference["quality"]["endsAbove"], serde_json::Value::Null);
}

/// What a clamp takes is told, the same for any number of threads; one that takes nothing changes nothing.
#[test]
fn a_clamp_tells_what_it_takes() {
    let folder = folder();
    let picture = |name: &str, more: &str| {
        let words = format!(
            "render ball.json --integrator path --spp 9 --no-metadata --message-format json -o {name} {more}"
        );
        let output = rtc(&folder, &words.split_whitespace().collect::<Vec<_>>());
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        let said = stderr(&output);
        let object: serde_json::Value = serde_json::from_str(said.lines().last().unwrap()).unwrap();
        let bytes = std::fs::read(folder.path().join(name)).unwrap();
        (bytes, object["rendered"]["clamped"].clone())
    };
    let (plain, nothing) = picture("plain.exr", "");
    let (wide, took_none) = picture("wide.exr", "--clamp 1e6");
    let (narrow, took) = picture("narrow.exr", "--clamp 0.01 --threads 1");
    assert!(nothing.is_null(), "{nothing}");
    assert!(
        plain == wide,
        "a clamp above all radiance changed the picture"
    );
    assert_eq!(
        (&took_none["paths"], &took_none["shareOfLight"]),
        (&0.into(), &0.0.into())
    );
    assert!(plain != narrow, "the clamp took nothing");
    assert!(took["paths"].as_u64() > Some(0), "{took}");
    let share = took["shareOfLight"].as_f64().unwrap();
    assert!(share > 0.0 && share < 0.5, "{took}");
    assert_eq!(
        (narrow, took),
        picture("again.exr", "--clamp 0.01 --threads 2")
    );
    let output = rtc(
        &folder,
        &["render", "ball.json", "--clamp", "1", "-o", "none.png"],
    );
    let words = stderr(&output);
    assert!(
        code(&output) != 0 && words.contains("is for traced paths"),
        "{words}"
    );
}

/// A picture in the terminal has a line for two of its rows, and its file is there, too.
#[test]
fn a_picture_is_shown_in_a_terminal() {
    let folder = folder();
    let args = ["render", "ball.json", "-o", "a.png", "--show"];
    let output = command(folder.path(), &args)
        .env("COLUMNS", "20")
        .output()
        .unwrap();
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let shown = String::from_utf8(output.stdout).unwrap();
    // 40 × 30 as 20 × 15.
    assert_eq!(shown.lines().count(), 8, "{shown}");
    assert!(
        shown.lines().all(|line| line.matches('▀').count() == 20),
        "{shown}"
    );
    assert!(folder.path().join("a.png").exists());
    let refused = rtc(&folder, &["render", "ball.json", "-o", "-", "--show"]);
    assert_eq!(code(&refused), 2, "{}", stderr(&refused));
}
