//! A setting: a value for each parameter, which can be read from a scene and written to it.

use super::parameter::{Parameter, arithmetic, precision_value};
use rtc_ir::{Material, Mode, Scene};
use rtc_passes::Overrides;
use rtc_plan::Arithmetic;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A value for each parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub struct Setting {
    /// Sub-samples along each side of a pixel.
    pub supersampling: u32,
    /// Points of the lens.
    pub aperture: u32,
    /// Points of each soft light.
    pub lights: u32,
    /// Rays of each glossy lobe.
    pub glossy: u32,
    /// Paths per pixel; 1 without path tracing.
    pub paths: u32,
    /// Whether caustics of small lights are estimated; false without path tracing.
    #[serde(default)]
    pub caustics: bool,
    /// Whether the picture is denoised.
    #[serde(default)]
    pub denoise: bool,
    /// Bounces after the first hit.
    pub depth: u32,
    /// The arithmetic of ray intersection.
    pub precision: Arithmetic,
}

impl Setting {
    /// The setting of a scene, with the robust arithmetic. If glossy lobes have different numbers
    /// of rays, the largest is used.
    #[must_use]
    pub fn of(scene: &Scene) -> Self {
        let settings = &scene.settings;
        let (supersampling, aperture, paths, caustics) = match &settings.mode {
            Mode::Path(path) => (1, 1, path.samples, path.caustics),
            Mode::Phong | Mode::Depth | Mode::Normal | Mode::Gooch(_) => {
                (settings.supersampling, scene.camera.lens.samples, 1, false)
            }
        };
        Self {
            supersampling,
            aperture,
            lights: scene.settings.light_samples,
            glossy: lobes(scene).max().unwrap_or(1),
            paths,
            caustics,
            denoise: false,
            depth: scene.settings.max_depth,
            precision: Arithmetic::Robust,
        }
    }

    /// The value of a parameter.
    #[must_use]
    pub fn get(&self, parameter: Parameter) -> u32 {
        match parameter {
            Parameter::Supersampling => self.supersampling,
            Parameter::Aperture => self.aperture,
            Parameter::Lights => self.lights,
            Parameter::Glossy => self.glossy,
            Parameter::Paths => self.paths,
            Parameter::Caustics => u32::from(self.caustics),
            Parameter::Denoise => u32::from(self.denoise),
            Parameter::Depth => self.depth,
            Parameter::Precision => precision_value(self.precision),
        }
    }

    /// The setting with another value for a parameter.
    #[must_use]
    pub fn with(mut self, parameter: Parameter, value: u32) -> Self {
        let slot = match parameter {
            Parameter::Supersampling => &mut self.supersampling,
            Parameter::Aperture => &mut self.aperture,
            Parameter::Lights => &mut self.lights,
            Parameter::Glossy => &mut self.glossy,
            Parameter::Paths => &mut self.paths,
            Parameter::Depth => &mut self.depth,
            Parameter::Caustics => {
                self.caustics = value > 0;
                return self;
            }
            Parameter::Denoise => {
                self.denoise = value > 0;
                return self;
            }
            Parameter::Precision => {
                return Self {
                    precision: arithmetic(value),
                    ..self
                };
            }
        };
        *slot = value;
        self
    }

    /// The settings with fewer paths that are tried with denoising.
    pub(super) fn denoised(self) -> impl Iterator<Item = Self> {
        let tried = [self.paths / 4, self.paths / 16].into_iter();
        tried.filter(|paths| *paths >= 2).map(move |paths| Self {
            paths,
            denoise: true,
            ..self
        })
    }

    /// The camera rays per pixel.
    #[must_use]
    pub fn camera_rays(&self) -> f64 {
        Parameter::Supersampling.samples(self.supersampling)
            * f64::from(self.aperture)
            * f64::from(self.paths)
    }

    /// Writes the values into a scene, except precision and denoising.
    pub fn apply(&self, scene: &mut Scene) {
        self.overrides(scene).apply(scene);
    }

