//! CSG solids: union, intersection and difference, and the `csg` that is one of them.
//!
//! The operands are lowered as objects are; then their surfaces are taken from the scene again, and
//! become the operands of one expression. A polyhedron is the intersection of half-spaces. The
//! result is one surface for each material, or more than one where some cast no shadow.

use super::{LowerObject, Object};
use crate::course::decode::{Decode, DecodeContext, SharedValue, Spanned};
use crate::course::keyword::{Keyword, KeywordTable};
use crate::course::lower::Lowering;
use crate::course::material::Material;
use crate::course::number::{Degrees, Positive};
use crate::course::object::SurfaceProperties;
use crate::course::record::{FieldResult, SameKeys, record};
use crate::course::rotation::{Rotation, RotationKeys};
use crate::course::schema::{self, SchemaDefinitions};
use crate::course::synonym::{POSITION, ROTATION, ROTATION_ANGLE, ROTATION_AXIS, with_canonical};
use crate::course::value::{Angles, AnyScalar, Point, Vector};
use rtc_diag::{Severity, codes};
use rtc_ir::{self as ir, MaterialId, Shape, Solid};
use rtc_math::{MAX_SET_OPERANDS, SetStep, Vec3, cross, unit};
use rtc_source::Span;
use rtc_source::tree::NodeId;
use serde_json::{Value as Json, json};

/// An operand: an object of any type.
pub(in crate::course) struct Operand(Object);

impl Decode for Operand {
    fn decode(node: NodeId, context: &mut DecodeContext<'_>) -> Option<Self> {
        Object::decode(node, context).map(Self)
    }

    fn schema(definitions: &mut SchemaDefinitions) -> Json {
        schema::operand(definitions)
    }
}

/// A list of operands.
pub(in crate::course) struct Operands(Vec<Spanned<Operand>>);

impl Decode for Operands {
    const IS_LIST: bool = true;

    fn decode(node: NodeId, context: &mut DecodeContext<'_>) -> Option<Self> {
        let tree = context.tree;
        if !tree.is_list(node) {
            return context.expected(node, "a list of objects");
        }
        let operands: Vec<_> = tree
            .items(node)
            .take(MAX_SET_OPERANDS + 1)
            .map(|item| {
                let span = Some(context.head(item));
                Operand::decode(item, context).map(|value| Spanned { value, span })
            })
            .collect();
        operands.into_iter().collect::<Option<_>>().map(Self)
    }

    fn schema(definitions: &mut SchemaDefinitions) -> Json {
        let item = Operand::schema(definitions);
        json!({ "type": "array", "items": item, "minItems": 1, "maxItems": MAX_SET_OPERANDS })
    }
}

record! {
    /// The union: the points in any operand.
    struct SetUnion, "union" {
        /// The type of the object.
        kind: Spanned<AnyScalar>, required, &[&["type"]];
        /// The two operands: objects with an inside, of any of these types, too.
        both: [Spanned<Operand>; 2], optional,
            &[&["a", "b"], &["left", "right"], &["first", "second"], &["A", "B"],
                &["object1", "object2"], &["shape1", "shape2"]];
        /// The operands instead of `a` and `b`, at most 64.
        of: Spanned<Operands>, optional,
            &[&["of"], &["operands"], &["objects"], &["children"], &["shapes"]];
        /// Which of the three operations a `csg` is; the other types are one.
        operation: Spanned<SetStep>, optional, &[&["operation"], &["operator"], &["op"]];
        /// The material of operands that have none.
        material: Spanned<SharedValue<Material>>, optional, &[&["material"]];
        /// The position of the origin of the operands' coordinates.
        position: Spanned<Point>, default(Point([0.0; 3])),
            &with_canonical(POSITION, "position");
        /// The scale factor of the operands, above 0.
        scale: Spanned<Positive>, default(Positive(1.0)),
            &[&["uniformScale"], &["scale"], &["scaleFactor"], &["scaling"]];
        /// The rotation of the operands about their origin by angles in radians: first
        /// about x, then y, then z; beside `angle` the axis of rotation.
        rotation: Spanned<Rotation<Angles>>, optional, &ROTATION;
        /// The axis of a rotation by `angle`.
        axis: Spanned<Vector>, optional,
            &with_canonical(ROTATION_AXIS, "rotationAxis");
        /// The angle of rotation about the axis, in degrees.
        angle: Spanned<Degrees>, optional, &ROTATION_ANGLE;
        /// Whether it casts shadows, if the scene has `Shadows`. Path tracing ignores
        /// `false`.
        shadow: Spanned<bool>, default(true), &[&["shadow"]], own true;
        /// How far it moves per second along each axis, while the `shutter` of the `Camera`
        /// is open.
        velocity: Spanned<Point>, default(Point([0.0; 3])), &[&["velocity"]], own true;
    }
    variants { [both] [of] }
}

