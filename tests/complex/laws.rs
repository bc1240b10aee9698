//! Laws of loops with complex coefficients, and what is refused of them.

use super::table::{machine, turned};
use crate::helpers::model::read;
use crate::helpers::program::jurist_with_input;
use jurist::Ask;
use jurist_algebra::limits::Budget;
use jurist_engine::error::{Code, Source};
use jurist_engine::model::Model;

/// What the program prints, without the errors.
fn printed(arguments: &[&str], text: &str) -> String {
    let run = jurist_with_input(arguments, text.as_bytes());
    assert_eq!(run.status, 0, "{}\n{text}", run.stderr);
    run.stdout
}

fn limits(text: &str, name: &str) -> Vec<String> {
    let set = read(text).ask().free(name).stable_set(&Budget::unlimited()).unwrap().into_value();
    set.intervals().iter().flat_map(|i| [&i.lower, &i.upper]).flatten().map(|e| e.value.decimal(25)).collect()
}

/// A frame that does not turn is none: the answers are the same, byte for byte.
#[test]
fn a_frame_at_rest_is_no_frame() {
    let still = machine("").replace("frame = 'omega_e'", "frame = 0").replace("omega_e = {", "w = {");
    let plain = still.replace("frame = 0, ", "");
    for arguments in
        [&["verdict", "-"][..], &["intervals", "-", "--param", "K_p", "--json"], &["roots", "-"], &["simulate", "-"]]
    {
        assert_eq!(printed(arguments, &still), printed(arguments, &plain), "{arguments:?}");
    }
}

/// Where no imaginary unit is left the loop is the real one.
#[test]
fn a_unit_that_cancels_leaves_a_real_loop() {
    let real = "time = 'discrete'\n[parameters]\nK = 0.5\n[loop]\ncharacteristic = 'z^2 - z + K'\n";
    for complex in [
        "z^2 - z - j^2*K",
        "z^2 - z + K*re(exp(j*0)) + im(3)",
        "(z - 1/2 + j*z)*(z - 1/2 - j*z) - z^2 - 1/4 + K",
        "z^2 - z + j*K*conj(j)",
    ] {
        let text = real.replace("z^2 - z + K", complex);
        for arguments in
            [&["verdict", "-"][..], &["intervals", "-", "--param", "K", "--json"], &["jury", "-"], &["charpoly", "-"]]
        {
            assert_eq!(printed(arguments, &text), printed(arguments, real), "{complex} {arguments:?}");
        }
    }
    // Two turns that cancel around the loop: the states are complex, the polynomial is not.
    let turned = "time = 'discrete'\n[parameters]\nK = 0.5\n[loop]\ninputs = ['r']\noutputs = ['y']\n[[block]]\ninput = 'r - y'\noutput = 'u'\n\
                  gain = 'K*j'\n[[block]]\ninput = '-j*u'\noutput = 'y'\ntransfer = '1/(z*(z - 1))'\n";
    let plain = turned.replace("K*j", "K").replace("-j*u", "u");
    let intervals = ["intervals", "-", "--param", "K", "--json"];
    assert_eq!(printed(&intervals, turned), printed(&intervals, &plain));
    assert_eq!(printed(&["verdict", "-"], turned), printed(&["verdict", "-"], &plain));
    assert_eq!(printed(&["roots", "-"], turned), printed(&["roots", "-"], &plain));
}

/// `D(z exp(j phi))` has the same set.
#[test]
fn a_turned_variable() {
    let of = |z: &str| {
        let characteristic = format!("{z}^2 - {z} + K*(3 + 4*j)/5");
        format!("time = 'discrete'\n[parameters]\nK = 0.3\n[loop]\ncharacteristic = '{characteristic}'\n")
    };
    let own = limits(&of("z"), "K");
    assert_eq!(own.len(), 2);
    for turned in ["(z*(5 + 12*j)/13)", "(-j*z)", "(z*exp(j*pi/5))"] {
        assert_eq!(limits(&of(turned), "K"), own, "{turned}");
    }
}

