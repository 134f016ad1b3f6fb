//! What front/gltf lowers, beside what the crate `gltf` reads of the same file: where the nodes stand,
//! the contents of accessors, the factors of materials.

use super::{is_near, open};
use crate::suite::{absent, files, name, root, shared, trial_if};
use gltf::accessor::{DataType, Dimensions};
use gltf::json::Value;
use gltf::scene::Transform;
use gltf::{Accessor, Gltf, Node, Primitive, Semantic};
use libtest_mimic::Trial;
use rtc::internals::ir::{Material, Mesh, Scene, Shape, Standard};
use std::path::{Path, PathBuf};

pub(crate) fn trials() -> Vec<Trial> {
    let folder = root("tests/gltf/assets");
    let mut trials = of_files("assets", &folder);
    trials.extend(match shared("gltf/assets") {
        Some(folder) => of_files("gltf/assets", &folder),
        None => vec![absent("beside the crate gltf", "gltf/assets")],
    });
    trials
}

fn of_files(what: &str, folder: &Path) -> Vec<Trial> {
    let test = |path: PathBuf| {
        let name = format!("beside the crate gltf: {what}/{}", name(&path, folder));
        trial_if(name, move || agrees(&path))
    };
    let files = files(folder, &["glb", "gltf"]);
    files.into_iter().map(test).collect()
}

/// An asset as the crate reads it, with the bytes of its buffers.
struct Peer {
    asset: Gltf,
    buffers: Vec<Vec<u8>>,
}

impl Peer {
    /// None of what the crate does not read: compressed buffers and meshes.
    fn open(path: &Path) -> Option<Self> {
        let bytes = std::fs::read(path).unwrap();
        let mut asset = Gltf::from_slice_without_validation(&bytes).unwrap();
        let is_compressed = |name: &str| name.contains("meshopt") || name.contains("draco");
        if asset.extensions_used().any(is_compressed) {
            return None;
        }
        let blob = asset.blob.take();
        let buffers = asset.buffers().map(|buffer| match buffer.source() {
            gltf::buffer::Source::Bin => blob.clone().unwrap(),
            gltf::buffer::Source::Uri(uri) => resolve(uri, path),
        });
        let buffers = buffers.collect();
        Some(Self { asset, buffers })
    }

    /// The numbers of an accessor, element by element; fractions where they are normalised.
    fn numbers(&self, accessor: &Accessor<'_>) -> Vec<f64> {
        let width = match accessor.dimensions() {
            Dimensions::Scalar => 1,
            Dimensions::Vec2 => 2,
            Dimensions::Vec3 => 3,
            Dimensions::Vec4 | Dimensions::Mat2 => 4,
            Dimensions::Mat3 => 9,
            Dimensions::Mat4 => 16,
        };
        let kind = accessor.data_type();
        let mut numbers = match accessor.view() {
            None => vec![0.0; width * accessor.count()],
            Some(view) => {
                let buffer = &self.buffers[view.buffer().index()];
                let stride = view.stride().unwrap_or(width * kind.size());
                let start = view.offset() + accessor.offset();
                (0..accessor.count())
                    .flat_map(|at| elements(&buffer[start + at * stride..], kind, width))
                    .collect()
            }
        };
        if let Some(sparse) = accessor.sparse() {
            let (indices, values) = (sparse.indices(), sparse.values());
            let bytes = |view: gltf::buffer::View<'_>, offset: usize| {
                &self.buffers[view.buffer().index()][view.offset() + offset..]
            };
            let index_kind = match indices.index_type() {
                gltf::accessor::sparse::IndexType::U8 => DataType::U8,
                gltf::accessor::sparse::IndexType::U16 => DataType::U16,
                gltf::accessor::sparse::IndexType::U32 => DataType::U32,
            };
            let count = sparse.count();
            let at = elements(bytes(indices.view(), indices.offset()), index_kind, count);
            let new = elements(bytes(values.view(), values.offset()), kind, width * count);
            for (at, new) in at.into_iter().zip(new.chunks(width)) {
                let first = (at as usize) * width;
                numbers[first..first + width].copy_from_slice(new);
            }
        }
        if accessor.normalized() {
            let most = match kind {
                DataType::I8 => 127.0,
                DataType::U8 => 255.0,
                DataType::I16 => 32767.0,
                DataType::U16 => 65535.0,
                DataType::U32 | DataType::F32 => 1.0,
            };
            numbers
                .iter_mut()
                .for_each(|own| *own = (*own / most).max(-1.0));
        }
        numbers
    }

    /// The vectors of an attribute, those of each corner of the triangles.
    fn corners(&self, primitive: &Primitive<'_>, semantic: &Semantic) -> Option<Vec<Vec<f64>>> {
        let accessor = primitive.get(semantic)?;
        let numbers = self.numbers(&accessor);
        let width = numbers.len() / accessor.count();
        let vectors: Vec<_> = numbers.chunks(width).map(<[f64]>::to_vec).collect();
        let Some(indices) = primitive.indices() else {
            return Some(vectors);
        };
        let indices = self.numbers(&indices).into_iter();
        Some(indices.map(|at| vectors[at as usize].clone()).collect())
    }
}

