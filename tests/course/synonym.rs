//! What one type of object understands its neighbours understand: types crossed with the names of
//! keys, as JSON, which is YAML too.

use super::*;
use serde_json::{Map, Value, json};

/// Names of one thing, for keys alone and in groups.
const SAME: &[&[&[&str]]] = &[
    &[
        &["position"],
        &["center"],
        &["centre"],
        &["pos"],
        &["origin"],
        &["location"],
        &["point"],
        &["O"],
    ],
    &[&["radius"], &["r"], &["R"], &["rad"]],
    &[
        &["direction"],
        &["axis"],
        &["normal"],
        &["N"],
        &["n"],
        &["dir"],
    ],
    &[&["height"], &["h"], &["length"]],
    &[
        &["p1", "p2"],
        &["point1", "point2"],
        &["center1", "center2"],
        &["end1", "end2"],
        &["p0", "p1"],
        &["a", "b"],
        &["start", "end"],
        &["bottom", "top"],
        &["base", "apex"],
    ],
    &[
        &["file"],
        &["filename"],
        &["fileName"],
        &["path"],
        &["model"],
        &["mesh"],
        &["object"],
        &["name"],
        &["src"],
        &["source"],
    ],
    &[&["scale"], &["scaleFactor"], &["scaling"]],
    &[&["rotation"], &["rotate"]],
];

/// Objects of all types that have such keys.
fn objects() -> Vec<Value> {
    let mut objects = vec![
        json!({ "type": "sphere", "position": [1, 2, 3], "radius": 4 }),
        json!({ "type": "circle", "center": [1, 2, 3], "normal": [0, 1, 2], "radius": 4 }),
        json!({ "type": "bplane", "typ": "quad", "center": [1, 2, 3], "normal": [0, 0, 2], "radius": 4 }),
        json!({ "type": "plane", "position": [1, 2, 3], "normal": [0, 1, 2] }),
        json!({ "type": "torus", "position": [1, 2, 3], "radius": 4, "alpha": 1, "direction": [0, 1, 2] }),
        json!({ "type": "box", "position": [1, 2, 3], "dimension": [4, 5, 6], "rotation": [1, 0, 0.5] }),
        json!({ "type": "cube", "position": [1, 2, 3], "side": 4, "rotation": [1, 0, 0.5] }),
        json!({ "type": "mesh", "file": "a.obj", "position": [1, 2, 3], "scale": 4, "rotation": [1, 0, 0.5] }),
        json!({ "type": "gltf", "file": "a.glb", "position": [1, 2, 3], "scale": 4, "rotation": [1, 0, 0.5] }),
    ];
    for kind in ["cylinder", "cone", "paraboloid"] {
        objects.extend([
            json!({ "type": kind, "position": [1, 2, 3], "direction": [0, 1, 2], "height": 5, "radius": 4 }),
            json!({ "type": kind, "position": [1, 2, 3], "up": [0, 4, 0], "radius": 4 }),
            json!({ "type": kind, "p1": [1, 2, 3], "p2": [1, 6, 3], "radius": 4 }),
        ]);
    }
    objects
}

/// The scene of one object, and the files it wants.
fn lowered(object: &Value) -> Option<(Scene, Vec<(AssetTarget, String)>)> {
    let mut object = object.clone();
    if object["type"] != "gltf" {
        object["material"] = json!({ "color": [1, 1, 1], "ka": 1, "kd": 1, "ks": 0, "n": 1 });
    }
    let text = json!({ "Eye": [200, 200, 1000], "Objects": [object] }).to_string();
    let mut map = SourceMap::default();
    let file = map.add("scene.json", text.into_bytes());
    let (mut sink, options) = (DiagnosticSink::default(), FrontOptions::default());
    let draft = course::lower(file, &map, &options, &mut sink)?;
    let is_read = sink.kept().iter().all(|found| found.code.id == "SC010");
    let pending = draft.pending_assets.into_iter();
    let pending = pending
        .map(|pending| (pending.target, pending.path))
        .collect();
    is_read.then_some((draft.lowered.scene, pending))
}

/// The object with other names for one thing, if it has that.
fn renamed(object: &Value, from: &[&str], to: &[&str]) -> Option<Value> {
    let keys = object.as_object()?;
    from.iter().all(|key| keys.contains_key(*key)).then(|| {
        let new = |key: &String| {
            let at = from.iter().position(|from| from == key);
            at.map_or(key.clone(), |at| to[at].to_owned())
        };
        let keys = keys.iter().map(|(key, value)| (new(key), value.clone()));
        Value::Object(keys.collect::<Map<_, _>>())
    })
}

