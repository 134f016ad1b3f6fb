//! Conservative bounds of surfaces: a bounding box or plane, and the shape class (planar, sphere,
//! convex) that rules use.

use super::margin::{BoxMargins, MARGIN, OrientedPlane, VisibleSides};
use super::shape::shape_facts;
use rtc_math::{Bounds, IdTable, Vec3, cross, unit};
use rtc_valid::{Instance, Mesh, ValidScene};
use std::sync::Arc;

/// The region that contains a surface.
#[derive(Clone, Copy, Debug)]
pub(crate) enum SurfaceExtent {
    /// An axis-aligned box.
    Within(Bounds),
    /// An unbounded plane.
    Plane(OrientedPlane),
    /// No bound is known: ray intersection may report a hit anywhere.
    Anywhere,
}

/// The extent of a surface and the shape class that rules use.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SurfaceBounds {
    pub(crate) extent: SurfaceExtent,
    pub(crate) class: ShapeClass,
}

/// The geometric properties of a shape that rules use.
#[derive(Clone, Copy, Debug)]
pub(crate) enum ShapeClass {
    /// A bounded part of a plane.
    Planar(OrientedPlane),
    /// A sphere: centre and radius.
    Sphere(Vec3, f64),
    /// A convex solid.
    Convex,
    /// Any other shape.
    Other,
}

impl SurfaceBounds {
    pub(crate) fn within(aabb: Bounds, class: ShapeClass) -> Self {
        Self {
            extent: SurfaceExtent::Within(aabb),
            class,
        }
    }

    /// Expands the bounds to all places of a surface that moves by a vector.
    fn sweep(&mut self, by: Vec3) {
        self.class = ShapeClass::Other;
        self.extent = match self.extent {
            SurfaceExtent::Within(Bounds { min, max }) => {
                let moved = Bounds {
                    min: min + by,
                    max: max + by,
                };
                SurfaceExtent::Within(moved.union(Bounds { min, max }))
            }
            SurfaceExtent::Plane(_) | SurfaceExtent::Anywhere => SurfaceExtent::Anywhere,
        };
    }

    /// Expands the bounds by the error of its points. If that error is not small against the
    /// thickness, the shape class is no longer valid.
    fn grow(&mut self, error_bound: f64, thickness: f64) {
        const MAX_RELATIVE_ERROR: f64 = 1.0 / 1024.0;
        if let SurfaceExtent::Within(aabb) = &mut self.extent {
            *aabb = aabb.widened(error_bound);
        }
        if error_bound > MAX_RELATIVE_ERROR * thickness {
            self.class = ShapeClass::Other;
        }
    }

    /// The bounding box, if the surface is bounded.
    pub(crate) fn aabb(&self) -> Option<&Bounds> {
        match &self.extent {
            SurfaceExtent::Within(aabb) => Some(aabb),
            SurfaceExtent::Plane(_) | SurfaceExtent::Anywhere => None,
        }
    }

    /// The sides that are visible from a box; from anywhere without one.
    pub(crate) fn visible_sides(&self, from: Option<&Bounds>) -> VisibleSides {
        let Some(from) = from else {
            return VisibleSides::BOTH;
        };
        match self.class {
            ShapeClass::Planar(plane) => plane.sides(from),
            ShapeClass::Sphere(..) | ShapeClass::Convex if self.is_disjoint_from(from) => {
                VisibleSides::FRONT
            }
            ShapeClass::Sphere(..) | ShapeClass::Convex | ShapeClass::Other => VisibleSides::BOTH,
        }
    }

    /// Whether a convex solid is certainly disjoint from a box.
    pub(crate) fn is_disjoint_from(&self, other: &Bounds) -> bool {
        let Some(aabb) = self.aabb() else {
            return false;
        };
        match self.class {
            ShapeClass::Sphere(center, radius) => {
                other.distance(center) > radius + 4.0 * MARGIN * (aabb.reach() + other.reach())
            }
            ShapeClass::Planar(_) | ShapeClass::Convex | ShapeClass::Other => {
                aabb.is_disjoint_from(other)
            }
        }
    }
}

