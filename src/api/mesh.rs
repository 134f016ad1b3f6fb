//! Meshes of scenes that are built in code.

use rtc_ir as ir;
use rtc_math::VertexColumn;

/// Triangles over one list of vertices, from slices of 32-bit or 64-bit floats. All copies share
/// the vertices.
///
/// ```
/// use rtc::{Camera, Mesh, Phong, SceneBuilder, Shape, Transform};
///
/// let positions = [[0.0_f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
/// let mesh = Mesh::new(&positions, &[[0, 1, 2]]).normals(&[[0.0_f32, 0.0, 1.0]; 3]);
/// let mut builder = SceneBuilder::new(Camera::look_at([0.3, 0.3, 5.0], [0.3, 0.3, 0.0]));
/// let mesh = builder.mesh(mesh);
/// builder.add(Shape::instance(mesh, Transform::new()), Phong::default());
/// let scene = builder.build().unwrap();
/// assert_eq!(scene.tree().unwrap().bounds(), Some([[0.0; 3], [1.0, 1.0, 0.0]]));
/// ```
#[derive(Clone, Debug, PartialEq)]
#[must_use = "a mesh is not seen before it is part of a scene"]
pub struct Mesh(pub(super) ir::Mesh);

impl Mesh {
    /// The positions of vertices, and three indices for each triangle, counterclockwise as seen
    /// from outside.
    pub fn new<'a>(positions: impl Into<Vertices<'a, 3>>, triangles: &[[u32; 3]]) -> Self {
        Self(ir::Mesh {
            positions: positions.into().column(),
            triangles: triangles.to_vec().into(),
            ..ir::Mesh::default()
        })
    }

    /// The shading normal at each vertex, of any length; without them shading is flat.
    pub fn normals<'a>(mut self, normals: impl Into<Vertices<'a, 3>>) -> Self {
        self.0.normals = normals.into().column();
        self
    }

    /// The texture coordinates at each vertex.
    pub fn uvs<'a>(mut self, uvs: impl Into<Vertices<'a, 2>>) -> Self {
        self.0.uvs = uvs.into().column();
        self
    }

    /// The second set of texture coordinates.
    pub fn second_uvs<'a>(mut self, uvs: impl Into<Vertices<'a, 2>>) -> Self {
        self.0.second_uvs = uvs.into().column();
        self
    }

    /// The tangent at each vertex, and ±1 for the side of the bitangent.
    pub fn tangents<'a>(mut self, tangents: impl Into<Vertices<'a, 4>>) -> Self {
        self.0.tangents = tangents.into().column();
        self
    }

    /// The linear colour and alpha at each vertex, which multiply those of the material.
    pub fn colors<'a>(mut self, colors: impl Into<Vertices<'a, 4>>) -> Self {
        self.0.colors = colors.into().column();
        self
    }
}

/// `N` numbers for each vertex of a [`Mesh`]: a slice of 32-bit or 64-bit floats.
///
/// ```
/// use rtc::Mesh;
///
/// let triangles = [[0, 1, 2]];
/// let single = Mesh::new(&[[0.0_f32; 3]; 3], &triangles);
/// let double = Mesh::new(&vec![[0.0_f64; 3]; 3], &triangles);
/// assert_ne!(single, double, "the precision is kept");
/// ```
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub enum Vertices<'a, const N: usize> {
    /// 32-bit floats.
    Single(&'a [[f32; N]]),
    /// 64-bit floats.
    Double(&'a [[f64; N]]),
}

impl<const N: usize> Vertices<'_, N> {
    fn column(self) -> VertexColumn<N> {
        match self {
            Self::Single(vertices) => vertices.to_vec().into(),
            Self::Double(vertices) => vertices.to_vec().into(),
        }
    }
}

/// A type of float that vertices may have.
pub trait VertexFloat: Sized {
    /// Vertices of this type.
    fn vertices<const N: usize>(vertices: &[[Self; N]]) -> Vertices<'_, N>;
}

impl VertexFloat for f32 {
    fn vertices<const N: usize>(vertices: &[[Self; N]]) -> Vertices<'_, N> {
        Vertices::Single(vertices)
    }
}

impl VertexFloat for f64 {
    fn vertices<const N: usize>(vertices: &[[Self; N]]) -> Vertices<'_, N> {
        Vertices::Double(vertices)
    }
}

impl<'a, F: VertexFloat, const N: usize> From<&'a [[F; N]]> for Vertices<'a, N> {
    fn from(vertices: &'a [[F; N]]) -> Self {
        F::vertices(vertices)
    }
}

impl<'a, F: VertexFloat, const N: usize, const M: usize> From<&'a [[F; N]; M]> for Vertices<'a, N> {
    fn from(vertices: &'a [[F; N]; M]) -> Self {
        F::vertices(vertices)
    }
}

impl<'a, F: VertexFloat, const N: usize> From<&'a Vec<[F; N]>> for Vertices<'a, N> {
    fn from(vertices: &'a Vec<[F; N]>) -> Self {
        F::vertices(vertices)
    }
}
