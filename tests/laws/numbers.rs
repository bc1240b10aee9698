//! Laws of the numbers: ring and field axioms, num-bigint as a second opinion, reading and printing.

use crate::helpers::number::number;
use jurist_algebra::number::strategies::{integer, nonzero_integer, nonzero_rational, rational};
use jurist_algebra::number::{
    Enclosure, Integer, Rational, enclosed_decimal, to_decimal, to_decimal_refining, to_scientific,
};
use num_bigint::BigInt;
use num_rational::Ratio;
use num_traits::{Signed, Zero};
use proptest::prelude::*;

fn big(n: &Integer) -> BigInt {
    // By text, so that the limb-wise conversions are checked too.
    n.to_string().parse().unwrap()
}

fn ratio(v: &Rational) -> Ratio<BigInt> {
    Ratio::new(big(&v.numerator()), big(&v.denominator()))
}

fn gcd(mut a: BigInt, mut b: BigInt) -> BigInt {
    while !b.is_zero() {
        (a, b) = (b.clone(), a % b);
    }
    a.abs()
}

/// A unit in the last of `digits` places of `v`, found by counting the powers of ten up to `|v|`.
fn unit_in_last_place(v: &Rational, digits: i64) -> Rational {
    let ten = Rational::from(10);
    let mut power = Rational::ONE;
    while power > v.abs() {
        power = power.checked_div(&ten).unwrap();
    }
    while &power * &ten <= v.abs() {
        power *= &ten;
    }
    power * ten.pow(1 - digits).unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn integers_form_a_ring(a in integer(), b in integer(), c in integer()) {
        prop_assert_eq!(&a + &b, &b + &a);
        prop_assert_eq!(&a * &b, &b * &a);
        prop_assert_eq!((&a + &b) + &c, &a + (&b + &c));
        prop_assert_eq!((&a * &b) * &c, &a * (&b * &c));
        prop_assert_eq!(&a * (&b + &c), &a * &b + &a * &c);
        prop_assert_eq!(&a + Integer::ZERO, a.clone());
        prop_assert_eq!(&a * Integer::ONE, a.clone());
        prop_assert!((&a + (-&a)).is_zero());
        prop_assert_eq!(&a - &b, &a + (-&b));
    }

    #[test]
    fn divisors_common_with_a_power_of_two(a in integer(), odd in integer(), power in 0u64..300, more in 0u64..300) {
        let (y, b) = (Integer::ONE << power, (&odd * &a) << more);
        for x in [&a, &b, &-&b, &Integer::ZERO, &(Integer::ONE << more)] {
            let expected = gcd(big(x), big(&y));
            prop_assert_eq!(big(&x.gcd(&y)), expected.clone());
            prop_assert_eq!(big(&y.gcd(x)), expected.clone());
            prop_assert_eq!(big(&x.gcd(&-&y)), expected);
        }
    }

    #[test]
    fn integers_agree_with_num_bigint(a in integer(), b in nonzero_integer(), m in 1u64..) {
        let (x, y) = (big(&a), big(&b));
        prop_assert_eq!(big(&(&a + &b)), &x + &y);
        prop_assert_eq!(big(&(&a - &b)), &x - &y);
        prop_assert_eq!(big(&(&a * &b)), &x * &y);
        prop_assert_eq!(a.cmp(&b), x.cmp(&y));
        prop_assert_eq!(big(&a.gcd(&b)), gcd(x.clone(), y.clone()));
        prop_assert_eq!((&a * &b).div_exact(&b), a.clone());
        prop_assert_eq!(a.divisible_by(&b), (&x % &y).is_zero());
        prop_assert_eq!(a.bit_length(), x.bits());
        prop_assert_eq!(a.trailing_zeros(), x.trailing_zeros());
        prop_assert_eq!(big(&a.abs().sqrt_floor()), x.abs().sqrt());
        prop_assert_eq!(BigInt::from(a.mod_u64(m)), ((&x % m) + m) % m);
        prop_assert_eq!(big(&(&a >> 37)), &x >> 37u32);
        prop_assert_eq!(big(&(&a << 101)), &x << 101u32);
        prop_assert_eq!(a.gcd(&b) * a.lcm(&b), (&a * &b).abs());
    }

    #[test]
    fn floored_division(a in integer(), b in nonzero_integer()) {
        let (q, r) = a.div_mod_floor(&b);
        prop_assert_eq!(&q * &b + &r, a);
        prop_assert!(r.abs() < b.abs());
        prop_assert!(r.is_zero() || r.is_negative() == b.is_negative());
    }

    #[test]
    fn fused_products(a in integer(), b in integer(), c in integer()) {
        let (mut sum, mut difference) = (a.clone(), a.clone());
        sum.add_mul_assign(&b, &c);
        difference.sub_mul_assign(&b, &c);
        prop_assert_eq!(sum, &a + &b * &c);
        prop_assert_eq!(difference, &a - &b * &c);
    }

    #[test]
    fn rationals_form_a_field(a in rational(), b in nonzero_rational(), c in rational()) {
        prop_assert_eq!(&a + &b, &b + &a);
        prop_assert_eq!((&a + &b) + &c, &a + (&b + &c));
        prop_assert_eq!((&a * &b) * &c, &a * (&b * &c));
        prop_assert_eq!(&a * (&b + &c), &a * &b + &a * &c);
        prop_assert_eq!(a.checked_div(&b).unwrap() * &b, a.clone());
        prop_assert!((&b * b.recip().unwrap()).is_one());
        prop_assert!(a.checked_div(&Rational::ZERO).is_none());
        prop_assert_eq!(a < c, (&a - &c).is_negative());
        prop_assert!(a.numerator().gcd(&a.denominator()).is_one() && !a.denominator().is_negative());
        let floor = Rational::from(a.floor());
        prop_assert!(floor <= a && a < floor + Rational::ONE);
        prop_assert_eq!(a.ceil(), -(-&a).floor());
        prop_assert_eq!(a.midpoint(&c) * Rational::from(2), &a + &c);
    }

    #[test]
    fn rationals_agree_with_num_rational(a in rational(), b in nonzero_rational()) {
        let (x, y) = (ratio(&a), ratio(&b));
        prop_assert_eq!(ratio(&(&a + &b)), &x + &y);
        prop_assert_eq!(ratio(&(&a - &b)), &x - &y);
        prop_assert_eq!(ratio(&(&a * &b)), &x * &y);
        prop_assert_eq!(ratio(&(&a / &b)), &x / &y);
        prop_assert_eq!(a.cmp(&b), x.cmp(&y));
    }

    #[test]
    fn conversions_keep_the_value(n in integer(), a in rational()) {
        prop_assert_eq!(BigInt::from(&n), big(&n));
        prop_assert_eq!(Integer::from(&big(&n)), n);
        prop_assert_eq!(Ratio::from(&a), ratio(&a));
        prop_assert_eq!(Rational::try_from(&ratio(&a)).unwrap(), a);
    }

    #[test]
    fn what_is_printed_in_full_reads_back(n in integer(), a in rational()) {
        prop_assert_eq!(n.to_string().parse::<Integer>().unwrap(), n.clone());
        prop_assert_eq!(a.to_string().parse::<Rational>().unwrap(), a);
        // At as many digits as an integer has, nothing is rounded.
        let digits = n.to_string().len();
        prop_assert_eq!(number(&to_decimal(&Rational::from(&n), digits)), Rational::from(&n));
        prop_assert_eq!(number(&to_scientific(&Rational::from(&n), digits)), Rational::from(&n));
    }

    #[test]
    fn decimals_are_rounded_correctly(a in nonzero_rational(), digits in 1usize..30) {
        for text in [to_decimal(&a, digits), to_scientific(&a, digits)] {
            let printed = number(&text);
            let twice_error = (&printed - &a).abs() * Rational::from(2);
            let ulp = unit_in_last_place(&a, digits as i64);
            prop_assert!(twice_error <= ulp, "{a} printed as {text}");
            let count = printed.checked_div(&ulp).unwrap();
            prop_assert!(count.is_integer(), "{text} has more than {digits} digits");
            prop_assert!(twice_error < ulp || count.numerator().is_even(), "the tie {a} was printed as {text}");
        }
    }

    #[test]
    fn notation_follows_the_rounded_magnitude(a in nonzero_rational(), digits in 1usize..30) {
        let text = to_decimal(&a, digits);
        let magnitude = number(&text).abs();
        prop_assert_eq!(!text.contains('e'), magnitude >= number("1e-6") && magnitude < number("1e15"));
    }

    #[test]
    fn an_enclosed_decimal_holds_for_all(a in rational(), width in 1i64..30, t in 0u32..=8, digits in 1usize..12) {
        let (lo, hi) = (a.clone(), &a + Rational::from(10).pow(-width).unwrap());
        let inside = &lo + (&hi - &lo) * Rational::new(Integer::from(t), Integer::from(8));
        if let Some(text) = enclosed_decimal(&lo, &hi, digits) {
            prop_assert_eq!(number(&text), number(&to_decimal(&inside, digits)));
        }
    }
}

