//! A small writer of certificates of best gains, for tests: it tries ends and middles of what factors have, and halves.

use crate::samples::Plant;
use jurist_check::{JudgedBox, Limits, Part, TuneJudge};
use std::rc::Rc;
use std::time::Duration;

pub const LIMITS: Limits = Limits::within(Duration::MAX);

/// The first gain as what is to be best.
pub const GAIN: &str = r#"{"above": [["1", 1]], "below": [["1"]]}"#;

/// What is asked, in the text of a statement.
#[derive(Clone)]
pub struct Asked {
    pub plant: Rc<Plant>,
    gains: String,
    region: &'static str,
    require: String,
    objective: String,
    found: Option<(String, String)>,
}

fn loop_of(time: &str, transfer: &str, names: &str, more: &str) -> String {
    format!(
        "time = '{time}'\nparameters = {{ {names} }}\n[loop]\ninputs = ['r']\n[[block]]\nname = 'plant'\ninput = 'r - y'\noutput = 'y'\ntransfer = '{transfer}'\n{more}"
    )
}

fn asked(plant: Plant, gains: &str) -> Asked {
    let region = if plant.time == "discrete" { r#"{"radius": "1"}"# } else { r#"{"decay": "0"}"# };
    let (gains, objective) = (gains.to_owned(), "null".to_owned());
    Asked { plant: Rc::new(plant), gains, region, require: String::new(), objective, found: None }
}

fn range(name: &str, low: &str, high: &str) -> String {
    format!(r#"{{"name": "{name}", "between": ["{low}", "{high}"]}}"#)
}

/// `K/(s (s + 1) (s + 2))`.
pub fn one() -> Asked {
    let plant = Plant {
        model: loop_of("continuous", "K/(s*(s + 1)*(s + 2))", "K = {}", ""),
        time: "continuous",
        open: Rc::new(|of| [[0.0, 2.0, 3.0, 1.0].map(|x| [x, 0.0]).to_vec(), vec![[of["K"], 0.0]]]),
    };
    asked(plant, &range("K", "1/8", "20"))
}

/// `K/(s (s + a) (s/5 + 1))`.
pub fn two() -> Asked {
    let plant = Plant {
        model: loop_of("continuous", "K/(s*(s + a)*(s/5 + 1))", "K = {}, a = {}", ""),
        time: "continuous",
        open: Rc::new(|of| {
            let (k, a) = (of["K"], of["a"]);
            [vec![[0.0, 0.0], [a, 0.0], [1.0 + a / 5.0, 0.0], [0.2, 0.0]], vec![[k, 0.0]]]
        }),
    };
    asked(plant, &format!("{}, {}", range("K", "1/2", "8"), range("a", "1/2", "2")))
}

/// `K/(z (z - a))`.
pub fn sampled() -> Asked {
    let plant = Plant {
        model: loop_of("discrete", "K/(z*(z - a))", "K = {}, a = {}", ""),
        time: "discrete",
        open: Rc::new(|of| [vec![[0.0, 0.0], [-of["a"], 0.0], [1.0, 0.0]], vec![[of["K"], 0.0]]]),
    };
    asked(plant, &format!("{}, {}", range("K", "1/2", "4"), range("a", "1/2", "1")))
}

/// `K/(s + a)` behind a hold.
pub fn held() -> Asked {
    let plant = Plant {
        model: "sample_time = 1\n".to_owned()
            + &loop_of("discrete", "K/(s + a)", "K = {}, a = {}", "discretize = 'zoh'\n"),
        time: "discrete",
        open: Rc::new(|of| {
            let (a, decay) = (of["a"], (-of["a"]).exp());
            let share = if a == 0.0 { 1.0 } else { (1.0 - decay) / a };
            [vec![[-decay, 0.0], [1.0, 0.0]], vec![[of["K"] * share, 0.0]]]
        }),
    };
    asked(plant, &format!("{}, {}", range("K", "1/2", "8"), range("a", "1/2", "1")))
}

/// A requirement on the loop cut at the input of the plant.
pub fn at_input(kind: &str, bound: &str) -> String {
    format!(r#"{{"kind": "{kind}", "at": {{"input": "plant"}}, "bound": "{bound}"}}"#)
}

/// A phase margin, of a whole number of degrees.
pub fn phase(degrees: u32) -> String {
    let tangent = (f64::from(degrees).to_radians() / 2.0).tan();
    let [below, above] = [(tangent * 1e6).floor(), (tangent * 1e6).ceil()];
    format!(
        r#"{{"kind": "phase_margin", "at": {{"input": "plant"}}, "bound": "{degrees}", "turns": ["{below}/1000000", "{above}/1000000"]}}"#
    )
}

impl Asked {
    pub fn between(self, low: &str, high: &str) -> Self {
        Asked { gains: range("K", low, high), ..self }
    }

    pub fn require(self, require: &str) -> Self {
        Asked { require: require.to_owned(), ..self }
    }

    pub fn region(self, region: &'static str) -> Self {
        Asked { region, ..self }
    }

    pub fn objective(self, objective: &str) -> Self {
        Asked { objective: objective.to_owned(), ..self }
    }

    pub fn found(self, k: &str, level: &str) -> Self {
        self.found_at(&[k], level)
    }

    pub fn found_at(self, point: &[&str], level: &str) -> Self {
        let point = point.iter().map(|x| format!("\"{x}\"")).collect::<Vec<_>>().join(", ");
        Asked { found: Some((point, level.to_owned())), ..self }
    }

    pub fn certificate(&self, tree: &str, proof: &str) -> String {
        let found = self.found.as_ref().map_or("null".to_owned(), |(point, level)| {
            format!(r#"{{"point": [{point}], "level": {level}, "proof": "{proof}"}}"#)
        });
        format!(
            r#"{{"schema": "jurist/certificate/11", "statement": {{"kind": "tune", "time": "{}", "gains": [{}], "set": {{}}, "region": {}, "require": [{}],
                "objective": {}, "found": {found}, "tree": "{tree}"}}, "order": 3, "bits": 128}}"#,
            self.plant.time, self.gains, self.region, self.require, self.objective
        )
    }

    /// With what the judge sees; `None` where it does not see it in cells that are not too small.
    pub fn written(&self) -> Option<String> {
        let judge = TuneJudge::new(&self.plant.model, &self.certificate("", ""), &LIMITS);
        let judge = judge.unwrap_or_else(|e| panic!("{e}\n{}", self.certificate("", "")));
        let mut proof = String::new();
        for k in judge.of_found() {
            for whole in judge.proofs_of_found(k) {
                proof += &proved(&judge, k, whole)?;
            }
        }
        Some(self.certificate(&tree(&judge, &judge.whole(0), 24, &mut Vec::new())?, &proof))
    }
}

