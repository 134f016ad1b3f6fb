//! Materials as surfaces show them, and what path tracers lack of them.

use super::textured_factor::{TextureChannel, TexturedFactor};
use crate::approximation::approximate_phong;
use rtc_ir::{
    Alpha, ImageId, Map, Material, Medium, Mode, Pixels, Scene, Shape, Standard, Surface, Texture,
};
use rtc_math::ln;
use std::borrow::Cow;
use std::collections::BTreeSet;

/// A material on surfaces of one kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct SurfaceMaterial {
    pub(crate) material: u32,
    /// Whether they lack the texture coordinates of its maps, which have no effect then.
    lacks_uvs: bool,
    /// Whether their corners have colours.
    pub(crate) has_colors: bool,
    /// Whether they have an opacity that counts.
    pub(crate) has_opacity: bool,
}

impl SurfaceMaterial {
    pub(crate) fn of(scene: &Scene, surface: &Surface) -> Self {
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

    /// Those of all surfaces.
    pub(crate) fn all(scene: &Scene) -> BTreeSet<Self> {
        let surfaces = scene.surfaces.iter();
        surfaces.map(|surface| Self::of(scene, surface)).collect()
    }

    /// Its identifier in the file.
    pub(crate) fn id(self) -> String {
        let plain = if self.lacks_uvs { "p" } else { "" };
        let colored = if self.has_colors { "c" } else { "" };
        let covering = if self.has_opacity { "a" } else { "" };
        format!("m{}{plain}{colored}{covering}", self.material)
    }

    /// The material, without the maps that have no effect.
    pub(crate) fn standard(self, scene: &Scene) -> Standard {
        let mut material = standard(&scene.materials[self.material as usize]).into_owned();
        if self.lacks_uvs {
            material.retain_maps(|_| false);
        }
        material
    }
}

/// The other material of a blend; `None` if the material is no blend.
pub(crate) fn other_material(scene: &Scene, material: &Standard) -> Option<Standard> {
    let other = scene.materials.get(material.blend_with?.0 as usize)?;
    Some(standard(other).into_owned())
}

/// How much of a blend is its other material.
pub(crate) fn blend_weight(material: &Standard) -> TexturedFactor<'_> {
    TexturedFactor {
        factor: [material.blend_weight; 3],
        map: material.blend_map.as_ref(),
        channel: TextureChannel::Red,
    }
}

/// The set of texture coordinates that is written for a material: that of its first map.
pub(crate) fn uv_set(material: &Standard) -> u32 {
    material.maps().next().map_or(0, |map| map.set)
}

/// The material that path tracing uses.
pub(crate) fn standard(material: &Material) -> Cow<'_, Standard> {
    match material {
        Material::Standard(standard) => Cow::Borrowed(standard),
        Material::Phong(phong) => Cow::Owned(approximate_phong(phong)),
    }
}

/// Whether all light that is not reflected is transmitted.
pub(crate) fn is_glass(material: &Standard) -> bool {
    material.transmission == 1.0 && material.metallic == 0.0 && material.transmission_map.is_none()
}

/// The share of light that a surface stops, where it is not all.
pub(crate) fn opacity(material: &Standard, of_corners: bool) -> Option<TexturedFactor<'_>> {
    let [.., alpha] = material.base_color;
    let channel = match material.alpha {
        Alpha::Opaque => return None,
        Alpha::Mask(cutoff) if material.opacity_map.is_some() => TextureChannel::RedCut(cutoff),
        Alpha::Mask(cutoff) => TextureChannel::AlphaCut(cutoff),
        Alpha::Blend if material.opacity_map.is_some() => TextureChannel::Red,
        Alpha::Blend => TextureChannel::Alpha,
    };
    let map = material.opacity_map.as_ref();
    let map = map.or(material.base_color_map.as_ref());
    let channel = match of_corners && map.is_none() {
        true => TextureChannel::CornerOpacity,
        false => channel,
    };
    Some(TexturedFactor {
        factor: [alpha; 3],
        map,
        channel,
    })
}

/// The radiance that surfaces of a material emit; `None` for one that emits nothing.
pub(crate) fn radiance(material: &Standard, has_colors: bool) -> Option<TexturedFactor<'_>> {
    let radiance = match material.unlit {
        true => TexturedFactor::color(material, has_colors),
        false => TexturedFactor {
            factor: material.emissive,
            map: material.emissive_map.as_ref(),
            channel: TextureChannel::Color,
        },
    };
    (radiance.factor != [0.0; 3]).then_some(radiance)
}

