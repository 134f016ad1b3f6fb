//! Cameras of scenes that are built in code.

use rtc_diag::{Diagnostic, codes};
use rtc_ir::{self as ir, Projection};
use rtc_math::{CameraBasisError, Vec3, camera_basis, fallback_up, length, shortest, unit};

/// A camera. The defaults are those of most scenes: +y is up, the vertical field of view has 45
/// degrees, the picture 400 × 400 pixels, and all is in focus.
///
/// ```
/// use rtc::{Camera, SceneBuilder};
///
/// let camera = Camera::look_at([0.0, 2.0, 8.0], [0.0, 1.0, 0.0]).fov(40.0).size(320, 240);
/// let scene = SceneBuilder::new(camera).build().unwrap();
/// let camera = scene.tree().unwrap().camera();
/// assert_eq!((camera.position(), camera.pixels()), ([0.0, 2.0, 8.0], [320, 240]));
/// assert!((camera.field_of_view().unwrap() - 40.0).abs() < 1e-9);
/// ```
#[derive(Clone, Debug, PartialEq)]
#[must_use = "a camera sees nothing without a scene"]
pub struct Camera {
    ir: ir::Camera,
    steps: PixelSteps,
    /// The vertical field of view in degrees, or the height of an orthographic picture.
    extent: Option<f64>,
}

/// The definition of the steps between pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
enum PixelSteps {
    /// They are given.
    Given,
    /// By +y, or another axis if the camera looks along it.
    Default,
    /// By this upward direction.
    Up([f64; 3]),
}

impl Camera {
    /// A camera at `eye`, with the point `center` in the middle of the picture and in focus.
    pub fn look_at(eye: [f64; 3], center: [f64; 3]) -> Self {
        Self {
            ir: ir::Camera {
                eye,
                center,
                ..placeholder()
            },
            steps: PixelSteps::Default,
            extent: Some(45.0),
        }
    }

    /// The upward direction, of any length but 0.
    pub fn up(mut self, up: [f64; 3]) -> Self {
        self.steps = PixelSteps::Up(up);
        self
    }

    /// The vertical field of view in degrees, above 0 and below 180.
    pub fn fov(mut self, degrees: f64) -> Self {
        self.ir.projection = Projection::Perspective;
        self.extent = Some(degrees);
        self
    }

    /// Parallel rays; `height` is that of the picture in scene units, above 0.
    pub fn orthographic(mut self, height: f64) -> Self {
        self.ir.projection = Projection::Orthographic;
        self.extent = Some(height);
        self
    }

    /// Width and height of the picture in pixels; the vertical extent stays.
    pub fn size(mut self, width: u32, height: u32) -> Self {
        let ratio = f64::from(self.ir.size[1]) / f64::from(height.max(1));
        let scaled = |step: [f64; 3]| step.map(|component| component * ratio);
        (self.ir.right, self.ir.up) = (scaled(self.ir.right), scaled(self.ir.up));
        self.ir.size = [width, height];
        self
    }

    /// A thin lens: its radius in scene units, and its samples per sub-sample (unused by path
    /// tracing), at least 1.
    pub fn lens(mut self, radius: f64, samples: u32) -> Self {
        self.ir.lens = ir::Lens { radius, samples };
        self
    }

    /// The same camera elsewhere: as [`Camera::look_at`], with the rest unchanged.
    pub fn moved(self, eye: [f64; 3], center: [f64; 3]) -> Self {
        let mut moved = Self::look_at(eye, center);
        moved.extent = match self.ir.projection {
            Projection::Perspective => self.field_of_view(),
            Projection::Orthographic => Some(self.height()),
        };
        let ir::Camera {
            eye: _,
            center: _,
            right: _,
            up: _,
            size,
            lens,
            projection,
        } = self.ir;
        (moved.ir.size, moved.ir.lens, moved.ir.projection) = (size, lens, projection);
        if let PixelSteps::Up(up) = self.steps {
            moved.steps = PixelSteps::Up(up);
        }
        moved
    }

    /// The position of the eye.
    #[must_use]
    pub fn position(&self) -> [f64; 3] {
        self.ir.eye
    }

