//! Area lights: rectangles of points.

use super::decode::{Decode, DecodeContext, Spanned};
use super::light::Light;
use super::lower::Lowering;
use super::number::{integer, json_number};
use super::record::FieldResult;
use super::schema::SchemaDefinitions;
use super::value::tuple;
use rtc_ir::{self as ir, EntityField, EntityKind};
use rtc_math::{Vec3, cross, unit};
use rtc_source::tree::NodeId;
use serde_json::{Value as Json, json};

/// The largest number of cells along a side.
const MAX_CELLS: u32 = 64;

/// The number of cells of an area light along its width and its height: one number for both, or a
/// list of two.
#[derive(Clone, Copy, Debug)]
pub(super) struct AreaLightCells(pub(super) [u32; 2]);

impl Decode for AreaLightCells {
    const IS_LIST: bool = true;

    fn decode(node: NodeId, context: &mut DecodeContext<'_>) -> Option<Self> {
        if context.tree.is_list(node) {
            let each = |node, context: &mut DecodeContext<'_>| integer(1, MAX_CELLS, node, context);
            return tuple(node, "a list of two whole numbers", context, each).map(Self);
        }
        integer(1, MAX_CELLS, node, context).map(|count| Self([count; 2]))
    }

    fn schema(_: &mut SchemaDefinitions) -> Json {
        let count = json!({ "type": "integer", "minimum": 1, "maximum": MAX_CELLS });
        let pair = json!({ "type": "array", "items": count, "minItems": 2, "maxItems": 2 });
        json!({ "anyOf": [count, pair] })
    }

    fn json(&self) -> Json {
        json_number(self.0[0].into())
    }
}

impl Lowering {
    /// Lowers an area light: a point without falloff in the middle of each cell, which together
    /// have the colour of the light. Returns whether it is one.
    pub(super) fn area_light(&mut self, light: &Spanned<Light>) -> bool {
        let Light {
            position: FieldResult::Read(position),
            color: FieldResult::Read(color),
            width: FieldResult::Read(width),
            height: FieldResult::Read(height),
            direction,
            cells,
            ..
        } = &light.value
        else {
            return false;
        };
        // The sides of the rectangle span the plane across its direction.
        let direction = direction
            .read()
            .map_or(Vec3::NEG_Y, |direction| direction.value.0.into());
        let [along_width, along_height] = sides(direction);
        let AreaLightCells([columns, rows]) = cells.value;
        // A point light at the centre of each cell has an equal part of the colour.
        let count = f64::from(columns) * f64::from(rows);
        let center = Vec3::from_array(position.value.0);
        for row in 0..rows {
            for column in 0..columns {
                let offset =
                    |cell: u32, cells: u32| (f64::from(cell) + 0.5) / f64::from(cells) - 0.5;
                let place = center
                    + along_width * (offset(column, columns) * width.value.0)
                    + along_height * (offset(row, rows) * height.value.0);
                let index = self.scene.lights.len();
                self.scene.lights.push(ir::Light::Point(ir::PointLight {
                    position: place.to_array(),
                    color: color.value.0.map(|channel| channel / count),
                    radius: 0.0,
                }));
                // Record the origin of each value.
                for (field, span) in [
                    (EntityField::Whole, light.span),
                    (EntityField::Position, position.span),
                    (EntityField::Color, color.span),
                ] {
                    self.record_span(EntityKind::Light, index, field, span);
                }
            }
        }
        true
    }
}

/// The directions of width and height of a rectangle that faces a direction: the width is
/// horizontal; one that faces straight up or down has its width along x.
fn sides(direction: Vec3) -> [Vec3; 2] {
    let Some(normal) = unit(direction) else {
        return [Vec3::X, Vec3::Z];
    };
    let horizontal = cross(Vec3::Y, normal);
    match unit(horizontal) {
        Some(width) if horizontal.length() > 1e-9 => [width, cross(normal, width)],
        _ => [Vec3::X, Vec3::Z],
    }
}