/// The bounds of all surfaces while the shutter is open, expanded by the rounding error of rays: a
/// ray starts at the eye or on another surface, and its error is proportional to those coordinates.
pub(crate) fn surface_bounds(scene: &ValidScene) -> Vec<SurfaceBounds> {
    let extent = |mesh: &Arc<Mesh>| Bounds::of(mesh.positions.iter().map(Vec3::from_array));
    let meshes = scene.meshes().iter().map(extent).collect::<IdTable<_, _>>();
    let surfaces = || scene.surfaces().iter().map(|surface| &surface.shape);
    let mut surface_bounds = surfaces()
        .map(|shape| shape_facts(shape).bounds(&meshes))
        .collect::<Vec<_>>();
    let sweeps = scene.surfaces().iter().map(|surface| surface.sweep);
    for (bounds, sweep) in surface_bounds.iter_mut().zip(sweeps) {
        if sweep != Vec3::ZERO {
            bounds.sweep(sweep);
        }
    }
    let eye = scene.camera().eye.abs().max_element();
    let farthest = surface_bounds
        .iter()
        .filter_map(SurfaceBounds::aabb)
        .map(Bounds::reach)
        .fold(eye, f64::max);
    for (bounds, shape) in surface_bounds.iter_mut().zip(surfaces()) {
        bounds.grow(MARGIN * farthest, shape_facts(shape).thickness());
    }
    surface_bounds
}

/// The plane of a triangle, unless the triangle is too thin for a reliable normal.
pub(crate) fn triangle_plane([a, b, c]: [Vec3; 3]) -> ShapeClass {
    /// The minimum sine between two edges: the error of the normal is then below 2⁻³⁶.
    const MIN_SINE: f64 = 1.0 / 65536.0;
    let normal = || {
        let (first, second) = (unit(b - a)?, unit(c - a)?);
        let normal = cross(first, second);
        (normal.length() > MIN_SINE).then(|| normal.normalize())
    };
    normal().map_or(ShapeClass::Other, |normal| {
        ShapeClass::Planar(OrientedPlane { point: a, normal })
    })
}

/// The bounding box of a circle about an axis, or of the torus with this tube radius.
pub(crate) fn circle_bounds(center: Vec3, axis: Vec3, radius: f64, minor_radius: f64) -> Bounds {
    let axis = unit(axis).unwrap_or(Vec3::ZERO);
    let reach = |n: f64| {
        radius * (1.0 - n * n).max(0.0).sqrt() + minor_radius + MARGIN * (radius + minor_radius)
    };
    Bounds::about(
        center,
        Vec3::new(reach(axis.x), reach(axis.y), reach(axis.z)),
    )
}

/// The world-space bounding box of a mesh instance. Rays are transformed to object space and back;
/// the rounding error grows as the transform becomes singular.
pub(crate) fn instance_bounds(instance: &Instance, mesh: &Bounds) -> Bounds {
    let [x, y, z, origin] = instance.world_from_object;
    let to_world = |p: Vec3| x * p.x + y * p.y + z * p.z + origin;
    let axes = [x, y, z].map(|axis| unit(axis).unwrap_or(Vec3::ZERO));
    let volume = axes[0].dot(axes[1].cross(axes[2])).abs();
    let aabb = Bounds::of(mesh.corners().map(to_world));
    let terms = x.abs() + y.abs() + z.abs();
    let size = terms.max_element() * mesh.reach() + origin.abs().max_element();
    aabb.widened(MARGIN * size / volume)
}

#[cfg(test)]
mod tests {
    use super::super::margin::tests::{has_margin, span};
    use super::*;

