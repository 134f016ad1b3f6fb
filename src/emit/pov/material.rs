//! Writes materials: of Phong's model all but glossy lobes and maps other than that of its colour;
//! of the standard material what POV-Ray's finish has.

use super::{PovWriter, vector};
use crate::approximation::without_index;
use crate::export::{called, enumeration, used_materials};
use crate::path_tracer::{TextureChannel, TexturedFactor, opacity};
use crate::picture::{ColorCoding, TexturePicture};
use crate::sidecar;
use rtc_ir::{
    Alpha, Ambient, Filter, Light, Map, Material, MaterialId, Phong, Scene, Shape, Standard,
    Surface, TextureId, ValuePath,
};
use rtc_math::{ln, shortest};
use xxhash_rust::xxh3::xxh3_64;

/// Why a texture is left out.
const NO_FILE: &str = "a texture is left out: it needs a file beside the text, as with `-o FILE`";
/// The roughness below which a mirror image is written: POV-Ray's are sharp.
const SHARP: f64 = 0.3;

/// The texture of a material that is written: that of its colour, or else of its opacity.
pub(super) fn written_map(material: &Material) -> Option<Map> {
    match material {
        Material::Phong(phong) => phong.color_map.map(Map::from),
        Material::Standard(standard) => {
            let color = standard.base_color_map.clone();
            color.or_else(|| opacity(standard, false)?.map.cloned())
        }
    }
}

/// The opacity of a material by a texture, if it is the one that is written.
fn written_opacity(standard: &Standard) -> Option<TexturedFactor<'_>> {
    let opacity = opacity(standard, false).filter(|opacity| opacity.map.is_some())?;
    let color = standard.base_color_map.as_ref();
    let is_written = color.is_none() || color == opacity.map;
    is_written.then_some(opacity)
}

/// Whether a surface is written as it is: POV-Ray's shapes have texture coordinates of their own,
/// so those with a texture become meshes, which have ours.
pub(super) fn is_written(scene: &Scene, surface: &Surface) -> bool {
    let material = &scene.materials[surface.material.0 as usize];
    matches!(surface.shape, Shape::Instance(_) | Shape::Csg(_)) || written_map(material).is_none()
}

