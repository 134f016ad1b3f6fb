//! The camera, as a `Camera` or in the older form of an `Eye`.

use super::decode::{DecodeContext, Spanned};
use super::keyword::{Keyword, KeywordTable};
use super::lower::Lowering;
use super::number::{Count, FieldOfView, NonNegative, PixelCount, Positive};
use super::record::{FieldResult, record};
use super::synonym::{EYE, IMAGE_SIZE, TARGET};
use super::value::{Point, Shutter, Vector};
use super::view_size::ViewSize;
use rtc_diag::{Severity, codes};
use rtc_ir::{self as ir, EntityField};
use rtc_math::{CameraBasisError, Vec3, atan2, camera_basis, fallback_up, length, shortest, unit};
use rtc_source::Span;

record! {
    /// The camera: its position, its target, and its image.
    struct Camera, "camera" {
        /// The position of the camera.
        eye: Spanned<Point>, required, &EYE;
        /// The point in the middle of the image. The plane through it is in focus.
        center: Spanned<Point>, required, &TARGET;
        /// The up vector; its length is the size of a pixel in the plane through `center`. In a
        /// camera of `position`, `lookAt` and `resolution` a length from 5 to 180 is the field of
        /// view from left to right in degrees, as in the programs that write so.
        up: Spanned<Vector>, required,
            &[&["up"], &["upVector"], &["viewUp"], &["worldUp"], &["vup"]];
        /// The vector from a pixel to its right neighbour. With it `up`, at a right angle, is the
        /// vector to the upper neighbour, and the image plane need not be perpendicular to the view
        /// direction. Without it pixels are square.
        right: Spanned<Vector>, optional, &[&["right"]], own true;
        /// Width and height of the image in pixels.
        view_size: Spanned<ViewSize>, unless("sides"), &IMAGE_SIZE;
        /// Width and height of the image as two keys.
        sides: [Spanned<PixelCount>; 2], optional, &[&["width", "height"]];
        /// The distance from the eye to an image plane with pixels of size 1; then only the
        /// directions of `center` and `up` are used.
        focal_distance: Spanned<Positive>, optional,
            &[&["focalDistance"], &["planeDistance"], &["imagePlaneDistance"]], own true;
        /// The size of a pixel in the image plane; then the length of `up` has no effect.
        pixel_size: Spanned<Positive>, optional, &[&["pixelSize"], &["pixSize"]], own true;
        /// The vertical field of view in degrees, above 0 and below 180; then the length of `up`
        /// has no effect.
        fov: Spanned<FieldOfView>, optional, &[&["fov"], &["fovy"], &["vfov"], &["yfov"]], own true;
        /// The projection: `perspective`, with all rays from the eye; or `orthographic`, with
        /// parallel rays in the direction from the eye to `center`, so that `fov` has no effect.
        projection: Spanned<ir::Projection>, default(ir::Projection::Perspective),
            &[&["projection"]], own true;
        /// The distance between two eyes in scene units; 0 for one eye. What lies in the plane
        /// through `center` is at the same place for both.
        stereo: Spanned<NonNegative>, default(NonNegative(0.0)),
            &[&["stereo"], &["eyeDistance"]], own true;
        /// How the picture shows what two eyes see: `sideBySide`, each in one half of the picture;
        /// or `anaglyph`, for glasses with a red filter on the left and a cyan one on the right.
        stereo_view: Spanned<ir::StereoView>, default(ir::StereoView::SideBySide),
            &[&["stereoView"]], own true;
        /// When the shutter opens and closes, in seconds: in between objects with a `velocity`
        /// move.
        shutter: Spanned<Shutter>, default(Shutter([0.0, 1.0])), &[&["shutter"]], own true;
        /// The radius of the lens in scene units; at 0 everything is in focus.
        aperture_radius: Spanned<NonNegative>, default(NonNegative(0.0)), &[&["apertureRadius"]];
        /// The number of lens samples per sub-sample.
        aperture_samples: Spanned<Count>, default(Count(1)), &[&["apertureSamples"]];
    }
    variants { [view_size] [sides] }
}

impl Keyword for ir::Projection {
    const KEYWORDS: KeywordTable<Self> = &[
        (
            "perspective",
            ir::Projection::Perspective,
            "Rays from the eye: what is farther looks smaller.",
        ),
        (
            "orthographic",
            ir::Projection::Orthographic,
            "Parallel rays: what is farther looks as large.",
        ),
    ];
}

impl Keyword for ir::StereoView {
    const KEYWORDS: KeywordTable<Self> = &[
        (
            "sideBySide",
            ir::StereoView::SideBySide,
            "The left eye in the left half of the picture, the right eye in the right half.",
        ),
        (
            "anaglyph",
            ir::StereoView::Anaglyph,
            "Both eyes in one picture, for red and cyan glasses.",
        ),
    ];
}

