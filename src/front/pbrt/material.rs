//! Materials as the standard material.
//!
//! `diffuse`, `dielectric`, `conductor` and mirrors are exact, up to the quantization of pictures. For the
//! others the closest standard material is used, with a warning that says how it differs. Both pbrt
//! and the standard material have the distribution of Trowbridge and Reitz (GGX).

use super::Lowering;
use super::medium::InterfaceMedia;
use super::parameter::Parameters;
use super::plugins::MATERIALS;
use super::texture::{ColorWithMap, NumberWithMap};
use crate::exchange::SpannedText;
use crate::exchange::color::{MIRROR, of_reflectance};
use crate::exchange::material::{matte, opaque};
use rtc_diag::{clip, codes};
use rtc_ir::{Alpha, Conductor, EntityKind, Map, Material, MaterialId, Standard};
use rtc_math::ln;
use rtc_source::{Resource, Span};
use std::rc::Rc;

/// What distinguishes materials of the IR: the material, the emitted radiance, the opacity
/// and the media.
pub(super) type EmittingMaterialKey = (usize, [u64; 3], u64, Option<[Option<[u64; 7]>; 2]>);

/// The memory of a material, in bytes, rounded up.
const MATERIAL_BYTES: u64 = 2048;

/// The names of the roughness for both directions, along u and along v.
const ROUGHNESS: [&str; 3] = ["roughness", "uroughness", "vroughness"];

/// A material of the scene.
#[derive(Debug)]
pub(super) struct LoweredMaterial {
    index: usize,
    span: Option<Span>,
    /// None where light passes through the surface.
    standard: Option<Standard>,
}

impl LoweredMaterial {
    pub(super) fn transmits(&self) -> bool {
        let standard = self.standard.as_ref();
        standard.is_some_and(|standard| standard.transmission > 0.0)
    }

    /// Whether the material looks up texture coordinates.
    pub(super) fn has_maps(&self) -> bool {
        self.standard
            .as_ref()
            .is_some_and(|standard| standard.maps().next().is_some() || standard.anisotropy > 0.0)
    }
}

