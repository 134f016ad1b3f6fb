//! `rtc.toml`: defaults of the command line for the scenes of a folder and of the folders below.

mod read;
mod trust;

use super::Failure;
use super::args::ReadArgs;
use rtc_diag::{Code, Diagnostic, DiagnosticLevels, clip_path, codes};
use rtc_front::UpAxis;
use rtc_math::to_u32;
use rtc_passes::Overrides;
use rtc_pipeline::Input;
use rtc_source::{Limits, LoadError, Loader, Resource, Span};
use rtc_study::RenderGoal;
use std::fmt;
use std::ops::Range;
use std::path::{Path, PathBuf};
use trust::ProjectTrust;

/// The name of the file.
const NAME: &str = "rtc.toml";

/// The most bytes of it, and of the user's own settings.
const MAX_BYTES: u64 = 64 << 10;

/// A folder that has one of these is where the search ends.
const END: &str = ".git";

/// The contents of an `rtc.toml`, and its errors.
pub(super) struct Project {
    path: PathBuf,
    bytes: Vec<u8>,
    settings: ProjectSettings,
    faults: Vec<ProjectFileError>,
    /// The reason why it was not read.
    withheld: Option<Withheld>,
}

/// Why a file was not read. Every scene below its folder would fail if that were an error, and the
/// folder may be that of somebody else.
#[derive(Debug)]
enum Withheld {
    /// It is a link out of its folder, or another user could have written it.
    Untrusted(&'static str),
    /// It can't be read.
    Unreadable(LoadError),
}

impl Withheld {
    fn hint(&self) -> &'static str {
        match self {
            Self::Untrusted(_) => "`--trust-project` has it read, unless it is a link",
            Self::Unreadable(_) => "the run goes on without its settings",
        }
    }
}

impl fmt::Display for Withheld {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Untrusted(reason) => f.write_str(reason),
            Self::Unreadable(error) => error.fmt(f),
        }
    }
}

/// Its contents.
#[derive(Default)]
struct ProjectSettings {
    /// Whether it may raise limits.
    is_trusted: bool,
    levels: DiagnosticLevels,
    limits: Vec<(Resource, u64)>,
    asset_root: Option<PathBuf>,
    up_axis: Option<UpAxis>,
    cache: Option<PathBuf>,
    cache_limit: Option<u64>,
    /// Patterns of files for which its folder is not searched.
    exclude: Vec<String>,
    render: Overrides,
}

/// An error in some of its bytes.
struct ProjectFileError {
    code: &'static Code,
    at: Range<usize>,
    message: String,
    hint: Option<String>,
    /// The suggested spelling of these bytes.
    suggestion: Option<String>,
}

impl Project {
    /// The file of a scene: in its folder, or the nearest above up to the root of a repository.
    /// Standard input belongs to the current folder.
    pub(super) fn of(scene: &Path, reading: &ReadArgs) -> Result<Option<Self>, Failure> {
        let Some((path, scenes)) = nearest_file(scene) else {
            return Ok(None);
        };
        let folder = path.parent().unwrap_or(Path::new("")).to_owned();
        let (bytes, withheld) = match content(&path, &folder, reading) {
            Ok(bytes) => (bytes, None),
            Err(reason) => (Vec::new(), Some(reason)),
        };
        let trust = match reading.trust_project || trust::is_listed(&folder)? {
            true => ProjectTrust::Full,
            false => ProjectTrust::Within(scenes),
        };
        let (settings, faults) = read::read(&bytes, &folder, trust);
        // As a person in this folder would name it.
        let here = std::env::current_dir().ok();
        let here = here.and_then(|here| path.strip_prefix(here).ok().map(Path::to_owned));
        Ok(Some(Self {
            path: here.unwrap_or(path),
            bytes,
            settings,
            faults,
            withheld,
        }))
    }

    /// Adds its levels of diagnostics below those of the command line.
    pub(super) fn levels(&self, typed: DiagnosticLevels) -> DiagnosticLevels {
        let mut levels = self.settings.levels.clone();
        levels.override_by(typed);
        levels
    }

    /// Sets the limits that it sets, or lowers them only.
    pub(super) fn set_limits(&self, limits: &mut Limits) {
        for (resource, limit) in &self.settings.limits {
            match self.settings.is_trusted {
                true => limits.set(*resource, *limit),
                false => limits.lower(*resource, *limit),
            }
        }
    }

    /// The axis that points up in its models.
    pub(super) fn up_axis(&self) -> Option<UpAxis> {
        self.settings.up_axis
    }

    /// The folder whose files its scenes may name.
    pub(super) fn asset_root(&self) -> Option<PathBuf> {
        self.settings.asset_root.clone()
    }

