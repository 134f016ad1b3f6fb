//! Writes materials: diffuse surfaces and white mirrors are exact; others are approximated.
//!
//! A metallic-roughness material is a mix of a coated diffuse surface and a conductor, and one that
//! transmits light a mix of that and a dielectric.

use super::{PbrtWriter, numbers, string};
use crate::approximation::without_index;
use crate::export::{called, enumeration, facet_width, facet_widths};
use crate::path_tracer::{
    SurfaceMaterial, TextureChannel, TexturedFactor, blend_weight, is_glass, is_null, media,
    missing_features, other_material, radiance,
};
use rtc_ir::{Alpha, Conductor, EntityField, EntityKind, Scene, Shape, Standard, ValuePath};
use rtc_math::{Medium, Microfacets, Plastic};
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::FRAC_PI_2;
use std::rc::Rc;

/// The least index of refraction that is written: an interface needs a difference.
const LEAST_IOR: f64 = 1.0001;
/// The greatest square root of a reflectance that becomes an index of refraction.
const GREATEST_ROOT: f64 = 0.95;

impl PbrtWriter<'_> {
    /// Writes the materials of surfaces; `None` if their pictures exceed the budget.
    pub(super) fn materials(&mut self) -> Option<()> {
        self.shown = shown_materials(self.scene);
        let mut reported = BTreeSet::new();
        for (variant, shown) in self.shown.clone() {
            let index = variant.material as usize;
            let path = ValuePath::new(EntityKind::Material, index, EntityField::Whole);
            if is_null(&shown.standard) {
                self.named(&variant.id(), "interface", "");
                self.media(variant, &shown.standard);
                continue;
            }
            if reported.insert(index) {
                self.report_material(&shown, path);
                let mut next = other_material(self.scene, &shown.standard);
                while let Some(part) = next {
                    next = other_material(self.scene, &part);
                    if part.alpha != Alpha::Opaque {
                        let name = called(&part.name);
                        let message = format!("{name} is written without its opacity in a blend");
                        self.beside.reporter.unsupported(&message, path);
                    }
                    let shown = ShownMaterial {
                        standard: Rc::new(part),
                        has_mean: false,
                    };
                    self.report_material(&shown, path);
                }
            }
            self.material(&variant.id(), &shown.standard, path)?;
            self.media(variant, &shown.standard);
        }
        Some(())
    }

    /// The material that surfaces show.
    pub(super) fn shown(&self, variant: SurfaceMaterial) -> Rc<Standard> {
        let shown = self.shown.get(&variant);
        shown.map_or_else(Rc::default, |shown| Rc::clone(&shown.standard))
    }

    fn report_material(&mut self, shown: &ShownMaterial, path: ValuePath) {
        let material = &*shown.standard;
        let name = called(&material.name);
        let missing = missing_features(self.scene, material, &own_features(shown));
        if !missing.is_empty() {
            let missing = enumeration(&missing);
            let message = format!("{name} is written without {missing}");
            self.beside.reporter.unsupported(&message, path);
        }
        if let Some(message) = approximation(material) {
            let message = format!("{name}: {message}");
            self.beside.reporter.unsupported(&message, path);
        }
    }

    /// A material or a blend.
    fn material(&mut self, id: &str, material: &Standard, path: ValuePath) -> Option<()> {
        let Some(other) = other_material(self.scene, material) else {
            return self.part(id, material, path);
        };
        let [first, second] = ["first", "second"].map(|part| format!("{id}.{part}"));
        self.part(&first, material, path)?;
        self.material(&second, &other, path)?;
        self.mix(id, [&first, &second], blend_weight(material), path)
    }

    /// A material that is no blend.
    fn part(&mut self, id: &str, material: &Standard, path: ValuePath) -> Option<()> {
        if material.unlit {
            let black = numbers("rgb", "reflectance", [0.0; 3]);
            self.named(id, "diffuse", &black);
            return Some(());
        }
        if is_glass(material) {
            return self.glass(id, material, path);
        }
        let transmission = TexturedFactor {
            factor: [material.transmission; 3],
            map: material.transmission_map.as_ref(),
            channel: TextureChannel::Red,
        };
        let [base, glass] = ["base", "glass"].map(|part| format!("{id}.{part}"));
        match material.transmission > 0.0 {
            true => {
                self.opaque(&base, material, path)?;
                self.glass(&glass, material, path)?;
                self.mix(id, [&base, &glass], transmission, path)
            }
            false => self.opaque(id, material, path),
        }
    }

    /// The part of a material that transmits no specular light.
    fn opaque(&mut self, id: &str, material: &Standard, path: ValuePath) -> Option<()> {
        let metallic = TexturedFactor {
            factor: [material.metallic; 3],
            map: material.metallic_roughness_map.as_ref(),
            channel: TextureChannel::Blue,
        };
        if material.metallic == 0.0 {
            return self.coated(id, material, path);
        }
        if is_metal(material) {
            return self.metal(id, material, path);
        }
        let [coated, metal] = ["coated", "metal"].map(|part| format!("{id}.{part}"));
        self.coated(&coated, material, path)?;
        self.metal(&metal, material, path)?;
        self.mix(id, [&coated, &metal], metallic, path)
    }

    /// A diffuse surface, under a dielectric interface if it has a mirror image.
    fn coated(&mut self, id: &str, material: &Standard, path: ValuePath) -> Option<()> {
        let normals = self.normals(material, path)?;
        let color = TexturedFactor::color(material, false);
        if material.diffuse_transmission > 0.0 {
            let parameters = self.diffuse_transmission(material, path)?;
            self.named(id, "diffusetransmission", &(parameters + &normals));
            return Some(());
        }
        if is_reflector(material) {
            let reflectance = material.specular_color.map(|part| part * material.specular);
            let color = numbers("rgb", "reflectance", reflectance.map(|part| part.min(1.0)));
            let roughness = self.roughness("", material, path)?;
            self.named(id, "conductor", &(color + &roughness + &normals));
            return Some(());
        }
        let color = self.slot("reflectance", color, path)?;
        if material.specular == 0.0 {
            self.named(id, "diffuse", &(color + &normals));
            return Some(());
        }
        let roughness = self.roughness("", material, path)?;
        let eta = numbers("float", "eta", [coat_ior(material)]);
        self.named(id, "coateddiffuse", &(color + &roughness + &eta + &normals));
        Some(())
    }

    /// A diffuse reflectance and a diffuse transmittance, whose sum is at most 1.
    fn diffuse_transmission(&mut self, material: &Standard, path: ValuePath) -> Option<String> {
        let share = material.diffuse_transmission;
        let color = TexturedFactor::color(material, false);
        let reflected = TexturedFactor {
            factor: color.factor.map(|channel| channel * (1.0 - share)),
            ..color
        };
        let transmitted = TexturedFactor {
            factor: material
                .diffuse_transmission_color
                .map(|channel| channel * share),
            map: material.diffuse_transmission_color_map.as_ref(),
            channel: TextureChannel::Color,
        };
        let reflected = self.slot("reflectance", reflected, path)?;
        Some(reflected + &self.slot("transmittance", transmitted, path)?)
    }

    fn metal(&mut self, id: &str, material: &Standard, path: ValuePath) -> Option<()> {
        let normals = self.normals(material, path)?;
        let prefix = match material.clearcoat > 0.0 {
            true => "conductor.",
            false => "",
        };
        let color = match index(material) {
            Some(Conductor { eta, k }) => {
                let part = |name, values| numbers("rgb", &format!("{prefix}{name}"), values);
                part("eta", eta) + &part("k", k)
            }
            None => {
                let colored = without_index(material);
                self.slot("reflectance", TexturedFactor::color(&colored, false), path)?
            }
        };
        if material.clearcoat == 0.0 {
            let roughness = self.roughness("", material, path)?;
            self.named(id, "conductor", &(color + &roughness + &normals));
            return Some(());
        }
        let roughness = self.roughness("conductor.", material, path)?;
        let coat = facet_width(material.clearcoat_roughness);
        let coat = numbers("float", "interface.roughness", [coat]);
        self.named(
            id,
            "coatedconductor",
            &(color + &roughness + &coat + &normals),
        );
        Some(())
    }

    fn glass(&mut self, id: &str, material: &Standard, path: ValuePath) -> Option<()> {
        let normals = self.normals(material, path)?;
        let eta = numbers("float", "eta", [material.ior.max(LEAST_IOR)]);
        if material.thickness == 0.0 && material.roughness == 0.0 {
            self.named(id, "thindielectric", &(eta + &normals));
            return Some(());
        }
        let roughness = self.roughness("", material, path)?;
        self.named(id, "dielectric", &(eta + &roughness + &normals));
        Some(())
    }

    fn mix(
        &mut self,
        id: &str,
        [first, second]: [&str; 2],
        amount: TexturedFactor<'_>,
        path: ValuePath,
    ) -> Option<()> {
        let materials = format!(r#" "string materials" [ "{first}" "{second}" ]"#);
        let amount = self.slot("amount", amount, path)?;
        self.named(id, "mix", &(materials + &amount));
        Some(())
    }

    /// The widths of the distribution of facets; both names have a prefix.
    fn roughness(&mut self, of: &str, material: &Standard, path: ValuePath) -> Option<String> {
        let exact = r#" "bool remaproughness" false"#;
        let slot = TexturedFactor {
            factor: [material.roughness; 3],
            map: material.metallic_roughness_map.as_ref(),
            channel: TextureChannel::GreenSquared,
        };
        if slot.map.is_some() {
            return Some(self.slot(&format!("{of}roughness"), slot, path)? + exact);
        }
        let [across, along] = facet_widths(material);
        if material.anisotropy == 0.0 {
            return Some(numbers("float", &format!("{of}roughness"), [across]) + exact);
        }
        let [u, v] = match material.anisotropy_rotation == 0.0 {
            true => [along, across],
            false => [across, along],
        };
        let u = numbers("float", &format!("{of}uroughness"), [u]);
        let v = numbers("float", &format!("{of}vroughness"), [v]);
        Some(u + &v + exact)
    }

    /// The maps of normals and of heights, or an empty text.
    fn normals(&mut self, material: &Standard, path: ValuePath) -> Option<String> {
        let heights = match TexturedFactor::heights(material) {
            Some(slot) => self.displacement(slot, material.bump_scale, path)?,
            None => String::new(),
        };
        Some(heights + &self.normal_map_of(material, path)?)
    }

    fn normal_map_of(&mut self, material: &Standard, path: ValuePath) -> Option<String> {
        match TexturedFactor::normal(material) {
            Some(slot) => self.normal_map(slot, path),
            None => Some(String::new()),
        }
    }

    fn named(&mut self, id: &str, kind: &str, parameters: &str) {
        let kind = string("string", "type", kind);
        self.line(&format!(r#"MakeNamedMaterial "{id}"{kind}{parameters}"#));
    }

    /// What light loses inside a body, as a medium that scatters nothing.
    fn media(&mut self, variant: SurfaceMaterial, material: &Standard) {
        let names = medium_names(variant, material);
        for (medium, name) in media(material).into_iter().zip(names) {
            if let Some(medium) = medium {
                self.named_medium(&name, &medium);
            }
        }
    }

    /// Writes a medium.
    pub(super) fn named_medium(&mut self, name: &str, medium: &Medium) {
        let Medium {
            sigma_a,
            sigma_s,
            g,
        } = *medium;
        let mut parts = string("string", "type", "homogeneous")
            + &numbers("rgb", "sigma_a", sigma_a)
            + &numbers("rgb", "sigma_s", sigma_s);
        if g != 0.0 {
            parts += &numbers("float", "g", [g]);
        }
        self.line(&format!(r#"MakeNamedMedium "{name}"{parts}"#));
    }
}

/// The names of the media inside and outside of surfaces of a material; empty for a vacuum.
pub(super) fn medium_names(variant: SurfaceMaterial, material: &Standard) -> [String; 2] {
    let [interior, exterior] = media(material).map(|medium| medium.is_some());
    let name = |is_there: bool, suffix: &str| match is_there {
        true => variant.id() + suffix,
        false => String::new(),
    };
    [name(interior, ""), name(exterior, ".outside")]
}

/// A material as it is shown.
#[derive(Clone)]
pub(super) struct ShownMaterial {
    /// The base colour times the mean of the colours of corners: pbrt's meshes have none.
    standard: Rc<Standard>,
    /// Whether corners have different colours.
    has_mean: bool,
}

/// The materials of all surfaces as they are shown.
fn shown_materials(scene: &Scene) -> BTreeMap<SurfaceMaterial, ShownMaterial> {
    // The meshes of each.
    let mut meshes = BTreeMap::<SurfaceMaterial, BTreeSet<usize>>::new();
    for surface in &scene.surfaces {
        let meshes = meshes
            .entry(SurfaceMaterial::of(scene, surface))
            .or_default();
        if let Shape::Instance(instance) = &surface.shape {
            meshes.insert(instance.mesh.0 as usize);
        }
    }
    let shown = meshes.into_iter().map(|(variant, meshes)| {
        let mut standard = variant.standard(scene);
        let is_colored = variant.has_colors || variant.has_opacity;
        let has_mean = is_colored && times_mean(&mut standard.base_color, scene, &meshes);
        let standard = Rc::new(standard);
        (variant, ShownMaterial { standard, has_mean })
    });
    shown.collect()
}

/// Multiplies a colour by the mean of the colours of corners; returns whether these differ.
fn times_mean(color: &mut [f64; 4], scene: &Scene, meshes: &BTreeSet<usize>) -> bool {
    let colors = meshes.iter().flat_map(|mesh| {
        let colors = &scene.meshes[*mesh].colors;
        (0..colors.len()).map(|at| colors.at(at))
    });
    let (mut sum, mut count, mut first, mut differ) = ([0.0; 4], 0.0, None, false);
    for corner in colors {
        differ |= *first.get_or_insert(corner) != corner;
        count += 1.0;
        for (sum, channel) in sum.iter_mut().zip(corner) {
            *sum += channel;
        }
    }
    for (channel, sum) in color.iter_mut().zip(sum) {
        *channel *= sum / f64::max(count, 1.0);
    }
    differ
}

/// Whether all of a material is metal.
fn is_metal(material: &Standard) -> bool {
    material.metallic == 1.0 && material.metallic_roughness_map.is_none()
}

/// The index of a metal whose reflectance has no other factor: pbrt has none.
fn index(material: &Standard) -> Option<Conductor> {
    let is_white = material.base_color[..3] == [1.0; 3] && material.base_color_map.is_none();
    material.conductor.filter(|_| is_white)
}

/// Whether a material has a mirror image only, by its colour.
fn is_reflector(material: &Standard) -> bool {
    let is_black = material.base_color[..3] == [0.0; 3];
    is_black && material.ior == 0.0 && material.specular > 0.0
}

/// The index of refraction that reflects as much along the normal as the coat of a material.
fn coat_ior(material: &Standard) -> f64 {
    let root = (material.ior - 1.0) / (material.ior + 1.0);
    let [r, g, b] = material.specular_color;
    let reflectance = root * root * material.specular * (r + g + b) / 3.0;
    let root = reflectance.sqrt().min(GREATEST_ROOT);
    ((1.0 + root) / (1.0 - root)).max(LEAST_IOR)
}

/// How the material that is written differs.
fn approximation(material: &Standard) -> Option<&'static str> {
    let is_white = material.base_color[..3] == [1.0; 3] && material.base_color_map.is_none();
    let is_bare = material.clearcoat == 0.0 && material.transmission == 0.0;
    if material.unlit {
        return Some("what shows its colour in any light is written as what shines with it");
    }
    if is_glass(material) {
        return match (material.thickness == 0.0, material.roughness > 0.0) {
            (true, true) => Some("a thin rough pane is written as the border of a solid"),
            (true, false) if material.thin_dielectric => None,
            (true, false) => Some("a wall of one face is written as a pane of two"),
            (false, _) => {
                Some("pbrt uses Fresnel's formula, not Schlick's, for transmissive surfaces")
            }
        };
    }
    if is_metal(material) && is_bare && index(material).is_some() {
        return None;
    }
    if is_metal(material) && is_bare {
        let is_exact = is_white && material.roughness == 0.0;
        return (!is_exact).then_some("`conductor` reflects by Fresnel's formula, not Schlick's");
    }
    let has_coat = material.specular > 0.0;
    let is_exact = material.metallic == 0.0 && is_bare && !has_coat;
    (!is_exact).then_some("pbrt's layers approximate the metallic-roughness material")
}

/// What pbrt lacks of a material, each with whether the material uses it.
fn own_features(shown: &ShownMaterial) -> [(bool, &'static str); 11] {
    let material = &*shown.standard;
    let is_transmissive = material.transmission > 0.0;
    let is_tinted = material.base_color[..3] != [1.0; 3] || material.base_color_map.is_some();
    let sheen = material.sheen_color != [0.0; 3];
    let turn = material.anisotropy_rotation;
    let is_straight = turn == 0.0 || (turn - FRAC_PI_2).abs() < 1e-9;
    let has_roughness_map = material.metallic_roughness_map.is_some();
    let emission_varies = radiance(material, false).is_some_and(|slot| slot.map.is_some());
    [
        (
            shown.has_mean,
            "the colours of the corners of its meshes, but their mean",
        ),
        (
            material.clearcoat > 0.0 && material.metallic < 1.0,
            "its clear coat",
        ),
        (
            material.clearcoat > 0.0 && material.metallic > 0.0 && material.clearcoat < 1.0
                || material.clearcoat_map.is_some(),
            "the share of its clear coat",
        ),
        (sheen, "its sheen"),
        (
            material.anisotropy > 0.0 && (!is_straight || has_roughness_map),
            "the direction of its anisotropy",
        ),
        (
            is_transmissive && is_tinted,
            "the colour of the light that goes through",
        ),
        (
            material.diffuse_transmission > 0.0 && material.specular > 0.0,
            "its mirror image",
        ),
        (
            material.microfacets == Microfacets::Beckmann && material.roughness > 0.0,
            "Beckmann's distribution of facets",
        ),
        (
            material.plastic != Plastic::None,
            "the light that its plastic reflects inside",
        ),
        (material.black_back, "its black back"),
        (emission_varies, "the texture of its emission, but its mean"),
    ]
}
