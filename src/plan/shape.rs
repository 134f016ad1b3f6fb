//! Facts about each shape: its bounds, its shape class, and its intersection equation.

use super::margin::OrientedPlane;
use super::precision::EquationKind;
use super::surface_bounds::{
    ShapeClass, SurfaceBounds, SurfaceExtent, circle_bounds, instance_bounds, triangle_plane,
};
use rtc_math::{Bounds, IdTable, OrthonormalBasis, Vec3, cos_sin_revolutions, unit};
use rtc_valid::{
    Cone, Csg, Cylinder, Disc, Ellipsoid, InfiniteCylinder, Instance, Mesh, Paraboloid, Plane,
    Quad, Shape, Sphere, Torus, Triangle, ValidScene,
};

/// The facts that rules need about a shape.
pub(super) trait ShapeFacts {
    /// The bounds; `meshes` has the bounding boxes of the meshes.
    fn bounds(&self, meshes: &IdTable<Mesh, Bounds>) -> SurfaceBounds;

    /// The thickness of a solid, or the length of the shortest side of a polygon; infinite where no
    /// rule depends on it.
    fn thickness(&self) -> f64;

    /// The intersection equation, and a point in the middle or nearest to the eye.
    fn formula(&self, scene: &ValidScene) -> (Vec3, EquationKind);

    /// The vertices of a convex polygon within a flat shape, in order.
    fn polygon(&self, _normal: Vec3) -> Option<Vec<Vec3>> {
        None
    }
}

/// A shape of any kind as something with facts.
pub(super) fn shape_facts(shape: &Shape) -> &dyn ShapeFacts {
    match shape {
        Shape::Sphere(shape) => shape,
        Shape::Plane(shape) => shape,
        Shape::Triangle(shape) => shape,
        Shape::Quad(shape) => &**shape,
        Shape::Disc(shape) => shape,
        Shape::Cylinder(shape) => shape,
        Shape::Cone(shape) => shape,
        Shape::Paraboloid(shape) => shape,
        Shape::Torus(shape) => shape,
        Shape::Instance(shape) => &**shape,
        Shape::Ellipsoid(shape) => &**shape,
        Shape::InfiniteCylinder(shape) => shape,
        Shape::Csg(shape) => &**shape,
    }
}

impl ShapeFacts for Sphere {
    fn bounds(&self, _: &IdTable<Mesh, Bounds>) -> SurfaceBounds {
        let radius = self.radius.get();
        let aabb = Bounds::about(self.center, Vec3::splat(radius));
        SurfaceBounds::within(aabb, ShapeClass::Sphere(self.center, radius))
    }

    fn thickness(&self) -> f64 {
        self.radius.get()
    }

    fn formula(&self, _: &ValidScene) -> (Vec3, EquationKind) {
        (self.center, EquationKind::Quadratic(self.radius.get()))
    }
}

impl ShapeFacts for Plane {
    fn bounds(&self, _: &IdTable<Mesh, Bounds>) -> SurfaceBounds {
        let plane = unit(self.normal).map(|normal| OrientedPlane {
            point: self.center,
            normal,
        });
        SurfaceBounds {
            extent: plane.map_or(SurfaceExtent::Anywhere, SurfaceExtent::Plane),
            class: ShapeClass::Other,
        }
    }

    fn thickness(&self) -> f64 {
        f64::INFINITY
    }

    fn formula(&self, scene: &ValidScene) -> (Vec3, EquationKind) {
        let (normal, eye) = (unit(self.normal).unwrap_or(Vec3::ZERO), scene.camera().eye);
        let nearest = eye + normal * normal.dot(self.center - eye);
        (nearest, EquationKind::Linear(f64::INFINITY))
    }
}

impl ShapeFacts for Triangle {
    fn bounds(&self, _: &IdTable<Mesh, Bounds>) -> SurfaceBounds {
        SurfaceBounds::within(Bounds::of(self.vertices), triangle_plane(self.vertices))
    }

    fn thickness(&self) -> f64 {
        shortest_side(&self.vertices)
    }

    fn formula(&self, _: &ValidScene) -> (Vec3, EquationKind) {
        linear_equation(&self.vertices)
    }

    fn polygon(&self, _: Vec3) -> Option<Vec<Vec3>> {
        Some(self.vertices.to_vec())
    }
}

