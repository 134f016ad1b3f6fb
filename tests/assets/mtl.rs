//! The materials of OBJ files: where they count, what is said where they don't, and that a scene
//! with them is written back as it is.

use super::{folder, write};
use proptest::prelude::*;
use rtc::internals::diag::DiagnosticSink;
use rtc::internals::emit::course::emit;
use rtc::internals::front::mesh::mtl::{self, MtlMap};
use rtc::internals::ir::{
    Alpha, Instance, LoweredScene, Map, Material, Phong, Scene, Shape, Standard, Texture,
};
use rtc::internals::pipeline::{Options, load};
use rtc::internals::source::{Budget, Loader, SourceMap};
use std::path::Path;

/// A mesh of three faces: one asks for nothing, one for `a`, one for `b`.
const OBJ: &str = "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nusemtl a\nf 2 3 4\nusemtl b\nf 1 2 4\n";
const MTL: &str = "newmtl a\nKd 1 0 0\nnewmtl b\nKd 0 0 1\nmap_Kd -s 1 1 1 the map.png\n";
const OWN: &str = "{color: [0.5, 0.5, 0.5], ka: 0, kd: 1, ks: 0, n: 1}";

/// The scene that holds these objects in a folder, and what is found, `CODE message` a line.
fn read(folder: &Path, objects: &str) -> (LoweredScene, String) {
    let text = format!(
        "Camera: {{eye: [0, 0, 9], center: [0, 0, 0], up: [0, 1, 0], viewSize: [4, 4]}}\nLights:\n- {{position: [0, 0, 9], \
         color: [1, 1, 1]}}\nObjects:\n{objects}"
    );
    std::fs::write(folder.join("scene.yaml"), text).unwrap();
    let (mut map, mut sink) = (SourceMap::default(), DiagnosticSink::default());
    let file = Loader.file(&folder.join("scene.yaml"), &mut map).unwrap();
    let lowered = load(file, &mut map, &Options::default(), &mut sink).unwrap();
    let lines = sink
        .kept()
        .iter()
        .map(|finding| format!("{} {}\n", finding.code, finding.message));
    (lowered, lines.collect())
}

fn instance(shape: &Shape) -> &Instance {
    let Shape::Instance(instance) = shape else {
        panic!("{shape:?} is no mesh");
    };
    instance
}

/// What each surface shows: the number of its triangles, and its material.
fn shown(scene: &Scene) -> Vec<(usize, Phong)> {
    let surfaces = scene.surfaces.iter().map(|surface| {
        let mesh = &scene.meshes[instance(&surface.shape).mesh.0 as usize];
        let material = scene.materials[surface.material.0 as usize].phong();
        (mesh.triangles.len(), material.unwrap().clone())
    });
    surfaces.collect()
}

#[test]
fn the_materials_of_a_file_count_where_the_scene_gives_none() {
    let folder = folder();
    write(&folder, "inner/sub/m.obj", OBJ);
    write(&folder, "inner/sub/m.mtl", MTL);
    let inner = folder.path().join("inner");
    let (lowered, findings) = read(&inner, "- {type: mesh, file: sub/m.obj}\n");
    let shown = shown(&lowered.scene);
    assert_eq!(shown.len(), 3);
    assert!(shown.iter().all(|(triangles, _)| *triangles == 1));
    assert_eq!(shown[0].1.color, [0.7; 3], "grey");
    assert_eq!((shown[1].1.color, shown[1].1.kd), ([1.0, 0.0, 0.0], 1.0));
    assert_eq!(shown[2].1.color, [0.0, 0.0, 1.0]);
    assert_eq!(
        findings,
        "SC012 some faces have no material, so they are grey\n\
         RE001 there is no file `sub/the map.png`; the texture is left out\n"
    );
}

#[test]
fn the_material_of_the_scene_counts_unless_it_asks_for_those_of_the_file() {
    let folder = folder();
    write(&folder, "inner/m.obj", OBJ);
    write(&folder, "inner/m.mtl", MTL);
    let inner = folder.path().join("inner");
    let own = format!("- {{type: mesh, file: m.obj, material: {OWN}}}\n");
    let (lowered, findings) = read(&inner, &own);
    let all = shown(&lowered.scene);
    assert_eq!((all.len(), all[0].0, all[0].1.color), (1, 3, [0.5; 3]));
    assert!(findings.starts_with("RE011 2 materials"), "{findings}");
    // Beside it, one that asks: the whole mesh stays for the first.
    let both = format!("{own}- {{type: mesh, file: m.obj, materials: mtl, material: {OWN}}}\n");
    let all = shown(&read(&inner, &both).0.scene);
    let triangles: Vec<_> = all.iter().map(|(triangles, _)| *triangles).collect();
    assert_eq!(triangles, [3, 1, 1, 1]);
    assert_eq!(all[1].1.color, [0.5; 3], "faces that ask for none");
}

