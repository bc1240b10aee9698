//! The rightmost roots of a loop with dead time, and that there are no others right of a line.

use super::count::count_from_line;
use super::mikhailov::{NotCounted, zero_at_origin};
use super::rightmost_cut::{MOST_MORE, cut};
use super::rightmost_disc::Enclosed;
use super::rightmost_search::{Approximate, Search};
use super::{ConstantParts, FamilyLoop, Kind, Line, QuasiPolynomial};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Enclosure, Integer, Rational};
use jurist_algebra::poly::{Domain, Poly, RootDisc, UniPoly, complex_roots};

/// The rightmost roots, all roots right of a line.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct RightmostRoots {
    /// From the right to the left, each in a disc and with its multiplicity, which is exact; of a pair of conjugates the upper one.
    pub list: Vec<RootDisc>,
    /// No other root has a real part that is equal to this or greater.
    pub others_left_of: Rational,
    /// Of a loop of neutral type: infinitely many roots come as near as one likes to the line with this real part, and finitely many are right
    /// of any line to the right of it.
    pub chain: Option<Enclosure>,
}

/// At least so many of the rightmost roots at a dead time that is a positive rational number, a pair of conjugates being one; all roots
/// right of a line. `None` where infinitely many are right of any line, as the highest power of `s` has no part without delay. Of a loop
/// of neutral type they may be fewer: those right of a line that can be told from the one that a chain of roots comes near to.
///
/// The radius of a disc is at most `relative` times its distance from zero. A root is shown to be in it by Rouché's theorem. That no other is
/// right of the line follows from the [count](super::count_delayed_roots) of roots from there. Multiplicities are those of the factors of the
/// polynomial in `s` and `z`: a factor without squares has simple roots only, and two have none in common, except `s = 0`, since `s` and
/// `exp(-tau s)` are not both algebraic at another `s` (Lindemann, [Baker1975](jurist_algebra::bibliography#baker1975)).
///
/// Cost: some hundred searches by Newton's method in floating point, some steps of it with enclosures for each root, and a count along
/// the line.
///
/// # Errors
/// [`NotCounted`]: the budget, a neutral loop that is not decided, or a count that is not the number of roots that were found.
///
/// # Panics
/// Unless the dead time is positive and the function has a delay.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_algebra::number::Rational;
/// use jurist_algebra::poly::UniPoly;
/// use jurist_stability::dead_time::{QuasiPolynomial, rightmost_roots};
/// // s + exp(-s): -0.318 +- 1.337 j is the logarithm of a fixed point of the exponential
/// let p = QuasiPolynomial::new(vec![UniPoly::from_i64(&[0, 1]), UniPoly::from_i64(&[1])]).unwrap();
/// let small = Rational::dyadic(&1.into(), 40);
/// let found = rightmost_roots(&p, &1.into(), 1, &small, &Budget::unlimited()).unwrap().unwrap();
/// assert_eq!(found.list.len(), 1);
/// assert!(found.list[0].is_pair && found.others_left_of < found.list[0].re);
/// ```
pub fn rightmost_roots(
    p: &QuasiPolynomial,
    tau: &Rational,
    wanted: usize,
    relative: &Rational,
    budget: &Budget,
) -> Result<Option<RightmostRoots>, NotCounted> {
    assert!(tau.sign().is_gt() && p.delays() > 0, "there is dead time");
    if p.kind() == Kind::Advanced {
        return Ok(None);
    }
    budget.step("searching roots");
    let mut found = All::new(p, tau, relative, budget)?.searched(wanted, budget)?;
    found.chain = chain(p, tau, budget)?;
    Ok(Some(found))
}

