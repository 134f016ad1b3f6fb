//! Suggestions for mistyped commands: a missing subcommand, or the equivalent of another renderer's
//! flag.

use super::args::{Cli, Command};
use super::input;
use super::parse::size;
use clap::builder::StyledStr;
use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{Error, Parser};
use rtc_diag::clip_words;
use rtc_front::is_scene_name;
use rtc_ir::{Mode, Scene};
use rtc_passes::Overrides;
use std::ffi::OsString;
use std::path::Path;

/// Flags of other renderers for the samples of a pixel.
const SAMPLES: [&str; 4] = ["--samples", "--sample-count", "--aa", "--antialiasing"];

/// Flags of other renderers for the size of a picture.
const SIZES: [&str; 4] = ["--width", "--height", "--resolution", "--res"];

/// Adds suggestions to an argument error, given the arguments with the name of the program.
pub(super) fn suggest(error: &mut Error, typed: &[OsString]) {
    let tip = if error.kind() == ErrorKind::InvalidSubcommand {
        verb(typed)
    } else if error.kind() == ErrorKind::UnknownArgument {
        flag(error, typed)
    } else {
        None
    };
    let Some(tip) = tip else { return };
    error.remove(ContextKind::SuggestedArg);
    error.remove(ContextKind::SuggestedSubcommand);
    let tip = ContextValue::StyledStrs(vec![StyledStr::from(tip)]);
    error.insert(ContextKind::Suggested, tip);
}

/// The subcommand that was left out before a scene.
fn verb(typed: &[OsString]) -> Option<String> {
    let path = Path::new(typed.get(1)?);
    let name = path.to_string_lossy();
    let is_scene = is_scene_name(&name) || path.is_file();
    is_scene.then(|| format!("did you mean `rtc render {}`?", clip_words(&name)))
}

/// The flag that is equivalent to an unknown one.
fn flag(error: &Error, typed: &[OsString]) -> Option<String> {
    let Some(ContextValue::String(wrong)) = error.get(ContextKind::InvalidArg) else {
        return None;
    };
    let is_samples = SAMPLES.contains(&wrong.as_str());
    if !is_samples && !SIZES.contains(&wrong.as_str()) {
        return None;
    }
    let (kept, foreign_flags) = without_foreign_flags(typed);
    let scene = scene(&kept)?;
    let value = |flag: &str| {
        let found = foreign_flags.iter().rev().find(|(name, _)| name == flag);
        found.and_then(|(_, value)| value.as_deref())
    };
    Some(if is_samples {
        samples(scene.as_ref(), value(wrong).and_then(|n| n.parse().ok()))
    } else {
        let sides = ["--width", "--height"].map(|side| value(side).and_then(|n| n.parse().ok()));
        let whole = value(wrong).filter(|_| wrong.starts_with("--res"));
        pixels(
            scene.as_ref(),
            sides,
            whole.and_then(|text| size(text).ok()),
        )
    })
}

/// A flag, and the value that it was given.
type RequestedFlag = (String, Option<String>);

/// The arguments without the flags of other renderers, and those flags.
fn without_foreign_flags(typed: &[OsString]) -> (Vec<OsString>, Vec<RequestedFlag>) {
    let (mut kept, mut foreign_flags) = (Vec::new(), Vec::new());
    let mut arguments = typed.iter().peekable();
    while let Some(argument) = arguments.next() {
        let text = argument.to_string_lossy();
        let (name, value) = match text.split_once('=') {
            Some((name, value)) => (name, Some(value.to_owned())),
            None => (text.as_ref(), None),
        };
        if !SAMPLES.contains(&name) && !SIZES.contains(&name) {
            kept.push(argument.clone());
            continue;
        }
        let is_value = |next: &&OsString| {
            let next = next.to_string_lossy();
            next.starts_with(|first: char| first.is_ascii_digit()) && !Path::new(&*next).exists()
        };
        let value = value.or_else(|| {
            let next = arguments.next_if(is_value)?;
            Some(next.to_string_lossy().into_owned())
        });
        foreign_flags.push((name.to_owned(), value));
    }
    (kept, foreign_flags)
}