#[test]
fn a_scene_with_the_materials_of_a_file_is_written_back() {
    let folder = folder();
    write(&folder, "inner/m.obj", OBJ);
    let mtl = "newmtl a\nKd 1 0 0\nd 0.5\nillum 7\nNi 1.5\nnewmtl b\nKs 0.2 0.3 0.4\nNs 7\n";
    write(&folder, "inner/m.mtl", mtl);
    let inner = folder.path().join("inner");
    let objects = format!(
        "- {{type: mesh, file: m.obj, fit: 2}}\n- {{type: mesh, file: m.obj, position: [1, 2, 3], part: b, material: {OWN}}}\n"
    );
    let (lowered, _) = read(&inner, &objects);
    let text = emit(&lowered.scene).unwrap();
    let (again, findings) = read(&inner, text.split_once("Objects:\n").unwrap().1);
    // The scene of the test follows no light through its glass.
    assert!(
        findings.starts_with("SC011") && findings.lines().count() == 1,
        "{findings}"
    );
    assert_eq!(shown(&again.scene), shown(&lowered.scene));
    assert_eq!(text.matches("part: ").count(), 4);
    let places = |scene: &Scene| -> Vec<_> {
        let surfaces = scene.surfaces.iter();
        let placed = surfaces.map(|surface| instance(&surface.shape).world_from_object);
        placed.collect()
    };
    assert_eq!(places(&again.scene), places(&lowered.scene));
}

#[test]
fn a_part_that_no_face_asks_for_is_an_error() {
    let folder = folder();
    write(&folder, "inner/m.obj", OBJ);
    let inner = folder.path().join("inner");
    let (_, findings) = read(&inner, "- {type: mesh, file: m.obj, part: c}\n");
    assert!(findings.contains("RE006 no face of"), "{findings}");
}

/// The only material of an MTL, as Phong's model.
fn phong(statements: &str) -> Phong {
    let folder = folder();
    write(
        &folder,
        "inner/m.obj",
        "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n",
    );
    write(&folder, "inner/m.mtl", format!("newmtl a\n{statements}"));
    let inner = folder.path().join("inner");
    let (lowered, findings) = read(&inner, "- {type: mesh, file: m.obj}\n");
    assert_eq!(findings, "", "{statements}");
    shown(&lowered.scene).remove(0).1
}

#[test]
fn statements_become_the_words_of_the_course() {
    let plain = phong("Ka 0.1 0.1 0.1\nKd 0.2 0.4 0.6\nKs 0.5 0.5 0.5\nNs 32\n");
    assert_eq!(
        (plain.ka, plain.kd, plain.ks, plain.n),
        (0.1, 1.0, 0.5, 32.0)
    );
    assert_eq!((plain.color, plain.kt), ([0.2, 0.4, 0.6], 0.0));
    assert_eq!(
        phong("Ka 1 1 1\n").ka,
        0.2,
        "no ambient light of the course is so strong"
    );
    assert_eq!(phong("Ks 1 1 1\nillum 1\n").ks, 0.0, "without highlights");
    let veil = phong("d 0.25\nNi 1.5\n");
    assert_eq!((veil.kt, veil.kd, veil.ior), (0.75, 0.25, 1.0));
    assert_eq!(phong("Tr 0.75\n").kt, 0.75);
    assert_eq!(phong("d 1\nTr 1\n").kt, 0.0, "`d` counts");
    let glass = phong("illum 7\nNi 1.5\n");
    assert_eq!((glass.kt, glass.kd, glass.ior), (1.0, 0.0, 1.5));
}

#[test]
fn options_of_maps_are_read_or_told_if_they_count() {
    let read = |options: &str| {
        let text = format!("newmtl a\nmap_Kd {options} a b.png\n");
        let library = mtl::parse(text.as_bytes(), &Budget::default()).unwrap();
        let map = library.materials["a"].color_map.clone().unwrap();
        let told = library.not_shown.map(|(first, _)| first.message);
        (map.value, told.unwrap_or_default())
    };
    let plain = MtlMap::of("a b.png".to_owned());
    for options in [
        "",
        "-s 1 1.0 1 -o 0 0",
        "-clamp off -bm 1.000",
        "-blendu on -mm 0 1",
    ] {
        assert_eq!(read(options), (plain.clone(), String::new()), "{options}");
    }
    let (map, told) = read("-s 2 3 -o 0.25 -clamp on -bm 0.3");
    assert_eq!((map.scale, map.offset), ([2.0, 3.0], [0.25, 0.0]));
    assert!(map.clamps && map.height == 0.3 && map.placed.is_some() && told.is_empty());
    let (map, told) = read("-mm 0 2 -t 1");
    assert_eq!(
        (map, told.as_str()),
        (plain, "the option `-mm` is not read")
    );
}

