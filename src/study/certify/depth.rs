//! Depth buffers: distances as greys, `(t_max − t)/(t_max − t_min)`, of the rays through the
//! middles of pixels.

use super::number::CertifiedNumber;
use super::shape::FirstHit;
use super::{CertifiedView, Doubts, PixelCertificate, Views};

/// The distance of a pixel.
#[derive(Clone, Copy)]
enum PixelDepth<N> {
    Nothing,
    Known(N),
    /// It is in this range, or there is none.
    Unclear([f64; 2], Doubts),
}

/// The certificates of all pixels; `None` if stopped.
pub(super) fn certificates(
    views: &Views<'_>,
    is_stopped: &(dyn Fn() -> bool + Sync),
) -> Option<Vec<PixelCertificate>> {
    let width = views.source.camera.size[0] as usize;
    let depths = views.pixels(is_stopped, |pixel| depth(&views.narrow, pixel))?;
    let place = |index: usize| [index % width, index / width].map(rtc_math::to_u32);
    let extremes = extremes(depths.iter().copied());
    // Evaluate the extremes again among the pixels that may have them.
    let may_be = |depth: &PixelDepth<_>| match depth {
        PixelDepth::Nothing => false,
        PixelDepth::Known(t) => extremes.iter().any(|end| overlaps(*t, *end)),
        PixelDepth::Unclear(..) => true,
    };
    let wide_extremes = || {
        let chosen = depths.iter().enumerate().filter(|(_, depth)| may_be(depth));
        let chosen = chosen.map(|(index, _)| depth(views.wide(), place(index)));
        self::extremes(chosen.take_while(|_| !is_stopped()))
    };
    let wide_extremes = std::sync::LazyLock::new(wide_extremes);
    let certificate = |index: usize| {
        let first = grey(depths[index], extremes);
        first.or(|| grey(depth(views.wide(), place(index)), *wide_extremes))
    };
    let certificates = (0..depths.len()).map(|index| (!is_stopped()).then(|| certificate(index)));
    certificates.collect()
}

fn depth<N: CertifiedNumber>(view: &CertifiedView<'_, N>, pixel: [u32; 2]) -> PixelDepth<N> {
    let ray = view.camera.middle(pixel);
    match view.scene.surfaces.first_hit(&ray) {
        FirstHit::Nothing => PixelDepth::Nothing,
        FirstHit::Surface(_, hit) => PixelDepth::Known(hit.t),
        FirstHit::Unclear(range, doubts) => PixelDepth::Unclear(range, doubts),
    }
}

fn overlaps<N: CertifiedNumber>(a: N, b: N) -> bool {
    !a.is_below(b) && !b.is_below(a)
}

/// The least and the greatest distance.
fn extremes<N: CertifiedNumber>(depths: impl Iterator<Item = PixelDepth<N>>) -> [N; 2] {
    let mut known: Option<[N; 2]> = None;
    let mut unclear: Option<[f64; 2]> = None;
    for depth in depths {
        match depth {
            PixelDepth::Nothing => {}
            PixelDepth::Known(t) => {
                let [near, far] = known.unwrap_or([t; 2]);
                known = Some([lesser(near, t), -lesser(-far, -t)]);
            }
            PixelDepth::Unclear([low, high], _) => {
                let [least, most] = unclear.unwrap_or([low, high]);
                unclear = Some([least.min(low), most.max(high)]);
            }
        }
    }
    // What is unclear may be nearer or farther.
    match (known, unclear) {
        (Some([near, far]), Some([low, high])) => [
            if low < near.low() {
                near.hull(N::between(low, near.low()))
            } else {
                near
            },
            if high > far.high() {
                far.hull(N::between(far.high(), high))
            } else {
                far
            },
        ],
        (Some(ends), None) => ends,
        (None, _) => [N::ALL; 2],
    }
}

/// The lesser of two numbers.
fn lesser<N: CertifiedNumber>(a: N, b: N) -> N {
    if a.is_below(b) {
        a
    } else if b.is_below(a) {
        b
    } else {
        a.hull(b)
    }
}

fn grey<N: CertifiedNumber>(depth: PixelDepth<N>, [near, far]: [N; 2]) -> PixelCertificate {
    match depth {
        PixelDepth::Nothing => PixelCertificate::of([N::ZERO; 3], Doubts::NONE),
        PixelDepth::Unclear(_, doubts) => PixelCertificate::of([N::ALL; 3], doubts),
        PixelDepth::Known(t) => {
            let grey = (far - t) / (far - near);
            PixelCertificate::of([grey; 3], Doubts::NONE)
        }
    }
}
