//! The instruction that follows a finding: what to change in the file, one sentence for each kind
//! of mistake.

use rtc_diag::Code;
use std::collections::BTreeMap;
use std::sync::LazyLock;

/// Lines of `kinds | sentence`, the kinds being names of Khronos' validator and codes.
const ADVICE: &str = include_str!("advice.txt");

/// The sentence of each kind, read once: a file may have very many mistakes.
static SENTENCES: LazyLock<BTreeMap<&str, &str>> = LazyLock::new(|| rows().collect());

/// What to do about a finding of `code` that the validator of Khronos calls `alias`.
pub(super) fn advice(code: &Code, alias: &str) -> Option<&'static str> {
    let of_kind = |kind| SENTENCES.get(kind).copied();
    of_kind(alias).or_else(|| of_kind(code.id))
}

/// Each kind with its sentence.
fn rows() -> impl Iterator<Item = (&'static str, &'static str)> {
    let lines = ADVICE.lines().filter(|line| !line.starts_with('#'));
    let rows = lines.filter_map(|line| line.split_once(" | "));
    rows.flat_map(|(kinds, text)| kinds.split(' ').map(move |kind| (kind, text)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use rtc_diag::codes;

    /// Rows of findings that do not come from a file, or whose advice is made where they are.
    fn is_elsewhere(code: &Code, alias: &str) -> bool {
        code.id >= "GL048" || matches!(alias, "IO_ERROR" | "NON_RELATIVE_URI")
    }

    #[test]
    fn each_kind_of_mistake_has_advice() {
        for code in codes::GL {
            for alias in code.aliases {
                let found = advice(code, alias).is_some();
                assert!(found || is_elsewhere(code, alias), "{code} {alias}");
            }
        }
    }

    #[test]
    fn each_row_is_of_a_known_kind_and_each_kind_has_one_row() {
        let mut seen = std::collections::BTreeSet::new();
        for (kind, _) in rows() {
            let is_known = |code: &&Code| code.id == kind || code.aliases.contains(&kind);
            assert!(
                codes::GL.iter().any(is_known) && seen.insert(kind),
                "{kind}"
            );
        }
    }
}
