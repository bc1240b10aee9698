//! Margins of loops with complex coefficients: random ones, each margin against a second way. A rotation, a factor or a number of samples just inside of a
//! margin leaves the loop stable by the criterion of Schur and Cohn, and just outside it does not; extremes are those of a fine grid.

use super::oracle::{Complex, is_hurwitz, is_schur, plus, times};
use crate::helpers::model::read;
use crate::helpers::number::ratio;
use crate::helpers::random::Random;
use crate::helpers::thorough;
use jurist::Ask;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::real::Real;
use jurist_engine::response::{DelayMargin, Direction, Margins, Place, Rotation};

type C = nalgebra::Complex<f64>;

/// An open loop `N/D` with coefficients from the constant term up, in eighths.
#[derive(Clone, Debug)]
pub struct Open {
    pub d: Vec<[i64; 2]>,
    pub n: Vec<[i64; 2]>,
    pub is_discrete: bool,
}

impl Open {
    /// The degree of `N` is at most that of `D`, and less in continuous time.
    pub fn random(random: &mut Random, is_discrete: bool) -> Open {
        let order = 1 + random.below(3);
        let mut part = |most: i64| random.below(2 * most as usize + 1) as i64 - most;
        let shift = if is_discrete { 0 } else { 8 };
        let mut d: Vec<[i64; 2]> = (0..order).map(|_| [part(8) + shift, part(8)]).collect();
        let n = (0..order + usize::from(is_discrete)).map(|_| [part(12), part(12)]).collect();
        d.push([8, 0]);
        // Some have an integrator.
        if order > 1 && part(2) == 2 {
            let at = |k: usize, i: usize| d.get(k).map_or(0, |c: &[i64; 2]| c[i]);
            let root = i64::from(is_discrete);
            d = (0..=order)
                .map(|k| [0, 1].map(|i| k.checked_sub(1).map_or(0, |k| at(k + 1, i)) - root * at(k + 1, i)))
                .collect();
        }
        Open { d, n, is_discrete }
    }

    /// The text with this sign before the imaginary unit.
    pub fn text(&self, sign: i64) -> String {
        let (time, x) = if self.is_discrete { ("discrete", "z") } else { ("continuous", "s") };
        let written = |p: &[[i64; 2]]| {
            let terms = p.iter().enumerate().map(|(k, c)| format!("({} + {}*j)/8*{x}^{k}", c[0], sign * c[1]));
            terms.collect::<Vec<_>>().join(" + ")
        };
        format!(
            "time = '{time}'\n[parameters]\nK = 1\n[loop]\ninputs = ['r']\noutputs = ['y']\n[[block]]\nname = 'L'\ninput = 'r - y'\noutput = 'y'\n\
             transfer = 'K*({})/({})'\n",
            written(&self.n),
            written(&self.d)
        )
    }

    /// `z^m D + c N`.
    fn closed(&self, m: usize, c: &Complex) -> Vec<Complex> {
        let number = |c: &[i64; 2]| [ratio(c[0], 8), ratio(c[1], 8)];
        let zero = [Rational::ZERO, Rational::ZERO];
        let mut sum = vec![zero; m + self.d.len()];
        self.d.iter().enumerate().for_each(|(k, x)| sum[m + k] = number(x));
        self.n.iter().enumerate().for_each(|(k, x)| sum[k] = plus(&sum[k], &times(c, &number(x))));
        sum
    }

    fn is_stable(&self, m: usize, c: &Complex) -> bool {
        let polynomial = self.closed(m, c);
        let is_lost = polynomial.last().is_some_and(|c| c.iter().all(Rational::is_zero));
        !is_lost && if self.is_discrete { is_schur(&polynomial) } else { is_hurwitz(&polynomial) }
    }

    pub fn at(&self, place: f64) -> C {
        let x = if self.is_discrete { C::from_polar(1.0, place) } else { C::new(0.0, place) };
        let value =
            |p: &[[i64; 2]]| p.iter().rev().fold(C::default(), |sum, c| sum * x + C::new(c[0] as f64, c[1] as f64));
        value(&self.n) / value(&self.d)
    }

    /// Angles, or frequencies, of a grid.
    pub fn grid(&self) -> impl Iterator<Item = f64> + '_ {
        const POINTS: i32 = 4000;
        let angle = |k: i32| f64::from(k) * std::f64::consts::PI / f64::from(POINTS);
        let places =
            (-POINTS + 1..POINTS).map(move |k| if self.is_discrete { angle(k) } else { (angle(k) / 2.0).tan() });
        places.filter(|x| self.at(*x).is_finite())
    }

    pub fn margins(&self, text: &str) -> Margins {
        let answer = read(text).ask().margins(None, &Rational::ZERO, &Budget::unlimited());
        answer.unwrap_or_else(|e| panic!("{e}\n{text}")).into_value()
    }
}

/// The signed angle or frequency at a place.
fn rate(margins: &Margins, place: &Place) -> Option<f64> {
    let frequency = margins.frequency(place, 60)?;
    let found = frequency.angle.or(frequency.radians_per_second)?;
    Some(found.lower().midpoint(found.upper()).to_f64_approximate())
}

