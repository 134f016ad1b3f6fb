//! Textures: the IR can represent an image or a checkerboard of the texture coordinates, times a
//! colour.

use super::Lowering;
use super::image::{ImageMap, ImageUse};
use super::parameter::{ParameterValues, Parameters};
use super::plugins::TEXTURES;
use crate::exchange::SpannedText;
use crate::exchange::checkerboard::checkerboard;
use rtc_diag::{clip, codes};
use rtc_ir::{Filter, Map, TextureId, Wrap};
use std::rc::Rc;

/// A pattern over the texture coordinates.
#[derive(Clone, Debug)]
pub(super) enum PbrtPattern {
    Image(Rc<ImageMap>),
    /// Squares of a period of two.
    Checkerboard([[f64; 3]; 2]),
}

/// How surface coordinates become those of the texture: scales and shifts of u and v.
#[derive(Clone, Copy, Debug)]
pub(super) struct UvMapping {
    scale: [f64; 2],
    shift: [f64; 2],
}

/// A colour, or one times a pattern.
#[derive(Clone, Debug)]
pub(super) struct ScaledTexture {
    pub(super) factor: [f64; 3],
    pub(super) pattern: Option<(PbrtPattern, UvMapping)>,
}

impl ScaledTexture {
    pub(super) fn constant(factor: [f64; 3]) -> Self {
        Self {
            factor,
            pattern: None,
        }
    }

    fn scaled(&self, by: [f64; 3]) -> Self {
        Self {
            factor: std::array::from_fn(|channel| self.factor[channel] * by[channel]),
            pattern: self.pattern.clone(),
        }
    }

    /// The mean of a checkerboard; half the factor of an image, whose mean is not known before it
    /// is read.
    pub(super) fn mean(&self) -> [f64; 3] {
        match &self.pattern {
            Some((PbrtPattern::Checkerboard([a, b]), _)) => {
                std::array::from_fn(|c| self.factor[c] * (a[c] + b[c]) / 2.0)
            }
            Some((PbrtPattern::Image(_), _)) => self.factor.map(|channel| channel / 2.0),
            None => self.factor,
        }
    }
}

/// A colour with a map of the IR.
pub(super) struct ColorWithMap {
    pub(super) color: [f64; 3],
    pub(super) map: Option<Map>,
}

/// A number with a map of the IR, whose red multiplies it.
pub(super) struct NumberWithMap {
    pub(super) number: f64,
    pub(super) map: Option<Map>,
}

impl From<f64> for NumberWithMap {
    fn from(number: f64) -> Self {
        Self { number, map: None }
    }
}