/// An interval and a point of it.
fn interval() -> impl Strategy<Value = (Enclosure, Rational)> {
    (rational(), rational(), 0u32..=8).prop_map(|(a, b, t)| {
        let (lo, hi) = if a <= b { (a, b) } else { (b, a) };
        let inside = &lo + (&hi - &lo) * Rational::new(Integer::from(t), Integer::from(8));
        (Enclosure::new(lo, hi), inside)
    })
}

fn encloses(outer: &Enclosure, inner: &Enclosure) -> bool {
    outer.contains(inner.lower()) && outer.contains(inner.upper())
}

fn overlap(a: &Enclosure, b: &Enclosure) -> bool {
    a.lower() <= b.upper() && b.lower() <= a.upper()
}

fn exactly(value: &Rational) -> Enclosure {
    Enclosure::from_rational(value.clone())
}

/// The cosine by its own series with Lagrange's remainder: independent of the arc functions.
fn cosine(x: &Rational, bits: u64) -> Enclosure {
    let square = x * x;
    let (mut term, mut sum, mut k) = (Rational::ONE, Rational::ZERO, 0i64);
    let small = Rational::dyadic(&Integer::ONE, bits);
    // Beyond k > |x| the terms fall, and alternate: the first one left out bounds the rest.
    while term.abs() > small || Rational::from(k) < x.abs() {
        sum += &term;
        term = -(term * &square).checked_div(&Rational::from((2 * k + 1) * (2 * k + 2))).unwrap();
        k += 1;
    }
    Enclosure::new(&sum - term.abs(), sum + term.abs())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]

    #[test]
    fn enclosures_contain_the_exact_results((a, x) in interval(), (b, y) in interval(), bits in 1u64..100) {
        prop_assert!(encloses(&a.rounded(bits), &a));
        prop_assert!(a.add(&b, bits).contains(&(&x + &y)));
        prop_assert!(a.sub(&b, bits).contains(&(&x - &y)));
        prop_assert!(a.mul(&b, bits).contains(&(&x * &y)));
        match a.div(&b, bits) {
            Some(q) => prop_assert!(q.contains(&x.checked_div(&y).unwrap())),
            None => prop_assert!(b.contains(&Rational::ZERO)),
        }
        let root = exactly(&x.abs()).sqrt(bits);
        prop_assert!(root.lower() * root.lower() <= x.abs() && x.abs() <= root.upper() * root.upper());
    }

    /// The results of a part lie in the result of the whole.
    #[test]
    fn enclosures_are_inclusion_isotonic((a, x) in interval(), (b, y) in interval(), bits in 1u64..60) {
        let (part, other) = (exactly(&x), exactly(&y));
        prop_assert!(encloses(&a.rounded(bits), &part.rounded(bits)));
        prop_assert!(encloses(&a.add(&b, bits), &part.add(&other, bits)));
        prop_assert!(encloses(&a.sub(&b, bits), &part.sub(&other, bits)));
        prop_assert!(encloses(&a.mul(&b, bits), &part.mul(&other, bits)));
        if let Some(q) = a.div(&b, bits) {
            prop_assert!(encloses(&q, &part.div(&other, bits).unwrap()));
        }
        if !x.is_negative() {
            prop_assert!(encloses(&a.sqrt(bits), &part.sqrt(bits)));
        }
    }

    #[test]
    fn widths_shrink_with_the_bits(x in nonzero_rational(), bits in 8u64..80) {
        let narrow = |e: &Enclosure| (e.upper() - e.lower()) * Rational::from(&Integer::ONE << (bits - 4)) <= e.upper().abs();
        let x = exactly(&x.abs());
        prop_assert!(narrow(&x.rounded(bits)));
        prop_assert!(narrow(&x.sqrt(bits)));
        prop_assert!(narrow(&x.atan(bits)));
        let ln = x.ln(bits).unwrap();
        prop_assert!(narrow(&ln) || narrow(&ln.neg()));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn the_cosine_of_the_arc_cosine(n in -1000i64..=1000, e in 0u32..12) {
        // From everywhere in [-1, 1] to within 1e-15 of its ends.
        let near = Rational::from(n) * Rational::from(10).pow(-3 - i64::from(e)).unwrap();
        for x in [&near - &Rational::from(near.sign() as i64), near.clone()] {
            let angle = exactly(&x).acos(120);
            // The cosine falls on [0, pi].
            prop_assert!(*cosine(angle.upper(), 140).lower() <= x && x <= *cosine(angle.lower(), 140).upper());
        }
    }

    #[test]
    fn arc_functions_and_logarithms_agree_with_themselves(x in nonzero_rational(), y in nonzero_rational()) {
        let bits = 120;
        let (e, inverse) = (exactly(&x), exactly(&x.recip().unwrap()));
        // atan x + atan 1/x = ±pi/2
        let half_pi = Enclosure::pi(bits).mul(&exactly(&number("1/2")), bits);
        let half_pi = if x.is_negative() { half_pi.neg() } else { half_pi };
        prop_assert!(overlap(&e.atan(bits).add(&inverse.atan(bits), bits), &half_pi));
        // ln xy = ln x + ln y
        let (a, b) = (x.abs(), y.abs());
        let sum = exactly(&a).ln(bits).unwrap().add(&exactly(&b).ln(bits).unwrap(), bits);
        prop_assert!(overlap(&sum, &exactly(&(a * b)).ln(bits).unwrap()));
    }
}

