//! The BSDF of the glTF material, evaluated and sampled in a local frame.
//!
//! The frame has the shading normal as z. Directions are unit vectors that point away from the
//! surface; z < 0 is inside a body or behind a thin wall. `f` excludes the cosine. Paths carry
//! basic radiance L/n², so `f` has no factor n².
//!
//! - [`BsdfLobes`] holds the lobes of a surface point for one direction `wo` to the viewer, with
//!   the features `F` compiled in. It evaluates ([`BsdfEvaluation`]) and samples ([`BsdfSample`])
//!   the BSDF.
//! - `standard` builds the lobes from the parameters of the material; `coat`, `sheen`, `thin_film`
//!   add its layers.
//! - `microfacet`, `distribution` with `beckmann`, and `fresnel` are the specular lobes;
//!   `compensation` with the tables of `albedo` restores the energy of multiple scattering.
//! - `lobe_pdf` chooses a lobe, `warp` maps the unit square to directions, `optics` reflects and
//!   refracts.
//!
//! A BSDF reflects no more light than it receives, and `f` is reciprocal except for transmission;
//! `tests/bsdf` checks both, and the densities by χ² tests.

mod albedo;
mod beckmann;
mod coat;
mod compensation;
mod distribution;
pub(crate) mod fresnel;
mod lobe_pdf;
mod microfacet;
pub(crate) mod optics;
mod plastic;
mod sheen;
mod side;
pub(crate) mod standard;
mod thin_film;
pub(crate) mod warp;

pub use fresnel::dispersed;
pub use plastic::PlasticBoundary;

use crate::sampler::remapped;
use coat::CoatLayer;
use compensation::Compensation;
use lobe_pdf::LobePdf;
use microfacet::{LobeWeights, Microfacet, ScatteredDirection};
use plastic::PlasticBase;
use rtc_math::{Microfacets, Vec3};
use rtc_plan::{FeatureSet, PathFeatures};
use sheen::SheenFibres;
use side::Side;
use standard::{DiffuseTransmission, StandardParameters};
use std::f64::consts::FRAC_1_PI;
pub(super) use warp::direction_at_angle;
use warp::{cosine_density, cosine_direction};

pub(crate) const LAYERS: PathFeatures = PathFeatures::LAYERS;
pub(crate) const MICROFACETS: PathFeatures = PathFeatures::MICROFACETS;
pub(crate) const TRANSMISSION: PathFeatures = PathFeatures::TRANSMISSION;

/// Whether the features `F` hold one: known at compile time.
pub(crate) const fn can<const F: u32>(feature: PathFeatures) -> bool {
    FeatureSet(F).contains(feature)
}

/// A direction on the other side of the surface.
fn mirrored(w: Vec3) -> Vec3 {
    Vec3::new(w.x, w.y, -w.z)
}

/// The albedo of the base where no microfacet reflects, and its diffuse transmittance. Of the parts
/// of a material by `metallic`, `transmission` and diffuse transmission each has its own fraction
/// of the light, so that all together keep what they get.
fn base<const F: u32>(standard: &StandardParameters<'_>) -> (Vec3, Option<Vec3>) {
    let scattered = (1.0 - standard.metallic) * (1.0 - standard.transmission);
    let diffuse = standard.base_color * scattered;
    match standard.diffuse_transmission.filter(|_| can::<F>(LAYERS)) {
        None => (diffuse, None),
        Some(DiffuseTransmission { factor, color }) => {
            (diffuse * (1.0 - factor), Some(color * (scattered * factor)))
        }
    }
}

/// The BSDF for one pair of directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BsdfEvaluation {
    /// The BSDF without its delta lobes.
    pub f: Vec3,
    /// The density per solid angle with which [`Bsdf::sample`] takes the direction.
    pub pdf: f64,
}

impl BsdfEvaluation {
    const NONE: Self = Self {
        f: Vec3::ZERO,
        pdf: 0.0,
    };
}

/// A sampled direction. Its radiance is weighted by `f·|cos θ|/pdf`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BsdfSample {
    /// The direction light comes from.
    pub wi: Vec3,
    /// The BSDF; of a delta lobe, the scattered fraction divided by |cos θ|.
    pub f: Vec3,
    /// The density per solid angle; of a delta lobe, its probability.
    pub pdf: f64,
    /// Whether the direction comes from a delta lobe, which light sampling cannot find.
    pub delta: bool,
}

