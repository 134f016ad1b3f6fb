//! What small assets of our own become: their IR beside the last one approved, and what is the same
//! however it is stored.

use super::make;
use rtc::internals::codec::{self, Encoding};
use rtc::internals::diag::{Diagnostic, DiagnosticSink, Severity};
use rtc::internals::front;
use rtc::internals::ir::{
    Environment, Light, LoweredScene, Material, PunctualKind, Scene, Shape, SourceSpans,
};
use rtc::internals::math::Vec3;
use rtc::internals::passes::{Framing, Overrides};
use rtc::internals::pipeline::{self, Options};
use rtc::internals::plan::{Plan, RuleSet};
use rtc::internals::render::RenderSelection;
use rtc::internals::source::{Loader, SourceMap};

/// The scene that an asset shows; every asset here is sound, and some have lines or no tangents.
fn lower(bytes: Vec<u8>, front: front::FrontOptions) -> Scene {
    let (mut map, mut sink) = (SourceMap::default(), DiagnosticSink::default());
    let file = map.add("made.gltf", bytes);
    let options = Options {
        front,
        ..Options::default()
    };
    let lowered = pipeline::load(file, &mut map, &options, &mut sink);
    let validated = lowered
        .as_ref()
        .and_then(|lowered| pipeline::validate(lowered, &options, &mut sink));
    let is_small =
        |finding: &Diagnostic| finding.severity == Severity::Note || finding.code.id == "GL034";
    assert!(
        validated.is_some() && sink.kept().iter().all(is_small),
        "{sink:#?}"
    );
    lowered.unwrap().scene
}

fn text(scene: &Scene) -> String {
    String::from_utf8(codec::encode(Encoding::Json, scene).unwrap()).unwrap()
}

#[test]
fn small_assets_become_what_was_approved() {
    let glass = front::FrontOptions {
        variant: Some("glass".to_owned()),
        ..front::FrontOptions::default()
    };
    let moved = front::FrontOptions {
        time: Some(1.0),
        animation: Some("move".to_owned()),
        ..front::FrontOptions::default()
    };
    let cases = [
        ("topology", make::topology(), front::FrontOptions::default()),
        (
            "hierarchy",
            make::hierarchy(),
            front::FrontOptions::default(),
        ),
        (
            "attributes",
            make::attributes(),
            front::FrontOptions::default(),
        ),
        ("motion", make::motion(), moved),
        ("stage", make::stage(), glass),
        ("texture", make::texture(), front::FrontOptions::default()),
    ];
    for (name, bytes, options) in cases {
        insta::assert_snapshot!(name, text(&lower(bytes, options)));
    }
}

#[test]
fn at_rest_nothing_moves_and_the_first_material_counts() {
    let rest = lower(make::motion(), front::FrontOptions::default());
    assert_eq!(
        rest.meshes[0].positions.at(0),
        [0.0, 0.0, 0.25],
        "the weight of the mesh itself"
    );
    assert_eq!(rest.meshes[1].positions.at(1), [1.0, 0.0, 0.0]);
    assert!(text(&lower(make::stage(), front::FrontOptions::default())).contains("glowing"));
}

#[test]
fn what_is_asked_for_and_not_there_is_an_error_with_its_code() {
    let asked = [
        front::FrontOptions {
            animation: Some("fly".to_owned()),
            ..front::FrontOptions::default()
        },
        front::FrontOptions {
            variant: Some("gold".to_owned()),
            ..front::FrontOptions::default()
        },
    ];
    for front in asked {
        let (mut map, mut sink) = (SourceMap::default(), DiagnosticSink::default());
        let file = map.add("made.gltf", make::stage());
        let options = Options {
            front,
            ..Options::default()
        };
        assert!(pipeline::load(file, &mut map, &options, &mut sink).is_none());
        assert!(
            sink.kept().iter().any(|finding| finding.code.id == "GL048"),
            "{sink:?}"
        );
    }
}

