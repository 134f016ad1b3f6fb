//! The IR back to text: the canonical spelling, with a `Camera`, and every number the shortest that
//! reads back.

mod camera;
mod light;
mod material;
mod shape;

use super::settings::PATTERNS;
use crate::ir::{
    Gooch, Light, MaterialId, Mode, PathSettings, Pattern, Projection, Scene, Settings, Surface,
};
use std::fmt::Write as _;

/// Writes the scene in the canonical spelling with a `Camera`.
///
/// Lowering the text gives the scene again, to the last bit, without materials that no surface has;
/// a material that several surfaces share becomes an anchor with aliases, images and meshes are
/// written as the names of their files.
///
/// # Errors
/// The reason, in words, why the scene can't be said in this format.
pub fn emit(scene: &Scene) -> Result<String, String> {
    let Scene {
        camera,
        settings,
        lights,
        images,
        textures: _,
        meshes: _,
        materials,
        surfaces,
        names: _,
        environment,
    } = scene;
    if camera.projection == Projection::Orthographic {
        return Err("the scene has an orthographic camera, which this format has not".to_owned());
    }
    let mut text = Text::default();
    text.camera(camera);
    text.settings(settings, lights)?;
    if let Some(environment) = environment {
        text.environment(environment, images)?;
    }
    text.line(
        0,
        if lights.is_empty() {
            "Lights: []"
        } else {
            "Lights:"
        },
    );
    for light in lights {
        text.light(light)?;
    }
    text.line(
        0,
        if surfaces.is_empty() {
            "Objects: []"
        } else {
            "Objects:"
        },
    );
    let mut uses = vec![0_usize; materials.len()];
    for Surface {
        material: MaterialId(id),
        ..
    } in surfaces
    {
        *uses
            .get_mut(*id as usize)
            .ok_or("a surface refers to a material that does not exist")? += 1;
    }
    let mut written = vec![false; materials.len()];
    for Surface {
        shape,
        material: MaterialId(id),
    } in surfaces
    {
        text.shape(shape, scene)?;
        let at = *id as usize;
        match (uses[at] > 1, std::mem::replace(&mut written[at], true)) {
            (true, true) => text.line(4, &format!("material: *m{id}")),
            (true, false) => text.material(&format!("material: &m{id}"), &materials[at], scene)?,
            (false, _) => text.material("material:", &materials[at], scene)?,
        }
    }
    if text.finite {
        Ok(text.text)
    } else {
        Err("a number of the scene is not finite".to_owned())
    }
}

/// The text so far.
struct Text {
    text: String,
    /// Whether all numbers so far were.
    finite: bool,
}

impl Default for Text {
    fn default() -> Self {
        Self {
            text: String::new(),
            finite: true,
        }
    }
}

impl Text {
    fn line(&mut self, indent: usize, content: &str) {
        writeln!(self.text, "{:indent$}{content}", "")
            .expect("a string takes all that is written to it");
    }

    fn number(&mut self, key: &str, value: f64, indent: usize) {
        self.finite &= value.is_finite();
        self.line(indent, &format!("{key}: {}", number(value)));
    }

    fn numbers(&mut self, key: &str, value: &[f64; 3], indent: usize) {
        self.finite &= value.iter().all(|value| value.is_finite());
        self.line(indent, &format!("{key}: {}", triple(*value)));
    }

    fn settings(&mut self, settings: &Settings, lights: &[Light]) -> Result<(), String> {
        let Settings {
            mode,
            shadows,
            max_depth,
            supersampling,
            pattern,
            light_samples,
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
        self.line(0, &format!("Shadows: {shadows}"));
        self.line(0, &format!("MaxRecursionDepth: {max_depth}"));
        self.line(0, "SuperSampling:");
        self.line(2, &format!("factor: {}", factor(mode, *supersampling)?));
        if let Some((word, _)) = PATTERNS
            .iter()
            .find(|(_, known)| known == pattern && *pattern != Pattern::Grid)
        {
            self.line(2, &format!("pattern: {word}"));
        }
        if *light_samples != 1
            || lights
                .iter()
                .filter_map(Light::point)
                .any(|light| light.radius > 0.0)
        {
            self.line(0, &format!("LightSamples: {light_samples}"));
        }
        Ok(())
    }
}

/// The rays along the side of a pixel, that of paths too.
fn factor(mode: &Mode, supersampling: u32) -> Result<u32, String> {
    let Mode::Path(PathSettings {
        samples,
        multiple_scattering,
    }) = mode
    else {
        return Ok(supersampling);
    };
    let side = samples.isqrt();
    if !multiple_scattering || supersampling != 1 || side * side != *samples {
        return Err(
            "paths are so many a pixel, or so followed, as this format can't say".to_owned(),
        );
    }
    Ok(side)
}

/// Three numbers as a flow list.
pub(in crate::front::course) fn triple([x, y, z]: [f64; 3]) -> String {
    format!("[{}, {}, {}]", number(x), number(y), number(z))
}

/// The shortest text that reads back as the same number.
fn number(value: f64) -> String {
    let (plain, scientific) = (format!("{value}"), format!("{value:e}"));
    // People read 0.0001 and 100000 better than the few characters less.
    if plain.len() <= scientific.len() + 4 {
        plain
    } else {
        scientific
    }
}
