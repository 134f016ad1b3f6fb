//! Encodes and decodes the IR: compact JSON and a binary container with checksums, both versioned.
//!
//! # Overview
//! - [`detect_format`] finds the [`Encoding`] of a file from its first bytes.
//! - [`decode`] turns bytes into a `Scene`. The scene still has to be validated.
//! - [`encode`] and [`prepare`] turn a scene into bytes; the same scene always gives the same
//!   bytes. [`hash()`] is the hash of these bytes.
//! - [`changes()`] lists the differences between two scenes, and [`schema()`] is the JSON Schema of
//!   the JSON encoding.
//!
//! # How decoding works
//! Both encodings hold the same tree of JSON values: detect the version, decode the tree, upgrade
//! it step by step to the current version (`upgrade`), and deserialise it. So an upgrade step is
//! written once for both encodings. Only mesh columns and image pixels bypass the tree: they are
//! copied between the scene and sections of the container (`section`, `mesh`, `image`). `columns`
//! packs lists of similar entities into tables of numbers.
//!
//! # Guarantees
//! - Every older version decodes; newer versions and corrupt bytes are errors with a position.
//! - Of a damaged container the first error is reported, because later bytes can't be trusted. Of a
//!   JSON document all errors are reported (`faults`).
//! - Memory use is bounded by a constant times the file length.

mod binary;
mod changes;
mod columns;
mod container;
mod decoded;
mod faults;
mod image;
mod locate;
mod mesh;
mod print;
mod run;
mod schema;
mod section;
mod stored;
mod text;
mod tree;
mod upgrade;
mod version;

pub use changes::{ValueChange, changes};
pub use schema::schema;
pub use tree::NonFiniteNumber;

use rtc_diag::DiagnosticSink;
use rtc_ir::{Display, Scene};
use rtc_source::{FileId, SourceMap};
use std::io::{self, Write};

/// The two encodings of the IR.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoding {
    /// JSON, one entity per line.
    Json,
    /// The binary container, `.rtir`.
    Binary,
}

/// The encoding of the bytes; `None` if they are not IR. A container with a damaged magic is still
/// detected.
#[must_use]
pub fn detect_format(bytes: &[u8]) -> Option<Encoding> {
    if binary::has_magic(bytes) {
        Some(Encoding::Binary)
    } else if text::has_magic(bytes) {
        Some(Encoding::Json)
    } else {
        None
    }
}

/// Decodes a scene and reports errors to the sink. The scene still has to be validated.
pub fn decode(
    encoding: Encoding,
    file: FileId,
    map: &SourceMap,
    sink: &mut DiagnosticSink,
) -> Option<Scene> {
    let scene = match encoding {
        Encoding::Json => text::decode(file, map.bytes(file), map.budget()),
        Encoding::Binary => binary::decode(file, map.bytes(file)).map_err(|fault| vec![*fault]),
    };
    scene
        .map_err(|faults| faults.into_iter().for_each(|fault| sink.push(fault)))
        .ok()
}

/// An encoded scene that has not been written yet.
pub struct EncodedScene<'s>(Writing<'s>);

enum Writing<'s> {
    Json(Vec<u8>),
    Binary(binary::ContainerDraft<'s>),
}

impl EncodedScene<'_> {
    /// Writes the file in pieces: columns and pixels are not copied in memory.
    ///
    /// # Errors
    /// The bytes of `out`.
    pub fn write(&self, out: &mut dyn Write) -> io::Result<()> {
        match &self.0 {
            Writing::Json(text) => out.write_all(text),
            Writing::Binary(draft) => draft.write(out),
        }
    }
}

/// Encodes a scene. The same scene always gives the same bytes.
///
/// # Errors
/// If a number is not finite: JSON has no syntax for it.
pub fn prepare(encoding: Encoding, scene: &Scene) -> Result<EncodedScene<'_>, NonFiniteNumber> {
    Ok(EncodedScene(match encoding {
        Encoding::Json => {
            let mut text = Vec::new();
            print::document(scene, &mut text)?;
            Writing::Json(text)
        }
        Encoding::Binary => Writing::Binary(binary::encode(scene, &scene.display, &[])?),
    }))
}

/// Encodes a scene as a binary container with its stored hierarchies, which [`prepare`] leaves
/// out.
///
/// # Errors
/// As [`prepare`].
pub fn prepare_with_trees(scene: &Scene) -> Result<EncodedScene<'_>, NonFiniteNumber> {
    let draft = binary::encode(scene, &scene.display, &scene.trees)?;
    Ok(EncodedScene(Writing::Binary(draft)))
}

/// The bytes of an encoded scene.
///
/// # Errors
/// As [`prepare`].
pub fn encode(encoding: Encoding, scene: &Scene) -> Result<Vec<u8>, NonFiniteNumber> {
    let mut bytes = Vec::new();
    prepare(encoding, scene)?
        .write(&mut bytes)
        .expect("memory takes all there is to write");
    Ok(bytes)
}

/// The 128-bit XXH3 hash of the binary encoding of a scene with default display settings. The bytes
/// are hashed in pieces.
///
/// # Errors
/// As [`prepare`].
pub fn hash(scene: &Scene) -> Result<u128, NonFiniteNumber> {
    let mut hash = section::HashWriter::default();
    let draft = binary::encode(scene, &Display::default(), &[])?;
    draft.write(&mut hash).expect("hashing does not fail");
    Ok(hash.0.digest128())
}
