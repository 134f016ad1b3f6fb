//! Reads the elements of an accessor: packed, interleaved or sparse, or zeros without a buffer
//! view.

use super::accessor::Accessor;
use super::document::Document;
use super::layout::{ComponentType, ElementLayout};
use rtc_ir::VertexColumn;

/// The components of an element; a matrix has the most.
pub(super) type AccessorElement = [f64; 16];

/// The data of an accessor. All elements are within their buffer views.
pub(super) struct AccessorReader<'d> {
    pub(super) layout: ElementLayout,
    pub(super) count: usize,
    /// The first element and the bytes from one to the next; none for zeros.
    base: Option<(&'d [u8], usize)>,
    /// The indices of a sparse accessor, and their elements.
    sparse: Option<(IntegerArray<'d>, &'d [u8])>,
}

/// An array of integers.
#[derive(Clone, Copy)]
pub(super) struct IntegerArray<'d> {
    bytes: &'d [u8],
    component: ComponentType,
}

impl IntegerArray<'_> {
    pub(super) fn len(&self) -> usize {
        self.bytes.len() / self.component.size()
    }

    pub(super) fn get(&self, at: usize) -> Option<usize> {
        let size = self.component.size();
        let bytes = self.bytes.get(at * size..(at + 1) * size)?;
        Some(
            bytes
                .iter()
                .rev()
                .fold(0, |number, byte| number << 8 | usize::from(*byte)),
        )
    }

    /// The position of a number in a sorted array.
    fn find(&self, number: usize) -> Option<usize> {
        let (mut low, mut high) = (0, self.len());
        while low < high {
            let middle = low.midpoint(high);
            if self.get(middle).is_some_and(|index| index < number) {
                low = middle + 1;
            } else {
                high = middle;
            }
        }
        (self.get(low) == Some(number)).then_some(low)
    }
}

impl<'d> AccessorReader<'d> {
    /// A reader of an accessor; none if an element is outside its buffer view.
    pub(super) fn of(doc: &'d Document<'_>, accessor: &Accessor) -> Option<Self> {
        let (layout, count) = (accessor.layout?, accessor.count?);
        // Find the elements in the buffer view.
        let base = match accessor.view {
            None => None,
            Some(view) => {
                let holder = doc.views.get(view)?;
                let stride = holder.stride.unwrap_or(layout.packed());
                let end = stride.checked_mul(count - 1)?.checked_add(extent(layout))?;
                let bytes = doc
                    .view_bytes(view)?
                    .get(accessor.offset..accessor.offset.checked_add(end)?)?;
                (stride >= extent(layout)).then_some((bytes, stride))
            }
        };
        if accessor.view.is_some() && base.is_none() {
            return None;
        }
        // Find the indices and values of a sparse accessor.
        let sparse = match &accessor.sparse {
            None => None,
            Some(sparse) => {
                let part = |view, offset: usize, size: usize| {
                    doc.view_bytes(view)?
                        .get(offset..offset.checked_add(sparse.count.checked_mul(size)?)?)
                };
                let (view, offset, component) = sparse.indices;
                let indices = IntegerArray {
                    bytes: part(view, offset, component.size())?,
                    component,
                };
                let size = layout.components() * layout.component.size();
                Some((indices, part(sparse.values.0, sparse.values.1, size)?))
            }
        };
        Some(Self {
            layout,
            count,
            base,
            sparse,
        })
    }

