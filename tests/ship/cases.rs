//! `jurist ship` on controllers whose answers are known by hand.

use crate::helpers::folder::Folder;
use crate::helpers::model::read;
use crate::helpers::number::number;
use crate::helpers::schema::fits;
use jurist::Ask;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{BinaryFormat, Rational, to_decimal, to_scientific};
use jurist_engine::model::Model;
use serde_json::Value;

/// A PI controller and a lag; `D(1) = 0.1 (b0 + b1)`.
const PI: &str = "time = 'discrete'\n[loop]\ninputs = ['r', 'd']\noutputs = ['y']\n\
    [[block]]\nname = 'controller'\ninput = 'r - y'\noutput = 'u'\ntransfer = '(0.5*z - 0.4999)/(z - 1)'\n\
    [[block]]\nname = 'plant'\ninput = 'u + d'\noutput = 'y'\ntransfer = '0.1/(z - 0.9)'\n";

fn ship(model: &str, options: &[&str]) -> (i32, Value) {
    let folder = Folder::new(&[("loop.toml", model)]);
    let run = folder.jurist(&[&["ship", "loop.toml", "--json"], options].concat());
    let document: Value = serde_json::from_str(&run.stdout).unwrap_or_else(|_| panic!("{options:?}: {}", run.stderr));
    fits(&document).unwrap_or_else(|why| panic!("{why}"));
    (run.status, document)
}

fn refused(model: &str, options: &[&str]) -> String {
    let folder = Folder::new(&[("loop.toml", model)]);
    let run = folder.jurist(&[&["ship", "loop.toml"], options].concat());
    assert_eq!(run.status, 2, "{options:?}: {}", run.stdout);
    run.stderr
}

#[test]
fn integral_action_is_lost_at_twelve_bits_and_not_at_thirteen() {
    let of = |bits: u32, mode: &str, stored: [&str; 2], verdict: &str| {
        let format = format!("Q2.{bits}");
        let (status, document) = ship(PI, &["--block", "controller", "--format", &format, "--round", mode]);
        let integers = [0, 1].map(|k| document["coefficients"]["b"]["integers"][k].as_str().unwrap().to_owned());
        assert_eq!(integers, stored, "{bits} {mode}");
        assert_eq!(document["rounded"]["verdict"], verdict, "{bits} {mode}");
        assert_eq!(status, i32::from(verdict != "stable"));
        let changes = document["changes"].as_array().unwrap();
        assert_eq!(
            changes.iter().any(|c| c.as_str().unwrap().contains("integral action is lost")),
            verdict != "stable"
        );
    };
    of(12, "nearest", ["2048", "-2048"], "marginal");
    of(13, "nearest", ["4096", "-4095"], "stable");
    of(13, "floor", ["4096", "-4096"], "marginal");
    of(14, "floor", ["8192", "-8191"], "stable");
    of(13, "ceil", ["4096", "-4095"], "stable");
    of(2, "zero", ["2", "-1"], "stable");
}

#[test]
fn the_fewest_bits_are_where_half_a_unit_is_less_than_half_of_the_sum() {
    // b0 + b1 = 1e-4 stays positive where both half units are below 5e-5: 2^-15 < 5e-5 < 2^-14.
    let (_, document) = ship(PI, &["--block", "controller", "--format", "Q2.13", "--fewest"]);
    let fewest = &document["fewest"];
    assert_eq!((&fewest["every_rounding"], &fewest["refuted"]), (&14.into(), &13.into()));
    // Below 14: 13 bits give -4095; at 0 bits -0.4999 becomes 0.
    assert_eq!(fewest["nearest"], serde_json::json!([0, 13]));
    assert_eq!(document["every_rounding"]["verdict"], "not stable");
    let (_, wider) = ship(PI, &["--block", "controller", "--format", "Q2.14"]);
    assert_eq!(wider["every_rounding"]["verdict"], "stable");
}

