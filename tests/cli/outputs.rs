//! Where results go, and what signals do to those who write them.

use super::*;
use std::os::unix::fs::symlink;
use std::process::Child;

/// Waits until a process catches SIGINT: from then on a signal is polled.
pub(crate) fn until_it_listens(child: &mut Child) {
    let status = format!("/proc/{}/status", child.id());
    let listens = || {
        let text = fs::read_to_string(&status).unwrap_or_default();
        let mask = text
            .lines()
            .find_map(|line| line.strip_prefix("SigCgt:"))
            .map(str::trim)
            .unwrap_or("0");
        u64::from_str_radix(mask, 16).unwrap() & 2 != 0
    };
    while !listens() {
        assert!(
            child.try_wait().unwrap().is_none(),
            "it ended before it could be interrupted"
        );
        std::thread::yield_now();
    }
}

/// Waits until a process has computed for a while, which it does only once its output is looked at.
fn until_it_renders(child: &mut Child) {
    /// In hundredths of a second.
    const WHILE: u64 = 30;
    until_it_listens(child);
    let stat = format!("/proc/{}/stat", child.id());
    let computed = || {
        let text = fs::read_to_string(&stat).unwrap_or_default();
        let fields = text.rsplit(')').next().unwrap_or_default();
        let time = fields.split_whitespace().nth(11);
        time.map_or(0, |time| time.parse().unwrap())
    };
    while computed() < WHILE {
        assert!(child.try_wait().unwrap().is_none(), "it ended");
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
}

fn kill(child: &Child, signal: &str) {
    assert!(
        Command::new("kill")
            .args([signal, &child.id().to_string()])
            .status()
            .unwrap()
            .success()
    );
}

/// A soft light whose every point takes a shadow ray.
const SOFT: &str = "Camera: {eye: [0, 0, 50], center: [0, 0, 0], up: [0, 1, 0], viewSize: [1, 1]}\nShadows: true\n\
                    LightSamples: 4000000000\nMaxRecursionDepth: 2\n\
                    Lights:\n- {position: [30, 40, 60], color: [1, 1, 1], radius: 5}\nObjects:\n\
                    - {type: sphere, position: [0, 0, 0], radius: 10, material: {color: [1, 0, 0], ka: 0.2, kd: 0.7, \
                    ks: 1, n: 16, glossySamples: 1}}\n";

#[test]
#[cfg_attr(
    not(target_os = "linux"),
    ignore = "only Linux has the /proc and /dev this needs"
)]
fn a_signal_ends_a_pixel_that_would_last_for_years() {
    let folder = folder();
    fs::write(folder.path().join("soft.yaml"), SOFT).unwrap();
    // What mirrors must have something to show, or no lobe is followed.
    let background = "- {type: sphere, position: [0, 0, 90], radius: 20, material: {color: [0, 1, 0], ka: 1, kd: 0, ks: 0, n: 1}}\n";
    let glossy = SOFT
        .replace("glossySamples: 1", "glossySamples: 4000000000")
        .replace("4000000000\nMax", "1\nMax");
    fs::write(folder.path().join("glossy.yaml"), glossy + background).unwrap();
    let before = names(folder.path());
    let cases: [&[&str]; 5] = [
        &["soft.yaml"],
        &["glossy.yaml"],
        &["ball.json", "--size", "1x1", "--supersampling", "60000"],
        &[
            "ball.json",
            "--size",
            "1x1",
            "--integrator",
            "path",
            "--spp",
            "4000000000",
        ],
        &[
            "ball.json",
            "--size",
            "1x1",
            "--supersampling",
            "60000",
            "--verify-effects",
        ],
    ];
    let signals = [("-INT", 130), ("-TERM", 143)];
    for (case, (signal, code)) in cases.iter().zip(signals.into_iter().cycle()) {
        let args = [
            &[
                "render",
                "--allow-huge",
                "--threads",
                "1",
                "-q",
                "-o",
                "x.png",
            ],
            *case,
        ]
        .concat();
        let mut child = command(folder.path(), &args).spawn().unwrap();
        until_it_listens(&mut child);
        kill(&child, signal);
        assert_eq!(child.wait().unwrap().code(), Some(code), "{case:?}");
        assert_eq!(names(folder.path()), before, "{case:?}");
    }
}

#[test]
#[cfg_attr(
    not(target_os = "linux"),
    ignore = "only Linux has the /proc and /dev this needs"
)]
fn who_is_killed_while_rendering_leaves_no_draft() {
    let folder = folder();
    let before = names(folder.path());
    let args = [
        "render",
        "ball.json",
        "--size",
        "4000x3000",
        "--supersampling",
        "8",
        "--threads",
        "1",
        "--allow-huge",
    ];
    for _ in 0..3 {
        let mut child = command(folder.path(), &args)
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        until_it_renders(&mut child);
        kill(&child, "-KILL");
        child.wait().unwrap();
        assert_eq!(names(folder.path()), before);
    }
}

