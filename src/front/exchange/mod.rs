//! What the readers of other renderers' scenes share: affine maps, colours and spectra,
//! checkerboards, materials, and the meshes that stand for shapes which the IR does not have.

pub(crate) mod checkerboard;
pub(crate) mod color;
pub(crate) mod material;
pub(crate) mod tessellate;
pub(crate) mod transform;

use rtc_source::Span;

/// A string of a text and its span.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Text {
    pub(crate) text: String,
    pub(crate) span: Span,
}
