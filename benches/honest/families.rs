//! The families of scenes: ordinary scenes, patterns as fine as pixels, and light that few samples
//! hit.

use super::patterns::{Pattern, grains, grid, quad};
use super::scenes::{lowered, scene};
use rtc::internals::codec::{self, Encoding};
use rtc::internals::diag::DiagnosticSink;
use rtc::internals::ir::Scene;
use rtc::internals::math::{cos, sin};
use rtc::internals::source::SourceMap;

/// Scenes of one kind, and their target error in grey levels.
pub(crate) struct Family {
    pub(crate) name: &'static str,
    pub(crate) target: f64,
    pub(crate) cases: Vec<Case>,
}

/// A scene with a name.
pub(crate) struct Case {
    pub(crate) name: String,
    pub(crate) reference: Truth,
}

/// The reference of a scene.
pub(crate) enum Truth {
    Known(Box<Pattern>),
    /// Two references with a quarter of the error.
    Rendered(Box<Scene>),
}

impl Case {
    fn known(name: String, pattern: Pattern) -> Self {
        let reference = Truth::Known(Box::new(pattern));
        Self { name, reference }
    }

    fn rendered(name: String, scene: Scene) -> Self {
        let reference = Truth::Rendered(Box::new(scene));
        Self { name, reference }
    }

    pub(crate) fn scene(&self) -> &Scene {
        match &self.reference {
            Truth::Known(pattern) => &pattern.scene,
            Truth::Rendered(scene) => scene,
        }
    }
}

pub(crate) fn all() -> Vec<Family> {
    let family = |name, target, cases| Family {
        name,
        target,
        cases,
    };
    vec![
        family("ordinary", 3.0, ordinary()),
        family("grids", 2.0, grids()),
        family("wires", 3.0, wires()),
        family("dust", 3.0, dust()),
        family("checkers", 4.0, checkers()),
        family("rare-light", 1.0, rare()),
        family("caustics", 8.0, caustics()),
        family("lamps-through-rough-glass", 8.0, lamps()),
        family("small-emitters", 4.0, small_emitters()),
        family("estimated-caustics", 8.0, estimated_caustics()),
        family("near-specular", 4.0, near_specular()),
        family("foliage-masks", 4.0, foliage()),
        family("fine-textures", 3.0, fine_textures()),
    ]
}

fn ordinary() -> Vec<Case> {
    let numbers = [1, 5, 10, 16, 19, 22, 26, 31];
    let case = |number| Case::rendered(format!("scene {number}"), scene(number, [40, 40]));
    numbers.into_iter().map(case).collect()
}

fn grids() -> Vec<Case> {
    let widths = [
        (0.03, 0.1),
        (0.05, 0.0),
        (0.11, 0.13),
        (0.2, 0.3),
        (0.34, 0.21),
        (0.5, 0.25),
        (0.77, 0.1),
        (0.95, 0.0),
    ];
    let case = |(width, offset)| Case::known(format!("width {width}"), grid(60, width, offset));
    widths.into_iter().map(case).collect()
}

/// Straight wires thinner than a pixel, at an angle.
fn wires() -> Vec<Case> {
    let wires = [
        (0.02, 1.5, [0.6, 0.8]),
        (0.07, 2.2, [0.8, 0.6]),
        (0.12, 2.9, [5.0 / 13.0, 12.0 / 13.0]),
        (0.17, 3.6, [15.0 / 17.0, 8.0 / 17.0]),
        (0.05, 7.3, [12.0 / 13.0, 5.0 / 13.0]),
        (0.3, 5.0, [24.0 / 25.0, 7.0 / 25.0]),
    ];
    let case = |(width, pitch, normal)| {
        let pattern = wire(40, width, pitch, normal);
        Case::known(format!("width {width}, {pitch} apart"), pattern)
    };
    wires.into_iter().map(case).collect()
}

