//! BSDFs and textures as the standard material.
//!
//! `diffuse`, conductors, dielectrics, plastics, polarizers (in light without polarization) and
//! `mask` are exact, up to the quantization of images. For the others the closest standard material
//! is used, with a warning that describes the difference.

use super::medium::ShapeMedia;
use super::number::{NumberOrMap, NumberUse};
use super::plugins::{BSDFS, TEXTURES};
use super::xml::{PluginNode, Value};
use super::{AssetTarget, Lowering};
use crate::exchange::checkerboard::checkerboard;
use crate::exchange::color::{MIRROR, copper, metal, named_ior};
use crate::exchange::material::{matte, opaque};
use crate::exchange::transform::AffineTransform;
use rtc_diag::clip;
use rtc_ir::{
    Alpha, Conductor, EntityKind, Filter, Map, Material, MaterialId, Sampled, Standard, Texture,
    TextureId, Wrap,
};
use rtc_math::Plastic;
use rtc_source::{Resource, Span};

/// What distinguishes materials: the BSDF, the emitter, whether v points down and the back is
/// black, and the media.
pub(super) type MaterialKey = (Option<Span>, Option<Span>, [bool; 2], [Option<Span>; 2]);

/// The memory of a material, in bytes, rounded up.
const MATERIAL_BYTES: u64 = 2048;
/// The most materials of a blend.
const MAX_BLENDED: usize = 16;
/// The deepest nesting of BSDFs.
const MAX_DEPTH: usize = 16;

/// A colour that is a constant, or a map.
pub(super) struct ColorOrMap {
    pub(super) color: [f64; 3],
    pub(super) map: Option<Map>,
}

impl PluginNode {
    /// The colour of a texture that is the same everywhere.
    pub(super) fn constant(&self) -> Option<[f64; 3]> {
        let either = |names: [&str; 2]| names.into_iter().find_map(|name| self.color(name));
        match self.plugin.text.as_str() {
            "uniform" => either(["value", "color"]).or(Some([1.0; 3])),
            "srgb" => either(["color", "value"]).or(Some([1.0; 3])),
            // Relative to that of daylight, which is white.
            "d65" => {
                let scale = self.number("scale").unwrap_or(1.0);
                let color = self.color("color").unwrap_or([1.0; 3]);
                Some(color.map(|channel| scale * channel))
            }
            _ => None,
        }
    }
}

impl<'run> Lowering<'run> {
    /// The material of a shape with its emission; `None` if light passes through the shape. The
    /// back is black if the BSDF has one side, unless `is_seen_behind`.
    pub(super) fn material(
        &mut self,
        shape: &'run PluginNode,
        emitter: Option<&'run PluginNode>,
        [flip, is_seen_behind]: [bool; 2],
        media: ShapeMedia,
    ) -> Option<MaterialId> {
        // Find the BSDF of the shape.
        let node = self.bsdf_of(shape);
        // Shapes with one BSDF and one emission share a material.
        let black_back = !is_seen_behind && node.is_none_or(|node| !self.has_two_sides(node));
        let span_of = |node: Option<&PluginNode>| node.map(|node| node.span);
        let key = (
            span_of(node),
            span_of(emitter),
            [flip, black_back],
            media.key(),
        );
        if let Some(known) = self.materials.get(&key) {
            return *known;
        }
        // Lower it, and add the emission.
        let standard = match node {
            Some(node) => self.standard(node, flip, 0),
            // A light without a BSDF reflects nothing.
            None if emitter.is_some() => Some(matte([0.0; 3])),
            None => Some(matte([0.5; 3])),
        };
        // A surface that light passes unchanged still bounds a medium.
        let is_interface = emitter.is_none() && media.key() != [None; 2];
        let standard = standard.or_else(|| is_interface.then(Standard::null));
        let dark = ColorOrMap {
            color: [0.0; 3],
            map: None,
        };
        let radiance = emitter.map_or(dark, |emitter| {
            self.channel(emitter, "radiance", [1.0; 3], flip)
        });
        let id = standard.map(|standard| {
            let with_back = |part: &Standard| Standard {
                black_back,
                ..part.clone()
            };
            let standard = match black_back {
                true => self.each_other(standard, with_back),
                false => standard,
            };
            let standard = Standard {
                emissive: radiance.color,
                emissive_map: radiance.map,
                black_back,
                interior: media.interior.map(|(_, medium)| medium),
                exterior: media.exterior.map(|(_, medium)| medium),
                ..standard
            };
            let index = self.scene.materials.len();
            self.record(EntityKind::Material, index, key.0.unwrap_or(shape.span));
            let material = Material::Standard(Box::new(standard));
            self.scene.materials.push(material);
            MaterialId(u32::try_from(index).unwrap_or(u32::MAX))
        });
        self.materials.insert(key, id);
        id
    }

