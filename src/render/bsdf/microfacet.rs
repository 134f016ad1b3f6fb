//! The microfacet lobes of a rough interface: reflection, and transmission for dielectrics.

use super::albedo::dielectric;
use super::compensation::{Compensation, Covering, grazing_share};
use super::distribution::FacetDistribution;
use super::fresnel::{Curve, Fresnel, normal_reflectance, refracted_cosine};
use super::plastic::PlasticBase;
use super::standard::StandardParameters;
use super::thin_film::ThinFilm;
use super::{BsdfEvaluation, LAYERS, MICROFACETS, TRANSMISSION, can};
use rtc_math::{ComplexIndex, Vec3};

/// The boundary seen from one side, with z towards that side.
#[derive(Clone, Copy, Debug)]
pub(super) struct Microfacet<const F: u32> {
    facets: FacetDistribution,
    smooth: bool,
    dark: bool,
    /// The reflectance of the dielectric part at normal and at grazing incidence.
    f0: Vec3,
    f90: f64,
    /// The reflectance of the metallic part at normal incidence; at grazing incidence it is 1.
    /// Where the metal has an index, this is a factor.
    metal: Vec3,
    /// Its index, of which `metal` is a factor.
    conductor: Option<ComplexIndex>,
    metallic: f64,
    /// The colour of the mirror image of a plastic, if it is one.
    plastic: Option<Vec3>,
    /// The thin film on both, and the fraction of the surface it covers.
    film: Option<(ThinFilm, f64)>,
    /// The fraction of the light in the dielectric that is transmitted, by channel.
    tint: Vec3,
    intersection: BoundaryCrossing,
    /// Whether it is a smooth pane that reflects light inside it.
    is_pane: bool,
    /// The index beyond divided by that on the side of the viewer.
    eta: f64,
    /// The index inside, if the material transmits: its reflectance is that of a dielectric.
    ior: Option<f64>,
    /// The factors of the reflection of the dielectric and of the transmission: they make up for
    /// the light of further bounces, and from inside only the part that transmits reflects.
    gain: [f64; 2],
}

/// How light continues behind the boundary.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum BoundaryCrossing {
    /// Through a thin wall: the reflected direction, reflected to the other side.
    Wall,
    /// Into a medium of the same index.
    Straight,
    /// Into a medium of another index.
    Refracted,
}

/// The fractions of light that a microfacet reflects and transmits at one angle.
#[derive(Clone, Copy, Debug)]
pub(super) struct LobeWeights {
    /// Reflected.
    pub(super) reflected: Vec3,
    /// Enters the dielectric part.
    pub(super) entering: f64,
    /// Transmitted.
    pub(super) through: Vec3,
}

impl LobeWeights {
    /// The probability of sampling the reflection.
    fn lobe_pdf(&self) -> f64 {
        let (reflected, through) = (self.reflected.max_element(), self.through.max_element());
        if through > 0.0 {
            reflected / (reflected + through)
        } else {
            1.0
        }
    }
}

/// A sampled direction of the microfacets.
pub(super) enum ScatteredDirection {
    /// A direction of a rough lobe.
    Lobe(Vec3),
    /// A single one, with the fraction of the light and the probability of taking it.
    Single(Vec3, Vec3, f64),
}

impl<const F: u32> Microfacet<F> {
    /// A boundary that lets all light through to the base.
    const NONE: Self = Self {
        facets: FacetDistribution::ROUGH,
        smooth: false,
        dark: true,
        f0: Vec3::ZERO,
        f90: 0.0,
        metal: Vec3::ZERO,
        conductor: None,
        metallic: 0.0,
        plastic: None,
        film: None,
        tint: Vec3::ZERO,
        intersection: BoundaryCrossing::Wall,
        is_pane: false,
        eta: 1.0,
        ior: None,
        gain: [1.0; 2],
    };

