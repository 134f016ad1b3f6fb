//! The Phong material, and the choice between it and the `standard` material.

use super::decode::{Decode, DecodeContext, SharedValue, Spanned};
use super::glass::{Glass, glass_setting, make_opaque, report_index_without_weight};
use super::keyword::{Keyword, KeywordTable, keyword_schema};
use super::lower::Lowering;
use super::number::{Count, NonNegative};
use super::pattern::{FileOrPattern, PatternTexture};
use super::reader::look_up;
use super::record::{FieldResult, HasRecord, record};
use super::schema::SchemaDefinitions;
use super::standard::{self, StandardMaterial};
use super::texture::add_texture;
use super::value::Color;
use rtc_diag::codes;
use rtc_ir::{self as ir, EntityField, EntityKind, MaterialId};
use rtc_source::Span;
use rtc_source::tree::NodeId;
use serde_json::{Value as Json, json};

record! {
    /// A material: Phong's reflection model with mirror reflection and refraction.
    struct PhongMaterial, "material" {
        /// The colour: red, green, blue.
        color: Spanned<Color>, optional, &[&["color"], &["colour"]], json "color";
        /// The image file of the colour; `UV` for the texture coordinates as the colours (u, 0,
        /// v); or a pattern: `checker`, `stripes`, `noise`, `worley`, or a map of its values. The
        /// other textures can be patterns, too.
        texture: Spanned<FileOrPattern>, optional, &[&["texture"]], json "texture";
        /// The image file of a bump map: its brightness is the height of the surface.
        bump: Spanned<FileOrPattern>, optional, &[&["bump"]], own true;
        /// The image file of a normal map: red to the right, green upwards, blue away from the
        /// surface.
        normal_map: Spanned<FileOrPattern>, optional, &[&["normalMap"]], own true;
        /// The image file whose red channel multiplies `ks`.
        specular_map: Spanned<FileOrPattern>, optional, &[&["specularMap"]], own true;
        /// The weight of the ambient light.
        ka: Spanned<NonNegative>, required, &[&["ka"], &["ambient"]], json "ka";
        /// The weight of the diffuse light.
        kd: Spanned<NonNegative>, required, &[&["kd"], &["diffuse"]], json "kd";
        /// The weight of the highlight, and of the mirror reflection where there is no `kr`; 1
        /// beside a `specularMap` that replaces it.
        ks: Spanned<NonNegative>, unless("specular_map"), &[&["ks"], &["specular"]], json "ks";
        /// The weight of the mirror reflection alone; `specularMap` does not scale it.
        kr: Spanned<NonNegative>, optional,
            &[&["kr"], &["reflect"], &["reflection"], &["reflectivity"], &["reflectance"],
                &["mirror"]], own true;
        /// The exponent of the highlight; a larger one makes it smaller and sharper.
        n: Spanned<NonNegative>, required,
            &[&["n"], &["shininess"], &["exponent"], &["specularExponent"]], json "n";
        /// The weight of the transmitted light; 0 is opaque.
        kt: Spanned<NonNegative>, default(NonNegative(0.0)), &[&["kt"], &["refract"]];
        /// The index of refraction, for instance 1.5 for glass; 0 is opaque.
        eta: Spanned<NonNegative>, default(NonNegative(1.0)),
            &[&["eta"], &["index"], &["nt"], &["ior"], &["refractiveIndex"], &["refractionIndex"]],
            json "nt";
        /// Whether `kt` is divided by Fresnel's equations, as in glass: a fraction is reflected,
        /// the rest transmitted (Schlick's approximation).
        fresnel: Spanned<bool>, default(false), &[&["fresnel"]], own true;
        /// In some files the kind of material: `refraction` is glass, a `kt` of 1 without `ka` and
        /// `kd`; `reflection` and `default` have a mirror reflection of weight `ks`, though in
        /// those files `default` has none.
        kind: Spanned<MaterialFinish>, optional, &[&["type"]], own true;
        /// In some files whether it is glass: `true` is a `kt` of 1 with `fresnel` besides its `ka`
        /// and `kd`, and no other mirror image; `false` a `kt` of 0.
        is_transparent: Spanned<bool>, optional, &[&["isTransparent"]], json "isTransparent";
        /// The number of rays of a glossy reflection; 1 is a sharp mirror.
        glossy_samples: Spanned<Count>, default(Count(1)), &[&["glossySamples"]];
    }
    variants { [color] [texture] [color texture] }
}

/// A material of either model.
pub(super) enum Material {
    Phong(Box<PhongMaterial>),
    Standard(Box<StandardMaterial>),
}

/// Whether a Phong material has this key. `type` is excluded, because other records have it too.
pub(super) fn is_material_key(key: &str) -> bool {
    let spellings = PhongMaterial::RECORD.fields.iter();
    let mut keys = spellings.flat_map(|field| field.spellings.iter().copied().flatten());
    key != KIND && keys.any(|known| *known == key)
}

