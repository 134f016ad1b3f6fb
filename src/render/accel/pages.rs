//! Memory for the rows of a hierarchy: on huge pages where the system grants them, since rays that
//! go anywhere wait for the addresses of pages as much as for the rows themselves.

use bytemuck::Pod;
use memmap2::{MmapMut, MmapOptions};
use std::marker::PhantomData;

/// Lists of so many bytes are worth pages of their own: twice the size of a huge page.
const WORTH: usize = 1 << 22;

/// A list of rows of numbers.
#[derive(Debug)]
pub(in crate::render::accel) enum Pages<T> {
    /// A list as any other.
    List(Vec<T>),
    /// In memory asked of the system, where huge pages are wanted.
    Mapped(MmapMut, PhantomData<T>),
}

impl<T: Pod> Pages<T> {
    /// So many rows of zeros.
    pub(in crate::render::accel) fn zeroed(count: usize) -> Self {
        let bytes = count * size_of::<T>();
        let mapped = (bytes >= WORTH).then(|| MmapOptions::new().len(bytes).map_anon());
        let Some(Ok(map)) = mapped else {
            return Self::List(vec![T::zeroed(); count]);
        };
        // Without huge pages it is slower, and no less right.
        #[cfg(target_os = "linux")]
        let _ = map.advise(memmap2::Advice::HugePage);
        Self::Mapped(map, PhantomData)
    }

    /// The rows of some lists, one after the other; each list is freed when its rows are copied.
    pub(in crate::render::accel) fn joined(lists: Vec<Vec<T>>) -> Self {
        let mut pages = Self::zeroed(lists.iter().map(Vec::len).sum());
        let mut rest = pages.rows_mut();
        for list in lists {
            let (here, after) = rest.split_at_mut(list.len());
            here.copy_from_slice(&list);
            rest = after;
        }
        pages
    }

    /// The rows, to be written.
    pub(in crate::render::accel) fn rows_mut(&mut self) -> &mut [T] {
        match self {
            Self::List(list) => list,
            Self::Mapped(map, _) => bytemuck::cast_slice_mut(map),
        }
    }

    /// The rows.
    #[inline]
    pub(in crate::render::accel) fn rows(&self) -> &[T] {
        match self {
            Self::List(list) => list,
            Self::Mapped(map, _) => bytemuck::cast_slice(map),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_the_same_on_pages_of_their_own() {
        let lists = |rows: usize| {
            let row = |index: usize| [index as f32; 64];
            [0..rows / 3, rows / 3..rows]
                .map(|range| range.map(row).collect::<Vec<_>>())
                .to_vec()
        };
        for rows in [0, 7, WORTH / 256 + 1] {
            let pages = Pages::joined(lists(rows));
            assert_eq!(pages.rows(), lists(rows).concat());
            assert_eq!(matches!(pages, Pages::Mapped(..)), rows > 7);
        }
    }
}
