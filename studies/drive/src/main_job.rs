//! The main job: the paper's drive on one page, each limit beside the paper's.

use crate::document::{Main, MainAnswer, MainName, PaperLimit, PaperLimits, Rounding};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::matrix::CharacteristicPolynomial;
use jurist_algebra::number::{Rational, enclosed_decimal, to_decimal};
use jurist_algebra::poly::RationalFunction;
use jurist_algebra::real::Real;
use jurist_engine::answer::{Answer, ParametricTable};
use jurist_engine::error::{Error, Source};
use jurist_engine::model::Model;
use jurist_engine::problem::Ask;
use jurist_engine::stability::{AlgebraicInterval, ClassicalTest, End, IntervalSet, StableInterval, StableSet};
use jurist_show::documents::{Answered, Exact};
use jurist_show::intervals::{domain_text, set_lines};
use jurist_show::layout::{Columns, short, visible, wrapped};
use jurist_show::notation::Coefficient;
use jurist_show::{Document, real};

/// Eq. 23 with the digits that the paper prints.
const PRINTED_23: &str = include_str!("../models/equation-23-as-printed.toml");

/// The amplitude of the PWM wave, in which Eq. 23 is written.
const AMPLITUDE: &str = "K_pwm";
/// The chopping period, in which Eq. 37 is written.
const PERIOD: &str = "T";

/// Characters per line.
const WIDTH: usize = 100;

/// Digits of the certified limits where fewer are asked for.
const LIMIT_DIGITS: usize = 20;

/// What the paper gives as limits: for each the root locus' and the Jury test's number.
const PAPER: [(&str, &str, &str); 3] =
    [("lower", "3.0", "2.9853"), ("upper", "550", "549.7"), ("period", "", "2012.47 Hz")];

/// Everything the main job shows.
#[derive(Debug)]
#[non_exhaustive]
pub struct MainJob {
    /// The Jury test in the amplitude; its problem has Eq. 23.
    pub amplitude: Answer<ParametricTable>,
    /// The Jury test in the period; its problem has Eq. 37.
    pub period: Answer<ParametricTable>,
    /// The exact stable set of Eq. 23 with the digits printed in the paper.
    pub printed: Answer<StableSet>,
}

/// Does the main job on the drive.
///
/// # Errors
/// [`Error::Stopped`] when the budget runs out.
pub fn main_job(model: &Model, budget: &Budget) -> Result<MainJob, Error> {
    let (printed, _) = Model::from_toml(&Source::new("<Eq. 23 as printed>", PRINTED_23))?;
    Ok(MainJob {
        amplitude: model.ask().free(AMPLITUDE).parametric_table(budget)?,
        period: model.ask().free(PERIOD).parametric_table(budget)?,
        printed: printed.ask().free(AMPLITUDE).stable_set(budget)?,
    })
}

/// The characteristic polynomial behind an answer.
fn equation<T>(answer: &Answer<T>) -> &CharacteristicPolynomial {
    let algebra = answer.problem().evaluated();
    algebra.and_then(|a| a.polynomial()).expect("the drive is defined, and its answers evaluated it")
}

/// The document `jurist/main/1`.
pub fn main_job_json(job: &MainJob, digits: usize) -> Main {
    let at_one = |p: &CharacteristicPolynomial| value_at_one(p).display(&p.variables).to_string();
    let [lower, upper, period] =
        PAPER.map(|(_, locus, jury)| PaperLimit { root_locus: locus.to_owned(), jury: jury.to_owned() });
    let answer = MainAnswer {
        title: job.amplitude.problem().title().unwrap_or_default().to_owned(),
        jury: [job.amplitude.json(digits), job.period.json(digits)],
        frequency_limit_hz: period_end(job).map(|end| reciprocal(&end.value, digits)),
        paper: PaperLimits { lower, upper, period },
        rounding: Rounding {
            exact_value_at_one: at_one(equation(&job.amplitude)),
            printed_value_at_one: at_one(equation(&job.printed)),
            printed_zero: printed_zero(job).as_ref().map(Exact::from),
            printed_polynomial: job.printed.json(digits),
        },
    };
    Main { schema: MainName::V1, answer: Answered::Known(answer) }
}

