use super::basis::Way;
use super::{RealIntervals, SymbolicPolynomial, SymbolicTest};
use crate::{IntervalSet, ParametricPolynomial, Range, Shape, Table, classical_test, symbolic_stable_set};
use jurist_algebra::ball::Ball;
use jurist_algebra::limits::Budget;
use jurist_algebra::matrix::CharacteristicPolynomial;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{Domain, MultiPoly, Poly, RationalFunction, RealAlgebraic, UniPoly};
use jurist_algebra::real::Real;
use jurist_algebra::symbols::{Definition, Symbols};
use jurist_engine::model::{Model, ParameterBuilder, Time};
use jurist_engine::problem::Ask;
use std::sync::Arc;

/// What an expression in `K` with constants says.
fn polynomial(characteristic: &str, time: Time) -> SymbolicPolynomial {
    let (model, _) = Model::builder(time)
        .parameter(ParameterBuilder::new("K").nominal("1"))
        .characteristic(characteristic)
        .build()
        .unwrap();
    own(&model.ask().free("K").problem().unwrap().symbolic(&Budget::unlimited()).unwrap().unwrap())
}

/// The engine is built with another instance of this crate than its own tests are.
fn own(p: &jurist_stability::SymbolicPolynomial) -> SymbolicPolynomial {
    let (polynomial, n) = (p.polynomial().clone(), p.formal_degree());
    let leading = polynomial.coeff(n);
    SymbolicPolynomial::from_parts(p.fixed_symbols().unwrap(), polynomial, leading, n, p.poles().to_vec())
}

fn region(time: Time) -> Shape {
    if time == Time::Discrete { Shape::UnitDisc } else { Shape::LeftHalfPlane }
}

fn test_of(characteristic: &str, time: Time, most: u64) -> SymbolicTest {
    let p = polynomial(characteristic, time);
    p.classical_test_with(&Range::all(), region(time), 20, Way::Expanding(most), &Budget::unlimited()).unwrap()
}

/// `exp(-1)`.
fn exponential() -> Ball {
    let mut symbols = Symbols::new();
    symbols.insert("X", Definition::exponential(-1));
    symbols.values(256)[0].clone()
}

/// Whether ends are those of the exact set divided by `exp(-1)`.
fn same_scaled(exact: &IntervalSet, found: &RealIntervals) -> bool {
    let x = exponential();
    let width = Rational::dyadic(&1.into(), 200);
    let same = |exact: &Option<RealAlgebraic>, found: &Option<Real>| match (exact, found) {
        (None, None) => true,
        (Some(exact), Some(found)) => {
            let ((lo, hi), (least, most)) = (exact.refined(&width).enclosure(), found.refined(&width).enclosure());
            let scaled = Ball::between(&least, &most, 256).mul(&x);
            scaled.lower() <= hi && lo <= scaled.upper()
        }
        _ => false,
    };
    exact.intervals().len() == found.intervals.len()
        && exact.intervals().iter().zip(&found.intervals).all(|(e, f)| same(&e.lower, &f[0]) && same(&e.upper, &f[1]))
}

/// Small numbers from a fixed sequence.
fn next(seed: &mut u64) -> i64 {
    *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*seed >> 33) as i64 % 19 - 9
}

