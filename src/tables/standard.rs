//! The table of the parameters of the glTF material (glTF 2.0, appendix B, and `KHR_materials_*`).
//!
//! To add a parameter, add a row here. Each stage passes a macro to which all rows are given, and
//! generates its part from them: the fields of the IR, their validation, the keys of the scene
//! format. A property of an extension of glTF that is a parameter is a row, too.

use PropertyKind::{Color, Distance, Fraction, FractionColor, Map, NonNegative, NormalMap, Number};

/// The parameters in the order of the IR: `field: kind = default, omitted;`.
///
/// The kind defines the type of a value and its range; `omitted` names the test by which an IR text
/// omits the value. The scene format has a key for each, described by the doc comment.
#[macro_export]
macro_rules! parameters {
    ($then:ident) => {
        $then! {
            /// The colour and its alpha; of a metal that of its mirror image.
            base_color: fractions = [1.0; 4], "never";
            /// Multiplies it, alpha too; coded as sRGB.
            base_color_map: map = None, "Option::is_none";
            /// How much of it is metal.
            metallic: fraction = 1.0, "never";
            /// How rough it is: 0 is a mirror.
            roughness: fraction = 1.0, "never";
            /// Its green multiplies the roughness, its blue the metal.
            metallic_roughness_map: map = None, "Option::is_none";
            /// The reflectance at normal incidence and the glossiness (rgb, a) of
            /// `KHR_materials_pbrSpecularGlossiness`, instead of metallic, roughness and ior.
            specular_glossiness: some_fractions = None, "Option::is_none";
            /// Multiplies them, alpha too; its colour is coded as sRGB.
            specular_glossiness_map: map = None, "Option::is_none";
            /// The radiance, strength included.
            emissive: color = [0.0; 3], "is_zero";
            /// Multiplies it; coded as sRGB.
            emissive_map: map = None, "Option::is_none";
            /// The shading normal in the frame of the surface: red along u, green along v, blue
            /// away from it.
            normal_map: map = None, "Option::is_none";
            /// How much of its red and green counts.
            normal_scale: number = 1.0, "is_one";
            /// The height of the surface in its red, along the normal.
            bump_map: map = None, "Option::is_none";
            /// How high a red of 1 is, in scene units.
            bump_scale: number = 1.0, "is_one";
            /// The alpha mode: opaque, cut off, or blended.
            alpha: alpha = Alpha::Opaque, "is_default";
            /// Its red multiplies the alpha of the base colour.
            opacity_map: map = None, "Option::is_none";
            /// Whether camera rays of traced paths see the back. They always see the back of a
            /// transmitting material, and all other rays hit the back of any material.
            double_sided: flag = false, "is_default";
            /// Whether it shows its colour as it is, whatever light there is.
            unlit: flag = false, "is_default";
            /// The index of refraction, at least 1; 0 mirrors all light.
            ior: ior = 1.5, "never";
            /// The complex index of refraction of the metal at red, green and blue: the base colour
            /// is then a factor of the reflectance by the Fresnel equations.
            conductor: conductor = None, "Option::is_none";
            /// The distribution of the microfacets and how they hide each other.
            microfacets: microfacets = Microfacets::Ggx, "is_default";
            /// How light leaves the diffuse base below a boundary of the index: as glTF says, or as
            /// from a plastic, whose mirror image has the specular strength and colour as a factor.
            plastic: plastic = Plastic::None, "is_default";
            /// The other material of a blend: light meets it in place of this one with the
            /// probability of the weight. What the surface emits is of this one.
            blend_with: material = None, "Option::is_none";
            /// How much of the surface has the other material.
            blend_weight: fraction = 0.0, "is_zero";
            /// Its red multiplies that.
            blend_map: map = None, "Option::is_none";
            /// Whether its back reflects nothing.
            black_back: flag = false, "is_default";
            /// The dispersion of the index: 20 over the Abbe number.
            dispersion: non_negative = 0.0, "is_zero";
            /// How much of light is mirrored that no metal mirrors.
            specular: fraction = 1.0, "is_one";
            /// Its alpha multiplies that.
            specular_map: map = None, "Option::is_none";
            /// The colour of that mirror image, seen along the normal.
            specular_color: color = [1.0; 3], "never";
            /// Multiplies it; coded as sRGB.
            specular_color_map: map = None, "Option::is_none";
            /// The fraction of the light that is transmitted, after specular reflection.
            transmission: fraction = 0.0, "is_zero";
            /// Its red multiplies that.
            transmission_map: map = None, "Option::is_none";
            /// Whether a smooth surface that transmits light and bounds no volume is a pane of two
            /// faces, between which light is reflected again and again.
            thin_dielectric: flag = false, "is_default";
            /// How thick it is; above 0 the surface bounds a volume.
            thickness: non_negative = 0.0, "is_zero";
            /// Its green multiplies it.
            thickness_map: map = None, "Option::is_none";
            /// The distance after which white light has the attenuation colour; none for infinite.
            attenuation_distance: distance = None, "Option::is_none";
            /// The colour that white light has after the attenuation distance.
            attenuation_color: fraction_color = [1.0; 3], "never";
            /// The participating medium inside its surfaces; only path tracing shows it.
            interior: medium = None, "Option::is_none";
            /// The participating medium outside its surfaces, where there is one.
            exterior: medium = None, "Option::is_none";
            /// How much of it is under a clear coat.
            clearcoat: fraction = 0.0, "is_zero";
            /// Its red multiplies that.
            clearcoat_map: map = None, "Option::is_none";
            /// How rough the coat is.
            clearcoat_roughness: fraction = 0.0, "is_zero";
            /// Its green multiplies that.
            clearcoat_roughness_map: map = None, "Option::is_none";
            /// The shading normal of the coat.
            clearcoat_normal_map: map = None, "Option::is_none";
            /// How much of its red and green counts.
            clearcoat_normal_scale: number = 1.0, "is_one";
            /// The colour of a sheen as of cloth; black is none.
            sheen_color: fraction_color = [0.0; 3], "is_zero";
            /// Multiplies it; coded as sRGB.
            sheen_color_map: map = None, "Option::is_none";
            /// How rough the sheen is.
            sheen_roughness: fraction = 0.0, "is_zero";
            /// Its alpha multiplies that.
            sheen_roughness_map: map = None, "Option::is_none";
            /// How much the mirror image is drawn out in one direction.
            anisotropy: fraction = 0.0, "is_zero";
            /// The direction in which it is drawn out, in radians from that of u.
            anisotropy_rotation: number = 0.0, "is_zero";
            /// Its red and green are a direction, its blue multiplies the strength.
            anisotropy_map: map = None, "Option::is_none";
            /// How much of it has a thin film.
            iridescence: fraction = 0.0, "is_zero";
            /// Its red multiplies that.
            iridescence_map: map = None, "Option::is_none";
            /// The index of refraction of the film.
            iridescence_ior: index_of_refraction = 1.3, "never";
            /// How thick the film is, from the least to the greatest, in nanometres.
            iridescence_thickness: pair = [100.0, 400.0], "never";
            /// Its green says how thick, between both.
            iridescence_thickness_map: map = None, "Option::is_none";
            /// The fraction of the diffuse light that is transmitted.
            diffuse_transmission: fraction = 0.0, "is_zero";
            /// Its alpha multiplies that.
            diffuse_transmission_map: map = None, "Option::is_none";
            /// The colour of transmitted light.
            diffuse_transmission_color: fraction_color = [1.0; 3], "is_one";
            /// Multiplies it; coded as sRGB.
            diffuse_transmission_color_map: map = None, "Option::is_none";
        }
    };
}

