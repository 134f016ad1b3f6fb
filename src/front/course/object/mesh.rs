//! A mesh file and its placement.

use super::LowerObject;
use super::sizing::MeshSizing;
use super::sphere::Radius;
use crate::course::assets::{MaterialSource, PendingMaterial};
use crate::course::decode::{Decode, DecodeContext, SharedValue, Spanned};
use crate::course::keyword::{Keyword, KeywordTable};
use crate::course::lower::Lowering;
use crate::course::material::Material;
use crate::course::number::{Degrees, Real};
use crate::course::record::{FieldResult, record};
use crate::course::rotation::{
    AffineColumns, Rotation, RotationKeys, VectorList, world_from_object,
};
use crate::course::schema::SchemaDefinitions;
use crate::course::synonym::{
    FILE, POSITION, ROTATION, ROTATION_ANGLE, ROTATION_AXIS, SCALE, with_canonical,
};
use crate::course::value::{Angles, AnyScalar, DisplayName, FileName, Point, Scale, Vector};
use rtc_diag::{Severity, codes};
use rtc_ir as ir;
use rtc_source::Span;
use rtc_source::tree::{NodeContent, NodeId};
use serde_json::{Value as Json, json};

record! {
    /// A mesh from an OBJ, OFF, STL or PLY file, or points from an XYZ file.
    struct Mesh, "mesh" {
        /// The type of the object.
        kind: Spanned<AnyScalar>, required, &[&["type"]], json "type";
        /// The file, in the folder of the scene file or below it.
        file: Spanned<FileName>, required, &FILE,
            json "filename", json "object";
        /// The position of the origin of the file's coordinates; beside `fit` the position of the
        /// middle of the mesh.
        position: Spanned<Point>, default(Point([0.0; 3])),
            &with_canonical(POSITION, "position"), json "position";
        /// The scale factor, or one factor for each of x, y and z.
        scale: Spanned<Scale>, optional, &SCALE, json "scale";
        /// The rotation about its origin by angles in radians: first about x, then y, then z;
        /// beside `angle` the axis of rotation.
        rotation: Spanned<Rotation<Angles>>, optional, &ROTATION, json "rotation";
        /// The axis of a rotation by `angle`.
        axis: Spanned<Vector>, optional, &ROTATION_AXIS;
        /// The angle of rotation about the axis, in degrees.
        angle: Spanned<Degrees>, optional, &ROTATION_ANGLE;
        /// Twelve numbers instead of `position` and `scale`: the columns of the transform, that is
        /// the images of the x, y and z axis and of the origin.
        transform: Spanned<AffineColumns>, optional, &[&["transform"]];
        /// A factor as `scale`, unless the mesh would fill the view or its box contain the eye:
        /// then 1.5 times the value of `fit`, with a warning. Better written `scale` or `fit`.
        size: Spanned<Real>, optional, &[&["size"]];
        /// Half the longest side of the mesh in the scene, whatever its size in the file; above 0.
        fit: Spanned<Radius>, optional, &[&["fit"], &["radius"]];
        /// The material. Without it the materials of the OBJ are used, or grey if there are none.
        material: Spanned<SharedValue<Material>>, optional, &[&["material"]], json "material";
        /// `mtl`: the materials of the MTL file that an OBJ names take precedence over `material`.
        /// `Kd` is the `color`, with a `kd` of 1; `map_Kd` is the `texture`, with the largest
        /// channel of `Kd` as `kd` if it is above 0. `ka` is the mean of `Ka`, at most 0.2. `ks` is
        /// the mean of `Ks`, or 0 under `illum` 0 and 1; `map_Ks` is the `specularMap`, `Ns` the
        /// `n`, `map_Bump` the `bump`, `norm` the `normalMap`. The transparency of `d` or `Tr` is
        /// `kt`, and reduces `ka` and `kd`. `Ni` is the `eta` under `illum` 4, 6, 7 and 9, which
        /// are clear without `d` and `Tr`. In path tracing the materials become `standard`
        /// materials, which also use `Ke`, `Tf`, `Pr`, `Pm`, `Ps`, `Pc`, `Pcr`, `aniso`, `map_d`,
        /// `map_Ke`, `map_Pr`, `map_Pm` and the placement of maps.
        materials: Spanned<LibraryKind>, optional, &[&["materials"]];
        /// For an OBJ: only the faces with the `usemtl` of this name; empty for faces without one.
        part: Spanned<MeshMaterialName>, optional, &[&["part"]];
        /// A name for people to read.
        label: Spanned<DisplayName>, optional, &[&["label"]];
        /// Whether it casts shadows, if the scene has `Shadows`. Path tracing ignores `false`.
        shadow: Spanned<bool>, default(true), &[&["shadow"]], json "shadow";
        /// How far it moves per second along each axis, while the `shutter` of the `Camera` is
        /// open.
        velocity: Spanned<Point>, default(Point([0.0; 3])), &[&["velocity"]], own true;
    }
    variants { [file] [file scale] [file size] [file fit] [file transform] }
}

/// The values of `materials`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum LibraryKind {
    /// The MTL file that the mesh file names.
    Mtl,
}

impl Keyword for LibraryKind {
    const KEYWORDS: KeywordTable<Self> = &[(
        "mtl",
        LibraryKind::Mtl,
        "The materials of the MTL file that the mesh file names.",
    )];
}

/// The name of a material in a mesh file, which may be empty.
#[derive(Clone, Debug)]
pub(crate) struct MeshMaterialName(String);

