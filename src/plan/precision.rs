//! The expected precision losses of the non-robust arithmetics in a scene: first-order estimates
//! from sizes and distances.
//!
//! The estimates are for typical rays, which hit a surface near its middle. Errors are larger at
//! silhouettes.

use super::shape::shape_facts;
use super::{Arithmetic, facts};
use rtc_valid::{Mode, Surface, ValidScene};

/// The epsilon of the non-robust arithmetics, in world units: hits nearer than this are ignored as
/// self-intersections.
pub const MIN_HIT_DISTANCE: f64 = 1e-5;

/// The largest relative error of hit points on a curved surface that does not change its shading in
/// 8 bits.
const MAX_INVISIBLE_ERROR: f64 = 1.0 / 512.0;

/// The largest fraction of the size of a surface that may be skipped without visible effect.
const MAX_SKIPPED_FRACTION: f64 = 1.0 / 100.0;

/// The visible symptom of a precision loss.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PrecisionArtifact {
    /// Self-intersection: rays that leave a surface hit it again, so it shadows or reflects itself.
    SelfHit,
    /// Errors of the hit points of a curved surface change its shading.
    Shape,
    /// The surface is not much larger than the epsilon that rays skip.
    Skipped,
}

/// The precision loss of an arithmetic.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrecisionLoss {
    /// The surface with the strongest symptom: an index into [`ValidScene::surfaces`].
    pub surface: usize,
    /// The symptom there.
    pub symptom: PrecisionArtifact,
    /// The error of hit points on the surface, in world units.
    pub error: f64,
    /// The ratio of the error to the largest invisible error.
    pub excess: f64,
    /// The number of affected surfaces.
    pub surfaces: usize,
}

/// The expected precision loss of a scene with an arithmetic, if it is visible.
#[must_use]
pub fn loss(scene: &ValidScene, arithmetic: Arithmetic) -> Option<PrecisionLoss> {
    // Choose the unit roundoff of the arithmetic.
    let unit = match arithmetic {
        Arithmetic::Robust => return None,
        Arithmetic::Plain => f64::EPSILON / 2.0,
        Arithmetic::F32 => f64::from(f32::EPSILON) / 2.0,
    };
    // Find the worst symptom of each surface.
    let has_shadows = scene.settings().shadows && !facts::light::course(scene.lights()).is_empty();
    let losses = scene
        .surfaces()
        .iter()
        .enumerate()
        .filter_map(|(index, surface)| {
            let measure = HitAccuracy::of(scene, surface);
            let symptoms = [
                PrecisionArtifact::SelfHit,
                PrecisionArtifact::Shape,
                PrecisionArtifact::Skipped,
            ];
            let excess = symptoms.map(|symptom| {
                measure.excess(symptom, unit, sends_rays(scene, surface, has_shadows))
            });
            let worst = (0..3).max_by(|a, b| excess[*a].total_cmp(&excess[*b]))?;
            let (symptom, excess) = (symptoms[worst], excess[worst]);
            (excess > 1.0).then(|| PrecisionLoss {
                surface: index,
                symptom,
                error: measure.error(unit),
                excess,
                surfaces: 1,
            })
        });
    // Take the worst surface, and count all affected ones.
    losses.reduce(|worst, loss| {
        let surfaces = worst.surfaces + loss.surfaces;
        PrecisionLoss {
            surfaces,
            ..if loss.excess > worst.excess {
                loss
            } else {
                worst
            }
        }
    })
}

/// Whether rays start on a surface; `has_shadows` says whether lights cast shadows.
fn sends_rays(scene: &ValidScene, surface: &Surface, has_shadows: bool) -> bool {
    let settings = scene.settings();
    match settings.mode {
        Mode::Phong => {}
        Mode::Path(_) => return true,
        Mode::Normal | Mode::Gooch(_) | Mode::Depth => return false,
    }
    let phong = facts::material::shown_phong(scene.materials(), surface.material);
    let bounces = phong.most_mirror_weight() > 0.0 || phong.kt.get() > 0.0;
    has_shadows || settings.max_depth > 0 && bounces
}

/// The sizes that determine the accuracy of hits on a surface.
struct HitAccuracy {
    /// The largest coordinate at the eye or on the surface.
    coordinates: f64,
    /// The distance from the eye to the middle of the surface.
    distance: f64,
    equation: EquationKind,
}

/// The degree of the intersection equation of a surface, with the sizes that its error depends on.
pub(super) enum EquationKind {
    /// A plane: t is a quotient. The size of the surface, infinite if it is unbounded.
    Linear(f64),
    /// A quadric of this radius.
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

    /// The error of a hit point: the rounding of its coordinates, plus the rounding of the
    /// polynomial over its derivative at the root.
    fn error(&self, unit: f64) -> f64 {
        let distance = self.distance;
        let polynomial = match self.equation {
            EquationKind::Linear(_) => distance,
            // The error of the discriminant is u·d², and its square root is about the radius.
            EquationKind::Quadratic(radius) => distance * (distance / radius).max(1.0),
            // The error of the quartic is 16 u·d⁴, from the sum of its terms; its derivative is the
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

    /// The ratio of a symptom to the largest invisible symptom.
    fn excess(&self, symptom: PrecisionArtifact, unit: f64, sends_rays: bool) -> f64 {
        match symptom {
            PrecisionArtifact::SelfHit if sends_rays => self.error(unit) / MIN_HIT_DISTANCE,
            PrecisionArtifact::Shape if !matches!(self.equation, EquationKind::Linear(_)) => {
                self.error(unit) / (MAX_INVISIBLE_ERROR * self.size())
            }
            PrecisionArtifact::Skipped if sends_rays => {
                MIN_HIT_DISTANCE / (MAX_SKIPPED_FRACTION * self.size())
            }
            PrecisionArtifact::SelfHit | PrecisionArtifact::Shape | PrecisionArtifact::Skipped => {
                0.0
            }
        }
    }
}
