//! Files as they are written, and files that nobody writes.

use super::{Reading, read};
use jurist_engine::error::Source;
use jurist_engine::model::Model;

const LOOP: &str = "#include <dsverifier.h>
/* .b = { 7 } */
extern digital_system plant;
digital_system ds = {
    .b = { 0.5f, -.25, 1.e-3, 9 }, // cut
    .b_size = 3,
    .a = { +1.0, -4.0E-01f },
    .a_size = 3,
    .sample_time = 1.000000e-02,
};
implementation impl = { .int_bits = 3, .frac_bits = 13, .max = 1.0, .min = -3.0, .scale = 4, .delta = 0.25 };
digital_system plant = {
    .b = { 0, 0.10 }, .b_size = 2, .b_uncertainty = { 1, 0.5 },
    .a = { 1, -0.9 }, .a_size = 2, .a_uncertainty = { 0, 5 }
};
int main() { return ds.a_size == 3; }
";

fn model(text: &str, reading: Reading) -> String {
    let found = read(&Source::new("loop.c", text), reading).unwrap_or_else(|error| panic!("{error}"));
    Model::from_toml(&Source::new("model.toml", found.model.as_str())).unwrap_or_else(|e| panic!("{e}{}", found.model));
    found.model
}

/// The text at an error, and its message.
fn refused(text: &str) -> (String, String) {
    let errors = read(&Source::new("loop.c", text), Reading::Z).unwrap_err();
    let error = errors.diagnostics().first().unwrap();
    let span = error.primary.as_ref().map(|label| label.span).unwrap_or_default();
    (text[span.start..span.end].to_owned(), error.message.clone())
}

#[test]
fn a_loop_is_read_as_the_source_reads_it() {
    let found = model(LOOP, Reading::Z);
    for line in [
        "sample_time = 1.000000e-2",
        "num = [0.5, -0.25, 1e-3]\nden = [1.0, -4.0e-1, 0]",
        // The zero has no uncertainty, and is no power of z.
        "num = [\"plant_b1\"]\nden = [1, \"plant_a1\"]",
        "plant_b1 = { value = 0.10, tolerance = \"0.5%\" }",
        "plant_a1 = { value = -0.9, tolerance = \"5%\" }",
        "format = { bits = 16, fraction = 13, round = \"floor\" }",
        "inputs = { r = \"3/4\" }",
        "delta = \"1/4\"",
    ] {
        assert!(found.contains(line), "{line}\n{found}");
    }
}

#[test]
fn lists_are_aligned_at_the_end_or_at_the_beginning() {
    let text = LOOP.replace(".b = { 0, 0.10 }, .b_size = 2", ".b = { 0.1 }, .b_size = 1");
    assert!(model(&text, Reading::Z).contains("num = [\"plant_b0\"]\nden = [1, \"plant_a1\"]"));
    assert!(model(&text, Reading::InverseZ).contains("num = [\"plant_b0\", 0]\nden = [1, \"plant_a1\"]"));
}

#[test]
fn mistakes_have_their_places() {
    let with = |from: &str, to: &str| {
        assert!(LOOP.contains(from));
        refused(&LOOP.replace(from, to))
    };
    assert_eq!(with("-.25", "GAIN").0, "GAIN");
    assert_eq!(with("-.25", "1/4").0, "1/4");
    assert_eq!(with("-.25", "0x1p3").0, "0x1p3");
    assert_eq!(with("-.25", "010").1, "'010' is an octal number in C");
    assert_eq!(with("-.25", "").1, "there is no number between two commas");
    assert_eq!(with(".a_size = 3", ".a_size = -1").0, "-1");
    assert_eq!(with(".a_size = 3", ".a_size = 1.5").0, "1.5");
    assert_eq!(with(".a_size = 3", "3").0, "3");
    assert_eq!(with(".a_size = 3", ".b_size = 3").0, ".b_size");
    assert_eq!(with(".int_bits = 3", ".int_bits = 64").1, "a number has 1 to 64 bits, not 77");
    assert_eq!(with("plant = {", "other = {").1, "there is no 'digital_system plant = { ... }' in the file");
    assert_eq!(with("{ +1.0, -4.0E-01f }", "{ 0 }").1, "the denominator of 'ds' is zero");
    assert_eq!(with("{ 0.5f, -.25, 1.e-3, 9 }", "{}").1, "the controller is zero: it controls nothing");
    assert_eq!(with("return ds.a_size == 3", "ds.a[0] = 3").0, "ds.a");
    assert_eq!(with("int main", "digital_system plant = {}; int main").1, "there are several definitions of 'plant'");
    assert_eq!(with("extern", "digital_system ds = { extern").1, "this brace is not closed");
    let improper = with(".b = { 0, 0.10 }, .b_size = 2", ".b = { 1, 2, 3 }, .b_size = 3");
    assert_eq!(improper.0, "{ 1, 2, 3 }");
}

#[test]
fn no_text_makes_it_panic() {
    // Deleted, doubled, exchanged and foreign characters at every place, by a generator with a fixed seed.
    let letters: Vec<char> = LOOP.chars().collect();
    let mut state = 1_u64;
    let mut below = |n: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % n
    };
    let foreign = ['{', '}', '.', ',', '=', '"', '\'', '/', '*', '#', '\\', '\n', '-', 'e', '9', 'ß', '\u{feff}', '\0'];
    for _ in 0..3_000 {
        let mut text = letters.clone();
        for _ in 0..1 + below(4) {
            let at = below(text.len());
            match below(4) {
                0 => text.truncate(at + 1),
                1 => drop(text.remove(at)),
                2 => text.insert(at, foreign[below(foreign.len())]),
                _ => text[at] = foreign[below(foreign.len())],
            }
            if text.is_empty() {
                break;
            }
        }
        let text: String = text.into_iter().collect();
        for reading in Reading::ALL {
            let source = Source::new("loop.c", text.as_str());
            match read(&source, reading) {
                // What is read is a model.
                Ok(found) => drop(
                    Model::from_toml(&Source::new("m", found.model.as_str())).unwrap_or_else(|e| panic!("{e}{text}")),
                ),
                Err(errors) => drop(errors.to_string()),
            }
        }
    }
}
