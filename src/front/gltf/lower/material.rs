//! Materials: factors and textures of glTF and of its extensions. Each material is lowered once.

use super::super::document::Document;
use super::super::field::ObjectFields;
use super::super::pointer::AnimatedValues;
use super::super::primitive::Primitive;
use super::super::report::AssetReport;
use super::pattern::add_patterns;
use super::tangent::TangentCoords;
use super::texture::LoweredTextures;
use super::uv::TexCoordSets;
use rtc_diag::codes;
use rtc_ir::{
    self as ir, Alpha, Bump, Conductor, EntityField, EntityKind, Map, MaterialId, Phong, Scene,
    SourceSpans, Standard, ValuePath,
};
use rtc_math::{Medium, to_u32};
use rtc_source::tree::SyntaxTree;
use rtc_tables::MATERIAL_EXTENSIONS;
use serde::de::DeserializeOwned;
use std::any::Any;
use std::collections::{BTreeMap, BTreeSet};

/// What became of the materials of the asset.
pub(super) struct ImportedMaterials {
    /// The properties of all parts that an animation has moved.
    pub(super) animated: AnimatedValues,
    made: Vec<Option<MaterialId>>,
    /// The default material of primitives.
    default: Option<MaterialId>,
    textures: LoweredTextures,
    /// The sets of texture coordinates that materials look at, where these are not the first two.
    uv_sets: BTreeMap<u32, TexCoordSets>,
    /// The materials whose tangents follow the surface, by `extras.rtc`.
    surface_tangents: BTreeSet<u32>,
    /// The materials of points and lines, by that of their primitive and whether they have normals.
    point_and_line_materials: BTreeMap<(u32, bool), MaterialId>,
}

/// The material that a primitive has in a variant.
pub(super) fn chosen(
    primitive: &Primitive,
    variant: Option<usize>,
    json: &SyntaxTree<'_>,
) -> Option<usize> {
    let variant = variant?;
    let mappings = ObjectFields::new(json, primitive.at).extension("KHR_materials_variants")?;
    let mapping = mappings
        .objects("mappings")
        .find(|mapping| mapping.indices("variants").contains(&variant))?;
    mapping.index("material")
}

impl ImportedMaterials {
    pub(super) fn new(doc: &Document<'_>, animated: AnimatedValues) -> Self {
        Self {
            animated,
            made: vec![None; doc.materials.len()],
            default: None,
            textures: LoweredTextures::new(doc),
            uv_sets: BTreeMap::new(),
            surface_tangents: BTreeSet::new(),
            point_and_line_materials: BTreeMap::new(),
        }
    }

    /// The sets of texture coordinates that the material uses.
    pub(super) fn uv_sets(&self, material: MaterialId) -> TexCoordSets {
        self.uv_sets.get(&material.0).copied().unwrap_or_default()
    }

    /// The material for points and lines whose primitives have `material`, and whether its emission
    /// was removed.
    pub(super) fn point_and_line_material(
        &mut self,
        material: MaterialId,
        is_lit: bool,
        scene: &mut Scene,
    ) -> (MaterialId, bool) {
        let extension = scene.materials.get(material.0 as usize);
        let Some(ir::Material::Standard(extension)) = extension else {
            return (material, false);
        };
        let loses_light = !is_lit && !extension.unlit && extension.emissive != [0.0; 3];
        let next = MaterialId(to_u32(scene.materials.len()));
        let id = *self
            .point_and_line_materials
            .entry((material.0, is_lit))
            .or_insert(next);
        if id == next {
            let copy = Standard {
                double_sided: true,
                unlit: extension.unlit || !is_lit,
                normal_map: None,
                clearcoat_normal_map: None,
                anisotropy: 0.0,
                ..(**extension).clone()
            };
            scene.materials.push(ir::Material::Standard(Box::new(copy)));
        }
        (id, loses_light)
    }

    /// An image of the document that need not be one of a texture; none if it can't be read.
    pub(super) fn image(
        &mut self,
        doc: &Document<'_>,
        index: usize,
        scene: &mut Scene,
        source_spans: &mut SourceSpans,
        report: &AssetReport<'_, '_>,
    ) -> Option<ir::ImageId> {
        self.textures.image(doc, index, scene, source_spans, report)
    }

    /// What the tangents of the material follow, if it uses them.
    pub(super) fn tangent_coords(
        &self,
        material: MaterialId,
        scene: &Scene,
    ) -> Option<TangentCoords> {
        match scene.materials.get(material.0 as usize)? {
            ir::Material::Standard(standard) => {
                let is_of_surface = self.surface_tangents.contains(&material.0);
                let coords = TangentCoords::of(standard);
                coords.map(|coords| match is_of_surface {
                    true => TangentCoords::SURFACE,
                    false => coords,
                })
            }
            ir::Material::Phong(_) => None,
        }
    }

