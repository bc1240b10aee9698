//! One mistake is one error, the most helpful one; what makes no sense is refused where it stands.

use jurist_engine::error::{Diagnostic, Source};
use jurist_engine::model::Model;
use jurist_show::diagnostics::render_error;

/// Every error: code, line and column of the caret, line of the second place, help.
fn errors(text: &str) -> Vec<String> {
    let source = Source::new("model.toml", text);
    let Err(error) = Model::from_toml(&source) else { return Vec::new() };
    assert!(render_error(&error, false).contains("error["));
    let line = |d: &Diagnostic| {
        let place = d.primary.as_ref().map(|l| source.line_column(l.span.start));
        let second = d.secondary.first().map(|l| source.line_column(l.span.start).0);
        let place = place.map_or(String::new(), |(line, column)| format!("@{line}:{column}"));
        let second = second.map_or(String::new(), |line| format!("+{line}"));
        format!("{}{place}{second} {}", d.code, d.help.clone().unwrap_or_default())
    };
    error.diagnostics().iter().map(line).collect()
}

const BLOCK: &str = "[[block]]\nname = 'plant'\ninput = 'r - K*y'\noutput = 'y'\ntransfer = '1/(z - 1/2)'\n";
const HEAD: &str = "time = 'discrete'\nparameters.K = { nominal = 1 }\nconstants.k = 2\n";

fn blocks(text: &str) -> Vec<String> {
    errors(&format!("{HEAD}[loop]\ninputs = ['r']\noutputs = ['y']\n{text}"))
}

#[test]
fn a_signal_with_the_name_of_a_constant_is_one_error() {
    let found = blocks(&BLOCK.replace("output = 'y'", "output = 'k'"));
    assert_eq!(found, ["E-duplicate-name@10:11+3 rename one of them"]);
    // The same for a parameter, and for an external input.
    let found = blocks(&BLOCK.replace("output = 'y'", "output = 'K'"));
    assert_eq!(found, ["E-duplicate-name@10:11+2 rename one of them"]);
}

#[test]
fn known_names_are_listed_once() {
    let text = format!("{HEAD}[loop]\ninputs = ['r', 'k']\noutputs = ['y']\n{}", BLOCK.replace("K*y", "1000*Quark*y"));
    for help in errors(&text) {
        assert!(help.matches("'k'").count() <= 1, "{help}");
    }
}

#[test]
fn a_refused_definition_is_not_an_unknown_name_as_well() {
    for bad in ["'1 +'", "'1/0'", "true", "inf", "'2 2'"] {
        let text =
            format!("time = 'discrete'\n[constants]\na = {bad}\nb = '2*a'\n[loop]\ncharacteristic = 'z - a*b'\n");
        let found = errors(&text);
        assert!(found.len() == 1 && !found[0].starts_with("E-unknown-name"), "{bad}: {found:?}");
    }
}

#[test]
fn a_misspelt_key_is_not_missing_as_well() {
    let found = blocks(&BLOCK.replace("input =", "inpt ="));
    assert_eq!(found, ["E-unknown-key@9:1 did you mean 'input'?"]);
    let found = blocks(&BLOCK.replace("output =", "ouput ="));
    assert_eq!(found, ["E-unknown-key@10:1 did you mean 'output'?"]);
    let found = blocks(&BLOCK.replace("transfer =", "tranfer ="));
    assert_eq!(found, ["E-unknown-key@11:1 did you mean 'transfer'?"]);
    let found = errors(&format!("{HEAD}[loop]\ninputs = ['r']\noutputs = ['y']\n{}", BLOCK.replace("block", "blok")));
    assert_eq!(found, ["E-unknown-key@7:3 did you mean 'block'?"]);
    let found = errors("tim = 'discrete'\nparameters.K = 1\nloop.characteristic = 'z - K'\n");
    assert_eq!(found, ["E-unknown-key@1:1 did you mean 'time'?"]);
    let found = errors("time = 'discrete'\nparameters.K = 1\nlop.characteristic = 'z - K'\n");
    assert_eq!(found, ["E-unknown-key@3:1 did you mean 'loop'?"]);
    let found = errors("time = 'discrete'\nparameter.K = 1\nloop.characteristic = 'z - K'\n");
    assert_eq!(found, ["E-unknown-key@2:1 did you mean 'parameters'?"]);
    let found = errors(&format!("{HEAD}[loop]\ninput = ['r']\noutputs = ['y']\n{BLOCK}"));
    assert_eq!(found, ["E-unknown-key@5:1 did you mean 'inputs'?"]);
    let feedback = "time = 'discrete'\nparameters.k = 1\n[loop]\nA = [[0]]\nB = [[1]]\nC = [[1]]\nk = [['k']]\n";
    assert_eq!(errors(feedback), ["E-unknown-key@7:1 did you mean 'K'?"]);
    let found = blocks(&BLOCK.replace("transfer = '1/(z - 1/2)'", "num = [1]\nde = [1, 0]"));
    assert_eq!(found.len(), 1, "{found:?}");
    let found = blocks(&format!("{BLOCK}discretize = {{ metod = 'forward', T = 1 }}\n").replace("(z", "(s"));
    assert_eq!(found, ["E-unknown-key@12:16 did you mean 'method'?"]);
}

