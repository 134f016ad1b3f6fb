//! What an animation shows at all its times. An asset without a camera is framed by it, so that
//! pictures of different times have one view.

use super::super::animation::Animation;
use super::super::primitive::Primitive;
use super::mesh::{self, RequestedMesh};
use super::pose::{self, ScenePose};
use super::shape::Deformations;
use super::transform::{self, InstanceTransforms};
use super::{Lowering, empty};
use crate::hull::SweptHull;
use glam::DAffine3;
use rtc_ir::{Instance, MeshId, Scene, Shape, Surface};
use rtc_math::{Vec3, to_u32};
use rtc_source::tree::NodeId;
use std::collections::BTreeMap;

/// The most poses that are looked at, from the first keyframe to the last.
const MOST_POSES: usize = 33;
/// The most vertices and hull points that are moved, and numbers of their poses, over all poses.
const MOST_POINTS: usize = 1 << 21;

/// The hulls of the primitives of nodes, over the poses so far.
#[derive(Default)]
struct SweptHulls {
    /// By node, and by the place of the primitive in its mesh.
    hulls: BTreeMap<(usize, usize), SweptHull>,
    /// Those at rest, in the coordinates of the mesh.
    at_rest: BTreeMap<NodeId, Vec<Vec3>>,
}

impl<'l> Lowering<'l, '_, '_> {
    /// A scene that stands for all times of an animation: the vertices of its surfaces are on the
    /// hulls of what the nodes show. `None` if that takes too much work, or there is nothing.
    pub(super) fn swept(
        &mut self,
        animation: &Animation,
        scene_from_file: Option<[Vec3; 3]>,
    ) -> Option<Scene> {
        let shown = transform::shown(self.doc);
        let points = shown.iter().map(|node| self.moved_points(*node));
        let numbers = pose::numbers(self.doc, animation);
        let points = points.fold(numbers, usize::saturating_add).max(1);
        let poses = (MOST_POINTS / points).min(MOST_POSES);
        let [first, last] = pose::span(self.doc, animation).filter(|_| poses >= 2)?;
        // Move a hull of each primitive through the poses.
        let mut swept = SweptHulls::default();
        for at in 0..poses {
            let share = at as f64 / (poses - 1) as f64;
            let pose = pose::moved(self.doc, animation, first + (last - first) * share);
            let worlds = transform::worlds(self.doc, &pose, scene_from_file);
            let mut shapes = Deformations::default();
            for node in &shown {
                self.sweep(*node, (&pose, &worlds), &mut shapes, &mut swept)?;
            }
        }
        // Make a surface of each hull.
        let mut scene = empty();
        for ((node, at), hull) in swept.hulls {
            let mesh = self.doc.nodes[node].mesh?;
            let material = self.material(&self.doc.meshes[mesh].primitives[at]);
            let shape = Shape::Instance(Instance {
                mesh: MeshId(to_u32(scene.meshes.len())),
                world_from_object: DAffine3::IDENTITY.to_cols_array_2d(),
            });
            scene.surfaces.push(Surface::new(shape, material));
            scene.meshes.push(hull.mesh());
        }
        scene.materials.clone_from(&self.scene.materials);
        (!scene.surfaces.is_empty()).then_some(scene)
    }

    /// The primitives of a node.
    fn primitives(&self, node: usize) -> &'l [Primitive] {
        let mesh = self.doc.nodes[node].mesh;
        let mesh = mesh.and_then(|mesh| self.doc.meshes.get(mesh));
        mesh.map_or(&[], |mesh| mesh.primitives.as_slice())
    }

    /// The points of a node that are moved in each pose: of meshes that change their shape all
    /// vertices.
    fn moved_points(&self, node: usize) -> usize {
        let of = &self.doc.nodes[node];
        let instances = of.instances.as_ref().map_or(1, |instances| {
            InstanceTransforms::many(self.doc, DAffine3::IDENTITY, instances).count()
        });
        let points = |primitive: &Primitive| match of.skin {
            None if primitive.targets.is_empty() => SweptHull::POINTS,
            _ => usize::try_from(mesh::vertices_of(self.doc, primitive)).unwrap_or(usize::MAX),
        };
        let all = self.primitives(node).iter().map(points);
        all.fold(0, usize::saturating_add).saturating_mul(instances)
    }

    /// Adds what a node shows in a pose. `None` if that exceeds the budget.
    fn sweep(
        &mut self,
        node: usize,
        (pose, worlds): (&ScenePose, &[DAffine3]),
        shapes: &mut Deformations,
        swept: &mut SweptHulls,
    ) -> Option<()> {
        let doc = self.doc;
        let of = &doc.nodes[node];
        let Some(mesh) = of.mesh.and_then(|mesh| doc.meshes.get(mesh)) else {
            return Some(());
        };
        let is_skinned = mesh.is_skinned() == Some(true);
        let skin = of.skin.filter(|skin| *skin < doc.skins.len() && is_skinned);
        let shape = shapes.of_node(doc, (node, skin), (pose, worlds), self.report)?;
        let shape = (shape, shapes.get(shape));
        let is_rigid = shape.1.joints.is_none() && shape.1.weights.is_empty();
        let places = InstanceTransforms::of_node(doc, of, skin, worlds[node]);
        for (at, primitive) in mesh.primitives.iter().enumerate() {
            let wanted = RequestedMesh {
                primitive,
                name: "",
                shape,
                tangents: None,
                uv_sets: super::uv::TexCoordSets::default(),
            };
            let is_lenient = self.report.is_lenient();
            let read = || mesh::used_points(doc, &wanted, is_lenient).unwrap_or_default();
            let deformed;
            let points = if is_rigid {
                let at_rest = swept.at_rest.entry(primitive.at);
                at_rest.or_insert_with(|| SweptHull::of(&read()).points())
            } else {
                deformed = read();
                &deformed
            };
            let hull = swept.hulls.entry((node, at)).or_default();
            for place in (0..places.count()).map(|place| places.at(place)) {
                points
                    .iter()
                    .for_each(|point| hull.add(place.transform_point3(*point)));
            }
        }
        Some(())
    }
}
