//! The settings of path tracing, and the decision whether a scene is path traced.

use super::assets::AssetTarget;
use super::decode::Spanned;
use super::filter::FilterSetting;
use super::lower::Lowering;
use super::number::Count;
use super::record::{FieldResult, record};
use super::settings::{Mode, Scene};
use rtc_ir as ir;
use rtc_math::PixelFilter;

record! {
    /// The settings of path tracing.
    struct PathParameters, "path parameters" {
        /// The number of paths for each ray of `SuperSampling`. Without `PathParameters` it is 1;
        /// without both a pixel has 64 paths.
        samples: Spanned<Count>, default(Count(64)), &[&["samples"]];
        /// Whether light that bounces several times between the microfacets of a rough surface is
        /// kept (energy compensation).
        multiple_scattering: Spanned<bool>, default(true), &[&["multipleScattering"]];
        /// Whether the caustics of small lights by smooth mirrors and clear glass are estimated
        /// (manifold sampling). Otherwise paths find them by chance, and those of point lights not
        /// at all.
        caustics: Spanned<bool>, default(false), &[&["caustics"]];
        /// The reconstruction filter of the pixels: how the light around the middle of a pixel is
        /// weighted.
        filter: Spanned<FilterSetting>, default(FilterSetting(PixelFilter::PIXEL)), &[&["filter"]];
    }
}

impl Lowering {
    /// Whether the scene has something that only path tracing renders, among its lights those of
    /// `is_traced`.
    pub(super) fn is_physical(&self, is_traced: impl Fn(&ir::Light) -> bool) -> bool {
        let ir::Scene {
            environment,
            medium,
            lights,
            materials,
            ..
        } = &self.scene;
        let mut pending_assets = self.files.pending_assets.iter();
        environment.is_some()
            || medium.is_some()
            || lights.iter().any(is_traced)
            || materials.iter().any(|material| material.phong().is_none())
            || pending_assets.any(|pending| matches!(pending.target, AssetTarget::Gltf(_)))
    }

    /// Selects path tracing if the file requests it, or if the scene needs a feature of path
    /// tracing. Call it after the lights and the objects.
    pub(super) fn resolve_mode(&mut self, scene: &Scene) {
        let Scene {
            mode,
            sampling,
            depth,
            reflections,
            ..
        } = scene;
        let is_physical = self.is_physical(|light| light.point().is_none());
        if mode.value != Mode::Path && (mode.span.is_some() || !is_physical) {
            return;
        }
        // The samples per pixel.
        let rays = sampling
            .value
            .factor
            .0
            .saturating_mul(sampling.value.factor.0);
        let default = ir::PathSettings::default();
        let settings = &mut self.scene.settings;
        settings.mode = ir::Mode::Path(match &scene.paths {
            FieldResult::Read(paths) => ir::PathSettings {
                samples: paths.value.samples.value.0,
                multiple_scattering: paths.value.multiple_scattering.value,
                caustics: paths.value.caustics.value,
                filter: paths.value.filter.value.0,
            },
            FieldResult::Absent | FieldResult::Broken => {
                settings.supersampling = 1;
                let samples = if sampling.span.is_some() {
                    rays
                } else {
                    default.samples
                };
                ir::PathSettings { samples, ..default }
            }
        });
        // The default depth of path tracing.
        if depth.span.is_none() && reflections.is_absent() {
            settings.max_depth = ir::PathSettings::DEPTH;
        }
    }
}
