//! The files that the examples name.

use flate2::{Compression, write::ZlibEncoder};
use rtc_image::{FileFormat, Image, Picture, png_bytes};
use std::io::Write as _;

const PLY: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n\
    property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n\
    0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
const OBJ: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
const LAYER: &str = "#usda 1.0\n(\ndefaultPrim = \"ball\"\n)\ndef Sphere \"ball\" {}\n";

/// The files by their names.
pub(super) fn beside() -> Vec<(String, Vec<u8>)> {
    let picture = png_bytes(
        [2, 2],
        false,
        &[40, 80, 120, 160, 200, 240, 10, 20, 30, 90, 60, 30],
    );
    let sky = Picture::opaque(Image {
        width: 4,
        height: 4,
        pixels: vec![[1.0, 2.0, 3.0]; 16],
    });
    let sky = sky.encode(FileFormat::Exr).unwrap_or_default();
    let files = [
        ("a.png", picture),
        ("sky.exr", sky),
        ("a.ply", PLY.as_bytes().to_vec()),
        ("a.obj", OBJ.as_bytes().to_vec()),
        ("a.serialized", serialized()),
        ("a.usda", LAYER.as_bytes().to_vec()),
        (
            "part.xml",
            br#"<scene version="3.0.0"><shape type="sphere"/></scene>"#.to_vec(),
        ),
        ("part.pbrt", b"Shape \"sphere\"\n".to_vec()),
    ];
    files.map(|(name, bytes)| (name.to_owned(), bytes)).to_vec()
}

/// A mesh of one triangle in Mitsuba's format, version 4.
fn serialized() -> Vec<u8> {
    // Positions in single precision, without normals and texture coordinates; an empty name.
    let mut mesh = vec![0, 16, 0, 0, 0];
    mesh.extend([3_u64, 1].iter().flat_map(|count| count.to_le_bytes()));
    let positions = [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    mesh.extend(positions.iter().flat_map(|number| number.to_le_bytes()));
    mesh.extend([0_u32, 1, 2].iter().flat_map(|corner| corner.to_le_bytes()));
    // Magic number, version, the mesh, its offset and the number of meshes.
    let mut encoder = ZlibEncoder::new(vec![0x1c, 0x04, 4, 0], Compression::default());
    let mut bytes = match encoder.write_all(&mesh) {
        Ok(()) => encoder.finish().unwrap_or_default(),
        Err(_) => Vec::new(),
    };
    bytes.extend(0_u64.to_le_bytes());
    bytes.extend(1_u32.to_le_bytes());
    bytes
}