    /// A BSDF as a standard material, which is made once; `None` for `null`.
    fn standard(&mut self, node: &'run PluginNode, flip: bool, depth: usize) -> Option<Standard> {
        // Nesting is bounded.
        if depth >= MAX_DEPTH {
            self.unsupported(node, "it is nested too deep, and grey replaces it");
            return Some(matte([0.5; 3]));
        }
        if let Some(known) = self.standards.get(&(node.span, flip)) {
            return known.clone();
        }
        self.charge(Resource::Memory, MATERIAL_BYTES, node.span);
        let standard = self.new_standard(node, flip, depth);
        self.standards.insert((node.span, flip), standard.clone());
        standard
    }

    fn new_standard(
        &mut self,
        node: &'run PluginNode,
        flip: bool,
        depth: usize,
    ) -> Option<Standard> {
        // Each plugin becomes the standard material nearest to it.
        Some(match BSDFS.known(&node.plugin.text) {
            "diffuse" | "lambertian" => {
                let channel = self.channel(node, "reflectance", [0.5; 3], flip);
                Standard {
                    base_color_map: channel.map,
                    ..matte(channel.color)
                }
            }
            "roughdiffuse" => {
                self.approximate(node.plugin.span, "`roughdiffuse` is shown as `diffuse`");
                let channel = self.channel(node, "reflectance", [0.5; 3], flip);
                Standard {
                    base_color_map: channel.map,
                    ..matte(channel.color)
                }
            }
            "conductor" | "roughconductor" => self.conductor(node, flip),
            "dielectric" | "roughdielectric" => self.dielectric(node, true, flip),
            "thindielectric" => self.dielectric(node, false, flip),
            "plastic" | "roughplastic" | "pplastic" => self.plastic(node, flip),
            "polarizer" | "circular" => self.polarizing_filter(node, 0.5, flip),
            "retarder" => self.polarizing_filter(node, 1.0, flip),
            "principled" => self.principled(node, flip),
            "principledthin" => self.principled_thin(node, flip),
            "phong" | "ward" => {
                self.unsupported(node, "its diffuse part replaces it");
                let channel = self.channel(node, "diffuse_reflectance", [0.5; 3], flip);
                Standard {
                    base_color_map: channel.map,
                    ..matte(channel.color)
                }
            }
            "twosided" => return self.inner(node, flip, depth),
            "mask" => {
                let inner = self.inner(node, flip, depth)?;
                self.mask(node, inner, flip)
            }
            "normalmap" => {
                let inner = self.inner(node, flip, depth)?;
                let normal_map = self.map(node, "normalmap", flip);
                let with_map = |part: &Standard| Standard {
                    normal_map: normal_map.clone(),
                    ..part.clone()
                };
                let first = with_map(&inner);
                self.each_other(first, with_map)
            }
            "bumpmap" => {
                let inner = self.inner(node, flip, depth)?;
                let NumberOrMap { map, .. } =
                    self.number_or_map(node, "", 0.0, NumberUse::of(flip));
                let bump_scale = node.number("scale").unwrap_or(1.0);
                let with_map = |part: &Standard| Standard {
                    bump_map: map.clone(),
                    bump_scale,
                    ..part.clone()
                };
                let first = with_map(&inner);
                self.each_other(first, with_map)
            }
            "blendbsdf" => return self.blend(node, flip, depth),
            "null" => return None,
            _ => {
                self.unsupported(node, "diffuse grey replaces it");
                matte([0.5; 3])
            }
        })
    }

