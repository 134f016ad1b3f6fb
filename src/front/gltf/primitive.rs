//! Primitives: whether attributes, indices, morph targets and material are consistent.

use super::accessor;
use super::attribute::{self, VertexAttribute};
use super::buffer::BufferViewUsage;
use super::constraint::AccessorConstraint;
use super::document::Document;
use super::field::ObjectFields;
use super::layout::ElementLayout;
use super::material;
use super::mesh::CheckedMeshes;
use super::report::AssetReport;
use super::usage::AccessorUsage;
use rtc_diag::codes;
use rtc_source::tree::NodeId;

/// The mode of triangles.
pub(super) const TRIANGLES: u64 = 4;

/// Geometry of one material.
#[derive(Debug)]
pub(super) struct Primitive {
    pub(super) at: NodeId,
    pub(super) attributes: Vec<VertexAttribute>,
    /// The positions of the attributes in the order of their names.
    sorted: Vec<usize>,
    pub(super) indices: Option<usize>,
    pub(super) material: Option<usize>,
    /// 0 are points, 1 lines, 2 a loop, 3 a strip of them; 4 triangles, 5 a strip, 6 a fan.
    pub(super) mode: u64,
    /// The attributes that each morph target displaces.
    pub(super) targets: Vec<Vec<VertexAttribute>>,
    /// Compressed by Draco.
    pub(super) draco: Option<NodeId>,
}

impl Primitive {
    pub(super) fn read(fields: ObjectFields<'_, '_>) -> Self {
        let attributes = fields
            .object("attributes")
            .map(attribute::read)
            .unwrap_or_default();
        let mut sorted: Vec<usize> = (0..attributes.len()).collect();
        sorted.sort_by_key(|place| &attributes[*place].name);
        Self {
            at: fields.at,
            attributes,
            sorted,
            indices: fields.index("indices"),
            material: fields.index("material"),
            mode: fields.integer("mode").unwrap_or(TRIANGLES),
            targets: fields.objects("targets").map(attribute::read).collect(),
            draco: fields
                .extension("KHR_draco_mesh_compression")
                .map(|fields| fields.at),
        }
    }

    /// The accessor of an attribute.
    pub(super) fn find(&self, name: &str) -> Option<usize> {
        let attribute = |place: usize| &self.attributes[place];
        let first = self
            .sorted
            .partition_point(|place| attribute(*place).name.as_str() < name);
        self.sorted
            .get(first)
            .map(|place| attribute(*place))
            .filter(|attribute| attribute.name == name)
            .map(|attribute| attribute.accessor)
    }

    /// The accessors of the joints that vertices follow, and of their weights, set after set.
    pub(super) fn influences(&self) -> impl Iterator<Item = [usize; 2]> + '_ {
        let find = |kind: &str, set: usize| self.find(&format!("{kind}_{set}"));
        (0..).map_while(move |set| Some([find("JOINTS", set)?, find("WEIGHTS", set)?]))
    }
}

/// Checks one primitive: its attributes, its indices, its morph targets, and its material.
pub(super) fn check(
    doc: &Document<'_>,
    primitive: &Primitive,
    // Record how each attribute uses its accessor and its view.
    links: &mut CheckedMeshes<'_>,
    report: &mut AssetReport<'_, '_>,
) {
    attribute::check_names(primitive, report);
    let mut vertices = None;
    for attribute in &primitive.attributes {
        let Some((_, accessor)) = accessor::find(doc, Some(attribute.accessor), report) else {
            continue;
        };
        links.usages.set(
            attribute.accessor,
            AccessorUsage::Vertices,
            attribute.at,
            report,
        );
        links.purposes.set(
            accessor.view,
            BufferViewUsage::Vertices,
            attribute.at,
            report,
        );
        // Check the format and layout of its elements.
        attribute::check_format(doc, attribute, accessor, false, report);
        attribute::check_place(doc, attribute, accessor, links.streams, report);
        attribute::add_constraints(attribute, accessor, links.constraints);
        // All attributes have as many elements as the first.
        match vertices {
            None => vertices = accessor.count,
            Some(first) if accessor.count != Some(first) => {
                let count = accessor.count.unwrap_or(0);
                let message = format!(
                    "`{}` has {count} elements, but the first attribute has {first}",
                    attribute.name
                );
                report.add(
                    &codes::GLTF_COUNT,
                    "MESH_PRIMITIVE_UNEQUAL_ACCESSOR_COUNT",
                    attribute.at,
                    message,
                );
            }
            Some(_) => {}
        }
    }
    // Check what refers to the vertices.
    check_indices(doc, (primitive, vertices), links, report);
    check_targets(doc, primitive, links, report);
    check_material(doc, primitive, links, report);
    check_tangents(doc, primitive, report);
}

