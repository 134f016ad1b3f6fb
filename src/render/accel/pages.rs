//! Memory for the rows of a BVH, in huge pages where the system grants them: incoherent rays wait
//! for address translation as much as for the rows themselves.

use bytemuck::Pod;
use memmap2::{MmapMut, MmapOptions};
use std::marker::PhantomData;

/// Lists of this many bytes get their own pages: twice the size of a huge page.
const WORTH: usize = 1 << 22;

/// Lists of this many bytes are returned to the system at once: the allocator would keep them.
const RETURNED: usize = 1 << 18;

/// A list of rows of numbers.
#[derive(Debug)]
pub(in crate::accel) enum PagedRows<T> {
    /// A list as any other.
    List(Vec<T>),
    /// In memory mapped by the system, with huge pages requested.
    Mapped(MmapMut, PhantomData<T>),
}

impl<T: Pod> PagedRows<T> {
    /// `count` rows of zeros.
    pub(in crate::accel) fn zeroed(count: usize) -> Self {
        let pages = Self::mapped_from(WORTH, count);
        // Without huge pages it is slower, and no less right.
        #[cfg(target_os = "linux")]
        if let Self::Mapped(map, _) = &pages {
            let _ = map.advise(memmap2::Advice::HugePage);
        }
        pages
    }

    /// `count` rows of zeros, in mapped memory if they are large.
    fn mapped_from(bytes: usize, count: usize) -> Self {
        let length = count * size_of::<T>();
        let map = (length >= bytes).then(|| MmapOptions::new().len(length).map_anon());
        match map {
            Some(Ok(map)) => Self::Mapped(map, PhantomData),
            Some(Err(_)) | None => Self::List(vec![T::zeroed(); count]),
        }
    }

    /// The rows of a list, in memory that the system has back when they are dropped.
    pub(in crate::accel) fn put_aside(list: &[T]) -> Self {
        let mut pages = Self::mapped_from(RETURNED, list.len());
        pages.rows_mut().copy_from_slice(list);
        pages
    }

    /// The rows of some lists, one after the other; each list is freed when its rows are copied.
    pub(in crate::accel) fn merged(lists: Vec<Self>) -> Self {
        let mut pages = Self::zeroed(lists.iter().map(|list| list.rows().len()).sum());
        let mut rest = pages.rows_mut();
        for list in lists {
            let (here, after) = rest.split_at_mut(list.rows().len());
            here.copy_from_slice(list.rows());
            rest = after;
        }
        pages
    }

    /// The rows, to be written.
    pub(in crate::accel) fn rows_mut(&mut self) -> &mut [T] {
        match self {
            Self::List(list) => list,
            Self::Mapped(map, _) => bytemuck::cast_slice_mut(map),
        }
    }

    /// The rows.
    #[inline]
    pub(in crate::accel) fn rows(&self) -> &[T] {
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
            let aside = lists(rows)
                .into_iter()
                .map(|list| PagedRows::put_aside(&list));
            let pages = PagedRows::merged(aside.collect());
            assert_eq!(pages.rows(), lists(rows).concat());
            assert_eq!(matches!(pages, PagedRows::Mapped(..)), rows > 7);
        }
    }
}
