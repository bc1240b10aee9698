//! How many roots of a polynomial over symbols lie inside, on and outside the boundary.

use crate::precisions::{ROOT_COUNT, ROOTS_ON_BOUNDARY};
use crate::{AtPoint, HalfSizePair, RootCount, Shape, count_roots};
use jurist_algebra::ball::Ball;
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{Domain, MultiPoly, Poly, UniPoly, subresultant_chain};
use jurist_algebra::symbols::{SymbolicPoly, Symbols};
use std::sync::Arc;

/// The root count of a polynomial whose coefficients are numbers.
pub(super) fn at_point(
    mut coefficients: Vec<MultiPoly>,
    formal_degree: usize,
    symbols: &Arc<Symbols>,
    region: Shape,
    budget: &Budget,
) -> Result<AtPoint, Exhausted> {
    while let Some(last) = coefficients.last() {
        let named = format!("a_{}", coefficients.len() - 1);
        if !is_zero(last, &named, symbols, budget)? {
            break;
        }
        coefficients.pop();
    }
    if coefficients.is_empty() {
        return Ok(AtPoint::Zero);
    }
    let count = count(Poly::new(coefficients), symbols, region, budget)?;
    Ok(AtPoint::Defined { count, infinite: formal_degree - count.total() })
}

/// An equation is written out where it is no longer than this.
const MOST_SHOWN: usize = 160;

/// Whether a number is zero; where that is not found out, the number and its name are said.
pub(super) fn is_zero(p: &MultiPoly, name: &str, symbols: &Symbols, budget: &Budget) -> Result<bool, Exhausted> {
    symbols.is_zero(p, budget).map_err(|stopped| {
        if !stopped.stop.is_precision() {
            return stopped;
        }
        let shown = p.display(&symbols.names()).to_string();
        let equation = if shown.len() <= MOST_SHOWN { format!("{name} = {shown}") } else { name.to_owned() };
        stopped.with_open(&format!("whether {equation} is zero"))
    })
}

/// The root count of a polynomial over symbols with a leading coefficient that is not zero.
fn count(
    mut d: Poly<MultiPoly>,
    symbols: &Arc<Symbols>,
    region: Shape,
    budget: &Budget,
) -> Result<RootCount, Exhausted> {
    let mut found = RootCount::default();
    let mut open = String::new();
    let mut precisions = ROOT_COUNT.bits();
    let mut next = precisions.next();
    while let Some(bits) = next {
        let n = d.coeffs().len() - 1;
        if n == 0 {
            return Ok(found);
        }
        budget.check()?;
        let balls: Vec<Ball> = budget.enter(|| d.coeffs().iter().map(|c| symbols.enclose(c, bits)).collect())?;
        if let Some(rest) = budget.enter(|| certain_count(&balls, region))? {
            return Ok(plus(found, rest));
        }
        if bits >= ROOTS_ON_BOUNDARY
            && let Some((on, rest)) = split_ends(&d, symbols, region, budget)?
        {
            // The rest is counted with the same bits.
            found.on += on;
            d = rest;
            continue;
        }
        if bits == ROOTS_ON_BOUNDARY
            && n >= 2
            && let Some((pairs, rest)) = split_pairs(&d, symbols, region, budget)?
        {
            return Ok(plus(plus(found, pairs), count(rest, symbols, region, budget)?));
        }
        open = open_equation(&balls, region);
        next = precisions.next();
    }
    Err(ROOT_COUNT.exhausted("counting the roots").with_open(&open))
}

fn plus(a: RootCount, b: RootCount) -> RootCount {
    RootCount { inside: a.inside + b.inside, on: a.on + b.on, outside: a.outside + b.outside }
}

/// The count that all polynomials with coefficients in the balls have, if no root of any of them is on the boundary, no two are
/// mirror images in it, and none is at infinity: no root then crosses the boundary between any two of them.
pub fn certain_count(coefficients: &[Ball], region: Shape) -> Option<RootCount> {
    let n = coefficients.len() - 1;
    let certain = |b: &Ball| !b.contains_zero();
    if !certain(&coefficients[n]) {
        return None;
    }
    let ends = [1, -1].iter().all(|sign| certain(&at_end(coefficients, region, *sign)));
    if !ends || (n >= 2 && !resultant_is_certain(coefficients, region)) {
        return None;
    }
    let middle = Poly::new(coefficients.iter().map(Ball::middle_units).collect::<Vec<Integer>>());
    Some(count_roots(&middle, region))
}

/// What is certain of all polynomials with enclosed coefficients.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EnclosedLoop {
    /// Where the roots are.
    pub count: RootCount,
    /// Whether an odd number of real roots lies beyond the point where the real axis leaves the region to the right.
    pub drifts: bool,
}

