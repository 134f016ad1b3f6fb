//! Our reader of OBJ says what `tobj` does, of the files of the repo and of meshes that are made
//! up.

use crate::obj_oracle::{Agreement, compared};
use crate::repo::{files, root};
use proptest::prelude::*;
use std::fmt::Write as _;

#[test]
fn files_of_the_repo_are_read_alike() {
    let mut same = 0;
    for folder in ["scenes", "tests", "fuzz/corpus/mesh"] {
        for path in files(&root(folder), &["obj"]) {
            let bytes = std::fs::read(&path).unwrap();
            let agreement = compared(&bytes);
            same += usize::from(matches!(agreement, Agreement::Same | Agreement::SameArea));
        }
    }
    assert!(same >= 10, "only {same} are read by both");
}

/// A mesh: vertices, texture coordinates, normals, and faces of three corners up to `most`, all in
/// one of the forms of a corner, counted from the start or from the end.
fn meshes(most: usize) -> impl Strategy<Value = String> {
    let row = |size| prop::collection::vec(-1000.0..1000.0, size);
    let list = move |size| prop::collection::vec(row(size), 3..12);
    let corner = (0_usize..12, 0_usize..12, 0_usize..12);
    let face = (prop::collection::vec(corner, 3..=most), prop::bool::ANY);
    let faces = prop::collection::vec(face, 1..12);
    (list(3), list(2), list(3), faces, 0_usize..4).prop_map(
        |(positions, uvs, normals, faces, form)| {
            let mut text = String::from("o made up\n");
            for (word, rows) in [("v", &positions), ("vt", &uvs), ("vn", &normals)] {
                for row in rows {
                    let numbers: Vec<String> = row.iter().map(f64::to_string).collect();
                    writeln!(text, "{word} {}", numbers.join(" ")).unwrap();
                }
            }
            for (corners, from_end) in faces {
                text.push('f');
                for (v, vt, vn) in corners {
                    let index = |at: usize, rows: &[Vec<f64>]| match from_end {
                        true => format!("-{}", rows.len() - at % rows.len()),
                        false => format!("{}", at % rows.len() + 1),
                    };
                    let v = index(v, &positions);
                    let [vt, vn] = [index(vt, &uvs), index(vn, &normals)];
                    let corner = match form {
                        0 => v,
                        1 => format!("{v}/{vt}"),
                        2 => format!("{v}//{vn}"),
                        _ => format!("{v}/{vt}/{vn}"),
                    };
                    write!(text, " {corner}").unwrap();
                }
                text.push('\n');
            }
            text
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, cases: 300, ..ProptestConfig::default() })]

    #[test]
    fn triangles_that_are_made_up_are_read_alike(text in meshes(3)) {
        prop_assert_eq!(compared(text.as_bytes()), Agreement::Same, "{}", text);
    }

    #[test]
    fn polygons_that_are_made_up_cover_the_same(text in meshes(6)) {
        let agreement = compared(text.as_bytes());
        prop_assert!(matches!(agreement, Agreement::Same | Agreement::SameArea), "{}", text);
    }
}
