//! The corpus asked of the program: its JSON, and the certificates that it writes beside it.

use crate::helpers::certificates::checkers::accept;
use crate::helpers::corpus::{Case, Expectation, Found, FoundEnd, ask_all};
use crate::helpers::number::number;
use crate::helpers::program::{jurist_with_input, number_in};
use jurist_algebra::number::Rational;
use jurist_algebra::poly::UniPoly;
use serde_json::Value;

/// What the program answers, and its certificate where there is one.
fn found(case: &Case, expectation: &Expectation) -> Result<(Found, Option<String>), String> {
    let file = std::env::temp_dir().join(format!("jurist-corpus-{}.json", std::process::id()));
    let mut arguments = expectation.arguments();
    arguments.extend(["-", "--json", "--digits", "40"].map(str::to_owned));
    if case.is_proved {
        arguments.extend(["--certificate".to_owned(), file.to_str().unwrap().to_owned()]);
    }
    let run = jurist_with_input(&arguments.iter().map(String::as_str).collect::<Vec<_>>(), case.model.as_bytes());
    let document: Value =
        serde_json::from_str(&run.stdout).map_err(|e| format!("{e}: {}{}", run.stdout, run.stderr))?;
    if !case.is_proved {
        return Ok((answer(&document), None));
    }
    let certificate = std::fs::read_to_string(&file).map_err(|e| format!("no certificate: {e}; {}", run.stderr))?;
    std::fs::remove_file(&file).unwrap();
    Ok((answer(&document), Some(certificate)))
}

fn answer(document: &Value) -> Found {
    if document["schema"] == "jurist/verdict/1" {
        let roots = ["inside", "on", "outside", "infinite"].map(|key| document[key].as_u64().unwrap_or(0));
        return Found::Verdict { verdict: document["verdict"].as_str().unwrap().to_owned(), roots };
    }
    assert_eq!(document["schema"], "jurist/intervals/1");
    let intervals = document["stable"].as_array().expect("decided");
    Found::Stable(intervals.iter().map(|i| [end(&i["lower"]), end(&i["upper"])]).collect())
}

fn end(end: &Value) -> Option<FoundEnd> {
    if end.is_null() {
        return None;
    }
    let coefficients = end["polynomial"].as_array().into_iter().flatten();
    let coefficients = coefficients.map(|c| number_in(c).numerator()).collect();
    let mut frequencies = Vec::new();
    if let Some(bounds) = end["frequency_enclosure"].as_array() {
        frequencies.push(("Hz", [number_in(&bounds[0]), number_in(&bounds[1])]));
    }
    for (unit, key) in [("rad/s", "radians_per_second"), ("rad", "angle")] {
        if end[key].is_number() {
            frequencies.push((unit, rounded(&number(&end[key].to_string()))));
        }
    }
    Some(FoundEnd {
        exact: end["exact"].as_str().map(number),
        enclosure: [number_in(&end["enclosure"][0]), number_in(&end["enclosure"][1])],
        polynomial: UniPoly::new(coefficients),
        causes: Some(end["cause"].as_str().unwrap().to_owned()),
        frequencies: Some(frequencies),
    })
}

/// The numbers that a number of twelve digits may stand for.
fn rounded(value: &Rational) -> [Rational; 2] {
    let error = value.abs() * number("1e-11");
    [value - &error, value + &error]
}

#[test]
#[ignore = "long: CI runs it"]
fn the_program_answers_as_expected_and_proves_it() {
    ask_all(3, |case, expectation| {
        let (found, certificate) = found(case, expectation)?;
        if let Some(certificate) = certificate {
            accept(&case.model, &certificate);
        }
        expectation.answer.compare(&found)
    });
}
