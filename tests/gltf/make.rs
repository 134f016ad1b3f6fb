//! Small assets of our own, written in code: one for each thing that lowering must get right.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use serde_json::{Value, json};

/// Collects data and the accessors to it.
#[derive(Default)]
struct Maker {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl Maker {
    fn view(&mut self, bytes: &[u8]) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        self.views
            .push(json!({"buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len()}));
        self.bytes.extend(bytes);
        self.views.len() - 1
    }

    fn push(&mut self, accessor: Value) -> usize {
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    /// An accessor of floats, with its bounds.
    fn floats(&mut self, kind: &str, width: usize, numbers: &[f32]) -> usize {
        let bytes: Vec<u8> = numbers
            .iter()
            .flat_map(|number| number.to_le_bytes())
            .collect();
        let component = |at: usize| numbers.iter().skip(at).step_by(width).copied();
        let min: Vec<f32> = (0..width)
            .map(|at| component(at).fold(f32::INFINITY, f32::min))
            .collect();
        let max: Vec<f32> = (0..width)
            .map(|at| component(at).fold(f32::NEG_INFINITY, f32::max))
            .collect();
        let view = self.view(&bytes);
        let count = numbers.len() / width;
        self.push(
            json!({"bufferView": view, "componentType": 5126, "type": kind, "count": count, "min": min, "max": max}),
        )
    }

    fn bytes(&mut self, kind: &str, width: usize, bytes: &[u8], is_fraction: bool) -> usize {
        let view = self.view(bytes);
        let count = bytes.len() / width;
        let accessor =
            json!({"bufferView": view, "componentType": 5121, "type": kind, "count": count});
        let index = self.push(accessor);
        if is_fraction {
            self.accessors[index]["normalized"] = true.into();
        }
        index
    }

    fn finish(self, mut asset: Value) -> Vec<u8> {
        asset["asset"] = json!({"version": "2.0"});
        let uri = format!(
            "data:application/octet-stream;base64,{}",
            STANDARD.encode(&self.bytes)
        );
        if !self.bytes.is_empty() {
            asset["buffers"] = json!([{"byteLength": self.bytes.len(), "uri": uri}]);
            asset["bufferViews"] = self.views.into();
        }
        if !self.accessors.is_empty() {
            asset["accessors"] = self.accessors.into();
        }
        serde_json::to_vec(&asset).unwrap()
    }
}

const TRIANGLE: [f32; 9] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
const SQUARE: [f32; 12] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0];

/// A strip with indices, a fan without, a sparse accessor without a base, and lines, which do not
/// show.
pub(super) fn topology() -> Vec<u8> {
    let mut maker = Maker::default();
    let square = maker.floats("VEC3", 3, &SQUARE);
    let strip = maker.bytes("SCALAR", 1, &[0, 1, 2, 3], false);
    let (places, moved) = (
        maker.view(&[1, 2]),
        maker.view(
            &[1.0_f32, 0.0, 0.0, 0.0, 1.0, 0.0]
                .map(f32::to_le_bytes)
                .concat(),
        ),
    );
    let sparse = maker.push(json!({
        "componentType": 5126, "type": "VEC3", "count": 3, "min": [0, 0, 0], "max": [1, 1, 0],
        "sparse": {"count": 2, "indices": {"bufferView": places, "componentType": 5121}, "values": {"bufferView": moved}},
    }));
    maker.finish(json!({
        "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0, "name": "forms"}],
        "meshes": [{"name": "forms", "primitives": [
            {"attributes": {"POSITION": square}, "indices": strip, "mode": 5},
            {"attributes": {"POSITION": square}, "mode": 6},
            {"attributes": {"POSITION": sparse}},
            {"attributes": {"POSITION": square}, "mode": 1},
        ]}],
    }))
}

/// A hierarchy with mirrored and sheared nodes, a hidden one, one scaled to nothing, and instances.
pub(super) fn hierarchy() -> Vec<u8> {
    let mut maker = Maker::default();
    let triangle = maker.floats("VEC3", 3, &TRIANGLE);
    let translations = maker.floats("VEC3", 3, &[0.0, 0.0, 1.0, 0.0, 0.0, 2.0]);
    maker.finish(json!({
        "extensionsUsed": ["EXT_mesh_gpu_instancing", "KHR_node_visibility"],
        "scenes": [{"nodes": [0]}],
        "nodes": [
            {"children": [1, 2, 3, 4], "scale": [-2, 1, 1], "translation": [1, 2, 3]},
            {"mesh": 0, "name": "turned", "rotation": [0, 0, 0.707_106_77, 0.707_106_77]},
            {"mesh": 0, "name": "sheared", "matrix": [1, 0, 0, 0, 0.5, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]},
            {"mesh": 0, "name": "hidden", "extensions": {"KHR_node_visibility": {"visible": false}}},
            {"children": [5], "mesh": 0, "name": "many",
             "extensions": {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": translations}}}},
            {"mesh": 0, "name": "nothing", "scale": [1, 1, 0]},
        ],
        "meshes": [{"name": "triangle", "primitives": [{"attributes": {"POSITION": triangle}}]}],
    }))
}

/// Colours as fractions, quantized positions, and two sets of texture coordinates.
pub(super) fn attributes() -> Vec<u8> {
    let mut maker = Maker::default();
    let view = maker.view(&[0, 0, 0, 0, 255, 0, 0, 0, 0, 255, 0, 0]);
    maker.views[view]["byteStride"] = 4.into();
    let positions = maker.push(json!({
        "bufferView": view, "componentType": 5121, "normalized": true, "type": "VEC3", "count": 3,
        "min": [0, 0, 0], "max": [255, 255, 0],
    }));
    let colors = maker.bytes(
        "VEC4",
        4,
        &[255, 0, 0, 255, 0, 255, 0, 51, 0, 0, 255, 0],
        true,
    );
    let first = maker.floats("VEC2", 2, &[0.0, 0.0, 1.0, 0.0, 0.0, 1.0]);
    let second = maker.floats("VEC2", 2, &[0.5, 0.5, 1.5, 0.5, 0.5, 1.5]);
    maker.finish(json!({
        "extensionsUsed": ["KHR_mesh_quantization"], "extensionsRequired": ["KHR_mesh_quantization"],
        "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes":
            {"POSITION": positions, "COLOR_0": colors, "TEXCOORD_0": first, "TEXCOORD_1": second}}]}],
    }))
}

/// A mesh that morphs and one that follows a joint, both moved by an animation.
pub(super) fn motion() -> Vec<u8> {
    let mut maker = Maker::default();
    let triangle = maker.floats("VEC3", 3, &TRIANGLE);
    let lifted = maker.floats("VEC3", 3, &[0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0]);
    let joints = maker.bytes("VEC4", 4, &[0; 12], false);
    let weights = maker.floats("VEC4", 4, &[1.0, 0.0, 0.0, 0.0].repeat(3));
    let times = maker.floats("SCALAR", 1, &[0.0, 2.0]);
    let amounts = maker.floats("SCALAR", 1, &[0.0, 1.0]);
    let turns = maker.floats("VEC4", 4, &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0]);
    maker.finish(json!({
        "scenes": [{"nodes": [0, 1, 2]}],
        "nodes": [{"mesh": 0, "name": "morph"}, {"mesh": 1, "skin": 0, "name": "skinned"}, {"name": "joint"}],
        "meshes": [
            {"primitives": [{"attributes": {"POSITION": triangle}, "targets": [{"POSITION": lifted}]}], "weights": [0.25]},
            {"primitives": [{"attributes": {"POSITION": triangle, "JOINTS_0": joints, "WEIGHTS_0": weights}}]},
        ],
        "skins": [{"joints": [2]}],
        "animations": [{"name": "move",
            "samplers": [{"input": times, "output": amounts}, {"input": times, "output": turns}],
            "channels": [
                {"sampler": 0, "target": {"node": 0, "path": "weights"}},
                {"sampler": 1, "target": {"node": 2, "path": "rotation"}},
            ]}],
    }))
}

