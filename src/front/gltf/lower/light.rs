//! Punctual lights (`KHR_lights_punctual`): they point along their negative z axis, and scale has
//! no effect. `extras.rtc` holds lights without falloff and photometric profiles.

use super::super::field::ObjectFields;
use super::Lowering;
use glam::DAffine3;
use rtc_ir::{
    EntityField, EntityKind, Light, Photometry, PointLight, Punctual, PunctualKind, ValuePath,
};
use rtc_math::{Vec3, unit};
use rtc_source::tree::NodeId;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

impl Lowering<'_, '_, '_> {
    /// Lowers the light at a node with the transform `world`.
    pub(super) fn light(&mut self, light: NodeId, world: DAffine3) {
        let fields = ObjectFields::new(self.report.json, light).animated(&self.materials.animated);
        let intensity = fields.number_or("intensity", 1.0);
        let position = world.translation.to_array();
        let backward = unit(world.z_axis).unwrap_or(Vec3::ZERO);
        // A light with the extras of rtc keeps exactly what they hold.
        if let Some(measured) = fields
            .rtc_extras()
            .and_then(|extras| light_extras(extras, world))
        {
            return self.add_light(light, measured);
        }
        // A punctual light shines along its local -z axis.
        let range = fields.number("range").filter(|range| *range > 0.0);
        let emitter = match fields.text("type").as_deref() {
            Some("directional") if backward != Vec3::ZERO => PunctualKind::Sun {
                direction: backward.to_array(),
            },
            Some("point") => PunctualKind::Point { position, range },
            Some("spot") if backward != Vec3::ZERO => {
                let angle = |key, default| {
                    fields
                        .object("spot")
                        .map_or(default, |spot| spot.number_or(key, default))
                };
                let outer_angle: f64 = angle("outerConeAngle", FRAC_PI_4);
                let outer_angle = outer_angle.min(FRAC_PI_2);
                let inner_angle = angle("innerConeAngle", 0.0);
                PunctualKind::Spot {
                    position,
                    direction: (-backward).to_array(),
                    inner_angle,
                    outer_angle,
                    range,
                }
            }
            _ => return,
        };
        // The radiant or luminous intensity scales the colour.
        let color = fields
            .vector_or("color", [1.0; 3])
            .map(|channel| channel * intensity);
        let punctual = Punctual::new(emitter, color);
        self.add_light(light, Light::Punctual(punctual));
    }

    fn add_light(&mut self, at: NodeId, light: Light) {
        let place = ValuePath::new(
            EntityKind::Light,
            self.scene.lights.len(),
            EntityField::Whole,
        );
        self.source_spans.record(place, self.report.json.span(at));
        self.scene.lights.push(light);
    }
}

/// A light that glTF can't express.
fn light_extras(extras: ObjectFields<'_, '_>, world: DAffine3) -> Option<Light> {
    let position = world.translation.to_array();
    if let Some(point) = extras.object("point") {
        return Some(Light::Point(PointLight {
            position,
            color: point.vector("color")?,
            radius: point.number_or("radius", 0.0),
        }));
    }
    let measured = extras.object("photometry")?;
    let photometry = Photometry {
        name: measured.text("name").unwrap_or_default(),
        vertical: measured.numbers("vertical")?,
        horizontal: measured.numbers("horizontal")?,
        candela: measured.numbers("candela")?,
    };
    let axis = |axis: Vec3| unit(axis).unwrap_or(Vec3::ZERO);
    let emitter = PunctualKind::Photometric {
        position,
        direction: (-axis(world.z_axis)).to_array(),
        horizontal: axis(world.x_axis).to_array(),
        photometry: Box::new(photometry),
    };
    let intensity = measured.vector("factor")?;
    Some(Light::Punctual(Punctual::new(emitter, intensity)))
}
