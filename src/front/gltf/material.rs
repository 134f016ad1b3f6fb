//! Materials: rules between their properties, without their textures.

use super::document::Document;
use super::field::ObjectFields;
use super::report::AssetReport;
use rtc_diag::codes;
use rtc_math::shortest;
use rtc_source::tree::{NodeId, NodeKind, SyntaxTree};

/// Each texture of a material with its set of texture coordinates.
pub(super) fn texture_coordinates(
    doc: &Document<'_>,
    json: &SyntaxTree<'_>,
    material: NodeId,
) -> Vec<(NodeId, u64)> {
    // Textures are in the material, its metallic-roughness part and its used extensions.
    let parts = json.at(material, &["pbrMetallicRoughness"]).into_iter();
    let is_used = |key: NodeId| json.text(key).is_some_and(|name| doc.uses(name));
    let extensions = json
        .get(material, "extensions")
        .into_iter()
        .flat_map(|all| json.pairs(all));
    let extensions = extensions
        .filter(|(key, _)| is_used(*key))
        .map(|(_, one)| one);
    let holders = std::iter::once(material).chain(parts).chain(extensions);
    let mut found = Vec::new();
    for (key, at) in holders.flat_map(|holder| json.pairs(holder)) {
        let is_texture = json.text(key).is_some_and(|key| key.ends_with("Texture"))
            && json.kind(at) == NodeKind::Map;
        if !is_texture {
            continue;
        }
        let fields = ObjectFields::new(json, at);
        // `KHR_texture_transform` may override the set of a texture.
        let transform = fields
            .extension("KHR_texture_transform")
            .filter(|_| doc.uses("KHR_texture_transform"));
        let transform = transform.and_then(|fields| Some((fields.at, fields.integer("texCoord")?)));
        let set_of_info = || {
            Some((
                at,
                if fields.has("texCoord") {
                    fields.integer("texCoord")?
                } else {
                    0
                },
            ))
        };
        found.extend(transform.or_else(set_of_info));
    }
    found
}

/// True if a texture of the material follows tangents.
pub(super) fn needs_tangents(doc: &Document<'_>, material: ObjectFields<'_, '_>) -> bool {
    let textures = [
        ("KHR_materials_clearcoat", "clearcoatNormalTexture"),
        ("KHR_materials_anisotropy", "anisotropyTexture"),
    ];
    let has = |name, key| {
        extension(doc, material, name)
            .and_then(|object| object.object(key))
            .is_some()
    };
    material.object("normalTexture").is_some()
        || textures.into_iter().any(|(name, key)| has(name, key))
}

/// Checks all materials.
pub(super) fn check(doc: &Document<'_>, report: &mut AssetReport<'_, '_>) {
    for material in &doc.materials {
        let fields = ObjectFields::new(report.json, *material);
        if let Some(at) = fields
            .node("alphaCutoff")
            .filter(|_| !fields.is("alphaMode", "MASK"))
        {
            let message = "the cutoff has no effect without the mode `MASK`".to_owned();
            report.add(
                &codes::GLTF_MATERIAL_ODD,
                "MATERIAL_ALPHA_CUTOFF_INVALID_MODE",
                at,
                message,
            );
        }
        super::node::report_levels(*material, report);
        check_models(fields, report);
        check_ior(doc, fields, report);
        check_iridescence(doc, fields, report);
        check_volume(doc, fields, report);
        check_dispersion(doc, fields, report);
        check_coats(doc, fields, report);
        check_emission(doc, fields, report);
    }
    report_occlusion(doc, report);
}

/// Reports once that baked occlusion is ignored: the scene's own geometry occludes the light.
fn report_occlusion(doc: &Document<'_>, report: &mut AssetReport<'_, '_>) {
    let json = report.json;
    let mut baked = doc
        .materials
        .iter()
        .filter_map(|material| json.get(*material, "occlusionTexture"));
    let Some(first) = baked.next() else { return };
    let message = match baked.count() {
        0 => "the `occlusionTexture` is ignored: path tracing computes the occlusion".to_owned(),
        more => format!(
            "{} `occlusionTexture`s are ignored: path tracing computes the occlusion",
            more + 1
        ),
    };
    let hint = "remove the textures, unless another program needs them".to_owned();
    report.add_with_hint(&codes::GLTF_REMARK, "", first, message, hint);
}

