use super::*;
use crate::simulate::{Course, SampledModel, Step, natural_duration};
use jurist_engine::error::{Code, Source};
use jurist_engine::model::Model;
use jurist_engine::problem::Ask;

const INTEGRATOR: &str = "time = 'continuous'\n[loop]\ninputs = ['r']\noutputs = ['y', 'v']\n\
    [[block]]\ninput = 'r - v'\noutput = 'y'\ntransfer = '1/s'\n\
    [[block]]\ninput = 'y'\noutput = 'v'\ndelay = 1\n";

fn problem(text: &str) -> std::sync::Arc<Problem> {
    let (model, _) = Model::from_toml(&Source::new("model.toml", text)).unwrap();
    model.ask().problem().unwrap()
}

fn model(text: &str, step: f64) -> DelayedModel {
    DelayedModel::from_loop(&problem(text), step, &Budget::unlimited()).unwrap().expect("dead time")
}

fn unit_step() -> Excitation {
    Excitation { steps: vec![Step { sample: 0, input: 0, value: 1.0 }], ..Excitation::default() }
}

fn code(error: Error) -> Code {
    match error {
        Error::Refused(list) => list.code(),
        other => panic!("{other:?}"),
    }
}

fn lag(gain: &str, time_constant: &str, dead_time: &str) -> String {
    format!(
        "time = 'continuous'\n[loop]\ninputs = ['r']\noutputs = ['y']\n\
         [[block]]\ninput = 'r - y'\noutput = 'u'\ngain = {gain}\n\
         [[block]]\ninput = 'u'\noutput = 'y'\ntransfer = 'exp(-{dead_time}*s)/({time_constant}*s + 1)'\n"
    )
}

#[test]
fn an_integrator_with_dead_time_follows_the_polynomials_of_its_intervals() {
    // y' = 1 - y(t - 1): sum (-1)^k (t - k)^(k + 1)/(k + 1)! over k < t.
    let model = model(INTEGRATOR, 0.3);
    let trace = model.simulate_within(&unit_step(), 15, &Budget::unlimited()).unwrap();
    let factorial = |n: u32| (1..=n).map(f64::from).product::<f64>();
    for (t, y) in trace.points("y") {
        let terms = (0..5u32)
            .filter(|k| t > f64::from(*k))
            .map(|k| (-1f64).powi(k as i32) * (t - f64::from(k)).powi(k as i32 + 1) / factorial(k + 1));
        let exact: f64 = terms.sum();
        assert!((y - exact).abs() < 1e-6, "{t}: {y} for {exact}");
    }
    // The delayed output is the output one second ago.
    let (y, v) = (trace.points("y"), trace.points("v"));
    assert_eq!((v[2].1, v[3].1), (0.0, 0.0));
    assert!((v[10].1 - 1.5).abs() < 1e-6 && y[10].0 == v[10].0, "{v:?}");
    assert!(model.final_values(&DVector::from_element(1, 1.0)).contains(&("y".to_owned(), 1.0)));
    assert_eq!((model.state_named("y"), model.state_named("v")), (Some(0), None));
}

#[test]
fn a_lag_with_dead_time_follows_its_neumann_series_however_fast_it_is() {
    // y = sum (-1)^n K^(n+1) P(n + 1, (t - (n + 1) d)/T), P(a, x) = 1 - exp(-x) sum_(j < a) x^j/j!.
    for (gain, time_constant, dead_time, step) in
        [("2", "10", "3", 0.7), ("0.9", "0.001", "0.5", 0.0501), ("3", "1", "0.01", 0.1)]
    {
        let model = model(&lag(gain, time_constant, dead_time), step);
        let trace = model.simulate_within(&unit_step(), 60, &Budget::unlimited()).unwrap();
        let [k, lag, d] = [gain, time_constant, dead_time].map(|x| x.parse::<f64>().unwrap());
        for (t, y) in trace.points("y").into_iter().step_by(7) {
            let (mut exact, mut n) = (0.0, 0u32);
            while t > f64::from(n + 1) * d && n < 40 {
                let x = (t - f64::from(n + 1) * d) / lag;
                let (mut term, mut sum) = (1.0, 0.0);
                for j in 0..=n {
                    sum += term;
                    term *= x / f64::from(j + 1);
                }
                exact += (-1f64).powi(n as i32) * k.powi(n as i32 + 1) * (1.0 - (-x).exp() * sum);
                n += 1;
            }
            // Beyond 40 reflections the series is of no use in floating point.
            if n < 40 && (k / lag * t) < 20.0 || lag < 0.01 {
                assert!(
                    (y - exact).abs() < 1e-6 * (1.0 + exact.abs()),
                    "{gain} {time_constant} {dead_time} {t}: {y} for {exact}"
                );
            }
        }
    }
}