/// Numbers of a buffer.
fn elements(bytes: &[u8], kind: DataType, count: usize) -> Vec<f64> {
    let each = bytes.chunks(kind.size()).take(count);
    let number = |own: &[u8]| match kind {
        DataType::I8 => f64::from(own[0].cast_signed()),
        DataType::U8 => f64::from(own[0]),
        DataType::I16 => f64::from(i16::from_le_bytes([own[0], own[1]])),
        DataType::U16 => f64::from(u16::from_le_bytes([own[0], own[1]])),
        DataType::U32 => f64::from(u32::from_le_bytes([own[0], own[1], own[2], own[3]])),
        DataType::F32 => f64::from(f32::from_le_bytes([own[0], own[1], own[2], own[3]])),
    };
    each.map(number).collect()
}

fn resolve(uri: &str, path: &Path) -> Vec<u8> {
    use base64::Engine as _;
    match uri.split_once(";base64,") {
        Some((_, text)) => base64::engine::general_purpose::STANDARD
            .decode(text)
            .unwrap(),
        None => std::fs::read(path.with_file_name(uri.replace("%20", " "))).unwrap(),
    }
}

/// A surface as the crate says it: its mesh, and its place.
struct PeerSurface<'p> {
    primitive: Primitive<'p>,
    world: [[f64; 4]; 4],
}

/// Compares an asset, or says why it can't be: what follows joints, morph targets or instances is posed
/// as it is lowered, and points and lines are thickened.
fn agrees(path: &Path) -> Result<(), &'static str> {
    let peer = Peer::open(path).ok_or("the crate reads nothing compressed")?;
    let lowered = open(path).ok_or("the asset is not sound")?;
    let mut surfaces = Vec::new();
    let scene = peer.asset.default_scene().or(peer.asset.scenes().next());
    for node in scene.unwrap().nodes() {
        collect(&node, IDENTITY, &mut surfaces);
    }
    let is_plain = peer.asset.skins().next().is_none()
        && peer.asset.animations().next().is_none()
        && !peer
            .asset
            .extensions_used()
            .any(|name| name.contains("instancing"))
        && surfaces.iter().all(|own| {
            own.primitive.mode() == gltf::mesh::Mode::Triangles
                && own.primitive.morph_targets().next().is_none()
        });
    if !is_plain {
        return Err("the asset is posed or thickened as it is lowered");
    }
    assert_eq!(surfaces.len(), lowered.scene.surfaces.len());
    for (peer_surface, surface) in surfaces.iter().zip(&lowered.scene.surfaces) {
        let Shape::Instance(own) = &surface.shape else {
            panic!("a glTF asset has meshes")
        };
        same_place(peer_surface.world, own.world_from_object);
        let mesh = &lowered.scene.meshes[own.mesh.0 as usize];
        same_mesh(&peer, &peer_surface.primitive, mesh);
        same_material(&peer_surface.primitive, &lowered.scene, surface.material.0);
    }
    Ok(())
}

const IDENTITY: [[f64; 4]; 4] = [
    [1.0, 0.0, 0.0, 0.0],
    [0.0, 1.0, 0.0, 0.0],
    [0.0, 0.0, 1.0, 0.0],
    [0.0, 0.0, 0.0, 1.0],
];

/// The surfaces of a node and of those below it, in the order of the file.
fn collect<'p>(node: &Node<'p>, above: [[f64; 4]; 4], surfaces: &mut Vec<PeerSurface<'p>>) {
    let world = product(above, local(node));
    for primitive in node.mesh().iter().flat_map(gltf::Mesh::primitives) {
        surfaces.push(PeerSurface { primitive, world });
    }
    for child in node.children() {
        collect(&child, world, surfaces);
    }
}

/// The columns of the matrix of a node.
fn local(node: &Node<'_>) -> [[f64; 4]; 4] {
    match node.transform() {
        Transform::Matrix { matrix } => matrix.map(|column| column.map(f64::from)),
        Transform::Decomposed {
            translation,
            rotation,
            scale,
        } => {
            let rotation = rotation.map(f64::from);
            // Files have rotations of length 1 only nearly.
            let length = rotation.iter().map(|part| part * part).sum::<f64>().sqrt();
            let [x, y, z, w] = rotation.map(|part| part / length);
            let [sx, sy, sz] = scale.map(f64::from);
            let [tx, ty, tz] = translation.map(f64::from);
            let column = |[a, b, c]: [f64; 3], scale: f64| [a * scale, b * scale, c * scale, 0.0];
            let first = [
                1.0 - 2.0 * (y * y + z * z),
                2.0 * (x * y + z * w),
                2.0 * (x * z - y * w),
            ];
            let second = [
                2.0 * (x * y - z * w),
                1.0 - 2.0 * (x * x + z * z),
                2.0 * (y * z + x * w),
            ];
            let third = [
                2.0 * (x * z + y * w),
                2.0 * (y * z - x * w),
                1.0 - 2.0 * (x * x + y * y),
            ];
            [
                column(first, sx),
                column(second, sy),
                column(third, sz),
                [tx, ty, tz, 1.0],
            ]
        }
    }
}

