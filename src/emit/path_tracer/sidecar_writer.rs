//! The files beside a scene: meshes as PLY, textures as pictures. Each is written once.

use super::basic_shape::TriangleSoup;
use super::surface_material::{SurfaceMaterial, uv_set};
use super::textured_factor::{TextureChannel, TexturedFactor};
use crate::picture::{ColorCoding, TexturePicture};
use crate::reporter::ExportReporter;
use crate::texture_area::TextureAreas;
use crate::{ply, sidecar};
use rtc_diag::codes;
use rtc_image::EncodeError;
use rtc_ir::{
    EntityField, EntityKind, Filter, Map, Mesh, MeshId, Scene, Standard, ValuePath, VertexColumn,
    Wrap,
};
use rtc_source::Budget;
use std::collections::BTreeMap;
use xxhash_rust::xxh3::xxh3_64;

/// Bytes of a PLY header, and of a triangle.
const HEAD: u64 = 512;
const TRIANGLE: u64 = 13;

/// The files beside a scene, with what their writing reports.
pub(crate) struct SidecarWriter<'w> {
    pub(crate) scene: &'w Scene,
    pub(crate) areas: TextureAreas,
    pub(crate) reporter: ExportReporter<'w>,
    pub(crate) budget: &'w Budget,
    folder: &'w str,
    /// Whether v grows upwards in meshes, against that of the IR.
    is_v_upward: bool,
    /// The bytes of each, by its path from the scene file.
    pub(crate) files: BTreeMap<String, Vec<u8>>,
    /// The file names of the meshes written so far, by what distinguishes them.
    meshes: BTreeMap<MeshFileKey, String>,
    /// The file names of the pictures of textures, by what was made of which.
    bitmaps: BTreeMap<String, String>,
}

/// What distinguishes the file of a mesh.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct MeshFileKey {
    mesh: u32,
    /// The set of texture coordinates that is written, if any.
    set: Option<u32>,
    /// The material whose base colour multiplies the colours that are written, if any.
    colored_for: Option<u32>,
}

/// The picture of a texture, and how it is looked up.
pub(crate) struct BitmapTexture {
    pub(crate) file: String,
    pub(crate) coding: ColorCoding,
    pub(crate) filter: Filter,
    /// What is beyond its edges.
    pub(crate) wrap: Wrap,
    /// The rows of the map to the coordinates of the picture, v downwards, from those of the
    /// surface.
    pub(crate) rows: [[f64; 3]; 2],
}

/// The colour and the opacity of a corner, by those of its mesh.
pub(crate) type CornerColor<'c> = &'c dyn Fn([f64; 4]) -> [f64; 4];

impl<'w> SidecarWriter<'w> {
    pub(crate) fn new(
        scene: &'w Scene,
        reporter: ExportReporter<'w>,
        budget: &'w Budget,
        folder: &'w str,
        is_v_upward: bool,
    ) -> Self {
        Self {
            scene,
            areas: TextureAreas::of(scene),
            reporter,
            budget,
            folder,
            is_v_upward,
            files: BTreeMap::new(),
            meshes: BTreeMap::new(),
            bitmaps: BTreeMap::new(),
        }
    }

