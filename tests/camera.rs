//! Laws of the camera: its basis for any view, its sub-samples, and the points of its lens.

use proptest::prelude::*;
use rtc::internals::math::{Vec3, camera_basis, cross, dot, pow};
use rtc::internals::render::{Camera, Projection, image_point, vogel};

/// Four units in the last place.
const FOUR_ULP: f64 = 4.0 * f64::EPSILON;

fn vector() -> impl Strategy<Value = Vec3> {
    let component = || -1e3..1e3_f64;
    (component(), component(), component()).prop_map(|(x, y, z)| Vec3::new(x, y, z))
}

/// A point on a grid of 2⁻¹⁰, so that sums and differences are exact.
fn grid_point() -> impl Strategy<Value = Vec3> {
    vector().prop_map(|v| (v * 1024.0).round() / 1024.0)
}

fn length(v: Vec3) -> f64 {
    dot(v, v).sqrt()
}

/// The sine of the angle between two vectors.
fn sine(a: Vec3, b: Vec3) -> f64 {
    length(cross(a, b)) / (length(a) * length(b))
}

prop_compose! {
    /// Eye, centre and up that make a camera with an angle to spare.
    fn view()(eye in vector(), center in vector(), up in vector()) -> (Vec3, Vec3, Vec3) {
        (eye, center, up)
    }
}

proptest! {
    #[test]
    fn the_basis_is_orthogonal_right_handed_and_of_the_length_of_up((eye, center, up) in view()) {
        let gaze = center - eye;
        prop_assume!(sine(gaze, up) > 1e-3);
        let (right, above) = camera_basis(eye, center, up).unwrap();
        let cosine = |a: Vec3, b: Vec3| dot(a, b).abs() / (length(a) * length(b));
        prop_assert!(cosine(right, above) <= FOUR_ULP);
        prop_assert!(cosine(right, gaze) <= FOUR_ULP);
        prop_assert!(cosine(above, gaze) <= FOUR_ULP);
        prop_assert!((length(right) / length(up) - 1.0).abs() <= FOUR_ULP);
        prop_assert!((length(above) / length(up) - 1.0).abs() <= FOUR_ULP);
        prop_assert!(dot(cross(right, above), gaze) < 0.0);
        prop_assert!(dot(above, up) > 0.0);
    }

    #[test]
    fn the_basis_does_not_move_with_the_scene(
        eye in grid_point(), center in grid_point(), up in grid_point(), shift in grid_point()
    ) {
        let here = camera_basis(eye, center, up);
        prop_assert_eq!(here, camera_basis(eye + shift, center + shift, up));
    }

    #[test]
    fn the_basis_grows_with_up((eye, center, up) in view(), factor in 1e-3..1e3_f64) {
        prop_assume!(sine(center - eye, up) > 1e-3);
        let (right, above) = camera_basis(eye, center, up).unwrap();
        let (right_2, above_2) = camera_basis(eye, center, up * 4.0).unwrap();
        prop_assert_eq!((right * 4.0, above * 4.0), (right_2, above_2));
        let (right_f, above_f) = camera_basis(eye, center, up * factor).unwrap();
        let close = |a: Vec3, b: Vec3| length(a - b) <= 1e3 * FOUR_ULP * length(b);
        prop_assert!(close(right_f, right * factor) && close(above_f, above * factor));
    }

    #[test]
    fn the_basis_is_continuous_as_up_nears_the_view(
        (eye, center, side) in view(), exponent in 1..8_i32
    ) {
        let gaze = center - eye;
        prop_assume!(sine(gaze, side) > 1e-1);
        let angle = pow(10.0, f64::from(-exponent));
        let (straight, _) = camera_basis(eye, center, side).unwrap();
        let leaning = gaze / length(gaze) + side * (angle / length(side));
        let (right, _) = camera_basis(eye, center, leaning).unwrap();
        // `leaning` is rounded to 1 u, which an angle this small amplifies; nothing else may show.
        let error = length(right / length(right) - straight / length(straight));
        prop_assert!(error <= 100.0 * f64::EPSILON / angle, "error {error:e} at {angle:e} rad");
    }

    #[test]
    fn up_within_a_billionth_of_the_view_is_refused((eye, center, side) in view()) {
        let gaze = center - eye;
        prop_assume!(sine(gaze, side) > 1e-1);
        let across = cross(gaze, side);
        let at = |angle: f64| camera_basis(eye, center, gaze / length(gaze) + across * (angle / length(across)));
        prop_assert!(at(0.9e-9).is_err());
        prop_assert!(at(1.1e-9).is_ok());
        prop_assert!(camera_basis(eye, center, gaze).is_err());
        prop_assert!(camera_basis(eye, center, -gaze).is_err());
    }

    #[test]
    fn sub_samples_are_symmetric_about_the_pixel(
        (eye, center, up) in view(), x in 0..400_u32, y in 0..300_u32, factor in 1..9_u32
    ) {
        prop_assume!(sine(center - eye, up) > 1e-3);
        let (right, above) = camera_basis(eye, center, up).unwrap();
        let camera = camera(eye, center, right, above);
        let middle = image_point(&camera, [x, y], [0.5; 2]);
        let at = |i: u32, j: u32| [i, j].map(|k| (f64::from(k) + 0.5) / f64::from(factor));
        let size = length(center) + 400.0 * length(up);
        for (i, j) in (0..factor).flat_map(|i| (0..factor).map(move |j| (i, j))) {
            let here = image_point(&camera, [x, y], at(i, j));
            let opposite = image_point(&camera, [x, y], at(factor - 1 - i, factor - 1 - j));
            prop_assert!(length((here + opposite) / 2.0 - middle) <= 4.0 * f64::EPSILON * size);
        }
    }

    #[test]
    fn points_of_the_lens_lie_on_vogels_spiral(n in 1..3000_u32, radius in 1e-3..1e3_f64, pixel in 1e-2..1e2_f64) {
        for k in [0, 1, n / 2, n - 1].into_iter().filter(|k| *k < n) {
            let [x, y] = vogel(k, n, radius, pixel);
            let r = (x * x + y * y).sqrt() * pixel;
            prop_assert!(r < radius);
            let wanted = radius * (f64::from(k) / f64::from(n)).sqrt();
            prop_assert!((r - wanted).abs() <= FOUR_ULP * radius, "point {k} of {n} at {r}, not {wanted}");
        }
        prop_assert_eq!(vogel(0, n, radius, pixel), [0.0; 2]);
        prop_assert_eq!(vogel(n - 1, n, 0.0, pixel).map(f64::abs), [0.0; 2]);
    }
}

