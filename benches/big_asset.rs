//! A large asset: `write FILE [TRIANGLES]` makes a `.glb` of one mesh, a bumpy globe with normals
//! and texture coordinates; `start FILE` loads and proves a scene as `rtc render` does and prints
//! the time of each step in CPU-milliseconds, up to where the hierarchies of its meshes are built.
//! `benches/big-asset.sh` runs both.

#![expect(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a measurement stops at the first surprise and prints what it measured"
)]

use cpu_time::ProcessTime;
use libm::{cos, sin};
use rtc::internals::diag::DiagnosticSink;
use rtc::internals::pipeline::{self, Options};
use rtc::internals::plan::{Plan, RuleSet};
use rtc::internals::render::{Shape, World};
use rtc::internals::source::{Loader, SourceMap};
use std::f64::consts::{PI, TAU};
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;

/// A grid over the globe: `columns` around it, half as many from pole to pole.
struct Grid {
    columns: u32,
    rows: u32,
}

impl Grid {
    /// The grid of about so many triangles.
    fn of(triangles: f64) -> Self {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a count below 2^32"
        )]
        let columns = triangles.sqrt().round() as u32;
        Self {
            columns,
            rows: columns / 2,
        }
    }

    fn vertices(&self) -> u32 {
        (self.columns + 1) * (self.rows + 1)
    }

    fn triangles(&self) -> u32 {
        2 * self.columns * self.rows
    }

    /// The texture coordinates of each vertex.
    fn uvs(&self) -> impl Iterator<Item = [f64; 2]> {
        let (columns, rows) = (self.columns, self.rows);
        let row = move |v: u32| {
            (0..=columns).map(move |u| {
                [
                    f64::from(u) / f64::from(columns),
                    f64::from(v) / f64::from(rows),
                ]
            })
        };
        (0..=rows).flat_map(row)
    }

    fn corners(&self) -> impl Iterator<Item = u32> {
        let (columns, stride) = (self.columns, self.columns + 1);
        let cell = move |row: u32, column: u32| {
            let (a, b) = (row * stride + column, (row + 1) * stride + column);
            [a, b, a + 1, a + 1, b, b + 1]
        };
        (0..self.rows).flat_map(move |row| (0..columns).flat_map(move |column| cell(row, column)))
    }
}

/// The point of the globe at these coordinates; it stays a little short of the poles, so that no
/// triangle is flat.
fn position([u, v]: [f64; 2]) -> [f64; 3] {
    let (across, down) = (TAU * u, PI * (0.001 + 0.998 * v));
    let radius = 1.0 + 0.05 * sin(8.0 * across) * sin(6.0 * down);
    [
        radius * sin(down) * cos(across),
        radius * cos(down),
        radius * sin(down) * sin(across),
    ]
}

/// The unit normal there, by differences.
fn normal(uv: [f64; 2]) -> [f64; 3] {
    const STEP: f64 = 1e-5;
    let along = |axis: usize| {
        let (mut before, mut after) = (uv, uv);
        before[axis] -= STEP;
        after[axis] += STEP;
        let (a, b) = (position(before), position(after));
        [b[0] - a[0], b[1] - a[1], b[2] - a[2]]
    };
    let (s, t) = (along(0), along(1));
    let n = [
        t[1] * s[2] - t[2] * s[1],
        t[2] * s[0] - t[0] * s[2],
        t[0] * s[1] - t[1] * s[0],
    ];
    let length = n.iter().map(|x| x * x).sum::<f64>().sqrt();
    n.map(|x| -x / length)
}

#[expect(clippy::cast_possible_truncation, reason = "glTF has 32-bit floats")]
fn floats(numbers: impl IntoIterator<Item = f64>, bin: &mut Vec<u8>) {
    bin.extend(
        numbers
            .into_iter()
            .flat_map(|number| (number as f32).to_le_bytes()),
    );
}

/// The least and the greatest position, as 32-bit floats.
#[expect(clippy::cast_possible_truncation, reason = "glTF has 32-bit floats")]
fn bounds(grid: &Grid) -> [[f32; 3]; 2] {
    let mut bounds = [[f32::INFINITY; 3], [f32::NEG_INFINITY; 3]];
    for point in grid
        .uvs()
        .map(|uv| position(uv).map(|number| number as f32))
    {
        for axis in 0..3 {
            bounds[0][axis] = bounds[0][axis].min(point[axis]);
            bounds[1][axis] = bounds[1][axis].max(point[axis]);
        }
    }
    bounds
}