#[test]
fn the_rounding_of_the_output_moves_it_by_half_a_unit_times_the_l1_norm() {
    let section = "[ship]\nblock = 'controller'\nformat = { bits = 16, fraction = 13 }\nsignal = { bits = 24, fraction = 8 }\ninputs = { r = 2 }\n";
    let (status, document) = ship(&format!("{PI}{section}"), &[]);
    assert_eq!(status, 0);
    // z (z - 0.9)/D has the l1 norm 8192, and half a unit is 2^-9.
    assert_eq!((&document["ranges"][0]["node"], &document["ranges"][1]["node"]), (&"u".into(), &"y".into()));
    assert_eq!(document["ranges"][1]["rounding"], "16");
    assert_eq!(document["ranges"][1]["holds"], true);
    // A format that goes to 2 is too small for what |r| <= 2 does; one of 8 bits leaves the question open.
    let (status, document) = ship(&format!("{PI}{section}"), &["--signal", "Q1.20"]);
    assert_eq!((status, &document["ranges"][1]["holds"]), (1, &Value::Bool(false)));
    let (status, document) = ship(&format!("{PI}{section}"), &["--signal", "Q3.8"]);
    assert_eq!((status, &document["ranges"][1]["holds"]), (3, &Value::Null));
}

#[test]
fn requirements_are_those_of_the_stored_loop() {
    let required = format!("{PI}[require]\ngain_margin = '38.004'\nat = 'u'\n");
    let options = ["--block", "controller", "--format", "Q2.13"];
    let (status, document) = ship(&required, &options);
    assert_eq!((status, &document["requirements"][0]["met"]), (0, &Value::Bool(true)));
    let (status, document) = ship(&required, &["--block", "controller", "--format", "Q2.14", "--round", "floor"]);
    assert_eq!((status, &document["requirements"][0]["met"]), (1, &Value::Bool(false)));
    // A radius is a region: the pole near 1 is outside.
    let (status, document) = ship(PI, &[&options[..], &["--radius", "0.999"]].concat());
    assert_eq!((status, &document["rounded"]["verdict"]), (1, &"unstable".into()));
}

#[test]
fn both_checkers_read_the_models_that_are_written() {
    let folder = Folder::new(&[("loop.toml", PI)]);
    let arguments = [
        "ship",
        "loop.toml",
        "--block",
        "controller",
        "--format",
        "Q2.14",
        "--rounded",
        "r.toml",
        "--every",
        "e.toml",
        "--certificate",
        "r.json",
    ];
    let run = folder.jurist(&arguments);
    assert_eq!((run.status, run.stderr.as_str()), (0, "wrote r.toml, e.toml and r.json\n"));
    let verified = folder.jurist(&["verify", "r.toml", "r.json"]);
    assert_eq!(verified.status, 0, "{}", verified.stderr);
    let run = folder.jurist(&["tolerance", "e.toml", "--certificate", "e.json"]);
    assert_eq!(run.status, 0, "{}{}", run.stdout, run.stderr);
    assert_eq!(folder.jurist(&["verify", "e.toml", "e.json"]).status, 0);
    for (model, certificate) in [("r.toml", "r.json"), ("e.toml", "e.json")] {
        let [model, certificate] = [model, certificate].map(|name| folder.read(name));
        crate::helpers::certificates::checkers::accept(&model, &certificate);
    }
}

#[test]
fn what_cannot_be_is_refused_with_what_to_do() {
    let asked = |options: &[&str], code: &str, help: &str| {
        let said = refused(PI, options);
        assert!(said.contains(code) && said.contains(help), "{options:?}: {said}");
    };
    asked(&["--format", "Q2.13"], "E-ship-block", "the blocks are controller, plant");
    asked(&["--block", "controler", "--format", "Q2.13"], "E-ship-block", "did you mean 'controller'?");
    asked(&["--block", "controller"], "E-ship-format", "add --format Q2.13 or float32");
    asked(&["--block", "controller", "--format", "Q2"], "E-ship-format", "Q2.13 is a sign");
    asked(&["--block", "controller", "--format", "Q99.99"], "E-ship-format", "Q2.13 is a sign");
    let said = refused(&PI.replace("0.5*z", "5*z"), &["--block", "controller", "--format", "Q2.13"]);
    assert!(said.contains("E-ship-range") && said.contains("17 bits with 13 behind the point"), "{said}");
    asked(&["--block", "controller", "--format", "Q2.13", "--realisation", "df3"], "E-ship-format", "did you mean 'df");
    asked(&["--block", "controller", "--format", "Q2.13", "--round", "up"], "E-ship-format", "one of nearest");
    asked(&["--block", "controller", "--format", "float32", "--round", "floor"], "E-ship-format", "leave out --round");
    asked(&["--block", "controller", "--format", "Q2.13", "--input", "q=1"], "E-unknown-name", "");
    asked(&["--block", "controller", "--format", "Q2.13", "--input", "r=-1"], "E-value", "");
    let continuous = PI.replace("discrete", "continuous").replace('z', "s");
    let said = refused(&continuous, &["--block", "controller", "--format", "Q2.13"]);
    assert!(said.contains("E-ship-continuous") && said.contains("discretize"), "{said}");
    for (section, code) in [
        ("block = 'nobody'", "E-ship-block"),
        ("format = { bits = 16, integer = 2, fraction = 13 }", "E-ship-format"),
        ("format = { bits = 16 }", "E-ship-format"),
        ("format = { bits = 65, fraction = 1 }", "E-ship-format"),
        ("format = { bits = 2.5, fraction = 1 }", "E-ship-format"),
        ("format = 16", "E-type"),
        ("format = { bits = 16, fraction = 13, round = 'down' }", "E-ship-format"),
        ("format = { bits = 16, fraction = 13, scale = 'much' }", "E-ship-format"),
        ("delta = 0.3", "E-ship-format"),
        ("inputs = { q = 1 }", "E-unknown-name"),
        ("inputs = { r = -1 }", "E-value"),
        ("saturate = 'yes'", "E-type"),
        ("formats = 'float32'", "E-unknown-key"),
    ] {
        let has_format = section.starts_with("format ");
        let format = if has_format { "" } else { "format = 'Q2.13'\n" };
        let block = if section.starts_with("block") { "" } else { "block = 'controller'\n" };
        let said = refused(&format!("{PI}[ship]\n{block}{format}{section}\n"), &[]);
        assert!(said.contains(code), "{section}: {said}");
    }
}

