//! Buffer views compressed by meshoptimizer (`EXT_meshopt_compression`, appendix A, and its
//! successor `KHR_meshopt_compression`): attributes, triangles and indices, with the filters on
//! top.
//!
//! Every read is within the given bytes, and every announced size is bounded by the size of the
//! data.

mod filter;
mod index;
mod vertex;

use super::buffer::{ByteRange, Bytes, byte_range};
use super::document::Document;
use super::field::ObjectFields;
use super::report::AssetReport;
use rtc_diag::codes;
use rtc_source::Resource;
use rtc_source::tree::NodeId;
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::rc::Rc;

/// The maximum number of bytes decoded from one byte: a control byte for four unchanged channels of
/// a block of 256 elements.
const MAX_RATIO: usize = 1024;

/// The reason why data are invalid.
type MeshoptError = &'static str;

/// Bytes read one after another.
struct MeshoptReader<'a> {
    bytes: &'a [u8],
}

impl<'a> MeshoptReader<'a> {
    fn take(&mut self, count: usize) -> Result<&'a [u8], MeshoptError> {
        let (head, rest) = self
            .bytes
            .split_at_checked(count)
            .ok_or("the data ends too early")?;
        self.bytes = rest;
        Ok(head)
    }

    fn byte(&mut self) -> Result<u8, MeshoptError> {
        self.take(1).map(|bytes| bytes[0])
    }

    /// A number in groups of seven bits, the least first (LEB128).
    fn number(&mut self) -> Result<u32, MeshoptError> {
        let mut number = 0;
        for shift in (0..35).step_by(7) {
            let byte = self.byte()?;
            number |= u32::from(byte & 0x7f) << shift;
            if byte < 0x80 {
                return Ok(number);
            }
        }
        Err("a number has too many bytes")
    }
}

/// A signed number whose sign is its lowest bit.
fn unzigzag(number: u32) -> u32 {
    (number >> 1) ^ 0_u32.wrapping_sub(number & 1)
}

/// The parameters of a compressed buffer view.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord)]
struct StreamHeader {
    bytes: ByteRange,
    count: usize,
    stride: usize,
    mode: String,
    filter: String,
}

impl StreamHeader {
    /// Reads the header. A size that the bytes cannot decompress to is an error.
    fn read(bytes: &[u8], extension: ObjectFields<'_, '_>) -> Result<Self, MeshoptError> {
        let (Some(count), Some(stride)) = (extension.index("count"), extension.index("byteStride"))
        else {
            return Err("it has no `count` or no `byteStride`");
        };
        let size = count.checked_mul(stride).ok_or("its size is too large")?;
        if size / MAX_RATIO > bytes.len() {
            return Err("it claims more data than its bytes can hold");
        }
        let text = |key| extension.text(key).unwrap_or_default();
        Ok(Self {
            bytes: byte_range(bytes),
            count,
            stride,
            mode: text("mode"),
            filter: text("filter"),
        })
    }

    /// Bytes that it takes to decode it: indices are decoded to four bytes each.
    fn memory(&self) -> u64 {
        let indices = if self.mode == "ATTRIBUTES" { 0 } else { 4 };
        self.count as u64 * (self.stride as u64 + indices)
    }
}

/// Decompresses the views that are compressed, those of the same bytes and claims once.
pub(super) fn expand(doc: &mut Document<'_>, report: &mut AssetReport<'_, '_>) {
    let mut made: BTreeMap<StreamHeader, Result<Bytes<'static>, MeshoptError>> = BTreeMap::new();
    for index in 0..doc.views.len() {
        let fields = ObjectFields::new(report.json, doc.views[index].at);
        let names = ["EXT_meshopt_compression", "KHR_meshopt_compression"];
        let Some(extension) = names.iter().find_map(|name| fields.extension(name)) else {
            continue;
        };
        let Some(bytes) = source(doc, extension) else {
            continue;
        };
        let decoded = StreamHeader::read(bytes, extension).and_then(|header| {
            if let Some(known) = made.get(&header) {
                return known.clone();
            }
            if !report.charge(
                Resource::Memory,
                header.memory(),
                extension.at,
                "the compressed buffer view",
            ) {
                return Err("it exceeds a limit");
            }
            let decoded = decode(bytes, &header).map(|decoded| Rc::new(Cow::Owned(decoded)));
            made.insert(header, decoded.clone());
            decoded
        });
        match decoded {
            Ok(decoded) => doc.views[index].decoded = Some(decoded),
            Err(fault) => add(extension.at, fault, report),
        }
    }
}

fn add(at: NodeId, fault: MeshoptError, report: &mut AssetReport<'_, '_>) {
    report.add(
        &codes::GLTF_COMPRESSED,
        "",
        at,
        format!("the compressed buffer view cannot be decoded: {fault}"),
    );
}

/// The compressed bytes of a view.
fn source<'d>(doc: &'d Document<'_>, extension: ObjectFields<'_, '_>) -> Option<&'d [u8]> {
    let buffer = doc.buffers.get(extension.index("buffer")?)?;
    let offset = extension.index("byteOffset").unwrap_or(0);
    buffer
        .bytes
        .as_ref()?
        .get(offset..offset.checked_add(extension.index("byteLength")?)?)
}

fn decode(bytes: &[u8], header: &StreamHeader) -> Result<Vec<u8>, MeshoptError> {
    let StreamHeader {
        bytes: _,
        count,
        stride,
        mode,
        filter,
    } = header;
    match mode.as_str() {
        "ATTRIBUTES" => {
            let mut decoded = vertex::decode(bytes, *count, *stride)?;
            filter::apply(filter, *stride, &mut decoded)?;
            Ok(decoded)
        }
        "TRIANGLES" => narrow(&index::triangles(bytes, *count)?, *stride),
        "INDICES" => narrow(&index::sequence(bytes, *count)?, *stride),
        _ => Err("its mode is unknown"),
    }
}

/// Indices as bytes, of two or four each.
fn narrow(indices: &[u32], stride: usize) -> Result<Vec<u8>, MeshoptError> {
    match stride {
        4 => Ok(indices
            .iter()
            .flat_map(|index| index.to_le_bytes())
            .collect()),
        2 => {
            let short =
                |index: &u32| u16::try_from(*index).map_err(|_| "an index has more than 16 bits");
            let shorts: Result<Vec<u16>, MeshoptError> = indices.iter().map(short).collect();
            Ok(shorts?
                .iter()
                .flat_map(|index| index.to_le_bytes())
                .collect())
        }
        _ => Err("an index must have 2 or 4 bytes"),
    }
}
