//! JSON text to nodes, strictly as RFC 8259 has it, bounded in depth, without recursion.

mod text;

use super::pointer::PointerStep;
use super::{Form, Node, NodeId, Tree, keys, to_u32};
use crate::FileId;

/// How deep lists and maps may lie in each other.
const MAX_DEPTH: usize = 512;

/// Why a text is no tree, and where.
#[derive(Debug, PartialEq, Eq)]
pub struct JsonFault {
    /// The offset in the text of the first byte that can't be.
    pub at: usize,
    /// What is wrong.
    pub what: &'static str,
}

impl From<(usize, &'static str)> for JsonFault {
    fn from((at, what): (usize, &'static str)) -> Self {
        Self { at, what }
    }
}

/// Parses `text`, which begins `base` bytes into `file`.
///
/// # Errors
/// The first fault.
pub fn parse(file: FileId, base: u32, text: &str) -> Result<Tree<'_>, JsonFault> {
    match begin(file, base, text) {
        (tree, None) => Ok(tree),
        (_, Some(fault)) => Err(fault),
    }
}

/// Parses `text` up to the first fault; what is open there ends there.
#[must_use]
pub fn begin(file: FileId, base: u32, text: &str) -> (Tree<'_>, Option<JsonFault>) {
    let mut scan = Scan {
        bytes: text.as_bytes(),
        at: 0,
        tree: Tree::new(file, base, text),
        open: Vec::new(),
    };
    let fault = scan.document().err();
    let end = to_u32(scan.at);
    let after = to_u32(scan.tree.nodes.len());
    for (index, _) in scan.open {
        let node = &mut scan.tree.nodes[index as usize];
        (node.end, node.link) = (end, after);
    }
    (scan.tree, fault)
}

struct Scan<'s> {
    bytes: &'s [u8],
    at: usize,
    tree: Tree<'s>,
    /// The lists and maps that are not closed yet, and how many values they have so far.
    open: Vec<(u32, u32)>,
}

