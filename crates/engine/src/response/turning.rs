//! How far the open loop has turned at a frequency: its phase, continued from the lowest frequency on.

use super::Frequencies;
use super::crossings::samples_between;
use super::ground::Ground;
use super::open_loop::OpenLoop;
use super::parts::{Parts, Reduced, with_parts};
use crate::stability::Shape;
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Integer, Rational, Sign};
use jurist_algebra::poly::{Domain, Poly};
use jurist_algebra::real::Real;

/// The quarter of a turn that the phase of an open loop without its dead time lies in, at every frequency.
///
/// The phase leaves a quarter only where the real or the imaginary part of `N conj(D0)` vanishes. Between neighbouring zeros one rational
/// point tells the quarter, and at one zero only one of the parts changes its sign, so that the quarters follow one another without
/// doubt. Where both vanish the open loop has poles or zeros on the boundary: these count as inside of it, so that each
/// pole takes half a turn off and each zero adds one; at the lowest frequency each integrator takes a quarter off, so that three of them
/// begin at -270 degrees. Where frequencies have a sign the phase is continued from 0 on in both directions; below 0 an integrator adds a quarter.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_engine::model::{BlockBuilder, Model, Time};
/// use jurist_engine::problem::Ask;
/// use jurist_engine::response::{OpenLoop, Turning};
/// let plant = BlockBuilder::new("plant", "r - y", "y").transfer("9/(s + 1)^5");
/// let (model, _) = Model::builder(Time::Continuous).inputs(["r"]).outputs(["y"]).block(plant).build()?;
/// let (problem, budget) = (model.ask().problem()?, Budget::unlimited());
/// let turning = Turning::of(&OpenLoop::of(&problem, None, &budget)?, &budget)?;
/// assert_eq!(turning.middle(&"-1/100".parse().unwrap()), -45);
/// assert_eq!(turning.middle(&(-100).into()), -405); // -5 arctan 10 = -421 degrees
/// # Ok::<(), jurist_engine::error::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Turning {
    /// Where the phase leaves its quarter, ascending in the variable of [`Frequencies`].
    zeros: Vec<Rational>,
    /// Between them: the quarter from 90 degrees times this number on.
    quarters: Vec<i64>,
}

/// Digits that tell on which side of a zero a frequency is.
const DIGITS: usize = 17;

impl Turning {
    /// Of an open loop; its dead time turns it further by `-omega tau`.
    ///
    /// Cost: isolation of the zeros of a polynomial of about twice the order, and a few signs between any two.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out, or two zeros are not told apart.
    pub fn of(open_loop: &OpenLoop, budget: &Budget) -> Result<Turning, Exhausted> {
        with_parts!(open_loop, parts => Turning::over(parts, budget))
    }

    /// The middle of the quarter, in degrees, at a point of the boundary given by the variable of [`Frequencies`]: the phase is at most 45
    /// degrees away, or one quarter more next to a zero.
    pub fn middle(&self, x: &Rational) -> i64 {
        90 * self.quarters[self.zeros.partition_point(|zero| zero < x)] + 45
    }

    fn over<G: Ground>(parts: &Parts<G>, budget: &Budget) -> Result<Turning, Exhausted> {
        let (r, ground, frequencies) = (&parts.reduced, &parts.ground, parts.frequencies());
        let sides = budget.enter(|| Sides::of(r))?;
        let all = sides.product();
        let zeros = if all.is_constant() { Vec::new() } else { ground.zeros(&all, &frequencies.inner(), budget)? };
        let cell = |sample| Cell::at(&sides, &Real::from(sample), ground, budget);
        let samples = samples_between(&zeros, frequencies, budget)?;
        let found = samples.into_iter().map(cell).collect::<Result<Vec<_>, _>>()?;
        let mut quarters = vec![0; found.len()];
        let integrators = integrators(parts);
        if frequencies.are_signed() {
            // From the frequency 0 on, where x is 0, both ways.
            let mut below = 0;
            while below < zeros.len() && budget.enter(|| zeros[below].sign())?.is_lt() {
                below += 1;
            }
            let is_zero = below < zeros.len() && budget.enter(|| zeros[below].sign())?.is_eq();
            let above = below + usize::from(is_zero);
            quarters[below] = found[below].first(-integrators);
            for next in (0..below).rev() {
                quarters[next] = quarters[next + 1] - found[next].turn_to(&found[next + 1]);
            }
            quarters[above] = found[above].first(integrators);
            for next in above + 1..found.len() {
                quarters[next] = quarters[next - 1] + found[next - 1].turn_to(&found[next]);
            }
        } else {
            // From the lowest frequency on, where x is greatest.
            let last = found.len() - 1;
            quarters[last] = found[last].first(integrators);
            for next in (0..last).rev() {
                quarters[next] = quarters[next + 1] + found[next + 1].turn_to(&found[next]);
            }
        }
        let middle = |zero: &Real| {
            let (lo, hi) = zero.refined_to_digits(DIGITS).enclosure();
            lo.midpoint(&hi)
        };
        let zeros = budget.enter(|| zeros.iter().map(middle).collect())?;
        Ok(Turning { zeros, quarters })
    }
}

