//! The maps of an MTL: a file, and options before it.

use super::super::WordSpan;
use super::super::material_use::name;
use crate::words::{Word, WordError};

/// An image, and its mapping onto a surface.
#[derive(Clone, Debug, PartialEq)]
pub struct MtlMap {
    /// The file.
    pub file: String,
    /// `-s`: the scale of the texture coordinates, any numbers.
    pub scale: [f64; 2],
    /// `-o`: the offset added after it, any numbers.
    pub offset: [f64; 2],
    /// `-clamp on`: beyond its edge the picture is as at it.
    pub clamps: bool,
    /// `-bm`: the height of a bump map, any number.
    pub height: f64,
    /// The span of the first effective option.
    pub placed: Option<WordSpan>,
}

/// Reads a map; beside it, its first option that changes the picture and is not read.
pub(super) fn read<'a>(
    head: &Word<'a>,
    rest: &[Word<'a>],
    file: &[u8],
) -> Result<(MtlMap, Option<Word<'a>>), WordError> {
    let mut map = MtlMap::of(String::new());
    let (mut rest, mut unread) = (rest, None);
    while let Some((option, others)) = rest.split_first() {
        let Some(plain) = plain_values(option.bytes) else {
            break;
        };
        // The trailing numbers of offsets and scales may be left out; the file follows.
        let most = plain.len().min(others.len().saturating_sub(1));
        let is_value = |(word, plain): &(&Word<'_>, &&str)| {
            word.number().is_ok() || plain.parse::<f64>().is_err()
        };
        let values = others[..most].iter().zip(plain);
        let count = values.clone().take_while(is_value).count();
        let is_same = |(word, plain): (&Word<'_>, &&str)| {
            word.bytes == plain.as_bytes()
                || word
                    .number()
                    .is_ok_and(|number| plain.parse() == Ok(number))
        };
        if !values.take(count).all(is_same) {
            if map.set(option, &others[..count]) {
                map.placed.get_or_insert(option.place());
            } else {
                unread.get_or_insert(*option);
            }
        }
        rest = &others[count..];
    }
    let missing = || head.fault(format!("`{}` names no file", head.text()), "left out");
    map.file = name(rest, file).ok_or_else(missing)?.text;
    Ok((map, unread))
}

impl MtlMap {
    /// A picture as it is.
    #[must_use]
    pub fn of(file: String) -> Self {
        Self {
            file,
            scale: [1.0; 2],
            offset: [0.0; 2],
            clamps: false,
            height: 1.0,
            placed: None,
        }
    }

    /// Takes an option with values; false if it is not read.
    fn set(&mut self, option: &Word<'_>, values: &[Word<'_>]) -> bool {
        let mut numbers = values.iter().map_while(|word| word.number().ok());
        match option.bytes {
            b"-s" | b"-o" => {
                let slots = match option.bytes {
                    b"-s" => &mut self.scale,
                    _ => &mut self.offset,
                };
                slots
                    .iter_mut()
                    .zip(numbers)
                    .for_each(|(slot, number)| *slot = number);
            }
            b"-bm" => self.height = numbers.next().unwrap_or(self.height),
            b"-clamp" => self.clamps = values.iter().any(|word| word.bytes == b"on"),
            _ => return false,
        }
        true
    }
}

/// The values of an option of a map that leave it as it is.
fn plain_values(option: &[u8]) -> Option<&'static [&'static str]> {
    match option {
        b"-bm" => Some(&["1"]),
        b"-mm" => Some(&["0", "1"]),
        b"-o" | b"-t" => Some(&["0", "0", "0"]),
        b"-s" => Some(&["1", "1", "1"]),
        b"-boost" => Some(&["0"]),
        b"-blendu" | b"-blendv" => Some(&["on"]),
        b"-cc" | b"-clamp" => Some(&["off"]),
        b"-imfchan" => Some(&["l"]),
        b"-texres" | b"-type" => Some(&["as it is"]),
        _ => None,
    }
}
