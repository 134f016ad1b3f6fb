//! The files a scene names: where they are looked for, what is refused, and what pictures and meshes become.

#![expect(
    clippy::unwrap_used,
    clippy::disallowed_methods,
    reason = "a test stops at the first surprise and makes the files it reads"
)]
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use image::{DynamicImage, ImageFormat, Rgb, RgbImage, Rgba, RgbaImage};
use proptest::prelude::*;
use rtc::diag::{Severity, Sink};
use rtc::front::{Asset, Options, Wanted, assets};
use rtc::ir::{Bump, Image, ImageId, Lowered, Material, Mesh, MeshId, Texture, TextureId};
use rtc::source::{Loader, SourceMap, Span};
use std::fs;
use std::io::Cursor;
use std::path::Path;
use tempfile::TempDir;

/// A scene with one image, one material that looks at it in every way, and one mesh; the text is where it is named.
fn lowered(map: &mut SourceMap) -> Lowered {
    let text = "Camera: {eye: [0, 0, 9], center: [0, 0, 0], up: [0, 1, 0], viewSize: [4, 4]}\nObjects:\n- {type: sphere, \
                position: [0, 0, 0], radius: 1, material: {color: [1, 0, 0], ka: 1, kd: 1, ks: 0, n: 1}}\n";
    let file = map.add("course", text.as_bytes().to_vec());
    let mut sink = Sink::default();
    let mut lowered = rtc::pipeline::load(file, map, &rtc::pipeline::Options::default(), &mut sink).unwrap();
    assert!(!sink.has_errors(), "{sink:?}");
    lowered.scene.images = vec![Image { name: "picture".to_owned(), width: 1, height: 1, pixels: "AAAA".to_owned() }];
    lowered.scene.textures = vec![Texture::Uv, Texture::Image(ImageId(0))];
    lowered.scene.meshes = vec![Mesh {
        name: "mesh".to_owned(),
        positions: Vec::new(),
        normals: Vec::new(),
        uvs: Vec::new(),
        triangles: Vec::new(),
    }];
    let Material::Phong(phong) = &mut lowered.scene.materials[0];
    phong.color_map = Some(TextureId(1));
    phong.specular_map = Some(TextureId(0));
    phong.bump = Some(Bump { texture: TextureId(1), height: 1.0 });
    lowered
}

/// What became of a wish.
struct Outcome {
    lowered: Lowered,
    /// `CODE severity place message`, each finding followed by its hints.
    findings: String,
    errors: bool,
}

fn bring(scene: &Path, asset: Asset, path: &str, options: &Options) -> Outcome {
    let mut map = SourceMap::default();
    let mut lowered = lowered(&mut map);
    let file = Loader.file(scene, &mut map).unwrap();
    let mut sink = Sink::default();
    let wanted = vec![Wanted { asset, path: path.to_owned(), span: Some(Span::new(file, 2, 5)) }];
    assets::bring(&mut lowered, wanted, file, options, &mut map, &mut sink);
    let mut findings = String::new();
    for finding in sink.kept() {
        let severity = match finding.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
            Severity::Note => "note",
        };
        let place = finding.primary.as_ref().map_or(String::new(), |label| {
            let at = map.line_column(label.span.file, label.span.start);
            let name = map.name(label.span.file).rsplit('/').next().unwrap().to_owned();
            format!("{name}:{}:{}", at.line, at.column)
        });
        findings.push_str(&format!("{} {severity} {place} {}\n", finding.code, finding.message));
        finding.hints.iter().for_each(|hint| findings.push_str(&format!("  {}\n", hint.text)));
    }
    Outcome { lowered, findings, errors: sink.has_errors() }
}

const IMAGE: Asset = Asset::Image(ImageId(0));
const MESH: Asset = Asset::Mesh(MeshId(0));

/// A folder with `inner/scene.yaml`; what a test needs beside it, it writes.
fn folder() -> TempDir {
    let folder = TempDir::new().unwrap();
    fs::create_dir(folder.path().join("inner")).unwrap();
    fs::write(folder.path().join("inner/scene.yaml"), "a: b.c\n").unwrap();
    folder
}

