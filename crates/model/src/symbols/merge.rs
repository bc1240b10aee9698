//! Symbols that are powers or multiple angles of one another, expressed by one of them.

use super::{Definition, Meaning, Symbols};
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{MultiPoly, RationalFunction};

/// Exponentials are written as powers of one while the powers stay below this: beyond it the degrees would cost more than
/// the relation gains.
const GREATEST_POWER: i64 = 64;

/// Tangents are written by that of one angle while its multiples stay below this.
const GREATEST_MULTIPLE: i64 = 6;

/// Members of one family: symbol `member` is `ratio` times the first one's argument.
struct Family {
    first: usize,
    members: Vec<(usize, Rational)>,
    /// The greatest common measure of all ratios.
    unit: Rational,
}

impl Family {
    /// The unit with one more ratio, if all multiples of it stay small.
    fn with(&self, ratio: &Rational, greatest: i64) -> Option<Rational> {
        let unit = common_measure(&self.unit, ratio);
        let small = |r: &Rational| r.checked_div(&unit).is_some_and(|k| k.abs() <= Rational::from(greatest));
        (small(ratio) && self.members.iter().all(|(_, r)| small(r))).then_some(unit)
    }
}

/// The greatest rational number of which both are whole multiples.
fn common_measure(a: &Rational, b: &Rational) -> Rational {
    let numerator = (&a.numerator() * &b.denominator()).gcd(&(&b.numerator() * &a.denominator()));
    Rational::new(numerator, &a.denominator() * &b.denominator())
}

/// `b/a`, where that is a rational number.
fn ratio(a: &RationalFunction, b: &RationalFunction) -> Option<Rational> {
    b.checked_div(a)?.as_constant()
}

impl Symbols {
    /// The symbols without relations of this kind, and for each old variable what it is in the new ones.
    pub(crate) fn merged(&self) -> Option<(Symbols, Vec<RationalFunction>)> {
        let first = self.first();
        if self.keeps_flows {
            // Enclosures need no relations.
            return Some((self.clone(), (0..first + self.table.len()).map(RationalFunction::variable).collect()));
        }
        let families = self.families();
        let mut merged = self.cleared();
        let mut images: Vec<RationalFunction> = (0..first).map(RationalFunction::variable).collect();
        // The variable of each family, once its first member is there.
        let mut bases: Vec<Option<RationalFunction>> = vec![None; families.len()];
        for (i, symbol) in self.table.iter().enumerate() {
            let meaning = symbol.meaning.try_map(|f| f.compose(&images))?;
            let member = families.iter().enumerate().find_map(|(k, family)| {
                let (_, ratio) = family.members.iter().find(|(member, _)| *member == i)?;
                Some((k, family, ratio))
            });
            let image = match (member, meaning) {
                (Some((k, family, ratio)), Meaning::Constant(Definition::Exponential(x))) => {
                    let base = match &bases[k] {
                        Some(base) => base.clone(),
                        None => merged.exponential(&x * &family.unit.clone().into()),
                    };
                    let image = base.pow(ratio.checked_div(&family.unit)?.numerator().to_i64()?)?;
                    bases[k] = Some(base);
                    image
                }
                (Some((k, family, ratio)), Meaning::Constant(Definition::Tangent { square, time })) => {
                    let base = match &bases[k] {
                        Some(base) => base.clone(),
                        None => merged.tangent(square.clone(), &time * &family.unit.clone().into()),
                    };
                    let Some(Definition::Tangent { square: square_of_base, .. }) =
                        self.table[family.first].definition()
                    else {
                        return None;
                    };
                    let square_of_base = square_of_base.compose(&images)?;
                    let factor = square.checked_div(&square_of_base)?.as_constant()?.checked_sqrt()?;
                    let multiple = ratio.checked_div(&family.unit)?.numerator().to_i64()?;
                    let (tangent, nonzero) = multiple_angle(&base, &square_of_base, multiple)?;
                    merged.nonzero.extend(nonzero);
                    bases[k] = Some(base);
                    tangent.checked_div(&factor.into())?
                }
                (_, meaning) => merged.intern_again(meaning)?,
            };
            assert_eq!(images.len(), first + i);
            images.push(image);
        }
        merged.nonzero.dedup();
        Some((merged, images))
    }

    /// A symbol whose arguments have changed their variables.
    pub(super) fn intern_again(&mut self, meaning: Meaning) -> Option<RationalFunction> {
        match meaning {
            Meaning::Constant(Definition::Root(x)) => self.root(x),
            Meaning::Constant(Definition::Exponential(x)) => Some(self.exponential(x)),
            Meaning::Constant(Definition::Tangent { square, time }) => Some(self.tangent(square, time)),
            other => Some(self.intern(other)),
        }
    }

    fn families(&self) -> Vec<Family> {
        let mut families: Vec<Family> = Vec::new();
        for (i, symbol) in self.table.iter().enumerate() {
            let Some(definition) = symbol.definition() else { continue };
            let greatest = match definition {
                Definition::Exponential(_) => GREATEST_POWER,
                Definition::Tangent { .. } => GREATEST_MULTIPLE,
                _ => continue,
            };
            let joined = families.iter_mut().any(|family| {
                let first = self.table[family.first].definition();
                let Some(ratio) = first.and_then(|first| related(first, definition)) else { return false };
                let Some(unit) = family.with(&ratio, greatest) else { return false };
                family.unit = unit;
                family.members.push((i, ratio));
                true
            });
            if !joined {
                families.push(Family { first: i, members: vec![(i, Rational::ONE)], unit: Rational::ONE });
            }
        }
        families
    }
}

/// By what factor the argument of the second exceeds that of the first.
fn related(a: &Definition, b: &Definition) -> Option<Rational> {
    match (a, b) {
        (Definition::Exponential(x), Definition::Exponential(y)) => ratio(x, y),
        (Definition::Tangent { square: v, time: s }, Definition::Tangent { square: w, time: t }) => {
            let factor = ratio(v, w)?.checked_sqrt()?;
            Some(&factor * &ratio(s, t)?)
        }
        _ => None,
    }
}

/// `tan(k a)/sqrt(w)` from `tan(a)/sqrt(w)`, by adding angles; and the denominators, which have no zero where the
/// multiples are finite.
fn multiple_angle(t: &RationalFunction, w: &RationalFunction, k: i64) -> Option<(RationalFunction, Vec<MultiPoly>)> {
    let (mut sum, mut nonzero) = (t.clone(), Vec::new());
    for _ in 1..k.unsigned_abs() {
        let below = &RationalFunction::one() - &(w * &(&sum * t));
        sum = (&sum + t).checked_div(&below)?;
        nonzero.push(sum.denominator().primitive_over_integers());
    }
    nonzero.retain(|p| !p.is_constant());
    Some((if k < 0 { -sum } else { sum }, nonzero))
}
