//! Requirements on the command line.

use super::assignments::in_line;
use super::commands::Context;
use super::status::Error;
use clap::Args;
use jurist_algebra::number::{Rational, parse_number};
use jurist_engine::error::Diagnostic;
use jurist_engine::response::Requirement;

/// What is required beyond stability.
#[derive(Args, Debug, Default)]
pub(super) struct RequirementOptions {
    /// Asks for a gain margin both ways: '6 dB' or a factor
    #[arg(long, value_name = "MARGIN")]
    pub gain_margin: Option<String>,
    /// Asks for a phase margin: '45 deg'
    #[arg(long, value_name = "ANGLE")]
    pub phase_margin: Option<String>,
    /// Asks for a modulus margin: the least |1 + L|
    #[arg(long, value_name = "NUMBER")]
    pub modulus_margin: Option<String>,
    /// Asks for a damping of all roots (continuous time)
    #[arg(long, value_name = "NUMBER")]
    pub damping: Option<String>,
    /// Where the loop is cut for margins: a signal, or a block (at its input) [default: the error of a single loop]
    #[arg(long, value_name = "SIGNAL")]
    pub at: Option<String>,
}

impl RequirementOptions {
    /// The requirements, in a fixed order.
    pub fn requirements(&self, context: &Context) -> Result<Vec<Requirement>, Error> {
        let mut out = Vec::new();
        if let Some(text) = &self.gain_margin {
            let (value, unit) = number(context, "--gain-margin", text, &["", "dB"])?;
            out.push(match unit {
                "dB" => Requirement::gain_margin_in_decibels(&value, &context.budget)?,
                _ => Requirement::gain_margin(&value)?,
            });
        }
        if let Some(text) = &self.phase_margin {
            let (value, _) = number(context, "--phase-margin", text, &["", "deg", "degrees"])?;
            out.push(Requirement::phase_margin(&value)?);
        }
        if let Some(text) = &self.modulus_margin {
            out.push(Requirement::modulus_margin(number(context, "--modulus-margin", text, &[""])?.0)?);
        }
        if let Some(text) = &self.damping {
            out.push(Requirement::damping(number(context, "--damping", text, &[""])?.0)?);
        }
        Ok(out)
    }
}

/// A number and its unit, one of some.
fn number<'u>(context: &Context, option: &str, text: &str, units: &[&'u str]) -> Result<(Rational, &'u str), Error> {
    let longest = units.iter().filter(|unit| text.trim_end().ends_with(**unit)).max_by_key(|unit| unit.len());
    let value = longest.and_then(|unit| {
        let digits = text.trim_end().strip_suffix(*unit)?.trim();
        Some((parse_number(digits).ok()?, *unit))
    });
    value.ok_or_else(|| {
        let place = context.line.option_value(option, text).span;
        let error = Diagnostic::error("E-option-value", format!("{option} expects a number and its unit"));
        let known: Vec<&str> = units.iter().copied().filter(|u| !u.is_empty()).collect();
        let error = error.at(place, "not understood");
        let error =
            if known.is_empty() { error } else { error.help(format!("units known here: {}", known.join(", "))) };
        in_line(context.line, vec![error]).into()
    })
}
