//! A mesh given by itself: checked, rendered, measured and compiled as an asset is.

use super::*;

/// A square of 2 × 2 at the origin that faces +z.
const SQUARE: &str = "solid\nfacet normal 0 0 1\nouter loop\nvertex -1 -1 0\nvertex 1 -1 0\nvertex 1 1 0\nendloop\nendfacet\n\
                      facet normal 0 0 1\nouter loop\nvertex -1 -1 0\nvertex 1 1 0\nvertex -1 1 0\nendloop\nendfacet\nendsolid\n";

#[test]
fn a_mesh_is_seen_and_lit_without_a_flag() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("square.stl"), SQUARE).unwrap();
    let checked = rtc(&folder, &["check", "square.stl"]);
    assert_eq!((code(&checked), stderr(&checked)), (0, String::new()));
    let few = [
        "render",
        "square.stl",
        "-q",
        "--size",
        "40x20",
        "--spp",
        "4",
        "-o",
        "x.png",
    ];
    let rendered = rtc(&folder, &[&few[..], &["--orbit", "0,0"]].concat());
    assert_eq!(code(&rendered), 0, "{}", stderr(&rendered));
    let picture = image::open(folder.path().join("x.png")).unwrap().to_rgb8();
    // The square spans 85 % of the rows, in the middle of a wide picture, and is lit by the studio.
    let [middle, aside] = [[20, 10], [2, 10]].map(|[x, y]| picture.get_pixel(x, y).0);
    assert!(
        middle.iter().all(|channel| (60..250).contains(channel)),
        "{middle:?}"
    );
    assert!(
        aside.iter().zip(middle).any(|(a, b)| a.abs_diff(b) > 20),
        "{aside:?} {middle:?}"
    );
    let compiled = rtc(&folder, &["compile", "square.stl", "-o", "square.rtir"]);
    assert_eq!(code(&compiled), 0, "{}", stderr(&compiled));
}

/// A wedge that stands on z = 0, off the plane y = 0.
const WEDGE: &str = "v 0 1 0\nv 3 1 0\nv 0 2 0\nv 0 1 4\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";

#[test]
fn a_mesh_with_z_upwards_is_noted_and_turned() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("wedge.obj"), WEDGE).unwrap();
    let noted = |args: &[&str]| {
        let checked = rtc(&folder, &[&["check", "wedge.obj"], args].concat());
        assert_eq!(code(&checked), 0, "{}", stderr(&checked));
        stderr(&checked).contains("warning[RD013]")
    };
    assert!(noted(&[]));
    assert!(!noted(&["--up-axis", "y"]) && !noted(&["--up-axis", "z"]));
    let bounds = |args: &[&str]| {
        let told = rtc(
            &folder,
            &[&["info", "--format", "json", "wedge.obj"], args].concat(),
        );
        let told: serde_json::Value = serde_json::from_slice(&told.stdout).unwrap();
        told["bounds"].clone()
    };
    let turned = serde_json::json!({"low": [0.0, 0.0, -2.0], "high": [3.0, 4.0, -1.0]});
    assert_eq!(bounds(&["--up-axis", "z"]), turned);
    fs::write(folder.path().join("rtc.toml"), "up-axis = \"z\"\n").unwrap();
    assert_eq!(bounds(&[]), turned, "the project says so");
    assert_ne!(
        bounds(&["--up-axis", "y"]),
        turned,
        "the command line decides"
    );
    // glTF, whose nodes are turned; a scene text is not.
    let compiled = rtc(
        &folder,
        &[
            "compile",
            "wedge.obj",
            "--up-axis",
            "y",
            "--ground",
            "off",
            "-o",
            "wedge.glb",
        ],
    );
    assert_eq!(code(&compiled), 0, "{}", stderr(&compiled));
    let told = rtc(&folder, &["info", "--format", "json", "wedge.glb"]);
    let told: serde_json::Value = serde_json::from_slice(&told.stdout).unwrap();
    assert_eq!(told["bounds"], turned);
}

