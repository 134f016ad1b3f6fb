//! Files of every version so far decode to the scene that they held.

use super::*;

/// The files of each version as they were written when it was new. They are never rewritten.
#[test]
fn frozen_files_decode() {
    let text = small();
    assert_eq!(
        decode(
            Form::Binary,
            &std::fs::read(frozen("v1/scene.rtir")).unwrap()
        )
        .unwrap(),
        text
    );
    assert_eq!(
        decode(Form::Text, &std::fs::read(frozen("v0/scene.json")).unwrap()).unwrap(),
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
            Form::Binary,
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
            Form::Text,
            &std::fs::read(frozen(&format!("v3/{name}.json"))).unwrap(),
        )
        .unwrap();
        let binary = decode(
            Form::Binary,
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
    assert!(matches!(course.meshes[0].positions, Column::Double(_)));
    let Column::Single(positions) = &path.meshes[0].positions else {
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

#[test]
fn older_files_are_the_same_scene_in_the_current_version() {
    let names = [
        "v0/scene.json",
        "v1/scene.json",
        "v2/scene.json",
        "v3/course.json",
        "v3/path.json",
        "v1/scene.rtir",
        "v2/scene.rtir",
        "v3/course.rtir",
        "v3/path.rtir",
    ];
    for name in names {
        let form = if name.ends_with(".rtir") {
            Form::Binary
        } else {
            Form::Text
        };
        let old = decode(form, &std::fs::read(frozen(name)).unwrap()).unwrap();
        for form in [Form::Text, Form::Binary] {
            let bytes = codec::encode(form, &old).unwrap();
            let version = [&b"\"irVersion\": 4"[..], b"\"irVersion\":4"];
            let start = &bytes[..64];
            assert!(
                version
                    .iter()
                    .any(|version| start.windows(version.len()).any(|part| part == *version)),
                "{name}"
            );
            assert_eq!(
                format!("{:?}", decode(form, &bytes).unwrap()),
                format!("{old:?}"),
                "{name}, {form:?}"
            );
        }
    }
}

#[test]
fn newer_files_say_so_where_the_version_stands() {
    let text = "{\"irVersion\": 7, \"spectra\": []}";
    let (finding, place) = *decode(Form::Text, text.as_bytes()).unwrap_err();
    assert_eq!((finding.code.id, place.as_str()), ("IR001", "7"));
    assert_eq!(
        finding.message,
        "IR version 7 is newer than 4, the newest this rtc reads"
    );
    let mut file = codec::encode(Form::Binary, &small()).unwrap();
    file[8] = 2;
    let file = with_header(&file, |header| header);
    let (finding, _) = *decode(Form::Binary, &file).unwrap_err();
    assert_eq!(
        finding.message,
        "container version 2 is newer than 1, the newest this rtc reads"
    );
    assert_eq!(finding.primary.unwrap().span.start, 8);
}
