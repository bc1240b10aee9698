//! Questions in which a dead time varies against the sample time of its hold: from one whole number of samples to the next the
//! loop has another order, so the domain is divided there.

use super::evaluation::Algebra;
use super::presupposed::inside;
use super::{Free, Problem};
use crate::error::Error;
use crate::error::{Code, Diagnostic};
use crate::stability::plane::boxes::Window;
use crate::stability::{Cause, End, Range, StableSet, UndecidedBracket, stable_set_of_parts};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::Rational;
use jurist_algebra::poly::RationalFunction;

/// How many whole numbers of samples are looked at on either side of the usual one.
const MOST_WINDOWS: i64 = 8;

/// The same on either side of the middle of a window, which has two ends.
const MOST_PARTS: i64 = 32;

impl Problem {
    /// True if the order depends on what is free: a dead time varies against the sample time of its hold.
    pub(super) fn is_of_varying_order(&self, budget: &Budget) -> Result<bool, Error> {
        let usual = |free: &Free| free.nominal.clone().unwrap_or_else(|| inside(&free.domain));
        let near: Vec<Rational> = self.free().iter().map(usual).collect();
        match budget.enter(|| Algebra::near(self, &near, budget))? {
            Ok(algebra) => Ok(!algebra.symbols().varying_samples().is_empty()),
            Err(stopped @ Error::Stopped(_)) => Err(stopped),
            Err(_) => Ok(false),
        }
    }

    /// The stable set where a dead time varies against its sample time; `None` where none does, or where the whole numbers of
    /// samples are not at rational values of the parameter.
    ///
    /// At a whole number of samples the loop is the same from either side, but for states that do nothing: intervals go on
    /// there. Numbers of samples far from the usual one stay undecided where the domain does not bound them.
    ///
    /// Cost: that of [`Problem::symbolic`] and `symbolic_stable_set` for each whole number of samples.
    ///
    /// # Errors
    /// As [`Problem::symbolic`] and `symbolic_stable_set`.
    pub fn stable_set_by_samples(&self, budget: &Budget) -> Result<Option<StableSet>, Error> {
        let [asked] = self.free() else { return Ok(None) };
        if self.region().is_free() {
            return Ok(None);
        }
        let domain = &asked.domain;
        let usual = asked.nominal.clone().filter(|x| domain.contains(x)).unwrap_or_else(|| inside(domain));
        let algebra = budget.enter(|| Algebra::near(self, std::slice::from_ref(&usual), budget))??;
        let ratios = algebra.symbols().varying_samples().to_vec();
        if ratios.is_empty() {
            return Ok(None);
        }
        let Some(breaks) = breaks(&ratios, domain, &usual, MOST_WINDOWS) else { return Ok(None) };
        let mut ends: Vec<Option<Rational>> = vec![domain.lower.clone()];
        ends.extend(breaks.into_iter().map(Some));
        ends.push(domain.upper.clone());
        let mut set = StableSet::from_intervals(Vec::new(), Vec::new());
        for window in ends.windows(2) {
            let range = Range::between(window[0].clone(), window[1].clone());
            let near = inside(&range);
            if ratios.iter().any(|ratio| value(ratio, &near).is_some_and(|samples| samples.is_negative())) {
                // No dead time is negative: the model means nothing there.
                continue;
            }
            if !ratios.iter().all(|ratio| is_looked_at(ratio, &near, &usual, MOST_WINDOWS)) {
                let why = "more whole samples than are looked at in one question: give a shorter domain";
                let unknown = vec![UndecidedBracket::new(range.lower, range.upper, why)];
                set = set.followed_by(StableSet::from_intervals(Vec::new(), unknown), None);
                continue;
            }
            let algebra = budget.enter(|| Algebra::near(self, &[near], budget))??;
            let Some(polynomial) = self.symbolic_of(&algebra)? else { continue };
            let parts = self.in_parts(&polynomial, &algebra, budget)?;
            let mut found = stable_set_of_parts(&parts, &range, self.shape(), budget)?;
            let is_stable_at = |x: &Rational| -> Result<bool, Exhausted> {
                Ok(polynomial.at(x, self.shape(), budget)?.is_stable(polynomial.formal_degree()))
            };
            for end in found.ends_mut() {
                let zero = end.value.exact().filter(|x| is_without_dead_time(&ratios, domain, x));
                end.closed = zero.map(|x| is_stable_at(&x)).transpose()?.unwrap_or(false);
            }
            let first = found.intervals().first().and_then(|interval| interval.lower.as_ref());
            let begins_at = |x: &&Rational| domain.contains(x) && first.is_some_and(|end| is_at(end, x));
            let joint = match range.lower.as_ref().filter(begins_at) {
                Some(before) if is_stable_at(before)? && !self.is_undefined_at(before, budget)? => Some(before),
                _ => None,
            };
            set = set.followed_by(found, joint);
        }
        // The divisions are not of the domain's making.
        let is_bound = |end: &End| [&domain.lower, &domain.upper].into_iter().flatten().any(|x| is_at(end, x));
        for end in set.ends_mut().filter(|end| !end.closed && !is_bound(end)) {
            end.causes.remove(Cause::Domain);
            if end.causes.iter().next().is_none() {
                // A sample stands on an edge of a pulse: the loops to both sides are different.
                end.causes.insert(Cause::Pole);
            }
        }
        Ok(Some(set))
    }