fn write(folder: &TempDir, path: &str, bytes: impl AsRef<[u8]>) {
    let path = folder.path().join(path);
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    fs::write(path, bytes).unwrap();
}

fn encoded(picture: &DynamicImage, format: ImageFormat) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    picture.write_to(&mut bytes, format).unwrap();
    bytes.into_inner()
}

/// A picture of one colour.
fn png(color: [u8; 3]) -> Vec<u8> {
    encoded(&RgbImage::from_pixel(2, 3, Rgb(color)).into(), ImageFormat::Png)
}

fn pixels(outcome: &Outcome) -> Vec<u8> {
    STANDARD.decode(&outcome.lowered.scene.images[0].pixels).unwrap()
}

/// Brings a picture named `path`, with these files around; the first byte of what was found, and the findings with the
/// folder called `F`.
fn found(files: &[(&str, u8)], path: &str, root: Option<&str>) -> (Option<u8>, String) {
    let folder = folder();
    for (name, grey) in files {
        write(&folder, name, png([*grey; 3]));
    }
    let options = Options { asset_root: root.map(|root| folder.path().join(root)), ..Options::default() };
    let path = path.replace("F/", &format!("{}/", folder.path().display()));
    let outcome = bring(&folder.path().join("inner/scene.yaml"), IMAGE, &path, &options);
    let findings = outcome.findings.replace(&folder.path().display().to_string(), "F");
    ((!outcome.errors).then(|| pixels(&outcome)[0]), findings)
}

#[test]
fn names_are_looked_for_beside_the_scene_and_then_above_it() {
    let both = [("inner/a.png", 1), ("a.png", 2)];
    assert_eq!(found(&both, "a.png", None), (Some(1), String::new()));
    assert_eq!(found(&both[1..], "a.png", None), (Some(2), String::new()));
    assert_eq!(found(&[("inner/t/a.png", 3)], "t\\a.png", None), (Some(3), String::new()));
    assert_eq!(found(&[("inner/t/a.png", 3)], "./x/../t/a.png", None), (Some(3), String::new()));
}

#[test]
fn names_of_other_places_are_replaced_by_their_tails_with_a_note() {
    let note =
        |written: &str, taken: &str| format!("RE003 note scene.yaml:1:3 `{written}` is taken from `F/{taken}`\n");
    let beside = [("inner/earth.png", 4)];
    for path in
        ["C:\\Users\\x\\earth.png", "/usr/share/earth.png", "../../earth.png", "textures/earth.png", "earth.png\t"]
    {
        let shown = path.escape_debug().to_string();
        assert_eq!(found(&beside, path, None), (Some(4), note(&shown, "inner/earth.png")), "{path}");
    }
    let deeper = [("maps/earth.png", 5), ("earth.png", 6)];
    assert_eq!(found(&deeper, "../maps/earth.png", None), (Some(5), note("../maps/earth.png", "maps/earth.png")));
    assert_eq!(found(&[("inner/Earth.PNG", 7)], "earth.png", None), (Some(7), note("earth.png", "inner/Earth.PNG")));
}

#[test]
fn what_is_not_there_is_told_with_the_places() {
    let absent = "RE001 error scene.yaml:1:3 there is no file `t/a.png`\n  looked for it at `F/inner/t/a.png`, `F/t/a.png`, \
                  `F/inner/a.png`, `F/a.png`\n";
    assert_eq!(found(&[], "t/a.png", None), (None, absent.to_owned()));
    let outside = "RE002 error scene.yaml:1:3 `/etc/a.png` leads out of the folder of the scene\n  looked for it at \
                   `F/inner/etc/a.png`, `F/etc/a.png`, `F/inner/a.png`, `F/a.png`\n  put the file beside the scene, or \
                   allow its folder by `--asset-root`\n";
    assert_eq!(found(&[], "/etc/a.png", None), (None, outside.to_owned()));
    assert_eq!(found(&[("other/a.png", 1)], "../other/../../a.png", None).0, None);
    for nothing in ["", " ", ".", "..", "/", "C:\\", "a\0b", "inner"] {
        assert!(found(&[], nothing, None).1.starts_with("RE00"), "{nothing:?}");
    }
}

