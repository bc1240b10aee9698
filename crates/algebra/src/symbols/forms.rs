//! A function in forms that are evaluated with less cancellation.
//!
//! Where a sampling period is short, `exp(-a T)` is about 1, and a boundary function such as `1 - exp(-a T) - a T` is small because
//! terms of about 1 cancel. Bits make up for that at a point; over an interval of the parameter every term varies, and only very short
//! intervals are decided. So each symbol is also written as the first terms of its series in time and what is left, which is small: the
//! first terms cancel in the polynomial, once and exactly.
//!
//! A resultant is taken in its unknown `x` and in `x - 2`: that is small for roots near `z = 1`, `x = z + 1/z`, as most are where the
//! sampling period is short.

use super::function::polynomial_at;
use super::horner::Scheme;
use super::scales::exponent;
use super::{Definition, Function, MovingSymbols};
use crate::ball::{Ball, Elementary, Known, Series, TaylorModel};
use crate::number::{Integer, Rational};
use crate::poly::{Domain, MultiPoly, RationalFunction};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

/// The powers of time up to which symbols are expanded.
const ORDERS: std::ops::RangeInclusive<u32> = 0..=3;

/// A form has at most so many times the terms of the function, and so many more.
const MOST_GROWTH: u64 = 4;
const MOST_MORE: u64 = 300;

/// So many forms are kept for a range of the parameter.
const KEPT: usize = 3;

/// Bits of the interval on which cancellation is measured.
const MEASURED: u64 = 64;

/// A function with what its symbols stand for.
#[derive(Debug)]
pub(super) struct Form {
    function: Function,
    /// By symbol: `q` times the symbol less `p` is the variable; none where it is the symbol.
    starts: Vec<Option<Start>>,
    /// The function has been multiplied by these powers of `q`, and divided by a number of so many bits.
    powers: Vec<u64>,
    divided: i64,
    scheme: Scheme,
}

/// The first terms of a symbol: `p/q`, with `q` a positive number times a power of the parameter.
#[derive(Clone, Debug)]
struct Start {
    p: MultiPoly,
    q: MultiPoly,
}

/// The forms of a function, the function itself first.
#[derive(Debug)]
pub(super) struct Forms {
    list: Vec<Form>,
    /// By the exponent and the sign of the parameter.
    best_of_octave: Mutex<BTreeMap<(i64, bool), usize>>,
}

impl Form {
    /// The function at series of the parameter and the symbols, up to a factor that is not zero in an interval in which the parameter
    /// keeps its sign.
    pub fn at_series<S: Elementary>(&self, values: &[S]) -> S {
        self.scheme.at(&self.arguments(values))
    }

    /// The same up to a power of two, in short numbers; `None` where they are too short.
    pub fn at_short(&self, values: &[TaylorModel]) -> Option<Known> {
        self.scheme.at_short(&self.arguments(values))
    }

    fn new(function: Function, starts: Vec<Option<Start>>, powers: Vec<u64>, divided: i64) -> Form {
        let scheme = Scheme::of(&function);
        Form { function, starts, powers, divided, scheme }
    }

    /// The parameter, and what stands for the symbols.
    fn arguments<'v, S: Elementary>(&self, values: &'v [S]) -> Cow<'v, [S]> {
        if self.starts.iter().all(Option::is_none) {
            return Cow::Borrowed(values);
        }
        let of_symbol = |(start, value): (&Option<Start>, &S)| match start {
            None => value.clone(),
            Some(start) => value.times(&polynomial_at(&start.q, values)).minus(&polynomial_at(&start.p, values)),
        };
        let rest = self.starts.iter().zip(&values[1..]).map(of_symbol);
        std::iter::once(values[0].clone()).chain(rest).collect()
    }

    /// Bits of the factor at a value of the parameter.
    fn factor_bits(&self, parameter: &Ball) -> i64 {
        let values = [Series::constant(parameter, 1)];
        let bits = |start: &Start| {
            let q = &polynomial_at(&start.q, &values).coefficients()[0].magnitude_units();
            q.bit_length() as i64 - parameter.bits() as i64
        };
        let all = self.starts.iter().zip(&self.powers);
        all.filter_map(|(start, power)| start.as_ref().map(|s| bits(s) * *power as i64)).sum::<i64>() - self.divided
    }
}

