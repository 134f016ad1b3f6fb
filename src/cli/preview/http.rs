//! One request and one reply of HTTP/1.1 on a connection: sizes are limited, and slow clients time
//! out.

use httparse::{EMPTY_HEADER, Status};
use std::io::{self, ErrorKind, Read, Write};
use std::net::{Shutdown, TcpStream};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// The longest head of a request, in bytes, and the most lines of it.
const MAX_HEAD: usize = 8 << 10;
const MAX_LINES: usize = 64;

/// The longest body of a request, in bytes.
const MAX_BODY: usize = 4 << 10;

/// The frame ancestors of the page: an editor. No web page has such an origin.
const ANCESTORS: &str = "vscode-file: vscode-webview:";

/// How long a request may take to arrive, and each piece of a reply to leave.
const PATIENCE: Duration = Duration::from_secs(5);

/// How much of a request that was refused is read to its end, so that the reply is not lost.
const MAX_REST: usize = 256 << 10;

/// A request.
#[derive(Debug, Default, PartialEq)]
pub(super) struct HttpRequest {
    pub(super) method: String,
    pub(super) path: String,
    /// Names and values, as they were sent.
    query: Vec<(String, String)>,
    /// All lines of these names.
    pub(super) hosts: Vec<String>,
    pub(super) sent_origins: Vec<String>,
    pub(super) body: Vec<u8>,
}

impl HttpRequest {
    /// The value of a name in the query; none of a name that is there twice.
    pub(super) fn value(&self, name: &str) -> Option<&str> {
        let mut values = self.query.iter().filter(|(own, _)| own == name);
        let value = values.next().map(|(_, value)| value.as_str());
        value.filter(|_| values.next().is_none())
    }
}

/// Why a request is not answered as it wants.
#[derive(Debug, PartialEq)]
pub(super) enum BadRequest {
    /// It did not come to its end.
    Gone,
    /// It is rejected with this status.
    Refused(u16),
}

impl From<io::Error> for BadRequest {
    fn from(_: io::Error) -> Self {
        Self::Gone
    }
}

/// Pieces of a reply, as they come.
pub(super) type EventStream = Box<dyn Iterator<Item = String>>;

/// The body of a reply.
enum ReplyBody {
    Whole(Arc<Vec<u8>>),
    /// Sent until it ends or the client disconnects.
    Events(EventStream),
}

/// A reply.
pub(super) struct HttpReply {
    status: u16,
    kind: &'static str,
    body: ReplyBody,
    /// What marks the script and the style that the page may have.
    nonce: Option<String>,
}

impl HttpReply {
    /// A reply with a status only.
    pub(super) fn empty(status: u16) -> Self {
        Self::of(status, "text/plain; charset=utf-8", Vec::new())
    }

    pub(super) fn png(bytes: Arc<Vec<u8>>) -> Self {
        Self {
            status: 200,
            kind: "image/png",
            body: ReplyBody::Whole(bytes),
            nonce: None,
        }
    }

    /// A reply of server-sent events (HTML Living Standard, section 9.2).
    pub(super) fn events(events: EventStream) -> Self {
        Self {
            body: ReplyBody::Events(events),
            ..Self::of(200, "text/event-stream", Vec::new())
        }
    }

    pub(super) fn json(value: &serde_json::Value) -> Self {
        Self::of(200, "application/json", value.to_string().into_bytes())
    }

    /// A text reply, for example an error message.
    pub(super) fn message(status: u16, message: &str) -> Self {
        Self::of(status, "text/plain; charset=utf-8", message.into())
    }

    /// A page whose script and style have the mark.
    pub(super) fn page(text: String, nonce: String) -> Self {
        Self {
            nonce: Some(nonce),
            ..Self::of(200, "text/html; charset=utf-8", text.into_bytes())
        }
    }

    fn of(status: u16, kind: &'static str, body: Vec<u8>) -> Self {
        Self {
            status,
            kind,
            body: ReplyBody::Whole(Arc::new(body)),
            nonce: None,
        }
    }