fn value(x: &Real) -> f64 {
    let (lo, hi) = x.refined_to_digits(17).enclosure();
    lo.midpoint(&hi).to_f64_approximate()
}

/// Rational numbers just below and above.
fn beside(x: &Real) -> [Rational; 2] {
    let near = Rational::dyadic(&Integer::ONE, 40);
    let (lo, hi) = x.refined(&near).enclosure();
    [&lo - &near, &hi + &near]
}

/// `exp(j phi)` by the cotangent of half the angle, or its conjugate.
fn turned(cotangent: &Rational, sign: i64) -> Complex {
    let square = cotangent * cotangent;
    let below = &square + &Rational::ONE;
    let sine = &(cotangent + cotangent) * &Rational::from(sign);
    [(&square - &Rational::ONE).checked_div(&below).unwrap(), sine.checked_div(&below).unwrap()]
}

/// A greater cotangent is a smaller angle.
fn check_rotation(of: &Open, margins: &Margins, rotation: &Rotation, sign: i64) {
    let [beyond, within] = beside(&rotation.cotangent);
    // Where the modulus only touches one the loop is stable beyond, and not at the margin itself.
    let touches = margins.crossings.gain.iter().any(|c| c.direction == Direction::Touching);
    let beyond = rotation.cotangent.exact().filter(|_| touches).unwrap_or(beyond);
    for more in [0, 1, 2, 5, 20, 100] {
        let less = turned(&(&within + &ratio(more, 4)), sign);
        assert!(of.is_stable(0, &less), "{of:?} turned by {sign} less than {rotation:?}");
    }
    assert!(!of.is_stable(0, &turned(&beyond, sign)), "{of:?} turned by {sign} more than {rotation:?}");
}

fn check_gain(of: &Open, margins: &Margins) {
    let gain = &margins.stable.as_ref().unwrap().gain;
    let real = |k: Rational| [k, Rational::ZERO];
    for (end, [inside, outside]) in [(&gain.upper, [0, 1]), (&gain.lower, [1, 0])] {
        let Some(end) = end else { continue };
        let sides = beside(&end.value);
        assert!(of.is_stable(0, &real(sides[inside].clone())), "{of:?} {end:?}");
        assert!(!of.is_stable(0, &real(sides[outside].clone())), "{of:?} {end:?}");
        // With the factor 0 a pole of the open loop is on the boundary.
        if let Some(frequency) = margins.frequency_of(end, 60).filter(|_| !end.value.sign().is_eq()) {
            let place = frequency.angle.or(frequency.radians_per_second).unwrap();
            let place = place.lower().to_f64_approximate();
            let found = of.at(place) * value(&end.value);
            assert!((found + 1.0).norm() < 1e-6, "{of:?}: {found} at {place}");
        }
    }
    for k in -40..40 {
        let k = ratio(8 * k + 3, 64);
        assert_eq!(gain.set.contains(&k), of.is_stable(0, &real(k.clone())), "{of:?} at {k}");
    }
}

fn check_extremes(of: &Open, margins: &Margins) {
    let stable = margins.stable.as_ref().unwrap();
    let norm = read(&of.text(1)).ask().norm("r", "y", &Budget::unlimited()).unwrap().into_value();
    let norm = norm.peak.expect("the loop is stable");
    assert!(norm.value.is_same(&stable.peak_complementary), "{of:?}: {norm:?}");
    let extreme = |f: &dyn Fn(C) -> f64| of.grid().map(|x| f(of.at(x))).filter(|x| x.is_finite()).fold(0.0, f64::max);
    let largest = |l: C| 1.0 / (l + 1.0).norm();
    for (found, of_grid) in [
        (value(&stable.peak_sensitivity), extreme(&largest)),
        (value(&stable.peak_complementary), extreme(&|l| (l / (l + 1.0)).norm())),
        (stable.disk.alpha.as_ref().map_or(0.0, |a| 1.0 / value(a)), extreme(&|l| (0.5 - 1.0 / (l + 1.0)).norm())),
    ] {
        // The higher a peak the narrower it is.
        let missed = 1e-3 + 1e-5 * found * found;
        assert!(of_grid <= found * (1.0 + 1e-9) && of_grid >= found * (1.0 - missed), "{of:?}: {found} {of_grid}");
    }
    if let Some(place) = stable.modulus_at.place().and_then(|place| rate(margins, place)) {
        assert!((of.at(place) + 1.0).norm() < value(&stable.modulus) * (1.0 + 1e-6), "{of:?} at {place}");
    }
}