impl EnclosedLoop {
    /// The same of all polynomials with coefficients in the balls; `None` where they are not all alike.
    pub fn of(coefficients: &[Ball], region: Shape) -> Option<EnclosedLoop> {
        let [.., lead] = coefficients else { return None };
        let count = if coefficients.len() == 1 { RootCount::default() } else { certain_count(coefficients, region)? };
        let drifts = at_end(coefficients, region, 1).sign()? != lead.sign()?;
        Some(EnclosedLoop { count, drifts })
    }
}

/// The value at an end of the boundary: 1 or -1 of this sign, or 0.
fn at_end(coefficients: &[Ball], region: Shape, sign: i64) -> Ball {
    if region == Shape::LeftHalfPlane {
        return coefficients[0].clone();
    }
    let signed = |(k, c): (usize, &Ball)| if sign < 0 && k % 2 == 1 { c.neg() } else { c.clone() };
    let zero = Ball::zero(coefficients[0].bits());
    coefficients.iter().enumerate().map(signed).fold(zero, |a, b| a.add(&b))
}

/// What would have to be known to count the roots of a polynomial with coefficients in the balls.
pub fn open_equation(coefficients: &[Ball], region: Shape) -> String {
    let n = coefficients.len() - 1;
    let small = |of: &Ball| {
        let bits = of.bits() as i64 - of.magnitude_units().bit_length() as i64;
        let digits = bits * 301 / 1000;
        if digits > 0 { format!(" (it is below 1e-{digits})") } else { String::new() }
    };
    if coefficients[n].contains_zero() {
        return format!("whether a_{n} is zero{}", small(&coefficients[n]));
    }
    let (variable, ends): (&str, &[i64]) = match region {
        Shape::UnitDisc => ("z", &[1, -1]),
        Shape::LeftHalfPlane => ("s", &[0]),
    };
    for &end in ends {
        let value = at_end(coefficients, region, end);
        if value.contains_zero() {
            return format!("whether D({end}) is zero, a root at {variable} = {end}{}", small(&value));
        }
    }
    match region {
        Shape::UnitDisc => "whether two roots have the product 1, as a pair on the circle".to_owned(),
        Shape::LeftHalfPlane => "whether two roots have the sum 0, as a pair on the axis".to_owned(),
    }
}

/// Whether the resultant of the half-size pair is not zero for all polynomials with coefficients in the balls.
fn resultant_is_certain(coefficients: &[Ball], region: Shape) -> bool {
    let n = coefficients.len() - 1;
    let bits = coefficients[0].bits();
    // The pair depends linearly on the coefficients.
    let units: Vec<HalfSizePair<Integer>> =
        (0..=n).map(|j| HalfSizePair::new(&UniPoly::monomial(Integer::ONE, j), n, region)).collect();
    let (degree_a, degree_b) = (units[0].degree_a, units[0].degree_b);
    let combined = |degree: usize, part: fn(&HalfSizePair<Integer>) -> &UniPoly| -> Vec<Ball> {
        let entry = |i: usize| {
            let terms = units.iter().zip(coefficients).map(|(unit, c)| c.scaled(&part(unit).coeff(i)));
            terms.fold(Ball::zero(bits), |a, b| a.add(&b))
        };
        (0..=degree).map(entry).collect()
    };
    let (a, b) = (combined(degree_a, |p| &p.a), combined(degree_b, |p| &p.b));
    let size = degree_a + degree_b;
    let row = |p: &[Ball], shift: usize| -> Vec<Ball> {
        let place = |j: usize| j.checked_sub(shift).and_then(|k| p.len().checked_sub(k + 1)).map(|k| p[k].clone());
        (0..size).map(|j| place(j).unwrap_or_else(|| Ball::zero(bits))).collect()
    };
    let rows = (0..degree_b).map(|k| row(&a, k)).chain((0..degree_a).map(|k| row(&b, k)));
    is_regular(rows.collect())
}

/// Whether elimination finds a pivot that is not zero in every column.
fn is_regular(mut rows: Vec<Vec<Ball>>) -> bool {
    let n = rows.len();
    for column in 0..n {
        let best = (column..n).max_by_key(|&i| rows[i][column].least_magnitude_units()).expect("rows are left");
        if rows[best][column].contains_zero() {
            return false;
        }
        rows.swap(column, best);
        let pivot = rows[column].clone();
        for row in &mut rows[column + 1..] {
            if row[column].is_zero() {
                continue;
            }
            let Some(factor) = row[column].div(&pivot[column]) else { return false };
            for (x, y) in row[column + 1..].iter_mut().zip(&pivot[column + 1..]) {
                *x = x.sub(&factor.mul(y));
            }
        }
    }
    true
}