/// The participating media inside and outside of surfaces of a material. A body that absorbs light
/// has one inside.
pub(crate) fn media(material: &Standard) -> [Option<Medium>; 2] {
    let interior = match (absorption(material), material.interior) {
        (None, interior) => interior,
        (Some(absorption), interior) => {
            let medium = interior.unwrap_or_default();
            let sigma_a = std::array::from_fn(|k| medium.sigma_a[k] + absorption[k]);
            Some(Medium { sigma_a, ..medium })
        }
    };
    [interior, material.exterior]
}

/// Whether a path tracer has to know about media: surfaces of a material bound some, or the camera
/// is in one.
pub(crate) fn has_media(scene: &Scene) -> bool {
    let bounds_one = |material: &Material| media(&standard(material)) != [None; 2];
    scene.medium.is_some() || scene.materials.iter().any(bounds_one)
}

/// Whether light passes surfaces of a material unchanged: they only bound media.
pub(crate) fn is_null(material: &Standard) -> bool {
    material.alpha == Alpha::Blend && material.base_color[3] == 0.0 && media(material) != [None; 2]
}

/// The coefficient of absorption inside a body of a material, per unit of length; `None` if it
/// bounds none, or a clear one.
fn absorption(material: &Standard) -> Option<[f64; 3]> {
    let distance = material.attenuation_distance?;
    let is_body = material.transmission > 0.0 && material.thickness > 0.0;
    let is_clear = material.attenuation_color == [1.0; 3];
    let of = |channel: f64| -ln(channel.max(1e-30)) / distance;
    (is_body && !is_clear).then(|| material.attenuation_color.map(of))
}

/// The features of a material that are not written: those that no path tracer here has, and those
/// of `own`, each with whether the material uses it.
pub(crate) fn missing_features(
    scene: &Scene,
    material: &Standard,
    own: &[(bool, &'static str)],
) -> Vec<&'static str> {
    let set = uv_set(material);
    let has = |maps: &[&Option<Map>]| maps.iter().any(|map| map.is_some());
    let is_on_edges =
        |map: &Map| matches!(scene.textures[map.texture.0 as usize], Texture::Image(_));
    let (is_traced, scatters_again) = match &scene.settings.mode {
        Mode::Path(path) => (true, path.multiple_scattering),
        Mode::Phong | Mode::Depth | Mode::Normal | Mode::Gooch(_) => (false, true),
    };
    let common = [
        (
            material.maps().any(|map| map.set != set),
            "the maps of its other texture coordinates",
        ),
        (
            !is_traced && material.maps().any(is_on_edges),
            "the half texel by which its image reaches beyond the edges",
        ),
        (
            !material.double_sided && material.transmission == 0.0,
            "one-sidedness for the camera",
        ),
        (
            has_two_opacities(scene, material),
            "the opacity in the texture of its colour",
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
        (
            scatters_again && material.metallic > 0.0 && material.roughness > 0.0,
            "the light that a rough metal scatters several times",
        ),
        (material.dispersion > 0.0, "its dispersion"),
        (material.iridescence > 0.0, "its thin film"),
    ];
    let features = common.into_iter().chain(own.iter().copied());
    let used = features.filter(|(is_used, _)| *is_used);
    used.map(|(_, name)| name).collect()
}

/// Whether both the image of the base colour and an opacity map hold an opacity.
fn has_two_opacities(scene: &Scene, material: &Standard) -> bool {
    let has_alpha = |map: &Map| match &scene.textures[map.texture.0 as usize] {
        Texture::Image(image) => has_alpha(scene, *image),
        Texture::Sampled(sampled) => has_alpha(scene, sampled.image),
        Texture::Uv | Texture::Procedural(_) => false,
    };
    let is_covering = material.alpha != Alpha::Opaque && material.opacity_map.is_some();
    is_covering && material.base_color_map.as_ref().is_some_and(has_alpha)
}

fn has_alpha(scene: &Scene, image: ImageId) -> bool {
    scene.images[image.0 as usize].kind == Pixels::Rgba8
}
