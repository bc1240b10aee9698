//! The comment at the head of a file.

use super::numbers::power;
use super::{Arithmetic, Shipped};
use crate::run::Overflow;
use jurist_algebra::number::BinaryFormat;

/// What holds in every language, line by line.
pub(super) fn head(shipped: &Shipped<'_>, name: &str) -> Vec<String> {
    let mut lines = vec![format!("{name}: a controller, {}.", shipped.realisation.words()), String::new()];
    if !shipped.remarks.is_empty() {
        lines.extend(shipped.remarks.iter().cloned());
        lines.push(String::new());
    }
    match shipped.arithmetic {
        Arithmetic::Fixed(fixed) => {
            let signal = &fixed.signal;
            let (least, greatest) = signal.integers();
            let unit = i64::from(signal.scale) - i64::from(signal.fraction);
            lines.push(format!(
                "Signals and states are integers of {} bits, {least} to {greatest}; 1 unit = {}.",
                signal.bits,
                power(unit)
            ));
            let sums = (0..fixed.sums.len()).map(|node| fixed.greatest_sum(node).bit_length() + 1).max().unwrap_or(1);
            lines.push(format!(
                "Each sum is exact, with at most {sums} of 64 bits, and rounded once, {}.",
                signal.rounding.words()
            ));
            lines.push(match fixed.overflow {
                Overflow::Saturate => "What does not fit becomes the greatest or the least number.".into(),
                Overflow::Wrap => {
                    format!("Of what does not fit the last {} bits are kept, in two's complement.", signal.bits)
                }
            });
        }
        Arithmetic::Float(float) => {
            let bits = if float.format == BinaryFormat::Single { 32 } else { 64 };
            lines.push(format!("Signals and states are numbers of {bits} bits of IEEE 754, not scaled: 1 is 1."));
            lines.push(
                "Each product and each sum is rounded, to nearest with ties to even, in the order that is written."
                    .into(),
            );
        }
    }
    lines
}
