//! Where a loop is likely to be most unstable: for a choice of what is proved, and no proof.

use jurist_check::{JudgedBox, Part, TuneJudge};

/// What of the own names of a loop refutes gains: the number of the loop, steps to a point, and by which power of two the boundary may be moved outwards.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Guess {
    pub number: usize,
    pub steps: Vec<(Part, usize)>,
    pub exponent: Option<i64>,
}

/// A side is cut into so many parts at first, and the best of them so often in two.
const FIRST: u64 = 4;
const LAST: u64 = 17;

/// So often all roots are corrected.
const ROUNDS: usize = 60;

/// The point of a side that is a number of parts from its lower end, of `2^level` parts.
fn steps(at: u64, level: u64, name: usize) -> Vec<(Part, usize)> {
    if at == 0 {
        return vec![(Part::Low, name)];
    }
    if at == 1 << level {
        return vec![(Part::High, name)];
    }
    let few = at.trailing_zeros().min(level as u32 - 1);
    let (at, level) = (at >> few, level - u64::from(few));
    // An odd number of parts: the middle of what the leading digits lead to.
    let half = |k: u64| if at >> k & 1 == 1 { Part::Upper } else { Part::Lower };
    (1..level).rev().map(|k| (half(k), name)).chain([(Part::Middle, name)]).collect()
}

/// The likeliest point of the own names of a loop that is not stable, and how far beyond the boundary a root is there: 0 where that is not known.
pub(super) fn most_unstable(judge: &TuneJudge, k: usize, gains: usize, middle: &JudgedBox) -> Option<(Guess, f64)> {
    match judge.coefficients_approximate(k, &mut middle.clone()) {
        Some(_) => by_roots(judge, k, gains, middle).filter(|(_, abscissa)| *abscissa > 0.0),
        None => by_trial(judge, k, gains, middle).map(|guess| (guess, 0.0)),
    }
}

/// A side has so many places that are tried where roots are not known, as a power of two.
const TRIED: u64 = 4;

/// The first of some points at which the loop is shown to be unstable.
fn by_trial(judge: &TuneJudge, k: usize, gains: usize, middle: &JudgedBox) -> Option<Guess> {
    let own = judge.loops().names(k) - gains;
    let radii: &[Option<Part>] = if own == 2 { &[Some(Part::High), Some(Part::Low)] } else { &[None] };
    let turns: Vec<Vec<(Part, usize)>> = match own {
        0 => vec![Vec::new()],
        _ => (0..=1 << TRIED).rev().map(|at| steps(at, TRIED, gains + own - 1)).collect(),
    };
    let all =
        radii.iter().flat_map(|radius| turns.iter().map(move |turn| (radius.map(|end| (end, gains)), turn.clone())));
    let mut all =
        all.map(|(radius, turn)| Guess { number: k, steps: radius.into_iter().chain(turn).collect(), exponent: None });
    all.find(|guess| judge.loops().shows(k, &mut guess.part(judge, middle), false))
}

/// A place of the own names, and how far beyond the boundary a root is there.
struct Place {
    radius: Option<Part>,
    /// So many parts of the last side from its lower end.
    at: u64,
    abscissa: f64,
    guess: Guess,
}

/// The point at which a root is farthest beyond, as far as halving finds it.
fn by_roots(judge: &TuneJudge, k: usize, gains: usize, middle: &JudgedBox) -> Option<(Guess, f64)> {
    let own = judge.loops().names(k) - gains;
    let radii: &[Option<Part>] = if own == 2 { &[Some(Part::High), Some(Part::Low)] } else { &[None] };
    let look = |radius: Option<Part>, turn: Vec<(Part, usize)>, at: u64| {
        let steps = radius.map(|end| (end, gains)).into_iter().chain(turn).collect();
        let guess = Guess { number: k, steps, exponent: None };
        let coefficients = judge.coefficients_approximate(k, &mut guess.part(judge, middle))?;
        let abscissa = abscissa_approximate(&coefficients)?;
        Some(Place { radius, at, abscissa, guess })
    };
    if own == 0 {
        return look(None, Vec::new(), 0).map(|place| (place.guess, place.abscissa));
    }
    let turned = |radius: Option<Part>, at: u64, level: u64| look(radius, steps(at, level, gains + own - 1), at);
    let better = |a: Place, b: Place| if b.abscissa > a.abscissa { b } else { a };
    let first = radii.iter().flat_map(|radius| (0..=1 << FIRST).filter_map(|at| turned(*radius, at, FIRST)));
    let mut best = first.reduce(better)?;
    for level in FIRST + 1..=LAST {
        best.at *= 2;
        let near = [best.at.checked_sub(1), (best.at < 1 << level).then_some(best.at + 1)];
        let radius = best.radius;
        best = near.into_iter().flatten().filter_map(|at| turned(radius, at, level)).fold(best, better);
    }
    Some((best.guess, best.abscissa))
}