/// Wires with a width, a pitch and a unit normal.
fn wire(side: u32, width: f64, pitch: f64, [a, b]: [f64; 2]) -> Pattern {
    /// The points per side of a pixel for counting its coverage.
    const POINTS: u32 = 256;
    let (mut text, half) = (String::new(), f64::from(side) / 2.0);
    let count = (1.5 * half / pitch) as i32 + 1;
    for k in -count..=count {
        let from = f64::from(k) * pitch;
        let corner = [a * from + b * 2.0 * half, b * from - a * 2.0 * half];
        let along = [-b * 4.0 * half, a * 4.0 * half];
        quad(&mut text, corner, [a * width, b * width], along);
    }
    let is_white = |x: f64, y: f64| (a * x + b * y).rem_euclid(pitch) < width;
    Pattern::new(side, &text, |x, y| {
        let place = |k: u32| (f64::from(k) + 0.5) / f64::from(POINTS);
        let points = (0..POINTS * POINTS).map(|k| [place(k % POINTS), place(k / POINTS)]);
        let white =
            points.filter(|[u, v]| is_white(f64::from(x) + u - half, half - f64::from(y) - v));
        white.count() as f64 / f64::from(POINTS * POINTS)
    })
}

/// Discs smaller than a pixel, each within one.
fn dust() -> Vec<Case> {
    let dust = [
        (0.06, 0.1),
        (0.1, 0.25),
        (0.15, 0.4),
        (0.2, 0.55),
        (0.25, 0.7),
        (0.3, 0.85),
    ];
    let case = |(radius, share)| {
        let name = format!("radius {radius} in {share} of the pixels");
        Case::known(name, grains(40, radius, share))
    };
    dust.into_iter().map(case).collect()
}

/// Few and tiny discs: a picture with few samples misses most of them.
fn rare() -> Vec<Case> {
    let rare = [(0.03, 0.2), (0.05, 0.05), (0.1, 0.02), (0.2, 0.01)];
    let case = |(radius, share)| {
        let name = format!("radius {radius} in {share} of the pixels");
        Case::known(name, grains(40, radius, share))
    };
    rare.into_iter().map(case).collect()
}

/// Checkers with squares of about a pixel.
fn checkers() -> Vec<Case> {
    let squares = [
        (1.0, [0.5, 0.5]),
        (1.0, [0.25, 0.4]),
        (1.01, [0.0, 0.0]),
        (0.99, [0.0, 0.0]),
        (1.5, [0.3, 0.2]),
        (2.0, [0.5, 0.35]),
    ];
    let case = |(square, shift)| {
        let name = format!("squares of {square} from {shift:?}");
        Case::known(name, checker(40, square, shift))
    };
    squares.into_iter().map(case).collect()
}

/// A checker with squares of a side, one corner shifted off the middle.
fn checker(side: u32, square: f64, shift: [f64; 2]) -> Pattern {
    let (mut text, half) = (String::new(), f64::from(side) / 2.0);
    let count = (half / square) as i32 + 3;
    for (i, j) in (-count..count).flat_map(|j| (-count..count).map(move |i| (i, j))) {
        if (i + j) % 2 == 0 {
            let corner = [(i, shift[0]), (j, shift[1])]
                .map(|(k, shift): (i32, f64)| f64::from(k) * square + shift);
            quad(&mut text, corner, [square, 0.0], [0.0, square]);
        }
    }
    // The integral of the square wave +1, −1, … from 0 on.
    let wave = |x: f64| {
        let phase = x.rem_euclid(2.0 * square);
        phase.min(2.0 * square - phase)
    };
    let mean = |from: f64| wave(from + 1.0) - wave(from);
    Pattern::new(side, &text, |x, y| {
        let left = f64::from(x) - half - shift[0];
        let low = half - f64::from(y) - 1.0 - shift[1];
        0.5 + 0.5 * mean(left) * mean(low)
    })
}

/// Path tracing: two spheres of plastic or metal under an emissive disc, large or small.
fn caustics() -> Vec<Case> {
    let caustics = [
        (0.5, 2.0, 1.0),
        (0.2, 2.0, 1.0),
        (0.1, 1.0, 4.0),
        (0.3, 0.5, 12.0),
    ];
    let case = |(roughness, radius, light)| {
        let name = format!("roughness {roughness}, a light of radius {radius}");
        Case::rendered(name, balls(roughness, radius, light))
    };
    caustics.into_iter().map(case).collect()
}