fn pipe(folder: &TempDir) {
    assert!(
        Command::new("mkfifo")
            .arg(folder.path().join("pipe.png"))
            .status()
            .unwrap()
            .success()
    );
}

#[test]
#[cfg_attr(
    not(target_os = "linux"),
    ignore = "only Linux has the /proc and /dev this needs"
)]
fn a_signal_ends_the_wait_for_a_reader() {
    let folder = folder();
    pipe(&folder);
    for args in [
        &["render", "ball.json", "-q", "-o", "pipe.png"][..],
        &["compile", "ball.json", "--emit", "ir", "-o", "pipe.png"],
    ] {
        let mut child = command(folder.path(), args).spawn().unwrap();
        until_it_listens(&mut child);
        kill(&child, "-INT");
        assert_eq!(child.wait().unwrap().code(), Some(130), "{args:?}");
    }
}

#[test]
fn a_pipe_gets_all_of_the_picture() {
    let folder = folder();
    pipe(&folder);
    // 600 × 600 pixels of noise-free shading are still more than a pipe holds.
    let args = [
        "render",
        "ball.json",
        "-q",
        "--size",
        "600x600",
        "--supersampling",
        "1",
        "-o",
    ];
    let mut child = command(folder.path(), &[&args[..], &["pipe.png"]].concat())
        .spawn()
        .unwrap();
    let piped = fs::read(folder.path().join("pipe.png")).unwrap();
    assert_eq!(child.wait().unwrap().code(), Some(0));
    assert!(piped == rtc(&folder, &[&args[..], &["-"]].concat()).stdout);
}

/// The text is more than a pipe holds, and nobody reads it.
#[test]
#[cfg_attr(
    not(target_os = "linux"),
    ignore = "only Linux has the /proc and /dev this needs"
)]
fn the_second_signal_ends_who_does_not_hear_the_first() {
    let folder = folder();
    let sphere = "    {\"shape\": {\"sphere\": {\"center\": [0, 0, 0], \"radius\": 10}}, \"material\": 0},\n";
    fs::write(
        folder.path().join("many.json"),
        scene_with(sphere, &sphere.repeat(5000)),
    )
    .unwrap();
    let mut child = command(folder.path(), &["compile", "many.json"])
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    until_it_listens(&mut child);
    kill(&child, "-INT");
    kill(&child, "-INT");
    while child.try_wait().unwrap().is_none() {
        // Two signals at once may come as one.
        let _ = Command::new("kill")
            .args(["-INT", &child.id().to_string()])
            .stderr(Stdio::null())
            .status();
    }
    assert_eq!(child.wait().unwrap().code(), Some(130));
}

#[test]
fn no_input_is_written_over() {
    let folder = folder();
    let textured = "Camera: {eye: [0, 0, 50], center: [0, 0, 0], up: [0, 1, 0], viewSize: [4, 4]}\nObjects:\n\
                    - {type: sphere, position: [0, 0, 0], radius: 1, material: {texture: t.png, ka: 1, kd: 1, ks: 0, n: 1}}\n\
                    - {type: mesh, file: m.obj, position: [0, 0, 0], scale: 1, material: {color: [1, 1, 1], ka: 1, kd: 1, \
                    ks: 0, n: 1}}\n";
    fs::write(folder.path().join("scene.yaml"), textured).unwrap();
    fs::write(
        folder.path().join("m.obj"),
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
    )
    .unwrap();
    assert_eq!(
        code(&rtc(&folder, &["render", "ball.json", "-q", "-o", "t.png"])),
        0
    );
    symlink("t.png", folder.path().join("link.png")).unwrap();
    let read = |name: &str| fs::read(folder.path().join(name)).unwrap();
    let before = ["scene.yaml", "m.obj", "t.png", "ball.json"].map(read);
    let cases: [&[&str]; 8] = [
        &["render", "scene.yaml", "-o", "t.png"],
        &["render", "scene.yaml", "-o", "./././t.png"],
        &["render", "scene.yaml", "-o", "link.png"],
        &["render", "scene.yaml", "--bits", "8", "-o", "m.obj"],
        &["compile", "scene.yaml", "-o", "scene.yaml"],
        &["compile", "scene.yaml", "--emit", "ir", "-o", "m.obj"],
        &[
            "compile",
            "ball.json",
            "-o",
            "../../../../../../../../../proc/self/cwd/ball.json",
        ],
        &["cost", "ball.json", "-o", "x.txt", "--html", "ball.json"],
    ];
    for args in cases {
        let refused = rtc(&folder, args);
        assert_eq!(code(&refused), 2, "{args:?}: {}", stderr(&refused));
        assert!(
            args.contains(&"m.obj") || stderr(&refused).contains(": it is an input of this run\n"),
            "{args:?}"
        );
        assert!(
            ["scene.yaml", "m.obj", "t.png", "ball.json"].map(read) == before,
            "{args:?}"
        );
    }
    assert_eq!(
        code(&rtc(&folder, &["render", "scene.yaml", "-o", "other.png"])),
        0
    );
}

