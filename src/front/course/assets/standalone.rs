//! A mesh file given as the input, without a scene. It becomes a scene like that of a glTF asset
//! without camera and lights: grey, or with the colours of its vertices or the materials of its
//! MTL.

use super::AssetImport;
use super::material_binder::{MaterialSource, PendingMaterial};
use super::mesh::{self, MeshFile};
use super::text_file;
use crate::mesh::{MeshOptions, is_mesh, parse_with};
use crate::words::TextParseError;
use crate::{FrontOptions, UpAxis, gltf, over_limit};
use rtc_diag::{Diagnostic, DiagnosticSink, codes};
use rtc_ir::{
    EntityField, EntityKind, Instance, LoweredScene, Material, MaterialId, Mesh, MeshId, Shape,
    SourceSpans, Standard, Surface, ValuePath,
};
use rtc_math::Vec3;
use rtc_source::{FileId, FileSearch, SourceMap, Span};

/// The roughness of a mesh without a material.
const ROUGHNESS: f64 = 0.6;

/// The reflectance of a mesh without a material.
const GREY: f64 = 0.7;

/// Reads a mesh file and makes a scene of it. `None` if the file has errors, which are reported.
pub fn lower_standalone_mesh(
    file: FileId,
    options: &FrontOptions,
    map: &mut SourceMap,
    sink: &mut DiagnosticSink,
) -> Option<LoweredScene> {
    let parsed = parse_file(file, options.mesh(), map, sink)?;
    let name = map.name(file).rsplit(['/', '\\']).next();
    let name = name.unwrap_or_default().to_owned();
    let (has_colors, is_unlit) = (!parsed.mesh.colors.is_empty(), parsed.is_unlit);
    mesh::report_losses(&parsed, file, None, sink);
    let mesh_file = MeshFile::new(parsed, file, name.clone());
    // A scene with one instance of the mesh, seen by a default camera.
    let mut scene = gltf::empty();
    scene.meshes.push(Mesh {
        name,
        ..mesh_file.full_mesh()
    });
    scene.materials.push(Material::Standard(Box::new(Standard {
        unlit: is_unlit,
        ..default_material(has_colors)
    })));
    let up_axis = options.up_axis.unwrap_or(UpAxis::Y);
    let [x, y, z] = up_axis.scene_from_file().map(|axis| axis.to_array());
    scene.surfaces.push(Surface::new(
        Shape::Instance(Instance {
            mesh: MeshId(0),
            world_from_object: [x, y, z, [0.0; 3]],
        }),
        MaterialId(0),
    ));
    if let Some(ball) = scene.bounding_sphere() {
        scene.camera = gltf::looking_at(ball);
    }
    let is_stl = map.name(file).to_ascii_lowercase().ends_with(".stl");
    if options.up_axis.is_none() && stands_on_z(&scene.meshes[0], is_stl) {
        let message = "the mesh stands on z = 0, as if z pointed up";
        let note = Diagnostic::new(&codes::Z_UP, message).at(Span::new(file, 0, 0), "the file");
        sink.push(note.hint("`--up-axis z` turns it upright, `--up-axis y` keeps it"));
    }
    // The span of all entities is the start of the file.
    let mut source_spans = SourceSpans::default();
    for entity in [EntityKind::Mesh, EntityKind::Surface] {
        source_spans.record(
            ValuePath::new(entity, 0, EntityField::Whole),
            Span::new(file, 0, 0),
        );
    }
    let mut lowered = LoweredScene {
        scene,
        source_spans,
    };
    // Load the materials of the mesh.
    let folder = map.folder(file);
    let search = FileSearch::new(folder, options.asset_root.as_deref())
        .with_parent(folder, options.home.as_deref());
    let mut import = AssetImport::new(search, options, map, sink);
    import.meshes.add(MeshId(0), mesh_file);
    let pending = PendingMaterial {
        surface: 0,
        source: MaterialSource::AssetTarget,
        span: None,
    };
    import.finish(&[pending], &mut lowered);
    Some(lowered)
}

/// Whether a mesh stands on the plane z = 0: its lowest point is there, and it is thicker than a
/// sheet. One that stands on y = 0 as well does so only in STL, where z mostly points up.
fn stands_on_z(mesh: &Mesh, is_stl: bool) -> bool {
    /// A part of the largest extent.
    const SMALL: f64 = 1e-6;
    let positions = mesh.positions.iter().map(Vec3::from_array);
    let bounds = positions.fold(
        [Vec3::INFINITY, Vec3::NEG_INFINITY],
        |[low, high], position| [low.min(position), high.max(position)],
    );
    let [low, high] = bounds;
    let size = (high - low).max_element();
    let lies_on = |lowest: f64| lowest.abs() <= SMALL * size;
    size > 0.0 && lies_on(low.z) && (is_stl || !lies_on(low.y)) && high.z > SMALL * size
}

/// Parses the mesh file.
fn parse_file(
    file: FileId,
    options: MeshOptions,
    map: &SourceMap,
    sink: &mut DiagnosticSink,
) -> Option<crate::mesh::ParsedMesh> {
    let bytes = map.bytes(file);
    if !is_mesh(bytes) {
        let message = format!("`{}` is {}", map.name(file), mesh::TEXT.is_not);
        let diagnostic = Diagnostic::new(&codes::BAD_MESH_FILE, message);
        sink.push(diagnostic.at(Span::new(file, 0, 0), "at its start"));
        return None;
    }
    match parse_with(bytes, options, map.budget()) {
        Ok(parsed) => return Some(parsed),
        Err(TextParseError::Limit(fault)) => {
            let what = format!("the mesh `{}`", map.name(file));
            sink.push(over_limit(&what, &fault).at(Span::new(file, 0, 0), "the file"));
        }
        Err(TextParseError::Faults(faults)) => {
            for fault in faults {
                sink.push(text_file::diagnostic(&codes::BAD_MESH_FILE, fault, file));
            }
        }
    }
    None
}

/// The material of a mesh without materials.
fn default_material(has_colors: bool) -> Standard {
    let base = if has_colors { 1.0 } else { GREY };
    Standard {
        base_color: [base, base, base, 1.0],
        metallic: 0.0,
        roughness: ROUGHNESS,
        double_sided: true,
        ..Standard::default()
    }
}
