//! Mitsuba's binary mesh files (`.serialized`, versions 3 and 4): several meshes, each compressed
//! by zlib (RFC 1950), and a table of their offsets at the end.

use super::MeshReadError;
use flate2::read::ZlibDecoder;
use rtc_ir::{Mesh, VertexColumn};
use rtc_source::{Budget, FileKind, Resource};
use std::io::Read;

/// Such files.
pub(super) const KIND: FileKind = FileKind {
    extensions: &["serialized"],
    begins: |head| head.starts_with(&MAGIC),
};

/// The largest file, in bytes.
pub(super) const MAX_BYTES: u64 = 1 << 30;

/// The first bytes of each mesh: the format, before the version.
const MAGIC: [u8; 2] = [0x1c, 0x04];

/// The longest name of a mesh, in bytes.
const MAX_NAME: usize = 4096;

/// The flags of a mesh.
const HAS_NORMALS: u32 = 0x1;
const HAS_UVS: u32 = 0x2;
const HAS_COLORS: u32 = 0x8;
const IS_DOUBLE: u32 = 0x2000;

/// The mesh with this index, from 0. Its memory is charged before it is taken.
pub(super) fn read(bytes: &[u8], index: u32, budget: &Budget) -> Result<Mesh, MeshReadError> {
    // Find the mesh in the file.
    let (start, end) = range(bytes, index)?;
    let bytes = bytes
        .get(start..end)
        .ok_or(MeshReadError::damaged("its table of offsets is damaged"))?;
    if !bytes.starts_with(&MAGIC) {
        return Err(MeshReadError::damaged(
            "a mesh does not begin with the bytes 1c 04",
        ));
    }
    // Read the header; the rest is compressed.
    let version = match bytes.get(2..4) {
        Some(&[version @ (3 | 4), 0]) => version,
        _ => return Err(MeshReadError::damaged("its version is neither 3 nor 4")),
    };
    let mut stream = SerializedStream(ZlibDecoder::new(&bytes[4..]));
    let flags = stream.u32()?;
    if version == 4 {
        stream.skip_name()?;
    }
    // Charge the memory before it is taken.
    let (vertices, triangles) = (stream.u64()?, stream.u64()?);
    let columns = [(HAS_NORMALS, 3), (HAS_UVS, 2), (HAS_COLORS, 3)];
    let given = columns.into_iter().filter(|(flag, _)| flags & flag != 0);
    let numbers = 3 + given.map(|(_, size)| size).sum::<u64>();
    budget.charge(Resource::Vertices, vertices)?;
    let memory = vertices.saturating_mul(8 * numbers);
    budget.charge(
        Resource::Memory,
        memory.saturating_add(triangles.saturating_mul(12)),
    )?;
    // Read the attributes that the flags declare.
    let is_double = flags & IS_DOUBLE != 0;
    let positions = stream.column::<3>(vertices, is_double)?;
    let normals = match flags & HAS_NORMALS {
        0 => Vec::new(),
        _ => stream.column::<3>(vertices, is_double)?,
    };
    let uvs = match flags & HAS_UVS {
        0 => Vec::new(),
        _ => stream.column::<2>(vertices, is_double)?,
    };
    if flags & HAS_COLORS != 0 {
        stream.column::<3>(vertices, is_double)?;
    }
    // Read the triangles.
    let mut corners = Vec::new();
    for _ in 0..triangles {
        let mut corner = || match vertices > u64::from(u32::MAX) {
            true => stream
                .u64()
                .map(|index| u32::try_from(index).unwrap_or(u32::MAX)),
            false => stream.u32(),
        };
        let triangle = [corner()?, corner()?, corner()?];
        if triangle.iter().any(|index| u64::from(*index) >= vertices) {
            return Err(MeshReadError::damaged(
                "a triangle has a vertex that does not exist",
            ));
        }
        corners.push(triangle);
    }
    Ok(Mesh {
        positions: VertexColumn::rounded(positions),
        normals: VertexColumn::rounded(normals),
        uvs: VertexColumn::rounded(uvs),
        triangles: corners.into(),
        ..Mesh::default()
    })
}

/// The bytes of a mesh, by the table at the end of the file: an offset for each mesh, of 8 bytes in
/// version 4 and of 4 in version 3, and their count.
fn range(bytes: &[u8], index: u32) -> Result<(usize, usize), MeshReadError> {
    let damaged = MeshReadError::damaged("its table of offsets is damaged");
    let is_wide = bytes.get(2) == Some(&4);
    let width = if is_wide { 8 } else { 4 };
    let Some(table_end) = bytes.len().checked_sub(4) else {
        return Err(damaged);
    };
    let count = le(&bytes[table_end..]);
    if u64::from(index) >= count {
        return Err(MeshReadError::damaged(
            "it has no mesh with this `shape_index`",
        ));
    }
    let table = usize::try_from(count)
        .ok()
        .and_then(|count| count.checked_mul(width))
        .and_then(|length| table_end.checked_sub(length));
    let Some(table) = table else {
        return Err(damaged);
    };
    let offset = |index: usize| {
        let at = table + index * width;
        usize::try_from(le(&bytes[at..at + width])).unwrap_or(usize::MAX)
    };
    let index = index as usize;
    let end = if (index as u64) + 1 < count {
        offset(index + 1)
    } else {
        table
    };
    Ok((offset(index), end))
}

