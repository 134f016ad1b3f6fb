//! What `rtc preview` tells when asked: settings and their costs, the effects at a pixel, and what the
//! picture is compared with, from where the page looks.

use super::preview::{commanded, rendered};
use super::running::Running;
use super::*;
use serde_json::{Value, json};

/// A view of the ball from the right.
fn view() -> Value {
    json!({ "eye": [30.5, 10, 40], "center": [0, 0, 0], "up": [0, 1, 0] })
}

/// What is shown once an order of this age, or a later one, is carried out.
fn after(live: &Running, reported: &Value, picture: &str) -> Value {
    let age = reported["age"].as_u64();
    live.when("carried out", |state| {
        state[picture]["age"].as_u64() >= age && state[picture]["isFinished"] == true
    })
}

#[test]
fn a_setting_that_is_chosen_is_rendered_as_its_command_says() {
    let folder = folder();
    let typed = ["ball.json", "--size=40x30", "--depth", "2", "--port", "0"];
    let live = Running::start(&folder, &typed);
    let own = live.finished(1);
    assert_eq!(own["settings"], Value::Null, "nobody asked");
    assert_eq!(
        own["command"],
        "rtc render ball.json --size=40x30 --depth 2"
    );
    let choice = json!({ "values": { "supersampling": 1, "depth": 0 }, "integrator": null });
    let reported = live.post("/settings", &choice).json();
    let state = after(&live, &reported, "picture");
    assert_eq!(
        state["command"],
        "rtc render ball.json --size=40x30 --supersampling 1 --depth 0"
    );
    let chosen = live.picture(&state);
    assert!(chosen == commanded(&folder, &state) && chosen != commanded(&folder, &own));
    let both = json!({ "view": view(), "isMoving": false });
    let state = after(&live, &live.post("/view", &both).json(), "picture");
    assert!(live.picture(&state) == commanded(&folder, &state) && state["choice"] == choice);
    let traced = json!({ "values": { "paths": 3 }, "integrator": "path" });
    let state = after(&live, &live.post("/settings", &traced).json(), "picture");
    let plain = live.picture(&state);
    assert!(plain == commanded(&folder, &state));
    let denoised = json!({ "values": { "paths": 3, "denoise": 1 }, "integrator": "path" });
    let state = after(&live, &live.post("/settings", &denoised).json(), "picture");
    assert!(live.picture(&state) == commanded(&folder, &state) && live.picture(&state) != plain);
    for wrong in [
        json!({ "values": { "supersampling": 0 }, "integrator": null }),
        json!({ "values": { "size": 1 }, "integrator": null }),
        json!({ "values": { "denoise": 2 }, "integrator": null }),
        json!({ "values": [], "integrator": null }),
        json!(null),
    ] {
        assert_eq!(live.post("/settings", &wrong).status, 400, "{wrong}");
    }
    let much = json!({ "values": { "supersampling": 4_000_000_000_u32 }, "integrator": null });
    live.post("/settings", &much);
    live.when("refused", |state| state["isFailed"] == true);
}

#[test]
fn the_noise_of_a_picture_is_laid_over_it_when_asked() {
    let folder = folder();
    let live = Running::start(&folder, &["ball.json", "--size", "16x12"]);
    assert_eq!(live.finished(1)["noise"], Value::Null);
    assert_eq!(live.post("/noise", &Value::Null).status, 202);
    let state = live.when("measured", |state| state["noise"].is_string());
    let told = state["noise"].as_str().unwrap();
    assert!(told.starts_with("error at most "), "{told}");
    let number = &state["picture"]["number"];
    let layer = |name: &str| live.get("/noise", &format!("&number={number}&layer={name}"));
    for name in ["error", "samples", "unmet"] {
        assert!(layer(name).body.starts_with(b"\x89PNG"), "{name}");
    }
    assert_eq!(layer("depth").status, 404);
    // Another picture has another noise.
    let both = json!({ "view": view(), "isMoving": false });
    let state = after(&live, &live.post("/view", &both).json(), "picture");
    assert_eq!(state["noise"], Value::Null);
}