/// The same machine in real form, as `examples/pmsm-stationary.toml` has it.
#[test]
fn a_machine_in_real_form() {
    let example = crate::helpers::model::example_text("pmsm-stationary");
    assert_eq!(limits(&example, "omega_e"), limits(&machine(", advance = 'omega_e*T'"), "omega_e"));
}

/// A plant of second order behind a hold, a rule, and none: the block with complex coefficients is that of two real signals.
#[test]
fn blocks_in_real_form() {
    let complex = |block: &str| {
        format!(
            "time = 'discrete'\nsample_time = 0.1\n[parameters]\nK = {{ nominal = 0.5, min = 0, max = 30 }}\n[loop]\ninputs = ['r']\n\
             outputs = ['y']\n[[block]]\ninput = 'r - y'\noutput = 'u'\ngain = 'K*(0.8 + 0.6*j)'\n[[block]]\ninput = 'u'\noutput = 'y'\n{block}\n"
        )
    };
    let real = |block: &str| {
        format!(
            "time = 'discrete'\nsample_time = 0.1\n[parameters]\nK = {{ nominal = 0.5, min = 0, max = 30 }}\n[loop]\ninputs = ['a', 'b']\n\
             outputs = ['x', 'y']\n[[block]]\ninput = ['a - x', 'b - y']\noutput = ['u', 'v']\nD = [['0.8*K', '-0.6*K'], ['0.6*K', '0.8*K']]\n\
             [[block]]\ninput = ['u', 'v']\noutput = ['x', 'y']\n{block}\n"
        )
    };
    // (A + jB) as [[A, -B], [B, A]]
    for (one, two) in [
        (
            "A = [['-1 + 2*j']]\nB = [[1]]\ndiscretize = 'zoh'",
            "A = [[-1, -2], [2, -1]]\nB = [[1, 0], [0, 1]]\ndiscretize = 'zoh'",
        ),
        (
            "transfer = '1/(s + 1 - 2*j)'\ndiscretize = 'tustin'",
            "A = [[-1, -2], [2, -1]]\nB = [[1, 0], [0, 1]]\ndiscretize = 'tustin'",
        ),
        (
            "transfer = '1/(s + 1)'\ndiscretize = { method = 'zoh', delay = 0.04 }",
            "A = [[-1, 0], [0, -1]]\nB = [[1, 0], [0, 1]]\ndiscretize = { method = 'zoh', delay = 0.04 }",
        ),
        (
            "transfer = '(2 - j)/(z*(z - 0.5*j))'",
            "A = [[0, -0.5, 1, 0], [0.5, 0, 0, 1], [0, 0, 0, 0], [0, 0, 0, 0]]\nB = [[0, 0], [0, 0], [2, 1], [-1, 2]]\nC = [[1, 0, 0, 0], [0, 1, 0, 0]]",
        ),
        (
            "transfer = '1/(s + 1)'\ndiscretize = { method = 'pwm', edge = 'trailing', duty = 0.3 }",
            "A = [[-1, 0], [0, -1]]\nB = [[1, 0], [0, 1]]\ndiscretize = { method = 'pwm', edge = 'trailing', duty = 0.3 }",
        ),
    ] {
        let found = limits(&complex(one), "K");
        assert!(!found.is_empty(), "{one}");
        assert_eq!(found, limits(&real(two), "K"), "{one}");
    }
}

