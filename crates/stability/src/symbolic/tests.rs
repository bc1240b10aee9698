use super::basis::Unexpanded;
use super::basis::Way;
use super::set::set_over;
use super::*;
use crate::{End, Range, RootCount, StableSet};
use jurist_algebra::number::{Integer, parse_number};
use jurist_algebra::poly::RationalFunction;
use jurist_algebra::real::Real;
use jurist_algebra::symbols::{Definition, EnclosedPoly};

fn number(text: &str) -> Rational {
    parse_number(text).unwrap()
}

/// A loop with the parameter K (variable 0) and symbols after it.
fn looped(coefficients: Vec<RationalFunction>, symbols: Symbols) -> SymbolicPolynomial {
    let formal_degree = coefficients.len() - 1;
    let variables = std::iter::once("K".to_owned()).chain(symbols.names()).collect();
    let d = CharacteristicPolynomial { variables, coefficients, formal_degree, poles: Vec::new(), monic: true };
    SymbolicPolynomial::new(&d, 1, &Arc::new(symbols))
}

fn stable(p: &SymbolicPolynomial, range: &Range) -> StableSet {
    symbolic_stable_set(p, range, Shape::UnitDisc, &Budget::unlimited()).unwrap()
}

fn decimal(end: &Option<End>, digits: usize) -> String {
    end.as_ref().map_or_else(|| "none".into(), |e| format!("{} {}", e.value.decimal(digits), e.causes))
}

fn ends(set: &StableSet, digits: usize) -> Vec<[String; 2]> {
    set.intervals().iter().map(|i| [decimal(&i.lower, digits), decimal(&i.upper, digits)]).collect()
}

fn count(p: &SymbolicPolynomial, value: &str) -> RootCount {
    match p.at(&number(value), Shape::UnitDisc, &Budget::unlimited()).unwrap() {
        AtPoint::Defined { count, infinite: 0 } => count,
        other => panic!("{other:?}"),
    }
}

/// `1/(s (s + a))` behind a hold of one second, with the gain K: `exp(-a)` is the symbol.
fn motor(a: i64) -> SymbolicPolynomial {
    let mut symbols = Symbols::new();
    symbols.insert("X", Definition::exponential(-a));
    let (k, x, one) = (RationalFunction::variable(0), RationalFunction::variable(1), RationalFunction::one());
    let scale = RationalFunction::from(Rational::new(Integer::ONE, Integer::from(a)));
    // What a step of the input adds in one sample to the speed, and to the position.
    let speed = &(&one - &x) * &scale;
    let position = &(&one - &speed) * &scale;
    // (z - 1)(z - X) + K ((z - X) position + speed^2)
    let constant = &x + &(&k * &(&(&speed * &speed) - &(&x * &position)));
    looped(vec![constant, &(&k * &position) - &(&one + &x), one], symbols)
}

#[test]
fn a_motor_behind_a_hold_has_the_textbook_limit() {
    // (1 - X)/(1 - 2 X) for X = exp(-1), the pair reaches the circle.
    let set = stable(&motor(1), &Range::between(Some(Rational::ZERO), None));
    assert_eq!(
        ends(&set, 32),
        [["0 z=1+domain".to_owned(), "2.3922111911773328143765528784798 complex pair".to_owned()]]
    );
    let pair = set.intervals()[0].upper.as_ref().unwrap().pair.as_ref().unwrap();
    // 0.2107838 Hz with a second to a sample.
    assert_eq!(pair.angle(64).unwrap().decimal(7).unwrap(), "1.324393");
}

#[test]
fn counts_on_either_side_of_a_limit_differ_by_the_pair() {
    let p = motor(1);
    assert_eq!(count(&p, "2.392211191177332814376552878"), RootCount { inside: 2, on: 0, outside: 0 });
    assert_eq!(count(&p, "2.392211191177332814376552879"), RootCount { inside: 0, on: 0, outside: 2 });
    // Without the gain the integrator is left.
    assert_eq!(count(&p, "0"), RootCount { inside: 1, on: 1, outside: 0 });
}

