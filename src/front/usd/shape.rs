//! Shapes: spheres and discs as they are, others as meshes (`UsdGeomGprim`).

use super::stage::ComposedPrim;
use super::{Lowering, PrimState};
use crate::exchange::tessellate;
use crate::exchange::transform::AffineTransform;
use rtc_diag::codes;
use rtc_ir::{Disc, Ellipsoid, EntityKind, MaterialId, Mesh, MeshId, Quad, Shape, Sphere, Surface};
use rtc_math::{Vec3, cos, sin, unit};
use rtc_source::{Resource, Span};
use std::f64::consts::{FRAC_PI_2, TAU};

pub(super) const KINDS: [&str; 8] = [
    "Sphere",
    "Cube",
    "Cylinder",
    "Cylinder_1",
    "Cone",
    "Capsule",
    "Capsule_1",
    "Plane",
];

/// The memory of a vertex with its triangles, in bytes, rounded up.
pub(super) const VERTEX: u64 = 160;
/// The rows of each half of a capsule.
const ROWS: u32 = 16;

/// The geometry of a shape in its own coordinates.
#[derive(Clone, Debug)]
pub(super) enum SolidGeometry {
    /// A sphere about the origin.
    Sphere(f64),
    /// A disc about the origin that faces −z.
    Disc(f64),
    /// A rectangle about the origin that faces −z, by its width and height.
    Rectangle(f64, f64),
    Mesh(MeshId),
}

/// A shape with its place.
#[derive(Clone, Debug)]
pub(super) struct StageShape {
    pub(super) geometry: SolidGeometry,
    pub(super) to_world: AffineTransform,
    pub(super) material: MaterialId,
    pub(super) span: Span,
}

