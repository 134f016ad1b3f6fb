//! A tile under way: which of its pixels are rendered, the samples each is to take, and where the
//! film keeps what they add up to.

use super::pixel::{Accumulator, SampleRanges};
use super::{Crop, Stride};

/// Begins a pixel: given its place, its number in the film, row by row, and what the film keeps of
/// it so far, says what adds up its samples and which it is to take.
pub(in crate::render) type Open<'run, A> =
    dyn Fn([u32; 2], usize, &<A as Accumulator>::Kept) -> (A, SampleRanges) + Sync + 'run;

/// The pixels of a tile, one after the other.
pub(in crate::render) struct Tile<'film, A: Accumulator> {
    /// The rectangle of the picture.
    area: Crop,
    /// That of the film.
    film: Crop,
    stride: Stride,
    kept: &'film mut [A::Kept],
    open: &'film Open<'film, A>,
    /// The next pixel, counted in rows of the tile.
    next: usize,
}

/// A pixel under way.
pub(in crate::render) struct OpenPixel<A> {
    /// Its place in the picture.
    pub(in crate::render) at: [u32; 2],
    /// What adds up its samples.
    pub(in crate::render) sums: A,
    /// The samples it is to take.
    pub(in crate::render) asked: SampleRanges,
    index: usize,
}

impl<'film, A: Accumulator> Tile<'film, A> {
    /// The pixels in `area` of a film, of which it keeps `kept`; only those that `stride` meets
    /// from the film's corner on.
    pub(in crate::render) fn new(
        [area, film]: [Crop; 2],
        stride: Stride,
        kept: &'film mut [A::Kept],
        open: &'film Open<'film, A>,
    ) -> Self {
        Self {
            area,
            film,
            stride,
            kept,
            open,
            next: 0,
        }
    }

    /// Begins the next pixel; `None` after the last.
    pub(in crate::render) fn next_pixel(&mut self) -> Option<OpenPixel<A>> {
        while self.next < self.kept.len() {
            let index = self.next;
            self.next += 1;
            let width = self.area.width as usize;
            let [column, row] = [
                (self.area.x - self.film.x) as usize + index % width,
                (self.area.y - self.film.y) as usize + index / width,
            ];
            let stride = self.stride.get() as usize;
            if column.is_multiple_of(stride) && row.is_multiple_of(stride) {
                let at = [self.film.x + to_u32(column), self.film.y + to_u32(row)];
                let number = row * self.film.width as usize + column;
                let (sums, asked) = (self.open)(at, number, &self.kept[index]);
                return Some(OpenPixel {
                    at,
                    sums,
                    asked,
                    index,
                });
            }
        }
        None
    }

    /// Keeps what the samples of a pixel add up to.
    pub(in crate::render) fn close(&mut self, pixel: OpenPixel<A>) {
        self.kept[pixel.index] = pixel.sums.close();
    }
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "a column or row of a picture"
)]
fn to_u32(place: usize) -> u32 {
    place as u32
}