impl Camera {
    /// Whether the length of `up`, or `pixelSize`, is the size of a pixel.
    fn uses_up_length(&self) -> bool {
        !self.has_fov() && self.right.is_absent()
    }

    /// Whether `fov` determines the size of a pixel.
    fn has_fov(&self) -> bool {
        !self.fov.is_absent() && self.projection.value == ir::Projection::Perspective
    }
}

/// The size of the image if neither a `Camera` nor an `ImageSize` gives it.
pub(super) const DEFAULT_SIZE: ViewSize = ViewSize([400, 400]);

impl Lowering {
    /// Lowers a `Camera`.
    pub(super) fn camera(&mut self, camera: &Spanned<Camera>, context: &mut DecodeContext<'_>) {
        let (center, up) = image_plane(&camera.value, context);
        let [fov_span, pixel_span] = size_spans(&camera.value, &up);
        let Camera {
            eye,
            center: _,
            up: _,
            right: step,
            view_size,
            sides,
            focal_distance: _,
            pixel_size: _,
            fov: _,
            projection,
            stereo: _,
            stereo_view: _,
            shutter: _,
            aperture_radius,
            aperture_samples,
        } = &camera.value;
        // The size of the image, from either variant.
        let view_size = match (view_size, sides) {
            (FieldResult::Read(size), _) => *size,
            (_, FieldResult::Read([width, height])) => {
                height.map(|_| ViewSize([width.value.0, height.value.0]))
            }
            _ => return,
        };
        report_pixel_size_without_effect(&camera.value, context);
        report_view_of_one_eye(&camera.value, context);
        // The field of view and the vectors between pixels.
        let fov = fov(&camera.value, &up, context);
        let basis = basis(&camera.value, &center, &up, context);
        // The spans of the values.
        for (field, span) in [
            (EntityField::Whole, camera.span),
            (EntityField::Eye, eye.span),
            (EntityField::Center, center.span),
            (
                EntityField::Right,
                if let FieldResult::Read(step) = step {
                    step.span
                } else {
                    up.span
                },
            ),
            (EntityField::Up, up.span),
            (EntityField::Fov, fov_span),
            (EntityField::PixelSize, pixel_span),
            (EntityField::Size, view_size.span),
            (EntityField::LensRadius, aperture_radius.span),
            (EntityField::LensSamples, aperture_samples.span),
        ] {
            self.record_span(ir::EntityKind::Camera, 0, field, span);
        }
        let Some((right, up)) = basis else { return };
        // The camera of the IR.
        self.scene.camera = ir::Camera {
            eye: eye.value.0,
            center: center.value.0,
            right: right.to_array(),
            up: up.to_array(),
            size: view_size.value.0,
            lens: ir::Lens {
                radius: aperture_radius.value.0,
                samples: aperture_samples.value.0,
            },
            projection: projection.value,
        };
        if let Some(fov) = fov {
            self.scene.camera.open(fov);
        }
    }

    /// Lowers a camera of three top-level keys: eye, target and up vector.
    pub(super) fn camera_from_keys(
        &mut self,
        [eye, center, up]: &[Spanned<Point>; 3],
        size: ViewSize,
        context: &mut DecodeContext<'_>,
    ) {
        let camera = Camera {
            eye: *eye,
            center: *center,
            up: up.map(|point| Vector(point.0)),
            right: FieldResult::Absent,
            view_size: FieldResult::Read(Spanned::without_span(size)),
            sides: FieldResult::Absent,
            focal_distance: FieldResult::Absent,
            pixel_size: FieldResult::Absent,
            fov: FieldResult::Absent,
            projection: Spanned::without_span(ir::Projection::Perspective),
            stereo: Spanned::without_span(NonNegative(0.0)),
            stereo_view: Spanned::without_span(ir::StereoView::SideBySide),
            shutter: Spanned::without_span(Shutter([0.0, 1.0])),
            aperture_radius: Spanned::without_span(NonNegative(0.0)),
            aperture_samples: Spanned::without_span(Count(1)),
        };
        self.camera(
            &Spanned {
                value: camera,
                span: eye.span,
            },
            context,
        );
    }

