//! Certificates of maps by boxes: both checkers accept what is written, and nothing that is wrong.

use crate::helpers::certificates::checkers::{PYTHON_EVERY, accept, python, reject};
use crate::helpers::certificates::{mutations, with};
use crate::helpers::model::{example_text, path, read};
use crate::helpers::number::number;
use crate::helpers::program::{jurist, jurist_with_input};
use crate::helpers::random::Random;
use crate::helpers::thorough::{count, tried};
use jurist::certified::certify_boxes;
use jurist::{Ask, BoxRequest, MapBoxes, MapMethod, MapOrBoxes};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_check::format::Json;
use jurist_check::{Limits, Step, check};
use jurist_engine::answer::{Answer, Verdict};
use jurist_engine::error::Error;
use jurist_engine::stability::Range;
use jurist_engine::stability::plane::boxes::BoxVerdict;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

/// No test may fail because the machine is busy.
const LIMITS: Limits = Limits::within(Duration::MAX);

/// A parameter and its ends.
pub(super) type Side<'a> = (&'a str, &'a str, &'a str);

fn boxes(text: &str, sides: [Side; 2], undecided: &str) -> Answer<MapBoxes> {
    let range = |(_, low, high): Side| Range::between(Some(number(low)), Some(number(high)));
    let request = BoxRequest::new(sides.map(range), number(undecided));
    let problem = read(text).ask().free(sides[0].0).free(sides[1].0).plane_problem().unwrap();
    match problem.map_by(MapMethod::Boxes, &request, 6, &Budget::unlimited()).unwrap() {
        MapOrBoxes::Boxes(found) => *found,
        MapOrBoxes::Exact(_) => panic!("boxes were asked for"),
    }
}

/// That a map is certified, at least this share of the window: both checkers accept it, and verdicts agree with it.
fn is_certified(text: &str, sides: [Side; 2], undecided: &str, least: &str) {
    assert!(certified(text, sides, undecided, least, 1) > 5, "{text}");
}

/// The same, with a point in one box of `every`; how many points.
pub(super) fn certified(text: &str, sides: [Side; 2], undecided: &str, least: &str, every: usize) -> usize {
    let (certificate, share) = emitted(text, sides, undecided);
    accept(text, &certificate);
    assert!(share > number(least), "{share}\n{text}");
    agree_with_verdicts(text, sides, &certificate, every)
}

/// The certificate, with the shares that it proves together.
pub(super) fn emitted(text: &str, sides: [Side; 2], undecided: &str) -> (String, Rational) {
    let found = certify_boxes(&boxes(text, sides, undecided), &Budget::unlimited());
    let found = found.unwrap_or_else(|e| panic!("{e}\n{text}"));
    (found.text, found.stable + found.unstable)
}

pub(super) fn plain(time: &str, characteristic: &str) -> String {
    format!("time = '{time}'\nparameters = {{ a = {{}}, b = {{}} }}\nloop.characteristic = '{characteristic}'")
}

pub(super) fn tree_of(certificate: &str) -> String {
    match Json::parse(certificate).unwrap().get("statement").and_then(|s| s.get("tree")) {
        Some(Json::Text(tree)) => tree.clone(),
        other => panic!("{other:?}"),
    }
}

/// The leaves of a tree in a window; `None` where it is none.
pub(super) fn leaves(tree: &str, window: [[Rational; 2]; 2]) -> Option<Vec<(char, [[Rational; 2]; 2])>> {
    let (mut out, mut stack) = (Vec::new(), vec![window]);
    for letter in tree.chars() {
        let cell = stack.pop()?;
        match letter {
            'x' | 'y' => {
                let axis = usize::from(letter == 'y');
                let middle = cell[axis][0].midpoint(&cell[axis][1]);
                let (mut low, mut high) = (cell.clone(), cell);
                (low[axis][1], high[axis][0]) = (middle.clone(), middle);
                stack.extend([high, low]);
            }
            _ => out.push((letter, cell)),
        }
    }
    stack.is_empty().then_some(out)
}

