//! What the light of a scene shows of it: how bright it is to be shown, if its lights are in lux and
//! candela, and how much of it is seen.
//!
//! That is found by a small render of the whole view, always of the same size and samples, so that it
//! does not depend on those of the picture, nor on the part of it that is rendered.

use super::Renderer;
use rtc_color::luminance;
use rtc_ir::{Camera, Mode, Scene};
use rtc_math::{exp, ln, pow};
use rtc_passes::emissive_surfaces;
use rtc_render::{Aov, Background, Film, Job, OnPixel, Values};
use rtc_valid::{ValidScene, revalidate};

/// The small render: its sides in pixels, and the paths of each.
const SIDE: u32 = 64;
const PATHS: u32 = 16;
/// What is lit is shown as a grey card in the mean of the logarithms of its luminance.
const GREY: f64 = 0.18;
/// So much of what is lit is at most white in all channels.
const UNCLIPPED: f64 = 0.95;
/// Pixels darker than this part of the bright ones count as if they were as bright.
const DARK: f64 = 1e-3;

/// Of what is darker than this, nothing is seen: 9 % of white as a display shows it.
const SEEN: f64 = 0.01;

/// What the light of a scene shows of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OwnLight {
    /// The exposure that shows it, in whole thirds of a stop; 0 if its surfaces are dark.
    pub stops: f64,
    /// The part of its surfaces that is seen then, of those in the picture that don't glow
    /// themselves, in [0, 1].
    pub seen: f64,
}

impl Renderer {
    /// What the light of a proven scene shows to a camera, exposed by as much as that asks for, or as
    /// it is. The scene is that of the renderer, but for its camera and settings. `None` if
    /// `on_pixel` said stop.
    pub fn own_light(
        &mut self,
        scene: &Scene,
        camera: &Camera,
        exposes: bool,
        on_pixel: &OnPixel<'_>,
    ) -> Option<OwnLight> {
        let own = self.world.scene().clone();
        self.change(small(scene, camera));
        let job = Job {
            values: Values::Linear,
            background: Background::Nothing,
            ..Job::default()
        };
        let film = self.render(&job, on_pixel);
        let numbers = self.layers(&[Aov::Instance], &job, &|| true);
        self.change(own);
        let (film, numbers) = (film?, numbers?);
        let stops = if exposes { stops(&film) } else { 0.0 };
        let glowing = emissive_surfaces(scene);
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "surfaces are counted from 1"
        )]
        let glows = |number: &f32| glowing.get((*number as usize).wrapping_sub(1)) == Some(&true);
        let glows: Vec<bool> = numbers.values.iter().map(glows).collect();
        let seen = seen(&film, &glows, stops);
        Some(OwnLight { stops, seen })
    }
}

/// The scene as the small render shows it.
fn small(scene: &Scene, camera: &Camera) -> ValidScene {
    let mut scene = scene.clone();
    let [width, height] = camera.size.map(|side| f64::from(side) / f64::from(SIDE));
    scene.camera = Camera {
        right: camera.right.map(|step| step * width),
        up: camera.up.map(|step| step * height),
        size: [SIDE; 2],
        ..camera.clone()
    };
    if let Mode::Path(path) = &mut scene.settings.mode {
        path.samples = PATHS;
    }
    revalidate(&scene)
}

/// The exposure at which the surfaces of a film are neither too dark nor too bright.
fn stops(film: &Film) -> f64 {
    let shown = surfaces(film).map(|(_, pixel)| pixel);
    let is_lit = |pixel: &[f64; 3]| luminance(*pixel) > 0.0 && luminance(*pixel).is_finite();
    let lit: Vec<[f64; 3]> = shown.filter(is_lit).collect();
    let mut brightest: Vec<f64> = lit.iter().map(|[r, g, b]| r.max(*g).max(*b)).collect();
    brightest.sort_unstable_by(f64::total_cmp);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "an index within the list"
    )]
    let index = (UNCLIPPED * brightest.len() as f64) as usize;
    let Some(bright) = brightest.get(index) else {
        return 0.0;
    };
    // The geometric mean of the luminance.
    let logarithms = lit
        .iter()
        .map(|pixel| ln(luminance(*pixel).max(DARK * bright)));
    let mean = exp(logarithms.sum::<f64>() / lit.len() as f64);
    let factor = (GREY / mean).min(1.0 / bright);
    let stops = ln(factor) / std::f64::consts::LN_2;
    (3.0 * stops).round() / 3.0
}

