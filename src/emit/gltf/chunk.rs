//! Buffer views and accessors in the single buffer.

use super::document::{
    ARRAY_BUFFER, Accessor, BufferView, ELEMENT_ARRAY_BUFFER, FLOAT, Index, UNSIGNED_INT,
    UNSIGNED_SHORT,
};
use super::writer::GltfWriter;
use rtc_ir::Image;

impl GltfWriter<'_> {
    /// Adds bytes as a buffer view, padded to a multiple of 4 bytes.
    pub(super) fn view(&mut self, bytes: &[u8], target: Option<u32>) -> Index<BufferView> {
        let offset = self.bin.len();
        self.bin.extend_from_slice(bytes);
        self.bin.resize(self.bin.len().next_multiple_of(4), 0);
        let view = BufferView {
            buffer: 0,
            byte_length: bytes.len(),
            byte_offset: offset,
            target,
        };
        Index::push(&mut self.root.buffer_views, view)
    }

    /// Adds float vectors, one per vertex. Positions need their minimum and maximum.
    pub(super) fn floats<const N: usize>(
        &mut self,
        vectors: &[[f32; N]],
        needs_extent: bool,
    ) -> Index<Accessor> {
        let bytes: Vec<u8> = vectors
            .iter()
            .flatten()
            .flat_map(|number| number.to_le_bytes())
            .collect();
        let view = self.view(&bytes, Some(ARRAY_BUFFER));
        let kind = match N {
            2 => "VEC2",
            3 => "VEC3",
            _ => "VEC4",
        };
        let [min, max] = match needs_extent {
            true => extent(vectors).map(Some),
            false => [None, None],
        };
        let accessor = Accessor {
            min,
            max,
            ..accessor(view, vectors.len(), FLOAT, kind)
        };
        Index::push(&mut self.root.accessors, accessor)
    }

    /// Adds the pixels of a float image, in rows from the top.
    pub(super) fn pixels(&mut self, image: &Image) -> Index<Accessor> {
        let view = self.view(&image.pixels, None);
        let count = image.pixels.len() / image.kind.bytes();
        let accessor = Accessor {
            name: Some(image.name.clone()).filter(|name| !name.is_empty()),
            ..accessor(view, count, FLOAT, "VEC3")
        };
        Index::push(&mut self.root.accessors, accessor)
    }

    /// Adds the vertex indices of triangles, in the smallest type that fits `vertices`.
    pub(super) fn indices(&mut self, triangles: &[[u32; 3]], vertices: usize) -> Index<Accessor> {
        let corners = triangles.iter().flatten();
        // The largest value of a type is the primitive restart index (glTF 2.0, section 3.7.2.1).
        let short: Option<Vec<u8>> = (vertices <= usize::from(u16::MAX)).then(|| {
            let indices = corners
                .clone()
                .filter_map(|corner| u16::try_from(*corner).ok());
            indices.flat_map(u16::to_le_bytes).collect()
        });
        let (bytes, component) = match short {
            Some(bytes) => (bytes, UNSIGNED_SHORT),
            None => (
                corners.flat_map(|corner| corner.to_le_bytes()).collect(),
                UNSIGNED_INT,
            ),
        };
        let view = self.view(&bytes, Some(ELEMENT_ARRAY_BUFFER));
        let accessor = accessor(view, 3 * triangles.len(), component, "SCALAR");
        Index::push(&mut self.root.accessors, accessor)
    }
}

fn accessor(
    buffer_view: Index<BufferView>,
    count: usize,
    component_type: u32,
    kind: &'static str,
) -> Accessor {
    Accessor {
        buffer_view,
        count,
        component_type,
        kind,
        min: None,
        max: None,
        name: None,
    }
}

/// The minimum and maximum of each component.
fn extent<const N: usize>(vectors: &[[f32; N]]) -> [Vec<f64>; 2] {
    let mut extent = [[f32::INFINITY; N], [f32::NEG_INFINITY; N]];
    for vector in vectors {
        for (at, number) in vector.iter().enumerate() {
            extent[0][at] = extent[0][at].min(*number);
            extent[1][at] = extent[1][at].max(*number);
        }
    }
    extent.map(|bound| bound.map(f64::from).to_vec())
}
