//! Laws that a suite states of the scenes it has: a scene times a power of two makes the same
//! picture, and so does one whose surfaces stand in another order.

use crate::scale::scaled;
use crate::small::{WHOLE, bits, film, small};
use rtc::internals::codec::{self, Encoding};
use rtc::internals::diag::DiagnosticSink;
use rtc::internals::ir::{self, LoweredScene, Scene, SourceSpans};
use rtc::internals::math::ldexp;
use rtc::internals::pipeline::{self, FormatTextError, Input, Options};
use rtc::internals::plan::{Plan, RuleSet};
use rtc::internals::render::{Intersect, WatertightRay, World, camera_ray, image_point};
use std::path::Path;

/// Scenes, each with the powers of two it is scaled by: all from −40 to 40 occur, `RTC_ALL_POWERS`
/// tries all on each; and −180 and 140, at which powers of a length leave the range of f64.
pub(crate) fn powers(scenes: usize, index: usize) -> impl Iterator<Item = i32> {
    let all = std::env::var_os("RTC_ALL_POWERS").is_some();
    let (scenes, index) = (
        i32::try_from(scenes).unwrap(),
        i32::try_from(index).unwrap(),
    );
    (-40..=40)
        .filter(move |k| all || (k + 40) % scenes == index)
        .chain([-180, 140])
}

/// Kills every fixed epsilon in the program.
pub(crate) fn makes_the_same_picture_times(path: &Path, powers: impl Iterator<Item = i32>) {
    let scene = small(path);
    let picture = bits(&film(&scene, &WHOLE, 0));
    for k in powers {
        let other = film(&scaled(&scene, ldexp(1.0, k)), &WHOLE, 0);
        assert!(bits(&other) == picture, "2^{k}: {}", path.display());
    }
}

/// Of a file: laid out, it says the same, to the last bit of the IR; and it is laid out once for
/// all.
pub(crate) fn is_the_same_laid_out(path: &Path) {
    let options = Options::default;
    let edited = |text: &str| Input::edited(path, text.as_bytes().to_vec(), options());
    let text = match Input::file(path, options()).format_text() {
        Ok(text) => text,
        // It is no YAML, or no scene.
        Err(FormatTextError::Reported | FormatTextError::NoScene) => return,
        Err(fault) => panic!("{}: {fault:?}", path.display()),
    };
    let again = edited(&text).format_text();
    assert_eq!(again.as_ref(), Ok(&text), "{}", path.display());
    let encoded = |mut input: Input| {
        let loaded = input.load()?;
        Some(codec::encode(Encoding::Binary, &loaded.lowered.scene).unwrap())
    };
    let is_same = encoded(Input::file(path, options())) == encoded(edited(&text));
    assert!(is_same, "{}", path.display());
}

/// Whether a camera ray of a pixel, of those in a grid, meets two surfaces at the very same t.
fn has_tie(world: &World, factor: u32, index: usize) -> bool {
    let camera = &world.camera;
    let width = camera.size[0] as usize;
    let pixel = [index % width, index / width].map(|k| u32::try_from(k).unwrap());
    let middle = |k: u32| (f64::from(k) + 0.5) / f64::from(factor);
    let places = (0..factor).flat_map(|i| (0..factor).map(move |j| [i, j].map(middle)));
    places
        .map(|place| camera_ray(camera.eye, image_point(camera, pixel, place)))
        .any(|ray| {
            let watertight = WatertightRay::new(&ray);
            let roots = world
                .surfaces
                .iter()
                .filter_map(|surface| surface.shape.intersect(&ray, &watertight, f64::INFINITY));
            let nearest = world.closest_hit(&ray).map(|hit| hit.t);
            roots.filter(|(t, _)| Some(*t) == nearest).count() > 1
        })
}

fn world(scene: &Scene) -> World {
    let lowered = LoweredScene {
        scene: scene.clone(),
        source_spans: SourceSpans::default(),
    };
    let valid = pipeline::validate(
        &lowered,
        &Options::default(),
        &mut DiagnosticSink::default(),
    )
    .unwrap();
    World::prepare(&valid, &Plan::new(&valid, RuleSet::NONE))
}

/// The order of surfaces is no part of a scene's meaning, but where several are met at the very
/// same t.
pub(crate) fn is_the_same_in_any_order(path: &Path) {
    let mut scene = small(path);
    let picture = film(&scene, &WHOLE, 0).image.pixels;
    let (ties, factor) = (world(&scene), scene.settings.supersampling);
    let count = scene.surfaces.len();
    let orders: [fn(&mut [ir::Surface]); 2] =
        [|all| all.reverse(), |all| all.rotate_left(all.len() / 2)];
    for order in orders {
        order(&mut scene.surfaces);
        let other = film(&scene, &WHOLE, 0).image.pixels;
        let differs =
            |index: &usize| picture[*index].map(f64::to_bits) != other[*index].map(f64::to_bits);
        let unexplained = (0..picture.len())
            .filter(differs)
            .find(|index| !has_tie(&ties, factor, *index));
        assert_eq!(
            unexplained,
            None,
            "a pixel of {}, {count} surfaces",
            path.display()
        );
    }
}
