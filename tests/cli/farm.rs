//! Jobs for engines: the folder is complete, and the commands in the job, run here in their order,
//! give the bytes of one process.

use super::parts::{bytes, reported, scenes};
use super::*;
use serde_json::Value;

/// Pictures, and how the scene of each is shown: by its samples, by its size, all around, in the
/// light of a sun, and of what has no light.
const JOBS: [(&str, &[&str]); 5] = [
    ("a.exr", &["paths.json", "--spp", "32", "--aov", "normal"]),
    (
        "b.png",
        &["ball.json", "--size", "33x20", "--exposure=-0.5"],
    ),
    (
        "c.png",
        &[
            "ball.json",
            "--sun",
            "1,1,1,2",
            "--spp",
            "3",
            "--tonemap",
            "agx",
        ],
    ),
    (
        "d.exr",
        &[
            "paths.json",
            "--no-scene-lights",
            "--studio",
            "off",
            "--crop",
            "5,5,20,20",
        ],
    ),
    (
        "e.png",
        &[
            "paths.json",
            "--no-scene-lights",
            "--exposure",
            "auto",
            "--bits",
            "16",
        ],
    ),
];

/// Makes a job in the folder `job`.
fn farm(folder: &TempDir, engine: &str, picture: &str, words: &[&str]) {
    let job = ["--to", engine, "--picture", picture, "-o", "job"];
    reported(folder, &[&["farm"], words, &job].concat());
}

/// Runs a command of a job in its folder.
fn run(folder: &TempDir, words: &[String]) {
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let output = command(&folder.path().join("job"), &words)
        .output()
        .unwrap();
    assert_eq!(code(&output), 0, "{words:?}: {}", stderr(&output));
}

fn filled(words: &Value, pairs: &[(&str, &str)]) -> Vec<String> {
    let words = words.as_array().unwrap().iter();
    let fill = |word: &Value| {
        let word = word.as_str().unwrap().to_owned();
        pairs
            .iter()
            .fold(word, |word, (name, value)| word.replace(name, value))
    };
    words.map(fill).collect()
}

/// Runs all tasks of an OpenJD template, in the order of its steps.
fn run_openjd(folder: &TempDir) {
    let job: Value = serde_json::from_slice(&bytes(folder, "job/template.json")).unwrap();
    assert_eq!(job["specificationVersion"], "jobtemplate-2023-09");
    assert_eq!(job["steps"][1]["dependencies"][0]["dependsOn"], "Parts");
    for step in job["steps"].as_array().unwrap() {
        let space = step["parameterSpace"]["taskParameterDefinitions"].as_array();
        let values = |name: &str| -> Vec<String> {
            let all = space.into_iter().flatten();
            let range = all
                .filter(|it| it["name"] == name)
                .map(|it| &it["range"])
                .next();
            match range {
                Some(Value::Array(list)) => list
                    .iter()
                    .map(|it| it.as_str().unwrap().to_owned())
                    .collect(),
                Some(range) => {
                    let (first, last) = range.as_str().unwrap().split_once('-').unwrap();
                    (first.parse().unwrap()..=last.parse::<u32>().unwrap())
                        .map(|part| part.to_string())
                        .collect()
                }
                None => vec![String::new()],
            }
        };
        let run_of = &step["script"]["actions"]["onRun"];
        assert_eq!(run_of["command"], "{{Param.Rtc}}");
        for frame in values("Frame") {
            for part in values("Part") {
                let pairs = [
                    ("{{Param.Folder}}", "."),
                    ("{{Task.Param.Frame}}", &frame),
                    ("{{Task.Param.Part}}", &part),
                ];
                run(folder, &filled(&run_of["args"], &pairs));
            }
        }
    }
}

