//! `rtc compile -o scene.glb`: written by its extension, sound, and told of with `-v`.

use super::*;

#[test]
fn a_scene_becomes_an_asset_that_shows_the_same() {
    let folder = folder();
    let written = rtc(&folder, &["compile", "ball.json", "-o", "ball.glb", "-v"]);
    let reported = stderr(&written);
    assert_eq!(code(&written), 0, "{reported}");
    for part in ["GL050", "GL051", "within 0.001 of its radius", "a square"] {
        assert!(reported.contains(part), "{part} is missing: {reported}");
    }
    let checked = rtc(&folder, &["check", "ball.glb"]);
    assert_eq!((code(&checked), stderr(&checked)), (0, String::new()));
    let picture = |name: &str| {
        let rendered = rtc(&folder, &["render", name, "-q", "-o", "x.png"]);
        assert_eq!(code(&rendered), 0, "{}", stderr(&rendered));
        image::open(folder.path().join("x.png")).unwrap().to_rgb8()
    };
    let (before, after) = (picture("ball.json"), picture("ball.glb"));
    let pairs = || before.pixels().zip(after.pixels());
    let off = pairs().filter(|(a, b)| (0..3).any(|at| a[at].abs_diff(b[at]) > 8));
    // A mesh is not quite round, and the ball mirrors where the wall ends.
    assert!(
        before.dimensions() == after.dimensions() && off.count() <= 40 * 30 / 20,
        "more than 5 % of the pixels differ"
    );
}

#[test]
fn a_finer_tolerance_takes_more_triangles_and_is_about_meshes_alone() {
    let folder = folder();
    let size = |tolerance: &str| {
        let asked = ["compile", "ball.json", "-q", "-o", "ball.glb"];
        let written = rtc(&folder, &[&asked[..], &["--tolerance", tolerance]].concat());
        assert_eq!(code(&written), 0, "{}", stderr(&written));
        fs::metadata(folder.path().join("ball.glb")).unwrap().len()
    };
    assert!(size("0.01") > 5 * size("0.1"));
    for (arguments, exit) in [
        ("compile ball.json -o x.glb --tolerance 0", 2),
        ("compile ball.json -o x.yaml --tolerance 1", 2),
        ("compile ball.json -o x.glb --tolerance 1e-12", 1),
    ] {
        let arguments: Vec<_> = arguments.split(' ').collect();
        let refused = rtc(&folder, &arguments);
        assert_eq!(code(&refused), exit, "{}", stderr(&refused));
    }
    assert!(!folder.path().join("x.glb").exists());
}

#[test]
fn a_text_has_its_vertices_beside_it_and_says_the_same() {
    let folder = folder();
    for target in ["ball.glb", "ball.gltf"] {
        let written = rtc(&folder, &["compile", "ball.json", "-q", "-o", target]);
        assert_eq!(code(&written), 0, "{}", stderr(&written));
    }
    let ir = |name: &str| rtc(&folder, &["compile", name, "-q", "-o", "-"]).stdout;
    assert!(!ir("ball.gltf").is_empty() && ir("ball.gltf") == ir("ball.glb"));
    let beside = fs::read_dir(folder.path().join("ball.files")).unwrap();
    assert_eq!(beside.count(), 1, "the buffer");
    let nowhere = rtc(&folder, &["compile", "ball.json", "-q", "--emit", "gltf"]);
    assert_eq!((code(&nowhere), nowhere.stdout.len()), (1, 0));
    assert!(
        stderr(&nowhere).contains("give `-o FILE`"),
        "{}",
        stderr(&nowhere)
    );
}
