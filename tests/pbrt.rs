//! Scenes of pbrt: what they lower to, and what they look like where that is known.

use crate::small::{WHOLE, film};
use flate2::{Compression, write::GzEncoder};
use rtc::internals::diag::DiagnosticSink;
use rtc::internals::ir::{Material, Medium, Mode, Scene, Shape};
use rtc::internals::pipeline::{Options, load};
use rtc::internals::source::{Limits, Loader, Resource, SourceMap};
use std::fs;
use std::io::Write as _;
use std::path::Path;

/// The scene of a file, which has no error, and the codes of its diagnostics.
fn read(path: &Path) -> (Scene, Vec<&'static str>) {
    let (mut map, mut sink) = (SourceMap::default(), DiagnosticSink::default());
    let file = Loader.file(path, &mut map).unwrap();
    let lowered = load(file, &mut map, &Options::default(), &mut sink);
    assert!(!sink.has_errors(), "{:?}", sink.kept());
    let codes = sink.kept().iter().map(|diagnostic| diagnostic.code.id);
    (lowered.unwrap().scene, codes.collect())
}

/// Reads files of a folder; the first one is the scene.
fn read_files(files: &[(&str, &[u8])]) -> (Scene, Vec<&'static str>) {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in files {
        fs::write(folder.path().join(name), bytes).unwrap();
    }
    read(&folder.path().join(files[0].0))
}

/// A scene of version 4 with a camera of 8 × 8 pixels at (0, 0, −10), which looks along +z.
fn head(fov: f64) -> String {
    format!(
        "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8\n\
         PixelFilter \"box\" Sampler \"halton\" \"integer pixelsamples\" 64\n\
         LookAt 0 0 -10 0 0 0 0 1 0\nCamera \"perspective\" \"float fov\" {fov}\nWorldBegin\n"
    )
}

/// The pixels of a scene before that camera, by rows from the top.
fn picture_with(fov: f64, body: &str, files: &[(&str, &[u8])]) -> Vec<[f64; 3]> {
    let text = format!("{}{body}", head(fov));
    let all = [&[("scene.pbrt", text.as_bytes())], files].concat();
    let (scene, _) = read_files(&all);
    film(&scene, &WHOLE, 1).image.pixels
}

