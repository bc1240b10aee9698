//! Certificates of loops with dead time beside constants that are not rational: both checkers accept what is written, and nothing that is wrong.

use super::map_boxes::{Side, certified, emitted, plain, rejected_or_true, tree_of};
use crate::helpers::certificates::checkers::{PYTHON_EVERY, accept, python, reject};
use crate::helpers::certificates::{mutations, with};
use crate::helpers::model::read;
use crate::helpers::number::number;
use crate::helpers::random::Random;
use crate::helpers::thorough::count;
use jurist::certified::{certify_intervals, certify_requirements, certify_tolerance, certify_verdict};
use jurist::{Ask, ToleranceRequest};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_check::format::Json;
use jurist_check::{Limits, Step, check};
use jurist_engine::error::Error;
use jurist_engine::model::Model;
use jurist_engine::response::Requirement;
use std::f64::consts::{FRAC_PI_2, PI, SQRT_2};
use std::time::Duration;

/// No test may fail because the machine is busy.
const LIMITS: Limits = Limits::within(Duration::MAX);

/// `i w = -sqrt(2) a exp(-i b w)`: stable for `0 < sqrt(2) a b < pi/2`.
const INTEGRATOR: &str = "s + sqrt(2)*a*exp(-b*s)";
const WINDOW: [Side; 2] = [("a", "1/8", "3"), ("b", "1/8", "2")];

/// Unity feedback with a gain `K`.
fn feedback_text(transfer: &str) -> String {
    format!(
        "time = 'continuous'\nparameters.K = {{ nominal = 1, min = 0 }}\nloop = {{ inputs = ['r'], outputs = ['y'] }}\n[[block]]\n\
         name = 'plant'\ninput = 'K*(r - y)'\noutput = 'y'\ntransfer = '{transfer}'\n"
    )
}

fn feedback(transfer: &str) -> Model {
    read(&feedback_text(transfer))
}

fn text_of(model: &Model) -> &str {
    &model.source().text
}

/// What both checkers say.
fn said(text: &str, certificate: &str) -> String {
    accept(text, certificate);
    check(text, certificate, &LIMITS).expect("it was accepted").statement
}

fn verdict(model: &Model, gain: Rational) -> Result<String, Error> {
    let budget = Budget::unlimited();
    certify_verdict(&model.ask().set("K", gain).verdict(&budget)?, &budget)
}

#[test]
fn a_verdict_is_certified_on_both_sides_of_a_limit_in_closed_form() {
    // pi K/s exp(-s/2) is stable below K = 1.
    let model = feedback("pi*exp(-s/2)/s");
    let at = |gain: &str| said(text_of(&model), &verdict(&model, number(gain)).unwrap());
    assert_eq!(at("0.999999"), "At K = 0.999999, the loop is stable.");
    assert_eq!(at("1.000001"), "At K = 1.000001, the loop is not stable.");
    // A loop without names.
    let alone = read("time = 'continuous'\nloop.characteristic = 's + pi/4 + sqrt(2)*exp(-s)'\n");
    let certificate = certify_verdict(&alone.ask().verdict(&Budget::unlimited()).unwrap(), &Budget::unlimited());
    assert_eq!(said(text_of(&alone), &certificate.unwrap()), "The loop is stable.");
}

#[test]
fn a_verdict_of_another_point_or_loop_is_rejected() {
    let model = feedback("pi*exp(-s/2)/s");
    let (text, certificate) = (text_of(&model), verdict(&model, number("9/10")).unwrap());
    reject(text, &with(&certificate, "9/10", "11/10"), Step::Stable);
    reject(text, &with(&certificate, "\"+.\"", "\"-0.\""), Step::Stable);
    for (step, transfer) in [
        (Step::Stable, "4*exp(-s/2)/s"),
        (Step::Stable, "pi*exp(-s)/s"),
        (Step::Stable, "sqrt(13)*exp(-s/2)/s"),
        (Step::Stable, "(1 + pi)*exp(-s/2)/s"),
        (Step::Stable, "pi*exp(-s/2)/(s - 4)"),
        // Not of the point, but of what no checker reads.
        (Step::Model, "pi*exp(-sqrt(2)*s/4)/s"),
        (Step::Model, "exp(exp(-s))/s"),
        (Step::Model, "cos(1 + exp(-s))/s"),
    ] {
        reject(&feedback_text(transfer), &certificate, step);
    }
    // A number for pi is another loop, and may be as stable.
    accept(&feedback_text("3*exp(-s/2)/s"), &certificate);
    // Undefined where a function that is zero is divided by, which no enclosure tells.
    reject(&feedback_text("pi*exp(-s/2)/(s*(sqrt(4) - 2))"), &certificate, Step::Stable);
}

