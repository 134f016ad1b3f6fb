//! Words as people misspell them: the nearest known word, and words cut short for messages.

/// Longer words are not compared: nobody misspells a key of this length.
const LONGEST: usize = 32;

/// The known word that was probably meant, if any is near enough.
pub(super) fn nearest<'k>(word: &str, known: impl Iterator<Item = &'k str>) -> Option<&'k str> {
    if word.is_empty() || word.len() > LONGEST {
        return None;
    }
    let lower = word.to_lowercase();
    // How many letters were changed, left out, put in or swapped with their neighbour.
    let far = |candidate: &str| strsim::osa_distance(&lower, &candidate.to_lowercase());
    let (cost, best) = known
        .map(|candidate| (far(candidate), candidate))
        .min_by_key(|(cost, _)| *cost)?;
    let tolerated = (word.chars().count().max(best.chars().count()) / 3).max(1);
    (cost <= tolerated && cost < best.chars().count()).then_some(best)
}

/// Words in backticks, with commas and `and`.
pub(super) fn list<'w>(words: impl IntoIterator<Item = &'w str>) -> String {
    let quoted: Vec<_> = words.into_iter().map(|word| format!("`{word}`")).collect();
    match quoted.as_slice() {
        [] => String::new(),
        [one] => one.clone(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

/// Whether two texts have the same letters and digits, in any case of letters: what stands between
/// them differs, and what they say does not.
pub(super) fn is_same_but_for_signs(written: &str, meant: &str) -> bool {
    let core = |text: &str| -> Vec<char> {
        let letters = text.chars().filter(|c| c.is_alphanumeric());
        letters.flat_map(char::to_lowercase).collect()
    };
    core(written) == core(meant)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slips_of_the_finger_are_seen_and_other_words_are_not() {
        let known = || ["position", "radius", "material", "n", "ka"].into_iter();
        assert_eq!(nearest("postion", known()), Some("position"));
        assert_eq!(nearest("raduis", known()), Some("radius"));
        assert_eq!(nearest("Material", known()), Some("material"));
        assert_eq!(nearest("colour", known()), None);
        assert_eq!(nearest("x", known()), None);
    }
}
