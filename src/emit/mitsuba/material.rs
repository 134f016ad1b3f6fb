//! Writes materials: diffuse materials and perfect mirrors are exact; others are approximated.

use super::MitsubaWriter;
use super::texture::{Channel, TexturedFactor};
use crate::approximation::approximate_phong;
use crate::export::{called, enumeration};
use rtc_ir::{Alpha, EntityKind, Field, Map, Material, Scene, Shape, Standard, Surface, ValuePath};
use rtc_math::{ln, shortest};
use std::borrow::Cow;
use std::collections::BTreeSet;

/// The normal-incidence reflectance of a dielectric with `specular` = 1 in Mitsuba's `principled`
/// plugin (Burley, "Physically based shading at Disney", 2012, section 5.2).
const PRINCIPLED: f64 = 0.08;

/// The least index of refraction that is written: Mitsuba's rough glass needs one that differs from
/// that of the outside.
const LEAST_IOR: f64 = 1.0001;

/// A material on surfaces of one kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct MaterialVariant {
    pub(super) material: u32,
    /// Whether they lack the texture coordinates of its maps, which have no effect then.
    pub(super) lacks_uvs: bool,
    /// Whether their corners have colours.
    pub(super) has_colors: bool,
    /// Whether they have an opacity that counts.
    pub(super) has_opacity: bool,
}

impl MaterialVariant {
    pub(super) fn of(scene: &Scene, surface: &Surface) -> Self {
        let material = surface.material.0;
        let of_material = standard(&scene.materials[material as usize]);
        let [mut has_uvs, mut has_colors, mut has_opacity] = [false; 3];
        if let Shape::Instance(instance) = &surface.shape {
            let mesh = &scene.meshes[instance.mesh.0 as usize];
            has_uvs = match uv_set(&of_material) {
                1 => !mesh.second_uvs.is_empty(),
                _ => !mesh.uvs.is_empty(),
            };
            has_opacity = of_material.alpha != Alpha::Opaque
                && (0..mesh.colors.len()).any(|at| mesh.colors.at(at)[3] != 1.0);
            has_colors = (0..mesh.colors.len()).any(|at| mesh.colors.at(at)[..3] != [1.0; 3]);
        }
        Self {
            material,
            lacks_uvs: of_material.maps().next().is_some() && !has_uvs,
            has_colors,
            has_opacity,
        }
    }

    /// Its identifier in the file.
    pub(super) fn id(self) -> String {
        let plain = if self.lacks_uvs { "p" } else { "" };
        let colored = if self.has_colors { "c" } else { "" };
        let covering = if self.has_opacity { "a" } else { "" };
        format!("m{}{plain}{colored}{covering}", self.material)
    }

    /// The material, without the maps that have no effect.
    pub(super) fn standard(self, scene: &Scene) -> Standard {
        let mut material = standard(&scene.materials[self.material as usize]).into_owned();
        if self.lacks_uvs {
            material.retain_maps(|_| false);
        }
        material
    }
}

/// The set of texture coordinates that is written for a material: that of its first map.
pub(super) fn uv_set(material: &Standard) -> u32 {
    material.maps().next().map_or(0, |map| map.set)
}

/// The material that path tracing uses.
pub(super) fn standard(material: &Material) -> Cow<'_, Standard> {
    match material {
        Material::Standard(standard) => Cow::Borrowed(standard),
        Material::Phong(phong) => Cow::Owned(approximate_phong(phong)),
    }
}

