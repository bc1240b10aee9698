//! Requirements on margins of loops with dead time, over boxes, against decisions at points.

use super::required_boxes::{agrees, boxes, decided, diagram, required};
use crate::helpers::number::number;
use crate::helpers::random::Random;
use crate::helpers::thorough::{count, is_thorough};
use jurist_engine::response::Requirement;

fn kinds() -> [Requirement; 3] {
    [
        Requirement::phase_margin(&number("40")).unwrap(),
        Requirement::gain_margin(&number("2")).unwrap(),
        Requirement::modulus_margin(number("1/2")).unwrap(),
    ]
}

/// Gains, a dead time, a zero and a time constant on the axes; with one pole at 0, with two, and with none.
#[test]
#[ignore = "long: CI runs it"]
fn boxes_of_loops_with_dead_time_agree_with_decisions_at_points() {
    let mut random = Random::new(41);
    let loops = [
        ("K + L/s", "exp(-s)/(2*s + 1)", [["0", "3"], ["0", "2"]]),
        ("K", "exp(-L*s)/(s + 1)", [["-1", "6"], ["0", "2"]]),
        ("K", "(1 + L*s)*exp(-0.25*s)/s^2", [["0", "4"], ["0", "3"]]),
        ("K", "(1 - L*s)*exp(-0.5*s)/(s*(s + 3))", [["0", "6"], ["-1", "1"]]),
        ("K", "exp(-0.3*s)/(L*s - 1)", [["0", "6"], ["1/2", "3"]]),
    ];
    let mut seen = [0; 2];
    for (i, (controller, plant, sides)) in loops.into_iter().enumerate() {
        let model = diagram("continuous", ["K", "L"], controller, plant, false);
        for (j, requirement) in kinds().iter().enumerate() {
            // The others take longer.
            if !is_thorough() && [i, j] != [1, 0] {
                continue;
            }
            let answer = boxes(&model, ["K", "L"], sides, "1/5", std::slice::from_ref(requirement));
            let [unmet, met] =
                agrees(&answer, &mut random, count(3, 6), |p| decided(&model, ["K", "L"], p, requirement));
            seen = [seen[0] + unmet, seen[1] + met];
            let told = required(&answer).iter().filter(|b| b.met.is_some()).count();
            assert!(told > 2, "{controller} {plant} {}", requirement.text());
        }
    }
    let [least, both] = [count(0, 21), count(3, 42)];
    assert!(seen[0] + seen[1] >= both && seen.iter().all(|seen| *seen >= least), "{seen:?}");
}
