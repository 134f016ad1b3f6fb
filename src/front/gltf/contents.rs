//! Validates the elements of accessors: finite numbers, the declared bounds, and the constraints of
//! each use.

use super::accessor::Accessor;
use super::accessor_reader::AccessorReader;
use super::constraint::{AccessorConstraint, AccessorConstraints, check_constraint};
use super::document::Document;
use super::report::AssetReport;
use super::unused::AccessorIndexUses;
use rtc_diag::codes;
use rtc_math::shortest;

/// The maximum number of components checked, per byte of the buffers and in addition.
const LOOKS: u64 = 16;
const FREE_LOOKS: u64 = 1 << 24;

/// The repair of wrong bounds.
const BOUNDS: &str = "the values are used";

/// Checks the elements of each accessor once, for all its uses. Decompressed values are no longer
/// exact, so bounds and lengths are not checked.
pub(super) fn check(
    doc: &Document<'_>,
    constraints: AccessorConstraints,
    report: &mut AssetReport<'_, '_>,
) {
    let constraints = constraints.sorted();
    // Limit the number of elements to read, since views may overlap.
    let held: u64 = doc
        .buffers
        .iter()
        .filter_map(|buffer| buffer.bytes.as_ref())
        .map(|bytes| bytes.len() as u64)
        .sum();
    let mut looks = held.saturating_mul(LOOKS).saturating_add(FREE_LOOKS);
    let mut rest = &constraints[..];
    let mut readers: Option<AccessorIndexUses> = None;
    for (index, accessor) in doc.accessors.iter().enumerate() {
        // Take the constraints of this accessor.
        let current = rest.partition_point(|(of, _, _)| *of <= index);
        let (current, after) = rest.split_at(current);
        rest = after;
        if accessor.view.is_none() && accessor.sparse.is_none() {
            continue;
        }
        let elements = AccessorReader::of(doc, accessor);
        let is_read = |_: &AccessorReader<'_>| report.is_lenient() || is_aligned(doc, accessor);
        let Some(elements) = elements.filter(is_read) else {
            continue;
        };
        // Charge the reads.
        let cost = (elements.count as u64).saturating_mul(elements.layout.components() as u64);
        let Some(left) = looks.checked_sub(cost.saturating_mul(1 + current.len() as u64)) else {
            let message = "the accessors before this one cover the buffers many times over already"
                .to_owned();
            return report.add(&codes::GLTF_HUGE, "", accessor.at, message);
        };
        looks = left;
        sparse(&elements, accessor, report);
        let is_exact = accessor
            .view
            .and_then(|view| doc.views.get(view))
            .is_none_or(|view| view.decoded.is_none());
        // Check for numbers that are not finite, and the declared bounds.
        let bad = values(&elements, accessor, is_exact, report);
        if let Some(first) = bad.first() {
            let readers = readers.get_or_insert_with(|| AccessorIndexUses::new(doc));
            let is_unused = match looks.checked_sub(readers.cost(doc, index)) {
                Some(left) => {
                    looks = left;
                    !readers.names_any(doc, index, |at| bad.binary_search(&at).is_ok())
                }
                None => false,
            };
            not_finite((bad.len(), *first), is_unused, accessor, report);
        }
        // Check the constraints of its uses.
        for (_, constraint, at) in current.iter().filter(|(_, constraint, _)| {
            is_exact || matches!(constraint, AccessorConstraint::Below(..))
        }) {
            check_constraint(&elements, *constraint, *at, report);
        }
    }
}

fn sparse(elements: &AccessorReader<'_>, accessor: &Accessor, report: &mut AssetReport<'_, '_>) {
    let Some(indices) = elements.replaced() else {
        return;
    };
    let at = accessor
        .sparse
        .as_ref()
        .map_or(accessor.at, |sparse| sparse.at);
    let at = report.json.at_or(at, "indices");
    // Sparse indices must increase strictly.
    let all = || (0..indices.len()).filter_map(|place| indices.get(place));
    if let Some((place, _)) = all()
        .zip(all().skip(1))
        .enumerate()
        .find(|(_, (a, b))| b <= a)
    {
        let message = format!(
            "sparse indices must increase: index {} is not greater than the one before it",
            place + 1
        );
        report.add(
            &codes::GLTF_SPARSE,
            "ACCESSOR_SPARSE_INDICES_NON_INCREASING",
            at,
            message,
        );
    }
    // Each must be the index of an element.
    if let Some((place, index)) = all()
        .enumerate()
        .find(|(_, index)| *index >= elements.count)
    {
        let message = format!(
            "index {place} is {index}, but there are only {} elements",
            elements.count
        );
        report.add(
            &codes::GLTF_SPARSE,
            "ACCESSOR_SPARSE_INDEX_OOB",
            at,
            message,
        );
    }
}

