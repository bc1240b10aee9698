//! What every diagnostic code means: the one text of it is `codes.md`.

/// The page of the docs, one section for each code.
const PAGE: &str = include_str!("codes.md");

/// Every code with its explanation as `jurist explain` prints it, sorted by code.
///
/// ```
/// let (_, text) = jurist_engine::error::codes().find(|(code, _)| *code == "E-cycle").unwrap();
/// assert!(text.starts_with("Constants are defined by each other"));
/// ```
pub fn codes() -> impl Iterator<Item = (&'static str, String)> {
    let section = |section: &'static str| {
        let (code, text) = section.split_once('\n').unwrap_or((section, ""));
        (code.trim(), indented(text))
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
    use super::codes;
    use std::collections::BTreeSet;
    use std::path::Path;

    /// Adds the codes that stand as string literals in the sources of a folder.
    fn collect(folder: &Path, found: &mut BTreeSet<String>) {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                collect(&path, found);
            } else if path.extension().is_some_and(|e| e == "rs") {
                let text = std::fs::read_to_string(&path).unwrap();
                // Literals of the tests below a module are no use of a code.
                let text = text.split("\n#[cfg(test)]\nmod tests {").next().unwrap_or_default();
                found.extend(text.split('"').filter(|piece| is_code(piece)).map(str::to_owned));
            }
        }
    }

    fn is_code(piece: &str) -> bool {
        let name = piece.strip_prefix("E-").or_else(|| piece.strip_prefix("W-")).unwrap_or_default();
        !name.is_empty() && name.bytes().all(|b| b == b'-' || b.is_ascii_lowercase() || b.is_ascii_digit())
    }

    #[test]
    fn every_code_in_the_sources_is_explained_and_every_explained_code_is_used() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        let mut used = BTreeSet::new();
        collect(&root.join("src"), &mut used);
        for folder in ["crates", "studies"] {
            for member in std::fs::read_dir(root.join(folder)).unwrap() {
                collect(&member.unwrap().path().join("src"), &mut used);
            }
        }
        let explained: BTreeSet<String> = codes().map(|(code, _)| code.to_owned()).collect();
        assert_eq!(used.difference(&explained).collect::<Vec<_>>(), Vec::<&String>::new(), "used but not explained");
        assert_eq!(explained.difference(&used).collect::<Vec<_>>(), Vec::<&String>::new(), "explained but not used");
        assert_eq!(codes().count(), explained.len(), "explained once");
    }

    #[test]
    fn explanations_are_short_sorted_and_without_marks_of_the_page() {
        assert!(codes().map(|(code, _)| code).is_sorted());
        for (code, text) in codes() {
            assert!(text.lines().count() <= 10 && text.len() > 30, "{code}: {text}");
            assert!(!text.contains("```"), "{code}: {text}");
        }
    }
}
