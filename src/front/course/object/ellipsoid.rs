//! The ellipsoid: a sphere that is stretched along its axes, and turned.

use super::LowerObject;
use crate::course::decode::{DecodeContext, SharedValue, Spanned};
use crate::course::lower::Lowering;
use crate::course::material::Material;
use crate::course::number::Degrees;
use crate::course::record::{FieldResult, record};
use crate::course::rotation::{
    AffineColumns, Rotation, RotationKeys, VectorList, world_from_object,
};
use crate::course::synonym::{POSITION, ROTATION, ROTATION_ANGLE, ROTATION_AXIS, with_canonical};
use crate::course::value::{Angles, AnyScalar, Point, Scale, Vector};
use rtc_diag::codes;
use rtc_ir as ir;
use rtc_math::shortest;
use rtc_source::Span;

record! {
    /// An ellipsoid.
    struct Ellipsoid, "ellipsoid" {
        /// The type of the object.
        kind: Spanned<AnyScalar>, required, &[&["type"]];
        /// The centre.
        position: Spanned<Point>, optional, &with_canonical(POSITION, "position");
        /// The semi-axes along x, y and z; 0 is invisible.
        radius: Spanned<Scale>, optional, &[&["radius"], &["radii"], &["semiAxes"], &["size"]];
        /// The rotation about the centre by angles in radians: first about x, then y, then z;
        /// beside `angle` the axis of rotation.
        rotation: Spanned<Rotation<Angles>>, optional, &ROTATION;
        /// The axis of a rotation by `angle`.
        axis: Spanned<Vector>, optional, &ROTATION_AXIS;
        /// The angle of rotation about the axis, in degrees.
        angle: Spanned<Degrees>, optional, &ROTATION_ANGLE;
        /// Twelve numbers instead of the other keys: the images of the x, y and z axis and of the
        /// origin under the map from the unit sphere.
        transform: Spanned<AffineColumns>, optional, &[&["transform"]];
        /// The material.
        material: Spanned<SharedValue<Material>>, required, &[&["material"]];
        /// Whether it casts shadows, if the scene has `Shadows`. Path tracing ignores `false`.
        shadow: Spanned<bool>, default(true), &[&["shadow"]], own true;
        /// How far it moves per second along each axis, while the `shutter` of the `Camera` is
        /// open.
        velocity: Spanned<Point>, default(Point([0.0; 3])), &[&["velocity"]], own true;
    }
    variants { [position radius] [transform] }
}

/// The map of the unit sphere, with the spans of centre and size.
type EllipsoidPlacement = (AffineColumns, [Option<Span>; 2]);

impl Ellipsoid {
    fn placement(&self, context: &mut DecodeContext<'_>) -> Option<EllipsoidPlacement> {
        let Self {
            position,
            radius,
            rotation,
            axis,
            angle,
            transform,
            ..
        } = self;
        if let FieldResult::Read(transform) = transform {
            return Some((transform.value, [transform.span; 2]));
        }
        let rotation_keys = RotationKeys {
            rotation,
            axis,
            angle,
        };
        let (position, radius) = (position.read()?, radius.read()?);
        if let (Some(negative), Some(span)) = (
            radius.value.0.iter().find(|radius| **radius < 0.0),
            radius.span,
        ) {
            let message = || format!("the radius `{}` is negative", shortest(*negative));
            context.report(&codes::RADIUS, span, message, |d| {
                d.at(span, "must be above 0")
            });
            return None;
        }
        let axes = rotation_keys.axes(context)?;
        let columns = world_from_object(axes, radius.value.0, position.value.0);
        Some((VectorList(columns), [position.span, radius.span]))
    }
}

impl LowerObject for Ellipsoid {
    fn lower(&self, lowering: &mut Lowering, context: &mut DecodeContext<'_>) {
        let props = lowering.surface_props(
            &self.kind,
            &self.material,
            (&self.shadow, &self.velocity),
            context,
        );
        let (Some((VectorList(columns), spans)), Some(props)) = (self.placement(context), props)
        else {
            return;
        };
        let [x, y, z, center] = columns;
        let axes = [x, y, z];
        if axes.contains(&[0.0; 3]) {
            lowering.invisible(spans[1].or(self.kind.span));
            return;
        }
        let shape = ir::Shape::Ellipsoid(ir::Ellipsoid { center, axes });
        lowering.add_surface(&props, shape, &[("center", spans[0]), ("axes", spans[1])]);
    }
}
