//! The table of the parameters of the glTF material (glTF 2.0, appendix B, and `KHR_materials_*`).
//!
//! A parameter is added here. The stages name a macro to which all rows are given, and make of them
//! what they can: the fields of the IR, their proof, the objects of glTF.

/// The parameters in the order of the IR: `field: kind = default, omitted;`.
///
/// The kind says which type a value has and from what range it is; `omitted` names the test by
/// which an IR text leaves the value out.
macro_rules! parameters {
    ($then:ident) => {
        $then! {
            base_color: fractions = [1.0; 4], "never";
            base_color_map: map = None, "Option::is_none";
            metallic: fraction = 1.0, "never";
            roughness: fraction = 1.0, "never";
            metallic_roughness_map: map = None, "Option::is_none";
            /// The reflectance at normal incidence and the glossiness (rgb, a) of
            /// `KHR_materials_pbrSpecularGlossiness`, in place of metallic, roughness and ior.
            specular_glossiness: some_fractions = None, "Option::is_none";
            specular_glossiness_map: map = None, "Option::is_none";
            /// The radiance, strength included.
            emissive: color = [0.0; 3], "is_zero";
            emissive_map: map = None, "Option::is_none";
            normal_map: map = None, "Option::is_none";
            normal_scale: number = 1.0, "is_one";
            alpha: alpha = Alpha::Opaque, "is_default";
            /// Whether camera rays of traced paths see the back. They always see the back of a
            /// transmitting material, and all other rays hit the back of any material.
            double_sided: flag = false, "is_default";
            unlit: flag = false, "is_default";
            ior: ior = 1.5, "never";
            dispersion: non_negative = 0.0, "is_zero";
            specular: fraction = 1.0, "is_one";
            specular_map: map = None, "Option::is_none";
            specular_color: color = [1.0; 3], "never";
            specular_color_map: map = None, "Option::is_none";
            transmission: fraction = 0.0, "is_zero";
            transmission_map: map = None, "Option::is_none";
            /// Above 0 the surface bounds a volume.
            thickness: non_negative = 0.0, "is_zero";
            thickness_map: map = None, "Option::is_none";
            /// None for infinite.
            attenuation_distance: distance = None, "Option::is_none";
            attenuation_color: fraction_color = [1.0; 3], "never";
            clearcoat: fraction = 0.0, "is_zero";
            clearcoat_map: map = None, "Option::is_none";
            clearcoat_roughness: fraction = 0.0, "is_zero";
            clearcoat_roughness_map: map = None, "Option::is_none";
            clearcoat_normal_map: map = None, "Option::is_none";
            clearcoat_normal_scale: number = 1.0, "is_one";
            sheen_color: fraction_color = [0.0; 3], "is_zero";
            sheen_color_map: map = None, "Option::is_none";
            sheen_roughness: fraction = 0.0, "is_zero";
            sheen_roughness_map: map = None, "Option::is_none";
            anisotropy: fraction = 0.0, "is_zero";
            /// In radians.
            anisotropy_rotation: number = 0.0, "is_zero";
            anisotropy_map: map = None, "Option::is_none";
            iridescence: fraction = 0.0, "is_zero";
            iridescence_map: map = None, "Option::is_none";
            iridescence_ior: index_of_refraction = 1.3, "never";
            /// From the least to the greatest, in nanometres.
            iridescence_thickness: pair = [100.0, 400.0], "never";
            iridescence_thickness_map: map = None, "Option::is_none";
            diffuse_transmission: fraction = 0.0, "is_zero";
            diffuse_transmission_map: map = None, "Option::is_none";
            diffuse_transmission_color: fraction_color = [1.0; 3], "is_one";
            diffuse_transmission_color_map: map = None, "Option::is_none";
        }
    };
}

