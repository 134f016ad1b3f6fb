//! Files with so many of one thing that work which grows faster than they do would never end.

use super::Repro;
use super::gltf::glb;
use std::fmt::Write as _;

/// What scenes begin with.
const HEAD: &str = "Camera: {eye: [0, 1, 6], center: [0, 0, 0], up: [0, 1, 0], viewSize: [200, 200]}\n\
                    Lights: [{position: [3, 5, 5], color: [1, 1, 1]}]\nObjects:\n";

/// All of them.
#[expect(clippy::too_many_lines, reason = "a table, one row a file")]
pub(crate) fn all() -> Vec<Repro> {
    vec![
        asked(
            "19 000 triangles about a point, without tangents",
            &["check", "a.glb"],
            vec![("a.glb", fan(19_000))],
            None,
        ),
        asked(
            "a picture of 9 000 triangles that are the same",
            &["render", "-q", "a.obj", "--size", "100", "-o", "a.png"],
            vec![("a.obj", equal_triangles(9_000))],
            None,
        ),
        asked(
            "1 000 objects with five slips each, to be fixed",
            &["check", "--fix", "--unsafe", "a.yaml"],
            vec![("a.yaml", slips(1_000))],
            Some("SC006"),
        ),
        asked(
            "20 000 maps that merge an alias of a list of 20 000 maps",
            &["check", "a.yaml"],
            vec![("a.yaml", merged_lists(20_000))],
            Some("SY011"),
        ),
        asked(
            "an rtc.toml of 3 000 unknown codes",
            &["check", "a.yaml"],
            vec![
                (
                    "a.yaml",
                    HEAD.replace("Objects:", "Objects: []").into_bytes(),
                ),
                ("rtc.toml", unknown_codes(3_000)),
            ],
            Some("IO004"),
        ),
        asked(
            "30 000 comments, to be laid out",
            &["fmt", "a.yaml"],
            vec![("a.yaml", comments(30_000))],
            None,
        ),
        asked(
            "a line of 1 MB with 10 000 findings",
            &[
                "check",
                "a.json",
                "--message-format",
                "short",
                "--max-errors",
                "20000",
            ],
            vec![("a.json", one_line(10_000))],
            Some("SC006"),
        ),
        asked(
            "20 000 nodes with a wrong scale",
            &[
                "check",
                "a.glb",
                "--message-format",
                "short",
                "--max-errors",
                "20000",
            ],
            vec![("a.glb", wrong_nodes(20_000))],
            Some("GL010"),
        ),
        asked(
            "2 000 textures that are not there, beside 2 000 that are",
            &["check", "a.yaml"],
            absent_names(2_000),
            Some("RE001"),
        ),
        asked(
            "20 000 materials with maps that are not there",
            &["check", "a.obj"],
            absent_maps(20_000),
            None,
        ),
    ]
}

/// What `rtc` is asked of some files.
fn asked(
    name: &'static str,
    arguments: &[&str],
    files: Vec<(impl Into<String>, Vec<u8>)>,
    expected: Option<&'static str>,
) -> Repro {
    let named = |(name, bytes): (_, _)| (Into::<String>::into(name), bytes);
    Repro {
        name,
        files: files.into_iter().map(named).collect(),
        arguments: arguments.iter().map(|word| (*word).to_owned()).collect(),
        expected,
    }
}

/// Triangles about a point, with a normal map and no tangents.
fn fan(count: u32) -> Vec<u8> {
    let vertices = count + 1;
    let mut places: Vec<[f32; 3]> = vec![[0.0; 3]];
    places.extend((0..count).map(|k| {
        // Points of a parabola instead of a circle: no function of angles is needed.
        let x = k as f32 / count as f32;
        [x + 1.0, x * x, 0.0]
    }));
    let last = places.len() as u32 - 1;
    let corners = (0..count).flat_map(|k| [0, k + 1, (k + 2).min(last)]);
    let mut chunk: Vec<u8> = places
        .iter()
        .flatten()
        .flat_map(|number| number.to_le_bytes())
        .collect();
    let indices = chunk.len();
    chunk.extend(corners.flat_map(u32::to_le_bytes));
    let [all, triangles] = [12 * vertices, 12 * count];
    let json = format!(
        r#""scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"TEXCOORD_0":2}},"indices":1,"material":0}}]}}],"materials":[{{"normalTexture":{{"index":0}}}}],"textures":[{{"source":0}}],"images":[{{"uri":"data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR4nGNoaPgPAAODAgAApfuJAAAAAElFTkSuQmCC"}}],"buffers":[{{"byteLength":{0}}}],"bufferViews":[{{"buffer":0,"byteLength":{all}}},{{"buffer":0,"byteOffset":{indices},"byteLength":{triangles}}},{{"buffer":0,"byteLength":{all},"byteStride":12}}],"accessors":[{{"bufferView":0,"componentType":5126,"count":{vertices},"type":"VEC3","min":[0,0,0],"max":[{1},{2},0]}},{{"bufferView":1,"componentType":5125,"count":{3},"type":"SCALAR"}},{{"bufferView":2,"componentType":5126,"count":{vertices},"type":"VEC2"}}]"#,
        chunk.len(),
        places[last as usize][0],
        places[last as usize][1],
        3 * count,
    );
    glb(&json, &chunk)
}

