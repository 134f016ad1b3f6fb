//! An editor at the other end of `rtc lsp`: it writes and reads the messages as they stand on the
//! wire, and keeps what was published.

use super::*;
use std::io::{BufRead, BufReader, Read};
use std::process::{Child, ChildStdin, ChildStdout};

pub(super) struct Editor {
    server: Child,
    input: ChildStdin,
    output: BufReader<ChildStdout>,
    pub(super) folder: TempDir,
    last: i32,
    /// What was published, newest last.
    pub(super) reported: Vec<Value>,
}

impl Editor {
    /// One that has said nothing yet.
    pub(super) fn silent(folder: TempDir) -> Self {
        let mut command = Command::new(env!("CARGO_BIN_EXE_rtc"));
        command.arg("lsp").current_dir(folder.path());
        command.stdin(Stdio::piped()).stdout(Stdio::piped());
        let mut server = command.stderr(Stdio::null()).spawn().unwrap();
        let input = server.stdin.take().unwrap();
        let output = BufReader::new(server.stdout.take().unwrap());
        Self {
            server,
            input,
            output,
            folder,
            last: 0,
            reported: Vec::new(),
        }
    }

    pub(super) fn new(folder: TempDir) -> Self {
        let mut editor = Self::silent(folder);
        let greeting = json!({"processId": null, "rootUri": null, "capabilities": {}});
        let answer = editor.ask("initialize", greeting);
        assert_eq!(answer["capabilities"]["positionEncoding"], "utf-16");
        editor.note("initialized", json!({}));
        editor
    }

    /// One that has opened a scene.
    pub(super) fn with(text: &str) -> Self {
        let mut editor = Self::new(tempfile::tempdir().unwrap());
        editor.open("a.yaml", text);
        editor
    }

    pub(super) fn raw(&mut self, body: &str) {
        write!(self.input, "Content-Length: {}\r\n\r\n{body}", body.len()).unwrap();
        self.input.flush().unwrap();
    }

    pub(super) fn note(&mut self, method: &str, params: Value) {
        self.raw(&json!({"jsonrpc": "2.0", "method": method, "params": params}).to_string());
    }

    /// The whole answer to a request.
    pub(super) fn response(&mut self, method: &str, params: Value) -> Value {
        self.last += 1;
        let id = self.last;
        let own = json!({"jsonrpc": "2.0", "id": id, "method": method, "params": params});
        self.raw(&own.to_string());
        self.until(|message| message["id"] == id)
    }

    /// The result of a request.
    pub(super) fn ask(&mut self, method: &str, params: Value) -> Value {
        let response = self.response(method, params);
        assert!(response.get("error").is_none(), "{method}: {response}");
        response["result"].clone()
    }

    /// The result of a request about a place in `a.yaml`.
    pub(super) fn ask_at(&mut self, method: &str, line: u32, character: u32) -> Value {
        let document = json!({"uri": self.uri("a.yaml")});
        let place = json!({"line": line, "character": character});
        self.ask(method, json!({"textDocument": document, "position": place}))
    }

    pub(super) fn until(&mut self, is_meant: impl Fn(&Value) -> bool) -> Value {
        loop {
            let message = self.read();
            if message["method"] == "textDocument/publishDiagnostics" {
                self.reported.push(message["params"].clone());
            }
            if is_meant(&message) {
                return message;
            }
        }
    }

    fn read(&mut self) -> Value {
        let mut length = 0;
        loop {
            let mut line = String::new();
            assert!(self.output.read_line(&mut line).unwrap() > 0, "it is gone");
            if let Some(value) = line.strip_prefix("Content-Length: ") {
                length = value.trim().parse().unwrap();
            }
            if line == "\r\n" {
                break;
            }
        }
        let mut body = vec![0; length];
        self.output.read_exact(&mut body).unwrap();
        serde_json::from_slice(&body).unwrap()
    }

    pub(super) fn uri(&self, name: &str) -> String {
        let folder = self.folder.path().display().to_string();
        format!("file://{folder}/{name}")
    }

    pub(super) fn open(&mut self, name: &str, text: &str) {
        let own = json!({"uri": self.uri(name), "languageId": "yaml", "version": 1, "text": text});
        self.note("textDocument/didOpen", json!({"textDocument": own}));
    }

    pub(super) fn change(&mut self, version: i32, changes: Value) {
        let own = json!({"uri": self.uri("a.yaml"), "version": version});
        let params = json!({"textDocument": own, "contentChanges": changes});
        self.note("textDocument/didChange", params);
    }

    /// The results of requests that are sent together.
    pub(super) fn ask_all(&mut self, requests: Vec<(&str, Value)>) -> Vec<Value> {
        let first = self.last + 1;
        for (method, params) in &requests {
            self.last += 1;
            let own =
                json!({"jsonrpc": "2.0", "id": self.last, "method": method, "params": params});
            self.raw(&own.to_string());
        }
        let results = (first..).zip(&requests).map(|(id, (method, _))| {
            let response = self.until(|message| message["id"] == id);
            assert!(response.get("error").is_none(), "{method}: {response}");
            response["result"].clone()
        });
        results.collect()
    }

    /// The findings that a file is next told to have.
    pub(super) fn findings(&mut self, name: &str) -> Vec<Value> {
        self.findings_of(&self.uri(name))
    }

    /// The findings that the file of a URI is next told to have.
    pub(super) fn findings_of(&mut self, uri: &str) -> Vec<Value> {
        let reported = self.until(|message| {
            message["method"] == "textDocument/publishDiagnostics"
                && message["params"]["uri"] == uri
        });
        reported["params"]["diagnostics"]
            .as_array()
            .unwrap()
            .clone()
    }

    /// Its exit code after it was told to go.
    pub(super) fn leave(mut self) -> i32 {
        self.note("exit", Value::Null);
        drop(self.input);
        self.server.wait().unwrap().code().unwrap()
    }
}
