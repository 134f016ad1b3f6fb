//! The reader of OBJ beside `tobj`: of a file that both read they say the same, corner by corner.

use rtc::internals::front::mesh;
use rtc::internals::ir::Mesh;
use rtc::internals::source::Budget;

/// The corner of a triangle: where it is, and its texture coordinates and normal if there are any.
type Corner = (Vec<f64>, Vec<f64>, Vec<f64>);

/// What became of a file.
#[derive(Debug, PartialEq, Eq)]
pub(crate) enum Agreement {
    /// Both read it, and say the same.
    Same,
    /// Both read it, and cut polygons in other ways, into triangles of the same area.
    SameArea,
    /// `tobj` alone refuses it.
    OursAlone,
    /// Both refuse it, or there are no triangles.
    Neither,
}

/// Compares both readers.
///
/// # Panics
/// If `tobj` reads what we refuse, or both say different things.
pub(crate) fn compared(bytes: &[u8]) -> Agreement {
    let options = tobj::LoadOptions {
        triangulate: true,
        ignore_points: true,
        ignore_lines: true,
        ..tobj::LoadOptions::default()
    };
    let none = |_: &std::path::Path| Ok(Default::default());
    // Lines of several corners are polygons to it.
    let lines = bytes.split(|byte| *byte == b'\n');
    let faces = lines.filter(|line| !line.starts_with(b"l ") && !line.starts_with(b"p "));
    let faces = faces.collect::<Vec<_>>().join(&b'\n');
    let theirs = tobj::load_obj_buf(&mut &*faces, &options, none);
    let ours = mesh::parse(bytes, &Budget::default());
    match (theirs, ours) {
        (Ok((models, _)), ours) if !models.is_empty() => {
            let ours = ours.expect("`tobj` reads it").mesh;
            let theirs: Vec<_> = models
                .iter()
                .flat_map(|model| triangles(&model.mesh))
                .collect();
            are_same(&ours, &theirs)
        }
        (Err(_), Ok(_)) => Agreement::OursAlone,
        (Ok(_) | Err(_), _) => Agreement::Neither,
    }
}

/// The triangles of a model; a flat list of what each corner says.
fn triangles(mesh: &tobj::Mesh) -> Vec<[Corner; 3]> {
    let pick = |from: &[f32], indices: &[u32], at: usize, size: usize| -> Vec<f64> {
        let Some(index) = indices.get(at) else {
            return Vec::new();
        };
        let first = *index as usize * size;
        from[first..first + size]
            .iter()
            .map(|number| f64::from(*number))
            .collect()
    };
    let corner = |at: usize| {
        (
            pick(&mesh.positions, &mesh.indices, at, 3),
            pick(&mesh.texcoords, &mesh.texcoord_indices, at, 2),
            pick(&mesh.normals, &mesh.normal_indices, at, 3),
        )
    };
    (0..mesh.indices.len() / 3)
        .map(|at| [0, 1, 2].map(|own| corner(3 * at + own)))
        .collect()
}

/// Asserts that a mesh begins with these triangles; lines and points come after them.
fn are_same(ours: &Mesh, theirs: &[[Corner; 3]]) -> Agreement {
    assert!(
        ours.triangles.len() >= theirs.len(),
        "{} triangles",
        ours.triangles.len()
    );
    let mut areas = [[0.0; 3]; 2];
    let mut are_equal = true;
    for (own, other) in ours.triangles.iter().zip(theirs) {
        let corners = own.map(|corner| ours.positions.at(corner as usize));
        add(&mut areas[0], corners);
        add(
            &mut areas[1],
            [0, 1, 2].map(|at| [0, 1, 2].map(|axis| other[at].0[axis])),
        );
        are_equal &= own
            .iter()
            .zip(other)
            .all(|(corner, (position, uv, normal))| {
                let at = *corner as usize;
                let (uvs, normals) = (&ours.uvs, &ours.normals);
                are_near(&ours.positions.at(at), position)
                    && (uv.is_empty() || uvs.is_empty() || are_near(&uvs.at(at), uv))
                    && (normal.is_empty()
                        || normals.is_empty()
                        || are_near(&normals.at(at), normal))
            });
    }
    // A polygon with a notch is cut in another way: its area as a vector is the same.
    let largest = areas
        .iter()
        .flatten()
        .fold(1.0, |most: f64, area| most.max(area.abs()));
    let count = theirs.len() as f64;
    let is_close = |axis: usize| (areas[0][axis] - areas[1][axis]).abs() <= 1e-5 * count * largest;
    assert!(are_equal || (0..3).all(is_close), "{areas:?}");
    match are_equal {
        true => Agreement::Same,
        false => Agreement::SameArea,
    }
}

/// Adds the area of a triangle, along its normal.
fn add(area: &mut [f64; 3], [a, b, c]: [[f64; 3]; 3]) {
    for (axis, sum) in area.iter_mut().enumerate() {
        let (k, l) = ((axis + 1) % 3, (axis + 2) % 3);
        *sum += ((b[k] - a[k]) * (c[l] - a[l]) - (b[l] - a[l]) * (c[k] - a[k])) / 2.0;
    }
}

/// Whether numbers differ by no more than the rounding to 32 bits.
fn are_near(ours: &[f64], theirs: &[f64]) -> bool {
    ours.iter()
        .zip(theirs)
        .all(|(own, other)| (own - other).abs() <= 1e-6 * (1.0 + own.abs()))
}
