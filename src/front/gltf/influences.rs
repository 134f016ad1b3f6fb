//! Skinning weights: the joints of each vertex, and their weights.

use super::accessor_reader::AccessorReader;
use super::document::Document;
use super::report::AssetReport;
use rtc_diag::codes;
use rtc_source::Resource;
use rtc_source::tree::NodeId;
use std::collections::BTreeSet;

/// The errors in the joints of vertices, and the first vertex of each.
#[derive(Default)]
struct JointErrors {
    out: Option<usize>,
    twice: Option<usize>,
    negative: Option<usize>,
    sum: Option<usize>,
    idle: Option<usize>,
}

/// Checks which joints each vertex follows, and by how much.
///
/// `accessors` are those of the joints and the weights, set after set, of the primitive at `at`.
pub(super) fn check(
    doc: &Document<'_>,
    (at, accessors): (NodeId, Vec<[usize; 2]>),
    joints: usize,
    report: &mut AssetReport<'_, '_>,
) {
    // Pair the joints and weights of each set.
    let part = |accessor: usize| {
        let accessor = doc.accessors.get(accessor)?;
        AccessorReader::of(doc, accessor)
            .filter(|_| accessor.view.is_some() || accessor.sparse.is_some())
    };
    let sets = accessors
        .into_iter()
        .map_while(|[joints, weights]| Some([part(joints)?, part(weights)?]));
    let sets: Vec<[AccessorReader<'_>; 2]> = sets.collect();
    // Sets of different lengths are reported elsewhere.
    let count = sets.first().map_or(0, |[joints, _]| joints.count);
    if sets
        .iter()
        .flatten()
        .any(|elements| elements.count != count)
    {
        return;
    }
    // Charge the work before any vertex is read.
    let work = (count as u64).saturating_mul(sets.len() as u64);
    if !report.charge(Resource::Vertices, work, at, "the skin") {
        return;
    }
    // Collect the influences of each vertex over all sets.
    let mut found = JointErrors::default();
    #[expect(clippy::cast_precision_loss, reason = "counts are far below 2^53")]
    let joints = joints as f64;
    let mut vertex = Vec::new();
    for index in 0..count {
        vertex.clear();
        for [joints, weights] in &sets {
            vertex.extend(
                joints
                    .at::<4>(index)
                    .into_iter()
                    .zip(weights.at::<4>(index)),
            );
        }
        found.look(index, &vertex, joints);
    }
    found.report(at, report);
}

impl JointErrors {
    fn look(&mut self, at: usize, vertex: &[(f64, f64)], joints: f64) {
        /// The tolerance of the sum of weights, per weight.
        const ROUNDING: f64 = 2e-7;
        let put = |slot: &mut Option<usize>| {
            slot.get_or_insert(at);
        };
        let (mut sum, mut slack, mut moving) = (0.0_f64, 0.0, BTreeSet::new());
        for (joint, weight) in vertex {
            if *joint >= joints {
                put(&mut self.out);
            } else if *weight == 0.0 {
                if *joint != 0.0 {
                    put(&mut self.idle);
                }
            } else if !moving.insert(joint.to_bits()) {
                put(&mut self.twice);
            } else if *weight < 0.0 {
                put(&mut self.negative);
            } else {
                #[expect(clippy::cast_possible_truncation, reason = "readers sum in 32 bits")]
                let added = (sum + weight) as f32;
                sum = f64::from(added);
                slack += ROUNDING;
            }
        }
        if (sum - 1.0).abs() > slack {
            put(&mut self.sum);
        }
    }

    /// Reports the errors of the primitive at a node.
    fn report(self, at: NodeId, report: &mut AssetReport<'_, '_>) {
        let JointErrors {
            out,
            twice,
            negative,
            sum,
            idle,
        } = self;
        let skin = &codes::GLTF_SKIN;
        // List each violation with its first vertex.
        for (code, place, alias, set, what) in [
            (
                skin,
                out,
                "ACCESSOR_JOINTS_INDEX_OOB",
                "JOINTS_0",
                "uses a joint that the skin does not have",
            ),
            (
                skin,
                twice,
                "ACCESSOR_JOINTS_INDEX_DUPLICATE",
                "JOINTS_0",
                "uses a joint twice",
            ),
            (
                skin,
                negative,
                "ACCESSOR_WEIGHTS_NEGATIVE",
                "WEIGHTS_0",
                "has a negative weight",
            ),
            (
                skin,
                sum,
                "ACCESSOR_WEIGHTS_NON_NORMALIZED",
                "WEIGHTS_0",
                "has skin weights that do not sum to 1",
            ),
            (
                &codes::GLTF_SKIN_ODD,
                idle,
                "ACCESSOR_JOINTS_USED_ZERO_WEIGHT",
                "JOINTS_0",
                "uses a joint with weight 0",
            ),
        ] {
            // Report those that were found.
            let Some(vertex) = place else { continue };
            let place = report.json.at(at, &["attributes", set]);
            let at = place.unwrap_or(at);
            report.add(code, alias, at, format!("vertex {vertex} {what}"));
        }
    }
}
