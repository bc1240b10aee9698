//! Samples in floating point: roots of `den + f num` for factors of a family, and values of names in their ranges.

use jurist_check::format::Json;
use std::collections::BTreeMap;

pub type Complex = [f64; 2];

fn times([a, b]: Complex, [c, d]: Complex) -> Complex {
    [a * c - b * d, a * d + b * c]
}

fn over(x: Complex, [c, d]: Complex) -> Complex {
    let n = c * c + d * d;
    times(x, [c / n, -d / n])
}

fn plus([a, b]: Complex, [c, d]: Complex) -> Complex {
    [a + c, b + d]
}

fn minus([a, b]: Complex, [c, d]: Complex) -> Complex {
    [a - c, b - d]
}

fn turn(angle: f64) -> Complex {
    [angle.cos(), angle.sin()]
}

fn modulus([a, b]: Complex) -> f64 {
    a.hypot(b)
}

/// A loop whose open loop is `num/den`, coefficients from the constant term up, for values of its names.
pub struct Plant {
    pub model: String,
    pub time: &'static str,
    pub open: Open,
}

pub type Open = std::rc::Rc<dyn Fn(&BTreeMap<String, f64>) -> [Vec<Complex>; 2]>;

/// How far the farthest root is beyond the boundary of the region of a radius, or of a decay rate; all of them by the method of Weierstrass.
fn beyond(polynomial: &[Complex], discrete: bool, bound: f64) -> f64 {
    let n = polynomial.len() - 1;
    let lead = polynomial[n];
    if modulus(lead) < 1e-12 {
        return 1.0;
    }
    let monic: Vec<Complex> = polynomial.iter().map(|c| over(*c, lead)).collect();
    let radius = 1.0 + monic[..n].iter().map(|c| modulus(*c)).fold(0.0, f64::max);
    let mut roots: Vec<Complex> = (0..n).map(|k| times([radius * 0.7, 0.0], turn(0.4 + k as f64 * 2.4))).collect();
    for _ in 0..400 {
        for i in 0..n {
            let value = monic.iter().rev().fold([0.0, 0.0], |sum, c| plus(times(sum, roots[i]), *c));
            let apart = (0..n).filter(|k| *k != i).fold([1.0, 0.0], |all, k| times(all, minus(roots[i], roots[k])));
            if modulus(apart) > 1e-30 {
                roots[i] = minus(roots[i], over(value, apart));
            }
        }
    }
    let of = |root: &Complex| if discrete { modulus(*root) - bound } else { root[0] + bound };
    roots.iter().map(of).fold(f64::NEG_INFINITY, f64::max)
}

pub fn number(json: &Json) -> f64 {
    let Json::Text(text) = json else { panic!("{json:?}") };
    let mut parts = text.split('/').map(|part| part.parse::<f64>().expect("a number"));
    parts.next().unwrap_or(0.0) / parts.next().unwrap_or(1.0)
}

pub fn list(json: Option<&Json>) -> &[Json] {
    match json {
        Some(Json::List(all)) => all,
        other => panic!("{other:?}"),
    }
}

pub fn text(json: Option<&Json>) -> &str {
    match json {
        Some(Json::Text(text)) => text,
        other => panic!("{other:?}"),
    }
}

pub type Range = (String, [f64; 2]);

pub fn ranges(json: Option<&Json>) -> Vec<Range> {
    let side = |range: &Json| {
        let between = list(range.get("between"));
        (text(range.get("name")).to_owned(), [number(&between[0]), number(&between[1])])
    };
    list(json).iter().map(side).collect()
}

/// Factors of a requirement; none has no factor but 1.
pub fn factors(requirement: Option<&Json>) -> Vec<Complex> {
    let Some(of) = requirement else { return vec![[1.0, 0.0]] };
    let bound = number(of.get("bound").expect("a bound"));
    let shares = (0..=24).map(|k| f64::from(k) / 24.0);
    let circle = || {
        (0..64)
            .flat_map(|k| [0.0, 0.5, 1.0].map(|r| times([r, 0.0], turn(f64::from(k) / 64.0 * std::f64::consts::TAU))))
    };
    let one = [1.0, 0.0];
    match text(of.get("kind")) {
        "gain_margin" => shares.map(|x| [bound.powf(2.0 * x - 1.0), 0.0]).collect(),
        "phase_margin" => shares.map(|x| turn((2.0 * x - 1.0) * bound.to_radians())).collect(),
        "modulus_margin" => circle().map(|d| over(one, minus(one, times([bound, 0.0], d)))).collect(),
        "disk_margin" => {
            let half = |d| times([bound / 2.0, 0.0], d);
            circle().map(|d| over(plus(one, half(d)), minus(one, half(d)))).collect()
        }
        _ => circle().map(|d| plus(one, over(d, [bound, 0.0]))).collect(),
    }
}

/// Points of a box: its corners, and some inside.
pub fn points(ranges: &[Range]) -> Vec<BTreeMap<String, f64>> {
    let mut all = vec![BTreeMap::new()];
    for (name, [low, high]) in ranges {
        let at = |x: f64| (name.clone(), low + (high - low) * x);
        let extended = |point: BTreeMap<String, f64>| {
            [0.0, 0.17, 0.5, 0.83, 1.0].map(|x| point.clone().into_iter().chain([at(x)]).collect::<BTreeMap<_, _>>())
        };
        all = all.into_iter().flat_map(extended).collect();
    }
    all
}

/// Names with values.
pub type Values = BTreeMap<String, f64>;

/// How far the worst root is beyond the boundary of a region, over some factors.
pub fn worst(plant: &Plant, values: &Values, factors: &[Complex], bound: f64) -> f64 {
    let [den, num] = (plant.open)(values);
    let closed = |f: &Complex| -> f64 {
        let at = |p: &[Complex], k: usize| p.get(k).copied().unwrap_or([0.0, 0.0]);
        let sum = |k: usize| plus(at(&den, k), times(at(&num, k), *f));
        let all: Vec<Complex> = (0..den.len().max(num.len())).map(sum).collect();
        beyond(&all, plant.time == "discrete", bound)
    };
    factors.iter().map(closed).fold(f64::NEG_INFINITY, f64::max)
}
