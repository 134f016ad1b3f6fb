//! The requested output transform, and the file format of a name.

use super::super::Failure;
use super::super::args::{BitDepth, OutputTransformArgs};
use super::super::output::is_stdout;
use rtc_color::Tone;
use rtc_image::FileFormat;
use rtc_pipeline::{OutputTransform, PictureSetup};
use rtc_render::Aov;
use std::path::Path;

/// The requested output transform.
pub(super) fn look(args: &OutputTransformArgs, output: &Path) -> Result<OutputTransform, Failure> {
    let refused = |message: &str| Failure::Trouble(message.to_owned());
    let kind = kind(output, args.bits)?;
    let aovs: Vec<Aov> = args.aov.iter().map(|layer| Aov::from(*layer)).collect();
    let tone = args.tonemap.map(Tone::from);
    let look = OutputTransform::new(kind, tone, args.exposure, args.background.fill(kind), &aovs);
    let mut look = look.map_err(refused)?;
    if matches!(kind, FileFormat::Jpeg | FileFormat::Webp) && !aovs.is_empty() {
        return Err(refused(
            "layers need a PNG, with files beside it, or an EXR",
        ));
    }
    look.has_metadata = !args.no_metadata;
    Ok(look)
}

/// Refuses layers that would be files beside a picture, where it is the only file.
pub(crate) fn refuse_layers(setup: &PictureSetup) -> Result<(), Failure> {
    if setup.look.kind.is_linear() || setup.look.aovs.is_empty() {
        return Ok(());
    }
    Err(Failure::Trouble(
        "the layers of a PNG are files beside it, where a whole picture is rendered into a file; \
         name the picture .exr, which holds them"
            .to_owned(),
    ))
}

/// The pixel file format of a name.
pub(crate) fn kind(output: &Path, bits: Option<BitDepth>) -> Result<FileFormat, Failure> {
    let extension = output
        .extension()
        .map(|extension| extension.to_string_lossy().to_lowercase());
    let is_stdout = is_stdout(output);
    match (extension.as_deref(), bits) {
        (Some("exr"), Some(BitDepth::ThirtyTwo) | None) => Ok(FileFormat::Exr),
        (Some("exr"), Some(BitDepth::Sixteen)) => Ok(FileFormat::ExrHalf),
        (Some("exr"), Some(BitDepth::Eight)) => Err(Failure::Trouble(
            "an EXR holds floats of 16 or 32 bits; leave out `--bits 8`".to_owned(),
        )),
        (Some("png"), Some(BitDepth::ThirtyTwo)) => Err(Failure::Trouble(
            "a PNG has 8 or 16 bits a channel; name the picture .exr".to_owned(),
        )),
        (Some("png"), Some(BitDepth::Sixteen)) => Ok(FileFormat::Png16),
        (Some("png"), Some(BitDepth::Eight) | None) => Ok(FileFormat::Png8),
        (Some("jpg" | "jpeg"), None) => Ok(FileFormat::Jpeg),
        (Some("webp"), None) => Ok(FileFormat::Webp),
        (Some("jpg" | "jpeg" | "webp"), Some(_)) => Err(Failure::Trouble(
            "`--bits` is for PNG and EXR; a JPEG or WebP has 8".to_owned(),
        )),
        (None, Some(BitDepth::Sixteen)) if is_stdout => Ok(FileFormat::Png16),
        (None, Some(BitDepth::Eight) | None) if is_stdout => Ok(FileFormat::Png8),
        _ => Err(Failure::Trouble(format!(
            "unknown picture format `{}`; use .png, .jpg, .webp or .exr",
            output.display()
        ))),
    }
}
