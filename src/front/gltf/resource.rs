//! Loads the bytes that an asset refers to: the binary chunk, data URIs, and files in its folder,
//! each file once.

use super::buffer::Bytes;
use super::document::Document;
use super::field::ObjectFields;
use super::image::ImageCoding;
use super::report::{AssetReport, shown};
use super::uri::{self, Uri, UriError};
use crate::pixels::PICTURES;
use rtc_diag::codes;
use rtc_source::tree::NodeId;
use rtc_source::{FileIdentity, FileKind, FileSearch, FoundFile, Loader, MissingFile, SourceMap};
use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;

/// The largest file read, in bytes.
const MAX_BYTES: u64 = 1 << 30;

/// Reads files, and remembers them.
pub(super) struct ResourceReader<'m> {
    search: FileSearch,
    map: &'m SourceMap,
    files: BTreeMap<FileIdentity, Bytes<'static>>,
    /// Data that are embedded.
    data: BTreeSet<Bytes<'static>>,
}

/// The resource of a URI: bytes, and the media type of a data URI.
type FoundResource = (Bytes<'static>, Option<String>);

impl<'m> ResourceReader<'m> {
    pub(super) fn new(search: FileSearch, map: &'m SourceMap) -> Self {
        Self {
            search,
            map,
            files: BTreeMap::new(),
            data: BTreeSet::new(),
        }
    }

    /// Loads the bytes of all buffers; `chunk` is the binary chunk of a `.glb`.
    pub(super) fn load_buffers<'s>(
        &mut self,
        doc: &mut Document<'s>,
        chunk: Option<&'s [u8]>,
        report: &mut AssetReport<'_, 's>,
    ) {
        let is_glb = doc.is_glb;
        for (index, buffer) in doc.buffers.iter_mut().enumerate() {
            let fields = ObjectFields::new(report.json, buffer.at);
            // Load the file or data URI, or take the binary chunk.
            let bytes: Option<Bytes<'s>> = if let Some(at) = fields.node("uri") {
                remark_uri(is_glb, at, report);
                self.fetch((at, None), is_glb, report)
                    .and_then(|(bytes, media)| {
                        is_buffer(media.as_deref(), at, report).then_some(bytes)
                    })
            } else if is_glb && index == 0 && !buffer.is_fallback && buffer.length.is_some() {
                if chunk.is_none() {
                    let message =
                        "the buffer refers to the binary chunk, which is missing".to_owned();
                    report.add(
                        &codes::GLTF_BUFFER,
                        "BUFFER_MISSING_GLB_DATA",
                        buffer.at,
                        message,
                    );
                }
                chunk.map(|chunk| Rc::new(Cow::Borrowed(chunk)))
            } else {
                None
            };
            // Compare the length with `byteLength`.
            let (Some(bytes), Some(length)) = (bytes, buffer.length) else {
                continue;
            };
            if bytes.len() < length {
                let message = format!(
                    "the buffer has {} bytes, but `byteLength` is {length}",
                    bytes.len()
                );
                report.add(
                    &codes::GLTF_BUFFER,
                    "BUFFER_BYTE_LENGTH_MISMATCH",
                    buffer.at,
                    message,
                );
                continue;
            }
            let extra = bytes.len() - length;
            if !fields.has("uri") && extra >= 4 {
                let message = format!("the binary chunk is {extra} bytes longer than the buffer");
                report.add(
                    &codes::GLB_EXTRA,
                    "BUFFER_GLB_CHUNK_TOO_BIG",
                    buffer.at,
                    message,
                );
            }
            buffer.bytes = Some(bytes);
        }
    }

    /// Brings the bytes of all images that are not in a view.
    pub(super) fn load_images(&mut self, doc: &mut Document<'_>, report: &mut AssetReport<'_, '_>) {
        let is_glb = doc.is_glb;
        for image in &mut doc.images {
            let Some(at) = report.json.get(image.at, "uri") else {
                continue;
            };
            remark_uri(is_glb, at, report);
            let Some((bytes, media)) = self.fetch((at, Some(&PICTURES)), is_glb, report) else {
                continue;
            };
            let is_image = media
                .as_deref()
                .is_some_and(|media| media.starts_with("image/"));
            if is_image && ImageCoding::of(&bytes).is_none() {
                let message = "the image does not have the media type of its URI".to_owned();
                let hint = "correct the media type after `data:`, or replace the data".to_owned();
                report.add_with_hint(&codes::GLTF_URI, "INVALID_URI", at, message, hint);
                continue;
            }
            image.media = image
                .media
                .take()
                .or(media.filter(|media| !media.is_empty()));
            image.bytes = Some(bytes);
        }
    }

    /// The bytes of the URI at a node, of a kind that may be in the parent folder; failures are
    /// reported.
    fn fetch(
        &mut self,
        (at, kind): (NodeId, Option<&FileKind>),
        is_glb: bool,
        report: &mut AssetReport<'_, '_>,
    ) -> Option<FoundResource> {
        let text = report.json.text(at)?;
        let parsed = uri::parse(text).or_else(|fault| {
            let (uri, message, repair) = uri::repair(text).ok_or(fault)?;
            let message = format!("`{}` {message}", shown(text));
            report.repair(&codes::GLTF_URI, "INVALID_URI", at, &message, repair);
            // An error that is not repaired is reported, and no file is read for it.
            match report.is_lenient() {
                true => Ok(uri),
                false => Err(UriError::Reported),
            }
        });
        match parsed {
            Ok(Uri::Data { media, bytes }) => {
                if is_glb {
                    let message =
                        "the data is Base64 text; the binary chunk would be smaller".to_owned();
                    report.add(&codes::GLB_EXTRA, "DATA_URI_GLB", at, message);
                }
                let bytes: Bytes<'static> = Rc::new(Cow::Owned(bytes));
                let known = self.data.get(&bytes).cloned();
                let bytes = known.unwrap_or_else(|| {
                    self.data.insert(Rc::clone(&bytes));
                    bytes
                });
                Some((bytes, Some(media)))
            }
            Ok(Uri::Path(path)) => {
                let found = self.search.below(&path);
                self.file(&path, found, at, report)
                    .map(|bytes| (bytes, None))
            }
            Ok(Uri::Above(path)) => {
                let found = self.search.above(&path, kind);
                self.file(&path, found, at, report)
                    .map(|bytes| (bytes, None))
            }
            Err(UriError::Malformed(why)) => {
                let message = format!("`{}` is not a valid URI: {why}", shown(text));
                report.add(&codes::GLTF_URI, "INVALID_URI", at, message);
                None
            }
            Err(UriError::Reported) => None,
            Err(UriError::Outside(how)) => {
                let hint = "copy the file beside the asset and use a relative path";
                outside(text, (how, hint), at, report);
                None
            }
        }
    }

    fn file(
        &mut self,
        path: &str,
        found: Result<FoundFile, MissingFile>,
        at: NodeId,
        report: &mut AssetReport<'_, '_>,
    ) -> Option<Bytes<'static>> {
        // Report a file that is absent or outside the permitted folders.
        let found = match found {
            Ok(found) => found,
            Err(MissingFile::Outside(_)) => {
                let climbs = path.split('/').any(|part| part == "..");
                let how = match climbs {
                    true => "it contains `..`",
                    false => "a link leaves it",
                };
                outside(path, (how, PERMIT_FOLDER), at, report);
                return None;
            }
            Err(MissingFile::NoFolder) => {
                let message = format!(
                    "`{}` cannot be found: an asset from standard input has no folder",
                    shown(path)
                );
                let hint = "pass the folder of its files with `--asset-root FOLDER`".to_owned();
                report.add_with_hint(&codes::GLTF_NO_FILE, "IO_ERROR", at, message, hint);
                return None;
            }
            Err(MissingFile::Absent(places)) => {
                let message = format!("there is no file `{}`", shown(path));
                let places: Vec<String> = places
                    .iter()
                    .map(|place| format!("`{}`", place.display()))
                    .collect();
                let hint = format!("searched at {}", places.join(", "));
                report.add_with_hint(&codes::GLTF_NO_FILE, "IO_ERROR", at, message, hint);
                return None;
            }
        };
        // Read a file once, whatever names it has.
        let identity = found.identity();
        if let Some(bytes) = identity
            .as_ref()
            .and_then(|identity| self.files.get(identity))
        {
            return Some(Rc::clone(bytes));
        }
        // Load the file within the budget.
        match Loader.found(&found, MAX_BYTES, self.map) {
            Ok(bytes) => {
                let bytes: Bytes<'static> = Rc::new(Cow::Owned(bytes));
                if let Some(identity) = identity {
                    self.files.insert(identity, Rc::clone(&bytes));
                }
                Some(bytes)
            }
            Err(error) => {
                let message = format!("cannot read `{}`: {error}", found.shown.display());
                report.add(&codes::GLTF_NO_FILE, "IO_ERROR", at, message);
                None
            }
        }
    }
}

