//! Real algebraic numbers.

use crate::errors::{About, raised};
use crate::question::number;
use crate::wait::{Patience, guarded, waited};
use jurist::{
    Budget, Code, Diagnostic, Error, Integer, RealAlgebraic, SquareFree, UniPoly, isolate_real_roots,
    isolate_real_roots_in,
};
use pyo3::prelude::*;
use std::cmp::Ordering;
use std::sync::Arc;

/// A real algebraic number: a root of an integer polynomial, told from the others by an enclosure.
#[pyclass(frozen, module = "jurist._jurist")]
pub(crate) struct Algebraic(Arc<RealAlgebraic>);

fn polynomial(coefficients: &[String]) -> Result<UniPoly, Error> {
    let integer = |text: &String| {
        let wrong = || Diagnostic::error(Code::Number, format!("the coefficient '{text}' is not an integer"));
        Integer::from_decimal(text).ok_or_else(wrong)
    };
    Ok(UniPoly::new(coefficients.iter().map(integer).collect::<Result<Vec<_>, _>>()?))
}

#[pymethods]
impl Algebraic {
    /// The only root of a polynomial (coefficients from the constant term up) in a closed interval.
    #[staticmethod]
    fn root(py: Python<'_>, coefficients: Vec<String>, lower: String, upper: String) -> PyResult<Algebraic> {
        let work = move |budget: &Budget| {
            let (p, lower, upper) = (polynomial(&coefficients)?, number(&lower)?, number(&upper)?);
            let wrong = |what: &str| Error::from(Diagnostic::error(Code::Value, what));
            let p = SquareFree::part_of(&p).ok_or_else(|| wrong("the polynomial is zero"))?;
            let mut roots = isolate_real_roots_in(&p, Some(&lower), Some(&upper), budget)?;
            for end in [&lower, &upper] {
                if p.poly().sign_at(end).is_eq() && (roots.is_empty() || lower != upper) {
                    roots.push(RealAlgebraic::from_rational(end.clone()));
                }
            }
            if lower == upper {
                roots.truncate(1);
            }
            match <[RealAlgebraic; 1]>::try_from(roots) {
                Ok([root]) => Ok(root),
                Err(all) if all.is_empty() => Err(wrong("the polynomial has no root there")),
                Err(_) => Err(wrong("the polynomial has several roots there")),
            }
        };
        let root = waited(py, &Patience::unlimited(), work)?.map_err(|e| raised(py, e, About::Question, None))?;
        Ok(Algebraic(Arc::new(root)))
    }

    /// All real roots of a polynomial, each once, in ascending order.
    #[staticmethod]
    fn roots(py: Python<'_>, coefficients: Vec<String>) -> PyResult<Vec<Algebraic>> {
        let work = move |budget: &Budget| {
            let p = SquareFree::part_of(&polynomial(&coefficients)?);
            let p = p.ok_or_else(|| Error::from(Diagnostic::error(Code::Value, "the polynomial is zero")))?;
            Ok(isolate_real_roots(&p, budget)?)
        };
        let roots = waited(py, &Patience::unlimited(), work)?.map_err(|e| raised(py, e, About::Question, None))?;
        Ok(roots.into_iter().map(|root| Algebraic(Arc::new(root))).collect())
    }

    /// A rational number.
    #[staticmethod]
    fn rational(py: Python<'_>, value: &str) -> PyResult<Algebraic> {
        let value = number(value).map_err(|e| raised(py, e, About::Question, None))?;
        Ok(Algebraic(Arc::new(RealAlgebraic::from_rational(value))))
    }

    /// Coefficients from the constant term up.
    fn polynomial(&self) -> Vec<String> {
        self.0.polynomial().coeffs().iter().map(ToString::to_string).collect()
    }

    /// The value, if it is rational.
    fn exact(&self) -> Option<String> {
        self.0.exact().map(|value| value.to_string())
    }

    /// Correctly rounded to so many significant digits.
    fn decimal(&self, py: Python<'_>, digits: usize) -> PyResult<String> {
        self.made(py, move |x| x.decimal(digits))
    }

    /// Lower and upper bound, of relative width at most `10^-(digits + 2)`.
    fn enclosure(&self, py: Python<'_>, digits: usize) -> PyResult<(String, String)> {
        self.made(py, move |x| {
            let (lower, upper) = x.refined_to_digits(digits).enclosure();
            (lower.to_string(), upper.to_string())
        })
    }

    /// The greatest integer that is not above.
    fn floor(&self, py: Python<'_>) -> PyResult<String> {
        guarded(py, || self.0.floor().to_string())
    }

    /// -1, 0 or 1: below, equal, above.
    fn compare(&self, py: Python<'_>, other: &Algebraic) -> PyResult<i8> {
        let other = Arc::clone(&other.0);
        self.made(py, move |x| sign(x.compare(&other)))
    }

    /// The same against a rational number.
    fn compare_rational(&self, py: Python<'_>, other: &str) -> PyResult<i8> {
        let other = number(other).map_err(|e| raised(py, e, About::Question, None))?;
        guarded(py, || sign(self.0.compare_rational(&other)))
    }
}

fn sign(order: Ordering) -> i8 {
    order as i8
}

impl Algebraic {
    fn made<T: Send + 'static>(
        &self,
        py: Python<'_>,
        make: impl FnOnce(&RealAlgebraic) -> T + Send + 'static,
    ) -> PyResult<T> {
        let value = Arc::clone(&self.0);
        let work = move |budget: &Budget| Ok(budget.enter(|| make(&value))?);
        waited(py, &Patience::unlimited(), work)?.map_err(|e| raised(py, e, About::Question, None))
    }
}