    /// The values as overrides of a scene, without precision and denoising. Lobes keep their
    /// numbers of rays if the setting has the largest of them.
    #[must_use]
    pub fn overrides(&self, scene: &Scene) -> Overrides {
        let mut overrides = Overrides::default();
        for parameter in Parameter::ALL {
            if let Some(count) = parameter.count() {
                *(count.of)(&mut overrides) = Some(self.get(parameter));
            }
        }
        overrides.caustics = matches!(scene.settings.mode, Mode::Path(_)).then_some(self.caustics);
        let largest = lobes(scene).max();
        overrides.glossy_samples = overrides.glossy_samples.filter(|own| largest != Some(*own));
        overrides
    }

    /// Formats the given parameters: "4×4 with 16 aperture samples, depth 3". The robust arithmetic
    /// and what is off are not mentioned.
    #[must_use]
    pub fn label(&self, parameters: &[Parameter]) -> String {
        let is_named = |parameter: &&Parameter| {
            (**parameter != Parameter::Precision || self.precision != Arithmetic::Robust)
                && (!parameter.is_switch() || self.get(**parameter) > 0)
        };
        let label: Vec<_> = parameters
            .iter()
            .filter(is_named)
            .map(|parameter| parameter.label(self.get(*parameter)))
            .collect();
        match label.split_first() {
            Some((first, [])) => first.clone(),
            Some((first, rest))
                if parameters[0] == Parameter::Supersampling
                    && parameters[1] != Parameter::Depth =>
            {
                format!("{first} with {}", rest.join(", "))
            }
            Some(_) => label.join(", "),
            None => "the scene as it is".to_owned(),
        }
    }
}

/// The ray numbers of the glossy lobes of a scene.
fn lobes(scene: &Scene) -> impl Iterator<Item = u32> {
    scene
        .materials
        .iter()
        .filter_map(Material::phong)
        .map(|phong| phong.glossy_samples)
        .filter(|count| *count > 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_in_words() {
        let setting = Setting {
            paths: 32,
            ..setting(4, 16, 3)
        };
        let label = |parameters: &[Parameter]| setting.label(parameters);
        assert_eq!(
            label(&[
                Parameter::Supersampling,
                Parameter::Aperture,
                Parameter::Depth
            ]),
            "4×4 with 16 aperture samples, depth 3"
        );
        assert_eq!(
            label(&[Parameter::Supersampling, Parameter::Lights]),
            "4×4 with 1 light sample"
        );
        assert_eq!(
            label(&[Parameter::Supersampling, Parameter::Depth]),
            "4×4, depth 3"
        );
        assert_eq!(
            label(&[Parameter::Paths, Parameter::Depth]),
            "32 paths, depth 3"
        );
        assert_eq!(label(&[]), "the scene as it is");
        assert_eq!(
            label(&[Parameter::Supersampling, Parameter::Precision]),
            "4×4"
        );
        let plain = Setting {
            precision: Arithmetic::Plain,
            ..setting
        };
        assert_eq!(
            plain.label(&[Parameter::Depth, Parameter::Precision]),
            "depth 3, plain arithmetic"
        );
    }

    fn setting(supersampling: u32, aperture: u32, depth: u32) -> Setting {
        let precision = Arithmetic::Robust;
        Setting {
            supersampling,
            aperture,
            lights: 1,
            glossy: 1,
            paths: 1,
            caustics: false,
            denoise: false,
            depth,
            precision,
        }
    }

    #[test]
    fn a_denoised_setting_is_labelled() {
        let setting = setting(1, 1, 3)
            .with(Parameter::Paths, 16)
            .with(Parameter::Denoise, 1);
        let label = setting.label(&[Parameter::Paths, Parameter::Denoise, Parameter::Depth]);
        assert_eq!(label, "16 paths, denoised, depth 3");
        assert_eq!(Parameter::Denoise.argument(1), "--denoise");
    }

    #[test]
    fn a_set_value_is_returned() {
        for parameter in Parameter::ALL {
            assert_eq!(
                setting(9, 9, 9).with(parameter, 1).get(parameter),
                1,
                "{parameter:?}"
            );
        }
    }
}
