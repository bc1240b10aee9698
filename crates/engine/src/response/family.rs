//! The open loop with a parameter left in it, and where its margins may pass a required value.

use super::open_loop::OpenLoop;
use super::opened::OpenedLoop;
use super::place::{modulus_squared, product};
use super::requirement::{Circle, Requirement, Rule};
use crate::error::{Code, Diagnostic, Error};
use crate::model::{Cut, Opened};
use crate::problem::{Problem, fixed_symbols};
use crate::stability::Shape;
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{
    Domain, MultiPoly, Poly, RationalFunction, RealAlgebraic, UniPoly, discriminant, resultant,
};
use jurist_algebra::symbols::{Symbols, common_scale};
use std::sync::Arc;

/// Polynomials in what is free: in one parameter, or in two.
pub(crate) trait Parameters: Domain {
    /// True if symbols may follow the parameters.
    const HAS_SYMBOLS: bool;
    /// With the parameters as the first variables.
    fn lifted(&self) -> MultiPoly;
    /// From one in the first variables only.
    fn lowered(p: &MultiPoly) -> Self;
    /// Polynomials at a point, all times one positive integer, in symbols as their table numbers them.
    fn at_point(list: &[Self], point: &[Rational]) -> Vec<MultiPoly>;
}

impl Parameters for UniPoly {
    const HAS_SYMBOLS: bool = false;

    fn lifted(&self) -> MultiPoly {
        MultiPoly::from_univariate(self, 0)
    }
    fn lowered(p: &MultiPoly) -> Self {
        p.to_univariate(0).expect("one variable is left")
    }
    fn at_point(list: &[Self], point: &[Rational]) -> Vec<MultiPoly> {
        common_scale(&list.iter().map(Self::lifted).collect::<Vec<_>>(), &point[0])
    }
}

impl Parameters for MultiPoly {
    const HAS_SYMBOLS: bool = true;

    fn lifted(&self) -> MultiPoly {
        self.clone()
    }
    fn lowered(p: &MultiPoly) -> Self {
        p.clone()
    }
    fn at_point(list: &[Self], point: &[Rational]) -> Vec<MultiPoly> {
        point.iter().fold(list.to_vec(), |list, value| common_scale(&list, value))
    }
}

/// The open loop with what is free left in it: polynomials in the frequency's variable over those in the parameters.
pub(crate) struct Family<R> {
    quotient: Quotient<R>,
    sample_time: Option<Rational>,
    cut: Cut,
    /// The number of parameters.
    free: usize,
    /// The symbols that follow them.
    pub symbols: Arc<Symbols>,
    /// Where the open loop is undefined.
    pub undefined: R,
}

/// `N/D0` over a ring in which the parameters are.
pub(super) struct Quotient<R> {
    pub denominator: Poly<R>,
    pub numerator: Poly<R>,
    pub shape: Shape,
}

/// How the variable of the frequency is eliminated, and a required number `alpha` that is not rational.
pub(super) trait Elimination<R: Domain> {
    /// A function of the parameters.
    type Left;

    /// One that is known.
    fn function(&self, f: R) -> Self::Left;

    /// What is zero where `p` and `a + alpha b` have a common root.
    fn common_root(
        &self,
        p: &Poly<R>,
        a: &Poly<R>,
        b: &Poly<R>,
        alpha: &RealAlgebraic,
        budget: &Budget,
    ) -> Result<Self::Left, Exhausted>;

    /// What is zero where `a + alpha b` is.
    fn sum(&self, a: &R, b: &R, alpha: &RealAlgebraic, budget: &Budget) -> Result<Self::Left, Exhausted>;

    /// What is negative where the condition of a circle is violated, of the squares of `|D0 + N|` and of the combination.
    fn excess(&self, circle: &Circle, sum_squared: &Poly<R>, combined_squared: &Poly<R>) -> Poly<R> {
        circle.excess(sum_squared, combined_squared)
    }

    /// What is zero where a square-free polynomial of degree 2 at least has a repeated root.
    fn discriminant(&self, p: &Poly<R>, budget: &Budget) -> Result<Self::Left, Exhausted>;
}

/// By resultants that are expanded; conjugates of the required number come with it.
struct Expanded {
    /// The variable of the required number.
    variable: usize,
}

/// Functions of what is free, at whose zeros a requirement may begin or cease to be met.
pub(crate) struct Boundaries<R> {
    /// All of them.
    pub zeros: Vec<R>,
    /// Where a crossing may appear at once: not known by continuity.
    pub touches: R,
}

impl<R: Parameters> Family<R> {
    pub fn of(problem: &Problem, at: Option<&str>, budget: &Budget) -> Result<Family<R>, Error> {
        Family::of_cut(problem, problem.model().cut(at)?, budget)
    }