/// `1/(s^2 + 1)` behind a hold of one second: `tan(1/2)` is the symbol.
fn oscillator() -> SymbolicPolynomial {
    let mut symbols = Symbols::new();
    symbols.insert("t", Definition::tangent(number("1/2")));
    let (k, t, one) = (RationalFunction::variable(0), RationalFunction::variable(1), RationalFunction::one());
    let square = &t * &t;
    let cos = (&one - &square).checked_div(&(&one + &square)).unwrap();
    let gain = &k * &(&one - &cos);
    looped(vec![&one + &gain, &gain - &(&cos + &cos), one], symbols)
}

#[test]
fn an_undamped_oscillator_is_stable_between_rational_ends() {
    let set = stable(&oscillator(), &Range::all());
    assert_eq!(ends(&set, 12), [["-1 z=1".to_owned(), "0 complex pair".to_owned()]]);
    assert_eq!(set.intervals()[0].upper.as_ref().unwrap().value.exact(), Some(Rational::ZERO));
    let pair = set.intervals()[0].upper.as_ref().unwrap().pair.as_ref().unwrap();
    assert_eq!(pair.angle(64).unwrap().decimal(12).unwrap(), "1.00000000000");
    let cells = set.cells().unwrap();
    assert!(!set.is_algebraic() && cells.samples.len() == cells.zeros.len() + 1);
}

#[test]
fn roots_on_the_circle_are_counted() {
    let p = oscillator();
    assert_eq!(count(&p, "0"), RootCount { inside: 0, on: 2, outside: 0 });
    assert_eq!(count(&p, "-1"), RootCount { inside: 1, on: 1, outside: 0 });
    assert_eq!(count(&p, "-1/2"), RootCount { inside: 2, on: 0, outside: 0 });
    assert_eq!(count(&p, "1"), RootCount { inside: 0, on: 0, outside: 2 });
}

#[test]
fn a_mirror_pair_beyond_the_circle_counts_once_on_either_side() {
    // (z - X)(z - 1/X)(z - 1/2), expanded: z + 1/z = X + 1/X is a common root of the pair for every X.
    let mut symbols = Symbols::new();
    symbols.insert("X", Definition::exponential(-1));
    let (x, one) = (RationalFunction::variable(1), RationalFunction::one());
    let sum = &x + &x.recip().unwrap();
    let half = RationalFunction::from(number("1/2"));
    let p = looped(vec![-&half, &one + &(&half * &sum), -&(&sum + &half), one], symbols);
    assert_eq!(count(&p, "0"), RootCount { inside: 2, on: 0, outside: 1 });
    assert!(stable(&p, &Range::all()).is_empty());
}

#[test]
fn a_loop_with_an_identity_that_vanishes_is_stable_nowhere() {
    // z - 1 + K (exp(-2) - exp(-1)^2): the gain does nothing, and the root stays at 1.
    let mut symbols = Symbols::new();
    symbols.insert("X", Definition::exponential(-2));
    symbols.insert("Y", Definition::exponential(-1));
    let [k, x, y] = [0, 1, 2].map(RationalFunction::variable);
    let zero = &k * &(&x - &(&y * &y));
    let p = looped(vec![&zero - &RationalFunction::one(), RationalFunction::one()], symbols);
    assert!(stable(&p, &Range::all()).is_empty());
    assert_eq!(count(&p, "5"), RootCount { inside: 0, on: 1, outside: 0 });
}

