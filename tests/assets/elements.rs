//! What mesh files hold beside plain faces: notches, strips, points, lines, colours, smoothing
//! groups, and what is left of a file with a fault.

use rtc::internals::front::mesh::{ParsedMesh, parse};
use rtc::internals::ir::{Mesh, VertexColumn};
use rtc::internals::source::Budget;

fn read(bytes: impl AsRef<[u8]>) -> ParsedMesh {
    parse(bytes.as_ref(), &Budget::default()).unwrap()
}

/// What is told of elements that don't show: how many, and why the first does not.
fn told(parsed: &ParsedMesh) -> Option<(usize, &str)> {
    let told = parsed.not_drawn.as_ref();
    told.map(|(fault, count)| (*count, fault.message.as_str()))
}

fn corners(mesh: &Mesh) -> impl Iterator<Item = [[f64; 3]; 3]> + '_ {
    let corner = |corner: u32| mesh.positions.at(corner as usize);
    mesh.triangles.iter().map(move |own| own.map(corner))
}

/// The area of a mesh, along its normals.
fn area(mesh: &Mesh) -> [f64; 3] {
    let mut area = [0.0; 3];
    for [a, b, c] in corners(mesh) {
        for (axis, sum) in area.iter_mut().enumerate() {
            let (k, l) = ((axis + 1) % 3, (axis + 2) % 3);
            *sum += ((b[k] - a[k]) * (c[l] - a[l]) - (b[l] - a[l]) * (c[k] - a[k])) / 2.0;
        }
    }
    area
}

/// The volume of a closed mesh whose triangles face outward.
fn volume(mesh: &Mesh) -> f64 {
    let determinant = |[a, b, c]: [[f64; 3]; 3]| {
        let minor = |k: usize, l: usize| b[k] * c[l] - b[l] * c[k];
        a[0] * minor(1, 2) + a[1] * minor(2, 0) + a[2] * minor(0, 1)
    };
    corners(mesh).map(determinant).sum::<f64>() / 6.0
}

fn list<const N: usize>(column: &VertexColumn<N>) -> Vec<[f64; N]> {
    column.iter().collect()
}

/// Colours with two digits behind the point.
fn shades(mesh: &Mesh) -> Vec<[f64; 4]> {
    let round = |channel: f64| (channel * 100.0).round() / 100.0;
    mesh.colors.iter().map(|color| color.map(round)).collect()
}

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
const RED: [f64; 4] = [1.0, 0.0, 0.0, 1.0];
const GREEN: [f64; 4] = [0.0, 1.0, 0.0, 1.0];
const WHITE: [f64; 4] = [1.0; 4];

#[test]
fn notches_of_polygons_stay_open() {
    let notched = "0 0 0\n2 0 0\n2 2 0\n1 .5 0\n0 2 0\n";
    let obj = format!(
        "v {}f 1 2 3 4 5\n",
        notched.trim_end().replace('\n', "\nv ") + "\n"
    );
    let off = format!("OFF\n5 1 0\n{notched}5 0 1 2 3 4\n");
    let ply = format!(
        "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n\
         element face 1\nproperty list uchar int vertex_indices\nend_header\n{notched}5 0 1 2 3 4\n"
    );
    for text in [obj, off, ply] {
        let mesh = read(&text).mesh;
        let areas: Vec<f64> = corners(&mesh)
            .map(|[a, b, c]| ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2.0)
            .collect();
        assert!(areas.iter().all(|area| *area > 0.0), "{text}: {areas:?}");
        assert_eq!((areas.len(), area(&mesh)[2]), (3, 2.5), "{text}");
    }
}

