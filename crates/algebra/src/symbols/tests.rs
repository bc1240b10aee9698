use super::*;
use crate::limits::{Budget, Stop};
use crate::number::parse_number;
use crate::poly::{Domain, SquareFree, UniPoly};

fn number(text: &str) -> Rational {
    parse_number(text).unwrap()
}

fn symbol(s: &mut Symbols, definition: Definition) -> MultiPoly {
    MultiPoly::variable(s.insert("x", definition))
}

fn decimal(s: &Symbols, x: &MultiPoly) -> String {
    s.enclose(x, 200).to_enclosure().decimal(30).unwrap()
}

#[test]
fn known_values_of_functions() {
    let budget = Budget::unlimited();
    let mut s = Symbols::new();
    let pi = symbol(&mut s, Definition::Pi);
    let sixth = &RationalFunction::from(pi) * &RationalFunction::from(number("1/6"));
    let tan = symbol(&mut s, Definition::Tangent { square: RationalFunction::one(), time: sixth.clone() });
    let root = symbol(&mut s, Definition::root(3));
    let e = symbol(&mut s, Definition::exponential(1));
    let power = symbol(&mut s, Definition::Exponential(sixth));
    assert_eq!(decimal(&s, &e), "2.71828182845904523536028747135");
    assert_eq!(decimal(&s, &tan), "0.577350269189625764509148780502");
    assert_eq!(decimal(&s, &root), "1.73205080756887729352744634151");
    assert_eq!(decimal(&s, &power), "1.68809179496446860061684762810");
    // tan(pi/6) sqrt(3) = 1
    let x = tan.times(&root).minus(&MultiPoly::one());
    assert!(s.enclose(&x, 300).contains_zero());
    assert!(s.sign(&root.minus(&e), &budget).unwrap().is_lt());
    // tanh(1)
    let tanh = symbol(&mut s, Definition::Tangent { square: (-1).into(), time: 1.into() });
    assert_eq!(decimal(&s, &tanh), "0.761594155955764888119458282605");
}

#[test]
fn fundamental_solutions_of_a_product_are_those_of_its_factors() {
    // (D + 1)(D + 2)(D + 3): the last is (exp(-t) - 2 exp(-2 t) + exp(-3 t))/2
    let mut s = Symbols::new();
    let polynomial = [6, 11, 6, 1].map(RationalFunction::from).to_vec();
    let time = RationalFunction::from(number("7/5"));
    let last = symbol(&mut s, Definition::Fundamental { polynomial, index: 2, time });
    let powers = [-1, -2, -3].map(|k| symbol(&mut s, Definition::exponential(&number("7/5") * &Rational::from(k))));
    let two = Integer::from(2);
    let zero = last.scaled_by(&two).minus(&powers[0]).plus(&powers[1].scaled_by(&two)).minus(&powers[2]);
    let value = s.enclose(&zero, 400);
    assert!(value.contains_zero() && value.width_units().bit_length() < 10);
}

#[test]
fn zeros_by_relations_of_exponentials_are_proved() {
    let budget = Budget::unlimited();
    let mut s = Symbols::new();
    // exp(-2) and exp(-1) as symbols of their own.
    let (a, b) = (symbol(&mut s, Definition::exponential(-2)), symbol(&mut s, Definition::exponential(-1)));
    assert!(s.sign(&a.minus(&b.times(&b)), &budget).unwrap().is_eq());
    // exp(sqrt(2)) exp(sqrt(8)) = exp(sqrt(18))
    let roots = [2, 8, 18].map(|n| symbol(&mut s, Definition::root(n)));
    let powers = roots.map(|r| symbol(&mut s, Definition::Exponential(r.into())));
    let zero = powers[0].times(&powers[1]).minus(&powers[2]);
    assert!(s.sign(&zero, &budget).unwrap().is_eq());
    assert!(s.sign(&powers[0].minus(&powers[1]), &budget).unwrap().is_lt());
    // Nearly the same: exp(-2) and exp(-1)^2 with an exponent that is 10^-300 larger.
    let near = symbol(&mut s, Definition::exponential(&number("-2") + &number("1e-300")));
    assert!(s.sign(&near.minus(&b.times(&b)), &budget).unwrap().is_gt());
}