impl Scan<'_> {
    fn document(&mut self) -> Result<(), JsonFault> {
        loop {
            self.value()?;
            if self.close_all()? {
                break;
            }
        }
        match self.peek() {
            None => Ok(()),
            Some(_) => Err(self.fault("something follows the end of the document")),
        }
    }

    /// Skips white space; the byte after it.
    fn peek(&mut self) -> Option<u8> {
        while let Some(b' ' | b'\t' | b'\n' | b'\r') = self.bytes.get(self.at) {
            self.at += 1;
        }
        self.bytes.get(self.at).copied()
    }

    fn fault(&self, what: &'static str) -> JsonFault {
        JsonFault::from((self.at, what))
    }

    /// Reads a value up to its end, or a list or map up to its first value.
    fn value(&mut self) -> Result<(), JsonFault> {
        loop {
            match self.peek() {
                None => return Err(self.fault("the text ends too early")),
                Some(b'[') => {
                    self.open(Form::List)?;
                    if self.peek() == Some(b']') {
                        return Ok(());
                    }
                }
                Some(b'{') => {
                    self.open(Form::Map)?;
                    if self.peek() == Some(b'}') {
                        return Ok(());
                    }
                    self.key()?;
                }
                Some(b'"') => return self.quoted(false),
                Some(b'-' | b'0'..=b'9') => return self.number(),
                Some(_) => return self.word(),
            }
        }
    }

    /// Closes what ends here, and goes to the next value. True if the document has ended.
    fn close_all(&mut self) -> Result<bool, JsonFault> {
        loop {
            let Some(&(parent, _)) = self.open.last() else {
                return Ok(true);
            };
            let form = self.tree.nodes[parent as usize].form;
            match (self.peek(), form) {
                (Some(b']'), Form::List) | (Some(b'}'), Form::Map) => self.close(),
                (Some(b','), _) => {
                    self.at += 1;
                    if form == Form::Map {
                        self.peek();
                        self.key()?;
                    }
                    return Ok(false);
                }
                (None, _) => return Err(self.fault("the text ends too early")),
                (Some(_), _) => return Err(self.fault("expected a comma or the closing bracket")),
            }
        }
    }

    fn push(&mut self, form: Form, link: u32, end: usize, is_key: bool) {
        let (parent, slot) = match self.open.last_mut() {
            Some((parent, count)) => {
                let slot = *count;
                *count += u32::from(!is_key);
                (*parent, slot)
            }
            None => (0, 0),
        };
        self.tree.steps.push(PointerStep { parent, slot });
        self.tree.nodes.push(Node {
            start: to_u32(self.at),
            end: to_u32(end),
            link,
            form,
        });
        self.at = end;
    }

    fn open(&mut self, form: Form) -> Result<(), JsonFault> {
        if self.open.len() == MAX_DEPTH {
            return Err(self.fault("lists and objects lie too deep in each other"));
        }
        let index = to_u32(self.tree.nodes.len());
        self.push(form, index + 1, self.at + 1, false);
        self.open.push((index, 0));
        Ok(())
    }

    fn close(&mut self) {
        self.at += 1;
        let Some((index, _)) = self.open.pop() else {
            return;
        };
        let after = to_u32(self.tree.nodes.len());
        let node = &mut self.tree.nodes[index as usize];
        (node.end, node.link) = (to_u32(self.at), after);
        if node.form == Form::Map {
            keys::close(&mut self.tree, NodeId(index));
        }
    }

    fn key(&mut self) -> Result<(), JsonFault> {
        if self.bytes.get(self.at) != Some(&b'"') {
            return Err(self.fault("expected a key in quotes"));
        }
        self.quoted(true)?;
        if self.peek() != Some(b':') {
            return Err(self.fault("expected a colon after the key"));
        }
        self.at += 1;
        Ok(())
    }

    /// Reads a text in quotes.
    fn quoted(&mut self, is_key: bool) -> Result<(), JsonFault> {
        let (end, has_escapes) = text::end(self.bytes, self.at)?;
        if has_escapes {
            let Tree { source, .. } = self.tree;
            let inside = source.get(self.at + 1..end - 1);
            let inside = inside.expect("quotes are characters");
            let link = self.tree.cook(|said| text::resolve(inside, said));
            self.push(Form::Cooked, link, end, is_key);
        } else {
            self.push(Form::Quoted, 0, end, is_key);
        }
        Ok(())
    }

    fn word(&mut self) -> Result<(), JsonFault> {
        let words = [
            ("null", Form::Null),
            ("true", Form::Bool),
            ("false", Form::Bool),
        ];
        let rest = &self.bytes[self.at..];
        let Some((word, form)) = words
            .into_iter()
            .find(|(word, _)| rest.starts_with(word.as_bytes()))
        else {
            return Err(self.fault("expected a value"));
        };
        self.push(form, 0, self.at + word.len(), false);
        Ok(())
    }

    fn number(&mut self) -> Result<(), JsonFault> {
        let start = self.at;
        self.at += usize::from(self.bytes[self.at] == b'-');
        if self.bytes.get(self.at) == Some(&b'0') {
            self.at += 1;
            if self.bytes.get(self.at).is_some_and(u8::is_ascii_digit) {
                return Err(self.fault("a number starts with a zero too many"));
            }
        } else {
            self.digits()?;
        }
        if self.bytes.get(self.at) == Some(&b'.') {
            self.at += 1;
            self.digits()?;
        }
        if let Some(b'e' | b'E') = self.bytes.get(self.at) {
            self.at += 1;
            self.at += usize::from(matches!(self.bytes.get(self.at), Some(b'+' | b'-')));
            self.digits()?;
        }
        let end = std::mem::replace(&mut self.at, start);
        self.push(Form::Number, 0, end, false);
        Ok(())
    }

    fn digits(&mut self) -> Result<(), JsonFault> {
        let count = self.bytes[self.at..]
            .iter()
            .take_while(|byte| byte.is_ascii_digit())
            .count();
        self.at += count;
        if count == 0 {
            Err(self.fault("expected a digit"))
        } else {
            Ok(())
        }
    }
}
