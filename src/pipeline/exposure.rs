//! Measures the light of a scene: its automatic exposure, and how much of the scene is visible.
//!
//! Both come from a small render of the whole view, always with the same size and number of
//! samples, so they do not depend on those of the picture nor on its crop window.

use super::Renderer;
use rtc_color::luminance;
use rtc_ir::{Camera, Mode, Scene};
use rtc_math::{exp, ln, pow};
use rtc_passes::emissive_surfaces;
use rtc_render::{Aov, Background, Crop, Film, PixelObserver, RenderSelection, Values};
use rtc_valid::{ValidScene, revalidate};

/// The pixels of the small render, each of which [`Renderer::measure_light`] renders so often, and
/// its paths per pixel.
pub(super) const WINDOW: Crop = Crop {
    x: 0,
    y: 0,
    width: SIDE,
    height: SIDE,
};
pub(super) const RENDERS: usize = 2;
pub(super) const SIDE: u32 = 64;
const PATHS: u32 = 16;
/// The geometric mean of the luminance of illuminated pixels is exposed to a grey card.
const GREY: f64 = 0.18;
/// The fraction of illuminated pixels that stay below white in all channels.
const UNCLIPPED: f64 = 0.95;
/// Pixels darker than this fraction of the bright ones count as if they had this fraction.
const DARKEST: f64 = 1e-3;

/// Darker pixels count as not visible: 9 % of white on a display.
const VISIBLE: f64 = 0.01;

/// The result of measuring the light of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct LightMeasurement {
    /// The automatic exposure, in whole thirds of a stop; 0 if all surfaces are dark.
    pub stops: f64,
    /// The fraction of the non-emissive surface pixels that are visible at this exposure, in [0,
    /// 1].
    pub visible: f64,
    /// For each pixel of the small render, whether it shows a surface that no path lights.
    pub is_dark: Vec<bool>,
}

impl Renderer {
    /// Measures the light of a valid scene for a camera, with automatic exposure if `exposes`. The
    /// scene is that of the renderer, except for camera and settings. `None` if `on_pixel` stopped
    /// it.
    pub fn measure_light(
        &mut self,
        scene: &Scene,
        camera: &Camera,
        exposes: bool,
        on_pixel: &PixelObserver<'_>,
    ) -> Option<LightMeasurement> {
        let scene_before = self.world.scene().clone();
        self.change(small(scene, camera));
        let job = RenderSelection {
            values: Values::Linear,
            background: Background::Nothing,
            ..RenderSelection::default()
        };
        let film = self.render(&job, on_pixel);
        let numbers = film.as_ref().and_then(|_| {
            let Self { world, threads } = self;
            threads.install(|| world.layers(&[Aov::Instance], &job, on_pixel))
        });
        self.change(scene_before);
        let (film, numbers) = (film?, numbers?);
        let stops = if exposes { stops(&film) } else { 0.0 };
        let glowing = emissive_surfaces(scene);
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "surfaces are counted from 1"
        )]
        let is_emissive =
            |number: &f32| glowing.get((*number as usize).wrapping_sub(1)) == Some(&true);
        let is_emissive: Vec<bool> = numbers.values.iter().map(is_emissive).collect();
        let visible = visible(&film, &is_emissive, stops);
        let mut is_dark = vec![false; film.coverage.len()];
        for (index, pixel) in surfaces(&film) {
            is_dark[index] = luminance(pixel) <= 0.0;
        }
        Some(LightMeasurement {
            stops,
            visible,
            is_dark,
        })
    }
}

/// The scene with the settings of the small render.
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
    let surface_pixels = surfaces(film).map(|(_, pixel)| pixel);
    let is_lit = |pixel: &[f64; 3]| luminance(*pixel) > 0.0 && luminance(*pixel).is_finite();
    let illuminated: Vec<[f64; 3]> = surface_pixels.filter(is_lit).collect();
    let mut brightest: Vec<f64> = illuminated
        .iter()
        .map(|[r, g, b]| r.max(*g).max(*b))
        .collect();
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
    let logarithms = illuminated
        .iter()
        .map(|pixel| ln(luminance(*pixel).max(DARKEST * bright)));
    let mean = exp(logarithms.sum::<f64>() / illuminated.len() as f64);
    let factor = (GREY / mean).min(1.0 / bright);
    let stops = ln(factor) / std::f64::consts::LN_2;
    (3.0 * stops).round() / 3.0
}

/// The fraction of non-emissive surface pixels that are visible at an exposure; 1 if there are
/// none.
fn visible(film: &Film, is_emissive: &[bool], stops: f64) -> f64 {
    let least = VISIBLE * pow(2.0, -stops);
    let illuminated = surfaces(film).filter(|(index, _)| is_emissive.get(*index) != Some(&true));
    let (all, visible) = illuminated.fold((0_u32, 0_u32), |(all, visible), (_, pixel)| {
        (all + 1, visible + u32::from(luminance(pixel) >= least))
    });
    if all == 0 {
        1.0
    } else {
        f64::from(visible) / f64::from(all)
    }
}

/// The pixels of a film that show a surface, with their indices. A partly covered pixel has the
/// brightness of its covered part.
fn surfaces(film: &Film) -> impl Iterator<Item = (usize, [f64; 3])> {
    let pixels = film.image.pixels.iter().zip(&film.coverage).enumerate();
    let covered = pixels.filter(|(_, (_, covered))| **covered > 0.0);
    covered.map(|(index, (pixel, covered))| {
        let uncovered = pixel.map(|value| value / f64::from(*covered));
        (index, uncovered)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use rtc_image::Image;
    use rtc_render::RayCounts;

    fn exposed(pixels: Vec<[f64; 3]>, coverage: Vec<f32>) -> f64 {
        let image = Image {
            width: u32::try_from(pixels.len()).expect("few pixels"),
            height: 1,
            pixels,
        };
        stops(&Film {
            image,
            coverage,
            counts: RayCounts::default(),
        })
    }

    #[test]
    fn an_even_grey_is_shown_as_a_grey_card() {
        let third = |stops: f64| (3.0 * stops).round() / 3.0;
        for radiance in [1e-6, 0.18, 3.0, 54_000.0] {
            let expected = third(-ln(radiance / GREY) / std::f64::consts::LN_2);
            let found = exposed(vec![[radiance; 3]; 40], vec![1.0; 40]);
            assert!((found - expected).abs() < 1e-9, "{radiance}: {found}");
            // Half covered, and next to a background without surfaces.
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
        let counts = RayCounts::default();
        let film = Film {
            image,
            coverage,
            counts,
        };
        assert_eq!(
            [0.0, 3.0, -2.0].map(|stops| visible(&film, &[], stops)),
            [0.25, 1.0, 0.0]
        );
        // Of the ten bright pixels five are emissive, then all covered ones.
        let is_emissive = |count: usize| (0..100).map(|index| index < count).collect::<Vec<_>>();
        let visible = |count| visible(&film, &is_emissive(count), 0.0);
        assert_eq!([5, 40].map(visible), [1.0 / 7.0, 1.0]);
    }

    #[test]
    fn what_is_dark_is_left_as_it_is() {
        assert_eq!(exposed(vec![[0.0; 3]; 9], vec![1.0; 9]), 0.0);
        assert_eq!(exposed(vec![], vec![]), 0.0);
    }
}
