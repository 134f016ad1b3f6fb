//! Checkerboards over texture coordinates.

use rtc_ir::{Map, Procedural, Scene, Texture, TextureId};
use rtc_math::{TextureMapping, TexturePattern, to_u32};

/// Adds a checkerboard, and returns its map: `rows` map the texture coordinates of a surface to
/// squares of side 1; the square at the origin has the first colour.
pub(crate) fn checkerboard(
    [first, second]: [[f64; 3]; 2],
    rows: [[f64; 3]; 2],
    scene: &mut Scene,
) -> Map {
    let (colors, scale, texture_from_surface) = match scaled(rows) {
        Some((scale, false)) => ([first, second], scale, None),
        Some((scale, true)) => ([second, first], scale, None),
        None => ([first, second], 1.0, Some(rows)),
    };
    let texture = TextureId(to_u32(scene.textures.len()));
    scene.textures.push(Texture::Procedural(Procedural {
        pattern: TexturePattern::Checker,
        colors,
        scale,
        mapping: TextureMapping::Uv,
    }));
    Map {
        texture,
        set: 0,
        texture_from_surface,
    }
}

/// The scale that equals a map on all squares, and whether it swaps their colours; `None` if there
/// is none. Since ⌊b − x⌋ is b − 1 − ⌊x⌋ for a whole b, the direction of v does not matter.
fn scaled([[u, s, a], [t, v, b]]: [[f64; 3]; 2]) -> Option<(f64, bool)> {
    let is_whole = |number: f64| number.fract() == 0.0;
    let is_scale = s == 0.0 && t == 0.0 && u > 0.0 && v.abs() == u && is_whole(a) && is_whole(b);
    let shift = if v < 0.0 { a + b - 1.0 } else { a + b };
    is_scale.then_some((u, shift.rem_euclid(2.0) == 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use rtc_math::Vec3;

    #[test]
    fn a_scale_has_the_squares_of_its_map() {
        let whole = |k: i32| f64::from(k);
        for rows in [
            [[2.0, 0.0, 0.0], [0.0, 2.0, 0.0]],
            [[2.0, 0.0, 0.0], [0.0, -2.0, 2.0]],
            [[4.0, 0.0, 1.0], [0.0, -4.0, 3.0]],
            [[4.0, 0.0, 3.0], [0.0, 4.0, 2.0]],
        ] {
            let (scale, swaps) = scaled(rows).unwrap();
            for (i, j) in (0..12).flat_map(|i| (0..12).map(move |j| (i, j))) {
                let [u, v] = [i, j].map(|k| (whole(k) + 0.3) / 7.0);
                let [x, y] = rows.map(|[a, b, c]| a * u + b * v + c);
                let mapped = TexturePattern::Checker.value(Vec3::new(x, y, 0.0));
                let value = TexturePattern::Checker.value(Vec3::new(u, v, 0.0) * scale);
                assert_eq!(if swaps { 1.0 - value } else { value }, mapped, "{rows:?}");
            }
        }
        assert_eq!(scaled([[2.0, 0.0, 0.0], [0.0, 3.0, 0.0]]), None);
        assert_eq!(scaled([[2.0, 0.0, 0.5], [0.0, 2.0, 0.0]]), None);
    }
}
