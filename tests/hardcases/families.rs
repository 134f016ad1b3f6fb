//! Families of rays, our own and those of the files: |t − t*| ≤ 2(1 + κ)u|t*|, no hit missed and
//! none invented.

use super::exact::{Truth, sides, truth};
use super::family::{FAMILIES, Family};
use super::random::{Random, rays};
use super::scenes::{cone, cylinder, plane, sphere, torus, triangle, world};
use super::truth::{Report, Table, tables};
use rayon::prelude::*;
use rtc::internals::ir;
use rtc::internals::math::{DoubleDouble, U, Vec3};
use rtc::internals::render::Ray;

/// Spheres and planes are right to this many u whatever κ.
const ABSOLUTE: f64 = 64.0;

/// Beyond this κ a hit may be missed.
const DOUBT: f64 = 1.0 / (64.0 * U);

/// What became of the rows of a family.
#[derive(Clone, Copy, Default)]
struct Outcome {
    rows: u64,
    missed: u64,
    invented: u64,
    /// In u.
    worst: f64,
    /// In u·(1 + κ).
    worst_of_kappa: f64,
}

impl Outcome {
    fn of(shape: ir::Shape, ray: &Ray, truth: &Truth) -> Self {
        let mut outcome = Self {
            rows: 1,
            ..Self::default()
        };
        match (world([shape]).closest_hit(ray), truth.t) {
            (Some(hit), Some(exact)) => {
                assert!(hit.t > 0.0 && hit.t.is_finite(), "{ray:?}: {hit:?}");
                let error =
                    (DoubleDouble::from(hit.t) - exact).to_f64().abs() / (U * exact.to_f64());
                (outcome.worst, outcome.worst_of_kappa) = (error, error / (1.0 + truth.kappa));
            }
            (None, Some(_)) => outcome.missed = u64::from(truth.kappa < DOUBT),
            (Some(_), None) => outcome.invented = 1,
            (None, None) => {}
        }
        outcome
    }

    fn plus(self, other: Self) -> Self {
        Self {
            rows: self.rows + other.rows,
            missed: self.missed + other.missed,
            invented: self.invented + other.invented,
            worst: self.worst.max(other.worst),
            worst_of_kappa: self.worst_of_kappa.max(other.worst_of_kappa),
        }
    }

    /// Whether all gates hold.
    fn passes(&self, kind: &str) -> bool {
        let absolute = !matches!(kind, "sphere" | "plane") || self.worst <= ABSOLUTE;
        self.missed + self.invented == 0 && self.worst_of_kappa <= 2.0 && absolute
    }

    /// The columns of a row of `benches/hard-cases.md`.
    fn columns(&self) -> String {
        let Self {
            rows,
            missed,
            invented,
            worst,
            worst_of_kappa,
        } = self;
        format!("{rows} | {missed} | {invented} | {worst:.1} | {worst_of_kappa:.2}")
    }
}

/// Rows of our own families: 250 of each unless `RTC_RAYS` says otherwise.
fn rows() -> u64 {
    (rays(1) / 4000).clamp(50, 25_000)
}

fn family((shape, kind, make): &Family) -> Outcome {
    let seed = shape
        .bytes()
        .chain(kind.bytes())
        .fold(0, |seed: u64, byte| seed.wrapping_mul(31) ^ u64::from(byte));
    let row = |index: u64| {
        let (shape, ray) = make(&mut Random::at(seed, index));
        // Where a ray passes within rounding of an edge either answer is right; closed meshes ask
        // about those.
        let near_edge = |t: &ir::Triangle| {
            sides(t.vertices, &ray)
                .iter()
                .any(|side| side.abs() < 64.0 * U)
        };
        if matches!(&shape, ir::Shape::Triangle(t) if near_edge(t)) {
            return Outcome::default();
        }
        let truth = truth(&shape, &ray).unwrap();
        Outcome::of(shape, &ray, &truth)
    };
    (0..rows())
        .into_par_iter()
        .map(row)
        .reduce(Outcome::default, Outcome::plus)
}

#[test]
fn our_own_families() {
    let mut report = Report::default();
    for (shape, kind, make) in FAMILIES {
        let outcome = family(&(shape, kind, make));
        println!("| truth | {shape} {kind} | {} |", outcome.columns());
        report.line(
            &format!("{shape} {kind}"),
            outcome.passes(shape),
            &outcome.columns(),
        );
    }
    report.finish();
}

fn shape(kind: &str, f: &[f64]) -> ir::Shape {
    let point = |k: usize| [f[k], f[k + 1], f[k + 2]];
    match kind {
        "sphere" => sphere(point(6), f[9]),
        "plane" => plane(point(6), point(9)),
        "triangle" => triangle([point(6), point(9), point(12)]),
        "cylinder" => cylinder(point(6), point(9), f[13], f[12]),
        "cone" => {
            let axis = Vec3::from_array(point(9));
            cone(point(6), (axis * (f[13] / axis.length())).to_array(), f[12])
        }
        "torus" => torus(point(6), point(9), f[12], f[13]),
        _ => panic!("a family of an unknown shape `{kind}`"),
    }
}

/// The families of the table, whose truth has 200 digits; ours must agree with it.
#[test]
fn families_of_the_table() {
    let mut report = Report::default();
    let tables = tables();
    assert_eq!(tables.iter().map(|t| t.rows.len()).sum::<usize>(), 1984);
    for Table {
        id,
        shape: kind,
        rows,
    } in tables
    {
        let (mut outcome, mut apart) = (Outcome::default(), 0.0_f64);
        for row in rows {
            let [hit, high, low, kappa] = row[row.len() - 4..].try_into().unwrap();
            let ray = Ray {
                origin: Vec3::from_slice(&row[0..3]),
                direction: Vec3::from_slice(&row[3..6]),
            };
            let t = (hit == 1.0).then(|| DoubleDouble::from(high) + DoubleDouble::from(low));
            let ours = truth(&shape(kind, &row), &ray).unwrap().t;
            assert_eq!(ours.is_some(), t.is_some(), "{id}: {ray:?}");
            if let (Some(ours), Some(t)) = (ours, t) {
                apart = apart.max(((ours - t) / t).to_f64().abs() / (1.0 + kappa));
            }
            outcome = outcome.plus(Outcome::of(shape(kind, &row), &ray, &Truth { t, kappa }));
        }
        // The file gives a cone by axis and height, the scene by their product, rounded.
        let agree = apart <= if kind == "cone" { 2.0 * U } else { 1e-24 };
        let detail = format!("{}, truths {apart:.1e}·(1 + κ) apart", outcome.columns());
        report.line(id, agree && outcome.passes(kind), &detail);
    }
    report.finish();
}
