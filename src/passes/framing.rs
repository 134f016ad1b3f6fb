//! Framing: a camera that shows the whole scene as large as possible.

use glam::DAffine3;
use rtc_ir::{Alpha, Camera, Lens, Material, Mesh, Projection, Scene, Shape, SourceSpans, Surface};
use rtc_math::{Vec3, acos, atan2, cos, sin};
use std::f64::consts::FRAC_PI_2;

/// The fraction of the picture that the subject spans, in the direction in which it is larger.
const SUBJECT_FRACTION: f64 = 0.85;
/// The vertical field of view in degrees and the picture size, for a scene without a camera.
const DEFAULT_YFOV_DEGREES: f64 = 35.0;
const SIZE: [u32; 2] = [512; 2];
/// A surface is a ground if its height is at most this fraction of its width, and if it is at least
/// this many times as wide as the rest of the scene.
const MAX_FLATNESS: f64 = 0.02;
const MIN_GROUND_RATIO: f64 = 2.0;
/// With more triangles than this, each mesh is replaced by its bounding box.
const MAX_TRIANGLES: usize = 1 << 22;

/// A viewing direction in spherical coordinates, in radians.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrbitAngles {
    /// The angle about the upward axis: 0 is the front (+z), π/2 the right (+x).
    pub azimuth: f64,
    /// The angle above the horizon, −π/2 to π/2.
    pub elevation: f64,
    /// The roll of the camera about its view direction, clockwise as seen through the camera.
    pub roll: f64,
}

impl Default for OrbitAngles {
    /// A three-quarter view: 34° to the right of the front, 23° above.
    fn default() -> Self {
        let from = Vec3::new(2.0, 1.5, 3.0).normalize();
        Self {
            azimuth: atan2(from.x, from.z),
            elevation: FRAC_PI_2 - acos(from.y),
            roll: 0.0,
        }
    }
}

/// The parameters of framing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Framing {
    /// The viewing direction.
    pub orbit: OrbitAngles,
    /// The vertical field of view in radians, above 0 and below π; by default 35°.
    pub yfov: Option<f64>,
    /// Width and height of the picture in pixels; by default 512 × 512.
    pub size: Option<[u32; 2]>,
    /// The index of the studio's ground surface, which is not part of the subject.
    pub ground: Option<usize>,
}

impl Framing {
    /// Sets the camera of a scene so that its subject, without a ground under it, is centred and
    /// spans 85 % of the picture in one direction. The subject of an animation is what it shows at
    /// all times. A scene without bounded surfaces keeps its camera.
    pub fn apply(&self, scene: &mut Scene, source_spans: &SourceSpans) {
        if let Some(camera) = self.camera(&[self.subject(scene, source_spans)]) {
            scene.camera = camera;
        }
    }

    /// What is framed of a scene: of an animation what it shows at all times; and the index of its
    /// studio's ground.
    #[must_use]
    pub fn subject<'scene>(
        &self,
        scene: &'scene Scene,
        source_spans: &'scene SourceSpans,
    ) -> (&'scene Scene, Option<usize>) {
        match &source_spans.swept {
            Some(swept) => (swept, None),
            None => (scene, self.ground),
        }
    }

    /// The camera that shows the subjects of all these scenes, each with the index of its studio's
    /// ground; `None` if they have no bounded surfaces.
    #[must_use]
    pub fn camera(&self, scenes: &[(&Scene, Option<usize>)]) -> Option<Camera> {
        let mut spheres = scenes.iter().map(|(scene, _)| scene.bounding_sphere());
        let sphere = spheres.find_map(|sphere| sphere)?;
        let axes = self.orbit.axes();
        let size = self.size.unwrap_or(SIZE);
        let half = self.yfov.unwrap_or(DEFAULT_YFOV_DEGREES.to_radians()) / 2.0;
        let tangent = sin(half) / cos(half);
        let aspect = f64::from(size[0]) / f64::from(size[1]);
        let tangents = [tangent * aspect, tangent];
        let mut fit = CameraFit::new(axes, tangents.map(|tangent| tangent * SUBJECT_FRACTION));
        for (scene, ground) in scenes {
            FramingSubject::of(scene, *ground)
                .corners(&mut |corner| fit.add(corner - sphere.center));
        }
        let (eye, depth) = fit.eye()?;
        let [x, y, z] = axes;
        // Place the image plane in the middle of the subject's depth.
        let distance = eye.dot(z) - depth;
        let step = |axis: Vec3, tangent: f64, count: u32| {
            (axis * (2.0 * tangent * distance / f64::from(count))).to_array()
        };
        Some(Camera {
            eye: (sphere.center + eye).to_array(),
            center: (sphere.center + eye - z * distance).to_array(),
            right: step(x, tangents[0], size[0]),
            up: step(y, tangents[1], size[1]),
            size,
            lens: Lens::PINHOLE,
            projection: Projection::Perspective,
        })
    }
}

