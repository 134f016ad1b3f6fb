//! The error bound is kept where all pixels have a feature that few samples hit: sample allocation
//! by the displayed values would prefer pixels that have missed it.

use super::patterns::grid;
use super::scenes::render;

/// If the bound holds with probability 0.9, fewer than 12 of 16 pictures keep it once in 300 runs.
#[test]
fn the_error_said_is_kept_by_grids_in_step_with_pixels() {
    let (mut kept, mut told) = (0, Vec::new());
    for (width, offset) in [(0.03, 0.13), (0.05, 0.0), (0.07, 0.2), (0.95, 0.0)] {
        let pattern = grid(24, width, offset);
        for seed in 1..=4 {
            let reached = render(&pattern.scene, 4.0, seed);
            let error = pattern.error(&reached);
            assert!(reached.error <= 4.0, "{}", reached.error);
            kept += u32::from(error <= reached.error);
            told.push([width, error, reached.error]);
        }
    }
    assert!(kept >= 12, "{kept} of 16: {told:.2?}");
}