/// With `K exp(-1)` in the place of a parameter every condition has the solution that the table of polynomials with integer
/// coefficients gives, divided by `exp(-1)`, whether determinants are expanded or not.
#[test]
fn conditions_are_those_of_the_exact_table_in_a_scaled_parameter() {
    let (mut seed, budget) = (7, Budget::unlimited());
    let range = Range::all();
    let x = exponential();
    let orders = [(Shape::UnitDisc, [1, 2, 3, 4, 5, 6, 9]), (Shape::LeftHalfPlane, [1, 2, 3, 4, 5, 6, 7])];
    // The low orders by default, all in CI.
    let most = if std::env::var_os("JURIST_THOROUGH").is_some() { 9 } else { 5 };
    let all = orders.iter().flat_map(|(region, orders)| orders.map(|n| (*region, n)));
    for (region, order) in all.filter(|(_, order)| *order <= most) {
        for moving_lead in [false, true] {
            let mut list: Vec<UniPoly> =
                (0..order).map(|_| UniPoly::from_i64(&[next(&mut seed), next(&mut seed)])).collect();
            list.push(UniPoly::from_i64(&[-(20 + next(&mut seed)), i64::from(moving_lead)]));
            let exact = ParametricPolynomial::from_integral(&Poly::new(list.clone()), order);
            let exact = classical_test(&exact, &range, region, &budget).unwrap();
            let scaled = MultiPoly::variable(0).times(&MultiPoly::variable(1));
            let coefficient = |c: &UniPoly| {
                let [a, b] = [0, 1].map(|k| MultiPoly::constant(c.coeff(k)));
                RationalFunction::from(a.plus(&b.times(&scaled)))
            };
            let d = CharacteristicPolynomial {
                variables: vec!["K".into(), "X".into()],
                coefficients: list.iter().map(coefficient).collect(),
                formal_degree: order,
                poles: Vec::new(),
                monic: false,
            };
            let mut symbols = Symbols::new();
            symbols.insert("X", Definition::exponential(-1));
            let p = SymbolicPolynomial::new(&d, 1, &Arc::new(symbols));
            for most in [0, u64::MAX] {
                let test = p.classical_test_with(&range, region, 20, Way::Expanding(most), &budget).unwrap();
                assert_eq!(test.conditions.len(), exact.conditions.len());
                for (found, condition) in test.conditions.iter().zip(&exact.conditions) {
                    assert_eq!(found.name, condition.name);
                    assert!(same_scaled(&condition.solution, &found.solution), "{region:?} {order}: {}", found.name);
                }
                assert!(same_scaled(&exact.intersection, &test.intersection), "{region:?} {order}");
                let rows: Vec<Vec<UniPoly>> = match &exact.table {
                    Table::Jury(table) => table.rows.iter().map(|row| row.entries.clone()).collect(),
                    Table::Routh(table) => table.rows.clone(),
                    Table::Hermitian(_) => unreachable!("the coefficients are real"),
                };
                assert_eq!(test.rows.len(), rows.len());
                for ((found, known), scale) in test.rows.iter().zip(&rows).zip(&exact.scales) {
                    assert_eq!(found.entries.len(), known.len());
                    for (found, known) in found.entries.iter().zip(known) {
                        assert_eq!(found.len(), known.coeffs().len(), "{region:?} {order}");
                        let mut power = Ball::from_integer(&1.into(), 256);
                        for (found, known) in found.iter().zip(known.coeffs()) {
                            let known = Ball::from_rational(&(scale * &Rational::from(known)), 256).mul(&power);
                            assert!(*found.lower() <= known.upper() && known.lower() <= *found.upper());
                            power = power.mul(&x);
                        }
                    }
                }
            }
        }
    }
}

/// At a number all conditions hold that hold in the table with that number in it, which has no determinants.
#[test]
#[ignore = "long: CI runs it"]
fn conditions_hold_where_those_of_the_table_at_a_point_do() {
    let (mut seed, budget) = (3, Budget::unlimited());
    for order in [2, 3, 4, 5, 6, 9] {
        let mut terms: Vec<String> = vec![format!("z^{order}")];
        for k in 0..order {
            let [a, b, c] = [next(&mut seed), next(&mut seed), next(&mut seed)];
            terms.push(format!("({a}/9 + {b}*exp(-1)/9 + K*{c}*exp(-1/3)/9)*z^{k}"));
        }
        let p = polynomial(&terms.join(" + "), Time::Discrete);
        let test = p.classical_test(&Range::all(), Shape::UnitDisc, 20, &budget).unwrap();
        let set = symbolic_stable_set(&p, &Range::all(), Shape::UnitDisc, &budget).unwrap();
        for k in -12..12 {
            let at = Rational::new(k.into(), 7.into());
            let d = terms.join(" + ").replace('K', &format!("({at})"));
            let (model, _) = Model::builder(Time::Discrete).characteristic(&d).build().unwrap();
            let point = own(&model.ask().problem().unwrap().symbolic(&budget).unwrap().unwrap());
            let table = point.jury_table(12, &budget).unwrap().unwrap();
            for (condition, known) in test.conditions.iter().zip(&table.conditions) {
                assert_eq!(condition.name, known.name);
                assert_eq!(condition.solution.contains(&at), known.holds, "{d}: {}", known.name);
            }
            assert_eq!(test.intersection.contains(&at), set.contains(&at), "{d}");
            // Entries as polynomials have the values of those at the point.
            for (row, known) in test.rows.iter().zip(&table.rows) {
                assert_eq!((&row.name, &row.divided_by), (&known.name, &known.divided_by));
                for (entry, known) in row.entries.iter().zip(&known.entries) {
                    let horner = |side: fn(&jurist_algebra::number::Enclosure) -> &Rational| {
                        entry.iter().rev().fold(Rational::ZERO, |sum, c| sum * &at + side(c))
                    };
                    let [low, high] = [horner(|e| e.lower()), horner(|e| e.upper())];
                    let apart = (&low - known.upper()).abs().max((&high - known.lower()).abs());
                    assert!(
                        apart < Rational::new(1.into(), 1_000_000_000.into()) * (known.upper().abs() + Rational::ONE)
                    );
                }
            }
        }
    }
}