#[test]
fn an_initial_state_is_felt_after_the_dead_time() {
    let model = model(INTEGRATOR, 0.25);
    let drive = Excitation { initial: vec![1.0], ..Excitation::default() };
    let trace = model.simulate_within(&drive, 8, &Budget::unlimited()).unwrap();
    // 1 until t = 1, then 1 - (t - 1).
    let y = trace.points("y");
    assert!((y[4].1 - 1.0).abs() < 1e-12 && (y[6].1 - 0.5).abs() < 1e-12 && y[8].1.abs() < 1e-12, "{y:?}");
}

#[test]
fn an_input_that_jumps_late_is_felt_after_the_dead_time_and_not_before() {
    let model = model(&lag("1", "1", "1/3"), 0.1);
    let drive = Excitation { steps: vec![Step { sample: 7, input: 0, value: 2.0 }], ..Excitation::default() };
    let y = model.simulate_within(&drive, 12, &Budget::unlimited()).unwrap().points("y");
    // u = 2 from t = 0.7 on, y = 2 (1 - exp(-(t - 0.7 - 1/3))) until the dead time has passed twice.
    assert!(y[..=10].iter().all(|p| p.1 == 0.0), "{y:?}");
    let expected = 2.0 * (1.0 - (-(1.1f64 - 0.7 - 1.0 / 3.0)).exp());
    assert!((y[11].1 - expected).abs() < 1e-6, "{y:?} {expected}");
}

#[test]
#[ignore = "long: CI runs it"]
fn a_dead_time_of_zero_leaves_the_loop_without() {
    let delayed = lag("2", "1", "0.0001");
    let sampled = lag("2", "1", "0");
    let a = model(&delayed, 0.1).simulate_within(&unit_step(), 20, &Budget::unlimited()).unwrap();
    let b = SampledModel::from_loop(&problem(&sampled), 0.1, &Budget::unlimited()).unwrap().simulate(&unit_step(), 20);
    for (p, q) in a.points("y").iter().zip(b.points("y")) {
        assert!((p.1 - q.1).abs() < 1e-3, "{p:?} {q:?}");
    }
}

#[test]
fn what_is_too_fine_or_neutral_is_refused() {
    let neutral = "time = 'continuous'\n[loop]\ninputs = ['r']\noutputs = ['y']\n\
        [[block]]\ninput = 'r - v'\noutput = 'y'\ntransfer = '(s + 3)/(2*s + 1)'\n\
        [[block]]\ninput = 'y'\noutput = 'v'\ndelay = 1\n";
    let refused = DelayedModel::from_loop(&problem(neutral), 0.1, &Budget::unlimited());
    assert_eq!(code(refused.unwrap_err()), Code::DeadTime);
    let fine = model(&lag("1", "1", "1e-9"), 1.0).simulate_within(&unit_step(), 100, &Budget::unlimited());
    assert_eq!(code(fine.unwrap_err()), Code::Simulation);
}

#[test]
fn a_run_is_as_long_as_several_dead_times_and_knows_where_it_goes() {
    let (problem, budget) = (problem(&lag("1", "1", "3")), Budget::unlimited());
    assert_eq!(natural_duration(&problem, &budget).unwrap(), Some(50.0));
    let mut course = Course::of(&problem, None, &budget).unwrap();
    course.step_first_input(problem.model());
    let run = course.run(&problem, &budget).unwrap();
    assert_eq!((run.trace.time.len(), run.is_complete, run.sample_time), (2001, true, None));
    assert_eq!(run.finals.last(), Some(&("y".to_owned(), 0.5)));
}
