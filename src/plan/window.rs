//! Where things may show in the picture: boxes projected through the lens to rectangles of pixels,
//! with a margin.

use super::body::{Body, Extent};
use super::space::{ROOM, Space};
use crate::math::{U, Vec3, cross, dot};
use crate::valid::Camera;

/// How far rounding may move what a pixel shows, in pixels, before nothing is said of it.
const DOUBT: f64 = 0.25;

/// A rectangle of pixels: columns and rows, each from the first to before the last.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::plan) struct Rect {
    pub(in crate::plan) x: [u32; 2],
    pub(in crate::plan) y: [u32; 2],
}

/// Where a surface may show.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::plan) enum Shown {
    /// Nowhere: no camera ray meets it.
    Nowhere,
    /// In these pixels alone.
    In(Rect),
    /// Anywhere.
    Anywhere,
}

/// The camera, seen as a map from the world to the picture.
pub(in crate::plan) struct Window {
    camera: Camera,
    /// A direction at a right angle to the image plane, in which that plane is 1 from the eye.
    depth: Vec3,
    /// The length of that direction.
    steepness: f64,
    /// The points of the lens are among these, and in their hull.
    lens: Vec<Vec3>,
    /// The box of all points of the lens.
    lens_box: Space,
    /// How far the lens and the middle of the picture are from the origin at most.
    far: f64,
    /// How far apart pixels are, across and upward.
    steps: [f64; 2],
    /// The pixels, in pixels.
    size: [f64; 2],
    /// Whether rounding leaves the map in doubt everywhere.
    blurred: bool,
}

impl Window {
    pub(in crate::plan) fn new(camera: &Camera, pinhole: bool) -> Self {
        let (right, up) = (camera.right.length(), camera.up.length());
        let normal = cross(camera.right / right, camera.up / up);
        let forward = camera.center - camera.eye;
        let distance = dot(normal, forward);
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
        let size = [camera.width.get(), camera.height.get()].map(f64::from);
        let reach = camera.eye.abs().max(camera.center.abs()).max_element()
            + right * size[0]
            + up * size[1];
        let blurred = 64.0 * U * reach > DOUBT * right.min(up) || U * reach > ROOM * distance.abs();
        let depth = normal / distance;
        let far =
            lens.iter().map(|from| from.length()).fold(0.0, f64::max) + camera.center.length();
        let lens_box = Space::of(lens.iter().copied());
        let (steepness, steps) = (depth.length(), [right, up]);
        Self {
            camera: camera.clone(),
            depth,
            steepness,
            lens,
            lens_box,
            far,
            steps,
            size,
            blurred,
        }
    }

    /// The box of all points of the lens.
    pub(in crate::plan) fn lens(&self) -> Space {
        self.lens_box
    }

    /// Where a surface may show.
    pub(in crate::plan) fn shown(&self, body: &Body) -> Shown {
        match &body.extent {
            Extent::Within(space) if !self.blurred => self.project(space),
            Extent::Within(_) | Extent::Plane(_) | Extent::Anywhere => Shown::Anywhere,
        }
    }

    /// Where a point shows from the middle of the lens, in pixels; `None` where that is in doubt.
    pub(in crate::plan) fn middle(&self, point: Vec3) -> Option<[f64; 2]> {
        let size = point.abs().max_element() + self.lens_box.size();
        let depth = (point - self.camera.eye).dot(self.depth);
        let doubt = 64.0 * U * size * self.steepness;
        let (at, error) = self.place(self.camera.eye, point, depth, doubt);
        (!self.blurred && depth > 16.0 * doubt && error <= DOUBT).then_some(at)
    }

