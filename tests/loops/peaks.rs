//! Peaks over frequency by ways that know nothing of critical points: eigenvalues of Hamiltonian matrices in floating point, and a search
//! for the minimum at sixty digits.

use crate::helpers::model::{example, read};
use crate::helpers::thorough::tried;
use jurist::Ask;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Enclosure, Integer, Rational};
use jurist_engine::model::{Model, Time};
use jurist_engine::response::OpenLoop;
use jurist_engine::stability::Shape;
use nalgebra::DMatrix;

/// Time, numerator and denominator of the open loop, the highest power first.
const LOOPS: [(Time, &[i64], &[i64]); 8] = [
    (Time::Continuous, &[4], &[1, 3, 3, 1]),
    (Time::Continuous, &[5], &[1, 1, 25, 0]),
    (Time::Continuous, &[3, 1], &[1, 1, 1, 0]),
    (Time::Continuous, &[1, 2, 40, 3], &[1, 9, 33, 51, 26]),
    (Time::Discrete, &[1], &[2, -1, 0]),
    (Time::Discrete, &[11, -10], &[1000, -1900, 900, 0, 0]),
    (Time::Discrete, &[1, 0, 1], &[100, -180, 90, 0, 0]),
    (Time::Discrete, &[-3, 2], &[20, -9, 4, 1, 0]),
];

fn model(time: Time, numerator: &[i64], denominator: &[i64]) -> Model {
    let list = |c: &[i64]| c.iter().map(i64::to_string).collect::<Vec<_>>().join(", ");
    read(&format!(
        "time = '{}'\n[loop]\ninputs = ['r']\noutputs = ['y']\n[[block]]\nname = 'L'\ninput = 'r - y'\noutput = 'y'\nnum = [{}]\n\
         den = [{}]\n",
        time.name(),
        list(numerator),
        list(denominator)
    ))
}

/// A polynomial with the lowest power first at `z = (1 + s)/(1 - s)`, times `(1 - s)^n`: the circle becomes the axis.
fn on_axis(p: &[f64], n: usize) -> Vec<f64> {
    let times = |a: &[f64], b: &[f64]| {
        let mut out = vec![0.0; a.len() + b.len() - 1];
        for (i, x) in a.iter().enumerate() {
            for (j, y) in b.iter().enumerate() {
                out[i + j] += x * y;
            }
        }
        out
    };
    let mut sum = vec![0.0; n + 1];
    for (k, c) in p.iter().enumerate() {
        let up = (0..k).fold(vec![1.0], |q, _| times(&q, &[1.0, 1.0]));
        let term = (k..n).fold(up, |q, _| times(&q, &[1.0, -1.0]));
        for (s, t) in sum.iter_mut().zip(term) {
            *s += c * t;
        }
    }
    sum
}

