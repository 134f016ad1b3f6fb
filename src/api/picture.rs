//! A rendered picture.

use super::{Aov, Diagnostic, Error, Format, Tone};
use rtc_color::quantize8;
use rtc_image::{self as image, PictureMetadata};
use rtc_pipeline::ResolvedOutputTransform;
use rtc_render::{FilmMonitor, RayCounts};

/// A picture: rows from top to bottom, each from left to right.
///
/// ```
/// use rtc::{Camera, Options, Phong, SceneBuilder, Shape};
///
/// let mut builder = SceneBuilder::new(Camera::look_at([0.0, 0.0, 6.0], [0.0; 3]).size(8, 8));
/// builder.add(Shape::sphere([0.0; 3], 1.0), Phong::default());
/// let scene = builder.build().unwrap();
/// let picture = scene.render(&Options::new().transparent())?;
/// assert_eq!((picture.pixels().len(), picture.rgba8().len()), (8 * 8, 8 * 8 * 4));
/// assert_eq!(picture.alpha().unwrap()[0], 0.0);
/// # Ok::<(), rtc::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Picture {
    held: image::Picture,
    look: ResolvedOutputTransform,
    metadata: PictureMetadata,
    format: Format,
    statistics: Statistics,
    error: Option<f64>,
    diagnostics: Vec<Diagnostic>,
}

/// The number of rays of a picture.
///
/// ```
/// use rtc::{Camera, Options, Phong, SceneBuilder, Shape};
///
/// let mut builder = SceneBuilder::new(Camera::look_at([0.0, 0.0, 6.0], [0.0; 3]).size(8, 8));
/// builder.add(Shape::sphere([0.0; 3], 1.0), Phong::default());
/// let scene = builder.build().unwrap();
/// let statistics = scene.render(&Options::new())?.statistics();
/// assert_eq!(statistics.camera_rays, 8 * 8);
/// assert!(statistics.hits < statistics.camera_rays);
/// # Ok::<(), rtc::Error>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Statistics {
    /// All rays.
    pub rays: u64,
    /// Camera rays.
    pub camera_rays: u64,
    /// Camera rays that hit a surface.
    pub hits: u64,
    /// Shadow rays.
    pub shadow_rays: u64,
}

impl Picture {
    pub(super) fn new(
        (held, look, metadata): (image::Picture, ResolvedOutputTransform, PictureMetadata),
        format: Format,
        (counts, error): (&RayCounts, Option<f64>),
        diagnostics: Vec<Diagnostic>,
    ) -> Self {
        Self {
            held,
            look,
            metadata,
            format,
            statistics: Statistics {
                rays: counts.rays(),
                camera_rays: counts.camera,
                hits: counts.hits,
                shadow_rays: counts.shadow,
            },
            error,
            diagnostics,
        }
    }

