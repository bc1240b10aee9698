use super::FromNumbers;
use crate::answer::{PointVerdict, Verdict};
use crate::error::{Error, Source};
use crate::model::Model;
use crate::problem::{Ask, Region};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;

/// A plant behind a hold in unity feedback with a gain.
fn held(transfer: &str, hold: &str, gain: &str, more: &str) -> Model {
    let text = format!(
        "time = 'discrete'\nsample_time = 0.1\n{more}[parameters]\nK = {{ nominal = {gain} }}\n[loop]\ninputs = ['r']\n\
         outputs = ['y']\n[[block]]\ninput = 'r - y'\noutput = 'u'\ngain = 'K'\n[[block]]\ninput = 'u'\noutput = 'y'\n\
         transfer = '{transfer}'\ndiscretize = {hold}\n"
    );
    Model::from_toml(&Source::new("model.toml", text)).unwrap().0
}

const ZERO_ORDER: &str = "'zoh'";

const THREE_MODES: &str = "1/((s+1)*(s^2+0.4*s+4)*(s^2+0.66*s+11)*(s^2+s+26))";
const FIVE_MODES: &str = "1/((s+0.3)*(s+1)*(s^2+0.4*s+4)*(s^2+0.66*s+11)*(s^2+s+26)*(s^2+0.5*s+40)*(s^2+0.8*s+70))";

/// Work that is no more than a moment; expanded over the symbols of the modes it takes a thousand times as much.
const A_MOMENT: u64 = 300_000_000;

fn counts(model: &Model, gain: &str, budget: &Budget) -> Result<(Verdict, usize, usize, usize), Error> {
    let gain: Rational = jurist_algebra::number::parse_number(gain).unwrap();
    let found: PointVerdict = model.ask().set("K", gain).verdict(budget)?.into_value();
    let count = found.count.unwrap();
    Ok((found.verdict, count.inside, count.on, count.outside))
}

/// The expected counts are those of eigenvalues in floating point, all of which are at least 1e-3 away from the circle.
#[test]
fn loops_of_several_modes_behind_a_hold_are_decided_with_little_work() {
    for (transfer, gain, order, outside) in [
        (THREE_MODES, "0.5", 7, 0),
        (THREE_MODES, "300", 7, 2),
        (THREE_MODES, "1000", 7, 2),
        (FIVE_MODES, "0.5", 12, 0),
        (FIVE_MODES, "1e6", 12, 0),
        (FIVE_MODES, "1e7", 12, 2),
    ] {
        let model = held(transfer, ZERO_ORDER, "1", "");
        let verdict = if outside == 0 { Verdict::Stable } else { Verdict::Unstable };
        let budget = Budget::with_work(A_MOMENT);
        assert_eq!(counts(&model, gain, &budget).unwrap(), (verdict, order - outside, 0, outside), "{order} {gain}");
    }
}

/// Holds of both kinds with and without dead time, hidden and undamped modes, loops inside of loops.
#[test]
fn enclosures_and_exact_algebra_count_the_same_roots() {
    let plants =
        ["1/(s+1)", "1/(s*(s+2))", "(s+3)/(s^2+0.2*s+9)", "(2*s^2+1)/(s^2+3*s+1)", "1/s^2", "(s+1)/((s+1)*(s-1))"];
    let holds = ["'zoh'", "'foh'", "{ method = 'zoh', delay = 0.03 }", "{ method = 'foh', delay = 0.25 }"];
    let budget = Budget::unlimited();
    let (mut known, mut open) = (0, 0);
    for plant in plants {
        for hold in holds {
            let model = held(plant, hold, "1", "");
            for (gain, radius) in [("0.5", "1"), ("-3", "1"), ("12", "1"), ("0.5", "0.93"), ("0", "1")] {
                let radius: Rational = jurist_algebra::number::parse_number(radius).unwrap();
                let gain: Rational = jurist_algebra::number::parse_number(gain).unwrap();
                let question = model.ask().set("K", gain.clone()).within(Region::disc(radius).unwrap());
                let problem = question.problem().unwrap();
                let exact = match problem.verdict_exactly(&budget) {
                    Ok(exact) => exact,
                    Err(failure) => panic!("{plant} {hold} {gain}: {failure}"),
                };
                match problem.roots_in_numbers(&budget) {
                    Ok(Some(FromNumbers::Known { at, degree, drifts, .. })) => {
                        known += 1;
                        let found = PointVerdict { drifts, ..PointVerdict::of(at, degree) };
                        assert_eq!(found, exact, "{plant} {hold} {gain}");
                    }
                    Ok(Some(FromNumbers::Open(question))) => {
                        open += 1;
                        let count = exact.count.unwrap();
                        assert!(count.on > 0 || count.outside > 0, "{plant} {hold} {gain}: {question}");
                    }
                    other => panic!("{plant} {hold} {gain}: {other:?}"),
                }
            }
        }
    }
    assert!(known >= 70 && open >= 12, "{known} {open}");
}