/// A material of an OBJ alone, whose paths are traced, and in a scene of Phong's model.
fn in_both(statements: &str) -> [(Material, String); 2] {
    let folder = folder();
    let obj = "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl a\nf 1/1 2/2 3/3\n";
    write(&folder, "inner/m.obj", obj);
    write(&folder, "inner/m.mtl", format!("newmtl a\n{statements}\n"));
    write(&folder, "inner/map.png", super::png([200, 100, 50]));
    let inner = folder.path().join("inner");
    let (mut map, mut sink) = (SourceMap::default(), DiagnosticSink::default());
    let file = Loader.file(&inner.join("m.obj"), &mut map).unwrap();
    let alone = load(file, &mut map, &Options::default(), &mut sink).unwrap();
    let told = sink
        .kept()
        .iter()
        .map(|finding| format!("{} {}\n", finding.code, finding.message));
    let alone = (alone.scene, told.collect::<String>());
    let in_scene = read(&inner, "- {type: mesh, file: m.obj}\n");
    [alone, (in_scene.0.scene, in_scene.1)].map(|(scene, told)| {
        let material = scene.surfaces[0].material.0 as usize;
        (scene.materials[material].clone(), told)
    })
}

/// Every statement of a material changes it or is told, whichever integrator shows it.
#[test]
fn no_statement_is_lost_in_silence() {
    let statements = [
        "Kd .1 .2 .3",
        "Ks .4 .4 .4",
        "Ns 77",
        "Ks .4 .4 .4\nNs 77\nNi 1.7\nillum 7\nd .5",
        "Ke 5 3 1",
        "Tf .1 .2 .3",
        "illum 7\nTf .1 .2 .3",
        "d .5",
        "Tr .5",
        "d 0",
        "Tr 1",
        "illum 4",
        "Pr .3",
        "Pm .3",
        "Ps .3",
        "Pc .3",
        "Pc .3\nPcr .2",
        "aniso .3",
        "aniso .3\nanisor .3",
        "map_Kd map.png",
        "Ks 1 1 1\nmap_Ks map.png",
        "norm map.png",
        "map_Bump map.png",
        "bump -bm 3 map.png",
        "map_d map.png",
        "map_Ke map.png",
        "map_Pr map.png",
        "map_Pm map.png",
        "map_Ns map.png",
        "disp map.png",
        "decal map.png",
        "refl map.png",
        "map_Kd -s 2 2 map.png",
        "map_Kd -o .5 map.png",
        "map_Kd -clamp on map.png",
        "map_Kd -mm .1 .9 map.png",
    ];
    let none = in_both("");
    for statement in statements {
        // The last line alone is asked of; what stands before it is what it needs.
        let before = statement.rsplit_once('\n').map_or("", |(before, _)| before);
        for (index, (with, told)) in in_both(statement).into_iter().enumerate() {
            let (without, silent) = match before {
                "" => none[index].clone(),
                _ => in_both(before)[index].clone(),
            };
            assert!(
                with != without || told != silent,
                "{statement} ({index}): {told}"
            );
        }
    }
}

#[test]
fn statements_become_parts_of_the_material_of_gltf() {
    let standard = |statements: &str| match in_both(statements) {
        [(Material::Standard(standard), told), _] => (*standard, told),
        [(Material::Phong(_), _), _] => panic!("paths are traced"),
    };
    let (glow, told) = standard("Kd 0 0 0\nKe 5 3 1\nPr .3\nPm .7\nPc .2\nPcr .1");
    assert_eq!((glow.emissive, told.as_str()), ([5.0, 3.0, 1.0], ""));
    assert_eq!((glow.roughness, glow.metallic), (0.3, 0.7));
    assert_eq!((glow.clearcoat, glow.clearcoat_roughness), (0.2, 0.1));
    let (veil, _) = standard("Kd 1 0 0\nd .25");
    assert_eq!(
        (veil.base_color, veil.alpha),
        ([1.0, 0.0, 0.0, 0.25], Alpha::Blend)
    );
    let (opaque, told) = standard("Kd 1 0 0\nTr 1");
    assert_eq!(
        (opaque.base_color, opaque.alpha),
        ([1.0, 0.0, 0.0, 1.0], Alpha::Opaque)
    );
    assert_eq!(told, "SC013 `Tr 1` is read as opaque\n");
    let (clear, told) = standard("Kd 1 0 0\nd 0");
    assert_eq!(clear.base_color[3], 0.0);
    assert!(
        told.contains("a material of this opacity is invisible"),
        "{told}"
    );
    let (glass, _) = standard("Kd 0 0 0\nillum 4\nNi 1.4\nTf .9 1 .9");
    assert_eq!(
        (glass.transmission, glass.thickness, glass.ior),
        (1.0, 1.0, 1.4)
    );
    assert_eq!(
        (glass.base_color, glass.roughness),
        ([0.9, 1.0, 0.9, 1.0], 0.0)
    );
    let (bent, told) = standard("norm map.png");
    assert!(bent.normal_map.is_some() && told.is_empty(), "{told}");
    let (placed, _) = standard("map_Kd -s 2 3 -o .25 .5 map.png");
    let map = placed.base_color_map.unwrap();
    assert_eq!(
        map.texture_from_surface,
        Some([[2.0, 0.0, 0.25], [0.0, -3.0, 0.5]])
    );
}

