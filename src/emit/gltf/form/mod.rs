//! Shapes as meshes: what glTF has no words for is cut into triangles, within a tolerance.
//!
//! A round form is a mesh in coordinates of its own, the same for all shapes of a kind and fineness;
//! the instance says where it stands and how large it is. So spheres share one mesh.

mod draft;
mod fineness;
mod flat;
mod round;

use crate::flat::{around, side};
use crate::told::Told;
use fineness::Fineness;
use glam::DAffine3;
use round::RoundForm;
use rtc_diag::codes;
use rtc_ir::{
    BoundingSphere, EntityKind, Field, Instance, Mesh, MeshId, Scene, Shape, ShapeKind, Surface,
    ValuePath,
};
use rtc_math::shortest;
use rtc_source::{Budget, Resource};
use std::collections::BTreeMap;

/// Bytes of a vertex with normal and texture coordinates, in 64-bit floats and in the file, with
/// its part of the triangles.
const VERTEX: u64 = 160;

/// A shape as a mesh.
enum ShapeForm {
    /// A round one, and where it stands.
    Round(RoundForm, DAffine3),
    /// A flat or bilinear one, with corners in the world.
    Own(Box<Mesh>),
}

/// The scene with meshes in place of all its shapes; `None` if they take too much, which is told.
pub(super) fn only_meshes(
    scene: &Scene,
    tolerance: Option<f64>,
    budget: &Budget,
    told: &mut Told<'_>,
) -> Option<Scene> {
    let mut maker = Maker {
        fineness: Fineness::new(tolerance),
        around: around(scene),
        budget,
        known: BTreeMap::new(),
        meshes: scene.meshes.clone(),
    };
    let mut surfaces = Vec::with_capacity(scene.surfaces.len());
    for (index, surface) in scene.surfaces.iter().enumerate() {
        let place = ValuePath::new(EntityKind::Surface, index, Field::Whole);
        let instance = maker.instance(&surface.shape, place, told)?;
        surfaces.push(Surface {
            shape: Shape::Instance(instance),
            ..surface.clone()
        });
    }
    Some(Scene {
        surfaces,
        meshes: maker.meshes,
        ..scene.clone()
    })
}

/// Makes meshes of shapes.
struct Maker<'m> {
    fineness: Fineness,
    around: BoundingSphere,
    budget: &'m Budget,
    /// The mesh of each round form that was made.
    known: BTreeMap<RoundForm, MeshId>,
    meshes: Vec<Mesh>,
}

impl Maker<'_> {
    fn instance(
        &mut self,
        shape: &Shape,
        place: ValuePath,
        told: &mut Told<'_>,
    ) -> Option<Instance> {
        let form = match shape {
            Shape::Instance(instance) => return Some(instance.clone()),
            Shape::Sphere(sphere) => round::sphere(sphere, &self.fineness),
            Shape::Cylinder(cylinder) => round::cylinder(cylinder, &self.fineness),
            Shape::Cone(cone) => round::cone(cone, &self.fineness),
            Shape::Paraboloid(paraboloid) => round::paraboloid(paraboloid, &self.fineness),
            Shape::Torus(torus) => round::torus(torus, &self.fineness),
            Shape::Disc(disc) => round::disc(disc, &self.fineness),
            Shape::Plane(plane) => flat::plane(plane, self.around),
            Shape::Triangle(triangle) => flat::triangle(triangle),
            Shape::Quad(quad) => {
                let steps = flat::steps(quad, &self.fineness);
                self.charge(u64::from(steps + 1).pow(2), place, told)?;
                flat::quad(quad, steps)
            }
        };
        self.tell(shape.kind(), place, told);
        let (mesh, world) = match form {
            ShapeForm::Own(mesh) => (self.add(*mesh), DAffine3::IDENTITY),
            ShapeForm::Round(form, world) => (self.round(form, place, told)?, world),
        };
        Some(Instance {
            mesh,
            world_from_object: world.to_cols_array_2d(),
        })
    }

    fn round(&mut self, form: RoundForm, place: ValuePath, told: &mut Told<'_>) -> Option<MeshId> {
        if let Some(known) = self.known.get(&form) {
            return Some(*known);
        }
        self.charge(form.vertices(), place, told)?;
        let id = self.add(form.mesh());
        self.known.insert(form, id);
        Some(id)
    }

    fn add(&mut self, mesh: Mesh) -> MeshId {
        self.meshes.push(mesh);
        MeshId(u32::try_from(self.meshes.len() - 1).unwrap_or(u32::MAX))
    }

    /// Charges so many vertices; `None` if that is too much, which is told.
    fn charge(&self, vertices: u64, place: ValuePath, told: &mut Told<'_>) -> Option<()> {
        let memory = vertices.saturating_mul(VERTEX);
        let charged = self.budget.charge(Resource::Vertices, vertices);
        let charged = charged.and_then(|()| self.budget.charge(Resource::Memory, memory));
        match charged {
            Ok(()) if u32::try_from(vertices).is_ok() => return Some(()),
            Ok(()) => {
                let message = "the shape takes more vertices than a mesh of glTF counts";
                told.refuse(&codes::GLTF_UNSAID, message, place);
            }
            Err(fault) => {
                let message = format!("the shape takes too many triangles: {fault}");
                told.refuse(&codes::OVER_LIMIT, &message, place);
            }
        }
        None
    }

    fn tell(&self, kind: ShapeKind, place: ValuePath, told: &mut Told<'_>) {
        let message = match kind {
            ShapeKind::Triangle | ShapeKind::Instance => return,
            ShapeKind::Plane => format!(
                "glTF has no plane: what is written is a square {} wide",
                shortest(2.0 * side(self.around))
            ),
            ShapeKind::Sphere
            | ShapeKind::Quad
            | ShapeKind::Disc
            | ShapeKind::Cylinder
            | ShapeKind::Cone
            | ShapeKind::Paraboloid
            | ShapeKind::Torus => format!(
                "glTF has no {}: what is written is a mesh {}",
                kind.name(),
                self.fineness.words()
            ),
        };
        told.tell(&codes::GLTF_NEARLY, &message, place);
    }
}