/// A stored hierarchy changes no picture and no other file.
#[test]
fn a_stored_hierarchy_is_only_a_hierarchy() {
    let folder = tempfile::tempdir().unwrap();
    let mut grid = String::new();
    for index in 0..100 {
        let (x, y) = (f64::from(index % 10), f64::from(index / 10));
        grid += &format!("v {x} {y} {}\n", (x * 0.7).sin() + (y * 0.9).cos());
    }
    for at in (1..90).filter(|at| at % 10 != 0) {
        grid += &format!("f {} {} {} {}\n", at, at + 1, at + 11, at + 10);
    }
    fs::write(folder.path().join("grid.obj"), grid).unwrap();
    let run = |args: &[&str]| {
        let output = rtc(&folder, args);
        assert_eq!(code(&output), 0, "{args:?}: {}", stderr(&output));
    };
    let bytes = |name: &str| fs::read(folder.path().join(name)).unwrap();
    run(&["compile", "grid.obj", "-o", "plain.rtir"]);
    run(&["compile", "grid.obj", "-o", "tree.rtir", "--with-bvh"]);
    assert!(bytes("tree.rtir").len() > bytes("plain.rtir").len() + 600);
    for scene in ["plain", "tree"] {
        let (file, picture) = (format!("{scene}.rtir"), format!("{scene}.png"));
        run(&[
            "render", &file, "-o", &picture, "--size", "48x48", "--spp", "4",
        ]);
        run(&["compile", &file, "-o", &format!("{scene}.json")]);
        run(&["compile", &file, "-o", "again.rtir"]);
        assert!(bytes("again.rtir") == bytes("plain.rtir"), "{scene}");
    }
    assert!(bytes("plain.png") == bytes("tree.png"));
    assert!(bytes("plain.json") == bytes("tree.json"));
    let refused = rtc(
        &folder,
        &["compile", "grid.obj", "-o", "x.glb", "--with-bvh"],
    );
    assert_ne!(code(&refused), 0);
    assert!(stderr(&refused).contains("name the output .rtir"));
}

/// What is told of a file by `check`, without and with `--lenient`, and the exit codes.
fn checked(name: &str, bytes: &[u8]) -> [(i32, String); 2] {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join(name), bytes).unwrap();
    [&["check", name][..], &["check", name, "--lenient"]].map(|args| {
        let output = rtc(&folder, args);
        (code(&output), stderr(&output))
    })
}

/// A binary STL of two triangles that says it has `count`.
fn stl(count: u32) -> Vec<u8> {
    let mut bytes = vec![b' '; 80];
    bytes.extend(count.to_le_bytes());
    for corner in [[1.0_f32, 1.0], [-1.0, -2.0]] {
        let corners = [[0.0, 0.0], [1.0, -1.0], corner];
        let numbers = corners.into_iter().flat_map(|[x, y]| [x, y, 0.0]);
        let numbers = [0.0, 0.0, 1.0].into_iter().chain(numbers);
        bytes.extend(numbers.flat_map(f32::to_le_bytes));
        bytes.extend([0; 2]);
    }
    bytes
}

#[test]
fn what_other_readers_repair_is_read_leniently_with_a_warning() {
    const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
    let cases: [(&str, Vec<u8>, &str); 7] = [
        (
            "x.obj",
            format!("{SQUARE}f 1//1 2//2 3//3 4//4\n").into(),
            "the corner is without it",
        ),
        (
            "x.obj",
            format!("{SQUARE}vt 0 0\nf 1/1 2/2 3/3\n").into(),
            "the corner is without it",
        ),
        ("x.stl", stl(5), "all are read"),
        ("x.stl", stl(0), "all are read"),
        (
            "x.xyz",
            b"0,0,0\n1,0,0\n0;1;0\n".to_vec(),
            "they are read as spaces",
        ),
        (
            "x.xyz",
            b"X Y Z\n0 0 0\n1 0 0\n0 1 0\n".to_vec(),
            "it is skipped",
        ),
        (
            "x.xyz",
            b"3\n0 0 0\n1 0 0\n0 1 0\n".to_vec(),
            "it is skipped",
        ),
    ];
    for (name, bytes, repair) in cases {
        let [strict, lenient] = checked(name, &bytes);
        let hint = format!("with `--lenient` this is a warning: {repair}");
        assert!(strict.0 == 1 && strict.1.contains(&hint), "{strict:?}");
        let is_told = lenient.1.contains("warning[RE006]") && lenient.1.contains(repair);
        assert!(lenient.0 == 0 && is_told, "{lenient:?}");
    }
    // A sound file is told nothing, and of one with more triangles than it says the rest is told.
    let [sound, _] = checked("x.stl", &stl(2));
    assert_eq!(sound, (0, String::new()));
    let [more, lenient] = checked("x.stl", &stl(1));
    assert!(more.0 == 0 && more.1.contains("warning[RE007]"), "{more:?}");
    assert!(lenient.1.contains("all are read"), "{lenient:?}");
    // A vertex that is not there stays an error.
    let [_, lenient] = checked("x.obj", format!("{SQUARE}f 7 8 9\n").as_bytes());
    assert_eq!(lenient.0, 1, "{lenient:?}");
}

