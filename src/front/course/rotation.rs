//! Rotations: by angles about the axes, by an axis and an angle, and by quaternions; and matrices.

use super::decode::{Decode, DecodeContext, Spanned};
use super::number::{Degrees, number, plain_number};
use super::record::FieldResult;
use super::schema::SchemaDefinitions;
use super::value::{Angles, Vector, list, tuple};
use rtc_diag::{Severity, clip, codes};
use rtc_math::{Vec3, cos, rotated_about, sin, unit};
use rtc_source::Span;
use rtc_source::tree::NodeId;
use serde_json::{Value as Json, json};

/// A rotation as a quaternion (x, y, z, w) of any length.
#[derive(Clone, Copy, Debug)]
pub(super) struct Quaternion(pub(super) [f64; 4]);

impl Decode for Quaternion {
    const IS_LIST: bool = true;

    fn decode(node: NodeId, context: &mut DecodeContext<'_>) -> Option<Self> {
        const WHAT: &str = "a list of four numbers";
        tuple(node, WHAT, context, |node, context| {
            number(node, WHAT, context)
        })
        .map(Self)
    }

    fn schema(_: &mut SchemaDefinitions) -> Json {
        json!({ "type": "array", "items": { "type": "number" }, "minItems": 4, "maxItems": 4 })
    }
}

/// Several vectors in one list of numbers.
#[derive(Clone, Copy, Debug)]
pub(super) struct VectorList<const N: usize>(pub(super) [[f64; 3]; N]);

/// The rows of a rotation.
pub(super) type RotationRows = VectorList<3>;

/// The columns of an affine map: the images of the three axes, and that of the origin.
pub(super) type AffineColumns = VectorList<4>;

/// The rows of an affine map of the plane: (a, b, c) for a·u + b·v + c.
pub(super) type PlaneRows = VectorList<2>;

impl<const N: usize> Decode for VectorList<N> {
    const IS_LIST: bool = true;

    fn decode(node: NodeId, context: &mut DecodeContext<'_>) -> Option<Self> {
        let what = match N {
            2 => "a list of six numbers",
            3 => "a list of nine numbers",
            _ => "a list of twelve numbers",
        };
        let numbers = list(node, 3 * N, what, context, |node, context| {
            number(node, what, context)
        })?;
        let (vectors, _) = numbers.as_chunks::<3>();
        vectors.try_into().ok().map(Self)
    }

    fn schema(_: &mut SchemaDefinitions) -> Json {
        let item = json!({ "type": "number", "minimum": -1e60, "maximum": 1e60 });
        json!({ "type": "array", "items": item, "minItems": 3 * N, "maxItems": 3 * N })
    }
}

/// A rotation; `None` if `--lenient` ignores one in an unknown notation.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rotation<T>(pub(super) Option<T>);

impl<T: Decode> Decode for Rotation<T> {
    const IS_LIST: bool = T::IS_LIST;

    fn decode(node: NodeId, context: &mut DecodeContext<'_>) -> Option<Self> {
        let tree = context.tree;
        let is_known = tree.is_list(node)
            && tree.items(node).take(4).count() == 3
            && tree
                .items(node)
                .all(|item| plain_number(item, context).is_some());
        if is_known || !context.options.lenient {
            return T::decode(node, context).map(|rotation| Self(Some(rotation)));
        }
        let (key, span) = (context.key, tree.span(node));
        let message = || format!("`{}` has an unknown notation", clip(key.text));
        context.report(&codes::NO_EFFECT, span, message, |d| {
            d.at(span, "ignored: no rotation")
                .severity(Severity::Warning)
                .hint("write a list of three numbers")
        });
        Some(Self(None))
    }

    fn schema(definitions: &mut SchemaDefinitions) -> Json {
        T::schema(definitions)
    }

    fn json(&self) -> Json {
        self.0.as_ref().map_or(Json::Null, Decode::json)
    }
}

/// The keys of an object's rotation: angles about x, y and z; or an axis and an angle.
pub(super) struct RotationKeys<'o> {
    /// The angles; beside an angle the axis.
    pub(super) rotation: &'o FieldResult<Spanned<Rotation<Angles>>>,
    pub(super) axis: &'o FieldResult<Spanned<Vector>>,
    pub(super) angle: &'o FieldResult<Spanned<Degrees>>,
}

