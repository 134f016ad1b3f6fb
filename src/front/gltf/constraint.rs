//! Constraints on the elements of accessors, by their use: unit vectors, rising times, indices in
//! range.

use super::accessor_reader::AccessorReader;
use super::node::LAST_ROW;
use super::report::AssetReport;
use rtc_diag::codes;
use rtc_source::tree::NodeId;

/// The tolerance of the length of a unit vector of three or four components: the quantisation of 8
/// bits per component.
const UNIT_3: f64 = 0.006_74;
const UNIT_4: f64 = 0.007_69;

/// A constraint on the elements of an accessor.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum AccessorConstraint {
    /// The first three components have length 1.
    Unit,
    /// The fourth component is 1 or -1.
    Sign,
    /// Colours lie between 0 and 1.
    Clamped,
    /// Times rise from 0.
    Times,
    /// Rotations have length 1.
    Rotations,
    /// Of three elements the second is a rotation of length 1.
    CubicRotations,
    /// Indices below the vertex count, of a primitive of this mode.
    Below(usize, u64),
    /// Matrices whose last row is 0, 0, 0, 1.
    Affine,
}

/// The constraints on accessors, each with the node that refers to the accessor.
#[derive(Default)]
pub(super) struct AccessorConstraints(Vec<(usize, AccessorConstraint, NodeId)>);

impl AccessorConstraints {
    pub(super) fn add(&mut self, accessor: usize, constraint: AccessorConstraint, at: NodeId) {
        self.0.push((accessor, constraint, at));
    }

    /// The constraints in the order of the accessors, without duplicates.
    pub(super) fn sorted(self) -> Vec<(usize, AccessorConstraint, NodeId)> {
        let mut constraints = self.0;
        constraints.sort_unstable();
        constraints.dedup_by_key(|(accessor, constraint, _)| (*accessor, *constraint));
        constraints
    }
}

/// Checks one constraint.
pub(super) fn check_constraint(
    elements: &AccessorReader<'_>,
    constraint: AccessorConstraint,
    at: NodeId,
    report: &mut AssetReport<'_, '_>,
) {
    let components = elements.layout.components();
    match constraint {
        // Normals and tangents are unit vectors.
        AccessorConstraint::Unit if components >= 3 => {
            let off =
                |_: usize, element: &[f64]| (length(elements, &element[..3]) - 1.0).abs() > UNIT_3;
            report_violations(
                elements,
                off,
                "ACCESSOR_VECTOR3_NON_UNIT",
                "are not of length 1",
                at,
                report,
            );
        }
        // The handedness of a tangent is 1 or -1.
        AccessorConstraint::Sign if components == 4 => {
            let off = |_: usize, element: &[f64]| elements.fraction(element[3]).abs() - 1.0 != 0.0;
            report_violations(
                elements,
                off,
                "ACCESSOR_INVALID_SIGN",
                "have a handedness that is neither 1 nor -1",
                at,
                report,
            );
        }
        // Colours and weights are fractions.
        AccessorConstraint::Clamped if elements.layout.component.range().is_none() => {
            let off = |_: usize, element: &[f64]| {
                element.iter().any(|number| *number < 0.0 || *number > 1.0)
            };
            report_violations(
                elements,
                off,
                "ACCESSOR_NON_CLAMPED",
                "are not between 0 and 1",
                at,
                report,
            );
        }
        // Rotations are unit quaternions; of three cubic elements only the middle one is a value.
        AccessorConstraint::Rotations | AccessorConstraint::CubicRotations if components == 4 => {
            let counts = |at: usize| constraint == AccessorConstraint::Rotations || at % 3 == 1;
            let off = |at: usize, element: &[f64]| {
                counts(at) && (length(elements, element) - 1.0).abs() > UNIT_4
            };
            let alias = "ACCESSOR_ANIMATION_SAMPLER_OUTPUT_NON_NORMALIZED_QUATERNION";
            report_violations(elements, off, alias, "are not of length 1", at, report);
        }
        // Times, indices and matrices have their own checks.
        AccessorConstraint::Times => times(elements, at, report),
        AccessorConstraint::Below(count, mode) => indices(elements, (count, mode), at, report),
        AccessorConstraint::Affine if components == 16 => affine(elements, at, report),
        AccessorConstraint::Unit
        | AccessorConstraint::Sign
        | AccessorConstraint::Clamped
        | AccessorConstraint::Rotations
        | AccessorConstraint::CubicRotations
        | AccessorConstraint::Affine => {}
    }
}

