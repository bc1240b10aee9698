//! `jurist tune` over boxes of gains: brackets of best values that are known, and specifications that cannot be met.

use crate::helpers::folder::Folder;
use crate::helpers::model::read;
use crate::helpers::number::{number, ratio};
use crate::helpers::schema::fits;
use jurist::Ask;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_engine::answer::Verdict;
use jurist_engine::model::Model;
use jurist_engine::response::{Requirement, Requirements};
use jurist_tune::answer::{Best, Optimum, Outcome, TuneAnswer};
use jurist_tune::asked::{Asked, Gain};
use proptest::prelude::*;
use serde_json::Value;

/// The closed loop is s^4 + s^3 + kd s^2 + kp s + ki: stable where kp (kd - kp) > ki > 0.
const THREE: &str = "time = 'continuous'\n[parameters]\nkp = 0.5\nki = 0.1\nkd = 1\n[loop]\ninputs = ['r']\noutputs = ['y']\n[[block]]\n\
    name = 'loop'\ninput = 'r - y'\noutput = 'y'\ntransfer = '(kd*s^2 + kp*s + ki)/(s^3*(s + 1))'\n[tune]\nfree = ['kp', 'ki', 'kd']\n\
    bounds = { kp = [0, 1], ki = [0, 1], kd = [0, 1.5] }\nobjective = 'max ki'\n";

/// A PI controller with a motor behind a hold.
const HELD: &str = "time = 'discrete'\nsample_time = '1/10'\n[parameters]\nk = 0.1\nki = 0.01\n[loop]\ninputs = ['r']\noutputs = ['y']\n\
    [[block]]\nname = 'c'\ninput = 'r - y'\noutput = 'u'\ntransfer = 'k + ki/10/(z - 1)'\n\
    [[block]]\nname = 'p'\ninput = 'u'\noutput = 'y'\nnum = [2]\nden = [1, 1, 0.2]\ndiscretize = 'zoh'\n";

const LAGS: &str = "time = 'continuous'\n[parameters]\nk = 0.5\nki = 0.2\n[loop]\ninputs = ['r']\noutputs = ['y']\n[[block]]\nname = 'loop'\n\
    input = 'r - y'\noutput = 'y'\ntransfer = '(k*s + ki)/(s*(s + 1)^3)'\n";

