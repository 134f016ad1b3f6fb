//! Procedural textures: patterns in closed form, instead of an image file.

use super::decode::{Decode, DecodeContext, Spanned};
use super::keyword::{Keyword, KeywordTable, keyword_schema};
use super::number::{NonNegative, integer, json_number, ranged};
use super::record::{FieldResult, record};
use super::rotation::PlaneRows;
use super::schema::SchemaDefinitions;
use super::standard::SetIndex;
use super::value::{Color, FileName, tuple};
use rtc_diag::{Severity, codes};
use rtc_ir::Procedural;
use rtc_math::{GradientNoise, TextureMapping, TexturePattern};
use rtc_source::tree::{NodeContent, NodeId};
use serde_json::{Value as Json, json};

/// Black and white.
const COLORS: ColorPair = ColorPair([Color([0.0; 3]), Color([1.0; 3])]);
const SCALE: NonNegative = NonNegative(8.0);
const SEED: Seed = Seed(0);
const OCTAVES: Octaves = Octaves(4);

record! {
    /// A pattern as a texture. Its keyword alone is a texture with the defaults.
    struct PatternTexture, "pattern" {
        /// `checker`: cubes of the two colours in turn; `stripes`: slabs across the first axis;
        /// `noise`: gradient noise between the colours; `worley`: the distance to the nearest of
        /// random points, one in each cell.
        pattern: Spanned<PatternKind>, required, &[&["pattern"]];
        /// The two colours, each red, green, blue; noise and distances blend them.
        colors: Spanned<ColorPair>, default(COLORS), &[&["colors"]];
        /// The number of cells per unit of the coordinates: 8 cells across texture coordinates from
        /// 0 to 1, for `mapping: world` the cells per scene unit.
        scale: Spanned<NonNegative>, default(SCALE), &[&["scale"]];
        /// The coordinates of the pattern: `uv` are the texture coordinates of the surface; `world`
        /// is the point in space, for surfaces without texture coordinates, too.
        mapping: Spanned<TextureMapping>, default(TextureMapping::Uv), &[&["mapping"]];
        /// The seed of `noise` and `worley`: another number is another picture.
        seed: Spanned<Seed>, default(SEED), &[&["seed"]];
        /// The number of octaves of `noise`: each has twice the frequency and half the weight of
        /// the one before.
        octaves: Spanned<Octaves>, default(OCTAVES), &[&["octaves"]];
        /// The set of texture coordinates of the mesh, 0 or 1, in a `standard` material.
        set: Spanned<SetIndex>, default(SetIndex(0)), &[&["set"]];
        /// Six numbers, in a `standard` material: the rows (a, b, c) of the map from texture
        /// coordinates of the surface to those of the pattern, each a·u + b·v + c.
        transform: Spanned<PlaneRows>, optional, &[&["transform"]];
    }
}

/// Which pattern.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PatternKind {
    Checker,
    Stripes,
    Noise,
    Worley,
}

impl Keyword for PatternKind {
    const KEYWORDS: KeywordTable<Self> = &[
        (
            "checker",
            Self::Checker,
            "Cubes of the two colours in turn.",
        ),
        ("checkerboard", Self::Checker, ""),
        (
            "stripes",
            Self::Stripes,
            "Slabs of the two colours in turn, across the first axis.",
        ),
        (
            "noise",
            Self::Noise,
            "Gradient noise, which blends the two colours.",
        ),
        (
            "worley",
            Self::Worley,
            "The distance to the nearest of random points, one in each cell.",
        ),
    ];
}

impl Keyword for TextureMapping {
    const KEYWORDS: KeywordTable<Self> = &[
        (
            "uv",
            Self::Uv,
            "Over the texture coordinates of the surface.",
        ),
        ("world", Self::World, "In space, as if cut out of a block."),
    ];
}

ranged! {
    /// The seed of a random pattern.
    Seed(u32), |node, context| integer(0, u32::MAX, node, context),
    { "type": "integer", "minimum": 0, "maximum": 4_294_967_295_u32 }
}

ranged! {
    /// The number of octaves of noise.
    Octaves(u32), |node, context| integer(1, GradientNoise::MAX_OCTAVES, node, context),
    { "type": "integer", "minimum": 1, "maximum": 16 }
}

/// Two colours.
#[derive(Clone, Copy, Debug)]
pub(super) struct ColorPair([Color; 2]);

