//! Models with singular cases, their certificates, and mutations.

use jurist::Ask;
use jurist::Certificate;
pub mod checkers;
pub mod forgeries;
pub mod python;

use super::model::read;
use super::number::number;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::parse_number;
use jurist_check::format::Json;
use jurist_engine::error::Code;
use jurist_engine::problem::Region;
use jurist_engine::stability::Range;

/// Name, text, parameter.
pub const MODELS: &[(&str, &str, &str)] = &[
    ("first order", "time = 'discrete'\nparameters.K = {}\nloop.characteristic = 'z - 1 + K'", "K"),
    ("constant", "time = 'discrete'\nparameters.K = {}\nloop.characteristic = '(K - 1)*K'", "K"),
    ("touching", "time = 'discrete'\nparameters.K = {}\nloop.characteristic = 'z^2 + 1 - K^2'", "K"),
    ("irrational touching", "time = 'discrete'\nparameters.K = {}\nloop.characteristic = 'z^2 + 1 - (K^2 - 2)^2'", "K"),
    ("pole", "time = 'discrete'\nparameters.K = {}\nloop.characteristic = 'z + K/2*(K - 1)/(K - 1)'", "K"),
    (
        "irrational pole",
        "time = 'discrete'\nparameters.K = {}\nconstants.unused = '1/(K^2 - 1/2)'\nloop.characteristic = 'z + K/2'",
        "K",
    ),
    ("degree lost", "time = 'discrete'\nparameters.K = {}\nloop.characteristic = '(K - 1)*z^2 + z + K/2'", "K"),
    ("degree lost, continuous", "time = 'continuous'\nparameters.K = {}\nloop.characteristic = 'K*s^2 + s + 1'", "K"),
    ("never: root at 1", "time = 'discrete'\nparameters.K = {}\nloop.characteristic = '(z - 1)*(z + K)'", "K"),
    (
        "never: mirror pair",
        "time = 'discrete'\nparameters.K = {}\nloop.characteristic = '(z^2 - z/2 + 1)*(z + K)'",
        "K",
    ),
    (
        "never: mirror pair off the circle",
        "time = 'discrete'\nparameters.K = {}\nloop.characteristic = '(z - K)*(K*z - 1)*(z - 1/2)'",
        "K",
    ),
    ("never: zero", "time = 'discrete'\nparameters.K = {}\nloop.characteristic = '0'", "K"),
    (
        "never: degree lost by a value",
        "time = 'discrete'\nparameters.K = {}\nparameters.T = { nominal = 1 }\nloop.characteristic = '(T - 1)*z^2 + z + K'",
        "K",
    ),
    (
        "undefined by a value",
        "time = 'discrete'\nparameters.K = {}\nparameters.T = { nominal = 1 }\nloop.characteristic = 'z + K/(T - 1)'",
        "K",
    ),
    (
        "third order",
        "time = 'discrete'\nparameters.K = {}\nloop.characteristic = 'z^3 - (K - 1/10)*z^2 + 1/2*z + K^2/3'",
        "K",
    ),
    (
        "continuous",
        "time = 'continuous'\nparameters.K = { min = -3 }\nloop.characteristic = 's^4 + 4*s^3 + 6*s^2 + 4*s + 1 + K'",
        "K",
    ),
    // D(1) = (1 - K)(1 + K)^2: its square-free part alone does not make it up.
    (
        "roots of two multiplicities",
        "time = 'discrete'\nparameters.K = { min = 0 }\nloop.characteristic = '(z - K)*(z + K)*(z^2 + K)'",
        "K",
    ),
    (
        "matrix",
        "time = 'discrete'\nparameters.K = { min = 0 }\nparameters.T = { nominal = 0.1 }\nloop.matrix = [[1, 'T'], ['-K*T/(K + 1)', '1 - K*T']]",
        "K",
    ),
    (
        "feedback",
        "time = 'continuous'\nparameters.K = { max = 100 }\n[loop]\nA = [[0, 1], [0, -1]]\nB = [[0], [1]]\nC = [[1, 0], [0, 1]]\nK = [['K', '1/K']]",
        "K",
    ),
    (
        "blocks",
        "time = 'discrete'\nparameters.K = {}\n[loop]\ninputs = ['r']\noutputs = ['y']\n[[block]]\nname = 'c'\ninput = 'r - y'\noutput = 'e'\ntransfer = '1 + 1/(z - 1) + K/(z^2 - 1)'\n[[block]]\nname = 'd'\ninput = 'e'\noutput = 'f'\ndelay = 1\n[[block]]\nname = 'p'\ninput = 'f/4'\noutput = 'y'\nA = [['-K']]\nB = [[1]]\ndiscretize = { method = 'tustin', T = 0.5 }",
        "K",
    ),
    (
        "discretised",
        "time = 'discrete'\nparameters.K = {}\nparameters.T = { nominal = '1/10', min = 0 }\n[loop]\ninputs = ['r']\n[[block]]\ninput = 'r - K*x'\noutput = 'y'\nnum = [1, 2]\nden = [1, '1/K', 1]\ndiscretize = { method = 'backward', T = 'T' }\n[[block]]\ninput = 'y'\noutput = 'x'\ntransfer = '3/(s + 4)'\ndiscretize = { method = 'forward', T = 'T' }",
        "K",
    ),
];

