//! What binary layers are packed of: blocks of LZ4, integers as differences, and values, which are
//! read when they are asked for. Every offset, index and count is checked, and memory is charged
//! before it is taken.

use super::layer::{MAX_DEPTH, Value};
use super::text::LayerParseError;
use rtc_source::{Budget, LimitExceeded, Resource};
use std::cell::OnceCell;
use std::ops::RangeInclusive;

/// The memory of a token, in bytes, rounded up.
pub(super) const TOKEN: u64 = 64;
/// Shorter arrays are not compressed.
const MIN_COMPRESSED: usize = 16;
/// LZ4 makes fewer bytes of one.
const MOST_UNPACKED: usize = 256;

pub(super) const CUT: LayerParseError = LayerParseError::Damaged("it ends before its tables do");

/// The tables that values refer to.
#[derive(Debug)]
pub(super) struct CrateTables {
    pub(super) version: (u8, u8),
    pub(super) tokens: Vec<String>,
    pub(super) strings: Vec<u32>,
    pub(super) paths: Vec<PathEntry>,
    /// The limit that a value exceeded.
    pub(super) exceeded: OnceCell<LimitExceeded>,
}

/// A path: that of its parent with one more name.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PathEntry {
    pub(super) parent: Option<u32>,
    pub(super) name: u32,
    pub(super) is_property: bool,
    pub(super) depth: u16,
}

/// Reads from a place in the file.
#[derive(Clone, Copy)]
pub(super) struct ByteCursor<'a> {
    pub(super) bytes: &'a [u8],
    pub(super) at: usize,
}

impl<'a> ByteCursor<'a> {
    pub(super) fn new(bytes: &'a [u8], at: u64) -> Option<Self> {
        let at = usize::try_from(at).ok().filter(|at| *at <= bytes.len())?;
        Some(Self { bytes, at })
    }