/// A question about gains within bounds, answered by boxes.
struct Case {
    model: Model,
    gains: Vec<(&'static str, [Rational; 2])>,
    list: Vec<Requirement>,
}

impl Case {
    fn new(text: &str, gains: &[(&'static str, &str, &str)], list: Vec<Requirement>) -> Case {
        let gains = gains.iter().map(|(name, low, high)| (*name, [number(low), number(high)])).collect();
        Case { model: read(text), gains, list }
    }

    fn answer(&self, objective: &str, gap: Rational) -> TuneAnswer {
        let gains = self.gains.iter().map(|(name, bounds)| Gain::new(*name).within(bounds.clone().map(Some)));
        let mut requirements = Requirements::default();
        requirements.list = self.list.clone();
        let mut asked = Asked::of(&self.model, gains.collect(), objective, requirements).unwrap();
        (asked.gap, asked.by_boxes) = (gap, true);
        TuneAnswer::of(&self.model.ask(), asked, &Budget::unlimited()).unwrap()
    }

    fn is_met(&self, point: &[Rational]) -> bool {
        let names = self.gains.iter().map(|(name, _)| (*name).to_owned());
        let problem = self.model.ask().set_all(names.zip(point.iter().cloned())).problem().unwrap();
        let budget = Budget::unlimited();
        problem.verdict(&budget).unwrap().value().verdict == Verdict::Stable
            && problem.requirements_met(&self.list, None, &budget).unwrap().iter().all(|found| found.met)
    }

    /// No point of some hundred that look like chance is better than what is proved, though some meet all.
    fn sample(&self, count: u64, mut look: impl FnMut(&[Rational])) {
        let mut chance: u64 = 7;
        let mut met = 0;
        for _ in 0..count {
            let mut at = |(_, [low, high]): &(&str, [Rational; 2])| {
                chance = chance.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                low + &((high - low) * ratio((chance >> 44) as i64, 1 << 20))
            };
            let point: Vec<Rational> = self.gains.iter().map(&mut at).collect();
            if self.is_met(&point) {
                met += 1;
                look(&point);
            }
        }
        assert!(met > 0);
    }
}

fn optimum(answer: &TuneAnswer) -> &Optimum {
    match &answer.outcome {
        Outcome::Optimum(optimum) => optimum,
        other => panic!("{other:?}"),
    }
}

/// The bracket, the lower end first.
fn bracket(answer: &TuneAnswer) -> [Rational; 2] {
    let Best::Between([a, b]) = &optimum(answer).value else { panic!("{:?}", optimum(answer)) };
    [a.min(b).clone(), a.max(b).clone()]
}

fn tune(model: &str, options: &[&str]) -> (i32, Value) {
    let folder = Folder::new(&[("loop.toml", model)]);
    let run = folder.jurist(&[&["tune", "loop.toml", "--json", "--digits", "12"], options].concat());
    let document: Value = serde_json::from_str(&run.stdout).unwrap_or_else(|_| panic!("{options:?}: {}", run.stderr));
    fits(&document).unwrap_or_else(|why| panic!("{why}: {document}"));
    (run.status, document)
}

fn three(list: Vec<Requirement>) -> Case {
    Case::new(THREE, &[("kp", "0", "1"), ("ki", "0", "1"), ("kd", "0", "1.5")], list)
}

/// By Routh's table: kp (kd - kp) is greatest at kd = 3/2 and kp = 3/4.
#[test]
#[ignore = "long: CI runs it"]
fn the_largest_of_three_gains() {
    let case = three(Vec::new());
    let answer = case.answer("max ki", ratio(2, 100));
    let [found, proved] = bracket(&answer);
    let exact = ratio(9, 16);
    assert!(found < exact && exact <= proved && proved <= &found * &ratio(103, 100), "{found} {proved}");
    let point = &optimum(&answer).found;
    assert!(point[1] == found && case.is_met(point), "{point:?}");
    case.sample(400, |point| assert!(point[1] < proved, "{point:?}"));
    let text = answer.text(12);
    assert!(text.contains("a bracket, proof: ") && text.contains(" cells)"), "{text}");
    // The gains that are typed in meet all, and are within the bounds.
    let typed = &optimum(&answer).typed.as_ref().unwrap().values;
    assert!(case.is_met(typed) && typed[1] >= &found * &ratio(99, 100) && typed[2] <= ratio(3, 2), "{typed:?}");
}

#[test]
fn the_smallest_of_three_gains() {
    // ki >= 1/4 asks for kp (kd - kp) > 1/4: kd > 1, at kp = 1/2.
    let case = Case::new(THREE, &[("kp", "0", "1"), ("ki", "0.25", "1"), ("kd", "0", "3")], Vec::new());
    let [proved, found] = bracket(&case.answer("min kd", ratio(2, 100)));
    assert!(proved <= Rational::ONE && Rational::ONE < found && found <= ratio(103, 100), "{proved} {found}");
}

/// The best value is the bound itself, which some gains have.
#[test]
fn a_bound_that_is_reached_is_the_best_value() {
    let (status, found) = tune(THREE, &["--objective", "max kp"]);
    let optimum = &found["optimum"];
    assert_eq!((status, &optimum["value"]["exact"], &optimum["attained"]), (0, &"1".into(), &true.into()), "{found}");
    assert_eq!(optimum["binding"][0], "bound of kp");
}

/// The exact answer of two gains lies in the bracket of boxes.
#[test]
#[ignore = "long: CI runs it"]
fn two_gains_by_boxes_and_exactly() {
    let list = || vec![Requirement::modulus_margin(ratio(5, 7)).unwrap()];
    let case = Case::new(LAGS, &[("k", "0", "5"), ("ki", "0", "5")], list());
    let [found, proved] = bracket(&case.answer("max ki", ratio(1, 1000)));
    let exact = number("0.32531741166766740672");
    assert!(found <= exact && exact < proved && proved < &found * &ratio(1002, 1000), "{found} {proved}");
}

#[test]
#[ignore = "long: CI runs it"]
fn a_level_over_three_gains() {
    let case = Case::new(THREE, &[("kp", "0.1", "1"), ("ki", "0.1", "1"), ("kd", "0.5", "1.5")], Vec::new());
    let answer = case.answer("max modulus_margin", ratio(5, 100));
    let [found, proved] = bracket(&answer);
    assert!(found < proved && proved <= &found * &ratio(106, 100), "{found} {proved}");
    let with = |least: Rational| Case {
        model: read(THREE),
        gains: case.gains.clone(),
        list: vec![Requirement::modulus_margin(least).unwrap()],
    };
    assert!(with(found).is_met(&optimum(&answer).found));
    let beyond = with(proved);
    case.sample(100, |point| assert!(!beyond.is_met(point), "{point:?}"));
}

/// Behind a hold the exact map over symbols takes minutes.
#[test]
#[ignore = "long: CI runs it"]
fn two_gains_behind_a_hold() {
    let options = ["--free", "k", "--free", "ki", "--bound", "k=0..10", "--bound", "ki=0..10", "--gap", "1e-2"];
    let required = ["--objective", "max ki", "--modulus-margin", "0.6"];
    let (status, found) = tune(HELD, &[&options[..], &required].concat());
    assert_eq!((status, &found["feasible"]), (0, &true.into()), "{found}");
    let [least, proved] = [&found["found"]["value"], &found["proved"]].map(|text| number(text.as_str().unwrap()));
    assert!(least < proved && proved < &least * &ratio(102, 100), "{found}");
    let case = Case::new(
        HELD,
        &[("k", "0", "2"), ("ki", "0", "1/4")],
        vec![Requirement::modulus_margin(ratio(3, 5)).unwrap()],
    );
    let point = ["k", "ki"].map(|name| number(found["found"]["point"][name].as_str().unwrap()));
    assert!(case.is_met(&point), "{found}");
    case.sample(60, |point| assert!(point[1] < proved, "{point:?}"));
}

/// A PI controller with a lag and a dead time: on the curve of 45 degrees, computed in floating point, the largest integral gain is 1.5786935 (at
/// `k = 1.47`).
#[test]
#[ignore = "long: CI runs it"]
fn two_gains_with_dead_time() {
    let text = "time = 'continuous'\n[parameters]\nk = 0.5\nki = 0.2\n[loop]\ninputs = ['r']\noutputs = ['y']\n[[block]]\ninput = 'r - y'\n\
        output = 'u'\ntransfer = 'k + ki/s'\n[[block]]\ninput = 'u'\noutput = 'y'\ntransfer = 'exp(-s/2)/(s + 1)'\n";
    let options = ["--free", "k", "--free", "ki", "--bound", "k=0.05..3", "--bound", "ki=0.02..2", "--gap", "0.2"];
    let (status, found) = tune(text, &[&options[..], &["--objective", "max ki", "--phase-margin", "45 deg"]].concat());
    assert_eq!((status, &found["feasible"]), (0, &true.into()), "{found}");
    let [least, proved] = [&found["found"]["value"], &found["proved"]].map(|text| number(text.as_str().unwrap()));
    assert!(
        least <= number("1.57869356") && number("1.57869355") <= proved && proved < &least * &ratio(5, 4),
        "{found}"
    );
}

#[test]
#[ignore = "long: CI runs it"]
fn specifications_that_cannot_be_met() {
    let bounds = ["--bound", "kp=0.1..1", "--bound", "ki=0.1..1", "--bound", "kd=0.1..1.5"];
    let required = ["--objective", "none", "--phase-margin", "170 deg", "--gain-margin", "1.01"];
    let (status, found) = tune(THREE, &[&bounds[..], &required].concat());
    assert_eq!((status, &found["feasible"]), (1, &false.into()), "{found}");
    assert_eq!(found["conflict"], serde_json::json!(["phase_margin >= 170 deg"]));
    assert!(found["cells"].as_u64().unwrap() > 1);
    // No requirement, and none is stable: kp (kd - kp) is 1/4 at most.
    let folder = Folder::new(&[("loop.toml", THREE)]);
    let options = ["--bound", "kp=0.1..1", "--bound", "ki=0.3..1", "--bound", "kd=0.1..1", "--objective", "none"];
    let run = folder.jurist(&[&["tune", "loop.toml"], &options[..]].concat());
    assert_eq!(run.status, 1, "{}", run.stderr);
    let said = "no gains within the bounds meet all of this (proof: ";
    assert!(run.stdout.contains(said) && run.stdout.contains("not even stability"), "{}", run.stdout);
}

/// Where the work ends the answer is the bracket so far.
#[test]
fn the_bracket_so_far() {
    let (status, found) = tune(THREE, &["--gap", "1e-9", "--work", "3000000"]);
    assert_eq!((status, &found["feasible"]), (3, &true.into()), "{found}");
    let [least, proved] = [&found["found"]["value"], &found["proved"]].map(|text| number(text.as_str().unwrap()));
    assert!(least <= ratio(9, 16) && ratio(9, 16) <= proved, "{found}");
    assert!(!found["undecided"].is_null());
}

#[test]
fn what_boxes_cannot_be_asked() {
    let folder = Folder::new(&[("loop.toml", &THREE.replace("kd = [0, 1.5] }", "}").replace("1], }", "1] }"))]);
    let run = folder.jurist(&["tune", "loop.toml"]);
    assert!(run.status == 2 && run.stderr.contains("E-tune-bounds"), "{}", run.stderr);
    assert!(run.stderr.contains("--bound kd=LO..HI"), "{}", run.stderr);
}

/// Where roots coincide at the best value: the bracket closes, and holds the closed form.
#[test]
#[ignore = "long: CI runs it"]
fn coinciding_roots_of_many_gains() {
    // All three coefficients are free, the last one up to 2: a triple root at -2^(1/3).
    let cubic =
        "time = 'continuous'\nparameters = { a = 3, b = 3, c = 1 }\nloop.characteristic = 's^3 + a*s^2 + b*s + c'\n";
    let case = Case::new(cubic, &[("a", "3", "4"), ("b", "2", "6"), ("c", "0", "2")], Vec::new());
    let answer = case.answer("max decay", ratio(1, 100));
    let [found, proved] = bracket(&answer);
    let exact = number("1.25992104989487316477");
    assert!(found < exact && exact < proved && proved <= &found * &ratio(102, 100), "{found} {proved}");
    // The sum of the four roots is -1: a fourfold root at -1/4.
    let [found, proved] = bracket(&three(Vec::new()).answer("max decay", ratio(2, 100)));
    assert!(found < ratio(1, 4) && ratio(1, 4) <= proved && proved <= &found * &ratio(104, 100), "{found} {proved}");
    // The heavy ball on the eigenvalues 1 and 10: double roots on both sides.
    let ball = "time = 'discrete'\nparameters = { alpha = 0.1, beta = 0.1 }\n\
        loop.characteristic = '(z^2 - (1 + beta - alpha)*z + beta)*(z^2 - (1 + beta - 10*alpha)*z + beta)'\n";
    let case = Case::new(ball, &[("alpha", "0", "1"), ("beta", "0", "1")], Vec::new());
    let [proved, found] = bracket(&case.answer("min radius", ratio(1, 1000)));
    let exact = number("0.51949385329591570400");
    assert!(proved < exact && exact < found && &found - &proved < ratio(1, 1000), "{found} {proved}");
}

/// Behind a hold too.
#[test]
#[ignore = "long: CI runs it"]
fn coinciding_roots_behind_a_hold() {
    let options = ["--free", "k", "--free", "ki", "--bound", "k=0..1", "--bound", "ki=0..1", "--gap", "2e-2"];
    let (status, found) = tune(HELD, &[&options[..], &["--objective", "min radius"]].concat());
    let [most, proved] = [&found["found"]["value"], &found["proved"]].map(|text| number(text.as_str().unwrap()));
    assert!(status == 0 && proved < most, "{found}");
    let case = Case::new(HELD, &[("k", "0", "1"), ("ki", "0", "1")], Vec::new());
    let is_within = |radius: &Rational, point: &[Rational]| {
        let set = case.gains.iter().map(|(name, _)| (*name).to_owned()).zip(point.iter().cloned());
        let region = jurist_engine::problem::Region::disc(radius.clone()).unwrap();
        let problem = case.model.ask().set_all(set).within(region).problem().unwrap();
        problem.verdict(&Budget::unlimited()).unwrap().value().verdict == Verdict::Stable
    };
    let point = ["k", "ki"].map(|name| number(found["found"]["point"][name].as_str().unwrap()));
    assert!(is_within(&(most + number("1e-9")), &point));
    case.sample(100, |point| assert!(!is_within(&proved, point), "{point:?}"));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4))]

