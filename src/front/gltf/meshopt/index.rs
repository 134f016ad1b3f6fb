//! Modes 1 and 2: triangles by the edges and corners they share with those before, and indices by
//! their differences.

use super::{MeshoptError, MeshoptReader, unzigzag};

/// Entries of each queue, and bytes of the table at the end of triangles.
const QUEUE: usize = 16;

/// The newest entries, the newest first.
struct RecentEntries<T> {
    entries: [T; QUEUE],
    newest: usize,
}

impl<T: Copy + Default> RecentEntries<T> {
    fn new() -> Self {
        Self {
            entries: [T::default(); QUEUE],
            newest: 0,
        }
    }

    fn push(&mut self, entry: T) {
        self.newest = (self.newest + QUEUE - 1) % QUEUE;
        self.entries[self.newest] = entry;
    }

    fn get(&self, age: u8) -> T {
        self.entries[(self.newest + usize::from(age)) % QUEUE]
    }
}

/// What decoding triangles remembers.
struct TriangleDecoder<'a> {
    data: MeshoptReader<'a>,
    edges: RecentEntries<[u32; 2]>,
    corners: RecentEntries<u32>,
    /// The index expected of a corner that was never seen.
    next: u32,
    /// The index that was last written out.
    last: u32,
}

/// Decodes `count` indices of triangles.
pub(super) fn triangles(bytes: &[u8], count: usize) -> Result<Vec<u32>, MeshoptError> {
    let inside = bytes
        .strip_prefix(&[0xe1])
        .ok_or("the first byte does not mark triangles")?;
    let end = inside
        .len()
        .checked_sub(QUEUE)
        .ok_or("the data ends too early")?;
    let (inside, table) = inside.split_at(end);
    if !count.is_multiple_of(3) {
        return Err("the number of indices is not a multiple of 3");
    }
    let (codes, data) = inside
        .split_at_checked(count / 3)
        .ok_or("the data ends too early")?;
    let data = MeshoptReader { bytes: data };
    let mut state = TriangleDecoder {
        data,
        edges: RecentEntries::new(),
        corners: RecentEntries::new(),
        next: 0,
        last: 0,
    };
    let mut indices = Vec::with_capacity(count);
    for code in codes {
        indices.extend(state.triangle(*code, table)?);
    }
    if state.data.bytes.is_empty() {
        Ok(indices)
    } else {
        Err("there is extra data at the end")
    }
}

impl TriangleDecoder<'_> {
    fn triangle(&mut self, code: u8, table: &[u8]) -> Result<[u32; 3], MeshoptError> {
        let (high, low) = (code >> 4, code & 15);
        // The triangle shares a recent edge and adds one corner.
        if high < 15 {
            let [a, b] = self.edges.get(high);
            let c = self.on_edge(low)?;
            self.edges.push([c, b]);
            self.edges.push([a, c]);
            return Ok([a, b, c]);
        }
        // Otherwise it has three corners of its own; a table or a byte tells how they are coded.
        let pair = if low < 14 {
            table[usize::from(low)]
        } else {
            self.data.byte()?
        };
        if low >= 14 && pair == 0 {
            self.next = 0;
        }
        let (z, w) = (pair >> 4, pair & 15);
        if low < 14 && (z == 15 || w == 15) {
            return Err("the table of triangles is damaged");
        }
        // Each corner is the next new vertex, a recent one, or an explicit delta.
        let a = self.corner(if low == 15 { 15 } else { 0 })?;
        let b = self.corner(z)?;
        let c = self.corner(w)?;
        self.corners.push(a);
        for (corner, kind) in [(b, z), (c, w)] {
            if kind == 0 || kind == 15 {
                self.corners.push(corner);
            }
        }
        // Its edges become the most recent ones.
        for edge in [[b, a], [c, b], [a, c]] {
            self.edges.push(edge);
        }
        Ok([a, b, c])
    }

    /// The third corner of a triangle on a known edge.
    fn on_edge(&mut self, low: u8) -> Result<u32, MeshoptError> {
        let corner = match low {
            0 => self.corner(0)?,
            1..=12 => return Ok(self.corners.get(low)),
            13 => self.explicit(u32::MAX),
            14 => self.explicit(1),
            _ => self.corner(15)?,
        };
        self.corners.push(corner);
        Ok(corner)
    }

    /// A corner never seen (0), written out (15), or one of those seen last.
    fn corner(&mut self, kind: u8) -> Result<u32, MeshoptError> {
        match kind {
            0 => {
                self.next = self.next.wrapping_add(1);
                Ok(self.next.wrapping_sub(1))
            }
            15 => {
                let delta = unzigzag(self.data.number()?);
                Ok(self.explicit(delta))
            }
            age => Ok(self.corners.get(age - 1)),
        }
    }

    fn explicit(&mut self, delta: u32) -> u32 {
        self.last = self.last.wrapping_add(delta);
        self.last
    }
}

/// Decodes `count` indices without triangles; the lowest bit says from which of two baselines each
/// differs.
pub(super) fn sequence(bytes: &[u8], count: usize) -> Result<Vec<u32>, MeshoptError> {
    const TAIL: usize = 4;
    let inside = bytes
        .strip_prefix(&[0xd1])
        .ok_or("the first byte does not mark indices")?;
    let end = inside
        .len()
        .checked_sub(TAIL)
        .ok_or("the data ends too early")?;
    let mut reader = MeshoptReader {
        bytes: &inside[..end],
    };
    let mut last = [0_u32; 2];
    let mut indices = Vec::with_capacity(count);
    for _ in 0..count {
        let number = reader.number()?;
        let baseline = &mut last[(number & 1) as usize];
        *baseline = baseline.wrapping_add(unzigzag(number >> 1));
        indices.push(*baseline);
    }
    if reader.bytes.is_empty() {
        Ok(indices)
    } else {
        Err("there is extra data at the end")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_triangles_that_share_an_edge() {
        // The first has three new corners, by the first entry of the table; the second is on its
        // newest edge (a, c).
        let bytes = [&[0xe1, 0xf0, 0x00][..], &[0; QUEUE]].concat();
        assert_eq!(triangles(&bytes, 6), Ok(vec![0, 1, 2, 0, 2, 3]));
        assert!(triangles(&bytes[..10], 6).is_err() && triangles(&bytes, 9).is_err());
    }

    #[test]
    fn indices_differ_from_one_of_two_baselines() {
        // +1 from the first, +2 from the second, −1 from the first.
        let bytes = [0xd1, 0b100, 0b1001, 0b010, 0, 0, 0, 0];
        assert_eq!(sequence(&bytes, 3), Ok(vec![1, 2, 0]));
    }
}
