//! Blocks behind a hold: the exact discrete system against the continuous block itself, run in pieces in floating point.

use jurist_algebra::limits::Budget;
use jurist_algebra::matrix::RationalMatrix;
use jurist_engine::error::{Code, Diagnostics, Error, Source};
use jurist_engine::model::{Definition, Evaluated, Model, value_approximate};

type Dense = Vec<Vec<f64>>;

fn read(text: &str) -> Result<Model, Diagnostics> {
    Ok(Model::from_toml(&Source::new("model.toml", text))?.0)
}

/// An open loop: one block from `u` to `y`.
fn open(block: &str) -> Model {
    read(&format!(
        "time = 'discrete'\n[loop]\ninputs = ['u']\noutputs = ['y']\n[[block]]\nname = 'plant'\ninput = 'u'\noutput = 'y'\n{block}\n"
    ))
    .unwrap()
}

fn evaluated(model: &Model) -> Evaluated {
    model.evaluate(&[], &[], &Budget::unlimited()).unwrap()
}

fn product(a: &Dense, b: &Dense) -> Dense {
    a.iter().map(|row| (0..b[0].len()).map(|j| row.iter().zip(b).map(|(x, r)| x * r[j]).sum()).collect()).collect()
}

/// `exp(m)` by its series and squaring: another way than modes.
fn exponential(m: &Dense) -> Dense {
    let n = m.len();
    let norm: f64 = m.iter().map(|row| row.iter().map(|x| x.abs()).sum::<f64>()).fold(0.0, f64::max);
    let halvings = (norm * 4.0).max(1.0).log2().ceil() as i32;
    let scaled: Dense = m.iter().map(|row| row.iter().map(|x| x * 0.5f64.powi(halvings)).collect()).collect();
    let mut sum: Dense = (0..n).map(|i| (0..n).map(|j| f64::from(u8::from(i == j))).collect()).collect();
    let mut term = sum.clone();
    for k in 1..30 {
        term = product(&term, &scaled);
        term.iter_mut().flatten().for_each(|x| *x /= f64::from(k));
        sum.iter_mut().flatten().zip(term.iter().flatten()).for_each(|(x, y)| *x += y);
    }
    (0..halvings).for_each(|_| sum = product(&sum, &sum));
    sum
}

/// A continuous system with one input and one output.
struct Plant {
    a: Dense,
    b: Vec<f64>,
    c: Vec<f64>,
    d: f64,
}

impl Plant {
    /// The state after `t` with the input going from `u` at the rate `slope`.
    fn flow(&self, x: &[f64], u: f64, slope: f64, t: f64) -> Vec<f64> {
        let n = x.len();
        let entry = |i: usize, j: usize| match (i, j) {
            (i, j) if i < n && j < n => self.a[i][j] * t,
            (i, j) if i < n && j == n => self.b[i] * t,
            (i, j) if i == n && j == n + 1 => t,
            _ => 0.0,
        };
        let m: Dense = (0..n + 2).map(|i| (0..n + 2).map(|j| entry(i, j)).collect()).collect();
        let start: Dense = x.iter().copied().chain([u, slope]).map(|x| vec![x]).collect();
        product(&exponential(&m), &start).into_iter().take(n).map(|row| row[0]).collect()
    }

    /// The outputs at the samples: inputs held (or straight) between samples, delayed by `samples + fraction` steps.
    fn run(&self, u: &[f64], step: f64, delay: (usize, f64), is_first_order: bool) -> Vec<f64> {
        let (samples, fraction) = delay;
        let at = |k: i64| if k < 0 { 0.0 } else { u.get(k as usize).copied().unwrap_or(0.0) };
        let mut x = vec![0.0; self.a.len()];
        let mut out = Vec::new();
        for k in 0..u.len() as i64 - 1 {
            let oldest = k - samples as i64 - 1;
            let (early, now, late) = (at(oldest), at(oldest + 1), at(oldest + 2));
            let (input, slopes) = if is_first_order {
                (fraction * early + (1.0 - fraction) * now, [(now - early) / step, (late - now) / step])
            } else {
                (if fraction > 0.0 { early } else { now }, [0.0, 0.0])
            };
            out.push(self.c.iter().zip(&x).map(|(c, x)| c * x).sum::<f64>() + self.d * input);
            if fraction > 0.0 {
                x = self.flow(&x, input, slopes[0], fraction * step);
            }
            x = self.flow(&x, now, slopes[1], (1.0 - fraction) * step);
        }
        out
    }
}

fn dense(m: &RationalMatrix, values: &[f64]) -> Dense {
    (0..m.rows()).map(|i| (0..m.columns()).map(|j| value_approximate(&m[(i, j)], values)).collect()).collect()
}

