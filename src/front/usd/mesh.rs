//! Meshes (`UsdGeomMesh`): faces become triangles, the parts of each material a mesh of their own.
//!
//! Meshes are shared by all prims of the same layers, so that instances cost no more than a place.
//! Of a subdivision surface the control mesh is shown, with smooth normals.

use super::attribute::Primvar;
use super::shape::{SolidGeometry, StageShape, VERTEX};
use super::stage::ComposedPrim;
use super::{Lowering, PrimState};
use crate::mesh::EarClipper;
use rtc_diag::{clip, clip_path, codes};
use rtc_ir::{Mesh, MeshId, VertexColumn};
use rtc_math::{Vec3, to_u32};
use rtc_source::Resource;
use std::collections::{BTreeMap, BTreeSet};

/// What distinguishes meshes: their layers, the part, the texture coordinates, and the primvar of
/// the colours of the vertices.
pub(super) type PartMeshKey = (Vec<(usize, u32)>, usize, [String; 2], Option<String>);

/// The faces of a mesh, and what belongs to its points.
struct MeshFaces {
    points: Vec<Vec3>,
    /// Where the corners of each face begin, and where the last one ends.
    starts: Vec<usize>,
    corners: Vec<usize>,
    is_left_handed: bool,
    holes: BTreeSet<usize>,
}

/// Some faces with one material.
struct MeshPart {
    faces: Option<Vec<usize>>,
    state: PrimState,
}

/// To which place of a primvar a corner belongs.
#[derive(Clone, Copy, PartialEq)]
enum PrimvarIndices {
    Constant,
    Face,
    Point,
    Corner,
}