impl Forms {
    /// The forms of a function over a table.
    ///
    /// Cost: for each order, products of polynomials.
    pub fn of(symbols: &MovingSymbols, f: &Function) -> Forms {
        let nothing = || vec![None; symbols.table().len()];
        let mut forms = vec![Form::new(f.clone(), nothing(), Vec::new(), 0)];
        let about = about_two(f);
        forms.extend(about.iter().map(|f| Form::new(f.clone(), nothing(), Vec::new(), 0)));
        for order in ORDERS {
            let starts: Vec<Option<Start>> = symbols.table().iter().map(|(_, d)| start(d, order)).collect();
            let texts =
                |starts: &[Option<Start>]| starts.iter().map(|s| s.as_ref().map(|s| s.p.clone())).collect::<Vec<_>>();
            if forms.iter().any(|known| texts(&known.starts) == texts(&starts)) {
                continue;
            }
            forms.extend(about.iter().filter_map(|f| rewritten(f, starts.clone())));
            forms.extend(rewritten(f, starts));
        }
        Forms { list: forms, best_of_octave: Mutex::default() }
    }

    /// The function itself and the two forms that are best around a value of the parameter.
    pub fn best_around(mut self, symbols: &MovingSymbols, x: &Rational, terms: usize) -> Forms {
        if let Some(costs) = self.costs(symbols, x, terms) {
            let mut forms: Vec<(i64, Form)> = costs.into_iter().zip(std::mem::take(&mut self.list)).collect();
            forms[1..].sort_by_key(|(cost, _)| *cost);
            forms.truncate(KEPT);
            let best = (0..forms.len()).min_by_key(|&i| forms[i].0).unwrap_or(0);
            self.best_of_octave = Mutex::new([((exponent(x), x.is_negative()), best)].into());
            self.list = forms.into_iter().map(|(_, form)| form).collect();
        }
        self.list.truncate(KEPT);
        self
    }

    /// The form that is likely to decide the longest interval for its cost, around this one.
    pub fn best(&self, symbols: &MovingSymbols, lo: &Rational, hi: &Rational, terms: usize) -> &Form {
        let middle = lo.midpoint(hi);
        // The factors of forms may have a zero at 0.
        if self.list.len() == 1 || middle.is_zero() || lo.sign() != hi.sign() {
            return &self.list[0];
        }
        // What cancels is about the same over an octave.
        let (octave, is_negative) = (exponent(&middle), middle.is_negative());
        let mut known = self.best_of_octave.lock().unwrap_or_else(PoisonError::into_inner);
        let best = known.entry((octave, is_negative)).or_insert_with(|| {
            let size = Rational::from(2).pow(octave).expect("two is not zero");
            let costs = self.costs(symbols, &if is_negative { -size } else { size }, terms).unwrap_or_default();
            costs.iter().enumerate().min_by_key(|(_, cost)| **cost).map_or(0, |(i, _)| i)
        });
        &self.list[*best]
    }

    /// For each form the logarithm of its cost, in quarters of bits and times the number of terms; `None` where nothing has a value.
    fn costs(&self, symbols: &MovingSymbols, x: &Rational, terms: usize) -> Option<Vec<i64>> {
        let width = x.abs() * Rational::dyadic(&Integer::ONE, MEASURED);
        // As many bits after the point for a short sampling period as for the unit.
        let bits = 4 * MEASURED + 2 * exponent(x).min(0).unsigned_abs();
        let parameter = Ball::between(&(x - &width), &(x + &width), bits);
        let values = symbols.series(&Series::constant(&parameter, 1))?;
        // The interval that is decided is shorter by the power 1/terms of what cancels.
        let cost = |form: &Form| {
            let noise = form.at_series(&values).coefficients()[0].width_units().bit_length() as i64;
            let size = i64::from(u128::from(form.function.size()).saturating_pow(4).ilog2());
            4 * (noise - form.factor_bits(&parameter)) + size * terms as i64
        };
        Some(self.list.iter().map(cost).collect())
    }
}

