//! The meshes: triangles from a file, placed.

use super::Lower;
use super::sizing::Sizing;
use super::sphere::Radius;
use crate::course::assets::{Dress, Dressing};
use crate::course::decode::{Context, SharedValue, Spanned, Value};
use crate::course::lower::Lowering;
use crate::course::material::Material;
use crate::course::number::{Degrees, Real};
use crate::course::record::{FieldOutcome, keys, record};
use crate::course::schema::Definitions;
use crate::course::synonym::{FILE, PLACE, ROTATION, SCALE, TURN_ANGLE, TURN_AXIS, led_by};
use crate::course::turn::{AffineColumns, Rotation, Turn, placed};
use crate::course::value::{Angles, Caption, FileName, Point, Scale, Text, Vector};
use crate::course::word::Words;
use rtc_diag::{Severity, codes};
use rtc_ir as ir;
use rtc_source::Span;
use rtc_source::tree::{NodeContent, NodeId};
use serde_json::{Value as Json, json};

record! {
    /// A mesh from an OBJ, OFF, STL or PLY file, or points from an XYZ file.
    struct Mesh, "mesh" {
        /// What kind of object this is.
        kind: Spanned<Text>, required, keys!["type"], json "type";
        /// The file, beside the scene file or in a folder below it.
        file: Spanned<FileName>, required, &FILE,
            json "filename", json "object";
        /// Where the origin of the file's coordinates comes to; beside `fit`, where the middle of the mesh does.
        position: Spanned<Point>, default(Point([0.0; 3])), &led_by(PLACE, "position"), json "position";
        /// How many times larger it is than in its file, in all directions or along x, y and z.
        scale: Spanned<Scale>, optional, &SCALE, json "scale";
        /// The angles in radians by which it is turned about its origin: first about x, then y,
        /// then z; beside `angle` the axis.
        rotation: Spanned<Rotation<Angles>>, optional, &ROTATION, json "rotation";
        /// The axis that it is turned about by `angle`.
        axis: Spanned<Vector>, optional, &TURN_AXIS;
        /// By how many degrees it is turned about its axis.
        angle: Spanned<Degrees>, optional, &TURN_ANGLE;
        /// Twelve numbers in place of `position` and `scale`: where x, y and z of the file's coordinates point, each with the
        /// length that a unit has, and where their origin comes to.
        transform: Spanned<AffineColumns>, optional, keys!["transform"];
        /// A factor as `scale`, unless the mesh would hide the view or hold the eye in its box: then 1.5 times what `fit`
        /// says, with a warning. Better written `scale` or `fit`.
        size: Spanned<Real>, optional, keys!["size"];
        /// Half the longest side of the mesh in the scene, however large it is in its file; above 0.
        fit: Spanned<Radius>, optional, keys!["fit" "radius"];
        /// What it is made of. If nothing is said, the materials that an OBJ asks for count, and grey where there are none.
        material: Spanned<SharedValue<Material>>, optional, keys!["material"], json "material";
        /// `mtl`: the materials of the MTL file that an OBJ names count before `material`. `Kd` is the `color`, with a `kd` of
        /// 1, `map_Kd` the `texture`, with the largest channel of `Kd` as `kd` if it is above 0; `ka` is the mean of `Ka`, at
        /// most 0.2; `ks` is the mean of `Ks`, 0 under `illum` 0 and 1, `map_Ks` the `specularMap`, `Ns` the `n`, `map_Bump` the
        /// `bump`, `norm` the `normalMap`. What `d` or `Tr` lets through is `kt`, and less of `ka` and `kd`; `Ni` is the `eta`
        /// under `illum` 4, 6, 7 and 9, which are clear without `d` and `Tr`. Where paths are
        /// traced they become the `standard` material, which shows `Ke`, `Tf`, `Pr`, `Pm`, `Ps`,
        /// `Pc`, `Pcr`, `aniso`, `map_d`, `map_Ke`, `map_Pr`, `map_Pm` and how maps lie, too.
        materials: Spanned<MaterialSource>, optional, keys!["materials"];
        /// Of an OBJ: the faces alone that ask for the material of this name by `usemtl`; empty for those that ask for none.
        part: Spanned<PartName>, optional, keys!["part"];
        /// What people call it.
        label: Spanned<Caption>, optional, keys!["label"];
        /// Whether it casts shadows, where the scene has `Shadows`; paths know only surfaces that do.
        shadow: Spanned<bool>, default(true), keys!["shadow"], json "shadow";
    }
    forms { [file] [file scale] [file size] [file fit] [file transform] }
}

/// Where materials come from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::course) enum MaterialSource {
    /// The file of materials that a mesh file names.
    Mtl,
}

impl Words for MaterialSource {
    const WORDS: &'static [(&'static str, Self)] = &[("mtl", MaterialSource::Mtl)];
}

/// The name of a material in a mesh file, which may be empty.
#[derive(Clone, Debug)]
pub(in crate::course) struct PartName(String);