impl Lowering<'_> {
    pub(super) fn mesh(&mut self, prim: &ComposedPrim, state: &PrimState) {
        if !state.is_shown {
            return;
        }
        // Split the mesh by the materials of its subsets.
        let span = self.span_of(prim);
        let is_double_sided = self.flag(prim, "doubleSided").unwrap_or(false);
        let parts = self.parts(prim, state);
        // Colours that vary are stored in the mesh, constant ones in the material.
        let opacity = self.primvar(prim, "primvars:displayOpacity", 1);
        let varies = |primvar: Option<&Primvar>| {
            primvar.is_some_and(|primvar| primvar.interpolation != "constant")
        };
        let mut read_colors = BTreeMap::new();
        let mut faces: Option<Option<MeshFaces>> = None;
        for (index, part) in parts.into_iter().enumerate() {
            let lowered = self.bound_material(&part.state);
            let color_name = lowered.shown_color.as_ref().map(|(name, _)| name.clone());
            let color = color_name.as_ref().and_then(|name| {
                let read = read_colors.entry(name.clone());
                read.or_insert_with(|| self.primvar(prim, name, 3)).as_ref()
            });
            let color_name = color_name.filter(|_| varies(color) || varies(opacity.as_ref()));
            let shows_colors = color_name.is_some();
            // Instances of a prim share the meshes.
            let key = (prim.key(), index, lowered.uv_names.clone(), color_name);
            let mesh = match self.meshes.get(&key) {
                Some(known) => *known,
                None => {
                    let faces = faces.get_or_insert_with(|| self.faces(prim));
                    let colors = [color, opacity.as_ref()].map(|one| one.filter(|_| shows_colors));
                    let mesh = faces.as_ref().and_then(|faces| {
                        self.part_mesh(
                            prim,
                            faces,
                            part.faces.as_deref(),
                            &lowered.uv_names,
                            colors,
                        )
                    });
                    self.meshes.insert(key, mesh);
                    mesh
                }
            };
            // Add the part with its material.
            let is_constant = !shows_colors;
            let Some(mesh) = mesh else { continue };
            let is_clear = opacity.is_some() && shows_colors;
            let material = self.material_id(
                &lowered,
                &part.state,
                is_double_sided,
                is_constant && !is_clear,
                span,
            );
            let Some(material) = material else { return };
            let (geometry, to_world) = (SolidGeometry::Mesh(mesh), state.to_world);
            self.add(StageShape {
                geometry,
                to_world,
                material,
                span,
            });
        }
    }

    /// The faces of each material: those of subsets, and the rest.
    fn parts(&mut self, prim: &ComposedPrim, state: &PrimState) -> Vec<MeshPart> {
        let (mut parts, mut taken) = (Vec::new(), BTreeSet::new());
        // Each face belongs to the first subset with a material that has it.
        for name in self.child_names(prim) {
            let Some(subset) = self.child(prim, &name) else {
                continue;
            };
            if self.type_name(&subset) != "GeomSubset" || !self.is_defined(&subset) {
                continue;
            }
            let bound = self.binding(&subset, "material:binding");
            // A binding of the mesh may be stronger than those of its subsets.
            let is_open = state.material.as_ref().is_none_or(|above| !above.is_strong);
            let is_face = self
                .text(&subset, "elementType")
                .is_none_or(|kind| kind == "face");
            let (Some(bound), true) = (bound, is_face && is_open) else {
                continue;
            };
            let mut faces = self.indices(&subset, "indices").unwrap_or_default();
            faces.retain(|face| taken.insert(*face));
            let state = PrimState {
                material: Some(bound),
                ..state.clone()
            };
            parts.push(MeshPart {
                faces: Some(faces),
                state,
            });
        }
        // The other faces have the material of the prim.
        if parts.is_empty() {
            return vec![MeshPart {
                faces: None,
                state: state.clone(),
            }];
        }
        let count = self
            .indices(prim, "faceVertexCounts")
            .map_or(0, |counts| counts.len());
        let rest: Vec<usize> = (0..count).filter(|face| !taken.contains(face)).collect();
        if !rest.is_empty() {
            parts.push(MeshPart {
                faces: Some(rest),
                state: state.clone(),
            });
        }
        parts
    }

    /// The faces of a mesh; `None` if they are not sound, which is reported.
    fn faces(&mut self, prim: &ComposedPrim) -> Option<MeshFaces> {
        // Read the points and the vertex lists of the faces.
        let numbers = self.numbers(prim, "points").unwrap_or_default();
        let counts = self.indices(prim, "faceVertexCounts").unwrap_or_default();
        let corners = self.indices(prim, "faceVertexIndices").unwrap_or_default();
        let points = numbers
            .as_chunks::<3>()
            .0
            .iter()
            .map(|point| Vec3::from_array(*point));
        let points: Vec<Vec3> = points.collect();
        // Sum the counts to find where each face starts.
        let mut starts = vec![0];
        let mut end = 0_usize;
        for count in &counts {
            end = end.saturating_add(*count);
            starts.push(end);
        }
        // Check that indices and counts agree.
        let wrong = match () {
            () if points.is_empty() || counts.is_empty() => Some("has no faces"),
            () if end != corners.len() => Some("has more or fewer corners than its faces"),
            () if corners.iter().any(|corner| *corner >= points.len()) => {
                Some("has a corner that is none of its points")
            }
            () if !points.iter().all(|point| point.is_finite()) => {
                Some("has a point that is no place")
            }
            () => None,
        };
        if let Some(wrong) = wrong {
            let message = format!(
                "the mesh `{}` {wrong}: it is left out",
                clip_path(&prim.path)
            );
            let span = self.span_of(prim);
            self.report(&codes::USD_UNSUPPORTED, span, message);
            return None;
        }
        // Read the orientation and the holes.
        let is_left_handed = self.text(prim, "orientation").as_deref() == Some("leftHanded");
        let holes = self
            .indices(prim, "holeIndices")
            .unwrap_or_default()
            .into_iter()
            .collect();
        Some(MeshFaces {
            points,
            starts,
            corners,
            is_left_handed,
            holes,
        })
    }

    /// The mesh of a part.
    fn part_mesh(
        &mut self,
        prim: &ComposedPrim,
        faces: &MeshFaces,
        chosen: Option<&[usize]>,
        uv_names: &[String; 2],
        colors: [Option<&Primvar>; 2],
    ) -> Option<MeshId> {
        // Subdivision surfaces show their control mesh.
        let span = self.span_of(prim);
        let scheme = self.text(prim, "subdivisionScheme");
        let scheme = scheme.unwrap_or_else(|| "catmullClark".to_owned());
        if scheme != "none" {
            let scheme = clip(&scheme);
            let message = format!(
                "the control mesh is shown, with smooth normals: `{scheme}` is not subdivided"
            );
            self.approximate(prim, &message);
        }
        // Read the primvars of the vertices.
        let normals = self.primvar(prim, "primvars:normals", 3);
        let normals = normals.or_else(|| self.primvar(prim, "normals", 3));
        let uvs = uv_names.each_ref().map(|name| match name.as_str() {
            "" => None,
            name => self.primvar(prim, &format!("primvars:{name}"), 2),
        });
        let mut column = |primvar, width| self.column(prim, faces, primvar, width);
        let columns = MeshColumns {
            normals: column(normals.as_ref(), 3),
            uvs: [column(uvs[0].as_ref(), 2), column(uvs[1].as_ref(), 2)],
            color: column(colors[0], 3),
            opacity: column(colors[1], 1),
        };
        // Charge the corners before they are built.
        let count = faces.starts.len() - 1;
        let chosen: Vec<usize> = match chosen {
            Some(chosen) => chosen
                .iter()
                .copied()
                .filter(|face| *face < count)
                .collect(),
            None => (0..count).collect(),
        };
        let sizes = chosen
            .iter()
            .map(|face| faces.starts[face + 1] - faces.starts[*face]);
        let corners = sizes.sum::<usize>() as u64;
        self.charge(Resource::Vertices, corners, span)?;
        let most = corners.max(faces.points.len() as u64);
        self.charge(Resource::Memory, VERTEX * most, span)?;
        // Triangulate the faces.
        let cut = cut(faces, &chosen, columns.are_apart());
        let is_smooth = scheme != "none" && columns.normals.is_none();
        // Build the mesh, with smooth normals if it has none.
        let (mut mesh, vertices) = columns.mesh(faces, cut);
        if is_smooth {
            mesh.normals = smooth_normals(faces, &vertices);
        }
        prim.name().clone_into(&mut mesh.name);
        if mesh.triangles.is_empty() || !mesh.is_finite() {
            return None;
        }
        self.charged_mesh(mesh, span)
    }

    /// Values with their places. Of another number than there are places they count for none.
    fn column<'p>(
        &mut self,
        prim: &ComposedPrim,
        faces: &MeshFaces,
        primvar: Option<&'p Primvar>,
        width: usize,
    ) -> Option<IndexedValues<'p>> {
        let primvar = primvar?;
        let (places, expected) = match primvar.interpolation.as_str() {
            "constant" => (PrimvarIndices::Constant, 1),
            "uniform" => (PrimvarIndices::Face, faces.starts.len() - 1),
            "vertex" | "varying" => (PrimvarIndices::Point, faces.points.len()),
            _ => (PrimvarIndices::Corner, faces.corners.len()),
        };
        let count = primvar.len(width);
        if count >= expected {
            return Some(IndexedValues { primvar, places });
        }
        let path = clip_path(&prim.path);
        let message =
            format!("{count} of {expected} places of `{path}` have a value: it is left out");
        self.report(&codes::USD_UNSUPPORTED, primvar.span, message);
        None
    }
}