fn balls(roughness: f64, radius: f64, light: f64) -> Scene {
    let text = include_str!("../../tests/honest/paths.json");
    let metal = format!("\"metallic\": 1, \"roughness\": {roughness}");
    let text = text
        .replace("\"metallic\": 0, \"roughness\": 0.5", &metal)
        .replace("\"radius\": 2}", &format!("\"radius\": {radius}}}"))
        .replace(
            "[1.6, 1.4, 1.2]",
            &format!("[{}, {}, {}]", 1.6 * light, 1.4 * light, 1.2 * light),
        );
    let (mut map, mut sink) = (SourceMap::default(), DiagnosticSink::default());
    let file = map.add("paths.json", text.into_bytes());
    codec::decode(Encoding::Json, file, &map, &mut sink)
        .unwrap_or_else(|| panic!("{:?}", sink.kept()))
}

/// Path tracing: a room with a sphere of rough glass under a punctual light, which paths from the
/// walls find through the glass only by chance.
fn lamps() -> Vec<Case> {
    let spot = "type: spot, direction: [0, -1, 0], outerAngle: 0.3, innerAngle: 0.1";
    let lamps = [
        (0.1, "type: point"),
        (0.2, "type: point"),
        (0.35, "type: point"),
        (0.1, spot),
        (0.3, spot),
    ];
    let case = |(roughness, lamp): (f64, &str)| {
        let kind = lamp.split(',').next().unwrap_or(lamp);
        let name = format!("roughness {roughness}, {kind}");
        Case::rendered(name, room(roughness, lamp))
    };
    lamps.into_iter().map(case).collect()
}

/// Five white walls around the sphere.
fn room(roughness: f64, lamp: &str) -> Scene {
    let wall = |corner: &str, up: &str, side: &str| {
        format!(
            "- {{type: quad, position: {corner}, up: {up}, side: {side}, material: {{type: \
             standard, \
             baseColor: [0.8, 0.8, 0.8, 1], metallic: 0, roughness: 1, specular: 0, doubleSided: \
             true}}}}\n"
        )
    };
    let (low, x, y, z) = ("[-2, -2, -2]", "[4, 0, 0]", "[0, 4, 0]", "[0, 0, 4]");
    let walls = [
        wall(low, z, x),
        wall("[-2, 2, -2]", z, x),
        wall(low, y, x),
        wall(low, y, z),
        wall("[2, -2, -2]", y, z),
    ];
    let text = format!(
        "Camera: {{eye: [0, 0, 8], center: [0, 0, 0], up: [0, 0.1833, 0], viewSize: [24, 24]}}\n\
         RenderMode: path\nMaxRecursionDepth: 5\n\
         Lights: [{{{lamp}, position: [0, 1.7, 0], intensity: 2}}]\n\
         Objects:\n{}\
         - {{type: sphere, position: [0, -1, 0], radius: 0.7, material: {{type: standard, \
         transmission: 1, \
         metallic: 0, roughness: {roughness}, thickness: 1}}}}\n",
        walls.concat()
    );
    lowered("room", text)
}

/// Path tracing: a floor, seen from above its middle, with more objects.
fn stage(name: &str, settings: &str, floor: &str, objects: &[String]) -> Scene {
    let text = format!(
        "Camera: {{eye: [0, 3, 7], center: [0, 0.6, 0], up: [0, 1, 0], fov: 35, viewSize: [24, 24]}}\n\
         Environment: {{color: 0.05}}\n\
         RenderMode: path\nMaxRecursionDepth: 6\n\
         PathParameters: {{samples: 16{settings}}}\n\
         Objects:\n\
         - {{type: quad, v0: [-6, 0, -6], v1: [-6, 0, 6], v2: [6, 0, 6], v3: [6, 0, -6], material: \
         {{type: standard, {floor}, metallic: 0, roughness: 1, specular: 0, doubleSided: true}}}}\n\
         {}",
        objects.concat()
    );
    lowered(name, text)
}

