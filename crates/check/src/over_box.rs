//! The characteristic polynomial of a loop in all parameters of a box. Nothing is brought to lowest terms.

mod common;

use common::may_share;
pub(super) use common::separated;

use super::blocks::cleared;
use super::characteristic::{Form, closed};
use super::clock::Clock;
use super::complex::{parts, real_divisor, short, square_of_root};
use super::enclosed::Determinant;
use super::factor::{Cut, Factor, Family};
use super::model::{self, Boxed, Functions};
use super::moving::Sources;
use super::multivariate::{Fraction, Multi};
use super::number::{Q, Z};
use super::over_symbols::{determinant, primitive, substituted};
use super::statement::Extent;
use super::symbols::Table;
use num_traits::One;

/// Of this variable on, polynomials are in the parameters of the box.
pub(super) const FIRST: usize = 2;

/// Polynomials in the parameters of a box.
pub(super) struct OverBox {
    pub discrete: bool,
    /// One more than the degree with all parameters symbolic, from the constant term up: up to a factor that has no zero where the
    /// loop is defined, the characteristic polynomial.
    pub coefficients: Vec<Multi>,
    /// The loop is undefined where all polynomials of one of these lists vanish.
    pub divisors: Vec<Vec<Multi>>,
    /// Whether the loop is complex, so that it is doubled.
    pub is_doubled: bool,
    /// The imaginary parts of the coefficients, where the loop has a complex factor.
    pub imaginary: Option<Vec<Multi>>,
    /// Whether the last of them is the leading coefficient, that of a determinant.
    pub has_lead_last: bool,
    /// Polynomials that are positive wherever the loop is asked about.
    pub positive: Vec<Multi>,
    /// Whether a loop with a complex factor is complex without it.
    pub is_complex: bool,
}

/// Reads the model; `set` has the values of all parameters but those of the box. The symbols of a table are the variables behind them.
pub(super) fn over_box(
    text: &str,
    names: &[String],
    set: &[(String, Q)],
    table: &Table,
    clock: &Clock,
) -> Result<OverBox, String> {
    let boxed = Boxed { names, set, factor: None };
    with_sources(text, boxed, Functions::OfNumbers(table), By::Expansion, clock).map(|(found, _)| found)
}

/// How the determinant is taken.
#[derive(Clone, Copy)]
pub(super) enum By<'w> {
    /// As a polynomial in all variables.
    Expansion,
    /// With a number of bits, over a window of the parameters. Each coefficient is a further variable, a number.
    Enclosures { window: &'w [[Q; 2]], bits: usize },
}

/// The same with functions and holds as further variables, if they are to be read, and what these are.
pub(super) fn with_sources(
    text: &str,
    boxed: Boxed<'_>,
    functions: Functions<'_>,
    by: By<'_>,
    clock: &Clock,
) -> Result<(OverBox, Sources), String> {
    let asked = model::asked_over_box(text, boxed, functions, clock)?;
    if let Some(factor) = boxed.factor.filter(|factor| factor.needs_linear_parameter()) {
        // Linear in a gain there, or, doubled, of twice the degree.
        let factor = Factor { family: Family::Gain, ..factor.clone() };
        let (plain, _) = with_sources(text, Boxed { factor: Some(&factor), ..boxed }, functions, by, clock)?;
        let most = if plain.is_doubled { 2 } else { 1 };
        if plain.coefficients.iter().any(|c| c.degree(FIRST + boxed.names.len()) > most) {
            return Err("the loop is not linear in the parameter that is cut".into());
        }
    }
    clock.reading(|| {
        let reader = Reader { values: &asked.values, unit: asked.unit, clock };
        let positive = boxed.factor.map(|f| f.family.positive(FIRST + boxed.names.len(), clock)).transpose()?;
        let mut divisors = asked
            .divisors
            .iter()
            .map(|divisor| substituted(&divisor.coefficients(0), reader.values, clock))
            .collect::<Result<Vec<_>, _>>()?;
        let sources =
            asked.moving.map_or_else(|| Ok(Sources::default()), |moving| moving.with_values(reader.values, clock))?;
        let (mut coefficients, sources) = reader.coefficients(&asked.form, by, sources, &mut divisors)?;
        if let Some(factor) = boxed.factor.filter(|factor| factor.cut == Cut::Variable) {
            if sources.have_dead_time() {
                return Err("where the roots of a loop with dead time are has no certificate".into());
            }
            let unit = asked.unit.unwrap_or_default();
            coefficients = factor.of_variable(coefficients, FIRST + boxed.names.len(), unit, clock)?;
        }
        let [coefficients, imaginary] = reader.in_parts(coefficients);
        let found = OverBox {
            discrete: asked.discrete,
            coefficients,
            imaginary: asked.unit.map(|_| imaginary),
            divisors,
            is_doubled: asked.is_doubled,
            // With a complex factor it is looked at where roots are.
            has_lead_last: asked.unit.is_none() && !matches!(asked.form, Form::Written(_)),
            positive: positive.unwrap_or_default(),
            is_complex: asked.is_complex,
        };
        Ok((found, sources))
    })
}

