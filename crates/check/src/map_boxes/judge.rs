//! What is shown of single boxes.

use super::axis::{right, scale, shifted};
use super::{Parts, Statement, read};
use crate::clock::Clock;
use crate::format::Json;
use crate::moving::Sources;
use crate::multivariate::Multi;
use crate::number::{Q, Z};
use crate::over_box::{FIRST, in_half_plane, in_region, with_sources};
use crate::over_symbols::primitive;
use crate::taylor::{Precision, Taylor};
use crate::{Limits, Rejection, STACK, Step};
use num_traits::{One, Signed};
use std::collections::BTreeMap;
use std::fmt;

/// Beyond the axis, by these powers of two relative to the size of the roots, roots of a box are looked for whose boundary runs between
/// parts that are all not stable.
const BEYOND: [i64; 2] = [-3, -1];

/// Decides boxes of a window one by one, as the check of a map by boxes does. Who writes a certificate asks it what a checker can see.
///
/// How it decides is in [`grammar`](crate::grammar), *maps by boxes*: Taylor models of the coefficients \[MakinoBerz2003\], and the turns about zero along
/// the imaginary axis.
///
/// ```
/// use jurist_check::{BoxJudge, Limits};
/// let model = "time = 'continuous'\nparameters = { a = {}, b = {} }\nloop.characteristic = 's^2 + a*s + b'";
/// let certificate = r#"{
///     "schema": "jurist/certificate/7",
///     "statement": {"kind": "boxes", "time": "continuous", "x": "a", "y": "b", "set": {}, "region": {"decay": "0"},
///         "window": {"x": ["-1", "3"], "y": ["1", "2"]}, "tree": "?"},
///     "order": 2, "bits": 64
/// }"#;
/// let judge = BoxJudge::new(model, certificate, &Limits::default()).unwrap();
/// let mut whole = judge.whole();
/// assert!(!judge.shows(&mut whole, true));
/// let [mut lower, upper] = judge.halves(&mut whole, 0);
/// assert!(!judge.shows(&mut lower, false), "a = 1 is stable, but a = 0 is its edge");
/// assert!(!judge.shows(&mut upper.clone(), false), "a from 1 to 3");
/// assert!(judge.shows(&mut upper.clone(), true));
/// ```
pub struct BoxJudge {
    statement: Statement,
    precision: Precision,
    clock: Clock,
    sources: Sources,
    /// Polynomials in the parameters and what depends on them: the coefficients in the half plane, then lists of divisors.
    functions: Functions,
    /// The number of coefficients.
    coefficients: usize,
    /// Places of those divisors that one list has.
    divisors: Vec<std::ops::Range<usize>>,
    /// Whether a divisor, or a coefficient, is zero everywhere: then no point is stable.
    is_nowhere: bool,
}

/// A box of the window, and what is known of the functions over it.
#[derive(Clone, Debug)]
pub struct JudgedBox {
    sides: [[Q; 2]; 2],
    /// The functions, and whether they were computed for this box and not for a larger one.
    known: Option<(Vec<Taylor>, bool)>,
    /// Whether that was tried.
    is_tried: bool,
}

impl fmt::Display for JudgedBox {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [[a, b], [c, d]] = &self.sides;
        write!(f, "[{a}, {b}] x [{c}, {d}]")
    }
}