/// The engine's certificate for the stable set.
pub fn emitted(model: &str, parameter: &str) -> String {
    let budget = Budget::unlimited();
    let answer = read(model).ask().free(parameter).stable_set(&budget).expect(model);
    answer.certificate(&budget).expect("no limit")
}

/// The same; `None` where there is no certificate of this kind of model yet.
pub fn emitted_if_any(model: &str, parameter: &str) -> Option<String> {
    let budget = Budget::unlimited();
    let answer = read(model).ask().free(parameter).stable_set(&budget).expect(model);
    match answer.certificate(&budget) {
        Ok(text) => Some(text),
        Err(jurist_engine::error::Error::Refused(why))
            if [Code::NoCertificate, Code::Complex].contains(&why.code()) =>
        {
            None
        }
        Err(other) => panic!("{model}: {other}"),
    }
}

/// The engine's certificate for the verdict at a value.
pub fn verdict_emitted(model: &str, parameter: &str, value: &str) -> String {
    let budget = Budget::unlimited();
    let answer = read(model).ask().set(parameter, number(value)).verdict(&budget).expect(model);
    answer.certificate(&budget).expect(model)
}

/// The first occurrence of a text replaced, which must be there.
pub fn with(certificate: &str, from: &str, to: &str) -> String {
    assert!(certificate.contains(from), "{from} in\n{certificate}");
    certificate.replacen(from, to, 1)
}

/// One count of a verdict's statement raised by one.
pub fn with_count_changed(certificate: &str, key: &str) -> String {
    let mut json = Json::parse(certificate).unwrap();
    if let Some(Json::Count(n)) = at(&mut json, &["statement", key]) {
        *n += 1;
    }
    json.to_text()
}

fn at<'j>(json: &'j mut Json, path: &[&str]) -> Option<&'j mut Json> {
    path.iter().try_fold(json, |json, key| match json {
        Json::Object(pairs) => pairs.iter_mut().find(|(k, _)| k == key).map(|(_, v)| v),
        _ => None,
    })
}

/// A place in a document, by positions.
type Path = Vec<usize>;

/// All documents that differ from one in one value: numbers changed in several ways, labels turned, entries left out, doubled and
/// swapped, keys left out.
pub struct Mutations<'j> {
    original: &'j Json,
    /// Where, and what stands there instead.
    changes: Vec<(Path, Json)>,
}

impl Mutations<'_> {
    /// One in so many of the documents, each made when its turn comes.
    pub fn one_in(&self, every: usize) -> impl Iterator<Item = Json> {
        self.changes.iter().step_by(every).map(|(path, value)| {
            let mut copy = self.original.clone();
            *inside(&mut copy, path) = value.clone();
            copy
        })
    }
}

pub fn mutations(original: &Json) -> Mutations<'_> {
    let mut changes = Vec::new();
    if let Json::Object(pairs) = original {
        for (i, (_, value)) in pairs.iter().enumerate() {
            list_changes(value, &mut vec![i], &mut changes);
        }
    }
    Mutations { original, changes }
}

fn inside<'j>(json: &'j mut Json, path: &[usize]) -> &'j mut Json {
    path.iter().fold(json, |json, &i| match json {
        Json::List(items) => &mut items[i],
        Json::Object(pairs) => &mut pairs[i].1,
        _ => unreachable!("paths lead through lists and objects"),
    })
}