    /// `c <= r^3` of `s^3 + a s^2 + b s + c`: the largest decay is `r`, at a triple root, wherever `3 r` and `3 r^2` are within the other bounds.
    #[test]
    #[ignore = "long: CI runs it"]
    fn a_triple_root_that_is_known(r in 1_i64..12, low in 1_i64..9, high in 11_i64..20) {
        let r = ratio(r, 4);
        let [b, c] = [&r * &r, &(&r * &r) * &r];
        let cubic = "time = 'continuous'\nparameters = { a = 1, b = 1, c = 1 }\nloop.characteristic = 's^3 + a*s^2 + b*s + c'\n";
        let around = |x: &Rational| [x * &ratio(3 * low, 10), x * &ratio(3 * high, 10)];
        let gains = vec![("a", around(&r)), ("b", around(&b)), ("c", [Rational::ZERO, c])];
        let case = Case { model: read(cubic), gains, list: Vec::new() };
        let [found, proved] = bracket(&case.answer("max decay", ratio(10, 100)));
        prop_assert!(found <= r && r <= proved && proved <= &found * &ratio(111, 100), "{} {} {}", found, r, proved);
    }

    /// `b >= r^2` of `z^2 - a z + b`: the smallest radius is `r`, where the roots have no more.
    #[test]
    fn a_radius_that_is_known(r in 1_i64..9, low in -8_i64..9, high in 10_i64..20) {
        let r = ratio(r, 10);
        let square = "time = 'discrete'\nparameters = { a = 1, b = 1 }\nloop.characteristic = 'z^2 - a*z + b'\n";
        let gains = vec![("a", [&r * &ratio(low, 5), &r * &ratio(high, 5)]), ("b", [&r * &r, Rational::ONE])];
        let case = Case { model: read(square), gains, list: Vec::new() };
        let [proved, found] = bracket(&case.answer("min radius", ratio(2, 100)));
        prop_assert!(proved <= r && r <= found, "{} {} {}", proved, r, found);
        prop_assert!(&found - &proved <= (Rational::ONE - &proved) * ratio(3, 100), "{} {}", proved, found);
    }
}