#[test]
fn maps_follow_a_closed_form() {
    let text = plain("continuous", INTEGRATOR);
    let (certificate, share) = emitted(&text, WINDOW, "0.5");
    accept(&text, &certificate);
    assert!(share > number("0.4"), "{share}");
    // The same boxes of a loop with a larger constant.
    for changed in ["s + pi*a*exp(-b*s)", "s + sqrt(2)*a*exp(-2*b*s)", "s - sqrt(2)*a*exp(-b*s)"] {
        reject(&plain("continuous", changed), &certificate, Step::Stable);
    }
    // Of a function of a name the checkers know as much.
    let moving = plain("continuous", "s + sqrt(a + 1)*exp(-b*s)");
    let by_hand = |tree: &str| {
        format!(
            r#"{{"schema": "jurist/certificate/7", "statement": {{"kind": "boxes", "time": "continuous", "x": "a", "y": "b", "set": {{}},
            "region": {{"decay": "0"}}, "window": {{"x": ["0", "1/2"], "y": ["1/2", "5/2"]}}, "tree": "{tree}"}}, "order": 4, "bits": 96}}"#
        )
    };
    accept(&moving, &by_hand("yyx++?y?-"));
    reject(&moving, &by_hand("yyx+++y?-"), Step::Stable);
    reject(&moving, &by_hand("yyx++?y--"), Step::Stable);
    // Nothing is said where a root is of what may be negative.
    reject(&plain("continuous", "s + sqrt(a - 1)*exp(-b*s)"), &by_hand("yyx++?y?-"), Step::Stable);
}

#[test]
fn a_set_is_certified_up_to_a_narrow_gap() {
    let budget = Budget::unlimited();
    let model = feedback("sqrt(2)*exp(-s/2)/s");
    let set = certify_intervals(&model.ask().free("K").stable_set(&budget).unwrap(), &budget).unwrap();
    // No other name has a value: it is one of boxes of the parameter alone.
    assert!(set.proved > number("0.999999"), "{}", set.proved);
    let limit = PI / SQRT_2;
    let found = said(text_of(&model), &set.text);
    let [below, above] = ["<= K <= ", "any value in "].map(|begin| {
        let (_, rest) = found.split_once(begin).unwrap();
        number(&rest.chars().take_while(|c| c.is_ascii_digit() || *c == '.').collect::<String>()).to_f64_approximate()
    });
    assert!(below < limit && limit < above && above - below < 1e-6, "{found}");
}

#[test]
fn requirements_are_certified() {
    let budget = Budget::unlimited();
    let model = feedback("sqrt(2)*exp(-s/2)/s");
    // A modulus margin m of K sqrt(2)/s exp(-s/2) at K = 1 is 0.497.
    let at = |margin: &str| Requirement::modulus_margin(number(margin)).unwrap();
    let problem = model.ask().set("K", Rational::ONE).problem().unwrap();
    let certificate = certify_requirements(&problem, &[at("2/5")], None, true, &budget).unwrap();
    let text = said(text_of(&model), &certificate);
    assert!(text.starts_with("At K = 1, the loop is stable, with a modulus margin of at least 2/5"), "{text}");
    reject(text_of(&model), &with(&certificate, "\"2/5\"", "\"1/2\""), Step::Stable);
}

#[test]
#[ignore = "long: CI runs it"]
fn tolerances_are_certified_and_larger_ones_are_rejected() {
    let budget = Budget::unlimited();
    let model = feedback("sqrt(8)*exp(-s/2)/s");
    let request = ToleranceRequest::new([("K", "20%".parse().unwrap())]);
    let found = certify_tolerance(&model.ask().tolerance(&request, &budget).unwrap(), None, &budget).unwrap();
    // Up to pi/sqrt(8).
    let factor = found.factor.unwrap().to_f64_approximate();
    assert!((factor - (FRAC_PI_2 / SQRT_2 - 1.0) / 0.2).abs() < 1e-2, "{factor}");
    let text = said(text_of(&model), &found.text);
    assert!(text.starts_with("For all K from ") && text.contains("the loop is stable. At K = 1.11"), "{text}");
    let Some(Json::List(ranges)) =
        Json::parse(&found.text).unwrap().get("statement").and_then(|s| s.get("for_all")).cloned()
    else {
        panic!("{}", found.text)
    };
    let Some(Json::List(between)) = ranges[0].get("between") else { panic!("{ranges:?}") };
    let Json::Text(high) = &between[1] else { panic!("{between:?}") };
    reject(text_of(&model), &with(&found.text, high, "9/8"), Step::Stable);
    reject(&feedback_text("sqrt(9)*exp(-s/2)/s"), &found.text, Step::Stable);
}

