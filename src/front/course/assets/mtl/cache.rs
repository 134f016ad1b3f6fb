//! The MTL materials added to the scene, and the images that they need.

use super::super::mesh::MeshFile;
use super::super::{AssetTarget, PendingAsset};
use super::bake::PendingTextureBake;
use super::{LoadedLibrary, phong, standard};
use crate::mesh::mtl::{MtlMap, MtlMaterial, MtlValue};
use crate::mesh::{SpannedName, WordSpan};
use rtc_diag::{Diagnostic, DiagnosticSink, Severity, codes};
use rtc_ir::{
    Bump, EntityField, EntityKind, Image, ImageId, LoweredScene, Map, Material, MaterialId, Mode,
    Phong, Pixels, Sampled, Texture, TextureId, ValuePath, Wrap,
};
use rtc_source::Span;
use std::collections::BTreeMap;

/// The MTL materials added so far, with their pending images.
#[derive(Default)]
pub(crate) struct MtlCache {
    pub(crate) pending_assets: Vec<PendingAsset>,
    /// The textures to bake once the images are loaded.
    pub(crate) bakes: Vec<PendingTextureBake>,
    images: BTreeMap<(String, bool), ImageId>,
    textures: BTreeMap<(u32, Option<bool>), TextureId>,
    /// Statements without effect: the span of the first, the reason, and their number.
    unsupported: Option<(Span, String, usize)>,
    /// The span of a `Tr 1`.
    transparency: Option<Span>,
}

/// A map statement of a material, with its resolved path.
pub(super) struct MapReference<'a> {
    pub(super) path: String,
    pub(super) map: &'a MtlMap,
    pub(super) span: Span,
}

impl LoadedLibrary {
    /// Resolves a map statement of one of its materials.
    pub(super) fn map<'a>(&self, map: &'a MtlValue<MtlMap>) -> MapReference<'a> {
        MapReference {
            path: sibling_path(&self.path, &map.value.file),
            map: &map.value,
            span: map.at.span(self.file),
        }
    }
}

impl MtlCache {
    /// Adds a material to the scene.
    pub(super) fn add(
        &mut self,
        loaded: &LoadedLibrary,
        material: &MtlMaterial,
        lowered: &mut LoweredScene,
    ) -> MaterialId {
        if material.is_transparency_1 && !phong::is_glass(material) {
            let at = material.opacity.as_ref().map(|opacity| opacity.at);
            self.transparency = self.transparency.or(at.map(|at| at.span(loaded.file)));
        }
        let index = lowered.scene.materials.len();
        let material_ir = match lowered.scene.settings.mode {
            Mode::Path(_) => self.standard(loaded, material, id(index), lowered),
            Mode::Phong | Mode::Depth | Mode::Normal | Mode::Gooch(_) => {
                Material::Phong(self.phong(loaded, material, lowered))
            }
        };
        let LoweredScene {
            scene,
            source_spans,
        } = lowered;
        scene.materials.push(material_ir);
        let bump = material.bump.as_ref().map(|bump| bump.at);
        for (field, at) in [
            (EntityField::Whole, Some(material.at)),
            (EntityField::Bump, bump),
        ] {
            let span = at.map(|at| at.span(loaded.file));
            source_spans.record(ValuePath::new(EntityKind::Material, index, field), span);
        }
        MaterialId(id(index))
    }

    fn standard(
        &mut self,
        loaded: &LoadedLibrary,
        material: &MtlMaterial,
        index: u32,
        lowered: &mut LoweredScene,
    ) -> Material {
        for (at, what) in standard::unsupported(material) {
            self.add_unsupported(at.span(loaded.file), what);
        }
        let material_ir = standard::standard(material);
        let material_ir = self.with_maps(material_ir, loaded, material, MaterialId(index), lowered);
        Material::Standard(Box::new(material_ir))
    }

