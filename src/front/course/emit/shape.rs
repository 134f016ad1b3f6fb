//! The shapes back to text.

use super::material::file_name;
use super::{Text, number, triple};
use crate::front::course::sphere::{axis_and_angle, texture_from_world};
use crate::ir::{Cone, Cylinder, Disc, Instance, Plane, Quad, Scene, Shape, Sphere, Torus, Triangle};
use crate::math::Vec3;

impl Text {
    pub(super) fn shape(&mut self, shape: &Shape, scene: &Scene) -> Result<(), String> {
        match shape {
            Shape::Sphere(sphere) => self.sphere(sphere),
            Shape::Plane(Plane { center, normal }) => {
                self.kind("plane");
                self.vectors(&[("position", center), ("normal", normal)]);
            }
            Shape::Triangle(triangle) => self.triangle(triangle),
            Shape::Quad(Quad { vertices: [a, b, c, d] }) => {
                self.kind("quad");
                self.vectors(&[("v0", a), ("v1", b), ("v2", c), ("v3", d)]);
            }
            Shape::Disc(Disc { center, normal, radius }) => {
                self.kind("circle");
                self.vectors(&[("center", center), ("normal", normal)]);
                self.number("radius", *radius, 4);
            }
            Shape::Cylinder(Cylinder { base, axis, height, radius }) => {
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
            Shape::Torus(Torus { center, axis, major, minor }) => {
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
        pairs.iter().for_each(|(key, value)| self.numbers(key, value, 4));
    }

    fn sphere(&mut self, Sphere { center, radius, texture_from_world: turn }: &Sphere) {
        self.kind("sphere");
        self.numbers("position", center, 4);
        let Some(turn) = turn else { return self.number("radius", *radius, 4) };
        let (axis, angle) = turn_of(*turn);
        self.finite &= [*radius, angle].iter().chain(&axis).all(|number| number.is_finite());
        self.line(4, &format!("radius: [{}, {}]", number(*radius), triple(axis)));
        self.number("angle", angle, 4);
    }

    fn triangle(&mut self, Triangle { vertices: [a, b, c], uvs }: &Triangle) {
        self.kind("triangle");
        self.vectors(&[("v0", a), ("v1", b), ("v2", c)]);
        for (key, [u, v]) in ["uv0", "uv1", "uv2"].into_iter().zip(uvs.iter().flatten()) {
            self.finite &= u.is_finite() && v.is_finite();
            self.line(4, &format!("{key}: [{}, {}]", number(*u), number(*v)));
        }
    }

    fn instance(&mut self, Instance { mesh, world_from_object }: &Instance, scene: &Scene) -> Result<(), String> {
        let mesh = scene.meshes.get(mesh.0 as usize).ok_or("a surface refers to a mesh that does not exist")?;
        let [axes @ .., origin] = world_from_object;
        let scale = axes[0][0];
        if *axes != Vec3::AXES.map(|axis| (axis * scale).to_array()) {
            return Err("a mesh is turned or stretched, and this format only moves and scales meshes".to_owned());
        }
        self.kind("mesh");
        self.line(4, &format!("file: {}", file_name(&mesh.name)?));
        self.numbers("position", origin, 4);
        self.number("scale", scale, 4);
        Ok(())
    }
}

/// The axis and angle that give a rotation to the last bit if a short angle does, else up to rounding.
fn turn_of(rows: [[f64; 3]; 3]) -> ([f64; 3], f64) {
    let (axis, angle) = axis_and_angle(rows);
    let rounded = |digits: usize| format!("{angle:.digits$}").parse().unwrap_or(angle);
    let exact = |angle: &f64| texture_from_world(axis.normalize(), *angle) == Some(rows);
    let angle = [0, 3, 9].map(rounded).into_iter().find(exact).unwrap_or(angle);
    (axis.to_array(), angle)
}