#[test]
fn costs_are_measured_when_asked_and_go_with_their_scene() {
    let folder = folder();
    let live = Running::start(&folder, &["ball.json", "--size", "16x12"]);
    assert_eq!(live.finished(1)["costs"], Value::Null);
    assert_eq!(live.post("/costs", &Value::Null).status, 202);
    let state = live.when("measured", |state| state["costs"].is_object());
    let report = state["costs"]["report"].as_str().unwrap();
    assert!(report.contains("rtc render ball.json"), "{report}");
    let parameters = state["settings"]["knobs"].as_array().unwrap();
    let [first, aperture] = [&parameters[0], &parameters[1]];
    assert!(first["own"] == 2 && first["idle"].is_null(), "{first}");
    assert!(aperture["idle"].as_str().unwrap().contains("lens"));
    let rows = state["costs"]["rows"].as_array().unwrap();
    let own = rows.iter().find(|row| row["values"] == json!({})).unwrap();
    let other = rows.iter().find(|row| row["values"] != json!({})).unwrap();
    assert!(own["seconds"].as_f64() > Some(0.0) && own["error"].as_f64() > Some(0.0));

    let choice = json!({ "values": other["values"], "integrator": null });
    let reported = live.post("/settings", &choice).json();
    let state = after(&live, &reported, "picture");
    assert!(
        state["costs"].is_object(),
        "they are of the scene's own values"
    );
    assert!(live.picture(&state) == commanded(&folder, &state));
    live.post("/view", &json!({ "view": view(), "isMoving": false }));
    live.when("forgotten", |state| state["costs"].is_null());
}

#[test]
fn a_pixel_tells_which_effects_took_part() {
    let folder = folder();
    let live = Running::start(&folder, &["ball.json", "--size", "40x30"]);
    live.finished(1);
    let effects = |x: u32, y: u32| {
        assert_eq!(live.post("/pixel", &json!([x, y])).status, 202);
        let state = live.when("told", |state| state["pixel"]["at"] == json!([x, y]));
        let effects = state["pixel"]["effects"].as_array().unwrap().clone();
        let name = |own: &Value| own[0].as_str().unwrap().to_owned();
        effects.iter().map(name).collect::<Vec<_>>()
    };
    let (ball, wall) = (effects(20, 15), effects(0, 29));
    let has = |effects: &[String], name: &str| effects.iter().any(|own| own == name);
    assert!(
        has(&ball, "highlight") && !has(&ball, "shadows"),
        "{ball:?}"
    );
    assert!(
        has(&wall, "shadows") && !has(&wall, "highlight"),
        "{wall:?}"
    );
    assert_eq!(live.get("/pixel", "&x=20&y=15").json()["name"], "sphere");
    assert_eq!(live.post("/pixel", &json!([1])).status, 400);
}

#[test]
fn another_scene_is_looked_at_as_the_first() {
    let folder = folder();
    let brown = scene_with("[1, 0, 0], \"ka\"", "[0.5, 0.3, 0], \"ka\"");
    fs::write(folder.path().join("brown.json"), brown).unwrap();
    let size = ["--size", "40x30"];
    let against = ["ball.json", "--against", "brown.json"];
    let live = Running::start(&folder, &[&against[..], &size].concat());
    let laid = |state: &Value| {
        let number = &state["against"]["number"];
        live.get("/against", &format!("&number={number}")).body
    };
    let own = live.when("laid", |state| state["against"]["isFinished"] == true);
    let other = [&["brown.json"][..], &size].concat();
    assert!(laid(&own) == rendered(&folder, &other));
    let moving = json!({ "view": view(), "isMoving": true });
    let age = live.post("/view", &moving).json()["age"].as_u64();
    let coarse = live.when("moved", |state| state["against"]["age"].as_u64() == age);
    assert_eq!(coarse["against"]["isFinished"], false);
    let resting = json!({ "view": view(), "isMoving": false });
    let state = after(&live, &live.post("/view", &resting).json(), "against");
    let words = state["command"]
        .as_str()
        .unwrap()
        .replace("ball.json", "brown.json");
    let turned = commanded(&folder, &json!({ "command": words }));
    assert!(laid(&state) == turned && laid(&own) != turned);

    fs::write(folder.path().join("brown.json"), "Lights: 3").unwrap();
    let refused = rtc(&folder, &[&["preview"][..], &against].concat());
    assert_eq!(code(&refused), 1, "{}", stderr(&refused));
}

#[test]
fn a_commit_is_compared_with() {
    let folder = folder();
    let git = |args: &[&str]| {
        let who = ["-c", "user.name=a", "-c", "user.email=a@example.com"];
        let mut git = Command::new("git");
        git.current_dir(folder.path()).args(who).args(args);
        assert!(git.output().unwrap().status.success(), "{args:?}");
    };
    git(&["init", "-q"]);
    git(&["add", "ball.json"]);
    git(&["commit", "-q", "-m", "a ball"]);
    let before = rendered(&folder, &["ball.json"]);
    let brown = scene_with("[1, 0, 0], \"ka\"", "[0.5, 0.3, 0], \"ka\"");
    fs::write(folder.path().join("ball.json"), brown).unwrap();
    let live = Running::start(&folder, &["ball.json", "--against", "HEAD"]);
    live.when("laid", |state| state["against"]["isFinished"] == true);
    let laid = live.get("/against", "&number=1").body;
    assert!(laid == before && laid != live.picture(&live.finished(1)));
    let none = rtc(&folder, &["preview", "ball.json", "--against", "HEAD~7"]);
    assert_eq!(code(&none), 2, "{}", stderr(&none));
}