    pub(super) fn take(&mut self, count: usize) -> Option<&'a [u8]> {
        let end = self.at.checked_add(count)?;
        let taken = self.bytes.get(self.at..end)?;
        self.at = end;
        Some(taken)
    }

    pub(super) fn u8(&mut self) -> Option<u8> {
        Some(self.take(1)?[0])
    }

    pub(super) fn u32(&mut self) -> Option<u32> {
        self.take(4)?.try_into().map(u32::from_le_bytes).ok()
    }

    pub(super) fn u64(&mut self) -> Option<u64> {
        self.take(8)?.try_into().map(u64::from_le_bytes).ok()
    }

    pub(super) fn f64(&mut self) -> Option<f64> {
        self.u64().map(f64::from_bits)
    }

    /// A count of items of at least so many bytes each, which the rest of the file has room for.
    pub(super) fn count(&mut self, least: usize) -> Option<usize> {
        let count = usize::try_from(self.u64()?).ok()?;
        let room = self.bytes.len().saturating_sub(self.at);
        (count.checked_mul(least)? <= room).then_some(count)
    }

    /// Follows an offset that is relative to where it stands; the cursor goes on behind it.
    pub(super) fn jump(&mut self) -> Option<Self> {
        let start = self.at;
        let offset = self.u64()?.cast_signed();
        let at = i64::try_from(start).ok()?.checked_add(offset)?;
        ByteCursor::new(self.bytes, u64::try_from(at).ok()?)
    }

    /// A block of LZ4, which becomes from `sizes.start()` to `sizes.end()` bytes.
    pub(super) fn unpack(
        &mut self,
        packed: usize,
        sizes: RangeInclusive<usize>,
        budget: &Budget,
    ) -> Result<Vec<u8>, LayerParseError> {
        const NOT_AS_LARGE: LayerParseError =
            LayerParseError::Damaged("a block is not as large as it says");
        // Memory is taken for no more than LZ4 can make of the block.
        let mut packed = self.take(packed).ok_or(CUT)?;
        let most = packed.len().saturating_mul(MOST_UNPACKED);
        if *sizes.start() > most {
            return Err(NOT_AS_LARGE);
        }
        let most = most.min(*sizes.end());
        charge(budget, most as u64)?;
        let mut unpacked = vec![0; most];
        // The first byte is the number of chunks; 0 means one without a length.
        let damaged = LayerParseError::Damaged("a block of it cannot be unpacked");
        let (chunks, rest) = packed.split_first().ok_or(CUT)?;
        packed = rest;
        // Unpack chunk by chunk.
        let mut length = 0;
        for _ in 0..(*chunks).max(1) {
            let mut block = packed;
            if *chunks > 0 {
                let mut cursor = ByteCursor {
                    bytes: packed,
                    at: 0,
                };
                let size = cursor.u32().ok_or(CUT)? as usize;
                block = cursor.take(size).ok_or(CUT)?;
                packed = &packed[cursor.at..];
            }
            match lz4_flex::block::decompress_into(block, &mut unpacked[length..]) {
                Ok(more) => length += more,
                Err(_) => return Err(damaged),
            }
        }
        unpacked.truncate(length);
        match sizes.contains(&length) {
            true => Ok(unpacked),
            false => Err(NOT_AS_LARGE),
        }
    }

    /// Integers of `size` bytes, stored as differences: 0 the common one, else 1, 2 or 4 bytes of
    /// four, and twice as many of eight.
    pub(super) fn integers(
        &mut self,
        count: usize,
        size: usize,
        budget: &Budget,
    ) -> Result<Vec<i64>, LayerParseError> {
        if count == 0 {
            return Ok(Vec::new());
        }
        let packed = self.count(1).ok_or(CUT)?;
        // Of differences that all are the common one there is only the table of codes.
        let least = size + count.div_ceil(4);
        let most = count.saturating_mul(size).saturating_add(least);
        let bytes = self.unpack(packed, least..=most, budget)?;
        charge(budget, (count as u64).saturating_mul(8))?;
        let mut codes = ByteCursor {
            bytes: &bytes,
            at: 0,
        };
        let common = codes.signed(size).ok_or(CUT)?;
        let table = codes.take(count.div_ceil(4)).ok_or(CUT)?;
        let (mut sum, mut all) = (0_i64, Vec::with_capacity(count));
        for index in 0..count {
            let code = (table[index / 4] >> (2 * (index % 4))) & 3;
            let difference = match code {
                0 => common,
                code => codes.signed((size / 4) << (code - 1)).ok_or(CUT)?,
            };
            sum = sum.wrapping_add(difference);
            if size == 4 {
                sum = i64::from(truncated(sum));
            }
            all.push(sum);
        }
        Ok(all)
    }

    /// An integer with a sign, of 1, 2, 4 or 8 bytes.
    fn signed(&mut self, size: usize) -> Option<i64> {
        let bytes = self.take(size)?;
        let mut wide = [if bytes[size - 1] & 0x80 == 0 { 0 } else { 0xff }; 8];
        wide[..size].copy_from_slice(bytes);
        Some(i64::from_le_bytes(wide))
    }

    /// Unsigned integers of four bytes.
    pub(super) fn indices(
        &mut self,
        count: usize,
        budget: &Budget,
    ) -> Result<Vec<u32>, LayerParseError> {
        let all = self.integers(count, 4, budget)?;
        Ok(all
            .into_iter()
            .map(|index| truncated(index).cast_unsigned())
            .collect())
    }
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "the low bits are asked for"
)]
fn truncated(number: i64) -> i32 {
    number as i32
}

pub(super) fn charge(budget: &Budget, bytes: u64) -> Result<(), LayerParseError> {
    budget
        .charge(Resource::Memory, bytes)
        .map_err(LayerParseError::Limit)
}

const ARRAY: u64 = 1 << 63;
const INLINED: u64 = 1 << 62;
const COMPRESSED: u64 = 1 << 61;
/// The bits of an offset, or of a value that is stored in its place.
pub(super) const PAYLOAD: u64 = (1 << 48) - 1;
pub(super) const PAYLOAD_ITEM: u8 = 47;

/// The kind of a value, a number of `crateDataTypes.h`.
pub(super) fn kind(packed: u64) -> Option<u8> {
    u8::try_from((packed >> 48) & 0xff).ok()
}

