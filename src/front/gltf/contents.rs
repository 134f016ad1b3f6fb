//! What is in the accessors: finite numbers, true bounds, and what each use asks of the elements.

use super::accessor::Accessor;
use super::document::Document;
use super::elements::Elements;
use super::json::NodeId;
use super::report::Report;
use crate::diag::codes;

/// Components that are looked at, for each byte of the buffers and beside that.
const LOOKS: u64 = 16;
const FREE_LOOKS: u64 = 1 << 24;

/// How far a vector of three or four components may be from length 1: what 8 bits a component
/// allow.
const UNIT_3: f64 = 0.006_74;
const UNIT_4: f64 = 0.007_69;

/// What a use asks of the elements of an accessor.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Demand {
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
    /// Indices below so many, of a primitive of this mode.
    Below(usize, u64),
    /// Matrices that keep points points.
    Affine,
}

/// The demands on accessors, with the place that makes each.
#[derive(Default)]
pub(super) struct Demands(Vec<(usize, Demand, NodeId)>);

impl Demands {
    pub(super) fn add(&mut self, accessor: usize, demand: Demand, at: NodeId) {
        self.0.push((accessor, demand, at));
    }
}

/// Checks the elements of each accessor once, whatever uses it. What was compressed is no longer
/// exact, so bounds and lengths don't count there.
pub(super) fn check(doc: &Document<'_>, demands: Demands, report: &mut Report<'_, '_>) {
    let mut demands = demands.0;
    demands.sort_unstable();
    demands.dedup_by_key(|(accessor, demand, _)| (*accessor, *demand));
    let held: u64 = doc
        .buffers
        .iter()
        .filter_map(|buffer| buffer.bytes.as_ref())
        .map(|bytes| bytes.len() as u64)
        .sum();
    let mut looks = held.saturating_mul(LOOKS).saturating_add(FREE_LOOKS);
    let mut rest = &demands[..];
    for (index, accessor) in doc.accessors.iter().enumerate() {
        let own = rest.partition_point(|(of, _, _)| *of <= index);
        let (own, after) = rest.split_at(own);
        rest = after;
        if accessor.view.is_none() && accessor.sparse.is_none() {
            continue;
        }
        let Some(elements) = Elements::of(doc, accessor) else {
            continue;
        };
        let cost = (elements.count as u64).saturating_mul(elements.layout.components() as u64);
        let Some(left) = looks.checked_sub(cost.saturating_mul(1 + own.len() as u64)) else {
            let message = "the accessors before this one cover the buffers many times over already"
                .to_owned();
            return report.say(&codes::GLTF_HUGE, "", accessor.at, message);
        };
        looks = left;
        sparse(&elements, accessor, report);
        let is_exact = accessor
            .view
            .and_then(|view| doc.views.get(view))
            .is_none_or(|view| view.decoded.is_none());
        values(&elements, accessor, is_exact, report);
        for (_, demand, at) in own
            .iter()
            .filter(|(_, demand, _)| is_exact || matches!(demand, Demand::Below(..)))
        {
            meet(&elements, *demand, *at, report);
        }
    }
}

fn sparse(elements: &Elements<'_>, accessor: &Accessor, report: &mut Report<'_, '_>) {
    let Some(indices) = elements.replaced() else {
        return;
    };
    let at = accessor
        .sparse
        .as_ref()
        .map_or(accessor.at, |sparse| sparse.at);
    let at = report.json.at_or(at, "indices");
    let all = || (0..indices.len()).filter_map(|place| indices.get(place));
    if let Some((place, _)) = all()
        .zip(all().skip(1))
        .enumerate()
        .find(|(_, (a, b))| b <= a)
    {
        let message = format!(
            "the indices don't rise: that at {} is no greater than the one before",
            place + 1
        );
        report.say(
            &codes::GLTF_SPARSE,
            "ACCESSOR_SPARSE_INDICES_NON_INCREASING",
            at,
            message,
        );
    }
    if let Some((place, index)) = all()
        .enumerate()
        .find(|(_, index)| *index >= elements.count)
    {
        let message = format!(
            "the index at {place} is {index}, and there are {} elements",
            elements.count
        );
        report.say(
            &codes::GLTF_SPARSE,
            "ACCESSOR_SPARSE_INDEX_OOB",
            at,
            message,
        );
    }
}

