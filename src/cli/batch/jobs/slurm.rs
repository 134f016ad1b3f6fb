//! The job as scripts for Slurm: an array of parts, an array of pictures that waits for it, and a
//! script that submits both.

use super::FarmJob;

/// The scripts, by name.
pub(super) fn scripts(job: &FarmJob<'_>) -> [(&'static str, String); 3] {
    let tasks = job.tasks();
    let [first, last] = job.frames.range().unwrap_or([1, 1]);
    let part = job.commands.part("", "$frame", "$part");
    let names = [job.commands.name("$frame", "*")];
    let merge = job.commands.merge("", "$frame", &names);
    let fill = |text: &str| {
        let values = [
            ("@TITLE@", job.title.clone()),
            ("@TASKS@", tasks.to_string()),
            ("@PARTS@", job.parts.to_string()),
            ("@FIRST@", first.to_string()),
            ("@LAST@", last.to_string()),
            ("@THREADS@", job.threads.to_string()),
            ("@MEMORY@", job.memory.to_string()),
            ("@RETRIES@", job.retries.to_string()),
            ("@PART@", part.join(" ")),
            ("@MERGE@", merge.join(" ")),
        ];
        let fill = |text: String, (name, value): (&str, String)| text.replace(name, &value);
        values.into_iter().fold(text.to_owned(), fill)
    };
    [
        ("parts.sh", fill(include_str!("slurm-parts.sh"))),
        ("merge.sh", fill(include_str!("slurm-merge.sh"))),
        ("submit.sh", fill(include_str!("slurm-submit.sh"))),
    ]
}
