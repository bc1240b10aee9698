//! Laws of the model room: a diagram's polynomial against its determinant and its realisation; continuous
//! against discrete answers through the bilinear map.

use crate::helpers::certificates::checkers::certified_set_of;
use crate::helpers::model::{continuous, discrete};
use crate::helpers::thorough::count;
use jurist::Ask;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_engine::error::{Code, Error, Source};
use jurist_engine::model::Model;
use jurist_engine::stability::{Cause, End};
use proptest::collection::vec;
use proptest::prelude::*;

type Matrix = Vec<Vec<Rational>>;

/// Gaussian elimination.
fn determinant(mut m: Matrix) -> Rational {
    let mut product = Rational::ONE;
    for i in 0..m.len() {
        let Some(pivot) = (i..m.len()).find(|&r| !m[r][i].is_zero()) else { return Rational::ZERO };
        if pivot != i {
            m.swap(pivot, i);
            product = -product;
        }
        product = &product * &m[i][i];
        for r in i + 1..m.len() {
            let factor = &m[r][i] / &m[i][i];
            let (above, below) = m.split_at_mut(r);
            for (entry, pivot) in below[0].iter_mut().zip(&above[i]).skip(i) {
                *entry = &*entry - &(&factor * pivot);
            }
        }
    }
    product
}

fn eval(coefficients: &[Rational], x: &Rational) -> Rational {
    coefficients.iter().rev().fold(Rational::ZERO, |sum, c| sum * x + c.clone())
}

/// A block with one input and one output, with integer numbers.
#[derive(Clone, Debug)]
enum Kind {
    /// Coefficients from the highest power down; the denominator begins with a number that is not 0.
    Ratio(Vec<i64>, Vec<i64>),
    /// The parameter k times a number plus a number.
    Gain(i64, i64),
    Delay(usize),
    /// A (2x2), B, C, D.
    States([i64; 8], i64),
}

impl Kind {
    fn toml(&self) -> String {
        match self {
            Kind::Ratio(num, den) => format!("num = {num:?}\nden = {den:?}"),
            Kind::Gain(p, q) => format!("gain = '{p}*k + {q}'"),
            Kind::Delay(n) => format!("delay = {n}"),
            Kind::States(v, d) => format!(
                "A = [[{}, {}], [{}, {}]]\nB = [[{}], [{}]]\nC = [[{}, {}]]\nD = [[{d}]]",
                v[0], v[1], v[2], v[3], v[4], v[5], v[6], v[7]
            ),
        }
    }

    /// Numerator and denominator at z, uncancelled.
    fn at(&self, z: &Rational, k: &Rational) -> (Rational, Rational) {
        let n = |v: i64| Rational::from(v);
        let list = |c: &[i64]| eval(&c.iter().rev().map(|&c| n(c)).collect::<Vec<_>>(), z);
        match self {
            Kind::Ratio(num, den) => (list(num), list(den)),
            Kind::Gain(p, q) => (n(*p) * k + n(*q), Rational::ONE),
            Kind::Delay(samples) => (Rational::ONE, (0..*samples).fold(Rational::ONE, |p, _| p * z)),
            Kind::States(v, d) => {
                let [a, b, c, e, b1, b2, c1, c2] = v.map(n);
                let den = (z - &a) * (z - &e) - &b * &c;
                // C adj(zI - A) B
                let x1 = (z - &e) * &b1 + &b * &b2;
                let x2 = &c * &b1 + (z - &a) * &b2;
                (c1 * x1 + c2 * x2 + n(*d) * &den, den)
            }
        }
    }

    /// The value at infinity, and the leading coefficient of the denominator.
    fn direct(&self, k: &Rational) -> (Rational, Rational) {
        let n = |v: i64| Rational::from(v);
        match self {
            Kind::Ratio(num, den) if num.len() == den.len() => (n(num[0]) / n(den[0]), n(den[0])),
            Kind::Ratio(_, den) => (Rational::ZERO, n(den[0])),
            Kind::Gain(p, q) => (n(*p) * k + n(*q), Rational::ONE),
            Kind::Delay(samples) => (n(i64::from(*samples == 0)), Rational::ONE),
            Kind::States(_, d) => (n(*d), Rational::ONE),
        }
    }

