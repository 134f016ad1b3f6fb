//! Writes the IR as YAML of the course, in canonical spelling, with a `Camera`, and with the
//! shortest decimal of each number that reads back exactly.
//!
//! [`emit`] refers to the original files of images and meshes, [`emit_with_files`] also writes new
//! ones, [`emit_elsewhere`] writes all anew. `files` names them. Lowering the text gives the same
//! scene.

mod camera;
mod csg;
mod files;
mod light;
mod material;
mod shape;
mod standard;

pub use files::SidecarFile;

use crate::export::parts_of_one;
use files::FileNames;
use rtc_ir::{
    Ambient, Display, Gooch, Light, Mode, PathSettings, Pattern, Scene, Settings, Shape,
    StereoView, Surface,
};
use rtc_math::{PixelFilter, shortest};
use serde_json::Value as Json;
use std::fmt::Write as _;

/// A text and its sidecar files.
#[derive(Debug)]
pub struct WrittenScene<'s> {
    /// The scene.
    pub text: String,
    /// The sidecar files.
    pub files: Vec<SidecarFile<'s>>,
}

/// Writes the scene in canonical spelling with a `Camera`.
///
/// Lowering the text gives the same scene, bit for bit, except materials without a surface. A
/// material of several surfaces becomes an anchor with aliases; images and meshes are written as
/// file names.
///
/// # Errors
/// A message, if the format can't express the scene.
pub fn emit(scene: &Scene) -> Result<String, String> {
    write(scene, FileNames::original()).map(|document| document.text)
}

/// The same for a scene whose images and meshes may have no files: those of a scene with glTF
/// materials, and images without a name, become files in `folder`, a path relative to the text.
/// Lowering the text gives the same scene, except names and order of images, textures and meshes,
/// and those without a surface.
///
/// # Errors
/// As [`emit`]; also if a file is needed and `folder` is `None`.
pub fn emit_with_files<'s>(
    scene: &'s Scene,
    folder: Option<&str>,
) -> Result<WrittenScene<'s>, String> {
    write(scene, FileNames::with_new_files(scene, folder))
}

/// The same with files in `folder` for all images and meshes, for a text that does not find those
/// of the scene.
///
/// # Errors
/// As [`emit`].
pub fn emit_elsewhere<'s>(scene: &'s Scene, folder: &str) -> Result<WrittenScene<'s>, String> {
    write(scene, FileNames::all_new(folder))
}

fn write<'s>(scene: &'s Scene, names: FileNames<'s>) -> Result<WrittenScene<'s>, String> {
    let Scene {
        camera,
        settings,
        lights,
        images: _,
        textures: _,
        meshes: _,
        materials: _,
        surfaces: _,
        names: _,
        environment,
        medium,
        display,
        trees: _,
    } = scene;
    // Write the camera, the settings, the lights and the objects.
    let mut text = SceneWriter {
        text: String::new(),
        finite: true,
        names,
    };
    text.camera(camera);
    if settings.stereo != 0.0 {
        text.number("stereo", settings.stereo, 2);
    }
    if settings.stereo_view == StereoView::Anaglyph {
        text.line(2, "stereoView: anaglyph");
    }
    if settings.shutter != Settings::default().shutter {
        let shutter = text.list(settings.shutter);
        text.line(2, &format!("shutter: {shutter}"));
    }
    text.settings(settings, lights);
    text.display(display);
    if let Some(environment) = environment {
        text.environment(environment, scene)?;
    }
    if let Some(medium) = medium {
        let value = text.medium(medium);
        text.line(0, &format!("Medium: {value}"));
    }
    text.lights(lights)?;
    text.objects(scene)?;
    // The format has no way to write NaN or infinity.
    if !text.finite {
        return Err("a number of the scene is not finite".to_owned());
    }
    Ok(WrittenScene {
        text: text.text,
        files: text.names.into_files(),
    })
}

/// The text so far.
struct SceneWriter<'s> {
    text: String,
    /// Whether all numbers so far were finite.
    finite: bool,
    names: FileNames<'s>,
}

impl<'s> SceneWriter<'s> {
    fn line(&mut self, indent: usize, content: &str) {
        writeln!(self.text, "{:indent$}{content}", "")
            .expect("a string takes all that is written to it");
    }

    fn number(&mut self, key: &str, value: f64, indent: usize) {
        self.finite &= value.is_finite();
        self.line(indent, &format!("{key}: {}", shortest(value)));
    }

