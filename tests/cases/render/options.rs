//! What a case says of itself: what it shows, and how it is rendered, in the words of `rtc render`:
//! `# options: spp=16 tonemap=agx aov=depth:2..8 env=files/sky.hdr threads=2`. It stands in the
//! first comments of a YAML or pbrt file, in the `shows` and `options` of `asset.extras` in a
//! `.gltf`, and as comments of `<case>.options` beside any other file.

use libtest_mimic::Failed;
use rtc::internals::color::Tone;
use rtc::internals::image::BackgroundFill;
use rtc::internals::passes::{IntegratorChoice, Overrides, SunLight, View};
use rtc::internals::plan::Arithmetic;
use rtc::internals::render::Aov;
use std::fs;
use std::path::Path;

/// How a case is rendered.
pub(super) struct Options {
    pub(super) threads: usize,
    pub(super) overrides: Overrides,
    pub(super) tone: Option<Tone>,
    pub(super) stops: f64,
    pub(super) background: BackgroundFill,
    /// The layer shown, and the values that are black and white in it.
    pub(super) aov: Option<(Aov, [f64; 2])>,
    pub(super) arithmetic: Arithmetic,
    pub(super) denoise: bool,
    pub(super) integrator: Option<IntegratorChoice>,
    pub(super) view: View,
    pub(super) suns: Vec<SunLight>,
    pub(super) env_color: Option<[f64; 3]>,
    /// A file beside the case.
    pub(super) env: Option<String>,
    pub(super) front: rtc::internals::front::FrontOptions,
    /// The codes of all that is found in it.
    pub(super) finds: Vec<String>,
}

/// Several threads, so that each picture shows as well that their number does not matter.
const THREADS: usize = 3;

impl Options {
    pub(super) fn read(case: &Path) -> Result<Self, Failed> {
        let mut options = Self {
            threads: THREADS,
            overrides: Overrides::default(),
            tone: None,
            stops: 0.0,
            background: BackgroundFill::Film,
            aov: None,
            arithmetic: Arithmetic::default(),
            denoise: false,
            integrator: None,
            view: View::default(),
            suns: Vec::new(),
            env_color: None,
            env: None,
            front: rtc::internals::front::FrontOptions::default(),
            finds: Vec::new(),
        };
        for word in said(case)?.split_whitespace() {
            options
                .set(word)
                .ok_or_else(|| format!("an option that is none: `{word}`"))?;
        }
        Ok(options)
    }

    fn set(&mut self, word: &str) -> Option<()> {
        let (key, value) = word.split_once('=')?;
        match key {
            "threads" => self.threads = value.parse().ok()?,
            "size" => self.overrides.size = Some(size(value)?),
            "spp" => self.overrides.spp = Some(value.parse().ok()?),
            "depth" => self.overrides.depth = Some(value.parse().ok()?),
            "tonemap" => self.tone = Some(tone(value)?),
            "exposure" => self.stops = value.parse().ok()?,
            "background" => self.background = background(value)?,
            "aov" => self.aov = Some(aov(value)?),
            "denoise" => self.denoise = value.parse().ok()?,
            "arithmetic" => self.arithmetic = arithmetic(value)?,
            "integrator" => self.integrator = Some(integrator(value)?),
            "eye" => self.view.eye = Some(numbers(value)?),
            "center" => self.view.center = Some(numbers(value)?),
            "yfov" => self.view.yfov = Some(value.parse::<f64>().ok()?.to_radians()),
            "sun" => self.suns.push(sun(value)?),
            "env-color" => self.env_color = Some(numbers(value)?),
            "env" => self.env = Some(value.to_owned()),
            "time" => self.front.time = Some(value.parse().ok()?),
            "animation" => self.front.animation = Some(value.to_owned()),
            "variant" => self.front.variant = Some(value.to_owned()),
            "camera" => self.front.camera = Some(value.to_owned()),
            "lenient" => self.front.lenient = value.parse().ok()?,
            "finds" => self.finds = value.split(',').map(str::to_owned).collect(),
            _ => return None,
        }
        Some(())
    }
}

/// The options of a case, which must say what it shows.
fn said(case: &Path) -> Result<String, Failed> {
    let kind = case.extension().unwrap_or_default();
    let (shows, options) = if kind == "gltf" {
        let asset: serde_json::Value = serde_json::from_slice(&fs::read(case)?)?;
        let extras = &asset["asset"]["extras"];
        let word = |key: &str| extras[key].as_str().unwrap_or_default().to_owned();
        (word("shows"), word("options"))
    } else {
        let path = if kind == "yaml" || kind == "pbrt" {
            case.to_owned()
        } else {
            case.with_extension("options")
        };
        let text = fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))?;
        let comments = || text.lines().map_while(|line| line.strip_prefix("# "));
        let options = comments().find_map(|line| line.strip_prefix("options: "));
        let shows = comments().next().unwrap_or_default();
        (shows.to_owned(), options.unwrap_or_default().to_owned())
    };
    if shows.is_empty() || shows.starts_with("options") {
        return Err("it must open with a comment that says what it shows".into());
    }
    Ok(options)
}

fn numbers<const N: usize>(text: &str) -> Option<[f64; N]> {
    let numbers: Option<Vec<f64>> = text.split(',').map(|part| part.parse().ok()).collect();
    numbers?.try_into().ok()
}

fn size(text: &str) -> Option<[u32; 2]> {
    let (width, height) = text.split_once('x')?;
    Some([width.parse().ok()?, height.parse().ok()?])
}

fn sun(text: &str) -> Option<SunLight> {
    let [x, y, z, irradiance] = numbers(text)?;
    let irradiance = [irradiance; 3];
    Some(SunLight {
        direction: [x, y, z],
        irradiance,
    })
}

fn tone(text: &str) -> Option<Tone> {
    Some(match text {
        "none" => Tone::None,
        "srgb" => Tone::Srgb,
        "agx" => Tone::Agx,
        "pbr-neutral" => Tone::PbrNeutral,
        _ => return None,
    })
}

fn background(text: &str) -> Option<BackgroundFill> {
    if text == "transparent" {
        return Some(BackgroundFill::Transparent);
    }
    numbers(text).map(BackgroundFill::Color)
}

fn arithmetic(text: &str) -> Option<Arithmetic> {
    Some(match text {
        "robust" => Arithmetic::Robust,
        "plain" => Arithmetic::Plain,
        "f32" => Arithmetic::F32,
        _ => return None,
    })
}

fn integrator(text: &str) -> Option<IntegratorChoice> {
    Some(match text {
        "whitted" => IntegratorChoice::Whitted,
        "path" => IntegratorChoice::Path,
        _ => return None,
    })
}

/// A layer, and the range of its values that is shown: `depth:2..8`.
fn aov(text: &str) -> Option<(Aov, [f64; 2])> {
    let (name, range) = text.split_once(':').unwrap_or((text, ""));
    let (aov, usual) = match name {
        "albedo" => (Aov::Albedo, [0.0, 1.0]),
        "normal" => (Aov::Normal, [-1.0, 1.0]),
        "depth" => (Aov::Depth, [0.0, 10.0]),
        "uv" => (Aov::Uv, [0.0, 1.0]),
        "instance" => (Aov::Instance, [0.0, 8.0]),
        "position" => (Aov::Position, [-1.0, 1.0]),
        _ => return None,
    };
    if range.is_empty() {
        return Some((aov, usual));
    }
    let (low, high) = range.split_once("..")?;
    Some((aov, [low.parse().ok()?, high.parse().ok()?]))
}
