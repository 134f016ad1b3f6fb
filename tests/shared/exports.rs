//! What other programs and rtc itself are given of scenes in `../shared`.

use crate::suite::needs;
use libtest_mimic::Trial;
use rtc::Scene;
use std::path::Path;

pub(crate) fn trials() -> Vec<Trial> {
    vec![
        needs(
            "exports: widths of Mitsuba",
            "round-4/mitsuba/mitsuba-alpha-is-not-written-back.xml",
            |path| {
                has(path, "x.xml", r#"name="alpha" value="0.1""#);
                has(path, "x.xml", r#"name="alpha" value="0.3""#);
            },
        ),
        needs(
            "exports: a width of pbrt",
            "round-4/pbrt/pbrt-roughness-0.3-is-not-written-back.pbrt",
            |path| has(path, "x.pbrt", r#""float roughness" [ 0.3 ]"#),
        ),
        needs(
            "exports: an emitter of POV-Ray",
            "round-4/export/pov-emitter-gets-white-diffuse-4.6x.usda",
            |path| {
                let text = text_of(path, "x.pov");
                assert!(!text.contains("pigment { rgb <1, 1, 1> }"), "{text}");
            },
        ),
        needs(
            "exports: checks of any scale",
            "round-4/export/export-checkerboard-to_uv-becomes-one-colour.xml",
            |path| {
                has(
                    path,
                    "x.xml",
                    r#"<texture type="bitmap" name="reflectance">"#,
                );
                has(path, "x.pbrt", r#""texture reflectance""#);
            },
        ),
        needs(
            "exports: a closed mesh of a solid",
            "round-4/export/csg-export-to-glb-has-open-edges-and-wrong-volume.yaml",
            |path| {
                let export = Scene::open(path).unwrap().export("x.glb").unwrap();
                let told = export.diagnostics().iter();
                let mut told = told.filter(|finding| finding.message.contains("closed mesh"));
                assert!(told.next().is_some());
            },
        ),
    ]
}

fn text_of(path: &Path, target: &str) -> String {
    let export = Scene::open(path).unwrap().export(target).unwrap();
    String::from_utf8(export.bytes().to_vec()).unwrap()
}

fn has(path: &Path, target: &str, words: &str) {
    let text = text_of(path, target);
    assert!(text.contains(words), "{text}");
}