/// True if the elements are aligned to the size of their components. Misaligned elements are
/// reported; their values are checked only if they are repaired.
fn is_aligned(doc: &Document<'_>, accessor: &Accessor) -> bool {
    let view = accessor.view.and_then(|view| doc.views.get(view));
    let start = view.map_or(0, |view| match view.decoded {
        Some(_) => 0,
        None => view.offset,
    });
    let size = accessor.layout.map_or(1, |layout| layout.component.size());
    accessor.view.is_none() || (start.saturating_add(accessor.offset)).is_multiple_of(size)
}

/// Reports the number of elements that are not finite, and the first of them.
fn not_finite(
    (count, first): (usize, usize),
    is_unused: bool,
    accessor: &Accessor,
    report: &mut AssetReport<'_, '_>,
) {
    let (code, alias) = (&codes::GLTF_NOT_FINITE, "ACCESSOR_INVALID_FLOAT");
    let message = match count {
        1 => format!("element {first} is NaN or infinite"),
        count => format!("{count} elements are NaN or infinite; the first is element {first}"),
    };
    if is_unused {
        let repair = "no triangle uses these vertices, so they are ignored";
        report.repair(code, alias, accessor.at, &message, repair);
    } else {
        report.add(code, alias, accessor.at, message);
    }
}

/// Finds elements that are not finite, which come back, and the true bounds.
fn values(
    elements: &AccessorReader<'_>,
    accessor: &Accessor,
    is_exact: bool,
    report: &mut AssetReport<'_, '_>,
) -> Vec<usize> {
    let components = elements.layout.components();
    let is_float = elements.layout.component.range().is_none();
    if !is_float && accessor.min.is_none() && accessor.max.is_none() {
        return Vec::new();
    }
    // The first element is a bound even if it is NaN, as in the validator of Khronos.
    let (mut least, mut most) = ([0.0; 16], [0.0; 16]);
    let mut bad = Vec::new();
    elements.each(|at, element| {
        for (component, number) in element.iter().enumerate() {
            if at == 0 || *number < least[component] {
                least[component] = *number;
            }
            if at == 0 || *number > most[component] {
                most[component] = *number;
            }
            if !number.is_finite() && bad.last() != Some(&at) {
                bad.push(at);
            }
        }
    });
    for (key, declared, found) in [("min", &accessor.min, least), ("max", &accessor.max, most)] {
        let Some(declared) = declared
            .as_ref()
            .filter(|declared| is_exact && declared.len() == components)
        else {
            continue;
        };
        #[expect(
            clippy::cast_possible_truncation,
            reason = "bounds of floats are compared as floats"
        )]
        let declared: Vec<f64> = declared
            .iter()
            .map(|declared| {
                if is_float {
                    f64::from(*declared as f32)
                } else {
                    *declared
                }
            })
            .collect();
        let mut beyond = None;
        for (component, found) in found.into_iter().enumerate().take(components) {
            bound(
                (elements, &declared, &mut beyond),
                accessor,
                (key, component),
                found,
                report,
            );
        }
    }
    bad
}

/// The number of elements beyond a bound, for each component.
fn count_beyond(elements: &AccessorReader<'_>, declared: &[f64], is_min: bool) -> [usize; 16] {
    let mut beyond = [0; 16];
    elements.each(|_, element| {
        for ((count, number), declared) in beyond.iter_mut().zip(element).zip(declared) {
            *count += usize::from(if is_min {
                number < declared
            } else {
                number > declared
            });
        }
    });
    beyond
}

/// Compares one component of a bound with the actual one; the elements beyond the bound are counted
/// when first needed.
fn bound(
    (elements, all, beyond): (&AccessorReader<'_>, &[f64], &mut Option<[usize; 16]>),
    accessor: &Accessor,
    (key, component): (&str, usize),
    found: f64,
    report: &mut AssetReport<'_, '_>,
) {
    // A declared bound that equals the computed one is right.
    let declared = all[component];
    if declared.total_cmp(&found).is_eq() || declared - found == 0.0 {
        return;
    }
    // Otherwise the values of the elements replace it.
    let is_min = key == "min";
    let (mismatch, out) = if is_min {
        ("ACCESSOR_MIN_MISMATCH", "ACCESSOR_ELEMENT_OUT_OF_MIN_BOUND")
    } else {
        ("ACCESSOR_MAX_MISMATCH", "ACCESSOR_ELEMENT_OUT_OF_MAX_BOUND")
    };
    let list = report.json.at_or(accessor.at, key);
    let at = report.json.items(list).nth(component).unwrap_or(list);
    let message = format!(
        "`{key}` is {}, but the {} value is {}",
        shortest(declared),
        if is_min { "least" } else { "greatest" },
        shortest(found)
    );
    report.repair(&codes::GLTF_BOUNDS, mismatch, at, &message, BOUNDS);
    // Count the elements that lie outside the declared bound.
    let beyond = beyond.get_or_insert_with(|| count_beyond(elements, all, is_min))[component];
    if beyond > 0 {
        let message = format!(
            "{beyond} elements are outside `{key}`, which is {}",
            shortest(declared)
        );
        report.repair(&codes::GLTF_BOUNDS, out, at, &message, BOUNDS);
    }
}
