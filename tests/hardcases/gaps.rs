//! Rays start no further off than they must: a gap of 10⁻¹³ of the scale behind a surface is still
//! seen.

use super::random::{Random, rays, tally};
use super::solids::{Form, KINDS, Kind, first, hit, icosphere};
use rtc::internals::render::{PreparedMesh, Ray};
use std::sync::Arc;

/// Of the scale.
const GAP: f64 = 1e-13;

/// Rays of one shape.
const CHUNK: u64 = 64;

/// Rays through the first of two surfaces, and those that did not find the second.
fn chunk(kind: Kind, mesh: &Arc<PreparedMesh>, index: u64) -> (u64, u64) {
    let mut random = Random::at(3, index);
    let size = random.magnitude(1e-6, 1e8);
    let center = random.cube() * (0.25 * size);
    let form = Form::random(kind, &mut random, size, center, mesh);
    let (outer, inner) = (form.shape(), form.inner(GAP * size).shape());
    let (mut asked, mut bad) = (0, 0);
    for _ in 0..CHUNK {
        let target = form.target(&mut random);
        let origin = target + random.direction() * (4.0 * size);
        let ray = Ray {
            origin,
            direction: target - origin,
        };
        let Some(at) = first(&form, &outer, &ray) else {
            continue;
        };
        let cosine = ray.direction.normalize().dot(at.normal);
        let from_front = !kind.is_solid() || cosine < 0.0;
        if cosine.abs() < 0.2 || !from_front {
            continue;
        }
        let background = if kind.is_solid() || cosine < 0.0 {
            ray.direction
        } else {
            -ray.direction
        };
        asked += 1;
        let slack = 32.0 * GAP * size / background.length();
        bad += u64::from(hit(&inner, &at.ray(background)).is_none_or(|(t, _)| t > slack));
    }
    (asked, bad)
}

#[test]
fn a_gap_of_a_ten_trillionth_is_seen() {
    let mesh = icosphere();
    let bad = KINDS.map(|(kind, name)| {
        tally("gaps not seen", name, rays(KINDS.len()) / CHUNK, |k| {
            chunk(kind, &mesh, k)
        })
        .bad
    });
    assert_eq!(bad, [0; KINDS.len()]);
}