/// Runs the scripts for Slurm as its tasks do.
#[cfg(unix)]
fn run_slurm(folder: &TempDir) {
    for name in ["parts.sh", "merge.sh"] {
        let path = folder.path().join("job").join(name);
        let text = fs::read_to_string(&path).unwrap();
        let array = text
            .lines()
            .find_map(|line| line.strip_prefix("#SBATCH --array="));
        let (first, last) = array.unwrap().split_once('-').unwrap();
        for task in first.parse::<u32>().unwrap()..=last.parse().unwrap() {
            let output = Command::new("sh")
                .arg(&path)
                .current_dir(folder.path().join("job"))
                .env("RTC", env!("CARGO_BIN_EXE_rtc"))
                .env("SLURM_ARRAY_TASK_ID", task.to_string())
                .output()
                .unwrap();
            assert_eq!(code(&output), 0, "{name} {task}: {}", stderr(&output));
        }
    }
}

/// Runs the tasks of an array, the last ones first, and the first once more.
#[cfg(unix)]
fn run_array(folder: &TempDir, tasks: u64) {
    for task in (0..tasks).rev().chain([0]) {
        let output = Command::new("sh")
            .arg(folder.path().join("job/task.sh"))
            .env("RTC", env!("CARGO_BIN_EXE_rtc"))
            .env("JOB_COMPLETION_INDEX", task.to_string())
            .output()
            .unwrap();
        assert_eq!(code(&output), 0, "{task}: {}", stderr(&output));
    }
}

/// The facts of `batch/v1` that an indexed Job must keep, and its tasks.
#[cfg(unix)]
fn run_kubernetes(folder: &TempDir) {
    let job: Value = serde_json::from_slice(&bytes(folder, "job/job.json")).unwrap();
    assert_eq!([&job["apiVersion"], &job["kind"]], ["batch/v1", "Job"]);
    let spec = &job["spec"];
    assert_eq!(spec["completionMode"], "Indexed");
    let pod = &spec["template"]["spec"];
    // Retries of an index need pods that are not restarted in place.
    assert!(spec["backoffLimitPerIndex"].is_u64() && pod["restartPolicy"] == "Never");
    let container = &pod["containers"][0];
    let mount = &container["volumeMounts"][0];
    assert_eq!(mount["name"], pod["volumes"][0]["name"]);
    let script = format!("{}/task.sh", mount["mountPath"].as_str().unwrap());
    assert_eq!(container["command"], serde_json::json!(["sh", script]));
    // Quantities are texts.
    assert!(container["resources"]["requests"]["cpu"].is_string());
    run_array(folder, spec["completions"].as_u64().unwrap());
}

/// More parts than one group merges, and one alone.
#[test]
#[cfg(unix)]
fn tasks_of_an_array_merge_as_a_tree() {
    let folder = scenes();
    let words = ["ball.json", "--size", "100x80"];
    reported(
        &folder,
        &[&["render"], &words[..], &["-o", "a.png"]].concat(),
    );
    for parts in ["35", "1"] {
        farm(
            &folder,
            "kubernetes",
            "a.png",
            &[&words[..], &["--parts", parts]].concat(),
        );
        run_kubernetes(&folder);
        assert!(
            bytes(&folder, "job/a.png") == bytes(&folder, "a.png"),
            "{parts}"
        );
        let made = names(&folder.path().join("job"));
        let nodes = made
            .iter()
            .filter(|name| name.starts_with("merged-"))
            .count();
        assert_eq!(nodes, if parts == "1" { 0 } else { 3 });
        fs::remove_dir_all(folder.path().join("job")).unwrap();
    }
    let many = [
        "farm",
        "ball.json",
        "--to",
        "kubernetes",
        "--turntable",
        "2",
        "--parts",
        "65536",
        "-o",
        "job",
    ];
    assert!(stderr(&rtc(&folder, &many)).contains("at most 100000 tasks"));
}

