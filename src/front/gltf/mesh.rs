//! Meshes: primitives with their attributes and morph targets, and whether these go together.

use super::accessor::{Accessor, Component, Layout};
use super::attribute;
use super::buffer::{Purpose, Purposes};
use super::contents::{Demand, Demands};
use super::document::Document;
use super::field::Fields;
use super::json::NodeId;
use super::material;
use super::report::Report;
use super::usage::{Usage, Usages};
use crate::diag::codes;
use std::collections::BTreeMap;

/// The mode of triangles.
pub(super) const TRIANGLES: u64 = 4;

/// A mesh.
#[derive(Debug)]
pub(super) struct Mesh {
    pub(super) at: NodeId,
    pub(super) name: String,
    pub(super) primitives: Vec<Primitive>,
    pub(super) weights: Vec<f64>,
    is_skinned: bool,
}

/// Geometry of one material.
#[derive(Debug)]
pub(super) struct Primitive {
    pub(super) at: NodeId,
    pub(super) attributes: Vec<Attribute>,
    /// The places of the attributes in the order of their names.
    sorted: Vec<usize>,
    pub(super) indices: Option<usize>,
    pub(super) material: Option<usize>,
    /// 4 are triangles, 5 a strip, 6 a fan; the others have no surface.
    pub(super) mode: u64,
    /// What each morph target moves.
    pub(super) targets: Vec<Vec<Attribute>>,
    /// Compressed by Draco.
    pub(super) draco: Option<NodeId>,
}

/// What an accessor is to the vertices.
#[derive(Debug)]
pub(super) struct Attribute {
    pub(super) at: NodeId,
    pub(super) name: String,
    pub(super) accessor: usize,
}

impl Mesh {
    pub(super) fn read(fields: Fields<'_, '_>) -> Self {
        let primitives: Vec<Primitive> = fields.objects("primitives").map(Primitive::read).collect();
        Self {
            at: fields.at,
            name: fields.name(),
            is_skinned: primitives.iter().any(|primitive| primitive.find("JOINTS_0").is_some()),
            primitives,
            weights: fields.numbers("weights").unwrap_or_default(),
        }
    }

    /// How many morph targets its primitives have.
    pub(super) fn targets(&self) -> usize {
        self.primitives.first().map_or(0, |primitive| primitive.targets.len())
    }

    pub(super) fn is_skinned(&self) -> bool {
        self.is_skinned
    }
}

impl Primitive {
    fn read(fields: Fields<'_, '_>) -> Self {
        let attributes = fields.object("attributes").map(read_attributes).unwrap_or_default();
        let mut sorted: Vec<usize> = (0..attributes.len()).collect();
        sorted.sort_by_key(|place| &attributes[*place].name);
        Self {
            at: fields.at,
            attributes,
            sorted,
            indices: fields.index("indices"),
            material: fields.index("material"),
            mode: fields.whole("mode").unwrap_or(TRIANGLES),
            targets: fields.objects("targets").map(read_attributes).collect(),
            draco: fields.extension("KHR_draco_mesh_compression").map(|fields| fields.at),
        }
    }

    /// The accessor of an attribute.
    pub(super) fn find(&self, name: &str) -> Option<usize> {
        let own = |place: usize| &self.attributes[place];
        let first = self.sorted.partition_point(|place| own(*place).name.as_str() < name);
        self.sorted.get(first).map(|place| own(*place)).filter(|own| own.name == name).map(|own| own.accessor)
    }

    /// The accessors of the joints that vertices follow, and of their weights, set after set.
    pub(super) fn influences(&self) -> impl Iterator<Item = [usize; 2]> + '_ {
        let find = |kind: &str, set: usize| self.find(&format!("{kind}_{set}"));
        (0..).map_while(move |set| Some([find("JOINTS", set)?, find("WEIGHTS", set)?]))
    }

    /// How many vertices there are.
    pub(super) fn count(&self, doc: &Document<'_>) -> Option<usize> {
        let counts = self.attributes.iter().filter_map(|attribute| doc.accessors.get(attribute.accessor)?.count);
        self.find("POSITION").and_then(|position| doc.accessors.get(position)?.count).or(counts.min())
    }
}