/// Finds numbers that are not finite, and the true bounds.
fn values(
    elements: &Elements<'_>,
    accessor: &Accessor,
    is_exact: bool,
    report: &mut Report<'_, '_>,
) {
    let components = elements.layout.components();
    let (mut least, mut most) = ([f64::INFINITY; 16], [f64::NEG_INFINITY; 16]);
    let (mut bad, mut first) = (0_usize, 0);
    elements.each(|at, element| {
        for (component, number) in element.iter().enumerate() {
            if number.is_finite() {
                least[component] = least[component].min(*number);
                most[component] = most[component].max(*number);
            } else {
                first = if bad == 0 { at } else { first };
                bad += 1;
            }
        }
    });
    if bad > 0 {
        let message = format!("{bad} numbers are not finite, the first in element {first}");
        report.say(
            &codes::GLTF_NOT_FINITE,
            "ACCESSOR_INVALID_FLOAT",
            accessor.at,
            message,
        );
    }
    for (key, own, found) in [("min", &accessor.min, least), ("max", &accessor.max, most)] {
        let Some(own) = own
            .as_ref()
            .filter(|own| is_exact && own.len() == components)
        else {
            continue;
        };
        let is_float = elements.layout.component.range().is_none();
        #[expect(
            clippy::cast_possible_truncation,
            reason = "bounds of floats are compared as floats"
        )]
        let own: Vec<f64> = own
            .iter()
            .map(|own| {
                if is_float {
                    f64::from(*own as f32)
                } else {
                    *own
                }
            })
            .collect();
        let mut beyond = None;
        for (component, found) in found.into_iter().enumerate().take(components) {
            bound(
                (elements, &own, &mut beyond),
                accessor,
                (key, component),
                found,
                report,
            );
        }
    }
}

/// How many elements are beyond a bound, for each component.
fn count_beyond(elements: &Elements<'_>, own: &[f64], is_min: bool) -> [usize; 16] {
    let mut beyond = [0; 16];
    elements.each(|_, element| {
        for ((count, number), own) in beyond.iter_mut().zip(element).zip(own) {
            *count += usize::from(if is_min { number < own } else { number > own });
        }
    });
    beyond
}

/// Compares one component of a bound with what was found; the elements beyond the bound are counted
/// when first needed.
fn bound(
    (elements, all, beyond): (&Elements<'_>, &[f64], &mut Option<[usize; 16]>),
    accessor: &Accessor,
    (key, component): (&str, usize),
    found: f64,
    report: &mut Report<'_, '_>,
) {
    let own = all[component];
    if own.total_cmp(&found).is_eq() || own - found == 0.0 || !found.is_finite() {
        return;
    }
    let is_min = key == "min";
    let (mismatch, out) = if is_min {
        ("ACCESSOR_MIN_MISMATCH", "ACCESSOR_ELEMENT_OUT_OF_MIN_BOUND")
    } else {
        ("ACCESSOR_MAX_MISMATCH", "ACCESSOR_ELEMENT_OUT_OF_MAX_BOUND")
    };
    let list = report.json.at_or(accessor.at, key);
    let at = report.json.items(list).nth(component).unwrap_or(list);
    let message = format!(
        "`{key}` is {own}, and the {} value is {found}",
        if is_min { "least" } else { "greatest" }
    );
    report.say(&codes::GLTF_BOUNDS, mismatch, at, message);
    if (is_min && found < own) || (!is_min && found > own) {
        let beyond = beyond.get_or_insert_with(|| count_beyond(elements, all, is_min))[component];
        let message = format!("{beyond} elements are beyond `{key}`, which is {own}");
        report.say(&codes::GLTF_BOUNDS, out, at, message);
    }
}

/// Checks what one use demands.
fn meet(elements: &Elements<'_>, demand: Demand, at: NodeId, report: &mut Report<'_, '_>) {
    let components = elements.layout.components();
    match demand {
        Demand::Unit if components >= 3 => {
            let off =
                |_: usize, element: &[f64]| (length(elements, &element[..3]) - 1.0).abs() > UNIT_3;
            tell(
                elements,
                off,
                "ACCESSOR_VECTOR3_NON_UNIT",
                "are not of length 1",
                at,
                report,
            );
        }
        Demand::Sign if components == 4 => {
            let off =
                |_: usize, element: &[f64]| (elements.fraction(element[3]).abs() - 1.0).abs() > 0.0;
            tell(
                elements,
                off,
                "ACCESSOR_INVALID_SIGN",
                "have a handedness that is neither 1 nor -1",
                at,
                report,
            );
        }
        Demand::Clamped if elements.layout.component.range().is_none() => {
            let off = |_: usize, element: &[f64]| {
                element.iter().any(|number| !(0.0..=1.0).contains(number))
            };
            tell(
                elements,
                off,
                "ACCESSOR_NON_CLAMPED",
                "are not between 0 and 1",
                at,
                report,
            );
        }
        Demand::Rotations | Demand::CubicRotations if components == 4 => {
            let counts = |at: usize| demand == Demand::Rotations || at % 3 == 1;
            let off = |at: usize, element: &[f64]| {
                counts(at) && (length(elements, element) - 1.0).abs() > UNIT_4
            };
            let alias = "ACCESSOR_ANIMATION_SAMPLER_OUTPUT_NON_NORMALIZED_QUATERNION";
            tell(elements, off, alias, "are not of length 1", at, report);
        }
        Demand::Times => times(elements, at, report),
        Demand::Below(count, mode) => indices(elements, (count, mode), at, report),
        Demand::Affine if components == 16 => affine(elements, at, report),
        Demand::Unit
        | Demand::Sign
        | Demand::Clamped
        | Demand::Rotations
        | Demand::CubicRotations
        | Demand::Affine => {}
    }
}

fn length(elements: &Elements<'_>, vector: &[f64]) -> f64 {
    vector
        .iter()
        .map(|number| elements.fraction(*number))
        .map(|number| number * number)
        .sum::<f64>()
        .sqrt()
}

/// Counts the elements that are off, and tells of them if there are any.
fn tell(
    elements: &Elements<'_>,
    off: impl Fn(usize, &[f64]) -> bool,
    alias: &'static str,
    what: &str,
    at: NodeId,
    report: &mut Report<'_, '_>,
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
            "{count} of {} elements {what}, the first at {first}",
            elements.count
        );
        report.say(&codes::GLTF_VECTOR, alias, at, message);
    }
}

