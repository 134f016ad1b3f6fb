//! Certified pixels: which 8-bit values of a picture are proven.
//!
//! # What is proven
//!
//! The Whitted integrator and the first-hit modes are evaluated over intervals ([`Enclosure`]) that
//! certainly contain the results of the formulas in real numbers, for the scene as its f64 numbers
//! state it. A value is proven if the whole interval lies in one level. Else it is flagged, with
//! its [`Doubts`]: a decision that rounding leaves open, or a feature whose formula is not
//! evaluated.
//!
//! The evaluation starts from the IR and shares no code with the renderer, so that an error of one
//! of them shows as a difference between them.
//!
//! # Data flow
//!
//! `camera` makes the rays of a pixel, `shape` meets surfaces, `shade` follows rays, `reason` names
//! what is in doubt. [`certify`] loops over the pixels.

mod camera;
mod enclosure;
mod reason;
mod shade;
mod shape;

pub use enclosure::{Enclosure, EnclosureVector};
pub use reason::Doubts;

use camera::CertifiedCamera;
use rayon::prelude::*;
use rayon::{ThreadPoolBuildError, ThreadPoolBuilder};
use rtc_ir::{Mode, Scene};
use shade::{CertifiedScene, Color, FirstHit, plus};

/// The certificate of a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PixelCertificate {
    /// The proven values of red, green and blue.
    pub levels: [Option<u8>; 3],
    /// Why others are not proven; none if all are.
    pub doubts: Doubts,
}

impl PixelCertificate {
    /// Whether all values are proven.
    #[must_use]
    pub fn is_proven(&self) -> bool {
        self.levels.iter().all(Option::is_some)
    }

    /// Whether a rendered pixel has all values that are proven.
    #[must_use]
    pub fn agrees(&self, rendered: [u8; 3]) -> bool {
        let pairs = self.levels.into_iter().zip(rendered);
        pairs
            .into_iter()
            .all(|(level, value)| level.is_none_or(|level| level == value))
    }

    /// The certificate of an enclosed colour.
    fn of(color: Color, doubts: Doubts) -> Self {
        let levels = color.map(Enclosure::level);
        let is_proven = levels.iter().all(Option::is_some);
        let doubts = match (is_proven, doubts.is_empty()) {
            (true, _) => Doubts::NONE,
            (false, true) => Doubts::LEVEL,
            (false, false) => doubts,
        };
        Self { levels, doubts }
    }
}

/// The certificates of the pixels of a scene's picture, row by row, with so many threads (0: one a
/// core); `None` if `is_stopped`.
///
/// The picture is that of 8 bits without exposure and tone map. A path-traced scene has no proven
/// pixel.
///
/// # Errors
/// If the threads can't be started.
pub fn certify(
    scene: &Scene,
    threads: usize,
    is_stopped: &(dyn Fn() -> bool + Sync),
) -> Result<Option<Vec<PixelCertificate>>, ThreadPoolBuildError> {
    let pool = ThreadPoolBuilder::new().num_threads(threads).build()?;
    Ok(pool.install(|| certificates(scene, is_stopped)))
}

fn certificates(
    scene: &Scene,
    is_stopped: &(dyn Fn() -> bool + Sync),
) -> Option<Vec<PixelCertificate>> {
    let [width, height] = scene.camera.size;
    let certified = CertifiedScene::new(scene);
    let camera = CertifiedCamera::new(scene);
    // A feature that is in doubt everywhere leaves nothing to prove.
    if !certified.doubts.is_empty() {
        let pixel = PixelCertificate {
            levels: [None; 3],
            doubts: certified.doubts,
        };
        return Some(vec![pixel; width as usize * height as usize]);
    }
    if matches!(scene.settings.mode, Mode::Depth) {
        return depths(&certified, &camera, is_stopped);
    }
    let row = |y: u32| {
        let pixel = |x: u32| shaded_pixel(&certified, &camera, [x, y]);
        (!is_stopped()).then(|| (0..width).map(pixel).collect::<Vec<_>>())
    };
    let rows: Option<Vec<_>> = (0..height).into_par_iter().map(row).collect();
    rows.map(|rows| rows.concat())
}

