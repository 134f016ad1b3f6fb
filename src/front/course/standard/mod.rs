//! The `standard` material: the material of glTF, from the table of its parameters.
//!
//! `rtc_tables::parameters!` lists the parameters with their kinds and defaults. The macros here
//! turn each row into a field of the record [`StandardMaterial`]: the key is the name of the row in
//! camel case, the kind of the row selects the type of the value (`written`), its default
//! (`requirement!`) and its lowering (`lowered!`). A parameter that is added to the table is
//! decoded, documented and lowered without a change here.
//!
//! `texture` has the record of a texture, with the placement and sampling of glTF; `value` has the
//! value types that only this material uses. All keys are optional except `type: standard`; the
//! validator checks the ranges. Images are added to the pending assets.

mod texture;
mod value;

pub(super) use texture::TextureMap;
pub(super) use value::SetIndex;

use super::decode::{Decode, DecodeContext, Spanned};
use super::lower::Lowering;
use super::medium::MediumCoefficients;
use super::number::{NonNegative, Positive, Real};
use super::reader::MapReader;
use super::record::{
    FieldDeclaration, FieldRequirement, FieldResult, FieldValue, HasRecord, Record,
};
use super::schema::{self, SchemaDefinitions};
use super::value::{AnyScalar, Color, DisplayName};
use rtc_ir::{self as ir, Alpha, EntityField, EntityKind, MaterialId};
use rtc_math::{Microfacets, Plastic};
use rtc_source::Span;
use rtc_source::tree::NodeId;
use rtc_tables::{camel_case, parameters};
use serde_json::Value as Json;
use texture::MapOrFile;
use value::{
    AlphaMode, ConductorIndex, Fraction, FractionColor, Range, Refraction, RefractionOrNone, Rgba,
};

/// The value of `type` that selects this material.
pub(super) const KEYWORD: &str = "standard";

/// The type of the format for each kind of parameter.
#[expect(non_camel_case_types, reason = "the words of the table")]
mod written {
    use super::*;

    pub(super) type fraction = Fraction;
    pub(super) type number = Real;
    pub(super) type non_negative = NonNegative;
    pub(super) type ior = RefractionOrNone;
    pub(super) type index_of_refraction = Refraction;
    pub(super) type distance = Positive;
    pub(super) type pair = Range;
    pub(super) type color = Color;
    pub(super) type fraction_color = FractionColor;
    pub(super) type fractions = Rgba;
    pub(super) type some_fractions = Rgba;
    pub(super) type conductor = ConductorIndex;
    pub(super) type medium = MediumCoefficients;
    pub(super) type microfacets = Microfacets;
    pub(super) type plastic = Plastic;
    pub(super) type flag = bool;
    pub(super) type alpha = AlphaMode;
    pub(super) type map = MapOrFile;
    pub(super) type material = BlendedMaterial;
}

/// The default for each kind of parameter.
macro_rules! requirement {
    (material, $default:expr) => {
        FieldRequirement::Optional
    };
    (map, $default:expr) => {
        FieldRequirement::Optional
    };
    (distance, $default:expr) => {
        FieldRequirement::Optional
    };
    (some_fractions, $default:expr) => {
        FieldRequirement::Optional
    };
    (conductor, $default:expr) => {
        FieldRequirement::Optional
    };
    (medium, $default:expr) => {
        FieldRequirement::Optional
    };
    (flag, $default:expr) => {
        FieldRequirement::Default(|| Decode::json(&$default))
    };
    ($kind:ident, $default:expr) => {
        FieldRequirement::Default(|| Decode::json(&<written::$kind>::from($default)))
    };
}

/// The value in the IR for each kind of parameter.
macro_rules! lowered {
    (material, $written:expr, $lowering:expr) => {
        $lowering.blended(&$written.value, $written.span)
    };
    (map, $written:expr, $lowering:expr) => {
        Some($lowering.texture_map(&$written.value, $written.span))
    };
    (distance, $written:expr, $lowering:expr) => {
        Some($written.value.0)
    };
    (some_fractions, $written:expr, $lowering:expr) => {
        Some($written.value.0)
    };
    (conductor, $written:expr, $lowering:expr) => {
        Some($written.value.0)
    };
    (medium, $written:expr, $lowering:expr) => {
        Some($written.value.lowered())
    };
    (flag, $written:expr, $lowering:expr) => {
        $written.value
    };
    (microfacets, $written:expr, $lowering:expr) => {
        $written.value
    };
    (plastic, $written:expr, $lowering:expr) => {
        $written.value
    };
    ($kind:ident, $written:expr, $lowering:expr) => {
        $written.value.0
    };
}

