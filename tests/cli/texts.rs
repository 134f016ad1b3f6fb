//! Assets compiled to scene texts: the same picture without the asset, and files that appear whole,
//! over nobody's, or not at all.

use super::studio::LEAF;
use super::*;

/// A folder with an asset, and a light for it.
fn holding() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    fs::copy(
        root.join("tests/gltf/assets/pirate.glb"),
        folder.path().join("pirate.glb"),
    )
    .unwrap();
    folder
}

fn picture(folder: &TempDir, scene: &str) -> Vec<u8> {
    // What made it differs: of a text and an asset the pixels are to be alike.
    let args = format!("render -q {scene} --size 24x24 --spp 2 --no-metadata -o -");
    let output = rtc(folder, &args.split(' ').collect::<Vec<_>>());
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    output.stdout
}

fn compile(folder: &TempDir, args: &[&str]) -> Output {
    rtc(folder, &[&["compile", "-q", "pirate.glb"], args].concat())
}

#[test]
fn the_text_gives_the_picture_of_the_asset_without_it() {
    let folder = holding();
    let before = picture(&folder, "pirate.glb");
    let compiled = compile(&folder, &["-o", "text.yaml"]);
    assert_eq!(code(&compiled), 0, "{}", stderr(&compiled));
    assert_eq!(
        names(folder.path()),
        ["pirate.glb", "text.files", "text.yaml"]
    );
    fs::remove_file(folder.path().join("pirate.glb")).unwrap();
    assert_eq!(
        picture(&folder, "text.yaml"),
        before,
        "with its own tone map, in the studio"
    );
}

#[test]
fn the_exposure_and_the_light_of_a_lit_asset_are_written() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("asset.gltf"), LEAF).unwrap();
    let before = picture(&folder, "asset.gltf");
    let compiled = rtc(&folder, &["compile", "asset.gltf", "-o", "text.yaml"]);
    assert_eq!(code(&compiled), 0, "{}", stderr(&compiled));
    fs::remove_file(folder.path().join("asset.gltf")).unwrap();
    let text = fs::read_to_string(folder.path().join("text.yaml")).unwrap();
    assert!(
        text.contains("ToneMap: pbr-neutral") && text.contains("Lights:"),
        "{text}"
    );
    assert_eq!(picture(&folder, "text.yaml"), before);
}

#[test]
fn compiled_again_nothing_changes_and_nobody_loses_a_file() {
    let folder = holding();
    let all = |path: &Path| {
        let mut files: Vec<_> = names(path);
        files.sort();
        let bytes = |name: &String| fs::read(path.join(name)).unwrap();
        files.iter().map(bytes).collect::<Vec<_>>()
    };
    assert_eq!(code(&compile(&folder, &["-o", "x.yaml"])), 0);
    let files = folder.path().join("x.files");
    let (text, before) = (fs::read(folder.path().join("x.yaml")).unwrap(), all(&files));
    assert_eq!(code(&compile(&folder, &["-o", "x.yaml"])), 0);
    assert_eq!(fs::read(folder.path().join("x.yaml")).unwrap(), text);
    assert_eq!(all(&files), before);
    // Somebody else's file of that name.
    let first = files.join(names(&files).remove(0));
    fs::write(&first, "mine").unwrap();
    fs::remove_file(folder.path().join("x.yaml")).unwrap();
    let refused = compile(&folder, &["-o", "x.yaml"]);
    assert!(code(&refused) == 2 && stderr(&refused).contains("something else of this name"));
    assert_eq!(fs::read(&first).unwrap(), b"mine");
    assert!(!folder.path().join("x.yaml").exists());
}

#[test]
fn what_fails_leaves_no_file() {
    let folder = holding();
    fs::write(folder.path().join("y.files"), "no folder").unwrap();
    let refused = compile(&folder, &["-o", "y.yaml"]);
    assert_eq!(code(&refused), 2, "{}", stderr(&refused));
    let refused = compile(&folder, &["--emit", "yaml"]);
    assert!(code(&refused) != 0 && refused.stdout.is_empty());
    assert!(stderr(&refused).contains("-o FILE"), "{}", stderr(&refused));
    assert_eq!(names(folder.path()), ["pirate.glb", "y.files"]);
}
