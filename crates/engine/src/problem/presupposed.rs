//! What a model presupposes as functions of what is free that have to be positive, and the domains in which they are.

use super::over_symbols::symbols_without;
use super::resolved::Free;
use crate::error::{Code, Diagnostic};
use crate::model::{Definition, Model, Presupposed, Presupposition, Symbols};
use crate::stability::Range;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Rational, Sign, parse_number, to_scientific};
use jurist_algebra::poly::{MultiPoly, RationalFunction, SquareFree, UniPoly, isolate_real_roots_in};
use jurist_algebra::symbols::Symbols as Table;

/// Significant digits of a bound that is not rational; it is rounded towards the inside of the domain.
const DIGITS: usize = 12;

/// No more work is done for all that is presupposed: to ask a question takes no time.
const MOST_WORK: u64 = 200_000_000;

/// Bits of its enclosure.
const BITS: u64 = 256;

/// Functions of what is free that are positive where the model's holds and rules have a meaning, and those among them that are duty
/// ratios, or what these leave to 1; `first` is the number of the first kept name among what is free.
///
/// Cost: that of evaluating the expressions of sample times and frequencies.
///
/// # Errors
/// Where something that is presupposed does not hold, whatever is free, or is not known to.
pub(super) fn positive_functions(
    model: &Model,
    kept: &[String],
    set: &[(String, Rational)],
    first: usize,
) -> Result<(Vec<RationalFunction>, Vec<RationalFunction>), Diagnostic> {
    let budget = Budget::with_work(MOST_WORK);
    let found = || {
        let presuppositions = model.presuppositions(kept, set, &budget).map_err(|_| too_long())?;
        let (mut found, mut duties) = (Vec::new(), Vec::new());
        let Some((presuppositions, symbols)) = presuppositions else { return Ok((found, duties)) };
        for presupposition in &presuppositions {
            if presupposition.of == Presupposed::Duty && kept.is_empty() && presupposition.function.is_constant() {
                // The loop is undefined there, which is a verdict.
                continue;
            }
            for f in positive(presupposition, symbols.clone(), &budget)? {
                let f = f.map_variables(|i| i + first).expect("no two variables become one");
                if presupposition.of == Presupposed::Duty {
                    duties.push(f.clone());
                }
                if !found.contains(&f) {
                    found.push(f);
                }
            }
        }
        Ok((found, duties))
    };
    budget.enter(found).map_err(|_| too_long())?
}

fn too_long() -> Diagnostic {
    Diagnostic::error(
        Code::TooLarge,
        "the sample time of a hold, or the frequency of 'prewarp', is too long an expression",
    )
    .help("set the parameters that it depends on, or write it shorter")
}

/// Functions of the kept names that are positive where what is presupposed holds; none where it holds for all values.
fn positive(of: &Presupposition, mut symbols: Symbols, budget: &Budget) -> Result<Vec<RationalFunction>, Diagnostic> {
    let pi = symbols.pi();
    let moving: Vec<usize> = symbols.moving().collect();
    let Some(table) = symbols_without(&symbols, &moving) else { return Err(of.not_known()) };
    let table = Constants { table, first: symbols.first(), budget };
    let f = &of.function;
    // What is positive, and what is below a power of pi.
    let (mut wanted, below) = match f.variables().into_iter().find(|i| moving.contains(i)) {
        None => (vec![f.clone()], (f.clone(), 1)),
        // A multiple of the root of something is judged by its square.
        Some(i) => {
            let under = symbols.iter().nth(i - symbols.first()).and_then(|s| match s.definition() {
                Some(Definition::Root(x)) => Some(x.clone()),
                _ => None,
            });
            let factor = f.checked_div(&RationalFunction::variable(i));
            let factor = factor.filter(|factor| factor.variables().iter().all(|j| !moving.contains(j)));
            let (Some(under), Some(factor)) = (under, factor) else { return Err(of.not_known()) };
            let square = &(&factor * &factor) * &under;
            (vec![factor, under], (square, 2))
        }
    };
    // What else moves is not known.
    if wanted.iter().chain([&below.0]).flat_map(RationalFunction::variables).any(|i| moving.contains(&i)) {
        return Err(of.not_known());
    }
    let mut out = Vec::new();
    for g in wanted.drain(..) {
        let Some((s, r)) = table.split(&g) else { return Err(of.not_known()) };
        match table.sign(&s) {
            None => return Err(of.not_known()),
            Some(Sign::Equal) => return Err(of.not_positive()),
            Some(sign) if r.is_constant() && sign.is_lt() => return Err(of.not_positive()),
            Some(sign) => out.push(if sign.is_lt() { -r } else { r }),
        }
    }
    if of.of == Presupposed::Angle {
        let (g, power) = below;
        let Some((s, r)) = table.split(&g) else { return Err(of.not_known()) };
        let limit = pi.pow(power).expect("a positive power");
        if r.is_constant() {
            match table.sign(&(&limit - &s)) {
                Some(sign) if sign.is_gt() => {}
                Some(_) => return Err(of.too_fast()),
                None => return Err(of.not_known()),
            }
        } else {
            let Some(bound) = limit.checked_div(&s).and_then(|q| table.below_modulus(&q)) else {
                return Err(of.not_known());
            };
            let r = if table.sign(&s).is_some_and(Sign::is_lt) { -r } else { r };
            out.push(&RationalFunction::from(bound) - &r);
        }
    }
    out.retain(|f| !f.is_constant());
    Ok(out)
}

