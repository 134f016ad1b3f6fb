//! OBJ and OFF files: what becomes of them, and where their faults are.

use super::{MESH, Outcome, bring, folder, write};
use proptest::prelude::*;
use rtc::internals::front::FrontOptions;
use rtc::internals::ir::{Mesh, VertexColumn};

/// Brings a mesh file of this text.
fn mesh(text: impl AsRef<[u8]>) -> Outcome {
    let folder = folder();
    write(&folder, "inner/m.obj", text);
    bring(
        &folder.path().join("inner/scene.yaml"),
        MESH,
        "m.obj",
        &FrontOptions::default(),
    )
}

fn list<const N: usize>(column: &VertexColumn<N>) -> Vec<[f64; N]> {
    column.iter().collect()
}

#[test]
fn obj_files_become_triangles() {
    let text = "# caf\u{e9}\no cube\nmtllib none.mtl\nv 0 0 0\nv 1 0 0 1\nv 1 1 0 0.5 0.5 0.5\ng half\nv 0 0.1 0\nusemtl red\n\
                f 1 2 \\\n 3 -1\ns off\ng other\nf -4 -2 -1\n";
    let latin1: Vec<u8> = text.chars().map(|c| c as u8).collect();
    for bytes in [
        text.as_bytes(),
        &latin1,
        text.replace('\n', "\r\n").as_bytes(),
    ] {
        let Outcome {
            lowered, findings, ..
        } = mesh(bytes);
        let traced =
            "RE007 warning scene.yaml:1:3 only path tracing shows the colours of vertices\n";
        assert_eq!(findings, traced);
        let mesh = &lowered.scene.meshes[0];
        assert_eq!(
            list(&mesh.positions),
            [
                [0.0, 0.0, 0.0],
                [1.0, 0.0, 0.0],
                [1.0, 1.0, 0.0],
                [0.0, 0.1, 0.0]
            ]
        );
        assert_eq!(*mesh.triangles, [[0, 1, 2], [0, 2, 3], [0, 2, 3]]);
        assert_eq!(
            (mesh.name.as_str(), mesh.normals.len(), mesh.uvs.len()),
            ("mesh", 0, 0)
        );
    }
}

#[test]
fn normals_and_uvs_stay_with_their_corners() {
    let corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0.25 0.75 0\nvt 0.5\nvn 0 0 1\nvn 1 0 0\n";
    let all = mesh(format!(
        "{corners}f 1/1/1 2/2/1 3/1/2\nf 1/1/2 2/2/1 3/1/2\n"
    ))
    .lowered
    .scene
    .meshes
    .remove(0);
    assert_eq!(all.positions.len(), 4, "one corner has two normals");
    assert_eq!(
        list(&all.uvs),
        [[0.25, 0.75], [0.5, 0.0], [0.25, 0.75], [0.25, 0.75]]
    );
    assert_eq!(
        list(&all.normals),
        [
            [0.0, 0.0, 1.0],
            [0.0, 0.0, 1.0],
            [1.0, 0.0, 0.0],
            [1.0, 0.0, 0.0]
        ]
    );
    let some = mesh(format!("{corners}f 1//1 2//1 3//2\nf 1 2 3\n"))
        .lowered
        .scene
        .meshes
        .remove(0);
    assert_eq!(
        (some.positions.len(), some.normals.len(), some.uvs.len()),
        (6, 6, 0)
    );
    assert_eq!(
        list(&some.normals)[3..],
        [[0.0; 3]; 3],
        "flat where the file says nothing"
    );
}

