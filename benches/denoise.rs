//! Denoises pictures with other seeds, and prints as Markdown how far they are from converged ones,
//! what is told of that, and how often the bound holds. Arguments are the folder of assets, the side
//! of a picture in pixels, the paths a pixel of each of two references, and how many seeds.
//! `benches/denoise.sh` runs it.

#![expect(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a measurement stops at the first surprise, and prints"
)]

#[path = "honest/limits.rs"]
#[expect(
    dead_code,
    reason = "the tests of many scenes at once are not asked here"
)]
mod limits;

use rtc::internals::image::{BackgroundFill, FileFormat, Image};
use rtc::internals::passes::ViewAndLight;
use rtc::internals::pipeline::{Input, Observer, Options, OutputTransform, PictureSetup};
use rtc::internals::plan::{Plan, Rules};
use rtc::internals::render::{AnyWorld, Job, Seeds};
use rtc::internals::study::{Errors, LEVELS, RenderOrder, probe};
use std::num::NonZeroU32;
use std::path::{Path, PathBuf};

/// The scenes: the name, and the file in the folder of assets.
const ASSETS: [[&str; 2]; 7] = [
    ["FlightHelmet", "FlightHelmet/FlightHelmet.gltf"],
    ["MetalRoughGrid", "own_MetalRoughGrid.glb"],
    ["TransmissionRoughnessTest", "TransmissionRoughnessTest.glb"],
    ["CornellLambert", "own_CornellLambert.glb"],
    ["GlassSphere", "own_GlassSphere.glb"],
    ["ClearCoatTest", "ClearCoatTest.glb"],
    ["SheenCloth", "SheenCloth.glb"],
];

/// The paths a pixel of a picture, and of the plain one it is to be as good as.
const SAMPLES: [u32; 2] = [16, 64];

/// A scene, ready to be rendered.
struct Case {
    world: AnyWorld,
    order: RenderOrder,
}

impl Case {
    /// As `rtc render` shows it, with so many paths a pixel at most.
    fn new(path: &Path, side: u32, paths: u32) -> Self {
        let kind = FileFormat::Png8;
        let look = OutputTransform::new(kind, None, None, BackgroundFill::Film, &[]).unwrap();
        let mut setup = PictureSetup::new(look);
        setup.overrides.size = Some([side; 2]);
        setup.overrides.spp = Some(paths);
        let mut input = Input::file(path, Options::default());
        input.stage(ViewAndLight::default());
        let loaded = input.load().unwrap();
        let mut subject = setup.validate(loaded, &mut input).unwrap().unwrap();
        let observer = Observer {
            on_step: &|_| (),
            is_stopped: &|| false,
        };
        setup.light(&mut subject, &mut input, &observer).unwrap();
        let window = setup.window(&subject.validated.lowered.scene).unwrap();
        let order = setup.order(&subject, window, None);
        let proof = &subject.validated.scene;
        let world = AnyWorld::prepare(proof, &Plan::new(proof, Rules::ALL));
        Self { world, order }
    }

    fn job(&self, seed: u64, samples: u32) -> Job {
        Job {
            crop: Some(self.order.crop),
            values: self.order.values,
            background: self.order.background,
            samples: NonZeroU32::new(samples),
            seeds: Seeds {
                pixel: seed,
                lens: seed,
                path: seed,
            },
            ..Job::default()
        }
    }

    /// A plain picture, linear.
    fn plain(&self, seed: u64, samples: u32) -> Image {
        let film = self.world.render(&self.job(seed, samples), &|_| true);
        film.unwrap().image
    }

    /// What a display shows of it.
    fn shown(&self, image: &Image) -> Image {
        let (tone, exposure) = self.order.display;
        let shown = |pixel: &[f64; 3]| tone.display(pixel.map(|value| value * exposure));
        Image {
            pixels: image.pixels.iter().map(shown).collect(),
            ..*image
        }
    }
}

/// What the seeds of a scene came to.
#[derive(Default)]
struct Tally {
    pictures: u64,
    /// Of plain pictures of few and of many paths, and of denoised ones.
    relative: [f64; 3],
    flip: [f64; 3],
    /// The mean square errors of a denoised picture, in squares of grey levels: the true one, what is told,
    /// the bound, and what halves of the samples would tell.
    squares: [f64; 4],
    held: u64,
    /// So many say that there is no bound; what they say of what samples met counts for the others.
    unbounded: u64,
    rays: [f64; 2],
}

impl Tally {
    fn add(&mut self, other: &Self) {
        self.pictures += other.pictures;
        self.held += other.held;
        self.unbounded += other.unbounded;
        let sums = [
            (&mut self.relative[..], &other.relative[..]),
            (&mut self.flip[..], &other.flip[..]),
            (&mut self.squares[..], &other.squares[..]),
            (&mut self.rays[..], &other.rays[..]),
        ];
        for (sums, values) in sums {
            sums.iter_mut()
                .zip(values)
                .for_each(|(sum, value)| *sum += value);
        }
    }