impl LowerObject for SetUnion {
    fn lower(&self, lowering: &mut Lowering, context: &mut DecodeContext<'_>) {
        self.lower_as(SetStep::Union, lowering, context);
    }
}

/// The intersection: the points in all operands.
pub(super) struct SetIntersection(SetUnion);

impl SameKeys for SetIntersection {
    type Keys = SetUnion;
    const NAME: &'static str = "intersection";
    const DOC: &'static str = " The intersection: the points in all operands.";

    fn from_keys(keys: SetUnion) -> Self {
        Self(keys)
    }
}

impl LowerObject for SetIntersection {
    fn lower(&self, lowering: &mut Lowering, context: &mut DecodeContext<'_>) {
        self.0.lower_as(SetStep::Intersection, lowering, context);
    }
}

/// The difference: the points in the first operand and in no other.
pub(super) struct SetDifference(SetUnion);

impl SameKeys for SetDifference {
    type Keys = SetUnion;
    const NAME: &'static str = "difference";
    const DOC: &'static str = " The difference: the points in the first operand and in no other.";

    fn from_keys(keys: SetUnion) -> Self {
        Self(keys)
    }
}

impl LowerObject for SetDifference {
    fn lower(&self, lowering: &mut Lowering, context: &mut DecodeContext<'_>) {
        self.0.lower_as(SetStep::Difference, lowering, context);
    }
}

impl SetUnion {
    /// Adds the solid that an operation makes of the operands.
    fn lower_as(
        &self,
        operation: SetStep,
        lowering: &mut Lowering,
        context: &mut DecodeContext<'_>,
    ) {
        let Self {
            kind,
            both,
            of,
            operation: written,
            material,
            position,
            scale,
            rotation,
            axis,
            angle,
            shadow,
            velocity,
        } = self;
        report_other_operation(operation, written, context);
        let operands = match (both, of) {
            (FieldResult::Read(both), _) => &both[..],
            (_, FieldResult::Read(of)) => &of.value.0,
            _ => return,
        };
        let rotation = RotationKeys {
            rotation,
            axis,
            angle,
        }
        .axes(context);
        let expression = lowering.expression(operation, operands, kind, context);
        // Shared properties are lowered in the order of decoding, after the operands.
        // Errors in a material that no operand uses are reported, too.
        if let FieldResult::Read(material) = material
            && lowering.material(material, context).is_none()
        {
            return;
        }
        let (Some(axes), Some(mut expression)) = (rotation, expression) else {
            return;
        };
        let placement = OperandPlacement {
            axes,
            scale: scale.value.0,
            position: position.value.0,
        };
        if !placement.is_identity() {
            for operand in &mut expression.operands {
                placement.place(&mut operand.solid);
                lowering.drop_unused_rotation(operand);
            }
        }
        lowering.dependent.record_shadow(shadow);
        lowering.add_expression(expression, kind.span, (shadow.value, *velocity));
    }
}

/// A solid whose key `operation` says which of the three it is.
pub(super) struct Csg(SetUnion);

impl SameKeys for Csg {
    type Keys = SetUnion;
    const NAME: &'static str = "csg";
    const DOC: &'static str =
        " The union, intersection or difference, as the key `operation` says.";

    fn from_keys(keys: SetUnion) -> Self {
        Self(keys)
    }
}

impl LowerObject for Csg {
    fn lower(&self, lowering: &mut Lowering, context: &mut DecodeContext<'_>) {
        let operation = match &self.0.operation {
            FieldResult::Read(operation) => operation.value,
            FieldResult::Absent => {
                report_no_operation(&self.0.kind, context);
                SetStep::Union
            }
            FieldResult::Broken => return,
        };
        self.0.lower_as(operation, lowering, context);
    }
}

