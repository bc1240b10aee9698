//! Certificates of maps of two parameters: both checkers accept what the engine writes and nothing that is wrong.

use crate::helpers::certificates::MODELS;
use crate::helpers::certificates::checkers::{accept, reject, reject_or_find_true};
use crate::helpers::model::{example_text, path, read};
use crate::helpers::number::number;
use crate::helpers::program::jurist;
use crate::helpers::random::Random;
use crate::helpers::thorough::{count, is_tried, tried};
use jurist::Ask;
use jurist::Certificate;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_check::format::Json;
use jurist_check::{Limits, Step, check};
use jurist_engine::answer::{Answer, Map};
use jurist_engine::error::Error;
use jurist_engine::problem::{Question, Region};
use jurist_engine::stability::Range;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

/// No test may fail because the machine is busy.
const LIMITS: Limits = Limits::within(Duration::MAX);

fn map_of(question: Question) -> Answer<Map> {
    question.map(6, &Budget::unlimited()).unwrap_or_else(|e| panic!("{e}"))
}

/// The certificate of a map over the model's own domains.
fn emitted(text: &str, x: &str, y: &str) -> String {
    map_of(read(text).ask().free(x).free(y)).certificate(&Budget::unlimited()).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

fn model(time: &str, parameters: &str, characteristic: &str) -> String {
    format!("time = '{time}'\nparameters = {{ {parameters} }}\nloop.characteristic = '{characteristic}'")
}

/// A model in `a` and `b` without ends.
fn plain(time: &str, characteristic: &str) -> String {
    model(time, "a = {}, b = {}", characteristic)
}

fn regions_of(certificate: &str) -> Vec<Vec<(usize, usize)>> {
    let json = Json::parse(certificate).unwrap();
    cells(json.get("statement").and_then(|s| s.get("regions")).unwrap())
}

fn items(json: &Json) -> &[Json] {
    let Json::List(items) = json else { panic!("a list") };
    items
}

fn cells(json: &Json) -> Vec<Vec<(usize, usize)>> {
    let count = |json: &Json| match json {
        Json::Count(n) => *n as usize,
        _ => panic!("a count"),
    };
    let cell = |json: &Json| (count(&items(json)[0]), count(&items(json)[1]));
    items(json).iter().map(|region| items(region).iter().map(cell).collect()).collect()
}

#[test]
#[ignore = "long: CI runs it"]
fn maps_of_examples_are_certified_in_either_order() {
    let examples = [
        ("drive", "T", "K_pwm"),
        ("drive-blocks", "T", "K_pwm"),
        ("de-gaston-safonov", "p1", "p2"),
        ("digital-pll", "K_p", "K_i"),
        ("buck-converter", "K_p", "V_g"),
        ("acc-benchmark", "k", "m_1"),
        ("heavy-ball", "alpha", "beta"),
        ("lcl-active-damping", "k", "c"),
        ("lcl-grid-current", "K_p", "K_ad"),
        ("unstable-disc", "q1", "q2"),
        ("vicino-tesi-milanese", "q1", "q3"),
    ];
    for (name, x, y) in tried(examples, 2) {
        let text = example_text(name);
        for (x, y) in [(x, y), (y, x)] {
            let map = map_of(read(&text).ask().free(x).free(y));
            let certificate = map.certificate(&Budget::unlimited()).unwrap();
            accept(&text, &certificate);
            assert_eq!(regions_of(&certificate).len(), map.value().decomposition.regions.len(), "{name}");
        }
    }
}

/// Loops with every special case: curves that are lines of either axis, that contain an edge of the domain, of several multiplicities,
/// with poles and lost degrees; no curve at all; several regions; walls that are exact.
const SPECIAL: &[(&str, &str, &str)] = &[
    ("discrete", "a = {}, b = {}", "z^2 + a*z + b"),
    ("discrete", "a = {}, b = {}", "z + a*b"),
    ("discrete", "a = {}, b = {}", "z + a^2 - 2 + 0*b"),
    ("discrete", "a = {}, b = {}", "z + b^2 - 2 + 0*a"),
    ("discrete", "a = {}, b = {}", "z + (a^2 - 2)*(b^2 - 3)/4"),
    ("discrete", "a = {}, b = {}", "z^2 + 1/4 + 0*a*b"),
    ("discrete", "a = { min = 0 }, b = { min = 0 }", "z^2 + a*z + b - b^2*a"),
    ("discrete", "a = { min = -1, max = 1 }, b = { min = -1, max = '1/2' }", "z^3 + a*z^2 + b*z + 1/3"),
    ("discrete", "a = {}, b = {}", "(z - a)*(z + a)*(z^2 + b)"),
    ("discrete", "a = {}, b = {}", "z^2 + 1 - (a^2 + b^2)^2"),
    ("discrete", "a = {}, b = {}", "z + a/2*(b - 1)/(b - 1) + 0/(a^2 + b^2 - 2)"),
    ("discrete", "a = {}, b = {}", "(a - b)*z^2 + z + b/2"),
    ("discrete", "a = {}, b = {}", "(a - b)*(z + a)"),
    ("discrete", "a = {}, b = {}", "(a - 1)*b"),
    ("continuous", "a = {}, b = {}", "s^3 + a*s^2 + b*s + 1"),
    ("continuous", "a = { min = 0 }, b = {}", "a*s^2 + b*s + (a - b)^2"),
    ("continuous", "a = {}, b = {}", "s^2 + (a^2 + b^2 - 1)*s + (a - 2*b)^2 + 1/9"),
    ("continuous", "a = {}, b = {}", "s + (a^2 + b^2 - 4)*(a^2 + b^2 - 1)"),
    ("continuous", "a = {}, b = {}", "s + b^3 - a^2"),
    ("continuous", "a = {}, b = {}", "s + (b^2 - a^2)*(b - 2*a)"),
    // Never stable.
    ("discrete", "a = {}, b = {}", "(z - 1)*(z + a*b)"),
    ("discrete", "a = {}, b = {}", "(z^2 - z/2 + 1)*(z + a + b)"),
    ("discrete", "a = {}, b = {}", "0*a*b"),
    ("continuous", "a = {}, b = {}", "(s^2 + a)*(s^2 + b)"),
];

#[test]
fn maps_of_special_loops_are_certified() {
    for (number, (time, parameters, characteristic)) in SPECIAL.iter().enumerate() {
        let text = model(time, parameters, characteristic);
        // By default each in one order.
        for (_, (x, y)) in [("a", "b"), ("b", "a")].into_iter().enumerate().filter(|(i, _)| is_tried(number + i, 2)) {
            accept(&text, &emitted(&text, x, y));
        }
    }
}

#[test]
fn what_a_value_leaves_undefined_or_without_degree_is_certified() {
    let parameters = "a = {}, b = {}, c = {}";
    for characteristic in ["z + a*b/(c - 1)", "(c - 1)*z^2 + z + a*b"] {
        let text = model("discrete", parameters, characteristic);
        for (value, empty) in [("1", true), ("2", false)] {
            let question = read(&text).ask().set("c", number(value)).free("a").free("b");
            let certificate = map_of(question).certificate(&Budget::unlimited()).unwrap();
            accept(&text, &certificate);
            assert_eq!(regions_of(&certificate).is_empty(), empty, "{certificate}");
        }
    }
}

/// All forms of loops with two parameters among the models of one.
#[test]
fn maps_of_every_form_of_loop_are_certified() {
    let mut forms = 0;
    for (name, text, _) in MODELS {
        let parameters: Vec<String> = read(text).parameters().iter().map(|p| p.name.clone()).collect();
        if let [x, y] = parameters.as_slice() {
            forms += 1;
            let certificate = emitted(text, x, y);
            assert_eq!(
                check(text, &certificate, &LIMITS).map(|proved| proved.kind),
                Ok("map"),
                "{name}\n{certificate}"
            );
            accept(text, &certificate);
        }
    }
    assert!(forms >= 4, "{forms} forms");
}

#[test]
#[ignore = "long: CI runs it"]
fn maps_of_generated_loops_are_certified() {
    let mut random = Random::new(11);
    let mut several = 0;
    for time in ["continuous", "discrete"] {
        for _ in 0..count(3, 9) {
            let mut number = || random.below(7) as i64 - 3;
            let [a, b, c, d, e] = [number(), number(), number(), number(), number()];
            let z = if time == "discrete" { "z" } else { "s" };
            let text = model(
                time,
                "a = { min = -2, max = 3 }, b = {}",
                &format!(
                    "{z}^3 + ({a}*a + b/2 + 1)*{z}^2 + ({b}*a^2 - {c}*b + 1)/(a + 7)*{z} + (a*b + {d}*b^2)/9 + {e}/20"
                ),
            );
            let certificate = emitted(&text, "a", "b");
            accept(&text, &certificate);
            several += usize::from(regions_of(&certificate).len() > 1);
        }
    }
    assert!(several >= count(1, 2), "{several} maps of several regions");
}

#[test]
fn maps_of_other_regions_and_of_constants_are_certified() {
    let text = "time = 'discrete'\nconstants.c = '1/2'\nparameters = { a = {}, b = {} }\nloop.characteristic = 'z^2 + a*z + b*c'";
    let (budget, loaded) = (Budget::unlimited(), read(text));
    let narrow = loaded.ask().free("a").free("b").within(Region::disc(number("3/4")).unwrap());
    let certificate = map_of(narrow).certificate(&budget).unwrap();
    accept(text, &certificate);
    reject(text, &certificate.replace("\"radius\": \"3/4\"", "\"radius\": \"1\""), Step::Characteristic);
    let constant = map_of(loaded.ask().set("a", number("1/3")).free("c").free("b")).certificate(&budget).unwrap();
    accept(text, &constant);
    let fast = plain("continuous", "s^2 + a*s + b");
    let fast_map = map_of(read(&fast).ask().free("a").free("b").within(Region::half_plane(number("1/2"))));
    accept(&fast, &fast_map.certificate(&budget).unwrap());
}

/// Whether the regions of a certificate are what the engine says of its question: the same stable cells, and none joined that are not.
fn is_true(text: &str, json: &Json) -> bool {
    let Some(statement) = json.get("statement") else { return false };
    let word = |json: &Json| match json {
        Json::Text(text) => text.clone(),
        _ => panic!("a text"),
    };
    let get = |key: &str| statement.get(key).cloned().unwrap();
    let mut question = read(text).ask();
    let Json::Object(set) = get("set") else { panic!("values") };
    question = question.set_all(set.iter().map(|(name, value)| (name.clone(), number(&word(value)))));
    let region = get("region");
    question = match (region.get("radius"), region.get("decay")) {
        (Some(radius), _) => question.within(Region::disc(number(&word(radius))).unwrap()),
        (_, Some(decay)) => question.within(Region::half_plane(number(&word(decay)))),
        _ => return false,
    };
    let names = [word(&get("x")), word(&get("y"))];
    for (key, name) in ["x", "y"].iter().zip(&names) {
        let domain = get("domain").get(key).cloned().unwrap();
        let end = |key: &str| match domain.get(key) {
            Some(Json::Text(text)) => Some(number(text)),
            _ => None,
        };
        question = question.domain(name, Range::between(end("lower"), end("upper"))).free(name);
    }
    let own = map_of(question.clone());
    let claimed = cells(&get("regions"));
    // Every point that the certificate names has the verdict of its cell.
    for (i, strip) in items(json.get("strips").unwrap()).iter().enumerate() {
        let x = number(&word(strip.get("x").unwrap()));
        for (k, y) in items(strip.get("cells").unwrap()).iter().enumerate() {
            let y: Rational = number(&word(y));
            let at = read(text).ask().set_all(own.problem().set().to_vec()).within(own.problem().region().clone());
            let at = at.set(&names[0], x.clone()).set(&names[1], y);
            let verdict = at.verdict(&Budget::unlimited()).unwrap().value().verdict;
            let is_claimed = claimed.iter().flatten().any(|cell| *cell == (i, k));
            if is_claimed != (verdict == jurist_engine::answer::Verdict::Stable) {
                return false;
            }
        }
    }
    let map = &own.value().decomposition;
    if items(json.get("strips").unwrap()).len() != map.strips.len() {
        // More walls than there need be.
        return true;
    }
    let known = map.regions.iter().map(|r| &r.cells).collect::<Vec<_>>();
    claimed.iter().map(Vec::len).sum::<usize>() == known.iter().map(|cells| cells.len()).sum::<usize>()
        && claimed.iter().all(|region| known.iter().any(|own| region.iter().all(|cell| own.contains(cell))))
}

/// Changes of one value each: what both checkers accept is true.
/// Every third change: each kind of change has its turn, since a text has seven of them and a count two.
#[test]
fn changed_certificates_are_rejected_or_true() {
    let circle = plain("continuous", "s + (a^2 + b^2 - 1)*(a - 3)");
    for (text, least) in [(plain("discrete", "z^2 + a*z + b"), 266), (plain("discrete", "z + a*b"), 100), (circle, 133)]
    {
        reject_or_find_true(&text, &emitted(&text, "a", "b"), 3, least, |json| is_true(&text, json));
    }
}

#[test]
fn what_has_no_certificate_is_refused() {
    let refused = |text: &str, x: &str, y: &str| {
        let map = read(text).ask().free(x).free(y).map(6, &Budget::unlimited()).unwrap();
        match map.certificate(&Budget::unlimited()) {
            Err(Error::Refused(why)) => why.code().as_str(),
            other => panic!("{other:?}"),
        }
    };
    let required = format!("{}\n[require]\nphase_margin = 30", plain("discrete", "z + a*b"));
    assert_eq!(refused(&required, "a", "b"), "E-no-certificate");
    // z - 1 + a b: rational, but no checker computes exponentials of what is not a number.
    let held = "time = 'discrete'\nparameters = { a = {}, b = {} }\nloop.inputs = ['r']\n[[block]]\nname = 'C'\ninput = 'r - y'\n\
        output = 'u'\ngain = 'a'\n[[block]]\nname = 'P'\ninput = 'u'\noutput = 'y'\ntransfer = '1/s'\n\
        discretize = { method = 'zoh', T = 'b' }";
    assert_eq!(refused(held, "a", "b"), "E-no-certificate");
    let of_another = emitted(&plain("discrete", "z - 1 + a*b"), "a", "b");
    reject(held, &of_another, Step::Model);
    let budget = Budget::unlimited().cancelled_by(Arc::new(AtomicBool::new(true)));
    let map = map_of(read(&plain("discrete", "z^2 + a*z + b")).ask().free("a").free("b"));
    assert!(matches!(map.certificate(&budget), Err(Error::Stopped(_))));
}

#[test]
fn the_program_writes_and_verifies_certificates_of_maps() {
    let folder = std::env::temp_dir().join(format!("jurist-maps-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let file = folder.join("map.json").to_str().unwrap().to_owned();
    let drive = path("examples/drive.toml").to_str().unwrap().to_owned();
    let ask = ["map", &drive, "-x", "T", "-y", "K_pwm", "--certificate"];
    let run = jurist(&[&ask[..], &[&file]].concat());
    assert_eq!((run.status, run.stderr), (0, format!("wrote {file}\n")));
    let proved = jurist(&["verify", &drive, &file, "--timeout", "inf"]);
    assert_eq!(proved.status, 0, "{}", proved.stderr);
    assert!(proved.stdout.contains("exactly in 1 connected region: 3 cells for T from 0 to"), "{}", proved.stdout);
    let other = folder.join("other.toml").to_str().unwrap().to_owned();
    std::fs::write(&other, example_text("drive").replace("K_a  = 0.55", "K_a  = 0.56")).unwrap();
    assert_eq!(jurist(&["verify", &other, &file]).status, 4);
    // On standard output there is room for one of the two.
    let both = jurist(&[&ask[..], &["-"]].concat());
    assert_eq!(both.status, 2);
    assert!(both.stderr.contains("would both be written to standard output"), "{}", both.stderr);
    let answer = folder.join("map.txt").to_str().unwrap().to_owned();
    let piped = jurist(&[&ask[..], &["-", "-o", &answer]].concat());
    assert_eq!((piped.status, piped.stdout), (0, std::fs::read_to_string(&file).unwrap()));
    let same = jurist(&[&ask[..], &[&file, "-o", &file]].concat());
    assert_eq!(same.status, 2);
    // Kinds of maps without one.
    let slices = jurist(&[&ask[..], &[&file, "-z", "R_a=1..2:3"]].concat());
    assert_eq!(slices.status, 2);
    assert!(slices.stderr.contains("E-no-certificate"), "{}", slices.stderr);
    let margins = jurist(&[&ask[..], &[&file, "--phase-margin", "30", "--at", "K_pwm", "--method", "exact"]].concat());
    assert_eq!(margins.status, 2);
    assert!(margins.stderr.contains("E-no-certificate"), "{}", margins.stderr);
    std::fs::remove_dir_all(&folder).unwrap();
}
