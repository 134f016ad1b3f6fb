//! Writes the IR as a Mitsuba 3 scene (XML) with meshes and pictures as sidecar files. Path-traced
//! features that Mitsuba supports are exact; everything else is reported with its replacement.

mod camera;
mod light;
mod material;
mod shape;
mod texture;

use super::ExportedScene;
use super::export::joined;
use super::reporter::ExportReporter;
use super::tessellate::{TargetFormat, with_meshes};
use material::MaterialVariant;
use rtc_diag::{Sink, codes};
use rtc_ir::{
    Display, EntityKind, Field, Material, Mode, PathSettings, Scene, SourceSpans, ValuePath,
};
use rtc_source::Budget;
use shape::{MeshFileKey, TriangleSoup};
use std::collections::BTreeMap;
use std::fmt::Write as _;

const FORMAT: TargetFormat = TargetFormat {
    name: "Mitsuba",
    approximated: &codes::NO_TWIN,
    has: shape::is_written,
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
    sink: &mut Sink,
) -> Option<ExportedScene> {
    // Replace shapes that Mitsuba lacks by meshes.
    let mut reporter = ExportReporter::new(source_spans, sink);
    let scene = &with_meshes(scene, &FORMAT, None, budget, &mut reporter)?;
    let mut writer = MitsubaWriter {
        scene,
        folder,
        budget,
        reporter,
        text: String::new(),
        files: BTreeMap::new(),
        meshes: BTreeMap::new(),
        triangle_soups: BTreeMap::new(),
        bitmaps: BTreeMap::new(),
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
    writer.reporter.shines(writer.shines)?;
    Some(ExportedScene {
        text: writer.text,
        files: writer.files,
    })
}

/// The scene so far.
struct MitsubaWriter<'w> {
    scene: &'w Scene,
    folder: &'w str,
    budget: &'w Budget,
    reporter: ExportReporter<'w>,
    text: String,
    files: BTreeMap<String, Vec<u8>>,
    /// The file names of the meshes written so far, by what distinguishes them.
    meshes: BTreeMap<MeshFileKey, String>,
    /// Triangles in world coordinates, by material.
    triangle_soups: BTreeMap<MaterialVariant, TriangleSoup>,
    /// The file names of the pictures of textures, by what was made of which.
    bitmaps: BTreeMap<String, String>,
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
        let settings = &self.scene.settings;
        let samples = match &settings.mode {
            Mode::Path(PathSettings {
                samples,
                multiple_scattering: _,
            }) => *samples,
            Mode::Phong | Mode::Depth | Mode::Normal | Mode::Gooch(_) => {
                let message = "Mitsuba traces paths, and this scene uses another integrator: \
                `--integrator path` renders the exported scene";
                let path = ValuePath::new(EntityKind::Settings, 0, Field::Mode);
                self.reporter.unsupported(message, path);
                settings.supersampling.saturating_pow(2)
            }
        };
        self.line(1, r#"<default name="sampler" value="independent"/>"#);
        self.line(1, &format!(r#"<default name="spp" value="{samples}"/>"#));
        let absorbs = |material: &Material| material::absorption(&material::standard(material));
        let has_media = self
            .scene
            .materials
            .iter()
            .any(|one| absorbs(one).is_some());
        let integrator = if has_media { "volpath" } else { "path" };
        self.line(1, &format!(r#"<integrator type="{integrator}">"#));
        // Phong's model lights every hit directly, also one without reflections.
        let more = if matches!(settings.mode, Mode::Path(_)) {
            1
        } else {
            2
        };
        let edges = settings.max_depth.saturating_add(more).min(i32::MAX as u32);
        self.value(2, "integer", "max_depth", &edges.to_string());
        self.line(1, "</integrator>");
        self.reporter.own_settings(settings);
        let Display { exposure, tone } = &self.scene.display;
        if *exposure != 0.0 || tone.is_some() {
            let message = "exposure and tone map are left out: Mitsuba writes linear values";
            let path = ValuePath::new(EntityKind::Settings, 0, Field::Whole);
            self.reporter.unsupported(message, path);
        }
    }
}
