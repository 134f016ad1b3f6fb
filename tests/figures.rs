//! The course's printed figures, pixel by pixel.
//!
//! The scenes and figures are those of `../shared/course`; without them the test skips with a note.
//! Where a figure was printed with other sampling than its scene says, the sampling of the figure
//! is set here.

#![expect(clippy::unwrap_used, reason = "a test stops at the first surprise")]

use rtc::color::quantize8;
use rtc::diag::Sink;
use rtc::passes::Overrides;
use rtc::pipeline::{self, Options};
use rtc::plan::{Plan, Rules};
use rtc::render::Job;
use rtc::source::{Loader, SourceMap};
use std::path::{Path, PathBuf};

struct Figure {
    name: &'static str,
    supersampling: Option<u32>,
    aperture_samples: Option<u32>,
    /// The least share of pixels equal in all three bytes, or another measure.
    bar: Bar,
}

enum Bar {
    Equal(f64),
    Psnr(f64),
    /// The largest mean absolute difference, in bytes.
    Mean(f64),
}

const FIGURES: &[Figure] = &[
    figure("scene02", None, Bar::Equal(0.999)),
    figure("scene01-zbuffer", None, Bar::Equal(0.999)),
    figure("scene01-shadows", None, Bar::Equal(0.999)),
    figure("scene01-lights-shadows", None, Bar::Equal(0.999)),
    figure("scene01-ss", Some(2), Bar::Equal(0.999)),
    figure(
        "scene01-camera-ss-reflect-lights-shadows",
        Some(2),
        Bar::Equal(0.996),
    ),
    Figure {
        name: "scene01-dof-ss-reflect-lights-shadows",
        supersampling: Some(2),
        aperture_samples: Some(128),
        bar: Bar::Psnr(46.0),
    },
    figure(
        "scene01-texture-ss-reflect-lights-shadows",
        None,
        Bar::Mean(4.0),
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

#[test]
fn the_course_figures_are_met() {
    let course = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/course");
    if !course.exists() {
        println!("skipped: {} is not here", course.display());
        return;
    }
    let mut failed = Vec::new();
    for figure in FIGURES {
        let ours = render(
            &course
                .join("scenes")
                .join(figure.name)
                .with_extension("yaml"),
            figure,
        );
        let theirs = read(
            &course
                .join("figures")
                .join(figure.name)
                .with_extension("png"),
        );
        let (equal, psnr, mean) = compare(&ours, &theirs);
        println!(
            "{:45} {:7.3} % equal, {psnr:.1} dB, {mean:.2} bytes off",
            figure.name,
            equal * 100.0
        );
        let met = match figure.bar {
            Bar::Equal(bar) => equal >= bar,
            Bar::Psnr(bar) => psnr >= bar,
            Bar::Mean(bar) => mean <= bar,
        };
        if !met {
            failed.push(figure.name);
        }
    }
    assert!(failed.is_empty(), "not met: {failed:?}");
}

type Pixels = Vec<[u8; 3]>;

fn render(path: &Path, figure: &Figure) -> Pixels {
    let (mut map, mut sink, options) = (SourceMap::default(), Sink::default(), Options::default());
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
    let scene = pipeline::prove(&lowered, &options, &mut sink)
        .unwrap_or_else(|| panic!("{:?}", sink.kept()));
    let film = pipeline::render(
        &scene,
        &Plan::new(&scene, Rules::ALL),
        &Job::default(),
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
