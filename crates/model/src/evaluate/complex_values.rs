//! Complex values. The imaginary unit is one more variable. Its square is -1, so that each value has one form.

use super::scalar::{Scope, Variable, checked_product};
use super::walk::{Failure, division_by_zero, too_large};
use crate::complex::{Parts, has_unit, parts_of};
use crate::error::{Code, Diagnostic, Span};
use crate::text::{Expression, Function};
use jurist_algebra::poly::RationalFunction;

impl Scope<'_> {
    /// A function of a complex value: its parts, its conjugate, and `exp(a + jb) = exp(a) (cos b + j sin b)`.
    pub(super) fn call_of_complex(
        &mut self,
        function: Function,
        value: &RationalFunction,
        span: Span,
    ) -> Result<RationalFunction, Failure> {
        let Parts { re, im } = parts_of(value, self.unit).ok_or_else(|| division_by_zero(span))?;
        let unit = self.imaginary_unit();
        match function {
            Function::Re => Ok(re),
            Function::Im => Ok(im),
            Function::Conj => Ok(&re - &(&unit * &im)),
            Function::Exp => {
                let length = self.call(Function::Exp, re, span)?;
                let (x, y) = (self.call(Function::Cos, im.clone(), span)?, self.call(Function::Sin, im, span)?);
                checked_product(&length, &(&x + &(&unit * &y))).ok_or_else(|| too_large(span))
            }
            _ => {
                let message = format!("'{}' of a complex value", function.name());
                let error = Diagnostic::error(Code::Complex, message).at(span, "contains the imaginary unit");
                let help = "functions of complex values are exp, conj, re and im; exp(j*phi) is cos(phi) + j*sin(phi)";
                Err(error.help(help).into())
            }
        }
    }

    /// The imaginary unit.
    pub fn imaginary_unit(&mut self) -> RationalFunction {
        let unit = self.variable(Variable::Unit);
        self.unit = self.variables.iter().position(|v| *v == Variable::Unit);
        unit
    }

    /// The value with `j^2 = -1`, and a real denominator; `None` where it divides by zero.
    pub fn reduced(&self, value: RationalFunction) -> Option<RationalFunction> {
        match self.unit.filter(|_| has_unit(&value, self.unit)) {
            Some(unit) => Some(parts_of(&value, Some(unit))?.joined(unit)),
            None => Some(value),
        }
    }

    /// The value of an expression that has to be real.
    pub fn real(&mut self, e: &Expression) -> Result<RationalFunction, Failure> {
        let value = self.scalar(e)?;
        if has_unit(&value, self.unit) {
            let error = Diagnostic::error(Code::Complex, "a real value belongs here").at(e.span, "a complex value");
            return Err(error.help("re(..) is the real part of a value, im(..) its imaginary part").into());
        }
        Ok(value)
    }
}
