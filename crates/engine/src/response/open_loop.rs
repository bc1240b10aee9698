//! The open loop as two polynomials.

use super::place::{modulus_squared, product};
use crate::error::{Diagnostic, Error};
use crate::model::{ClosedLoop, Cut, Opened};
use crate::problem::Problem;
use crate::stability::{ParametricPolynomial, Shape};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{Domain, MultiPoly, Poly, RationalFunction, UniPoly};

/// `D(z; k) = D0 + k N`: the characteristic polynomial with the factor `k` at the cut, nominally 1.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_algebra::poly::UniPoly;
/// use jurist_engine::model::{BlockBuilder, Model, Time};
/// use jurist_engine::response::OpenLoop;
/// let (model, _) = Model::builder(Time::Discrete)
///     .inputs(["r"])
///     .outputs(["y"])
///     .block(BlockBuilder::new("controller", "r - y", "u").gain("1/2"))
///     .block(BlockBuilder::new("plant", "u", "y").transfer("1/z"))
///     .build()?;
/// let (problem, budget) = (model.ask().problem()?, Budget::unlimited());
/// let open_loop = OpenLoop::of(&problem, None, &budget)?; // 0.5/z
/// assert_eq!(open_loop.denominator(), &UniPoly::from_i64(&[0, 2]));
/// assert_eq!(open_loop.numerator(), &UniPoly::from_i64(&[1]));
/// # Ok::<(), jurist_engine::error::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct OpenLoop {
    cut: Cut,
    denominator: UniPoly,
    numerator: UniPoly,
    /// Polynomials in the factor at whose zeros the model is undefined.
    poles: Vec<UniPoly>,
    shape: Shape,
    sample_time: Option<Rational>,
    reduced: Reduced,
}

/// `L` in lowest terms, and its products on the boundary, in `x`.
#[derive(Clone, Debug)]
pub(crate) struct Reduced {
    pub numerator: UniPoly,
    pub denominator: UniPoly,
    /// The greater degree of the two.
    pub degree: usize,
    /// `|N|^2`, `|D0|^2`, `|D0 + N|^2`, `|D0 - N|^2`.
    pub numerator_squared: UniPoly,
    pub denominator_squared: UniPoly,
    pub sum_squared: UniPoly,
    pub difference_squared: UniPoly,
    /// Twice the real part of `N conj(D0)`, and its imaginary part over `sin theta` or `omega`.
    pub twice_real: UniPoly,
    pub imaginary: UniPoly,
}

impl OpenLoop {
    /// The loop of a problem without free parameters, cut at a name as in [`Model::cut`](crate::model::Model::cut).
    ///
    /// Cost: that of evaluating the model, and two characteristic polynomials.
    ///
    /// # Errors
    /// [`Error::Refused`] as [`Model::cut`](crate::model::Model::cut), and where a parameter does not enter affinely or is nominally 0, or nothing
    /// comes back to the cut; [`Error::Undefined`], [`Error::Stopped`].
    ///
    /// # Panics
    /// When a parameter is free.
    pub fn of(problem: &Problem, at: Option<&str>, budget: &Budget) -> Result<OpenLoop, Error> {
        assert!(problem.free().is_empty(), "every parameter has a value");
        let model = problem.model();
        let cut = match (model.cut(at), at) {
            (Ok(cut), _) => cut,
            // Of several parameters, one that enters as a gain is meant if it is the only one.
            (Err(refused), None) => match only_gain(problem, budget)? {
                Some(name) => Cut::Gain(name),
                None => return Err(refused.into()),
            },
            (Err(refused), _) => return Err(refused.into()),
        };
        let (denominator, numerator, poles, sample_time) = match &cut {
            Cut::Gain(name) => by_gain(problem, name, budget)?,
            _ => {
                let Opened { system, sample_time } = model.opened(&cut, &[], problem.set(), budget)?;
                let (denominator, numerator) = returned(&system, budget)?;
                (denominator, numerator, Vec::new(), sample_time.and_then(|t| t.as_constant()))
            }
        };
        if numerator.is_zero() {
            let message = format!("nothing comes back to '{}': there is no loop through it", cut.name());
            return Err(Diagnostic::error("E-cut", message).into());
        }
        let shape = problem.shape();
        let reduced = budget.enter(|| Reduced::of(&numerator, &denominator, shape))?;
        Ok(OpenLoop { cut, denominator, numerator, poles, shape, sample_time, reduced })
    }

    /// From its polynomials.
    pub(crate) fn from_parts(
        cut: Cut,
        denominator: UniPoly,
        numerator: UniPoly,
        shape: Shape,
        sample_time: Option<Rational>,
    ) -> OpenLoop {
        let reduced = Reduced::of(&numerator, &denominator, shape);
        OpenLoop { cut, denominator, numerator, poles: Vec::new(), shape, sample_time, reduced }
    }

