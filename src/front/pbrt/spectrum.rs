//! Colours: numbers, black bodies, spectra by pairs, names and files, as linear Rec. 709.

use super::Lowering;
use super::parameter::{ParameterType, ParameterValues, Parameters};
use crate::exchange::SpannedText;
use crate::exchange::color::{
    copper, emitted, emitted_spectrum, from_spectrum, from_xyz, integrated, interpolated, metal,
    normal_reflectance, of_reflectance, of_unit_luminance, planck,
};
use rtc_diag::clip;
use rtc_ir::Conductor;
use rtc_source::{FileKind, Resource};
use std::rc::Rc;

/// Spectra as text: pairs of a wavelength in nanometres and a value.
const SPECTRA: FileKind = FileKind {
    extensions: &["spd"],
    begins: |head| head.iter().all(|byte| byte.is_ascii()),
};

/// The largest spectrum, in bytes.
const MAX_SPECTRUM: usize = 1 << 20;

/// The glasses of version 4 by name: the index of refraction at 589 nm and the Abbe number, from
/// the data sheets of Schott.
const GLASSES: [(&str, f64, f64); 8] = [
    ("glass-BK7", 1.5168, 64.17),
    ("glass-BAF10", 1.67, 47.11),
    ("glass-FK51A", 1.48656, 84.47),
    ("glass-LASF9", 1.85025, 32.17),
    ("glass-F5", 1.60342, 38.03),
    ("glass-SF5", 1.67271, 32.21),
    ("glass-SF10", 1.72828, 28.41),
    ("glass-SF11", 1.78472, 25.76),
];

/// The pairs of a file; none if it cannot be read.
pub(super) type SpectrumPairs = Option<Rc<[(f64, f64)]>>;

/// A spectrum of a conductor's index.
#[derive(Clone, Debug)]
enum IndexSpectrum {
    /// The values at the primaries.
    Primaries([f64; 3]),
    Pairs(Rc<[(f64, f64)]>),
    /// The spectrum of a metal by name.
    Metal(Conductor),
}

