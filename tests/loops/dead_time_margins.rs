//! Margins of continuous loops with dead time, to the digits of mpmath at eighty, and against counts of roots.

use crate::helpers::model::load;
use crate::helpers::number::number;
use crate::helpers::open_loops::{margins_of, stable};
use jurist::Ask;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_engine::model::Model;
use jurist_engine::response::{DelayMargin, PhaseMargin, Place, Requirement, Requirements};
use jurist_show::{real, required_value};

/// `K exp(-tau s)/(s (s/2 + 1))`.
fn positioner(gain: &str, delay: &str) -> Model {
    load(&format!(
        "time = 'continuous'\n[parameters]\nK = {{ nominal = {gain} }}\n[loop]\ninputs = ['r']\noutputs = ['y']\n[[block]]\n\
         name = 'L'\ninput = 'r - y'\noutput = 'y'\ntransfer = 'K*exp(-{delay}*s)/(s*(s/2 + 1))'\n"
    ))
}

#[test]
fn a_positioner_with_dead_time_has_these_margins_to_thirty_digits() {
    let answer = margins_of(&positioner("2", "0.3"), None);
    let margins = stable(&answer);
    assert_eq!(margins.gain.upper.as_ref().unwrap().value.decimal(30), "1.81320582643931752040262223029");
    let degrees = real::enclosed(30, |bits| margins.phase.degrees(bits)).unwrap();
    assert_eq!(degrees, "24.8013987706506243055118456934");
    let PhaseMargin::Angle { place: Some(place), .. } = &margins.phase else { panic!("a crossing") };
    let rate = real::enclosed(30, |bits| answer.value().frequency(place, bits)?.radians_per_second).unwrap();
    assert_eq!(rate, "1.57230275551484657213911717169");
    let DelayMargin::DeadTime(i) = margins.delay else { panic!("a dead time") };
    let shape = answer.value().open_loop.shape();
    let delay = real::enclosed(30, |bits| answer.value().crossings.gain[i].delay(shape, bits)).unwrap();
    assert_eq!(delay, "0.275307071828024934211391935180");
    assert_eq!(margins.modulus.decimal(30), "0.315539627788758622195987663893");
    assert_eq!(margins.disk.alpha.as_ref().unwrap().decimal(30), "0.354717659386133510841458403888");
    // The crossings of the negative real axis down to a hundredth: the next is at a modulus of 1/113.46.
    let factors: Vec<String> = answer
        .value()
        .crossings
        .phase
        .iter()
        .map(|c| real::enclosed(12, |bits| Some(c.factor.enclosure(bits))).unwrap())
        .collect();
    assert_eq!(factors, ["1.81320582644"]);
}

/// The limits that the margins say are those of the roots: stable a little before, unstable a little after.
#[test]
fn gain_and_delay_margins_are_the_limits_of_the_closed_loop() {
    let answer = margins_of(&positioner("2", "0.3"), None);
    let verdict = |gain: Rational, delay: Rational| {
        let model = positioner(&format!("'{gain}'"), &format!("({delay})"));
        model.ask().verdict(&Budget::unlimited()).unwrap().value().verdict.name()
    };
    let factor = stable(&answer).gain.upper.as_ref().unwrap().value.refined_to_digits(12).enclosure().0;
    let step = number("1e-9");
    let gain = |k: Rational| verdict(&k * &number("2"), number("0.3"));
    assert_eq!([gain(&factor - &step), gain(&factor + &step)], ["stable", "unstable"]);
    let more = answer.value().delay_seconds(60).unwrap().lower() + &number("0.3");
    let delay = |tau: Rational| verdict(number("2"), tau);
    assert_eq!([delay(&more - &step), delay(&more + &step)], ["stable", "unstable"]);
}

/// Without the dead time the same loop has algebraic margins, and they are near for a short dead time.
#[test]
fn margins_with_a_short_dead_time_are_near_those_without() {
    let model = load(
        "time = 'continuous'\n[loop]\ninputs = ['r']\noutputs = ['y']\n[[block]]\nname = 'L'\ninput = 'r - y'\noutput = 'y'\n\
         transfer = '2/(s*(s/2 + 1))'\n",
    );
    let (with, without) = (margins_of(&positioner("2", "1e-9"), None), margins_of(&model, None));
    let apart = stable(&with).modulus.refined_to_digits(20).enclosure().0
        - stable(&without).modulus.refined_to_digits(20).enclosure().0;
    assert!(apart.abs() < number("1e-8") && !apart.is_zero());
    assert!(stable(&without).gain.upper.is_none() && stable(&with).gain.upper.is_some());
}