    /// A blend of two BSDFs, of which either may be a blend: the first material of a chain. `None`
    /// if light passes through both.
    fn blend(&mut self, node: &'run PluginNode, flip: bool, depth: usize) -> Option<Standard> {
        let parts: Vec<_> = self.bsdf_children(node);
        let [first, second, ..] = parts[..] else {
            self.approximate(
                node.plugin.span,
                "a blend of fewer than two BSDFs is no blend",
            );
            return self.standard(parts.first()?, flip, depth + 1);
        };
        let [first, second] = [first, second].map(|part| self.standard(part, flip, depth + 1));
        // The first material of a chain is no blend.
        let is_chain =
            |part: &Option<Standard>| part.as_ref().is_some_and(|part| part.blend_with.is_some());
        let is_swapped = is_chain(&first);
        if is_swapped && is_chain(&second) {
            let message = "of a blend of two blends the second one is shown as its first BSDF";
            self.approximate(node.plugin.span, message);
        }
        let how = NumberUse {
            is_inverted: is_swapped,
            ..NumberUse::of(flip)
        };
        let weight = self.number_or_map(node, "weight", 0.5, how);
        let (first, second) = match is_swapped {
            true => (second, first),
            false => (first, second),
        };
        let clear = || Standard {
            base_color: [0.0; 4],
            alpha: Alpha::Blend,
            ..matte([0.0; 3])
        };
        if first.is_none() && second.is_none() {
            return None;
        }
        let second = second.unwrap_or_else(clear);
        if self.others(&second) + 2 > MAX_BLENDED {
            let message = format!("a blend of more than {MAX_BLENDED} BSDFs lacks the last one");
            self.approximate(node.plugin.span, message);
            return Some(second);
        }
        let index = self.scene.materials.len();
        self.record(EntityKind::Material, index, node.span);
        self.scene
            .materials
            .push(Material::Standard(Box::new(second)));
        Some(Standard {
            blend_with: Some(MaterialId(rtc_math::to_u32(index))),
            blend_weight: weight.number.clamp(0.0, 1.0),
            blend_map: weight.map,
            ..first.unwrap_or_else(clear)
        })
    }

    /// How many materials a blend has beside the first one.
    fn others(&self, first: &Standard) -> usize {
        let next = |part: &Standard| match self.scene.materials.get(part.blend_with?.0 as usize) {
            Some(Material::Standard(part)) => Some(&**part),
            _ => None,
        };
        std::iter::successors(next(first), |part| next(part)).count()
    }