impl BoxJudge {
    /// Of a certificate, whose tree is not looked at.
    ///
    /// Cost: the characteristic polynomial in all parameters and functions of them, expanded.
    ///
    /// # Errors
    /// [`Rejection`] where the certificate has not the form of one of boxes, or the model cannot be read.
    pub fn new(model: &str, certificate: &str, limits: &Limits) -> Result<Self, Rejection> {
        let read = || {
            let (statement, parts) = read(&Step::Format.of(Json::parse(certificate))?)?;
            BoxJudge::of(model, statement, &parts, Clock::new(limits.timeout))
        };
        // As a check: expressions may nest deeper than a default stack allows.
        std::thread::scope(|scope| {
            let thread = std::thread::Builder::new().stack_size(STACK).spawn_scoped(scope, read);
            thread.map_or_else(
                |_| read(),
                |thread| thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)),
            )
        })
    }

    pub(super) fn of(model: &str, statement: Statement, parts: &Parts, clock: Clock) -> Result<Self, Rejection> {
        let (own, sources) = Step::Model.of(with_sources(model, &statement.names, &statement.set, true, &clock))?;
        if own.discrete != statement.discrete {
            let reason = "the model's time is not that of the statement".into();
            return Err(Rejection { step: Step::Model, reason });
        }
        let in_this_region = Step::Model.of(in_region(&own.coefficients, own.discrete, &statement.extent))?;
        let own_is_discrete = own.discrete;
        let mut all = primitive(if own_is_discrete { in_half_plane(&in_this_region) } else { in_this_region });
        let coefficients = all.len();
        let is_undefined = own.divisors.iter().any(|parts| parts.iter().all(Multi::is_zero));
        let is_nowhere = is_undefined || all.iter().any(Multi::is_zero);
        let mut divisors = Vec::with_capacity(own.divisors.len());
        for parts in own.divisors.into_iter().filter(|parts| !parts.iter().any(is_number)) {
            divisors.push(all.len()..all.len() + parts.len());
            all.extend(primitive(parts));
        }
        let functions = Functions::new(&all);
        let precision = Precision::new(parts.order, parts.bits);
        Ok(BoxJudge { statement, precision, clock, sources, functions, coefficients, divisors, is_nowhere })
    }

    pub(super) fn statement(&self) -> &Statement {
        &self.statement
    }

    pub(super) fn clock(&self) -> &Clock {
        &self.clock
    }

    /// The whole window.
    pub fn whole(&self) -> JudgedBox {
        JudgedBox { sides: self.statement.window.clone(), known: None, is_tried: false }
    }

    /// The lower and the upper half of a box in `x` (axis 0) or `y` (axis 1).
    ///
    /// Cost: that of computing the functions over the box, unless those of a larger one are precise enough for it.
    pub fn halves(&self, of: &mut JudgedBox, axis: usize) -> [JudgedBox; 2] {
        // Where time is over, all that follows is not shown.
        self.halved(of, axis).unwrap_or_else(|_| self.cut(of, axis))
    }

    pub(super) fn halved(&self, of: &mut JudgedBox, axis: usize) -> Result<[JudgedBox; 2], String> {
        if of.known.as_ref().is_none_or(|(known, is_own)| !is_own && !self.is_precise(known, 4)) {
            self.compute(of)?;
        }
        Ok(self.cut(of, axis))
    }

    fn cut(&self, of: &JudgedBox, axis: usize) -> [JudgedBox; 2] {
        let [low, high] = &of.sides[axis];
        let middle = (low + high) / Q::from(Z::from(2));
        let (mut lower, mut upper) = (Vec::new(), Vec::new());
        for f in of.known.iter().flat_map(|(known, _)| known) {
            let [below, above] = f.halves(axis, &self.precision);
            lower.push(below);
            upper.push(above);
        }
        let half = |side: [Q; 2], known: Vec<Taylor>| {
            let mut sides = of.sides.clone();
            sides[axis] = side;
            JudgedBox { sides, known: of.known.as_ref().map(|_| (known, false)), is_tried: false }
        };
        [half([low.clone(), middle.clone()], lower), half([middle, high.clone()], upper)]
    }

    /// Whether what is left out is less than a share of what the box changes.
    fn is_precise(&self, known: &[Taylor], share: usize) -> bool {
        known[..self.coefficients].iter().all(|f| {
            let variation = f.variation();
            (&f.rest << share) <= variation || f.rest.bits() < 8
        })
    }

    /// The functions over the box itself, where the series allow it.
    fn compute(&self, of: &mut JudgedBox) -> Result<(), String> {
        if of.is_tried {
            return Ok(());
        }
        of.is_tried = true;
        self.clock.tick()?;
        let p = &self.precision;
        let parameters = of.sides.iter().enumerate().map(|(i, side)| Taylor::coordinate(side, i, p)).collect();
        // A box may be too wide for a series; then it is not shown.
        let own = self.sources.values(parameters, p, &self.clock).and_then(|v| self.functions.at(&v, p, &self.clock));
        self.clock.tick()?;
        if let Ok(own) = own {
            of.known = Some((own, true));
        }
        Ok(())
    }

    /// How much has been done, in units of about a nanosecond. It is counted, not timed: the same for the same boxes.
    pub fn work(&self) -> u64 {
        self.clock.work()
    }

    /// Whether the loop is shown to be stable at every point of the closed box, or, with `stable` false, at none.
    ///
    /// Cost: the functions over the box, where those of a larger box are not enough; for each part of the imaginary axis, halved until it
    /// is clear of roots, `O(n^2)` operations on their coefficients.
    pub fn shows(&self, of: &mut JudgedBox, stable: bool) -> bool {
        self.shown(of, stable).unwrap_or(false)
    }

    pub(super) fn shown(&self, of: &mut JudgedBox, stable: bool) -> Result<bool, String> {
        if self.is_nowhere {
            return Ok(!stable);
        }
        if let Some((known, is_own)) = &of.known {
            if self.decided(known, stable)? {
                return Ok(true);
            }
            if *is_own || self.is_precise(known, 10) {
                return Ok(false);
            }
        }
        self.compute(of)?;
        match &of.known {
            Some((known, true)) => self.decided(known, stable),
            _ => Ok(false),
        }
    }

    fn decided(&self, known: &[Taylor], stable: bool) -> Result<bool, String> {
        let p = &known[..self.coefficients];
        if stable {
            let is_defined = |list: &std::ops::Range<usize>| known[list.clone()].iter().any(|f| f.sign().is_some());
            return Ok(self.divisors.iter().all(is_defined) && self.right(p)? == Some(0));
        }
        // All roots to the left make all coefficients of one sign.
        let signs: Vec<bool> = p.iter().filter_map(Taylor::sign).collect();
        if signs.contains(&true) && signs.contains(&false) {
            return Ok(true);
        }
        if self.right(p)?.is_some_and(|count| count > 0) {
            return Ok(true);
        }
        for beyond in BEYOND {
            if self.right(&shifted(p, scale(p) + beyond))?.is_some_and(|count| count > 0) {
                return Ok(true);
            }
        }
        Ok(false)
    }

    fn right(&self, p: &[Taylor]) -> Result<Option<usize>, String> {
        right(p, &self.precision, &self.clock)
    }

    /// The axis along which the functions change most in a box, 0 or 1; of one that is not known, 0 where it is the wider one in shares of
    /// the window.
    pub fn axis(&self, of: &JudgedBox) -> usize {
        match &of.known {
            Some((known, _)) => {
                let mut sums = [0.0; 2];
                for f in &known[..self.coefficients] {
                    let size = f.magnitude().max(Z::one());
                    for (axis, sum) in sums.iter_mut().enumerate() {
                        // Shares in thousandths, for a choice and no proof.
                        let share = u32::try_from(f.linear(axis).abs() * 1000 / &size).unwrap_or(u32::MAX);
                        *sum += f64::from(share);
                    }
                }
                usize::from(sums[1] > sums[0])
            }
            None => {
                let share = |k: usize| {
                    let ([low, high], [a, b]) = (&of.sides[k], &self.statement.window[k]);
                    (high - low) / (b - a)
                };
                usize::from(share(1) > share(0))
            }
        }
    }
}