impl Value for PartName {
    fn decode(node: NodeId, context: &mut Context<'_>) -> Option<Self> {
        match context.tree.shape(node) {
            NodeContent::Word(text) | NodeContent::Text(text) => Some(Self(text.to_owned())),
            NodeContent::List | NodeContent::Map => {
                context.expected(node, "the name of a material")
            }
        }
    }

    fn schema(_: &mut Definitions) -> Json {
        json!({ "type": ["string", "number"] })
    }
}

impl Lower for Mesh {
    fn lower(&self, lowering: &mut Lowering, context: &mut Context<'_>) {
        let Mesh {
            kind,
            file,
            material,
            materials,
            part,
            label,
            shadow,
            ..
        } = self;
        let clothes = match material {
            FieldOutcome::Read(material) => lowering.clothe(kind, material, shadow, context),
            FieldOutcome::Absent => Some(lowering.clothe_in_grey(kind, shadow)),
            FieldOutcome::Broken => None,
        };
        let index = lowering.scene.surfaces.len();
        let (Some((transform, sizing)), Some(clothes)) = (self.place(index, context), clothes)
        else {
            return;
        };
        let part = match part {
            FieldOutcome::Read(part) => Some(&*part.value.0),
            FieldOutcome::Absent => None,
            FieldOutcome::Broken => return,
        };
        let [axes @ .., _] = transform.value.0;
        if axes == [[0.0; 3]; 3] {
            lowering.invisible(transform.span);
            return;
        }
        let mesh = lowering.files.mesh(&mut lowering.scene, file, part);
        lowering
            .dressings
            .push(dressing(index, kind.span, material, materials));
        lowering.sizings.extend(sizing);
        let shape = ir::Instance {
            mesh,
            world_from_object: transform.value.0,
        };
        let places = [("mesh", file.span), (TRANSFORM, transform.span)];
        lowering.put(&clothes, ir::Shape::Instance(shape), &places);
        if let FieldOutcome::Read(label) = label {
            lowering.call(&label.value.0);
        }
    }
}

impl Mesh {
    /// The transform of the surface of this index, and what is still to be done about its size.
    fn place(
        &self,
        index: usize,
        context: &mut Context<'_>,
    ) -> Option<(Spanned<AffineColumns>, Option<Sizing>)> {
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
        let turn = Turn {
            rotation,
            axis,
            angle,
        };
        let (scale, sizing) = match (transform, scale, size, fit) {
            (FieldOutcome::Read(transform), ..) => {
                useless(position.span, "position", context);
                useless(turn.span(), "rotation", context);
                return Some((*transform, None));
            }
            (_, FieldOutcome::Read(scale), ..) => (scale.map(|scale| scale.0), None),
            (.., FieldOutcome::Read(size), _) => {
                let sizing = Sizing::Check(index, size.value.0);
                (size.map(|size| [size.0; 3]), Some(sizing))
            }
            (.., FieldOutcome::Read(fit)) => {
                useless_axis(fit, context);
                (fit.map(|fit| [fit.length; 3]), Some(Sizing::Fit(index)))
            }
            (
                FieldOutcome::Absent,
                FieldOutcome::Absent,
                FieldOutcome::Absent,
                FieldOutcome::Absent,
            ) => (position.map(|_| [1.0; 3]), None),
            _ => return None,
        };
        let axes = turn.axes(context)?;
        let place = |scale: &[f64; 3]| AffineColumns(placed(axes, *scale, position.value.0));
        Some((scale.map(place), sizing))
    }
}

/// Says that a mesh that has a transform is at no other place.
fn useless(span: Option<Span>, key: &str, context: &mut Context<'_>) {
    let Some(span) = span else { return };
    let message = || format!("`{key}` has no effect beside `transform`");
    context.report(&codes::NO_EFFECT, span, message, |d| {
        d.at(span, "ignored")
            .severity(Severity::Warning)
            .hint("the numbers of `transform` say where the mesh stands and how it is turned")
    });
}

/// The way to the transform of an instance in the IR.
pub(super) const TRANSFORM: &str = "worldFromObject";

/// Where the material of a mesh comes from.
fn dressing(
    surface: usize,
    object: Option<Span>,
    material: &FieldOutcome<Spanned<SharedValue<Material>>>,
    materials: &FieldOutcome<Spanned<MaterialSource>>,
) -> Dressing {
    let (dress, span) = match (materials, material) {
        (FieldOutcome::Read(source), _) => (Dress::Mtl, source.span),
        (_, FieldOutcome::Absent) => (Dress::MtlOrGrey, object),
        _ => (Dress::Scene, object),
    };
    Dressing {
        surface,
        dress,
        span,
    }
}

fn useless_axis(radius: &Spanned<Radius>, context: &mut Context<'_>) {
    if let Some(span) = radius.value.axis.and_then(|axis| axis.span) {
        let message = || "a mesh is not turned about an axis".to_owned();
        context.report(&codes::NO_EFFECT, span, message, |d| {
            d.at(span, "ignored").severity(Severity::Warning)
        });
    }
}
