//! The meshes: triangles that share corners.

use arbitrary::Arbitrary;
use rtc_math::{Column, Shared};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The index of a mesh in [`super::Scene::meshes`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(transparent)]
pub struct MeshId(pub u32);

/// Triangles over one list of corners, in object coordinates.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Mesh {
    /// What its file was called, as the scene names it; empty if it has no name.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub name: String,
    /// The material of its file whose triangles it holds, by its name there, empty for those that have
    /// none; absent if it holds all of the file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub part: Option<String>,
    /// Where the corners are.
    pub positions: Column<3>,
    /// The shading normal at each corner, of any length; empty for flat shading.
    #[serde(default, skip_serializing_if = "Column::is_empty")]
    pub normals: Column<3>,
    /// The texture coordinates at each corner; empty if there are none.
    #[serde(default, skip_serializing_if = "Column::is_empty")]
    pub uvs: Column<2>,
    /// The second set of texture coordinates; empty if there is none.
    #[serde(default, skip_serializing_if = "Column::is_empty")]
    pub second_uvs: Column<2>,
    /// The direction of growing u at each corner, and ±1 for that of growing v: `w·(normal ×
    /// tangent)`; empty if none.
    #[serde(default, skip_serializing_if = "Column::is_empty")]
    pub tangents: Column<4>,
    /// The colour at each corner, linear, with alpha: it multiplies that of the material; empty if
    /// none.
    #[serde(default, skip_serializing_if = "Column::is_empty")]
    pub colors: Column<4>,
    /// The corners of each triangle; its normal is (v1 − v0) × (v2 − v0).
    pub triangles: Shared<[u32; 3]>,
}

impl Mesh {
    /// Whether all numbers of the vertices are finite.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        fn all<const N: usize>(column: &Column<N>) -> bool {
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