/// Whether what a statement says of its boxes is true at their corners and within.
pub(super) fn is_true(text: &str, json: &Json) -> bool {
    let Some(statement) = json.get("statement") else { return false };
    let word = |json: &Json| match json {
        Json::Text(text) => text.clone(),
        other => panic!("{other:?}"),
    };
    let window = ["x", "y"].map(|key| match statement.get("window").and_then(|w| w.get(key)) {
        Some(Json::List(ends)) => [number(&word(&ends[0])), number(&word(&ends[1]))],
        other => panic!("{other:?}"),
    });
    let names = ["x", "y"].map(|key| word(statement.get(key).unwrap()));
    let Some(Json::Object(region)) = statement.get("region") else { return false };
    let (time, bound) = (word(statement.get("time").unwrap()), number(&word(&region[0].1)));
    let model = read(text);
    let region = match time.as_str() {
        "discrete" => jurist::Region::disc(bound).unwrap(),
        _ => jurist::Region::half_plane(bound),
    };
    let tree = word(statement.get("tree").unwrap());
    leaves(&tree, window).is_some_and(|leaves| {
        leaves.into_iter().filter(|(letter, _)| *letter != '?').all(|(letter, [x, y])| {
            let points = [(0, 0), (3, 3), (1, 2), (0, 3)];
            let inner = |[low, high]: &[Rational; 2], k: i64| low + &((high - low) * Rational::new(k.into(), 3.into()));
            points.into_iter().all(|(i, j)| {
                let point = [(names[0].clone(), inner(&x, i)), (names[1].clone(), inner(&y, j))];
                let verdict = model.ask().set_all(point).within(region.clone()).verdict(&Budget::unlimited()).unwrap();
                (verdict.value().verdict == Verdict::Stable) == (letter == '+')
            })
        })
    })
}

/// At random points of the boxes the engine's verdict is what the certificate says; at how many.
fn agree_with_verdicts(text: &str, sides: [Side; 2], certificate: &str, every: usize) -> usize {
    let window = sides.map(|(_, low, high)| [number(low), number(high)]);
    let (mut random, mut seen) = (Random::new(7), [0, 0]);
    let model = read(text);
    for (letter, cell) in leaves(&tree_of(certificate), window).unwrap().into_iter().step_by(every) {
        if letter == '?' {
            continue;
        }
        let mut inner = |[low, high]: &[Rational; 2]| {
            // The edges belong to a box; and few digits leave dead times a large divisor in common.
            low + &((high - low) * Rational::new((random.below(5) as i64).into(), 4.into()))
        };
        let point = [0, 1].map(|k| (sides[k].0.to_owned(), inner(&cell[k])));
        let verdict = match model.ask().set_all(point.clone()).verdict(&Budget::unlimited()) {
            Ok(verdict) => verdict,
            // Dead times without a divisor in common have no verdict.
            Err(refused) if refused.to_string().contains("no common divisor") => continue,
            Err(refused) => panic!("{refused}"),
        };
        assert_eq!(verdict.value().verdict == Verdict::Stable, letter == '+', "{point:?}\n{text}");
        seen[usize::from(letter == '+')] += 1;
    }
    seen.iter().sum()
}

