//! Images decoded side by side: what comes of them, what is said of them and what is charged does
//! not depend on the number of threads.

use super::make;
use rtc::internals::diag::DiagnosticSink;
use rtc::internals::front::FrontOptions;
use rtc::internals::pipeline::{self, Options};
use rtc::internals::source::{Limits, Resource, SourceMap};

/// The pixels of the images, and the findings in their order, of so many threads.
fn loaded(asset: &[u8], limits: Limits, threads: usize) -> (Vec<Vec<u8>>, Vec<String>) {
    let (mut map, mut sink) = (SourceMap::with_limits(limits), DiagnosticSink::default());
    let file = map.add("made.gltf", asset.to_vec());
    let front = FrontOptions {
        threads,
        ..FrontOptions::default()
    };
    let options = Options {
        front,
        ..Options::default()
    };
    let lowered = pipeline::load(file, &mut map, &options, &mut sink);
    let images = lowered.map_or_else(Vec::new, |lowered| lowered.scene.images);
    let pixels = images.into_iter().map(|image| image.pixels.to_vec());
    let findings = sink.kept().iter().map(|finding| {
        let pointer = finding.pointer.as_deref().unwrap_or_default();
        format!("{} {pointer} {}", finding.code.id, finding.message)
    });
    (pixels.collect(), findings.collect())
}

/// The findings about images, of which each is one of those expected, in their order.
fn assert_said(found: &[String], expected: &[(&str, &str)]) {
    let about = |finding: &&String| finding.contains("/images/");
    let found: Vec<_> = found.iter().filter(about).collect();
    assert_eq!(found.len(), expected.len(), "{found:#?}");
    for (found, (place, words)) in found.into_iter().zip(expected) {
        assert!(found.contains(place) && found.contains(words), "{found}");
    }
}

#[test]
fn images_come_in_their_order_on_any_number_of_threads() {
    let asset = make::images(&[64, 1, 32, 16, 64, 8], None);
    let (pixels, findings) = loaded(&asset, Limits::default(), 1);
    let sizes: Vec<_> = pixels.iter().map(Vec::len).collect();
    assert_eq!(sizes, [64_usize, 1, 32, 16, 8].map(|side| 3 * side * side));
    assert_eq!((pixels, findings), loaded(&asset, Limits::default(), 4));
}

#[test]
fn the_image_in_ktx2_is_taken() {
    let (pixels, findings) = loaded(&make::ktx2(), Limits::default(), 1);
    assert_eq!(pixels.len(), 1, "{findings:#?}");
    // 10 × 6 pixels: red, green and blue above white of some opacity, and grey.
    let corners = [0, 9, 50, 59].map(|pixel| pixels[0][4 * pixel..][..4].to_vec());
    let colors = [
        [255, 0, 0, 255],
        [0, 0, 255, 255],
        [255, 255, 255, 102],
        [99, 99, 99, 255],
    ];
    assert_eq!(corners, colors);
    assert_said(&findings, &[("/images/1", "10 × 6")]);
}

#[test]
fn a_damaged_image_is_told_between_its_neighbours() {
    let asset = make::images(&[3, 64, 5, 7], Some(1));
    let (pixels, findings) = loaded(&asset, Limits::default(), 1);
    let expected = [
        ("/images/0", "3 × 3"),
        ("/images/1", "damaged"),
        ("/images/2", "5 × 5"),
        ("/images/3", "7 × 7"),
    ];
    assert_said(&findings, &expected);
    assert_eq!((pixels, findings), loaded(&asset, Limits::default(), 4));
}

#[test]
fn the_image_that_asks_for_too_much_is_the_same_one() {
    let asset = make::images(&[3, 64, 5, 7], None);
    let mut limits = Limits::default();
    limits.set(Resource::Pixels, 9 + 64 * 64 + 24);
    let (pixels, findings) = loaded(&asset, limits, 1);
    let expected = [("/images/2", "4130 pixels")];
    assert_said(&findings, &expected);
    assert_eq!((pixels, findings), loaded(&asset, limits, 4));
}
