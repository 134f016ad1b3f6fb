//! The camera back to text.

use super::Text;
use rtc_ir::{Camera, Lens, Projection};
use rtc_math::{Vec3, camera_basis, length, unit};

impl Text<'_> {
    pub(super) fn camera(&mut self, camera: &Camera) {
        let Camera {
            eye,
            center,
            right,
            up,
            size: [width, height],
            lens,
            projection,
        } = camera;
        let Lens { radius, samples } = lens;
        self.line(0, "Camera:");
        self.numbers("eye", eye, 2);
        self.numbers("center", center, 2);
        match upright(camera) {
            Some(up) => self.numbers("up", &up.to_array(), 2),
            None => {
                self.numbers("up", up, 2);
                self.numbers("right", right, 2);
            }
        }
        self.line(2, &format!("viewSize: [{width}, {height}]"));
        match projection {
            Projection::Perspective => {}
            Projection::Orthographic => self.line(2, "projection: orthographic"),
        }
        if *radius != 0.0 || *samples != 1 {
            self.number("apertureRadius", *radius, 2);
            self.line(2, &format!("apertureSamples: {samples}"));
        }
    }
}

/// How far frames may be from right angles and equal lengths to be looked for among those of an
/// `up` alone.
const TOLERANCE: f64 = 1e-9;

/// An `up` that alone gives exactly the frame of the camera, if one is found.
fn upright(camera: &Camera) -> Option<Vec3> {
    let [eye, center, right, up] =
        [camera.eye, camera.center, camera.right, camera.up].map(Vec3::from_array);
    let (gaze, across, upward) = (unit(center - eye)?, unit(right)?, unit(up)?);
    let pixel = length(up);
    let is_square =
        ((length(right) - pixel) / pixel).abs() < TOLERANCE && across.dot(upward).abs() < TOLERANCE;
    // A mirrored image is none either.
    let is_faced = across.dot(gaze).abs() < TOLERANCE && upward.dot(gaze).abs() < TOLERANCE;
    if !is_square || !is_faced || across.cross(upward).dot(gaze) > 0.0 {
        return None;
    }
    let exact = |candidate: &Vec3| camera_basis(eye, center, *candidate) == Ok((right, up));
    axes(pixel).chain(tilted(up, gaze * pixel)).find(exact)
}

/// The axes with the length of a pixel, rounded as a person would have written it.
fn axes(pixel: f64) -> impl Iterator<Item = Vec3> {
    let rounded = move |digits: usize| format!("{pixel:.digits$e}").parse().unwrap_or(pixel);
    let lengths = move || [rounded(3), rounded(8), rounded(14), pixel];
    let axes = [
        Vec3::Y,
        Vec3::Z,
        Vec3::X,
        Vec3::NEG_Y,
        Vec3::NEG_Z,
        Vec3::NEG_X,
    ];
    axes.into_iter()
        .flat_map(move |axis| lengths().map(|length| axis * length))
}

/// `up` tilted along the gaze: all give the same frame, each with its own rounding.
fn tilted(up: Vec3, gaze: Vec3) -> impl Iterator<Item = Vec3> {
    const TRIES: u32 = 1 << 10;
    (0..TRIES).map(move |step| {
        let t = f64::from(step) / f64::from(TRIES);
        (up * (1.0 - t * t) + gaze * (2.0 * t)) / (1.0 + t * t)
    })
}