impl Guess {
    /// The part of a box of the loop that it leads to.
    pub fn part(&self, judge: &TuneJudge, whole: &JudgedBox) -> JudgedBox {
        self.steps.iter().fold(whole.clone(), |part, (step, name)| judge.loops().part(&part, *step, *name))
    }
}

/// The greatest real part of a root, by the method of Aberth.
pub(super) fn abscissa_approximate(p: &[f64]) -> Option<f64> {
    let n = p.len() - 1;
    if n == 0 || p[n] == 0.0 || p.iter().any(|c| !c.is_finite()) {
        return None;
    }
    let size = (p[0] / p[n]).abs().powf(1.0 / n as f64);
    let size = if size > 0.0 && size.is_finite() { size } else { 1.0 };
    let monic: Vec<f64> = (0..=n).map(|k| p[k] / p[n] * size.powi(k as i32 - n as i32)).collect();
    let bound = 1.0 + monic[..n].iter().fold(0.0_f64, |most, c| most.max(c.abs()));
    let mut roots: Vec<[f64; 2]> = (0..n)
        .map(|k| {
            let (angle, radius) = (0.4 + k as f64 * 2.4, bound.min(1.0 + k as f64 / n as f64));
            [radius * angle.cos(), radius * angle.sin()]
        })
        .collect();
    for _ in 0..ROUNDS {
        let mut most = 0.0_f64;
        for i in 0..n {
            let z = roots[i];
            let (mut value, mut slope) = ([0.0, 0.0], [0.0, 0.0]);
            for c in monic.iter().rev() {
                slope = plus(times(slope, z), value);
                value = plus(times(value, z), [*c, 0.0]);
            }
            let newton = over(value, slope);
            let others = (0..n)
                .filter(|&k| k != i)
                .fold([0.0, 0.0], |sum, k| plus(sum, over([1.0, 0.0], [z[0] - roots[k][0], z[1] - roots[k][1]])));
            let product = times(newton, others);
            let step = over(newton, [1.0 - product[0], -product[1]]);
            if step.iter().all(|x| x.is_finite()) {
                roots[i] = [z[0] - step[0], z[1] - step[1]];
                most = most.max(step[0].hypot(step[1]));
            }
        }
        if most < 1e-13 {
            break;
        }
    }
    Some(size * roots.iter().fold(f64::NEG_INFINITY, |most, z| most.max(z[0])))
}

fn plus(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] + b[0], a[1] + b[1]]
}

fn times(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
}

fn over(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    let n = b[0] * b[0] + b[1] * b[1];
    let c = times(a, [b[0], -b[1]]);
    [c[0] / n, c[1] / n]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn abscissas_are_those_of_known_roots() {
        // (s + 1)(s - 3)(s^2 + 2 s + 5)
        let known = [-15.0, -16.0, -2.0, 0.0, 1.0];
        assert!((abscissa_approximate(&known).unwrap() - 3.0).abs() < 1e-9);
        let scaled: Vec<f64> = known.iter().zip(0..).map(|(c, k)| c * 1e6_f64.powi(-k)).collect();
        assert!((abscissa_approximate(&scaled).unwrap() - 3e6).abs() < 1e-3);
        assert_eq!(abscissa_approximate(&[1.0]), None);
        assert_eq!(abscissa_approximate(&[1.0, 0.0]), None);
    }

    #[test]
    fn steps_lead_to_the_points_that_they_are_made_for() {
        for level in 1..6_u64 {
            for at in 0..=1 << level {
                let (mut low, mut high) = (0.0, f64::from(1 << level));
                for (step, _) in steps(at, level, 3) {
                    let middle = (low + high) / 2.0;
                    (low, high) = match step {
                        Part::Lower => (low, middle),
                        Part::Upper => (middle, high),
                        Part::Middle => (middle, middle),
                        Part::Low => (low, low),
                        Part::High => (high, high),
                    };
                }
                assert_eq!((low, high), (at as f64, at as f64), "{at} of {level}");
            }
        }
    }
}
