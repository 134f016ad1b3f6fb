//! Two pictures from files.

use super::super::Failure;
use super::super::args::Diff;
use super::super::interrupt::Interrupt;
use super::super::output::Output;
use super::{DiffOutputs, report};
use rtc_image::ShownPicture;
use rtc_source::{Loader, SourceMap};
use std::path::Path;

/// The largest picture file that is read, in bytes.
const MAX_BYTES: u64 = 1 << 32;

/// The most pixels of a picture, unless more are allowed: some 200 bytes each are taken for two pictures
/// and what the eye makes of them.
const MAX_PIXELS: u64 = 1 << 25;

/// Compares two pictures, and says how they differ.
pub(super) fn run(args: &Diff) -> Result<(), Failure> {
    let interrupt = Interrupt::listen()?;
    let map = SourceMap::default();
    let (new, old) = (read(&args.new, args, &map)?, read(&args.old, args, &map)?);
    fitting(args, &new, &old)?;
    let open = |path: &Option<_>| {
        let path: Option<&Path> = path.as_deref();
        path.map(|path| Output::apart_from(path, &map)).transpose()
    };
    let outputs = DiffOutputs {
        map: open(&args.output)?,
        page: open(&args.html)?,
    };
    report(args, outputs, [&new, &old], None, &interrupt)
}

fn read(path: &Path, args: &Diff, map: &SourceMap) -> Result<ShownPicture, Failure> {
    let name = path.display();
    let bytes = Loader.bytes(path, MAX_BYTES, map);
    let bytes = bytes.map_err(|error| Failure::Trouble(format!("`{name}`: {error}")))?;
    let most = if args.reading.allow_huge {
        u64::MAX
    } else {
        MAX_PIXELS
    };
    ShownPicture::read(&bytes, most).map_err(|error| Failure::Trouble(format!("`{name}` {error}")))
}

/// Refuses pictures that can't be compared.
fn fitting(args: &Diff, picture: &ShownPicture, reference: &ShownPicture) -> Result<(), Failure> {
    let size = |picture: &ShownPicture| [picture.display.width, picture.display.height];
    let names = [&args.new, &args.old].map(|path| path.display());
    let [a, b] = [size(picture), size(reference)];
    if a != b {
        return Err(Failure::Trouble(format!(
            "pictures of one size are compared: `{}` has {} × {} pixels, `{}` {} × {}",
            names[0], a[0], a[1], names[1], b[0], b[1]
        )));
    }
    if picture.linear.is_some() != reference.linear.is_some() {
        let light = usize::from(reference.linear.is_some());
        return Err(Failure::Trouble(format!(
            "`{}` holds values of light, and `{}` those of a display: compare two of a kind",
            names[light],
            names[1 - light]
        )));
    }
    Ok(())
}
