//! Scenes of Mitsuba: what they lower to, what they look like where that is known, and that what is
//! written for Mitsuba is read back.

use crate::repo::root;
use crate::small::{WHOLE, film};
use rtc::internals::diag::Sink;
use rtc::internals::ir::{Mode, Scene};
use rtc::internals::pipeline::{Options, load};
use rtc::internals::source::{Loader, SourceMap};
use std::fs;
use std::path::Path;
use std::process::Command;

/// The scene of a file, which has no error, and the codes of its diagnostics.
fn read(path: &Path) -> (Scene, Vec<&'static str>) {
    read_with(path, &Options::default())
}

fn read_with(path: &Path, options: &Options) -> (Scene, Vec<&'static str>) {
    let (mut map, mut sink) = (SourceMap::default(), Sink::default());
    let file = Loader.file(path, &mut map).unwrap();
    let lowered = load(file, &mut map, options, &mut sink);
    assert!(!sink.has_errors(), "{:?}", sink.kept());
    let codes = sink.kept().iter().map(|diagnostic| diagnostic.code.id);
    (lowered.unwrap().scene, codes.collect())
}

#[test]
fn version_0_5_with_parameters_and_an_included_file_is_read() {
    let (scene, codes) = read(&root("tests/mitsuba/room.xml"));
    assert_eq!(codes, Vec::<&str>::new());
    let Mode::Path(path) = &scene.settings.mode else {
        panic!("{:?}", scene.settings.mode)
    };
    assert_eq!((path.samples, scene.settings.max_depth), (16, 3));
    assert_eq!((scene.surfaces.len(), scene.materials.len()), (4, 4));
    assert_eq!(scene.camera.size, [48, 32]);
    let yfov = scene.camera.yfov().unwrap().to_degrees();
    assert!((yfov - 40.0).abs() < 1e-9, "{yfov}");
    // The picture is not mirrored: its right is the +x of the world.
    assert!(scene.camera.right[0] > 0.0 && scene.camera.up[1] > 0.0);
}

#[test]
fn a_definition_comes_before_the_default_and_one_without_effect_is_told() {
    let mut options = Options::default();
    let mut define = |name: &str, value: &str| {
        let defined = &mut options.front.define;
        defined.insert(name.to_owned(), value.to_owned());
    };
    define("samples", "5");
    define("nothing", "1");
    let (scene, codes) = read_with(&root("tests/mitsuba/room.xml"), &options);
    let Mode::Path(path) = &scene.settings.mode else {
        panic!("{:?}", scene.settings.mode)
    };
    assert_eq!((path.samples, codes), (5, vec!["MI005"]));
}

/// Writes a scene with a sensor of 8 × 8 pixels in front of it, and renders it.
fn picture(body: &str) -> Vec<[f64; 3]> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.xml");
    let text = format!(
        r#"<scene version="3.0.0">
            <sensor type="perspective">
                <float name="fov" value="10"/>
                <transform name="to_world">
                    <lookat origin="0, 0, 10" target="0, 0, 0" up="0, 1, 0"/>
                </transform>
                <sampler type="independent"><integer name="sample_count" value="64"/></sampler>
                <film type="hdrfilm">
                    <integer name="width" value="8"/>
                    <integer name="height" value="8"/>
                    <rfilter type="box"/>
                </film>
            </sensor>
            {body}
        </scene>"#
    );
    fs::write(&path, text).unwrap();
    let (scene, _) = read(&path);
    film(&scene, &WHOLE, 1).image.pixels
}

fn assert_all_near(pixels: &[[f64; 3]], value: [f64; 3], tolerance: f64) {
    for pixel in pixels {
        for (channel, known) in pixel.iter().zip(value) {
            assert!(
                (channel - known).abs() < tolerance,
                "{pixel:?}, not {value:?}"
            );
        }
    }
}

#[test]
fn a_convex_diffuse_surface_in_a_white_furnace_shows_its_reflectance() {
    let pixels = picture(
        r#"<emitter type="constant"/>
        <shape type="sphere">
            <float name="radius" value="2"/>
            <bsdf type="diffuse"><rgb name="reflectance" value="0.2, 0.5, 0.8"/></bsdf>
        </shape>"#,
    );
    assert_all_near(&pixels, [0.2, 0.5, 0.8], 1e-6);
}