impl Lowering<'_> {
    /// A colour of a surface; `None` for one that is not given, is a texture, or is not readable,
    /// which is reported.
    pub(super) fn color(
        &mut self,
        parameters: &Parameters,
        name: &'static str,
    ) -> Option<[f64; 3]> {
        self.color_by(parameters, name, from_spectrum)
    }

    /// The colour of a light. In version 4 spectra and black bodies have the luminance 1 before
    /// they are scaled.
    pub(super) fn light_color(&mut self, parameters: &Parameters, name: &'static str) -> [f64; 3] {
        let kind = parameters.find(name).map(|parameter| parameter.kind);
        if let (Some(ParameterType::Spectrum), Some(text)) = (kind, parameters.string(name))
            && let Some(color) = illuminant(&text.text)
        {
            return color;
        }
        let color = self.color_by(parameters, name, emitted_spectrum);
        let color = color.unwrap_or([1.0; 3]);
        let is_spectrum = matches!(
            kind,
            Some(ParameterType::Spectrum | ParameterType::Blackbody)
        );
        match is_spectrum && !self.is_version_3 {
            true => of_unit_luminance(color),
            false => color,
        }
    }

    /// A colour; `convert` makes it of the pairs of a spectrum.
    fn color_by(
        &mut self,
        parameters: &Parameters,
        name: &'static str,
        convert: impl Fn(&[(f64, f64)]) -> Option<[f64; 3]>,
    ) -> Option<[f64; 3]> {
        // A spectrum in a file is converted from its samples.
        let parameter = parameters.find(name)?;
        let numbers = match &parameter.values {
            ParameterValues::Numbers(numbers) => numbers.as_slice(),
            ParameterValues::Strings(strings) if parameter.kind == ParameterType::Spectrum => {
                parameters.take(name);
                let pairs = self.spectrum_file(strings.first()?, "white replaces it");
                let color = pairs.and_then(|pairs| convert(&pairs));
                return Some(color.unwrap_or([1.0; 3]));
            }
            _ => return None,
        };
        parameters.take(name);
        // Other values are converted by the type of the parameter.
        match (parameter.kind, numbers) {
            (ParameterType::Float | ParameterType::Integer, [grey, ..]) => Some([*grey; 3]),
            (ParameterType::Rgb | ParameterType::Tuple(3), [r, g, b, ..]) => Some([*r, *g, *b]),
            (ParameterType::Xyz, [x, y, z, ..]) => {
                Some(from_xyz([*x, *y, *z]).map(|channel| channel.max(0.0)))
            }
            (ParameterType::Blackbody, numbers) => Some(black_body(numbers)),
            (ParameterType::Spectrum, numbers) => {
                let pairs: Vec<_> = numbers
                    .as_chunks()
                    .0
                    .iter()
                    .map(|[nm, v]| (*nm, *v))
                    .collect();
                let color = convert(&pairs);
                if color.is_none() {
                    self.mistake(parameter.name.span, "the wavelengths do not ascend");
                }
                color
            }
            _ => None,
        }
    }

    /// The index of a conductor by `eta` and `k`; that of copper without them. Of spectra it is the
    /// one with their reflectance along the normal.
    pub(super) fn conductor(
        &mut self,
        parameters: &Parameters,
        [eta, k]: [&'static str; 2],
    ) -> Conductor {
        let (eta, k) = (self.index(parameters, eta), self.index(parameters, k));
        if let (Some(IndexSpectrum::Pairs(eta)), Some(IndexSpectrum::Pairs(k))) = (&eta, &k) {
            let reflectance = integrated(|nm| {
                let (eta, k) = (interpolated(eta, nm), interpolated(k, nm));
                let [eta, k] = [eta, k].map(|number| [number.max(0.0); 3]);
                normal_reflectance(Conductor { eta, k })[0]
            });
            let eta = from_spectrum(eta).unwrap_or([1.0; 3]);
            return of_reflectance(eta, reflectance);
        }
        let values = |index: Option<IndexSpectrum>, part: fn(Conductor) -> [f64; 3]| {
            let values = match index {
                Some(IndexSpectrum::Primaries(values)) => values,
                Some(IndexSpectrum::Pairs(pairs)) => from_spectrum(&pairs).unwrap_or([1.0; 3]),
                Some(IndexSpectrum::Metal(metal)) => part(metal),
                None => part(copper()),
            };
            values.map(|channel| channel.max(0.0))
        };
        Conductor {
            eta: values(eta, |metal| metal.eta),
            k: values(k, |metal| metal.k),
        }
    }

    fn index(&mut self, parameters: &Parameters, name: &'static str) -> Option<IndexSpectrum> {
        let parameter = parameters.find(name)?;
        let (ParameterType::Spectrum, ParameterValues::Strings(strings)) =
            (parameter.kind, &parameter.values)
        else {
            return self.color(parameters, name).map(IndexSpectrum::Primaries);
        };
        parameters.take(name);
        let text = strings.first()?.clone();
        let known = metal_name(&text.text);
        if let Some(known) = known.filter(|_| text.text.starts_with("metal-")) {
            return Some(IndexSpectrum::Metal(known));
        }
        let instead = match known {
            Some(_) => "the usual index of the metal replaces it",
            None => "that of copper replaces it",
        };
        match self.spectrum_file(&text, instead) {
            Some(pairs) => Some(IndexSpectrum::Pairs(pairs)),
            None => known.map(IndexSpectrum::Metal),
        }
    }

    /// The index of refraction of a dielectric and its dispersion, 20 over the Abbe number.
    pub(super) fn refraction(
        &mut self,
        parameters: &Parameters,
        names: [&'static str; 2],
    ) -> (f64, f64) {
        let [name, other] = names.map(|name| parameters.find(name));
        let Some(parameter) = name.or(other) else {
            return (1.5, 0.0);
        };
        let span = parameter.name.span;
        if !matches!(parameter.kind, ParameterType::Bool | ParameterType::String) {
            names.into_iter().for_each(|name| parameters.take(name));
        }
        match (&parameter.values, parameter.kind) {
            (ParameterValues::Strings(strings), ParameterType::Spectrum) => {
                let name = strings.first().map_or("", |text| text.text.as_str());
                let glass = GLASSES.iter().find(|(known, ..)| *known == name);
                if let Some((_, ior, abbe)) = glass {
                    return (*ior, 20.0 / abbe);
                }
                let message = format!("the glass `{}` is not known: 1.5 is its index", clip(name));
                self.approximate(span, message);
                (1.5, 0.0)
            }
            (ParameterValues::Strings(_), ParameterType::Texture) => {
                self.approximate(span, "the texture of an index of refraction is left out");
                (1.5, 0.0)
            }
            (ParameterValues::Numbers(numbers), ParameterType::Spectrum) => {
                // The value in the middle of the visible spectrum.
                let pairs: Vec<_> = numbers
                    .as_chunks()
                    .0
                    .iter()
                    .map(|[nm, v]| (*nm, *v))
                    .collect();
                (interpolated(&pairs, 589.0), 0.0)
            }
            (ParameterValues::Numbers(numbers), _) => {
                (numbers.first().copied().unwrap_or(1.5), 0.0)
            }
            (ParameterValues::Flags(_) | ParameterValues::Strings(_), _) => (1.5, 0.0),
        }
    }

    fn spectrum_file(&mut self, path: &SpannedText, instead: &str) -> SpectrumPairs {
        if let Some(known) = self.spectra.get(&path.text) {
            return known.clone();
        }
        let pairs = self.read_spectrum(path, instead).map(Rc::from);
        self.spectra.insert(path.text.clone(), pairs.clone());
        pairs
    }

    fn read_spectrum(&mut self, path: &SpannedText, instead: &str) -> Option<Vec<(f64, f64)>> {
        let bytes = self.file(path, &SPECTRA, instead)?;
        let charged = self.charge(Resource::Memory, 8 * bytes.len() as u64, path.span);
        charged?;
        let text = std::str::from_utf8(&bytes).ok();
        let text = text.filter(|text| text.len() <= MAX_SPECTRUM);
        let pairs = text.and_then(pairs);
        if pairs.is_none() {
            let why = "it is not pairs of numbers whose first ascend";
            self.damaged(&rtc_diag::codes::PBRT_VALUE, path, why, instead);
        }
        pairs
    }
}

/// The pairs of a text: lines of a wavelength and a value, `#` before comments.
fn pairs(text: &str) -> Option<Vec<(f64, f64)>> {
    let lines = text
        .lines()
        .map(|line| line.split('#').next().unwrap_or_default());
    let words = lines.flat_map(str::split_ascii_whitespace);
    let numbers: Option<Vec<f64>> = words.map(|word| word.parse().ok()).collect();
    let (pairs, []) = numbers.as_deref()?.as_chunks() else {
        return None;
    };
    let pairs: Vec<_> = pairs.iter().map(|[nm, value]| (*nm, *value)).collect();
    let is_sound = !pairs.is_empty()
        && pairs.is_sorted_by(|a, b| a.0 < b.0)
        && pairs
            .iter()
            .all(|(nm, value)| nm.is_finite() && value.is_finite());
    is_sound.then_some(pairs)
}

/// The metal of `metal-Au-eta`, or of a file as `spds/Au.eta.spd`.
fn metal_name(text: &str) -> Option<Conductor> {
    let name = text.rsplit('/').next()?;
    let name = name.strip_prefix("metal-").unwrap_or(name);
    metal(name.split(['-', '.']).next()?)
}

/// A black body: the temperature in kelvin, and in version 3 a scale.
fn black_body(numbers: &[f64]) -> [f64; 3] {
    let kelvin = numbers.first().copied().unwrap_or(6500.0).clamp(100.0, 1e6);
    let scale = numbers.get(1).copied().unwrap_or(1.0);
    emitted(|nm| planck(nm, kelvin)).map(|channel| channel * scale)
}

/// The illuminants of version 4 by name, with the luminance 1.
fn illuminant(name: &str) -> Option<[f64; 3]> {
    let kelvin = match name {
        "stdillum-D65" => return Some([1.0; 3]),
        "stdillum-A" => 2856.0,
        "stdillum-D50" => 5003.0,
        _ => return None,
    };
    Some(of_unit_luminance(emitted(|nm| planck(nm, kelvin))))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn metals_are_known_by_both_spellings() {
        assert!(metal_name("metal-Au-eta").is_some());
        assert_eq!(metal_name("metal-Cu-k"), metal_name("spds/Cu.k.spd"));
        assert_eq!(metal_name("spds/unknown.spd"), None);
    }

    #[test]
    fn spectra_are_pairs_that_ascend() {
        assert_eq!(
            pairs("400 1 # violet\n700 2"),
            Some(vec![(400.0, 1.0), (700.0, 2.0)])
        );
        assert_eq!(
            (pairs("400 1 700"), pairs("500 1 400 1"), pairs("")),
            (None, None, None)
        );
    }
}