#[test]
fn mended_assets_show_the_triangle_that_was_meant() {
    let cases = [
        "GL001/json-lenient.glb",
        "GL002/unaligned-lenient.glb",
        "GL002/padded-lenient.glb",
        "GL004/bom-lenient.gltf",
        "GL005/same-lenient.gltf",
        "GL009/arrays-lenient.gltf",
        "GL010/stride-lenient.gltf",
        "GL012/channels-lenient.gltf",
        "GL013/offset-lenient.gltf",
        "GL019/undeclared-lenient.gltf",
        "GL021/media-lenient.gltf",
        "GL021/space-lenient.gltf",
        "GL025/target-lenient.gltf",
        "GL026/unaligned-lenient.gltf",
        "GL028/unused-lenient.gltf",
        "GL031/no-bounds-lenient.gltf",
        "GL037/root-with-parent-lenient.gltf",
        "GL042/jpg-lenient.gltf",
    ];
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/diagnostics");
    for case in cases {
        let (mut map, mut sink) = (SourceMap::default(), DiagnosticSink::default());
        let file = Loader.file(&folder.join(case), &mut map).unwrap();
        let front = front::FrontOptions {
            lenient: true,
            ..front::FrontOptions::default()
        };
        let options = Options {
            front,
            ..Options::default()
        };
        let lowered = pipeline::load(file, &mut map, &options, &mut sink);
        let proof = lowered
            .as_ref()
            .and_then(|lowered| pipeline::validate(lowered, &options, &mut sink));
        assert!(proof.is_some(), "{case}: {:?}", sink.kept());
        let scene = &lowered.unwrap().scene;
        let ([mesh], [surface]) = (&scene.meshes[..], &scene.surfaces[..]) else {
            panic!("{case}: one surface of one mesh, and not {scene:?}");
        };
        let corners: Vec<[f64; 3]> = (0..mesh.positions.len())
            .map(|at| mesh.positions.at(at))
            .collect();
        let meant = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        assert_eq!(corners, meant, "{case}");
        assert_eq!(mesh.triangles.len(), 1, "{case}");
        let Shape::Instance(instance) = &surface.shape else {
            panic!("{case}: an instance");
        };
        let moved = f64::from(u8::from(case.starts_with("GL037")));
        assert_eq!(instance.world_from_object[3][0], moved, "{case}");
    }
}

#[test]
fn of_levels_of_detail_the_finest_is_shown() {
    for has_scene in [true, false] {
        let scene = lower(make::levels(has_scene), front::FrontOptions::default());
        assert_eq!(scene.names, ["fine"], "with a scene: {has_scene}");
    }
}

#[test]
fn a_mesh_has_the_sets_of_texture_coordinates_that_its_material_looks_at() {
    for sets @ [color, emissive] in [[0, 1], [3, 2], [0, 3], [2, 2]] {
        let scene = lower(make::sets(sets), front::FrontOptions::default());
        for (surface, asked) in scene.surfaces.iter().zip([vec![color, emissive], vec![0]]) {
            let Shape::Instance(instance) = &surface.shape else {
                panic!("an instance");
            };
            let mesh = &scene.meshes[instance.mesh.0 as usize];
            let Material::Standard(material) = &scene.materials[surface.material.0 as usize] else {
                panic!("a material of glTF");
            };
            let found = material.maps().map(|map| match map.set {
                0 => mesh.uvs.at(0)[0],
                _ => mesh.second_uvs.at(0)[0],
            });
            let asked: Vec<f64> = asked.into_iter().map(f64::from).collect();
            assert_eq!(found.collect::<Vec<_>>(), asked, "{sets:?}");
        }
    }
}

