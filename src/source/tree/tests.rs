//! Tests of YAML and JSON trees.

use super::*;
use crate::SourceMap;

fn with<R>(text: &str, look: impl FnOnce(&SyntaxTree<'_>) -> R) -> R {
    let mut map = SourceMap::default();
    let file = map.add("t", text.as_bytes().to_vec());
    let tree = yaml::parse(file, map.bytes(file), &mut |mistake| panic!("{mistake:?}")).unwrap();
    look(&tree)
}

#[test]
fn a_node_is_sixteen_bytes() {
    assert_eq!(size_of::<TreeNode>(), 16);
}

#[test]
fn aliases_are_links_and_spans_are_bytes_of_the_file() {
    with("\u{feff}a: &x [1, 'q', \"\\u0041\"]\nb: *x\n", |tree| {
        let pairs: Vec<_> = tree.pairs(tree.root()).collect();
        assert_eq!(pairs.len(), 2);
        let literals: Vec<_> = tree.items(pairs[1].1).map(|id| tree.shape(id)).collect();
        assert_eq!(
            literals,
            [
                NodeContent::Word("1"),
                NodeContent::Text("q"),
                NodeContent::Text("A")
            ]
        );
        assert_eq!(tree.target(pairs[1].1), pairs[0].1);
        let (list, alias) = (tree.span(pairs[0].1), tree.span(pairs[1].1));
        assert_eq!(
            (list.start, list.end, alias.start, alias.end),
            (9, 27, 31, 33)
        );
    });
}

#[test]
fn a_block_is_text_whatever_it_begins_with() {
    for (text, literal) in [
        ("a: |\n  \"b \u{1cc}", "\"b \u{1cc}"),
        ("a: |\n  'b \u{e9}", "'b \u{e9}"),
        ("a: >\n  \"b\"", "\"b\""),
        ("a: |-\n  '\n", "'"),
        ("a: |\n  5", "5"),
    ] {
        with(text, |tree| {
            let (_, value) = tree.pairs(tree.root()).next().unwrap();
            let NodeContent::Text(found) = tree.shape(value) else {
                panic!("{text:?} is no text")
            };
            // The parser decides whether an unterminated last line gets a newline.
            assert_eq!(found.trim_end_matches('\n'), literal, "{text:?}");
        });
    }
}

#[test]
fn nothing_written_is_the_empty_word_after_its_key() {
    with("Objects:\nLights: []\n", |tree| {
        let (_, nothing) = tree.pairs(tree.root()).next().unwrap();
        assert_eq!(tree.shape(nothing), NodeContent::Word(""));
        assert_eq!((tree.span(nothing).start, tree.span(nothing).end), (7, 7));
    });
}

fn file() -> FileId {
    SourceMap::default().add("x", Vec::new())
}

#[test]
fn nodes_know_their_way_and_their_bytes() {
    let text = r#" {"a": [1, {"b/c": "x\u00e9\ud83d\ude00"}, true], "d": {}, "e": -2.5e1} "#;
    let tree = json::parse(file(), 10, text).unwrap();
    let at = |keys: &[&str]| tree.at(tree.root(), keys).unwrap();
    let inner = tree.items(at(&["a"])).nth(1).unwrap();
    let text = tree.get(inner, "b/c").unwrap();
    assert_eq!(
        (tree.pointer(text).as_str(), tree.text(text).unwrap()),
        ("/a/1/b~1c", "xé😀")
    );
    assert_eq!(
        (tree.number(at(&["e"])), tree.integer(at(&["e"]))),
        (Some(-25.0), None)
    );
    assert_eq!(
        tree.items(at(&["a"]))
            .filter_map(|id| tree.boolean(id))
            .next(),
        Some(true)
    );
    assert_eq!(
        (
            tree.pairs(at(&["d"])).count(),
            tree.pairs(tree.root()).count()
        ),
        (0, 3)
    );
    assert_eq!(tree.span(tree.root()).start, 11);
    let (key, _) = tree.pairs(tree.root()).nth(1).unwrap();
    assert_eq!(tree.pointer(key), "/d");
}

#[test]
fn what_is_no_json_is_found_where_it_is() {
    for (text, at) in [
        ("", 0),
        ("{", 1),
        ("[1,]", 3),
        ("{\"a\" 1}", 5),
        ("{\"a\":1,}", 7),
        ("01", 1),
        ("1.", 2),
        ("tru", 0),
        ("\"a", 2),
        ("\"\\x\"", 1),
        ("[1 2]", 3),
        ("{} {}", 3),
        ("\"\n\"", 1),
        ("-", 1),
        ("1e", 2),
        ("nan", 0),
    ] {
        assert_eq!(json::parse(file(), 0, text).unwrap_err().at, at, "{text}");
    }
}

#[test]
fn keys_that_stand_twice_are_found_in_small_maps_and_large() {
    let twice = |text: &str| {
        let tree = json::parse(file(), 0, text).unwrap();
        tree.duplicate_keys()
            .iter()
            .map(|(_, later)| tree.span(*later).start as usize)
            .collect::<Vec<_>>()
    };
    assert_eq!(twice(r#"{"a":1,"\u0061":2}"#), [7]);
    let many: String = (0..100).map(|key| format!("\"{key}\":0,")).collect();
    assert_eq!(twice(&format!("{{{many}\"50\":1}}")), [many.len() + 1]);
}

#[test]
fn keys_of_wide_maps_are_found() {
    let text: String = (0..100)
        .map(|key| format!("\"\\u0061{key}\":{key},"))
        .collect();
    let text = format!("{{{text}\"b\":[1,{{\"c\":2}}]}}");
    let tree = json::parse(file(), 0, &text).unwrap();
    let found = (0..100).filter_map(|key| tree.integer(tree.get(tree.root(), &format!("a{key}"))?));
    assert!(found.eq(0..100));
    assert_eq!(tree.get(tree.root(), "a100"), None);
    assert_eq!(tree.list(tree.root(), "b").count(), 2);
}

#[test]
fn long_pointers_are_cut() {
    let text = format!("{{\"{}\":{{\"b\":1}}}}", "ü".repeat(1_000));
    let tree = json::parse(file(), 0, &text).unwrap();
    let inner = tree.pairs(tree.root()).next().unwrap().1;
    let pointer = tree.pointer(tree.get(inner, "b").unwrap());
    assert!(
        pointer.starts_with("/ü") && pointer.ends_with("ü…/b") && pointer.len() < 300,
        "{pointer}"
    );
    let text = r#"{"key":"#.repeat(500) + "1" + &"}".repeat(500);
    let tree = json::parse(file(), 0, &text).unwrap();
    let pointer = tree.pointer(NodeId(1_000));
    assert!(
        pointer.starts_with("…/key/key/") && pointer.len() < 600,
        "{pointer}"
    );
}

#[test]
fn depth_is_bounded() {
    assert!(json::parse(file(), 0, &("[".repeat(500) + &"]".repeat(500))).is_ok());
    assert_eq!(
        json::parse(file(), 0, &"[".repeat(100_000)).unwrap_err().at,
        512
    );
}

#[test]
fn a_text_up_to_its_fault_is_a_tree() {
    let (tree, error) = json::parse_prefix(file(), 0, r#"{"a": [1, {"b": 2, "c" x"#);
    assert_eq!(error.map(|error| error.at), Some(23));
    let list = tree.get(tree.root(), "a").unwrap();
    let inner = tree.items(list).nth(1).unwrap();
    let two = tree.get(inner, "b").unwrap();
    assert_eq!(
        (tree.integer(two), tree.pointer(two).as_str()),
        (Some(2), "/a/1/b")
    );
    assert_eq!(tree.range(inner), (10, 23));
}
