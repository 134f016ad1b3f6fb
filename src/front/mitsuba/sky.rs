//! The emitters `sky`, `sun` and `sunsky`: an environment map and a distant light.

use super::Lowering;
use super::xml::PluginNode;
use crate::exchange::sky::{Sky, TimeAndPlace, solid_angle, sun_radiance};
use crate::over_limit;
use rtc_ir::{EntityKind, Environment, Image, Pixels, PunctualKind};
use rtc_math::{Vec3, cos, sin, unit};
use rtc_source::Resource;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// The size of the map of all directions.
const SIZE: [u32; 2] = [512, 256];

/// The aperture of the sun in degrees.
const APERTURE: f64 = 0.5358;

/// A widening of the sun from which its soft shadows are told to be missing.
const SOFT: f64 = 2.0;

/// The axes of a sky: right-handed, z points up.
struct SkyAxes {
    /// The rows of the map from the world.
    sky_from_world: [Vec3; 3],
    /// The direction to the sun in them.
    sun: Vec3,
}

impl<'run> Lowering<'run> {
    /// A sky, a sun, or both.
    pub(super) fn sky(&mut self, node: &'run PluginNode) {
        let Some(SkyAxes {
            sky_from_world,
            sun,
        }) = self.sky_axes(node)
        else {
            return self.unsupported(node, "its sun is below the horizon: it is left out");
        };
        self.report_sky(node);
        let turbidity = node.number("turbidity").unwrap_or(3.0);
        if !(1.0..=10.0).contains(&turbidity) {
            let message = "the turbidity of a sky is from 1 to 10: the nearest is shown";
            self.approximate(node.plugin.span, message);
        }
        let scale = |name| {
            node.number(name)
                .or_else(|| node.number("scale"))
                .unwrap_or(1.0)
        };
        if node.plugin.text != "sun" {
            let albedo = self.channel(node, "albedo", [0.3; 3], false).color;
            let sky = Sky::new(turbidity, albedo, sun.to_array());
            self.sky_map(node, &sky, sky_from_world, scale("sky_scale"));
        }
        let factor = scale("sun_scale");
        if node.plugin.text != "sky" && factor > 0.0 {
            // The power does not depend on the aperture of version 0, nor on that of version 3.
            let radiance = sun_radiance(turbidity, FRAC_PI_2 - rtc_math::acos(sun.z));
            let solid_angle = solid_angle(APERTURE) * factor;
            let [x, y, z] = sky_from_world;
            let direction = x * sun.x + y * sun.y + z * sun.z;
            let emitter = PunctualKind::Sun {
                direction: direction.to_array(),
            };
            self.light(node, emitter, radiance.map(|channel| channel * solid_angle));
        }
    }

    /// Reports what is left out.
    fn report_sky(&mut self, node: &PluginNode) {
        let widening = match (node.number("sun_radius_scale"), node.number("sun_aperture")) {
            (Some(scale), _) => scale,
            (None, Some(aperture)) => aperture / APERTURE,
            (None, None) => 1.0,
        };
        if node.plugin.text != "sky" && widening > SOFT {
            let message = "the sun is a point in the sky: its shadows are sharp";
            self.approximate(node.plugin.span, message);
        }
    }

    /// The axes of the sky and its sun; `None` for a sun below the horizon. Up is z, and in version
    /// 0 it was y.
    fn sky_axes(&mut self, node: &PluginNode) -> Option<SkyAxes> {
        let to_world = node.transform("to_world");
        let axes = to_world.orthonormal();
        let [x, y, z] = axes.unwrap_or([Vec3::X, Vec3::Y, Vec3::Z]);
        let is_old = node.version < 2;
        let sky_from_world = if is_old { [x, -z, y] } else { [x, y, z] };
        // It is given in the world.
        let given = node.vector("sun_direction").and_then(|direction| {
            let direction = Vec3::from_array(direction);
            unit(Vec3::from_array(
                sky_from_world.map(|axis| axis.dot(direction)),
            ))
        });
        let sun = given.unwrap_or_else(|| {
            let [zenith, azimuth] = time_and_place(node).sun();
            let (around, up) = (sin(zenith), cos(zenith));
            match is_old {
                true => Vec3::new(sin(azimuth) * around, cos(azimuth) * around, up),
                false => {
                    let angle = azimuth - PI;
                    Vec3::new(cos(angle) * around, sin(angle) * around, up)
                }
            }
        });
        (sun.z > 0.0).then_some(SkyAxes {
            sky_from_world,
            sun,
        })
    }

    /// Adds the environment map of a sky. The IR's map has y upwards and −z in its middle.
    fn sky_map(&mut self, node: &PluginNode, sky: &Sky, [x, y, z]: [Vec3; 3], scale: f64) {
        if self.scene.environment.is_some() {
            return self.unsupported(node, "a scene has one environment: the first one");
        }
        let [width, height] = SIZE;
        let bytes = 12 * u64::from(width) * u64::from(height);
        if let Err(limit) = self.map.budget().charge(Resource::Memory, bytes) {
            let diagnostic = over_limit("the sky", &limit);
            return self.sink.push(diagnostic.at(node.span, ""));
        }
        let mut pixels = Vec::with_capacity(12 * (width * height) as usize);
        for row in 0..height {
            let polar = (f64::from(row) + 0.5) / f64::from(height) * PI;
            for column in 0..width {
                let turn = (f64::from(column) + 0.5) / f64::from(width) - 0.5;
                let (around, angle) = (sin(polar), turn * TAU);
                let direction = [sin(angle) * around, cos(angle) * around, cos(polar)];
                for channel in sky.radiance(direction) {
                    #[expect(
                        clippy::cast_possible_truncation,
                        reason = "rounded to what the IR stores"
                    )]
                    pixels.extend((channel as f32).to_le_bytes());
                }
            }
        }
        self.record(EntityKind::Environment, 0, node.span);
        let image = self.scene.add_image(Image {
            name: String::new(),
            width,
            height,
            kind: Pixels::Rgb32f,
            pixels: pixels.into(),
        });
        self.record(EntityKind::Image, image.0 as usize, node.span);
        self.scene.environment = Some(Environment {
            radiance: [scale; 3],
            image: Some(image),
            image_from_world: Some([x, z, -y].map(|row| row.to_array())),
        });
    }
}

/// The time and place of a sky without a direction of its sun.
fn time_and_place(node: &PluginNode) -> TimeAndPlace {
    let number = |name, default| node.number(name).unwrap_or(default);
    TimeAndPlace {
        date: [
            number("year", 2010.0),
            number("month", 7.0),
            number("day", 10.0),
        ],
        hours: number("hour", 15.0) + (number("minute", 0.0) + number("second", 0.0) / 60.0) / 60.0,
        timezone: number("timezone", 9.0),
        latitude: number("latitude", 35.689),
        longitude: number("longitude", 139.6917),
    }
}
