//! Checks that bytes are text fit to parse: UTF-8, no control characters, no scalar that is too
//! long.

use super::YamlError;
use crate::{FileId, Span};
use rtc_math::to_u32;

/// The maximum length in bytes of a run without separators, and of a scalar.
pub(super) const MAX_WORD: usize = 1 << 20;

/// The text of a file, without its byte order mark, and its offset in the file.
pub(super) fn text(file: FileId, bytes: &[u8]) -> Result<(&str, u32), YamlError<'static>> {
    let text = decode(file, bytes)?;
    let body = text.strip_prefix('\u{feff}').unwrap_or(text);
    let base = text.len() - body.len();
    match unfit(file, body, base) {
        None => Ok((body, to_u32(base))),
        Some(mistake) => Err(mistake),
    }
}

fn decode(file: FileId, bytes: &[u8]) -> Result<&str, YamlError<'static>> {
    if looks_like_utf16(bytes) {
        let span = Span::new(file, 0, to_u32(bytes.len().min(2)));
        return Err(YamlError::Utf16 { span });
    }
    std::str::from_utf8(bytes).map_err(|error| {
        let at = error.valid_up_to();
        YamlError::NotUtf8 {
            byte: bytes.get(at).copied().unwrap_or_default(),
            span: Span::new(file, to_u32(at), to_u32(at + 1)),
        }
    })
}

/// Whether it starts with a UTF-16 byte order mark, or exactly one of the first two bytes is zero.
fn looks_like_utf16(bytes: &[u8]) -> bool {
    match *bytes {
        [0xff, 0xfe, ..] | [0xfe, 0xff, ..] => true,
        [first, second, ..] => (first == 0) != (second == 0),
        [_] | [] => false,
    }
}

#[derive(Clone, Copy, PartialEq)]
enum CharacterClass {
    Ordinary,
    Separator,
    Control,
    /// The first byte of U+0080 to U+00BF.
    MaybeControl,
}

const CLASSES: [CharacterClass; 256] = classes();

const fn classes() -> [CharacterClass; 256] {
    let mut classes = [CharacterClass::Ordinary; 256];
    let mut control = 0;
    while control < 0x20 {
        classes[control] = CharacterClass::Control;
        control += 1;
    }
    classes[0x7f] = CharacterClass::Control;
    classes[0xc2] = CharacterClass::MaybeControl;
    let separators = b"\t\n\r,:[]{}";
    let mut at = 0;
    while at < separators.len() {
        classes[separators[at] as usize] = CharacterClass::Separator;
        at += 1;
    }
    classes
}

/// The first character that YAML does not allow, or the start of a scalar that is too long.
fn unfit(file: FileId, text: &str, base: usize) -> Option<YamlError<'static>> {
    let bytes = text.as_bytes();
    let mut word_start = 0;
    // In chunks, so that a scalar of many chunks is found after two of them.
    for (piece, start) in bytes.chunks(MAX_WORD).zip((0..).step_by(MAX_WORD)) {
        for (at, byte) in (start..).zip(piece) {
            match CLASSES[usize::from(*byte)] {
                CharacterClass::Ordinary => {}
                CharacterClass::Separator => word_start = at + 1,
                CharacterClass::Control => {
                    return Some(control(file, base + at, 1, u32::from(*byte)));
                }
                CharacterClass::MaybeControl => match bytes.get(at + 1).copied() {
                    Some(0x85) | None => {}
                    Some(second) if second >= 0xa0 => {}
                    Some(second) => return Some(control(file, base + at, 2, u32::from(second))),
                },
            }
        }
        if word_start + MAX_WORD < start + piece.len() {
            return Some(too_long(file, base + word_start));
        }
    }
    None
}

fn control(file: FileId, at: usize, length: usize, character: u32) -> YamlError<'static> {
    YamlError::Control {
        character,
        span: Span::new(file, to_u32(at), to_u32(at + length)),
    }
}

/// The error for a scalar of more than one MiB at `at`.
pub(super) fn too_long(file: FileId, at: usize) -> YamlError<'static> {
    let at = to_u32(at);
    YamlError::TooLong {
        span: Span::new(file, at, at + 1),
    }
}
