//! `rtc render`: where the picture goes, what options change in it, and what is said of it.

use super::*;

#[test]
fn a_picture_is_named_after_its_scene_and_lands_here() {
    let folder = folder();
    fs::create_dir(folder.path().join("here")).unwrap();
    let rendered = command(&folder.path().join("here"), &["render", "../ball.json"])
        .output()
        .unwrap();
    assert_eq!(
        (code(&rendered), names(&folder.path().join("here"))),
        (0, vec!["ball.png".to_owned()])
    );
}

#[test]
fn every_form_of_the_ir_renders_to_the_same_bytes() {
    let folder = folder();
    let picture = |scene: &str| rtc(&folder, &["render", scene, "-o", "-", "-q"]).stdout;
    for form in ["copy.json", "copy.rtir"] {
        assert_eq!(
            code(&rtc(&folder, &["compile", "ball.json", "-o", form])),
            0
        );
        assert!(picture(form) == picture("ball.json"), "{form}");
    }
    let binary = rtc(&folder, &["compile", "ball.json", "--emit", "ir-bin"]).stdout;
    assert!(binary == fs::read(folder.path().join("copy.rtir")).unwrap());
}

#[test]
fn a_crop_is_that_part_of_the_whole_on_any_threads() {
    let folder = folder();
    let decode = |args: &[&str]| {
        let output = rtc(
            &folder,
            &[&["render", "ball.json", "-q", "-o", "-"], args].concat(),
        );
        image::load_from_memory(&output.stdout).unwrap().to_rgb16()
    };
    for bits in ["8", "16"] {
        let whole = decode(&["--bits", bits, "--threads", "1"]);
        let part = decode(&["--bits", bits, "--threads", "3", "--crop", "13,7,20,100"]);
        assert_eq!(part.dimensions(), (20, 23));
        assert!(image::imageops::crop_imm(&whole, 13, 7, 20, 23).to_image() == part);
    }
}

#[test]
fn options_override_the_scene() {
    let folder = folder();
    let reported = |args: &[&str]| {
        let output = rtc(
            &folder,
            &[
                &["render", "ball.json", "-o", "o.png", "--depth", "0"],
                args,
            ]
            .concat(),
        );
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        stderr(&output)
    };
    assert!(reported(&["--size", "20x15", "--supersampling", "1"]).starts_with("o.png: 20×15, "));
    assert_eq!(
        image::open(folder.path().join("o.png")).unwrap().width(),
        20
    );
    let huge = rtc(&folder, &["render", "ball.json", "--size", "70000x70000"]);
    assert_eq!(
        (
            code(&huge),
            names(folder.path()).contains(&"ball.png".to_owned())
        ),
        (1, false)
    );
}

#[test]
fn a_picture_says_where_it_came_from_unless_that_is_left_out() {
    let folder = folder();
    let picture = |name: &str, args: &[&str]| {
        let render = [&["render", "ball.json", "-o", name], args].concat();
        assert_eq!(code(&rtc(&folder, &render)), 0, "{name} {args:?}");
        fs::read(folder.path().join(name)).unwrap()
    };
    let has = |bytes: &[u8], words: &str| bytes.windows(words.len()).any(|w| w == words.as_bytes());
    for [name, other] in [["a.exr", "b.exr"], ["a.png", "b.png"]] {
        let first = picture(name, &[]);
        assert!(
            first == picture(other, &["--threads", "1"]),
            "two renders differ"
        );
        let bare = picture(other, &["--no-metadata"]);
        for words in [
            "rtc:scene",
            "rtc:settings",
            "\"supersampling\":2",
            concat!("rtc ", env!("CARGO_PKG_VERSION")),
        ] {
            assert!(
                has(&first, words) && !has(&bare, words),
                "{words} in {name}"
            );
        }
        let diff = rtc(&folder, &["diff", name, other, "--gate", "max<=0"]);
        assert_eq!(code(&diff), 0, "{}", stderr(&diff));
    }
    let linear = fs::read(folder.path().join("b.exr")).unwrap();
    assert!(has(&linear, "chromaticities") && has(&linear, "worldToCamera"));
    assert!(has(&fs::read(folder.path().join("b.png")).unwrap(), "sRGB"));
}

