//! What the two checkers once said different words of, or took gigabytes for, by name.

use super::{assert_same, text};
use crate::python::Python;
use jurist_check::format::Json;

/// A certificate of the corpus with a piece of its text replaced.
fn with(name: &str, from: &str, to: &str) -> String {
    let certificate = text(name);
    assert_eq!(certificate.matches(from).count(), 1, "{from} in\n{certificate}");
    certificate.replace(from, to)
}

fn assert_word(model: &str, certificate: &str, word: &str) {
    let Some(mut python) = Python::start() else { return };
    assert_eq!(assert_same(&mut python, model, certificate).as_deref(), Ok(word), "{certificate}");
}

#[test]
fn an_escaped_emoji_in_a_title_is_read() {
    let escaped = r"\ud83d\ude00";
    let said =
        |title: &str| with("plain.1.json", "\"title\": \"Two gains, \u{1f600}\"", &format!("\"title\": \"{title}\""));
    assert_word(&text("plain.toml"), &said(escaped), "accepted");
    for half in [r"\ud83d", r"\ude00", r"\ude00\ud83d", r"\ud83dx"] {
        assert_word(&text("plain.toml"), &said(half), "rejected");
    }
}

#[test]
fn counts_and_nesting_end_at_the_same_place() {
    let about = |value: &str| with("plain.1.json", "\"model\": {", &format!("\"model\": {{\"x\": {value}, "));
    let nested = |n: usize| format!("{}{}", "[".repeat(n), "]".repeat(n));
    for (value, word) in [
        ("999999999".to_owned(), "accepted"),
        ("1000000000".into(), "rejected"),
        ("4000000000".into(), "rejected"),
        (nested(14), "accepted"),
        (nested(15), "rejected"),
        (nested(5000), "rejected"),
    ] {
        assert_word(&text("plain.toml"), &about(&value), word);
    }
}

/// Its integer factors move no zero.
#[test]
fn a_factor_over_symbols_need_not_be_primitive() {
    let mut json = Json::parse(&text("held.2.json")).expect("a certificate");
    let Json::Object(pairs) = &mut json else { panic!("an object") };
    let factors = pairs.iter_mut().find(|(key, _)| key == "factors");
    let Some((_, Json::List(factors))) = factors else { panic!("factors") };
    for factor in factors.iter_mut() {
        let Json::List(terms) = factor else { panic!("terms") };
        for term in terms {
            let Json::List(parts) = term else { panic!("a term") };
            let Json::Text(c) = &mut parts[0] else { panic!("a number") };
            *c = if c == "0" { c.clone() } else { format!("{}", 6 * c.parse::<i64>().expect("a short number")) };
        }
    }
    let Some(mut python) = Python::start() else { return };
    let word = assert_same(&mut python, &text("held.toml"), &json.to_text());
    assert!(word.is_ok(), "{word:?}");
}

/// U+001C to U+001F are white space to Python and to nobody else.
#[test]
fn control_characters_are_no_white_space() {
    let model = text("plain.toml");
    for c in ["\\u001c", "\\u001f", "\\u001e"] {
        for tolerance in [format!("{c}10%"), format!("10%{c}"), format!("10{c}%")] {
            assert_word(&model.replace("\"10%\"", &format!("\"{tolerance}\"")), &text("plain.1.json"), "rejected");
        }
    }
    assert_word(&model.replace("\"10%\"", "\"\\u00a010\\u2028%\""), &text("plain.1.json"), "accepted");
    assert_word(&model.replace("+ a + K/4\"", "+ a + K/4\\u001c\""), &text("plain.1.json"), "rejected");
}