/// A characteristic function with constants in it.
fn random_function(random: &mut Random) -> String {
    let constant = ["sqrt(2)", "pi", "exp(1/2)", "(1 + sqrt(5))/2", "cos(1)", "1/pi"][random.below(6)];
    let mut c = |n: usize| random.below(n) as i64;
    match c(4) {
        0 => format!("s^2 + {}*{constant}*s + {} + (a + {}*s)*exp(-b*s)", 1 + c(4), c(5), c(3)),
        1 => format!("s^2 + {}*s + {constant} + a*exp(-b*s)*{constant} - {}*exp(-s/{})", 2 + c(3), c(3), 1 + c(3)),
        2 => format!("s^3 + {}*s^2 + {constant}*s + a*({} - s)*exp(-(b + 1/3)*s)", 1 + c(5), c(4)),
        _ => format!("s*(1 + a/{}*exp(-b*s)) + {constant} + {}*exp(-s/2)", 6 + c(4), c(3)),
    }
}

#[test]
#[ignore = "long: CI runs it"]
fn random_loops_agree_with_verdicts() {
    let (mut random, mut seen) = (Random::new(31), 0);
    for _ in 0..count(2, 4) {
        let text = plain("continuous", &random_function(&mut random));
        seen += certified(&text, [("a", "-1", "5"), ("b", "0", "1")], "0.2", "0.6", 1);
    }
    assert!(seen > count(2, 4), "{seen}");
}

/// The loop of the statements, `K sqrt(2) exp(-s/2)/(s (s/(4 pi) + 1))`.
const PLANT: &str = "sqrt(2)*exp(-s/2)/(s*(s/(4*pi) + 1))";

/// A certificate of each kind.
fn statement(kind: &str) -> String {
    let (model, budget) = (feedback(PLANT), Budget::unlimited());
    let request = ToleranceRequest::new([("K", "20%".parse().unwrap())]);
    let margin = [Requirement::modulus_margin(number("3/10")).unwrap()];
    let problem = model.ask().set("K", Rational::ONE).problem().unwrap();
    match kind {
        "stable" => verdict(&model, Rational::ONE).unwrap(),
        "unstable" => verdict(&model, 3.into()).unwrap(),
        "margin" => certify_requirements(&problem, &margin, None, true, &budget).unwrap(),
        "set" => certify_intervals(&model.ask().free("K").stable_set(&budget).unwrap(), &budget).unwrap().text,
        _ => certify_tolerance(&model.ask().tolerance(&request, &budget).unwrap(), None, &budget).unwrap().text,
    }
}

/// In floating point: the limit of the gain is where the phase is half a turn, and the distance to -1 is looked at on a fine grid.
fn is_good(gain: f64, margin: f64) -> bool {
    let (phase, size) = (|w: f64| w / 2.0 + (w / (4.0 * PI)).atan(), |w: f64| w * (w / (4.0 * PI)).hypot(1.0) / SQRT_2);
    let [low, high] = (0..60).fold([0.0, PI], |[low, high], _| {
        let middle = f64::midpoint(low, high);
        if phase(middle) < FRAC_PI_2 { [middle, high] } else { [low, middle] }
    });
    let distance = |w: f64| {
        let (turn, ratio) = (phase(w) + FRAC_PI_2, gain / size(w));
        (1.0 + ratio * turn.cos()).hypot(ratio * turn.sin())
    };
    let is_far = || (1..100_000).all(|k| distance(f64::from(k) / 1e3) >= margin);
    gain > 0.0 && gain < size(f64::midpoint(low, high)) && (margin <= 0.0 || is_far())
}

