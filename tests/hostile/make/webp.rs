//! WebP files that are small and ask for much.

/// Name, bytes and the finding of each.
pub(crate) fn all() -> Vec<(&'static str, Vec<u8>, &'static str)> {
    vec![
        (
            "a WebP of 28 bytes and 16383² pixels",
            black(16383),
            "IO003",
        ),
        (
            "a WebP of 15 000 groups of prefix codes",
            codes(15_000),
            "IO003",
        ),
        (
            "a WebP with a prefix code twice too full",
            overfull(),
            "RE004",
        ),
        (
            "a WebP of 8² pixels around a picture of 16383²",
            beyond(16383),
            "RE004",
        ),
        (
            "a moving WebP of 8² pixels around one of 16383²",
            moving(16383),
            "RE004",
        ),
        (
            "a moving WebP of 8² pixels around one of 32²",
            moving(32),
            "RE004",
        ),
    ]
}

/// A stream of bits, the lowest of a byte first.
#[derive(Default)]
struct Bits {
    bytes: Vec<u8>,
    length: usize,
}

impl Bits {
    fn push(&mut self, value: u64, count: usize) {
        for bit in 0..count {
            if self.length.is_multiple_of(8) {
                self.bytes.push(0);
            }
            *self.bytes.last_mut().unwrap() |= ((value >> bit & 1) as u8) << (self.length % 8);
            self.length += 1;
        }
    }

    /// A prefix code of one symbol, which takes no bits.
    fn single(&mut self, symbol: u64) {
        self.push(0b101, 3);
        self.push(symbol, 8);
    }

    /// A prefix code of a symbol of one bit and 2048 symbols of twelve. Of the lengths of codes, 16
    /// repeats the one before up to six times.
    fn long(&mut self) {
        self.push(0, 1);
        // Of 17, 18, 0 to 5, 16 and 6 to 12: 1 takes two bits, 16 one, 12 two.
        let lengths = [0, 0, 0, 2, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 2];
        self.push(lengths.len() as u64 - 4, 4);
        lengths.iter().for_each(|length| self.push(*length, 3));
        // As many lengths are told of as there are here.
        self.push(1, 1);
        self.push(4, 3);
        self.push(344 - 2, 10);
        self.push(0b01, 2);
        self.push(0b11, 2);
        (0..341).for_each(|_| self.push(0b110, 3));
        self.push(0b11, 2);
    }

    /// What is no prefix code: twice as many codes as there is room for, of one to fifteen bits.
    fn twice(&mut self) {
        self.push(0, 1);
        // Of 17, 18, 0 to 5, 16 and 6 to 15: all but 16 to 18 take four bits.
        let lengths = [0, 0, 4, 4, 4, 4, 4, 4, 0, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4];
        self.push(lengths.len() as u64 - 4, 4);
        lengths.iter().for_each(|length| self.push(*length, 3));
        // As many lengths are told of as there are here.
        let told: Vec<u64> = [1, 1].into_iter().chain(1..=15).chain([15]).collect();
        self.push(1, 1);
        self.push(2, 3);
        self.push(told.len() as u64 - 2, 6);
        told.iter()
            .for_each(|length| self.push(length.reverse_bits() >> 60, 4));
    }
}

/// A RIFF chunk.
fn chunk(kind: &[u8; 4], contents: &[u8]) -> Vec<u8> {
    let length = u32::try_from(contents.len()).unwrap().to_le_bytes();
    let filling = vec![0; contents.len() % 2];
    [kind.as_slice(), &length, contents, &filling].concat()
}

fn riff(chunks: &[Vec<u8>]) -> Vec<u8> {
    chunk(b"RIFF", &[b"WEBP".as_slice(), &chunks.concat()].concat())
}

/// Begins a lossless picture.
fn lossless(side: u64) -> Bits {
    let mut bits = Bits::default();
    bits.push(0x2f, 8);
    bits.push(side - 1, 14);
    bits.push(side - 1, 14);
    bits.push(0, 4);
    bits
}

/// A lossless picture of one colour, of which no pixel takes a bit.
fn black(side: u64) -> Vec<u8> {
    let mut bits = lossless(side);
    // No transforms, no cache of colours, one group of codes of one symbol each.
    bits.push(0, 3);
    (0..5).for_each(|_| bits.push(0b0001, 4));
    riff(&[chunk(b"VP8L", &bits.bytes)])
}

/// A picture with a code that is none.
fn overfull() -> Vec<u8> {
    let mut bits = lossless(8);
    bits.push(0, 3);
    bits.twice();
    (0..4).for_each(|_| bits.push(0b0001, 4));
    bits.push(0, 64);
    riff(&[chunk(b"VP8L", &bits.bytes)])
}

/// A picture of 8 × 8 pixels with so many groups of prefix codes, each of one long code.
fn codes(groups: u64) -> Vec<u8> {
    let mut bits = lossless(8);
    // No transform; a cache of 2¹¹ colours; groups, which an image of one pixel chooses from.
    bits.push(0, 1);
    bits.push(1, 1);
    bits.push(11, 4);
    bits.push(1, 1);
    bits.push(7, 3);
    bits.push(0, 1);
    bits.single((groups - 1) & 255);
    bits.single((groups - 1) >> 8);
    (0..3).for_each(|_| bits.single(0));
    for _ in 0..groups {
        bits.long();
        (0..4).for_each(|_| bits.push(0b0001, 4));
    }
    riff(&[chunk(b"VP8L", &bits.bytes)])
}

/// A lossy picture, all grey.
fn lossy(side: u16) -> Vec<u8> {
    // A key frame, to be shown, with a first part of 4096 bytes.
    let tag = 1_u32 << 4 | 4096 << 5;
    let side = side.to_le_bytes();
    let head = [&tag.to_le_bytes()[..3], &[0x9d, 0x01, 0x2a], &side, &side].concat();
    chunk(b"VP8 ", &[head, vec![0; 4096 + 64]].concat())
}

/// Three bytes.
fn three(number: u32) -> Vec<u8> {
    number.to_le_bytes()[..3].to_vec()
}

/// The size of a canvas, and what is on it.
fn canvas(flags: u8, side: u32) -> Vec<u8> {
    let side = three(side - 1);
    chunk(
        b"VP8X",
        &[vec![flags, 0, 0, 0], side.clone(), side].concat(),
    )
}

/// A canvas of 8 × 8 pixels with a lossy picture of another size on it.
fn beyond(side: u16) -> Vec<u8> {
    riff(&[canvas(0, 8), lossy(side)])
}

/// The same as the first picture of an animation, with a plane of opacity.
fn moving(side: u16) -> Vec<u8> {
    let head = [three(0), three(0), three(7), three(7), three(1), vec![0]].concat();
    let opacity = chunk(b"ALPH", &[0; 65]);
    let frame = [head, opacity, lossy(side)].concat();
    riff(&[
        canvas(0b1_0010, 8),
        chunk(b"ANIM", &[0; 6]),
        chunk(b"ANMF", &frame),
    ])
}