    /// The material of the index given, or the one that glTF has where none is.
    pub(super) fn make(
        &mut self,
        doc: &Document<'_>,
        material: Option<usize>,
        scene: &mut Scene,
        source_spans: &mut SourceSpans,
        report: &mut AssetReport<'_, '_>,
    ) -> MaterialId {
        // Each material is lowered once.
        let known = material.map_or(self.default, |material| self.made[material]);
        if let Some(known) = known {
            return known;
        }
        // The other materials of a blend come before it.
        let mut chain: Vec<usize> = material.into_iter().collect();
        while let Some(other) = chain.last().and_then(|last| blended(doc, *last, report))
            && chain.len() < MOST_BLENDED
        {
            chain.push(other);
        }
        for other in chain.iter().skip(1).rev() {
            if self.made[*other].is_none() {
                self.make_one(doc, Some(*other), scene, source_spans, report);
            }
        }
        self.make_one(doc, material, scene, source_spans, report)
    }

    fn make_one(
        &mut self,
        doc: &Document<'_>,
        material: Option<usize>,
        scene: &mut Scene,
        source_spans: &mut SourceSpans,
        report: &mut AssetReport<'_, '_>,
    ) -> MaterialId {
        let id = MaterialId(to_u32(scene.materials.len()));
        let mut standard = match material {
            None => Standard::default(),
            Some(material) => {
                let fields = ObjectFields::new(report.json, doc.materials[material])
                    .animated(&self.animated);
                let extras = fields.rtc_extras();
                if extras.is_some_and(|extras| extras.boolean("surfaceTangents")) {
                    self.surface_tangents.insert(id.0);
                }
                let mut reader = MaterialReader {
                    doc,
                    textures: &mut self.textures,
                    scene,
                    source_spans,
                    report,
                };
                // A Phong material is stored in extras.
                if let Some(phong) = reader.phong(fields) {
                    let place = ValuePath::new(
                        EntityKind::Material,
                        scene.materials.len(),
                        EntityField::Whole,
                    );
                    source_spans.record(place, report.json.span(fields.at));
                    scene.materials.push(ir::Material::Phong(phong));
                    self.made[material] = Some(id);
                    return id;
                }
                let mut standard = reader.material(fields);
                if let Some(other) = blended(doc, material, report) {
                    standard.blend_with = self.made[other];
                }
                standard
            }
        };
        // Two sets of texture coordinates at most remain in a material.
        let (sets, lost) = TexCoordSets::choose(&mut standard);
        if sets != TexCoordSets::default() {
            self.uv_sets.insert(id.0, sets);
        }
        if let (Some(lost), Some(material)) = (lost, material) {
            let [first, second] = sets.names();
            let message = format!(
                "textures use more than two sets of texture coordinates: `{first}` and `{second}` \
                are kept, and `{first}` replaces `TEXCOORD_{lost}`"
            );
            let at = doc.materials[material];
            let hint = "let the textures share two sets".to_owned();
            report.add_with_hint(&codes::GLTF_MATERIAL_ODD, "", at, message, hint);
        }
        // Record the origin and store the material.
        if let Some(material) = material {
            let place = ValuePath::new(
                EntityKind::Material,
                scene.materials.len(),
                EntityField::Whole,
            );
            source_spans.record(place, report.json.span(doc.materials[material]));
        }
        scene
            .materials
            .push(ir::Material::Standard(Box::new(standard)));
        match material {
            Some(material) => self.made[material] = Some(id),
            None => self.default = Some(id),
        }
        id
    }
}

/// The most materials of a blend.
const MOST_BLENDED: usize = 16;

/// The other material of a blend in `extras.rtc`, an earlier one.
fn blended(doc: &Document<'_>, material: usize, report: &AssetReport<'_, '_>) -> Option<usize> {
    let fields = ObjectFields::new(report.json, doc.materials[material]);
    let other = fields.rtc_extras()?.index("blendWith");
    other.filter(|other| *other < material)
}

/// Reads materials, bringing the textures they name.
struct MaterialReader<'m, 'd, 'r, 's> {
    doc: &'m Document<'d>,
    textures: &'m mut LoweredTextures,
    scene: &'m mut Scene,
    source_spans: &'m mut SourceSpans,
    report: &'m mut AssetReport<'r, 's>,
}