impl Decode for MeshMaterialName {
    fn decode(node: NodeId, context: &mut DecodeContext<'_>) -> Option<Self> {
        match context.tree.shape(node) {
            NodeContent::Word(text) | NodeContent::Text(text) => Some(Self(text.to_owned())),
            NodeContent::List | NodeContent::Map => {
                context.expected(node, "the name of a material")
            }
        }
    }

    fn schema(_: &mut SchemaDefinitions) -> Json {
        json!({ "type": ["string", "number"] })
    }
}

impl LowerObject for Mesh {
    fn is_in_file(&self) -> bool {
        true
    }

    fn lower(&self, lowering: &mut Lowering, context: &mut DecodeContext<'_>) {
        let Mesh {
            kind,
            file,
            material,
            materials,
            part,
            label,
            shadow,
            velocity,
            ..
        } = self;
        let props = match material {
            FieldResult::Read(material) => {
                lowering.surface_props(kind, material, (shadow, velocity), context)
            }
            FieldResult::Absent => Some(lowering.grey_surface_props(kind, (shadow, velocity))),
            FieldResult::Broken => None,
        };
        // The transform and the sizing.
        let index = lowering.scene.surfaces.len();
        let (Some((transform, sizing)), Some(props)) = (self.transform(index, context), props)
        else {
            return;
        };
        let part = match part {
            FieldResult::Read(part) => Some(&*part.value.0),
            FieldResult::Absent => None,
            FieldResult::Broken => return,
        };
        let [axes @ .., _] = transform.value.0;
        if axes == [[0.0; 3]; 3] {
            lowering.invisible(transform.span);
            return;
        }
        // The pending mesh, its material and its sizing.
        let mesh = lowering.files.mesh(&mut lowering.scene, file, part);
        lowering
            .pending_materials
            .push(pending_material(index, kind.span, material, materials));
        lowering.sizings.extend(sizing);
        // The instance.
        let shape = ir::Instance {
            mesh,
            world_from_object: transform.value.0,
        };
        let value_spans = [("mesh", file.span), (TRANSFORM, transform.span)];
        lowering.add_surface(&props, ir::Shape::Instance(shape), &value_spans);
        if let FieldResult::Read(label) = label {
            lowering.set_name(&label.value.0);
        }
    }
}

impl Mesh {
    /// The transform of surface `index`, and the sizing that remains until the file is loaded.
    fn transform(
        &self,
        index: usize,
        context: &mut DecodeContext<'_>,
    ) -> Option<(Spanned<AffineColumns>, Option<MeshSizing>)> {
        let Self {
            position,
            scale,
            rotation,
            axis,
            angle,
            transform,
            size,
            fit,
            ..
        } = self;
        let rotation_keys = RotationKeys {
            rotation,
            axis,
            angle,
        };
        // `transform` overrides other keys; else one of `scale`, `size` and `fit` gives the size.
        let (scale, sizing) = match (transform, scale, size, fit) {
            (FieldResult::Read(transform), ..) => {
                report_key_without_effect(position.span, "position", context);
                report_key_without_effect(rotation_keys.span(), "rotation", context);
                return Some((*transform, None));
            }
            (_, FieldResult::Read(scale), ..) => (scale.map(|scale| scale.0), None),
            (.., FieldResult::Read(size), _) => {
                let sizing = MeshSizing::Check(index, size.value.0);
                (size.map(|size| [size.0; 3]), Some(sizing))
            }
            (.., FieldResult::Read(fit)) => {
                report_axis_without_effect(fit, context);
                (fit.map(|fit| [fit.length; 3]), Some(MeshSizing::Fit(index)))
            }
            (
                FieldResult::Absent,
                FieldResult::Absent,
                FieldResult::Absent,
                FieldResult::Absent,
            ) => (position.map(|_| [1.0; 3]), None),
            _ => return None,
        };
        // Compose scale, rotation and translation.
        let axes = rotation_keys.axes(context)?;
        let transform =
            |scale: &[f64; 3]| VectorList(world_from_object(axes, *scale, position.value.0));
        Some((scale.map(transform), sizing))
    }
}

/// Reports a key that `transform` overrides.
fn report_key_without_effect(span: Option<Span>, key: &str, context: &mut DecodeContext<'_>) {
    let Some(span) = span else { return };
    let message = || format!("`{key}` has no effect with `transform`");
    context.report(&codes::NO_EFFECT, span, message, |d| {
        d.at(span, "ignored")
            .severity(Severity::Warning)
            .hint("`transform` gives the position and the rotation")
    });
}

/// The path of an instance's transform in the IR.
pub(super) const TRANSFORM: &str = "worldFromObject";

/// The source of a mesh's material.
fn pending_material(
    surface: usize,
    object: Option<Span>,
    material: &FieldResult<Spanned<SharedValue<Material>>>,
    materials: &FieldResult<Spanned<LibraryKind>>,
) -> PendingMaterial {
    let (source, span) = match (materials, material) {
        (FieldResult::Read(library), _) => (MaterialSource::Mtl, library.span),
        (_, FieldResult::Absent) => (MaterialSource::MtlOrGrey, object),
        _ => (MaterialSource::Scene, object),
    };
    PendingMaterial {
        surface,
        source,
        span,
    }
}

fn report_axis_without_effect(radius: &Spanned<Radius>, context: &mut DecodeContext<'_>) {
    if let Some(span) = radius.value.axis.and_then(|axis| axis.span) {
        let message = || "the axis of a `fit` has no effect".to_owned();
        context.report(&codes::NO_EFFECT, span, message, |d| {
            d.at(span, "ignored").severity(Severity::Warning)
        });
    }
}