#[test]
fn a_sun_shines_by_its_irradiance_and_a_point_by_its_intensity() {
    let floor = r#"<shape type="rectangle">
        <transform name="to_world"><scale value="50"/></transform>
        <bsdf type="diffuse"><rgb name="reflectance" value="0.5"/></bsdf>
    </shape>"#;
    // Reflected radiance: reflectance / π times the irradiance.
    let sun = r#"<emitter type="directional">
        <vector name="direction" x="0" y="0" z="-1"/>
        <rgb name="irradiance" value="2"/>
    </emitter>"#;
    let known = 0.5 / std::f64::consts::PI * 2.0;
    assert_all_near(&picture(&format!("{sun}{floor}")), [known; 3], 1e-9);
    // A point at a distance of 20 that is 400 times as strong lights the middle as much.
    let point = r#"<emitter type="point">
        <point name="position" x="0" y="0" z="20"/>
        <rgb name="intensity" value="800"/>
    </emitter>"#;
    let pixels = picture(&format!("{point}{floor}"));
    let middle = [pixels[27], pixels[28], pixels[35], pixels[36]];
    assert_all_near(&middle, [known; 3], 1e-3 * known);
}

#[test]
fn an_image_is_not_mirrored_and_its_first_row_is_at_the_top() {
    // The colours of a checkerboard of one period: color0 where both halves are equal.
    let pixels = picture(
        r#"<emitter type="constant"/>
        <shape type="rectangle">
            <transform name="to_world"><scale value="0.8748866"/></transform>
            <bsdf type="diffuse">
                <texture type="checkerboard" name="reflectance">
                    <rgb name="color0" value="1, 0, 0"/>
                    <rgb name="color1" value="0, 0, 1"/>
                </texture>
            </bsdf>
        </shape>"#,
    );
    let [top_left, top_right] = [pixels[9], pixels[14]];
    assert!(
        top_left[2] > 0.9 && top_right[0] > 0.9,
        "{top_left:?} {top_right:?}"
    );
}

#[test]
fn what_is_written_for_mitsuba_is_read_back() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("scene.yaml");
    fs::write(
        &scene,
        "Camera: {eye: [0, 2, 9], center: [0, 1, 0], up: [0, 1, 0], viewSize: [24, 16], fov: 30}\n\
         RenderMode: path\nSuperSampling: {factor: 4}\nMaxRecursionDepth: 3\n\
         Environment: {color: [0.3, 0.4, 0.5]}\n\
         Lights: [{type: sun, direction: [1, 2, 1], irradiance: 2}]\n\
         Objects:\n\
         - {type: sphere, position: [-1, 1, 0], radius: 1, material: &m {type: standard, \
         baseColor: [0.8, 0.3, 0.2, 1], metallic: 0, roughness: 1, specular: 0, \
         doubleSided: true}}\n\
         - {type: circle, center: [1.5, 1, 0], normal: [0, 1, 2], radius: 1, material: *m}\n\
         - {type: quad, v0: [-5, 0, -5], v1: [-5, 0, 5], v2: [5, 0, 5], v3: [5, 0, -5], \
         material: *m}\n",
    )
    .unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_rtc"))
        .args(["compile", "scene.yaml", "-o", "scene.xml"])
        .current_dir(folder.path())
        .output()
        .unwrap();
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let (written, _) = read(&scene);
    let (again, codes) = read(&scene.with_extension("xml"));
    assert_eq!(codes, Vec::<&str>::new());
    let [a, b] = [&written, &again].map(|scene| film(scene, &WHOLE, 1).image.pixels);
    assert_eq!(a.len(), b.len());
    let error: f64 = a
        .iter()
        .flatten()
        .zip(b.iter().flatten())
        .map(|(a, b)| (a - b).abs())
        .sum();
    let mean = error / (3.0 * a.len() as f64);
    assert!(mean < 2e-3, "the pictures differ by {mean} in the mean");
}
