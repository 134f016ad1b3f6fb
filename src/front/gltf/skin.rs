//! Skins: joints in one tree, their matrices, and the nodes that have one.

use super::accessor;
use super::buffer::{BufferViewUsage, BufferViewUsages};
use super::constraint::{AccessorConstraint, AccessorConstraints};
use super::document::Document;
use super::field::ObjectFields;
use super::influences;
use super::layout::{ComponentType, ElementLayout};
use super::node::{Node, NodeHierarchy, NodeTransform};
use super::report::AssetReport;
use super::usage::{AccessorUsage, AccessorUsages};
use rtc_diag::codes;
use rtc_source::tree::NodeId;
use std::collections::{BTreeMap, BTreeSet};

/// A skin.
#[derive(Debug)]
pub(super) struct Skin {
    pub(super) at: NodeId,
    pub(super) joints: Vec<usize>,
    pub(super) matrices: Option<usize>,
    skeleton: Option<usize>,
}

impl Skin {
    pub(super) fn read(fields: ObjectFields<'_, '_>) -> Self {
        Self {
            at: fields.at,
            joints: fields.indices("joints"),
            matrices: fields.index("inverseBindMatrices"),
            skeleton: fields.index("skeleton"),
        }
    }
}

/// Checks all skins, and the nodes that have one.
pub(super) fn check(
    doc: &Document<'_>,
    hierarchy: &NodeHierarchy,
    (purposes, usages, constraints): (
        &mut BufferViewUsages,
        &mut AccessorUsages,
        &mut AccessorConstraints,
    ),
    report: &mut AssetReport<'_, '_>,
) {
    // Check each skin by itself.
    let order = JointOrder::new(doc, hierarchy);
    for skin in &doc.skins {
        check_tree(doc, skin, hierarchy, &order, report);
        check_matrices(doc, skin, (purposes, usages, constraints), report);
    }
    // Check each node with a mesh and a skin.
    let mut scene_trees = ScenesOfTrees::new(doc, hierarchy);
    let mut done = CheckedSkins::default();
    for (index, node) in doc.nodes.iter().enumerate() {
        let skin = node
            .skin
            .and_then(|skin| Some((skin, doc.skins.get(skin)?)));
        let Some((of, skin)) = skin.filter(|(_, skin)| !skin.joints.is_empty()) else {
            continue;
        };
        let Some((at, mesh)) = node
            .mesh
            .and_then(|mesh| Some((mesh, doc.meshes.get(mesh)?)))
        else {
            continue;
        };
        check_node((index, node), hierarchy, report);
        // One scene contains the mesh and its joints.
        if scene_trees.differ(hierarchy.roots[index], of) {
            let message = "the scene contains the mesh but not its joints".to_owned();
            report.add(&codes::GLTF_SKIN, "NODE_SKIN_NO_SCENE", node.at, message);
        }
        // Check the joints and weights of each mesh once per number of joints.
        if done.meshes.insert((at, skin.joints.len())) {
            for primitive in &mesh.primitives {
                let accessors: Vec<[usize; 2]> = primitive.influences().collect();
                if done
                    .influences
                    .insert((accessors.clone(), skin.joints.len()))
                {
                    let vertices = (primitive.at, accessors);
                    influences::check(doc, vertices, skin.joints.len(), report);
                }
            }
        }
    }
}

/// Which scenes show which trees.
struct ScenesOfTrees {
    /// The scenes that show the tree of each root.
    scenes: BTreeMap<usize, BTreeSet<usize>>,
    /// The root above the joints of each skin.
    joints: Vec<Option<usize>>,
    /// For a tree and a skin, whether some scene shows the one without the other.
    known: BTreeMap<(usize, usize), bool>,
}

impl ScenesOfTrees {
    fn new(doc: &Document<'_>, hierarchy: &NodeHierarchy) -> Self {
        let mut scenes: BTreeMap<usize, BTreeSet<usize>> = BTreeMap::new();
        for (index, scene) in doc.scenes.iter().enumerate() {
            for node in &scene.nodes {
                scenes.entry(*node).or_default().insert(index);
            }
        }
        let root = |node: &usize| hierarchy.roots.get(*node).copied().flatten();
        let joints = doc
            .skins
            .iter()
            .map(|skin| skin.joints.iter().find_map(root))
            .collect();
        Self {
            scenes,
            joints,
            known: BTreeMap::new(),
        }
    }

    fn differ(&mut self, root: Option<usize>, skin: usize) -> bool {
        let Some(root) = root else { return false };
        let Self {
            scenes,
            joints,
            known,
        } = self;
        let differ = || {
            let Some(scenes_of_mesh) = scenes.get(&root) else {
                return false;
            };
            let of_joints = joints[skin].and_then(|root| scenes.get(&root));
            of_joints.is_none_or(|of_joints| !scenes_of_mesh.is_subset(of_joints))
        };
        *known.entry((root, skin)).or_insert_with(differ)
    }
}

/// The skins checked so far.
#[derive(Default)]
struct CheckedSkins {
    /// Meshes, with a number of joints.
    meshes: BTreeSet<(usize, usize)>,
    /// The accessors of joints and weights, with a number of joints.
    influences: BTreeSet<(Vec<[usize; 2]>, usize)>,
}

/// The nodes in the order of a walk through their trees: those below one lie in one stretch.
struct JointOrder {
    first: Vec<usize>,
    after: Vec<usize>,
}