    fn order(&self) -> usize {
        match self {
            Kind::Ratio(_, den) => den.len() - 1,
            Kind::Gain(..) => 0,
            Kind::Delay(samples) => *samples,
            Kind::States(..) => 2,
        }
    }
}

fn kind() -> impl Strategy<Value = Kind> {
    let small = || -3i64..=3;
    prop_oneof![
        (vec(small(), 1..4), vec(small(), 0..3), prop_oneof![Just(1i64), Just(2), Just(-1)]).prop_map(
            |(num, rest, first)| {
                let mut den = vec![first];
                den.extend(rest);
                let proper = num.len().saturating_sub(den.len());
                Kind::Ratio(num[proper..].to_vec(), den)
            }
        ),
        (small(), small()).prop_map(|(p, q)| Kind::Gain(p, q)),
        (0usize..3).prop_map(Kind::Delay),
        (prop::array::uniform8(small()), small()).prop_map(|(v, d)| Kind::States(v, d)),
    ]
}

/// Blocks and the matrix of their wiring: the input of block i is the sum of `wires[i][j]` times output j.
fn diagram() -> impl Strategy<Value = (Vec<Kind>, Vec<Vec<i64>>)> {
    (2usize..5).prop_flat_map(|n| (vec(kind(), n), vec(vec(prop_oneof![2 => Just(0i64), 3 => -2i64..=2], n), n)))
}

