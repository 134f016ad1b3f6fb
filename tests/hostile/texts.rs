//! Hostile texts end in a located error, and odd but sound ones are accepted, each within 64 MiB,
//! the text included.
//!
//! One test, because the allocator that watches the memory is one for the whole binary. Work is
//! bounded by the bytes it allocates in all and by the nodes it looks at (SY011), not by a clock.

#![expect(unsafe_code, reason = "an allocator is unsafe code")]

use rtc::internals::diag::{DiagnosticSink, Severity};
use rtc::internals::pipeline;
use rtc::internals::source::SourceMap;
use std::alloc::{GlobalAlloc, Layout, System};
use std::fmt::Write as _;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

struct Watching;

static LIVE: AtomicUsize = AtomicUsize::new(0);
static PEAK: AtomicUsize = AtomicUsize::new(0);

// SAFETY: everything is passed on to the system's allocator as it came.
unsafe impl GlobalAlloc for Watching {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        PEAK.fetch_max(
            LIVE.fetch_add(layout.size(), Relaxed) + layout.size(),
            Relaxed,
        );
        // SAFETY: the caller's promise is passed on.
        unsafe { System.alloc(layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        LIVE.fetch_sub(layout.size(), Relaxed);
        PEAK.fetch_max(LIVE.fetch_add(size, Relaxed) + size, Relaxed);
        // SAFETY: the caller's promise is passed on.
        unsafe { System.realloc(pointer, layout, size) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        LIVE.fetch_sub(layout.size(), Relaxed);
        // SAFETY: the caller's promise is passed on.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Watching = Watching;

const LIMIT: usize = 64 << 20;

/// Checks a text: the codes of its errors, and the most memory that was in use.
fn check(text: impl FnOnce() -> Vec<u8>) -> (Vec<&'static str>, usize) {
    let before = LIVE.load(Relaxed);
    let bytes = text();
    PEAK.store(LIVE.load(Relaxed), Relaxed);
    let mut map = SourceMap::default();
    let file = map.add("hostile", bytes);
    let mut sink = DiagnosticSink::default();
    let options = pipeline::Options::default();
    let lowered = pipeline::load(file, &mut map, &options, &mut sink);
    let proof = lowered.and_then(|lowered| pipeline::validate(&lowered, &options, &mut sink));
    assert_eq!(proof.is_some(), !sink.has_errors());
    let errors = sink.kept().iter().filter(|d| d.severity == Severity::Error);
    let codes = errors.map(|d| {
        d.primary
            .as_ref()
            .map(|_| d.code.id)
            .expect("every error has a place")
    });
    let mut codes: Vec<_> = codes.collect();
    codes.sort_unstable();
    codes.dedup();
    (codes, PEAK.load(Relaxed) - before)
}

const EYE: &str = "Eye: [200, 200, 1000]\n";
const SPHERE: &str = "{type: sphere, position: [0, 0, 0], radius: 1, material: {color: [1, 1, 1], ka: 1, kd: 1, ks: 0, \
                      n: 1}}\n";

/// Lists of ten aliases to lists of ten aliases.
fn alias_bomb() -> String {
    let mut text = format!("{EYE}a: &a [x, x, x, x, x, x, x, x, x, x]\n");
    for (name, before) in ('b'..='t').zip('a'..) {
        writeln!(
            text,
            "{name}: &{name} [{}]",
            vec![format!("*{before}"); 10].join(", ")
        )
        .unwrap();
    }
    text + "Objects: *t\nLights: *t\n"
}

/// Maps that merge ten times a map that merges ten times a map.
fn merge_bomb() -> String {
    let mut text = format!("{EYE}a: &a {{x: 1}}\n");
    for (name, before) in ('b'..='t').zip('a'..) {
        writeln!(
            text,
            "{name}: &{name} {{<<: [{}]}}",
            vec![format!("*{before}"); 10].join(", ")
        )
        .unwrap();
    }
    text + "Objects:\n- <<: *t\n"
}

/// A long map shared by many objects.
fn shared_map() -> String {
    let mut text = format!("{EYE}Objects:\n- &s\n  type: sphere\n");
    (0..5_000).for_each(|key| writeln!(text, "  k{key}: 1").unwrap());
    text + &"- *s\n".repeat(5_000)
}

fn nested_maps(depth: usize) -> String {
    (0..depth)
        .map(|depth| format!("{:depth$}k:\n", ""))
        .collect()
}

fn unknown_keys(different: bool) -> String {
    let mut text = EYE.to_owned();
    (0..100_000)
        .for_each(|key| writeln!(text, "k{}: {key}", if different { key } else { 0 }).unwrap());
    text
}

fn utf16(text: &str) -> Vec<u8> {
    text.encode_utf16().flat_map(u16::to_le_bytes).collect()
}

/// What a text is, the text, and the codes of its errors; none if it is accepted.
type Case = (
    &'static str,
    Box<dyn FnOnce() -> Vec<u8>>,
    &'static [&'static str],
);

#[expect(clippy::too_many_lines, reason = "a table, one row a text")]
fn cases() -> Vec<Case> {
    fn case(text: impl FnOnce() -> String + 'static) -> Box<dyn FnOnce() -> Vec<u8>> {
        Box::new(|| text().into_bytes())
    }
    vec![
        ("alias bomb", case(alias_bomb), &["SC003"]),
        ("merge bomb", case(merge_bomb), &["SC002"]),
        (
            "a long map shared by many",
            case(shared_map),
            &["SC002", "SY011"],
        ),
        ("100 000 [", case(|| "[".repeat(100_000)), &["SY009"]),
        ("100 000 {", case(|| "{".repeat(100_000)), &["SY009"]),
        (
            "100 000 [ as a value",
            case(|| format!("{EYE}Lights: {}", "[".repeat(100_000))),
            &["SY009"],
        ),
        ("100 000 -", case(|| "- ".repeat(100_000)), &["SY009"]),
        ("100 000 ?", case(|| "? ".repeat(100_000)), &["SY009"]),
        ("maps 2 000 deep", case(|| nested_maps(2_000)), &["SY009"]),
        (
            "a plain word of 50 MB",
            case(|| "a".repeat(50_000_000)),
            &["SY010"],
        ),
        (
            "a quoted word of 50 MB",
            case(|| ["Eye: \"", &"a ".repeat(25_000_000)].concat()),
            &["SY010"],
        ),
        (
            "a block of 2 MB",
            case(|| format!("Eye: |\n{}", "  a, b, c\n".repeat(200_000))),
            &["SY010"],
        ),
        (
            "100 000 times the same key",
            case(|| unknown_keys(false)),
            &["SY007"],
        ),
        (
            "100 000 times the same key and value",
            case(|| format!("{EYE}{}", "k: 1\n".repeat(100_000))),
            &[],
        ),
        ("UTF-16", Box::new(|| utf16(EYE)), &["SY001"]),
        (
            "a megabyte of NUL",
            Box::new(|| vec![0; 1 << 20]),
            &["SY004"],
        ),
        (
            "a megabyte of line ends",
            case(|| "\n".repeat(1 << 20)),
            &["SY006"],
        ),
        (
            "self-alias",
            case(|| format!("{EYE}Objects: &a [*a]\n")),
            &["SY008"],
        ),
        (
            "Objects: null",
            case(|| format!("{EYE}Objects: null\n")),
            &["SC003"],
        ),
        (
            "100 000 wrong objects",
            case(|| format!("{EYE}Objects:\n{}", "- 1\n".repeat(100_000))),
            &["SC003"],
        ),
        ("100 000 unknown keys", case(|| unknown_keys(true)), &[]),
        (
            "one anchor used 100 000 times",
            case(|| format!("{EYE}Objects:\n- &s {SPHERE}{}", "- *s\n".repeat(100_000))),
            &[],
        ),
        ("byte order mark", case(|| format!("\u{feff}{EYE}")), &[]),
        (
            "a tab after a colon",
            case(|| "Eye:\t[1, 2, 3]\n".to_owned()),
            &[],
        ),
        (
            "a list closed at column 0",
            case(|| "Eye: [\n1,\n2,\n3\n]\nLights: [\n]\n".to_owned()),
            &[],
        ),
        (
            "keys n and y",
            case(|| format!("{EYE}RenderMode: gooch\nGoochParameters: {{y: 1}}\nn: 1\n")),
            &[],
        ),
        (
            "merge keys",
            case(|| format!("{EYE}Objects:\n- &s {SPHERE}- <<: *s\n  radius: 2\n")),
            &[],
        ),
        (
            "no line end at the end",
            case(|| "Eye: [1, 2, 3]".to_owned()),
            &[],
        ),
        (
            "line ends of Windows",
            case(|| "Eye: [1, 2, 3]\r\nShadows: true\r\n".to_owned()),
            &[],
        ),
    ]
}

#[test]
fn hostile_texts_are_refused_and_odd_ones_read_within_bounds() {
    let mut faults = String::new();
    for (name, text, expected) in cases() {
        let (codes, peak) = check(text);
        if codes != expected || peak > LIMIT {
            writeln!(
                faults,
                "{name}: {codes:?} instead of {expected:?}, {} MiB",
                peak >> 20
            )
            .unwrap();
        }
    }
    assert!(faults.is_empty(), "{faults}");
}