/// A delay margin as a requirement: 0.2753 s are borne.
#[test]
fn a_delay_margin_is_required_of_a_loop_with_dead_time() {
    let model = positioner("2", "0.3");
    let problem = model.ask().problem().unwrap();
    let met = |seconds: &str| {
        let asked = Requirements::of(&model, &[("delay_margin", seconds)], &[], &Budget::unlimited()).unwrap();
        let found = problem.requirements_met(&asked.list, None, &Budget::unlimited()).unwrap();
        (found[0].met, required_value(&found[0], 6).unwrap())
    };
    assert_eq!(met("0.2753070"), (true, "0.275307".to_owned()));
    assert_eq!(met("0.2753071"), (false, "0.275307".to_owned()));
}

/// Dead time inside of the loop that is cut elsewhere is not one factor of the open loop.
#[test]
fn dead_time_that_is_no_single_factor_is_refused() {
    let model = load(
        "time = 'continuous'\n[loop]\ninputs = ['r']\noutputs = ['y']\n[[block]]\nname = 'C'\ninput = 'r - y - m'\noutput = 'u'\n\
         gain = 2\n[[block]]\nname = 'P'\ninput = 'u'\noutput = 'y'\ntransfer = 'exp(-s)/(s + 1)'\n[[block]]\nname = 'M'\n\
         input = 'u'\noutput = 'm'\ntransfer = '(1 - exp(-s))/(s + 2)'\n",
    );
    let refused = model.ask().margins(Some("y"), &Rational::ZERO, &Budget::unlimited()).unwrap_err().to_string();
    assert!(refused.contains("E-dead-time"), "{refused}");
}

/// Poles on the axis, as of a resonant controller, and an open loop that does not fall at high frequencies, against grids of frequencies in floating point.
#[test]
#[ignore = "long: CI runs it"]
fn resonant_and_neutral_loops_with_dead_time_have_margins() {
    type Quotient = fn(f64) -> [[f64; 2]; 2];
    let resonant: Quotient = |w| {
        // (1/2 (s^2 + 4) + s/5) over (s^2 + 4)(s + 1)
        let q = 4.0 - w * w;
        [[q / 2.0, w / 5.0], [q, q * w]]
    };
    let neutral: Quotient = |w| [[2.4, 0.3 * w], [2.0, w]];
    for (transfer, tau, quotient) in
        [("(1/2 + s/(5*(s^2 + 4)))*exp(-s/5)/(s + 1)", 0.2, resonant), ("3/10*(s + 8)/(s + 2)*exp(-s/2)", 0.5, neutral)]
    {
        let model = load(&format!(
            "time = 'continuous'\n[loop]\ninputs = ['r']\noutputs = ['y']\n[[block]]\nname = 'L'\ninput = 'r - y'\n\
             output = 'y'\ntransfer = '{transfer}'\n"
        ));
        let answer = model.ask().margins(None, &Rational::ZERO, &Budget::unlimited()).unwrap_or_else(|e| panic!("{e}"));
        let margins = stable(&answer);
        // |D|, |N| and |D + N exp(-j w tau)|, |D - N exp(-j w tau)|.
        let sizes = |w: f64| {
            let [n, d] = quotient(w);
            let (cos, sin) = ((w * tau).cos(), (w * tau).sin());
            let n = [n[0] * cos + n[1] * sin, n[1] * cos - n[0] * sin];
            [d[0].hypot(d[1]), n[0].hypot(n[1]), (d[0] + n[0]).hypot(d[1] + n[1]), (d[0] - n[0]).hypot(d[1] - n[1])]
        };
        let greatest =
            |f: &dyn Fn([f64; 4]) -> f64| (0..400_000).map(|k| f(sizes(f64::from(k) * 1e-4))).fold(0.0, f64::max);
        let number = |x: &jurist_algebra::real::Real| x.decimal(12).parse::<f64>().unwrap();
        // A grid is never above the peak.
        let near = |found: f64, grid: f64| {
            assert!(found > grid * (1.0 - 1e-10) && found < grid * (1.0 + 1e-4), "{transfer}: {found} {grid}");
        };
        near(number(&margins.peak_sensitivity), greatest(&|[d, _, sum, _]| d / sum));
        near(1.0 / number(&margins.modulus), greatest(&|[d, _, sum, _]| d / sum));
        near(number(&margins.peak_complementary), greatest(&|[_, n, sum, _]| n / sum));
        near(2.0 / number(margins.disk.alpha.as_ref().unwrap()), greatest(&|[_, _, sum, other]| other / sum));
    }
}

