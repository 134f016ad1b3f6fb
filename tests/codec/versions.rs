//! Files of every version so far decode to the scene that they held.

use super::*;
use rtc::internals::color::Tone;
use rtc::internals::ir::{Ambient, Light, Material, Punctual, PunctualKind};

/// The files of each version as they were written when it was new. They are never rewritten.
#[test]
fn frozen_files_decode() {
    let text = small();
    assert_eq!(
        decode(
            Encoding::Binary,
            &std::fs::read(frozen("v1/scene.rtir")).unwrap()
        )
        .unwrap(),
        text
    );
    assert_eq!(
        decode(
            Encoding::Json,
            &std::fs::read(frozen("v0/scene.json")).unwrap()
        )
        .unwrap(),
        text
    );
    let Shape::Sphere(sphere) = &text.surfaces[0].shape else {
        panic!("the first surface is a sphere")
    };
    assert_eq!(
        (
            sphere.radius,
            text.settings.supersampling,
            text.surfaces.len()
        ),
        (59.9, 4, 3)
    );
    let text = large();
    assert_eq!(
        decode(
            Encoding::Binary,
            &std::fs::read(frozen("v2/scene.rtir")).unwrap()
        )
        .unwrap(),
        text
    );
    assert_eq!(
        (
            text.meshes[0].positions.at(35),
            text.meshes[0].triangles.len()
        ),
        ([0.5, 0.5, 0.125], 50)
    );
    assert_eq!(
        (text.images[0].pixels.len(), &text.textures[1]),
        (384, &Texture::Uv)
    );
}

/// The scenes of version 3: all shapes of the course, and one whose paths are traced, with columns
/// of 32-bit floats.
#[test]
fn frozen_files_of_version_3_decode() {
    let [course, path] = ["course", "path"].map(|name| {
        let text = decode(
            Encoding::Json,
            &std::fs::read(frozen(&format!("v3/{name}.json"))).unwrap(),
        )
        .unwrap();
        let binary = decode(
            Encoding::Binary,
            &std::fs::read(frozen(&format!("v3/{name}.rtir"))).unwrap(),
        )
        .unwrap();
        assert_eq!(format!("{binary:?}"), format!("{text:?}"), "{name}");
        text
    });
    assert_eq!(
        (
            course.surfaces.len(),
            course.materials.len(),
            course.names[9].as_str()
        ),
        (10, 5, "leaf")
    );
    assert_eq!(
        (
            course.meshes[0].positions.at(35),
            course.images[0].pixels[383]
        ),
        ([1.0, 1.0, 0.225], 40)
    );
    assert!(matches!(
        course.meshes[0].positions,
        VertexColumn::Double(_)
    ));
    let VertexColumn::Single(positions) = &path.meshes[0].positions else {
        panic!("glTF has 32-bit floats")
    };
    assert_eq!(
        (positions[1], path.meshes[0].colors.at(35)),
        ([0.2, 0.0, 0.045], [1.0, 1.0, f64::from(0.1_f32), 1.0])
    );
    assert_eq!(
        (
            path.lights.len(),
            path.images[1].kind,
            path.images[1].pixels.len()
        ),
        (3, Pixels::Rgb32f, 384)
    );
    assert_eq!(
        path.environment
            .as_ref()
            .and_then(|environment| environment.image),
        Some(ImageId(1))
    );
}

/// The scenes of version 4: a cartoon of a paraboloid without a shadow and of the parts of an OBJ;
/// and paths from a measured lamp through glass that disperses, shown by another tone map.
#[test]
fn frozen_files_of_version_4_decode() {
    let [course, path] = ["course", "path"].map(|name| {
        let read = |extension| std::fs::read(frozen(&format!("v4/{name}.{extension}"))).unwrap();
        let text = decode(Encoding::Json, &read("json")).unwrap();
        assert_eq!(
            decode(Encoding::Binary, &read("rtir")).unwrap(),
            text,
            "{name}"
        );
        text
    });
    assert!(course.settings.toon && course.surfaces[0].casts_no_shadow);
    assert!(matches!(&course.surfaces[0].shape, Shape::Paraboloid(it) if it.radius == 0.75));
    let parts: Vec<_> = course
        .meshes
        .iter()
        .map(|mesh| mesh.part.as_deref())
        .collect();
    assert_eq!(parts, [Some("red"), Some("blue")]);
    let Light::Punctual(Punctual {
        emitter: PunctualKind::Photometric { photometry, .. },
        ..
    }) = &path.lights[0]
    else {
        panic!("the first light is a lamp")
    };
    assert_eq!(
        (photometry.name.as_str(), photometry.vertical[1]),
        ("washer.ies", 10.0)
    );
    let Material::Standard(glass) = &path.materials[0] else {
        panic!("the first material is that of glTF")
    };
    assert_eq!((glass.dispersion, glass.diffuse_transmission), (8.0, 0.5));
    assert_eq!(
        (path.display.exposure, path.display.tone),
        (0.5, Some(Tone::Agx))
    );
}

#[test]
fn older_files_are_the_same_scene_in_the_current_version() {
    let names = [
        "v0/scene.json",
        "v1/scene.json",
        "v2/scene.json",
        "v3/course.json",
        "v3/path.json",
        "v4/course.json",
        "v4/path.json",
        "v1/scene.rtir",
        "v2/scene.rtir",
        "v3/course.rtir",
        "v3/path.rtir",
        "v4/course.rtir",
        "v4/path.rtir",
        "v5/scene.json",
        "v5/scene.rtir",
    ];
    for name in names {
        let encoding = if name.ends_with(".rtir") {
            Encoding::Binary
        } else {
            Encoding::Json
        };
        let old = decode(encoding, &std::fs::read(frozen(name)).unwrap()).unwrap();
        for encoding in [Encoding::Json, Encoding::Binary] {
            let bytes = codec::encode(encoding, &old).unwrap();
            let version = [&b"\"irVersion\": 5"[..], b"\"irVersion\":5"];
            let start = &bytes[..64];
            assert!(
                version
                    .iter()
                    .any(|version| start.windows(version.len()).any(|part| part == *version)),
                "{name}"
            );
            assert_eq!(
                format!("{:?}", decode(encoding, &bytes).unwrap()),
                format!("{old:?}"),
                "{name}, {encoding:?}"
            );
        }
    }
}

#[test]
fn newer_files_say_so_where_the_version_stands() {
    let text = "{\"irVersion\": 7, \"spectra\": []}";
    let (finding, place) = *decode(Encoding::Json, text.as_bytes()).unwrap_err();
    assert_eq!((finding.code.id, place.as_str()), ("IR001", "7"));
    assert_eq!(
        finding.message,
        "IR version 7 is newer than 5, the newest this rtc reads"
    );
    let mut file = codec::encode(Encoding::Binary, &small()).unwrap();
    file[8] = 2;
    let file = with_header(&file, |header| header);
    let (finding, _) = *decode(Encoding::Binary, &file).unwrap_err();
    assert_eq!(
        finding.message,
        "container version 2 is newer than 1, the newest this rtc reads"
    );
    assert_eq!(finding.primary.unwrap().span.start, 8);
}

/// A scene of version 5, whose ambient light is added once.
#[test]
fn frozen_files_of_version_5_decode() {
    let read = |name| std::fs::read(frozen(name)).unwrap();
    let text = decode(Encoding::Json, &read("v5/scene.json")).unwrap();
    assert_eq!(
        decode(Encoding::Binary, &read("v5/scene.rtir")).unwrap(),
        text
    );
    assert_eq!(text.settings.ambient, Ambient::Once);
}
