//! `kernels planned|everything|unpruned|NUMBER SCENE` renders 160 × 160 pixels of a scene, or of the
//! set-up of a reference, 16 paths each where paths are traced, and says nothing, for a profiler to
//! count the instructions of `picture`: as planned; by the kernel that can do everything; with no
//! rule of the plan; by the kernel of a number.
//! `kernels time SCENE` says how long the first two take: the median of pictures made in turns.

#![expect(clippy::unwrap_used, reason = "a bench stops at the first surprise")]

mod setup;

use rtc::passes::Overrides;
use rtc::plan::{Features, PathFeatures, Plan, Rules, Shapes};
use rtc::render::{AnyWorld, Film, Job, KERNELS, PATH_KERNELS};
use rtc::valid::Proof;
use std::path::Path;
use std::time::Instant;

/// Paths a pixel.
const SAMPLES: u32 = 16;

/// Pictures of each kind that are timed.
const ROUNDS: usize = 9;

fn main() {
    // One thread, this one, so that its instructions are all there are.
    let _pool = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .use_current_thread()
        .build_global();
    let mut args = std::env::args().skip(1);
    let (which, file) = (args.next().unwrap(), args.next().unwrap());
    let scene = scene(&file);
    let planned = Plan::new(&scene, Rules::ALL);
    match which.as_str() {
        "planned" => count(&scene, &planned),
        "everything" => count(
            &scene,
            &by(&planned, KERNELS.len() - 2, PATH_KERNELS.len() - 1),
        ),
        "unpruned" => count(&scene, &Plan::new(&scene, Rules::NONE)),
        "time" => time(&scene, &planned),
        number => {
            let number = number.parse().unwrap();
            count(
                &scene,
                &by(&planned, number, number.min(PATH_KERNELS.len() - 1)),
            );
        }
    }
}

/// The plan, done by other kernels; for all shapes, where it is the one that can do everything.
fn by(planned: &Plan, kernel: usize, of_paths: usize) -> Plan {
    let mut plan = planned.clone();
    plan.features = KERNELS[kernel].features;
    let is_everything = match &mut plan.paths {
        Some(paths) => {
            paths.features = PATH_KERNELS[of_paths].features;
            paths.features == PathFeatures::EVERYTHING
        }
        None => plan.features == Features::EVERYTHING,
    };
    if is_everything {
        plan.shapes = Shapes::All;
    }
    plan
}

fn count(scene: &Proof, plan: &Plan) {
    assert!(picture(&AnyWorld::prepare(scene, plan)).counts.rays() > 0);
}

/// Prints the medians of both kernels, in seconds.
#[expect(clippy::disallowed_methods, reason = "a bench tells time")]
fn time(scene: &Proof, planned: &Plan) {
    let everything = by(planned, KERNELS.len() - 2, PATH_KERNELS.len() - 1);
    let worlds = [planned, &everything].map(|plan| AnyWorld::prepare(scene, plan));
    let mut taken = [const { Vec::new() }; 2];
    for _ in 0..ROUNDS {
        for (taken, world) in taken.iter_mut().zip(&worlds) {
            let start = Instant::now();
            picture(world);
            taken.push(start.elapsed().as_secs_f64());
        }
    }
    let [planned, everything] = taken.map(|mut taken| {
        taken.sort_by(f64::total_cmp);
        taken[ROUNDS / 2]
    });
    #[expect(clippy::print_stdout, reason = "this is what it is for")]
    {
        println!("{planned:.3} {everything:.3}");
    }
}

#[inline(never)]
fn picture(world: &AnyWorld) -> Film {
    world.render(&Job::default(), &|_| true).unwrap()
}

fn scene(file: &str) -> Proof {
    let path = Path::new(file);
    let mut lowered = if path.extension().is_some_and(|it| it == "json") {
        setup::load_set_up(path, SAMPLES)
    } else {
        setup::load(path)
    };
    Overrides {
        size: Some([160; 2]),
        spp: Some(SAMPLES),
        ..Overrides::default()
    }
    .apply(&mut lowered.scene);
    setup::prove(&lowered)
}
