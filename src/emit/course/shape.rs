//! The shapes back to text.

use super::material::file_name;
use super::{Text, triple};
use crate::ir::{
    Cone, Cylinder, Disc, Instance, Plane, Quad, Scene, Shape, Sphere, Torus, Triangle,
};
use crate::math::{Vec3, axis_and_angle, shortest, turned_to_z, unit};

impl Text {
    pub(super) fn shape(&mut self, shape: &Shape, scene: &Scene) -> Result<(), String> {
        match shape {
            Shape::Sphere(sphere) => self.sphere(sphere)?,
            Shape::Plane(Plane { center, normal }) => {
                self.kind("plane");
                self.vectors(&[("position", center), ("normal", normal)]);
            }
            Shape::Triangle(triangle) => self.triangle(triangle),
            Shape::Quad(Quad {
                vertices: [a, b, c, d],
            }) => {
                self.kind("quad");
                self.vectors(&[("v0", a), ("v1", b), ("v2", c), ("v3", d)]);
            }
            Shape::Disc(Disc {
                center,
                normal,
                radius,
            }) => {
                self.kind("circle");
                self.vectors(&[("center", center), ("normal", normal)]);
                self.number("radius", *radius, 4);
            }
            Shape::Cylinder(Cylinder {
                base,
                axis,
                height,
                radius,
            }) => {
                self.kind("cylinder");
                self.vectors(&[("position", base), ("direction", axis)]);
                self.number("height", *height, 4);
                self.number("radius", *radius, 4);
            }
            Shape::Cone(Cone { base, up, radius }) => {
                self.kind("cone");
                self.vectors(&[("position", base), ("up", up)]);
                self.number("radius", *radius, 4);
            }
            Shape::Torus(Torus {
                center,
                axis,
                major,
                minor,
            }) => {
                self.kind("torus");
                self.vectors(&[("position", center), ("direction", axis)]);
                self.number("radius", *major, 4);
                self.number("alpha", *minor, 4);
            }
            Shape::Instance(instance) => self.instance(instance, scene)?,
        }
        Ok(())
    }

    fn kind(&mut self, word: &str) {
        self.line(2, &format!("- type: {word}"));
    }

    fn vectors(&mut self, pairs: &[(&str, &[f64; 3])]) {
        pairs
            .iter()
            .for_each(|(key, value)| self.numbers(key, value, 4));
    }

    fn sphere(
        &mut self,
        Sphere {
            center,
            radius,
            texture_from_world: turn,
        }: &Sphere,
    ) -> Result<(), String> {
        self.kind("sphere");
        self.numbers("position", center, 4);
        let Some(turn) = turn else {
            self.number("radius", *radius, 4);
            return Ok(());
        };
        let turn = turn_of(*turn)
            .ok_or("the texture of a sphere is turned as no axis and angle say to the last bit")?;
        let (axis, angle) = turn;
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

    fn triangle(
        &mut self,
        Triangle {
            vertices: [a, b, c],
            uvs,
        }: &Triangle,
    ) {
        self.kind("triangle");
        self.vectors(&[("v0", a), ("v1", b), ("v2", c)]);
        for (key, [u, v]) in ["uv0", "uv1", "uv2"].into_iter().zip(uvs.iter().flatten()) {
            self.finite &= u.is_finite() && v.is_finite();
            self.line(4, &format!("{key}: [{}, {}]", shortest(*u), shortest(*v)));
        }
    }

    fn instance(
        &mut self,
        Instance {
            mesh,
            world_from_object,
        }: &Instance,
        scene: &Scene,
    ) -> Result<(), String> {
        let mesh = scene
            .meshes
            .get(mesh.0 as usize)
            .ok_or("a surface refers to a mesh that does not exist")?;
        let [axes @ .., origin] = world_from_object;
        let scale = axes[0][0];
        if *axes != Vec3::AXES.map(|axis| (axis * scale).to_array()) {
            return Err(
                "a mesh is turned or stretched, and this format only moves and scales meshes"
                    .to_owned(),
            );
        }
        self.kind("mesh");
        self.line(4, &format!("file: {}", file_name(&mesh.name)?));
        self.numbers("position", origin, 4);
        self.number("scale", scale, 4);
        Ok(())
    }
}

/// An axis and an angle that give a rotation to the last bit, the shorter the better; `None` if
/// none is found, as for a rotation that no text was lowered to.
fn turn_of(rows: [[f64; 3]; 3]) -> Option<([f64; 3], f64)> {
    let (axis, nearly) = axis_and_angle(rows);
    let turns = |angle: &f64| turned_to_z(axis, *angle) == Some(rows);
    let digits =
        (0..18).map(|digits: usize| format!("{nearly:.digits$}").parse().unwrap_or(nearly));
    // Halfway between two quarters it counts from which side the angle is written.
    let angles = digits
        .chain(around(nearly, 0.0))
        .flat_map(|angle| [angle, angle + 360.0, angle - 360.0]);
    let angle = angles.into_iter().find(turns)?;
    // Any length will do, so long as it rounds to this axis.
    let mut lengths = around(1.0, 1.0 / 4096.0);
    let axis = lengths
        .find_map(|length| Some(axis * length).filter(|scaled| unit(*scaled) == Some(axis)))?;
    Some((axis.to_array(), angle))
}

/// Numbers around one, nearest first, a share of it apart, or if that is 0 all that there are.
fn around(middle: f64, share: f64) -> impl Iterator<Item = f64> {
    const TRIES: usize = 1 << 11;
    let next = move |at: &f64| {
        Some(if share > 0.0 {
            at + share * middle
        } else {
            at.next_up()
        })
    };
    let before = move |at: &f64| {
        Some(if share > 0.0 {
            at - share * middle
        } else {
            at.next_down()
        })
    };
    let up = std::iter::successors(Some(middle), next);
    let down = std::iter::successors(Some(middle), before);
    up.zip(down)
        .take(TRIES)
        .flat_map(|(above, below)| [above, below])
}
