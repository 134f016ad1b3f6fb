//! Writes the IR as a scene of pbrt-v4, with meshes and pictures as sidecar files. What pbrt lacks
//! is reported with its replacement.
//!
//! ```text
//! settings, camera ─ WorldBegin ─ environment, lights ─ textures, materials ─ objects, shapes
//! ```

mod camera;
mod equal_area;
mod light;
mod material;
mod shape;
mod texture;

use super::ExportedScene;
use super::export::joined;
use super::path_tracer::{
    SidecarWriter, SurfaceMaterial, TriangleSoup, bounces, has_maps, has_media, is_basic,
    pixel_filter,
};
use super::reporter::ExportReporter;
use super::tessellate::{TargetFormat, with_meshes};
use material::ShownMaterial;
use rtc_diag::{DiagnosticSink, codes};
use rtc_ir::{Scene, Shape, SourceSpans, Surface};
use rtc_math::{PixelFilter, Vec3};
use rtc_source::Budget;
use std::collections::BTreeMap;
use std::fmt::Write as _;

const FORMAT: TargetFormat = TargetFormat {
    name: "pbrt",
    approximated: &codes::NO_TWIN,
    has: is_written,
};

/// Whether pbrt has the shape of a surface: beside the basic shapes ellipsoids, which are stretched
/// spheres, and bilinear patches.
fn is_written(scene: &Scene, surface: &Surface) -> bool {
    let is_own = matches!(surface.shape, Shape::Ellipsoid(_) | Shape::Quad(_));
    is_basic(scene, surface) || is_own && !has_maps(scene, surface)
}

/// Exports a valid scene; meshes and pictures become files in `folder`, a path relative to the text.
///
/// `None` if they exceed the budget, or if nothing in the file emits light; the sink has the error.
/// It also has a warning for each feature without an exact equivalent.
pub fn emit(
    scene: &Scene,
    source_spans: &SourceSpans,
    folder: &str,
    budget: &Budget,
    sink: &mut DiagnosticSink,
) -> Option<ExportedScene> {
    // Replace shapes that pbrt lacks by meshes.
    let mut reporter = ExportReporter::new(source_spans, sink);
    let scene = &with_meshes(scene, &FORMAT, None, budget, &mut reporter)?;
    let mut writer = PbrtWriter {
        scene,
        beside: SidecarWriter::new(scene, reporter, budget, folder, true),
        text: String::new(),
        shown: BTreeMap::new(),
        textures: BTreeMap::new(),
        triangle_soups: BTreeMap::new(),
        objects: BTreeMap::new(),
        shines: false,
    };
    // Write the directives before the world, and those of the world.
    writer.line("# pbrt-v4");
    writer.settings();
    writer.camera();
    writer.line("WorldBegin");
    writer.environment()?;
    writer.lights();
    writer.materials()?;
    writer.surfaces()?;
    // Report an error for a scene without light.
    writer.beside.reporter.shines(writer.shines)?;
    Some(ExportedScene {
        text: writer.text,
        files: writer.beside.files,
    })
}

/// The scene so far.
struct PbrtWriter<'w> {
    scene: &'w Scene,
    /// Meshes and pictures beside the text.
    beside: SidecarWriter<'w>,
    text: String,
    /// The materials as surfaces show them.
    shown: BTreeMap<SurfaceMaterial, ShownMaterial>,
    /// The names of textures, by their directives without the name.
    textures: BTreeMap<String, String>,
    /// Triangles in world coordinates, by material.
    triangle_soups: BTreeMap<SurfaceMaterial, TriangleSoup>,
    /// The names of the objects of mesh files with a material.
    objects: BTreeMap<(String, SurfaceMaterial), String>,
    /// Whether anything that is written emits light.
    shines: bool,
}

impl PbrtWriter<'_> {
    fn line(&mut self, content: &str) {
        writeln!(self.text, "{content}").expect("a string takes all that is written to it");
    }

    /// The absolute transform to the world, by its columns.
    fn placed(&mut self, columns: [Vec3; 4]) {
        self.line(&format!("Transform [ {} ]", matrix(columns)));
    }

    /// Writes directives with their own graphics state.
    fn attributes<T>(&mut self, write: impl FnOnce(&mut Self) -> T) -> T {
        self.line("AttributeBegin");
        let written = write(self);
        self.line("AttributeEnd");
        written
    }

    /// Integrator, sampler and filter. pbrt counts bounces as the IR does.
    fn settings(&mut self) {
        let samples = self.beside.reporter.path_samples(self.scene, "pbrt");
        let integrator = match has_media(self.scene) {
            true => "volpath",
            false => "path",
        };
        let bounces = bounces(&self.scene.settings);
        self.line(&format!(
            r#"Integrator "{integrator}" "integer maxdepth" [ {bounces} ]"#
        ));
        self.line(&format!(
            r#"Sampler "independent" "integer pixelsamples" [ {samples} ]"#
        ));
        let filter = match pixel_filter(&self.scene.settings) {
            PixelFilter::Box { radius } => filter("box", radius, &[]),
            PixelFilter::Tent { radius } => filter("triangle", radius, &[]),
            PixelFilter::Gaussian { deviation, radius } => {
                filter("gaussian", radius, &[("sigma", deviation)])
            }
            PixelFilter::Mitchell { b, c, radius } => {
                filter("mitchell", radius, &[("B", b), ("C", c)])
            }
            PixelFilter::Lanczos { window, radius } => filter("sinc", radius, &[("tau", window)]),
        };
        self.line(&filter);
    }
}

/// A filter of the film.
fn filter(kind: &str, radius: f64, others: &[(&str, f64)]) -> String {
    let radii = [("xradius", radius), ("yradius", radius)];
    let all = radii.iter().chain(others);
    let parameters: String = all
        .map(|(name, value)| numbers("float", name, [*value]))
        .collect();
    format!(r#"PixelFilter "{kind}"{parameters}"#)
}

/// A parameter with numbers.
fn numbers(kind: &str, name: &str, values: impl IntoIterator<Item = f64>) -> String {
    format!(r#" "{kind} {name}" [ {} ]"#, joined(values, " "))
}

/// A parameter with a string.
fn string(kind: &str, name: &str, value: &str) -> String {
    format!(r#" "{kind} {name}" "{value}""#)
}

/// An affine map as pbrt writes it: column after column.
fn matrix(columns: [Vec3; 4]) -> String {
    let last = [0.0, 0.0, 0.0, 1.0];
    let entries = columns.into_iter().zip(last);
    joined(
        entries.flat_map(|(column, last)| [column.x, column.y, column.z, last]),
        " ",
    )
}