#[test]
fn a_folder_the_user_allows_is_looked_in_too() {
    let files = [("other/a.png", 8)];
    assert_eq!(found(&files, "a.png", Some("other")), (Some(8), String::new()));
    assert_eq!(found(&files, "../other/a.png", Some("other")), (Some(8), String::new()));
    let (grey, note) = found(&files, "F/other/a.png", Some("other"));
    assert!(grey == Some(8) && note.starts_with("RE003 note"), "{note}");
    assert_eq!(found(&files, "../other/a.png", Some("inner")).1.lines().count(), 1, "by its tail, with a note");
}

#[cfg(unix)]
#[test]
fn links_that_leave_the_folder_and_what_is_no_file_are_refused() {
    let (folder, elsewhere) = (folder(), TempDir::new().unwrap());
    fs::write(elsewhere.path().join("a.png"), png([9; 3])).unwrap();
    std::os::unix::fs::symlink(elsewhere.path().join("a.png"), folder.path().join("inner/a.png")).unwrap();
    std::os::unix::fs::symlink(elsewhere.path(), folder.path().join("inner/away")).unwrap();
    std::os::unix::fs::symlink("real.png", folder.path().join("inner/within.png")).unwrap();
    std::os::unix::fs::symlink("/dev/zero", folder.path().join("inner/zero.png")).unwrap();
    write(&folder, "inner/real.png", png([3; 3]));
    let scene = folder.path().join("inner/scene.yaml");
    for path in ["a.png", "away/a.png"] {
        let outcome = bring(&scene, IMAGE, path, &Options::default());
        assert!(outcome.findings.starts_with("RE002 error"), "{path}: {}", outcome.findings);
    }
    for path in ["zero.png", "A.PNG"] {
        assert!(bring(&scene, IMAGE, path, &Options::default()).errors, "{path}");
    }
    let allowed = Options { asset_root: Some(elsewhere.path().to_owned()), ..Options::default() };
    assert_eq!(pixels(&bring(&scene, IMAGE, "a.png", &allowed))[0], 9);
    assert_eq!(pixels(&bring(&scene, IMAGE, "within.png", &Options::default()))[0], 3);
}

#[test]
fn a_scene_from_a_stream_has_only_the_folder_that_is_allowed() {
    let folder = folder();
    write(&folder, "a.png", png([5; 3]));
    for (root, expected) in [(None, None), (Some(folder.path().to_owned()), Some(5))] {
        let (mut map, mut sink) = (SourceMap::default(), Sink::default());
        let mut lowered = lowered(&mut map);
        let file = map.add("<stdin>", b"x".to_vec());
        let wanted = vec![Wanted { asset: IMAGE, path: "a.png".to_owned(), span: Some(Span::new(file, 0, 1)) }];
        let options = Options { asset_root: root, ..Options::default() };
        assets::bring(&mut lowered, wanted, file, &options, &mut map, &mut sink);
        let codes: Vec<_> = sink.kept().iter().map(|finding| finding.code.id).collect();
        assert_eq!(codes, if expected.is_none() { vec!["RE002"] } else { Vec::new() });
        assert_eq!(STANDARD.decode(&lowered.scene.images[0].pixels).unwrap()[0], expected.unwrap_or(0));
    }
}

#[test]
fn lenient_leaves_textures_and_objects_out_and_says_so() {
    let folder = folder();
    let scene = folder.path().join("inner/scene.yaml");
    let lenient = Options { lenient: true, ..Options::default() };
    let outcome = bring(&scene, IMAGE, "a.png", &lenient);
    let message = "RE001 warning scene.yaml:1:3 there is no file `a.png`; the texture is left out\n";
    assert!(outcome.findings.starts_with(message), "{}", outcome.findings);
    let Material::Phong(phong) = &outcome.lowered.scene.materials[0];
    assert_eq!((phong.color_map, phong.specular_map, &phong.bump), (None, Some(TextureId(0)), &None));
    write(&folder, "inner/cat.obj", "v 1 2 x\nv 1 2 y\n");
    let outcome = bring(&scene, MESH, "cat", &lenient);
    let expected = "RE006 warning cat.obj:1:7 `x` is not a number; the object is left out\n";
    assert!(outcome.findings.ends_with(expected) && !outcome.errors, "{}", outcome.findings);
}