#[test]
fn every_type_takes_every_name_of_a_key() {
    let mut count = 0;
    for object in objects() {
        let expected = lowered(&object).unwrap_or_else(|| panic!("{object}"));
        for names in SAME {
            let own = names
                .iter()
                .find(|from| renamed(&object, from, from).is_some());
            let Some(own) = own else { continue };
            // Of a torus, `R` beside `r` is another thing than either alone.
            for other in *names {
                let other = renamed(&object, own, other).unwrap();
                assert_eq!(lowered(&other).as_ref(), Some(&expected), "{other}");
                count += 1;
            }
        }
    }
    assert!(count > 150, "{count}");
}

#[test]
fn other_forms_of_neighbours_say_the_same() {
    let same = |a: Value, b: Value| {
        let [own, other] = [&a, &b].map(lowered);
        assert!(own.is_some() && own == other, "{a} {b}");
    };
    for kind in ["cone", "paraboloid", "cylinder"] {
        let up = json!({ "type": kind, "position": [1, 2, 3], "up": [0, 4, 0], "radius": 2 });
        let ends = json!({ "type": kind, "point1": [1, 2, 3], "point2": [1, 6, 3], "radius": 2 });
        same(up, ends);
    }
    let torus = json!({ "type": "torus", "position": [1, 2, 3], "radius": 80, "alpha": 25 });
    for other in [
        json!({ "type": "torus", "pos": [1, 2, 3], "R": 80, "r": 25 }),
        json!({ "type": "torus", "pos": [1, 2, 3], "radius": 80, "r": 25 }),
        json!({ "type": "torus", "pos": [1, 2, 3], "r": 80, "alpha": 25 }),
        json!({ "type": "torus", "pos": [1, 2, 3], "majorRadius": 80, "minorRadius": 25 }),
    ] {
        same(torus.clone(), other);
    }
    let corners = json!({ "type": "box", "min": [0, 0, 0], "max": [2, 2, 2] });
    same(
        corners.clone(),
        json!({ "type": "box", "corner1": [0, 0, 0], "corner2": [2, 2, 2] }),
    );
    same(
        corners,
        json!({ "type": "box", "center": [1, 1, 1], "size": 2 }),
    );
}

/// The steps of the transform of a mesh that is turned.
fn turned(turn: &str) -> [[f64; 3]; 4] {
    let keys = format!("type: mesh, file: a.obj, position: [1, 2, 3], scale: [2, 3, 4], {turn}");
    let scene = object(&keys);
    let ir::Shape::Instance(instance) = &scene.surfaces[0].shape else {
        panic!("a mesh is an instance");
    };
    instance.world_from_object
}

#[test]
fn a_mesh_is_turned_by_angles_and_about_an_axis() {
    let expected = [
        [0.0, 2.0, 0.0],
        [-3.0, 0.0, 0.0],
        [0.0, 0.0, 4.0],
        [1.0, 2.0, 3.0],
    ];
    for turn in [
        "rotation: [0, 0, 1.5707963267948966]",
        "axis: [0, 0, 7], angle: 90",
        "rotation: [0, 0, 1], angle: 90",
        "rotationAxis: [0, 0, 1], rotationAngle: 90",
    ] {
        let found = turned(turn);
        let pairs = found.as_flattened().iter().zip(expected.as_flattened());
        let is_near = pairs.into_iter().all(|(a, b)| (a - b).abs() < 1e-12);
        assert!(is_near, "{turn}: {found:?}");
    }
}

#[test]
fn cameras_of_other_programs_are_read() {
    let camera = |keys: &str| scene(&format!("{{\"Camera\": {{{keys}}}, \"Objects\": []}}"));
    let rest = "\"up\": [0, 0.02, 0]";
    let own = camera(&format!(
        "\"eye\": [0, 3, 12], \"center\": [0, 1, 0], {rest}, \"viewSize\": [30, 20]"
    ));
    assert!(own.is_some());
    for (eye, center) in [
        ("position", "lookat"),
        ("position", "lookAt"),
        ("position", "look_at"),
        ("from", "to"),
        ("eye", "target"),
        ("lookFrom", "lookAt"),
        ("origin", "target"),
        ("location", "at"),
    ] {
        for size in ["resolution", "size", "imageSize", "viewSize"] {
            let keys = format!(
                "\"{eye}\": [0, 3, 12], \"{center}\": [0, 1, 0], {rest}, \"{size}\": [30, 20]"
            );
            assert_eq!(camera(&keys), own, "{keys}");
        }
    }
    let place = "\"eye\": [0, 0, 12], \"center\": [0, 0, 0], \"viewSize\": [30, 20]";
    let wide = camera(&format!("{place}, \"up\": [0, 1, 0], \"fov\": 60"));
    assert!(wide.is_some());
    assert_eq!(
        camera(&format!("{place}, \"up\": [0, 1, 0], \"fovy\": 60")),
        wide
    );
    // An image 6 before the eye has pixels half as large as one at 12.
    let plane = camera(&format!(
        "{place}, \"up\": [0, 9, 0], \"planeDistance\": 6, \"pixSize\": 0.25"
    ));
    let plane = plane.unwrap().camera;
    assert_eq!(
        (plane.center, plane.up),
        ([0.0, 0.0, 6.0], [0.0, 0.25, 0.0])
    );
    let pixel = camera(&format!("{place}, \"up\": [0, 9, 0], \"pixelSize\": 0.5")).unwrap();
    assert_eq!(
        (pixel.camera.center, pixel.camera.up),
        ([0.0; 3], [0.0, 0.5, 0.0])
    );
}

