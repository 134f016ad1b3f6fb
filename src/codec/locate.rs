//! Where a decoder stopped in a JSON text: the span of the culprit and its JSON pointer.
//!
//! Runs only when something is wrong. Up to where the decoder stopped the text is sound JSON, so a
//! rough scan is enough.

/// The culprit: its bytes and its JSON pointer, empty for the whole document.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Culprit {
    pub(super) start: usize,
    pub(super) end: usize,
    pub(super) pointer: String,
}

/// The byte offset behind `column` bytes of `line`, counted from 1 as `serde_json` does.
pub(super) fn offset(text: &str, line: usize, column: usize) -> usize {
    let start = match line {
        0 | 1 => 0,
        _ => text
            .match_indices('\n')
            .nth(line - 2)
            .map_or(text.len(), |(at, _)| at + 1),
    };
    (start + column).min(text.len())
}

/// The list or map being read, and where in it.
struct Frame {
    start: usize,
    step: Step,
}

enum Step {
    Index(usize),
    Key(String),
}

/// The value or key that ends at `read`, or else the value that starts there.
pub(super) fn culprit(text: &str, read: usize) -> Culprit {
    let mut scan = Scan {
        text: text.as_bytes(),
        frames: Vec::new(),
        last: None,
        key_next: false,
    };
    let mut at = 0;
    while at < read.min(text.len()) {
        at = scan.token(at);
    }
    let (start, end) = scan.last.unwrap_or_else(|| next_token(text, at));
    Culprit {
        start,
        end,
        pointer: scan.pointer(),
    }
}

/// A member of the document, or an item of a list that is one.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Part {
    pub(super) key: String,
    /// Which item of the list.
    pub(super) index: Option<usize>,
    pub(super) start: usize,
    pub(super) end: usize,
}

/// The members of the document, and the items of those that are lists, in the order of their ends.
pub(super) fn parts(text: &str) -> Vec<Part> {
    let mut scan = Scan {
        text: text.as_bytes(),
        frames: Vec::new(),
        last: None,
        key_next: false,
    };
    let (mut at, mut parts) = (0, Vec::new());
    while at < text.len() {
        let before = scan.last;
        at = scan.token(at);
        let Some((start, end)) = scan.last.filter(|_| scan.last != before && !scan.key_next) else {
            continue;
        };
        let steps: Vec<_> = scan
            .frames
            .iter()
            .take(3)
            .map(|frame| &frame.step)
            .collect();
        match steps.as_slice() {
            [Step::Key(key)] => parts.push(Part {
                key: key.clone(),
                index: None,
                start,
                end,
            }),
            [Step::Key(key), Step::Index(index)] => {
                parts.push(Part {
                    key: key.clone(),
                    index: Some(*index),
                    start,
                    end,
                });
            }
            _ => {}
        }
    }
    parts
}

/// The first character from `at` on that is not white space; empty at the end.
fn next_token(text: &str, at: usize) -> (usize, usize) {
    let rest = text.get(at..).unwrap_or("");
    let start = text.len() - rest.trim_start().len();
    let width = text
        .get(start..)
        .and_then(|rest| rest.chars().next())
        .map_or(0, char::len_utf8);
    (start, start + width)
}

struct Scan<'a> {
    text: &'a [u8],
    frames: Vec<Frame>,
    /// The value or key just read; none after a bracket that opens, a comma or a colon.
    last: Option<(usize, usize)>,
    /// The next string is a key.
    key_next: bool,
}

impl Scan<'_> {
    /// Takes the token at `at` and returns where it ends.
    fn token(&mut self, at: usize) -> usize {
        match self.text[at] {
            byte if byte.is_ascii_whitespace() => return at + 1,
            b'{' => self.open(at, Step::Key(String::new())),
            b'[' => self.open(at, Step::Index(0)),
            b'}' | b']' => {
                (self.last, self.key_next) =
                    (self.frames.pop().map(|frame| (frame.start, at + 1)), false);
            }
            b',' => self.comma(),
            b':' => (self.last, self.key_next) = (None, false),
            b'"' => return self.string(at),
            _ => return self.scalar(at),
        }
        at + 1
    }

    fn open(&mut self, start: usize, step: Step) {
        self.key_next = matches!(step, Step::Key(_));
        self.frames.push(Frame { start, step });
        self.last = None;
    }

    fn comma(&mut self) {
        match self.frames.last_mut().map(|frame| &mut frame.step) {
            Some(Step::Index(index)) => *index += 1,
            Some(Step::Key(_)) => self.key_next = true,
            None => {}
        }
        self.last = None;
    }

    fn string(&mut self, start: usize) -> usize {
        let mut end = start + 1;
        while end < self.text.len() && self.text[end] != b'"' {
            end += if self.text[end] == b'\\' { 2 } else { 1 };
        }
        let end = (end + 1).min(self.text.len());
        self.last = Some((start, end));
        if let (true, Some(Step::Key(key))) = (
            self.key_next,
            self.frames.last_mut().map(|frame| &mut frame.step),
        ) {
            *key = String::from_utf8_lossy(
                &self.text[start + 1..end.saturating_sub(1).max(start + 1)],
            )
            .into_owned();
        }
        end
    }

    fn scalar(&mut self, start: usize) -> usize {
        let ends = |byte: &u8| byte.is_ascii_whitespace() || b",:[]{}\"".contains(byte);
        let end = self.text[start..]
            .iter()
            .position(ends)
            .map_or(self.text.len(), |length| start + length);
        self.last = Some((start, end));
        end
    }

    fn pointer(&self) -> String {
        let step = |frame: &Frame| match &frame.step {
            Step::Index(index) => format!("/{index}"),
            Step::Key(key) => format!("/{}", key.replace('~', "~0").replace('/', "~1")),
        };
        self.frames.iter().map(step).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_members_and_items_of_lists() {
        let text = r#"{"a": [1, {"b": "x"}], "c": {}}"#;
        let found: Vec<_> = parts(text)
            .iter()
            .map(|part| (part.index, text.get(part.start..part.end).unwrap()))
            .collect();
        let list = (None, r#"[1, {"b": "x"}]"#);
        assert_eq!(
            found,
            [
                (Some(0), "1"),
                (Some(1), r#"{"b": "x"}"#),
                list,
                (None, "{}")
            ]
        );
    }

    #[test]
    fn finds_values_keys_and_containers() {
        let text = r#"{"a": [1, {"b": "x"}, 22], "c": {}}"#;
        let found = |read: &str| {
            let culprit = culprit(text, text.find(read).unwrap() + read.len());
            (
                text.get(culprit.start..culprit.end).unwrap().to_owned(),
                culprit.pointer,
            )
        };
        let pair = |text: &str, pointer: &str| (text.to_owned(), pointer.to_owned());
        assert_eq!(found(r#""x""#), pair(r#""x""#, "/a/1/b"));
        assert_eq!(found(r#""x"}"#), pair(r#"{"b": "x"}"#, "/a/1"));
        assert_eq!(found("22"), pair("22", "/a/2"));
        assert_eq!(found(r#""c""#), pair(r#""c""#, "/c"));
        assert_eq!(found(r#""c": "#), pair("{", "/c"));
        assert_eq!(found("22]"), pair(r#"[1, {"b": "x"}, 22]"#, "/a"));
    }
}