/// The product of matrices by their columns.
fn product(a: [[f64; 4]; 4], b: [[f64; 4]; 4]) -> [[f64; 4]; 4] {
    b.map(|column| std::array::from_fn(|row| (0..4).map(|at| a[at][row] * column[at]).sum::<f64>()))
}

fn same_place(peer: [[f64; 4]; 4], own: [[f64; 3]; 4]) {
    let size = peer
        .iter()
        .flatten()
        .fold(0.0_f64, |size, part| size.max(part.abs()));
    for (peer, own) in peer.into_iter().zip(own) {
        let near = peer.into_iter().zip(own).all(|(a, b)| is_near(a, b, size));
        assert!(near, "{peer:?} {own:?}");
    }
}

/// The corners of the triangles have the same positions, normals and coordinates.
fn same_mesh(peer: &Peer, primitive: &Primitive<'_>, mesh: &Mesh) {
    let corners: Vec<usize> = mesh
        .triangles
        .iter()
        .flatten()
        .map(|at| *at as usize)
        .collect();
    let attributes = [
        (Semantic::Positions, vectors(mesh.positions.iter())),
        (Semantic::Normals, vectors(mesh.normals.iter())),
        (Semantic::TexCoords(0), vectors(mesh.uvs.iter())),
        (Semantic::TexCoords(1), vectors(mesh.second_uvs.iter())),
        (Semantic::Tangents, vectors(mesh.tangents.iter())),
    ];
    for (semantic, own) in attributes {
        let Some(peer) = peer.corners(primitive, &semantic) else {
            continue;
        };
        // Sets of coordinates beyond the first two may stand in for these.
        if own.is_empty() && semantic != Semantic::Positions {
            continue;
        }
        assert_eq!(peer.len(), corners.len(), "{semantic:?}");
        for (peer, at) in peer.iter().zip(&corners) {
            let near = peer
                .iter()
                .zip(&own[*at])
                .all(|(a, b)| is_near(*a, *b, 1e-30));
            assert!(near, "{semantic:?}: {peer:?} {:?}", own[*at]);
        }
    }
}

fn vectors<const N: usize>(vectors: impl Iterator<Item = [f64; N]>) -> Vec<Vec<f64>> {
    vectors.map(|vector| vector.to_vec()).collect()
}

fn same_material(primitive: &Primitive<'_>, scene: &Scene, own: u32) {
    let material = primitive.material();
    let Material::Standard(own) = &scene.materials[own as usize] else {
        panic!("a glTF asset has materials of glTF")
    };
    let pbr = material.pbr_metallic_roughness();
    let mut pairs = Vec::new();
    if own.specular_glossiness.is_none() {
        let colors = pbr.base_color_factor().map(f64::from);
        pairs.extend(colors.into_iter().zip(own.base_color));
    }
    pairs.push((pbr.metallic_factor().into(), own.metallic));
    pairs.push((pbr.roughness_factor().into(), own.roughness));
    let strength = extension(&material, "emissive_strength", "emissiveStrength").unwrap_or(1.0);
    let emissive = material
        .emissive_factor()
        .map(|own| f64::from(own) * strength);
    pairs.extend(emissive.into_iter().zip(own.emissive));
    pairs.push((material.ior().map_or(1.5, f64::from), own.ior));
    let transmission = material.transmission();
    let factor = transmission.map_or(0.0, |own| own.transmission_factor().into());
    pairs.push((factor, own.transmission));
    let thickness = material
        .volume()
        .map_or(0.0, |own| own.thickness_factor().into());
    pairs.push((thickness, own.thickness));
    let specular = material
        .specular()
        .map_or(1.0, |own| own.specular_factor().into());
    pairs.push((specular, own.specular));
    for (name, key, own) in others(own) {
        pairs.push((extension(&material, name, key).unwrap_or(0.0), own));
    }
    for (peer, ours) in pairs {
        assert!(
            is_near(peer, ours, 1e-30),
            "{:?}: {peer} {ours}",
            material.name()
        );
    }
    assert_eq!(material.double_sided(), own.double_sided);
    assert_eq!(material.unlit(), own.unlit);
}

/// Factors of extensions that the crate has no types for.
fn others(own: &Standard) -> [(&'static str, &'static str, f64); 6] {
    [
        ("clearcoat", "clearcoatFactor", own.clearcoat),
        (
            "clearcoat",
            "clearcoatRoughnessFactor",
            own.clearcoat_roughness,
        ),
        ("sheen", "sheenRoughnessFactor", own.sheen_roughness),
        ("anisotropy", "anisotropyStrength", own.anisotropy),
        ("iridescence", "iridescenceFactor", own.iridescence),
        ("dispersion", "dispersion", own.dispersion),
    ]
}

fn extension(material: &gltf::Material<'_>, name: &str, key: &str) -> Option<f64> {
    let block = material.extension_value(&format!("KHR_materials_{name}"))?;
    block.get(key).and_then(Value::as_f64)
}
