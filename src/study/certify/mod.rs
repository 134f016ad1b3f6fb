//! Certified pixels: which 8-bit values of a picture are proven.
//!
//! # What is proven
//!
//! The Whitted integrator and the first-hit modes are evaluated over sets of numbers
//! ([`CertifiedNumber`]) that certainly contain the results of the formulas in real numbers, for
//! the scene as its f64 numbers state it. A value is proven if the whole set lies in one level.
//! First the sets are intervals of f64 ([`Enclosure`]); what they leave open is evaluated again
//! with balls of about 106 bits ([`DoubleDoubleBall`]). What is still open is flagged, with its
//! [`Doubts`]: a decision within rounding, or a feature whose formula is not evaluated.
//!
//! The evaluation starts from the IR and shares no code with the renderer, so that an error of one
//! of them shows as a difference between them.
//!
//! # Data flow
//!
//! `camera` makes the rays of a pixel, `shape` meets surfaces, `shade` follows rays along the tree
//! that `branch` makes, `texture` and `sampling` give them colours and random numbers, `reason`
//! names what is in doubt. [`certify`] loops over the pixels.

mod ball;
mod branch;
mod camera;
mod depth;
mod enclosure;
mod number;
mod reason;
mod sampling;
mod shade;
mod shape;
mod texture;
mod vector;

pub use ball::DoubleDoubleBall;
pub use enclosure::Enclosure;
pub use number::{Certainty, CertifiedNumber};
pub use reason::Doubts;

use camera::CertifiedCamera;
use rayon::prelude::*;
use rayon::{ThreadPoolBuildError, ThreadPoolBuilder};
use rtc_ir::{Mode, Scene};
use rtc_math::{Vec3, Vector};
use shade::{CertifiedScene, Color, plus};
use shape::{CertifiedRay, CertifiedSurfaces, FirstHit};
use std::sync::OnceLock;
use vector::CertifiedVector;

/// The certificate of a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PixelCertificate {
    /// The proven values of red, green and blue.
    pub levels: [Option<u8>; 3],
    /// Why others are not proven; none if all are.
    pub doubts: Doubts,
    /// Which of the values 53 bits left open: an ordinary renderer may round these otherwise.
    pub is_close: [bool; 3],
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
        self.differences(rendered).all(|differs| !differs)
    }

    /// Whether a rendered pixel differs from a proven value by more than rounding: 53 bits prove
    /// the value.
    #[must_use]
    pub fn contradicts(&self, rendered: [u8; 3]) -> bool {
        let differences = self.differences(rendered).zip(self.is_close);
        differences
            .into_iter()
            .any(|(differs, is_close)| differs && !is_close)
    }

    /// For each channel, whether it differs from its proven value.
    fn differences(&self, rendered: [u8; 3]) -> impl Iterator<Item = bool> {
        let pairs = self.levels.into_iter().zip(rendered);
        pairs.map(|(level, value)| level.is_some_and(|level| level != value))
    }

    /// The certificate of a colour.
    fn of<N: CertifiedNumber>(color: Color<N>, doubts: Doubts) -> Self {
        let levels = color.map(N::level);
        let is_proven = levels.iter().all(Option::is_some);
        let doubts = match (is_proven, doubts.is_empty()) {
            (true, _) => Doubts::NONE,
            (false, true) => Doubts::LEVEL,
            (false, false) => doubts,
        };
        Self {
            levels,
            doubts,
            is_close: levels.map(|level| level.is_none()),
        }
    }

    /// The certificate of this and of a second evaluation of what this left open.
    fn or(self, second: impl FnOnce() -> Self) -> Self {
        if self.is_proven() || !self.doubts.is_rounding() {
            return self;
        }
        let second = second();
        let levels = std::array::from_fn(|k| self.levels[k].or(second.levels[k]));
        let is_proven = levels.iter().all(Option::is_some);
        Self {
            levels,
            doubts: if is_proven {
                Doubts::NONE
            } else {
                second.doubts
            },
            is_close: self.is_close,
        }
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

/// The distance at which a ray first meets the surfaces of a scene, in lengths of its direction,
/// which must not be 0; `None` if it meets none.
///
/// # Errors
/// What is in doubt, if it is not certain what is met.
pub fn first_distance<N: CertifiedNumber>(
    scene: &Scene,
    [origin, direction]: [Vec3; 2],
) -> Result<Option<N>, Doubts> {
    let along = Vector::<N>::point(direction);
    let ray = CertifiedRay::new(Vector::point(origin), along.normalized(), None);
    match CertifiedSurfaces::new(scene).first_hit(&ray) {
        FirstHit::Nothing => Ok(None),
        FirstHit::Surface(_, hit) => Ok(Some(hit.t / along.length())),
        FirstHit::Unclear(_, doubts) => Err(doubts),
    }
}

fn certificates(
    scene: &Scene,
    is_stopped: &(dyn Fn() -> bool + Sync),
) -> Option<Vec<PixelCertificate>> {
    let [width, height] = scene.camera.size;
    // A feature that is in doubt everywhere leaves nothing to prove.
    let doubts = doubts_everywhere(scene);
    if !doubts.is_empty() {
        let pixel = PixelCertificate {
            levels: [None; 3],
            doubts,
            is_close: [false; 3],
        };
        return Some(vec![pixel; width as usize * height as usize]);
    }
    let views = Views::new(scene);
    if matches!(scene.settings.mode, Mode::Depth) {
        return depth::certificates(&views, is_stopped);
    }
    views.pixels(is_stopped, |pixel| {
        let first = views.narrow.certificate(pixel);
        first.or(|| views.wide().certificate(pixel))
    })
}

/// A scene and its camera as sets of numbers.
struct CertifiedView<'scene, N> {
    scene: CertifiedScene<'scene, N>,
    camera: CertifiedCamera<N>,
}

