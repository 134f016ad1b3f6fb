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
