//! The report of an audit, as text and as JSON.

use super::super::Failure;
use rtc_pipeline::{AUDIT_ODDS, AuditFinding, AuditResult, AuditSubject};
use rtc_render::Crop;
use schemars::JsonSchema;
use serde::Serialize;
use std::path::Path;

/// The maximum number of diagnostics, or settings, in the text.
const MOST: usize = 8;

/// The JSON report of an audit.
#[derive(Serialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub(crate) struct AuditReport {
    /// The schema of this report: `rtc-audit/1`.
    #[schemars(extend("const" = "rtc-audit/1"))]
    schema: &'static str,
    /// The picture, as on the command line.
    picture: String,
    /// Its scene.
    scene: String,
    /// Whether nothing differs.
    passes: bool,
    /// The seed by which tiles were drawn; a string, as it has 64 bits.
    seed: String,
    /// The number of tiles; 0 if the metadata are wrong.
    tiles: u64,
    /// The pixels of a tile, but for those at the border.
    tile_pixels: u64,
    /// The number of tiles that were rendered again.
    drawn: u64,
    /// The confidence of the bound.
    confidence: f64,
    /// If no tile differs, an exclusive bound on the number of differing tiles.
    fewer_than: Option<u64>,
    /// The same as a fraction of all tiles.
    fraction: Option<f64>,
    /// What differs.
    findings: Vec<ReportedFinding>,
    /// The settings of the picture that its scene has otherwise.
    settings: Vec<ReportedSetting>,
}

/// A difference between the metadata and the facts.
#[derive(Serialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
struct ReportedFinding {
    /// The subject: `root`, `scene`, `settings`, `view`, `size`, `values`, `samples`
    /// or `file`.
    subject: &'static str,
    /// The number of the tile.
    tile: Option<u64>,
    /// The tile: x, y, width, height.
    area: Option<[u32; 4]>,
    /// The first pixel that differs.
    pixel: Option<[u32; 2]>,
    /// The value in the picture or its metadata.
    stated: String,
    /// The actual value.
    anew: String,
}

/// A setting of the picture that its scene has otherwise.
#[derive(Serialize, JsonSchema)]
struct ReportedSetting {
    /// Its name.
    name: String,
    /// Its value in the picture, as JSON.
    picture: String,
    /// Its value in the scene, as JSON.
    scene: String,
}

impl AuditReport {
    pub(super) fn new([picture, scene]: [&Path; 2], seed: u64, result: &AuditResult) -> Self {
        let setting = |[name, picture, scene]: &[String; 3]| ReportedSetting {
            name: name.clone(),
            picture: picture.clone(),
            scene: scene.clone(),
        };
        let fraction = |bound: u64| bound as f64 / result.all.max(1) as f64;
        Self {
            schema: "rtc-audit/1",
            picture: picture.display().to_string(),
            scene: scene.display().to_string(),
            passes: result.findings.is_empty(),
            seed: seed.to_string(),
            tiles: result.all,
            tile_pixels: result.film_tiles * 256,
            drawn: result.drawn.len() as u64,
            confidence: 1.0 - 1.0 / AUDIT_ODDS as f64,
            fewer_than: result.fewer_than,
            fraction: result.fewer_than.map(fraction),
            findings: result.findings.iter().map(ReportedFinding::of).collect(),
            settings: result.settings.iter().map(setting).collect(),
        }
    }

    /// The report as JSON.
    pub(super) fn json(&self) -> Result<String, Failure> {
        let text = serde_json::to_string_pretty(self);
        text.map(|text| text + "\n")
            .map_err(|error| Failure::Failed(error.to_string()))
    }

    /// The report for people.
    pub(super) fn to_text(&self) -> String {
        let Self {
            picture,
            seed,
            tiles,
            tile_pixels,
            drawn,
            findings,
            settings,
            ..
        } = self;
        let mut lines = Vec::new();
        let drawn = match drawn == tiles {
            true => format!("all {tiles} tiles"),
            false => format!("{drawn} of {tiles} tiles"),
        };
        let drawn = format!("{drawn} of {tile_pixels} pixels, rendered again (seed {seed})");
        lines.push(match (self.passes, tiles) {
            (true, _) => format!("{picture}: {drawn}, are the same"),
            (false, 0) => format!("{picture}: its metadata are wrong"),
            (false, _) if findings.iter().all(|finding| finding.subject == "file") => {
                format!("{picture}: {drawn}, are the same, but not its file")
            }
            (false, _) => format!("{picture}: {drawn}, and {} differ", findings.len()),
        });
        if let Some((bound, fraction)) = self.fewer_than.zip(self.fraction) {
            // Rounded up, so that the text promises no more than the value.
            let percent = (fraction * 1000.0).ceil() / 10.0;
            lines.push(match bound {
                1 => "so none differs".to_owned(),
                _ => format!("98 % sure that fewer than {percent} % of the tiles differ ({bound})"),
            });
        }
        lines.extend(findings.iter().take(MOST).map(ReportedFinding::to_text));
        lines.extend(more(findings.len()));
        if !settings.is_empty() {
            lines.push("settings of the picture that the scene has otherwise:".to_owned());
        }
        let line = |setting: &ReportedSetting| {
            let ReportedSetting {
                name,
                picture,
                scene,
            } = setting;
            match scene.as_str() {
                "null" => format!("  {name}: {picture}, not in the scene"),
                scene => format!("  {name}: {picture}, in the scene {scene}"),
            }
        };
        lines.extend(settings.iter().take(MOST).map(line));
        lines.extend(more(settings.len()));
        lines.join("\n") + "\n"
    }
}

/// The line for omitted entries.
fn more(count: usize) -> Option<String> {
    let more = count.checked_sub(MOST).filter(|more| *more > 0)?;
    Some(format!("  and {more} more (`--format json` has all)"))
}

impl ReportedFinding {
    fn of(finding: &AuditFinding) -> Self {
        let area = |area: Crop| [area.x, area.y, area.width, area.height];
        Self {
            subject: match finding.subject {
                AuditSubject::Root => "root",
                AuditSubject::Scene => "scene",
                AuditSubject::Settings => "settings",
                AuditSubject::View => "view",
                AuditSubject::Size => "size",
                AuditSubject::Values => "values",
                AuditSubject::Samples => "samples",
                AuditSubject::File => "file",
            },
            tile: finding.tile,
            area: finding.area.map(area),
            pixel: finding.pixel,
            stated: finding.stated.clone(),
            anew: finding.anew.clone(),
        }
    }

    fn to_text(&self) -> String {
        let Self {
            subject,
            tile,
            area,
            pixel,
            stated,
            anew,
        } = self;
        let location = match (tile, area) {
            (Some(tile), Some([x, y, ..])) => format!("tile {tile} at ({x}, {y}): "),
            _ => String::new(),
        };
        let pixel = pixel.map_or_else(String::new, |[x, y]| {
            format!(", first in column {x}, row {y}")
        });
        let what = match *subject {
            "root" => "the root of its hashes and its metadata",
            "scene" => "the hash of the scene, with the requested view and light",
            "settings" => "its settings",
            "view" => "its view",
            "size" => "its size",
            "file" => "the bytes of the file",
            "values" => "the hash of the values of which it was made",
            _ => "its pixels, by their hash",
        };
        format!("  {location}{what}{pixel}\n    in the file  {stated}\n    rendered     {anew}")
    }
}