/// The BSDF with all lobes.
pub type Bsdf<'world> = BsdfLobes<'world, { PathFeatures::EVERYTHING.0 }>;

/// The lobes of the material at a point, for one `wo`. Compiled for the [`PathFeatures`] `F`: the
/// material must not need any other feature.
#[derive(Clone, Copy, Debug)]
pub struct BsdfLobes<'world, const F: u32> {
    side: Side,
    wo: Vec3,
    microfacet: Microfacet<F>,
    /// The albedo of the base where no microfacet reflects.
    diffuse: Vec3,
    /// Its diffuse transmittance.
    through: Option<Vec3>,
    /// Whether no boundary covers the base: seen from inside of the body, the boundary is that of
    /// the part that transmits.
    is_bare: bool,
    compensation: Option<Compensation>,
    /// The base below the boundary of a plastic, instead of `diffuse`.
    plastic: Option<PlasticBase<'world>>,
    sheen: Option<SheenFibres>,
    coat: Option<CoatLayer>,
    lobe_pdf: LobePdf,
}

impl<'world, const F: u32> BsdfLobes<'world, F> {
    /// The material seen from `wo`.
    #[must_use]
    #[inline]
    pub fn new(standard: &StandardParameters<'world>, wo: Vec3) -> Self {
        let along = standard
            .anisotropy
            .map_or([1.0, 0.0], |anisotropy| anisotropy.direction);
        let side = Side {
            below: wo.z < 0.0,
            along,
        };
        let wo = side.enter(wo);
        let transmits = can::<F>(TRANSMISSION) && standard.transmission > 0.0;
        let inside = side.below && !standard.thin_walled && transmits;
        let mut microfacet = Microfacet::new(standard, inside);
        // Sheen and coat are invisible from inside the body.
        let (sheen, clearcoat) = if inside || !can::<F>(LAYERS) {
            (None, None)
        } else {
            (standard.sheen, standard.clearcoat)
        };
        let coat = clearcoat.and_then(|coat| {
            let sign = if side.below { -1.0 } else { 1.0 };
            CoatLayer::new(&coat, side.enter(coat.normal * sign), wo)
        });
        let (mut diffuse, mut through) = base::<F>(standard);
        // The tables of further bounces are those of glTF's facets.
        let multiple = standard.multiple_scattering && standard.facets == Microfacets::Ggx;
        let plastic = microfacet.plastic(standard, wo).filter(|_| !inside);
        let covers = !inside && !microfacet.is_dark() && plastic.is_none();
        let compensation = (covers && multiple).then(|| microfacet.compensation(wo));
        if covers && !multiple {
            let share = microfacet.grazing_share(wo);
            diffuse *= share;
            through = through.map(|through| through * share);
        }
        // The half-way vector is seldom as grazing as the view.
        let entering = || microfacet.weights(1.0).entering;
        let (entering, bounces) = match &compensation {
            None if inside => (1.0, Vec3::ZERO),
            None => (entering(), Vec3::ZERO),
            Some(compensation) => (compensation.base_albedo(), compensation.albedo()),
        };
        if multiple {
            microfacet.compensate(wo, bounces.max_element());
        }
        let sheen = sheen.and_then(|sheen| SheenFibres::new(&sheen, wo));
        let base = match &plastic {
            None => diffuse * entering + bounces,
            Some(plastic) => plastic.albedo(),
        };
        let lobe_pdf = LobePdf::new(
            base,
            through.map_or(Vec3::ZERO, |through| through * entering),
            &microfacet.weights(wo.z),
            sheen.as_ref(),
            coat.as_ref(),
        );
        Self {
            side,
            wo,
            microfacet,
            diffuse,
            through,
            is_bare: inside,
            compensation,
            plastic,
            sheen,
            coat,
            lobe_pdf,
        }
    }

    /// The clearcoat; `None` at compile time without the feature for layers.
    #[inline]
    fn coat(&self) -> Option<&CoatLayer> {
        self.coat.as_ref().filter(|_| can::<F>(LAYERS))
    }

    /// The sheen, as [`Self::coat`].
    #[inline]
    fn sheen(&self) -> Option<&SheenFibres> {
        self.sheen.as_ref().filter(|_| can::<F>(LAYERS))
    }

