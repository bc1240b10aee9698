//! The whole paper once more on one page.

use super::diagrams::{chopper, current_controller, drive_blocks, pwm_signal, speed_controller, tracker};
use super::latex;
use super::limits::limits;
use super::runs;
use super::tables::{errata, polynomial, sensitivity};
use jurist_algebra::limits::Budget;
use jurist_algebra::matrix::CharacteristicPolynomial;
use jurist_algebra::number::{Rational, to_decimal};
use jurist_algebra::poly::RationalFunction;
use jurist_draw::figures::{Figure, locus_of};
use jurist_draw::page::{Section, Table, escaped, figure, math, matrix, paragraph, report_page};
use jurist_draw::report::{comment_at, entries};
use jurist_engine::answer::{Answer, ParametricTable};
use jurist_engine::error::{Error, Source};
use jurist_engine::model::{Form, Model};
use jurist_engine::problem::Ask;
use jurist_show::Text;
use jurist_show::intervals::set_lines;
use jurist_show::notation::{Coefficient, coefficient_text, root_locus_form};

/// The drive as blocks, for the circuit with switches.
const BLOCKS: &str = include_str!("../models/drive-blocks.toml");
/// Eqs. 23 and 37 with the digits that the paper prints.
const PRINTED_23: &str = include_str!("../models/equation-23-as-printed.toml");
const PRINTED_37: &str = include_str!("../models/equation-37-as-printed.toml");

/// A figure and the name of its file.
#[derive(Debug)]
pub struct NamedFigure {
    /// The file's name without its ending.
    pub name: String,
    /// The figure.
    pub figure: Figure,
}

/// The report: one page that needs nothing else, its figures, its tables.
#[derive(Debug)]
pub struct PaperReport {
    /// The page, figures and style within.
    pub html: String,
    /// The figures of the page.
    pub figures: Vec<NamedFigure>,
    /// The errata: place, printed, exact, what is wrong.
    pub errata: Table,
    /// The tables as LaTeX floats: limits, characteristic equations, Jury's table with its conditions,
    /// errata, sensitivity; no package is needed.
    pub latex: String,
}

/// Computes everything that the paper says about its drive once more, and writes it down.
///
/// # Errors
/// [`Error`] when the budget runs out.
pub fn paper_report(budget: &Budget) -> Result<PaperReport, Error> {
    let model = Model::drive();
    let read = |name: &str, text: &str| Model::from_toml(&Source::new(name, text)).map(|(model, _)| model);
    let blocks = read("<drive as blocks>", BLOCKS)?;
    let printed = [read("<Eq. 23 as printed>", PRINTED_23)?, read("<Eq. 37 as printed>", PRINTED_37)?];
    let mut figures = Vec::new();
    let drive = drive_section(&model, &blocks, &mut figures, budget)?;
    budget.step("equations");
    let (eq_23, eq_37) = (polynomial(&model, "K_pwm", budget)?, polynomial(&model, "T", budget)?);
    let equations = equations(&eq_23, &eq_37);
    let errata = errata(&model, budget)?;
    budget.step("Jury table");
    let in_amplitude = model.ask().free("K_pwm").parametric_table(budget)?;
    let in_period = model.ask().free("T").parametric_table(budget)?;
    let jury = jury_tables(&in_amplitude, &in_period);
    budget.step("root locus");
    let locus = locus_section(&model, &mut figures, budget)?;
    let runs = runs::section(&model, &blocks, &mut figures, budget)?;
    budget.step("limits by several ways");
    let limits = limits(&model, &blocks, [&printed[0], &printed[1]], budget)?;
    let sensitivity = sensitivity(&model, budget)?;
    let section = |(id, heading, html)| Section { id, heading, html };
    let html = report_page(
        "Stability of a PWM DC motor drive: the paper of Gürbüz and Akpınar (2002) once more, exactly",
        "",
        &[
            ("drive", "The drive", drive),
            ("model", "The model", model_section(&model)),
            ("equations", "Characteristic equations", equations_section(&equations, &eq_23)),
            ("errata", "Errata", errata_intro() + &errata.html()),
            ("jury", "Jury test", jury_section(&jury, [&in_amplitude, &in_period])),
            ("locus", "Root locus", locus),
            ("responses", "Responses", runs),
            ("limits", "Limits by several ways", limits.html() + &limits_remarks()),
            ("sensitivity", "How the limits depend on each number", sensitivity_intro() + &sensitivity.html()),
            ("proved", "What is proved, what is drawn", proved()),
        ]
        .map(section),
    );
    let latex = latex::floats(&[
        ("limits", &limits),
        ("equation-23", &equations[0]),
        ("equation-37", &equations[1]),
        ("jury", &jury[0]),
        ("conditions", &jury[1]),
        ("errata", &errata),
        ("sensitivity", &sensitivity),
    ]);
    Ok(PaperReport { html, figures, errata, latex })
}

