//! What robust arithmetic costs beside plain f64 and f32, and where the pictures differ.
//!
//! `arithmetic FILE…` prints a line for each scene and arithmetic; with `--cost N` it measures CPU
//! time as well, N times by turns on one thread. `arithmetic --once NAME FILE` renders once and
//! prints nothing, for a profiler.

#![expect(
    clippy::unwrap_used,
    clippy::print_stdout,
    clippy::disallowed_methods,
    reason = "a bench stops at the first surprise, prints, and reads what time it took"
)]

use rtc::internals::color::quantize8;
use rtc::internals::diag::DiagnosticSink;
use rtc::internals::passes::Overrides;
use rtc::internals::pipeline::{self, Options};
use rtc::internals::plan::{Arithmetic, Plan, RuleSet};
use rtc::internals::render::{self, Film, RenderSelection};
use rtc::internals::source::{Loader, SourceMap};
use rtc::internals::valid::ValidScene;
use std::path::Path;

const ALL: [(&str, Arithmetic); 3] = [
    ("robust", Arithmetic::Robust),
    ("plain", Arithmetic::Plain),
    ("f32", Arithmetic::F32),
];

fn main() {
    // One thread, this one, so that its time is all there is.
    let _pool = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .use_current_thread()
        .build_global();
    let mut args = std::env::args().skip(1).peekable();
    let mut repeats = 0;
    match args.peek().map(String::as_str) {
        Some("--once") => {
            let (name, file) = (args.nth(1).unwrap(), args.next().unwrap());
            let (_, arithmetic) = ALL.into_iter().find(|(known, _)| *known == name).unwrap();
            render(&scene(&file), arithmetic);
            return;
        }
        Some("--cost") => repeats = args.nth(1).unwrap().parse().unwrap(),
        _ => {}
    }
    for file in args {
        let scene = scene(&file);
        let name = Path::new(&file)
            .file_stem()
            .unwrap()
            .to_string_lossy()
            .into_owned();
        differences(&name, &scene);
        if repeats > 0 {
            costs(&name, &scene, repeats);
        }
    }
}

/// The scene, no more than 160 pixels wide and high and with few samples.
fn scene(file: &str) -> ValidScene {
    let (mut map, mut sink, options) = (
        SourceMap::default(),
        DiagnosticSink::default(),
        Options::default(),
    );
    let read = Loader.file(Path::new(file), &mut map).unwrap();
    let mut lowered = pipeline::load(read, &mut map, &options, &mut sink).unwrap();
    let [width, height] = lowered.scene.camera.size;
    let shrink = f64::from(width.max(height)) / 160.0;
    let size =
        [width, height].map(|side| (f64::from(side) / shrink.max(1.0)).round().max(1.0) as u32);
    let overrides = Overrides {
        size: Some(size),
        ..Overrides::default()
    };
    overrides.apply(&mut lowered.scene);
    pipeline::validate(&lowered, &options, &mut sink).unwrap()
}

fn render(scene: &ValidScene, arithmetic: Arithmetic) -> Film {
    render::render(
        scene,
        &Plan::with_arithmetic(arithmetic, scene, RuleSet::ALL),
        &RenderSelection::default(),
        &|_| true,
    )
    .unwrap()
}

/// The share of pixels whose bytes differ from the robust ones, and of those that differ by more
/// than 8.
fn differences(name: &str, scene: &ValidScene) {
    let robust = render(scene, Arithmetic::Robust);
    for (arithmetic, choice) in &ALL[1..] {
        let film = render(scene, *choice);
        let pairs = || film.image.pixels.iter().zip(&robust.image.pixels);
        let share = |least: u8| {
            let differ = |(a, b): &(&[f64; 3], &[f64; 3])| {
                (0..3).any(|k| quantize8(a[k]).abs_diff(quantize8(b[k])) >= least)
            };
            100.0 * pairs().filter(differ).count() as f64 / pairs().count() as f64
        };
        println!(
            "{name:<45} {arithmetic:<6} differ {:8.4} %, by more than 8 {:8.4} %",
            share(1),
            share(9)
        );
    }
}

/// The median of the time by each arithmetic over that by plain f64, by turns.
fn costs(name: &str, scene: &ValidScene, repeats: usize) {
    // Short renders are repeated: the clock may tick only every 4 ms.
    let mut rounds = 0;
    let start = cpu_seconds();
    while cpu_seconds() - start < 0.2 {
        render(scene, Arithmetic::Plain);
        rounds += 1;
    }
    let mut times = [const { Vec::new() }; 3];
    for _ in 0..repeats {
        for (times, (_, arithmetic)) in times.iter_mut().zip(ALL) {
            let start = cpu_seconds();
            (0..rounds).for_each(|_| drop(render(scene, arithmetic)));
            times.push((cpu_seconds() - start) / f64::from(rounds));
        }
    }
    let [robust, plain, f32] = times.map(|mut times| {
        times.sort_by(f64::total_cmp);
        times[times.len() / 2]
    });
    let (a, b) = (robust / plain, f32 / plain);
    println!(
        "{name:<45} plain {:7.1} ms, robust / plain {a:5.2}, f32 / plain {b:5.2}",
        plain * 1e3
    );
}

/// The time this thread has run, on Linux.
fn cpu_seconds() -> f64 {
    let schedule = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap();
    schedule.split(' ').next().unwrap().parse::<f64>().unwrap() / 1e9
}
