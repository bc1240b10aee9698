//! What every diagnostic code means: the one text of it is `codes.md`.

use super::Code;

/// The page of the docs, one section for each code.
const PAGE: &str = include_str!("codes.md");

/// Every code with its explanation as `jurist explain` prints it, sorted by code.
///
/// ```
/// use jurist_model::error::{Code, codes};
/// let (_, text) = codes().find(|(code, _)| *code == Code::Cycle).unwrap();
/// assert!(text.starts_with("Constants are defined by each other"));
/// ```
pub fn codes() -> impl Iterator<Item = (Code, String)> {
    sections().zip(Code::ALL).map(|((_, text), code)| (*code, indented(text)))
}

/// The sections of the page: what their headings name, and their texts. A test holds them against [`Code::ALL`].
fn sections() -> impl Iterator<Item = (&'static str, &'static str)> {
    let section = |section: &'static str| {
        let (code, text) = section.split_once('\n').unwrap_or((section, ""));
        (code.trim(), text)
    };
    PAGE.split("\n### ").skip(1).map(section)
}

/// The text with its fenced examples indented instead.
fn indented(text: &str) -> String {
    let mut lines = Vec::new();
    let mut is_example = false;
    for line in text.trim().lines() {
        if line.starts_with("```") {
            is_example = !is_example;
        } else {
            lines.push(if is_example { format!("    {line}") } else { line.to_owned() });
        }
    }
    lines.join("\n")
}

#[cfg(test)]
mod tests {
    use super::{Code, codes, sections};
    use std::collections::BTreeSet;
    use std::path::Path;

    /// What stands in the sources outside of tests.
    #[derive(Default)]
    struct Found {
        /// Names that follow `Code::`.
        variants: BTreeSet<String>,
        /// Codes as string literals.
        literals: BTreeSet<String>,
    }

    impl Found {
        /// Adds what stands in the sources of a folder.
        fn collect(&mut self, folder: &Path) {
            for entry in std::fs::read_dir(folder).unwrap() {
                let path = entry.unwrap().path();
                let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
                let is_test = name == "tests" || name == "tests.rs" || name.starts_with("tests_");
                if is_test || path.ends_with("error/code.rs") {
                    continue;
                }
                if path.is_dir() {
                    self.collect(&path);
                } else if name.ends_with(".rs") {
                    self.read(&std::fs::read_to_string(&path).unwrap());
                }
            }
        }

        fn read(&mut self, text: &str) {
            // The tests below a module are no use of a code, and examples in comments are none.
            let text = text.split("\n#[cfg(test)]\nmod tests {").next().unwrap_or_default();
            for line in text.lines().filter(|line| !line.trim_start().starts_with("//")) {
                let name = |rest: &str| rest.chars().take_while(|c| c.is_alphanumeric()).collect::<String>();
                self.variants.extend(line.split("Code::").skip(1).map(name));
                self.literals.extend(line.split('"').filter(|piece| is_code(piece)).map(str::to_owned));
            }
        }
    }

    fn is_code(piece: &str) -> bool {
        let name = piece.strip_prefix("E-").or_else(|| piece.strip_prefix("W-")).unwrap_or_default();
        !name.is_empty() && name.bytes().all(|b| b == b'-' || b.is_ascii_lowercase() || b.is_ascii_digit())
    }

    #[test]
    fn every_code_is_explained_once_and_the_page_explains_no_other() {
        let explained: Vec<&str> = sections().map(|(code, _)| code).collect();
        let known: Vec<&str> = Code::ALL.iter().map(|code| code.as_str()).collect();
        assert_eq!(explained, known);
        assert!(known.iter().all(|code| is_code(code)) && Code::ALL.is_sorted());
    }

    #[test]
    fn every_code_is_used_and_none_as_a_text() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        let mut found = Found::default();
        for folder in ["src", "python/src", "web/engine/src"] {
            found.collect(&root.join(folder));
        }
        for folder in ["crates", "studies"] {
            for member in std::fs::read_dir(root.join(folder)).unwrap() {
                let source = member.unwrap().path().join("src");
                // The package of other packages' tests has none.
                if source.exists() {
                    found.collect(&source);
                }
            }
        }
        assert_eq!(found.literals, BTreeSet::new(), "codes as texts");
        let unused = |code: &&Code| !found.variants.contains(&format!("{code:?}"));
        assert_eq!(Code::ALL.iter().filter(unused).collect::<Vec<_>>(), Vec::<&Code>::new(), "not used");
    }

    #[test]
    fn explanations_are_short_sorted_and_without_marks_of_the_page() {
        assert!(codes().map(|(code, _)| code.as_str()).is_sorted());
        for (code, text) in codes() {
            assert!(text.lines().count() <= 10 && text.len() > 30, "{code}: {text}");
            assert!(!text.contains("```"), "{code}: {text}");
        }
    }
}
