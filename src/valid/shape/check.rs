//! How each shape is proven.

use super::area::has_area;
use super::{Instance, Quad, Shape, Sphere, Surface, Triangle};
use crate::check::{Check, EntityCounts, SMALLEST, place};
use rtc_diag::{Diagnostic, codes};
use rtc_ir::{self as ir, EntityKind, Field, ShapeKind, ValuePath};
use rtc_math::{Positive, Vec3, unit};

/// `Some(None)` for a face without an area: no ray can hit it, so it is left out with a warning.
pub(crate) fn surface(
    surface: &ir::Surface,
    index: usize,
    counts: &EntityCounts,
    check: &mut Check<'_>,
) -> Option<Option<Surface>> {
    let ir::Surface {
        shape,
        material,
        casts_no_shadow,
    } = surface;
    let kind = shape.kind();
    let mut proof = SurfaceCheck {
        kind,
        index,
        counts,
        check,
    };
    let material = proof.check.handle(
        material.0,
        counts.materials,
        "material",
        place(EntityKind::Surface, index, Field::Material),
    );
    let shape = shape.validate(&mut proof);
    let material = material?;
    Some(shape?.map(|shape| Surface {
        shape,
        material,
        casts_shadow: !casts_no_shadow,
        index,
    }))
}

/// A shape under the check.
struct SurfaceCheck<'a, 'run> {
    kind: ShapeKind,
    index: usize,
    counts: &'a EntityCounts,
    check: &'a mut Check<'run>,
}

impl SurfaceCheck<'_, '_> {
    /// The place of a value of the shape.
    fn at(&self, way: &str) -> ValuePath {
        let field = Field::of_shape(self.kind, way);
        place(EntityKind::Surface, self.index, field)
    }

    fn whole(&self) -> ValuePath {
        place(EntityKind::Surface, self.index, Field::Whole)
    }

    /// A point: its components are finite and in range.
    fn point(&mut self, value: [f64; 3], way: &str, _words: &str) -> Option<Vec3> {
        self.check.vector(value, self.at(way))
    }

    /// A direction: a point that is not 0, scaled.
    fn direction(&mut self, value: [f64; 3], way: &str, words: &str) -> Option<Vec3> {
        self.check.direction(value, words, self.at(way))
    }

    /// A length: above 0, and in range.
    fn length(&mut self, value: f64, way: &str, words: &str) -> Option<Positive> {
        self.check
            .length(value, self.at(way), &codes::RADIUS, words)
    }

    /// A step: a point as far from 0 as a length.
    fn step(&mut self, value: [f64; 3], way: &str, words: &str) -> Option<Vec3> {
        let step = self.point(value, way, words);
        let longest = step.map(|step| step.abs().max_element());
        longest.and_then(|longest| self.length(longest, way, words))?;
        step
    }

    /// Warns about a face that has no area.
    fn face(&mut self, sound: Option<Shape>, name: &str) -> Option<Shape> {
        if sound.is_none() {
            let message = format!("a {name} has no area, so it is invisible");
            let finding = Diagnostic::new(&codes::DEGENERATE_TRIANGLE, message);
            let finding = finding.hint("give it corners that are not in line, or remove it");
            self.check
                .report(self.whole(), "its corners are in line", finding);
        }
        sound
    }
}

/// How a shape of the IR is proven.
trait Prove {
    /// The proven shape; `Some(None)` for a face without an area.
    fn validate(&self, proof: &mut SurfaceCheck<'_, '_>) -> Option<Option<Shape>>;
}

