//! A turntable: views around a scene that is validated once, and the names of their files.

use super::Failure;
use rtc_ir::{Camera, Scene};
use rtc_math::{Vec3, unit};
use rtc_pipeline::ValidatedScene;
use std::f64::consts::TAU;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// Views around the upward axis through the middle of a scene; the first is that of its camera.
pub(super) struct Turntable {
    camera: Camera,
    axis: Vec3,
    middle: Vec3,
    count: u32,
}

/// Which views of a turntable are shown.
pub(super) struct TurntableViews {
    /// The number of views.
    pub(super) count: u32,
    /// Those that are shown, from 0.
    pub(super) shown: Range<u32>,
}

impl TurntableViews {
    /// The number of views, and the range of them to render, from 1, if any.
    pub(super) fn new(
        count: Option<u32>,
        frames: Option<[u32; 2]>,
    ) -> Result<Option<Self>, Failure> {
        let Some(count) = count else {
            return Ok(None);
        };
        let [first, last] = frames.unwrap_or([1, count]);
        if last > count {
            return Err(Failure::Failed(format!(
                "there is no frame {last}: the turntable has {count}"
            )));
        }
        let shown = first - 1..last;
        Ok(Some(Self { count, shown }))
    }
}

impl Turntable {
    /// A number of views around `up`, or by default around the world axis closest to the camera's
    /// up vector.
    pub(super) fn new(scene: &Scene, up: Option<[f64; 3]>, count: u32) -> Self {
        let camera = scene.camera.clone();
        let axis = up.map_or_else(
            || camera.upright(),
            |up| unit(Vec3::from_array(up)).unwrap_or(Vec3::Y),
        );
        let middle = scene
            .bounding_sphere()
            .map_or(Vec3::from_array(camera.center), |ball| ball.center);
        Self {
            camera,
            axis,
            middle,
            count,
        }
    }

    /// Sets the scene to one frame, from 0; the camera moves anticlockwise, seen from above.
    pub(super) fn turn(&self, validated: &mut ValidatedScene, frame: u32) -> Result<(), Failure> {
        let angle = TAU * f64::from(frame) / f64::from(self.count);
        let camera = match frame {
            0 => self.camera.clone(),
            _ => self.camera.turned(angle, self.axis, self.middle),
        };
        let unsound = || {
            Failure::Failed(format!(
                "frame {} can't be seen: its camera is too far away",
                frame + 1
            ))
        };
        validated.scene = validated.scene.seen_by(&camera).ok_or_else(unsound)?;
        validated.lowered.scene.camera = camera;
        Ok(())
    }
}

/// The name of a frame's file: its number, from 1, replaces `%04d` (of any width), or precedes the
/// extension.
pub(super) fn name(pattern: &Path, frame: u32) -> PathBuf {
    let number = frame + 1;
    let file = pattern.file_name().unwrap_or_default().to_string_lossy();
    let placed = file.match_indices('%').find_map(|(at, sign)| {
        let (before, after) = file.split_at(at);
        let (width, rest) = after.strip_prefix(sign)?.split_once('d')?;
        let width: usize = if width.is_empty() {
            1
        } else {
            width.parse().ok().filter(|width| *width < 10)?
        };
        Some(format!("{before}{number:0width$}{rest}"))
    });
    placed.map_or_else(
        || {
            let stem = pattern.file_stem().unwrap_or_default().to_string_lossy();
            let named = pattern.with_file_name(format!("{stem}-{number:04}"));
            pattern.extension().map_or_else(
                || named.clone(),
                |extension| named.with_added_extension(extension),
            )
        },
        |placed| pattern.with_file_name(placed),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_numbered_where_the_name_says_so() {
        let name = |pattern: &str, frame| name(Path::new(pattern), frame).display().to_string();
        assert_eq!(name("a/b-%04d.png", 0), "a/b-0001.png");
        assert_eq!(
            (name("%d.exr", 11), name("x%02dy.png", 0)),
            ("12.exr".to_owned(), "x01y.png".to_owned())
        );
        assert_eq!(
            (name("a.b.png", 2), name("100%.png", 0)),
            ("a.b-0003.png".to_owned(), "100%-0001.png".to_owned())
        );
    }
}