impl MaterialReader<'_, '_, '_, '_> {
    /// Reads the extensions whose properties are parameters unchanged; an absent property leaves
    /// the default.
    fn extensions(&mut self, fields: ObjectFields<'_, '_>, standard: &mut Standard) {
        for (name, properties) in MATERIAL_EXTENSIONS {
            let Some(extension) = fields.extension(name) else {
                continue;
            };
            for (key, _, parameter) in *properties {
                let Some(parameter) = standard.parameter_mut(parameter) else {
                    continue;
                };
                if let Some(map) = parameter.downcast_mut::<Option<Map>>() {
                    *map = self.map(Some(extension), key);
                } else if let Some(number) = parameter.downcast_mut::<f64>() {
                    *number = extension.number_or(key, *number);
                } else if let Some(color) = parameter.downcast_mut::<[f64; 3]>() {
                    *color = extension.vector_or(key, *color);
                } else if let Some(distance) = parameter.downcast_mut::<Option<f64>>() {
                    *distance = extension.number(key);
                }
            }
        }
    }

    fn map(&mut self, fields: Option<ObjectFields<'_, '_>>, key: &str) -> Option<Map> {
        let info = fields?.object(key)?;
        self.textures
            .map(self.doc, info, self.scene, self.source_spans, self.report)
    }

    fn material(&mut self, fields: ObjectFields<'_, '_>) -> Standard {
        let pbr = fields.object("pbrMetallicRoughness");
        let strength = extension(fields, "emissive_strength").map_or(1.0, |extension| {
            extension.number_or("emissiveStrength", 1.0)
        });
        let normal = fields.object("normalTexture");
        // Read the metallic-roughness model of the core specification.
        let mut standard = Standard {
            name: fields.name(),
            base_color: pbr
                .and_then(|pbr| pbr.vector("baseColorFactor"))
                .unwrap_or([1.0; 4]),
            base_color_map: self.map(pbr, "baseColorTexture"),
            metallic: number(pbr, "metallicFactor", 1.0),
            roughness: number(pbr, "roughnessFactor", 1.0),
            metallic_roughness_map: self.map(pbr, "metallicRoughnessTexture"),
            emissive: fields
                .vector_or("emissiveFactor", [0.0; 3])
                .map(|channel| channel * strength),
            emissive_map: self.map(Some(fields), "emissiveTexture"),
            normal_map: self.map(Some(fields), "normalTexture"),
            normal_scale: number(normal, "scale", 1.0),
            alpha: match fields.text("alphaMode").as_deref() {
                Some("MASK") => Alpha::Mask(fields.number_or("alphaCutoff", 0.5)),
                Some("BLEND") => Alpha::Blend,
                _ => Alpha::Opaque,
            },
            double_sided: fields.boolean("doubleSided"),
            unlit: extension(fields, "unlit").is_some(),
            ..Standard::default()
        };
        // Extensions replace parameters of it or add layers.
        self.specular_glossiness(fields, &mut standard);
        self.extensions(fields, &mut standard);
        let coat =
            extension(fields, "clearcoat").and_then(|coat| coat.object("clearcoatNormalTexture"));
        standard.clearcoat_normal_scale = number(coat, "scale", 1.0);
        self.iridescence(fields, &mut standard);
        conductor(fields, &mut standard);
        facets(fields, &mut standard);
        let extension = fields.rtc_extras();
        standard.opacity_map = self.map(extension, "opacityTexture");
        standard.bump_map = self.map(extension, "bumpTexture");
        standard.bump_scale = number(extension, "bumpScale", 1.0);
        standard.blend_weight = number(extension, "blendWeight", 0.0);
        standard.blend_map = self.map(extension, "blendTexture");
        for (parameter, map) in self.patterns(fields) {
            let parameter = standard.parameter_mut(&parameter);
            if let Some(own) = parameter.and_then(<dyn Any>::downcast_mut::<Option<Map>>) {
                *own = Some(map);
            }
        }
        standard
    }

    /// The patterns of a material, each with the parameter whose map it is.
    fn patterns(&mut self, fields: ObjectFields<'_, '_>) -> Vec<(String, Map)> {
        let span = self.report.json.span(fields.at);
        add_patterns(fields, span, (&mut *self.scene, &mut *self.source_spans))
    }

