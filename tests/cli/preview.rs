//! `rtc preview`, by requests as they stand on the wire: who may come in, what is shown, what is
//! changed.

use super::running::Running;
use super::*;
use serde_json::{Value, json};
use std::net::TcpStream;

/// A small scene with its camera in keys, a slip that has one reading and one that needs a guess.
const TYPED: &str = "# A ball.\nCamera:\n  eye: [0, 0, 50] # far away\n  center: [0, 0, 0]\n  up: [0, 1, 0]\n  \
viewSize: [12, 8]\nShadws: true\nLights: [{position: [9, 9, 90], color: [1, 1, 1]}]\nObjects:\n\
- {type: sphere, position: [0, 0, 0], radius: '3', material: {color: [1, 0, 0], ka: 1, kd: 0, ks: 0, n: 1}}\n";

fn typed(text: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.yaml"), text).unwrap();
    folder
}

pub(super) fn rendered(folder: &TempDir, args: &[&str]) -> Vec<u8> {
    let output = rtc(folder, &[&["render", "-q", "-o", "-"], args].concat());
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    output.stdout
}

/// The picture of the command that is said to render what is shown.
pub(super) fn commanded(folder: &TempDir, state: &Value) -> Vec<u8> {
    let words = state["command"].as_str().unwrap();
    let words: Vec<_> = words
        .strip_prefix("rtc render ")
        .unwrap()
        .split(' ')
        .collect();
    rendered(folder, &words)
}

#[test]
fn strangers_are_told_nothing() {
    let folder = folder();
    let live = Running::start(&folder, &["ball.json", "--size", "4x3"]);
    let (host, token) = (live.host(), live.token.clone());
    let other = live.token.replace(|c| c != '0', "0");
    let own = format!("GET /?token={token}");
    let foreign = "Origin: http://example.com\r\n";
    let two_hosts = format!("Host: {host}\r\n");
    for (line, host, more) in [
        ("GET /", host.as_str(), ""),
        (&format!("GET /?token={other}"), &host, ""),
        ("GET /?token=", &host, ""),
        (&format!("GET /?token={token}0"), &host, ""),
        (&format!("{own}&token={token}"), &host, ""),
        (&own, "example.com", ""),
        (&own, "127.0.0.1", ""),
        (&own, &format!("127.0.0.1.example.com:{}", live.port), ""),
        (&own, &host, &two_hosts),
        (&own, &host, foreign),
        (&own, &host, "Origin: null\r\n"),
        (&format!("POST /fix?token={token}"), &host, foreign),
        ("GET /../Cargo.toml", &host, ""),
    ] {
        let refused = live.ask(line, host, more);
        assert_eq!(
            (refused.status, refused.body.len()),
            (403, 0),
            "{line} {host} {more}"
        );
    }
    let bare = live.raw(format!("{own} HTTP/1.0\r\n\r\n").as_bytes());
    assert_eq!(bare.status, 403, "a request without a host");
    for origin in [&host, &format!("localhost:{}", live.port)] {
        let lines = format!("Origin: http://{origin}\r\n");
        assert_eq!(live.ask(&own, origin, &lines).status, 200, "{origin}");
    }
    for path in [
        "/..",
        "/../Cargo.toml",
        "/ball.json",
        "/%2e%2e/",
        "//",
        "/events/",
    ] {
        assert_eq!(live.get(path, "").status, 404, "{path}");
    }
}

#[test]
fn the_page_needs_nothing_else_and_stands_in_no_page_of_the_web() {
    let folder = folder();
    let live = Running::start(&folder, &["ball.json", "--size", "4x3"]);
    let page = live.get("/", "");
    let head = page.head.as_str();
    for line in [
        "X-Content-Type-Options: nosniff\r\n",
        "Cache-Control: no-store\r\n",
        "Referrer-Policy: no-referrer\r\n",
        "Cross-Origin-Resource-Policy: same-origin\r\n",
        "Cross-Origin-Opener-Policy: same-origin\r\n",
        "Content-Security-Policy: default-src 'none'; ",
    ] {
        // A space before a name would make the line a part of the header above it.
        assert!(head.contains(&format!("\r\n{line}")), "{head}");
    }
    assert!(
        head.contains("; frame-ancestors vscode-file: vscode-webview:;"),
        "{head}"
    );
    let text = String::from_utf8(page.body).unwrap();
    let nonce = head.split("script-src 'nonce-").nth(1).unwrap();
    let nonce = nonce.split('\'').next().unwrap();
    assert_eq!(text.matches(&format!("nonce=\"{nonce}\"")).count(), 2);
    assert!(!head.contains("unsafe") && !text.contains("://") && !text.contains(&live.token));
}

