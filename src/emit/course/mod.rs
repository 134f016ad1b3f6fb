//! The IR back to the YAML of the course: the canonical spelling, with a `Camera`, and every number
//! the shortest that reads back.

mod camera;
mod light;
mod material;
mod shape;

use crate::ir::{
    Gooch, Light, MaterialId, Mode, PathSettings, Pattern, Projection, Scene, Settings, Surface,
};
use crate::math::shortest;
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
        materials: _,
        surfaces: _,
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
    text.lights(lights)?;
    text.objects(scene)?;
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
        self.line(indent, &format!("{key}: {}", shortest(value)));
    }

    fn numbers(&mut self, key: &str, value: &[f64; 3], indent: usize) {
        self.finite &= value.iter().all(|value| value.is_finite());
        self.line(indent, &format!("{key}: {}", triple(*value)));
    }

    fn lights(&mut self, lights: &[Light]) -> Result<(), String> {
        if lights.is_empty() {
            self.line(0, "Lights: []");
        } else {
            self.line(0, "Lights:");
        }
        lights.iter().try_for_each(|light| self.light(light))
    }

    fn objects(&mut self, scene: &Scene) -> Result<(), String> {
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
        let mut written = vec![false; uses.len()];
        for Surface {
            shape,
            material: MaterialId(id),
            casts_no_shadow,
        } in &scene.surfaces
        {
            self.shape(shape, scene)?;
            let at = *id as usize;
            let material = &scene.materials[at];
            match (uses[at] > 1, std::mem::replace(&mut written[at], true)) {
                (true, true) => self.line(4, &format!("material: *m{id}")),
                (true, false) => self.material(&format!("material: &m{id}"), material, scene)?,
                (false, _) => self.material("material:", material, scene)?,
            }
            if *casts_no_shadow {
                self.line(4, "shadow: false");
            }
        }
        Ok(())
    }

    fn settings(&mut self, settings: &Settings, lights: &[Light]) -> Result<(), String> {
        let Settings {
            mode,
            shadows,
            max_depth,
            supersampling,
            pattern,
            light_samples,
            toon,
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
        self.line(0, &format!("Shadows: {shadows}"));
        self.line(0, &format!("MaxRecursionDepth: {max_depth}"));
        self.line(0, "SuperSampling:");
        self.line(2, &format!("factor: {}", factor(mode, *supersampling)?));
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
fn triple([x, y, z]: [f64; 3]) -> String {
    format!("[{}, {}, {}]", shortest(x), shortest(y), shortest(z))
}
