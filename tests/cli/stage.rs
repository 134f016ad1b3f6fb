//! View and light from the command line: they mean the same as in a scene, and what they can't mean
//! is refused.

use super::set::{course, decode, folder, holding, picture, rtc, values};
use super::{code, names, stderr};
use std::fs;

#[test]
fn what_contradicts_itself_or_is_out_of_range_is_refused() {
    let folder = folder();
    let wrong = [
        "--env sky.hdr --env-color 1",
        "--env none.hdr",
        "--env-color -1",
        "--sun 0,0,0,1",
        "--sun 0,1,0",
        "--eye 1,2",
        "--up 0,0,0",
        "--yfov 180",
        "--integrator rasterizer",
        "--turntable 0",
        "--turntable 2 --verify-effects",
        "--turntable 2 -o -",
    ];
    for words in wrong {
        let output = rtc(folder.path(), &format!("render ball.yaml {words}"));
        assert_eq!(code(&output), 2, "{words}: {}", stderr(&output));
    }
    let found = [
        ("ball.yaml --env broken.hdr", "RE004"),
        ("ball.yaml --env ball.yaml", "RE004"),
        ("ball.yaml --eye 1,2,0", "VA104"),
        ("ball.yaml --eye 1,9,0 --center 1,2,0 --up 0,1,0", "VA106"),
        ("square.gltf --camera back", "GL048"),
        ("ball.yaml --camera front", "GL048"),
        ("ball.yaml --variant red", "GL048"),
        ("ball.json --camera 0", "GL048"),
        ("ball.json --animation walk", "GL048"),
    ];
    for (words, finding) in found {
        let output = rtc(folder.path(), &format!("render {words}"));
        assert_eq!(code(&output), 1, "{words}");
        assert!(
            stderr(&output).contains(&format!("error[{finding}]")),
            "{words}: {}",
            stderr(&output)
        );
    }
    let before = [
        "ball.json",
        "ball.yaml",
        "beside.yaml",
        "broken.hdr",
        "sky.hdr",
        "square.gltf",
        "sunny.gltf",
    ];
    assert_eq!(names(folder.path()), before);
}

#[test]
fn a_time_where_nothing_moves_is_a_warning() {
    let folder = folder();
    for words in [
        "ball.yaml --time 1",
        "ball.json --time 1",
        "square.gltf --time 1",
    ] {
        let output = rtc(folder.path(), &format!("render {words} --size 16x16 -o -"));
        assert_eq!(code(&output), 0, "{words}: {}", stderr(&output));
        assert!(
            stderr(&output).contains("warning[GL049]"),
            "{words}: {}",
            stderr(&output)
        );
    }
}

#[test]
fn a_view_asked_for_is_that_of_a_camera_there() {
    let folder = folder();
    let show = |words: &str| picture(folder.path(), words);
    let beside = show("beside.yaml");
    assert_eq!(
        show("ball.yaml --eye 7,2,8 --center 1,2,0"),
        beside,
        "the angle of the picture stays"
    );
    assert_eq!(
        show("ball.yaml --eye 7,2,8"),
        beside,
        "the middle of the scene is that of the ball"
    );
    assert_eq!(
        show("ball.yaml --eye 7,2,8 --up 0,3,0"),
        beside,
        "only the direction counts"
    );
    assert_ne!(show("ball.yaml"), beside);
    assert_eq!(
        show("ball.yaml --yfov 50"),
        show("ball.yaml --eye 1,2,10 --yfov 50"),
        "a wider lens stays in its place"
    );
    assert_ne!(show("ball.yaml --yfov 50"), show("ball.yaml"));
    assert!(
        !show("ball.yaml --eye 1,9,0").is_empty(),
        "from above some direction is up"
    );
}

#[test]
fn a_camera_is_found_by_its_name_that_of_its_node_and_its_index() {
    let folder = folder();
    let show = |words: &str| {
        picture(
            folder.path(),
            &format!("square.gltf --size 8x8 --spp 4 {words}"),
        )
    };
    let (first, wide) = (show(""), show("--camera wide"));
    assert_eq!(
        [show("--camera front"), show("--camera 0")],
        [first.clone(), first.clone()]
    );
    assert_eq!(show("--camera 1"), wide);
    assert_ne!(first, wide);
}

