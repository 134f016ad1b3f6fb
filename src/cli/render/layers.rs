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
        let open = |aov: &Aov| {
            let extension = look.kind.traits().extensions[0];
            let path = path.with_extension(format!("{}.{extension}", aov.name()));
            Ok((*aov, Output::open_unless_read(&path, read)?))
        };
        let opened = separate(look).iter().map(open);
        opened.collect::<Result<_, _>>().map(Self)
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

    /// Writes their bytes.
    pub(super) fn commit(self, files: &[Vec<u8>], interrupt: &Interrupt) -> Result<(), Failure> {
        let mut files = self.0.into_iter().zip(files);
        files.try_for_each(|((_, output), bytes)| output.commit(bytes, interrupt))
    }
}

/// The layers of a picture that have files of their own: a linear one holds them itself.
pub(super) fn separate(look: &OutputTransform) -> &[Aov] {
    match look.kind.is_linear() {
        true => &[],
        false => &look.aovs,
    }
}
