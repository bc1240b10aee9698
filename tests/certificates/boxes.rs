//! Certificates of boxes of tolerances: both checkers accept what the engine writes and nothing that is wrong.

use crate::helpers::certificates::checkers::{accept, python, reject, reject_or_find_true};
use crate::helpers::certificates::with;
use crate::helpers::model::{example_text, path, read};
use crate::helpers::number::number;
use crate::helpers::program::jurist;
use crate::helpers::random::Random;
use jurist::Ask;
use jurist::Certificate;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_check::format::Json;
use jurist_check::{Limits, Step, check};
use jurist_engine::answer::{ToleranceRequest, Verdict};
use jurist_engine::error::{Code, Error};
use jurist_engine::problem::Region;
use std::time::Duration;

/// No test may fail because the machine is busy.
const LIMITS: Limits = Limits::within(Duration::MAX);

fn certificate_of(text: &str, request: &ToleranceRequest, region: Option<Region>) -> Result<String, Error> {
    let (model, budget) = (read(text), Budget::unlimited());
    let question = region.into_iter().fold(model.ask(), |question, region| question.within(region));
    question.tolerance(request, &budget).unwrap_or_else(|e| panic!("{e}\n{text}")).certificate(&budget)
}

/// With the tolerances in the model, the bracket a thousandth wide.
fn emitted(text: &str) -> String {
    let request = ToleranceRequest::of_model(&read(text)).gap(number("1/1000"));
    certificate_of(text, &request, None).unwrap()
}

fn twenty_percent(names: &str) -> ToleranceRequest {
    ToleranceRequest::new(names.split(' ').map(|name| (name, "20%".parse().unwrap()))).gap(number("1/1000"))
}

fn model(time: &str, parameters: &str, characteristic: &str) -> String {
    format!("time = '{time}'\n[parameters]\n{parameters}\n[loop]\ncharacteristic = '{characteristic}'")
}

/// `s^3 + (a + 3) s^2 + b s + 1` with a divisor.
fn small() -> String {
    let parameters = "a = { nominal = 2, tolerance = 1 }\nb = { nominal = 2, tolerance = 1 }\nc = { nominal = 3, tolerance = '10%' }";
    model("continuous", parameters, "s^3 + (a + 3)*s^2 + b*s + a*b/c")
}

/// An end of a circle: an interval of one parameter in discrete time.
fn sampled() -> String {
    model("discrete", "k = { nominal = '1/2', tolerance = '1/10' }\nd = 3", "z^2 - z*k + (1 - k)/d")
}

/// The boxes that a certificate speaks of: the claim at the factor and the point beyond are what the question for one point says.
pub fn is_true(text: &str, json: &Json) -> bool {
    let get = |json: &Json, key: &str| json.get(key).cloned().unwrap();
    let number = |json: &Json| match json {
        Json::Text(text) => number(text),
        _ => panic!("a number"),
    };
    let items = |json: Json| match json {
        Json::List(items) => items,
        _ => panic!("a list"),
    };
    let statement = get(json, "statement");
    let factor = number(&get(&statement, "factor"));
    let (mut names, mut sides) = (Vec::new(), Vec::new());
    for tolerance in items(get(&statement, "tolerances")) {
        let Json::Text(name) = get(&tolerance, "name") else { panic!("a name") };
        names.push(name);
        let nominal = number(&get(&tolerance, "nominal"));
        let ends = items(get(&tolerance, "between"));
        sides.push([&ends[0], &ends[1]].map(|end| &nominal + &(&factor * &(&number(end) - &nominal))));
    }
    let loaded = read(text);
    let mut question = loaded.ask();
    let Json::Object(set) = get(&statement, "set") else { panic!("values") };
    question = question.set_all(set.iter().map(|(name, value)| (name.clone(), number(value))));
    let region = get(&statement, "region");
    question = match (region.get("radius"), region.get("decay")) {
        (Some(radius), _) => question.within(Region::disc(number(radius)).unwrap()),
        (_, Some(decay)) => question.within(Region::half_plane(number(decay))),
        _ => question,
    };
    let verdict = |point: Vec<Rational>| {
        let question = question.clone().set_all(names.iter().cloned().zip(point));
        question.verdict(&Budget::unlimited()).unwrap().value().verdict
    };
    let stable = (0..1usize << sides.len()).all(|mask| {
        let corner = sides.iter().enumerate().map(|(i, side)| side[mask >> i & 1].clone()).collect();
        verdict(corner) == Verdict::Stable
    });
    let beyond = get(&statement, "beyond");
    let unstable = |point: Json| verdict(items(get(&point, "point")).iter().map(number).collect()) != Verdict::Stable;
    stable && items(beyond).into_iter().all(unstable)
}