#[test]
fn other_notations_of_blocks_and_sections_are_rewritten() {
    let inline = "time = 'discrete'\nloop.inputs = ['r']\nloop.outputs = ['y']\nparameters = { K = { nominal = 1, min = 0 } }\n\
        block = [{ name = 'controller', input = 'r - y', output = 'u', num = ['K/2', '-0.4999*K'], den = [1, -1] }, \
        { name = 'plant', input = 'u', output = 'y', transfer = '0.1/(z - 0.9)' }]\n\
        ship = { block = 'controller', format = 'Q2.14', signal = 'Q8.14', inputs = { r = 1 }, saturate = true }\n";
    let (status, document) = ship(inline, &[]);
    assert_eq!((status, &document["every_rounding"]["verdict"]), (0, &"stable".into()));
    let nested = "time = 'discrete'\nparameters.K.nominal = 1\n[loop]\ninputs = ['r'] # here\noutputs = ['y']\n\
        [[block]]\nname = 'controller'\ninput = 'r - y'\noutput = 'u'\ntransfer = '0.5 + 100/s'\n\
        [block.discretize]\nmethod = 'tustin'\nT = '1/1000000'\n\
        [[block]]\nname = 'plant'\ninput = 'K*u'\noutput = 'y'\ntransfer = '0.1/(z - 0.9)'\n";
    let (status, document) =
        ship(nested, &["--block", "controller", "--format", "Q2.20", "--signal", "Q8.14", "--input", "r=1"]);
    assert_eq!((status, &document["every_rounding"]["verdict"]), (0, &"stable".into()));
    assert_eq!(document["coefficients"]["b"]["exact"][0][0], "10001/20000");
}

