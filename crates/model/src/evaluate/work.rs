//! Work that is counted, never timed: whether a text is a model must not depend on how busy the machine is.

use super::scalar::Scope;
use super::walk::{Failure, evaluate};
use crate::error::{Code, Diagnostic};
use crate::text::{Expression, Node};
use jurist_algebra::limits::{Budget, checkpoint};
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{MultiPoly, RationalFunction};

/// Units of work (see [`checkpoint`]) in which a formula of numbers has to be evaluated: about a third of a second on
/// an idle machine, thousands of times what formulas of numbers need. Beyond it the text is refused.
pub(crate) const NUMBER_WORK: u64 = 30_000_000;

/// Units of work that an operation on the smallest numbers costs.
const OPERATION: u64 = 20;

/// Counts an operation on `a` and `b` by their terms and bits: a product of all terms with all terms, each of which
/// costs the power 3/2 of its machine words, between what products and greatest common divisors cost.
pub(crate) fn count_work(a: &RationalFunction, b: &RationalFunction) {
    let terms = |f: &RationalFunction| (f.numerator().terms().len() + f.denominator().terms().len()) as u64;
    let words = |p: &MultiPoly| p.height_bits() / 64;
    let words = [a, b].into_iter().map(|f| words(f.numerator()) + words(f.denominator())).sum::<u64>();
    let each = 1 + words.saturating_mul(words.isqrt());
    checkpoint(OPERATION.saturating_add(terms(a).saturating_mul(terms(b)).saturating_mul(each)));
}

/// The value of an expression without names; `Err(None)` when it has names.
pub(crate) fn constant_value(e: &Expression) -> Result<Rational, Option<Diagnostic>> {
    if let Node::Number(value) = &e.node {
        return Ok(value.clone());
    }
    if !e.is_constant() {
        return Err(None);
    }
    let too_much =
        || Diagnostic::error(Code::TooLarge, "the number takes too much work to compute").at(e.span, "too large");
    let budget = Budget::with_work(NUMBER_WORK);
    let evaluated = budget.enter(|| {
        let mut scope = Scope::new(std::iter::empty(), std::iter::empty(), |_, _| None, &budget, &mut |_| {});
        evaluate(e, &mut scope)
    });
    // Where a computation cannot be left in its midst, it has gone on beyond the limit.
    if budget.check().is_err() {
        return Err(Some(too_much()));
    }
    match evaluated {
        Ok(Ok(value)) => value.as_constant().ok_or(None),
        Ok(Err(Failure::Wrong(diagnostic))) => Err(Some(*diagnostic)),
        Ok(Err(Failure::Exhausted(_) | Failure::Poisoned)) | Err(_) => Err(Some(too_much())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Model;
    use crate::error::Source;
    use std::path::Path;

    /// A number of this many digits.
    fn digits(count: usize) -> String {
        "7".repeat(count)
    }

    /// The least of 1, 2, .. for which `refused` holds.
    fn threshold(refused: impl Fn(usize) -> bool) -> usize {
        let mut above = 1;
        while !refused(above) {
            above *= 2;
        }
        let mut below = above / 2;
        while above - below > 1 {
            let middle = usize::midpoint(above, below);
            if refused(middle) { above = middle } else { below = middle }
        }
        above
    }

    /// The decision on `below - 1` and `below`, several times while other threads work.
    fn is_the_same_on_a_busy_machine(at: usize, refused: impl Fn(usize) -> bool + Sync) {
        std::thread::scope(|scope| {
            for _ in 0..4 {
                scope.spawn(|| {
                    assert!(!refused(at - 1));
                    assert!(refused(at));
                });
            }
        });
    }

    #[test]
    #[ignore = "long: CI runs it"]
    fn a_number_is_refused_by_the_work_it_takes() {
        let term = digits(20_000);
        let refused = |terms: usize| {
            let text = vec![term.as_str(); terms].join("/3 + ");
            let e = Expression::parse(&text).unwrap();
            match constant_value(&e) {
                Ok(_) => false,
                Err(error) => error.unwrap().code == Code::TooLarge,
            }
        };
        let at = threshold(refused);
        assert!(at > 10, "{at}");
        is_the_same_on_a_busy_machine(at, refused);
    }

    #[test]
    fn the_check_of_values_gives_up_by_the_work_it_takes() {
        let number = digits(20_000);
        let given_up = |constants: usize| {
            let chain: String = (1..=constants).map(|i| format!("c{i} = 'c{}/3 + c0'\n", i - 1)).collect();
            let text = format!(
                "time = 'discrete'\n[parameters]\nK = {{ nominal = 1 }}\n[constants]\nc0 = {number}\n{chain}\
                 [loop]\ncharacteristic = 'z - c{constants}/(K - K)'\n"
            );
            match Model::from_toml(&Source::new("model.toml", text)) {
                Ok(_) => true,
                Err(error) => {
                    assert_eq!(error.code(), Code::DivisionByZero);
                    false
                }
            }
        };
        let at = threshold(given_up);
        assert!(at > 10, "{at}");
        is_the_same_on_a_busy_machine(at, given_up);
    }

    #[test]
    fn no_clock_is_read_in_the_room_of_models() {
        fn each_file(folder: &Path, visit: &mut dyn FnMut(&Path, &str)) {
            for entry in std::fs::read_dir(folder).unwrap() {
                let path = entry.unwrap().path();
                if path.is_dir() {
                    each_file(&path, visit);
                } else {
                    visit(&path, &std::fs::read_to_string(&path).unwrap());
                }
            }
        }
        let mut files = 0;
        each_file(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src"), &mut |path, text| {
            files += 1;
            for clock in [concat!("std::", "time"), concat!("with_", "timeout"), concat!("Instant", "::")] {
                assert!(!text.contains(clock), "{}: {clock}", path.display());
            }
        });
        assert!(files > 20, "{files}");
    }
}
