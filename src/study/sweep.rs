//! Each parameter alone: its error if all others have none, and the power law of that error; and a
//! model of all parameters together, in which squared errors add.

use super::metrics::{LEVELS, products};
use super::outcome::ParameterReport;
use super::parameter::Parameter;
use super::reference::{ComparedDepths, ParameterLevel, Reference, independent};
use super::setting::Setting;
use super::statistics::PowerLaw;
use super::subject::{Stopped, StudySubject};
use rtc_image::Image;
use rtc_math::{exp, ln};
use rtc_render::SamplingSeeds;

/// A parameter at each of its values, with all others as in the reference.
pub(super) struct ParameterSweep {
    pub(super) parameter: Parameter,
    pub(super) levels: Vec<ParameterLevel>,
    pub(super) law: Option<PowerLaw>,
}

/// Renders the values of one sampling parameter within the budget.
///
/// The others stay at `base` with independent samples in two renders: their common error is that of
/// the parameter alone.
pub(super) fn sweep(
    subject: &StudySubject<'_>,
    reference: &Reference,
    (parameter, base): (Parameter, Setting),
    budget: u64,
) -> Result<ParameterSweep, Stopped> {
    let mut levels: Vec<ParameterLevel> = Vec::new();
    let mut spent = 0;
    for value in parameter.levels() {
        if let Some(last) = levels.last() {
            let expected =
                last.rays as f64 * parameter.samples(value) / parameter.samples(last.value);
            if levels.len() > 2 && spent as f64 + 2.0 * expected > budget as f64 {
                break;
            }
        }
        let setting = base.with(parameter, value);
        let (a, b) = (
            subject.render(setting, others(parameter, 3))?,
            subject.render(setting, others(parameter, 4))?,
        );
        let level = level(value, [&a.tiles, &b.tiles], reference, a.counts.rays());
        spent += a.counts.rays() + b.counts.rays();
        levels.push(level);
        if !level.resolved {
            break;
        }
    }
    Ok(ParameterSweep {
        parameter,
        law: law(parameter, &levels),
        levels,
    })
}

/// Independent seeds, except for the parameter itself.
fn others(parameter: Parameter, number: u64) -> SamplingSeeds {
    let seeds = independent(number);
    match parameter {
        Parameter::Supersampling => SamplingSeeds { pixel: 0, ..seeds },
        Parameter::Aperture => SamplingSeeds { lens: 0, ..seeds },
        Parameter::Lights | Parameter::Glossy => SamplingSeeds { path: 0, ..seeds },
        Parameter::Paths => SamplingSeeds::NONE,
        Parameter::Caustics | Parameter::Denoise | Parameter::Depth | Parameter::Precision => seeds,
    }
}

/// The common error of two renders against the reference, less the error of the reference itself.
fn level(value: u32, [a, b]: [&[Image]; 2], reference: &Reference, rays: u64) -> ParameterLevel {
    /// The number of channels of a block of pixels, at most a tile.
    const BLOCK: usize = 3 * 256;
    let floor = reference.floor / LEVELS;
    let reference_tiles = reference.tiles.as_slice();
    let products: Vec<_> = products([a, reference_tiles], [b, reference_tiles])
        .map(|product| product - floor * floor)
        .collect();
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let (whole, blocks) = (mean(&products), products.len().div_ceil(BLOCK) as f64);
    let squares = products
        .chunks(BLOCK)
        .map(|block| mean(block) - whole)
        .map(|off| off * off)
        .sum::<f64>();
    let deviation = (squares / (blocks * (blocks - 1.0).max(1.0))).sqrt();
    let resolved = whole > 2.0 * deviation && whole > floor * floor;
    ParameterLevel {
        value,
        error: whole.max(0.0).sqrt() * LEVELS,
        resolved,
        rays,
    }
}

/// The power law of the resolved levels. A single light or lobe sample is at the centre: that is
/// another picture, not a sample of it.
fn law(parameter: Parameter, levels: &[ParameterLevel]) -> Option<PowerLaw> {
    let is_sample = |level: &&ParameterLevel| {
        level.resolved
            && !(level.value == 1 && matches!(parameter, Parameter::Lights | Parameter::Glossy))
    };
    let points: Vec<_> = levels
        .iter()
        .filter(is_sample)
        .map(|level| (parameter.samples(level.value), level.error))
        .collect();
    PowerLaw::fit(&points)
}

/// A model of the error and the rays of any setting.
pub(super) struct CostModel {
    parameters: Vec<ParameterSweep>,
    base: Setting,
    base_rays: f64,
    /// The interaction of supersampling and lens samples: the squared error of one of each, beyond
    /// the sum of both alone.
    interaction: f64,
}

impl CostModel {
    /// The model of levels that were measured around `base`, which takes `base_rays`.
    pub(super) fn new(
        mut parameters: Vec<ParameterSweep>,
        depths: Option<&ComparedDepths>,
        base: Setting,
        base_rays: u64,
    ) -> Self {
        parameters.extend(depths.map(|depths| ParameterSweep {
            parameter: Parameter::Depth,
            levels: depths.levels.clone(),
            law: None,
        }));
        Self {
            parameters,
            base,
            base_rays: base_rays as f64,
            interaction: 0.0,
        }
    }

    /// Fits the interaction to the error of the base with one sub-sample and one lens sample.
    pub(super) fn learn_interaction(&mut self, coarse: Setting, error: f64) {
        let alone = self.error(coarse);
        self.interaction = (error * error - alone * alone).max(0.0);
    }