impl<'scene, N: CertifiedNumber> CertifiedView<'scene, N> {
    fn new(scene: &'scene Scene) -> Self {
        Self {
            scene: CertifiedScene::new(scene),
            camera: CertifiedCamera::new(scene),
        }
    }

    /// The mean of the samples of a pixel, each clamped to [0, 1].
    fn certificate(&self, pixel: [u32; 2]) -> PixelCertificate {
        let mut sum = [N::ZERO; 3];
        let mut doubts = Doubts::NONE;
        let mut count = 0.0;
        for (ray, key) in self.camera.rays(pixel) {
            let value = self.scene.radiance(ray, key);
            sum = plus(sum, value.color.map(|channel| channel.clamp(0.0, 1.0)));
            doubts = doubts | value.doubts;
            count += 1.0;
        }
        let count = N::point(count);
        PixelCertificate::of(sum.map(|channel| channel / count), doubts)
    }
}

/// A scene by intervals, and by balls where it is asked for.
struct Views<'scene> {
    source: &'scene Scene,
    narrow: CertifiedView<'scene, Enclosure>,
    wide: OnceLock<CertifiedView<'scene, DoubleDoubleBall>>,
}

impl<'scene> Views<'scene> {
    fn new(source: &'scene Scene) -> Self {
        let (narrow, wide) = (CertifiedView::new(source), OnceLock::new());
        Self {
            source,
            narrow,
            wide,
        }
    }

    fn wide(&self) -> &CertifiedView<'scene, DoubleDoubleBall> {
        self.wide.get_or_init(|| CertifiedView::new(self.source))
    }

    /// What is said of each pixel, row by row; `None` if stopped.
    fn pixels<T: Send + Clone>(
        &self,
        is_stopped: &(dyn Fn() -> bool + Sync),
        of: impl Fn([u32; 2]) -> T + Sync,
    ) -> Option<Vec<T>> {
        let [width, height] = self.source.camera.size;
        let row = |y: u32| {
            let pixel = |x: u32| (!is_stopped()).then(|| of([x, y]));
            (0..width).map(pixel).collect::<Option<Vec<_>>>()
        };
        let rows: Option<Vec<_>> = (0..height).into_par_iter().map(row).collect();
        rows.map(|rows| rows.concat())
    }
}

/// What is unsupported in the whole picture.
fn doubts_everywhere(scene: &Scene) -> Doubts {
    let settings = &scene.settings;
    let has_falloff = scene.lights.iter().any(|light| light.point().is_none());
    let is_moving = (scene.surfaces.iter()).any(|surface| surface.velocity.get() != [0.0; 3]);
    let cases = [
        (settings.toon, "toon shading"),
        (settings.stereo != 0.0, "stereo"),
        (is_moving, "motion"),
        (settings.background.is_some(), "a background colour"),
        (has_falloff, "lights with falloff"),
        (matches!(settings.mode, Mode::Path(_)), "path tracing"),
        (scene.environment.is_some(), "an environment"),
    ];
    let found = cases.into_iter().filter(|(is_there, _)| *is_there);
    found.fold(Doubts::NONE, |doubts, (_, name)| {
        doubts | Doubts::unsupported(name)
    })
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
        scene
            .surfaces
            .extend([floor, disc].map(|shape| Surface::new(shape, MaterialId(0))));
        scene
    }

    #[test]
    fn the_border_of_a_shadow_is_flagged_and_both_sides_are_proven() {
        let pixel = |off: f64| certificates(&shadow_of_disc(off), &|| false).unwrap()[0];
        assert_eq!(pixel(0.0).doubts, Doubts::SHADOW);
        for near in [1e-9, 1e-15] {
            assert_eq!(pixel(-near).levels, [Some(0); 3]);
            assert!(pixel(near).levels[0].is_some_and(|level| level > 150));
        }
    }
}