    /// A window of two free names in parts of one order each, with the problem of each part, where a dead time varies against its sample time.
    ///
    /// Cost: that of [`Problem::algebra_over_symbols`] for each part.
    ///
    /// # Errors
    /// As [`Problem::algebra_over_symbols`]; [`Error::Refused`] where the whole numbers of samples are not at rational values of one of the names,
    /// where a dead time is negative in the window, and where it has too many whole samples there.
    pub(crate) fn parts_by_samples(&self, window: &Window, budget: &Budget) -> Result<Vec<(Window, Problem)>, Error> {
        let near = |window: &Window| [&window.x, &window.y].map(|[low, high]| low.midpoint(high));
        let usual = near(window);
        let ratios = budget.enter(|| Algebra::near(self, &usual, budget))??.symbols().varying_samples().to_vec();
        let axis = usize::from(ratios.iter().all(|ratio| ratio.variables() == [1]));
        let of_axis = |ratio: &RationalFunction| {
            (ratio.variables() == [axis]).then(|| ratio.map_variables(|_| 0).expect("it has one variable"))
        };
        let side = [&window.x, &window.y][axis];
        let range = Range::between(Some(side[0].clone()), Some(side[1].clone()));
        let found = ratios.iter().map(of_axis).collect::<Option<Vec<_>>>();
        let found = found.and_then(|ratios| Some((breaks(&ratios, &range, &usual[axis], MOST_PARTS)?, ratios)));
        let Some((mut ends, ratios)) = found else {
            let [x, y] = self.axes().map(|axis| axis.name.as_str());
            let message = format!("'{x}' and '{y}' decide together how many samples a dead time is");
            let help = "set one of them, or give the dead time as a multiple of the sample time (delay = \"1.5*T\")";
            return Err(Diagnostic::error(Code::Function, message).help(help).into());
        };
        ends.insert(0, side[0].clone());
        ends.push(side[1].clone());
        let part = |ends: &[Rational]| {
            let middle = ends[0].midpoint(&ends[1]);
            let name = &self.axes()[axis].name;
            if ratios.iter().any(|ratio| value(ratio, &middle).is_some_and(|samples| samples.is_negative())) {
                return Err(not_in_the_window(name, "is negative"));
            }
            if !ratios.iter().all(|ratio| is_looked_at(ratio, &middle, &usual[axis], MOST_PARTS)) {
                return Err(not_in_the_window(
                    name,
                    &format!("is {MOST_PARTS} samples longer or shorter than in its middle"),
                ));
            }
            let mut part = window.clone();
            *[&mut part.x, &mut part.y][axis] = [ends[0].clone(), ends[1].clone()];
            let algebra = budget.enter(|| Algebra::near(self, &near(&part), budget))??;
            Ok((part, self.with_algebra(algebra)))
        };
        ends.windows(2).map(part).collect()
    }

    /// Whether the model is undefined at a value of the one free parameter, as where a sample stands on an edge of a pulse.
    fn is_undefined_at(&self, value: &Rational, budget: &Budget) -> Result<bool, Error> {
        let mut values = self.set().to_vec();
        values.push((self.parameter().name.clone(), value.clone()));
        match budget.enter(|| self.model().closed_loop_in_numbers(&[], &values, budget))? {
            Err(Error::Undefined(_)) => Ok(true),
            found => found.map(|_| false),
        }
    }
}

fn not_in_the_window(name: &str, what: &str) -> Error {
    Diagnostic::error(Code::Usage, format!("in the window of '{name}' a dead time {what}"))
        .help(format!("ask about less of it: '-x {name}=LOW..HIGH'"))
        .into()
}

fn is_at(end: &End, x: &Rational) -> bool {
    end.value.exact().as_ref() == Some(x)
}

/// Whether a dead time is zero at a value inside of the domain.
fn is_without_dead_time(ratios: &[RationalFunction], domain: &Range, x: &Rational) -> bool {
    domain.contains(x) && ratios.iter().any(|ratio| value(ratio, x).is_some_and(|samples| samples.is_zero()))
}

fn value(ratio: &RationalFunction, at: &Rational) -> Option<Rational> {
    ratio.substitute(0, at)?.as_constant()
}

