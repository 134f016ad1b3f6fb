//! Writes materials: diffuse materials, metals with an index, plastics and perfect mirrors are
//! exact; others are approximated.

use super::MitsubaWriter;
use crate::approximation::without_index;
use crate::export::{called, enumeration, facet_widths};
use crate::path_tracer::{
    SurfaceMaterial, TextureChannel, TexturedFactor, blend_weight, is_glass, is_null, media,
    missing_features, opacity, other_material,
};
use rtc_ir::{Conductor, EntityField, EntityKind, Standard, ValuePath};
use rtc_math::{Medium, Microfacets, Plastic, shortest};
use std::collections::BTreeSet;

/// The normal-incidence reflectance of a dielectric with `specular` = 1 in Mitsuba's `principled`
/// plugin (Burley, "Physically based shading at Disney", 2012, section 5.2).
const PRINCIPLED: f64 = 0.08;

/// The last letters of the ids of media inside and outside.
pub(super) const MEDIA: [char; 2] = ['v', 'o'];

/// The least index of refraction that is written: Mitsuba's rough glass needs one that differs from
/// that of the outside.
const LEAST_IOR: f64 = 1.0001;

impl MitsubaWriter<'_> {
    /// Writes the materials of surfaces; `None` if their pictures exceed the budget.
    pub(super) fn materials(&mut self) -> Option<()> {
        let scene = self.scene;
        let mut reported = BTreeSet::new();
        for variant in SurfaceMaterial::all(scene) {
            let index = variant.material as usize;
            let path = ValuePath::new(EntityKind::Material, index, EntityField::Whole);
            let material = variant.standard(scene);
            if is_null(&material) {
                self.line(1, &format!(r#"<bsdf type="null" id="{}"/>"#, variant.id()));
                self.volume(variant, &material);
                continue;
            }
            if reported.insert(index) {
                let mut next = Some(material.clone());
                while let Some(part) = next {
                    let (shown, plugin, message) = shown(&part);
                    self.report_material(&shown, (plugin, message), path);
                    next = other_material(scene, &part);
                }
            }
            let id = format!(r#" id="{}""#, variant.id());
            self.material((1, &id), variant, &material, path)?;
            self.volume(variant, &material);
        }
        Some(())
    }

    fn report_material(
        &mut self,
        material: &Standard,
        (plugin, message): (MitsubaPlugin, Option<&str>),
        path: ValuePath,
    ) {
        let name = called(&material.name);
        let own = [
            (
                material.diffuse_transmission > 0.0,
                "the scattered light that goes through",
            ),
            (
                material.plastic != Plastic::None && !matches!(plugin, MitsubaPlugin::Plastic(_)),
                "the light that its plastic reflects inside",
            ),
        ];
        let missing_features = missing_features(self.scene, material, &own);
        if !missing_features.is_empty() {
            let missing = enumeration(&missing_features);
            let message = format!("{name} is written without {missing}");
            self.beside.reporter.unsupported(&message, path);
        }
        if let Some(message) = message {
            self.beside
                .reporter
                .unsupported(&format!("{name}: {message}"), path);
        }
        if material.emissive != [0.0; 3] {
            let message = format!(
                "{name} shines both ways: Mitsuba's emitters shine to the front alone, or outwards"
            );
            self.beside.reporter.unsupported(&message, path);
        }
    }

    /// A material or a blend.
    fn material(
        &mut self,
        (depth, id): (usize, &str),
        variant: SurfaceMaterial,
        material: &Standard,
        path: ValuePath,
    ) -> Option<()> {
        let Some(other) = other_material(self.scene, material) else {
            return self.part((depth, id), variant, material, path);
        };
        let first = Standard {
            blend_with: None,
            ..material.clone()
        };
        self.line(depth, &format!(r#"<bsdf type="blendbsdf"{id}>"#));
        self.slot(depth + 1, "weight", blend_weight(material), path)?;
        self.part((depth + 1, ""), variant, &first, path)?;
        self.material((depth + 1, ""), variant, &other, path)?;
        self.line(depth, "</bsdf>");
        Some(())
    }

    /// A material that is no blend.
    fn part(
        &mut self,
        (outer, id): (usize, &str),
        variant: SurfaceMaterial,
        material: &Standard,
        path: ValuePath,
    ) -> Option<()> {
        let (material, plugin, _) = shown(material);
        let material = &material;
        // A mask applies the opacity.
        let cut = opacity(material, variant.has_opacity);
        let (depth, inner_id) = match &cut {
            Some(_) => (outer + 1, ""),
            None => (outer, id),
        };
        if let Some(opacity) = cut {
            self.line(outer, &format!(r#"<bsdf type="mask"{id}>"#));
            self.slot(depth, "opacity", opacity, path)?;
        }
        // A partly transmissive material blends layers with glass.
        let is_mixed = plugin == MitsubaPlugin::Layered && material.transmission > 0.0;
        if is_mixed {
            self.line(depth, &format!(r#"<bsdf type="blendbsdf"{inner_id}>"#));
            let weight = TexturedFactor {
                factor: [material.transmission; 3],
                map: material.transmission_map.as_ref(),
                channel: TextureChannel::Red,
            };
            self.slot(depth + 1, "weight", weight, path)?;
            self.two_sided(depth + 1, "", variant, (plugin, material), path)?;
            let glass = MitsubaPlugin::glass(material);
            self.bsdf(depth + 1, "", variant, (glass, material), path)?;
            self.line(depth, "</bsdf>");
        } else if matches!(plugin, MitsubaPlugin::Glass(_)) {
            self.bsdf(depth, inner_id, variant, (plugin, material), path)?;
        } else {
            self.two_sided(depth, inner_id, variant, (plugin, material), path)?;
        }
        // Close the mask.
        if depth > outer {
            self.line(outer, "</bsdf>");
        }
        Some(())
    }

    /// Materials that light does not cross have two sides, or a black back.
    fn two_sided(
        &mut self,
        depth: usize,
        id: &str,
        variant: SurfaceMaterial,
        material: (MitsubaPlugin, &Standard),
        path: ValuePath,
    ) -> Option<()> {
        if material.1.black_back {
            return self.bsdf(depth, id, variant, material, path);
        }
        self.line(depth, &format!(r#"<bsdf type="twosided"{id}>"#));
        self.bsdf(depth + 1, "", variant, material, path)?;
        self.line(depth, "</bsdf>");
        Some(())
    }

    fn bsdf(
        &mut self,
        depth: usize,
        id: &str,
        variant: SurfaceMaterial,
        (plugin, material): (MitsubaPlugin, &Standard),
        path: ValuePath,
    ) -> Option<()> {
        if let Some(slot) = TexturedFactor::heights(material) {
            self.line(depth, &format!(r#"<bsdf type="bumpmap"{id}>"#));
            self.value(depth + 1, "float", "scale", &shortest(material.bump_scale));
            self.slot(depth + 1, "heights", slot, path)?;
            let smooth = Standard {
                bump_map: None,
                ..material.clone()
            };
            self.bsdf(depth + 1, "", variant, (plugin, &smooth), path)?;
            self.line(depth, "</bsdf>");
            return Some(());
        }
        let Some(slot) = TexturedFactor::normal(material) else {
            return self.base(depth, id, variant, (plugin, material), path);
        };
        self.line(depth, &format!(r#"<bsdf type="normalmap"{id}>"#));
        self.slot(depth + 1, "normalmap", slot, path)?;
        self.base(depth + 1, "", variant, (plugin, material), path)?;
        self.line(depth, "</bsdf>");
        Some(())
    }

    fn base(
        &mut self,
        depth: usize,
        id: &str,
        variant: SurfaceMaterial,
        (plugin, material): (MitsubaPlugin, &Standard),
        path: ValuePath,
    ) -> Option<()> {
        let inner = depth + 1;
        self.line(
            depth,
            &format!(r#"<bsdf type="{}"{id}>"#, plugin.shape_name(material)),
        );
        let color = TexturedFactor::color(material, variant.has_colors);
        match plugin {
            MitsubaPlugin::Black => self.rgb(inner, "reflectance", [0.0; 3]),
            MitsubaPlugin::Diffuse => self.slot(inner, "reflectance", color, path)?,
            MitsubaPlugin::Mirror => {
                self.value(inner, "string", "material", "none");
                self.slot(inner, "specular_reflectance", color, path)?;
            }
            MitsubaPlugin::Conductor(Conductor { eta, k }) => {
                self.rgb(inner, "eta", eta);
                self.rgb(inner, "k", k);
                self.roughness(inner, material);
                self.slot(inner, "specular_reflectance", color, path)?;
            }
            MitsubaPlugin::Plastic(_) => {
                self.dielectric_interface(inner, material);
                self.slot(inner, "diffuse_reflectance", color, path)?;
                let specular = material.specular_color.map(|part| part * material.specular);
                if specular != [1.0; 3] {
                    self.rgb(inner, "specular_reflectance", specular);
                }
                if material.plastic == Plastic::Nonlinear {
                    self.value(inner, "boolean", "nonlinear", "true");
                }
            }
            MitsubaPlugin::Glass(_) => {
                self.dielectric_interface(inner, material);
                self.slot(inner, "specular_transmittance", color, path)?;
            }
            MitsubaPlugin::Layered => {
                let factor = plugin.color(material, color.factor);
                self.slot(
                    inner,
                    "base_color",
                    TexturedFactor { factor, ..color },
                    path,
                )?;
                self.layers(inner, material, path)?;
            }
        }
        self.line(depth, "</bsdf>");
        Some(())
    }

    /// The interface of a dielectric with air.
    fn dielectric_interface(&mut self, depth: usize, material: &Standard) {
        let ior = shortest(material.ior.max(LEAST_IOR));
        self.value(depth, "float", "int_ior", &ior);
        self.value(depth, "float", "ext_ior", "1");
        self.roughness(depth, material);
    }

    /// The widths along u and v (`KHR_materials_anisotropy`) and the distribution.
    fn roughness(&mut self, depth: usize, material: &Standard) {
        let [least, most] = facet_widths(material);
        if most == 0.0 {
            return;
        }
        if most > least {
            let [u, v] = match material.anisotropy_rotation == 0.0 {
                true => [most, least],
                false => [least, most],
            };
            self.value(depth, "float", "alpha_u", &shortest(u));
            self.value(depth, "float", "alpha_v", &shortest(v));
        } else {
            self.value(depth, "float", "alpha", &shortest(least));
        }
        let distribution = match material.microfacets {
            Microfacets::Ggx | Microfacets::SeparableGgx => "ggx",
            Microfacets::Beckmann => "beckmann",
        };
        self.value(depth, "string", "distribution", distribution);
    }

    fn layers(&mut self, depth: usize, material: &Standard, path: ValuePath) -> Option<()> {
        // Metal and roughness.
        for (name, factor, channel) in [
            ("metallic", material.metallic, TextureChannel::Blue),
            ("roughness", material.roughness, TextureChannel::Green),
        ] {
            let slot = TexturedFactor {
                factor: [factor; 3],
                map: material.metallic_roughness_map.as_ref(),
                channel,
            };
            self.slot(depth, name, slot, path)?;
        }
        // The mirror image of what is no metal.
        let root = (material.ior - 1.0) / (material.ior + 1.0);
        let [r, g, b] = material.specular_color;
        let tint = (r + g + b) / 3.0;
        let specular = (root * root * material.specular * tint / PRINCIPLED).clamp(0.0, 1.0);
        self.value(depth, "float", "specular", &shortest(specular));
        // Layers.
        if material.clearcoat > 0.0 {
            let slot = TexturedFactor {
                factor: [material.clearcoat; 3],
                map: material.clearcoat_map.as_ref(),
                channel: TextureChannel::Red,
            };
            self.slot(depth, "clearcoat", slot, path)?;
            let gloss = shortest(1.0 - material.clearcoat_roughness);
            self.value(depth, "float", "clearcoat_gloss", &gloss);
        }
        let sheen = material.sheen_color.into_iter().fold(0.0, f64::max);
        if sheen > 0.0 {
            self.value(depth, "float", "sheen", &shortest(sheen));
        }
        if material.anisotropy > 0.0 {
            self.value(
                depth,
                "float",
                "anisotropic",
                &shortest(material.anisotropy),
            );
        }
        Some(())
    }

    /// What light loses inside a body, as a medium that scatters nothing.
    fn volume(&mut self, variant: SurfaceMaterial, material: &Standard) {
        for (medium, letter) in media(material).into_iter().zip(MEDIA) {
            if let Some(medium) = medium {
                self.medium(1, &format!(r#"id="{}{letter}""#, variant.id()), &medium);
            }
        }
    }

    /// Writes a medium with an id or a name.
    pub(super) fn medium(&mut self, depth: usize, name: &str, medium: &Medium) {
        let Medium {
            sigma_a,
            sigma_s,
            g,
        } = *medium;
        let sigma_t: [f64; 3] = std::array::from_fn(|k| sigma_a[k] + sigma_s[k]);
        let albedo = std::array::from_fn(|k| match sigma_t[k] > 0.0 {
            true => sigma_s[k] / sigma_t[k],
            false => 0.0,
        });
        // Colours are at most 1, so the greatest is a factor.
        let greatest = sigma_t.into_iter().fold(0.0, f64::max);
        let scale = if greatest > 0.0 { greatest } else { 1.0 };
        self.line(depth, &format!(r#"<medium type="homogeneous" {name}>"#));
        self.rgb(depth + 1, "albedo", albedo);
        self.rgb(depth + 1, "sigma_t", sigma_t.map(|sigma| sigma / scale));
        self.value(depth + 1, "float", "scale", &shortest(scale));
        if g != 0.0 {
            self.line(depth + 1, r#"<phase type="hg">"#);
            self.value(depth + 2, "float", "g", &shortest(g));
            self.line(depth + 1, "</phase>");
        }
        self.line(depth, "</medium>");
    }
}

/// The base colour for `principled` with which a sphere in a white furnace shows the colour that it
/// has here. Its diffuse lobe loses nothing to the mirror image, and its metal loses what is
/// scattered several times between facets, which no colour above 1 can make up for. The numbers
/// were measured with Mitsuba 3.9 at five roughnesses.
fn principled_color(material: &Standard, color: [f64; 3]) -> [f64; 3] {
    let Standard {
        metallic,
        roughness,
        ..
    } = *material;
    let diffuse = 0.953 - 0.035 * roughness;
    let lost = 0.62 * roughness * roughness * roughness.sqrt();
    let again = if material.base_color_map.is_none() {
        lost / (1.0 - lost)
    } else {
        0.0
    };
    color.map(|channel| {
        let metal = (channel * (1.0 + channel * again)).min(1.0);
        channel * diffuse * (1.0 - metallic) + metal * metallic
    })
}

/// A material as its plugin shows it, and a message if that differs.
fn shown(material: &Standard) -> (Standard, MitsubaPlugin, Option<&'static str>) {
    let (plugin, message) = MitsubaPlugin::of(material);
    let material = match plugin {
        MitsubaPlugin::Conductor(_) | MitsubaPlugin::Plastic(_) => material.clone(),
        MitsubaPlugin::Black
        | MitsubaPlugin::Diffuse
        | MitsubaPlugin::Mirror
        | MitsubaPlugin::Glass(_)
        | MitsubaPlugin::Layered => without_index(material),
    };
    (material, plugin, message)
}

/// Whether facets have a width in some direction.
fn is_rough(material: &Standard) -> bool {
    material.roughness > 0.0 || material.anisotropy > 0.0
}

/// The plugin of a plastic that is neither metal nor lets light through.
fn plastic(material: &Standard) -> Option<&'static str> {
    let is_plain = material.metallic == 0.0 && material.transmission == 0.0;
    let is_rough = is_rough(material);
    let plugin = match material.plastic {
        Plastic::None => return None,
        Plastic::Single => "pplastic",
        Plastic::Linear | Plastic::Nonlinear if material.anisotropy > 0.0 => return None,
        Plastic::Linear | Plastic::Nonlinear if is_rough => "roughplastic",
        Plastic::Linear | Plastic::Nonlinear => "plastic",
    };
    Some(plugin).filter(|_| is_plain)
}

/// How the masking of a rough material differs.
fn masking(material: &Standard) -> Option<&'static str> {
    let message = "Mitsuba's facets hide light and viewer independently";
    (material.microfacets == Microfacets::Ggx && is_rough(material)).then_some(message)
}

/// The Mitsuba plugin of a material.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum MitsubaPlugin {
    /// What reflects nothing.
    Black,
    Diffuse,
    Mirror,
    /// A metal with its index.
    Conductor(Conductor),
    /// A plastic, with the name of the plugin.
    Plastic(&'static str),
    /// The name of the plugin.
    Glass(&'static str),
    Layered,
}

impl MitsubaPlugin {
    /// The plugin, and a message if it differs from the material.
    pub(super) fn of(material: &Standard) -> (Self, Option<&'static str>) {
        let (metal, rough) = (material.metallic, material.roughness);
        let is_white = material.base_color[..3] == [1.0; 3] && material.base_color_map.is_none();
        let is_bare = material.metallic_roughness_map.is_none() && material.clearcoat == 0.0;
        if material.unlit {
            let message = "what shows its colour in any light is written as what shines with it";
            (Self::Black, Some(message))
        } else if is_glass(material) {
            let message = match (material.thickness == 0.0, rough > 0.0) {
                (true, true) => Some("a thin rough pane is written as the border of a solid"),
                (true, false) if material.thin_dielectric => None,
                (true, false) => Some("a wall of one face is written as a pane of two"),
                (false, _) => {
                    Some("Mitsuba uses Fresnel's formula, not Schlick's, for transmissive surfaces")
                }
            };
            (Self::glass(material), message)
        } else if metal == 0.0
            && material.specular == 0.0
            && material.transmission == 0.0
            && is_bare
        {
            (Self::Diffuse, None)
        } else if let Some(plugin) = plastic(material).filter(|_| is_bare) {
            (Self::Plastic(plugin), masking(material))
        } else if let Some(conductor) = material.conductor.filter(|_| metal == 1.0 && is_bare) {
            (Self::Conductor(conductor), masking(material))
        } else if metal == 1.0 && rough == 0.0 && is_bare {
            let message = "a coloured mirror is written without Schlick's rise towards white";
            (Self::Mirror, (!is_white).then_some(message))
        } else {
            let message = "`principled` approximates the metallic-roughness material";
            (Self::Layered, Some(message))
        }
    }

    /// The plugin of light that goes through.
    fn glass(material: &Standard) -> Self {
        Self::Glass(match (material.roughness > 0.0, material.thickness > 0.0) {
            (false, false) => "thindielectric",
            (false, true) => "dielectric",
            (true, _) => "roughdielectric",
        })
    }

    /// A base colour as the plugin takes it.
    pub(super) fn color(self, material: &Standard, color: [f64; 3]) -> [f64; 3] {
        match self {
            Self::Layered => principled_color(material, color),
            Self::Black
            | Self::Diffuse
            | Self::Mirror
            | Self::Conductor(_)
            | Self::Plastic(_)
            | Self::Glass(_) => color,
        }
    }

    fn shape_name(self, material: &Standard) -> &'static str {
        match self {
            Self::Conductor(_) if is_rough(material) => "roughconductor",
            Self::Conductor(_) => "conductor",
            Self::Black | Self::Diffuse => "diffuse",
            Self::Mirror => "conductor",
            Self::Plastic(plugin) | Self::Glass(plugin) => plugin,
            Self::Layered => "principled",
        }
    }
}
