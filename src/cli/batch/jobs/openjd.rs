//! The job as a template of Open Job Description, `jobtemplate-2023-09`.

use super::FarmJob;
use serde_json::{Value, json};

const FRAME: &str = "{{Task.Param.Frame}}";

/// The template: a step for the parts, and one for the pictures, which waits for it.
pub(super) fn template(job: &FarmJob<'_>) -> String {
    let folder = "{{Param.Folder}}/";
    let parts = job.commands.part(folder, FRAME, "{{Task.Param.Part}}");
    let merge = job
        .commands
        .merge(folder, FRAME, &job.commands.names(FRAME));
    let part = json!({"name": "Part", "type": "INT", "range": format!("1-{}", job.parts)});
    // As text, so that names keep their zeros.
    let frame = json!({"name": "Frame", "type": "STRING", "range": job.frames.names()});
    let frame = job.frames.range().map(|_| frame);
    let all: Vec<Value> = frame.clone().into_iter().chain([part]).collect();
    let mut merging = json!({
        "name": "Merge",
        "dependencies": [{"dependsOn": "Parts"}],
        "script": script(merge),
        "hostRequirements": needs(1, job.memory),
    });
    if let Some(frame) = frame {
        merging["parameterSpace"] = json!({"taskParameterDefinitions": [frame]});
    }
    let template = json!({
        "specificationVersion": "jobtemplate-2023-09",
        "name": format!("rtc {}", job.picture),
        "description": job.title,
        "parameterDefinitions": [
            {"name": "Folder", "type": "PATH", "objectType": "DIRECTORY", "dataFlow": "INOUT", "default": "."},
            {"name": "Rtc", "type": "STRING", "default": "rtc"},
        ],
        "steps": [
            {
                "name": "Parts",
                "parameterSpace": {"taskParameterDefinitions": all},
                "script": script(parts),
                "hostRequirements": needs(job.threads, job.memory),
            },
            merging,
        ],
    });
    format!("{template:#}\n")
}

fn script(args: Vec<String>) -> Value {
    json!({"actions": {"onRun": {"command": "{{Param.Rtc}}", "args": args}}})
}

/// Cores, and memory in GiB.
fn needs(cores: u16, memory: u32) -> Value {
    json!({"amounts": [
        {"name": "amount.worker.vcpu", "min": cores},
        {"name": "amount.worker.memory", "min": u64::from(memory) * 1024},
    ]})
}
