//! The course's printed figures, pixel by pixel.
//!
//! Where a figure was printed with other sampling than its scene says, the sampling of the figure
//! is set here.

use crate::suite::needs;
use libtest_mimic::Trial;
use rtc::internals::color::quantize8;
use rtc::internals::diag::DiagnosticSink;
use rtc::internals::passes::Overrides;
use rtc::internals::pipeline::{self, Options};
use rtc::internals::plan::{Plan, RuleSet};
use rtc::internals::render::RenderSelection;
use rtc::internals::source::{Loader, SourceMap};
use std::path::{Path, PathBuf};

struct Figure {
    name: &'static str,
    supersampling: Option<u32>,
    aperture_samples: Option<u32>,
    /// What is reached: the least share of pixels equal in all three bytes, or another measure.
    bar: Bar,
}

enum Bar {
    Equal(f64),
    Psnr(f64),
    /// The largest mean absolute difference, in bytes.
    Mean(f64),
}

const FIGURES: &[Figure] = &[
    figure("scene02", None, Bar::Equal(1.0)),
    figure("scene01-zbuffer", None, Bar::Equal(1.0)),
    figure("scene01-shadows", None, Bar::Equal(0.99936)),
    figure("scene01-lights-shadows", None, Bar::Equal(0.9993)),
    figure("scene01-ss", Some(2), Bar::Equal(0.99978)),
    figure(
        "scene01-camera-ss-reflect-lights-shadows",
        Some(2),
        Bar::Equal(0.99758),
    ),
    Figure {
        name: "scene01-dof-ss-reflect-lights-shadows",
        supersampling: Some(2),
        aperture_samples: Some(128),
        bar: Bar::Psnr(47.8),
    },
    figure(
        "scene01-texture-ss-reflect-lights-shadows",
        None,
        Bar::Mean(0.848),
    ),
];

const fn figure(name: &'static str, supersampling: Option<u32>, bar: Bar) -> Figure {
    Figure {
        name,
        supersampling,
        aperture_samples: None,
        bar,
    }
}

pub(crate) fn trials() -> Vec<Trial> {
    let trials = FIGURES.iter().map(|figure| {
        let name = format!("figures/{}", figure.name);
        needs(name, "course", |course| is_met(figure, course))
    });
    trials.collect()
}

fn is_met(figure: &Figure, course: &Path) {
    let file = |folder: &str, extension: &str| {
        course
            .join(folder)
            .join(figure.name)
            .with_extension(extension)
    };
    let ours = render(&file("scenes", "yaml"), figure);
    let theirs = read(&file("figures", "png"));
    let (equal, psnr, mean) = compare(&ours, &theirs);
    println!(
        "{:45} {:7.4} % equal, {psnr:.2} dB, {mean:.4} bytes off",
        figure.name,
        equal * 100.0
    );
    let met = match figure.bar {
        Bar::Equal(bar) => equal >= bar,
        Bar::Psnr(bar) => psnr >= bar,
        Bar::Mean(bar) => mean <= bar,
    };
    assert!(met, "{equal} equal, {psnr} dB, {mean} bytes off");
}

type Pixels = Vec<[u8; 3]>;

fn render(path: &Path, figure: &Figure) -> Pixels {
    let (mut map, mut sink, options) = (
        SourceMap::default(),
        DiagnosticSink::default(),
        Options::default(),
    );
    let file = Loader.file(path, &mut map).unwrap();
    let mut lowered = pipeline::load(file, &mut map, &options, &mut sink).unwrap();
    let Figure {
        name: _,
        supersampling,
        aperture_samples,
        bar: _,
    } = *figure;
    Overrides {
        supersampling,
        aperture_samples,
        ..Overrides::default()
    }
    .apply(&mut lowered.scene);
    let scene = pipeline::validate(&lowered, &options, &mut sink)
        .unwrap_or_else(|| panic!("{:?}", sink.kept()));
    let film = pipeline::render(
        &scene,
        &Plan::new(&scene, RuleSet::ALL),
        &RenderSelection::default(),
        0,
        &|_| true,
    )
    .unwrap()
    .unwrap();
    film.image
        .pixels
        .iter()
        .map(|pixel| pixel.map(quantize8))
        .collect()
}

fn read(path: &PathBuf) -> Pixels {
    image::open(path)
        .unwrap()
        .to_rgb8()
        .pixels()
        .map(|pixel| pixel.0)
        .collect()
}

/// The share of equal pixels, the peak signal-to-noise ratio in dB, and the mean absolute
/// difference in bytes.
fn compare(ours: &Pixels, theirs: &Pixels) -> (f64, f64, f64) {
    assert_eq!(ours.len(), theirs.len());
    let equal = ours.iter().zip(theirs).filter(|(a, b)| a == b).count();
    let square = |a: u8, b: u8| (f64::from(a) - f64::from(b)) * (f64::from(a) - f64::from(b));
    let squares: f64 = ours
        .iter()
        .flatten()
        .zip(theirs.iter().flatten())
        .map(|(a, b)| square(*a, *b))
        .sum();
    let values = (3 * ours.len()) as f64;
    let off: f64 = ours
        .iter()
        .flatten()
        .zip(theirs.iter().flatten())
        .map(|(a, b)| f64::from(a.abs_diff(*b)))
        .sum();
    let psnr = 10.0 * (255.0 * 255.0 * values / squares).log10();
    (equal as f64 / ours.len() as f64, psnr, off / values)
}
