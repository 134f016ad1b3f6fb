//! Nodes, meshes, morph targets, skins and animations that multiply each other.

use super::super::Repro;
use super::{check, glb, list, many, primitive, scene, zeros};

/// All of them.
pub(super) fn all() -> Vec<Repro> {
    vec![
        instances(),
        nodes_and_primitives(),
        placements(),
        distinct_primitives(),
        many_targets(),
        own_weights(),
        nodes_and_targets(),
        joints(),
        influences(),
        channels(),
        keyframes(),
        tangents(),
    ]
}

const MESH: &str = r#"{"mesh":0}"#;

fn mesh_nodes(count: usize) -> String {
    many("nodes", count, |_| MESH.to_owned())
}

/// 20 nodes, each with the same million of instances.
fn instances() -> Repro {
    let node =
        r#"{"mesh":0,"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":0}}}}"#;
    let parts = [
        r#""extensionsUsed":["EXT_mesh_gpu_instancing"]"#.to_owned(),
        format!(
            r#""accessors":[{},{}]"#,
            zeros(1_000_000, "VEC3"),
            zeros(3, "VEC3")
        ),
        format!(r#""meshes":[{{"primitives":[{}]}}]"#, primitive(1)),
        many("nodes", 20, |_| node.to_owned()),
        scene(20),
    ];
    check(
        "20 nodes with 10⁶ instances each",
        Some("IO003"),
        &parts.join(","),
        &[],
    )
}

/// Nodes that all show a mesh of equal primitives.
fn nodes_and_primitives() -> Repro {
    let parts = [
        format!(r#""accessors":[{}]"#, zeros(3, "VEC3")),
        format!(
            r#""meshes":[{{"primitives":[{}]}}]"#,
            list(3_000, |_| primitive(0))
        ),
        mesh_nodes(3_000),
        scene(3_000),
    ];
    check(
        "3 000 nodes × one mesh of 3 000 equal primitives",
        Some("IO003"),
        &parts.join(","),
        &[],
    )
}

/// A scene that places an asset of many nodes many times.
fn placements() -> Repro {
    let parts = [
        format!(r#""accessors":[{}]"#, zeros(3, "VEC3")),
        format!(r#""meshes":[{{"primitives":[{}]}}]"#, primitive(0)),
        mesh_nodes(10_000),
        scene(10_000),
    ];
    let yaml = format!(
        "Eye: [0, 0, 9]\nObjects:\n{}",
        "- {type: gltf, file: a.glb}\n".repeat(20_000)
    );
    let files = vec![
        ("s.yaml".to_owned(), yaml.into_bytes()),
        ("a.glb".to_owned(), glb(&parts.join(","), &[])),
    ];
    let arguments = ["check", "s.yaml"].map(str::to_owned).to_vec();
    Repro {
        name: "YAML with 20 000 × an asset of 10 000 nodes",
        files,
        arguments,
        expected: Some("IO003"),
    }
}

/// Primitives that differ in an attribute that nobody looks at.
fn distinct_primitives() -> Repro {
    let distinct = |index| format!(r#"{{"attributes":{{"POSITION":0,"_A":{}}}}}"#, index + 1);
    let parts = [
        many("accessors", 8_001, |_| zeros(3, "VEC3")),
        format!(r#""meshes":[{{"primitives":[{}]}}]"#, list(8_000, distinct)),
        mesh_nodes(100),
        scene(100),
    ];
    check(
        "100 nodes × 8 000 distinct primitives",
        Some("IO003"),
        &parts.join(","),
        &[],
    )
}

/// A primitive with this many targets, each of the same accessor.
fn morphing(targets: usize) -> String {
    let targets = list(targets, |_| r#"{"POSITION":0}"#.to_owned());
    format!(r#"{{"attributes":{{"POSITION":0}},"targets":[{targets}]}}"#)
}

fn many_targets() -> Repro {
    let weights = list(15_000, |_| "1".to_owned());
    let parts = [
        format!(r#""accessors":[{}]"#, zeros(40_000, "VEC3")),
        format!(
            r#""meshes":[{{"primitives":[{}],"weights":[{weights}]}}]"#,
            morphing(15_000)
        ),
        mesh_nodes(1),
        scene(1),
    ];
    check(
        "15 000 morph targets of 40 000 vertices",
        Some("IO003"),
        &parts.join(","),
        &[],
    )
}

fn own_weights() -> Repro {
    let parts = [
        format!(r#""accessors":[{}]"#, zeros(40_000, "VEC3")),
        format!(r#""meshes":[{{"primitives":[{}]}}]"#, morphing(1)),
        many("nodes", 12_000, |node| {
            format!(r#"{{"mesh":0,"weights":[{}]}}"#, node + 1)
        }),
        scene(12_000),
    ];
    check(
        "12 000 nodes with own weights",
        Some("IO003"),
        &parts.join(","),
        &[],
    )
}

fn nodes_and_targets() -> Repro {
    let parts = [
        format!(r#""accessors":[{}]"#, zeros(3, "VEC3")),
        format!(
            r#""meshes":[{{"primitives":[{}]}}]"#,
            list(10, |_| morphing(2_000))
        ),
        mesh_nodes(20_000),
        scene(20_000),
    ];
    check(
        "20 000 nodes × 10 primitives × 2 000 targets",
        None,
        &parts.join(","),
        &[],
    )
}

/// Nodes that all hang a mesh on the same many joints.
fn joints() -> Repro {
    const JOINTS: usize = 20_000;
    let joint = |_| r#"{"name":"j"}"#.to_owned();
    let skinned = r#"{"mesh":0,"skin":0}"#;
    let parts = [
        format!(
            r#""accessors":[{},{}]"#,
            zeros(3, "VEC3"),
            zeros(3, "VEC4").replace("5126", "5121")
        ),
        r#""meshes":[{"primitives":[{"attributes":{"POSITION":0,"JOINTS_0":1,"WEIGHTS_0":2}}]}]"#
            .to_owned(),
        format!(
            r#""nodes":[{{"children":[{}]}},"#,
            list(JOINTS, |joint| (joint + 1).to_string())
        ) + &list(JOINTS, joint)
            + ","
            + &list(JOINTS, |_| skinned.to_owned())
            + "]",
        format!(
            r#""skins":[{{"joints":[{}]}}]"#,
            list(JOINTS, |joint| (joint + 1).to_string())
        ),
        format!(
            r#""scenes":[{{"nodes":[0,{}]}}]"#,
            list(JOINTS, |node| (node + 1 + JOINTS).to_string())
        ),
    ];
    let parts = parts.join(",").replace(
        r#"}],"meshes""#,
        &format!(r#"}},{}],"meshes""#, zeros(3, "VEC4")),
    );
    check("20 000 nodes on a skin of 20 000 joints", None, &parts, &[])
}

/// One skin on many nodes whose mesh has many vertices, all of them with weights.
fn influences() -> Repro {
    const VERTICES: usize = 40_000;
    let joints = vec![0_u8; 4 * VERTICES];
    let weights = [255_u8, 0, 0, 0].repeat(VERTICES);
    let view = |offset| {
        format!(
            r#"{{"buffer":0,"byteOffset":{offset},"byteLength":{}}}"#,
            4 * VERTICES
        )
    };
    let of = |view, more: &str| {
        format!(
            r#"{{"bufferView":{view},"componentType":5121,"type":"VEC4","count":{VERTICES}{more}}}"#
        )
    };
    let parts = [
        format!(r#""buffers":[{{"byteLength":{}}}]"#, 8 * VERTICES),
        format!(r#""bufferViews":[{},{}]"#, view(0), view(4 * VERTICES)),
        format!(
            r#""accessors":[{},{},{}]"#,
            zeros(VERTICES, "VEC3"),
            of(0, ""),
            of(1, r#","normalized":true"#)
        ),
        r#""meshes":[{"primitives":[{"attributes":{"POSITION":0,"JOINTS_0":1,"WEIGHTS_0":2}}]}]"#
            .to_owned(),
        r#""skins":[{"joints":[0]}]"#.to_owned(),
        format!(
            r#""nodes":[{{"name":"j"}},{}]"#,
            list(5_000, |_| r#"{"mesh":0,"skin":0}"#.to_owned())
        ),
        scene(5_001),
    ];
    check(
        "5 000 nodes with a skin × 40 000 vertices",
        None,
        &parts.join(","),
        &[joints, weights].concat(),
    )
}

/// Channels that each set the weights of a node from one long row of keyframes.
fn channels() -> Repro {
    const TARGETS: usize = 20_000;
    const NODES: usize = 6_000;
    let channel = |node| format!(r#"{{"sampler":0,"target":{{"node":{node},"path":"weights"}}}}"#);
    let parts = [
        format!(
            r#""accessors":[{},{},{}]"#,
            zeros(3, "VEC3"),
            zeros(1, "SCALAR"),
            zeros(TARGETS, "SCALAR")
        ),
        format!(r#""meshes":[{{"primitives":[{}]}}]"#, morphing(TARGETS)),
        format!(
            r#""animations":[{{"samplers":[{{"input":1,"output":2}}],"channels":[{}]}}]"#,
            list(NODES, channel)
        ),
        mesh_nodes(NODES),
        scene(NODES),
    ];
    let mut repro = check(
        "6 000 channels × 20 000 weights",
        Some("IO003"),
        &parts.join(","),
        &[],
    );
    repro
        .arguments
        .extend(["--time".to_owned(), "0".to_owned()]);
    repro
}

/// Samplers that all read the same many keyframes.
fn keyframes() -> Repro {
    const KEYS: usize = 100_000;
    const NODES: usize = 5_000;
    let times = (0..KEYS).flat_map(|key| {
        f32::to_le_bytes(
            f32::from(u16::try_from(key / 2).unwrap()) + if key % 2 == 0 { 0.0 } else { 0.5 },
        )
    });
    let times: Vec<u8> = times.collect();
    let last = f32::from(u16::try_from((KEYS - 1) / 2).unwrap()) + 0.5;
    let channel =
        |node| format!(r#"{{"sampler":{node},"target":{{"node":{node},"path":"translation"}}}}"#);
    let parts = [
        format!(r#""buffers":[{{"byteLength":{}}}]"#, times.len()),
        format!(
            r#""bufferViews":[{{"buffer":0,"byteLength":{}}}]"#,
            times.len()
        ),
        format!(
            r#""accessors":[{},{{"bufferView":0,"componentType":5126,"type":"SCALAR","count":{KEYS},"min":[0],"max":[{last}]}},{}]"#,
            zeros(3, "VEC3"),
            zeros(KEYS, "VEC3")
        ),
        format!(r#""meshes":[{{"primitives":[{}]}}]"#, primitive(0)),
        format!(
            r#""animations":[{{"samplers":[{}],"channels":[{}]}}]"#,
            list(NODES, |_| r#"{"input":1,"output":2}"#.to_owned()),
            list(NODES, channel)
        ),
        mesh_nodes(NODES),
        scene(NODES),
    ];
    let mut repro = check(
        "5 000 samplers × 100 000 keyframes",
        None,
        &parts.join(","),
        &times,
    );
    repro
        .arguments
        .extend(["--time".to_owned(), "7".to_owned()]);
    repro
}

/// Many nodes whose meshes differ in their weights and need tangents.
fn tangents() -> Repro {
    let attributes = r#"{"POSITION":0,"NORMAL":0,"TEXCOORD_0":1}"#;
    let parts = [
        format!(
            r#""accessors":[{},{}]"#,
            zeros(30_000, "VEC3"),
            zeros(30_000, "VEC2")
        ),
        format!(
            r#""meshes":[{{"primitives":[{{"attributes":{attributes},"material":0,"targets":[{{"POSITION":0}}]}}]}}]"#
        ),
        r#""extensionsUsed":["KHR_materials_anisotropy"]"#.to_owned(),
        r#""materials":[{"extensions":{"KHR_materials_anisotropy":{"anisotropyStrength":0.5}}}]"#
            .to_owned(),
        many("nodes", 5_000, |node| {
            format!(r#"{{"mesh":0,"weights":[{}]}}"#, node + 1)
        }),
        scene(5_000),
    ];
    check(
        "tangents made for 5 000 poses of 30 000 vertices",
        Some("IO003"),
        &parts.join(","),
        &[],
    )
}
