//! The head of a PLY: its form, and the elements with their properties, in the order of the body.

use super::super::material_use::{SpannedName, name};
use crate::words::{Word, WordError, WordLines};

/// The encoding of the numbers in the body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PlyEncoding {
    Text,
    LittleEndian,
    BigEndian,
}

/// The type of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PlyNumberType {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

/// An element of the header: a number of rows of properties.
#[derive(Debug)]
pub(super) struct PlyElement<'a> {
    pub(super) name: Word<'a>,
    pub(super) count: usize,
    /// The span of the count.
    promise: Word<'a>,
    pub(super) properties: Vec<PlyProperty<'a>>,
}

/// A number, or a list of numbers, of each row.
#[derive(Debug)]
pub(super) struct PlyProperty<'a> {
    pub(super) name: Word<'a>,
    pub(super) kind: PlyNumberType,
    /// The type of the length, if it is a list.
    pub(super) length: Option<PlyNumberType>,
}

impl PlyNumberType {
    fn of(word: &Word<'_>) -> Result<Self, WordError> {
        Ok(match word.bytes {
            b"char" | b"int8" => Self::I8,
            b"uchar" | b"uint8" => Self::U8,
            b"short" | b"int16" => Self::I16,
            b"ushort" | b"uint16" => Self::U16,
            b"int" | b"int32" => Self::I32,
            b"uint" | b"uint32" => Self::U32,
            b"float" | b"float32" => Self::F32,
            b"double" | b"float64" => Self::F64,
            _ => {
                let message = format!("unknown type `{}`", word.text());
                return Err(word.fault(message, "char to double are there"));
            }
        })
    }

    /// In a binary file, in bytes.
    pub(super) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    /// A number of this type as a part of the whole: that of whole numbers is their largest.
    pub(super) fn fraction(self, number: f64) -> f64 {
        let whole = match self {
            Self::I8 | Self::U8 => 255.0,
            Self::I16 | Self::U16 => 65_535.0,
            Self::I32 | Self::U32 => f64::from(u32::MAX),
            Self::F32 | Self::F64 => 1.0,
        };
        (number / whole).clamp(0.0, 1.0)
    }
}

impl PlyProperty<'_> {
    /// Whether it lists the corners of a face.
    pub(super) fn is_corners(&self) -> bool {
        let is_named = matches!(self.name.bytes, b"vertex_indices" | b"vertex_index");
        is_named && self.length.is_some()
    }

    /// Whether it lists the texture coordinates of the corners of a face.
    pub(super) fn is_uvs(&self) -> bool {
        self.name.bytes == b"texcoord" && self.length.is_some()
    }
}

impl PlyElement<'_> {
    /// The file has fewer than declared.
    pub(super) fn is_cut_off(&self) -> WordError {
        let message = format!(
            "the file ends before the last of {} of `{}`",
            self.count,
            self.name.text()
        );
        self.promise.fault(message, "promised here")
    }
}

/// The header.
pub(super) struct PlyHeader<'a> {
    pub(super) elements: Vec<PlyElement<'a>>,
    pub(super) form: PlyEncoding,
    /// The offset of the body.
    pub(super) start: usize,
    /// The pictures that comments name: the first, and how many.
    pub(super) textures: Option<(SpannedName, usize)>,
}

impl PlyHeader<'_> {
    /// The declared number of vertices.
    pub(super) fn vertices(&self) -> usize {
        let mut elements = self.elements.iter();
        let vertices = elements.find(|element| element.name.bytes == b"vertex");
        vertices.map_or(0, |element| element.count)
    }
}

/// Reads the head.
pub(super) fn read(bytes: &[u8]) -> Result<PlyHeader<'_>, WordError> {
    let (mut lines, mut words) = (WordLines::new(bytes), Vec::new());
    let (mut elements, mut form, mut textures) = (Vec::new(), None, None);
    while lines.next(&mut words) {
        // Each line declares the format, an element or a property of the last element.
        match (words[0].bytes, &words[1..]) {
            (b"comment", [word, rest @ ..]) if word.bytes.eq_ignore_ascii_case(b"texturefile") => {
                if let Some(file) = name(rest, bytes) {
                    textures.get_or_insert((file, 0)).1 += 1;
                }
            }
            (b"ply" | b"comment" | b"obj_info", _) => {}
            (b"format", [word, ..]) => form = Some(form_of(word)?),
            (b"element", [name, count, ..]) => elements.push(element(*name, *count)?),
            (b"property", rest) => {
                let Some(element) = elements.last_mut() else {
                    return Err(words[0].fault("the property is of no element", "before the first"));
                };
                element.properties.push(property(&words[0], rest)?);
            }
            // The body starts after this line.
            (b"end_header", _) => {
                let form = form
                    .ok_or_else(|| words[0].fault("the header has no `format`", "it ends here"))?;
                return Ok(PlyHeader {
                    elements,
                    form,
                    start: end(&words[0], bytes),
                    textures,
                });
            }
            _ => {
                let head = name(&words, bytes).map_or_else(String::new, |line| line.text);
                let message = format!("`{}` is not a line of a header", rtc_diag::clip(&head));
                return Err(words[0].fault(message, "before `end_header`"));
            }
        }
    }
    Err(Word::START.fault("the head has no `end_header`", "in this file"))
}

/// The end of the line of a word.
fn end(word: &Word<'_>, bytes: &[u8]) -> usize {
    let end = word.range().end;
    let rest = &bytes[end..];
    let line = rest.iter().position(|byte| *byte == b'\n');
    // Old systems end lines by `\r` alone.
    let line = line.filter(|line| rest[..*line].iter().all(u8::is_ascii_whitespace));
    end + line.map_or(1, |line| line + 1).min(rest.len())
}

fn form_of(word: &Word<'_>) -> Result<PlyEncoding, WordError> {
    match word.bytes {
        b"ascii" => Ok(PlyEncoding::Text),
        b"binary_little_endian" => Ok(PlyEncoding::LittleEndian),
        b"binary_big_endian" => Ok(PlyEncoding::BigEndian),
        _ => Err(word.fault(format!("there is no format `{}`", word.text()), "unknown")),
    }
}

fn element<'a>(name: Word<'a>, promise: Word<'a>) -> Result<PlyElement<'a>, WordError> {
    let count = usize::try_from(promise.integer()?);
    Ok(PlyElement {
        name,
        count: count.map_err(|_| promise.fault("a count is negative", "of this element"))?,
        promise,
        properties: Vec::new(),
    })
}

fn property<'a>(head: &Word<'a>, rest: &[Word<'a>]) -> Result<PlyProperty<'a>, WordError> {
    match rest {
        [list, length, kind, name, ..] if list.bytes == b"list" => Ok(PlyProperty {
            name: *name,
            kind: PlyNumberType::of(kind)?,
            length: Some(PlyNumberType::of(length)?),
        }),
        [kind, name, ..] => Ok(PlyProperty {
            name: *name,
            kind: PlyNumberType::of(kind)?,
            length: None,
        }),
        _ => Err(head.fault("a property has a type and a name", "this has not")),
    }
}