fn main() {
    let arguments = std::env::args().skip(1).collect::<Vec<_>>();
    match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["write", path] => write(path, 1e6),
        ["write", path, triangles] => write(path, triangles.parse().unwrap()),
        ["start", path] => start(path),
        _ => panic!("write FILE [TRIANGLES] or start FILE"),
    }
}

/// Prints what stands between a file and the first hierarchy.
fn start(path: &str) {
    let (mut map, mut sink, options) = (
        SourceMap::default(),
        DiagnosticSink::default(),
        Options::default(),
    );
    let begin = ProcessTime::now();
    let file = Loader.file(Path::new(path), &mut map).unwrap();
    let read = begin.elapsed();
    let lowered = pipeline::load(file, &mut map, &options, &mut sink).unwrap();
    let loaded = begin.elapsed();
    let validated = pipeline::validate(&lowered, &options, &mut sink).unwrap();
    let checked = begin.elapsed();
    let plan = Plan::new(&validated, RuleSet::ALL);
    let planned = begin.elapsed();
    let world = World::<Shape>::prepare(&validated, &plan);
    let built = begin.elapsed();
    drop(world);
    let steps = [
        ("read", read),
        ("decode", loaded - read),
        ("prove", checked - loaded),
        ("plan", planned - checked),
    ];
    for (step, time) in steps.into_iter().chain([
        ("all before the build", planned),
        ("build", built - planned),
    ]) {
        println!("{step}: {:.1} ms", 1e3 * time.as_secs_f64());
    }
}

/// Writes a globe of about so many triangles.
fn write(path: &str, triangles: f64) {
    let grid = Grid::of(triangles);
    let mut bin = Vec::new();
    floats(grid.uvs().flat_map(position), &mut bin);
    let normals = bin.len();
    floats(grid.uvs().flat_map(normal), &mut bin);
    let uvs = bin.len();
    floats(grid.uvs().flatten(), &mut bin);
    let indices = bin.len();
    bin.extend(grid.corners().flat_map(u32::to_le_bytes));
    let (vertices, corners, length) = (grid.vertices(), 3 * grid.triangles(), bin.len());
    let [min, max] = bounds(&grid);
    let mut text = format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],
"meshes":[{{"name":"globe","primitives":[{{"attributes":{{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2}},"indices":3}}]}}],
"accessors":[
{{"bufferView":0,"componentType":5126,"count":{vertices},"type":"VEC3","min":{min:?},"max":{max:?}}},
{{"bufferView":1,"componentType":5126,"count":{vertices},"type":"VEC3"}},
{{"bufferView":2,"componentType":5126,"count":{vertices},"type":"VEC2"}},
{{"bufferView":3,"componentType":5125,"count":{corners},"type":"SCALAR"}}],
"bufferViews":[
{{"buffer":0,"byteOffset":0,"byteLength":{normals},"target":34962}},
{{"buffer":0,"byteOffset":{normals},"byteLength":{},"target":34962}},
{{"buffer":0,"byteOffset":{uvs},"byteLength":{},"target":34962}},
{{"buffer":0,"byteOffset":{indices},"byteLength":{},"target":34963}}],
"buffers":[{{"byteLength":{length}}}]}}"#,
        uvs - normals,
        indices - uvs,
        length - indices,
    );
    while !text.len().is_multiple_of(4) {
        text.push(' ');
    }
    write_glb(path, text.as_bytes(), &bin).unwrap();
}

/// The container: a header, the text, the bytes.
fn write_glb(path: &str, text: &[u8], bin: &[u8]) -> std::io::Result<()> {
    let word = |length: usize| u32::try_from(length).unwrap().to_le_bytes();
    #[expect(
        clippy::disallowed_methods,
        reason = "a measurement writes what it measures"
    )]
    let mut file = BufWriter::new(File::create(path)?);
    file.write_all(b"glTF\x02\0\0\0")?;
    file.write_all(&word(12 + 8 + text.len() + 8 + bin.len()))?;
    file.write_all(&word(text.len()))?;
    file.write_all(b"JSON")?;
    file.write_all(text)?;
    file.write_all(&word(bin.len()))?;
    file.write_all(b"BIN\0")?;
    file.write_all(bin)?;
    file.flush()
}