/// Values and the places that they belong to.
struct IndexedValues<'p> {
    primvar: &'p Primvar,
    places: PrimvarIndices,
}

impl IndexedValues<'_> {
    fn at<const N: usize>(&self, vertex: &SplitVertex) -> [f64; N] {
        self.primvar.at(match self.places {
            PrimvarIndices::Constant => 0,
            PrimvarIndices::Face => vertex.face,
            PrimvarIndices::Point => vertex.point,
            PrimvarIndices::Corner => vertex.corner,
        })
    }
}

/// The values of the vertices of a mesh.
struct MeshColumns<'p> {
    normals: Option<IndexedValues<'p>>,
    uvs: [Option<IndexedValues<'p>>; 2],
    color: Option<IndexedValues<'p>>,
    opacity: Option<IndexedValues<'p>>,
}

impl MeshColumns<'_> {
    /// Whether corners at one point differ.
    fn are_apart(&self) -> bool {
        let [first, second] = &self.uvs;
        let all = [&self.normals, first, second, &self.color, &self.opacity];
        let mut places = all.into_iter().flatten().map(|column| column.places);
        places.any(|places| matches!(places, PrimvarIndices::Face | PrimvarIndices::Corner))
    }

    /// The mesh of triangles with these values, and its vertices.
    fn mesh(&self, faces: &MeshFaces, cut: SplitFaces) -> (Mesh, Vec<SplitVertex>) {
        let SplitFaces {
            vertices,
            triangles,
        } = cut;
        // v runs down.
        let uvs = self.uvs.each_ref().map(|column| match column {
            Some(column) => VertexColumn::rounded(vertices.iter().map(|vertex| {
                let [u, v] = column.at(vertex);
                [u, 1.0 - v]
            })),
            None => VertexColumn::default(),
        });
        let [uvs, second_uvs] = uvs;
        let color = |vertex: &SplitVertex| {
            let color = self.color.as_ref().map(|column| column.at(vertex));
            let [r, g, b] = color.unwrap_or([0.5; 3]);
            let opacity = self.opacity.as_ref().map(|column| column.at(vertex));
            let [opacity] = opacity.unwrap_or([1.0]);
            [r, g, b, opacity].map(|channel: f64| channel.clamp(0.0, 1.0))
        };
        let colors = match self.color.is_some() || self.opacity.is_some() {
            true => VertexColumn::rounded(vertices.iter().map(color)),
            false => VertexColumn::default(),
        };
        let normals = self
            .normals
            .as_ref()
            .map(|column| VertexColumn::rounded(vertices.iter().map(|vertex| column.at(vertex))));
        let position = |vertex: &SplitVertex| faces.points[vertex.point].to_array();
        let mesh = Mesh {
            positions: VertexColumn::rounded(vertices.iter().map(position)),
            normals: normals.unwrap_or_default(),
            uvs,
            second_uvs,
            colors,
            triangles: triangles.into(),
            ..Mesh::default()
        };
        (mesh, vertices)
    }
}

