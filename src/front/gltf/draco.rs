//! Primitives compressed by Draco (`KHR_draco_mesh_compression`): decoded by `draco-core`, and put in place as views of
//! the accessors that stand for them. The one file that names the decoder.

use super::accessor::{Component, Layout};
use super::buffer::View;
use super::document::Document;
use super::field::Fields;
use super::json::NodeId;
use super::report::Report;
use crate::diag::codes;
use draco_core::{DecodeLimits, DecoderBuffer, Mesh, MeshDecoder};

/// Decoded bytes for each compressed byte, and beside that, that a primitive may claim.
const MAX_RATIO: u64 = 256;
const FREE: u64 = 1 << 20;

/// What a primitive says of its compressed data.
struct Packed {
    at: NodeId,
    view: usize,
    /// The accessor of each attribute, and its number in the compressed data.
    attributes: Vec<(usize, u32)>,
    indices: Option<usize>,
}

/// Decodes the primitives that are compressed.
pub(super) fn expand(doc: &mut Document<'_>, report: &mut Report<'_, '_>) {
    for packed in find(doc, report) {
        match unpack(doc, &packed) {
            Ok(accessors) => accessors.into_iter().for_each(|(accessor, bytes)| fill(doc, accessor, bytes)),
            Err(fault) => {
                let message = format!("the primitive can't be decompressed: {fault}");
                report.say(&codes::GLTF_COMPRESSED, "", packed.at, message);
            }
        }
    }
}

fn find(doc: &Document<'_>, report: &Report<'_, '_>) -> Vec<Packed> {
    let primitives = doc.meshes.iter().flat_map(|mesh| &mesh.primitives);
    let packed = primitives.filter_map(|primitive| {
        let fields = Fields::new(report.json, primitive.draco?);
        let numbers = fields.object("attributes")?;
        let number = |name: &str| u32::try_from(numbers.whole(name)?).ok();
        let attributes = primitive.attributes.iter();
        let attributes = attributes.filter_map(|own| Some((own.accessor, number(&own.name)?))).collect();
        Some(Packed { at: fields.at, view: fields.index("bufferView")?, attributes, indices: primitive.indices })
    });
    packed.collect()
}

/// The bytes of each accessor of a primitive.
fn unpack(doc: &Document<'_>, packed: &Packed) -> Result<Vec<(usize, Vec<u8>)>, String> {
    let bytes = doc.view_bytes(packed.view).ok_or("its view is not there")?;
    let limit = (bytes.len() as u64).saturating_mul(MAX_RATIO).saturating_add(FREE);
    let limits = DecodeLimits::default().with_max_points(limit).with_max_faces(limit).with_max_decoded_bytes(limit);
    let mut mesh = Mesh::new();
    let mut buffer = DecoderBuffer::new(bytes).with_limits(limits);
    MeshDecoder::new().decode(&mut buffer, &mut mesh).map_err(|fault| fault.to_string())?;
    let points = mesh.num_points();
    let mut accessors = Vec::new();
    for (accessor, number) in &packed.attributes {
        let (layout, count) = layout_of(doc, *accessor)?;
        let attribute = mesh.attribute_by_unique_id(*number).ok_or("it lacks an attribute")?;
        if count != points || usize::from(attribute.num_components()) != layout.components() {
            return Err(format!("an accessor has {count} elements, and the data {points}"));
        }
        let numbers = attribute.read_f32s(points, layout.components());
        accessors.push((*accessor, to_bytes(numbers.into_iter().map(f64::from), layout.component)));
    }
    if let Some(accessor) = packed.indices {
        let (layout, count) = layout_of(doc, accessor)?;
        if count != 3 * mesh.num_faces() {
            return Err(format!("there are {count} indices, and the data has {} triangles", mesh.num_faces()));
        }
        let corners = mesh.faces().iter().flatten().map(|point| f64::from(point.0));
        accessors.push((accessor, to_bytes(corners, layout.component)));
    }
    Ok(accessors)
}

fn layout_of(doc: &Document<'_>, accessor: usize) -> Result<(Layout, usize), String> {
    let accessor = doc.accessors.get(accessor);
    accessor
        .and_then(|accessor| Some((accessor.layout?, accessor.count?)))
        .ok_or_else(|| "an accessor is faulty".into())
}

/// Numbers as the components of an accessor; those out of range are cut off.
fn to_bytes(numbers: impl Iterator<Item = f64>, component: Component) -> Vec<u8> {
    let mut bytes = Vec::new();
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a cast keeps within the range")]
    for number in numbers {
        match component {
            Component::I8 => bytes.extend((number as i8).to_le_bytes()),
            Component::U8 => bytes.push(number as u8),
            Component::I16 => bytes.extend((number as i16).to_le_bytes()),
            Component::U16 => bytes.extend((number as u16).to_le_bytes()),
            Component::U32 => bytes.extend((number as u32).to_le_bytes()),
            Component::F32 => bytes.extend((number as f32).to_le_bytes()),
        }
    }
    bytes
}

/// Gives an accessor a view of its own.
fn fill(doc: &mut Document<'_>, accessor: usize, bytes: Vec<u8>) {
    let at = doc.accessors[accessor].at;
    let view = View::decoded(at, bytes);
    let accessor = &mut doc.accessors[accessor];
    (accessor.view, accessor.offset, accessor.sparse) = (Some(doc.views.len()), 0, None);
    doc.views.push(view);
}