/// How numbers are stored.
#[derive(Clone, Copy, PartialEq)]
enum NumberFormat {
    Byte,
    Int(usize),
    Unsigned(usize),
    Half,
    Float,
    Double,
}

impl NumberFormat {
    fn size(self) -> usize {
        match self {
            Self::Byte => 1,
            Self::Half => 2,
            Self::Float => 4,
            Self::Double => 8,
            Self::Int(size) | Self::Unsigned(size) => size,
        }
    }

    /// The number of bytes as many as it has.
    #[expect(clippy::cast_precision_loss, reason = "numbers are doubles from here")]
    fn of(self, bytes: &[u8]) -> f64 {
        let mut wide = [0; 8];
        wide[..bytes.len()].copy_from_slice(bytes);
        let bits = u64::from_le_bytes(wide);
        let [a, b, c, d, ..] = wide;
        match self {
            Self::Byte | Self::Unsigned(_) => bits as f64,
            Self::Int(4) => f64::from(i32::from_le_bytes([a, b, c, d])),
            Self::Int(_) => bits.cast_signed() as f64,
            Self::Half => half(u16::from_le_bytes([a, b])),
            Self::Float => f64::from(f32::from_le_bytes([a, b, c, d])),
            Self::Double => f64::from_bits(bits),
        }
    }
}

/// A float of 16 bits (IEEE 754).
fn half(bits: u16) -> f64 {
    let sign = if bits & 0x8000 == 0 { 1.0 } else { -1.0 };
    let (exponent, fraction) = (u64::from((bits >> 10) & 31), f64::from(bits & 0x3ff));
    let power = |exponent: u64| f64::from_bits((1023 - 25 + exponent) << 52);
    let magnitude = match exponent {
        0 => fraction * power(1),
        31 if fraction == 0.0 => f64::INFINITY,
        31 => f64::NAN,
        _ => (1024.0 + fraction) * power(exponent),
    };
    sign * magnitude
}

/// The numbers of each kind of value, and how many one has; square matrices by their sides.
fn numbers_of(kind: u8) -> Option<(NumberFormat, usize, bool)> {
    let single = |number| Some((number, 1, false));
    let vector = |number, count| Some((number, count, false));
    let of_precision = |step: u8| match step {
        0 => NumberFormat::Double,
        1 => NumberFormat::Float,
        2 => NumberFormat::Half,
        _ => NumberFormat::Int(4),
    };
    match kind {
        1 | 2 => single(NumberFormat::Byte),
        3 => single(NumberFormat::Int(4)),
        4 => single(NumberFormat::Unsigned(4)),
        5 => single(NumberFormat::Int(8)),
        6 => single(NumberFormat::Unsigned(8)),
        7 => single(NumberFormat::Half),
        8 => single(NumberFormat::Float),
        9 | 48 | 56 => single(NumberFormat::Double),
        13..=15 => {
            let side = usize::from(kind - 11);
            Some((NumberFormat::Double, side * side, true))
        }
        16..=18 => vector(of_precision(kind - 16), 4),
        19..=30 => vector(
            of_precision((kind - 19) % 4),
            usize::from((kind - 19) / 4 + 2),
        ),
        _ => None,
    }
}

impl CrateTables {
    pub(super) fn token(&self, index: u32) -> Option<&str> {
        self.tokens.get(index as usize).map(String::as_str)
    }

    pub(super) fn string(&self, index: u32) -> Option<&str> {
        self.token(*self.strings.get(index as usize)?)
    }

    /// The last name of a path.
    pub(super) fn name(&self, path: u32) -> Option<&str> {
        self.token(self.paths.get(path as usize)?.name)
    }

    /// A path as text, without selections of variants.
    pub(super) fn path(&self, index: u32) -> Option<String> {
        let mut names = Vec::new();
        let mut at = self.paths.get(index as usize)?;
        while let Some(parent) = at.parent.filter(|_| names.len() <= 2 * MAX_DEPTH) {
            let name = self.token(at.name)?;
            if !name.starts_with('{') {
                names.push((if at.is_property { "." } else { "/" }, name));
            }
            at = self.paths.get(parent as usize)?;
        }
        if names.is_empty() {
            return Some("/".to_owned());
        }
        let parts = names.into_iter().rev();
        Some(parts.flat_map(|(joint, name)| [joint, name]).collect())
    }