#[test]
fn what_is_too_long_or_too_much_keeps_nobody_out() {
    let folder = folder();
    let live = Running::start(&folder, &["ball.json", "--size", "4x3"]);
    let host = live.host();
    let long = format!("A: {}\r\n", "b".repeat(100_000));
    assert_eq!(live.ask("GET /", &host, &long).status, 431);
    let much = "Content-Length: 1000000000\r\n";
    assert_eq!(live.ask("POST /fix", &host, much).status, 413);
    assert_eq!(live.raw(b"\x16\x03\x01 hello\r\n\r\n").status, 400);
    let idle: Vec<_> = (0..200)
        .map(|_| TcpStream::connect(("127.0.0.1", live.port)).unwrap())
        .collect();
    assert_eq!(live.get("/", "").status, 200);
    let slow = idle.iter().map(|mut stream| stream.write(b"GET"));
    assert!(slow.count() == 200 && live.get("/", "").status == 200);
}

#[test]
fn streams_of_events_are_few_and_keep_nobody_out() {
    let folder = folder();
    let live = Running::start(&folder, &["ball.json", "--size", "4x3"]);
    live.finished(1);
    let opened = (0..100).map(|_| {
        let mut stream = live.events();
        assert_eq!(stream.next().unwrap()["load"], 1, "a new one is told");
        stream
    });
    let mut streams: Vec<_> = opened.collect();
    assert_eq!(live.get("/", "").status, 200);
    let view = json!({ "eye": [30.5, 10, 40], "center": [0, 0, 0], "up": [0, 1, 0] });
    live.post("/view", &json!({ "view": view, "isMoving": false }));
    let mut newest = streams.pop().unwrap();
    assert!(
        newest.any(|state| state["isMoved"] == true),
        "and go on to be"
    );
    let ended = streams.into_iter().take(96);
    assert!(
        ended.map(Iterator::count).max() <= Some(2),
        "the others end"
    );
}

#[test]
fn the_finished_picture_is_that_of_render() {
    let folder = folder();
    let size = ["--size", "200x150", "--threads", "1"];
    let live = Running::start(&folder, &[&["ball.json"][..], &size].concat());
    let state = live.finished(1);
    assert_eq!(state["picture"]["full"], json!([200, 150]));
    let whole = rendered(&folder, &[&["ball.json"][..], &size].concat());
    assert!(live.picture(&state) == whole, "the bytes are the same");
    let found = live.get("/pixel", "&x=100&y=75").json();
    assert_eq!(found["surface"], 1, "the ball");
    let depth = found["depth"].as_f64().unwrap();
    assert!((depth - 40.0).abs() < 0.01, "{depth}");
    let beside = live.get("/pixel", "&x=0&y=0").json();
    assert!(beside["surface"] == 2 && beside["value"] != found["value"]);
    assert_eq!(live.get("/pixel", "&x=200&y=0").status, 404);

    let view = json!({ "eye": [30.5, 10, 40], "center": [0, 0.25, 0], "up": [0, 1, 0] });
    let moving = json!({ "view": view, "isMoving": true });
    let age = live.post("/view", &moving).json()["age"].as_u64();
    let coarse = live.when("moved", |state| state["picture"]["age"].as_u64() == age);
    assert_eq!(coarse["picture"]["isFinished"], false);
    let resting = json!({ "view": view, "isMoving": false });
    let age = live.post("/view", &resting).json()["age"].as_u64();
    let state = live.when("turned", |state| {
        state["picture"]["age"].as_u64() == age && state["picture"]["isFinished"] == true
    });
    let turned = commanded(&folder, &state);
    assert!(turned != whole && live.picture(&state) == turned);
    for wrong in [
        json!({ "isMoving": 1 }),
        json!({ "view": {}, "isMoving": true }),
        json!(1),
    ] {
        assert_eq!(live.post("/view", &wrong).status, 400, "{wrong}");
    }
    assert_eq!(live.post("/effects", &Value::Null).status, 202);
    let state = live.when("explained", |state| state["effects"].is_string());
    assert!(state["effects"].as_str().unwrap().contains("shadows"));
}