#[test]
fn one_number_is_the_size_of_a_square() {
    let size = |text: &str| scene(text).map(|scene| scene.camera.size);
    for text in [
        "{\"Eye\": [200, 200, 900], \"Resolution\": 640}",
        "{\"Eye\": [200, 200, 900], \"ImageSize\": [640]}",
        "Camera: {eye: [0, 0, 9], center: [0, 0, 0], up: [0, 1, 0], viewSize: 640}",
        "Camera: {position: [0, 0, 9], lookAt: [0, 0, 0], up: [0, 1, 0], resolution: 640}",
    ] {
        assert_eq!(size(text), Some([640, 640]), "{text}");
    }
    assert_eq!(
        size("{\"Eye\": [200, 200, 900], \"Resolution\": 0.5}"),
        None
    );
}

/// The two readings of a torus with two rims: the one by which it holds less of the rest.
#[test]
fn the_rims_of_a_torus_are_read_by_what_is_around_it() {
    let radii = |objects: &str| {
        let text = format!(
            "Eye: [200, 200, 900]\nLights: [{{position: [200, 240, 700], color: [1, 1, 1]}}]\nObjects:\n{objects}"
        );
        let scene = scene(&text).unwrap();
        let ir::Shape::Torus(torus) = &scene.surfaces[0].shape else {
            panic!("a torus is the first");
        };
        (torus.major, torus.minor)
    };
    let ring = format!(
        "- {{type: torus, center: [200, 200, 0], axis: [0, 1, 0.2], innerRadius: 2, outerRadius: 170, {CLAY}}}\n"
    );
    assert_eq!(radii(&ring), (86.0, 84.0), "alone it is a hole and a whole");
    let ball = format!("{ring}- {{type: sphere, position: [200, 200, 0], radius: 60, {CLAY}}}\n");
    assert_eq!(radii(&ball), (170.0, 2.0), "a thin ring round the ball");
    let far = format!("{ring}- {{type: sphere, position: [200, 900, 0], radius: 60, {CLAY}}}\n");
    assert_eq!(radii(&far), (86.0, 84.0));
}

#[test]
fn a_bent_quad_is_two_triangles_unless_it_is_said_to_be_curved() {
    let corners =
        "type: quad, v0: [80, 90, 0], v1: [320, 90, 0], v2: [320, 310, 220], v3: [80, 310, 0]";
    let shapes = |keys: &str| {
        object(keys)
            .surfaces
            .into_iter()
            .map(|surface| surface.shape.kind())
    };
    let kinds = |keys: &str| shapes(keys).collect::<Vec<_>>();
    let triangles = [ir::ShapeKind::Triangle; 2];
    assert_eq!(kinds(corners), triangles);
    assert_eq!(kinds(&format!("{corners}, curved: false")), triangles);
    assert_eq!(
        kinds(&format!("{corners}, curved: true")),
        [ir::ShapeKind::Quad]
    );
    // What is bent by less than an eye sees is as it was.
    let flat = corners.replace("220", "0.1");
    assert_eq!(kinds(&flat), [ir::ShapeKind::Quad]);
    comes_back(&object(&format!("{corners}, curved: true")));
    comes_back(&object(corners));
}

#[test]
fn materials_of_other_programs_are_read() {
    let ball = |material: &str| {
        scene(&format!(
            "Eye: [200, 200, 900]\nObjects: [{{type: sphere, position: [0, 0, 0], radius: 1, material: {{{material}}}}}]\n"
        ))
    };
    let own = ball("color: [1, 0, 0], ka: 0.1, kd: 0.7, ks: 0.2, n: 9, kt: 0.5, eta: 1.5");
    assert!(own.is_some());
    let other = "colour: [1, 0, 0], ambient: 0.1, diffuse: 0.7, specular: 0.2, shininess: 9, refract: 0.5, ior: 1.5";
    assert_eq!(ball(other), own);
}
