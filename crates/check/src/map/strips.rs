//! Strips of two parameters, their cells, and what joins cells of neighbouring strips.

use super::isolation::{Place, is_in_stretch, merged, roots};
use super::resultant::is_product;
use crate::boxes::at;
use crate::clock::Clock;
use crate::coefficient::at_point;
use crate::format::Json;
use crate::multivariate::Multi;
use crate::number::{Q, Z};
use crate::over_box::FIRST;
use crate::roots::{is_hurwitz, is_schur};
use crate::statement::{Domain, count, list, number, object};
use crate::univariate::Uni;
use num_traits::One;

/// A curve: its polynomial's coefficients in `y` from the constant term up, polynomials in `x`.
pub(super) type Curve = Vec<Uni>;

/// The polynomial in `y` over `Z[x]`.
pub(super) fn in_y(p: &Multi) -> Curve {
    let number = |p: Multi| p.0.into_values().next().unwrap_or_default();
    let in_x = |p: &Multi| Uni::new(p.coefficients(FIRST).into_iter().map(number).collect());
    p.coefficients(FIRST + 1).iter().map(in_x).collect()
}

/// A positive multiple of the polynomial at a rational `y`.
fn at_y(f: &[Uni], y: &Q, clock: &Clock) -> Result<Uni, String> {
    let (mut sum, mut power) = (Uni::default(), Z::one());
    for c in f.iter().rev() {
        clock.spend(c.0.len(), power.bits(), y.numer().bits())?;
        sum = sum.scaled(y.numer()).plus(&c.scaled(&power));
        power *= y.denom();
    }
    Ok(sum)
}

/// That all polynomials at whose zeros curves may meet, turn, leave or end are products of the given ones.
pub(super) fn covered(curves: &[Curve], x_factors: &[Uni], y_domain: &Domain, clock: &Clock) -> Result<(), String> {
    let divided_by_all = |p: &Uni| -> Result<bool, String> {
        let mut rest = p.primitive(clock)?;
        for f in x_factors {
            while rest.degree() > 0
                && let Some(quotient) = rest.divided(f, clock)?
            {
                rest = quotient;
            }
        }
        Ok(rest.0.len() == 1)
    };
    let primitive: Vec<Uni> = x_factors.iter().map(|f| f.primitive(clock)).collect::<Result<_, _>>()?;
    let is_resultant = |f: &Curve, g: &Curve| is_product(f, g, &primitive, clock);
    let need = |what: String, is_product: bool| -> Result<(), String> {
        if is_product { Ok(()) } else { Err(format!("{what} is not a product of the factors in x")) }
    };
    for (i, f) in curves.iter().enumerate() {
        let Some(lead) = f.last() else { return Err("a factor is zero".into()) };
        need(format!("the leading coefficient of factor {i}"), divided_by_all(lead)?)?;
        if f.len() == 1 {
            continue;
        }
        if f.len() > 2 {
            let derivative: Curve = f.iter().zip(0..).skip(1).map(|(c, k)| c.scaled(&Z::from(k))).collect();
            need(format!("the discriminant of factor {i}"), is_resultant(f, &derivative)?)?;
        }
        for end in [&y_domain.0, &y_domain.1].into_iter().flatten() {
            let value = at_y(f, end, clock)?;
            // A curve that contains the edge is there for every x.
            if !value.is_zero() {
                need(format!("factor {i} on the edge {end}"), divided_by_all(&value)?)?;
            }
        }
        for (j, g) in curves.iter().enumerate().take(i).filter(|(_, g)| g.len() > 1) {
            need(format!("the resultant of the factors {j} and {i}"), is_resultant(f, g)?)?;
        }
    }
    Ok(())
}

/// The factors in `x` and all their roots in the domain.
pub(super) fn walls(json: &Json, domain: &Domain, clock: &Clock) -> Result<(Vec<Uni>, Vec<Place>), String> {
    let (mut factors, mut places) = (Vec::new(), Vec::new());
    for (i, factor) in list(json, "'x_factors'")?.iter().enumerate() {
        let [polynomial, own] = object(factor, "a factor in x", ["polynomial", "roots"], &[])?;
        let f = crate::statement::polynomial(polynomial, "a factor in x")?;
        if f.degree() == 0 {
            return Err("a factor in x is constant".into());
        }
        let found = roots(list(own, "'roots'")?, &f, domain.0.as_ref(), domain.1.as_ref(), clock);
        places.push(found.map_err(|e| format!("factor {i} in x: {e}"))?);
        factors.push(f);
    }
    Ok((factors, merged(&places)?))
}

/// The decomposition of the domain.
pub(super) struct Strips<'c> {
    pub discrete: bool,
    /// The characteristic polynomial.
    pub characteristic: &'c [Multi],
    pub curves: &'c [Curve],
    /// Where one strip ends and the next begins.
    pub walls: &'c [Place],
    pub domain: &'c [Domain; 2],
}