/// With the values of all parameters but those of the box, and, if a variable is the imaginary unit, with `j^2 = -1`.
struct Reader<'r> {
    values: &'r [Q],
    unit: Option<usize>,
    clock: &'r Clock,
}

impl Reader<'_> {
    fn at_values(&self, rows: &[Vec<Multi>]) -> Result<Vec<Vec<Multi>>, String> {
        rows.iter().map(|row| substituted(row, self.values, self.clock)).collect()
    }

    fn reduced(&self, d: Multi) -> Result<Multi, String> {
        match self.unit {
            Some(unit) => short(&d, unit, self.clock),
            None => Ok(d),
        }
    }

    fn divisor(&self, d: Multi) -> Result<Vec<Multi>, String> {
        Ok(vec![match self.unit {
            Some(unit) => real_divisor(&d, unit, self.clock)?,
            None => d,
        }])
    }

    /// The real and the imaginary parts.
    fn in_parts(&self, coefficients: Vec<Multi>) -> [Vec<Multi>; 2] {
        let Some(unit) = self.unit else { return [coefficients, Vec::new()] };
        let (real, imaginary) = coefficients.iter().map(|c| parts(c, unit)).map(|[x, y]| (x, y)).unzip();
        [real, imaginary]
    }

    /// The coefficients of a determinant that has at most this degree.
    fn expanded(&self, rows: &[Vec<Multi>], degree: usize) -> Result<Vec<Multi>, String> {
        let d = self.reduced(determinant(rows, self.clock)?)?;
        if d.degree(0) > degree {
            return Err("a determinant has a higher degree than the model".into());
        }
        Ok(resized(&d, degree))
    }

    /// The coefficients of a loop, the variables in them that are no parameters, and by what is divided for them.
    fn coefficients(
        &self,
        form: &Form,
        by: By<'_>,
        sources: Sources,
        divisors: &mut Vec<Vec<Multi>>,
    ) -> Result<(Vec<Multi>, Sources), String> {
        let clock = self.clock;
        let (rows, degree) = match form {
            Form::Written(f) => {
                let mut both = substituted(&[f.numerator.clone(), f.whole_denominator(clock)?], self.values, clock)?;
                divisors.push(self.divisor(both.pop().unwrap_or_default())?);
                let d = self.reduced(both.pop().unwrap_or_default())?;
                let degree = self.reduced(f.numerator.clone())?.degree(0);
                return Ok((resized(&d, degree), sources));
            }
            Form::Matrix(m) => (less(m, clock)?, m.len()),
            Form::Feedback(parts) => (less(&closed(parts, clock)?, clock)?, parts[0].len()),
            Form::System((rows, degree), alone) => {
                for (rows, degree) in alone {
                    let lead = self.expanded(&self.at_values(rows)?, *degree)?.pop();
                    divisors.push(self.divisor(lead.unwrap_or_default())?);
                }
                (rows.clone(), *degree)
            }
        };
        let rows = self.at_values(&rows)?;
        let found = match by {
            By::Expansion => (self.expanded(&rows, degree)?, sources),
            By::Enclosures { window, bits } => {
                let of = Determinant { rows: &rows, degree, window, sources: &sources, bits, clock };
                let (coefficients, numbers) = of.as_further_variables()?;
                (coefficients, sources.with_numbers(numbers))
            }
        };
        if self.unit.is_none() {
            divisors.push(found.0.last().cloned().into_iter().collect());
        }
        Ok(found)
    }
}

/// So many coefficients and one.
fn resized(d: &Multi, degree: usize) -> Vec<Multi> {
    let mut coefficients = d.coefficients(0);
    coefficients.resize(degree + 1, Multi::default());
    coefficients
}

/// The rows of `zI - M`, each times its denominators.
fn less(m: &[Vec<Fraction>], clock: &Clock) -> Result<Vec<Vec<Multi>>, String> {
    let mut out = Vec::with_capacity(m.len());
    for (i, row) in m.iter().enumerate() {
        let mut entries = Vec::with_capacity(row.len());
        for (j, f) in row.iter().enumerate() {
            let minus = f.clone().negated();
            entries.push(if i == j { Fraction::variable(0).plus(&minus, clock)? } else { minus });
        }
        out.push(cleared(entries.iter().enumerate().collect(), m.len(), clock)?);
    }
    Ok(out)
}