    pub fn of_cut(problem: &Problem, cut: Cut, budget: &Budget) -> Result<Family<R>, Error> {
        let mut opened = OpenedLoop::of(problem, cut, budget)?;
        if !R::HAS_SYMBOLS {
            opened = opened.without_symbols()?;
        }
        let symbols = Arc::new(fixed_symbols(&opened.symbols)?);
        let (quotient, undefined) = opened.quotient(R::lowered, budget)?;
        let sample_time = opened.sample_time.and_then(|t| t.as_constant());
        Ok(Family { quotient, sample_time, cut: opened.cut, free: problem.free().len(), symbols, undefined })
    }

    /// `D0` and `N` with the open loop `N/D0`, in the variable of the closed loop.
    pub fn parts(&self) -> [&Poly<R>; 2] {
        [&self.quotient.denominator, &self.quotient.numerator]
    }

    /// `N/D0`.
    pub(super) fn quotient(&self) -> &Quotient<R> {
        &self.quotient
    }

    /// The open loop at a point.
    pub fn at(&self, point: &[Rational]) -> OpenLoop {
        let Quotient { denominator, numerator, shape } = &self.quotient;
        let all: Vec<R> = denominator.coeffs().iter().chain(numerator.coeffs()).cloned().collect();
        let mut at = R::at_point(&all, point);
        let above = Poly::new(at.split_off(denominator.coeffs().len()));
        OpenLoop::over_symbols(
            self.cut.clone(),
            (Poly::new(at), above),
            &self.symbols,
            *shape,
            self.sample_time.clone(),
        )
    }

    pub fn boundaries(&self, requirement: &Requirement, budget: &Budget) -> Result<Boundaries<R>, Exhausted> {
        self.quotient.boundaries(&Expanded { variable: self.free + self.symbols.len() }, requirement, budget)
    }
}

impl<R: Domain> Quotient<R> {
    /// From the cut to the cut, and the common denominator of all coefficients. A closed loop `N/D` is that of `N/(D - N)`.
    pub fn of(
        Opened { system, is_closed, .. }: &Opened,
        shape: Shape,
        ring: impl Fn(&MultiPoly) -> R,
        budget: &Budget,
    ) -> Result<(Quotient<R>, R), Error> {
        let column = system.inputs.len().max(system.e.columns()) - 1;
        let transfer = system.between(0, column).transfer_function_at(0, column, budget)?;
        let signed = |f: &RationalFunction| if *is_closed { f.clone() } else { -f };
        let all: Vec<RationalFunction> =
            transfer.denominator.coefficients.iter().cloned().chain(transfer.numerator.iter().map(signed)).collect();
        budget
            .enter(|| {
                let common = all.iter().fold(R::one(), |l, f| {
                    let d = ring(f.denominator());
                    l.times(&d.div_exact(&l.gcd(&d)).expect("a gcd divides"))
                });
                let cleared = |f: &RationalFunction| {
                    let factor = common.div_exact(&ring(f.denominator())).expect("a common multiple");
                    ring(f.numerator()).times(&factor)
                };
                let split = transfer.denominator.coefficients.len();
                let denominator: Poly<R> = Poly::new(all[..split].iter().map(cleared).collect());
                let numerator: Poly<R> = Poly::new(all[split..].iter().map(cleared).collect());
                let denominator = if *is_closed { denominator.minus(&numerator) } else { denominator };
                (Quotient { denominator, numerator, shape }, common)
            })
            .map_err(Error::from)
    }

    /// Where a requirement may begin or cease to be met.
    pub fn boundaries<E: Elimination<R>>(
        &self,
        by: &E,
        requirement: &Requirement,
        budget: &Budget,
    ) -> Result<Boundaries<E::Left>, Exhausted> {
        let along = Along::of(self, by, budget)?;
        match requirement.rule() {
            Rule::Circle(circle) => along.of_circle(circle),
            Rule::Turned { twice_cosine } => along.of_turn(twice_cosine),
            Rule::Factors(factor) => along.of_factors(factor),
            Rule::Sector(_) | Rule::DeadTime(_) | Rule::Modulus { .. } => {
                Ok(Boundaries { zeros: Vec::new(), touches: along.one() })
            }
        }
    }

    /// With other coefficients.
    pub fn map<S: Domain>(&self, f: impl Fn(&R) -> S) -> Quotient<S> {
        Quotient { denominator: self.denominator.map(&f), numerator: self.numerator.map(&f), shape: self.shape }
    }
}

