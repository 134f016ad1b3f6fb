//! The layers of a PNG: pictures of their own beside it, as `picture.depth.png`.

use super::super::Failure;
use super::super::interrupt::Interrupt;
use super::super::output::Output;
use rtc_image::Picture;
use rtc_pipeline::{Input, OutputTransform, PictureSetup, RenderSubject};
use rtc_render::Aov;
use std::path::Path;

/// The destination of the layers of a picture; none if its own file holds them.
pub(super) struct LayerFiles(Vec<(Aov, Output)>);

/// The destination of each layer with its encoded bytes.
pub(super) struct EncodedLayers(Vec<(Output, Vec<u8>)>);

impl LayerFiles {
    /// Those beside a picture, fit to be written.
    pub(super) fn open(
        look: &OutputTransform,
        path: &Path,
        input: &Input,
    ) -> Result<Self, Failure> {
        if look.kind.is_linear() {
            return Ok(Self(Vec::new()));
        }
        let open = |aov: &Aov| {
            let extension = look.kind.traits().extensions[0];
            let path = path.with_extension(format!("{}.{extension}", aov.name()));
            Ok((*aov, Output::open(&path, input)?))
        };
        look.aovs
            .iter()
            .map(open)
            .collect::<Result<_, _>>()
            .map(Self)
    }

    /// The files of the layers of a picture.
    pub(super) fn encode(
        self,
        setup: &PictureSetup,
        picture: &Picture,
        subject: &RenderSubject,
    ) -> Result<EncodedLayers, Failure> {
        let encode = |(aov, output)| Ok((output, setup.encode_layer(aov, picture, subject)?));
        let encoded = self.0.into_iter().map(encode);
        encoded.collect::<Result<_, Failure>>().map(EncodedLayers)
    }
}

impl EncodedLayers {
    /// Writes them.
    pub(super) fn commit(self, interrupt: &Interrupt) -> Result<(), Failure> {
        let mut files = self.0.into_iter();
        files.try_for_each(|(output, bytes)| output.commit(&bytes, interrupt))
    }
}