    /// Adds the errors of the arithmetics.
    pub(super) fn learn_precision(&mut self, levels: ParameterSweep) {
        self.parameters.push(levels);
    }

    fn levels(&self, parameter: Parameter) -> Option<&ParameterSweep> {
        self.parameters
            .iter()
            .find(|levels| levels.parameter == parameter)
    }

    /// The measured values of a parameter, in ascending order of work.
    pub(super) fn measured_values(&self, parameter: Parameter) -> impl Iterator<Item = u32> {
        self.levels(parameter)
            .into_iter()
            .flat_map(|levels| &levels.levels)
            .map(|level| level.value)
    }

    /// The measurements of a parameter; `not_applicable` is the reason why it does not apply, if it
    /// does not.
    pub(super) fn report(
        &self,
        parameter: Parameter,
        not_applicable: Option<String>,
    ) -> ParameterReport {
        let levels = self.levels(parameter);
        ParameterReport {
            parameter,
            not_applicable,
            levels: levels
                .map(|levels| levels.levels.clone())
                .unwrap_or_default(),
            law: levels.and_then(|levels| levels.law),
        }
    }

    /// The error of a setting in grey levels.
    pub(super) fn error(&self, setting: Setting) -> f64 {
        let more = self.base.camera_rays() / setting.camera_rays();
        let squares = self.parameters.iter().map(|levels| {
            let value = setting.get(levels.parameter);
            let error = levels.error(value);
            // Lights and lobes are resampled for each camera ray; a single sample is always the
            // centre.
            let is_resampled =
                matches!(levels.parameter, Parameter::Lights | Parameter::Glossy) && value > 1;
            error * error * if is_resampled { more } else { 1.0 }
        });
        // Each lens sample has its own aliasing: the mean is smoother the more lens samples there
        // are.
        let samples = Parameter::Supersampling.samples(setting.supersampling);
        let interaction =
            self.interaction / (samples * samples.sqrt() * f64::from(setting.aperture));
        (squares.sum::<f64>() + interaction).sqrt()
    }

    /// The rays of a setting.
    pub(super) fn rays(&self, setting: Setting) -> f64 {
        let factors = self.parameters.iter().map(|levels| {
            let rays = |value| levels.rays(value);
            rays(setting.get(levels.parameter)) / rays(self.base.get(levels.parameter))
        });
        self.base_rays * factors.product::<f64>()
    }
}

impl ParameterSweep {
    fn error(&self, value: u32) -> f64 {
        // The first level has the largest error; it counts even if it is not resolved.
        let counts = |(index, level): &(usize, &ParameterLevel)| {
            *index == 0 || level.resolved || self.parameter == Parameter::Depth
        };
        let clear: Vec<_> = self
            .levels
            .iter()
            .enumerate()
            .filter(counts)
            .map(|(_, level)| level)
            .collect();
        if let Some(level) = clear.iter().find(|level| level.value == value) {
            return level.error;
        }
        let (Some(last), x) = (clear.last(), self.parameter.samples(value)) else {
            return 0.0;
        };
        let above = clear
            .iter()
            .position(|level| level.value > value)
            .filter(|above| *above > 0);
        match above {
            // Between the measured depths and the scene's depth, which has no error.
            Some(above) if self.parameter == Parameter::Depth => {
                let (below, above) = (clear[above - 1], clear[above]);
                let fraction =
                    f64::from(value - below.value) / f64::from(above.value - below.value);
                below.error + fraction * (above.error - below.error)
            }
            Some(above) => self.between([clear[above - 1], clear[above]], x, |level| level.error),
            // Beyond the last value: constant for the depth, the power law otherwise.
            None if self.parameter == Parameter::Depth => last.error,
            None => {
                let exponent = self.law.map_or(0.5, |law| law.p.value.clamp(0.25, 2.0));
                last.error * exp(-exponent * ln(x / self.parameter.samples(last.value)))
            }
        }
    }

    /// The rays in arbitrary units.
    fn rays(&self, value: u32) -> f64 {
        let at = |level: &ParameterLevel| level.rays as f64;
        if let Some(level) = self.levels.iter().find(|level| level.value == value) {
            return at(level);
        }
        let x = self.parameter.samples(value);
        let above = self
            .levels
            .iter()
            .position(|level| level.value > value)
            .filter(|above| *above > 0);
        match (above, self.levels.last()) {
            (Some(above), _) => self.between([&self.levels[above - 1], &self.levels[above]], x, at),
            (None, Some(last)) if self.parameter == Parameter::Depth => at(last),
            (None, Some(last)) => at(last) * x / self.parameter.samples(last.value),
            (None, None) => 1.0,
        }
    }

    /// Linear interpolation between two levels, on logarithmic scales.
    fn between(
        &self,
        [below, above]: [&ParameterLevel; 2],
        x: f64,
        of: impl Fn(&ParameterLevel) -> f64,
    ) -> f64 {
        let log = |x: f64| ln(x.max(f64::MIN_POSITIVE));
        let (from, to) = (
            log(self.parameter.samples(below.value)),
            log(self.parameter.samples(above.value)),
        );
        let fraction = (log(x) - from) / (to - from);
        exp(log(of(below)) * (1.0 - fraction) + log(of(above)) * fraction)
    }
}
