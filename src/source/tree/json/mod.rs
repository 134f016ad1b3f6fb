//! Parses JSON text to nodes, strictly by RFC 8259, with bounded depth and without recursion.

mod text;

use super::pointer::PointerStep;
use super::{NodeId, NodeSyntax, SyntaxTree, TreeNode, keys};
use crate::FileId;
use rtc_math::to_u32;

/// The maximum nesting depth.
const MAX_DEPTH: usize = 512;

/// Why a text is not JSON, and where.
#[derive(Debug, PartialEq, Eq)]
pub struct JsonError {
    /// The offset of the first invalid byte in the text.
    pub at: usize,
    /// The message.
    pub message: &'static str,
}

impl From<(usize, &'static str)> for JsonError {
    fn from((at, message): (usize, &'static str)) -> Self {
        Self { at, message }
    }
}

/// Parses `text`, which starts `base` bytes into `file`.
///
/// # Errors
/// The first error.
pub fn parse(file: FileId, base: u32, text: &str) -> Result<SyntaxTree<'_>, JsonError> {
    match parse_prefix(file, base, text) {
        (tree, None) => Ok(tree),
        (_, Some(error)) => Err(error),
    }
}

/// Parses `text` up to the first error, where all open lists and maps end.
#[must_use]
pub fn parse_prefix(file: FileId, base: u32, text: &str) -> (SyntaxTree<'_>, Option<JsonError>) {
    let mut scan = JsonScanner {
        bytes: text.as_bytes(),
        at: 0,
        tree: SyntaxTree::new(file, base, text),
        open: Vec::new(),
    };
    let error = scan.document().err();
    let end = to_u32(scan.at);
    let after = to_u32(scan.tree.nodes.len());
    for (index, _) in scan.open {
        let node = &mut scan.tree.nodes[index as usize];
        (node.end, node.link) = (end, after);
    }
    (scan.tree, error)
}

struct JsonScanner<'s> {
    bytes: &'s [u8],
    at: usize,
    tree: SyntaxTree<'s>,
    /// The open lists and maps with the number of their values so far.
    open: Vec<(u32, u32)>,
}