impl MitsubaWriter<'_> {
    /// Writes the materials of surfaces; `None` if their pictures exceed the budget.
    pub(super) fn materials(&mut self) -> Option<()> {
        let scene = self.scene;
        let variants = scene.surfaces.iter();
        let variants: BTreeSet<_> = variants
            .map(|one| MaterialVariant::of(scene, one))
            .collect();
        let mut reported = BTreeSet::new();
        for variant in variants {
            let index = variant.material as usize;
            let path = ValuePath::new(EntityKind::Material, index, Field::Whole);
            let material = variant.standard(scene);
            let (plugin, message) = Plugin::of(&material);
            if reported.insert(index) {
                self.report_material(&material, message, path);
            }
            self.material(variant, &material, plugin, path)?;
        }
        Some(())
    }

    fn report_material(&mut self, material: &Standard, message: Option<&str>, path: ValuePath) {
        let name = called(&material.name);
        let missing_features = missing_features(material);
        if !missing_features.is_empty() {
            let missing = enumeration(&missing_features);
            let message = format!("{name} is written without {missing}");
            self.reporter.unsupported(&message, path);
        }
        if let Some(message) = message {
            self.reporter
                .unsupported(&format!("{name}: {message}"), path);
        }
        if material.emissive != [0.0; 3] {
            let message = format!(
                "{name} shines both ways: Mitsuba's emitters shine to the front alone, or outwards"
            );
            self.reporter.unsupported(&message, path);
        }
    }

    fn material(
        &mut self,
        variant: MaterialVariant,
        material: &Standard,
        plugin: Plugin,
        path: ValuePath,
    ) -> Option<()> {
        // A mask applies the opacity.
        let id = format!(r#" id="{}""#, variant.id());
        let cut = opacity(material, variant.has_opacity);
        let (depth, id) = match &cut {
            Some(_) => (2, String::new()),
            None => (1, id),
        };
        if let Some(opacity) = cut {
            self.line(1, &format!(r#"<bsdf type="mask" id="{}">"#, variant.id()));
            self.slot(2, "opacity", opacity, path)?;
        }
        // A partly transmissive material blends layers with glass.
        let is_mixed = plugin == Plugin::Layered && material.transmission > 0.0;
        if is_mixed {
            self.line(depth, &format!(r#"<bsdf type="blendbsdf"{id}>"#));
            let weight = TexturedFactor {
                factor: [material.transmission; 3],
                map: material.transmission_map.as_ref(),
                channel: Channel::Red,
            };
            self.slot(depth + 1, "weight", weight, path)?;
            self.two_sided(depth + 1, "", variant, (plugin, material), path)?;
            let glass = Plugin::glass(material);
            self.bsdf(depth + 1, "", variant, (glass, material), path)?;
            self.line(depth, "</bsdf>");
        } else if matches!(plugin, Plugin::Glass(_)) {
            self.bsdf(depth, &id, variant, (plugin, material), path)?;
        } else {
            self.two_sided(depth, &id, variant, (plugin, material), path)?;
        }
        // Close the mask and write the interior medium.
        if depth == 2 {
            self.line(1, "</bsdf>");
        }
        self.volume(variant, material);
        Some(())
    }

    /// Materials that light does not cross have two sides.
    fn two_sided(
        &mut self,
        depth: usize,
        id: &str,
        variant: MaterialVariant,
        material: (Plugin, &Standard),
        path: ValuePath,
    ) -> Option<()> {
        self.line(depth, &format!(r#"<bsdf type="twosided"{id}>"#));
        self.bsdf(depth + 1, "", variant, material, path)?;
        self.line(depth, "</bsdf>");
        Some(())
    }

    fn bsdf(
        &mut self,
        depth: usize,
        id: &str,
        variant: MaterialVariant,
        (plugin, material): (Plugin, &Standard),
        path: ValuePath,
    ) -> Option<()> {
        let Some(map) = &material.normal_map else {
            return self.base(depth, id, variant, (plugin, material), path);
        };
        self.line(depth, &format!(r#"<bsdf type="normalmap"{id}>"#));
        let slot = TexturedFactor {
            factor: [1.0; 3],
            map: Some(map),
            channel: Channel::Normal(material.normal_scale),
        };
        self.slot(depth + 1, "normalmap", slot, path)?;
        self.base(depth + 1, "", variant, (plugin, material), path)?;
        self.line(depth, "</bsdf>");
        Some(())
    }

    fn base(
        &mut self,
        depth: usize,
        id: &str,
        variant: MaterialVariant,
        (plugin, material): (Plugin, &Standard),
        path: ValuePath,
    ) -> Option<()> {
        let inner = depth + 1;
        self.line(
            depth,
            &format!(r#"<bsdf type="{}"{id}>"#, plugin.shape_name()),
        );
        let color = TexturedFactor::color(material, variant.has_colors);
        match plugin {
            Plugin::Black => self.rgb(inner, "reflectance", [0.0; 3]),
            Plugin::Diffuse => self.slot(inner, "reflectance", color, path)?,
            Plugin::Mirror => {
                self.value(inner, "string", "material", "none");
                self.slot(inner, "specular_reflectance", color, path)?;
            }
            Plugin::Glass(_) => {
                self.dielectric_interface(inner, material);
                self.slot(inner, "specular_transmittance", color, path)?;
            }
            Plugin::Layered => {
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
        if material.roughness > 0.0 {
            let alpha = material.roughness * material.roughness;
            self.value(depth, "float", "alpha", &shortest(alpha));
            self.value(depth, "string", "distribution", "ggx");
        }
    }

    fn layers(&mut self, depth: usize, material: &Standard, path: ValuePath) -> Option<()> {
        // Metal and roughness.
        for (name, factor, channel) in [
            ("metallic", material.metallic, Channel::Blue),
            ("roughness", material.roughness, Channel::Green),
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
                channel: Channel::Red,
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
    fn volume(&mut self, variant: MaterialVariant, material: &Standard) {
        let Some(absorption) = absorption(material) else {
            return;
        };
        let id = variant.id();
        self.line(1, &format!(r#"<medium type="homogeneous" id="{id}v">"#));
        // Colours are at most 1, so the greatest is a factor.
        let scale = absorption.into_iter().fold(0.0, f64::max);
        self.rgb(2, "albedo", [0.0; 3]);
        self.rgb(2, "sigma_t", absorption.map(|channel| channel / scale));
        self.value(2, "float", "scale", &shortest(scale));
        self.line(1, "</medium>");
    }
}

/// The share of light that a surface stops, where it is not all.
fn opacity(material: &Standard, of_corners: bool) -> Option<TexturedFactor<'_>> {
    let [.., alpha] = material.base_color;
    let channel = match material.alpha {
        Alpha::Opaque => return None,
        Alpha::Mask(cutoff) => Channel::AlphaCut(cutoff),
        Alpha::Blend => Channel::Alpha,
    };
    let channel = match of_corners && material.base_color_map.is_none() {
        true => Channel::CornerOpacity,
        false => channel,
    };
    Some(TexturedFactor {
        factor: [alpha; 3],
        map: material.base_color_map.as_ref(),
        channel,
    })
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

/// The coefficient of absorption inside a body of a material, per unit of length; `None` if it
/// bounds none, or a clear one.
pub(super) fn absorption(material: &Standard) -> Option<[f64; 3]> {
    let distance = material.attenuation_distance?;
    let is_body = material.transmission > 0.0 && material.thickness > 0.0;
    let is_clear = material.attenuation_color == [1.0; 3];
    let of = |channel: f64| -ln(channel.max(1e-30)) / distance;
    (is_body && !is_clear).then(|| material.attenuation_color.map(of))
}

/// The Mitsuba plugin of a material.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Plugin {
    /// What reflects nothing.
    Black,
    Diffuse,
    Mirror,
    /// The name of the plugin.
    Glass(&'static str),
    Layered,
}

impl Plugin {
    /// The plugin, and a message if it differs from the material.
    pub(super) fn of(material: &Standard) -> (Self, Option<&'static str>) {
        let (metal, rough) = (material.metallic, material.roughness);
        let is_white = material.base_color[..3] == [1.0; 3] && material.base_color_map.is_none();
        let is_bare = material.metallic_roughness_map.is_none() && material.clearcoat == 0.0;
        if material.unlit {
            let message = "what shows its colour in any light is written as what shines with it";
            (Self::Black, Some(message))
        } else if is_glass(material) {
            let message = match rough > 0.0 && material.thickness == 0.0 {
                true => "a thin rough pane is written as the border of a solid",
                false => "Mitsuba uses Fresnel's formula, not Schlick's, for transmissive surfaces",
            };
            (Self::glass(material), Some(message))
        } else if metal == 0.0
            && material.specular == 0.0
            && material.transmission == 0.0
            && is_bare
        {
            (Self::Diffuse, None)
        } else if metal == 1.0 && rough == 0.0 && is_bare {
            let message = "a coloured mirror is written without Schlick's rise towards white";
            (Self::Mirror, (!is_white).then_some(message))
        } else {
            let message = match metal > 0.0 {
                true => {
                    "`principled` approximates the metallic-roughness material, without the light \
                     that a rough metal scatters several times"
                }
                false => "`principled` approximates the metallic-roughness material",
            };
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
            Self::Black | Self::Diffuse | Self::Mirror | Self::Glass(_) => color,
        }
    }

    fn shape_name(self) -> &'static str {
        match self {
            Self::Black | Self::Diffuse => "diffuse",
            Self::Mirror => "conductor",
            Self::Glass(plugin) => plugin,
            Self::Layered => "principled",
        }
    }
}

/// Whether all light that is not reflected is transmitted.
fn is_glass(material: &Standard) -> bool {
    material.transmission == 1.0 && material.metallic == 0.0 && material.transmission_map.is_none()
}

/// The features of a material that are not written.
fn missing_features(material: &Standard) -> Vec<&'static str> {
    // List the features that no plugin has, with the condition that the material uses them.
    let set = uv_set(material);
    let has = |maps: &[&Option<Map>]| maps.iter().any(|map| map.is_some());
    let parts = [
        (
            material.maps().any(|map| map.set != set),
            "the maps of its other texture coordinates",
        ),
        (
            !material.double_sided && material.transmission == 0.0,
            "one-sidedness for the camera",
        ),
        (
            material.specular_glossiness.is_some(),
            "the colour of its mirror image",
        ),
        (
            has(&[
                &material.specular_map,
                &material.specular_color_map,
                &material.thickness_map,
                &material.clearcoat_roughness_map,
                &material.clearcoat_normal_map,
                &material.sheen_color_map,
                &material.sheen_roughness_map,
                &material.anisotropy_map,
            ]),
            "the maps of its layers",
        ),
        (material.dispersion > 0.0, "its dispersion"),
        (material.iridescence > 0.0, "its thin film"),
        (
            material.diffuse_transmission > 0.0,
            "the scattered light that goes through",
        ),
    ];
    let parts = parts.into_iter().filter(|(has, _)| *has);
    parts.map(|(_, name)| name).collect()
}
