//! What the rules know of each shape: where it is, whether it is flat or convex, its texture
//! coordinates, and the formula that rays meet it by.

use super::body::{Body, Extent, Hull, face, placed, ring};
use super::path::Area;
use super::precision::Formula;
use super::space::Flat;
use rtc_math::{Basis, Bounds, Vec3, cos_sin_turns, unit};
use rtc_valid::{
    Cone, Cylinder, Disc, Instance, Paraboloid, Plane, Quad, Shape, Sphere, Torus, Triangle,
    ValidScene,
};

/// What the rules ask of a shape.
pub(super) trait ShapeFacts {
    /// Its form and place; `meshes` are the boxes of the meshes.
    fn body(&self, meshes: &[Bounds]) -> Body;

    /// How thick a solid is, or how long the shortest side of a face; infinite where nothing rests
    /// on it.
    fn thickness(&self) -> f64;

    /// The formula that meets it, and a point in its middle or nearest to the eye.
    fn formula(&self, scene: &ValidScene) -> (Vec3, Formula);

    /// Corners of a convex polygon within a flat shape, in order around it.
    fn polygon(&self, _normal: Vec3) -> Option<Vec<Vec3>> {
        None
    }

    /// Whether its points have texture coordinates.
    fn has_uv(&self, _scene: &ValidScene) -> bool {
        false
    }

    /// The bounds of its texture coordinates, for both sets; the unit square for a shape that has
    /// them by its form.
    fn uv_areas(&self, scene: &ValidScene) -> [Option<Area>; 2] {
        [self.has_uv(scene).then_some(Area::UNIT), None]
    }
}