/// The bounding box of the subject of a scene; `None` if the scene has a ground or nothing bounded.
pub(super) fn standing_bounds(scene: &Scene) -> Option<[Vec3; 2]> {
    let subject = FramingSubject::of(scene, None);
    let mut bounds = EMPTY;
    subject.corners(&mut |corner| bounds = [bounds[0].min(corner), bounds[1].max(corner)]);
    (!subject.has_ground && bounds[0].x <= bounds[1].x).then_some(bounds)
}

impl OrbitAngles {
    /// The camera axes: right, up, and from the scene to the eye.
    fn axes(&self) -> [Vec3; 3] {
        let Self {
            azimuth,
            elevation,
            roll,
        } = *self;
        let elevation = elevation.clamp(-FRAC_PI_2, FRAC_PI_2);
        let ahead = Vec3::new(sin(azimuth), 0.0, cos(azimuth));
        let z = ahead * cos(elevation) + Vec3::Y * sin(elevation);
        let x = Vec3::new(cos(azimuth), 0.0, -sin(azimuth));
        let y = z.cross(x);
        // Roll the camera about its view direction.
        let (sine, cosine) = (sin(roll), cos(roll));
        [x * cosine - y * sine, y * cosine + x * sine, z]
    }
}

/// Finds the eye position from which all points are within the field of view.
///
/// A point at (a, b, c) along the axes is within the tangent t of an eye at (e, f, g) if
/// |a − e| ≤ t·(g − c): four half spaces, of which the outermost ones decide.
struct CameraFit {
    axes: [Vec3; 3],
    tangents: [f64; 2],
    /// For both directions of x and y, the largest ±a + t·c.
    bounds: [[f64; 2]; 2],
    /// The minimum and the maximum of c.
    depth: [f64; 2],
}

impl CameraFit {
    fn new(axes: [Vec3; 3], tangents: [f64; 2]) -> Self {
        Self {
            axes,
            tangents,
            bounds: [[f64::NEG_INFINITY; 2]; 2],
            depth: [f64::INFINITY, f64::NEG_INFINITY],
        }
    }

    fn add(&mut self, point: Vec3) {
        let [x, y, z] = self.axes.map(|axis| axis.dot(point));
        for ((bounds, along), tangent) in self.bounds.iter_mut().zip([x, y]).zip(self.tangents) {
            bounds[0] = bounds[0].max(along + tangent * z);
            bounds[1] = bounds[1].max(tangent * z - along);
        }
        self.depth = [self.depth[0].min(z), self.depth[1].max(z)];
    }

    /// The nearest eye position that centres the points, and the middle of their depth along the
    /// third axis; `None` for fewer than two distinct points.
    fn eye(&self) -> Option<(Vec3, f64)> {
        let far = |k: usize| (self.bounds[k][0] + self.bounds[k][1]) / (2.0 * self.tangents[k]);
        let aside = |k: usize| (self.bounds[k][0] - self.bounds[k][1]) / 2.0;
        let back = far(0).max(far(1));
        let depth = self.depth[0] + (self.depth[1] - self.depth[0]) / 2.0;
        let [x, y, z] = self.axes;
        let eye = x * aside(0) + y * aside(1) + z * back;
        (eye.is_finite() && back > depth).then_some((eye, depth))
    }
}

/// The surfaces that a picture shows.
struct FramingSubject<'scene> {
    scene: &'scene Scene,
    surfaces: Vec<&'scene Surface>,
    /// The bounding boxes of the meshes.
    boxes: Vec<[Vec3; 2]>,
    /// The used vertices of each mesh; `None` if meshes are replaced by their bounding boxes.
    vertices: Option<Vec<Vec<u32>>>,
    /// Whether ground surfaces were removed.
    has_ground: bool,
}

