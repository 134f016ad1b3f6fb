//! A closed mesh to aim at: the icosphere, its triangles placed one by one or as an instance.

use super::random::Random;
use super::scenes::{prepare, scene, triangle, world};
use rtc::internals::ir;
use rtc::internals::math::Vec3;
use rtc::internals::render::World;

/// A closed mesh: vertices and triangles.
pub(crate) struct Mesh {
    pub(crate) vertices: Vec<Vec3>,
    pub(crate) triangles: Vec<[usize; 3]>,
}

impl Mesh {
    /// The icosahedron, each triangle split in four `level` times, on the unit sphere, rounded to
    /// f32.
    pub(crate) fn icosphere(level: u32) -> Self {
        let g = (1.0 + 5.0_f64.sqrt()) / 2.0;
        let corner = |k: usize| {
            let (a, b) = ([-1.0, 1.0][k & 1], [-g, g][k >> 1 & 1]);
            [
                Vec3::new(a, b, 0.0),
                Vec3::new(0.0, a, b),
                Vec3::new(b, 0.0, a),
            ][k >> 2]
        };
        let vertices = (0..12).map(|k| corner(k).normalize()).collect::<Vec<_>>();
        let near = |i: usize, j: usize| vertices[i].distance(vertices[j]) < 1.2;
        let mut triangles = Vec::new();
        for (i, j, k) in
            (0..12).flat_map(|i| (i..12).flat_map(move |j| (j..12).map(move |k| (i, j, k))))
        {
            if i < j && j < k && near(i, j) && near(j, k) && near(i, k) {
                triangles.push([i, j, k]);
            }
        }
        let mut mesh = Self {
            vertices,
            triangles,
        };
        for _ in 0..level {
            mesh.split();
        }
        for vertex in &mut mesh.vertices {
            *vertex = vertex.normalize().as_vec3().as_dvec3();
        }
        mesh
    }

    fn split(&mut self) {
        let mut middles = std::collections::BTreeMap::new();
        let mut triangles = Vec::new();
        for [a, b, c] in std::mem::take(&mut self.triangles) {
            let mut middle = |i: usize, j: usize| {
                *middles.entry((i.min(j), i.max(j))).or_insert_with(|| {
                    self.vertices
                        .push(((self.vertices[i] + self.vertices[j]) / 2.0).normalize());
                    self.vertices.len() - 1
                })
            };
            let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
            triangles.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
        }
        self.triangles = triangles;
    }

    /// The icosphere of level 3 with its radii stretched by up to `push`, scaled and moved.
    pub(crate) fn displaced(scale: f64, push: f64, offset: Vec3) -> Self {
        let mut mesh = Self::icosphere(3);
        let mut random = Random::new(777);
        for vertex in &mut mesh.vertices {
            *vertex = *vertex * (scale * (1.0 + push * random.uniform())) + offset;
        }
        mesh
    }

    /// The world of its triangles, one by one.
    pub(crate) fn world(&self) -> World {
        let corners = |t: &[usize; 3]| t.map(|k| self.vertices[k].to_array());
        world(self.triangles.iter().map(|t| triangle(corners(t))))
    }

    /// The world of one instance of it.
    pub(crate) fn placed(&self, world_from_object: [Vec3; 4]) -> World {
        let map = world_from_object.map(|column| column.to_array());
        let mut scene = scene([ir::Shape::Instance(ir::Instance {
            mesh: ir::MeshId(0),
            world_from_object: map,
        })]);
        let index = |k: usize| u32::try_from(k).unwrap();
        scene.meshes.push(ir::Mesh {
            positions: self
                .vertices
                .iter()
                .map(|vertex| vertex.to_array())
                .collect(),
            triangles: self.triangles.iter().map(|t| t.map(index)).collect(),
            ..ir::Mesh::default()
        });
        prepare(&scene)
    }
}
