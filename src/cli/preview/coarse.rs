//! A coarse picture before the finished one: fewer pixels, and few samples of each.

use super::preview_state::RenderedPicture;
use super::renderings::rendering;
use rtc_diag::DiagnosticSink;
use rtc_ir::{Mode, Scene, SourceSpans};
use rtc_pipeline::{Input, PictureSetup, RenderError, RenderObserver, RenderSubject, Traced};
use rtc_render::Crop;
use rtc_source::Limits;
use rtc_valid::{self as valid, ValidationOptions};

/// The approximate number of pixels.
const PIXELS: u64 = 20_000;

/// Paths per pixel.
const PATHS: u32 = 2;

/// The crude picture; `None` if there is none that is quicker. The subject is as before afterwards.
pub(super) fn render(
    setup: &PictureSetup,
    subject: &mut RenderSubject,
    input: &mut Input,
    observer: &RenderObserver<'_>,
) -> Result<Option<RenderedPicture>, RenderError> {
    // Replace the scene by a coarse one.
    let scene = &mut subject.validated.lowered.scene;
    let Crop { width, height, .. } = setup.window(scene)?;
    let (camera, settings) = (scene.camera.clone(), scene.settings.clone());
    let k = coarsen(scene);
    let options = ValidationOptions {
        limits: Limits::NONE,
    };
    let proof = valid::validate(
        scene,
        &SourceSpans::default(),
        &options,
        &mut DiagnosticSink::default(),
    );
    // Render it in place of the whole scene.
    let rendered = match proof {
        None => Ok(None),
        Some(proof) => {
            let whole = std::mem::replace(&mut subject.validated.scene, proof);
            let rendered = trace(&coarse(setup, k), subject, input, observer);
            subject.validated.scene = whole;
            rendered.map(|rendering| {
                Some(RenderedPicture {
                    full: [width, height],
                    is_finished: false,
                    ..rendering
                })
            })
        }
    };
    // Restore the scene.
    let scene = &mut subject.validated.lowered.scene;
    (scene.camera, scene.settings) = (camera, settings);
    subject.turn();
    rendered
}

fn trace(
    setup: &PictureSetup,
    subject: &mut RenderSubject,
    input: &mut Input,
    observer: &RenderObserver<'_>,
) -> Result<RenderedPicture, RenderError> {
    subject.turn();
    let window = setup.window(&subject.validated.lowered.scene)?;
    let Traced { film, .. } = setup.trace(subject, (window, input.rays()), observer)?;
    // Its diagnostics are reported with the finished picture.
    let found = input.take_diagnostics();
    let rendering = rendering(setup, subject, film, input, observer);
    input.restore_diagnostics(found);
    rendering
}

/// Takes fewer pixels and samples; every how manyth pixel of a row is left.
fn coarsen(scene: &mut Scene) -> u32 {
    let [width, height] = scene.camera.size;
    let mut k = 1;
    while u64::from(width / k) * u64::from(height / k) > PIXELS {
        k += 1;
    }
    scene
        .camera
        .fit([width, height].map(|side| (side / k).max(1)));
    scene.camera.lens.samples = 1;
    scene.settings.supersampling = 1;
    scene.settings.light_samples = 1;
    if let Mode::Path(path) = &mut scene.settings.mode {
        path.samples = path.samples.min(PATHS);
    }
    k
}

/// The same region of a picture with every k-th pixel; not denoised.
fn coarse(setup: &PictureSetup, k: u32) -> PictureSetup {
    let crop = setup.crop.map(|crop| Crop {
        x: crop.x / k,
        y: crop.y / k,
        width: (crop.width / k).max(1),
        height: (crop.height / k).max(1),
    });
    PictureSetup {
        crop,
        denoise: false,
        ..setup.clone()
    }
}