/// The record, generated from the table of parameters.
macro_rules! material {
    ($(
        $(#[doc = $about:literal])*
        $field:ident: $kind:ident = $default:expr, $omitted:literal;
    )*) => {
        /// The material of glTF.
        pub(crate) struct StandardMaterial {
            name: FieldResult<Spanned<DisplayName>>,
            $($field: FieldResult<Spanned<written::$kind>>,)*
        }

        impl HasRecord for StandardMaterial {
            const RECORD: &'static Record = &Record {
                name: "standard material",
                doc: " A material: that of glTF 2.0 and of its extensions `KHR_materials_*`. \
                      Colours are linear; a texture multiplies the number or colour beside it, \
                      in the channels that glTF specifies.",
                fields: &[
                    FieldDeclaration {
                        name: "kind",
                        doc: " `standard`: which material this is.",
                        spellings: &[&["type"]],
                        json: &[],
                        requirement: FieldRequirement::Required,
                        is_own: false,
                        schema: <Spanned<AnyScalar> as FieldValue>::schema,
                    },
                    FieldDeclaration {
                        name: "name",
                        doc: " A name for people to read.",
                        spellings: &[&["name"]],
                        json: &[],
                        requirement: FieldRequirement::Optional,
                        is_own: false,
                        schema: <Spanned<DisplayName> as FieldValue>::schema,
                    },
                    $(FieldDeclaration {
                        name: stringify!($field),
                        doc: concat!($($about),*),
                        spellings: &[&[camel_case!($field)]],
                        json: &[],
                        requirement: requirement!($kind, $default),
                        is_own: false,
                        schema: <Spanned<written::$kind> as FieldValue>::schema,
                    },)*
                ],
                variants: &[],
                variants_are_lowered: false,
            };

            fn read(
                record: &'static Record,
                node: NodeId,
                context: &mut DecodeContext<'_>,
            ) -> Option<Self> {
                let mut reader = MapReader::open(record, node, context)?;
                let _ = reader.next::<Spanned<AnyScalar>>(context);
                let name = reader.next(context);
                $(let $field = reader.next(context);)*
                reader.close(context).then_some(Self { name, $($field,)* })
            }
        }

        impl StandardMaterial {
            /// Lowers the material; its textures are added to the pending assets.
            fn lowered(&self, lowering: &mut Lowering) -> ir::Standard {
                let mut standard = ir::Standard::default();
                if let FieldResult::Read(name) = &self.name {
                    standard.name.clone_from(&name.value.0);
                }
                $(if let FieldResult::Read(written) = &self.$field {
                    standard.$field = lowered!($kind, written, lowering);
                })*
                standard
            }
        }
    };
}

parameters!(material);

impl Decode for StandardMaterial {
    fn decode(node: NodeId, context: &mut DecodeContext<'_>) -> Option<Self> {
        Self::read(Self::RECORD, node, context)
    }

    fn schema(definitions: &mut SchemaDefinitions) -> Json {
        schema::record(Self::RECORD, definitions)
    }
}

/// The other material of a blend: a standard material, too.
pub(crate) struct BlendedMaterial(Box<StandardMaterial>);

impl Decode for BlendedMaterial {
    fn decode(node: NodeId, context: &mut DecodeContext<'_>) -> Option<Self> {
        StandardMaterial::decode(node, context).map(|material| Self(Box::new(material)))
    }

    fn schema(definitions: &mut SchemaDefinitions) -> Json {
        StandardMaterial::schema(definitions)
    }
}

impl Lowering {
    /// Lowers a standard material.
    pub(super) fn standard(&mut self, material: &StandardMaterial) -> ir::Material {
        ir::Material::Standard(Box::new(material.lowered(self)))
    }

    /// Lowers the other material of a blend, which comes before the blend.
    fn blended(
        &mut self,
        BlendedMaterial(material): &BlendedMaterial,
        span: Option<Span>,
    ) -> Option<MaterialId> {
        let lowered = self.standard(material);
        let id = self.add_material(lowered);
        self.record_span(
            EntityKind::Material,
            id.0 as usize,
            EntityField::Whole,
            span,
        );
        Some(id)
    }
}