impl Strips<'_> {
    /// The verdicts of the cells of each strip from below.
    pub fn cells(&self, json: &Json, clock: &Clock) -> Result<Vec<Vec<bool>>, String> {
        let strips = list(json, "'strips'")?;
        if strips.len() != self.walls.len() + 1 {
            return Err(format!("there are {} strips between {} walls", strips.len(), self.walls.len()));
        }
        let each = strips.iter().enumerate();
        each.map(|(i, strip)| self.strip(i, strip, clock).map_err(|e| format!("strip {i}: {e}"))).collect()
    }

    fn strip(&self, i: usize, json: &Json, clock: &Clock) -> Result<Vec<bool>, String> {
        let [x, own, cells] = object(json, "a strip", ["x", "roots", "cells"], &[])?;
        let x = number(x, "'x'")?;
        self.is_in_strip(&x, i)?;
        let [_, (lower, upper)] = self.domain;
        let branches = merged(&self.branches(own, &x, (lower.as_ref(), upper.as_ref()), clock)?)?;
        let cells = list(cells, "'cells'")?;
        if cells.len() != branches.len() + 1 {
            return Err(format!("there are {} cells between {} branches", cells.len(), branches.len()));
        }
        let mut verdicts = Vec::with_capacity(cells.len());
        for (k, y) in cells.iter().enumerate() {
            clock.tick()?;
            let y = number(y, "a cell")?;
            if !is_in_stretch(&y, &branches, k, lower.as_ref(), upper.as_ref()) {
                return Err(format!("the point of cell {k} is not in it"));
            }
            let p = at(self.characteristic, &[x.clone(), y], clock)?;
            if p.0.len() != self.characteristic.len() {
                return Err(format!("the point of cell {k} loses degree"));
            }
            verdicts.push(if self.discrete { is_schur(&p, clock)? } else { is_hurwitz(&p, clock)? });
        }
        Ok(verdicts)
    }

    fn is_in_strip(&self, x: &Q, strip: usize) -> Result<(), String> {
        let [(lower, upper), _] = self.domain;
        match is_in_stretch(x, self.walls, strip, lower.as_ref(), upper.as_ref()) {
            true => Ok(()),
            false => Err(format!("x = {x} is not in strip {strip}")),
        }
    }

    /// The roots in `y` of each curve that depends on it, at one `x`.
    fn branches(
        &self,
        json: &Json,
        x: &Q,
        (lower, upper): (Option<&Q>, Option<&Q>),
        clock: &Clock,
    ) -> Result<Vec<Vec<Place>>, String> {
        let in_y: Vec<&Curve> = self.curves.iter().filter(|f| f.len() > 1).collect();
        let lists = list(json, "the roots")?;
        if lists.len() != in_y.len() {
            return Err("there is not one list of roots for each factor with y".into());
        }
        let each = lists.iter().zip(in_y);
        each.map(|(own, f)| roots(list(own, "the roots")?, &at_point(f, x, clock)?, lower, upper, clock)).collect()
    }

    /// The two cells on either side of a wall that a horizontal segment joins without meeting a curve.
    pub fn join(&self, json: &Json, clock: &Clock) -> Result<[(usize, usize); 2], String> {
        let [strip, x, y, below, clear] = object(json, "a join", ["strip", "x", "y", "below", "clear"], &[])?;
        let strip = count(strip, "'strip'")?;
        let y = number(y, "'y'")?;
        let [_, (lower, upper)] = self.domain;
        if lower.as_ref().is_some_and(|l| *l >= y) || upper.as_ref().is_some_and(|u| *u <= y) {
            return Err("'y' is outside of the domain".into());
        }
        let ([left, right], [left_below, right_below]) = (list(x, "'x'")?, list(below, "'below'")?) else {
            return Err("a join has two sides".into());
        };
        let (left, right) = (number(left, "'x'")?, number(right, "'x'")?);
        let mut cells = [(strip, 0), (strip + 1, 0)];
        for ((cell, x), below) in cells.iter_mut().zip([&left, &right]).zip([left_below, right_below]) {
            self.is_in_strip(x, cell.0)?;
            cell.1 = self.branches(below, x, (lower.as_ref(), Some(&y)), clock)?.iter().map(Vec::len).sum();
        }
        let clear = list(clear, "'clear'")?;
        if clear.len() != self.curves.len() {
            return Err("there is not one list of splits for each factor".into());
        }
        for (i, (splits, f)) in clear.iter().zip(self.curves).enumerate() {
            let along = at_y(f, &y, clock)?;
            let met = roots(list(splits, "'clear'")?, &along, Some(&left), Some(&right), clock)?;
            if !met.is_empty() || along.vanishes_at(&left, clock)? || along.vanishes_at(&right, clock)? {
                return Err(format!("the segment meets factor {i}"));
            }
        }
        Ok(cells)
    }
}
