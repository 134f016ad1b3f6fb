//! STL and PLY: the same mesh in every form, places of faults, and counts that promise too much.

use super::{folder, write};
use proptest::prelude::*;
use rtc::internals::diag::DiagnosticSink;
use rtc::internals::front::mesh::{ParsedMesh, TextParseError, is_mesh, parse};
use rtc::internals::ir::{LoweredScene, Material, Mode, VertexColumn};
use rtc::internals::pipeline::{Options, load, validate};
use rtc::internals::source::{Budget, Limits, Loader, Resource, SourceMap};

/// The vertices of a tetrahedron.
const CORNERS: [[f32; 3]; 4] = [
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.5],
];

const FACES: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];

fn stl(is_text: bool) -> Vec<u8> {
    if is_text {
        let facet = |face: [u32; 3]| {
            let corners = face.map(|at| CORNERS[at as usize]);
            let lines = corners.map(|[x, y, z]| format!("vertex {x} {y} {z}\n"));
            format!(
                "facet normal 0 0 0\nouter loop\n{}endloop\nendfacet\n",
                lines.concat()
            )
        };
        return format!("solid a #1\n{}endsolid\n", FACES.map(facet).concat()).into_bytes();
    }
    let mut bytes = b"solid, but binary".to_vec();
    bytes.resize(80, b' ');
    bytes.extend(4_u32.to_le_bytes());
    for face in FACES {
        bytes.extend([0; 12]);
        for at in face {
            bytes.extend(CORNERS[at as usize].map(f32::to_le_bytes).concat());
        }
        bytes.extend([0; 2]);
    }
    bytes
}

