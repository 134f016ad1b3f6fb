//! The meshes: triangles from a file, placed.

use super::Lower;
use super::sphere::Radius;
use crate::course::assets::{Dress, Dressing};
use crate::course::decode::{Context, SharedValue, Spanned, Value};
use crate::course::lower::Lowering;
use crate::course::material::Material;
use crate::course::number::Real;
use crate::course::record::{FieldOutcome, keys, record};
use crate::course::schema::Definitions;
use crate::course::turn::AffineColumns;
use crate::course::value::{Caption, FileName, Point, Scale, Text, word, word_schema};
use rtc_diag::{Diagnostic, Severity, Sink, codes};
use rtc_ir::{self as ir, Field, Lowered, Noun, Place};
use rtc_math::{Vec3, shortest};
use rtc_source::Span;
use rtc_source::tree::{NodeContent, NodeId};
use serde_json::{Value as Json, json};

record! {
    /// A mesh from an OBJ, OFF, STL or PLY file, or points from an XYZ file.
    struct Mesh, "mesh" {
        /// What kind of object this is.
        kind: Spanned<Text>, required, keys!["type"], json "type";
        /// The file, beside the scene file or in a folder below it.
        file: Spanned<FileName>, required, keys!["file" "filename" "fileName" "path" "modelPath" "name" "object"],
            json "filename", json "object";
        /// Where the origin of the file's coordinates comes to; beside `fit`, where the middle of the mesh does.
        position: Spanned<Point>, default(Point([0.0; 3])), keys!["position" "center"], json "position";
        /// How many times larger it is than in its file, in all directions or along x, y and z.
        scale: Spanned<Scale>, optional, keys!["scale" "scalefactor" "scaleFactor"], json "scale";
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
        /// under `illum` 4, 6, 7 and 9, which are clear without `d` and `Tr`. Where paths are traced they become the `standard`
        /// material, which shows `Ke`, `Tf`, `Pr`, `Pm`, `Ps`, `Pc`, `Pcr`, `aniso`, `map_d`, `map_Ke`, `map_Pr`, `map_Pm` and how maps lie, too.
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
#[derive(Clone, Copy, Debug)]
pub(in crate::course) enum MaterialSource {
    /// The file of materials that a mesh file names.
    Mtl,
}

/// The words for it.
const SOURCES: &[(&str, MaterialSource)] = &[("mtl", MaterialSource::Mtl)];

impl Value for MaterialSource {
    fn decode(node: NodeId, context: &mut Context<'_>) -> Option<Self> {
        word(node, SOURCES, context)
    }

    fn schema(_: &mut Definitions) -> Json {
        word_schema(SOURCES)
    }
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

/// What is done about the size of a mesh once its file is there.
#[derive(Clone, Copy, Debug)]
pub(in crate::course) enum Sizing {
    /// The mesh gets the size that the transform of the surface says.
    Fit(usize),
    /// The surface stays as it is, unless it hides the view.
    Check(usize),
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
            transform,
            size,
            fit,
            ..
        } = self;
        let (scale, sizing) = match (transform, scale, size, fit) {
            (FieldOutcome::Read(transform), ..) => {
                useless_position(position.span, context);
                return Some((*transform, None));
            }
            (_, FieldOutcome::Read(scale), ..) => (scale.map(|scale| scale.0), None),
            (.., FieldOutcome::Read(size), _) => {
                (size.map(|size| [size.0; 3]), Some(Sizing::Check(index)))
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
        Some((
            scale.map(|scale| AffineColumns(placed(*scale, position.value.0))),
            sizing,
        ))
    }
}

/// Says that a mesh that has a transform is at no other place.
fn useless_position(position: Option<Span>, context: &mut Context<'_>) {
    let Some(span) = position else { return };
    let message = || "`position` has no effect beside `transform`".to_owned();
    context.report(&codes::NO_EFFECT, span, message, |d| {
        d.at(span, "ignored")
            .severity(Severity::Warning)
            .hint("the last three numbers of `transform` say where the mesh stands")
    });
}

/// The way to the transform of an instance in the IR.
const TRANSFORM: &str = "worldFromObject";

/// The transform that scales along the axes and moves the origin.
fn placed(scale: [f64; 3], position: [f64; 3]) -> [[f64; 3]; 4] {
    let [x, y, z] = Vec3::AXES;
    let [x, y, z] = [x * scale[0], y * scale[1], z * scale[2]].map(|axis| axis.to_array());
    [x, y, z, position]
}

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

/// Sees to the size of a mesh, now that its file is there.
pub(in crate::course) fn settle(sizing: Sizing, lowered: &mut Lowered, sink: &mut Sink) {
    let (surface, is_factor) = match sizing {
        Sizing::Fit(surface) => (surface, false),
        Sizing::Check(surface) => (surface, true),
    };
    let Lowered { scene, origins } = lowered;
    let Some(ir::Surface {
        shape: ir::Shape::Instance(instance),
        ..
    }) = scene.surfaces.get_mut(surface)
    else {
        return;
    };
    let Some(mesh) = scene.meshes.get(instance.mesh.0 as usize) else {
        return;
    };
    let corners = mesh.positions.iter().map(Vec3::from_array);
    let bounds = corners.map(|p| (p, p));
    let Some((low, high)) = bounds.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))) else {
        return;
    };
    if is_factor {
        let place = Field::of_shape(ir::ShapeKind::Instance, TRANSFORM);
        let span = origins.span(Place::new(Noun::Surface, surface, place));
        let [[size, ..], .., position] = instance.world_from_object;
        if !hides_view(
            [low, high].map(|p| p * size + Vec3::from_array(position)),
            &scene.camera,
        ) {
            sink.push(factor(size, span));
            return;
        }
        let half = size / UNITS;
        sink.push(unitised(size, half, span));
        instance.world_from_object = placed([half; 3], position);
    }
    fit(instance, [low, high]);
}