/// `D(R z)` or `D(s - S)`, times a positive number.
pub(super) fn in_region(d: &[Multi], discrete: bool, extent: &Extent, clock: &Clock) -> Result<Vec<Multi>, String> {
    let Extent::Number(bound) = extent else { return Err("the region has no parameter here".into()) };
    let n = d.len().saturating_sub(1) as u32;
    let (top, bottom) = (bound.numer(), bound.denom());
    let (terms, bits) = size(d);
    let bits = bits + u64::from(n) * (top.bits() + bottom.bits());
    clock.hold(terms, bits)?;
    clock.spend(terms, bits, top.bits())?;
    if discrete {
        return Ok(d.iter().zip(0..).map(|(c, k)| c.scaled(&(top.pow(k) * bottom.pow(n - k)))).collect());
    }
    // b^n D(x/b - a/b) in x = b s, shifted by -a, then back.
    let mut c: Vec<Multi> = d.iter().zip(0..).map(|(c, k)| c.scaled(&bottom.pow(n - k))).collect();
    for i in 0..c.len() {
        for j in (i..c.len() - 1).rev() {
            clock.spend(1 + c[j].0.len() + c[j + 1].0.len(), bits, top.bits())?;
            c[j] = c[j].minus(&c[j + 1].scaled(top));
        }
    }
    Ok(c.iter().zip(0..).map(|(c, k)| c.scaled(&bottom.pow(k))).collect())
}

/// `(1 - s)^n D((1 + s)/(1 - s))`, whose roots are left of the imaginary axis where those of `D` are in the unit disc.
pub(super) fn in_half_plane(d: &[Multi], clock: &Clock) -> Result<Vec<Multi>, String> {
    let n = d.len() - 1;
    let (terms, bits) = size(d);
    clock.hold((n + 1).saturating_mul(terms), bits + n as u64)?;
    let mut out = vec![Multi::default(); n + 1];
    for (i, c) in d.iter().enumerate() {
        let mut factor = vec![Z::one()];
        clock.spend(n * n / 2 + (n + 1) * c.0.len(), bits + n as u64, 1)?;
        for k in 0..n {
            factor.push(Z::from(0));
            for j in (1..factor.len()).rev() {
                let before = factor[j - 1].clone();
                factor[j] = if k < i { &factor[j] + before } else { &factor[j] - before };
            }
        }
        for (target, a) in out.iter_mut().zip(&factor) {
            *target = target.plus(&c.scaled(a));
        }
    }
    Ok(out)
}

/// The number of terms, and the bits of the longest number.
fn size(d: &[Multi]) -> (usize, u64) {
    let numbers = d.iter().flat_map(|p| p.0.values());
    (numbers.clone().count(), numbers.map(Z::bits).max().unwrap_or(0))
}

/// Whether the own polynomial, or the root of a doubled one, is the given one times a common factor; the factor of the polynomial.
pub(super) fn common_factor(given: &[Multi], own: &[Multi], is_doubled: bool, clock: &Clock) -> Result<Multi, String> {
    if let Some(square) = square_of_root(given, own, is_doubled, clock)? {
        return common_factor(&square, own, false, clock);
    }
    if given.len() != own.len() {
        return Err(format!("there are {} coefficients, but the model's polynomial has {}", given.len(), own.len()));
    }
    let (given, own) = (primitive(given.to_vec(), clock)?, primitive(own.to_vec(), clock)?);
    let shortest = (0..given.len()).filter(|&k| !given[k].is_zero()).min_by_key(|&k| given[k].0.len());
    let k = shortest.ok_or("the polynomial is zero")?;
    // Gauss: the quotient by polynomials without an integer common to all is integral.
    let quotient = own[k].divided(&given[k], clock)?.ok_or_else(|| not_that(k))?;
    for (k, (g, o)) in given.iter().zip(&own).enumerate() {
        if g.times(&quotient, clock)? != *o {
            return Err(not_that(k));
        }
    }
    Ok(quotient)
}

fn not_that(k: usize) -> String {
    format!("coefficient {k} is not that of the model")
}

/// Divides a polynomial by its common divisors with the factors, again and again, until it holds no parameter. `parameters` is their number.
pub(super) fn beside_factors(p: &Multi, factors: &[Multi], parameters: usize, clock: &Clock) -> Result<Multi, String> {
    let mut p = primitive(vec![p.clone()], clock)?.swap_remove(0);
    let is_done = |p: &Multi| p.is_zero() || (FIRST..FIRST + parameters).all(|v| p.degree(v) == 0);
    // Divisions that leave nothing are most often enough, and cheap beside common divisors.
    for f in factors {
        while !is_done(&p)
            && let Some(quotient) = p.divided(f, clock)?
        {
            p = quotient;
        }
    }
    for f in factors {
        while !is_done(&p) && may_share(&p, f, FIRST..FIRST + parameters, clock)? {
            let common = p.gcd(f, clock)?;
            if common.is_constant() {
                break;
            }
            p = p.quotient(&common, clock)?;
        }
    }
    Ok(p)
}