/// A little-endian number.
fn le(bytes: &[u8]) -> u64 {
    let digits = bytes.iter().rev();
    digits.fold(0, |number, byte| number << 8 | u64::from(*byte))
}

/// The decompressed bytes of a mesh.
struct SerializedStream<'a>(ZlibDecoder<&'a [u8]>);

impl SerializedStream<'_> {
    fn bytes<const N: usize>(&mut self) -> Result<[u8; N], MeshReadError> {
        let mut bytes = [0; N];
        self.0.read_exact(&mut bytes)?;
        Ok(bytes)
    }

    fn u32(&mut self) -> Result<u32, MeshReadError> {
        self.bytes().map(u32::from_le_bytes)
    }

    fn u64(&mut self) -> Result<u64, MeshReadError> {
        self.bytes().map(u64::from_le_bytes)
    }

    /// A name ends with a byte 0.
    fn skip_name(&mut self) -> Result<(), MeshReadError> {
        for _ in 0..=MAX_NAME {
            if self.bytes::<1>()? == [0] {
                return Ok(());
            }
        }
        Err(MeshReadError::damaged("the name of a mesh has no end"))
    }

    /// One vector for each vertex.
    fn column<const N: usize>(
        &mut self,
        vertices: u64,
        is_double: bool,
    ) -> Result<Vec<[f64; N]>, MeshReadError> {
        let mut vectors = Vec::new();
        for _ in 0..vertices {
            let mut vector = [0.0; N];
            for number in &mut vector {
                *number = match is_double {
                    true => f64::from_le_bytes(self.bytes()?),
                    false => f64::from(f32::from_le_bytes(self.bytes()?)),
                };
            }
            vectors.push(vector);
        }
        Ok(vectors)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use flate2::Compression;
    use flate2::write::ZlibEncoder;
    use std::io::Write as _;

    /// A file of two triangles in the plane z = 0, the second one shifted.
    fn file() -> Vec<u8> {
        let (mut file, mut offsets) = (Vec::new(), Vec::new());
        for shift in [0.0_f32, 5.0] {
            offsets.push(file.len() as u64);
            file.extend([0x1c, 0x04, 4, 0]);
            let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
            let mut put = |bytes: &[u8]| encoder.write_all(bytes).unwrap();
            put(&0x1000_u32.to_le_bytes());
            put(b"part\0");
            put(&3_u64.to_le_bytes());
            put(&1_u64.to_le_bytes());
            for number in [shift, 0.0, 0.0, shift + 1.0, 0.0, 0.0, shift, 1.0, 0.0] {
                put(&number.to_le_bytes());
            }
            for index in [0_u32, 1, 2] {
                put(&index.to_le_bytes());
            }
            file.extend(encoder.finish().unwrap());
        }
        for offset in &offsets {
            file.extend(offset.to_le_bytes());
        }
        file.extend(2_u32.to_le_bytes());
        file
    }

    #[test]
    fn each_mesh_of_a_file_is_read() {
        let file = file();
        let mesh = |index| read(&file, index, &Budget::default());
        let second = mesh(1).ok().unwrap();
        assert_eq!(second.positions.at(1), [6.0, 0.0, 0.0]);
        assert_eq!(second.triangles[..], [[0, 1, 2]]);
        assert!(mesh(2).is_err());
    }

    #[test]
    fn a_name_without_an_end_is_not_unpacked() {
        let mut encoder = ZlibEncoder::new(Vec::new(), Compression::best());
        encoder.write_all(&0x1000_u32.to_le_bytes()).unwrap();
        encoder.write_all(&vec![b'a'; 1 << 20]).unwrap();
        let mut file = vec![0x1c, 0x04, 4, 0];
        file.extend(encoder.finish().unwrap());
        let mut stream = SerializedStream(ZlibDecoder::new(&file[4..]));
        stream.u32().ok().unwrap();
        assert!(stream.skip_name().is_err());
        assert!(stream.0.total_out() < 5000, "{}", stream.0.total_out());
    }

    #[test]
    fn no_damaged_file_is_read_and_none_panics() {
        let file = file();
        for length in 0..file.len() {
            let cut = &file[..length];
            let _ = read(cut, 0, &Budget::default());
            let mut changed = file.clone();
            changed[length] ^= 0x55;
            let _ = read(&changed, 1, &Budget::default());
        }
        assert!(read(&file[..40], 0, &Budget::default()).is_err());
    }
}
