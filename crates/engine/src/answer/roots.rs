//! Where the roots of a closed loop are, each in a small disc.

use super::Answer;
use super::rightmost::{WithDelay, rightmost};
use super::roots_of_complex::{rightmost_of_complex, roots_of_complex};
use super::roots_on_boundary::{number, tell_boundary};
use crate::error::Error;
use crate::model::{Time, quotient_at};
use crate::precisions::ROOTS;
use crate::problem::{BaseDelay, DelayedLoop, Problem, exact_or_enclosed};
use crate::stability::count_roots;
use jurist_algebra::ball::Ball;
use jurist_algebra::limits::{Budget, checkpoint};
use jurist_algebra::number::{Enclosure, Rational};
use jurist_algebra::poly::{Domain, RootDisc, UniPoly, complex_roots, root_discs};
use std::sync::Arc;

/// The roots of the characteristic polynomial at a point.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_engine::model::{Model, ParameterBuilder, Time};
/// use jurist_engine::problem::Ask;
/// let (model, _) = Model::builder(Time::Continuous)
///     .parameter(ParameterBuilder::new("K").nominal("2"))
///     .characteristic("s^2 + 2*s + K")
///     .build()?;
/// let answer = model.ask().problem()?.roots(12, &Budget::unlimited())?;
/// let [pair] = answer.value().list.as_slice() else { panic!("-1 + j and -1 - j") };
/// assert_eq!((pair.disc.is_pair, pair.damping(60).unwrap().decimal(6).unwrap().as_str()), (true, "0.707107"));
/// # Ok::<(), jurist_engine::error::Error>(())
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Roots {
    /// The degree of the polynomial in all parameters.
    pub degree: usize,
    /// By how much the degree drops at this point.
    pub infinite: usize,
    /// The slowest root first: by magnitude from the largest in discrete time, by real part from the rightmost in continuous time. Of a
    /// pair of conjugate roots the upper one is listed.
    pub list: Vec<ClosedLoopRoot>,
    /// Of a loop with dead time, which has infinitely many roots, how far they are listed; `None` where all are.
    pub beyond: Option<BeyondRoots>,
}

/// Where the roots are that are not listed, of a loop with dead time.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct BeyondRoots {
    /// How many were asked for. More are listed where real parts are nearly the same, fewer where a chain of roots comes before.
    pub wanted: usize,
    /// No other root has this real part or a greater one.
    pub others_left_of: Rational,
    /// Of a loop of neutral type the real part of a line that infinitely many roots come as near to as one likes.
    pub chain: Option<Enclosure>,
}

/// How many roots of a loop with dead time are listed where nothing else is asked for.
pub const RIGHTMOST: usize = 10;

/// A root, or a cluster: several roots that share one disc.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct ClosedLoopRoot {
    /// Where.
    pub disc: RootDisc,
    pub(super) time: Time,
    /// From one sample to the next, of a discrete loop that says it; of several rates the hyperperiod.
    pub(super) period: Option<Rational>,
    /// Whether it is known to be on the unit circle, or on the imaginary axis.
    pub(super) is_on_boundary: bool,
}

impl ClosedLoopRoot {
    /// The real part.
    pub fn real(&self) -> Enclosure {
        match self.time {
            Time::Continuous if self.is_on_boundary => Enclosure::from_rational(Rational::ZERO),
            Time::Discrete if self.is_on_boundary && self.disc.im.is_zero() => {
                Enclosure::from_rational(if self.disc.re.is_negative() { -Rational::ONE } else { Rational::ONE })
            }
            _ => around(&self.disc.re, &self.disc.radius),
        }
    }

    /// The imaginary part: 0 of a real root, positive of a pair, of either sign of one complex root.
    pub fn imaginary(&self) -> Enclosure {
        match self.disc.is_pair || !self.disc.is_one {
            true => around(&self.disc.im, &self.disc.radius),
            false if !self.disc.im.is_zero() => around(&self.disc.im, &self.disc.radius),
            false => Enclosure::from_rational(Rational::ZERO),
        }
    }

    /// The magnitude, computed with so many bits; its width is that of the disc.
    pub fn magnitude(&self, bits: u64) -> Enclosure {
        if self.is_on_boundary && self.time == Time::Discrete {
            return Enclosure::from_rational(Rational::ONE);
        }
        let (re, im) = (self.real(), self.imaginary());
        if im.upper().is_zero() && im.lower().is_zero() {
            return absolute(&re);
        }
        re.mul(&re, bits).add(&im.mul(&im, bits), bits).sqrt(bits)
    }

