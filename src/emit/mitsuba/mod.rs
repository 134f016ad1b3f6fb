//! The IR as a scene of Mitsuba 3 (XML), with meshes as PLY beside it: the parts that Mitsuba shows
//! just so, in traced paths. What has no exact twin there is told, with what stands for it.

mod camera;
mod light;
mod material;
mod shape;

use super::ExportedScene;
use super::told::Told;
use super::twin::joined;
use rtc_diag::Sink;
use rtc_ir::{
    Display, EntityKind, Environment, Field, Mode, PathSettings, Scene, SourceSpans, ValuePath,
};
use rtc_source::Budget;
use shape::Soup;
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// Writes a proven scene; meshes become files in `folder`, which is named as the text is to name it.
///
/// `None` if the meshes take too much, which the sink says. It also has a warning for each part that
/// has no exact twin.
pub fn emit(
    scene: &Scene,
    source_spans: &SourceSpans,
    folder: &str,
    budget: &Budget,
    sink: &mut Sink,
) -> Option<ExportedScene> {
    let mut writer = MitsubaWriter {
        scene,
        folder,
        budget,
        told: Told::new(source_spans, sink),
        text: String::new(),
        files: BTreeMap::new(),
        meshes: BTreeMap::new(),
        soups: BTreeMap::new(),
    };
    writer.line(0, r#"<scene version="3.0.0">"#);
    writer.settings();
    writer.camera();
    writer.environment();
    writer.lights();
    writer.materials();
    writer.surfaces()?;
    writer.line(0, "</scene>");
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
    told: Told<'w>,
    text: String,
    files: BTreeMap<String, Vec<u8>>,
    /// The names of the files of meshes that were written.
    meshes: BTreeMap<u32, String>,
    /// Triangles that stand in the scene themselves, by their material.
    soups: BTreeMap<u32, Soup>,
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

    /// A path of so many bounces has one edge more after the first. Sampler and samples are parameters
    /// of the scene, which Mitsuba's `-D` sets.
    fn settings(&mut self) {
        let settings = &self.scene.settings;
        let samples = match &settings.mode {
            Mode::Path(PathSettings {
                samples,
                multiple_scattering: _,
            }) => *samples,
            Mode::Phong | Mode::Zbuffer | Mode::Normal | Mode::Gooch(_) => {
                let message = "Mitsuba traces paths, and this scene is shown in another way: \
                               `--integrator path` shows what is written";
                let place = ValuePath::new(EntityKind::Settings, 0, Field::Mode);
                self.told.no_twin(message, place);
                settings.supersampling.saturating_pow(2)
            }
        };
        self.line(1, r#"<default name="sampler" value="independent"/>"#);
        self.line(1, &format!(r#"<default name="spp" value="{samples}"/>"#));
        self.line(1, r#"<integrator type="path">"#);
        let edges = settings.max_depth.saturating_add(1).min(i32::MAX as u32);
        self.value(2, "integer", "max_depth", &edges.to_string());
        self.line(1, "</integrator>");
        let Display { exposure, tone } = &self.scene.display;
        if *exposure != 0.0 || tone.is_some() {
            let message = "exposure and tone map are left out: Mitsuba writes linear values";
            let place = ValuePath::new(EntityKind::Settings, 0, Field::Whole);
            self.told.no_twin(message, place);
        }
    }

    fn environment(&mut self) {
        let Some(Environment {
            radiance,
            image,
            image_from_world: _,
        }) = &self.scene.environment
        else {
            return;
        };
        if image.is_some() {
            let message = "a picture of the surroundings is left out";
            let place = ValuePath::new(EntityKind::Environment, 0, Field::Whole);
            self.told.no_twin(message, place);
            return;
        }
        self.line(1, r#"<emitter type="constant">"#);
        self.rgb(2, "radiance", *radiance);
        self.line(1, "</emitter>");
    }
}