impl Keyword for SetStep {
    const KEYWORDS: KeywordTable<Self> = &[
        ("union", SetStep::Union, "The points in any operand."),
        (
            "intersection",
            SetStep::Intersection,
            "The points in all operands.",
        ),
        (
            "difference",
            SetStep::Difference,
            "The points in the first operand and in no other.",
        ),
        ("add", SetStep::Union, ""),
        ("or", SetStep::Union, ""),
        ("intersect", SetStep::Intersection, ""),
        ("and", SetStep::Intersection, ""),
        ("subtract", SetStep::Difference, ""),
        ("subtraction", SetStep::Difference, ""),
        ("minus", SetStep::Difference, ""),
    ];
}

/// Reports a `csg` without its operation.
fn report_no_operation(kind: &Spanned<AnyScalar>, context: &mut DecodeContext<'_>) {
    let Some(span) = kind.span else { return };
    let message = || "the csg has no `operation`: it is read as a union".to_owned();
    context.report(&codes::ASSUMED, span, message, |d| {
        d.at(span, "all operands together").hint(
            "`operation` is `union`, `intersection` or `difference`, the first operand without \
             the others",
        )
    });
}

/// Reports an operation other than the type of the object.
fn report_other_operation(
    operation: SetStep,
    other: &FieldResult<Spanned<SetStep>>,
    context: &mut DecodeContext<'_>,
) {
    if let Some(Spanned {
        value,
        span: Some(span),
    }) = other.read()
        && *value != operation
    {
        let message = || format!("the `operation` of a {} has no effect", word(operation));
        context.report(&codes::NO_EFFECT, *span, message, |d| {
            d.at(*span, "the `type` says otherwise")
                .severity(Severity::Warning)
        });
    }
}

/// A solid with the properties of its surface.
struct PlacedSolid {
    solid: Solid,
    material: MaterialId,
    casts_no_shadow: bool,
}

/// Operands, and the operations over them.
#[derive(Default)]
struct CsgExpression {
    operands: Vec<PlacedSolid>,
    steps: Vec<SetStep>,
}

impl Lowering {
    /// Lowers operands to an expression. `None` if one is invalid, which is reported.
    fn expression(
        &mut self,
        operation: SetStep,
        operands: &[Spanned<Operand>],
        kind: &Spanned<AnyScalar>,
        context: &mut DecodeContext<'_>,
    ) -> Option<CsgExpression> {
        let mut whole = CsgExpression::default();
        let mut is_valid = true;
        for (index, operand) in operands.iter().enumerate() {
            let Some(part) = self.operand(operand, context) else {
                is_valid = false;
                continue;
            };
            whole.operands.extend(part.operands);
            whole.steps.extend(part.steps);
            whole.steps.extend((index > 0).then_some(operation));
        }
        let count = whole.operands.len();
        if count > MAX_SET_OPERANDS {
            let message = format!(
                "a {} of more than {MAX_SET_OPERANDS} solids",
                word(operation)
            );
            report(kind.span, &message, "too many", context);
            return None;
        }
        (is_valid && count > 0).then_some(whole)
    }

    /// Lowers an operand. `None` if it is invalid, which is reported.
    fn operand(
        &mut self,
        operand: &Spanned<Operand>,
        context: &mut DecodeContext<'_>,
    ) -> Option<CsgExpression> {
        let Operand(object) = &operand.value;
        if object.0.is_in_file() {
            report(operand.span, "a mesh is no operand", "no solid", context);
            return None;
        }
        let (first, tori) = (self.scene.surfaces.len(), self.ambiguous_tori.len());
        self.object(object, context);
        let surfaces = self.scene.surfaces.split_off(first);
        self.forget_surfaces(first);
        self.ambiguous_tori.truncate(tori);
        if surfaces.is_empty() {
            return None;
        }
        if surfaces
            .iter()
            .any(|surface| surface.velocity.get() != [0.0; 3])
        {
            let message = "an operand does not move by itself: the whole solid does";
            report(
                operand.span,
                message,
                "has a `velocity` of its own",
                context,
            );
            return None;
        }
        let expression = CsgExpression::of(&surfaces);
        if expression.is_none() {
            let name = surfaces[0].shape.kind().name();
            let message = format!("a {name} has no inside");
            report(operand.span, &message, "no solid", context);
        }
        expression
    }