/// How many more poles than zeros an open loop has at the lowest frequency, `z = 1` or `s = 0`.
fn integrators<G: Ground>(parts: &Parts<G>) -> i64 {
    // |z - 1|^2 = 2 - x; where frequencies have a sign a root there is a double zero at 0.
    let (at, power) = match parts.frequencies() {
        Frequencies::Positive(Shape::UnitDisc) => (2, 1),
        Frequencies::Positive(Shape::LeftHalfPlane) => (0, 1),
        Frequencies::Signed(_) => (0, 2),
    };
    let root = Poly::new(vec![G::Number::from_integer(&Integer::from(-at)), G::Number::one()]);
    let count = |p: &Poly<G::Number>| {
        let quotients = std::iter::successors(Some(p.clone()), |p| p.div_exact(&root).filter(|q| !q.is_zero()));
        quotients.count() as i64 - 1
    };
    (count(&parts.reduced.denominator_squared) - count(&parts.reduced.numerator_squared)) / power
}

/// Twice the real part of `N conj(D0)` and its imaginary part as an open loop has them, in factors.
struct Sides<R: Domain> {
    /// Both without what they have in common.
    real: Poly<R>,
    imaginary: Poly<R>,
    /// What they have in common, where it is negative the open loop has turned by half a turn.
    common: Poly<R>,
    /// The zeros of what they have in common: those of the denominator and of the numerator, as products of powers: the factor at `k`
    /// has the zeros of multiplicity `k + 1` at least.
    poles: Vec<Poly<R>>,
    zeros: Vec<Poly<R>>,
}

impl<R: Domain> Sides<R> {
    fn of(r: &Reduced<R>) -> Sides<R> {
        let (real, imaginary) = (&r.twice_real, &r.imaginary);
        let common = r.common(real, imaginary);
        let divided = |p: &Poly<R>, by: &Poly<R>| p.div_exact(by).expect("a gcd divides");
        let of_poles = r.common(&common, &r.denominator_squared);
        let of_zeros = divided(&common, &of_poles);
        let [real, imaginary] = [real, imaginary].map(|p| divided(p, &common));
        Sides { real, imaginary, poles: multiple(of_poles), zeros: multiple(of_zeros), common }
    }

    /// A polynomial that vanishes wherever a part changes its sign.
    fn product(&self) -> Poly<R> {
        let all = [&self.real, &self.imaginary].into_iter().chain(self.poles.first()).chain(self.zeros.first());
        let product = all.filter(|p| !p.is_zero()).fold(Poly::one(), |product, p| product.times(p));
        let repeated = product.gcd(&product.derivative());
        if product.is_constant() { product } else { product.div_exact(&repeated).expect("a gcd divides") }
    }
}

/// Polynomials with simple zeros: the first has all zeros of this one, the second those that are at least double, and so on.
fn multiple<R: Domain>(p: Poly<R>) -> Vec<Poly<R>> {
    let (mut out, mut p) = (Vec::new(), p);
    while !p.is_constant() {
        let repeated = p.gcd(&p.derivative());
        out.push(p.div_exact(&repeated).expect("a gcd divides"));
        p = repeated;
    }
    out
}

/// The signs in a cell between two zeros.
struct Cell {
    /// Of both parts without their common factor.
    sides: [Sign; 2],
    common: Sign,
    poles: Vec<Sign>,
    zeros: Vec<Sign>,
}

impl Cell {
    fn at<G: Ground>(sides: &Sides<G::Number>, x: &Real, ground: &G, budget: &Budget) -> Result<Cell, Exhausted> {
        let sign = |p: &Poly<G::Number>| ground.sign_at(p, x, budget);
        let each = |list: &[Poly<G::Number>]| list.iter().map(sign).collect::<Result<Vec<Sign>, Exhausted>>();
        Ok(Cell {
            sides: [sign(&sides.real)?, sign(&sides.imaginary)?],
            common: sign(&sides.common)?,
            poles: each(&sides.poles)?,
            zeros: each(&sides.zeros)?,
        })
    }

    /// The quarter from 0 on, without the common factor; a part that is zero everywhere counts as positive.
    fn quarter(&self) -> i64 {
        match self.sides.map(Sign::is_lt) {
            [false, false] => 0,
            [true, false] => 1,
            [true, true] => 2,
            [false, true] => 3,
        }
    }

    /// The quarter of the lowest frequencies: the one with the middle nearest to -90 degrees for each integrator.
    fn first(&self, integrators: i64) -> i64 {
        let quarter = self.quarter() + if self.common.is_lt() { 2 } else { 0 };
        (quarter + integrators + 2).rem_euclid(4) - 2 - integrators
    }

    /// The quarters turned to a neighbour at higher frequencies.
    fn turn_to(&self, next: &Cell) -> i64 {
        let own = match (next.quarter() - self.quarter()).rem_euclid(4) {
            3 => -1,
            turn => turn,
        };
        let passed = |a: &[Sign], b: &[Sign]| a.iter().zip(b).filter(|(a, b)| a != b).count() as i64;
        own - 2 * passed(&self.poles, &next.poles) + 2 * passed(&self.zeros, &next.zeros)
    }
}