/// The extensions whose properties are parameters as they stand: `"name" { field: kind "property"; }`.
macro_rules! extensions {
    ($then:ident) => {
        $then! {
            "KHR_materials_ior" {
                ior: non_negative "ior";
            }
            "KHR_materials_dispersion" {
                dispersion: non_negative "dispersion";
            }
            "KHR_materials_specular" {
                specular: fraction "specularFactor";
                specular_map: map "specularTexture";
                specular_color: color "specularColorFactor";
                specular_color_map: map "specularColorTexture";
            }
            "KHR_materials_transmission" {
                transmission: fraction "transmissionFactor";
                transmission_map: map "transmissionTexture";
            }
            "KHR_materials_volume" {
                thickness: non_negative "thicknessFactor";
                thickness_map: map "thicknessTexture";
                attenuation_distance: distance "attenuationDistance";
                attenuation_color: fraction_color "attenuationColor";
            }
            "KHR_materials_clearcoat" {
                clearcoat: fraction "clearcoatFactor";
                clearcoat_map: map "clearcoatTexture";
                clearcoat_roughness: fraction "clearcoatRoughnessFactor";
                clearcoat_roughness_map: map "clearcoatRoughnessTexture";
                clearcoat_normal_map: normal_map "clearcoatNormalTexture";
            }
            "KHR_materials_sheen" {
                sheen_color: fraction_color "sheenColorFactor";
                sheen_color_map: map "sheenColorTexture";
                sheen_roughness: fraction "sheenRoughnessFactor";
                sheen_roughness_map: map "sheenRoughnessTexture";
            }
            "KHR_materials_anisotropy" {
                anisotropy: fraction "anisotropyStrength";
                anisotropy_rotation: number "anisotropyRotation";
                anisotropy_map: map "anisotropyTexture";
            }
            "KHR_materials_diffuse_transmission" {
                diffuse_transmission: fraction "diffuseTransmissionFactor";
                diffuse_transmission_map: map "diffuseTransmissionTexture";
                diffuse_transmission_color: fraction_color "diffuseTransmissionColorFactor";
                diffuse_transmission_color_map: map "diffuseTransmissionColorTexture";
            }
        }
    };
}

/// The layers: lobes that a material may have beside those of its base.
///
/// Of each: its name, why a scene does not need it, the factor and the channels of the map that
/// weigh it, its maps with the factors that they multiply, and whether light goes through it. The
/// word before the braces is its field in the parameters of the BSDF.
macro_rules! layers {
    ($then:ident) => {
        $then! {
            /// `KHR_materials_clearcoat`.
            Clearcoat = clearcoat {
                told: "clearcoat", "no material has a clearcoat";
                weight: clearcoat * clearcoat_map [0..1];
                maps: clearcoat * clearcoat_map, clearcoat_roughness * clearcoat_roughness_map;
                transmits: false;
            }
            /// `KHR_materials_sheen`.
            Sheen = sheen {
                told: "sheen", "no material has sheen";
                weight: sheen_color * sheen_color_map [0..3];
                maps: sheen_color * sheen_color_map, sheen_roughness * sheen_roughness_map;
                transmits: false;
            }
            /// `KHR_materials_anisotropy`.
            Anisotropy = anisotropy {
                told: "anisotropy", "no material is anisotropic";
                weight: anisotropy * anisotropy_map [2..3];
                maps: anisotropy * anisotropy_map;
                transmits: false;
            }
            /// `KHR_materials_iridescence`.
            Iridescence = iridescence {
                told: "iridescence", "no material is iridescent";
                weight: iridescence * iridescence_map [0..1];
                maps: iridescence * iridescence_map, iridescence * iridescence_thickness_map;
                transmits: false;
            }
            /// `KHR_materials_diffuse_transmission`.
            DiffuseTransmission = diffuse_transmission {
                told: "translucency", "no material is translucent";
                weight: diffuse_transmission * diffuse_transmission_map [3..4];
                maps: diffuse_transmission * diffuse_transmission_map,
                    diffuse_transmission_color * diffuse_transmission_color_map;
                transmits: true;
            }
        }
    };
}

/// The layers whose parts are numbers and colours times maps, and no more: `field: Prepared =>
/// Parameters { part: kind(factor, map, channel); }`. The first part weighs the layer.
macro_rules! plain_layers {
    ($then:ident) => {
        $then! {
            sheen: SheenLayer => Sheen {
                color: tint(sheen_color, sheen_color_map);
                roughness: number(sheen_roughness, sheen_roughness_map, 3);
            }
            diffuse_transmission: DiffuseTransmissionLayer => DiffuseTransmission {
                factor: number(diffuse_transmission, diffuse_transmission_map, 3);
                color: tint(diffuse_transmission_color, diffuse_transmission_color_map);
            }
        }
    };
}

/// The map that a parameter of a kind of the table holds.
macro_rules! map_of {
    (map, $map:expr) => {
        $map
    };
    ($kind:ident, $value:expr) => {
        &None
    };
}

pub(crate) use {extensions, layers, map_of, parameters, plain_layers};
