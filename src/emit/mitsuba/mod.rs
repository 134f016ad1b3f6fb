//! Writes the IR as a Mitsuba 3 scene (XML) with meshes and pictures as sidecar files. Path-traced
//! features that Mitsuba supports are exact; everything else is reported with its replacement.

mod camera;
mod light;
mod material;
mod shape;
mod texture;

use super::ExportedScene;
use super::export::joined;
use super::path_tracer::{
    SidecarWriter, SurfaceMaterial, TriangleSoup, bounces, has_media, is_basic,
};
use super::reporter::ExportReporter;
use super::tessellate::{TargetFormat, with_meshes};
use rtc_diag::{DiagnosticSink, codes};
use rtc_ir::{Scene, SourceSpans};
use rtc_source::Budget;
use std::collections::BTreeMap;
use std::fmt::Write as _;

const FORMAT: TargetFormat = TargetFormat {
    name: "Mitsuba",
    approximated: &codes::NO_TWIN,
    has: is_basic,
};

/// Exports a valid scene; meshes become files in `folder`, a path relative to the text.
///
/// `None` if meshes or pictures exceed the budget, or if nothing in the file emits light; the sink
/// has the error. It also has a warning for each feature without an exact equivalent.
pub fn emit(
    scene: &Scene,
    source_spans: &SourceSpans,
    folder: &str,
    budget: &Budget,
    sink: &mut DiagnosticSink,
) -> Option<ExportedScene> {
    // Replace shapes that Mitsuba lacks by meshes.
    let mut reporter = ExportReporter::new(source_spans, sink);
    let scene = &with_meshes(scene, &FORMAT, None, budget, &mut reporter)?;
    let mut writer = MitsubaWriter {
        scene,
        beside: SidecarWriter::new(scene, reporter, budget, folder, false),
        text: String::new(),
        triangle_soups: BTreeMap::new(),
        shines: false,
    };
    // Write the elements of the scene.
    writer.line(0, r#"<scene version="3.0.0">"#);
    writer.settings();
    writer.camera();
    writer.environment()?;
    writer.lights()?;
    writer.materials()?;
    writer.surfaces()?;
    writer.line(0, "</scene>");
    // Warn about a scene without light.
    writer.beside.reporter.shines(writer.shines)?;
    Some(ExportedScene {
        text: writer.text,
        files: writer.beside.files,
    })
}

/// The scene so far.
struct MitsubaWriter<'w> {
    scene: &'w Scene,
    /// Meshes and pictures beside the text.
    beside: SidecarWriter<'w>,
    text: String,
    /// Triangles in world coordinates, by material.
    triangle_soups: BTreeMap<SurfaceMaterial, TriangleSoup>,
    /// Whether anything that is written emits light.
    shines: bool,
}

impl MitsubaWriter<'_> {
    fn line(&mut self, depth: usize, content: &str) {
        let indent = 2 * depth;
        writeln!(self.text, "{:indent$}{content}", "")
            .expect("a string takes all that is written to it");
    }

    fn value(&mut self, depth: usize, kind: &str, name: &str, value: &str) {
        self.line(
            depth,
            &format!(r#"<{kind} name="{name}" value="{value}"/>"#),
        );
    }

    fn rgb(&mut self, depth: usize, name: &str, color: [f64; 3]) {
        self.value(depth, "rgb", name, &joined(color, " "));
    }

    /// Mitsuba counts path edges, one more than bounces. Sampler and sample count are parameters of
    /// the scene, which Mitsuba's `-D` sets.
    fn settings(&mut self) {
        let samples = self.beside.reporter.path_samples(self.scene, "Mitsuba");
        self.line(1, r#"<default name="sampler" value="independent"/>"#);
        self.line(1, &format!(r#"<default name="spp" value="{samples}"/>"#));
        let integrator = match has_media(self.scene) {
            true => "volpath",
            false => "path",
        };
        self.line(1, &format!(r#"<integrator type="{integrator}">"#));
        let edges = bounces(&self.scene.settings).saturating_add(1);
        self.value(2, "integer", "max_depth", &edges.to_string());
        self.line(1, "</integrator>");
    }
}
