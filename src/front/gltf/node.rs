//! Nodes: transforms, and the node hierarchy, which is traversed without recursion.

use super::document::Document;
use super::field::ObjectFields;
use super::report::AssetReport;
use rtc_diag::codes;
use rtc_math::unit;
use rtc_source::tree::{NodeId, SyntaxTree};
use std::collections::BTreeSet;

/// By how much the length of a rotation's quaternion may differ from 1.
const UNIT: f64 = 0.007_69;
const IDENTITY: [f64; 16] = [
    1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0,
];

/// The extension that names coarser levels of detail.
const LEVELS: &str = "MSFT_lod";

/// The repair of a matrix that is not affine.
pub(super) const LAST_ROW: &str = "the last row is read as 0, 0, 0, 1";

/// A node.
#[derive(Debug)]
pub(super) struct Node {
    pub(super) at: NodeId,
    pub(super) name: String,
    pub(super) transform: NodeTransform,
    pub(super) children: Vec<usize>,
    pub(super) mesh: Option<usize>,
    pub(super) skin: Option<usize>,
    pub(super) camera: Option<usize>,
    pub(super) light: Option<usize>,
    /// The weights of morph targets that override those of the mesh.
    pub(super) weights: Vec<f64>,
    /// Whether its contents are visible.
    pub(super) visible: bool,
    /// The nodes that show the same in less detail (`MSFT_lod`).
    pub(super) coarser: Vec<usize>,
    /// The instances of its mesh.
    pub(super) instances: Option<GpuInstancing>,
}

/// The accessors of `EXT_mesh_gpu_instancing`.
#[derive(Clone, Debug)]
pub(super) struct GpuInstancing {
    /// Translation, rotation, scale.
    pub(super) parts: [Option<usize>; 3],
    /// The accessors of all attributes, application-specific ones too; each gives the number of
    /// instances.
    pub(super) all: Vec<usize>,
}

impl GpuInstancing {
    fn read(attributes: ObjectFields<'_, '_>) -> Self {
        let pairs = attributes.json.pairs(attributes.at);
        let accessors = pairs.filter_map(|(_, at)| attributes.json.integer(at));
        Self {
            parts: ["TRANSLATION", "ROTATION", "SCALE"].map(|name| attributes.index(name)),
            all: accessors
                .filter_map(|at| usize::try_from(at).ok())
                .collect(),
        }
    }
}

/// The transform of a node in its parent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum NodeTransform {
    /// Column by column.
    Matrix([f64; 16]),
    /// Scale first, then rotation, then translation.
    Parts {
        translation: [f64; 3],
        rotation: [f64; 4],
        scale: [f64; 3],
    },
}

impl Node {
    pub(super) fn read(fields: ObjectFields<'_, '_>) -> Self {
        let parts = NodeTransform::Parts {
            translation: fields.vector_or("translation", [0.0; 3]),
            rotation: fields.vector_or("rotation", [0.0, 0.0, 0.0, 1.0]),
            scale: fields.vector_or("scale", [1.0; 3]),
        };
        let instancing = fields
            .extension("EXT_mesh_gpu_instancing")
            .and_then(|fields| fields.object("attributes"));
        Self {
            at: fields.at,
            name: fields.name(),
            transform: fields.vector("matrix").map_or(parts, NodeTransform::Matrix),
            children: fields.indices("children"),
            mesh: fields.index("mesh"),
            skin: fields.index("skin"),
            camera: fields.index("camera"),
            light: fields
                .extension("KHR_lights_punctual")
                .and_then(|fields| fields.index("light")),
            weights: fields.numbers("weights").unwrap_or_default(),
            visible: fields
                .extension("KHR_node_visibility")
                .is_none_or(|fields| !fields.has("visible") || fields.boolean("visible")),
            coarser: fields
                .extension(LEVELS)
                .map_or_else(Vec::new, |fields| fields.indices("ids")),
            instances: instancing.map(GpuInstancing::read),
        }
    }
}

/// The parent of each node.
pub(super) struct NodeHierarchy {
    pub(super) parents: Vec<Option<usize>>,
    /// The root above each node; none in a loop.
    pub(super) roots: Vec<Option<usize>>,
}

