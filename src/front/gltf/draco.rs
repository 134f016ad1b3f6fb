//! Primitives compressed by Draco (`KHR_draco_mesh_compression`): `draco-core` decodes them into
//! views for their accessors. This is the only file that names the decoder.

use super::buffer::{BufferView, ByteRange, Bytes, byte_range};
use super::document::Document;
use super::field::ObjectFields;
use super::layout::{ComponentType, ElementLayout};
use super::report::AssetReport;
use draco_core::{DecodeLimits, DecoderBuffer, Mesh, MeshDecoder};
use rtc_diag::codes;
use rtc_source::Resource;
use rtc_source::tree::NodeId;
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::rc::Rc;

/// Decoded bytes for each compressed byte, and beside that, that a primitive may claim.
const MAX_RATIO: u64 = 256;
const FREE: u64 = 1 << 20;

/// Temporary bytes per point and per triangle while decoding.
const POINT: u64 = 48;
const FACE: u64 = 48;

/// The description of the compressed data of a primitive.
struct CompressedPrimitive {
    at: NodeId,
    view: usize,
    /// The accessor of each attribute, and its number in the compressed data.
    attributes: Vec<(usize, u32)>,
    indices: Option<usize>,
}

/// The decoded primitives, each once.
#[derive(Default)]
struct DecodedData {
    meshes: BTreeMap<(ByteRange, DracoMeshSize), Result<Rc<Mesh>, String>>,
    /// Attributes by their numbers, and the corners.
    columns: BTreeMap<(ByteRange, Option<u32>, ComponentType), Bytes<'static>>,
    /// The data and the number that each accessor has now.
    filled: BTreeMap<usize, (ByteRange, Option<u32>)>,
}

/// Points and triangles.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct DracoMeshSize {
    points: u64,
    faces: u64,
}

/// Decodes the primitives that are compressed.
pub(super) fn expand(doc: &mut Document<'_>, report: &mut AssetReport<'_, '_>) {
    let mut made = DecodedData::default();
    for packed in find(doc, report) {
        match unpack(doc, &packed, &mut made, report) {
            Ok(accessors) => accessors
                .into_iter()
                .for_each(|(accessor, bytes)| fill(doc, accessor, bytes)),
            Err(fault) => {
                let message = format!("the primitive cannot be decompressed: {fault}");
                report.add(&codes::GLTF_COMPRESSED, "", packed.at, message);
            }
        }
    }
}

fn find(doc: &Document<'_>, report: &AssetReport<'_, '_>) -> Vec<CompressedPrimitive> {
    let primitives = doc.meshes.iter().flat_map(|mesh| &mesh.primitives);
    let packed = primitives.filter_map(|primitive| {
        let fields = ObjectFields::new(report.json, primitive.draco?);
        let numbers = fields.object("attributes")?;
        let number = |name: &str| u32::try_from(numbers.integer(name)?).ok();
        let attributes = primitive.attributes.iter();
        let attributes = attributes
            .filter_map(|item| Some((item.accessor, number(&item.name)?)))
            .collect();
        Some(CompressedPrimitive {
            at: fields.at,
            view: fields.index("bufferView")?,
            attributes,
            indices: primitive.indices,
        })
    });
    packed.collect()
}

/// The bytes of each accessor of a primitive that does not have them yet.
fn unpack(
    doc: &Document<'_>,
    packed: &CompressedPrimitive,
    made: &mut DecodedData,
    report: &mut AssetReport<'_, '_>,
) -> Result<Vec<(usize, Bytes<'static>)>, String> {
    let bytes = doc
        .view_bytes(packed.view)
        .ok_or("its buffer view is missing")?;
    let range = byte_range(bytes);
    // Find the numbers of points and triangles.
    let corners = packed.indices.map_or(Ok(0), |accessor| {
        layout_of(doc, accessor).map(|layout| layout.1)
    })?;
    let points = packed
        .attributes
        .first()
        .map_or(Ok(corners), |(accessor, _)| {
            layout_of(doc, *accessor).map(|layout| layout.1)
        })?;
    let size = DracoMeshSize {
        points: points as u64,
        faces: corners as u64 / 3,
    };
    // Decode the data, once for all primitives that share it.
    let mesh = match made.meshes.get(&(range, size)) {
        Some(known) => known.clone(),
        None => {
            let mesh = charge(size, packed, report).and_then(|()| decode(bytes, size));
            made.meshes.insert((range, size), mesh.clone());
            mesh
        }
    }?;
    // Convert each attribute to the layout of its accessor.
    let mut accessors = Vec::new();
    let parts = packed
        .attributes
        .iter()
        .map(|(accessor, number)| (*accessor, Some(*number)));
    for (accessor, number) in parts.chain(packed.indices.map(|accessor| (accessor, None))) {
        if made.filled.insert(accessor, (range, number)) == Some((range, number)) {
            continue;
        }
        let (layout, count) = layout_of(doc, accessor)?;
        check(&mesh, number, (layout, count))?;
        let key = (range, number, layout.component);
        if let Some(known) = made.columns.get(&key) {
            accessors.push((accessor, Rc::clone(known)));
            continue;
        }
        let memory = count as u64 * layout.packed() as u64;
        if !report.charge(
            Resource::Memory,
            memory,
            packed.at,
            "the compressed primitive",
        ) {
            return Err("it exceeds a limit".to_owned());
        }
        let column = Rc::new(Cow::Owned(column(&mesh, number, layout)));
        made.columns.insert(key, Rc::clone(&column));
        accessors.push((accessor, column));
    }
    Ok(accessors)
}

