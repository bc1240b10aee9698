//! Loops of DSVerifier against a second way: its files written from a table of their numbers, read, asked, and compared with the recursion of Schur
//! and Cohn in fractions on `a_c a_p + b_c b_p`; and files that are no files.
//!
//! The table `dsverifier/loops.txt` has the numbers of every closed loop of <https://github.com/ssvlab/dsverifier> (Apache License 2.0) at commit 1daca47,
//! as `tests/outside/dsverifier.py` found them there.

use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Rational, parse_number};
use jurist_engine::answer::Verdict;
use jurist_engine::error::{Code, Diagnostics, Source};
use jurist_engine::model::{Model, source_from_bytes};
use jurist_ship::dsverifier::{DsFile, Reading, Writing};
use jurist_ship::format::Rounding;
use proptest::prelude::*;

struct Row {
    name: &'static str,
    integer: u32,
    fraction: u32,
    /// Controller b, a, plant b, a, as they are written.
    lists: [Vec<&'static str>; 4],
    expected: &'static str,
}

fn rows() -> Vec<Row> {
    let lines = include_str!("dsverifier/loops.txt").lines().filter(|line| !line.starts_with('#'));
    lines
        .map(|line| {
            let parts: Vec<&'static str> = line.split(" | ").collect();
            let list = |k: usize| parts[k].split(' ').collect();
            let (integer, fraction) = parts[1].split_once(' ').expect("two numbers");
            Row {
                name: parts[0],
                integer: integer.parse().unwrap(),
                fraction: fraction.parse().unwrap(),
                lists: [list(2), list(3), list(4), list(5)],
                expected: parts[6],
            }
        })
        .collect()
}

impl Row {
    /// A file with these numbers, each odd one with the suffix of single precision.
    fn file(&self) -> String {
        let list = |name: &str, numbers: &[&str]| {
            let suffix =
                |(k, n): (usize, &&str)| if k % 2 == 1 && n.contains('.') { format!("{n}f") } else { (*n).to_owned() };
            let numbers: Vec<String> = numbers.iter().enumerate().map(suffix).collect();
            format!(".{name} = {{ {} }}, .{name}_size = {}", numbers.join(", "), numbers.len())
        };
        let [bc, ac, bp, ap] = &self.lists;
        format!(
            "#include <dsverifier.h>\ndigital_system controller = {{ {}, {}, }};\nimplementation impl = {{ .int_bits = {}, .frac_bits = {} }};\n\
             digital_system plant = {{ {}, {} }};\n",
            list("b", bc),
            list("a", ac),
            self.integer,
            self.fraction,
            list("b", bp),
            list("a", ap)
        )
    }