#[test]
fn a_finding_is_mended_by_its_button_alone() {
    let folder = typed(TYPED);
    let path = folder.path().join("a.yaml");
    let live = Running::start(&folder, &["a.yaml"]);
    let before = live.when("told", |state| {
        state["load"] == 1 && state["isWorking"] == false
    });
    let refused = rtc(&folder, &["check", "a.yaml", "--color", "never"]);
    let refused = stderr(&refused);
    let findings = before["findings"].as_array().unwrap();
    assert!(
        before["isFailed"] == false || before["picture"].is_null(),
        "{before:#}"
    );
    let fixes = |state: &Value| -> Vec<Value> {
        let findings = state["findings"].as_array().unwrap().iter();
        findings.map(|finding| finding["fix"].clone()).collect()
    };
    assert_eq!(
        fixes(&before),
        [json!("guess"), json!("sure")],
        "{before:#}"
    );
    for finding in findings {
        let text = finding["texts"][0].as_str().unwrap().trim_end();
        assert!(refused.contains(text), "{text}\n---\n{refused}");
    }
    let changes: Vec<_> = findings.iter().map(|own| &own["change"]).collect();
    assert_eq!(
        changes,
        ["replace `Shadws` by `Shadows`", "replace `'3'` by `3`"]
    );
    let stale = live.post("/fix", &json!({ "load": 0, "finding": 0 }));
    assert_eq!(stale.status, 409);
    let done = live.post("/fix", &json!({ "load": 1, "finding": 0 }));
    assert_eq!(done.json()["changes"], 1);
    let guessed = TYPED.replace("Shadws", "Shadows");
    assert_eq!(
        fs::read_to_string(&path).unwrap(),
        guessed,
        "that finding alone is mended"
    );
    let state = live.when("read again", |state| state["load"].as_u64() >= Some(2));
    let state = live.when("told", |now| {
        now["load"] == state["load"] && now["isWorking"] == false
    });
    let done = live.post("/fix", &json!({ "load": state["load"], "finding": null }));
    assert_eq!(done.json()["changes"], 1);
    let repaired = guessed.replace("'3'", "3");
    assert_eq!(fs::read_to_string(&path).unwrap(), repaired);
    let state = live.finished(3);
    assert_eq!((&state["isFailed"], fixes(&state)), (&json!(false), vec![]));
    assert_eq!(live.picture(&state), rendered(&folder, &["a.yaml"]));
}

#[test]
fn the_last_good_picture_stays_while_a_fault_is_told() {
    let text = TYPED.replace("Shadws", "Shadows").replace("'3'", "3");
    let folder = typed(&text);
    let path = folder.path().join("a.yaml");
    let mut live = Running::start(&folder, &["a.yaml"]);
    let good = live.picture(&live.finished(1));
    fs::write(&path, text.replace("radius: 3", "radius: -3 # <b>")).unwrap();
    let broken = live.when("broken", |state| state["isFailed"] == true);
    let reported = broken["findings"][0]["texts"][0].as_str().unwrap();
    assert!(
        reported.starts_with("error[") && reported.contains("radius: -3 # <b>"),
        "{reported}"
    );
    assert!(live.picture(&broken) == good, "the last good picture stays");
    fs::write(&path, text.replace("radius: 3", "radius: 2")).unwrap();
    let load = broken["load"].as_u64().unwrap() + 1;
    let state = live.finished(load);
    assert_eq!(state["isFailed"], false);
    assert!(live.picture(&state) != good);

    let pid = live.child.id().to_string();
    Command::new("kill").args(["-INT", &pid]).status().unwrap();
    assert_eq!(live.child.wait().unwrap().code(), Some(130));
}