/// A camera, the three kinds of lights, and a material that depends on the variant.
pub(super) fn stage() -> Vec<u8> {
    let mut maker = Maker::default();
    let triangle = maker.floats("VEC3", 3, &TRIANGLE);
    let variants = json!({"mappings": [{"variants": [0], "material": 1}]});
    maker.finish(json!({
        "extensionsUsed": ["KHR_lights_punctual", "KHR_materials_variants", "KHR_materials_volume",
            "KHR_materials_transmission", "KHR_materials_emissive_strength"],
        "extensions": {
            "KHR_lights_punctual": {"lights": [
                {"type": "directional", "intensity": 3}, {"type": "point", "color": [1, 0.5, 0], "range": 9},
                {"type": "spot", "spot": {"innerConeAngle": 0.25, "outerConeAngle": 0.5}},
            ]},
            "KHR_materials_variants": {"variants": [{"name": "glass"}]},
        },
        "scenes": [{"nodes": [0, 1, 2, 3, 4]}],
        "nodes": [
            {"camera": 0, "translation": [0, 0, 4]}, {"mesh": 0},
            {"extensions": {"KHR_lights_punctual": {"light": 0}}, "rotation": [1, 0, 0, 0]},
            {"extensions": {"KHR_lights_punctual": {"light": 1}}, "translation": [0, 2, 0]},
            {"extensions": {"KHR_lights_punctual": {"light": 2}}, "scale": [2, 2, 2]},
        ],
        "cameras": [{"type": "orthographic", "orthographic": {"xmag": 2, "ymag": 1, "znear": 0, "zfar": 10}}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": triangle}, "material": 0,
            "extensions": {"KHR_materials_variants": variants}}]}],
        "materials": [
            {"name": "glowing", "alphaMode": "MASK", "emissiveFactor": [1, 0.5, 0],
             "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 4}}},
            {"name": "glass", "doubleSided": false, "extensions": {
                "KHR_materials_transmission": {"transmissionFactor": 1},
                "KHR_materials_volume": {"thicknessFactor": 1, "attenuationDistance": 2, "attenuationColor": [1, 0.5, 0.25]}}},
        ],
    }))
}

