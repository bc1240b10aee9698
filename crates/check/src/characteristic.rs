//! The characteristic polynomial of a loop whose entries are evaluated, in one parameter.

use super::blocks::Ordered;
use super::clock::Clock;
use super::determinant::{Entry, determinant};
use super::multivariate::{Fraction, Multi};
use super::number::{Q, Z};
use super::univariate::{Uni, common_denominator};
use num_traits::{One, Signed, Zero};
use std::collections::BTreeSet;

/// A polynomial in `z` or `s` whose coefficients are polynomials in the parameter.
pub(super) struct Characteristic {
    /// Whether time is discrete.
    pub discrete: bool,
    /// Whether it is that of a complex loop, doubled.
    pub is_doubled: bool,
    /// The degree with all parameters symbolic.
    pub degree: usize,
    /// `degree + 1` coefficients from the constant term up: up to a factor that does not vanish where
    /// the loop is defined, the characteristic polynomial.
    pub coefficients: Vec<Uni>,
    /// The loop is undefined at the zeros of these; everywhere if one of them is zero.
    pub poles: Vec<Uni>,
}

/// What a loop is, evaluated.
pub(super) enum Form {
    /// A characteristic polynomial as written, over a denominator.
    Written(Fraction),
    /// `zI - M`: the entries of `M`.
    Matrix(Vec<Vec<Fraction>>),
    /// `A - B K C`.
    Feedback([Vec<Vec<Fraction>>; 4]),
    /// A polynomial system matrix and the degree of its determinant, and those of blocks alone.
    System(Ordered, Vec<Ordered>),
}

/// Numerator and denominator, by powers of the parameter.
type Quotient = (Vec<Q>, Vec<Q>);

/// A fraction with all parameters but the kept one replaced by their values: numerator and denominator as
/// polynomials in the kept parameter. The fraction does not contain variable 0.
fn in_parameter(f: &Fraction, numbers: &[Q], clock: &Clock) -> Result<Option<Quotient>, String> {
    let numerator = f.numerator.specialised(1, numbers, clock)?.swap_remove(0);
    let denominator = f.whole_denominator(clock)?.specialised(1, numbers, clock)?.swap_remove(0);
    Ok(if denominator.iter().all(Zero::is_zero) { None } else { Some((numerator, denominator)) })
}

/// Cleared of denominators; a positive factor does not matter.
fn cleared(rows: &[Vec<Q>]) -> Vec<Uni> {
    let d = common_denominator(rows.iter().flatten());
    rows.iter().map(|row| Uni::new(row.iter().map(|q| q.numer() * (&d / q.denom())).collect())).collect()
}

/// The polynomial with all parameters but the one in question replaced by their values.
pub(super) fn specialised(
    form: &Form,
    divisors: &BTreeSet<Multi>,
    discrete: bool,
    numbers: &[Q],
    clock: &Clock,
) -> Result<Characteristic, String> {
    let mut poles = Vec::new();
    for divisor in divisors {
        // Undefined where all coefficients in variable 0 vanish together.
        let mut common = Uni::default();
        for part in cleared(&divisor.specialised(1, numbers, clock)?) {
            common = common.gcd(&part, clock)?;
        }
        poles.push(common);
    }
    let (coefficients, denominator, degree) = over_denominator(form, numbers, &mut poles, clock)?;
    let coefficients = if denominator.is_zero() {
        poles.push(Uni::default());
        Vec::new()
    } else {
        in_lowest_terms(coefficients, &denominator, degree, clock)?
    };
    Ok(Characteristic { discrete, is_doubled: false, degree, coefficients, poles })
}

/// Coefficients, the denominator they stand over, and the degree with all parameters symbolic.
type OverDenominator = (Vec<Uni>, Uni, usize);

/// The denominator is zero where the polynomial is undefined everywhere; other new places of being undefined are noted.
fn over_denominator(
    form: &Form,
    numbers: &[Q],
    poles: &mut Vec<Uni>,
    clock: &Clock,
) -> Result<OverDenominator, String> {
    let of_matrix = |m: &[Vec<Fraction>]| match matrix_entries(m, numbers, clock)? {
        Some(entries) => monic(entries, m.len(), clock),
        None => Ok((Vec::new(), Uni::default(), m.len())),
    };
    match form {
        Form::Written(f) => {
            let mut all = f.numerator.specialised(1, numbers, clock)?;
            all.extend(f.whole_denominator(clock)?.specialised(1, numbers, clock)?);
            let mut all = cleared(&all);
            let denominator = all.pop().unwrap_or_default();
            Ok((all, denominator, f.numerator.degree(0)))
        }
        Form::Matrix(m) => of_matrix(m),
        Form::Feedback(parts) => of_matrix(&closed(parts, clock)?),
        Form::System(whole, alone) => {
            let specialised = |(rows, degree): &Ordered| {
                let mut entries = Vec::with_capacity(rows.len());
                for row in rows {
                    let parts = row.iter().map(|m| m.specialised(1, numbers, clock)).collect::<Result<Vec<_>, _>>()?;
                    entries.push(clear_row(&parts));
                }
                monic(entries, *degree, clock)
            };
            // A block keeps its order, the connection is well posed, where its leading coefficient is not zero.
            for block in alone {
                poles.push(specialised(block)?.1);
            }
            let found = specialised(whole)?;
            poles.push(found.1.clone());
            Ok(found)
        }
    }
}