fn times(elements: &Elements<'_>, at: NodeId, report: &mut Report<'_, '_>) {
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
        let message = format!("the time at {index} is negative");
        report.say(
            &codes::GLTF_ANIMATION,
            "ACCESSOR_ANIMATION_INPUT_NEGATIVE",
            at,
            message,
        );
    }
    if let Some(index) = falling {
        let message = format!("the time at {index} is no later than the one before");
        report.say(
            &codes::GLTF_ANIMATION,
            "ACCESSOR_ANIMATION_INPUT_NON_INCREASING",
            at,
            message,
        );
    }
}

/// Checks that indices are below `count`, and counts the triangles that have no area.
fn indices(
    elements: &Elements<'_>,
    (count, mode): (usize, u64),
    at: NodeId,
    report: &mut Report<'_, '_>,
) {
    const TRIANGLES: u64 = 4;
    let (mut beyond, mut restart, mut degenerate) = (None, None, 0_usize);
    let greatest = elements
        .layout
        .component
        .range()
        .map_or(f64::INFINITY, |[_, most]| most);
    #[expect(clippy::cast_precision_loss, reason = "counts are far below 2^53")]
    let limit = count as f64;
    let mut corners = [-1.0; 3];
    elements.each(|at, element| {
        let index = element[0];
        if index - greatest == 0.0 {
            restart.get_or_insert(at);
        } else if index >= limit {
            beyond.get_or_insert((at, index));
        }
        corners[at % 3] = index;
        let [a, b, c] = corners;
        degenerate += usize::from(at % 3 == 2 && ((a - b) * (b - c) * (c - a) == 0.0));
    });
    if let Some((place, index)) = beyond {
        let message = format!("the index at {place} is {index}, and there are {count} vertices");
        report.say(&codes::GLTF_INDEX, "ACCESSOR_INDEX_OOB", at, message);
    }
    if let Some(place) = restart {
        let message = format!("the index at {place} is {greatest}, which restarts a primitive");
        report.say(
            &codes::GLTF_INDEX,
            "ACCESSOR_INDEX_PRIMITIVE_RESTART",
            at,
            message,
        );
    }
    if degenerate > 0 && mode == TRIANGLES {
        let message = format!(
            "{degenerate} of {} triangles have two corners in one vertex",
            elements.count / 3
        );
        report.say(
            &codes::GLTF_REMARK,
            "ACCESSOR_INDEX_TRIANGLE_DEGENERATE",
            at,
            message,
        );
    }
}

fn affine(elements: &Elements<'_>, at: NodeId, report: &mut Report<'_, '_>) {
    let mut off = None;
    elements.each(|at, matrix| {
        let row = [matrix[3], matrix[7], matrix[11], matrix[15] - 1.0];
        if row.iter().any(|number| *number != 0.0) {
            off.get_or_insert(at);
        }
    });
    if let Some(index) = off {
        let message = format!("the last row of the matrix at {index} is not 0, 0, 0, 1");
        report.say(&codes::GLTF_MATRIX, "ACCESSOR_INVALID_IBM", at, message);
    }
}
