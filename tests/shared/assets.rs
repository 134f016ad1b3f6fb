//! The pictures and meshes that people's scenes name: each is read.

use super::scenes::each;
use libtest_mimic::Trial;
use rtc::internals::diag::DiagnosticSink;
use rtc::internals::pipeline::{self, Options};
use rtc::internals::source::SourceMap;
use std::path::Path;

pub(crate) fn trials() -> Vec<Trial> {
    ["wild", "wild-2", "course/scenes"]
        .iter()
        .flat_map(|folder| each("assets", folder, &["png", "obj", "off"], is_read))
        .collect()
}

fn is_read(path: &Path) {
    let name = path.file_name().unwrap().to_str().unwrap();
    let head =
        "Camera: {eye: [0, 0, 9], center: [0, 0, 0], up: [0, 1, 0], viewSize: [4, 4]}\nObjects:\n";
    let is_picture = path.extension().is_some_and(|extension| extension == "png");
    let (material, object) = if is_picture {
        let sphere = "type: sphere, position: [0, 0, 0], radius: 1";
        (format!("texture: \"{name}\""), sphere.to_owned())
    } else {
        (
            "color: [1, 1, 1]".to_owned(),
            format!("type: mesh, file: \"{name}\""),
        )
    };
    let text =
        format!("{head}- {{{object}, material: {{{material}, ka: 1, kd: 1, ks: 0, n: 1}}}}\n");
    let (mut map, mut sink, mut options) = (
        SourceMap::default(),
        DiagnosticSink::default(),
        Options::default(),
    );
    options.front.asset_root = path.parent().map(Path::to_owned);
    let file = map.add("scene.yaml", text.into_bytes());
    let lowered = pipeline::load(file, &mut map, &options, &mut sink);
    let scene = lowered.unwrap().scene;
    assert!(!sink.has_errors(), "{:?}", sink.kept());
    if is_picture {
        assert!(scene.images[0].width > 1);
    } else {
        assert!(scene.meshes[0].triangles.len() > 1);
    }
}