/// The outputs of the discrete system that the engine makes of a block.
fn discrete_run(model: &Model, u: &[f64]) -> Vec<f64> {
    let evaluated = evaluated(model);
    let values = evaluated.symbols.values_approximate(&[]);
    let system = evaluated.closed_loop.unwrap();
    let [a, e, c, d] = [&system.a, &system.e, &system.c, &system.d].map(|m| dense(m, &values));
    let mut x = vec![0.0; a.len()];
    let mut out = Vec::new();
    for u in &u[..u.len() - 1] {
        let dot = |row: &[f64], x: &[f64]| row.iter().zip(x).map(|(a, b)| a * b).sum::<f64>();
        out.push(c.first().map_or(0.0, |row| dot(row, &x)) + d[0][0] * u);
        x = (0..a.len()).map(|i| dot(&a[i], &x) + e[i][0] * u).collect();
    }
    out
}

fn inputs() -> Vec<f64> {
    let mut state = 1u64;
    (0..24)
        .map(|_| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 40) as f64 / f64::from(1 << 24) - 0.5
        })
        .collect()
}

/// A block and the same as matrices.
fn plants() -> Vec<(&'static str, Plant)> {
    let plant = |a: &[&[f64]], b: &[f64], c: &[f64], d: f64| Plant {
        a: a.iter().map(|row| row.to_vec()).collect(),
        b: b.to_vec(),
        c: c.to_vec(),
        d,
    };
    vec![
        ("transfer = '1/(s + 1)'", plant(&[&[-1.0]], &[1.0], &[1.0], 0.0)),
        ("transfer = '(2*s + 3)/(s + 4)'", plant(&[&[-4.0]], &[1.0], &[-5.0], 2.0)),
        ("transfer = '1/s^2'", plant(&[&[0.0, 1.0], &[0.0, 0.0]], &[0.0, 1.0], &[1.0, 0.0], 0.0)),
        ("transfer = '1/(s*(s + 1)*(s + 1))'", {
            plant(&[&[0.0, 1.0, 0.0], &[0.0, 0.0, 1.0], &[0.0, -1.0, -2.0]], &[0.0, 0.0, 1.0], &[1.0, 0.0, 0.0], 0.0)
        }),
        ("transfer = '(s + 5)/(s^2 + s/5 + 9)'", plant(&[&[0.0, 1.0], &[-9.0, -0.2]], &[0.0, 1.0], &[5.0, 1.0], 0.0)),
        ("transfer = '1/(s^2 + 3*s + 1)'", plant(&[&[0.0, 1.0], &[-1.0, -3.0]], &[0.0, 1.0], &[1.0, 0.0], 0.0)),
        ("transfer = '4/(s*(s^2 + 7))'", {
            plant(&[&[0.0, 1.0, 0.0], &[0.0, 0.0, 1.0], &[0.0, -7.0, 0.0]], &[0.0, 0.0, 1.0], &[4.0, 0.0, 0.0], 0.0)
        }),
        ("transfer = '1/(s^3 + s^2 + 2*s + 1/2)'", {
            plant(&[&[0.0, 1.0, 0.0], &[0.0, 0.0, 1.0], &[-0.5, -2.0, -1.0]], &[0.0, 0.0, 1.0], &[1.0, 0.0, 0.0], 0.0)
        }),
        ("transfer = '1/((s^2 + 4*s + 5)*(s^2 + s + 3))'", {
            let a: [&[f64]; 4] =
                [&[0.0, 1.0, 0.0, 0.0], &[0.0, 0.0, 1.0, 0.0], &[0.0, 0.0, 0.0, 1.0], &[-15.0, -17.0, -12.0, -5.0]];
            plant(&a, &[0.0, 0.0, 0.0, 1.0], &[1.0, 0.0, 0.0, 0.0], 0.0)
        }),
        ("transfer = '1/(s + pi*sqrt(2))'", {
            let rate = std::f64::consts::PI * 2.0f64.sqrt();
            plant(&[&[-rate]], &[1.0], &[1.0], 0.0)
        }),
        ("transfer = '1/(s^2 + sqrt(2)*s + pi)'", {
            let (a, b) = (2.0f64.sqrt(), std::f64::consts::PI);
            plant(&[&[0.0, 1.0], &[-b, -a]], &[0.0, 1.0], &[1.0, 0.0], 0.0)
        }),
    ]
}

