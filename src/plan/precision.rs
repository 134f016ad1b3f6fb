//! The expected losses by the plain arithmetics in a scene: first-order estimates from its sizes
//! and distances.
//!
//! Estimates are for typical rays, which meet a surface near its middle. At outlines errors are
//! larger.

use super::shape::shape_facts;
use super::{Arithmetic, facts};
use rtc_valid::{Mode, Phong, Surface, ValidScene};

/// The plain arithmetics ignore hits nearer than this, in units of the world: they take them for
/// the start of the ray.
pub const MIN_HIT_DISTANCE: f64 = 1e-5;

/// The largest relative error of the points of a curved surface that is invisible in its shading in
/// 8 bits.
const VISIBLE: f64 = 1.0 / 512.0;

/// The largest fraction of the size of a surface that may be skipped invisibly.
const SKIPPED: f64 = 1.0 / 100.0;

/// The symptom of a loss.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Symptom {
    /// Rays that leave a surface meet it again: it shades or mirrors itself.
    SelfHit,
    /// The errors of the points of a curved surface make its shading wrong.
    Shape,
    /// The surface is hardly larger than the skipped start of each ray.
    Skipped,
}

/// The loss by an arithmetic.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Loss {
    /// The surface with the strongest symptom: an index into [`ValidScene::surfaces`].
    pub surface: usize,
    /// The symptom there.
    pub symptom: Symptom,
    /// The error of the points of the surface, in units of the world.
    pub error: f64,
    /// The ratio of the error to the largest invisible one.
    pub excess: f64,
    /// The number of affected surfaces.
    pub surfaces: usize,
}

/// The loss of a scene by an arithmetic, if it is expected to be visible.
#[must_use]
pub fn loss(scene: &ValidScene, arithmetic: Arithmetic) -> Option<Loss> {
    let unit = match arithmetic {
        Arithmetic::Robust => return None,
        Arithmetic::Plain => f64::EPSILON / 2.0,
        Arithmetic::F32 => f64::from(f32::EPSILON) / 2.0,
    };
    let is_lit = scene.settings().shadows && !facts::light::course(scene.lights()).is_empty();
    let losses = scene
        .surfaces()
        .iter()
        .enumerate()
        .filter_map(|(index, surface)| {
            let measure = HitAccuracy::of(scene, surface);
            let symptoms = [Symptom::SelfHit, Symptom::Shape, Symptom::Skipped];
            let excess = symptoms
                .map(|symptom| measure.excess(symptom, unit, sends_rays(scene, surface, is_lit)));
            let worst = (0..3).max_by(|a, b| excess[*a].total_cmp(&excess[*b]))?;
            let (symptom, excess) = (symptoms[worst], excess[worst]);
            (excess > 1.0).then(|| Loss {
                surface: index,
                symptom,
                error: measure.error(unit),
                excess,
                surfaces: 1,
            })
        });
    losses.reduce(|worst, loss| {
        let surfaces = worst.surfaces + loss.surfaces;
        Loss {
            surfaces,
            ..if loss.excess > worst.excess {
                loss
            } else {
                worst
            }
        }
    })
}

/// Whether rays start on a surface; `is_lit` says whether lights cast shadows.
fn sends_rays(scene: &ValidScene, surface: &Surface, is_lit: bool) -> bool {
    let settings = scene.settings();
    match settings.mode {
        Mode::Phong => {}
        Mode::Path(_) => return true,
        Mode::Normal | Mode::Gooch(_) | Mode::Zbuffer => return false,
    }
    let Phong { ks, kt, .. } = facts::material::phong(&scene.materials()[surface.material]);
    is_lit || settings.max_depth > 0 && (ks.get() > 0.0 || kt.get() > 0.0)
}

/// The sizes that decide the accuracy of hits on a surface.
struct HitAccuracy {
    /// The size of the coordinates at both ends of rays.
    coordinates: f64,
    /// From the eye to the middle of the surface.
    distance: f64,
    equation: EquationKind,
}

/// The type of equation of a surface, with the sizes that divide its error.
pub(super) enum EquationKind {
    /// Flat: t is one quotient. The size, infinite for an unbounded one.
    Linear(f64),
    /// A quadratic, of this radius.
    Quadratic(f64),
    /// The quartic of a torus.
    Quartic { major: f64, minor: f64 },
}

impl HitAccuracy {
    fn of(scene: &ValidScene, surface: &Surface) -> Self {
        let eye = scene.camera().eye;
        let (project_through_center, equation) = shape_facts(&surface.shape).formula(scene);
        let coordinates = eye
            .abs()
            .max_element()
            .max(project_through_center.abs().max_element());
        Self {
            coordinates,
            distance: eye.distance(project_through_center),
            equation,
        }
    }

    fn size(&self) -> f64 {
        match self.equation {
            EquationKind::Linear(size)
            | EquationKind::Quadratic(size)
            | EquationKind::Quartic { minor: size, .. } => size,
        }
    }

    /// The error of a point: the rounding of its coordinates, and that of the polynomial divided by
    /// its slope at the root.
    fn error(&self, unit: f64) -> f64 {
        let distance = self.distance;
        let polynomial = match self.equation {
            EquationKind::Linear(_) => distance,
            // The discriminant is known to u·d², and its root is about the radius.
            EquationKind::Quadratic(radius) => distance * (distance / radius).max(1.0),
            // The quartic is known to 16 u·d⁴, the sum of its terms' sizes; its slope is the
            // product of the distances to the other roots.
            EquationKind::Quartic { major, minor } => {
                let other = distance / (2.0 * (major + minor));
                16.0 * distance
                    * other.max(1.0)
                    * other.max(1.0)
                    * (distance / (2.0 * minor)).max(1.0)
            }
        };
        unit * (self.coordinates + polynomial)
    }

    /// The ratio of a symptom to the largest invisible one.
    fn excess(&self, symptom: Symptom, unit: f64, sends_rays: bool) -> f64 {
        match symptom {
            Symptom::SelfHit if sends_rays => self.error(unit) / MIN_HIT_DISTANCE,
            Symptom::Shape if !matches!(self.equation, EquationKind::Linear(_)) => {
                self.error(unit) / (VISIBLE * self.size())
            }
            Symptom::Skipped if sends_rays => MIN_HIT_DISTANCE / (SKIPPED * self.size()),
            Symptom::SelfHit | Symptom::Shape | Symptom::Skipped => 0.0,
        }
    }
}