/// The reader that takes another common denominator has a power of `tau` in all coefficients.
#[test]
fn a_factor_that_all_coefficients_have_does_not_hide_a_sign() {
    let boxes = |window: &str, tree: &str| {
        format!(
            r#"{{"schema": "jurist/certificate/7", "statement": {{"kind": "boxes", "time": "discrete", "x": "tau", "y": "K", "set": {{}},
            "region": {{"radius": "1"}}, "window": {window}, "tree": "{tree}"}}, "order": 6, "bits": 256}}"#
        )
    };
    let Some(mut python) = Python::start() else { return };
    for model in [text("foh.toml"), text("foh.toml").replace("tau*s-1", "tau*s+1")] {
        for (window, tree) in [
            (r#"{"x": ["-3/20", "-1/10"], "y": ["-3", "-3/2"]}"#, "+"),
            (r#"{"x": ["1/32", "5/128"], "y": ["13/4", "4"]}"#, "-"),
            (r#"{"x": ["1/10", "1/5"], "y": ["13/4", "4"]}"#, "xyyyy????????????????-"),
            (r#"{"x": ["1/2", "1"], "y": ["2", "3"]}"#, "+"),
            (r#"{"x": ["1/2", "1"], "y": ["1/4", "1/2"]}"#, "-"),
        ] {
            let same = assert_same(&mut python, &model, &boxes(window, tree));
            assert!(same.is_ok(), "{same:?}");
        }
    }
}

/// An enclosure of a dead time names one switch: it holds no other.
#[test]
fn an_end_of_a_window_holds_one_switch() {
    let (model, certificate) = (text("windows.toml"), text("windows.3.json"));
    assert_word(&model, &certificate, "accepted");
    let mut json = Json::parse(&certificate).expect("a certificate");
    let between = first_between(&mut json).expect("a switch");
    *between = Json::List(vec!["1/1000".into(), "1000".into()]);
    assert_word(&model, &json.to_text(), "rejected");
    let between = first_between(&mut json).expect("a switch");
    *between = Json::List(vec!["4/5".into(), "1".into()]);
    assert_word(&model, &json.to_text(), "accepted");
}

fn first_between(json: &mut Json) -> Option<&mut Json> {
    match json {
        Json::List(items) => items.iter_mut().find_map(first_between),
        Json::Object(pairs) => pairs.iter_mut().find_map(|(key, value)| match key.as_str() {
            "between" => Some(value),
            _ => first_between(value),
        }),
        _ => None,
    }
}

/// A certificate of less than a kilobyte whose factor has a high degree, or long ends, took gigabytes and minutes.
#[test]
fn short_certificates_of_much_work_are_refused() {
    let model = text("tolerance.toml");
    let of = |factor: &str, polynomial: &str, tree: &str| {
        let mut json = Json::parse(&text("tolerance.4.json")).expect("a certificate");
        let Json::Object(pairs) = &mut json else { panic!("an object") };
        let factors = format!("[{{\"polynomial\": {polynomial}, \"tree\": \"{tree}\"}}]");
        for (key, value) in pairs {
            match (key.as_str(), value) {
                ("factors", value) => *value = Json::parse(&factors).expect("factors"),
                ("statement", Json::Object(parts)) => {
                    parts.iter_mut().filter(|(key, _)| key == "factor").for_each(|(_, value)| *value = factor.into());
                }
                _ => {}
            }
        }
        json.to_text()
    };
    let long = format!("{}/{}", "9".repeat(60), "7".repeat(60));
    for (factor, polynomial, tree) in [
        ("1310719/262144", r#"[["1", 4000, 30], ["1", 1]]"#, "+".to_owned()),
        (long.as_str(), r#"[["1", 4000, 30], ["1", 1]]"#, "+".to_owned()),
        ("1310719/262144", r#"[["1", 300], ["1", 0, 300]]"#, "s0,".repeat(600)),
    ] {
        assert_word(&model, &of(factor, polynomial, &tree), "refused");
    }
}

/// `tomllib` reads TOML 1.0 before Python 3.15; models may have what TOML 1.1 adds.
#[test]
fn models_of_toml_1_1_are_read() {
    let Some(mut python) = Python::start() else { return };
    let line = "T = { nominal = \"1/2\", tolerance = \"10%\" }";
    for (other, word) in [
        ("T = {\n nominal = \"1/2\", # {seconds}\r\n tolerance = \"10%\"\n, }", "accepted"),
        (
            "T = { \"n\\x6fminal\" = \"1/2\", unit = \"\\e\", tolerance = [ # share\n \"-10%\", \"10%\", ], }",
            "accepted",
        ),
        ("T = { nominal = \"1/2\",, }", "rejected"),
        ("T = { nominal\n =\n \"1/2\" }", "accepted"),
        ("T = { nominal . \n x = 1 }", "rejected"),
        ("T = { nominal = \"1/2\"\n unit = \"s\" }", "rejected"),
        ("T = { nominal = \"1/2\", # \u{7f}\n }", "rejected"),
        ("T = { nominal = \"1/2\", \r }", "rejected"),
        ("T = { , }", "rejected"),
        ("T = { nominal = \"\\x6\", }", "rejected"),
        ("T = { nominal = \"1/2, }", "rejected"),
    ] {
        let model = text("plain.toml");
        assert_eq!(model.matches(line).count(), 1);
        assert_eq!(assert_same(&mut python, &model.replace(line, other), &text("plain.1.json")).as_deref(), Ok(word));
    }
}

/// So precise that one of the checkers counted too much work.
#[test]
fn boxes_are_computed_with_few_bits() {
    for name in ["foh", "delayed"] {
        let (model, certificate) = (text(&format!("{name}.toml")), text(&format!("{name}.7.json")));
        let mut json = Json::parse(&certificate).expect("a certificate");
        for (bits, word) in [(512, "accepted"), (1025, "rejected"), (4000, "rejected")] {
            let Json::Object(pairs) = &mut json else { panic!("an object") };
            pairs.iter_mut().filter(|(key, _)| key == "bits").for_each(|(_, value)| *value = Json::Count(bits));
            assert_word(&model, &json.to_text(), word);
        }
    }
}

/// The exponential of a large number has as many digits; both took minutes.
#[test]
fn exponentials_of_large_numbers_are_refused() {
    let model = text("foh.toml").replace("1/5", "10000000001/5");
    assert_word(&model, &text("foh.7.json"), "refused");
}

/// An exponent that is allowed and far from the right one.
#[test]
fn long_exponents_get_the_same_word() {
    let Some(mut python) = Python::start() else { return };
    let mut wrong = Vec::new();
    for (model, certificate) in super::corpus() {
        let json = Json::parse(&certificate).expect("a certificate");
        let counts = (0..).take_while(|&n| nth_count(&mut json.clone(), &mut { n }).is_some()).count();
        for n in (0..counts).step_by(counts / 2 + 1) {
            let mut json = json.clone();
            *nth_count(&mut json, &mut { n }).expect("a count") = 4000;
            wrong.extend(assert_same(&mut python, &model, &json.to_text()).err());
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

fn nth_count<'j>(json: &'j mut Json, n: &mut usize) -> Option<&'j mut u32> {
    match json {
        Json::Count(count) if *n == 0 => Some(count),
        Json::Count(_) => {
            *n -= 1;
            None
        }
        Json::List(items) => items.iter_mut().find_map(|item| nth_count(item, n)),
        Json::Object(pairs) => pairs.iter_mut().find_map(|(_, value)| nth_count(value, n)),
        _ => None,
    }
}
