//! Whether a statement about gains is true, by samples in floating point.

use crate::samples::{Plant, Values, factors, list, number, points, ranges, text, worst};
use jurist_check::format::Json;

/// What a certificate asks of gains.
struct Asks {
    bound: f64,
    require: Vec<Json>,
}

impl Asks {
    /// How far gains are from being good: a root that far beyond some boundary.
    fn worst(&self, plant: &Plant, values: &Values) -> f64 {
        let usual = if plant.time == "discrete" { 1.0 } else { 0.0 };
        let plain = worst(plant, values, &factors(None), self.bound);
        self.require.iter().map(|own| worst(plant, values, &factors(Some(own)), usual)).fold(plain, f64::max)
    }

    /// With a level beside, or in the place of the region.
    fn with(&self, level: &Json) -> Asks {
        let mut require = self.require.clone();
        match level.get("decay").or(level.get("radius")) {
            Some(bound) => Asks { bound: number(bound), require },
            None => {
                require.push(level.clone());
                Asks { bound: self.bound, require }
            }
        }
    }
}

fn polynomial(json: Option<&Json>, at: &[f64]) -> f64 {
    let count = |json: &Json| match json {
        Json::Count(n) => *n as i32,
        other => panic!("{other:?}"),
    };
    let term = |term: &Json| {
        let [c, exponents @ ..] = list(Some(term)) else { panic!("{term:?}") };
        number(c) * exponents.iter().zip(at).map(|(e, x)| x.powi(count(e))).product::<f64>()
    };
    list(json).iter().map(term).sum()
}

/// What is to be best; positive where a value is better than the one that is proved.
fn better_by(objective: &Json, at: &[f64]) -> Option<f64> {
    let (of, sign) = match (objective.get("greatest"), objective.get("least")) {
        (Some(of), _) => (of, 1.0),
        (_, Some(of)) => (of, -1.0),
        _ => return None,
    };
    let value = polynomial(of.get("above"), at) / polynomial(of.get("below"), at);
    Some(sign * (value - number(objective.get("proved")?)))
}

/// Whether a certificate says nothing that samples contradict.
pub fn is_true(plant: &Plant, certificate: &str) -> bool {
    const SLACK: f64 = 1e-6;
    let json = Json::parse(certificate).expect("it was accepted");
    let of = json.get("statement").expect("a statement");
    assert_eq!(text(of.get("kind")), "tune");
    let gains = ranges(of.get("gains"));
    let Some(Json::Object(set)) = of.get("set") else { panic!("no set") };
    let set: Values = set.iter().map(|(name, x)| (name.clone(), number(x))).collect();
    let with_set = |at: &Values| -> Values { at.iter().chain(&set).map(|(name, x)| (name.clone(), *x)).collect() };
    let region = of.get("region").expect("a region");
    let bound = number(region.get("decay").or(region.get("radius")).expect("a bound"));
    let required = Asks { bound, require: list(of.get("require")).to_vec() };
    let objective = of.get("objective").expect("an objective");
    let none = objective.get("level").map_or_else(|| required.with_none(), |level| required.with(level));
    let in_order = |at: &Values| -> Vec<f64> { gains.iter().map(|(name, _)| at[name]).collect() };
    let is_bad = |at: &Values| {
        // What is as good as what is proved: next to it rounding decides.
        let is_asked = better_by(objective, &in_order(at)).is_none_or(|x| x > 1e-9);
        // A grid of factors may miss the worst by a little.
        !is_asked || none.worst(plant, &with_set(at)) > -0.05
    };
    let is_found = of.get("found").filter(|found| **found != Json::Null).is_none_or(|found| {
        let point = gains.iter().zip(list(found.get("point")));
        let at: Values = point.map(|((name, _), x)| (name.clone(), number(x))).collect();
        let level = found.get("level").filter(|level| **level != Json::Null);
        let has = level.map_or_else(|| required.with_none(), |level| required.with(level));
        has.worst(plant, &with_set(&at)) < SLACK
            && gains.iter().all(|(name, [low, high])| (low - SLACK..=high + SLACK).contains(&at[name]))
    });
    is_found && points(&gains).iter().all(is_bad)
}

impl Asks {
    fn with_none(&self) -> Asks {
        Asks { bound: self.bound, require: self.require.clone() }
    }
}