impl Lowering<'_> {
    /// A `Texture` directive: a name for a texture.
    pub(super) fn texture(
        &mut self,
        name: SpannedText,
        kind: &SpannedText,
        plugin: &SpannedText,
        parameters: &Parameters,
    ) {
        let texture = self.texture_of(plugin, parameters);
        // The parameters of an unsupported texture are marked as read.
        if TEXTURES.find(&plugin.text).is_some() {
            self.ignored("texture", &plugin.text, (&TEXTURES, parameters));
        }
        match kind.text.as_str() {
            "float" => drop(self.floats.insert(name.text, texture)),
            "color" | "spectrum" => drop(self.colors.insert(name.text, texture)),
            _ => {
                let message = format!("`{}` is neither `float` nor `spectrum`", clip(&kind.text));
                self.mistake(kind.span, message);
            }
        }
    }

    fn texture_of(&mut self, plugin: &SpannedText, parameters: &Parameters) -> ScaledTexture {
        match TEXTURES.known(&plugin.text) {
            "constant" => self.operand(parameters, "value", [1.0; 3]),
            "scale" => self.scale_texture(plugin, parameters),
            "mix" => self.mix_texture(plugin, parameters),
            "imagemap" => self.image_texture(plugin, parameters),
            "checkerboard" => self.checkerboard(plugin, parameters),
            _ => {
                self.unsupported("texture", plugin, &TEXTURES, "grey replaces it");
                ScaledTexture::constant([0.5; 3])
            }
        }
    }

    /// A parameter of a texture: a colour, or another texture.
    fn operand(
        &mut self,
        parameters: &Parameters,
        name: &'static str,
        default: [f64; 3],
    ) -> ScaledTexture {
        self.named_texture(parameters, name)
            .or_else(|| self.color(parameters, name).map(ScaledTexture::constant))
            .unwrap_or_else(|| ScaledTexture::constant(default))
    }

    /// The texture that a parameter names.
    pub(super) fn named_texture(
        &mut self,
        parameters: &Parameters,
        name: &'static str,
    ) -> Option<ScaledTexture> {
        let parameter = parameters.find(name)?;
        if parameter.kind != super::parameter::ParameterType::Texture {
            return None;
        }
        parameters.take(name);
        let ParameterValues::Strings(strings) = &parameter.values else {
            return None;
        };
        let text = strings.first()?;
        let known = self
            .colors
            .get(&text.text)
            .or_else(|| self.floats.get(&text.text));
        let known = known.cloned();
        if known.is_none() {
            let name = clip(&text.text);
            let message = format!("there is no texture `{name}`: the default replaces it");
            self.doubtful(text.span, message);
        }
        known
    }

    fn scale_texture(&mut self, plugin: &SpannedText, parameters: &Parameters) -> ScaledTexture {
        // Version 3 has `tex1` and `tex2`, version 4 `tex` and `scale`.
        let pick = |new, old| match parameters.find(new) {
            Some(_) => new,
            None => old,
        };
        let a = self.operand(parameters, pick("tex", "tex1"), [1.0; 3]);
        let b = self.operand(parameters, pick("scale", "tex2"), [1.0; 3]);
        match (&a.pattern, &b.pattern) {
            (_, None) => a.scaled(b.factor),
            (None, Some(_)) => b.scaled(a.factor),
            (Some(_), Some(_)) => {
                let message = "the product of two patterns is shown as the first one";
                self.approximate(plugin.span, message);
                a.scaled(b.mean())
            }
        }
    }

    fn mix_texture(&mut self, plugin: &SpannedText, parameters: &Parameters) -> ScaledTexture {
        let a = self.operand(parameters, "tex1", [0.0; 3]);
        let b = self.operand(parameters, "tex2", [1.0; 3]);
        let amount = self.operand(parameters, "amount", [0.5; 3]);
        let weight = amount.mean();
        let mixed = |a: [f64; 3], b: [f64; 3]| {
            std::array::from_fn(|c| a[c] * (1.0 - weight[c]) + b[c] * weight[c])
        };
        if a.pattern.is_none() && b.pattern.is_none() && amount.pattern.is_none() {
            return ScaledTexture::constant(mixed(a.factor, b.factor));
        }
        let message = "a mix of patterns is shown as the one of the larger weight";
        self.approximate(plugin.span, message);
        if weight[1] > 0.5 { b } else { a }
    }

    fn image_texture(&mut self, plugin: &SpannedText, parameters: &Parameters) -> ScaledTexture {
        let Some(path) = parameters.string("filename").cloned() else {
            self.mistake(plugin.span, "an image texture needs a `filename`");
            return ScaledTexture::constant([0.5; 3]);
        };
        let wrap = match parameters.word("wrap", "repeat").as_str() {
            "clamp" => Wrap::Clamp,
            "black" => {
                let message = "`black` around a texture is shown as its edge";
                self.approximate(path.span, message);
                Wrap::Clamp
            }
            _ => Wrap::Repeat,
        };
        let filter = match parameters.word("filter", "bilinear").as_str() {
            "point" => Filter::Nearest,
            _ => Filter::Linear,
        };
        // How far textures are blurred in the distance is `rtc`'s own affair.
        parameters.skip(&["trilinear", "maxanisotropy", "noiseaware"]);
        let gamma = parameters
            .flag("gamma")
            .map(|is_srgb| if is_srgb { "srgb" } else { "linear" });
        let encoding = parameters.word("encoding", gamma.unwrap_or("srgb"));
        let image = ImageMap {
            path,
            wrap,
            filter,
            is_linear: encoding == "linear",
            is_inverted: parameters.flag("invert") == Some(true),
        };
        if encoding != "linear" && encoding != "srgb" {
            let message = format!("the encoding `{}` is taken for sRGB", clip(&encoding));
            self.approximate(image.path.span, message);
        }
        let mapping = self.mapping(plugin, parameters);
        let scale = parameters.number("scale").unwrap_or(1.0);
        ScaledTexture {
            factor: [scale; 3],
            pattern: mapping.map(|mapping| (PbrtPattern::Image(Rc::new(image)), mapping)),
        }
    }

    /// The mapping of the texture coordinates; `None` for one by position, which is reported.
    fn mapping(&mut self, plugin: &SpannedText, parameters: &Parameters) -> Option<UvMapping> {
        let kind = parameters.word("mapping", "uv");
        let number = |name, default| parameters.number(name).unwrap_or(default);
        let mapping = UvMapping {
            scale: [number("uscale", 1.0), number("vscale", 1.0)],
            shift: [number("udelta", 0.0), number("vdelta", 0.0)],
        };
        if kind == "uv" {
            return Some(mapping);
        }
        parameters.skip(&["v1", "v2"]);
        let message = format!(
            "the mapping `{}` is not supported: the mean of the texture replaces it",
            clip(&kind)
        );
        self.report(&codes::PBRT_PLUGIN, plugin.span, message);
        None
    }

    fn checkerboard(&mut self, plugin: &SpannedText, parameters: &Parameters) -> ScaledTexture {
        parameters.skip(&["aamode"]);
        let a = self.operand(parameters, "tex1", [1.0; 3]);
        let b = self.operand(parameters, "tex2", [0.0; 3]);
        let colors = [a.mean(), b.mean()];
        if a.pattern.is_some() || b.pattern.is_some() {
            let message = "the squares of a checkerboard are shown in one colour each";
            self.approximate(plugin.span, message);
        }
        let mapping = if parameters.count("dimension") == Some(3) {
            let message = "a checkerboard in space is shown as its mean";
            self.approximate(plugin.span, message);
            None
        } else {
            self.mapping(plugin, parameters)
        };
        let pattern = mapping.map(|mapping| (PbrtPattern::Checkerboard(colors), mapping));
        let factor = match pattern {
            Some(_) => [1.0; 3],
            None => std::array::from_fn(|c| (colors[0][c] + colors[1][c]) / 2.0),
        };
        ScaledTexture { factor, pattern }
    }

    /// A colour of a material: a constant or a texture.
    pub(super) fn channel(
        &mut self,
        parameters: &Parameters,
        name: &'static str,
        default: [f64; 3],
    ) -> ColorWithMap {
        let texture = self.operand(parameters, name, default);
        self.lower_texture(&texture)
    }

    fn lower_texture(&mut self, texture: &ScaledTexture) -> ColorWithMap {
        let Some((pattern, mapping)) = &texture.pattern else {
            return ColorWithMap {
                color: texture.factor,
                map: None,
            };
        };
        let map = match pattern {
            PbrtPattern::Image(image) => {
                let texture = self.image_map(image, ImageUse::Colors);
                texture.map(|id| mapping.map(id))
            }
            PbrtPattern::Checkerboard(colors) => {
                Some(checkerboard(*colors, mapping.rows(), &mut self.scene))
            }
        };
        ColorWithMap {
            color: match map {
                Some(_) => texture.factor,
                None => texture.factor.map(|channel| channel / 2.0),
            },
            map,
        }
    }

    /// A number of a material or a shape: a constant, times the red of a map.
    pub(super) fn number_or_map(
        &mut self,
        parameters: &Parameters,
        name: &'static str,
        default: f64,
    ) -> NumberWithMap {
        let texture = self.operand(parameters, name, [default; 3]);
        let mean = |[r, g, b]: [f64; 3]| (r + g + b) / 3.0;
        let number = mean(texture.factor);
        let map = match &texture.pattern {
            None => None,
            Some((PbrtPattern::Image(image), mapping)) => {
                let id = self.image_map(image, ImageUse::Numbers);
                id.map(|id| mapping.map(id))
            }
            Some((PbrtPattern::Checkerboard(colors), mapping)) => {
                let greys = colors.map(|color| [mean(color); 3]);
                Some(checkerboard(greys, mapping.rows(), &mut self.scene))
            }
        };
        NumberWithMap { number, map }
    }

    /// A number of a material; the mean of a texture, which is reported.
    pub(super) fn scalar(
        &mut self,
        parameters: &Parameters,
        name: &'static str,
        default: f64,
    ) -> f64 {
        let texture = self.operand(parameters, name, [default; 3]);
        if texture.pattern.is_some()
            && let Some(parameter) = parameters.get(name)
        {
            let message = format!("the texture of `{name}` is shown as its mean");
            self.approximate(parameter.name.span, message);
        }
        let [r, g, b] = texture.mean();
        (r + g + b) / 3.0
    }
}

impl UvMapping {
    fn rows(&self) -> [[f64; 3]; 2] {
        let ([su, sv], [du, dv]) = (self.scale, self.shift);
        [[su, 0.0, du], [0.0, sv, dv]]
    }

    /// The map of an image. pbrt's v points up in an image, that of the IR down.
    fn map(&self, texture: TextureId) -> Map {
        let [u, [a, b, c]] = self.rows();
        Map {
            texture,
            set: 0,
            texture_from_surface: Some([u, [-a, -b, 1.0 - c]]),
        }
    }
}