impl Decode for ColorPair {
    const IS_LIST: bool = true;

    fn decode(node: NodeId, context: &mut DecodeContext<'_>) -> Option<Self> {
        tuple(node, "a list of two colours", context, Color::decode).map(Self)
    }

    fn schema(definitions: &mut SchemaDefinitions) -> Json {
        let color = Color::schema(definitions);
        json!({ "type": "array", "items": color, "minItems": 2, "maxItems": 2 })
    }

    fn json(&self) -> Json {
        self.0
            .map(|Color(color)| color.map(json_number))
            .to_vec()
            .into()
    }
}

impl PatternTexture {
    /// A pattern with the defaults, for its keyword.
    fn of(pattern: PatternKind) -> Self {
        Self {
            pattern: Spanned::without_span(pattern),
            colors: Spanned::without_span(COLORS),
            scale: Spanned::without_span(SCALE),
            mapping: Spanned::without_span(TextureMapping::Uv),
            seed: Spanned::without_span(SEED),
            octaves: Spanned::without_span(OCTAVES),
            set: Spanned::without_span(SetIndex(0)),
            transform: FieldResult::Absent,
        }
    }

    /// Reports a placement in a Phong material, which has none.
    fn report_placement(&self, context: &mut DecodeContext<'_>) {
        let transform = self.transform.read().and_then(|rows| rows.span);
        for (key, span) in [("set", self.set.span), ("transform", transform)] {
            let Some(span) = span else { continue };
            let message = || format!("`{key}` of a pattern has no effect in a Phong material");
            context.report(&codes::NO_EFFECT, span, message, |d| {
                d.at(span, "only for textures of a `standard` material")
                    .severity(Severity::Warning)
            });
        }
    }

    /// The texture in the IR.
    pub(super) fn lowered(&self) -> Procedural {
        let (Seed(seed), Octaves(octaves)) = (self.seed.value, self.octaves.value);
        let ColorPair(colors) = self.colors.value;
        Procedural {
            pattern: match self.pattern.value {
                PatternKind::Checker => TexturePattern::Checker,
                PatternKind::Stripes => TexturePattern::Stripes,
                PatternKind::Noise => TexturePattern::Noise(GradientNoise { seed, octaves }),
                PatternKind::Worley => TexturePattern::Worley { seed },
            },
            colors: colors.map(|Color(color)| color),
            scale: self.scale.value.0,
            mapping: self.mapping.value,
        }
    }
}

/// The texture of a Phong material: an image file, or a pattern.
pub(super) enum FileOrPattern {
    File(FileName),
    Pattern(Box<PatternTexture>),
}

impl Decode for FileOrPattern {
    fn decode(node: NodeId, context: &mut DecodeContext<'_>) -> Option<Self> {
        if context.tree.is_map(node) {
            let pattern = PatternTexture::decode(node, context)?;
            pattern.report_placement(context);
            return Some(Self::Pattern(Box::new(pattern)));
        }
        if let Some(pattern) = pattern_word(node, context) {
            return Some(Self::Pattern(Box::new(pattern)));
        }
        FileName::decode(node, context).map(Self::File)
    }

    fn schema(definitions: &mut SchemaDefinitions) -> Json {
        json!({ "title": "file or pattern", "anyOf": Self::variants(definitions) })
    }
}

impl FileOrPattern {
    /// The schemas of a file, of the keyword of a pattern, and of its map.
    pub(super) fn variants(definitions: &mut SchemaDefinitions) -> [Json; 3] {
        let word = keyword_schema(PatternKind::KEYWORDS);
        [
            FileName::schema(definitions),
            word,
            PatternTexture::schema(definitions),
        ]
    }
}

/// The pattern that a keyword names. In quotes it is a file, except in JSON, where all text is.
pub(super) fn pattern_word(node: NodeId, context: &DecodeContext<'_>) -> Option<PatternTexture> {
    let word = match context.tree.shape(node) {
        NodeContent::Word(word) => word,
        NodeContent::Text(text) if context.is_json() => text,
        NodeContent::Text(_) | NodeContent::List | NodeContent::Map => return None,
    };
    let mut words = PatternKind::KEYWORDS.iter();
    let (_, pattern, _) = words.find(|(known, ..)| known.eq_ignore_ascii_case(word))?;
    Some(PatternTexture::of(*pattern))
}