/// Runs the commands of a driver for Dask in their order.
fn run_dask(folder: &TempDir) {
    let text = String::from_utf8(bytes(folder, "job/run.py")).unwrap();
    let value = |name: &str| -> Value {
        let lines = &mut text.lines();
        let line = lines.find_map(|line| line.strip_prefix(name)?.strip_prefix(" = "));
        serde_json::from_str(line.unwrap()).unwrap()
    };
    for frame in value("FRAMES").as_array().unwrap() {
        let frame = ("{frame}", frame.as_str().unwrap());
        for part in 1..=value("PARTS").as_u64().unwrap() {
            run(
                folder,
                &filled(&value("PART"), &[frame, ("{part}", &part.to_string())]),
            );
        }
        run(folder, &filled(&value("MERGE"), &[frame]));
    }
}

/// The command of one process, as the README tells it.
fn whole_command(folder: &TempDir) -> Vec<String> {
    let readme = String::from_utf8(bytes(folder, "job/README")).unwrap();
    let (_, command) = readme.split_once("is that of `rtc ").unwrap();
    let (command, _) = command.split_once('`').unwrap();
    command.split(' ').map(str::to_owned).collect()
}

#[test]
fn the_commands_of_a_job_give_the_bytes_of_one_process() {
    for (at, (picture, words)) in JOBS.into_iter().enumerate() {
        let folder = scenes();
        reported(&folder, &[&["render"], words, &["-o", picture]].concat());
        let parts = (2 + at).to_string();
        let by = if at == 0 { "samples" } else { "tiles" };
        let share = ["--parts", &parts, "--parts-by", by];
        farm(&folder, "openjd", picture, &[words, &share].concat());
        // The scene is in the job.
        fs::remove_file(folder.path().join(words[0])).unwrap();
        let made = format!("job/{picture}");
        let whole = bytes(&folder, picture);
        run(&folder, &whole_command(&folder));
        assert!(bytes(&folder, &made) == whole, "{words:?}");
        fs::remove_file(folder.path().join(&made)).unwrap();
        run_openjd(&folder);
        assert!(bytes(&folder, &made) == whole, "{words:?}");
    }
}

/// An engine, what runs its job here, and the files of its job.
type Tried<'a> = (&'a str, fn(&TempDir), &'a [&'a str]);

#[test]
fn each_engine_runs_all_frames_of_a_turntable_in_parts() {
    let words = ["paths.json", "--turntable", "12", "--size", "24x18"];
    let folder = scenes();
    reported(
        &folder,
        &[&["render"], &words[..], &["-o", "all.png"]].concat(),
    );
    let engines: &[Tried] = &[
        ("openjd", run_openjd, &["template.json"]),
        #[cfg(unix)]
        ("slurm", run_slurm, &["merge.sh", "parts.sh", "submit.sh"]),
        ("dask", run_dask, &["run.py"]),
        #[cfg(unix)]
        ("kubernetes", run_kubernetes, &["job.json", "task.sh"]),
    ];
    for (engine, run, files) in engines {
        let some = ["--frames", "11..12", "--parts", "3"];
        farm(&folder, engine, "all.png", &[&words[..], &some].concat());
        let mut expected = vec!["README", "scene.rtir"];
        expected.extend(*files);
        expected.sort_unstable();
        assert_eq!(names(&folder.path().join("job")), expected, "{engine}");
        let readme = String::from_utf8(bytes(&folder, "job/README")).unwrap();
        assert_eq!(readme.lines().count(), 3, "{readme}");
        run(&folder);
        for frame in ["all-0011.png", "all-0012.png"] {
            let merged = bytes(&folder, &format!("job/{frame}"));
            assert!(merged == bytes(&folder, frame), "{engine} {frame}");
        }
        fs::remove_dir_all(folder.path().join("job")).unwrap();
    }
}