#[test]
#[ignore = "long: CI runs it"]
fn boxes_of_examples_are_certified() {
    let maps = [
        ("drive", [("T", "0", "0.001"), ("K_pwm", "0", "600")], "0.05"),
        ("lcl-active-damping", [("k", "-1", "2"), ("c", "-1", "1")], "0.1"),
        ("acc-benchmark", [("k", "0", "4"), ("m_1", "0.2", "4")], "0.1"),
        // A sample time, and a constant of the plant with it: both inside of exponentials.
        ("dc-servo", [("K", "1", "200"), ("T", "0.0005", "0.01")], "0.1"),
        ("drive-hold", [("L_a", "0.002", "0.2"), ("T", "0.0001", "0.001")], "0.5"),
    ];
    for (name, sides, undecided) in tried(maps, 3) {
        let text = example_text(name);
        let (certificate, share) = emitted(&text, sides, undecided);
        accept(&text, &certificate);
        assert!(share >= number("0.85") - number(undecided), "{name}: {share}");
        // Of few boxes all are looked at.
        let every = if certificate.len() < 1000 { 1 } else { 3 };
        assert!(agree_with_verdicts(&text, sides, &certificate, every) > 5, "{name}");
    }
}

#[test]
#[ignore = "long: CI runs it"]
fn functions_of_parameters_and_constants_are_certified() {
    let loops = [
        ("continuous", "(s + 1)*(s^2 + sqrt(2)*b*s + b^2) + a*b^2"),
        ("continuous", "s^2 + sqrt(a + 3)*s + (b - 1)/cos(a/2)"),
        ("discrete", "z^2 - 2*exp(-b)*cos(3*b)*z + exp(-2*b) + a*(z + sin(b)/pi + tan(b/4))"),
        ("discrete", "z + a/(b - exp(-3))"),
    ];
    for (time, characteristic) in tried(loops, 2) {
        is_certified(&plain(time, characteristic), [("a", "-1", "2"), ("b", "1/10", "2")], "0.25", "0.7");
    }
}

/// Holds of both orders, with dead time in whole and broken samples, the sample time on an axis.
#[test]
fn all_kinds_of_holds_are_certified() {
    let plants = [
        "transfer = '1/(s + 1)'\ndiscretize = { method = 'foh', delay = 'T' }",
        "transfer = '1/(s*(s + 1))'\ndiscretize = 'zoh'",
        "transfer = '(2 - s)/(s^2 + s/2 + 3)'\ndiscretize = { method = 'zoh', delay = '0.7*T' }",
        "transfer = '-(exp(-T*s/4)*(s + 3))/(s + 1)*-exp(-T*s/4)'\ndiscretize = 'zoh'",
        "transfer = '1/(s^2 + 4)'\ndiscretize = { method = 'foh', delay = '1.3*T' }",
        "A = [[0, 1], [-5, -2]]\nB = [[0], [1]]\nC = [[1, 'K/7']]\ndiscretize = 'zoh'",
    ];
    for plant in tried(plants, 3) {
        let text = format!(
            "time = 'discrete'\nsample_time = 'T'\nparameters = {{ K = {{ nominal = 1 }}, T = {{ nominal = '1/5', min = 0 }} }}\n[loop]\n\
             [[block]]\ninput = '-K*y'\noutput = 'u'\ngain = 1\n[[block]]\ninput = 'u'\noutput = 'y'\n{plant}\n"
        );
        is_certified(&text, [("K", "-1/2", "3"), ("T", "1/10", "2")], "0.4", "0.5");
    }
}

#[test]
fn loops_that_are_nowhere_stable_are_one_box() {
    for text in [
        plain("discrete", "(z - 1)*(z - exp(-a)*b)"),
        plain("continuous", "s^3 + a*s^2 + b + 0*s"),
        format!("{}\nconstants.c = '1/(a*b)^0 + 0/(2 - 1)'", plain("discrete", "(z + 2)*(z + a + b)")),
    ] {
        let (certificate, share) = emitted(&text, [("a", "1", "2"), ("b", "1", "3")], "0.1");
        accept(&text, &certificate);
        assert_eq!((share, tree_of(&certificate).as_str()), (1.into(), "-"), "{text}");
    }
}

/// The triangle of `z^2 + a z + b`.
const TRIANGLE: [Side; 2] = [("a", "-3", "3"), ("b", "-2", "2")];