fn read_attributes(fields: Fields<'_, '_>) -> Vec<Attribute> {
    let attribute = |(key, at): (NodeId, NodeId)| {
        let accessor = usize::try_from(fields.json.whole(at)?).ok()?;
        Some(Attribute { at, name: fields.json.text(key)?.into_owned(), accessor })
    };
    fields.json.pairs(fields.at).filter_map(attribute).collect()
}

/// What the checks of meshes gather.
pub(super) struct Links<'l> {
    pub(super) purposes: &'l mut Purposes,
    pub(super) usages: &'l mut Usages,
    pub(super) demands: &'l mut Demands,
    /// The accessor that was first seen in each view without a stride.
    pub(super) streams: &'l mut BTreeMap<usize, usize>,
    /// The textures of each material met so far, each with its set of texture coordinates.
    pub(super) textures: BTreeMap<NodeId, Vec<(NodeId, u64)>>,
}

/// Checks all meshes.
pub(super) fn check(doc: &Document<'_>, links: &mut Links<'_>, report: &mut Report<'_, '_>) {
    for mesh in &doc.meshes {
        for primitive in &mesh.primitives {
            check_primitive(doc, primitive, links, report);
        }
        let targets = mesh.targets();
        for primitive in mesh.primitives.iter().filter(|primitive| primitive.targets.len() != targets) {
            let at = report.json.at_or(primitive.at, "targets");
            let message = format!("{} morph targets, and the first primitive has {targets}", primitive.targets.len());
            report.say(&codes::GLTF_COUNT, "MESH_PRIMITIVES_UNEQUAL_TARGETS_COUNT", at, message);
        }
        if !mesh.weights.is_empty() && mesh.weights.len() != targets {
            let at = report.json.at_or(mesh.at, "weights");
            let message = format!("{} weights for {targets} morph targets", mesh.weights.len());
            report.say(&codes::GLTF_COUNT, "MESH_INVALID_WEIGHTS_COUNT", at, message);
        }
    }
}

fn check_primitive(doc: &Document<'_>, primitive: &Primitive, links: &mut Links<'_>, report: &mut Report<'_, '_>) {
    attribute::check_names(primitive, report);
    for attribute in &primitive.attributes {
        let Some(accessor) = doc.accessors.get(attribute.accessor) else { continue };
        links.usages.set(attribute.accessor, Usage::Vertices, attribute.at, report);
        links.purposes.set(accessor.view, Purpose::Vertices, attribute.at, report);
        attribute::check_format(doc, attribute, accessor, false, report);
        attribute::check_place(doc, attribute, accessor, links.streams, report);
        attribute::demand(attribute, accessor, links.demands);
        let first = primitive.attributes.first().and_then(|first| doc.accessors.get(first.accessor)?.count);
        if let (Some(count), Some(first)) = (accessor.count, first)
            && count != first
        {
            let message = format!("`{}` has {count} elements, and the first attribute {first}", attribute.name);
            report.say(&codes::GLTF_COUNT, "MESH_PRIMITIVE_UNEQUAL_ACCESSOR_COUNT", attribute.at, message);
        }
    }
    check_indices(doc, primitive, links, report);
    check_targets(doc, primitive, links, report);
    check_material(doc, primitive, links, report);
}

fn check_indices(doc: &Document<'_>, primitive: &Primitive, links: &mut Links<'_>, report: &mut Report<'_, '_>) {
    let vertices = primitive.count(doc);
    let indices = primitive.indices.and_then(|index| Some((index, doc.accessors.get(index)?)));
    if let Some((index, accessor)) = indices {
        let at = report.json.at_or(primitive.at, "indices");
        links.usages.set(index, Usage::Indices, at, report);
        links.purposes.set(accessor.view, Purpose::Indices, at, report);
        if accessor.view.and_then(|view| doc.views.get(view)).is_some_and(|view| view.stride.is_some()) {
            let message = "the view of the indices has a stride".to_owned();
            report.say(&codes::GLTF_VIEW, "MESH_PRIMITIVE_INDICES_ACCESSOR_WITH_BYTESTRIDE", at, message);
        }
        let is_index = |layout: &Layout| {
            let fits = matches!(layout.component, Component::U8 | Component::U16 | Component::U32);
            fits && layout.components() == 1 && !layout.normalized
        };
        if let Some(layout) = accessor.layout.filter(|layout| !is_index(layout)) {
            let message = format!("the indices are {}, not scalar of u8, u16 or u32", layout.name());
            report.say(&codes::GLTF_FORMAT, "MESH_PRIMITIVE_INDICES_ACCESSOR_INVALID_FORMAT", at, message);
        } else if let Some(vertices) = vertices {
            links.demands.add(index, Demand::Below(vertices, primitive.mode), at);
        }
    }
    let count = if primitive.indices.is_some() { indices.and_then(|(_, indices)| indices.count) } else { vertices };
    if let Some(count) = count.filter(|count| !fills(primitive.mode, *count)) {
        let at = report.json.at_or(primitive.at, "mode");
        let message = format!("{count} vertices or indices leave some over in mode {}", primitive.mode);
        report.say(&codes::GLTF_PRIMITIVE_ODD, "MESH_PRIMITIVE_INCOMPATIBLE_MODE", at, message);
    }
}

