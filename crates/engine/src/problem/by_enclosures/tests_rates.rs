//! Loops with several rates: enclosures of the coefficients over a hyperperiod against exact polynomials.

use super::tests::ends;
use super::tests_boxes::at;
use super::*;
use crate::error::Source;
use crate::model::Model;
use crate::problem::Ask;
use crate::stability::{StableSet, stable_set_of_parts, symbolic_stable_set};

/// A slow block before a fast one, and a plant behind a hold.
fn cascade(slow: &str, fast: &str, plant: &str, limits: &str) -> Arc<Problem> {
    let text = format!(
        "time = 'discrete'\nsample_time = '1/4'\n[parameters]\nK = {{ nominal = 1, {limits} }}\n[loop]\ninputs = ['r']\n\
         outputs = ['y']\n[[block]]\nname = 'slow'\ninput = 'r - y'\noutput = 'w'\n{slow}\n[[block]]\nname = 'fast'\n\
         input = 'w - y'\noutput = 'u'\n{fast}\n[[block]]\nname = 'plant'\ninput = 'u'\noutput = 'y'\n{plant}\n"
    );
    let (model, _) = Model::from_toml(&Source::new("model.toml", text)).unwrap();
    model.ask().free("K").problem().unwrap()
}

/// Ends of intervals with their causes.
type Ends = Vec<[Option<(String, String)>; 2]>;

/// The sets by enclosures and by exact polynomials; `None` where enclosures do not tell, so that the program asks exact polynomials.
fn both(problem: &Problem) -> Option<[Ends; 2]> {
    let (budget, domain) = (Budget::unlimited(), &problem.parameter().domain);
    let own = match problem.lifted_parts("K", &budget).unwrap()?.0 {
        EnclosedParts::Unstable => Ok(StableSet::from_intervals(Vec::new(), Vec::new())),
        EnclosedParts::Parts(parts) => stable_set_of_parts(&parts, domain, Shape::UnitDisc, &budget),
    };
    let p = problem.symbolic(&budget).unwrap().expect("not a constant");
    let exact = symbolic_stable_set(&p, domain, Shape::UnitDisc, &budget).unwrap();
    match own {
        Ok(own) => Some([ends(&own), ends(&exact)]),
        Err(stopped) if stopped.stop.is_precision() => None,
        Err(stopped) => panic!("{stopped}"),
    }
}

#[test]
#[ignore = "long: CI runs it"]
fn a_gain_of_the_fast_loop_has_the_set_of_the_exact_polynomial() {
    let slow =
        ["gain = 2\nevery = 2", "transfer = '1/(4*(z - 1))'\nevery = 3\nphase = 1", "transfer = '1/z'\nevery = 4"];
    let fast = ["gain = 'K'", "transfer = '(K*z - K/2)/(z - 1)'", "transfer = 'K/z'"];
    let plants = [
        "transfer = '1/(s + 1)'\ndiscretize = 'zoh'",
        "transfer = '1/(s*(s + 1))'\ndiscretize = 'zoh'",
        "transfer = '1/(s - 1/2)'\ndiscretize = { method = 'zoh', delay = '1/4' }",
        "transfer = '2/(s + 3)'\ndiscretize = { method = 'pwm', edge = 'trailing', duty = '1/3' }",
    ];
    let mut known = 0;
    for (k, plant) in plants.iter().enumerate() {
        for (i, slow) in slow.iter().enumerate() {
            // All with each other would take long.
            let fast = fast[(i + k) % fast.len()];
            for limits in ["min = 0, max = 20", "min = 0", "max = 3"] {
                let Some([own, exact]) = both(&cascade(slow, fast, plant, limits)) else { continue };
                assert_eq!(own, exact, "{slow}, {fast}, {plant}, {limits}");
                known += 1;
            }
        }
    }
    assert!(known >= 30, "{known} of 36");
}

