//! The textures of a `standard` material: images with the placement and sampling of glTF.

use super::super::decode::{Decode, DecodeContext, Spanned};
use super::super::keyword::{keyword, keyword_schema};
use super::super::lower::Lowering;
use super::super::pattern::{FileOrPattern, PatternTexture, pattern_word};
use super::super::reader::look_up;
use super::super::record::{FieldResult, record};
use super::super::rotation::PlaneRows;
use super::super::schema::SchemaDefinitions;
use super::super::value::{FileName, tuple};
use super::value::SetIndex;
use crate::course::keyword::{Keyword, KeywordTable};
use rtc_ir::{self as ir, Filter, Wrap};
use rtc_source::Span;
use rtc_source::tree::{NodeContent, NodeId};
use serde_json::{Value as Json, json};

record! {
    /// A texture: an image and its placement on the surface. v = 0 is the top row. A file name
    /// alone is a texture too.
    struct TextureMap, "texture" {
        /// The image file: PNG, JPEG, WebP, KTX2, EXR or HDR; its alpha channel is used.
        file: Spanned<FileName>, required, &[&["file"]];
        /// The set of texture coordinates of the mesh, 0 or 1.
        set: Spanned<SetIndex>, default(SetIndex(0)), &[&["set"]];
        /// The wrap mode beyond the image along u and v, one keyword for both or a list of two:
        /// `repeat` the image, `mirror` it, or `clamp` to the texels of its edge.
        wrap: Spanned<WrapModes>, default(WrapModes([Wrap::Repeat; 2])), &[&["wrap"]];
        /// The filter: `linear` blends the four nearest texels, `nearest` uses the nearest one.
        filter: Spanned<Filter>, default(Filter::Linear), &[&["filter"]];
        /// Six numbers: the rows (a, b, c) of the map from texture coordinates of the surface to
        /// those of the image, each a·u + b·v + c.
        transform: Spanned<PlaneRows>, optional, &[&["transform"]];
    }
}

/// An image with its placement, the name of its file alone, or a pattern.
pub(crate) enum MapOrFile {
    Image(TextureMap),
    Pattern(Box<PatternTexture>),
}

impl Decode for MapOrFile {
    fn decode(node: NodeId, context: &mut DecodeContext<'_>) -> Option<Self> {
        if context.tree.is_map(node) {
            return if look_up("pattern", node, context).is_some() {
                PatternTexture::decode(node, context).map(|map| Self::Pattern(Box::new(map)))
            } else {
                TextureMap::decode(node, context).map(Self::Image)
            };
        }
        if let Some(pattern) = pattern_word(node, context) {
            return Some(Self::Pattern(Box::new(pattern)));
        }
        let span = Some(context.tree.span(node));
        let value = FileName::decode(node, context)?;
        Some(Self::Image(TextureMap {
            file: Spanned { value, span },
            set: Spanned::without_span(SetIndex(0)),
            wrap: Spanned::without_span(WrapModes([Wrap::Repeat; 2])),
            filter: Spanned::without_span(Filter::Linear),
            transform: FieldResult::Absent,
        }))
    }

    fn schema(definitions: &mut SchemaDefinitions) -> Json {
        let [file, word, pattern] = FileOrPattern::variants(definitions);
        let image = TextureMap::schema(definitions);
        json!({ "title": "file, texture or pattern", "anyOf": [file, image, word, pattern] })
    }
}

/// The wrap modes along u and v.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WrapModes([Wrap; 2]);

/// The keywords of wrap modes.
const WRAPS: KeywordTable<Wrap> = &[
    ("repeat", Wrap::Repeat, "The image again and again."),
    (
        "mirror",
        Wrap::Mirror,
        "The image, and every other time its mirror image.",
    ),
    ("clamp", Wrap::Clamp, "The texels of its edge."),
];

impl Decode for WrapModes {
    const IS_LIST: bool = true;

    fn decode(node: NodeId, context: &mut DecodeContext<'_>) -> Option<Self> {
        if context.tree.shape(node) == NodeContent::List {
            let each = |node, context: &mut DecodeContext<'_>| keyword(node, WRAPS, context);
            return tuple(node, "a word or a list of two", context, each).map(Self);
        }
        keyword(node, WRAPS, context).map(|wrap| Self([wrap; 2]))
    }

    fn schema(_: &mut SchemaDefinitions) -> Json {
        let keyword = keyword_schema(WRAPS);
        let pair = json!({ "type": "array", "items": keyword, "minItems": 2, "maxItems": 2 });
        json!({ "anyOf": [keyword, pair] })
    }

    fn json(&self) -> Json {
        let keyword = WRAPS.iter().find(|(_, wrap, _)| *wrap == self.0[0]);
        keyword.map_or(Json::Null, |(keyword, ..)| json!(keyword))
    }
}

impl Keyword for Filter {
    const KEYWORDS: KeywordTable<Self> = &[
        ("linear", Filter::Linear, "Blends the four nearest texels."),
        (
            "nearest",
            Filter::Nearest,
            "The nearest texel, with hard edges.",
        ),
    ];
}

impl Lowering {
    /// Lowers a texture; its file is added to the pending assets.
    pub(super) fn texture_map(&mut self, map: &MapOrFile, span: Option<Span>) -> ir::Map {
        let map = match map {
            MapOrFile::Image(map) => map,
            MapOrFile::Pattern(pattern) => {
                return ir::Map {
                    texture: self.pattern(pattern, span),
                    set: pattern.set.value.0,
                    texture_from_surface: pattern.transform.read().map(|rows| rows.value.0),
                };
            }
        };
        let TextureMap {
            file,
            set,
            wrap,
            filter,
            transform,
        } = map;
        let sampling = (wrap.value.0, filter.value);
        ir::Map {
            texture: self.files.sampled(&mut self.scene, file, sampling),
            set: set.value.0,
            texture_from_surface: transform.read().map(|rows| rows.value.0),
        }
    }
}
