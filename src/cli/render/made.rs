//! A finished picture: its messages, as text and as a JSON object.

use super::super::{progress, system};
use indicatif::{HumanBytes, HumanCount};
use rtc_pipeline::PictureSetup;
use rtc_plan::Effect;
use rtc_render::{ClampedLight, RayCounts};
use rtc_study::{CoarsePicture, ProbedError, SampleStatistics};
use serde_json::{Map, Value, json};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// A picture that was made.
pub(crate) struct FinishedPicture {
    output: PathBuf,
    size: [u32; 2],
    /// The stops by which it was exposed, if they were found.
    exposure: Option<f64>,
    /// The message about its light.
    light: String,
    counts: RayCounts,
    elapsed: Duration,
    /// Whether it is denoised.
    is_denoised: bool,
    /// Whether light of its paths is clamped.
    is_clamped: bool,
    quality: Option<PictureQuality>,
}

/// A bound that is so many times the estimate is told beside it.
const FAR_ABOVE: f64 = 10.0;

/// How good a picture is, if that is known.
pub(super) struct PictureQuality {
    /// The bound on its error in grey levels.
    pub(super) error: f64,
    /// The largest radiance that no sample may have hit, if there is no bound.
    pub(super) undersampled: Option<f64>,
    pub(super) known: EstimateSource,
}

/// The source of the estimate.
pub(super) enum EstimateSource {
    /// The picture grew until it was good enough.
    Growing {
        /// The likely error, in grey levels.
        estimate: f64,
        /// If the time was too short for it.
        coarse: Option<CoarsePicture>,
        samples: SampleStatistics,
        /// Its rays ran out.
        has_run_out: bool,
        /// The target in grey levels, if the picture ended with a larger bound.
        ends_above: Option<f64>,
    },
    /// Some pixels of a denoised picture were sampled again.
    Probing {
        /// The likely error, in grey levels.
        estimate: f64,
        /// The bound of the plain picture, in grey levels.
        plain: f64,
        /// The number of pixels.
        probes: usize,
        /// Each so often.
        samples: u32,
        /// The target in grey levels, if the picture ended with a larger error.
        ends_above: Option<f64>,
    },
}

impl FinishedPicture {
    /// A picture with its setup, pixels, rays and seconds.
    pub(super) fn new(
        output: &Path,
        setup: &PictureSetup,
        size: [u32; 2],
        (counts, elapsed): (RayCounts, Duration),
    ) -> Self {
        Self {
            output: output.to_owned(),
            size,
            exposure: setup.look.found_exposure(),
            light: setup.light_summary(),
            counts,
            elapsed,
            is_denoised: setup.denoise,
            is_clamped: setup.clamp.is_some(),
            quality: None,
        }
    }

    /// The same, with how good it is.
    pub(super) fn with(self, quality: Option<PictureQuality>) -> Self {
        Self { quality, ..self }
    }

    /// The text: size, light, rays and time; if `verbose`, how often each effect was simulated and
    /// the bytes on huge pages; the quality.
    pub(crate) fn text(&self, verbose: bool) -> String {
        let ([width, height], light) = (self.size, &self.light);
        let work = progress::summary(self.counts.rays(), self.elapsed);
        let line = format!("{}: {width}×{height}, {light}{work}", self.output.display());
        let simulated = verbose.then(|| simulated(&self.counts));
        let pages = verbose.then(huge_pages).flatten();
        let clamped = self.is_clamped.then(|| clamped(&self.counts.clamped));
        let quality = self.quality_text();
        let lines = [Some(line), simulated, pages, clamped, quality];
        lines.into_iter().flatten().collect::<Vec<_>>().join("\n")
    }

    /// Its width and height.
    pub(super) fn size(&self) -> [u32; 2] {
        self.size
    }

    /// The text about its quality, if that is known.
    pub(super) fn quality_text(&self) -> Option<String> {
        let source = match self.counts.of(Effect::Caustics) {
            0 => "paths hit lights via smooth metal or glass by chance",
            _ => "estimated caustics have no greatest value near a focus",
        };
        self.quality.as_ref().map(|quality| quality.text(source))
    }

    /// As an object of one line, `{"rendered": …}`.
    pub(crate) fn object(&self) -> String {
        json!({ "rendered": self.facts() }).to_string()
    }

    /// The content of that object.
    pub(super) fn facts(&self) -> Value {
        let simulated: Map<String, Value> = effects(&self.counts)
            .map(|(name, count)| (name.to_owned(), json!(count)))
            .collect();
        let quality = self.quality.as_ref().map(PictureQuality::object);
        json!({
            "output": self.output.display().to_string(),
            "size": self.size,
            "exposureStops": self.exposure,
            "rays": self.counts.rays(),
            "seconds": self.elapsed.as_secs_f64(),
            "quality": quality,
            "denoised": self.is_denoised,
            "clamped": self.is_clamped.then(|| clamped_object(&self.counts.clamped)),
            "simulated": simulated,
        })
    }
}

/// How often each effect was simulated: its rays, or its evaluations.
pub(crate) fn effects(counts: &RayCounts) -> impl Iterator<Item = (&'static str, u64)> {
    let effects = Effect::OF_PATHS.into_iter().chain(Effect::OF_WHITTED);
    let counted = effects.map(|effect| (effect.name(), counts.of(effect)));
    counted.filter(|(_, count)| *count > 0)
}

/// The energy lost by clamping, as text.
fn clamped(light: &ClampedLight) -> String {
    let (share, paths) = (100.0 * light.share(), HumanCount(light.paths));
    format!("clamped: {paths} paths, which takes {share:.3} % of the light")
}

