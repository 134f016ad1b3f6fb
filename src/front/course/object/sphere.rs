//! The sphere, and the turn of its texture.

use super::Lower;
use crate::diag::codes;
use crate::front::course::decode::{Context, SharedValue, Spanned, Value};
use crate::front::course::lower::Lowering;
use crate::front::course::material::Material;
use crate::front::course::number::{Degrees, Positive, json_number};
use crate::front::course::record::{FieldOutcome, keys, record};
use crate::front::course::schema::Definitions;
use crate::front::course::value::{Point, Text, Vector};
use crate::ir;
use crate::math::{Vec3, turned_to_z, unit};
use crate::source::tree::{NodeContent, NodeId};
use serde_json::{Value as Json, json};

record! {
    /// A sphere.
    struct Sphere, "sphere" {
        /// What kind of object this is.
        kind: Spanned<Text>, required, keys!["type"];
        /// The centre.
        position: Spanned<Point>, required, keys!["position" "center"];
        /// The radius, above 0; or a list of the radius and the axis that its texture is turned about.
        radius: Spanned<Radius>, required, keys!["radius" "r"];
        /// By how many degrees the texture is turned about its axis.
        angle: Spanned<Degrees>, default(Degrees(0.0)), keys!["angle"];
        /// The axis that the texture is turned about: its poles lie on it.
        axis: Spanned<Vector>, optional, keys!["axis" "rotation" "rotationVector"];
        /// What it is made of.
        material: Spanned<SharedValue<Material>>, required, keys!["material"];
        /// Whether it casts shadows, where the scene has `Shadows`; paths know only surfaces that do.
        shadow: Spanned<bool>, default(true), keys!["shadow"];
    }
}

/// A radius, with or without the axis of a texture.
#[derive(Clone, Copy, Debug)]
pub(in crate::front::course) struct Radius {
    pub(in crate::front::course) length: f64,
    pub(in crate::front::course) axis: Option<Spanned<Vector>>,
}

impl Value for Radius {
    const IS_LIST: bool = true;

    fn decode(node: NodeId, context: &mut Context<'_>) -> Option<Self> {
        let tree = context.tree;
        if tree.shape(node) != NodeContent::List {
            return Positive::decode(node, context).map(|length| Self {
                length: length.0,
                axis: None,
            });
        }
        let mut items = tree.items(node);
        let (Some(length), Some(axis), None) = (items.next(), items.next(), items.next()) else {
            return context.expected(node, "a number, or a list of a number and an axis");
        };
        let length = Positive::decode(length, context);
        let span = Some(tree.span(axis));
        let axis = Vector::decode(axis, context).map(|value| Spanned { value, span });
        Some(Self {
            length: length?.0,
            axis: Some(axis?),
        })
    }

    fn schema(definitions: &mut Definitions) -> Json {
        let length = Positive::schema(definitions);
        let pair = json!([length, Vector::schema(definitions)]);
        json!({ "anyOf": [length, { "type": "array", "prefixItems": pair, "minItems": 2, "maxItems": 2 }] })
    }

    fn json(&self) -> Json {
        json_number(self.length)
    }
}

impl Lower for Sphere {
    fn lower(&self, lowering: &mut Lowering, context: &mut Context<'_>) {
        let Sphere {
            kind,
            position,
            radius,
            angle,
            axis,
            material,
            shadow,
        } = self;
        let axis = texture_axis(radius, axis, context);
        let shape = ir::Shape::Sphere(ir::Sphere {
            center: position.value.0,
            radius: radius.value.length,
            texture_from_world: turned_to_z(axis, angle.value.0),
        });
        let places = [("center", position.span), ("radius", radius.span)];
        if let Some(clothes) = lowering.clothe(kind, material, shadow, context) {
            lowering.put(&clothes, shape, &places);
        }
    }
}

/// The axis of the texture: +z unless there is another with a direction. What has no effect is
/// noted.
fn texture_axis(
    radius: &Spanned<Radius>,
    axis: &FieldOutcome<Spanned<Vector>>,
    context: &mut Context<'_>,
) -> Vec3 {
    let mut no_effect = |axis: &Spanned<Vector>, message: &str| {
        axis.span.into_iter().for_each(|span| {
            context.report(
                &codes::NO_EFFECT,
                span,
                || message.to_owned(),
                |d| d.at(span, "no effect"),
            );
        });
    };
    let chosen = match (axis, &radius.value.axis) {
        (FieldOutcome::Read(axis), inner) => {
            inner.iter().for_each(|inner| {
                no_effect(
                    inner,
                    "the axis beside the radius counts for nothing: `axis` does",
                )
            });
            axis
        }
        (FieldOutcome::Absent | FieldOutcome::Broken, Some(axis)) => axis,
        (FieldOutcome::Absent | FieldOutcome::Broken, None) => return Vec3::Z,
    };
    unit(Vec3::from_array(chosen.value.0)).unwrap_or_else(|| {
        no_effect(
            chosen,
            "the axis has no direction, so the texture is turned about [0, 0, 1]",
        );
        Vec3::Z
    })
}