/// What `sh` makes of a line in which `RTC` is the program.
fn sh(folder: &TempDir, line: &str) -> Output {
    let line = line.replace("RTC", env!("CARGO_BIN_EXE_rtc"));
    Command::new("sh")
        .current_dir(folder.path())
        .args(["-c", &line])
        .output()
        .unwrap()
}

/// As whoever starts a program opens what ignores its output: `stdio: "ignore"` of Node all
/// streams, `stdout=DEVNULL` of Python one, to be read and written.
#[test]
fn an_output_that_is_ignored_is_written() {
    let folder = folder();
    for streams in [
        "<>/dev/null 1<>/dev/null",
        "1<>/dev/null",
        ">/dev/null",
        "</dev/null 1<>/dev/null",
    ] {
        for command in ["compile ball.json", "render -q ball.json -o -"] {
            let ignored = sh(&folder, &format!("RTC {command} {streams}"));
            assert_eq!(
                (code(&ignored), stderr(&ignored).as_str()),
                (0, ""),
                "{streams}"
            );
        }
    }
    assert_eq!(code(&sh(&folder, "RTC compile ball.json -o x.json >&-")), 0);
}

/// Standard output by the names of the system, whatever it is.
#[test]
#[cfg_attr(not(target_os = "linux"), ignore = "only Linux has this /proc")]
fn standard_output_has_names() {
    let folder = folder();
    let wanted = rtc(&folder, &["render", "-q", "ball.json", "-o", "-"]).stdout;
    let before = fs::symlink_metadata("/dev/stdout").unwrap().is_symlink();
    for name in ["/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"] {
        let piped = sh(&folder, &format!("RTC render -q ball.json -o {name} | cat"));
        assert!(piped.stdout == wanted, "{name}: {}", stderr(&piped));
        let line = format!("RTC render -q ball.json -o {name} > x.png");
        assert_eq!(code(&sh(&folder, &line)), 0);
        assert!(
            fs::read(folder.path().join("x.png")).unwrap() == wanted,
            "{name}"
        );
    }
    let is_link = fs::symlink_metadata("/dev/stdout").unwrap().is_symlink();
    assert_eq!(is_link, before);
}

#[test]
#[cfg_attr(
    not(target_os = "linux"),
    ignore = "only Linux has the /proc and /dev this needs"
)]
fn messages_name_the_output_and_not_the_draft() {
    let folder = folder();
    let args = ["compile", "ball.json", "--emit", "ir", "-o", "/dev/full"];
    assert_eq!(
        stderr(&rtc(&folder, &args)),
        "error: can't write `/dev/full`: No space left on device (os error 28)\n"
    );
    let before = names(folder.path());
    // Whether who started it ignores the signal of the limit or not, nothing half-written stays
    // behind.
    for ignores in ["trap '' XFSZ;", ""] {
        for command in ["render -q ball.json", "compile ball.json --emit ir"] {
            let line = format!("{ignores} ulimit -f 0; exec RTC {command} -o x.png");
            let large = sh(&folder, &line);
            let said = stderr(&large);
            assert!(
                said.contains("can't write `x.png") && said.contains("File too large"),
                "{line}: {said}"
            );
            assert_eq!((code(&large), names(folder.path())), (2, before.clone()));
        }
    }
}

/// A folder that becomes a link while the picture is made is not written through.
#[test]
fn a_folder_that_is_swapped_for_a_link_gets_no_picture() {
    let (folder, elsewhere) = (folder(), tempfile::tempdir().unwrap());
    let path = |name: &str| folder.path().join(name);
    fs::create_dir(path("out")).unwrap();
    let slow = ["--size", "900x675", "--supersampling", "8"];
    let args = [&["render", "ball.json", "-o", "out/a.png"][..], &slow].concat();
    let mut child = command(folder.path(), &args)
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    until_it_renders(&mut child);
    fs::rename(path("out"), path("gone")).unwrap();
    symlink(elsewhere.path(), path("out")).unwrap();
    let output = child.wait_with_output().unwrap();
    assert_eq!(code(&output), 2, "{}", stderr(&output));
    assert!(
        stderr(&output).contains("its folder was replaced"),
        "{}",
        stderr(&output)
    );
    assert_eq!(names(elsewhere.path()), Vec::<String>::new());
    assert_eq!(names(&path("gone")), Vec::<String>::new());
}

#[test]
fn an_interrupt_tells_of_checkpoints() {
    let folder = folder();
    let slow = [
        "render",
        "ball.json",
        "--size",
        "2000x1500",
        "--supersampling",
        "16",
    ];
    for (more, is_told) in [(&[][..], true), (&["--checkpoint", "c.rtp"], false)] {
        let mut command = command(folder.path(), &[&slow, more].concat());
        let mut child = command.stderr(Stdio::piped()).spawn().unwrap();
        until_it_renders(&mut child);
        kill(&child, "-INT");
        let output = child.wait_with_output().unwrap();
        assert_eq!(code(&output), 130);
        let said = stderr(&output);
        assert_eq!(said.contains("with `--checkpoint FILE`"), is_told, "{said}");
    }
}