/// The same as a JSON object.
fn clamped_object(light: &ClampedLight) -> Value {
    json!({ "paths": light.paths, "shareOfLight": light.share() })
}

fn simulated(counts: &RayCounts) -> String {
    let text = effects(counts).map(|(name, count)| format!("{name} {}", HumanCount(count)));
    format!("simulated: {}", text.collect::<Vec<_>>().join("; "))
}

impl PictureQuality {
    /// For a denoised picture, which may have a target error.
    pub(super) fn probed(probed: &ProbedError, target: Option<f64>) -> Self {
        Self {
            error: probed.error,
            undersampled: probed.undersampled,
            known: EstimateSource::Probing {
                estimate: probed.estimate,
                plain: probed.plain,
                probes: probed.probes,
                samples: probed.samples,
                ends_above: target.filter(|target| probed.error > *target),
            },
        }
    }

    /// If the time was too short for the picture.
    pub(super) fn coarse(&self) -> Option<CoarsePicture> {
        match self.known {
            EstimateSource::Growing { coarse, .. } => coarse,
            EstimateSource::Probing { .. } => None,
        }
    }

    /// The text; `unbounded` says why there is no greatest value of a sample, if there is none.
    fn text(&self, unbounded: &str) -> String {
        // State the bound of the error.
        let bound = match self.coarse() {
            Some(CoarsePicture { block, .. }) => {
                format!("no bound: of some blocks of {block} × {block} pixels one was sampled")
            }
            None => bound(self.error, self.undersampled, unbounded),
        };
        // Tell how it was estimated.
        match &self.known {
            EstimateSource::Growing {
                estimate,
                samples: SampleStatistics { min, mean, most },
                has_run_out,
                ends_above,
                ..
            } => {
                // A bound far above the estimate says nothing of the picture.
                let likely = match self.error >= FAR_ABOVE * estimate && *estimate > 0.0 {
                    true => format!(", likely about {estimate:.2}"),
                    false => String::new(),
                };
                let end = match (has_run_out, ends_above) {
                    (true, _) => ", ended by `--limit rays`".to_owned(),
                    (_, Some(target)) => format!(
                        ", more than {target}: few pixels have most of the noise, so a bound \
                        would take far more samples than the picture"
                    ),
                    _ => String::new(),
                };
                format!(
                    "{bound}{likely}, {mean:.0} samples per pixel on average, {min} … {most}{end}"
                )
            }
            EstimateSource::Probing {
                estimate,
                plain,
                probes,
                samples,
                ends_above,
            } => {
                let end = ends_above.map_or_else(String::new, |target| {
                    format!(", more than {target}; `--denoise` takes no more paths")
                });
                let bound = match self.undersampled {
                    None => format!(
                        "error {plain:.2} → {:.2} grey levels (90 %)",
                        up(self.error)
                    ),
                    Some(_) => format!("{bound}, without denoising {plain:.2}"),
                };
                format!(
                    "{bound}, likely {estimate:.2}, by {samples} more samples of {probes} \
                    pixels{end}"
                )
            }
        }
    }

    /// Without a bound the object has only the error of the samples.
    fn object(&self) -> Value {
        let coarse = self.coarse();
        let has_bound = self.undersampled.is_none() && coarse.is_none();
        let mut object = json!({
            "bound": has_bound.then_some(self.error),
            "confidence": has_bound.then_some(0.9),
            "metError": coarse.is_none().then_some(self.error),
            "unmetWhites": self.undersampled,
        });
        match &self.known {
            EstimateSource::Growing {
                estimate,
                samples: SampleStatistics { min, mean, most },
                has_run_out,
                ends_above,
                ..
            } => {
                object["toldError"] = json!(coarse.is_none().then_some(estimate));
                object["crudeBlock"] = json!(coarse.map(|coarse| coarse.block));
                object["samples"] = json!({ "min": min, "mean": mean, "most": most });
                object["ranOut"] = json!(has_run_out);
                object["endsAbove"] = json!(ends_above);
            }
            EstimateSource::Probing {
                estimate,
                plain,
                probes,
                samples,
                ends_above,
            } => {
                object["endsAbove"] = json!(ends_above);
                object["toldError"] = json!(estimate);
                object["plainError"] = json!(plain);
                object["probes"] = json!({ "pixels": probes, "samples": samples });
            }
        }
        object
    }
}

/// A bound on the error in grey levels, as text; or the radiance, in multiples of white, that
/// prevents a bound; if that is infinite, for the given reason.
fn bound(levels: f64, undersampled: Option<f64>, unbounded: &str) -> String {
    match undersampled {
        None => format!("{} (90 %)", error(levels)),
        Some(white) if white <= 1.0 => format!(
            "no bound: rare features may be missing; {} (90 %) for the sampled part",
            error(levels)
        ),
        Some(white) if white.is_infinite() => format!(
            "no bound: {unbounded}; {} (90 %) for the sampled part",
            error(levels)
        ),
        Some(white) => format!(
            "no bound: light {white:.0} times as bright as white may be missing; {} (90 %) for the \
            sampled part",
            error(levels)
        ),
    }
}

/// An error in grey levels, as text.
pub(super) fn error(levels: f64) -> String {
    format!("error ≤ {:.2} grey levels", up(levels))
}

/// Rounded up, so that words promise no more than was measured.
fn up(levels: f64) -> f64 {
    (levels * 100.0).ceil() / 100.0
}

/// The bytes on huge pages, as text.
fn huge_pages() -> Option<String> {
    let bytes = system::huge_pages().filter(|bytes| *bytes > 0)?;
    Some(format!("huge pages: {}", HumanBytes(bytes)))
}
