//! Deforms meshes by morph targets and then by skinning.

use super::super::accessor_reader::AccessorReader;
use super::super::attribute::VertexAttribute;
use super::super::document::Document;
use super::super::primitive::Primitive;
use super::shape::Deformation;
use super::uv::TexCoordSets;
use glam::{DAffine3, DMat3};
use rtc_ir::{self as ir, VertexColumn};
use rtc_math::Vec3;

/// Moves the vertices of a mesh.
pub(super) fn deform(
    doc: &Document<'_>,
    primitive: &Primitive,
    (shape, uv_sets): (Deformation<'_>, TexCoordSets),
    mesh: &mut ir::Mesh,
) {
    let targets = primitive
        .targets
        .iter()
        .zip(shape.weights)
        .filter(|(_, weight)| **weight != 0.0);
    let targets = targets
        .map(|(target, weight)| (target.as_slice(), *weight))
        .collect::<Vec<_>>();
    let morph = MorphTargets { doc, targets };
    morph.add::<3, 3>("POSITION", &mut mesh.positions);
    morph.add::<3, 3>("NORMAL", &mut mesh.normals);
    morph.add::<4, 3>("TANGENT", &mut mesh.tangents);
    let [first, second] = &uv_sets.names();
    morph.add::<2, 2>(first, &mut mesh.uvs);
    morph.add::<2, 2>(second, &mut mesh.second_uvs);
    if morph.add::<4, 4>("COLOR_0", &mut mesh.colors) {
        mesh.colors = super::mesh::clamped(mesh.colors.iter());
    }
    if let Some(joints) = shape.joints {
        skin(doc, primitive, joints, mesh);
    }
}

/// The morph targets that count, each with its weight.
struct MorphTargets<'d, 's> {
    doc: &'d Document<'s>,
    targets: Vec<(&'d [VertexAttribute], f64)>,
}

impl MorphTargets<'_, '_> {
    /// Adds the morph targets of an attribute, to the first `M` of its components. False if none
    /// changes it.
    fn add<const N: usize, const M: usize>(
        &self,
        name: &str,
        column: &mut VertexColumn<N>,
    ) -> bool {
        let mut animated: Option<Vec<[f64; N]>> = None;
        for (target, weight) in &self.targets {
            let accessor = target
                .iter()
                .find(|attribute| attribute.name == name)
                .map(|attribute| attribute.accessor);
            let accessor = accessor.and_then(|accessor| self.doc.accessors.get(accessor));
            let Some(deltas) = accessor.and_then(|accessor| AccessorReader::of(self.doc, accessor))
            else {
                continue;
            };
            let animated = animated.get_or_insert_with(|| column.iter().collect());
            deltas.each(|at, delta| {
                let vertex = animated.get_mut(at).into_iter().flatten().take(M);
                vertex
                    .zip(delta)
                    .for_each(|(number, delta)| *number += weight * deltas.fraction(*delta));
            });
        }
        if let Some(animated) = &animated {
            *column = VertexColumn::rounded(animated.iter().copied());
        }
        animated.is_some()
    }
}

/// Moves each vertex by the mean of its joints.
fn skin(doc: &Document<'_>, primitive: &Primitive, joints: &[DAffine3], mesh: &mut ir::Mesh) {
    // Blend the joint matrices of each vertex.
    let mut blends = vec![(DMat3::ZERO, Vec3::ZERO); mesh.positions.len()];
    let part = |accessor: usize| AccessorReader::of(doc, doc.accessors.get(accessor)?);
    for [indices, weights] in primitive.influences() {
        let (Some(indices), Some(weights)) = (part(indices), part(weights)) else {
            break;
        };
        for (at, blend) in blends
            .iter_mut()
            .enumerate()
            .take(indices.count.min(weights.count))
        {
            let influences = indices.at::<4>(at).into_iter().zip(weights.at::<4>(at));
            for (joint, weight) in influences.filter(|(_, weight)| *weight != 0.0) {
                #[expect(
                    clippy::cast_possible_truncation,
                    clippy::cast_sign_loss,
                    reason = "joints are whole numbers"
                )]
                let Some(joint) = joints.get(joint as usize) else {
                    continue;
                };
                blend.0 += joint.matrix3 * weight;
                blend.1 += joint.translation * weight;
            }
        }
    }
    // Transform positions, normals and tangents.
    let positions = mesh.positions.iter().map(Vec3::from_array).zip(&blends);
    mesh.positions = VertexColumn::rounded(
        positions.map(|(p, (matrix, translation))| (matrix * p + translation).to_array()),
    );
    // Normals turn with the cofactors, which the inverse transpose is but for its length.
    let cofactors = |m: &DMat3| {
        DMat3::from_cols(
            m.y_axis.cross(m.z_axis),
            m.z_axis.cross(m.x_axis),
            m.x_axis.cross(m.y_axis),
        )
    };
    let normals = mesh.normals.iter().map(Vec3::from_array).zip(&blends);
    let turned = normals
        .map(|(normal, (matrix, _))| (cofactors(matrix) * normal).normalize_or_zero().to_array());
    mesh.normals = VertexColumn::rounded(turned);
    let turned = mesh
        .tangents
        .iter()
        .zip(&blends)
        .map(|([x, y, z, side], (matrix, _))| {
            let Vec3 { x, y, z } = (*matrix * Vec3::new(x, y, z)).normalize_or_zero();
            [x, y, z, side]
        });
    mesh.tangents = VertexColumn::rounded(turned);
}
