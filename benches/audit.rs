//! Audits pictures that were tampered with, and pictures that were not, and prints what was found
//! as tables in Markdown. It exits with 1 if a tampered tile was drawn and not found, if a bound
//! holds less often than it says, or if an alarm is false. With `write FOLDER` it writes pictures,
//! and with `read FOLDER` it audits those that another machine wrote. `benches/audit.sh` runs it.

#![expect(
    clippy::unwrap_used,
    clippy::print_stdout,
    clippy::print_stderr,
    clippy::disallowed_methods,
    reason = "a measurement stops at the first surprise, prints what it finds, and writes pictures"
)]

#[path = "../tests/tampered.rs"]
mod tampered;

use rtc::internals::image::{FileFormat, WrittenPicture};
use rtc::internals::pipeline::{
    AuditResult, PictureSetup, RenderError, RenderShard, ShardDivision, ShardPlan, TileDraw,
};
use rtc::internals::render::SimdLevel;
use rtc::internals::study::least_faults;
use std::path::Path;
use std::process::ExitCode;
use tampered::{
    Made, OBSERVER, Recipe, ValidatedScene, audit, numbers, read, recipes, setup, validated,
};

/// So many tiles are drawn of each tampered picture.
const DRAWN: u64 = 5;

/// What differs from the promises.
struct Faults(u64);

fn main() -> ExitCode {
    let mut faults = Faults(0);
    let words: Vec<String> = std::env::args()
        .skip(1)
        .filter(|word| word != "--bench")
        .collect();
    match &words[..] {
        [word, folder] if word == "write" => write_pictures(Path::new(folder)),
        [word, folder] if word == "read" => {
            pictures_of_another_machine(Path::new(folder), &mut faults)
        }
        _ => {
            tampered_pictures(&mut faults);
            stated_probability(&mut faults);
            false_alarms(&mut faults);
        }
    }
    eprintln!("{} faults", faults.0);
    match faults.0 {
        0 => ExitCode::SUCCESS,
        _ => ExitCode::FAILURE,
    }
}

impl Faults {
    fn count(&mut self, is_fault: bool) {
        self.0 += u64::from(is_fault);
    }
}

/// A way to tamper with a picture: its name, how many pictures of a recipe are made, and the
/// picture with its tile, if only that is changed.
type Tampering = (
    &'static str,
    u64,
    fn(&Made, &mut dyn FnMut(u64) -> u64) -> (WrittenPicture, Option<u64>),
);

const TAMPERINGS: [Tampering; 4] = [
    ("a bit of a sample", 84, |made, random| {
        let (written, tile) = made.with_flipped_sample(&mut |bound| random(bound));
        (written, Some(tile))
    }),
    (
        "the hash of a tile, with a root that fits",
        42,
        |made, random| {
            let (written, tile) = made.with_other_hash(&mut |bound| random(bound));
            (written, Some(tile))
        },
    ),
    ("a bit of version, scene or settings", 21, |made, random| {
        (
            made.with_flipped_word(&mut |bound| random(bound), false),
            None,
        )
    }),
    ("the same, with a root that fits", 21, |made, random| {
        (
            made.with_flipped_word(&mut |bound| random(bound), true),
            None,
        )
    }),
];

/// Tampers with pictures of each recipe, and audits them.
fn tampered_pictures(faults: &mut Faults) {
    println!(
        "| changed | pictures | tile drawn | found | not drawn | found | all drawn | found | refused |"
    );
    println!("| --- | --: | --: | --: | --: | --: | --: | --: | --: |");
    let made: Vec<Made> = recipes().into_iter().map(Made::new).collect();
    let mut random = numbers(1);
    for (name, count, tamper) in TAMPERINGS {
        // Drawn and found, not drawn and found, all drawn and found, refused.
        let mut row = [0_u64; 8];
        for made in &made {
            for seed in 0..count {
                let (written, tile) = tamper(made, &mut random);
                let draws = [DRAWN, u64::MAX].map(|tiles| TileDraw { tiles, seed });
                let at_once = |draw| audit(&written, &made.recipe, draw, (2, SimdLevel::best()));
                let [some, all] = draws.map(at_once);
                row[0] += 1;
                if let (Some(tile), Ok(some)) = (tile, &some) {
                    let is_drawn = some.drawn.contains(&tile);
                    let is_found = !some.findings.is_empty();
                    let column = if is_drawn { 1 } else { 3 };
                    row[column] += 1;
                    row[column + 1] += u64::from(is_found);
                    faults.count(is_drawn != is_found);
                }
                match is_refuted(&all) {
                    None => row[7] += 1,
                    Some(is_found) => {
                        row[5] += 1;
                        row[6] += u64::from(is_found);
                        faults.count(!is_found);
                    }
                }
            }
        }
        let cells = row.map(|number| number.to_string()).join(" | ");
        println!("| {name} | {cells} |");
    }
}

