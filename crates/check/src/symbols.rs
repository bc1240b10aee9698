//! The numbers that are not rational, as further variables: what a certificate says they stand for, and their values.

use super::clock::Clock;
use super::interval::{Interval, solutions};
use super::multivariate::{Fraction, Multi};
use super::number::{Q, Z};
use super::statement::{count, list, number, object};
use crate::format::Json;
use num_traits::{One, Signed, ToPrimitive, Zero};
use std::cell::OnceCell;
use std::collections::BTreeMap;

/// More bits are refused.
const MAX_BITS: usize = 1 << 15;

/// Powers and multiples of symbols beyond these are not looked for.
const MAX_MULTIPLE: i64 = 200;

/// What a symbol stands for.
#[derive(Clone, Debug, PartialEq)]
enum Symbol {
    /// `exp(x)`.
    Exponential(Q),
    /// `tan(sqrt(w) t)/sqrt(w)`, with `tanh` and `sqrt(-w)` for a negative `w`.
    Tangent { w: Q, t: Q },
    /// Entry `index` of [`solutions`].
    Solution { monic: Vec<Q>, t: Q, index: usize },
}

/// The table of a certificate. In polynomials over symbols variable 1 is the parameter and symbol `i` is variable `i + 2`.
pub(super) struct Table {
    pub bits: usize,
    symbols: Vec<Symbol>,
    /// Monic polynomials by whose solutions exponentials of matrices are written.
    modes: Vec<Vec<Q>>,
    values: OnceCell<Vec<Interval>>,
}

impl Table {
    /// No symbols: only powers of time.
    pub fn empty() -> Self {
        Table { bits: 64, symbols: Vec::new(), modes: Vec::new(), values: OnceCell::new() }
    }

    pub fn read(bits: &Json, symbols: &Json, modes: &Json) -> Result<Self, String> {
        let bits = count(bits, "'bits'")?;
        if !(64..=MAX_BITS).contains(&bits) {
            return Err(format!("'bits' is not from 64 to {MAX_BITS}"));
        }
        let symbols = list(symbols, "'symbols'")?.iter().map(symbol).collect::<Result<_, _>>()?;
        let modes = list(modes, "'modes'")?.iter().map(|m| monic(m, "a mode")).collect::<Result<_, _>>()?;
        Ok(Table { bits, symbols, modes, values: OnceCell::new() })
    }

    pub fn len(&self) -> usize {
        self.symbols.len()
    }

    /// The factors among the modes of a monic polynomial, with multiplicities, powers of `s` first.
    pub fn factored(&self, monic: &[Q]) -> Result<Vec<(Vec<Q>, usize)>, String> {
        let mut rest = monic.to_vec();
        let mut out = Vec::new();
        let s = vec![Q::zero()];
        for mode in std::iter::once(&s).chain(self.modes.iter().filter(|m| **m != s)) {
            let mut multiplicity = 0;
            while let Some(quotient) = quotient(&rest, mode) {
                rest = quotient;
                multiplicity += 1;
            }
            if multiplicity > 0 {
                out.push((mode.clone(), multiplicity));
            }
        }
        if rest.is_empty() { Ok(out) } else { Err("a held block has a mode that is not in 'modes'".into()) }
    }

    fn variable(i: usize, first: usize) -> Fraction {
        Fraction::variable(first + i)
    }

    /// `multiple_of` says which multiple of a symbol a number is. Returns the symbol with the smallest multiple, the first of equal ones, and
    /// that multiple.
    fn nearest(&self, multiple_of: impl Fn(&Symbol) -> Option<i64>) -> Option<(usize, i64)> {
        let multiples = self.symbols.iter().enumerate().filter_map(|(i, symbol)| Some((i, multiple_of(symbol)?)));
        multiples.min_by_key(|(_, k)| k.unsigned_abs())
    }

    /// `exp(x)` over the symbols, which are the variables from `first` on.
    pub fn exponential(&self, x: &Q, first: usize, clock: &Clock) -> Result<Fraction, String> {
        if x.is_zero() {
            return Ok(Fraction::number(&Q::one()));
        }
        let of = |symbol: &Symbol| match symbol {
            Symbol::Exponential(of) => multiple(x, of),
            _ => None,
        };
        let Some((i, k)) = self.nearest(of) else { return Err(format!("exp({x}) is not among 'symbols'")) };
        let power = Table::variable(i, first).power(k.unsigned_abs() as u32, clock)?;
        if k < 0 { power.inverse(clock) } else { Ok(power) }
    }