fn drive_section(
    model: &Model,
    blocks: &Model,
    figures: &mut Vec<NamedFigure>,
    budget: &Budget,
) -> Result<String, Error> {
    let mut html = paragraph(
        "A separately excited DC motor, fed by a class-C chopper, with a PI speed controller around a PI current \
         controller. Figs. 1 to 6 are drawn anew.",
    );
    let drawn = [
        ("fig-01", drive_blocks(), "Fig. 1: the speed control system"),
        ("fig-02", chopper(), "Fig. 2: class-C chopper and its waveform"),
        ("fig-03", pwm_signal(), "Fig. 3: pulse width modulated signal"),
        ("fig-04", current_controller(), "Fig. 4: current controller, Eqs. 7 to 9"),
        ("fig-05", speed_controller(), "Fig. 5: speed controller, Eqs. 10 to 12"),
        ("fig-06", tracker(), "Fig. 6: the system as a tracker with output feedback"),
    ];
    for (name, drawing, caption) in drawn {
        html.push_str(&figure(name, &drawing, caption));
        figures.push(NamedFigure { name: name.into(), figure: drawing });
    }
    if let Some(ripple) = runs::ripple(blocks, budget)? {
        html.push_str(&figure(
            &ripple.name,
            &ripple.figure,
            "The current of the switched circuit in steady state, with its ripple",
        ));
        figures.push(ripple);
    }
    let mut table = Table::new("Nominal values", &["name", "value", "meaning, unit"]);
    for c in model.constants() {
        let value = c.number.as_ref().map(|n| to_decimal(n, 8)).unwrap_or_default();
        table.rows.push(vec![c.name.clone(), value, comment_at(model, c.span)]);
    }
    for p in model.parameters() {
        let value = p.nominal.as_ref().map(|n| to_decimal(n, 8)).unwrap_or_default();
        let meaning = [p.description.clone(), p.unit.clone()].into_iter().flatten().collect::<Vec<_>>().join(", ");
        table.rows.push(vec![p.name.clone(), value, meaning]);
    }
    html.push_str(&table.html());
    Ok(html)
}

fn model_section(model: &Model) -> String {
    let mut html = paragraph(
        "Eqs. 13 to 21: <i>x</i>(<i>n</i>+1) = <i>A x</i>(<i>n</i>) + <i>B u</i>(<i>n</i>) + <i>E r</i>(<i>n</i>), \
         <i>u</i> = −<i>K y</i>, <i>y</i> = <i>C x</i>, so that <i>x</i>(<i>n</i>+1) = [<i>A</i> − <i>BKC</i>] \
         <i>x</i>(<i>n</i>) + <i>E r</i>(<i>n</i>). States: <i>i</i><sub>a</sub>, <i>ω</i>, and two of each controller. \
         Two entries of the paper's text are repaired; see the errata.",
    );
    if let Form::OutputFeedback { a, b, c, k, ports } = model.form() {
        for (name, m) in
            [("A", Some(a)), ("B", Some(b)), ("C", Some(c)), ("K", Some(k)), ("E", ports.input_matrix.as_ref())]
        {
            html.push_str(&m.map(|m| matrix(name, &entries(model, m))).unwrap_or_default());
        }
    }
    html
}

