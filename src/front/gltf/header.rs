//! The version and the extensions of an asset.

use super::field::ObjectFields;
use super::report::{AssetReport, shown};
use super::schema;
use rtc_diag::codes;
use rtc_source::tree::{NodeId, NodeKind, SyntaxTree};
use std::collections::BTreeSet;

/// Prefixes of extensions that the registry of Khronos knows, beside those of Khronos and of
/// several vendors.
const PREFIXES: &[&str] = &[
    "3DTILES",
    "ADOBE",
    "AGI",
    "AGT",
    "ALCM",
    "ALI",
    "AMZN",
    "ANIMECH",
    "ASOBO",
    "AVR",
    "BLENDER",
    "CAPTURE",
    "CESIUM",
    "CITRUS",
    "CLO",
    "CVTOOLS",
    "EPIC",
    "EXT",
    "FB",
    "FOXIT",
    "FRAUNHOFER",
    "GODOT",
    "GOOGLE",
    "GRIFFEL",
    "INTEL",
    "KDAB",
    "KHR",
    "LLQ",
    "MAXAR",
    "MESHOPT",
    "MOZ",
    "MPEG",
    "MSFT",
    "NEEDLE",
    "NV",
    "OFT",
    "OMI",
    "OWLII",
    "PANDA3D",
    "POLUTROPON",
    "PTC",
    "S8S",
    "SEIN",
    "SI",
    "SKFB",
    "SKYLINE",
    "SOHU",
    "SPECTRUM",
    "TRYON",
    "UX3D",
    "VIZUALIST",
    "VRMC",
    "WEB3D",
];

/// The hint for glTF 1.0.
pub(super) const CONVERT: &str =
    "convert it with `gltf-pipeline -i old.gltf -o new.glb`, or export it again as glTF 2.0";

/// The evidence that an asset is glTF 1.0: its version, which may be a number there, a profile, or
/// entities with names instead of numbers.
fn of_first_version(json: &SyntaxTree<'_>) -> Option<NodeId> {
    let root = json.root();
    let version = json.at(root, &["asset", "version"]);
    let is_declared = |at: &NodeId| match json.text(*at) {
        Some(text) => text == "1" || text.starts_with("1."),
        None => json.number(*at).is_some_and(|number| number == 1.0),
    };
    if let Some(at) = version.filter(is_declared) {
        return Some(at);
    }
    let parts = ["accessors", "bufferViews", "buffers", "meshes", "nodes"];
    let named = parts.iter().filter_map(|key| json.get(root, key));
    let is_named = |at: &NodeId| {
        json.kind(*at) == NodeKind::Map
            && json
                .pairs(*at)
                .all(|(_, part)| json.kind(part) == NodeKind::Map)
    };
    let mut named = named.filter(is_named);
    let profile = json.at(root, &["asset", "profile"]);
    if version.is_none() {
        profile.or(named.next())
    } else {
        None
    }
}

/// Rejects glTF 1.0, with a hint on converting it. True if the asset is that.
pub(super) fn is_refused(report: &mut AssetReport<'_, '_>) -> bool {
    let at = of_first_version(report.json);
    if let Some(at) = at {
        let message = "the asset is glTF 1.0; rtc reads glTF 2.0".to_owned();
        let (alias, hint) = ("UNKNOWN_ASSET_MAJOR_VERSION", CONVERT.to_owned());
        report.add_with_hint(&codes::GLTF_VERSION, alias, at, message, hint);
    }
    at.is_some()
}

/// Checks the version. True if it is 2, whatever comes after the point.
pub(super) fn check_version(report: &mut AssetReport<'_, '_>) -> bool {
    let Some(asset) = ObjectFields::new(report.json, report.json.root()).object("asset") else {
        return false;
    };
    let Some((at, (major, minor))) = version(asset, "version") else {
        return false;
    };
    // The major version must be 2; a higher minor version is compatible.
    if major != 2 {
        let message = format!("the asset is glTF {major}.{minor}; rtc reads glTF 2.0");
        report.add(
            &codes::GLTF_VERSION,
            "UNKNOWN_ASSET_MAJOR_VERSION",
            at,
            message,
        );
    } else if minor > 0 {
        let message = format!("the asset declares glTF {major}.{minor}; it is read as 2.0");
        report.add(
            &codes::GLTF_MINOR_VERSION,
            "UNKNOWN_ASSET_MINOR_VERSION",
            at,
            message,
        );
    }
    // The minimum version may not exceed the version, or glTF 2.0.
    let Some((at, least)) = version(asset, "minVersion") else {
        return major == 2;
    };
    if least > (major, minor) {
        let message = format!(
            "the asset needs glTF {}.{}, but its version is {major}.{minor}",
            least.0, least.1
        );
        report.add(
            &codes::GLTF_VERSION,
            "ASSET_MIN_VERSION_GREATER_THAN_VERSION",
            at,
            message,
        );
    } else if least > (2, 0) {
        let message = format!(
            "the asset needs glTF {}.{}; rtc reads glTF 2.0",
            least.0, least.1
        );
        report.add(&codes::GLTF_VERSION, "", at, message);
    }
    major == 2
}