#[test]
#[ignore = "long: CI runs it"]
fn boxes_of_every_form_of_loop_are_certified() {
    let drive = example_text("drive");
    let blocks = example_text("drive-blocks");
    for (text, names) in [
        (&drive, "R_a L_a J B_v K_a k_1 k_2 E_sw"),
        (&drive, "T K_pwm L_a"),
        (&blocks, "R_a L_a K_pi K_ps"),
        (&example_text("dc-servo"), "R L J"),
        (&example_text("lcl-active-damping"), "L_1 C"),
    ] {
        let loaded = read(text);
        let known = |name: &&str| {
            let parameter = loaded.parameters().iter().any(|p| p.name == **name && p.nominal.is_some());
            parameter || loaded.constants().iter().any(|c| c.name == **name && c.number.is_some())
        };
        let names: Vec<&str> = names.split(' ').filter(known).collect();
        if names.is_empty() {
            continue;
        }
        let certificate = certificate_of(text, &twenty_percent(&names.join(" ")), None).unwrap();
        assert_eq!(check(text, &certificate, &LIMITS).unwrap().kind, "tolerance");
        accept(text, &certificate);
        assert!(is_true(text, &Json::parse(&certificate).unwrap()), "{certificate}");
    }
    for name in ["de-gaston-safonov", "unstable-disc"] {
        accept(&example_text(name), &emitted(&example_text(name)));
    }
}

/// Where the polynomial itself vanishes no root can be counted, also where its degree is 0 everywhere: the point is not stable all the same.
#[test]
fn a_point_at_which_the_polynomial_vanishes_is_beyond() {
    let tolerance = "K = { nominal = 2, tolerance = '20%' }";
    for (time, characteristic) in [("discrete", "K - 1"), ("continuous", "K - 1"), ("continuous", "(K - 1)*(s + 3)")] {
        let text = model(time, tolerance, characteristic);
        accept(&text, &emitted(&text));
    }
    // A constant other than zero is stable.
    let text = model("discrete", tolerance, "K - 1");
    let wrong = emitted(&text).replace("\"point\": [\"1\"]", "\"point\": [\"3/2\"]");
    reject(&text, &wrong, Step::Stable);
}

#[test]
fn boxes_in_other_regions_are_certified() {
    let request = |text: &str| ToleranceRequest::of_model(&read(text));
    let (small, sampled) = (small(), sampled());
    let slow = certificate_of(&small, &request(&small), Some(Region::half_plane(number("1/50")))).unwrap();
    accept(&small, &slow);
    let narrow = certificate_of(&sampled, &request(&sampled), Some(Region::disc(number("9/10")).unwrap())).unwrap();
    accept(&sampled, &narrow);
    // A box of the one is none of the other.
    reject(&small, &slow.replace("\"decay\": \"1/50\"", "\"decay\": \"3/50\""), Step::Characteristic);
    reject(&sampled, &narrow.replace("\"radius\": \"9/10\"", "\"radius\": \"1\""), Step::Characteristic);
}

#[test]
fn boxes_of_generated_loops_are_certified() {
    let mut random = Random::new(5);
    let mut boxes = 0;
    for time in ["continuous", "discrete"] {
        for _ in 0..12 {
            let mut number = || random.below(7) as i64 - 3;
            let [a, b, c, d, e] = [number(), number(), number(), number(), number()];
            let z = if time == "discrete" { "z" } else { "s" };
            let characteristic = format!(
                "{z}^3 + ({a}*p*q + {b}/4 + q)*{z}^2 + ({c}*p^2 + r + 1)/(r + 7)*{z} + (p*q*r + {d}*q^2)/9 + {e}/20"
            );
            let parameters = ["p", "q", "r"].map(|name| format!("{name} = {{ nominal = '1/3', tolerance = '15%' }}\n"));
            let text = model(time, &parameters.concat(), &characteristic);
            let certificate = emitted(&text);
            let proved = check(&text, &certificate, &LIMITS).unwrap_or_else(|e| panic!("{e}\n{text}\n{certificate}"));
            if let Some(Err(e)) = python(&text, &certificate) {
                panic!("Python: {e}\n{text}\n{certificate}");
            }
            if proved.kind == "tolerance" {
                boxes += 1;
                assert!(is_true(&text, &Json::parse(&certificate).unwrap()), "{text}\n{certificate}");
            } else {
                assert_ne!(read(&text).ask().verdict(&Budget::unlimited()).unwrap().value().verdict, Verdict::Stable);
            }
        }
    }
    assert!(boxes >= 4, "{boxes} boxes");
}