#[test]
fn tangents_satisfy_double_angles_and_the_hyperbolic_ones_are_exponentials() {
    let budget = Budget::unlimited();
    let mut s = Symbols::new();
    let mut at = |square: i64, time: &str| {
        symbol(&mut s, Definition::Tangent { square: square.into(), time: number(time).into() })
    };
    let (t, u, h) = (at(3, "1/10"), at(3, "1/5"), at(-1, "1/2"));
    // tan(2v) (1 - tan(v)^2) = 2 tan(v), with tan = sqrt(3) t
    let one = MultiPoly::one();
    let zero = u.times(&one.minus(&t.times(&t).scaled_by(&3.into()))).minus(&t.scaled_by(&2.into()));
    assert!(s.sign(&zero, &budget).unwrap().is_eq());
    assert!(s.sign(&u.minus(&t), &budget).unwrap().is_gt());
    // tanh(1/2) (e + 1) = e - 1
    let e = symbol(&mut s, Definition::exponential(1));
    let zero = h.times(&e.plus(&one)).minus(&e.minus(&one));
    assert!(s.sign(&zero, &budget).unwrap().is_eq());
}

#[test]
fn the_determinant_of_an_exponential_is_seen_to_be_that_of_the_trace() {
    let mut s = Symbols::new();
    let polynomial = [1, 1, 1].map(RationalFunction::from).to_vec();
    let fundamental = |index| Definition::Fundamental { polynomial: polynomial.clone(), index, time: 1.into() };
    let (a, b) = (symbol(&mut s, fundamental(0)), symbol(&mut s, fundamental(1)));
    let x = symbol(&mut s, Definition::exponential(-1));
    // a (a - b) + b^2 = exp(-1).
    let zero = a.times(&a.minus(&b)).plus(&b.times(&b)).minus(&x);
    assert!(s.sign(&zero, &Budget::unlimited()).unwrap().is_eq());
    let more = zero.plus(&a).minus(&b);
    assert!(s.sign(&more, &Budget::unlimited()).unwrap().is_ne());
}

#[test]
fn a_zero_that_is_not_recognised_ends_with_a_message() {
    let mut s = Symbols::new();
    // exp(sqrt(3 + 2 sqrt(2))) = exp(1 + sqrt(2)): exponents that are roots of roots are not told to be equal.
    symbol(&mut s, Definition::root(2));
    let a = RationalFunction::variable(0);
    let inner = &(&a + &a) + &RationalFunction::from(3);
    symbol(&mut s, Definition::Root(inner));
    let x = symbol(&mut s, Definition::Exponential(RationalFunction::variable(1)));
    let y = symbol(&mut s, Definition::Exponential(&RationalFunction::one() + &a));
    let zero = x.minus(&y);
    let refused = s.sign(&zero, &Budget::unlimited()).unwrap_err();
    assert_eq!(refused.stop, Stop::Precision(8192));
}

/// Symbols `exp(-T)` and, for `1 + y'' = 0`, cosine and sine of `T`.
fn moving() -> Arc<MovingSymbols> {
    let t = RationalFunction::variable(0);
    let circle = [1, 0, 1].map(RationalFunction::from).to_vec();
    let solution = |index| Definition::Fundamental { polynomial: circle.clone(), index, time: t.clone() };
    Arc::new(MovingSymbols::new(vec![
        ("X".into(), Definition::Exponential(-&t)),
        ("c".into(), solution(0)),
        ("s".into(), solution(1)),
    ]))
}

