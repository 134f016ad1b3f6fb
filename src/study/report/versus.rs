//! The comparison of a scene with its reference, for a terminal.

use super::super::advice::{digits, seconds};
use super::super::versus::{DifferentTile, SceneComparison};
use super::table::count;
use std::fmt::Write;

/// The maximum number of listed tiles.
const MAX_LISTED: usize = 5;

/// The comparison as text.
#[must_use]
pub fn versus_table(versus: &SceneComparison) -> String {
    // Write the subjects of the comparison.
    let mut text = String::new();
    for (which, about) in ["scene    ", "reference"].iter().zip(&versus.scenes) {
        let _ = writeln!(text, "{which}  {}  {}", about.hash, about.scene);
    }
    let [width, height] = versus.part.size;
    let coverage = match versus.part.tiles {
        0 => String::new(),
        tiles => format!(
            ", of which {tiles} random tiles are rendered ({} %)",
            digits(100.0 * versus.part.fraction)
        ),
    };
    let _ = writeln!(text, "{width}×{height} pixels{coverage}\n");
    // Write time, rays and noise of both scenes.
    text += "             scene      reference  ratio\n";
    let fraction = versus.part.fraction;
    let rays = versus.rays.map(|rays| count(rays.all() as f64 / fraction));
    let off = format!(" ± {:.1} %", 100.0 * versus.time.relative());
    let rows = [
        (
            "time",
            versus.seconds.map(|time| seconds(time.value)),
            versus.time.value,
            off,
        ),
        ("rays", rays, versus.ratio_of_rays(), String::new()),
        (
            "noise",
            versus.noise.map(digits),
            versus.ratio_of_noise(),
            "  grey levels, of one render with random samples".to_owned(),
        ),
    ];
    for (name, [scene, reference], ratio, label) in rows {
        let _ = writeln!(text, "{name:13}{scene:11}{reference:11}{ratio:.2}×{label}");
    }
    // Write the difference.
    text += &format!("\n{}{}", difference(versus), tiles(versus));
    if versus.wall_over_cpu > 1.2 {
        let times = versus.wall_over_cpu;
        let _ = writeln!(
            text,
            "The machine was busy (wall time {times:.1}× processor time); these are processor \
             times."
        );
    }
    text
}

fn difference(versus: &SceneComparison) -> String {
    let error = versus.error;
    if versus.rendered == 0.0 {
        return "The pictures are the same, to the last bit of the rendered part.\n".to_owned();
    }
    format!(
        "The pictures differ by {} grey levels as they are rendered; beyond noise by {} ({} … \
         {}).\n",
        digits(versus.rendered),
        digits(error.value),
        digits(error.low),
        digits(error.high)
    )
}

fn tiles(versus: &SceneComparison) -> String {
    let (count, all) = (versus.different.len(), versus.tested);
    if count == 0 {
        return format!(
            "No tile of {all} differs significantly (5 % false positives for all together).\n"
        );
    }
    let mut text = format!(
        "{count} of {all} tiles differ significantly (5 % false positives for all together){}\n",
        if count > MAX_LISTED {
            "; the most different:"
        } else {
            ":"
        }
    );
    for tile in versus.different.iter().take(MAX_LISTED) {
        let DifferentTile {
            at: [x, y],
            size: [width, height],
            levels,
            deviations: _,
        } = tile;
        let (right, bottom, levels) = (x + width - 1, y + height - 1, digits(*levels));
        let _ = writeln!(
            text,
            "  columns {x} to {right}, rows {y} to {bottom}: by {levels} grey levels in the mean"
        );
    }
    text
}