fn list_changes(value: &Json, path: &mut Path, changes: &mut Vec<(Path, Json)>) {
    let mut here = |path: &Path, value: Json| changes.push((path.clone(), value));
    match value {
        Json::Null => here(path, Json::Text("0".into())),
        Json::Bool(b) => here(path, Json::Bool(!b)),
        Json::Count(n) => [n + 1, n.wrapping_sub(1).min(9)].into_iter().for_each(|n| here(path, Json::Count(n))),
        Json::Text(text) => {
            let mut out = vec![format!("-{text}"), format!("1{text}"), format!("{text}0"), "0".into(), "1/7".into()];
            if let Ok(q) = parse_number(text) {
                out.extend([1, -1].map(|d| (&q + &jurist_algebra::number::Rational::from(d)).to_string()));
            }
            out.into_iter().filter(|t| t != text).for_each(|t| here(path, Json::Text(t)));
        }
        Json::List(items) => {
            for (i, item) in items.iter().enumerate() {
                path.push(i);
                list_changes(item, path, changes);
                path.pop();
                let mut without = items.clone();
                without.remove(i);
                changes.push((path.clone(), Json::List(without)));
                let mut doubled = items.clone();
                doubled.insert(i, item.clone());
                changes.push((path.clone(), Json::List(doubled)));
                if i > 0 && items[i] != items[i - 1] {
                    let mut swapped = items.clone();
                    swapped.swap(i, i - 1);
                    changes.push((path.clone(), Json::List(swapped)));
                }
            }
        }
        Json::Object(pairs) => {
            for (i, (_, value)) in pairs.iter().enumerate() {
                path.push(i);
                list_changes(value, path, changes);
                path.pop();
                let mut without = pairs.clone();
                without.remove(i);
                changes.push((path.clone(), Json::Object(without)));
            }
        }
    }
}

/// Whether the engine, asked the question of a certificate's statement, gives the claimed set or verdict.
pub fn is_true(model: &str, certificate: &Json) -> bool {
    let Some(statement) = certificate.get("statement") else { return false };
    let text = |json: &Json| match json {
        Json::Text(text) => Some(text.clone()),
        _ => None,
    };
    let number = |json: &Json| text(json).map(|t| number(&t));
    let mut question = read(model).ask();
    if let Some(Json::Object(pairs)) = statement.get("set") {
        question = question.set_all(pairs.iter().map(|(name, value)| (name, number(value).unwrap())));
    }
    if let Some(region) = statement.get("region") {
        let bound = |name: &str| region.get(name).and_then(number);
        question = match (bound("radius"), bound("decay")) {
            (Some(radius), None) => match Region::disc(radius) {
                Ok(disc) => question.within(disc),
                Err(_) => return false,
            },
            (None, Some(decay)) => question.within(Region::half_plane(decay)),
            (None, None) => question,
            (Some(_), Some(_)) => return false,
        };
    }
    let budget = Budget::unlimited();
    if statement.get("kind").and_then(text).as_deref() == Some("verdict") {
        let Ok(answer) = question.verdict(&budget) else { return false };
        let (time, answer) = (answer.problem().time(), answer.value());
        let found = answer.count.unwrap_or_default();
        let counts = [
            ("degree", answer.degree),
            ("inside", found.inside),
            ("on", found.on),
            ("outside", found.outside),
            ("infinite", answer.infinite),
        ];
        return statement.get("time").and_then(text).as_deref() == Some(time.name())
            && statement.get("verdict").and_then(text).as_deref() == Some(answer.verdict.name())
            && counts.iter().all(|(key, n)| statement.get(key) == Some(&Json::Count(*n as u32)));
    }
    let Some(parameter) = statement.get("parameter").and_then(text) else { return false };
    let bound = |key: &str| statement.get("domain").and_then(|d| d.get(key)).and_then(number);
    let domain = Range::between(bound("lower"), bound("upper"));
    let Ok(answer) = question.domain(&parameter, domain).free(&parameter).stable_set(&budget) else { return false };
    let set = answer.value();
    let Some(Json::List(claimed)) = statement.get("stable") else { return false };
    let matches_end = |json: Option<&Json>, end: Option<&jurist_engine::stability::End>| match (json, end) {
        (Some(Json::Null), None) => true,
        (Some(Json::Text(text)), Some(end)) => end.value.exact() == Some(parse_number(text).unwrap()),
        (Some(other), Some(end)) => {
            let Some(Json::List(ab)) = other.get("between") else { return false };
            let side = |i: usize| ab.get(i).and_then(number).unwrap();
            let Some(Json::List(coefficients)) = other.get("polynomial") else { return false };
            let coefficients = coefficients.iter().map(|c| number(c).unwrap().numerator()).collect();
            let f = jurist_algebra::poly::UniPoly::new(coefficients);
            end.value.compare_rational(&side(0)).is_gt()
                && end.value.compare_rational(&side(1)).is_lt()
                && end.value.algebraic().is_some_and(|x| x.sign_of(&f).is_eq())
        }
        _ => false,
    };
    claimed.len() == set.intervals().len()
        && claimed.iter().zip(set.intervals()).all(|(json, interval)| {
            matches_end(json.get("lower"), interval.lower.as_ref())
                && matches_end(json.get("upper"), interval.upper.as_ref())
        })
}
