//! `kernels WHICH SCENE [SIZE]` renders a scene, or the set-up of a reference, with 16 paths a pixel
//! where paths are traced, and says nothing, for a profiler to count the instructions of `picture`.
//! WHICH is `planned`; `next`, by the next larger kernel; `all`, by the same kernel for all shapes;
//! `everything`, by the kernel that can do everything for all shapes; or `unpruned`, with no rule of
//! the plan.
//! `kernels names SCENE` prints the kernel planned, its shapes, and the next larger kernel.
//! `kernels time SCENE` prints the CPU time of `planned` and `everything`: the median of pictures made
//! in turns.

#![expect(clippy::unwrap_used, reason = "a bench stops at the first surprise")]

mod setup;

use cpu_time::ThreadTime;
use rtc::internals::passes::Overrides;
use rtc::internals::plan::{PathFeatures, Plan, RuleSet, ShapeSet, WhittedFeatures};
use rtc::internals::render::{
    AnyWorld, Film, KERNELS, PATH_KERNELS, RenderSelection, choose, choose_for_paths,
};
use rtc::internals::valid::ValidScene;
use std::path::Path;

/// Paths a pixel.
const SAMPLES: u32 = 16;

/// Pixels across, and down, where nothing else is asked for.
const SIZE: u32 = 160;

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
    let size = args.next().map_or(SIZE, |size| size.parse().unwrap());
    let scene = scene(&file, size);
    let planned = Plan::new(&scene, RuleSet::ALL);
    match which.as_str() {
        "planned" => count(&scene, &planned),
        "next" => count(&scene, &by_next(&planned)),
        "all" => count(&scene, &for_all_shapes(&planned)),
        "everything" => count(&scene, &everything(&planned)),
        "unpruned" => count(&scene, &Plan::new(&scene, RuleSet::NONE)),
        "names" => print_names(&planned),
        "time" => time(&scene, &planned),
        other => panic!("`{other}` is none of them"),
    }
}

/// The plan, done by the smallest kernel that can do more than the one planned; as planned, if
/// there is none.
fn by_next(planned: &Plan) -> Plan {
    let mut plan = planned.clone();
    match &mut plan.paths {
        Some(paths) => {
            let next = (choose_for_paths(paths.features) + 1).min(PATH_KERNELS.len() - 1);
            paths.features = PATH_KERNELS[next].features;
        }
        None => {
            let own = KERNELS[choose(plan.features)].features;
            let larger = KERNELS.iter().map(|kernel| kernel.features);
            let mut larger = larger.filter(|it| it.contains(own) && *it != own);
            plan.features = larger.next().unwrap_or(own);
        }
    }
    plan
}

fn for_all_shapes(planned: &Plan) -> Plan {
    Plan {
        shapes: ShapeSet::All,
        ..planned.clone()
    }
}

fn everything(planned: &Plan) -> Plan {
    let mut plan = for_all_shapes(planned);
    plan.features = WhittedFeatures::EVERYTHING;
    if let Some(paths) = &mut plan.paths {
        paths.features = PathFeatures::EVERYTHING;
    }
    plan
}

#[expect(clippy::print_stdout, reason = "this is what it is for")]
fn print_names(planned: &Plan) {
    let name = |plan: &Plan| match &plan.paths {
        Some(paths) => PATH_KERNELS[choose_for_paths(paths.features)].name,
        None => KERNELS[choose(plan.features)].name,
    };
    let (own, next) = (name(planned), name(&by_next(planned)));
    let next = if next == own { "" } else { next };
    println!("{own} | {:?} | {next}", planned.shapes);
}

fn count(scene: &ValidScene, plan: &Plan) {
    assert!(picture(&AnyWorld::prepare(scene, plan)).counts.rays() > 0);
}

/// Prints the medians of both kernels, in seconds.
fn time(scene: &ValidScene, planned: &Plan) {
    let worlds = [planned, &everything(planned)].map(|plan| AnyWorld::prepare(scene, plan));
    let mut taken = [const { Vec::new() }; 2];
    for _ in 0..ROUNDS {
        for (taken, world) in taken.iter_mut().zip(&worlds) {
            let start = ThreadTime::now();
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
    world
        .render(&RenderSelection::default(), &|_| true)
        .unwrap()
}

fn scene(file: &str, size: u32) -> ValidScene {
    let path = Path::new(file);
    let mut lowered = if path.extension().is_some_and(|it| it == "json") {
        setup::load_set_up(path, SAMPLES)
    } else {
        setup::load(path)
    };
    Overrides {
        size: Some([size; 2]),
        spp: Some(SAMPLES),
        ..Overrides::default()
    }
    .apply(&mut lowered.scene);
    setup::validate(&lowered)
}
