//! From a resolved question to algebra: the model is evaluated once, and the region's bound put in.

use super::region::{Bound, Region};
use super::resolved::Problem;
use super::substitution::{scaled_by_radius, shifted_by_decay};
use crate::error::Error;
use crate::model::{ClosedLoop, ComplexPolynomial, Evaluated, Model, Symbols, Time};
use crate::stability::ParametricPolynomial;
use crate::stability::boxes::on_line;
use jurist_algebra::limits::Budget;
use jurist_algebra::matrix::CharacteristicPolynomial;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{Domain, MultiPoly, RationalFunction};

/// What the model says to a question.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_engine::model::{Model, ParameterBuilder, Time};
/// use jurist_engine::problem::Ask;
/// let (model, _) = Model::builder(Time::Discrete)
///     .parameter(ParameterBuilder::new("K").nominal("1"))
///     .characteristic("z^2 - z + K/2")
///     .build()?;
/// let (problem, budget) = (model.ask().free("K").problem()?, Budget::unlimited());
/// let algebra = problem.algebra(&budget)?;
/// let polynomial = algebra.polynomial().unwrap();
/// assert_eq!(algebra.formal_degree(), 2);
/// assert_eq!(polynomial.coefficients[0].display(&polynomial.variables).to_string(), "K/2");
/// # Ok::<(), jurist_engine::error::Error>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Algebra {
    polynomial: Option<CharacteristicPolynomial>,
    undefined: Option<String>,
    complex: Option<ComplexPolynomial>,
    is_complex: bool,
    formal_degree: usize,
    sample_time: Option<RationalFunction>,
    closed_loop: Option<ClosedLoop>,
    symbols: Symbols,
}

impl Algebra {
    /// Evaluates the model for a question. The polynomial's variables are what is free.
    pub(super) fn of(problem: &Problem, budget: &Budget) -> Result<Algebra, Error> {
        Algebra::near(problem, &[], budget)
    }

    /// The same where dead times have as many whole samples as near these values of what is free.
    pub(super) fn near(problem: &Problem, near: &[Rational], budget: &Budget) -> Result<Algebra, Error> {
        budget.step("characteristic polynomial");
        let model = problem.model();
        let bound =
            problem.free().iter().position(|f| problem.region().is_free() && f.name == problem.region().bound_name());
        let kept: Vec<String> =
            problem.free().iter().enumerate().filter(|(i, _)| Some(*i) != bound).map(|(_, f)| f.name.clone()).collect();
        let evaluated =
            known(problem, budget).unwrap_or_else(|| model.evaluate_near(&kept, problem.set(), near, budget));
        let evaluated = match evaluated {
            Ok(evaluated) => evaluated,
            Err(Error::Undefined(why)) => {
                let (formal_degree, is_complex) = symbolic_degree(model, &kept, problem.set(), budget)?;
                let undefined = Some(why);
                return Ok(Algebra { undefined, formal_degree, is_complex, ..Algebra::default() });
            }
            Err(failure) => return Err(failure),
        };
        let Evaluated { mut polynomial, complex, closed_loop, sample_time, symbols, .. } = evaluated;
        if let Some(closed_loop) = closed_loop.as_ref().filter(|_| !symbols.delays().is_empty()) {
            // The monic polynomial would divide by functions of s.
            polynomial.coefficients.iter_mut().for_each(|c| *c = &*c * &closed_loop.leading);
            polynomial.monic = false;
        }
        let polynomial = match bound {
            None => polynomial,
            Some(at) => make_room(polynomial, at, problem.region().bound_name()),
        };
        let sample_time = sample_time.filter(|_| problem.time() == Time::Discrete);
        let sample_time = match bound {
            None => sample_time,
            Some(at) => sample_time.map(|t| shifted(&t, at)),
        };
        let complex = match (complex, bound) {
            (Some(complex), Some(at)) => complex.try_map(|f| Some(shifted(f, at))),
            (complex, _) => complex,
        };
        Ok(Algebra {
            formal_degree: polynomial.formal_degree,
            is_complex: complex.is_some(),
            complex,
            polynomial: Some(in_region(polynomial, problem.region(), bound)),
            undefined: None,
            sample_time,
            closed_loop,
            symbols,
        })
    }