/// The part of the surfaces of a film that is seen at an exposure, of the pixels that don't glow;
/// all if there are no others.
fn seen(film: &Film, glows: &[bool], stops: f64) -> f64 {
    let least = SEEN * pow(2.0, -stops);
    let lit = surfaces(film).filter(|(index, _)| glows.get(*index) != Some(&true));
    let (all, seen) = lit.fold((0_u32, 0_u32), |(all, seen), (_, pixel)| {
        (all + 1, seen + u32::from(luminance(pixel) >= least))
    });
    if all == 0 {
        1.0
    } else {
        f64::from(seen) / f64::from(all)
    }
}

/// The pixels of a film that show a surface, by their indices. What covers a pixel in part is as
/// bright as if it covered it whole.
fn surfaces(film: &Film) -> impl Iterator<Item = (usize, [f64; 3])> {
    let pixels = film.image.pixels.iter().zip(&film.coverage).enumerate();
    let covered = pixels.filter(|(_, (_, covered))| **covered > 0.0);
    covered.map(|(index, (pixel, covered))| {
        let whole = pixel.map(|value| value / f64::from(*covered));
        (index, whole)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use rtc_image::Image;
    use rtc_render::Counts;

    fn exposed(pixels: Vec<[f64; 3]>, coverage: Vec<f32>) -> f64 {
        let image = Image {
            width: u32::try_from(pixels.len()).expect("few pixels"),
            height: 1,
            pixels,
        };
        stops(&Film {
            image,
            coverage,
            counts: Counts::default(),
        })
    }

    #[test]
    fn an_even_grey_is_shown_as_a_grey_card() {
        let third = |stops: f64| (3.0 * stops).round() / 3.0;
        for radiance in [1e-6, 0.18, 3.0, 54_000.0] {
            let expected = third(-ln(radiance / GREY) / std::f64::consts::LN_2);
            let found = exposed(vec![[radiance; 3]; 40], vec![1.0; 40]);
            assert!((found - expected).abs() < 1e-9, "{radiance}: {found}");
            // Half covered, and beside a background that is no surface.
            let mut half = vec![[radiance / 2.0; 3]; 40];
            half.extend([[0.0; 3]; 60]);
            let coverage = [vec![0.5; 40], vec![0.0; 60]].concat();
            assert!((exposed(half, coverage) - expected).abs() < 1e-9);
        }
    }

    #[test]
    fn bright_surfaces_are_kept_below_white() {
        // A tenth of the picture is 64 times as bright as a grey card.
        let mut pixels = vec![[GREY; 3]; 90];
        pixels.extend([[64.0 * GREY, 0.0, 0.0]; 10]);
        let found = exposed(pixels, vec![1.0; 100]);
        assert!(64.0 * GREY * libm::exp2(found) <= 1.0 + 0.13, "{found}");
    }

    #[test]
    fn what_is_seen_is_counted_among_the_surfaces_at_the_exposure() {
        let pixels = [
            vec![[0.02; 3]; 10],
            vec![[0.002; 3]; 30],
            vec![[0.0; 3]; 60],
        ]
        .concat();
        let image = Image {
            width: 100,
            height: 1,
            pixels,
        };
        let coverage = [vec![1.0; 40], vec![0.0; 60]].concat();
        let counts = Counts::default();
        let film = Film {
            image,
            coverage,
            counts,
        };
        assert_eq!(
            [0.0, 3.0, -2.0].map(|stops| seen(&film, &[], stops)),
            [0.25, 1.0, 0.0]
        );
        // Of the ten bright ones five glow, and then all that are there.
        let glows = |count: usize| (0..100).map(|index| index < count).collect::<Vec<_>>();
        let seen = |count| seen(&film, &glows(count), 0.0);
        assert_eq!([5, 40].map(seen), [1.0 / 7.0, 1.0]);
    }

    #[test]
    fn what_is_dark_is_left_as_it_is() {
        assert_eq!(exposed(vec![[0.0; 3]; 9], vec![1.0; 9]), 0.0);
        assert_eq!(exposed(vec![], vec![]), 0.0);
    }
}