    /// `tan(sqrt(w) t)/sqrt(w)`, and everything that is divided by for it.
    pub fn tangent(&self, w: &Q, t: &Q, first: usize, clock: &Clock) -> Result<(Fraction, Vec<Multi>), String> {
        let nearest = self.nearest(|symbol| match symbol {
            Symbol::Tangent { w: of, t: at } => multiple(&(rational_root(&(w / of))? * t), at),
            _ => None,
        });
        let Some((i, k)) = nearest else {
            return Err(format!("the tangent of {t} times the root of {w} is not among 'symbols'"));
        };
        let Symbol::Tangent { w: of, .. } = &self.symbols[i] else { return Err("internal: no tangent".into()) };
        let root = rational_root(&(w / of)).ok_or("internal: no rational root")?;
        // Sums of angles: tan(a + b) = (tan a + tan b)/(1 - tan a tan b).
        let x = Table::variable(i, first);
        let (mut sum, mut divisors) = (x.clone(), Vec::new());
        for _ in 1..k.unsigned_abs() {
            let product = sum.times(&x, clock)?.times(&Fraction::number(of), clock)?;
            let below = Fraction::number(&Q::one()).plus(&product.negated(), clock)?;
            divisors.push(below.numerator.clone());
            sum = sum.plus(&x, clock)?.times(&below.inverse(clock)?, clock)?;
        }
        let factor = if k < 0 { -root.recip() } else { root.recip() };
        Ok((sum.times(&Fraction::number(&factor), clock)?, divisors))
    }

    /// A solution of an equation of higher order.
    pub fn solution(&self, monic: &[Q], t: &Q, index: usize, first: usize) -> Result<Fraction, String> {
        let wanted = Symbol::Solution { monic: monic.to_vec(), t: t.clone(), index };
        let found = self.symbols.iter().position(|symbol| *symbol == wanted);
        found.map(|i| Table::variable(i, first)).ok_or_else(|| format!("a solution at {t} is not among 'symbols'"))
    }

    /// The values of all symbols.
    fn values(&self, clock: &Clock) -> Result<&[Interval], String> {
        if let Some(values) = self.values.get() {
            return Ok(values);
        }
        let of = |symbol: &Symbol| match symbol {
            Symbol::Exponential(x) => Ok(solutions(&[-Q::one()], x, self.bits, clock)?.swap_remove(0)),
            Symbol::Tangent { w, t } => {
                let turn = solutions(&[w.clone(), Q::zero()], t, self.bits, clock)?;
                turn[1].divided(&turn[0], self.bits).ok_or_else(|| "a tangent is not told from infinity".to_owned())
            }
            Symbol::Solution { monic, t, index } => Ok(solutions(monic, t, self.bits, clock)?.swap_remove(*index)),
        };
        let values = self.symbols.iter().map(of).collect::<Result<Vec<_>, String>>()?;
        Ok(self.values.get_or_init(|| values))
    }

    /// The coefficients of the powers of the parameter in a polynomial over symbols, enclosed.
    pub fn enclosed(&self, p: &Multi, clock: &Clock) -> Result<Vec<Interval>, String> {
        let mut out = vec![Interval::zero(); if p.is_zero() { 0 } else { p.degree(1) + 1 }];
        for (e, c) in self.enclosed_beside(p, 2, clock)? {
            out[e.get(1).copied().unwrap_or(0) as usize] = c;
        }
        Ok(out)
    }

