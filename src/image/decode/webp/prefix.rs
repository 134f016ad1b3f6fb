//! The prefix codes of a lossless picture, and their bit stream.
//!
//! Where the decoder deviates from the specification, as in the order of two symbols, this follows
//! the decoder, so that both find the same codes. Incomplete codes are rejected, since the decoder
//! does not detect all of them.

/// The memory of the decoder per code, beside its tables.
pub(super) const CODE: u64 = 56;

/// The maximum overhead of two allocations.
const ALLOCATIONS: u64 = 64;

/// The longest code, in bits.
const LONGEST: usize = 15;

/// The longest code that the decoder has a table for; longer ones are branches of a tree.
const TABLE: usize = 10;

/// A stream of bits, the lowest of a byte first.
pub(super) struct BitReader<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> BitReader<'a> {
    /// The bits of these bytes without the first ones.
    pub(super) fn of(bytes: &'a [u8], at: usize) -> Self {
        Self { bytes, at }
    }

    /// The number of bits read.
    pub(super) fn at(&self) -> usize {
        self.at
    }

    /// The next bits, at least 32; behind the end there are zeros.
    fn peek(&self) -> u64 {
        let rest = self.bytes.get(self.at / 8..).unwrap_or_default();
        let bytes = rest.first_chunk().copied().unwrap_or_else(|| {
            let mut last = [0; 8];
            last.iter_mut().zip(rest).for_each(|(to, from)| *to = *from);
            last
        });
        u64::from_le_bytes(bytes) >> (self.at % 8)
    }

    fn pass(&mut self, count: usize) -> Option<()> {
        self.at += count;
        (self.at <= self.bytes.len().saturating_mul(8)).then_some(())
    }

    /// A number of at most 32 bits.
    pub(super) fn read(&mut self, count: u32) -> Option<u32> {
        let number = self.peek() & ((1 << count) - 1);
        self.pass(count as usize)?;
        u32::try_from(number).ok()
    }

    pub(super) fn flag(&mut self) -> Option<bool> {
        Some(self.read(1)? == 1)
    }
}

/// A complete prefix code, or one symbol, which takes no bits.
pub(super) struct PrefixCode {
    /// The number of symbols with a code of each length.
    counts: [u16; LONGEST + 1],
    /// The symbols, in the order of their codes.
    symbols: Vec<u16>,
    /// Bytes of its tables.
    memory: u64,
}

impl PrefixCode {
    /// Reads a code of this many symbols.
    pub(super) fn read(bits: &mut BitReader<'_>, alphabet: u16) -> Option<Self> {
        if bits.flag()? {
            Self::simple(bits, alphabet)
        } else {
            Self::of(&lengths(bits, alphabet)?)
        }
    }

    /// Reads one or two symbols.
    fn simple(bits: &mut BitReader<'_>, alphabet: u16) -> Option<Self> {
        let is_pair = bits.flag()?;
        let width = if bits.flag()? { 8 } else { 1 };
        let mut symbols = vec![u16::try_from(bits.read(width)?).ok()?];
        let mut counts = [0; LONGEST + 1];
        if is_pair {
            symbols.push(u16::try_from(bits.read(8)?).ok()?);
            counts[1] = 2;
        }
        let is_known = symbols.iter().all(|symbol| *symbol < alphabet);
        is_known.then_some(Self {
            counts,
            symbols,
            memory: if is_pair { 56 + ALLOCATIONS } else { 0 },
        })
    }

    /// A code with these lengths, if there is a complete one; 0 is a symbol without a code.
    fn of(lengths: &[u8]) -> Option<Self> {
        let mut counts = [0_u16; LONGEST + 1];
        for length in lengths.iter().filter(|length| **length > 0) {
            *counts.get_mut(usize::from(*length))? += 1;
        }
        let symbols = in_order(lengths, &counts);
        if symbols.len() == 1 {
            return Some(Self {
                counts: [0; LONGEST + 1],
                symbols,
                memory: 0,
            });
        }
        let fraction = |(length, count): (usize, &u16)| u32::from(*count) << (LONGEST - length);
        let fractions: u32 = counts.iter().enumerate().map(fraction).sum();
        (fractions == 1 << LONGEST).then(|| Self {
            memory: tables(&counts),
            counts,
            symbols,
        })
    }