fn equal_triangles(count: usize) -> Vec<u8> {
    format!("v 0 0 0\nv 1 0 0\nv 0 1 0\n{}", "f 1 2 3\n".repeat(count)).into_bytes()
}

/// A scene of objects that each merge the same list of maps.
fn merged_lists(count: usize) -> Vec<u8> {
    let list = vec!["*a"; count].join(", ");
    let objects = "- <<: *l\n".repeat(count);
    format!("a: &a {{x: 1}}\nl: &l [{list}]\n{HEAD}{objects}").into_bytes()
}

/// Settings with levels of codes that do not exist.
fn unknown_codes(count: usize) -> Vec<u8> {
    let levels = (0..count).map(|code| format!("VA{code:04} = \"warn\"\n"));
    ("[levels]\n".to_owned() + &levels.collect::<String>()).into_bytes()
}

fn slips(count: usize) -> Vec<u8> {
    let mut text = HEAD.to_owned();
    for radius in 0..count {
        let _ = writeln!(
            text,
            "- {{type: spher, centre: [0, 0, 0], radus: {radius}, mat: {{colour: [1, 1, 1]}}}}"
        );
    }
    text.into_bytes()
}

fn comments(count: usize) -> Vec<u8> {
    let mut text = HEAD.replace("Objects:\n", "");
    (0..count).for_each(|at| text += &format!("# c{at}\n\n\n"));
    text.into_bytes()
}

fn one_line(count: usize) -> Vec<u8> {
    let object = format!(r#"{{"type":"nothing","x":"{}"}}"#, "ü".repeat(30));
    let objects = vec![object; count].join(",");
    format!(
        r#"{{"Camera":{{"eye":[0,1,6],"center":[0,0,0],"up":[0,1,0],"viewSize":[8,8]}},"Objects":[{objects}]}}"#
    )
    .into_bytes()
}

fn wrong_nodes(count: usize) -> Vec<u8> {
    let nodes = vec![r#"{"scale":[1,1]}"#; count].join(",");
    let roots: Vec<String> = (0..count).map(|node| node.to_string()).collect();
    let roots = roots.join(",");
    glb(
        &format!(r#""scene":0,"scenes":[{{"nodes":[{roots}]}}],"nodes":[{nodes}]"#),
        &[],
    )
}

fn absent_names(count: usize) -> Vec<(String, Vec<u8>)> {
    let mut text = HEAD.to_owned();
    for at in 0..count {
        let _ = writeln!(
            text,
            "- {{type: sphere, position: [0, 0, 0], radius: 1, material: {{texture: a/b/c/x{at}.png, ka: 0.2, kd: 0.7, ks: 0.1, n: 8}}}}"
        );
    }
    let there = (0..count).map(|at| (format!("y{at}.png"), Vec::new()));
    there
        .chain([("a.yaml".to_owned(), text.into_bytes())])
        .collect()
}

fn absent_maps(count: usize) -> Vec<(String, Vec<u8>)> {
    let mut library = String::new();
    let mut mesh = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\n".to_owned();
    for at in 0..count {
        let _ = writeln!(library, "newmtl a{at}\nmap_Kd t{at}.png\nmap_Ks s{at}.png");
        let _ = writeln!(mesh, "usemtl a{at}\nf 1 2 3");
    }
    vec![
        ("a.mtl".to_owned(), library.into_bytes()),
        ("a.obj".to_owned(), mesh.into_bytes()),
    ]
}