/// The certificate of the safe range of one parameter: one box, and a point beyond each end with the others in their tolerances.
#[test]
fn the_safe_range_of_one_parameter_is_certified_with_both_ends() {
    let (drive, small) = (example_text("drive"), small());
    let asked = [
        (&drive, twenty_percent("L_a k_1 E_sw").limit("K_pwm")),
        (&small, ToleranceRequest::new([("b", "1".parse().unwrap()), ("c", "10%".parse().unwrap())]).limit("a")),
    ];
    for (text, request) in asked {
        let name = request.limit.clone().unwrap();
        let answer = read(text).ask().tolerance(&request, &Budget::unlimited()).unwrap();
        let certificate = answer.certificate(&Budget::unlimited()).unwrap();
        accept(text, &certificate);
        let json = Json::parse(&certificate).unwrap();
        let statement = json.get("statement").unwrap();
        assert_eq!(statement.get("limit"), Some(&Json::Text(name.clone())));
        let Some(Json::List(beyond)) = statement.get("beyond") else { panic!("points") };
        let [Some(lower), Some(upper)] = &answer.value().limit.as_ref().unwrap().sides else { panic!("both sides") };
        let known = [lower, upper].iter().filter(|side| side.unsafe_at.is_some()).count();
        assert!(beyond.len() == known && known > 0, "{} of {known}", beyond.len());
        assert!(is_true(text, &json), "{certificate}");
        // Another parameter's range: its tolerance alone would have to hold the points.
        let other = answer.problem().free().iter().find(|free| free.name != name).unwrap();
        let lie = with(&certificate, &format!("\"limit\": \"{name}\""), &format!("\"limit\": \"{}\"", other.name));
        reject(text, &lie, Step::Stable);
    }
}

#[test]
fn a_nominal_point_that_is_not_stable_has_the_certificate_of_its_verdict() {
    let text = model("continuous", "a = { nominal = -1, tolerance = 1 }", "s + a");
    assert_eq!(check(&text, &emitted(&text), &LIMITS).unwrap().kind, "verdict");
}

#[test]
fn a_loop_with_exponentials_has_no_certificate_of_its_box_yet() {
    let request = ToleranceRequest::new([("K", "1%".parse().unwrap())]);
    let text = "time = 'discrete'\nparameters.K = 1\nloop.characteristic = 'z - exp(-1) + K/9'";
    match certificate_of(text, &request, None) {
        Err(Error::Refused(why)) => assert_eq!(why.code(), Code::NoCertificate),
        other => panic!("{other:?}"),
    }
}

/// Changes of one value each: what both checkers accept is true.
#[test]
fn changed_certificates_are_rejected_or_true() {
    for (text, least) in [(small(), 300), (sampled(), 150)] {
        reject_or_find_true(&text, &emitted(&text), 1, least, |json| is_true(&text, json));
    }
}

/// `s + a` for a from 1 to 3, by hand.
const BY_HAND: &str = r#"{
    "schema": "jurist/certificate/4",
    "statement": {"kind": "tolerance", "time": "continuous", "set": {"b": "0"}, "region": {"decay": "0"},
        "tolerances": [{"name": "a", "nominal": "2", "between": ["1", "3"]}], "factor": "1", "limit": null,
        "beyond": [{"factor": "2", "point": ["0"], "degree": 1, "inside": 0, "on": 1, "outside": 0, "infinite": 0}]},
    "characteristic": [[["1", 1]], [["1"]]],
    "factors": [{"polynomial": [["1", 1]], "tree": "s0,++"}],
    "pair": {"v0": "4", "weight": "1", "tree": "s0,l1,0;l1,1;"}
}"#;

const BY_HAND_MODEL: &str = "time = 'continuous'\nparameters = { a = {}, b = {} }\nloop.characteristic = 's + a + b'";