    /// Reads a symbol.
    pub(super) fn symbol(&self, bits: &mut BitReader<'_>) -> Option<u16> {
        if let [symbol] = self.symbols.as_slice() {
            return Some(*symbol);
        }
        let (mut ahead, mut code, mut first, mut index) = (bits.peek(), 0, 0, 0);
        for (length, count) in self.counts.iter().enumerate().skip(1) {
            let count = usize::from(*count);
            code = code << 1 | (ahead & 1) as usize;
            ahead >>= 1;
            if code < first + count {
                bits.pass(length)?;
                return self.symbols.get(index + code - first).copied();
            }
            index += count;
            first = (first + count) << 1;
        }
        None
    }

    /// Bytes that the decoder takes for its tables.
    pub(super) fn memory(&self) -> u64 {
        self.memory
    }
}

/// The symbols that have codes, by the lengths of these.
fn in_order(lengths: &[u8], counts: &[u16; LONGEST + 1]) -> Vec<u16> {
    let mut next = [0; LONGEST + 2];
    for (length, count) in counts.iter().enumerate() {
        next[length + 1] = next[length] + usize::from(*count);
    }
    let mut symbols = vec![0; next[LONGEST + 1]];
    for (symbol, length) in (0..).zip(lengths).filter(|(_, length)| **length > 0) {
        let at = &mut next[usize::from(*length)];
        symbols[*at] = symbol;
        *at += 1;
    }
    symbols
}

/// Bytes of the tables of a code: four for each number of as many bits as the longest code has, up
/// to ten, and two branches of sixteen for each code that is longer.
fn tables(counts: &[u16; LONGEST + 1]) -> u64 {
    let longest = counts.iter().rposition(|count| *count > 0).unwrap_or(0);
    let longer: u64 = counts
        .iter()
        .skip(TABLE + 1)
        .map(|count| u64::from(*count))
        .sum();
    (4 << longest.min(TABLE)) + 32 * longer + ALLOCATIONS
}

/// Reads the code lengths of this many symbols, which have a code of their own.
fn lengths(bits: &mut BitReader<'_>, alphabet: u16) -> Option<Vec<u8>> {
    /// The order of the lengths of the code lengths.
    const ORDER: [usize; 19] = [
        17, 18, 0, 1, 2, 3, 4, 5, 16, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15,
    ];
    // Read the prefix code of the code lengths.
    let mut of_lengths = [0; ORDER.len()];
    let count = 4 + bits.read(4)? as usize;
    for at in ORDER.get(..count)? {
        of_lengths[*at] = u8::try_from(bits.read(3)?).ok()?;
    }
    let code = PrefixCode::of(&of_lengths)?;
    let alphabet = usize::from(alphabet);
    // Read how many symbols follow.
    let mut left = if bits.flag()? {
        let width = 2 + 2 * bits.read(3)?;
        2 + bits.read(width)? as usize
    } else {
        alphabet
    };
    if left > alphabet {
        return None;
    }
    // Decode the lengths: 16 repeats the last one, 17 and 18 repeat zero.
    let mut lengths = Vec::with_capacity(alphabet);
    let mut last = 8;
    while lengths.len() < alphabet && left > 0 {
        left -= 1;
        let (length, times) = match u8::try_from(code.symbol(bits)?).ok()? {
            16 => (last, 3 + bits.read(2)?),
            17 => (0, 3 + bits.read(3)?),
            18 => (0, 11 + bits.read(7)?),
            length => (length, 1),
        };
        if length > 0 {
            last = length;
        }
        lengths.extend(std::iter::repeat_n(length, times as usize));
    }
    (lengths.len() <= alphabet).then_some(lengths)
}
