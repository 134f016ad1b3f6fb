//! Materials (`UsdShade`): `UsdPreviewSurface` as the standard material. Both have the distribution
//! of Trowbridge and Reitz (GGX), and the same meaning of metal and roughness.

use super::stage::ComposedPrim;
use super::texture::{SourceChannel, TextureLookup};
use super::{Lowering, PrimState};
use crate::exchange::material::matte;
use rtc_diag::{clip, clip_path, codes};
use rtc_ir::{Alpha, EntityKind, Map, Material, MaterialId, Standard};
use rtc_source::{Resource, Span};
use std::rc::Rc;

/// The material of prims without one, and the bits of what they show.
pub(super) type ShownMaterialKey = (String, bool, Option<[u64; 3]>, Option<u64>);

/// The memory of a material, in bytes, rounded up.
const MATERIAL_BYTES: u64 = 2048;
/// The grey of what has no colour.
const GREY: f64 = 0.5;
/// The longest chain of connections.
const MAX_CONNECTIONS: usize = 16;

/// A material of the stage.
#[derive(Debug)]
pub(super) struct BoundMaterial {
    path: String,
    standard: Standard,
    /// The primvars of both sets of texture coordinates.
    pub(super) uv_names: [String; 2],
    /// The primvar whose colour it shows, and the colour of prims without it.
    pub(super) shown_color: Option<(String, [f64; 3])>,
    span: Option<Span>,
}

/// A colour and its picture.
struct ColorInput {
    color: [f64; 3],
    look: Option<TextureLookup>,
}