/// Eqs. 23 and 37, coefficient by coefficient.
fn equations(eq_23: &CharacteristicPolynomial, eq_37: &CharacteristicPolynomial) -> [Table; 2] {
    [("Eq. 23, T = 0.0001 s", eq_23), ("Eq. 37, K_pwm = 110 V", eq_37)]
        .map(|(caption, p)| coefficients(caption, "a", &p.variables, &p.coefficients))
}

fn equations_section(tables: &[Table; 2], eq_23: &CharacteristicPolynomial) -> String {
    let mut html = paragraph(&format!(
        "Eq. 22: det(<i>zI</i> − (<i>A</i> − <i>BKC</i>)) = 0. {}",
        math("Q(z) = a_6 z^6 + a_5 z^5 + a_4 z^4 + a_3 z^3 + a_2 z^2 + a_1 z + a_0.")
    ));
    html.extend(tables.iter().map(Table::html));
    if let Some((num, den)) = root_locus_form(eq_23, 0) {
        html.push_str(&paragraph(&math("Eq. 24: 1 + K_pwm num(z)/den(z) = 0")));
        html.push_str(&coefficients("num(z)", "n", &eq_23.variables, &num).html());
        html.push_str(&coefficients("den(z)", "d", &eq_23.variables, &den).html());
    }
    html
}

fn coefficients(caption: &str, letter: &str, names: &[String], list: &[RationalFunction]) -> Table {
    let mut table = Table::new(caption, &["", "exact", "12 digits"]);
    for (k, c) in list.iter().enumerate() {
        let c = Coefficient::new(c, names.len());
        let text = |digits| coefficient_text(&c, names, digits);
        table.rows.push(vec![format!("{letter}_{k}"), text(None), text(Some(12))]);
    }
    table
}

fn errata_intro() -> String {
    paragraph(
        "The program holds every printed coefficient of Eqs. 23 and 37 and of the list after Eq. 36 as data and compares \
         it, at the number of digits printed, with the exact one. What is not in the table is equal to the last printed \
         digit. Rows said to be in the text as we have it may be damage of that text; only the numbers are the paper's.",
    )
}

/// Table 1, and its conditions with their solution sets.
fn jury_tables(amplitude: &Answer<ParametricTable>, period: &Answer<ParametricTable>) -> [Table; 2] {
    let head = ["z^0", "z^1", "z^2", "z^3", "z^4", "z^5", "z^6"];
    let mut scheme = Table::new("Table 1: each row of letters follows from the one above by Eqs. 26 to 29", &head);
    for (letter, top) in [("a", 6), ("b", 5), ("c", 4), ("d", 3)] {
        scheme.rows.push((0..=top).map(|k| format!("{letter}_{k}")).collect());
        scheme.rows.push((0..=top).rev().map(|k| format!("{letter}_{k}")).collect());
    }
    scheme.rows.push((0..=2).map(|k| format!("e_{k}")).collect());
    let head = ["condition", "holds for K_pwm in V (T = 0.0001 s)", "holds for T in s (K_pwm = 110 V)"];
    let mut table = Table::new("Conditions 30 to 36, each with its exact solution set", &head);
    let (Some(a), Some(b)) = (&amplitude.value().test, &period.value().test) else {
        return [scheme, table];
    };
    let solution = |name: &str, set| match set_lines(name, set, 12).join(" or ") {
        text if text.is_empty() => "nowhere".to_owned(),
        text => text,
    };
    for (x, y) in a.conditions.iter().zip(&b.conditions) {
        table.rows.push(vec![x.name.clone(), solution("K_pwm", &x.solution), solution("T", &y.solution)]);
    }
    let all = vec!["all together".into(), solution("K_pwm", &a.intersection), solution("T", &b.intersection)];
    table.rows.push(all);
    [scheme, table]
}

fn jury_section(tables: &[Table; 2], answers: [&Answer<ParametricTable>; 2]) -> String {
    let mut html: String = tables.iter().map(Table::html).collect();
    html.push_str(&paragraph(
        "The sets were found twice: from the conditions, and from the boundary polynomials without the table. They agree.",
    ));
    for answer in answers {
        let summary = math(&format!("The table's entries in {}", answer.problem().parameter().name));
        let text = escaped(&answer.text(9));
        html.push_str(&format!("<details><summary>{summary}</summary><pre>{text}</pre></details>\n"));
    }
    html
}

