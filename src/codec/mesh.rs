//! Meshes in a container: each column is a section, copied directly from and to the scene.

use super::columns::SectionReader;
use super::section::{ElementType, Section, SectionContent, SectionWriter};
use rtc_ir::{Mesh, VertexColumn};
use serde::{Deserialize, Serialize};

/// A mesh with the section index of each column; absent for an empty column.
#[derive(Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct StoredMesh {
    #[serde(default, skip_serializing_if = "String::is_empty")]
    name: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    part: Option<String>,
    positions: Option<usize>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    normals: Option<usize>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    uvs: Option<usize>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    second_uvs: Option<usize>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    tangents: Option<usize>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    colors: Option<usize>,
    triangles: usize,
}

/// Puts the columns of a mesh into sections.
pub(super) fn store<'s>(mesh: &'s Mesh, body: &mut SectionWriter<'s>) -> StoredMesh {
    let Mesh {
        name,
        part,
        positions,
        normals,
        uvs,
        second_uvs,
        tangents,
        colors,
        triangles,
    } = mesh;
    StoredMesh {
        name: name.clone(),
        part: part.clone(),
        positions: put(positions, body),
        normals: put(normals, body),
        uvs: put(uvs, body),
        second_uvs: put(second_uvs, body),
        tangents: put(tangents, body),
        colors: put(colors, body),
        triangles: body.push(
            ElementType::U32,
            3,
            SectionContent::U32(triangles.as_flattened()),
        ),
    }
}

fn put<'s, const N: usize>(
    column: &'s VertexColumn<N>,
    body: &mut SectionWriter<'s>,
) -> Option<usize> {
    match column {
        _ if column.is_empty() => None,
        VertexColumn::Single(vectors) => Some(body.push(
            ElementType::F32,
            N,
            SectionContent::F32(vectors.as_flattened()),
        )),
        VertexColumn::Double(vectors) => Some(body.push(
            ElementType::F64,
            N,
            SectionContent::F64(vectors.as_flattened()),
        )),
    }
}

impl StoredMesh {
    /// The mesh; `None` if a section is missing, of another type, or was taken before.
    pub(super) fn load(&self, reader: &mut SectionReader<'_>) -> Option<Mesh> {
        let triangles = reader.take(self.triangles)?;
        Some(Mesh {
            name: self.name.clone(),
            part: self.part.clone(),
            positions: column(self.positions, reader)?,
            normals: column(self.normals, reader)?,
            uvs: column(self.uvs, reader)?,
            second_uvs: column(self.second_uvs, reader)?,
            tangents: column(self.tangents, reader)?,
            colors: column(self.colors, reader)?,
            triangles: triangles
                .vectors(ElementType::U32, u32::from_le_bytes)?
                .into(),
        })
    }
}

fn column<const N: usize>(
    section: Option<usize>,
    reader: &mut SectionReader<'_>,
) -> Option<VertexColumn<N>> {
    let Some(section) = section else {
        return Some(VertexColumn::default());
    };
    let section: &Section<'_> = reader.take(section)?;
    let single = || {
        section
            .vectors(ElementType::F32, f32::from_le_bytes)
            .map(VertexColumn::from)
    };
    single().or_else(|| {
        section
            .vectors(ElementType::F64, f64::from_le_bytes)
            .map(VertexColumn::from)
    })
}