    fn bsdf_children(&mut self, node: &'run PluginNode) -> Vec<&'run PluginNode> {
        let children = node.children.iter();
        let resolved = children.filter_map(|child| self.resolve(child));
        resolved.filter(|child| child.tag == "bsdf").collect()
    }

    /// The BSDF inside another one.
    fn inner(&mut self, node: &'run PluginNode, flip: bool, depth: usize) -> Option<Standard> {
        let children = self.bsdf_children(node);
        if children.len() > 1 {
            self.approximate(node.plugin.span, "the back has the BSDF of the front");
        }
        match children.first() {
            Some(child) => self.standard(child, flip, depth + 1),
            None => {
                let message = format!("`{}` holds no BSDF: grey replaces it", node.plugin.text);
                self.approximate(node.plugin.span, message);
                Some(matte([0.5; 3]))
            }
        }
    }

    /// A metal, or a mirror without an index.
    fn conductor(&mut self, node: &'run PluginNode, flip: bool) -> Standard {
        let given = [node.color("eta"), node.color("k")];
        let name = node.string("material").map(|name| name.text.as_str());
        let conductor = match (given, name) {
            ([None, None], None | Some("none")) => MIRROR,
            ([None, None], Some(name)) => metal(name).unwrap_or_else(|| {
                let message = format!("the metal `{}` is unknown: copper replaces it", clip(name));
                self.approximate(node.plugin.span, message);
                copper()
            }),
            ([eta, k], _) => {
                let least = |part: [f64; 3]| part.map(|channel| channel.max(0.0));
                Conductor {
                    eta: least(eta.unwrap_or(MIRROR.eta)),
                    k: least(k.unwrap_or(MIRROR.k)),
                }
            }
        };
        let tint = self.channel(node, "specular_reflectance", [1.0; 3], flip);
        Standard {
            base_color: opaque(tint.color),
            base_color_map: tint.map,
            metallic: 1.0,
            conductor: Some(conductor),
            ..self.with_facets(node, flip, matte([1.0; 3]))
        }
    }

    /// An index of refraction: a number or the name of a material.
    fn ior(&mut self, node: &PluginNode, name: &str, default: f64) -> f64 {
        match node.get(name) {
            Some(Value::Number(number)) => *number,
            Some(Value::String(material)) => named_ior(&material.text).unwrap_or_else(|| {
                let message = format!("the material `{}` is not known", material.text);
                self.approximate(material.span, message);
                default
            }),
            _ => default,
        }
    }

    /// The index of the inside over that of the outside, at least 1.
    fn relative_ior(&mut self, node: &PluginNode, default: f64) -> f64 {
        let inside = self.ior(node, "int_ior", default);
        let outside = self.ior(node, "ext_ior", 1.000_277);
        let ratio = inside / outside;
        if ratio < 1.0 {
            let message = "an index of refraction below that of the outside is not supported: its \
                           inverse replaces it";
            self.approximate(node.plugin.span, message);
            return 1.0 / ratio;
        }
        ratio
    }

    fn dielectric(&mut self, node: &'run PluginNode, is_solid: bool, flip: bool) -> Standard {
        let ior = self.relative_ior(node, 1.5046);
        let tint = self.channel(node, "specular_transmittance", [1.0; 3], flip);
        if node.get("specular_reflectance").is_some() {
            self.approximate(
                node.plugin.span,
                "`specular_reflectance` of glass is left out",
            );
        }
        // The colour of a volume acts once on the way in and once on the way out.
        Standard {
            base_color: opaque(tint.color),
            base_color_map: tint.map,
            ior,
            specular: 1.0,
            transmission: 1.0,
            thickness: if is_solid { 1.0 } else { 0.0 },
            thin_dielectric: !is_solid,
            ..self.with_facets(node, flip, matte([1.0; 3]))
        }
    }

    /// A diffuse base below the boundary of a dielectric.
    fn plastic(&mut self, node: &'run PluginNode, flip: bool) -> Standard {
        let diffuse = self.channel(node, "diffuse_reflectance", [0.5; 3], flip);
        let tint = self.channel(node, "specular_reflectance", [1.0; 3], flip);
        let is_nonlinear = node.flag("nonlinear") == Some(true);
        Standard {
            base_color_map: diffuse.map,
            ior: self.relative_ior(node, 1.49),
            specular: 1.0,
            specular_color: tint.color,
            specular_color_map: tint.map,
            plastic: match is_nonlinear {
                _ if node.plugin.text == "pplastic" => Plastic::Single,
                true => Plastic::Nonlinear,
                false => Plastic::Linear,
            },
            ..self.with_facets(node, flip, matte(diffuse.color))
        }
    }

    /// An element that changes the polarization of light: of light without one, a pane without an
    /// index that lets a share through.
    fn polarizing_filter(&mut self, node: &'run PluginNode, share: f64, flip: bool) -> Standard {
        let tint = self.channel(node, "transmittance", [1.0; 3], flip);
        Standard {
            base_color: opaque(tint.color.map(|channel| share * channel)),
            base_color_map: tint.map,
            roughness: 0.0,
            ior: 1.0,
            specular: 1.0,
            transmission: 1.0,
            ..matte([1.0; 3])
        }
    }

    fn principled(&mut self, node: &'run PluginNode, flip: bool) -> Standard {
        let message = "the standard material replaces the principled BSDF";
        self.approximate(node.plugin.span, message);
        let base = self.channel(node, "base_color", [0.5; 3], flip);
        let fraction =
            |name: &str, default: f64| node.number(name).unwrap_or(default).clamp(0.0, 1.0);
        // `specular` s is a reflectance of 0.08·s along the normal (Burley 2012, section 5.2).
        let ior = match (node.number("eta"), node.number("specular")) {
            (Some(eta), _) => eta.max(1.0),
            (None, specular) => {
                let root = (0.08 * specular.unwrap_or(0.5).clamp(0.0, 1.0)).sqrt();
                (1.0 + root) / (1.0 - root)
            }
        };
        let unit = |number: f64| number.clamp(0.0, 1.0);
        let clear = self.number_or_map_named(node, "spec_trans", 0.0, NumberUse::of(flip));
        let transmission = unit(clear.number);
        let (roughness, metallic, map) = self.rough_metal(node, flip);
        Standard {
            base_color_map: base.map,
            metallic,
            roughness,
            metallic_roughness_map: map,
            ior,
            specular: 1.0,
            clearcoat: fraction("clearcoat", 0.0),
            clearcoat_roughness: 1.0 - fraction("clearcoat_gloss", 0.0),
            anisotropy: fraction("anisotropic", 0.0),
            sheen_color: [fraction("sheen", 0.0); 3],
            transmission,
            transmission_map: clear.map,
            thickness: if transmission > 0.0 { 1.0 } else { 0.0 },
            ..matte(base.color)
        }
    }

    /// The roughness and the metal of a principled BSDF, of which one may have a texture: green is
    /// the roughness, blue the metal. Textures of other parameters are told to be left out.
    fn rough_metal(&mut self, node: &'run PluginNode, flip: bool) -> (f64, f64, Option<Map>) {
        let of_channel = |channel| NumberUse {
            channel: Some(channel),
            ..NumberUse::of(flip)
        };
        let metallic = self.number_or_map_named(node, "metallic", 0.0, of_channel(2));
        let roughness = self.number_or_map_named(node, "roughness", 0.5, of_channel(1));
        if metallic.map.is_some() && roughness.map.is_some() {
            let message = "a texture of `metallic` is left out";
            self.approximate(node.plugin.span, message);
        }
        let unit = |number: f64| number.clamp(0.0, 1.0);
        let metal = match (&roughness.map, &metallic.map) {
            (Some(_), Some(_)) => 0.5,
            (_, _) => unit(metallic.number),
        };
        let map = roughness.map.or(metallic.map);
        (unit(roughness.number), metal, map)
    }

    /// A thin sheet: of its diffuse light half of `diff_trans` comes through.
    fn principled_thin(&mut self, node: &'run PluginNode, flip: bool) -> Standard {
        let message = "the standard material replaces the thin principled BSDF";
        self.approximate(node.plugin.span, message);
        let base = self.channel(node, "base_color", [0.5; 3], flip);
        let as_is = NumberUse::of(flip);
        let through = self.number_or_map_named(node, "diff_trans", 0.0, as_is);
        let clear = self.number_or_map_named(node, "spec_trans", 0.0, as_is);
        let (roughness, _, roughness_map) = self.rough_metal(node, flip);
        if through.map.is_some() {
            let message = "the texture of `diff_trans` is shown as its half";
            self.approximate(node.plugin.span, message);
        }
        let diffuse = match through.map {
            Some(_) => 0.5,
            None => (through.number / 2.0).clamp(0.0, 1.0),
        };
        let unit = |number: f64| number.clamp(0.0, 1.0);
        Standard {
            base_color_map: base.map.clone(),
            roughness,
            metallic_roughness_map: roughness_map,
            ior: node.number("eta").unwrap_or(1.5).max(1.0),
            specular: 1.0,
            anisotropy: unit(node.number("anisotropic").unwrap_or(0.0)),
            sheen_color: [unit(node.number("sheen").unwrap_or(0.0)); 3],
            transmission: unit(clear.number),
            transmission_map: clear.map,
            diffuse_transmission: diffuse,
            diffuse_transmission_color: base.color.map(unit),
            diffuse_transmission_color_map: base.map,
            ..matte(base.color)
        }
    }

    fn mask(&mut self, node: &'run PluginNode, inner: Standard, flip: bool) -> Standard {
        let NumberOrMap { number, map } =
            self.number_or_map(node, "opacity", 0.5, NumberUse::of(flip));
        // One mask in another covers by the product of both.
        let [r, g, b, alpha] = inner.base_color;
        if map.is_some() && inner.opacity_map.is_some() {
            let message = "of the textures of two masks the inner one is left out";
            self.approximate(node.plugin.span, message);
        }
        let inner = self.each_other(inner, |part| {
            let [r, g, b, alpha] = part.base_color;
            Standard {
                base_color: [r, g, b, alpha * number.clamp(0.0, 1.0)],
                alpha: Alpha::Blend,
                opacity_map: map.clone().or(part.opacity_map.clone()),
                ..part.clone()
            }
        });
        Standard {
            base_color: [r, g, b, alpha * number.clamp(0.0, 1.0)],
            alpha: Alpha::Blend,
            opacity_map: map.or(inner.opacity_map),
            ..inner
        }
    }

    /// Changes the other materials of a chain of blends; they become new ones.
    fn each_other(&mut self, first: Standard, change: impl Fn(&Standard) -> Standard) -> Standard {
        // Find the chain, the last one first.
        let mut chain = Vec::new();
        let mut next = first.blend_with;
        while let Some(Material::Standard(part)) =
            next.and_then(|id| self.scene.materials.get(id.0 as usize))
        {
            next = part.blend_with;
            chain.push(change(part));
        }
        // Link the new ones.
        let mut other = None;
        for part in chain.into_iter().rev() {
            let index = self.scene.materials.len();
            let material = Standard {
                blend_with: other,
                ..part
            };
            self.scene
                .materials
                .push(Material::Standard(Box::new(material)));
            other = Some(MaterialId(rtc_math::to_u32(index)));
        }
        Standard {
            blend_with: other,
            ..first
        }
    }

    /// A colour of a BSDF: a property or a texture.
    pub(super) fn channel(
        &mut self,
        node: &'run PluginNode,
        name: &str,
        default: [f64; 3],
        flip: bool,
    ) -> ColorOrMap {
        if let Some(color) = node.color(name) {
            return ColorOrMap { color, map: None };
        }
        let Some(texture) = node.child(name).and_then(|child| self.resolve(child)) else {
            return ColorOrMap {
                color: default,
                map: None,
            };
        };
        if let Some(color) = texture.constant() {
            return ColorOrMap { color, map: None };
        }
        match TEXTURES.known(&texture.plugin.text) {
            "mesh_attribute" => {
                let name = texture.string("name").map(|name| name.text.as_str());
                if !matches!(name, Some("vertex_color" | "face_color")) {
                    self.unsupported(texture, "white replaces it");
                }
                ColorOrMap {
                    color: [texture.number("scale").unwrap_or(1.0); 3],
                    map: None,
                }
            }
            _ => {
                let map = self.texture(texture, flip);
                if let Some(map) = map.as_ref().filter(|_| texture.flag("raw") == Some(true)) {
                    self.raw_colors.push((map.texture, texture.span));
                }
                ColorOrMap {
                    color: [1.0; 3],
                    map,
                }
            }
        }
    }

    /// The map of a texture child.
    pub(super) fn map(&mut self, node: &'run PluginNode, name: &str, flip: bool) -> Option<Map> {
        let texture = node.child(name).and_then(|child| self.resolve(child));
        let texture = texture.or_else(|| node.children.iter().find(|child| child.tag == "texture"));
        if texture.is_none() {
            let message = format!("`{}` has no texture, and no effect", node.plugin.text);
            self.approximate(node.plugin.span, message);
        }
        self.texture(texture?, flip)
    }

    /// A texture as a map; `None` for one that is not supported.
    pub(super) fn texture(&mut self, node: &'run PluginNode, flip: bool) -> Option<Map> {
        // Find the image and the filter.
        let (image, filter) = match TEXTURES.known(&node.plugin.text) {
            "bitmap" => {
                let Some(path) = node.string("filename") else {
                    self.unsupported(node, "it names no file, and white replaces it");
                    return None;
                };
                let filter = match node.string("filter_type") {
                    Some(name) if name.text == "nearest" => Filter::Nearest,
                    _ => Filter::Linear,
                };
                (self.image(path, AssetTarget::Sampled), filter)
            }
            "checkerboard" => return Some(self.checkerboard(node, flip)),
            _ => {
                self.unsupported(node, "white replaces it");
                return None;
            }
        };
        // Read the wrap mode and the transform of the coordinates.
        let wrap = match node.string("wrap_mode").map(|name| name.text.as_str()) {
            Some("mirror") => Wrap::Mirror,
            Some("clamp") => Wrap::Clamp,
            _ => Wrap::Repeat,
        };
        let rows = rows(node, flip);
        // Add the texture.
        self.scene.textures.push(Texture::Sampled(Sampled {
            image,
            wrap: [wrap; 2],
            filter,
        }));
        let index = self.scene.textures.len() - 1;
        self.record(EntityKind::Texture, index, node.span);
        Some(Map {
            texture: TextureId(u32::try_from(index).unwrap_or(u32::MAX)),
            set: 0,
            texture_from_surface: (rows != [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]).then_some(rows),
        })
    }

    fn checkerboard(&mut self, node: &PluginNode, flip: bool) -> Map {
        let (colors, squares) = checkerboard_colors(node, flip);
        self.record(EntityKind::Texture, self.scene.textures.len(), node.span);
        checkerboard(colors, squares, &mut self.scene)
    }
}

/// The colours of a checkerboard and the rows of the map to its squares, two along u and v: the
/// diagonal has `color0`.
pub(super) fn checkerboard_colors(node: &PluginNode, flip: bool) -> ([[f64; 3]; 2], [[f64; 3]; 2]) {
    let colors = [("color0", 0.4), ("color1", 0.2)];
    let colors = colors.map(|(name, grey)| node.color(name).unwrap_or([grey; 3]));
    let squares = rows(node, flip).map(|row| row.map(|number| 2.0 * number));
    (colors, squares)
}

/// The rows of the map from the texture coordinates of a surface to those of a texture; with `flip`
/// v points the other way on the surface.
pub(super) fn rows(node: &PluginNode, flip: bool) -> [[f64; 3]; 2] {
    let scale = |name| node.number(name).unwrap_or(1.0);
    let scaled = AffineTransform::scale([scale("uscale"), scale("vscale"), 1.0]);
    let offset = |name| node.number(name).unwrap_or(0.0);
    let moved = AffineTransform::translation([offset("uoffset"), offset("voffset"), 0.0]);
    let placed = moved.after(&scaled);
    let AffineTransform([x, y, _, origin]) = node.transform("to_uv").after(&placed);
    let row = |k: usize| match flip {
        false => [x[k], y[k], origin[k]],
        true => [x[k], -y[k], origin[k] + y[k]],
    };
    [row(0), row(1)]
}
