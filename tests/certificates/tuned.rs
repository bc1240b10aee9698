//! Certificates of best gains (`jurist/certificate/11`): designs whose best value is known, and specifications that cannot be met.

use crate::helpers::certificates::checkers::accept;
use crate::helpers::folder::Folder;
use crate::helpers::model::read;
use crate::helpers::number::{number, ratio};
use crate::helpers::random::Random;
use crate::helpers::thorough::{count, tried};
use jurist::certified::certify_tune;
use jurist::{Ask, Budget, Error, Rational, Requirement};
use jurist_check::{Limits, check};
use jurist_engine::problem::Region;
use jurist_engine::response::Requirements;
use jurist_tune::answer::TuneAnswer;
use jurist_tune::asked::{Asked, Gain};
use serde_json::Value;
use std::time::Duration;

/// A design: a loop, bounds of its gains, and what is required.
struct Design {
    text: String,
    gains: Vec<(&'static str, [Rational; 2])>,
    list: Vec<Requirement>,
    region: Option<Region>,
}

/// A unity feedback loop around a transfer function.
fn loop_of(time: &str, transfer: &str, names: &str) -> String {
    format!(
        "time = '{time}'\nparameters = {{ {names} }}\nloop = {{ inputs = ['r'], outputs = ['y'] }}\n[[block]]\nname = 'P'\ninput = 'r - y'\noutput = 'y'\n\
         transfer = '{transfer}'\n"
    )
}

impl Design {
    fn new(text: String, gains: &[(&'static str, Rational, Rational)]) -> Design {
        let gains = gains.iter().map(|(name, low, high)| (*name, [low.clone(), high.clone()])).collect();
        Design { text, gains, list: Vec::new(), region: None }
    }

    fn require(self, requirement: Requirement) -> Design {
        Design { list: vec![requirement], ..self }
    }

    fn within(self, region: Region) -> Design {
        Design { region: Some(region), ..self }
    }

    fn answer(&self, objective: &str) -> TuneAnswer {
        let model = read(&self.text);
        let gains = self.gains.iter().map(|(name, bounds)| Gain::new(*name).within(bounds.clone().map(Some)));
        let mut requirements = Requirements::default();
        (requirements.list, requirements.region) = (self.list.clone(), self.region.clone());
        let mut asked = Asked::of(&model, gains.collect(), objective, requirements).unwrap();
        asked.gap = ratio(1, 50);
        TuneAnswer::of(&model.ask(), asked, &Budget::unlimited()).unwrap()
    }

    /// A certificate that both checkers accept.
    fn certified(&self, objective: &str) -> Value {
        let text = certify_tune(&self.answer(objective), &Budget::unlimited());
        let text = text.unwrap_or_else(|e| panic!("{e:?}\n{}", self.text));
        accept(&self.text, &text);
        serde_json::from_str(&text).unwrap()
    }
}

fn one() -> Rational {
    Rational::ONE
}

/// Numbers in tenths.
fn tenths(random: &mut Random, low: usize, high: usize) -> Rational {
    ratio((low + random.below(high - low + 1)) as i64, 10)
}

const K: &str = "K = 1";
const PI: &str = "k = 1, ki = 1";

/// A design, what is to be best, and its best value: of a gain, an expression or a level.
fn known(kind: usize, random: &mut Random) -> (Design, &'static str, Rational) {
    let [a, b, c] = [0; 3].map(|_| tenths(random, 5, 30));
    let nothing = Rational::ZERO;
    let (two, half) = (ratio(2, 1), ratio(1, 2));
    // Of s^3 + ... by Routh: K < (a + b)(b + c)(c + a).
    let three = loop_of("continuous", &format!("K*{a}*{b}*{c}/((s + {a})*(s + {b})*(s + {c}))"), K);
    let most = (&a + &b) * (&b + &c) * (&c + &a) * (&a * &b * &c).recip().unwrap();
    let pole = ratio(1 + random.below(9) as i64, 10);
    let second = loop_of("continuous", &format!("(k*s + ki)/(s*(s + {a}))"), PI);
    // With all roots left of -rate: k + a > 2 rate, ki > rate (k + a) - rate^2.
    let rate = &a + &half;
    let pi = |ki: Rational| {
        Design::new(second.clone(), &[("k", nothing.clone(), &rate * &two + one()), ("ki", nothing.clone(), ki)])
    };
    let wide = ratio(100, 1);
    match kind {
        0 => (Design::new(three, &[("K", nothing, wide)]), "max K", most),
        1 => {
            let factor = one() + &a;
            let best = most.checked_div(&factor).unwrap();
            (
                Design::new(three, &[("K", nothing, wide)]).require(Requirement::gain_margin(&factor).unwrap()),
                "max K",
                best,
            )
        }
        2 => (
            Design::new(loop_of("discrete", &format!("K/(z - {pole})"), K), &[("K", ratio(1, 50), ratio(9, 1))]),
            "max K",
            one() + pole,
        ),
        3 => (
            Design::new(loop_of("continuous", &format!("K/(s*(s + {a}))"), K), &[("K", ratio(1, 50), ratio(9, 1))]),
            "max decay",
            &a * &half,
        ),
        4 => (
            Design::new(loop_of("discrete", &format!("K/(z*(z - {pole}))"), K), &[("K", nothing, one())]),
            "min radius",
            &pole * &half,
        ),
        // |1 + K/(s - 1)| is K - 1 at least, at the frequency 0.
        5 => {
            let design = Design::new(loop_of("continuous", "K/(s - 1)", K), &[("K", ratio(1, 2), ratio(9, 1))]);
            (design.require(Requirement::modulus_margin(pole.clone()).unwrap()), "min K", one() + pole)
        }
        6 => (pi(ratio(99, 1)).within(Region::half_plane(rate.clone())), "min k", &rate * &two - &a),
        // s^2 + a s + K has the damping a/(2 sqrt(K)).
        7 => {
            let design = Design::new(loop_of("continuous", &format!("K/(s*(s + {a}))"), K), &[("K", nothing, wide)]);
            let best = (&a * &half).checked_div(&pole).unwrap();
            (design.require(Requirement::damping(pole).unwrap()), "max K", &best * &best)
        }
        // s^3 + (a + b) s^2 + (a b + k) s + ki
        _ => {
            let text = loop_of("continuous", &format!("(k*s + ki)/(s*(s + {a})*(s + {b}))"), PI);
            let best = (&a + &b) * (&a * &b + &c);
            (Design::new(text, &[("k", nothing.clone(), c), ("ki", nothing, &best * &two)]), "max ki", best)
        }
    }
}

fn exact(json: &Value) -> Rational {
    number(json.as_str().unwrap())
}

#[test]
fn best_values_that_are_known_are_between_what_is_found_and_what_is_proved() {
    let mut random = Random::new(3);
    for round in 0..count(9, 40) {
        let (design, objective, best) = known(round % 9, &mut random);
        let found = design.certified(objective);
        let of = &found["statement"];
        let (low, high) = match of["objective"].get("level") {
            None => {
                let name = objective.rsplit(' ').next().unwrap();
                let place = design.gains.iter().position(|(gain, _)| *gain == name).unwrap();
                (exact(&of["found"]["point"][place]), exact(&of["objective"]["proved"]))
            }
            Some(level) => {
                let bound = |json: &Value| exact(json.get("decay").or(json.get("radius")).unwrap());
                (bound(&of["found"]["level"]), bound(level))
            }
        };
        let is_between =
            if objective.starts_with("max") { low <= best && best < high } else { high < best && best <= low };
        assert!(is_between, "{round} {objective}: {low} {best} {high}\n{}", design.text);
        assert!(
            (&high - &low).abs() <= &best * &ratio(1, 200),
            "{round} {objective}: {low} {best} {high}\n{}",
            design.text
        );
    }
}

/// Of the designs above what is better than the best one.
fn impossible(kind: usize, random: &mut Random) -> Design {
    let (design, objective, best) = known(kind, random);
    let more = one() + ratio(1 + random.below(20) as i64, 50);
    let name = objective.rsplit(' ').next().unwrap();
    let mut design = design;
    match (name, objective.starts_with("max")) {
        ("decay", _) => design.within(Region::half_plane(best * more)),
        ("radius", _) => design.within(Region::disc(best.checked_div(&more).unwrap()).unwrap()),
        (_, is_greatest) => {
            let gain = design.gains.iter_mut().find(|(gain, _)| *gain == name).unwrap();
            gain.1[usize::from(!is_greatest)] =
                if is_greatest { best * more } else { best.checked_div(&more).unwrap() };
            design
        }
    }
}

#[test]
#[ignore = "long: CI runs it"]
fn specifications_that_cannot_be_met_are_certified() {
    let mut random = Random::new(4);
    for round in 0..count(27, 40) {
        let design = impossible(round % 9, &mut random);
        // Some bounds may have no gains between them.
        if design.gains.iter().any(|(_, [low, high])| low >= high) {
            continue;
        }
        let found = design.certified("none");
        assert_eq!(found["statement"]["objective"], Value::Null);
        assert_eq!(found["statement"]["found"], Value::Null);
    }
}

#[test]
fn an_expression_is_certified_in_its_bracket() {
    let (design, _, _) = known(6, &mut Random::new(9));
    let found = design.certified("min 2*k + ki/(1 + k)");
    let proved = exact(&found["statement"]["objective"]["proved"]);
    assert!(found["statement"]["objective"]["least"]["below"].is_array() && proved.sign().is_gt());
}

/// Behind a hold, at several rates, with dead time, and over three gains.
#[test]
fn loops_of_all_rings_are_certified() {
    let held = "time = 'discrete'\nsample_time = '1/10'\nparameters = { k = 1 }\nloop = { inputs = ['r'], outputs = ['y'] }\n[[block]]\nname = 'P'\n\
        input = 'r - y'\noutput = 'y'\ntransfer = 'k*2/(s^2 + s + 1/5)'\ndiscretize = 'zoh'\n";
    let rates = "time = 'discrete'\nparameters = { k = 1 }\n[loop]\ninputs = ['r']\noutputs = ['y']\n[[block]]\nname = 'C'\ninput = 'r - y'\noutput = 'u'\n\
        gain = 'k'\nevery = 2\n[[block]]\ninput = 'u'\noutput = 'y'\ntransfer = '1/(z - 1/2)'\n";
    let delayed = loop_of("continuous", "k*exp(-s)/(s + 1)", "k = 1");
    let three = loop_of("continuous", "(kd*s^2 + kp*s + ki)/(s^3*(s + 1))", "kp = 1, ki = 1, kd = 1");
    let gain = |high: i64| [("k", ratio(1, 10), ratio(high, 1))];
    for (text, objective) in [(held.to_owned(), "max k"), (rates.to_owned(), "max k"), (delayed, "max k")] {
        let found = Design::new(text, &gain(20)).certified(objective);
        assert!(found["statement"]["found"].is_object());
    }
    let all = ["kp", "ki", "kd"].map(|name| (name, ratio(1, 10), one()));
    // kp (kd - kp) > ki: at most 1/4 at kp = 1/2, kd = 1.
    let mut few = Design::new(three, &all);
    few.gains[1].1[0] = ratio(27, 100);
    assert_eq!(few.certified("none")["statement"]["kind"], "tune");
}

#[test]
fn what_has_no_certificate_is_said() {
    let refused = |design: &Design, objective: &str, what: &str| match certify_tune(
        &design.answer(objective),
        &Budget::unlimited(),
    ) {
        Err(Error::Refused(why)) => assert!(why.to_string().contains(what), "{why}"),
        other => panic!("{other:?}"),
    };
    let text = loop_of("continuous", "K/(s*(s + 1)*(s + 2))", K);
    let lags = loop_of("continuous", "(K*s + 1/5)/(s*(s + 1)^3)", K);
    let design = Design::new(lags, &[("K", ratio(1, 10), ratio(9, 1))]);
    refused(&design, "min norm r y", "norm");
    // Levels that follow from where roots are, and from a dead time, have one.
    for objective in tried(["max damping", "max delay_margin"], 2) {
        assert!(design.certified(objective)["statement"]["found"]["level"].is_object());
    }
    // The gain margin has no bound.
    let first = loop_of("continuous", "K/(s + 1)", K);
    refused(&Design::new(first, &[("K", ratio(1, 10), ratio(9, 1))]), "max gain_margin", "no best value");
    let folder = Folder::new(&[("loop.toml", &text)]);
    let run = folder.jurist(&["tune", "loop.toml", "--free", "K", "--objective", "max K", "--certificate", "c.json"]);
    assert_eq!(run.status, 2, "{}", run.stderr);
    assert!(
        run.stderr.contains("'K' has no bounds at both ends") && run.stdout.contains("largest K: 6"),
        "{}",
        run.stderr
    );
}

#[test]
fn the_program_writes_what_it_verifies() {
    let text = loop_of("continuous", "K/(s*(s + 1)*(s + 2))", K)
        + "[tune]\nfree = ['K']\nbounds = { K = [0, 50] }\nobjective = 'max K'\n";
    let folder = Folder::new(&[("loop.toml", &text)]);
    for (more, status, sentence) in [
        (vec![], 0, "For no K from 0 to 50 with K >= 6.00000"),
        (vec!["--bound", "K=7..50"], 1, "For no K from 7 to 50, the loop is stable."),
        // Where a bound is best, the gain on it is what is found.
        (vec!["--bound", "K=0.1..3"], 0, "At K = 3 it is, and K is 3 there."),
        (vec!["--bound", "K=0.1..3", "--objective", "max phase_margin"], 0, "At K = 1/10 it is, with a phase margin"),
        (vec!["--objective", "none"], 0, "the loop is stable"),
    ] {
        let run = folder.jurist(&[vec!["tune", "loop.toml", "--certificate", "c.json"], more].concat());
        assert_eq!(run.status, status, "{}", run.stderr);
        let verified = folder.jurist(&["verify", "loop.toml", "c.json"]);
        assert!(verified.status == 0 && verified.stdout.contains(sentence), "{}", verified.stdout);
    }
    let proved = check(&text, &folder.read("c.json"), &Limits::within(Duration::MAX)).unwrap();
    assert_eq!(proved.kind, "verdict");
}
