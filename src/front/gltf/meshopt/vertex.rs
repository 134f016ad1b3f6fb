//! Mode 0: elements as differences from the one before, byte by byte, in blocks of groups of 16.

use super::{MeshoptError, MeshoptReader, unzigzag};

/// Elements of a group.
const GROUP: usize = 16;
/// The maximum bytes and elements of a block.
const BLOCK_BYTES: usize = 8192;
const BLOCK_ELEMENTS: usize = 256;

/// The encoding of the differences of a channel of four bytes; version 0 has bytes only.
#[derive(Clone, Copy)]
enum ByteChannel {
    Bytes,
    Shorts,
    /// Exclusive or, with the bits rotated so far.
    Xor(u32),
}

/// Decodes `count` elements of `stride` bytes.
pub(super) fn decode(bytes: &[u8], count: usize, stride: usize) -> Result<Vec<u8>, MeshoptError> {
    if !stride.is_multiple_of(4) || stride == 0 || stride > BLOCK_ELEMENTS {
        return Err("the stride is not a multiple of 4 up to 256");
    }
    // The first byte holds the version.
    let version = match bytes.first() {
        Some(0xa0) => 0,
        Some(0xa1) => 1,
        _ => return Err("the first byte does not mark attributes"),
    };
    // The tail holds the first element, and in version 1 the mode of each channel.
    let tail = if version == 0 {
        stride
    } else {
        stride + stride / 4
    };
    let padded = tail.max(if version == 0 { 32 } else { 24 });
    let end = bytes
        .len()
        .checked_sub(padded)
        .filter(|end| *end >= 1)
        .ok_or("the data ends too early")?;
    let (baseline, channels) = bytes[bytes.len() - tail..].split_at(stride);
    let channels = if version == 0 {
        vec![ByteChannel::Bytes; stride / 4]
    } else {
        read_channels(channels)?
    };
    let mut reader = MeshoptReader {
        bytes: &bytes[1..end],
    };
    // Decode blocks of elements: each is the previous one plus deltas.
    let mut last = baseline.to_vec();
    let mut decoded = Vec::with_capacity(count * stride);
    let block = ((BLOCK_BYTES / stride) & !(GROUP - 1)).min(BLOCK_ELEMENTS);
    let mut deltas = vec![0; BLOCK_ELEMENTS * stride];
    while decoded.len() < count * stride {
        let elements = block.min(count - decoded.len() / stride);
        read_block(&mut reader, version, (elements, stride), &mut deltas)?;
        for element in 0..elements {
            for (channel, mode) in channels.iter().enumerate() {
                // A channel is four bytes, whose deltas are stored in planes.
                let delta = [0, 1, 2, 3]
                    .map(|byte| deltas[(4 * channel + byte) * BLOCK_ELEMENTS + element]);
                let bytes = &mut last[4 * channel..4 * channel + 4];
                let next = step(*mode, [bytes[0], bytes[1], bytes[2], bytes[3]], delta);
                bytes.copy_from_slice(&next);
            }
            decoded.extend_from_slice(&last);
        }
    }
    // All bytes before the tail must be consumed.
    if reader.bytes.is_empty() {
        Ok(decoded)
    } else {
        Err("there is extra data at the end")
    }
}

fn read_channels(bytes: &[u8]) -> Result<Vec<ByteChannel>, MeshoptError> {
    let channel = |byte: &u8| match byte & 3 {
        0 => Ok(ByteChannel::Bytes),
        1 => Ok(ByteChannel::Shorts),
        2 => Ok(ByteChannel::Xor(u32::from(byte >> 4))),
        _ => Err("a channel has an unknown mode"),
    };
    bytes.iter().map(channel).collect()
}

/// Four bytes of an element from those of the element before.
fn step(channel: ByteChannel, last: [u8; 4], delta: [u8; 4]) -> [u8; 4] {
    match channel {
        ByteChannel::Bytes => {
            let mut next = last;
            for (byte, delta) in next.iter_mut().zip(delta) {
                *byte = byte.wrapping_add(unzigzag(u32::from(delta)).to_le_bytes()[0]);
            }
            next
        }
        ByteChannel::Shorts => {
            let short = |at: usize| {
                let delta = unzigzag(u32::from(u16::from_le_bytes([delta[at], delta[at + 1]])))
                    .to_le_bytes();
                let last = u16::from_le_bytes([last[at], last[at + 1]]);
                last.wrapping_add(u16::from_le_bytes([delta[0], delta[1]]))
                    .to_le_bytes()
            };
            let ([a, b], [c, d]) = (short(0), short(2));
            [a, b, c, d]
        }
        ByteChannel::Xor(rotation) => (u32::from_le_bytes(last)
            ^ u32::from_le_bytes(delta).rotate_right(rotation))
        .to_le_bytes(),
    }
}

