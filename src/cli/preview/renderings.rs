//! Pictures of scenes: the finished one of `rtc render`, and one pixel of it.

use super::pixels::PixelTable;
use super::preview_state::{NoiseLayers, RenderedPicture};
use super::{Failure, args, render};
use crate::project;
use rtc_pipeline::{Input, PictureSetup, RenderError, RenderObserver, RenderSubject, Rounds};
use rtc_render::{Aov, Crop, Film, RayCounts, RenderSelection};
use rtc_study::RenderGoal;
use std::num::NonZeroU32;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

/// The settings of requested pictures.
pub(super) fn setup(args: &args::PreviewArgs) -> Result<PictureSetup, Failure> {
    let setup = render::wanted(&args.wanted, &args.look, Path::new("preview.png"))?;
    render::refuse_layers(&setup)?;
    let settled = project::picture(&args.file, &args.reading, RenderGoal::default())?;
    Ok(PictureSetup {
        threads: args.threads.count(),
        overrides: setup.overrides.or(settled),
        ..setup
    })
}

/// The picture as `rtc render` makes it, and its pixels.
pub(super) fn finish(
    setup: &PictureSetup,
    subject: &mut RenderSubject,
    input: &mut Input,
    observer: &RenderObserver<'_>,
) -> Result<(RenderedPicture, PixelTable), RenderError> {
    let window = setup.window(&subject.validated.lowered.scene)?;
    let film = trace(setup, subject, window, input, observer)?;
    let job = RenderSelection {
        crop: Some(window),
        samples: Some(NonZeroU32::MIN),
        ..RenderSelection::default()
    };
    let is_going = || !(observer.is_stopped)();
    let (_, renderer) = setup.renderer(subject)?;
    let layers = renderer.layers(&[Aov::Instance, Aov::Depth], &job, &is_going);
    let layers = layers.ok_or(RenderError::Stopped)?;
    let pixels = PixelTable::new(&film.image, &layers, &subject.validated, input);
    let rendering = rendering(setup, subject, film, input, observer)?;
    Ok((rendering, pixels))
}

/// The picture alone.
pub(super) fn whole(
    setup: &PictureSetup,
    subject: &mut RenderSubject,
    input: &mut Input,
    observer: &RenderObserver<'_>,
) -> Result<RenderedPicture, RenderError> {
    let window = setup.window(&subject.validated.lowered.scene)?;
    let film = trace(setup, subject, window, input, observer)?;
    rendering(setup, subject, film, input, observer)
}

/// The target of the picture whose noise is shown, in grey levels.
const NOISE_TARGET: f64 = 4.0;

/// The standard error, the samples and the light that may be unmet of each pixel, of a picture to
/// [`NOISE_TARGET`] in the same view and settings.
pub(super) fn noise(
    setup: &PictureSetup,
    subject: &mut RenderSubject,
    input: &mut Input,
    observer: &RenderObserver<'_>,
) -> Result<NoiseLayers, RenderError> {
    // Render it to a target, with the layers of samples.
    let mut setup = PictureSetup {
        denoise: false,
        goal: RenderGoal {
            error: Some(NOISE_TARGET),
            ..RenderGoal::default()
        },
        ..setup.clone()
    };
    setup.look.aovs = [Aov::Error, Aov::Samples, Aov::Undersampled].into();
    let window = setup.window(&subject.validated.lowered.scene)?;
    setup.check_memory(subject, window)?;
    let rounds = Rounds {
        elapsed: &|| Duration::ZERO,
        begin: &|_| (),
    };
    let found = setup.approach(subject, (window, input.rays()), observer, &rounds)?;
    // Tell its bound, and make a picture of each layer.
    let samples = found.samples;
    let bound = match found.undersampled {
        None => format!("error at most {:.1} grey levels (90 %)", found.error),
        Some(_) => "no bound on the error: bright light may be unmet".to_owned(),
    };
    let text = format!(
        "{bound}; {} … {} samples per pixel, {:.0} on average",
        samples.min, samples.most, samples.mean
    );
    let film = (found.image, found.coverage, &found.counts);
    let is_stopped = observer.is_stopped;
    let picture = setup.develop(subject, film, &found.quality, input, is_stopped)?;
    let file = |aov: &Aov| {
        let png = setup.encode_layer(*aov, &picture, subject)?;
        Ok((aov.name(), Arc::new(png)))
    };
    let files: Result<_, RenderError> = setup.look.aovs.iter().map(file).collect();
    Ok(NoiseLayers {
        files: files?,
        text,
    })
}

/// The effects simulated for a pixel of the picture, which is rendered again by itself; `None`
/// outside of it.
pub(super) fn pixel(
    setup: &PictureSetup,
    subject: &mut RenderSubject,
    [x, y]: [u32; 2],
    input: &Input,
    observer: &RenderObserver<'_>,
) -> Result<Option<RayCounts>, RenderError> {
    let window = setup.window(&subject.validated.lowered.scene)?;
    if x >= window.width || y >= window.height {
        return Ok(None);
    }
    let own = Crop {
        x: window.x + x,
        y: window.y + y,
        width: 1,
        height: 1,
    };
    let plain = PictureSetup {
        denoise: false,
        ..setup.clone()
    };
    let traced = plain.trace(subject, (own, input.rays()), observer)?;
    Ok(Some(traced.film.counts))
}

/// The film of a window, if there is room for it.
fn trace(
    setup: &PictureSetup,
    subject: &mut RenderSubject,
    window: Crop,
    input: &Input,
    observer: &RenderObserver<'_>,
) -> Result<Film, RenderError> {
    setup.check_memory(subject, window)?;
    Ok(setup.trace(subject, (window, input.rays()), observer)?.film)
}

/// The picture of a film, as a file.
pub(super) fn rendering(
    setup: &PictureSetup,
    subject: &mut RenderSubject,
    film: Film,
    input: &mut Input,
    observer: &RenderObserver<'_>,
) -> Result<RenderedPicture, RenderError> {
    let Film {
        image,
        coverage,
        counts,
    } = film;
    let full = [image.width, image.height];
    let film = (image, coverage, &counts);
    let picture = setup.develop(subject, film, &[], input, observer.is_stopped)?;
    Ok(RenderedPicture {
        png: Arc::new(setup.encode(&picture, subject)?),
        full,
        is_finished: true,
    })
}
