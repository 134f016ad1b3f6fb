//! Validates the glTF material: every factor is in the range of its specification.

use super::check::{Checker, EntityCounts, LARGEST};
use super::material::MaterialId;
use super::medium;
use super::texture::{self, Map};
use rtc_diag::{Diagnostic, codes};
use rtc_ir::{self as ir, EntityField, EntityKind, ValuePath};
use rtc_math::{
    ComplexIndex, Id, Medium, Microfacets, NonNegative, Plastic, Positive, UnitInterval, Vec3,
    shortest,
};
use rtc_tables::{camel_case, parameters};
use std::any::Any;

/// The type of a valid parameter of each kind of the table.
#[expect(non_camel_case_types, reason = "the words of the table")]
mod validated {
    use super::*;

    pub(super) type fraction = UnitInterval;
    pub(super) type number = f64;
    pub(super) type non_negative = NonNegative;
    pub(super) type ior = NonNegative;
    pub(super) type index_of_refraction = Positive;
    pub(super) type distance = Option<Positive>;
    pub(super) type pair = [NonNegative; 2];
    pub(super) type color = Vec3;
    pub(super) type fraction_color = Vec3;
    pub(super) type fractions = [UnitInterval; 4];
    pub(super) type some_fractions = Option<[UnitInterval; 4]>;
    pub(super) type conductor = Option<ComplexIndex>;
    pub(super) type medium = Option<Medium>;
    pub(super) type microfacets = Microfacets;
    pub(super) type plastic = Plastic;
    pub(super) type flag = bool;
    pub(super) type alpha = Alpha;
    pub(super) type map = Option<Map>;
    pub(super) type material = Option<MaterialId>;
}

/// A default of the table as a valid value.
macro_rules! validated_default {
    (fraction, $value:expr) => {
        UnitInterval::saturating($value)
    };
    (non_negative, $value:expr) => {
        NonNegative::saturating($value)
    };
    (ior, $value:expr) => {
        NonNegative::saturating($value)
    };
    (index_of_refraction, $value:expr) => {
        Positive::or_one($value)
    };
    (pair, $value:expr) => {
        non_negatives($value)
    };
    (color, $value:expr) => {
        Vec3::from_array($value)
    };
    (fraction_color, $value:expr) => {
        Vec3::from_array($value)
    };
    (fractions, $value:expr) => {
        unit_intervals($value)
    };
    ($kind:ident, $value:expr) => {
        $value
    };
}

const fn non_negatives([a, b]: [f64; 2]) -> [NonNegative; 2] {
    [NonNegative::saturating(a), NonNegative::saturating(b)]
}

const fn unit_intervals([a, b, c, d]: [f64; 4]) -> [UnitInterval; 4] {
    [
        UnitInterval::saturating(a),
        UnitInterval::saturating(b),
        UnitInterval::saturating(c),
        UnitInterval::saturating(d),
    ]
}

/// Declares the material and its validation from the table of its parameters: the kind of each
/// names its check.
macro_rules! material {
    ($(
        $(#[doc = $about:literal])*
        $field:ident: $kind:ident = $default:expr, $omitted:literal;
    )*) => {
        /// The material of glTF with its factors in range and the maps that multiply them.
        #[derive(Clone, Debug, PartialEq)]
        pub struct Standard {
            $($(#[doc = $about])* pub $field: validated::$kind,)*
        }

        impl Standard {
            /// The default material of glTF: white, metallic and rough.
            pub const DEFAULT: Self = Self { $($field: validated_default!($kind, $default),)* };

            /// All texture maps.
            pub fn maps(&self) -> impl Iterator<Item = &Map> {
                let fields: [&dyn Any; ir::Standard::PARAMETERS.len()] = [$(&self.$field),*];
                let maps = fields.into_iter().filter_map(<dyn Any>::downcast_ref::<Option<Map>>);
                maps.flatten()
            }
        }

        pub(super) fn standard(
            material: &ir::Standard,
            index: usize,
            counts: &EntityCounts,
            check: &mut Checker<'_>,
        ) -> Option<Standard> {
            let ir::Standard { name: _, $($field,)* } = material;
            let mut parameters = ParameterCheck { index, counts, check };
            $(let $field = parameters.$kind($field, camel_case!($field));)*
            Some(Standard { $($field: $field?,)* })
        }
    };
}

parameters!(material);

impl Standard {
    /// Whether camera rays pass through back faces. A transmissive material is also visible from
    /// inside.
    #[must_use]
    pub fn is_seen_from_one_side(&self) -> bool {
        !self.double_sided && self.transmission == UnitInterval::ZERO
    }
}

/// The alpha mode: how a surface covers the background.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Alpha {
    /// Fully.
    Opaque,
    /// Fully where alpha is at least the cutoff, not at all elsewhere.
    Mask(NonNegative),
    /// By the fraction alpha.
    Blend,
}

/// The minimum and the maximum.
type ValueRange = [f64; 2];

const FRACTION: ValueRange = [0.0, 1.0];
const AT_LEAST_0: ValueRange = [0.0, LARGEST];
const AT_LEAST_1: ValueRange = [1.0, LARGEST];
const ABOVE_0: ValueRange = [f64::MIN_POSITIVE, LARGEST];
const ANY: ValueRange = [-LARGEST, LARGEST];

/// The state of validating one material.
struct ParameterCheck<'a, 'run> {
    index: usize,
    counts: &'a EntityCounts,
    check: &'a mut Checker<'run>,
}

#[expect(
    clippy::trivially_copy_pass_by_ref,
    reason = "each row of the table hands over a reference"
)]
#[expect(
    clippy::option_option,
    reason = "an error and an absence are two things"
)]
impl ParameterCheck<'_, '_> {
    /// A number in a range, bounds included.
    fn within(&mut self, value: f64, name: &str, [low, high]: ValueRange) -> Option<f64> {
        let is_valid = low <= value && value <= high;
        if !is_valid {
            let [value, low, high] = [value, low, high].map(shortest);
            let message =
                format!("`{name}` of a material is `{value}`, but must be from {low} to {high}");
            let diagnostic = Diagnostic::new(&codes::BAD_FACTOR, message);
            let at = self.at(name);
            self.check.report(at, "", diagnostic);
        }
        is_valid.then_some(value)
    }