impl<'scene> FramingSubject<'scene> {
    /// All visible surfaces, without the surface `ground` and without grounds of the scene.
    fn of(scene: &'scene Scene, ground: Option<usize>) -> Self {
        let is_visible = |surface: &&Surface| {
            let material = scene.materials.get(surface.material.0 as usize);
            !material.is_some_and(is_invisible)
        };
        let triangles =
            |surface: &&Surface| mesh(scene, surface).map_or(0, |(mesh, ..)| mesh.triangles.len());
        let count = scene.surfaces.iter().map(|surface| triangles(&surface));
        let candidates = || {
            let all = scene.surfaces.iter().enumerate();
            all.filter(|(index, _)| Some(*index) != ground)
                .map(|(_, surface)| surface)
        };
        let mut subject = Self {
            scene,
            surfaces: candidates().filter(is_visible).collect(),
            boxes: scene.mesh_boxes(),
            vertices: (count.fold(0, usize::saturating_add) <= MAX_TRIANGLES)
                .then(|| scene.meshes.iter().map(used_vertices).collect()),
            has_ground: false,
        };
        if subject.surfaces.is_empty() {
            subject.surfaces = candidates().collect();
        }
        subject.remove_ground();
        subject
    }

    /// Removes the surfaces that are a ground under the others.
    fn remove_ground(&mut self) {
        let boxes: Vec<_> = self
            .surfaces
            .iter()
            .map(|surface| self.bounds(surface))
            .collect();
        let standing_bounds = boxes.iter().filter(|bounds| !is_flat(**bounds));
        let standing_bounds_of_rest = standing_bounds.fold(EMPTY, |[low, high], [from, to]| {
            [low.min(*from), high.max(*to)]
        });
        let (mut boxes, count) = (boxes.into_iter(), self.surfaces.len());
        self.surfaces.retain(|_| {
            !boxes.next().is_some_and(|bounds| {
                is_flat(bounds) && is_ground_of(bounds, standing_bounds_of_rest)
            })
        });
        self.has_ground = self.surfaces.len() < count;
    }

    /// The bounding box of a surface.
    fn bounds(&self, surface: &Surface) -> [Vec3; 2] {
        let mut bounds = EMPTY;
        self.each_corner(surface, &mut |corner| {
            bounds = [bounds[0].min(corner), bounds[1].max(corner)];
        });
        bounds
    }

    fn corners(&self, visit: &mut dyn FnMut(Vec3)) {
        for surface in &self.surfaces {
            self.each_corner(surface, visit);
        }
    }

    /// Visits the vertices of a surface; without vertices, the corners of its bounding box; none
    /// for an unbounded surface.
    fn each_corner(&self, surface: &Surface, visit: &mut dyn FnMut(Vec3)) {
        let in_world = self.vertices.as_ref().zip(mesh(self.scene, surface));
        let Some((vertices, (mesh, index, world))) = in_world else {
            return surface.shape.corners_around(&self.boxes, visit);
        };
        for vertex in &vertices[index] {
            let position = mesh.positions.at(*vertex as usize);
            visit(world.transform_point3(Vec3::from_array(position)));
        }
    }
}

/// The valid vertex indices that the triangles of a mesh use.
fn used_vertices(mesh: &Mesh) -> Vec<u32> {
    let mut is_used = vec![false; mesh.positions.len()];
    for corner in mesh.triangles.iter().flatten() {
        if let Some(is_used) = is_used.get_mut(*corner as usize) {
            *is_used = true;
        }
    }
    let all = (0_u32..).zip(is_used);
    all.filter_map(|(vertex, is_used)| is_used.then_some(vertex))
        .collect()
}

/// The empty bounding box.
const EMPTY: [Vec3; 2] = [Vec3::INFINITY, Vec3::NEG_INFINITY];

/// The mesh of a surface, its index and its transform, if the surface is a mesh instance.
fn mesh<'scene>(
    scene: &'scene Scene,
    surface: &Surface,
) -> Option<(&'scene Mesh, usize, DAffine3)> {
    let Shape::Instance(instance) = &surface.shape else {
        return None;
    };
    let index = instance.mesh.0 as usize;
    Some((
        scene.meshes.get(index)?,
        index,
        DAffine3::from_cols_array_2d(&instance.world_from_object),
    ))
}

/// Whether a material is fully transparent.
fn is_invisible(material: &Material) -> bool {
    let Material::Standard(standard) = material else {
        return false;
    };
    match standard.alpha {
        _ if standard.blend_with.is_some() => false,
        Alpha::Opaque => false,
        Alpha::Blend => standard.base_color[3] == 0.0,
        Alpha::Mask(cutoff) => standard.base_color[3] < cutoff,
    }
}

/// Whether a box is flat and horizontal.
fn is_flat([low, high]: [Vec3; 2]) -> bool {
    let extent = high - low;
    extent.y <= MAX_FLATNESS * extent.x.min(extent.z) && extent.x.min(extent.z) > 0.0
}

