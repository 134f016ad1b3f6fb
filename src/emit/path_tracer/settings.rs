//! Settings of a scene for a path tracer.

use crate::reporter::ExportReporter;
use rtc_ir::{Display, EntityField, EntityKind, Mode, PathSettings, Scene, Settings, ValuePath};
use rtc_math::PixelFilter;

impl ExportReporter<'_> {
    /// The number of samples of a pixel. Reports the settings that a renderer lacks.
    pub(crate) fn path_samples(&mut self, scene: &Scene, renderer: &str) -> u32 {
        let settings = &scene.settings;
        let samples = match &settings.mode {
            Mode::Path(PathSettings {
                samples,
                multiple_scattering: _,
                caustics: _,
                filter: _,
            }) => *samples,
            Mode::Phong | Mode::Depth | Mode::Normal | Mode::Gooch(_) => {
                let message = format!(
                    "{renderer} traces paths, and this scene uses another integrator: \
                     `--integrator path` renders the exported scene"
                );
                let path = ValuePath::new(EntityKind::Settings, 0, EntityField::Mode);
                self.unsupported(&message, path);
                settings.supersampling.saturating_pow(2)
            }
        };
        self.own_settings(scene);
        let Display { exposure, tone } = &scene.display;
        if *exposure != 0.0 || tone.is_some() {
            let message =
                format!("exposure and tone map are left out: {renderer} writes linear values");
            let path = ValuePath::new(EntityKind::Settings, 0, EntityField::Whole);
            self.unsupported(&message, path);
        }
        samples
    }
}

/// The filter of the pixels.
pub(crate) fn pixel_filter(settings: &Settings) -> PixelFilter {
    match &settings.mode {
        Mode::Path(path) => path.filter,
        Mode::Phong | Mode::Depth | Mode::Normal | Mode::Gooch(_) => PixelFilter::PIXEL,
    }
}

/// The greatest number of bounces of a path. Phong's model lights every hit directly, also one
/// without reflections.
pub(crate) fn bounces(settings: &Settings) -> u32 {
    let more = u32::from(!matches!(settings.mode, Mode::Path(_)));
    settings.max_depth.saturating_add(more).min(i32::MAX as u32)
}