impl Lowering<'_> {
    /// The material that is bound to a prim, or that of all others.
    pub(super) fn bound_material(&mut self, state: &PrimState) -> Rc<BoundMaterial> {
        let (path, span) = match &state.material {
            Some(bound) => (bound.path.to_string(), bound.span),
            None => (String::new(), self.root_span),
        };
        if let Some(known) = self.materials.get(&path) {
            return Rc::clone(known);
        }
        let lowered = Rc::new(self.lowered_material(&path, span));
        self.charge(Resource::Memory, MATERIAL_BYTES, self.root_span);
        self.materials.insert(path, Rc::clone(&lowered));
        lowered
    }

    /// The material of the IR for what a prim shows; `varies` if its vertices have the colour.
    pub(super) fn material_id(
        &mut self,
        lowered: &BoundMaterial,
        state: &PrimState,
        is_double_sided: bool,
        is_constant: bool,
        span: Span,
    ) -> Option<MaterialId> {
        // The colour and opacity of the prim show if no shader replaces them.
        let shown = |color: [f64; 3]| color.map(|channel| channel.clamp(0.0, 1.0));
        let color = lowered
            .shown_color
            .as_ref()
            .map(|(name, fallback)| match is_constant {
                true => shown(self.constant_primvar(state, name).unwrap_or(*fallback)),
                false => [1.0; 3],
            });
        let opacity = (color.is_some() && is_constant).then(|| {
            let opacity = self.constant_primvar(state, "primvars:displayOpacity");
            opacity.map_or(1.0, |[opacity]: [f64; 1]| opacity.clamp(0.0, 1.0))
        });
        // Prims with equal values share a material.
        let key = (
            lowered.path.clone(),
            is_double_sided,
            color.map(|color| color.map(f64::to_bits)),
            opacity.map(f64::to_bits),
        );
        if let Some(known) = self.placed_materials.get(&key) {
            return Some(*known);
        }
        // Complete the material with these values.
        self.charge(Resource::Memory, MATERIAL_BYTES, span)?;
        let mut standard = lowered.standard.clone();
        standard.double_sided = is_double_sided;
        if let Some([r, g, b]) = color {
            standard.base_color = [r, g, b, standard.base_color[3] * opacity.unwrap_or(1.0)];
            if opacity.is_none_or(|opacity| opacity < 1.0) && standard.alpha == Alpha::Opaque {
                standard.alpha = Alpha::Blend;
            }
        }
        let id = self.add_material(standard, lowered.span.unwrap_or(span));
        self.placed_materials.insert(key, id);
        Some(id)
    }

    pub(super) fn add_material(&mut self, standard: Standard, span: Span) -> MaterialId {
        let index = self.scene.materials.len();
        self.record(EntityKind::Material, index, span);
        self.scene.materials.push(Material::from(standard));
        MaterialId(u32::try_from(index).unwrap_or(u32::MAX))
    }

    fn lowered_material(&mut self, path: &str, bound: Span) -> BoundMaterial {
        let mut lowered = BoundMaterial {
            path: path.to_owned(),
            standard: matte([GREY; 3]),
            uv_names: ["st".to_owned(), String::new()],
            shown_color: Some(("primvars:displayColor".to_owned(), [GREY; 3])),
            span: None,
        };
        if path.is_empty() {
            return lowered;
        }
        // Find the material and its surface shader.
        const INSTEAD: &str = "the colour of the prim takes its place";
        let Some(prim) = self.prim_at(path) else {
            let message = format!("there is no material `{}`: {INSTEAD}", clip_path(path));
            self.report(&codes::USD_ARC, bound, message);
            return lowered;
        };
        lowered.span = Some(self.span_of(&prim));
        lowered.standard.name = prim.name().to_owned();
        let Some((shader, _)) = self.node(&prim, "outputs:surface") else {
            let networks = [
                "outputs:mtlx:surface",
                "outputs:ri:surface",
                "outputs:mdl:surface",
            ];
            let what = match networks.iter().any(|name| self.has(&prim, name)) {
                true => "the network for another renderer",
                false => "a material without a surface",
            };
            self.unsupported(&prim, what, INSTEAD);
            return lowered;
        };
        // Only the preview surface is supported.
        let id = self.shader_id(&shader).unwrap_or_default();
        if id != "UsdPreviewSurface" {
            self.unsupported(&shader, &format!("the shader `{}`", clip(&id)), INSTEAD);
            return lowered;
        }
        if self.node(&prim, "outputs:volume").is_some() {
            self.unsupported(&prim, "the volume", "it is left out");
        }
        // Lower its inputs.
        lowered.shown_color = None;
        self.preview(&shader, &mut lowered);
        lowered
    }

    pub(super) fn shader_id(&self, prim: &ComposedPrim) -> Option<String> {
        self.text(prim, "info:id")
    }

    /// Where the value of an input stands: there, or in the interface of the material.
    pub(super) fn value_source(
        &mut self,
        prim: &ComposedPrim,
        name: &str,
    ) -> Option<(Rc<ComposedPrim>, String)> {
        match self.source(prim, name)? {
            (prim, name) if name.starts_with("inputs:") => Some((prim, name)),
            _ => None,
        }
    }

    /// The shader whose output an input is connected to.
    pub(super) fn node(
        &mut self,
        prim: &ComposedPrim,
        name: &str,
    ) -> Option<(Rc<ComposedPrim>, String)> {
        self.connection(prim, name)?;
        match self.source(prim, name)? {
            (node, output)
                if output.starts_with("outputs:") && self.type_name(&node) == "Shader" =>
            {
                Some((node, output))
            }
            _ => None,
        }
    }

    /// Follows connections to the last attribute.
    fn source(&mut self, prim: &ComposedPrim, name: &str) -> Option<(Rc<ComposedPrim>, String)> {
        let mut at = (self.prim_at(&prim.path)?, name.to_owned());
        for _ in 0..MAX_CONNECTIONS {
            let Some((path, output)) = self.connection(&at.0, &at.1) else {
                break;
            };
            at = (self.prim_at(&path)?, output);
        }
        Some(at)
    }

    /// A colour or three numbers.
    fn color_input(
        &mut self,
        shader: &ComposedPrim,
        name: &str,
        default: [f64; 3],
        lowered: &mut BoundMaterial,
    ) -> ColorInput {
        // An input without a connection is a constant.
        let name = format!("inputs:{name}");
        let Some((node, output)) = self.node(shader, &name) else {
            let source = self.value_source(shader, &name);
            let color = source.and_then(|(prim, name)| self.vector::<3>(&prim, &name));
            return ColorInput {
                color: color.unwrap_or(default),
                look: None,
            };
        };
        // Otherwise a texture or a primvar reader supplies it.
        let id = self.shader_id(&node).unwrap_or_default();
        match id.as_str() {
            "UsdUVTexture" => {
                let look = self.texture_look(&node, &output);
                let fallback = look.as_ref().map_or(default, |look| {
                    let channel = |at: usize| look.fallback(look.channel.unwrap_or(at));
                    [channel(0), channel(1), channel(2)]
                });
                ColorInput {
                    color: fallback,
                    look,
                }
            }
            "UsdPrimvarReader_float3" | "UsdPrimvarReader_color" => {
                let source = self.value_source(&node, "inputs:varname");
                let varname = source.and_then(|(prim, name)| self.text(&prim, &name));
                let varname = varname.unwrap_or_default();
                let fallback = self.vector::<3>(&node, "inputs:fallback");
                if name == "inputs:diffuseColor" {
                    let shown = fallback.unwrap_or([GREY; 3]);
                    lowered.shown_color = Some((format!("primvars:{varname}"), shown));
                } else {
                    self.unsupported(
                        &node,
                        &format!("the primvar `{}`", clip(&varname)),
                        "its fallback takes its place",
                    );
                }
                ColorInput {
                    color: fallback.unwrap_or(default),
                    look: None,
                }
            }
            _ => {
                self.unsupported(
                    &node,
                    &format!("the shader `{}`", clip(&id)),
                    "one value takes its place",
                );
                ColorInput {
                    color: default,
                    look: None,
                }
            }
        }
    }

    /// A number; that of a picture is one of its channels.
    fn number_input(
        &mut self,
        shader: &ComposedPrim,
        name: &str,
        default: f64,
    ) -> (f64, Option<TextureLookup>) {
        let full = format!("inputs:{name}");
        let Some((node, output)) = self.node(shader, &full) else {
            let source = self.value_source(shader, &full);
            let number = source.and_then(|(prim, name)| self.number(&prim, &name));
            return (number.unwrap_or(default), None);
        };
        let id = self.shader_id(&node).unwrap_or_default();
        if id != "UsdUVTexture" {
            self.unsupported(
                &node,
                &format!("the shader `{}`", clip(&id)),
                "one value takes its place",
            );
            let fallback = self.number(&node, "inputs:fallback");
            return (fallback.unwrap_or(default), None);
        }
        let look = self.texture_look(&node, &output).map(|mut look| {
            look.channel.get_or_insert(0);
            look
        });
        let fallback = look
            .as_ref()
            .map(|look| look.fallback(look.channel.unwrap_or(0)));
        (fallback.unwrap_or(default), look)
    }

    /// `UsdPreviewSurface`.
    fn preview(&mut self, shader: &ComposedPrim, lowered: &mut BoundMaterial) {
        let mut uvs = PrimvarSets::default();
        let diffuse = self.color_input(shader, "diffuseColor", [0.18; 3], lowered);
        let opacity = self.number_input(shader, "opacity", 1.0);
        let threshold = self.number_input(shader, "opacityThreshold", 0.0).0;
        let mut standard = Standard {
            name: std::mem::take(&mut lowered.standard.name),
            metallic: 0.0,
            ..Standard::default()
        };
        self.base_color(&diffuse, &opacity, &mut standard, &mut uvs);
        standard.alpha = match (threshold > 0.0, opacity.0 < 1.0 || opacity.1.is_some()) {
            (true, _) => Alpha::Mask(threshold.min(1.0)),
            (false, true) => Alpha::Blend,
            (false, false) => Alpha::Opaque,
        };
        let is_specular = self.number_input(shader, "useSpecularWorkflow", 0.0).0 != 0.0;
        let roughness = self.number_input(shader, "roughness", 0.5);
        let metallic = match is_specular {
            true => (0.0, None),
            false => self.number_input(shader, "metallic", 0.0),
        };
        let map = self.channels([None, roughness.1.as_ref(), metallic.1.as_ref()], &mut uvs);
        standard.roughness = factor(roughness.0, roughness.1.is_some() && map.is_some());
        standard.metallic = factor(metallic.0, metallic.1.is_some() && map.is_some());
        standard.metallic_roughness_map = map;
        if is_specular {
            // A reflectance of any colour along the normal, and of white at grazing angles.
            let specular = self.color_input(shader, "specularColor", [0.0; 3], lowered);
            standard.ior = 0.0;
            standard.specular_color_map = self.color_map(&specular, &mut uvs);
            standard.specular_color = color(&specular, standard.specular_color_map.is_some());
        } else {
            let ior = self.number_input(shader, "ior", 1.5).0;
            standard.ior = if ior < 1.0 { 1.0 / ior.max(0.1) } else { ior };
        }
        let emissive = self.color_input(shader, "emissiveColor", [0.0; 3], lowered);
        self.emission(&emissive, &mut standard, &mut uvs);
        let coat = self.number_input(shader, "clearcoat", 0.0);
        standard.clearcoat_map = self.channels([coat.1.as_ref(), None, None], &mut uvs);
        standard.clearcoat = factor(coat.0, standard.clearcoat_map.is_some());
        let coat_roughness = self.number_input(shader, "clearcoatRoughness", 0.01);
        standard.clearcoat_roughness_map =
            self.channels([None, coat_roughness.1.as_ref(), None], &mut uvs);
        standard.clearcoat_roughness =
            factor(coat_roughness.0, standard.clearcoat_roughness_map.is_some());
        self.normals(shader, &mut standard, &mut uvs, lowered);
        let displacement = self.number_input(shader, "displacement", 0.0);
        if displacement.0 != 0.0 || displacement.1.is_some() {
            self.unsupported(shader, "the displacement", "the surface is shown smooth");
        }
        if uvs.is_over {
            self.approximate(
                shader,
                "its pictures have more than two sets of texture coordinates",
            );
        }
        lowered.uv_names = uvs.names;
        lowered.standard = standard;
    }

    /// The base colour and its alpha.
    fn base_color(
        &mut self,
        diffuse: &ColorInput,
        opacity: &(f64, Option<TextureLookup>),
        standard: &mut Standard,
        uvs: &mut PrimvarSets,
    ) {
        // Combine the textures of colour and opacity into one image.
        let constant = diffuse.color.map(|channel| channel.clamp(0.0, 1.0));
        let alpha = opacity.0.clamp(0.0, 1.0);
        let look = diffuse.look.as_ref().or(opacity.1.as_ref());
        let map = look.and_then(|look| {
            let mut channels: Vec<SourceChannel> = (0..3)
                .map(|at| match &diffuse.look {
                    Some(look) => look.file(look.channel.unwrap_or(at), true, 1.0, 0.0),
                    None => SourceChannel::Constant(255),
                })
                .collect();
            if let Some(look) = &opacity.1 {
                channels.push(look.file(look.channel.unwrap_or(3), false, 1.0, 0.0));
            }
            let set = uvs.set(&look.primvar);
            self.picture_map(look, channels, true, set)
        });
        // A texture replaces the constant factor.
        let [r, g, b] = if diffuse.look.is_some() && map.is_some() {
            [1.0; 3]
        } else {
            constant
        };
        let alpha = if opacity.1.is_some() && map.is_some() {
            1.0
        } else {
            alpha
        };
        standard.base_color = [r, g, b, alpha];
        standard.base_color_map = map;
    }

    fn color_map(&mut self, input: &ColorInput, uvs: &mut PrimvarSets) -> Option<Map> {
        let look = input.look.as_ref()?;
        let channel = |at: usize| look.file(look.channel.unwrap_or(at), true, 1.0, 0.0);
        let set = uvs.set(&look.primvar);
        self.picture_map(look, vec![channel(0), channel(1), channel(2)], true, set)
    }

    /// The radiance; that of a picture may be scaled beyond 1.
    fn emission(&mut self, emissive: &ColorInput, standard: &mut Standard, uvs: &mut PrimvarSets) {
        standard.emissive = emissive.color.map(|channel| channel.max(0.0));
        let Some(look) = emissive.look.as_ref() else {
            return;
        };
        let most = look.scale[..3].iter().copied().fold(1.0, f64::max);
        let channel = |at: usize| look.file(look.channel.unwrap_or(at), true, 1.0 / most, 0.0);
        let set = uvs.set(&look.primvar);
        let map = self.picture_map(look, vec![channel(0), channel(1), channel(2)], true, set);
        if map.is_some() {
            standard.emissive = [most; 3];
        }
        standard.emissive_map = map;
    }

    /// The normals of a picture: its values, scaled, are the components.
    fn normals(
        &mut self,
        shader: &ComposedPrim,
        standard: &mut Standard,
        uvs: &mut PrimvarSets,
        lowered: &mut BoundMaterial,
    ) {
        let normal = self.color_input(shader, "normal", [0.0, 0.0, 1.0], lowered);
        let Some(mut look) = normal.look else { return };
        look.is_srgb.get_or_insert(false);
        let is_plain = look.scale[..3] == [1.0; 3] && look.bias[..3] == [0.0; 3];
        let channel = |at: usize| match is_plain {
            // Without scale and bias the values of a picture of bytes would have no negative parts.
            true => look.file(at, false, 1.0, 0.0),
            false => look.file(at, false, 0.5, 0.5),
        };
        if is_plain {
            let message =
                "a map of normals without `scale` and `bias` is read as if it had those of bytes";
            self.report(&codes::USD_APPROXIMATE, look.path.span, message);
        }
        let set = uvs.set(&look.primvar);
        standard.normal_map =
            self.picture_map(&look, vec![channel(0), channel(1), channel(2)], false, set);
    }

    /// A picture whose channels are numbers.
    fn channels(
        &mut self,
        looks: [Option<&TextureLookup>; 3],
        uvs: &mut PrimvarSets,
    ) -> Option<Map> {
        let look = *looks.iter().flatten().next()?;
        let places = |look: &TextureLookup| {
            (
                look.primvar.clone(),
                look.wrap,
                look.rows.map(|row| row.map(f64::to_bits)),
            )
        };
        if looks
            .iter()
            .flatten()
            .any(|other| places(other) != places(look))
        {
            let message = "both pictures have the texture coordinates of the first one";
            self.report(&codes::USD_APPROXIMATE, look.path.span, message);
        }
        let channels = looks.map(|look| match look {
            Some(look) => look.file(look.channel.unwrap_or(0), false, 1.0, 0.0),
            None => SourceChannel::Constant(u8::MAX),
        });
        let set = uvs.set(&look.primvar);
        self.picture_map(look, channels.to_vec(), false, set)
    }
}

/// The two sets of texture coordinates of a material.
struct PrimvarSets {
    names: [String; 2],
    is_used: bool,
    is_over: bool,
}

impl Default for PrimvarSets {
    fn default() -> Self {
        Self {
            names: ["st".to_owned(), String::new()],
            is_used: false,
            is_over: false,
        }
    }
}

impl PrimvarSets {
    fn set(&mut self, name: &str) -> u32 {
        if !self.is_used {
            self.is_used = true;
            name.clone_into(&mut self.names[0]);
        }
        if self.names[0] == name {
            return 0;
        }
        if self.names[1].is_empty() {
            name.clone_into(&mut self.names[1]);
        }
        self.is_over |= self.names[1] != name;
        1
    }
}

/// A number, or 1 where a picture has it.
fn factor(number: f64, has_map: bool) -> f64 {
    if has_map { 1.0 } else { number.clamp(0.0, 1.0) }
}

fn color(input: &ColorInput, has_map: bool) -> [f64; 3] {
    if has_map {
        [1.0; 3]
    } else {
        input.color.map(|channel| channel.max(0.0))
    }
}
