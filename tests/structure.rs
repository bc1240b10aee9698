//! The crate's floors: imports go down only, nothing is in a circle, every file belongs to the crate,
//! and only `number` names the big-number crate it stands on.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// The rooms, floor by floor from below. Rooms of one floor do not import each other.
const FLOORS: &[&[&str]] = &[
    &["error"],
    &["limits"],
    &["number"],
    &["poly"],
    &["matrix"],
    &["stability", "model"],
    &["analysis"],
    &["simulate", "certificate"],
    &["report"],
    &["cli"],
    &["fuzzing"],
];

/// The longest file that is still read at one go.
const LONGEST_FILE: usize = 600;

fn floor(room: &str) -> Option<usize> {
    FLOORS.iter().position(|rooms| rooms.contains(&room))
}

fn source_folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("src")
}

/// All Rust files below a folder.
fn rust_files(folder: &Path) -> Vec<PathBuf> {
    let mut out = Vec::new();
    for entry in fs::read_dir(folder).expect("the folder is readable") {
        let path = entry.expect("the folder is readable").path();
        if path.is_dir() {
            out.extend(rust_files(&path));
        } else if path.extension().is_some_and(|e| e == "rs") {
            out.push(path);
        }
    }
    out.sort();
    out
}

/// The path of modules that a file is: `src/poly/dense.rs` is `[poly, dense]`, `src/lib.rs` is `[]`.
fn module_path(file: &Path) -> Vec<String> {
    let relative = file.strip_prefix(source_folder()).expect("a file of src").with_extension("");
    let mut parts: Vec<String> = relative.iter().map(|p| p.to_string_lossy().into_owned()).collect();
    if parts.last().is_some_and(|p| p == "mod") || parts == ["lib"] || parts == ["main"] {
        parts.pop();
    }
    parts
}

/// A token of Rust as far as imports need it.
#[derive(Clone, Debug, PartialEq)]
enum Token {
    Word(String),
    PathSeparator,
    Symbol(char),
}

/// Code without comments, strings and characters.
fn tokens(code: &str) -> Vec<Token> {
    let chars: Vec<char> = code.chars().collect();
    let mut out = Vec::new();
    let mut i = 0;
    let starts = |i: usize, text: &str| text.chars().enumerate().all(|(k, c)| chars.get(i + k) == Some(&c));
    while i < chars.len() {
        let c = chars[i];
        if starts(i, "//") {
            while i < chars.len() && chars[i] != '\n' {
                i += 1;
            }
        } else if starts(i, "/*") {
            while i < chars.len() && !starts(i, "*/") {
                i += 1;
            }
            i += 2;
        } else if c == 'r' && (starts(i, "r\"") || starts(i, "r#")) && raw_string_end(&chars, i).is_some() {
            i = raw_string_end(&chars, i).expect("just found");
        } else if c == '"' {
            i += 1;
            while i < chars.len() && chars[i] != '"' {
                i += if chars[i] == '\\' { 2 } else { 1 };
            }
            i += 1;
        } else if c == '\'' && chars.get(i + 1) == Some(&'\\') {
            i += 3;
            while i < chars.len() && chars[i] != '\'' {
                i += 1;
            }
            i += 1;
        } else if c == '\'' && chars.get(i + 2) == Some(&'\'') {
            i += 3;
        } else if c.is_alphabetic() || c == '_' {
            let start = i;
            while i < chars.len() && (chars[i].is_alphanumeric() || chars[i] == '_') {
                i += 1;
            }
            out.push(Token::Word(chars[start..i].iter().collect()));
        } else if starts(i, "::") {
            out.push(Token::PathSeparator);
            i += 2;
        } else {
            if !c.is_whitespace() {
                out.push(Token::Symbol(c));
            }
            i += 1;
        }
    }
    out
}

/// Where the raw string that begins at `i` ends.
fn raw_string_end(chars: &[char], i: usize) -> Option<usize> {
    let hashes = chars[i + 1..].iter().take_while(|c| **c == '#').count();
    if chars.get(i + 1 + hashes) != Some(&'"') {
        return None;
    }
    let mut at = i + 2 + hashes;
    loop {
        if *chars.get(at)? == '"' && chars[at + 1..].iter().take(hashes).filter(|c| **c == '#').count() == hashes {
            return Some(at + 1 + hashes);
        }
        at += 1;
    }
}

/// The modules directly below the crate's root that a file names, and the modules it declares.
fn rooms_and_children(file: &Path) -> (BTreeSet<String>, Vec<String>) {
    let tokens = tokens(&fs::read_to_string(file).expect("the file is readable"));
    let word = |i: usize| match tokens.get(i) {
        Some(Token::Word(w)) => Some(w.as_str()),
        _ => None,
    };
    let mut here = module_path(file);
    let mut inline: Vec<usize> = Vec::new();
    let (mut depth, mut rooms, mut children) = (0, BTreeSet::new(), Vec::new());
    let mut i = 0;
    while i < tokens.len() {
        match &tokens[i] {
            Token::Symbol('{') => depth += 1,
            Token::Symbol('}') => {
                depth -= 1;
                if inline.last() == Some(&depth) {
                    inline.pop();
                    here.pop();
                }
            }
            Token::Word(w) if w == "mod" => match (word(i + 1), tokens.get(i + 2)) {
                (Some(name), Some(Token::Symbol(';'))) => children.push(name.to_owned()),
                (Some(name), Some(Token::Symbol('{'))) => {
                    here.push(name.to_owned());
                    inline.push(depth);
                }
                _ => {}
            },
            Token::Word(w) if (w == "crate" || w == "super") && (i == 0 || tokens[i - 1] != Token::PathSeparator) => {
                let mut path = if w == "crate" { Vec::new() } else { here.clone() };
                path.truncate(path.len().saturating_sub(usize::from(w == "super")));
                let mut at = i + 1;
                while tokens.get(at) == Some(&Token::PathSeparator) && word(at + 1) == Some("super") {
                    path.pop();
                    at += 2;
                }
                if tokens.get(at) == Some(&Token::PathSeparator) {
                    for next in following(&tokens, at + 1) {
                        let mut path = path.clone();
                        path.push(next);
                        rooms.insert(path.remove(0));
                    }
                }
            }
            _ => {}
        }
        i += 1;
    }
    (rooms, children)
}