#[test]
fn what_has_to_be_real() {
    let of = |head: &str, rest: &str| format!("time = 'discrete'\n{head}\n[parameters]\nK = 0.1\n{rest}\n");
    let polynomial = "[loop]\ncharacteristic = 'z - K'";
    let block = |discretize: &str| {
        format!(
            "[loop]\ninputs = ['r']\n[[block]]\ninput = 'K*r - y'\noutput = 'y'\ntransfer = '1/(s + 1)'\ndiscretize = {discretize}"
        )
    };
    for (text, code) in [
        (of("sample_time = '1 + j'", polynomial), Code::Complex),
        (of("constants.c = 'sin(j)'", "[loop]\ncharacteristic = 'z - K*c'"), Code::Complex),
        (of("sample_time = 1", &block("{ method = 'zoh', delay = 'j' }")), Code::Complex),
        (of("sample_time = 1", &block("{ method = 'zoh', frame = 'j' }")), Code::Complex),
        (of("sample_time = 1", &block("{ method = 'pwm', edge = 'trailing', duty = '0.5*j' }")), Code::Complex),
        (of("sample_time = 1", &block("{ method = 'zoh', advance = 1 }")), Code::Frame),
        (of("sample_time = 1", &block("{ method = 'foh', frame = 1 }")), Code::Discretize),
        (of("", "[loop]\ncharacteristic = 'z - conj(z)'"), Code::Function),
        (of("constants.c = '1/(1 + j^2)'", "[loop]\ncharacteristic = 'z - K*c'"), Code::DivisionByZero),
        (of("parameters.a.nominal = '1 + j'", "[loop]\ncharacteristic = 'z - K*a'"), Code::Complex),
    ] {
        let text = text.replace("[parameters]\nK = 0.1", "parameters.K = 0.1");
        let error =
            Model::from_toml(&Source::new("model.toml", text.clone())).err().unwrap_or_else(|| panic!("{text}"));
        let codes: Vec<Code> = error.diagnostics().iter().map(|d| d.code).collect();
        assert!(codes.contains(&code), "{text}\n{error}");
    }
}

/// One mistake is told once: a complex sample time, which every block that is made discrete uses, and a frame whose name is mistyped.
#[test]
fn one_mistake_is_one_error() {
    let block = |n: usize, discretize: &str| {
        format!(
            "[[block]]\ninput = '{}y{n}'\noutput = 'y{}'\ntransfer = '1/(s + 1)'\ndiscretize = {discretize}\n",
            if n == 0 { "-" } else { "" },
            1 - n
        )
    };
    for (time, discretize, code) in
        [("'1 + j'", "'zoh'", Code::Complex), ("1", "{ method = 'zoh', fraem = 1, advance = 1 }", Code::UnknownKey)]
    {
        let blocks = block(0, discretize) + &block(1, if time == "1" { "'zoh'" } else { discretize });
        let text = format!("time = 'discrete'\nsample_time = {time}\n[loop]\n{blocks}");
        let error = Model::from_toml(&Source::new("model.toml", text)).map(|_| ()).unwrap_err();
        let codes: Vec<Code> = error.diagnostics().iter().map(|d| d.code).collect();
        assert_eq!(codes, [code], "{error}");
    }
}

/// Two roots reach the circle at once, `exp(+-j pi/3)` turned: the one of lower frequency is named, also where the turn is no rational number.
#[test]
fn several_roots_at_one_value() {
    for (turn, angle) in
        [("exp(j*pi/5)", "0.4188790"), ("exp(j*0.3)", "0.7471976"), ("exp(-j*0.3)", "-0.7471976"), ("j", "-0.5235988")]
    {
        let text = format!(
            "time = 'discrete'\n[parameters]\nK = 0.3\n[loop]\ncharacteristic = '(z*{turn})^2 - z*{turn} + K'\n"
        );
        let text = printed(&["intervals", "-", "--param", "K"], &text);
        assert!(text.contains(&format!("complex root at {angle} rad")), "{turn}\n{text}");
    }
}