impl ShapeFacts for Quad {
    /// The intersection of a bilinear patch has no known error bound, so its extent is unbounded.
    fn bounds(&self, _: &IdTable<Mesh, Bounds>) -> SurfaceBounds {
        let [a, b, c, d] = self.vertices;
        if !self.is_flat() {
            return SurfaceBounds {
                extent: SurfaceExtent::Anywhere,
                class: ShapeClass::Other,
            };
        }
        let class = match triangle_plane([a, b, c]) {
            ShapeClass::Planar(plane) => ShapeClass::Planar(plane),
            ShapeClass::Sphere(..) | ShapeClass::Convex | ShapeClass::Other => {
                triangle_plane([a, c, d])
            }
        };
        SurfaceBounds::within(Bounds::of(self.vertices), class)
    }

    fn thickness(&self) -> f64 {
        shortest_side(&self.vertices)
    }

    fn formula(&self, _: &ValidScene) -> (Vec3, EquationKind) {
        linear_equation(&self.vertices)
    }

    fn polygon(&self, _: Vec3) -> Option<Vec<Vec3>> {
        Some(self.vertices.to_vec())
    }
}

impl ShapeFacts for Disc {
    fn bounds(&self, _: &IdTable<Mesh, Bounds>) -> SurfaceBounds {
        let point = self.center;
        let plane =
            unit(self.normal).map(|normal| ShapeClass::Planar(OrientedPlane { point, normal }));
        let aabb = circle_bounds(self.center, self.normal, self.radius.get(), 0.0);
        SurfaceBounds::within(aabb, plane.unwrap_or(ShapeClass::Other))
    }

    fn thickness(&self) -> f64 {
        self.radius.get()
    }

    fn formula(&self, _: &ValidScene) -> (Vec3, EquationKind) {
        (self.center, EquationKind::Linear(self.radius.get()))
    }

    fn polygon(&self, normal: Vec3) -> Option<Vec<Vec3>> {
        /// The vertices of the inscribed polygon: it covers 97 % of the disc.
        const COUNT: u64 = 16;
        let basis = OrthonormalBasis::around(normal);
        let corner = |k: u64| {
            let (x, y) = cos_sin_revolutions(k << 60);
            self.center + basis.to_world(Vec3::new(x, y, 0.0)) * self.radius.get()
        };
        Some((0..COUNT).map(corner).collect())
    }
}

impl ShapeFacts for Cylinder {
    fn bounds(&self, _: &IdTable<Mesh, Bounds>) -> SurfaceBounds {
        let top = self.base + unit(self.axis).unwrap_or(Vec3::ZERO) * self.height.get();
        let rim = |center| circle_bounds(center, self.axis, self.radius.get(), 0.0);
        SurfaceBounds::within(rim(self.base).union(rim(top)), ShapeClass::Convex)
    }

    fn thickness(&self) -> f64 {
        self.height.get().min(self.radius.get())
    }

    fn formula(&self, _: &ValidScene) -> (Vec3, EquationKind) {
        (self.base, EquationKind::Quadratic(self.radius.get()))
    }
}

impl ShapeFacts for Cone {
    fn bounds(&self, _: &IdTable<Mesh, Bounds>) -> SurfaceBounds {
        let rim = circle_bounds(self.base, self.up, self.radius.get(), 0.0);
        let apex = Bounds::of([self.base + self.up]);
        SurfaceBounds::within(rim.union(apex), ShapeClass::Convex)
    }

    fn thickness(&self) -> f64 {
        self.up.abs().max_element().min(self.radius.get())
    }

    fn formula(&self, _: &ValidScene) -> (Vec3, EquationKind) {
        (self.base, EquationKind::Quadratic(self.radius.get()))
    }
}

impl ShapeFacts for Paraboloid {
    fn bounds(&self, _: &IdTable<Mesh, Bounds>) -> SurfaceBounds {
        let radius = self.radius.get();
        let rim = circle_bounds(self.base, self.up, radius, 0.0);
        // The profile is within the hull of the rim and a circle of half the radius at the apex.
        let top = circle_bounds(self.base + self.up, self.up, 0.5 * radius, 0.0);
        SurfaceBounds::within(rim.union(top), ShapeClass::Convex)
    }

    fn thickness(&self) -> f64 {
        self.up.abs().max_element().min(self.radius.get())
    }

    fn formula(&self, _: &ValidScene) -> (Vec3, EquationKind) {
        (self.base, EquationKind::Quadratic(self.radius.get()))
    }
}

impl ShapeFacts for Torus {
    fn bounds(&self, _: &IdTable<Mesh, Bounds>) -> SurfaceBounds {
        let aabb = circle_bounds(self.center, self.axis, self.major.get(), self.minor.get());
        SurfaceBounds::within(aabb, ShapeClass::Other)
    }