#[test]
fn routh_conditions_over_symbols_are_solved() {
    // s^3 + pi s^2 + sqrt(2) s + K: H_2 = pi sqrt(2) - K, H_3 = K H_2.
    for most in [0, u64::MAX] {
        let test = test_of("s^3 + pi*s^2 + sqrt(2)*s + K", Time::Continuous, most);
        let names: Vec<&str> = test.conditions.iter().map(|c| c.name.as_str()).collect();
        assert_eq!(names, ["H_1 > 0", "H_2 > 0", "H_3 > 0"]);
        let [lower, upper] = &test.intersection.intervals[0];
        assert_eq!(lower.as_ref().unwrap().exact(), Some(Rational::ZERO));
        assert_eq!(upper.as_ref().unwrap().decimal(20), "4.4428829381583662470");
        assert!(test.conditions[0].solution.intervals[0].iter().all(Option::is_none));
        assert_eq!(test.rows.iter().map(|r| r.entries.len()).collect::<Vec<_>>(), [2, 2, 1, 1]);
    }
}

/// A determinant that is zero for all values ends Routh's table, and no condition holds there: `s^4 + e s^2 + K` has no odd part.
#[test]
fn a_condition_that_is_zero_for_all_values_holds_nowhere() {
    let test = test_of("s^4 + exp(1)*s^2 + K", Time::Continuous, u64::MAX);
    assert_eq!((test.conditions.len(), test.rows.len()), (1, 2));
    assert!(test.conditions[0].solution.intervals.is_empty() && test.intersection.intervals.is_empty());
    // a_0 = a_2 whatever K is, which only the values of the constants show: sqrt(2)^2 = 2.
    let test = test_of("z^2 + K*exp(-1)*z + sqrt(2)^2 - 1", Time::Discrete, u64::MAX);
    let [.., last] = &test.conditions[..] else { panic!("no conditions") };
    assert_eq!(last.name, "|a_0| < a_2");
    assert!(last.solution.intervals.is_empty() && test.intersection.intervals.is_empty());
}

/// Where the leading coefficient vanishes degree is lost, and no set goes through that.
#[test]
fn a_leading_coefficient_that_vanishes_cuts_the_sets() {
    for most in [0, u64::MAX] {
        // (K - X) z + X/2 with X = exp(-1): |X/2| < |K - X|.
        let test = test_of("(K - exp(-1))*z + exp(-1)/2", Time::Discrete, most);
        assert_eq!(test.conditions[2].name, "|a_0| < |a_1|");
        let ends = |i: usize| test.conditions[2].solution.intervals[i].clone();
        assert_eq!(ends(0)[1].as_ref().unwrap().decimal(6), "0.183940");
        assert_eq!(ends(1)[0].as_ref().unwrap().decimal(6), "0.551819");
        assert_eq!(test.intersection.intervals.len(), 2);
    }
}

/// Determinants with a common zero at a number that is not rational, here `K^2 = X` twice, are told by their common factor.
#[test]
fn zeros_in_common_are_one_end() {
    let p = polynomial("(z - K^2 + exp(-1))*(z + 1/2)*(z - K^2/2 + exp(-1)/2)", Time::Discrete);
    let budget = Budget::unlimited();
    let test = p.classical_test(&Range::all(), Shape::UnitDisc, 20, &budget).unwrap();
    let set = symbolic_stable_set(&p, &Range::all(), Shape::UnitDisc, &budget).unwrap();
    let real = |end: &Option<crate::End>| end.as_ref().map(|end| end.value.clone());
    let intervals = set.intervals().iter().map(|i| [real(&i.lower), real(&i.upper)]).collect();
    assert!(test.intersection.agree(&RealIntervals { intervals }, 200) && !test.intersection.intervals.is_empty());
}

/// Zeros that are double, and in common, because `sqrt(2)^2` is 2.
#[test]
fn zeros_in_common_by_what_the_constants_are_are_one_end() {
    let p = polynomial("z^2 - 2*sqrt(2)*K*z + 2*K^2", Time::Discrete);
    let test = p.classical_test(&Range::all(), Shape::UnitDisc, 20, &Budget::unlimited()).unwrap();
    let [all] = &test.intersection.intervals[..] else { panic!("one interval") };
    let ends = all.each_ref().map(|end| end.as_ref().unwrap().decimal(12));
    assert_eq!(ends, ["-0.707106781187", "0.707106781187"]);
    // The first condition touches zero.
    assert_eq!(test.conditions[0].solution.intervals.len(), 2);
}