/// A material, two lights, a camera and a node, all moved by pointers.
pub(super) fn pointers() -> Vec<u8> {
    let mut maker = Maker::default();
    let triangle = maker.floats("VEC3", 3, &TRIANGLE);
    let times = maker.floats("SCALAR", 1, &[0.0, 2.0]);
    let moved = [
        (
            "/nodes/1/translation",
            maker.floats("VEC3", 3, &[0.0, 0.0, 0.0, 4.0, 0.0, 0.0]),
        ),
        (
            "/materials/0/pbrMetallicRoughness/baseColorFactor",
            maker.floats("VEC4", 4, &[0.0, 0.0, 0.0, 1.0, 1.0, 0.5, 0.0, 1.0]),
        ),
        (
            "/materials/0/emissiveFactor",
            maker.floats("VEC3", 3, &[0.0, 0.0, 0.0, 1.0, 1.0, 1.0]),
        ),
        (
            "/materials/0/extensions/KHR_materials_clearcoat/clearcoatFactor",
            maker.floats("SCALAR", 1, &[0.0, 3.0]),
        ),
        (
            "/cameras/0/perspective/yfov",
            maker.floats("SCALAR", 1, &[1.0, 2.0]),
        ),
        (
            "/extensions/KHR_lights_punctual/lights/0/intensity",
            maker.floats("SCALAR", 1, &[0.0, 8.0]),
        ),
        (
            "/extensions/KHR_lights_punctual/lights/0/spot/outerConeAngle",
            maker.floats("SCALAR", 1, &[0.5, 0.7]),
        ),
    ];
    let samplers: Vec<Value> = moved
        .iter()
        .map(|(_, output)| json!({"input": times, "output": output}))
        .collect();
    let target = |pointer: &str| json!({"path": "pointer", "extensions": {"KHR_animation_pointer": {"pointer": pointer}}});
    let channels: Vec<Value> = moved
        .iter()
        .enumerate()
        .map(|(at, (pointer, _))| json!({"sampler": at, "target": target(pointer)}))
        .collect();
    maker.finish(json!({
        "extensionsUsed": ["KHR_animation_pointer", "KHR_lights_punctual", "KHR_materials_clearcoat"],
        "extensionsRequired": ["KHR_animation_pointer"],
        "extensions": {"KHR_lights_punctual": {"lights": [{"type": "spot", "spot": {}}]}},
        "scenes": [{"nodes": [0, 1, 2]}],
        "nodes": [
            {"camera": 0, "translation": [0, 0, 4]}, {"mesh": 0},
            {"extensions": {"KHR_lights_punctual": {"light": 0}}},
        ],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 1, "znear": 1}}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": triangle}, "material": 0}]}],
        "materials": [{"pbrMetallicRoughness": {"metallicFactor": 0.25}, "extensions": {"KHR_materials_clearcoat": {}}}],
        "animations": [{"samplers": samplers, "channels": channels}],
    }))
}