fn check_indices(
    doc: &Document<'_>,
    (primitive, vertices): (&Primitive, Option<usize>),
    links: &mut CheckedMeshes<'_>,
    report: &mut AssetReport<'_, '_>,
) {
    let indices = accessor::find(doc, primitive.indices, report);
    if let Some((index, accessor)) = indices {
        // Record how the indices use their accessor and their view.
        let at = report.json.at_or(primitive.at, "indices");
        links.usages.set(index, AccessorUsage::Indices, at, report);
        links
            .purposes
            .set(accessor.view, BufferViewUsage::Indices, at, report);
        if accessor
            .view
            .and_then(|view| doc.views.get(view))
            .is_some_and(|view| view.stride.is_some())
        {
            let message = "the buffer view of indices must not have a `byteStride`";
            let (alias, repair) = (
                "MESH_PRIMITIVE_INDICES_ACCESSOR_WITH_BYTESTRIDE",
                "the stride is used",
            );
            report.repair(&codes::GLTF_VIEW, alias, at, message, repair);
        }
        // Indices are unsigned integers below the number of vertices.
        let is_index = |layout: ElementLayout| {
            layout.component.is_index() && layout.components() == 1 && !layout.normalized
        };
        if accessor.layout.is_some_and(is_index) {
            links.constraints.add(
                index,
                AccessorConstraint::Below(vertices.unwrap_or(0), primitive.mode),
                at,
            );
        } else {
            let found = accessor
                .layout
                .map_or("of an unknown type".to_owned(), ElementLayout::name);
            let message = format!("the indices are {found}; they must be scalar of u8, u16 or u32");
            report.add(
                &codes::GLTF_FORMAT,
                "MESH_PRIMITIVE_INDICES_ACCESSOR_INVALID_FORMAT",
                at,
                message,
            );
        }
    }
    // The indices, or else the vertices, fill whole primitives.
    let count = if primitive.indices.is_some() {
        indices.and_then(|(_, indices)| indices.count)
    } else {
        vertices
    };
    if let Some(count) = count.filter(|count| !fills(primitive.mode, *count)) {
        let at = report.json.at_or(primitive.at, "mode");
        let message = format!(
            "{count} vertices or indices do not make whole primitives of mode {}",
            primitive.mode
        );
        report.add(
            &codes::GLTF_PRIMITIVE_ODD,
            "MESH_PRIMITIVE_INCOMPATIBLE_MODE",
            at,
            message,
        );
    }
}

/// True if the number of vertices makes whole points, lines or triangles.
fn fills(mode: u64, count: usize) -> bool {
    match mode {
        1 => count >= 2 && count.is_multiple_of(2),
        2 | 3 => count >= 2,
        4 => count >= 3 && count.is_multiple_of(3),
        5 | 6 => count >= 3,
        _ => true,
    }
}

