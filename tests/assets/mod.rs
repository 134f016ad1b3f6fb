//! The files a scene names: where they are looked for, what is refused, and what pictures and
//! meshes become.

#![expect(
    clippy::unwrap_used,
    clippy::disallowed_methods,
    reason = "a test stops at the first surprise and makes the files it reads"
)]
mod climbing;
mod elements;
mod forms;
mod mesh;
mod mtl;
mod names;
mod oracle;
mod outside;
mod picture;
mod search;
mod written;

use image::{DynamicImage, ImageFormat, Rgb, RgbImage};
use rtc::internals::diag::{DiagnosticSink, Severity};
use rtc::internals::front::FrontOptions;
use rtc::internals::front::course::UnfinishedScene;
use rtc::internals::front::course::assets::{self, AssetTarget, PendingAsset};
use rtc::internals::ir::{
    Bump, Image, ImageId, LoweredScene, Mesh, MeshId, Pixels, Texture, TextureId,
};
use rtc::internals::source::{Loader, SourceMap, Span};
use std::fs;
use std::io::Cursor;
use std::path::Path;
use tempfile::TempDir;

/// A scene with one image, one material that looks at it in every way, and one mesh; the text is
/// where it is named.
fn lowered(map: &mut SourceMap) -> LoweredScene {
    let text = "Camera: {eye: [0, 0, 9], center: [0, 0, 0], up: [0, 1, 0], viewSize: [4, 4]}\nObjects:\n- {type: sphere, \
                position: [0, 0, 0], radius: 1, material: {color: [1, 0, 0], ka: 1, kd: 1, ks: 0, n: 1}}\n";
    let file = map.add("course", text.as_bytes().to_vec());
    let mut sink = DiagnosticSink::default();
    let mut lowered = rtc::internals::pipeline::load(
        file,
        map,
        &rtc::internals::pipeline::Options::default(),
        &mut sink,
    )
    .unwrap();
    assert!(!sink.has_errors(), "{sink:?}");
    lowered.scene.images = vec![Image {
        name: "picture".to_owned(),
        width: 1,
        height: 1,
        kind: Pixels::Rgb8,
        pixels: vec![0; 3].into(),
    }];
    lowered.scene.textures = vec![Texture::Uv, Texture::Image(ImageId(0))];
    lowered.scene.meshes = vec![Mesh {
        name: "mesh".to_owned(),
        ..Mesh::default()
    }];
    let phong = lowered.scene.materials[0].phong_mut().unwrap();
    phong.color_map = Some(TextureId(1));
    phong.specular_map = Some(TextureId(0));
    phong.bump = Some(Bump {
        texture: TextureId(1),
        height: 1.0,
    });
    lowered
}

/// What became of a wish.
struct Outcome {
    lowered: LoweredScene,
    /// `CODE severity place message`, each finding followed by its hints.
    findings: String,
    errors: bool,
}

fn bring(scene: &Path, asset: AssetTarget, path: &str, options: &FrontOptions) -> Outcome {
    let mut map = SourceMap::default();
    let lowered = lowered(&mut map);
    let file = Loader.file(scene, &mut map).unwrap();
    let mut sink = DiagnosticSink::default();
    let pending = vec![PendingAsset {
        target: asset,
        path: path.to_owned(),
        span: Some(Span::new(file, 2, 5)),
    }];
    let draft = UnfinishedScene::new(lowered, pending);
    let lowered = assets::load(draft, file, options, &mut map, &mut sink);
    let mut findings = String::new();
    for finding in sink.kept() {
        let severity = match finding.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
            Severity::Note => "note",
        };
        let place = finding.primary.as_ref().map_or(String::new(), |label| {
            let at = map.line_column(label.span.file, label.span.start);
            let name = map
                .name(label.span.file)
                .rsplit('/')
                .next()
                .unwrap()
                .to_owned();
            format!("{name}:{}:{}", at.line, at.column)
        });
        findings.push_str(&format!(
            "{} {severity} {place} {}\n",
            finding.code, finding.message
        ));
        finding
            .hints
            .iter()
            .for_each(|hint| findings.push_str(&format!("  {}\n", hint.text)));
    }
    Outcome {
        lowered,
        findings,
        errors: sink.has_errors(),
    }
}

const IMAGE: AssetTarget = AssetTarget::Image(ImageId(0));
const MESH: AssetTarget = AssetTarget::Mesh(MeshId(0));

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
pub(crate) fn png(color: [u8; 3]) -> Vec<u8> {
    encoded(
        &RgbImage::from_pixel(2, 3, Rgb(color)).into(),
        ImageFormat::Png,
    )
}

fn pixels(outcome: &Outcome) -> Vec<u8> {
    outcome.lowered.scene.images[0].pixels.to_vec()
}