    /// The indices of the elements that are replaced.
    pub(super) fn replaced(&self) -> Option<IntegerArray<'d>> {
        self.sparse.as_ref().map(|(indices, _)| *indices)
    }

    /// The element at `at`, which is below the count; normalised components are fractions.
    pub(super) fn at<const N: usize>(&self, at: usize) -> [f64; N] {
        let (layout, mut element) = (self.layout, AccessorElement::default());
        let replaced = self
            .sparse
            .as_ref()
            .and_then(|(indices, values)| Some((indices.find(at)?, *values)));
        if let Some((place, values)) = replaced {
            let flat = ElementLayout {
                columns: 1,
                rows: layout.components(),
                ..layout
            };
            read(&values[place * flat.packed()..], flat, &mut element);
        } else if let Some((bytes, stride)) = self.base {
            read(&bytes[at * stride..], layout, &mut element);
        }
        let mut vector = [0.0; N];
        vector
            .iter_mut()
            .zip(&element[..layout.components()])
            .for_each(|(to, from)| *to = self.fraction(*from));
        vector
    }

    /// The elements as bytes with a stride, if none is replaced and each is one column.
    fn plain(&self) -> Option<(&'d [u8], usize)> {
        self.base
            .filter(|_| self.sparse.is_none() && self.layout.columns == 1)
    }

    /// Calls `see` with each element in turn. Sparse elements whose indices do not increase are
    /// skipped.
    pub(super) fn each(&self, mut see: impl FnMut(usize, &[f64])) {
        let ElementLayout {
            component, rows, ..
        } = self.layout;
        let (float, short, long) = (
            |bytes| f64::from(f32::from_le_bytes(bytes)),
            |bytes| f64::from(u16::from_le_bytes(bytes)),
            |bytes| f64::from(u32::from_le_bytes(bytes)),
        );
        // Common component types are specialised, so that large meshes are read without a branch
        // per element.
        match (component, rows, self.plain()) {
            (ComponentType::F32, 2, Some(all)) => {
                records::<2, _, _>(all, float, |at, element| see(at, element))
            }
            (ComponentType::F32, 3, Some(all)) => {
                records::<3, _, _>(all, float, |at, element| see(at, element))
            }
            (ComponentType::F32, 4, Some(all)) => {
                records::<4, _, _>(all, float, |at, element| see(at, element))
            }
            (ComponentType::U16, 1, Some(all)) => {
                records::<1, _, _>(all, short, |at, element| see(at, element))
            }
            (ComponentType::U32, 1, Some(all)) => {
                records::<1, _, _>(all, long, |at, element| see(at, element))
            }
            _ => self.each_by_layout(see),
        }
    }

    /// As [`Self::each`], for elements of any layout.
    fn each_by_layout(&self, mut see: impl FnMut(usize, &[f64])) {
        let (layout, mut element) = (self.layout, AccessorElement::default());
        let components = layout.components();
        let mut next = self.replaced().and_then(|indices| indices.get(0));
        let mut place = 0;
        for at in 0..self.count {
            if let (true, Some((indices, values))) = (next == Some(at), &self.sparse) {
                let flat = ElementLayout {
                    columns: 1,
                    rows: components,
                    ..layout
                };
                read(&values[place * flat.packed()..], flat, &mut element);
                place += 1;
                next = indices.get(place);
            } else if let Some((bytes, stride)) = self.base {
                read(&bytes[at * stride..], layout, &mut element);
            } else {
                element = AccessorElement::default();
            }
            see(at, &element[..components]);
        }
    }

    /// All elements, of `N` components; normalised integers are fractions.
    pub(super) fn vectors<const N: usize>(&self) -> Vec<[f64; N]> {
        let mut vectors = Vec::with_capacity(self.count);
        self.each(|_, element| {
            let mut vector = [0.0; N];
            vector
                .iter_mut()
                .zip(element)
                .for_each(|(to, from)| *to = self.fraction(*from));
            vectors.push(vector);
        });
        vectors
    }

    /// The same as a column of 32-bit floats, which represent floats and short integers exactly.
    pub(super) fn column<const N: usize>(&self) -> VertexColumn<N> {
        let mut vectors = Vec::with_capacity(self.count);
        let ElementLayout {
            component, rows, ..
        } = self.layout;
        if let (ComponentType::F32, Some(all)) = (component, self.plain().filter(|_| rows == N)) {
            records::<N, _, _>(all, f32::from_le_bytes, |_, vector| vectors.push(*vector));
            return vectors.into();
        }
        #[expect(
            clippy::cast_possible_truncation,
            reason = "components are of 32 bits or are rounded to them"
        )]
        self.each(|_, element| {
            let mut vector = [0.0; N];
            vector
                .iter_mut()
                .zip(element)
                .for_each(|(to, from)| *to = self.fraction(*from) as f32);
            vectors.push(vector);
        });
        vectors.into()
    }

    /// All components as whole numbers, of elements that are indices.
    pub(super) fn integers(&self) -> Vec<u32> {
        let mut integers = Vec::with_capacity(self.count * self.layout.components());
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "the number of an u32, or cut off"
        )]
        self.each(|_, element| integers.extend(element.iter().map(|number| *number as u32)));
        integers
    }

    /// The same in groups of `N`; an incomplete group is dropped.
    pub(super) fn groups<const N: usize>(&self) -> Vec<[u32; N]> {
        let ElementLayout {
            component, rows, ..
        } = self.layout;
        if let (ComponentType::U32, 1, Some((bytes, 4))) = (component, rows, self.plain()) {
            let groups = bytes.as_chunks::<4>().0.as_chunks::<N>().0.iter();
            return groups.map(|group| group.map(u32::from_le_bytes)).collect();
        }
        self.integers().as_chunks().0.to_vec()
    }

    /// The value of a component (glTF 2.0, section 3.6.2.2).
    pub(super) fn fraction(&self, number: f64) -> f64 {
        match self.layout.component.range() {
            Some([_, most]) if self.layout.normalized => (number / most).max(-1.0),
            _ => number,
        }
    }
}

/// Calls `see` with each of some records of `N` numbers at the given stride.
#[inline(always)]
fn records<const N: usize, const B: usize, T: Copy + Default>(
    (bytes, stride): (&[u8], usize),
    number: impl Fn([u8; B]) -> T,
    mut see: impl FnMut(usize, &[T; N]),
) {
    for (at, record) in bytes.chunks(stride).enumerate() {
        let mut numbers = [T::default(); N];
        numbers
            .iter_mut()
            .zip(record.as_chunks().0)
            .for_each(|(to, bytes)| *to = number(*bytes));
        see(at, &numbers);
    }
}

/// Bytes of an element from its first to its last component.
fn extent(layout: ElementLayout) -> usize {
    layout.column() * (layout.columns - 1) + layout.rows * layout.component.size()
}

/// Reads one element that `bytes` start with.
fn read(bytes: &[u8], layout: ElementLayout, element: &mut AccessorElement) {
    let size = layout.component.size();
    for column in 0..layout.columns {
        let bytes = &bytes[column * layout.column()..];
        for row in 0..layout.rows {
            element[column * layout.rows + row] = number(layout.component, &bytes[row * size..]);
        }
    }
}

fn number(component: ComponentType, bytes: &[u8]) -> f64 {
    let four = || [bytes[0], bytes[1], bytes[2], bytes[3]];
    match component {
        ComponentType::I8 => f64::from(bytes[0].cast_signed()),
        ComponentType::U8 => f64::from(bytes[0]),
        ComponentType::I16 => f64::from(i16::from_le_bytes([bytes[0], bytes[1]])),
        ComponentType::U16 => f64::from(u16::from_le_bytes([bytes[0], bytes[1]])),
        ComponentType::U32 => f64::from(u32::from_le_bytes(four())),
        ComponentType::F32 => f64::from(f32::from_le_bytes(four())),
    }
}
