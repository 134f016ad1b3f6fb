//! Meshes: primitives and morph target weights, and whether they are consistent.

use super::buffer::BufferViewUsages;
use super::constraint::AccessorConstraints;
use super::document::Document;
use super::field::ObjectFields;
use super::primitive::{self, Primitive};
use super::report::AssetReport;
use super::usage::AccessorUsages;
use rtc_diag::codes;
use rtc_source::tree::NodeId;
use std::collections::BTreeMap;

/// A mesh.
#[derive(Debug)]
pub(super) struct Mesh {
    pub(super) at: NodeId,
    pub(super) name: String,
    pub(super) primitives: Vec<Primitive>,
    pub(super) weights: Vec<f64>,
    is_skinned: bool,
}

impl Mesh {
    pub(super) fn read(fields: ObjectFields<'_, '_>) -> Self {
        let primitives: Vec<Primitive> =
            fields.objects("primitives").map(Primitive::read).collect();
        Self {
            at: fields.at,
            name: fields.name(),
            is_skinned: primitives
                .iter()
                .any(|primitive| primitive.find("JOINTS_0").is_some()),
            primitives,
            weights: fields.numbers("weights").unwrap_or_default(),
        }
    }

    /// The number of morph targets of its primitives.
    pub(super) fn targets(&self) -> usize {
        self.primitives
            .first()
            .map_or(0, |primitive| primitive.targets.len())
    }

    /// True if some of its vertices follow joints; unknown for a mesh without primitives.
    pub(super) fn is_skinned(&self) -> Option<bool> {
        (!self.primitives.is_empty()).then_some(self.is_skinned)
    }
}

/// The results of the checks of meshes.
pub(super) struct CheckedMeshes<'l> {
    pub(super) purposes: &'l mut BufferViewUsages,
    pub(super) usages: &'l mut AccessorUsages,
    pub(super) constraints: &'l mut AccessorConstraints,
    /// The accessor that was first seen in each view without a stride.
    pub(super) streams: &'l mut BTreeMap<usize, usize>,
    /// The textures of each material so far, each with its set of texture coordinates.
    pub(super) textures: BTreeMap<NodeId, Vec<(NodeId, u64)>>,
}

/// Checks all meshes.
pub(super) fn check(
    doc: &Document<'_>,
    links: &mut CheckedMeshes<'_>,
    report: &mut AssetReport<'_, '_>,
) {
    for mesh in &doc.meshes {
        // Check each primitive by itself.
        for primitive in &mesh.primitives {
            primitive::check(doc, primitive, links, report);
        }
        // All primitives have as many morph targets as the first.
        let targets = mesh.targets();
        for primitive in mesh
            .primitives
            .iter()
            .filter(|primitive| primitive.targets.len() != targets)
        {
            let at = report.json.at_or(primitive.at, "targets");
            let message = format!(
                "this primitive has {} morph targets, but the first primitive has {targets}",
                primitive.targets.len()
            );
            report.add(
                &codes::GLTF_COUNT,
                "MESH_PRIMITIVES_UNEQUAL_TARGETS_COUNT",
                at,
                message,
            );
        }
        // There is one weight per morph target.
        if !mesh.weights.is_empty() && mesh.weights.len() != targets {
            let at = report.json.at_or(mesh.at, "weights");
            let message = format!(
                "there are {} weights for {targets} morph targets",
                mesh.weights.len()
            );
            report.add(
                &codes::GLTF_COUNT,
                "MESH_INVALID_WEIGHTS_COUNT",
                at,
                message,
            );
        }
    }
}
