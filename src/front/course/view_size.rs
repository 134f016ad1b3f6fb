//! The size of the image in pixels, in all notations.

use super::decode::{Decode, DecodeContext, Spanned};
use super::lower::Lowering;
use super::number::{PixelCount, json_number, plain_number};
use super::record::{FieldResult, record};
use super::schema::SchemaDefinitions;
use super::settings::Scene;
use super::value::tuple;
use rtc_diag::{Severity, codes};
use rtc_source::tree::NodeId;
use serde_json::{Value as Json, json};

record! {
    /// Width and height of the image in pixels.
    struct SizeMap, "size" {
        /// The width, the height.
        sides: [Spanned<PixelCount>; 2], required,
            &[&["width", "height"], &["x", "y"], &["w", "h"]];
    }
}

record! {
    /// The first of two maps with the size of the image.
    struct Width, "width" {
        /// The width in pixels.
        side: Spanned<PixelCount>, required, &[&["width"], &["x"], &["w"]];
    }
}

record! {
    /// The second of two maps with the size of the image.
    struct Height, "height" {
        /// The height in pixels.
        side: Spanned<PixelCount>, required, &[&["height"], &["y"], &["h"]];
    }
}

/// Width and height of the image in pixels: a list of two numbers, a map, a list of maps, or one
/// number for a square.
#[derive(Clone, Copy, Debug)]
pub(super) struct ViewSize(pub(super) [u32; 2]);

impl Decode for ViewSize {
    const IS_LIST: bool = true;

    fn decode(node: NodeId, context: &mut DecodeContext<'_>) -> Option<Self> {
        let tree = context.tree;
        if plain_number(node, context).is_some() {
            return square_size(node, context);
        }
        if tree.is_map(node) {
            return SizeMap::decode(node, context).map(size_of_map);
        }
        let mut items = tree.items(node).filter(|_| tree.is_list(node));
        let is_map = |item: &NodeId| tree.is_map(*item);
        match [items.next(), items.next(), items.next()] {
            [Some(only), None, None] if is_map(&only) => {
                SizeMap::decode(only, context).map(size_of_map)
            }
            [Some(first), Some(second), None] if is_map(&first) && is_map(&second) => {
                let width = Width::decode(first, context);
                let height = Height::decode(second, context);
                Some(Self([width?.side.value.0, height?.side.value.0]))
            }
            [Some(only), None, None] if plain_number(only, context).is_some() => {
                square_size(only, context)
            }
            _ => {
                const WHAT: &str = "a list of two whole numbers";
                tuple(node, WHAT, context, PixelCount::decode)
                    .map(|sides| Self(sides.map(|side| side.0)))
            }
        }
    }

    fn schema(definitions: &mut SchemaDefinitions) -> Json {
        let side = PixelCount::schema(definitions);
        let one = [SizeMap::schema(definitions)];
        let two = [Width::schema(definitions), Height::schema(definitions)];
        json!({ "anyOf": [
            { "type": "array", "items": side, "minItems": 2, "maxItems": 2 },
            side,
            { "type": "array", "items": side, "minItems": 1, "maxItems": 1, "deprecated": true },
            one[0],
            { "type": "array", "prefixItems": one, "minItems": 1, "maxItems": 1 },
            { "type": "array", "prefixItems": two, "minItems": 2, "maxItems": 2 },
        ] })
    }

    fn json(&self) -> Json {
        self.0.map(|side| json_number(side.into())).to_vec().into()
    }
}

/// One number for both sides.
fn square_size(node: NodeId, context: &mut DecodeContext<'_>) -> Option<ViewSize> {
    PixelCount::decode(node, context).map(|side| ViewSize([side.0; 2]))
}

fn size_of_map(
    SizeMap {
        sides: [width, height],
    }: SizeMap,
) -> ViewSize {
    ViewSize([width.value.0, height.value.0])
}

impl Lowering {
    /// Reports sizes without effect. Call it after the camera is lowered.
    pub(super) fn report_unused_sizes(&self, scene: &Scene, context: &mut DecodeContext<'_>) {
        let Scene {
            camera,
            image_size,
            aspect_ratio,
            ..
        } = scene;
        // A size beside a `Camera`.
        let [width, height] = self.scene.camera.size;
        if let (
            FieldResult::Read(_),
            FieldResult::Read(Spanned {
                value,
                span: Some(span),
            }),
        ) = (camera, image_size)
        {
            if value.0.contains(&0) {
                let message = || "the sides of a picture are at least 1 pixel".to_owned();
                context.report(&codes::OUT_OF_RANGE, *span, message, |d| {
                    d.at(*span, "0 here")
                });
            }
            let is_same = value.0 == [width, height];
            let message =
                || format!("the size of the image is that of the `Camera`: {width} × {height}");
            context.report(&codes::NO_EFFECT, *span, message, |d| {
                d.at(*span, "no effect").severity(severity(is_same))
            });
        }
        if let FieldResult::Read(Spanned {
            value,
            span: Some(span),
        }) = aspect_ratio
        {
            let ratio = f64::from(width) / f64::from(height);
            let is_same = (value.0 - ratio).abs() <= TOLERANCE * ratio;
            let message =
                || format!("the picture has {width} × {height} pixels, all of them square");
            context.report(&codes::NO_EFFECT, *span, message, |d| {
                d.at(*span, "no effect")
                    .severity(severity(is_same))
                    .hint("`viewSize` of the `Camera`, or `ImageSize`, is its width and height")
            });
        }
    }
}

/// The relative tolerance of an aspect ratio.
const TOLERANCE: f64 = 0.01;

/// A key without effect is only a note if its value agrees with the image.
fn severity(is_same: bool) -> Severity {
    if is_same {
        Severity::Note
    } else {
        Severity::Warning
    }
}