    fn phong(
        &mut self,
        loaded: &LoadedLibrary,
        material: &MtlMaterial,
        lowered: &mut LoweredScene,
    ) -> Phong {
        for (at, what) in beyond_phong(material) {
            self.add_unsupported(at.span(loaded.file), format!("{what} only in path tracing"));
        }
        let mut phong = phong::phong(material);
        let mut texture = |map: &Option<MtlValue<MtlMap>>| {
            let image = self.image(&loaded.map(map.as_ref()?), false, lowered);
            Some(self.texture(image, None, lowered))
        };
        phong.color_map = texture(&material.color_map);
        phong.specular_map = texture(&material.specular_map);
        phong.normal_map = texture(&material.normal_map);
        let bump = texture(&material.bump);
        phong.bump = bump.zip(material.bump.as_ref()).map(|(texture, map)| Bump {
            texture,
            height: map.value.height,
        });
        phong
    }

    /// Adds a material with one texture, for a mesh file that names a texture but no material.
    pub(super) fn add_textured(
        &mut self,
        mesh: &MeshFile,
        texture: &SpannedName,
        lowered: &mut LoweredScene,
    ) -> MaterialId {
        let loaded = LoadedLibrary {
            library: crate::mesh::mtl::MtlLibrary::default(),
            file: mesh.file,
            path: mesh.path.clone(),
        };
        let map = MtlValue {
            value: MtlMap::of(texture.text.clone()),
            at: texture.at,
        };
        let white = MtlValue {
            value: [1.0; 3],
            at: texture.at,
        };
        let material = MtlMaterial {
            at: texture.at,
            diffuse: Some(white),
            color_map: Some(map),
            ..MtlMaterial::default()
        };
        self.add(&loaded, &material, lowered)
    }

    /// Records a statement without effect.
    pub(super) fn add_unsupported(&mut self, span: Span, why: String) {
        self.unsupported.get_or_insert((span, why, 0)).2 += 1;
    }

    /// Reports statements without effect, and statements that programs interpret in two ways.
    pub(super) fn report(&mut self, sink: &mut DiagnosticSink) {
        if let Some((span, why, count)) = self.unsupported.take() {
            let message = match count {
                1 => format!("a statement of the MTL has no effect: {why}"),
                _ => format!("{count} statements of the MTL have no effect: {why}"),
            };
            sink.push(Diagnostic::new(&codes::BAD_MTL, message).at(span, "the first one"));
        }
        if let Some(span) = self.transparency.take() {
            let message = "`Tr 1` is read as opaque";
            let note =
                Diagnostic::new(&codes::KEY_READ_DIFFERENTLY, message).severity(Severity::Note);
            let note = note.at(span, "invisible in some programs");
            sink.push(note.hint("`d 1` is opaque and `d 0` invisible in all"));
        }
    }

    /// The image of a map statement, with or without alpha; one white pixel until the file is
    /// loaded.
    pub(super) fn image(
        &mut self,
        map: &MapReference<'_>,
        has_opacity: bool,
        lowered: &mut LoweredScene,
    ) -> ImageId {
        let key = (map.path.clone(), has_opacity);
        if let Some(known) = self.images.get(&key) {
            return *known;
        }
        let image = lowered.scene.add_image(Image {
            name: map.path.clone(),
            width: 1,
            height: 1,
            kind: Pixels::Rgb8,
            pixels: vec![255; 3].into(),
        });
        self.pending_assets.push(PendingAsset {
            target: match has_opacity {
                true => AssetTarget::Mask(image),
                false => AssetTarget::Map(image),
            },
            path: map.path.clone(),
            span: Some(map.span),
        });
        self.images.insert(key, image);
        image
    }

    /// The texture of an image: with the sampling of the course, or with that of glTF and the given
    /// wrap mode.
    pub(super) fn texture(
        &mut self,
        image: ImageId,
        wrap: Option<Wrap>,
        lowered: &mut LoweredScene,
    ) -> TextureId {
        let textures = &mut lowered.scene.textures;
        let clamps = wrap.map(|wrap| wrap == Wrap::Clamp);
        *self.textures.entry((image.0, clamps)).or_insert_with(|| {
            textures.push(match wrap {
                None => Texture::Image(image),
                Some(wrap) => Texture::Sampled(Sampled {
                    image,
                    wrap: [wrap; 2],
                    filter: rtc_ir::Filter::Linear,
                }),
            });
            TextureId(id(textures.len() - 1))
        })
    }

