//! Scenes of `../shared`: a trial for each file of a folder, and each read, proven, rendered.

use crate::suite::{absent, files, shared, trial};
use libtest_mimic::Trial;
use rtc::internals::diag::DiagnosticSink;
use rtc::internals::ir::{LoweredScene, Scene, SourceSpans};
use rtc::internals::passes::Overrides;
use rtc::internals::pipeline::{self, Options};
use rtc::internals::plan::{Plan, RuleSet};
use rtc::internals::render::{Film, RenderSelection};
use rtc::internals::source::{Loader, SourceMap};
use rtc::internals::valid::ValidScene;
use std::path::Path;

/// The scenes of the course, of which each shows something.
pub(crate) const COURSE: &str = "course/scenes";

/// A trial for each file of a folder, or one that is ignored if there is none.
pub(crate) fn each(suite: &str, folder: &str, extensions: &[&str], check: fn(&Path)) -> Vec<Trial> {
    let Some(path) = shared(folder) else {
        return vec![absent(format!("{suite}/{folder}"), folder)];
    };
    let found = files(&path, extensions).into_iter();
    let trials = found.map(|file| {
        // Files may differ in their extension alone.
        let own = file.strip_prefix(&path).unwrap().to_string_lossy();
        let name = format!("{suite}/{folder}/{}", own.replace('\\', "/"));
        trial(name, move || check(&file))
    });
    trials.collect()
}

/// A trial of one scene of the course.
pub(crate) fn course(
    suite: &str,
    file: &'static str,
    check: impl FnOnce(Scene) + Send + 'static,
) -> Trial {
    let path = format!("{COURSE}/{file}");
    crate::suite::needs(format!("{suite}/{path}"), &path, |path| check(read(path)))
}

/// A scene as it is; none if it is refused.
pub(crate) fn accepted(path: &Path) -> Option<Scene> {
    let (mut map, mut sink, options) = (
        SourceMap::default(),
        DiagnosticSink::default(),
        Options::default(),
    );
    let file = Loader.file(path, &mut map).unwrap();
    let lowered = pipeline::load(file, &mut map, &options, &mut sink)?;
    (!sink.has_errors()).then_some(lowered.scene)
}

pub(crate) fn read(path: &Path) -> Scene {
    accepted(path).unwrap_or_else(|| panic!("{} is refused", path.display()))
}

/// The scene at another size, with so many samples along each side of a pixel.
pub(crate) fn at(mut scene: Scene, size: [u32; 2], supersampling: u32) -> Scene {
    Overrides {
        size: Some(size),
        supersampling: Some(supersampling),
        ..Overrides::default()
    }
    .apply(&mut scene);
    scene
}

pub(crate) fn validated(scene: Scene) -> ValidScene {
    let (mut sink, options) = (DiagnosticSink::default(), Options::default());
    let lowered = LoweredScene {
        scene,
        source_spans: SourceSpans::default(),
    };
    pipeline::validate(&lowered, &options, &mut sink).unwrap_or_else(|| panic!("{:?}", sink.kept()))
}

pub(crate) fn film(scene: &ValidScene, plan: &Plan, job: &RenderSelection) -> Film {
    pipeline::render(scene, plan, job, 0, &|_| true)
        .unwrap()
        .unwrap()
}

/// A film with all rules.
pub(crate) fn whole(scene: &ValidScene) -> Film {
    film(
        scene,
        &Plan::new(scene, RuleSet::ALL),
        &RenderSelection::default(),
    )
}