impl Lowering<'_> {
    /// Adds a shape to the scene, or to the prototype that is read.
    pub(super) fn add(&mut self, shape: StageShape) {
        match self.prototype.is_some() {
            true => {
                let charged = self.charge(Resource::Memory, crate::gltf::SURFACE, shape.span);
                if let (Some(()), Some(shapes)) = (charged, &mut self.prototype) {
                    shapes.push(shape);
                }
            }
            false => drop(self.place(&shape, &AffineTransform::IDENTITY)),
        }
    }

    /// Adds a shape, moved by `outer`. `None` if the budget is used up.
    pub(super) fn place(&mut self, placed: &StageShape, outer: &AffineTransform) -> Option<()> {
        let to_world = outer.after(&placed.to_world);
        if self.prototype.is_some() {
            self.add(StageShape {
                to_world,
                ..placed.clone()
            });
            return (!self.is_exhausted()).then_some(());
        }
        self.charge_surface(placed.span)?;
        // A shape without an extent is not seen.
        let Some(shape) = self.shape(&placed.geometry, &to_world, placed.span) else {
            return (!self.is_exhausted()).then_some(());
        };
        self.record(EntityKind::Surface, self.scene.surfaces.len(), placed.span);
        self.scene
            .surfaces
            .push(Surface::new(shape, placed.material));
        Some(())
    }

    fn shape(
        &mut self,
        geometry: &SolidGeometry,
        to_world: &AffineTransform,
        span: Span,
    ) -> Option<Shape> {
        // A singular transform makes solids invisible.
        let AffineTransform([x, y, z, origin]) = to_world;
        let is_flat = to_world.determinant() == 0.0 || !to_world.determinant().is_finite();
        // Shapes that a transform distorts become another shape or a mesh.
        Some(match geometry {
            SolidGeometry::Mesh(_) | SolidGeometry::Sphere(_) if is_flat => return None,
            SolidGeometry::Mesh(mesh) => to_world.instance(*mesh),
            SolidGeometry::Sphere(radius) => match to_world.similarity() {
                Some(scale) => Shape::Sphere(Sphere {
                    center: origin.to_array(),
                    radius: radius * scale,
                    texture_from_world: None,
                }),
                None => Shape::Ellipsoid(Ellipsoid {
                    center: origin.to_array(),
                    axes: [*x, *y, *z].map(|axis| (axis * *radius).to_array()),
                }),
            },
            SolidGeometry::Disc(radius) => {
                let (a, b) = (x.length(), y.length());
                let is_round = (a - b).abs() <= 1e-6 * a.max(b) && x.dot(*y).abs() <= 1e-6 * a * b;
                match unit(y.cross(*x)).filter(|_| is_round) {
                    Some(normal) => Shape::Disc(Disc {
                        center: origin.to_array(),
                        normal: normal.to_array(),
                        radius: radius * a,
                    }),
                    None => {
                        let mesh = self.built("disk", span, tessellate::disk)?;
                        let scale = AffineTransform::scale([*radius, -radius, -1.0]);
                        to_world.after(&scale).instance(mesh)
                    }
                }
            }
            SolidGeometry::Rectangle(width, height) => {
                let (w, h) = (width / 2.0, height / 2.0);
                let corner = |[u, v]: [f64; 2]| to_world.point(Vec3::new(u, v, 0.0)).to_array();
                let vertices = [[w, -h], [-w, -h], [-w, h], [w, h]].map(corner);
                Shape::Quad(Quad { vertices })
            }
        })
    }

    /// The mesh of a name, made when it is first asked for.
    fn built(&mut self, name: &str, span: Span, make: impl FnOnce() -> Mesh) -> Option<MeshId> {
        if let Some(known) = self.built.get(name) {
            return Some(*known);
        }
        let mesh = make();
        let id = self.charged_mesh(mesh, span)?;
        self.built.insert(name.to_owned(), id);
        Some(id)
    }

    /// Adds a mesh whose size is known before.
    pub(super) fn charged_mesh(&mut self, mesh: Mesh, span: Span) -> Option<MeshId> {
        let vertices = mesh.positions.len() as u64;
        self.charge(Resource::Vertices, vertices, span)?;
        self.charge(Resource::Memory, VERTEX * vertices, span)?;
        let index = self.scene.meshes.len();
        self.record(EntityKind::Mesh, index, span);
        self.scene.meshes.push(mesh);
        Some(MeshId(u32::try_from(index).unwrap_or(u32::MAX)))
    }

    /// A sphere, a cube and the like.
    pub(super) fn solid(&mut self, prim: &ComposedPrim, kind: &str, state: &PrimState) {
        if !state.is_shown {
            return;
        }
        let span = self.span_of(prim);
        let is_double_sided = self.flag(prim, "doubleSided").unwrap_or(false) || kind == "Plane";
        let lowered = self.bound_material(state);
        let material = self.material_id(&lowered, state, is_double_sided, true, span);
        let Some(((geometry, local), material)) =
            self.solid_geometry(prim, kind, span).zip(material)
        else {
            return;
        };
        let to_world = state.to_world.after(&local);
        self.add(StageShape {
            geometry,
            to_world,
            material,
            span,
        });
    }

    /// The geometry of a solid and its place in the coordinates of the prim.
    fn solid_geometry(
        &mut self,
        prim: &ComposedPrim,
        kind: &str,
        span: Span,
    ) -> Option<(SolidGeometry, AffineTransform)> {
        let number = |name: &str, default: f64| self.number(prim, name).unwrap_or(default);
        let axis = self.text(prim, "axis").unwrap_or_else(|| "Z".to_owned());
        // The axes of a solid about z, turned to another one.
        let axes = match axis.as_str() {
            "X" => [Vec3::Y, Vec3::Z, Vec3::X],
            "Y" => [Vec3::Z, Vec3::X, Vec3::Y],
            _ => [Vec3::X, Vec3::Y, Vec3::Z],
        };
        let along = AffineTransform([axes[0], axes[1], axes[2], Vec3::ZERO]);
        match kind {
            "Sphere" => Some((
                SolidGeometry::Sphere(number("radius", 1.0)),
                AffineTransform::IDENTITY,
            )),
            "Cube" => {
                let size = number("size", 2.0) / 2.0;
                let mesh = self.built("cube", span, tessellate::cube)?;
                Some((SolidGeometry::Mesh(mesh), AffineTransform::scale([size; 3])))
            }
            "Plane" => {
                let (width, length) = (number("width", 2.0) / 2.0, number("length", 2.0) / 2.0);
                let mesh = self.built("plane", span, tessellate::rectangle)?;
                // The width of a plane across x runs along z, that across y along x.
                let [u, v] = if axis == "Z" {
                    [width, length]
                } else {
                    [length, width]
                };
                let local = along.after(&AffineTransform::scale([u, v, 1.0]));
                Some((SolidGeometry::Mesh(mesh), local))
            }
            _ => {
                let radius = number(
                    "radius",
                    if kind.starts_with("Capsule") {
                        0.5
                    } else {
                        1.0
                    },
                );
                let top = number("radiusTop", radius);
                let bottom = number("radiusBottom", radius);
                let height = number(
                    "height",
                    if kind.starts_with("Capsule") {
                        1.0
                    } else {
                        2.0
                    },
                );
                if height < 0.0 || top < 0.0 || bottom < 0.0 {
                    self.report(
                        &codes::USD_UNSUPPORTED,
                        span,
                        "a solid of a negative size is left out",
                    );
                    return None;
                }
                if kind == "Capsule_1" && (top - bottom).abs() > 0.0 {
                    self.approximate(
                        prim,
                        "both ends of the capsule have the radius of its bottom",
                    );
                }
                let name = format!("{kind} {bottom} {top} {height}");
                let mesh = self.built(&name, span, || {
                    let profile = match kind {
                        "Cone" => frustum(radius, 0.0, height),
                        "Cylinder" | "Cylinder_1" => frustum(bottom, top, height),
                        _ => capsule(bottom, height),
                    };
                    tessellate::revolved(&profile, TAU)
                })?;
                Some((SolidGeometry::Mesh(mesh), along))
            }
        }
    }
}

/// The profile of a cylinder or a cone about z with its caps, from the bottom.
fn frustum(bottom: f64, top: f64, height: f64) -> Vec<(Vec3, Vec3)> {
    let point = |x: f64, z: f64| Vec3::new(x, 0.0, z * height / 2.0);
    let side = unit(Vec3::new(height, 0.0, bottom - top)).unwrap_or(Vec3::X);
    vec![
        (point(0.0, -1.0), Vec3::NEG_Z),
        (point(bottom, -1.0), Vec3::NEG_Z),
        (point(bottom, -1.0), side),
        (point(top, 1.0), side),
        (point(top, 1.0), Vec3::Z),
        (point(0.0, 1.0), Vec3::Z),
    ]
}

/// The profile of a capsule about z, from the bottom: `height` is that of its cylinder.
fn capsule(radius: f64, height: f64) -> Vec<(Vec3, Vec3)> {
    let half = |sign: f64| {
        (0..=ROWS).map(move |row| {
            let share = f64::from(row) / f64::from(ROWS);
            let angle = FRAC_PI_2 * if sign < 0.0 { share - 1.0 } else { share };
            // The poles are points.
            let ring = cos(angle);
            let ring = if ring < 1e-12 { 0.0 } else { ring };
            let normal = Vec3::new(ring, 0.0, sin(angle));
            (normal * radius + Vec3::Z * (sign * height / 2.0), normal)
        })
    };
    half(-1.0).chain(half(1.0)).collect()
}