/// The scene of a command that makes pictures, if it can be read; `None` of another command.
#[expect(
    clippy::option_option,
    reason = "a command without a scene is not one without a picture"
)]
fn scene(kept: &[OsString]) -> Option<Option<Scene>> {
    let is_verb = |argument: &OsString| argument == "render" || argument == "farm";
    if !kept.get(1).is_some_and(is_verb) {
        return None;
    }
    let command = Cli::try_parse_from(kept).ok().map(|cli| cli.command);
    let (file, reading, stage) = match &command {
        Some(Command::Render(args)) => (args.file(), &args.reading, &args.stage),
        Some(Command::Farm(args)) => (args.file.as_path(), &args.reading, &args.stage),
        _ => return Some(None),
    };
    if file.as_os_str() == "-" {
        return Some(None);
    }
    let input = input::staged(file, reading, stage).ok();
    let validated = input.and_then(|mut input| {
        let loaded = input.load()?;
        input.validate(loaded, |_, _| ())
    });
    Some(validated.map(|validated| validated.lowered.scene))
}

/// The flag for a number of samples per pixel.
fn samples(scene: Option<&Scene>, count: Option<u32>) -> String {
    match scene.map(|scene| &scene.settings.mode) {
        Some(Mode::Path(_)) => {
            let count = count.map_or_else(|| "N".to_owned(), |count| count.to_string());
            format!("`--spp {count}` is for this scene, whose paths are traced")
        }
        Some(Mode::Depth) => "this scene takes one sample a pixel".to_owned(),
        Some(Mode::Phong | Mode::Gooch(_) | Mode::Normal) => {
            let side = count.map_or_else(|| "N".to_owned(), |count| side(count).to_string());
            format!("`--supersampling {side}` is for this scene: {side}×{side} samples a pixel")
        }
        None => "`--spp N` is for scenes whose paths are traced, `--supersampling N` for others"
            .to_owned(),
    }
}

/// The side of the smallest square with at least this many sub-samples.
fn side(count: u32) -> u32 {
    let root = count.isqrt();
    root + u32::from(root * root < count)
}

/// The flag for a picture of this width, this height or this size; one side alone keeps the shape
/// of the picture.
fn pixels(scene: Option<&Scene>, sides: [Option<u32>; 2], whole: Option<[u32; 2]>) -> String {
    let scaled = |side: u32, [own, other]: [u32; 2]| {
        let scaled = f64::from(side) * f64::from(other) / f64::from(own);
        (scaled.round() as u32).max(1)
    };
    let own = scene.map(|scene| scene.camera.size);
    let size = match (sides, own) {
        ([Some(width), Some(height)], _) => Some([width, height]),
        ([Some(width), None], Some(own)) => Some([width, scaled(width, own)]),
        ([None, Some(height)], Some([w, h])) => Some([scaled(height, [h, w]), height]),
        _ => whole,
    };
    match size.filter(|size| !size.contains(&0)) {
        Some([width, height]) => format!("did you mean `--size {width}x{height}`?"),
        None => "`--size WxH` sets width and height in pixels".to_owned(),
    }
}

/// The message for requested samples that a scene does not use, if any.
pub(super) fn idle(foreign_flags: &Overrides, mode: &Mode) -> Option<&'static str> {
    let (is_spp, is_side) = (
        foreign_flags.spp.is_some(),
        foreign_flags.supersampling.is_some(),
    );
    match mode {
        Mode::Path(_) => is_side.then_some(
            "warning: `--supersampling` has no effect: the scene is path-traced; `--spp N` traces \
            N paths in each pixel",
        ),
        Mode::Depth => is_spp.then_some(
            "warning: `--spp` has no effect: the scene is not \
        path-traced",
        ),
        Mode::Phong | Mode::Gooch(_) | Mode::Normal => is_spp.then_some(
            "warning: `--spp` has no effect: the scene is not path-traced; `--supersampling N` \
            takes N×N samples in each pixel",
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flags_of_other_renderers_are_set_apart_with_their_values() {
        let typed = "rtc render --width=64 a.yaml --height 48 --samples --res x".split(' ');
        let typed: Vec<OsString> = typed.map(OsString::from).collect();
        let (kept, foreign_flags) = without_foreign_flags(&typed);
        assert_eq!(kept, ["rtc", "render", "a.yaml", "x"]);
        let foreign_flags: Vec<_> = foreign_flags
            .iter()
            .map(|(name, value)| (name.as_str(), value.as_deref()))
            .collect();
        let wanted = [
            ("--width", Some("64")),
            ("--height", Some("48")),
            ("--samples", None),
            ("--res", None),
        ];
        assert_eq!(foreign_flags, wanted);
    }

    #[test]
    fn a_square_has_no_fewer_samples_than_asked_for() {
        assert_eq!([1, 2, 16, 17, u32::MAX].map(side), [1, 2, 4, 5, 65_536]);
    }
}