/// Finds the facts of a shape of any kind.
macro_rules! facts {
    ($($(#[$doc:meta])* $Name:ident $word:ident $Store:ident $how:ident $values:tt)*) => {
        pub(super) fn shape_facts(shape: &Shape) -> &dyn ShapeFacts {
            match shape {
                $(Shape::$Name(shape) => {
                    let shape: &$Name = shape;
                    shape
                })*
            }
        }
    };
}

rtc_tables::shapes!(facts);

impl ShapeFacts for Sphere {
    fn body(&self, _: &[Bounds]) -> Body {
        let radius = self.radius.get();
        let space = Bounds::about(self.center, Vec3::splat(radius));
        Body::within(space, Hull::Ball(self.center, radius))
    }

    fn thickness(&self) -> f64 {
        self.radius.get()
    }

    fn formula(&self, _: &ValidScene) -> (Vec3, Formula) {
        (self.center, Formula::Round(self.radius.get()))
    }

    fn has_uv(&self, _: &ValidScene) -> bool {
        true
    }
}

impl ShapeFacts for Plane {
    fn body(&self, _: &[Bounds]) -> Body {
        let flat = unit(self.normal).map(|normal| Flat {
            point: self.center,
            normal,
        });
        Body {
            extent: flat.map_or(Extent::Anywhere, Extent::Plane),
            form: Hull::Other,
        }
    }

    fn thickness(&self) -> f64 {
        f64::INFINITY
    }

    fn formula(&self, scene: &ValidScene) -> (Vec3, Formula) {
        let (normal, eye) = (unit(self.normal).unwrap_or(Vec3::ZERO), scene.camera().eye);
        let nearest = eye + normal * normal.dot(self.center - eye);
        (nearest, Formula::Flat(f64::INFINITY))
    }
}

impl ShapeFacts for Triangle {
    fn body(&self, _: &[Bounds]) -> Body {
        Body::within(Bounds::of(self.vertices), face(self.vertices))
    }

    fn thickness(&self) -> f64 {
        shortest_side(&self.vertices)
    }

    fn formula(&self, _: &ValidScene) -> (Vec3, Formula) {
        flat(&self.vertices)
    }

    fn polygon(&self, _: Vec3) -> Option<Vec<Vec3>> {
        Some(self.vertices.to_vec())
    }

    fn has_uv(&self, _: &ValidScene) -> bool {
        self.uvs.is_some()
    }

    fn uv_areas(&self, _: &ValidScene) -> [Option<Area>; 2] {
        let corners = self.uvs.as_deref();
        [corners.map(|uvs| Area::of(uvs.iter().copied())), None]
    }
}

impl ShapeFacts for Quad {
    /// The formulas of a patch have no known error bound, so it may be anywhere.
    fn body(&self, _: &[Bounds]) -> Body {
        let [a, b, c, d] = self.vertices;
        if !self.is_flat() {
            return Body {
                extent: Extent::Anywhere,
                form: Hull::Other,
            };
        }
        let form = match face([a, b, c]) {
            Hull::Flat(flat) => Hull::Flat(flat),
            Hull::Ball(..) | Hull::Convex | Hull::Other => face([a, c, d]),
        };
        Body::within(Bounds::of(self.vertices), form)
    }

    fn thickness(&self) -> f64 {
        shortest_side(&self.vertices)
    }

    fn formula(&self, _: &ValidScene) -> (Vec3, Formula) {
        flat(&self.vertices)
    }

    fn polygon(&self, _: Vec3) -> Option<Vec<Vec3>> {
        Some(self.vertices.to_vec())
    }

    fn has_uv(&self, _: &ValidScene) -> bool {
        true
    }
}

impl ShapeFacts for Disc {
    fn body(&self, _: &[Bounds]) -> Body {
        let point = self.center;
        let flat = unit(self.normal).map(|normal| Hull::Flat(Flat { point, normal }));
        let space = ring(self.center, self.normal, self.radius.get(), 0.0);
        Body::within(space, flat.unwrap_or(Hull::Other))
    }

    fn thickness(&self) -> f64 {
        self.radius.get()
    }

    fn formula(&self, _: &ValidScene) -> (Vec3, Formula) {
        (self.center, Formula::Flat(self.radius.get()))
    }

    fn polygon(&self, normal: Vec3) -> Option<Vec<Vec3>> {
        /// Corners of the polygon within a disc: it covers 97 % of it.
        const COUNT: u64 = 16;
        let basis = Basis::around(normal);
        let corner = |k: u64| {
            let (x, y) = cos_sin_turns(k << 60);
            self.center + basis.to_world(Vec3::new(x, y, 0.0)) * self.radius.get()
        };
        Some((0..COUNT).map(corner).collect())
    }
}

impl ShapeFacts for Cylinder {
    fn body(&self, _: &[Bounds]) -> Body {
        let top = self.base + unit(self.axis).unwrap_or(Vec3::ZERO) * self.height.get();
        let rim = |center| ring(center, self.axis, self.radius.get(), 0.0);
        Body::within(rim(self.base).union(rim(top)), Hull::Convex)
    }

    fn thickness(&self) -> f64 {
        self.height.get().min(self.radius.get())
    }

    fn formula(&self, _: &ValidScene) -> (Vec3, Formula) {
        (self.base, Formula::Round(self.radius.get()))
    }
}

impl ShapeFacts for Cone {
    fn body(&self, _: &[Bounds]) -> Body {
        let rim = ring(self.base, self.up, self.radius.get(), 0.0);
        let apex = Bounds::of([self.base + self.up]);
        Body::within(rim.union(apex), Hull::Convex)
    }

    fn thickness(&self) -> f64 {
        self.up.abs().max_element().min(self.radius.get())
    }

    fn formula(&self, _: &ValidScene) -> (Vec3, Formula) {
        (self.base, Formula::Round(self.radius.get()))
    }
}

impl ShapeFacts for Paraboloid {
    fn body(&self, _: &[Bounds]) -> Body {
        let radius = self.radius.get();
        let rim = ring(self.base, self.up, radius, 0.0);
        // The profile lies between the rim, and the vertex and half the radius beside it.
        let top = ring(self.base + self.up, self.up, 0.5 * radius, 0.0);
        Body::within(rim.union(top), Hull::Convex)
    }

    fn thickness(&self) -> f64 {
        self.up.abs().max_element().min(self.radius.get())
    }

    fn formula(&self, _: &ValidScene) -> (Vec3, Formula) {
        (self.base, Formula::Round(self.radius.get()))
    }

    fn has_uv(&self, _: &ValidScene) -> bool {
        true
    }
}

impl ShapeFacts for Torus {
    fn body(&self, _: &[Bounds]) -> Body {
        let space = ring(self.center, self.axis, self.major.get(), self.minor.get());
        Body::within(space, Hull::Other)
    }

    fn thickness(&self) -> f64 {
        f64::INFINITY
    }

    fn formula(&self, _: &ValidScene) -> (Vec3, Formula) {
        let (major, minor) = (self.major.get(), self.minor.get());
        (self.center, Formula::Torus { major, minor })
    }
}

impl ShapeFacts for Instance {
    fn body(&self, meshes: &[Bounds]) -> Body {
        Body::within(placed(self, &meshes[self.mesh]), Hull::Other)
    }

    fn thickness(&self) -> f64 {
        f64::INFINITY
    }

    /// The first corner of the mesh, and how far that extends.
    fn formula(&self, scene: &ValidScene) -> (Vec3, Formula) {
        let [x, y, z, origin] = self.world_from_object;
        let to_world = |p: Vec3| x * p.x + y * p.y + z * p.z + origin;
        let mut corners = scene.meshes()[self.mesh]
            .positions
            .iter()
            .map(Vec3::from_array)
            .map(to_world);
        let first = corners.next().unwrap_or(origin);
        let distances = corners.map(|corner| corner.distance(first));
        (first, Formula::Flat(distances.fold(0.0, f64::max)))
    }

    fn has_uv(&self, scene: &ValidScene) -> bool {
        !scene.meshes()[self.mesh].uvs.is_empty()
    }

    fn uv_areas(&self, scene: &ValidScene) -> [Option<Area>; 2] {
        let mesh = &scene.meshes()[self.mesh];
        [&mesh.uvs, &mesh.second_uvs].map(|uvs| (!uvs.is_empty()).then(|| Area::of(uvs.iter())))
    }
}

/// The length of the shortest side of a face, by the largest component.
fn shortest_side(corners: &[Vec3]) -> f64 {
    let sides = corners
        .iter()
        .zip(corners.iter().cycle().skip(1))
        .map(|(a, b)| (*a - *b).abs().max_element());
    sides.fold(f64::INFINITY, f64::min)
}

/// The first corner of a face, and how far the others are from there.
fn flat(corners: &[Vec3]) -> (Vec3, Formula) {
    let distances = corners[1..].iter().map(|c| c.distance(corners[0]));
    (corners[0], Formula::Flat(distances.fold(0.0, f64::max)))
}
