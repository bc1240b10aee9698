//! Files that tests write from lists of the code.

/// The text between a line that has `begin` and one that has `end`, with what is before and after.
pub fn between<'t>(text: &'t str, begin: &str, end: &str) -> [&'t str; 3] {
    let from =
        text.find(begin).and_then(|k| Some(k + text[k..].find('\n')? + 1)).expect("a line that begins the table");
    let to = from + text[from..].find(end).expect("a line that ends the table");
    [&text[..from], &text[from..to], &text[to..]]
}

/// Compares what is written in a file with what is made of a list, or writes the whole file if the environment says `UPDATE_SCHEMAS=1`.
pub fn publish(path: &str, written: &str, made: &str, whole: &str) {
    if std::env::var_os("UPDATE_SCHEMAS").is_some() {
        std::fs::write(path, whole).expect("the file can be written");
        return;
    }
    assert_eq!(written, made, "UPDATE_SCHEMAS=1 cargo test schemas writes {path}");
}