/// Constants over symbols, whose variables come after the kept names.
struct Constants<'b> {
    table: Table,
    first: usize,
    budget: &'b Budget,
}

impl Constants<'_> {
    fn own(&self, p: &MultiPoly) -> MultiPoly {
        p.map_variables(|i| i.saturating_sub(self.first))
    }

    /// A constant, one other than zero if there is one, and a rational function of the kept names, whose product is `f`.
    fn split(&self, f: &RationalFunction) -> Option<(RationalFunction, RationalFunction)> {
        let kept: Vec<usize> = f.variables().into_iter().filter(|i| *i < self.first).collect();
        if kept.is_empty() || f.is_zero() {
            return Some((f.clone(), RationalFunction::one()));
        }
        // At one of a few points it is neither zero nor undefined.
        let point =
            |k: i64| kept.iter().try_fold(f.clone(), |f, &i| f.substitute(i, &Rational::from(k + i as i64 * (k + 1))));
        let s = (1..=20).filter_map(point).find(|s| !s.is_zero())?;
        let r = f.checked_div(&s)?;
        r.variables().iter().all(|i| *i < self.first).then_some((s, r))
    }

    /// The sign of a constant; `None` where it is not found.
    fn sign(&self, s: &RationalFunction) -> Option<Sign> {
        let [above, below] = [s.numerator(), s.denominator()].map(|p| self.table.sign(&self.own(p), self.budget).ok());
        match (above?, below?) {
            (_, Sign::Equal) => None,
            (sign, below) if below.is_lt() => Some(sign.reverse()),
            (sign, _) => Some(sign),
        }
    }

    /// A number not above the modulus of a constant, the modulus itself if that is rational.
    fn below_modulus(&self, q: &RationalFunction) -> Option<Rational> {
        if let Some(q) = q.as_constant() {
            return Some(q.abs());
        }
        let [above, below] = [q.numerator(), q.denominator()].map(|p| self.table.enclose(&self.own(p), BITS));
        let ball = above.div(&below)?;
        let least = if ball.upper().is_negative() { -ball.upper() } else { ball.lower() };
        (!least.is_negative() && !least.is_zero()).then(|| rounded_down(&least))
    }
}

/// A number of so many digits below a positive one: what is taken off is more than what rounding adds.
fn rounded_down(x: &Rational) -> Rational {
    let share = Rational::from(10).pow(1 - DIGITS as i64).expect("ten is not zero");
    let rounded = to_scientific(&(x - &(x * &share)), DIGITS);
    parse_number(&rounded).expect("a number that was written")
}