/// Brings a picture of these bytes.
fn picture(bytes: &[u8]) -> Outcome {
    let folder = folder();
    write(&folder, "inner/picture", bytes);
    bring(&folder.path().join("inner/scene.yaml"), IMAGE, "picture", &Options::default())
}

#[test]
fn pictures_of_each_format_become_pixels_from_the_top() {
    let mut small = RgbaImage::from_pixel(2, 1, Rgba([10, 20, 30, 0]));
    small.put_pixel(1, 0, Rgba([200, 100, 50, 255]));
    let small = DynamicImage::from(small);
    let bytes = [10, 20, 30, 200, 100, 50];
    for format in [ImageFormat::Png, ImageFormat::WebP] {
        let outcome = picture(&encoded(&small, format));
        let image = &outcome.lowered.scene.images[0];
        assert_eq!((image.name.as_str(), image.width, image.height), ("picture", 2, 1), "{}", outcome.findings);
        assert_eq!(pixels(&outcome), bytes, "{format:?}");
    }
    let sixteen = picture(&encoded(&small.to_rgb16().into(), ImageFormat::Png));
    assert_eq!(pixels(&sixteen), bytes);
    let grey =
        picture(&encoded(&DynamicImage::from(image::GrayImage::from_pixel(1, 1, image::Luma([77]))), ImageFormat::Png));
    assert_eq!(pixels(&grey), [77; 3]);
    let plain = DynamicImage::from(RgbImage::from_pixel(8, 8, Rgb([180, 90, 60])));
    let jpeg = picture(&encoded(&plain, ImageFormat::Jpeg));
    let near = pixels(&jpeg).iter().zip([180_u8, 90, 60].iter().cycle()).all(|(a, b)| a.abs_diff(*b) <= 3);
    assert!(near && pixels(&jpeg).len() == 3 * 64, "{:?}", pixels(&jpeg));
}

/// The PNG with another width and height in its head, whose checksum is right.
fn with_size(png: &[u8], width: u32, height: u32) -> Vec<u8> {
    let mut bytes = png.to_vec();
    bytes[16..20].copy_from_slice(&width.to_be_bytes());
    bytes[20..24].copy_from_slice(&height.to_be_bytes());
    let crc = crc32fast::hash(&bytes[12..29]);
    bytes[29..33].copy_from_slice(&crc.to_be_bytes());
    bytes
}

#[test]
fn pictures_that_cannot_be_are_refused() {
    let good = png([1, 2, 3]);
    let cases = [
        (good[..good.len() - 20].to_vec(), "RE004", "is damaged: "),
        (b"no picture".to_vec(), "RE004", "is not a picture"),
        (Vec::new(), "RE004", "is not a picture"),
        (b"GIF89a\x01\x00\x01\x00".to_vec(), "RE004", "is a gif file"),
        (with_size(&good, 70_000, 70_000), "RE005", "has 70000 × 70000 pixels"),
        (with_size(&good, u32::MAX >> 1, u32::MAX >> 1), "RE00", ""),
        (with_size(&good, 0, 5), "RE004", "is damaged: "),
    ];
    for (bytes, code, words) in cases {
        let findings = picture(&bytes).findings;
        assert!(findings.starts_with(code) && findings.contains(words), "{words}: {findings}");
        assert!(findings.contains(" error scene.yaml:1:3 "), "{findings}");
    }
}

#[test]
fn only_bump_maps_that_hold_normals_become_normal_maps() {
    for (color, becomes) in
        [([128, 128, 255], true), ([190, 128, 235], true), ([128; 3], false), ([255; 3], false), ([150, 90, 40], false)]
    {
        let outcome = picture(&png(color));
        let Material::Phong(phong) = &outcome.lowered.scene.materials[0];
        let expected = if becomes { (Some(TextureId(1)), false) } else { (None, true) };
        assert_eq!((phong.normal_map, phong.bump.is_some()), expected, "{color:?}");
        assert_eq!(outcome.findings.starts_with("RE008 note"), becomes, "{}", outcome.findings);
    }
}

/// Brings a mesh file of this text.
fn mesh(text: impl AsRef<[u8]>) -> Outcome {
    let folder = folder();
    write(&folder, "inner/m.obj", text);
    bring(&folder.path().join("inner/scene.yaml"), MESH, "m.obj", &Options::default())
}

