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
    /// The column and the row of the next pixel, counted from the corner of the film.
    next: [u32; 2],
    /// Its number in the tile.
    index: usize,
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
            next: [area.x - film.x, area.y - film.y],
            index: 0,
        }
    }

    /// Begins the next pixel; `None` after the last.
    pub(in crate::render) fn next_pixel(&mut self) -> Option<OpenPixel<A>> {
        while self.index < self.kept.len() {
            let ([column, row], index) = (self.next, self.index);
            self.advance();
            let is_met = |at: u32| at.is_multiple_of(self.stride.get());
            if is_met(column) && is_met(row) {
                let at = [self.film.x + column, self.film.y + row];
                let number = row as usize * self.film.width as usize + column as usize;
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

    /// Goes to the next pixel of the tile, row by row.
    fn advance(&mut self) {
        let [column, row] = &mut self.next;
        (*column, self.index) = (*column + 1, self.index + 1);
        if *column == self.area.x + self.area.width - self.film.x {
            (*column, *row) = (self.area.x - self.film.x, *row + 1);
        }
    }

    /// Keeps what the samples of a pixel add up to.
    pub(in crate::render) fn close(&mut self, pixel: OpenPixel<A>) {
        self.kept[pixel.index] = pixel.sums.close();
    }
}
