//! The requested output transform, and the file format of a name.

use super::super::Failure;
use super::super::args::{BitDepthArg, OutputTransformArgs};
use super::super::output::is_stdout;
use super::layers::separate;
use rtc_color::Tone;
use rtc_image::FileFormat;
use rtc_pipeline::{OutputTransform, PictureSetup};
use rtc_render::Aov;
use std::path::Path;

/// The requested output transform.
pub(super) fn look(args: &OutputTransformArgs, output: &Path) -> Result<OutputTransform, Failure> {
    let refused = |message: &str| Failure::Failed(message.to_owned());
    let kind = kind(output, args.bits)?;
    let aovs: Vec<Aov> = args.aov.iter().map(|layer| Aov::from(*layer)).collect();
    let tone = args.tonemap.map(Tone::from);
    let look = OutputTransform::new(kind, tone, args.exposure, args.background.fill(kind), &aovs);
    let mut look = look.map_err(refused)?;
    if !kind.traits().has_layers && !aovs.is_empty() {
        return Err(refused(
            "layers need a PNG, with files beside it, or an EXR",
        ));
    }
    look.has_metadata = !args.no_metadata;
    Ok(look)
}

/// Refuses layers that would be files beside a picture, where it is the only file.
pub(crate) fn refuse_layers(setup: &PictureSetup) -> Result<(), Failure> {
    if separate(&setup.look).is_empty() {
        return Ok(());
    }
    Err(Failure::Failed(
        "the layers of a PNG are files beside it, where a whole picture is rendered into a file; \
         name the picture .exr, which holds them"
            .to_owned(),
    ))
}

/// The pixel file format of a name.
pub(crate) fn kind(output: &Path, bits: Option<BitDepthArg>) -> Result<FileFormat, Failure> {
    let extension = output
        .extension()
        .map(|extension| extension.to_string_lossy().to_lowercase());
    let extension = extension.or_else(|| is_stdout(output).then(|| "png".to_owned()));
    let has_name = |form: &FileFormat| {
        let names = form.traits().extensions;
        extension.as_deref().is_some_and(|own| names.contains(&own))
    };
    let forms = || FileFormat::ALL.into_iter().filter(has_name);
    let Some(usual) = forms().next() else {
        let mut names = FileFormat::ALL
            .map(|form| form.traits().extensions[0])
            .to_vec();
        names.dedup();
        let last = names.pop().unwrap_or_default();
        return Err(Failure::Failed(format!(
            "unknown picture format `{}`; use .{} or .{last}",
            output.display(),
            names.join(", .")
        )));
    };
    let wanted = bits.map_or(usual.traits().bits, BitDepthArg::bits);
    forms()
        .find(|form| form.traits().bits == wanted)
        .ok_or_else(|| {
            let known: Vec<_> = forms().map(|form| form.traits().bits.to_string()).collect();
            let name = usual.traits().name;
            let known = known.join(" or ");
            Failure::Failed(format!(
                "the channels of {name} files have {known} bits, not {wanted}"
            ))
        })
}
