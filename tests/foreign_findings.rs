//! What a scene of Mitsuba or pbrt says and the picture does not show is told, and what those
//! programs go on after is read.

use crate::small::{WHOLE, film};
use rtc::internals::diag::{DiagnosticSink, Severity};
use rtc::internals::ir::{Pixels, Scene, Shape};
use rtc::internals::math::Vec3;
use rtc::internals::pipeline::{Options, load};
use rtc::internals::source::{Loader, Resource, SourceMap};
use std::fs;

/// What became of some files, of which the first one is the scene.
struct Outcome {
    scene: Option<Scene>,
    /// The code and the message of each finding.
    findings: Vec<(&'static str, String)>,
    has_errors: bool,
    /// The nodes that were charged.
    work: u64,
}

fn outcome(files: &[(&str, &[u8])]) -> Outcome {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in files {
        fs::write(folder.path().join(name), bytes).unwrap();
    }
    let (mut map, mut sink) = (SourceMap::default(), DiagnosticSink::default());
    let file = Loader
        .file(&folder.path().join(files[0].0), &mut map)
        .unwrap();
    let lowered = load(file, &mut map, &Options::default(), &mut sink);
    let findings = sink.kept().iter();
    let findings = findings.filter(|own| own.severity < Severity::Note);
    let budget = map.budget();
    Outcome {
        scene: lowered.map(|lowered| lowered.scene),
        findings: findings
            .map(|own| (own.code.id, own.message.clone()))
            .collect(),
        has_errors: sink.has_errors(),
        work: budget.limit(Resource::Nodes) - budget.remaining(Resource::Nodes),
    }
}

const SENSOR: &str = r#"<sensor type="perspective"><float name="fov" value="10"/>
    <transform name="to_world"><lookat origin="0, 0, 10" target="0, 0, 0" up="0, 1, 0"/></transform>
    <sampler type="independent"><integer name="sample_count" value="16"/></sampler>
    <film type="hdrfilm"><integer name="width" value="8"/><integer name="height" value="8"/>
    <rfilter type="box"/></film></sensor>"#;

fn mitsuba_with(body: &str, files: &[(&str, &[u8])]) -> Outcome {
    let text = format!(r#"<scene version="3.0.0">{SENSOR}{body}</scene>"#);
    outcome(&[&[("a.xml", text.as_bytes())], files].concat())
}

fn mitsuba(body: &str) -> Outcome {
    mitsuba_with(body, &[])
}

fn pbrt(body: &str) -> Outcome {
    let text = format!("{PBRT}{body}");
    outcome(&[("a.pbrt", text.as_bytes())])
}

const PBRT: &str = "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8\n\
    PixelFilter \"box\" Sampler \"halton\" \"integer pixelsamples\" 16\n\
    LookAt 0 0 -10 0 0 0 0 1 0\nCamera \"perspective\" \"float fov\" 10\nWorldBegin\n\
    LightSource \"infinite\" \"rgb L\" [1 1 1]\n";

impl Outcome {
    /// The mean of the picture.
    fn mean(&self) -> Vec3 {
        let image = film(self.scene.as_ref().unwrap(), &WHOLE, 1).image;
        let sum: Vec3 = image.pixels.iter().copied().map(Vec3::from_array).sum();
        sum / image.pixels.len() as f64
    }

    /// Asserts that there is one finding, with this code and text.
    fn tells(&self, code: &str, text: &str) {
        let [(found, message)] = &self.findings[..] else {
            panic!("{code} {text}: {:?}", self.findings)
        };
        assert!(
            *found == code && message.contains(text),
            "{code} {text}: {message}"
        );
    }

    fn is_near(&self, color: [f64; 3], tolerance: f64) {
        let mean = self.mean();
        assert!(
            mean.distance(Vec3::from_array(color)) < tolerance,
            "{mean}, not {color:?}"
        );
    }
}

#[test]
fn what_has_no_effect_in_mitsuba_is_told() {
    let in_sphere =
        |text: &str| format!(r#"<emitter type="constant"/><shape type="sphere">{text}</shape>"#);
    let in_bsdf =
        |plugin: &str, text: &str| in_sphere(&format!(r#"<bsdf type="{plugin}">{text}</bsdf>"#));
    let cases = [
        (in_sphere(r#"<string name="radius" value="2"/>"#), "MI005", "is no `<string>`"),
        (in_sphere(r#"<boolean name="center" value="true"/>"#), "MI005", "is no `<boolean>`"),
        (in_sphere(r#"<float name="radious" value="2"/>"#), "MI005", "`radious`"),
        (in_sphere(r#"<float name="radius" value="1"/><float name="radius" value="2"/>"#), "MI006", "given twice"),
        (in_sphere(r#"<ref id="nothing"/>"#), "MI002", "no element with the id `nothing`"),
        (in_sphere(r#"<transform name="to_world"><translate X="1"/></transform>"#), "MI005", "`X` of `<translate>`"),
        (in_sphere(r#"<transform name="to_world"><rotate x="1" y="1" angle="9"/></transform>"#), "MI006", "1.4142"),
        (in_sphere(r#"<animation name="to_world"><transform time="0"/><transform time="1"/></animation>"#), "MI004", "motion"),
        (in_bsdf("conductor", r#"<float name="alpha" value="0.1"/>"#), "MI005", "`alpha`"),
        (in_bsdf("dielectric", r#"<float name="ior" value="1.3"/>"#), "MI005", "`ior`"),
        (in_bsdf("plastic", r#"<texture type="checkerboard" name="reflectance"/>"#), "MI005", "`reflectance`"),
        (in_bsdf("diffuse", r#"<texture type="checkerboard"/>"#), "MI005", "without a name"),
        (in_bsdf("diffuse", r#"<rgb name="reflectance" value="1.5"/>"#), "MI006", "between 0 and 1"),
        (in_bsdf("plastic", r#"<float name="diffuse_reflectance" value="-1"/>"#), "MI006", "between 0 and 1"),
        (in_bsdf("diffuse", r#"<rgb name="reflectance" value="0.2"/><texture name="reflectance" type="checkerboard"/>"#), "MI006", "given twice"),
        (r#"<emitter type="constant"/><bsdf type="diffuse" id="a"/><bsdf type="diffuse" id="a"/>"#.to_owned(), "MI006", "the id `a`"),
        (r#"<emitter type="constant"/><integrator type="path"><boolean name="hide_emitters" value="true"/></integrator>"#.to_owned(), "MI004", "lights are seen"),
        (r#"<emitter type="constant"/><float name="exposure" value="1"/>"#.to_owned(), "MI005", "`exposure`"),
        (
            in_sphere(r#"<bsdf type="diffuse"/><bsdf type="plastic"/>"#),
            "MI006",
            "a second `<bsdf>`",
        ),
        (
            in_sphere(r#"<sampler type="independent"/>"#),
            "MI005",
            "`<sampler>` has no effect here",
        ),
        (
            in_bsdf("twosided", ""),
            "MI004",
            "holds no BSDF",
        ),
        (
            in_bsdf("normalmap", r#"<bsdf type="diffuse"/>"#),
            "MI004",
            "has no texture",
        ),
        (
            in_bsdf("diffuse", r#"<texture name="reflectance" type="bitmap"/>"#),
            "MI003",
            "names no file",
        ),
        (
            r#"<emitter type="envmap"/>"#.to_owned(),
            "MI003",
            "names no file",
        ),
    ];
    for (body, code, text) in cases {
        mitsuba(&body).tells(code, text);
    }
    // What says nothing is not told.
    let silent = mitsuba(
        r#"<integrator type="path"><boolean name="hide_emitters" value="false"/></integrator>
        <emitter type="constant"><spectrum type="d65" name="radiance"/></emitter>
        <bsdf type="diffuse" id="a"/><alias id="a" as="b"/><shape type="sphere"><ref id="b"/>
        <transform name="to_world"><rotate x="0.577" y="0.577" z="0.577" angle="9"/></transform></shape>"#,
    );
    assert_eq!(silent.findings, []);
}

#[test]
fn a_constant_spectrum_of_a_plugin_is_that_colour() {
    for (spectrum, color) in [
        (
            r#"<spectrum type="d65" name="radiance"><float name="scale" value="2"/></spectrum>"#,
            [2.0; 3],
        ),
        (
            r#"<spectrum type="d65" name="radiance"><rgb name="color" value="1 .5 .2"/></spectrum>"#,
            [1.0, 0.5, 0.2],
        ),
        (
            r#"<spectrum type="uniform" name="radiance"><float name="value" value="3"/></spectrum>"#,
            [3.0; 3],
        ),
        (r#"<ref id="day" name="radiance"/>"#, [4.0; 3]),
    ] {
        let found = mitsuba(&format!(
            r#"<spectrum type="d65" id="day"><float name="scale" value="4"/></spectrum>
            <emitter type="constant">{spectrum}</emitter>"#
        ));
        assert_eq!(found.findings, [], "{spectrum}");
        found.is_near(color, 1e-6);
    }
}

#[test]
fn the_direction_of_the_sun_is_one_of_the_world() {
    // The sun shines on the wall across z, however the sky is turned.
    let wall = r#"<shape type="rectangle"><transform name="to_world"><scale value="9"/></transform></shape>"#;
    let lit = |sky: &str| {
        let body = format!(
            r#"<emitter type="sun"><vector name="sun_direction" value="0 0.6 0.8"/>{sky}</emitter>{wall}"#
        );
        mitsuba(&body).mean()
    };
    // The elevation of the sun, and with it its colour, differ: the cosine at the wall does not.
    let turned = lit(r#"<transform name="to_world"><rotate x="1" angle="-90"/></transform>"#);
    let upright = lit("");
    assert!(turned.x > 0.0 && turned.z < upright.z, "{turned} {upright}");
    // Where the sun is at one height above both horizons, all is the same.
    let same = lit(r#"<transform name="to_world"><rotate z="1" angle="70"/></transform>"#);
    assert!(
        same.distance(upright) < 1e-9 * upright.length(),
        "{same} {upright}"
    );
}

#[test]
fn turned_normals_make_the_front_of_a_surface_its_back() {
    let flipped = r#"<boolean name="flip_normals" value="true"/>"#;
    let light = r#"<emitter type="area"><rgb name="radiance" value="1"/></emitter>"#;
    let around = r#"<emitter type="constant"/>"#;
    let wide = r#"<transform name="to_world"><scale value="2"/></transform>"#;
    let big = |plugin: &str| {
        format!(
            r#"<shape type="{plugin}">{flipped}<transform name="to_world"><scale value="20"/></transform>"#
        )
    };
    let cases = [
        // From outside a flipped light and a flipped matte surface are black.
        (
            format!(
                r#"<shape type="sphere">{flipped}<float name="radius" value="2"/>{light}</shape>"#
            ),
            0.0,
        ),
        (
            format!(
                r#"{around}<shape type="sphere">{flipped}<float name="radius" value="2"/></shape>"#
            ),
            0.0,
        ),
        (
            format!(r#"{around}<shape type="cube">{flipped}</shape>"#),
            0.0,
        ),
        (
            format!(r#"{around}<shape type="disk">{flipped}{wide}</shape>"#),
            0.0,
        ),
        (
            format!(r#"{around}<shape type="rectangle">{flipped}</shape>"#),
            0.0,
        ),
        (
            format!(r#"<shape type="rectangle">{flipped}{light}</shape>"#),
            0.0,
        ),
        // From inside they are seen.
        (format!("{}{light}</shape>", big("sphere")), 1.0),
        // What has two sides has them still.
        (
            format!(
                r#"{around}<shape type="rectangle">{flipped}<bsdf type="twosided"><bsdf type="diffuse"/></bsdf></shape>"#
            ),
            0.5,
        ),
    ];
    for (body, known) in cases {
        let found = mitsuba(&body);
        assert_eq!(found.findings, [], "{body}");
        found.is_near([known; 3], 1e-6);
    }
    // The back of a curved light that is no sphere cannot be covered.
    mitsuba(&format!("{}{light}</shape>", big("cube"))).tells("MI004", "both sides");
}

#[test]
fn a_rotation_about_an_axis_of_another_length_is_that_of_mitsuba() {
    let found = mitsuba(
        r#"<shape type="cube"><transform name="to_world"><rotate x="1" y="1" angle="33"/></transform></shape>"#,
    );
    let Shape::Instance(instance) = &found.scene.unwrap().surfaces[0].shape else {
        panic!("no instance")
    };
    let [x, y, z, _] = instance.world_from_object.map(Vec3::from_array);
    let determinant = x.cross(y).dot(z);
    assert!((determinant - 1.506).abs() < 1e-3, "{determinant}");
    // Version 0 normalizes it.
    let old = r#"<scene version="0.6.0"><sensor type="perspective"/><emitter type="constant"/><shape type="cube">
        <transform name="toWorld"><rotate x="1" y="1" angle="33"/></transform></shape></scene>"#;
    assert_eq!(outcome(&[("a.xml", old.as_bytes())]).findings, []);
}

#[test]
fn what_a_clip_plane_would_hide_is_told_where_it_is_in_the_view() {
    let with = |clip: &str, body: &str| {
        let sensor = SENSOR.replace("<float name=\"fov\"", &format!("{clip}<float name=\"fov\""));
        let text =
            format!(r#"<scene version="3.0.0">{sensor}<emitter type="constant"/>{body}</scene>"#);
        outcome(&[("a.xml", text.as_bytes())])
    };
    let near = |depth: f64| format!(r#"<float name="near_clip" value="{depth}"/>"#);
    let far = |depth: f64| format!(r#"<float name="far_clip" value="{depth}"/>"#);
    let sphere = r#"<shape type="sphere"/>"#;
    with(&near(9.5), sphere).tells("MI004", "nearer than `near_clip`");
    with(&far(9.5), sphere).tells("MI004", "farther than `far_clip`");
    // A wall that passes the eye on both sides is cut, one beside the view is not.
    let wall = |x: f64| {
        format!(
            r#"<shape type="rectangle"><transform name="to_world"><scale value="50"/><rotate y="1" angle="90"/>
        <translate x="{x}"/></transform></shape>"#
        )
    };
    with(&near(0.5), &wall(0.02)).tells("MI004", "nearer");
    for (clip, body) in [
        (near(8.9), sphere.to_owned()),
        (far(11.1), sphere.to_owned()),
        (near(0.5), wall(3.0)),
    ] {
        assert_eq!(with(&clip, &body).findings, [], "{clip} {body}");
    }
}

/// A PNG of one colour.
fn png(size: [u32; 2], color: [u8; 3]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, size[0], size[1]);
    encoder.set_color(png::ColorType::Rgb);
    let mut writer = encoder.write_header().unwrap();
    let pixels = color.repeat((size[0] * size[1]) as usize);
    writer.write_image_data(&pixels).unwrap();
    writer.finish().unwrap();
    bytes
}

#[test]
fn a_picture_of_8_bits_lights_a_scene_by_its_linear_values() {
    let sky = png([4, 2], [255, 188, 0]);
    // 188 of 255 is half of the light: ((188/255 + 0.055)/1.055)^2.4.
    let known = [1.0, ((188.0 / 255.0 + 0.055_f64) / 1.055).powf(2.4), 0.0];
    let files = [("sky.png", sky.as_slice())];
    let body = r#"<emitter type="envmap"><string name="filename" value="sky.png"/></emitter>"#;
    let found = mitsuba_with(body, &files);
    assert_eq!(found.findings, []);
    assert_eq!(found.scene.as_ref().unwrap().images[0].kind, Pixels::Rgb32f);
    found.is_near(known, 1e-6);
    let text = PBRT.replace("\"rgb L\" [1 1 1]", "\"string filename\" \"sky.png\"");
    let found = outcome(&[&[("a.pbrt", text.as_bytes())], &files[..]].concat());
    found.is_near(known, 1e-6);
}

#[test]
fn what_has_no_effect_in_pbrt_is_told() {
    let cases = [
        (
            "Shape \"sphere\" \"string radius\" \"2\"",
            "PB005",
            "is no `string`",
        ),
        (
            "Shape \"sphere\" \"bool radius\" true",
            "PB005",
            "is no `bool`",
        ),
        ("Shape \"sphere\" \"float radious\" 2", "PB005", "`radious`"),
        (
            "Material \"diffuse\" \"string reflectance\" \"red\"",
            "PB005",
            "is no `string`",
        ),
        (
            "Material \"dielectric\" \"string eta\" \"glass-BK7\"",
            "PB005",
            "is no `string`",
        ),
        (
            "Material \"conductor\" \"string reflectance\" \"red\"",
            "PB005",
            "is no `string`",
        ),
        (
            "Shape \"sphere\" \"float radius\" 1 \"float radius\" 2",
            "PB006",
            "given twice",
        ),
        (
            "Camera \"perspective\" \"float fov\" 40",
            "PB006",
            "`Camera` has no effect",
        ),
        (
            "Film \"rgb\" \"integer xresolution\" 9",
            "PB006",
            "`Film` has no effect",
        ),
        (
            "Option \"bool forcediffuse\" true",
            "PB005",
            "`forcediffuse`",
        ),
        (
            "Attribute \"shape\" \"float radious\" 2",
            "PB005",
            "`radious`",
        ),
        ("Attribute \"camera\" \"float fov\" 2", "PB005", "`camera`"),
    ];
    for (body, code, text) in cases {
        pbrt(body).tells(code, text);
    }
    // A default that a plugin does not have is one of others.
    let silent = pbrt(
        "Attribute \"shape\" \"float radius\" 2\nShape \"sphere\"\nShape \"trianglemesh\" \
         \"integer indices\" [0 1 2] \"point3 P\" [0 0 0 1 0 0 0 1 0]\nOption \"integer seed\" 7\nAttribute \"light\" \"bool twosided\" true",
    );
    assert_eq!(silent.findings, []);
    let early = PBRT.replace("WorldBegin\n", "Shape \"sphere\"\nWorldBegin\n");
    outcome(&[("a.pbrt", early.as_bytes())]).tells("PB006", "before `WorldBegin`");
    let film = PBRT.replace(
        "Film \"rgb\"",
        "Film \"rgb\" \"float maxcomponentvalue\" 0.5",
    );
    outcome(&[("a.pbrt", film.as_bytes())]).tells("PB004", "`maxcomponentvalue`");
}

#[test]
fn what_pbrt_goes_on_after_is_read_with_a_warning() {
    let red = "Material \"diffuse\" \"rgb reflectance\" [0.8 0.2 0.1]\n";
    let sphere = "Shape \"sphere\" \"float radius\" 2\n";
    let cases = [
        // The material before stays.
        (
            format!("{red}NamedMaterial \"nope\"\n{sphere}"),
            "there is no material `nope`",
            [0.8, 0.2, 0.1],
        ),
        (
            format!("Material \"mix\" \"string materials\" [\"a\" \"b\"]\n{sphere}"),
            "there is no material",
            [0.5; 3],
        ),
        (
            format!("Material \"diffuse\" \"texture reflectance\" \"t\"\n{sphere}"),
            "there is no texture `t`",
            [0.5; 3],
        ),
        (
            format!("{red}ObjectInstance \"o\"\n{sphere}"),
            "there is no object `o`",
            [0.8, 0.2, 0.1],
        ),
        (
            format!("{red}CoordSysTransform \"c\"\n{sphere}"),
            "there is no coordinate system `c`",
            [0.8, 0.2, 0.1],
        ),
        (
            format!("{red}ConcatTransform [1 0 0 0 0 1 0 0 0 0 1 8.87 0 0 0 1]\n{sphere}"),
            "is not affine",
            [0.8, 0.2, 0.1],
        ),
        (
            format!("{red}AttributeBegin\n{sphere}"),
            "`AttributeBegin` is not closed",
            [0.8, 0.2, 0.1],
        ),
        (
            format!("{red}{sphere}AttributeEnd\n"),
            "`AttributeEnd` ends nothing",
            [0.8, 0.2, 0.1],
        ),
        (
            format!("{red}{sphere}Include \"parts/a.pbrt\"\n"),
            "there is no file `parts/a.pbrt`",
            [0.8, 0.2, 0.1],
        ),
    ];
    for (body, text, color) in cases {
        let found = pbrt(&body);
        assert!(!found.has_errors, "{body}: {:?}", found.findings);
        let is_told = found
            .findings
            .iter()
            .any(|(_, message)| message.contains(text));
        assert!(is_told, "{body}: {:?}", found.findings);
        found.is_near(color, 1e-6);
    }
    // Blocks that end each other.
    let found = pbrt(&format!(
        "{red}ObjectBegin \"a\"\nAttributeBegin\n{sphere}ObjectEnd\nAttributeEnd\nObjectInstance \"a\"\n"
    ));
    assert!(
        !found.has_errors && found.findings.len() == 2,
        "{:?}",
        found.findings
    );
    found.is_near([0.8, 0.2, 0.1], 1e-6);
    // A file that includes itself has no end, and is refused.
    assert!(pbrt("Include \"a.pbrt\"").has_errors);
    // The last of two values counts, as in pbrt.
    let found = pbrt(&format!(
        "{red}Shape \"sphere\" \"float radius\" 0.01 \"float radius\" 2"
    ));
    found.is_near([0.8, 0.2, 0.1], 1e-6);
}

/// Asserts that work grows no faster than what it is done for.
fn assert_linear(what: &str, work: impl Fn(usize) -> u64) {
    let [one, two, four] = [50, 100, 200].map(work);
    let (first, second) = (two.saturating_sub(one), four.saturating_sub(two));
    assert!(
        second <= 2 * first + first / 4 + 16,
        "{what}: {one}, {two}, {four}"
    );
}

#[test]
fn work_grows_with_the_text_of_a_scene() {
    let numbered =
        |count: usize, line: &dyn Fn(usize) -> String| (0..count).map(line).collect::<String>();
    // Each BSDF is lowered once, however often others refer to it.
    let blends = |count: usize| {
        let blend = |n: usize| {
            format!(
                r#"<bsdf type="blendbsdf" id="b{}"><ref id="b{n}"/><ref id="b{n}"/></bsdf>
                <shape type="sphere"><ref id="b{n}"/></shape>"#,
                n + 1
            )
        };
        mitsuba(&(r#"<bsdf type="diffuse" id="b0"/>"#.to_owned() + &numbered(count, &blend)))
    };
    assert_linear("materials of blends", |count| {
        blends(count).scene.unwrap().materials.len() as u64
    });
    assert_linear("findings of blends", |count| {
        blends(count).findings.len() as u64
    });
    assert_linear("other names", |count| {
        mitsuba(
            &(r#"<bsdf type="diffuse" id="a"/>"#.to_owned()
                + &r#"<bsdf type="diffuse"/>"#.repeat(count)
                + &numbered(count, &|n| format!(r#"<alias id="a" as="a{n}"/>"#))),
        )
        .work
    });
    // Files that are not there are looked for once in each folder.
    assert_linear("folders", |count| {
        mitsuba(
            &(r#"<path value="p"/>"#.repeat(8)
                + &numbered(count, &|n| {
                    format!(
                        r#"<shape type="obj"><string name="filename" value="{n}.obj"/></shape>"#
                    )
                })),
        )
        .work
    });
    assert_linear("defaults of shapes", |count| {
        pbrt(&format!(
            "Attribute \"shape\" {}\n{}",
            numbered(count, &|n| format!("\"float a{n}\" 1 ")),
            "Shape \"sphere\"\n".repeat(count)
        ))
        .work
    });
    // Comments are work, each time they are passed.
    let comments = |count: usize| {
        let scene = format!("{PBRT}{}", "Include \"part.pbrt\"\n".repeat(count));
        let part = "#\n".repeat(8000);
        outcome(&[("a.pbrt", scene.as_bytes()), ("part.pbrt", part.as_bytes())]).work
    };
    assert_linear("comments", comments);
    assert!(comments(50) >= 49 * 4000, "{}", comments(50));
}

#[test]
fn what_the_parser_of_xml_compares_in_pairs_is_bounded() {
    let attributes = |count: usize| {
        (0..count)
            .map(|n| format!(" a{n}=\"\""))
            .collect::<String>()
    };
    let namespaces = |count: usize| "<bsdf xmlns:b=\"c\"/>".repeat(count);
    for text in [format!("<bsdf{}/>", attributes(65)), namespaces(65)] {
        mitsuba(&text).tells("MI001", "more than 64");
    }
    assert!(!mitsuba(&namespaces(64)).has_errors);
    // A transform in itself does not fill the stack.
    let deep = "<transform>".repeat(20_000) + &"</transform>".repeat(20_000);
    let found = mitsuba(&format!(
        r#"<shape type="sphere"><transform name="to_world">{deep}</transform></shape>"#
    ));
    assert!(found.has_errors);
}