#[test]
fn a_sun_asked_for_is_the_light_of_an_asset() {
    let folder = folder();
    let show = |words: &str| {
        let few = format!("{words} --size 8x8 --spp 4 --exposure 0");
        picture(folder.path(), &few)
    };
    let sunny = show("sunny.gltf");
    assert_eq!(show("square.gltf --sun 0,0,3,2"), sunny);
    assert_eq!(
        show("sunny.gltf --no-scene-lights --sun 0,0,1,2,2,2"),
        sunny
    );
    let one = values(folder.path(), "sunny.gltf --spp 4 --exposure 0");
    let two = values(
        folder.path(),
        "square.gltf --sun 0,0,1,0.5 --sun 0,0,1,1.5 --spp 4",
    );
    assert!(
        one.iter()
            .zip(&two)
            .all(|(one, two)| one.abs_diff(*two) <= 1),
        "suns add up: {one:?} {two:?}"
    );
}

#[test]
fn a_white_surface_under_an_even_sky_is_the_sky() {
    let folder = folder();
    let grey = 187;
    let even = values(
        folder.path(),
        "square.gltf --env-color 0.5 --spp 4 --tonemap srgb",
    );
    assert!(
        even.iter().all(|value| value.abs_diff(grey) <= 1),
        "{even:?}"
    );
    let sky = values(
        folder.path(),
        "square.gltf --env sky.hdr --spp 64 --tonemap srgb",
    );
    let mean = sky.iter().map(|value| f64::from(*value)).sum::<f64>() / sky.len() as f64;
    assert!((mean - f64::from(grey)).abs() < 2.0, "{mean}");
    let warm = values(
        folder.path(),
        "square.gltf --env-color 1,0.5,0 --spp 4 --tonemap srgb",
    );
    assert!(
        warm.chunks(3)
            .all(|pixel| pixel[0] >= 254 && pixel[1].abs_diff(grey) <= 1 && pixel[2] == 0),
        "{warm:?}"
    );
}

#[test]
fn what_has_no_light_stands_in_the_studio() {
    let folder = folder();
    let reported = |words: &str| {
        stderr(&rtc(
            folder.path(),
            &format!("render {words} --size 8x8 --spp 4 -v -o x.png"),
        ))
    };
    assert!(
        reported("square.gltf").contains("note[RD003]")
            && reported("sunny.gltf --no-scene-lights").contains("RD003")
    );
    for lit in [
        "sunny.gltf",
        "square.gltf --env-color 0",
        "square.gltf --sun 0,0,1,1",
        "square.gltf --env sky.hdr",
        "ball.yaml",
    ] {
        assert!(!reported(lit).contains("RD003"), "{lit}");
    }
    let dark = values(folder.path(), "square.gltf --env-color 0 --spp 4");
    assert!(dark.iter().all(|value| *value == 0));
    let studio = values(folder.path(), "square.gltf --spp 64 --tonemap srgb");
    assert!(
        studio.iter().all(|value| (40..250).contains(value)),
        "{studio:?}"
    );
    assert_eq!(
        code(&rtc(folder.path(), "compile square.gltf -o square.rtir")),
        0
    );
    assert_eq!(
        values(folder.path(), "square.rtir --spp 64 --tonemap srgb"),
        studio,
        "the studio is part of the IR"
    );
    assert_eq!(
        values(folder.path(), "square.rtir --spp 64"),
        values(folder.path(), "square.gltf --spp 64"),
        "and so is the tone map"
    );
}

#[test]
fn either_integrator_shows_either_kind_of_scene() {
    let folder = folder();
    let show = |words: &str| picture(folder.path(), &format!("{words} --size 12x8"));
    assert_eq!(show("ball.yaml --integrator whitted"), show("ball.yaml"));
    let paths = values(folder.path(), "ball.yaml --integrator path --spp 16");
    assert!(
        paths.iter().any(|value| *value > 100)
            && show("ball.yaml --integrator path") != show("ball.yaml")
    );
    let sun = "ball.yaml --sun 1,1,1,3";
    assert_eq!(
        show(sun),
        show(&format!("{sun} --integrator path")),
        "a sun is seen by paths"
    );
    assert_ne!(
        show(&format!("{sun} --integrator whitted")),
        show("ball.yaml"),
        "and by Whitted, if he is to"
    );
    for asset in ["square.gltf", "sunny.gltf"] {
        let middle =
            values(folder.path(), &format!("{asset} --integrator whitted"))[3 * (4 * 8 + 4)];
        assert!(middle > 100, "{asset}: {middle}");
    }
}

#[test]
fn a_turntable_is_so_many_pictures_all_around() {
    let folder = folder();
    let made = rtc(
        folder.path(),
        "render beside.yaml --turntable 3 --no-metadata -o out-%02d.png",
    );
    assert_eq!(
        (code(&made), stderr(&made).lines().count()),
        (0, 3),
        "{}",
        stderr(&made)
    );
    let frame = |number: u32| fs::read(folder.path().join(format!("out-0{number}.png"))).unwrap();
    assert_eq!(
        frame(1),
        picture(folder.path(), "beside.yaml"),
        "the first is the view of the scene"
    );
    assert!(frame(1) != frame(2) && frame(2) != frame(3) && frame(1) != frame(3));
    assert_eq!(
        code(&rtc(folder.path(), "render beside.yaml -q --turntable 1")),
        0
    );
    let made = ["beside-0001.png", "out-01.png", "out-02.png", "out-03.png"];
    let pictures: Vec<_> = names(folder.path())
        .into_iter()
        .filter(|name| !name.contains("gltf") && name.ends_with(".png"))
        .collect();
    assert_eq!(pictures, made);
}

