//! Accessors: typed elements of buffer views, and whether they are within them.

use super::buffer::{BufferViewUsage, BufferViewUsages};
use super::document::Document;
use super::field::ObjectFields;
use super::layout::{ComponentType, ElementLayout};
use super::report::AssetReport;
use rtc_diag::codes;
use rtc_source::tree::{NodeId, NodeKind};

/// The maximum total size of accessors without data, which are zeros.
const MAX_ZEROS: u64 = 1 << 24;

/// The repair of misaligned elements.
pub(super) const UNALIGNED: &str = "they are read unaligned";

/// Elements.
#[derive(Debug)]
pub(super) struct Accessor {
    pub(super) at: NodeId,
    pub(super) view: Option<usize>,
    pub(super) offset: usize,
    pub(super) count: Option<usize>,
    pub(super) layout: Option<ElementLayout>,
    pub(super) min: Option<Vec<f64>>,
    pub(super) max: Option<Vec<f64>>,
    pub(super) sparse: Option<SparseAccessor>,
}

/// Elements that replace some of an accessor's.
#[derive(Debug)]
pub(super) struct SparseAccessor {
    pub(super) at: NodeId,
    pub(super) count: usize,
    /// The view of the indices, the offset in it, and their type.
    pub(super) indices: (usize, usize, ComponentType),
    /// The view of the elements and the offset in it.
    pub(super) values: (usize, usize),
}

impl Accessor {
    pub(super) fn read(fields: ObjectFields<'_, '_>) -> Self {
        let layout = layout(fields);
        let bound = |key| {
            fields
                .numbers(key)
                .filter(|bound| layout.is_some_and(|layout| layout.is_bound(bound)))
        };
        Self {
            at: fields.at,
            view: fields.index("bufferView"),
            offset: fields.index("byteOffset").unwrap_or(0),
            count: fields.index("count").filter(|count| *count > 0),
            layout,
            min: bound("min"),
            max: bound("max"),
            sparse: fields.object("sparse").and_then(sparse),
        }
    }

    /// True if both bounds are given and sound.
    pub(super) fn has_bounds(&self) -> bool {
        self.min.is_some() && self.max.is_some()
    }
}

fn layout(fields: ObjectFields<'_, '_>) -> Option<ElementLayout> {
    let component = ComponentType::from_code(fields.integer("componentType")?)?;
    let (columns, rows) = match fields.text("type")?.as_str() {
        "SCALAR" => (1, 1),
        "VEC2" => (1, 2),
        "VEC3" => (1, 3),
        "VEC4" => (1, 4),
        "MAT2" => (2, 2),
        "MAT3" => (3, 3),
        "MAT4" => (4, 4),
        _ => return None,
    };
    Some(ElementLayout {
        component,
        columns,
        rows,
        normalized: fields.boolean("normalized"),
    })
}

fn sparse(fields: ObjectFields<'_, '_>) -> Option<SparseAccessor> {
    let (indices, values) = (fields.object("indices")?, fields.object("values")?);
    let component = ComponentType::from_code(indices.integer("componentType")?)
        .filter(|component| component.is_index())?;
    Some(SparseAccessor {
        at: fields.at,
        count: fields.index("count").filter(|count| *count > 0)?,
        indices: (
            indices.index("bufferView")?,
            indices.index("byteOffset").unwrap_or(0),
            component,
        ),
        values: (
            values.index("bufferView")?,
            values.index("byteOffset").unwrap_or(0),
        ),
    })
}

/// The accessor of an index with that index, if it is one.
pub(super) fn find<'d>(
    doc: &'d Document<'_>,
    index: Option<usize>,
    report: &AssetReport<'_, '_>,
) -> Option<(usize, &'d Accessor)> {
    let accessor = doc
        .accessors
        .get(index?)
        .filter(|accessor| report.is_part(accessor.at))?;
    Some((index?, accessor))
}