fn check_crossings(of: &Open, margins: &Margins) {
    let crossings = &margins.crossings;
    let places: Vec<f64> = crossings.gain.iter().filter_map(|c| rate(margins, &c.place)).collect();
    assert!(places.windows(2).all(|w| w[0] < w[1]), "{places:?}");
    assert!(places.iter().all(|x| (of.at(*x).norm() - 1.0).abs() < 1e-9), "{of:?}: {places:?}");
    let excess: Vec<bool> = of.grid().map(|x| of.at(x).norm() > 1.0).collect();
    let changes = excess.iter().zip(excess.iter().cycle().skip(1)).filter(|(a, b)| a != b).count();
    let passed = crossings.gain.iter().filter(|c| c.direction != Direction::Touching).count();
    assert!(changes <= passed && (passed - changes).is_multiple_of(2), "{of:?}: {changes} {places:?}");
    for c in &crossings.phase {
        let Some(place) = rate(margins, &c.place) else { continue };
        let k = c.factor.enclosure(60).lower().to_f64_approximate();
        assert!((of.at(place) * k + 1.0).norm() < 1e-6, "{of:?} at {place}: {k}");
    }
    let passes = |x: f64| of.at(x).im > 0.0;
    let negative = of.grid().zip(of.grid().skip(1)).filter(|(a, b)| passes(*a) != passes(*b) && of.at(*a).re < 0.0);
    // At a pole or a zero it changes its sign without being real and negative.
    let near = negative.filter(|(a, _)| (1e-2..20.0).contains(&of.at(*a).norm())).count();
    assert!(near <= crossings.phase.len(), "{of:?}: {near} {:?}", crossings.phase);
}

/// How often the open loop with this dead time turns around -1, on a grid that is finer next to one frequency.
fn turns(of: &Open, tau: f64, near: f64) -> i64 {
    let mut grid: Vec<f64> = of.grid().collect();
    grid.extend((1..4000).flat_map(|k| [1.0, -1.0].map(|sign| near + sign * near.abs() * 1.002f64.powi(-k))));
    grid.retain(|x| x.abs() < 200.0 / tau.max(0.1));
    grid.sort_by(f64::total_cmp);
    let values: Vec<C> = grid.iter().map(|x| 1.0 + of.at(*x) * C::from_polar(1.0, -x * tau)).collect();
    let sum: f64 = values.windows(2).map(|w| (w[1] / w[0]).arg()).sum();
    (sum / (2.0 * std::f64::consts::PI)).round() as i64
}

/// The number of samples, if a bound has been found.
fn check_delay(of: &Open, margins: &Margins) -> bool {
    let one = [Rational::ONE, Rational::ZERO];
    match &margins.stable.as_ref().unwrap().delay {
        DelayMargin::Unbounded if of.is_discrete => {
            assert!((1..20).all(|m| of.is_stable(m, &one)), "{of:?}");
            false
        }
        DelayMargin::Samples(m) => {
            let m = *m as usize;
            assert!((1..=m.min(20)).all(|m| of.is_stable(m, &one)), "{of:?}: {m}");
            assert!(m > 20 || !of.is_stable(m + 1, &one), "{of:?}: {m}");
            true
        }
        DelayMargin::DeadTime(i) => {
            let crossing = &margins.crossings.gain[*i];
            let tau = crossing.delay(margins.open_loop.frequencies(), 60).unwrap().lower().to_f64_approximate();
            let place = rate(margins, &crossing.place).unwrap();
            // A grid does not go around a pole on the axis.
            let has_pole = of.grid().any(|x| of.at(x).norm() > 500.0);
            let touches = crossing.direction == Direction::Touching;
            if !has_pole && !touches && tau < 40.0 {
                let [less, more] = [0.995, 1.005].map(|share| turns(of, share * tau, place));
                assert!(less == turns(of, 0.0, place) && more != less, "{of:?}: {tau} at {place}: {less} {more}");
            }
            place < 0.0
        }
        _ => false,
    }
}

#[test]
#[ignore = "long: CI runs it"]
fn margins_of_random_loops_agree_with_a_second_way() {
    let count =
        std::env::var("JURIST_COMPLEX_LOOPS").ok().and_then(|n| n.parse().ok()).unwrap_or(thorough::count(12, 60));
    let mut random = Random::new(1932);
    let (mut stable, mut rotations, mut delays, mut below) = (0, 0, 0, 0);
    while stable < count {
        let of = Open::random(&mut random, stable % 2 == 0);
        if !of.is_stable(0, &[Rational::ONE, Rational::ZERO]) || of.n.iter().all(|c| *c == [0, 0]) {
            continue;
        }
        let margins = of.margins(&of.text(1));
        let found = margins.stable.as_ref().unwrap_or_else(|| panic!("{of:?}"));
        stable += 1;
        if let Some(both) = &found.one_sided {
            for (rotation, sign) in [(&both.lag, -1), (&both.lead, 1)] {
                let Some(rotation) = rotation else { continue };
                check_rotation(&of, &margins, rotation, sign);
                rotations += 1;
                let place = rotation.place.as_ref().and_then(|place| rate(&margins, place));
                below += usize::from(place.is_some_and(|place| place < 0.0));
            }
        }
        check_gain(&of, &margins);
        check_extremes(&of, &margins);
        check_crossings(&of, &margins);
        delays += usize::from(check_delay(&of, &margins));
    }
    assert!(rotations > stable && below > stable / 4 && delays > stable / 8, "{stable} {rotations} {below} {delays}");
}