#[test]
fn limits_separate_counts_and_nothing_changes_in_between() {
    // Three lags of different rates behind a hold, each discretised by itself: (z - X)(z - Y)(z - Z) + K.
    let mut symbols = Symbols::new();
    for (name, rate) in [("X", "-1/3"), ("Y", "-5/7"), ("Z", "-2")] {
        symbols.insert(name, Definition::exponential(number(rate)));
    }
    let [k, x, y, z] = [0, 1, 2, 3].map(RationalFunction::variable);
    let sum = &(&x + &y) + &z;
    let products = &(&(&x * &y) + &(&y * &z)) + &(&x * &z);
    let coefficients = vec![&k - &(&(&x * &y) * &z), products, -sum, RationalFunction::one()];
    let p = looped(coefficients, symbols);
    let set = stable(&p, &Range::all());
    let mut seen = 0;
    for interval in set.intervals() {
        for (end, direction) in [(&interval.lower, 1), (&interval.upper, -1)] {
            let (lo, hi) = end.as_ref().unwrap().value.refined(&number("1e-40")).enclosure();
            let (inner, outer) = if direction > 0 { (hi, lo) } else { (lo, hi) };
            let at = |x: &Rational| p.at(x, Shape::UnitDisc, &Budget::unlimited()).unwrap();
            let all = |x: &Rational| matches!(at(x), AtPoint::Defined { count, .. } if count.inside == 3);
            assert!(all(&inner) && !all(&outer));
            seen += 1;
        }
    }
    assert_eq!(seen, 2);
}

/// The motor with its sample time T as the parameter and a gain that is a number.
fn motor_in_time(gain: &str) -> SymbolicPolynomial {
    let (t, x, one) = (RationalFunction::variable(0), RationalFunction::variable(1), RationalFunction::one());
    let gain = RationalFunction::from(number(gain));
    let (speed, position) = (&one - &x, &(&t - &one) + &x);
    let constant = &x + &(&gain * &(&(&speed * &speed) - &(&x * &position)));
    let coefficients = vec![constant, &(&gain * &position) - &(&one + &x), one];
    let variables = vec!["T".to_owned(), "X".to_owned()];
    let d = CharacteristicPolynomial { variables, coefficients, formal_degree: 2, poles: Vec::new(), monic: true };
    SymbolicPolynomial::with_moving(&d, &Arc::new(MovingSymbols::new(vec![("X".into(), Definition::Exponential(-&t))])))
}

#[test]
fn the_sample_time_and_the_gain_have_the_same_limit() {
    // The limit of the gain at T = 1, as a number: then the limit of T is 1 but for what the number was rounded by.
    let p = motor_in_time("2.3922111911773328143765528784798");
    let set = stable(&p, &Range::between(Some(Rational::ZERO), Some(Rational::from(5))));
    let found = ends(&set, 20);
    assert_eq!(found, [["0 z=1+domain".to_owned(), "1.0000000000000000000 complex pair".to_owned()]]);
    assert!(set.undecided().is_empty());
    let pair = set.intervals()[0].upper.as_ref().unwrap().pair.as_ref().unwrap();
    assert_eq!(pair.angle(64).unwrap().decimal(7).unwrap(), "1.324393");
}

#[test]
fn a_sample_time_that_is_stable_up_to_the_end_of_the_domain_ends_there() {
    let set = stable(&motor_in_time("1"), &Range::between(Some(Rational::ZERO), Some(Rational::from(2))));
    assert_eq!(ends(&set, 12), [["0 z=1+domain".to_owned(), "2 domain".to_owned()]]);
}

/// `1/(s^2 + s/5 + 1)` behind a hold with a constant gain in the loop; the sample time is the parameter.
fn resonance_in_time(gain: &str) -> SymbolicPolynomial {
    let [t, a, b] = [0, 1, 2].map(RationalFunction::variable);
    let equation = ["1", "1/5", "1"].map(|c| RationalFunction::from(number(c))).to_vec();
    let solution = |index| Definition::Fundamental { polynomial: equation.clone(), index, time: t.clone() };
    let symbols = MovingSymbols::new(vec![("a".into(), solution(0)), ("b".into(), solution(1))]);
    // exp(A T) = [[a, b], [-b, a - b/5]]; the input adds (1 - a, b).
    let fifth = RationalFunction::from(number("1/5"));
    let (one, gain) = (RationalFunction::one(), RationalFunction::from(number(gain)));
    let entries = [[a.clone(), b.clone()], [-&b, &a - &(&b * &fifth)]];
    let input = [&one - &a, b.clone()];
    let closed = |i: usize, j: usize| {
        let feedback = if j == 0 { &gain * &input[i] } else { RationalFunction::zero() };
        &entries[i][j] - &feedback
    };
    let trace = &closed(0, 0) + &closed(1, 1);
    let determinant = &(&closed(0, 0) * &closed(1, 1)) - &(&closed(0, 1) * &closed(1, 0));
    let variables = ["T", "a", "b"].map(String::from).to_vec();
    let coefficients = vec![determinant, -trace, one];
    let d = CharacteristicPolynomial { variables, coefficients, formal_degree: 2, poles: Vec::new(), monic: true };
    SymbolicPolynomial::with_moving(&d, &Arc::new(symbols))
}

