//! Conservative projection of bounding boxes through the lens to pixel rectangles.
//!
//! A box is projected corner by corner, through every corner of the lens; the rectangle of these
//! points, expanded by a pixel and by the error bound, contains every pixel whose camera rays may
//! hit the box. All error bounds are first-order bounds of the rounding of each operation, as
//! multiples of the unit roundoff [`U`]. Where the error may exceed [`MAX_ERROR`] of a pixel, or a
//! box reaches the plane of the lens, the result is [`ScreenRect::Unknown`].

use crate::margin::{MARGIN, OrientedPlane};
use crate::surface_bounds::{SurfaceBounds, SurfaceExtent};
use rtc_math::{Bounds, U, Vec3, cross, dot};
use rtc_valid::Camera;

/// The largest accepted rounding error of a projected point, in pixels.
const MAX_ERROR: f64 = 0.25;

/// A rectangle of pixels: half-open ranges of columns and rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct PixelRect {
    pub(crate) x: [u32; 2],
    pub(crate) y: [u32; 2],
}

/// The screen-space bounds of a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ScreenRect {
    /// Outside the picture: no camera ray hits the surface.
    Outside,
    /// Within these pixels.
    Within(PixelRect),
    /// Unknown.
    Unknown,
}

/// The camera as a projection from the world to the picture.
pub(crate) struct ScreenProjection {
    camera: Camera,
    /// The normal of the image plane, scaled so that the plane has depth 1 from the eye.
    depth: Vec3,
    /// The length of that vector.
    depth_scale: f64,
    /// Points whose convex hull contains the lens.
    lens: Vec<Vec3>,
    /// The bounding box of the lens.
    lens_box: Bounds,
    /// The maximum distance from the origin to the lens, plus that to the centre of the picture.
    reach: f64,
    /// The distances between pixels, across and upward.
    steps: [f64; 2],
    /// The size of the picture in pixels.
    size: [f64; 2],
    /// How far the rays of a pixel reach beyond it, in pixels.
    beyond: f64,
    /// Whether rounding makes the projection useless everywhere.
    is_ill_conditioned: bool,
}

impl ScreenProjection {
    pub(crate) fn new(camera: &Camera, pinhole: bool, beyond: f64) -> Self {
        // Compute the image plane from the camera axes.
        let (right, up) = (camera.right.length(), camera.up.length());
        let normal = cross(camera.right / right, camera.up / up);
        let forward = camera.center - camera.eye;
        let distance = dot(normal, forward);
        // Bound the lens by the corners of its square.
        let radius = if pinhole {
            0.0
        } else {
            camera.lens.radius.get() / up
        };
        let corner = |[x, y]: [f64; 2]| camera.eye + (camera.right * x + camera.up * y) * radius;
        let corners = [[-1.0, -1.0], [1.0, -1.0], [-1.0, 1.0], [1.0, 1.0]].map(corner);
        let lens = if radius > 0.0 {
            corners.to_vec()
        } else {
            vec![camera.eye]
        };
        // Give up if rounding is large against a pixel or against the distance of the plane.
        let size = [camera.width.get(), camera.height.get()].map(f64::from);
        let reach = camera.eye.abs().max(camera.center.abs()).max_element()
            + right * size[0]
            + up * size[1];
        let is_ill_conditioned =
            64.0 * U * reach > MAX_ERROR * right.min(up) || U * reach > MARGIN * distance.abs();
        // Scale the normal so that the image plane has depth 1.
        let depth = normal / distance;
        let reach =
            lens.iter().map(|from| from.length()).fold(0.0, f64::max) + camera.center.length();
        let lens_box = Bounds::of(lens.iter().copied());
        let (depth_scale, steps) = (depth.length(), [right, up]);
        Self {
            camera: camera.clone(),
            depth,
            depth_scale,
            lens,
            lens_box,
            reach,
            steps,
            size,
            beyond,
            is_ill_conditioned,
        }
    }

    /// The bounding box of the lens.
    pub(crate) fn lens(&self) -> Bounds {
        self.lens_box
    }