#[test]
fn maps_of_several_pictures_are_baked() {
    let scene = |statements: &str| {
        let folder = folder();
        write(&folder, "inner/m.obj", OBJ);
        write(
            &folder,
            "inner/m.mtl",
            format!("newmtl a\n{statements}\nnewmtl b\n"),
        );
        let inner = folder.path().join("inner");
        for (name, color) in [
            ("c.png", [10, 20, 30]),
            ("m.png", [99; 3]),
            ("n.png", [60; 3]),
        ] {
            write(&folder, &format!("inner/{name}"), super::png(color));
        }
        let (mut map, mut sink) = (SourceMap::default(), DiagnosticSink::default());
        let file = Loader.file(&inner.join("m.obj"), &mut map).unwrap();
        load(file, &mut map, &Options::default(), &mut sink)
            .unwrap()
            .scene
    };
    let pixels = |scene: &Scene, of: fn(&Standard) -> &Option<Map>| {
        let standards = scene
            .materials
            .iter()
            .filter_map(|material| match material {
                Material::Standard(standard) => of(standard).as_ref(),
                Material::Phong(_) => None,
            });
        let map = standards.collect::<Vec<_>>().pop().unwrap();
        let Texture::Sampled(sampled) = &scene.textures[map.texture.0 as usize] else {
            panic!("it is laid as glTF lays it");
        };
        let image = &scene.images[sampled.image.0 as usize];
        image.pixels[..image.kind.bytes()].to_vec()
    };
    let veiled = scene("map_Kd c.png\nmap_d m.png");
    assert_eq!(pixels(&veiled, |own| &own.base_color_map), [10, 20, 30, 99]);
    let metal = scene("map_Pr m.png\nmap_Pm n.png");
    assert_eq!(
        pixels(&metal, |own| &own.metallic_roughness_map),
        [255, 99, 60]
    );
    // A height field without slopes.
    let even = scene("map_Bump m.png");
    assert_eq!(pixels(&even, |own| &own.normal_map), [128, 128, 255]);
}

/// Lines of statements, most of them nearly right.
fn statements() -> impl Strategy<Value = String> {
    let word = prop::sample::select(vec![
        "newmtl", "Kd", "ka", "KS", "Ns", "Ni", "d", "Tr", "illum", "map_Kd", "bump", "-bm", "-s",
        "-clamp", "-o", "on", "Pr", "Tf", "map_d", "map_Pr", "norm", "1", "0.5", "-3", "1e400",
        "nan", "xyz", "spectral", "-halo", "\\\n", "\n", "\n", "#", "é", "\0", "a.png", "map_Ka",
        "Ke",
    ]);
    prop::collection::vec(word, 0..80).prop_map(|words| words.join(" "))
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, cases: 500, ..ProptestConfig::default() })]

    #[test]
    fn any_bytes_are_materials_in_range(text in statements(), bytes: Vec<u8>, plain in prop::bool::ANY) {
        let text = if plain { text.into_bytes() } else { bytes };
        let library = mtl::parse(&text, &Budget::default()).unwrap();
        for material in library.materials.values() {
            let colors = [&material.ambient, &material.diffuse, &material.specular];
            let channels = colors.into_iter().flatten().flat_map(|color| color.value);
            let numbers = [&material.exponent, &material.index].into_iter().flatten().map(|number| number.value);
            prop_assert!(channels.chain(numbers).all(|number| (0.0..=1e6).contains(&number)));
            prop_assert!(material.opacity.iter().all(|opacity| (0.0..=1.0).contains(&opacity.value)));
        }
    }
}