#[test]
fn frames_of_an_animation_are_scenes_of_their_own() {
    let folder = scenes();
    let asset = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/render/asset/animation.gltf");
    fs::copy(asset, folder.path().join("a.gltf")).unwrap();
    let words = ["a.gltf", "--size", "24x18", "--spp", "2"];
    let some = ["--frames", "2..3", "--fps", "4", "--parts", "2"];
    farm(&folder, "openjd", "a.png", &[&words[..], &some].concat());
    run_openjd(&folder);
    let mut pictures = Vec::new();
    for (time, picture) in [("0.25", "a-0002.png"), ("0.5", "a-0003.png")] {
        let still = ["--time", time, "-o", picture];
        reported(&folder, &[&["render"], &words[..], &still].concat());
        pictures.push(bytes(&folder, picture));
        assert!(bytes(&folder, &format!("job/{picture}")) == pictures[pictures.len() - 1]);
    }
    assert!(pictures[0] != pictures[1], "nothing moves");
}

#[test]
fn the_folder_appears_whole_or_not_at_all() {
    let folder = scenes();
    let farm = |words: &[&str]| {
        let words = [&["farm", "--to", "slurm", "-o", "job"], words].concat();
        let output = rtc(&folder, &words);
        (code(&output), stderr(&output))
    };
    let before = names(folder.path());
    let refused = |words: &[&str], expected: i32, reason: &str| {
        let (code, reported) = farm(words);
        assert_eq!(code, expected, "{words:?}: {reported}");
        assert!(reported.contains(reason), "{words:?}: {reported}");
        assert_eq!(names(folder.path()), before, "{words:?}");
    };
    refused(&["bad.json"], 1, "radius");
    refused(&["none.json"], 2, "none.json");
    refused(&["ball.json", "--picture", "a.gif"], 2, ".exr or .hdr");
    refused(&["ball.json", "--picture", "b/a.png"], 2, "letters, digits");
    refused(
        &["ball.json", "--picture", "$(a).png"],
        2,
        "letters, digits",
    );
    refused(&["ball.json", "--picture=-a.png"], 2, "letters, digits");
    refused(
        &["ball.json", "--parts-by", "samples"],
        2,
        "only pictures of traced paths",
    );
    refused(
        &["ball.json", "--crop", "100,100,9,9"],
        2,
        "outside the picture",
    );
    refused(
        &["ball.json", "--turntable", "3", "--frames", "2..4"],
        2,
        "there is no frame 4",
    );
    refused(&["ball.json", "--frames", "2..4"], 2, "`--turntable N`");
    refused(
        &["-", "--frames", "2..4", "--fps", "9"],
        2,
        "name of its file",
    );
    // An empty folder is filled, one with files is not touched.
    fs::create_dir(folder.path().join("job")).unwrap();
    assert_eq!(farm(&["ball.json"]), (0, farm_told()));
    let made = names(&folder.path().join("job"));
    let scene = bytes(&folder, "job/scene.rtir");
    let (code, reported) = farm(&["away.json"]);
    assert_eq!(code, 2);
    assert!(reported.contains("can't make `job`"), "{reported}");
    assert_eq!(names(&folder.path().join("job")), made);
    assert!(bytes(&folder, "job/scene.rtir") == scene);
}

fn farm_told() -> String {
    "job: picture.png in 64 parts; in the folder, `sh submit.sh` runs them\n".to_owned()
}

#[test]
fn a_part_of_a_turntable_is_of_one_frame() {
    let folder = scenes();
    let words = ["render", "ball.json", "--turntable", "5", "--part", "1/2"];
    let output = rtc(&folder, &words);
    assert_eq!(code(&output), 2);
    assert!(
        stderr(&output).contains("--frames 3..3"),
        "{}",
        stderr(&output)
    );
    let some = [
        "render",
        "ball.json",
        "--turntable",
        "5",
        "--frames",
        "2..3",
    ];
    reported(&folder, &[&some[..], &["-o", "x.png"]].concat());
    let rendered = names(folder.path());
    let rendered: Vec<_> = rendered
        .iter()
        .filter(|name| name.starts_with('x'))
        .collect();
    assert_eq!(rendered, ["x-0002.png", "x-0003.png"]);
}
