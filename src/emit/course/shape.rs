//! Writes the shapes.

use super::{SceneWriter, quoted, triple};
use rtc_ir::{self as ir, Csg, Ellipsoid, Instance, Quad, Scene, Shape, Sphere, Triangle};
use rtc_math::{Vec3, axis_and_angle, rotated_to_z, shortest, unit};

/// A shape that the scene format can express.
trait WriteShape {
    /// # Errors
    /// A message, if the format can't express the shape.
    fn emit<'s>(&self, text: &mut SceneWriter<'s>, scene: &'s Scene) -> Result<(), String>;
}

/// Writes each shape by its own `impl`, or by the keys of its row.
macro_rules! emit {
    (
        all { $($(#[$doc:meta])* $Name:ident $name:ident $Store:ident $paths:tt;)* }
        derived { $($(#[$about:meta])* $Derived:ident $word:ident {
            $type:literal $($value:ident: $rule:ident $key:literal $($words:literal)?;)*
        })* }
    ) => {
        impl<'s> SceneWriter<'s> {
            pub(super) fn shape(&mut self, shape: &Shape, scene: &'s Scene) -> Result<(), String> {
                match shape {
                    $(Shape::$Name(shape) => shape.emit(self, scene),)*
                }
            }
        }

        $(impl WriteShape for ir::$Derived {
            fn emit<'s>(&self, text: &mut SceneWriter<'s>, _: &'s Scene) -> Result<(), String> {
                let Self { $($value),* } = self;
                text.kind($type);
                $(text.$rule($key, $value);)*
                Ok(())
            }
        })*
    };
}

rtc_tables::shapes!(emit);

impl SceneWriter<'_> {
    fn kind(&mut self, word: &str) {
        self.line(2, &format!("- type: {word}"));
    }

    fn point(&mut self, key: &str, value: &[f64; 3]) {
        self.numbers(key, value, 4);
    }

    fn direction(&mut self, key: &str, value: &[f64; 3]) {
        self.numbers(key, value, 4);
    }

    fn step(&mut self, key: &str, value: &[f64; 3]) {
        self.numbers(key, value, 4);
    }

    fn length(&mut self, key: &str, value: &f64) {
        self.number(key, *value, 4);
    }

    fn corners<const N: usize>(&mut self, corners: &[[f64; 3]; N]) {
        for (key, corner) in ["v0", "v1", "v2", "v3"].into_iter().zip(corners) {
            self.point(key, corner);
        }
    }
}

impl WriteShape for Sphere {
    fn emit<'s>(&self, text: &mut SceneWriter<'s>, _: &'s Scene) -> Result<(), String> {
        let Self {
            center,
            radius,
            texture_from_world: rotation,
        } = self;
        text.kind("sphere");
        text.point("position", center);
        let Some(rotation) = rotation else {
            text.length("radius", radius);
            return Ok(());
        };
        let rotation = axis_angle_of(*rotation)
            .ok_or("the texture of a sphere is turned as no axis and angle say to the last bit")?;
        let (axis, angle) = rotation;
        text.finite &= [*radius, angle]
            .iter()
            .chain(&axis)
            .all(|number| number.is_finite());
        text.line(
            4,
            &format!("radius: [{}, {}]", shortest(*radius), triple(axis)),
        );
        text.number("angle", angle, 4);
        Ok(())
    }
}

impl WriteShape for Triangle {
    fn emit<'s>(&self, text: &mut SceneWriter<'s>, _: &'s Scene) -> Result<(), String> {
        let Self { vertices, uvs } = self;
        text.kind("triangle");
        text.corners(vertices);
        for (key, [u, v]) in ["uv0", "uv1", "uv2"].into_iter().zip(uvs.iter().flatten()) {
            text.finite &= u.is_finite() && v.is_finite();
            text.line(4, &format!("{key}: [{}, {}]", shortest(*u), shortest(*v)));
        }
        Ok(())
    }
}

impl WriteShape for Quad {
    fn emit<'s>(&self, text: &mut SceneWriter<'s>, _: &'s Scene) -> Result<(), String> {
        let Self { vertices } = self;
        text.kind("quad");
        text.corners(vertices);
        if self.is_bent() {
            text.line(4, "curved: true");
        }
        Ok(())
    }
}

impl WriteShape for Instance {
    fn emit<'s>(&self, text: &mut SceneWriter<'s>, scene: &'s Scene) -> Result<(), String> {
        let Self {
            mesh,
            world_from_object,
        } = self;
        let [axes @ .., origin] = world_from_object;
        let scale = [axes[0][0], axes[1][1], axes[2][2]];
        let [x, y, z] = Vec3::AXES;
        let straight = [x * scale[0], y * scale[1], z * scale[2]].map(|axis| axis.to_array());
        let (file, part) = text.names.mesh(scene, *mesh)?;
        text.kind("mesh");
        text.line(4, &format!("file: {file}"));
        if let Some(part) = part {
            text.line(4, &format!("part: {}", quoted(part)));
        }
        if axes.map(|axis| axis.map(f64::to_bits)) != straight.map(|axis| axis.map(f64::to_bits)) {
            let columns = text.list(world_from_object.iter().flatten().copied());
            text.line(4, &format!("transform: {columns}"));
            return Ok(());
        }
        text.point("position", origin);
        match scale {
            [x, y, z] if x == y && y == z => text.number("scale", x, 4),
            _ => text.numbers("scale", &scale, 4),
        }
        Ok(())
    }
}

impl WriteShape for Ellipsoid {
    fn emit<'s>(&self, text: &mut SceneWriter<'s>, _: &'s Scene) -> Result<(), String> {
        let Self { center, axes } = self;
        text.kind("ellipsoid");
        let [x, y, z] = axes;
        let straight = [[x[0], 0.0, 0.0], [0.0, y[1], 0.0], [0.0, 0.0, z[2]]];
        if axes.map(|axis| axis.map(f64::to_bits)) != straight.map(|axis| axis.map(f64::to_bits)) {
            let columns = text.list(axes.iter().chain([center]).flatten().copied());
            text.line(4, &format!("transform: {columns}"));
            return Ok(());
        }
        text.point("position", center);
        text.numbers("radius", &[x[0], y[1], z[2]], 4);
        Ok(())
    }
}

impl WriteShape for Csg {
    fn emit<'s>(&self, _: &mut SceneWriter<'s>, _: &'s Scene) -> Result<(), String> {
        Err("a CSG solid can only be written with all parts of its boundary".to_owned())
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
