//! Participating media of shapes and of the sensor.
//!
//! Homogeneous media are exact. A heterogeneous medium whose volumes are constant is homogeneous;
//! the mean replaces a grid and a constant other volumes, with a warning.

use super::Lowering;
use super::plugins::{MEDIA, PHASES};
use super::xml::PluginNode;
use rtc_diag::{Diagnostic, clip, codes};
use rtc_ir::Medium;
use rtc_source::{FileKind, Span};

/// A grid of Mitsuba: `VOL`, the version 3, five integers (the type of 32-bit floats, three sizes,
/// the channels), six floats of a box, and the values.
const GRID: FileKind = FileKind {
    extensions: &["vol"],
    begins: |head| head.starts_with(b"VOL\x03"),
};

/// The mean of each channel of a grid.
fn mean_of_grid(bytes: &[u8]) -> Option<[f64; 3]> {
    const HEAD: usize = 48;
    let word = |at: usize| <[u8; 4]>::try_from(bytes.get(at..at + 4)?).ok();
    let integer = |index: usize| word(4 + 4 * index).map(u32::from_le_bytes);
    let (kind, channels) = (integer(0)?, integer(4)? as usize);
    let values = bytes.get(HEAD..)?.chunks_exact(4);
    if kind != 1 || !matches!(channels, 1 | 3) || values.len() < channels {
        return None;
    }
    let cells = values.len() / channels;
    let mut sums = [0.0; 3];
    for (index, value) in values.take(cells * channels).enumerate() {
        let value = <[u8; 4]>::try_from(value).ok().map(f32::from_le_bytes)?;
        sums[index % channels] += f64::from(value).max(0.0);
    }
    let means = sums.map(|sum| sum / cells as f64);
    Some(match channels {
        1 => [means[0]; 3],
        _ => means,
    })
}

/// The media of a shape that were found, with the spans of their elements.
#[derive(Clone, Copy, Default)]
pub(super) struct ShapeMedia {
    pub(super) interior: Option<(Span, Medium)>,
    pub(super) exterior: Option<(Span, Medium)>,
}

impl ShapeMedia {
    /// The same on the other sides.
    fn swapped(self) -> Self {
        Self {
            interior: self.exterior,
            exterior: self.interior,
        }
    }

    /// What distinguishes them.
    pub(super) fn key(&self) -> [Option<Span>; 2] {
        [self.interior, self.exterior].map(|medium| medium.map(|(span, _)| span))
    }
}

impl<'run> Lowering<'run> {
    /// Notes whether an integrator knows media: those without do not see them.
    pub(super) fn integrator_of_media(&mut self, node: &PluginNode) {
        self.ignores_media = matches!(node.plugin.text.as_str(), "path" | "direct" | "prb");
    }

    /// The media inside and outside of a shape. Mitsuba's normal decides; `is_inside_out` says that
    /// it points into the shape.
    pub(super) fn media_of(&mut self, shape: &'run PluginNode, is_inside_out: bool) -> ShapeMedia {
        let side = |side: &str| shape.child(side);
        let [interior, exterior] = ["interior", "exterior"].map(|name| {
            let node = side(name).and_then(|node| self.resolve(node))?;
            Some((node.span, self.medium(node)?))
        });
        for child in &shape.children {
            let name = child.name.as_deref();
            if child.tag == "medium" && !matches!(name, Some("interior" | "exterior")) {
                self.ignored_element(child);
            }
        }
        let media = ShapeMedia { interior, exterior };
        match is_inside_out {
            true => media.swapped(),
            false => media,
        }
    }

    /// The medium in which the sensor is.
    pub(super) fn medium_of_sensor(&mut self, sensor: &'run PluginNode) {
        let is_medium =
            |node: &&'run PluginNode| node.tag == "medium" || self.refers_to(node, "medium");
        let Some(node) = sensor.children.iter().find(is_medium) else {
            return;
        };
        self.scene.medium = self.resolve(node).and_then(|node| self.medium(node));
    }