/// True if so many vertices make whole points, lines or triangles.
fn fills(mode: u64, count: usize) -> bool {
    match mode {
        1 => count >= 2 && count.is_multiple_of(2),
        2 | 3 => count >= 2,
        4 => count >= 3 && count.is_multiple_of(3),
        5 | 6 => count >= 3,
        _ => true,
    }
}

fn check_targets(doc: &Document<'_>, primitive: &Primitive, links: &mut Links<'_>, report: &mut Report<'_, '_>) {
    for attribute in primitive.targets.iter().flatten() {
        let Some(accessor) = doc.accessors.get(attribute.accessor) else { continue };
        links.usages.set(attribute.accessor, Usage::Vertices, attribute.at, report);
        links.purposes.set(accessor.view, Purpose::Vertices, attribute.at, report);
        attribute::check_format(doc, attribute, accessor, true, report);
        attribute::check_place(doc, attribute, accessor, links.streams, report);
        let Some(base) = primitive.find(&attribute.name) else {
            let message = format!("the target moves `{}`, which the primitive has not", attribute.name);
            report.say(&codes::GLTF_ATTRIBUTE, "MESH_PRIMITIVE_MORPH_TARGET_NO_BASE_ACCESSOR", attribute.at, message);
            continue;
        };
        let counts = (accessor.count, doc.accessors.get(base).and_then(|base| base.count));
        if let (Some(count), Some(base)) = counts
            && count != base
        {
            let message = format!("{count} elements, and the primitive has {base} vertices");
            report.say(
                &codes::GLTF_COUNT,
                "MESH_PRIMITIVE_MORPH_TARGET_INVALID_ATTRIBUTE_COUNT",
                attribute.at,
                message,
            );
        }
    }
}

fn check_material(doc: &Document<'_>, primitive: &Primitive, links: &mut Links<'_>, report: &mut Report<'_, '_>) {
    let Some(material) = primitive.material.and_then(|material| doc.materials.get(material)) else { return };
    let textures = || material::texture_coordinates(report.json, *material);
    for (binding, set) in &*links.textures.entry(*material).or_insert_with(textures) {
        if primitive.find(&format!("TEXCOORD_{set}")).is_none() {
            let at = report.json.at_or(primitive.at, "material");
            let message = format!("the material needs `TEXCOORD_{set}` for `{}`", report.json.pointer(*binding));
            report.say(&codes::GLTF_ATTRIBUTE, "MESH_PRIMITIVE_TOO_FEW_TEXCOORDS", at, message);
        }
    }
    let normal_map = Fields::new(report.json, *material).has("normalTexture");
    let tangent = primitive.attributes.iter().find(|attribute| attribute.name == "TANGENT");
    if let Some(tangent) = tangent.filter(|_| !normal_map) {
        let message = "the material has no normal map, so tangents have no effect".to_owned();
        report.say(&codes::GLTF_REMARK, "UNUSED_MESH_TANGENT", tangent.at, message);
    }
}

/// True if an accessor has an alignment that vertices need.
pub(super) fn is_aligned(accessor: &Accessor, stride: Option<usize>) -> bool {
    let packed = accessor.layout.map_or(4, Layout::packed);
    accessor.offset.is_multiple_of(4) && stride.unwrap_or(packed).is_multiple_of(4)
}
