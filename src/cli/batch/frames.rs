//! The pictures of a job: one, views of a turntable, or moments of an animation; and which scenes
//! they are of.

use super::super::Failure;
use super::super::args::{FarmArgs, FarmEngine};
use super::super::turntable::TurntableViews;

/// The pictures of a job.
pub(super) enum JobFrames {
    One,
    /// The first and the last of N views of one scene, from 1.
    Turntable([u32; 2], u32),
    /// The first and the last of the frames of an animation, from 1, with the frames per second.
    Animation([u32; 2], f64),
}

/// The most frames of a job for Open Job Description: a list there is no longer.
const MOST_OF_LIST: u32 = 1024;

/// The most tasks of a Job of Kubernetes whose indexes are retried one by one.
const MOST_TASKS: u64 = 100_000;

impl JobFrames {
    pub(super) fn new(args: &FarmArgs) -> Result<Self, Failure> {
        let frames = Self::requested(args)?;
        let count = frames.range().map_or(1, |[first, last]| last - first + 1);
        if args.to == FarmEngine::OpenJd && count > MOST_OF_LIST {
            return Err(Failure::Failed(format!(
                "a job for OpenJD has at most {MOST_OF_LIST} frames; make several, by `--frames`"
            )));
        }
        let tasks = u64::from(count) * u64::from(args.parts);
        if args.to == FarmEngine::Kubernetes && tasks > MOST_TASKS {
            return Err(Failure::Failed(format!(
                "such a job has at most {MOST_TASKS} tasks, parts times frames; make several, by \
                `--frames`"
            )));
        }
        Ok(frames)
    }

    fn requested(args: &FarmArgs) -> Result<Self, Failure> {
        let trouble = |message: &str| Err(Failure::Failed(message.to_owned()));
        if let Some(views) = TurntableViews::new(args.turntable, args.frames)? {
            if args.stage.up.is_some() {
                return trouble(
                    "a turntable in a job turns around the axis of the scene; leave `--up` out",
                );
            }
            let shown = [views.shown.start + 1, views.shown.end];
            return Ok(Self::Turntable(shown, views.count));
        }
        match (args.frames, args.fps) {
            (None, None) => Ok(Self::One),
            (Some([_, last]), Some(_)) if last > 9999 => trouble("there are at most 9999 frames"),
            (Some(_), Some(_)) if args.file.as_os_str() == "-" => {
                trouble("an animation is read frame by frame; give the name of its file")
            }
            (Some(frames), Some(fps)) => Ok(Self::Animation(frames, fps)),
            (Some(_), None) | (None, Some(_)) => trouble(
                "frames are those of `--turntable N`, or with `--fps N` those of an animation",
            ),
        }
    }

    /// The first frame and the last, of more pictures than one.
    pub(super) fn range(&self) -> Option<[u32; 2]> {
        match self {
            Self::One => None,
            Self::Turntable(range, _) | Self::Animation(range, _) => Some(*range),
        }
    }

    /// The frame numbers in names; a single picture has none.
    pub(super) fn names(&self) -> Vec<String> {
        match self.range() {
            Some([first, last]) => (first..=last).map(padded).collect(),
            None => vec![String::new()],
        }
    }

    /// The name of the scene of a frame.
    pub(super) fn scene(&self, frame: &str) -> String {
        match self {
            Self::One | Self::Turntable(..) => "scene.rtir".to_owned(),
            Self::Animation(..) => format!("scene-{frame}.rtir"),
        }
    }

    /// The scenes, each with its moment if there is one: frame 1 is at 0 seconds.
    pub(super) fn scenes(&self) -> Vec<(String, Option<f64>)> {
        let Self::Animation([first, last], fps) = self else {
            return vec![(self.scene(""), None)];
        };
        let scene = |frame: u32| (self.scene(&padded(frame)), Some(f64::from(frame - 1) / fps));
        (*first..=*last).map(scene).collect()
    }

    /// The moment of the first scene.
    pub(super) fn first_time(&self) -> Option<f64> {
        self.scenes().first().and_then(|(_, time)| *time)
    }
}

fn padded(frame: u32) -> String {
    format!("{frame:04}")
}
