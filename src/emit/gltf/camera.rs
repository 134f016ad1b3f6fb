//! The camera: perspective or orthographic, and in `extras.rtc` what glTF has no words for: the
//! size of the picture, the plane of focus, where its middle lies, the lens.

use super::writer::{GltfWriter, extras, single};
use crate::ir::{Camera, Field, Lens, Noun, Place, Projection};
use crate::math::{Vec3, atan2, length, unit};
use gltf::json;
use json::camera::{Orthographic, Perspective, Type};
use json::validation::Checked;
use serde_json::{Map as Block, json};

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
        let camera = match projection {
            Projection::Perspective => self.perspective(half, distance),
            Projection::Orthographic => self.orthographic(half, distance),
        };
        let camera = json::Camera {
            extras: extras(own),
            ..camera
        };
        let node = json::Node {
            camera: Some(self.root.push(camera)),
            ..json::Node::default()
        };
        self.node(node, [x, y, z, eye].map(|column| column.to_array()));
    }

    fn own_words_of_camera(
        &mut self,
        distance: f64,
        shift: [f64; 2],
        lens: &Lens,
    ) -> Block<String, json::Value> {
        let place = Place::new(Noun::Camera, 0, Field::Whole);
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

    fn perspective(&mut self, [width, height]: [f64; 2], distance: f64) -> json::Camera {
        let yfov = 2.0 * atan2(height, distance);
        let at = format!("/cameras/{}/perspective", self.root.cameras.len());
        self.exact.push((format!("{at}/yfov"), yfov.into()));
        self.exact
            .push((format!("{at}/aspectRatio"), (width / height).into()));
        json::Camera {
            perspective: Some(Perspective {
                aspect_ratio: Some(single(width / height)),
                yfov: single(yfov),
                zfar: None,
                znear: single(NEAR * distance),
                extensions: None,
                extras: None,
            }),
            ..camera(Type::Perspective)
        }
    }

    fn orthographic(&mut self, [width, height]: [f64; 2], distance: f64) -> json::Camera {
        let at = format!("/cameras/{}/orthographic", self.root.cameras.len());
        self.exact.push((format!("{at}/xmag"), width.into()));
        self.exact.push((format!("{at}/ymag"), height.into()));
        let eye = Vec3::from_array(self.scene.camera.eye);
        let far = self.scene.ball().map_or(distance, |ball| {
            ball.center.distance(eye) + ball.radius + distance
        });
        json::Camera {
            orthographic: Some(Orthographic {
                xmag: single(width),
                ymag: single(height),
                zfar: single(far),
                znear: 0.0,
                extensions: None,
                extras: None,
            }),
            ..camera(Type::Orthographic)
        }
    }
}

fn camera(kind: Type) -> json::Camera {
    json::Camera {
        name: None,
        orthographic: None,
        perspective: None,
        type_: Checked::Valid(kind),
        extensions: None,
        extras: None,
    }
}
