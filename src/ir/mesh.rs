//! Triangle meshes with shared vertices.

use arbitrary::Arbitrary;
use rtc_math::{SharedList, VertexColumn};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The index of a mesh in [`super::Scene::meshes`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(transparent)]
pub struct MeshId(pub u32);

/// Triangles over one list of vertices, in object coordinates.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Mesh {
    /// The name of its file as the scene writes it; empty if there is none.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub name: String,
    /// The name of the material in its file whose triangles this mesh holds, empty for triangles
    /// without a material; absent if the mesh holds the whole file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub part: Option<String>,
    /// The position of each vertex.
    pub positions: VertexColumn<3>,
    /// The shading normal at each vertex, of any length; empty for flat shading.
    #[serde(default, skip_serializing_if = "VertexColumn::is_empty")]
    pub normals: VertexColumn<3>,
    /// The texture coordinates at each vertex; empty if there are none.
    #[serde(default, skip_serializing_if = "VertexColumn::is_empty")]
    pub uvs: VertexColumn<2>,
    /// The second set of texture coordinates; empty if there is none.
    #[serde(default, skip_serializing_if = "VertexColumn::is_empty")]
    pub second_uvs: VertexColumn<2>,
    /// The tangent at each vertex (the direction of increasing u), and ±1 for the bitangent
    /// `w·(normal × tangent)`; empty if there are none.
    #[serde(default, skip_serializing_if = "VertexColumn::is_empty")]
    pub tangents: VertexColumn<4>,
    /// The linear RGBA colour at each vertex, which multiplies that of the material; empty if there
    /// are none.
    #[serde(default, skip_serializing_if = "VertexColumn::is_empty")]
    pub colors: VertexColumn<4>,
    /// The vertex indices of each triangle; its normal is (v1 − v0) × (v2 − v0).
    pub triangles: SharedList<[u32; 3]>,
}

impl Mesh {
    /// Whether all numbers of all vertices are finite.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        fn all<const N: usize>(column: &VertexColumn<N>) -> bool {
            column.iter().flatten().all(f64::is_finite)
        }
        let Self {
            name: _,
            part: _,
            positions,
            normals,
            uvs,
            second_uvs,
            tangents,
            colors,
            triangles: _,
        } = self;
        all(positions)
            && all(normals)
            && all(uvs)
            && all(second_uvs)
            && all(tangents)
            && all(colors)
    }
}
