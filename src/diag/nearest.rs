//! Suggestions for misspelt names: the known name with the smallest edit distance.

/// Longer names are not compared: no key is that long.
const LONGEST: usize = 32;

/// The known name that was probably meant: the one with the smallest optimal string alignment
/// distance, if that is at most a third of the length.
#[must_use]
pub fn nearest<'k>(word: &str, known: impl Iterator<Item = &'k str>) -> Option<&'k str> {
    if word.is_empty() || word.len() > LONGEST {
        return None;
    }
    let lower = word.to_lowercase();
    let distance = |candidate: &str| strsim::osa_distance(&lower, &candidate.to_lowercase());
    let (cost, best) = known
        .map(|candidate| (distance(candidate), candidate))
        .min_by_key(|(cost, _)| *cost)?;
    let tolerated = (word.chars().count().max(best.chars().count()) / 3).max(1);
    (cost <= tolerated && cost < best.chars().count()).then_some(best)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn typing_mistakes_are_recognised_and_other_words_are_not() {
        let known = || ["position", "radius", "material", "n", "ka"].into_iter();
        assert_eq!(nearest("postion", known()), Some("position"));
        assert_eq!(nearest("raduis", known()), Some("radius"));
        assert_eq!(nearest("Material", known()), Some("material"));
        assert_eq!(nearest("colour", known()), None);
        assert_eq!(nearest("x", known()), None);
    }
}