#[test]
fn pointers_move_materials_lights_cameras_and_nodes() {
    let at = |time| {
        let front = front::FrontOptions {
            time,
            ..front::FrontOptions::default()
        };
        let scene = lower(make::pointers(), front);
        let Shape::Instance(instance) = &scene.surfaces[0].shape else {
            panic!("an instance");
        };
        let Material::Standard(material) = &scene.materials[0] else {
            panic!("a material of glTF");
        };
        let Light::Punctual(light) = &scene.lights[0] else {
            panic!("a spot");
        };
        let PunctualKind::Spot { outer_angle, .. } = light.emitter else {
            panic!("a spot");
        };
        let own = [instance.world_from_object[3][0], material.clearcoat];
        let factors = [material.metallic, material.emissive[0], light.intensity[0]];
        let opening = scene.camera.up[1] * f64::from(scene.camera.size[1]) / 2.0;
        (own, factors, material.base_color, opening, outer_angle)
    };
    let (own, factors, color, opening, angle) = at(None);
    assert_eq!(
        (own, factors, color),
        ([0.0, 0.0], [0.25, 0.0, 1.0], [1.0; 4])
    );
    assert!((opening - 0.5_f64.tan()).abs() < 1e-12, "{opening}");
    assert!((angle - std::f64::consts::FRAC_PI_4).abs() < 1e-12);
    // In the middle the clearcoat would be 1.5, which is kept in its range.
    let (own, factors, color, opening, angle) = at(Some(1.0));
    assert_eq!((own, factors), ([2.0, 1.0], [0.25, 0.5, 4.0]));
    assert_eq!(color, [0.5, 0.25, 0.0, 1.0]);
    assert!((opening - 0.75_f64.tan()).abs() < 1e-12, "{opening}");
    assert!((angle - 0.6).abs() < 1e-7, "{angle}");
}

#[test]
fn points_have_the_radius_of_their_density_whatever_their_node_does() {
    // Half the opening of the camera that is chosen where an asset has none.
    let half = 17.5_f64.to_radians();
    // From the ball about -3 to 3, at 512 pixels.
    let pixel = 2.0 * 3.0 / (512.0 * half.cos());
    for (count, corners, radius) in [(4, 6, 3.0 / 64.0), (u16::MAX, 4, pixel)] {
        let scene = lower(make::cloud(count), front::FrontOptions::default());
        let ([mesh], [surface]) = (&scene.meshes[..], &scene.surfaces[..]) else {
            panic!("one mesh, and not {}", scene.meshes.len());
        };
        assert_eq!(mesh.positions.len(), corners * usize::from(count));
        let Shape::Instance(instance) = &surface.shape else {
            panic!("an instance");
        };
        assert_eq!(instance.world_from_object[3], [-3.0, 0.0, 0.0]);
        let first = Vec3::from_array(mesh.positions.at(0));
        assert!((first.length() - radius).abs() < 1e-6 * radius, "{first}");
    }
    // By request.
    let front = front::FrontOptions {
        point_size: Some(9.0),
        ..front::FrontOptions::default()
    };
    let first = Vec3::from_array(lower(make::cloud(4), front).meshes[0].positions.at(0));
    assert!(
        (first.length() - 4.5 * pixel).abs() < 1e-6 * pixel,
        "{first}"
    );
}

#[test]
fn splats_are_ellipsoids_and_their_loss_is_told() {
    let (mut map, mut sink) = (SourceMap::default(), DiagnosticSink::default());
    let file = map.add("made.gltf", make::splats());
    let lowered = pipeline::load(file, &mut map, &Options::default(), &mut sink);
    let told: Vec<_> = sink
        .kept()
        .iter()
        .map(|finding| &*finding.message)
        .collect();
    assert!(
        told.len() == 1 && told[0].contains("opaque ellipsoids"),
        "{told:?}"
    );
    let scene = lowered.unwrap().scene;
    let [mesh] = &scene.meshes[..] else {
        panic!("one mesh, and not {}", scene.meshes.len());
    };
    let Material::Standard(material) = &scene.materials[0] else {
        panic!("a material of glTF");
    };
    // Two nodes show it; of three splats one is too faint.
    assert_eq!((scene.surfaces.len(), mesh.triangles.len()), (2, 2 * 80));
    assert!(material.unlit);
    let [red, green] = [0, 42].map(|at| mesh.colors.at(at));
    assert!(red[0] > 0.9 && red[1] < 0.01 && green[1] > 0.9 && green[0] < 0.01);
}

#[test]
fn a_mesh_used_twice_is_made_once() {
    let scene = lower(make::hierarchy(), front::FrontOptions::default());
    assert_eq!(
        (scene.meshes.len(), scene.surfaces.len()),
        (1, 4),
        "two nodes and two instances of one mesh"
    );
    assert!(
        scene
            .surfaces
            .iter()
            .all(|surface| matches!(surface.shape, Shape::Instance(_)))
    );
}