/// A number other than zero.
fn is_number(p: &Multi) -> bool {
    p.is_constant() && !p.is_zero()
}

/// Polynomials as sums over the monomials of what depends on the parameters, each times a polynomial in these.
struct Functions {
    /// The exponents of the variables behind the parameters.
    monomials: Vec<Vec<u32>>,
    /// Exponents of the parameters.
    powers: Vec<[u32; 2]>,
    /// Of each polynomial and each of its monomials the coefficients of powers of the parameters.
    rows: Vec<BTreeMap<usize, Vec<(usize, Z)>>>,
}

impl Functions {
    fn new(all: &[Multi]) -> Self {
        let (mut monomials, mut powers) = (BTreeMap::new(), BTreeMap::new());
        let mut rows = Vec::with_capacity(all.len());
        for p in all {
            let mut row: BTreeMap<usize, Vec<(usize, Z)>> = BTreeMap::new();
            for (e, c) in &p.0 {
                let at = |i: usize| e.get(FIRST + i).copied().unwrap_or(0);
                let behind = e.get(FIRST + 2..).unwrap_or(&[]).to_vec();
                let next = monomials.len();
                let monomial = *monomials.entry(behind).or_insert(next);
                let next = powers.len();
                let power = *powers.entry([at(0), at(1)]).or_insert(next);
                row.entry(monomial).or_default().push((power, c.clone()));
            }
            rows.push(row);
        }
        Functions { monomials: in_order(monomials), powers: in_order(powers), rows }
    }

    /// At the values of all variables from [`FIRST`] on.
    fn at(&self, values: &[Taylor], p: &Precision, clock: &Clock) -> Result<Vec<Taylor>, String> {
        let mut tables: Vec<Vec<Taylor>> = vec![vec![Taylor::number(&Q::one(), p)]; values.len()];
        let mut product = |exponents: &[u32], first: usize| -> Result<Taylor, String> {
            let mut product: Option<Taylor> = None;
            for (i, &k) in exponents.iter().enumerate().filter(|(_, k)| **k > 0) {
                let table = &mut tables[first + i];
                while table.len() <= k as usize {
                    let next = table[table.len() - 1].times(&values[first + i], p, clock)?;
                    table.push(next);
                }
                let power = &table[k as usize];
                product = Some(match product {
                    Some(known) => known.times(power, p, clock)?,
                    None => power.clone(),
                });
            }
            Ok(product.unwrap_or_else(|| Taylor::number(&Q::one(), p)))
        };
        let powers = self.powers.iter().map(|e| product(e, 0)).collect::<Result<Vec<_>, _>>()?;
        let monomials = self.monomials.iter().map(|e| product(e, 2)).collect::<Result<Vec<_>, _>>()?;
        let mut out = Vec::with_capacity(self.rows.len());
        for row in &self.rows {
            let mut sum = Taylor::zero();
            for (&monomial, terms) in row {
                let mut factor = Taylor::zero();
                for (power, c) in terms {
                    clock.spend(p.order * p.order, c.bits(), p.bits as u64)?;
                    factor.add_scaled(&powers[*power], c);
                }
                let is_one = self.monomials[monomial].iter().all(|k| *k == 0);
                sum = sum.plus(&if is_one { factor } else { factor.times(&monomials[monomial], p, clock)? });
            }
            out.push(sum);
        }
        Ok(out)
    }
}

/// The keys in the order of their numbers.
fn in_order<K>(numbered: BTreeMap<K, usize>) -> Vec<K> {
    let mut all: Vec<(K, usize)> = numbered.into_iter().collect();
    all.sort_by_key(|(_, number)| *number);
    all.into_iter().map(|(key, _)| key).collect()
}