#[test]
fn obj_files_become_triangles() {
    let text = "# caf\u{e9}\no cube\nmtllib none.mtl\nv 0 0 0\nv 1 0 0 1\nv 1 1 0 0.5 0.5 0.5\ng half\nv 0 0.1 0\nusemtl red\n\
                f 1 2 \\\n 3 -1\ns 1\ng other\nf -4 -2 -1\n";
    let latin1: Vec<u8> = text.chars().map(|c| c as u8).collect();
    for bytes in [text.as_bytes(), &latin1, text.replace('\n', "\r\n").as_bytes()] {
        let Outcome { lowered, findings, .. } = mesh(bytes);
        assert_eq!(findings, "");
        let mesh = &lowered.scene.meshes[0];
        assert_eq!(mesh.positions, [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 0.1, 0.0]]);
        assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3], [0, 2, 3]]);
        assert_eq!((mesh.name.as_str(), mesh.normals.len(), mesh.uvs.len()), ("mesh", 0, 0));
    }
}

#[test]
fn normals_and_uvs_stay_with_their_corners() {
    let corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0.25 0.75 0\nvt 0.5\nvn 0 0 1\nvn 1 0 0\n";
    let all = mesh(format!("{corners}f 1/1/1 2/2/1 3/1/2\nf 1/1/2 2/2/1 3/1/2\n")).lowered.scene.meshes.remove(0);
    assert_eq!(all.positions.len(), 4, "one corner has two normals");
    assert_eq!(all.uvs, [[0.25, 0.75], [0.5, 0.0], [0.25, 0.75], [0.25, 0.75]]);
    assert_eq!(all.normals, [[0.0, 0.0, 1.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [1.0, 0.0, 0.0]]);
    let some = mesh(format!("{corners}f 1//1 2//1 3//2\nf 1 2 3\n")).lowered.scene.meshes.remove(0);
    assert_eq!((some.positions.len(), some.normals.len(), some.uvs.len()), (6, 6, 0));
    assert_eq!(some.normals[3..], [[0.0; 3]; 3], "flat where the file says nothing");
}

#[test]
fn off_files_become_triangles() {
    let body = "4 2 0\n0 0 0\n1 0 0 # corner\n1 1 0\n0 1 0\n\n4 0 1 2 3 255 0 0\n3 0 2 3\n";
    for text in [
        format!("OFF\n{body}"),
        format!("# first\nOFF {body}"),
        format!("COFF\n{}", body.replace("1 1 0", "1 1 0 9 9 9 1")),
    ] {
        let Outcome { lowered, findings, .. } = mesh(&text);
        assert_eq!(findings, "", "{text}");
        let mesh = &lowered.scene.meshes[0];
        assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3], [0, 2, 3]]);
        assert_eq!((mesh.positions[2], mesh.positions.len()), ([1.0, 1.0, 0.0], 4));
    }
    let normals = mesh("NOFF\n3 1 0\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 1 0 0\n3 0 1 2\n").lowered.scene.meshes.remove(0);
    assert_eq!(normals.normals, [[0.0, 0.0, 1.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]);
}

