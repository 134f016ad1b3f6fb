//! World transforms of nodes, computed without recursion, and the nodes of a scene.

use super::super::accessor_reader::AccessorReader;
use super::super::document::Document;
use super::super::node::{GpuInstancing, Node};
use super::pose::ScenePose;
use glam::{DAffine3, DQuat};
use rtc_math::{Vec3, unit};

/// The transformation of each node to the scene, in which the axes of the file are
/// `scene_from_file`; of one in a loop, its own.
pub(super) fn worlds(
    doc: &Document<'_>,
    pose: &ScenePose,
    scene_from_file: Option<[Vec3; 3]>,
) -> Vec<DAffine3> {
    let count = doc.nodes.len();
    // The roots are the nodes that are no child.
    let mut is_child = vec![false; count];
    for child in doc
        .nodes
        .iter()
        .flat_map(|node| &node.children)
        .filter(|child| **child < count)
    {
        is_child[*child] = true;
    }
    let mut worlds: Vec<DAffine3> = (0..count).map(|node| pose.local(node)).collect();
    let mut open: Vec<usize> = (0..count).filter(|node| !is_child[*node]).collect();
    // The axes of the asset are turned into those of the scene.
    if let Some([x, y, z]) = scene_from_file {
        let turn = DAffine3::from_cols(x, y, z, Vec3::ZERO);
        for root in &open {
            worlds[*root] = turn * worlds[*root];
        }
    }
    // Multiply down the hierarchy: `world_from_child = world_from_parent * parent_from_child`.
    while let Some(node) = open.pop() {
        for child in doc.nodes[node]
            .children
            .iter()
            .copied()
            .filter(|child| *child < count)
        {
            worlds[child] = worlds[node] * worlds[child];
            open.push(child);
        }
    }
    worlds
}

/// The nodes that the scene shows, parents before children, in the order of the file; if there is
/// no scene, all.
pub(super) fn shown(doc: &Document<'_>) -> Vec<usize> {
    // A visited node is not rendered again: a coarser level never, a root that has a parent once.
    let mut is_visited = coarser(doc);
    let Some(scene) = doc.scenes.get(doc.scene.unwrap_or(0)) else {
        return (0..doc.nodes.len())
            .filter(|node| doc.nodes[*node].visible && !is_visited[*node])
            .collect();
    };
    let mut shown = Vec::new();
    let mut open: Vec<usize> = scene.nodes.iter().rev().copied().collect();
    while let Some(index) = open.pop() {
        let Some(node) = doc.nodes.get(index).filter(|node| node.visible) else {
            continue;
        };
        if std::mem::replace(&mut is_visited[index], true) {
            continue;
        }
        shown.push(index);
        open.extend(node.children.iter().rev());
    }
    shown
}

/// Which nodes show another one in less detail, or lie below such a node.
fn coarser(doc: &Document<'_>) -> Vec<bool> {
    let mut is_coarser = vec![false; doc.nodes.len()];
    for (index, node) in doc.nodes.iter().enumerate() {
        if is_coarser[index] {
            continue;
        }
        let levels = node.coarser.iter().copied();
        let mut open: Vec<usize> = levels.filter(|level| *level != index).collect();
        while let Some(level) = open.pop() {
            if let Some(slot @ false) = is_coarser.get_mut(level) {
                *slot = true;
                open.extend(&doc.nodes[level].children);
            }
        }
    }
    is_coarser
}

/// The transforms of a mesh at its node.
pub(super) struct InstanceTransforms<'d> {
    /// The transform of the node.
    world: DAffine3,
    /// The instances of `EXT_mesh_gpu_instancing` at the node: translations, rotations and scales.
    instances: Option<[Option<AccessorReader<'d>>; 3]>,
    count: usize,
}

impl<'d> InstanceTransforms<'d> {
    /// The transform of the node only.
    pub(super) fn one(world: DAffine3) -> Self {
        Self {
            world,
            instances: None,
            count: 1,
        }
    }

    /// The transforms of the mesh of a node: of a skinned one its joints move it.
    pub(super) fn of_node(
        doc: &'d Document<'_>,
        node: &Node,
        skin: Option<usize>,
        world: DAffine3,
    ) -> Self {
        match (skin, &node.instances) {
            (Some(_), _) => Self::one(DAffine3::IDENTITY),
            (None, Some(instances)) => Self::many(doc, world, instances),
            (None, None) => Self::one(world),
        }
    }

    /// The transforms of instances.
    pub(super) fn many(doc: &'d Document<'_>, world: DAffine3, instancing: &GpuInstancing) -> Self {
        let elements = |accessor| AccessorReader::of(doc, doc.accessors.get(accessor)?);
        let parts = instancing.parts.map(|accessor| elements(accessor?));
        let read = parts.iter().flatten().map(|reader| reader.count);
        let all = instancing.all.iter();
        let counts = all.filter_map(|accessor| doc.accessors.get(*accessor)?.count);
        Self {
            world,
            count: counts.chain(read).min().unwrap_or(0),
            instances: Some(parts),
        }
    }

    /// The number of transforms.
    pub(super) fn count(&self) -> usize {
        self.count
    }

    /// The transform at `at`, which is below the count.
    pub(super) fn at(&self, at: usize) -> DAffine3 {
        let Some([translations, rotations, scales]) = &self.instances else {
            return self.world;
        };
        let translation = translations
            .as_ref()
            .map_or([0.0; 3], |reader| reader.at(at));
        let rotation = rotations
            .as_ref()
            .map_or([0.0, 0.0, 0.0, 1.0], |reader| reader.at(at));
        self.world
            * compose(
                translation,
                rotation,
                scales.as_ref().map_or([1.0; 3], |reader| reader.at(at)),
            )
    }
}

/// Scale first, then rotation, then translation.
pub(super) fn compose(translation: [f64; 3], rotation: [f64; 4], scale: [f64; 3]) -> DAffine3 {
    let rotation = DQuat::from_array(rotation);
    let rotation = if rotation.length_squared() > 0.0 {
        rotation.normalize()
    } else {
        DQuat::IDENTITY
    };
    DAffine3::from_scale_rotation_translation(
        Vec3::from_array(scale),
        rotation,
        Vec3::from_array(translation),
    )
}

/// True if a transform is invertible, with a margin far above that of the IR.
pub(super) fn has_volume(world: DAffine3) -> bool {
    let axes = [world.x_axis, world.y_axis, world.z_axis];
    let [x, y, z] = axes.map(|axis| unit(axis).unwrap_or(Vec3::ZERO));
    let is_sound = axes
        .iter()
        .all(|axis| axis.is_finite() && axis.abs().max_element() > f64::MIN_POSITIVE);
    is_sound && x.dot(y.cross(z)).abs() >= 1e-9
}