/// A `size` of so many is a `fit` of 1, where it is no factor.
const UNITS: f64 = 1.5;

/// Whether the eye is in a box, or the box is all that it sees. A box is convex, so that it fills
/// the picture if it does so at its corners.
fn hides_view([a, b]: [Vec3; 2], camera: &ir::Camera) -> bool {
    let ir::Camera {
        eye,
        center,
        right,
        up,
        size,
        ..
    } = camera;
    let [eye, center, right, up] = [eye, center, right, up].map(|v| Vec3::from_array(*v));
    let (low, high) = (a.min(b), a.max(b));
    let [x, y] = size.map(|side| f64::from(side) / 2.0);
    let corners = [[-x, -y], [x, -y], [-x, y], [x, y]];
    let is_inside = eye.clamp(low, high) == eye;
    is_inside
        || corners.iter().all(|[x, y]| {
            let direction = center + right * *x + up * *y - eye;
            let (to_low, to_high) = ((low - eye) / direction, (high - eye) / direction);
            let (enter, leave) = (to_low.min(to_high), to_low.max(to_high));
            leave.min_element() >= enter.max_element().max(0.0)
        })
}

fn factor(size: f64, span: Option<Span>) -> Diagnostic {
    let message = format!(
        "the `size` of a mesh is a factor, as in `scale: {}`",
        shortest(size)
    );
    Diagnostic::new(&codes::TWO_READINGS, message)
        .severity(Severity::Note)
        .at(span, "times as large as in its file")
        .hint("in some programs it is the size of the mesh; that is written `fit`")
}

fn unitised(size: f64, half: f64, span: Option<Span>) -> Diagnostic {
    let (size, half) = (shortest(size), shortest(half));
    let message = format!("`size: {size}` is taken as the size of the mesh, not as a factor");
    Diagnostic::new(&codes::TWO_READINGS, message)
        .at(span, "as a factor it would hide the view")
        .hint(format!(
            "`fit: {half}` is the size that is shown, `scale: {size}` the factor"
        ))
}

/// Makes a mesh of these bounds fill the size it is to have: the transform of the instance has that
/// size and where its middle is to be.
fn fit(instance: &mut ir::Instance, [low, high]: [Vec3; 2]) {
    let half = ((high - low) / 2.0).max_element();
    if half > 0.0 {
        let [x, y, z, middle] = instance.world_from_object.map(Vec3::from_array);
        let axes = [x, y, z].map(|axis| axis / half);
        let center = (low + high) / 2.0;
        let origin = middle - (axes[0] * center.x + axes[1] * center.y + axes[2] * center.z);
        instance.world_from_object =
            [axes[0], axes[1], axes[2], origin].map(|column| column.to_array());
    }
}
