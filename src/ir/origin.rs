//! Source spans of the values of a scene. They are stored beside the scene and never serialised.

use super::{Scene, ShapeKind, Standard};
use rtc_math::to_u32;
use rtc_source::Span;
use std::fmt;

/// A kind of entity of the scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum EntityKind {
    /// The camera.
    Camera,
    /// The settings.
    Settings,
    /// A light.
    Light,
    /// An image.
    Image,
    /// A texture.
    Texture,
    /// A mesh.
    Mesh,
    /// A material.
    Material,
    /// A surface.
    Surface,
    /// The environment light.
    Environment,
    /// The medium around the camera.
    Medium,
}

impl EntityKind {
    /// All kinds, in declaration order.
    const ALL: [Self; Self::Medium as usize + 1] = [
        Self::Camera,
        Self::Settings,
        Self::Light,
        Self::Image,
        Self::Texture,
        Self::Mesh,
        Self::Material,
        Self::Surface,
        Self::Environment,
        Self::Medium,
    ];
}

/// A value of an entity, or the entity itself ([`EntityField::Whole`]).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[expect(missing_docs, reason = "each names the field of the IR it stands for")]
pub enum EntityField {
    Whole,
    Eye,
    Center,
    Right,
    Up,
    /// The field of view.
    Fov,
    /// The size of a pixel that the length of `up` does not give.
    PixelSize,
    Size,
    LensRadius,
    LensSamples,
    Mode,
    GoochB,
    GoochY,
    GoochAlpha,
    GoochBeta,
    MaxDepth,
    Supersampling,
    LightSamples,
    /// The colour of the ambient light.
    AmbientLight,
    /// The background.
    Background,
    /// The distance between two eyes.
    Stereo,
    /// When the shutter opens and closes.
    Shutter,
    /// The velocity of a surface.
    Velocity,
    Position,
    Color,
    LightRadius,
    Ka,
    Kd,
    Ks,
    Kr,
    N,
    Kt,
    Ior,
    GlossySamples,
    ColorMap,
    SpecularMap,
    NormalMap,
    Bump,
    /// A value of a shape: its index in the shape's row of the table of shapes.
    Shape(ShapeKind, u8),
    /// A parameter of a standard material: its row in the table of parameters.
    Parameter(u8),
    Intensity,
    Material,
}

/// The path to a value in a scene; displayed as a JSON pointer into the JSON encoding.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct ValuePath {
    /// The kind of entity.
    pub entity: EntityKind,
    /// Its index; 0 for the camera and the settings.
    pub index: u32,
    /// The value.
    pub field: EntityField,
}

impl EntityField {
    /// The value of a shape at this path in the IR, for example `radius` or `vertices/0`.
    ///
    /// # Panics
    /// If the shape has no such value.
    #[must_use]
    pub fn of_shape(kind: ShapeKind, path: &str) -> Self {
        let at = kind.values().iter().position(|known| *known == path);
        let at = at.and_then(|at| u8::try_from(at).ok());
        Self::Shape(kind, at.expect("the row of the shape has this value"))
    }

    /// The parameter of a standard material of this name in the IR, for example `ior`.
    ///
    /// # Panics
    /// If there is no such parameter.
    #[must_use]
    pub fn of_parameter(name: &str) -> Self {
        let at = Standard::PARAMETERS.iter().position(|known| *known == name);
        let at = at.and_then(|at| u8::try_from(at).ok());
        Self::Parameter(at.expect("the table has this parameter"))
    }
}

impl ValuePath {
    /// The path to `field` of entity `index` of kind `entity`.
    #[must_use]
    pub fn new(entity: EntityKind, index: usize, field: EntityField) -> Self {
        Self {
            entity,
            index: to_u32(index),
            field,
        }
    }
}

impl fmt::Display for ValuePath {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let index = self.index;
        match self.entity {
            EntityKind::Camera => f.write_str("/camera"),
            EntityKind::Settings => f.write_str("/settings"),
            EntityKind::Light => write!(f, "/lights/{index}"),
            EntityKind::Image => write!(f, "/images/{index}"),
            EntityKind::Texture => write!(f, "/textures/{index}"),
            EntityKind::Mesh => write!(f, "/meshes/{index}"),
            EntityKind::Material => write!(f, "/materials/{index}"),
            EntityKind::Surface => write!(f, "/surfaces/{index}"),
            EntityKind::Environment => f.write_str("/environment"),
            EntityKind::Medium => f.write_str("/medium"),
        }?;
        if let EntityField::Shape(kind, value) = self.field {
            let path = kind.values()[usize::from(value)];
            return write!(f, "/shape/{}/{path}", kind.name());
        }
        if let EntityField::Parameter(row) = self.field {
            return write!(f, "/standard/{}", Standard::PARAMETERS[usize::from(row)]);
        }
        f.write_str(pointer_tail(self.entity, self.field))
    }
}