    /// The path of a parameter.
    fn at(&self, name: &str) -> ValuePath {
        ValuePath::new(
            EntityKind::Material,
            self.index,
            EntityField::of_parameter(name),
        )
    }

    /// Several numbers in a range; all errors are reported.
    fn all_within<const N: usize>(
        &mut self,
        values: &[f64; N],
        name: &str,
        range: ValueRange,
    ) -> Option<[f64; N]> {
        let is_valid = values.iter().fold(true, |is_valid, value| {
            is_valid & self.within(*value, name, range).is_some()
        });
        is_valid.then_some(*values)
    }

    fn number(&mut self, value: &f64, name: &str) -> Option<f64> {
        self.within(*value, name, ANY)
    }

    fn fraction(&mut self, value: &f64, name: &str) -> Option<UnitInterval> {
        self.within(*value, name, FRACTION)
            .and_then(UnitInterval::new)
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
        self.all_within(values, name, FRACTION)
            .map(|values| values.map(UnitInterval::saturating))
    }

    fn some_fractions(
        &mut self,
        values: &Option<[f64; 4]>,
        name: &str,
    ) -> Option<Option<[UnitInterval; 4]>> {
        match values {
            Some(values) => self.fractions(values, name).map(Some),
            None => Some(None),
        }
    }

    fn conductor(
        &mut self,
        index: &Option<ir::Conductor>,
        name: &str,
    ) -> Option<Option<ComplexIndex>> {
        let Some(index) = index else {
            return Some(None);
        };
        let ir::Conductor { eta, k } = index;
        let [eta, k] = [eta, k].map(|values| self.color(values, name));
        Some(Some(ComplexIndex { eta: eta?, k: k? }))
    }

    fn medium(&mut self, medium: &Option<Medium>, name: &str) -> Option<Option<Medium>> {
        let at = self.at(name);
        self.check.optional(medium.as_ref(), |check, medium| {
            medium::medium(medium, at, check)
        })
    }

    #[expect(
        clippy::unused_self,
        clippy::unnecessary_wraps,
        reason = "a row of the table like the others; each value is sound"
    )]
    fn microfacets(&self, value: &Microfacets, _name: &str) -> Option<Microfacets> {
        Some(*value)
    }

    #[expect(
        clippy::unused_self,
        clippy::unnecessary_wraps,
        reason = "a row of the table like the others; each value is sound"
    )]
    fn plastic(&self, value: &Plastic, _name: &str) -> Option<Plastic> {
        Some(*value)
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
        self.all_within(values, name, FRACTION)
            .map(Vec3::from_array)
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

    /// The other material of a blend, an earlier one: so blends end.
    fn material(
        &mut self,
        material: &Option<ir::MaterialId>,
        name: &str,
    ) -> Option<Option<MaterialId>> {
        let Some(ir::MaterialId(id)) = *material else {
            return Some(None);
        };
        let is_earlier = (id as usize) < self.index;
        if !is_earlier {
            let message = format!("a blend is with material {id}, which does not come before it");
            let at = self.at(name);
            self.check
                .report(at, "", Diagnostic::new(&codes::BAD_HANDLE, message));
        }
        is_earlier.then(|| Some(Id::new(id as usize)))
    }

    fn map(&mut self, map: &Option<ir::Map>, name: &str) -> Option<Option<Map>> {
        let (counts, at) = (self.counts, self.at(name));
        self.check.optional(map.as_ref(), |check, map| {
            texture::map(map, counts, at, check)
        })
    }
}
