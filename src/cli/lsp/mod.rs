//! `rtc lsp`: a language server for scenes over standard input and output (Language Server Protocol
//! 3.17).
//!
//! `wire` reads and writes messages, `protocol` has their types, `workspace` the open documents.
//! Each [`open_text`] is checked like a file by `rtc check`; `diagnostics` converts the result,
//! with fixes. `answer` dispatches requests: `completion` (with `snippet`), `hover`, `outline`,
//! `inlay`, `anchor`, `folding`, `links`, `semantic`, `lens`; `traverse` visits the nodes of a document.
//! `path_at` finds the
//! key at a position, `vocabulary` its schema, `effective` its value in the IR. `text` converts
//! positions, `uri` paths.
//!
//! Documents are checked when no message waits. An error in a message is a response; the server
//! ends only when the editor closes the stream.

mod anchor;
mod answer;
mod completion;
mod diagnostics;
mod effective;
mod folding;
mod foreign;
mod hover;
mod inlay;
mod lens;
mod links;
mod method;
mod open_text;
mod outline;
mod path_at;
mod place;
mod protocol;
mod semantic;
mod snippet;
mod text;
mod traverse;
mod uri;
mod vocabulary;
mod wire;
mod workspace;

use super::Failure;
use super::args;
use lsp_server::{ErrorCode, Message, Request, Response};
use protocol::{CodeActionKind, TextDocumentSyncKind};
use serde_json::{Value, json};
use std::io::{self, BufReader, Stdout};
use std::panic::{self, AssertUnwindSafe};
use text::Columns;
use wire::{IncomingMessage, MessageQueue};
use workspace::Workspace;

/// The state of the session (LSP, "Server lifecycle").
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum SessionState {
    /// Before the request `initialize`.
    Starting,
    /// Requests are answered.
    Running,
    /// After the request `shutdown`.
    ShutDown,
}

/// A server of one editor.
struct Server {
    inbox: MessageQueue,
    out: Stdout,
    state: SessionState,
    workspace: Workspace,
}

/// Serves one editor until it sends `exit` or disconnects.
pub(super) fn run(args: args::LspArgs) -> Result<(), Failure> {
    let trouble = |error: io::Error| Failure::Failed(format!("lsp: {error}"));
    let mut server = Server {
        inbox: MessageQueue::of(BufReader::new(io::stdin())).map_err(trouble)?,
        out: io::stdout(),
        state: SessionState::Starting,
        workspace: Workspace::new(args.reading),
    };
    server.serve()
}

/// Processes messages, one per line, and drops the responses.
///
/// # Panics
/// If a message causes an internal error.
pub(super) fn hear_all(args: args::LspArgs, messages: &[u8]) {
    /// The maximum number of messages.
    const MOST: usize = 64;
    let mut workspace = Workspace::new(args.reading);
    for line in messages.split(|byte| *byte == b'\n').take(MOST) {
        let mut reported = match serde_json::from_slice(line) {
            Ok(Message::Request(request)) => vec![workspace.answer(request).into()],
            Ok(Message::Notification(own)) => workspace.note(own),
            Ok(Message::Response(_)) | Err(_) => Vec::new(),
        };
        while let Some(more) = workspace.check_next() {
            reported.extend(more);
        }
        let reported = serde_json::to_string(&reported).unwrap_or_default();
        assert!(!reported.contains(open_text::FAULT), "{reported}");
    }
}

impl Server {
    /// Processes messages in order; checks documents when no message waits.
    fn serve(&mut self) -> Result<(), Failure> {
        loop {
            let incoming = match self.inbox.next() {
                Some(incoming) => incoming,
                None => {
                    if let Some(reported) = self.workspace.check_next() {
                        reported.into_iter().for_each(|message| self.send(message));
                        continue;
                    }
                    match self.inbox.wait() {
                        Some(incoming) => incoming,
                        None => return Ok(()),
                    }
                }
            };
            match incoming {
                IncomingMessage::Message(Message::Notification(own)) if own.method == "exit" => {
                    let is_asked = self.state == SessionState::ShutDown;
                    let error_text = "the editor left without `shutdown`";
                    let failure = || Failure::Input(error_text.to_owned());
                    return is_asked.then_some(()).ok_or_else(failure);
                }
                IncomingMessage::Message(message) => self.hear(message),
                IncomingMessage::Done(messages) => {
                    messages.into_iter().for_each(|message| self.send(message));
                }
                IncomingMessage::End => return Ok(()),
                IncomingMessage::Cancelled(id) => {
                    let error_text = "cancelled".to_owned();
                    let code = ErrorCode::RequestCanceled as i32;
                    self.send(Response::new_err(id, code, error_text));
                }
                // An editor that is gone is noticed where its next message is waited for.
                IncomingMessage::NoMessage(code, error_text) => {
                    let _ = wire::refuse(&mut self.out, code, &error_text);
                }
                IncomingMessage::Broken(error_text) => {
                    return Err(Failure::Failed(format!("lsp: {error_text}")));
                }
            }
        }
    }

