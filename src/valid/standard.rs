//! The proof of glTF's material: every factor is in the range of its specification.

use super::check::{Check, EntityCounts, LARGEST, place};
use super::texture::{self, Map};
use crate::diag::{Diagnostic, codes};
use crate::ir::{self, Field, Noun, Place};
use crate::math::{NonNegative, Positive, UnitInterval, Vec3};

/// The material and its proof, from a table of its parameters: the proven type, the check, and the
/// name in findings.
macro_rules! parameters {
    ($($(#[$about:meta])* $field:ident: $type:ty = $check:ident($name:literal);)*) => {
        /// The material of glTF, proven: the factors of its specification, with the names used
        /// there, each in its range, and the maps that multiply them.
        #[derive(Clone, Debug, PartialEq)]
        #[expect(
            missing_docs,
            reason = "each is named and described in the specification of glTF"
        )]
        pub struct Standard {
            $($(#[$about])* pub $field: $type,)*
        }

        pub(super) fn standard(
            material: &ir::Standard,
            index: usize,
            counts: &EntityCounts,
            check: &mut Check<'_>,
        ) -> Option<Standard> {
            let ir::Standard { name: _, $($field,)* } = material;
            let at = place(Noun::Material, index, Field::Whole);
            let mut parameters = Parameters { at, counts, check };
            $(let $field = parameters.$check($field, $name);)*
            Some(Standard { $($field: $field?,)* })
        }
    };
}

parameters! {
    base_color: [UnitInterval; 4] = fractions("baseColor");
    base_color_map: Option<Map> = map("baseColorMap");
    metallic: UnitInterval = fraction("metallic");
    roughness: UnitInterval = fraction("roughness");
    metallic_roughness_map: Option<Map> = map("metallicRoughnessMap");
    /// The reflectance at normal incidence and the glossiness (rgb, a), in place of metallic,
    /// roughness and ior.
    specular_glossiness: Option<[UnitInterval; 4]> = some_shares("specularGlossiness");
    specular_glossiness_map: Option<Map> = map("specularGlossinessMap");
    /// The radiance, strength included.
    emissive: Vec3 = color("emissive");
    emissive_map: Option<Map> = map("emissiveMap");
    normal_map: Option<Map> = map("normalMap");
    normal_scale: f64 = number("normalScale");
    alpha: Alpha = alpha("alpha");
    /// Whether the camera sees the back where paths are traced.
    double_sided: bool = flag("doubleSided");
    unlit: bool = flag("unlit");
    /// At least 1, or 0 for an infinite one.
    ior: NonNegative = ior("ior");
    dispersion: NonNegative = non_negative("dispersion");
    specular: UnitInterval = fraction("specular");
    specular_map: Option<Map> = map("specularMap");
    specular_color: Vec3 = color("specularColor");
    specular_color_map: Option<Map> = map("specularColorMap");
    transmission: UnitInterval = fraction("transmission");
    transmission_map: Option<Map> = map("transmissionMap");
    /// Above 0, the surface bounds a volume.
    thickness: NonNegative = non_negative("thickness");
    thickness_map: Option<Map> = map("thicknessMap");
    /// `None` is infinite.
    attenuation_distance: Option<Positive> = distance("attenuationDistance");
    attenuation_color: Vec3 = fraction_color("attenuationColor");
    clearcoat: UnitInterval = fraction("clearcoat");
    clearcoat_map: Option<Map> = map("clearcoatMap");
    clearcoat_roughness: UnitInterval = fraction("clearcoatRoughness");
    clearcoat_roughness_map: Option<Map> = map("clearcoatRoughnessMap");
    clearcoat_normal_map: Option<Map> = map("clearcoatNormalMap");
    clearcoat_normal_scale: f64 = number("clearcoatNormalScale");
    sheen_color: Vec3 = fraction_color("sheenColor");
    sheen_color_map: Option<Map> = map("sheenColorMap");
    sheen_roughness: UnitInterval = fraction("sheenRoughness");
    sheen_roughness_map: Option<Map> = map("sheenRoughnessMap");
    anisotropy: UnitInterval = fraction("anisotropy");
    /// In radians.
    anisotropy_rotation: f64 = number("anisotropyRotation");
    anisotropy_map: Option<Map> = map("anisotropyMap");
    iridescence: UnitInterval = fraction("iridescence");
    iridescence_map: Option<Map> = map("iridescenceMap");
    /// At least 1.
    iridescence_ior: Positive = index_of_refraction("iridescenceIor");
    /// The minimum and the maximum, in nanometres.
    iridescence_thickness: [NonNegative; 2] = pair("iridescenceThickness");
    iridescence_thickness_map: Option<Map> = map("iridescenceThicknessMap");
}

impl Standard {
    /// Every map it has.
    pub fn maps(&self) -> impl Iterator<Item = &Map> {
        [
            &self.base_color_map,
            &self.metallic_roughness_map,
            &self.specular_glossiness_map,
            &self.emissive_map,
            &self.normal_map,
            &self.specular_map,
            &self.specular_color_map,
            &self.transmission_map,
            &self.thickness_map,
            &self.clearcoat_map,
            &self.clearcoat_roughness_map,
            &self.clearcoat_normal_map,
            &self.sheen_color_map,
            &self.sheen_roughness_map,
            &self.anisotropy_map,
            &self.iridescence_map,
            &self.iridescence_thickness_map,
        ]
        .into_iter()
        .flatten()
    }

    /// Whether camera rays skip the back. The back of a transmitting material is never skipped: a ray
    /// may meet it from inside.
    #[must_use]
    pub fn is_seen_from_one_side(&self) -> bool {
        !self.double_sided && self.transmission == UnitInterval::ZERO
    }
}

/// The alpha mode: how much of the background a surface covers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Alpha {
    /// All.
    Opaque,
    /// All where alpha is at least the cutoff, nothing elsewhere.
    Mask(NonNegative),
    /// The fraction alpha.
    Blend,
}

/// The least and the greatest number.
type Range = [f64; 2];

const SHARE: Range = [0.0, 1.0];
const AT_LEAST_0: Range = [0.0, LARGEST];
const AT_LEAST_1: Range = [1.0, LARGEST];
const ABOVE_0: Range = [f64::MIN_POSITIVE, LARGEST];
const ANY: Range = [-LARGEST, LARGEST];

/// The checks of the parameters of one material.
struct Parameters<'a, 'run> {
    at: Place,
    counts: &'a EntityCounts,
    check: &'a mut Check<'run>,
}

#[expect(
    clippy::trivially_copy_pass_by_ref,
    reason = "each row of the table hands over a reference"
)]
#[expect(
    clippy::option_option,
    reason = "an error and an absence are two things"
)]
impl Parameters<'_, '_> {
    /// A number in a range, ends included.
    fn within(&mut self, value: f64, name: &str, [low, high]: Range) -> Option<f64> {
        let is_sound = low <= value && value <= high;
        if !is_sound {
            let message =
                format!("`{name}` of a material is `{value}`, but must be from {low} to {high}");
            let finding = Diagnostic::new(&codes::BAD_FACTOR, message);
            self.check.report(self.at, "", finding);
        }
        is_sound.then_some(value)
    }

