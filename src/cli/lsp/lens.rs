//! Code lenses above a scene, and their commands: to render it, and to study what it costs. A
//! command runs `rtc` on the saved file, in a process of its own, and tells its result.

use super::method;
use super::open_text::OpenText;
use super::place;
use super::protocol::{CodeLens, EditorCommand, Range};
use super::uri::DocumentUri;
use lsp_server::{Message, Notification, Request, RequestId};
use rtc_pipeline::SourceKind;
use serde_json::{Value, json};
use std::path::Path;
use std::process::{self, Stdio};
use std::{env, io};

/// The command that renders.
pub(super) const RENDER: &str = "rtc.render";

/// The command that studies the cost.
pub(super) const COST: &str = "rtc.cost";

/// The lenses of a document; a mesh has none.
pub(super) fn lenses(document: &OpenText) -> Vec<CodeLens> {
    let lens = |(title, command): (&str, &'static str)| CodeLens {
        range: Range::default(),
        command: EditorCommand {
            title: title.to_owned(),
            command,
            arguments: vec![document.uri.clone()],
        },
    };
    match document.kind() {
        SourceKind::Mesh => Vec::new(),
        SourceKind::Scene
        | SourceKind::Ir(_)
        | SourceKind::Gltf
        | SourceKind::Mitsuba
        | SourceKind::Pbrt
        | SourceKind::Usd => {
            let all = [("render", RENDER), ("what this costs", COST)];
            all.into_iter().map(lens).collect()
        }
    }
}

/// Carries out a command; returns the messages for the editor. It may take long.
pub(super) fn carry_out(command: &str, uri: &DocumentUri) -> Vec<Message> {
    let path = place::path(uri);
    let reported = match command {
        RENDER => render(&path),
        _ => cost(&path),
    };
    reported.unwrap_or_else(|error| vec![shown(false, &format!("rtc does not start: {error}"))])
}

/// Renders a scene beside its file, and shows the picture.
fn render(path: &Path) -> io::Result<Vec<Message>> {
    let picture = path.with_extension("png");
    let done = rtc(path, &["render", "--quiet", "-o"], Some(&picture))?;
    if let Some(error_text) = error_text(&done) {
        return Ok(vec![shown(false, &error_text)]);
    }
    let text = format!("rendered to {}", picture.display());
    let mut messages = vec![shown(true, &text)];
    messages.extend(place::uri(&picture).map(|uri| {
        let params = json!({ "uri": uri, "takeFocus": false });
        let id = RequestId::from("show".to_owned());
        Request::new(id, method::SHOW_DOCUMENT.to_owned(), params).into()
    }));
    Ok(messages)
}

/// Studies a scene quickly: the errors that can be had in some times.
fn cost(path: &Path) -> io::Result<Vec<Message>> {
    let done = rtc(path, &["cost", "--effort", "quick"], None)?;
    if let Some(error_text) = error_text(&done) {
        return Ok(vec![shown(false, &error_text)]);
    }
    let table = String::from_utf8_lossy(&done.stdout);
    let lines = table.lines().filter(|line| line.starts_with("in "));
    let text = lines.collect::<Vec<_>>().join("; ");
    Ok(vec![shown(true, &text)])
}

/// Runs this program on a file.
fn rtc(path: &Path, words: &[&str], output: Option<&Path>) -> io::Result<process::Output> {
    let mut command = process::Command::new(env::current_exe()?);
    command.args(words).args(output).arg(path);
    // The streams of the server are those of the protocol.
    command.stdin(Stdio::null()).output()
}

/// The last line of what a program reported, if it failed.
fn error_text(done: &process::Output) -> Option<String> {
    let text = String::from_utf8_lossy(&done.stderr);
    let last = text.lines().rev().find(|line| !line.trim().is_empty());
    (!done.status.success()).then(|| last.unwrap_or("rtc failed").to_owned())
}

/// A message that the editor shows.
fn shown(is_good: bool, text: &str) -> Message {
    const ERROR: u8 = 1;
    const INFO: u8 = 3;
    let params = json!({ "type": if is_good { INFO } else { ERROR }, "message": text });
    Notification::new(method::SHOW_MESSAGE.to_owned(), params).into()
}

/// The command and the document of a request.
pub(super) fn parsed(params: &Value) -> Option<(String, DocumentUri)> {
    let command = params.get("command")?.as_str()?;
    let known = [RENDER, COST].contains(&command);
    let uri = params.pointer("/arguments/0")?.as_str()?.parse().ok()?;
    known.then(|| (command.to_owned(), uri))
}