    /// Algebra of a loop in discrete time whose coefficients are known by their values; the region's bound is in the polynomial.
    pub(super) fn of_values(
        polynomial: CharacteristicPolynomial,
        sample_time: Option<RationalFunction>,
        symbols: Symbols,
    ) -> Algebra {
        let formal_degree = polynomial.formal_degree;
        Algebra { polynomial: Some(polynomial), formal_degree, sample_time, symbols, ..Algebra::default() }
    }

    /// What the polynomial's variables beyond the free names stand for; none where everything is rational.
    ///
    /// Where the bound of the region is free it is one more variable before the symbols.
    pub fn symbols(&self) -> &Symbols {
        &self.symbols
    }

    /// The characteristic polynomial in the free parameters, the region's bound put in; `None` where the loop is undefined
    /// whatever they are.
    pub fn polynomial(&self) -> Option<&CharacteristicPolynomial> {
        self.polynomial.as_ref()
    }

    /// The characteristic polynomial `D` itself, without the region's bound, where it is complex: [`Algebra::polynomial`] is then
    /// `D conj(D)`, with each root of `D` and its conjugate.
    pub fn complex(&self) -> Option<&ComplexPolynomial> {
        self.complex.as_ref()
    }

    /// Whether the loop is complex: each of its roots is then counted with its conjugate.
    pub fn is_complex(&self) -> bool {
        self.is_complex
    }

    /// The order of the loop: the degree of its characteristic polynomial while all parameters are symbolic.
    pub fn order(&self) -> usize {
        if self.is_complex { self.formal_degree / 2 } else { self.formal_degree }
    }

    /// Why the loop is undefined whatever the free parameters are.
    pub fn undefined(&self) -> Option<&str> {
        self.undefined.as_deref()
    }

    /// The degree of the polynomial while all parameters are symbolic; of a complex loop twice the order.
    pub fn formal_degree(&self) -> usize {
        self.formal_degree
    }

    /// The sample time in the free parameters, in discrete time and if the model gives one.
    pub fn sample_time(&self) -> Option<&RationalFunction> {
        self.sample_time.as_ref()
    }

    /// The closed loop in state space, where the model has states and is defined.
    pub(super) fn state_space(&self) -> Option<&ClosedLoop> {
        self.closed_loop.as_ref()
    }

    pub(super) fn closed_loop(&self, model: &Model) -> Result<&ClosedLoop, Error> {
        match (&self.closed_loop, &self.undefined) {
            (Some(closed_loop), _) => Ok(closed_loop),
            (None, Some(why)) => Err(Error::Undefined(why.clone())),
            (None, None) => Err(model.has_no_states()),
        }
    }

    /// What is left where one of two free parameters has a value, for one who has the polynomial in another form.
    pub(super) fn beside_polynomial(&self, fixed: usize, value: &Rational) -> Algebra {
        let left = |f: &RationalFunction| f.substitute(fixed, value)?.map_variables(|_| 0);
        let sample_time = self.sample_time.as_ref().and_then(left);
        let undefined = self.undefined.clone();
        let (formal_degree, is_complex) = (self.formal_degree, self.is_complex);
        let complex = self.complex.as_ref().and_then(|d| d.try_map(left));
        Algebra { undefined, complex, is_complex, formal_degree, sample_time, ..Algebra::default() }
    }

    /// What is left where one of two free parameters has a value.
    pub(super) fn on_line(&self, fixed: usize, value: &Rational) -> Algebra {
        let left = |f: &RationalFunction| f.substitute(fixed, value)?.map_variables(|_| 0);
        let polynomial = self.polynomial.as_ref().and_then(|d| {
            let poles: Vec<MultiPoly> =
                d.poles.iter().map(|p| p.substitute(fixed, value).0.map_variables(|_| 0)).collect();
            let coefficients = d.coefficients.iter().map(left).collect::<Option<Vec<_>>>()?;
            let variables = vec![d.variables[1 - fixed].clone()];
            (!poles.iter().any(MultiPoly::is_zero)).then(|| CharacteristicPolynomial {
                variables,
                coefficients,
                poles,
                ..d.clone()
            })
        });
        let undefined = polynomial.is_none().then(|| "an expression divides by zero".to_owned());
        Algebra { undefined: self.undefined.clone().or(undefined), polynomial, ..self.beside_polynomial(fixed, value) }
    }
}