/// What an extension's property is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PropertyKind {
    /// A number from 0 to 1.
    Fraction,
    /// Any number.
    Number,
    /// A number of at least 0.
    NonNegative,
    /// A number above 0; none is infinite.
    Distance,
    /// Three numbers of at least 0.
    Color,
    /// Three numbers from 0 to 1.
    FractionColor,
    /// A texture.
    Map,
    /// A texture of normals, with the scale of its slopes.
    NormalMap,
}

/// A property of an extension: its key, what it is, and the name of the parameter in the IR.
pub type ExtensionProperty = (&'static str, PropertyKind, &'static str);

/// The extensions whose properties are parameters unchanged, by name.
#[rustfmt::skip]
pub const MATERIAL_EXTENSIONS: &[(&str, &[ExtensionProperty])] = &[
    ("KHR_materials_ior", &[
        ("ior", NonNegative, "ior"),
    ]),
    ("KHR_materials_dispersion", &[
        ("dispersion", NonNegative, "dispersion"),
    ]),
    ("KHR_materials_specular", &[
        ("specularFactor", Fraction, "specular"),
        ("specularTexture", Map, "specularMap"),
        ("specularColorFactor", Color, "specularColor"),
        ("specularColorTexture", Map, "specularColorMap"),
    ]),
    ("KHR_materials_transmission", &[
        ("transmissionFactor", Fraction, "transmission"),
        ("transmissionTexture", Map, "transmissionMap"),
    ]),
    ("KHR_materials_volume", &[
        ("thicknessFactor", NonNegative, "thickness"),
        ("thicknessTexture", Map, "thicknessMap"),
        ("attenuationDistance", Distance, "attenuationDistance"),
        ("attenuationColor", FractionColor, "attenuationColor"),
    ]),
    ("KHR_materials_clearcoat", &[
        ("clearcoatFactor", Fraction, "clearcoat"),
        ("clearcoatTexture", Map, "clearcoatMap"),
        ("clearcoatRoughnessFactor", Fraction, "clearcoatRoughness"),
        ("clearcoatRoughnessTexture", Map, "clearcoatRoughnessMap"),
        ("clearcoatNormalTexture", NormalMap, "clearcoatNormalMap"),
    ]),
    ("KHR_materials_sheen", &[
        ("sheenColorFactor", FractionColor, "sheenColor"),
        ("sheenColorTexture", Map, "sheenColorMap"),
        ("sheenRoughnessFactor", Fraction, "sheenRoughness"),
        ("sheenRoughnessTexture", Map, "sheenRoughnessMap"),
    ]),
    ("KHR_materials_anisotropy", &[
        ("anisotropyStrength", Fraction, "anisotropy"),
        ("anisotropyRotation", Number, "anisotropyRotation"),
        ("anisotropyTexture", Map, "anisotropyMap"),
    ]),
    ("KHR_materials_diffuse_transmission", &[
        ("diffuseTransmissionFactor", Fraction, "diffuseTransmission"),
        ("diffuseTransmissionTexture", Map, "diffuseTransmissionMap"),
        ("diffuseTransmissionColorFactor", FractionColor, "diffuseTransmissionColor"),
        ("diffuseTransmissionColorTexture", Map, "diffuseTransmissionColorMap"),
    ]),
];

