//! Overrides of settings: values that replace those of a scene before it is validated.

use rtc_ir::{Material, Mode, Scene};

/// Values that replace those of the scene.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Overrides {
    /// Width and height in pixels. The image plane keeps its height, so the pixel size changes.
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
}

impl Overrides {
    /// These overrides, and `others` where these have no value.
    #[must_use]
    pub fn or(self, others: Self) -> Self {
        Self {
            size: self.size.or(others.size),
            supersampling: self.supersampling.or(others.supersampling),
            aperture_samples: self.aperture_samples.or(others.aperture_samples),
            light_samples: self.light_samples.or(others.light_samples),
            glossy_samples: self.glossy_samples.or(others.glossy_samples),
            depth: self.depth.or(others.depth),
            spp: self.spp.or(others.spp),
        }
    }

    /// Writes the given values into `scene`.
    pub fn apply(&self, scene: &mut Scene) {
        let Self {
            size,
            supersampling,
            aperture_samples,
            light_samples,
            glossy_samples,
            depth,
            spp,
        } = *self;
        if let Some(size) = size {
            let ratio = f64::from(scene.camera.size[1]) / f64::from(size[1]);
            scene.camera.right = scene.camera.right.map(|component| component * ratio);
            scene.camera.up = scene.camera.up.map(|component| component * ratio);
            scene.camera.size = size;
        }
        if let Some(samples) = glossy_samples {
            let lobes = scene
                .materials
                .iter_mut()
                .filter_map(Material::phong_mut)
                .map(|phong| &mut phong.glossy_samples);
            lobes
                .filter(|count| **count > 1)
                .for_each(|count| *count = samples);
        }
        if let (Some(spp), Mode::Path(path)) = (spp, &mut scene.settings.mode) {
            path.samples = spp;
        }
        scene.camera.lens.samples = aperture_samples.unwrap_or(scene.camera.lens.samples);
        scene.settings.light_samples = light_samples.unwrap_or(scene.settings.light_samples);
        scene.settings.supersampling = supersampling.unwrap_or(scene.settings.supersampling);
        scene.settings.max_depth = depth.unwrap_or(scene.settings.max_depth);
    }
}
