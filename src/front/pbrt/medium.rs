//! Participating media of shapes and of the camera. Homogeneous media are exact; others are left
//! out.

use super::Lowering;
use super::parameter::Parameters;
use super::plugins::MEDIA;
use crate::exchange::SpannedText;
use rtc_diag::{clip, codes};
use rtc_ir::Medium;

/// The integrators that do not know media.
const IN_VACUUM: [&str; 5] = [
    "path",
    "simplepath",
    "directlighting",
    "whitted",
    "ambientocclusion",
];

/// The media inside and outside of the following shapes; the latter is that of the camera.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct InterfaceMedia {
    pub(super) interior: Option<Medium>,
    pub(super) exterior: Option<Medium>,
}

impl InterfaceMedia {
    /// Whether a surface leads from one medium to another.
    pub(super) fn is_transition(&self) -> bool {
        self.interior != self.exterior
    }

    /// What distinguishes surfaces: the bits of all numbers, if they lead from one medium to
    /// another.
    pub(super) fn key(&self) -> Option<[Option<[u64; 7]>; 2]> {
        let bits = |medium: Medium| {
            let Medium {
                sigma_a: [a, b, c],
                sigma_s: [d, e, f],
                g,
            } = medium;
            [a, b, c, d, e, f, g].map(f64::to_bits)
        };
        let media = [self.interior, self.exterior];
        self.is_transition()
            .then(|| media.map(|medium| medium.map(bits)))
    }
}

impl Lowering<'_> {
    /// `MakeNamedMedium`.
    pub(super) fn make_named_medium(&mut self, name: SpannedText, parameters: &Parameters) {
        let Some(plugin) = parameters.string("type").cloned() else {
            let message = format!("the medium `{}` has no `type`", clip(&name.text));
            return self.mistake(name.span, message);
        };
        let medium = match MEDIA.known(&plugin.text) {
            "homogeneous" => Some(self.homogeneous(&plugin, parameters)),
            _ => {
                self.unsupported("medium", &plugin, &MEDIA, "it is left out");
                None
            }
        };
        self.media.insert(name.text, medium);
    }

    fn homogeneous(&mut self, plugin: &SpannedText, parameters: &Parameters) -> Medium {
        /// The coefficients of pbrt without any, per millimetre.
        const SIGMA_A: [f64; 3] = [0.0011, 0.0024, 0.014];
        const SIGMA_S: [f64; 3] = [2.55, 3.21, 3.77];
        if let Some(preset) = parameters.string("preset") {
            let message = format!(
                "the coefficients of the preset `{}` are not known: those of the default replace \
                 them",
                clip(&preset.text)
            );
            let span = preset.span;
            self.approximate(span, message);
        }
        if ["Le", "Lescale"]
            .iter()
            .any(|name| parameters.get(name).is_some())
        {
            self.approximate(plugin.span, "the light that the medium emits is left out");
        }
        let scale = parameters.number("scale").unwrap_or(1.0);
        let sigma_a = self.color(parameters, "sigma_a").unwrap_or(SIGMA_A);
        let sigma_s = self.color(parameters, "sigma_s").unwrap_or(SIGMA_S);
        let g = parameters.number("g").unwrap_or(0.0);
        self.ignored("medium", &plugin.text, (&MEDIA, parameters));
        let [sigma_a, sigma_s] = [sigma_a, sigma_s].map(|sigma| sigma.map(|x| x * scale));
        Medium {
            sigma_a,
            sigma_s,
            g,
        }
    }

    /// `MediumInterface`: the media inside and outside of shapes, by name; one name is both.
    pub(super) fn medium_interface(&mut self, names: &[SpannedText]) {
        let [interior, exterior] = match names {
            [both] => [both, both],
            [interior, exterior, ..] => [interior, exterior],
            [] => return,
        };
        let [interior, exterior] = [interior, exterior].map(|name| self.named_medium(name));
        self.state.media = InterfaceMedia { interior, exterior };
    }

    fn named_medium(&mut self, name: &SpannedText) -> Option<Medium> {
        if name.text.is_empty() {
            return None;
        }
        if self.ignores_media {
            let message = "the integrator of the scene does not know participating media";
            self.report(&codes::PBRT_IGNORED, name.span, message);
            return None;
        }
        let medium = self.media.get(&name.text).copied();
        if medium.is_none() {
            let message = format!("there is no medium `{}`: none is there", clip(&name.text));
            self.doubtful(name.span, message);
        }
        medium.flatten()
    }

    /// Notes whether an integrator knows media.
    pub(super) fn integrator_of_media(&mut self, plugin: &str) {
        self.ignores_media = IN_VACUUM.contains(&plugin);
    }
}