    fn thickness(&self) -> f64 {
        f64::INFINITY
    }

    fn formula(&self, _: &ValidScene) -> (Vec3, EquationKind) {
        let (major, minor) = (self.major.get(), self.minor.get());
        (self.center, EquationKind::Quartic { major, minor })
    }
}

impl ShapeFacts for Ellipsoid {
    fn bounds(&self, _: &IdTable<Mesh, Bounds>) -> SurfaceBounds {
        let bounds = Bounds::around_ellipsoid(self.center, self.axes);
        SurfaceBounds::within(bounds, ShapeClass::Convex)
    }

    /// A bound of the least singular value of the map of the unit sphere, from its determinant and
    /// the sum of the squares of all three.
    fn thickness(&self) -> f64 {
        let [x, y, z] = self.axes;
        x.dot(y.cross(z)).abs() / (x.dot(x) + y.dot(y) + z.dot(z))
    }

    fn formula(&self, _: &ValidScene) -> (Vec3, EquationKind) {
        (self.center, EquationKind::Quadratic(self.thickness()))
    }
}

impl ShapeFacts for InfiniteCylinder {
    fn bounds(&self, _: &IdTable<Mesh, Bounds>) -> SurfaceBounds {
        SurfaceBounds {
            extent: SurfaceExtent::Anywhere,
            class: ShapeClass::Other,
        }
    }

    fn thickness(&self) -> f64 {
        self.radius.get()
    }

    fn formula(&self, scene: &ValidScene) -> (Vec3, EquationKind) {
        let (axis, eye) = (unit(self.axis).unwrap_or(Vec3::Z), scene.camera().eye);
        let nearest = self.center + axis * axis.dot(eye - self.center);
        (nearest, EquationKind::Quadratic(self.radius.get()))
    }
}

impl ShapeFacts for Csg {
    /// The boxes of the operands, through the operations.
    fn bounds(&self, meshes: &IdTable<Mesh, Bounds>) -> SurfaceBounds {
        let operands = self.operands.iter().map(|operand| {
            if let Shape::Plane(plane) = operand {
                return Bounds::of_half_space(plane.center, plane.normal);
            }
            let bounds = shape_facts(operand).bounds(meshes);
            bounds.aabb().copied().unwrap_or(Bounds::EVERYTHING)
        });
        let whole = Bounds::of_set(&self.steps, operands);
        SurfaceBounds {
            extent: whole.map_or(SurfaceExtent::Anywhere, SurfaceExtent::Within),
            class: ShapeClass::Other,
        }
    }

    fn thickness(&self) -> f64 {
        f64::INFINITY
    }

    fn formula(&self, scene: &ValidScene) -> (Vec3, EquationKind) {
        shape_facts(&self.operands[0]).formula(scene)
    }
}

impl ShapeFacts for Instance {
    fn bounds(&self, meshes: &IdTable<Mesh, Bounds>) -> SurfaceBounds {
        SurfaceBounds::within(instance_bounds(self, &meshes[self.mesh]), ShapeClass::Other)
    }

    fn thickness(&self) -> f64 {
        f64::INFINITY
    }

    /// The first vertex of the mesh, and the largest distance of another vertex from it.
    fn formula(&self, scene: &ValidScene) -> (Vec3, EquationKind) {
        let [x, y, z, origin] = self.world_from_object;
        let to_world = |p: Vec3| x * p.x + y * p.y + z * p.z + origin;
        let mut corners = scene.meshes()[self.mesh]
            .positions
            .iter()
            .map(Vec3::from_array)
            .map(to_world);
        let first = corners.next().unwrap_or(origin);
        let distances = corners.map(|corner| corner.distance(first));
        (first, EquationKind::Linear(distances.fold(0.0, f64::max)))
    }
}

/// The length of the shortest side of a polygon, in the maximum norm.
fn shortest_side(corners: &[Vec3]) -> f64 {
    let sides = corners
        .iter()
        .zip(corners.iter().cycle().skip(1))
        .map(|(a, b)| (*a - *b).abs().max_element());
    sides.fold(f64::INFINITY, f64::min)
}

/// The first vertex of a polygon, and the largest distance of another vertex from it.
fn linear_equation(corners: &[Vec3]) -> (Vec3, EquationKind) {
    let distances = corners[1..].iter().map(|c| c.distance(corners[0]));
    (
        corners[0],
        EquationKind::Linear(distances.fold(0.0, f64::max)),
    )
}