/// The document `jurist/main/1` of a job that the budget did not allow.
pub fn main_job_undecided(stopped: &Exhausted) -> Main {
    Main { schema: MainName::V1, answer: Answered::Undecided(stopped.into()) }
}

/// The page.
pub fn main_job_text(job: &MainJob, digits: usize) -> String {
    let mut out = model_text(job);
    let title = |p: &CharacteristicPolynomial, set: &[(String, Rational)]| {
        let at: Vec<String> = set.iter().map(|(name, v)| format!("{name} = {}", short(v))).collect();
        format!("Q(z) = a_{} z^{} + ... + a_1 z + a_0 at {}", p.formal_degree, p.formal_degree, at.join(", "))
    };
    out.push_str(&format!("\nEq. 23  {}\n", title(equation(&job.amplitude), job.amplitude.problem().set())));
    out.push_str(&equation_text(equation(&job.amplitude), digits, true));
    out.push_str(&format!("\nEq. 37  {}\n", title(equation(&job.period), job.period.problem().set())));
    out.push_str(&equation_text(equation(&job.period), digits, false));
    out.push_str("\nJury's conditions, each solved exactly ('jurist jury --param NAME' shows all)\n");
    out.push_str(&conditions_text(job, digits));
    out.push_str("\nLimits of stability\n");
    out.push_str(&limits_text(job, digits.max(LIMIT_DIGITS)));
    out.push_str(&format!("\n{}\n", wrapped(&rounding_text(job, digits), WIDTH, "").replace('\u{a0}', " ")));
    out
}

/// Title, parameters and constants.
fn model_text(job: &MainJob) -> String {
    let model = job.amplitude.problem().model();
    let mut out = format!(
        "{}: {} time, order {}\n",
        visible(model.title().unwrap_or("the drive")),
        model.time().name(),
        equation(&job.amplitude).formal_degree
    );
    let mut columns = Columns::new("  ");
    for p in model.parameters() {
        let unit = visible(p.unit.as_deref().unwrap_or_default());
        let nominal = p.nominal.as_ref().map(|n| format!("{} {unit}", short(n))).unwrap_or_default();
        let domain = domain_text(&p.name, &jurist_engine::stability::Range::between(p.min.clone(), p.max.clone()));
        columns.row([
            p.name.clone(),
            nominal,
            domain,
            visible(p.description.as_deref().unwrap_or_default()).into_owned(),
        ]);
    }
    out.push_str(&columns.to_string());
    let constants =
        model.constants().iter().filter_map(|c| Some(format!("{} = {}", c.name, short(c.number.as_ref()?))));
    // A value stays on its name's line.
    let constants = constants.map(|c| c.replace(' ', "\u{a0}")).collect::<Vec<_>>().join(", ");
    out.push_str(&format!("  {}\n", wrapped(&constants, WIDTH - 2, "  ").replace('\u{a0}', " ")));
    out
}

/// The coefficients by powers of the parameter, exact and rounded: side by side or below each other.
fn equation_text(p: &CharacteristicPolynomial, digits: usize, beside: bool) -> String {
    let rows: Vec<Vec<Rational>> = p.coefficients.iter().map(powers_of_parameter).collect();
    let width = rows.iter().map(Vec::len).max().unwrap_or(1);
    let name = p.variables.first().map_or("", String::as_str);
    let heads = (0..width).map(|k| match k {
        0 => "1".to_owned(),
        1 => name.to_owned(),
        _ => format!("{name}^{k}"),
    });
    let heads: Vec<String> = heads.collect();
    let cells = |row: &Vec<Rational>, write: &dyn Fn(&Rational) -> String| -> Vec<String> {
        (0..width).map(|k| row.get(k).filter(|v| !v.is_zero()).map(write).unwrap_or_default()).collect()
    };
    let exact = |v: &Rational| v.to_string();
    let rounded = |v: &Rational| to_decimal(v, digits);
    let label = |k: usize| format!("a_{k}");
    let mut columns = Columns::new("  ");
    if beside {
        let notes = [vec!["exact".to_owned()], heads.clone(), vec![format!("{digits} digits")], heads].concat();
        columns.row(notes);
        for (k, row) in rows.iter().enumerate() {
            let line = [vec![label(k)], cells(row, &exact), vec![String::new()], cells(row, &rounded)].concat();
            columns.row(line);
        }
        return columns.to_string();
    }
    columns.row([vec!["exact".to_owned()], heads.clone()].concat());
    for (k, row) in rows.iter().enumerate() {
        columns.row([vec![label(k)], cells(row, &exact)].concat());
    }
    columns.row([vec![format!("{digits} digits")], heads].concat());
    for (k, row) in rows.iter().enumerate() {
        columns.row([vec![label(k)], cells(row, &rounded)].concat());
    }
    columns.to_string()
}

