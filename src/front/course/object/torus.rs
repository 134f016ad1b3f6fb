//! The torus.

use super::LowerObject;
use crate::course::decode::{DecodeContext, SharedValue, Spanned};
use crate::course::lower::Lowering;
use crate::course::material::Material;
use crate::course::number::{NonNegative, Positive};
use crate::course::record::{FieldResult, record};
use crate::course::synonym::{AXIS, POSITION, with_canonical};
use crate::course::value::{AnyScalar, Point, Vector};
use rtc_diag::codes;
use rtc_ir as ir;
use rtc_math::{Vec3, shortest, unit};

record! {
    /// A torus.
    struct Torus, "torus" {
        /// The type of the object.
        kind: Spanned<AnyScalar>, required, &[&["type"]], json "type";
        /// The centre.
        position: Spanned<Point>, required, &with_canonical(POSITION, "position"), json "position";
        /// The major and the minor radius: `radius` and `alpha`.
        radii: [Spanned<NonNegative>; 2], optional, &[&["R", "r"], &["radius", "r"]];
        /// The major radius, from the centre to the middle of the tube; above 0.
        radius: Spanned<Positive>, optional,
            &[&["radius"], &["r"], &["R"], &["rad"], &["majorRadius"], &["major"], &["ringRadius"]];
        /// The minor radius, that of the tube; 0 is invisible.
        alpha: Spanned<NonNegative>, optional,
            &[&["alpha"], &["minorRadius"], &["minor"], &["tubeRadius"], &["tube"]];
        /// The radii of the hole and of the outer rim. If that torus would contain more of the eye,
        /// the lights and the other objects, they are taken as the minor and the major radius:
        /// `alpha` and `radius`.
        inner_outer: [Spanned<Positive>; 2], optional,
            &[&["innerRadius", "outerRadius"]], json "innerRadius";
        /// The direction of the axis, of any length but 0.
        direction: Spanned<Vector>, default(Vector([0.0, 0.0, 1.0])),
            &with_canonical(AXIS, "direction");
        /// The material.
        material: Spanned<SharedValue<Material>>, required, &[&["material"]], json "material";
        /// Whether it casts shadows, if the scene has `Shadows`. Path tracing ignores `false`.
        shadow: Spanned<bool>, default(true), &[&["shadow"]], json "shadow";
        /// How far it moves per second along each axis, while the `shutter` of the `Camera` is
        /// open.
        velocity: Spanned<Point>, default(Point([0.0; 3])), &[&["velocity"]], own true;
    }
    variants { [radius alpha] [radii] [inner_outer] }
}

impl LowerObject for Torus {
    fn lower(&self, lowering: &mut Lowering, context: &mut DecodeContext<'_>) {
        let Torus {
            kind,
            position,
            radii,
            radius,
            alpha,
            inner_outer,
            direction,
            material,
            shadow,
            velocity,
        } = self;
        // The major and the minor radius, from one variant.
        let (radius, alpha) = match (radius, alpha, radii, inner_outer) {
            (FieldResult::Read(radius), FieldResult::Read(alpha), ..) => {
                (radius.map(|radius| radius.0), alpha.map(|alpha| alpha.0))
            }
            (_, _, FieldResult::Read(radii), _) => {
                let [radius, alpha] = radii.map(|radius| radius.map(|radius| radius.0));
                (radius, alpha)
            }
            (.., FieldResult::Read([inner, outer])) => {
                let [major, minor] = major_and_minor(inner.value.0, outer.value.0);
                (outer.map(|_| major), inner.map(|_| minor))
            }
            _ => return,
        };
        let (center, axis) = (position.value.0, direction.value.0);
        let shape = ir::Torus {
            center,
            axis,
            major: radius.value,
            minor: alpha.value,
        };
        let value_spans = [
            ("center", position.span),
            ("axis", direction.span),
            ("major", radius.span),
            ("minor", alpha.span),
        ];
        let Some(props) = lowering.surface_props(kind, material, (shadow, velocity), context)
        else {
            return;
        };
        // Inner and outer radii are interpreted when all objects are known.
        let surface = lowering.scene.surfaces.len();
        lowering.add_surface(&props, ir::Shape::Torus(shape), &value_spans);
        if let (FieldResult::Read(radii), true) =
            (inner_outer, lowering.scene.surfaces.len() > surface)
        {
            lowering.ambiguous_tori.push(AmbiguousTorus {
                surface,
                radii: *radii,
            });
        }
    }
}