fn pointer_tail(entity: EntityKind, field: EntityField) -> &'static str {
    // Each field has the path of its JSON key.
    match field {
        EntityField::Whole | EntityField::Shape(..) | EntityField::Parameter(_) => "",
        EntityField::Eye => "/eye",
        EntityField::Center => "/center",
        EntityField::Right => "/right",
        EntityField::Up | EntityField::Fov | EntityField::PixelSize => "/up",
        EntityField::Size => "/size",
        EntityField::LensRadius => "/lens/radius",
        EntityField::LensSamples => "/lens/samples",
        EntityField::Mode => "/mode",
        EntityField::GoochB => "/mode/gooch/b",
        EntityField::GoochY => "/mode/gooch/y",
        EntityField::GoochAlpha => "/mode/gooch/alpha",
        EntityField::GoochBeta => "/mode/gooch/beta",
        EntityField::MaxDepth => "/maxDepth",
        EntityField::Supersampling => "/supersampling",
        EntityField::LightSamples => "/lightSamples",
        EntityField::AmbientLight => "/ambientLight",
        EntityField::Background => "/background",
        EntityField::Stereo => "/stereo",
        EntityField::Shutter => "/shutter",
        EntityField::Velocity => "/velocity",
        EntityField::Position => "/point/position",
        EntityField::LightRadius => "/point/radius",
        EntityField::Intensity => "/punctual/intensity",
        EntityField::Color if entity == EntityKind::Light => "/point/color",
        EntityField::Color if entity == EntityKind::Environment => "/radiance",
        EntityField::Color => "/phong/color",
        EntityField::Ka => "/phong/ka",
        EntityField::Kd => "/phong/kd",
        EntityField::Ks => "/phong/ks",
        EntityField::Kr => "/phong/kr",
        EntityField::N => "/phong/n",
        EntityField::Kt => "/phong/kt",
        EntityField::Ior => "/phong/eta",
        EntityField::GlossySamples => "/phong/glossySamples",
        EntityField::ColorMap => "/phong/colorMap",
        EntityField::SpecularMap => "/phong/specularMap",
        EntityField::NormalMap => "/phong/normalMap",
        EntityField::Bump => "/phong/bump",
        EntityField::Material => "/material",
    }
}

/// A table from value paths to source spans; empty for a scene that was not read from text.
///
/// Each kind of entity has its own list. A front end visits the entities of one kind in order but
/// mixes the kinds, so the lists are mostly sorted already.
#[derive(Clone, Debug, Default)]
pub struct SourceSpans {
    lists: [List; EntityKind::ALL.len()],
    /// A scene that stands for what the source shows at all times of its animation, where it has no
    /// camera of its own: the vertices of its surfaces are on hulls of that.
    pub swept: Option<Box<Scene>>,
}

#[derive(Clone, Debug, Default)]
struct List {
    spans: Vec<(u32, EntityField, Span)>,
    unsorted: bool,
}

impl List {
    fn find(&self, index: u32, field: EntityField) -> Option<Span> {
        let found = self
            .spans
            .binary_search_by_key(&(index, field), |(index, field, _)| (*index, *field));
        found.ok().map(|at| self.spans[at].2)
    }
}

impl SourceSpans {
    /// Records the span of the value at `path`; does nothing if there is no span.
    pub fn record(&mut self, path: ValuePath, span: impl Into<Option<Span>>) {
        let ValuePath {
            entity,
            index,
            field,
        } = path;
        if let Some(span) = span.into() {
            let list = &mut self.lists[entity as usize];
            list.unsorted |= list
                .spans
                .last()
                .is_some_and(|(last, before, _)| (*last, *before) >= (index, field));
            list.spans.push((index, field, span));
        }
    }

    /// Removes the spans of all entities of a kind, because they were replaced.
    pub fn forget(&mut self, entity: EntityKind) {
        self.lists[entity as usize] = List::default();
    }

    /// Removes the last spans that were recorded, of entities of a kind from an index on.
    pub fn forget_from(&mut self, entity: EntityKind, first: usize) {
        let spans = &mut self.lists[entity as usize].spans;
        let first = u32::try_from(first).unwrap_or(u32::MAX);
        while spans.last().is_some_and(|(index, ..)| *index >= first) {
            spans.pop();
        }
    }

    /// Removes the spans of one entity, because it was replaced.
    pub fn forget_one(&mut self, entity: EntityKind, index: usize) {
        let index = to_u32(index);
        let spans = &mut self.lists[entity as usize].spans;
        spans.retain(|(recorded, ..)| *recorded != index);
    }

    /// Sorts the table; call it after the last `record`.
    pub fn finish(&mut self) {
        for list in self.lists.iter_mut().filter(|list| list.unsorted) {
            list.spans.sort_by_key(|(index, field, _)| (*index, *field));
            list.unsorted = false;
        }
    }

    /// The paths of the values that were written at this span.
    pub fn paths(&self, span: Span) -> impl Iterator<Item = ValuePath> {
        let kinds = EntityKind::ALL.into_iter().zip(&self.lists);
        kinds.flat_map(move |(entity, list)| {
            let spans = list
                .spans
                .iter()
                .filter(move |(_, _, recorded)| *recorded == span);
            spans.map(move |(index, field, _)| ValuePath {
                entity,
                index: *index,
                field: *field,
            })
        })
    }

    /// The span of a value. A value that was filled by default has the span of its entity.
    #[must_use]
    pub fn span(&self, path: ValuePath) -> Option<Span> {
        let ValuePath {
            entity,
            index,
            field,
        } = path;
        let list = &self.lists[entity as usize];
        list.find(index, field)
            .or_else(|| list.find(index, EntityField::Whole))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_default_falls_back_to_its_entity() {
        let file = rtc_source::SourceMap::default().add("x", Vec::new());
        let mut source_spans = SourceSpans::default();
        let [center, radius] =
            ["center", "radius"].map(|path| EntityField::of_shape(ShapeKind::Sphere, path));
        source_spans.record(
            ValuePath::new(EntityKind::Surface, 3, radius),
            Span::new(file, 5, 6),
        );
        source_spans.record(
            ValuePath::new(EntityKind::Surface, 3, EntityField::Whole),
            Span::new(file, 1, 9),
        );
        source_spans.finish();
        let span = |field| {
            source_spans
                .span(ValuePath::new(EntityKind::Surface, 3, field))
                .map(|span| span.start)
        };
        assert_eq!((span(radius), span(center)), (Some(5), Some(1)));
        assert_eq!(
            ValuePath::new(EntityKind::Surface, 3, radius).to_string(),
            "/surfaces/3/shape/sphere/radius"
        );
    }
}
