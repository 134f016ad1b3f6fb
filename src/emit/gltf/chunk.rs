//! The one buffer: buffer views and accessors, each written once.

use super::writer::GltfWriter;
use crate::ir::Image;
use gltf::json;
use json::accessor::{ComponentType, GenericComponentType, Type};
use json::buffer::Target;
use json::validation::{Checked, USize64};
use json::{Accessor, Index};

/// The least and greatest values of each component.
type Extent<const N: usize> = [[f32; N]; 2];

impl GltfWriter<'_> {
    /// Adds bytes as a buffer view, whose length is filled up to whole words.
    pub(super) fn view(
        &mut self,
        bytes: &[u8],
        target: Option<Target>,
    ) -> Index<json::buffer::View> {
        let offset = self.bin.len();
        self.bin.extend_from_slice(bytes);
        self.bin.resize(self.bin.len().next_multiple_of(4), 0);
        self.root.push(json::buffer::View {
            buffer: Index::new(0),
            byte_length: USize64::from(bytes.len()),
            byte_offset: Some(USize64::from(offset)),
            byte_stride: None,
            name: None,
            target: target.map(Checked::Valid),
            extensions: None,
            extras: None,
        })
    }

    /// Adds vectors of floats, one a vertex. Positions need their extent.
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
        let view = self.view(&bytes, Some(Target::ArrayBuffer));
        let type_ = match N {
            2 => Type::Vec2,
            3 => Type::Vec3,
            _ => Type::Vec4,
        };
        let extent = needs_extent.then(|| extent(vectors));
        let bound = |at: usize| extent.map(|extent| json::Value::from(extent[at].to_vec()));
        let accessor = Accessor {
            min: bound(0),
            max: bound(1),
            ..accessor(view, vectors.len(), ComponentType::F32, type_)
        };
        self.root.push(accessor)
    }

    /// Adds the pixels of an image of floats, in rows from the top.
    pub(super) fn pixels(&mut self, image: &Image) -> Index<Accessor> {
        let view = self.view(&image.pixels, None);
        let count = image.pixels.len() / image.kind.bytes();
        let accessor = Accessor {
            name: Some(image.name.clone()).filter(|name| !name.is_empty()),
            ..accessor(view, count, ComponentType::F32, Type::Vec3)
        };
        self.root.push(accessor)
    }

    /// Adds the corners of triangles, in the smallest type that counts so many vertices.
    pub(super) fn indices(&mut self, triangles: &[[u32; 3]], vertices: usize) -> Index<Accessor> {
        let corners = triangles.iter().flatten();
        // The greatest number of a type restarts a strip (glTF 2.0, section 3.7.2.1).
        let short: Option<Vec<u8>> = (vertices <= usize::from(u16::MAX)).then(|| {
            let words = corners
                .clone()
                .filter_map(|corner| u16::try_from(*corner).ok());
            words.flat_map(u16::to_le_bytes).collect()
        });
        let (bytes, component) = match short {
            Some(bytes) => (bytes, ComponentType::U16),
            None => (
                corners.flat_map(|corner| corner.to_le_bytes()).collect(),
                ComponentType::U32,
            ),
        };
        let view = self.view(&bytes, Some(Target::ElementArrayBuffer));
        let count = 3 * triangles.len();
        self.root
            .push(accessor(view, count, component, Type::Scalar))
    }
}

fn accessor(
    view: Index<json::buffer::View>,
    count: usize,
    component: ComponentType,
    type_: Type,
) -> Accessor {
    Accessor {
        buffer_view: Some(view),
        byte_offset: None,
        count: USize64::from(count),
        component_type: Checked::Valid(GenericComponentType(component)),
        extensions: None,
        extras: None,
        type_: Checked::Valid(type_),
        min: None,
        max: None,
        name: None,
        normalized: false,
        sparse: None,
    }
}

fn extent<const N: usize>(vectors: &[[f32; N]]) -> Extent<N> {
    let mut extent = [[f32::INFINITY; N], [f32::NEG_INFINITY; N]];
    for vector in vectors {
        for (at, number) in vector.iter().enumerate() {
            extent[0][at] = extent[0][at].min(*number);
            extent[1][at] = extent[1][at].max(*number);
        }
    }
    extent
}