    /// Lowers an `Eye`: it looks at a rectangle in the plane z = 0 with one corner at the origin
    /// and pixels of size 1. A `Resolution` is the number of pixels across the width of 400 units
    /// that an `Eye` sees without a size.
    pub(super) fn old_eye_camera(
        &mut self,
        eye: Spanned<Point>,
        size: ViewSize,
        context: &DecodeContext<'_>,
    ) {
        let [width, _] = size.0.map(f64::from);
        let pixel = match context.is_spelled("Resolution", "ImageSize") {
            true if width > 0.0 => f64::from(DEFAULT_SIZE.0[0]) / width,
            _ => 1.0,
        };
        let [x, y] = size.0.map(|side| f64::from(side) / 2.0 * pixel);
        self.scene.camera = ir::Camera {
            eye: eye.value.0,
            center: [x, y, 0.0],
            right: [pixel, 0.0, 0.0],
            up: [0.0, pixel, 0.0],
            size: size.0,
            ..ir::Camera::default()
        };
        self.record_span(ir::EntityKind::Camera, 0, EntityField::Whole, eye.span);
        self.record_span(ir::EntityKind::Camera, 0, EntityField::Eye, eye.span);
    }
}

/// The centre of the image and the up vector. With a focal distance the image plane has that
/// distance, and pixels of size 1 or of the given size.
fn image_plane(
    camera: &Camera,
    context: &mut DecodeContext<'_>,
) -> (Spanned<Point>, Spanned<Vector>) {
    let (mut center, mut up) = (camera.center, camera.up);
    let [eye, at, upward] = [camera.eye.value.0, center.value.0, up.value.0].map(Vec3::from_array);
    let distance = camera.focal_distance.ok();
    let size = camera.pixel_size.ok().filter(|_| camera.uses_up_length());
    let size = size.map(|size| size.value.0);
    let size = size.or(distance.map(|_| 1.0));
    let size = size.or_else(|| pixel_of_opening(camera, context));
    if let (Some(view_dir), Some(distance)) = (unit(at - eye), distance) {
        center.value = Point((eye + view_dir * distance.value.0).to_array());
    }
    if let (Some(upward), Some(size)) = (unit(upward), size) {
        up.value = Vector((upward * size).to_array());
    }
    (center, up)
}

/// Where the field of view and the size of a pixel are written, of a camera with this `up` in the
/// image plane. Each is absent where it, or the length of `up`, has no effect on the size.
fn size_spans(camera: &Camera, up: &Spanned<Vector>) -> [Option<Span>; 2] {
    if camera.has_fov() {
        return [camera.fov.read().and_then(|fov| fov.span), None];
    }
    let size = camera.pixel_size.read().and_then(|size| size.span);
    let distance = camera.focal_distance.read().and_then(|it| it.span);
    match size.filter(|_| camera.uses_up_length()).or(distance) {
        None if up.value.0 != camera.up.value.0 => [up.span, None],
        written => [None, written],
    }
}

/// The lengths of `up` that are degrees in a camera of `position`, `lookAt` and `resolution`.
const OPENINGS: std::ops::Range<f64> = 5.0..180.0;

/// The size of a pixel in a camera of `position`, `lookAt` and `resolution`, if the length of its
/// `up` is that of an angle: the programs that write these keys see so many degrees across. The
/// reading is reported.
fn pixel_of_opening(camera: &Camera, context: &mut DecodeContext<'_>) -> Option<f64> {
    let other_keys = [
        ("position", "eye"),
        ("lookAt", "center"),
        ("resolution", "viewSize"),
    ];
    let mut other_keys = other_keys.into_iter();
    let are_other = other_keys.all(|(written, canonical)| context.is_spelled(written, canonical));
    let [eye, center, up] =
        [camera.eye.value.0, camera.center.value.0, camera.up.value.0].map(Vec3::from_array);
    let (degrees, ViewSize([width, height])) = (length(up), camera.view_size.read()?.value);
    let is_perspective = camera.projection.value == ir::Projection::Perspective;
    let reads_length = are_other && is_perspective && camera.uses_up_length();
    if !(reads_length && OPENINGS.contains(&degrees)) || width == 0 {
        return None;
    }
    let pixel = ir::Camera::pixel(degrees.to_radians(), eye.distance(center), width);
    let half = pixel * f64::from(height) / 2.0;
    let down = 2.0 * atan2(half, eye.distance(center)).to_degrees();
    let down = shortest((down * 100.0).round() / 100.0);
    let across = shortest(degrees);
    let message =
        || format!("the length of `up` is read as a field of view of {across} degrees across");
    let span = camera.up.span?;
    context.report(&codes::KEY_READ_DIFFERENTLY, span, message, |d| {
        d.at(
            span,
            "as where `position`, `lookAt` and `resolution` are the keys",
        )
        .hint(format!(
            "`fov: {down}` says so everywhere; beside `eye`, `center` and `viewSize` the \
                 length of `up` is the size of a pixel"
        ))
    });
    Some(pixel)
}

/// Reports a `pixelSize` that another key overrides.
fn report_pixel_size_without_effect(camera: &Camera, context: &mut DecodeContext<'_>) {
    let span = camera.pixel_size.read().and_then(|size| size.span);
    if let (Some(span), false) = (span, camera.uses_up_length()) {
        let message = || "`pixelSize` has no effect with `fov` or `right`".to_owned();
        context.report(&codes::NO_EFFECT, span, message, |d| {
            d.at(span, "ignored").severity(Severity::Warning)
        });
    }
}

