//! JSON text to nodes, strictly as RFC 8259 has it, bounded in depth, without recursion.

use super::{Kind, Node, NodeId, Tree, text};
use crate::source::FileId;
use std::borrow::Cow;
use std::collections::BTreeMap;

/// How deep lists and maps may lie in each other.
const MAX_DEPTH: usize = 512;
/// Maps up to this size are searched pair by pair; the keys of larger ones are sorted.
const FEW_KEYS: usize = 12;

/// Why a text is no tree, and where.
#[derive(Debug, PartialEq, Eq)]
pub struct Fault {
    /// The offset in the text of the first byte that can't be.
    pub at: usize,
    /// What is wrong.
    pub what: &'static str,
}

impl From<(usize, &'static str)> for Fault {
    fn from((at, what): (usize, &'static str)) -> Self {
        Self { at, what }
    }
}

/// Parses `text`, which begins `base` bytes into `file`.
///
/// # Errors
/// The first fault.
pub fn parse(file: FileId, base: u32, text: &str) -> Result<Tree<'_>, Fault> {
    let tree = Tree {
        text,
        base,
        file,
        nodes: Vec::new(),
        twice: Vec::new(),
        wide: BTreeMap::new(),
    };
    let mut scan = Scan {
        bytes: text.as_bytes(),
        at: 0,
        tree,
        open: Vec::new(),
    };
    scan.document()?;
    Ok(scan.tree)
}

struct Scan<'s> {
    bytes: &'s [u8],
    at: usize,
    tree: Tree<'s>,
    /// The lists and maps that are not closed yet, and how many values they have so far.
    open: Vec<(u32, u32)>,
}

impl Scan<'_> {
    fn document(&mut self) -> Result<(), Fault> {
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

    fn fault(&self, what: &'static str) -> Fault {
        Fault::from((self.at, what))
    }

    /// Reads a value up to its end, or a list or map up to its first value.
    fn value(&mut self) -> Result<(), Fault> {
        loop {
            match self.peek() {
                None => return Err(self.fault("the text ends too early")),
                Some(b'[') => {
                    self.open(Kind::List)?;
                    if self.peek() == Some(b']') {
                        return Ok(());
                    }
                }
                Some(b'{') => {
                    self.open(Kind::Map)?;
                    if self.peek() == Some(b'}') {
                        return Ok(());
                    }
                    self.key()?;
                }
                Some(b'"') => return self.text(),
                Some(b'-' | b'0'..=b'9') => return self.number(),
                Some(_) => return self.word(),
            }
        }
    }

    /// Closes what ends here, and goes to the next value. True if the document has ended.
    fn close_all(&mut self) -> Result<bool, Fault> {
        loop {
            let Some(&(parent, _)) = self.open.last() else {
                return Ok(true);
            };
            let kind = self.tree.nodes[parent as usize].kind;
            match (self.peek(), kind) {
                (Some(b']'), Kind::List) | (Some(b'}'), Kind::Map) => self.close(),
                (Some(b','), _) => {
                    self.at += 1;
                    if kind == Kind::Map {
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

    fn push(&mut self, kind: Kind, start: usize, end: usize, is_key: bool) {
        let index = to_u32(self.tree.nodes.len());
        let (parent, slot) = match self.open.last_mut() {
            Some((parent, count)) => {
                let slot = *count;
                *count += u32::from(!is_key);
                (*parent, slot)
            }
            None => (0, 0),
        };
        let node = Node {
            start: to_u32(start),
            end: to_u32(end),
            after: index + 1,
            parent,
            slot,
            kind,
        };
        self.tree.nodes.push(node);
    }

    fn open(&mut self, kind: Kind) -> Result<(), Fault> {
        if self.open.len() == MAX_DEPTH {
            return Err(self.fault("lists and objects lie too deep in each other"));
        }
        let index = to_u32(self.tree.nodes.len());
        self.push(kind, self.at, self.at + 1, false);
        self.open.push((index, 0));
        self.at += 1;
        Ok(())
    }

    fn close(&mut self) {
        self.at += 1;
        let Some((index, _)) = self.open.pop() else {
            return;
        };
        let after = to_u32(self.tree.nodes.len());
        let node = &mut self.tree.nodes[index as usize];
        (node.end, node.after) = (to_u32(self.at), after);
        if node.kind == Kind::Map {
            self.keys_differ(NodeId(index));
        }
    }

    fn key(&mut self) -> Result<(), Fault> {
        if self.bytes.get(self.at) != Some(&b'"') {
            return Err(self.fault("expected a key in quotes"));
        }
        let end = text::end(self.bytes, self.at)?;
        self.push(Kind::Text, self.at, end, true);
        self.at = end;
        if self.peek() != Some(b':') {
            return Err(self.fault("expected a colon after the key"));
        }
        self.at += 1;
        Ok(())
    }

    fn text(&mut self) -> Result<(), Fault> {
        let end = text::end(self.bytes, self.at)?;
        self.push(Kind::Text, self.at, end, false);
        self.at = end;
        Ok(())
    }

    fn word(&mut self) -> Result<(), Fault> {
        let words = [
            ("null", Kind::Null),
            ("true", Kind::Truth),
            ("false", Kind::Truth),
        ];
        let rest = &self.bytes[self.at..];
        let Some((word, kind)) = words
            .into_iter()
            .find(|(word, _)| rest.starts_with(word.as_bytes()))
        else {
            return Err(self.fault("expected a value"));
        };
        self.push(kind, self.at, self.at + word.len(), false);
        self.at += word.len();
        Ok(())
    }

    fn number(&mut self) -> Result<(), Fault> {
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
        self.push(Kind::Number, start, self.at, false);
        Ok(())
    }

    fn digits(&mut self) -> Result<(), Fault> {
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

    fn keys_differ(&mut self, map: NodeId) {
        let mut keys: Vec<(Cow<'_, str>, NodeId)> = self
            .tree
            .pairs(map)
            .map(|(key, _)| (text::value(self.tree.written(key)), key))
            .collect();
        let mut twice = Vec::new();
        if keys.len() <= FEW_KEYS {
            let before = |at: usize| keys[..at].iter().find(|(key, _)| *key == keys[at].0);
            twice.extend((1..keys.len()).filter_map(|at| Some((before(at)?.1, keys[at].1))));
        } else {
            keys.sort_unstable();
            twice.extend(
                keys.windows(2)
                    .filter(|pair| pair[0].0 == pair[1].0)
                    .map(|pair| (pair[0].1, pair[1].1)),
            );
            let sorted = keys.into_iter().map(|(_, key)| key).collect();
            self.tree.wide.insert(map, sorted);
        }
        self.tree.twice.append(&mut twice);
    }
}

/// An offset or index of a text below 4 GiB.
fn to_u32(count: usize) -> u32 {
    u32::try_from(count).expect("the loader refuses files of 4 GiB and more")
}
