//! The proof of the material of glTF: every factor within the range its specification gives.

use super::check::{Check, Counts, LARGEST, place};
use crate::diag::{Diagnostic, codes};
use crate::ir::{self, Alpha, Field, Map, Noun, Place, Standard};

/// The proven material: the numbers as they are, each in its range, and maps that exist.
pub(super) fn standard(
    material: &Standard,
    index: usize,
    counts: &Counts,
    check: &mut Check<'_>,
) -> Option<Standard> {
    let at = place(Noun::Material, index, Field::Whole);
    let factors = factors(material)
        .into_iter()
        .map(|(name, value, range)| in_range(value, name, range, at, check));
    let sound = factors.fold(true, |sound, factor| sound & factor);
    let maps = material.maps().map(|map| known(map, counts, at, check));
    maps.fold(sound, |sound, map| sound & map)
        .then(|| material.clone())
}

type Range = [f64; 2];

const UNIT: Range = [0.0, 1.0];
const POSITIVE: Range = [0.0, LARGEST];
const ANY: Range = [-LARGEST, LARGEST];

/// Each number with its name and range.
fn factors(material: &Standard) -> Vec<(&'static str, f64, Range)> {
    let m = material;
    let colors = [
        ("baseColor", &m.base_color[..], UNIT),
        ("emissive", &m.emissive, POSITIVE),
        ("specularColor", &m.specular_color, POSITIVE),
        ("attenuationColor", &m.attenuation_color, UNIT),
        ("sheenColor", &m.sheen_color, UNIT),
        ("iridescenceThickness", &m.iridescence_thickness, POSITIVE),
        (
            "specularGlossiness",
            m.specular_glossiness
                .as_ref()
                .map_or(&[][..], |factors| factors),
            UNIT,
        ),
    ];
    let colors = colors
        .into_iter()
        .flat_map(|(name, values, range)| values.iter().map(move |v| (name, *v, range)));
    let cutoff = if let Alpha::Mask(cutoff) = m.alpha {
        cutoff
    } else {
        0.0
    };
    let numbers = [
        ("metallic", m.metallic, UNIT),
        ("roughness", m.roughness, UNIT),
        ("normalScale", m.normal_scale, ANY),
        ("alpha", cutoff, POSITIVE),
        (
            "ior",
            if m.ior == 0.0 { 1.0 } else { m.ior },
            [1.0, LARGEST],
        ),
        ("dispersion", m.dispersion, POSITIVE),
        ("specular", m.specular, UNIT),
        ("transmission", m.transmission, UNIT),
        ("thickness", m.thickness, POSITIVE),
        (
            "attenuationDistance",
            m.attenuation_distance.unwrap_or(1.0),
            [f64::MIN_POSITIVE, LARGEST],
        ),
        ("clearcoat", m.clearcoat, UNIT),
        ("clearcoatRoughness", m.clearcoat_roughness, UNIT),
        ("clearcoatNormalScale", m.clearcoat_normal_scale, ANY),
        ("sheenRoughness", m.sheen_roughness, UNIT),
        ("anisotropy", m.anisotropy, UNIT),
        ("anisotropyRotation", m.anisotropy_rotation, ANY),
        ("iridescence", m.iridescence, UNIT),
        ("iridescenceIor", m.iridescence_ior, [1.0, LARGEST]),
    ];
    colors.chain(numbers).collect()
}

fn in_range(value: f64, name: &str, [low, high]: Range, at: Place, check: &mut Check<'_>) -> bool {
    let sound = low <= value && value <= high;
    if !sound {
        let message =
            format!("`{name}` of a material is `{value}`, and must be from {low} to {high}");
        check.report(at, "", Diagnostic::new(&codes::BAD_FACTOR, message));
    }
    sound
}

fn known(map: &Map, counts: &Counts, at: Place, check: &mut Check<'_>) -> bool {
    let Map {
        texture,
        set,
        texture_from_surface,
    } = map;
    let exists = check
        .handle(texture.0, counts.textures, "texture", at)
        .is_some();
    let has_set = *set < 2;
    if !has_set {
        let message =
            format!("a map uses set {set} of texture coordinates, and there are two, from 0");
        check.report(at, "", Diagnostic::new(&codes::BAD_FACTOR, message));
    }
    let rows = texture_from_surface.iter().flatten().flatten();
    let finite = rows.fold(true, |sound, number| {
        sound & check.number(*number, at).is_some()
    });
    exists && has_set && finite
}

/// What the integrator of the course makes of it: the colour without the light.
pub(super) fn as_phong(material: &Standard) -> ir::Phong {
    let [r, g, b, _] = material.base_color;
    ir::Phong {
        color: [r, g, b],
        kd: 1.0 - material.metallic,
        ks: material.metallic,
        n: 1.0 / (material.roughness * material.roughness).max(1e-4),
        ..ir::Phong::MATT
    }
}

/// The material of the course in physical terms: its diffuse part is Lambert's, and a mirror is a
/// smooth metal.
pub(super) fn from_phong(phong: &ir::Phong) -> Standard {
    let share = |weight: f64| weight.clamp(0.0, 1.0);
    let (kd, ks, kt) = (share(phong.kd), share(phong.ks), share(phong.kt));
    let [r, g, b] = phong
        .color
        .map(|channel| share(channel) * if ks > kd { 1.0 } else { kd });
    let is_mirror = ks > 0.0 && kd == 0.0 && kt == 0.0;
    Standard {
        base_color: if is_mirror {
            [ks, ks, ks, 1.0]
        } else {
            [r, g, b, 1.0]
        },
        base_color_map: phong.color_map.map(|texture| Map {
            texture,
            set: 0,
            texture_from_surface: None,
        }),
        metallic: if is_mirror { 1.0 } else { 0.0 },
        roughness: if is_mirror || kt > 0.0 {
            0.0
        } else {
            (2.0 / (phong.n + 2.0)).sqrt().sqrt()
        },
        specular: if ks > 0.0 || kt > 0.0 { 1.0 } else { 0.0 },
        transmission: kt,
        thickness: if kt > 0.0 { 1.0 } else { 0.0 },
        ior: phong.eta.max(1.0),
        double_sided: true,
        ..Standard::default()
    }
}