    /// A medium; `None` where it is left out.
    fn medium(&mut self, node: &'run PluginNode) -> Option<Medium> {
        if node.tag != "medium" {
            return None;
        }
        if let Some(known) = self.media.get(&node.span) {
            return *known;
        }
        let medium = self.lowered_medium(node);
        self.media.insert(node.span, medium);
        medium
    }

    fn lowered_medium(&mut self, node: &'run PluginNode) -> Option<Medium> {
        if self.ignores_media {
            let message = "the integrator of the scene does not know participating media: they \
                           are left out";
            let diagnostic = Diagnostic::new(&codes::MITSUBA_IGNORED, message);
            self.sink.push(diagnostic.at(node.plugin.span, ""));
            return None;
        }
        if MEDIA.find(&node.plugin.text).is_none() {
            self.unsupported(node, "it is left out");
            return None;
        }
        if let Some(name) = node.string("material") {
            let message = format!(
                "the coefficients of the material `{}` are not known: those of the default \
                 replace them",
                clip(&name.text)
            );
            self.approximate(name.span, message);
        }
        let scale = node.number("scale").unwrap_or(1.0);
        let scaled = |sigma: [f64; 3]| sigma.map(|channel| channel * scale);
        let g = self.mean_cosine(node);
        // Versions before 2 may name the coefficients of absorption and scattering.
        if node.get("sigma_s").is_some() || node.get("sigma_a").is_some() {
            let sigma = |name| scaled(node.color(name).unwrap_or([0.0; 3]));
            return Some(Medium {
                sigma_a: sigma("sigma_a"),
                sigma_s: sigma("sigma_s"),
                g,
            });
        }
        let density = match node.child("density").is_some() || node.get("density").is_some() {
            true => "density",
            false => "sigma_t",
        };
        let sigma_t = scaled(self.volume(node, density, 1.0));
        let albedo = self.volume(node, "albedo", 0.75);
        Some(Medium::of_albedo(
            sigma_t,
            albedo.map(|channel| channel.min(1.0)),
            g,
        ))
    }

    /// The constant value of a property or of a volume.
    fn volume(&mut self, node: &'run PluginNode, name: &str, default: f64) -> [f64; 3] {
        if let Some(color) = node.color(name) {
            return color;
        }
        let Some(volume) = node.child(name).and_then(|child| self.resolve(child)) else {
            return [default; 3];
        };
        if volume.plugin.text == "constvolume" {
            return volume.color("value").unwrap_or([default; 3]);
        }
        if volume.plugin.text == "gridvolume"
            && let Some(mean) = self.grid_mean(volume)
        {
            self.unsupported(volume, "its mean replaces it");
            return mean;
        }
        self.unsupported(volume, &format!("the constant {default} replaces it"));
        [default; 3]
    }

    /// The mean of a grid with one or three channels; `None` without a readable file.
    fn grid_mean(&mut self, volume: &'run PluginNode) -> Option<[f64; 3]> {
        let path = self.located(volume.string("filename")?);
        let bytes = self.file_bytes(&path, &GRID)?;
        mean_of_grid(&bytes)
    }

    /// The mean cosine of the phase function of a medium.
    fn mean_cosine(&mut self, node: &'run PluginNode) -> f64 {
        let is_phase =
            |child: &&'run PluginNode| child.tag == "phase" || self.refers_to(child, "phase");
        let phase = node.children.iter().find(is_phase);
        let Some(phase) = phase.and_then(|phase| self.resolve(phase)) else {
            return 0.0;
        };
        match PHASES.known(&phase.plugin.text) {
            "isotropic" => 0.0,
            "hg" => phase.number("g").unwrap_or(0.8),
            _ => {
                self.unsupported(phase, "light is scattered equally into all directions");
                0.0
            }
        }
    }
}