#[test]
fn faults_of_mesh_files_have_their_place_there() {
    let corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    let cases = [
        ("v 0 0\n".to_owned(), "m.obj:1:1 2 numbers where there should be 3"),
        ("v 0 nan 0\n".to_owned(), "m.obj:1:5 `nan` is not a finite number"),
        ("v 0 1e999 0\n".to_owned(), "m.obj:1:5 `1e999` is not a finite number"),
        ("v 0 1,5 0\n".to_owned(), "m.obj:1:5 `1,5` is not a number"),
        (format!("{corners}f 1 2 4\n"), "m.obj:4:7 a face refers to vertex 4, and the file has 3"),
        (format!("{corners}f 1 2 0\n"), "m.obj:4:7 a face refers to vertex 0, and the file has 3"),
        (format!("{corners}f 1 2 -4\n"), "m.obj:4:7 a face refers to vertex -4, and 3 stand before it"),
        (format!("{corners}f 1/1 2 3\n"), "m.obj:4:5 a face refers to texture coordinate 1, and the file has 0"),
        (format!("{corners}f 1//-9223372036854775808 2 3\n"), "m.obj:4:6 a face refers to normal"),
        (format!("{corners}f 1///4 2 3\n"), "m.obj:4:3 `1///4` has more than three parts"),
        (format!("{corners}f /1 2 3\n"), "m.obj:4:3 the corner `/1` has no vertex"),
        (format!("{corners}f a b c\n"), "m.obj:4:3 `a` is not a whole number"),
        (corners.to_owned(), "m.obj:1:1 the mesh has no faces"),
        (String::new(), "m.obj:1:1 the mesh file is empty"),
        ("OFF\n3 1 0\n0 0 0\n".to_owned(), "m.obj:2:1 the file ends before the last of 3 vertices"),
        ("OFF\n99999999999999 1 0\n0 0 0\n".to_owned(), "m.obj:2:1 the file ends before the last of 99999999999999"),
        ("OFF\n-1 1 0\n".to_owned(), "m.obj:2:1 there can't be -1 vertices"),
        ("OFF\n3\n".to_owned(), "m.obj:1:1 the number of faces is missing"),
        ("OFF BINARY\n".to_owned(), "m.obj:1:5 binary OFF is not supported"),
        ("4OFF\n".to_owned(), "m.obj:1:1 `4OFF` is a kind of OFF that is not supported"),
        ("OFF\n1 1 0\n0 0 0\n3 0 0 1\n".to_owned(), "m.obj:4:7 a face refers to vertex 1, and there are 1, from 0"),
        ("OFF\n1 1 0\n0 0 0\n4 0 0 0\n".to_owned(), "m.obj:4:1 a face of 4 corners names 3"),
    ];
    for (text, expected) in cases {
        let findings = mesh(&text).findings;
        assert!(findings.starts_with(&format!("RE006 error {expected}")), "{text}: {findings}");
    }
}

#[test]
fn what_does_not_show_is_told() {
    let outcome = mesh("v 0 0 0\nv 1 0 0\nv 0 1 0\nl 1 2\nf 1 2\nf 1 2 3\n");
    let expected = "RE007 warning m.obj:4:1 2 elements of this file don't show: lines and points have no surface\n";
    assert_eq!((outcome.findings.as_str(), outcome.lowered.scene.meshes[0].triangles.len()), (expected, 1));
}

/// Words that mesh files are made of, whole and broken.
fn hostile() -> impl Strategy<Value = String> {
    let word = prop::sample::select(vec![
        "v",
        "vn",
        "vt",
        "f",
        "l",
        "g",
        "usemtl",
        "mtllib",
        "OFF",
        "NOFF",
        "#",
        "\\",
        "\n",
        "\n",
        "\r\n",
        "0",
        "1",
        "2",
        "3",
        "-1",
        "-2",
        "1/1",
        "1//1",
        "1/1/1",
        "-1/-9",
        "/",
        "//",
        "4",
        "1e308",
        "-1e308",
        "inf",
        "1e-320",
        "0x1",
        "18446744073709551615",
        "9223372036854775807",
        "-9223372036854775808",
        "é",
        "\0",
        "surf",
    ]);
    prop::collection::vec(word, 0..60).prop_map(|words| words.join(" "))
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, cases: 500, ..ProptestConfig::default() })]

    #[test]
    fn any_bytes_are_a_sound_mesh_or_an_error(
        head in prop::sample::select(vec!["", "OFF\n", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"]),
        words in hostile(),
        bytes: Vec<u8>,
        mixed in prop::bool::ANY,
    ) {
        let text = if mixed { [head.as_bytes(), words.as_bytes()].concat() } else { bytes };
        let Outcome { mut lowered, findings: _, errors } = mesh(text);
        let Mesh { name: _, positions, normals, uvs, triangles } = lowered.scene.meshes.remove(0);
        prop_assert_eq!(triangles.is_empty(), errors);
        let count = positions.len();
        prop_assert!(triangles.iter().flatten().all(|corner| (*corner as usize) < count));
        prop_assert!([normals.len(), uvs.len()].iter().all(|length| *length == 0 || *length == count));
        prop_assert!(positions.iter().flatten().all(|value| value.is_finite()));
    }
}
