//! The paths of values in scenes that were built in code.

use rtc_ir::{ImageId, MaterialId, Scene, Texture};

/// The path of a value, for example `objects[3].material.ior`, from its pointer in the IR; a
/// material is named by the first object that has it, an image by its texture.
pub(super) fn path(pointer: &str, scene: &Scene) -> Option<String> {
    let mut steps = pointer.strip_prefix('/')?.split('/');
    let list = steps.next()?;
    let mut index = || steps.next().and_then(|step| step.parse::<usize>().ok());
    let (mut path, skipped) = match list {
        "surfaces" => (format!("objects[{}]", index()?), 2),
        "materials" => (material(index()?, scene), 1),
        "lights" => match index() {
            Some(index) => (format!("lights[{index}]"), 1),
            None => ("lights".to_owned(), 0),
        },
        "images" => (image(index()?, scene), 0),
        "textures" | "meshes" => (format!("{list}[{}]", index()?), 0),
        "camera" | "settings" | "environment" | "medium" => (list.to_owned(), 0),
        _ => return None,
    };
    // The kind of an object, a light or a material is no step.
    let rest: Vec<_> = steps.collect();
    let kinds = if rest.len() > skipped { skipped } else { 0 };
    for step in rest.iter().skip(kinds) {
        path += &match step.parse::<usize>() {
            Ok(index) => format!("[{index}]"),
            Err(_) => format!(".{}", field(step)),
        };
    }
    Some(path)
}

fn material(index: usize, scene: &Scene) -> String {
    let is_it = |material: MaterialId| material.0 as usize == index;
    let mut surfaces = scene.surfaces.iter();
    match surfaces.position(|surface| is_it(surface.material)) {
        Some(object) => format!("objects[{object}].material"),
        None => format!("materials[{index}]"),
    }
}

fn image(index: usize, scene: &Scene) -> String {
    let is_it = |image: &ImageId| image.0 as usize == index;
    let mut textures = scene.textures.iter();
    let texture = textures.position(|texture| match texture {
        Texture::Uv | Texture::Procedural(_) => false,
        Texture::Image(image) => is_it(image),
        Texture::Sampled(sampled) => is_it(&sampled.image),
    });
    match texture {
        Some(texture) => format!("textures[{texture}]"),
        None => "environment.image".to_owned(),
    }
}

/// The name of a field in Rust, from that in JSON.
fn field(key: &str) -> String {
    if key == "eta" {
        return "ior".to_owned();
    }
    let mut name = String::new();
    for c in key.chars() {
        if c.is_ascii_uppercase() {
            name.push('_');
        }
        name.push(c.to_ascii_lowercase());
    }
    name
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::api::camera::placeholder;
    use rtc_ir::{Material, Phong, Settings, Shape, Sphere, Surface};

    #[test]
    fn a_path_names_what_the_builder_names() {
        let mut scene = Scene::new(placeholder(), Settings::default());
        scene.materials = vec![Material::Phong(Phong::MATT); 3];
        for material in [0, 2, 2] {
            let sphere = Sphere {
                center: [0.0; 3],
                radius: 1.0,
                texture_from_world: None,
            };
            scene
                .surfaces
                .push(Surface::new(Shape::Sphere(sphere), MaterialId(material)));
        }
        for (pointer, expected) in [
            ("/surfaces/3/shape/sphere/radius", "objects[3].radius"),
            (
                "/surfaces/3/shape/triangle/vertices/2",
                "objects[3].vertices[2]",
            ),
            ("/surfaces/3/material", "objects[3].material"),
            ("/surfaces/3", "objects[3]"),
            ("/materials/2/phong/eta", "objects[1].material.ior"),
            (
                "/materials/1/standard/clearcoatRoughness",
                "materials[1].clearcoat_roughness",
            ),
            ("/materials/1", "materials[1]"),
            ("/lights/0/point/color", "lights[0].color"),
            ("/lights/0/punctual/intensity", "lights[0].intensity"),
            ("/lights", "lights"),
            ("/camera/lens/radius", "camera.lens.radius"),
            ("/settings/maxDepth", "settings.max_depth"),
            ("/images/0", "environment.image"),
        ] {
            assert_eq!(
                path(pointer, &scene).as_deref(),
                Some(expected),
                "{pointer}"
            );
        }
        assert_eq!(path("/nodes/0", &scene), None);
    }
}
