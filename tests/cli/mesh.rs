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