impl Problem {
    /// The characteristic polynomial `D` itself with the region's bound put in, where it is complex.
    ///
    /// Cost: that of [`Problem::algebra_over_symbols`].
    ///
    /// # Errors
    /// As [`Problem::algebra_over_symbols`].
    pub(crate) fn complex_in_region(&self, budget: &Budget) -> Result<Option<ComplexPolynomial>, Error> {
        let algebra = self.algebra_over_symbols(budget)?;
        let (Some(whole), Some(product)) = (algebra.complex(), algebra.polynomial()) else { return Ok(None) };
        let bound = self.free().iter().position(|f| self.region().is_free() && f.name == self.region().bound_name());
        let part = |list: &[RationalFunction]| {
            let coefficients = list.to_vec();
            in_region(CharacteristicPolynomial { coefficients, ..product.clone() }, self.region(), bound).coefficients
        };
        Ok(Some(ComplexPolynomial::new(part(&whole.re), part(&whole.im))))
    }
}

impl Algebra {
    /// What is left where all free parameters move along the line `base + t step`; `t` is the only variable.
    pub(super) fn on_ray(&self, name: &str, base: &[Rational], step: &[Rational]) -> Algebra {
        if !self.symbols.is_empty() {
            return self.on_ray_over_symbols(name, base, step);
        }
        let left = |f: &RationalFunction| {
            let [above, below] = on_line([f.numerator(), f.denominator()], base, step);
            RationalFunction::new(MultiPoly::from_univariate(&above, 0), MultiPoly::from_univariate(&below, 0))
        };
        let polynomial = self.polynomial.as_ref().and_then(|d| {
            let one = MultiPoly::one();
            let pole = |p: &MultiPoly| MultiPoly::from_univariate(&on_line([p, &one], base, step)[0], 0);
            let poles: Vec<MultiPoly> = d.poles.iter().map(pole).collect();
            let coefficients = d.coefficients.iter().map(left).collect::<Option<Vec<_>>>()?;
            let variables = vec![name.to_owned()];
            (!poles.iter().any(MultiPoly::is_zero)).then(|| CharacteristicPolynomial {
                variables,
                coefficients,
                poles,
                ..d.clone()
            })
        });
        self.moved(polynomial, &left, self.symbols.clone())
    }

    /// The same where there are symbols, which stay variables after the one.
    fn on_ray_over_symbols(&self, name: &str, base: &[Rational], step: &[Rational]) -> Algebra {
        let t = RationalFunction::variable(0);
        let on_line =
            base.iter().zip(step).map(|(b, s)| &RationalFunction::from(b.clone()) + &(&t * &s.clone().into()));
        let images: Vec<RationalFunction> =
            on_line.chain((1..=self.symbols.iter().count()).map(RationalFunction::variable)).collect();
        let left = |f: &RationalFunction| f.compose(&images);
        let pole = |p: &MultiPoly| Some(left(&p.clone().into())?.numerator().clone());
        let symbols = self.symbols.along(name, &images);
        let polynomial = self.polynomial.as_ref().zip(symbols.as_ref()).and_then(|(d, symbols)| {
            let poles = d.poles.iter().map(pole).collect::<Option<Vec<_>>>()?;
            let coefficients = d.coefficients.iter().map(left).collect::<Option<Vec<_>>>()?;
            let variables = symbols.variables();
            let is_defined = !poles.iter().any(MultiPoly::is_zero);
            is_defined.then(|| CharacteristicPolynomial { variables, coefficients, poles, ..d.clone() })
        });
        self.moved(polynomial, &left, symbols.unwrap_or_default())
    }

