//! Writes lights: `KHR_lights_punctual`, and other values in `extras.rtc`.

use super::document::{self, GltfIndex, Spot};
use super::material::strength;
use super::writer::{GltfWriter, extras, lit};
use crate::export::NOT_PROJECTED;
use rtc_diag::codes;
use rtc_ir::{
    EntityField, EntityKind, Light, Photometry, PointLight, Punctual, PunctualKind, ValuePath,
};
use rtc_math::{OrthonormalBasis, Vec3, unit};
use serde_json::{Map as JsonObject, Value, json};

/// A light in terms of glTF.
struct GltfLight {
    kind: &'static str,
    intensity: [f64; 3],
    range: Option<f64>,
    /// The inner and the outer angle.
    angles: Option<[f64; 2]>,
    rtc_extras: JsonObject<String, Value>,
    /// The transform from the light, which points along its −z axis, to the world.
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
            .map_or(Vec3::ZERO, |sphere| sphere.center);
        for (index, light) in scene.lights.iter().enumerate() {
            let path = ValuePath::new(EntityKind::Light, index, EntityField::Whole);
            let light = match light {
                Light::Point(point) => self.course_light(point, middle, path),
                Light::Punctual(punctual) => self.punctual(punctual, middle, path),
            };
            self.light(light);
        }
    }

    /// A light of the course has no falloff: one that lights the middle of the scene as much stands
    /// for it.
    fn course_light(&mut self, light: &PointLight, middle: Vec3, path: ValuePath) -> GltfLight {
        let PointLight {
            position,
            color,
            radius,
        } = light;
        self.reporter
            .in_extras("a light without falloff, with its radius,", path);
        let message = "a light without falloff becomes a point light that is equally bright at the centre of \
             the scene";
        self.reporter
            .report(&codes::GLTF_APPROXIMATED, message, path);
        let rtc_extras = json!({ "color": color, "radius": radius });
        GltfLight {
            kind: "point",
            intensity: light.intensity_at(middle.to_array()),
            range: None,
            angles: None,
            rtc_extras: JsonObject::from_iter([("point".to_owned(), rtc_extras)]),
            columns: placed(*position),
        }
    }

    fn punctual(&mut self, light: &Punctual, middle: Vec3, path: ValuePath) -> GltfLight {
        let Punctual {
            emitter,
            intensity,
            projected,
        } = light;
        if projected.is_some() {
            self.reporter
                .report(&codes::GLTF_APPROXIMATED, NOT_PROJECTED, path);
        }
        // glTF has directional, point and spot lights that shine along -z.
        let light = |kind, columns| GltfLight {
            kind,
            intensity: *intensity,
            range: emitter.range(),
            angles: None,
            rtc_extras: JsonObject::new(),
            columns,
        };
        match emitter {
            PunctualKind::Sun { direction } => light(
                "directional",
                pointing_from(middle.to_array(), *direction, None),
            ),
            PunctualKind::Point { position, range: _ } => light("point", placed(*position)),
            PunctualKind::Spot {
                position,
                direction,
                inner_angle,
                outer_angle,
                range: _,
            } => GltfLight {
                angles: Some([*inner_angle, *outer_angle]),
                ..light(
                    "spot",
                    pointing_from(*position, direction.map(|component| -component), None),
                )
            },
            // A photometric light becomes a uniform point light of its mean intensity.
            PunctualKind::Photometric {
                position,
                direction,
                horizontal,
                photometry,
            } => {
                let back = direction.map(|component| -component);
                let columns = pointing_from(*position, back, Some(*horizontal));
                self.photometric_light(light("point", columns), photometry, path)
            }
        }
    }

    /// An IES light: glTF gets a point light with the mean of its candelas.
    fn photometric_light(
        &mut self,
        light: GltfLight,
        photometry: &Photometry,
        path: ValuePath,
    ) -> GltfLight {
        let Photometry {
            name,
            vertical,
            horizontal,
            candela,
        } = photometry;
        self.reporter.in_extras("how a lamp was measured", path);
        let message = "an IES light becomes a uniform point light";
        self.reporter
            .report(&codes::GLTF_APPROXIMATED, message, path);
        let mean = candela.iter().sum::<f64>() / (candela.len().max(1) as f64);
        let rtc_extras = json!({
            "name": name,
            "factor": light.intensity,
            "vertical": vertical,
            "horizontal": horizontal,
            "candela": candela,
        });
        GltfLight {
            intensity: light.intensity.map(|channel| channel * mean),
            rtc_extras: JsonObject::from_iter([("photometry".to_owned(), rtc_extras)]),
            ..light
        }
    }

    fn light(&mut self, light: GltfLight) {
        let GltfLight {
            kind,
            intensity,
            range,
            angles,
            rtc_extras,
            columns,
        } = light;
        self.root.extensions_used.insert("KHR_lights_punctual");
        let strength = strength(intensity);
        let light = document::Light {
            color: intensity.map(|channel| channel / strength),
            extras: extras(rtc_extras),
            intensity: strength,
            range,
            spot: angles.map(|[inner_cone_angle, outer_cone_angle]| Spot {
                inner_cone_angle,
                outer_cone_angle,
            }),
            kind,
        };
        let extensions = self.root.extensions.get_or_insert_default();
        let light = GltfIndex::push(&mut extensions.punctual.lights, light);
        self.node(lit(light), columns);
    }
}

/// The transform of a light without direction.
fn placed(position: [f64; 3]) -> [[f64; 3]; 4] {
    [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], position]
}

/// The transform of a light that points away from `back`, with its x axis towards `across` if
/// given.
fn pointing_from(position: [f64; 3], back: [f64; 3], across: Option<[f64; 3]>) -> [[f64; 3]; 4] {
    let z = unit(Vec3::from_array(back)).unwrap_or(Vec3::Z);
    let around = OrthonormalBasis::around(z);
    let x = across.and_then(|across| {
        let across = Vec3::from_array(across);
        unit(across - z * across.dot(z))
    });
    let x = x.unwrap_or(around.tangent);
    [x.to_array(), z.cross(x).to_array(), z.to_array(), position]
}