#[test]
fn digits_of_an_angle_near_zero() {
    // acos(1 - e) = sqrt(2e) (1 + e/12 + 3e^2/160 + 5e^3/896 + 35e^4/18432 + ...), e = 5e-8: below e^5/1000 is left.
    let e = number("5e-8");
    let bits = 400;
    let mut series = Rational::ZERO;
    for c in ["35/18432", "5/896", "3/160", "1/12", "1"] {
        series = series * &e + number(c);
    }
    let root = exactly(&(&e * Rational::from(2))).sqrt(bits);
    let least = root.mul(&exactly(&series), bits);
    let most = root.mul(&exactly(&(series + number("1e-39"))), bits);
    let angle = exactly(&(Rational::ONE - &e)).acos(bits);
    assert!(least.lower() <= angle.lower() && angle.upper() <= most.upper());
    let relative_width = (angle.upper() - angle.lower()).checked_div(angle.lower()).unwrap();
    assert!(relative_width < number("1e-100"));
}

#[test]
fn a_tie_is_never_decided() {
    let around = |bits| {
        let d = Rational::dyadic(&Integer::ONE, bits);
        Some(Enclosure::new(number("1.25") - &d, number("1.25") + &d))
    };
    assert_eq!(to_decimal_refining(2, around), None);
    assert_eq!(to_decimal_refining(3, around).as_deref(), Some("1.25"));
}