#[test]
fn layers_are_pictures_beside_a_png() {
    let folder = folder();
    let render = |args: &[&str]| rtc(&folder, &[&["render", "ball.json"], args].concat());
    let all = "albedo,normal,depth,uv,instance,position";
    let made = render(&["-o", "b.png", "--aov", all]);
    assert_eq!(code(&made), 0, "{}", stderr(&made));
    for layer in all.split(',') {
        let bytes = fs::read(folder.path().join(format!("b.{layer}.png"))).unwrap();
        let text = String::from_utf8_lossy(&bytes);
        assert!(
            text.contains(&format!("{{\"layer\":\"{layer}\"")),
            "{layer}"
        );
        assert_eq!(text.contains("sRGB"), layer == "albedo", "{layer}");
        let ranged = layer == "depth" || layer == "position";
        assert_eq!(text.contains("\"ranges\":[["), ranged, "{layer}");
    }
    let goal = ["--target-error", "8", "-o", "c.png"];
    let made = render(&[&goal[..], &["--aov", "error,samples,unmet"]].concat());
    assert_eq!(code(&made), 0, "{}", stderr(&made));
    for layer in ["error", "samples", "unmet"] {
        let bytes = fs::read(folder.path().join(format!("c.{layer}.png"))).unwrap();
        let text = String::from_utf8_lossy(&bytes);
        assert_eq!(text.contains("\"ranges\":[["), layer != "unmet", "{layer}");
    }
    for (args, why) in [
        (
            &["-o", "b.png", "--aov", "unmet"][..],
            "`--target-error LEVELS`",
        ),
        (&["-o", "b.jpg", "--aov", "uv"], "or an EXR"),
        (&["-o", "-", "--aov", "uv"], "name the picture .exr"),
        (
            &["-o", "b.png", "--aov", "uv", "--strips"],
            "name the picture .exr",
        ),
        (
            &["-o", "b.rtp", "--aov", "uv", "--part", "1/2"],
            "name the picture .exr",
        ),
    ] {
        let refused = render(args);
        assert_eq!(code(&refused), 2, "{args:?}");
        assert!(stderr(&refused).contains(why), "{}", stderr(&refused));
    }
}

#[test]
fn an_exr_has_floats_of_16_bits_if_asked() {
    let folder = folder();
    let render = |name: &str, bits: &str| {
        rtc(
            &folder,
            &["render", "ball.json", "-o", name, "--bits", bits],
        )
    };
    assert_eq!(
        (code(&render("a.exr", "32")), code(&render("b.exr", "16"))),
        (0, 0)
    );
    let length = |name: &str| fs::metadata(folder.path().join(name)).unwrap().len();
    assert!(length("b.exr") < length("a.exr"));
    let near = rtc(&folder, &["diff", "a.exr", "b.exr", "--gate", "max<=1"]);
    assert_eq!(code(&near), 0, "{}", stderr(&near));
    for (name, bits) in [("a.exr", "8"), ("a.png", "32"), ("a.jpg", "16")] {
        assert_eq!(code(&render(name, bits)), 2, "{name} {bits}");
    }
}

#[test]
fn a_target_is_met_said_and_the_same_on_any_threads() {
    let folder = folder();
    let render = |args: &[&str]| {
        rtc(
            &folder,
            &[&["render", "ball.json", "-o", "-"], args].concat(),
        )
    };
    let one = render(&["--target-error", "2", "--threads", "1"]);
    let reporter = stderr(&one);
    let said = reporter
        .lines()
        .nth(1)
        .unwrap()
        .strip_prefix("error ≤ ")
        .unwrap();
    assert!(
        said.split(' ').next().unwrap().parse::<f64>().unwrap() <= 2.0,
        "{reporter}"
    );
    assert!(
        said.contains(" grey levels (90 %), ") && said.contains(" samples per pixel on average, "),
        "{reporter}"
    );
    assert!(render(&["--target-error", "2", "--threads", "3"]).stdout == one.stdout);
    assert_eq!(
        code(&render(&[
            "--target-error",
            "2",
            "--time-budget",
            "1",
            "--crop",
            "3,4,5,6"
        ])),
        0
    );
    for args in [
        &["--supersampling", "2"],
        &["--aperture-samples", "2"],
        &["--target-error", "0"],
    ] {
        assert_eq!(
            code(&render(&[&["--time-budget", "1"], &args[..]].concat())),
            2,
            "{args:?}"
        );
    }
}

