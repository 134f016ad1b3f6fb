//! Tables of numbers as differences of neighbours, which compress well: what is handed out is
//! compressed, and the tables are the largest part of it that code is not.

/// The entries of a table whose numbers have `W` bytes: `axes` are the lengths of its axes, the
/// last one contiguous, and each entry has `N` numbers.
///
/// A table is packed number after number of its entries. In each, the difference to the entry
/// before is taken along each axis in turn, its sign is moved to the lowest bit, and the bytes are
/// grouped by significance, the lowest first. Sums wrap round, so the bits are those of the table.
pub(super) fn unpack<const W: usize, const N: usize>(
    packed: &[u8],
    axes: &[usize],
) -> Vec<[[u8; W]; N]> {
    let count = axes.iter().product();
    let mut table = vec![[[0; W]; N]; count];
    for (k, planes) in packed.chunks_exact((W * count).max(1)).enumerate() {
        let difference = |entry: usize| {
            let byte =
                |bits: u64, plane: usize| bits << 8 | u64::from(planes[plane * count + entry]);
            let folded = (0..W).rev().fold(0, byte);
            folded >> 1 ^ (folded & 1).wrapping_neg()
        };
        let mut numbers = (0..count).map(difference).collect::<Vec<u64>>();
        for [step, end] in steps(axes) {
            for entry in step..count {
                if entry % end >= step {
                    numbers[entry] = numbers[entry].wrapping_add(numbers[entry - step]);
                }
            }
        }
        for (entry, number) in table.iter_mut().zip(numbers) {
            let bytes = number.to_le_bytes();
            entry[k] = std::array::from_fn(|plane| bytes[plane]);
        }
    }
    table
}

/// For each axis the distance of neighbours along it, and of lines of entries along it.
fn steps(axes: &[usize]) -> impl Iterator<Item = [usize; 2]> {
    let length = |axes: &[usize]| axes.iter().product::<usize>();
    (0..axes.len()).map(move |axis| [length(&axes[axis + 1..]), length(&axes[axis..])])
}

/// A table, packed.
#[cfg(test)]
pub(super) fn pack<const W: usize, const N: usize>(
    table: &[[[u8; W]; N]],
    axes: &[usize],
) -> Vec<u8> {
    let mut packed = Vec::new();
    for k in 0..N {
        // The bits at the top, so that differences wrap round.
        let spare = 64 - 8 * W as u32;
        let number = |entry: &[[u8; W]; N]| {
            let byte = |bits: u64, byte: &u8| bits << 8 | u64::from(*byte);
            entry[k].iter().rev().fold(0, byte) << spare
        };
        let mut numbers = table.iter().map(number).collect::<Vec<u64>>();
        for [step, end] in steps(axes) {
            for entry in (step..numbers.len()).rev() {
                if entry % end >= step {
                    numbers[entry] = numbers[entry].wrapping_sub(numbers[entry - step]);
                }
            }
        }
        let folded = numbers.into_iter().map(|difference| {
            let difference = difference.cast_signed() >> spare;
            (difference << 1 ^ difference >> 63).cast_unsigned()
        });
        let folded = folded.collect::<Vec<u64>>();
        for plane in 0..W {
            packed.extend(folded.iter().map(|bits| bits.to_le_bytes()[plane]));
        }
    }
    packed
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_packed_table_comes_back_whatever_its_bits() {
        let mut state = 1_u64;
        let mut byte = || {
            state = state.wrapping_mul(0x5851_f42d_4c95_7f2d).wrapping_add(1);
            state.to_be_bytes()[0]
        };
        let wide = [(); 24].map(|()| [(); 3].map(|()| [(); 8].map(|()| byte())));
        assert_eq!(unpack(&pack(&wide, &[4, 6]), &[4, 6]), wide);
        let narrow = [(); 30].map(|()| [[byte(), byte()]]);
        assert_eq!(unpack(&pack(&narrow, &[2, 3, 5]), &[2, 3, 5]), narrow);
    }

    #[test]
    fn a_slope_is_packed_to_few_values() {
        let slope = [0_i16, 3, 6, 9].map(|number| [number.to_le_bytes()]);
        assert_eq!(pack(&slope, &[4]), [0, 6, 6, 6, 0, 0, 0, 0]);
        let fall = [0_i16, -3, -6, -9].map(|number| [number.to_le_bytes()]);
        assert_eq!(pack(&fall, &[4]), [0, 5, 5, 5, 0, 0, 0, 0]);
    }
}
