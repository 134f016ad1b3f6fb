//! Words as people misspell them: the nearest known word.

/// Longer words are not compared: nobody misspells a key of this length.
const LONGEST: usize = 32;

/// The known word that was probably meant, if any is near enough.
#[must_use]
pub fn nearest<'k>(word: &str, known: impl Iterator<Item = &'k str>) -> Option<&'k str> {
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
