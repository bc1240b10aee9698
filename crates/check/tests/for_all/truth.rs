//! Whether a statement is true, by samples in floating point.

use crate::samples::{Plant, Range, Values, factors, list, number, points, ranges, text, worst};
use jurist_check::format::Json;
use std::collections::BTreeMap;

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
    let set: Values = set.iter().map(|(name, x)| (name.clone(), number(x))).collect();
    let require = list(of.get("require"));
    let families: Vec<_> =
        if require.is_empty() { vec![factors(None)] } else { require.iter().map(|r| factors(Some(r))).collect() };
    let bound = if text(of.get("time")) == "discrete" { 1.0 } else { 0.0 };
    // Over all factors.
    let worst =
        |values: &Values| families.iter().map(|own| worst(plant, values, own, bound)).fold(f64::NEG_INFINITY, f64::max);
    let with = |a: &Values, b: &Values| -> Values {
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