/// Rounding the coefficients of the paper's own characteristic polynomial, which is affine in K_pwm: what twelve digits, floats and doubles make
/// of the limits.
#[test]
fn the_digits_of_the_papers_polynomial_move_its_limits() {
    let problem = Model::drive().ask().free("K_pwm").problem().unwrap();
    let polynomial = problem.algebra(&Budget::unlimited()).unwrap().polynomial().unwrap();
    let parts: Vec<[Rational; 2]> = polynomial
        .coefficients
        .iter()
        .map(|c| {
            let at = |k: i64| c.substitute(0, &k.into()).unwrap().as_constant().unwrap();
            let (zero, one) = (at(0), at(1));
            [zero.clone(), one - zero]
        })
        .collect();
    let limits = |rounded: &dyn Fn(&Rational) -> Rational| -> Vec<String> {
        let term = |(k, [a, b]): (usize, &[Rational; 2])| format!("(({}) + ({})*K_pwm)*z^{k}", rounded(a), rounded(b));
        let sum: Vec<String> = parts.iter().enumerate().map(term).collect();
        let text = format!(
            "time = 'discrete'\n[parameters]\nK_pwm = {{ nominal = 110, min = 0 }}\n[loop]\ncharacteristic = '{}'\n",
            sum.join(" + ")
        );
        let answer = read(&text).ask().free("K_pwm").stable_set(&Budget::unlimited()).unwrap();
        let ends = answer.value().intervals().iter().flat_map(|i| [&i.lower, &i.upper]);
        ends.map(|end| end.as_ref().unwrap().value.decimal(22)).collect()
    };
    let exact = limits(&|x| x.clone());
    assert_eq!(exact[0][..12], *"0.0381005333");
    let float = |format: BinaryFormat| move |x: &Rational| format.nearest(x).unwrap();
    assert_eq!(limits(&float(BinaryFormat::Single)), [""; 0], "no K_pwm is stable");
    assert_eq!(limits(&float(BinaryFormat::Double)), ["0.03826276953448258142787", "550.9411666866746036192"]);
    // Significant decimals, 10 to 16: twelve give the published limit, none gives the exact one. The table stands in docs/how-to/ship.md.
    let decimal = |digits: usize| move |x: &Rational| number(&to_scientific(x, digits));
    let lower: Vec<String> =
        (10..=16).map(|digits| limits(&decimal(digits)).first().cloned().unwrap_or_default()).collect();
    let shown: Vec<String> = lower.iter().map(|text| to_decimal(&number(text), 6)).collect();
    let expected = ["173.160", "0.930950", "2.98532", "0.223982", "0.0224007", "0.00149341", "0.000112006"];
    assert_eq!(shown, expected);
}

#[test]
#[ignore = "long: CI runs it"]
fn the_drives_controllers_are_shipped_in_all_formats() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/shipped");
    let mut seen = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let (status, document) = ship(&std::fs::read_to_string(&path).unwrap(), &[]);
        assert_eq!((status, &document["rounded"]["verdict"]), (0, &"stable".into()), "{}", path.display());
        assert_eq!(document["every_rounding"]["verdict"], "stable", "{}", path.display());
        let stored = document["coefficients"]["b"].clone();
        seen.push((path.file_name().unwrap().to_string_lossy().into_owned(), stored));
    }
    seen.sort_by(|a, b| a.0.cmp(&b.0));
    let names: Vec<&str> = seen.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["current-float32.toml", "current-q15.toml", "speed-float64.toml", "speed-q15.toml"]);
    // 10.025 * 2^15 / 2^4 = 20531.2 and 1.00025 * 2^15 / 2 = 16388.096.
    assert_eq!(
        [&seen[1].1["integers"], &seen[3].1["integers"]],
        [&serde_json::json!([null, "20531", "-20429"]), &serde_json::json!([null, "16388", "-16380"])]
    );
}

/// Zeros that are not rational have a product that is: the section's numbers are those of the direct form, to the last bit.
#[test]
fn a_section_with_irrational_zeros_has_its_rational_coefficients() {
    let model = "time = 'discrete'\n[parameters]\nK = { nominal = 1, min = 0 }\n[loop]\ninputs = ['r']\noutputs = ['y']\n\
        [[block]]\nname = 'c'\ninput = 'r - y'\noutput = 'v'\ntransfer = '(z^2 + 2.5*z + 0.5)/z^2'\n\
        [[block]]\nname = 'p'\ninput = 'K*v'\noutput = 'y'\ntransfer = '0.1/(z - 0.5)'\n";
    let of = |realisation: &str| {
        let options = ["--block", "c", "--format", "Q4.3", "--realisation", realisation, "--param", "K", "--fewest"];
        let (_, document) = ship(model, &options);
        (document["limits"]["rows"].clone(), document["fewest"]["nearest"].clone(), document["fewest"]["floor"].clone())
    };
    assert_eq!(of("sos"), of("df1"));
    // With no bit behind the point 2.5 and 0.5 are stored as 3 and 1: stable up to 20/7.
    let (_, document) = ship(model, &["--block", "c", "--format", "Q4.0", "--realisation", "sos", "--param", "K"]);
    let row = document["limits"]["rows"].as_array().unwrap().iter().find(|row| row["fraction"] == 0).unwrap();
    assert_eq!(row["stable"][0]["upper"]["exact"], "20/7");
}

