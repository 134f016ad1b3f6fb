//! The stages on bytes nobody vouches for: what the fuzz targets call, and the suite with what they found.
//!
//! None may panic, whatever the bytes are. What a stage promises beyond that is asserted here.

use super::{Options, load, prove, render};
use crate::codec::{self, Form};
use crate::diag::Sink;
use crate::front::course;
use crate::ir::{Lowered, Material, Mode, Origins, Scene};
use crate::plan::{Plan, Rules};
use crate::render::Job;
use crate::source::{FileId, SourceMap};
use crate::valid;
use arbitrary::{Arbitrary, Unstructured};

/// The most of anything a scene under trial is rendered with.
const TINY: u32 = 4;

/// Lowers a text of the course's format.
///
/// # Panics
/// If the text is refused without an error.
pub fn lower(bytes: &[u8]) {
    let (map, file) = source(bytes);
    let mut sink = Sink::default();
    let lowered = course::lower(file, &map, &Options::default().front, &mut sink);
    assert!(lowered.is_some() || sink.has_errors(), "a text is refused with an error");
}

/// Takes a scene in any form from bytes to its proof.
///
/// # Panics
/// If there is neither a proof nor an error, or both, or a proven scene is another one after encoding and decoding.
pub fn check(bytes: &[u8]) {
    let (mut map, file) = source(bytes);
    let (mut sink, options) = (Sink::default(), Options::default());
    let lowered = load(file, &mut map, &options, &mut sink);
    let proven = lowered.as_ref().and_then(|lowered| prove(lowered, &options, &mut sink));
    assert_eq!(proven.is_none(), sink.has_errors(), "a proof or an error, never both");
    if let (Some(Lowered { scene, origins: _ }), Some(_)) = (lowered, proven) {
        round_trips(&scene);
    }
}

/// Decodes bytes in both forms of the IR.
///
/// # Panics
/// If there is neither a scene nor an error, or a scene is another one after encoding and decoding.
pub fn decode(bytes: &[u8]) {
    let (map, file) = source(bytes);
    for form in [Form::Text, Form::Binary] {
        let mut sink = Sink::default();
        let scene = codec::decode(form, file, &map, &mut sink);
        assert_eq!(scene.is_none(), sink.has_errors(), "a scene or an error, never both");
        scene.iter().for_each(round_trips);
    }
}

/// Proves the scene that the bytes stand for.
///
/// # Panics
/// If there is neither a proof nor an error, or both.
pub fn validate(bytes: &[u8]) {
    let Ok(scene) = Scene::arbitrary(&mut Unstructured::new(bytes)) else { return };
    let mut sink = Sink::default();
    let proven = valid::validate(&scene, &Origins::default(), &Options::default().valid, &mut sink);
    assert_eq!(proven.is_none(), sink.has_errors(), "a proof or an error, never both");
}

/// Renders a scene in any form, a few pixels of it.
///
/// # Panics
/// If a pixel is not in [0, 1].
pub fn picture(bytes: &[u8]) {
    let (mut map, file) = source(bytes);
    let (mut sink, options) = (Sink::default(), Options::default());
    let Some(mut lowered) = load(file, &mut map, &options, &mut sink) else { return };
    make_tiny(&mut lowered.scene);
    let Some(proven) = prove(&lowered, &options, &mut sink) else { return };
    let film = render(&proven, &Plan::new(&proven, Rules::ALL), &Job::default(), 1, &|_| true)
        .expect("the system gives one thread");
    let image = film.expect("nobody said stop").image;
    let inside = |channel: &f64| (0.0..=1.0).contains(channel);
    assert!(image.pixels.iter().flatten().all(inside), "every channel is in [0, 1]: {:?}", image.pixels);
}

fn source(bytes: &[u8]) -> (SourceMap, FileId) {
    let mut map = SourceMap::default();
    let file = map.add("trial", bytes.to_vec());
    (map, file)
}

fn round_trips(scene: &Scene) {
    for form in [Form::Text, Form::Binary] {
        let bytes = codec::encode(form, scene).expect("a scene that was read holds finite numbers");
        assert_eq!(codec::recognise(&bytes), Some(form), "what was encoded is recognised");
        let (map, file) = source(&bytes);
        let mut sink = Sink::default();
        let back = codec::decode(form, file, &map, &mut sink);
        assert_eq!(back.as_ref(), Some(scene), "{form:?}: {sink:?}");
    }
}

/// Bounds the work of a picture, and keeps the view.
fn make_tiny(scene: &mut Scene) {
    let Scene {
        camera,
        settings,
        lights,
        images: _,
        textures: _,
        meshes: _,
        materials,
        surfaces,
        names,
        environment: _,
    } = scene;
    camera.size = camera.size.map(|pixels| pixels.min(2 * TINY));
    camera.lens.samples = camera.lens.samples.min(TINY);
    settings.max_depth = settings.max_depth.min(TINY);
    settings.supersampling = settings.supersampling.min(2);
    settings.light_samples = settings.light_samples.min(TINY);
    lights.truncate(TINY as usize);
    surfaces.truncate(8 * TINY as usize);
    names.clear();
    if let Mode::Path(path) = &mut settings.mode {
        path.samples = path.samples.min(TINY);
    }
    for material in materials.iter_mut().filter_map(Material::phong_mut) {
        material.glossy_samples = material.glossy_samples.min(TINY / 2);
    }
}