fn version(
    asset: ObjectFields<'_, '_>,
    key: &str,
) -> Option<(rtc_source::tree::NodeId, (u64, u64))> {
    let text = asset.text(key)?;
    let (major, minor) = text.split_once('.')?;
    let number = |digits: &str| {
        let is_number = !digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit());
        is_number.then(|| digits.parse().unwrap_or(u64::MAX))
    };
    Some((asset.node(key)?, (number(major)?, number(minor)?)))
}

/// Checks the lists of extensions; one that is required and not supported is refused.
pub(super) fn check_extensions(report: &mut AssetReport<'_, '_>) {
    let json = report.json;
    let texts = |key| -> Vec<_> {
        json.list(json.root(), key)
            .filter_map(|at| Some((at, json.text(at)?)))
            .collect()
    };
    let (used, required) = (texts("extensionsUsed"), texts("extensionsRequired"));
    let names = |list: &[(NodeId, &str)]| -> BTreeSet<String> {
        list.iter().map(|(_, name)| (*name).to_owned()).collect()
    };
    let (used_names, required_names) = (names(&used), names(&required));
    let has_used = json.get(json.root(), "extensionsUsed").is_some();
    if let Some(at) = json
        .get(json.root(), "extensionsRequired")
        .filter(|_| !has_used)
    {
        let message =
            "`extensionsRequired` lists extensions, but `extensionsUsed` is missing".to_owned();
        report.add(&codes::GLTF_TOGETHER, "UNSATISFIED_DEPENDENCY", at, message);
    }
    for (at, name) in &required {
        check_required(*at, name, used_names.contains(*name), report);
    }
    let in_materials = in_materials(report);
    for (at, name) in &used {
        if !required_names.contains(*name) {
            check_not_required(*at, name, in_materials.contains(*name), report);
        }
        check_name(*at, name, report);
    }
}

fn check_required(at: NodeId, name: &str, is_listed: bool, report: &mut AssetReport<'_, '_>) {
    let shown = shown(name);
    if !is_listed {
        let message =
            format!("`{shown}` is listed in `extensionsRequired` but not in `extensionsUsed`");
        let alias = "UNUSED_EXTENSION_REQUIRED";
        report.add(&codes::GLTF_EXTENSION, alias, at, message);
    }
    if schema::find(name).is_none() {
        let message = format!("the asset requires the extension `{shown}`, which is not supported");
        let hint = "export the asset without it".to_owned();
        let alias = "UNSUPPORTED_EXTENSION";
        report.add_with_hint(&codes::GLTF_REQUIRES, alias, at, message, hint);
    }
}

/// Checks an extension that the asset uses and does not require.
fn check_not_required(
    at: NodeId,
    name: &str,
    is_in_materials: bool,
    report: &mut AssetReport<'_, '_>,
) {
    if name == "KHR_mesh_quantization" {
        let message = format!("`{name}` must also be listed in `extensionsRequired`");
        let alias = "NON_REQUIRED_EXTENSION";
        report.add(&codes::GLTF_EXTENSION, alias, at, message);
    }
    if schema::find(name).is_some() {
        return;
    }
    let shown = shown(name);
    if is_in_materials {
        let message =
            format!("materials use `{shown}`, which is not supported, so they look different");
        let hint = "express the material with extensions of Khronos, `KHR_materials_…`".to_owned();
        report.add_with_hint(&codes::GLTF_MATERIAL_ODD, "", at, message, hint);
    } else {
        let message = format!("the extension `{shown}` has no effect");
        report.add(&codes::GLTF_IGNORES, "UNSUPPORTED_EXTENSION", at, message);
    }
}

/// Checks that the name of an extension is one, of a registered prefix.
fn check_name(at: NodeId, name: &str, report: &mut AssetReport<'_, '_>) {
    let parts = name.split_once('_');
    match parts.filter(|(prefix, rest)| !prefix.is_empty() && !rest.is_empty()) {
        Some((prefix, _)) if PREFIXES.contains(&prefix) => {}
        Some((prefix, _)) => {
            let message = format!(
                "`{}` is not a registered prefix of extensions",
                shown(prefix)
            );
            let alias = "UNRESERVED_EXTENSION_PREFIX";
            report.add(&codes::GLTF_EXTENSION_ODD, alias, at, message);
        }
        None => {
            let message = format!(
                "`{}` is not a valid name of an extension, such as `KHR_lights_punctual`",
                shown(name)
            );
            let alias = "INVALID_EXTENSION_NAME_FORMAT";
            report.add(&codes::GLTF_EXTENSION_ODD, alias, at, message);
        }
    }
}

/// The extensions that some material has.
fn in_materials(report: &AssetReport<'_, '_>) -> BTreeSet<String> {
    let json = report.json;
    let extensions = json
        .list(json.root(), "materials")
        .filter_map(|material| json.get(material, "extensions"));
    let keys = extensions
        .flat_map(|all| json.pairs(all))
        .filter_map(|(key, _)| json.text(key));
    keys.map(str::to_owned).collect()
}