/// The step of an input may be complex: `[simulation]` names its parts as the command line does.
#[test]
fn inputs_of_a_simulation_have_parts() {
    let model = machine("");
    let table = |arguments: &[&str], inputs: &str| {
        printed(
            &[&["simulate", "-", "--duration", "0.005"], arguments].concat(),
            &format!("{model}[simulation]\n{inputs}\n"),
        )
    };
    let asked = table(&["--input", "i_ref=1", "--input", "i_ref.im=2"], "");
    for inputs in [
        "inputs = { i_ref = { re = 1, im = 2 } }",
        "inputs = { 'i_ref.re' = 1, 'i_ref.im' = 2 }",
        "inputs.i_ref.re = 1\ninputs.i_ref.im = 2",
    ] {
        assert_eq!(table(&[], inputs), asked, "{inputs}");
    }
    assert_eq!(table(&[], "inputs.i_ref = 1"), table(&[], "inputs.i_ref.re = 1"));
    assert_ne!(table(&[], "inputs.i_ref.im = 1"), table(&[], "inputs.i_ref.re = 1"));
    for (inputs, place) in [("inputs.i_ref.imag = 1", "i_ref.imag"), ("inputs.u.im = 1", "u.im")] {
        let error = Model::from_toml(&Source::new("model.toml", format!("{model}[simulation]\n{inputs}\n")));
        let error = error.map(|_| ()).unwrap_err();
        assert!(error.to_string().contains(place) && error.code() == Code::UnknownName, "{error}");
    }
}

/// A coefficient of the document has a real and an imaginary part in each term.
#[test]
fn coefficients_in_the_document() {
    let text = "time = 'discrete'\n[parameters]\nK = 0.3\nL = 1\n[loop]\ncharacteristic = 'z^2 - j*z/(1 + L) + K*(3 + 4*j)/5 + L/(2 + j)'\n";
    let document = printed(&["charpoly", "-", "--json"], text);
    let document: serde_json::Value = serde_json::from_str(&document).unwrap();
    assert_eq!(document["parameters"], serde_json::json!(["K", "L"]));
    let expected = serde_json::json!([
        { "numerator": [[[1, 0], ["3/5", "4/5"]], [[0, 1], ["2/5", "-1/5"]]], "denominator": [[[0, 0], "1"]] },
        { "numerator": [[[0, 0], ["0", "-1"]]], "denominator": [[[0, 1], "1"], [[0, 0], "1"]] },
        { "numerator": [[[0, 0], ["1", "0"]]], "denominator": [[[0, 0], "1"]] },
    ]);
    assert_eq!(document["coefficients"], expected);
    assert!(document.get("imaginary").is_none());
}

/// A model's own name comes first.
#[test]
fn a_name_of_the_model() {
    let text = "time = 'discrete'\n[parameters]\nj = 0.5\n[loop]\ncharacteristic = 'z - j'\n";
    let (model, warnings) = Model::from_toml(&Source::new("model.toml", text)).unwrap();
    assert_eq!(warnings.iter().map(|w| w.code).collect::<Vec<_>>(), [Code::OwnMeaningWarning]);
    let verdict = model.ask().verdict(&Budget::unlimited()).unwrap().into_value();
    assert_eq!((verdict.degree, verdict.count.unwrap().inside), (1, 1));
}

/// What is not known of complex loops is refused by one sentence.
#[test]
fn what_is_refused() {
    let text = turned("pi/6");
    for arguments in [
        &["norm", "-", "r", "y", "--l1"][..],
        &["locus", "-", "--param", "K"],
        &["intervals", "-", "--param", "K", "--delay-margin", "1/100"],
        &["intervals", "-", "--param", "K", "--sensitivity"],
        &["charpoly", "-", "--transfer", "r", "y"],
        &["charpoly", "-", "--root-locus-form", "K"],
        &["tune", "-", "--free", "K"],
        &["export", "-", "--to", "matlab"],
        &["simulate", "-", "--switched"],
    ] {
        let run = jurist_with_input(arguments, text.as_bytes());
        assert!(run.status != 0 && run.stderr.contains("E-complex"), "{arguments:?}\n{}{}", run.stdout, run.stderr);
    }
}
