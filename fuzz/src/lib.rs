//! Scenes with the files that they name, from one input: what the targets `folder`, `mesh`, `image`
//! and others do with it, and their replay in `tests/cases/corpora.rs`. The files lie in a
//! temporary folder, and nothing is read or written outside.

use rtc::internals::pipeline::trial;
use std::fs;
use std::path::{Component, Path, PathBuf};
use tempfile::TempDir;

/// What begins the line of a name.
const MARK: &[u8] = b"== ";

/// No more files than these are written.
const MAX_FILES: usize = 8;

/// Shows a mesh, in any format.
const MESH: &[u8] = b"
Camera: {eye: [3, 2, 4], center: [0, 0, 0], up: [0, 1, 0], fov: 40, viewSize: [8, 8]}
Shadows: true
Lights:
- {position: [5, 5, 5], color: [1, 1, 1]}
Objects:
- {type: mesh, file: m.obj, material: {texture: UV, ka: 0.1, kd: 0.5, ks: 0.2, n: 8}}
== m.obj
";

/// Shows a picture on a sphere, in PNG, JPEG or WebP.
const TEXTURE: &[u8] = b"
Camera: {eye: [0, 0, 4], center: [0, 0, 0], up: [0, 1, 0], fov: 40, viewSize: [8, 8]}
Lights:
- {position: [5, 5, 5], color: [1, 1, 1]}
Objects:
- {type: sphere, position: [0, 0, 0], radius: 1, material: {texture: p.png, bump: p.png, ka: 0.1, kd: 0.5, ks: 0, n: 1}}
== p.png
";

/// Shows a picture of surroundings, in HDR or EXR.
const ENVIRONMENT: &[u8] = b"
Camera: {eye: [0, 0, 4], center: [0, 0, 0], up: [0, 1, 0], fov: 40, viewSize: [8, 8]}
Environment: {file: e.hdr}
Objects:
- {type: sphere, position: [0, 0, 0], radius: 1, material: {color: [1, 1, 1], ka: 0, kd: 1, ks: 0, n: 1}}
== e.hdr
";

/// Shows a lamp with a profile.
const LAMP: &[u8] = b"
Camera: {eye: [0, 0, 4], center: [0, 0, 0], up: [0, 1, 0], fov: 40, viewSize: [8, 8]}
Lights:
- {type: ies, position: [0, 3, 0], direction: [0, -1, 0], file: l.ies}
Objects:
- {type: sphere, position: [0, 0, 0], radius: 1, material: {color: [1, 1, 1], ka: 0, kd: 1, ks: 0, n: 1}}
== l.ies
";

/// Shows a mesh in the materials of another file.
const MATERIALS: &[u8] = b"
Camera: {eye: [0, 0, 4], center: [0, 0, 0], up: [0, 1, 0], fov: 40, viewSize: [8, 8]}
Lights:
- {position: [5, 5, 5], color: [1, 1, 1]}
Objects:
- {type: mesh, file: m.obj, materials: mtl}
== m.obj
mtllib m.mtl
v 0 0 0
v 1 0 0
v 0 1 0
v 1 1 0
vt 0 0
vt 1 0
vt 0 1
usemtl a
f 1/1 2/2 3/3
usemtl b
f 2/1 4/2 3/3
== m.mtl
";

/// A scene and what it names. A line `== NAME` begins the file NAME, which goes on to the next such
/// line; what stands before the first one is `scene.yaml`. The first file is the scene. `../NAME`
/// lies in the folder above; a name that leads anywhere else is left out.
pub fn folder(input: &[u8]) {
    let temporary = TempDir::new().expect("there is room for a folder");
    let mut scene = None;
    for (name, bytes) in files(input).into_iter().take(MAX_FILES) {
        if let Some(path) = place(temporary.path(), name) {
            // The system does not take every name.
            let _ = fs::create_dir_all(path.parent().expect("it lies in a folder"))
                .and_then(|()| fs::write(&path, bytes));
            scene.get_or_insert(path);
        }
    }
    if let Some(path) = scene {
        trial::file(&path);
    }
}

/// A mesh file.
pub fn mesh(input: &[u8]) {
    folder(&[MESH, input].concat());
}

/// A picture file.
pub fn image(input: &[u8]) {
    let is_light = input.starts_with(b"#?") || input.starts_with(b"\x76\x2f\x31\x01");
    folder(&[if is_light { ENVIRONMENT } else { TEXTURE }, input].concat());
}

/// A photometric file of a lamp.
pub fn ies(input: &[u8]) {
    folder(&[LAMP, input].concat());
}

/// A file of materials.
pub fn mtl(input: &[u8]) {
    folder(&[MATERIALS, input].concat());
}

/// A PLY file, of which `ply` may be left out.
pub fn ply(input: &[u8]) {
    begun(b"ply\n", input);
}

/// An STL file; one that begins as no text is binary.
pub fn stl(input: &[u8]) {
    let name = [&MESH[..MESH.len() - b"m.obj\n".len()], b"m.stl\n"].concat();
    let name = String::from_utf8_lossy(&name).replace("file: m.obj", "file: m.stl");
    folder(&[name.as_bytes(), input].concat());
}

/// A mesh file that begins so, whatever its input begins with.
fn begun(start: &[u8], input: &[u8]) {
    let rest = input.strip_prefix(start).unwrap_or(input);
    mesh(&[start, rest].concat());
}

/// A scene of pbrt; what it names may follow behind lines `== NAME`.
pub fn pbrt(input: &[u8]) {
    folder(&[b"== scene.pbrt\n", input].concat());
}

/// A scene of Mitsuba; what it names may follow behind lines `== NAME`.
pub fn mitsuba(input: &[u8]) {
    folder(&[b"== scene.xml\n", input].concat());
}

/// A stage of USD; what it names may follow behind lines `== NAME`.
pub fn usd(input: &[u8]) {
    folder(&[b"== scene.usd\n", input].concat());
}

/// The names and the bytes of all files.
fn files(input: &[u8]) -> Vec<(&[u8], &[u8])> {
    let (mut files, mut name, mut start, mut at) = (Vec::new(), &b"scene.yaml"[..], 0, 0);
    while at < input.len() {
        let end = input[at..]
            .iter()
            .position(|byte| *byte == b'\n')
            .map_or(input.len(), |length| at + length);
        if let Some(next) = input[at..end].strip_prefix(MARK) {
            if at > 0 {
                // The line end before a mark belongs to the mark.
                files.push((name, &input[start.min(at - 1)..at - 1]));
            }
            (name, start) = (next, (end + 1).min(input.len()));
        }
        at = end + 1;
    }
    files.push((name, &input[start..]));
    files
}

/// Where the file of a name goes, if it goes anywhere.
fn place(temporary: &Path, name: &[u8]) -> Option<PathBuf> {
    let name = std::str::from_utf8(name).ok()?;
    let (folder, below) = match name.strip_prefix("../") {
        Some(below) => (temporary.to_owned(), below),
        None => (temporary.join("scene"), name),
    };
    let mut parts = Path::new(below).components().peekable();
    parts.peek()?;
    parts
        .all(|part| matches!(part, Component::Normal(_)))
        .then(|| folder.join(below))
}
