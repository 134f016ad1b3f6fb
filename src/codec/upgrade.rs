//! Upgrades older trees to the current version, one step per version. A step renames and fills in;
//! it never computes.
//!
//! A new version needs one function here, one entry in `STEPS`, and one frozen file in
//! `tests/codec`.

use rtc_ir::VERSION;
use serde_json::Value;

/// `STEPS[n]` upgrades version n to version n + 1.
const STEPS: [fn(&mut Value); VERSION as usize] = [from_0, from_1, from_2, from_3, from_4];

/// Upgrades a tree to the current version. Invalid trees are left for the typed decoder to reject.
pub(super) fn to_current(version: u32, mut tree: Value) -> Value {
    for step in STEPS.iter().skip(version as usize) {
        step(&mut tree);
    }
    tree
}

/// Version 0 was never published; it exists so that the upgrade path is always tested. It spells
/// `superSampling` as the scene format does.
fn from_0(tree: &mut Value) {
    if let Some(settings) = tree.get_mut("settings") {
        rename(settings, "superSampling", "supersampling");
    }
}

/// Version 2 added images, textures, meshes and more shapes; absent values have defaults.
fn from_1(_tree: &mut Value) {}

/// Version 3 added the material, lights and settings of glTF, and an environment; absent values
/// have defaults.
fn from_2(_tree: &mut Value) {}

/// Version 4 added IES profiles, paraboloids, toon shading, surfaces without a shadow, the display
/// and more of the material; absent values have defaults, or belong to kinds that older files don't
/// contain.
fn from_3(_tree: &mut Value) {}

/// Version 5 added the ambient term that is added once; absent values have a default.
fn from_4(_tree: &mut Value) {}

fn rename(map: &mut Value, old: &str, new: &str) {
    if let Some(members) = map.as_object_mut()
        && let Some(value) = members.remove(old)
    {
        members.insert(new.to_owned(), value);
    }
}
