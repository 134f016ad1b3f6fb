//! A preview that is running, and requests to it as they stand on the wire.

use super::*;
use serde_json::Value;
use std::io::{BufRead, BufReader, Read};
use std::net::TcpStream;
use std::process::{Child, ChildStdout};

/// A preview that is running; it ends with the test.
pub(super) struct Running {
    pub(super) child: Child,
    /// Its standard output stays open.
    _stdout: BufReader<ChildStdout>,
    pub(super) port: u16,
    pub(super) token: String,
}

impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// A reply: its status, its head and its body.
pub(super) struct Reply {
    pub(super) status: u16,
    pub(super) head: String,
    pub(super) body: Vec<u8>,
}

impl Reply {
    pub(super) fn json(&self) -> Value {
        assert_eq!(self.status, 200, "{}", self.head);
        serde_json::from_slice(&self.body).unwrap()
    }
}

/// What is shown, as it changes.
pub(super) struct Events(std::io::Lines<BufReader<TcpStream>>);

impl Iterator for Events {
    type Item = Value;

    fn next(&mut self) -> Option<Value> {
        let mut lines = self.0.by_ref().map_while(Result::ok);
        lines.find_map(|line| serde_json::from_str(line.strip_prefix("data: ")?).ok())
    }
}

impl Running {
    pub(super) fn start(folder: &TempDir, args: &[&str]) -> Self {
        let words = [&["preview"], args].concat();
        let mut child = command(folder.path(), &words)
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let mut stdout = BufReader::new(child.stdout.take().unwrap());
        let mut line = String::new();
        stdout.read_line(&mut line).unwrap();
        let address = line.trim_end().strip_prefix("http://127.0.0.1:").unwrap();
        let (port, token) = address.split_once("/?token=").unwrap();
        assert!(token.len() == 32 && token.chars().all(|c| c.is_ascii_hexdigit()));
        Self {
            child,
            port: port.parse().unwrap(),
            token: token.to_owned(),
            _stdout: stdout,
        }
    }

    /// Sends these bytes and reads the reply to its end.
    pub(super) fn raw(&self, bytes: &[u8]) -> Reply {
        let mut stream = TcpStream::connect(("127.0.0.1", self.port)).unwrap();
        stream.write_all(bytes).unwrap();
        reply(stream)
    }

    /// Sends a request of this line with more lines.
    pub(super) fn ask(&self, line: &str, host: &str, more: &str) -> Reply {
        self.raw(format!("{line} HTTP/1.1\r\nHost: {host}\r\n{more}\r\n").as_bytes())
    }

    pub(super) fn host(&self) -> String {
        format!("127.0.0.1:{}", self.port)
    }

    pub(super) fn get(&self, path: &str, more: &str) -> Reply {
        let token = &self.token;
        self.ask(&format!("GET {path}?token={token}{more}"), &self.host(), "")
    }

    pub(super) fn post(&self, path: &str, body: &Value) -> Reply {
        let (token, body) = (&self.token, body.to_string());
        let lines = format!("Content-Length: {}\r\n", body.len());
        let line = format!(
            "POST {path}?token={token} HTTP/1.1\r\nHost: {}\r\n",
            self.host()
        );
        self.raw(format!("{line}{lines}\r\n{body}").as_bytes())
    }

    /// A stream of events from now on.
    pub(super) fn events(&self) -> Events {
        let mut stream = TcpStream::connect(("127.0.0.1", self.port)).unwrap();
        let (token, host) = (&self.token, self.host());
        let request = format!("GET /events?token={token} HTTP/1.1\r\nHost: {host}\r\n\r\n");
        stream.write_all(request.as_bytes()).unwrap();
        let patience = std::time::Duration::from_secs(60);
        stream.set_read_timeout(Some(patience)).unwrap();
        Events(BufReader::new(stream).lines())
    }

    /// What is shown once it is as wanted.
    pub(super) fn when(&self, what: &str, is_wanted: impl Fn(&Value) -> bool) -> Value {
        let state = self.events().find(is_wanted);
        state.unwrap_or_else(|| panic!("never {what}"))
    }

    /// What is shown once a reading of the scene, or a later one, is rendered to its end.
    pub(super) fn finished(&self, load: u64) -> Value {
        self.when("finished", |state| {
            let picture = &state["picture"];
            let of = picture["load"].as_u64();
            of >= Some(load) && of == state["load"].as_u64() && picture["isFinished"] == true
        })
    }

    pub(super) fn picture(&self, state: &Value) -> Vec<u8> {
        let number = &state["picture"]["number"];
        let reply = self.get("/picture", &format!("&number={number}"));
        assert_eq!(reply.status, 200);
        assert!(reply.head.contains("Content-Type: image/png\r\n"));
        reply.body
    }
}

fn reply(mut stream: TcpStream) -> Reply {
    let mut bytes = Vec::new();
    stream.read_to_end(&mut bytes).unwrap();
    let end = bytes
        .windows(4)
        .position(|four| four == b"\r\n\r\n")
        .unwrap()
        + 4;
    let head = String::from_utf8(bytes[..end].to_vec()).unwrap();
    Reply {
        status: head.split(' ').nth(1).unwrap().parse().unwrap(),
        body: bytes[end..].to_vec(),
        head,
    }
}
