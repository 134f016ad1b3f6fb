//! Scenes of Mitsuba: what they lower to, what they look like where that is known, and that what is
//! written for Mitsuba is read back.

use crate::repo::root;
use crate::small::{WHOLE, film};
use rtc::internals::diag::DiagnosticSink;
use rtc::internals::ir::{Camera, Light, Material, Medium, Mode, Scene, Shape};
use rtc::internals::math::{ComplexIndex, Microfacets, PixelFilter, Vec3};
use rtc::internals::pipeline::{Options, load};
use rtc::internals::source::{Loader, SourceMap};
use std::fs;
use std::path::Path;
use std::process::Command;

/// The scene of a file, which has no error, and the codes of its diagnostics.
pub(crate) fn read(path: &Path) -> (Scene, Vec<&'static str>) {
    read_with(path, &Options::default())
}

fn read_with(path: &Path, options: &Options) -> (Scene, Vec<&'static str>) {
    let (mut map, mut sink) = (SourceMap::default(), DiagnosticSink::default());
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
    // The last surface is the back of the light.
    assert_eq!((scene.surfaces.len(), scene.materials.len()), (5, 5));
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
pub(crate) fn picture(body: &str) -> Vec<[f64; 3]> {
    picture_with(body, &[])
}

/// As [`picture`], with files beside the scene.
fn picture_with(body: &str, files: &[(&str, &str)]) -> Vec<[f64; 3]> {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        fs::write(folder.path().join(name), text).unwrap();
    }
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

#[test]
fn a_flat_light_shines_on_the_side_of_its_normal() {
    let light = |flips: bool, shape: &str| {
        let body = format!(
            r#"<shape type="{shape}">
                <transform name="to_world"><scale value="5"/></transform>
                <boolean name="flip_normals" value="{flips}"/>
                <emitter type="area"><rgb name="radiance" value="3"/></emitter>
            </shape>"#
        );
        picture(&body)
    };
    for shape in ["rectangle", "disk"] {
        assert_all_near(&light(false, shape), [3.0; 3], 1e-9);
        assert_all_near(&light(true, shape), [0.0; 3], 1e-9);
    }
    // The back of a light with a BSDF of two sides scatters light.
    let body = r#"<emitter type="constant"/><shape type="rectangle">
        <transform name="to_world"><scale value="5"/></transform>
        <boolean name="flip_normals" value="true"/>
        <bsdf type="twosided"><bsdf type="diffuse"/></bsdf>
        <emitter type="area"><rgb name="radiance" value="3"/></emitter>
    </shape>"#;
    assert_all_near(&picture(body), [0.5; 3], 1e-9);
}

#[test]
fn a_scaled_sphere_that_shines_stays_a_sphere_and_a_disc_that_is_textured_has_coordinates() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.xml");
    let texture =
        r#"<bsdf type="diffuse"><texture type="checkerboard" name="reflectance"/></bsdf>"#;
    let text = format!(
        r#"<scene version="3.0.0"><sensor type="perspective"/>
            <shape type="sphere">
                <transform name="to_world"><scale value="2"/></transform>
                <emitter type="area"/>
            </shape>
            <shape type="disk"><emitter type="area"/></shape>
            <shape type="disk">{texture}</shape>
        </scene>"#
    );
    fs::write(&path, text).unwrap();
    let (scene, _) = read(&path);
    let [sphere, disc, mesh, cover] = &scene.surfaces[..] else {
        panic!("{:?}", scene.surfaces)
    };
    assert!(matches!(&sphere.shape, Shape::Sphere(sphere) if sphere.radius == 2.0));
    assert!(matches!(&disc.shape, Shape::Disc(_)));
    assert!(matches!(&cover.shape, Shape::Disc(_)) && cover.material != disc.material);
    let Shape::Instance(instance) = &mesh.shape else {
        panic!("{:?}", mesh.shape)
    };
    assert!(!scene.meshes[instance.mesh.0 as usize].uvs.is_empty());
}