/// The rightmost roots of a loop of retarded type whose coefficients are constants that are not rational. Each coefficient is enclosed, and Rouché's theorem and
/// the count take the bounds of the errors. The roots of a factor that has rational coefficients and divides
/// all parts are known exactly. A multiple root of the rest stays undecided, and so does its root at 0.
///
/// Cost: that of [`rightmost_roots`].
///
/// # Errors
/// As [`rightmost_roots`], and for a loop that is not of retarded type.
///
/// # Panics
/// Unless the dead time is positive and the function has a delay.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_algebra::number::Rational;
/// use jurist_algebra::poly::{Domain, MultiPoly};
/// use jurist_algebra::symbols::{Definition, Symbols};
/// use jurist_stability::dead_time::{ConstantParts, rightmost_roots_over};
/// // 2 s + pi exp(-s) has the pair +- j pi/2
/// let mut symbols = Symbols::new();
/// let pi = MultiPoly::variable(symbols.insert("pi", Definition::Pi) + 1);
/// let two = MultiPoly::constant(2.into());
/// let parts = ConstantParts::new(vec![vec![MultiPoly::zero(), two], vec![pi]], symbols);
/// let small = Rational::dyadic(&1.into(), 40);
/// let found = rightmost_roots_over(&parts, &1.into(), 1, &small, &Budget::unlimited()).unwrap();
/// assert!(found.list[0].is_pair && found.list[0].re.abs() < small);
/// ```
pub fn rightmost_roots_over(
    constants: &ConstantParts,
    tau: &Rational,
    wanted: usize,
    relative: &Rational,
    budget: &Budget,
) -> Result<RightmostRoots, NotCounted> {
    assert!(tau.sign().is_gt(), "there is dead time");
    budget.step("searching roots");
    let narrow = relative.denominator().bit_length().saturating_sub(relative.numerator().bit_length());
    let (factor, constants) = constants.clone().without_fixed_factor();
    let (p, errors) = budget.enter(|| constants.at_a_point(MORE_BITS * (narrow + 64)))?;
    let is_retarded = p.kind() == Kind::Retarded && errors.iter().skip(1).all(|e| e.coeff(p.order()).is_zero());
    if !is_retarded {
        let limit = "what is known of loops of neutral type beside constants that are not rational";
        return Err(Exhausted::by_method(limit, "searching roots").into());
    }
    let search = Search::new(&p, tau, 0, budget)?;
    let source = Some((errors, constants));
    let part = Part { p, source, multiplicity: 1, at_zero: 0, search, known: Vec::new() };
    let fixed = complex_roots(&factor, relative, budget)?;
    All { tau, relative, parts: vec![part], fixed, floor: None }.searched(wanted, budget)
}

/// The coefficients have this many times the bits of a disc.
const MORE_BITS: u64 = 4;

/// The disc of roots at 0.
fn at_zero(count: usize) -> RootDisc {
    let zero = || Rational::ZERO;
    RootDisc { re: zero(), im: zero(), radius: zero(), count, is_one: true, is_pair: false }
}

/// Searches, each of them denser and further.
const ROUNDS: u32 = 5;

/// A factor without squares, and how often it divides.
struct Part {
    p: QuasiPolynomial,
    /// How far its coefficients may be off, and the constants that they are.
    source: Option<(Vec<UniPoly>, ConstantParts)>,
    multiplicity: usize,
    /// How often 0 is a root of the factor.
    at_zero: usize,
    search: Search,
    /// What has become of approximations.
    known: Vec<(Approximate, Option<RootDisc>)>,
}

/// All factors.
struct All<'t> {
    tau: &'t Rational,
    relative: &'t Rational,
    parts: Vec<Part>,
    /// The roots that do not depend on the dead time, and 0.
    fixed: Vec<RootDisc>,
    /// Left of it nothing is counted.
    floor: Option<Rational>,
}