/// Checks each node, and that they form trees.
pub(super) fn check(doc: &Document<'_>, report: &mut AssetReport<'_, '_>) -> NodeHierarchy {
    // Check each node by itself; a joint may be empty.
    let joints: BTreeSet<usize> = doc
        .skins
        .iter()
        .flat_map(|skin| skin.joints.iter().copied())
        .collect();
    for (index, node) in doc.nodes.iter().enumerate() {
        check_transform(node, report);
        check_mesh(doc, node, report);
        report_levels(node.at, report);
        if !joints.contains(&index) && report.is_part(node.at) {
            check_empty(node, report);
        }
    }
    // Each node has at most one parent.
    let mut parents = vec![None; doc.nodes.len()];
    let index_at = |at: NodeId, json: &SyntaxTree<'_>| usize::try_from(json.integer(at)?).ok();
    for (index, node) in doc.nodes.iter().enumerate() {
        for at in report.json.list(node.at, "children") {
            let Some(child) = index_at(at, report.json) else {
                continue;
            };
            match parents.get_mut(child) {
                Some(parent @ None) => *parent = Some(index),
                Some(Some(parent)) if *parent != index => {
                    let before = std::mem::replace(parent, index);
                    let message = format!("node {child} is already a child of node {before}");
                    report.add(&codes::GLTF_NODES, "NODE_PARENT_OVERRIDE", at, message);
                }
                Some(Some(_)) | None => {}
            }
        }
    }
    // Scenes list roots only.
    let roots = roots(doc, &parents, report);
    for scene in &doc.scenes {
        for at in report.json.list(scene.at, "nodes") {
            let Some(node) = index_at(at, report.json) else {
                continue;
            };
            if parents.get(node).is_some_and(Option::is_some) {
                let message =
                    format!("node {node} is a child, but a scene may list only root nodes");
                report.repair(
                    &codes::GLTF_NODES,
                    "SCENE_NON_ROOT_NODE",
                    at,
                    &message,
                    "it appears once, under its parent",
                );
            }
        }
    }
    NodeHierarchy { parents, roots }
}

/// Walks up from each node to one whose root is known; a walk that meets itself is a cycle.
fn roots(
    doc: &Document<'_>,
    parents: &[Option<usize>],
    report: &mut AssetReport<'_, '_>,
) -> Vec<Option<usize>> {
    #[derive(Clone, Copy)]
    enum NodeState {
        New,
        OnWay,
        Finished(Option<usize>),
    }
    // Follow the parents of each node up to a root or a node of known root.
    let mut states = vec![NodeState::New; parents.len()];
    for start in 0..parents.len() {
        let (mut path, mut at): (Vec<usize>, usize) = (Vec::new(), start);
        let root = loop {
            match states[at] {
                NodeState::Finished(root) => break root,
                // The path met itself: its nodes form a cycle.
                NodeState::OnWay => {
                    let first = path.iter().position(|node| *node == at).unwrap_or(0);
                    for node in &path[first..] {
                        let message = format!("node {node} is its own ancestor");
                        report.add(
                            &codes::GLTF_NODES,
                            "NODE_LOOP",
                            doc.nodes[*node].at,
                            message,
                        );
                    }
                    break None;
                }
                NodeState::New => {
                    states[at] = NodeState::OnWay;
                    path.push(at);
                    match parents[at] {
                        Some(parent) => at = parent,
                        None => break Some(at),
                    }
                }
            }
        };
        // All nodes of the path have this root.
        path.into_iter()
            .for_each(|node| states[node] = NodeState::Finished(root));
    }
    let root = |state: &NodeState| {
        if let NodeState::Finished(root) = state {
            *root
        } else {
            None
        }
    };
    states.iter().map(root).collect()
}

fn check_transform(node: &Node, report: &mut AssetReport<'_, '_>) {
    match node.transform {
        NodeTransform::Matrix(matrix) => {
            let at = report.json.at_or(node.at, "matrix");
            let fields = ObjectFields::new(report.json, node.at);
            // A matrix excludes the separate transforms.
            if ["translation", "rotation", "scale"]
                .iter()
                .any(|key| fields.numbers(key).is_some())
            {
                let message = "a node may have a `matrix` or `translation`, `rotation` and \
                `scale`, but not both"
                    .to_owned();
                report.add(&codes::GLTF_TOGETHER, "NODE_MATRIX_TRS", at, message);
            }
            // The matrix must be affine and invertible.
            if matrix == IDENTITY {
                let message = "the matrix is the identity, which is the default".to_owned();
                report.add(&codes::GLTF_REMARK, "NODE_MATRIX_DEFAULT", at, message);
            } else if !is_invertible(&matrix) {
                let message = "the matrix is no product of translation, rotation and scale";
                report.repair(
                    &codes::GLTF_MATRIX,
                    "NODE_MATRIX_NON_TRS",
                    at,
                    message,
                    LAST_ROW,
                );
            } else if is_sheared(&matrix) {
                let message =
                    "the matrix contains shear, which some readers of glTF do not support"
                        .to_owned();
                let hint = "apply the shear to the vertices, for these readers".to_owned();
                report.add_with_hint(&codes::GLTF_REMARK, "", at, message, hint);
            }
        }
        NodeTransform::Parts {
            translation: _,
            rotation,
            scale: _,
        } => {
            // A rotation is a unit quaternion.
            let length = rotation.iter().map(|part| part * part).sum::<f64>().sqrt();
            if (length - 1.0).abs() > UNIT {
                let at = report.json.at_or(node.at, "rotation");
                let message =
                    format!("the rotation has length {length}; it must be a unit quaternion");
                report.add(&codes::GLTF_VALUE, "ROTATION_NON_UNIT", at, message);
            }
        }
    }
}