    /// The coefficients of the monomials in other variables, enclosed. Symbols are the variables from `first` on.
    pub fn enclosed_beside(
        &self,
        p: &Multi,
        first: usize,
        clock: &Clock,
    ) -> Result<BTreeMap<Vec<u32>, Interval>, String> {
        let values = self.values(clock)?;
        let mut powers: Vec<Vec<Interval>> = vec![vec![Interval::integer(&Z::one(), self.bits)]; values.len()];
        let mut out: BTreeMap<Vec<u32>, Interval> = BTreeMap::new();
        let mut known: BTreeMap<&[u32], Interval> = BTreeMap::new();
        for (e, c) in &p.0 {
            clock.spend(1 + values.len(), self.bits as u64, self.bits as u64)?;
            let of_symbols = e.get(first..).unwrap_or(&[]);
            if of_symbols.len() > values.len() || e.first().is_some_and(|k| *k > 0) {
                return Err("a polynomial has a variable that is no symbol".into());
            }
            if !known.contains_key(of_symbols) {
                let mut product = Interval::integer(&Z::one(), self.bits);
                for (i, &k) in of_symbols.iter().enumerate().filter(|(_, k)| **k > 0) {
                    clock.hold(k as usize, 2 * self.bits as u64)?;
                    while powers[i].len() <= k as usize {
                        clock.spend(4, self.bits as u64, self.bits as u64)?;
                        let last = &powers[i][powers[i].len() - 1];
                        let next = last.times(&values[i], self.bits);
                        powers[i].push(next);
                    }
                    product = product.times(&powers[i][k as usize], self.bits);
                }
                known.insert(of_symbols, product);
            }
            let beside = &e[..first.min(e.len())];
            let end = beside.iter().rposition(|k| *k > 0).map_or(0, |last| last + 1);
            let sum = out.entry(beside[..end].to_vec()).or_insert_with(Interval::zero);
            *sum = sum.plus(&known[of_symbols].scaled(c));
        }
        Ok(out)
    }
}

fn symbol(json: &Json) -> Result<Symbol, String> {
    let Json::Object(pairs) = json else { return Err("a symbol is not an object".into()) };
    match pairs.first().map(|(key, _)| key.as_str()) {
        Some("exp") => {
            let [x] = object(json, "a symbol", ["exp"], &[])?;
            Ok(Symbol::Exponential(number(x, "'exp'")?))
        }
        Some("tan") => {
            let [of] = object(json, "a symbol", ["tan"], &[])?;
            match list(of, "'tan'")? {
                [w, t] => {
                    let (w, t) = (number(w, "'tan'")?, number(t, "'tan'")?);
                    if w.is_zero() { Err("a tangent of nothing".into()) } else { Ok(Symbol::Tangent { w, t }) }
                }
                _ => Err("'tan' is not a pair".into()),
            }
        }
        _ => {
            let [of, t, index] = object(json, "a symbol", ["solution", "time", "index"], &[])?;
            let (monic, t, index) = (monic(of, "'solution'")?, number(t, "'time'")?, count(index, "'index'")?);
            if index >= monic.len() {
                return Err("an equation has no such solution".into());
            }
            Ok(Symbol::Solution { monic, t, index })
        }
    }
}

/// The coefficients of a monic polynomial from the constant term up, without the leading one.
fn monic(json: &Json, what: &str) -> Result<Vec<Q>, String> {
    let coefficients = list(json, what)?.iter().map(|c| number(c, what)).collect::<Result<Vec<_>, _>>()?;
    if coefficients.is_empty() || coefficients.len() > 64 {
        Err(format!("{what} has no fitting degree"))
    } else {
        Ok(coefficients)
    }
}

/// The quotient of monic polynomials, both without the leading one, if the division is exact.
fn quotient(dividend: &[Q], divisor: &[Q]) -> Option<Vec<Q>> {
    let n = divisor.len();
    if dividend.len() < n {
        return None;
    }
    let mut rest = dividend.to_vec();
    rest.push(Q::one());
    let mut out = vec![Q::zero(); rest.len() - n];
    for k in (0..out.len()).rev() {
        let c = rest[k + n].clone();
        for (j, d) in divisor.iter().enumerate() {
            rest[k + j] -= &c * d;
        }
        out[k] = c;
    }
    out.pop();
    rest[..n].iter().all(Zero::is_zero).then_some(out)
}

/// `k` where `x = k of`, if that is a small whole number other than zero.
fn multiple(x: &Q, of: &Q) -> Option<i64> {
    if of.is_zero() {
        return None;
    }
    let ratio = x / of;
    let k = Some(&ratio).filter(|r| r.is_integer()).and_then(|r| r.to_integer().to_i64());
    k.filter(|k| *k != 0 && k.abs() <= MAX_MULTIPLE)
}

/// The positive root, if it is rational.
fn rational_root(q: &Q) -> Option<Q> {
    if !q.is_positive() {
        return None;
    }
    let root = Q::new(q.numer().sqrt(), q.denom().sqrt());
    (&root * &root == *q).then_some(root)
}
