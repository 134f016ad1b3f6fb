//! Messages on the wire: header lines, then JSON (Language Server Protocol 3.17, "Base Protocol"),
//! and the queue of pending requests.

use lsp_server::{Message, RequestId};
use serde::Deserialize;
use serde_json::{Value, json};
use std::collections::VecDeque;
use std::io::{self, BufRead, Read, Write};
use std::sync::mpsc::{self, Receiver, Sender};
use std::thread;

/// The largest message that is taken, in bytes.
const MAX_MESSAGE: u64 = 1 << 28;

/// The longest line of a head, in bytes.
const MAX_LINE: u64 = 1 << 12;

/// The method of a cancellation.
const CANCEL: &str = "$/cancelRequest";

/// What came in.
#[derive(Debug)]
pub(super) enum IncomingMessage {
    /// A message.
    Message(Message),
    /// A request that was cancelled before it began.
    Cancelled(RequestId),
    /// An invalid body, with the code and message of the response.
    NoMessage(i32, String),
    /// Messages of ours for the editor, from a command that is done.
    Done(Vec<Message>),
    /// The end of the stream.
    End,
    /// A stream error, with its message.
    Broken(String),
}

/// The messages that wait, in their order.
pub(super) struct MessageQueue {
    receiver: Receiver<IncomingMessage>,
    sender: Sender<IncomingMessage>,
    waiting: VecDeque<IncomingMessage>,
}

impl MessageQueue {
    /// The queue of a stream, which is read by a thread of its own.
    ///
    /// # Errors
    /// If there is no thread to be had.
    pub(super) fn of(mut input: impl BufRead + Send + 'static) -> io::Result<Self> {
        let (sender, receiver) = mpsc::channel();
        let own = sender.clone();
        let read = move || {
            loop {
                let (incoming, is_last) = match next(&mut input) {
                    Ok(Some(incoming)) => (incoming, false),
                    Ok(None) => (IncomingMessage::End, true),
                    Err(error) => (IncomingMessage::Broken(error.to_string()), true),
                };
                if own.send(incoming).is_err() || is_last {
                    return;
                }
            }
        };
        let reader = thread::Builder::new().name("reader".to_owned());
        drop(reader.spawn(read)?);
        Ok(Self {
            receiver,
            sender,
            waiting: VecDeque::new(),
        })
    }

    /// Does some work in a thread of its own; its messages arrive here.
    ///
    /// # Errors
    /// If there is no thread to be had.
    pub(super) fn work(
        &self,
        work: impl FnOnce() -> Vec<Message> + Send + 'static,
    ) -> io::Result<()> {
        let sender = self.sender.clone();
        let done = move || {
            // Without a reader the server has ended.
            let _ = sender.send(IncomingMessage::Done(work()));
        };
        let worker = thread::Builder::new().name("command".to_owned());
        worker.spawn(done).map(drop)
    }

    /// The next message, if one is there.
    pub(super) fn next(&mut self) -> Option<IncomingMessage> {
        while let Ok(incoming) = self.receiver.try_recv() {
            self.put(incoming);
        }
        self.waiting.pop_front()
    }

    /// The next message, which may be waited for; `None` if no more can come.
    pub(super) fn wait(&mut self) -> Option<IncomingMessage> {
        if let Some(incoming) = self.next() {
            return Some(incoming);
        }
        self.put(self.receiver.recv().ok()?);
        self.next()
    }

    /// Queues a message, or cancels a queued one if it is a cancellation.
    fn put(&mut self, incoming: IncomingMessage) {
        let Some(id) = taken_back(&incoming) else {
            return self.waiting.push_back(incoming);
        };
        let is_meant = |waiting: &&mut IncomingMessage| match waiting {
            IncomingMessage::Message(Message::Request(request)) => request.id == id,
            IncomingMessage::Message(Message::Response(_) | Message::Notification(_))
            | IncomingMessage::Cancelled(_)
            | IncomingMessage::NoMessage(..)
            | IncomingMessage::Done(_)
            | IncomingMessage::End
            | IncomingMessage::Broken(_) => false,
        };
        if let Some(suggestion) = self.waiting.iter_mut().find(is_meant) {
            *suggestion = IncomingMessage::Cancelled(id);
        }
    }
}

/// The request that a message takes back.
fn taken_back(incoming: &IncomingMessage) -> Option<RequestId> {
    let IncomingMessage::Message(Message::Notification(own)) = incoming else {
        return None;
    };
    let id = own.params.get("id").filter(|_| own.method == CANCEL)?;
    RequestId::deserialize(id).ok()
}

/// The next message of a stream; none at its end.
fn next(input: &mut impl BufRead) -> io::Result<Option<IncomingMessage>> {
    let Some(length) = head(input)? else {
        return Ok(None);
    };
    let mut body = Vec::new();
    // Memory is allocated as data arrives, not by the announced length.
    if input.take(length).read_to_end(&mut body)? as u64 != length {
        return Ok(None);
    }
    let no_message = |code: lsp_server::ErrorCode, error: serde_json::Error| {
        IncomingMessage::NoMessage(code as i32, error.to_string())
    };
    let value: Value = match serde_json::from_slice(&body) {
        Ok(value) => value,
        Err(error) => return Ok(Some(no_message(lsp_server::ErrorCode::ParseError, error))),
    };
    Ok(Some(match serde_json::from_value(value) {
        Ok(message) => IncomingMessage::Message(message),
        Err(error) => no_message(lsp_server::ErrorCode::InvalidRequest, error),
    }))
}