#[test]
fn a_held_block_does_at_the_samples_what_the_continuous_block_does() {
    let u = inputs();
    let delays = [("0", (0, 0.0)), ("T", (1, 0.0)), ("T/2", (0, 0.5)), ("1.5*T", (1, 0.5)), ("2.25*T", (2, 0.25))];
    for (text, plant) in plants() {
        // The characteristic polynomial of many symbols is long, and it is made each time.
        let is_long = plant.a.len() > 3 || ["sqrt", "s^3"].iter().any(|part| text.contains(part));
        for (delay, parts) in delays.into_iter().take(if is_long { 1 } else { delays.len() }) {
            for (method, is_first_order) in
                [("zoh", false), ("foh", true)].into_iter().take(if is_long { 1 } else { 2 })
            {
                let block = format!(
                    "{text}\ndiscretize = {{ method = '{method}', T = 0.3, delay = '{}' }}",
                    delay.replace('T', "3/10")
                );
                let expected = plant.run(&u, 0.3, parts, is_first_order);
                // Without a whole sample of delay the first-order hold sees the next input: its state is behind by its part.
                let model = open(&block);
                let found = discrete_run(&model, &u);
                if !is_first_order || parts.0 > 0 {
                    for (k, (x, y)) in found.iter().zip(&expected).enumerate() {
                        assert!((x - y).abs() < 1e-9, "{text} {method} {delay}: sample {k}: {x} {y}");
                    }
                } else {
                    // Started at rest, x - late u is at rest: compare runs whose first input is 0.
                    let mut v = u.clone();
                    v[0] = 0.0;
                    let (found, expected) = (discrete_run(&model, &v), plant.run(&v, 0.3, parts, is_first_order));
                    for (k, (x, y)) in found.iter().zip(&expected).enumerate() {
                        assert!((x - y).abs() < 1e-9, "{text} {method} {delay}: sample {k}: {x} {y}");
                    }
                }
            }
        }
    }
}

#[test]
fn a_double_integrator_behind_a_hold_is_rational() {
    let evaluated = evaluated(&open("transfer = '1/s^2'\ndiscretize = { method = 'zoh', T = 0.5, delay = 0.2 }"));
    assert!(evaluated.symbols.is_empty());
    let one = evaluated.polynomial.coefficients.last().unwrap().clone();
    assert!(one.is_one());
    // (z - 1)^2 z: the past input is a state.
    let shown: Vec<String> = evaluated.polynomial.coefficients.iter().map(|c| format!("{c:?}")).collect();
    assert_eq!(shown, ["0", "1", "-2", "1"]);
}

#[test]
fn powers_of_one_exponential_are_one_symbol() {
    let text = "time = 'discrete'\n[constants]\nd = 'exp(-2*0.1) - exp(-0.1)^2'\n[loop]\ncharacteristic = 'z - d'\n";
    let evaluated = evaluated(&read(text).unwrap());
    assert!(evaluated.polynomial.coefficients[0].is_zero());
    let text = "time = 'discrete'\n[constants]\na = 0.7\nd = 'sin(a)^2 + cos(a)^2 + tan(a) - sin(a)/cos(a) - sin(2*a) + 2*sin(a)*cos(a)'\n\
        [loop]\ncharacteristic = 'z - d'\n";
    let evaluated = self::evaluated(&read(text).unwrap());
    assert!(evaluated.polynomial.coefficients[0].as_constant() == Some((-1).into()), "{:?}", evaluated.polynomial);
}

#[test]
fn known_angles_have_their_algebraic_values() {
    let text = "time = 'discrete'\n[constants]\nd = 'sin(pi/6) + cos(2*pi/3) + tan(5*pi/4) + sin(pi/4)*sqrt(2) + cos(pi)*4'\n\
        [loop]\ncharacteristic = 'z - d'\n";
    let evaluated = evaluated(&read(text).unwrap());
    let values = evaluated.symbols.values_approximate(&[]);
    // 1/2 - 1/2 + 1 + 1 - 4
    assert!((value_approximate(&evaluated.polynomial.coefficients[0], &values) - 2.0).abs() < 1e-12);
}

