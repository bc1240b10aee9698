//! What the words of the answers mean: the one text of it is `words.md`.

/// The page of the docs, one section for each word.
const PAGE: &str = include_str!("words.md");

/// Every word that answers use with its explanation, sorted.
///
/// ```
/// let (_, text) = jurist_engine::show::words().find(|(word, _)| *word == "complex pair").unwrap();
/// assert!(text.starts_with("A cause of a limit"));
/// ```
pub fn words() -> impl Iterator<Item = (&'static str, &'static str)> {
    PAGE.split("\n### ").skip(1).map(|section| {
        let (word, text) = section.split_once('\n').unwrap_or((section, ""));
        (word.trim(), text.trim())
    })
}

#[cfg(test)]
mod tests {
    use super::words;
    use crate::stability::Cause::{ComplexPair, DegreeLost, Domain, Pole, RootAtMinusOne, RootAtOne, RootAtZero};

    #[test]
    fn words_are_sorted_and_every_cause_is_one() {
        let known: Vec<&str> = words().map(|(word, _)| word).collect();
        assert!(known.is_sorted(), "{known:?}");
        for cause in [RootAtOne, RootAtMinusOne, ComplexPair, RootAtZero, DegreeLost, Pole, Domain] {
            assert!(known.contains(&cause.to_string().as_str()), "{cause}");
        }
    }
}
