//! The camera back to text.

use super::Text;
use crate::ir::{Camera, Lens};
use crate::math::{Vec3, camera_basis};

impl Text {
    pub(super) fn camera(&mut self, camera: &Camera, up: Vec3) {
        let Camera { eye, center, right: _, up: _, size: [width, height], lens, projection: _ } = camera;
        let Lens { radius, samples } = lens;
        self.line(0, "Camera:");
        self.numbers("eye", eye, 2);
        self.numbers("center", center, 2);
        self.numbers("up", &up.to_array(), 2);
        self.line(2, &format!("viewSize: [{width}, {height}]"));
        if *radius != 0.0 || *samples != 1 {
            self.number("apertureRadius", *radius, 2);
            self.line(2, &format!("apertureSamples: {samples}"));
        }
    }
}

/// How far frames may be from right angles and equal lengths to be those of a `Camera`.
const TOLERANCE: f64 = 1e-9;

/// An `up` that gives exactly the frame of the camera if there is one, else one that gives it up to rounding.
pub(super) fn camera_up(camera: &Camera) -> Result<Vec3, String> {
    let [eye, center, right, up] = [camera.eye, camera.center, camera.right, camera.up].map(Vec3::from_array);
    let gaze = (center - eye).try_normalize().ok_or("the eye of the camera lies in the middle of its image")?;
    let pixel = up.length();
    let along_gaze = |side: Vec3| (side.dot(gaze) / pixel).abs() > TOLERANCE;
    if along_gaze(right) || along_gaze(up) {
        return Err(
            "the camera looks at its image at a slant, as an old `Eye` off the middle does; a `Camera` looks at \
                    it squarely"
                .to_owned(),
        );
    }
    if ((right.length() - pixel) / pixel).abs() > TOLERANCE || (right.dot(up) / (pixel * pixel)).abs() > TOLERANCE {
        return Err("the pixels of the camera are not square, and those of a `Camera` are".to_owned());
    }
    if right.cross(up).dot(gaze) > 0.0 {
        return Err("the image of the camera is mirrored, and that of a `Camera` is not".to_owned());
    }
    let exact = |candidate: &Vec3| camera_basis(eye, center, *candidate) == Ok((right, up));
    Ok(axes(pixel).chain(tilted(up, gaze * pixel)).find(exact).unwrap_or(up))
}

/// The axes with the length of a pixel, rounded as a person would have written it.
fn axes(pixel: f64) -> impl Iterator<Item = Vec3> {
    let rounded = move |digits: usize| format!("{pixel:.digits$e}").parse().unwrap_or(pixel);
    let lengths = move || [rounded(3), rounded(8), rounded(14), pixel];
    let axes = [Vec3::Y, Vec3::Z, Vec3::X, Vec3::NEG_Y, Vec3::NEG_Z, Vec3::NEG_X];
    axes.into_iter().flat_map(move |axis| lengths().map(|length| axis * length))
}

/// `up` tilted along the gaze: all give the same frame, each with its own rounding.
fn tilted(up: Vec3, gaze: Vec3) -> impl Iterator<Item = Vec3> {
    const TRIES: u32 = 1 << 14;
    (0..TRIES).map(move |step| {
        let t = f64::from(step) / f64::from(TRIES);
        (up * (1.0 - t * t) + gaze * (2.0 * t)) / (1.0 + t * t)
    })
}
