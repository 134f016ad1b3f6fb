//! The typed arguments of a command, for messages that repeat them.

use std::ffi::OsString;

/// The arguments without the program and without these options and their values, which are the next
/// argument or the rest of their own.
pub(super) fn without(typed: &[OsString], options: &[&str]) -> Vec<String> {
    let mut arguments = typed
        .iter()
        .skip(1)
        .map(|argument| argument.to_string_lossy());
    let mut kept = Vec::new();
    while let Some(argument) = arguments.next() {
        if options.contains(&argument.as_ref()) {
            arguments.next();
        } else if !options.iter().any(|option| holds(&argument, option)) {
            kept.push(argument.into_owned());
        }
    }
    kept
}

/// Whether an argument is an option with its value.
fn holds(argument: &str, option: &str) -> bool {
    let rest = argument.strip_prefix(option);
    rest.is_some_and(|rest| !option.starts_with("--") || rest.starts_with('='))
}

/// An argument quoted for a POSIX shell.
pub(super) fn quoted(argument: &str) -> String {
    let is_plain = |letter: char| letter.is_ascii_alphanumeric() || "_-./:=,+@%".contains(letter);
    match !argument.is_empty() && argument.chars().all(is_plain) {
        true => argument.to_owned(),
        false => format!("'{}'", argument.replace('\'', "'\\''")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_go_with_their_values_and_the_rest_stays() {
        let typed = "rtc render a.yaml --size 4 -o b --part=1/2 --output c --party x -ob --size=3";
        let typed: Vec<_> = typed.split(' ').map(OsString::from).collect();
        assert_eq!(
            without(&typed, &["--part", "--output", "-o", "--size"]).join(" "),
            "render a.yaml --party x"
        );
    }

    #[test]
    fn what_a_shell_would_take_apart_is_quoted() {
        assert_eq!(
            ["a-b/c.yaml", "", "two words", "it's", "$HOME"]
                .map(quoted)
                .join("|"),
            "a-b/c.yaml|''|'two words'|'it'\\''s'|'$HOME'"
        );
    }
}
