//! What no sample has met is in no estimate, but it is in the bound; and where too bright light may be
//! unmet there is no bound.

use super::paths::balls;
use super::patterns::grains;
use super::scenes::render;
use rtc::internals::ir::{Material, Scene};

/// Of 32 pictures fewer than 25 keep the bound of 90 of 100 by chance once in 100; by the estimate of
/// what was met, 19 keep it, and some say that there is no error at all.
#[test]
fn the_error_said_is_kept_where_few_pixels_show_anything() {
    let (mut kept, mut told) = (0, Vec::new());
    for (radius, share) in [(0.05, 0.05), (0.1, 0.02)] {
        let pattern = grains(24, radius, share);
        for seed in 1..=16 {
            let reached = render(&pattern.scene, 1.0, seed);
            let error = pattern.error(&reached);
            assert!(reached.undersampled.is_none());
            assert!(reached.error > 0.0, "some may be unmet");
            kept += u32::from(error <= reached.error);
            told.push([radius, error, reached.error]);
        }
    }
    assert!(kept >= 25, "{kept} of 32: {told:.2?}");
}

/// The same balls, under a light so many times as bright.
pub(super) fn under(brightness: f64) -> Scene {
    let mut scene = balls();
    for material in &mut scene.materials {
        if let Material::Standard(standard) = material {
            standard.emissive = standard.emissive.map(|channel| brightness * channel);
        }
    }
    scene
}

#[test]
fn there_is_no_bound_where_much_brighter_light_may_be_unmet() {
    let undersampled = |brightness| render(&under(brightness), 12.0, 1).undersampled;
    assert_eq!(undersampled(1.0), None);
    let white = undersampled(1e5).unwrap();
    assert!((1e5..1e6).contains(&white), "{white}");
}