/// Reports a `stereoView` without `stereo`.
fn report_view_of_one_eye(camera: &Camera, context: &mut DecodeContext<'_>) {
    if let (Some(span), true) = (camera.stereo_view.span, camera.stereo.value.0 == 0.0) {
        let message = || "`stereoView` has no effect without `stereo`".to_owned();
        context.report(&codes::NO_EFFECT, span, message, |d| {
            d.at(span, "one eye sees the picture")
                .severity(Severity::Warning)
        });
    }
}

/// The vertical field of view in radians, if it is given. Reports a `fov` or a length of `up`
/// without effect.
fn fov(camera: &Camera, up: &Spanned<Vector>, context: &mut DecodeContext<'_>) -> Option<f64> {
    let FieldResult::Read(Spanned {
        value: FieldOfView(degrees),
        span: Some(span),
    }) = camera.fov
    else {
        return None;
    };
    if !camera.has_fov() {
        let message = || "`fov` has no effect on an orthographic camera".to_owned();
        context.report(&codes::NO_EFFECT, span, message, |d| {
            d.at(span, "ignored: the length of `up` is the size of a pixel")
                .also(camera.projection.span, "an orthographic picture")
                .severity(Severity::Warning)
        });
        return None;
    }
    let length = length(Vec3::from_array(up.value.0));
    if let (Some(up_span), true) = (up.span, (length - 1.0).abs() > 1e-6) {
        let message = || "the length of `up` has no effect with `fov`".to_owned();
        context.report(&codes::NO_EFFECT, up_span, message, |d| {
            d.at(up_span, "only the direction is used")
                .also(span, "gives the size of a pixel")
                .severity(Severity::Warning)
        });
    }
    Some(degrees.to_radians())
}

/// The vectors between neighbouring pixels; `None` if there are none, which is reported.
fn basis(
    camera: &Camera,
    center: &Spanned<Point>,
    up: &Spanned<Vector>,
    context: &mut DecodeContext<'_>,
) -> Option<(Vec3, Vec3)> {
    let Camera { eye, right, .. } = camera;
    match right {
        FieldResult::Read(right) => {
            return Some((
                Vec3::from_array(right.value.0),
                Vec3::from_array(up.value.0),
            ));
        }
        FieldResult::Broken => return None,
        FieldResult::Absent => {}
    }
    // Without `right` the basis follows from the view direction and `up`.
    let [from, to, mut upward] = [eye.value.0, center.value.0, up.value.0].map(Vec3::from_array);
    if camera.has_fov() {
        upward = unit(upward).unwrap_or(Vec3::ZERO);
    }
    match camera_basis(from, to, upward) {
        Ok(basis) => Some(basis),
        Err(CameraBasisError::ZeroGaze) => {
            if let Some(span) = center.span {
                let message = || "the camera looks at the point where it stands".to_owned();
                context.report(&codes::EYE_IS_CENTER, span, message, |d| {
                    d.at(span, "the same point as `eye`")
                        .also(eye.span, "the eye")
                        .hint("move one of them")
                });
            }
            None
        }
        Err(CameraBasisError::ZeroUp) => {
            if let Some(span) = up.span {
                context.report(
                    &codes::ZERO_UP,
                    span,
                    || "`up` has no length".to_owned(),
                    |d| {
                        d.at(span, "no direction, and no size of a pixel").guess(
                            "for instance",
                            span,
                            "[0, 1, 0]",
                        )
                    },
                );
            }
            None
        }
        Err(CameraBasisError::Parallel) => report_parallel_up(to - from, upward, up.span?, context)
            .and_then(|up| camera_basis(from, to, up).ok()),
    }
}

/// Reports an `up` along the view direction, with a replacement; returns it if `--lenient` is on.
fn report_parallel_up(
    view_dir: Vec3,
    up: Vec3,
    span: Span,
    context: &mut DecodeContext<'_>,
) -> Option<Vec3> {
    let replacement = fallback_up(view_dir, up);
    let [x, y, z] = replacement.to_array().map(shortest);
    let text = format!("[{x}, {y}, {z}]");
    let lenient = context.options.lenient;
    context.report(
        &codes::UP_PARALLEL,
        span,
        || "`up` points along the view".to_owned(),
        |d| match lenient {
            false => d
                .at(span, "parallel to the direction from `eye` to `center`")
                .guess("change it, for instance to", span, text),
            true => d
                .at(span, format!("parallel to the view; taken as {text}"))
                .severity(Severity::Warning),
        },
    );
    lenient.then_some(replacement)
}