    /// The boundary of a material, seen from within the body if `inside`.
    #[inline]
    pub(super) fn new(standard: &StandardParameters<'_>, inside: bool) -> Self {
        if !can::<F>(MICROFACETS) {
            return Self::NONE;
        }
        // Choose the distribution of normals.
        let facets = match standard.anisotropy {
            None => FacetDistribution::isotropic(standard.roughness),
            Some(anisotropy) => {
                FacetDistribution::anisotropic(standard.roughness, anisotropy.strength)
            }
        };
        let facets = facets.of_model(standard.facets);
        // Add the thin film, if any.
        let film = standard
            .iridescence
            .filter(|film| can::<F>(LAYERS) && film.thickness > 0.0);
        let film = film.map(|film| {
            (
                ThinFilm {
                    ior: film.ior,
                    thickness: film.thickness,
                },
                film.factor,
            )
        });
        // Decide whether and how light is transmitted.
        let transmits = can::<F>(TRANSMISSION) && standard.transmission > 0.0;
        let ior = if standard.ior > 0.0 {
            standard.ior
        } else {
            1.0
        };
        let plastic = standard
            .plastic
            .map(|_| (standard.specular_color * standard.specular).min(Vec3::ONE));
        let dark = standard.specular == 0.0
            && standard.metallic == 0.0
            && film.is_none()
            && plastic.is_none()
            && !inside;
        let intersection = match standard.thin_walled {
            true => BoundaryCrossing::Wall,
            false if (ior - 1.0).abs() < NEARLY_STRAIGHT => BoundaryCrossing::Straight,
            false => BoundaryCrossing::Refracted,
        };
        Self {
            facets,
            smooth: facets.is_smooth(),
            dark,
            f0: standard.dielectric_f0(),
            f90: standard.specular,
            metal: standard.base_color,
            conductor: standard.conductor,
            metallic: standard.metallic,
            plastic,
            film,
            tint: standard.base_color * standard.transmitting(),
            intersection,
            is_pane: transmits
                && standard.has_two_faces
                && standard.thin_walled
                && facets.is_smooth(),
            eta: if inside { 1.0 / ior } else { ior },
            ior: transmits.then_some(ior),
            gain: [if inside { standard.transmission } else { 1.0 }, 1.0],
        }
    }

    /// The film; `None` at compile time without the feature for layers.
    #[inline]
    fn film(&self) -> Option<(ThinFilm, f64)> {
        if can::<F>(LAYERS) { self.film } else { None }
    }

    #[inline]
    fn dielectric(&self) -> Fresnel {
        if let Some(color) = self.plastic {
            let ior = self.eta.max(1.0 / self.eta);
            return Fresnel {
                f0: color * normal_reflectance(ior),
                f90: color,
                curve: Curve::Dielectric(ior),
                film: self.film(),
            };
        }
        Fresnel {
            f0: self.f0,
            f90: Vec3::splat(self.f90),
            curve: match self.ior.filter(|_| can::<F>(TRANSMISSION)) {
                Some(ior) => Curve::Dielectric(ior),
                None => Curve::Schlick,
            },
            film: self.film(),
        }
    }

    #[inline]
    fn metal(&self) -> Fresnel {
        match self.conductor {
            None => Fresnel {
                f0: self.metal,
                f90: Vec3::ONE,
                curve: Curve::Schlick,
                film: self.film(),
            },
            Some(index) => Fresnel {
                f0: index.reflectance(1.0) * self.metal,
                f90: self.metal,
                curve: Curve::Conductor(index, self.metal),
                film: self.film(),
            },
        }
    }

    /// The factor of the base, where that light is left out.
    pub(super) fn grazing_share(&self, wo: Vec3) -> f64 {
        grazing_share(&self.covering(), wo)
    }

    fn covering(&self) -> Covering {
        Covering {
            facets: self.facets,
            dielectric: self.dielectric(),
            is_pane: self.is_pane,
        }
    }