/// The coefficients of a polynomial in one parameter, from the constant term up. The drive's matrices
/// are polynomial in its parameters, so no denominator contains one.
fn powers_of_parameter(c: &RationalFunction) -> Vec<Rational> {
    let mut out = Vec::new();
    for (exponents, value) in Coefficient::new(c, 1).numerator {
        let k = exponents.first().map_or(0, |e| *e as usize);
        if out.len() <= k {
            out.resize(k + 1, Rational::ZERO);
        }
        out[k] = value;
    }
    out
}

/// The conditions of both tests side by side: they have the same names. Of each solution set the piece
/// around the nominal value is shown.
fn conditions_text(job: &MainJob, digits: usize) -> String {
    let (Some(a), Some(b)) = (test(&job.amplitude), test(&job.period)) else { return String::new() };
    let piece = |answer: &Answer<ParametricTable>, set: &IntervalSet| {
        let free = answer.problem().parameter();
        let around = |i: &&AlgebraicInterval| free.nominal.as_ref().is_some_and(|n| i.contains(n));
        let intervals = set.intervals();
        let Some(shown) = intervals.iter().find(around).or(intervals.first()) else { return "nowhere".to_owned() };
        // Alone, so that its ends need not be told apart from others that are not shown.
        let line = set_lines(&free.name, &IntervalSet::from_iter([shown.clone()]), digits.min(9)).remove(0);
        match intervals.len() {
            1 => line,
            n => format!("{line} (and {} more)", n - 1),
        }
    };
    let mut columns = Columns::new("  ");
    for (x, y) in a.conditions.iter().zip(&b.conditions) {
        columns.row([x.name.clone(), piece(&job.amplitude, &x.solution), piece(&job.period, &y.solution)]);
    }
    let all = [piece(&job.amplitude, &a.intersection), piece(&job.period, &b.intersection)];
    columns.row(std::iter::once("all together".to_owned()).chain(all));
    columns.to_string()
}

fn test(answer: &Answer<ParametricTable>) -> Option<&ClassicalTest> {
    answer.value().test.as_ref()
}

/// The certified limits beside the paper's.
fn limits_text(job: &MainJob, digits: usize) -> String {
    let name = &job.amplitude.problem().parameter().name;
    let mut columns = Columns::new("  ");
    columns.row(["", "certified", "", "paper: Jury", "root locus"].map(String::from));
    let ends = main_interval(&job.amplitude);
    let [lower, upper, period] = PAPER;
    if let Some(end) = ends.and_then(|i| i.lower.as_ref()) {
        let value = real::rounded(&end.value, digits).decimal;
        columns.row([format!("{name} >"), value, cause(end, job), lower.2.into(), lower.1.into()]);
    }
    if let Some(end) = ends.and_then(|i| i.upper.as_ref()) {
        let value = real::rounded(&end.value, digits).decimal;
        columns.row([format!("{name} <"), value, cause(end, job), upper.2.into(), upper.1.into()]);
    }
    if let Some(end) = period_end(job) {
        let value = real::rounded(&end.value, digits).decimal;
        let name = &job.period.problem().parameter().name;
        let at = hertz(end, &job.period).map(|f| format!("{} at {f} Hz", end.causes)).unwrap_or_default();
        columns.row([format!("{name} <"), format!("{value} s"), at, String::new(), String::new()]);
        let frequency = format!("{} Hz", reciprocal(&end.value, digits));
        columns.row([format!("1/{name} >"), frequency, String::new(), period.2.into(), period.1.into()]);
    }
    columns.to_string()
}