    /// The Phong material in `extras.rtc`, if any.
    fn phong(&mut self, fields: ObjectFields<'_, '_>) -> Option<Phong> {
        let extension = fields.rtc_extras()?.object("phong")?;
        let patterns = self.patterns(fields);
        let mut texture = |key| {
            let is_own = |(parameter, _): &&(String, Map)| parameter == key;
            if let Some((_, pattern)) = patterns.iter().find(is_own) {
                return Some(pattern.texture);
            }
            let index = extension.index(key)?;
            self.textures
                .of_phong(self.doc, index, self.scene, self.source_spans, self.report)
        };
        let matt = Phong::MATT;
        Some(Phong {
            color: extension.vector("color")?,
            ka: extension.number_or("ka", matt.ka),
            kd: extension.number_or("kd", matt.kd),
            ks: extension.number_or("ks", matt.ks),
            kr: extension.number("kr"),
            n: extension.number_or("n", matt.n),
            kt: extension.number_or("kt", matt.kt),
            fresnel: extension.boolean("fresnel"),
            ior: extension.number_or("eta", matt.ior),
            glossy_samples: extension.count_or("glossySamples", matt.glossy_samples),
            color_map: texture("colorMap"),
            specular_map: texture("specularMap"),
            normal_map: texture("normalMap"),
            bump: texture("bumpMap").map(|texture| Bump {
                texture,
                height: extension.number_or("bumpHeight", 1.0),
            }),
        })
    }

    fn specular_glossiness(&mut self, fields: ObjectFields<'_, '_>, standard: &mut Standard) {
        let extension = extension(fields, "pbrSpecularGlossiness");
        let Some(model) = extension else { return };
        let [r, g, b] = model.vector_or("specularFactor", [1.0; 3]);
        standard.specular_glossiness = Some([r, g, b, model.number_or("glossinessFactor", 1.0)]);
        standard.specular_glossiness_map = self.map(extension, "specularGlossinessTexture");
        standard.base_color = model.vector_or("diffuseFactor", [1.0; 4]);
        standard.base_color_map = self.map(extension, "diffuseTexture");
    }

    fn iridescence(&mut self, fields: ObjectFields<'_, '_>, standard: &mut Standard) {
        let extension = extension(fields, "iridescence");
        standard.iridescence = number(extension, "iridescenceFactor", 0.0);
        standard.iridescence_map = self.map(extension, "iridescenceTexture");
        standard.iridescence_ior = number(extension, "iridescenceIor", 1.3);
        let thickness = |key, default| number(extension, key, default);
        standard.iridescence_thickness = [
            thickness("iridescenceThicknessMinimum", 100.0),
            thickness("iridescenceThicknessMaximum", 400.0),
        ];
        standard.iridescence_thickness_map = self.map(extension, "iridescenceThicknessTexture");
    }
}

/// The index of a metal in `extras.rtc`, with the base colour, which viewers see otherwise.
fn conductor(fields: ObjectFields<'_, '_>, standard: &mut Standard) {
    let extension = fields.rtc_extras().and_then(|rtc| rtc.object("conductor"));
    let Some(extension) = extension else { return };
    let Some((eta, k)) = extension.vector("eta").zip(extension.vector("k")) else {
        return;
    };
    standard.conductor = Some(Conductor { eta, k });
    let [r, g, b, alpha] = standard.base_color;
    let [r, g, b] = extension.vector_or("baseColor", [r, g, b]);
    standard.base_color = [r, g, b, alpha];
}

/// The distribution of facets, the kind of plastic and the sides in `extras.rtc`.
fn facets(fields: ObjectFields<'_, '_>, standard: &mut Standard) {
    let Some(extension) = fields.rtc_extras() else {
        return;
    };
    standard.microfacets = keyword(extension, "microfacets");
    standard.plastic = keyword(extension, "plastic");
    standard.black_back = extension.boolean("blackBack");
    standard.thin_dielectric = extension.boolean("thinDielectric");
    standard.interior = medium(extension, "interior");
    standard.exterior = medium(extension, "exterior");
}

/// A participating medium in `extras.rtc`.
pub(super) fn medium(extension: ObjectFields<'_, '_>, key: &str) -> Option<Medium> {
    let medium = extension.object(key)?;
    Some(Medium {
        sigma_a: medium.vector_or("sigmaA", [0.0; 3]),
        sigma_s: medium.vector_or("sigmaS", [0.0; 3]),
        g: medium.number_or("g", 0.0),
    })
}

/// The value of a property that names one; its default for any other text.
fn keyword<T: DeserializeOwned + Default>(fields: ObjectFields<'_, '_>, key: &str) -> T {
    let text = fields.text(key);
    text.and_then(|text| serde_json::from_value(text.into()).ok())
        .unwrap_or_default()
}

/// The object of a `KHR_materials_*` extension.
fn extension<'t, 's>(fields: ObjectFields<'t, 's>, name: &str) -> Option<ObjectFields<'t, 's>> {
    fields.extension(&format!("KHR_materials_{name}"))
}

fn number(fields: Option<ObjectFields<'_, '_>>, key: &str, default: f64) -> f64 {
    fields.map_or(default, |fields| fields.number_or(key, default))
}