impl<'t> All<'t> {
    fn new(
        p: &QuasiPolynomial,
        tau: &'t Rational,
        relative: &'t Rational,
        budget: &Budget,
    ) -> Result<All<'t>, NotCounted> {
        let mut fixed = complex_roots(&p.content(), relative, budget)?;
        let mut at_zero = 0;
        fixed.retain(|disc| {
            let is_zero = disc.re.is_zero() && disc.im.is_zero() && disc.radius.is_zero();
            at_zero += if is_zero { disc.count } else { 0 };
            !is_zero
        });
        let mut parts = Vec::new();
        let factors = budget.enter(|| Poly::new(p.primitive().parts().to_vec()).square_free_decomposition())?;
        for (factor, multiplicity) in factors {
            let p = QuasiPolynomial::new(factor.into_coeffs()).expect("a factor is not zero");
            let vanishes = p.parts().iter().fold(Integer::ZERO, |sum, part| sum + part.coeff(0)).is_zero();
            let own = if vanishes { zero_at_origin(&p, tau).0 } else { 0 };
            at_zero += own * multiplicity;
            let search = Search::new(&p, tau, own, budget)?;
            parts.push(Part { p, source: None, multiplicity, at_zero: own, search, known: Vec::new() });
        }
        if at_zero > 0 {
            fixed.push(self::at_zero(at_zero));
        }
        Ok(All { tau, relative, floor: floor_approximate(p, tau), parts, fixed })
    }

    /// All roots right of a line.
    fn searched(mut self, wanted: usize, budget: &Budget) -> Result<RightmostRoots, NotCounted> {
        let mut last = None;
        for round in 0..ROUNDS {
            let floor = self.floor.as_ref().map_or(f64::NEG_INFINITY, Rational::to_f64_approximate);
            for part in &mut self.parts {
                part.search.look_approximate(wanted + MOST_MORE, floor, round, budget)?;
            }
            match self.attempt(wanted, budget)? {
                Ok(found) => return Ok(found),
                Err(reason) => last = reason.or(last),
            }
        }
        let unknown = || Exhausted::by_method("searches for approximations", "searching roots");
        Err(last.unwrap_or_else(unknown).into())
    }

    /// All roots right of a line, or why that is not shown.
    fn attempt(
        &mut self,
        wanted: usize,
        budget: &Budget,
    ) -> Result<Result<RightmostRoots, Option<Exhausted>>, NotCounted> {
        self.prove(wanted + MOST_MORE, budget)?;
        let mut list: Vec<RootDisc> = self.fixed.clone();
        for part in &self.parts {
            list.extend(part.discs().map(|disc| RootDisc { count: part.multiplicity, ..disc.clone() }));
        }
        list.sort_by(|a, b| (&b.re, &a.im).cmp(&(&a.re, &b.im)));
        let reals: Vec<[Rational; 2]> =
            list.iter().map(|disc| [&disc.re - &disc.radius, &disc.re + &disc.radius]).collect();
        let unit = self.tau.recip().expect("the dead time is positive");
        let Some((kept, gap)) = cut(&reals, wanted, self.floor.as_ref(), &unit) else { return Ok(Err(None)) };
        let line = gap.decimal();
        for part in &self.parts {
            let counted = match part.counted(self.tau, &line, budget) {
                Err(NotCounted::Stopped(stopped)) if stopped.stop.is_precision() => return Ok(Err(Some(stopped))),
                counted => counted?,
            };
            let found = part.right_of(&line);
            if counted != found {
                let limit =
                    format!("searches for approximations: of {counted} roots right of Re s = {line} they find {found}");
                return Ok(Err(Some(Exhausted::by_method(limit, "searching roots"))));
            }
        }
        list.truncate(kept);
        Ok(Ok(RightmostRoots { list, others_left_of: line, chain: None }))
    }

    /// Discs about the rightmost approximations, so many of them.
    fn prove(&mut self, wanted: usize, budget: &Budget) -> Result<(), Exhausted> {
        let mut reals: Vec<f64> =
            self.parts.iter().flat_map(|part| part.search.found_approximate()).map(|s| s.re).collect();
        reals.extend(self.fixed.iter().map(|disc| disc.re.to_f64_approximate()));
        reals.sort_by(|a, b| b.total_cmp(a));
        let least = reals.get(wanted).copied().unwrap_or(f64::NEG_INFINITY);
        for part in &mut self.parts {
            let errors = part.source.as_ref().map_or(&[][..], |(errors, _)| errors);
            let enclosed = Enclosed::new(&part.p, errors, self.tau);
            for s in part.search.found_approximate().filter(|s| s.re >= least) {
                if part.known.iter().any(|(known, _)| *known == s) {
                    continue;
                }
                let disc = enclosed.disc(s, self.relative, budget)?;
                let is_new = |disc: &RootDisc| {
                    let is_zero = part.at_zero > 0 && touch(disc, &zero_of(disc));
                    !is_zero
                        && !part.known.iter().filter_map(|(_, known)| known.as_ref()).any(|known| touch(known, disc))
                };
                part.known.push((s, disc.filter(is_new)));
            }
        }
        Ok(())
    }
}

