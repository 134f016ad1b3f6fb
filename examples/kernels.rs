//! `kernels planned|everything|unpruned SCENE` renders 160 × 160 pixels, 16 paths each where paths
//! are traced, and says nothing, for a profiler to count the instructions of `picture`: as planned, as planned but by the integrator
//! that can do everything for all shapes, or with no rule of the plan.

#![expect(clippy::unwrap_used, reason = "a bench stops at the first surprise")]

use rtc::diag::Sink;
use rtc::passes::Overrides;
use rtc::pipeline::{self, Options};
use rtc::plan::{Features, PathFeatures, Plan, Rules, Shapes};
use rtc::render::{self, Film, Job};
use rtc::source::{Loader, SourceMap};
use rtc::valid::Proof;
use std::path::Path;

fn main() {
    // One thread, this one, so that its instructions are all there are.
    let _pool = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .use_current_thread()
        .build_global();
    let mut args = std::env::args().skip(1);
    let (which, file) = (args.next().unwrap(), args.next().unwrap());
    let scene = scene(&file);
    let mut plan = Plan::new(
        &scene,
        if which == "unpruned" {
            Rules::NONE
        } else {
            Rules::ALL
        },
    );
    if which == "everything" {
        (plan.features, plan.shapes) = (Features::EVERYTHING, Shapes::All);
        if let Some(paths) = &mut plan.paths {
            paths.features = PathFeatures::EVERYTHING;
        }
    }
    assert!(picture(&scene, &plan).counts.rays() > 0);
}

#[inline(never)]
fn picture(scene: &Proof, plan: &Plan) -> Film {
    render::render(scene, plan, &Job::default(), &|_| true).unwrap()
}

fn scene(file: &str) -> Proof {
    let (mut map, mut sink, options) = (SourceMap::default(), Sink::default(), Options::default());
    let read = Loader.file(Path::new(file), &mut map).unwrap();
    let mut lowered = pipeline::load(read, &mut map, &options, &mut sink).unwrap();
    Overrides {
        size: Some([160; 2]),
        spp: Some(16),
        ..Overrides::default()
    }
    .apply(&mut lowered.scene);
    pipeline::prove(&lowered, &options, &mut sink).unwrap()
}