fn remark_uri(is_glb: bool, at: NodeId, report: &mut AssetReport<'_, '_>) {
    if is_glb {
        report.add(
            &codes::GLTF_REMARK,
            "URI_GLB",
            at,
            "the file is external; a `.glb` can embed it",
        );
    }
}

/// The advice for a file that is outside of the permitted folders.
const PERMIT_FOLDER: &str = "put the file beside the asset and use a relative path, or permit its \
    folder with `--asset-root FOLDER`";

fn outside(text: &str, (how, hint): (&str, &str), at: NodeId, report: &mut AssetReport<'_, '_>) {
    let message = format!(
        "`{}` is outside of the folder of the asset: {how}",
        shown(text)
    );
    report.add_with_hint(
        &codes::GLTF_OUTSIDE,
        "IO_ERROR",
        at,
        message,
        hint.to_owned(),
    );
}

/// True if a data URI has the media type of a buffer, or if the URI is no data URI.
fn is_buffer(media: Option<&str>, at: NodeId, report: &mut AssetReport<'_, '_>) -> bool {
    let Some(media) = media else { return true };
    let is_buffer = ["application/octet-stream", "application/gltf-buffer"].contains(&media);
    if !is_buffer {
        let message = format!(
            "the media type of the buffer is `{}`; it must be application/octet-stream or \
            application/gltf-buffer",
            shown(media)
        );
        let (alias, repair) = (
            "BUFFER_DATA_URI_MIME_TYPE_INVALID",
            "the media type is ignored",
        );
        report.repair(&codes::GLTF_URI, alias, at, &message, repair);
    }
    is_buffer || report.is_lenient()
}
