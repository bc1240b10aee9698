//! The files for Coq: their text, the names in them, and what is refused. Whether Coq takes them is asked by `.ci/proofs`.

use crate::helpers::model::{example_text, read};
use jurist::Ask;
use jurist::Theorem;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_engine::error::Error;
use jurist_engine::model::Model;

fn file(model: &Model, parameter: &str) -> Result<String, Error> {
    let budget = Budget::unlimited();
    model.ask().free(parameter).stable_set(&budget).unwrap().coq(&budget)
}

fn refusal(model: &str, parameter: &str) -> String {
    file(&read(model), parameter).unwrap_err().to_string()
}

fn point_file(model: &Model, set: &[(&str, Rational)]) -> Result<String, Error> {
    let budget = Budget::unlimited();
    let question = set.iter().fold(model.ask(), |question, (name, value)| question.set(*name, value.clone()));
    question.verdict(&budget).unwrap().coq(&budget)
}

#[test]
fn the_committed_files_of_the_drive_are_what_the_program_writes() {
    let drive = Model::drive();
    assert_eq!(file(&drive, "K_pwm").unwrap(), include_str!("../../proofs/drive/Amplitude.v"));
    assert_eq!(file(&drive, "T").unwrap(), include_str!("../../proofs/drive/Period.v"));
}

#[test]
fn the_limits_of_the_drive_are_roots_of_their_own_polynomials() {
    let degree = |text: &str, name: &str| {
        let list = text.split_once(&format!("{name}_factor : poly := [")).unwrap().1.split_once(']').unwrap().0;
        list.matches(';').count()
    };
    let text = file(&Model::drive(), "K_pwm").unwrap();
    assert_eq!((degree(&text, "lower_limit"), degree(&text, "upper_limit")), (4, 4));
    assert_eq!(degree(&file(&Model::drive(), "T").unwrap(), "upper_limit"), 13);
}

#[test]
fn a_typing_error_states_the_other_model() {
    let text = example_text("drive");
    let other = read(&text.replace("K_ii = 500 ", "K_ii = 501 "));
    let (text, other) = (file(&read(&text), "K_pwm").unwrap(), file(&other, "K_pwm").unwrap());
    assert!(text.contains("Definition K_ii : expr := 500.") && other.contains("Definition K_ii : expr := 501."));
    let limits = |text: &str| text.split_once("Definition limits").unwrap().1.split_once("Lemma").unwrap().0.to_owned();
    assert_ne!(limits(&text), limits(&other));
}

#[test]
fn one_point_is_stated_by_the_entries_and_the_values() {
    let stable = point_file(&Model::drive(), &[]).unwrap();
    assert!(stable.contains("Definition K_pwm : expr := 110.\nDefinition T : expr := 0.0001."), "{stable}");
    let closed = "(feedback 6 2 4 Model.A Model.B Model.K Model.C)";
    assert!(stable.contains(&format!("check_matrix_point (Disc 1) 6 {closed} true = true")), "{stable}");
    assert!(stable.contains("Theorem stable (R : rcfType) :\n  forall z : R[i],\n      eigenvalue"), "{stable}");
    assert!(stable.contains(" z -> `|z| < 1.\nProof. exact: (feedback_stable R checked). Qed."), "{stable}");
    let unstable = point_file(&Model::drive(), &[("K_pwm", Rational::from(551))]).unwrap();
    assert!(unstable.contains("Theorem not_stable (R : rcfType) :\n  exists z : R[i],\n"), "{unstable}");
    assert!(unstable.contains(" z /\\ 1 <= `|z|.\nProof. exact: (feedback_not_stable R checked). Qed."), "{unstable}");
}

#[test]
fn a_point_on_the_boundary_is_not_stable() {
    let model =
        "time = \"continuous\"\n[parameters]\nK = { nominal = 0 }\n[loop]\ncharacteristic = \"s^2 + K*s + 1\"\n";
    let text = point_file(&read(model), &[]).unwrap();
    assert!(text.contains("check_coefs_point (Left 0) Model.coefficients false = true"), "{text}");
    assert!(text.contains("p`_2 = 0 \\/ exists z : R[i], root (map_poly (real_complex R) p) z /\\ 0 <= complex.Re z."));
}