/// Whether a number of samples is not too far from the usual one.
fn is_looked_at(ratio: &RationalFunction, near: &Rational, usual: &Rational, most: i64) -> bool {
    let (Some(here), Some(there)) = (value(ratio, near), value(ratio, usual)) else { return false };
    let (here, there) = (Rational::from(here.floor()), Rational::from(there.floor()));
    !here.is_negative() && (here - there).abs() <= Rational::from(most)
}

/// The values of the parameter in the domain at which a dead time is a whole number of samples, near the usual one, ascending;
/// `None` where these are not known as rational numbers.
fn breaks(ratios: &[RationalFunction], domain: &Range, usual: &Rational, most: i64) -> Option<Vec<Rational>> {
    let mut out = Vec::new();
    for ratio in ratios {
        let middle = value(ratio, usual)?.floor().to_i64()?;
        for whole in (middle - most).max(0)..=middle + most + 1 {
            let difference = ratio - &RationalFunction::from(Rational::from(whole));
            let p = difference.numerator().to_univariate(0)?;
            match p.degree() {
                Some(0) => {}
                Some(1) => {
                    let root = Rational::new(-p.coeff(0), p.coeff(1));
                    if domain.contains(&root) && !out.contains(&root) {
                        out.push(root);
                    }
                }
                _ => return None,
            }
        }
    }
    out.sort();
    Some(out)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::answer::Verdict;
    use crate::error::Source;
    use crate::model::Model;
    use crate::problem::Ask;

    fn servo() -> Model {
        let text = "time = 'discrete'\nsample_time = 'T'\n[parameters]\nT = { nominal = 0.1, min = 0 }\n\
            L = { nominal = 0.12, min = 0 }\nK = { nominal = 2, min = 0 }\n[loop]\ninputs = ['r']\n[[block]]\n\
            name = 'plant'\ninput = 'K*(r - y)'\noutput = 'y'\ntransfer = '1/(s*(s + 1))'\n\
            discretize = { method = 'zoh', delay = 'L' }\n";
        Model::from_toml(&Source::new("model.toml", text)).unwrap().0
    }

    #[test]
    fn a_dead_time_of_any_fraction_of_a_sample_is_a_question() {
        let budget = Budget::unlimited();
        for (name, values) in
            [("L", ["0.01", "0.1", "0.15", "0.33", "0.5", "0.7"]), ("T", ["0.02", "0.06", "0.12", "0.3", "0.7", "2"])]
        {
            let answer = servo().ask().free(name).stable_set(&budget).unwrap();
            let set = answer.value();
            for x in values {
                let x: Rational = jurist_algebra::number::parse_number(x).unwrap();
                let known = set
                    .undecided()
                    .iter()
                    .all(|b| b.lower.as_ref().is_some_and(|lo| x < *lo) || b.upper.as_ref().is_some_and(|hi| *hi < x));
                assert!(known, "{name} = {x}");
                let verdict = servo().ask().set(name, x.clone()).verdict(&budget).unwrap().into_value().verdict;
                assert_eq!(set.contains(&x), verdict == Verdict::Stable, "{name} = {x}");
            }
            assert_eq!(set.intervals().len(), 1, "{name}: {:?}", set.intervals());
        }
    }

    #[test]
    fn a_hold_without_dead_time_belongs_to_the_answer_and_a_negative_one_to_none() {
        let budget = Budget::unlimited();
        for (delay, name) in [("L - 1/10", "below"), ("3/10 - L", "above")] {
            let text = servo()
                .source()
                .text
                .replace("delay = 'L'", &format!("delay = '{delay}'"))
                .replace("0.12, min = 0", "0.15");
            let (model, _) = Model::from_toml(&Source::new("model.toml", text)).unwrap();
            let set = model.ask().set("T", "1/10".parse::<Rational>().unwrap()).free("L").stable_set(&budget).unwrap();
            let set = set.value();
            let (zero, inside): (Rational, Rational) = match name {
                "below" => ("1/10".parse().unwrap(), "1/5".parse().unwrap()),
                _ => ("3/10".parse().unwrap(), "1/5".parse().unwrap()),
            };
            assert!(set.contains(&zero) && set.contains(&inside), "{name}: {:?}", set.intervals());
            let verdict = model
                .ask()
                .set("T", "1/10".parse::<Rational>().unwrap())
                .set("L", zero.clone())
                .verdict(&budget)
                .unwrap();
            assert_eq!(verdict.value().verdict, Verdict::Stable);
            let far = |b: &UndecidedBracket| match name {
                "below" => b.upper.as_ref().is_some_and(|hi| *hi <= zero),
                _ => b.lower.as_ref().is_some_and(|lo| *lo >= zero),
            };
            assert!(!set.undecided().iter().any(far), "{name}: {:?}", set.undecided());
        }
    }
}
