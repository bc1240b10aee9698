//! Where a requirement on the open loop may begin or cease to be met: functions of what is free, of real loops and of complex ones.

use super::Frequencies;
use super::parts::Reduced;
use super::requirement::{Circle, Requirement, Rule};
use crate::stability::Shape;
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::Integer;
use jurist_algebra::poly::{Domain, Poly, RealAlgebraic};

/// Functions of what is free, at whose zeros a requirement may begin or cease to be met.
pub(crate) struct Boundaries<R> {
    /// All of them.
    pub zeros: Vec<R>,
    /// Where a crossing may appear at once: not known by continuity.
    pub touches: R,
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

/// An open loop `N/D0` in lowest terms along the boundary, and how the frequency is eliminated.
pub(super) struct Along<'q, R: Domain, E> {
    pub by: &'q E,
    pub reduced: Reduced<R>,
    /// Numbers whose quotient is that of `N` and `D0` where the open loop is real at an end of the range of frequencies, whatever is free: a root passes there at the
    /// factor `-D0/N`. Neither is zero.
    pub at_ends: Vec<(R, R)>,
    pub budget: &'q Budget,
}

impl<'q, R: Domain, E: Elimination<R>> Along<'q, R, E> {
    /// Where a requirement may begin or cease to be met.
    pub fn boundaries(&self, requirement: &Requirement) -> Result<Boundaries<E::Left>, Exhausted> {
        match requirement.rule() {
            Rule::Circle(circle) => self.of_circle(circle),
            Rule::Turned { twice_cosine } => self.of_turn(twice_cosine),
            Rule::Factors(factor) => self.of_factors(factor),
            Rule::Sector(_) | Rule::DeadTime(_) | Rule::Modulus { .. } => {
                Ok(Boundaries { zeros: Vec::new(), touches: self.one() })
            }
        }
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
        let [u, v] = circle.combined().map(Integer::from);
        let excess = self.by.excess(circle, &self.reduced.sum_squared, &self.reduced.combined_squared(&u, &v));
        // Where the content is zero, all frequencies pass to the other side at once.
        let (content, excess) = self.budget.enter(|| (excess.content(), excess.square_free_part()))?;
        let mut zeros = self.zeros_at_ends(&excess);
        zeros.extend((!content.is_zero()).then(|| self.by.function(content)));
        zeros.push(self.repeated(&excess)?);
        Ok(Boundaries { zeros, touches: self.one() })
    }

    /// Modulus one, and the real part is minus the cosine: `twice_real + 2 cos |N|^2 = 0`. Of a gain, `N` is a multiple.
    fn of_turn(&self, twice_cosine: &RealAlgebraic) -> Result<Boundaries<E::Left>, Exhausted> {
        let Reduced { numerator_squared: above, denominator_squared: below, twice_real, .. } = &self.reduced;
        let excess = without_common(&above.minus(below), &[below, twice_real], self.budget)?;
        // At an end of the range L = 1: where it is -1 there, stability ends.
        let ends = self.at_ends.iter().map(|(d, n)| n.minus(d));
        let ends = ends.chain(excess.leading().cloned()).filter(|f| !f.is_zero());
        let mut zeros: Vec<_> = ends.map(|f| self.by.function(f)).collect();
        zeros.push(self.eliminated(&excess, twice_real, above, twice_cosine)?);
        zeros.push(self.repeated(&excess)?);
        Ok(Boundaries { zeros, touches: self.repeated(&excess)? })
    }

    /// Real, and the factor makes it -1: `2 |D0|^2 + k twice_real = 0`.
    fn of_factors(&self, factor: &RealAlgebraic) -> Result<Boundaries<E::Left>, Exhausted> {
        let (mut zeros, mut touches) = (Vec::new(), self.one());
        let Reduced { denominator_squared: below, twice_real, imaginary, .. } = &self.reduced;
        if !imaginary.is_zero() {
            let twice_below = &below.scaled(&integer(2));
            let imaginary = without_common(imaginary, &[below, twice_real], self.budget)?;
            zeros.extend(self.zeros_at_ends(&imaginary));
            zeros.push(self.eliminated(&imaginary, twice_below, twice_real, factor)?);
            zeros.push(self.eliminated(&imaginary, twice_real, twice_below, factor)?);
            zeros.push(self.repeated(&imaginary)?);
            touches = self.repeated(&imaginary)?;
        }
        for (a, b) in &self.at_ends {
            for (a, b) in [(a, b), (b, a)] {
                zeros.push(self.by.sum(a, b, factor, self.budget)?);
            }
        }
        Ok(Boundaries { zeros, touches })
    }

    /// The values at the ends of the range of frequencies, and the leading coefficient.
    fn zeros_at_ends(&self, p: &Poly<R>) -> Vec<E::Left> {
        let mut out: Vec<R> = match self.reduced.frequencies {
            Frequencies::Positive(Shape::UnitDisc) => [2, -2].map(|x| p.eval(&integer(x))).to_vec(),
            Frequencies::Positive(Shape::LeftHalfPlane) => vec![p.coeff(0)],
            Frequencies::Signed(_) => Vec::new(),
        };
        out.extend(p.leading().cloned());
        out.into_iter().filter(|f| !f.is_zero()).map(|f| self.by.function(f)).collect()
    }
}

pub(super) fn integer<R: Domain>(x: i64) -> R {
    R::from_integer(&Integer::from(x))
}

/// The polynomial without what it has in common with all others.
fn without_common<R: Domain>(p: &Poly<R>, others: &[&Poly<R>], budget: &Budget) -> Result<Poly<R>, Exhausted> {
    budget.enter(|| {
        let common = others.iter().fold(p.clone(), |g, q| g.gcd(q));
        p.div_exact(&common).expect("a gcd divides").square_free_part()
    })
}
