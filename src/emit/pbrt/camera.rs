//! Writes camera and film: any frustum, with or without a thin lens, and straight parallel rays.

use super::{PbrtWriter, matrix, numbers};
use crate::path_tracer::CameraFrame;
use rtc_ir::{EntityField, EntityKind, Projection, ValuePath};
use rtc_math::{Vec3, atan2};

impl PbrtWriter<'_> {
    /// pbrt's camera looks along its z axis, with y up and x to the right.
    pub(super) fn camera(&mut self) {
        let camera = &self.scene.camera;
        let frame = CameraFrame::of(camera);
        // The film.
        let [width, height] = camera.size;
        self.line(&format!(
            r#"Film "rgb" "integer xresolution" [ {width} ] "integer yresolution" [ {height} ]"#
        ));
        // From the world to the camera: the axes are the rows of the rotation.
        let rotated = |v: Vec3| Vec3::from_array(frame.axes.map(|axis| axis.dot(v)));
        let columns = [Vec3::X, Vec3::Y, Vec3::Z, -frame.eye].map(rotated);
        self.line(&format!("Transform [ {} ]", matrix(columns)));
        // The screen, in units of half of its shorter side.
        let (kind, parameters) = match camera.projection {
            Projection::Perspective => ("perspective", perspective(&frame)),
            Projection::Orthographic => ("orthographic", screen(&frame, 1.0)),
        };
        if camera.projection == Projection::Orthographic && frame.is_slanted() {
            let message = "rays come slantwise through the picture: pbrt's come straight";
            let path = ValuePath::new(EntityKind::Camera, 0, EntityField::Whole);
            self.beside.reporter.unsupported(message, path);
        }
        let lens = match camera.lens.radius > 0.0 && camera.projection == Projection::Perspective {
            true => {
                let focus = numbers("float", "focaldistance", [frame.distance]);
                numbers("float", "lensradius", [camera.lens.radius]) + &focus
            }
            false => String::new(),
        };
        if let Some(medium) = &self.scene.medium {
            self.named_medium("around", medium);
            self.line(r#"MediumInterface "" "around""#);
        }
        self.line(&format!(r#"Camera "{kind}"{parameters}{lens}"#));
        if self.scene.medium.is_some() {
            self.line(r#"MediumInterface "" """#);
        }
    }
}

/// The field of view of the shorter side, and the screen relative to it.
fn perspective(frame: &CameraFrame) -> String {
    let [width, height] = frame.half;
    let shorter = width.min(height);
    let angle = 2.0 * atan2(shorter, frame.distance);
    numbers("float", "fov", [angle.to_degrees()]) + &screen(frame, shorter)
}

/// The bounds of the screen in a unit: left, right, bottom, top.
fn screen(frame: &CameraFrame, unit: f64) -> String {
    let [x, y] = [0, 1].map(|k| {
        let [half, shift] = [frame.half[k] / unit, frame.shift[k]];
        [half * (shift - 1.0), half * (shift + 1.0)]
    });
    numbers("float", "screenwindow", x.into_iter().chain(y))
}