/// Roots at the ends of the boundary (1 and -1, or 0), split off.
fn split_ends(
    d: &Poly<MultiPoly>,
    symbols: &Symbols,
    region: Shape,
    budget: &Budget,
) -> Result<Option<(usize, Poly<MultiPoly>)>, Exhausted> {
    let ends: &[i64] = match region {
        Shape::UnitDisc => &[1, -1],
        Shape::LeftHalfPlane => &[0],
    };
    let (mut rest, mut on) = (d.clone(), 0);
    for &end in ends {
        let at = MultiPoly::constant(Integer::from(end));
        while rest.coeffs().len() > 1 && is_zero(&rest.eval(&at), &format!("D({end})"), symbols, budget)? {
            rest = without_root(&rest, &at);
            on += 1;
        }
    }
    Ok((on > 0).then_some((on, rest)))
}

/// The quotient by `z - a`, whose remainder is known to be zero.
fn without_root(p: &Poly<MultiPoly>, a: &MultiPoly) -> Poly<MultiPoly> {
    let mut coefficients = p.coeffs().to_vec();
    for i in (1..coefficients.len()).rev() {
        coefficients[i - 1] = coefficients[i - 1].plus(&coefficients[i].times(a));
    }
    coefficients.remove(0);
    Poly::new(coefficients)
}

/// Splits off pairs of roots that are mirror images in the boundary. Both roots of a pair lie on the boundary, or one on each side of it.
fn split_pairs(
    d: &Poly<MultiPoly>,
    symbols: &Arc<Symbols>,
    region: Shape,
    budget: &Budget,
) -> Result<Option<(RootCount, Poly<MultiPoly>)>, Exhausted> {
    let n = d.coeffs().len() - 1;
    let Some(common) = common_roots(&HalfSizePair::new(d, n, region), symbols, budget)? else { return Ok(None) };
    let degree = common.coeffs().len() - 1;
    // Roots x of the common divisor are pairs of roots z of a polynomial of twice the degree.
    let lifted = match region {
        Shape::UnitDisc => {
            let x = Poly::new(vec![MultiPoly::one(), MultiPoly::zero(), MultiPoly::one()]);
            let mut sum = Poly::zero();
            let mut power = Poly::one();
            for (k, c) in common.coeffs().iter().enumerate() {
                sum = &sum + &power.scaled(c).shifted_up(degree - k);
                power = &power * &x;
            }
            sum
        }
        Shape::LeftHalfPlane => {
            let spread =
                |(k, c): (usize, &MultiPoly)| if k == 0 { vec![c.clone()] } else { vec![MultiPoly::zero(), c.clone()] };
            Poly::new(common.coeffs().iter().enumerate().flat_map(spread).collect())
        }
    };
    let (rest, _) = budget.enter(|| d.pseudo_div_rem(&lifted))?;
    // Variable 0 is the unknown.
    let in_x = common.coeffs().iter().map(|c| c.map_variables(|i| i + 1)).collect();
    let in_x = MultiPoly::from_poly_in(&Poly::new(in_x), 0);
    let Some(split) = SymbolicPoly::new(&in_x, symbols, budget)? else { return Ok(None) };
    let (lower, upper) = match region {
        Shape::UnitDisc => (Some(Rational::from(-2)), Rational::from(2)),
        Shape::LeftHalfPlane => (None, Rational::ZERO),
    };
    let distinct = split.algebraic().degree() + split.rest().degree_in(0) as usize;
    if distinct != degree {
        // Pairs that coincide: their multiplicities are not told.
        return Ok(None);
    }
    let on = split.real_roots_in(lower.as_ref(), Some(&upper), budget)?.len();
    let across = degree - on;
    Ok(Some((RootCount { inside: across, on: 2 * on, outside: across }, rest)))
}

/// The greatest common divisor of the half-size pair as numbers; `None` where it is constant.
pub(super) fn common_roots(
    pair: &HalfSizePair<MultiPoly>,
    symbols: &Symbols,
    budget: &Budget,
) -> Result<Option<Poly<MultiPoly>>, Exhausted> {
    let (a, b) = (trimmed(&pair.a, symbols, budget)?, trimmed(&pair.b, symbols, budget)?);
    let (first, second) = if a.degree() >= b.degree() { (a, b) } else { (b, a) };
    if second.is_zero() {
        return Ok((!first.is_constant()).then_some(first));
    }
    let chain = subresultant_chain(&first, &second, budget)?;
    for subresultant in chain.iter().rev() {
        let common = trimmed(subresultant, symbols, budget)?;
        if !common.is_zero() {
            return Ok((!common.is_constant()).then_some(common));
        }
    }
    Ok(None)
}

/// Without leading coefficients that are zero as numbers.
fn trimmed(p: &Poly<MultiPoly>, symbols: &Symbols, budget: &Budget) -> Result<Poly<MultiPoly>, Exhausted> {
    let mut coefficients = p.coeffs().to_vec();
    while let Some(last) = coefficients.last() {
        if !symbols.is_zero(last, budget)? {
            break;
        }
        coefficients.pop();
    }
    Ok(Poly::new(coefficients))
}
