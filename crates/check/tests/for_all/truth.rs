//! Whether a statement is true, by samples in floating point: roots of `den + f num` for factors of the family, and values of names in their ranges.

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

/// How far the farthest root is beyond the boundary; all of them by the method of Weierstrass.
fn beyond(polynomial: &[Complex], discrete: bool) -> f64 {
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
    let of = |root: &Complex| if discrete { modulus(*root) - 1.0 } else { root[0] };
    roots.iter().map(of).fold(f64::NEG_INFINITY, f64::max)
}

fn number(json: &Json) -> f64 {
    let Json::Text(text) = json else { panic!("{json:?}") };
    let mut parts = text.split('/').map(|part| part.parse::<f64>().expect("a number"));
    parts.next().unwrap_or(0.0) / parts.next().unwrap_or(1.0)
}

fn list(json: Option<&Json>) -> &[Json] {
    match json {
        Some(Json::List(all)) => all,
        other => panic!("{other:?}"),
    }
}

fn text(json: Option<&Json>) -> &str {
    match json {
        Some(Json::Text(text)) => text,
        other => panic!("{other:?}"),
    }
}

type Range = (String, [f64; 2]);

fn ranges(json: Option<&Json>) -> Vec<Range> {
    let side = |range: &Json| {
        let between = list(range.get("between"));
        (text(range.get("name")).to_owned(), [number(&between[0]), number(&between[1])])
    };
    list(json).iter().map(side).collect()
}

/// Factors of a requirement; none has no factor but 1.
fn factors(requirement: Option<&Json>) -> Vec<Complex> {
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
fn points(ranges: &[Range]) -> Vec<BTreeMap<String, f64>> {
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

/// The number of proofs of a leaf `+`.
fn proofs(require: &[Json], has_names: bool) -> usize {
    let is_of_disc = |of: &Json| !["phase_margin", "gain_margin"].contains(&text(of.get("kind")));
    require.iter().map(|of| if has_names && is_of_disc(of) { 3 } else { 1 }).sum::<usize>().max(1)
}

/// The leaves of a tree with their boxes, proofs and steps left out.
fn leaves(tree: &str, axes: &[Range], proofs: usize) -> Vec<(char, Vec<Range>)> {
    let (mut letters, mut out, mut stack) = (tree.chars(), Vec::new(), vec![axes.to_vec()]);
    while let Some(own) = stack.pop() {
        let letter = letters.next().expect("a tree");
        match letter {
            '+' => {
                let mut open = proofs;
                while open > 0 {
                    if letters.next().expect("a proof") == '.' { open -= 1 } else { open += 1 }
                }
            }
            '-' => while letters.next().expect("steps") != '.' {},
            '?' => {}
            axis => {
                let k = axis as usize - 'a' as usize;
                let [low, high] = own[k].1;
                let halves = [[(low + high) / 2.0, high], [low, (low + high) / 2.0]];
                stack.extend(halves.map(|side| {
                    let mut half = own.clone();
                    half[k].1 = side;
                    half
                }));
                continue;
            }
        }
        out.push((letter, own));
    }
    out
}

/// Whether a certificate says nothing that samples contradict.
pub fn is_true(plant: &Plant, certificate: &str) -> bool {
    const SLACK: f64 = 1e-6;
    let json = Json::parse(certificate).expect("it was accepted");
    let of = json.get("statement").expect("a statement");
    let (axes, for_all) = (ranges(of.get("axes")), ranges(of.get("for_all")));
    let Some(Json::Object(set)) = of.get("set") else { panic!("no set") };
    let set: BTreeMap<String, f64> = set.iter().map(|(name, x)| (name.clone(), number(x))).collect();
    let require = list(of.get("require"));
    let families: Vec<Vec<Complex>> =
        if require.is_empty() { vec![factors(None)] } else { require.iter().map(|r| factors(Some(r))).collect() };
    let discrete = text(of.get("time")) == "discrete";
    // How far the worst root is beyond, over all factors.
    let worst = |values: &BTreeMap<String, f64>| {
        let [den, num] = (plant.open)(values);
        let closed = |f: &Complex| -> f64 {
            let sum: Vec<Complex> = (0..den.len().max(num.len()))
                .map(|k| {
                    let at = |p: &[Complex]| p.get(k).copied().unwrap_or([0.0, 0.0]);
                    plus(at(&den), times(at(&num), *f))
                })
                .collect();
            beyond(&sum, discrete)
        };
        families.iter().flatten().map(closed).fold(f64::NEG_INFINITY, f64::max)
    };
    let with = |a: &BTreeMap<String, f64>, b: &BTreeMap<String, f64>| -> BTreeMap<String, f64> {
        a.iter().chain(b).chain(&set).map(|(name, x)| (name.clone(), *x)).collect()
    };
    let inner = points(&for_all);
    let all_good = leaves(text(of.get("tree")), &axes, proofs(require, !axes.is_empty() || !for_all.is_empty()))
        .into_iter()
        .all(|(letter, own)| {
            points(&own).iter().all(|at| {
                let most = || inner.iter().map(|values| worst(&with(at, values))).fold(f64::NEG_INFINITY, f64::max);
                match letter {
                    '+' => most() < SLACK,
                    // A grid of factors may miss the worst by a little.
                    '-' => most() > -0.05,
                    _ => true,
                }
            })
        });
    let beyond = of.get("beyond").filter(|beyond| **beyond != Json::Null);
    all_good
        && beyond.is_none_or(|beyond| {
            let point = list(beyond.get("point")).iter().zip(&for_all);
            worst(&with(&point.map(|(x, (name, _))| (name.clone(), number(x))).collect(), &BTreeMap::new())) > -0.05
        })
}