    /// Asserts that a box is another one expanded by a margin, up to the rounding of its corners.
    fn is_grown(aabb: Bounds, from: Bounds, margin: f64) {
        let (low, high) = (from.min - aabb.min, aabb.max - from.max);
        let margins = [low.x, low.y, low.z, high.x, high.y, high.z];
        assert!(
            margins
                .iter()
                .all(|found| (found - margin).abs() < 1e-3 * margin),
            "{margins:?}, not {margin:e}"
        );
    }

    #[test]
    fn a_circle_extends_across_its_axis_with_a_margin() {
        let found = circle_bounds(
            Vec3::new(1.0, 2.0, -1.0),
            Vec3::new(0.0, 3.0, 4.0),
            2.0,
            0.5,
        );
        is_grown(
            found,
            span([-1.5, -0.1, -2.7], [3.5, 4.1, 0.7]),
            2.5 * MARGIN,
        );
    }

    #[test]
    fn the_margin_of_an_instance_grows_as_its_transform_becomes_singular() {
        let [x, y, z] = [[2.0, 0.0, 0.0], [0.0, 3.0, 4.0], [0.0, 0.0, 5.0]].map(Vec3::from_array);
        let world_from_object = [x, y, z, Vec3::new(7.0, -20.0, 1.0)];
        let mesh = span([-1.0, -2.0, -3.0], [4.0, 5.0, 6.0]);
        let found = instance_bounds(
            &Instance {
                mesh: rtc_math::Id::new(0),
                world_from_object,
            },
            &mesh,
        );
        // At most (2, 3 and 4 + 5) times 6, and 20; the determinant of the unit axes is 0.6.
        is_grown(
            found,
            span([5.0, -26.0, -22.0], [15.0, -5.0, 51.0]),
            (9.0 * 6.0 + 20.0) / 0.6 * MARGIN,
        );
    }

    #[test]
    fn a_sphere_is_disjoint_from_a_box_by_a_margin_and_other_solids_by_their_boxes() {
        let center = Vec3::X * 3.0;
        let ball = SurfaceBounds::within(
            Bounds::about(center, Vec3::ONE),
            ShapeClass::Sphere(center, 1.0),
        );
        let before = |gap: f64| span([4.0 + gap, -1.0, -1.0], [9.0, 1.0, 1.0]);
        has_margin(4.0 * 13.0 * MARGIN, |gap| {
            ball.is_disjoint_from(&before(gap))
        });
        assert!(
            !ball.is_disjoint_from(&before(4.0 * 13.0 * MARGIN)),
            "in doubt it is not"
        );
        let solid = SurfaceBounds {
            class: ShapeClass::Convex,
            ..ball
        };
        has_margin(13.0 * MARGIN, |gap| solid.is_disjoint_from(&before(gap)));
        let corner = span([3.8, 0.8, 0.8], [9.0, 1.0, 1.0]);
        assert!(
            ball.is_disjoint_from(&corner) && !solid.is_disjoint_from(&corner),
            "a sphere has no corners"
        );
    }

    #[test]
    fn a_triangle_has_a_plane_unless_it_is_a_sliver() {
        let corners = |sine: f64| [Vec3::ZERO, Vec3::X * 3.0, Vec3::new(2.0, 2.0 * sine, 0.0)];
        has_margin(1.0 / 65536.0, |sine| {
            matches!(triangle_plane(corners(sine)), ShapeClass::Planar(_))
        });
        // The sine is 2⁻¹⁶.
        let sliver = [
            Vec3::ZERO,
            Vec3::X * 3.0,
            Vec3::new((1.0 - MARGIN).sqrt(), 1.0 / 65536.0, 0.0),
        ];
        assert!(
            matches!(triangle_plane(sliver), ShapeClass::Other),
            "in doubt it is"
        );
        let ShapeClass::Planar(plane) = triangle_plane(corners(1.0)) else {
            panic!("no sliver")
        };
        assert_eq!(
            plane,
            OrientedPlane {
                point: Vec3::ZERO,
                normal: Vec3::Z
            }
        );
    }
}