impl RotationKeys<'_> {
    /// The span of one of the keys, if there is any.
    pub(super) fn span(&self) -> Option<Span> {
        let Self {
            rotation,
            axis,
            angle,
        } = self;
        let rotation = rotation.read().and_then(|rotation| rotation.span);
        let axis = axis.read().and_then(|axis| axis.span);
        rotation
            .or(axis)
            .or(angle.read().and_then(|angle| angle.span))
    }

    /// The rotated axes. Reports keys without effect. `None` if a key can't be read.
    pub(super) fn axes(&self, context: &mut DecodeContext<'_>) -> Option<[Vec3; 3]> {
        let Self {
            rotation,
            axis,
            angle,
        } = *self;
        if rotation.is_broken() || axis.is_broken() || angle.is_broken() {
            return None;
        }
        // An axis and an angle override angles; each of them alone has no effect.
        let angles = rotation.read().and_then(|rotation| rotation.value.0);
        match (axis.read(), angle.read(), angles) {
            (Some(axis), Some(angle), _) => {
                let other = rotation.read().and_then(|rotation| rotation.span);
                report_no_rotation(
                    other,
                    "`rotation` has no effect with `axis` and `angle`",
                    context,
                );
                Some(rotation_about(axis.value.0, angle.value.0))
            }
            (None, Some(angle), Some(Angles(axis))) => Some(rotation_about(axis, angle.value.0)),
            (axis, angle, angles) => {
                let message = "`axis` and `angle` have an effect only together";
                report_no_rotation(axis.and_then(|axis| axis.span), message, context);
                report_no_rotation(angle.and_then(|angle| angle.span), message, context);
                Some(angles.map_or(Vec3::AXES, |angles| euler_axes(angles.0)))
            }
        }
    }
}

fn rotation_about(axis: [f64; 3], degrees: f64) -> [Vec3; 3] {
    axes_rotated_about(Vec3::from_array(axis), degrees.to_radians())
}

fn report_no_rotation(span: Option<Span>, message: &str, context: &mut DecodeContext<'_>) {
    if let Some(span) = span {
        context.report(
            &codes::NO_EFFECT,
            span,
            || message.to_owned(),
            |d| d.at(span, "no effect").severity(Severity::Warning),
        );
    }
}

/// The transform that scales along the object's axes, maps them to `axes`, and translates.
pub(super) fn world_from_object(
    axes: [Vec3; 3],
    scale: [f64; 3],
    position: [f64; 3],
) -> [[f64; 3]; 4] {
    let [x, y, z] = axes;
    let [x, y, z] = [x * scale[0], y * scale[1], z * scale[2]].map(|axis| axis.to_array());
    [x, y, z, position]
}

/// The axes rotated by an angle in radians about an axis; unchanged if the axis is zero.
pub(super) fn axes_rotated_about(axis: Vec3, angle: f64) -> [Vec3; 3] {
    let sin_cos = [sin(angle), cos(angle)];
    unit(axis).map_or(Vec3::AXES, |axis| {
        Vec3::AXES.map(|v| rotated_about(v, axis, sin_cos))
    })
}

/// The axes rotated by angles in radians about x, then y, then z.
pub(super) fn euler_axes(angles: [f64; 3]) -> [Vec3; 3] {
    let [(cx, sx), (cy, sy), (cz, sz)] = angles.map(|angle| (cos(angle), sin(angle)));
    Vec3::AXES.map(|Vec3 { x, y, z }| {
        let (y, z) = (y * cx - z * sx, y * sx + z * cx);
        let (x, z) = (x * cy + z * sy, z * cy - x * sy);
        Vec3::new(x * cz - y * sz, x * sz + y * cz, z)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quarter_turn_about_z_takes_x_to_y() {
        let [x, y, z] = axes_rotated_about(Vec3::Z * 3.0, std::f64::consts::FRAC_PI_2);
        let is_near = |a: Vec3, b: Vec3| (a - b).length() < 1e-15;
        assert!(is_near(x, Vec3::Y) && is_near(y, Vec3::NEG_X) && is_near(z, Vec3::Z));
        assert_eq!(axes_rotated_about(Vec3::ZERO, 1.0), Vec3::AXES);
    }
}
