//! The IR back to text: the canonical spelling, with a `Camera`, and every number the shortest that reads back.

use crate::ir::{Camera, Gooch, Lens, Light, Material, MaterialId, Mode, Phong, Plane, PointLight};
use crate::ir::{Scene, Settings, Shape, Sphere, Surface, Triangle};
use crate::math::{Vec3, camera_basis};
use std::fmt::Write as _;

/// Writes the scene in the canonical spelling with a `Camera`.
///
/// Lowering the text gives the scene again, without materials that no surface has; a material that several surfaces
/// share becomes an anchor with aliases. The camera comes back to the last bit if an axis was its `up`, else at least
/// up to rounding.
///
/// # Errors
/// The reason, in words, why the scene can't be said in this format.
pub fn emit(scene: &Scene) -> Result<String, String> {
    let Scene { camera, settings, lights, materials, surfaces } = scene;
    let mut text = Text::default();
    text.camera(camera, camera_up(camera)?);
    text.settings(settings);
    text.line(0, if lights.is_empty() { "Lights: []" } else { "Lights:" });
    for Light::Point(PointLight { position, color }) in lights {
        text.numbers("- position", position, 2);
        text.numbers("color", color, 4);
    }
    text.line(0, if surfaces.is_empty() { "Objects: []" } else { "Objects:" });
    let mut uses = vec![0_usize; materials.len()];
    for Surface { material: MaterialId(id), .. } in surfaces {
        *uses.get_mut(*id as usize).ok_or("a surface refers to a material that does not exist")? += 1;
    }
    let mut written = vec![false; materials.len()];
    for Surface { shape, material: MaterialId(id) } in surfaces {
        text.shape(shape);
        let at = *id as usize;
        match (uses[at] > 1, std::mem::replace(&mut written[at], true)) {
            (true, true) => text.line(4, &format!("material: *m{id}")),
            (true, false) => text.material(&format!("material: &m{id}"), &materials[at]),
            (false, _) => text.material("material:", &materials[at]),
        }
    }
    if text.finite { Ok(text.text) } else { Err("a number of the scene is not finite".to_owned()) }
}

/// The text so far.
struct Text {
    text: String,
    /// Whether all numbers so far were.
    finite: bool,
}

impl Default for Text {
    fn default() -> Self {
        Self { text: String::new(), finite: true }
    }
}

impl Text {
    fn line(&mut self, indent: usize, content: &str) {
        writeln!(self.text, "{:indent$}{content}", "").expect("a string takes all that is written to it");
    }

    fn number(&mut self, key: &str, value: f64, indent: usize) {
        self.finite &= value.is_finite();
        self.line(indent, &format!("{key}: {}", number(value)));
    }

    fn numbers(&mut self, key: &str, value: &[f64; 3], indent: usize) {
        self.finite &= value.iter().all(|value| value.is_finite());
        self.line(indent, &format!("{key}: {}", triple(*value)));
    }

    fn camera(&mut self, camera: &Camera, up: Vec3) {
        let Camera { eye, center, right: _, up: _, size: [width, height], lens: Lens { radius, samples } } = camera;
        self.line(0, "Camera:");
        self.numbers("eye", eye, 2);
        self.numbers("center", center, 2);
        self.numbers("up", &up.to_array(), 2);
        self.line(2, &format!("viewSize: [{width}, {height}]"));
        if *radius != 0.0 || *samples != 1 {
            self.number("apertureRadius", *radius, 2);
            self.line(2, &format!("apertureSamples: {samples}"));
        }
    }

    fn settings(&mut self, settings: &Settings) {
        let Settings { mode, shadows, max_depth, supersampling } = settings;
        match mode {
            Mode::Phong => self.line(0, "RenderMode: phong"),
            Mode::Zbuffer => self.line(0, "RenderMode: zbuffer"),
            Mode::Normal => self.line(0, "RenderMode: normal"),
            Mode::Gooch(Gooch { b, y, alpha, beta }) => {
                self.line(0, "RenderMode: gooch");
                self.line(0, "GoochParameters:");
                for (key, value) in [("b", b), ("y", y), ("alpha", alpha), ("beta", beta)] {
                    self.number(key, *value, 2);
                }
            }
        }
        self.line(0, &format!("Shadows: {shadows}"));
        self.line(0, &format!("MaxRecursionDepth: {max_depth}"));
        self.line(0, "SuperSampling:");
        self.line(2, &format!("factor: {supersampling}"));
    }