#[test]
fn nothing_in_view_is_a_warning_after_the_render() {
    let folder = folder();
    let output = rtc(&folder, &["render", "away.json"]);
    assert_eq!(code(&output), 0);
    assert!(
        stderr(&output).contains("warning[RD001]: no ray of the camera hit anything"),
        "{}",
        stderr(&output)
    );
    assert!(folder.path().join("away.png").exists());
}

#[test]
fn an_arithmetic_too_coarse_for_the_scene_is_a_warning_at_the_surface() {
    let folder = folder();
    let far = SCENE
        .replace(", 50]", ", 1000050]")
        .replace("[0, 0, 0], \"right\"", "[0, 0, 1000000], \"right\"");
    let far = far
        .replace("[0, 0, 0], \"radius\"", "[0, 0, 1000000], \"radius\"")
        .replace("40, 60]", "40, 1000060]");
    fs::write(folder.path().join("far.json"), far).unwrap();
    let warning = |arithmetic: &str| {
        let output = rtc(&folder, &["render", "far.json", "--arithmetic", arithmetic]);
        assert_eq!(code(&output), 0);
        stderr(&output)
            .lines()
            .find(|line| line.contains("RD002"))
            .map(str::to_owned)
    };
    let found = warning("f32").unwrap();
    assert!(
        found.contains("in f32 this picture will be wrong: surfaces shade or mirror themselves"),
        "{found}"
    );
    assert_eq!((warning("plain"), warning("robust")), (None, None));
}

/// A scene of paths: a white ball in a sun from this direction.
fn in_a_sun(direction: &str) -> String {
    format!(
        "Camera: {{eye: [0, 2, 6], center: [0, 0, 0], up: [0, 1, 0], fov: 45, viewSize: [32, 24]}}\n\
         Lights:\n- {{type: sun, direction: {direction}, irradiance: [3, 3, 3]}}\n\
         Objects:\n- {{type: sphere, position: [0, 0, 0], radius: 1, material: {{type: standard, \
         baseColor: [1, 0.2, 0.1, 1], metallic: 0, roughness: 0.3}}}}\n"
    )
}

/// The warning is of the picture, so the picture is there when it is denied.
#[test]
fn a_target_that_is_not_met_is_a_warning_and_the_picture_is_not_lost() {
    let folder = folder();
    fs::write(folder.path().join("a.yaml"), in_a_sun("[1, 2, 1]")).unwrap();
    let render = |more: &[&str]| {
        let fixed = ["render", "a.yaml", "-o", "a.png"];
        let output = rtc(&folder, &[&fixed, more].concat());
        (code(&output), stderr(&output))
    };
    let (done, said) = render(&["--target-error", "0.1"]);
    assert!(done == 0 && said.contains("warning[RD017]"), "{said}");
    fs::remove_file(folder.path().join("a.png")).unwrap();
    let (done, said) = render(&["--target-error", "0.1", "--deny", "RD017", "-q"]);
    assert!(done == 1 && said.contains("error[RD017]"), "{said}");
    assert!(folder.path().join("a.png").exists());
    let (_, said) = render(&["--target-error", "50"]);
    assert!(!said.contains("RD017"), "{said}");
    // A time that ends before is what was asked for.
    let (_, said) = render(&["--target-error", "0.1", "--time-budget", "0.2"]);
    assert!(!said.contains("RD017"), "{said}");
}

#[test]
fn surfaces_that_no_light_reaches_are_told() {
    let folder = folder();
    for (direction, is_dark) in [("[0, -2, -9]", true), ("[0, 2, 9]", false)] {
        fs::write(folder.path().join("a.yaml"), in_a_sun(direction)).unwrap();
        let output = rtc(&folder, &["render", "a.yaml", "--spp", "2", "-o", "a.png"]);
        let said = stderr(&output);
        assert_eq!(
            said.contains("warning[RD018]"),
            is_dark,
            "{direction}: {said}"
        );
    }
    // Darkness that is asked for is none to tell.
    let dark = [
        "render",
        "a.yaml",
        "--no-scene-lights",
        "--env-color",
        "0,0,0",
        "-o",
        "a.png",
    ];
    assert!(!stderr(&rtc(&folder, &dark)).contains("RD018"));
}
