//! Writes the IR as a POV-Ray 3.7 scene. Features of the Phong model that POV-Ray supports are
//! exact; everything else is reported with its replacement.

mod material;
mod shape;

use super::ExportedScene;
use super::export::joined;
use super::reporter::ExportReporter;
use rtc_diag::Sink;
use rtc_ir::{
    Camera, Display, EntityKind, Field, Light, Mode, Pattern, PointLight, Projection, Scene,
    Settings, SourceSpans, ValuePath,
};
use rtc_math::Vec3;
use rtc_source::Budget;
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// Exports a valid scene. `None` if its meshes exceed the budget; the sink has the error. It also
/// has a warning for each feature without an exact equivalent.
pub fn emit(
    scene: &Scene,
    source_spans: &SourceSpans,
    budget: &Budget,
    sink: &mut Sink,
) -> Option<ExportedScene> {
    let mut writer = PovWriter {
        scene,
        budget,
        reporter: ExportReporter::new(source_spans, sink),
        text: String::new(),
    };
    writer.settings();
    writer.camera();
    writer.lights();
    writer.materials();
    writer.surfaces()?;
    Some(ExportedScene {
        text: writer.text,
        files: BTreeMap::new(),
    })
}

/// The scene so far.
struct PovWriter<'w> {
    scene: &'w Scene,
    budget: &'w Budget,
    reporter: ExportReporter<'w>,
    text: String,
}

impl PovWriter<'_> {
    fn line(&mut self, content: &str) {
        writeln!(self.text, "{content}").expect("a string takes all that is written to it");
    }

    /// POV-Ray counts the camera ray as a level, and drops rays that would contribute less than
    /// `adc_bailout`.
    fn settings(&mut self) {
        /// The maximum number of reflection levels, and of samples across a pixel.
        const MAX: [u32; 2] = [256, 9];
        let Settings {
            mode,
            max_depth,
            supersampling,
            pattern,
            toon,
            ..
        } = &self.scene.settings;
        // Command line options.
        let [width, height] = self.scene.camera.size;
        let across = (*supersampling).min(MAX[1]);
        let samples = match (across, pattern) {
            (1, _) => String::new(),
            (factor, Pattern::Grid) => format!(" +A0.0 +AM1 +R{factor} -J"),
            (factor, _) => format!(" +A0.0 +AM1 +R{factor} +J"),
        };
        // Report what POV-Ray does not support.
        let path = ValuePath::new(EntityKind::Settings, 0, Field::Mode);
        if *mode != Mode::Phong || *toon {
            let message = "POV-Ray shows Phong's model, and this scene is shown in another way";
            self.reporter.unsupported(message, path);
        }
        let levels = max_depth.saturating_add(1);
        if levels > MAX[0] || *supersampling > MAX[1] {
            let message = "POV-Ray follows at most 256 levels, and takes at most 9 × 9 samples";
            self.reporter.unsupported(message, path);
        }
        let Display { exposure, tone } = &self.scene.display;
        if *exposure != 0.0 || tone.is_some() {
            let message = "exposure and tone map are left out";
            self.reporter.unsupported(message, path);
        }
        self.reporter.own_settings(&self.scene.settings);
        // Write the settings.
        self.line(&format!(
            "// povray +W{width} +H{height} +FN File_Gamma=1.0{samples}\n#version 3.7;"
        ));
        let levels = levels.min(MAX[0]);
        self.line(&format!(
            "global_settings {{ assumed_gamma 1 ambient_light rgb 1 max_trace_level {levels} \
             adc_bailout 0 }}"
        ));
    }

    /// POV-Ray's camera is given by the sides of its image, so any frustum is exact.
    fn camera(&mut self) {
        let Camera {
            eye,
            center,
            right,
            up,
            size: [width, height],
            lens,
            projection,
        } = &self.scene.camera;
        let [right, up] = [(right, width), (up, height)]
            .map(|(step, count)| Vec3::from_array(*step) * f64::from(*count));
        let view_direction = Vec3::from_array(*center) - Vec3::from_array(*eye);
        let kind = match projection {
            Projection::Perspective => "perspective",
            Projection::Orthographic => "orthographic",
        };
        if lens.radius > 0.0 {
            let message = "the lens is left out: POV-Ray samples it by another pattern";
            let path = ValuePath::new(EntityKind::Camera, 0, Field::Whole);
            self.reporter.unsupported(message, path);
        }
        let [right, up, view_direction] = [right, up, view_direction].map(|v| vector(v.to_array()));
        let eye = vector(*eye);
        self.line(&format!(
            "camera {{ {kind} location {eye} direction {view_direction} right {right} up {up} }}"
        ));
    }

    fn lights(&mut self) {
        let scene = self.scene;
        if scene.environment.is_some() {
            let message = "the surroundings are left out";
            let path = ValuePath::new(EntityKind::Environment, 0, Field::Whole);
            self.reporter.unsupported(message, path);
        }
        let emitting = scene.lights.iter().enumerate();
        for (index, light) in emitting.filter(|(_, light)| light.emits()) {
            let path = ValuePath::new(EntityKind::Light, index, Field::Whole);
            let Light::Point(PointLight {
                position,
                color,
                radius,
            }) = light
            else {
                let message = "a light in physical units is left out";
                self.reporter.unsupported(message, path);
                continue;
            };
            if *radius > 0.0 && scene.settings.light_samples > 1 {
                let message = "a soft light is written as the point in its middle";
                self.reporter.unsupported(message, path);
            }
            let (position, color) = (vector(*position), vector(*color));
            self.line(&format!("light_source {{ {position}, rgb {color} }}"));
        }
    }
}

/// A vector in POV-Ray syntax.
fn vector(numbers: impl IntoIterator<Item = f64>) -> String {
    format!("<{}>", joined(numbers, ", "))
}
