//! Tessellation: converts shapes that a format lacks to meshes, within a tolerance.
//!
//! A round shape becomes a mesh in object coordinates that depends only on its kind and number of
//! steps; the instance has its position and size. So all spheres share one mesh.
//!
//! - [`Tessellator`] converts shape by shape and charges vertices to the budget.
//! - [`TessellationTolerance`] computes the numbers of steps from the tolerance.
//! - `csg` contours CSG solids by the faces of their operands (`face`).
//! - [`UnitRoundShape`] is a round shape of radius 1; `round` and `flat` build the meshes with
//!   `MeshBuilder`.

mod builder;
mod csg;
mod face;
mod flat;
mod round;
mod tolerance;

use crate::export::shape_name;
use crate::flat::{around, finite, side};
use crate::reporter::ExportReporter;
use csg::CsgMesh;
use glam::DAffine3;
use round::UnitRoundShape;
use rtc_diag::{Code, codes};
use rtc_ir::{
    BoundingSphere, EntityField, EntityKind, Instance, Mesh, MeshId, Scene, Shape, ShapeKind,
    Surface, ValuePath,
};
use rtc_math::{shortest, to_u32};
use rtc_source::{Budget, Resource};
use std::collections::BTreeMap;
use tolerance::TessellationTolerance;

/// Bytes per vertex with normal and texture coordinates, as f64 and in the file, including its
/// share of the triangles.
const VERTEX: u64 = 160;

/// The mesh of a shape.
enum ShapeMesh {
    /// A round shape and its transform.
    Round(UnitRoundShape, DAffine3),
    /// A mesh in world coordinates.
    World(Box<Mesh>),
}

/// The target format, for diagnostics.
pub(super) struct TargetFormat {
    pub(super) name: &'static str,
    /// The code for tessellated shapes.
    pub(super) approximated: &'static Code,
    /// Whether it has the shape of a surface of a scene, which stays as it is.
    pub(super) has: fn(&Scene, &Surface) -> bool,
}

/// The scene with meshes instead of all shapes that the format lacks; `None` if they exceed the
/// budget, which is reported.
pub(super) fn with_meshes(
    scene: &Scene,
    format: &TargetFormat,
    tolerance: Option<f64>,
    budget: &Budget,
    reporter: &mut ExportReporter<'_>,
) -> Option<Scene> {
    let mut tessellator = Tessellator {
        format,
        tessellation: TessellationTolerance::new(tolerance),
        around: around(scene),
        budget,
        unit_meshes: BTreeMap::new(),
        meshes: scene.meshes.clone(),
    };
    let mut surfaces = Vec::with_capacity(scene.surfaces.len());
    for (index, surface) in scene.surfaces.iter().enumerate() {
        let path = ValuePath::new(EntityKind::Surface, index, EntityField::Whole);
        let shape = if (format.has)(scene, surface) {
            surface.shape.clone()
        } else {
            Shape::Instance(tessellator.instance(&surface.shape, path, reporter)?)
        };
        surfaces.push(Surface {
            shape,
            ..surface.clone()
        });
    }
    Some(Scene {
        surfaces,
        meshes: tessellator.meshes,
        ..scene.clone()
    })
}

/// Converts shapes to meshes.
struct Tessellator<'m> {
    format: &'m TargetFormat,
    tessellation: TessellationTolerance,
    around: BoundingSphere,
    budget: &'m Budget,
    /// The meshes of round shapes so far.
    unit_meshes: BTreeMap<UnitRoundShape, MeshId>,
    meshes: Vec<Mesh>,
}