    fn numbers(&mut self, key: &str, value: &[f64; 3], indent: usize) {
        self.finite &= value.iter().all(|value| value.is_finite());
        self.line(indent, &format!("{key}: {}", triple(*value)));
    }

    /// Numbers as a flow list.
    fn list(&mut self, numbers: impl IntoIterator<Item = f64>) -> String {
        let displayed = numbers.into_iter().map(|number| {
            self.finite &= number.is_finite();
            shortest(number)
        });
        format!("[{}]", displayed.collect::<Vec<_>>().join(", "))
    }

    fn display(&mut self, display: &Display) {
        let Display { exposure, tone } = display;
        if let Some(tone) = tone {
            self.line(0, &format!("ToneMap: {}", tone.name()));
        }
        if *exposure != 0.0 {
            self.number("Exposure", *exposure, 0);
        }
    }

    fn lights(&mut self, lights: &'s [Light]) -> Result<(), String> {
        if lights.is_empty() {
            self.line(0, "Lights: []");
        } else {
            self.line(0, "Lights:");
        }
        lights.iter().try_for_each(|light| self.light(light))
    }

    fn objects(&mut self, scene: &'s Scene) -> Result<(), String> {
        if scene.surfaces.is_empty() {
            self.line(0, "Objects: []");
        } else {
            self.line(0, "Objects:");
        }
        // Surfaces of one solid or mesh become one object.
        let mut materials = MaterialNames::of(scene)?;
        let mut index = 0;
        while let Some(surface) = scene.surfaces.get(index) {
            let parts = &scene.surfaces[index..][..parts_of_one(&scene.surfaces[index..])];
            let name = scene.names.get(index).filter(|name| !name.is_empty());
            index += parts.len();
            // Write the shape.
            if let Shape::Csg(csg) = &surface.shape {
                self.csg(csg, parts, scene, &mut materials)?;
                if name.is_none() {
                    continue;
                }
            } else {
                self.shape(&surface.shape, scene)?;
            }
            // Write the name and the material.
            match (name, &surface.shape) {
                (Some(name), Shape::Instance(_)) => {
                    self.line(4, &format!("label: {}", quoted(name)))
                }
                (Some(name), _) => {
                    return Err(format!(
                        "`{}` has a name, and only meshes have",
                        name.escape_debug()
                    ));
                }
                (None, _) => {}
            }
            self.surface_look(surface, scene, &mut materials)?;
        }
        Ok(())
    }

    /// The material of a surface, an anchor at its first use if it is used again; and its shadow.
    fn surface_look(
        &mut self,
        surface: &Surface,
        scene: &'s Scene,
        materials: &mut MaterialNames,
    ) -> Result<(), String> {
        let at = surface.material.0 as usize;
        let material = &scene.materials[at];
        let MaterialNames {
            uses,
            numbers,
            next,
        } = materials;
        match numbers[at] {
            Some(number) => self.line(4, &format!("material: *m{number}")),
            None if uses[at] > 1 => {
                self.material(&format!("material: &m{next}"), material, scene)?
            }
            None => self.material("material:", material, scene)?,
        }
        if numbers[at].is_none() {
            numbers[at] = Some(*next);
            *next += 1;
        }
        if surface.casts_no_shadow {
            self.line(4, "shadow: false");
        }
        if surface.velocity.get() != [0.0; 3] {
            self.numbers("velocity", &surface.velocity.get(), 4);
        }
        Ok(())
    }

    fn settings(&mut self, settings: &Settings, lights: &[Light]) {
        let Settings {
            mode,
            shadows,
            max_depth,
            supersampling,
            pattern,
            light_samples,
            ambient,
            ..
        } = settings;
        // Render mode.
        match mode {
            Mode::Phong => self.line(0, "RenderMode: phong"),
            Mode::Depth => self.line(0, "RenderMode: zbuffer"),
            Mode::Normal => self.line(0, "RenderMode: normal"),
            Mode::Path(_) => self.line(0, "RenderMode: path"),
            Mode::Gooch(Gooch { b, y, alpha, beta }) => {
                self.line(0, "RenderMode: gooch");
                self.line(0, "GoochParameters:");
                for (key, value) in [("b", b), ("y", y), ("alpha", alpha), ("beta", beta)] {
                    self.number(key, *value, 2);
                }
            }
        }
        // Shadows and recursion.
        self.line(0, &format!("Shadows: {shadows}"));
        self.line(0, &format!("MaxRecursionDepth: {max_depth}"));
        // Sampling.
        let factor = self.paths(mode, *supersampling);
        self.line(0, "SuperSampling:");
        self.line(2, &format!("factor: {factor}"));
        match pattern {
            Pattern::Grid => {}
            Pattern::Jitter => self.line(2, "pattern: jitter"),
            Pattern::Random => self.line(2, "pattern: random"),
        }
        let points = || lights.iter().filter_map(Light::point);
        if *light_samples == 1 && points().any(|light| light.radius > 0.0) {
            self.line(0, "LightSamples: 1");
        }
        // Written explicitly, because a JSON version of the text would have another default.
        if *ambient == Ambient::PerLight && *mode == Mode::Phong {
            self.line(0, "Ambient: perLight");
        }
        self.other_settings(settings);
    }