    /// `s`, or `ln(z)` per sample, as real and imaginary part; `None` of a root that may be 0.
    fn exponent(&self, bits: u64) -> Option<[Enclosure; 2]> {
        if self.time == Time::Continuous {
            return Some([self.real(), self.imaginary()]);
        }
        Some([self.magnitude(bits).ln(bits)?, self.angle(bits)?])
    }

    /// The modulus of the root's angle, from 0 to pi; `None` of a root that may be 0.
    fn angle(&self, bits: u64) -> Option<Enclosure> {
        let (re, im) = (self.real(), absolute(&self.imaginary()));
        if self.disc.im.is_zero() {
            return match (re.lower().sign(), re.upper().sign()) {
                _ if !self.disc.is_one => None,
                (std::cmp::Ordering::Greater, _) => Some(Enclosure::from_rational(Rational::ZERO)),
                (_, std::cmp::Ordering::Less) => Some(Enclosure::pi(bits)),
                _ => None,
            };
        }
        // Twice the arc tangent of half the angle.
        let below = self.magnitude(bits).add(&re, bits);
        let two = Enclosure::from_rational(Rational::from(2));
        match im.div(&below, bits).filter(|_| below.lower().sign().is_gt()) {
            Some(half) => Some(half.atan(bits).mul(&two, bits)),
            None => {
                // Next to the negative axis the sum is small and the difference is not.
                let above = self.magnitude(bits).sub(&re, bits);
                Some(Enclosure::pi(bits).sub(&im.div(&above, bits)?.atan(bits).mul(&two, bits), bits))
            }
        }
    }

    /// The damping ratio: the cosine of the angle that `s`, or `ln(z)`, makes with the negative real axis; `None` for the roots
    /// `s = 0`, `z = 0` and `z = 1`, and for a cluster.
    pub fn damping(&self, bits: u64) -> Option<Enclosure> {
        let [re, im] = self.exponent(bits).filter(|_| self.disc.is_one)?;
        let size = re.mul(&re, bits).add(&im.mul(&im, bits), bits).sqrt(bits);
        re.neg().div(&size, bits).filter(|_| size.lower().sign().is_gt())
    }

    /// The natural frequency `|s|`, or `|ln(z)|` over the sample time, in radians per unit of time; `None` of a discrete loop without a
    /// sample time, for the root `z = 0`, and for a cluster.
    pub fn natural_frequency(&self, bits: u64) -> Option<Enclosure> {
        let [re, im] = self.exponent(bits).filter(|_| self.disc.is_one)?;
        let size = re.mul(&re, bits).add(&im.mul(&im, bits), bits).sqrt(bits);
        match self.time {
            Time::Continuous => Some(size),
            Time::Discrete => size.div(&Enclosure::from_rational(self.period.clone()?), bits),
        }
    }

    /// What the roots are ordered by, the slowest first.
    fn slowness(&self) -> Rational {
        match self.time {
            Time::Continuous if self.is_on_boundary => Rational::ZERO,
            Time::Discrete if self.is_on_boundary => Rational::ONE,
            Time::Continuous => self.disc.re.clone(),
            Time::Discrete => &self.disc.re * &self.disc.re + &self.disc.im * &self.disc.im,
        }
    }
}

fn around(centre: &Rational, radius: &Rational) -> Enclosure {
    Enclosure::new(centre - radius, centre + radius)
}

fn absolute(x: &Enclosure) -> Enclosure {
    let (lo, hi) = (x.lower(), x.upper());
    match (lo.is_negative(), hi.is_negative()) {
        (false, _) => x.clone(),
        (true, true) => x.neg(),
        (true, false) => Enclosure::new(Rational::ZERO, hi.clone().max(lo.abs())),
    }
}

/// What the roots are those of.
enum Polynomial {
    Exact(UniPoly),
    /// Enclosed, with so many bits.
    Enclosed(Vec<RootDisc>),
    /// With a dead time.
    Delayed(WithDelay, Rational),
}

impl Problem {
    /// The roots of the characteristic polynomial at the point that the values of all parameters are, in discs that are small enough for so
    /// many significant digits of the root.
    ///
    /// The discs are proved (Smith 1970); multiplicities are exact for a rational loop and for one with dead time. Behind holds roots that are
    /// equal, or nearer to each other than some thousand bits tell, share a disc. Of a loop with dead time the [ten](RIGHTMOST) rightmost roots are
    /// listed, as by [`Problem::rightmost_roots`].
    ///
    /// Cost: that of the characteristic polynomial, and of some dozen rounds of the iteration of Aberth and Ehrlich.
    ///
    /// # Errors
    /// As [`Problem::rightmost_roots`].
    ///
    /// # Panics
    /// When a parameter is free.
    pub fn roots(self: &Arc<Self>, digits: usize, budget: &Budget) -> Result<Answer<Roots>, Error> {
        self.rightmost_roots(RIGHTMOST, digits, budget)
    }

