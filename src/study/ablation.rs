//! Ablations of a scene: an effect, a light or an object is removed, or a material is made diffuse.

use rtc_ir::{Light, Material, Mode, Phong, Scene, Shape, Standard, Surface};
use rtc_math::Vec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// The maximum number of lights, of objects and of materials.
const MAX_PER_KIND: usize = 8;

/// The kind of an ablation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub enum Ablation {
    /// An effect of the whole scene.
    Effect,
    /// A light, or the environment.
    Light,
    /// An object: a surface, or consecutive surfaces with the same name.
    Object,
    /// A material: its surfaces become diffuse, in its colour.
    Material,
}

/// A scene after an ablation.
pub(super) struct AblatedScene {
    pub(super) kind: Ablation,
    pub(super) name: String,
    pub(super) scene: Scene,
}

/// A function that removes an effect from a scene.
type EffectRemoval = (&'static str, fn(&mut Scene));

const EFFECTS: [EffectRemoval; 6] = [
    ("shadows", |scene| scene.settings.shadows = false),
    ("mirrors and refraction", |scene| {
        scene.settings.max_depth = 0
    }),
    ("depth of field", |scene| scene.camera.lens.radius = 0.0),
    ("highlights and mirrors", |scene| {
        phongs(scene).for_each(|phong| phong.ks = 0.0)
    }),
    ("soft lights", |scene| {
        scene.lights.iter_mut().for_each(remove_radius)
    }),
    ("textures", |scene| phongs(scene).for_each(remove_maps)),
];

/// All ablations that change a scene: effects first, then the other kinds in turn, those with the
/// largest projected size first.
pub(super) fn of(scene: &Scene) -> Vec<AblatedScene> {
    if !matches!(scene.settings.mode, Mode::Phong | Mode::Path(_)) {
        return Vec::new();
    }
    let objects = objects(scene);
    let kinds = [
        lights(scene),
        objects
            .iter()
            .map(|object| object_removal(scene, object))
            .collect(),
        materials(scene, &objects),
    ];
    let mut all: Vec<_> = effects(scene);
    for rank in 0..MAX_PER_KIND {
        all.extend(
            kinds
                .iter()
                .filter_map(|kind| kind.get(rank)?.ablated(scene)),
        );
    }
    all
}

/// An ablation that is not applied yet.
struct AblationCandidate {
    kind: Ablation,
    name: String,
    remove: Box<dyn Fn(&mut Scene)>,
}

impl AblationCandidate {
    /// The scene after the ablation, if it changes anything.
    fn ablated(&self, scene: &Scene) -> Option<AblatedScene> {
        let mut remove = scene.clone();
        (self.remove)(&mut remove);
        (remove != *scene).then(|| AblatedScene {
            kind: self.kind,
            name: self.name.clone(),
            scene: remove,
        })
    }
}

fn effects(scene: &Scene) -> Vec<AblatedScene> {
    if !matches!(scene.settings.mode, Mode::Phong) {
        return Vec::new();
    }
    let effect = |(name, remove): EffectRemoval| AblationCandidate {
        kind: Ablation::Effect,
        name: name.to_owned(),
        remove: Box::new(remove),
    };
    let all = EFFECTS.into_iter().map(effect);
    all.filter_map(|effect| effect.ablated(scene)).collect()
}

fn phongs(scene: &mut Scene) -> impl Iterator<Item = &mut Phong> {
    scene.materials.iter_mut().filter_map(Material::phong_mut)
}

fn remove_radius(light: &mut Light) {
    if let Light::Point(light) = light {
        light.radius = 0.0;
    }
}

fn remove_maps(phong: &mut Phong) {
    (
        phong.color_map,
        phong.specular_map,
        phong.normal_map,
        phong.bump,
    ) = (None, None, None, None);
}

/// The environment, then the lights in scene order.
fn lights(scene: &Scene) -> Vec<AblationCandidate> {
    let light = |index: usize| AblationCandidate {
        kind: Ablation::Light,
        name: format!("light {}", index + 1),
        remove: Box::new(move |scene| {
            scene.lights.remove(index);
        }),
    };
    let emits = |index: &usize| scene.lights[*index].emits();
    let lights = (0..scene.lights.len())
        .filter(emits)
        .take(MAX_PER_KIND)
        .map(light);
    let environment = AblationCandidate {
        kind: Ablation::Light,
        name: "surroundings".to_owned(),
        remove: Box::new(|scene| scene.environment = None),
    };
    let environment = scene.environment.is_some().then_some(environment);
    environment.into_iter().chain(lights).collect()
}

/// Surfaces that form one object.
struct SceneObject {
    surfaces: Range<usize>,
    name: String,
    /// Its approximate projected size: half its diagonal over its distance from the eye.
    extent: f64,
}

/// The objects, those with the largest projected size first.
fn objects(scene: &Scene) -> Vec<SceneObject> {
    let meshes = scene.mesh_boxes();
    let eye = Vec3::from_array(scene.camera.eye);
    let name = |index: usize| scene.names.get(index).map_or("", String::as_str);
    let mut objects: Vec<SceneObject> = Vec::new();
    for (index, surface) in scene.surfaces.iter().enumerate() {
        let extent = extent(&surface.shape, &meshes, eye);
        match objects.last_mut() {
            Some(last) if !name(index).is_empty() && name(last.surfaces.start) == name(index) => {
                last.surfaces.end = index + 1;
                last.extent = last.extent.max(extent);
            }
            Some(_) | None => objects.push(SceneObject {
                surfaces: index..index + 1,
                name: display_name(name(index), surface, index),
                extent,
            }),
        }
    }
    objects.sort_by(|a, b| b.extent.total_cmp(&a.extent));
    objects
}

fn display_name(name: &str, surface: &Surface, index: usize) -> String {
    match name {
        "" => format!("{} {}", surface.shape.kind().name(), index + 1),
        name => format!("`{name}`"),
    }
}

fn extent(shape: &Shape, meshes: &[[Vec3; 2]], eye: Vec3) -> f64 {
    let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    shape.corners_around(meshes, &mut |corner| {
        (low, high) = (low.min(corner), high.max(corner));
    });
    if low.x > high.x {
        // It is unbounded.
        return f64::INFINITY;
    }
    let half = 0.5 * (high - low).length();
    half / (0.5 * (low + high) - eye).length().max(half * f64::EPSILON)
}

fn object_removal(scene: &Scene, object: &SceneObject) -> AblationCandidate {
    // Surfaces after the last name are unnamed.
    let surfaces = object.surfaces.clone();
    let end = surfaces.end.min(scene.names.len());
    let names = surfaces.start.min(end)..end;
    AblationCandidate {
        kind: Ablation::Object,
        name: object.name.clone(),
        remove: Box::new(move |scene| {
            scene.surfaces.drain(surfaces.clone());
            scene.names.drain(names.clone());
        }),
    }
}

/// The materials, those of objects with the largest projected size first.
fn materials(scene: &Scene, objects: &[SceneObject]) -> Vec<AblationCandidate> {
    let mut order: Vec<usize> = Vec::new();
    for surface in objects.iter().flat_map(|object| object.surfaces.clone()) {
        let material = scene.surfaces[surface].material.0 as usize;
        if !order.contains(&material)
            && order.len() < MAX_PER_KIND
            && !is_diffuse(&scene.materials[material])
        {
            order.push(material);
        }
    }
    let material = |index: usize| AblationCandidate {
        kind: Ablation::Material,
        name: match &scene.materials[index] {
            Material::Standard(standard) if !standard.name.is_empty() => {
                format!("`{}`, matt instead", standard.name)
            }
            Material::Standard(_) | Material::Phong(_) => {
                format!("material {}, matt instead", index + 1)
            }
        },
        remove: Box::new(move |scene| make_diffuse(&mut scene.materials[index])),
    };
    order.into_iter().map(material).collect()
}

fn is_diffuse(material: &Material) -> bool {
    let mut other = material.clone();
    make_diffuse(&mut other);
    other == *material
}

/// Makes a material diffuse in its colour, without textures. An unlit material stays.
fn make_diffuse(material: &mut Material) {
    match material {
        Material::Phong(phong) => {
            let (color, ka, kd) = (phong.color, phong.ka, phong.kd);
            *phong = Phong {
                color,
                ka,
                kd,
                ..Phong::MATT
            };
        }
        Material::Standard(standard) if !standard.unlit => {
            **standard = Standard {
                name: std::mem::take(&mut standard.name),
                base_color: standard.base_color,
                metallic: 0.0,
                specular: 0.0,
                emissive: standard.emissive,
                emissive_map: standard.emissive_map.clone(),
                double_sided: standard.double_sided,
                ..Standard::default()
            };
        }
        Material::Standard(_) => {}
    }
}