/// Reads the differences of one block: for each byte of an element its own row of
/// [`BLOCK_ELEMENTS`].
fn read_block(
    reader: &mut MeshoptReader<'_>,
    version: u8,
    (elements, stride): (usize, usize),
    deltas: &mut [u8],
) -> Result<(), MeshoptError> {
    let controls = if version == 0 {
        &[][..]
    } else {
        reader.take(stride / 4)?
    };
    for (byte, row) in deltas.chunks_exact_mut(BLOCK_ELEMENTS).enumerate() {
        let control = controls
            .get(byte / 4)
            .map(|bits| bits >> (2 * (byte % 4)) & 3);
        match control {
            None => read_row(reader, [0, 2, 4, 8], elements, row)?,
            Some(0) => read_row(reader, [0, 1, 2, 4], elements, row)?,
            Some(1) => read_row(reader, [1, 2, 4, 8], elements, row)?,
            Some(2) => row.fill(0),
            Some(_) => row[..elements].copy_from_slice(reader.take(elements)?),
        }
    }
    Ok(())
}

/// Reads one row: two bits a group that choose among the widths, then the groups.
fn read_row(
    reader: &mut MeshoptReader<'_>,
    widths: [usize; 4],
    elements: usize,
    row: &mut [u8],
) -> Result<(), MeshoptError> {
    let groups = elements.div_ceil(GROUP);
    let header = reader.take(groups.div_ceil(4))?;
    for (group, deltas) in row.chunks_exact_mut(GROUP).take(groups).enumerate() {
        let choice = header[group / 4] >> (2 * (group % 4)) & 3;
        read_group(reader, widths[usize::from(choice)], deltas)?;
    }
    Ok(())
}

/// Reads 16 differences of the given number of bits; all bits set means that a byte after the group
/// follows.
fn read_group(
    reader: &mut MeshoptReader<'_>,
    width: usize,
    deltas: &mut [u8],
) -> Result<(), MeshoptError> {
    match width {
        0 => deltas.fill(0),
        8 => deltas.copy_from_slice(reader.take(GROUP)?),
        width => {
            let packed = reader.take(GROUP * width / 8)?;
            let sentinel = (1_u8 << width) - 1;
            for (at, delta) in deltas.iter_mut().enumerate() {
                let bit = at * width;
                // Single bits run from the least significant on, wider ones from the most.
                let shift = if width == 1 {
                    bit % 8
                } else {
                    8 - width - bit % 8
                };
                let value = packed[bit / 8] >> shift & sentinel;
                *delta = if value == sentinel {
                    reader.byte()?
                } else {
                    value
                };
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_group_of_the_specification_is_read_as_it_says() {
        let bytes = [0x17, 0x5f, 0xf0, 0xbc, 0x77, 0xa9, 0x21, 0x00, 0x34, 0xb5];
        let (mut deltas, mut reader) = ([0; GROUP], MeshoptReader { bytes: &bytes });
        read_group(&mut reader, 4, &mut deltas).unwrap();
        let signed = deltas.map(|delta| unzigzag(u32::from(delta)).to_le_bytes()[0].cast_signed());
        assert_eq!(
            signed,
            [-1, -4, -3, 26, -91, 0, -6, 6, -4, -4, 5, -5, 1, -1, 0, 0]
        );
    }

    #[test]
    fn what_is_cut_off_is_an_error() {
        let sound = [&[0xa0][..], &[0; 4], &[7; 4], &[0; 28]].concat();
        let tail = [&[0xa0][..], &[0; 4], &[0; 28], &[7, 8, 9, 10]].concat();
        assert_eq!(decode(&tail, 2, 4), Ok(vec![7, 8, 9, 10, 7, 8, 9, 10]));
        for length in 0..sound.len() {
            assert!(decode(&sound[..length], 2, 4).is_err(), "{length} bytes");
        }
    }
}