    /// The screen-space bounds of a surface.
    pub(crate) fn screen_rect(&self, bounds: &SurfaceBounds) -> ScreenRect {
        match &bounds.extent {
            SurfaceExtent::Within(aabb) if !self.is_ill_conditioned => self.project(aabb),
            SurfaceExtent::Within(_) | SurfaceExtent::Plane(_) | SurfaceExtent::Anywhere => {
                ScreenRect::Unknown
            }
        }
    }

    /// Whether no camera ray hits a plane: all rays from the lens through the picture lead away
    /// from it. Lens and picture are convex and the distance from the plane is linear in both, so
    /// their corners suffice.
    pub(crate) fn is_behind(&self, plane: &OrientedPlane) -> bool {
        let Camera {
            center, right, up, ..
        } = &self.camera;
        let [x, y] = self.size.map(|side| side / 2.0 + 1.0 + self.beyond);
        let corner = |[x, y]: [f64; 2]| *center + *right * x + *up * y;
        let corners = [[-x, -y], [x, -y], [-x, y], [x, y]].map(corner);
        let away = |from: &Vec3, corner: &Vec3| {
            let distance = (*from - plane.point).dot(plane.normal);
            let approach = (*corner - *from).dot(plane.normal);
            let size = from.abs().max_element() + plane.point.abs().max_element();
            let reach = size + corner.abs().max_element();
            distance * approach > 0.0
                && distance.abs() > MARGIN * size
                && approach.abs() > MARGIN * reach
        };
        let leads_away = |from: &Vec3| corners.iter().all(|corner| away(from, corner));
        !self.is_ill_conditioned && self.lens.iter().all(leads_away)
    }

    /// The projection of a point through the centre of the lens, in pixels; `None` if it is
    /// uncertain.
    pub(crate) fn project_through_center(&self, point: Vec3) -> Option<[f64; 2]> {
        let size = point.abs().max_element() + self.lens_box.reach();
        let depth = (point - self.camera.eye).dot(self.depth);
        let error_bound = 64.0 * U * size * self.depth_scale;
        let (at, error) = self.project_point(self.camera.eye, point, depth, error_bound);
        (!self.is_ill_conditioned && depth > 16.0 * error_bound && error <= MAX_ERROR).then_some(at)
    }

    /// The screen rectangle of a box: the bounds of the projections of its corners through the
    /// corners of the lens.
    fn project(&self, aabb: &Bounds) -> ScreenRect {
        let size = aabb.reach() + self.lens_box.reach();
        let aabb = aabb.widened(MARGIN * size);
        let depths = aabb
            .corners()
            .map(|corner| (corner - self.camera.eye).dot(self.depth));
        let error_bound = 64.0 * U * size * self.depth_scale;
        if depths.iter().all(|depth| *depth < -error_bound) {
            return ScreenRect::Outside;
        }
        if depths.iter().any(|depth| *depth <= 16.0 * error_bound) {
            return ScreenRect::Unknown;
        }
        let mut low = [f64::INFINITY; 2];
        let mut high = [f64::NEG_INFINITY; 2];
        for (corner, depth) in aabb.corners().into_iter().zip(depths) {
            for from in &self.lens {
                let (at, error) = self.project_point(*from, corner, depth, error_bound);
                if error.is_nan() || error > MAX_ERROR {
                    return ScreenRect::Unknown;
                }
                low = [0, 1].map(|axis| low[axis].min(at[axis]));
                high = [0, 1].map(|axis| high[axis].max(at[axis]));
            }
        }
        self.rectangle(low, high)
    }

    /// The projection of a point through a point of the lens, in pixels from the upper left, and a
    /// bound on its error.
    fn project_point(
        &self,
        from: Vec3,
        point: Vec3,
        depth: f64,
        error_bound: f64,
    ) -> ([f64; 2], f64) {
        /// The camera's axes are perpendicular up to this error.
        const MAX_SKEW: f64 = 1e-9;
        let Camera {
            center, right, up, ..
        } = &self.camera;
        let away = (point - from) / depth;
        let on_plane = (from - *center) + away;
        let [across_step, upward_step] = self.steps;
        let across = on_plane.dot(*right) / (across_step * across_step);
        let upward = on_plane.dot(*up) / (upward_step * upward_step);
        let error = (error_bound / depth + 16.0 * U) * away.length() + 16.0 * U * self.reach;
        let skew = MAX_SKEW * (across.abs() + upward.abs()) * (across_step + upward_step);
        let at = [across + self.size[0] / 2.0, self.size[1] / 2.0 - upward];
        (at, (error + skew) / across_step.min(upward_step))
    }

