//! Numbers written with square roots and exponentials that cancel: a loop and its answers are those of the numbers themselves, also
//! where roots of its boundaries coincide only for what these constants are.

use crate::helpers::model::load;
use crate::helpers::thorough::count;
use jurist::Ask;
use jurist_algebra::limits::Budget;
use jurist_engine::stability::{End, StableSet};
use proptest::collection::vec;
use proptest::prelude::*;

/// The number in one of several ways.
fn written(n: i64, way: usize) -> String {
    match way {
        0 => format!("({n}*sqrt(2)^2/2)"),
        1 => format!("({n}*sqrt(3)*sqrt(12)/6)"),
        2 => format!("({n} + sqrt(2)*sqrt(3) - sqrt(6))"),
        3 => format!("({n}*exp(1)*exp(-1))"),
        4 => format!("({n}*(sqrt(5) - 1)*(sqrt(5) + 1)/4)"),
        5 => format!("({n}/sqrt(2)*sqrt(2))"),
        _ => format!("({n})"),
    }
}

/// Coefficients of the powers of the roots' variable, each of powers of the parameter.
type Coefficients = Vec<Vec<(i64, usize)>>;

fn stable_set(coefficients: &Coefficients, time: &str, is_disguised: bool) -> StableSet {
    let number = |&(n, way): &(i64, usize)| if is_disguised { written(n, way) } else { format!("({n})") };
    let variable = if time == "discrete" { "z" } else { "s" };
    let term = |(k, list): (usize, &Vec<(i64, usize)>)| {
        let powers = list.iter().enumerate().map(|(j, n)| format!("{}*K^{j}", number(n))).collect::<Vec<_>>();
        format!("({})*{variable}^{k}", powers.join(" + "))
    };
    let sum = coefficients.iter().enumerate().map(term).collect::<Vec<_>>().join(" + ");
    let model = load(&format!("time = '{time}'\n[parameters]\nK = {{}}\n[loop]\ncharacteristic = '{sum}'\n"));
    let answer = model.ask().free("K").stable_set(&Budget::unlimited());
    answer.unwrap_or_else(|e| panic!("{sum}: {e}")).into_value()
}

fn ends(set: &StableSet) -> Vec<[Option<(String, String)>; 2]> {
    let end = |end: &Option<End>| end.as_ref().map(|end| (end.value.decimal(20), end.causes.to_string()));
    set.intervals().iter().map(|i| [end(&i.lower), end(&i.upper)]).collect()
}

fn coefficient() -> impl Strategy<Value = Vec<(i64, usize)>> {
    vec((-4i64..=4, 0usize..8), 1..=3)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(count(8, 20) as u32))]

    #[test]
    fn the_stable_set_is_that_of_the_plain_numbers(
        low in vec(coefficient(), 1..=4),
        lead in (1i64..=3, 0usize..8),
        is_discrete in any::<bool>(),
    ) {
        let coefficients: Coefficients = low.into_iter().chain([vec![lead]]).collect();
        let time = if is_discrete { "discrete" } else { "continuous" };
        let [plain, disguised] = [false, true].map(|d| stable_set(&coefficients, time, d));
        prop_assert_eq!(ends(&plain), ends(&disguised));
    }

    /// A root that is repeated for every value: `(z + a + b K)^2`.
    #[test]
    fn squares_are_seen(a in -4i64..=4, b in -3i64..=3, ways in vec(0usize..8, 5), is_discrete in any::<bool>()) {
        let list = |numbers: &[i64], ways: &[usize]| numbers.iter().copied().zip(ways.iter().copied()).collect::<Vec<_>>();
        let coefficients =
            vec![list(&[a * a, 2 * a * b, b * b], &ways[..3]), list(&[2 * a, 2 * b], &ways[3..]), vec![(1, 7)]];
        let time = if is_discrete { "discrete" } else { "continuous" };
        let [plain, disguised] = [false, true].map(|d| stable_set(&coefficients, time, d));
        prop_assert_eq!(ends(&plain), ends(&disguised));
    }
}