/// Whether something was found; `None` if the picture was refused.
fn is_refuted(result: &Result<AuditResult, RenderError>) -> Option<bool> {
    match result {
        Ok(result) => Some(!result.findings.is_empty()),
        Err(RenderError::Refused(_)) => None,
        Err(other) => panic!("{other:?}"),
    }
}

/// Damages as many tiles as the bound says that there are not, and counts how often a draw misses
/// them all: that must be rarer than the 2 % that are left to it.
fn stated_probability(faults: &mut Faults) {
    const SEEDS: u64 = 6000;
    let recipe = Recipe {
        size: [160, 128],
        ..Recipe::of("one-light-shadows.yaml", FileFormat::Png8)
    };
    let made = Made::new(recipe);
    let all = made.tiles() as u64;
    println!("\n| tiles | drawn | fewer than | damaged | draws that miss, of {SEEDS} | expected |");
    println!("| --: | --: | --: | --: | --: | --: |");
    for drawn in [4, 8, 16, 32, 60] {
        let bound = least_faults(all, drawn, 50).unwrap();
        for damaged in [bound, bound.saturating_sub(1).max(1)] {
            let written = made.with_damaged_tiles(damaged);
            let missed = (0..SEEDS).filter(|seed| {
                let draw = TileDraw {
                    tiles: drawn,
                    seed: seed + 10_000 * drawn,
                };
                let result = audit(&written, &recipe, draw, (2, SimdLevel::best())).unwrap();
                result.findings.is_empty()
            });
            let missed = missed.count() as f64 / SEEDS as f64;
            // ∏ (N−d−i) / (N−i), as the binomial coefficients are cancelled.
            let expected: f64 = (0..drawn)
                .map(|i| (all - damaged).saturating_sub(i) as f64 / (all - i) as f64)
                .product();
            println!(
                "| {all} | {drawn} | {bound} | {damaged} | {:.2} % | {:.2} % |",
                100.0 * missed,
                100.0 * expected
            );
            // Four standard deviations above what is expected.
            let spread = (expected * (1.0 - expected) / SEEDS as f64).sqrt();
            faults.count((missed - expected).abs() > 4.0 * spread + 0.001);
            faults.count(damaged >= bound && expected > 0.02);
        }
    }
}

/// How a picture is made, and what of it is audited.
#[derive(Clone, Copy)]
enum Way {
    Whole,
    Merged(ShardDivision),
    Part(ShardDivision),
}