    /// Without a texture, how a sphere is turned does not matter.
    fn drop_unused_rotation(&self, operand: &mut PlacedSolid) {
        let MaterialId(index) = operand.material;
        let material = self.scene.materials.get(index as usize);
        let has_texture = material
            .and_then(ir::Material::phong)
            .is_none_or(ir::Phong::has_texture);
        if let Solid::Sphere(sphere) = &mut operand.solid
            && !has_texture
        {
            sphere.texture_from_world = None;
        }
    }

    /// Adds the surfaces of an expression, one for each material.
    fn add_expression(
        &mut self,
        expression: CsgExpression,
        span: Option<Span>,
        (casts_shadow, velocity): (bool, Spanned<Point>),
    ) {
        let CsgExpression { operands, steps } = expression;
        let mut looks: Vec<((MaterialId, bool), Vec<u32>)> = Vec::new();
        let materials = &self.scene.materials;
        let is_same = |MaterialId(a): MaterialId, MaterialId(b): MaterialId| {
            a == b || materials.get(a as usize) == materials.get(b as usize)
        };
        for (index, operand) in (0..).zip(&operands) {
            let is_known = |((material, casts_no_shadow), _): &&mut ((MaterialId, bool), _)| {
                *casts_no_shadow == operand.casts_no_shadow && is_same(*material, operand.material)
            };
            match looks.iter_mut().find(is_known) {
                Some((_, faces)) => faces.push(index),
                None => looks.push(((operand.material, operand.casts_no_shadow), vec![index])),
            }
        }
        let operands: Vec<_> = operands.into_iter().map(|operand| operand.solid).collect();
        for ((material, casts_no_shadow), faces) in looks {
            let props = SurfaceProperties {
                object_span: span,
                material,
                span,
                casts_shadow: casts_shadow && !casts_no_shadow,
                velocity,
            };
            let shape = ir::Csg {
                operands: operands.clone(),
                steps: steps.clone(),
                faces,
            };
            self.add_surface(&props, Shape::Csg(shape), &[]);
        }
    }
}

impl CsgExpression {
    /// The expression of the surfaces of one object; `None` if they have no inside.
    fn of(surfaces: &[ir::Surface]) -> Option<Self> {
        let placed = |solid, surface: &ir::Surface| PlacedSolid {
            solid,
            material: surface.material,
            casts_no_shadow: surface.casts_no_shadow,
        };
        let first = surfaces.first()?;
        // A CSG expression: each of its surfaces takes its properties from an operand.
        if let Shape::Csg(csg) = &first.shape {
            let looks = |index: u32| {
                let shows = |surface: &&ir::Surface| {
                    let is_face = |csg: &ir::Csg| csg.faces.contains(&index);
                    matches!(&surface.shape, Shape::Csg(csg) if is_face(csg))
                };
                surfaces.iter().find(shows)
            };
            let operands = (0..).zip(&csg.operands);
            let operands =
                operands.map(|(index, solid)| Some(placed(solid.clone(), looks(index)?)));
            return Some(Self {
                operands: operands.collect::<Option<_>>()?,
                steps: csg.steps.clone(),
            });
        }
        let solids = match Solid::of(first.shape.clone()) {
            Some(solid) => vec![solid],
            None => half_spaces(surfaces)?,
        };
        let steps = [SetStep::Operand].into_iter();
        let more = [SetStep::Operand, SetStep::Intersection].repeat(solids.len() - 1);
        Some(Self {
            steps: steps.chain(more).collect(),
            operands: solids
                .into_iter()
                .map(|solid| placed(solid, first))
                .collect(),
        })
    }
}