/// The bytes of a name in camel case, and how many of them count: `base_color` is `baseColor`.
pub const fn camel_bytes<const N: usize>(name: &str) -> ([u8; N], usize) {
    let bytes = name.as_bytes();
    let (mut camel, mut length, mut at) = ([0; N], 0, 0);
    while at < bytes.len() {
        if bytes[at] == b'_' {
            at += 1;
            camel[length] = bytes[at].to_ascii_uppercase();
        } else {
            camel[length] = bytes[at];
        }
        (at, length) = (at + 1, length + 1);
    }
    (camel, length)
}

/// The name of a field as texts write it, in camel case.
#[macro_export]
macro_rules! camel_case {
    ($field:ident) => {{
        const NAME: &str = stringify!($field);
        const CAMEL: ([u8; NAME.len()], usize) = $crate::camel_bytes(NAME);
        const KEY: &str = match std::str::from_utf8(CAMEL.0.split_at(CAMEL.1).0) {
            Ok(key) => key,
            Err(_) => panic!("the name of a field is ASCII"),
        };
        KEY
    }};
}

/// The terms of Phong's model that are fitted, of any size.
pub struct PhongTerms {
    /// The colour of the material.
    pub color: [f64; 3],
    /// The weight of the diffuse term.
    pub kd: f64,
    /// The weight of the specular term.
    pub ks: f64,
    /// The exponent of the highlight.
    pub n: f64,
    /// The weight of the refracted ray.
    pub kt: f64,
    /// The index of refraction.
    pub ior: f64,
}

/// The parameters of the glTF material closest to Phong's model; the others have defaults.
pub struct PhongFit {
    /// The colour, its weight included.
    pub base_color: [f64; 3],
    /// 1 for a mirror, else 0.
    pub metallic: f64,
    /// The perceptual roughness, √α.
    pub roughness: f64,
    /// 1 where it mirrors or refracts, else 0.
    pub specular: f64,
    /// The part of the light that is refracted.
    pub transmission: f64,
    /// 1 where it refracts, so that the surface bounds a volume; else 0.
    pub thickness: f64,
    /// The index of refraction, at least 1.
    pub ior: f64,
}

/// The glTF material closest to Phong's model: the diffuse term becomes Lambert's, a mirror without
/// one a smooth metal of its weight, and a refractive material a volume with a smooth surface.
///
/// The exponent n of a highlight becomes the width α of a microfacet distribution by n = 2/α² − 2
/// (Walter et al., "Microfacet models for refraction through rough surfaces", EGSR 2007, section
/// 5.2); glTF's roughness is √α.
pub fn fit_phong(phong: &PhongTerms) -> PhongFit {
    let fraction = |weight: f64| weight.clamp(0.0, 1.0);
    let (kd, ks, kt) = (fraction(phong.kd), fraction(phong.ks), fraction(phong.kt));
    let (mirrors, refracts) = (ks > 0.0, kt > 0.0);
    let is_mirror = mirrors && kd == 0.0 && !refracts;
    let weight = if ks > kd { 1.0 } else { kd };
    let one_if = |condition| if condition { 1.0 } else { 0.0 };
    PhongFit {
        base_color: if is_mirror {
            [ks; 3]
        } else {
            phong
                .color
                .map(|channel| fraction(channel.min(1.0) * weight))
        },
        metallic: one_if(is_mirror),
        roughness: if is_mirror || refracts {
            0.0
        } else {
            (2.0 / (phong.n + 2.0)).sqrt().sqrt()
        },
        specular: one_if(mirrors || refracts),
        transmission: kt,
        thickness: one_if(refracts),
        ior: phong.ior.max(1.0),
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn a_capital_begins_each_word_but_the_first() {
        assert_eq!(camel_case!(ior), "ior");
        assert_eq!(
            camel_case!(clearcoat_roughness_map),
            "clearcoatRoughnessMap"
        );
    }
}