    /// The same with another number of roots of a loop with dead time, of which infinitely many exist: so many of the rightmost, a pair of
    /// conjugates being one. No other root is right of the line that [`BeyondRoots`] says. Of a loop without dead time all roots are listed.
    ///
    /// Discs are proved by Rouché's theorem, and that there are no others by a count along the line
    /// ([`rightmost_roots`](crate::stability::dead_time::rightmost_roots)).
    ///
    /// Cost: as [`Problem::roots`]; with dead time that of the searches and counts there.
    ///
    /// # Errors
    /// [`Error::Refused`] (`E-dead-time`) for dead time beside other functions, and where infinitely many roots are right of any line.
    /// [`Error::Undefined`] where the loop is, and where its polynomial is zero; [`Error::Stopped`].
    ///
    /// # Panics
    /// When a parameter is free.
    ///
    /// ```
    /// use jurist_algebra::limits::Budget;
    /// use jurist_engine::model::{Model, ParameterBuilder, Time};
    /// use jurist_engine::problem::Ask;
    /// let (model, _) = Model::builder(Time::Continuous)
    ///     .parameter(ParameterBuilder::new("K").nominal("1"))
    ///     .characteristic("s + K*exp(-s)")
    ///     .build()?;
    /// let answer = model.ask().problem()?.rightmost_roots(3, 12, &Budget::unlimited())?;
    /// let beyond = answer.value().beyond.as_ref().unwrap();
    /// assert_eq!((answer.value().list.len(), beyond.others_left_of.to_string().as_str()), (3, "-14/5"));
    /// # Ok::<(), jurist_engine::error::Error>(())
    /// ```
    pub fn rightmost_roots(
        self: &Arc<Self>,
        wanted: usize,
        digits: usize,
        budget: &Budget,
    ) -> Result<Answer<Roots>, Error> {
        assert!(self.free().is_empty(), "a point has no free parameters");
        let narrow = Rational::from(10).pow(-(digits as i64 + 4)).expect("ten is not zero");
        // The roots are the loop's own, whatever smaller region is asked about.
        let roots = self.without_region().enclosed_roots(wanted, &narrow, budget)?;
        Ok(Answer::new(Arc::clone(self), roots))
    }

    fn enclosed_roots(&self, wanted: usize, narrow: &Rational, budget: &Budget) -> Result<Roots, Error> {
        let time = self.time();
        let (polynomial, degree, period) = exact_or_enclosed(
            budget,
            |budget| self.roots_by_polynomial(narrow, budget),
            |budget| self.roots_by_matrix(narrow, budget),
        )?;
        budget.step("enclosing the roots");
        let mut exact = None;
        let discs = match polynomial {
            Polynomial::Exact(p) if p.coeffs().is_empty() => {
                return Err(Error::Undefined(
                    "the characteristic polynomial is zero, so that every number is a root".into(),
                ));
            }
            Polynomial::Exact(p) => {
                let discs = complex_roots(&p, narrow, budget)?;
                exact = Some(p);
                discs
            }
            Polynomial::Enclosed(discs) => discs,
            Polynomial::Delayed(p, tau) => {
                let with_conjugates = |radius: &Rational| rightmost(&p, &tau, wanted, radius, degree, budget);
                let algebra = self.algebra_over_symbols(budget)?;
                return match algebra.complex() {
                    Some(whole) => rightmost_of_complex(whole, algebra, narrow, budget, with_conjugates),
                    None => with_conjugates(narrow),
                };
            }
        };
        let found: usize = discs.iter().map(number).sum();
        let root = |disc| ClosedLoopRoot { disc, time, period: period.clone(), is_on_boundary: false };
        let mut list: Vec<ClosedLoopRoot> = discs.into_iter().map(root).collect();
        if let Some(p) = exact {
            tell_boundary(&mut list, || budget.enter(|| count_roots(&p, self.shape()).on))?;
        }
        list.sort_by_cached_key(|root| {
            std::cmp::Reverse((root.slowness(), root.disc.re.clone(), root.disc.im.clone()))
        });
        Ok(Roots { degree, infinite: degree.saturating_sub(found), list, beyond: None })
    }