impl Lowering<'_> {
    pub(super) fn make_named_material(&mut self, name: SpannedText, parameters: &Parameters) {
        let Some(plugin) = parameters.string("type").cloned() else {
            let message = format!("the material `{}` has no `type`", clip(&name.text));
            return self.mistake(name.span, message);
        };
        let material = self.material(&plugin, parameters);
        self.materials.insert(name.text, material);
    }

    pub(super) fn named_material(&mut self, name: &SpannedText) {
        match self.materials.get(&name.text) {
            Some(material) => self.state.material = Some(Rc::clone(material)),
            None => {
                let name_text = clip(&name.text);
                let message = format!("there is no material `{name_text}`: the one before stays");
                self.doubtful(name.span, message);
            }
        }
    }

    /// Lowers a material directive.
    pub(super) fn material(
        &mut self,
        plugin: &SpannedText,
        parameters: &Parameters,
    ) -> Rc<LoweredMaterial> {
        let standard = self.standard(plugin, parameters);
        let standard = standard.map(|standard| self.with_bumps(standard, parameters));
        // `type` names the plugin of a named material.
        parameters.skip(&["type"]);
        self.ignored("material", &plugin.text, (&MATERIALS, parameters));
        self.charge(Resource::Memory, MATERIAL_BYTES, plugin.span);
        self.material_count += 1;
        Rc::new(LoweredMaterial {
            index: self.material_count,
            span: Some(plugin.span),
            standard,
        })
    }

    /// The material of shapes before any directive.
    pub(super) fn default_material(&self) -> Rc<LoweredMaterial> {
        Rc::new(LoweredMaterial {
            index: 0,
            span: None,
            standard: Some(matte([0.5; 3])),
        })
    }

    /// A material as a standard material; `None` where light passes through.
    fn standard(&mut self, plugin: &SpannedText, parameters: &Parameters) -> Option<Standard> {
        Some(match MATERIALS.known(&plugin.text) {
            "diffuse" => self.diffuse(parameters, "reflectance"),
            "matte" => {
                if self.scalar(parameters, "sigma", 0.0) != 0.0 {
                    let message = "the roughness `sigma` of a matte surface is left out";
                    self.approximate(plugin.span, message);
                }
                self.diffuse(parameters, "Kd")
            }
            "mirror" => self.mirror(parameters),
            "conductor" | "metal" => self.metal(plugin, parameters),
            "coatedconductor" => self.coated_conductor(plugin, parameters),
            "coateddiffuse" => self.coated_diffuse(plugin, parameters),
            "plastic" | "uber" => self.plastic(plugin, parameters),
            "substrate" => self.substrate(plugin, parameters),
            "dielectric" | "glass" => self.dielectric(plugin, parameters, true),
            "thindielectric" => self.dielectric(plugin, parameters, false),
            "diffusetransmission" | "translucent" => self.translucent(plugin, parameters),
            "disney" => self.disney(plugin, parameters),
            "mix" => return self.mix(plugin, parameters),
            "" | "none" | "interface" => return None,
            "subsurface" | "kdsubsurface" | "hair" | "measured" | "fourier" => {
                self.of_unknown_scattering(plugin, parameters)
            }
            _ => {
                let instead = "diffuse grey replaces it";
                self.unsupported("material", plugin, &MATERIALS, instead);
                matte([0.5; 3])
            }
        })
    }

    /// Reports that the standard material approximates a material, or a part of it.
    fn nearest(&mut self, plugin: &SpannedText, part: &str) {
        let name = &plugin.text;
        let message = format!("the standard material replaces {part}`{name}`");
        self.approximate(plugin.span, message);
    }

    fn diffuse(&mut self, parameters: &Parameters, name: &'static str) -> Standard {
        let channel = self.channel(parameters, name, [0.5; 3]);
        textured(channel)
    }

    /// A mirror that reflects `Kr` at all angles.
    fn mirror(&mut self, parameters: &Parameters) -> Standard {
        let tint = self.channel(parameters, "Kr", [0.9; 3]);
        Standard {
            roughness: 0.0,
            ..metallic((tint, Some(MIRROR)))
        }
    }

    fn metal(&mut self, plugin: &SpannedText, parameters: &Parameters) -> Standard {
        let default = if plugin.text == "metal" { 0.01 } else { 0.0 };
        let alpha = self.alpha(plugin, parameters, ROUGHNESS, default);
        let conductor = self.conductor_index(plugin, parameters, ["eta", "k"]);
        parameters.skip(&["Kr"]);
        rough(metallic(conductor), alpha)
    }

    /// The factor of a conductor's reflectance, and its index: with `reflectance` the one that
    /// pbrt derives from it.
    fn conductor_index(
        &mut self,
        plugin: &SpannedText,
        parameters: &Parameters,
        names: [&'static str; 2],
    ) -> (ColorWithMap, Option<Conductor>) {
        let white = |map| ColorWithMap {
            color: [1.0; 3],
            map,
        };
        if parameters.find("reflectance").is_none() {
            let conductor = self.conductor(parameters, names);
            return (white(None), Some(conductor));
        }
        let channel = self.channel(parameters, "reflectance", [1.0; 3]);
        if channel.map.is_some() {
            let message = "Schlick's approximation replaces the Fresnel equations of this metal";
            self.approximate(plugin.span, message);
            return (channel, None);
        }
        let conductor = of_reflectance([1.0; 3], channel.color);
        (white(None), Some(conductor))
    }

    fn coated_conductor(&mut self, plugin: &SpannedText, parameters: &Parameters) -> Standard {
        // A metal under a clear coat approximates the layered material.
        self.nearest(plugin, "the layers of ");
        // Read the roughness of both layers.
        let names = [
            "conductor.roughness",
            "conductor.uroughness",
            "conductor.vroughness",
        ];
        let alpha = self.alpha(plugin, parameters, names, 0.0);
        let names = [
            "interface.roughness",
            "interface.uroughness",
            "interface.vroughness",
        ];
        let coat = self.alpha(plugin, parameters, names, 0.0);
        let names = ["conductor.eta", "conductor.k"];
        // The index of refraction gives the colour of the metal.
        let conductor = self.conductor_index(plugin, parameters, names);
        parameters.skip(&[
            "interface.eta",
            "thickness",
            "maxdepth",
            "nsamples",
            "albedo",
            "g",
        ]);
        // The coat has the geometric mean of its two roughnesses.
        rough(
            Standard {
                clearcoat: 1.0,
                clearcoat_roughness: (coat[0] * coat[1]).sqrt().sqrt(),
                ..metallic(conductor)
            },
            alpha,
        )
    }

    fn coated_diffuse(&mut self, plugin: &SpannedText, parameters: &Parameters) -> Standard {
        self.nearest(plugin, "the layers of ");
        let alpha = self.alpha(plugin, parameters, ROUGHNESS, 0.0);
        let base = self.channel(parameters, "reflectance", [0.5; 3]);
        let (ior, _) = self.refraction(parameters, ["eta", "index"]);
        parameters.skip(&["thickness", "maxdepth", "nsamples", "albedo", "g"]);
        let standard = Standard {
            ior: ior.max(1.0),
            specular: 1.0,
            ..textured(base)
        };
        rough(standard, alpha)
    }

    /// `plastic` and `uber` of version 3: a diffuse part and a reflection by the Fresnel equations
    /// of glass, times `Ks`.
    fn plastic(&mut self, plugin: &SpannedText, parameters: &Parameters) -> Standard {
        let is_uber = plugin.text == "uber";
        self.nearest(plugin, "");
        let alpha = self.alpha(plugin, parameters, ROUGHNESS, 0.1);
        let base = self.channel(parameters, "Kd", [0.25; 3]);
        let specular = self.channel(parameters, "Ks", [0.25; 3]);
        let (ior, _) = match is_uber {
            true => self.refraction(parameters, ["eta", "index"]),
            false => (1.5, 0.0),
        };
        let most = greatest(specular.color);
        let mut standard = Standard {
            ior: ior.max(1.0),
            specular: most.min(1.0),
            specular_color: relative(specular.color, most),
            specular_color_map: specular.map,
            ..textured(base)
        };
        if is_uber {
            self.uber(plugin, parameters, &mut standard);
        }
        rough(standard, alpha)
    }

    /// What `uber` has beside `plastic`: a mirror, clear glass and opacity.
    fn uber(&mut self, plugin: &SpannedText, parameters: &Parameters, standard: &mut Standard) {
        let mirror = self.channel(parameters, "Kr", [0.0; 3]).color;
        standard.clearcoat = greatest(mirror).min(1.0);
        let clear = greatest(self.channel(parameters, "Kt", [0.0; 3]).color).min(1.0);
        if clear > 0.0 {
            let message = "what shines through `uber` has the colour of its diffuse part";
            self.approximate(plugin.span, message);
            standard.transmission = clear;
            standard.thickness = 1.0;
        }
        let opacity = self.number_or_map(parameters, "opacity", 1.0);
        if opacity.number < 1.0 || opacity.map.is_some() {
            *standard = covering(standard.clone(), opacity);
        }
    }

    /// The model of Ashikhmin and Shirley: a diffuse part under a reflection by Schlick's formula.
    fn substrate(&mut self, plugin: &SpannedText, parameters: &Parameters) -> Standard {
        self.nearest(plugin, "");
        let alpha = self.alpha(plugin, parameters, ROUGHNESS, 0.1);
        let base = self.channel(parameters, "Kd", [0.5; 3]);
        let specular = self.channel(parameters, "Ks", [0.5; 3]);
        let standard = Standard {
            ior: 0.0,
            specular: 1.0,
            specular_color: specular.color.map(|channel| channel.clamp(0.0, 1.0)),
            specular_color_map: specular.map,
            ..textured(base)
        };
        rough(standard, alpha)
    }

    fn dielectric(
        &mut self,
        plugin: &SpannedText,
        parameters: &Parameters,
        is_solid: bool,
    ) -> Standard {
        let alpha = self.alpha(plugin, parameters, ROUGHNESS, 0.0);
        let (ior, dispersion) = self.refraction(parameters, ["eta", "index"]);
        let ior = match ior < 1.0 {
            true => {
                let message = "an index of refraction below 1 is not supported: its inverse \
                replaces it";
                self.approximate(plugin.span, message);
                1.0 / ior.max(0.01)
            }
            false => ior,
        };
        let tint = match plugin.text == "glass" {
            true => {
                if self.channel(parameters, "Kr", [1.0; 3]).color != [1.0; 3] {
                    self.approximate(plugin.span, "`Kr` of glass is left out");
                }
                self.channel(parameters, "Kt", [1.0; 3])
            }
            false => ColorWithMap {
                color: [1.0; 3],
                map: None,
            },
        };
        let standard = Standard {
            ior,
            dispersion: if is_solid { dispersion } else { 0.0 },
            specular: 1.0,
            transmission: 1.0,
            thickness: if is_solid { 1.0 } else { 0.0 },
            thin_dielectric: !is_solid,
            ..textured(tint)
        };
        rough(standard, alpha)
    }

    /// A diffuse reflectance and a diffuse transmittance.
    fn translucent(&mut self, plugin: &SpannedText, parameters: &Parameters) -> Standard {
        let (reflected, transmitted) = if plugin.text == "translucent" {
            let message = "`translucent` is shown without its mirror image";
            self.approximate(plugin.span, message);
            parameters.skip(&["Ks", "roughness", "remaproughness"]);
            let ColorWithMap { color, map } = self.channel(parameters, "Kd", [0.25; 3]);
            let reflect = self.channel(parameters, "reflect", [0.5; 3]).color;
            let transmit = self.channel(parameters, "transmit", [0.5; 3]).color;
            let times = |by: [f64; 3]| ColorWithMap {
                color: std::array::from_fn(|c| color[c] * by[c]),
                map: map.clone(),
            };
            (times(reflect), times(transmit))
        } else {
            let scale = parameters.number("scale").unwrap_or(1.0);
            let mut part = |name| {
                let channel = self.channel(parameters, name, [0.25; 3]);
                ColorWithMap {
                    color: channel.color.map(|value| value * scale),
                    ..channel
                }
            };
            (part("reflectance"), part("transmittance"))
        };
        // The fraction `through` of the light is transmitted, the rest reflected.
        let most = |channel: &ColorWithMap| greatest(channel.color);
        let (back, through) = (most(&reflected), most(&transmitted));
        let share = if through > 0.0 {
            through / (back + through)
        } else {
            0.0
        };
        let over = |color: [f64; 3], share: f64| match share > 0.0 {
            true => color.map(|channel| (channel / share).clamp(0.0, 1.0)),
            false => [0.0; 3],
        };
        Standard {
            base_color: opaque(over(reflected.color, 1.0 - share)),
            base_color_map: reflected.map,
            diffuse_transmission: share,
            diffuse_transmission_color: over(transmitted.color, share),
            diffuse_transmission_color_map: transmitted.map,
            ..matte([1.0; 3])
        }
    }

    /// Disney's material (Burley 2012 and 2015), as far as the standard material has its parts.
    fn disney(&mut self, plugin: &SpannedText, parameters: &Parameters) -> Standard {
        self.nearest(plugin, "");
        let base = self.channel(parameters, "color", [0.5; 3]);
        let mut fraction = |name, default| self.scalar(parameters, name, default).clamp(0.0, 1.0);
        let sheen = fraction("sheen", 0.0);
        let transmission = fraction("spectrans", 0.0);
        let standard = Standard {
            metallic: fraction("metallic", 0.0),
            roughness: fraction("roughness", 0.5),
            specular: 1.0,
            clearcoat: fraction("clearcoat", 0.0),
            clearcoat_roughness: 1.0 - fraction("clearcoatgloss", 1.0),
            anisotropy: fraction("anisotropic", 0.0),
            sheen_color: [sheen; 3],
            transmission,
            diffuse_transmission: (fraction("difftrans", 0.0) / 2.0).min(1.0),
            thickness: if transmission > 0.0 { 1.0 } else { 0.0 },
            ..textured(base)
        };
        let (ior, _) = self.refraction(parameters, ["eta", "index"]);
        Standard {
            ior: ior.max(1.0),
            ..standard
        }
    }

    fn of_unknown_scattering(&mut self, plugin: &SpannedText, parameters: &Parameters) -> Standard {
        let name = if parameters.find("Kd").is_some() {
            "Kd"
        } else {
            "reflectance"
        };
        let base = self.channel(parameters, name, [0.5; 3]);
        let message = format!(
            "the material `{}` is not supported: a diffuse surface replaces it",
            plugin.text
        );
        self.report(&codes::PBRT_PLUGIN, plugin.span, message);
        // The other parameters go with the material.
        parameters.skip(&[
            "sigma_a",
            "sigma_s",
            "mfp",
            "mean free path",
            "name",
            "eta",
            "g",
            "scale",
            "roughness",
            "uroughness",
            "vroughness",
            "remaproughness",
            "bsdffile",
            "filename",
            "beta_m",
            "beta_n",
            "alpha",
            "eumelanin",
            "pheomelanin",
            "color",
            "Kr",
            "Kt",
        ]);
        textured(base)
    }

    /// A mix of two materials.
    fn mix(&mut self, plugin: &SpannedText, parameters: &Parameters) -> Option<Standard> {
        let names: Vec<SpannedText> = match parameters.strings("materials") {
            Some(names) => names.to_vec(),
            // Version 3 has them in the other order: `amount` is the share of the first one.
            None => ["namedmaterial2", "namedmaterial1"]
                .into_iter()
                .filter_map(|name| parameters.string(name).cloned())
                .collect(),
        };
        let [first, second] = match <[SpannedText; 2]>::try_from(names) {
            Ok(names) => names.map(|name| match self.materials.get(&name.text) {
                Some(material) => Some(material.standard.clone()),
                None => {
                    let name_text = clip(&name.text);
                    let message = format!("there is no material `{name_text}`: grey replaces it");
                    self.doubtful(name.span, message);
                    Some(Some(matte([0.5; 3])))
                }
            }),
            Err(_) => {
                self.mistake(plugin.span, "a mix needs the names of two materials");
                [None, None]
            }
        };
        let (Some(first), Some(second)) = (first, second) else {
            return Some(matte([0.5; 3]));
        };
        let amount = self.number_or_map(parameters, "amount", 0.5);
        let share = amount.number.clamp(0.0, 1.0);
        match (first, second) {
            (first, _) if share == 0.0 => first,
            (_, second) if share == 1.0 && amount.map.is_none() => second,
            (None, None) => None,
            (first, second) => self.blend(plugin, [first, second], amount),
        }
    }

    /// A blend of two materials; light passes through what is none.
    fn blend(
        &mut self,
        plugin: &SpannedText,
        [first, second]: [Option<Standard>; 2],
        amount: NumberWithMap,
    ) -> Option<Standard> {
        let clear = || covering(matte([0.0; 3]), 0.0.into());
        let [first, second] = [first, second].map(|part| part.unwrap_or_else(clear));
        // The first material of a chain is no blend.
        let (first, second, amount) = match (&first.blend_with, &second.blend_with) {
            (Some(_), None) if amount.map.is_none() => {
                (second, first, (1.0 - amount.number).into())
            }
            (Some(_), _) => {
                let message = "a mix of mixes shows one material of its first one";
                self.approximate(plugin.span, message);
                (first, second, amount)
            }
            (None, _) => (first, second, amount),
        };
        self.charge(Resource::Memory, MATERIAL_BYTES, plugin.span)?;
        let index = self.scene.materials.len();
        self.record(EntityKind::Material, index, plugin.span);
        self.scene
            .materials
            .push(Material::Standard(Box::new(second)));
        Some(Standard {
            blend_with: Some(MaterialId(rtc_math::to_u32(index))),
            blend_weight: amount.number.clamp(0.0, 1.0),
            blend_map: amount.map,
            ..first
        })
    }

    /// Adds the map of heights and that of normals.
    fn with_bumps(&mut self, standard: Standard, parameters: &Parameters) -> Standard {
        // Version 3 has `bumpmap`.
        let name = match parameters.find("displacement") {
            Some(_) => "displacement",
            None => "bumpmap",
        };
        let height = self.number_or_map(parameters, name, 0.0);
        let standard = Standard {
            bump_scale: if height.map.is_some() {
                height.number
            } else {
                1.0
            },
            bump_map: height.map,
            ..standard
        };
        let Some(path) = parameters.string("normalmap").cloned() else {
            return standard;
        };
        let normal_map = self.normal_map(&path).map(|texture| Map {
            texture,
            set: 0,
            texture_from_surface: Some([[1.0, 0.0, 0.0], [0.0, -1.0, 1.0]]),
        });
        Standard {
            normal_map,
            ..standard
        }
    }

    /// The widths of the distribution along u and v.
    fn alpha(
        &mut self,
        plugin: &SpannedText,
        parameters: &Parameters,
        [both, u, v]: [&'static str; 3],
        default: f64,
    ) -> [f64; 2] {
        let remap = parameters.flag("remaproughness") != Some(false);
        let both = self.scalar(parameters, both, default);
        // The glass of version 3 has no `roughness` for both.
        let (u, v) = (
            self.scalar(parameters, u, both),
            self.scalar(parameters, v, both),
        );
        let is_old = matches!(
            plugin.text.as_str(),
            "metal" | "plastic" | "uber" | "substrate" | "glass"
        );
        [u, v]
            .map(|roughness| match (remap, is_old) {
                (false, _) => roughness,
                (true, _) if roughness <= 0.0 && (!is_old || plugin.text == "glass") => 0.0,
                (true, true) => alpha_of_version_3(roughness),
                (true, false) => roughness.max(0.0).sqrt(),
            })
            .map(|alpha| alpha.clamp(0.0, 1.0))
    }

    /// A material that a map of an opacity covers.
    pub(super) fn covered(
        &mut self,
        material: &Rc<LoweredMaterial>,
        opacity: NumberWithMap,
        span: Span,
    ) -> Rc<LoweredMaterial> {
        let Some(standard) = &material.standard else {
            return Rc::clone(material);
        };
        if standard.opacity_map.is_some() {
            let message = "the texture of `alpha` replaces that of the opacity of the material";
            self.approximate(span, message);
        }
        let key = (material.index, format!("{:?}", opacity.map));
        if let Some(known) = self.covered_materials.get(&key) {
            return Rc::clone(known);
        }
        let standard = covering(standard.clone(), opacity);
        self.charge(Resource::Memory, MATERIAL_BYTES, span);
        self.material_count += 1;
        let covered = Rc::new(LoweredMaterial {
            index: self.material_count,
            span: material.span,
            standard: Some(standard),
        });
        self.covered_materials.insert(key, Rc::clone(&covered));
        covered
    }

    /// The material of the IR for a shape with its emission and opacity; `None` where light passes
    /// through.
    pub(super) fn material_id(
        &mut self,
        material: &LoweredMaterial,
        radiance: [f64; 3],
        (opacity, media): (f64, InterfaceMedia),
        span: Span,
    ) -> Option<MaterialId> {
        // A surface that light passes unchanged still bounds a medium.
        let is_interface = media.is_transition() && radiance == [0.0; 3];
        let standard = match &material.standard {
            Some(standard) => standard.clone(),
            None if is_interface => Standard::null(),
            None => return None,
        };
        let key = (
            material.index,
            radiance.map(f64::to_bits),
            opacity.to_bits(),
            media.key(),
        );
        if let Some(known) = self.placed_materials.get(&key) {
            return Some(*known);
        }
        self.charge(Resource::Memory, MATERIAL_BYTES, span)?;
        let mut standard = Standard {
            emissive: radiance,
            ..standard
        };
        if media.is_transition() {
            (standard.interior, standard.exterior) = (media.interior, media.exterior);
        }
        if opacity < 1.0 {
            standard = covering(standard, opacity.into());
        }
        let index = self.scene.materials.len();
        self.record(EntityKind::Material, index, material.span.unwrap_or(span));
        self.scene
            .materials
            .push(Material::Standard(Box::new(standard)));
        let id = MaterialId(u32::try_from(index).unwrap_or(u32::MAX));
        self.placed_materials.insert(key, id);
        Some(id)
    }
}

/// The width of the distribution for a roughness of version 3: the polynomial of its
/// `TrowbridgeReitzDistribution::RoughnessToAlpha`.
fn alpha_of_version_3(roughness: f64) -> f64 {
    let x = ln(roughness.max(1e-3));
    1.62142 + x * (0.819_955 + x * (0.1734 + x * (0.017_120_1 + x * 0.000_640_711)))
}

/// A material with the distribution of these widths. The roughness of the standard material is √α;
/// along the tangent its width is α + (1 − α)·a² for the anisotropy a (`KHR_materials_anisotropy`).
fn rough(standard: Standard, [u, v]: [f64; 2]) -> Standard {
    let (least, most) = (u.min(v), u.max(v));
    let is_round = most - least < 1e-6 || least >= 1.0;
    Standard {
        roughness: least.sqrt(),
        anisotropy: match is_round {
            true => 0.0,
            false => ((most - least) / (1.0 - least)).sqrt().min(1.0),
        },
        anisotropy_rotation: if v > u && !is_round {
            std::f64::consts::FRAC_PI_2
        } else {
            0.0
        },
        ..standard
    }
}

/// A metal by the factor of its reflectance and its index; without one the factor is the
/// reflectance along the normal, by Schlick's approximation.
fn metallic((tint, conductor): (ColorWithMap, Option<Conductor>)) -> Standard {
    Standard {
        base_color: opaque(tint.color),
        base_color_map: tint.map,
        metallic: 1.0,
        conductor,
        ..matte([1.0; 3])
    }
}

/// The greatest channel of a colour, at least 0.
fn greatest(color: [f64; 3]) -> f64 {
    color.into_iter().fold(0.0, f64::max)
}

/// A colour over the greatest of its channels.
fn relative(color: [f64; 3], most: f64) -> [f64; 3] {
    match most > 0.0 {
        true => color.map(|channel| (channel / most).max(0.0)),
        false => [1.0; 3],
    }
}

/// A material with partial coverage. Of two maps of an opacity it has the outer one.
fn covering(standard: Standard, share: NumberWithMap) -> Standard {
    let [r, g, b, alpha] = standard.base_color;
    Standard {
        base_color: [r, g, b, alpha * share.number.clamp(0.0, 1.0)],
        alpha: Alpha::Blend,
        opacity_map: share.map.or(standard.opacity_map),
        ..standard
    }
}

fn textured(channel: ColorWithMap) -> Standard {
    Standard {
        base_color_map: channel.map,
        ..matte(channel.color)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_widths_of_a_distribution_are_kept() {
        for [u, v] in [[0.2, 0.2], [0.5, 0.1], [0.1, 0.5], [0.0, 0.3]] {
            let standard = rough(matte([1.0; 3]), [u, v]);
            let base = standard.roughness * standard.roughness;
            let along = base + (1.0 - base) * standard.anisotropy * standard.anisotropy;
            let is_turned = standard.anisotropy_rotation != 0.0;
            let found = if is_turned {
                [base, along]
            } else {
                [along, base]
            };
            assert!(
                (found[0] - u).abs() < 1e-12 && (found[1] - v).abs() < 1e-12,
                "{found:?}"
            );
        }
    }

    #[test]
    fn the_roughness_of_version_3_ends_where_its_polynomial_does() {
        assert!((alpha_of_version_3(1.0) - 1.62142).abs() < 1e-12);
        let least = alpha_of_version_3(1e-3);
        assert!((alpha_of_version_3(0.0) - least).abs() < 1e-12 && least > 0.0);
    }
}