/// Unlit and specular-glossiness replace the model that other extensions extend.
fn check_models(fields: ObjectFields<'_, '_>, report: &mut AssetReport<'_, '_>) {
    let Some(extensions) = fields.node("extensions") else {
        return;
    };
    let count = report.json.pairs(extensions).count();
    for name in ["KHR_materials_unlit", "KHR_materials_pbrSpecularGlossiness"] {
        if let Some(one) = fields.extension(name).filter(|_| count > 1) {
            let message = format!("`{name}` cannot be combined with other extensions");
            report.add(
                &codes::GLTF_EXTENSION_ODD,
                "MULTIPLE_EXTENSIONS",
                one.at,
                message,
            );
        }
    }
}

/// The object of an extension that the asset uses.
fn extension<'t, 's>(
    doc: &Document<'_>,
    fields: ObjectFields<'t, 's>,
    name: &str,
) -> Option<ObjectFields<'t, 's>> {
    fields.extension(name).filter(|_| doc.uses(name))
}

fn check_ior(doc: &Document<'_>, fields: ObjectFields<'_, '_>, report: &mut AssetReport<'_, '_>) {
    let Some(ior) = extension(doc, fields, "KHR_materials_ior") else {
        return;
    };
    if let (Some(at), Some(value)) = (ior.node("ior"), ior.number("ior"))
        && value > 0.0
        && value < 1.0
    {
        let message = format!("the index of refraction is {value}; it must be 0, or at least 1");
        report.add(&codes::GLTF_VALUE, "VALUE_NOT_IN_RANGE", at, message);
    }
}

fn check_iridescence(
    doc: &Document<'_>,
    fields: ObjectFields<'_, '_>,
    report: &mut AssetReport<'_, '_>,
) {
    let Some(film) = extension(doc, fields, "KHR_materials_iridescence") else {
        return;
    };
    // The texture interpolates between the two thicknesses.
    let [least, most] = [
        film.number_or("iridescenceThicknessMinimum", 100.0),
        film.number_or("iridescenceThicknessMaximum", 400.0),
    ];
    let texture = film.has("iridescenceThicknessTexture");
    // Without a texture, the film has its maximum thickness.
    if let Some(at) = film
        .node("iridescenceThicknessMinimum")
        .filter(|_| !texture)
    {
        let message = "the minimum thickness has no effect without a texture".to_owned();
        let alias = "KHR_MATERIALS_IRIDESCENCE_THICKNESS_RANGE_WITHOUT_TEXTURE";
        report.add(&codes::GLTF_REMARK, alias, at, message);
    }
    // With one, the range must not be empty or reversed.
    if texture && least > most {
        let [least, most] = [least, most].map(shortest);
        let message =
            format!("the minimum thickness is {least}, above the maximum, which is {most}");
        report.add(
            &codes::GLTF_VALUE,
            "KHR_MATERIALS_IRIDESCENCE_THICKNESS_RANGE_INVALID",
            film.at,
            message,
        );
    } else if texture && least - most == 0.0 {
        let at = report.json.at_or(film.at, "iridescenceThicknessTexture");
        let message =
            "the texture has no effect: the minimum thickness equals the maximum".to_owned();
        report.add(
            &codes::GLTF_REMARK,
            "KHR_MATERIALS_IRIDESCENCE_THICKNESS_TEXTURE_UNUSED",
            at,
            message,
        );
    }
}

fn check_volume(
    doc: &Document<'_>,
    fields: ObjectFields<'_, '_>,
    report: &mut AssetReport<'_, '_>,
) {
    let Some(volume) = extension(doc, fields, "KHR_materials_volume") else {
        return;
    };
    let code = &codes::GLTF_MATERIAL_ODD;
    let entered = [
        "KHR_materials_transmission",
        "KHR_materials_diffuse_transmission",
    ];
    if !entered
        .iter()
        .any(|name| extension(doc, fields, name).is_some())
    {
        let message = "no light enters the volume: the material has no transmission".to_owned();
        report.add(
            code,
            "KHR_MATERIALS_VOLUME_NO_TRANSMISSION",
            volume.at,
            message,
        );
    }
    if fields.boolean("doubleSided") && volume.number_or("thicknessFactor", 0.0) > 0.0 {
        let message =
            "a volume needs a surface with one side, but the material is double-sided".to_owned();
        report.add(
            code,
            "KHR_MATERIALS_VOLUME_DOUBLE_SIDED",
            volume.at,
            message,
        );
    }
}