/// Notes that of the levels of detail at a node or a material the finest is shown.
pub(super) fn report_levels(at: NodeId, report: &mut AssetReport<'_, '_>) {
    let levels = ObjectFields::new(report.json, at).extension(LEVELS);
    if let Some(levels) = levels {
        let count = 1 + levels.indices("ids").len();
        let message = format!("the finest of {count} levels of detail is used");
        report.add(&codes::GLTF_IGNORES, "", levels.at, message);
    }
}

fn columns(matrix: &[f64; 16]) -> [glam::DVec3; 3] {
    [0, 4, 8].map(|at| glam::DVec3::new(matrix[at], matrix[at + 1], matrix[at + 2]))
}

/// True if a matrix is affine and keeps space three-dimensional.
fn is_invertible(matrix: &[f64; 16]) -> bool {
    let [x, y, z] = columns(matrix).map(|column| unit(column).unwrap_or_default());
    let last_row = [matrix[3], matrix[7], matrix[11], matrix[15] - 1.0];
    last_row.iter().all(|part| *part == 0.0) && x.cross(y).dot(z) != 0.0
}

/// True if the axes are not perpendicular, within the precision of 32-bit floats and of exporters.
fn is_sheared(matrix: &[f64; 16]) -> bool {
    const RIGHT_ANGLE: f64 = 1e-3;
    let [x, y, z] = columns(matrix).map(|column| unit(column).unwrap_or_default());
    [x.dot(y), y.dot(z), z.dot(x)]
        .iter()
        .any(|cosine| cosine.abs() > RIGHT_ANGLE)
}

fn check_mesh(doc: &Document<'_>, node: &Node, report: &mut AssetReport<'_, '_>) {
    let mesh = node.mesh.and_then(|mesh| doc.meshes.get(mesh));
    let fields = ObjectFields::new(report.json, node.at);
    // Weights need a mesh with as many morph targets.
    if let Some(at) = fields.node("weights").filter(|_| !node.weights.is_empty()) {
        if node.mesh.is_none() {
            let message = "the node has `weights` but no mesh".to_owned();
            report.add(&codes::GLTF_TOGETHER, "UNSATISFIED_DEPENDENCY", at, message);
        } else if let Some(mesh) =
            mesh.filter(|mesh| !mesh.primitives.is_empty() && mesh.targets() != node.weights.len())
        {
            let message = format!(
                "there are {} weights for {} morph targets",
                node.weights.len(),
                mesh.targets()
            );
            report.add(&codes::GLTF_COUNT, "NODE_WEIGHTS_INVALID", at, message);
        }
    }
    // A skin needs a mesh.
    if let Some(at) = fields
        .node("skin")
        .filter(|_| node.skin.is_some() && node.mesh.is_none())
    {
        let message = "the node has a `skin` but no mesh".to_owned();
        report.add(&codes::GLTF_TOGETHER, "UNSATISFIED_DEPENDENCY", at, message);
    }
    // A skinned mesh and a skin belong together.
    match (mesh, node.skin.and_then(|skin| doc.skins.get(skin))) {
        (Some(mesh), Some(_)) if mesh.is_skinned() == Some(false) => {
            let message = "the node has a skin, but its mesh has no `JOINTS_0`".to_owned();
            report.add(
                &codes::GLTF_SKIN,
                "NODE_SKIN_WITH_NON_SKINNED_MESH",
                node.at,
                message,
            );
        }
        (Some(mesh), None) if mesh.is_skinned() == Some(true) => {
            let message = "the mesh has `JOINTS_0`, but the node has no skin".to_owned();
            report.add(
                &codes::GLTF_SKIN_ODD,
                "NODE_SKINNED_MESH_WITHOUT_SKIN",
                node.at,
                message,
            );
        }
        (_, _) => {}
    }
}

fn check_empty(node: &Node, report: &mut AssetReport<'_, '_>) {
    let fields = ObjectFields::new(report.json, node.at);
    let declares = ["children", "mesh", "camera", "extensions", "extras"];
    if !declares.iter().any(|key| fields.has(key)) {
        report.add(
            &codes::GLTF_REMARK,
            "NODE_EMPTY",
            node.at,
            "the node is empty",
        );
    }
}