    /// The pixels of a screen-space interval, expanded by one pixel and by how far rays reach.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "clamped to the picture before"
    )]
    fn rectangle(&self, low: [f64; 2], high: [f64; 2]) -> ScreenRect {
        let side = |axis: usize| {
            let first = (low[axis] - 1.0 - self.beyond - MAX_ERROR)
                .floor()
                .clamp(0.0, self.size[axis]);
            let last = (high[axis] + 1.0 + self.beyond + MAX_ERROR)
                .ceil()
                .clamp(0.0, self.size[axis]);
            [first as u32, last as u32]
        };
        let rect = PixelRect {
            x: side(0),
            y: side(1),
        };
        let is_empty = rect.x[0] >= rect.x[1] || rect.y[0] >= rect.y[1];
        if is_empty {
            ScreenRect::Outside
        } else {
            ScreenRect::Within(rect)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::margin::tests::{has_margin, span};
    use crate::surface_bounds::ShapeClass;
    use rtc_math::NonNegative;
    use rtc_valid::{Lens, Projection};
    use std::num::NonZeroU32;

    /// A camera of 100 × 80 pixels that looks along −z.
    fn camera(eye: [f64; 3], center: [f64; 3], [right, up]: [f64; 2], radius: f64) -> Camera {
        let count = |n| NonZeroU32::new(n).unwrap();
        Camera {
            eye: Vec3::from_array(eye),
            center: Vec3::from_array(center),
            right: Vec3::X * right,
            up: Vec3::Y * up,
            width: count(100),
            height: count(80),
            lens: Lens {
                radius: NonNegative::new(radius).unwrap(),
                samples: count(9),
            },
            projection: Projection::Perspective,
        }
    }

    /// Pixels of size 1 around the origin, with the eye at distance 100.
    fn projection(radius: f64) -> ScreenProjection {
        ScreenProjection::new(
            &camera([0.0, 0.0, 100.0], [0.0; 3], [1.0; 2], radius),
            radius == 0.0,
            0.0,
        )
    }

    fn pinhole(eye: [f64; 3], center: [f64; 3], steps: [f64; 2]) -> ScreenProjection {
        ScreenProjection::new(&camera(eye, center, steps, 0.0), true, 0.0)
    }

    fn screen_rect(projection: &ScreenProjection, center: Vec3, reach: f64) -> ScreenRect {
        let aabb = Bounds::about(center, Vec3::splat(reach));
        projection.screen_rect(&SurfaceBounds {
            extent: SurfaceExtent::Within(aabb),
            class: ShapeClass::Other,
        })
    }

    #[test]
    fn a_box_shows_in_its_pixels_and_one_more_on_each_side() {
        let rect = ScreenRect::Within(PixelRect {
            x: [58, 64],
            y: [27, 33],
        });
        assert_eq!(
            screen_rect(&projection(0.0), Vec3::new(11.0, 10.0, 0.0), 1.0),
            rect
        );
    }

    #[test]
    fn a_box_behind_or_beside_is_outside_and_one_at_the_lens_is_unknown() {
        let projection = projection(0.0);
        assert_eq!(
            screen_rect(&projection, Vec3::Z * 110.0, 1.0),
            ScreenRect::Outside
        );
        assert_eq!(
            screen_rect(&projection, Vec3::X * 60.0, 1.0),
            ScreenRect::Outside
        );
        assert_eq!(
            screen_rect(&projection, Vec3::Z * 100.0, 1.0),
            ScreenRect::Unknown
        );
        assert_ne!(
            screen_rect(&projection, Vec3::X * 51.0, 1.0),
            ScreenRect::Outside
        );
    }

    #[test]
    fn a_lens_sees_round_the_edge_of_the_picture() {
        let reach = Vec3::new(40.0, 0.0, 50.0);
        assert_eq!(
            screen_rect(&projection(0.0), reach, 1.0),
            ScreenRect::Outside
        );
        assert_ne!(
            screen_rect(&projection(60.0), reach, 1.0),
            ScreenRect::Outside
        );
    }

    #[test]
    fn where_rounding_exceeds_a_pixel_the_bounds_are_unknown() {
        let reach = Vec3::splat(1e16);
        let mut projection = projection(0.0);
        projection.camera.eye += reach;
        projection.camera.center += reach;
        let projection = ScreenProjection::new(&projection.camera, true, 0.0);
        assert_eq!(
            screen_rect(&projection, Vec3::ZERO, 1.0),
            ScreenRect::Unknown
        );
    }

    #[test]
    fn the_camera_gives_the_projection() {
        let projection = pinhole([3.0, 0.0, 4.0], [3.0, 0.0, -4.0], [0.5, 0.25]);
        assert_eq!(
            (projection.depth, projection.depth_scale, projection.reach),
            (Vec3::Z * -0.125, 0.125, 10.0)
        );
        assert_eq!(projection.lens(), span([3.0, 0.0, 4.0], [3.0, 0.0, 4.0]));
        // The lens radius is in units of the upward step, and the lens has the aspect of a pixel.
        let open = ScreenProjection::new(
            &camera([3.0, 0.0, 4.0], [3.0, 0.0, -4.0], [0.5, 0.25], 0.75),
            false,
            0.0,
        );
        assert_eq!(open.lens(), span([1.5, -0.75, 4.0], [4.5, 0.75, 4.0]));
        let corners = [
            [1.5, -0.75, 4.0],
            [4.5, -0.75, 4.0],
            [1.5, 0.75, 4.0],
            [4.5, 0.75, 4.0],
        ];
        assert_eq!(open.lens, corners.map(Vec3::from_array));
        assert_eq!(
            open.reach,
            (4.5_f64 * 4.5 + 0.75 * 0.75 + 16.0).sqrt() + 5.0
        );
    }

    #[test]
    fn a_projection_is_ill_conditioned_where_rounding_is_large_against_a_pixel_or_the_distance() {
        let reach = 1.0 / (1024.0 * U);
        let steps = |steps| pinhole([reach, 0.0, 1_073_741_824.0], [reach, 0.0, 0.0], steps);
        has_margin(0.25, |up| !steps([4.0, up]).is_ill_conditioned);
        has_margin(0.25, |right| !steps([right, 4.0]).is_ill_conditioned);
        // The offset is 30, and the picture has the sizes 50 and 20.
        has_margin(100.0 * U / MARGIN, |z| {
            !pinhole([30.0, 0.0, z], [30.0, 0.0, 0.0], [0.5, 0.25]).is_ill_conditioned
        });
        has_margin(100.0 * U / MARGIN, |z| {
            !pinhole([0.0, 0.0, 0.0], [0.0, -30.0, z], [0.5, 0.25]).is_ill_conditioned
        });
    }

    #[test]
    fn a_point_is_projected_along_the_line_through_the_eye() {
        let projection = pinhole([1.0, 2.0, 100.0], [1.0, 2.0, 0.0], [0.5, 0.25]);
        assert_eq!(
            projection.project_through_center(Vec3::new(6.0, 4.5, 0.0)),
            Some([60.0, 30.0])
        );
        assert_eq!(
            projection.project_through_center(Vec3::new(3.5, 3.25, 50.0)),
            Some([60.0, 30.0])
        );
        assert_eq!(
            projection.project_through_center(Vec3::new(3.5, 3.25, 150.0)),
            None,
            "behind the eye"
        );
        assert_eq!(
            pinhole([1e16, 0.0, 100.0], [1e16, 0.0, 0.0], [1.0; 2])
                .project_through_center(Vec3::X * 1e16),
            None,
            "blurred"
        );
    }

    #[test]
    fn a_box_beside_the_eye_is_unknown_within_the_margin_and_the_rounding_of_its_depth() {
        let beside = |step: f64| pinhole([100.0, 0.0, 0.0], [100.0, 0.0, -128.0], [step; 2]);
        let point = |z: f64| beside(100.0).project_through_center(Vec3::new(100.0, 0.0, -z));
        has_margin(16.0 * 64.0 * 200.0 * U, |z| point(z).is_some());
        assert!(point(16.0 * 64.0 * 200.0 * U).is_none(), "in doubt");
        let screen_rect = |low: f64, high: f64| {
            let extent = SurfaceExtent::Within(span([100.0, 0.0, low], [100.0, 0.0, high]));
            beside(1e6).screen_rect(&SurfaceBounds {
                extent,
                class: ShapeClass::Other,
            })
        };
        has_margin(200.0 * MARGIN + 16.0 * 64.0 * 200.0 * U, |z| {
            screen_rect(-100.0, -z) != ScreenRect::Unknown
        });
        has_margin(200.0 * MARGIN + 64.0 * 200.0 * U, |z| {
            screen_rect(z, 100.0) == ScreenRect::Outside
        });
        assert_eq!(
            screen_rect(200.0 * MARGIN + 64.0 * 200.0 * U, 100.0),
            ScreenRect::Unknown,
            "in doubt"
        );
    }

    #[test]
    fn the_error_of_a_projected_point_has_its_rounding_and_the_skew_of_the_axes() {
        let projection = pinhole([0.0, 0.0, 100.0], [0.0; 3], [0.5, 0.25]);
        let from = Vec3::new(1.0, 2.0, 0.0);
        let project_point = |away: [f64; 3], error_bound: f64| {
            projection.project_point(from, from + Vec3::from_array(away) * 0.5, 0.5, error_bound)
        };
        let is_near = |found: f64, wanted: f64| {
            assert!(
                (found / wanted - 1.0).abs() < 1e-5,
                "{found:e}, not {wanted:e}"
            )
        };
        // In the middle: the error of the depth, the rounding of the distance, 3, and that of the
        // camera, 100.
        let (at, error) = project_point([-1.0, -2.0, 2.0], 100.0 * U);
        assert_eq!(at, [50.0, 40.0]);
        is_near(error, ((200.0 + 16.0) * 3.0 + 16.0 * 100.0) * U / 0.25);
        // 6 pixels across and 20 upward: the error of axes that are not perpendicular.
        let (at, error) = project_point([2.0, 3.0, 6.0], 0.0);
        assert_eq!(at, [56.0, 20.0]);
        is_near(error, 1e-9 * 26.0 * 0.75 / 0.25);
    }

    #[test]
    fn a_box_too_far_aside_or_unbounded_is_unknown() {
        let projection = projection(0.0);
        assert_eq!(
            screen_rect(&projection, Vec3::X * 4e7, 1.0),
            ScreenRect::Outside
        );
        assert_eq!(
            screen_rect(&projection, Vec3::X * 6e7, 1.0),
            ScreenRect::Unknown
        );
        assert_eq!(
            screen_rect(&projection, Vec3::ZERO, f64::INFINITY),
            ScreenRect::Unknown
        );
    }

    #[test]
    fn an_interval_is_expanded_by_a_pixel_and_the_error() {
        let projection = projection(0.0);
        assert_eq!(
            projection.rectangle([3.2, -5.0], [6.8, 200.0]),
            ScreenRect::Within(PixelRect {
                x: [1, 9],
                y: [0, 80]
            })
        );
        assert_eq!(
            projection.rectangle([3.3, 20.0], [6.7, 30.0]),
            ScreenRect::Within(PixelRect {
                x: [2, 8],
                y: [18, 32]
            })
        );
        assert_eq!(
            projection.rectangle([101.5, 20.0], [110.0, 30.0]),
            ScreenRect::Outside,
            "beside"
        );
        assert_eq!(
            projection.rectangle([20.0, -9.0], [30.0, -1.5]),
            ScreenRect::Outside,
            "above"
        );
    }
}