/// The part of a parameter's domain in which the functions of it alone are positive: that around its nominal value, if they are
/// positive there, else the first; and whether there are others. `None` where they are positive nowhere.
///
/// Cost: the real roots of their numerators and denominators.
///
/// # Errors
/// Where these take too much work.
pub(super) fn trimmed(
    free: &Free,
    own: usize,
    functions: &[RationalFunction],
) -> Result<Option<(Range, bool)>, Diagnostic> {
    let (range, budget) = (&free.domain, Budget::with_work(MOST_WORK));
    let polynomials: Vec<UniPoly> = functions
        .iter()
        .filter(|f| f.variables() == [own])
        .flat_map(|f| [f.numerator(), f.denominator()])
        .map(|p| p.to_univariate(own).expect("one variable occurs"))
        .collect();
    if polynomials.is_empty() {
        return Ok(Some((range.clone(), false)));
    }
    let mut ends: Vec<[Rational; 2]> = Vec::new();
    for p in &polynomials {
        let Some(part) = SquareFree::part_of(p) else { return Ok(None) };
        for root in
            isolate_real_roots_in(&part, range.lower.as_ref(), range.upper.as_ref(), &budget).map_err(|_| too_long())?
        {
            ends.push(match root.exact() {
                Some(x) => [x.clone(), x],
                None => root.refined_to_digits(DIGITS).enclosure().into(),
            });
        }
    }
    ends.sort();
    // Enclosures of roots that are close together may be within one another.
    for k in 1..ends.len() {
        ends[k][1] = ends[k][1].clone().max(ends[k - 1][1].clone());
    }
    // From the upper end of one root's enclosure to the lower end of the next one's.
    let lower = std::iter::once(range.lower.clone()).chain(ends.iter().map(|e| Some(e[1].clone())));
    let upper = ends.iter().map(|e| Some(e[0].clone())).chain(std::iter::once(range.upper.clone()));
    let pieces = lower.zip(upper).map(|(lower, upper)| Range::between(lower, upper)).filter(|piece| !piece.is_empty());
    let is_positive = |piece: &Range| {
        let x = inside(piece);
        // A quotient is positive where numerator and denominator have the same sign.
        polynomials.chunks(2).all(|pair| {
            let [above, below] = [0, 1].map(|k| pair[k].sign_at(&x));
            above.is_ne() && above == below
        })
    };
    let positive: Vec<Range> = pieces.filter(is_positive).collect();
    let around = positive.iter().find(|piece| free.nominal.as_ref().is_some_and(|x| piece.contains(x)));
    Ok(around.or(positive.first()).map(|piece| (piece.clone(), positive.len() > 1)))
}