/// Whether what a statement says is true.
fn is_true(statement: &Json) -> bool {
    let text = |json: Option<&Json>| match json {
        Some(Json::Text(text)) => text.clone(),
        other => panic!("{other:?}"),
    };
    let list = |json: Option<&Json>| match json {
        Some(Json::List(list)) => list.clone(),
        _ => Vec::new(),
    };
    let value = |json: &Json| number(&text(Some(json)));
    let ranges =
        |key: &str| list(statement.get(key)).iter().map(|range| list(range.get("between"))).collect::<Vec<_>>();
    let margins = list(statement.get("require"));
    let margin = margins.iter().map(|own| value(own.get("bound").unwrap()).to_f64_approximate()).fold(0.0, f64::max);
    let good = |gain: &Rational| is_good(gain.to_f64_approximate(), margin);
    let set = statement.get("set").and_then(|set| set.get("K")).map(value);
    let range = ["axes", "for_all"].into_iter().flat_map(ranges).next();
    let range = range.map_or_else(|| vec![set.clone().unwrap(); 2], |ends| ends.iter().map(value).collect());
    let mut stack = vec![[range[0].clone(), range[1].clone()]];
    let (tree, has_axes) = (text(statement.get("tree")), !ranges("axes").is_empty());
    let mut letters = tree.chars();
    let beyond = list(statement.get("beyond").and_then(|beyond| beyond.get("point")));
    let mut is_right = !beyond.iter().any(|point| good(&value(point)));
    while let Some([low, high]) = stack.pop() {
        let letter = letters.next().expect("a letter");
        let middle = low.midpoint(&high);
        if letter == 'a' {
            stack.extend([[middle.clone(), high], [low, middle]]);
            continue;
        }
        let seen = [low, middle, high].map(|gain| good(&gain));
        is_right &= match (letter, has_axes) {
            ('+', _) => seen == [true; 3],
            ('-', true) => seen == [false; 3],
            ('-', false) => seen.contains(&false),
            _ => true,
        };
        if letter != '?' {
            let end = letters.by_ref().find(|c| *c == '.');
            assert_eq!(end, Some('.'), "{tree}");
        }
    }
    is_right
}

/// A certificate with a letter, or a part of the tree, in the place of another.
fn other_trees(certificate: &str, count: usize) -> Vec<String> {
    let (tree, mut random) = (tree_of(certificate), Random::new(7));
    let other = |_| {
        let (at, from) = (random.below(tree.len()), random.below(tree.len()));
        let to = (from + random.below(5)).min(tree.len());
        let changed = format!("{}{}{}", &tree[..at], &tree[from..to], &tree[at + 1..]);
        with(certificate, &format!("\"{tree}\""), &format!("\"{changed}\""))
    };
    (0..count).map(other).collect()
}

/// How many changes of a certificate are rejected, and how many accepted: one in `every`, and so many trees.
fn changed(kind: &str, every: usize, trees: usize) -> [usize; 2] {
    let (text, certificate, mut seen) = (feedback_text(PLANT), statement(kind), [0, 0]);
    let original = Json::parse(&certificate).unwrap();
    assert!(is_true(original.get("statement").unwrap()), "{certificate}");
    let changes = mutations(&original);
    let changes = changes.one_in(every).map(|json| json.to_text()).chain(other_trees(&certificate, trees));
    for (k, changed) in changes.enumerate() {
        let found = check(&text, &changed, &LIMITS);
        if k % PYTHON_EVERY == 0
            && let Some(other) = python(&text, &changed)
        {
            assert_eq!(found.is_ok(), other.is_ok(), "{found:?} {other:?}\n{changed}");
        }
        let is_true = || is_true(Json::parse(&changed).unwrap().get("statement").unwrap());
        assert!(found.is_err() || is_true(), "{changed}");
        seen[usize::from(found.is_ok())] += 1;
    }
    seen
}

#[test]
fn some_changed_statements_are_rejected_or_true() {
    for kind in ["stable", "unstable"] {
        let [rejected, accepted] = changed(kind, 3, 4);
        assert!(rejected > accepted, "{kind}: {rejected} rejected, {accepted} accepted");
    }
}

#[test]
#[ignore = "long: CI runs it"]
fn changed_statements_are_rejected_or_true() {
    let mut seen = 0;
    for kind in ["stable", "unstable", "tolerance", "margin", "set"] {
        let [rejected, accepted] = changed(kind, 3, count(20, 60));
        assert!(rejected > accepted, "{kind}: {rejected} rejected, {accepted} accepted");
        seen += rejected;
    }
    assert!(seen > count(50, 150), "{seen}");
}

#[test]
#[ignore = "long: CI runs it"]
fn changed_maps_are_rejected_or_true() {
    let text = plain("continuous", INTEGRATOR);
    let (certificate, _) = emitted(&text, WINDOW, "0.4");
    let [rejected, accepted] = rejected_or_true(&text, &certificate, &mut Random::new(5), [1, 1000, PYTHON_EVERY]);
    assert!(rejected > 500 && accepted > 0, "{rejected} rejected, {accepted} accepted");
}