fn check_targets(
    doc: &Document<'_>,
    primitive: &Primitive,
    // Record how each displacement uses its accessor and its view.
    links: &mut CheckedMeshes<'_>,
    report: &mut AssetReport<'_, '_>,
) {
    for attribute in primitive.targets.iter().flatten() {
        let Some((_, accessor)) = accessor::find(doc, Some(attribute.accessor), report) else {
            continue;
        };
        links.usages.set(
            attribute.accessor,
            AccessorUsage::Vertices,
            attribute.at,
            report,
        );
        links.purposes.set(
            accessor.view,
            BufferViewUsage::Vertices,
            attribute.at,
            report,
        );
        // Check the format and layout of its elements.
        attribute::check_format(doc, attribute, accessor, true, report);
        attribute::check_place(doc, attribute, accessor, links.streams, report);
        // It displaces an attribute of the primitive with as many elements.
        let Some(base) = primitive.find(&attribute.name) else {
            let message = format!(
                "the morph target has `{}`, which the primitive lacks",
                attribute.name
            );
            report.add(
                &codes::GLTF_ATTRIBUTE,
                "MESH_PRIMITIVE_MORPH_TARGET_NO_BASE_ACCESSOR",
                attribute.at,
                message,
            );
            continue;
        };
        let base = doc.accessors.get(base).and_then(|base| base.count);
        if let Some(base) = base.filter(|base| accessor.count != Some(*base)) {
            let message = format!(
                "there are {} elements, but the primitive has {base} vertices",
                accessor.count.unwrap_or(0)
            );
            let alias = "MESH_PRIMITIVE_MORPH_TARGET_INVALID_ATTRIBUTE_COUNT";
            report.add(&codes::GLTF_COUNT, alias, attribute.at, message);
        }
    }
}

fn check_material(
    doc: &Document<'_>,
    primitive: &Primitive,
    links: &mut CheckedMeshes<'_>,
    report: &mut AssetReport<'_, '_>,
) {
    let Some(material) = primitive
        .material
        .and_then(|material| doc.materials.get(material))
    else {
        return;
    };
    let textures = || material::texture_coordinates(doc, report.json, *material);
    for (binding, set) in &*links.textures.entry(*material).or_insert_with(textures) {
        if primitive.find(&format!("TEXCOORD_{set}")).is_none() {
            let at = report.json.at_or(primitive.at, "material");
            let message = format!(
                "the material needs `TEXCOORD_{set}` for `{}`",
                report.json.pointer(*binding)
            );
            report.add(
                &codes::GLTF_ATTRIBUTE,
                "MESH_PRIMITIVE_TOO_FEW_TEXCOORDS",
                at,
                message,
            );
        }
    }
}

/// Checks that tangents are present where the material uses them, and absent elsewhere.
fn check_tangents(doc: &Document<'_>, primitive: &Primitive, report: &mut AssetReport<'_, '_>) {
    // A normal map or anisotropy needs tangents.
    let material = primitive
        .material
        .and_then(|material| doc.materials.get(material));
    let material = material.map(|material| ObjectFields::new(report.json, *material));
    let is_needed = material.is_some_and(|material| material::needs_tangents(doc, material));
    let find = |name| {
        primitive
            .attributes
            .iter()
            .find(|attribute| attribute.name == name)
    };
    // Other materials ignore them.
    if let Some(tangent) = find("TANGENT").filter(|_| !is_needed) {
        let message = "the material has no normal map, so the tangents have no effect".to_owned();
        report.add(
            &codes::GLTF_REMARK,
            "UNUSED_MESH_TANGENT",
            tangent.at,
            message,
        );
    }
    // Missing tangents are generated from the coordinates of the normal map.
    let (Some(material), true) = (material, is_needed) else {
        return;
    };
    if find("TANGENT").is_some() && find("NORMAL").is_some() {
        return;
    }
    let at = report.json.at_or(primitive.at, "material");
    if material.object("normalTexture").is_some() {
        let message =
            "the normal map needs tangents, which are missing: they are computed".to_owned();
        report.add(
            &codes::GLTF_PRIMITIVE_ODD,
            "MESH_PRIMITIVE_GENERATED_TANGENT_SPACE",
            at,
            message,
        );
    } else {
        let message =
            "the material needs tangents; there are none, and without a normal map none are made"
                .to_owned();
        report.add(
            &codes::GLTF_ATTRIBUTE,
            "MESH_PRIMITIVE_NO_TANGENT_SPACE",
            at,
            message,
        );
    }
}