    fn head(&self) -> String {
        let allowed = self.nonce.as_ref().map_or_else(String::new, |nonce| {
            format!(
                "; script-src 'nonce-{nonce}'; style-src 'nonce-{nonce}'; img-src data:; \
                connect-src 'self'"
            )
        });
        // Events end with their connection.
        let length = match &self.body {
            ReplyBody::Whole(bytes) => format!("Content-Length: {}\r\n", bytes.len()),
            ReplyBody::Events(_) => String::new(),
        };
        format!(
            "HTTP/1.1 {} {}\r\nContent-Type: {}\r\n{length}Connection: close\r\n\
             Cache-Control: no-store\r\nX-Content-Type-Options: nosniff\r\n\
             Referrer-Policy: no-referrer\r\n\
             Cross-Origin-Resource-Policy: same-origin\r\n\
             Cross-Origin-Opener-Policy: same-origin\r\n\
             Content-Security-Policy: default-src 'none'; base-uri 'none'; form-action 'none'; \
             frame-ancestors {ANCESTORS}{allowed}\r\n\r\n",
            self.status,
            reason(self.status),
            self.kind,
        )
    }

    /// Sends it and ends the connection.
    pub(super) fn send(self, mut stream: &TcpStream) -> io::Result<()> {
        stream.set_write_timeout(Some(PATIENCE))?;
        stream.write_all(self.head().as_bytes())?;
        match self.body {
            ReplyBody::Whole(bytes) => stream.write_all(&bytes)?,
            ReplyBody::Events(mut events) => {
                events.try_for_each(|event| stream.write_all(event.as_bytes()))?;
            }
        }
        stream.shutdown(Shutdown::Write)
    }
}

fn reason(status: u16) -> &'static str {
    match status {
        200 => "OK",
        202 => "Accepted",
        400 => "Bad Request",
        403 => "Forbidden",
        404 => "Not Found",
        409 => "Conflict",
        413 => "Content Too Large",
        431 => "Request Header Fields Too Large",
        503 => "Service Unavailable",
        _ => "Error",
    }
}

/// A connection that is read until a moment.
struct DeadlineReader<'s> {
    stream: &'s TcpStream,
    until: Instant,
}

#[expect(
    clippy::disallowed_methods,
    reason = "who is slow is left alone after a while; no picture depends on it"
)]
impl DeadlineReader<'_> {
    fn begin(stream: &TcpStream) -> DeadlineReader<'_> {
        let until = Instant::now() + PATIENCE;
        DeadlineReader { stream, until }
    }

    /// Reads a piece into `bytes`; there is one.
    fn more(&mut self, bytes: &mut Vec<u8>) -> Result<(), BadRequest> {
        let left = self.until.saturating_duration_since(Instant::now());
        if left.is_zero() {
            return Err(BadRequest::Gone);
        }
        self.stream.set_read_timeout(Some(left))?;
        let mut piece = [0; 2048];
        let read = loop {
            match self.stream.read(&mut piece) {
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                read => break read?,
            }
        };
        if read == 0 {
            return Err(BadRequest::Gone);
        }
        bytes.extend_from_slice(piece.get(..read).unwrap_or_default());
        Ok(())
    }
}

/// Reads the request on a connection.
pub(super) fn read(stream: &TcpStream) -> Result<HttpRequest, BadRequest> {
    let mut patient = DeadlineReader::begin(stream);
    let mut bytes = Vec::new();
    loop {
        if let Some((mut request, head, body)) = parse(&bytes)? {
            let end = head + body;
            while bytes.len() < end {
                patient.more(&mut bytes)?;
            }
            request.body = bytes.get(head..end).unwrap_or_default().to_vec();
            return Ok(request);
        }
        if bytes.len() >= MAX_HEAD {
            return Err(BadRequest::Refused(431));
        }
        patient.more(&mut bytes)?;
    }
}

/// Reads the rest of a rejected request: a connection that closes earlier loses its reply.
pub(super) fn read_rest(stream: &TcpStream) {
    let mut patient = DeadlineReader::begin(stream);
    let mut bytes = Vec::new();
    let mut left = MAX_REST;
    while left > 0 && patient.more(&mut bytes).is_ok() {
        left = left.saturating_sub(bytes.len());
        bytes.clear();
    }
}