/// `K = 0` leaves the integrator alone.
#[test]
fn a_loop_on_the_boundary_is_decided_exactly() {
    let model = held("1/(s*(s+2))", ZERO_ORDER, "1", "");
    assert_eq!(counts(&model, "0", &Budget::unlimited()).unwrap(), (Verdict::Marginal, 1, 1, 0));
}

/// On the boundary, and too long for exact algebra with this work.
/// An integrator that nothing feeds back to rests at z = 1.
#[test]
fn a_root_at_rest_is_counted() {
    let model = held(&THREE_MODES.replace("(s+1)", "s"), ZERO_ORDER, "1", "");
    let found = counts(&model, "0", &Budget::with_work(A_MOMENT / 10)).unwrap();
    assert_eq!(found, (Verdict::Marginal, 6, 1, 0));
}

#[test]
fn what_stays_open_is_named() {
    let stopped = |found: Result<_, Error>| match found {
        Err(Error::Stopped(stopped)) => stopped.reached(),
        other => panic!("{other:?}"),
    };
    // cos(pi/7) cos(2 pi/7) cos(3 pi/7) = 1/8 is true, and no identity that is known here.
    let text = "time = 'discrete'\n[parameters]\nK = { nominal = 1 }\n[loop]\n\
        characteristic = '2*z - 1 - cos(pi/7)*cos(2*pi/7)*cos(3*pi/7)*8*K'\n";
    let model = Model::from_toml(&Source::new("model.toml", text)).unwrap().0;
    let reached = stopped(counts(&model, "1", &Budget::unlimited()));
    assert!(reached.contains("; open: whether D(1) = "), "{reached}");
}

/// Modes whose angle in a step is a multiple of the circle number turn by it exactly, as `cos(pi)` does.
#[test]
fn modes_that_turn_by_multiples_of_pi_are_decided() {
    let budget = Budget::unlimited();
    // z = -1 - 2 K c and a hidden root at -1, with the gain c of the plant at rest.
    for (time, transfer) in
        [("pi", "1/(s^2+1)"), ("pi/sqrt(2)", "2/(s^2+2)"), ("sqrt(2)*pi/2", "2/(s^2+2)"), ("3*pi/2", "4/(s^2+4)")]
    {
        let text = format!(
            "time = 'discrete'\nsample_time = 'T'\n[constants]\nT = '{time}'\n[parameters]\nK = {{ nominal = 0.5 }}\n[loop]\n\
             inputs = ['r']\noutputs = ['y']\n[[block]]\ninput = 'K*(r - y)'\noutput = 'y'\ntransfer = '{transfer}'\n\
             discretize = 'zoh'\n"
        );
        let model = Model::from_toml(&Source::new("model.toml", text)).unwrap().0;
        let at = |gain: &str| counts(&model, gain, &budget).unwrap();
        assert_eq!(at("0.5"), (Verdict::Unstable, 0, 1, 1), "{time}");
        assert_eq!(at("-0.5"), (Verdict::Marginal, 1, 1, 0), "{time}");
        assert_eq!(at("-1"), (Verdict::Marginal, 0, 2, 0), "{time}");
        // The hidden root stays on the circle.
        let set = model.ask().free("K").stable_set(&budget).unwrap().into_value();
        assert!(set.is_empty() && set.undecided().is_empty(), "{time}");
    }
}