/// The mean of the samples of a pixel, each clamped to [0, 1].
fn shaded_pixel(
    scene: &CertifiedScene<'_>,
    camera: &CertifiedCamera,
    pixel: [u32; 2],
) -> PixelCertificate {
    let mut sum = [Enclosure::ZERO; 3];
    let mut doubts = Doubts::NONE;
    let mut count = 0.0;
    for ray in camera.rays(pixel) {
        let value = scene.radiance(ray);
        sum = plus(sum, value.color.map(|channel| channel.clamp(0.0, 1.0)));
        doubts = doubts | value.doubts;
        count += 1.0;
    }
    let count = Enclosure::point(count);
    PixelCertificate::of(sum.map(|channel| channel / count), doubts)
}

/// Distances as greys, `(t_max − t)/(t_max − t_min)`, of the rays through the middles of pixels.
fn depths(
    scene: &CertifiedScene<'_>,
    camera: &CertifiedCamera,
    is_stopped: &(dyn Fn() -> bool + Sync),
) -> Option<Vec<PixelCertificate>> {
    let [width, height] = scene.scene.camera.size;
    let row = |y: u32| {
        let hit = |x: u32| scene.first_hit(&camera.middle([x, y]));
        (!is_stopped()).then(|| (0..width).map(hit).collect::<Vec<_>>())
    };
    let rows: Option<Vec<_>> = (0..height).into_par_iter().map(row).collect();
    let hits = rows?.into_iter().flatten().collect::<Vec<_>>();
    // Enclose the least and the greatest distance.
    let (mut near, mut far) = ([f64::INFINITY; 2], [0.0_f64; 2]);
    for hit in &hits {
        match hit {
            FirstHit::Nothing => {}
            FirstHit::Surface(_, hit) => {
                let ends = [hit.t.low(), hit.t.high()];
                near = [near[0].min(ends[0]), near[1].min(ends[1])];
                far = [far[0].max(ends[0]), far[1].max(ends[1])];
            }
            FirstHit::Unclear([low, high], _) => {
                near[0] = near[0].min(*low);
                far[1] = far[1].max(*high);
            }
        }
    }
    let [near, far] = [near, far].map(|[low, high]| Enclosure::between(low, high));
    let grey = |hit: &FirstHit| match hit {
        FirstHit::Nothing => PixelCertificate::of([Enclosure::ZERO; 3], Doubts::NONE),
        FirstHit::Unclear(_, doubts) => PixelCertificate::of([Enclosure::ALL; 3], *doubts),
        FirstHit::Surface(_, hit) => {
            let grey = (far - hit.t) / (far - near);
            PixelCertificate::of([grey; 3], Doubts::NONE)
        }
    };
    Some(hits.iter().map(grey).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use rtc_ir::{
        Camera, Disc, Light, MaterialId, Phong, Plane, PointLight, Settings, Shape, Surface,
    };

    /// A floor seen from above at the border of the shadow of a disc, and `off` it.
    fn shadow_of_disc(off: f64) -> Scene {
        let camera = Camera {
            eye: [2.0 + off, 0.0, 20.0],
            center: [2.0 + off, 0.0, 0.0],
            ..Camera::default()
        };
        let settings = Settings {
            shadows: true,
            ..Settings::default()
        };
        let mut scene = Scene::new(camera, settings);
        scene.lights.push(Light::Point(PointLight {
            position: [0.0, 0.0, 10.0],
            color: [0.7; 3],
            radius: 0.0,
        }));
        scene.materials.push(Phong::MATT.into());
        let floor = Shape::Plane(Plane {
            center: [0.0; 3],
            normal: [0.0, 0.0, 1.0],
        });
        let disc = Shape::Disc(Disc {
            center: [0.0, 0.0, 5.0],
            normal: [0.0, 0.0, 1.0],
            radius: 1.0,
        });
        scene.surfaces.extend([floor, disc].map(|shape| Surface {
            shape,
            material: MaterialId(0),
            casts_no_shadow: false,
        }));
        scene
    }

    #[test]
    fn the_border_of_a_shadow_is_flagged_and_both_sides_are_proven() {
        let pixel = |off: f64| certificates(&shadow_of_disc(off), &|| false).unwrap()[0];
        assert_eq!(pixel(0.0).doubts, Doubts::SHADOW);
        assert_eq!(pixel(-1e-9).levels, [Some(0); 3]);
        assert!(pixel(1e-9).levels[0].is_some_and(|level| level > 150));
    }
}