fn picture(body: &str) -> Vec<[f64; 3]> {
    picture_with(10.0, body, &[])
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
fn directives_before_the_world_make_camera_and_settings() {
    let text = "Sampler \"stratified\" \"integer xsamples\" 3 \"integer ysamples\" 5\n\
                Integrator \"path\" \"integer maxdepth\" 7\n\
                Film \"rgb\" \"integer xresolution\" 60 \"integer yresolution\" 40\n\
                LookAt 1 2 3 1 2 9 0 1 0\n\
                Camera \"perspective\" \"float fov\" 50 \"float lensradius\" 0.1 \"float focaldistance\" 4\n\
                WorldBegin\nLightSource \"infinite\"\nShape \"sphere\"\n";
    let (scene, codes) = read_files(&[("scene.pbrt", text.as_bytes())]);
    assert_eq!(codes, Vec::<&str>::new());
    let Mode::Path(path) = &scene.settings.mode else {
        panic!("{:?}", scene.settings.mode)
    };
    assert_eq!((path.samples, scene.settings.max_depth), (15, 7));
    let camera = &scene.camera;
    assert_eq!((camera.size, camera.eye), ([60, 40], [1.0, 2.0, 3.0]));
    // The field of view is that of the shorter side.
    let yfov = camera.yfov().unwrap().to_degrees();
    assert!((yfov - 50.0).abs() < 1e-9, "{yfov}");
    assert_eq!((camera.center, camera.lens.radius), ([1.0, 2.0, 7.0], 0.1));
    // Space is left-handed: looking along +z, +x is on the right.
    assert!(camera.right[0] > 0.0 && camera.up[1] > 0.0);
}

#[test]
fn a_convex_diffuse_surface_in_a_white_furnace_shows_its_reflectance() {
    let pixels = picture(
        "LightSource \"infinite\" \"rgb L\" [1 1 1]\n\
         Material \"diffuse\" \"rgb reflectance\" [0.2 0.5 0.8]\nShape \"sphere\" \"float radius\" 2",
    );
    assert_all_near(&pixels, [0.2, 0.5, 0.8], 1e-6);
}

#[test]
fn lights_shine_by_irradiance_intensity_and_power() {
    let wall = "Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]\n\
                Shape \"bilinearmesh\" \"point3 P\" [-50 -50 0 50 -50 0 -50 50 0 50 50 0]\n";
    // Reflected radiance: reflectance / π times the irradiance.
    let known = 0.5 / std::f64::consts::PI * 2.0;
    let sun = "LightSource \"distant\" \"point3 from\" [0 0 -1] \"point3 to\" [0 0 0] \"rgb L\" [2 2 2]\n";
    assert_all_near(&picture(&format!("{sun}{wall}")), [known; 3], 1e-9);
    // A point at a distance of 20 that is 400 times as strong lights the middle as much.
    let point = "LightSource \"point\" \"point3 from\" [0 0 -20] \"rgb I\" [800 800 800]\n";
    let power = 800.0 * 4.0 * std::f64::consts::PI;
    let powered =
        format!("LightSource \"point\" \"point3 from\" [0 0 -20] \"float power\" {power}\n");
    for light in [point.to_owned(), powered] {
        let pixels = picture(&format!("{light}{wall}"));
        let middle = [pixels[27], pixels[28], pixels[35], pixels[36]];
        assert_all_near(&middle, [known; 3], 1e-3 * known);
    }
}

#[test]
fn an_area_light_shines_from_the_side_of_its_normal() {
    // The camera sees the back of one half and the front of the other.
    let light = |reversed: &str| {
        format!(
            "AttributeBegin\nMaterial \"diffuse\" \"rgb reflectance\" [0 0 0]\n\
             AreaLightSource \"diffuse\" \"rgb L\" [3 2 1]\n{reversed}\
             Shape \"disk\" \"float radius\" 5\nAttributeEnd\n"
        )
    };
    assert_all_near(&picture(&light("")), [0.0; 3], 1e-12);
    assert_all_near(
        &picture(&light("ReverseOrientation\n")),
        [3.0, 2.0, 1.0],
        1e-9,
    );
    // A mirrored space keeps the normal, and a turned one does not.
    assert_all_near(&picture(&light("Scale -1 1 1\n")), [0.0; 3], 1e-12);
    assert_all_near(
        &picture(&light("Rotate 180 0 1 0\n")),
        [3.0, 2.0, 1.0],
        1e-9,
    );
    let both = light("").replace("[3 2 1]", "[3 2 1] \"bool twosided\" true");
    assert_all_near(&picture(&both), [3.0, 2.0, 1.0], 1e-9);
}

#[test]
fn the_first_colour_of_a_checkerboard_is_at_the_origin_of_the_surface() {
    // u runs to the right, and v up.
    let pixels = picture(
        "LightSource \"infinite\" \"rgb L\" [1 1 1]\n\
         Texture \"t\" \"spectrum\" \"checkerboard\" \"float uscale\" 2 \"float vscale\" 2 \
         \"rgb tex1\" [1 0 0] \"rgb tex2\" [0 0 1]\n\
         Material \"diffuse\" \"texture reflectance\" \"t\"\n\
         Shape \"bilinearmesh\" \"point3 P\" [-0.87 -0.87 0 0.87 -0.87 0 -0.87 0.87 0 0.87 0.87 0]",
    );
    let [top_left, top_right, bottom_left] = [pixels[9], pixels[14], pixels[49]];
    assert!(
        top_left[2] > 0.9 && top_right[0] > 0.9 && bottom_left[0] > 0.9,
        "{top_left:?} {top_right:?} {bottom_left:?}"
    );
}

/// A picture of radiance (HDR) by its rows from the top; values are at most 1.
fn hdr(width: usize, rows: &[Vec<[f32; 3]>]) -> Vec<u8> {
    let mut bytes = format!(
        "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {} +X {width}\n",
        rows.len()
    )
    .into_bytes();
    for [r, g, b] in rows.iter().flatten() {
        // One byte a channel, with the exponent of 1.
        let byte = |value: &f32| (value * 128.0) as u8;
        bytes.extend([byte(r), byte(g), byte(b), 129]);
    }
    bytes
}

#[test]
fn the_surroundings_stand_where_version_3_puts_them() {
    // Longitude from +x towards +y, latitude from +z: the second of four columns is about the
    // middle between +y and −x.
    let mut rows = vec![vec![[0.0_f32; 3]; 4]; 2];
    rows[0][1] = [1.0, 0.0, 0.0];
    rows[1][2] = [0.0, 1.0, 0.0];
    let map = hdr(4, &rows);
    let seen = |direction: [f64; 3]| {
        let [x, y, z] = direction;
        let text = format!(
            "Film \"image\" \"integer xresolution\" 8 \"integer yresolution\" 8\n\
             Sampler \"halton\" \"integer pixelsamples\" 16\n\
             LookAt 0 0 0 {x} {y} {z} 0.1 0.2 0.7\nCamera \"perspective\" \"float fov\" 2\nWorldBegin\n\
             LightSource \"infinite\" \"string mapname\" \"sky.hdr\"\nWorldEnd\n"
        );
        let (scene, _) = read_files(&[("scene.pbrt", text.as_bytes()), ("sky.hdr", &map)]);
        film(&scene, &WHOLE, 1).image.pixels[27]
    };
    let red = seen([-1.0, 1.0, 1.4]);
    assert!(red[0] > 0.9 && red[1] < 0.1, "{red:?}");
    let green = seen([-1.0, -1.0, -1.4]);
    assert!(green[1] > 0.9 && green[0] < 0.1, "{green:?}");
    let dark = seen([1.0, 1.0, 1.4]);
    assert!(dark[0] + dark[1] < 0.1, "{dark:?}");
}

#[test]
fn the_surroundings_stand_where_version_4_puts_them() {
    // A square of equal areas: +x to the right, +y down, +z in the middle, −z in the corners.
    let side = 16;
    let texel = |row: usize, column: usize| match (row < 8, column < 8) {
        (false, false) => [1.0, 0.0, 0.0],
        (true, false) => [0.0, 1.0, 0.0],
        _ => [0.0; 3],
    };
    let rows: Vec<Vec<[f32; 3]>> = (0..side)
        .map(|row| (0..side).map(|column| texel(row, column)).collect())
        .collect();
    let map = hdr(side, &rows);
    let seen = |[x, y, z]: [f64; 3], turn: &str| {
        let text = format!(
            "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8\n\
             Sampler \"halton\" \"integer pixelsamples\" 16\n\
             LookAt 0 0 0 {x} {y} {z} 0.1 0.2 0.7\nCamera \"perspective\" \"float fov\" 2\nWorldBegin\n\
             {turn}\nLightSource \"infinite\" \"string filename\" \"sky.hdr\"\n"
        );
        let (scene, _) = read_files(&[("scene.pbrt", text.as_bytes()), ("sky.hdr", &map)]);
        film(&scene, &WHOLE, 1).image.pixels[27]
    };
    for z in [-1.0, 1.0] {
        let red = seen([1.0, 1.0, z], "");
        assert!(red[0] > 0.9 && red[1] < 0.1, "{red:?}");
        let green = seen([1.0, -1.0, z], "");
        assert!(green[1] > 0.9 && green[0] < 0.1, "{green:?}");
        // A light that is turned by 90° about +z, from +x to +y.
        let red = seen([-1.0, 1.0, z], "Rotate 90 0 0 1");
        assert!(red[0] > 0.9 && red[1] < 0.1, "{red:?}");
        // A mirrored one.
        let green = seen([1.0, 1.0, z], "Scale 1 -1 1");
        assert!(green[1] > 0.9 && green[0] < 0.1, "{green:?}");
    }
}

#[test]
fn states_are_restored_and_imports_keep_theirs_to_themselves() {
    let text = format!(
        "{}LightSource \"infinite\"\nAttributeBegin\nTranslate 1 0 0\nShape \"sphere\"\nAttributeEnd\n\
         Include \"moved.pbrt\"\nShape \"sphere\"\nImport \"moved.pbrt\"\nShape \"sphere\"\n\
         ObjectBegin \"o\"\nTranslate 0 1 0\nShape \"sphere\"\nObjectEnd\nTranslate 1 0 0\n\
         ObjectInstance \"o\"\nCoordinateSystem \"here\"\nIdentity\nCoordSysTransform \"here\"\n\
         Shape \"sphere\"",
        head(10.0)
    );
    let moved = b"Translate 0 0 3\nShape \"sphere\" \"float radius\" 2";
    let (scene, codes) = read_files(&[("scene.pbrt", text.as_bytes()), ("moved.pbrt", moved)]);
    assert_eq!(codes, Vec::<&str>::new());
    let spheres: Vec<_> = scene
        .surfaces
        .iter()
        .map(|surface| match &surface.shape {
            Shape::Sphere(sphere) => (sphere.center, sphere.radius),
            other => panic!("{other:?}"),
        })
        .collect();
    assert_eq!(
        spheres,
        [
            ([1.0, 0.0, 0.0], 1.0),
            ([0.0, 0.0, 3.0], 2.0),
            ([0.0, 0.0, 3.0], 1.0),
            ([0.0, 0.0, 6.0], 2.0),
            ([0.0, 0.0, 3.0], 1.0),
            // Where the object was defined, moved to where it is used.
            ([1.0, 1.0, 6.0], 1.0),
            ([1.0, 0.0, 3.0], 1.0),
        ]
    );
}

#[test]
fn the_names_of_version_3_mean_what_they_did() {
    // `matte` is `diffuse`, and the same picture, but for the directions of the environment.
    let pixels = |text: &str| {
        let text = format!("{}{text}", head(10.0));
        let (scene, _) = read_files(&[("scene.pbrt", text.as_bytes())]);
        film(&scene, &WHOLE, 1).image.pixels
    };
    let new = pixels(
        "LightSource \"point\" \"point3 from\" [0 3 -9] \"rgb I\" [50 60 70]\n\
         Material \"diffuse\" \"rgb reflectance\" [0.2 0.5 0.8]\nShape \"sphere\"",
    );
    let old = pixels(
        "LightSource \"point\" \"point from\" [0 3 -9] \"color I\" [50 60 70]\n\
         Material \"matte\" \"color Kd\" [0.2 0.5 0.8]\nShape \"sphere\"\nWorldEnd",
    );
    assert_eq!(new, old);
    assert!(new.iter().any(|pixel| pixel[2] > 0.1));
}

#[test]
fn the_crop_of_an_orthographic_camera_looks_along_its_axis() {
    let text = b"Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8 \
        \"float cropwindow\" [ 0.5 1 0 1 ]\nCamera \"orthographic\"\nWorldBegin\n";
    let (scene, codes) = read_files(&[("a.pbrt", text)]);
    assert_eq!(codes, Vec::<&str>::new());
    let [eye, center] = [scene.camera.eye, scene.camera.center];
    assert_eq!((eye, center), ([0.5, 0.0, 0.0], [0.5, 0.0, 1.0]));
    assert_eq!(scene.camera.size, [4, 8]);
}

#[test]
fn media_of_shapes_and_of_the_camera_are_read() {
    let (scene, codes) = read_files(&[(
        "scene.pbrt",
        br#"MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_a" [ 1 2 3 ]
            "rgb sigma_s" [ 4 5 6 ] "float g" 0.5 "float scale" 2
        MakeNamedMedium "smoke" "string type" "homogeneous" "string preset" "Skin1"
        MediumInterface "" "fog"
        LookAt 0 0 -10 0 0 0 0 1 0 Camera "perspective"
        WorldBegin LightSource "infinite"
        AttributeBegin
            MediumInterface "smoke" "fog"
            Material "interface" Shape "sphere"
        AttributeEnd
        MediumInterface "fog" Material "interface" Shape "sphere"
        Material "diffuse" Shape "sphere""#,
    )]);
    let fog = Medium {
        sigma_a: [2.0, 4.0, 6.0],
        sigma_s: [8.0, 10.0, 12.0],
        g: 0.5,
    };
    // The preset is not known; a shape with fog on both sides leads nowhere.
    assert_eq!(codes, ["PB004"]);
    assert_eq!(scene.medium, Some(fog));
    assert_eq!(scene.surfaces.len(), 2);
    let Material::Standard(interface) = &scene.materials[0] else {
        panic!("a standard material");
    };
    assert_eq!(interface.exterior, Some(fog));
    assert!(interface.interior.is_some_and(|smoke| smoke.scatters()));
}

#[test]
fn what_a_compressed_file_becomes_raises_no_limit() {
    let mut packed = GzEncoder::new(Vec::new(), Compression::best());
    packed.write_all(&b"#\n".repeat(1 << 20)).unwrap();
    let packed = packed.finish().unwrap();
    let folder = tempfile::tempdir().unwrap();
    let scene = head(90.0) + "Include \"a.pbrt.gz\"\nInclude \"a.pbrt.gz\"\nShape \"sphere\"\n";
    fs::write(folder.path().join("a.pbrt"), &scene).unwrap();
    fs::write(folder.path().join("a.pbrt.gz"), &packed).unwrap();
    let (mut map, mut sink) = (SourceMap::default(), DiagnosticSink::default());
    let file = Loader
        .file(&folder.path().join("a.pbrt"), &mut map)
        .unwrap();
    assert!(load(file, &mut map, &Options::default(), &mut sink).is_some());
    let read = (scene.len() + packed.len()) as u64;
    let limit = map.budget().limit(Resource::Memory);
    assert_eq!(limit, Limits::default().of(Resource::Memory, read));
}
