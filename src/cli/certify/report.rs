//! The report of a certificate, as text and as JSON.

use super::super::Failure;
use super::named;
use rtc_math::to_u32;
use rtc_study::PixelCertificate;
use schemars::JsonSchema;
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::Path;

/// The maximum number of differing pixels in the text.
const MOST: usize = 8;

/// The JSON report of a certificate.
#[derive(Serialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub(crate) struct CertificateReport {
    /// The schema of this report: `rtc-certify/1`.
    #[schemars(extend("const" = "rtc-certify/1"))]
    schema: &'static str,
    /// The scene, as on the command line.
    scene: String,
    /// The picture.
    picture: String,
    /// The number of pixels.
    pixels: usize,
    /// The number of pixels whose values are all proven.
    certain: usize,
    /// The number of flagged pixels that lie on a border within rounding.
    within_rounding: usize,
    /// The number of flagged pixels that show a feature that is not evaluated.
    unsupported: usize,
    /// The number of flagged pixels with each reason; a pixel may have several.
    reasons: BTreeMap<&'static str, usize>,
    /// The pixels whose rendered values differ from the proven ones by more than rounding.
    differing: Vec<DifferingPixel>,
    /// The pixels whose rendered values differ from the proven ones where 53 bits leave the value
    /// open.
    rounded: Vec<DifferingPixel>,
}

/// A pixel whose rendered values differ from the proven ones.
#[derive(Serialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
struct DifferingPixel {
    /// Its column and its row.
    pixel: [u32; 2],
    /// The rendered values.
    rendered: [u8; 3],
    /// The proven values; null for one that is not proven.
    certain: [Option<u8>; 3],
}

impl CertificateReport {
    /// The report of a picture of a width, by its certificates and its values.
    pub(super) fn new(
        [scene, picture]: [&Path; 2],
        width: u32,
        (certified, rendered): (&[PixelCertificate], &[[u8; 3]]),
    ) -> Self {
        let certain = certified.iter().filter(|pixel| pixel.is_proven()).count();
        let flagged = || certified.iter().filter(|pixel| !pixel.is_proven());
        let within_rounding = flagged().filter(|pixel| pixel.doubts.is_rounding());
        let mut reasons = BTreeMap::new();
        for name in flagged().flat_map(|pixel| pixel.doubts.names()) {
            *reasons.entry(name).or_insert(0) += 1;
        }
        let within_rounding = within_rounding.count();
        let width = width as usize;
        let differing = |is_error: bool| {
            let pairs = certified.iter().zip(rendered).enumerate();
            let differing = pairs.filter(|(_, (certificate, values))| {
                !certificate.agrees(**values) && certificate.contradicts(**values) == is_error
            });
            let pixel = differing.map(|(index, (certificate, values))| DifferingPixel {
                pixel: [index % width, index / width].map(to_u32),
                rendered: *values,
                certain: certificate.levels,
            });
            pixel.collect()
        };
        Self {
            schema: "rtc-certify/1",
            scene: named(scene),
            picture: named(picture),
            pixels: certified.len(),
            certain,
            within_rounding,
            unsupported: certified.len() - certain - within_rounding,
            reasons,
            differing: differing(true),
            rounded: differing(false),
        }
    }

    /// Whether no rendered value differs from a proven one by more than rounding.
    pub(super) fn agrees(&self) -> bool {
        self.differing.is_empty()
    }

    /// The report as JSON.
    pub(super) fn json(&self) -> Result<String, Failure> {
        let text = serde_json::to_string_pretty(self);
        text.map(|text| text + "\n")
            .map_err(|error| Failure::Failed(error.to_string()))
    }

    /// The report for people.
    pub(super) fn to_text(&self) -> String {
        let mut line = format!(
            "{}: {} of {} pixels proven",
            self.picture,
            grouped(self.certain),
            grouped(self.pixels)
        );
        if self.within_rounding > 0 {
            line += &format!(
                "; {} within rounding of an edge",
                grouped(self.within_rounding)
            );
        }
        if self.unsupported > 0 {
            line += &format!(
                "; {} with features not evaluated",
                grouped(self.unsupported)
            );
        }
        let mut lines = vec![line];
        let reason = |(name, count): (&&str, &usize)| format!("  {name}: {}", grouped(*count));
        lines.extend(self.reasons.iter().map(reason));
        if !self.rounded.is_empty() {
            let count = grouped(self.rounded.len());
            lines.push(format!(
                "  {count} pixels are rendered otherwise than proven, where 53 bits do not decide"
            ));
        }
        if !self.agrees() {
            let count = grouped(self.differing.len());
            lines.push(format!(
                "{count} pixels differ from their proof, please report:"
            ));
        }
        lines.extend(
            self.differing
                .iter()
                .take(MOST)
                .map(DifferingPixel::to_text),
        );
        if self.differing.len() > MOST {
            let more = self.differing.len() - MOST;
            lines.push(format!("  and {more} more (`--format json` has all)"));
        }
        lines.join("\n") + "\n"
    }
}

impl DifferingPixel {
    fn to_text(&self) -> String {
        let value = |level: Option<u8>| level.map_or("?".to_owned(), |level| level.to_string());
        let levels = self.certain.map(value).join(", ");
        let [x, y] = self.pixel;
        format!("  ({x}, {y}): {:?}, proven ({levels})", self.rendered)
    }
}

/// A number with its digits in groups of three.
fn grouped(number: usize) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            text.push(' ');
        }
        text.push(digit);
    }
    text
}