    /// Where the loop is cut.
    pub fn cut(&self) -> &Cut {
        &self.cut
    }

    /// `D0`, primitive together with `N`; hidden modes stay.
    pub fn denominator(&self) -> &UniPoly {
        &self.denominator
    }

    /// `N`.
    pub fn numerator(&self) -> &UniPoly {
        &self.numerator
    }

    /// The disc or the half plane.
    pub fn shape(&self) -> Shape {
        self.shape
    }

    /// The sample time, of a discrete loop that has one.
    pub fn sample_time(&self) -> Option<&Rational> {
        self.sample_time.as_ref()
    }

    /// `L` at a point of the boundary, given by `x = z + 1/z` or `x = s^2`: the real part, and the imaginary part divided by
    /// `sin theta` or `omega`; `None` at a pole.
    ///
    /// ```
    /// use jurist_algebra::limits::Budget;
    /// use jurist_algebra::number::Rational;
    /// use jurist_engine::model::{BlockBuilder, Model, Time};
    /// use jurist_engine::response::OpenLoop;
    /// let plant = BlockBuilder::new("plant", "r - y", "y").transfer("1/(s + 1)");
    /// let (model, _) = Model::builder(Time::Continuous).inputs(["r"]).outputs(["y"]).block(plant).build()?;
    /// let (problem, budget) = (model.ask().problem()?, Budget::unlimited());
    /// let open_loop = OpenLoop::of(&problem, None, &budget)?;
    /// let (real, imaginary) = open_loop.value_at(&Rational::from(-4)).unwrap(); // 1/(1 + 2j) = 1/5 - 2/5 j
    /// assert_eq!((real.to_string(), imaginary.to_string()), ("1/5".to_owned(), "-1/5".to_owned()));
    /// # Ok::<(), jurist_engine::error::Error>(())
    /// ```
    pub fn value_at(&self, x: &Rational) -> Option<(Rational, Rational)> {
        let r = &self.reduced;
        let below = r.denominator_squared.eval_rational(x);
        let real = r.twice_real.eval_rational(x).checked_div(&(&below + &below))?;
        Some((real, r.imaginary.eval_rational(x).checked_div(&below)?))
    }

    pub(crate) fn reduced(&self) -> &Reduced {
        &self.reduced
    }

    /// The degree of the closed loop's polynomial, with hidden modes.
    pub(crate) fn degree(&self) -> usize {
        self.denominator.coeffs().len().max(self.numerator.coeffs().len()).saturating_sub(1)
    }

    /// `D0 + k N` as a polynomial with the parameter `k`.
    pub(crate) fn in_factor(&self) -> ParametricPolynomial {
        let coefficient = |i| (Poly::new(vec![self.denominator.coeff(i), self.numerator.coeff(i)]), UniPoly::one());
        let coefficients: Vec<_> = (0..=self.degree()).map(coefficient).collect();
        ParametricPolynomial::new(&coefficients, self.degree(), self.poles.clone())
    }
}

impl Reduced {
    fn of(numerator: &UniPoly, denominator: &UniPoly, shape: Shape) -> Reduced {
        let common = numerator.gcd(denominator);
        let divided = |p: &UniPoly| p.div_exact(&common).expect("a gcd divides");
        let (numerator, denominator) = (divided(numerator), divided(denominator));
        let degree = numerator.coeffs().len().max(denominator.coeffs().len()) - 1;
        let squared = |p: &UniPoly| modulus_squared(p, degree, shape);
        let (twice_real, imaginary) = product(&numerator, &denominator, degree, shape);
        Reduced {
            numerator_squared: squared(&numerator),
            denominator_squared: squared(&denominator),
            sum_squared: squared(&denominator.plus(&numerator)),
            difference_squared: squared(&denominator.minus(&numerator)),
            degree,
            twice_real,
            imaginary,
            numerator,
            denominator,
        }
    }
}

/// `D0` and `N` of a system from the cut to the cut: what comes back has the sign of the feedback, so `L = -P`.
fn returned(system: &ClosedLoop, budget: &Budget) -> Result<(UniPoly, UniPoly), Error> {
    let column = system.inputs.len().max(system.e.columns()) - 1;
    let transfer = system.transfer_function_at(0, column, budget)?;
    let constant = |f: &RationalFunction| f.as_constant().expect("every parameter has a value");
    let below = transfer.denominator.coefficients.iter().map(constant);
    let above = transfer.numerator.iter().map(|f| -constant(f));
    Ok(integral(below.collect(), above.collect()))
}

