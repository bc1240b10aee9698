//! Random changes of certificates and models.

use jurist_check::format::Json;

/// Numbers that look random.
pub struct Draw(u64);

impl Draw {
    pub fn new(seed: u64) -> Self {
        Draw(seed)
    }

    pub fn below(&mut self, bound: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) as usize) % bound.max(1)
    }

    fn of<'t, T>(&mut self, items: &'t [T]) -> &'t T {
        &items[self.below(items.len())]
    }
}

/// What stands in a text where something else stood.
const PIECES: [&str; 48] = [
    "",
    "0",
    "1",
    "-1",
    "7",
    "9",
    "1/7",
    "-3/2",
    "00",
    "1_0",
    "1e3",
    "1.5",
    "0x1f",
    "1e400",
    "999999999",
    "1000000000",
    " ",
    "\t",
    "\u{1c}",
    "\u{a0}",
    "\u{85}",
    "\u{2028}",
    "\n",
    "\r\n",
    "\"",
    "'",
    "\\",
    "\\u0041",
    "\\ud83d\\ude00",
    "\\ud800",
    "\\u001f",
    "\\u001c",
    "[",
    "]",
    "{",
    "}",
    ",",
    ":",
    "null",
    "true",
    "(",
    ")",
    "*",
    "+",
    "-",
    "^",
    "K",
    "\u{e9}",
];

/// Numbers of certificates.
const NUMBERS: [&str; 18] = [
    "0",
    "1",
    "-1",
    "2",
    "1/2",
    "-7/3",
    "2/4",
    "1/0",
    "1/-2",
    "-0",
    "007",
    "+1",
    "1e3",
    "100000000000000000000000000000/7",
    "-12345678901234567890",
    "",
    "parameter",
    "0.5",
];

const WORDS: [&str; 22] = [
    "schema",
    "statement",
    "model",
    "kind",
    "intervals",
    "verdict",
    "boxes",
    "cells",
    "map",
    "tolerance",
    "radius",
    "decay",
    "discrete",
    "continuous",
    "stable",
    "unstable",
    "marginal",
    "undefined",
    "K",
    "T",
    "tau",
    "x",
];

/// Model and certificate, one of them or both changed in one to three places.
pub fn changed(corpus: &[(String, String)], draw: &mut Draw) -> (String, String) {
    let (mut model, mut certificate) = draw.of(corpus).clone();
    match draw.below(20) {
        0 => model = draw.of(corpus).0.clone(),
        1..=5 => model = (0..1 + draw.below(2)).fold(model, |text, _| in_text(&text, draw)),
        6 | 7 => certificate = in_text(&certificate, draw),
        8 => {
            let version = |n: usize| format!("certificate/{n}");
            let (from, to) = (1 + draw.below(7), 1 + draw.below(8));
            certificate = certificate.replace(&version(from), &version(to));
        }
        _ => {
            let mut json = Json::parse(&certificate).expect("a certificate");
            for _ in 0..1 + draw.below(3) {
                change(&mut json, draw);
            }
            certificate = json.to_text();
        }
    }
    (model, certificate)
}

/// A piece of a text replaced, left out, doubled, or moved.
fn in_text(text: &str, draw: &mut Draw) -> String {
    let places: Vec<usize> = text.char_indices().map(|(at, _)| at).chain([text.len()]).collect();
    let from = draw.below(places.len());
    let to = (from + draw.below(4)).min(places.len() - 1);
    let (before, cut, after) = (&text[..places[from]], &text[places[from]..places[to]], &text[places[to]..]);
    match draw.below(6) {
        0 => format!("{before}{after}"),
        1 => format!("{before}{cut}{cut}{after}"),
        2 => {
            // An empty text has an empty line.
            let mut lines: Vec<&str> = text.split('\n').collect();
            let (a, b) = (draw.below(lines.len()), draw.below(lines.len()));
            match draw.below(3) {
                0 => lines.swap(a, b),
                1 => lines.insert(a, lines[b]),
                _ => drop(lines.remove(a)),
            }
            lines.join("\n")
        }
        3 => format!("{before}{}{cut}{after}", draw.of(&PIECES)),
        _ => format!("{before}{}{after}", draw.of(&PIECES)),
    }
}

