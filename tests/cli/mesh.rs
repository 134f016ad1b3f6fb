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
