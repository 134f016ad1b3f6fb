//! Cameras (`UsdGeomCamera`): they look along −z, y is up. Apertures and the focal length are in
//! tenths of a unit.

use super::stage::ComposedPrim;
use super::{Lowering, PlacedCamera};
use rtc_diag::{Diagnostic, clip, codes};
use rtc_ir::{BoundingSphere, Camera, EntityKind, Lens, Projection};
use rtc_math::{Vec3, unit};

/// The larger side of a picture, in pixels.
const SIDE: f64 = 768.0;
/// The points of a lens that a sample takes: one, as paths are many.
const LENS_SAMPLES: u32 = 2;

impl Lowering<'_> {
    /// Chooses the camera: the one that is asked for by its path, name or index, or else the first.
    pub(super) fn finish_camera(&mut self) {
        // Choose the camera by path, name or index, or the first one.
        let cameras = std::mem::take(&mut self.cameras);
        let wanted = self.options.camera.as_deref();
        let chosen = match wanted {
            Some(wanted) => cameras.iter().enumerate().find(|(index, camera)| {
                let prim = &camera.prim;
                prim.path == wanted || prim.name() == wanted || index.to_string() == wanted
            }),
            None => cameras.iter().enumerate().next(),
        };
        // Report a camera that does not exist.
        if let (Some(wanted), None) = (wanted, &chosen) {
            let message = format!("the stage has no camera called `{}`", clip(wanted));
            let names: Vec<_> = cameras
                .iter()
                .map(|camera| format!("`{}`", clip(&camera.prim.path)))
                .collect();
            let hint = match names.is_empty() {
                true => "it has none".to_owned(),
                false => format!("it has {}", names.join(", ")),
            };
            self.sink
                .push(Diagnostic::new(&codes::GLTF_CHOSEN, message).hint(hint));
        }
        // Use its view if it has a volume.
        if let Some((_, camera)) = chosen {
            if let Some(view) = self.view(camera) {
                self.report_clipping(camera);
                self.report_exposure(&camera.prim);
                let span = self.span_of(&camera.prim);
                self.record(EntityKind::Camera, 0, span);
                self.scene.camera = view;
                return;
            }
            self.approximate(
                &camera.prim,
                "the camera has no volume: another view takes its place",
            );
        }
        // Otherwise look at the bounding sphere of the scene.
        let ball = self.scene.bounding_sphere().unwrap_or(BoundingSphere {
            center: Vec3::ZERO,
            radius: 1.0,
        });
        self.scene.camera = crate::gltf::looking_at(ball);
    }

    /// Reports an exposure, which is chosen for the picture.
    fn report_exposure(&mut self, prim: &ComposedPrim) {
        let stops = self.number(prim, "exposure").unwrap_or(0.0);
        if stops != 0.0 {
            let message = format!(
                "`exposure` of the camera is not applied: `--exposure {stops}` adds it to the picture"
            );
            self.approximate(prim, &message);
        }
    }

    /// Reports planes that would clip the scene: paths see all of it. Whether a near plane clips is
    /// not known where the camera is within the bounds of the scene.
    fn report_clipping(&mut self, camera: &PlacedCamera) {
        let range = self.vector::<2>(&camera.prim, "clippingRange");
        let (Some([near, far]), Some(ball)) = (range, self.scene.bounding_sphere()) else {
            return;
        };
        let axis = camera.to_world.vector(Vec3::NEG_Z);
        let (Some(view), scale) = (unit(axis), axis.length()) else {
            return;
        };
        let depth = (ball.center - camera.to_world.point(Vec3::ZERO)).dot(view);
        let [first, last] = [depth - ball.radius, depth + ball.radius];
        let clips_near = first > 0.0 && first < near * scale;
        if clips_near || last > far * scale {
            let message = "`clippingRange` of the camera clips nothing: all of the scene shows";
            self.approximate(&camera.prim, message);
        }
    }

    fn view(&mut self, camera: &PlacedCamera) -> Option<Camera> {
        let PlacedCamera { prim, to_world } = camera;
        let prim: &ComposedPrim = prim;
        let number = |name: &str, default: f64| self.number(prim, name).unwrap_or(default);
        let aperture = [
            number("horizontalAperture", 20.955),
            number("verticalAperture", 15.2908),
        ];
        let offset = [
            number("horizontalApertureOffset", 0.0),
            number("verticalApertureOffset", 0.0),
        ];
        let focal = number("focalLength", 50.0);
        let (focus, f_stop) = (number("focusDistance", 0.0), number("fStop", 0.0));
        let is_orthographic = self.text(prim, "projection").as_deref() == Some("orthographic");
        if aperture.iter().any(|side| *side <= 0.0) || focal <= 0.0 {
            return None;
        }
        let [x, y, z] = to_world.orthonormal()?;
        let eye = to_world.point(Vec3::ZERO);
        let scale = unit_length(to_world.vector(Vec3::Z))?;
        let distance = if focus > 0.0 { focus * scale } else { scale };
        // Half of a picture in the plane of focus.
        let per_aperture = match is_orthographic {
            true => 0.1 * scale,
            false => distance / focal,
        };
        let longer = aperture[0].max(aperture[1]);
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "at most the larger side"
        )]
        let size = aperture.map(|side| (SIDE * side / longer).round().max(1.0) as u32);
        let pixel = aperture[1] * per_aperture / f64::from(size[1]);
        let shift = x * (offset[0] * per_aperture) + y * (offset[1] * per_aperture);
        let radius = match f_stop > 0.0 && focus > 0.0 && !is_orthographic {
            true => focal * 0.1 * scale / (2.0 * f_stop),
            false => 0.0,
        };
        Some(Camera {
            eye: if is_orthographic { eye + shift } else { eye }.to_array(),
            center: (eye - z * distance + shift).to_array(),
            right: (x * pixel).to_array(),
            up: (y * pixel).to_array(),
            size,
            lens: match radius > 0.0 {
                true => Lens {
                    radius,
                    samples: LENS_SAMPLES,
                },
                false => Lens::PINHOLE,
            },
            projection: match is_orthographic {
                true => Projection::Orthographic,
                false => Projection::Perspective,
            },
        })
    }
}

fn unit_length(vector: Vec3) -> Option<f64> {
    unit(vector)?;
    Some(vector.length())
}