#[test]
fn zeros_of_exponential_polynomials_are_found() {
    let (symbols, budget) = (moving(), Budget::unlimited());
    let [t, x, c, s] = [0, 1, 2, 3].map(MultiPoly::variable);
    let zeros = |f: &MultiPoly, lo: &str, hi: &str| {
        let found = symbols.zeros_in(&f.clone().into(), &number(lo), &number(hi), &number(hi), &budget).unwrap();
        assert!(found.undecided.is_empty(), "{:?}", found.undecided);
        found.zeros.iter().map(|z| z.decimal(20)).collect::<Vec<_>>()
    };
    // sin(T) from 0, where it vanishes, to 10: pi, 2 pi, 3 pi.
    assert_eq!(zeros(&s, "0", "10"), ["3.1415926535897932385", "6.2831853071795864769", "9.4247779607693797154"]);
    // T - sin(T): of order three at 0, and no other zero.
    assert!(zeros(&t.minus(&s), "0", "10").is_empty());
    // cos(T) = T
    assert_eq!(zeros(&c.minus(&t), "0", "10"), ["0.73908513321516064166"]);
    // exp(-T) sin(T) = 1/10, twice
    let f = x.times(&s).scaled_by(&10.into()).minus(&MultiPoly::one());
    assert_eq!(zeros(&f, "0", "10").len(), 2);
}

#[test]
fn a_function_that_touches_zero_is_undecided_there_and_only_there() {
    let (symbols, budget) = (moving(), Budget::unlimited());
    let s = MultiPoly::variable(3);
    let found = symbols
        .zeros_in(&MultiPoly::one().minus(&s).into(), &number("1"), &number("3"), &number("2"), &budget)
        .unwrap();
    assert!(found.zeros.is_empty() && found.undecided.len() == 1);
    let (lo, hi) = &found.undecided[0];
    assert!(*lo < number("1.570796326794897") && number("1.570796326794896") < *hi && hi - lo < number("1e-12"));
}

/// `K^2 (X - K^2 r)` with `X = exp(-1)`, `r` the root of 2: the double zero at 0 is one of a function of `K^2`, and leaves nothing open.
#[test]
fn a_zero_at_the_end_of_a_function_of_a_square_is_seen_to_be_alone() {
    let root = crate::poly::isolate_real_roots(
        &SquareFree::new(UniPoly::from_i64(&[-2, 0, 1])).unwrap(),
        &Budget::unlimited(),
    )
    .unwrap()
    .pop()
    .unwrap();
    let table = vec![("X".to_owned(), Definition::exponential(-1)), ("r".to_owned(), Definition::Algebraic(root))];
    let symbols = Arc::new(MovingSymbols::new(table));
    let [k, x, r] = [0, 1, 2].map(MultiPoly::variable);
    let square = k.times(&k);
    let f = square.times(&x.minus(&square.times(&r)));
    let (zero, one) = (Rational::ZERO, Rational::ONE);
    let found = symbols.zeros_in(&f.into(), &zero, &one, &one, &Budget::unlimited()).unwrap();
    // sqrt(exp(-1)/sqrt(2))
    assert_eq!(found.zeros.iter().map(|z| z.decimal(20)).collect::<Vec<_>>(), ["0.51002945749382402528"]);
    assert!(found.undecided.is_empty(), "{:?}", found.undecided);
}

/// Where the parameter is negative, forms of a function may have its opposite sign: signs of the one and of the other say nothing together.
/// The zero is so near to an end that no Taylor polynomial tells the sign there.
#[test]
fn zeros_beside_an_end_are_found_where_the_parameter_is_negative() {
    let budget = Budget::unlimited();
    let inverse = RationalFunction::variable(0).recip().unwrap();
    let symbols = Arc::new(MovingSymbols::new(vec![("X".into(), Definition::Exponential(-&inverse))]));
    let (lower, upper) = (number("-1001"), number("-1000"));
    // T X - T + 1, about 1/(2 T) by cancellation, rises with T.
    let x = crate::ball::exp(&crate::ball::Ball::from_rational(&number("1/1001"), 400)).lower();
    let at_lower = &(&lower * &x) - &(&lower - &Rational::ONE);
    let tiny = Rational::from(10).pow(-46).unwrap();
    for (value, count) in [(&at_lower - &tiny, 1), (&at_lower + &tiny, 0)] {
        let (n, d) = (value.numerator(), value.denominator());
        let [t, x] = [0, 1].map(MultiPoly::variable);
        let less = t.times(&x).minus(&t).plus(&MultiPoly::one());
        let f = less.scaled_by(&d).minus(&MultiPoly::constant(n));
        let found = symbols.zeros_in(&f.into(), &lower, &upper, &number("-1000"), &budget).unwrap();
        assert_eq!((found.zeros.len(), found.undecided.len()), (count, 0), "{found:?}");
        if let Some(zero) = found.zeros.first() {
            assert!(zero.compare_rational(&(&lower + &number("1/1000000000000000000000000"))).is_lt());
        }
    }
}