    /// The rectangle of a box: the hull of its corners, seen from the corners of the lens.
    fn project(&self, space: &Space) -> Shown {
        let size = space.size() + self.lens_box.size();
        let space = space.grown(ROOM * size);
        let depths = space
            .corners()
            .map(|corner| (corner - self.camera.eye).dot(self.depth));
        let doubt = 64.0 * U * size * self.steepness;
        if depths.iter().all(|depth| *depth < -doubt) {
            return Shown::Nowhere;
        }
        if depths.iter().any(|depth| *depth <= 16.0 * doubt) {
            return Shown::Anywhere;
        }
        let mut low = [f64::INFINITY; 2];
        let mut high = [f64::NEG_INFINITY; 2];
        for (corner, depth) in space.corners().into_iter().zip(depths) {
            for from in &self.lens {
                let (at, error) = self.place(*from, corner, depth, doubt);
                if error.is_nan() || error > DOUBT {
                    return Shown::Anywhere;
                }
                low = [0, 1].map(|axis| low[axis].min(at[axis]));
                high = [0, 1].map(|axis| high[axis].max(at[axis]));
            }
        }
        self.rectangle(low, high)
    }

    /// Where a point shows from a point of the lens, in pixels from the upper left, and a bound on
    /// its error.
    fn place(&self, from: Vec3, point: Vec3, depth: f64, doubt: f64) -> ([f64; 2], f64) {
        /// The steps of a camera are at a right angle to within this.
        const RIGHT_ANGLE: f64 = 1e-9;
        let Camera {
            center, right, up, ..
        } = &self.camera;
        let away = (point - from) / depth;
        let on_plane = (from - *center) + away;
        let [across_step, upward_step] = self.steps;
        let across = on_plane.dot(*right) / (across_step * across_step);
        let upward = on_plane.dot(*up) / (upward_step * upward_step);
        let error = (doubt / depth + 16.0 * U) * away.length() + 16.0 * U * self.far;
        let skew = RIGHT_ANGLE * (across.abs() + upward.abs()) * (across_step + upward_step);
        let at = [across + self.size[0] / 2.0, self.size[1] / 2.0 - upward];
        (at, (error + skew) / across_step.min(upward_step))
    }