/// `|L|` of `(s + 1)/(2 s + 4) exp(-s)` rises to a half: the least `|1 + L|` is come near to at high frequencies only, and so are the peaks.
#[test]
fn a_modulus_margin_may_be_that_of_the_limit_of_high_frequencies() {
    let model = load(
        "time = 'continuous'\n[loop]\ninputs = ['r']\noutputs = ['y']\n[[block]]\nname = 'L'\ninput = 'r - y'\n\
         output = 'y'\ntransfer = '(s + 1)/(2*s + 4)*exp(-s)'\n",
    );
    let answer = model.ask().margins(None, &Rational::ZERO, &Budget::unlimited()).unwrap_or_else(|e| panic!("{e}"));
    let margins = stable(&answer);
    assert_eq!(margins.modulus.exact(), Some("1/2".parse().unwrap()));
    assert_eq!(margins.peak_complementary.exact(), Some(Rational::ONE));
    // 2 (1 - 1/2)/(1 + 1/2)
    assert_eq!(margins.disk.alpha.as_ref().unwrap().exact(), Some("2/3".parse().unwrap()));
    assert!(matches!(margins.modulus_at.place(), Some(Place::Highest)));
}

/// Roots of a loop with dead time go on without end, with ever less damping: that is said.
#[test]
fn no_damping_is_required_of_a_loop_with_dead_time() {
    let damping = [Requirement::damping("1/2".parse().unwrap()).unwrap()];
    let budget = Budget::unlimited();
    let with = positioner("1", "0.3");
    let refusals = [
        with.ask().problem().unwrap().requirements_met(&damping, None, &budget).map(drop),
        with.ask().free("K").problem().unwrap().required_set(&damping, None, &budget).map(drop),
    ];
    for refused in refusals {
        assert!(refused.unwrap_err().to_string().contains("no loop with dead time has a damping"));
    }
}

/// At a zero of the open loop on the axis it is 0, and crosses the negative real axis at no factor.
#[test]
#[ignore = "long: CI runs it"]
fn a_loop_with_dead_time_and_a_zero_on_the_axis_has_margins() {
    let model = load(
        "time = 'continuous'\n[loop]\ninputs = ['r']\noutputs = ['y']\n[[block]]\nname = 'L'\ninput = 'r - y'\n\
         output = 'y'\ntransfer = '3*(s^2 + 4)*exp(-s/10)/(s + 2)^3'\n",
    );
    let budget = Budget::unlimited().within_work(20_000_000);
    let answer = model.ask().margins(None, &Rational::ZERO, &budget).unwrap_or_else(|e| panic!("{e}"));
    let margins = stable(&answer);
    // Least values over a million frequencies, in floating point.
    let of = |w: f64| {
        let (n, d) = (3.0 * (4.0 - w * w), (8.0 - 6.0 * w * w, 12.0 * w - w * w * w));
        let (size, turn) = (n / d.0.hypot(d.1), -d.1.atan2(d.0) - w / 10.0);
        (size * turn.cos(), size * turn.sin())
    };
    let least = |f: &dyn Fn((f64, f64)) -> f64| {
        (1..1_000_000).map(|k| f(of(f64::from(k) / 3e3))).min_by(f64::total_cmp).unwrap()
    };
    let modulus: f64 = margins.modulus.decimal(12).parse().unwrap();
    assert!((least(&|l| (1.0 + l.0).hypot(l.1)) - modulus).abs() < 1e-6, "{modulus}");
    let peak: f64 = margins.peak_complementary.decimal(12).parse().unwrap();
    assert!((least(&|l| (1.0 + l.0).hypot(l.1) / l.0.hypot(l.1)) - 1.0 / peak).abs() < 1e-6, "{peak}");
    // Sign changes of the imaginary part where the real part is negative, down to a hundredth.
    let crossings = (1..1_000_000).filter(|k| {
        let [a, b] = [f64::from(k - 1), f64::from(*k)].map(|k| of(k / 3e3));
        a.1 * b.1 < 0.0 && b.0 < -0.01
    });
    assert_eq!(answer.value().crossings.phase.len(), crossings.count());
}

/// The modulus of the open loop falls from 9/10 to 6/10, so the modulus of the sensitivity comes down to 5/2, again and again, from a greater peak; all margins of such a loop were
/// undecided. The numbers are minima over a million frequencies.
#[test]
#[ignore = "long: CI runs it"]
fn a_peak_above_the_limit_at_high_frequencies_is_found() {
    let model = load(
        "time = 'continuous'\n[loop]\ninputs = ['r']\noutputs = ['y']\n[[block]]\nname = 'L'\ninput = 'r - y'\noutput = 'y'\n\
         transfer = '0.9*exp(-s)*(2*s + 1)/(3*s + 1)'\n",
    );
    let answer = margins_of(&model, None);
    let margins = stable(&answer);
    assert_eq!(margins.modulus.decimal(9), "0.395695352");
    assert_eq!(margins.peak_complementary.decimal(6), "1.52721");
    assert_eq!(margins.gain.upper.as_ref().unwrap().value.decimal(7), "1.654801");
    assert!(matches!(margins.phase, PhaseMargin::Unbounded) && matches!(margins.delay, DelayMargin::Unbounded));
}