/// Checks each accessor for itself and against its views.
pub(super) fn check(
    doc: &Document<'_>,
    purposes: &mut BufferViewUsages,
    report: &mut AssetReport<'_, '_>,
) {
    for accessor in &doc.accessors {
        depends(accessor, report);
        let Some(layout) = accessor.layout else {
            continue;
        };
        alone(accessor, layout, report);
        let Some(count) = accessor.count else {
            continue;
        };
        if let Some(view) = accessor.view {
            // The stride of the view must hold an element.
            let stride = doc.views.get(view).and_then(|view| view.stride);
            if let Some(stride) = stride.filter(|stride| *stride < layout.size()) {
                let message = format!(
                    "the stride of the buffer view is {stride}, less than the {} bytes of an \
                    element",
                    layout.size()
                );
                report.add(
                    &codes::GLTF_ACCESSOR,
                    "ACCESSOR_SMALL_BYTESTRIDE",
                    accessor.at,
                    message,
                );
            }
            // All elements lie within the view.
            let bytes = (stride.unwrap_or(layout.packed()) as u64).saturating_mul(count as u64 - 1);
            let place = (view, accessor.offset, layout.component.size());
            fits(
                doc,
                place,
                bytes.saturating_add(layout.size() as u64),
                accessor.at,
                report,
            );
        }
        // Sparse accessors replace some elements by those of other views.
        if let Some(sparse) = &accessor.sparse {
            check_sparse(doc, sparse, (layout, count), purposes, report);
        }
    }
}

/// An offset counts from the start of a view.
fn depends(accessor: &Accessor, report: &mut AssetReport<'_, '_>) {
    if let Some(at) = report
        .json
        .get(accessor.at, "byteOffset")
        .filter(|_| accessor.view.is_none())
    {
        let message = "the accessor has a `byteOffset` but no buffer view";
        let (alias, repair) = ("UNSATISFIED_DEPENDENCY", "it is ignored");
        report.repair(&codes::GLTF_TOGETHER, alias, at, message, repair);
    }
}

/// The checks that need no buffer view.
fn alone(accessor: &Accessor, layout: ElementLayout, report: &mut AssetReport<'_, '_>) {
    let fields = ObjectFields::new(report.json, accessor.at);
    if layout.columns > 1 && accessor.view.is_some() && !accessor.offset.is_multiple_of(4) {
        let at = report.json.at_or(accessor.at, "byteOffset");
        let message = format!(
            "the columns of a matrix must be aligned to 4 bytes, but the offset is {}",
            accessor.offset
        );
        let alias = "ACCESSOR_MATRIX_ALIGNMENT";
        report.repair(&codes::GLTF_ACCESSOR, alias, at, &message, UNALIGNED);
    }
    if layout.normalized && matches!(layout.component, ComponentType::F32 | ComponentType::U32) {
        let at = report.json.at_or(accessor.at, "normalized");
        let message = format!(
            "{} cannot be normalised; only bytes and shorts can",
            layout.component.name()
        );
        report.add(
            &codes::GLTF_ACCESSOR,
            "ACCESSOR_NORMALIZED_INVALID",
            at,
            message,
        );
    }
    for key in ["min", "max"] {
        if let Some(list) = fields.node(key) {
            bound(list, key, layout, report);
        }
    }
}

/// One bound: as many numbers as an element has, each one that the component type can hold.
fn bound(list: NodeId, key: &str, layout: ElementLayout, report: &mut AssetReport<'_, '_>) {
    let kind = report.json.kind(list);
    if kind != NodeKind::List {
        let message = format!(
            "`{key}` is {}; it must be {}",
            kind.name(),
            NodeKind::List.name()
        );
        return report.add(&codes::GLTF_TYPE, "TYPE_MISMATCH", list, message);
    }
    // A bound has one number per component.
    let items: Vec<NodeId> = report.json.items(list).collect();
    if items.is_empty() && layout.component == ComponentType::F32 {
        return report.repair(
            &codes::GLTF_EMPTY,
            "EMPTY_ENTITY",
            list,
            &format!("`{key}` is empty"),
            "it is treated as absent",
        );
    }
    if items.len() != layout.components() {
        let message = format!(
            "`{key}` has {} numbers, but an element has {}",
            items.len(),
            layout.components()
        );
        return report.add(
            &codes::GLTF_VALUE,
            "ARRAY_LENGTH_NOT_IN_LIST",
            list,
            message,
        );
    }
    // Each is a value of the component type.
    for item in items {
        let Some(number) = report.json.number(item) else {
            let message = format!(
                "an element of `{key}` is {}; it must be a number",
                report.json.kind(item).name()
            );
            report.add(&codes::GLTF_TYPE, "ARRAY_TYPE_MISMATCH", item, message);
            continue;
        };
        let Some([least, most]) = layout.component.range() else {
            if !number.is_finite() {
                let message = format!("`{key}` is {}; it must be finite", report.shown(item));
                report.add(&codes::GLTF_VALUE, "VALUE_NOT_IN_RANGE", item, message);
            }
            continue;
        };
        if number.fract() != 0.0 {
            let message = format!(
                "`{key}` is {}, but the components are whole numbers",
                report.shown(item)
            );
            report.add(&codes::GLTF_TYPE, "ARRAY_TYPE_MISMATCH", item, message);
        } else if !(least..=most).contains(&number) {
            let message = format!(
                "`{key}` is {}, which is out of the range of {}",
                report.shown(item),
                layout.component.name()
            );
            report.add(&codes::GLTF_VALUE, "INVALID_GL_VALUE", item, message);
        }
    }
}