/// Edges that alternate, and blocks that the parameter does not act on.
#[test]
fn other_forms_have_the_set_of_the_exact_polynomial() {
    let plant = "transfer = '1/(s + 1)'\ndiscretize = 'zoh'";
    let alternating = "transfer = '1/(s + 1)'\ndiscretize = { method = 'pwm', edge = 'alternating', duty = '1/3' }";
    let beside = |pole: &str| {
        format!(
            "{plant}\n[[block]]\nname = 'beside'\ninput = 'y'\noutput = 'v'\ntransfer = '1/(z - {pole})'\nevery = 2\n"
        )
    };
    for (slow, plant) in
        [("gain = 1", alternating), ("gain = 1\nevery = 2", &beside("1/2")), ("gain = 1\nevery = 2", &beside("2"))]
    {
        let [own, exact] = both(&cascade(slow, "gain = 'K'", plant, "min = 0")).expect("a loop of this form");
        assert_eq!(own, exact, "{slow}, {plant}");
    }
    // Not linear in a sample, and in a divisor.
    let unknown =
        [("gain = 'K/5'\nevery = 2", "gain = 'K'", plant), ("gain = 1\nevery = 2", "transfer = '1/(K*z - 1)'", plant)];
    for (slow, fast, plant) in unknown {
        let problem = cascade(slow, fast, plant, "min = 0");
        assert!(problem.lifted_parts("K", &Budget::unlimited()).unwrap().is_none(), "{slow}, {fast}, {plant}");
    }
}

/// Integrators that nobody reads where the parameter is 0: a root at 1 that does not show in the matrix over a hyperperiod.
#[test]
fn an_integral_gain_has_the_set_of_the_exact_polynomial() {
    let plant = "transfer = '1/(s + 1)'\ndiscretize = 'zoh'";
    for (slow, fast) in [
        ("gain = 1\nevery = 3", "transfer = '1/2 + K/20*(z + 1)/(z - 1)'"),
        ("transfer = '1/2 + 1/20*(z + 1)/(z - 1)'\nevery = 2", "transfer = '(1/3 + K/20*(z + 1)/(z - 1))/z'"),
    ] {
        let found = both(&cascade(slow, fast, plant, "min = 0"));
        let [own, exact] = found.unwrap_or_else(|| panic!("{slow}, {fast}"));
        assert_eq!(own, exact, "{slow}, {fast}");
        assert!(own[0][0].as_ref().is_some_and(|(at, causes)| at == "0" && causes.contains("z=1")), "{own:?}");
    }
}

/// Beyond that number the loop is unstable, and a tenth of it is none for a loop whose gain is that large at its limit.
#[test]
fn a_number_beyond_which_a_loop_is_unstable_is_one() {
    let problem = cascade("gain = 1\nevery = 3", "gain = 'K'", "transfer = '1/(s + 1)'\ndiscretize = 'zoh'", "min = 0");
    let Some((EnclosedParts::Parts(parts), _)) = problem.lifted_parts("K", &Budget::unlimited()).unwrap() else {
        panic!()
    };
    let end = parts[0].known_unstable_beyond().expect("a number").clone();
    let [limits, _] = both(&problem).unwrap();
    let upper = limits[0][1].clone().expect("an end").0.parse::<f64>().unwrap();
    assert!(end.to_f64_approximate() > upper && end.to_f64_approximate() < 1000.0 * upper, "{end} and {upper}");
    for factor in [1, 2, 5, 100] {
        let at = parts[0].at(&(&end * &factor.into()), Shape::UnitDisc, &Budget::unlimited()).unwrap();
        assert!(!at.is_stable(parts[0].formal_degree()), "{factor}");
    }
}

/// The gain stands at two inputs of the plant: in each sample it is in two rows that no combination makes one.
#[test]
fn a_gain_at_two_inputs_has_the_set_of_the_exact_polynomial() {
    let text = "time = 'discrete'\nsample_time = '1/4'\n[parameters]\nK = { nominal = 1, min = 0 }\n[loop]\ninputs = ['r']\noutputs = ['y']\n\
        [[block]]\nname = 'slow'\ninput = 'r - y'\noutput = 'w'\ngain = 2\nevery = 2\n\
        [[block]]\nname = 'first'\ninput = 'w - x'\noutput = 'u'\ngain = 'K'\n\
        [[block]]\nname = 'second'\ninput = 'x - y'\noutput = 'v'\ngain = 'K'\n\
        [[block]]\nname = 'plant'\ninput = ['u', 'v']\noutput = ['x', 'y']\nA = [[-1, '1/2'], [1, -2]]\nB = [[1, 0], [0, 1]]\n\
        discretize = 'zoh'\n";
    let (model, _) = Model::from_toml(&Source::new("model.toml", text)).unwrap();
    let problem = model.ask().free("K").problem().unwrap();
    let [own, exact] = both(&problem).expect("a loop of this form");
    assert_eq!(own, exact);
    assert_eq!(own.len(), 1);
}