    /// Several numbers in a range; all faults are reported.
    fn all_within<const N: usize>(
        &mut self,
        values: &[f64; N],
        name: &str,
        range: Range,
    ) -> Option<[f64; N]> {
        let is_sound = values.iter().fold(true, |is_sound, value| {
            is_sound & self.within(*value, name, range).is_some()
        });
        is_sound.then_some(*values)
    }

    fn number(&mut self, value: &f64, name: &str) -> Option<f64> {
        self.within(*value, name, ANY)
    }

    fn fraction(&mut self, value: &f64, name: &str) -> Option<UnitInterval> {
        self.within(*value, name, SHARE).and_then(UnitInterval::new)
    }

    fn non_negative(&mut self, value: &f64, name: &str) -> Option<NonNegative> {
        self.within(*value, name, AT_LEAST_0)
            .and_then(NonNegative::new)
    }

    fn index_of_refraction(&mut self, value: &f64, name: &str) -> Option<Positive> {
        self.within(*value, name, AT_LEAST_1)
            .and_then(Positive::new)
    }

    fn ior(&mut self, value: &f64, name: &str) -> Option<NonNegative> {
        if *value == 0.0 {
            Some(NonNegative::ZERO)
        } else {
            self.index_of_refraction(value, name).map(NonNegative::from)
        }
    }

    fn distance(&mut self, value: &Option<f64>, name: &str) -> Option<Option<Positive>> {
        match value {
            Some(value) => self
                .within(*value, name, ABOVE_0)
                .and_then(Positive::new)
                .map(Some),
            None => Some(None),
        }
    }

    fn fractions(&mut self, values: &[f64; 4], name: &str) -> Option<[UnitInterval; 4]> {
        self.all_within(values, name, SHARE)
            .map(|values| values.map(UnitInterval::saturating))
    }

    fn some_shares(
        &mut self,
        values: &Option<[f64; 4]>,
        name: &str,
    ) -> Option<Option<[UnitInterval; 4]>> {
        match values {
            Some(values) => self.fractions(values, name).map(Some),
            None => Some(None),
        }
    }

    fn pair(&mut self, values: &[f64; 2], name: &str) -> Option<[NonNegative; 2]> {
        self.all_within(values, name, AT_LEAST_0)
            .map(|values| values.map(NonNegative::saturating))
    }

    fn color(&mut self, values: &[f64; 3], name: &str) -> Option<Vec3> {
        self.all_within(values, name, AT_LEAST_0)
            .map(Vec3::from_array)
    }

    fn fraction_color(&mut self, values: &[f64; 3], name: &str) -> Option<Vec3> {
        self.all_within(values, name, SHARE).map(Vec3::from_array)
    }

    fn alpha(&mut self, alpha: &ir::Alpha, name: &str) -> Option<Alpha> {
        match alpha {
            ir::Alpha::Opaque => Some(Alpha::Opaque),
            ir::Alpha::Mask(cutoff) => self.non_negative(cutoff, name).map(Alpha::Mask),
            ir::Alpha::Blend => Some(Alpha::Blend),
        }
    }

    #[expect(
        clippy::unused_self,
        clippy::unnecessary_wraps,
        reason = "a row of the table like the others; either value is sound"
    )]
    fn flag(&self, value: &bool, _name: &str) -> Option<bool> {
        Some(*value)
    }

    fn map(&mut self, map: &Option<ir::Map>, _name: &str) -> Option<Option<Map>> {
        let (counts, at) = (self.counts, self.at);
        self.check.optional(map.as_ref(), |check, map| {
            texture::map(map, counts, at, check)
        })
    }
}
