//! Denoises pictures with other seeds, and prints as Markdown how far they are from converged ones,
//! what is told of that, how often the bound holds, and how often a picture is worse than the plain
//! one. Arguments are the side of a picture in pixels, the paths a pixel of each of two references,
//! how many seeds, and files of scenes. `benches/denoise.sh` runs it. OIDN names a Python that has
//! pyoidn, by which `benches/denoise_oidn.py` filters the same plain pictures.

#![expect(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a measurement stops at the first surprise, prints, and asks another program"
)]

#[path = "honest/limits.rs"]
#[expect(
    dead_code,
    reason = "the tests of many scenes at once are not asked here"
)]
mod limits;

use rtc::internals::image::{BackgroundFill, FileFormat, Image};
use rtc::internals::passes::{IntegratorChoice, ViewAndLight};
use rtc::internals::pipeline::{Input, Options, OutputTransform, PictureSetup, RenderObserver};
use rtc::internals::plan::{Plan, RuleSet};
use rtc::internals::render::{AnyWorld, Aov, RenderSelection, SamplingSeeds};
use rtc::internals::study::{LEVELS, PictureErrors, RenderRequest, probe};
use std::ffi::OsString;
use std::io::Write as _;
use std::path::Path;
use std::process::{Command, Stdio};

/// The paths a pixel of a picture, and of the plain one it is to be as good as.
const SAMPLES: [u32; 2] = [16, 64];

/// A denoised picture may have this much of the error of the plain one.
const ALLOWED: f64 = 1.02;

/// A scene, ready to be rendered with so many paths a pixel.
struct Case {
    world: AnyWorld,
    order: RenderRequest,
    paths: u32,
}

impl Case {
    /// As `rtc render --integrator path` shows it.
    fn new(path: &Path, side: u32, paths: u32) -> Self {
        let kind = FileFormat::Png8;
        let look = OutputTransform::new(kind, None, None, BackgroundFill::Film, &[]).unwrap();
        let mut setup = PictureSetup::new(look);
        setup.overrides.size = Some([side; 2]);
        setup.overrides.spp = Some(paths);
        let mut input = Input::file(path, Options::default());
        input.stage(ViewAndLight {
            integrator: Some(IntegratorChoice::Path),
            ..ViewAndLight::default()
        });
        let loaded = input.load().unwrap();
        let mut subject = setup.validate(loaded, &mut input).unwrap().unwrap();
        let observer = RenderObserver {
            on_step: &|_| (),
            is_stopped: &|| false,
        };
        setup.light(&mut subject, &mut input, &observer).unwrap();
        let window = setup.window(&subject.validated.lowered.scene).unwrap();
        let order = setup.order(&subject, window, None);
        let proof = &subject.validated.scene;
        let world = AnyWorld::prepare(proof, &Plan::new(proof, RuleSet::ALL));
        Self {
            world,
            order,
            paths,
        }
    }

