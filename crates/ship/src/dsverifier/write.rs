//! A loop of DSVerifier as the text of a model.

use super::system::{Coefficient, Implementation, List, System};
use super::{Loop, Reading, refused};
use jurist_algebra::number::Rational;
use jurist_engine::error::{Diagnostic, Source};
use jurist_engine::show::layout::visible;
use std::fmt::Write;
use std::path::Path;

/// What is read of a file.
pub(super) struct Parts<'a> {
    pub source: &'a Source,
    pub reading: Reading,
    pub controller: System,
    pub plant: System,
    pub implementation: Option<Implementation>,
    pub remarks: Vec<String>,
}

/// Lines of comments are as long as this.
const WIDTH: usize = 118;

/// What a text takes.
const TAKES: &str = "a text takes all text";

/// The model, and what is to be said of it.
pub(super) fn write(parts: &Parts<'_>) -> Result<Loop, Diagnostic> {
    let Parts { controller, plant, reading, .. } = parts;
    let mut constants = String::new();
    // Only the plant's uncertainty is looked at, as in the source.
    let c = [&controller.b, &controller.a].map(plain);
    let p = [("plant_b", &plant.b), ("plant_a", &plant.a)].map(|(name, list)| named(name, list, &mut constants));
    let c = fraction("controller", controller, c, *reading)?;
    let p = fraction("plant", plant, p, *reading)?;
    let remarks = remarks(parts);
    let name = Path::new(&parts.source.name)
        .file_name()
        .map_or(parts.source.name.clone(), |file| file.to_string_lossy().into_owned());
    let name = visible(&name);
    let mut out = comment(&format!(
        "From {name}, a file of DSVerifier (https://github.com/ssvlab/dsverifier; how it is read is that of commit 1daca47). {}",
        match reading {
            Reading::Z => "Lists are falling powers of z, the last entry is the constant.",
            Reading::InverseZ => "Lists are powers of 1/z, the first entry is that of the present sample.",
        }
    ));
    remarks.iter().for_each(|remark| out += &comment(&sentence(remark)));
    let title = name.replace('\\', "\\\\").replace('"', "\\\"");
    write!(out, "\ntitle = \"Loop of {title}\"\ntime = \"discrete\"\n").expect(TAKES);
    if let Some(time) = &controller.sample_time {
        writeln!(out, "sample_time = {}", time.text).expect(TAKES);
    }
    if !constants.is_empty() {
        write!(out, "\n[constants]\n{constants}").expect(TAKES);
    }
    out += "\n[loop]\ninputs = [\"r\"]\noutputs = [\"y\"]\n";
    for (name, input, output, [num, den]) in [("controller", "r - y", "u", &c), ("plant", "u", "y", &p)] {
        write!(
            out,
            "\n[[block]]\nname = \"{name}\"\ninput = \"{input}\"\noutput = \"{output}\"\nnum = {num}\nden = {den}\n"
        )
        .expect(TAKES);
    }
    out += &ship(parts.implementation.as_ref());
    Ok(Loop { model: out, remarks })
}

fn ship(implementation: Option<&Implementation>) -> String {
    let mut out = "\n[ship]\nblock = \"controller\"\nrealisation = \"df1\"\n".to_owned();
    let Some(Implementation { bits, fraction, bound, delta }) = implementation else { return out };
    writeln!(out, "format = {{ bits = {bits}, fraction = {fraction}, round = \"floor\" }}").expect(TAKES);
    if let Some(bound) = bound {
        writeln!(out, "inputs = {{ r = {bound} }}").expect(TAKES);
    }
    if let Some(delta) = delta {
        writeln!(out, "delta = \"{}\"", delta.value).expect(TAKES);
    }
    out
}

/// What stands in a list of the model, with its value.
type Entry = (String, Rational);

fn plain(list: &List) -> Vec<Entry> {
    list.entries.iter().map(|Coefficient { number, .. }| (number.text.clone(), number.value.clone())).collect()
}