/// At `K = -1` a fast controller is driven by `(1 + K) y = 0`: where it integrates, or the plant does, a root is 1 there.
#[test]
fn a_loop_that_rests_at_a_gain_other_than_zero_has_the_set_of_the_exact_polynomial() {
    let lag = "transfer = '1/(s + 1)'\ndiscretize = 'zoh'";
    let integrator = "transfer = '1/(s*(s + 1))'\ndiscretize = { method = 'zoh', delay = '3/32' }";
    let pulsed = "transfer = '1/(s + 1)'\ndiscretize = { method = 'pwm', edge = 'leading', duty = '1/3' }";
    for (slow, fast, plant) in [
        ("gain = 'K'\nevery = 2\nphase = 1", "transfer = '1/4*(z - 1/2)/(z - 1)'", lag),
        ("gain = 'K'\nevery = 2", "gain = '1/4'", integrator),
        ("gain = 'K'\nevery = 2", "transfer = '1/4*(z - 1/2)/(z - 1)'", pulsed),
    ] {
        let found = both(&cascade(slow, fast, plant, "max = 40"));
        let [own, exact] = found.unwrap_or_else(|| panic!("{slow}, {fast}, {plant}"));
        assert_eq!(own, exact, "{slow}, {fast}, {plant}");
        let lower = own[0][0].as_ref().expect("an end");
        assert!(lower.0 == "-1" && lower.1.contains("z=1"), "{own:?}");
    }
}

/// A register of the dead time has the value that the slow block holds: a combination of states is zero, and so is a root.
#[test]
fn roots_at_the_origin_of_loops_with_registers_are_known() {
    let plant = "transfer = '1/(s + 1)'\ndiscretize = { method = 'zoh', delay = '13/32' }";
    for slow in ["gain = 'K'\nevery = 2", "gain = 'K'\nevery = 4", "transfer = 'K/z'\nevery = 4"] {
        let problem = cascade(slow, "gain = '1/4'\nevery = 2", plant, "max = 40");
        let budget = Budget::unlimited();
        let at_origin = |p: &SymbolicPolynomial| p.polynomial().coeffs().iter().take_while(|c| c.is_zero()).count();
        let Some((EnclosedParts::Parts(parts), _)) = problem.lifted_parts("K", &budget).unwrap() else {
            panic!("{slow}")
        };
        let exact = at_origin(&problem.symbolic(&budget).unwrap().expect("not a constant"));
        assert!(exact > 0, "{slow}");
        assert_eq!(parts.iter().map(at_origin).sum::<usize>(), exact, "{slow}");
        let [own, exact] = both(&problem).unwrap_or_else(|| panic!("{slow}"));
        assert_eq!(own, exact, "{slow}");
    }
}

/// A constant of the plant, and a gain beside it: over a hyperperiod only values are known of them.
#[test]
fn coefficients_by_values_over_a_hyperperiod_are_the_exact_ones() {
    let budget = Budget::unlimited();
    let (slow, fast) = ("transfer = '1/(4*(z - 1))'\nevery = 3\nphase = 1", "transfer = '(K*z - K/2)/(z - 1)'");
    let plant = "transfer = 'b/(s + a)'\ndiscretize = 'zoh'";
    let text =
        cascade(slow, fast, "transfer = '1/(s + 1)'\ndiscretize = 'zoh'", "min = 0").model().source().text.clone();
    let text = text.replace("transfer = '1/(s + 1)'\ndiscretize = 'zoh'", plant);
    let text = text.replace("[loop]", "a = { nominal = 1, min = 0 }\nb = 1\n[loop]");
    let (model, _) = Model::from_toml(&Source::new("model.toml", text)).unwrap();
    for (names, points) in [(["a", "K"], [["1/3", "2"], ["5", "1/7"]]), (["b", "a"], [["2", "1/2"], ["1/9", "3"]])] {
        let problem = names.iter().fold(model.ask(), |ask, name| ask.free(*name)).problem().unwrap();
        let exact = problem.algebra_over_symbols(&budget).unwrap();
        let by_values = problem.coefficients_by_values(&Rational::ONE, &budget).unwrap().expect("of this form");
        assert_eq!(by_values.formal_degree(), exact.formal_degree());
        for point in &points {
            let (exact, found) = (at(exact, point), at(&by_values, point));
            let lead = exact.last().unwrap().clone();
            for (a, b) in exact.iter().zip(&found) {
                let a = a.div(&lead).unwrap();
                assert!(a.intersection(b).is_some() && b.width_units().bit_length() < 100, "{names:?} {point:?}");
            }
        }
    }
}