    fn job(&self, seed: u64) -> RenderSelection<'_> {
        RenderSelection {
            crop: Some(self.order.crop),
            values: self.order.values,
            background: self.order.background,
            seeds: SamplingSeeds {
                pixel: seed,
                lens: seed,
                path: seed,
            },
            ..RenderSelection::default()
        }
    }

    /// A plain picture, linear.
    fn plain(&self, seed: u64) -> Image {
        let film = self.world.render(&self.job(seed), &|_| true);
        film.unwrap().image
    }

    /// A plain picture as OIDN filters it, by `python`, with the albedo and the normals of the
    /// first hits.
    fn by_oidn(&self, plain: &Image, seed: u64, python: &OsString) -> Image {
        let layers = [Aov::Albedo, Aov::Normal];
        let guides = self.world.layers(&layers, &self.job(seed), &|_| true);
        let colors = plain.pixels.iter().flatten().map(|value| *value as f32);
        let [width, height] = [plain.width, plain.height].map(|side| side.to_string());
        let mut oidn = Command::new(python)
            .args(["benches/denoise_oidn.py", &width, &height])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let numbers: Vec<u8> = colors
            .chain(guides.unwrap().values)
            .flat_map(f32::to_le_bytes)
            .collect();
        oidn.stdin.take().unwrap().write_all(&numbers).unwrap();
        let out = oidn.wait_with_output().unwrap();
        assert!(out.status.success(), "OIDN filtered nothing");
        let (values, _) = out.stdout.as_chunks::<4>();
        let values: Vec<f64> = values
            .iter()
            .map(|bytes| f32::from_le_bytes(*bytes).into())
            .collect();
        Image {
            pixels: values.as_chunks::<3>().0.to_vec(),
            ..*plain
        }
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
    /// Of those that OIDN filters.
    oidn: f64,
    flip: [f64; 3],
    /// The mean square errors in squares of grey levels: those of a plain and of a denoised
    /// picture, the estimate of that, and the bound.
    squares: [f64; 4],
    /// So many are worse than the plain picture.
    worse: u64,
    /// The most of the error of the plain picture.
    most: f64,
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
        self.worse += other.worse;
        self.oidn += other.oidn;
        self.most = self.most.max(other.most);
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

    /// One picture of a seed, of few paths, beside one of many.
    fn of([few, many]: &[Case; 2], seed: u64, [a, b]: &[Image; 2]) -> Self {
        let middle = Image {
            pixels: zip(a, b, |a, b| 0.5 * (a + b)),
            ..*a
        };
        let errors = |image: &Image| {
            PictureErrors::of(
                std::slice::from_ref(image),
                std::slice::from_ref(&middle),
                1.0,
            )
        };
        let picture = few
            .world
            .denoised(few.paths, &few.job(seed), &|_| true, &|| ())
            .unwrap();
        let order = RenderRequest { seed, ..few.order };
        let rays = picture.film.counts.rays();
        let (film, probed) = probe(&few.world, &order, picture, few.paths, &|_| true).unwrap();
        let noisy = few.plain(seed);
        let oidn = std::env::var_os("OIDN").map_or(0.0, |python| {
            relative(&few.shown(&few.by_oidn(&noisy, seed, &python)), a, b)
        });
        let [plain, more] = [few.shown(&noisy), many.shown(&many.plain(seed))];
        let shown = few.shown(&film.image);
        let [before, truth] = [&plain, &shown].map(|image| mean(image, a, b) * LEVELS * LEVELS);
        let pictures = [&plain, &more, &shown];
        let all = pictures.map(errors);
        let most = (truth / before).max(0.0).sqrt();
        Self {
            pictures: 1,
            relative: pictures.map(|image| relative(image, a, b)),
            oidn,
            flip: all.map(|errors| errors.flip),
            squares: [
                before,
                truth,
                probed.estimate * probed.estimate,
                probed.error * probed.error,
            ],
            worse: u64::from(most > ALLOWED),
            most,
            held: u64::from(probed.undersampled.is_none() && truth <= probed.error * probed.error),
            unbounded: u64::from(probed.undersampled.is_some()),
            rays: [rays as f64, (film.counts.rays() - rays) as f64],
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
        let [before, truth, probed, bound] = self.squares.map(|sum| (sum / n).max(0.0).sqrt());
        println!(
            "| {name} | {plain:.5} | {more:.5} | {denoised:.5} | {} | {:.3} | {:.3} | {:.3} \
             | {before:.2} | {truth:.2} | {:.2} | {} | {probed:.2} | {bound:.2} | {} of {} | {} \
             | {:.0} % |",
            match self.oidn / n {
                0.0 => String::new(),
                oidn => format!("{oidn:.5}"),
            },
            flip[0],
            flip[1],
            flip[2],
            self.most,
            self.worse,
            self.held,
            self.bounded(),
            self.unbounded,
            100.0 * self.rays[1] / self.rays[0]
        );
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

/// The mean of (x − r)²/(r² + 0.01), in which the noise of the two references cancels.
fn relative(test: &Image, a: &Image, b: &Image) -> f64 {
    let pixels = test.pixels.iter().zip(&a.pixels).zip(&b.pixels);
    let terms = pixels.flat_map(|((x, a), b)| {
        [0, 1, 2].map(|c: usize| {
            let middle = 0.5 * (a[c] + b[c]);
            (x[c] - a[c]) * (x[c] - b[c]) / (middle * middle + 0.01)
        })
    });
    terms.sum::<f64>() / (3 * test.pixels.len()) as f64
}

fn main() {
    let words: Vec<_> = std::env::args()
        .skip(1)
        .filter(|word| word != "--bench")
        .collect();
    let [side, paths, seeds, files @ ..] = &words[..] else {
        panic!("usage: denoise SIDE PATHS SEEDS FILES...");
    };
    let [side, paths, seeds] = [side, paths, seeds].map(|word| word.parse::<u32>().unwrap());
    println!(
        "| scene | relMSE 16 | relMSE 64 | denoised | OIDN | FLIP 16 | FLIP 64 | denoised | error 16 \
         | denoised | most | worse | estimate | bound | held | no bound | rays of probes |"
    );
    println!("| --- |{}", " --: |".repeat(16));
    let mut sum = Tally::default();
    for file in files {
        let path = Path::new(file);
        let case = |paths| Case::new(path, side, paths);
        let (reference, cases) = (case(paths), SAMPLES.map(case));
        let references = [90_001, 90_002].map(|seed| reference.shown(&reference.plain(seed)));
        let mut tally = Tally::default();
        for seed in 0..u64::from(seeds) {
            tally.add(&Tally::of(&cases, 10_000 + seed, &references));
        }
        tally.print(&path.file_stem().unwrap().to_string_lossy());
        sum.add(&tally);
    }
    println!(
        "\nWorse than {ALLOWED} × plain: {} of {}; the most is {:.2} ×.",
        sum.worse, sum.pictures, sum.most
    );
    let limit = limits::lower(sum.held, sum.bounded());
    println!(
        "Held: {} of {}; with 95 % confidence at least {limit:.3} of all.",
        sum.held,
        sum.bounded()
    );
}