/// A PLY of three vertices with more properties.
fn ply(properties: &[(&str, [f64; 3])]) -> Vec<u8> {
    let corners = [
        ("x", [0.0, 1.0, 0.0]),
        ("y", [0.0, 0.0, 1.0]),
        ("z", [0.0; 3]),
    ];
    let all = corners.iter().chain(properties);
    let head: String = all
        .clone()
        .map(|(name, _)| format!("property float {name}\n"))
        .collect();
    let row = |at: usize| {
        let row: Vec<String> = all
            .clone()
            .map(|(_, values)| values[at].to_string())
            .collect();
        row.join(" ") + "\n"
    };
    let rows: String = (0..3).map(row).collect();
    format!("ply\nformat ascii 1.0\nelement vertex 3\n{head}end_header\n{rows}").into_bytes()
}

#[test]
fn properties_of_a_ply_that_are_not_read_are_told() {
    let told = |properties: &[&str]| {
        let properties: Vec<_> = properties.iter().map(|name| (*name, [0.5; 3])).collect();
        checked("x.ply", &ply(&properties))[0].1.clone()
    };
    for sound in [
        &[][..],
        &["nx", "ny", "nz", "red", "green", "blue", "alpha"],
    ] {
        assert_eq!(told(sound), "");
    }
    assert!(told(&["radius", "intensity"]).contains("are not read: `radius`, `intensity`"));
    // A part of a colour is none.
    assert!(told(&["red", "alpha"]).contains("are not read: `red`, `alpha`"));
    let many: Vec<String> = (0..9).map(|at| format!("scalar_{at}")).collect();
    let many: Vec<&str> = many.iter().map(String::as_str).collect();
    assert!(told(&many).contains("`scalar_5` and 3 more"));
}

#[test]
fn splats_of_a_ply_are_ellipsoids_of_their_colours() {
    // Red, green and blue, small, opaque.
    let color = |channel: usize| {
        let mut color = [-1.7; 3];
        color[channel] = 1.7;
        color
    };
    let [red, green, blue] = [0, 1, 2].map(color);
    let splat = [
        ("f_dc_0", red),
        ("f_dc_1", green),
        ("f_dc_2", blue),
        ("f_rest_0", [0.1; 3]),
        ("opacity", [9.0; 3]),
        ("scale_0", [-1.6; 3]),
        ("scale_1", [-1.6; 3]),
        ("scale_2", [-1.6; 3]),
        ("rot_0", [1.0; 3]),
        ("rot_1", [0.0; 3]),
        ("rot_2", [0.0; 3]),
        ("rot_3", [0.0; 3]),
    ];
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("x.ply"), ply(&splat)).unwrap();
    let words = [
        "render", "x.ply", "-o", "x.png", "--size", "64x64", "--orbit", "0,0",
    ];
    let output = rtc(&folder, &words);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    assert!(stderr(&output).contains("opaque ellipsoids of one colour"));
    assert!(!stderr(&output).contains("f_rest_0"));
    let picture = image::open(folder.path().join("x.png")).unwrap().to_rgb8();
    for channel in 0..3 {
        let is_pure = |pixel: &&image::Rgb<u8>| {
            let others = (0..3).filter(|other| *other != channel);
            pixel.0[channel] > 200 && others.into_iter().all(|other| pixel.0[other] < 60)
        };
        let count = picture.pixels().filter(is_pure).count();
        assert!(count > 50, "{channel}: {count}");
    }
}