impl PovWriter<'_> {
    /// Writes the materials of surfaces; `None` if their pictures exceed the budget.
    pub(super) fn materials(&mut self) -> Option<()> {
        for (index, material, path) in used_materials(self.scene) {
            let text = match material {
                Material::Phong(phong) => self.phong(phong, path)?,
                Material::Standard(standard) => self.standard(&without_index(standard), path)?,
            };
            self.line(&format!("#declare M{index} = {text}"));
        }
        Some(())
    }

    fn phong(&mut self, phong: &Phong, path: ValuePath) -> Option<String> {
        let missing_features = missing_features(phong);
        if !missing_features.is_empty() {
            let message = format!(
                "a material is written without {}",
                enumeration(&missing_features)
            );
            self.reporter.unsupported(&message, path);
        }
        if phong.kt > 0.0 && self.scene.settings.shadows {
            let message = "POV-Ray lets light through what is transparent: here it casts a shadow";
            self.reporter.unsupported(message, path);
        }
        let ambient = self.ambient_light().map(|channel| channel * phong.ka);
        self.shines |= ambient.iter().any(|channel| *channel > 0.0);
        // What goes through takes its share of the others, which are as strong without.
        let kept = if phong.kt < 1.0 { 1.0 - phong.kt } else { 1.0 };
        let ambient = vector(ambient.map(|channel| channel / kept));
        let map = phong.color_map.map(Map::from);
        let pigment = self.pigment(
            phong.color,
            (map.as_ref(), ColorCoding::Linear),
            phong.kt,
            path,
        )?;
        let [kd, ks, n] = [phong.kd / kept, phong.ks, phong.n].map(shortest);
        let kr = match phong.fresnel {
            false => shortest(phong.mirror_weight()),
            true => {
                let (least, most) = (phong.mirror_weight(), phong.most_mirror_weight());
                format!("{{ {}, {} fresnel on }}", shortest(least), shortest(most))
            }
        };
        Some(format!(
            "texture {{ {pigment} finish {{ ambient rgb {ambient} diffuse {kd} phong {ks} \
             phong_size {n} reflection {kr} }} }}"
        ))
    }

    /// The pigment of a colour and its texture, with the share of light that goes through.
    fn pigment(
        &mut self,
        color: [f64; 3],
        (map, coding): (Option<&Map>, ColorCoding),
        transmit: f64,
        path: ValuePath,
    ) -> Option<String> {
        let Some(map) = map else {
            let color = vector(color);
            return Some(match transmit > 0.0 {
                true => format!("pigment {{ rgb {color} transmit {} }}", shortest(transmit)),
                false => format!("pigment {{ rgb {color} }}"),
            });
        };
        let factor = match coding {
            // The texture of Phong's model replaces the colour.
            ColorCoding::Linear => [1.0; 3],
            ColorCoding::Srgb => color,
        };
        let picture = self.picture(map, path)?;
        let encoded = picture.encode(coding, |[r, g, b, _]| {
            [r * factor[0], g * factor[1], b * factor[2]]
        });
        let Some((file, extension)) = self.beside(picture.name(), encoded.ok()?) else {
            self.reporter.unsupported(NO_FILE, path);
            return self.pigment(color, (None, coding), transmit, path);
        };
        let gamma = match (extension, coding) {
            ("exr", _) => "",
            (_, ColorCoding::Srgb) => " gamma srgb",
            (_, ColorCoding::Linear) => " gamma 1",
        };
        let kind = if extension == "exr" { "exr" } else { "png" };
        let interpolate = match picture.filter {
            Filter::Linear => " interpolate 2",
            Filter::Nearest => "",
        };
        let transmit = match transmit > 0.0 {
            true => format!(" transmit all {}", shortest(transmit)),
            false => String::new(),
        };
        Some(format!(
            "pigment {{ uv_mapping image_map {{ {kind} \"{file}\"{gamma}{interpolate}{transmit} \
             }} }}"
        ))
    }

    /// The pigment of a colour, times its texture if it has one, with the opacity of a picture.
    fn cut_pigment(
        &mut self,
        color: [f64; 3],
        is_textured: bool,
        opacity: TexturedFactor<'_>,
        path: ValuePath,
    ) -> Option<String> {
        let picture = self.picture(opacity.map?, path)?;
        let bytes = picture.png_with_alpha(|texel, raw| {
            let [r, g, b, _] = if is_textured { texel } else { [1.0; 4] };
            let [alpha, ..] = opacity.channel.pixel(opacity.factor, raw);
            [r * color[0], g * color[1], b * color[2], alpha]
        });
        let is_cut = matches!(
            opacity.channel,
            TextureChannel::AlphaCut(_) | TextureChannel::RedCut(_)
        );
        let interpolate = match picture.filter {
            Filter::Linear if !is_cut => " interpolate 2",
            Filter::Linear | Filter::Nearest => "",
        };
        let Some((file, _)) = self.beside(picture.name(), (bytes, "png")) else {
            self.reporter.unsupported(NO_FILE, path);
            return self.pigment(color, (None, ColorCoding::Srgb), 0.0, path);
        };
        Some(format!(
            "pigment {{ uv_mapping image_map {{ png \"{file}\" gamma srgb{interpolate} }} }}"
        ))
    }

    /// Puts a file beside the scene; returns its name, `None` if there is no folder for it.
    pub(super) fn beside(
        &mut self,
        of: &str,
        (bytes, extension): (Vec<u8>, &'static str),
    ) -> Option<(String, &'static str)> {
        let name = sidecar::path(self.folder?, of, "picture", xxh3_64(&bytes), extension);
        self.files.insert(name.clone(), bytes);
        Some((name, extension))
    }

    /// The standard material. Its metal and its dielectric mirror what is sharp; a rough metal is
    /// matt in its colour.
    fn standard(&mut self, material: &Standard, path: ValuePath) -> Option<String> {
        let message = format!(
            "{} is written with a matt colour and sharp mirror images: POV-Ray has no other",
            called(&material.name)
        );
        self.reporter.unsupported(&message, path);
        let has_cut = opacity(material, false).is_some_and(|opacity| opacity.map.is_some());
        let cut = written_opacity(material);
        for (is_lost, what) in [
            (
                material.blend_with.is_some(),
                "the other material of its blend",
            ),
            (
                has_cut && cut.is_none(),
                "the texture of its opacity, beside that of its colour",
            ),
            (material.emissive_map.is_some(), "the texture of its light"),
            (material.bump_map.is_some(), "its bump map"),
        ] {
            if is_lost {
                let message = format!("{} is written without {what}", called(&material.name));
                self.reporter.unsupported(&message, path);
            }
        }
        let Standard {
            base_color: [r, g, b, alpha],
            metallic,
            roughness,
            transmission,
            ..
        } = *material;
        // What goes through.
        let covered = match material.alpha {
            Alpha::Opaque => 1.0,
            Alpha::Mask(cutoff) => f64::from(u8::from(alpha >= cutoff)),
            Alpha::Blend => alpha,
        };
        let through = 1.0 - covered * (1.0 - transmission * (1.0 - metallic));
        // What is emitted, as a multiple of the pigment.
        let emits = material.emissive != [0.0; 3];
        self.shines |= emits || material.unlit;
        let [color, emission] = match (material.unlit, emits) {
            (true, _) => [[r, g, b], [1.0; 3]],
            (false, false) => [[r, g, b], [0.0; 3]],
            (false, true) => emitting([r, g, b], material.emissive),
        };
        let is_sharp = roughness < SHARP && !material.unlit;
        let metal = if is_sharp { metallic } else { 0.0 };
        let diffuse = if material.unlit { 0.0 } else { 1.0 - metal };
        let map = (material.base_color_map.as_ref(), ColorCoding::Srgb);
        let pigment = match cut {
            Some(opacity) => self.cut_pigment(color, map.0.is_some(), opacity, path)?,
            None => self.pigment(color, map, through, path)?,
        };
        let reflection = match (is_sharp, metallic > 0.5) {
            (false, _) => String::new(),
            (true, true) => format!(" reflection {{ rgb {} }}", vector([r, g, b])),
            (true, false) => " reflection { 0, 1 fresnel on } conserve_energy".to_owned(),
        };
        Some(format!(
            "texture {{ {pigment} finish {{ ambient 0 diffuse {} emission rgb {}{reflection} }} }}",
            shortest(diffuse),
            vector(emission)
        ))
    }

    /// What a body of a material holds: its index of refraction and what light loses in it; empty
    /// for a surface that light does not enter.
    pub(super) fn interior(&self, MaterialId(id): MaterialId) -> String {
        let (ior, absorption) = match &self.scene.materials[id as usize] {
            Material::Phong(phong) if phong.kt > 0.0 => (phong.ior, None),
            Material::Standard(standard) if standard.roughness < SHARP => {
                // Light passes a surface that covers a part as it is.
                let is_solid = standard.alpha == Alpha::Opaque
                    && (standard.thickness > 0.0 || standard.transmission == 0.0);
                let distance = standard.attenuation_distance;
                let absorption = distance
                    .filter(|_| standard.transmission > 0.0)
                    .map(|distance| {
                        standard
                            .attenuation_color
                            .map(|c| -ln(c.max(1e-30)) / distance)
                    });
                (if is_solid { standard.ior } else { 1.0 }, absorption)
            }
            Material::Phong(_) | Material::Standard(_) => return String::new(),
        };
        let most = absorption.map_or(0.0, |all| all.into_iter().fold(0.0, f64::max));
        let fade = absorption.filter(|_| most > 0.0).map(|all| {
            // Above a power of 1000 POV-Ray fades exponentially.
            let color = vector(all.map(|channel| 1.0 - channel / most));
            let distance = shortest(1.0 / most);
            format!(" fade_power 1001 fade_distance {distance} fade_color rgb {color}")
        });
        let fade = fade.unwrap_or_default();
        format!(" interior {{ ior {}{fade} }}", shortest(ior))
    }

    /// The factor of the ambient term: the sum of the colours of all lights, or that of the ambient
    /// light.
    fn ambient_light(&self) -> [f64; 3] {
        if self.scene.settings.ambient == Ambient::Once {
            return self.scene.settings.ambient_light;
        }
        let points = self.scene.lights.iter().filter_map(Light::point);
        points.fold([0.0; 3], |sum, light| {
            [0, 1, 2].map(|channel| sum[channel] + light.color[channel])
        })
    }
}

