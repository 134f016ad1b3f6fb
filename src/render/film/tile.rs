//! A tile being rendered: the pixels selected, the samples of each, and the storage of their sums.

use super::pixel::{PixelAccumulator, SampleId, SampleRanges};
use super::{Crop, PixelStride};

/// Begins a pixel: given its position, its row-major index in the film, and its state in the film
/// so far, returns its accumulator and the samples to take.
pub(crate) type BeginPixel<'run, A> =
    dyn Fn([u32; 2], usize, &StateOf<A>) -> (A, SampleRanges) + Sync + 'run;

/// The state of a pixel in the film of an accumulator.
type StateOf<A> = <A as PixelAccumulator>::PixelState;

/// A tile as an integrator sees it: one pixel after the other, whatever the film keeps of each.
pub(crate) trait FilmTile<Sample> {
    /// Begins the next pixel: its coordinates in the picture, and the samples it is to take; `None`
    /// after the last.
    fn next(&mut self) -> Option<([u32; 2], SampleRanges)>;

    /// Adds the next sample of a stream to the current pixel.
    fn add(&mut self, id: &SampleId, sample: Sample);

    /// Stores the sum of the current pixel.
    fn close(&mut self);
}

/// A tile of a film that stores the results of an accumulator.
pub(crate) struct Tile<'film, A: PixelAccumulator> {
    /// The rectangle of the picture.
    area: Crop,
    /// The index in the film.
    film: Crop,
    stride: PixelStride,
    kept: &'film mut [A::PixelState],
    open: &'film BeginPixel<'film, A>,
    /// The column and the row of the next pixel, counted from the corner of the film.
    next: [u32; 2],
    /// Its number in the tile.
    index: usize,
    /// The accumulator of the current pixel, and its index in the tile.
    begun: Option<(A, usize)>,
}

impl<'film, A: PixelAccumulator> Tile<'film, A> {
    /// The pixels in `area` of a film with the state `kept`; only every `stride`-th from the film's
    /// corner.
    pub(crate) fn new(
        [area, film]: [Crop; 2],
        stride: PixelStride,
        kept: &'film mut [A::PixelState],
        open: &'film BeginPixel<'film, A>,
    ) -> Self {
        Self {
            area,
            film,
            stride,
            kept,
            open,
            next: [area.x - film.x, area.y - film.y],
            index: 0,
            begun: None,
        }
    }

    /// Goes to the next pixel of the tile, row by row.
    fn advance(&mut self) {
        let [column, row] = &mut self.next;
        (*column, self.index) = (*column + 1, self.index + 1);
        if *column == self.area.x + self.area.width - self.film.x {
            (*column, *row) = (self.area.x - self.film.x, *row + 1);
        }
    }
}

impl<A: PixelAccumulator> FilmTile<A::Sample> for Tile<'_, A> {
    fn next(&mut self) -> Option<([u32; 2], SampleRanges)> {
        while self.index < self.kept.len() {
            let ([column, row], index) = (self.next, self.index);
            self.advance();
            let is_selected = |at: u32| at.is_multiple_of(self.stride.get());
            if is_selected(column) && is_selected(row) {
                let at = [self.film.x + column, self.film.y + row];
                let number = row as usize * self.film.width as usize + column as usize;
                let (sums, ranges) = (self.open)(at, number, &self.kept[index]);
                self.begun = Some((sums, index));
                return Some((at, ranges));
            }
        }
        None
    }

    fn add(&mut self, id: &SampleId, sample: A::Sample) {
        if let Some((sums, _)) = &mut self.begun {
            sums.add(id, sample);
        }
    }

    fn close(&mut self) {
        if let Some((sums, index)) = self.begun.take() {
            self.kept[index] = sums.close();
        }
    }
}