/// A torus with an inner and an outer radius, which programs interpret in two ways.
pub(crate) struct AmbiguousTorus {
    surface: usize,
    radii: [Spanned<Positive>; 2],
}

/// The major and the minor radius, from the radii of the hole and of the outer rim.
fn major_and_minor(inner: f64, outer: f64) -> [f64; 2] {
    [f64::midpoint(inner, outer), (outer - inner) / 2.0]
}

/// The number of other surfaces that are tested for being inside a torus.
const MAX_OTHERS: usize = 64;

impl Lowering {
    /// Chooses between the two interpretations of each ambiguous torus: the one that contains fewer
    /// points of other entities. Call it after all of these are lowered.
    pub(crate) fn resolve_tori(&mut self, context: &mut DecodeContext<'_>) {
        for AmbiguousTorus {
            surface,
            radii: [inner, outer],
        } in std::mem::take(&mut self.ambiguous_tori)
        {
            let others = self.points_outside(surface);
            let Some(ir::Shape::Torus(torus)) = self
                .scene
                .surfaces
                .get_mut(surface)
                .map(|surface| &mut surface.shape)
            else {
                continue;
            };
            let tube = ir::Torus {
                major: outer.value.0,
                minor: inner.value.0,
                ..*torus
            };
            let contained =
                |torus: &ir::Torus| others.iter().filter(|p| contains(torus, **p)).count();
            let is_tube = contained(&tube) < contained(torus);
            if is_tube {
                *torus = tube;
            }
            report_two_radii(&inner, &outer, is_tube, context);
        }
    }

    /// The eye, the lights, and the corners of the bounding boxes of other surfaces.
    fn points_outside(&self, surface: usize) -> Vec<Vec3> {
        let lights = self.scene.lights.iter().filter_map(ir::Light::point);
        let lights = lights.map(|light| light.position).take(MAX_OTHERS);
        let eye = [self.scene.camera.eye];
        let mut points: Vec<_> = lights.chain(eye).map(Vec3::from_array).collect();
        let others = self.scene.surfaces.iter().enumerate();
        // Mesh files are not loaded yet.
        let others = others
            .filter(|(at, other)| *at != surface && !matches!(other.shape, ir::Shape::Instance(_)));
        for (_, other) in others.take(MAX_OTHERS) {
            let visit = &mut |corner| points.push(corner);
            other.shape.corners_around(&[], visit);
        }
        points
    }
}

/// Whether a point lies inside a torus.
fn contains(torus: &ir::Torus, point: Vec3) -> bool {
    let Some(axis) = unit(Vec3::from_array(torus.axis)) else {
        return false;
    };
    let from_center = point - Vec3::from_array(torus.center);
    let above = axis.dot(from_center);
    let off = (from_center - axis * above).length();
    Vec3::new(off - torus.major, above, 0.0).length() < torus.minor
}

/// Reports how an ambiguous torus is interpreted.
fn report_two_radii(
    inner: &Spanned<Positive>,
    outer: &Spanned<Positive>,
    is_tube: bool,
    context: &mut DecodeContext<'_>,
) {
    let Some(span) = inner.span else { return };
    let ([first, second], hint) = match is_tube {
        false => (
            ["the radius of the hole", "that of the outer rim"],
            "if they are the radii of the tube and of the ring, write `alpha` and `radius`"
                .to_owned(),
        ),
        true => {
            let [major, minor] = major_and_minor(inner.value.0, outer.value.0).map(shortest);
            let hint = format!(
                "if they are the radii of the hole and of the outer rim, write \
                 `radius: {major}` and `alpha: {minor}`; the torus would then contain other objects"
            );
            (["the radius of the tube", "that of the ring"], hint)
        }
    };
    let message = || format!("`innerRadius` is read as {first}, `outerRadius` as {second}");
    context.report(&codes::KEY_READ_DIFFERENTLY, span, message, |d| {
        d.at(span, first).also(outer.span, second).hint(hint)
    });
}
