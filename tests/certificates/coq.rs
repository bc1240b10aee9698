//! The files for Coq: their text, the names in them, and what is refused. Whether Coq takes them is asked by `.ci/proofs`.

use crate::helpers::model::{example_text, read};
use jurist_algebra::limits::Budget;
use jurist_engine::error::Error;
use jurist_engine::model::Model;

fn file(model: &Model, parameter: &str) -> Result<String, Error> {
    let budget = Budget::unlimited();
    model.ask().free(parameter).stable_set(&budget).unwrap().coq(&budget)
}

fn refusal(model: &str, parameter: &str) -> String {
    file(&read(model), parameter).unwrap_err().to_string()
}

#[test]
fn the_drives_amplitude_has_the_statement_of_the_committed_file() {
    let text = file(&Model::drive(), "K_pwm").unwrap();
    let statement =
        |text: &str| text.split_once("  exists lower_limit").unwrap().1.split_once("Print").unwrap().0.to_owned();
    assert_eq!(statement(&text), statement(include_str!("../../proofs/drive/Amplitude.v")));
}

#[test]
fn several_intervals_and_rational_ends_are_stated_in_order() {
    let model = "time = \"discrete\"\n[parameters]\nK = { min = -3 }\n[loop]\ncharacteristic = \"z - 1 + K^2*(K - 1)*(K + 1)/10\"\n";
    let text = file(&read(model), "K").unwrap();
    // K^4 - K^2 lies between 0 and 20 from -sqrt 5 to -1 and from 1 to sqrt 5.
    assert!(
        text.contains("exists limit_1 : R, only_root limit_1_factor (-2.2360679775) (-2.23606797749) limit_1"),
        "{text}"
    );
    assert!(text.contains("<-> limit_1 < K < qr R (-1) \\/ qr R 1 < K < limit_4."), "{text}");
}

#[test]
fn a_value_between_two_stable_intervals_is_touched() {
    let model = "time = \"continuous\"\n[parameters]\nK = {}\n[loop]\ncharacteristic = \"s + (K^2 - 2)^2\"\n";
    let text = file(&read(model), "K").unwrap();
    assert!(text.contains("Touch limit_1_factor (-1.41421356237)"), "{text}");
    assert!(text.contains("<-> K < limit_1 \\/ limit_1 < K < limit_2 \\/ limit_2 < K."), "{text}");
}

#[test]
fn names_that_coq_keeps_for_itself_are_changed() {
    let model = "title = \"a *) b\"\ntime = \"discrete\"\n[constants]\nA = 2\nfun = \"A/4\"\n[parameters]\nforall = { min = 0 }\n\
                 [loop]\nmatrix = [[\"fun\", \"-forall\"], [1, 0]]\n";
    let text = file(&read(model), "forall").unwrap();
    assert!(
        text.contains("Definition A_ : expr := 2.\nDefinition fun_ : expr := A_/4.\nDefinition forall_ : expr := Par.")
    );
    assert!(text.contains("  [fun_; -forall_];\n  [1; 0]]"), "{text}");
    assert!(text.contains("forall forall_ : R, 0 < forall_ ->"), "{text}");
    assert!(text.starts_with("(** a * ) b: "), "{text}");
}

#[test]
fn block_diagrams_say_what_the_statement_is_about() {
    let text = file(&read(&example_text("digital-pll")), "K_i").unwrap();
    assert!(text.contains("that they belong to the diagram is not part of the theorem"), "{text}");
    assert!(text.contains("poly_of Model.coefficients K_i"), "{text}");
}

#[test]
fn what_has_no_file_is_refused_with_a_remedy() {
    let gap = "time = \"discrete\"\n[parameters]\nK = {}\n[loop]\ncharacteristic = \"z - 1/(2*K)\"\n";
    let said = refusal(gap, "K");
    assert!(said.contains("E-coq") && said.contains("undefined at K = 0"), "{said}");
    let large = "time = \"discrete\"\n[parameters]\nK = {}\n[loop]\ncharacteristic = \"z^13 + K/2\"\n";
    let said = refusal(large, "K");
    assert!(said.contains("the order is 13"), "{said}");
    let said = file(&Model::drive(), "radius").unwrap_err().to_string();
    assert!(said.contains("'radius' is the question"), "{said}");
}