fn charge(
    size: DracoMeshSize,
    packed: &CompressedPrimitive,
    report: &mut AssetReport<'_, '_>,
) -> Result<(), String> {
    let DracoMeshSize { points, faces } = size;
    let memory = points
        .saturating_mul(POINT)
        .saturating_add(faces.saturating_mul(FACE));
    let is_small = report.charge(
        Resource::Vertices,
        points.saturating_add(3 * faces),
        packed.at,
        "the compressed primitive",
    ) && report.charge(
        Resource::Memory,
        memory,
        packed.at,
        "the compressed primitive",
    );
    if is_small {
        Ok(())
    } else {
        Err("it exceeds a limit".to_owned())
    }
}

/// The mesh of compressed bytes, if it has the size that its accessors claim.
fn decode(bytes: &[u8], size: DracoMeshSize) -> Result<Rc<Mesh>, String> {
    let limit = (bytes.len() as u64)
        .saturating_mul(MAX_RATIO)
        .saturating_add(FREE);
    let limits = DecodeLimits::default()
        .with_max_points(size.points.min(limit))
        .with_max_decoded_bytes(limit);
    let limits = limits.with_max_faces(size.faces.min(limit));
    let mut mesh = Mesh::new();
    let mut buffer = DecoderBuffer::new(bytes).with_limits(limits);
    MeshDecoder::new()
        .decode(&mut buffer, &mut mesh)
        .map_err(|fault| fault.to_string())?;
    Ok(Rc::new(mesh))
}

/// Checks that an attribute, or the corners without a number, have the size that an accessor
/// claims.
fn check(
    mesh: &Mesh,
    number: Option<u32>,
    (layout, count): (ElementLayout, usize),
) -> Result<(), String> {
    let Some(number) = number else {
        let faces = mesh.num_faces();
        let message = || format!("there are {count} indices, but the data has {faces} triangles");
        return if count == 3 * faces {
            Ok(())
        } else {
            Err(message())
        };
    };
    let (points, attribute) = (
        mesh.num_points(),
        mesh.attribute_by_unique_id(number)
            .ok_or("an attribute is missing")?,
    );
    if count != points || usize::from(attribute.num_components()) != layout.components() {
        return Err(format!(
            "an accessor has {count} elements, but the data has {points}"
        ));
    }
    Ok(())
}

/// The bytes of an attribute, or of the corners.
fn column(mesh: &Mesh, number: Option<u32>, layout: ElementLayout) -> Vec<u8> {
    match number.map(|number| mesh.attribute_by_unique_id(number)) {
        None => to_bytes(
            mesh.faces()
                .iter()
                .flatten()
                .map(|point| f64::from(point.0)),
            layout.component,
        ),
        Some(attribute) => {
            let numbers =
                attribute.map(|item| item.read_f32s(mesh.num_points(), layout.components()));
            to_bytes(
                numbers.unwrap_or_default().into_iter().map(f64::from),
                layout.component,
            )
        }
    }
}

fn layout_of(doc: &Document<'_>, accessor: usize) -> Result<(ElementLayout, usize), String> {
    let accessor = doc.accessors.get(accessor);
    accessor
        .and_then(|accessor| Some((accessor.layout?, accessor.count?)))
        .ok_or_else(|| "an accessor is faulty".into())
}

/// Numbers as the components of an accessor; those out of range are cut off.
fn to_bytes(numbers: impl Iterator<Item = f64>, component: ComponentType) -> Vec<u8> {
    let mut bytes = Vec::new();
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a cast keeps within the range"
    )]
    for number in numbers {
        match component {
            ComponentType::I8 => bytes.extend((number as i8).to_le_bytes()),
            ComponentType::U8 => bytes.push(number as u8),
            ComponentType::I16 => bytes.extend((number as i16).to_le_bytes()),
            ComponentType::U16 => bytes.extend((number as u16).to_le_bytes()),
            ComponentType::U32 => bytes.extend((number as u32).to_le_bytes()),
            ComponentType::F32 => bytes.extend((number as f32).to_le_bytes()),
        }
    }
    bytes
}

/// Gives an accessor a view of its own.
fn fill(doc: &mut Document<'_>, accessor: usize, bytes: Bytes<'static>) {
    let at = doc.accessors[accessor].at;
    let view = BufferView::decoded(at, bytes);
    let accessor = &mut doc.accessors[accessor];
    (accessor.view, accessor.offset, accessor.sparse) = (Some(doc.views.len()), 0, None);
    doc.views.push(view);
}