/// The resultant of the same polynomials in the unknown less 2; `None` where there is no unknown.
fn about_two(f: &Function) -> Option<Function> {
    let Function::Resultant { a, b } = f else { return None };
    let moved = |list: &[MultiPoly]| {
        let mut out = list.to_vec();
        for from in 0..out.len() {
            for i in (from..out.len() - 1).rev() {
                out[i] = out[i].plus(&out[i + 1].scaled_by(&Integer::from(2)));
            }
        }
        out
    };
    Some(Function::Resultant { a: moved(a), b: moved(b) })
}

/// The first terms of a symbol in powers of time; `None` where they are no polynomial over a power of the parameter.
fn start(definition: &Definition, order: u32) -> Option<Start> {
    let mut sum = RationalFunction::zero();
    let mut found = None;
    let mut add = |term: RationalFunction| -> bool {
        sum = &sum + &term;
        let start = Start { p: sum.numerator().clone(), q: sum.denominator().clone() };
        let fits = is_monomial(&start.q);
        if fits && !start.p.is_zero() {
            found = Some(start);
        }
        fits
    };
    let over_factorial = |power: RationalFunction, k: u32| {
        (1..=k).fold(power, |t, j| &t * &Rational::new(Integer::ONE, j.into()).into())
    };
    match definition {
        Definition::Exponential(x) => {
            for k in 0..=order {
                if !add(over_factorial(x.pow(i64::from(k))?, k)) {
                    break;
                }
            }
        }
        Definition::Tangent { square, time } => {
            if order >= 1 && add(time.clone()) && order >= 3 {
                let cube = &(square * &time.pow(3)?) * &Rational::new(Integer::ONE, 3.into()).into();
                add(cube);
            }
        }
        Definition::Fundamental { polynomial, index, time } => {
            let n = polynomial.len() - 1;
            let mut derivatives: Vec<RationalFunction> = Vec::new();
            for k in 0..=order as usize {
                let next = if k < n {
                    if k == *index { RationalFunction::one() } else { RationalFunction::zero() }
                } else {
                    (0..n).fold(RationalFunction::zero(), |s, i| &s - &(&polynomial[i] * &derivatives[k - n + i]))
                };
                derivatives.push(next);
                if !derivatives[k].is_zero() && !add(over_factorial(&derivatives[k] * &time.pow(k as i64)?, k as u32)) {
                    break;
                }
            }
        }
        // What a pulse adds beside its mean is small in a short period.
        Definition::Duty(duty) => {
            if order >= 1 {
                add(duty.mean.clone());
            }
        }
        Definition::Pi
        | Definition::Algebraic(_)
        | Definition::Enclosed(_)
        | Definition::Root(_)
        | Definition::Family(_) => {}
    }
    found
}

/// Whether a polynomial is a positive number times a power of the parameter.
fn is_monomial(q: &MultiPoly) -> bool {
    let [(_, c)] = q.terms() else { return false };
    c.sign().is_gt() && q.variables().iter().all(|&i| i == 0)
}

/// The function in what is left of the symbols; `None` where it has far more terms.
fn rewritten(f: &Function, starts: Vec<Option<Start>>) -> Option<Form> {
    let most = f.size() * MOST_GROWTH + MOST_MORE;
    let (lists, orders): (Vec<Vec<MultiPoly>>, Vec<u64>) = match f {
        Function::Polynomial(p) => (vec![vec![p.clone()]], vec![1]),
        // A factor of all coefficients of one polynomial comes out by the degree of the other.
        Function::Resultant { a, b } => (vec![a.clone(), b.clone()], vec![b.len() as u64 - 1, a.len() as u64 - 1]),
    };
    let mut powers = vec![0; starts.len()];
    let mut divided = 0;
    let mut out: Vec<Vec<MultiPoly>> = Vec::new();
    for (mut list, times) in lists.into_iter().zip(orders) {
        // From the last symbol: the first terms of one may have earlier ones.
        for (i, start) in starts.iter().enumerate().rev() {
            let Some(start) = start else { continue };
            let degree = list.iter().map(|p| p.degree_in(i + 1)).max().unwrap_or(0);
            if degree == 0 {
                continue;
            }
            powers[i] += u64::from(degree) * times;
            list = list.iter().map(|p| put(p, i + 1, start, degree)).collect();
            if list.iter().map(|p| p.terms().len() as u64).sum::<u64>() > most {
                return None;
            }
        }
        let content = list.iter().fold(Integer::ZERO, |g, p| g.gcd(&p.integer_content()));
        if !content.is_zero() {
            divided += content.bit_length() as i64 * times as i64;
            list = list.iter().map(|p| p.div_exact_integer(&content).expect("a content")).collect();
        }
        out.push(list);
    }
    let function = match (f, out.pop()?, out.pop()) {
        (Function::Polynomial(_), mut list, _) => Function::Polynomial(list.pop()?),
        (Function::Resultant { .. }, b, Some(a)) => Function::Resultant { a, b },
        _ => return None,
    };
    Some(Form::new(function, starts, powers, divided))
}

