//! Changed certificates: what is accepted is true, in both checkers.

use crate::python::Python;
use crate::truth::is_true;
use crate::writer::{Asked, GAIN, LIMITS, at_input, held, one, phase, sampled, two};
use jurist_check::check;

/// Numbers that look random.
struct Draw(u64);

impl Draw {
    fn below(&mut self, bound: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % bound.max(1)
    }
}

fn asked() -> Vec<Asked> {
    let greatest = |proved: &str| format!(r#"{{"greatest": {GAIN}, "proved": "{proved}"}}"#);
    let product = r#"{"greatest": {"above": [["1", 1, 1]], "below": [["2"], ["1", 0, 1]]}, "proved": "11/2"}"#;
    let level = |own: &str| format!(r#"{{"level": {own}}}"#);
    let both = format!("{}, {}", phase(30), at_input("gain_margin", "5/4"));
    vec![
        one().between("7", "20"),
        one().between("4", "20").require(&at_input("gain_margin", "2")),
        one().objective(&greatest("7")).found("5", "null"),
        one().region(r#"{"decay": "1/5"}"#).objective(&greatest("5")).found("1/2", "null"),
        one().objective(&level(r#"{"decay": "9/20"}"#)).found("3/8", r#"{"decay": "1/10"}"#),
        one().objective(&level(&phase(85))).found("1/2", &phase(40)),
        one().objective(&level(&at_input("modulus_margin", "99/100"))).found("1/2", &at_input("modulus_margin", "1/2")),
        two().require(&both).objective(&greatest("8")).found_at(&["1", "3/2"], "null"),
        two().objective(product).found_at(&["1", "1"], "null"),
        two().region(r#"{"decay": "3"}"#),
        sampled().objective(&greatest("3/2")).found_at(&["3/4", "3/4"], "null"),
        sampled().objective(&level(r#"{"radius": "1/2"}"#)).found_at(&["1/2", "1/2"], r#"{"radius": "9/10"}"#),
        held().objective(&greatest("5")).found_at(&["1", "1"], "null"),
        held().require(&at_input("disk_margin", "1")).objective(&greatest("7/2")).found_at(&["1/2", "1"], "null"),
    ]
}

/// Places of the texts between quotes.
fn texts(certificate: &str) -> Vec<(usize, usize)> {
    let quotes: Vec<usize> = certificate.match_indices('"').map(|(i, _)| i).collect();
    quotes.chunks(2).map(|pair| (pair[0] + 1, pair[1])).collect()
}

fn with_number(certificate: &str, draw: &mut Draw) -> String {
    const NUMBERS: [&str; 12] = ["0", "1", "2", "1/2", "-1", "3/4", "5", "1/100", "90", "9/10", "100", "20"];
    let is_number =
        |text: &str| text.starts_with(|c: char| c.is_ascii_digit() || c == '-') && !text.contains(['.', ';']);
    let numbers: Vec<_> = texts(certificate).into_iter().filter(|(i, k)| is_number(&certificate[*i..*k])).collect();
    let (i, k) = numbers[draw.below(numbers.len())];
    let (top, below) = certificate[i..k].split_once('/').unwrap_or((&certificate[i..k], "1"));
    let (top, below): (i64, i64) = (top.parse().unwrap_or(1), below.parse().unwrap_or(1));
    let new = match draw.below(3) {
        0 => NUMBERS[draw.below(NUMBERS.len())].to_owned(),
        n => format!("{}/{}", top * ([100, 97, 130, 60][draw.below(4)] + n as i64), below * 100),
    };
    let mut out = certificate.to_owned();
    out.replace_range(i..k, &new);
    out
}

fn with_word(certificate: &str, draw: &mut Draw) -> String {
    const WORDS: [&str; 16] = [
        "greatest",
        "least",
        "decay",
        "radius",
        "phase_margin",
        "gain_margin",
        "modulus_margin",
        "disk_margin",
        "complementary_peak",
        "continuous",
        "discrete",
        "K",
        "a",
        "above",
        "below",
        "level",
    ];
    let words: Vec<_> = texts(certificate).into_iter().filter(|(i, k)| WORDS.contains(&&certificate[*i..*k])).collect();
    let (i, k) = words[draw.below(words.len())];
    let mut out = certificate.to_owned();
    out.replace_range(i..k, WORDS[draw.below(WORDS.len())]);
    out
}

fn with_letter(certificate: &str, draw: &mut Draw) -> String {
    const LETTERS: [&str; 20] = [
        ".", "o", "-", "a", "b", "c", "d", "0", "1", "2", "m", "l", "u", "<", ">", "-0.", "-1.", "s-3;0.", "oo",
        "s-9;1.",
    ];
    let key = if draw.below(4) == 0 && certificate.contains("\"proof\"") { "\"proof\": \"" } else { "\"tree\": \"" };
    let at = certificate.find(key).expect("it is there") + key.len();
    let end = at + certificate[at..].find('"').expect("its end");
    let i = at + draw.below(end - at);
    let letter = LETTERS[draw.below(LETTERS.len())];
    let mut out = certificate.to_owned();
    match draw.below(3) {
        0 if i < end => out.replace_range(i..=i, letter),
        1 if i < end => out.replace_range(i..=i, ""),
        _ => out.insert_str(i, letter),
    }
    out
}

/// An exponent, or a name more.
fn with_count(certificate: &str, draw: &mut Draw) -> String {
    let pairs = [
        ("\", 1]", "\", 2]"),
        (", 1]", "]"),
        ("\"found\": {", "\"found\": null, \"x\": {"),
        ("\"require\": [", "\"require\": [{}, "),
        ("\"order\": 3", "\"order\": 1"),
        ("\"order\": 3", "\"order\": 5"),
        ("\"set\": {}", "\"set\": {\"K\": \"1\"}"),
        ("\"level\": null", "\"level\": {\"decay\": \"1/100\"}"),
    ];
    let (find, put) = pairs[draw.below(pairs.len())];
    certificate.replacen(find, put, 1)
}

fn changed(certificate: &str, draw: &mut Draw) -> String {
    match draw.below(9) {
        0..=3 => with_number(certificate, draw),
        4 => with_word(certificate, draw),
        5 => with_count(certificate, draw),
        _ => with_letter(certificate, draw),
    }
}

/// `JURIST_CHANGES=1000` looks at so many changes.
#[test]
#[ignore = "long: CI runs it"]
fn what_is_accepted_of_changed_certificates_of_gains_is_true() {
    let count = std::env::var("JURIST_CHANGES").ok().and_then(|n| n.parse().ok()).unwrap_or(60);
    let mut draw = Draw(5);
    let all: Vec<(Asked, String)> = asked()
        .into_iter()
        .enumerate()
        .map(|(i, asked)| {
            let certificate = asked.written().unwrap_or_else(|| panic!("the judge does not see {i}"));
            let proved =
                check(&asked.plant.model, &certificate, &LIMITS).unwrap_or_else(|e| panic!("{e}\n{certificate}"));
            assert!(is_true(&asked.plant, &certificate), "{proved:?}\n{certificate}");
            (asked, certificate)
        })
        .collect();
    let (mut python, mut accepted, mut differ) = (Python::start(), 0, 0);
    for _ in 0..count {
        let (asked, certificate) = &all[draw.below(all.len())];
        let mut own = changed(certificate, &mut draw);
        if draw.below(3) == 0 {
            own = changed(&own, &mut draw);
        }
        if own == *certificate {
            continue;
        }
        let found = check(&asked.plant.model, &own, &LIMITS);
        let other = python.as_mut().map(|python| python.judge(&asked.plant.model, &own));
        let by_python = other.as_ref().is_some_and(|(word, _)| word == "accepted");
        if found.is_ok() || by_python {
            assert!(is_true(&asked.plant, &own), "{found:?} {other:?}\n{}\n{own}", asked.plant.model);
            accepted += 1;
        }
        if let (Ok(proved), Some((_, said)), true) = (&found, &other, by_python) {
            assert_eq!(proved.statement, *said);
        }
        // What one sees only just the other may not see.
        if other.is_some() && found.is_ok() != by_python {
            println!("{found:?} {other:?}\n{own}");
            differ += 1;
        }
    }
    println!("{accepted} of {count} are accepted, {differ} by one checker alone");
    assert!(accepted * 20 > count && differ * 50 <= count, "{accepted} of {count}, {differ}");
}
