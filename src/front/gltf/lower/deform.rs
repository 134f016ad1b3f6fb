//! Meshes out of their rest: moved by morph targets, then by the joints of a skin.

use super::super::document::Document;
use super::super::elements::Elements;
use super::super::mesh::{Attribute, Primitive};
use super::super::skin::Skin;
use crate::ir;
use crate::math::Vec3;
use glam::{DAffine3, DMat3, DMat4};

/// What moves the vertices of a mesh.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Shape {
    /// The weight of each morph target.
    pub(super) weights: Vec<f64>,
    /// From the mesh to the world, for each joint.
    pub(super) skin: Option<Vec<DAffine3>>,
}

/// From the mesh to the world for each joint: its inverse bind matrix, then its place.
pub(super) fn joints(doc: &Document<'_>, skin: &Skin, worlds: &[DAffine3]) -> Vec<DAffine3> {
    let matrices = skin.matrices.and_then(|matrices| Elements::of(doc, doc.accessors.get(matrices)?));
    let binds = matrices.map_or_else(Vec::new, |matrices| matrices.vectors::<16>());
    let bind = |at: usize| binds.get(at).map_or(DMat4::IDENTITY, DMat4::from_cols_array);
    let world = |joint: usize| worlds.get(joint).copied().unwrap_or(DAffine3::IDENTITY);
    skin.joints.iter().enumerate().map(|(at, joint)| world(*joint) * DAffine3::from_mat4(bind(at))).collect()
}

/// Moves the vertices of a mesh.
pub(super) fn deform(doc: &Document<'_>, primitive: &Primitive, shape: &Shape, mesh: &mut ir::Mesh) {
    for (target, weight) in primitive.targets.iter().zip(&shape.weights).filter(|(_, weight)| **weight != 0.0) {
        morph(doc, target, *weight, mesh);
    }
    if let Some(joints) = &shape.skin {
        skin(doc, primitive, joints, mesh);
    }
}

/// Adds a share of what a target moves.
fn morph(doc: &Document<'_>, target: &[Attribute], weight: f64, mesh: &mut ir::Mesh) {
    for attribute in target {
        let Some(elements) = doc.accessors.get(attribute.accessor).and_then(|own| Elements::of(doc, own)) else {
            continue;
        };
        match attribute.name.as_str() {
            "POSITION" => add(&mut mesh.positions, &elements.vectors::<3>(), weight),
            "NORMAL" => add(&mut mesh.normals, &elements.vectors::<3>(), weight),
            "TANGENT" => add(&mut mesh.tangents, &elements.vectors::<3>(), weight),
            "TEXCOORD_0" => add(&mut mesh.uvs, &elements.vectors::<2>(), weight),
            "TEXCOORD_1" => add(&mut mesh.second_uvs, &elements.vectors::<2>(), weight),
            "COLOR_0" => {
                let width = elements.layout.components();
                let mut deltas = elements.vectors::<4>();
                deltas.iter_mut().filter(|_| width < 4).for_each(|delta| delta[3] = 0.0);
                add(&mut mesh.colors, &deltas, weight);
                mesh.colors.iter_mut().flatten().for_each(|channel| *channel = channel.clamp(0.0, 1.0));
            }
            _ => {}
        }
    }
}

fn add<const N: usize, const M: usize>(base: &mut [[f64; N]], deltas: &[[f64; M]], weight: f64) {
    for (base, delta) in base.iter_mut().zip(deltas) {
        base.iter_mut().zip(delta).for_each(|(base, delta)| *base += weight * delta);
    }
}

/// Moves each vertex by the mean of its joints.
fn skin(doc: &Document<'_>, primitive: &Primitive, joints: &[DAffine3], mesh: &mut ir::Mesh) {
    let mut blends = vec![(DMat3::ZERO, Vec3::ZERO); mesh.positions.len()];
    for set in 0.. {
        let part = |name: String| Elements::of(doc, doc.accessors.get(primitive.find(&name)?)?);
        let (Some(own), Some(weights)) = (part(format!("JOINTS_{set}")), part(format!("WEIGHTS_{set}"))) else { break };
        let own = own.integers();
        for ((blend, own), weights) in blends.iter_mut().zip(own.as_chunks::<4>().0).zip(weights.vectors::<4>()) {
            for (joint, weight) in own.iter().zip(weights).filter(|(_, weight)| *weight != 0.0) {
                let Some(joint) = joints.get(*joint as usize) else { continue };
                blend.0 += joint.matrix3 * weight;
                blend.1 += joint.translation * weight;
            }
        }
    }
    for (at, (matrix, translation)) in blends.into_iter().enumerate() {
        let position = &mut mesh.positions[at];
        *position = (matrix * Vec3::from_array(*position) + translation).to_array();
        // Normals turn with the cofactors, which the inverse transpose is but for its length.
        let cofactors = DMat3::from_cols(
            matrix.y_axis.cross(matrix.z_axis),
            matrix.z_axis.cross(matrix.x_axis),
            matrix.x_axis.cross(matrix.y_axis),
        );
        if let Some(normal) = mesh.normals.get_mut(at) {
            *normal = (cofactors * Vec3::from_array(*normal)).normalize_or_zero().to_array();
        }
        if let Some([x, y, z, _]) = mesh.tangents.get_mut(at) {
            [*x, *y, *z] = (matrix * Vec3::new(*x, *y, *z)).normalize_or_zero().to_array();
        }
    }
}
