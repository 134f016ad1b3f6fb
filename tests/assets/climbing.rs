//! Assets that climb out of their folder by `..`: the folder above lends them pictures, the folder
//! that the user allows lends all.

use super::{folder, png, write};
use rtc::internals::diag::DiagnosticSink;
use rtc::internals::front::{FrontOptions, gltf};
use rtc::internals::source::{Loader, SourceMap};

/// The codes of errors about an asset in `inner` that names a picture and a buffer.
fn errors(image: &str, buffer: &str, root: Option<&str>) -> Vec<&'static str> {
    let folder = folder();
    write(&folder, "textures/t.png", png([9; 3]));
    write(&folder, "textures/text.png", "no picture");
    write(&folder, "textures/four.bin", [0; 4]);
    let asset = format!(
        r#"{{"asset": {{"version": "2.0"}}, "images": [{{"uri": "{image}"}}], "buffers": [{{"byteLength": 4, "uri": "{buffer}"}}]}}"#
    );
    write(&folder, "inner/asset.gltf", asset);
    let (mut map, mut sink) = (SourceMap::default(), DiagnosticSink::default());
    let path = folder.path().join("inner/asset.gltf");
    let file = Loader.file(&path, &mut map).unwrap();
    let options = FrontOptions {
        asset_root: root.map(|root| folder.path().join(root)),
        ..FrontOptions::default()
    };
    let _ = gltf::lower(file, &map, &options, &mut sink);
    let errors = sink.kept().iter();
    let errors = errors.filter(|found| found.severity.name() == "error");
    errors.map(|found| found.code.id).collect()
}

#[test]
fn the_folder_above_lends_pictures_alone() {
    const NONE: &str = "data:application/octet-stream;base64,AAAAAA==";
    for image in [
        "../textures/t.png",
        "%2e%2e/textures/t.png",
        "x/../../textures/t.png",
    ] {
        assert_eq!(errors(image, NONE, None), [""; 0], "{image}");
    }
    // Whether there is a file that is no picture is not told.
    assert_eq!(errors("../textures/text.png", NONE, None), ["GL023"]);
    assert_eq!(errors("../textures/none.png", NONE, None), ["GL023"]);
    assert_eq!(errors("../../t.png", NONE, None), ["GL022"]);
    let (image, buffer) = ("../textures/t.png", "../textures/four.bin");
    assert_eq!(errors(image, buffer, None), ["GL022"]);
    assert_eq!(errors(image, buffer, Some("textures")), [""; 0]);
    assert_eq!(
        errors("..\\\\textures\\\\t.png", NONE, Some("textures")),
        ["GL022"]
    );
}
