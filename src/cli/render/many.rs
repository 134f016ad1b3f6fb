//! Pictures of many scenes in sequence: failures are reported, the others continue.

use super::super::output::check_folder;
use super::super::reporter::{self, Reporter};
use super::super::{Failure, args, files, interrupt};
use super::sheet::ContactSheet;
use super::{RenderSetup, stem};
use rtc_pipeline::FolderIdentity;
use std::collections::{BTreeMap, BTreeSet};
use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf, is_separator};
use std::{fs, io};

/// Stands for the name of a scene without its extension.
const STEM: &str = "{stem}";

/// Stands for the folder of a scene, within the folder that was given.
const DIR: &str = "{dir}";

/// A scene, and the destination of its picture.
pub(super) struct RenderJob {
    scene: PathBuf,
    output: PathBuf,
    /// The number of folders of the destination that may be made.
    depth: usize,
}

/// The scenes and their pictures; `None` of one scene whose picture has a name of its own.
pub(super) fn jobs(args: &args::RenderArgs) -> Result<Option<Vec<RenderJob>>, Failure> {
    // Find the scenes.
    let found = files::scenes(&args.files, false)?;
    found.report_skipped(args.reporter.quiet);
    let scenes = found.paths;
    let destination = Destination::new(args.output.as_deref());
    // One file is rendered by itself.
    if scenes == args.files && scenes.len() == 1 && !destination.is_for_many() {
        return match &args.contact_sheet {
            None => Ok(None),
            Some(_) => Err(Failure::Failed(
                "`--contact-sheet` is for many scenes; give a folder, a pattern or more of them"
                    .to_owned(),
            )),
        };
    }
    // Several scenes need a picture of their own each.
    let refused = |message: &str| Err(Failure::Failed(message.to_owned()));
    if args.part.is_some() || args.checkpoint.is_some() {
        return refused(
            "`--part` and `--checkpoint` are for one scene and a picture of its own name",
        );
    }
    if let Destination::One(output) = &destination {
        return refused(&format!(
            "`{}` is one picture, and there are {} scenes; give `-o FOLDER/` or `-o '{STEM}.png'`",
            output.display(),
            scenes.len()
        ));
    }
    // Name the picture of each scene. Where names are equal, pictures lie as their scenes do.
    let jobs = |is_mirrored: bool| {
        let job = |(scene, folder): (&PathBuf, &PathBuf)| {
            let dir: &Path = if is_mirrored { folder } else { Path::new("") };
            let output = destination.of(dir, stem(scene, args)?);
            Ok(RenderJob {
                scene: scene.clone(),
                output,
                depth: dir.components().count() + 1,
            })
        };
        let jobs = scenes.iter().zip(&found.folders).map(job);
        jobs.collect::<Result<Vec<_>, Failure>>()
    };
    let has_pattern = matches!(destination, Destination::Pattern(_));
    let mut named = jobs(has_pattern)?;
    if !has_pattern && refuse_same(&named).is_err() {
        named = jobs(true)?;
    }
    refuse_same(&named)?;
    Ok(Some(named))
}

/// Refuses two pictures of one name.
fn refuse_same(jobs: &[RenderJob]) -> Result<(), Failure> {
    let mut taken = BTreeMap::new();
    for RenderJob { scene, output, .. } in jobs {
        if let Some(other) = taken.insert(output, scene) {
            let [output, other, scene] = [output, other, scene].map(|path| path.display());
            return Err(Failure::Failed(format!(
                "`{output}` would be the picture of both `{other}` and `{scene}`; \
                `-o '{DIR}/{STEM}.png'` names the folder of each"
            )));
        }
    }
    Ok(())
}