/// Checks that `bytes` bytes of components lie within a view, given with the offset in it and the
/// size of a component.
fn fits(
    doc: &Document<'_>,
    (view, offset, size): (usize, usize, usize),
    bytes: u64,
    at: NodeId,
    report: &mut AssetReport<'_, '_>,
) {
    let Some(holder) = doc.views.get(view).filter(|view| report.is_part(view.at)) else {
        return;
    };
    let code = &codes::GLTF_ACCESSOR;
    let place = report.json.at_or(at, "byteOffset");
    // Offsets are multiples of the component size, in the view and in the buffer.
    if !offset.is_multiple_of(size) {
        let message =
            format!("the offset {offset} is not a multiple of {size}, the size of a component");
        report.repair(
            code,
            "ACCESSOR_OFFSET_ALIGNMENT",
            place,
            &message,
            UNALIGNED,
        );
    }
    let total = holder.offset.saturating_add(offset);
    if !total.is_multiple_of(size) {
        let message = format!(
            "the offset in the buffer is {total}; it must be a multiple of {size}, the size of a \
            component"
        );
        let alias = "ACCESSOR_TOTAL_OFFSET_ALIGNMENT";
        report.repair(code, alias, at, &message, UNALIGNED);
    }
    // The last element ends within the view.
    let end = bytes.saturating_add(offset as u64);
    let length = holder.length.unwrap_or(0);
    if end > length as u64 {
        let at = if offset > length { place } else { at };
        let message = format!(
            "the elements end at byte {end} of buffer view {view}, which has {length} bytes"
        );
        report.add(code, "ACCESSOR_TOO_LONG", at, message);
    }
}

fn check_sparse(
    doc: &Document<'_>,
    sparse: &SparseAccessor,
    (layout, count): (ElementLayout, usize),
    purposes: &mut BufferViewUsages,
    report: &mut AssetReport<'_, '_>,
) {
    // No more elements are replaced than there are.
    if sparse.count > count {
        let at = report.json.at_or(sparse.at, "count");
        let message = format!(
            "{} elements are replaced, but there are only {count}",
            sparse.count
        );
        report.add(
            &codes::GLTF_SPARSE,
            "ACCESSOR_SPARSE_COUNT_OUT_OF_RANGE",
            at,
            message,
        );
    }
    // The views of indices and values are tightly packed.
    let (indices, values) = (
        report.json.at_or(sparse.at, "indices"),
        report.json.at_or(sparse.at, "values"),
    );
    for (part, view) in [(indices, sparse.indices.0), (values, sparse.values.0)] {
        let at = report.json.at_or(part, "bufferView");
        purposes.set(Some(view), BufferViewUsage::Other, at, report);
        if doc
            .views
            .get(view)
            .is_some_and(|view| view.stride.is_some())
        {
            let message = "only a buffer view of vertices may have a `byteStride`";
            let (alias, repair) = ("BUFFER_VIEW_INVALID_BYTE_STRIDE", "the stride is ignored");
            report.repair(&codes::GLTF_VIEW, alias, at, message, repair);
        }
    }
    // The indices and the values lie within their views.
    let ((view, offset, component), of) = (sparse.indices, sparse.count as u64);
    let size = component.size();
    fits(
        doc,
        (view, offset, size),
        of.saturating_mul(size as u64),
        indices,
        report,
    );
    let ((view, offset), size) = (sparse.values, layout.component.size());
    fits(
        doc,
        (view, offset, size),
        of.saturating_mul((size * layout.components()) as u64),
        values,
        report,
    );
}

/// Rejects accessors with more zeros than any asset needs; real sparse accessors have fewer.
pub(super) fn check_claims(doc: &Document<'_>, report: &mut AssetReport<'_, '_>) {
    let mut left = MAX_ZEROS;
    for accessor in &doc.accessors {
        let (Some(layout), Some(count), None) = (accessor.layout, accessor.count, accessor.view)
        else {
            continue;
        };
        let bytes = (count as u64).saturating_mul(layout.packed() as u64);
        match left.checked_sub(bytes) {
            Some(rest) => left = rest,
            None => {
                let at = report.json.at_or(accessor.at, "count");
                let message = format!(
                    "the accessor has no buffer view and asks for {count} elements of zeros, \
                    {bytes} bytes"
                );
                report.add(&codes::GLTF_HUGE, "", at, message);
            }
        }
    }
}
