//! Writes the IR as a POV-Ray 3.7 scene. Features of the Phong model that POV-Ray supports are
//! exact; everything else is reported with its replacement.

mod light;
mod material;
mod shape;

use super::ExportedScene;
use super::export::joined;
use super::reporter::ExportReporter;
use super::tessellate::{TargetFormat, with_meshes};
use super::texture_area::TextureAreas;
use rtc_diag::{DiagnosticSink, codes};
use rtc_ir::{
    Camera, Display, EntityField, EntityKind, Material, Mode, Pattern, Projection, Scene, Settings,
    SourceSpans, ValuePath,
};
use rtc_math::Vec3;
use rtc_source::Budget;
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// Stand-ins are reported with these words.
const FORMAT: TargetFormat = TargetFormat {
    name: "POV-Ray",
    approximated: &codes::NO_TWIN,
    has: material::is_written,
};

/// Exports a valid scene; pictures become files in `folder`, a path relative to the text, and are
/// left out without one.
///
/// `None` if meshes or pictures exceed the budget, or if nothing in the file emits light; the sink
/// has the error. It also has a warning for each feature without an exact equivalent.
pub fn emit(
    scene: &Scene,
    source_spans: &SourceSpans,
    folder: Option<&str>,
    budget: &Budget,
    sink: &mut DiagnosticSink,
) -> Option<ExportedScene> {
    let mut reporter = ExportReporter::new(source_spans, sink);
    let scene = &with_meshes(scene, &FORMAT, None, budget, &mut reporter)?;
    let mut writer = PovWriter {
        scene,
        areas: TextureAreas::of(scene),
        folder,
        budget,
        reporter,
        text: String::new(),
        files: BTreeMap::new(),
        shines: false,
    };
    writer.settings();
    writer.camera();
    writer.environment()?;
    writer.lights();
    writer.materials()?;
    writer.surfaces()?;
    writer.reporter.shines(writer.shines)?;
    Some(ExportedScene {
        text: writer.text,
        files: writer.files,
    })
}

/// The scene so far.
struct PovWriter<'w> {
    scene: &'w Scene,
    areas: TextureAreas,
    folder: Option<&'w str>,
    budget: &'w Budget,
    reporter: ExportReporter<'w>,
    text: String,
    files: BTreeMap<String, Vec<u8>>,
    /// Whether anything that is written emits light.
    shines: bool,
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
        /// The most bounces of gathered light.
        const BOUNCES: u32 = 8;
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
        let path = ValuePath::new(EntityKind::Settings, 0, EntityField::Mode);
        let is_path = matches!(mode, Mode::Path(_));
        if is_path {
            let message = "POV-Ray gathers the light between surfaces at few points (radiosity): \
                           paths are not traced";
            self.reporter.unsupported(message, path);
        } else if *mode != Mode::Phong || *toon {
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
        let bounds_medium = |material: &Material| match material {
            Material::Standard(m) => m.interior.is_some() || m.exterior.is_some(),
            Material::Phong(_) => false,
        };
        if self.scene.medium.is_some() || self.scene.materials.iter().any(bounds_medium) {
            let message = "participating media are left out";
            let path = ValuePath::new(EntityKind::Medium, 0, EntityField::Whole);
            self.reporter.unsupported(message, path);
        }
        self.reporter.own_settings(self.scene);
        // Write the settings.
        self.line(&format!(
            "// povray +W{width} +H{height} +FN File_Gamma=1.0{samples}\n#version 3.7;"
        ));
        let levels = levels.min(MAX[0]);
        let radiosity = match is_path {
            true => format!(
                " radiosity {{ pretrace_start 0.08 pretrace_end 0.01 count 400 nearest_count 8 \
                 error_bound 0.3 recursion_limit {} low_error_factor 0.7 gray_threshold 0 \
                 minimum_reuse 0.005 brightness 1 }}",
                levels.clamp(1, BOUNCES)
            ),
            false => String::new(),
        };
        self.line(&format!(
            "global_settings {{ assumed_gamma 1 ambient_light rgb 1 max_trace_level {levels} \
             adc_bailout 0{radiosity} }}"
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
            let path = ValuePath::new(EntityKind::Camera, 0, EntityField::Whole);
            self.reporter.unsupported(message, path);
        }
        let [right, up, view_direction] = [right, up, view_direction].map(|v| vector(v.to_array()));
        let eye = vector(*eye);
        self.line(&format!(
            "camera {{ {kind} location {eye} direction {view_direction} right {right} up {up} }}"
        ));
    }
}

/// A vector in POV-Ray syntax.
fn vector(numbers: impl IntoIterator<Item = f64>) -> String {
    format!("<{}>", joined(numbers, ", "))
}