    /// Puts a picture beside the scene, by its bytes and extension; returns its name.
    pub(crate) fn picture(
        &mut self,
        source_name: &str,
        encoded: Result<(Vec<u8>, &'static str), EncodeError>,
        path: ValuePath,
    ) -> Option<String> {
        let (bytes, extension) = encoded
            .map_err(|fault| {
                let message = format!("the picture cannot be written: {fault}");
                self.reporter.report_error(&codes::NO_TWIN, &message, path);
            })
            .ok()?;
        Some(self.put(source_name, "picture", bytes, extension))
    }

    fn put(&mut self, name: &str, fallback: &str, bytes: Vec<u8>, extension: &str) -> String {
        let hash = xxh3_64(&bytes);
        let name = sidecar::path(self.folder, name, fallback, hash, extension);
        self.files.insert(name.clone(), bytes);
        name
    }

    /// The bitmap of a channel of a texture, with the factor in its pixels; `None` if it exceeds the
    /// budget, which is reported.
    pub(crate) fn bitmap(
        &mut self,
        map: &Map,
        TexturedFactor {
            factor, channel, ..
        }: TexturedFactor<'_>,
        path: ValuePath,
    ) -> Option<BitmapTexture> {
        // Encode each texture and channel once.
        let picture = TexturePicture::new(self.scene, &self.areas, map.texture);
        let key = format!("{} {channel:?} {factor:?}", map.texture.0);
        let file = match self.bitmaps.get(&key) {
            Some(file) => file.clone(),
            None => {
                if let Some(loss) = picture.loss() {
                    self.reporter.unsupported(loss, path);
                }
                self.reporter.charge(picture.cost(), self.budget, path)?;
                let change = |texel| channel.pixel(factor, texel);
                let encoded = picture.encode(channel.coding(), change);
                self.picture(picture.name(), encoded, path)?
            }
        };
        self.bitmaps.insert(key, file.clone());
        // How it is looked up.
        let [u, v] = picture.wrap;
        if u != v {
            let message = "a texture goes on in two ways beyond its edges: in one in the file";
            self.reporter.unsupported(message, path);
        }
        let is_cut = matches!(
            channel,
            TextureChannel::AlphaCut(_) | TextureChannel::RedCut(_)
        );
        Some(BitmapTexture {
            file,
            coding: channel.coding(),
            filter: if is_cut {
                Filter::Nearest
            } else {
                picture.filter
            },
            wrap: u,
            rows: picture.rows(map),
        })
    }

    /// The file of a mesh, which is written once for each set of texture coordinates and each
    /// colouring of its corners.
    pub(crate) fn mesh(
        &mut self,
        id: MeshId,
        surface_material: SurfaceMaterial,
        material: &Standard,
        corner_color: Option<CornerColor<'_>>,
    ) -> Option<String> {
        // Choose the texture coordinates that the material uses.
        let mesh = &self.scene.meshes[id.0 as usize];
        let set = uv_set(material);
        let uvs = match (material.maps().next(), set) {
            (None, _) => &VertexColumn::default(),
            (Some(_), 0) => &mesh.uvs,
            (Some(_), _) => &mesh.second_uvs,
        };
        // Equal attributes share a file.
        let key = MeshFileKey {
            mesh: id.0,
            set: (!uvs.is_empty()).then_some(set),
            colored_for: corner_color.map(|_| surface_material.material),
        };
        if let Some(name) = self.meshes.get(&key) {
            return Some(name.clone());
        }
        // Write the attributes as PLY.
        let colors = corner_color.map_or_else(Vec::new, |color| {
            let corners = 0..mesh.colors.len();
            corners.map(|at| color(mesh.colors.at(at))).collect()
        });
        let uvs = match self.is_v_upward {
            true => VertexColumn::rounded(uvs.iter().map(|[u, v]| [u, 1.0 - v])),
            false => uvs.clone(),
        };
        let bare = Mesh {
            positions: mesh.positions.clone(),
            normals: mesh.normals.clone(),
            triangles: mesh.triangles.clone(),
            uvs,
            ..Mesh::default()
        };
        let path = ValuePath::new(EntityKind::Mesh, id.0 as usize, EntityField::Whole);
        let name = self.ply(&mesh.name, &bare, colors, path)?;
        self.meshes.insert(key, name.clone());
        Some(name)
    }

    /// The file of the triangles of a material.
    pub(crate) fn triangles(&mut self, soup: TriangleSoup, material: u32) -> Option<String> {
        let path = ValuePath::new(EntityKind::Material, material as usize, EntityField::Whole);
        self.ply("triangles", &soup.mesh(), Vec::new(), path)
    }

    /// Puts a mesh beside the scene; Mitsuba calls values of these names `vertex_color` and
    /// `vertex_opacity`.
    fn ply(
        &mut self,
        of: &str,
        mesh: &Mesh,
        colors: Vec<[f64; 4]>,
        path: ValuePath,
    ) -> Option<String> {
        let colors = VertexColumn::from(colors);
        let columns = mesh.positions.bytes() + mesh.normals.bytes();
        let columns = columns + mesh.uvs.bytes() + colors.bytes();
        let bytes = columns as u64 + TRIANGLE * mesh.triangles.len() as u64 + HEAD;
        self.reporter.charge(bytes, self.budget, path)?;
        let bytes = ply::encode_with(mesh, &colors, ["r", "g", "b", "opacity_x"]);
        Some(self.put(of, "mesh", bytes, "ply"))
    }
}
