//! Buffers and buffer views: their bytes, whether each view is within its buffer, and whether it is
//! used for one purpose.

use super::document::Document;
use super::field::ObjectFields;
use super::report::AssetReport;
use rtc_diag::codes;
use rtc_source::tree::NodeId;
use std::borrow::Cow;
use std::rc::Rc;

/// Bytes.
#[derive(Debug)]
pub(super) struct Buffer<'s> {
    pub(super) at: NodeId,
    /// Its `byteLength`.
    pub(super) length: Option<usize>,
    /// The bytes, at least `length` of them; `None` if they could not be loaded, or are an
    /// unsupported placeholder.
    pub(super) bytes: Option<Bytes<'s>>,
    /// Its data is that of a compression extension.
    pub(super) is_fallback: bool,
}

/// Bytes that several buffers may share.
pub(super) type Bytes<'s> = Rc<Cow<'s, [u8]>>;

/// The address and length of some bytes: within a document, equal keys are the same bytes.
pub(super) type ByteRange = (usize, usize);

/// The location of these bytes.
pub(super) fn byte_range(bytes: &[u8]) -> ByteRange {
    (bytes.as_ptr().addr(), bytes.len())
}

impl Buffer<'_> {
    pub(super) fn read(fields: ObjectFields<'_, '_>) -> Self {
        let compressed = |name| {
            fields
                .extension(name)
                .is_some_and(|fields| fields.boolean("fallback"))
        };
        Self {
            at: fields.at,
            length: fields.index("byteLength").filter(|length| *length > 0),
            bytes: None,
            is_fallback: compressed("EXT_meshopt_compression")
                || compressed("KHR_meshopt_compression"),
        }
    }
}

/// A stretch of a buffer.
#[derive(Debug)]
pub(super) struct BufferView {
    pub(super) at: NodeId,
    pub(super) buffer: Option<usize>,
    pub(super) offset: usize,
    pub(super) length: Option<usize>,
    pub(super) stride: Option<usize>,
    /// Its `target`.
    target: Option<BufferViewUsage>,
    /// Decompressed bytes.
    pub(super) decoded: Option<Bytes<'static>>,
}

/// The usage of a buffer view.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum BufferViewUsage {
    Vertices,
    Indices,
    InverseBindMatrices,
    Image,
    /// Keyframes, and the parts of sparse accessors.
    Other,
}

impl BufferViewUsage {
    fn name(self) -> &'static str {
        match self {
            Self::Vertices => "vertices",
            Self::Indices => "indices",
            Self::InverseBindMatrices => "inverse bind matrices",
            Self::Image => "an image",
            Self::Other => "keyframes or sparse elements",
        }
    }
}

impl BufferView {
    pub(super) fn read(fields: ObjectFields<'_, '_>) -> Self {
        Self {
            at: fields.at,
            buffer: fields.index("buffer"),
            offset: fields.index("byteOffset").unwrap_or(0),
            length: fields.index("byteLength").filter(|length| *length > 0),
            stride: fields
                .index("byteStride")
                .filter(|stride| (4..=252).contains(stride)),
            target: match fields.integer("target") {
                Some(34962) => Some(BufferViewUsage::Vertices),
                Some(34963) => Some(BufferViewUsage::Indices),
                _ => None,
            },
            decoded: None,
        }
    }
}

impl BufferView {
    /// A view of bytes outside of the asset.
    pub(super) fn decoded(at: NodeId, bytes: Bytes<'static>) -> Self {
        let (buffer, offset, length, stride, target) = (None, 0, Some(bytes.len()), None, None);
        Self {
            at,
            buffer,
            offset,
            length,
            stride,
            target,
            decoded: Some(bytes),
        }
    }
}

impl Document<'_> {
    /// The bytes of a view, if they are all there.
    pub(super) fn view_bytes(&self, view: usize) -> Option<&[u8]> {
        let view = self.views.get(view)?;
        if let Some(decoded) = &view.decoded {
            return Some(decoded);
        }
        let buffer = self.buffers.get(view.buffer?)?;
        let bytes = buffer.bytes.as_ref()?.get(..buffer.length?)?;
        bytes.get(view.offset..view.offset.checked_add(view.length?)?)
    }
}

/// Checks that each view lies in its buffer.
pub(super) fn check(doc: &Document<'_>, report: &mut AssetReport<'_, '_>) {
    for view in &doc.views {
        stride(view, report);
        let (Some(buffer), Some(length)) = (view.buffer, view.length) else {
            continue;
        };
        let Some(size) = doc.buffers.get(buffer).and_then(|buffer| buffer.length) else {
            continue;
        };
        let end = view.offset.saturating_add(length);
        if end > size {
            let key = if view.offset >= size {
                "byteOffset"
            } else {
                "byteLength"
            };
            let at = report.json.at_or(view.at, key);
            let message = format!(
                "the buffer view ends at byte {end} of buffer {buffer}, which has {size} bytes"
            );
            report.add(&codes::GLTF_VIEW, "BUFFER_VIEW_TOO_LONG", at, message);
        }
    }
}

fn stride(view: &BufferView, report: &mut AssetReport<'_, '_>) {
    let Some(stride) = view.stride else { return };
    let at = report.json.at_or(view.at, "byteStride");
    if !stride.is_multiple_of(4) {
        let message = format!("`byteStride` is {stride}; it must be a multiple of 4");
        let (alias, repair) = ("VALUE_MULTIPLE_OF", "it is used");
        report.repair(&codes::GLTF_VALUE, alias, at, &message, repair);
    }
    if let Some(length) = view.length.filter(|length| *length < stride) {
        let message =
            format!("`byteStride` is {stride}, more than the {length} bytes of the buffer view");
        report.add(
            &codes::GLTF_VIEW,
            "BUFFER_VIEW_TOO_BIG_BYTE_STRIDE",
            at,
            message,
        );
    }
    if view.target == Some(BufferViewUsage::Indices) {
        let message = "a buffer view of indices must not have a `byteStride`";
        let (alias, repair) = (
            "BUFFER_VIEW_INVALID_BYTE_STRIDE",
            "its users define its contents",
        );
        report.repair(&codes::GLTF_VIEW, alias, at, message, repair);
    }
}

/// The usage found for each view.
pub(super) struct BufferViewUsages(Vec<Option<BufferViewUsage>>);

impl BufferViewUsages {
    pub(super) fn new(doc: &Document<'_>) -> Self {
        Self(doc.views.iter().map(|view| view.target).collect())
    }

    /// Takes down that the node `at` uses a view for a purpose; two purposes don't go together.
    pub(super) fn set(
        &mut self,
        view: Option<usize>,
        purpose: BufferViewUsage,
        at: NodeId,
        report: &mut AssetReport<'_, '_>,
    ) {
        let Some(slot) = view.and_then(|view| self.0.get_mut(view)) else {
            return;
        };
        match slot {
            None => *slot = Some(purpose),
            Some(first) if *first != purpose => {
                let message = format!(
                    "the buffer view is used for {} here, but its target is {}",
                    purpose.name(),
                    first.name()
                );
                let (alias, repair) = ("BUFFER_VIEW_TARGET_OVERRIDE", "it is used for both");
                report.repair(&codes::GLTF_VIEW, alias, at, &message, repair);
            }
            Some(_) => {}
        }
    }
}
