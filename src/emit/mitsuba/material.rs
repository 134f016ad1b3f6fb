//! Writes materials: diffuse materials and perfect mirrors are exact; others are approximated.

use super::MitsubaWriter;
use crate::approximation::approximate_phong;
use crate::export::{enumeration, used_materials};
use rtc_ir::{Alpha, Material, Standard, ValuePath};
use rtc_math::shortest;
use std::borrow::Cow;

/// The normal-incidence reflectance of a dielectric with `specular` = 1 in Mitsuba's `principled`
/// plugin (Burley, "Physically based shading at Disney", 2012, section 5.2).
const PRINCIPLED: f64 = 0.08;

impl MitsubaWriter<'_> {
    /// Writes the materials of surfaces.
    pub(super) fn materials(&mut self) {
        for (index, material, path) in used_materials(self.scene) {
            self.material(index, &standard(material), path);
        }
    }

    fn material(&mut self, index: usize, material: &Standard, path: ValuePath) {
        let missing_features = missing_features(material);
        if !missing_features.is_empty() {
            let message = format!(
                "a material is written without {}",
                enumeration(&missing_features)
            );
            self.reporter.unsupported(&message, path);
        }
        let (kind, message) = Plugin::of(material);
        if let Some(message) = message {
            self.reporter.unsupported(message, path);
        }
        let id = format!(r#"id="m{index}""#);
        // Transmissive materials must not be `twosided`; all others are.
        let is_open = matches!(kind, Plugin::Glass(_));
        if is_open {
            self.bsdf(1, &kind, &id, material);
        } else {
            self.line(1, &format!(r#"<bsdf type="twosided" {id}>"#));
            self.bsdf(2, &kind, "", material);
            self.line(1, "</bsdf>");
        }
    }

    fn bsdf(&mut self, depth: usize, kind: &Plugin, id: &str, material: &Standard) {
        let head = format!(r#"<bsdf type="{}" {id}"#, kind.shape_name());
        self.line(depth, &format!("{}>", head.trim_end()));
        let [r, g, b, _] = material.base_color;
        let inner = depth + 1;
        match kind {
            Plugin::Matt => self.rgb(inner, "reflectance", [r, g, b]),
            Plugin::Mirror => {
                self.value(inner, "string", "material", "none");
                self.rgb(inner, "specular_reflectance", [r, g, b]);
            }
            Plugin::Glass(_) => {
                self.value(inner, "float", "int_ior", &shortest(material.ior));
                self.value(inner, "float", "ext_ior", "1");
                if material.roughness > 0.0 {
                    let alpha = material.roughness * material.roughness;
                    self.value(inner, "float", "alpha", &shortest(alpha));
                    self.value(inner, "string", "distribution", "ggx");
                }
                self.rgb(inner, "specular_transmittance", [r, g, b]);
            }
            Plugin::Layered => {
                let root = (material.ior - 1.0) / (material.ior + 1.0);
                let specular = (root * root * material.specular / PRINCIPLED).clamp(0.0, 1.0);
                self.rgb(inner, "base_color", [r, g, b]);
                self.value(inner, "float", "metallic", &shortest(material.metallic));
                self.value(inner, "float", "roughness", &shortest(material.roughness));
                self.value(inner, "float", "specular", &shortest(specular));
            }
        }
        self.line(depth, "</bsdf>");
    }
}

/// The material that path tracing uses.
pub(super) fn standard(material: &Material) -> Cow<'_, Standard> {
    match material {
        Material::Standard(standard) => Cow::Borrowed(standard),
        Material::Phong(phong) => Cow::Owned(approximate_phong(phong)),
    }
}

/// The Mitsuba plugin of a material.
enum Plugin {
    Matt,
    Mirror,
    /// The name of the plugin.
    Glass(&'static str),
    Layered,
}

impl Plugin {
    /// The plugin, and a message if it differs from the material.
    fn of(material: &Standard) -> (Self, Option<&'static str>) {
        let (metal, rough) = (material.metallic, material.roughness);
        let [r, g, b, _] = material.base_color;
        let is_white = [r, g, b] == [1.0; 3];
        if is_glass(material) {
            let message = match rough > 0.0 && material.thickness == 0.0 {
                true => "a thin rough pane is written as the border of a solid",
                false => "Mitsuba uses Fresnel's formula, not Schlick's, for transmissive surfaces",
            };
            let plugin = match (rough > 0.0, material.thickness > 0.0) {
                (false, false) => "thindielectric",
                (false, true) => "dielectric",
                (true, _) => "roughdielectric",
            };
            (Self::Glass(plugin), Some(message))
        } else if metal == 0.0 && material.specular == 0.0 {
            (Self::Matt, None)
        } else if metal == 1.0 && rough == 0.0 {
            let message = "a coloured mirror is written without Schlick's rise towards white";
            (Self::Mirror, (!is_white).then_some(message))
        } else {
            let message = "`principled` approximates the metallic-roughness material";
            (Self::Layered, Some(message))
        }
    }

    fn shape_name(&self) -> &'static str {
        match self {
            Self::Matt => "diffuse",
            Self::Mirror => "conductor",
            Self::Glass(plugin) => plugin,
            Self::Layered => "principled",
        }
    }
}

/// Whether all light that is not reflected is transmitted.
fn is_glass(material: &Standard) -> bool {
    material.transmission == 1.0 && material.metallic == 0.0
}

/// The features of a material that are not written.
fn missing_features(material: &Standard) -> Vec<&'static str> {
    // The features that are written.
    let default = Standard::default();
    let base = Standard {
        name: material.name.clone(),
        base_color: material.base_color,
        metallic: material.metallic,
        roughness: material.roughness,
        emissive: material.emissive,
        alpha: material.alpha,
        double_sided: material.double_sided,
        unlit: material.unlit,
        ior: material.ior,
        specular: material.specular,
        transmission: material.transmission,
        thickness: material.thickness,
        ..default
    };
    // Name the others.
    let parts = [
        (material.maps().next().is_some(), "its maps"),
        (material.alpha != Alpha::Opaque, "its alpha"),
        (material.unlit, "being unlit"),
        (
            !material.double_sided && material.transmission == 0.0,
            "one-sidedness for the camera",
        ),
        (
            material.transmission > 0.0 && !is_glass(material),
            "the transmitted light",
        ),
        (
            has_layers(material, &base),
            "its layers, volume or dispersion",
        ),
    ];
    let parts = parts.into_iter().filter(|(has, _)| *has);
    parts.map(|(_, name)| name).collect()
}

/// Whether a material has features apart from its base and its maps.
fn has_layers(material: &Standard, base: &Standard) -> bool {
    let mut bare = material.clone();
    bare.retain_maps(|_| false);
    bare != *base
}
