//! Writes the shapes.

use super::{SceneWriter, quoted, triple};
use rtc_ir::{
    Cone, Cylinder, Disc, Ellipsoid, InfiniteCylinder, Instance, Paraboloid, Plane, Quad, Scene,
    Shape, Sphere, Torus, Triangle,
};
use rtc_math::{Vec3, axis_and_angle, rotated_to_z, shortest, unit};

impl<'s> SceneWriter<'s> {
    /// Writes a shape.
    ///
    /// # Errors
    /// A message, if the format can't express the shape.
    pub(super) fn shape(&mut self, shape: &Shape, scene: &'s Scene) -> Result<(), String> {
        match shape {
            Shape::Sphere(sphere) => return self.sphere(sphere),
            Shape::Triangle(triangle) => self.triangle(triangle),
            Shape::Quad(quad) => self.quad(quad),
            Shape::Instance(instance) => return self.instance(instance, scene),
            Shape::Ellipsoid(ellipsoid) => self.ellipsoid(ellipsoid),
            Shape::Csg(_) => {
                let message = "a CSG solid can only be written with all parts of its boundary";
                return Err(message.to_owned());
            }
            Shape::Plane(Plane { center, normal }) => {
                self.values("plane", &[("position", center), ("normal", normal)], &[]);
            }
            Shape::Disc(Disc {
                center,
                normal,
                radius,
            }) => {
                self.values(
                    "circle",
                    &[("center", center), ("normal", normal)],
                    &[("radius", radius)],
                );
            }
            Shape::Cylinder(Cylinder {
                base,
                axis,
                height,
                radius,
            }) => {
                self.values(
                    "cylinder",
                    &[("position", base), ("direction", axis)],
                    &[("height", height), ("radius", radius)],
                );
            }
            Shape::Cone(Cone { base, up, radius }) => {
                self.values(
                    "cone",
                    &[("position", base), ("up", up)],
                    &[("radius", radius)],
                );
            }
            Shape::Paraboloid(Paraboloid { base, up, radius }) => {
                self.values(
                    "paraboloid",
                    &[("position", base), ("up", up)],
                    &[("radius", radius)],
                );
            }
            Shape::Torus(Torus {
                center,
                axis,
                major,
                minor,
            }) => {
                self.values(
                    "torus",
                    &[("position", center), ("direction", axis)],
                    &[("radius", major), ("alpha", minor)],
                );
            }
            Shape::InfiniteCylinder(InfiniteCylinder {
                center,
                axis,
                radius,
            }) => {
                self.values(
                    "infiniteCylinder",
                    &[("position", center), ("direction", axis)],
                    &[("radius", radius)],
                );
            }
        }
        Ok(())
    }

    /// Writes a shape by the values of its keys.
    fn values(&mut self, kind: &str, vectors: &[(&str, &[f64; 3])], lengths: &[(&str, &f64)]) {
        self.kind(kind);
        for (key, vector) in vectors {
            self.numbers(key, vector, 4);
        }
        for (key, length) in lengths {
            self.number(key, **length, 4);
        }
    }

    fn kind(&mut self, word: &str) {
        self.line(2, &format!("- type: {word}"));
    }

    fn corners<const N: usize>(&mut self, corners: &[[f64; 3]; N]) {
        for (key, corner) in ["v0", "v1", "v2", "v3"].into_iter().zip(corners) {
            self.numbers(key, corner, 4);
        }
    }

    fn sphere(&mut self, sphere: &Sphere) -> Result<(), String> {
        let Sphere {
            center,
            radius,
            texture_from_world: rotation,
        } = sphere;
        self.kind("sphere");
        self.numbers("position", center, 4);
        let Some(rotation) = rotation else {
            self.number("radius", *radius, 4);
            return Ok(());
        };
        let rotation = axis_angle_of(*rotation)
            .ok_or("the texture of a sphere is turned as no axis and angle say to the last bit")?;
        let (axis, angle) = rotation;
        self.finite &= [*radius, angle]
            .iter()
            .chain(&axis)
            .all(|number| number.is_finite());
        self.line(
            4,
            &format!("radius: [{}, {}]", shortest(*radius), triple(axis)),
        );
        self.number("angle", angle, 4);
        Ok(())
    }