/// Over the least common denominator of the coefficients in lowest terms.
fn in_lowest_terms(
    mut coefficients: Vec<Uni>,
    denominator: &Uni,
    degree: usize,
    clock: &Clock,
) -> Result<Vec<Uni>, String> {
    let mut common = denominator.clone();
    for c in &coefficients {
        common = common.gcd(c, clock)?;
    }
    let negative = denominator.leading().is_negative();
    for c in &mut coefficients {
        if !c.is_zero() {
            let scale = c.content(clock)?;
            let quotient = c.divided(&common, clock)?.ok_or("internal: a gcd does not divide")?;
            *c = quotient.scaled(&if negative { -scale } else { scale });
        }
    }
    coefficients.resize(degree + 1, Uni::default());
    primitive(coefficients, clock)
}

/// Divided by the greatest common divisor of all integers in it.
pub(super) fn primitive(coefficients: Vec<Uni>, clock: &Clock) -> Result<Vec<Uni>, String> {
    let g = super::univariate::gcd_of(coefficients.iter().flat_map(|c| c.0.iter()), clock)?;
    if g.is_zero() || g.is_one() {
        return Ok(coefficients);
    }
    Ok(coefficients.into_iter().map(|c| Uni(c.0.iter().map(|x| x / &g).collect())).collect())
}

/// The determinant's coefficients with the leading one as denominator.
fn monic(entries: Vec<Vec<Entry>>, degree: usize, clock: &Clock) -> Result<OverDenominator, String> {
    let coefficients = determinant(&entries, clock)?;
    if coefficients.len() > degree + 1 {
        return Err("a determinant has a higher degree than the model".into());
    }
    let lead = coefficients.get(degree).cloned().unwrap_or_default();
    Ok((coefficients, lead, degree))
}

/// `zQ - N`, where the row denominators `Q` are cleared; `None` when one vanishes identically.
fn matrix_entries(m: &[Vec<Fraction>], numbers: &[Q], clock: &Clock) -> Result<Option<Vec<Vec<Entry>>>, String> {
    let mut out = Vec::new();
    for (i, row) in m.iter().enumerate() {
        let mut parts = Vec::new();
        for f in row {
            let Some(part) = in_parameter(f, numbers, clock)? else { return Ok(None) };
            let common = common_denominator(part.0.iter().chain(&part.1));
            let side = |c: &[Q]| Uni::new(c.iter().map(|q| q.numer() * (&common / q.denom())).collect());
            let (mut n, mut d) = (side(&part.0), side(&part.1));
            if n.is_zero() {
                d = Uni::constant(Z::one());
            }
            // Lowest terms keep the row's denominator small; the places of division are noted already.
            let g = n.gcd(&d, clock)?;
            if g.degree() > 0 {
                let (cn, cd) = (n.content(clock)?, d.content(clock)?);
                let reduced =
                    |p: &Uni| p.divided(&g, clock)?.ok_or_else(|| "internal: a gcd does not divide".to_owned());
                (n, d) = (reduced(&n)?.scaled(&cn), reduced(&d)?.scaled(&cd));
            }
            parts.push((n, d));
        }
        // Least common multiple of the denominators, up to integers.
        let mut common = Uni::constant(Z::one());
        for (_, d) in &parts {
            let g = common.gcd(d, clock)?;
            let rest = d.divided(&g, clock)?.ok_or("internal: a gcd does not divide")?;
            common = common.product(&rest, clock)?;
        }
        let mut contents = Z::one();
        for (_, d) in &parts {
            let c = d.content(clock)?;
            contents = &contents / super::univariate::gcd_counted(&contents, &c, clock)? * c;
        }
        let common = common.scaled(&contents);
        let mut entries = Vec::new();
        for (j, (n, d)) in parts.iter().enumerate() {
            let factor = common.divided(d, clock)?.ok_or("internal: a common multiple is none")?;
            // common = factor d times a rational number, fixed by the leading coefficients.
            let scale = Q::new(common.leading(), factor.leading() * d.leading());
            if !scale.is_integer() {
                return Err("internal: a common multiple is not integral".into());
            }
            let minus = n.product(&factor, clock)?.scaled(&-scale.to_integer());
            entries.push(if i == j { Entry(vec![minus, common.clone()]) } else { Entry(vec![minus]) });
        }
        out.push(entries);
    }
    Ok(Some(out))
}

/// A row of polynomials in variable 0 and the parameter, cleared of denominators together.
fn clear_row(parts: &[Vec<Vec<Q>>]) -> Vec<Entry> {
    let d = common_denominator(parts.iter().flatten().flatten());
    let uni = |c: &Vec<Q>| Uni::new(c.iter().map(|q| q.numer() * (&d / q.denom())).collect());
    parts.iter().map(|entry| Entry(entry.iter().map(uni).collect())).collect()
}

/// `A - B K C`.
pub(super) fn closed([a, b, c, k]: &[Vec<Vec<Fraction>>; 4], clock: &Clock) -> Result<Vec<Vec<Fraction>>, String> {
    let bkc = product(&product(b, k, clock)?, c, clock)?;
    let mut m = a.clone();
    for (entry, f) in m.iter_mut().flatten().zip(bkc.into_iter().flatten()) {
        *entry = entry.plus(&f.negated(), clock)?;
    }
    Ok(m)
}

fn product(a: &[Vec<Fraction>], b: &[Vec<Fraction>], clock: &Clock) -> Result<Vec<Vec<Fraction>>, String> {
    let mut out = Vec::new();
    for row in a {
        let mut sums = Vec::new();
        for j in 0..b.first().map_or(0, Vec::len) {
            let mut sum = Fraction::number(&Q::zero());
            for (x, r) in row.iter().zip(b).filter(|(x, r)| !x.numerator.is_zero() && !r[j].numerator.is_zero()) {
                sum = sum.plus(&x.times(&r[j], clock)?, clock)?;
            }
            sums.push(sum);
        }
        out.push(sums);
    }
    Ok(out)
}
