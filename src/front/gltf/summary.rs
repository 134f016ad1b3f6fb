//! The summary of an asset for `rtc info`: what its JSON lists, without validation.

use super::field::ObjectFields;
use super::inventory::{Inventory, InventoryReader};
use super::{parts, text};
use rtc_diag::DiagnosticSink;
use rtc_source::tree::json;
use rtc_source::{FileId, SourceMap};
use std::cell::Cell;

/// The contents of an asset by its JSON.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AssetSummary {
    /// The version of glTF.
    pub version: String,
    /// The program that wrote it; empty if it does not say.
    pub generator: String,
    /// The number of each kind: the key of the list, and its items.
    pub counts: Vec<(&'static str, usize)>,
    /// The names in `extensionsUsed`.
    pub extensions: Vec<String>,
    /// The required ones among them.
    pub required: Vec<String>,
    /// The animations.
    pub animations: Vec<AnimationSummary>,
    /// The names of the cameras, empty where one has none.
    pub cameras: Vec<String>,
    /// The names of the variants of materials.
    pub variants: Vec<String>,
    /// A row for each scene, mesh, material and texture.
    pub inventory: Inventory,
}

/// One animation.
#[derive(Clone, Debug, PartialEq)]
pub struct AnimationSummary {
    /// Its name, empty if it has none.
    pub name: String,
    /// The number of properties it animates.
    pub channels: usize,
    /// The number of its samplers.
    pub samplers: usize,
    /// The number of keyframes of its samplers.
    pub keyframes: u64,
    /// The time of its last keyframe in seconds, as its accessors say.
    pub seconds: f64,
}

/// The lists that are counted.
const COUNTED: [&str; 11] = [
    "scenes",
    "nodes",
    "meshes",
    "skins",
    "cameras",
    "materials",
    "textures",
    "images",
    "animations",
    "accessors",
    "buffers",
];

/// The contents of an asset; `None` if its text can't be read.
#[must_use]
pub fn summary(file: FileId, map: &SourceMap) -> Option<AssetSummary> {
    // Its errors are reported when it is lowered.
    let mut sink = DiagnosticSink::default();
    let parts = parts(file, map, true, &mut sink)?;
    let (base, text) = text(file, map.bytes(file), &parts, true, &mut sink)?;
    let tree = json::parse(file, base, text).ok()?;
    let root = ObjectFields::new(&tree, tree.root());
    let words = |key| -> Vec<String> {
        let items = tree.list(tree.root(), key);
        items
            .filter_map(|item| tree.text(item).map(str::to_owned))
            .collect()
    };
    let asset = root.object("asset");
    let text = |key: &str| asset.and_then(|asset| asset.text(key)).unwrap_or_default();
    let variants = root.extension("KHR_materials_variants");
    let names = |fields: ObjectFields<'_, '_>| fields.text("name").unwrap_or_default();
    let reader = InventoryReader {
        tree: &tree,
        map,
        file,
        parts: &parts,
        read: Cell::new(0),
    };
    Some(AssetSummary {
        inventory: reader.inventory(),
        version: text("version"),
        generator: text("generator"),
        counts: COUNTED
            .iter()
            .map(|key| (*key, tree.list(tree.root(), key).count()))
            .collect(),
        extensions: words("extensionsUsed"),
        required: words("extensionsRequired"),
        animations: animations(root),
        cameras: root.objects("cameras").map(names).collect(),
        variants: variants
            .map(|variants| variants.objects("variants").map(names).collect())
            .unwrap_or_default(),
    })
}

fn animations(root: ObjectFields<'_, '_>) -> Vec<AnimationSummary> {
    let ends: Vec<f64> = root
        .objects("accessors")
        .map(|accessor| accessor.numbers("max").and_then(|max| max.first().copied()))
        .map(Option::unwrap_or_default)
        .collect();
    let counts: Vec<u64> = root
        .objects("accessors")
        .map(|accessor| accessor.integer("count").unwrap_or(0))
        .collect();
    let keyframes = |sampler: ObjectFields<'_, '_>| counts.get(sampler.index("input")?).copied();
    let animation = |animation: ObjectFields<'_, '_>| AnimationSummary {
        name: animation.text("name").unwrap_or_default(),
        channels: animation.objects("channels").count(),
        samplers: animation.objects("samplers").count(),
        keyframes: animation.objects("samplers").filter_map(keyframes).sum(),
        seconds: animation
            .objects("samplers")
            .filter_map(|sampler| ends.get(sampler.index("input")?).copied())
            .fold(0.0, f64::max),
    };
    root.objects("animations").map(animation).collect()
}
