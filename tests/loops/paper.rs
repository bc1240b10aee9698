//! The derivation of the paper (Gürbüz and Akpınar 2002), step by step, with every gain symbolic.

use crate::helpers::model::{characteristic, keeping, load};
use jurist::Ask;
use jurist_algebra::limits::Budget;
use jurist_algebra::poly::RationalFunction;
use jurist_engine::model::Model;
use jurist_engine::problem::Problem;

fn product(a: &[RationalFunction], b: &[RationalFunction]) -> Vec<RationalFunction> {
    let mut out = vec![RationalFunction::zero(); a.len() + b.len() - 1];
    for (i, x) in a.iter().enumerate() {
        for (j, y) in b.iter().enumerate() {
            out[i + j] = &out[i + j] + &(x * y);
        }
    }
    while out.last().is_some_and(RationalFunction::is_zero) {
        out.pop();
    }
    out
}

/// The controller of Eqs. 8 and 9 (11 and 12 have the same form), as it is printed.
const CONTROLLER: &str = r#"
time = "discrete"
[parameters]
K_p = {}
K_i = {}
k = {}
T = {}
[loop]
inputs = ["reference", "measured"]
outputs = ["out"]
[[block]]
name = "controller"
input = ["reference", "measured"]
output = "out"
A = [[0, 0], ["T/2", 1]]
B = [[1, "-k"], ["T/2", "-k*T/2"]]
C = [["K_p", "K_i"]]
"#;

#[test]
fn equations_7_and_10_are_the_transfer_functions_of_8_9_and_11_12() {
    let lp = load(CONTROLLER);
    let (problem, budget) = (keeping(&lp, &["K_p", "K_i", "k", "T"]).problem().unwrap(), Budget::unlimited());
    let closed = problem.closed_loop(&budget).unwrap();
    let [kp, ki, k, t] = [0, 1, 2, 3].map(RationalFunction::variable);
    let half_ki_t = (&ki * &t).checked_div(&2.into()).unwrap();
    // K_p/z + K_i/z T/2 (z + 1)/(z - 1) over the denominator z (z - 1).
    let numerator = [&half_ki_t - &kp, &half_ki_t + &kp];
    let denominator = [0.into(), -&RationalFunction::one(), RationalFunction::one()];
    for (input, factor) in [("reference", RationalFunction::one()), ("measured", -&k)] {
        let tf = closed.transfer_function(input, "out", &budget).unwrap();
        let expected: Vec<_> = numerator.iter().map(|c| c * &factor).collect();
        assert_eq!(product(&tf.numerator, &denominator), product(&tf.denominator.coefficients, &expected), "{input}");
    }
}

/// A - B K C of Eqs. 13, 17 and 20 multiplied out by hand: Eq. 21.
const MULTIPLIED_OUT: &str = r#"
time = "discrete"
[constants]
R_a = 1
L_a = 46e-3
J = 0.093
B_v = 0.008
K_a = 0.55
E_sw = 12
K_pi = 10
K_ii = 500
K_ps = 1
K_is = 5
k_1 = 1
k_2 = 1
[parameters]
K_pwm = { nominal = 110, min = 0 }
T = { nominal = 1e-4, min = 0 }
[loop]
matrix = [
  ["(L_a - R_a*T)/L_a", "-K_a*T/L_a", "K_pwm*T/(L_a*E_sw)*K_pi", "K_pwm*T/(L_a*E_sw)*K_ii", 0, 0],
  ["K_a*T/J", "(J - B_v*T)/J", 0, 0, 0, 0],
  ["-k_1", 0, 0, 0, "K_ps", "K_is"],
  ["-k_1*T/2", 0, "T/2", 1, "T/2*K_ps", "T/2*K_is"],
  [0, "-k_2", 0, 0, 0, 0],
  [0, "-k_2*T/2", 0, 0, "T/2", 1],
]
"#;

#[test]
fn equations_13_to_20_give_equation_21() {
    let gains = ["K_pwm", "T", "R_a", "L_a", "J", "B_v", "K_a", "E_sw", "K_pi", "K_ii", "K_ps", "K_is", "k_1", "k_2"];
    let budget = Budget::unlimited();
    // As matrices, with every quantity symbolic.
    let [tracker, by_hand] = [Model::drive(), load(MULTIPLIED_OUT)].map(|lp| keeping(&lp, &gains).problem().unwrap());
    let of = |problem: &Problem| problem.closed_loop(&budget).unwrap().a.clone();
    assert_eq!(of(&tracker), of(&by_hand));
    let [drive, hand] =
        [Model::drive(), load(MULTIPLIED_OUT)].map(|lp| characteristic(keeping(&lp, &["K_pwm", "T"])).coefficients);
    assert_eq!(drive, hand);
}

#[test]
fn equation_24_is_linear_in_the_amplitude() {
    let whole = characteristic(keeping(&Model::drive(), &["K_pwm", "T"]));
    let at = |k: i64| characteristic(Model::drive().ask().free("T").set("K_pwm", k)).coefficients;
    let (den, one, two) = (at(0), at(1), at(2));
    for (k, c) in whole.coefficients.iter().enumerate() {
        assert!(c.numerator().degree_in(0) <= 1 && c.denominator().degree_in(0) == 0);
        // 1 + K num/den: the value at K = 2 is den + 2 num.
        let num = &one[k] - &den[k];
        assert_eq!(&den[k] + &(&num * &2.into()), two[k]);
    }
    // den has the two integrators' factors z^2 (z - 1)^2 of the controllers.
    assert!(den[0].is_zero() && den[1].is_zero());
    let sum = den.iter().fold(RationalFunction::zero(), |s, c| &s + c);
    let slope = den.iter().enumerate().fold(RationalFunction::zero(), |s, (k, c)| &s + &(c * &(k as i64).into()));
    assert!(sum.is_zero() && slope.is_zero());
}
