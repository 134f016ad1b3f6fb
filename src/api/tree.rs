//! The contents of a scene, read-only.

use super::{Camera, Light, Location, Material, MaterialId, ObjectId, Shape};
use rtc_ir::{self as ir, EntityField, EntityKind, LoweredScene, ValuePath};
use rtc_math::Vec3;
use rtc_source::{SourceMap, Span};
use std::sync::OnceLock;

/// The contents of a scene: camera, objects, materials and lights. [`super::Scene::edit`] changes
/// them.
///
/// ```
/// use rtc::Scene;
///
/// # fn main() -> Result<(), rtc::Error> {
/// let text = "\
/// Camera: {eye: [0, 0, 9], center: [0, 0, 0], up: [0, 1, 0], viewSize: [32, 24], fov: 30}
/// Lights:
/// - {position: [5, 5, 9], color: [1, 1, 1]}
/// Objects:
/// - {type: sphere, position: [0, 0, 0], radius: 2,
///    material: {color: [1, 0, 0], ka: 0.2, kd: 0.8, ks: 0, n: 1}}
/// ";
/// let scene = Scene::from_files("ball.yaml", [("ball.yaml".to_owned(), text.into())])?;
/// let tree = scene.tree().unwrap();
/// let ball = tree.objects().next().unwrap();
/// assert_eq!((ball.shape().kind(), ball.location().unwrap().line), ("sphere", Some(5)));
/// assert_eq!(tree.bounds(), Some([[-2.0; 3], [2.0; 3]]));
/// assert_eq!(tree.lights().count(), 1);
/// # Ok(())
/// # }
/// ```
pub struct SceneContents<'a> {
    lowered: &'a LoweredScene,
    map: &'a SourceMap,
    /// The bounding box of each mesh.
    boxes: OnceLock<Vec<[Vec3; 2]>>,
}

/// An object of a scene: a shape with a material.
///
/// ```
/// use rtc::{Camera, Phong, SceneBuilder, Shape};
///
/// let mut builder = SceneBuilder::new(Camera::look_at([0.0, 0.0, 6.0], [0.0; 3]));
/// builder.add(Shape::sphere([0.0; 3], 1.0), Phong::default());
/// let scene = builder.build().unwrap();
/// let tree = scene.tree().unwrap();
/// let object = tree.objects().next().unwrap();
/// assert_eq!(object.shape().value("radius"), Some(vec![1.0]));
/// assert_eq!(object.bounds(), Some([[-1.0; 3], [1.0; 3]]));
/// ```
#[derive(Clone, Copy)]
pub struct Object<'a> {
    tree: &'a SceneContents<'a>,
    index: usize,
}

impl<'a> SceneContents<'a> {
    pub(super) fn new(lowered: &'a LoweredScene, map: &'a SourceMap) -> Self {
        let boxes = OnceLock::new();
        Self {
            lowered,
            map,
            boxes,
        }
    }

    fn scene(&self) -> &'a ir::Scene {
        &self.lowered.scene
    }

    /// The camera.
    pub fn camera(&self) -> Camera {
        Camera::of(&self.scene().camera)
    }

    /// The objects. An object of a scene text may be several of these, as a mesh with several
    /// materials is.
    pub fn objects(&self) -> impl ExactSizeIterator<Item = Object<'_>> {
        let count = self.scene().surfaces.len();
        (0..count).map(|index| Object { tree: self, index })
    }

    /// The first object of this name.
    #[must_use]
    pub fn find(&self, name: &str) -> Option<Object<'_>> {
        let mut names = self.scene().names.iter();
        let index = names.position(|own| own == name)?;
        Some(Object { tree: self, index })
    }

    /// The materials; an index is a [`MaterialId`].
    #[must_use]
    pub fn materials(&self) -> &'a [Material] {
        &self.scene().materials
    }

    /// The lights, without the environment and emissive surfaces.
    pub fn lights(&self) -> impl ExactSizeIterator<Item = Light> {
        self.scene().lights.iter().cloned().map(Light)
    }

    /// Whether there is an environment.
    #[must_use]
    pub fn has_environment(&self) -> bool {
        self.scene().environment.is_some()
    }

    /// The lower and the upper corner of a box around all finite objects; `None` if there are none.
    #[must_use]
    pub fn bounds(&self) -> Option<[[f64; 3]; 2]> {
        self.around(0..self.scene().surfaces.len())
    }

    fn around(&self, surfaces: impl IntoIterator<Item = usize>) -> Option<[[f64; 3]; 2]> {
        let boxes = self.boxes.get_or_init(|| self.scene().mesh_boxes());
        let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        for index in surfaces {
            let shape = &self.scene().surfaces[index].shape;
            shape.corners_around(boxes, &mut |corner| {
                (low, high) = (low.min(corner), high.max(corner));
            });
        }
        low.is_finite().then(|| [low.to_array(), high.to_array()])
    }

    /// The source position of the camera, if any.
    #[must_use]
    pub fn camera_location(&self) -> Option<Location> {
        self.location(EntityKind::Camera, 0)
    }

    /// Where a light was written, if it was.
    #[must_use]
    pub fn light_location(&self, index: usize) -> Option<Location> {
        self.location(EntityKind::Light, index)
    }

    fn location(&self, entity: EntityKind, index: usize) -> Option<Location> {
        let whole = ValuePath::new(entity, index, EntityField::Whole);
        let span: Span = self.lowered.source_spans.span(whole)?;
        Some(Location::new(span, self.map))
    }
}

impl<'a> Object<'a> {
    /// Its index.
    #[must_use]
    pub fn id(&self) -> ObjectId {
        ObjectId(self.index)
    }

    /// Its name; empty if it has none.
    #[must_use]
    pub fn name(&self) -> &'a str {
        let name = self.tree.scene().names.get(self.index);
        name.map_or("", String::as_str)
    }

    /// Its shape.
    #[must_use]
    pub fn shape(&self) -> Shape {
        Shape(self.surface().shape.clone())
    }

    /// The index of its material.
    #[must_use]
    pub fn material(&self) -> MaterialId {
        self.surface().material
    }

    /// Whether it casts shadows; in traced paths all do.
    #[must_use]
    pub fn casts_shadow(&self) -> bool {
        !self.surface().casts_no_shadow
    }

    /// How far it moves per second, while the shutter is open.
    #[must_use]
    pub fn velocity(&self) -> [f64; 3] {
        self.surface().velocity.get()
    }

    /// The lower and the upper corner of a box around it; `None` if it is infinite.
    #[must_use]
    pub fn bounds(&self) -> Option<[[f64; 3]; 2]> {
        self.tree.around([self.index])
    }

    /// Its source position, if any.
    #[must_use]
    pub fn location(&self) -> Option<Location> {
        self.tree.location(EntityKind::Surface, self.index)
    }

    fn surface(&self) -> &ir::Surface {
        &self.tree.scene().surfaces[self.index]
    }
}
