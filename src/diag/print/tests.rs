//! The printers on made-up findings, as whole texts.

use super::*;
use crate::diag::codes;
use crate::source::Span;

fn print(format: Format, options: Options, text: &[u8], make: impl Fn(Span) -> Vec<Diagnostic>) -> String {
    let mut map = SourceMap::default();
    let file = map.add("scene.yaml", text.to_vec());
    let mut sink = Sink::default();
    make(Span::new(file, 0, 0)).into_iter().for_each(|diagnostic| sink.push(diagnostic));
    let mut printer = Printer::new(format, options);
    let text = printer.file("scene.yaml", sink, &map);
    text + &printer.finish()
}

fn plain() -> Options {
    Options { color: false, width: 80, least: Severity::Warning, max: 100 }
}

const SCENE: &str = "Camera:\n\teye: [0, 日本, .inf]\nShaddows: true\n";

fn find(at: Span, text: &str, word: &str) -> Span {
    let start = u32::try_from(text.find(word).unwrap()).unwrap();
    Span { start, end: start + u32::try_from(word.len()).unwrap(), ..at }
}

fn two(at: Span) -> Vec<Diagnostic> {
    let span = |word| find(at, SCENE, word);
    vec![
        Diagnostic::new(&codes::UNKNOWN_KEY, "unknown key `Shaddows`")
            .at(span("Shaddows"), "no such key at the top level")
            .also(span("Camera"), "`Shadows` goes beside this")
            .replace("a key with a similar name exists", span("Shaddows"), "Shadows"),
        Diagnostic::new(&codes::NOT_FINITE, "`.inf` is not finite")
            .at(span(".inf"), "not a number to compute with")
            .hint("give a finite number"),
    ]
}

#[test]
fn human() {
    insta::assert_snapshot!(print(Format::Human, plain(), SCENE.as_bytes(), two), @"");
}
