//! Lights: `KHR_lights_punctual`, and in `extras.rtc` what it has no words for.

use super::document::{self, Index, Spot};
use super::material::strength;
use super::writer::{GltfWriter, extras, lit};
use rtc_diag::codes;
use rtc_ir::{Emitter, EntityKind, Field, Light, Photometry, PointLight, Punctual, ValuePath};
use rtc_math::{Basis, Vec3, unit};
use serde_json::{Map as Block, Value, json};
use std::f64::consts::PI;

/// A light as glTF has it.
struct Lamp {
    kind: &'static str,
    intensity: [f64; 3],
    range: Option<f64>,
    /// The inner and the outer angle.
    angles: Option<[f64; 2]>,
    own: Block<String, Value>,
    /// From the light, which shines along its −z axis, to the world.
    columns: [[f64; 3]; 4],
}

impl GltfWriter<'_> {
    /// Writes all lights.
    pub(super) fn lights(&mut self) {
        let scene = self.scene;
        if scene.lights.is_empty() {
            return;
        }
        let middle = scene
            .bounding_sphere()
            .map_or(Vec3::ZERO, |ball| ball.center);
        for (index, light) in scene.lights.iter().enumerate() {
            let place = ValuePath::new(EntityKind::Light, index, Field::Whole);
            let lamp = match light {
                Light::Point(point) => self.course_light(point, middle, place),
                Light::Punctual(punctual) => self.punctual(punctual, middle, place),
            };
            self.light(lamp);
        }
    }

    /// A light of the course has no falloff. Written is the one that lights the middle of the scene
    /// as much: a facing white Lambert surface there has the colour of the light as radiance.
    fn course_light(&mut self, light: &PointLight, middle: Vec3, place: ValuePath) -> Lamp {
        let PointLight {
            position,
            color,
            radius,
        } = light;
        self.told
            .own_words("a light without falloff, with its radius,", place);
        let message =
            "a light without falloff becomes one that lights the middle of the scene as much";
        self.told.tell(&codes::GLTF_NEARLY, message, place);
        let square = middle.distance_squared(Vec3::from_array(*position));
        let own = json!({ "color": color, "radius": radius });
        Lamp {
            kind: "point",
            intensity: color.map(|channel| channel * PI * square),
            range: None,
            angles: None,
            own: Block::from_iter([("point".to_owned(), own)]),
            columns: placed(*position),
        }
    }

    fn punctual(&mut self, light: &Punctual, middle: Vec3, place: ValuePath) -> Lamp {
        let Punctual { emitter, intensity } = light;
        let lamp = |kind, columns| Lamp {
            kind,
            intensity: *intensity,
            range: emitter.range(),
            angles: None,
            own: Block::new(),
            columns,
        };
        match emitter {
            Emitter::Sun { direction } => {
                lamp("directional", shining(middle.to_array(), *direction, None))
            }
            Emitter::Point { position, range: _ } => lamp("point", placed(*position)),
            Emitter::Spot {
                position,
                direction,
                inner_angle,
                outer_angle,
                range: _,
            } => Lamp {
                angles: Some([*inner_angle, *outer_angle]),
                ..lamp(
                    "spot",
                    shining(*position, direction.map(|along| -along), None),
                )
            },
            Emitter::Lamp {
                position,
                direction,
                horizontal,
                photometry,
            } => {
                let back = direction.map(|along| -along);
                let columns = shining(*position, back, Some(*horizontal));
                self.measured(lamp("point", columns), photometry, place)
            }
        }
    }

    /// A lamp as it was measured: glTF has the point with the mean of its candelas.
    fn measured(&mut self, lamp: Lamp, photometry: &Photometry, place: ValuePath) -> Lamp {
        let Photometry {
            name,
            vertical,
            horizontal,
            candela,
        } = photometry;
        self.told.own_words("how a lamp was measured", place);
        let message = "a measured lamp becomes a point that shines alike in all directions";
        self.told.tell(&codes::GLTF_NEARLY, message, place);
        let mean = candela.iter().sum::<f64>() / (candela.len().max(1) as f64);
        let own = json!({
            "name": name,
            "factor": lamp.intensity,
            "vertical": vertical,
            "horizontal": horizontal,
            "candela": candela,
        });
        Lamp {
            intensity: lamp.intensity.map(|channel| channel * mean),
            own: Block::from_iter([("photometry".to_owned(), own)]),
            ..lamp
        }
    }

    fn light(&mut self, lamp: Lamp) {
        let Lamp {
            kind,
            intensity,
            range,
            angles,
            own,
            columns,
        } = lamp;
        self.root.extensions_used.insert("KHR_lights_punctual");
        let strength = strength(intensity);
        let light = document::Light {
            color: intensity.map(|channel| channel / strength),
            extras: extras(own),
            intensity: strength,
            range,
            spot: angles.map(|[inner_cone_angle, outer_cone_angle]| Spot {
                inner_cone_angle,
                outer_cone_angle,
            }),
            kind,
        };
        let extensions = self.root.extensions.get_or_insert_default();
        let light = Index::push(&mut extensions.punctual.lights, light);
        self.node(lit(light), columns);
    }
}

/// Something without a direction.
fn placed(position: [f64; 3]) -> [[f64; 3]; 4] {
    [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], position]
}

/// Something that shines away from `back`, with its x axis towards `across` if that is given.
fn shining(position: [f64; 3], back: [f64; 3], across: Option<[f64; 3]>) -> [[f64; 3]; 4] {
    let z = unit(Vec3::from_array(back)).unwrap_or(Vec3::Z);
    let around = Basis::around(z);
    let x = across.and_then(|across| {
        let across = Vec3::from_array(across);
        unit(across - z * across.dot(z))
    });
    let x = x.unwrap_or(around.tangent);
    [x.to_array(), z.cross(x).to_array(), z.to_array(), position]
}
