//! Vertex attributes: their names, formats and alignment.

use super::accessor::{Accessor, UNALIGNED};
use super::constraint::{AccessorConstraint, AccessorConstraints};
use super::document::Document;
use super::field::ObjectFields;
use super::layout::{ComponentType, ElementLayout};
use super::primitive::Primitive;
use super::report::{AssetReport, shown};
use rtc_diag::codes;
use rtc_source::tree::NodeId;
use std::collections::{BTreeMap, BTreeSet};

/// The role of an accessor for the vertices.
#[derive(Debug)]
pub(super) struct VertexAttribute {
    pub(super) at: NodeId,
    pub(super) name: String,
    pub(super) accessor: usize,
}

/// Reads a map of attributes and their accessors.
pub(super) fn read(fields: ObjectFields<'_, '_>) -> Vec<VertexAttribute> {
    let attribute = |(key, at): (NodeId, NodeId)| {
        let accessor = usize::try_from(fields.json.integer(at)?).ok()?;
        Some(VertexAttribute {
            at,
            name: fields.json.text(key)?.to_owned(),
            accessor,
        })
    };
    fields.json.pairs(fields.at).filter_map(attribute).collect()
}

/// The semantic of an attribute, with the number of its set.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum AttributeSemantic {
    Position,
    Normal,
    Tangent,
    Uv(u64),
    Color(u64),
    Joints(u64),
    Weights(u64),
    /// It starts with an underscore, and we don't know, or with the name of an extension.
    Custom,
    /// It is no attribute semantic.
    None,
}

impl AttributeSemantic {
    pub(super) fn of(name: &str) -> Self {
        match name {
            "POSITION" => return Self::Position,
            "NORMAL" => return Self::Normal,
            "TANGENT" => return Self::Tangent,
            name if name.starts_with('_') => return Self::Custom,
            _ => {}
        }
        let extension = name.split_once(':').map(|(extension, _)| extension);
        if extension.is_some_and(|extension| super::schema::find(extension).is_some()) {
            return Self::Custom;
        }
        let Some((kind, set)) = name.split_once('_') else {
            return Self::None;
        };
        let digits = set.bytes().all(|byte| byte.is_ascii_digit())
            && (set.len() == 1 || !set.starts_with('0'));
        let Some(set) = set.parse().ok().filter(|_| digits) else {
            return Self::None;
        };
        match kind {
            "TEXCOORD" => Self::Uv(set),
            "COLOR" => Self::Color(set),
            "JOINTS" => Self::Joints(set),
            "WEIGHTS" => Self::Weights(set),
            _ => Self::None,
        }
    }
}

/// Checks the names of the attributes of a primitive, and that none is missing.
pub(super) fn check_names(primitive: &Primitive, report: &mut AssetReport<'_, '_>) {
    // Each name is that of a semantic, or starts with an underscore.
    let semantics: Vec<AttributeSemantic> = primitive
        .attributes
        .iter()
        .map(|attribute| AttributeSemantic::of(&attribute.name))
        .collect();
    for attribute in primitive
        .attributes
        .iter()
        .filter(|attribute| AttributeSemantic::of(&attribute.name) == AttributeSemantic::None)
    {
        let message = format!(
            "`{}` is not a valid name of an attribute",
            shown(&attribute.name)
        );
        report.add(
            &codes::GLTF_ATTRIBUTE,
            "MESH_PRIMITIVE_INVALID_ATTRIBUTE",
            attribute.at,
            message,
        );
    }
    // Positions are needed, and tangents need normals.
    let has = |semantic| semantics.contains(&semantic);
    let at = report.json.at_or(primitive.at, "attributes");
    if !primitive.attributes.is_empty() && !has(AttributeSemantic::Position) {
        let message = "the primitive has no `POSITION`, so it is invisible".to_owned();
        report.add(
            &codes::GLTF_PRIMITIVE_ODD,
            "MESH_PRIMITIVE_NO_POSITION",
            at,
            message,
        );
    }
    if has(AttributeSemantic::Tangent) && !has(AttributeSemantic::Normal) {
        let at = report.json.at_or(at, "TANGENT");
        let message = "the primitive has `TANGENT` but no `NORMAL`".to_owned();
        report.add(
            &codes::GLTF_PRIMITIVE_ODD,
            "MESH_PRIMITIVE_TANGENT_WITHOUT_NORMAL",
            at,
            message,
        );
    }
    // The sets of one semantic are numbered from 0.
    check_sets(&semantics, at, report);
}

