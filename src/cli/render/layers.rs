//! The layers of a PNG: pictures of their own beside it, as `picture.depth.png`.

use super::super::Failure;
use super::super::interrupt::Interrupt;
use super::super::output::Output;
use rtc_image::Picture;
use rtc_pipeline::{OutputTransform, PictureSetup, RenderSubject};
use rtc_render::Aov;
use rtc_source::SourceMap;
use std::path::Path;

/// The destination of the layers of a picture; none if its own file holds them.
pub(super) struct LayerFiles(Vec<(Aov, Output)>);

impl LayerFiles {
    /// Those beside a picture, fit to be written.
    pub(super) fn open(
        look: &OutputTransform,
        path: &Path,
        read: &SourceMap,
    ) -> Result<Self, Failure> {
        if look.kind.is_linear() {
            return Ok(Self(Vec::new()));
        }
        let open = |aov: &Aov| {
            let extension = look.kind.traits().extensions[0];
            let path = path.with_extension(format!("{}.{extension}", aov.name()));
            Ok((*aov, Output::open_unless_read(&path, read)?))
        };
        look.aovs
            .iter()
            .map(open)
            .collect::<Result<_, _>>()
            .map(Self)
    }

    /// The files of the layers of a picture.
    pub(super) fn encode(
        &self,
        setup: &PictureSetup,
        picture: &Picture,
        subject: &RenderSubject,
    ) -> Result<Vec<Vec<u8>>, Failure> {
        let encode = |(aov, _): &(Aov, Output)| Ok(setup.encode_layer(*aov, picture, subject)?);
        self.0.iter().map(encode).collect()
    }

    /// The number of files of a picture with this output transform.
    pub(super) fn count(look: &OutputTransform) -> usize {
        if look.kind.is_linear() {
            0
        } else {
            look.aovs.len()
        }
    }

    /// Writes their bytes.
    pub(super) fn commit(self, files: &[Vec<u8>], interrupt: &Interrupt) -> Result<(), Failure> {
        let mut files = self.0.into_iter().zip(files);
        files.try_for_each(|((_, output), bytes)| output.commit(bytes, interrupt))
    }
}