#[test]
fn a_spot_falls_off_linearly_in_the_angle_and_is_written_so() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.xml");
    let text = r#"<scene version="3.0.0"><sensor type="perspective"/>
        <emitter type="spot">
            <transform name="to_world">
                <lookat origin="0, 0, 5" target="0, 0, 0" up="0, 1, 0"/>
            </transform>
            <float name="cutoff_angle" value="40"/><float name="beam_width" value="10"/>
        </emitter>
        <shape type="sphere"/>
    </scene>"#;
    fs::write(&path, text).unwrap();
    let again = folder.path().join("again.xml");
    let output = Command::new(env!("CARGO_BIN_EXE_rtc"))
        .args(["compile", "scene.xml", "-o", "again.xml"])
        .current_dir(folder.path())
        .output()
        .unwrap();
    assert!(output.status.success(), "{output:?}");
    for path in [path, again] {
        let (scene, _) = read(&path);
        let [Light::Punctual(light)] = &scene.lights[..] else {
            panic!("{:?}", scene.lights)
        };
        let profile = light.emitter.profile().unwrap();
        for (degrees, known) in [
            (0.0, 1.0),
            (10.0, 1.0),
            (25.0, 0.5),
            (34.0, 0.2),
            (41.0, 0.0),
        ] {
            let angle = f64::to_radians(degrees);
            let factor = profile.factor(Vec3::new(angle.sin(), 0.0, -angle.cos()));
            assert!((factor - known).abs() < 1e-9, "{degrees}: {factor}");
        }
    }
}

#[test]
fn a_projector_shows_its_texture_upright_and_a_spot_within_its_cone() {
    // A projector where the sensor is; the diagonal of its four squares has the first colour.
    let light = |kind: &str, texture: &str, more: &str| {
        format!(
            r#"<emitter type="{kind}">
                <transform name="to_world">
                    <lookat origin="0, 0, 10" target="0, 0, 0" up="0, 1, 0"/>
                </transform>
                <texture name="{texture}" type="checkerboard">
                    <rgb name="color0" value="1"/><rgb name="color1" value="0.25"/>
                </texture>
                {more}
            </emitter>
            <shape type="rectangle">
                <transform name="to_world"><scale value="50"/></transform>
                <bsdf type="diffuse"><rgb name="reflectance" value="0.5"/></bsdf>
            </shape>"#
        )
    };
    // The irradiance of a projector at the distance 1 is π times its own, as Mitsuba measures it.
    let projector = light(
        "projector",
        "irradiance",
        r#"<float name="fov" value="20"/>"#,
    );
    let spot = r#"<rgb name="intensity" value="3.141592653589793"/>
        <float name="cutoff_angle" value="20"/><float name="beam_width" value="19"/>"#;
    let (first, second) = (0.5 / 100.0, 0.25 * 0.5 / 100.0);
    // The texture of a spot is turned by half a turn, which does not change the squares.
    for body in [projector, light("spot", "texture", spot)] {
        let pixels = picture(&body);
        let corners = [(0, first), (7, second), (56, second), (63, first)];
        for (pixel, known) in corners {
            let [value, ..] = pixels[pixel];
            assert!(
                (value / known - 1.0).abs() < 0.02,
                "{pixel}: {value}, not {known}"
            );
        }
    }
    // Beyond its field of view it is dark.
    let narrow = light(
        "projector",
        "irradiance",
        r#"<float name="fov" value="5"/>"#,
    );
    assert_eq!(picture(&narrow)[0], [0.0; 3]);
}