fn check_sets(semantics: &[AttributeSemantic], at: NodeId, report: &mut AssetReport<'_, '_>) {
    type Kind = fn(u64) -> AttributeSemantic;
    let kinds: [(&str, Kind); 4] = [
        ("TEXCOORD", AttributeSemantic::Uv),
        ("COLOR", AttributeSemantic::Color),
        ("JOINTS", AttributeSemantic::Joints),
        ("WEIGHTS", AttributeSemantic::Weights),
    ];
    let mut counts = [0; 4];
    let present: BTreeSet<AttributeSemantic> = semantics.iter().copied().collect();
    for ((name, kind), count) in kinds.into_iter().zip(&mut counts) {
        // The first missing set number ends the sets; higher ones are unused.
        *count = semantics
            .iter()
            .filter(|semantic| {
                std::mem::discriminant(*semantic) == std::mem::discriminant(&kind(0))
            })
            .count();
        let gap = (0..*count as u64).find(|set| !present.contains(&kind(*set)));
        if let Some(gap) = gap {
            let message =
                format!("there are {count} sets of `{name}`, but `{name}_{gap}` is missing");
            report.add(
                &codes::GLTF_ATTRIBUTE,
                "MESH_PRIMITIVE_INDEXED_SEMANTIC_CONTINUITY",
                at,
                message,
            );
        }
    }
    let [_, _, joints, weights] = counts;
    if joints != weights {
        let message = format!("there are {joints} sets of joints but {weights} sets of weights");
        report.add(
            &codes::GLTF_COUNT,
            "MESH_PRIMITIVE_JOINTS_WEIGHTS_MISMATCH",
            at,
            message,
        );
    }
}

/// Checks that an attribute of a primitive, or of a morph target, has a format that its name
/// allows.
pub(super) fn check_format(
    doc: &Document<'_>,
    attribute: &VertexAttribute,
    accessor: &Accessor,
    in_target: bool,
    report: &mut AssetReport<'_, '_>,
) {
    let semantic = AttributeSemantic::of(&attribute.name);
    // Bounds of positions are required by the specification.
    if semantic == AttributeSemantic::Position && !accessor.has_bounds() {
        report.repair(
            &codes::GLTF_FORMAT,
            "MESH_PRIMITIVE_POSITION_ACCESSOR_WITHOUT_BOUNDS",
            attribute.at,
            "the accessor of positions needs `min` and `max`",
            "they are computed",
        );
    }
    // The element type must be known.
    let Some(layout) = accessor.layout else {
        if !matches!(
            semantic,
            AttributeSemantic::Custom | AttributeSemantic::None
        ) {
            let message = format!(
                "`{}` has no element type or no component type",
                attribute.name
            );
            let alias = "MESH_PRIMITIVE_ATTRIBUTES_ACCESSOR_INVALID_FORMAT";
            report.add(&codes::GLTF_FORMAT, alias, attribute.at, message);
        }
        return;
    };
    // The semantic allows certain element types; quantization adds some.
    let quantized = doc.uses("KHR_mesh_quantization");
    if !allows(semantic, layout, quantized, in_target) {
        let message = format!(
            "`{}` is {}, a type that `{}` does not allow",
            attribute.name,
            layout.name(),
            attribute.name
        );
        report.add(
            &codes::GLTF_FORMAT,
            "MESH_PRIMITIVE_ATTRIBUTES_ACCESSOR_INVALID_FORMAT",
            attribute.at,
            message,
        );
    } else if semantic == AttributeSemantic::Custom && layout.component == ComponentType::U32 {
        let message = "a vertex attribute must not be u32".to_owned();
        report.add(
            &codes::GLTF_FORMAT,
            "MESH_PRIMITIVE_ATTRIBUTES_ACCESSOR_UNSIGNED_INT",
            attribute.at,
            message,
        );
    }
}