    /// A picture that is being rendered; `None` if no pixel of it is final yet.
    pub(super) fn unfinished(
        look: &ResolvedOutputTransform,
        format: Format,
        monitor: &FilmMonitor,
    ) -> Option<Self> {
        let held = look.unfinished(monitor)?;
        let made = (held, look.clone(), PictureMetadata::default());
        let counts = RayCounts::default();
        Some(Self::new(made, format, (&counts, None), Vec::new()))
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

    /// Red, green and blue of each pixel. For EXR formats: linear (Rec. 709), premultiplied by
    /// alpha. For PNG formats: display values, where [0, 1] is the range of a display.
    #[must_use]
    pub fn pixels(&self) -> &[[f64; 3]] {
        &self.held.image.pixels
    }

    /// The opacity of each pixel in [0, 1]; `None` if all are opaque.
    #[must_use]
    pub fn alpha(&self) -> Option<&[f32]> {
        self.held.alpha.as_deref()
    }

    /// Red, green, blue and alpha of each pixel as bytes for a display, alpha not premultiplied.
    /// Linear values are encoded as sRGB.
    #[must_use]
    pub fn rgba8(&self) -> Vec<u8> {
        let alpha = |index: usize| self.alpha().map_or(1.0, |alpha| f64::from(alpha[index]));
        let is_linear = self.format.kind().is_linear();
        let shown = |index: usize, pixel: [f64; 3]| match is_linear {
            false => pixel,
            true if alpha(index) > 0.0 => {
                Tone::Srgb.display(pixel.map(|value| value / alpha(index)))
            }
            true => [0.0; 3],
        };
        let pixels = self.pixels().iter().enumerate();
        let bytes = pixels.flat_map(|(index, pixel)| {
            let [r, g, b] = shown(index, *pixel);
            [r, g, b, alpha(index)].map(quantize8)
        });
        bytes.collect()
    }

    /// A layer that was requested: the values of [`Aov::channels`], pixel after pixel; `None` if it
    /// was not requested.
    #[must_use]
    pub fn layer(&self, aov: Aov) -> Option<Vec<f32>> {
        let image::PixelLayers { names, values } = &self.held.layers;
        let channels = aov.channels();
        let first = names
            .iter()
            .position(|name| channels.first() == Some(name))?;
        let pixels = values.chunks_exact(names.len());
        let own = pixels.flat_map(|pixel| &pixel[first..first + channels.len()]);
        Some(own.copied().collect())
    }

    /// The number of rays.
    #[must_use]
    pub fn statistics(&self) -> Statistics {
        self.statistics
    }

    /// An upper bound of the error in grey levels of 8 bits, with a confidence of 90 %, if
    /// [`Options::target_error`](super::Options::target_error) or
    /// [`Options::denoise`](super::Options::denoise) was set. `None` if there may be light much
    /// brighter than white that no sample found.
    #[must_use]
    pub fn error(&self) -> Option<f64> {
        self.error
    }

    /// Warnings and notes about the scene and the picture.
    #[must_use]
    pub fn diagnostics(&self) -> &[Diagnostic] {
        &self.diagnostics
    }

    /// The bytes of the file, identical to those of `rtc render`.
    ///
    /// # Errors
    /// [`Error::Refused`] if it is larger than the format allows.
    pub fn encode(&self) -> Result<Vec<u8>, Error> {
        let bytes = self.look.encode(&self.held, || self.metadata.clone());
        bytes.map_err(|error| Error::Refused(error.to_string()))
    }

    /// The same of a picture made for PNG. In a program that calls no [`Self::encode`] or
    /// [`Self::save`], the encoders of other formats are left out.
    ///
    /// # Errors
    /// [`Error::Refused`] if it is made for another format, or larger than PNG allows.
    pub fn png(&self) -> Result<Vec<u8>, Error> {
        let bytes = self.look.encode_png(&self.held, self.metadata.clone());
        bytes.map_err(|error| Error::Refused(error.to_string()))
    }

    /// Writes the file atomically. The extension must be that of the format.
    ///
    /// # Errors
    /// [`Error::Refused`] if the extension differs, [`Error::Unwritable`] if writing fails.
    #[cfg(not(target_family = "wasm"))]
    pub fn save(&self, path: impl AsRef<std::path::Path>) -> Result<(), Error> {
        let path = path.as_ref();
        let expected = self.format.extension();
        let extension = path.extension().unwrap_or_default().to_string_lossy();
        if extension.to_lowercase() != expected {
            let path = path.display();
            let formats = [Format::Png, Format::Exr, Format::Hdr].map(Format::extension);
            let other = formats
                .into_iter()
                .find(|own| *own == extension.to_lowercase());
            let remedy = other.map_or_else(String::new, |other| {
                format!("; render it with the format `{other}`")
            });
            return Err(Error::Refused(format!(
                "the picture was made for a .{expected}; `{path}` is none{remedy}"
            )));
        }
        let bytes = self.encode()?;
        rtc_pipeline::AtomicFile::save(path, &bytes).map_err(|error| Error::Unwritable {
            path: path.to_owned(),
            error,
        })
    }
}