#[test]
fn sample_times_are_decided_out_to_infinity_where_all_modes_die_away() {
    let range = Range::between(Some(Rational::ZERO), None);
    // Negative feedback of one half: windows, and in the end the static gain 1/2 in the loop is stable.
    let p = resonance_in_time("1/2");
    let set = stable(&p, &range);
    assert!(set.undecided().is_empty());
    let last = set.intervals().last().unwrap();
    assert!(last.lower.is_some() && last.upper.is_none());
    // Counts on a sweep agree with the intervals.
    for k in 1..200 {
        let t = number(&format!("{k}/7"));
        let at = p.at(&t, Shape::UnitDisc, &Budget::unlimited()).unwrap();
        let all = matches!(at, AtPoint::Defined { count, .. } if count.inside == 2);
        assert_eq!(set.contains(&t), all, "T = {t}");
    }
    // A static gain above 1: unstable in the end.
    let set = stable(&resonance_in_time("3/2"), &range);
    assert!(set.intervals().iter().all(|i| i.upper.is_some()));
}

/// Coefficients that are polynomials of low degree in the gain and two symbols.
fn random_loop(order: usize, seed: &mut u64) -> SymbolicPolynomial {
    let mut next = |count: u64| {
        *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        Integer::from((*seed >> 40) % count)
    };
    let mut symbols = Symbols::new();
    symbols.insert("X", Definition::exponential(number("-3/5")));
    symbols.insert("t", Definition::tangent(number("2/7")));
    let [k, x, t] = [0, 1, 2].map(RationalFunction::variable);
    let mut coefficient = |size: u64| {
        let mut number =
            || RationalFunction::from(Rational::new(next(2 * size + 1) - Integer::from(size), Integer::from(9)));
        let (a, b, c) = (number(), number(), number());
        &(&a + &(&b * &x)) + &(&c * &(&x * &t))
    };
    // A stable polynomial without the gain: z^n and little else.
    let mut list: Vec<RationalFunction> = (0..order).map(|_| &coefficient(2) + &(&k * &coefficient(9))).collect();
    list.push(RationalFunction::one());
    looped(list, symbols)
}

#[test]
fn limits_by_enclosed_resultants_are_those_by_expanded_ones() {
    let mut seed = 5;
    let mut limits = 0;
    for order in [2, 3, 4, 4, 5, 6] {
        let p = random_loop(order, &mut seed);
        let Table::Fixed(symbols) = &p.symbols else { unreachable!() };
        let by = |most| {
            set_over(&p, symbols, &Range::all(), Shape::UnitDisc, Way::Expanding(most), &Budget::unlimited()).unwrap()
        };
        let (enclosed, expanded) = (by(0), by(u64::MAX));
        assert_eq!(ends(&enclosed, 25), ends(&expanded, 25), "order {order}");
        limits += ends(&enclosed, 3).len();
    }
    assert!(limits > 3);
}

#[test]
fn zeros_at_either_end_of_an_enclosed_resultant_are_known() {
    // (z - 1)^2 (z - X) z + K (z - 9/10) z: a double integrator at K = 0; at infinity 0 and 9/10 are zeros, two roots go off.
    let mut symbols = Symbols::new();
    symbols.insert("X", Definition::exponential(-1));
    let (k, x, one) = (RationalFunction::variable(0), RationalFunction::variable(1), RationalFunction::one());
    let two = &one + &one;
    let zero = RationalFunction::from(number("9/10"));
    let list = vec![RationalFunction::zero(), -&(&x + &(&k * &zero)), &(&one + &(&two * &x)) + &k, -&(&two + &x), one];
    let p = looped(list, symbols);
    let Table::Fixed(symbols) = &p.symbols else { unreachable!() };
    let pair = Arc::new(pair::Pair::of(&p.pair(Shape::UnitDisc)));
    let resultant = resultant::PairResultant::new(&pair, symbols, false, &Budget::unlimited()).unwrap();
    assert!(resultant.vanishes_at_zero());
    let by = |most| {
        set_over(&p, symbols, &Range::all(), Shape::UnitDisc, Way::Expanding(most), &Budget::unlimited()).unwrap()
    };
    assert_eq!(ends(&by(0), 25), ends(&by(u64::MAX), 25));
    assert!(!by(0).is_empty());
}

