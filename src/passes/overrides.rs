//! Overrides of settings: values that replace those of a scene before it is validated.
//!
//! Each row of [`CountSetting::ALL`] is a number that can be overridden. It defines the flag of
//! `rtc render` with its help, the key of `rtc.toml`, and how the number changes a scene.

use rtc_ir::{Material, Mode, Scene};

/// Values that replace those of the scene.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Overrides {
    /// Width and height in pixels. The picture shows at least what it shows without.
    pub size: Option<[u32; 2]>,
    /// Sub-samples along each side of a pixel.
    pub supersampling: Option<u32>,
    /// Lens samples per sub-sample.
    pub aperture_samples: Option<u32>,
    /// Samples of each area light.
    pub light_samples: Option<u32>,
    /// Rays of each glossy lobe; perfect reflections stay.
    pub glossy_samples: Option<u32>,
    /// Bounces after the first hit.
    pub depth: Option<u32>,
    /// Paths per pixel, for path tracing.
    pub spp: Option<u32>,
    /// Whether the caustics of small lights are estimated, for path tracing.
    pub caustics: Option<bool>,
}

/// A number of samples or bounces that replaces that of a scene.
#[derive(Debug)]
pub struct CountSetting {
    /// The flag without `--`, and the key in `rtc.toml`.
    pub name: &'static str,
    /// What the flag does, for its help.
    pub help: &'static str,
    /// The least value.
    pub least: u32,
    /// The value in the overrides.
    pub of: fn(&mut Overrides) -> &mut Option<u32>,
    /// Replaces the number of a scene.
    set: fn(&mut Scene, u32),
}

impl CountSetting {
    /// All of them, in the order of the help.
    pub const ALL: [Self; 6] = [
        Self {
            name: "supersampling",
            help: "Take N × N samples in each pixel",
            least: 1,
            of: |overrides| &mut overrides.supersampling,
            set: |scene, side| scene.settings.supersampling = side,
        },
        Self {
            name: "aperture-samples",
            help: "Sample N points of the lens for each sample of a pixel",
            least: 1,
            of: |overrides| &mut overrides.aperture_samples,
            set: |scene, points| scene.camera.lens.samples = points,
        },
        Self {
            name: "light-samples",
            help: "Sample N points of each soft light",
            least: 1,
            of: |overrides| &mut overrides.light_samples,
            set: |scene, points| scene.settings.light_samples = points,
        },
        Self {
            name: "glossy-samples",
            help: "Trace N rays for each glossy reflection",
            least: 1,
            of: |overrides| &mut overrides.glossy_samples,
            set: |scene, rays| {
                let lobes = scene.materials.iter_mut().filter_map(Material::phong_mut);
                let counts = lobes.map(|phong| &mut phong.glossy_samples);
                counts
                    .filter(|count| **count > 1)
                    .for_each(|count| *count = rays);
            },
        },
        Self {
            name: "spp",
            help: "Trace N paths in each pixel, in path-traced scenes",
            least: 1,
            of: |overrides| &mut overrides.spp,
            set: |scene, paths| {
                if let Mode::Path(path) = &mut scene.settings.mode {
                    path.samples = paths;
                }
            },
        },
        Self {
            name: "depth",
            help: "Follow N bounces after the first hit",
            least: 0,
            of: |overrides| &mut overrides.depth,
            set: |scene, bounces| scene.settings.max_depth = bounces,
        },
    ];
}

impl Overrides {
    /// These overrides, and `others` where these have no value.
    #[must_use]
    pub fn or(mut self, mut others: Self) -> Self {
        self.size = self.size.or(others.size);
        self.caustics = self.caustics.or(others.caustics);
        for CountSetting { of, .. } in &CountSetting::ALL {
            *of(&mut self) = of(&mut self).or(*of(&mut others));
        }
        self
    }

    /// Writes the given values into `scene`.
    pub fn apply(mut self, scene: &mut Scene) {
        if let Some(size) = self.size {
            scene.camera.fit(size);
        }
        if let (Some(caustics), Mode::Path(path)) = (self.caustics, &mut scene.settings.mode) {
            path.caustics = caustics;
        }
        for CountSetting { of, set, .. } in &CountSetting::ALL {
            if let Some(value) = *of(&mut self) {
                set(scene, value);
            }
        }
    }
}
