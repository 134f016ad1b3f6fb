//! Denoised pictures of a study: as `rtc render --denoise` makes them, the work of telling their errors
//! included.

use super::probe::probe;
use super::target::{Goal, Order};
use rtc_color::Tone;
use rtc_render::{AnyWorld, Crop, DenoisedFilm, Film, Job, OnPixel, Values};
use rtc_valid::Mode;

/// How [`Values::Display`] shows paths.
const DISPLAY: (Tone, f64) = (Tone::Srgb, 1.0);

/// The picture of a world, denoised if that is asked for and paths are traced; `None` if `on_pixel` said
/// stop. A denoised one is whole, whatever tiles the job asks for.
pub(super) fn film(
    world: &AnyWorld,
    job: &Job,
    denoise: bool,
    on_pixel: &OnPixel<'_>,
) -> Option<Film> {
    let paths = match &world.scene().settings().mode {
        Mode::Path(path) if denoise => path.samples.get(),
        Mode::Path(_) | Mode::Phong | Mode::Zbuffer | Mode::Normal | Mode::Gooch(_) => {
            return world.render(job, on_pixel);
        }
    };
    let camera = world.scene().camera();
    let order = Order {
        goal: Goal::default(),
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
    let whole = Job {
        tiles: None,
        values: Values::Linear,
        ..*job
    };
    let picture = world.denoised(paths, &whole, on_pixel, &|| ())?;
    let probed = probe(world, &order, &picture, paths, on_pixel)?;
    let DenoisedFilm { mut film, .. } = picture;
    film.counts = film.counts.plus(probed.counts);
    let (tone, _) = DISPLAY;
    for pixel in &mut film.image.pixels {
        *pixel = tone.display(*pixel);
    }
    Some(film)
}
