//! Conservative projection of bounding boxes through the lens to pixel rectangles.
//!
//! A box is projected corner by corner, through every corner of the lens; the rectangle of these
//! points, expanded by a pixel and by the error bound, contains every pixel whose camera rays may hit
//! the box. All error bounds are first-order bounds of the rounding of each operation, as multiples
//! of the unit roundoff [`U`]. Where the error may exceed [`MAX_ERROR`] of a pixel, or a box reaches
//! the plane of the lens, the result is [`ScreenRect::Unknown`].

use crate::margin::{MARGIN, OrientedPlane};
use crate::surface_bounds::{Extent, SurfaceBounds};
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
    /// Whether rounding makes the projection useless everywhere.
    is_ill_conditioned: bool,
}

impl ScreenProjection {
    pub(crate) fn new(camera: &Camera, pinhole: bool) -> Self {
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
            Extent::Within(aabb) if !self.is_ill_conditioned => self.project(aabb),
            Extent::Within(_) | Extent::Plane(_) | Extent::Anywhere => ScreenRect::Unknown,
        }
    }

    /// Whether no camera ray hits a plane: all rays from the lens through the picture lead away
    /// from it. Lens and picture are convex and the distance from the plane is linear in both, so
    /// their corners suffice.
    pub(crate) fn is_behind(&self, plane: &OrientedPlane) -> bool {
        let Camera {
            center, right, up, ..
        } = &self.camera;
        let [x, y] = self.size.map(|side| side / 2.0 + 1.0);
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

    /// The pixels of a screen-space interval, expanded by one pixel.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "clamped to the picture before"
    )]
    fn rectangle(&self, low: [f64; 2], high: [f64; 2]) -> ScreenRect {
        let side = |axis: usize| {
            let first = (low[axis] - 1.0 - MAX_ERROR)
                .floor()
                .clamp(0.0, self.size[axis]);
            let last = (high[axis] + 1.0 + MAX_ERROR)
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
mod tests;