    /// The times and the values of an attribute.
    pub(super) fn samples(&self, bytes: &[u8], packed: u64, budget: &Budget) -> Vec<(f64, u64)> {
        let read = || {
            let mut cursor = ByteCursor::new(bytes, packed & PAYLOAD)?;
            let mut times = cursor.jump()?;
            let Value::Numbers(numbers) = self.value(bytes, times.u64()?, budget)? else {
                return None;
            };
            let mut values = times.jump()?;
            let count = values.count(8)?.min(numbers.len());
            self.kept(charge(budget, 16 * count as u64))?;
            let pairs = numbers.into_iter().take(count);
            pairs
                .map(|time| Some((time, values.u64()?)))
                .collect::<Option<Vec<_>>>()
        };
        read().unwrap_or_default()
    }

    /// What was read, unless a limit is exceeded or the file is damaged.
    fn kept<T>(&self, read: Result<T, LayerParseError>) -> Option<T> {
        let keep = |fault| {
            if let LayerParseError::Limit(fault) = fault {
                self.exceeded.get_or_init(|| fault);
            }
        };
        read.map_err(keep).ok()
    }

    /// A value of the file, none of a kind without use; `None` if it is damaged, or too large.
    pub(super) fn value(&self, bytes: &[u8], packed: u64, budget: &Budget) -> Option<Value> {
        let (kind, payload) = (kind(packed)?, packed & PAYLOAD);
        let (is_array, is_inlined) = (packed & ARRAY != 0, packed & INLINED != 0);
        match kind {
            51 => return Some(Value::Blocked),
            10..=12 | 41 | 50 => return self.texts(bytes, packed, budget),
            _ => {}
        }
        let Some((number, width, is_matrix)) = numbers_of(kind) else {
            return Some(Value::Blocked);
        };
        let inline = payload.to_le_bytes();
        let mut numbers = match (is_array || kind == 48, is_inlined) {
            (true, _) => self.array(bytes, packed, number, width, budget)?,
            (false, true) if width > 1 => {
                // The components, or those of the diagonal, are bytes with a sign.
                if number == NumberFormat::Half && width == 2 {
                    vec![number.of(&inline[..2]), number.of(&inline[2..4])]
                } else {
                    let byte = |index: usize| f64::from(inline[index].cast_signed());
                    let side = (2..=4)
                        .find(|side| side * side == width)
                        .filter(|_| is_matrix);
                    match side {
                        Some(side) => (0..width)
                            .map(|at| {
                                if at % (side + 1) == 0 {
                                    byte(at / side)
                                } else {
                                    0.0
                                }
                            })
                            .collect(),
                        None => (0..width).map(byte).collect(),
                    }
                }
            }
            (false, true) => vec![match number {
                NumberFormat::Double => NumberFormat::Float.of(&inline[..4]),
                NumberFormat::Int(_) => NumberFormat::Int(4).of(&inline[..4]),
                NumberFormat::Byte
                | NumberFormat::Unsigned(_)
                | NumberFormat::Half
                | NumberFormat::Float => number.of(&inline[..number.size().min(4)]),
            }],
            (false, false) => {
                let mut cursor = ByteCursor::new(bytes, payload)?;
                let read = (0..width).map(|_| Some(number.of(cursor.take(number.size())?)));
                read.collect::<Option<Vec<f64>>>()?
            }
        };
        // Files have the real part of a quaternion last, texts first.
        if (16..=18).contains(&kind) {
            numbers
                .chunks_exact_mut(4)
                .for_each(|quaternion| quaternion.rotate_right(1));
        }
        Some(Value::Numbers(numbers))
    }

