//! Colours of files that do not say from where to where their numbers go.

use rtc_color::srgb_decoded;
use rtc_ir::VertexColumn;

/// Colours as files write them, coded as sRGB codes them, with alpha: each channel from 0 to 1, or,
/// if any is above 1, to 255.
#[derive(Clone, Debug, Default)]
pub(super) struct VertexColors {
    colors: Vec<[f32; 4]>,
    most: f32,
}

/// The default colour of elements without one.
pub(super) const WHITE: [f32; 4] = [1.0; 4];

impl VertexColors {
    /// Adds the colour of the next element, three or four channels.
    #[expect(
        clippy::cast_possible_truncation,
        reason = "rounded to what the IR stores"
    )]
    pub(super) fn push(&mut self, channels: &[f64]) {
        let channel = |at: usize| channels.get(at).map(|channel| *channel as f32);
        let [r, g, b] = [0, 1, 2].map(|at| channel(at).unwrap_or(1.0).max(0.0));
        let alpha = channel(3).map_or(f32::INFINITY, |alpha| alpha.max(0.0));
        self.most = [r, g, b].into_iter().fold(self.most, f32::max);
        self.colors.push([r, g, b, alpha]);
    }

    /// The next element has no colour.
    pub(super) fn skip(&mut self) {
        self.colors.push([f32::INFINITY; 4]);
    }

    /// Whether there are none.
    pub(super) fn is_empty(&self) -> bool {
        self.colors.iter().all(|[red, ..]| red.is_infinite())
    }

    /// The number of colours that were added or skipped.
    pub(super) fn count(&self) -> usize {
        self.colors.len()
    }

    /// The linear colours; empty if there are none.
    pub(super) fn linear(self) -> Vec<[f32; 4]> {
        if self.is_empty() {
            return Vec::new();
        }
        let whole: f32 = if self.most > 1.0 { 255.0 } else { 1.0 };
        let linear = |color: [f32; 4]| match color {
            [red, ..] if red.is_infinite() => WHITE,
            [r, g, b, alpha] => {
                let [r, g, b] = [r, g, b].map(|channel| decoded(f64::from(channel / whole)));
                [r, g, b, (alpha / whole).min(1.0)]
            }
        };
        self.colors.into_iter().map(linear).collect()
    }

    /// The linear colours of vertices; empty if there are none.
    pub(super) fn column(self) -> VertexColumn<4> {
        self.linear().into()
    }
}

/// The linear value of a coded one, as the IR stores it.
#[expect(
    clippy::cast_possible_truncation,
    reason = "rounded to what the IR stores"
)]
pub(super) fn decoded(coded: f64) -> f32 {
    srgb_decoded(coded.clamp(0.0, 1.0)) as f32
}