impl Tessellator<'_> {
    fn instance(
        &mut self,
        shape: &Shape,
        path: ValuePath,
        reporter: &mut ExportReporter<'_>,
    ) -> Option<Instance> {
        let shape_mesh = match shape {
            Shape::Instance(instance) => return Some(instance.clone()),
            Shape::Csg(csg) => {
                let CsgMesh { mesh, exactness } = self.csg(csg, path, reporter)?;
                let message = format!(
                    "{} has no union, intersection or difference: a closed mesh {exactness} \
                     replaces it",
                    self.format.name
                );
                reporter.report(self.format.approximated, &message, path);
                mesh
            }
            Shape::Sphere(_)
            | Shape::Plane(_)
            | Shape::Triangle(_)
            | Shape::Quad(_)
            | Shape::Disc(_)
            | Shape::Cylinder(_)
            | Shape::Cone(_)
            | Shape::Paraboloid(_)
            | Shape::Torus(_)
            | Shape::Ellipsoid(_)
            | Shape::InfiniteCylinder(_) => self.simple(shape, path, reporter)?,
        };
        self.report(shape, path, reporter);
        let (mesh, world) = match shape_mesh {
            ShapeMesh::World(mesh) => (self.add(*mesh), DAffine3::IDENTITY),
            ShapeMesh::Round(unit_shape, world) => (self.round(unit_shape, path, reporter)?, world),
        };
        Some(Instance {
            mesh,
            world_from_object: world.to_cols_array_2d(),
        })
    }

    /// The mesh of a shape that is neither an instance nor a CSG solid.
    fn simple(
        &self,
        shape: &Shape,
        path: ValuePath,
        reporter: &mut ExportReporter<'_>,
    ) -> Option<ShapeMesh> {
        Some(match shape {
            Shape::Instance(_) | Shape::Csg(_) => return None,
            Shape::Sphere(sphere) => round::sphere(sphere, &self.tessellation),
            Shape::Cylinder(cylinder) => round::cylinder(cylinder, &self.tessellation),
            Shape::Cone(cone) => round::cone(cone, &self.tessellation),
            Shape::Paraboloid(paraboloid) => round::paraboloid(paraboloid, &self.tessellation),
            Shape::Torus(torus) => round::torus(torus, &self.tessellation),
            Shape::Disc(disc) => round::disc(disc, &self.tessellation),
            Shape::Ellipsoid(ellipsoid) => round::ellipsoid(ellipsoid, &self.tessellation),
            Shape::InfiniteCylinder(cylinder) => {
                round::cylinder(&finite(cylinder, self.around), &self.tessellation)
            }
            Shape::Plane(plane) => flat::plane(plane, self.around),
            Shape::Triangle(triangle) => flat::triangle(triangle),
            Shape::Quad(quad) => {
                let steps = flat::steps(quad, &self.tessellation);
                self.charge(u64::from(steps + 1).pow(2), path, reporter)?;
                flat::quad(quad, steps)
            }
        })
    }

    fn round(
        &mut self,
        unit_shape: UnitRoundShape,
        path: ValuePath,
        reporter: &mut ExportReporter<'_>,
    ) -> Option<MeshId> {
        if let Some(mesh) = self.unit_meshes.get(&unit_shape) {
            return Some(*mesh);
        }
        self.charge(unit_shape.vertices(), path, reporter)?;
        let id = self.add(unit_shape.mesh());
        self.unit_meshes.insert(unit_shape, id);
        Some(id)
    }

    fn add(&mut self, mesh: Mesh) -> MeshId {
        self.meshes.push(mesh);
        MeshId(to_u32(self.meshes.len() - 1))
    }

    /// Charges vertices; `None` if they exceed the budget, which is reported.
    fn charge(
        &self,
        vertices: u64,
        path: ValuePath,
        reporter: &mut ExportReporter<'_>,
    ) -> Option<()> {
        let memory = vertices.saturating_mul(VERTEX);
        let charged = self.budget.charge(Resource::Vertices, vertices);
        let charged = charged.and_then(|()| self.budget.charge(Resource::Memory, memory));
        match charged {
            Ok(()) if u32::try_from(vertices).is_ok() => return Some(()),
            Ok(()) => {
                let message = format!(
                    "the shape takes more vertices than a mesh of {} counts",
                    self.format.name
                );
                reporter.report_error(&codes::OVER_LIMIT, &message, path);
            }
            Err(error) => {
                let message = format!("the shape takes too many triangles: {error}");
                reporter.report_error(&codes::OVER_LIMIT, &message, path);
            }
        }
        None
    }

    fn report(&self, shape: &Shape, path: ValuePath, reporter: &mut ExportReporter<'_>) {
        // Say what replaces the shape and how exactly.
        let format = self.format.name;
        let side = || shortest(2.0 * side(self.around));
        let message = match shape.kind() {
            ShapeKind::Triangle | ShapeKind::Instance | ShapeKind::Csg => return,
            ShapeKind::Plane => {
                format!(
                    "{format} has no plane: a square {} wide replaces it",
                    side()
                )
            }
            ShapeKind::InfiniteCylinder => format!(
                "{format} has no infinite cylinder: one {} long replaces it",
                side()
            ),
            ShapeKind::Sphere
            | ShapeKind::Ellipsoid
            | ShapeKind::Quad
            | ShapeKind::Disc
            | ShapeKind::Cylinder
            | ShapeKind::Cone
            | ShapeKind::Paraboloid
            | ShapeKind::Torus => format!(
                "{format} has no {}: a mesh {} replaces it",
                shape_name(shape),
                self.tessellation.describe()
            ),
        };
        reporter.report(self.format.approximated, &message, path);
    }
}