#[test]
fn a_certificate_never_says_more_than_the_answer() {
    let text = plain("discrete", "z^2 + a*z + b");
    let answer = boxes(&text, TRIANGLE, "0.2");
    let certified = certify_boxes(&answer, &Budget::unlimited()).unwrap();
    let window = TRIANGLE.map(|(_, low, high)| [number(low), number(high)]);
    for (letter, [x, y]) in leaves(&tree_of(&certified.text), window).unwrap() {
        let found = answer.value().boxes.locate(&x[0].midpoint(&x[1]), &y[0].midpoint(&y[1]));
        // The middle of a box may be an edge of the answer's boxes.
        match (letter, found.map(|b| b.verdict)) {
            ('?', _) | (_, None) => {}
            (_, Some(verdict)) => assert_eq!(verdict == BoxVerdict::Stable, letter == '+', "{x:?} {y:?}"),
        }
    }
    let areas = &answer.value().boxes.areas;
    let decided = (&areas.stable + &areas.unstable) / answer.value().boxes.window.area();
    assert!(&certified.stable + &certified.unstable <= decided);
    // Without time nothing is said.
    let budget = Budget::unlimited().cancelled_by(Arc::new(AtomicBool::new(true)));
    match certify_boxes(&answer, &budget) {
        Err(Error::Stopped(_)) => {}
        Ok(certified) => assert_eq!(tree_of(&certified.text), "?"),
        Err(other) => panic!("{other}"),
    }
}

#[test]
#[ignore = "long: CI runs it"]
fn a_leaf_that_lies_is_rejected() {
    let text = plain("discrete", "z^2 + a*z + b");
    let (certificate, _) = emitted(&text, TRIANGLE, "0.2");
    let tree = tree_of(&certificate);
    let window = TRIANGLE.map(|(_, low, high)| [number(low), number(high)]);
    let changed = |tree: &str| with(&certificate, &format!("\"{}\"", tree_of(&certificate)), &format!("\"{tree}\""));
    let mut undecidable = 0;
    for (at, letter) in tree.char_indices() {
        let replaced = |by: char| changed(&format!("{}{by}{}", &tree[..at], &tree[at + 1..]));
        match letter {
            '+' => reject(&text, &replaced('-'), Step::Stable),
            '-' => reject(&text, &replaced('+'), Step::Stable),
            '?' => {
                for by in ['+', '-'] {
                    if check(&text, &replaced(by), &LIMITS).is_err() {
                        undecidable += 1;
                        reject(&text, &replaced(by), Step::Stable);
                    } else {
                        assert!(is_true(&text, &Json::parse(&replaced(by)).unwrap()));
                    }
                }
            }
            _ => {}
        }
    }
    assert!(undecidable > 10, "{undecidable}");
    reject(&text, &changed(&format!("{tree}?")), Step::Line);
    for wrong in ["", "x?", "x???", "z??", "é", "x??\\n"] {
        reject(&text, &changed(wrong), Step::Line);
    }
    reject(&text, &changed(&format!("{}{}", "x".repeat(161), "?".repeat(162))), Step::Line);
    assert!(leaves(&tree, window).is_some_and(|leaves| leaves.len() > 30));
}