/// A white floor.
const WHITE: &str = "baseColor: [0.8, 0.8, 0.8, 1]";

fn object(shape: &str, material: &str) -> String {
    format!("- {{{shape}, material: {{type: standard, {material}}}}}\n")
}

/// A lamp of the same power for each radius.
fn lamp(radius: f64) -> String {
    let emissive = 3.0 / (radius * radius);
    object(
        &format!("type: sphere, position: [1.5, 4, 0], radius: {radius}"),
        &format!(
            "baseColor: [0, 0, 0, 1], metallic: 0, specular: 0, emissive: [{emissive}, {emissive}, \
             {emissive}]"
        ),
    )
}

const BALL: &str = "type: sphere, position: [0, 1, 0], radius: 1";

fn small_emitters() -> Vec<Case> {
    let case = |radius: f64| {
        let plastic = object(
            BALL,
            "baseColor: [0.8, 0.3, 0.2, 1], metallic: 0, roughness: 0.5",
        );
        let scene = stage("small", "", WHITE, &[plastic, lamp(radius)]);
        Case::rendered(format!("a lamp of radius {radius}"), scene)
    };
    [0.3, 0.03, 0.003, 0.0003].map(case).into()
}

fn estimated_caustics() -> Vec<Case> {
    let glass = "transmission: 1, thickness: 1, roughness: 0, metallic: 0, ior: 1.5";
    let ring = "type: torus, position: [0, 0.2, 0], normal: [0, 1, 0], majorRadius: 1.2, \
                minorRadius: 0.2";
    let casters = [
        ("ball", BALL, glass),
        (
            "lens",
            "type: ellipsoid, position: [0, 2, 0], radius: [1, 0.3, 1]",
            glass,
        ),
        ("ring", ring, "metallic: 1, roughness: 0"),
    ];
    let case = |(name, shape, material): (&str, &str, &str)| {
        let objects = [object(shape, material), lamp(0.05)];
        let scene = stage(name, ", caustics: true", WHITE, &objects);
        Case::rendered(name.to_owned(), scene)
    };
    casters.map(case).into()
}

fn near_specular() -> Vec<Case> {
    let case = |roughness: f64| {
        let material = format!("metallic: 1, roughness: {roughness}");
        let scene = stage("metal", "", WHITE, &[object(BALL, &material), lamp(0.5)]);
        Case::rendered(format!("roughness {roughness}"), scene)
    };
    [0.05, 0.1, 0.2].map(case).into()
}

/// Heaps of leaves that masks cut into so many pieces along each side.
fn foliage() -> Vec<Case> {
    let case = |pieces: f64| {
        // Directions by the golden angle.
        let leaf = |k: i32| {
            let turn = f64::from(k) * 2.399_963;
            let (x, y, z) = (
                1.6 * sin(turn * 1.7),
                0.2 + 0.04 * f64::from(k),
                1.6 * cos(turn),
            );
            let shape = format!(
                "type: quad, position: [{x}, {y}, {z}], up: [0.5, 0.5, {}], side: [{}, 0.1, 0.5]",
                sin(turn),
                -cos(turn)
            );
            let mask = format!(
                "baseColor: [0.3, 0.6, 0.2, 1], alpha: mask, opacityMap: {{pattern: checker, \
                 scale: {pieces}}}, metallic: 0, roughness: 0.8, doubleSided: true"
            );
            object(&shape, &mask)
        };
        let mut objects: Vec<_> = (0..40).map(leaf).collect();
        objects.push(lamp(0.3));
        let scene = stage("leaves", "", WHITE, &objects);
        Case::rendered(format!("{pieces} pieces"), scene)
    };
    [2.0, 6.0, 20.0].map(case).into()
}

/// Floors with checkers from two squares a pixel to hundreds.
fn fine_textures() -> Vec<Case> {
    let case = |scale: f64| {
        let floor = format!("baseColorMap: {{pattern: checker, scale: {scale}}}");
        Case::rendered(
            format!("scale {scale}"),
            stage("checker", "", &floor, &[lamp(0.3)]),
        )
    };
    [20.0, 100.0, 500.0].map(case).into()
}