/// True if the specification, or `KHR_mesh_quantization`, has the format for the attribute.
fn allows(
    semantic: AttributeSemantic,
    layout: ElementLayout,
    quantized: bool,
    in_target: bool,
) -> bool {
    use ComponentType::{F32, I8, I16, U8, U16, U32};
    let ElementLayout {
        component,
        columns,
        rows,
        normalized,
    } = layout;
    let is = |rows_of: &[usize]| columns == 1 && rows_of.contains(&rows);
    let float = component == F32 && !normalized;
    let unsigned_fraction = normalized && matches!(component, U8 | U16);
    let signed_fraction = normalized && matches!(component, I8 | I16);
    let small = matches!(component, I8 | U8 | I16 | U16);
    let signed = matches!(component, I8 | I16);
    match semantic {
        AttributeSemantic::Position => {
            is(&[3]) && (float || quantized && if in_target { signed } else { small })
        }
        AttributeSemantic::Normal => is(&[3]) && (float || quantized && signed_fraction),
        AttributeSemantic::Tangent => {
            let rows: &[usize] = if in_target { &[3] } else { &[4] };
            is(rows) && (float || quantized && signed_fraction)
        }
        AttributeSemantic::Uv(_) => is(&[2]) && (float || unsigned_fraction || quantized && small),
        AttributeSemantic::Color(_) => {
            is(&[3, 4]) && (float || unsigned_fraction || in_target && signed_fraction)
        }
        AttributeSemantic::Joints(_) => is(&[4]) && !normalized && matches!(component, U8 | U16),
        AttributeSemantic::Weights(_) => is(&[4]) && (float || unsigned_fraction),
        AttributeSemantic::Custom | AttributeSemantic::None => {
            component != U32 || semantic == AttributeSemantic::Custom
        }
    }
}

/// Checks that vertex data is aligned, and has a stride where accessors share a view; `streams` has
/// those seen before.
pub(super) fn check_place(
    doc: &Document<'_>,
    attribute: &VertexAttribute,
    accessor: &Accessor,
    streams: &mut BTreeMap<usize, usize>,
    report: &mut AssetReport<'_, '_>,
) {
    let Some((index, view)) = accessor
        .view
        .and_then(|view| Some((view, doc.views.get(view)?)))
    else {
        return;
    };
    if !report.is_part(view.at) {
        return;
    }
    // Vertex data is aligned to four bytes.
    if !is_aligned(accessor, view.stride) {
        report.repair(
            &codes::GLTF_ACCESSOR,
            "MESH_PRIMITIVE_ACCESSOR_UNALIGNED",
            attribute.at,
            "vertex data must be aligned to 4 bytes",
            UNALIGNED,
        );
    }
    // A view that several attributes share needs a stride.
    if view.stride.is_none()
        && *streams.entry(index).or_insert(attribute.accessor) != attribute.accessor
    {
        let message =
            format!("buffer view {index} contains several attributes but has no `byteStride`");
        report.repair(
            &codes::GLTF_VIEW,
            "MESH_PRIMITIVE_ACCESSOR_WITHOUT_BYTESTRIDE",
            attribute.at,
            &message,
            "the elements of each are read as tightly packed",
        );
    }
}

/// The constraints on the elements of an attribute.
pub(super) fn add_constraints(
    attribute: &VertexAttribute,
    accessor: &Accessor,
    constraints: &mut AccessorConstraints,
) {
    let mut add = |constraint| constraints.add(attribute.accessor, constraint, attribute.at);
    match AttributeSemantic::of(&attribute.name) {
        AttributeSemantic::Normal => add(AccessorConstraint::Unit),
        AttributeSemantic::Tangent
            if accessor
                .layout
                .is_some_and(|layout| layout.components() == 4) =>
        {
            add(AccessorConstraint::Unit);
            add(AccessorConstraint::Sign);
        }
        AttributeSemantic::Color(_) => add(AccessorConstraint::Clamped),
        AttributeSemantic::Position
        | AttributeSemantic::Tangent
        | AttributeSemantic::Uv(_)
        | AttributeSemantic::Joints(_)
        | AttributeSemantic::Weights(_)
        | AttributeSemantic::Custom
        | AttributeSemantic::None => {}
    }
}

/// True if an accessor has an alignment that vertices need.
fn is_aligned(accessor: &Accessor, stride: Option<usize>) -> bool {
    let packed = accessor.layout.map_or(4, ElementLayout::packed);
    accessor.offset.is_multiple_of(4) && stride.unwrap_or(packed).is_multiple_of(4)
}
