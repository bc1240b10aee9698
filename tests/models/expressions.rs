//! Expressions against exact evaluation at points, and back through their printed text.

use crate::helpers::model::characteristic;
use jurist::Ask;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_engine::model::{BlockBuilder, Expression, Model, ParameterBuilder, Time};
use proptest::prelude::*;

/// A text and its value where a = 2/3 and b = -5.
fn expression() -> impl Strategy<Value = (String, Rational)> {
    let point = |n: i64, d: i64| Rational::new(n.into(), d.into());
    let leaf = prop_oneof![
        Just(("a".to_owned(), point(2, 3))),
        Just(("b".to_owned(), point(-5, 1))),
        (0i64..50).prop_map(move |n| (n.to_string(), point(n, 1))),
        (0i64..500).prop_map(move |n| (format!("{}.{:02}", n / 100, n % 100), point(n, 100))),
    ];
    leaf.prop_recursive(4, 24, 2, |inner| {
        let pair = (inner.clone(), inner.clone());
        prop_oneof![
            pair.clone().prop_map(|((s, x), (t, y))| (format!("({s} + {t})"), x + y)),
            pair.clone().prop_map(|((s, x), (t, y))| (format!("({s})-({t})"), x - y)),
            pair.clone().prop_map(|((s, x), (t, y))| (format!("({s})*({t})"), x * y)),
            pair.prop_filter_map("division by zero", |((s, x), (t, y))| {
                Some((format!("({s})/({t})"), x.checked_div(&y)?))
            }),
            inner.clone().prop_map(|(s, x)| (format!("-({s})"), -x)),
            (inner, 0i64..4).prop_map(|((s, x), n)| (format!("({s})^{n}"), x.pow(n).unwrap())),
        ]
    })
}

fn value(text: &str) -> Option<Rational> {
    let model = Model::builder(Time::Discrete)
        .parameter(ParameterBuilder::new("a").nominal("2/3"))
        .parameter(ParameterBuilder::new("b").nominal("-5"))
        .characteristic(&format!("z - ({text}) + 0*a*b"));
    let (model, _) = model.build().ok()?;
    let problem = model.ask().problem().ok()?;
    let p = problem.algebra(&Budget::unlimited()).ok()?.polynomial()?;
    p.coefficients[0].as_constant().map(|c| -c)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]

    #[test]
    fn value_at_a_point((text, expected) in expression()) {
        // A division by something identically zero is refused, though it was not met at the point.
        if let Some(found) = value(&text) {
            prop_assert_eq!(found, expected);
        }
    }

    #[test]
    fn printed_text_reads_back((text, expected) in expression()) {
        let parsed = Expression::parse(&text).unwrap();
        let printed = parsed.to_string();
        let again = Expression::parse(&printed).unwrap();
        prop_assert_eq!(again.to_string(), printed.clone());
        if let Some(found) = value(&printed) {
            prop_assert_eq!(found, expected);
        }
    }
}

#[test]
fn precedence() {
    for (text, expected) in
        [("-a^2", "-4/9"), ("2^3^2", "512"), ("6/2*3", "9"), ("1-2-3", "-4"), ("2*-3", "-6"), ("a^-2", "9/4")]
    {
        assert_eq!(value(text).unwrap().to_string(), expected, "{text}");
    }
}

/// The coefficients of a loop `y = G u`, `u = -y`, as text.
fn unity_feedback(block: BlockBuilder) -> Vec<String> {
    let model =
        Model::builder(Time::Discrete).parameter(ParameterBuilder::new("T")).outputs(["y + 0*T*y"]).block(block);
    let (model, _) = model.build().unwrap_or_else(|e| panic!("{e}"));
    let p = characteristic(model.ask().free("T"));
    p.coefficients.iter().map(|c| c.display(&p.variables).to_string()).collect()
}

#[test]
fn discretisation_rules() {
    let lag = || BlockBuilder::new("lag", "-y", "y").transfer("3/(s + 2)");
    // (z - 1)/T + 5 = 0
    assert_eq!(unity_feedback(lag().discretize("forward", "T")), ["5*T - 1", "1"]);
    // (z - 1)/(T z) + 5 = 0
    assert_eq!(unity_feedback(lag().discretize("backward", "T")), ["-1/(5*T + 1)", "1"]);
    // 2 (z - 1)/(T (z + 1)) + 5 = 0
    assert_eq!(unity_feedback(lag().discretize("tustin", "T")), ["(5*T - 2)/(5*T + 2)", "1"]);
}

#[test]
fn hidden_modes_stay() {
    // (z - 2) cancels in the product of the two, but is a mode of the loop.
    let ratio = BlockBuilder::new("both", "-y", "y").ratio(["1", "-2"], ["1", "-2", "0"]);
    assert_eq!(unity_feedback(ratio), ["-2", "-1", "1"]);
    let sum = BlockBuilder::new("sum", "-y", "y").transfer("1/(z - 2) + 1/(z - 2)");
    assert_eq!(unity_feedback(sum), ["0", "1"]);
    assert_eq!(unity_feedback(BlockBuilder::new("delay", "-y", "y").delay(3)), ["1", "0", "0", "1"]);
}
