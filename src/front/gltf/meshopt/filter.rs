//! The filters of decoded attributes.

use super::MeshoptError;

/// Undoes a filter on elements of `stride` bytes, in place.
pub(super) fn apply(filter: &str, stride: usize, bytes: &mut [u8]) -> Result<(), MeshoptError> {
    match (filter, stride) {
        ("" | "NONE", _) => {}
        ("OCTAHEDRAL", 4) => each_4(bytes, |[x, y, one, w]| {
            let [x, y, z] =
                octahedral([x, y, one].map(|byte| f64::from(byte.cast_signed())), 127.0);
            [to_i8(x), to_i8(y), to_i8(z), w]
        }),
        ("OCTAHEDRAL", 8) => each_8(bytes, |[x, y, one, w]| {
            let [x, y, z] = octahedral([x, y, one].map(f64::from), 32767.0);
            [to_i16(x), to_i16(y), to_i16(z), w]
        }),
        ("QUATERNION", 8) => each_8(bytes, quaternion),
        ("EXPONENTIAL", stride) if stride.is_multiple_of(4) => {
            each_4(bytes, |word| exponential(word).to_le_bytes())
        }
        ("COLOR", 4) => each_4(bytes, |[y, co, cg, a]| {
            let color = [
                f64::from(y),
                f64::from(co.cast_signed()),
                f64::from(cg.cast_signed()),
            ];
            color_from(color, u32::from(a), 255.0).map(to_u8)
        }),
        ("COLOR", 8) => each_8(bytes, |[y, co, cg, a]| {
            let color = [f64::from(y.cast_unsigned()), f64::from(co), f64::from(cg)];
            color_from(color, u32::from(a.cast_unsigned()), 65535.0)
                .map(|value| to_u16(value).cast_signed())
        }),
        _ => return Err("its filter does not fit its stride"),
    }
    Ok(())
}

fn each_4(bytes: &mut [u8], undo: impl Fn([u8; 4]) -> [u8; 4]) {
    bytes
        .as_chunks_mut::<4>()
        .0
        .iter_mut()
        .for_each(|element| *element = undo(*element));
}

fn each_8(bytes: &mut [u8], undo: impl Fn([i16; 4]) -> [i16; 4]) {
    for element in bytes.as_chunks_mut::<8>().0 {
        let shorts = [0, 2, 4, 6].map(|at| i16::from_le_bytes([element[at], element[at + 1]]));
        for (pair, short) in element.chunks_exact_mut(2).zip(undo(shorts)) {
            pair.copy_from_slice(&short.to_le_bytes());
        }
    }
}

/// A unit vector from the octahedron it was unfolded from.
fn octahedral([x, y, one]: [f64; 3], most: f64) -> [f64; 3] {
    let (x, y) = if one == 0.0 {
        (0.0, 0.0)
    } else {
        (x / one, y / one)
    };
    let z = 1.0 - x.abs() - y.abs();
    let fold = (-z).max(0.0);
    let unfold = |part: f64| {
        if part >= 0.0 {
            part - fold
        } else {
            part + fold
        }
    };
    let (x, y) = (unfold(x), unfold(y));
    let scale = most / (x * x + y * y + z * z).sqrt();
    [x * scale, y * scale, z * scale]
}

/// A unit quaternion from three components; the largest was omitted, and its index is in the low
/// bits of the last.
fn quaternion([x, y, z, w]: [i16; 4]) -> [i16; 4] {
    let scale = std::f64::consts::FRAC_1_SQRT_2 / f64::from(w | 3);
    let parts = [x, y, z].map(|part| f64::from(part) * scale);
    let rest = (1.0 - parts.iter().map(|part| part * part).sum::<f64>())
        .max(0.0)
        .sqrt();
    let place = usize::from(w.cast_unsigned() & 3);
    let mut rotation = [0; 4];
    for (at, part) in [rest, parts[0], parts[1], parts[2]].into_iter().enumerate() {
        rotation[(place + at) % 4] = to_i16(part * 32767.0);
    }
    rotation
}

/// A float from an exponent of 8 bits and a mantissa of 24.
fn exponential(word: [u8; 4]) -> f32 {
    let word = i32::from_le_bytes(word);
    let (exponent, mantissa) = (word >> 24, word << 8 >> 8);
    #[expect(
        clippy::cast_possible_truncation,
        reason = "the format has 32-bit floats"
    )]
    let float = rtc_math::ldexp(f64::from(mantissa), exponent) as f32;
    float
}

/// Red, green, blue and alpha from luma and two chromas; the highest bit of alpha encodes the bit
/// depth.
fn color_from([y, co, cg]: [f64; 3], alpha: u32, most: f64) -> [f64; 4] {
    let greatest = (1_u32 << (u32::BITS - alpha.leading_zeros())) - 1;
    let a = alpha & (greatest >> 1);
    let a = a << 1 | a & 1;
    let scale = if greatest == 0 {
        0.0
    } else {
        most / f64::from(greatest)
    };
    [y + co - cg, y + cg, y - co - cg, f64::from(a)].map(|channel| channel * scale)
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "rounded, and a cast keeps within the range"
)]
fn to_i8(value: f64) -> u8 {
    (value.round() as i8).cast_unsigned()
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "rounded, and a cast keeps within the range"
)]
fn to_i16(value: f64) -> i16 {
    value.round() as i16
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a cast keeps within the range"
)]
fn to_u8(value: f64) -> u8 {
    value.round() as u8
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a cast keeps within the range"
)]
fn to_u16(value: f64) -> u16 {
    value.round() as u16
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn filters_give_what_was_meant() {
        let mut up = [0_u8, 0, 127, 1];
        apply("OCTAHEDRAL", 4, &mut up).unwrap();
        assert_eq!(up, [0, 0, 127, 1]);
        assert_eq!(quaternion([0, 0, 0, 0x7fff]), [0, 0, 0, 32767]);
        assert!((exponential([3, 0, 0, 0xff]) - 1.5).abs() < f32::EPSILON);
        let mut grey = [127_u8, 0, 0, 255];
        apply("COLOR", 4, &mut grey).unwrap();
        assert_eq!(grey, [127, 127, 127, 255]);
        assert!(apply("QUATERNION", 4, &mut grey).is_err());
    }
}