#[test]
fn a_time_constant_is_decided_down_to_zero_where_its_mode_dies_away() {
    // A lag 1/(L s + 1) behind a hold with T = 1 and a gain: z - X + K (1 - X) with X = exp(-1/L), stable for X (1 + K) > K - 1.
    let [l, x] = [0, 1].map(RationalFunction::variable);
    let one = RationalFunction::one();
    let symbols = MovingSymbols::new(vec![("X".into(), Definition::Exponential(-&l.recip().unwrap()))]);
    let table = Arc::new(symbols);
    for (gain, limit) in [("3", Some("1.4426950408889634074 z=-1")), ("1/2", None)] {
        let gain = RationalFunction::from(number(gain));
        let coefficients = vec![&(&gain * &(&one - &x)) - &x, one.clone()];
        let variables = vec!["L".to_owned(), "X".to_owned()];
        let d = CharacteristicPolynomial { variables, coefficients, formal_degree: 1, poles: Vec::new(), monic: true };
        let p = SymbolicPolynomial::with_moving(&d, &table);
        let set = stable(&p, &Range::between(Some(Rational::ZERO), Some(Rational::from(10))));
        assert!(set.undecided().is_empty(), "{:?}", set.undecided());
        let lower = ends(&set, 20)[0][0].clone();
        // 1/ln 2 for a gain of 3.
        assert_eq!(lower, limit.unwrap_or("0 domain"));
    }
}

/// Else the two numbers are compared to thousands of bits, and a bracket stays.
#[test]
fn a_function_that_is_given_twice_has_its_zeros_once() {
    let [k, x] = [0, 1].map(MultiPoly::variable);
    let symbols =
        Arc::new(MovingSymbols::new(vec![("X".into(), Definition::Exponential(-&RationalFunction::variable(0)))]));
    // Res(u - K, u - X) with X = exp(-K).
    let f = Function::resultant(vec![k.negated(), MultiPoly::one()], vec![x.negated(), MultiPoly::one()]);
    let range = Range::between(Some(Rational::ZERO), Some(Rational::from(2)));
    let all = |_: &Real| true;
    let (zeros, open) =
        zeros_of_functions(vec![f.clone(), f], &symbols, &range, &Rational::ONE, &all, &Budget::unlimited()).unwrap();
    let found: Vec<_> = zeros.iter().map(|(value, of)| (value.decimal(10), of.clone())).collect();
    assert_eq!(found, [("0.5671432904".to_string(), vec![0, 1])]);
    assert!(open.is_empty(), "{open:?}");
}

/// Curves that touch at infinity leave more zero coefficients than they have common roots there; this ended with the last precision.
#[test]
fn zero_coefficients_of_curves_that_are_tangent_at_infinity_are_known() {
    // x y = x^2 + X and x y = x^2 + 2 X: both follow y = x, and their resultant is X x up to the sign.
    let mut symbols = Symbols::new();
    symbols.insert("X", Definition::exponential(-1));
    let (x, constant) = (MultiPoly::variable(0), MultiPoly::variable(1));
    let curve = |k: i64| vec![x.power(2).plus(&constant.scaled_by(&Integer::from(k))).negated(), x.clone()];
    let found = resultant::PairResultant::of_curves(curve(1), curve(2), &Arc::new(symbols), &Budget::unlimited());
    let coefficients = found.unwrap().enclose(64);
    assert!(coefficients.len() == 1 && !coefficients[0].contains_zero());
}