/// The norm of a stable transfer function in `s` by bisection: the Hamiltonian matrix of a bound has eigenvalues on the imaginary axis
/// just when the gain reaches it somewhere (Boyd, Balakrishnan and Kabamba 1989).
fn norm_by_hamiltonians(numerator: &[f64], denominator: &[f64]) -> f64 {
    let n = denominator.len() - 1;
    let lead = denominator[n];
    let through = numerator.get(n).copied().unwrap_or(0.0) / lead;
    let a = DMatrix::from_fn(n, n, |i, j| match (i + 1 == n, j == i + 1) {
        (true, _) => -denominator[j] / lead,
        (false, true) => 1.0,
        (false, false) => 0.0,
    });
    let b = DMatrix::from_fn(n, 1, |i, _| if i + 1 == n { 1.0 } else { 0.0 });
    let c = DMatrix::from_fn(1, n, |_, j| (numerator.get(j).copied().unwrap_or(0.0) - through * denominator[j]) / lead);
    let reached = |bound: f64| {
        let r = bound * bound - through * through;
        let upper = &a + &b * &c * (through / r);
        let right = &b * b.transpose() / r;
        let left = -(c.transpose() * &c) * (1.0 + through * through / r);
        let mut h = DMatrix::zeros(2 * n, 2 * n);
        h.view_mut((0, 0), (n, n)).copy_from(&upper);
        h.view_mut((0, n), (n, n)).copy_from(&right);
        h.view_mut((n, 0), (n, n)).copy_from(&left);
        h.view_mut((n, n), (n, n)).copy_from(&-upper.transpose());
        h.complex_eigenvalues().iter().any(|x| x.re.abs() < 1e-7 * (1.0 + x.norm()))
    };
    let (mut low, mut high) = (through.abs() * (1.0 + 1e-9) + 1e-9, 1e6);
    for _ in 0..60 {
        let middle = (low * high).sqrt();
        if reached(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

#[test]
fn peak_gains_are_those_of_hamiltonian_matrices() {
    for (time, numerator, denominator) in LOOPS {
        let low_first = |c: &[i64]| c.iter().rev().map(|x| *x as f64).collect::<Vec<_>>();
        let (n, d) = (low_first(numerator), low_first(denominator));
        let closed: Vec<f64> = d.iter().enumerate().map(|(i, x)| x + n.get(i).copied().unwrap_or(0.0)).collect();
        let order = closed.len() - 1;
        let [above, below] = match time {
            Time::Continuous => [n, closed],
            Time::Discrete => [on_axis(&n, order), on_axis(&closed, order)],
        };
        let asked = model(time, numerator, denominator).ask();
        let peak = asked.norm("r", "y", &Budget::unlimited()).unwrap().into_value().peak.expect("stable");
        let exact = peak.value.refined_to_digits(17).enclosure().0.to_f64_approximate();
        let bound = norm_by_hamiltonians(&above, &below);
        assert!((bound / exact - 1.0).abs() < 1e-5, "{numerator:?}/{denominator:?}: {bound} {exact}");
    }
}

/// Bits of the search: what is lost at its flat minimum is the square of what is left of the interval.
const BITS: u64 = 320;

/// `|1 + L|^2`, by the value of the open loop at a point of the boundary.
fn distance_squared(open_loop: &OpenLoop, x: &Rational) -> Option<Rational> {
    let (real, imaginary) = open_loop.value_at(x, BITS)?;
    let middle = |e: Enclosure| e.lower().midpoint(e.upper());
    let (real, imaginary) = (middle(real) + Rational::ONE, middle(imaginary));
    // The imaginary part is given over sin theta, or over omega.
    let square = match open_loop.shape() {
        Shape::UnitDisc => Rational::ONE - x * x * Rational::new(Integer::ONE, Integer::from(4)),
        Shape::LeftHalfPlane => -x,
    };
    Some(&real * &real + &imaginary * &imaginary * square)
}

fn rounded(x: &Rational) -> Rational {
    let scaled = x * &Rational::from(2).pow(BITS as i64).expect("two is not zero");
    Rational::from(scaled.floor()) * Rational::dyadic(&Integer::ONE, BITS)
}

/// The least value by the golden section between the neighbours of the best of many points.
fn least_distance_squared(open_loop: &OpenLoop) -> Rational {
    let point = |i: i64| match open_loop.shape() {
        Shape::UnitDisc => Rational::new(Integer::from(i - 2000), Integer::from(1000)),
        // From fast to slow.
        Shape::LeftHalfPlane => -Rational::new(Integer::from(4000 - i), Integer::from(i + 1)),
    };
    let value = |x: &Rational| distance_squared(open_loop, x);
    let best = (0..=4000).filter_map(|i| Some((value(&point(i))?, i))).min().expect("no pole everywhere").1;
    let (mut lo, mut hi) = (point((best - 1).max(0)), point((best + 1).min(4000)));
    // (sqrt(5) - 1)/2 to some digits: any number between 1/2 and 1 will do.
    let ratio = Rational::new(Integer::from(618_033_988_749i64), Integer::from(1_000_000_000_000i64));
    while &hi - &lo > Rational::dyadic(&Integer::ONE, 112) {
        let step = rounded(&((&hi - &lo) * &ratio));
        let (a, b) = (&hi - &step, &lo + &step);
        if value(&a).expect("no pole") < value(&b).expect("no pole") {
            hi = b;
        } else {
            lo = a;
        }
    }
    [lo.midpoint(&hi), lo, hi].iter().filter_map(value).min().expect("no pole")
}

#[test]
fn modulus_margins_are_the_minimum_of_a_search_to_sixty_digits() {
    let budget = Budget::unlimited();
    let mut models: Vec<Model> = LOOPS.iter().map(|(time, n, d)| model(*time, n, d)).collect();
    models.insert(1, example("dc-servo"));
    for model in tried(models, 2) {
        let answer = model.ask().margins(None, &Rational::ZERO, &budget).unwrap();
        let open_loop = &answer.value().open_loop;
        let modulus = answer.value().stable.as_ref().expect("stable").modulus.refined_to_digits(64).enclosure().0;
        let difference = (&modulus * &modulus - least_distance_squared(open_loop)).abs();
        assert!(difference < Rational::from(10).pow(-60).unwrap(), "{modulus:?} {difference:?}");
    }
}

/// The closed loop at a frequency as a matrix in floating point: states by `j omega`, dead times by their exponentials.
fn gain_at(blocks: &[(f64, f64, f64)], k: f64, omega: f64) -> f64 {
    // Of the paths K c exp(-tau s)/(T s + 1) from the error back to it, the first is the output.
    let path = |(c, time, tau): &(f64, f64, f64)| {
        let (size, turn) = (c / (1.0 + (time * omega).powi(2)).sqrt(), -tau * omega - (time * omega).atan());
        [size * turn.cos(), size * turn.sin()]
    };
    let paths: Vec<[f64; 2]> = blocks.iter().map(path).collect();
    let sum = paths.iter().fold([1.0, 0.0], |sum, p| [sum[0] + k * p[0], sum[1] + k * p[1]]);
    k * paths[0][0].hypot(paths[0][1]) / sum[0].hypot(sum[1])
}

/// Dead time in the feedback, and several dead times, against a dense grid of frequencies.
#[test]
fn peaks_with_dead_time_in_the_feedback_are_those_of_a_dense_grid() {
    for (k, blocks) in [
        (2.0, vec![(1.0, 1.0, 0.5)]),
        (1.0, vec![(1.0, 3.0, 1.0)]),
        // A predictor of a wrong dead time: 1 - exp(-5 s) beside exp(-6 s).
        (2.0, vec![(1.0, 2.0, 6.0), (1.0, 2.0, 0.0), (-1.0, 2.0, 5.0)]),
        (0.5, vec![(2.0, 1.0, 0.5), (1.0, 4.0, 1.5)]),
    ] {
        let plants: Vec<String> = blocks
            .iter()
            .enumerate()
            .map(|(i, (c, time, tau))| {
                format!("[[block]]\ninput = 'u'\noutput = 'y{i}'\ntransfer = '{c}*exp(-{tau}*s)/({time}*s + 1)'\n")
            })
            .collect();
        let error = (0..blocks.len()).fold("r".to_owned(), |text, i| text + &format!(" - y{i}"));
        let model = read(&format!(
            "time = 'continuous'\n[loop]\ninputs = ['r']\noutputs = ['y0']\n[[block]]\ninput = '{error}'\noutput = 'u'\ngain = '{k}'\n{}",
            plants.concat()
        ));
        let found = model.ask().norm("r", "y0", &Budget::unlimited()).unwrap();
        let value: f64 = found.value().peak.as_ref().expect("a stable loop").value.decimal(12).parse().unwrap();
        let grid = (0..200_000).map(|i| gain_at(&blocks, k, f64::from(i) * 1e-4)).fold(0.0, f64::max);
        assert!((value - grid).abs() < 1e-6 * grid, "{blocks:?}: {value} {grid}");
    }
}

/// Nothing but dead time between input and output: the peak is that of what stands before it, and a pure dead time has modulus one everywhere.
#[test]
fn a_modulus_that_is_the_same_everywhere_is_a_peak() {
    let model = read(
        "time = 'continuous'\n[loop]\ninputs = ['r']\noutputs = ['y', 'z']\n[[block]]\ninput = 'r'\noutput = 'y'\ntransfer = '3*exp(-s)'\n\
         [[block]]\ninput = 'r - z'\noutput = 'z'\ntransfer = 'exp(-s)/(s + 1)'\n",
    );
    let peak = |output: &str| model.ask().norm("r", output, &Budget::unlimited()).unwrap().into_value().peak.unwrap();
    assert_eq!(peak("y").value.decimal(6), "3");
    assert!(peak("z").value.compare_rational(&"1/2".parse().unwrap()).is_gt());
}
