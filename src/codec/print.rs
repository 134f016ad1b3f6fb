//! The layout of the JSON encoding: the two outer levels are broken into lines, deeper levels stay
//! on one line.
//!
//! So each entity and each setting is one line, and a change of one is a change of one line.

use super::tree::NonFiniteNumber;
use rtc_ir::{Scene, VERSION};
use serde::Serialize;
use serde_json::Serializer;
use serde_json::ser::Formatter;
use std::io::{self, ErrorKind, Write};

/// The number of outer levels that are broken into lines.
const BROKEN: usize = 2;

/// The document of a scene.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct WrittenDocument<'s> {
    ir_version: u32,
    #[serde(flatten)]
    scene: &'s Scene,
}

/// Writes a scene as JSON, `irVersion` first, ending with a newline. `out` must not fail.
pub(super) fn document(scene: &Scene, out: &mut impl Write) -> Result<(), NonFiniteNumber> {
    let mut serializer = Serializer::with_formatter(&mut *out, JsonLayout::default());
    // Only the layout can fail: it rejects numbers that are not finite.
    WrittenDocument {
        ir_version: VERSION,
        scene,
    }
    .serialize(&mut serializer)
    .map_err(|_| NonFiniteNumber)?;
    out.write_all(b"\n")
        .and_then(|()| out.flush())
        .map_err(|_| NonFiniteNumber)
}

#[derive(Default)]
struct JsonLayout {
    /// The nesting depth.
    level: usize,
    /// Whether the innermost list or map has an item.
    filled: bool,
}

impl JsonLayout {
    fn open(&mut self, out: &mut (impl Write + ?Sized), bracket: &[u8]) -> io::Result<()> {
        (self.level, self.filled) = (self.level + 1, false);
        out.write_all(bracket)
    }

    fn item(&self, out: &mut (impl Write + ?Sized), first: bool) -> io::Result<()> {
        match (self.level <= BROKEN, first) {
            (true, true) => self.new_line(out),
            (true, false) => out.write_all(b",").and_then(|()| self.new_line(out)),
            (false, true) => Ok(()),
            (false, false) => out.write_all(b", "),
        }
    }

    fn close(&mut self, out: &mut (impl Write + ?Sized), bracket: &[u8]) -> io::Result<()> {
        self.level -= 1;
        if self.filled && self.level < BROKEN {
            self.new_line(out)?;
        }
        out.write_all(bracket)
    }

    fn new_line(&self, out: &mut (impl Write + ?Sized)) -> io::Result<()> {
        out.write_all(b"\n")?;
        (0..self.level).try_for_each(|_| out.write_all(b"  "))
    }
}

impl Formatter for JsonLayout {
    /// `serde_json` writes null for a number that is not finite, and the IR has no other nulls.
    fn write_null<W: ?Sized + Write>(&mut self, _out: &mut W) -> io::Result<()> {
        Err(ErrorKind::InvalidData.into())
    }

    fn begin_array<W: ?Sized + Write>(&mut self, out: &mut W) -> io::Result<()> {
        self.open(out, b"[")
    }

    fn begin_array_value<W: ?Sized + Write>(&mut self, out: &mut W, first: bool) -> io::Result<()> {
        self.item(out, first)
    }

    fn end_array_value<W: ?Sized + Write>(&mut self, _out: &mut W) -> io::Result<()> {
        self.filled = true;
        Ok(())
    }

    fn end_array<W: ?Sized + Write>(&mut self, out: &mut W) -> io::Result<()> {
        self.close(out, b"]")
    }

    fn begin_object<W: ?Sized + Write>(&mut self, out: &mut W) -> io::Result<()> {
        self.open(out, b"{")
    }

    fn begin_object_key<W: ?Sized + Write>(&mut self, out: &mut W, first: bool) -> io::Result<()> {
        self.item(out, first)
    }

    fn begin_object_value<W: ?Sized + Write>(&mut self, out: &mut W) -> io::Result<()> {
        out.write_all(b": ")
    }

    fn end_object_value<W: ?Sized + Write>(&mut self, _out: &mut W) -> io::Result<()> {
        self.filled = true;
        Ok(())
    }

    fn end_object<W: ?Sized + Write>(&mut self, out: &mut W) -> io::Result<()> {
        self.close(out, b"}")
    }
}
