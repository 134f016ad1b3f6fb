//! Textures: the course's lookup in real numbers.

use super::number::CertifiedNumber;
use super::reason::Doubts;
use super::shade::{Color, plus, times};
use rtc_ir::{Image, Pixels, Scene, Texture, TextureId};

/// The colour of a texture at texture coordinates.
pub(super) fn look_up<N: CertifiedNumber>(
    scene: &Scene,
    texture: TextureId,
    [u, v]: [N; 2],
) -> Result<Color<N>, Doubts> {
    match scene.textures.get(texture.0 as usize) {
        Some(Texture::Uv) => Ok([u, N::ZERO, v]),
        Some(Texture::Image(image)) => {
            let image = scene.images.get(image.0 as usize);
            bilinear(image.ok_or(Doubts::unsupported("textures"))?, [u, v])
        }
        Some(Texture::Sampled(_) | Texture::Procedural(_)) | None => {
            Err(Doubts::unsupported("textures"))
        }
    }
}

/// Interpolates bilinearly between four texels. The unit square spans from the center of the first
/// texel to the center of the last; v = 1 is the top row; the image repeats.
fn bilinear<N: CertifiedNumber>(image: &Image, [u, v]: [N; 2]) -> Result<Color<N>, Doubts> {
    let last = |count: u32| N::point(f64::from(count - 1));
    let across = repeated(u)? * last(image.width);
    let down = (N::ONE - repeated(v)?) * last(image.height);
    let [columns, rows] = [(across, image.width), (down, image.height)];
    // Interpolation is continuous: near a texel, both of its sides count.
    let mut sum: Option<Color<N>> = None;
    for (row, t) in texels(rows)? {
        for (column, s) in texels(columns)? {
            let [right, below] = [
                (column + 1).min(image.width - 1),
                (row + 1).min(image.height - 1),
            ];
            let texel = |column, row| texel::<N>(image, column, row);
            let top = between(texel(column, row)?, texel(right, row)?, s);
            let bottom = between(texel(column, below)?, texel(right, below)?, s);
            let color = between(top, bottom, t).map(|channel| channel / N::point(255.0));
            sum = Some(match sum {
                None => color,
                Some(other) => std::array::from_fn(|k| color[k].hull(other[k])),
            });
        }
    }
    sum.ok_or(Doubts::SEAM)
}

/// a + (b − a)·s.
fn between<N: CertifiedNumber>(a: Color<N>, b: Color<N>, s: N) -> Color<N> {
    plus(a, times(plus(b, a.map(|channel| -channel)), s))
}

/// A coordinate repeated to [0, 1], where 1 stays 1; not known where it jumps.
fn repeated<N: CertifiedNumber>(coordinate: N) -> Result<N, Doubts> {
    if !coordinate.is_negative() && !N::ONE.is_below(coordinate) {
        // It may lie beyond an edge: that is no jump if the edge is its own.
        let is_inside = coordinate.low() >= 0.0 && coordinate.high() <= 1.0;
        return is_inside.then_some(coordinate).ok_or(Doubts::SEAM);
    }
    match coordinate.floors() {
        Some([first, last]) if first == last => Ok(coordinate - N::point(first)),
        _ => Err(Doubts::SEAM),
    }
}

/// The texels below a place and the weights of the next ones: one, or two near a texel.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the place is within the image"
)]
fn texels<N: CertifiedNumber>(
    (place, count): (N, u32),
) -> Result<impl Iterator<Item = (u32, N)>, Doubts> {
    let [first, last] = place.floors().ok_or(Doubts::SEAM)?;
    let clamped = |texel: f64| texel.clamp(0.0, f64::from(count - 1));
    let [first, last] = [first, last].map(clamped);
    let found = last - first <= 1.0;
    let texels = [Some(first), (last > first).then_some(last)];
    let weight = move |texel: f64| (texel as u32, place - N::point(texel));
    found
        .then(|| texels.into_iter().flatten().map(weight))
        .ok_or(Doubts::SEAM)
}

/// A texel in units of the full byte.
fn texel<N: CertifiedNumber>(image: &Image, column: u32, row: u32) -> Result<Color<N>, Doubts> {
    let size = match image.kind {
        Pixels::Rgb8 => 3,
        Pixels::Rgba8 => 4,
        Pixels::Rgb32f => return Err(Doubts::unsupported("textures")),
    };
    let start = (row as usize * image.width as usize + column as usize) * size;
    let bytes = image.pixels.get(start..start + 3);
    let bytes = bytes.ok_or(Doubts::unsupported("textures"))?;
    Ok([0, 1, 2].map(|k| N::point(f64::from(bytes[k]))))
}
