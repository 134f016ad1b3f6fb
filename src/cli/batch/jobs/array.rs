//! The job as one array of tasks, each of which merges what it can: an indexed Job of Kubernetes.

use super::FarmJob;
use serde_json::{Value, json};

/// The number of parts that are merged at once: 4096 parts take three levels.
const GROUP: u32 = 16;

/// Where the folder of the job is mounted.
const MOUNT: &str = "/job";

/// The name of the job and of its volume claim.
const NAME: &str = "rtc-job";

/// The program in its version.
const IMAGE: &str = concat!("rtc:", env!("CARGO_PKG_VERSION"));

/// The files of a Job of Kubernetes (`batch/v1`).
pub(super) fn kubernetes(job: &FarmJob<'_>) -> Vec<(&'static str, String)> {
    let memory = format!("{}Gi", job.memory);
    let container = json!({
        "name": "rtc",
        "image": IMAGE,
        "command": command(),
        "resources": {
            "requests": {"cpu": job.threads.to_string(), "memory": memory},
            "limits": {"memory": memory},
        },
        "volumeMounts": [{"name": "job", "mountPath": MOUNT}],
    });
    let template = json!({
        "apiVersion": "batch/v1",
        "kind": "Job",
        "metadata": {"name": NAME, "annotations": {"rtc/title": job.title}},
        "spec": {
            "completionMode": "Indexed",
            "completions": job.tasks(),
            "parallelism": job.tasks(),
            "backoffLimitPerIndex": job.retries,
            "template": {"spec": {
                "restartPolicy": "Never",
                "containers": [container],
                "volumes": [{"name": "job", "persistentVolumeClaim": {"claimName": NAME}}],
            }},
        },
    });
    vec![("job.json", text(&template)), ("task.sh", task(job))]
}

fn command() -> [String; 2] {
    ["sh".to_owned(), format!("{MOUNT}/task.sh")]
}

fn text(value: &Value) -> String {
    format!("{value:#}\n")
}

/// The script of each task.
fn task(job: &FarmJob<'_>) -> String {
    let [first, _] = job.frames.range().unwrap_or([1, 1]);
    let mut merge = job.commands.merge("", "$frame", &["\"$@\"".to_owned()]);
    // The last argument is where the merged file goes.
    merge.pop();
    merge.push("\"$to\"".to_owned());
    let values = [
        ("@TITLE@", job.title.clone()),
        ("@GROUP@", GROUP.to_string()),
        ("@PARTS@", job.parts.to_string()),
        ("@FIRST@", first.to_string()),
        ("@NAME@", job.commands.name("$frame", "$part")),
        ("@PART@", job.commands.part("", "$frame", "$part").join(" ")),
        ("@PICTURE@", job.commands.output("$frame")),
        ("@MERGE@", merge.join(" ")),
    ];
    let script = include_str!("array-task.sh").to_owned();
    let fill = |text: String, (name, value): (&str, String)| text.replace(name, &value);
    values.into_iter().fold(script, fill)
}