fn check_dispersion(
    doc: &Document<'_>,
    fields: ObjectFields<'_, '_>,
    report: &mut AssetReport<'_, '_>,
) {
    let volume = extension(doc, fields, "KHR_materials_volume");
    if let Some(dispersion) =
        extension(doc, fields, "KHR_materials_dispersion").filter(|_| volume.is_none())
    {
        let message = "dispersion has no effect without a volume".to_owned();
        report.add(
            &codes::GLTF_MATERIAL_ODD,
            "KHR_MATERIALS_DISPERSION_NO_VOLUME",
            dispersion.at,
            message,
        );
    }
}

/// Textures that share tangents use the texture coordinates of the normal map.
fn check_coats(doc: &Document<'_>, fields: ObjectFields<'_, '_>, report: &mut AssetReport<'_, '_>) {
    let set = |texture: ObjectFields<'_, '_>| texture.integer("texCoord").unwrap_or(0);
    let Some(normal) = fields.object("normalTexture").map(set) else {
        return;
    };
    for (name, key, alias) in [
        (
            "KHR_materials_clearcoat",
            "clearcoatNormalTexture",
            "KHR_MATERIALS_CLEARCOAT_CLEARCOAT_NORMAL_TEXTURE_TEXCOORD",
        ),
        (
            "KHR_materials_anisotropy",
            "anisotropyTexture",
            "KHR_MATERIALS_ANISOTROPY_ANISOTROPY_TEXTURE_TEXCOORD",
        ),
    ] {
        let texture = extension(doc, fields, name).and_then(|fields| fields.object(key));
        if let Some(texture) = texture.filter(|texture| set(*texture) != normal) {
            let message =
                "the texture and the normal map use different texture coordinates".to_owned();
            report.add(&codes::GLTF_MATERIAL_ODD, alias, texture.at, message);
        }
    }
}

fn check_emission(
    doc: &Document<'_>,
    fields: ObjectFields<'_, '_>,
    report: &mut AssetReport<'_, '_>,
) {
    let Some(strength) = extension(doc, fields, "KHR_materials_emissive_strength") else {
        return;
    };
    let is_one = strength.number_or("emissiveStrength", 1.0) - 1.0 == 0.0;
    if !is_one
        && fields
            .vector_or("emissiveFactor", [0.0; 3])
            .iter()
            .all(|channel| *channel == 0.0)
    {
        let message = "the emissive factor is 0, so nothing is emitted".to_owned();
        report.add(
            &codes::GLTF_MATERIAL_ODD,
            "KHR_MATERIALS_EMISSIVE_STRENGTH_ZERO_FACTOR",
            strength.at,
            message,
        );
    }
}

/// Checks that each primitive has one material a variant.
pub(super) fn check_variants(doc: &Document<'_>, report: &mut AssetReport<'_, '_>) {
    if !doc.uses("KHR_materials_variants") {
        return;
    }
    for primitive in doc.meshes.iter().flat_map(|mesh| &mesh.primitives) {
        let Some(variants) =
            ObjectFields::new(report.json, primitive.at).extension("KHR_materials_variants")
        else {
            continue;
        };
        let mut seen = std::collections::BTreeSet::new();
        for mapping in variants.objects("mappings") {
            for item in report.json.list(mapping.at, "variants") {
                let Some(variant) = report.json.integer(item) else {
                    continue;
                };
                if !seen.insert(variant) {
                    let message =
                        format!("the primitive already has a material for variant {variant}");
                    report.add(
                        &codes::GLTF_DUPLICATE,
                        "KHR_MATERIALS_VARIANTS_NON_UNIQUE_VARIANT",
                        item,
                        message,
                    );
                }
            }
        }
    }
}
