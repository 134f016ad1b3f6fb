//! The material of glTF 2.0: metallic-roughness with the layers of its extensions.

use super::TextureId;
use arbitrary::Arbitrary;
use rtc_tables::{map_of, parameters};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A texture, and the map from the coordinates of a surface to its own.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Map {
    /// The texture.
    pub texture: TextureId,
    /// Which set of texture coordinates, 0 or 1.
    #[serde(default, skip_serializing_if = "is_default")]
    #[schemars(range(max = 1))]
    pub set: u32,
    /// The rows of the affine map from the coordinates of the surface to those of the texture,
    /// `(a, b, c)` for `a·u + b·v + c`; none for the identity.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub texture_from_surface: Option<[[f64; 3]; 2]>,
}

/// The alpha mode: how much of the background a surface covers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub enum Alpha {
    /// All of it.
    #[default]
    Opaque,
    /// All where alpha is at least the cutoff, nothing elsewhere.
    Mask(f64),
    /// The fraction alpha.
    Blend,
}

/// The type of a parameter of a kind of the table.
macro_rules! stored {
    (fraction) => { f64 };
    (number) => { f64 };
    (non_negative) => { f64 };
    (ior) => { f64 };
    (index_of_refraction) => { f64 };
    (distance) => { Option<f64> };
    (pair) => { [f64; 2] };
    (color) => { [f64; 3] };
    (fraction_color) => { [f64; 3] };
    (fractions) => { [f64; 4] };
    (some_fractions) => { Option<[f64; 4]> };
    (flag) => { bool };
    (alpha) => { Alpha };
    (map) => { Option<Map> };
}

/// The map that a parameter of a kind holds, to be changed.
macro_rules! map_mut_of {
    (map, $map:expr) => {
        $map.as_mut()
    };
    ($kind:ident, $value:expr) => {
        None
    };
}

/// Leaves out the map that a parameter of a kind holds, if its texture is missing.
macro_rules! forget_map {
    (map, $map:expr, $is_missing:ident) => {
        $map.take_if(|map| $is_missing(&map.texture))
    };
    ($kind:ident, $value:expr, $is_missing:ident) => {};
}

/// The material, from the table of its parameters.
macro_rules! material {
    ($(
        $(#[doc = $about:literal])*
        $field:ident: $kind:ident = $default:expr, $omitted:literal;
    )*) => {
        /// The material of glTF 2.0, appendix B, and of the `KHR_materials_*` extensions, by whose
        /// names the fields go; a map multiplies its factor, in the channels the specification
        /// gives it.
        #[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
        #[serde(rename_all = "camelCase", deny_unknown_fields, default)]
        pub struct Standard {
            /// What people call it.
            #[serde(skip_serializing_if = "String::is_empty")]
            pub name: String,
            $(
                $(#[doc = $about])*
                #[serde(skip_serializing_if = $omitted)]
                pub $field: stored!($kind),
            )*
        }

        impl Standard {
            /// Every map it has.
            pub fn maps(&self) -> impl Iterator<Item = &Map> {
                [$(map_of!($kind, &self.$field)),*].into_iter().flatten()
            }

            /// The same, to be changed.
            pub fn maps_mut(&mut self) -> impl Iterator<Item = &mut Map> {
                [$(map_mut_of!($kind, self.$field)),*].into_iter().flatten()
            }

            /// Leaves out the maps whose textures are said to be missing.
            pub fn forget_maps(&mut self, is_missing: impl Fn(&TextureId) -> bool) {
                $(forget_map!($kind, self.$field, is_missing);)*
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

/// Of what an IR text always holds.
fn never<T>(_: &T) -> bool {
    false
}

/// Whether a value is the default of its type, so that it need not be written.
pub(super) fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

/// A number, or several.
trait Numbers {
    /// Whether all are the number given, bit for bit.
    fn are(&self, number: f64) -> bool;
}

impl Numbers for f64 {
    fn are(&self, number: f64) -> bool {
        self.to_bits() == number.to_bits()
    }
}

impl Numbers for [f64; 3] {
    fn are(&self, number: f64) -> bool {
        self.iter().all(|own| own.are(number))
    }
}

fn is_zero(numbers: &impl Numbers) -> bool {
    numbers.are(0.0)
}

fn is_one(numbers: &impl Numbers) -> bool {
    numbers.are(1.0)
}
