//! The table as a page of the documentation.

use super::refusals::COMPLEX;
use super::{CoefficientRing, Coverage, Method, Refusal, rows};
use crate::model::Time;

const BEGINNING: &str = "\
# What is answered

This page is made of the table that the program itself reads (`crates/engine/src/coverage/table.rs`); a test asks the program every question of
a loop over each ring. `--explain` prints the row and the ring of a question.

A loop may still be refused for a reason of its own, such as dead times without a common divisor, and an answer may stay undecided
within its budget.
";

const COMPLEX_LOOPS: &str = "
## Complex coefficients

A loop with the imaginary unit in it, or with a plant that is held in another frame, has a characteristic polynomial `D` with complex coefficients. Its
real and imaginary parts are over one of the rings above, and so is `D conj(D)`, whose roots are those of `D` and their conjugates. That is asked
in the same way, roots are counted once, and `D` tells on which side of the real axis the one is that limits the loop. With dead time the values of a gain follow from
the crossings of `D` itself, at frequencies of both signs. Requirements on margins over values of a parameter are decided with dead time where one factor of the open loop has it, and numerator
and denominator beside it have the parameter to the first power at most; in tolerances they are known of one name. These questions are answered:

";

/// The page `docs/explanation/coverage.md`.
///
/// ```
/// assert!(jurist_engine::coverage::page().starts_with("# What is answered\n"));
/// ```
pub fn page() -> String {
    let mut out = BEGINNING.to_owned();
    out += "\n## Coefficient rings\n\n| ring | coefficients of the characteristic function |\n|---|---|\n";
    for ring in CoefficientRing::ALL {
        out += &format!("| {} | {} |\n", ring.name(), ring.words());
    }
    let (mut methods, mut refusals) = (Vec::new(), Vec::new());
    out += "\n## Questions\n\nA number is that of a method below, a letter that of a refusal.\n\n| question |";
    out += &CoefficientRing::ALL.map(|ring| format!(" {} |", ring.name())).concat();
    out += &format!("\n|---|{}\n", "---|".repeat(CoefficientRing::ALL.len()));
    for row in rows() {
        let time = match row.time {
            None => "",
            Some(Time::Discrete) => ", discrete time",
            Some(Time::Continuous) => ", continuous time",
        };
        out += &format!("| `{}`{time} |", row.command);
        for coverage in &row.coverage {
            out += &format!(" {} |", cell(coverage, &mut methods, &mut refusals));
        }
        out.push('\n');
    }
    out += COMPLEX_LOOPS;
    let known = rows().iter().filter(|row| row.asked.of_complex_loop().is_none());
    out += &known.map(|row| format!("- `{}`\n", row.command)).collect::<String>();
    out += &format!("\nAll others are refused (`{}`): {}.\n", COMPLEX.code, COMPLEX.message);
    out += "\n## Methods\n\n";
    for (k, method) in methods.iter().enumerate() {
        out += &format!("{}. **{}** (`{}`). {}\n", k + 1, method.name, method.place, method.how);
    }
    out += "\n## Refusals\n\nWords in braces stand for what belongs to the question.\n\n| | code | words | what to do |\n|---|---|---|---|\n";
    for (k, refusal) in refusals.iter().enumerate() {
        out += &format!("| {} | `{}` | {} | {} |\n", letter(k), refusal.code, refusal.message, refusal.help);
    }
    out
}

fn cell(coverage: &Coverage, methods: &mut Vec<&'static Method>, refusals: &mut Vec<&'static Refusal>) -> String {
    let mut out = match coverage {
        Coverage::Answered(_) | Coverage::Refused(_) => String::new(),
        Coverage::ByBoxes(_) | Coverage::InPart(..) => format!("{}: ", coverage.name()),
    };
    if let Some(method) = coverage.method() {
        out += &(place(methods, method) + 1).to_string();
    }
    if let Some(refusal) = coverage.refusal() {
        let before = if coverage.method().is_some() { ", else " } else { "" };
        out += &format!("{before}{}", letter(place(refusals, refusal)));
    }
    out
}

/// The place of an entry in a list, to which it is added where it is new.
fn place<T>(list: &mut Vec<&'static T>, entry: &'static T) -> usize {
    list.iter().position(|known| std::ptr::eq(*known, entry)).unwrap_or_else(|| {
        list.push(entry);
        list.len() - 1
    })
}

/// `A` to `Z`, then `AA`.
fn letter(k: usize) -> String {
    let own = char::from(b'A' + (k % 26) as u8);
    if k < 26 { own.to_string() } else { format!("{}{own}", letter(k / 26 - 1)) }
}

#[cfg(test)]
mod tests {
    use super::super::Asked;
    use super::*;
    use crate::model::published::publish;

    #[test]
    fn each_question_has_its_row() {
        let rows: Vec<Asked> = rows().iter().map(|row| row.asked).collect();
        assert_eq!(rows, Asked::ALL);
    }

    #[test]
    fn beside_the_schemas_the_documentation_has_the_page_of_the_table() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/explanation/coverage.md");
        let made = page();
        publish(path, &std::fs::read_to_string(path).unwrap_or_default(), &made, &made);
    }
}