/// All values, by the ways to them.
fn ways(json: &Json, way: &mut Vec<usize>, out: &mut Vec<Vec<usize>>) {
    out.push(way.clone());
    let children: Vec<&Json> = match json {
        Json::List(items) => items.iter().collect(),
        Json::Object(pairs) => pairs.iter().map(|(_, value)| value).collect(),
        _ => Vec::new(),
    };
    for (i, child) in children.into_iter().enumerate() {
        way.push(i);
        ways(child, way, out);
        way.pop();
    }
}

fn at<'j>(json: &'j mut Json, way: &[usize]) -> &'j mut Json {
    way.iter().fold(json, |json, &i| match json {
        Json::List(items) => &mut items[i],
        Json::Object(pairs) => &mut pairs[i].1,
        _ => unreachable!("ways lead through lists and objects"),
    })
}

fn change(json: &mut Json, draw: &mut Draw) {
    let mut all = Vec::new();
    ways(json, &mut Vec::new(), &mut all);
    let other = at(json, &all[draw.below(all.len())]).clone();
    let place = at(json, &all[draw.below(all.len())]);
    if draw.below(12) == 0 {
        *place = other;
        return;
    }
    match place {
        Json::Null => *place = Json::Text(draw.of(&NUMBERS).to_string()),
        Json::Bool(b) => *b = !*b,
        Json::Count(n) => {
            *n = *draw.of(&[
                0,
                1,
                2,
                3,
                64,
                65,
                4000,
                4001,
                999_999_999,
                n.wrapping_add(1) % 1_000_000,
                n.saturating_sub(1),
            ])
        }
        Json::Text(text) => *text = changed_text(text, draw),
        Json::List(items) => match (draw.below(4), items.len()) {
            (_, 0) | (3, _) => items.push(other),
            (0, n) => drop(items.remove(draw.below(n))),
            (1, n) => {
                let k = draw.below(n);
                items.insert(k, items[k].clone());
            }
            (_, n) => items.swap(draw.below(n), draw.below(n)),
        },
        Json::Object(pairs) => match (draw.below(4), pairs.len()) {
            (_, 0) | (0, _) => pairs.push((draw.of(&WORDS).to_string(), other)),
            (1, n) => drop(pairs.remove(draw.below(n))),
            (2, n) => pairs[draw.below(n)].0 = draw.of(&WORDS).to_string(),
            (_, n) => pairs.swap(draw.below(n), draw.below(n)),
        },
    }
}

/// Of numbers, words and trees.
fn changed_text(text: &str, draw: &mut Draw) -> String {
    let nudged = |by: i64| match text.split_once('/') {
        Some((n, d)) => n.parse::<i64>().ok().map(|n| format!("{}/{d}", n.wrapping_add(by))),
        None => text.parse::<i64>().ok().map(|n| n.wrapping_add(by).to_string()),
    };
    match draw.below(7) {
        0 => draw.of(&NUMBERS).to_string(),
        1 => draw.of(&WORDS).to_string(),
        2 | 3 => nudged(draw.below(3) as i64 - 1).unwrap_or_else(|| in_text(text, draw)),
        4 if text.parse::<i64>().is_ok() => format!("{text}000001/1000000"),
        5 if text.len() > 3 && text.chars().all(|c| "xys+-?".contains(c)) => {
            let at = draw.below(text.len());
            format!("{}{}{}", &text[..at], draw.of(&["+", "-", "?", "x", "y", "x??"]), &text[at + 1..])
        }
        _ => in_text(text, draw),
    }
}