#[test]
fn a_point_where_the_degree_is_lost_is_stated_with_the_degree_of_the_model() {
    let model =
        "time = \"discrete\"\n[parameters]\nK = { nominal = 0 }\n[loop]\ncharacteristic = \"K*z^2 + z + 1/2\"\n";
    let text = point_file(&read(model), &[]).unwrap();
    assert!(text.contains("list expr := [\n  0.5;\n  1;\n  0].\nEnd"), "{text}");
    assert!(text.contains("p`_2 = 0 \\/ exists z"), "{text}");
}

#[test]
fn a_point_where_the_model_is_undefined_has_no_file() {
    let model = "time = \"discrete\"\n[parameters]\nK = { nominal = 0 }\n[loop]\ncharacteristic = \"z - 1/K\"\n";
    let said = point_file(&read(model), &[]).unwrap_err().to_string();
    assert!(said.contains("E-coq") && said.contains("undefined at the point"), "{said}");
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
fn keywords_of_coq_are_no_names_of_constants() {
    let words =
        ["Axiom", "CoFixpoint", "Definition", "Fixpoint", "Hypothesis", "Parameter", "Theorem", "Variable", "lib"];
    let constants: String = words.iter().map(|word| format!("{word} = 1\n")).collect();
    let model = format!(
        "time = \"discrete\"\n[constants]\n{constants}[parameters]\nK = {{}}\n[loop]\nmatrix = [[\"K*{}\"]]\n",
        words.join("*")
    );
    let text = file(&read(&model), "K").unwrap();
    for word in words {
        assert!(text.contains(&format!("Definition {word}_ : expr := 1.")), "{text}");
    }
}

#[test]
fn functions_in_entries_are_refused_where_they_have_rational_values_too() {
    for entry in ["sqrt(4)/8", "exp(0)/8", "c/8", "0*pi"] {
        let model = format!(
            "time = \"discrete\"\n[constants]\nc = \"sqrt(9)\"\n[parameters]\nK = {{ nominal = 0 }}\n[loop]\n\
             matrix = [[\"K\", \"{entry}\"], [1, 0]]\n"
        );
        let said = refusal(&model, "K");
        let what = if entry.contains("pi") { "an entry contains pi" } else { "an entry contains a function" };
        assert!(said.contains("E-coq") && said.contains(what), "{entry}: {said}");
        assert!(point_file(&read(&model), &[]).unwrap_err().to_string().contains(what), "{entry}");
    }
    // A name of the model is no function, and a polynomial is stated by its coefficients.
    let model = "time = \"discrete\"\n[constants]\npi = 3\n[parameters]\nK = {}\n[loop]\nmatrix = [[\"K/pi\"]]\n";
    assert!(file(&read(model), "K").unwrap().contains("Definition pi : expr := 3."));
    let model = "time = \"discrete\"\n[parameters]\nK = {}\n[loop]\ncharacteristic = \"z - sqrt(4)*K\"\n";
    assert!(file(&read(model), "K").unwrap().contains("-2*K;\n  1]."));
}

#[test]
fn loops_with_exponentials_are_refused_with_the_reason() {
    for (example, parameter, why) in [
        ("dead-time-pi", "K_c", "it contains z1 = exp(-3*s)"),
        ("chatter", "k_c", "the loop is not rational"),
        ("dc-servo", "K", "the loop is not rational"),
        ("drive-hold", "K_pwm", "the loop is not rational"),
    ] {
        let said = refusal(&example_text(example), parameter);
        assert!(said.contains("E-coq") && said.contains(why), "{example}: {said}");
    }
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
    let Err(Error::Refused(why)) = file(&read(gap), "K") else { panic!("a file of a gap") };
    let help = why.diagnostics()[0].help.as_deref().unwrap_or_default();
    assert!(help.contains("--domain K=LOWER..UPPER"), "{help}");
    let large = "time = \"discrete\"\n[parameters]\nK = {}\n[loop]\ncharacteristic = \"z^13 + K/2\"\n";
    let said = refusal(large, "K");
    assert!(said.contains("the order is 13"), "{said}");
    let said = file(&Model::drive(), "radius").unwrap_err().to_string();
    assert!(said.contains("'radius' is the question"), "{said}");
}