/// Proves each shape in its own way, or by the rules of its row.
macro_rules! validate {
    ($($(#[$doc:meta])* $Name:ident $word:ident $Store:ident $how:ident $values:tt)*) => {
        impl Prove for ir::Shape {
            fn validate(&self, proof: &mut SurfaceCheck<'_, '_>) -> Option<Option<Shape>> {
                match self {
                    $(Self::$Name(shape) => shape.validate(proof),)*
                }
            }
        }

        $(by_rule!($Name $how $values);)*
    };
}

/// Proves a shape by the rules of its row. All its values are looked at, whatever is wrong.
macro_rules! by_rule {
    ($Name:ident custom $values:tt) => {};
    ($Name:ident derived {
        $type:literal $($value:ident: $rule:ident $key:literal $($words:literal)?;)*
    }) => {
        impl Prove for ir::$Name {
            fn validate(&self, proof: &mut SurfaceCheck<'_, '_>) -> Option<Option<Shape>> {
                let Self { $($value),* } = *self;
                $(let $value = proof.$rule($value, stringify!($value), concat!($($words)?));)*
                Some(Some(Shape::$Name(super::$Name { $($value: $value?),* })))
            }
        }
    };
}

rtc_tables::shapes!(validate);

impl Prove for ir::Sphere {
    fn validate(&self, proof: &mut SurfaceCheck<'_, '_>) -> Option<Option<Shape>> {
        let Self {
            center,
            radius,
            texture_from_world,
        } = self;
        let center = proof.point(*center, "center", "");
        let radius = proof.length(*radius, "radius", "radius");
        let rows = texture_from_world.map(|rows| Box::new(rows.map(Vec3::from_array)));
        if rows.as_deref().is_some_and(|rows| !is_rotation(*rows)) {
            let finding = Diagnostic::new(
                &codes::BAD_ROTATION,
                "the texture of a sphere is turned by a matrix that is not a rotation",
            );
            proof.check.report(proof.whole(), "", finding);
            return None;
        }
        Some(Some(Shape::Sphere(Sphere {
            center: center?,
            radius: radius?,
            texture_from_world: rows,
        })))
    }
}

impl Prove for ir::Triangle {
    fn validate(&self, proof: &mut SurfaceCheck<'_, '_>) -> Option<Option<Shape>> {
        const WAYS: [&str; 3] = ["vertices/0", "vertices/1", "vertices/2"];
        let Self { vertices, uvs } = self;
        let corners = [0, 1, 2].map(|k| proof.point(vertices[k], WAYS[k], ""));
        for uv in uvs.iter().flatten().flatten() {
            proof.check.number(*uv, proof.whole())?;
        }
        let vertices = [corners[0]?, corners[1]?, corners[2]?];
        let sound = has_area(vertices).then_some(Shape::Triangle(Triangle {
            vertices,
            uvs: uvs.map(Box::new),
        }));
        Some(proof.face(sound, "triangle"))
    }
}

impl Prove for ir::Quad {
    fn validate(&self, proof: &mut SurfaceCheck<'_, '_>) -> Option<Option<Shape>> {
        const WAYS: [&str; 4] = ["vertices/0", "vertices/1", "vertices/2", "vertices/3"];
        let Self { vertices } = self;
        let corners = [0, 1, 2, 3].map(|k| proof.point(vertices[k], WAYS[k], ""));
        let [a, b, c, d] = [corners[0]?, corners[1]?, corners[2]?, corners[3]?];
        let area = has_area([a, b, c]) || has_area([a, c, d]);
        let sound = area.then_some(Shape::Quad(Box::new(Quad {
            vertices: [a, b, c, d],
        })));
        Some(proof.face(sound, "quad"))
    }
}

impl Prove for ir::Instance {
    fn validate(&self, proof: &mut SurfaceCheck<'_, '_>) -> Option<Option<Shape>> {
        let Self {
            mesh,
            world_from_object,
        } = self;
        let meshes = proof.counts.meshes;
        let mesh = proof.check.handle(mesh.0, meshes, "mesh", proof.at("mesh"));
        let columns = world_from_object.map(|column| proof.point(column, "worldFromObject", ""));
        let columns = [columns[0]?, columns[1]?, columns[2]?, columns[3]?];
        let axes = [0, 1, 2].map(|k| unit(columns[k]).unwrap_or(Vec3::ZERO));
        let volume = axes[0].dot(axes[1].cross(axes[2])).abs();
        let smallest = columns[..3]
            .iter()
            .map(|axis| axis.abs().max_element())
            .fold(f64::INFINITY, f64::min);
        if volume < 1e-9 || smallest < SMALLEST {
            let finding =
                Diagnostic::new(&codes::BAD_ROTATION, "the transform of a mesh flattens it");
            let at = proof.at("worldFromObject");
            proof.check.report(at, "", finding);
            return None;
        }
        Some(Some(Shape::Instance(Box::new(Instance {
            mesh: mesh?,
            world_from_object: columns,
        }))))
    }
}

/// Whether the rows are a rotation matrix, to within 1e-6.
fn is_rotation(rows: [Vec3; 3]) -> bool {
    const SLACK: f64 = 1e-6;
    let close = |value: f64, wanted: f64| (value - wanted).abs() <= SLACK;
    let [x, y, z] = rows;
    let units = rows.iter().all(|row| close(row.dot(*row), 1.0));
    units
        && close(x.dot(y), 0.0)
        && close(y.dot(z), 0.0)
        && close(z.dot(x), 0.0)
        && close(x.cross(y).dot(z), 1.0)
}
