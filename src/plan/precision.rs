//! What the plain arithmetics would lose in a scene: first-order estimates from its own sizes and
//! distances.
//!
//! An estimate is of typical rays, those that meet a surface near its middle; at outlines errors
//! are larger.

use super::shape::shape_facts;
use super::{Arithmetic, facts};
use crate::valid::{Mode, Phong, Proof, Surface};

/// The plain arithmetics take hits nearer than this, in units of the world, for the surface the ray
/// starts on.
pub const NEAREST: f64 = 1e-5;

/// The largest part of the size of a curved surface that its points may be off before its shading
/// shows it in 8 bits.
const VISIBLE: f64 = 1.0 / 512.0;

/// The largest part of the size of a surface that may be skipped before it shows.
const SKIPPED: f64 = 1.0 / 100.0;

/// How a loss shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Symptom {
    /// Rays that leave a surface meet it again: it shades or mirrors itself.
    SelfHit,
    /// The points of a curved surface are so far off that its shading is wrong.
    Shape,
    /// The surface is hardly larger than what is skipped before each ray.
    Skipped,
}

/// What an arithmetic loses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Loss {
    /// The surface that shows it most: an index into [`Proof::surfaces`].
    pub surface: usize,
    /// How it shows there.
    pub symptom: Symptom,
    /// How far points of the surface are off, in units of the world.
    pub error: f64,
    /// How many times too large that is.
    pub excess: f64,
    /// How many surfaces lose something.
    pub surfaces: usize,
}

/// What a scene loses by an arithmetic, if anything is expected to show.
#[must_use]
pub fn loss(scene: &Proof, arithmetic: Arithmetic) -> Option<Loss> {
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
            let measure = Measure::of(scene, surface);
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
fn sends_rays(scene: &Proof, surface: &Surface, is_lit: bool) -> bool {
    let settings = scene.settings();
    match settings.mode {
        Mode::Phong => {}
        Mode::Path(_) => return true,
        Mode::Normal | Mode::Gooch(_) | Mode::Zbuffer => return false,
    }
    let Phong { ks, kt, .. } = facts::material::phong(&scene.materials()[surface.material]);
    is_lit || settings.max_depth > 0 && (ks.get() > 0.0 || kt.get() > 0.0)
}

/// What decides how well rays can meet a surface.
struct Measure {
    /// The size of the coordinates that rays start and end with.
    coordinates: f64,
    /// From the eye to the middle of the surface.
    distance: f64,
    form: Formula,
}

/// What a surface is to a formula, with the sizes that divide its error.
pub(super) enum Formula {
    /// Flat: t is one quotient. Of this size, or without an end.
    Flat(f64),
    /// A quadratic, of this radius.
    Round(f64),
    /// The quartic of a torus.
    Torus { major: f64, minor: f64 },
}

impl Measure {
    fn of(scene: &Proof, surface: &Surface) -> Self {
        let eye = scene.camera().eye;
        let (middle, form) = shape_facts(&surface.shape).formula(scene);
        let coordinates = eye.abs().max_element().max(middle.abs().max_element());
        Self {
            coordinates,
            distance: eye.distance(middle),
            form,
        }
    }

    fn size(&self) -> f64 {
        match self.form {
            Formula::Flat(size) | Formula::Round(size) | Formula::Torus { minor: size, .. } => size,
        }
    }

    /// How far off a point is: the rounding of its coordinates, and that of the polynomial over its
    /// slope at the root.
    fn error(&self, unit: f64) -> f64 {
        let distance = self.distance;
        let polynomial = match self.form {
            Formula::Flat(_) => distance,
            // The discriminant is known to u·d², and its root is about the radius.
            Formula::Round(radius) => distance * (distance / radius).max(1.0),
            // The quartic is known to 16 u·d⁴, the sum of its terms' sizes; its slope is the
            // product of the distances to the other roots.
            Formula::Torus { major, minor } => {
                let other = distance / (2.0 * (major + minor));
                16.0 * distance
                    * other.max(1.0)
                    * other.max(1.0)
                    * (distance / (2.0 * minor)).max(1.0)
            }
        };
        unit * (self.coordinates + polynomial)
    }

    /// How many times larger than bearable a symptom is.
    fn excess(&self, symptom: Symptom, unit: f64, sends_rays: bool) -> f64 {
        match symptom {
            Symptom::SelfHit if sends_rays => self.error(unit) / NEAREST,
            Symptom::Shape if !matches!(self.form, Formula::Flat(_)) => {
                self.error(unit) / (VISIBLE * self.size())
            }
            Symptom::Skipped if sends_rays => NEAREST / (SKIPPED * self.size()),
            Symptom::SelfHit | Symptom::Shape | Symptom::Skipped => 0.0,
        }
    }
}