/// The code takes its input in the format of signals: what does not fit there is no answer.
#[test]
fn the_range_of_the_input_counts() {
    let model = "time = 'discrete'\n[loop]\ninputs = ['r']\noutputs = ['y']\n\
        [[block]]\nname = 'c'\ninput = 'r - y'\noutput = 'v'\ntransfer = '0.01*z/(z - 0.5)'\n\
        [[block]]\nname = 'p'\ninput = 'v'\noutput = 'y'\ntransfer = '0.1/(z - 0.9)'\n\
        [ship]\nblock = 'c'\nformat = 'Q5.10'\nsignal = 'Q7.8'\ninputs = { r = 1000 }\n";
    let (status, document) = ship(model, &[]);
    assert_eq!(
        (status, &document["ranges"][0]["holds"], &document["ranges"][1]["holds"]),
        (1, &false.into(), &true.into())
    );
}

/// A controller of gain 10 and a plant 0.1/(z - 1.5), whose only rounding is that of the input: its code cycles at |x| = 0.00243.
#[test]
fn a_limit_cycle_by_the_rounding_of_the_input_is_bounded() {
    let model = "time = 'discrete'\n[loop]\ninputs = ['r']\noutputs = ['x']\n\
        [[block]]\nname = 'c'\ninput = 'r - x'\noutput = 'v'\ngain = 10\n\
        [[block]]\nname = 'p'\ninput = 'v'\noutput = 'x'\ntransfer = '0.1/(z - 1.5)'\n\
        [ship]\nblock = 'c'\nformat = 'Q7.8'\nsignal = 'Q7.8'\n";
    let (_, document) = ship(model, &[]);
    let found = &document["limit_cycle"]["x"];
    let bound = |key: &str| found[key].as_str().unwrap().parse::<Rational>().unwrap();
    assert!(bound("bound") < number("0.00243") && bound("with_inputs") > number("0.00243"), "{found}");
}

#[test]
fn a_parameter_keeps_the_domain_that_it_is_given() {
    let section = "[parameters]\nK = 1\n";
    let model = format!("{}{section}", PI.replace("'0.1/(z - 0.9)'", "'0.1*K/(z - 0.9)'"));
    let (_, document) =
        ship(&model, &["--block", "controller", "--format", "Q2.14", "--param", "K", "--domain", "K=0..1"]);
    for row in document["limits"]["rows"].as_array().unwrap() {
        for range in row["stable"].as_array().unwrap() {
            assert!(number(range["upper"]["decimal"].as_str().unwrap()) <= Rational::ONE, "{row}");
        }
    }
    assert_eq!(document["limits"]["exact"]["stable"][0]["upper"]["exact"], "1");
    let refusal =
        refused(&model.replace("0.5*z", "K*z"), &["--block", "controller", "--format", "Q2.14", "--param", "K"]);
    assert!(refusal.contains("E-ship-block"), "{refusal}");
}

#[test]
fn the_fewest_bits_do_not_depend_on_the_format_that_is_asked_for() {
    let fewest = |bits: u32| {
        let (_, document) = ship(PI, &["--block", "controller", "--format", &format!("Q2.{bits}"), "--fewest"]);
        (document["fewest"]["every_rounding"].clone(), document["fewest"]["refuted"].clone())
    };
    for bits in [6, 10, 14, 20, 30] {
        assert_eq!(fewest(bits), (14.into(), 13.into()), "{bits}");
    }
}

#[test]
fn a_stored_loop_that_is_not_well_posed_is_no_mistake_of_the_text() {
    let model = "time = 'discrete'\n[loop]\ninputs = ['r']\noutputs = ['y']\n\
        [[block]]\nname = 'c'\ninput = 'r - y'\noutput = 'u'\ngain = -0.4999\n\
        [[block]]\nname = 'p'\ninput = 'u'\noutput = 'y'\ngain = 2\n";
    let said = refused(model, &["--block", "c", "--format", "Q4.11"]);
    assert!(said.contains("with the stored coefficients the loop is not well posed") && !said.contains("^"), "{said}");
}

#[test]
fn initial_values_of_states_are_left_out_where_the_controller_gets_other_states() {
    let model = PI
        .replace("transfer = '(0.5*z - 0.4999)/(z - 1)'", "A = [[0.5]]\nB = [[0.2]]\n")
        .replace("output = 'u'", "output = ['u']");
    for initial in ["[simulation]\ninitial = { u = 1 }\n", "[simulation.initial]\nu = 1\n"] {
        let (status, document) = ship(&format!("{model}{initial}"), &["--block", "controller", "--format", "Q2.13"]);
        assert_eq!((status, &document["rounded"]["verdict"]), (0, &"stable".into()), "{document}");
    }
}
