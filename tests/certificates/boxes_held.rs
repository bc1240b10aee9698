//! Certificates of tolerances of loops with plants behind holds, pulses and prewarped rules: both checkers accept what the engine writes and nothing that is wrong.

use super::boxes::is_true;
use crate::helpers::certificates::checkers::{accept, reject, reject_or_find_true};
use crate::helpers::certificates::with;
use crate::helpers::model::{example_text, path, read};
use crate::helpers::number::number;
use crate::helpers::program::jurist;
use crate::helpers::thorough::{count, tried};
use jurist::Ask;
use jurist::Certificate;
use jurist_algebra::limits::Budget;
use jurist_check::format::Json;
use jurist_check::{Limits, Step, check};
use jurist_engine::answer::ToleranceRequest;
use jurist_engine::error::{Code, Error};
use jurist_engine::problem::Region;
use std::time::Duration;

/// No test may fail because the machine is busy.
const LIMITS: Limits = Limits::within(Duration::MAX);

/// A controller `(a z + b)/z` and a plant.
fn loop_of(plant: &str) -> String {
    format!(
        "time = 'discrete'\nsample_time = 'T'\nconstants.T = '1/5'\n[parameters]\na = {{ nominal = '1/2', tolerance = '20%' }}\n\
         b = {{ nominal = '-1/5', tolerance = '1/10' }}\n[loop]\n[[block]]\ninput = '-y'\noutput = 'u'\nnum = ['a', 'b']\nden = [1, 0]\n\
         [[block]]\ninput = 'u'\noutput = 'y'\n{plant}\n"
    )
}

/// A complex mode with little damping behind a hold, with dead time; behind a first-order hold; pulses; a double and an unstable mode; modes of third
/// order; an integrator; a matrix in which a parameter stands outside of the exponential; a prewarped rule.
const PLANTS: [&str; 9] = [
    "transfer = '1/(s^2 + s/20 + 9)'\ndiscretize = { method = 'zoh', delay = '0.3*T' }",
    "transfer = '(2 - s)/(s^2 + s/2 + 3)'\ndiscretize = 'foh'",
    "transfer = '1/(s + 1)'\ndiscretize = { method = 'pwm', edge = 'trailing', duty = '1/3' }",
    "transfer = '(2 - s)/(s^2 + s/2 + 3)'\ndiscretize = { method = 'pwm', edge = 'double', duty = '2/5', delay = '0.6*T' }",
    "transfer = '-3/((s + 1)^2*(s - 1/2))'\ndiscretize = 'zoh'",
    "transfer = '1/(s^3 + 2*s^2 + s + 1)'\ndiscretize = 'zoh'",
    "transfer = '1/(s*(s + 1))'\ndiscretize = { method = 'zoh', delay = 'T/2' }",
    "A = [[0, 1], [-5, -2]]\nB = [[0], ['1 + a/3']]\nC = [[1, 'b/7']]\ndiscretize = 'zoh'",
    "transfer = '1/(s^2 + s/2 + 3)'\ndiscretize = { method = 'tustin', prewarp = 2 }",
];

fn request(text: &str) -> ToleranceRequest {
    ToleranceRequest::of_model(&read(text)).gap(number("1/1000"))
}

fn certificate_of(text: &str, request: &ToleranceRequest, region: Option<Region>) -> Result<String, Error> {
    let (model, budget) = (read(text), Budget::unlimited());
    let question = region.into_iter().fold(model.ask(), |question, region| question.within(region));
    question.tolerance(request, &budget).unwrap_or_else(|e| panic!("{e}\n{text}")).certificate(&budget)
}

