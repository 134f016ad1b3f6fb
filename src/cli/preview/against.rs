//! The reference of a preview: a picture file, or another scene rendered in the same view, from a
//! file or from a git commit of the scene.

use super::preview_state::{RenderedPicture, ViewSettings};
use super::scene::{self, ReadScene, ShownScene};
use super::{Failure, args, input, renderings};
use crate::project::Project;
use crate::reporter::Reporter;
use crate::shown;
use rtc_image::{DecodeCost, FileFormat, Picture, PictureHeader};
use rtc_ir::Camera;
use rtc_pipeline::{Input, PictureSetup, RenderError, RenderObserver};
use rtc_source::SourceMap;
use std::io::Read as _;
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::Arc;

/// The largest text of a commit, in bytes.
const MAX_BYTES: u64 = 1 << 30;

/// Bytes of a pixel that is made a PNG.
const PNG_PIXEL: u64 = 32;

/// The reference of a preview.
pub(super) enum ComparisonReference {
    /// A picture, which is as it is.
    Picture(RenderedPicture),
    /// A scene.
    Scene(Box<ComparisonScene>),
}

/// A scene to compare with.
pub(super) struct ComparisonScene {
    scene: ReadScene,
    shown: Option<ShownScene>,
    /// The last view, and its camera unless it is the reference's own.
    seen: Option<(ViewSettings, Option<Camera>)>,
}

impl ComparisonReference {
    /// The requested reference, if any; a scene is validated, and its diagnostics reported.
    pub(super) fn new(args: &args::PreviewArgs) -> Result<Option<Self>, Failure> {
        let Some(path) = &args.against else {
            return Ok(None);
        };
        // The reference is a picture, a scene, or a commit of the scene.
        if input::is_picture(path) {
            return Ok(Some(Self::Picture(picture(path, &args.reading)?)));
        }
        let text = match path.exists() {
            true => None,
            false => committed(path, &args.file),
        };
        let input = match text {
            Some(text) => {
                let project = Project::of(&args.file, &args.reading)?;
                let options = input::options(&args.reading, project.as_ref())?;
                input::set_stage(Input::edited(&args.file, text, options), &args.stage)?
            }
            None => input::staged(path, &args.reading, &args.stage)?,
        };
        // Validate the scene now, so that its errors end the command.
        let setup = renderings::setup(args)?;
        let mut scene = ReadScene::read(input, args, setup.threads);
        let mut reporter = Reporter::beside_result(&args.reporter);
        let validated = scene.validate(&setup, &ViewSettings::default());
        let validated = match validated {
            Ok(validated) => {
                input::unless_refused(validated, &mut scene.input, &mut reporter).map(drop)
            }
            Err(error) => {
                input::report_diagnostics(&mut scene.input, &mut reporter).and(Err(error.into()))
            }
        };
        reporter.finish()?;
        validated?;
        let (shown, seen) = (None, None);
        Ok(Some(Self::Scene(Box::new(ComparisonScene {
            scene,
            shown,
            seen,
        }))))
    }
}

impl ComparisonScene {
    /// Its picture in the view of the first scene, by the same camera unless that is the scene's
    /// own; `None` if it is already shown.
    pub(super) fn rendering(
        &mut self,
        setup: &PictureSetup,
        (view_settings, camera): (&ViewSettings, &Camera),
        observer: &RenderObserver<'_>,
    ) -> Result<Option<RenderedPicture>, RenderError> {
        let camera = view_settings.view_override.is_some().then_some(camera);
        let wanted = (view_settings.clone(), camera.cloned());
        if self.seen.as_ref() == Some(&wanted) {
            return Ok(None);
        }
        (self.shown, self.seen) = (None, None);
        let Some((mut setup, mut subject)) = self.scene.validate(setup, view_settings)? else {
            let message = "the reference can't be rendered in these settings";
            return Err(RenderError::Refused(message.to_owned()));
        };
        let input = &mut self.scene.input;
        setup.light(&mut subject, input, observer)?;
        if let Some(camera) = camera {
            scene::see_by(&mut subject, camera);
        }
        let rendering = renderings::whole(&setup, &mut subject, input, observer)?;
        (self.shown, self.seen) = (Some((setup, subject)), Some(wanted));
        Ok(Some(rendering))
    }

    /// A crude picture by another camera; `None` if there is none.
    pub(super) fn glance(
        &mut self,
        camera: &Camera,
        observer: &RenderObserver<'_>,
    ) -> Result<Option<RenderedPicture>, RenderError> {
        self.seen = None;
        let Some(shown) = &mut self.shown else {
            return Ok(None);
        };
        scene::see_by(&mut shown.1, camera);
        self.scene.glance(shown, observer)
    }
}

/// The picture in a file, as a PNG.
fn picture(path: &Path, reading: &args::ReadArgs) -> Result<RenderedPicture, Failure> {
    let refused = |message: String| Failure::Failed(format!("`{}`: {message}", path.display()));
    let map = SourceMap::with_limits(reading.limits(|_| ()));
    let bytes = shown::read(path, &map)?;
    let file = shown::opened(path, &bytes, map.budget())?;
    let DecodeCost {
        pixels,
        memory,
        scratch,
    } = file.cost();
    let cost = DecodeCost {
        pixels,
        memory: memory.saturating_add(pixels.saturating_mul(PNG_PIXEL)),
        scratch,
    };
    shown::charge(path, cost, map.budget())?;
    let image = shown::decoded(path, file)?.image();
    let full = [image.width, image.height];
    let picture = Picture {
        image,
        ..Picture::default()
    };
    let png = PictureHeader::of(&picture, FileFormat::Png8).encode(&picture);
    Ok(RenderedPicture {
        png: Arc::new(png.map_err(|error| refused(error.to_string()))?),
        full,
        is_finished: true,
    })
}

/// The text that the scene has in a commit of git; none if there is no such commit, or no scene in
/// it.
fn committed(revision: &Path, scene: &Path) -> Option<Vec<u8>> {
    let revision = revision.to_str().filter(|own| !own.starts_with('-'))?;
    let folder = scene.parent().filter(|own| !own.as_os_str().is_empty());
    let mut git = Command::new("git")
        .arg("-C")
        .arg(folder.unwrap_or(Path::new(".")))
        .args(["cat-file", "blob"])
        .arg(format!("{revision}:./{}", scene.file_name()?.to_str()?))
        .envs([("GIT_NO_LAZY_FETCH", "1"), ("GIT_TERMINAL_PROMPT", "0")])
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .ok()?;
    let mut text = Vec::new();
    // The pipe is closed then, so that git does not wait for a reader.
    let read = git
        .stdout
        .take()?
        .take(MAX_BYTES + 1)
        .read_to_end(&mut text);
    let is_whole = git.wait().ok()?.success() && text.len() as u64 <= MAX_BYTES;
    (read.is_ok() && is_whole).then_some(text)
}