    /// One picture of a seed.
    fn of(case: &Case, seed: u64, [a, b]: &[Image; 2]) -> Self {
        let middle = Image {
            pixels: zip(a, b, |a, b| 0.5 * (a + b)),
            ..*a
        };
        let errors =
            |image: &Image| Errors::of(&[case.shown(image)], std::slice::from_ref(&middle), 1.0);
        let [few, many] = SAMPLES.map(|samples| case.plain(seed, samples));
        let job = case.job(seed, SAMPLES[0]);
        let picture = case
            .world
            .denoised(SAMPLES[0], &job, &|_| true, &|| ())
            .unwrap();
        let order = RenderOrder { seed, ..case.order };
        let probed = probe(&case.world, &order, &picture, SAMPLES[0], &|_| true).unwrap();
        let shown = case.shown(&picture.film.image);
        let truth = mean(&shown, a, b);
        let all = [errors(&few), errors(&many), errors(&picture.film.image)];
        let levels = |square: f64| square * LEVELS * LEVELS;
        Self {
            pictures: 1,
            relative: all.map(|errors| errors.relative_mse),
            flip: all.map(|errors| errors.flip),
            squares: [
                levels(truth),
                probed.estimate * probed.estimate,
                probed.error * probed.error,
                levels(case.by_halves(seed, &few)),
            ],
            held: u64::from(
                probed.undersampled.is_none() && levels(truth) <= probed.error * probed.error,
            ),
            unbounded: u64::from(probed.undersampled.is_some()),
            rays: [
                picture.film.counts.rays() as f64,
                probed.counts.rays() as f64,
            ],
        }
    }

    /// The pictures that have a bound.
    fn bounded(&self) -> u64 {
        self.pictures - self.unbounded
    }

    fn print(&self, name: &str) {
        let n = self.pictures as f64;
        let [plain, more, denoised] = self.relative.map(|sum| sum / n);
        let flip = self.flip.map(|sum| sum / n);
        let [truth, probed, bound, halves] = self.squares.map(|sum| (sum / n).max(0.0).sqrt());
        println!(
            "| {name} | {plain:.5} | {more:.5} | {denoised:.5} | {:.3} | {:.3} | {:.3} | {truth:.2} | {probed:.2} | {bound:.2} | {} of {} | {} | {halves:.2} | {:.0} % |",
            flip[0],
            flip[1],
            flip[2],
            self.held,
            self.bounded(),
            self.unbounded,
            100.0 * self.rays[1] / self.rays[0]
        );
    }
}

impl Case {
    /// What halves of the samples tell of the mean square error: one half, denoised, against the other,
    /// whose variance is taken off, and half of that for twice as many samples.
    fn by_halves(&self, seed: u64, whole: &Image) -> f64 {
        let half = SAMPLES[0] / 2;
        let first = self.plain(seed, half);
        let second = Image {
            pixels: zip(whole, &first, |whole, first| 2.0 * whole - first),
            ..*whole
        };
        let job = self.job(seed, half);
        let denoised = self.world.denoised(half, &job, &|_| true, &|| ()).unwrap();
        let [a, b, d] = [&first, &second, &denoised.film.image].map(|image| self.shown(image));
        0.5 * (mean(&d, &b, &b) - 0.5 * mean(&a, &b, &b))
    }
}

fn zip(a: &Image, b: &Image, of: impl Fn(f64, f64) -> f64) -> Vec<[f64; 3]> {
    let pixels = a.pixels.iter().zip(&b.pixels);
    pixels
        .map(|(a, b)| [0, 1, 2].map(|c| of(a[c], b[c])))
        .collect()
}

/// The mean of the products of the differences of a picture from two others.
fn mean(test: &Image, a: &Image, b: &Image) -> f64 {
    let [a, b] = [a, b].map(|other| zip(test, other, |test, other| test - other));
    let products = a
        .iter()
        .flatten()
        .zip(b.iter().flatten())
        .map(|(a, b)| a * b);
    products.sum::<f64>() / (3 * a.len()) as f64
}

fn main() {
    let words: Vec<_> = std::env::args()
        .skip(1)
        .filter(|word| word != "--bench")
        .collect();
    let [assets, side, paths, seeds] = &words[..] else {
        panic!("usage: denoise ASSETS SIDE PATHS SEEDS");
    };
    let numbers = [side, paths, seeds].map(|word| word.parse::<u32>().unwrap());
    let [side, paths, seeds] = numbers;
    let vases = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/vases.yaml");
    let assets = ASSETS.map(|[name, file]| (name, Path::new(assets).join(file)));
    let scenes: Vec<(&str, PathBuf)> = assets.into_iter().chain([("`vases`", vases)]).collect();
    println!(
        "| scene | relMSE 16 | relMSE 64 | denoised | FLIP 16 | FLIP 64 | denoised | true error | told | bound | held | no bound | by halves | rays of probes |"
    );
    println!("| --- |{}", " --: |".repeat(13));
    let mut sum = Tally::default();
    for (name, path) in scenes {
        let case = Case::new(&path, side, paths);
        let references = [90_001, 90_002].map(|seed| case.shown(&case.plain(seed, paths)));
        let mut tally = Tally::default();
        for seed in 0..u64::from(seeds) {
            tally.add(&Tally::of(&case, 10_000 + seed, &references));
        }
        tally.print(name);
        sum.add(&tally);
    }
    let limit = limits::lower(sum.held, sum.bounded());
    println!(
        "\nHeld: {} of {}; with 95 % confidence at least {limit:.3} of all.",
        sum.held,
        sum.bounded()
    );
}
