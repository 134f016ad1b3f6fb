//! The same promises for path tracing: the reference is the sRGB value of the limit of many paths.

use super::on;
use super::scenes::{error, references, render};
use rtc::internals::codec::{self, Encoding};
use rtc::internals::diag::DiagnosticSink;
use rtc::internals::ir::Scene;
use rtc::internals::source::SourceMap;

/// Two spheres on a floor, under an emissive disc and an environment.
pub(super) fn balls() -> Scene {
    decoded(include_str!("paths.json"))
}

/// A scene by its JSON.
pub(super) fn decoded(text: &str) -> Scene {
    let (mut map, mut sink) = (SourceMap::default(), DiagnosticSink::default());
    let file = map.add("paths.json", text.as_bytes().to_vec());
    codec::decode(Encoding::Json, file, &map, &mut sink)
        .unwrap_or_else(|| panic!("{:?}", sink.kept()))
}

#[test]
fn the_error_said_is_kept_by_paths() {
    let scene = balls();
    let references = references(&scene, 2.0);
    let mut kept = 0;
    for seed in 1..=8 {
        let reached = render(&scene, 2.0, seed);
        assert!(
            reached.error <= 2.0 && reached.error > 0.2,
            "{}",
            reached.error
        );
        assert!(
            reached.samples.most > reached.samples.min,
            "samples go where the noise is: {:?}",
            reached.samples
        );
        kept += u32::from(error(&reached, &references) <= reached.error);
    }
    assert!(kept >= 6, "{kept} of 8");
}

#[test]
fn threads_change_no_bit_of_paths() {
    let scene = balls();
    let [one, three] = [1, 3].map(|threads| on(threads, || render(&scene, 12.0, 0)));
    assert!(one.image == three.image && one.counts == three.counts && one.error == three.error);
}