/// So many points on a line from -1 to 1.
pub(super) fn cloud(count: u16) -> Vec<u8> {
    let mut maker = Maker::default();
    let last = f32::from(count - 1);
    let places: Vec<f32> = (0..count)
        .flat_map(|at| [2.0 * f32::from(at) / last - 1.0, 0.0, 0.0])
        .collect();
    let points = maker.floats("VEC3", 3, &places);
    maker.finish(json!({
        "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0, "scale": [3, 1, 0]}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": points}, "mode": 0}]}],
    }))
}

/// A red and a green splat, and a faint one, shown by two nodes.
pub(super) fn splats() -> Vec<u8> {
    let mut maker = Maker::default();
    let points = maker.floats("VEC3", 3, &TRIANGLE);
    let turns = maker.floats("VEC4", 4, &[0.0, 0.0, 0.0, 1.0].repeat(3));
    let scales = maker.floats("VEC3", 3, &[-2.0; 9]);
    let opacities = maker.floats("SCALAR", 1, &[1.0, 0.9, 0.1]);
    let colors = [1.75, -1.75, -1.75, -1.75, 1.75, -1.75, 0.0, 0.0, 0.0];
    let colors = maker.floats("VEC3", 3, &colors);
    maker.finish(json!({
        "extensionsUsed": ["KHR_gaussian_splatting"],
        "scenes": [{"nodes": [0, 1]}], "nodes": [{"mesh": 0}, {"mesh": 0, "translation": [3, 0, 0]}],
        "meshes": [{"primitives": [{"mode": 0, "attributes": {
            "POSITION": points,
            "KHR_gaussian_splatting:ROTATION": turns,
            "KHR_gaussian_splatting:SCALE": scales,
            "KHR_gaussian_splatting:OPACITY": opacities,
            "KHR_gaussian_splatting:SH_DEGREE_0_COEF_0": colors,
        }, "extensions": {"KHR_gaussian_splatting": {"kernel": "ellipse", "colorSpace": "srgb_rec709_display"}}}]}],
    }))
}

/// A triangle in three levels of detail, each a root, the coarsest with a child; without scenes all
/// nodes show.
pub(super) fn levels(has_scene: bool) -> Vec<u8> {
    let mut maker = Maker::default();
    let triangle = maker.floats("VEC3", 3, &TRIANGLE);
    let mut asset = json!({
        "extensionsUsed": ["MSFT_lod"],
        "nodes": [
            {"mesh": 0, "name": "coarse", "children": [3]},
            {"mesh": 0, "name": "middle"},
            {"mesh": 0, "name": "fine", "extensions": {"MSFT_lod": {"ids": [1, 0]}}},
            {"mesh": 0, "name": "below"},
        ],
        "meshes": [{"primitives": [{"attributes": {"POSITION": triangle}}]}],
    });
    if has_scene {
        asset["scenes"] = json!([{"nodes": [0, 1, 2]}]);
    }
    maker.finish(asset)
}

/// A picture of two by one pixels.
const PNG: &str = "iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAIAAAB7QOjdAAAAD0lEQVR4nGNoaPj/v6EBAA4AA//GDX4UAAAAAElFTkSuQmCC";

/// Four sets of texture coordinates, of which one material looks at those given, for its colour and
/// its glow, and another one at the first.
pub(super) fn sets([color, emissive]: [u32; 2]) -> Vec<u8> {
    let mut maker = Maker::default();
    let triangle = maker.floats("VEC3", 3, &TRIANGLE);
    let mut attributes = json!({"POSITION": triangle});
    for (set, corner) in [0.0_f32, 1.0, 2.0, 3.0].into_iter().enumerate() {
        let uvs = [corner, 0.0, 1.0, 0.5, 0.0, 1.0];
        attributes[format!("TEXCOORD_{set}")] = maker.floats("VEC2", 2, &uvs).into();
    }
    maker.finish(json!({
        "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [
            {"attributes": attributes, "material": 0}, {"attributes": attributes, "material": 1},
        ]}],
        "materials": [
            {"pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "texCoord": color}},
             "emissiveTexture": {"index": 0, "texCoord": emissive}, "emissiveFactor": [1, 1, 1]},
            {"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}},
        ],
        "textures": [{"source": 0}],
        "images": [{"uri": format!("data:image/png;base64,{PNG}")}],
    }))
}