#[test]
fn a_certificate_by_hand_is_accepted_and_lies_about_it_are_not() {
    accept(BY_HAND_MODEL, BY_HAND);
    accept(
        BY_HAND_MODEL,
        &with(
            BY_HAND,
            r#""beyond": [{"factor": "2", "point": ["0"], "degree": 1, "inside": 0, "on": 1, "outside": 0, "infinite": 0}]"#,
            r#""beyond": []"#,
        ),
    );
    accept(BY_HAND_MODEL, &with(BY_HAND, r#""limit": null"#, r#""limit": "a""#));
    for (step, from, to) in [
        (Step::Format, "certificate/4", "certificate/99"),
        (Step::Statement, "certificate/4", "certificate/5"),
        (Step::Statement, "certificate/4", "certificate/3"),
        (Step::Statement, "certificate/4", "certificate/1"),
        (Step::Statement, r#""kind": "tolerance""#, r#""kind": "intervals""#),
        (Step::Statement, r#""kind": "tolerance""#, r#""kind": "verdict""#),
        (Step::Statement, r#""decay": "0""#, r#""decay": "parameter""#),
        (Step::Statement, r#"["1", "3"]"#, r#"["3", "1"]"#),
        (Step::Statement, r#"["1", "3"]"#, r#"["1"]"#),
        (Step::Statement, r#""nominal": "2""#, r#""nominal": "4""#),
        (Step::Statement, r#"[{"name": "a", "nominal": "2", "between": ["1", "3"]}]"#, "[]"),
        (Step::Statement, r#""factor": "1""#, r#""factor": "-1""#),
        (Step::Statement, r#""limit": null"#, r#""limit": "b""#),
        (Step::Statement, r#""limit": null"#, r#""limit": ["a"]"#),
        (Step::Statement, r#""beyond": ["#, r#""beyond": ["0", "#),
        (Step::Model, r#""name": "a""#, r#""name": "b""#),
        (Step::Model, r#""name": "a""#, r#""name": "c""#),
        (Step::Model, r#""set": {"b": "0"}"#, r#""set": {}"#),
        (Step::Model, r#""set": {"b": "0"}"#, r#""set": {"b": "0", "a": "2"}"#),
        (Step::Statement, r#""time": "continuous""#, r#""time": "discrete""#),
        (Step::Characteristic, r#""set": {"b": "0"}"#, r#""set": {"b": "1/2"}"#),
        (Step::Characteristic, r#"[[["1", 1]], [["1"]]]"#, r#"[[["1", 1]]]"#),
        (Step::Characteristic, r#"[[["1", 1]], [["1"]]]"#, r#"[[["2", 1]], [["1"]]]"#),
        (Step::Characteristic, r#"[[["1", 1]], [["1"]]]"#, r#"[[["1", 1]], [["1"], ["1", 1]]]"#),
        (Step::Characteristic, r#"[[["1", 1]], [["1"]]]"#, r#"[[["1", 2]], [["1", 1]]]"#),
        (Step::Characteristic, r#"[[["1", 1]], [["1"]]]"#, r#"[[["1", 1, 0]], [["1"]]]"#),
        (Step::Characteristic, r#"[[["1", 1]], [["1"]]]"#, "[[], []]"),
        (Step::Factors, r#"["1", "3"]"#, r#"["0", "3"]"#),
        (Step::Factors, r#""factor": "1""#, r#""factor": "2""#),
        (Step::Factors, r#"[{"polynomial": [["1", 1]], "tree": "s0,++"}]"#, "[]"),
        (Step::Factors, r#""polynomial": [["1", 1]]"#, r#""polynomial": [["1", 1], ["1"]]"#),
        (Step::Factors, r#""polynomial": [["1", 1]]"#, r#""polynomial": [["1"]]"#),
        (Step::Factors, "s0,++", "s0,+"),
        (Step::Factors, "s0,++", "s0,+++"),
        (Step::Factors, "s0,++", "s0,+-"),
        (Step::Factors, "s0,++", "s1,++"),
        (Step::Boundary, r#""v0": "4""#, r#""v0": "0""#),
        (Step::Boundary, r#""weight": "1""#, r#""weight": "-1""#),
        (Step::Boundary, "s0,l1,0;l1,1;", "s0,l1,0;"),
        (Step::Boundary, "s0,l1,0;l1,1;", "s0,l-1,0;l1,1;"),
        (Step::Boundary, "s0,l1,0;l1,1;", "s0,l0,0;l1,1;"),
        (Step::Boundary, "s0,l1,0;l1,1;", "c"),
        (Step::Stable, r#""point": ["0"]"#, r#""point": ["1"]"#),
        (Step::Stable, r#""point": ["0"]"#, r#""point": ["-1"]"#),
        (Step::Stable, r#""point": ["0"]"#, r#""point": ["0", "0"]"#),
        (Step::Stable, r#""on": 1"#, r#""on": 0"#),
    ] {
        reject(BY_HAND_MODEL, &with(BY_HAND, from, to), step);
    }
    // A point within that is stable.
    let within = with(
        &with(BY_HAND, r#""point": ["0"]"#, r#""point": ["1"]"#),
        r#""inside": 0, "on": 1"#,
        r#""inside": 1, "on": 0"#,
    );
    reject(BY_HAND_MODEL, &within, Step::Stable);
    // Everything but the nominal point is right for another model: a - s is never stable.
    let mirrored = BY_HAND_MODEL.replace("s + a + b", "s - a + b");
    let claim = BY_HAND.replace(r#"[[["1", 1]], [["1"]]]"#, r#"[[["-1", 1]], [["1"]]]"#);
    let claim = claim.replace("s0,l1,0;l1,1;", "s0,l-1,0;l-1,1;");
    reject(&mirrored, &claim, Step::Stable);
}

/// What a divisor hides: the loop is undefined on a line through the box, and nothing else is wrong.
#[test]
fn a_divisor_is_a_factor_that_must_not_vanish() {
    let model = "time = 'continuous'\nparameters = { a = {}, b = {} }\nloop.characteristic = 's + a + 0*b/(a - b)'";
    let with_zero = BY_HAND.replace(r#""b": "0""#, r#""b": "5/2""#);
    reject(model, &with_zero, Step::Factors);
    let known = r#"{"polynomial": [["1", 1]], "tree": "s0,++"}, {"polynomial": [["2", 1], ["-5"]], "tree": "s0,-+"}"#;
    reject(model, &with_zero.replace(r#"{"polynomial": [["1", 1]], "tree": "s0,++"}"#, known), Step::Factors);
    // With b = 4 the line is outside.
    let elsewhere = BY_HAND.replace(r#""b": "0""#, r#""b": "4""#);
    let known = r#"{"polynomial": [["1", 1]], "tree": "s0,++"}, {"polynomial": [["1", 1], ["-4"]], "tree": "-"}"#;
    accept(model, &elsewhere.replace(r#"{"polynomial": [["1", 1]], "tree": "s0,++"}"#, known));
}

#[test]
fn the_program_writes_and_verifies_certificates_of_boxes() {
    let folder = std::env::temp_dir().join(format!("jurist-boxes-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let file = folder.join("box.json").to_str().unwrap().to_owned();
    let drive = path("examples/drive.toml").to_str().unwrap().to_owned();
    let run = jurist(&["tolerance", &drive, "--tol", "R_a,L_a,J=20%", "--digits", "3", "--certificate", &file]);
    assert_eq!((run.status, run.stderr), (0, format!("wrote {file}\n")));
    let proved = jurist(&["verify", &drive, &file, "--timeout", "inf"]);
    assert_eq!(proved.status, 0, "{}", proved.stderr);
    assert!(proved.stdout.contains("the loop is stable; these are the tolerances times"), "{}", proved.stdout);
    // Another model (the box replaces the numbers of its own parameters), a wider box, a leaf of another vector.
    let other = folder.join("other.toml").to_str().unwrap().to_owned();
    std::fs::write(&other, example_text("drive").replace("K_a  = 0.55", "K_a  = 0.56")).unwrap();
    assert_eq!(jurist(&["verify", &other, &file]).status, 4);
    let text = std::fs::read_to_string(&file).unwrap();
    let tree = text.rfind("\"tree\": \"").unwrap() + 9;
    let turned = format!("{}{}", &text[..tree], text[tree..].replacen('l', "l-", 1).replace("--", ""));
    let forged = folder.join("forged.json").to_str().unwrap().to_owned();
    for wrong in [turned, text.replacen("\"factor\": \"", "\"factor\": \"1", 1)] {
        assert_ne!(wrong, text);
        std::fs::write(&forged, wrong).unwrap();
        assert_eq!(jurist(&["verify", &drive, &forged]).status, 4);
    }
    std::fs::remove_dir_all(&folder).unwrap();
}
