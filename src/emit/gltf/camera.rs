//! The camera: perspective or orthographic, and in `extras.rtc` what glTF has no words for: the
//! size of the picture, the plane of focus, where its middle lies, the lens.

use super::document::{self, Index, Node};
use super::writer::{GltfWriter, extras, single};
use rtc_ir::{Camera, EntityKind, Field, Lens, Projection, ValuePath};
use rtc_math::{Vec3, atan2, length, unit};
use serde_json::{Map as Block, Value, json};

/// The near plane, as a share of the distance to the plane of focus.
const NEAR: f64 = 1e-3;
/// How far the middle of the picture may be from the axis to be on it, in halves of the picture.
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
        let [eye, center, right, up] = [*eye, *center, *right, *up].map(Vec3::from_array);
        let [x, y] = [right, up].map(|step| unit(step).unwrap_or(Vec3::X));
        let z = unit(x.cross(y)).unwrap_or(Vec3::Z);
        let z = if z.dot(eye - center) < 0.0 { -z } else { z };
        let distance = (eye - center).dot(z);
        let half = [
            length(right) * f64::from(*width) / 2.0,
            length(up) * f64::from(*height) / 2.0,
        ];
        let middle = center - (eye - z * distance);
        let shift = [middle.dot(x) / half[0], middle.dot(y) / half[1]];
        let own = self.own_words_of_camera(distance, shift, lens);
        let (kind, projection) = match projection {
            Projection::Perspective => ("perspective", perspective(half, distance)),
            Projection::Orthographic => ("orthographic", self.orthographic(half, distance)),
        };
        let camera = document::Camera {
            projection,
            kind,
            extras: extras(own),
        };
        let node = Node {
            camera: Some(Index::push(&mut self.root.cameras, camera)),
            ..Node::default()
        };
        self.node(node, [x, y, z, eye].map(|column| column.to_array()));
    }

    fn own_words_of_camera(
        &mut self,
        distance: f64,
        shift: [f64; 2],
        lens: &Lens,
    ) -> Block<String, Value> {
        let place = ValuePath::new(EntityKind::Camera, 0, Field::Whole);
        let [width, height] = self.scene.camera.size;
        let mut own = Block::new();
        let mut say = |key: &str, value| {
            own.insert(key.to_owned(), value);
        };
        say("width", width.into());
        say("height", height.into());
        say("focusDistance", distance.into());
        self.told.own_words("the size of the picture", place);
        if shift.iter().any(|side| side.abs() > CENTERED) {
            say("shift", json!(shift));
            let what = "that the camera looks past the middle of its picture";
            self.told.own_words(what, place);
        }
        let Lens { radius, samples } = lens;
        if *radius != 0.0 || *samples != 1 {
            say("lensRadius", (*radius).into());
            say("lensSamples", (*samples).into());
            self.told.own_words("the lens of the camera", place);
        }
        own
    }

    fn orthographic(&self, [xmag, ymag]: [f64; 2], distance: f64) -> document::Projection {
        let eye = Vec3::from_array(self.scene.camera.eye);
        let far = self.scene.bounding_sphere().map_or(distance, |ball| {
            ball.center.distance(eye) + ball.radius + distance
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

/// A distance above 0 in the few digits of a 32-bit float, if there is one as long.
fn short(distance: f64) -> f64 {
    let rounded = f64::from(single(distance));
    match rounded.is_normal() {
        true => rounded,
        false => distance.clamp(f64::MIN_POSITIVE, f64::MAX),
    }
}
