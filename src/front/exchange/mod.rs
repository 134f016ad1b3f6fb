//! Modules shared by the readers of other renderers' scenes: affine maps, colours and spectra,
//! checkerboards, materials, images of numbers, textures of images, round shapes, covers of shapes
//! with one side, skies, spots, and tessellations of shapes that the IR lacks.

pub(crate) mod checkerboard;
pub(crate) mod color;
pub(crate) mod material;
pub(crate) mod number;
pub(crate) mod one_sided;
pub(crate) mod round;
pub(crate) mod sky;
pub(crate) mod spot;
pub(crate) mod tessellate;
pub(crate) mod texture;
pub(crate) mod transform;

use rtc_ir::{Mode, PathSettings, Settings};
use rtc_math::PixelFilter;
use rtc_source::Span;

/// The memory of a surface and its span while their lists grow, in bytes, rounded up.
pub(crate) const SURFACE_BYTES: u64 = 768;

/// A string of a text and its span.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct SpannedText {
    pub(crate) text: String,
    pub(crate) span: Span,
}

/// The settings of a scene that is path traced, with one scattering between microfacets, as other
/// renderers have it.
pub(crate) fn traced(samples: u32, max_depth: u32) -> Settings {
    Settings {
        mode: Mode::Path(PathSettings {
            samples,
            multiple_scattering: false,
            caustics: false,
            filter: PixelFilter::PIXEL,
        }),
        shadows: true,
        max_depth,
        ..Settings::default()
    }
}
