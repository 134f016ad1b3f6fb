//! A picture that was rendered.

use super::{Aov, Error, Finding, Format, Tone};
use rtc_color::quantize8;
use rtc_image::{self as image, Origin};
use rtc_pipeline::ResolvedOutputTransform;
use rtc_render::Counts;

/// A picture: rows from the top, each from the left.
#[derive(Clone, Debug)]
pub struct Picture {
    held: image::Picture,
    look: ResolvedOutputTransform,
    origin: Origin,
    format: Format,
    statistics: Statistics,
    error: Option<f64>,
    findings: Vec<Finding>,
}

/// What a picture took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Statistics {
    /// All rays.
    pub rays: u64,
    /// Those from the eye.
    pub camera_rays: u64,
    /// Those from the eye that hit a surface.
    pub hits: u64,
    /// Those to a light.
    pub shadow_rays: u64,
}

impl Picture {
    pub(super) fn new(
        (held, look, origin): (image::Picture, ResolvedOutputTransform, Origin),
        format: Format,
        (counts, error): (&Counts, Option<f64>),
        findings: Vec<Finding>,
    ) -> Self {
        Self {
            held,
            look,
            origin,
            format,
            statistics: Statistics {
                rays: counts.rays(),
                camera_rays: counts.camera,
                hits: counts.hits,
                shadow_rays: counts.shadow,
            },
            error,
            findings,
        }
    }

    /// Width in pixels.
    #[must_use]
    pub fn width(&self) -> u32 {
        self.held.image.width
    }

    /// Height in pixels.
    #[must_use]
    pub fn height(&self) -> u32 {
        self.held.image.height
    }

    /// Red, green and blue of each pixel: of [`Format::Exr`] linear (Rec. 709), times the opacity
    /// where there is one; else as displayed, where [0, 1] is shown.
    #[must_use]
    pub fn pixels(&self) -> &[[f64; 3]] {
        &self.held.image.pixels
    }

    /// The opacity of each pixel in [0, 1]; `None` if all are opaque.
    #[must_use]
    pub fn alpha(&self) -> Option<&[f32]> {
        self.held.alpha.as_deref()
    }

    /// Red, green, blue and opacity of each pixel in a byte each, as a display shows them, opacity
    /// straight; linear values are coded by sRGB.
    #[must_use]
    pub fn rgba8(&self) -> Vec<u8> {
        let alpha = |index: usize| self.alpha().map_or(1.0, |alpha| f64::from(alpha[index]));
        let shown = |index: usize, pixel: [f64; 3]| match self.format {
            Format::Png | Format::Png16 => pixel,
            Format::Exr | Format::ExrHalf if alpha(index) > 0.0 => {
                Tone::Srgb.display(pixel.map(|value| value / alpha(index)))
            }
            Format::Exr | Format::ExrHalf => [0.0; 3],
        };
        let pixels = self.pixels().iter().enumerate();
        let bytes = pixels.flat_map(|(index, pixel)| {
            let [r, g, b] = shown(index, *pixel);
            [r, g, b, alpha(index)].map(quantize8)
        });
        bytes.collect()
    }

    /// A layer that was asked for: the values of [`Aov::channels`], pixel after pixel.
    #[must_use]
    pub fn layer(&self, aov: Aov) -> Option<Vec<f32>> {
        let image::Layers { names, values } = &self.held.layers;
        let channels = aov.channels();
        let first = names
            .iter()
            .position(|name| channels.first() == Some(name))?;
        let pixels = values.chunks_exact(names.len());
        let own = pixels.flat_map(|pixel| &pixel[first..first + channels.len()]);
        Some(own.copied().collect())
    }

    /// What it took.
    #[must_use]
    pub fn statistics(&self) -> Statistics {
        self.statistics
    }

    /// The error in grey levels of 8 bits that it has at most, in 90 % of all pictures, if
    /// [`Options::target_error`](super::Options::target_error) or
    /// [`Options::denoise`](super::Options::denoise) was asked for; none where light that no
    /// sample met may be far brighter than white.
    #[must_use]
    pub fn error(&self) -> Option<f64> {
        self.error
    }

    /// What was found about the scene and in the picture; no errors.
    #[must_use]
    pub fn findings(&self) -> &[Finding] {
        &self.findings
    }

    /// The bytes of its file, the same as those of `rtc render`.
    ///
    /// # Errors
    /// [`Error::Refused`] if it is larger than the format can hold.
    pub fn encode(&self) -> Result<Vec<u8>, Error> {
        let bytes = self.look.encode(&self.held, || self.origin.clone());
        bytes.map_err(|error| Error::Refused(error.to_string()))
    }

    /// Writes its file, which appears whole or not at all. Its name ends in `.png` or `.exr`, as the
    /// picture was made for.
    ///
    /// # Errors
    /// [`Error::Refused`] if the name is of another kind of file, [`Error::Unwritable`] if it can't
    /// be written.
    #[cfg(not(target_family = "wasm"))]
    pub fn save(&self, path: impl AsRef<std::path::Path>) -> Result<(), Error> {
        let path = path.as_ref();
        let wanted = self.format.extension();
        let extension = path.extension().unwrap_or_default().to_string_lossy();
        if extension.to_lowercase() != wanted {
            let path = path.display();
            return Err(Error::Refused(format!(
                "the picture was made for a .{wanted}; `{path}` is none"
            )));
        }
        let bytes = self.encode()?;
        rtc_pipeline::NewFile::save(path, &bytes).map_err(|error| Error::Unwritable {
            path: path.to_owned(),
            error,
        })
    }
}
