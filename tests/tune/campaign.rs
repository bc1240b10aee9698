//! Random designs whose best value is known in closed form, and designs that cannot be met: some of each here, and two hundred where all cases are
//! tried. What is found is never better than the best value, and what is proved never worse.

use crate::helpers::model::read;
use crate::helpers::number::ratio;
use crate::helpers::thorough::count;
use jurist::Ask;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_engine::response::Requirements;
use jurist_tune::answer::{Best, Outcome, TuneAnswer};
use jurist_tune::asked::{Asked, Gain};
use std::cmp::Ordering;

/// Numbers that look like chance.
struct Chance(u64);

impl Chance {
    fn next(&mut self, low: i64, high: i64) -> i64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        low + ((self.0 >> 33) % (high - low) as u64) as i64
    }
}

/// A design: a characteristic polynomial, its gains with bounds, what is to be best, and how a number compares with the best value.
struct Design {
    time: &'static str,
    polynomial: String,
    gains: Vec<(&'static str, [Rational; 2])>,
    objective: String,
    compare: Box<dyn Fn(&Rational) -> Ordering>,
    /// A requirement that is just beyond the best value: a bound of the region, or of a gain.
    beyond: (&'static str, Rational),
}

fn known(value: Rational) -> Box<dyn Fn(&Rational) -> Ordering> {
    Box::new(move |x| x.cmp(&value))
}

/// The decay of `K/(s (s + p) (s + q))` at its break point: the lesser root of `3 x^2 - 2 (p + q) x + p q`.
fn break_point(chance: &mut Chance) -> Design {
    let (p, q) = (ratio(chance.next(1, 40), 4), ratio(chance.next(1, 40), 4));
    let sum = &p + &q;
    let product = &p * &q;
    let compare = move |x: &Rational| {
        let value = &(&(x * x) * &Rational::from(3)) - &(x * &sum) * &Rational::from(2) + &product;
        // Beyond the middle of both roots it is beyond the lesser one.
        let is_far = x * &Rational::from(3) > sum;
        if is_far { Ordering::Greater } else { Rational::ZERO.cmp(&value) }
    };
    // A rational number above the root.
    let mut above = &p.clone().min(q.clone()) * &ratio(1, 2);
    while compare(&above) != Ordering::Greater {
        above = &above * &ratio(101, 100);
    }
    Design {
        time: "continuous",
        polynomial: format!("s*(s + {p})*(s + {q}) + K"),
        gains: vec![("K", [Rational::ZERO, Rational::from(2000)])],
        objective: "max decay".into(),
        compare: Box::new(compare),
        beyond: ("decay", above),
    }
}

/// The radius of `K/(z (z - a))`: both roots at `a/2`.
fn double_root(chance: &mut Chance) -> Design {
    let a = ratio(chance.next(1, 40), 20);
    let best = &a * &ratio(1, 2);
    Design {
        time: "discrete",
        polynomial: format!("z*(z - {a}) + K"),
        gains: vec![("K", [Rational::from(-2), Rational::from(2)])],
        objective: "min radius".into(),
        beyond: ("radius", &best * &ratio(99, 100)),
        compare: known(best),
    }
}

/// Routh: `K < a b`.
fn product(chance: &mut Chance) -> Design {
    let (a, b) = (ratio(chance.next(1, 60), 7), ratio(chance.next(1, 60), 11));
    let best = &a * &b;
    Design {
        time: "continuous",
        polynomial: format!("s^3 + {a}*s^2 + {b}*s + K"),
        gains: vec![("K", [Rational::ZERO, Rational::from(1000)])],
        objective: "max K".into(),
        beyond: ("K", &best * &ratio(101, 100)),
        compare: known(best),
    }
}

/// Two gains: a double root at half of the greatest damping.
fn two_gains(chance: &mut Chance) -> Design {
    let (a, most) = (ratio(chance.next(1, 30), 10), ratio(chance.next(1, 40), 10));
    let best = (&a + &most) * &ratio(1, 2);
    let enough = &(&best * &best) * &ratio(chance.next(11, 30), 10);
    Design {
        time: "continuous",
        polynomial: format!("s^2 + ({a} + k)*s + ki"),
        gains: vec![("k", [Rational::ZERO, most]), ("ki", [Rational::ZERO, enough])],
        objective: "max decay".into(),
        beyond: ("decay", &best * &ratio(105, 100)),
        compare: known(best),
    }
}

/// Three gains: a triple root, since the last one is `r^3` at most.
fn triple_root(chance: &mut Chance) -> Design {
    let r = ratio(chance.next(2, 20), 5);
    let (b, c) = (&r * &r, &(&r * &r) * &r);
    let around = |x: &Rational, chance: &mut Chance| {
        [x * &ratio(3 * chance.next(2, 9), 10), x * &ratio(3 * chance.next(11, 18), 10)]
    };
    Design {
        time: "continuous",
        polynomial: "s^3 + a*s^2 + b*s + c".into(),
        gains: vec![("a", around(&r, chance)), ("b", around(&b, chance)), ("c", [Rational::ZERO, c])],
        objective: "max decay".into(),
        beyond: ("decay", &r * &ratio(11, 10)),
        compare: known(r),
    }
}

fn design(chance: &mut Chance, k: usize) -> Design {
    match k % 5 {
        0 => break_point(chance),
        1 => double_root(chance),
        2 => product(chance),
        3 => two_gains(chance),
        _ => triple_root(chance),
    }
}

impl Design {
    fn answer(&self, objective: &str, beyond: bool) -> TuneAnswer {
        let names: Vec<String> = self.gains.iter().map(|(name, _)| format!("{name} = 1")).collect();
        let model = read(&format!(
            "time = '{}'\nparameters = {{ {} }}\nloop.characteristic = '{}'\n",
            self.time,
            names.join(", "),
            self.polynomial
        ));
        let (name, value) = &self.beyond;
        let gains = self.gains.iter().map(|(gain, [low, high])| {
            let low = if beyond && gain == name { value.clone() } else { low.clone() };
            Gain::new(*gain).within([Some(low), Some(high.clone())])
        });
        let budget = Budget::unlimited();
        let mut requirements = Requirements::default();
        if beyond && ["decay", "radius"].contains(name) {
            requirements = Requirements::without_section(&model, &[(name, &value.to_string())], &[], &budget).unwrap();
        }
        let mut asked = Asked::of(&model, gains.collect(), objective, requirements).unwrap();
        asked.gap = ratio(5, 100);
        TuneAnswer::of(&model.ask(), asked, &budget).unwrap()
    }

    /// Whether the answer is exact; that it is right is asserted.
    fn check(&self) -> bool {
        let answer = self.answer(&self.objective, false);
        let Outcome::Optimum(optimum) = &answer.outcome else { panic!("{}: {answer:?}", self.polynomial) };
        let is_rising = self.objective.starts_with("max");
        let not_better = if is_rising { Ordering::Greater } else { Ordering::Less };
        match &optimum.value {
            Best::Exact(value) => {
                let (low, high) = value.refined_to_digits(20).enclosure();
                assert!((self.compare)(&low).is_le() && (self.compare)(&high).is_ge(), "{}: {low}", self.polynomial);
                true
            }
            Best::Between([found, proved]) => {
                assert_ne!((self.compare)(found), not_better, "{}: {found} is found", self.polynomial);
                assert_ne!((self.compare)(proved), not_better.reverse(), "{}: {proved} is proved", self.polynomial);
                false
            }
            other => panic!("{}: {other:?}", self.polynomial),
        }
    }

    fn check_beyond(&self) {
        let answer = self.answer("none", true);
        assert_eq!(answer.is_feasible(), Some(false), "{}: {:?}", self.polynomial, self.beyond);
    }
}

fn campaign(all: usize, seed: u64) -> (usize, usize) {
    let mut chance = Chance(seed);
    let designs: Vec<Design> = (0..all).map(|k| design(&mut chance, k)).collect();
    let exact = designs.iter().filter(|design| design.check()).count();
    designs.iter().for_each(Design::check_beyond);
    (exact, all - exact)
}

/// Twenty designs, or two hundred where all cases are tried.
#[test]
#[ignore = "long: CI runs it"]
fn designs_with_a_known_best_value() {
    let all = count(20, 200);
    let (exact, brackets) = campaign(all, 1);
    assert!(exact * 2 > all && brackets > 0, "{exact} exact, {brackets} brackets");
}
