//! Which parts of surfaces have texture coordinates: what a rule asks before it takes a constant
//! map for one value.
//!
//! A shape is asked part by part, so that a solid of several shapes can't answer for all of them by
//! one. Only [`UvCoverage::presence`] makes a [`ShownMap`], the proof without which no map is
//! folded.

use super::path::UvRect;
use rtc_math::VertexColumn;
use rtc_valid::{Shape, TextureId, UvSet, ValidScene};

/// The texture coordinates of a part of a shape, in one set.
#[derive(Clone, Copy)]
enum Coordinates<'scene> {
    Nowhere,
    UnitSquare,
    Corners(&'scene [[f64; 2]]),
    Column(&'scene VertexColumn<2>),
}

impl Coordinates<'_> {
    fn area(self) -> UvRect {
        match self {
            Self::Nowhere => UvRect::NONE,
            Self::UnitSquare => UvRect::UNIT,
            Self::Corners(uvs) => UvRect::of(uvs.iter().copied()),
            Self::Column(uvs) => UvRect::of(uvs.iter()),
        }
    }
}

/// The texture coordinates of each part of a shape, in both sets.
fn parts<'scene>(shape: &'scene Shape, scene: &'scene ValidScene) -> Vec<[Coordinates<'scene>; 2]> {
    let one = |first| vec![[first, Coordinates::Nowhere]];
    match shape {
        Shape::Sphere(_) | Shape::Ellipsoid(_) | Shape::Quad(_) | Shape::Paraboloid(_) => {
            one(Coordinates::UnitSquare)
        }
        Shape::Plane(_)
        | Shape::Disc(_)
        | Shape::Cylinder(_)
        | Shape::InfiniteCylinder(_)
        | Shape::Cone(_)
        | Shape::Torus(_) => one(Coordinates::Nowhere),
        Shape::Triangle(triangle) => one(match &triangle.uvs {
            Some(uvs) => Coordinates::Corners(&uvs[..]),
            None => Coordinates::Nowhere,
        }),
        Shape::Instance(instance) => {
            let mesh = &scene.meshes()[instance.mesh];
            vec![
                [&mesh.uvs, &mesh.second_uvs].map(|uvs| match uvs.is_empty() {
                    true => Coordinates::Nowhere,
                    false => Coordinates::Column(uvs),
                }),
            ]
        }
        Shape::Csg(csg) => {
            let operands = csg.operands.iter().enumerate();
            let shown = operands.filter(|(operand, _)| csg.faces >> operand & 1 == 1);
            shown
                .flat_map(|(_, operand)| parts(operand, scene))
                .collect()
        }
    }
}

/// The bounding rectangles of all texture coordinates of a shape, in both sets.
pub(super) fn areas(shape: &Shape, scene: &ValidScene) -> [UvRect; 2] {
    let parts = parts(shape, scene);
    [0, 1].map(|set| {
        let areas = parts.iter().map(|part| part[set].area());
        areas.fold(UvRect::NONE, UvRect::around)
    })
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Coverage {
    Never,
    Somewhere,
    Everywhere,
}

/// For each set of texture coordinates, whether all, some or none of the parts of some surfaces
/// have it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct UvCoverage([Coverage; 2]);

impl UvCoverage {
    /// The coverage of a shape.
    #[must_use]
    pub fn of(shape: &Shape, scene: &ValidScene) -> Self {
        let covered = |part: [Coordinates<'_>; 2]| {
            Self(part.map(|coordinates| match coordinates {
                Coordinates::Nowhere => Coverage::Never,
                Coordinates::UnitSquare | Coordinates::Corners(_) | Coordinates::Column(_) => {
                    Coverage::Everywhere
                }
            }))
        };
        let parts = parts(shape, scene).into_iter().map(covered);
        parts.reduce(Self::and).unwrap_or(Self::NEVER)
    }

    /// The coverage without any texture coordinates.
    pub(super) const NEVER: Self = Self([Coverage::Never; 2]);

    /// The coverage of these and other surfaces.
    pub(super) fn and(self, Self(other): Self) -> Self {
        let Self(own) = self;
        Self([0, 1].map(|set| {
            if own[set] == other[set] {
                own[set]
            } else {
                Coverage::Somewhere
            }
        }))
    }

    /// On which parts a texture is shown, with a set of texture coordinates if it needs any.
    #[must_use]
    pub fn presence(self, scene: &ValidScene, texture: TextureId, set: UvSet) -> MapPresence {
        let Self(sets) = self;
        match sets[set.index()] {
            _ if !scene.textures()[texture].needs_uv() => {
                MapPresence::Everywhere(ShownMap { texture, set })
            }
            Coverage::Everywhere => MapPresence::Everywhere(ShownMap { texture, set }),
            Coverage::Somewhere => MapPresence::Somewhere,
            Coverage::Never => MapPresence::Never,
        }
    }
}

/// The parts of some surfaces that show a map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MapPresence {
    /// None.
    Never,
    /// Some, but not all.
    Somewhere,
    /// All.
    Everywhere(ShownMap),
}

/// A map that all parts of some surfaces show: the proof that its texture, if it is constant, has
/// one value there. It is made by [`UvCoverage::presence`] alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShownMap {
    texture: TextureId,
    set: UvSet,
}

impl ShownMap {
    /// Its texture.
    #[must_use]
    pub fn texture(self) -> TextureId {
        self.texture
    }

    /// Its set of texture coordinates.
    #[must_use]
    pub fn set(self) -> UvSet {
        self.set
    }
}