    fn triangle(&mut self, triangle: &Triangle) {
        let Triangle { vertices, uvs } = triangle;
        self.kind("triangle");
        self.corners(vertices);
        for (key, [u, v]) in ["uv0", "uv1", "uv2"].into_iter().zip(uvs.iter().flatten()) {
            self.finite &= u.is_finite() && v.is_finite();
            self.line(4, &format!("{key}: [{}, {}]", shortest(*u), shortest(*v)));
        }
    }

    fn quad(&mut self, quad: &Quad) {
        let Quad { vertices } = quad;
        self.kind("quad");
        self.corners(vertices);
        if quad.is_bent() {
            self.line(4, "curved: true");
        }
    }

    fn instance(&mut self, instance: &Instance, scene: &'s Scene) -> Result<(), String> {
        let Instance {
            mesh,
            world_from_object,
        } = instance;
        let [axes @ .., origin] = world_from_object;
        let scale = [axes[0][0], axes[1][1], axes[2][2]];
        let [x, y, z] = Vec3::AXES;
        let straight = [x * scale[0], y * scale[1], z * scale[2]].map(|axis| axis.to_array());
        let (file, part) = self.names.mesh(scene, *mesh)?;
        self.kind("mesh");
        self.line(4, &format!("file: {file}"));
        if let Some(part) = part {
            self.line(4, &format!("part: {}", quoted(part)));
        }
        if axes.map(|axis| axis.map(f64::to_bits)) != straight.map(|axis| axis.map(f64::to_bits)) {
            let columns = self.list(world_from_object.iter().flatten().copied());
            self.line(4, &format!("transform: {columns}"));
            return Ok(());
        }
        self.numbers("position", origin, 4);
        match scale {
            [x, y, z] if x == y && y == z => self.number("scale", x, 4),
            _ => self.numbers("scale", &scale, 4),
        }
        Ok(())
    }

    fn ellipsoid(&mut self, ellipsoid: &Ellipsoid) {
        let Ellipsoid { center, axes } = ellipsoid;
        self.kind("ellipsoid");
        let [x, y, z] = axes;
        let straight = [[x[0], 0.0, 0.0], [0.0, y[1], 0.0], [0.0, 0.0, z[2]]];
        if axes.map(|axis| axis.map(f64::to_bits)) != straight.map(|axis| axis.map(f64::to_bits)) {
            let columns = self.list(axes.iter().chain([center]).flatten().copied());
            self.line(4, &format!("transform: {columns}"));
            return;
        }
        self.numbers("position", center, 4);
        self.numbers("radius", &[x[0], y[1], z[2]], 4);
    }
}

/// An axis and an angle, as short as possible, whose rotation equals `rows` bit for bit; `None` if
/// none is found, for example if no text was lowered to this rotation.
fn axis_angle_of(rows: [[f64; 3]; 3]) -> Option<([f64; 3], f64)> {
    let (axis, approximate) = axis_and_angle(rows);
    let reproduces = |angle: &f64| rotated_to_z(axis, *angle) == Some(rows);
    let digits = (0..18).map(|digits: usize| {
        format!("{approximate:.digits$}")
            .parse()
            .unwrap_or(approximate)
    });
    // Halfway between two quarters of a turn, the sign of the angle matters.
    let angles = digits
        .chain(around(approximate, f64::EPSILON / 2.0))
        .flat_map(|angle| [angle, angle + 360.0, angle - 360.0]);
    let angle = angles.into_iter().find(reproduces)?;
    // Any length that normalises to this axis.
    let mut lengths = around(1.0, 1.0 / 67_108_864.0);
    let axis = lengths
        .find_map(|length| Some(axis * length).filter(|scaled| unit(*scaled) == Some(axis)))?;
    Some((axis.to_array(), angle))
}

/// Candidates around a number with increasing step sizes: first `fraction` of the number, then 16
/// times as much, and so on. The right step size depends on the rounding of the input, so one would
/// not suffice.
fn around(middle: f64, fraction: f64) -> impl Iterator<Item = f64> {
    const SCALES: u32 = 6;
    const STEPS: i32 = 1 << 15;
    let step = move |scale| middle * fraction * f64::from(16_i32.pow(scale));
    let steps =
        (0..SCALES).flat_map(move |scale| (1..=STEPS).map(move |k| step(scale) * f64::from(k)));
    std::iter::once(middle).chain(steps.flat_map(move |by| [middle + by, middle - by]))
}