impl JointOrder {
    fn new(doc: &Document<'_>, hierarchy: &NodeHierarchy) -> Self {
        let count = doc.nodes.len();
        let mut order = Self {
            first: vec![usize::MAX; count],
            after: vec![0; count],
        };
        let mut at = 0;
        for root in (0..count).filter(|node| hierarchy.roots[*node] == Some(*node)) {
            let mut open = vec![(root, false)];
            while let Some((node, is_done)) = open.pop() {
                if is_done {
                    order.after[node] = at;
                } else if order.first[node] == usize::MAX {
                    order.first[node] = at;
                    at += 1;
                    open.push((node, true));
                    let children = doc.nodes[node]
                        .children
                        .iter()
                        .filter(|child| hierarchy.parents.get(**child) == Some(&Some(node)));
                    open.extend(children.map(|child| (*child, false)));
                }
            }
        }
        order
    }

    fn is_below(&self, node: usize, above: usize) -> bool {
        let place = self.first[node];
        place != usize::MAX && self.first[above] <= place && place < self.after[above]
    }
}

fn check_tree(
    doc: &Document<'_>,
    skin: &Skin,
    hierarchy: &NodeHierarchy,
    order: &JointOrder,
    report: &mut AssetReport<'_, '_>,
) {
    let Some(at) = report
        .json
        .get(skin.at, "joints")
        .filter(|at| report.json.items(*at).next().is_some())
    else {
        return;
    };
    let is_node = |joint: &usize| {
        doc.nodes
            .get(*joint)
            .is_some_and(|node| report.is_part(node.at))
    };
    let known: Vec<usize> = skin.joints.iter().copied().filter(is_node).collect();
    let root = known.first().and_then(|joint| hierarchy.roots[*joint]);
    if root.is_none() || known.iter().any(|joint| hierarchy.roots[*joint] != root) {
        let message = "no node is an ancestor of all joints".to_owned();
        report.add(&codes::GLTF_SKIN, "SKIN_NO_COMMON_ROOT", at, message);
    } else if let Some(skeleton) = skin.skeleton.filter(|skeleton| *skeleton < doc.nodes.len())
        && !known.iter().all(|joint| order.is_below(*joint, skeleton))
    {
        let at = report.json.at_or(skin.at, "skeleton");
        let message = format!("node {skeleton} is not an ancestor of all joints");
        let (alias, repair) = ("SKIN_SKELETON_INVALID", "`skeleton` is ignored");
        report.repair(&codes::GLTF_SKIN, alias, at, &message, repair);
    }
}

fn check_matrices(
    doc: &Document<'_>,
    skin: &Skin,
    (purposes, usages, constraints): (
        &mut BufferViewUsages,
        &mut AccessorUsages,
        &mut AccessorConstraints,
    ),
    report: &mut AssetReport<'_, '_>,
) {
    let Some((index, accessor)) = accessor::find(doc, skin.matrices, report) else {
        return;
    };
    // Record how the skin uses the accessor and its view.
    let at = report.json.at_or(skin.at, "inverseBindMatrices");
    usages.set(index, AccessorUsage::InverseBindMatrices, at, report);
    purposes.set(
        accessor.view,
        BufferViewUsage::InverseBindMatrices,
        at,
        report,
    );
    if accessor
        .view
        .and_then(|view| doc.views.get(view))
        .is_some_and(|view| view.stride.is_some())
    {
        let message = "the buffer view of inverse bind matrices must not have a `byteStride`";
        let (alias, repair) = ("SKIN_IBM_ACCESSOR_WITH_BYTESTRIDE", "the stride is used");
        report.repair(&codes::GLTF_VIEW, alias, at, message, repair);
    }
    // The elements are affine matrices in f32.
    let is_matrix = |layout: ElementLayout| {
        layout.columns == 4 && layout.component == ComponentType::F32 && !layout.normalized
    };
    if accessor.layout.is_some_and(is_matrix) {
        constraints.add(index, AccessorConstraint::Affine, at);
    } else {
        let found = accessor
            .layout
            .map_or("of an unknown type".to_owned(), ElementLayout::name);
        let message = format!("the inverse bind matrices are {found}; they must be mat4 of f32");
        report.add(&codes::GLTF_FORMAT, "SKIN_IBM_INVALID_FORMAT", at, message);
    }
    // There is one matrix per joint.
    if let Some(count) =
        Some(accessor.count.unwrap_or(0)).filter(|count| *count < skin.joints.len())
    {
        let message = format!(
            "there are {count} matrices for {} joints",
            skin.joints.len()
        );
        report.add(
            &codes::GLTF_COUNT,
            "INVALID_IBM_ACCESSOR_COUNT",
            at,
            message,
        );
    }
}

fn check_node(
    (index, node): (usize, &Node),
    hierarchy: &NodeHierarchy,
    report: &mut AssetReport<'_, '_>,
) {
    let code = &codes::GLTF_SKIN_ODD;
    let unmoved = NodeTransform::Parts {
        translation: [0.0; 3],
        rotation: [0.0, 0.0, 0.0, 1.0],
        scale: [1.0; 3],
    };
    if hierarchy.parents[index].is_some() {
        let message = "the node with a skinned mesh is not a root; the transforms of its \
        ancestors are ignored"
            .to_owned();
        report.add(code, "NODE_SKINNED_MESH_NON_ROOT", node.at, message);
    }
    if node.transform != unmoved {
        let message = "the transform of a node with a skinned mesh is ignored".to_owned();
        report.add(code, "NODE_SKINNED_MESH_LOCAL_TRANSFORMS", node.at, message);
    }
}