/// A normal map, turned and scaled, so that tangents are made.
pub(super) fn texture() -> Vec<u8> {
    let mut maker = Maker::default();
    let triangle = maker.floats("VEC3", 3, &TRIANGLE);
    let normals = maker.floats("VEC3", 3, &[0.0, 0.0, 1.0].repeat(3));
    let uvs = maker.floats("VEC2", 2, &[0.0, 1.0, 1.0, 1.0, 0.0, 0.0]);
    maker.finish(json!({
        "extensionsUsed": ["KHR_texture_transform"],
        "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": triangle, "NORMAL": normals, "TEXCOORD_0": uvs}, "material": 0}]}],
        "materials": [{"normalTexture": {"index": 0, "scale": 0.5, "extensions":
            {"KHR_texture_transform": {"offset": [0.5, 0.25], "scale": [2, 3], "rotation": std::f64::consts::FRAC_PI_2}}}}],
        "textures": [{"source": 0, "sampler": 0}],
        "samplers": [{"magFilter": 9728, "wrapS": 33071, "wrapT": 33648}],
        "images": [{"name": "two", "uri": format!("data:image/png;base64,{PNG}")}],
    }))
}

/// Two textures of a PNG and of a KTX2, which is taken: one names the PNG too.
pub(super) fn ktx2() -> Vec<u8> {
    const KTX2: &[u8] = include_bytes!("../../fuzz/corpus/image/uastc.ktx2");
    let mut maker = Maker::default();
    let triangle = maker.floats("VEC3", 3, &TRIANGLE);
    let uvs = maker.floats("VEC2", 2, &[0.0, 1.0, 1.0, 1.0, 0.0, 0.0]);
    let replaced = json!({"KHR_texture_basisu": {"source": 1}});
    maker.finish(json!({
        "extensionsUsed": ["KHR_texture_basisu"], "extensionsRequired": ["KHR_texture_basisu"],
        "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": triangle, "TEXCOORD_0": uvs}, "material": 0}]}],
        "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}, "emissiveTexture": {"index": 1}}],
        "textures": [{"extensions": replaced}, {"source": 0, "extensions": replaced}],
        "images": [
            {"uri": format!("data:image/png;base64,{PNG}")},
            {"uri": format!("data:image/ktx2;base64,{}", STANDARD.encode(KTX2))},
        ],
    }))
}

/// A triangle for each of some square images of these sides, of which one may be cut short.
pub(super) fn images(sides: &[u32], cut: Option<usize>) -> Vec<u8> {
    let mut maker = Maker::default();
    let triangle = maker.floats("VEC3", 3, &TRIANGLE);
    let uvs = maker.floats("VEC2", 2, &[0.0, 1.0, 1.0, 1.0, 0.0, 0.0]);
    let attributes = json!({"POSITION": triangle, "TEXCOORD_0": uvs});
    let of_each = |part: &dyn Fn(usize) -> Value| (0..sides.len()).map(part).collect::<Value>();
    let image = |index: usize| {
        let mut png = squares(sides[index]);
        if cut == Some(index) {
            png.truncate(png.len() / 2);
        }
        json!({"uri": format!("data:image/png;base64,{}", STANDARD.encode(png))})
    };
    let base =
        |index: usize| json!({"pbrMetallicRoughness": {"baseColorTexture": {"index": index}}});
    maker.finish(json!({
        "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives":
            of_each(&|index| json!({"attributes": attributes, "material": index}))}],
        "materials": of_each(&base),
        "textures": of_each(&|index| json!({"source": index})),
        "images": of_each(&image),
    }))
}

/// A PNG of so many pixels a side, no two rows of it alike.
fn squares(side: u32) -> Vec<u8> {
    let pixel = |index: u32| [index / side, index % side, 3].map(|level| f64::from(level) / 255.0);
    let pixels = (0..side * side).map(pixel).collect();
    let image = rtc::internals::image::Image {
        width: side,
        height: side,
        pixels,
    };
    let picture = rtc::internals::image::Picture::opaque(image);
    picture
        .encode(rtc::internals::image::FileFormat::Png8)
        .unwrap()
}