fn cause(end: &End, job: &MainJob) -> String {
    match hertz(end, &job.amplitude) {
        Some(f) => format!("{} at {f} Hz", end.causes),
        None => end.causes.to_string(),
    }
}

/// The frequency of the pair at an end, to seven digits.
fn hertz(end: &End, answer: &Answer<ParametricTable>) -> Option<String> {
    real::enclosed(7, |bits| answer.problem().frequency(end, bits)?.hertz)
}

/// The first stable interval.
fn main_interval(answer: &Answer<ParametricTable>) -> Option<&StableInterval> {
    answer.value().stable.intervals().first()
}

fn period_end(job: &MainJob) -> Option<&End> {
    main_interval(&job.period)?.upper.as_ref()
}

/// `1/x` of a positive number, correctly rounded.
fn reciprocal(x: &Real, digits: usize) -> String {
    let mut accuracy = digits;
    loop {
        let (lo, hi) = x.refined_to_digits(accuracy).enclosure();
        if let (Some(a), Some(b)) = (hi.recip(), lo.recip())
            && let Some(decimal) = enclosed_decimal(&a, &b, digits)
        {
            return decimal;
        }
        accuracy = accuracy + accuracy / 2 + 4;
    }
}

/// `Q(1)`: the sum of the coefficients.
fn value_at_one(p: &CharacteristicPolynomial) -> RationalFunction {
    p.coefficients.iter().fold(RationalFunction::zero(), |sum, c| &sum + c)
}

/// Where `Q(1)` of the printed polynomial, which is linear, vanishes.
fn printed_zero(job: &MainJob) -> Option<Rational> {
    let line = powers_of_parameter(&value_at_one(equation(&job.printed)));
    (-line.first()?).checked_div(line.get(1)?)
}

/// In two sentences, why the paper's lower limit is an effect of rounding.
fn rounding_text(job: &MainJob, digits: usize) -> String {
    let name = &job.amplitude.problem().parameter().name;
    let (Some(zero), Some(printed), Some(limit)) = (
        printed_zero(job),
        job.printed.value().intervals().first(),
        main_interval(&job.amplitude).and_then(|i| i.lower.as_ref()),
    ) else {
        return String::new();
    };
    let at_one = |p: &CharacteristicPolynomial| {
        let names = [name.clone()];
        jurist_show::notation::coefficient_text(&Coefficient::new(&value_at_one(p), 1), &names, Some(digits))
    };
    let end =
        |end: &Option<End>| end.as_ref().map_or_else(|| "infinity".into(), |e| real::rounded(&e.value, digits).decimal);
    let factor = {
        let (lo, hi) = limit.value.refined_to_digits(6).enclosure();
        let ratio = |x: &Rational| zero.checked_div(x);
        ratio(&hi).zip(ratio(&lo)).and_then(|(a, b)| enclosed_decimal(&a, &b, 3)).unwrap_or_default()
    };
    format!(
        "Why the paper's {} is rounding: with the twelve digits of Eq. 23 as printed, Q(1) = {}, which is positive only for \
         {name} > {}, and that polynomial, analysed exactly, is stable for {} < {name} < {}. With exact coefficients \
         Q(1) = {}, positive for every {name} > 0, so what ends stability below is not a root at z = 1 but the {} of the \
         table above, at a {name} {factor} times smaller.",
        PAPER[0].2,
        at_one(equation(&job.printed)).replace(' ', "\u{a0}"),
        to_decimal(&zero, digits),
        end(&printed.lower),
        end(&printed.upper),
        at_one(equation(&job.amplitude)),
        limit.causes,
    )
}