/// The words that can follow a path's `::`: one, or those of a group.
fn following(tokens: &[Token], at: usize) -> Vec<String> {
    match &tokens.get(at) {
        Some(Token::Word(w)) => vec![w.clone()],
        Some(Token::Symbol('{')) => {
            let (mut depth, mut out) = (0, Vec::new());
            for (k, token) in tokens[at..].iter().enumerate() {
                match token {
                    Token::Symbol('{') => depth += 1,
                    Token::Symbol('}') => depth -= 1,
                    Token::Word(w) if depth == 1 && tokens[at + k - 1] != Token::PathSeparator => out.push(w.clone()),
                    _ => {}
                }
                if depth == 0 {
                    break;
                }
            }
            out
        }
        _ => Vec::new(),
    }
}

#[test]
fn imports_go_down_only() {
    let mut wrong = Vec::new();
    for file in rust_files(&source_folder()) {
        let Some(own) = module_path(&file).first().cloned() else { continue };
        let Some(own_floor) = floor(&own) else {
            wrong.push(format!("{}: the room '{own}' has no floor", file.display()));
            continue;
        };
        for room in rooms_and_children(&file).0 {
            // What is not a room is an item re-exported at the crate's root.
            match floor(&room) {
                Some(f) if room != own && f >= own_floor => {
                    wrong.push(format!("{}: {own} imports {room}, which is not below it", file.display()));
                }
                None => wrong.push(format!("{}: '{room}' is not a room", file.display())),
                _ => {}
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn rooms_are_not_in_a_circle() {
    let mut imports: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for file in rust_files(&source_folder()) {
        if let Some(own) = module_path(&file).first().cloned() {
            let others = rooms_and_children(&file).0.into_iter().filter(|room| *room != own);
            imports.entry(own.clone()).or_default().extend(others);
        }
    }
    // Rooms that import nothing that is left are taken away; a circle stays.
    loop {
        let free: Vec<String> = imports
            .iter()
            .filter(|(_, to)| !to.iter().any(|room| imports.contains_key(room)))
            .map(|(room, _)| room.clone())
            .collect();
        if free.is_empty() {
            break;
        }
        for room in free {
            imports.remove(&room);
        }
    }
    assert!(imports.is_empty(), "in a circle: {imports:?}");
}

#[test]
fn every_file_is_reached() {
    let folder = source_folder();
    let mut reached = BTreeSet::new();
    let mut waiting = vec![folder.join("lib.rs"), folder.join("main.rs")];
    while let Some(file) = waiting.pop() {
        let children = rooms_and_children(&file).1;
        let mut below = folder.clone();
        below.extend(module_path(&file));
        for child in children {
            let candidates = [below.join(format!("{child}.rs")), below.join(&child).join("mod.rs")];
            let found = candidates.into_iter().find(|c| c.is_file());
            waiting.push(found.unwrap_or_else(|| panic!("{}: no file for 'mod {child}'", file.display())));
        }
        reached.insert(file);
    }
    let orphans: Vec<PathBuf> = rust_files(&folder).into_iter().filter(|f| !reached.contains(f)).collect();
    assert!(orphans.is_empty(), "no 'mod' reaches {orphans:?}");
}

#[test]
fn only_number_names_malachite() {
    for file in rust_files(&source_folder()) {
        if module_path(&file).first().is_some_and(|room| room == "number") {
            continue;
        }
        let words = tokens(&fs::read_to_string(&file).expect("the file is readable"));
        let named = words.iter().any(|t| matches!(t, Token::Word(w) if w.starts_with("malachite")));
        assert!(!named, "{} names malachite", file.display());
    }
}

#[test]
fn files_are_short() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    for folder in ["src", "tests", "benches", "fuzz/fuzz_targets"] {
        let folder = root.join(folder);
        for file in if folder.is_dir() { rust_files(&folder) } else { Vec::new() } {
            let lines = fs::read_to_string(&file).expect("the file is readable").lines().count();
            assert!(lines <= LONGEST_FILE, "{} has {lines} lines", file.display());
        }
    }
}

#[test]
fn the_reader_of_imports_finds_them() {
    let code = r##"
        //! crate::comment
        use crate::{error::{Error, Span}, number::Rational, poly};
        fn f() { let s = "crate::string"; let r = r#"crate::raw"#; let c = '"'; crate::matrix::g::<'static>() }
        mod tests { use super::super::stability; }
    "##;
    let words: Vec<String> =
        tokens(code).iter().filter_map(|t| if let Token::Word(w) = t { Some(w.clone()) } else { None }).collect();
    assert!(!words.iter().any(|w| ["comment", "string", "raw"].contains(&w.as_str())));
    let all = tokens(code);
    let start = all.iter().position(|t| *t == Token::Word("crate".into())).unwrap();
    assert_eq!(following(&all, start + 2), ["error", "number", "poly"]);
    assert!(module_path(&source_folder().join("lib.rs")).is_empty());
    assert_eq!(module_path(&source_folder().join("poly/dense.rs")), ["poly", "dense"]);
}