/// A vertex of the mesh that is made.
struct SplitVertex {
    face: usize,
    point: usize,
    corner: usize,
}

struct SplitFaces {
    vertices: Vec<SplitVertex>,
    triangles: Vec<[u32; 3]>,
}

/// The triangles of some faces; each corner is a vertex of its own if they are apart.
fn cut(faces: &MeshFaces, chosen: &[usize], are_apart: bool) -> SplitFaces {
    let mut made = SplitFaces {
        vertices: Vec::new(),
        triangles: Vec::new(),
    };
    let mut known = BTreeMap::new();
    let mut clipper = EarClipper::new(faces.corners.len());
    let mut ring: Vec<u32> = Vec::new();
    for face in chosen {
        // Skip holes and degenerate faces.
        let range = faces.starts[*face]..faces.starts[face + 1];
        if range.len() < 3 || faces.holes.contains(face) {
            continue;
        }
        // Make the vertices of the face; faces share them unless a primvar differs per corner.
        ring.clear();
        for corner in range {
            let point = faces.corners[corner];
            let vertex = SplitVertex {
                face: *face,
                point,
                corner,
            };
            let next = to_u32(made.vertices.len());
            let index = match are_apart {
                true => next,
                false => *known.entry(point).or_insert(next),
            };
            if index == next {
                made.vertices.push(vertex);
            }
            ring.push(index);
        }
        // Clip ears, and reverse the order of a left-handed mesh.
        let position = |at: usize| faces.points[made.vertices[ring[at] as usize].point].to_array();
        let triangles = &mut made.triangles;
        clipper.cut(ring.len(), position, |[a, b, c]| {
            let [a, b, c] = [a, b, c].map(|at| ring[at]);
            triangles.push(if faces.is_left_handed {
                [a, c, b]
            } else {
                [a, b, c]
            });
        });
    }
    made
}

/// The sum of the normals of the faces around each vertex.
fn smooth_normals(faces: &MeshFaces, vertices: &[SplitVertex]) -> VertexColumn<3> {
    let mut normals = vec![Vec3::ZERO; faces.points.len()];
    for face in faces.starts.windows(2) {
        let ring = &faces.corners[face[0]..face[1]];
        let Some(first) = ring.first().map(|corner| faces.points[*corner]) else {
            continue;
        };
        let edges = ring.windows(2).map(|pair| {
            let [a, b] = [pair[0], pair[1]].map(|corner| faces.points[corner] - first);
            a.cross(b)
        });
        let normal: Vec3 = edges.sum();
        for corner in ring {
            normals[*corner] += if faces.is_left_handed {
                -normal
            } else {
                normal
            };
        }
    }
    VertexColumn::rounded(
        vertices
            .iter()
            .map(|vertex| normals[vertex.point].to_array()),
    )
}