/// Whether a flat box is the ground of others: below their middle, and much wider.
fn is_ground_of([low, high]: [Vec3; 2], [from, to]: [Vec3; 2]) -> bool {
    let (candidates, others) = (high - low, to - from);
    let widest = others.x.max(others.z);
    widest.is_finite()
        && widest > 0.0
        && candidates.x.min(candidates.z) >= MIN_GROUND_RATIO * widest
        && high.y <= (from.y + to.y) / 2.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use rtc_ir::{Instance, MaterialId, MeshId, Settings, Triangle};
    use std::f64::consts::PI;

    fn empty() -> Scene {
        let camera = Camera {
            eye: [0.0, 0.0, 1.0],
            center: [0.0; 3],
            right: [1.0, 0.0, 0.0],
            up: [0.0, 1.0, 0.0],
            size: [1; 2],
            lens: Lens::PINHOLE,
            projection: Projection::Perspective,
        };
        Scene::new(camera, Settings::default())
    }

    /// A scene of boxes, each with two opposite corners.
    fn scene(boxes: &[[[f64; 3]; 2]]) -> Scene {
        let mut scene = empty();
        for [low, high] in boxes {
            let pick = |corner: usize, k: usize| {
                if corner >> k & 1 == 0 {
                    low[k]
                } else {
                    high[k]
                }
            };
            let positions: Vec<_> = (0..8)
                .map(|corner| [0, 1, 2].map(|k| pick(corner, k)))
                .collect();
            let mesh = MeshId(u32::try_from(scene.meshes.len()).expect("few"));
            scene.meshes.push(Mesh {
                positions: positions.into(),
                triangles: vec![[0, 1, 2], [3, 4, 5], [6, 7, 0]].into(),
                ..Mesh::default()
            });
            let world_from_object = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0; 3]];
            scene.surfaces.push(Surface::new(
                Shape::Instance(Instance {
                    mesh,
                    world_from_object,
                }),
                MaterialId(0),
            ));
        }
        scene
    }

    /// The projected corners of some boxes, −1 to 1 across the picture: minimum and maximum.
    fn shown(scene: &Scene, boxes: &[[[f64; 3]; 2]]) -> [[f64; 2]; 2] {
        let camera = &scene.camera;
        let [eye, center, right, up] =
            [camera.eye, camera.center, camera.right, camera.up].map(Vec3::from_array);
        let z = (eye - center).normalize();
        let mut shown = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
        for corner in boxes
            .iter()
            .flat_map(|corners| (0..8).map(move |corner| (corners, corner)))
        {
            let (corners, bits) = corner;
            let at = Vec3::from_array([0, 1, 2].map(|k| corners[bits >> k & 1][k])) - eye;
            let scale = (eye - center).length() / -at.dot(z);
            for ((range, step), size) in shown.iter_mut().zip([right, up]).zip(camera.size) {
                let along = at.dot(step) * scale / step.length_squared() / (f64::from(size) / 2.0);
                *range = [range[0].min(along), range[1].max(along)];
            }
        }
        shown
    }

    fn framed(boxes: &[[[f64; 3]; 2]], framing: Framing) -> Scene {
        let mut scene = scene(boxes);
        framing.apply(&mut scene, &SourceSpans::default());
        scene
    }

    #[test]
    fn a_subject_spans_85_percent_and_stands_in_the_middle() {
        let sizes = [None, Some([300, 100]), Some([100, 300])];
        for ((stretch, size), yfov) in [[1.0, 1.0, 1.0], [9.0, 0.5, 1.0], [0.2, 5.0, 0.2]]
            .iter()
            .zip(sizes)
            .zip([None, Some(0.1), Some(2.0)])
        {
            let far = [7000.0, -300.0, 40.0];
            let corner = |sign: f64| [0, 1, 2].map(|k| far[k] + sign * stretch[k]);
            let boxes = [[corner(-1.0), corner(1.0)]];
            let framing = Framing {
                yfov,
                size,
                ..Framing::default()
            };
            let [x, y] = shown(&framed(&boxes, framing), &boxes);
            let spans = [x, y].map(|[from, to]| (to - from) / 2.0);
            assert!(
                (spans[0].max(spans[1]) - SUBJECT_FRACTION).abs() < 1e-9,
                "{spans:?}"
            );
            for [from, to] in [x, y] {
                assert!(
                    (from + to).abs() < 0.3
                        && from >= -SUBJECT_FRACTION - 1e-9
                        && to <= SUBJECT_FRACTION + 1e-9
                );
            }
            let widest = if spans[0] > spans[1] { x } else { y };
            assert!(
                (widest[0] + widest[1]).abs() < 1e-9,
                "{widest:?} is in the middle"
            );
        }
    }

    #[test]
    fn a_wide_ground_is_no_subject_but_a_floor_alone_is() {
        let sphere = [[-1.0, 0.0, -1.0], [1.0, 2.0, 1.0]];
        let ground = [[-90.0, -0.01, -90.0], [90.0, 0.0, 90.0]];
        let (alone, on_ground) = (
            framed(&[sphere], Framing::default()),
            framed(&[sphere, ground], Framing::default()),
        );
        let distance = |scene: &Scene| scene.camera.distance();
        assert!((distance(&alone) - distance(&on_ground)).abs() < 1e-9);
        assert!(distance(&framed(&[ground], Framing::default())) > 100.0);
        // A roof of the same size and a small floor are part of the subject.
        let (roof, floor) = (
            [[-90.0, 5.0, -90.0], [90.0, 5.1, 90.0]],
            [[-1.5, -0.01, -1.5], [1.5, 0.0, 1.5]],
        );
        assert!(distance(&framed(&[sphere, roof], Framing::default())) > 100.0);
        assert!(distance(&framed(&[sphere, floor], Framing::default())) > 1.05 * distance(&alone));
    }

    #[test]
    fn an_orbit_goes_to_the_right_and_up_and_rolls_clockwise() {
        let at = |azimuth: f64, elevation: f64, roll: f64| {
            let orbit = OrbitAngles {
                azimuth,
                elevation,
                roll,
            };
            let [x, y, z] = orbit.axes();
            assert!((x.cross(y) - z).length() < 1e-12);
            (y, z)
        };
        let near = |(a, b): (Vec3, Vec3), (c, d): (Vec3, Vec3)| {
            (a - c).length() + (b - d).length() < 1e-12
        };
        assert!(near(at(0.0, 0.0, 0.0), (Vec3::Y, Vec3::Z)));
        assert!(near(at(PI / 2.0, 0.0, 0.0), (Vec3::Y, Vec3::X)));
        assert!(near(at(0.0, PI / 2.0, 0.0), (-Vec3::Z, Vec3::Y)));
        // The camera rolls clockwise: the up direction leans to its left.
        assert!(near(at(0.0, 0.0, PI / 2.0), (Vec3::X, Vec3::Z)));
    }

    #[test]
    fn what_an_animation_shows_at_all_times_is_framed_in_place_of_the_scene() {
        let [left, right] = [-9.0, 5.0].map(|x| [[x, 0.0, 0.0], [x + 1.0, 2.0, 1.0]]);
        let mut swept = SourceSpans::default();
        swept.swept = Some(Box::new(scene(&[left, right])));
        let cameras = [left, right].map(|now| {
            let mut scene = scene(&[now]);
            Framing::default().apply(&mut scene, &swept);
            scene.camera
        });
        assert_eq!(cameras[0], cameras[1]);
        assert_eq!(
            cameras[0],
            framed(&[left, right], Framing::default()).camera
        );
    }

    #[test]
    fn a_scene_without_extent_keeps_its_camera() {
        let mut point = scene(&[]);
        point.surfaces.push(Surface::new(
            Shape::Triangle(Triangle {
                vertices: [[1.0; 3]; 3],
                uvs: None,
            }),
            MaterialId(0),
        ));
        for mut scene in [scene(&[]), point] {
            let before = scene.camera.clone();
            Framing::default().apply(&mut scene, &SourceSpans::default());
            assert_eq!(scene.camera, before);
        }
    }

    #[test]
    fn the_ground_of_the_studio_takes_no_part() {
        let flat = [[[-1.0, 0.0, -1.0], [1.0, 0.0, 1.0]]];
        let mut scene = scene(&flat);
        let [low, high] = flat[0].map(Vec3::from_array);
        let ground = crate::ground::add_ground(&mut scene, [low, high], 0.5);
        assert_eq!(ground, Some(1));
        let framing = Framing {
            ground,
            ..Framing::default()
        };
        framing.apply(&mut scene, &SourceSpans::default());
        let spans = shown(&scene, &flat).map(|[least, most]| (most - least) / 2.0);
        assert!(
            (spans[0].max(spans[1]) - SUBJECT_FRACTION).abs() < 1e-9,
            "{spans:?}"
        );
    }
}