#[test]
fn an_lcl_filter_with_a_delay_and_a_half_loses_its_structural_zeros_by_identity() {
    let text = "time = 'discrete'\n[parameters]\nK = 1\n[loop]\ninputs = ['r']\noutputs = ['y']\n[[block]]\nname = 'filter'\n\
        input = 'K*(r - y)'\noutput = 'y'\ntransfer = '4e9/(s*(s^2 + 1.2e8))'\n\
        discretize = { method = 'zoh', T = 1e-4, delay = 1.5e-4 }\n";
    let model = read(text).unwrap();
    let evaluated = model.evaluate(&["K".into()], &[], &Budget::unlimited()).unwrap();
    let definitions: Vec<&Definition> = evaluated.symbols.iter().filter_map(|s| s.definition()).collect();
    assert!(matches!(definitions.as_slice(), [Definition::Tangent { .. }]), "{definitions:?}");
    // States: three of the filter and two past inputs.
    assert_eq!(evaluated.polynomial.formal_degree, 5);
    assert!(evaluated.polynomial.poles.is_empty(), "{:?}", evaluated.polynomial.poles);
    // K = 0: z^2 (z - 1)(z^2 - 2 cos z + 1), palindromic but for its zeros.
    let at_zero: Vec<_> =
        evaluated.polynomial.coefficients.iter().map(|c| c.substitute(0, &0.into()).unwrap()).collect();
    assert!(at_zero[0].is_zero() && at_zero[1].is_zero());
    assert_eq!(at_zero[2], -&at_zero[5]);
    assert_eq!(at_zero[3], -&at_zero[4]);
}

#[test]
fn a_free_sample_time_stays_inside_its_functions() {
    let text = "time = 'discrete'\nsample_time = 'T'\n[parameters]\nT = { nominal = 0.1, min = 0 }\n[loop]\ninputs = ['r']\n\
        [[block]]\nname = 'plant'\ninput = 'r - y'\noutput = 'y'\ntransfer = '1/((s + 1)*(s^2 + s + 4))'\n\
        discretize = { method = 'zoh', delay = '0.5*T' }\n";
    let model = read(text).unwrap();
    let moving = model.evaluate(&["T".into()], &[], &Budget::unlimited()).unwrap();
    let fixed = model.evaluate(&[], &[("T".into(), "1/10".parse().unwrap())], &Budget::unlimited()).unwrap();
    assert!(moving.symbols.is_moving() && !fixed.symbols.is_moving());
    let at = |e: &Evaluated, kept: &[f64]| -> Vec<f64> {
        let values = e.symbols.values_approximate(kept);
        e.polynomial.coefficients.iter().map(|c| value_approximate(c, &values)).collect()
    };
    for (x, y) in at(&moving, &[0.1]).iter().zip(at(&fixed, &[])) {
        assert!((x - y).abs() < 1e-9, "{x} {y}");
    }
    // A constant of the plant inside the exponential, too.
    let text = text.replace("(s + 1)", "(s + a)").replace("[parameters]", "[parameters]\na = 1");
    let model = read(&text).unwrap();
    let given = [("T".to_owned(), "1/10".parse().unwrap())];
    let moving = model.evaluate(&["a".into()], &given, &Budget::unlimited()).unwrap();
    assert!(moving.symbols.is_moving());
    for (x, y) in at(&moving, &[1.0]).iter().zip(at(&fixed, &[])) {
        assert!((x - y).abs() < 1e-9, "{x} {y}");
    }
}

#[test]
fn what_cannot_be_is_refused_with_its_place() {
    let base = "time = 'discrete'\n[parameters]\nK = 1\n[loop]\ninputs = ['u']\n[[block]]\nname = 'plant'\ninput = 'u - K*y'\n\
        output = 'y'\ntransfer = '1/(s + 1)'\n";
    let code = |line: &str| match read(&format!("{base}{line}\n")) {
        Ok(model) => match model.evaluate(&[], &[("K".into(), 1.into())], &Budget::unlimited()) {
            Err(Error::Refused(e)) => e.code(),
            other => panic!("{line}: {other:?}"),
        },
        Err(e) => e.code(),
    };
    for (line, expected) in [
        ("discretize = { method = 'zoh', T = -1 }", Code::Value),
        ("discretize = { method = 'zoh', T = 1, delay = -1 }", Code::Value),
        ("discretize = { method = 'zoh', T = 1, delay = 5000 }", Code::Value),
        ("discretize = { method = 'tustin', T = 1, delay = 1 }", Code::Discretize),
        ("discretize = { method = 'zoh', T = 1, prewarp = 1 }", Code::Discretize),
        ("discretize = { method = 'tustin', T = 1, prewarp = 1, c = 2 }", Code::Discretize),
        ("discretize = { method = 'tustin', T = 1, prewarp = 3.15 }", Code::Discretize),
        ("discretize = { method = 'tustin', T = 1, prewarp = -1 }", Code::Discretize),
        ("discretize = 'zho'", Code::Discretize),
        ("discretize = 'zoh'", Code::Discretize),
        ("discretize = { method = 'zoh', T = 'tau' }", Code::UnknownName),
    ] {
        assert_eq!(code(line), expected, "{line}");
    }
}
