//! Renders families of scenes to a target error, many times each, and prints how many pictures keep
//! the reported error bound, as tables in Markdown. Arguments: the minimum number of pictures of a
//! family, and the families (by default all). `benches/honest.sh` runs it.

#![expect(clippy::print_stdout, reason = "it prints what it measured")]

#[path = "honest/families.rs"]
mod families;
#[path = "honest/limits.rs"]
mod limits;
#[path = "../tests/honest/patterns.rs"]
mod patterns;
#[path = "../tests/honest/scenes.rs"]
mod scenes;

use families::{Family, Truth};
use std::sync::LazyLock;

/// The promised fraction of pictures that keep the bound.
const PROMISE: f64 = 0.9;

/// The results of the pictures of a scene.
#[derive(Default)]
struct Tally {
    pictures: u64,
    /// The number of pictures without a bound, which no other field counts.
    unbounded: u64,
    /// The number of pictures with an error within the bound.
    kept: u64,
    /// The number of pictures with an error within the target.
    under: u64,
    /// The sums of the squared true errors and of the squared bounds.
    squares: [f64; 2],
    /// The largest ratio of error to bound.
    worst: f64,
    /// The sum of the mean samples per pixel.
    samples: f64,
}

impl Tally {
    fn add(&mut self, other: &Self) {
        self.pictures += other.pictures;
        self.unbounded += other.unbounded;
        self.kept += other.kept;
        self.under += other.under;
        (0..2).for_each(|i| self.squares[i] += other.squares[i]);
        self.worst = self.worst.max(other.worst);
        self.samples += other.samples;
    }

    /// Renders a scene once for each seed.
    fn of(scene: &families::Case, target: f64, seeds: u64) -> Self {
        // Pictures without a bound need no references.
        let references = LazyLock::new(|| scenes::references(scene.scene(), target));
        let mut tally = Self::default();
        for seed in 1..=seeds {
            let reached = scenes::render(scene.scene(), target, seed);
            if reached.undersampled.is_some() {
                tally.unbounded += 1;
                continue;
            }
            let error = match &scene.reference {
                Truth::Known(pattern) => pattern.error(&reached),
                Truth::Rendered(_) => scenes::error(&reached, &references),
            };
            tally.add(&Self {
                pictures: 1,
                unbounded: 0,
                kept: u64::from(error <= reached.error),
                under: u64::from(error <= target),
                squares: [error * error, reached.error * reached.error],
                worst: if error == 0.0 {
                    0.0
                } else {
                    error / reached.error
                },
                samples: reached.samples.mean,
            });
        }
        tally
    }

    fn print(&self, name: &str, last: &str) {
        // Without a bound there is nothing to compare.
        if self.pictures == 0 {
            println!(
                "| {name} | 0 | {} |{} {last} |",
                self.unbounded,
                " – |".repeat(7)
            );
            return;
        }
        let limit = limits::lower(self.kept, self.pictures);
        println!(
            "| {name} | {} | {} | {} | {limit:.3} | {} | {:.2} | {:.2} | {:.0} | {last} |",
            self.pictures,
            self.unbounded,
            self.kept,
            self.under,
            (self.squares[0] / self.squares[1]).sqrt(),
            self.worst,
            self.samples / self.pictures as f64
        );
    }
}

fn main() {
    let mut words = std::env::args().skip(1).filter(|word| word != "--bench");
    let least = words.next().and_then(|word| word.parse().ok());
    let least: u64 = least.unwrap_or(200);
    let names: Vec<String> = words.collect();
    let is_asked = |family: &Family| names.is_empty() || names.iter().any(|n| n == family.name);
    println!(
        "| family | pictures with a bound | without | within the error said | 95 % limit | \
         within the target | true over said | worst | samples a pixel | scenes below 0.9 |"
    );
    println!("| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |");
    for family in families::all().into_iter().filter(is_asked) {
        let count = family.cases.len() as u64;
        let seeds = least.div_ceil(count).max(8);
        let tallies: Vec<_> = family
            .cases
            .iter()
            .map(|case| Tally::of(case, family.target, seeds))
            .collect();
        let of = |tally: &Tally| limits::at_most(tally.kept, tally.pictures, PROMISE);
        let below = limits::holm(tallies.iter().map(of).collect());
        let mut sum = Tally::default();
        tallies.iter().for_each(|tally| sum.add(tally));
        let name = format!("{}, to {}", family.name, family.target);
        sum.print(&name, &format!("{below} of {count}"));
        for (case, tally) in family.cases.iter().zip(&tallies) {
            if of(tally) < 0.05 {
                tally.print(&format!("— {}", case.name), "");
            }
        }
    }
}