/// The keyword of the `standard` material.
const STANDARD: KeywordTable<()> = &[(
    standard::KEYWORD,
    (),
    "A material with metalness and roughness, for path tracing.",
)];

/// The key that selects the model.
const KIND: &str = "type";

impl Decode for Material {
    fn decode(node: NodeId, context: &mut DecodeContext<'_>) -> Option<Self> {
        let is_map = context.tree.is_map(node);
        let kind = is_map.then(|| look_up(KIND, node, context)).flatten();
        let keyword = kind.and_then(|kind| context.tree.text(kind));
        if keyword.is_some_and(|keyword| keyword.eq_ignore_ascii_case(standard::KEYWORD)) {
            return StandardMaterial::decode(node, context)
                .map(|material| Self::Standard(Box::new(material)));
        }
        PhongMaterial::decode(node, context).map(|material| Self::Phong(Box::new(material)))
    }

    fn schema(definitions: &mut SchemaDefinitions) -> Json {
        let standard = keyword_schema(STANDARD);
        json!({
            "if": { "type": "object", "properties": { KIND: standard }, "required": [KIND] },
            "then": StandardMaterial::schema(definitions),
            "else": PhongMaterial::schema(definitions),
        })
    }
}

/// The kind of a material in some files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum MaterialFinish {
    Default,
    Reflection,
    Refraction,
}

impl Keyword for MaterialFinish {
    const KEYWORDS: KeywordTable<Self> = &[
        (
            "default",
            MaterialFinish::Default,
            "A mirror reflection of weight `ks`.",
        ),
        (
            "reflection",
            MaterialFinish::Reflection,
            "A mirror reflection of weight `ks`.",
        ),
        (
            "refraction",
            MaterialFinish::Refraction,
            "Glass: a `kt` of 1 without `ka` and `kd`.",
        ),
    ];
}

/// The material of a mesh without one.
const GREY: ir::Phong = ir::Phong {
    color: [0.7; 3],
    ka: 0.2,
    kd: 0.8,
    ..ir::Phong::MATT
};

impl Lowering {
    /// Lowers a material; one that aliases share becomes one material. `None` if it is invalid,
    /// which is reported.
    pub(super) fn material(
        &mut self,
        material: &Spanned<SharedValue<Material>>,
        context: &mut DecodeContext<'_>,
    ) -> Option<MaterialId> {
        let SharedValue { node, value } = &material.value;
        if let Some(id) = self.shared.get(node) {
            return Some(*id);
        }
        let id = match value.as_ref()? {
            Material::Phong(phong) => self.phong_material(phong, material.span, context)?,
            Material::Standard(standard) => {
                let lowered = self.standard(standard);
                let id = self.add_material(lowered);
                self.record_span(
                    EntityKind::Material,
                    id.0 as usize,
                    EntityField::Whole,
                    material.span,
                );
                id
            }
        };
        self.shared.insert(*node, id);
        Some(id)
    }

    fn phong_material(
        &mut self,
        value: &PhongMaterial,
        span: Option<Span>,
        context: &mut DecodeContext<'_>,
    ) -> Option<MaterialId> {
        // The texture replaces an absent colour.
        let color = match (&value.color, &value.texture) {
            (FieldResult::Read(color), _) => *color,
            (FieldResult::Absent, _) => Spanned::without_span(Color([1.0; 3])),
            (FieldResult::Broken, _) => return None,
        };
        let mut phong = self.phong(value, color.value);
        // `isTransparent` is an older key for refraction.
        let mut glass = value.kt.span;
        let mut is_clear = false;
        match glass_setting(value) {
            Some((true, span)) if value.kt.span.is_none() => {
                (phong.kt, phong.ior) = refraction(1.0, value.eta.value.0);
                glass = Some(span);
                is_clear = value.is_transparent.is_absent();
                if !is_clear {
                    phong.fresnel = true;
                    phong.kr = phong.kr.or(Some(0.0));
                }
            }
            Some((false, span)) if value.kt.value.0 > 0.0 => make_opaque(&mut phong, span, context),
            Some(_) => {}
            None => report_index_without_weight(value, context),
        }
        // Report what has no effect.
        self.report_mirror(value, context);
        self.dependent.record_material(value, phong.ks);
        // Add the material with its origins.
        let lets_through = phong.kt > 0.0;
        let id = self.add_material(ir::Material::Phong(phong));
        if let (true, Some(span)) = (lets_through, glass) {
            self.glass.push(Glass { id, span, is_clear });
        }
        self.record_material_spans(id, value, span, color.span);
        Some(id)
    }