fn diagram_text(blocks: &[Kind], wires: &[Vec<i64>]) -> String {
    let mut text = String::from("time = 'discrete'\n[parameters]\nk = {}\n[loop]\n");
    for (i, (block, row)) in blocks.iter().zip(wires).enumerate() {
        let input: Vec<_> = row.iter().enumerate().map(|(j, w)| format!("({w})*y{j}")).collect();
        text +=
            &format!("[[block]]\nname = 'b{i}'\ninput = '{}'\noutput = 'y{i}'\n{}\n", input.join(" + "), block.toml());
    }
    text
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(count(48, 128) as u32))]

    /// det(zI - A) of the interconnection, times det(I - D M) and the denominators' leading coefficients, is
    /// det(diag(den) - diag(num) M): every mode counts, cancelled or not, reached or not.
    #[test]
    fn diagram_has_the_determinant_of_its_wiring((blocks, wires) in diagram()) {
        let n = blocks.len();
        let mixed = |parts: &[(Rational, Rational)]| -> Matrix {
            (0..n).map(|i| (0..n).map(|j| {
                let own = if i == j { parts[i].1.clone() } else { Rational::ZERO };
                own - &parts[i].0 * Rational::from(wires[i][j])
            }).collect()).collect()
        };
        let lead = |k: &Rational| {
            let direct: Vec<_> = blocks.iter().map(|b| (b.direct(k).0, Rational::ONE)).collect();
            blocks.iter().fold(determinant(mixed(&direct)), |p, b| p * b.direct(k).1)
        };
        let values: Vec<Rational> = (-3i64..=4).map(|v| Rational::from(v) / Rational::from(2)).collect();
        // An unused parameter is only a warning.
        let lp = match Model::from_toml(&Source::new("diagram.toml", diagram_text(&blocks, &wires))) {
            Ok((lp, _)) => lp,
            Err(error) => {
                prop_assert_eq!(error.code(), Code::AlgebraicLoop);
                prop_assert!(values.iter().all(|k| lead(k).is_zero()), "refused, though well posed");
                return Ok(());
            }
        };
        let (problem, budget) = (lp.ask().free("k").problem().unwrap(), Budget::unlimited());
        let polynomial = match problem.algebra(&budget) {
            Ok(algebra) => algebra.polynomial(),
            Err(Error::Stopped(e)) => panic!("{e}"),
            Err(_) => None,
        };
        let polynomial = match polynomial {
            Some(polynomial) => polynomial,
            None => {
                prop_assert!(values.iter().all(|k| lead(k).is_zero()), "refused, though well posed");
                return Ok(());
            }
        };
        // Both checkers read the diagram's text in their own way, and compare the polynomial.
        certified_set_of(lp.ask().free("k"));
        prop_assert_eq!(polynomial.formal_degree, blocks.iter().map(Kind::order).sum::<usize>());
        let closed = problem.closed_loop(&budget).unwrap();
        for k in &values {
            let Some(coefficients) = polynomial.at(std::slice::from_ref(k)) else {
                prop_assert!(lead(k).is_zero(), "undefined at {}", k);
                continue;
            };
            prop_assert!(!lead(k).is_zero(), "defined at {}", k);
            for z in &values {
                let p = eval(&coefficients, z);
                let parts: Vec<_> = blocks.iter().map(|b| b.at(z, k)).collect();
                prop_assert_eq!(&p * &lead(k), determinant(mixed(&parts)), "at k = {}, z = {}", k, z);
                let order = polynomial.formal_degree;
                let realised: Matrix = (0..order).map(|i| (0..order).map(|j| {
                    let own = if i == j { z.clone() } else { Rational::ZERO };
                    own - closed.a[(i, j)].eval(std::slice::from_ref(k)).unwrap()
                }).collect()).collect();
                prop_assert_eq!(p, determinant(realised));
            }
        }
    }

    /// With s = (z - 1)/(z + 1) both kinds of time have the same stable set; a lost degree is a root at z = -1.
    #[test]
    #[ignore = "long: CI runs it"]
    fn continuous_answers_are_the_discrete_ones_through_the_bilinear_map(
        rows in vec((-4i64..=4, -3i64..=3, -1i64..=1), 2..6),
        pole in prop::option::of(-2i64..=2),
    ) {
        let n = rows.len() - 1;
        // With the pole at 0 the last term is c k.
        let nonzero = |(a, b, c): (i64, i64, i64)| match pole {
            Some(0) => (a, b + c) != (0, 0),
            _ => (a, b, c) != (0, 0, 0),
        };
        let at_one = rows.iter().fold((0, 0, 0), |s, r| (s.0 + r.0, s.1 + r.1, s.2 + r.2));
        // Else the formal degrees differ, and a root stays at infinity or at s = 1.
        prop_assume!(nonzero(rows[n]) && nonzero(at_one));
        let coefficient = |(a, b, c): &(i64, i64, i64)| match pole {
            Some(p) => format!("(({a}) + ({b})*k + ({c})*k^2/(k - ({p})))"),
            None => format!("(({a}) + ({b})*k + ({c})*k^2)"),
        };
        let text = |power: &dyn Fn(usize) -> String| -> String {
            rows.iter().enumerate().map(|(i, r)| format!("{}*{}", coefficient(r), power(i))).collect::<Vec<_>>().join(" + ")
        };
        let in_s = continuous(&text(&|i| format!("s^{i}")), "");
        let in_z = discrete(&text(&|i| format!("(z - 1)^{i}*(z + 1)^{}", n - i)), "");
        let (a, b) = (certified_set_of(in_s.ask().free("k")), certified_set_of(in_z.ask().free("k")));
        prop_assert!(a.to_interval_set().unwrap().same_as(&b.to_interval_set().unwrap()), "{:?}\n{:?}", a, b);
        let ends = |set: &jurist_engine::stability::StableSet| -> Vec<End> {
            set.intervals().iter().flat_map(|i| [i.lower.clone(), i.upper.clone()]).flatten().collect()
        };
        for (s, z) in ends(&a).iter().zip(&ends(&b)) {
            if z.causes.contains(Cause::DegreeLost) {
                // Only where all coefficients vanish: a root at s = 1 is no limit of stable ones.
                prop_assert!(s.causes.contains(Cause::DegreeLost));
                continue;
            }
            for (in_s, in_z) in [
                (Cause::RootAtZero, Cause::RootAtOne),
                (Cause::DegreeLost, Cause::RootAtMinusOne),
                (Cause::ComplexPair, Cause::ComplexPair),
                (Cause::Pole, Cause::Pole),
            ] {
                if !s.causes.contains(Cause::Pole) || in_s == Cause::Pole {
                    prop_assert_eq!(s.causes.contains(in_s), z.causes.contains(in_z), "{} against {}", s.causes, z.causes);
                }
            }
        }
    }
}
