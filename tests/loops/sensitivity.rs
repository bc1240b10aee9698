//! How limits move: exact derivatives against limits of loops with a constant a little different.

use crate::helpers::model::load;
use crate::helpers::number::number;
use crate::helpers::open_loops::SERVO_BEHIND_A_HOLD;
use crate::helpers::program::json;
use jurist::Ask;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_engine::model::Model;

/// Every derivative agrees with a central difference with steps of 1e-12 of the value, to eight digits.
fn agree_with_differences(model: &Model, name: &str, every: usize) -> usize {
    let budget = Budget::unlimited();
    let answer = model.ask().free(name).stable_set(&budget).unwrap();
    let table = answer.sensitivities(&budget).unwrap();
    let mut compared = 0;
    for row in table.rows.iter().step_by(every) {
        let Some(derivative) = &row.derivative else { continue };
        let step = &row.value * &number("1e-12");
        let moved = |value: Rational| -> Rational {
            let set = model.ask().set(row.name.clone(), value).free(name).stable_set(&budget).unwrap();
            let ends = set.value().intervals().iter().flat_map(|i| [&i.lower, &i.upper]).flatten();
            let at = row.limit.refined_to_digits(30).enclosure().0;
            let near = ends.map(|end| end.value.refined_to_digits(40).enclosure().0);
            near.min_by_key(|x| (x - &at).abs()).unwrap()
        };
        let difference = (moved(&row.value + &step) - moved(&row.value - &step)) / (&step + &step);
        let exact = derivative.refined_to_digits(20).enclosure().0;
        let error = (&difference - &exact).abs();
        assert!(
            error <= exact.abs() * number("1e-8") + number("1e-14"),
            "{} {}: {exact} {difference}",
            row.name,
            row.limit.decimal(9)
        );
        compared += 1;
    }
    compared
}

#[test]
fn limits_of_the_drive_move_as_their_derivatives_say() {
    assert!(agree_with_differences(&Model::drive(), "K_pwm", 5) >= 4);
}

#[test]
fn limits_behind_a_hold_move_as_their_derivatives_say() {
    // T and T_m are inside of the exponential.
    let model = load(SERVO_BEHIND_A_HOLD);
    // Both limits, 0 and the upper one.
    assert_eq!(agree_with_differences(&model, "K", 1), 2);
    let answer = model.ask().free("K").stable_set(&Budget::unlimited()).unwrap();
    let table = answer.sensitivities(&Budget::unlimited()).unwrap();
    let none: Vec<&str> = table.rows.iter().filter(|r| r.derivative.is_none()).map(|r| r.name.as_str()).collect();
    assert!(none.contains(&"T_m") && !none.contains(&"Kd"), "{none:?}");
}

/// `s^3 + a s^2 + b s + K` is stable for `0 < K < a b`.
#[test]
fn limits_in_continuous_time_move_as_their_derivatives_say() {
    let text = "time = 'continuous'\n[constants]\na = 3\nb = 2\n[parameters]\nK = { nominal = 1 }\n[loop]\n\
                characteristic = 's^3 + a*s^2 + b*s + K'\n";
    let model = load(text);
    assert_eq!(agree_with_differences(&model, "K", 1), 4);
    let answer = model.ask().free("K").stable_set(&Budget::unlimited()).unwrap();
    let table = answer.sensitivities(&Budget::unlimited()).unwrap();
    let exact: Vec<_> =
        table.rows.iter().map(|r| r.derivative.as_ref().unwrap().exact().unwrap().to_string()).collect();
    assert_eq!(exact, ["0", "0", "2", "3"]);
}

#[test]
fn the_program_adds_the_table() {
    let document = json(&["intervals", "--param", "K_pwm", "--sensitivity", "--json"]);
    let rows = document["sensitivity"].as_array().unwrap();
    // The chopper's gain is K_pwm/E_sw: one percent of one is one percent of the other.
    let of_carrier: Vec<_> = rows.iter().filter(|r| r["name"] == "E_sw").collect();
    assert!(!of_carrier.is_empty() && of_carrier.iter().all(|r| r["relative"]["exact"] == "1"), "{of_carrier:?}");
    assert!(json(&["intervals", "--param", "K_pwm", "--json"]).get("sensitivity").is_none());
}
