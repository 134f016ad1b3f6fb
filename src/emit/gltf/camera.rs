//! Writes the camera: perspective or orthographic. Image size, plane of focus, off-centre
//! projection and lens go to `extras.rtc`, because glTF can't express them.

use super::document::{self, GltfIndex, Node};
use super::writer::{GltfWriter, extras, single};
use rtc_ir::{Camera, EntityField, EntityKind, Lens, Projection, ValuePath};
use rtc_math::{Vec3, atan2, length, unit};
use serde_json::{Map as JsonObject, Value, json};

/// The near plane, as a fraction of the distance to the plane of focus.
const NEAR: f64 = 1e-3;
/// The largest offset of the image centre from the axis that counts as centred, in half image
/// sizes.
const CENTERED: f64 = 1e-12;

impl GltfWriter<'_> {
    /// Writes the camera.
    pub(super) fn camera(&mut self) {
        let Camera {
            eye,
            center,
            right,
            up,
            size: [width, height],
            lens,
            projection,
        } = &self.scene.camera;
        // Axes of the camera.
        let [eye, center, right, up] = [*eye, *center, *right, *up].map(Vec3::from_array);
        let [x, y] = [right, up].map(|step| unit(step).unwrap_or(Vec3::X));
        let z = unit(x.cross(y)).unwrap_or(Vec3::Z);
        let z = if z.dot(eye - center) < 0.0 { -z } else { z };
        // Image size, and offset of its centre from the axis.
        let distance = (eye - center).dot(z);
        let half = [
            length(right) * f64::from(*width) / 2.0,
            length(up) * f64::from(*height) / 2.0,
        ];
        let middle = center - (eye - z * distance);
        let shift = [middle.dot(x) / half[0], middle.dot(y) / half[1]];
        // Write the camera and its node.
        let rtc_extras = self.camera_extras(distance, shift, lens);
        let (kind, projection) = match projection {
            Projection::Perspective => ("perspective", perspective(half, distance)),
            Projection::Orthographic => ("orthographic", self.orthographic(half, distance)),
        };
        let camera = document::Camera {
            projection,
            kind,
            extras: extras(rtc_extras),
        };
        let node = Node {
            camera: Some(GltfIndex::push(&mut self.root.cameras, camera)),
            ..Node::default()
        };
        self.node(node, [x, y, z, eye].map(|column| column.to_array()));
    }

    fn camera_extras(
        &mut self,
        distance: f64,
        shift: [f64; 2],
        lens: &Lens,
    ) -> JsonObject<String, Value> {
        let path = ValuePath::new(EntityKind::Camera, 0, EntityField::Whole);
        let [width, height] = self.scene.camera.size;
        let mut rtc_extras = JsonObject::new();
        let mut insert = |key: &str, value| {
            rtc_extras.insert(key.to_owned(), value);
        };
        insert("width", width.into());
        insert("height", height.into());
        insert("focusDistance", distance.into());
        self.reporter.in_extras("the size of the picture", path);
        if shift.iter().any(|side| side.abs() > CENTERED) {
            insert("shift", json!(shift));
            let what = "that the camera looks past the middle of its picture";
            self.reporter.in_extras(what, path);
        }
        let Lens { radius, samples } = lens;
        if *radius != 0.0 || *samples != 1 {
            insert("lensRadius", (*radius).into());
            insert("lensSamples", (*samples).into());
            self.reporter.in_extras("the lens of the camera", path);
        }
        rtc_extras
    }

    fn orthographic(&self, [xmag, ymag]: [f64; 2], distance: f64) -> document::Projection {
        let eye = Vec3::from_array(self.scene.camera.eye);
        let far = self.scene.bounding_sphere().map_or(distance, |sphere| {
            sphere.center.distance(eye) + sphere.radius + distance
        });
        document::Projection::Orthographic {
            xmag,
            ymag,
            zfar: short(far),
            znear: 0.0,
        }
    }
}

fn perspective([width, height]: [f64; 2], distance: f64) -> document::Projection {
    document::Projection::Perspective {
        aspect_ratio: width / height,
        yfov: 2.0 * atan2(height, distance),
        znear: short(NEAR * distance),
    }
}

/// A positive distance rounded to f32, if that is a normal number.
fn short(distance: f64) -> f64 {
    let rounded = f64::from(single(distance));
    match rounded.is_normal() {
        true => rounded,
        false => distance.clamp(f64::MIN_POSITIVE, f64::MAX),
    }
}
