//! Facts about a scene before any rule is applied, and the results of the rules, for the Whitted
//! integrator.

use super::light::LightRuleResults;
use super::rules::{Rule, RuleSet};
use super::summary::{ConstantTextures, MapUse, MaterialSummary};
use super::surface_bounds::{SurfaceBounds, surface_bounds};
use super::visibility::VisibleSurfaces;
use super::{WhittedFeatures, facts, summary};
use rtc_math::IdTable;
use rtc_valid::{CourseLight, Material, Mesh, Mode, Pattern, Phong, Shape, Surface, ValidScene};

/// Facts about a scene before any rule is applied.
pub(super) struct SceneFacts<'scene> {
    pub(super) scene: &'scene ValidScene,
    pub(super) rules: RuleSet,
    /// The lights of the integrator.
    pub(super) sources: IdTable<CourseLight>,
    /// The materials of the integrator.
    pub(super) materials: IdTable<Material, Phong>,
    /// The bounds of each surface.
    pub(super) surface_bounds: Vec<SurfaceBounds>,
    /// The summary of each surface's material.
    pub(super) summaries: Vec<MaterialSummary>,
    /// The values of the constant textures.
    pub(super) constants: ConstantTextures,
    /// For each mesh, whether the three normals of every triangle are equal.
    pub(super) has_flat_normals: IdTable<Mesh, bool>,
}

impl<'scene> SceneFacts<'scene> {
    pub(super) fn new(scene: &'scene ValidScene, rules: RuleSet) -> Self {
        let constants = if rules.contains(Rule::TextureConstant) {
            ConstantTextures::of(scene)
        } else {
            ConstantTextures::none(scene)
        };
        let materials = facts::material::phongs(scene.materials());
        let summary = |surface: &Surface| {
            MaterialSummary::of(surface, &materials[surface.material], scene, &constants)
        };
        let summaries = scene.surfaces().iter().map(summary).collect();
        let has_flat_normals = scene
            .meshes()
            .iter()
            .map(|mesh| summary::is_even(mesh))
            .collect();
        Self {
            scene,
            rules,
            sources: facts::light::course(scene.lights()),
            materials,
            surface_bounds: surface_bounds(scene),
            summaries,
            constants,
            has_flat_normals,
        }
    }

    /// The rule, if it may be applied.
    pub(super) fn allowed(&self, rule: Rule) -> Option<Rule> {
        Some(rule).filter(|rule| self.rules.contains(*rule))
    }

    /// Whether the three shading normals of every triangle of a surface are equal.
    pub(super) fn is_even(&self, surface: usize) -> bool {
        let shape = &self.scene.surfaces()[surface].shape;
        let Shape::Instance(instance) = shape else {
            return true;
        };
        self.rules.contains(Rule::NormalFlat) && self.has_flat_normals[instance.mesh]
    }

    /// Whether all camera rays start at the eye.
    pub(super) fn is_pinhole(&self) -> bool {
        is_pinhole(self.scene)
    }
}

/// Whether all camera rays of a scene start at the eye.
pub(super) fn is_pinhole(scene: &ValidScene) -> bool {
    let lens = &scene.camera().lens;
    lens.radius.get() == 0.0
        || lens.samples.get() == 1
        || matches!(scene.settings().mode, Mode::Depth)
}

/// The results of the rules.
pub(super) struct RuleResults<'scene> {
    pub(super) facts: SceneFacts<'scene>,
    pub(super) visibility: VisibleSurfaces,
    pub(super) lights: LightRuleResults,
    /// The number of bounces in the plan.
    pub(super) max_depth: u32,
    /// The number of bounces that the scene requests.
    pub(super) requested: u32,
}