/// Where pictures go.
enum Destination<'a> {
    /// Here, by the names of their scenes.
    Here,
    /// Into this folder, by the names of their scenes.
    Folder(&'a Path),
    /// A name that contains [`STEM`] or [`DIR`].
    Pattern(&'a str),
    /// A destination for one picture.
    One(&'a Path),
}

impl<'a> Destination<'a> {
    fn new(output: Option<&'a Path>) -> Self {
        let Some(output) = output else {
            return Self::Here;
        };
        // A folder that is named as a picture is in its way.
        let is_folder = output.extension().is_none() && output.is_dir();
        match output.to_str() {
            Some(text) if [STEM, DIR].iter().any(|own| text.contains(own)) => Self::Pattern(text),
            Some(text) if text.ends_with(is_separator) || is_folder => Self::Folder(output),
            None if is_folder => Self::Folder(output),
            Some(_) | None => Self::One(output),
        }
    }

    /// Whether the argument is a destination for several pictures.
    fn is_for_many(&self) -> bool {
        matches!(self, Self::Folder(_) | Self::Pattern(_))
    }

    /// The destination for the picture of a scene in a folder.
    fn of(&self, dir: &Path, stem: &OsStr) -> PathBuf {
        let named = || dir.join(Path::new(stem).with_added_extension("png"));
        match self {
            Self::Here => named(),
            Self::Folder(folder) => folder.join(named()),
            Self::Pattern(pattern) => {
                let here = OsStr::new(".");
                let dir = if dir.as_os_str().is_empty() {
                    here
                } else {
                    dir.as_os_str()
                };
                let with_dir = |piece: &str| joined(piece.split(DIR).map(OsString::from), dir);
                joined(pattern.split(STEM).map(with_dir), stem).into()
            }
            Self::One(output) => output.to_path_buf(),
        }
    }
}

/// Pieces of a name with another between them.
fn joined(pieces: impl Iterator<Item = OsString>, between: &OsStr) -> OsString {
    let mut name = OsString::new();
    for (number, piece) in pieces.enumerate() {
        if number > 0 {
            name.push(between);
        }
        name.push(piece);
    }
    name
}

/// Renders the scenes and writes their pictures.
pub(super) fn run(
    mut args: args::RenderArgs,
    jobs: Vec<RenderJob>,
    typed: &[OsString],
) -> Result<(), Failure> {
    let (mut plans, mut depths) = (Vec::new(), Vec::new());
    for RenderJob {
        scene,
        output,
        depth,
    } in jobs
    {
        // Errors of the command are reported once, before any file is read.
        args.files = vec![scene.clone()];
        args.output = Some(output);
        plans.push((scene, RenderSetup::new(&args, typed)?));
        depths.push(depth);
    }
    let sheet = args.contact_sheet.as_deref();
    let sheet = sheet
        .map(|path| ContactSheet::new(path, &plans))
        .transpose()?;
    let mut made = Vec::new();
    let mut folders = Vec::new();
    for ((_, plan), depth) in plans.iter().zip(depths) {
        make_folders(&plan.output, depth, &mut made)?;
        folders.push(FolderIdentity::of_file(&plan.output).ok());
    }
    let mut reporter = Reporter::beside_result(&args.reporter);
    let mut shown = BTreeSet::new();
    let outcome = carry_out((plans, &folders), &args, &mut reporter, &mut shown);
    let outcome = match sheet {
        Some(sheet) if !interrupt::is_heard() => sheet.write(&shown).and(outcome),
        Some(_) | None => outcome,
    };
    // Those that hold no picture go again; the others stay.
    for folder in made.iter().rev() {
        let _ = fs::remove_dir(folder);
    }
    reporter.finish()?;
    outcome
}

/// Makes the folder of a picture and those above it, so many at most, and notes them.
fn make_folders(output: &Path, depth: usize, made: &mut Vec<PathBuf>) -> Result<(), Failure> {
    let folders = output.ancestors().skip(1).take(depth);
    let missing = folders.take_while(|folder| !folder.as_os_str().is_empty() && !folder.is_dir());
    let missing: Vec<&Path> = missing.collect();
    for folder in missing.into_iter().rev() {
        let trouble = |error: io::Error| {
            Failure::Failed(format!("can't make `{}`: {error}", folder.display()))
        };
        fs::create_dir(folder).map_err(trouble)?;
        made.push(folder.to_owned());
    }
    Ok(())
}

/// Goes on after a failure, unless it is the end of all; notes the pictures that are made.
fn carry_out(
    (plans, folders): (Vec<(PathBuf, RenderSetup)>, &[Option<FolderIdentity>]),
    args: &args::RenderArgs,
    reporter: &mut Reporter,
    made: &mut BTreeSet<PathBuf>,
) -> Result<(), Failure> {
    let (all, mut failed) = (plans.len(), 0);
    // Each scene is rendered with its own clock.
    for (number, ((scene, plan), folder)) in plans.into_iter().zip(folders).enumerate() {
        if number > 0 {
            plan.clock.restart();
        }
        if interrupt::is_heard() {
            return Err(Failure::Interrupted);
        }
        // One that fails does not stop the others.
        let output = plan.output.clone();
        let folder = folder.as_ref();
        let is_there = folder.map_or(Ok(()), |folder| check_folder(folder, &output));
        match is_there.and_then(|()| plan.begin(&scene, args, reporter)) {
            Ok(()) => {
                made.insert(output);
                continue;
            }
            Err(end @ (Failure::Interrupted | Failure::ClosedPipe)) => return Err(end),
            Err(Failure::Reported | Failure::Unreadable) => {}
            Err(Failure::Input(message) | Failure::Failed(message)) => {
                reporter::print_message(&format!("error: `{}`: {message}", scene.display()));
            }
        }
        failed += 1;
    }
    // The exit code tells whether any failed.
    match failed {
        0 => Ok(()),
        _ if interrupt::is_heard() => Err(Failure::Interrupted),
        _ => Err(Failure::Input(format!(
            "{failed} of {all} scenes have no picture"
        ))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_of_many_holds_the_stem() {
        let destination = |output| Destination::new(Some(Path::new(output)));
        let of = |output, dir: &str, stem| destination(output).of(Path::new(dir), OsStr::new(stem));
        assert_eq!(
            of("out/{stem}-{stem}.exr", "x", "a"),
            Path::new("out/a-a.exr")
        );
        assert_eq!(
            of("out/{dir}/{stem}.exr", "x/y", "a"),
            Path::new("out/x/y/a.exr")
        );
        assert_eq!(of("out/{dir}/{stem}.exr", "", "a"), Path::new("out/a.exr"));
        assert_eq!(of("out/", "", "a.b"), Path::new("out/a.b.png"));
        assert_eq!(of("out/", "x", "a"), Path::new("out/x/a.png"));
        assert!(!destination("a.png").is_for_many() && !destination("-").is_for_many());
    }
}
