//! Loads the glTF assets of a scene and places their surfaces and lights. Their cameras are
//! ignored.

use super::{AssetLoader, FileCache, MissingAssetPolicy, PendingAsset};
use crate::{FrontOptions, gltf, over_limit};
use glam::DAffine3;
use rtc_diag::{Diagnostic, codes};
use rtc_ir::{
    EntityField, EntityKind, ImageId, Light, LoweredScene, Material, MaterialId, MeshId, Punctual,
    Scene, Shape, SourceSpans, Surface, Texture, TextureId, ValuePath,
};
use rtc_math::Vec3;
use rtc_source::{Budget, FileId, FileKind, FoundFile, LimitExceeded, Resource};

/// The file formats of assets.
pub(super) const KIND: FileKind = FileKind {
    extensions: &["gltf", "glb"],
    begins: gltf::begins,
};

/// The largest asset read, in bytes.
const MAX_BYTES: u64 = 1 << 30;

/// The assets loaded so far.
#[derive(Default)]
pub(super) struct GltfAssets {
    cache: FileCache<ImportedAsset>,
    /// Whether the budget was exceeded, which is reported once.
    is_over: bool,
}

/// An asset whose images, textures, meshes and materials are in the scene. Its surfaces and lights
/// are added for each placement.
struct ImportedAsset {
    surfaces: Vec<Surface>,
    names: Vec<String>,
    lights: Vec<Light>,
}

impl GltfAssets {
    /// Loads an asset and places it. If that fails, nothing is placed.
    pub(super) fn load(
        &mut self,
        transform: [[f64; 3]; 4],
        pending: &PendingAsset,
        lowered: &mut LoweredScene,
        loader: &mut AssetLoader<'_>,
    ) {
        if self.is_over {
            return;
        }
        let Some(found) = loader.find(pending, MissingAssetPolicy::Object) else {
            return;
        };
        // Load the asset the first time.
        let asset = self.cache.get_or_load(&found, || {
            let bytes = loader.loader.found(&found, MAX_BYTES, loader.map);
            let bytes = bytes.map_err(|error| {
                loader.unreadable(
                    &found,
                    &error.to_string(),
                    pending.span,
                    MissingAssetPolicy::Object,
                )
            });
            let file = add_asset(&found, bytes.ok()?, pending, loader)?;
            let options = FrontOptions {
                camera: None,
                up_axis: None,
                ..loader.options.clone()
            };
            let asset = gltf::lower(file, loader.map, &options, loader.sink)?;
            gltf::release(file, loader.map);
            Some(add(asset, lowered))
        });
        let Some(asset) = asset else { return };
        // Place it if the budget allows.
        match asset.charge(loader.map.budget()) {
            Ok(()) => asset.transform(DAffine3::from_cols_array_2d(&transform), pending, lowered),
            Err(fault) => {
                self.is_over = true;
                loader
                    .sink
                    .push(over_limit("the asset", &fault).at(pending.span, "placed here"));
            }
        }
    }
}

/// Adds the bytes of an asset to the source map if they are one. Otherwise diagnostics would quote
/// a file of another format.
fn add_asset(
    found: &FoundFile,
    bytes: Vec<u8>,
    pending: &PendingAsset,
    loader: &mut AssetLoader<'_>,
) -> Option<FileId> {
    if gltf::is_gltf("", &bytes) {
        return Some(loader.map.add_found(found, bytes));
    }
    let message = format!("`{}` is not a glTF asset", found.shown.display());
    loader.reject(
        Diagnostic::new(&codes::GLTF_NOT_JSON, message).at(pending.span, "named here"),
        MissingAssetPolicy::Object,
    );
    None
}

/// The number of images, textures, meshes and materials in the scene before an asset is added: the
/// offsets of the asset's indices.
struct IndexOffsets {
    images: u32,
    textures: u32,
    meshes: u32,
    materials: u32,
}

impl IndexOffsets {
    fn of(scene: &Scene) -> Self {
        let count = |count: usize| u32::try_from(count).unwrap_or(u32::MAX);
        Self {
            images: count(scene.images.len()),
            textures: count(scene.textures.len()),
            meshes: count(scene.meshes.len()),
            materials: count(scene.materials.len()),
        }
    }

    /// Records the spans of the asset's entities under their new indices.
    fn record(&self, asset: &LoweredScene, source_spans: &mut SourceSpans) {
        let Scene {
            images,
            textures,
            meshes,
            materials,
            ..
        } = &asset.scene;
        for (entity, offsets, count) in [
            (EntityKind::Image, self.images, images.len()),
            (EntityKind::Texture, self.textures, textures.len()),
            (EntityKind::Mesh, self.meshes, meshes.len()),
            (EntityKind::Material, self.materials, materials.len()),
        ] {
            for index in 0..count {
                let transform =
                    ValuePath::new(entity, offsets as usize + index, EntityField::Whole);
                let source = ValuePath::new(entity, index, EntityField::Whole);
                source_spans.record(transform, asset.source_spans.span(source));
            }
        }
    }