/// A few pixels of what a scene shows, to the bit.
fn picture(mut scene: Scene) -> Vec<[u64; 3]> {
    Overrides {
        size: Some([24, 24]),
        spp: Some(4),
        ..Overrides::default()
    }
    .apply(&mut scene);
    let lowered = LoweredScene {
        scene,
        source_spans: SourceSpans::default(),
    };
    let (options, mut sink) = (Options::default(), DiagnosticSink::default());
    let validated = pipeline::validate(&lowered, &options, &mut sink).unwrap();
    let plan = Plan::new(&validated, RuleSet::ALL);
    let film = pipeline::render(&validated, &plan, &RenderSelection::default(), 1, &|_| true)
        .unwrap()
        .unwrap();
    film.image
        .pixels
        .iter()
        .map(|pixel| pixel.map(f64::to_bits))
        .collect()
}

#[test]
fn assets_make_the_same_picture_from_either_form_of_the_ir() {
    let moved = front::FrontOptions {
        time: Some(1.0),
        animation: Some("move".to_owned()),
        ..front::FrontOptions::default()
    };
    let cases = [
        (make::hierarchy(), front::FrontOptions::default()),
        (make::attributes(), front::FrontOptions::default()),
        (make::motion(), moved),
        (make::texture(), front::FrontOptions::default()),
    ];
    let (mut names, mut images, mut surroundings) = (0, 0, 0);
    for (bytes, options) in cases {
        let mut scene = lower(bytes, options);
        let sky = Environment {
            radiance: [1.0; 3],
            image: None,
            image_from_world: None,
        };
        scene.environment.get_or_insert(sky);
        names += scene.names.len();
        images += scene.images.len();
        surroundings += usize::from(scene.environment.is_some());
        let expected = picture(scene.clone());
        assert!(
            expected.iter().any(|pixel| *pixel != expected[0]),
            "something shows"
        );
        for encoding in [Encoding::Json, Encoding::Binary] {
            let back = lower(
                codec::encode(encoding, &scene).unwrap(),
                front::FrontOptions::default(),
            );
            assert_eq!(format!("{back:?}"), format!("{scene:?}"), "{encoding:?}");
            assert!(picture(back) == expected, "{encoding:?}");
        }
    }
    assert!(
        names > 0 && images > 0 && surroundings > 0,
        "names, images and surroundings are met"
    );
}

/// Without a camera the ball around all of it just fits into 35° from bottom to top.
#[test]
fn a_camera_that_is_not_there_sees_all_of_it() {
    let scene = lower(make::texture(), front::FrontOptions::default());
    let [eye, up] = [scene.camera.eye, scene.camera.up].map(Vec3::from_array);
    let ball = scene.bounding_sphere().unwrap();
    let half = (up.length() * f64::from(scene.camera.size[1]) / 2.0).atan();
    assert!((half.to_degrees() - 17.5).abs() < 1e-9, "{half}");
    assert!(((ball.radius / eye.distance(ball.center)).asin() - half).abs() < 1e-9);
    assert!(
        eye.x > ball.center.x && eye.y > ball.center.y && eye.z > ball.center.z,
        "a three-quarter view"
    );
}

#[test]
fn instances_are_as_many_as_any_attribute_has() {
    let asset = include_bytes!("../cli/models/instancing-id-only-vanishes.glb");
    let scene = lower(asset.to_vec(), front::FrontOptions::default());
    assert_eq!((scene.meshes.len(), scene.surfaces.len()), (1, 3));
}

#[test]
fn points_that_differ_in_where_they_are_alone_are_made_once() {
    let text = r#"{
        "asset": {"version": "2.0"},
        "scenes": [{"nodes": [0, 1, 2]}],
        "nodes": [{"mesh": 0}, {"mesh": 1, "translation": [5, 0, 0]}, {"mesh": 0, "scale": [2, 2, 2]}],
        "meshes": [
            {"primitives": [{"attributes": {"POSITION": 0}, "mode": 0}]},
            {"primitives": [{"attributes": {"POSITION": 0}, "mode": 0, "material": 0}]}
        ],
        "materials": [{}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3, "min": [0, 0, 0], "max": [1, 1, 0]}
        ],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "buffers": [
            {"byteLength": 36, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}
        ]
    }"#;
    let scene = lower(text.as_bytes().to_vec(), front::FrontOptions::default());
    let of = |surface: &rtc::internals::ir::Surface| {
        let Shape::Instance(instance) = &surface.shape else {
            panic!("points are meshes");
        };
        (instance.mesh.0, instance.world_from_object[3])
    };
    let shown: Vec<_> = scene.surfaces.iter().map(of).collect();
    assert_eq!(shown, [(0, [0.0; 3]), (0, [5.0, 0.0, 0.0]), (1, [0.0; 3])]);
}

