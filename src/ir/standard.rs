//! The material of glTF 2.0: metallic-roughness with the layers of its extensions.

use super::{MaterialId, TextureId};
use arbitrary::Arbitrary;
use rtc_math::{ComplexIndex, Medium, Microfacets, Plastic, Vec3};
use rtc_tables::{camel_case, parameters};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::any::Any;

/// A texture with an affine map from surface to texture coordinates.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Map {
    /// The texture.
    pub texture: TextureId,
    /// The set of texture coordinates, 0 or 1.
    #[serde(default, skip_serializing_if = "is_default")]
    #[schemars(range(max = 1))]
    pub set: u32,
    /// The rows of the affine map from surface to texture coordinates, `(a, b, c)` for `a·u + b·v +
    /// c`; absent for the identity.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub texture_from_surface: Option<[[f64; 3]; 2]>,
}

impl Map {
    /// Another set of texture coordinates, 0 or 1.
    #[must_use]
    pub fn set(self, set: u32) -> Self {
        Self { set, ..self }
    }

    /// An affine map from surface to texture coordinates, by its rows.
    #[must_use]
    pub fn texture_from_surface(self, rows: [[f64; 3]; 2]) -> Self {
        let texture_from_surface = Some(rows);
        Self {
            texture_from_surface,
            ..self
        }
    }
}

impl Map {
    /// Whether tangents along its coordinates may differ from those along the first coordinates of
    /// the vertices: it has others, or they are turned, sheared or mirrored.
    #[must_use]
    pub fn turns_tangents(&self) -> bool {
        let is_turned = |[[a, b, _], [c, d, _]]: [[f64; 3]; 2]| {
            b != 0.0 || c != 0.0 || a.is_sign_negative() || d.is_sign_negative()
        };
        self.set != 0 || self.texture_from_surface.is_some_and(is_turned)
    }
}

impl From<TextureId> for Map {
    /// The texture, over the first set of texture coordinates.
    fn from(texture: TextureId) -> Self {
        Self {
            texture,
            set: 0,
            texture_from_surface: None,
        }
    }
}

/// The alpha mode: how a surface covers the background.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub enum Alpha {
    /// Fully.
    #[default]
    Opaque,
    /// Fully where alpha is at least the cutoff, not at all elsewhere.
    Mask(f64),
    /// By the fraction alpha.
    Blend,
}

/// The complex index of refraction η + i·k of a metal, over that of the medium outside.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Conductor {
    /// η at red, green and blue, each at least 0.
    #[schemars(inner(range(min = 0.0)))]
    pub eta: [f64; 3],
    /// k at red, green and blue, each at least 0.
    #[schemars(inner(range(min = 0.0)))]
    pub k: [f64; 3],
}

impl From<Conductor> for ComplexIndex {
    fn from(Conductor { eta, k }: Conductor) -> Self {
        Self {
            eta: Vec3::from_array(eta),
            k: Vec3::from_array(k),
        }
    }
}

/// The type of a parameter of each kind of the table.
#[expect(non_camel_case_types, reason = "the words of the table")]
mod stored {
    use super::*;

    pub(super) type fraction = f64;
    pub(super) type number = f64;
    pub(super) type non_negative = f64;
    pub(super) type ior = f64;
    pub(super) type index_of_refraction = f64;
    pub(super) type distance = Option<f64>;
    pub(super) type pair = [f64; 2];
    pub(super) type color = [f64; 3];
    pub(super) type fraction_color = [f64; 3];
    pub(super) type fractions = [f64; 4];
    pub(super) type some_fractions = Option<[f64; 4]>;
    pub(super) type conductor = Option<Conductor>;
    pub(super) type medium = Option<Medium>;
    pub(super) type microfacets = Microfacets;
    pub(super) type plastic = Plastic;
    pub(super) type flag = bool;
    pub(super) type alpha = Alpha;
    pub(super) type map = Option<Map>;
    pub(super) type material = Option<MaterialId>;
}