/// An open loop `N/D0` in lowest terms along the boundary, and how the frequency is eliminated.
struct Along<'q, R, E> {
    by: &'q E,
    shape: Shape,
    d: Poly<R>,
    n: Poly<R>,
    degree: usize,
    /// `|D0|^2`.
    below: Poly<R>,
    /// Twice the real part of `N conj(D0)`.
    twice_real: Poly<R>,
    imaginary: Poly<R>,
    budget: &'q Budget,
}

impl<'q, R: Domain, E: Elimination<R>> Along<'q, R, E> {
    fn of(quotient: &Quotient<R>, by: &'q E, budget: &'q Budget) -> Result<Self, Exhausted> {
        let shape = quotient.shape;
        let common = budget.enter(|| quotient.denominator.gcd(&quotient.numerator))?;
        let divided = |p: &Poly<R>| p.div_exact(&common).expect("a gcd divides");
        let (d, n) = (divided(&quotient.denominator), divided(&quotient.numerator));
        let degree = d.coeffs().len().max(n.coeffs().len()) - 1;
        let below = modulus_squared(&d, degree, shape);
        let (twice_real, imaginary) = product(&n, &d, degree, shape);
        Ok(Along { by, shape, d, n, degree, below, twice_real, imaginary, budget })
    }

    fn squared(&self, p: &Poly<R>) -> Poly<R> {
        modulus_squared(p, self.degree, self.shape)
    }

    fn one(&self) -> E::Left {
        self.by.function(R::one())
    }

    fn repeated(&self, p: &Poly<R>) -> Result<E::Left, Exhausted> {
        match p.degree() {
            Some(2..) => self.by.discriminant(p, self.budget),
            _ => Ok(self.one()),
        }
    }

    fn eliminated(&self, p: &Poly<R>, a: &Poly<R>, b: &Poly<R>, alpha: &RealAlgebraic) -> Result<E::Left, Exhausted> {
        match p.is_constant() {
            true => Ok(self.one()),
            false => self.by.common_root(p, a, b, alpha, self.budget),
        }
    }

    fn of_circle(&self, circle: &Circle) -> Result<Boundaries<E::Left>, Exhausted> {
        let (sum, combined) = (self.d.plus(&self.n), circle.combination(&self.d, &self.n));
        let excess = self.by.excess(circle, &self.squared(&sum), &self.squared(&combined));
        // Where the content is zero, all frequencies pass to the other side at once.
        let (content, excess) = self.budget.enter(|| (excess.content(), excess.square_free_part()))?;
        let mut zeros = self.at_ends(&excess);
        zeros.extend((!content.is_zero()).then(|| self.by.function(content)));
        zeros.push(self.repeated(&excess)?);
        Ok(Boundaries { zeros, touches: self.one() })
    }

    /// Modulus one, and the real part is minus the cosine: `twice_real + 2 cos |N|^2 = 0`. Of a gain, `N` is a multiple.
    fn of_turn(&self, twice_cosine: &RealAlgebraic) -> Result<Boundaries<E::Left>, Exhausted> {
        let above = self.squared(&self.n);
        let excess = without_common(&above.minus(&self.below), &[&self.below, &self.twice_real], self.budget)?;
        // At an end of the range L = 1: where it is -1 there, stability ends.
        let ends = self.values_at_ends().into_iter().map(|(d, n)| n.minus(&d));
        let ends = ends.chain(excess.leading().cloned()).filter(|f| !f.is_zero());
        let mut zeros: Vec<_> = ends.map(|f| self.by.function(f)).collect();
        zeros.push(self.eliminated(&excess, &self.twice_real, &above, twice_cosine)?);
        zeros.push(self.repeated(&excess)?);
        Ok(Boundaries { zeros, touches: self.repeated(&excess)? })
    }

    /// Real, and the factor makes it -1: `2 |D0|^2 + k twice_real = 0`.
    fn of_factors(&self, factor: &RealAlgebraic) -> Result<Boundaries<E::Left>, Exhausted> {
        let (mut zeros, mut touches) = (Vec::new(), self.one());
        if !self.imaginary.is_zero() {
            let (twice_real, twice_below) = (&self.twice_real, &self.below.scaled(&integer(2)));
            let imaginary = without_common(&self.imaginary, &[&self.below, twice_real], self.budget)?;
            zeros.extend(self.at_ends(&imaginary));
            zeros.push(self.eliminated(&imaginary, twice_below, twice_real, factor)?);
            zeros.push(self.eliminated(&imaginary, twice_real, twice_below, factor)?);
            zeros.push(self.repeated(&imaginary)?);
            touches = self.repeated(&imaginary)?;
        }
        for (a, b) in self.values_at_ends() {
            for (a, b) in [(&a, &b), (&b, &a)] {
                zeros.push(self.by.sum(a, b, factor, self.budget)?);
            }
        }
        Ok(Boundaries { zeros, touches })
    }

