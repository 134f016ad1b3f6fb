//! Stages of USD that were once read wrongly: each with what is right.

use crate::suite::needs;
use libtest_mimic::Trial;
use rtc::internals::diag::DiagnosticSink;
use rtc::internals::ir::{Material, Scene};
use rtc::internals::pipeline::{Options, load};
use rtc::internals::source::{Loader, SourceMap};
use std::path::Path;

const FOLDER: &str = "round-4/usd";

type SceneCheck = fn(&Scene);

pub(crate) fn trials() -> Vec<Trial> {
    let warned = [
        (
            "usd-ies-ignored-silently.usda",
            "US003",
            "inputs:shaping:ies:file",
        ),
        (
            "usd-light-diffuse-multiplier-ignored.usda",
            "US003",
            "inputs:diffuse",
        ),
        (
            "usd-light-link-ignored-silently.usda",
            "US003",
            "collection:lightLink",
        ),
        (
            "usd-string-for-double-silent.usda",
            "US001",
            "the type `double`",
        ),
        ("u_no_header.usda", "US001", "does not begin as a layer"),
        (
            "usd-outside-root/a/b/c/main.usda",
            "RE002",
            "leaves the folder",
        ),
    ];
    let warned = warned.into_iter().map(|(file, code, part)| {
        of(file, move |path| {
            let found = read(path).1;
            let is_told = |(own, message): &(&str, String)| *own == code && message.contains(part);
            assert!(found.iter().any(is_told), "{found:?}");
        })
    });
    let clean: [(&str, SceneCheck); 5] = [
        ("usdc-regular-mesh-23x23-lost.usdc", |scene| {
            assert_eq!(scene.meshes[0].triangles.len(), 2 * 23 * 23);
        }),
        ("usd-time-samples-without-space-refused.usda", |scene| {
            assert_eq!(scene.surfaces.len(), 1);
        }),
        ("usd-inherited-constant-primvar-not-read.usda", |scene| {
            let colors = [0, 1].map(|surface| base_color(scene, surface));
            assert_eq!(colors, [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]);
        }),
        ("usd-stronger-than-descendants-ignored.usda", |scene| {
            assert_eq!(base_color(scene, 0), [0.5; 3]);
        }),
        ("udim/udim.usda", |scene| {
            assert_eq!(scene.images.len(), 1);
            let image = &scene.images[0];
            assert_eq!(image.width, 2 * image.height);
        }),
    ];
    let clean = clean.into_iter().map(|(file, check)| {
        of(file, move |path| {
            let (scene, mut found) = read(path);
            // Of a subdivision surface the control mesh is shown.
            found.retain(|(code, _)| *code != "US004");
            assert_eq!(found, Vec::new());
            check(&scene.unwrap());
        })
    });
    warned.chain(clean).collect()
}

fn of(file: &'static str, check: impl FnOnce(&Path) + Send + 'static) -> Trial {
    let path = format!("{FOLDER}/{file}");
    needs(format!("stages/{file}"), &path, check)
}

fn read(path: &Path) -> (Option<Scene>, Vec<(&'static str, String)>) {
    let (mut map, mut sink) = (SourceMap::default(), DiagnosticSink::default());
    let file = Loader.file(path, &mut map).unwrap();
    let lowered = load(file, &mut map, &Options::default(), &mut sink);
    let found = sink.kept().iter();
    let found = found.map(|found| (found.code.id, found.message.clone()));
    (lowered.map(|lowered| lowered.scene), found.collect())
}

fn base_color(scene: &Scene, surface: usize) -> [f64; 3] {
    match &scene.materials[scene.surfaces[surface].material.0 as usize] {
        Material::Standard(standard) => {
            let [r, g, b, _] = standard.base_color;
            [r, g, b]
        }
        Material::Phong(other) => panic!("{other:?}"),
    }
}
