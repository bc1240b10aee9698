//! Sturm's theorem for a polynomial whose coefficients are polynomials in an algebraic number.

use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Integer, Rational, Sign};
use jurist_algebra::poly::real_roots::{sign_variations, signed_remainder_sequence_by};
use jurist_algebra::poly::{Domain, Poly, RealAlgebraic, UniPoly};
use std::cmp::Ordering;

/// The signed remainder sequence of `f(c, y)` and its derivative, for an algebraic number `c` and over an
/// interval of `y` whose finite ends are no roots: their linear factors are divided out first.
///
/// Coefficients are reduced modulo the polynomial of `c`; one is zero when its exact sign at `c` is.
pub(super) struct SturmAt<'a> {
    sequence: Vec<Poly<UniPoly>>,
    c: &'a RealAlgebraic,
    lower: Option<&'a Rational>,
    upper: Option<&'a Rational>,
}

impl<'a> SturmAt<'a> {
    /// The sequence; `None` when `f(c, y)` vanishes identically.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out.
    pub fn new(
        f: &Poly<UniPoly>,
        c: &'a RealAlgebraic,
        lower: Option<&'a Rational>,
        upper: Option<&'a Rational>,
        budget: &Budget,
    ) -> Result<Option<Self>, Exhausted> {
        let mut first = reduced(f, c);
        if first.is_zero() {
            return Ok(None);
        }
        for end in [lower, upper].into_iter().flatten() {
            while !first.is_constant() && sign_at(&first, c, end).is_eq() {
                first = reduced(&without_root(&first, end), c);
            }
        }
        let sequence = budget.enter(|| {
            let derivative = reduced(&first.derivative(), c);
            signed_remainder_sequence_by(first, derivative, |p| reduced(&p, c), |lead| c.sign_of(lead))
        })?;
        Ok(Some(SturmAt { sequence, c, lower, upper }))
    }

    /// The number of distinct real roots strictly between the ends, both of which are finite.
    pub fn count_inside(&self) -> Option<usize> {
        Some(self.count(self.lower?, self.upper?))
    }

    fn is_root(&self, y: &Rational) -> bool {
        sign_at(&self.sequence[0], self.c, y).is_eq()
    }

    /// The number of distinct real roots between two numbers that are no roots.
    fn count(&self, low: &Rational, high: &Rational) -> usize {
        self.variations(|p| sign_at(p, self.c, low)) - self.variations(|p| sign_at(p, self.c, high))
    }

    /// The number of distinct real roots.
    fn count_all(&self) -> usize {
        let lead = |p: &Poly<UniPoly>| p.leading().map_or(Ordering::Equal, |l| self.c.sign_of(l));
        let at_minus_infinity = |p: &Poly<UniPoly>| {
            let sign = lead(p);
            if p.coeffs().len().is_multiple_of(2) { sign.reverse() } else { sign }
        };
        self.variations(at_minus_infinity) - self.variations(lead)
    }

    fn variations(&self, sign: impl Fn(&Poly<UniPoly>) -> Sign) -> usize {
        sign_variations(self.sequence.iter().map(sign))
    }

    /// One rational in each open piece that the distinct roots cut the interval into, ascending.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out.
    pub fn points_between_roots(&self, budget: &Budget) -> Result<Vec<Rational>, Exhausted> {
        let mut far = Rational::ONE;
        let two = Rational::from(2);
        loop {
            budget.check()?;
            let within = |end: Option<&Rational>| end.is_none_or(|e| e.abs() < far);
            let minus = -&far;
            let free = !self.is_root(&far) && !self.is_root(&minus);
            if within(self.lower) && within(self.upper) && free && self.count(&minus, &far) == self.count_all() {
                break;
            }
            far *= &two;
        }
        let low = match self.lower {
            None => -&far,
            Some(end) => self.close_to(end, &far, budget)?,
        };
        let high = match self.upper {
            None => far,
            Some(end) => self.close_to(end, &-far, budget)?,
        };
        let mut points = vec![low.clone()];
        if low < high {
            self.split(&low, &high, self.count(&low, &high), &mut points, budget)?;
        }
        Ok(points)
    }

