//! Scenes of Mitsuba and pbrt of `../shared`: those that a program goes on after are read, and what
//! has no effect is told.

use crate::suite::needs;
use libtest_mimic::Trial;
use rtc::internals::diag::{DiagnosticSink, Severity};
use rtc::internals::ir::{Light, PunctualKind, Scene};
use rtc::internals::math::Vec3;
use rtc::internals::pipeline::{Options, load};
use rtc::internals::source::{Loader, SourceMap};
use std::path::Path;

/// A file, the codes of its errors and warnings, and what its scene must be.
type Row = (&'static str, &'static [&'static str], fn(&Scene) -> bool);

/// Some findings, and fewer than 64.
const FEW: &[&str] = &["…"];

const ROWS: [Row; 15] = [
    ("mitsuba/mi-d65-scale-ignored.xml", &[], |scene| {
        let environment = scene.environment.as_ref().unwrap();
        environment.radiance == [2.0; 3]
    }),
    ("mitsuba/mi-dangling-ref-silent.xml", &["MI002"], |_| true),
    ("mitsuba/mi-envmap-png-refused.xml", &[], |scene| {
        scene.environment.as_ref().unwrap().image.is_some() && scene.images[0].width > 1
    }),
    ("mitsuba/mi-near-clip-ignored.xml", &["MI004"], |_| true),
    ("mitsuba/mi-property-twice-silent.xml", &["MI006"], |_| true),
    // The cover of the sphere, whose light shines inwards.
    ("mitsuba/mi-sphere-flip-normals-ignored.xml", &[], |scene| {
        scene.surfaces.len() == 3
    }),
    (
        "mitsuba/mi-sunsky-sun-direction-with-to-world.xml",
        &[],
        |scene| {
            let Light::Punctual(sun) = &scene.lights[0] else {
                return false;
            };
            let PunctualKind::Sun { direction } = sun.emitter else {
                return false;
            };
            let known = Vec3::new(0.3, 0.5, 0.4);
            Vec3::from_array(direction).distance(known / known.length()) < 1e-12
        },
    ),
    (
        "mitsuba/mitsuba-rotate-axis-not-of-length-1.xml",
        &["MI006"],
        |_| true,
    ),
    (
        "pbrt/pbrt-absent-include-becomes-itself/main.pbrt",
        &["RE001"],
        |_| true,
    ),
    (
        "pbrt/pbrt-maxcomponentvalue-ignored.pbrt",
        &["PB004"],
        |_| true,
    ),
    (
        "pbrt/pbrt-projective-matrix-on-infinite-light-refused.pbrt",
        &["PB006"],
        |scene| scene.environment.is_some(),
    ),
    (
        "pbrt/pbrt3-interleaved-object-attribute.pbrt",
        &["PB006", "PB006"],
        |scene| scene.surfaces.len() == 1,
    ),
    (
        "pbrt/pbrt3-undefined-named-material-is-error.pbrt",
        &["PB006"],
        |scene| scene.surfaces.len() == 1,
    ),
    ("hostile/xmlns-cubic.xml", &["MI001"], |_| true),
    // Each blend is lowered once, and tells once what it leaves out.
    ("hostile/blend.xml", FEW, |scene| scene.materials.len() < 64),
];

pub(crate) fn trials() -> Vec<Trial> {
    let trials = ROWS.into_iter().map(|(name, codes, is_right)| {
        let path = format!("round-4/{name}");
        needs(format!("exchange/{name}"), &path, move |path| {
            check(path, codes, is_right);
        })
    });
    trials.collect()
}

fn check(path: &Path, codes: &[&str], is_right: fn(&Scene) -> bool) {
    let (mut map, mut sink) = (SourceMap::default(), DiagnosticSink::default());
    let file = Loader.file(path, &mut map).unwrap();
    let lowered = load(file, &mut map, &Options::default(), &mut sink);
    let told = sink.kept().iter();
    let told = told.filter(|own| own.severity < Severity::Note);
    let found: Vec<_> = told.map(|own| own.code.id).collect();
    if codes == FEW {
        assert!((1..64).contains(&found.len()), "{}", found.len());
    } else {
        assert_eq!(found, codes, "{:?}", sink.kept());
    }
    if let Some(lowered) = lowered {
        assert!(is_right(&lowered.scene), "{}", path.display());
    }
}