impl JsonScanner<'_> {
    fn document(&mut self) -> Result<(), JsonError> {
        loop {
            self.value()?;
            if self.close_all()? {
                break;
            }
        }
        match self.peek() {
            None => Ok(()),
            Some(_) => Err(self.error("something follows the end of the document")),
        }
    }

    /// Skips white space and returns the next byte.
    fn peek(&mut self) -> Option<u8> {
        while let Some(b' ' | b'\t' | b'\n' | b'\r') = self.bytes.get(self.at) {
            self.at += 1;
        }
        self.bytes.get(self.at).copied()
    }

    fn error(&self, message: &'static str) -> JsonError {
        JsonError::from((self.at, message))
    }

    /// Reads a scalar, or the beginning of a list or map up to its first scalar.
    fn value(&mut self) -> Result<(), JsonError> {
        loop {
            match self.peek() {
                None => return Err(self.error("the text ends too early")),
                Some(b'[') => {
                    self.open(NodeSyntax::List)?;
                    if self.peek() == Some(b']') {
                        return Ok(());
                    }
                }
                Some(b'{') => {
                    self.open(NodeSyntax::Map)?;
                    if self.peek() == Some(b'}') {
                        return Ok(());
                    }
                    self.key()?;
                }
                Some(b'"') => return self.quoted(false),
                Some(b'-' | b'0'..=b'9') => return self.number(),
                Some(_) => return self.literal(),
            }
        }
    }

    /// Closes lists and maps that end here and moves to the next value. True at the end of the
    /// document.
    fn close_all(&mut self) -> Result<bool, JsonError> {
        loop {
            let Some(&(parent, _)) = self.open.last() else {
                return Ok(true);
            };
            let syntax = self.tree.nodes[parent as usize].syntax;
            match (self.peek(), syntax) {
                (Some(b']'), NodeSyntax::List) | (Some(b'}'), NodeSyntax::Map) => self.close(),
                (Some(b','), _) => {
                    self.at += 1;
                    if syntax == NodeSyntax::Map {
                        self.peek();
                        self.key()?;
                    }
                    return Ok(false);
                }
                (None, _) => return Err(self.error("the text ends too early")),
                (Some(_), _) => return Err(self.error("expected a comma or the closing bracket")),
            }
        }
    }

    fn push(&mut self, syntax: NodeSyntax, link: u32, end: usize, is_key: bool) {
        let (parent, slot) = match self.open.last_mut() {
            Some((parent, count)) => {
                let slot = *count;
                *count += u32::from(!is_key);
                (*parent, slot)
            }
            None => (0, 0),
        };
        self.tree.steps.push(PointerStep { parent, slot });
        self.tree.nodes.push(TreeNode {
            start: to_u32(self.at),
            end: to_u32(end),
            link,
            syntax,
        });
        self.at = end;
    }

    fn open(&mut self, syntax: NodeSyntax) -> Result<(), JsonError> {
        if self.open.len() == MAX_DEPTH {
            return Err(self.error("lists and objects lie too deep in each other"));
        }
        let index = to_u32(self.tree.nodes.len());
        self.push(syntax, index + 1, self.at + 1, false);
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
        if node.syntax == NodeSyntax::Map {
            keys::close(&mut self.tree, NodeId(index));
        }
    }

    fn key(&mut self) -> Result<(), JsonError> {
        if self.bytes.get(self.at) != Some(&b'"') {
            return Err(self.error("expected a key in quotes"));
        }
        self.quoted(true)?;
        if self.peek() != Some(b':') {
            return Err(self.error("expected a colon after the key"));
        }
        self.at += 1;
        Ok(())
    }

    /// Reads a quoted string.
    fn quoted(&mut self, is_key: bool) -> Result<(), JsonError> {
        let (end, has_escapes) = text::end(self.bytes, self.at)?;
        if has_escapes {
            let SyntaxTree { source, .. } = self.tree;
            let inside = source.get(self.at + 1..end - 1);
            let inside = inside.expect("quotes are characters");
            let link = self
                .tree
                .unescape_with(|value| text::resolve(inside, value));
            self.push(NodeSyntax::Unescaped, link, end, is_key);
        } else {
            self.push(NodeSyntax::Quoted, 0, end, is_key);
        }
        Ok(())
    }

    fn literal(&mut self) -> Result<(), JsonError> {
        let literals = [
            ("null", NodeSyntax::Null),
            ("true", NodeSyntax::Bool),
            ("false", NodeSyntax::Bool),
        ];
        let rest = &self.bytes[self.at..];
        let Some((literal, syntax)) = literals
            .into_iter()
            .find(|(literal, _)| rest.starts_with(literal.as_bytes()))
        else {
            return Err(self.error("expected a value"));
        };
        self.push(syntax, 0, self.at + literal.len(), false);
        Ok(())
    }

    fn number(&mut self) -> Result<(), JsonError> {
        let start = self.at;
        self.at += usize::from(self.bytes[self.at] == b'-');
        if self.bytes.get(self.at) == Some(&b'0') {
            self.at += 1;
            if self.bytes.get(self.at).is_some_and(u8::is_ascii_digit) {
                return Err(self.error("a number starts with a zero too many"));
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
        self.push(NodeSyntax::Number, 0, end, false);
        Ok(())
    }

    fn digits(&mut self) -> Result<(), JsonError> {
        let count = self.bytes[self.at..]
            .iter()
            .take_while(|byte| byte.is_ascii_digit())
            .count();
        self.at += count;
        if count == 0 {
            Err(self.error("expected a digit"))
        } else {
            Ok(())
        }
    }
}