/// A form of PLY, and how it writes a float and an index.
type Form = (&'static str, fn(f32) -> Vec<u8>, fn(u32) -> Vec<u8>);

const FORMS: [Form; 3] = [
    (
        "ascii",
        |x| format!("{x} ").into_bytes(),
        |i| format!("{i} ").into_bytes(),
    ),
    (
        "binary_little_endian",
        |x| x.to_le_bytes().to_vec(),
        |i| i.to_le_bytes().to_vec(),
    ),
    (
        "binary_big_endian",
        |x| x.to_be_bytes().to_vec(),
        |i| i.to_be_bytes().to_vec(),
    ),
];

fn ply((form, float, index): Form) -> Vec<u8> {
    let head = format!(
        "ply\nformat {form} 1.0\nobj_info made # up\nelement vertex 4\nproperty float z\nproperty float y\nproperty float x\n\
         property list uint uint rings\nproperty float red\nproperty float green\nproperty float blue\nelement edge 1\n\
         property uint vertex1\nelement face 3\nproperty list uint uint vertex_indices\nend_header\n"
    );
    let mut bytes = head.into_bytes();
    for [x, y, z] in CORNERS {
        bytes.extend([z, y, x].into_iter().flat_map(float));
        bytes.extend([1, 7].into_iter().flat_map(index));
        bytes.extend([1.0, 0.0, 0.5].into_iter().flat_map(float));
    }
    bytes.extend(index(3));
    // A face of four corners stands for two triangles.
    for face in [&[0, 2, 1, 3][..], &[0, 3, 2], &[1, 2]] {
        bytes.extend(index(u32::try_from(face.len()).unwrap()));
        bytes.extend(face.iter().copied().flat_map(index));
    }
    bytes
}

fn read(bytes: &[u8]) -> ParsedMesh {
    assert!(is_mesh(bytes));
    parse(bytes, &Budget::default()).unwrap()
}

/// The first fault: its message, and the bytes at its place.
fn fault(bytes: &[u8]) -> (String, String) {
    let Err(TextParseError::Faults(faults)) = parse(bytes, &Budget::default()) else {
        panic!("no fault in {}", String::from_utf8_lossy(bytes));
    };
    let mut map = SourceMap::default();
    let file = map.add("mesh", bytes.to_vec());
    let span = faults[0].span(file);
    (faults[0].message.clone(), map.slice(span).into_owned())
}

#[test]
fn stl_says_the_same_as_text_and_in_binary() {
    for is_text in [true, false] {
        let mesh = read(&stl(is_text)).mesh;
        let expected = FACES.as_flattened().iter();
        let expected: Vec<_> = expected
            .map(|at| CORNERS[*at as usize].map(f64::from))
            .collect();
        assert_eq!(mesh.positions.iter().collect::<Vec<_>>(), expected);
        let triangles = [[0, 1, 2], [3, 4, 5], [6, 7, 8], [9, 10, 11]];
        assert_eq!(*mesh.triangles, triangles);
        let none = (mesh.normals.len(), mesh.uvs.len(), mesh.colors.len());
        assert_eq!(none, (0, 0, 0));
        assert_eq!((mesh.second_uvs.len(), mesh.tangents.len()), (0, 0));
    }
}

#[test]
fn ply_says_the_same_in_every_form() {
    for form in FORMS {
        let parsed = read(&ply(form));
        let mesh = parsed.mesh;
        assert_eq!(
            mesh.positions.iter().collect::<Vec<_>>(),
            CORNERS.map(|corner| corner.map(f64::from)),
            "{}",
            form.0
        );
        assert_eq!(*mesh.triangles, [[0, 2, 1], [0, 1, 3], [0, 3, 2]]);
        let [red, green, blue, alpha] = mesh.colors.at(3);
        assert_eq!((red, green, alpha), (1.0, 0.0, 1.0));
        assert!((blue - 0.214).abs() < 1e-3, "a coded 0.5 is {blue}");
        assert_eq!(
            parsed.not_drawn.map(|(_, count)| count),
            Some(1),
            "a face of two corners"
        );
    }
}

#[test]
fn a_ply_keeps_the_precision_of_its_numbers() {
    let head = |kind: &str| {
        format!(
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty {kind} x\nproperty {kind} y\n\
             property {kind} z\nproperty float s1\nproperty float t1\nproperty float linear_red\n\
             property float linear_green\nproperty float linear_blue\nproperty float linear_alpha\n\
             element face 1\nproperty list uchar int vertex_indices\nend_header\n"
        )
    };
    let body = "0 0 0 0.5 0.25 0.5 2 0 1\n1 0 0 0 0 0 0 0 1\n0 1 0 0 0 0 0 0 1\n3 0 1 2\n";
    for (kind, is_single) in [("float", true), ("double", false), ("int", false)] {
        let mesh = read(format!("{}{body}", head(kind)).as_bytes()).mesh;
        assert_eq!(
            matches!(mesh.positions, VertexColumn::Single(_)),
            is_single,
            "{kind}"
        );
        assert_eq!(mesh.second_uvs.at(0), [0.5, 0.25]);
        assert_eq!(
            mesh.colors.at(0),
            [0.5, 2.0, 0.0, 1.0],
            "nothing decodes or clamps them"
        );
    }
    let negative = format!("{}{body}", head("float")).replace("0.5 2 0 1", "0.5 -2 0 1");
    assert_eq!(fault(negative.as_bytes()).0, "a colour is negative");
}

#[test]
fn faults_of_stl_have_their_places() {
    let text = String::from_utf8(stl(true)).unwrap();
    let cases = [
        (text.replacen("1.5", "x", 1), "`x` is not a number", "x"),
        (
            text.replacen("vertex 0 0 0\n", "", 1),
            "a facet has not three corners",
            "endfacet",
        ),
        (
            text.replacen("outer", "inner", 1),
            "`inner` is not a statement of STL",
            "inner",
        ),
    ];
    for (text, message, place) in cases {
        assert_eq!(
            fault(text.as_bytes()),
            (message.to_owned(), place.to_owned())
        );
    }
    let mut infinite = stl(false);
    infinite[96..100].copy_from_slice(&f32::INFINITY.to_le_bytes());
    assert_eq!(fault(&infinite).0, "a corner of a triangle is not finite");
}

/// A slip in a PLY: what is replaced by what, the fault, and its place.
const SLIPS: [[&str; 4]; 6] = [
    ["float z", "floot z", "unknown type `floot`", "floot"],
    [
        "format",
        "fromat",
        "`fromat ascii 1.0` is not a line of a header",
        "fromat",
    ],
    [
        "float z",
        "float w",
        "the vertices have no x, y and z",
        "vertex",
    ],
    [
        "face 3",
        "face 4",
        "the file ends before the last of 4 of `face`",
        "4",
    ],
    ["face 3", "face -3", "a count is negative", "-3"],
    [
        "vertex 4",
        "vertex 4000000000",
        "the file ends before the last of 4000000000 of `vertex`",
        "4000000000",
    ],
];

#[test]
fn faults_of_ply_have_their_places() {
    let text = String::from_utf8(ply(FORMS[0])).unwrap();
    for [from, to, message, place] in SLIPS {
        let own = fault(text.replacen(from, to, 1).as_bytes());
        assert_eq!(own.0, message, "{to}");
        assert_eq!(own.1, place, "{to}");
    }
    // Any number of faces of nothing is nothing, and soon told.
    let none = text.replacen(
        "element face 3",
        "element face 4294967295\nelement edge 3",
        1,
    );
    let points = read(none.as_bytes()).mesh;
    assert_eq!(points.triangles.len(), 4 * 8, "a solid a vertex");
    let mut cut = ply(FORMS[1]);
    cut.pop();
    assert_eq!(
        fault(&cut).0,
        "the file ends before the last of 3 of `face`"
    );
}

#[test]
fn a_mesh_is_charged_before_it_is_made() {
    for bytes in [stl(true), stl(false), ply(FORMS[0]), ply(FORMS[2])] {
        for resource in [Resource::Vertices, Resource::Memory] {
            let mut limits = Limits::default();
            limits.set(resource, 3);
            let outcome = parse(&bytes, &Budget::new(limits));
            assert!(
                matches!(outcome, Err(TextParseError::Limit(_))),
                "{resource:?}"
            );
        }
    }
}

/// A mesh file loaded as the scene, and what is found, `CODE message` a line.
fn alone(name: &str, bytes: &[u8], beside: &[(&str, &str)]) -> (Option<LoweredScene>, String) {
    let folder = folder();
    let path = folder.path().join(name);
    write(&folder, name, bytes);
    beside
        .iter()
        .for_each(|(name, text)| write(&folder, name, text));
    let (mut map, mut sink) = (SourceMap::default(), DiagnosticSink::default());
    let file = Loader.file(&path, &mut map).unwrap();
    let options = Options::default();
    let lowered = load(file, &mut map, &options, &mut sink);
    let proof = lowered
        .as_ref()
        .and_then(|lowered| validate(lowered, &options, &mut sink));
    assert_eq!(proof.is_some(), lowered.is_some());
    let lines = sink.kept().iter();
    let lines = lines.map(|finding| format!("{} {}\n", finding.code, finding.message));
    (lowered, lines.collect())
}

#[test]
fn a_mesh_alone_is_an_asset() {
    let off = b"OFF\n4 1 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2\n";
    let z_up = "RD013 the mesh stands on z = 0, as if z pointed up\n";
    for (name, bytes, expected) in [
        ("a.stl", stl(true), z_up),
        ("b.stl", stl(false), z_up),
        ("c.off", off.to_vec(), ""),
    ] {
        let (lowered, findings) = alone(name, &bytes, &[]);
        let scene = lowered.unwrap().scene;
        let Material::Standard(standard) = &scene.materials[0] else {
            panic!("{name} is not of the standard material");
        };
        assert!(matches!(scene.settings.mode, Mode::Path(_)) && scene.lights.is_empty());
        assert_eq!(
            (standard.base_color, standard.metallic),
            ([0.7, 0.7, 0.7, 1.0], 0.0)
        );
        assert_eq!(
            (scene.meshes[0].name.as_str(), findings.as_str()),
            (name, expected)
        );
    }
    let scene = alone("d.ply", &ply(FORMS[0]), &[]).0.unwrap().scene;
    assert_eq!(scene.meshes[0].colors.len(), 4);
}

#[test]
fn an_obj_alone_has_the_materials_of_its_mtl() {
    let obj = b"mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nusemtl a\nf 2 3 4\n";
    let (lowered, findings) = alone("m.obj", obj, &[("m.mtl", "newmtl a\nKd 1 0 0\n")]);
    let scene = lowered.unwrap().scene;
    let color = |at: usize| {
        let material = &scene.materials[scene.surfaces[at].material.0 as usize];
        let Material::Standard(standard) = material else {
            panic!("paths are traced");
        };
        let [r, g, b, _] = standard.base_color;
        [r, g, b]
    };
    assert_eq!(
        (scene.surfaces.len(), color(0), color(1)),
        (2, [0.7; 3], [1.0, 0.0, 0.0])
    );
    assert_eq!(findings, "");
    let (lowered, findings) = alone("m.obj", obj, &[]);
    assert_eq!(lowered.unwrap().scene.surfaces.len(), 1);
    assert_eq!(
        findings,
        "RE010 there is no file `m.mtl`; its materials are left out\n"
    );
}

#[test]
fn a_file_that_only_its_name_calls_a_mesh_is_refused() {
    let (lowered, findings) = alone("m.stl", b"\0\x01\x02 nothing", &[]);
    assert!(lowered.is_none());
    assert!(
        findings.starts_with("RE006 ")
            && findings.ends_with("m.stl` is no OBJ, OFF, STL, PLY or XYZ\n"),
        "{findings}"
    );
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, cases: 600, ..ProptestConfig::default() })]

    #[test]
    fn any_damage_leaves_a_sound_mesh_or_an_error(
        form in 0..5_usize,
        damage in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..6),
        end in any::<prop::sample::Index>(),
        cuts in prop::bool::ANY,
    ) {
        let mut bytes = match form {
            0 => stl(true),
            1 => stl(false),
            _ => ply(FORMS[form - 2]),
        };
        for (at, byte) in damage {
            let at = at.index(bytes.len());
            bytes[at] = byte;
        }
        if cuts {
            bytes.truncate(end.index(bytes.len()));
        }
        if let Ok(ParsedMesh { mesh, .. }) = parse(&bytes, &Budget::default()) {
            let count = mesh.positions.len();
            prop_assert!(mesh.triangles.iter().flatten().all(|corner| (*corner as usize) < count));
            let lengths = [mesh.normals.len(), mesh.uvs.len(), mesh.colors.len()];
            prop_assert!(lengths.iter().all(|length| *length == 0 || *length == count));
            prop_assert!(mesh.positions.iter().flatten().all(|number| number.is_finite()));
        }
    }
}
