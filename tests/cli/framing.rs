//! The view of an asset without a camera of its own, and of one with another shape of picture.

use super::*;

/// A card of 2 × 2 at the origin that faces +z, without a camera; cut from a case with one.
fn card(cameras: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let positions: [f32; 12] = [-1., -1., 0., 1., -1., 0., 1., 1., 0., -1., 1., 0.];
    let mut bytes: Vec<u8> = positions.iter().flat_map(|v| v.to_le_bytes()).collect();
    bytes.extend([0_u16, 1, 2, 0, 2, 3].iter().flat_map(|v| v.to_le_bytes()));
    fs::write(folder.path().join("card.bin"), bytes).unwrap();
    let asset = format!(
        r#"{{"asset": {{"version": "2.0"}}, "scene": 0,
        "buffers": [{{"uri": "card.bin", "byteLength": 60}}],
        "bufferViews": [{{"buffer": 0, "byteLength": 48}}, {{"buffer": 0, "byteOffset": 48, "byteLength": 12}}],
        "accessors": [{{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 4, "min": [-1, -1, 0], "max": [1, 1, 0]}},
          {{"bufferView": 1, "componentType": 5123, "type": "SCALAR", "count": 6}}],
        "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}, "indices": 1}}]}}], {cameras}}}"#
    );
    fs::write(folder.path().join("card.gltf"), asset).unwrap();
    folder
}

/// How many columns and rows of the picture the card is in, of how many.
fn spans(folder: &TempDir, args: &[&str]) -> ([u32; 2], [u32; 2]) {
    let few = [
        "render",
        "card.gltf",
        "-q",
        "--spp",
        "1",
        "--background",
        "transparent",
        "-o",
        "x.png",
    ];
    let output = rtc(folder, &[&few, args].concat());
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let picture = image::open(folder.path().join("x.png")).unwrap().to_rgba8();
    let (width, height) = picture.dimensions();
    let is_card = |x: u32, y: u32| picture.get_pixel(x, y)[3] > 0;
    let columns = (0..width)
        .filter(|x| (0..height).any(|y| is_card(*x, y)))
        .count();
    let rows = (0..height)
        .filter(|y| (0..width).any(|x| is_card(x, *y)))
        .count();
    ([columns, rows].map(|count| count as u32), [width, height])
}

const ALONE: &str = r#""nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}]"#;
/// Its own camera is 4 away and sees from −1 to 1 at that distance, twice as wide as high.
const SEEN: &str = r#""cameras": [{"type": "perspective", "perspective": {"yfov": 0.4899573, "aspectRatio": 2, "znear": 0.1}}],
    "nodes": [{"mesh": 0}, {"camera": 0, "translation": [0, 0, 4]}], "scenes": [{"nodes": [0, 1]}]"#;

#[test]
fn an_asset_without_a_camera_spans_85_percent_of_the_picture() {
    let folder = card(ALONE);
    for args in [
        &["--size", "64x64"][..],
        &["--size", "120x40"],
        &["--size", "40x120", "--yfov", "80"],
        &["--size", "64x64", "--orbit", "-60,-30,20"],
    ] {
        let (spans, size) = spans(&folder, args);
        let share = |k: usize| f64::from(spans[k]) / f64::from(size[k]);
        let longer = share(0).max(share(1));
        assert!((0.8..0.9).contains(&longer), "{args:?}: {longer}");
    }
    // From the front it is a square.
    let (front, _) = spans(&folder, &["--size", "64x64", "--orbit", "0,0"]);
    assert_eq!(front[0], front[1]);
}

#[test]
fn the_view_of_a_camera_is_never_cropped_by_another_size() {
    let folder = card(SEEN);
    let (own, _) = spans(&folder, &["--size", "64x32"]);
    assert_eq!(own, [32, 32], "the card fills the height of its view");
    assert_eq!(
        spans(&folder, &["--size", "32x32"]).0,
        [16, 16],
        "no narrower"
    );
    assert_eq!(
        spans(&folder, &["--size", "96x32"]).0,
        [32, 32],
        "but wider"
    );
    // Asked for, all of it is framed in the angle of its camera.
    let (framed, _) = spans(&folder, &["--size", "64x64", "--orbit", "0,0"]);
    assert!((51..58).contains(&framed[0]), "{framed:?}");
}

#[test]
fn a_picture_of_another_shape_than_the_camera_sees_is_told() {
    let folder = card(SEEN);
    let reported = |size: &str| {
        let args = [
            "render",
            "card.gltf",
            "-v",
            "--spp",
            "1",
            "-o",
            "x.png",
            "--size",
            size,
        ];
        stderr(&rtc(&folder, &args))
    };
    assert!(reported("64x64").contains("more is shown above and below"));
    assert!(reported("64x16").contains("more is shown left and right"));
    assert!(!reported("64x32").contains("RD010"));
}

#[test]
fn an_orbit_is_two_or_three_angles_and_stands_for_the_eye() {
    let folder = card(ALONE);
    for args in [
        "--orbit 1",
        "--orbit 1,91",
        "--orbit a,b",
        "--orbit 1,2 --eye 1,2,3",
    ] {
        let words: Vec<&str> = args.split(' ').collect();
        let output = rtc(&folder, &[&["render", "card.gltf"], &words[..]].concat());
        assert_eq!(code(&output), 2, "{args}");
    }
}