impl<'w> PovWriter<'w> {
    /// The picture of a texture; `None` if it exceeds the budget, which is reported.
    fn picture(&mut self, map: &Map, path: ValuePath) -> Option<TexturePicture<'w>> {
        let picture = TexturePicture::new(self.scene, &self.areas, map.texture);
        if let Some(loss) = picture.loss() {
            self.reporter.unsupported(loss, path);
        }
        self.reporter.charge(picture.cost(), self.budget, path)?;
        Some(picture)
    }
}

/// A pigment, and its multiple that is emitted: the colour of the surface, but hardly any where it
/// has none and emits.
fn emitting(color: [f64; 3], radiance: [f64; 3]) -> [[f64; 3]; 2] {
    /// A reflectance that is not seen.
    const LEAST: f64 = 1e-6;
    let pigment = [0, 1, 2].map(|channel| match radiance[channel] > 0.0 {
        true => color[channel].max(LEAST),
        false => color[channel],
    });
    let emission = [0, 1, 2].map(|channel| match radiance[channel] > 0.0 {
        true => radiance[channel] / pigment[channel],
        false => 0.0,
    });
    [pigment, emission]
}

/// The features of a material that are not written.
fn missing_features(phong: &Phong) -> Vec<&'static str> {
    let has = |map: Option<TextureId>| map.is_some();
    let parts = [
        (
            phong.kt == 1.0 && phong.kd + phong.ka > 0.0,
            "its colour, as all light goes through",
        ),
        (phong.glossy_samples > 1, "the spread of its mirror image"),
        (has(phong.specular_map), "its specular map"),
        (has(phong.normal_map), "its normal map"),
        (phong.bump.is_some(), "its bump map"),
    ];
    let parts = parts.into_iter().filter(|(has, _)| *has);
    parts.map(|(_, name)| name).collect()
}