    /// The light of multiple bounces between microfacets.
    #[inline]
    fn compensation(&self) -> Option<&Compensation> {
        self.compensation.as_ref().filter(|_| can::<F>(MICROFACETS))
    }

    /// The base of a plastic.
    #[inline]
    fn plastic(&self) -> Option<&PlasticBase<'world>> {
        self.plastic.as_ref().filter(|_| can::<F>(MICROFACETS))
    }

    /// Whether the boundary reflects.
    pub(super) fn reflects(&self) -> bool {
        !self.microfacet.is_dark()
    }

    /// Whether the light of multiple bounces between microfacets is added.
    pub(super) fn compensates(&self) -> bool {
        self.compensation().is_some()
    }

    /// The diffuse transmittance, as [`Self::coat`].
    #[inline]
    fn through(&self) -> Option<Vec3> {
        self.through.filter(|_| can::<F>(LAYERS))
    }

    /// Whether all lobes are delta lobes, so that light sampling is useless.
    #[must_use]
    pub fn is_delta(&self) -> bool {
        let coat = self.coat().is_none_or(CoatLayer::is_smooth);
        let is_diffuse = self.lobe_pdf.cosine + self.lobe_pdf.through != 0.0;
        !is_diffuse && self.microfacet.is_smooth() && coat
    }

    /// The BSDF for light from `wi`, and the density with which [`Bsdf::sample`] samples `wi`.
    #[must_use]
    pub fn evaluate(&self, wi: Vec3) -> BsdfEvaluation {
        self.evaluate_entered(self.side.enter(wi))
    }

    /// The BSDF of [`Self::evaluate`] alone: for lights that [`Bsdf::sample`] cannot find.
    #[must_use]
    pub(super) fn f(&self, wi: Vec3) -> Vec3 {
        self.evaluate_entered(self.side.enter(wi)).f
    }

    /// Inlined, so that an unused density is not computed.
    #[inline(always)]
    fn evaluate_entered(&self, wi: Vec3) -> BsdfEvaluation {
        let above = wi.z > 0.0;
        if wi.z == 0.0 || self.wo.z == 0.0 {
            return BsdfEvaluation::NONE;
        }
        // Evaluate the microfacets and the base.
        let mut sum = if above {
            self.reflected(wi)
        } else {
            self.microfacet.through(self.wo, wi)
        };
        // Average the densities of the lobes.
        sum.pdf *= self.lobe_pdf.microfacet;
        if above {
            sum.pdf += self.lobe_pdf.cosine * cosine_density(wi);
        } else if let Some(through) = self.through() {
            let mirrored = mirrored(wi);
            sum.f += through * self.base_f(mirrored);
            sum.pdf += self.lobe_pdf.through * cosine_density(mirrored);
        }
        // Add the layers, from the inside out.
        if let Some(sheen) = self.sheen() {
            sum.f = sheen.over(sum.f, self.wo, wi);
        }
        if let Some(coat) = self.coat() {
            let (f, pdf) = if above { coat.evaluate(wi) } else { (0.0, 0.0) };
            sum.f = sum.f.lerp(Vec3::splat(f), coat.weight);
            sum.pdf += self.lobe_pdf.coat * pdf;
        }
        sum
    }

    /// The BSDF of a white base, which transmits like it reflects: by the direction reflected to
    /// the side of the viewer.
    fn base_f(&self, wi: Vec3) -> f64 {
        match (self.compensation(), self.plastic()) {
            (Some(compensation), _) => {
                compensation.base_f(compensation.towards(wi), self.microfacet.uneven(wi))
            }
            (None, Some(plastic)) => plastic.through_f(wi),
            (None, None) => {
                let h = (self.wo + wi).normalize();
                self.entering_f(&self.microfacet.weights(self.wo.dot(h)))
            }
        }
    }

    /// The BSDF of a white base below a boundary that lets so much light in.
    fn entering_f(&self, weights: &LobeWeights) -> f64 {
        if self.is_bare {
            FRAC_1_PI
        } else {
            weights.entering * FRAC_1_PI
        }
    }

    /// The reflection of the microfacets and of the diffuse base, with the density of the
    /// microfacets.
    fn reflected(&self, wi: Vec3) -> BsdfEvaluation {
        if self.microfacet.is_dark() {
            // All light reaches the base.
            return BsdfEvaluation {
                f: self.diffuse * FRAC_1_PI,
                pdf: 0.0,
            };
        }
        // Evaluate the microfacet lobe at the half vector.
        let h = (self.wo + wi).normalize();
        let weights = self.microfacet.weights(self.wo.dot(h));
        let mut sum = self.microfacet.reflected(self.wo, wi, h, &weights);
        // Add the diffuse base, and the multiple bounces.
        if let Some(plastic) = self.plastic() {
            sum.f += plastic.f(wi);
            return sum;
        }
        sum.f += match self.compensation() {
            None => self.diffuse * self.entering_f(&weights),
            Some(compensation) => {
                let e = compensation.towards(wi);
                let uneven = self.microfacet.uneven(wi);
                self.diffuse * compensation.base_f(e, uneven) + compensation.bounces_f(e)
            }
        };
        sum
    }

    /// Samples a direction with two numbers in [0, 1); `None` if the direction is invalid.
    ///
    /// The first one chooses the lobe, too, so that the points of each lobe stay stratified. A
    /// third one, also in [0, 1), is drawn where microfacets both reflect and transmit.
    #[must_use]
    #[inline(always)]
    pub fn sample(&self, u: [f64; 2], third: impl FnOnce() -> f64) -> Option<BsdfSample> {
        let LobePdf {
            cosine,
            microfacet,
            through,
            coat,
        } = self.lobe_pdf;
        let rest = |left: f64, probability: f64| [remapped(left, probability), u[1]];
        // Sample the diffuse lobe.
        if u[0] < cosine {
            return self.glossy_sample(cosine_direction(rest(u[0], cosine)));
        }
        // Sample the microfacets: reflection or transmission.
        let left = u[0] - cosine;
        if left < microfacet {
            let u = rest(left, microfacet);
            return match self.microfacet.sample(self.wo, u, third)? {
                ScatteredDirection::Lobe(wi) => self.glossy_sample(wi),
                ScatteredDirection::Single(wi, weight, pdf) => {
                    let left = self.sheen().map_or(1.0, |sheen| sheen.left_for(wi));
                    let covered = self.coat().map_or(0.0, |coat| coat.weight);
                    self.single(wi, weight * (left * (1.0 - covered)), microfacet * pdf)
                }
            };
        }
        // Sample the diffuse transmission.
        let left = left - microfacet;
        if self.through().is_some() && left < through {
            return self.glossy_sample(mirrored(cosine_direction(rest(left, through))));
        }
        // Sample the coat.
        let layer = self.coat()?;
        let wi = layer.sample(rest(left - through, coat))?;
        match layer.is_smooth() {
            _ if wi.z <= 0.0 => None,
            true => self.single(wi, Vec3::splat(layer.weight), coat),
            false => self.glossy_sample(wi),
        }
    }

    /// The direction of the light that the smooth boundary reflects or transmits to the viewer, and
    /// the fraction that it scatters so; `None` for a rough boundary and for total reflection.
    pub(super) fn smooth(&self, transmits: bool) -> Option<(Vec3, Vec3)> {
        let (wi, fraction) = self.microfacet.smooth(self.wo, transmits)?;
        let left = self.sheen().map_or(1.0, |sheen| sheen.left_for(wi));
        let covered = self.coat().map_or(0.0, |coat| coat.weight);
        Some((self.side.leave(wi), fraction * (left * (1.0 - covered))))
    }

    fn glossy_sample(&self, wi: Vec3) -> Option<BsdfSample> {
        let BsdfEvaluation { f, pdf } = self.evaluate_entered(wi);
        // A denormal density has no reciprocal.
        (pdf >= f64::MIN_POSITIVE).then(|| BsdfSample {
            wi: self.side.leave(wi),
            f,
            pdf,
            delta: false,
        })
    }

    fn single(&self, wi: Vec3, scattered: Vec3, pdf: f64) -> Option<BsdfSample> {
        let f = scattered / wi.z.abs();
        (wi.z != 0.0 && pdf > 0.0).then(|| BsdfSample {
            wi: self.side.leave(wi),
            f,
            pdf,
            delta: true,
        })
    }
}
