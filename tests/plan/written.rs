//! Generated scenes of any size can be written and read again.

use super::dice::Dice;
use crate::scale::scaled;
use rtc::internals::ir::{Projection, Scene, VertexColumn};
use rtc::internals::math::ldexp;
use rtc::internals::pipeline::trial::is_written;

const SCENES: u64 = 120;

/// Powers of two that lengths are multiplied by: beyond the range of 32-bit floats and of their
/// squares, and within.
const POWERS: [i32; 7] = [0, -160, -130, -60, 60, 100, 110];

/// A generated scene, in turn orthographic, and with tangents of any length.
fn scene(seed: u64) -> Scene {
    let mut scene = Dice::new(seed).scene();
    if seed.is_multiple_of(3) {
        scene.camera.projection = Projection::Orthographic;
    }
    for mesh in &mut scene.meshes {
        let normals: Vec<[f64; 3]> = mesh.positions.iter().map(|_| [0.0, 3.0, 4.0]).collect();
        let length = [0.0, 1e-30, 0.5, 1.0, 1e30][(seed % 5) as usize];
        mesh.tangents = normals.iter().map(|_| [length, 0.0, 0.0, -0.3]).collect();
        mesh.normals = VertexColumn::rounded(normals);
    }
    let power = POWERS[(seed % 7) as usize];
    scaled(&scene, ldexp(1.0, power))
}

#[test]
fn what_is_written_is_accepted() {
    for seed in 0..SCENES {
        // If the test fails, the last printed number is the failing scene.
        println!("{seed}");
        is_written(scene(seed));
    }
}