fn letter(axis: usize) -> char {
    char::from(b'a' + axis as u8)
}

fn proved(judge: &TuneJudge, k: usize, whole: JudgedBox) -> Option<String> {
    let (mut out, mut stack) = (String::new(), vec![whole]);
    for _ in 0..300 {
        let Some(mut part) = stack.pop() else { return Some(out) };
        if judge.loops().shows(k, &mut part, true) {
            out.push('.');
            continue;
        }
        let sides = judge.loops().sides(&part);
        let axis = judge.loops().axis(k, &part);
        let axis = if sides[axis][0] == sides[axis][1] { sides.iter().position(|[a, b]| a != b)? } else { axis };
        out.push(letter(axis));
        let [low, high] = judge.loops().halves(k, &mut part, axis);
        stack.extend([high, low]);
    }
    None
}

/// How a cell is refuted: the loop, steps, and how far the boundary is moved.
type Way = (usize, String, Option<i64>);

fn refuted(judge: &TuneJudge, cell: &JudgedBox, (k, steps, exponent): &Way) -> bool {
    let mut part = judge.loops().over(cell, *k);
    let letters: Vec<char> = steps.chars().collect();
    for step in letters.chunks(2) {
        let of = Part::ALL.into_iter().find(|part| part.letter() == step[0]).expect("a step");
        part = judge.loops().part(&part, of, step[1] as usize - 'a' as usize);
    }
    match exponent {
        None => judge.loops().shows(*k, &mut part, false),
        Some(exponent) => judge.has_root_beyond(*k, &mut part, *exponent),
    }
}

/// Ends and middles of all own names.
fn ways(judge: &TuneJudge, gains: usize) -> Vec<Way> {
    let mut out = Vec::new();
    for k in 0..judge.refutable() {
        let mut steps = vec![String::new()];
        for name in gains..judge.loops().names(k) {
            let places = |part: &String| {
                ["<", ">", "m", "l?m", "u?m", "l?l?m", "l?u?m", "u?l?m", "u?u?m"].map(|place| {
                    let own = place.replace('?', &letter(name).to_string());
                    format!("{part}{own}{}", letter(name))
                })
            };
            steps = steps.iter().flat_map(places).collect();
        }
        out.extend(steps.iter().map(|steps| (k, steps.clone(), None)));
        out.extend([-6, -3].map(|exponent| (k, steps[0].clone(), Some(exponent))));
    }
    out
}

fn tree(judge: &TuneJudge, cell: &JudgedBox, depth: usize, recent: &mut Vec<Way>) -> Option<String> {
    if judge.is_worse(cell) {
        return Some("o".to_owned());
    }
    let gains = judge.loops().names(0);
    let all = ways(judge, gains);
    if let Some(way) = recent.iter().chain(&all).find(|way| refuted(judge, cell, way)).cloned() {
        let begin = way.2.map_or("-".to_owned(), |exponent| format!("s{exponent};"));
        let leaf = format!("{begin}{}{}.", way.0, way.1);
        recent.insert(0, way);
        recent.truncate(3);
        return Some(leaf);
    }
    let axis = judge.widest(cell).filter(|_| depth > 0)?;
    let mut out = letter(axis).to_string();
    for half in [Part::Lower, Part::Upper] {
        out += &tree(judge, &judge.loops().part(cell, half, axis), depth - 1, recent)?;
    }
    Some(out)
}
