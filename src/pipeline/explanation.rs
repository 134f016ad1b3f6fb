//! The long texts of codes and of rules of the plan.

use rtc_diag::{Code, codes};
use rtc_plan::Rule;

/// Columns of the text.
const WIDTH: usize = 80;

/// The long text of a code such as `VA002`, or of a rule of the plan; `None` if there is none.
#[must_use]
pub fn explanation(name: &str) -> Option<String> {
    codes::find(name).map(explain_code).or_else(|| {
        let rule = Rule::find(name)?;
        Some(format!(
            "## {} (rule)\n\n{}",
            rule.name(),
            fill(rule.text())
        ))
    })
}

/// The long text of a code.
#[must_use]
pub fn explain_code(code: &Code) -> String {
    let Code {
        id,
        severity,
        summary,
        aliases,
    } = code;
    let severity = severity.name();
    let known = match aliases {
        [] => String::new(),
        names => format!(
            "\n{}",
            fill(&format!(
                "The glTF validator calls it {}.",
                names.join(", ")
            ))
        ),
    };
    format!(
        "## {id} ({severity}): {summary}\n\n{}",
        code.page().replacen("\n\n", &format!("\n{known}\n"), 1)
    )
}

/// The text in lines of at most [`WIDTH`] characters.
fn fill(text: &str) -> String {
    let mut lines = vec![String::new()];
    for word in text.split_whitespace() {
        let line = lines
            .last_mut()
            .expect("there is a first line and none is taken away");
        if line.is_empty() {
            line.push_str(word);
        } else if line.chars().count() + 1 + word.chars().count() <= WIDTH {
            line.push(' ');
            line.push_str(word);
        } else {
            lines.push(word.to_owned());
        }
    }
    lines.join("\n") + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_filled_and_no_longer() {
        let text = "ab ".repeat(100);
        let filled = fill(&text);
        assert!(filled.lines().all(|line| line.len() <= WIDTH));
        assert_eq!(filled.lines().count(), 4);
        assert_eq!(filled.split_whitespace().count(), 100);
    }
}