impl RuleResults<'_> {
    pub(super) fn mode(&self) -> &Mode {
        &self.facts.scene.settings().mode
    }

    /// The visible surfaces, directly or by reflection.
    pub(super) fn visible(&self) -> impl Iterator<Item = usize> {
        (0..self.facts.surface_bounds.len()).filter(|surface| self.visibility.visible[*surface])
    }

    /// The Phong material of a surface.
    pub(super) fn phong(&self, surface: usize) -> &Phong {
        &self.facts.materials[self.facts.scene.surfaces()[surface].material]
    }

    /// Whether the material of any visible surface has a property.
    pub(super) fn any(&self, shows: impl Fn(&MaterialSummary) -> bool) -> bool {
        self.visible()
            .any(|surface| shows(&self.facts.summaries[surface]))
    }

    pub(super) fn is_shaded(&self) -> bool {
        matches!(self.mode(), Mode::Phong | Mode::Gooch(_))
    }

    pub(super) fn is_phong(&self) -> bool {
        matches!(self.mode(), Mode::Phong)
    }

    /// Whether a light contributes more than its ambient term to a surface.
    pub(super) fn is_illuminated(&self, summary: &MaterialSummary) -> bool {
        summary.is_illuminated() && self.lights.plans.iter().any(|light| light.direct)
    }

    /// Whether the picture depends on the shading normals of a material.
    pub(super) fn shows_normal(&self, summary: &MaterialSummary) -> bool {
        match self.mode() {
            Mode::Depth => false,
            Mode::Normal | Mode::Path(_) => true,
            Mode::Gooch(_) => !self.lights.plans.is_empty(),
            Mode::Phong => {
                self.is_illuminated(summary) || (summary.has_bounce() && self.max_depth > 0)
            }
        }
    }

    /// Whether the picture depends on the colour texture of a material.
    pub(super) fn shows_color_map(&self, summary: &MaterialSummary) -> bool {
        let varies = summary.color_map == MapUse::Varying;
        self.is_shaded() && varies && (summary.ambient || summary.diffuse)
    }

    /// Whether the picture depends on the ks texture of a material.
    pub(super) fn shows_specular_map(&self, summary: &MaterialSummary) -> bool {
        self.is_shaded() && summary.specular_map == MapUse::Varying && summary.is_specular
    }

    /// Whether shadow rays are needed.
    pub(super) fn casts_shadows(&self) -> bool {
        self.lights.shadow.is_some()
    }

    /// Whether an area light is sampled.
    pub(super) fn is_soft(&self) -> bool {
        let settings = self.facts.scene.settings();
        let lights = self.facts.sources.iter().zip(&self.lights.plans);
        let soft = lights
            .filter(|(light, plan)| light.radius.get() > 0.0 && plan.direct)
            .count();
        self.is_phong() && settings.light_samples.get() > 1 && soft > 0
    }

    /// Whether a glossy lobe is sampled.
    pub(super) fn is_glossy(&self) -> bool {
        self.max_depth > 0 && self.any(|summary| summary.glossy && summary.has_bounce())
    }

    /// Whether a pixel has several camera rays, or camera rays off its centre.
    pub(super) fn is_sampled(&self) -> bool {
        let settings = self.facts.scene.settings();
        let several = settings.supersampling.get() > 1 || settings.pattern != Pattern::Grid;
        several && !matches!(settings.mode, Mode::Depth)
    }

    /// The smallest feature set that renders the picture.
    pub(super) fn features(&self) -> WhittedFeatures {
        let rules = self.facts.rules;
        // Define when a material needs each feature.
        let bends = |summary: &MaterialSummary| {
            summary.has_shading_normals()
                && (self.shows_normal(summary) || !rules.contains(Rule::NormalFlat))
        };
        let colors = |summary: &MaterialSummary| {
            let shows = self.shows_color_map(summary) || self.shows_specular_map(summary);
            shows || (summary.has_map() && !rules.contains(Rule::TextureUnseen))
        };
        let is_specular =
            |summary: &MaterialSummary| summary.is_specular && self.is_illuminated(summary);
        let illuminated = self.any(|summary| self.is_illuminated(summary))
            || !rules.contains(Rule::LightUnreached);
        // Collect the needed features.
        let mut features = WhittedFeatures::NONE;
        let mut add = |feature, condition: bool| {
            features = if condition {
                features.with(feature)
            } else {
                features
            }
        };
        add(
            WhittedFeatures::CAMERA,
            self.is_sampled() || !self.facts.is_pinhole(),
        );
        add(
            WhittedFeatures::MAPS,
            self.any(|summary| bends(summary) || colors(summary)),
        );
        add(WhittedFeatures::LIGHT, self.is_phong() && illuminated);
        add(
            WhittedFeatures::HIGHLIGHT,
            self.is_shaded() && self.any(is_specular),
        );
        let is_drawing = matches!(self.mode(), Mode::Gooch(_)) || self.facts.scene.settings().toon;
        add(WhittedFeatures::GOOCH, is_drawing);
        add(WhittedFeatures::SHADOW, self.casts_shadows());
        add(WhittedFeatures::BOUNCE, self.max_depth > 0);
        add(WhittedFeatures::SAMPLED, self.is_soft() || self.is_glossy());
        add(
            WhittedFeatures::UNPRUNED,
            !rules.contains_all(RuleSet::AT_HITS),
        );
        features
    }
}