/// Where a middle of its bracket is the zero no sign is ever known there.
#[test]
fn a_zero_in_the_middle_of_its_bracket_is_refined_without_end_of_bits() {
    let budget = Budget::unlimited();
    let t = RationalFunction::variable(0);
    let symbols = Arc::new(MovingSymbols::new(vec![("X".into(), Definition::Exponential(-&t))]));
    // exp(-T) - 1 + T^3, zero at T = 0 between bounds that are as far away.
    let [t, x] = [0, 1].map(MultiPoly::variable);
    let f = Function::from(x.minus(&MultiPoly::one()).plus(&t.times(&t).times(&t)));
    let (lower, upper) = (number("-1/2"), number("1/2"));
    let found = symbols.zeros_in(&f, &lower, &upper, &number("1/3"), &budget).unwrap();
    assert_eq!((found.zeros.len(), found.undecided.len()), (1, 0));
    assert_eq!(found.zeros[0].exact(), Some(Rational::ZERO));
}

/// The middle of a wide place is the zero itself, and the derivative is not known there.
#[test]
fn a_zero_in_the_middle_of_its_place_is_refined() {
    use super::horner::Scheme;
    use super::moving_root::MovingRoot;
    use crate::real::Enclosing;
    let exponential = Definition::Exponential(RationalFunction::variable(0));
    let symbols = Arc::new(MovingSymbols::new(vec![("X".into(), exponential)]));
    // (p - 30) exp(p)
    let f = &(&MultiPoly::variable(0) - &MultiPoly::from(30)) * &MultiPoly::variable(1);
    let function = Function::from(f);
    for (lower, upper) in [(8, 52), (29, 31), (30, 52), (30, 30)] {
        let place = Enclosure::new(Rational::from(lower), Rational::from(upper));
        let root = MovingRoot {
            symbols: Arc::clone(&symbols),
            scheme: Arc::new(Scheme::of(&function)),
            function: Arc::new(function.clone()),
            place,
            monotone: Rational::ONE,
            rising: std::sync::OnceLock::new(),
        };
        let found = root.enclose(48, None);
        assert!(found.contains(&Rational::from(30)), "{found:?}");
        assert!(found.upper() - found.lower() <= Rational::dyadic(&Integer::ONE, 48), "{found:?}");
    }
}

/// `exp(exp(T)) exp(-exp(T)) = 1` is beyond the normal form: that the zero is 1/2 is not proved, and its enclosures stand for it.
#[test]
fn a_rational_zero_that_nothing_proves_is_a_zero() {
    let exp = |x: RationalFunction| Definition::Exponential(x);
    let inner = RationalFunction::variable(1);
    let table = [("a", exp(RationalFunction::variable(0))), ("b", exp(inner.clone())), ("c", exp(-&inner))];
    let symbols = Arc::new(MovingSymbols::new(table.map(|(name, d)| (name.to_owned(), d)).to_vec()));
    let [t, b, c] = [0, 2, 3].map(MultiPoly::variable);
    let f = t.scaled_by(&2.into()).minus(&b.times(&c));
    let one = Rational::ONE;
    let found = symbols.zeros_in(&f.into(), &Rational::ZERO, &one, &one, &Budget::unlimited()).unwrap();
    let [zero] = &found.zeros[..] else { panic!("one zero") };
    assert!(found.undecided.is_empty() && zero.decimal(10) == "0.5000000000");
}
