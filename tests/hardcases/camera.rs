//! Camera bases, orthonormal bases, and points of the lens.

use super::truth::{Report, cases, error, id, number, vector, vector_error};
use rtc::internals::math::{OrthonormalBasis, U, Vec3, view_basis};
use rtc::internals::render::vogel;

#[test]
fn camera_bases() {
    let mut report = Report::default();
    for case in cases("camera_basis") {
        let input = |key: &str| vector(&case["input"][key]);
        let (right, up) = view_basis(input("center") - input("eye"), input("up")).unwrap();
        let length = number(&case["expect"]["pixel_size"]["hi"]);
        let units = |v: Vec3, key: &str| vector_error(v, &case["expect"][key]) / length / U;
        let (right, up) = (units(right, "right"), units(up, "up"));
        let tolerance = number(&case["tol"]["vec_u"]);
        report.line(
            id(&case),
            right.max(up) <= tolerance,
            &format!("right {right:.2} u, up {up:.2} u of {tolerance}"),
        );
    }
    report.finish();
}

#[test]
fn orthonormal_bases() {
    let mut report = Report::default();
    for case in cases("onb") {
        let tolerance = number(&case["tol"]["orthonormality_u"]) * U;
        for (k, v) in case["input"]["v"].as_array().unwrap().iter().enumerate() {
            let OrthonormalBasis {
                tangent,
                bitangent,
                normal,
            } = OrthonormalBasis::around(vector(v).normalize());
            let lengths = [tangent, bitangent].map(|v| (v.length() - 1.0).abs());
            let angles = [
                tangent.dot(bitangent),
                tangent.dot(normal),
                bitangent.dot(normal),
            ]
            .map(f64::abs);
            let worst = lengths.into_iter().chain(angles).fold(0.0, f64::max);
            let handed = tangent.cross(bitangent).dot(normal) > 0.0;
            report.line(
                &format!("{}.{k}", id(&case)),
                worst <= tolerance && handed,
                &format!("{:.2} u", worst / U),
            );
        }
    }
    report.finish();
}

#[test]
fn points_of_the_lens() {
    let mut report = Report::default();
    for case in cases("aperture") {
        let input = |key: &str| number(&case["input"][key]);
        let (n, radius, pixel) = (input("samples") as u32, input("radius"), input("up_length"));
        let (right, up) = (
            vector(&case["input"]["right"]),
            vector(&case["input"]["up"]),
        );
        let tolerance = number(&case["tol"]["offset_abs_over_R"]) * radius;
        for point in case["expect"]["points"].as_array().unwrap() {
            let k = u32::try_from(point["n"].as_u64().unwrap()).unwrap();
            let [across, upward] = vogel(k, n, radius, pixel);
            let offset = right * across + up * upward;
            let worst = vector_error(offset, &point["offset"]);
            report.line(
                &format!("{}.{k}", id(&case)),
                worst <= tolerance,
                &format!("{worst:e} of {tolerance:e}"),
            );
        }
        let points = (0..n).map(|k| vogel(k, n, radius, pixel));
        let mean = points
            .map(|[x, y]| (x * x + y * y) * pixel * pixel)
            .sum::<f64>()
            / f64::from(n);
        let wanted = &case["expect"]["mean_r2"];
        let close = error(mean, wanted) <= 1e-9 * number(&wanted["hi"]);
        report.line(
            &format!("{}.mean", id(&case)),
            close,
            &format!("mean r² {mean:e}"),
        );
    }
    report.finish();
}