    /// The light of multiple bounces between the microfacets.
    pub(super) fn compensation(&self, wo: Vec3) -> Compensation {
        let (fresnel, uneven) = ([&self.dielectric(), &self.metal()], self.uneven(wo));
        Compensation::new(self.facets, wo, fresnel, self.metallic, uneven)
    }

    /// The reflectance of the dielectric towards a direction, where it does not follow Schlick's
    /// curve: of a film, and of a pane; else 0.
    #[inline]
    pub(super) fn uneven(&self, w: Vec3) -> f64 {
        if self.film().is_some() || self.is_pane {
            self.dielectric_at(w.z).max_element()
        } else {
            0.0
        }
    }

    /// The base below the boundary of a plastic.
    pub(super) fn plastic<'world>(
        &self,
        standard: &StandardParameters<'world>,
        wo: Vec3,
    ) -> Option<PlasticBase<'world>> {
        let boundary = standard.plastic.filter(|_| can::<F>(MICROFACETS))?;
        let through = standard.diffuse_transmission.filter(|_| can::<F>(LAYERS));
        let scattered = (1.0 - standard.metallic)
            * (1.0 - standard.transmission)
            * (1.0 - through.map_or(0.0, |through| through.factor));
        let is_prepared = self.film().is_none()
            && self.facets.is_isotropic()
            && !self.is_pane
            && boundary.is_of(standard.roughness);
        let covering = (!is_prepared).then(|| self.covering());
        let color = standard.base_color;
        Some(PlasticBase::new(boundary, color, scattered, covering, wo))
    }

    /// Whether its lobes are delta lobes.
    pub(super) fn is_smooth(&self) -> bool {
        self.smooth
    }

    /// Whether it reflects no light.
    pub(super) fn is_dark(&self) -> bool {
        !can::<F>(MICROFACETS) || self.dark
    }

    /// The weights of a microfacet whose normal has this cosine to the light.
    pub(super) fn weights(&self, cosine: f64) -> LobeWeights {
        if self.is_dark() {
            return LobeWeights {
                reflected: Vec3::ZERO,
                entering: 1.0,
                through: self.tint,
            };
        }
        let dielectric = self.dielectric_at(cosine);
        let entering = 1.0 - dielectric.max_element();
        let dielectric = dielectric * self.gain[0];
        LobeWeights {
            reflected: match self.metallic {
                0.0 => dielectric,
                metallic => dielectric.lerp(self.metal().at(cosine), metallic),
            },
            entering,
            through: self.tint * (entering * self.gain[1]),
        }
    }

    /// Compensates for the multiply scattered light of a rough dielectric at a cosine: from outside
    /// in the transmission, which is the rest after single and further (`bounces`) reflections;
    /// from inside in both. After Turquin, "Practical multiple scattering compensation for
    /// microfacet models" (2019).
    pub(super) fn compensate(&mut self, wo: Vec3, bounces: f64) {
        let is_rough = can::<F>(TRANSMISSION) && !self.smooth;
        let is_straight = self.intersection == BoundaryCrossing::Straight;
        let Some(ior) = self.ior.filter(|_| is_rough && !is_straight) else {
            return;
        };
        let [reflected, through] = match self.facets.is_isotropic() && self.film().is_none() {
            true => self.tabulated(ior, wo.z),
            false => self.integrated(wo),
        };
        if self.eta < 1.0 {
            let whole = reflected + through;
            self.gain = self.gain.map(|gain| gain / whole);
        } else if through > 0.0 {
            self.gain[1] = ((1.0 - reflected - bounces) / through).max(0.0);
        }
    }

    /// The light that the facets of the dielectric reflect and transmit once, by the tables; from
    /// inside, both together.
    fn tabulated(&self, ior: f64, cosine: f64) -> [f64; 2] {
        let roughness = self.facets.mean_roughness();
        let Fresnel { f0, f90, .. } = self.dielectric();
        let [f0, f90] = [f0, f90].map(Vec3::max_element);
        if self.eta < 1.0 {
            return [dielectric::inside(ior, roughness, cosine).at(f0, f90), 0.0];
        }
        let [reflected, refracted] = dielectric::outside(ior, roughness, cosine);
        let through = match self.intersection {
            BoundaryCrossing::Refracted => refracted,
            BoundaryCrossing::Wall | BoundaryCrossing::Straight => reflected,
        };
        let single = through.whole() - through.at(f0, f90);
        [reflected.at(f0, f90), single]
    }

    /// The same for facets without tables, over a lattice of visible normals.
    #[inline(never)]
    fn integrated(&self, wo: Vec3) -> [f64; 2] {
        /// The error is about one per cent.
        const NORMALS: u32 = 128;
        /// The inverse of the golden ratio.
        const GOLDEN: f64 = 0.618_033_988_749_894_9;
        let mut sum = [0.0; 2];
        for k in 0..NORMALS {
            let k = f64::from(k) + 0.5;
            let u = [k / f64::from(NORMALS), (k * GOLDEN).fract()];
            let h = self.facets.visible_normal(wo, u);
            let cosine = wo.dot(h);
            let reflectance = self.dielectric_at(cosine).max_element();
            let reflected = h * (2.0 * cosine) - wo;
            if reflected.z > 0.0 {
                sum[0] += reflectance * self.facets.unhidden(wo, reflected);
            }
            let through = self.transmitted(wo, h, cosine);
            if let Some(wi) = through.filter(|wi| wi.z < 0.0) {
                let towards = match self.intersection {
                    BoundaryCrossing::Refracted => wi,
                    BoundaryCrossing::Wall | BoundaryCrossing::Straight => reflected,
                };
                sum[1] += (1.0 - reflectance) * self.facets.unhidden(wo, towards);
            }
        }
        sum.map(|sum| sum / f64::from(NORMALS))
    }

    /// The Fresnel reflectance of the dielectric. Schlick's formula takes the angle in the medium
    /// of the lower index; beyond the critical angle the reflectance is 1. A pane sends back
    /// `R + T²R + T²R³ + … = 2R/(1 + R)` (Pharr, Jakob, Humphreys, §9.5.1).
    fn dielectric_at(&self, cosine: f64) -> Vec3 {
        if self.is_pane {
            let face = self.dielectric().at(cosine);
            return face * 2.0 / (Vec3::ONE + face);
        }
        if self.eta >= 1.0 {
            return self.dielectric().at(cosine);
        }
        refracted_cosine(cosine, self.eta).map_or(Vec3::ONE, |cosine| self.dielectric().at(cosine))
    }

    /// The reflection lobe: `wi` is above the surface.
    pub(super) fn reflected(
        &self,
        wo: Vec3,
        wi: Vec3,
        h: Vec3,
        weights: &LobeWeights,
    ) -> BsdfEvaluation {
        if self.smooth {
            return BsdfEvaluation::NONE;
        }
        let density = self.facets.density(h);
        let f = weights.reflected * (density * self.facets.visibility(wo, wi));
        BsdfEvaluation {
            f,
            pdf: weights.lobe_pdf() * 0.5 * density / (wo.z + self.facets.lambda_root(wo)),
        }
    }

    /// The transmission lobe: `wi` is below the surface.
    pub(super) fn through(&self, wo: Vec3, wi: Vec3) -> BsdfEvaluation {
        if !can::<F>(TRANSMISSION) || self.smooth || self.tint == Vec3::ZERO {
            return BsdfEvaluation::NONE;
        }
        match self.intersection {
            BoundaryCrossing::Straight => BsdfEvaluation::NONE,
            BoundaryCrossing::Wall => {
                let mirrored = Vec3::new(wi.x, wi.y, -wi.z);
                let h = (wo + mirrored).normalize();
                let weights = self.weights(wo.dot(h));
                let f = weights.through
                    * (self.facets.density(h) * self.facets.visibility(wo, mirrored));
                BsdfEvaluation {
                    f,
                    pdf: (1.0 - weights.lobe_pdf()) * self.facets.vndf_pdf(wo, h) / 4.0,
                }
            }
            BoundaryCrossing::Refracted => self.refracted(wo, wi),
        }
    }

    /// The refraction lobe (Walter et al., "Microfacet models for refraction through rough
    /// surfaces" (EGSR 2007), equation 21).
    fn refracted(&self, wo: Vec3, wi: Vec3) -> BsdfEvaluation {
        // Find the generalized half vector.
        let half = wo + wi * self.eta;
        let h = (half * half.z.signum()).normalize_or_zero();
        let (o, i) = (wo.dot(h), wi.dot(h));
        if o <= 0.0 || i >= 0.0 {
            return BsdfEvaluation::NONE;
        }
        let weights = self.weights(o);
        // Jacobian dω_h/dω_i: |ω_i·h|/(ω_i·h + ω_o·h/η)².
        let root = i + o / self.eta;
        let turn = -i / (root * root);
        let f = weights.through
            * (4.0 * self.facets.density(h) * self.facets.visibility(wo, wi) * o * turn);
        BsdfEvaluation {
            f,
            pdf: (1.0 - weights.lobe_pdf()) * self.facets.vndf_pdf(wo, h) * o * turn,
        }
    }

    /// Samples a direction by a visible normal; `None` if the direction is on the wrong side.
    /// `u_lobe` is evaluated where light is both reflected and transmitted.
    pub(super) fn sample(
        &self,
        wo: Vec3,
        u: [f64; 2],
        u_lobe: impl FnOnce() -> f64,
    ) -> Option<ScatteredDirection> {
        // Sample the visible normal.
        let h = if self.smooth {
            Vec3::Z
        } else {
            self.facets.visible_normal(wo, u)
        };
        let cosine = wo.dot(h);
        let weights = self.weights(cosine);
        let lobe_pdf = weights.lobe_pdf();
        // Reflect at the microfacet.
        if lobe_pdf >= 1.0 || u_lobe() < lobe_pdf {
            let wi = h * (2.0 * cosine) - wo;
            let direction = if self.smooth {
                ScatteredDirection::Single(wi, weights.reflected, lobe_pdf)
            } else {
                ScatteredDirection::Lobe(wi)
            };
            return (wi.z > 0.0).then_some(direction);
        }
        // Or transmit through it.
        let wi = self.transmitted(wo, h, cosine)?;
        let single = self.smooth || self.intersection == BoundaryCrossing::Straight;
        let direction = if single {
            ScatteredDirection::Single(wi, weights.through, 1.0 - lobe_pdf)
        } else {
            ScatteredDirection::Lobe(wi)
        };
        (wi.z < 0.0).then_some(direction)
    }

    /// The direction through a microfacet with the normal `h`; `None` for total reflection.
    #[inline]
    fn transmitted(&self, wo: Vec3, h: Vec3, cosine: f64) -> Option<Vec3> {
        Some(match self.intersection {
            BoundaryCrossing::Straight => -wo,
            BoundaryCrossing::Wall => {
                let mirrored = h * (2.0 * cosine) - wo;
                Vec3::new(mirrored.x, mirrored.y, -mirrored.z)
            }
            BoundaryCrossing::Refracted => {
                h * (cosine / self.eta - refracted_cosine(cosine, self.eta)?) - wo / self.eta
            }
        })
    }

    /// The direction that a smooth boundary reflects or transmits light from, and the fraction that
    /// it scatters so.
    pub(super) fn smooth(&self, wo: Vec3, transmits: bool) -> Option<(Vec3, Vec3)> {
        if !self.smooth {
            return None;
        }
        let weights = self.weights(wo.z);
        if transmits {
            Some((self.transmitted(wo, Vec3::Z, wo.z)?, weights.through))
        } else {
            Some((Vec3::new(-wo.x, -wo.y, wo.z), weights.reflected))
        }
    }
}

/// Indices that differ by less refract by no more than a rounding error.
const NEARLY_STRAIGHT: f64 = 1e-6;