/// The half-spaces behind the faces of a convex polyhedron, whose intersection it is; `None` for
/// other surfaces.
fn half_spaces(surfaces: &[ir::Surface]) -> Option<Vec<Solid>> {
    /// A corner may be so far outside, of the size of the polyhedron.
    const SLACK: f64 = 1e-9;
    // All faces must be triangles.
    let corners = |surface: &ir::Surface| {
        let Shape::Triangle(triangle) = &surface.shape else {
            return None;
        };
        Some(triangle.vertices.map(Vec3::from_array))
    };
    let faces: Vec<_> = surfaces.iter().map(corners).collect::<Option<_>>()?;
    // Collect the planes of the faces, each once.
    let mut planes: Vec<(Vec3, Vec3)> = Vec::new();
    for [a, b, c] in &faces {
        let normal = unit(cross(*b - *a, *c - *a))?;
        if !planes
            .iter()
            .any(|(_, known)| known.dot(normal) > 1.0 - 1e-12)
        {
            planes.push((*a, normal));
        }
    }
    // The solid is convex if no corner is outside of a plane.
    let [a, ..] = faces.first()?;
    let points = || faces.iter().flatten();
    let size = points().fold(0.0, |most: f64, point| most.max(point.distance(*a)));
    let holds = |(center, normal): &(Vec3, Vec3)| {
        points().all(|point| normal.dot(*point - *center) <= SLACK * size)
    };
    let solid = |(center, normal): &(Vec3, Vec3)| {
        Solid::Plane(ir::Plane {
            center: center.to_array(),
            normal: normal.to_array(),
        })
    };
    // It then is the intersection of half-spaces.
    let is_polyhedron = planes.len() >= 4 && planes.iter().all(holds);
    is_polyhedron.then(|| planes.iter().map(solid).collect())
}

/// The transform of the operands: scale, rotation, then translation.
struct OperandPlacement {
    /// The images of the axes, of length 1.
    axes: [Vec3; 3],
    scale: f64,
    position: [f64; 3],
}

impl OperandPlacement {
    fn is_identity(&self) -> bool {
        self.axes == Vec3::AXES && self.scale == 1.0 && self.position == [0.0; 3]
    }

    fn turn(&self, direction: &mut [f64; 3]) {
        let [x, y, z] = self.axes;
        let [u, v, w] = *direction;
        *direction = (x * u + y * v + z * w).to_array();
    }

    fn step(&self, step: &mut [f64; 3]) {
        self.turn(step);
        *step = step.map(|component| component * self.scale);
    }

    fn point(&self, point: &mut [f64; 3]) {
        self.step(point);
        *point = (Vec3::from_array(*point) + Vec3::from_array(self.position)).to_array();
    }

    fn length(&self, length: &mut f64) {
        *length *= self.scale;
    }

    fn place(&self, solid: &mut Solid) {
        // Transform points, directions and lengths of the solid.
        match solid {
            Solid::Sphere(ir::Sphere {
                center,
                radius,
                texture_from_world,
            }) => {
                self.point(center);
                self.length(radius);
                if self.axes != Vec3::AXES {
                    let rows = texture_from_world.get_or_insert(Vec3::AXES.map(|v| v.to_array()));
                    rows.iter_mut().for_each(|row| self.turn(row));
                }
            }
            Solid::Plane(ir::Plane { center, normal }) => {
                self.point(center);
                self.turn(normal);
            }
            Solid::Cylinder(ir::Cylinder {
                base,
                axis,
                height,
                radius,
            }) => {
                self.point(base);
                self.turn(axis);
                self.length(height);
                self.length(radius);
            }
            Solid::InfiniteCylinder(ir::InfiniteCylinder {
                center,
                axis,
                radius,
            }) => {
                self.point(center);
                self.turn(axis);
                self.length(radius);
            }
            Solid::Cone(ir::Cone { base, up, radius })
            | Solid::Paraboloid(ir::Paraboloid { base, up, radius }) => {
                self.point(base);
                self.step(up);
                self.length(radius);
            }
            Solid::Torus(ir::Torus {
                center,
                axis,
                major,
                minor,
            }) => {
                self.point(center);
                self.turn(axis);
                self.length(major);
                self.length(minor);
            }
            Solid::Ellipsoid(ir::Ellipsoid { center, axes }) => {
                self.point(center);
                axes.iter_mut().for_each(|axis| self.step(axis));
            }
        }
    }
}

/// The keyword of an operation.
fn word(operation: SetStep) -> &'static str {
    match operation {
        SetStep::Operand | SetStep::Union => "union",
        SetStep::Intersection => "intersection",
        SetStep::Difference => "difference",
    }
}

/// Reports an operand that is none.
fn report(span: Option<Span>, message: &str, label: &str, context: &mut DecodeContext<'_>) {
    const HINT: &str = "the operands are spheres, ellipsoids, boxes and other convex polyhedra, \
                        cylinders, cones, paraboloids, tori, half-spaces (`plane`), and unions, \
                        intersections and differences of these";
    if let Some(span) = span {
        let message = || message.to_owned();
        context.report(&codes::BAD_OPERAND, span, message, |d| {
            d.at(span, label).hint(HINT)
        });
    }
}
