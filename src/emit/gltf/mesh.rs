//! Writes meshes and nodes: accessors once per mesh of the scene, a glTF mesh per mesh and
//! material, a node per surface.

use super::document::{self, Accessor, Attributes, GltfIndex, Node, Primitive};
use super::writer::{GltfWriter, extras, single};
use rtc_diag::codes;
use rtc_ir::{EntityField, EntityKind, Instance, Mesh, MeshId, Shape, ValuePath, VertexColumn};
use rtc_math::{Vec3, cross, to_u32, unit};
use rtc_source::Resource;
use std::collections::BTreeMap;

/// The accessors of a mesh.
#[derive(Clone, Copy)]
pub(super) struct MeshAccessors {
    of_vertices: Attributes,
    triangles: GltfIndex<Accessor>,
}

/// Lengths that count as 1, so that numbers stay unchanged; the tolerance of the glTF validator is
/// 0.006.
const UNIT: std::ops::RangeInclusive<f64> = 0.999..=1.001;

impl GltfWriter<'_> {
    /// Writes a surface as a node with a mesh; `None` if that is impossible.
    pub(super) fn surface(&mut self, index: usize) -> Option<()> {
        let scene = self.scene;
        let surface = &scene.surfaces[index];
        let Shape::Instance(Instance {
            mesh,
            world_from_object,
        }) = &surface.shape
        else {
            unreachable!("all shapes have become meshes");
        };
        let path = ValuePath::new(EntityKind::Surface, index, EntityField::Whole);
        if scene.meshes[mesh.0 as usize].triangles.is_empty() {
            return Some(());
        }
        let material = self.material(surface.material, *mesh);
        let mesh = self.mesh(*mesh, material, path)?;
        let mut rtc_extras = serde_json::Map::new();
        if surface.casts_no_shadow {
            rtc_extras.insert("castsNoShadow".to_owned(), true.into());
            self.reporter
                .in_extras("that a surface casts no shadow", path);
        }
        if surface.velocity.get() != [0.0; 3] {
            rtc_extras.insert(
                "velocity".to_owned(),
                surface.velocity.get().to_vec().into(),
            );
            self.reporter.in_extras("the velocity of a surface", path);
        }
        let name = scene.names.get(index).filter(|name| !name.is_empty());
        let node = Node {
            mesh: Some(mesh),
            name: name.cloned(),
            extras: extras(rtc_extras),
            ..Node::default()
        };
        self.node(node, *world_from_object);
        Some(())
    }

    /// The glTF mesh with this material.
    fn mesh(
        &mut self,
        id: MeshId,
        material: GltfIndex<document::Material>,
        path: ValuePath,
    ) -> Option<GltfIndex<document::Mesh>> {
        let key = (id.0, material.value());
        if let Some(known) = self.meshes.get(&key) {
            return Some(*known);
        }
        let MeshAccessors {
            of_vertices: attributes,
            triangles,
        } = self.attributes(id, path)?;
        let primitive = Primitive {
            attributes,
            indices: triangles,
            material,
        };
        let name = &self.scene.meshes[id.0 as usize].name;
        let mesh = document::Mesh {
            name: Some(name.clone()).filter(|name| !name.is_empty()),
            primitives: [primitive],
        };
        let mesh = GltfIndex::push(&mut self.root.meshes, mesh);
        self.meshes.insert(key, mesh);
        Some(mesh)
    }

    /// The accessors of a mesh of the scene.
    fn attributes(&mut self, id: MeshId, path: ValuePath) -> Option<MeshAccessors> {
        // Each mesh is written once, and charged before.
        if let Some(known) = self.attributes.get(&id.0) {
            return Some(*known);
        }
        let mesh = &self.scene.meshes[id.0 as usize];
        self.charge(mesh, path)?;
        let Mesh {
            name: _,
            part: _,
            positions,
            normals,
            uvs,
            second_uvs,
            tangents,
            colors,
            triangles,
        } = mesh;
        // Positions and normals.
        let corners = self.rounded(positions, path)?;
        let mut of_vertices = Attributes {
            position: Some(self.floats(&corners, true)),
            ..Attributes::default()
        };
        if !normals.is_empty() {
            let normals = self.directions(normals, &corners, triangles, path)?;
            of_vertices.normal = Some(self.floats(&normals, false));
        }
        // Texture coordinates.
        for (uvs, attribute) in [
            (uvs, &mut of_vertices.texcoord_0),
            (second_uvs, &mut of_vertices.texcoord_1),
        ] {
            if !uvs.is_empty() {
                let uvs = self.rounded(uvs, path)?;
                *attribute = Some(self.floats(&uvs, false));
            }
        }
        // Tangents and colours.
        if !tangents.is_empty() && !normals.is_empty() {
            let tangents = self.tangents(tangents, normals, path)?;
            of_vertices.tangent = Some(self.floats(&tangents, false));
        }
        if !colors.is_empty() {
            let mut colors = self.rounded(colors, path)?;
            // glTF 2.0, section 3.7.2.1: the components of COLOR_0 are from 0 to 1.
            if colors.iter().flatten().any(|channel| *channel > 1.0) {
                let message = "vertex colours above 1 are written as 1";
                self.reporter.report(&codes::GLTF_UNSAID, message, path);
                for channel in colors.iter_mut().flatten() {
                    *channel = channel.min(1.0);
                }
            }
            of_vertices.color_0 = Some(self.floats(&colors, false));
        }
        // Indices.
        let made = MeshAccessors {
            of_vertices,
            triangles: self.indices(triangles, positions.len()),
        };
        self.attributes.insert(id.0, made);
        Some(made)
    }

    /// Charges the bytes of a mesh; `None` if they exceed the budget, which is reported.
    fn charge(&mut self, mesh: &Mesh, path: ValuePath) -> Option<()> {
        let numbers = 3 * (mesh.positions.len() + mesh.normals.len() + mesh.triangles.len())
            + 2 * (mesh.uvs.len() + mesh.second_uvs.len())
            + 4 * (mesh.tangents.len() + mesh.colors.len());
        let charged = self.budget.charge(Resource::Memory, 4 * numbers as u64);
        if let Err(error) = &charged {
            let message = format!("the mesh takes too much as glTF: {error}");
            self.reporter
                .report_error(&codes::OVER_LIMIT, &message, path);
        }
        charged.ok()
    }

    /// A column as f32; `None` if a value is out of range, which is reported.
    fn rounded<const N: usize>(
        &mut self,
        column: &VertexColumn<N>,
        path: ValuePath,
    ) -> Option<Vec<[f32; N]>> {
        let vectors: Vec<[f32; N]> = match column {
            VertexColumn::Single(vectors) => vectors.to_vec(),
            VertexColumn::Double(vectors) => {
                vectors.iter().map(|vector| vector.map(single)).collect()
            }
        };
        if let VertexColumn::Double(exact) = column {
            if !vectors.iter().flatten().all(|number| number.is_finite()) {
                let message = "a mesh reaches beyond the range of the 32-bit floats of glTF";
                self.reporter
                    .report_error(&codes::GLTF_UNSAID, message, path);
                return None;
            }
            let is_exact =
                |(rounded, exact): (&f32, &f64)| f64::from(*rounded).to_bits() == exact.to_bits();
            if !vectors
                .iter()
                .flatten()
                .zip(exact.iter().flatten())
                .all(is_exact)
            {
                let message = "the vertices of a mesh are rounded to the 32-bit floats of glTF";
                self.reporter
                    .report(&codes::GLTF_APPROXIMATED, message, path);
            }
        }
        Some(vectors)
    }

    /// Tangents normalised to length 1 and handedness ±1, as glTF requires; valid ones keep their
    /// bits. A tangent without direction becomes one perpendicular to its normal.
    fn tangents(
        &mut self,
        tangents: &VertexColumn<4>,
        normals: &VertexColumn<3>,
        path: ValuePath,
    ) -> Option<Vec<[f32; 4]>> {
        let mut rounded = self.rounded(tangents, path)?;
        for (at, tangent) in rounded.iter_mut().enumerate() {
            let [x, y, z, side] = tangents.at(at);
            let vector = Vec3::new(x, y, z);
            if !UNIT.contains(&vector.length()) {
                let across = || Vec3::from_array(normals.at(at)).any_orthogonal_vector();
                let vector = unit(vector).or_else(|| unit(across()));
                let [x, y, z] = vector.unwrap_or(Vec3::X).to_array().map(single);
                *tangent = [x, y, z, tangent[3]];
            }
            tangent[3] = if side < 0.0 { -1.0 } else { 1.0 };
        }
        Some(rounded)
    }

    /// Normals of length 1, as glTF requires; valid ones keep their bits. A normal without
    /// direction becomes that of a triangle at the vertex.
    fn directions(
        &mut self,
        normals: &VertexColumn<3>,
        corners: &[[f32; 3]],
        triangles: &[[u32; 3]],
        path: ValuePath,
    ) -> Option<Vec<[f32; 3]>> {
        // Normalise the normals that have a direction.
        let mut rounded = self.rounded(normals, path)?;
        let corner = |at: u32| Vec3::from_array(corners[at as usize].map(f64::from));
        let mut without_direction: BTreeMap<u32, Vec3> = BTreeMap::new();
        for (at, normal) in rounded.iter_mut().enumerate() {
            let vector = Vec3::from_array(normals.at(at));
            if UNIT.contains(&vector.length()) {
                continue;
            }
            match unit(vector) {
                Some(vector) => *normal = vector.to_array().map(single),
                None => {
                    without_direction.insert(to_u32(at), Vec3::Z);
                }
            }
        }
        // Replace the others by the normal of a triangle at the vertex.
        let needed = if without_direction.is_empty() {
            &[]
        } else {
            triangles
        };
        for [a, b, c] in needed {
            let front = unit(cross(corner(*b) - corner(*a), corner(*c) - corner(*a)));
            for vertex in [a, b, c] {
                if let (Some(vector), Some(front)) = (without_direction.get_mut(vertex), front) {
                    *vector = front;
                }
            }
        }
        for (at, normal) in without_direction {
            rounded[at as usize] = normal.to_array().map(single);
        }
        Some(rounded)
    }
}