    /// A texture slot of a `standard` material, placed as the MTL says.
    pub(super) fn placement(
        &mut self,
        map: &MapReference<'_>,
        image: ImageId,
        lowered: &mut LoweredScene,
    ) -> Map {
        let placement = MapPlacement::of(map.map);
        Map {
            texture: self.texture(image, Some(placement.wrap), lowered),
            set: 0,
            texture_from_surface: Some(placement.texture_from_surface),
        }
    }
}

/// The placement of an image on a surface.
pub(super) struct MapPlacement {
    pub(super) wrap: Wrap,
    pub(super) texture_from_surface: [[f64; 3]; 2],
}

impl MapPlacement {
    pub(super) fn of(map: &MtlMap) -> Self {
        let ([u, v], [right, up]) = (map.scale, map.offset);
        Self {
            wrap: if map.clamps {
                Wrap::Clamp
            } else {
                Wrap::Repeat
            },
            // The first row of an image is its top.
            texture_from_surface: [[u, 0.0, right], [0.0, -v, 1.0 - up]],
        }
    }
}

/// The statements of a material that Phong's model cannot express.
fn beyond_phong(material: &MtlMaterial) -> Vec<(WordSpan, String)> {
    let m = material;
    // Find where the file states each kind of value.
    let number =
        |statement: &Option<MtlValue<f64>>| statement.as_ref().map(|statement| statement.at);
    let map =
        |statement: &Option<MtlValue<MtlMap>>| statement.as_ref().map(|statement| statement.at);
    let color = |statement: &Option<MtlValue<[f64; 3]>>, nothing: f64| {
        let statement = statement.as_ref();
        let statement =
            statement.filter(|statement| statement.value.iter().any(|channel| *channel != nothing));
        statement.map(|statement| statement.at)
    };
    let placement = |statement: &Option<MtlValue<MtlMap>>| {
        statement
            .as_ref()
            .and_then(|statement| statement.value.placed)
    };
    // List the statements that the Phong model does not show.
    let parts = [
        ("`Ke` shows", color(&m.emissive, 0.0)),
        ("`Tf` shows", color(&m.filter, 1.0)),
        ("`Pr` shows", number(&m.roughness)),
        ("`Pm` shows", number(&m.metallic)),
        ("`Ps` shows", number(&m.sheen)),
        ("`Pc` shows", number(&m.clearcoat)),
        ("`Pcr` shows", number(&m.clearcoat_roughness)),
        ("`aniso` shows", number(&m.anisotropy)),
        ("`anisor` shows", number(&m.anisotropy_rotation)),
        ("`map_d` shows", map(&m.opacity_map)),
        ("`map_Ke` shows", map(&m.emissive_map)),
        ("`map_Pr` shows", map(&m.roughness_map)),
        ("`map_Pm` shows", map(&m.metallic_map)),
        ("options of `map_Kd` show", placement(&m.color_map)),
        ("options of `map_Ks` show", placement(&m.specular_map)),
        ("options of `norm` show", placement(&m.normal_map)),
    ];
    let statement = parts.into_iter();
    statement
        .filter_map(|(what, at)| Some((at?, what.to_owned())))
        .collect()
}

/// The path of a file that the file at `path` names. Of an absolute path only the last component is
/// used.
pub(super) fn sibling_path(path: &str, name: &str) -> String {
    let name = name.replace('\\', "/");
    let is_absolute = name.starts_with('/') || name.as_bytes().get(1) == Some(&b':');
    let name = match name.rsplit_once('/') {
        Some((_, last)) if is_absolute => last,
        _ => &name,
    };
    match path.rsplit_once('/') {
        Some((folder, _)) => format!("{folder}/{name}"),
        None => name.to_owned(),
    }
}

/// An index of the IR.
fn id(index: usize) -> u32 {
    u32::try_from(index).unwrap_or(u32::MAX)
}
