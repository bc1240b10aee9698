//! What the words of the answers mean: the one text of it is `words.md`.

/// The page of the docs, one section for each word.
const PAGE: &str = include_str!("words.md");

/// Every word of the answers and of the field with its explanation, sorted without regard to case; a word with several names has one after
/// the other.
///
/// ```
/// let (_, text) = jurist_show::words().find(|(word, _)| *word == "complex pair").unwrap();
/// assert!(text.starts_with("A cause of a limit"));
/// ```
pub fn words() -> impl Iterator<Item = (&'static str, &'static str)> {
    PAGE.split("\n### ").skip(1).flat_map(|section| {
        let (names, text) = section.split_once('\n').unwrap_or((section, ""));
        names.split(',').map(move |name| (name.trim(), text.trim()))
    })
}

#[cfg(test)]
mod tests {
    use super::words;
    use jurist_engine::stability::Cause::{
        ComplexPair, ComplexRoot, DegreeLost, Domain, Pole, RootAtMinusOne, RootAtOne, RootAtZero,
    };

    #[test]
    fn words_are_sorted_and_every_cause_is_one() {
        let sections = super::PAGE.split("\n### ").skip(1).map(|s| s.split(['\n', ',']).next().unwrap().to_lowercase());
        assert!(sections.clone().is_sorted(), "{:?}", sections.collect::<Vec<_>>());
        let known: Vec<&str> = words().map(|(word, _)| word).collect();
        for cause in [RootAtOne, RootAtMinusOne, ComplexPair, ComplexRoot, RootAtZero, DegreeLost, Pole, Domain] {
            assert!(known.contains(&cause.to_string().as_str()), "{cause}");
        }
    }
    #[test]
    fn every_word_is_known_once_and_every_reference_is_a_word() {
        let known: Vec<String> = words().map(|(word, _)| word.to_lowercase()).collect();
        for word in &known {
            assert_eq!(known.iter().filter(|w| *w == word).count(), 1, "{word}");
        }
        for (word, text) in words() {
            assert!(text.len() > 40 && text.lines().count() <= 4, "{word}: {text}");
            let text = text.replace('\n', " ");
            for reference in text.split("ee `").skip(1).filter_map(|rest| rest.split('`').next()) {
                assert!(known.iter().any(|known| known == reference), "{word} refers to {reference}");
            }
        }
    }

    #[test]
    fn the_terms_of_the_field_are_words() {
        let known: Vec<String> = words().map(|(word, _)| word.to_lowercase()).collect();
        for term in [
            "phase margin",
            "gain margin",
            "delay margin",
            "modulus margin",
            "disk margin",
            "zoh",
            "foh",
            "tustin",
            "jury",
            "routh",
            "damping",
            "settling time",
            "sensitivity",
            "complementary sensitivity",
            "nyquist",
            "bode",
            "dead time",
            "falling",
            "rising",
        ] {
            assert!(known.iter().any(|word| word == term), "{term}");
        }
    }
}