    /// The verdict by hand: `None` where there is no such loop.
    fn by_hand(&self, reading: Reading, is_stored: bool) -> Option<bool> {
        let mut lists =
            self.lists.clone().map(|list| list.iter().map(|n| parse_number(n).unwrap()).collect::<Vec<_>>());
        if is_stored {
            let unit = Rational::from(2).pow(self.fraction.into()).unwrap();
            let limit = Rational::from(2).pow(i64::from(self.integer) - 1).unwrap();
            let leading = lists[1].iter().position(|n| !n.is_zero())?;
            for number in lists[..2].iter_mut().flatten() {
                let greatest = &limit - &Rational::ONE.checked_div(&unit).unwrap();
                if *number < -&limit || *number > greatest {
                    return None;
                }
                *number = Rational::from((&*number * &unit).floor()).checked_div(&unit).unwrap();
            }
            if lists[1][leading].is_zero() {
                return None;
            }
        }
        characteristic(&lists, reading).map(is_schur)
    }
}

fn product(a: &[Rational], b: &[Rational]) -> Vec<Rational> {
    let mut out = vec![Rational::ZERO; a.len() + b.len() - 1];
    for (i, x) in a.iter().enumerate() {
        for (j, y) in b.iter().enumerate() {
            out[i + j] = &out[i + j] + &(x * y);
        }
    }
    out
}

/// `a_c a_p + b_c b_p`, the highest power of z first; `None` where a list would need values that are still to come.
fn characteristic([bc, ac, bp, ap]: &[Vec<Rational>; 4], reading: Reading) -> Option<Vec<Rational>> {
    let degree = |p: &[Rational]| p.len() - p.iter().take_while(|c| c.is_zero()).count();
    let is_proper = |b: &[Rational], a: &[Rational]| match reading {
        Reading::Z => degree(a) > 0 && degree(b) <= degree(a),
        Reading::Delays => !a[0].is_zero(),
    };
    (is_proper(bc, ac) && is_proper(bp, ap)).then_some(())?;
    let mut sides = [product(ac, ap), product(bc, bp)];
    let longest = sides[0].len().max(sides[1].len());
    for side in &mut sides {
        let zeros = vec![Rational::ZERO; longest - side.len()];
        *side = match reading {
            Reading::Z => [zeros, side.clone()].concat(),
            Reading::Delays => [side.clone(), zeros].concat(),
        };
    }
    Some(sides[0].iter().zip(&sides[1]).map(|(x, y)| x + y).collect())
}

/// Whether all roots lie inside the unit circle.
fn is_schur(p: Vec<Rational>) -> bool {
    let mut p: Vec<Rational> = p.into_iter().skip_while(Rational::is_zero).collect();
    while p.len() > 1 {
        let last = p.len() - 1;
        if p[last].abs() >= p[0].abs() {
            return false;
        }
        let ratio = p[last].checked_div(&p[0]).unwrap();
        p = (0..last).map(|i| &p[i] - &(&ratio * &p[last - i])).collect();
    }
    !p.is_empty()
}

fn read(name: &str, text: &str) -> Result<DsFile, Diagnostics> {
    DsFile::read(&Source::new(name, text), &[])
}

#[test]
fn every_loop_has_its_verdict_as_printed_and_as_stored_under_both_readings() {
    let (mut compared, mut without, mut zero) = (0, 0, 0);
    for row in rows() {
        let printed = read(row.name, &row.file());
        let is_zero = row.lists[..2].iter().any(|list| list.iter().all(|n| parse_number(n).unwrap().is_zero()));
        assert_eq!(printed.is_err(), is_zero, "{}", row.name);
        let Ok(printed) = printed else {
            zero += 1;
            continue;
        };
        let stored = printed.stored(Rounding::Floor).ok();
        for reading in Reading::ALL {
            for (file, is_stored) in [(Some(&printed), false), (stored.as_ref(), true)] {
                let writing = Writing { reading, ..Writing::default() };
                let found = file.and_then(|file| file.verdict(&writing, &Budget::unlimited()).ok());
                let found = found.map(|verdict| verdict.verdict == Verdict::Stable);
                assert_eq!(found, row.by_hand(reading, is_stored), "{} {reading:?} {is_stored}", row.name);
                compared += usize::from(found.is_some());
                without += usize::from(found.is_none());
            }
        }
    }
    assert_eq!((compared, without, zero), COMPARED);
}

/// Verdicts that were compared; loops that there are not, because a coefficient does not fit, or is stored as 0 where it divides, or a numerator is too
/// long; and files whose controller is zero, which are refused.
const COMPARED: (usize, usize, usize) = (956, 40, 47);

/// What DSVerifier expects of its own loops is compared with exact arithmetic: four of its regression tests are wrong.
#[test]
fn expectations_that_are_false() {
    let mut false_ones = Vec::new();
    for row in rows().into_iter().filter(|row| ["successful", "failed"].contains(&row.expected)) {
        let holds = row.by_hand(Reading::Z, true) == Some(true);
        if holds != (row.expected == "successful") {
            false_ones.push(row.name);
        }
    }
    let regression: Vec<&str> = false_ones.iter().filter_map(|name| name.strip_prefix("regression/cbmc/")).collect();
    let expected =
        ["helicopter", "pendulum", "satelliteB2", "spgMsDamper"].map(|name| format!("synthesized-closed-loop/{name}"));
    assert_eq!(regression, expected);
    assert_eq!(false_ones.len() - regression.len(), 19, "{false_ones:?}");
}

const LOOP: &str =
    "digital_system controller = { .b = { 0.15 }, .b_size = 1, .a = { 1.0f }, .a_size = 1, .sample_time = 0.01 };
implementation impl = { .int_bits = 3, .frac_bits = 13, .max = 4.0, .min = -5.0, .scale = 2, .delta = 0.25 };
digital_system plant = { .b = { 2.0, -4.0 }, .b_size = 2, .a = { 1.0, -.1, -3.e-1L }, .a_size = 3,
    .b_uncertainty = { 5 }, .a_uncertainty = { 0, 1.5, -2 } };
";

#[test]
fn a_loop_is_written_with_its_tolerances_and_its_format() {
    let model = read("loop.c", LOOP).unwrap().model("loop.c", &Writing::default()).unwrap();
    let body = model.split_once("\ntitle").unwrap().1;
    let expected = r#" = "loop.c"
time = "discrete"
sample_time = 0.01

[constants]
plant_b0 = { value = 2.0, tolerance = "5%" }
plant_a1 = { value = -0.1, tolerance = "1.5%" }

[loop]
inputs = ["r"]
outputs = ["y"]

[[block]]
name = "controller"
input = "r - y"
output = "u"
num = [0.15]
den = [1.0]

[[block]]
name = "plant"
input = "u"
output = "y"
num = ["plant_b0", -4.0]
den = [1.0, "plant_a1", -3.0e-1]

[ship]
block = "controller"
realisation = "df1"
format = { bits = 16, fraction = 13, round = "floor" }
signal = { bits = 16, fraction = 13, round = "nearest" }
inputs = { r = "5/2" }
delta = 0.25
"#;
    assert_eq!(body, expected);
}

#[test]
fn readings_that_differ_are_remarked_upon_and_others_are_not() {
    let budget = Budget::unlimited();
    let warning = read("loop.c", LOOP).unwrap().reading_warning(&Writing::default(), &budget).unwrap().unwrap();
    assert_eq!(warning.code, Code::DsvReadingWarning);
    assert!(warning.message.contains("as powers of z^-1 the loop is stable, read as falling powers of z it is not"));
    // As many coefficients above as below.
    let even = LOOP.replace(".b = { 2.0, -4.0 }, .b_size = 2", ".b = { 0, 2.0, -4.0 }, .b_size = 3");
    assert_eq!(read("loop.c", &even).unwrap().reading_warning(&Writing::default(), &budget).unwrap(), None);
    // Sizes are lengths: zeros at the end.
    let longer = LOOP.replace(".b_size = 2", ".b_size = 3");
    assert_eq!(read("loop.c", &longer).unwrap().reading_warning(&Writing::default(), &budget).unwrap(), None);
    assert!(
        read("loop.c", &longer)
            .unwrap()
            .model("", &Writing::default())
            .unwrap()
            .contains("num = [\"plant_b0\", -4.0, 0]")
    );
}

#[test]
fn a_leading_coefficient_that_is_not_one_is_stored_too() {
    // pendulum, regression/cbmc/synthesized-closed-loop of DSVerifier.
    let text = LOOP.replace(".a = { 1.0f }, .a_size = 1", ".a = { 0.88965, -0.875, 0 }, .a_size = 3");
    let file = read("loop.c", &text).unwrap();
    let stored = file.stored(Rounding::Floor).unwrap();
    let model = stored.model("loop.c", &Writing::default()).unwrap();
    assert!(model.contains("den = [\"911/1024\", \"-7/8\", 0]") && !model.contains("[ship]"), "{model}");
    let note = file.storing_note(&Writing::default(), &Budget::unlimited()).unwrap().unwrap();
    assert!(note.contains("0.88965") && note.contains("as 911/1024 and divides by it"), "{note}");
}

fn refused(text: &str) -> (Code, String, String) {
    let error = match read("loop.c", text) {
        Err(error) => error,
        Ok(file) => file.model("loop.c", &Writing::default()).and_then(|_| file.stored(Rounding::Floor)).unwrap_err(),
    };
    let first = &error.diagnostics()[0];
    let place = first.primary.as_ref().map(|label| text[label.span.start..label.span.end].to_owned());
    (first.code, first.message.clone(), place.unwrap_or_default())
}

#[test]
fn what_is_refused_points_into_the_file() {
    let cases = [
        ("{ 0.15 }", "{ 1.0/3 }", "an expression where a number is expected", "/"),
        ("{ 0.15 }", "{ GAIN }", "'GAIN' where a number is expected", "GAIN"),
        ("{ 0.15 }", "{ 0x1p-3 }", "a hexadecimal or binary number", "0x1p-3"),
        ("{ 0.15 }", "{ 017 }", "C reads a number that begins with 0 in base 8", "017"),
        ("{ 0.15 }", "{ 1e2000 }", "an exponent beyond 1000", "1e2000"),
        ("{ 0.15 }", "{ 0.0, 3 }", "the numerator of 'controller' is zero", "{ 0.0, 3 }"),
        ("{ 0.15 }", "{ 7.15 }", "b[0] = 7.15 is not between -4 and 32767/8192", "7.15"),
        ("{ 1.0f }", "{ 1e-9 }", "a[0] = 1e-9 is stored as 0", "1e-9"),
        ("{ 1.0f }", "{ }", "the denominator of 'controller' is zero", "{ }"),
        (".b_size = 1", ".b_size = 51", "'b_size' is no whole number from 1 to 50", "51"),
        (".b_size = 1", ".b_sise = 1", "unknown field 'b_sise'", "b_sise"),
        (".b_size = 1, ", "", "'controller' has no .b_size, so C takes it for empty", "controller"),
        (
            ".b = { 2.0, -4.0 }, .b_size = 2",
            ".b = { 1, 2, 3, 4 }, .b_size = 4",
            "'plant' would need values of its input that are still to come",
            "{ 1, 2, 3, 4 }",
        ),
        ("digital_system plant", "int plant", "there is no 'digital_system plant = { .. }'", "controller"),
        ("digital_system plant", "digital_system controller", "'controller' is given twice", "controller"),
        (".int_bits = 3", ".int_bits = 0", "'int_bits' is no whole number from 1 to 64", "0"),
        ("};\nimplementation", "} /* ", "a comment does not end", "/*"),
    ];
    for (from, to, message, place) in cases {
        let text = LOOP.replacen(from, to, 1);
        assert_ne!(text, LOOP, "{from}");
        let found = refused(&text);
        assert_eq!((found.1.as_str(), found.2.as_str()), (message, place));
        let range = message.contains("not between");
        assert_eq!(found.0, if range { Code::ShipRange } else { Code::Import });
    }
}

#[test]
fn conditions_choose_what_the_command_line_defines() {
    let text = format!(
        "#define COUNT 2\n#if (DS_ID == 1) // one\n{LOOP}#elif DS_ID == 2\n{}#else\n#error none\n#endif\n#ifndef COUNT\n#if 1\nint x;\n#endif\n}}}}{{\n#endif\n",
        LOOP.replace("0.15", "0.25")
    );
    let read = |defines: &[(String, i64)]| DsFile::read(&Source::new("loop.c", text.as_str()), defines);
    let gain = |id: i64| read(&[("DS_ID".into(), id)]).unwrap().controller.numerator.numbers[0].text.clone();
    assert_eq!((gain(1), gain(2)), ("0.15".into(), "0.25".into()));
    let error = read(&[]).unwrap_err();
    assert_eq!(
        error.diagnostics()[0].help.as_deref(),
        Some("parts of the file stand behind conditions: add -D DS_ID=1")
    );
    let text = "#if A > B\n#endif\n";
    assert_eq!(refused(text).1, "this condition is not read");
}

#[test]
fn a_system_alone_is_a_model_without_feedback() {
    let text = LOOP
        .split("digital_system plant")
        .next()
        .unwrap()
        .replace("controller", "ds")
        .replace("1.0f }, .a_size = 1", "1.0f, -2 }, .a_size = 2");
    let file = read("alone.c", &text).unwrap();
    let verdict = file.verdict(&Writing::default(), &Budget::unlimited()).unwrap();
    assert_eq!((verdict.verdict, verdict.count.unwrap().outside), (Verdict::Unstable, 1));
}

/// Whatever the bytes are: no panic, and a file that is read gives models that are read.
fn is_read_or_refused(bytes: &[u8]) {
    let Ok(source) = source_from_bytes("mutated.c", bytes) else { return };
    let Ok(file) = DsFile::read(&source, &[("DS_ID".into(), 1)]) else { return };
    for reading in Reading::ALL {
        for rounding in Rounding::ALL {
            let writing = Writing { reading, rounding, ..Writing::default() };
            for file in [Ok(file.clone()), file.stored(rounding)].into_iter().flatten() {
                if let Ok(text) = file.model("mutated.c", &writing)
                    && let Err(error) = Model::from_toml(&Source::new("model", text.as_str()))
                {
                    panic!("{error}\n{text}\n{}", source.text);
                }
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn mutated_files_are_read_or_refused(
        edits in proptest::collection::vec((any::<prop::sample::Index>(), 0usize..60, 0usize..30), 1..8),
        condition in any::<bool>(),
    ) {
        const PIECES: [&str; 30] = [
            "{", "}", ",", ".", "=", ";", "-", "(", ")", "(double)", "1e9", "0", "1e-400", "\"", "'", "/*", "*/", "//", "#if DS_ID == 1\n", "#endif\n",
            "#else\n", "digital_system plant = {", "digital_system ds = {", ".a_size = 50", ".b = {", "\\\n", "\u{e9}", "9999999999999999999", "\0", "e",
        ];
        let text = if condition { format!("#if DS_ID == 1\n{LOOP}\n#endif\n") } else { LOOP.to_owned() };
        let mut bytes = text.into_bytes();
        for (place, removed, piece) in edits {
            let at = place.index(bytes.len() + 1);
            let removed = (removed / 10).min(bytes.len() - at);
            bytes.splice(at..at + removed, PIECES[piece].bytes());
        }
        is_read_or_refused(&bytes);
    }

    #[test]
    fn any_bytes_are_read_or_refused(bytes in proptest::collection::vec(any::<u8>(), 0..200)) {
        is_read_or_refused(&bytes);
        is_read_or_refused(&[b"digital_system ds = {".as_slice(), &bytes].concat());
    }
}
