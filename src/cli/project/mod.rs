//! `rtc.toml`: what holds for the scenes of a folder and of those below, where the command line says
//! nothing else.

mod read;

use super::Failure;
use rtc_diag::{Code, Diagnostic, FindingLevels, clip_path, codes};
use rtc_passes::Overrides;
use rtc_pipeline::Input;
use rtc_source::{Limits, Loader, Resource, SourceMap, Span};
use rtc_study::Goal;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// The name of the file.
const NAME: &str = "rtc.toml";

/// The most bytes of it.
const MAX_BYTES: u64 = 64 << 10;

/// A folder that has one of these is where the search ends.
const END: &str = ".git";

/// What an `rtc.toml` says, and what is wrong with it.
pub(super) struct Project {
    path: PathBuf,
    bytes: Vec<u8>,
    settings: ProjectSettings,
    faults: Vec<ProjectFault>,
}

/// What it says.
#[derive(Default)]
struct ProjectSettings {
    levels: FindingLevels,
    limits: Vec<(Resource, u64)>,
    asset_root: Option<PathBuf>,
    render: Overrides,
}

/// What is wrong in some of its bytes.
struct ProjectFault {
    code: &'static Code,
    at: Range<usize>,
    message: String,
    hint: Option<String>,
    /// What was most likely meant in these bytes.
    meant: Option<String>,
}

impl Project {
    /// That of a scene: in its folder, or the nearest above up to the root of a repository. Standard
    /// input lies in the current folder.
    pub(super) fn of(scene: &Path) -> Result<Option<Self>, Failure> {
        let Some(path) = nearest_file(scene) else {
            return Ok(None);
        };
        let bytes = Loader.bytes(&path, MAX_BYTES, &SourceMap::default());
        let bytes = bytes.map_err(|error| {
            Failure::Trouble(format!("can't read `{}`: {error}", path.display()))
        })?;
        let (settings, faults) = read::read(&bytes, path.parent().unwrap_or(Path::new("")));
        // As a person in this folder would name it.
        let here = std::env::current_dir().ok();
        let here = here.and_then(|here| path.strip_prefix(here).ok().map(Path::to_owned));
        Ok(Some(Self {
            path: here.unwrap_or(path),
            bytes,
            settings,
            faults,
        }))
    }

    /// Puts what it says of findings below what was said before.
    pub(super) fn levels(&self, typed: FindingLevels) -> FindingLevels {
        let mut levels = self.settings.levels.clone();
        levels.override_by(typed);
        levels
    }

    /// Sets the limits that it sets.
    pub(super) fn set_limits(&self, limits: &mut Limits) {
        for (resource, limit) in &self.settings.limits {
            limits.set(*resource, *limit);
        }
    }

    /// The folder whose files its scenes may name.
    pub(super) fn asset_root(&self) -> Option<PathBuf> {
        self.settings.asset_root.clone()
    }

    /// Tells of it among the findings of a scene.
    pub(super) fn tell(&self, input: &mut Input) {
        let file = input.add_text(&self.path, self.bytes.clone());
        let path = self.path.display().to_string();
        let message = format!("settings from `{}`", clip_path(&path));
        input.push(Diagnostic::new(&codes::SETTINGS_READ, message));
        let to_u32 = |at: usize| u32::try_from(at).unwrap_or(u32::MAX);
        for fault in &self.faults {
            let span = Span::new(file, to_u32(fault.at.start), to_u32(fault.at.end));
            let found = Diagnostic::new(fault.code, fault.message.clone()).at(span, "");
            let found = match (&fault.hint, &fault.meant) {
                (Some(hint), Some(meant)) => found.guess(hint.clone(), span, meant.clone()),
                (Some(hint), None) => found.hint(hint.clone()),
                (None, _) => found,
            };
            input.push(found);
        }
    }
}

/// How the pictures of a scene are made by its project. A compiled scene has that settled, and what is
/// sampled until it is good enough has no number of samples.
pub(super) fn picture(scene: &Path, goal: Goal) -> Result<Overrides, Failure> {
    let is_compiled = scene.extension().is_some_and(|own| own == "rtir");
    let project = Project::of(scene)?.filter(|_| !is_compiled);
    let settled = project.map_or_else(Overrides::default, |own| own.settings.render);
    Ok(match goal {
        Goal {
            error: None,
            time: None,
        } => settled,
        Goal { error: _, time: _ } => Overrides {
            supersampling: None,
            aperture_samples: None,
            spp: None,
            ..settled
        },
    })
}

/// The file that holds for a scene.
fn nearest_file(scene: &Path) -> Option<PathBuf> {
    let folder = scene.parent().filter(|own| !own.as_os_str().is_empty());
    let folder = folder.unwrap_or(Path::new(".")).canonicalize().ok()?;
    for folder in folder.ancestors() {
        let path = folder.join(NAME);
        if path.is_file() {
            return Some(path);
        }
        if folder.join(END).exists() {
            return None;
        }
    }
    None
}
