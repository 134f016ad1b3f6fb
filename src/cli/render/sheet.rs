//! The contact sheet of many scenes: their pictures, as their files show them.

use super::super::Failure;
use super::super::interrupt::Interrupt;
use super::super::output::Output;
use super::RenderSetup;
use rtc_image::{DisplayedPicture, FileFormat, Picture, contact_sheet, for_sheet};
use rtc_source::{Loader, SourceMap};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// The most pictures of a sheet.
const MOST: usize = 2048;

/// The largest picture file that is read, in bytes.
const MAX_BYTES: u64 = 1 << 32;

/// A sheet to be, and the pictures that it shows.
pub(super) struct ContactSheet {
    output: Output,
    pictures: Vec<PathBuf>,
}

impl ContactSheet {
    /// A sheet of the pictures of these renders, which are not made yet. It is none of them.
    pub(super) fn new(path: &Path, plans: &[(PathBuf, RenderSetup)]) -> Result<Self, Failure> {
        let name = path.display();
        let refused = |message: String| Err(Failure::Failed(message));
        if !path
            .extension()
            .is_some_and(|extension| extension.eq_ignore_ascii_case("png"))
        {
            return refused(format!("a contact sheet is a PNG; name `{name}` so"));
        }
        if plans.len() > MOST {
            return refused(format!("a contact sheet shows at most {MOST} pictures"));
        }
        let mut taken = plans.iter().flat_map(|(scene, plan)| [scene, &plan.output]);
        if taken.any(|taken| taken == path) {
            return refused(format!(
                "`{name}` would be the contact sheet and another file"
            ));
        }
        let output = Output::open_unless_read(path, &SourceMap::default())?;
        let pictures = plans.iter().map(|(_, plan)| plan.output.clone());
        Ok(Self {
            output,
            pictures: pictures.collect(),
        })
    }

    /// Reads the pictures that were made and writes the sheet.
    pub(super) fn write(self, made: &BTreeSet<PathBuf>) -> Result<(), Failure> {
        let pictures = self.pictures.iter().map(|path| {
            let name = path
                .file_name()
                .unwrap_or_default()
                .to_string_lossy()
                .into_owned();
            // An existing picture of a failed scene is an old one.
            let path = made.get(path);
            let bytes =
                path.and_then(|path| Loader.bytes(path, MAX_BYTES, &SourceMap::default()).ok());
            let read = bytes.and_then(|bytes| DisplayedPicture::read(&bytes, u64::MAX).ok());
            (name, read.map(|picture| for_sheet(picture.image())))
        });
        let sheet = contact_sheet(&pictures.collect::<Vec<_>>());
        let bytes = Picture::opaque(sheet).encode(FileFormat::Png8);
        let bytes = bytes.map_err(|error| Failure::Failed(error.to_string()))?;
        self.output.commit(&bytes, &Interrupt::listen()?)
    }
}