    fn array(
        &self,
        bytes: &[u8],
        packed: u64,
        number: NumberFormat,
        width: usize,
        budget: &Budget,
    ) -> Option<Vec<f64>> {
        if packed & PAYLOAD == 0 {
            return Some(Vec::new());
        }
        // Read the count and whether the array is compressed.
        let (mut cursor, count) = self.array_start(bytes, packed)?;
        let size = number.size();
        let is_packed = packed & COMPRESSED != 0 && count >= MIN_COMPRESSED && width == 1;
        // Plain arrays are copied.
        if !is_packed {
            let total = count.checked_mul(width)?;
            let raw = cursor.take(total.checked_mul(size)?)?;
            // Compressed integers are deltas; compressed floats are integers or indices of a table.
            self.kept(charge(budget, 8 * total as u64))?;
            return Some(
                raw.chunks_exact(size)
                    .map(|bytes| number.of(bytes))
                    .collect(),
            );
        }
        self.kept(charge(budget, (count as u64).checked_mul(8)?))?;
        #[expect(clippy::cast_precision_loss, reason = "numbers are doubles from here")]
        let doubles = |all: Vec<i64>| all.into_iter().map(|number| number as f64).collect();
        match number {
            NumberFormat::Int(size) => {
                Some(doubles(self.kept(cursor.integers(count, size, budget))?))
            }
            NumberFormat::Unsigned(4) => {
                let all = self.kept(cursor.indices(count, budget))?;
                Some(all.into_iter().map(f64::from).collect())
            }
            NumberFormat::Unsigned(size) => {
                let all = self.kept(cursor.integers(count, size, budget))?;
                Some(
                    all.into_iter()
                        .map(|bits| bits.cast_unsigned() as f64)
                        .collect(),
                )
            }
            NumberFormat::Byte => None,
            NumberFormat::Half | NumberFormat::Float | NumberFormat::Double => match cursor.u8()? {
                b'i' => Some(doubles(self.kept(cursor.integers(count, 4, budget))?)),
                b't' => {
                    let entries = cursor.u32()? as usize;
                    let raw = cursor.take(entries.checked_mul(size)?)?;
                    let indices = self.kept(cursor.indices(count, budget))?;
                    let entry = |index: u32| {
                        let start = (index as usize).checked_mul(size)?;
                        Some(number.of(raw.get(start..start + size)?))
                    };
                    indices.into_iter().map(entry).collect()
                }
                _ => None,
            },
        }
    }

    /// Where the items of an array begin, and how many there are.
    fn array_start<'b>(&self, bytes: &'b [u8], packed: u64) -> Option<(ByteCursor<'b>, usize)> {
        let mut cursor = ByteCursor::new(bytes, packed & PAYLOAD)?;
        if self.version < (0, 5) && packed & ARRAY != 0 {
            cursor.u32()?;
        }
        let is_long = self.version >= (0, 7) || packed & ARRAY == 0;
        let count = if is_long {
            cursor.u64()?
        } else {
            u64::from(cursor.u32()?)
        };
        Some((cursor, usize::try_from(count).ok()?))
    }

    fn texts(&self, bytes: &[u8], packed: u64, budget: &Budget) -> Option<Value> {
        let kind = kind(packed)?;
        // Lists of assets are lists of strings, one asset is a token.
        let is_array = packed & ARRAY != 0 || matches!(kind, 41 | 50);
        let text = |index: u32| match kind {
            10 | 50 => self.string(index),
            12 if is_array => self.string(index),
            _ => self.token(index),
        };
        if packed & INLINED != 0 {
            let index = u32::try_from(packed & 0xffff_ffff).ok()?;
            return Some(Value::Texts(vec![text(index)?.to_owned()]));
        }
        if packed & PAYLOAD == 0 {
            return Some(Value::Texts(Vec::new()));
        }
        let (mut cursor, count) = match is_array {
            true => self.array_start(bytes, packed)?,
            false => (ByteCursor::new(bytes, packed & PAYLOAD)?, 1),
        };
        let room = cursor.bytes.len() - cursor.at;
        if count.checked_mul(4)? > room {
            return None;
        }
        let read = |_| {
            let text = text(cursor.u32()?)?;
            self.kept(charge(budget, TOKEN + text.len() as u64))?;
            Some(text.to_owned())
        };
        (0..count)
            .map(read)
            .collect::<Option<Vec<_>>>()
            .map(Value::Texts)
    }
}
