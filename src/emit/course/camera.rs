//! Writes the camera.

use super::SceneWriter;
use rtc_ir::{Camera, Lens, Projection};
use rtc_math::{Vec3, camera_basis, length, unit};

impl SceneWriter<'_> {
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

/// The largest deviation from perpendicular axes and square pixels at which a frame of an `up`
/// alone is tried.
const TOLERANCE: f64 = 1e-9;

/// An `up` from which the exact frame of the camera can be computed, if one is found.
fn upright(camera: &Camera) -> Option<Vec3> {
    let [eye, center, right, up] =
        [camera.eye, camera.center, camera.right, camera.up].map(Vec3::from_array);
    let (view_direction, across, upward) = (unit(center - eye)?, unit(right)?, unit(up)?);
    let pixel = length(up);
    let is_square =
        ((length(right) - pixel) / pixel).abs() < TOLERANCE && across.dot(upward).abs() < TOLERANCE;
    // A mirrored image can't be expressed by `up` either.
    let is_faced = across.dot(view_direction).abs() < TOLERANCE
        && upward.dot(view_direction).abs() < TOLERANCE;
    if !is_square || !is_faced || across.cross(upward).dot(view_direction) > 0.0 {
        return None;
    }
    let exact = |candidate: &Vec3| camera_basis(eye, center, *candidate) == Ok((right, up));
    axes(pixel)
        .chain(tilted(up, view_direction * pixel))
        .find(exact)
}

/// The world axes with the length of a pixel, rounded as an author would write it.
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

/// `up` tilted along the viewing direction: all give the same frame, with different rounding
/// errors.
fn tilted(up: Vec3, view_direction: Vec3) -> impl Iterator<Item = Vec3> {
    const TRIES: u32 = 1 << 10;
    (0..TRIES).map(move |step| {
        let t = f64::from(step) / f64::from(TRIES);
        (up * (1.0 - t * t) + view_direction * (2.0 * t)) / (1.0 + t * t)
    })
}
