//! Tables of the report: errata and sensitivity.

use super::coefficient;
use super::errata::{Comparison, Match, compare_all};
use super::limits::{ends, reciprocal};
use super::printed::{EQUATION_23, EQUATION_37, LIST_AFTER_36, Printed};
use jurist_algebra::limits::Budget;
use jurist_algebra::matrix::CharacteristicPolynomial;
use jurist_algebra::number::{Rational, to_decimal};
use jurist_algebra::real::Real;
use jurist_draw::page::Table;
use jurist_draw::report::{limit_text, percent_change};
use jurist_engine::error::{Error, Source};
use jurist_engine::model::Model;
use jurist_engine::problem::{Ask, Question};

/// Constants whose influence the report shows.
const CONSTANTS: [&str; 8] = ["J", "B_v", "R_a", "L_a", "K_pi", "K_ii", "K_ps", "K_is"];

/// Eqs. 5 and 13 as the text has them: place, printed entry, the entry as it has to be.
const ENTRIES: [(&str, &str, &str); 2] =
    [("Eq. 5, entry (1,1)", "(L_a - R_a)/L_a", "(L_a - R_a*T)/L_a"), ("Eq. 13, entry (2,1)", "-K_a*T/J", "K_a*T/J")];

/// The polynomial with one parameter free.
pub(super) fn polynomial(model: &Model, name: &str, budget: &Budget) -> Result<CharacteristicPolynomial, Error> {
    let problem = model.ask().free(name).problem()?;
    let algebra = problem.algebra(budget)?;
    algebra.polynomial().cloned().ok_or_else(|| Error::Undefined(algebra.undefined().unwrap_or_default().to_owned()))
}

/// How many of the printed numbers are right to the last digit.
fn right(printed: &[Printed], p: &CharacteristicPolynomial) -> usize {
    let all = compare_all(printed, |z, k| coefficient(p, z, k));
    all.iter().filter(|c| c.outcome == Match::Rounded).count()
}

/// Everything printed that is not what it should be, found by comparison: place, printed, exact, what is wrong.
///
/// # Errors
/// [`Error`] when the budget runs out.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_engine::model::Model;
/// let table = jurist_drive::errata(&Model::drive(), &Budget::unlimited())?;
/// let entry = table.rows.iter().find(|row| row[0] == "Eq. 5, entry (1,1)").unwrap();
/// assert_eq!(entry[1..3], ["(L_a - R_a)/L_a", "(L_a - R_a*T)/L_a"]);
/// # Ok::<(), jurist_engine::error::Error>(())
/// ```
pub fn errata(model: &Model, budget: &Budget) -> Result<Table, Error> {
    let (eq_23, eq_37) = (polynomial(model, "K_pwm", budget)?, polynomial(model, "T", budget)?);
    let mut table =
        Table::new("Errata, found by comparison with the exact values", &["where", "printed", "exact", "what"]);
    let total = EQUATION_23.len();
    for (place, printed, entry) in ENTRIES {
        let text = model.source().text.replacen(&format!("\"{entry}\""), &format!("\"{printed}\""), 1);
        let (damaged, _) = Model::from_toml(&Source::new("<as printed>", text))?;
        let count = right(EQUATION_23, &polynomial(&damaged, "K_pwm", budget)?);
        let what = format!(
            "in the text as we have it: it gives {count} of the {total} numbers of Eq. 23, the exact entry {}",
            right(EQUATION_23, &eq_23)
        );
        table.rows.push(vec![place.into(), printed.into(), entry.into(), what]);
    }
    for (list, p, name) in
        [(EQUATION_23, &eq_23, "K_pwm"), (LIST_AFTER_36, &eq_23, "K_pwm"), (EQUATION_37, &eq_37, "T")]
    {
        let all = compare_all(list, |z, k| coefficient(p, z, k));
        table.rows.extend(all.iter().filter(|c| c.outcome != Match::Rounded).map(|c| erratum(c, name)));
    }
    Ok(table)
}

fn erratum(c: &Comparison, parameter: &str) -> Vec<String> {
    let Printed { place, power_of_z, power_of_parameter, digits } = c.printed;
    let monomial = match power_of_parameter {
        0 => String::new(),
        1 => format!(", {parameter}"),
        n => format!(", {parameter}^{n}"),
    };
    let significant = digits.split('e').next().map_or(0, |d| d.chars().filter(char::is_ascii_digit).count());
    let exact = to_decimal(&c.exact, significant + 4);
    vec![format!("{place}, a_{power_of_z}{monomial}"), digits.into(), exact, c.outcome.words().into()]
}

/// How the limits move when a constant changes by a tenth, each limit exact.
pub(super) fn sensitivity(model: &Model, budget: &Budget) -> Result<Table, Error> {
    let head = ["constant", "value", "K_pwm, lower", "change / %", "upper", "change / %", "f, lower", "change / %"];
    let mut table = Table::new("The limits when one constant is 10 % smaller or larger: K_pwm in V, f in Hz", &head);
    let limits = |question: Question| -> Result<[Option<Real>; 3], Error> {
        let k = question.clone().free("K_pwm").stable_set(budget)?;
        let t = question.free("T").stable_set(budget)?;
        let ((lower, upper), (_, longest)) = (ends(&k), ends(&t));
        Ok([lower.cloned(), upper.cloned(), longest.cloned()])
    };
    let base = limits(model.ask())?;
    let cells = |now: &[Option<Real>; 3], first: [String; 2]| {
        let mut row = first.to_vec();
        for (k, (x, x0)) in now.iter().zip(&base).enumerate() {
            let frequency = k == 2;
            row.push(if frequency { reciprocal(x.as_ref(), 7) } else { limit_text(x.as_ref(), 7) });
            let change = x.as_ref().zip(x0.as_ref()).and_then(|(x, x0)| {
                // A frequency is the reciprocal of its period.
                if frequency { percent_change(x0, x) } else { percent_change(x, x0) }
            });
            row.push(change.unwrap_or_default());
        }
        row
    };
    table.rows.push(cells(&base, ["all".into(), "nominal".into()]));
    for name in CONSTANTS {
        budget.step("limits with other constants");
        let Some(nominal) = model.constant(name).and_then(|c| c.number.clone()) else { continue };
        for (percent, sign) in [(90, "−10 %"), (110, "+10 %")] {
            let value = &nominal * &Rational::new(percent.into(), 100.into());
            let text = format!("{}, {sign}", to_decimal(&value, 8));
            table.rows.push(cells(&limits(model.ask().set(name, value.clone()))?, [name.into(), text]));
        }
    }
    Ok(table)
}