    /// The pixels within one of a stretch of the picture.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "clamped to the picture before"
    )]
    fn rectangle(&self, low: [f64; 2], high: [f64; 2]) -> Shown {
        let side = |axis: usize| {
            let first = (low[axis] - 1.0 - DOUBT)
                .floor()
                .clamp(0.0, self.size[axis]);
            let last = (high[axis] + 1.0 + DOUBT)
                .ceil()
                .clamp(0.0, self.size[axis]);
            [first as u32, last as u32]
        };
        let rect = Rect {
            x: side(0),
            y: side(1),
        };
        let is_empty = rect.x[0] >= rect.x[1] || rect.y[0] >= rect.y[1];
        if is_empty {
            Shown::Nowhere
        } else {
            Shown::In(rect)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::body::Form;
    use super::super::space::tests::{has_margin, span};
    use super::*;
    use crate::math::NonNegative;
    use crate::valid::{Lens, Projection};
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

    /// Pixels of size 1 around the origin, seen from 100 in front.
    fn window(radius: f64) -> Window {
        Window::new(
            &camera([0.0, 0.0, 100.0], [0.0; 3], [1.0; 2], radius),
            radius == 0.0,
        )
    }

    fn pinhole(eye: [f64; 3], center: [f64; 3], steps: [f64; 2]) -> Window {
        Window::new(&camera(eye, center, steps, 0.0), true)
    }

    fn shown(window: &Window, center: Vec3, reach: f64) -> Shown {
        let space = Space::around(center, Vec3::splat(reach));
        window.shown(&Body {
            extent: Extent::Within(space),
            form: Form::Other,
        })
    }

    #[test]
    fn a_box_shows_in_its_pixels_and_one_more_on_each_side() {
        let rect = Shown::In(Rect {
            x: [58, 64],
            y: [27, 33],
        });
        assert_eq!(shown(&window(0.0), Vec3::new(11.0, 10.0, 0.0), 1.0), rect);
    }

    #[test]
    fn what_is_behind_or_beside_shows_nowhere_and_what_reaches_the_lens_anywhere() {
        let window = window(0.0);
        assert_eq!(shown(&window, Vec3::Z * 110.0, 1.0), Shown::Nowhere);
        assert_eq!(shown(&window, Vec3::X * 60.0, 1.0), Shown::Nowhere);
        assert_eq!(shown(&window, Vec3::Z * 100.0, 1.0), Shown::Anywhere);
        assert_ne!(shown(&window, Vec3::X * 51.0, 1.0), Shown::Nowhere);
    }

    #[test]
    fn a_lens_sees_round_the_edge_of_the_picture() {
        let far = Vec3::new(40.0, 0.0, 50.0);
        assert_eq!(shown(&window(0.0), far, 1.0), Shown::Nowhere);
        assert_ne!(shown(&window(60.0), far, 1.0), Shown::Nowhere);
    }

    #[test]
    fn where_rounding_blurs_a_pixel_nothing_is_said() {
        let far = Vec3::splat(1e16);
        let mut window = window(0.0);
        window.camera.eye += far;
        window.camera.center += far;
        let window = Window::new(&window.camera, true);
        assert_eq!(shown(&window, Vec3::ZERO, 1.0), Shown::Anywhere);
    }

    #[test]
    fn a_camera_is_measured() {
        let window = pinhole([3.0, 0.0, 4.0], [3.0, 0.0, -4.0], [0.5, 0.25]);
        assert_eq!(
            (window.depth, window.steepness, window.far),
            (Vec3::Z * -0.125, 0.125, 10.0)
        );
        assert_eq!(window.lens(), span([3.0, 0.0, 4.0], [3.0, 0.0, 4.0]));
        // The radius counts in steps upward, the lens is as wide as pixels are.
        let open = Window::new(
            &camera([3.0, 0.0, 4.0], [3.0, 0.0, -4.0], [0.5, 0.25], 0.75),
            false,
        );
        assert_eq!(open.lens(), span([1.5, -0.75, 4.0], [4.5, 0.75, 4.0]));
        let corners = [
            [1.5, -0.75, 4.0],
            [4.5, -0.75, 4.0],
            [1.5, 0.75, 4.0],
            [4.5, 0.75, 4.0],
        ];
        assert_eq!(open.lens, corners.map(Vec3::from_array));
        assert_eq!(open.far, (4.5_f64 * 4.5 + 0.75 * 0.75 + 16.0).sqrt() + 5.0);
    }

    #[test]
    fn a_picture_is_blurred_where_rounding_is_a_part_of_a_pixel_or_of_the_way_to_it() {
        let far = 1.0 / (1024.0 * U);
        let steps = |steps| pinhole([far, 0.0, 1_073_741_824.0], [far, 0.0, 0.0], steps);
        has_margin(0.25, |up| !steps([4.0, up]).blurred);
        has_margin(0.25, |right| !steps([right, 4.0]).blurred);
        // 30 aside, and the picture is 50 and 20 large.
        has_margin(100.0 * U / ROOM, |z| {
            !pinhole([30.0, 0.0, z], [30.0, 0.0, 0.0], [0.5, 0.25]).blurred
        });
        has_margin(100.0 * U / ROOM, |z| {
            !pinhole([0.0, 0.0, 0.0], [0.0, -30.0, z], [0.5, 0.25]).blurred
        });
    }

    #[test]
    fn a_point_shows_where_the_line_to_it_meets_the_picture() {
        let window = pinhole([1.0, 2.0, 100.0], [1.0, 2.0, 0.0], [0.5, 0.25]);
        assert_eq!(window.middle(Vec3::new(6.0, 4.5, 0.0)), Some([60.0, 30.0]));
        assert_eq!(
            window.middle(Vec3::new(3.5, 3.25, 50.0)),
            Some([60.0, 30.0])
        );
        assert_eq!(
            window.middle(Vec3::new(3.5, 3.25, 150.0)),
            None,
            "behind the eye"
        );
        assert_eq!(
            pinhole([1e16, 0.0, 100.0], [1e16, 0.0, 0.0], [1.0; 2]).middle(Vec3::X * 1e16),
            None,
            "blurred"
        );
    }

    #[test]
    fn what_is_beside_the_eye_is_in_doubt_by_room_of_both_and_the_rounding_of_its_depth() {
        let beside = |step: f64| pinhole([100.0, 0.0, 0.0], [100.0, 0.0, -128.0], [step; 2]);
        let point = |z: f64| beside(100.0).middle(Vec3::new(100.0, 0.0, -z));
        has_margin(16.0 * 64.0 * 200.0 * U, |z| point(z).is_some());
        assert!(point(16.0 * 64.0 * 200.0 * U).is_none(), "in doubt");
        let shown = |low: f64, high: f64| {
            let extent = Extent::Within(span([100.0, 0.0, low], [100.0, 0.0, high]));
            beside(1e6).shown(&Body {
                extent,
                form: Form::Other,
            })
        };
        has_margin(200.0 * ROOM + 16.0 * 64.0 * 200.0 * U, |z| {
            shown(-100.0, -z) != Shown::Anywhere
        });
        has_margin(200.0 * ROOM + 64.0 * 200.0 * U, |z| {
            shown(z, 100.0) == Shown::Nowhere
        });
        assert_eq!(
            shown(200.0 * ROOM + 64.0 * 200.0 * U, 100.0),
            Shown::Anywhere,
            "in doubt"
        );
    }

    #[test]
    fn the_place_of_a_point_has_its_rounding_and_that_of_the_steps() {
        let window = pinhole([0.0, 0.0, 100.0], [0.0; 3], [0.5, 0.25]);
        let from = Vec3::new(1.0, 2.0, 0.0);
        let place = |away: [f64; 3], doubt: f64| {
            window.place(from, from + Vec3::from_array(away) * 0.5, 0.5, doubt)
        };
        let is_near = |found: f64, wanted: f64| {
            assert!(
                (found / wanted - 1.0).abs() < 1e-5,
                "{found:e}, not {wanted:e}"
            )
        };
        // Seen in the middle: what the depth is in doubt by, and the rounding of the way, 3, and of
        // the camera, 100.
        let (at, error) = place([-1.0, -2.0, 2.0], 100.0 * U);
        assert_eq!(at, [50.0, 40.0]);
        is_near(error, ((200.0 + 16.0) * 3.0 + 16.0 * 100.0) * U / 0.25);
        // 6 pixels across and 20 upward: what two steps at no right angle come to.
        let (at, error) = place([2.0, 3.0, 6.0], 0.0);
        assert_eq!(at, [56.0, 20.0]);
        is_near(error, 1e-9 * 26.0 * 0.75 / 0.25);
    }

    #[test]
    fn what_shows_nowhere_for_sure_is_not_too_far_aside_nor_without_bounds() {
        let window = window(0.0);
        assert_eq!(shown(&window, Vec3::X * 4e7, 1.0), Shown::Nowhere);
        assert_eq!(shown(&window, Vec3::X * 6e7, 1.0), Shown::Anywhere);
        assert_eq!(shown(&window, Vec3::ZERO, f64::INFINITY), Shown::Anywhere);
    }

    #[test]
    fn a_stretch_of_the_picture_is_taken_with_a_pixel_and_the_doubt_on_each_side() {
        let window = window(0.0);
        assert_eq!(
            window.rectangle([3.2, -5.0], [6.8, 200.0]),
            Shown::In(Rect {
                x: [1, 9],
                y: [0, 80]
            })
        );
        assert_eq!(
            window.rectangle([3.3, 20.0], [6.7, 30.0]),
            Shown::In(Rect {
                x: [2, 8],
                y: [18, 32]
            })
        );
        assert_eq!(
            window.rectangle([101.5, 20.0], [110.0, 30.0]),
            Shown::Nowhere,
            "beside"
        );
        assert_eq!(
            window.rectangle([20.0, -9.0], [30.0, -1.5]),
            Shown::Nowhere,
            "above"
        );
    }
}