#[test]
fn pictures_of_all_times_of_an_animation_have_one_view() {
    // The camera of a picture at a time, and where its vertices are in it, −1 to 1.
    let framed = |time: Option<f64>| {
        let (mut map, mut sink) = (SourceMap::default(), DiagnosticSink::default());
        let file = map.add("made.gltf", make::motion());
        let mut options = Options::default();
        options.front.time = time;
        let mut lowered = pipeline::load(file, &mut map, &options, &mut sink).unwrap();
        Framing::default().apply(&mut lowered.scene, &lowered.source_spans);
        let camera = lowered.scene.camera.clone();
        let [eye, center, right, up] =
            [camera.eye, camera.center, camera.right, camera.up].map(Vec3::from_array);
        let ahead = (center - eye).normalize();
        let mut reach = 0.0_f64;
        for surface in &lowered.scene.surfaces {
            let Shape::Instance(instance) = &surface.shape else {
                panic!("an instance");
            };
            let world = glam::DAffine3::from_cols_array_2d(&instance.world_from_object);
            for position in lowered.scene.meshes[instance.mesh.0 as usize]
                .positions
                .iter()
            {
                let at = world.transform_point3(Vec3::from_array(position)) - eye;
                let scale = (center - eye).length() / at.dot(ahead);
                for (step, size) in [right, up].into_iter().zip(camera.size) {
                    let along = at.dot(step) * scale / step.length_squared();
                    reach = reach.max(along.abs() / (f64::from(size) / 2.0));
                }
            }
        }
        (camera, reach)
    };
    let pictures = [0.0, 0.3, 0.5, 1.0, 7.0].map(|time| framed(Some(time)));
    for (camera, reach) in &pictures {
        assert_eq!(*camera, pictures[0].0);
        assert!(*reach < 0.9, "{reach}");
    }
    let widest = pictures.iter().map(|(_, reach)| *reach);
    assert!(widest.fold(0.0, f64::max) > 0.6);
    assert_ne!(
        framed(None).0,
        pictures[0].0,
        "at rest it is framed as it is"
    );
}

#[test]
fn a_stride_where_none_may_be_is_used_leniently() {
    let mut asset: serde_json::Value = serde_json::from_slice(&make::motion()).unwrap();
    let keyframes = asset["animations"][0]["samplers"].clone();
    for (sampler, key) in [(0, "input"), (0, "output"), (1, "output")] {
        let accessor = &asset["accessors"][keyframes[sampler][key].as_u64().unwrap() as usize];
        let stride = if accessor["type"] == "VEC4" { 16 } else { 4 };
        let view = accessor["bufferView"].as_u64().unwrap() as usize;
        asset["bufferViews"][view]["byteStride"] = stride.into();
    }
    let load = |bytes: Vec<u8>, lenient| {
        let (mut map, mut sink) = (SourceMap::default(), DiagnosticSink::default());
        let file = map.add("made.gltf", bytes);
        let front = front::FrontOptions {
            lenient,
            time: Some(1.0),
            ..front::FrontOptions::default()
        };
        let options = Options {
            front,
            ..Options::default()
        };
        let lowered = pipeline::load(file, &mut map, &options, &mut sink);
        let told = sink
            .kept()
            .iter()
            .map(|finding| (finding.code.id, finding.severity));
        (
            lowered.map(|lowered| text(&lowered.scene)),
            told.collect::<Vec<_>>(),
        )
    };
    let bytes = serde_json::to_vec(&asset).unwrap();
    let (refused, told) = load(bytes.clone(), false);
    assert!(
        refused.is_none() && told.contains(&("GL025", Severity::Error)),
        "{told:?}"
    );
    let (read, told) = load(bytes, true);
    assert!(told.contains(&("GL025", Severity::Warning)), "{told:?}");
    assert_eq!(read, load(make::motion(), false).0);
}