#[test]
fn a_texture_shows_the_colours_of_vertices_or_of_faces() {
    let ply = "ply\nformat ascii 1.0\nelement vertex 4\n\
        property float x\nproperty float y\nproperty float z\n\
        property float color_0\nproperty float color_1\nproperty float color_2\n\
        element face 1\nproperty list uchar int vertex_indices\n\
        property float color_0\nproperty float color_1\nproperty float color_2\nend_header\n\
        -9 -9 0 0.2 0.5 0.8\n9 -9 0 0.2 0.5 0.8\n9 9 0 0.2 0.5 0.8\n-9 9 0 0.2 0.5 0.8\n\
        4 0 1 2 3 0.7 0.4 0.1\n";
    let body = |reflectance: &str| {
        format!(
            r#"<emitter type="constant"/>
            <shape type="ply">
                <string name="filename" value="quad.ply"/>
                <bsdf type="diffuse">{reflectance}</bsdf>
            </shape>"#
        )
    };
    let attribute = |name| {
        let name = format!(r#"<string name="name" value="{name}"/>"#);
        body(&format!(
            r#"<texture type="mesh_attribute" name="reflectance">{name}</texture>"#
        ))
    };
    for (scene, known) in [
        (attribute("vertex_color"), [0.2, 0.5, 0.8]),
        (attribute("face_color"), [0.7, 0.4, 0.1]),
        (body(r#"<rgb name="reflectance" value="0.5"/>"#), [0.5; 3]),
    ] {
        assert_all_near(&picture_with(&scene, &[("quad.ply", ply)]), known, 1e-6);
    }
}

#[test]
fn the_crop_of_a_film_is_that_part_of_the_picture() {
    let scene = |crop: &str| {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("scene.xml");
        let text = format!(
            r#"<scene version="3.0.0">
                <sensor type="perspective"><film type="hdrfilm">
                    <integer name="width" value="32"/><integer name="height" value="20"/>{crop}
                </film></sensor>
                <emitter type="constant"/>
            </scene>"#
        );
        fs::write(&path, text).unwrap();
        read(&path).0.camera
    };
    let whole = scene("");
    let part = scene(
        r#"<integer name="crop_offset_x" value="5"/><integer name="crop_offset_y" value="3"/>
        <integer name="crop_width" value="8"/><integer name="crop_height" value="6"/>"#,
    );
    assert_eq!(part.size, [8, 6]);
    // Pixel (5, 3) of the whole is pixel (0, 0) of the part.
    let corner = |camera: &Camera, x: f64, y: f64| {
        let [w, h] = camera.size.map(f64::from);
        let [right, up] = [camera.right, camera.up].map(Vec3::from_array);
        Vec3::from_array(camera.center) + right * (x - w / 2.0) + up * (h / 2.0 - y)
    };
    let [a, b] = [corner(&whole, 5.0, 3.0), corner(&part, 0.0, 0.0)];
    assert!((a - b).length() < 1e-12, "{a:?} {b:?}");
}

#[test]
fn a_metal_reflects_by_its_complex_index_at_all_angles() {
    let metal = |angle: f64, bsdf: &str| {
        let body = format!(
            r#"<emitter type="constant"/>
            <shape type="rectangle">
                <transform name="to_world"><scale value="50"/><rotate x="1" angle="{angle}"/></transform>
                {bsdf}
            </shape>"#
        );
        picture(&body)
    };
    // Gold by its name, without the light that is scattered several times, and by numbers.
    let index = ComplexIndex {
        eta: Vec3::new(0.143042, 0.375313, 1.44205),
        k: Vec3::new(3.983, 2.38556, 1.60336),
    };
    for bsdf in [
        r#"<bsdf type="conductor"><string name="material" value="Au"/></bsdf>"#,
        r#"<bsdf type="conductor">
            <rgb name="eta" value="0.143042, 0.375313, 1.44205"/>
            <rgb name="k" value="3.983, 2.38556, 1.60336"/>
        </bsdf>"#,
    ] {
        for angle in [0.0, 80.0] {
            let pixels = metal(angle, bsdf);
            let normal = Vec3::new(
                0.0,
                f64::to_radians(-angle).sin(),
                f64::to_radians(angle).cos(),
            );
            // A pixel by the direction through its centre: the view is 10° wide.
            let side = f64::to_radians(5.0).tan() / 4.0;
            for (index_of_pixel, pixel) in pixels.iter().enumerate() {
                let [x, y] = [index_of_pixel % 8, index_of_pixel / 8].map(|at| at as f64 - 3.5);
                let ray = Vec3::new(x * side, -y * side, -1.0).normalize();
                let known = index.reflectance(ray.dot(normal).abs());
                let difference = (Vec3::from_array(*pixel) - known).abs().max_element();
                assert!(difference < 2e-3, "{pixel:?} {known}");
            }
        }
    }
    // A mirror without an index, with a tint that grazing light keeps.
    let mirror = r#"<bsdf type="conductor">
        <rgb name="specular_reflectance" value="0.2, 0.5, 0.8"/>
    </bsdf>"#;
    assert_all_near(&metal(80.0, mirror), [0.2, 0.5, 0.8], 1e-9);
}

#[test]
fn a_metal_is_the_same_in_every_format_that_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.xml");
    let text = r#"<scene version="3.0.0"><sensor type="perspective"/>
        <emitter type="constant"/>
        <shape type="sphere">
            <bsdf type="roughconductor">
                <string name="distribution" value="ggx"/>
                <float name="alpha" value="0.04"/>
                <string name="material" value="Cu"/>
                <rgb name="specular_reflectance" value="0.5, 0.75, 1"/>
            </bsdf>
        </shape>
    </scene>"#;
    fs::write(&path, text).unwrap();
    let (scene, codes) = read(&path);
    assert_eq!(codes, Vec::<&str>::new());
    for name in ["again.xml", "again.gltf", "again.yaml"] {
        let output = Command::new(env!("CARGO_BIN_EXE_rtc"))
            .args(["compile", "scene.xml", "-o", name])
            .current_dir(folder.path())
            .output()
            .unwrap();
        assert!(output.status.success(), "{output:?}");
        let (again, _) = read(&folder.path().join(name));
        let [one, other] = [&scene, &again].map(|scene| match &scene.materials[0] {
            Material::Standard(standard) => (**standard).clone(),
            Material::Phong(phong) => panic!("{phong:?}"),
        });
        assert!(
            one.conductor.is_some() && one.conductor == other.conductor,
            "{name}"
        );
        assert_eq!(one.base_color, other.base_color, "{name}");
        assert_eq!(one.microfacets, Microfacets::SeparableGgx);
        assert_eq!(one.microfacets, other.microfacets, "{name}");
        assert!(one.black_back && other.black_back, "{name}");
        assert!((one.roughness - other.roughness).abs() < 1e-9, "{name}");
        // The filter of the pixels, too: that of Mitsuba's films is a Gaussian.
        let filter = |scene: &Scene| match &scene.settings.mode {
            Mode::Path(path) => path.filter,
            mode => panic!("{mode:?}"),
        };
        assert!(!filter(&scene).is_pixel(), "{name}");
        assert_eq!(filter(&scene), filter(&again), "{name}");
    }
}

#[test]
fn an_edge_is_as_soft_as_the_filter_of_the_film() {
    for (filter, known) in [
        (
            r#"<rfilter type="gaussian"/>"#,
            PixelFilter::Gaussian {
                deviation: 0.5,
                radius: 2.0,
            },
        ),
        (
            r#"<rfilter type="tent"><float name="radius" value="1.5"/></rfilter>"#,
            PixelFilter::Tent { radius: 1.5 },
        ),
        (r#"<rfilter type="catmullrom"/>"#, PixelFilter::CATMULL_ROM),
    ] {
        // A light that covers the left half of the picture.
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("scene.xml");
        let text = format!(
            r#"<scene version="3.0.0">
                <sensor type="orthographic">
                    <transform name="to_world">
                        <lookat origin="0, 0, 10" target="0, 0, 0" up="0, 1, 0"/>
                    </transform>
                    <sampler type="independent"><integer name="sample_count" value="256"/></sampler>
                    <film type="hdrfilm">
                        <integer name="width" value="8"/><integer name="height" value="8"/>{filter}
                    </film>
                </sensor>
                <shape type="rectangle">
                    <transform name="to_world"><scale value="9"/><translate x="-9"/></transform>
                    <emitter type="area"><rgb name="radiance" value="1"/></emitter>
                </shape>
            </scene>"#
        );
        fs::write(&path, text).unwrap();
        let (scene, codes) = read(&path);
        assert_eq!(codes, Vec::<&str>::new());
        let pixels = film(&scene, &WHOLE, 1).image.pixels;
        // The share of the filter to the left of the edge, which is between two columns.
        let steps = 4000;
        let place = |k: i32| (f64::from(k) + 0.5) / f64::from(steps) * 8.0 - 4.0;
        let weight = |k: i32| known.weight(place(k));
        let whole: f64 = (0..steps).map(weight).sum();
        for column in 0..8 {
            let edge = 3.5 - f64::from(column);
            let left = (0..steps).filter(|k| place(*k) < edge).map(weight);
            let share = left.sum::<f64>() / whole;
            let shown = (0..8).map(|row| pixels[(8 * row + column) as usize][0]);
            let mean = shown.sum::<f64>() / 8.0;
            assert!(
                (mean - share).abs() < 0.01,
                "{filter} {column}: {mean}, not {share}"
            );
        }
    }
}

#[test]
fn files_are_found_in_the_folders_of_path() {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("data")).unwrap();
    let mesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    fs::write(folder.path().join("data/corner.obj"), mesh).unwrap();
    let path = folder.path().join("scene.xml");
    let text = r#"<scene version="3.0.0">
        <path value="nothing"/>
        <path value="data"/>
        <sensor type="perspective"/>
        <emitter type="constant"/>
        <shape type="obj"><string name="filename" value="corner.obj"/></shape>
    </scene>"#;
    fs::write(&path, text).unwrap();
    let (scene, codes) = read(&path);
    assert_eq!((scene.meshes[0].triangles.len(), codes), (1, Vec::new()));
}

/// The scene of a text, and the codes of its diagnostics.
fn read_text(text: &str) -> (Scene, Vec<&'static str>) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.xml");
    fs::write(&path, text).unwrap();
    read(&path)
}

/// The media inside and outside of the surfaces of a scene.
fn media(scene: &Scene) -> Vec<[Option<Medium>; 2]> {
    let surfaces = scene.surfaces.iter();
    let materials = surfaces.map(|surface| &scene.materials[surface.material.0 as usize]);
    let media = materials.map(|material| match material {
        Material::Standard(standard) => [standard.interior, standard.exterior],
        Material::Phong(_) => [None; 2],
    });
    media.collect()
}

const MEDIA: &str = r#"
    <medium type="homogeneous" id="a"><rgb name="sigma_t" value="1 2 4"/><rgb name="albedo" value="0.5 0.25 1"/>
        <float name="scale" value="2"/>
        <phase type="hg"><float name="g" value="0.5"/></phase></medium>
    <medium type="heterogeneous" id="b">
        <volume name="sigma_t" type="constvolume"><float name="value" value="3"/></volume>
        <float name="albedo" value="0"/></medium>
    <shape type="sphere"><bsdf type="null"/><ref name="interior" id="a"/>
        <ref name="exterior" id="b"/></shape>
    <shape type="rectangle"><boolean name="flip_normals" value="true"/><bsdf type="dielectric"/>
        <ref name="interior" id="b"/></shape>
    <shape type="sphere"><bsdf type="null"/></shape>"#;

#[test]
fn media_of_shapes_and_of_the_sensor_are_read() {
    let (scene, codes) = read_text(&format!(
        r#"<scene version="3.0.0"><integrator type="volpathmis"/>
        <sensor type="perspective"><ref id="b"/></sensor><emitter type="constant"/>{MEDIA}</scene>"#
    ));
    assert_eq!(codes, ["MI004"]);
    let a = Medium {
        sigma_a: [1.0, 3.0, 0.0],
        sigma_s: [1.0, 1.0, 8.0],
        g: 0.5,
    };
    let b = Medium {
        sigma_a: [3.0; 3],
        ..Medium::default()
    };
    assert_eq!(scene.medium, Some(b));
    assert_eq!(media(&scene), [[Some(a), Some(b)], [None, Some(b)]]);
}

#[test]
fn coefficients_of_older_versions_are_read_and_what_is_not_known_is_told() {
    let (scene, codes) = read_text(
        r#"<scene version="0.6.0"><integrator type="volpath"/><sensor type="perspective"/>
        <emitter type="constant"/>
        <shape type="sphere"><medium type="homogeneous" name="interior">
            <rgb name="sigmaA" value="1, 2, 3"/><rgb name="sigmaS" value="0.5, 0, 0"/>
            <string name="material" value="Ketchup"/><phase type="rayleigh"/>
        </medium></shape></scene>"#,
    );
    let expected = Medium {
        sigma_a: [1.0, 2.0, 3.0],
        sigma_s: [0.5, 0.0, 0.0],
        g: 0.0,
    };
    assert_eq!(media(&scene), [[Some(expected), None]]);
    assert_eq!(codes, ["MI004", "MI003"]);
}

#[test]
fn an_integrator_without_media_shows_none_and_tells_so() {
    let (scene, codes) = read_text(&format!(
        r#"<scene version="3.0.0"><integrator type="path"/><sensor type="perspective"/>
        <emitter type="constant"/>{MEDIA}</scene>"#
    ));
    assert_eq!(media(&scene), [[None; 2]]);
    assert_eq!(codes, ["MI005", "MI005", "MI004"]);
}
