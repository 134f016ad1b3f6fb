//! The textures of a `standard` material: pictures, as glTF lays them on a surface and looks them up.

use super::super::decode::{Context, Spanned, Value};
use super::super::keyword::{keyword, keyword_schema};
use super::super::lower::Lowering;
use super::super::record::{FieldOutcome, keys, record};
use super::super::rotation::PlaneRows;
use super::super::schema::Definitions;
use super::super::value::{FileName, tuple};
use super::value::SetIndex;
use crate::course::keyword::Keyword;
use rtc_ir::{self as ir, Filter, Wrap};
use rtc_source::tree::{NodeContent, NodeId};
use serde_json::{Value as Json, json};

record! {
    /// A texture: a picture, and how it lies on the surface. v = 0 is its top row. The name of the file alone will do.
    struct TextureMap, "texture" {
        /// The file of the picture: PNG, JPEG or WebP; its opacity is kept.
        file: Spanned<FileName>, required, keys!["file"];
        /// Which set of texture coordinates of the mesh, 0 or 1.
        set: Spanned<SetIndex>, default(SetIndex(0)), keys!["set"];
        /// What lies beyond the picture along u and v, one word for both or a list of two: `repeat` it again, `mirror` it
        /// again, mirrored, `clamp` the texel at its edge.
        wrap: Spanned<WrapModes>, default(WrapModes([Wrap::Repeat; 2])), keys!["wrap"];
        /// How texels blend: `linear` the four nearest, `nearest` the nearest alone.
        filter: Spanned<Filter>, default(Filter::Linear), keys!["filter"];
        /// Six numbers: the rows (a, b, c) of the map from the coordinates of the surface to those of the picture, each
        /// a·u + b·v + c.
        transform: Spanned<PlaneRows>, optional, keys!["transform"];
    }
}

/// A texture, or the name of its file alone.
pub(in crate::course) struct MapOrFile(pub(super) TextureMap);

impl Value for MapOrFile {
    fn decode(node: NodeId, context: &mut Context<'_>) -> Option<Self> {
        if context.tree.is_map(node) {
            return TextureMap::decode(node, context).map(Self);
        }
        let span = Some(context.tree.span(node));
        let value = FileName::decode(node, context)?;
        Some(Self(TextureMap {
            file: Spanned { value, span },
            set: Spanned::unwritten(SetIndex(0)),
            wrap: Spanned::unwritten(WrapModes([Wrap::Repeat; 2])),
            filter: Spanned::unwritten(Filter::Linear),
            transform: FieldOutcome::Absent,
        }))
    }

    fn schema(definitions: &mut Definitions) -> Json {
        json!({ "anyOf": [FileName::schema(definitions), TextureMap::schema(definitions)] })
    }
}

/// What lies beyond a picture along u and v.
#[derive(Clone, Copy, Debug)]
pub(in crate::course) struct WrapModes([Wrap; 2]);

/// The words for it.
const WRAPS: &[(&str, Wrap)] = &[
    ("repeat", Wrap::Repeat),
    ("mirror", Wrap::Mirror),
    ("clamp", Wrap::Clamp),
];

impl Value for WrapModes {
    const IS_LIST: bool = true;

    fn decode(node: NodeId, context: &mut Context<'_>) -> Option<Self> {
        if context.tree.shape(node) == NodeContent::List {
            let each = |node, context: &mut Context<'_>| keyword(node, WRAPS, context);
            return tuple(node, "a word or a list of two", context, each).map(Self);
        }
        keyword(node, WRAPS, context).map(|wrap| Self([wrap; 2]))
    }

    fn schema(_: &mut Definitions) -> Json {
        let keyword = keyword_schema(WRAPS);
        json!({ "anyOf": [keyword, { "type": "array", "items": keyword, "minItems": 2, "maxItems": 2 }] })
    }

    fn json(&self) -> Json {
        let keyword = WRAPS.iter().find(|(_, wrap)| *wrap == self.0[0]);
        keyword.map_or(Json::Null, |(keyword, _)| json!(keyword))
    }
}

impl Keyword for Filter {
    const KEYWORDS: &'static [(&'static str, Self)] =
        &[("linear", Filter::Linear), ("nearest", Filter::Nearest)];
}

impl Lowering {
    /// Lowers a texture: its file is wanted.
    pub(super) fn texture_map(&mut self, map: &TextureMap) -> ir::Map {
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
            texture_from_surface: match transform {
                FieldOutcome::Read(rows) => Some(rows.value.0),
                FieldOutcome::Absent | FieldOutcome::Broken => None,
            },
        }
    }
}