/// The setter of a parameter of each kind of the table: of an optional one it takes the value.
macro_rules! setter {
    (map, $(#[$about:meta])* $field:ident) => {
        $(#[$about])*
        #[must_use]
        pub fn $field(self, map: impl Into<Map>) -> Self {
            Self { $field: Some(map.into()), ..self }
        }
    };
    (distance, $(#[$about:meta])* $field:ident) => {
        $(#[$about])*
        #[must_use]
        pub fn $field(self, $field: f64) -> Self {
            Self { $field: Some($field), ..self }
        }
    };
    (some_fractions, $(#[$about:meta])* $field:ident) => {
        $(#[$about])*
        #[must_use]
        pub fn $field(self, $field: [f64; 4]) -> Self {
            Self { $field: Some($field), ..self }
        }
    };
    (material, $(#[$about:meta])* $field:ident) => {
        $(#[$about])*
        #[must_use]
        pub fn $field(self, material: MaterialId) -> Self {
            Self { $field: Some(material), ..self }
        }
    };
    (conductor, $(#[$about:meta])* $field:ident) => {
        $(#[$about])*
        #[must_use]
        pub fn $field(self, $field: Conductor) -> Self {
            Self { $field: Some($field), ..self }
        }
    };
    (medium, $(#[$about:meta])* $field:ident) => {
        $(#[$about])*
        #[must_use]
        pub fn $field(self, $field: Medium) -> Self {
            Self { $field: Some($field), ..self }
        }
    };
    ($kind:ident, $(#[$about:meta])* $field:ident) => {
        $(#[$about])*
        #[must_use]
        pub fn $field(self, $field: stored::$kind) -> Self {
            Self { $field, ..self }
        }
    };
}

/// Declares the material from the table of its parameters.
macro_rules! material {
    ($(
        $(#[doc = $about:literal])*
        $field:ident: $kind:ident = $default:expr, $omitted:literal;
    )*) => {
        /// The material of glTF 2.0, appendix B, and of the `KHR_materials_*` extensions, with
        /// their names for the fields. A map multiplies its factor, in the channels that the
        /// specification names.
        #[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
        #[serde(rename_all = "camelCase", deny_unknown_fields, default)]
        pub struct Standard {
            /// Its name in the source file.
            #[serde(skip_serializing_if = "String::is_empty")]
            pub name: String,
            $(
                $(#[doc = $about])*
                #[serde(skip_serializing_if = $omitted)]
                pub $field: stored::$kind,
            )*
        }

        /// Setters, one for each parameter.
        impl Standard {
            $(setter!($kind, $(#[doc = $about])* $field);)*
        }

        impl Standard {
            /// The names of the parameters in the IR, in the order of the table.
            pub const PARAMETERS: &'static [&'static str] = &[$(camel_case!($field)),*];

            /// What each parameter is, in the order of the table.
            pub const ABOUT: &'static [&'static str] = &[$(concat!($($about),*)),*];

            fn parameters(&self) -> [&dyn Any; Self::PARAMETERS.len()] {
                [$(&self.$field),*]
            }

            fn parameters_mut(&mut self) -> [&mut dyn Any; Self::PARAMETERS.len()] {
                [$(&mut self.$field),*]
            }
        }

        impl Default for Standard {
            /// The default material of glTF: white, metallic and rough.
            fn default() -> Self {
                Self { name: String::new(), $($field: $default,)* }
            }
        }
    };
}

parameters!(material);

impl Standard {
    /// A surface that light passes unchanged, as if there were none: it only bounds media.
    #[must_use]
    pub fn null() -> Self {
        Self {
            base_color: [1.0, 1.0, 1.0, 0.0],
            metallic: 0.0,
            specular: 0.0,
            alpha: Alpha::Blend,
            double_sided: true,
            ..Self::default()
        }
    }

    /// The parameter of this name in the IR.
    #[must_use]
    pub fn parameter(&self, name: &str) -> Option<&dyn Any> {
        let at = Self::PARAMETERS.iter().position(|known| *known == name);
        at.map(|at| self.parameters()[at])
    }

    /// The parameter of this name in the IR, mutably.
    pub fn parameter_mut(&mut self, name: &str) -> Option<&mut dyn Any> {
        let mut named = Self::PARAMETERS.iter().zip(self.parameters_mut());
        named.find_map(|(known, parameter)| (*known == name).then_some(parameter))
    }

    /// All texture maps.
    pub fn maps(&self) -> impl Iterator<Item = &Map> {
        let maps = self.parameters().into_iter();
        let maps = maps.filter_map(<dyn Any>::downcast_ref::<Option<Map>>);
        maps.flatten()
    }

    /// The parameters that hold a texture map or none.
    fn map_fields(&mut self) -> impl Iterator<Item = &mut Option<Map>> {
        let fields = self.parameters_mut().into_iter();
        fields.filter_map(<dyn Any>::downcast_mut)
    }

    /// All texture maps, mutably.
    pub fn maps_mut(&mut self) -> impl Iterator<Item = &mut Map> {
        self.map_fields().flatten()
    }

    /// Removes the maps that are not to be kept.
    pub fn retain_maps(&mut self, is_kept: impl Fn(&Map) -> bool) {
        for map in self.map_fields() {
            map.take_if(|map| !is_kept(map));
        }
    }
}

/// The `skip_serializing_if` of fields that are always written.
fn never<T>(_: &T) -> bool {
    false
}

/// Whether a value is the default of its type and need not be written.
pub(super) fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

/// One or more numbers.
trait Components {
    /// Whether all of them equal `number`, bit for bit.
    fn are(&self, number: f64) -> bool;
}

impl Components for f64 {
    fn are(&self, number: f64) -> bool {
        self.to_bits() == number.to_bits()
    }
}

impl Components for [f64; 3] {
    fn are(&self, number: f64) -> bool {
        self.iter().all(|component| component.are(number))
    }
}

fn is_zero(numbers: &impl Components) -> bool {
    numbers.are(0.0)
}

fn is_one(numbers: &impl Components) -> bool {
    numbers.are(1.0)
}