#[test]
fn a_fault_loses_one_face() {
    let obj = format!("{SQUARE}f 1 2 3\nf 1 2 99\nf 1 2 x\nf 1 3 4\n");
    let parsed = read(obj);
    assert_eq!(parsed.mesh.triangles.len(), 2);
    let expected = "a face refers to vertex 99, but the file has only 4";
    assert_eq!(told(&parsed), Some((2, expected)));
    let off = "OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n3 0 1 2\n";
    let parsed = read(off);
    assert_eq!(*parsed.mesh.triangles, [[0, 1, 2]]);
    let expected = "a face refers to vertex 7, but there are only 3, from 0";
    assert_eq!(told(&parsed), Some((1, expected)));
    let ply = ply(
        "element face 3\nproperty list uchar int vertex_indices\n",
        "3 0 1 2\n3 0 1 9\n3 0 -1 2\n",
    );
    let parsed = read(ply);
    assert_eq!(*parsed.mesh.triangles, [[0, 1, 2]]);
    assert_eq!(told(&parsed).map(|(count, _)| count), Some(2));
    // Where nothing is left, the fault is an error.
    assert!(parse(format!("{SQUARE}f 1 2 99\n").as_bytes(), &Budget::default()).is_err());
}

/// A text of four vertices, the corners of the unit square, and more.
fn ply(head: &str, body: &str) -> String {
    format!(
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n{head}end_header\n\
         0 0 0\n1 0 0\n1 1 0\n0 1 0\n{body}"
    )
}

