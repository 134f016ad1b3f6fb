//! Denoised pictures for a study, as `rtc render --denoise` makes them. Their cost includes the
//! error estimate.

use super::probe::probe;
use super::target::{RenderGoal, RenderRequest};
use rtc_color::Tone;
use rtc_render::{AnyWorld, Crop, Film, PixelObserver, RenderSelection, Values};
use rtc_valid::Mode;

/// The tone curve and exposure of [`Values::Display`] for path tracing.
const DISPLAY: (Tone, f64) = (Tone::Srgb, 1.0);

/// Renders a world, and denoises the picture if that is requested and the mode is path tracing;
/// `None` if `on_pixel` stopped it. A denoised picture is always complete, whatever tiles the job
/// requests.
pub(super) fn film(
    world: &AnyWorld,
    job: &RenderSelection,
    denoise: bool,
    on_pixel: &PixelObserver<'_>,
) -> Option<Film> {
    // Render without denoising if that is not requested or not path tracing.
    let paths = match &world.scene().settings().mode {
        Mode::Path(path) if denoise => path.samples.get(),
        Mode::Path(_) | Mode::Phong | Mode::Depth | Mode::Normal | Mode::Gooch(_) => {
            return world.render(job, on_pixel);
        }
    };
    // Render the whole picture in linear values, and denoise it.
    let camera = world.scene().camera();
    let order = RenderRequest {
        goal: RenderGoal::default(),
        crop: Crop {
            x: 0,
            y: 0,
            width: camera.width.get(),
            height: camera.height.get(),
        },
        background: job.background,
        values: Values::Linear,
        display: DISPLAY,
        keep_lights: false,
        seed: 0,
    };
    let whole = RenderSelection {
        tiles: None,
        values: Values::Linear,
        ..*job
    };
    // Estimate its error, which is part of the cost.
    let picture = world.denoised(paths, &whole, on_pixel, &|| ())?;
    let (mut film, _) = probe(world, &order, picture, paths, on_pixel)?;
    // Convert to display values.
    let (tone, _) = DISPLAY;
    for pixel in &mut film.image.pixels {
        *pixel = tone.display(*pixel);
    }
    Some(film)
}