#[test]
fn an_asset_that_a_scene_holds_looks_as_it_does_alone() {
    let folder = folder();
    let hold = |eye: &str, center: &str, rest: &str| {
        fs::write(folder.path().join("held.yaml"), holding(eye, center, rest)).unwrap();
        picture(folder.path(), "held.yaml --spp 4")
    };
    let view =
        "--eye 0,0,3 --center 0,0,0 --yfov 30 --size 24x16 --spp 4 --exposure 0 --tonemap srgb";
    let alone = |words: &str| picture(folder.path(), &format!("{words} {view}"));
    let square = "Objects:\n- {type: gltf, file: square.gltf}\n";
    let sun = "Lights:\n- {type: sun, direction: [0, 0, 1], irradiance: 2}\n";
    assert_eq!(
        hold("[0, 0, 3]", "[0, 0, 0]", &format!("{sun}{square}")),
        alone("square.gltf --sun 0,0,1,2")
    );
    let sky = "Environment: {file: sky.hdr}\n";
    assert_eq!(
        hold("[0, 0, 3]", "[0, 0, 0]", &format!("{sky}{square}")),
        alone("square.gltf --env sky.hdr")
    );
    let sunny = "Objects:\n- {type: gltf, file: sunny.gltf}\n";
    assert_eq!(
        hold("[0, 0, 3]", "[0, 0, 0]", sunny),
        alone("sunny.gltf"),
        "its lights count"
    );
    assert_eq!(
        hold("[0, 0, 3]", "[0, 0, 0]", square),
        alone("square.gltf"),
        "without light it stands in the studio"
    );
    let moved = "Objects:\n- {type: gltf, file: sunny.gltf, position: [4, 0, 0], scale: 2, rotation: [0, 1.5707963267948966, 0]}\n";
    let moved = decode(&hold("[10, 0, 0]", "[4, 0, 0]", moved))
        .unwrap()
        .bytes;
    let first = decode(&alone("sunny.gltf")).unwrap().bytes;
    assert!(
        moved
            .iter()
            .zip(&first)
            .filter(|(a, b)| a.abs_diff(**b) > 1)
            .count()
            < 30,
        "moved, turned and scaled alike"
    );
}

#[test]
fn an_angle_in_a_scene_is_that_of_the_command_line() {
    let folder = folder();
    let ball = course("[1, 2, 10]");
    let wide = ball
        .replace("up: [0, 0.5, 0]", "up: [0, 1, 0], fov: 50")
        .replace("[1, 2, 10]", "[7, 4, 8]");
    fs::write(folder.path().join("wide.yaml"), wide).unwrap();
    let expected = picture(
        folder.path(),
        "ball.yaml --eye 7,4,8 --center 1,2,0 --up 0,2,0 --yfov 50",
    );
    assert_eq!(picture(folder.path(), "wide.yaml"), expected);
    assert_eq!(
        picture(folder.path(), "ball.yaml --eye 7,4,8 --yfov 50"),
        expected
    );
}

/// The sky is bright towards −x; turned by a quarter about y it is bright towards the camera, or
/// away from it.
#[test]
fn an_environment_is_turned_as_a_shape_is() {
    let folder = folder();
    let sky = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n\x80\x80\x80\x81\x00\x00\x00\x00";
    fs::write(folder.path().join("half.hdr"), sky).unwrap();
    let front = |rotation: &str| {
        let ball = "{type: sphere, position: [0, 0, 0], radius: 1, material: {color: [1, 1, 1], ka: 0, kd: 1, ks: 0, n: 1}}";
        let rest =
            format!("Environment: {{file: half.hdr, rotation: {rotation}}}\nObjects:\n- {ball}\n");
        fs::write(
            folder.path().join("turned.yaml"),
            holding("[0, 0, 6]", "[0, 0, 0]", &rest),
        )
        .unwrap();
        values(folder.path(), "turned.yaml --spp 64")[3 * (4 * 8 + 4)]
    };
    let (bright, side, dark) = (
        front("[0, 1.5708, 0]"),
        front("[0, 0, 0]"),
        front("[0, -1.5708, 0]"),
    );
    assert!(
        bright > side + 20 && side > dark + 20,
        "{bright} {side} {dark}"
    );
}