#[test]
fn off_files_become_triangles() {
    let body = "4 2 0\n0 0 0\n1 0 0 # corner\n1 1 0\n0 1 0\n\n4 0 1 2 3 255 0 0\n3 0 2 3\n";
    for text in [
        format!("OFF\n{body}"),
        format!("# first\nOFF {body}"),
        format!("COFF\n{}", body.replace("1 1 0", "1 1 0 9 9 9 1")),
    ] {
        let Outcome {
            lowered, findings, ..
        } = mesh(&text);
        assert!(findings.contains("colours"), "{text}");
        let mesh = &lowered.scene.meshes[0];
        let corners = mesh.triangles.iter().flatten();
        let corners: Vec<_> = corners.map(|at| mesh.positions.at(*at as usize)).collect();
        let expected = [0, 1, 2, 0, 2, 3, 0, 2, 3]
            .map(|at| [[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]][at]);
        assert_eq!(corners, expected);
    }
    let normals = mesh("NOFF\n3 1 0\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 1 0 0\n3 0 1 2\n")
        .lowered
        .scene
        .meshes
        .remove(0);
    assert_eq!(
        list(&normals.normals),
        [[0.0, 0.0, 1.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]
    );
}

/// Asserts that the first error of each text begins as expected.
fn are_told<T: AsRef<str>>(cases: &[(T, &str)]) {
    for (text, expected) in cases {
        let text = text.as_ref();
        let findings = mesh(text).findings;
        assert!(
            findings.starts_with(&format!("RE006 error {expected}")),
            "{text}: {findings}"
        );
    }
}

#[test]
fn faults_of_obj_files_have_their_place_there() {
    let corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    are_told(&[
        (
            "v 0 0\n".to_owned(),
            "m.obj:1:1 2 numbers where there should be 3",
        ),
        (
            "v 0 nan 0\n".to_owned(),
            "m.obj:1:5 `nan` is not a finite number",
        ),
        (
            "v 0 1e999 0\n".to_owned(),
            "m.obj:1:5 `1e999` is not a finite number",
        ),
        ("v 0 1,5 0\n".to_owned(), "m.obj:1:5 `1,5` is not a number"),
        (
            format!("{corners}f 1 2 4\n"),
            "m.obj:4:7 a face refers to vertex 4, but the file has only 3",
        ),
        (
            format!("{corners}f 1 2 0\n"),
            "m.obj:4:7 a face refers to vertex 0, but the file has only 3",
        ),
        (
            format!("{corners}f 1 2 -4\n"),
            "m.obj:4:7 a face refers to vertex -4, but only 3 come before it",
        ),
        (
            format!("{corners}f 1/1 2 3\n"),
            "m.obj:4:5 a face refers to texture coordinate 1, but the file has only 0",
        ),
        (
            format!("{corners}f 1//-9223372036854775808 2 3\n"),
            "m.obj:4:6 a face refers to normal",
        ),
        (
            format!("{corners}f 1///4 2 3\n"),
            "m.obj:4:3 `1///4` has more than three parts",
        ),
        (
            format!("{corners}f /1 2 3\n"),
            "m.obj:4:3 the corner `/1` has no vertex",
        ),
        (
            format!("{corners}f a b c\n"),
            "m.obj:4:3 `a` is not a whole number",
        ),
        (
            "o nothing\nv 0 0 0\nf 1 1\n".to_owned(),
            "m.obj:3:1 faces need three corners",
        ),
    ]);
}

#[test]
fn faults_of_off_files_have_their_place_there() {
    are_told(&[
        (
            "OFF\n3 1 0\n0 0 0\n",
            "m.obj:2:1 the file ends before the last of 3 vertices",
        ),
        (
            "OFF\n99999999999999 1 0\n0 0 0\n",
            "m.obj:2:1 the file ends before the last of 99999999999999",
        ),
        ("OFF\n-1 1 0\n", "m.obj:2:1 there can't be -1 vertices"),
        ("OFF\n3\n", "m.obj:1:1 the number of faces is missing"),
        ("OFF BINARY\n", "m.obj:1:5 binary OFF is not supported"),
        (
            "4OFF\n",
            "m.obj:1:1 `4OFF` is a kind of OFF that is not supported",
        ),
        (
            "OFF\n1 1 0\n0 0 0\n3 0 0 1\n",
            "m.obj:4:7 a face refers to vertex 1, but there are only 1, from 0",
        ),
        (
            "OFF\n1 1 0\n0 0 0\n4 0 0 0\n",
            "m.obj:4:1 a face of 4 corners names 3",
        ),
    ]);
}

#[test]
fn nothing_is_told_from_a_file_that_is_no_mesh() {
    for text in [
        "root:x:0:0:root:/root:/bin/sh\n",
        "TOKEN=secret",
        "# secret\n",
        "f secret secret secret\n",
        "s secret\nv",
    ] {
        let findings = mesh(text).findings;
        assert!(
            findings.starts_with("RE006 error scene.yaml:1:3 `"),
            "{findings}"
        );
        assert!(
            findings.ends_with("/inner/m.obj` is no OBJ, OFF, STL, PLY or XYZ\n")
                && !findings.contains("secret"),
            "{findings}"
        );
    }
    let findings = mesh("").findings;
    assert!(
        findings.starts_with("RE006 error scene.yaml:1:3 the mesh file `")
            && findings.ends_with("is empty\n")
    );
}

#[test]
fn what_does_not_show_is_told() {
    let outcome = mesh("v 0 0 0\nv 1 0 0\nv 0 1 0\ncurv 0 1 1 2\nf 1 2\nf 1 2 3\n");
    let expected = "RE007 warning m.obj:4:1 2 elements of the file are not drawn: free-form curves and surfaces are not supported\n";
    assert_eq!(
        (
            outcome.findings.as_str(),
            outcome.lowered.scene.meshes[0].triangles.len()
        ),
        (expected, 1)
    );
}

/// Words that mesh files are made of, whole and broken.
fn hostile() -> impl Strategy<Value = String> {
    let word = prop::sample::select(vec![
        "v",
        "vn",
        "vt",
        "f",
        "l",
        "g",
        "usemtl",
        "mtllib",
        "OFF",
        "NOFF",
        "#",
        "\\",
        "\n",
        "\n",
        "\r\n",
        "0",
        "1",
        "2",
        "3",
        "-1",
        "-2",
        "1/1",
        "1//1",
        "1/1/1",
        "-1/-9",
        "/",
        "//",
        "4",
        "1e308",
        "-1e308",
        "inf",
        "1e-320",
        "0x1",
        "18446744073709551615",
        "9223372036854775807",
        "-9223372036854775808",
        "é",
        "\0",
        "surf",
    ]);
    prop::collection::vec(word, 0..60).prop_map(|words| words.join(" "))
}

#[test]
fn a_point_that_is_too_far_away_is_reported_where_it_is() {
    let Outcome {
        lowered, errors, ..
    } = mesh("0 1e308 0 #");
    let positions = list(&lowered.scene.meshes[0].positions);
    assert!(
        positions
            .iter()
            .all(|position| *position == [0.0, 1e308, 0.0])
    );
    assert!(!positions.is_empty() && !errors);
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, cases: 500, ..ProptestConfig::default() })]

    #[test]
    fn any_bytes_are_a_sound_mesh_or_an_error(
        head in prop::sample::select(vec!["", "OFF\n", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"]),
        words in hostile(),
        bytes: Vec<u8>,
        mixed in prop::bool::ANY,
    ) {
        let text = if mixed { [head.as_bytes(), words.as_bytes()].concat() } else { bytes };
        let Outcome { mut lowered, findings: _, errors } = mesh(text);
        let Mesh { positions, normals, uvs, triangles, .. } = lowered.scene.meshes.remove(0);
        prop_assert_eq!(triangles.is_empty(), errors);
        let count = positions.len();
        prop_assert!(triangles.iter().flatten().all(|corner| (*corner as usize) < count));
        prop_assert!([normals.len(), uvs.len()].iter().all(|length| *length == 0 || *length == count));
        prop_assert!(positions.iter().flatten().all(f64::is_finite));
    }
}