    /// Writes all other settings that have not their defaults, by their names in the IR.
    fn other_settings(&mut self, settings: &Settings) {
        const WRITTEN: [&str; 8] = [
            "mode",
            "shadows",
            "maxDepth",
            "supersampling",
            "pattern",
            "stereo",
            "stereoView",
            "shutter",
        ];
        let fields = serde_json::to_value(settings);
        let Ok(Json::Object(fields)) = fields else {
            self.finite = false;
            return;
        };
        for (name, value) in fields {
            if !WRITTEN.contains(&name.as_str()) {
                let (first, rest) = name.split_at(1);
                let value = match value {
                    Json::String(word) => word,
                    Json::Array(numbers) => self.list(numbers.iter().filter_map(Json::as_f64)),
                    Json::Null | Json::Bool(_) | Json::Number(_) | Json::Object(_) => {
                        value.to_string()
                    }
                };
                self.line(0, &format!("{}{rest}: {value}", first.to_ascii_uppercase()));
            }
        }
    }

    /// Writes the path tracing parameters, unless `SuperSampling` expresses them; returns the
    /// factor for `SuperSampling`.
    fn paths(&mut self, mode: &Mode, supersampling: u32) -> u32 {
        let Mode::Path(PathSettings {
            samples,
            multiple_scattering,
            caustics,
            filter,
        }) = mode
        else {
            return supersampling;
        };
        let side = samples.isqrt();
        let is_default = *multiple_scattering && !*caustics && filter.is_pixel();
        if is_default && supersampling == 1 && side * side == *samples {
            return side;
        }
        self.line(0, "PathParameters:");
        self.line(2, &format!("samples: {samples}"));
        self.line(2, &format!("multipleScattering: {multiple_scattering}"));
        if *caustics {
            self.line(2, "caustics: true");
        }
        if !filter.is_pixel() {
            self.line(2, &format!("filter: {}", filter_text(filter)));
        }
        supersampling
    }
}

/// A filter of pixels as the format has it.
fn filter_text(filter: &PixelFilter) -> String {
    match filter {
        PixelFilter::Box { radius } => format!("{{box: {{radius: {radius}}}}}"),
        PixelFilter::Tent { radius } => format!("{{tent: {{radius: {radius}}}}}"),
        PixelFilter::Gaussian { deviation, radius } => {
            format!("{{gaussian: {{deviation: {deviation}, radius: {radius}}}}}")
        }
        PixelFilter::Mitchell { b, c, radius } => {
            format!("{{mitchell: {{b: {b}, c: {c}, radius: {radius}}}}}")
        }
        PixelFilter::Lanczos { window, radius } => {
            format!("{{lanczos: {{window: {window}, radius: {radius}}}}}")
        }
    }
}

/// The numbers of materials in the text.
struct MaterialNames {
    /// The number of surfaces, or operands, with each material.
    uses: Vec<usize>,
    /// The number of each in the order of first use.
    numbers: Vec<Option<usize>>,
    next: usize,
}

impl MaterialNames {
    fn of(scene: &Scene) -> Result<Self, String> {
        let mut uses = vec![0_usize; scene.materials.len()];
        for surface in &scene.surfaces {
            let count = if let Shape::Csg(csg) = &surface.shape {
                csg.faces.len()
            } else {
                1
            };
            *uses
                .get_mut(surface.material.0 as usize)
                .ok_or("a surface refers to a material that does not exist")? += count;
        }
        let numbers = vec![None; uses.len()];
        Ok(Self {
            uses,
            numbers,
            next: 0,
        })
    }
}

/// A quoted string that is valid in YAML and JSON.
fn quoted(text: &str) -> String {
    serde_json::Value::from(text).to_string()
}

/// Three numbers as a flow list.
fn triple([x, y, z]: [f64; 3]) -> String {
    format!("[{}, {}, {}]", shortest(x), shortest(y), shortest(z))
}
