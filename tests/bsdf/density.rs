//! Samples fall as their density says: it integrates to what is sampled, and a χ² test finds no
//! difference.

use super::{lattice, sampled, variety, view};
use rtc::internals::math::Vec3;
use rtc::internals::render::{Bsdf, StandardParameters};
use std::f64::consts::{PI, TAU};

/// Bins over the sphere: along the cosine, and along the azimuth.
const BINS: [usize; 2] = [20, 20];

/// Steps of the midpoint rule in a bin, each way.
const STEPS: usize = 8;

const SAMPLES: u32 = 100_000;

/// A number in [0, 1) from a sequence that passes for random (PCG-XSH-RR, O'Neill 2014).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        let word = (((self.0 >> 18) ^ self.0) >> 27) as u32;
        f64::from(word.rotate_right((self.0 >> 59) as u32)) / 4_294_967_296.0
    }
}

fn direction(z: f64, azimuth: f64) -> Vec3 {
    let sine = (1.0 - z * z).max(0.0).sqrt();
    Vec3::new(sine * azimuth.cos(), sine * azimuth.sin(), z)
}

fn bin_of(w: Vec3) -> usize {
    let row = ((w.z + 1.0) / 2.0 * BINS[0] as f64) as usize;
    let column = (w.y.atan2(w.x).rem_euclid(TAU) / TAU * BINS[1] as f64) as usize;
    row.min(BINS[0] - 1) * BINS[1] + column.min(BINS[1] - 1)
}

/// The integral of the density over each bin.
fn expected(bsdf: &Bsdf) -> Vec<f64> {
    let (rows, columns) = (BINS[0] * STEPS, BINS[1] * STEPS);
    let mut bins = vec![0.0; BINS[0] * BINS[1]];
    for i in 0..rows {
        for j in 0..columns {
            let z = (i as f64 + 0.5) / rows as f64 * 2.0 - 1.0;
            let w = direction(z, (j as f64 + 0.5) / columns as f64 * TAU);
            bins[(i / STEPS) * BINS[1] + j / STEPS] +=
                bsdf.evaluate(w).pdf * 2.0 * TAU / (rows * columns) as f64;
        }
    }
    bins
}

/// Samples per bin, and the share of numbers that gave a direction.
fn observed(bsdf: &Bsdf, seed: u64) -> (Vec<f64>, f64) {
    let mut random = Random(seed);
    let mut bins = vec![0.0; BINS[0] * BINS[1]];
    let mut taken = 0;
    for _ in 0..SAMPLES {
        let u = [random.next(), random.next(), random.next()];
        if let Some(sample) = sampled(bsdf, u).filter(|sample| !sample.delta) {
            bins[bin_of(sample.wi)] += 1.0;
            taken += 1;
        }
    }
    (bins, f64::from(taken) / f64::from(SAMPLES))
}

/// The probability that χ² with `freedom` degrees is above `x`: Q(k/2, x/2) by series or continued
/// fraction.
fn tail(x: f64, freedom: f64) -> f64 {
    let (a, x) = (freedom / 2.0, x / 2.0);
    let front = (a * x.ln() - x - libm::lgamma(a)).exp();
    if x < a + 1.0 {
        let (mut term, mut sum) = (1.0 / a, 1.0 / a);
        for k in 1..1000 {
            term *= x / (a + f64::from(k));
            sum += term;
        }
        return 1.0 - front * sum;
    }
    // Lentz's method.
    let (mut b, mut c) = (x + 1.0 - a, f64::INFINITY);
    let mut d = 1.0 / b;
    let mut h = d;
    for k in 1..1000 {
        let an = -f64::from(k) * (f64::from(k) - a);
        b += 2.0;
        d = 1.0 / (an * d + b);
        c = b + an / c;
        h *= d * c;
    }
    front * h
}

/// Bins with fewer than 5 expected samples are pooled.
fn chi_squared(expected: &[f64], observed: &[f64]) -> f64 {
    let (mut sum, mut freedom, mut pool) = (0.0, -1.0, (0.0, 0.0));
    let mut add = |e: f64, o: f64| {
        sum += (o - e) * (o - e) / e;
        freedom += 1.0;
    };
    for (e, o) in expected.iter().zip(observed) {
        let e = e * f64::from(SAMPLES);
        if e >= 5.0 {
            add(e, *o)
        } else {
            pool = (pool.0 + e, pool.1 + o)
        }
    }
    if pool.0 >= 5.0 {
        add(pool.0, pool.1);
    }
    tail(sum, freedom)
}

#[test]
fn samples_follow_their_density() {
    let cosines = [0.9, 0.4, -0.7];
    let cases = variety().len() * cosines.len();
    // Šidák's correction for many tests at once.
    let limit = 1.0 - 0.99_f64.powf(1.0 / cases as f64);
    for (index, (name, standard)) in variety().into_iter().enumerate() {
        for (turn, cosine) in cosines.into_iter().enumerate() {
            let bsdf = Bsdf::new(&standard, view(cosine));
            let (bins, taken) = observed(&bsdf, (index * cosines.len() + turn) as u64 + 1);
            let expected = expected(&bsdf);
            let whole = expected.iter().sum::<f64>();
            assert!(
                (whole - taken).abs() < 0.006,
                "{name}, cos {cosine}: ∫ pdf = {whole}, {taken} taken"
            );
            let p = chi_squared(&expected, &bins);
            assert!(p > limit, "{name}, cos {cosine}: p = {p}");
        }
    }
}

#[test]
fn the_tail_of_chi_squared_is_known() {
    // Two degrees: exp(−x/2). One: erfc(√(x/2)).
    assert!((tail(3.0, 2.0) - (-1.5_f64).exp()).abs() < 1e-12);
    assert!((tail(9.0, 1.0) - libm::erfc(4.5_f64.sqrt())).abs() < 1e-12);
}

#[test]
fn a_sample_carries_what_evaluation_gives() {
    for (name, standard) in variety() {
        for cosine in [0.9, 0.3, -0.5] {
            let bsdf = Bsdf::new(&standard, view(cosine));
            for sample in (0..500)
                .filter_map(|k| sampled(&bsdf, lattice(k)))
                .filter(|sample| !sample.delta)
            {
                let value = bsdf.evaluate(sample.wi);
                let error =
                    (value.f - sample.f).abs().max_element() / (1.0 + sample.f.max_element());
                assert!(error < 1e-6, "{name}, cos {cosine}: {sample:?} {value:?}");
            }
        }
    }
}

#[test]
fn a_diffuse_surface_samples_by_the_cosine() {
    let lambert = StandardParameters {
        specular: 0.0,
        multiple_scattering: false,
        ..StandardParameters::default()
    };
    let bsdf = Bsdf::new(&lambert, view(0.4));
    for k in 0..100 {
        let sample = sampled(&bsdf, lattice(k)).unwrap();
        assert!((sample.pdf - sample.wi.z / PI).abs() < 1e-12 && !sample.delta);
    }
}
