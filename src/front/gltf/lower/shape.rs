//! The deformation of each node: morph weights and joint matrices. Equal ones are stored once.

use super::super::accessor_reader::AccessorReader;
use super::super::document::Document;
use super::super::report::AssetReport;
use super::super::skin::Skin;
use super::pose::ScenePose;
use glam::{DAffine3, DMat4};
use rtc_source::Resource;
use std::collections::BTreeMap;

/// The bytes of a joint: its matrix and the bits in the key.
const JOINT: u64 = 192;

/// Gives a shape an id; equal shapes share it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct ShapeId {
    weights: usize,
    joints: Option<usize>,
}

/// What moves the vertices of a mesh.
#[derive(Clone, Copy)]
pub(super) struct Deformation<'s> {
    /// The weight of each morph target; missing ones are zero.
    pub(super) weights: &'s [f64],
    /// From the mesh to the world, for each joint.
    pub(super) joints: Option<&'s [DAffine3]>,
}

/// The shapes so far.
#[derive(Default)]
pub(super) struct Deformations {
    weights: UniqueLists<f64>,
    joints: UniqueLists<DAffine3>,
    /// The weights of nodes that have none of their own, by the mesh.
    of_mesh: BTreeMap<usize, usize>,
    of_skin: BTreeMap<usize, usize>,
}

/// Lists by the bits of their numbers.
struct UniqueLists<T> {
    known: BTreeMap<Vec<u64>, usize>,
    lists: Vec<Vec<T>>,
}

impl<T> Default for UniqueLists<T> {
    fn default() -> Self {
        Self {
            known: BTreeMap::new(),
            lists: Vec::new(),
        }
    }
}

impl<T> UniqueLists<T> {
    fn name<const N: usize>(&mut self, list: Vec<T>, numbers: impl Fn(&T) -> [f64; N]) -> usize {
        // The sum turns -0 into 0, which is the same shape.
        let bits = list
            .iter()
            .flat_map(numbers)
            .map(|number| (number + 0.0).to_bits())
            .collect();
        let Self { known, lists } = self;
        *known.entry(bits).or_insert_with(|| {
            lists.push(list);
            lists.len() - 1
        })
    }
}

impl Deformations {
    /// The shape of a mesh at a node, with its skin if any; `None` if that exceeds the budget.
    pub(super) fn of_node(
        &mut self,
        doc: &Document<'_>,
        (node, skin): (usize, Option<usize>),
        (pose, worlds): (&ScenePose, &[DAffine3]),
        report: &mut AssetReport<'_, '_>,
    ) -> Option<ShapeId> {
        let joints = match skin {
            Some(skin) => Some(self.of_skin(doc, skin, worlds, report)?),
            None => None,
        };
        Some(ShapeId {
            weights: self.of_weights(doc, node, pose)?,
            joints,
        })
    }

    fn of_weights(&mut self, doc: &Document<'_>, node: usize, pose: &ScenePose) -> Option<usize> {
        let of = doc.nodes[node].mesh?;
        let animated = pose.weights(node);
        if let Some(known) = self.of_mesh.get(&of).filter(|_| animated.is_none()) {
            return Some(*known);
        }
        let mesh = &doc.meshes[of];
        let weights = animated.unwrap_or(&mesh.weights);
        let weights = &weights[..weights.len().min(mesh.targets())];
        let last = weights.iter().rposition(|weight| *weight != 0.0);
        let name = self.weights.name(
            weights[..last.map_or(0, |last| last + 1)].to_vec(),
            |weight| [*weight],
        );
        if animated.is_none() {
            self.of_mesh.insert(of, name);
        }
        Some(name)
    }

    fn of_skin(
        &mut self,
        doc: &Document<'_>,
        of: usize,
        worlds: &[DAffine3],
        report: &mut AssetReport<'_, '_>,
    ) -> Option<usize> {
        if let Some(known) = self.of_skin.get(&of) {
            return Some(*known);
        }
        let skin = &doc.skins[of];
        if !report.charge(
            Resource::Memory,
            JOINT * skin.joints.len() as u64,
            skin.at,
            "the skin",
        ) {
            return None;
        }
        let name = self
            .joints
            .name(joints(doc, skin, worlds), DAffine3::to_cols_array);
        self.of_skin.insert(of, name);
        Some(name)
    }

    /// The shape of a name.
    pub(super) fn get(&self, id: ShapeId) -> Deformation<'_> {
        let joints = id.joints.map(|joints| self.joints.lists[joints].as_slice());
        Deformation {
            weights: &self.weights.lists[id.weights],
            joints,
        }
    }
}

/// From the mesh to the world for each joint: its inverse bind matrix, then its transform.
fn joints(doc: &Document<'_>, skin: &Skin, worlds: &[DAffine3]) -> Vec<DAffine3> {
    let matrices = skin
        .matrices
        .and_then(|matrices| AccessorReader::of(doc, doc.accessors.get(matrices)?));
    let known = |at: usize| matrices.as_ref().filter(|matrices| at < matrices.count);
    let bind = |at: usize| {
        known(at).map_or(DMat4::IDENTITY, |matrices| {
            DMat4::from_cols_array(&matrices.at(at))
        })
    };
    let world = |joint: usize| worlds.get(joint).copied().unwrap_or(DAffine3::IDENTITY);
    skin.joints
        .iter()
        .enumerate()
        .map(|(at, joint)| world(*joint) * DAffine3::from_mat4(bind(at)))
        .collect()
}
