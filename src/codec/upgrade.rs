//! Older trees brought to the current version, one step a version; a step renames and fills in, it
//! never computes.
//!
//! A new version is one function here, one entry in `STEPS`, and one frozen file in `tests/codec`.

use rtc_ir::VERSION;
use serde_json::Value;

/// `STEPS[n]` brings version n to version n + 1.
const STEPS: [fn(&mut Value); VERSION as usize] = [from_0, from_1, from_2, from_3, from_4];

/// The tree in the current version; what is not as its version says is left for the typed decoder
/// to refuse.
pub(super) fn to_current(version: u32, mut tree: Value) -> Value {
    for step in STEPS.iter().skip(version as usize) {
        step(&mut tree);
    }
    tree
}

/// Version 0 was never published. It is made up, so that the way through this file is walked from
/// the first day: it spells `superSampling` as the scene format does.
fn from_0(tree: &mut Value) {
    if let Some(settings) = tree.get_mut("settings") {
        rename(settings, "superSampling", "supersampling");
    }
}

/// Version 2 added images, textures, meshes and more shapes; what is absent has a default.
fn from_1(_tree: &mut Value) {}

/// Version 3 added the material, lights and settings of glTF, and a surrounding; what is absent has
/// a default.
fn from_2(_tree: &mut Value) {}

/// Version 4 added measured lamps, paraboloids, cartoons, surfaces without a shadow, the display and
/// more of the material; what is absent has a default, or is of a kind that older files don't hold.
fn from_3(_tree: &mut Value) {}

/// Version 5 added the ambient term that is added once; what is absent has a default.
fn from_4(_tree: &mut Value) {}

fn rename(map: &mut Value, old: &str, new: &str) {
    if let Some(members) = map.as_object_mut()
        && let Some(value) = members.remove(old)
    {
        members.insert(new.to_owned(), value);
    }
}
