//! What is zero for all values of the parameters, and what is zero at some values only.

use jurist_algebra::limits::Budget;
use jurist_engine::answer::Verdict;
use jurist_engine::error::Source;
use jurist_engine::model::Model;
use jurist_engine::problem::Ask;

fn model(loop_text: &str) -> Model {
    let text = format!(
        "time = 'discrete'\n[parameters]\nK = {{ nominal = 0.1 }}\na = {{ nominal = 0.3 }}\n[constants]\nb = 1.7\n{loop_text}"
    );
    Model::from_toml(&Source::new("model.toml", text)).unwrap().0
}

/// Zero whatever `a` is, as in the help of `sin` and `cos`, of numbers, and of roots of roots.
const ZEROS: [&str; 12] = [
    "cos(pi/3) - 1/2",
    "sin(a)^2 + cos(a)^2 - 1",
    "sin(b)^2 + cos(b)^2 - 1",
    "sqrt(2)^2 - 2",
    "tan(pi/4) - 1",
    "sqrt(3 + 2*sqrt(2)) - 1 - sqrt(2)",
    "sin(2*a) - 2*sin(a)*cos(a)",
    "cos(a + b) - cos(a)*cos(b) + sin(a)*sin(b)",
    "exp(a)*exp(-a) - 1",
    "exp(2*b) - exp(b)^2",
    "a*(sqrt(8) - 2*sqrt(2))",
    "tan(pi*a)*cos(pi*a) - sin(pi*a)",
];

#[test]
fn what_is_zero_for_all_values_does_not_count_for_the_degree() {
    let budget = Budget::unlimited();
    for zero in ZEROS {
        let form = format!("[loop]\ncharacteristic = '({zero})*z^3 + K*({zero})*z^2 + z - K'\n");
        let model = model(&form);
        let verdict = model.ask().verdict(&budget).unwrap().into_value();
        assert_eq!((verdict.verdict, verdict.degree, verdict.infinite), (Verdict::Stable, 1, 0), "{zero}");
        let set = model.ask().free("K").stable_set(&budget).unwrap().into_value();
        let ends = |i: &jurist_engine::stability::StableInterval| {
            [&i.lower, &i.upper].map(|end| end.as_ref().unwrap().value.exact().unwrap())
        };
        assert_eq!(set.intervals().iter().map(ends).collect::<Vec<_>>(), [[(-1).into(), 1.into()]], "{zero}");
    }
}

#[test]
fn neither_does_it_in_a_block() {
    for zero in ZEROS {
        let form = format!(
            "[loop]\ninputs = ['r']\noutputs = ['y']\n[[block]]\ninput = 'r - y'\noutput = 'y'\n\
             transfer = '(({zero})*z^2 + K)/(({zero})*z^2 + z)'\n"
        );
        let verdict = model(&form).ask().verdict(&Budget::unlimited()).unwrap().into_value();
        assert_eq!((verdict.verdict, verdict.degree, verdict.infinite), (Verdict::Stable, 1, 0), "{zero}");
    }
}

/// A coefficient that is zero at these values only is a root that has left through infinity.
#[test]
fn what_is_zero_at_the_values_only_counts() {
    for almost in ["a - 3/10", "sin(a - 3/10)", "sin(a)^2 + cos(a)^2 - 1 + 10*a - 3", "sqrt(2)^2 - 2 + K - 1/10"] {
        let form = format!("[loop]\ncharacteristic = '({almost})*z^2 + z - K'\n");
        let verdict = model(&form).ask().verdict(&Budget::unlimited()).unwrap().into_value();
        assert_eq!((verdict.verdict, verdict.degree, verdict.infinite), (Verdict::Unstable, 2, 1), "{almost}");
    }
}