#[test]
fn another_statement_is_rejected() {
    let text = plain("continuous", "s^2 + a*s + b").replace("b = {}", "b = {}, c = {}");
    let by_hand = r#"{
        "schema": "jurist/certificate/7",
        "statement": {"kind": "boxes", "time": "continuous", "x": "a", "y": "b", "set": {"c": "0"}, "region": {"decay": "0"},
            "window": {"x": ["-3", "5"], "y": ["1", "2"]}, "tree": "xx-?+"},
        "order": 2, "bits": 64
    }"#;
    accept(&text, by_hand);
    let said = check(&text, by_hand, &LIMITS).unwrap().statement;
    assert_eq!(
        said,
        "For a from -3 to 5 and b from 1 to 2, with c = 0, the loop is stable in all boxes '+' of the tree, and nowhere in its boxes '-': at \
         least 50.0 % and 25.0 % of the window. Nothing is said of the rest."
    );
    for (step, from, to) in [
        (Step::Format, "certificate/7", "certificate/99"),
        (Step::Statement, "certificate/7", "certificate/5"),
        (Step::Statement, r#""kind": "boxes""#, r#""kind": "map""#),
        (Step::Format, r#""order": 2"#, r#""order": 0"#),
        (Step::Format, r#""order": 2"#, r#""order": 9"#),
        (Step::Format, r#""bits": 64"#, r#""bits": 63"#),
        (Step::Format, r#""bits": 64"#, r#""bits": 1025"#),
        (Step::Format, r#""bits": 64"#, r#""bits": "64""#),
        (Step::Format, r#""order""#, r#""degree""#),
        (Step::Statement, r#"["-3", "5"]"#, r#"["5", "-3"]"#),
        (Step::Statement, r#"["-3", "5"]"#, r#"["5"]"#),
        (Step::Statement, r#""tree""#, r#""boxes""#),
        (Step::Statement, r#"{"decay": "0"}"#, r#"{"decay": "parameter"}"#),
        (Step::Statement, r#"{"decay": "0"}"#, r#"{"radius": "1"}"#),
        (Step::Model, r#""time": "continuous", "x""#, r#""time": "discrete", "x""#),
        (Step::Model, r#"{"c": "0"}"#, "{}"),
        (Step::Model, r#"{"c": "0"}"#, r#"{"c": "0", "d": "0"}"#),
        (Step::Model, r#""y": "b""#, r#""y": "a""#),
        (Step::Model, r#""y": "b""#, r#""y": "d""#),
        // Other windows and regions.
        (Step::Stable, r#"["-3", "5"]"#, r#"["-4", "4"]"#),
        (Step::Stable, r#"["-3", "5"]"#, r#"["-2", "6"]"#),
        (Step::Stable, r#"["1", "2"]"#, r#"["0", "2"]"#),
        (Step::Stable, r#"["1", "2"]"#, r#"["-1", "2"]"#),
    ] {
        let changed = match (step, from) {
            // Of a discrete loop the region has a radius.
            (Step::Model, from) if from.contains("continuous") => {
                with(&with(by_hand, from, to), r#"{"decay": "0"}"#, r#"{"radius": "1"}"#)
            }
            _ => with(by_hand, from, to),
        };
        reject(&text, &changed, step);
    }
    reject(&text, &with(by_hand, r#"{"decay": "0"}"#, r#"{"decay": "1/2"}"#), Step::Stable);
    reject(&text.replace("a*s", "(a - 1)*s"), by_hand, Step::Stable);
}

/// Asserts of changes of one value in a certificate, one in `part`, and of `trees` trees with a part in another place that what is accepted is true, and
/// of one in `every` that both checkers say the same. How many are rejected, and how many accepted.
pub(super) fn rejected_or_true(
    text: &str,
    certificate: &str,
    random: &mut Random,
    [part, trees, every]: [usize; 3],
) -> [usize; 2] {
    let (original, tree) = (Json::parse(certificate).unwrap(), tree_of(certificate));
    assert!(is_true(text, &original));
    let mut changes: Vec<String> = mutations(&original).one_in(part).map(|json| json.to_text()).collect();
    // A letter, or a part of the tree, in the place of another.
    for _ in 0..trees {
        let (at, from) = (random.below(tree.len()), random.below(tree.len()));
        let to = (from + 1 + random.below(5)).min(tree.len());
        let changed = format!("{}{}{}", &tree[..at], &tree[from..to], &tree[at + 1..]);
        changes.push(with(certificate, &format!("\"{tree}\""), &format!("\"{changed}\"")));
    }
    let mut seen = [0, 0];
    for (k, changed) in changes.iter().enumerate() {
        let verdict = check(text, changed, &LIMITS);
        if k % every == 0
            && let Some(other) = python(text, changed)
        {
            assert_eq!(verdict.is_ok(), other.is_ok(), "{verdict:?} {other:?}\n{changed}");
        }
        assert!(verdict.is_err() || is_true(text, &Json::parse(changed).unwrap()), "{changed}");
        seen[usize::from(verdict.is_ok())] += 1;
    }
    seen
}

#[test]
fn changed_certificates_are_rejected_or_true() {
    let mut random = Random::new(3);
    for (text, sides) in [
        (plain("discrete", "z^2 + a*z + b"), TRIANGLE),
        (plain("discrete", "z - exp(-b) + a*(1 - exp(-b))"), [("a", "1/2", "4"), ("b", "1/4", "2")]),
    ] {
        let (certificate, _) = emitted(&text, sides, "0.4");
        let [rejected, accepted] =
            rejected_or_true(&text, &certificate, &mut random, [count(4, 1), count(25, 100), PYTHON_EVERY]);
        assert!(rejected > count(20, 80) && accepted > count(0, 2), "{rejected} rejected, {accepted} accepted");
    }
}

#[test]
fn the_program_certifies_boxes() {
    let folder = std::env::temp_dir().join(format!("jurist-boxes-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let file = folder.join("boxes.json").to_str().unwrap().to_owned();
    let servo = path("examples/dc-servo.toml").to_str().unwrap().to_owned();
    let ask = ["map", &servo, "-x", "K=1..200", "-y", "T=0.0005..0.01", "--undecided", "0.3", "--certificate", &file];
    let run = jurist(&ask);
    assert_eq!(run.status, 0, "{}", run.stderr);
    assert!(
        run.stderr.starts_with("note: the certificate proves ") && !run.stderr.contains("warning"),
        "{}",
        run.stderr
    );
    let proved = jurist(&["verify", &servo, &file, "--timeout", "inf"]);
    assert_eq!(proved.status, 0, "{}", proved.stderr);
    assert!(proved.stdout.contains("K from 1 to 200 and T from 1/2000 to 1/100, with T_m = 1/20"), "{}", proved.stdout);
    let exact = jurist(&[&ask[..], &["--method", "exact"]].concat());
    assert!(exact.status == 2 && exact.stderr.contains("E-no-certificate"), "{}", exact.stderr);
    // What the checkers do not read is said before there is a map.
    for (text, x, y) in [
        // A divisor with dead time in it.
        (
            "time = 'continuous'\nparameters = { K = {}, tau = {} }\n[[block]]\ninput = '-K*y'\noutput = 'y'\n\
             transfer = '1/(s + 2 - exp(-tau*s))'\n[loop]",
            "K=1..2",
            "tau=1..2",
        ),
        (
            "time = 'discrete'\nparameters = { K = {}, a = {} }\nloop.characteristic = 'z^2 - z + K*a'\nrequire.damping = 0.3",
            "K=0.1..0.2",
            "a=1..2",
        ),
    ] {
        for method in ["auto", "boxes"] {
            let options = ["map", "-", "-x", x, "-y", y, "--method", method, "--certificate", &file];
            let run = jurist_with_input(&options, text.as_bytes());
            assert!(run.status == 2 && run.stderr.contains("error[E-no-certificate]"), "{}", run.stderr);
        }
    }
    std::fs::remove_dir_all(&folder).unwrap();
}

/// A judge may be asked on any thread, and expressions nest as deep there as in a check.
#[test]
fn expressions_nest_as_deep_as_in_a_check() {
    let text = plain("discrete", &format!("z^2 + a*z + {}b{}", "(".repeat(195), ")".repeat(195)));
    is_certified(&text, [("a", "-3", "3"), ("b", "-3", "3")], "0.3", "0.6");
}