fn length(elements: &AccessorReader<'_>, vector: &[f64]) -> f64 {
    vector
        .iter()
        .map(|number| elements.fraction(*number))
        .map(|number| number * number)
        .sum::<f64>()
        .sqrt()
}

/// Counts the elements that violate a constraint, and reports them.
fn report_violations(
    elements: &AccessorReader<'_>,
    off: impl Fn(usize, &[f64]) -> bool,
    alias: &'static str,
    what: &str,
    at: NodeId,
    report: &mut AssetReport<'_, '_>,
) {
    let (mut count, mut first) = (0_usize, 0);
    elements.each(|at, element| {
        if off(at, element) {
            first = if count == 0 { at } else { first };
            count += 1;
        }
    });
    if count > 0 {
        let message = format!(
            "{count} of {} elements {what}; the first is element {first}",
            elements.count
        );
        let repair = "they are used unchanged";
        report.repair(&codes::GLTF_VECTOR, alias, at, &message, repair);
    }
}

fn times(elements: &AccessorReader<'_>, at: NodeId, report: &mut AssetReport<'_, '_>) {
    let (mut negative, mut falling, mut before) = (None, None, f64::NEG_INFINITY);
    elements.each(|at, element| {
        let time = element[0];
        if time < 0.0 {
            negative.get_or_insert(at);
        } else {
            if time <= before {
                falling.get_or_insert(at);
            }
            before = time;
        }
    });
    if let Some(index) = negative {
        let message = format!("time {index} is negative");
        report.add(
            &codes::GLTF_ANIMATION,
            "ACCESSOR_ANIMATION_INPUT_NEGATIVE",
            at,
            message,
        );
    }
    if let Some(index) = falling {
        let message = format!("time {index} is not later than the one before it");
        report.add(
            &codes::GLTF_ANIMATION,
            "ACCESSOR_ANIMATION_INPUT_NON_INCREASING",
            at,
            message,
        );
    }
}

/// Checks that indices are below `count`, and counts the triangles that have no area.
fn indices(
    elements: &AccessorReader<'_>,
    (count, mode): (usize, u64),
    at: NodeId,
    report: &mut AssetReport<'_, '_>,
) {
    const TRIANGLES: u64 = 4;
    // The greatest value of the type restarts a primitive.
    let (mut beyond, mut restart, mut degenerate) = (None, None, 0_usize);
    let greatest = elements
        .layout
        .component
        .range()
        .map_or(f64::INFINITY, |[_, most]| most);
    #[expect(clippy::cast_precision_loss, reason = "counts are far below 2^53")]
    let limit = count as f64;
    let mut corners = [-1.0; 3];
    // Test each index, and each triangle for equal corners.
    elements.each(|at, element| {
        let index = element[0];
        if index - greatest == 0.0 {
            restart.get_or_insert(at);
        }
        if index >= limit {
            beyond.get_or_insert((at, index));
        }
        corners[at % 3] = index;
        let [a, b, c] = corners;
        degenerate += usize::from(at % 3 == 2 && ((a - b) * (b - c) * (c - a) == 0.0));
    });
    // Report the first index of each kind, and the number of degenerate triangles.
    if let Some((place, index)) = beyond {
        let message = format!("index {place} is {index}, but there are only {count} vertices");
        report.add(&codes::GLTF_INDEX, "ACCESSOR_INDEX_OOB", at, message);
    }
    if let Some(place) = restart {
        let message = format!(
            "index {place} is {greatest}, the value that restarts a primitive, which glTF forbids"
        );
        report.add(
            &codes::GLTF_INDEX,
            "ACCESSOR_INDEX_PRIMITIVE_RESTART",
            at,
            message,
        );
    }
    if degenerate > 0 && mode == TRIANGLES {
        let message = format!(
            "{degenerate} of {} triangles use one vertex twice",
            elements.count / 3
        );
        report.add(
            &codes::GLTF_REMARK,
            "ACCESSOR_INDEX_TRIANGLE_DEGENERATE",
            at,
            message,
        );
    }
}

fn affine(elements: &AccessorReader<'_>, at: NodeId, report: &mut AssetReport<'_, '_>) {
    let mut off = None;
    elements.each(|at, matrix| {
        let row = [matrix[3], matrix[7], matrix[11], matrix[15] - 1.0];
        if row.iter().any(|number| *number != 0.0) {
            off.get_or_insert(at);
        }
    });
    if let Some(index) = off {
        let message = format!("the last row of matrix {index} is not 0, 0, 0, 1");
        let alias = "ACCESSOR_INVALID_IBM";
        report.repair(&codes::GLTF_MATRIX, alias, at, &message, LAST_ROW);
    }
}
