//! What is said about a certificate when it has been written: whether the independent check accepts it.

use super::arguments::RunOptions;
use super::commands::Context;
use super::output::{note, write_answer};
use jurist_algebra::number::{Rational, to_decimal};
use jurist_check::{Limits, check};
use jurist_engine::error::{Code, Diagnostic, Error};
use std::ffi::{OsStr, OsString};
use std::time::Duration;

/// Runs the check of `jurist verify` on a certificate that has been written, for as long as `--timeout` leaves
/// time, and warns where it does not accept what was written. The answer is out by then and stays what it is.
pub(super) fn check_certificate(context: &Context, options: &RunOptions, model: &str, text: &str, file: &OsStr) {
    if context.quiet {
        return;
    }
    let file = file.to_string_lossy();
    let usual = Limits::default().timeout;
    let left = options.timeout.map_or(usual, |timeout| timeout.saturating_sub(context.reporter.elapsed()).min(usual));
    let unchecked = |reason: &str| {
        let message =
            format!("the certificate {file} has been written, but 'jurist verify' may not accept it: {reason}");
        context.warn(
            None,
            &[Diagnostic::warning(Code::CertificateWarning, message)
                .help("the answer stands; it lacks its independent proof")],
        );
    };
    if left == Duration::ZERO {
        return unchecked("no time was left to check it");
    }
    context.budget.step("checking the certificate");
    let result = check(model, text, &Limits::within(left));
    context.reporter.finish();
    match result {
        Ok(proved) if options.verbose => note(&format!("checked: {file} proves: {}", proved.statement)),
        Ok(_) => {}
        Err(rejection) => unchecked(&rejection.to_string()),
    }
}

/// Makes a certificate, where a file for it is asked for, writes and checks it. The answer is out before, however long that takes.
pub(super) fn certify(
    context: &Context,
    options: &RunOptions,
    model: &str,
    file: &Option<OsString>,
    make: impl FnOnce() -> Result<String, Error>,
) -> Result<(), Error> {
    let Some((text, file)) = certified(context, file, make)? else { return Ok(()) };
    write_answer(&text, Some(file))?;
    check_certificate(context, options, model, &text, file);
    Ok(())
}

/// What a certificate is made of and the file for it, where one is asked for; why there is none is to be said after the answer.
pub(super) fn certified<'f, T>(
    context: &Context,
    file: &'f Option<OsString>,
    make: impl FnOnce() -> Result<T, Error>,
) -> Result<Option<(T, &'f OsString)>, Error> {
    let make = || context.check_certifiable().and_then(|()| make());
    file.as_ref().map(|file| Ok((make()?, file))).transpose()
}

/// A share in percent with so many decimal places, rounded down: no more is said than is proved.
pub(super) fn percent_below(share: &Rational, places: i64) -> String {
    let scale = Rational::from(10).pow(places).expect("ten is not zero");
    let floor = Rational::from((&(share * &Rational::from(100)) * &scale).floor());
    to_decimal(&(floor / scale), 12)
}

/// How much a certificate by boxes speaks of.
pub(super) fn share(name: &str, [low, high]: &[Rational; 2], proved: &Rational) -> String {
    let (low, high) = (to_decimal(low, 6), to_decimal(high, 6));
    let percent = percent_below(proved, 6);
    format!("proves {percent} % of {low} <= {name} <= {high}, by boxes; it says nothing of the rest")
}