    /// The folder of finished pictures, and the most bytes in it.
    pub(super) fn cache(&self) -> (Option<PathBuf>, Option<u64>) {
        (self.settings.cache.clone(), self.settings.cache_limit)
    }

    /// Everything that a picture may depend on: its path and its bytes, and whether it is trusted.
    pub(super) fn identity(&self) -> String {
        let Self {
            path,
            bytes,
            settings,
            faults: _,
            withheld,
        } = self;
        let is_trusted = settings.is_trusted;
        format!("{path:?} {bytes:?} {is_trusted} {withheld:?}")
    }

    /// Adds its diagnostics to those of a scene.
    pub(super) fn report_diagnostics(&self, input: &mut Input) {
        let path = self.path.display().to_string();
        if let Some(reason) = &self.withheld {
            let message = format!("`{}` is not read: {reason}", clip_path(&path));
            let found = Diagnostic::new(&codes::SETTINGS_UNTRUSTED, message);
            return input.push(found.hint(reason.hint()));
        }
        let file = input.add_text(&self.path, self.bytes.clone());
        let message = format!("settings from `{}`", clip_path(&path));
        input.push(Diagnostic::new(&codes::SETTINGS_READ, message));
        for fault in &self.faults {
            let span = Span::new(file, to_u32(fault.at.start), to_u32(fault.at.end));
            let found = Diagnostic::new(fault.code, fault.message.clone()).at(span, "");
            let found = match (&fault.hint, &fault.suggestion) {
                (Some(hint), Some(suggestion)) => {
                    found.guess(hint.clone(), span, suggestion.clone())
                }
                (Some(hint), None) => found.hint(hint.clone()),
                (None, _) => found,
            };
            input.push(found);
        }
    }
}

/// The patterns of files for which a folder without links is not searched, by its own file.
pub(super) fn excluded(folder: &Path) -> Vec<String> {
    let file = Loader.owned(&folder.join(NAME), MAX_BYTES).ok();
    let file = file.filter(|file| file.is_trusted && file.path.starts_with(folder));
    let trust = || ProjectTrust::Within(folder.to_owned());
    let settings = file.map(|file| read::read(&file.bytes, folder, trust()).0);
    settings.map_or_else(Vec::new, |own| own.exclude)
}

/// The settings of pictures of a scene. A compiled scene already has them; a picture with a target
/// has no number of samples.
pub(super) fn picture(
    scene: &Path,
    reading: &ReadArgs,
    goal: RenderGoal,
) -> Result<Overrides, Failure> {
    let is_compiled = scene.extension().is_some_and(|own| own == "rtir");
    let project = Project::of(scene, reading)?.filter(|_| !is_compiled);
    let settled = project.map_or_else(Overrides::default, |own| own.settings.render);
    Ok(match goal {
        RenderGoal {
            error: None,
            time: None,
        } => settled,
        RenderGoal { error: _, time: _ } => Overrides {
            supersampling: None,
            aperture_samples: None,
            spp: None,
            ..settled
        },
    })
}

/// The contents of the file at a path in a folder without links, or the reason why it is not read.
fn content(path: &Path, folder: &Path, reading: &ReadArgs) -> Result<Vec<u8>, Withheld> {
    const LINK: Withheld = Withheld::Untrusted("it is a link that leaves its folder");
    let is_link = path.is_symlink();
    match Loader.owned(path, MAX_BYTES) {
        Ok(file) if !file.path.starts_with(folder) => Err(LINK),
        Ok(file) if !file.is_trusted && !reading.trust_project => Err(Withheld::Untrusted(
            "it belongs to another user, or all may write it",
        )),
        Ok(file) => Ok(file.bytes),
        // Whether a file outside exists is not revealed.
        Err(_) if is_link => Err(LINK),
        Err(LoadError::NotRegular) => Err(Withheld::Untrusted("it is no regular file")),
        Err(error) => Err(Withheld::Unreadable(error)),
    }
}

/// The file that applies to a scene, and the folder of the scene, both without links; the file
/// itself may be a link.
fn nearest_file(scene: &Path) -> Option<(PathBuf, PathBuf)> {
    let own = scene.parent().filter(|own| !own.as_os_str().is_empty());
    let own = own.unwrap_or(Path::new(".")).canonicalize().ok()?;
    for folder in own.ancestors() {
        let path = folder.join(NAME);
        if path.symlink_metadata().is_ok_and(|there| !there.is_dir()) {
            return Some((path, own));
        }
        if folder.join(END).exists() {
            return None;
        }
    }
    None
}