/// The point 0.
fn zero_of(disc: &RootDisc) -> RootDisc {
    RootDisc { re: Rational::ZERO, im: Rational::ZERO, radius: Rational::ZERO, ..disc.clone() }
}

/// Whether two discs have a point in common.
fn touch(a: &RootDisc, b: &RootDisc) -> bool {
    let (x, y, reach) = (&a.re - &b.re, &a.im - &b.im, &a.radius + &b.radius);
    &x * &x + &y * &y <= &reach * &reach
}

impl Part {
    /// Discs that do not touch, each with one root that is not 0.
    fn discs(&self) -> impl Iterator<Item = &RootDisc> {
        self.known.iter().filter_map(|(_, disc)| disc.as_ref())
    }

    /// The number of roots right of a line on which no known one is.
    fn counted(&self, tau: &Rational, line: &Rational, budget: &Budget) -> Result<usize, NotCounted> {
        budget.step("counting roots right of a line");
        // In units in which the dead time is not above 1: the way along the line begins with a step of 1.
        let scale = tau.ceil().bit_length();
        let unit = Rational::dyadic(&Integer::ONE, scale);
        let count = match &self.source {
            None => {
                let shift = |part: &UniPoly| shifted(part, self.p.order(), line, scale);
                let parts = self.p.parts().iter().map(shift).collect();
                let shifted = QuasiPolynomial::new(parts).expect("the function is not zero");
                count_from_line(&shifted, &(tau * &unit), &-(tau * line), budget)?
            }
            Some((_, constants)) => {
                let parts = constants.map_parts(|part| shifted(part, self.p.order(), line, scale));
                let decay = (-line).checked_div(&unit).expect("not zero");
                let family = FamilyLoop::enclosed(parts, Line::constant(tau * &unit), Line::constant(decay));
                family.count(&Rational::ZERO, budget)?.expect("the function is not zero")
            }
        };
        count.right.ok_or(NotCounted::Neutral)
    }

    /// The number of known ones there.
    fn right_of(&self, line: &Rational) -> usize {
        let zero = if line.is_negative() { self.at_zero } else { 0 };
        zero + self.discs().filter(|disc| disc.re > *line).map(|disc| 1 + usize::from(disc.is_pair)).sum::<usize>()
    }
}

/// A part in `2^scale s`, `s` being counted from a line, times a positive number that depends on the order, the line and the scale alone.
fn shifted<R: Domain>(part: &Poly<R>, order: usize, line: &Rational, scale: u64) -> Poly<R> {
    let (a, d) = (line.numerator(), line.denominator());
    // d^n P(s + a/d) = Q(d s + a) with the coefficients c_j d^(n - j).
    let times = |c: &R, by: Integer| c.times(&R::from_integer(&by));
    let scaled = part.coeffs().iter().enumerate().map(|(j, c)| times(c, d.pow((order - j) as u64)));
    let moved = Poly::new(scaled.collect()).taylor_shift(&R::from_integer(&a)).scaled_argument(&R::from_integer(&d));
    let unit = |j: usize| Integer::ONE << (scale * (order - j) as u64);
    Poly::new(moved.coeffs().iter().enumerate().map(|(j, c)| times(c, unit(j))).collect())
}