#[test]
fn a_row_of_a_text_is_a_line() {
    // As VCG writes it: numbers of the corners' colours, which the head does not have.
    let head = "element face 2\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\n\
                property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar alpha\n";
    let long = "9 1 1 1 1 1 1 1 1 1";
    let body = format!("3 0 1 2 6 0 0 1 0 1 1 {long}\n3 0 2 3 6 0 0 1 1 0 1 {long}\n");
    let parsed = read(ply(head, &body));
    assert_eq!(parsed.mesh.triangles.len(), 2);
    let uvs = [
        [0.0, 0.0],
        [1.0, 0.0],
        [1.0, 1.0],
        [0.0, 0.0],
        [1.0, 1.0],
        [0.0, 1.0],
    ];
    assert_eq!(list(&parsed.mesh.uvs), uvs);
    assert!(parsed.mesh.colors.is_empty(), "which number is red is open");
    let (count, why) = told(&parsed).unwrap();
    assert!(
        count == 2 && why.contains("more numbers than properties"),
        "{why}"
    );
    // Fewer lines than rows: the numbers follow each other.
    let head = "element face 2\nproperty list uchar int vertex_indices\n";
    let parsed = read(ply(head, "3 0 1\n2 3 0 2 3"));
    assert_eq!(*parsed.mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(told(&parsed), None);
}

#[test]
fn strips_are_turned_and_begin_anew() {
    let head = "element tristrips 1\nproperty list int int vertex_indices\n";
    let parsed = read(ply(head, "9 0 1 3 2 -1 0 3 1 -1\n"));
    assert_eq!(*parsed.mesh.triangles, [[0, 1, 3], [3, 1, 2], [0, 3, 1]]);
    assert_eq!(told(&parsed), None);
}

/// A binary STL of a tetrahedron, the last two bytes of its triangles as given.
fn stl(head: &str, attributes: [u16; 4]) -> Vec<u8> {
    let corners: [[f32; 3]; 4] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let mut bytes = head.as_bytes().to_vec();
    bytes.resize(80, b' ');
    bytes.extend(4_u32.to_le_bytes());
    for (triangle, attribute) in [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
        .iter()
        .zip(attributes)
    {
        let normal = [0.0_f32; 3];
        let numbers = normal
            .into_iter()
            .chain(triangle.iter().flat_map(|at| corners[*at]));
        bytes.extend(numbers.flat_map(f32::to_le_bytes));
        bytes.extend(attribute.to_le_bytes());
    }
    bytes
}

#[test]
fn colours_of_stl_are_read_in_both_dialects() {
    let plain = stl("a part", [0, 1, 2, 3]);
    assert!(read(&plain).mesh.colors.is_empty(), "bytes of any kind");
    let set = 1 << 15;
    let viscam = stl("VisCAM", [set | 31 << 10, set | 31 << 5, 0, set | 31]);
    let colors = shades(&read(viscam).mesh);
    let grey = [0.7, 0.7, 0.7, 1.0];
    assert_eq!([colors[0], colors[3], colors[6]], [RED, GREEN, grey]);
    assert_eq!((colors[9], colors.len()), ([0.0, 0.0, 1.0, 1.0], 12));
    let head = "COLOR=\u{0}\u{0}\u{0}\u{0}";
    let magics = stl(head, [31, 31 << 5, set, 31 << 10]);
    let colors = shades(&read(magics).mesh);
    assert_eq!([colors[0], colors[3]], [RED, GREEN]);
    assert_eq!(colors[6], [0.0, 0.0, 0.0, 1.0], "the colour of the whole");
}

#[test]
fn stl_may_be_longer_than_it_says_or_shout() {
    let mut long = stl("", [0; 4]);
    long.extend(b"7 more ");
    let mesh = read(long).mesh;
    assert_eq!((mesh.triangles.len(), volume(&mesh)), (4, 1.0 / 6.0));
    let text = "SOLID A\nFACET NORMAL 0 0 1\nOUTER LOOP\nVERTEX 0 0 0\nVERTEX 1 0 0\nVERTEX 0 1 0\n\
                ENDLOOP\nENDFACET\nENDSOLID A\n";
    assert_eq!(area(&read(text).mesh), [0.0, 0.0, 0.5]);
}

#[test]
fn colours_of_vertices_are_read() {
    let obj = "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0\nf 1 2 3\n";
    assert_eq!(shades(&read(obj).mesh), [RED, GREEN, WHITE]);
    let bytes =
        "v 0 0 0 255 0 0\nv 1 0 0 0 255 0\nv 0 1 0 255 255 255\nvn 0 0 1\nf 1//1 2//1 3//1\n";
    assert_eq!(shades(&read(bytes).mesh), [RED, GREEN, WHITE]);
    let off = "COFF\n3 1 0\n0 0 0 1.0 0.0 0.0 1.0\n1 0 0 0 1 0 1\n0 1 0 1 1 1 1\n3 0 1 2\n";
    assert_eq!(shades(&read(off).mesh), [RED, GREEN, WHITE]);
    // A half as sRGB codes it.
    let half = read("v 0 0 0 .5 .5 .5\nv 1 0 0 .5 .5 .5\nv 0 1 0 .5 .5 .5\nf 1 2 3\n");
    assert_eq!(shades(&half.mesh)[0], [0.21, 0.21, 0.21, 1.0]);
}

#[test]
fn colours_of_faces_are_read() {
    let head = "element face 2\nproperty list uchar int vertex_indices\nproperty uchar red\nproperty uchar green\n\
                property uchar blue\n";
    let mesh = read(ply(head, "3 0 1 2 255 0 0\n3 0 2 3 0 255 0\n")).mesh;
    assert_eq!(shades(&mesh), [RED, RED, RED, GREEN, GREEN, GREEN]);
    assert_eq!(area(&mesh), [0.0, 0.0, 1.0]);
    let off = "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2 255 0 0\n3 0 2 3\n";
    let mesh = read(off).mesh;
    assert_eq!(shades(&mesh), [RED, RED, RED, WHITE, WHITE, WHITE]);
}

#[test]
fn the_picture_of_a_ply_is_named() {
    let head = "comment TextureFile the picture.png\nelement face 1\nproperty list uchar int vertex_indices\n";
    let parsed = read(ply(head, "4 0 1 2 3\n"));
    assert_eq!(
        parsed.texture.map(|named| named.text).as_deref(),
        Some("the picture.png")
    );
}

#[test]
fn smoothing_groups_give_normals() {
    let octahedron = "v 1 0 0\nv -1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nv 0 0 -1\n";
    let faces = "f 1 3 5\nf 3 2 5\nf 2 4 5\nf 4 1 5\nf 3 1 6\nf 2 3 6\nf 4 2 6\nf 1 4 6\n";
    let smooth = read(format!("{octahedron}s 1\n{faces}")).mesh;
    assert_eq!(smooth.positions.len(), 6);
    for (position, normal) in smooth.positions.iter().zip(smooth.normals.iter()) {
        let apart = position.iter().zip(normal).map(|(a, b)| (a - b).abs());
        assert!(apart.fold(0.0, f64::max) < 1e-12, "{position:?} {normal:?}");
    }
    for flat in ["", "s off\n", "s 0\n"] {
        let mesh = read(format!("{octahedron}{flat}{faces}")).mesh;
        assert!(mesh.normals.is_empty(), "{flat}");
    }
    // Of two groups that meet each has its own, and what has normals keeps them.
    let edge = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvn 0 0 -1\n";
    let two = read(format!(
        "{edge}s 1\nf 1 3 2\ns 2\nf 1 2 4\ns 3\nf 1//1 3//1 4//1\n"
    ))
    .mesh;
    let normals = list(&two.normals);
    assert_eq!(&normals[..3], [[0.0, 0.0, -1.0]; 3]);
    assert_eq!(&normals[3..6], [[0.0, -1.0, 0.0]; 3]);
    assert!(
        normals[6..]
            .iter()
            .all(|normal| *normal == [0.0, 0.0, -1.0])
    );
}

/// So many triangles has a point, and a line, without a normal.
const POINT: usize = 8;
const LINE: usize = 8;

#[test]
fn points_and_lines_are_drawn() {
    let counted = |text: &str| read(text).mesh.triangles.len();
    assert_eq!(counted(&format!("{SQUARE}l 1 2 3 4 1\n")), 4 * LINE);
    assert_eq!(
        counted(&format!("{SQUARE}p 1 2\nl 1 2\n")),
        2 * POINT + LINE
    );
    assert_eq!(counted(SQUARE), 4 * POINT, "nothing but vertices");
    assert_eq!(counted(&format!("{SQUARE}f 1 2 3\nl 1 3\n")), 1 + LINE);
    assert_eq!(
        counted("OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n2 0 1\n1 2\n"),
        LINE + POINT
    );
    assert_eq!(counted("OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n"), 3 * POINT);
    let edges = "element edge 2\nproperty int vertex1\nproperty int vertex2\n";
    assert_eq!(counted(&ply(edges, "0 1\n1 2\n")), 2 * LINE);
    assert_eq!(
        counted(&ply(
            "element face 0\nproperty list uchar int vertex_indices\n",
            ""
        )),
        4 * POINT
    );
    assert_eq!(counted("0 0 0\n1 0 0\n0 1 0\n"), 3 * POINT);
}

#[test]
fn points_have_their_colours_and_normals() {
    let colored = read("0 0 0 255 0 0\n1 0 0 0 255 0\n").mesh;
    let colors = shades(&colored);
    assert_eq!([colors[0], colors[colors.len() - 1]], [RED, GREEN]);
    // A disc of four triangles faces the normal.
    let turned = read("0 0 0 0 0 1\n1 0 0 0 0 1\n").mesh;
    assert_eq!(turned.triangles.len(), 8);
    let [x, y, z] = area(&turned);
    assert!(z > 0.0 && x.abs() + y.abs() < 1e-6 * z, "{x} {y} {z}");
    let both = read("0 0 0 255 0 0 0 0 1\n1 0 0 0 255 0 0 0 1\n").mesh;
    assert!(both.colors.len() == both.normals.len() && both.triangles.len() == 8);
}

#[test]
fn lines_have_the_material_that_they_ask_for() {
    let text =
        format!("mtllib m.mtl\n{SQUARE}usemtl a\nf 1 2 3\nusemtl b\nl 1 2\nusemtl a\nl 2 3\n");
    let parsed = read(text);
    let names: Vec<_> = parsed
        .material_use
        .materials
        .iter()
        .map(|own| own.text.as_str())
        .collect();
    assert_eq!(names, ["a", "b"]);
    let parts = parsed.material_use.parts(parsed.mesh.triangles.len());
    let counts: Vec<usize> = parts
        .iter()
        .map(|own| own.iter().map(ExactSizeIterator::len).sum())
        .collect();
    assert_eq!(counts, [1 + LINE, LINE]);
}
