//! The meshes: triangles from a file, placed.

use super::Lower;
use super::sphere::Radius;
use crate::diag::{Severity, codes};
use crate::front::course::decode::{Context, SharedValue, Spanned};
use crate::front::course::lower::Lowering;
use crate::front::course::material::Material;
use crate::front::course::number::Real;
use crate::front::course::record::{FieldOutcome, keys, record};
use crate::front::course::value::{FileName, Point, Text};
use crate::ir;
use crate::math::Vec3;

record! {
    /// A mesh from an OBJ or OFF file.
    struct Mesh, "mesh" {
        /// What kind of object this is.
        kind: Spanned<Text>, required, keys!["type"];
        /// The file, beside the scene file or in a folder below it.
        file: Spanned<FileName>, required, keys!["file" "filename" "fileName" "path" "modelPath" "name"];
        /// Where the origin of the file's coordinates comes to; beside `radius`, where the middle of the mesh does.
        position: Spanned<Point>, default(Point([0.0; 3])), keys!["position" "center"];
        /// How many times larger it is than in its file.
        scale: Spanned<Real>, optional, keys!["scale" "scalefactor" "scaleFactor" "size"];
        /// Half the longest side of the mesh in the scene, however large it is in its file; above 0.
        radius: Spanned<Radius>, optional, keys!["radius"];
        /// What it is made of; grey if nothing is said.
        material: Spanned<SharedValue<Material>>, optional, keys!["material"];
    }
    forms { [file] [file scale] [file radius] }
}

impl Lower for Mesh {
    fn lower(&self, lowering: &mut Lowering, context: &mut Context<'_>) {
        let Mesh {
            kind,
            file,
            position,
            scale,
            radius,
            material,
        } = self;
        let clothes = match material {
            FieldOutcome::Read(material) => lowering.clothe(kind, material, context),
            FieldOutcome::Absent => Some(lowering.clothe_in_grey(kind)),
            FieldOutcome::Broken => None,
        };
        let (size, to_fit) = match (scale, radius) {
            (FieldOutcome::Read(scale), _) => (scale.map(|scale| scale.0), false),
            (_, FieldOutcome::Read(radius)) => {
                useless_axis(radius, context);
                (radius.map(|radius| radius.length), true)
            }
            (FieldOutcome::Absent, FieldOutcome::Absent) => (
                Spanned {
                    value: 1.0,
                    span: position.span,
                },
                false,
            ),
            _ => return,
        };
        let Some(clothes) = clothes else { return };
        let mesh = lowering.files.mesh(&mut lowering.scene, file);
        if to_fit {
            lowering.fitted.push(lowering.scene.surfaces.len());
        }
        let [x, y, z] = Vec3::AXES.map(|axis| (axis * size.value).to_array());
        let shape = ir::Instance {
            mesh,
            world_from_object: [x, y, z, position.value.0],
        };
        let places = [("mesh", file.span), ("worldFromObject", size.span)];
        lowering.put(&clothes, ir::Shape::Instance(shape), &places);
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

/// Makes a mesh fill the size it is to have: the transform of the instance has that size and where
/// its middle is to be.
pub(in crate::front::course) fn fit(scene: &mut ir::Scene, surface: usize) {
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
    let corners = || mesh.positions.iter().map(Vec3::from_array);
    let Some((low, high)) = corners()
        .map(|p| (p, p))
        .reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
    else {
        return;
    };
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