#[test]
fn a_view_is_written_into_the_keys_of_the_scene() {
    let text = TYPED.replace("Shadws", "Shadows").replace("'3'", "3");
    let folder = typed(&text);
    let live = Running::start(&folder, &["a.yaml"]);
    assert_eq!(
        live.post("/keep", &Value::Null).status,
        409,
        "it is looked at as it says"
    );
    let state = live.finished(1);
    assert_eq!(state["view"]["canWrite"], true);
    let view = json!({ "eye": [25, 0, 0], "center": [0, 0, 0], "up": [0, 2, 0] });
    live.post("/view", &json!({ "view": view, "isMoving": false }));
    assert_eq!(live.post("/keep", &Value::Null).status, 200);
    let kept = fs::read_to_string(folder.path().join("a.yaml")).unwrap();
    let wanted = text
        .replace("eye: [0, 0, 50] # far away", "eye: [25, 0, 0] # far away")
        .replace("up: [0, 1, 0]", "up: [0, 0.5, 0]");
    assert_eq!(kept, wanted);
    let state = live.finished(2);
    assert_eq!(
        (&state["isMoved"], &state["view"]["eye"]),
        (&json!(false), &json!([25.0, 0.0, 0.0]))
    );
}

#[test]
fn what_can_not_be_shown_is_a_fault_of_usage() {
    let folder = folder();
    let code = |args: &[&str]| code(&rtc(&folder, &[&["preview"], args].concat()));
    assert_eq!(code(&["-"]), 2);
    assert_eq!(code(&["nofile.yaml"]), 2);
    assert_eq!(code(&["ball.json", "--against", "none.png"]), 2);
    fs::write(folder.path().join("no.png"), "{}").unwrap();
    assert_eq!(code(&["ball.json", "--against", "no.png"]), 2);
    assert_eq!(code(&["ball.json", "--port", "70000"]), 2);
    assert_eq!(code(&["ball.json", "--aov", "depth"]), 2);
    let taken = std::net::TcpListener::bind(("127.0.0.1", 0)).unwrap();
    let port = taken.local_addr().unwrap().port().to_string();
    assert_eq!(code(&["ball.json", "--port", &port]), 2);
}

/// The picture takes 16 thousand million rays.
#[test]
fn a_render_for_an_old_text_or_one_that_is_interrupted_is_given_up() {
    let sound = TYPED.replace("Shadws", "Shadows").replace("'3'", "3");
    let endless = sound
        .replace("[12, 8]", "[2000, 2000]")
        .replace("up: [0, 1, 0]", "up: [0, 0.001, 0]")
        + "SuperSampling: {factor: 64}\n";
    let folder = typed(&endless);
    let path = folder.path().join("a.yaml");
    fs::write(folder.path().join("b.yaml"), &sound).unwrap();
    let golden = rtc(&folder, &["render", "b.yaml", "-o", "golden.png"]);
    assert_eq!(code(&golden), 0);
    let mut live = Running::start(
        &folder,
        &["a.yaml", "--against", "golden.png", "--allow-huge"],
    );
    let laid = live.get("/against", "&number=1");
    assert!(laid.status == 200 && laid.body.starts_with(b"\x89PNG"));
    let is_crude = |state: &Value| state["picture"]["isFinished"] == false;
    live.when("begun", is_crude);
    fs::write(&path, &sound).unwrap();
    let state = live.finished(2);
    assert_eq!(state["picture"]["full"], json!([12, 8]));
    fs::write(&path, &endless).unwrap();
    live.when("begun again", is_crude);
    let pid = live.child.id().to_string();
    Command::new("kill").args(["-INT", &pid]).status().unwrap();
    assert_eq!(live.child.wait().unwrap().code(), Some(130));
}