/// The length of the message whose head comes next; none at the end of the stream.
fn head(input: &mut impl BufRead) -> io::Result<Option<u64>> {
    let wrong = |message: &str| io::Error::new(io::ErrorKind::InvalidData, message.to_owned());
    let mut length = None;
    loop {
        let mut line = Vec::new();
        input.take(MAX_LINE).read_until(b'\n', &mut line)?;
        if line.is_empty() {
            return Ok(None);
        }
        let line = str::from_utf8(&line).map_err(|_| wrong("the head of a message is no text"))?;
        if line.trim().is_empty() {
            break;
        }
        let (name, value) = line
            .split_once(':')
            .filter(|_| line.ends_with('\n'))
            .ok_or_else(|| wrong("a line in the head of a message is no `name: value`"))?;
        if name.trim().eq_ignore_ascii_case("Content-Length") {
            length = value.trim().parse().ok().filter(|own| *own <= MAX_MESSAGE);
        }
    }
    let length = length
        .ok_or_else(|| wrong("a message has no `Content-Length`, or one of more than 256 MB"))?;
    Ok(Some(length))
}

/// Answers an invalid message, which has no id.
///
/// # Errors
/// If the stream can't be written.
pub(super) fn refuse(out: &mut impl Write, code: i32, message: &str) -> io::Result<()> {
    let error = json!({ "code": code, "message": message });
    let answer = json!({ "jsonrpc": "2.0", "id": null, "error": error }).to_string();
    write!(out, "Content-Length: {}\r\n\r\n{answer}", answer.len())?;
    out.flush()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn framed(body: &str) -> String {
        format!("Content-Length: {}\r\n\r\n{body}", body.len())
    }

    fn read(text: &str) -> Vec<String> {
        let mut input = text.as_bytes();
        let reported = |incoming| match incoming {
            IncomingMessage::Message(Message::Request(own)) => format!("request {}", own.id),
            IncomingMessage::Message(Message::Notification(own)) => own.method,
            IncomingMessage::Message(Message::Response(_)) => "response".to_owned(),
            IncomingMessage::Cancelled(id) => format!("cancelled {id}"),
            IncomingMessage::NoMessage(code, _) => format!("no message {code}"),
            IncomingMessage::Done(_) => "done".to_owned(),
            IncomingMessage::End => "end".to_owned(),
            IncomingMessage::Broken(_) => "broken".to_owned(),
        };
        let mut all = Vec::new();
        loop {
            match next(&mut input) {
                Ok(Some(incoming)) => all.push(reported(incoming)),
                Ok(None) => return all,
                Err(error) => {
                    all.push(error.kind().to_string());
                    return all;
                }
            }
        }
    }

    #[test]
    fn what_is_no_message_is_told_and_the_next_is_read() {
        let bad = framed("{\"id\": }") + &framed("[1]");
        let good = framed(r#"{"id":7,"method":"shutdown"}"#);
        assert_eq!(
            read(&(bad + &good)),
            ["no message -32700", "no message -32600", "request 7"]
        );
    }

    #[test]
    fn a_head_that_promises_too_much_ends_it_and_takes_no_memory() {
        let wrong = io::ErrorKind::InvalidData.to_string();
        for text in [
            "Content-Length: 99999999999999\r\n\r\n{}",
            "Content-Length: -1\r\n\r\n{}",
            "Content-Type: x\r\n\r\n{}",
            "GET / HTTP/1.1\r\n\r\n",
            &"x".repeat(1 << 13),
        ] {
            assert_eq!(read(text), [wrong.as_str()], "{text}");
        }
        assert!(read("Content-Length: 200000000\r\n\r\n{").is_empty());
    }

    #[test]
    fn requests_that_wait_can_be_taken_back() {
        let text = framed(r#"{"id":1,"method":"a"}"#)
            + &framed(r#"{"id":"x","method":"b"}"#)
            + &framed(r#"{"method":"$/cancelRequest","params":{"id":"x"}}"#);
        let mut inbox = MessageQueue::of(io::Cursor::new(text)).unwrap();
        let first = inbox.wait().unwrap();
        assert!(matches!(
            first,
            IncomingMessage::Message(Message::Request(_))
        ));
        let (mut others, mut cancelled) = (0, 0);
        while let Some(own) = inbox
            .wait()
            .filter(|own| !matches!(own, IncomingMessage::End))
        {
            others += 1;
            cancelled += usize::from(matches!(own, IncomingMessage::Cancelled(_)));
        }
        // Whether the second still waited when it was taken back is for the threads to say.
        assert_eq!(others, 1);
        assert!(cancelled <= 1);
    }
}