#[test]
fn one_slip_is_one_error() {
    // A quote too few, an equals sign too many.
    assert_eq!(blocks(&BLOCK.replace("'y'", "'y")).len(), 1);
    assert_eq!(errors("time == 'discrete'\nloop.characteristic = 'z'\n").len(), 1);
    // An empty block, an empty expression, an empty name.
    assert!(blocks(&format!("[[block]]\n{BLOCK}"))[0].starts_with("E-missing@7:3"));
    assert_eq!(blocks(&format!("[[block]]\n{BLOCK}")).len(), 1);
    assert_eq!(blocks(&BLOCK.replace("'r - K*y'", "''")).len(), 1);
    assert_eq!(blocks(&BLOCK.replace("output = 'y'", "output = ''")).len(), 1);
    // What stands in no section is not unknown as well.
    let found = errors("time = 'discrete'\nK = 1\nloop.characteristic = 'z - K'\n");
    assert!(found.len() == 1 && found[0].starts_with("E-unknown-key@2:1"), "{found:?}");
    // One of two blocks is misspelt: its signal is not unknown as well.
    let second = BLOCK.replace("plant", "sensor").replace("'y'", "'x'").replace("block", "bloc");
    let found = blocks(&format!("{}{second}", BLOCK.replace("K*y", "x")));
    assert!(found.len() == 1 && found[0].starts_with("E-unknown-key"), "{found:?}");
    // A row too few.
    let text = "time = 'discrete'\n[loop]\nA = [[1, 0]]\nB = [[1], [1]]\nC = [[1, 0]]\nK = [[1]]\n\
                states = ['x', 'v']\ninputs = ['u']\nE = [[1], [0]]\n";
    let found = errors(text);
    assert!(found.len() == 1 && found[0].starts_with("E-size@3:5"), "{found:?}");
}

#[test]
fn a_loop_without_states_is_refused() {
    let head = "time = 'discrete'\n[loop]\n";
    assert!(errors(&format!("{head}matrix = []\n"))[0].starts_with("E-size@3:10"));
    assert!(errors(&format!("{head}matrix = [[]]\n"))[0].starts_with("E-size@3:10"));
    assert!(errors(&format!("{head}A = []\nB = []\nC = []\nK = []\n"))[0].starts_with("E-size@3:5"));
}

#[test]
fn a_sample_time_is_positive() {
    let model = |t: &str| {
        format!("time = 'discrete'\nsample_time = {t}\nconstants.h = -2\nloop.characteristic = 'z - 1/(3+h)'\n")
    };
    for wrong in ["-1", "0", "'h'", "'2 + h'", "'1/h - 1'"] {
        let found = errors(&model(wrong));
        assert!(found.len() == 1 && found[0].starts_with("E-value@2:1"), "{wrong}: {found:?}");
    }
    assert!(errors(&model("'1/(h + 2)'"))[0].starts_with("E-division-by-zero@2:1"));
    assert_eq!(errors(&model("'-h'")), [""; 0]);
    // What depends on a parameter is judged where the question is asked.
    assert_eq!(errors(&model("'-T'").replace("constants", "parameters.T = -1\nconstants")), [""; 0]);
}

#[test]
fn a_sample_time_in_continuous_time_is_remarked_upon() {
    let text = "time = 'continuous'\nsample_time = 1\nparameters.K = 1\nloop.characteristic = 's + K'\n";
    let (_, warnings) = Model::from_toml(&Source::new("model.toml", text)).unwrap();
    assert_eq!(warnings.iter().map(|w| w.code.as_str()).collect::<Vec<_>>(), ["W-unused"]);
}

#[test]
fn names_are_given_once() {
    let again = BLOCK.replace("'y'", "'x'");
    assert!(blocks(&format!("{BLOCK}{again}"))[0].starts_with("E-duplicate-name@13:8+8"));
    // Blocks without names are as many as one likes.
    let unnamed = format!("{BLOCK}{again}").replace("name = 'plant'\n", "");
    assert_eq!(blocks(&unnamed), [""; 0]);
    let diagram =
        |inputs: &str, outputs: &str| errors(&format!("{HEAD}[loop]\ninputs = {inputs}\noutputs = {outputs}\n{BLOCK}"));
    assert!(diagram("['r', 'r']", "['y']")[0].starts_with("E-duplicate-name@5:17+5"));
    assert!(diagram("['r']", "['y', '2*y', 'y']")[0].starts_with("E-duplicate-name@6:25+6"));
    let matrix =
        |ports: &str| errors(&format!("time = 'discrete'\n[loop]\nmatrix = [['1/2']]\nstates = ['x']\n{ports}"));
    assert!(matrix("outputs = ['x', 'x']\n")[0].starts_with("E-duplicate-name@5:18+5"));
    assert!(matrix("inputs = ['u', 'u']\nE = [[1, 1]]\n")[0].starts_with("E-duplicate-name@5:17+5"));
}

#[test]
fn an_exponent_with_a_name_says_what_to_do() {
    let text = "time = 'discrete'\nconstants.n = 2\nparameters.K = 1\nloop.characteristic = 'z^3 - K^n'\n";
    let found = errors(text);
    assert_eq!(found.len(), 1);
    assert!(found[0].starts_with("E-exponent@4:32") && found[0].contains("write its value"), "{found:?}");
}

#[test]
fn blocks_without_a_loop_are_told_what_to_add() {
    let found = errors(&format!("{HEAD}{BLOCK}"));
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(found[0].starts_with("E-missing@4:3 add [loop]"), "{found:?}");
    assert!(found[0].contains("inputs = [\"r\"], outputs = [\"y\"]"), "{found:?}");
}
