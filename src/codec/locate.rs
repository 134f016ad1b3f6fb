//! Finds the bytes and the JSON pointer where a decoder stopped.
//!
//! Used only for a document that is JSON but not a scene, so its tree holds the node.

use rtc_source::tree::{NodeId, SyntaxTree};

/// The node at which decoding stopped: its bytes and its JSON pointer, empty for the whole
/// document.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct ErrorNode {
    pub(super) start: usize,
    pub(super) end: usize,
    pub(super) pointer: String,
}

/// The byte offset after `column` bytes of `line`, counted from 1 as `serde_json` does.
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

/// The value or key that ends at `read`, or else the first character of the node that starts there.
/// Without a tree: that character, with the pointer of the whole document.
pub(super) fn error_node(tree: Option<&SyntaxTree<'_>>, text: &str, read: usize) -> ErrorNode {
    let before = text.get(..read).unwrap_or(text);
    let after = text.get(read..).unwrap_or_default();
    let end = before.trim_end().len();
    let start = text.len() - after.trim_start().len();
    let pointer = |at: NodeId| tree.map(|tree| tree.pointer(at)).unwrap_or_default();
    let find = |is: &dyn Fn(usize, usize) -> bool| {
        tree.and_then(|tree| {
            tree.nodes()
                .find(|at| is(tree.range(*at).0, tree.range(*at).1))
        })
    };
    if let Some((at, tree)) = find(&|_, e| e == end).zip(tree) {
        let (start, end) = tree.range(at);
        return ErrorNode {
            start,
            end,
            pointer: pointer(at),
        };
    }
    let width = text.get(start..).and_then(|tail| tail.chars().next());
    ErrorNode {
        start,
        end: start + width.map_or(0, char::len_utf8),
        pointer: find(&|s, _| s == start).map(pointer).unwrap_or_default(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rtc_source::SourceMap;
    use rtc_source::tree::json;

    #[test]
    fn finds_values_keys_and_containers() {
        let text = r#"{"a": [1, {"b": "x"}, 22], "c": {}}"#;
        let file = SourceMap::default().add("x", Vec::new());
        let tree = json::parse(file, 5, text).unwrap();
        let found = |read: &str| {
            let read = text.find(read).unwrap() + read.len();
            let error_node = error_node(Some(&tree), text, read);
            (
                text.get(error_node.start..error_node.end)
                    .unwrap()
                    .to_owned(),
                error_node.pointer,
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