    fn texture(&self, texture: Texture) -> Texture {
        match texture {
            Texture::Uv | Texture::Procedural(_) => texture,
            Texture::Image(ImageId(image)) => Texture::Image(ImageId(image + self.images)),
            Texture::Sampled(mut sampled) => {
                sampled.image.0 += self.images;
                Texture::Sampled(sampled)
            }
        }
    }

    fn material(&self, mut material: Material) -> Material {
        if let Material::Standard(standard) = &mut material {
            standard
                .maps_mut()
                .for_each(|map| map.texture = TextureId(map.texture.0 + self.textures));
            if let Some(MaterialId(other)) = &mut standard.blend_with {
                *other += self.materials;
            }
        }
        material
    }

    fn surface(&self, mut surface: Surface) -> Surface {
        if let Shape::Instance(instance) = &mut surface.shape {
            instance.mesh = MeshId(instance.mesh.0 + self.meshes);
        }
        surface.material.0 += self.materials;
        surface
    }
}

/// Adds the images, textures, meshes and materials of an asset to a scene.
fn add(asset: LoweredScene, lowered: &mut LoweredScene) -> ImportedAsset {
    let LoweredScene {
        scene,
        source_spans,
    } = lowered;
    let offsets = IndexOffsets::of(scene);
    offsets.record(&asset, source_spans);
    let source = asset.scene;
    let textures = source.textures.into_iter();
    let materials = source.materials.into_iter();
    let surfaces = source.surfaces.into_iter();
    scene.images.extend(source.images);
    scene
        .textures
        .extend(textures.map(|source| offsets.texture(source)));
    scene.meshes.extend(source.meshes);
    scene
        .materials
        .extend(materials.map(|source| offsets.material(source)));
    ImportedAsset {
        surfaces: surfaces.map(|source| offsets.surface(source)).collect(),
        names: source.names,
        lights: source.lights,
    }
}

impl ImportedAsset {
    /// Charges the budget for one more placement.
    fn charge(&self, budget: &Budget) -> Result<(), LimitExceeded> {
        let names = self.names.iter().map(|name| name.len() as u64).sum::<u64>();
        let lights = size_of::<Light>() as u64 * self.lights.len() as u64;
        let surfaces = self.surfaces.len() as u64;
        budget.charge(Resource::Surfaces, surfaces)?;
        budget.charge(Resource::Memory, surfaces * gltf::SURFACE + names + lights)
    }

    /// Adds the surfaces and lights of the asset, transformed by `world`.
    fn transform(&self, world: DAffine3, pending: &PendingAsset, lowered: &mut LoweredScene) {
        let LoweredScene {
            scene,
            source_spans,
        } = lowered;
        if !self.names.is_empty() || !scene.names.is_empty() {
            scene.names.resize(scene.surfaces.len(), String::new());
            scene.names.extend(self.names.iter().cloned());
            scene
                .names
                .resize(scene.surfaces.len() + self.surfaces.len(), String::new());
        }
        for surface in &self.surfaces {
            let mut surface = surface.clone();
            if let Shape::Instance(instance) = &mut surface.shape {
                let source = DAffine3::from_cols_array_2d(&instance.world_from_object);
                instance.world_from_object = (world * source).to_cols_array_2d();
                let velocity = Vec3::from_array(surface.velocity.get());
                surface.velocity = (world.matrix3 * velocity).to_array().into();
            }
            source_spans.record(
                ValuePath::new(
                    EntityKind::Surface,
                    scene.surfaces.len(),
                    EntityField::Whole,
                ),
                pending.span,
            );
            scene.surfaces.push(surface);
        }
        for light in &self.lights {
            source_spans.record(
                ValuePath::new(EntityKind::Light, scene.lights.len(), EntityField::Whole),
                pending.span,
            );
            scene.lights.push(transformed(light, world));
        }
    }
}

/// A light transformed by `world`. As in glTF, its intensity and range are not scaled.
fn transformed(light: &Light, world: DAffine3) -> Light {
    // A light of glTF projects no texture.
    let Light::Punctual(Punctual {
        emitter,
        intensity,
        projected: _,
    }) = light
    else {
        return light.clone();
    };
    let mut emitter = emitter.clone();
    let transform = |point| world.transform_point3(Vec3::from_array(point)).to_array();
    let rotation_keys = |direction| {
        world
            .transform_vector3(Vec3::from_array(direction))
            .to_array()
    };
    emitter.transform(transform, rotation_keys, 1.0);
    Light::Punctual(Punctual::new(emitter, *intensity))
}