/// Audits what was made as it should be, mostly on other threads and at other levels than
/// those on which it was made.
fn false_alarms(faults: &mut Faults) {
    let levels: Vec<SimdLevel> = SimdLevel::NAMES
        .into_iter()
        .filter_map(SimdLevel::named)
        .collect();
    println!("\n| what was audited | audits | tiles made anew | false alarms |");
    println!("| --- | --: | --: | --: |");
    let ways = [
        ("a picture", Way::Whole),
        (
            "a picture merged of parts by tiles",
            Way::Merged(ShardDivision::Tiles),
        ),
        (
            "a picture merged of parts by samples",
            Way::Merged(ShardDivision::Samples),
        ),
        ("a part by tiles", Way::Part(ShardDivision::Tiles)),
        ("a part by samples", Way::Part(ShardDivision::Samples)),
    ];
    for (name, way) in ways {
        let by_samples = matches!(
            way,
            Way::Merged(ShardDivision::Samples) | Way::Part(ShardDivision::Samples)
        );
        let recipes: Vec<Recipe> = recipes()
            .into_iter()
            .filter(|recipe| !by_samples || recipe.paths.is_some())
            .map(|recipe| match by_samples {
                // More than one block of samples, for parts.
                true => Recipe {
                    paths: Some(50),
                    ..recipe
                },
                false => recipe,
            })
            .collect();
        let [mut tiles, mut alarms] = [0, 0];
        for index in 0..50 {
            let recipe = recipes[index % recipes.len()];
            let round = index / recipes.len();
            let made_on = (1 + index % 4, levels[round % levels.len()]);
            let audited_on = (
                1 + (index + round + 1) % 4,
                levels[(round + 1 + index) % levels.len()],
            );
            let result = audited(&recipe, way, index as u64, (made_on, audited_on));
            tiles += result.drawn.len();
            alarms += usize::from(!result.findings.is_empty());
        }
        println!("| {name} | 50 | {tiles} | {alarms} |");
        faults.count(alarms > 0);
    }
    let names: Vec<&str> = levels.iter().map(|level| level.name()).collect();
    println!("\nInstructions: {}; 1 to 4 threads.", names.join(", "));
}

/// Writes a picture of each recipe into a folder.
fn write_pictures(folder: &Path) {
    for (index, recipe) in recipes().into_iter().enumerate() {
        std::fs::write(folder.join(index.to_string()), Made::new(recipe).file()).unwrap();
    }
}

/// Audits all tiles of the pictures that another machine wrote into a folder.
fn pictures_of_another_machine(folder: &Path, faults: &mut Faults) {
    let [mut tiles, mut alarms] = [0, 0];
    for (index, recipe) in recipes().into_iter().enumerate() {
        let written = read(&std::fs::read(folder.join(index.to_string())).unwrap()).unwrap();
        let all = TileDraw {
            tiles: u64::MAX,
            seed: 0,
        };
        let result = audit(&written, &recipe, all, (1, SimdLevel::best())).unwrap();
        tiles += result.drawn.len();
        alarms += usize::from(!result.findings.is_empty());
    }
    println!(
        "| {} | {} | {tiles} | {alarms} |",
        std::env::consts::ARCH,
        recipes().len()
    );
    faults.count(alarms > 0);
}

/// Threads and instructions.
type Machine = (usize, SimdLevel);

/// Makes a picture or a part of it on one machine, and audits all of it on another.
fn audited(
    recipe: &Recipe,
    way: Way,
    seed: u64,
    (made_on, audited_on): (Machine, Machine),
) -> AuditResult {
    let all = TileDraw {
        tiles: u64::MAX,
        seed,
    };
    let on = |setup: PictureSetup, (threads, simd): Machine| PictureSetup {
        threads,
        simd,
        ..setup
    };
    let ValidatedScene { setup, mut subject } = validated(recipe, on(setup(recipe), made_on));
    let window = setup.window(&subject.validated.lowered.scene).unwrap();
    let mut part = |by, first, last| {
        let shares = ShardPlan {
            by,
            first,
            last,
            count: 3,
        };
        let part = setup
            .part(&mut subject, (shares, window, u64::MAX), &OBSERVER)
            .unwrap();
        RenderShard::load(&part.save(), 1 << 20).unwrap()
    };
    match way {
        Way::Whole => {
            let written = Made::with(*recipe, made_on).written();
            audit(&written, recipe, all, audited_on).unwrap()
        }
        Way::Merged(by) => {
            let mut whole = part(by, 1, 1);
            whole.add(part(by, 3, 3)).unwrap();
            whole.add(part(by, 2, 2)).unwrap();
            let picture = whole.develop().unwrap().0;
            let bytes = whole.look().encode(&picture, || whole.metadata()).unwrap();
            audit(&read(&bytes).unwrap(), recipe, all, audited_on).unwrap()
        }
        Way::Part(by) => {
            let part = part(by, 2, 2);
            let anew = on(part.setup().unwrap(), audited_on);
            let ValidatedScene { setup, mut subject } = validated(recipe, anew);
            part.audit(&setup, &mut subject, (all, u64::MAX), &OBSERVER)
                .unwrap()
        }
    }
}