    /// The algebra of the same loop on a line.
    fn moved(
        &self,
        polynomial: Option<CharacteristicPolynomial>,
        left: &dyn Fn(&RationalFunction) -> Option<RationalFunction>,
        symbols: Symbols,
    ) -> Algebra {
        let undefined = polynomial.is_none().then(|| "an expression divides by zero".to_owned());
        Algebra {
            undefined: self.undefined.clone().or(undefined),
            polynomial,
            complex: self.complex.as_ref().and_then(|d| d.try_map(left)),
            is_complex: self.is_complex,
            formal_degree: self.formal_degree,
            sample_time: self.sample_time.as_ref().and_then(left),
            closed_loop: None,
            symbols,
        }
    }
}

/// What follows from the closed loop of a point in numbers, where that is known and rational.
fn known(problem: &Problem, budget: &Budget) -> Option<Result<Evaluated, Error>> {
    problem.known_in_numbers()?.evaluated(budget).transpose()
}

/// The polynomial of one kept parameter (or none) in the form that is decided.
pub(super) fn parametric(d: &CharacteristicPolynomial) -> ParametricPolynomial {
    let side = |p: &MultiPoly| p.to_univariate(0).expect("one variable is kept");
    let coefficients: Vec<_> = d.coefficients.iter().map(|c| (side(c.numerator()), side(c.denominator()))).collect();
    let poles = d.univariate_poles().expect("one variable is kept");
    let poles = poles.into_iter().filter(|p| !p.is_constant() || p.is_zero()).collect();
    ParametricPolynomial::new(&coefficients, d.formal_degree, poles)
}

/// The polynomial with the bound of the region put in.
pub(super) fn in_region(
    d: CharacteristicPolynomial,
    region: &Region,
    bound: Option<usize>,
) -> CharacteristicPolynomial {
    let put = |value: &Bound| match (value, bound) {
        (Bound::Number(value), _) => RationalFunction::from(value.clone()),
        (Bound::Free, at) => RationalFunction::variable(at.expect("a free bound is among what is free")),
    };
    match region {
        Region::Disc(Bound::Number(r)) if r.is_one() => d,
        Region::HalfPlane(Bound::Number(s)) if s.is_zero() => d,
        Region::Disc(value) => scaled_by_radius(&d, &put(value)),
        Region::HalfPlane(value) => shifted_by_decay(&d, &put(value)),
    }
}

/// The same polynomial with one more variable, on which it does not depend yet.
fn make_room(d: CharacteristicPolynomial, at: usize, name: &str) -> CharacteristicPolynomial {
    let mut variables = d.variables;
    variables.insert(at, name.to_owned());
    CharacteristicPolynomial {
        variables,
        coefficients: d.coefficients.iter().map(|c| shifted(c, at)).collect(),
        poles: d.poles.iter().map(|p| p.map_variables(|i| i + usize::from(i >= at))).collect(),
        ..d
    }
}

fn shifted(f: &RationalFunction, at: usize) -> RationalFunction {
    f.map_variables(|i| i + usize::from(i >= at)).expect("no two variables become one")
}

/// The degree where the values set leave the loop undefined: that of the polynomial before any was set; and whether the loop is complex.
fn symbolic_degree(
    model: &Model,
    kept: &[String],
    set: &[(String, Rational)],
    budget: &Budget,
) -> Result<(usize, bool), Error> {
    let is_parameter = |name: &String| model.parameter(name).is_some();
    let parameters = model.parameters().iter().map(|p| p.name.clone());
    let all: Vec<String> = parameters.chain(kept.iter().filter(|n| !is_parameter(n)).cloned()).collect();
    let constants: Vec<_> = set.iter().filter(|(name, _)| !is_parameter(name)).cloned().collect();
    match model.evaluate(&all, &constants, budget) {
        Ok(evaluated) => Ok((evaluated.polynomial.formal_degree, evaluated.complex.is_some())),
        // The order depends on the values: by a dead time that is no fixed number of samples.
        Err(Error::Refused(_)) => Ok((0, false)),
        Err(other) => Err(other),
    }
}