/// A number inside of a range.
pub(super) fn inside(range: &Range) -> Rational {
    match (&range.lower, &range.upper) {
        (Some(lo), Some(hi)) => lo.midpoint(hi),
        (Some(lo), None) => lo + &(lo.abs() + Rational::ONE),
        (None, Some(hi)) => hi - &(hi.abs() + Rational::ONE),
        (None, None) => Rational::ZERO,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::answer::{BoxRequest, MapMethod, MapOrBoxes, Verdict};
    use crate::error::{Error, Source};
    use crate::problem::Ask;
    fn number(text: &str) -> Rational {
        parse_number(text).unwrap()
    }

    /// A gain before a block that is made discrete like this.
    fn model(parameters: &str, transfer: &str, discretize: &str) -> Model {
        let text = format!(
            "time = 'discrete'\n[parameters]\nK = {{ nominal = 1 }}\n{parameters}\n[loop]\ninputs = ['r']\noutputs = ['y']\n\
             [[block]]\nname = 'C'\ninput = 'K*(r - y)'\noutput = 'u'\ntransfer = '1/z'\n\
             [[block]]\nname = 'P'\ninput = 'u'\noutput = 'y'\ntransfer = '{transfer}'\ndiscretize = {discretize}\n"
        );
        Model::from_toml(&Source::new("model.toml", &text)).unwrap().0
    }

    fn code(error: Error) -> Code {
        let Error::Refused(diagnostics) = error else { panic!("{error}") };
        diagnostics.code()
    }

    #[test]
    fn domains_end_where_the_model_has_no_meaning() {
        let tustin = "{ method = 'tustin', T = 'T', prewarp = 'w' }";
        let [t, w] = ["T = { nominal = 0.001 }", "w = { nominal = 700 }"];
        let both = format!("{t}\n{w}");
        let cases = [
            // (parameters, discretize, free, lower end, upper end)
            (t, "{ method = 'zoh', T = 'T' }", "T", "0", None),
            ("f = { nominal = 1000 }", "{ method = 'zoh', T = '1/f' }", "f", "0", None),
            ("f = { nominal = 1000 }", "{ method = 'zoh', T = '1/(f - 5)' }", "f", "5", None),
            ("T = { nominal = -0.001 }", "{ method = 'foh', T = '-T' }", "T", "", Some("0")),
            (&*both, tustin, "T", "0", Some("0.00448798950508")),
            (&*both, tustin, "w", "0", Some("3141.59265356")),
            (t, "{ method = 'tustin', T = 'T', prewarp = '2*pi*120' }", "T", "0", Some("1/240")),
            ("f = { nominal = 120 }", "{ method = 'tustin', T = '1/400', prewarp = '2*pi*f' }", "f", "0", Some("200")),
            // sqrt(k/3)/10 < pi
            (
                "k = { nominal = 1 }",
                "{ method = 'tustin', T = '1/10', prewarp = 'sqrt(k/3)' }",
                "k",
                "0",
                Some("2960.88132030"),
            ),
            // (f - 1) (3 - f) is positive from 1 to 3
            ("f = { nominal = 2 }", "{ method = 'zoh', T = '(f - 1)*(3 - f)' }", "f", "1", Some("3")),
        ];
        for (parameters, discretize, free, lower, upper) in cases {
            let model = model(parameters, "1/(s + 1)", discretize);
            let problem = model.ask().free(free).problem().unwrap();
            let domain = &problem.parameter().domain;
            let ends = [(!lower.is_empty()).then_some(lower), upper].map(|end| end.map(number));
            assert_eq!([&domain.lower, &domain.upper].map(Clone::clone), ends, "{discretize}");
            // The same of single values.
            for (end, outwards) in [(&domain.lower, "-1/50"), (&domain.upper, "1/50")] {
                let Some(end) = end else { continue };
                let step = &number(outwards) * &(end.abs().max(number("1/100")));
                let is_refused = |x: Rational| match model.ask().set(free, x).verdict(&Budget::unlimited()) {
                    // The root of a negative number.
                    Ok(answer) => answer.value().verdict == Verdict::Undefined,
                    Err(error) => [Code::Discretize, Code::Value].contains(&code(error)),
                };
                assert!(is_refused(end + &step) && !is_refused(end - &step), "{discretize} at {end}");
            }
        }
    }

    #[test]
    fn roots_of_what_moves_by_itself_are_not_known() {
        // With the root of a root, and that of an exponential, in the place of a number the bound would be any.
        for frequency in ["sqrt(sqrt(x))", "sqrt(exp(x))", "sqrt(x*sqrt(x))", "sqrt(1 - sqrt(x))"] {
            let rule = format!("{{ method = 'tustin', T = '1', prewarp = '{frequency}' }}");
            let found = model("x = { nominal = 0.5 }", "1/(s - 1)", &rule).ask().free("x").problem();
            assert_eq!(found.map_err(code).err(), Some(Code::Discretize), "{frequency}");
        }
    }

    #[test]
    #[ignore = "long: CI runs it"]
    fn what_several_blocks_presuppose_holds_together() {
        // x^2 > 1 and x > 0; the nominal value is in neither part of the first.
        let text = "time = 'discrete'\n[parameters]\nx = { nominal = 0.5 }\n[loop]\ninputs = ['r']\n\
            [[block]]\nname = 'A'\ninput = 'r - y'\noutput = 'u'\ntransfer = '1/(s + 1)'\n\
            discretize = { method = 'zoh', T = 'x^2 - 1' }\n\
            [[block]]\nname = 'B'\ninput = 'u'\noutput = 'y'\ntransfer = '1/(s + 2)'\n\
            discretize = { method = 'zoh', T = 'x' }\n";
        let model = Model::from_toml(&Source::new("model.toml", text)).unwrap().0;
        let problem = model.ask().free("x").problem().unwrap();
        assert_eq!(problem.parameter().domain, Range::between(Some(1.into()), None));
        // Irrational ends that are 1e-30 apart.
        let close = text.replace("x^2 - 1", "x^2 - 2").replace("T = 'x' }", "T = 'x^2 - 2 - 1e-30' }");
        let model = Model::from_toml(&Source::new("model.toml", &close)).unwrap().0;
        let problem = model.ask().free("x").domain("x", Range::between(Some(1.into()), None)).problem().unwrap();
        let end = problem.parameter().domain.lower.clone().unwrap();
        let beyond = &(&end * &end) - &number("2.000000000000000000000000000001");
        assert!(!beyond.is_negative() && beyond < number("1e-10"), "{end}");
        // Of several parts one is left, and that is said.
        let both = text.replace("T = 'x' }", "T = 'x^2 - 4' }");
        let model = Model::from_toml(&Source::new("model.toml", &both)).unwrap().0;
        let problem = model.ask().free("x").problem().unwrap();
        assert_eq!(problem.parameter().domain, Range::between(None, Some((-2).into())));
        assert!(problem.warnings().iter().any(|w| w.code == Code::DomainWarning));
        // Long expressions are refused and take no time.
        let long = text.replace("x^2 - 1", "(x^20 + 3*x^19 - x + 1)^120 + 1");
        let model = Model::from_toml(&Source::new("model.toml", &long)).unwrap().0;
        assert_eq!(model.ask().free("x").problem().map_err(code).err(), Some(Code::TooLarge));
    }

    #[test]
    fn a_frequency_above_half_the_sampling_rate_is_refused_also_where_it_is_no_rational_number() {
        for (frequency, is_refused) in [
            ("2*pi*499", false),
            ("2*pi*500", true),
            ("2*pi*501", true),
            ("sqrt(9869604)", false),
            ("sqrt(9869605)", true),
        ] {
            let rule = format!("{{ method = 'tustin', T = '0.001', prewarp = '{frequency}' }}");
            let found = model("", "1/(s + 1)", &rule).ask().free("K").stable_set(&Budget::unlimited());
            assert_eq!(found.map_err(code).err(), is_refused.then_some(Code::Discretize), "{frequency}");
        }
    }

    #[test]
    fn a_loop_with_a_hold_is_not_stable_at_negative_sample_times() {
        let integrator = model("T = { nominal = 0.1 }", "1/s", "{ method = 'zoh', T = 'T' }");
        let budget = Budget::unlimited();
        let set = |gain: i64| integrator.ask().free("T").set("K", gain).stable_set(&budget).unwrap().into_value();
        // z^2 - z + K T is stable for K T between 0 and 1.
        let [positive, negative] = [set(1), set(-1)];
        assert!(positive.contains(&number("0.9")) && !positive.contains(&number("-0.9")));
        assert!(negative.intervals().is_empty());
    }

    #[test]
    #[ignore = "long: CI runs it"]
    fn where_two_names_decide_together_boxes_are_stable_only_within() {
        // A filter that is not stable: with an angle beyond pi its bilinear map would turn it around.
        let filter = model(
            "w = { nominal = 1 }\nT = { nominal = 1 }",
            "1/(s - 1)",
            "{ method = 'tustin', T = 'T', prewarp = 'w' }",
        );
        let filter = std::sync::Arc::new(filter);
        let problem = Model::ask(&filter).free("w").free("T").set("K", number("1/20")).plane_problem().unwrap();
        let side = || Range::between(Some(number("1/2")), Some(number("4")));
        let request = BoxRequest::new([side(), side()], number("1/20"));
        let found = problem.map_by(MapMethod::Auto, &request, 12, &Budget::unlimited()).unwrap();
        let MapOrBoxes::Boxes(map) = found else { panic!("both are inside of functions") };
        assert!(map.value().boxes.areas.stable.is_zero());
        assert!(map.value().boxes.areas.unstable > number("11"), "{:?}", map.value().boxes.areas);
        let at = |w: &str, t: &str| {
            let ask = Model::ask(&filter).set("w", number(w)).set("T", number(t)).set("K", number("1/20"));
            ask.verdict(&Budget::unlimited()).map(|answer| answer.into_value().verdict)
        };
        assert_eq!(at("1", "1").unwrap(), Verdict::Unstable);
        assert_eq!(at("3", "3/2").map_err(code).unwrap_err(), Code::Discretize);
        // Both negative: the angle is positive, and the factor of the rule is not.
        assert_eq!(at("-1", "-1").map_err(code).unwrap_err(), Code::Discretize);
    }
}