    fn shape(&mut self, shape: &Shape) {
        match shape {
            Shape::Sphere(Sphere { center, radius }) => {
                self.line(2, "- type: sphere");
                self.numbers("position", center, 4);
                self.number("radius", *radius, 4);
            }
            Shape::Plane(Plane { center, normal }) => {
                self.line(2, "- type: plane");
                self.numbers("position", center, 4);
                self.numbers("normal", normal, 4);
            }
            Shape::Triangle(Triangle { vertices }) => {
                self.line(2, "- type: triangle");
                for (key, vertex) in ["v0", "v1", "v2"].into_iter().zip(vertices) {
                    self.numbers(key, vertex, 4);
                }
            }
        }
    }

    fn material(&mut self, key: &str, material: &Material) {
        let Material::Phong(Phong { color, ka, kd, ks, n, kt, eta, glossy_samples }) = material;
        self.line(4, key);
        self.numbers("color", color, 6);
        for (key, value) in [("ka", ka), ("kd", kd), ("ks", ks), ("n", n)] {
            self.number(key, *value, 6);
        }
        if *kt != 0.0 || *eta != 1.0 {
            self.number("kt", *kt, 6);
            self.number("eta", *eta, 6);
        }
        if *glossy_samples != 1 {
            self.line(6, &format!("glossySamples: {glossy_samples}"));
        }
    }
}

/// Three numbers as a flow list.
pub(super) fn triple([x, y, z]: [f64; 3]) -> String {
    format!("[{}, {}, {}]", number(x), number(y), number(z))
}

/// The shortest text that reads back as the same number.
fn number(value: f64) -> String {
    let (plain, scientific) = (format!("{value}"), format!("{value:e}"));
    // People read 0.0001 and 100000 better than the few characters less.
    if plain.len() <= scientific.len() + 4 { plain } else { scientific }
}

/// How far frames may be from right angles and equal lengths to be those of a `Camera`.
const TOLERANCE: f64 = 1e-9;

/// An `up` that gives exactly the frame of the camera if there is one, else one that gives it up to rounding.
fn camera_up(camera: &Camera) -> Result<Vec3, String> {
    let [eye, center, right, up] = [camera.eye, camera.center, camera.right, camera.up].map(Vec3::from_array);
    let gaze = (center - eye).try_normalize().ok_or("the eye of the camera lies in the middle of its image")?;
    let pixel = up.length();
    let along_gaze = |side: Vec3| (side.dot(gaze) / pixel).abs() > TOLERANCE;
    if along_gaze(right) || along_gaze(up) {
        return Err(
            "the camera looks at its image at a slant, as an old `Eye` off the middle does; a `Camera` looks at \
                    it squarely"
                .to_owned(),
        );
    }
    if ((right.length() - pixel) / pixel).abs() > TOLERANCE || (right.dot(up) / (pixel * pixel)).abs() > TOLERANCE {
        return Err("the pixels of the camera are not square, and those of a `Camera` are".to_owned());
    }
    if right.cross(up).dot(gaze) > 0.0 {
        return Err("the image of the camera is mirrored, and that of a `Camera` is not".to_owned());
    }
    let exact = |candidate: &Vec3| camera_basis(eye, center, *candidate) == Ok((right, up));
    Ok(axes(pixel).chain(tilted(up, gaze * pixel)).find(exact).unwrap_or(up))
}

/// The axes with the length of a pixel, rounded as a person would have written it.
fn axes(pixel: f64) -> impl Iterator<Item = Vec3> {
    let rounded = move |digits: usize| format!("{pixel:.digits$e}").parse().unwrap_or(pixel);
    let lengths = move || [rounded(3), rounded(8), rounded(14), pixel];
    let axes = [Vec3::Y, Vec3::Z, Vec3::X, Vec3::NEG_Y, Vec3::NEG_Z, Vec3::NEG_X];
    axes.into_iter().flat_map(move |axis| lengths().map(|length| axis * length))
}

/// `up` tilted along the gaze: all give the same frame, each with its own rounding.
fn tilted(up: Vec3, gaze: Vec3) -> impl Iterator<Item = Vec3> {
    const TRIES: u32 = 1 << 14;
    (0..TRIES).map(move |step| {
        let t = f64::from(step) / f64::from(TRIES);
        (up * (1.0 - t * t) + gaze * (2.0 * t)) / (1.0 + t * t)
    })
}
