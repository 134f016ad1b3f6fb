//! The job as a driver for Dask, in Python.

use super::FarmJob;
use serde_json::json;

/// The driver. Its lists are JSON too.
pub(super) fn driver(job: &FarmJob<'_>) -> String {
    let part = job.commands.part("", "{frame}", "{part}");
    let merge = job
        .commands
        .merge("", "{frame}", &job.commands.names("{frame}"));
    let values = [
        ("@TITLE@", job.title.clone()),
        ("@PART@", json!(part).to_string()),
        ("@MERGE@", json!(merge).to_string()),
        ("@PARTS@", job.parts.to_string()),
        ("@FRAMES@", json!(job.frames.names()).to_string()),
        ("@RETRIES@", job.retries.to_string()),
    ];
    let fill = |text: String, (name, value): (&str, String)| text.replace(name, &value);
    let text = include_str!("dask.py").to_owned();
    values.into_iter().fold(text, fill)
}