/// A line right of which the highest power of `s` outweighs the rest at high frequencies; `None` of a loop that is not of neutral type. It is
/// proved where roots are counted.
fn floor_approximate(p: &QuasiPolynomial, tau: &Rational) -> Option<Rational> {
    /// Sizes of `z` that are tried are powers of `2^(1/256)`.
    const FINEST: i64 = 256;
    /// The angle by which the longest dead time turns at most along the line.
    const MOST_TURNED: f64 = 3000.0;
    if p.kind() != Kind::Neutral {
        return None;
    }
    let terms = terms_approximate(p);
    let size = |log: i64| (log as f64 / FINEST as f64).exp2();
    // All terms at s = r beside the first one, where |z| = x.
    let sum = |x: f64, r: f64| terms.iter().map(|(k, below, c)| c * x.powi(*k) * r.powi(-*below)).sum::<f64>();
    let outweighs = |log: i64| sum(size(log), f64::INFINITY) < 2.0;
    let mut log = 0i64;
    while log > -FINEST * 1000 && !outweighs(log) {
        log -= 1;
    }
    while log < FINEST * 1000 && outweighs(log + 1) {
        log += 1;
    }
    let turned = |log: i64| {
        let radius = (0..200).map(|e| 2f64.powi(e)).find(|r| sum(size(log), *r) < 2.0);
        radius.unwrap_or(f64::INFINITY) * p.delays() as f64 * tau.to_f64_approximate()
    };
    // Further from the chain there are fewer roots to be told, and less way to go.
    let distances = [1, 2, 4, 8, 16, 32, 64, 128, 256];
    let distance = distances.into_iter().find(|distance| turned(log - distance) <= MOST_TURNED).unwrap_or(256);
    // Re s = -ln|z|/tau with ln 2 = 6931472/10^7.
    let exponent = Rational::new((distance - log).into(), FINEST.into());
    (exponent * Rational::new(6_931_472.into(), 10_000_000.into())).checked_div(tau)
}

/// The moduli of the coefficients of `z^k s^(n - below)`, that without delay of the highest power being 1.
fn terms_approximate(p: &QuasiPolynomial) -> Vec<(i32, i32, f64)> {
    let n = p.order();
    let first = p.difference().coeff(0).abs();
    let share = |c: &Integer| Rational::new(c.abs(), first.clone()).to_f64_approximate();
    let of = |(k, part): (usize, &UniPoly)| -> Vec<(i32, i32, f64)> {
        let terms = part.coeffs().iter().enumerate().filter(|(_, c)| !c.is_zero());
        terms.map(|(j, c)| (k as i32, (n - j) as i32, share(c))).collect()
    };
    p.parts().iter().enumerate().flat_map(of).collect()
}

/// The line that a chain of roots comes near to.
fn chain(p: &QuasiPolynomial, tau: &Rational, budget: &Budget) -> Result<Option<Enclosure>, Exhausted> {
    const BITS: u64 = 96;
    if p.kind() != Kind::Neutral {
        return Ok(None);
    }
    let discs = complex_roots(&p.difference(), &Rational::dyadic(&Integer::ONE, 80), budget)?;
    budget.enter(|| {
        let line = |disc: &RootDisc| -> Option<Enclosure> {
            let around = |x: &Rational| Enclosure::new(x - &disc.radius, x + &disc.radius);
            let (re, im) = (around(&disc.re), around(&disc.im));
            let square = re.mul(&re, BITS).add(&im.mul(&im, BITS), BITS);
            let twice = Enclosure::from_rational(Rational::from(-2) * tau);
            square.ln(BITS)?.div(&twice, BITS)
        };
        let lines: Option<Vec<Enclosure>> = discs.iter().map(line).collect();
        lines?.into_iter().reduce(|a, b| {
            let most = |x: &Rational, y: &Rational| x.clone().max(y.clone());
            Enclosure::new(most(a.lower(), b.lower()), most(a.upper(), b.upper()))
        })
    })
}
