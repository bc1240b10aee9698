//! The paper's drive: the conditions of its table, each for itself, against its stable sets.

use jurist::Ask;
use jurist_algebra::limits::Budget;
use jurist_engine::model::Model;

#[test]
fn jury_conditions_intersect_in_the_stable_set() {
    for parameter in ["K_pwm", "T"] {
        let answer = Model::drive().ask().free(parameter).parametric_table(&Budget::unlimited()).unwrap();
        let test = answer.value().test.as_ref().unwrap();
        assert_eq!(test.conditions.len(), 7);
        assert!(test.intersection.same_as(&answer.value().stable.to_interval_set().unwrap()));
    }
}
