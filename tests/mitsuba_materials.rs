//! Materials and skies of Mitsuba's scenes, by what is read and by the light that they show.

use crate::mitsuba::{picture, read};
use rtc::internals::ir::{Map, Material, Pixels, Scene, Texture};
use rtc::internals::math::{Microfacets, Plastic};
use std::fs;

#[test]
fn plastics_and_facets_are_read_without_a_warning() {
    let material = |bsdf: &str| {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("scene.xml");
        let head = r#"<scene version="3.0.0"><sensor type="perspective"/>"#;
        let text = format!(r#"{head}<shape type="sphere">{bsdf}</shape></scene>"#);
        fs::write(&path, text).unwrap();
        let (scene, codes) = read(&path);
        assert_eq!(codes, Vec::<&str>::new(), "{bsdf}");
        match &scene.materials[0] {
            Material::Standard(standard) => (**standard).clone(),
            Material::Phong(phong) => panic!("{phong:?}"),
        }
    };
    let plastics = [
        (r#"<bsdf type="plastic"/>"#, Plastic::Linear),
        (
            r#"<bsdf type="roughplastic"><boolean name="nonlinear" value="true"/></bsdf>"#,
            Plastic::Nonlinear,
        ),
        (r#"<bsdf type="pplastic"/>"#, Plastic::Single),
    ];
    for (bsdf, plastic) in plastics {
        let one = material(bsdf);
        assert_eq!((one.plastic, one.black_back), (plastic, true), "{bsdf}");
        let both = material(&format!(r#"<bsdf type="twosided">{bsdf}</bsdf>"#));
        assert!(!both.black_back, "{bsdf}");
    }
    // The lesser width is 0.05; along v it is 0.3 = 0.05 + 0.95·strength².
    let brushed = material(
        r#"<bsdf type="roughconductor"><float name="alpha_u" value="0.05"/>
        <float name="alpha_v" value="0.3"/></bsdf>"#,
    );
    assert_eq!(brushed.microfacets, Microfacets::Beckmann);
    assert!((brushed.roughness.powi(2) - 0.05).abs() < 1e-12);
    assert!((0.05 + 0.95 * brushed.anisotropy.powi(2) - 0.3).abs() < 1e-12);
    assert_eq!(brushed.anisotropy_rotation, std::f64::consts::FRAC_PI_2);
    // Of light without polarization a polarizer lets half through.
    let filter = material(r#"<bsdf type="polarizer"/>"#);
    assert_eq!((filter.base_color, filter.ior), ([0.5, 0.5, 0.5, 1.0], 1.0));
}

#[test]
fn a_mask_covers_by_the_luminance_of_its_texture() {
    // Squares of white and red: the card covers all of one half and 0.2126 of the other.
    let pixels = picture(
        r#"<emitter type="constant"/>
        <shape type="rectangle">
            <transform name="to_world"><scale value="0.6"/></transform>
            <bsdf type="mask">
                <texture name="opacity" type="checkerboard">
                    <rgb name="color0" value="1"/><rgb name="color1" value="1 0 0"/>
                    <transform name="to_uv"><scale y="0.5"/></transform>
                </texture>
                <bsdf type="diffuse"><rgb name="reflectance" value="0"/></bsdf>
            </bsdf>
        </shape>"#,
    );
    let at = |x: usize| pixels[8 * 4 + x][1];
    assert!(at(2) < 0.02, "{}", at(2));
    assert!((at(5) - (1.0 - 0.2126)).abs() < 0.15, "{}", at(5));
}

#[test]
fn a_blend_reflects_the_mean_of_its_materials() {
    // In a white furnace a blend of blends shows the sum of the reflectances by the weights.
    let diffuse = |value: f64| {
        format!(r#"<bsdf type="diffuse"><rgb name="reflectance" value="{value}"/></bsdf>"#)
    };
    let blend = |weight: &str, first: &str, second: &str| {
        format!(r#"<bsdf type="blendbsdf">{weight}{first}{second}</bsdf>"#)
    };
    let (weight, quarter) = (
        r#"<texture name="weight" type="checkerboard"><rgb name="color0" value="0.25"/>
        <rgb name="color1" value="0.25"/></texture>"#,
        r#"<float name="weight" value="0.25"/>"#,
    );
    let (low, high) = (diffuse(0.2), diffuse(0.8));
    let in_second = blend(
        weight,
        &low,
        &blend(quarter, &high, r#"<bsdf type="null"/>"#),
    );
    let in_first = blend(
        weight,
        &blend(quarter, &high, r#"<bsdf type="null"/>"#),
        &low,
    );
    for (bsdf, known) in [
        (blend(quarter, &low, &high), 0.35),
        // A part lets the light behind it through.
        (in_second, 0.75 * 0.2 + 0.25 * (0.75 * 0.8 + 0.25)),
        (in_first, 0.25 * 0.2 + 0.75 * (0.75 * 0.8 + 0.25)),
    ] {
        let pixels = picture(&format!(
            r#"<emitter type="constant"/><shape type="rectangle">
            <transform name="to_world"><scale value="4"/></transform>{bsdf}</shape>"#
        ));
        let mean = pixels.iter().map(|pixel| pixel[1]).sum::<f64>() / 64.0;
        assert!((mean - known).abs() < 0.02, "{mean}, not {known}: {bsdf}");
    }
}

#[test]
fn raw_colours_are_linear_and_textures_of_numbers_keep_their_channel() {
    let material = |bsdf: &str| {
        let folder = tempfile::tempdir().unwrap();
        // One texel of (128, 128, 128), as a PNM.
        let texel = [&b"P6 1 1 255\n"[..], &[128; 3]].concat();
        fs::write(folder.path().join("a.ppm"), texel).unwrap();
        let path = folder.path().join("scene.xml");
        let head = r#"<scene version="3.0.0"><sensor type="perspective"/>"#;
        let text = format!(r#"{head}<shape type="sphere">{bsdf}</shape></scene>"#);
        fs::write(&path, text).unwrap();
        read(&path).0
    };
    let bitmap = |name: &str| {
        format!(
            r#"<texture name="{name}" type="bitmap"><string name="filename" value="a.ppm"/>
            <boolean name="raw" value="true"/></texture>"#
        )
    };
    let floats = |scene: &Scene, map: &Map| {
        let Texture::Sampled(sampled) = &scene.textures[map.texture.0 as usize] else {
            panic!("{map:?}");
        };
        let image = &scene.images[sampled.image.0 as usize];
        let (floats, _) = image.pixels.as_chunks();
        (
            image.kind,
            floats
                .iter()
                .map(|bytes| f32::from_le_bytes(*bytes))
                .collect::<Vec<_>>(),
        )
    };
    let standard = |scene: &Scene| match &scene.materials[0] {
        Material::Standard(standard) => (**standard).clone(),
        Material::Phong(phong) => panic!("{phong:?}"),
    };
    let scene = material(&format!(
        r#"<bsdf type="diffuse">{}</bsdf>"#,
        bitmap("reflectance")
    ));
    let map = standard(&scene).base_color_map.unwrap();
    assert_eq!(
        floats(&scene, &map),
        (Pixels::Rgb32f, vec![128.0 / 255.0; 3])
    );
    // The roughness is green; red and blue are 1.
    let scene = material(&format!(
        r#"<bsdf type="principled">{}</bsdf>"#,
        bitmap("roughness")
    ));
    let map = standard(&scene).metallic_roughness_map.unwrap();
    let Texture::Sampled(sampled) = &scene.textures[map.texture.0 as usize] else {
        panic!("{map:?}");
    };
    let image = &scene.images[sampled.image.0 as usize];
    assert_eq!(
        (image.kind, &image.pixels[..]),
        (Pixels::Rgb8, &[255, 128, 255][..])
    );
}

#[test]
fn a_sky_and_its_sun_light_a_plane_as_in_mitsuba() {
    // The irradiance by `sunsky` of Mitsuba 3.9.1, and by its sun alone, for the sun at 45°.
    let (sky, sun) = ([0.1613, 0.2516, 0.4215], [1.0377, 0.8524, 0.6278]);
    let mean = |plugin: &str| {
        let pixels = picture(&format!(
            r#"<emitter type="{plugin}"><vector name="sun_direction" value="1, 0, 1"/></emitter>
            <shape type="rectangle"><transform name="to_world"><scale value="4"/></transform>
            <bsdf type="diffuse"><rgb name="reflectance" value="1"/></bsdf></shape>"#
        ));
        let sum = |channel: usize| pixels.iter().map(|pixel| pixel[channel]).sum::<f64>();
        [0, 1, 2].map(|channel| sum(channel) / 64.0 * std::f64::consts::PI)
    };
    let both: [f64; 3] = std::array::from_fn(|channel| sky[channel] + sun[channel]);
    for (plugin, known) in [("sky", sky), ("sun", sun), ("sunsky", both)] {
        for (found, known) in mean(plugin).into_iter().zip(known) {
            assert!(
                (found / known - 1.0).abs() < 0.02,
                "{plugin}: {found}, not {known}"
            );
        }
    }
}

#[test]
fn a_pane_reflects_between_its_faces() {
    // Seen along the normal a face reflects R = 0.04 and a pane 2R/(1 + R) of the emitter behind
    // the viewer; the rest of the light comes through.
    let seen = |bsdf: &str| {
        let pixels = picture(&format!(
            r#"<shape type="rectangle"><transform name="to_world"><scale value="4"/>
            </transform><bsdf type="{bsdf}"><float name="int_ior" value="1.5"/>
            <float name="ext_ior" value="1"/></bsdf></shape>
            <shape type="rectangle"><transform name="to_world"><scale value="40"/>
            <translate z="-5"/></transform><bsdf type="diffuse"><rgb name="reflectance" value="0"/>
            </bsdf><emitter type="area"/></shape>"#
        ));
        pixels.iter().map(|pixel| pixel[1]).sum::<f64>() / 64.0
    };
    let (face, expected) = (0.04, 1.0 - 2.0 * 0.04 / 1.04);
    let pane = seen("thindielectric");
    assert!((pane - expected).abs() < 0.02, "{pane}, not {expected}");
    assert!(pane < 1.0 - face - 0.01);
}