/// `q^degree f` with `(p + x)/q` in place of the variable.
fn put(f: &MultiPoly, variable: usize, start: &Start, degree: u32) -> MultiPoly {
    let parts = f.as_poly_in(variable);
    let image = start.p.plus(&MultiPoly::variable(variable));
    let mut scale = MultiPoly::one();
    let mut sum = MultiPoly::zero();
    for k in (0..=degree as usize).rev() {
        sum = sum.times(&image).plus(&parts.coeff(k).times(&scale));
        scale = scale.times(&start.q);
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::parse_number;

    fn number(text: &str) -> Rational {
        parse_number(text).unwrap()
    }

    /// `exp(-2 T)`, `exp(-1/T)`, and both solutions of `y'' + 3 y' + T y = 0` at the time `T`.
    fn table() -> MovingSymbols {
        let t = RationalFunction::variable(0);
        let constant = |n: i64| RationalFunction::from(Rational::from(n));
        let polynomial = vec![t.clone(), constant(3), constant(1)];
        let solution = |index| Definition::Fundamental { polynomial: polynomial.clone(), index, time: t.clone() };
        let list = [
            Definition::Exponential(&constant(-2) * &t),
            Definition::Exponential(-&t.recip().unwrap()),
            solution(0),
            solution(1),
        ];
        MovingSymbols::new(list.into_iter().enumerate().map(|(i, d)| (format!("x{i}"), d)).collect())
    }

    #[test]
    fn forms_are_multiples_of_the_function() {
        let symbols = table();
        let [t, x, y, c, s] = [0, 1, 2, 3, 4].map(MultiPoly::variable);
        let product = x.times(&c).minus(&y.times(&y).times(&s)).plus(&t.times(&s));
        let resultant = Function::resultant(vec![x.clone(), c.clone(), MultiPoly::one()], vec![s.minus(&t), y.clone()]);
        for f in [Function::from(product), Function::from(x.minus(&MultiPoly::one())), resultant] {
            let forms = Forms::of(&symbols, &f);
            assert!(forms.list.len() > 2, "{}", forms.list.len());
            for form in &forms.list {
                // Value over value and over the factors, which is the same number everywhere.
                let ratio = |at: &str| {
                    let parameter = Ball::from_rational(&number(at), 256);
                    let values = symbols.series(&Series::constant(&parameter, 1)).unwrap();
                    let value = |s: &Series| s.coefficients()[0].clone();
                    let mut ratio = value(&form.at_series(&values)).div(&value(&f.at_series(&values))).unwrap();
                    for (start, power) in form.starts.iter().zip(&form.powers) {
                        let Some(start) = start else { continue };
                        let q = value(&polynomial_at(&start.q, &values)).power(*power);
                        ratio = ratio.div(&q).unwrap();
                    }
                    ratio
                };
                let (one, two) = (ratio("1/3"), ratio("5/4"));
                assert!(one.intersection(&two).is_some() && !one.contains_zero(), "{form:?}");
                assert!(one.union(&two).width_units().bit_length() < 128, "{form:?}");
            }
        }
    }

    /// `1 - exp(-2 T) - 2 T` is small of second order: terms of about 1 are gone from its second form.
    #[test]
    fn what_cancels_is_gone_from_the_form_that_is_chosen() {
        let symbols = table();
        let [t, x] = [0, 1].map(MultiPoly::variable);
        let f = Function::from(MultiPoly::one().minus(&x).minus(&t).minus(&t));
        let forms = Forms::of(&symbols, &f);
        let (lo, hi) = (number("0.001"), number("0.0011"));
        let best = forms.best(&symbols, &lo, &hi, 12);
        assert!(!std::ptr::eq(best, &forms.list[0]));
        assert_eq!(best.function, Function::from(x.negated()));
    }
}