fn camera(eye: Vec3, center: Vec3, right: Vec3, up: Vec3) -> Camera {
    Camera {
        eye,
        center,
        right,
        up,
        size: [400, 300],
        lens_radius: 0.0,
        lens_samples: 1,
        projection: Projection::Perspective,
        eyes: None,
    }
}

/// All points of a lens of radius 1.
fn points(n: u32) -> Vec<[f64; 2]> {
    (0..n).map(|k| vogel(k, n, 1.0, 1.0)).collect()
}

#[test]
fn the_centre_of_mass_of_the_lens_tends_to_its_middle() {
    let centre = |n: u32| {
        let sum = points(n)
            .iter()
            .fold([0.0; 2], |sum, p| [sum[0] + p[0], sum[1] + p[1]]);
        (sum[0] * sum[0] + sum[1] * sum[1]).sqrt() / f64::from(n)
    };
    for n in [16, 64, 256, 1024, 4096, 1_000_000] {
        assert!(
            centre(n) < 0.5 / f64::from(n).sqrt(),
            "{n} points: {}",
            centre(n)
        );
    }
}

#[test]
fn each_point_of_the_lens_stands_for_the_same_area() {
    let n = 4096;
    let mut rings = [0_u32; 8];
    let mut quadrants = [0_u32; 4];
    for [x, y] in points(n) {
        rings[((x * x + y * y) * 8.0 + 1e-9) as usize] += 1;
        quadrants[usize::from(x < 0.0) * 2 + usize::from(y < 0.0)] += 1;
    }
    assert!(
        rings.iter().all(|count| count.abs_diff(n / 8) <= 1),
        "{rings:?}"
    );
    assert!(
        quadrants.iter().all(|count| count.abs_diff(n / 4) <= 8),
        "{quadrants:?}"
    );
}

/// The best any n points can do is the hexagonal grid: a distance of √(2A/√3) for an area A each.
/// Points 0 and 1 of the course's formula are 0.52 of it apart; the mean over all points must reach
/// 0.6, and no pair may be closer than those.
#[test]
fn points_of_the_lens_keep_their_distance() {
    for n in [16_u32, 64, 256, 1024] {
        let points = points(n);
        let nearest = |k: usize| {
            let distance = |p: &[f64; 2]| {
                let [x, y] = [p[0] - points[k][0], p[1] - points[k][1]];
                (x * x + y * y).sqrt()
            };
            let others = points.iter().enumerate().filter(|(j, _)| *j != k);
            others
                .map(|(_, p)| distance(p))
                .fold(f64::INFINITY, f64::min)
        };
        let best = (2.0 * std::f64::consts::PI / f64::from(n) / 3.0_f64.sqrt()).sqrt();
        let distances = (0..points.len()).map(nearest).collect::<Vec<_>>();
        let mean = distances.iter().sum::<f64>() / f64::from(n);
        let least = distances.iter().copied().fold(f64::INFINITY, f64::min);
        assert!(mean >= 0.6 * best, "{n} points: mean {mean} of {best}");
        assert!(
            least >= (1.0 - 1e-12) / f64::from(n).sqrt(),
            "{n} points: {least}"
        );
    }
}