/// The request that begins with these bytes, the length of its head and that of its body; `None` if
/// the head has no end yet.
fn parse(bytes: &[u8]) -> Result<Option<(HttpRequest, usize, usize)>, BadRequest> {
    let refused = BadRequest::Refused;
    // Parse the head if it is complete.
    let mut lines = [EMPTY_HEADER; MAX_LINES];
    let mut parsed = httparse::Request::new(&mut lines);
    let head = match parsed.parse(bytes) {
        Ok(Status::Complete(head)) if head <= MAX_HEAD => head,
        Ok(Status::Complete(_)) | Err(httparse::Error::TooManyHeaders) => return Err(refused(431)),
        Ok(Status::Partial) => return Ok(None),
        Err(_) => return Err(refused(400)),
    };
    // Split the target into path and query.
    let (Some(method), Some(target)) = (parsed.method, parsed.path) else {
        return Err(refused(400));
    };
    let (path, query) = target.split_once('?').unwrap_or((target, ""));
    let mut request = HttpRequest {
        method: method.to_owned(),
        path: path.to_owned(),
        query: query
            .split('&')
            .filter_map(|pair| pair.split_once('='))
            .map(|(name, value)| (name.to_owned(), value.to_owned()))
            .collect(),
        ..HttpRequest::default()
    };
    // Keep the headers that guard access and tell the length of the body.
    let mut lengths = Vec::new();
    for line in &*parsed.headers {
        let value = || String::from_utf8_lossy(line.value).trim().to_owned();
        match line.name.to_ascii_lowercase().as_str() {
            "host" => request.hosts.push(value()),
            "origin" => request.sent_origins.push(value()),
            "content-length" => lengths.push(value()),
            "transfer-encoding" => return Err(refused(400)),
            _ => {}
        }
    }
    // The body needs one valid length within the limit.
    let body = match lengths.as_slice() {
        [] => 0,
        [length] if !length.is_empty() && length.bytes().all(|byte| byte.is_ascii_digit()) => {
            length.parse().unwrap_or(usize::MAX)
        }
        _ => return Err(refused(400)),
    };
    match body <= MAX_BODY {
        true => Ok(Some((request, head, body))),
        false => Err(refused(413)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_request_is_read_with_what_is_asked_of_it() {
        let text = b"POST /fix?token=ab&token2=c HTTP/1.1\r\nHost: a\r\nHOST:  b \
            \r\ncontent-length: 2\r\n\r\n{}";
        let (request, head, body) = parse(text).unwrap().unwrap();
        assert_eq!((head + body, body), (text.len(), 2));
        assert_eq!(
            (request.method.as_str(), request.path.as_str()),
            ("POST", "/fix")
        );
        assert_eq!(request.hosts, ["a", "b"]);
        assert_eq!(
            (request.value("token"), request.value("x")),
            (Some("ab"), None)
        );
        let twice = parse(b"GET /?token=a&token=b HTTP/1.1\r\n\r\n").unwrap();
        assert_eq!(twice.unwrap().0.value("token"), None);
        assert_eq!(parse(b"GET / HTTP/1.1\r\nHost: a\r\n"), Ok(None));
    }

    #[test]
    fn what_is_too_long_or_could_be_read_in_two_ways_is_refused() {
        let refused = |text: &str| parse(text.as_bytes()).unwrap_err();
        let post = |lines: &str| refused(&format!("POST / HTTP/1.1\r\n{lines}\r\n\r\n"));
        assert_eq!(post("Content-Length: 99999"), BadRequest::Refused(413));
        for lines in [
            "Content-Length: 1\r\nContent-Length: 2",
            "Content-Length: +1",
            "Content-Length:",
            "Transfer-Encoding: chunked",
        ] {
            assert_eq!(post(lines), BadRequest::Refused(400), "{lines}");
        }
        assert_eq!(post(&["A: b"; 65].join("\r\n")), BadRequest::Refused(431));
        assert_eq!(refused("\u{1} /\r\n\r\n"), BadRequest::Refused(400));
    }
}
