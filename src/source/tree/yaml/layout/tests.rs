//! Tests of the formatter: input and result.

use super::*;
use crate::SourceMap;
use proptest::prelude::*;

fn formatted(text: &str) -> Result<String, FormatTextFault> {
    let mut map = SourceMap::default();
    let file = map.add("t", text.as_bytes().to_vec());
    layout(file, text.as_bytes(), &mut |_| ())
}

/// Checks the result, and that formatting the result changes nothing.
#[track_caller]
fn becomes(text: &str, expected: &str) {
    assert_eq!(formatted(text).as_deref(), Ok(expected));
    assert_eq!(
        formatted(expected).as_deref(),
        Ok(expected),
        "laid out twice"
    );
}

#[test]
fn blanks_are_those_of_the_house() {
    becomes(
        "\u{feff}\r\n\r\n Eye :   [200,200 ,1000 ]  \r\n\r\n\r\n\r\n a:\t{ x : 1,y:  2 }\r\n\r\n",
        "Eye: [200, 200, 1000]\n\na: {x: 1, y: 2}\n",
    );
    becomes(
        "a: [ ]\nb: { }\nc:   # none\nd: [1,]",
        "a: []\nb: {}\nc:   # none\nd: [1,]\n",
    );
    becomes(
        " # x\n%YAML  1.2 \n---  # y\na: 1\n...",
        "# x\n%YAML  1.2\n---  # y\na: 1\n...\n",
    );
}

#[test]
fn lists_stand_below_their_key_and_maps_two_spaces_in() {
    becomes(
        "Lights:\n    -   position: [1,2,3]\n        color: [1,1,1]\n    -\n        -   1\n        - 2\nObjects:\n -  a:\n          b: 1\n    c: 2\n",
        "Lights:\n- position: [1, 2, 3]\n  color: [1, 1, 1]\n-\n  - 1\n  - 2\nObjects:\n- a:\n    b: 1\n  c: 2\n",
    );
    becomes("-   -   a\n    -   b\n-   - c\n", "- - a\n  - b\n- - c\n");
    becomes(
        "a:\n     word\nb:\n     [1,\n2\n]\n",
        "a:\n  word\nb:\n  [1,\n    2\n  ]\n",
    );
    becomes("?   k\n:   - v\n", "? k\n: - v\n");
}

#[test]
fn comments_stay_with_what_they_stood_with() {
    becomes(
        "# first\n\na:\n      # of b\n      b: 1\n      # after b\n   # of a, too\n# of c\nc: [ # in c\n# also\n1]\n# last\n",
        "# first\n\na:\n  # of b\n  b: 1\n  # after b\n# of a, too\n# of c\nc: [ # in c\n  # also\n  1]\n# last\n",
    );
    // Aligned comments stay aligned.
    becomes(
        "l:\n    - a: [1,2]   # one\n      bb: [1,2]  # two\n",
        "l:\n- a: [1, 2]  # one\n  bb: [1, 2] # two\n",
    );
    becomes("a: 'x # y' # z\nb: x#y #z\n", "a: 'x # y' # z\nb: x#y #z\n");
}

#[test]
fn brackets_over_many_lines_are_indented_by_level() {
    becomes(
        "Objects: [\n{type: sphere,\nmaterial: {a: 1,\n         b: 2}},\n      {}\n   ]\n",
        "Objects: [\n  {type: sphere,\n    material: {a: 1,\n      b: 2}},\n  {}\n]\n",
    );
    becomes(
        "- {a: 1,\n   b: [\n 2\n   ]\n  }\n- k: {x: 1,\n     y: 2}\n",
        "- {a: 1,\n    b: [\n      2\n    ]\n  }\n- k: {x: 1,\n    y: 2}\n",
    );
    becomes(
        "{\n\t\"Eye\" : [1,2,3],\n\t\"a\":{\"b\":1}\n}",
        "{\n  \"Eye\": [1, 2, 3],\n  \"a\": {\"b\": 1}\n}\n",
    );
}

#[test]
fn anchors_aliases_tags_and_merges_are_kept() {
    becomes(
        "a:   &m\n    ka:  0.10\nb: { <<:  *m , kd: +1e3 }\nc:   !t   &n   x\n*n : 1\nd: [ *m ,*n ]\n",
        "a: &m\n  ka: 0.10\nb: {<<: *m, kd: +1e3}\nc: !t &n x\n*n : 1\nd: [*m, *n]\n",
    );
}

#[test]
fn texts_of_many_lines_say_the_same() {
    becomes(
        "a:\n      b: one\n         two\n\n         three\n      c: \"x\n         y \\\n           z\"\n",
        "a:\n  b: one\n    two\n\n    three\n  c: \"x\n    y \\\n    z\"\n",
    );
    becomes(
        "a:\n      b: |  # why\n          one # no comment\n            two  \n\n          three\n\n\n      c: >-\n         x\n# end\n",
        "a:\n  b: |  # why\n    one # no comment\n      two  \n\n    three\n\n  c: >-\n    x\n# end\n",
    );
    becomes("a: |+\n   x\n\n\nb: 1\n", "a: |+\n  x\n\n\nb: 1\n");
    becomes("a:\n    b: |1\n       x\n", "a:\n  b: |1\n     x\n");
    becomes("a: |+\n  \n\nb: 1\n", "a: |+\n\n\nb: 1\n");
}

#[test]
fn what_is_no_yaml_is_left_alone() {
    assert_eq!(formatted("a: [1, 2\n"), Err(FormatTextFault::Mistakes));
    assert_eq!(
        formatted("a: 1\n---\nb: 2\n"),
        Err(FormatTextFault::Mistakes)
    );
}

/// Fragments of generated texts.
const PARTS: [&str; 24] = [
    "a: ", "b:", "- ", "-   ", "\n", "\n\n\n", "\n  ", "\n    ", "\n   ", "\n ", "[", "]", "{",
    "}", ", ", " # c", "'q \n r'", "x", "y z", "|\n", "&a ", "*a ", "? ", ": ",
];

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40_000))]

    /// Formatting a result changes nothing.
    #[test]
    fn once_is_enough(parts in prop::collection::vec(prop::sample::select(&PARTS[..]), 1..16)) {
        let text = parts.concat();
        match formatted(&text) {
            Ok(once) => prop_assert_eq!(formatted(&once), Ok(once), "{:?}", text),
            // The last line of a block scalar may lack its newline, which a file has.
            Err(fault) => prop_assert!(
                fault == FormatTextFault::Mistakes || text.contains('|'),
                "{:?}",
                text
            ),
        }
    }
}
