//! The IR back to the YAML of the course: the canonical spelling, with a `Camera`, and every number
//! the shortest that reads back.

mod camera;
mod files;
mod light;
mod material;
mod shape;
mod standard;

pub use files::Attachment;

use files::FileNames;
use rtc_ir::{
    Ambient, Display, Gooch, Light, MaterialId, Mode, PathSettings, Pattern, Scene, Settings,
    Shape, Surface,
};
use rtc_math::shortest;
use std::fmt::Write as _;

/// A text, and the files beside it that it names.
#[derive(Debug)]
pub struct WrittenScene<'s> {
    /// The scene.
    pub text: String,
    /// The files.
    pub files: Vec<Attachment<'s>>,
}

/// Writes the scene in the canonical spelling with a `Camera`.
///
/// Lowering the text gives the scene again, to the last bit, without materials that no surface has;
/// a material that several surfaces share becomes an anchor with aliases, images and meshes are
/// written as the names of their files.
///
/// # Errors
/// The reason, in words, why the scene can't be said in this format.
pub fn emit(scene: &Scene) -> Result<String, String> {
    write(scene, FileNames::known()).map(|document| document.text)
}

/// The same for a scene whose images and meshes need not be files: those of a scene that holds
/// materials of glTF, and images without a name, become files in `folder`, which is named as the text
/// is to name it. Lowering the text gives the scene again but for the names and the order of images,
/// textures and meshes, and for those that no surface shows.
///
/// # Errors
/// As [`emit`]; without a folder also if files would be needed.
pub fn emit_beside<'s>(scene: &'s Scene, folder: Option<&str>) -> Result<WrittenScene<'s>, String> {
    write(scene, FileNames::beside(scene, folder))
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
        display,
    } = scene;
    let mut text = Text {
        text: String::new(),
        finite: true,
        names,
    };
    text.camera(camera);
    text.settings(settings, lights);
    text.display(display);
    if let Some(environment) = environment {
        text.environment(environment, scene)?;
    }
    text.lights(lights)?;
    text.objects(scene)?;
    if !text.finite {
        return Err("a number of the scene is not finite".to_owned());
    }
    Ok(WrittenScene {
        text: text.text,
        files: text.names.into_files(),
    })
}

/// The text so far.
struct Text<'s> {
    text: String,
    /// Whether all numbers so far were.
    finite: bool,
    names: FileNames<'s>,
}

impl<'s> Text<'s> {
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
        let shown = numbers.into_iter().map(|number| {
            self.finite &= number.is_finite();
            shortest(number)
        });
        format!("[{}]", shown.collect::<Vec<_>>().join(", "))
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

    fn lights(&mut self, lights: &[Light]) -> Result<(), String> {
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
        let mut uses = vec![0_usize; scene.materials.len()];
        for surface in &scene.surfaces {
            *uses
                .get_mut(surface.material.0 as usize)
                .ok_or("a surface refers to a material that does not exist")? += 1;
        }
        // The number of each material in the order of first use: unused materials take none.
        let mut numbers: Vec<Option<usize>> = vec![None; uses.len()];
        let mut next = 0;
        for (index, surface) in scene.surfaces.iter().enumerate() {
            let Surface {
                shape,
                material: MaterialId(id),
                casts_no_shadow,
            } = surface;
            self.shape(shape, scene)?;
            let name = scene.names.get(index).filter(|name| !name.is_empty());
            match (name, shape) {
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
            let at = *id as usize;
            let material = &scene.materials[at];
            match numbers[at] {
                Some(number) => self.line(4, &format!("material: *m{number}")),
                None if uses[at] > 1 => {
                    self.material(&format!("material: &m{next}"), material, scene)?
                }
                None => self.material("material:", material, scene)?,
            }
            if numbers[at].is_none() {
                numbers[at] = Some(next);
                next += 1;
            }
            if *casts_no_shadow {
                self.line(4, "shadow: false");
            }
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
            toon,
            ambient,
        } = settings;
        match mode {
            Mode::Phong => self.line(0, "RenderMode: phong"),
            Mode::Zbuffer => self.line(0, "RenderMode: zbuffer"),
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
        if *toon {
            self.line(0, "Toon: true");
        }
        match ambient {
            Ambient::Once => self.line(0, "Ambient: once"),
            // Who makes JSON of it would change its meaning.
            Ambient::PerLight if *mode == Mode::Phong => self.line(0, "Ambient: perLight"),
            Ambient::PerLight => {}
        }
        self.line(0, &format!("Shadows: {shadows}"));
        self.line(0, &format!("MaxRecursionDepth: {max_depth}"));
        let factor = self.paths(mode, *supersampling);
        self.line(0, "SuperSampling:");
        self.line(2, &format!("factor: {factor}"));
        match pattern {
            Pattern::Grid => {}
            Pattern::Jitter => self.line(2, "pattern: jitter"),
            Pattern::Random => self.line(2, "pattern: random"),
        }
        if *light_samples != 1
            || lights
                .iter()
                .filter_map(Light::point)
                .any(|light| light.radius > 0.0)
        {
            self.line(0, &format!("LightSamples: {light_samples}"));
        }
    }

    /// Says how paths are followed, where their number a pixel is not that of `SuperSampling`; returns
    /// what that is to be.
    fn paths(&mut self, mode: &Mode, supersampling: u32) -> u32 {
        let Mode::Path(PathSettings {
            samples,
            multiple_scattering,
        }) = mode
        else {
            return supersampling;
        };
        let side = samples.isqrt();
        if *multiple_scattering && supersampling == 1 && side * side == *samples {
            return side;
        }
        self.line(0, "PathParameters:");
        self.line(2, &format!("samples: {samples}"));
        self.line(2, &format!("multipleScattering: {multiple_scattering}"));
        supersampling
    }
}

/// A text in quotes, in which YAML and JSON agree.
fn quoted(text: &str) -> String {
    serde_json::Value::from(text).to_string()
}

/// Three numbers as a flow list.
fn triple([x, y, z]: [f64; 3]) -> String {
    format!("[{}, {}, {}]", shortest(x), shortest(y), shortest(z))
}
