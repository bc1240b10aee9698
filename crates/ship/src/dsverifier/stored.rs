//! The controller with the coefficients that DSVerifier stores: each is rounded as it is written, the leading one of the denominator too.

use super::{DsFile, List, refused};
use crate::format::{Fixed, Rounding};
use jurist_engine::error::{Code, Diagnostic, Diagnostics};

impl DsFile {
    /// The file with the stored coefficients in the place of the controller's.
    ///
    /// DSVerifier does not divide by the leading coefficient of the denominator before it rounds: it stores all coefficients, and divides at each
    /// sample. So this is another controller than that of `[ship]` in [`DsFile::model`], unless the coefficient is 1.
    ///
    /// Cost: a division for each coefficient.
    ///
    /// ```
    /// use jurist_engine::error::Source;
    /// use jurist_ship::dsverifier::DsFile;
    /// use jurist_ship::format::Rounding;
    /// let text = "digital_system ds = { .b = { -0.1 }, .b_size = 1, .a = { 0.76172, 0.3 }, .a_size = 2 };
    ///     implementation impl = { .int_bits = 3, .frac_bits = 7 };";
    /// let stored = DsFile::read(&Source::new("input.c", text), &[])?.stored(Rounding::Floor)?;
    /// let texts: Vec<String> = stored.controller.denominator.numbers.iter().map(|n| n.value.to_string()).collect();
    /// assert_eq!(texts, ["97/128", "19/64"]);
    /// # Ok::<(), jurist_engine::error::Diagnostics>(())
    /// ```
    ///
    /// # Errors
    /// `E-ship-range` at a coefficient that does not fit, before it is rounded: DSVerifier calls that a failure of whatever it checks. `E-import` where
    /// there is no format, or the leading coefficient of the denominator is stored as 0.
    pub fn stored(&self, rounding: Rounding) -> Result<DsFile, Diagnostics> {
        self.rounded(rounding).map_err(|error| self.refuse(error))
    }

    fn rounded(&self, rounding: Rounding) -> Result<DsFile, Diagnostic> {
        let Some(one) = &self.implementation else {
            let error = refused("the file has no number format");
            return Err(error.help("add implementation impl = { .int_bits = 3, .frac_bits = 13 };"));
        };
        let fixed = Fixed {
            bits: one.integer + one.fraction,
            fraction: i32::try_from(one.fraction).unwrap_or(i32::MAX),
            scale: 0,
            rounding,
        };
        let mut out = DsFile { is_stored: true, ..self.clone() };
        let system = &mut out.controller;
        for (letter, list) in [('b', &mut system.numerator), ('a', &mut system.denominator)] {
            round(list, letter, &fixed)?;
        }
        let before = &self.controller.denominator;
        let leading = before.leading_zeros();
        if system.denominator.numbers[leading].value.is_zero() {
            let number = &before.numbers[leading];
            let error = refused(format!("a[{leading}] = {} is stored as 0", number.text));
            return Err(error
                .at(number.span, "the controller divides by it")
                .help("it needs more bits behind the point"));
        }
        Ok(out)
    }
}

fn round(list: &mut List, letter: char, fixed: &Fixed) -> Result<(), Diagnostic> {
    let (least, greatest) = fixed.integers();
    let (least, greatest) = (fixed.value(&least), fixed.value(&greatest));
    for (k, number) in list.numbers.iter_mut().enumerate() {
        if number.value < least || number.value > greatest {
            let message = format!("{letter}[{k}] = {} is not between {least} and {greatest}", number.text);
            let error = Diagnostic::error(Code::ShipRange, message).at(number.span, "does not fit");
            return Err(error.help("of the bits before the point one is the sign: .int_bits has to be larger"));
        }
        number.value = fixed.value(&fixed.rounded(&number.value));
        number.text = match number.value.is_integer() {
            true => number.value.to_string(),
            false => format!("\"{}\"", number.value),
        };
    }
    Ok(())
}
