//! Long lists, and loops over them that must not be loops within loops.

use super::super::Repro;
use super::{check, list, many, primitive, scene, zeros};

/// All of them.
pub(super) fn all() -> Vec<Repro> {
    vec![
        children(),
        required(),
        ring(),
        attributes(),
        target_attributes(),
        type_errors(),
        empty_nodes(),
        long_name(),
        long_pointers(),
        deep_pointers(),
        wide_root(),
        skins_and_scenes(),
        skinned_primitives(),
        materials(),
        variants(),
        declared(),
    ]
}

/// Two nodes that share all children.
fn children() -> Repro {
    const COUNT: usize = 70_000;
    let children = list(COUNT, |child| (child + 2).to_string());
    let parent = format!(r#"{{"children":[{children}]}}"#);
    let parts = format!(
        r#""nodes":[{parent},{parent},{}]"#,
        list(COUNT, |_| "{}".to_owned())
    );
    check(
        "two nodes with the same 70 000 children",
        Some("GL037"),
        &parts,
        &[],
    )
}

fn required() -> Repro {
    let name = |index| format!(r#""X_{index}""#);
    let parts = [
        many("extensionsUsed", 40_000, |index| format!(r#""Y_{index}""#)),
        many("extensionsRequired", 40_000, name),
    ];
    check(
        "40 000 `extensionsRequired`",
        Some("GL017"),
        &parts.join(","),
        &[],
    )
}

fn ring() -> Repro {
    const COUNT: usize = 30_000;
    let parts = many("nodes", COUNT, |node| {
        format!(r#"{{"children":[{}]}}"#, (node + 1) % COUNT)
    });
    check("a loop of 30 000 nodes", Some("GL037"), &parts, &[])
}

fn attributes() -> Repro {
    let own = list(25_000, |set| format!(r#""TEXCOORD_{set}":1"#));
    let parts = [
        format!(r#""accessors":[{},{}]"#, zeros(3, "VEC3"), zeros(3, "VEC2")),
        format!(r#""meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,{own}}}}}]}}]"#),
        r#""nodes":[{"mesh":0}]"#.to_owned(),
        scene(1),
    ];
    check("25 000 attributes", None, &parts.join(","), &[])
}

/// Many attributes, each moved by a morph target, on an asset that lists many extensions.
fn target_attributes() -> Repro {
    let own = list(15_000, |index| format!(r#""_{index}":0"#));
    let parts = [
        many("extensionsUsed", 10_000, |index| {
            format!(r#""EXT_{index}""#)
        }),
        format!(r#""accessors":[{}]"#, zeros(3, "VEC3")),
        format!(
            r#""meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,{own}}},"targets":[{{{own}}}]}}]}}]"#
        ),
        r#""nodes":[{"mesh":0}]"#.to_owned(),
        scene(1),
    ];
    check(
        "15 000 attributes that a morph target moves",
        None,
        &parts.join(","),
        &[],
    )
}

fn type_errors() -> Repro {
    check(
        "400 000 type errors",
        Some("GL006"),
        &many("extensionsUsed", 400_000, |_| "0".to_owned()),
        &[],
    )
}

/// Parts that take far more room than what is written of them.
fn empty_nodes() -> Repro {
    check(
        "2 000 000 empty nodes",
        Some("IO003"),
        &many("nodes", 2_000_000, |_| "{}".to_owned()),
        &[],
    )
}

/// A long name, as often as there are primitives.
fn long_name() -> Repro {
    let name = "n".repeat(200_000);
    let other = |_| r#"{"attributes":{"POSITION":0},"material":0}"#.to_owned();
    let parts = [
        format!(r#""accessors":[{}]"#, zeros(3, "VEC3")),
        format!(
            r#""meshes":[{{"name":"{name}","primitives":[{}]}}]"#,
            list(5_000, other)
        ),
        r#""materials":[{}]"#.to_owned(),
        format!(r#""nodes":[{{"mesh":0,"name":"{name}"}}]"#),
        scene(1),
    ];
    check(
        "a name of 200 KB on 5 000 surfaces",
        Some("IO003"),
        &parts.join(","),
        &[],
    )
}

/// Findings below a long key.
fn long_pointers() -> Repro {
    let (key, wrong) = (
        "EXT_".to_owned() + &"k".repeat(300_000),
        many("x", 100_000, |_| "1".to_owned()),
    );
    let unknown = list(20_000, |index| format!(r#""{index}":0"#));
    let parts = format!(
        r#""extensionsUsed":["KHR_materials_variants"],"extensions":{{"{key}":{{{wrong},{unknown}}},"KHR_materials_variants":{{"variants":[{}]}}}}"#,
        list(20_000, |_| "0".to_owned())
    );
    check(
        "100 000 findings beside a key of 300 KB",
        Some("GL006"),
        &parts,
        &[],
    )
}

/// Findings whose way from the root is long.
fn deep_pointers() -> Repro {
    let key = "k".repeat(1_000);
    let depth = 200;
    let open = format!(r#"{{"{key}":"#).repeat(depth);
    let twice = list(20_000, |_| r#""a":0"#.to_owned());
    let parts = format!(r#""extras":{open}{{{twice}}}{}"#, "}".repeat(depth));
    check(
        "20 000 findings below a key of 200 × 1 KB",
        Some("GL005"),
        &parts,
        &[],
    )
}

/// Lights that each look up what stands last in a long map.
fn wide_root() -> Repro {
    let unknown = list(40_000, |index| format!(r#""u{index}":0"#));
    let node = r#"{"extensions":{"KHR_lights_punctual":{"light":0}}}"#;
    let parts = [
        unknown,
        r#""extensionsUsed":["KHR_lights_punctual"]"#.to_owned(),
        many("nodes", 10_000, |_| node.to_owned()),
        r#""extensions":{"KHR_lights_punctual":{"lights":[{"type":"point"}]}}"#.to_owned(),
    ];
    check(
        "10 000 references past 40 000 keys",
        None,
        &parts.join(","),
        &[],
    )
}

/// Skinned nodes, and scenes that show all of them.
fn skins_and_scenes() -> Repro {
    let joints = zeros(3, "VEC4").replace("5126", "5121");
    let parts = [
        format!(
            r#""accessors":[{},{joints},{}]"#,
            zeros(3, "VEC3"),
            zeros(3, "VEC4")
        ),
        r#""meshes":[{"primitives":[{"attributes":{"POSITION":0,"JOINTS_0":1,"WEIGHTS_0":2}}]}]"#
            .to_owned(),
        r#""skins":[{"joints":[0]}]"#.to_owned(),
        format!(
            r#""nodes":[{{"name":"j"}},{}]"#,
            list(20_000, |_| r#"{"mesh":0,"skin":0}"#.to_owned())
        ),
        format!(
            r#""scene":0,"scenes":[{{"nodes":[{}]}}]"#,
            list(20_001, |node| (20_000 - node).to_string())
        ),
    ];
    check(
        "20 000 skinned nodes in a scene of 20 001",
        None,
        &parts.join(","),
        &[],
    )
}

/// Nodes that ask whether a mesh of many primitives has joints.
fn skinned_primitives() -> Repro {
    let parts = [
        format!(r#""accessors":[{}]"#, zeros(3, "VEC3")),
        format!(
            r#""meshes":[{{"primitives":[{}]}}]"#,
            list(12_000, |_| primitive(0))
        ),
        many("nodes", 25_000, |_| r#"{"mesh":0}"#.to_owned()),
        r#""scenes":[{"nodes":[0]}]"#.to_owned(),
    ];
    check(
        "25 000 nodes × 12 000 primitives, one shown",
        None,
        &parts.join(","),
        &[],
    )
}

/// Primitives that each look through one long material.
fn materials() -> Repro {
    let own = list(20_000, |index| format!(r#""{index}Texture":0"#));
    let parts = [
        format!(r#""accessors":[{}]"#, zeros(3, "VEC3")),
        format!(
            r#""meshes":[{{"primitives":[{}]}}]"#,
            list(8_000, |_| r#"{"attributes":{"POSITION":0},"material":0}"#
                .to_owned())
        ),
        format!(r#""materials":[{{"extras":{{}},{own}}}]"#),
        r#""nodes":[{"mesh":0}]"#.to_owned(),
        scene(1),
    ];
    check(
        "8 000 primitives of a material of 20 000 keys",
        None,
        &parts.join(","),
        &[],
    )
}

/// Nodes that each look for a variant in a long list of mappings.
fn variants() -> Repro {
    const COUNT: usize = 8_000;
    let mapping = |variant| format!(r#"{{"material":0,"variants":[{variant}]}}"#);
    let mappings = format!(
        r#"{{"KHR_materials_variants":{{"mappings":[{}]}}}}"#,
        list(COUNT, mapping)
    );
    let parts = [
        r#""extensionsUsed":["KHR_materials_variants"]"#.to_owned(),
        format!(r#""accessors":[{}]"#, zeros(3, "VEC3")),
        format!(
            r#""meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"extensions":{mappings}}}]}}]"#
        ),
        r#""materials":[{}]"#.to_owned(),
        many("nodes", 20_000, |_| r#"{"mesh":0}"#.to_owned()),
        scene(20_000),
        format!(
            r#""extensions":{{"KHR_materials_variants":{{{}}}}}"#,
            many("variants", COUNT, |variant| format!(
                r#"{{"name":"v{variant}"}}"#
            ))
        ),
    ];
    let mut repro = check(
        "20 000 nodes × 8 000 mappings of variants",
        None,
        &parts.join(","),
        &[],
    );
    repro
        .arguments
        .extend(["--variant".to_owned(), format!("v{}", COUNT - 1)]);
    repro
}

/// Extensions that are looked up among those declared, once for each object.
fn declared() -> Repro {
    let parts = [
        many("extensionsUsed", 25_000, |index| {
            format!(r#""EXT_{index}""#)
        }),
        many("nodes", 15_000, |_| {
            r#"{"extensions":{"EXT_24999":{}}}"#.to_owned()
        }),
    ];
    check(
        "15 000 objects with the last of 25 000 extensions",
        None,
        &parts.join(","),
        &[],
    )
}