/// Coefficients with an uncertainty become constants with a tolerance.
fn named(name: &str, list: &List, constants: &mut String) -> Vec<Entry> {
    let entry = |(k, Coefficient { number, uncertainty }): (usize, &Coefficient)| {
        let Some(percent) = uncertainty else { return (number.text.clone(), number.value.clone()) };
        writeln!(constants, "{name}{k} = {{ value = {}, tolerance = \"{}%\" }}", number.text, percent.text)
            .expect(TAKES);
        (format!("\"{name}{k}\""), number.value.clone())
    };
    list.entries.iter().enumerate().map(entry).collect()
}

/// Numerator and denominator as lists of a model, by falling powers of z.
fn fraction(
    name: &str,
    system: &System,
    [mut num, mut den]: [Vec<Entry>; 2],
    reading: Reading,
) -> Result<[String; 2], Diagnostic> {
    if reading == Reading::InverseZ {
        let length = num.len().max(den.len());
        for list in [&mut num, &mut den] {
            list.resize(length, ("0".into(), Rational::ZERO));
        }
    }
    // What is lost is the name of no uncertain number: zeros have none.
    let lists = [&num, &den].map(|list| match list.iter().position(|(_, value)| !value.is_zero()) {
        Some(first) => &list[first..],
        None => &list[list.len().saturating_sub(1)..],
    });
    let [above, below] = lists.map(<[Entry]>::len);
    if above > below {
        let error = refused(format!(
            "the numerator of the {name} has degree {}, its denominator {}: the output would come before the input",
            above - 1,
            below - 1
        ))
        .at(system.b.span, "too long")
        .also(system.a.span, "too short");
        return Err(match reading {
            Reading::Z => error.help("--reading z^-1 aligns both lists at their beginning"),
            Reading::InverseZ => error.help("the first entry of the denominator is not 0 in this reading"),
        });
    }
    Ok(lists.map(|list| {
        let texts: Vec<&str> = list.iter().map(|(text, _)| text.as_str()).collect();
        format!("[{}]", texts.join(", "))
    }))
}

fn remarks(parts: &Parts<'_>) -> Vec<String> {
    let Parts { controller, plant, implementation, .. } = parts;
    let mut out = parts.remarks.clone();
    out.extend(controller.remarks.iter().chain(&plant.remarks).cloned());
    let leading = controller.a.entries.iter().map(|entry| &entry.number).find(|number| !number.value.is_zero());
    if let Some(number) = leading.filter(|number| !number.value.is_one()) {
        out.push(format!(
            "the first coefficient of the controller's denominator is {}, not 1: all its coefficients are divided by it before they are rounded",
            number.text
        ));
    }
    if [&controller.b, &controller.a].iter().any(|list| list.entries.iter().any(|entry| entry.uncertainty.is_some())) {
        out.push(
            "the uncertainty of the controller is left out, as DSVerifier does: only that of the plant counts".into(),
        );
    }
    let lists = [controller, plant].map(|system| system.b.entries.len() == system.a.entries.len());
    if lists != [true; 2] {
        out.push(
            "a numerator and a denominator have lists of different lengths: the other reading is another loop".into(),
        );
    }
    if implementation.is_none() {
        out.push("there is no 'implementation': give the format, say with --format Q2.13 --round floor".into());
    }
    out
}

/// A remark as a sentence.
fn sentence(remark: &str) -> String {
    let mut letters = remark.chars();
    letters.next().map(|first| format!("{}{}.", first.to_uppercase(), letters.as_str())).unwrap_or_default()
}

/// A text as lines of a comment.
fn comment(text: &str) -> String {
    let mut lines = vec!["#".to_owned()];
    for word in visible(text).split(' ') {
        let line = lines.last_mut().expect("there is a line");
        if line.len() > 1 && line.len() + word.len() >= WIDTH {
            lines.push(format!("# {word}"));
        } else {
            line.push(' ');
            line.push_str(word);
        }
    }
    lines.join("\n") + "\n"
}