/// Found when the rounding grid depended on how a number is written as a quotient.
#[test]
fn rounding_is_monotone_across_quotients() {
    for bits in 1..8 {
        for d in 1..24i64 {
            for n in 1..48i64 {
                let x = Rational::new(Integer::from(n), Integer::from(d));
                let below = &x - number("1e-9");
                let (low, high) = (exactly(&below).rounded(bits), exactly(&x).rounded(bits));
                assert!(low.lower() <= high.lower() && low.upper() <= high.upper(), "{x} to {bits} bits");
                let (low, high) = (exactly(&below).sqrt(bits), exactly(&x).sqrt(bits));
                assert!(low.lower() <= high.lower() && low.upper() <= high.upper(), "root of {x} to {bits} bits");
            }
        }
    }
}

#[test]
fn corpus_of_the_number_parser() {
    let limit = "9".repeat(500);
    for text in
        ["1e100000/3e-100000", "-0_0.1_2e-0_3", &limit, &format!("{limit}/{limit}1"), &format!("0.{limit}e-{limit}")]
    {
        jurist_fuzzing::number_parser(text.as_bytes());
    }
}

proptest! {
    #[test]
    fn the_number_parser_keeps_its_promises(text in "[-+0-9._eE/ é]{0,12}") {
        jurist_fuzzing::number_parser(text.as_bytes());
    }
}

#[test]
fn long_numbers_are_read_and_printed() {
    let long = "7".repeat(100_000);
    let value = number(&long);
    assert_eq!(to_decimal(&value, 5), "7.7778e99999");
    assert_eq!(value.to_string(), long);
    assert_eq!(to_decimal(&number(&format!("0.{long}")), 100_000), format!("0.{long}"));
}
