//! The verdict on each effect of traced paths, derived from the final draft.

use super::draft::{Applied, Draft, is_asked_by};
use crate::ir::{Field, Noun, Place};
use crate::plan::effect::{Effect, State, Verdict};
use crate::valid::Standard;

/// The most places named for one verdict.
const FEW: usize = 3;

/// A verdict on each effect that paths may have.
pub(super) fn verdicts(asked: &Draft<'_>, left: &Draft<'_>, applied: &[Applied]) -> Vec<Verdict> {
    Effect::OF_PATHS
        .into_iter()
        .map(|effect| verdict(effect, asked, left, applied))
        .collect()
}

fn verdict(effect: Effect, asked: &Draft<'_>, left: &Draft<'_>, applied: &[Applied]) -> Verdict {
    let spared = || {
        applied
            .iter()
            .find(|applied| applied.spared.contains(&effect))
    };
    let (state, rule, because, mut facts) = if left.asks(effect) {
        (
            State::Needed,
            None,
            left.because(effect),
            left.places(effect),
        )
    } else if let Some(Applied { rule, places, .. }) = spared().filter(|_| asked.asks(effect)) {
        (
            State::Pruned,
            Some(rule.rule),
            rule.because.to_owned(),
            places.clone(),
        )
    } else {
        (State::Absent, None, absence(effect).to_owned(), Vec::new())
    };
    facts.truncate(FEW);
    Verdict {
        effect,
        of: None,
        state,
        rule,
        because,
        facts,
    }
}

/// Why a scene does not ask for an effect.
fn absence(effect: Effect) -> &'static str {
    match effect {
        Effect::Surfaces => "the scene has none",
        Effect::Supersampling => "one path a pixel",
        Effect::Lens => "a pinhole: the lens has radius 0",
        Effect::Environment => "the scene has no environment",
        Effect::Emission => "no material emits light",
        Effect::Unlit => "no material is unlit",
        Effect::Alpha => "all materials are opaque",
        Effect::DirectLight => "there is no light to aim at",
        Effect::Shadows => "no light is aimed at",
        Effect::Mis => "no light can be found both by aiming and by scattering",
        Effect::Depth => "no path goes on",
        Effect::Refraction => "no material transmits light",
        Effect::Volume => "no medium absorbs light",
        Effect::Dispersion => "no material disperses light",
        Effect::Microfacets => "no material reflects at its boundary",
        Effect::Compensation => "no light bounces between microfacets",
        Effect::Clearcoat => "no material has a clearcoat",
        Effect::Sheen => "no material has sheen",
        Effect::Anisotropy => "no material is anisotropic",
        Effect::Iridescence => "no material is iridescent",
        Effect::Textures => "no material has a texture",
        Effect::NormalMapping => "no material has a normal map",
        Effect::NormalInterpolation => "no mesh has normals",
        Effect::VertexColors => "no mesh has colours at its corners",
        Effect::DepthBuffer
        | Effect::NormalBuffer
        | Effect::SoftLight
        | Effect::Highlight
        | Effect::Mirror
        | Effect::GlossyReflection => "paths know no such effect",
    }
}

impl Draft<'_> {
    /// Why the picture needs an effect.
    fn because(&self, effect: Effect) -> String {
        let of_materials = self.materials_with(effect).count();
        match effect {
            _ if of_materials > 0 => counted(of_materials, "material"),
            Effect::Surfaces => {
                let left = self.surfaces.iter().filter(|is_left| **is_left).count();
                format!("{left} of {} may be met by a ray", self.surfaces.len())
            }
            Effect::Supersampling => counted(self.path.samples.get() as usize, "path") + " a pixel",
            Effect::Lens => format!("a lens of radius {}", self.scene.camera().lens.radius.get()),
            Effect::Environment => "paths that leave the scene find light".to_owned(),
            Effect::DirectLight => "a surface is lit by a light that can be aimed at".to_owned(),
            Effect::Shadows => "a surface may hide a light from another, or from itself".to_owned(),
            Effect::Mis => "aiming and scattering find the same light".to_owned(),
            Effect::Depth => {
                let bounces = self.max_depth - u32::from(!self.last_ray);
                format!("at most {}", counted(bounces as usize, "bounce"))
            }
            Effect::Compensation => "light bounces between the facets of rough surfaces".to_owned(),
            Effect::NormalInterpolation => "a mesh has normals at its corners".to_owned(),
            Effect::NormalMapping => "a material has a normal map".to_owned(),
            Effect::VertexColors => "a mesh has colours at its corners".to_owned(),
            Effect::Textures => "a material has a texture".to_owned(),
            Effect::Emission
            | Effect::Unlit
            | Effect::Alpha
            | Effect::Microfacets
            | Effect::Refraction
            | Effect::Volume
            | Effect::Dispersion
            | Effect::Clearcoat
            | Effect::Sheen
            | Effect::Anisotropy
            | Effect::Iridescence
            | Effect::DepthBuffer
            | Effect::NormalBuffer
            | Effect::SoftLight
            | Effect::Highlight
            | Effect::Mirror
            | Effect::GlossyReflection => String::new(),
        }
    }

    /// The values that make an effect necessary.
    fn places(&self, effect: Effect) -> Vec<Place> {
        let material = |index| Place::new(Noun::Material, index, Field::Whole);
        let materials: Vec<_> = self
            .materials_with(effect)
            .map(material)
            .take(FEW)
            .collect();
        let (noun, field) = match effect {
            _ if !materials.is_empty() => return materials,
            Effect::Textures | Effect::NormalMapping => {
                let has_map = |(_, m): &(usize, &Standard)| m.maps().next().is_some();
                return self
                    .used()
                    .filter(has_map)
                    .map(|(index, _)| material(index))
                    .collect();
            }
            Effect::Environment => (Noun::Environment, Field::Whole),
            Effect::Lens => (Noun::Camera, Field::LensRadius),
            Effect::Supersampling | Effect::Compensation => (Noun::Settings, Field::Mode),
            Effect::Depth => (Noun::Settings, Field::MaxDepth),
            Effect::DirectLight | Effect::Shadows | Effect::Mis => (Noun::Light, Field::Whole),
            Effect::Surfaces
            | Effect::NormalInterpolation
            | Effect::VertexColors
            | Effect::Emission
            | Effect::Unlit
            | Effect::Alpha
            | Effect::Microfacets
            | Effect::Refraction
            | Effect::Volume
            | Effect::Dispersion
            | Effect::Clearcoat
            | Effect::Sheen
            | Effect::Anisotropy
            | Effect::Iridescence
            | Effect::DepthBuffer
            | Effect::NormalBuffer
            | Effect::SoftLight
            | Effect::Highlight
            | Effect::Mirror
            | Effect::GlossyReflection => (Noun::Surface, Field::Whole),
        };
        vec![Place::new(noun, 0, field)]
    }

    /// The materials that ask for an effect by themselves.
    fn materials_with(&self, effect: Effect) -> impl Iterator<Item = usize> {
        let asks = move |(_, material): &(usize, &Standard)| is_asked_by(material, effect);
        self.used().filter(asks).map(|(index, _)| index)
    }
}

fn counted(count: usize, noun: &str) -> String {
    format!("{count} {noun}{}", if count == 1 { "" } else { "s" })
}
