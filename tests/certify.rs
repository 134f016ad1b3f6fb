//! Certified pixels: what is proven is what is rendered.

use crate::repo::{files, root};
use rtc::internals::color::quantize8;
use rtc::internals::image::{BackgroundFill, FileFormat};
use rtc::internals::ir::{Mode, Scene};
use rtc::internals::passes::Overrides;
use rtc::internals::pipeline::{
    Input, Options, OutputTransform, PictureSetup, RenderObserver, RenderSubject,
};
use rtc::internals::study::{PixelCertificate, certify};
use std::path::Path;

/// A scene in a small picture.
fn small(path: &Path, size: [u32; 2]) -> (PictureSetup, RenderSubject) {
    let look = OutputTransform::new(FileFormat::Png8, None, None, BackgroundFill::Film, &[]);
    let mut setup = PictureSetup {
        overrides: Overrides {
            size: Some(size),
            ..Overrides::default()
        },
        threads: 1,
        ..PictureSetup::new(look.unwrap())
    };
    let mut input = Input::file(path, Options::default());
    let loaded = input.load().unwrap();
    let subject = setup.validate(loaded, &mut input).unwrap().unwrap();
    (setup, subject)
}

fn certified(scene: &Scene) -> Vec<PixelCertificate> {
    certify(scene, 1, &|| false).unwrap().unwrap()
}

#[test]
fn what_is_proven_is_what_is_rendered() {
    let (mut pixels, mut proven) = (0, 0);
    for path in files(&root("scenes"), &["yaml"]) {
        let (setup, mut subject) = small(&path, [28, 20]);
        let scene = subject.validated.lowered.scene.clone();
        let moves = (scene.surfaces.iter()).any(|surface| surface.velocity.get() != [0.0; 3]);
        if moves || matches!(scene.settings.mode, Mode::Path(_)) {
            continue;
        }
        let window = setup.window(&scene).unwrap();
        let observer = RenderObserver {
            on_step: &|_| (),
            is_stopped: &|| false,
        };
        let traced = setup.trace(&mut subject, (window, u64::MAX), &observer);
        let rendered = traced.ok().unwrap().film.image.pixels;
        for (certificate, pixel) in certified(&scene).iter().zip(&rendered) {
            let values = pixel.map(quantize8);
            assert!(
                !certificate.contradicts(values),
                "{}: {values:?}, {certificate:?}",
                path.display()
            );
            pixels += 1;
            proven += u32::from(certificate.is_proven());
            assert_eq!(certificate.is_proven(), certificate.doubts.is_empty());
        }
    }
    assert!(
        pixels > 10_000 && proven * 1000 > pixels * 999,
        "{proven} of {pixels}"
    );
}