    /// A point from a finite end towards another, inside the interval, with no root in between.
    fn close_to(&self, end: &Rational, towards: &Rational, budget: &Budget) -> Result<Rational, Exhausted> {
        let inside = |y: &Rational| self.lower.is_none_or(|l| l < y) && self.upper.is_none_or(|u| y < u);
        let mut point = end.midpoint(towards);
        loop {
            budget.check()?;
            let (a, b) = if *end < point { (end, &point) } else { (&point, end) };
            if inside(&point) && !self.is_root(&point) && self.count(a, b) == 0 {
                return Ok(point);
            }
            point = end.midpoint(&point);
        }
    }

    /// Adds points so that there is one root between neighbours, up to and including `high`.
    fn split(
        &self,
        low: &Rational,
        high: &Rational,
        roots: usize,
        points: &mut Vec<Rational>,
        budget: &Budget,
    ) -> Result<(), Exhausted> {
        budget.check()?;
        if roots <= 1 {
            if roots == 1 {
                points.push(high.clone());
            }
            return Ok(());
        }
        let mut middle = low.midpoint(high);
        while self.is_root(&middle) {
            middle = low.midpoint(&middle);
        }
        let left = self.count(low, &middle);
        self.split(low, &middle, left, points, budget)?;
        self.split(&middle, high, roots - left, points, budget)
    }
}

/// The sign of `p(c, y)` at a rational `y`.
fn sign_at(p: &Poly<UniPoly>, c: &RealAlgebraic, y: &Rational) -> Sign {
    let (a, q) = (y.numerator(), y.denominator());
    let mut acc = UniPoly::zero();
    let mut power = Integer::ONE;
    for coefficient in p.coeffs().iter().rev() {
        acc = acc.scaled(&a).plus(&coefficient.scaled(&power));
        power = &power * &q;
    }
    c.sign_of(&acc)
}

/// The quotient of `q^d p` by `q y - a` up to a positive factor, for a root `a/q` of `p(c, y)`.
fn without_root(p: &Poly<UniPoly>, root: &Rational) -> Poly<UniPoly> {
    let (a, q) = (root.numerator(), root.denominator());
    let divisor = Poly::new(vec![UniPoly::constant(-a), UniPoly::constant(q)]);
    p.pseudo_div_rem(&divisor).0
}

/// The same values at `c` up to one positive factor: coefficients reduced modulo the polynomial of `c`,
/// those at the top that vanish at `c` dropped, integer content removed.
fn reduced(p: &Poly<UniPoly>, c: &RealAlgebraic) -> Poly<UniPoly> {
    let modulus = c.polynomial();
    let m = modulus.coeffs().len();
    let longest = p.coeffs().iter().map(|k| k.coeffs().len()).max().unwrap_or(0);
    let mut coeffs = p.coeffs().to_vec();
    if longest >= m {
        // Pseudo-division multiplies by a power of the leading coefficient, which is positive; all
        // coefficients are to be multiplied by the same power.
        let lead = modulus.leading().expect("not zero");
        let steps = longest - m + 1;
        for k in &mut coeffs {
            let own = (k.coeffs().len() + 1).saturating_sub(m);
            *k = k.pseudo_rem(modulus).scaled(&lead.pow((steps - own) as u64));
        }
    }
    while coeffs.last().is_some_and(|k| c.sign_of(k).is_eq()) {
        coeffs.pop();
    }
    let content = coeffs.iter().fold(Integer::ZERO, |g, k| g.gcd(&k.content()));
    if !content.is_zero() && !content.is_one() {
        for k in &mut coeffs {
            *k = k.div_exact_scalar(&content).expect("the content divides");
        }
    }
    Poly::new(coeffs)
}