    fn phong(&mut self, material: &PhongMaterial, color: Color) -> ir::Phong {
        let PhongMaterial {
            color: _,
            texture,
            bump,
            normal_map,
            specular_map,
            ka,
            kd,
            ks,
            kr,
            n,
            kt,
            eta,
            fresnel,
            kind: _,
            is_transparent: _,
            glossy_samples,
        } = material;
        // Convert the refraction and look up the textures.
        let (kt, eta) = refraction(kt.value.0, eta.value.0);
        ir::Phong {
            color: color.0,
            ka: ka.value.0,
            kd: kd.value.0,
            ks: specular(ks).value.0,
            kr: kr.ok().map(|kr| kr.value.0),
            n: n.value.0,
            kt,
            fresnel: fresnel.value,
            ior: eta,
            glossy_samples: glossy_samples.value.0,
            color_map: self.texture(texture),
            specular_map: self.texture(specular_map),
            normal_map: self.texture(normal_map),
            bump: self.texture(bump).map(|texture| ir::Bump {
                texture,
                height: 1.0,
            }),
        }
    }

    /// Reports that `type: default` acts as a mirror here, if the image shows it.
    fn report_mirror(&self, material: &PhongMaterial, context: &mut DecodeContext<'_>) {
        let FieldResult::Read(Spanned {
            value: MaterialFinish::Default,
            span: Some(span),
        }) = material.kind
        else {
            return;
        };
        let shows =
            self.scene.settings.max_depth > 0 && self.scene.settings.mode == ir::Mode::Phong;
        let ks = specular(&material.ks);
        if shows && ks.value.0 > 0.0 && material.kr.is_absent() {
            let message = || "`type: default` mirrors by `ks` here".to_owned();
            context.report(&codes::KEY_READ_DIFFERENTLY, span, message, |d| {
                d.at(span, "no mirror in some programs")
                    .also(ks.span, "the weight of the mirror image")
                    .hint("a `ks` of 0 has no reflection and no highlight")
            });
        }
    }

    fn texture(&mut self, file: &FieldResult<Spanned<FileOrPattern>>) -> Option<ir::TextureId> {
        let FieldResult::Read(Spanned { value, span }) = file else {
            return None;
        };
        Some(match value {
            FileOrPattern::File(file) => self.files.texture(&mut self.scene, (file, *span)),
            FileOrPattern::Pattern(pattern) => self.pattern(pattern, *span),
        })
    }

    /// The texture of a pattern. Equal patterns are one texture.
    pub(super) fn pattern(
        &mut self,
        pattern: &PatternTexture,
        span: Option<Span>,
    ) -> ir::TextureId {
        let texture = ir::Texture::Procedural(pattern.lowered());
        let id = add_texture(&mut self.scene, texture);
        self.record_span(EntityKind::Texture, id.0 as usize, EntityField::Whole, span);
        id
    }

    fn record_material_spans(
        &mut self,
        id: MaterialId,
        material: &PhongMaterial,
        span: Option<Span>,
        color: Option<Span>,
    ) {
        let PhongMaterial {
            color: _,
            texture,
            bump,
            normal_map,
            specular_map,
            ka,
            kd,
            ks,
            kr,
            n,
            kt,
            eta,
            fresnel: _,
            kind: _,
            is_transparent: _,
            glossy_samples,
        } = material;
        // Record the origin of each number.
        for (field, span) in [
            (EntityField::Whole, span),
            (EntityField::Color, color),
            (EntityField::Ka, ka.span),
            (EntityField::Kd, kd.span),
            (EntityField::Ks, specular(ks).span),
            (EntityField::Kr, kr.ok().and_then(|kr| kr.span)),
            (EntityField::N, n.span),
            (EntityField::Kt, kt.span),
            (EntityField::Ior, eta.span),
            (EntityField::GlossySamples, glossy_samples.span),
        ] {
            self.record_span(EntityKind::Material, id.0 as usize, field, span);
        }
        // Record the origin of each texture.
        for (field, file) in [
            (EntityField::ColorMap, texture),
            (EntityField::SpecularMap, specular_map),
            (EntityField::NormalMap, normal_map),
            (EntityField::Bump, bump),
        ] {
            if let FieldResult::Read(file) = file {
                self.record_span(EntityKind::Material, id.0 as usize, field, file.span);
            }
        }
    }

    /// The material of objects without one.
    pub(super) fn grey(&mut self) -> MaterialId {
        let id = self
            .grey
            .unwrap_or_else(|| self.add_material(ir::Material::Phong(GREY)));
        self.grey = Some(id);
        id
    }

    pub(super) fn add_material(&mut self, material: ir::Material) -> MaterialId {
        let id = MaterialId(u32::try_from(self.scene.materials.len()).unwrap_or(u32::MAX));
        self.scene.materials.push(material);
        id
    }
}

/// The weight and the index of refraction in the IR. A weight or an index of 0 means no refraction;
/// the validator rejects negative ones.
fn refraction(kt: f64, eta: f64) -> (f64, f64) {
    let weight = if eta == 0.0 { kt.min(0.0) } else { kt };
    let ratio = if eta == 0.0 || (kt == 0.0 && eta > 0.0) {
        1.0
    } else {
        eta
    };
    (weight, ratio)
}

/// The weight of the highlight; 1 if only a texture gives it.
fn specular(ks: &FieldResult<Spanned<NonNegative>>) -> Spanned<NonNegative> {
    ks.ok().unwrap_or(Spanned::without_span(NonNegative(1.0)))
}