fn emitted(text: &str) -> String {
    certificate_of(text, &request(text), None).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

fn json(certificate: &str) -> Json {
    Json::parse(certificate).unwrap()
}

/// Whether a point beyond is in the certificate.
fn has_beyond(certificate: &str) -> bool {
    let statement = json(certificate).get("statement").cloned().unwrap();
    matches!(statement.get("beyond"), Some(Json::List(points)) if !points.is_empty())
}

#[test]
#[ignore = "long: CI runs it"]
fn boxes_of_held_loops_of_all_kinds_are_certified() {
    let mut boxes = 0;
    for plant in tried(PLANTS, 2) {
        let text = loop_of(plant);
        let certificate = emitted(&text);
        accept(&text, &certificate);
        if certificate.contains("jurist/certificate/8") {
            boxes += 1;
            assert!(has_beyond(&certificate), "{plant}");
            assert!(is_true(&text, &json(&certificate)), "{plant}\n{certificate}");
        } else {
            // The nominal point is not stable: its verdict.
            assert!(certificate.contains("jurist/certificate/2"), "{plant}");
        }
    }
    assert!(boxes >= 4 * count(1, 2), "{boxes} boxes");
}

#[test]
#[ignore = "long: CI runs it"]
fn the_drive_behind_a_hold_is_certified_in_its_controllers() {
    let drive = example_text("drive-hold");
    let of = |names: &str| {
        let sides = names.split(' ').map(|name| (name, "30%".parse().unwrap()));
        ToleranceRequest::new(sides).gap(number("1/1000"))
    };
    for names in tried(["K_ps K_is", "K_pi K_ii K_ps K_is", "k_1 k_2 E_sw"], 3) {
        let certificate = certificate_of(&drive, &of(names), None).unwrap();
        assert!(certificate.contains("jurist/certificate/8") && has_beyond(&certificate), "{names}");
        accept(&drive, &certificate);
    }
    // Of an exact end the bracket is certified.
    let exact = certificate_of(&drive, &of("K_ps").exact(), None).unwrap();
    accept(&drive, &exact);
    // What is inside of the exponentials has no certificate.
    for name in ["L_a", "T"] {
        match certificate_of(&drive, &of(name), None) {
            Err(Error::Refused(why)) => assert_eq!(why.code(), Code::NoCertificate),
            other => panic!("{name}: {other:?}"),
        }
    }
}

/// Another model's certificate, be the other ever so near.
#[test]
fn a_certificate_is_about_its_own_plant() {
    let cases = [
        (PLANTS[0], "'1/5'", "'1/5 + 1/1000000000000'"),
        (PLANTS[0], "s/20", "s/21"),
        (PLANTS[0], "0.3*T", "0.4*T"),
        (PLANTS[1], "'foh'", "'zoh'"),
        (PLANTS[2], "1/3", "2/5"),
        (PLANTS[2], "trailing", "leading"),
        (PLANTS[3], "double", "double-ends"),
        (PLANTS[7], "-5", "-6"),
        (PLANTS[8], "prewarp = 2", "prewarp = 3"),
    ];
    for (plant, from, to) in tried(cases, 4) {
        let text = loop_of(plant);
        let other = text.replace(from, to);
        assert!(other != text && check(&other, &emitted(&text), &LIMITS).is_err(), "{plant}: {to}");
    }
}

/// In another region; and a box of the whole disc is none of a smaller one.
#[test]
fn boxes_in_smaller_discs_are_certified() {
    let text = loop_of(PLANTS[7]);
    let certificate = certificate_of(&text, &request(&text), Some(Region::disc(number("19/20")).unwrap())).unwrap();
    assert!(certificate.contains("jurist/certificate/8"));
    accept(&text, &certificate);
    reject(&text, &with(&certificate, r#""radius": "19/20""#, r#""radius": "9/10""#), Step::Characteristic);
}

#[test]
fn the_safe_range_of_one_parameter_is_certified_with_both_ends() {
    let text = loop_of(PLANTS[7]);
    let asked = ToleranceRequest::new([("b", "1/10".parse().unwrap())]).gap(number("1/1000")).limit("a");
    let certificate = certificate_of(&text, &asked, None).unwrap();
    accept(&text, &certificate);
    assert!(certificate.contains(r#""limit": "a""#) && has_beyond(&certificate));
    assert!(is_true(&text, &json(&certificate)), "{certificate}");
    reject(&text, &with(&certificate, r#""limit": "a""#, r#""limit": "b""#), Step::Stable);
}

/// Not every point of the box is stable: the certificate is that of a smaller box with a point of the box beyond.
#[test]
fn a_box_that_is_not_stable_has_the_certificate_of_what_is_stable_in_it() {
    let text = loop_of(PLANTS[2]).replace("tolerance = '20%'", "tolerance = 500");
    let certificate = emitted(&text);
    accept(&text, &certificate);
    assert!(has_beyond(&certificate) && is_true(&text, &json(&certificate)));
    let Some(Json::Text(factor)) = json(&certificate).get("statement").unwrap().get("factor").cloned() else {
        panic!()
    };
    assert!(number(&factor) < number("1"));
    // The whole of it.
    reject(&text, &with(&certificate, &format!(r#""factor": "{factor}""#), r#""factor": "1""#), Step::Factors);
}

/// Boxes that are wider than the truth by a little, all other parts as they are.
#[test]
#[ignore = "long: CI runs it"]
fn boxes_wider_than_the_truth_are_rejected() {
    let mut seen = 0;
    for plant in tried(PLANTS, 2) {
        let text = loop_of(plant);
        let request = request(&text);
        let answer = read(&text).ask().tolerance(&request, &Budget::unlimited()).unwrap();
        let Some(found) = &answer.value().factor else { continue };
        let (Some(upper), Ok(certificate)) = (&found.upper, answer.certificate(&Budget::unlimited())) else { continue };
        for share in ["1", "1000001/1000000", "11/10", "2", "1000"] {
            let wider = upper * &number(share);
            let lie =
                with(&certificate, &format!(r#""factor": "{}""#, found.lower), &format!(r#""factor": "{wider}""#));
            assert!(check(&text, &lie, &LIMITS).is_err(), "{share}\n{text}\n{lie}");
            seen += 1;
        }
    }
    assert!(seen >= 20 * count(1, 2), "{seen}");
}

/// Changes of one value each: what both checkers accept is true.
#[test]
#[ignore = "long: CI runs it"]
fn changed_certificates_are_rejected_or_true() {
    for (plant, every, least) in [(PLANTS[2], 1, 250), (PLANTS[0], 5, 150), (PLANTS[8], 3, 100)] {
        let text = loop_of(plant);
        let less = count(4, 1);
        reject_or_find_true(&text, &emitted(&text), every * less, least / less, |json| is_true(&text, json));
    }
    reject_or_find_true(&by_hand_model(), BY_HAND, 1, 150, |json| is_true(&by_hand_model(), json));
}

/// `z - X + K (1 - X)`, `X = exp(-1)`, for K from 0 to 2, by hand: stable up to `(1 + X)/(1 - X)`, or 2.1639534...
const BY_HAND: &str = r#"{
    "schema": "jurist/certificate/8",
    "statement": {"kind": "tolerance", "time": "discrete", "set": {}, "region": {"radius": "1"},
        "tolerances": [{"name": "K", "nominal": "1", "between": ["0", "2"]}], "factor": "1", "limit": null,
        "beyond": [{"factor": "2", "point": ["3"], "degree": 1, "inside": 0, "on": 0, "outside": 1, "infinite": 0}]},
    "bits": 128,
    "symbols": [{"exp": "-1"}],
    "modes": [["1"]],
    "characteristic": [[["1", 1], ["-1", 0, 1], ["-1", 1, 1]], [["1"]]],
    "factors": [{"polynomial": [["1"], ["1", 1]], "tree": "+"},
        {"polynomial": [["1"], ["-1", 1], ["1", 0, 1], ["1", 1, 1]], "tree": "s0,++"}],
    "pair": {"v0": "1", "weight": "1", "tree": "s0,l1,0;l1,0;"}
}"#;

fn by_hand_model() -> String {
    "time = 'discrete'\nsample_time = 1\nparameters.K = {}\n[[block]]\ninput = '-K*y'\noutput = 'y'\ntransfer = '1/(s + 1)'\ndiscretize = 'zoh'\n[loop]\n".to_owned()
}

#[test]
fn a_certificate_by_hand_is_accepted_and_lies_about_it_are_not() {
    let model = &by_hand_model();
    accept(model, BY_HAND);
    let beyond = r#"{"factor": "2", "point": ["3"], "degree": 1, "inside": 0, "on": 0, "outside": 1, "infinite": 0}"#;
    let factor = r#""polynomial": [["1"], ["1", 1]], "tree": "+""#;
    for (from, to) in [
        // A root at 1 by an identity: K = -1.
        (beyond, r#"{"factor": "2", "point": ["-1"], "degree": 1, "inside": 0, "on": 1, "outside": 0, "infinite": 0}"#),
        (beyond, ""),
        // Factors in which symbols alone are a factor: (1 - X)(K + 1), and the negative of it.
        (factor, r#""polynomial": [["1"], ["1", 1], ["-1", 0, 1], ["-1", 1, 1]], "tree": "+""#),
        (factor, r#""polynomial": [["-1"], ["-1", 1], ["1", 0, 1], ["1", 1, 1]], "tree": "-""#),
        (r#""bits": 128"#, r#""bits": 64"#),
        (r#"{"exp": "-1"}"#, r#"{"exp": "-1"}, {"exp": "-1/2"}"#),
        ("s0,l1,0;l1,0;", "a0:9,0,1,0;"),
    ] {
        accept(model, &with(BY_HAND, from, to));
    }
    for (step, from, to) in [
        (Step::Format, "certificate/8", "certificate/99"),
        (Step::Format, "certificate/8", "certificate/4"),
        (Step::Statement, "certificate/8", "certificate/2"),
        (Step::Statement, "certificate/8", "certificate/5"),
        (Step::Format, r#""bits": 128"#, r#""bits": 32"#),
        (Step::Format, r#""bits": 128"#, r#""bits": 100000"#),
        (Step::Format, r#""bits": 128,"#, ""),
        (Step::Model, r#"{"exp": "-1"}"#, r#"{"exp": "-2"}"#),
        (Step::Model, r#"{"exp": "-1"}"#, ""),
        (Step::Characteristic, r#"{"exp": "-1"}"#, r#"{"exp": "-1/2"}"#),
        (Step::Characteristic, r#"{"exp": "-1"}"#, r#"{"exp": "1"}"#),
        (Step::Characteristic, r#"{"exp": "-1"}"#, r#"{"exp": "-1/2"}, {"exp": "-1"}"#),
        (Step::Model, r#""modes": [["1"]]"#, r#""modes": [["2"]]"#),
        (Step::Statement, r#""time": "discrete""#, r#""time": "continuous""#),
        (Step::Statement, r#""name": "K", "nominal": "1""#, r#""name": "K", "nominal": "3""#),
        (Step::Characteristic, r#"["-1", 0, 1]"#, r#"["-1", 0, 2]"#),
        (Step::Characteristic, r#"["-1", 0, 1]"#, r#"["-1", 0, 0, 1]"#),
        (Step::Factors, factor, r#""polynomial": [["1"], ["1", 1]], "tree": "-""#),
        (Step::Factors, factor, r#""polynomial": [["1"], ["-1", 0, 1]], "tree": "+""#),
        (Step::Factors, "s0,++", "s1,++"),
        (Step::Factors, r#"["1", 0, 1], ["1", 1, 1]], "tree""#, r#"["1", 0, 1], ["2", 1, 1]], "tree""#),
        (Step::Boundary, "s0,l1,0;l1,0;", "s1,l1,0;l1,0;"),
        (Step::Boundary, "s0,l1,0;l1,0;", "s0,l1,0;l-1,0;"),
        (Step::Boundary, "s0,l1,0;l1,0;", "s0,l1,-9;l1,0;"),
        (Step::Boundary, "s0,l1,0;l1,0;", "a1:9,0,1,0;"),
        (Step::Boundary, "s0,l1,0;l1,0;", "a0:9,0,19,0;"),
        (Step::Stable, r#""point": ["3"]"#, r#""point": ["5/2"]"#),
        (Step::Stable, r#""point": ["3"]"#, r#""point": ["7/2"]"#),
        (Step::Stable, r#""inside": 0, "on": 0, "outside": 1"#, r#""inside": 1, "on": 0, "outside": 0"#),
        (Step::Factors, r#"["0", "2"]"#, r#"["0", "11/5"]"#),
        (Step::Factors, r#"["0", "2"]"#, r#"["-1", "2"]"#),
    ] {
        let lie = with(BY_HAND, from, to);
        // The point is right where it is in its box.
        if to.contains("5/2") {
            accept(model, &lie);
        } else {
            reject(model, &lie, step);
        }
    }
    // All is right but that the nominal point is not stable: K from 3 to 4.
    let outside = with(BY_HAND, r#""nominal": "1", "between": ["0", "2"]"#, r#""nominal": "3", "between": ["3", "4"]"#);
    reject(model, &with(&with(&outside, "s0,++", "s0,--"), beyond, ""), Step::Stable);
}

/// Up to the end itself, as far as the bits reach.
#[test]
fn an_end_is_certified_as_near_as_the_bits_tell() {
    let model = &by_hand_model();
    let digits = "216395341373865284877000401021802311709373860215079227253357411929608763478";
    let at = |digits: &str| format!(r#"["0", "{digits}/1{}"]"#, "0".repeat(digits.len() - 1));
    for (length, bits, is_seen) in [(15, 64, true), (30, 128, true), (30, 64, false), (70, 128, false), (70, 300, true)]
    {
        let (below, above) = (digits[..length].to_owned(), format!("{}9", &digits[..length - 1]));
        let with_bits = with(BY_HAND, r#""bits": 128"#, &format!(r#""bits": {bits}"#));
        let end = |digits: &str| with(&with_bits, r#"["0", "2"]"#, &at(digits));
        match is_seen {
            true => accept(model, &end(&below)),
            false => reject(model, &end(&below), Step::Factors),
        }
        reject(model, &end(&above), Step::Factors);
    }
}

/// What a divisor hides: the loop is undefined on a line through the box, or at a point beyond.
#[test]
fn divisors_must_not_vanish() {
    let beyond = r#"{"factor": "2", "point": ["3"], "degree": 1, "inside": 0, "on": 0, "outside": 1, "infinite": 0}"#;
    let undefined =
        r#"{"factor": "2", "point": ["5/2"], "degree": 1, "inside": 0, "on": 0, "outside": 0, "infinite": 0}"#;
    let known = |polynomial: &str, tree: &str| {
        let factor = format!(r#""factors": [{{"polynomial": {polynomial}, "tree": "{tree}"}}, "#);
        with(BY_HAND, r#""factors": ["#, &factor)
    };
    let outside = format!("constants.unused = '1/(2*K - 5)'\n{}", by_hand_model());
    reject(&outside, BY_HAND, Step::Factors);
    accept(&outside, &known(r#"[["-5"], ["2", 1]]"#, "-"));
    accept(&outside, &with(&known(r#"[["-5"], ["2", 1]]"#, "-"), beyond, undefined));
    reject(&by_hand_model(), &with(BY_HAND, beyond, undefined), Step::Stable);
    let inside = format!("constants.unused = '1/(2*K - 3)'\n{}", by_hand_model());
    reject(&inside, BY_HAND, Step::Factors);
    for tree in ["-", "+", "s0,-+", "s0,--", "s0,-s0,-+"] {
        reject(&inside, &known(r#"[["-3"], ["2", 1]]"#, tree), Step::Factors);
    }
}

/// A sampled loop without symbols may be written so, too; a continuous one has none.
#[test]
fn symbols_are_those_of_sampled_loops() {
    let rational = |time: &str| format!("time = '{time}'\nparameters.K = {{}}\nloop.characteristic = 'VAR + K/4'");
    let text = with(BY_HAND, r#"[{"exp": "-1"}]"#, "[]");
    let text = with(&text, r#"[[["1", 1], ["-1", 0, 1], ["-1", 1, 1]], [["1"]]]"#, r#"[[["1", 1]], [["4"]]]"#);
    let text = with(&text, r#"[["1"], ["1", 1]]"#, r#"[["4"], ["1", 1]]"#);
    let text = with(&text, r#"[["1"], ["-1", 1], ["1", 0, 1], ["1", 1, 1]]"#, r#"[["4"], ["-1", 1]]"#);
    let text = with(&text, r#"["3"]"#, r#"["4"]"#).replace(r#""factor": "2""#, r#""factor": "3""#);
    let text = with(&text, r#""on": 0, "outside": 1"#, r#""on": 1, "outside": 0"#);
    accept(&rational("discrete").replace("VAR", "z"), &text);
    let continuous = text.replace("discrete", "continuous").replace(r#""radius": "1""#, r#""decay": "0""#);
    reject(&rational("continuous").replace("VAR", "s"), &continuous, Step::Model);
}

/// The counted work of a check bounds long trees, many bits and high powers.
#[test]
#[ignore = "long: CI runs it"]
fn hostile_sizes_are_rejected_by_counted_work() {
    let model = &by_hand_model();
    let deep = "s0,".repeat(3_000);
    let power = r#"[["1", 4000, 4000], ["1"]]"#;
    for (from, to) in [
        ("s0,++", deep.as_str()),
        ("s0,l1,0;l1,0;", deep.as_str()),
        (r#"[["1"], ["1", 1]]"#, power),
        (r#"{"exp": "-1"}"#, r#"{"exp": "-1"}, {"exp": "1000000000"}"#),
        (r#"{"exp": "-1"}"#, r#"{"exp": "-1"}, {"solution": ["1", "1000000000", "7"], "time": "1000000", "index": 0}"#),
    ] {
        let lie = with(&with(BY_HAND, from, to), r#""bits": 128"#, r#""bits": 32768"#);
        // No clock decides: counted work or the format ends the check.
        match check(model, &lie, &Limits::within(Duration::from_secs(1 << 32))) {
            // Symbols that are not used are right; what takes long is refused.
            Ok(_) => assert!(from.contains("exp"), "{to:.40}"),
            Err(e) if to.contains("1000000000") => assert_eq!(e.step, Step::Work, "{e}"),
            Err(e) => assert_ne!(e.step, Step::Time, "{e}"),
        }
    }
}

#[test]
#[ignore = "long: CI runs it"]
fn the_program_certifies_every_rounding_of_the_drive_behind_a_hold() {
    let folder = std::env::temp_dir().join(format!("jurist-boxes-held-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let [every, file, other] =
        ["e.toml", "e.json", "other.toml"].map(|name| folder.join(name).to_str().unwrap().to_owned());
    let drive = path("examples/drive-hold.toml").to_str().unwrap().to_owned();
    let shipped = jurist(&["ship", &drive, "--block", "speed controller", "--format", "Q4.14", "--every", &every]);
    assert_eq!(shipped.status, 0, "{}", shipped.stderr);
    let run = jurist(&["tolerance", &every, "--certificate", &file]);
    assert_eq!(run.status, 0, "{}", run.stderr);
    let proved = jurist(&["verify", &every, &file, "--timeout", "inf"]);
    assert_eq!(proved.status, 0, "{}", proved.stderr);
    assert!(proved.stdout.contains("the loop is stable; these are the tolerances times"), "{}", proved.stdout);
    let text = std::fs::read_to_string(&every).unwrap();
    accept(&text, &std::fs::read_to_string(&file).unwrap());
    std::fs::write(&other, with(&text, "K_ii = 500", "K_ii = 501")).unwrap();
    assert_eq!(jurist(&["verify", &other, &file]).status, 4);
    std::fs::remove_dir_all(&folder).unwrap();
}
