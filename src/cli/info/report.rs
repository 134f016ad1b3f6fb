//! The JSON report of `rtc info`; the table is printed from it, too.

use rtc_front::gltf::{AnimationSummary, AssetSummary, Inventory};
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::{Map, Value};
use std::collections::BTreeMap;

/// A scene: its content, its size, and the effects that its picture requires.
#[derive(Serialize, JsonSchema)]
pub(crate) struct InfoReport<'a> {
    /// The schema of this report: `rtc-info/1`.
    #[schemars(extend("const" = "rtc-info/1"))]
    pub(super) schema: &'static str,
    /// The name of the file.
    pub(super) file: String,
    #[serde(flatten)]
    pub(super) content: ContentReport,
    #[serde(flatten)]
    pub(super) settings: SettingsReport,
    /// The glTF asset; null for other files.
    pub(super) asset: Option<GltfAssetReport<'a>>,
}

/// The content of a scene.
#[derive(Default, Serialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub(super) struct ContentReport {
    /// The number of entities of each kind.
    pub(super) counts: ContentCounts,
    /// The number of surfaces of each shape.
    pub(super) shapes: BTreeMap<&'static str, usize>,
    /// The number of materials of each model.
    pub(super) materials: BTreeMap<&'static str, usize>,
    /// The number of lights of each kind.
    pub(super) lights: BTreeMap<&'static str, usize>,
    /// The environment light.
    #[schemars(extend("enum" = ["none", "color", "image"]))]
    pub(super) environment: &'static str,
    /// The bounding box of all bounded shapes; null if there is none.
    pub(super) bounds: Option<BoundsReport>,
    /// The bytes of all meshes.
    pub(super) mesh_bytes: usize,
    /// The bytes of all images.
    pub(super) image_bytes: usize,
    /// The images.
    pub(super) images: Vec<ImageReport>,
}

/// The number of entities of each kind.
#[derive(Default, Serialize, JsonSchema)]
pub(super) struct ContentCounts {
    pub(super) surfaces: usize,
    pub(super) triangles: usize,
    pub(super) meshes: usize,
    pub(super) materials: usize,
    pub(super) textures: usize,
    pub(super) images: usize,
    pub(super) lights: usize,
}

/// An axis-aligned box, in scene units.
#[derive(Serialize, JsonSchema)]
pub(super) struct BoundsReport {
    /// The corner with the smallest coordinates.
    pub(super) low: [f64; 3],
    /// The corner with the largest coordinates.
    pub(super) high: [f64; 3],
}

/// An image.
#[derive(Serialize, JsonSchema)]
pub(super) struct ImageReport {
    pub(super) name: String,
    pub(super) width: u32,
    pub(super) height: u32,
    /// The bytes of its decoded pixels.
    pub(super) bytes: usize,
}

/// The settings of the picture, and the effects that it requires.
#[derive(Serialize, JsonSchema)]
pub(super) struct SettingsReport {
    /// The settings of the picture.
    pub(super) picture: PictureReport,
    /// The camera.
    pub(super) camera: CameraReport,
    /// The status of each effect.
    pub(super) effects: Vec<EffectReport>,
}

/// The settings of the picture.
#[derive(Serialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub(super) struct PictureReport {
    pub(super) width: u32,
    pub(super) height: u32,
    #[schemars(extend("enum" = ["phong", "zbuffer", "normal", "gooch", "path"]))]
    pub(super) mode: &'static str,
    /// The number of samples of each pixel.
    pub(super) samples_per_pixel: u64,
    /// The maximum number of bounces after the first hit.
    pub(super) max_depth: u32,
}

/// The camera.
#[derive(Serialize, JsonSchema)]
pub(super) struct CameraReport {
    /// The position of the camera.
    pub(super) eye: [f64; 3],
    /// The point in the centre of the picture.
    pub(super) center: [f64; 3],
    #[schemars(extend("enum" = ["perspective", "orthographic"]))]
    pub(super) projection: &'static str,
    /// The vertical field of view in radians; null for an orthographic camera.
    pub(super) yfov: Option<f64>,
}

/// The status of an effect.
#[derive(Serialize, JsonSchema)]
pub(super) struct EffectReport {
    /// The name of the effect.
    pub(super) effect: &'static str,
    /// Whether the picture requires it, a rule removes it, or the scene does not have it.
    #[serde(rename = "verdict")]
    #[schemars(extend("enum" = ["needed", "pruned", "absent"]))]
    pub(super) status: &'static str,
    /// The rule that removes it; null if none does.
    pub(super) rule: Option<&'static str>,
    /// The reason for the status.
    #[serde(rename = "because")]
    pub(super) reason: String,
}

/// A glTF asset.
#[derive(Serialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub(super) struct GltfAssetReport<'a> {
    /// The version of glTF.
    version: &'a str,
    /// The program that wrote the asset; empty if unknown.
    generator: &'a str,
    /// The number of items of each list.
    #[schemars(with = "BTreeMap<String, usize>")]
    counts: Map<String, Value>,
    /// The extensions that the asset uses.
    extensions_used: &'a [String],
    /// The extensions that a reader must support.
    extensions_required: &'a [String],
    #[serde(flatten)]
    inventory: &'a Inventory,
    /// The animations.
    animations: Vec<AnimationReport<'a>>,
    /// The names of the cameras; empty for a camera without a name.
    cameras: &'a [String],
    /// The names of the material variants.
    variants: &'a [String],
}

/// An animation of a glTF asset.
#[derive(Serialize, JsonSchema)]
struct AnimationReport<'a> {
    /// Its name; empty if it has none.
    name: &'a str,
    /// The number of animated properties.
    channels: usize,
    /// The number of samplers.
    samplers: usize,
    /// The number of keyframes of all samplers.
    keyframes: u64,
    /// The time of the last keyframe, in seconds.
    seconds: f64,
}

impl<'a> GltfAssetReport<'a> {
    pub(super) fn new(asset: &'a AssetSummary) -> Self {
        let animation = |animation: &'a AnimationSummary| AnimationReport {
            name: &animation.name,
            channels: animation.channels,
            samplers: animation.samplers,
            keyframes: animation.keyframes,
            seconds: animation.seconds,
        };
        let count = |(key, count): &(&str, usize)| ((*key).to_owned(), (*count).into());
        Self {
            version: &asset.version,
            generator: &asset.generator,
            counts: asset.counts.iter().map(count).collect(),
            extensions_used: &asset.extensions,
            extensions_required: &asset.required,
            inventory: &asset.inventory,
            animations: asset.animations.iter().map(animation).collect(),
            cameras: &asset.cameras,
            variants: &asset.variants,
        }
    }
}