    /// The point in the middle of the picture.
    #[must_use]
    pub fn target(&self) -> [f64; 3] {
        self.ir.center
    }

    /// Width and height of the picture in pixels.
    #[must_use]
    pub fn pixels(&self) -> [u32; 2] {
        self.ir.size
    }

    /// The vertical field of view in degrees; `None` if rays are parallel.
    #[must_use]
    pub fn field_of_view(&self) -> Option<f64> {
        let of_steps = || self.ir.yfov().map(f64::to_degrees);
        match self.ir.projection {
            Projection::Perspective => self.extent.or_else(of_steps),
            Projection::Orthographic => None,
        }
    }

    /// The height of the picture in scene units.
    fn height(&self) -> f64 {
        let [_, rows] = self.ir.size;
        let of_steps = || length(Vec3::from_array(self.ir.up)) * f64::from(rows);
        self.extent.unwrap_or_else(of_steps)
    }

    pub(super) fn of(camera: &ir::Camera) -> Self {
        Self {
            ir: camera.clone(),
            steps: PixelSteps::Given,
            extent: None,
        }
    }

    /// The camera of the IR.
    ///
    /// # Errors
    /// The error in the view or the field of view.
    pub(super) fn lower(&self) -> Result<ir::Camera, Box<Diagnostic>> {
        let mut camera = self.ir.clone();
        let is_flat = camera.projection == Projection::Orthographic;
        let rows = f64::from(camera.size[1].max(1));
        if let (PixelSteps::Default | PixelSteps::Up(_), size) = (self.steps, self.extent) {
            let pixel = size.filter(|_| is_flat).map_or(1.0, |height| height / rows);
            let (right, up) = self.basis(pixel).map_err(basis_fault)?;
            (camera.right, camera.up) = (right.to_array(), up.to_array());
        } else if let Some(height) = self.extent.filter(|_| is_flat) {
            let ratio = height / rows / length(Vec3::from_array(camera.up));
            let scaled = |step: [f64; 3]| step.map(|component| component * ratio);
            (camera.right, camera.up) = (scaled(camera.right), scaled(camera.up));
        }
        if let Some(fov) = self.extent.filter(|_| !is_flat) {
            if !(fov > 0.0 && fov < 180.0) {
                let message = format!(
                    "`fov` must be above 0 and below 180, not `{}`",
                    shortest(fov)
                );
                let fault = Diagnostic::new(&codes::OUT_OF_RANGE, message).pointer("/camera/fov");
                return Err(Box::new(fault));
            }
            camera.open(fov.to_radians());
        }
        Ok(camera)
    }

    /// The steps between pixels of this size.
    fn basis(&self, pixel: f64) -> Result<(Vec3, Vec3), CameraBasisError> {
        let [eye, center] = [self.ir.eye, self.ir.center].map(Vec3::from_array);
        let upward = |up: Vec3| unit(up).unwrap_or(Vec3::ZERO) * pixel;
        match self.steps {
            PixelSteps::Up(up) => camera_basis(eye, center, upward(Vec3::from_array(up))),
            PixelSteps::Default | PixelSteps::Given => {
                match camera_basis(eye, center, upward(Vec3::Y)) {
                    Err(CameraBasisError::Parallel) => {
                        camera_basis(eye, center, upward(fallback_up(center - eye, Vec3::Y)))
                    }
                    basis => basis,
                }
            }
        }
    }
}

/// A valid camera for a scene whose camera is not.
pub(super) fn placeholder() -> ir::Camera {
    ir::Camera {
        size: [400, 400],
        ..ir::Camera::default()
    }
}

fn basis_fault(fault: CameraBasisError) -> Box<Diagnostic> {
    let (code, pointer, message) = match fault {
        CameraBasisError::ZeroGaze => (
            &codes::EYE_IS_CENTER,
            "/camera/center",
            "the camera looks at the point where it stands",
        ),
        CameraBasisError::ZeroUp => (&codes::ZERO_UP, "/camera/up", "`up` has no length"),
        CameraBasisError::Parallel => (
            &codes::UP_PARALLEL,
            "/camera/up",
            "`up` points along the view",
        ),
    };
    Box::new(Diagnostic::new(code, message).pointer(pointer))
}
