//! Rounding and overflow as statements.

use super::statements::{ARGUMENT, Expression, Helper, Operator, Statement};
use crate::format::{Fixed, Rounding};
use crate::run::Overflow;
use jurist_algebra::number::Integer;

fn power(bits: u32) -> Expression {
    Expression::Whole(Integer::ONE << u64::from(bits))
}

fn zero() -> Expression {
    Expression::Whole(Integer::ZERO)
}

fn argument() -> Expression {
    Expression::name(ARGUMENT)
}

fn wide(name: &str, value: Expression) -> Statement {
    Statement::Let { name: name.into(), kind: super::statements::WIDE, value }
}

fn floor(name: &str, of: &str, bits: u32) -> Statement {
    Statement::Floor { name: name.into(), of: of.into(), bits }
}

fn either(condition: Expression, then: Expression, otherwise: Vec<Statement>) -> Statement {
    Statement::If { condition, then: vec![Statement::Return(then)], otherwise }
}

/// The helper that rounds a sum by so many bits, at least one. No step overflows where the sum and `2^bits` together do not.
pub(super) fn rounding(name: String, mode: Rounding, bits: u32) -> Helper {
    use Operator::{And, Equal, Less, Minus, Over, Plus, Times, Unequal};
    let half = || power(bits - 1);
    let quotient = || Expression::name("q");
    let is_negative = || argument().with(Less, zero());
    let body = match mode {
        // Division drops the fraction: towards zero, whatever the sign.
        Rounding::Zero => vec![Statement::Return(argument().with(Over, power(bits)))],
        Rounding::Nearest => vec![either(
            is_negative(),
            argument().with(Minus, half()).with(Over, power(bits)),
            vec![Statement::Return(argument().with(Plus, half()).with(Over, power(bits)))],
        )],
        Rounding::Floor => vec![floor("q", ARGUMENT, bits), Statement::Return(quotient())],
        Rounding::HalfUp => {
            vec![wide("w", argument().with(Plus, half())), floor("q", "w", bits), Statement::Return(quotient())]
        }
        Rounding::Ceil => {
            vec![wide("w", argument().negative()), floor("q", "w", bits), Statement::Return(quotient().negative())]
        }
        // Ties go up at first; where that made an odd number of a tie, it is one too many.
        Rounding::Even => {
            let is_tie = Expression::name("w").with(Minus, quotient().with(Times, power(bits))).with(Equal, zero());
            let is_odd = quotient().with(Operator::Modulo, power(1)).with(Unequal, zero());
            vec![
                wide("w", argument().with(Plus, half())),
                floor("q", "w", bits),
                either(is_tie.with(And, is_odd), quotient().with(Minus, power(0)), vec![Statement::Return(quotient())]),
            ]
        }
    };
    Helper { name, remark: format!("Divides by 2^{bits} and rounds {}.", mode.words()), body }
}

/// The helper that makes a signal of a number.
pub(super) fn fitting(name: String, signal: &Fixed, overflow: Overflow) -> Helper {
    use Operator::{Greater, Less, Minus, Modulo, Plus};
    let (least, greatest) = signal.integers();
    let whole = |value: &Integer| Expression::Whole(value.clone());
    let (body, remark) = match overflow {
        Overflow::Saturate => {
            let below =
                either(argument().with(Less, whole(&least)), whole(&least), vec![Statement::Return(argument())]);
            let body = vec![either(argument().with(Greater, whole(&greatest)), whole(&greatest), vec![below])];
            (body, "What does not fit becomes the greatest or the least number.".to_owned())
        }
        Overflow::Wrap => {
            // The rest of the division is at most one turn away. Of 63 bits a turn is 2^63, which is no number of 64 bits.
            let half = -&least;
            let (rest, turn): (_, Box<dyn Fn(Operator) -> Expression>) = if signal.bits < 63 {
                let size = power(signal.bits);
                (
                    argument().with(Modulo, size.clone()),
                    Box::new(move |by| Expression::name("r").with(by, size.clone())),
                )
            } else {
                (argument(), Box::new(move |by| Expression::name("r").with(by, whole(&half)).with(by, whole(&half))))
            };
            let r = || Expression::name("r");
            let below = either(r().with(Less, whole(&least)), turn(Plus), vec![Statement::Return(r())]);
            let body = vec![wide("r", rest), either(r().with(Greater, whole(&greatest)), turn(Minus), vec![below])];
            (body, format!("Keeps the last {} bits.", signal.bits))
        }
    };
    Helper { name, remark, body }
}