fn locus_section(model: &Model, figures: &mut Vec<NamedFigure>, budget: &Budget) -> Result<String, Error> {
    let answer = model.ask().free("K_pwm").stable_set(budget)?;
    let range = (Rational::new(1.into(), 1000.into()), Rational::from(1000));
    let drawn = locus_of(&answer, &range, None, budget)?;
    let caption = "Roots of Eq. 24; colours and crossings are those of the exact answer, not of the drawn roots";
    let captions =
        [("root-locus-whole", caption), ("root-locus-near", "The same, magnified where roots cross the circle")];
    let parts = drawn.parts.iter().zip(captions).map(|(part, (name, caption))| figure(name, part, caption));
    let mut html = format!("<div class=\"grid two\">{}</div>\n", parts.collect::<String>());
    let labels: Vec<String> = drawn.crossings.iter().map(|c| format!("<li>{}</li>", math(&c.label))).collect();
    html.push_str(&format!("<p>The unit circle is crossed at</p><ul>{}</ul>\n", labels.concat()));
    figures.push(NamedFigure { name: "root-locus".into(), figure: drawn.figure });
    Ok(html)
}

fn limits_remarks() -> String {
    let cut = Rational::new(10_000_000.into(), 4969.into());
    let rounding = paragraph(&format!(
        "The lower limit of the paper is an effect of rounding: with twelve digits printed, Q(1) of Eq. 23 vanishes at \
         {}, with exact coefficients Q(1) is a positive multiple of {}. The printed Eq. 37, taken as exact, is not stable \
         at very short periods either. The published 2012.47 Hz is 1/0.0004969 s = {} Hz, cut: the limit of the period was \
         rounded to four digits before it was inverted.",
        math("K_pwm = 2.9853 V"),
        math("K_pwm"),
        to_decimal(&cut, 8),
    ));
    let circuit = paragraph(
        "The rows called circuit are about the chopper itself, around its periodic steady state at 80 rad/s with the \
         on-time from the sawtooth: once by the eigenvalues of the period map linearised there without approximation, \
         once by runs of the circuit that a disturbance of a ten-millionth shows to grow or to die, which need no \
         derivative. At 2010 Hz the linear model is unstable and the circuit is not. Two things make the difference: \
         Euler's rule, which replaces the motor's exponential over a period, and the pulse, which acts at its own \
         instant and not, as a mean, over the whole period; so it also matters where in the period the pulse lies. A \
         large disturbance is another question: from rest the duty ratio is clamped, and nothing can grow without bound.",
    );
    rounding + &circuit
}

fn sensitivity_intro() -> String {
    paragraph(
        "The paper concludes that the region depends on inertia, friction, the motor's other constants and the \
         controllers' gains, without saying how much. Every limit below is an algebraic number, correctly rounded.",
    )
}

fn proved() -> String {
    "<ul><li><b>Proved</b>, by exact arithmetic from the model's text to the limit: the characteristic equations, the \
     errata, Table 1 with its conditions and solution sets, the limits marked so, the table of what moves them, and the \
     labels of the crossings on the root locus.</li>\n<li><b>Only drawn</b>, in floating point: the roots between the \
     crossings, all responses, growth factors, everything about the circuit with switches, and the limits found by \
     simulation.</li>\n<li><b>Assumed</b>: the model itself. Euler's rule stands for the motor, and nothing limits the \
     voltage; the circuit with switches shows what that leaves out.</li></ul>\n"
        .to_owned()
}

#[cfg(test)]
mod tests {
    use super::super::coefficient;
    use super::*;

    #[test]
    fn the_exact_value_at_one_is_a_multiple_of_the_amplitude() {
        let p = polynomial(&Model::drive(), "K_pwm", &Budget::unlimited()).unwrap();
        let sum = |k| (0..=6).fold(Rational::ZERO, |s, z| s + coefficient(&p, z, k));
        assert!(sum(0).is_zero() && sum(1).sign().is_gt());
    }
}