    fn send(&mut self, message: impl Into<Message>) {
        let _ = message.into().write(&mut self.out);
    }

    fn hear(&mut self, message: Message) {
        match message {
            Message::Request(request) => {
                let response = self.answered(request);
                self.send(response);
            }
            Message::Notification(own) if self.state == SessionState::Running => {
                let reported = self.workspace.note(own);
                reported.into_iter().for_each(|message| self.send(message));
            }
            Message::Notification(_) | Message::Response(_) => {}
        }
    }

    /// The response to a request; an internal error is a response, too, and the server continues.
    fn answered(&mut self, request: Request) -> Response {
        let id = request.id.clone();
        let refused = |code: ErrorCode, error_text: &str| {
            Response::new_err(id.clone(), code as i32, error_text.to_owned())
        };
        match (self.state, request.method.as_str()) {
            (SessionState::Starting, "initialize") => {
                self.state = SessionState::Running;
                Response::new_ok(id, self.greet(&request.params))
            }
            (SessionState::Starting, _) => {
                refused(ErrorCode::ServerNotInitialized, "`initialize` comes first")
            }
            (SessionState::Running, "initialize") => {
                refused(ErrorCode::InvalidRequest, "`initialize` came before")
            }
            (SessionState::Running, "shutdown") => {
                self.state = SessionState::ShutDown;
                Response::new_ok(id, Value::Null)
            }
            (SessionState::Running, method::EXECUTE_COMMAND) => {
                let Some((command, uri)) = lens::parsed(&request.params) else {
                    return refused(ErrorCode::InvalidParams, "no such command");
                };
                let work = move || lens::carry_out(&command, &uri);
                match self.inbox.work(work) {
                    Ok(()) => Response::new_ok(id, Value::Null),
                    Err(error) => refused(ErrorCode::InternalError, &error.to_string()),
                }
            }
            (SessionState::Running, _) => {
                let answer = AssertUnwindSafe(|| self.workspace.answer(request));
                let error_text = "internal error of rtc; please report it with the scene";
                panic::catch_unwind(answer)
                    .unwrap_or_else(|_| refused(ErrorCode::InternalError, error_text))
            }
            (SessionState::ShutDown, _) => {
                refused(ErrorCode::InvalidRequest, "`shutdown` came before")
            }
        }
    }

    /// The capabilities of the server, for an editor with the given position encoding.
    fn greet(&mut self, params: &Value) -> Value {
        // Other notifications are ignored.
        let columns = self.workspace.adapt(params);
        json!({
            "capabilities": capabilities(columns),
            "serverInfo": { "name": "rtc", "version": env!("CARGO_PKG_VERSION") },
        })
    }
}

fn capabilities(columns: Columns) -> Value {
    json!({
        "positionEncoding": columns.kind(),
        "textDocumentSync": TextDocumentSyncKind::INCREMENTAL,
        "codeActionProvider": {
            "codeActionKinds": [CodeActionKind::QUICKFIX, CodeActionKind::SOURCE_FIX_ALL],
        },
        "hoverProvider": true,
        "completionProvider": { "triggerCharacters": [" ", "/", "*", "\"", "<"] },
        "documentFormattingProvider": true,
        "documentSymbolProvider": true,
        "definitionProvider": true,
        "colorProvider": true,
        "inlayHintProvider": true,
        "referencesProvider": true,
        "renameProvider": { "prepareProvider": true },
        "foldingRangeProvider": true,
        "selectionRangeProvider": true,
        "documentLinkProvider": {},
        "codeLensProvider": {},
        "executeCommandProvider": { "commands": [lens::RENDER, lens::COST] },
        "diagnosticProvider": {
            "identifier": "rtc",
            "interFileDependencies": true,
            "workspaceDiagnostics": false,
        },
        "semanticTokensProvider": {
            "legend": {
                "tokenTypes": semantic::TYPES,
                "tokenModifiers": semantic::MODIFIERS,
            },
            "full": true,
            "range": true,
        },
    })
}