    /// The values at the ends of the range of frequencies, and the leading coefficient.
    fn at_ends(&self, p: &Poly<R>) -> Vec<E::Left> {
        let mut out: Vec<R> = match self.shape {
            Shape::UnitDisc => [2, -2].map(|x| p.eval(&integer(x))).to_vec(),
            Shape::LeftHalfPlane => vec![p.coeff(0)],
        };
        out.extend(p.leading().cloned());
        out.into_iter().filter(|f| !f.is_zero()).map(|f| self.by.function(f)).collect()
    }

    /// `D0` and `N` at the real ends: a root passes there at the factor `-D0/N`.
    fn values_at_ends(&self) -> Vec<(R, R)> {
        let at = |x: i64| (self.d.eval(&integer(x)), self.n.eval(&integer(x)));
        let mut out = match self.shape {
            Shape::UnitDisc => vec![at(1), at(-1)],
            Shape::LeftHalfPlane => vec![at(0), (self.d.coeff(self.degree), self.n.coeff(self.degree))],
        };
        out.retain(|(a, b)| !a.is_zero() && !b.is_zero());
        out
    }
}

impl<R: Parameters> Elimination<R> for Expanded {
    type Left = R;

    fn function(&self, f: R) -> R {
        f
    }

    fn common_root(
        &self,
        p: &Poly<R>,
        a: &Poly<R>,
        b: &Poly<R>,
        alpha: &RealAlgebraic,
        budget: &Budget,
    ) -> Result<R, Exhausted> {
        if let Some(alpha) = alpha.exact() {
            return resultant(p, &plus_multiple(a, b, &alpha), budget);
        }
        let lift = |p: &Poly<R>| p.map(R::lifted);
        let with = lift(a).plus(&lift(b).scaled(&MultiPoly::variable(self.variable)));
        let value = resultant(&lift(p), &with, budget)?;
        self.norm_of(&value, alpha, budget)
    }

    fn sum(&self, a: &R, b: &R, alpha: &RealAlgebraic, budget: &Budget) -> Result<R, Exhausted> {
        if let Some(alpha) = alpha.exact() {
            return Ok(plus_multiple_of(a, b, &alpha));
        }
        self.norm_of(&a.lifted().plus(&b.lifted().times(&MultiPoly::variable(self.variable))), alpha, budget)
    }

    fn discriminant(&self, p: &Poly<R>, budget: &Budget) -> Result<R, Exhausted> {
        discriminant(p, budget)
    }
}

impl Expanded {
    /// The resultant with the polynomial of `alpha`, the variable after those that are free.
    fn norm_of<R: Parameters>(
        &self,
        value: &MultiPoly,
        alpha: &RealAlgebraic,
        budget: &Budget,
    ) -> Result<R, Exhausted> {
        let in_alpha = value.as_poly_in(self.variable);
        let polynomial = alpha.polynomial().map(|c| MultiPoly::constant(c.clone()));
        let left = if in_alpha.is_constant() { in_alpha.coeff(0) } else { resultant(&in_alpha, &polynomial, budget)? };
        Ok(R::lowered(&left))
    }
}

/// The refusal of a cut through which there is no loop.
pub(super) fn nothing_comes_back(cut: &Cut) -> Error {
    let message = match cut {
        Cut::Between(between) => format!("nothing comes from '{}' to '{}'", between.input, between.output),
        _ => format!("nothing comes back to '{}': there is no loop through it", cut.name()),
    };
    Diagnostic::error(Code::Cut, message).into()
}

/// `a + alpha b` times the denominator of `alpha`.
pub(super) fn plus_multiple<R: Domain>(a: &Poly<R>, b: &Poly<R>, alpha: &Rational) -> Poly<R> {
    a.scaled(&R::from_integer(&alpha.denominator())).plus(&b.scaled(&R::from_integer(&alpha.numerator())))
}

/// The same of numbers.
pub(super) fn plus_multiple_of<R: Domain>(a: &R, b: &R, alpha: &Rational) -> R {
    a.times(&R::from_integer(&alpha.denominator())).plus(&b.times(&R::from_integer(&alpha.numerator())))
}

fn integer<R: Domain>(x: i64) -> R {
    R::from_integer(&Integer::from(x))
}

/// The polynomial without what it has in common with all others.
fn without_common<R: Domain>(p: &Poly<R>, others: &[&Poly<R>], budget: &Budget) -> Result<Poly<R>, Exhausted> {
    budget.enter(|| {
        let common = others.iter().fold(p.clone(), |g, q| g.gcd(q));
        p.div_exact(&common).expect("a gcd divides").square_free_part()
    })
}