/// Two polynomials with integer coefficients, primitive together.
pub(crate) fn integral(a: Vec<Rational>, b: Vec<Rational>) -> (UniPoly, UniPoly) {
    let split = a.len();
    let all: Vec<Rational> = a.into_iter().chain(b).collect();
    let denominator = all.iter().fold(Integer::ONE, |l, c| l.lcm(&c.denominator()));
    let cleared = |c: &Rational| c.numerator() * denominator.div_exact(&c.denominator());
    let mut all: Vec<Integer> = all.iter().map(cleared).collect();
    let content = all.iter().fold(Integer::ZERO, |g, c| g.gcd(c));
    if !content.is_zero() {
        all = all.iter().map(|c| c.div_exact(&content)).collect();
    }
    let b = all.split_off(split);
    (Poly::new(all), Poly::new(b))
}

/// `D0`, `N`, the poles in the factor, and the sample time, with a parameter as the gain.
type ByGain = (UniPoly, UniPoly, Vec<UniPoly>, Option<Rational>);

/// The polynomial in the parameter, if it is affine there.
fn affine(problem: &Problem, name: &str, budget: &Budget) -> Result<Option<ByGain>, Error> {
    let model = problem.model();
    let constant = model.constant(name).and_then(|c| c.number.clone());
    let nominal = problem.set().iter().find(|(n, _)| n == name).map(|(_, v)| v.clone()).or(constant);
    let Some(nominal) = nominal.filter(|v| !v.is_zero()) else { return Ok(None) };
    let others: Vec<(String, Rational)> = problem.set().iter().filter(|(n, _)| n != name).cloned().collect();
    let evaluated = model.evaluate(&[name.to_owned()], &others, budget)?;
    // Where the sample time depends on it, a parameter is no gain.
    let sample_time = evaluated.sample_time.map(|t| t.as_constant());
    if sample_time == Some(None) {
        return Ok(None);
    }
    let d = &evaluated.polynomial;
    let side = |p: &MultiPoly| p.to_univariate(0).expect("one variable is kept");
    let coefficients: Vec<_> = d.coefficients.iter().map(|c| (side(c.numerator()), side(c.denominator()))).collect();
    let parametric = ParametricPolynomial::new(&coefficients, d.formal_degree, Vec::new());
    let is_affine = |p: &Poly<UniPoly>| p.coeffs().iter().all(|c| c.coeffs().len() <= 2);
    // A factor that all coefficients share is part of the loop where that is affine, else it is a pole.
    let whole = parametric.polynomial().scaled(parametric.content());
    let (p, shared) = match is_affine(&whole) {
        true => (&whole, UniPoly::one()),
        false => (parametric.polynomial(), parametric.content().clone()),
    };
    if !is_affine(p) || p.coeffs().iter().all(|c| c.coeff(0).is_zero()) {
        return Ok(None);
    }
    let part = |k: usize| (0..=d.formal_degree).map(move |i| Rational::from(p.coeff(i).coeff(k)));
    let (below, above) = integral(part(0).collect(), part(1).map(|c| c * &nominal).collect());
    let poles = d.poles.iter().map(side).chain([parametric.denominator().clone(), shared]);
    // In the factor: the parameter is the factor times its nominal value p/q.
    let (up, down) = (nominal.numerator(), nominal.denominator());
    let in_factor = |pole: UniPoly| {
        let n = pole.coeffs().len().saturating_sub(1);
        let scaled = pole.coeffs().iter().enumerate();
        let terms = scaled.map(|(i, c)| c * &(up.pow(i as u64) * down.pow((n - i) as u64)));
        Poly::new(terms.collect::<Vec<Integer>>())
    };
    let poles = poles.filter(|p| !p.is_constant()).map(in_factor).collect();
    Ok(Some((below, above, poles, sample_time.flatten())))
}

fn by_gain(problem: &Problem, name: &str, budget: &Budget) -> Result<ByGain, Error> {
    affine(problem, name, budget)?.ok_or_else(|| {
        let message = format!("'{}' is not a gain of the loop", crate::model::shorten(name));
        Diagnostic::error("E-cut", message)
            .help("a parameter is one where it enters the characteristic polynomial to the first power and is not 0")
            .into()
    })
}

/// The only parameter that enters as a gain, of a loop that has no signals.
fn only_gain(problem: &Problem, budget: &Budget) -> Result<Option<String>, Error> {
    if matches!(problem.model().form(), crate::model::Form::Blocks(_)) {
        return Ok(None);
    }
    let mut found = None;
    for parameter in problem.model().parameters() {
        if affine(problem, &parameter.name, budget)?.is_some_and(|(_, n, _, _)| !n.is_zero()) {
            if found.is_some() {
                return Ok(None);
            }
            found = Some(parameter.name.clone());
        }
    }
    Ok(found)
}