    /// By the polynomial of the algebra.
    fn roots_by_polynomial(
        &self,
        narrow: &Rational,
        budget: &Budget,
    ) -> Result<(Polynomial, usize, Option<Rational>), Error> {
        let algebra = self.algebra_over_symbols(budget)?;
        let symbols = algebra.symbols();
        let undefined = || {
            let why = algebra.undefined().unwrap_or("an expression divides by zero");
            Error::Undefined(why.to_owned())
        };
        let degree = algebra.order();
        let period = algebra.sample_time().and_then(|t| t.as_constant());
        if !symbols.delays().is_empty() {
            let delayed = self.delayed(budget)?.ok_or_else(undefined)?;
            return Ok((with_dead_time(delayed), degree, period));
        }
        if let Some(whole) = algebra.complex() {
            let discs = roots_of_complex(whole, algebra, narrow, budget)?;
            return Ok((Polynomial::Enclosed(discs), degree, period));
        }
        if symbols.is_empty() {
            let p = self.parametric(budget)?.filter(|p| !p.is_undefined_at(&Rational::ZERO)).ok_or_else(undefined)?;
            return Ok((Polynomial::Exact(p.specialised(&Rational::ZERO)), degree, period));
        }
        let p = algebra.polynomial().ok_or_else(undefined)?;
        let enclosed = |bits: u64| -> Option<Vec<Ball>> {
            let values = symbols.enclosed(bits)?;
            p.coefficients.iter().map(|c| quotient_at(c, &values, bits)).collect()
        };
        // Structural zeros are exact.
        let zeros = p.coefficients.iter().take_while(|c| c.is_zero()).count();
        Ok((Polynomial::Enclosed(discs(enclosed, zeros, narrow, budget)?), degree, period))
    }

    /// By the matrix of the closed loop, as numbers.
    fn roots_by_matrix(
        &self,
        narrow: &Rational,
        budget: &Budget,
    ) -> Result<Option<(Polynomial, usize, Option<Rational>)>, Error> {
        let Some((degree, period)) = self.size_in_numbers(budget)? else { return Ok(None) };
        if self.is_written_complex() {
            return Ok(None);
        }
        let discs = discs(|bits| self.polynomial_in_numbers(bits, budget), 0, narrow, budget)?;
        Ok(Some((Polynomial::Enclosed(discs), degree, period)))
    }
}

/// The characteristic function of a loop with dead time, where that is no factor that can be left out.
fn with_dead_time(delayed: &DelayedLoop) -> Polynomial {
    if let (Some(constants), BaseDelay::Number(tau)) = (delayed.over_constants(), delayed.delay()) {
        return Polynomial::Delayed(WithDelay::Over(constants.clone()), tau.clone());
    }
    let Some(p) = delayed.quasi_polynomial() else { return Polynomial::Exact(UniPoly::zero()) };
    match delayed.delay() {
        BaseDelay::Number(tau) if p.delays() > 0 => Polynomial::Delayed(WithDelay::Exact(p), tau.clone()),
        _ => Polynomial::Exact(p.without_delay()),
    }
}

/// The roots of a polynomial. `enclosed` gives its coefficients with a number of bits; the first `zeros` coefficients, from the constant term up, are 0.
/// Roots that the last precision does not separate share a disc.
pub(super) fn discs(
    enclosed: impl Fn(u64) -> Option<Vec<Ball>>,
    zeros: usize,
    narrow: &Rational,
    budget: &Budget,
) -> Result<Vec<RootDisc>, Error> {
    let mut last: Option<Vec<RootDisc>> = None;
    ROOTS.find(|bits| -> Result<Option<()>, Error> {
        budget.check()?;
        let discs = budget.enter(|| {
            checkpoint(bits);
            enclosed(bits).and_then(|balls| root_discs(&balls[zeros.min(balls.len())..], bits))
        })?;
        let is_fine = discs.as_ref().is_some_and(|discs| discs.iter().all(|disc| disc.is_fine(narrow)));
        last = discs.or(last.take());
        Ok(is_fine.then_some(()))
    })?;
    let Some(mut discs) = last else {
        return Err(Error::Undefined("whether the leading coefficient is zero is not told by its digits".into()));
    };
    if zeros > 0 {
        discs.push(RootDisc {
            re: Rational::ZERO,
            im: Rational::ZERO,
            radius: Rational::ZERO,
            count: zeros,
            is_one: true,
            is_pair: false,
        });
    }
    Ok(discs)
}
