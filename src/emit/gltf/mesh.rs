//! Meshes and where they stand: attributes once for each mesh of the scene, a mesh of glTF for each
//! material that it has, a node for each surface.

use super::document::{self, Accessor, Attributes, Index, Node, Primitive};
use super::writer::{GltfWriter, extras, single};
use rtc_diag::codes;
use rtc_ir::{Column, EntityKind, Field, Instance, Mesh, MeshId, Shape, ValuePath};
use rtc_math::{Vec3, cross, unit};
use rtc_source::Resource;
use std::collections::BTreeMap;

/// The accessors of a mesh.
#[derive(Clone, Copy)]
pub(super) struct MeshAccessors {
    of_vertices: Attributes,
    triangles: Index<Accessor>,
}

/// Lengths that count as 1, so that the numbers stay as they are; that of glTF is 0.006.
const UNIT: std::ops::RangeInclusive<f64> = 0.999..=1.001;

impl GltfWriter<'_> {
    /// Writes a surface of the scene as a node with a mesh; `None` if that is not possible.
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
        let place = ValuePath::new(EntityKind::Surface, index, Field::Whole);
        if scene.meshes[mesh.0 as usize].triangles.is_empty() {
            return Some(());
        }
        let material = self.material(surface.material, *mesh);
        let mesh = self.mesh(*mesh, material, place)?;
        let mut own = serde_json::Map::new();
        if surface.casts_no_shadow {
            own.insert("castsNoShadow".to_owned(), true.into());
            self.told.own_words("that a surface casts no shadow", place);
        }
        let name = scene.names.get(index).filter(|name| !name.is_empty());
        let node = Node {
            mesh: Some(mesh),
            name: name.cloned(),
            extras: extras(own),
            ..Node::default()
        };
        self.node(node, *world_from_object);
        Some(())
    }

    /// The mesh of glTF with this material.
    fn mesh(
        &mut self,
        id: MeshId,
        material: Index<document::Material>,
        place: ValuePath,
    ) -> Option<Index<document::Mesh>> {
        let key = (id.0, material.value());
        if let Some(known) = self.meshes.get(&key) {
            return Some(*known);
        }
        let MeshAccessors {
            of_vertices: attributes,
            triangles,
        } = self.attributes(id, place)?;
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
        let mesh = Index::push(&mut self.root.meshes, mesh);
        self.meshes.insert(key, mesh);
        Some(mesh)
    }

    /// The accessors of a mesh of the scene.
    fn attributes(&mut self, id: MeshId, place: ValuePath) -> Option<MeshAccessors> {
        if let Some(known) = self.attributes.get(&id.0) {
            return Some(*known);
        }
        let mesh = &self.scene.meshes[id.0 as usize];
        self.charge(mesh, place)?;
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
        let corners = self.rounded(positions, place)?;
        let mut of_vertices = Attributes {
            position: Some(self.floats(&corners, true)),
            ..Attributes::default()
        };
        if !normals.is_empty() {
            let normals = self.directions(normals, &corners, triangles, place)?;
            of_vertices.normal = Some(self.floats(&normals, false));
        }
        for (uvs, attribute) in [
            (uvs, &mut of_vertices.texcoord_0),
            (second_uvs, &mut of_vertices.texcoord_1),
        ] {
            if !uvs.is_empty() {
                let uvs = self.rounded(uvs, place)?;
                *attribute = Some(self.floats(&uvs, false));
            }
        }
        if !tangents.is_empty() && !normals.is_empty() {
            let tangents = self.tangents(tangents, normals, place)?;
            of_vertices.tangent = Some(self.floats(&tangents, false));
        }
        if !colors.is_empty() {
            let colors = self.rounded(colors, place)?;
            of_vertices.color_0 = Some(self.floats(&colors, false));
        }
        let made = MeshAccessors {
            of_vertices,
            triangles: self.indices(triangles, positions.len()),
        };
        self.attributes.insert(id.0, made);
        Some(made)
    }

    /// Charges the bytes of a mesh; `None` if that is too much, which is told.
    fn charge(&mut self, mesh: &Mesh, place: ValuePath) -> Option<()> {
        let numbers = 3 * (mesh.positions.len() + mesh.normals.len() + mesh.triangles.len())
            + 2 * (mesh.uvs.len() + mesh.second_uvs.len())
            + 4 * (mesh.tangents.len() + mesh.colors.len());
        let charged = self.budget.charge(Resource::Memory, 4 * numbers as u64);
        if let Err(fault) = &charged {
            let message = format!("the mesh takes too much as glTF: {fault}");
            self.told.refuse(&codes::OVER_LIMIT, &message, place);
        }
        charged.ok()
    }

    /// A column in 32-bit floats; `None` if they don't reach so far.
    fn rounded<const N: usize>(
        &mut self,
        column: &Column<N>,
        place: ValuePath,
    ) -> Option<Vec<[f32; N]>> {
        let vectors: Vec<[f32; N]> = match column {
            Column::Single(vectors) => vectors.to_vec(),
            Column::Double(vectors) => vectors.iter().map(|own| own.map(single)).collect(),
        };
        if let Column::Double(exact) = column {
            if !vectors.iter().flatten().all(|number| number.is_finite()) {
                let message = "a mesh reaches beyond the range of the 32-bit floats of glTF";
                self.told.refuse(&codes::GLTF_UNSAID, message, place);
                return None;
            }
            let is_exact =
                |(own, exact): (&f32, &f64)| f64::from(*own).to_bits() == exact.to_bits();
            if !vectors
                .iter()
                .flatten()
                .zip(exact.iter().flatten())
                .all(is_exact)
            {
                let message = "the vertices of a mesh are rounded to the 32-bit floats of glTF";
                self.told.tell(&codes::GLTF_NEARLY, message, place);
            }
        }
        Some(vectors)
    }

    /// Tangents of length 1 with a side of ±1, as glTF wants them; those that are so keep their
    /// bits. One without a direction takes one across its normal.
    fn tangents(
        &mut self,
        tangents: &Column<4>,
        normals: &Column<3>,
        place: ValuePath,
    ) -> Option<Vec<[f32; 4]>> {
        let mut rounded = self.rounded(tangents, place)?;
        for (at, tangent) in rounded.iter_mut().enumerate() {
            let [x, y, z, side] = tangents.at(at);
            let own = Vec3::new(x, y, z);
            if !UNIT.contains(&own.length()) {
                let across = || Vec3::from_array(normals.at(at)).any_orthogonal_vector();
                let own = unit(own).or_else(|| unit(across()));
                let [x, y, z] = own.unwrap_or(Vec3::X).to_array().map(single);
                *tangent = [x, y, z, tangent[3]];
            }
            tangent[3] = if side < 0.0 { -1.0 } else { 1.0 };
        }
        Some(rounded)
    }

    /// Normals of length 1, as glTF wants them; those that have it keep their bits. One without a
    /// direction takes that of a triangle at it.
    fn directions(
        &mut self,
        normals: &Column<3>,
        corners: &[[f32; 3]],
        triangles: &[[u32; 3]],
        place: ValuePath,
    ) -> Option<Vec<[f32; 3]>> {
        let mut rounded = self.rounded(normals, place)?;
        let corner = |at: u32| Vec3::from_array(corners[at as usize].map(f64::from));
        let mut lost: BTreeMap<u32, Vec3> = BTreeMap::new();
        for (at, normal) in rounded.iter_mut().enumerate() {
            let own = Vec3::from_array(normals.at(at));
            if UNIT.contains(&own.length()) {
                continue;
            }
            match unit(own) {
                Some(own) => *normal = own.to_array().map(single),
                None => {
                    lost.insert(u32::try_from(at).unwrap_or(u32::MAX), Vec3::Z);
                }
            }
        }
        let needed = if lost.is_empty() { &[] } else { triangles };
        for [a, b, c] in needed {
            let front = unit(cross(corner(*b) - corner(*a), corner(*c) - corner(*a)));
            for vertex in [a, b, c] {
                if let (Some(own), Some(front)) = (lost.get_mut(vertex), front) {
                    *own = front;
                }
            }
        }
        for (at, normal) in lost {
            rounded[at as usize] = normal.to_array().map(single);
        }
        Some(rounded)
    }
}
