//! A small writer of certificates for all values, for tests: it asks the judge, and halves where that does not see.

use jurist_check::{ForAllJudge, JudgedBox, Limits, Part, check};
use std::time::Duration;

pub const LIMITS: Limits = Limits::within(Duration::MAX);

/// What is asked, in the text of a statement.
#[derive(Clone, Debug)]
pub struct Asked {
    pub time: &'static str,
    pub axes: &'static str,
    pub for_all: &'static str,
    pub set: &'static str,
    pub require: String,
    pub beyond: &'static str,
    pub order: usize,
}

impl Asked {
    pub fn of(time: &'static str) -> Self {
        Asked { time, axes: "", for_all: "", set: "", require: String::new(), beyond: "null", order: 3 }
    }

    pub fn axes(self, axes: &'static str) -> Self {
        Asked { axes, ..self }
    }

    pub fn for_all(self, for_all: &'static str) -> Self {
        Asked { for_all, ..self }
    }

    pub fn set(self, set: &'static str) -> Self {
        Asked { set, ..self }
    }

    pub fn beyond(self, beyond: &'static str) -> Self {
        Asked { beyond, ..self }
    }

    pub fn require(self, require: impl Into<String>) -> Self {
        Asked { require: require.into(), ..self }
    }

    pub fn certificate(&self, tree: &str) -> String {
        let region = if self.time == "discrete" { r#"{"radius": "1"}"# } else { r#"{"decay": "0"}"# };
        format!(
            r#"{{"schema": "jurist/certificate/10", "statement": {{"kind": "for_all", "time": "{}", "axes": [{}], "for_all": [{}], "set": {{{}}},
                "region": {region}, "require": [{}], "tree": "{tree}", "beyond": {}}}, "order": {}, "bits": 128}}"#,
            self.time, self.axes, self.for_all, self.set, self.require, self.beyond, self.order
        )
    }

    pub fn judge(&self, model: &str) -> ForAllJudge {
        ForAllJudge::new(model, &self.certificate("?"), &LIMITS).unwrap_or_else(|e| panic!("{e}"))
    }
}

fn letter(axis: usize) -> char {
    char::from(b'a' + axis as u8)
}

/// The proof of a loop over a box, with so many parts at most.
pub fn proof(judge: &ForAllJudge, k: usize, part: JudgedBox, most: &mut usize) -> Option<String> {
    let (mut out, mut stack) = (String::new(), vec![part]);
    while let Some(mut part) = stack.pop() {
        *most = most.checked_sub(1)?;
        if judge.shows(k, &mut part, true) {
            out.push('.');
            continue;
        }
        let sides = judge.sides(&part);
        let axis = judge.axis(k, &part);
        let axis = if sides[axis][0] == sides[axis][1] { sides.iter().position(|[a, b]| a != b)? } else { axis };
        out.push(letter(axis));
        let [low, high] = judge.halves(k, &mut part, axis);
        stack.extend([high, low]);
    }
    Some(out)
}

/// The steps to a part in which a loop is nowhere stable.
fn steps(judge: &ForAllJudge, k: usize, axes: usize, part: JudgedBox, most: usize) -> Option<String> {
    let mut open = vec![(part, String::new())];
    for _ in 0..=most {
        let mut next = Vec::new();
        for (part, steps) in &mut open {
            if judge.shows(k, part, false) {
                return Some(format!("-{k}{steps}."));
            }
            let sides = judge.sides(part);
            for axis in (axes..judge.names(k)).filter(|&axis| sides[axis][0] != sides[axis][1]) {
                for step in Part::ALL {
                    next.push((judge.part(part, step, axis), format!("{steps}{}{}", step.letter(), letter(axis))));
                }
            }
        }
        open = next;
    }
    None
}

/// What is shown of all points of some axes, halved so often at most.
fn tree(judge: &ForAllJudge, axes: usize, part: &JudgedBox, depth: usize, most: usize) -> String {
    // Refutations are short, or proofs are.
    let refuted = |most| (0..judge.loops()).find_map(|k| steps(judge, k, axes, judge.over(part, k), most));
    let proved = || {
        (0..judge.loops()).try_fold(String::from("+"), |all, k| {
            let proofs = judge.proofs(part, k).into_iter().map(|own| proof(judge, k, own, &mut most.clone()));
            Some(all + &proofs.collect::<Option<String>>()?)
        })
    };
    if let Some(found) = refuted(1).or_else(proved).or_else(|| refuted(3)) {
        return found;
    }
    if depth == 0 || axes == 0 {
        return "?".into();
    }
    let axis = if axes == 2 && depth % 2 == 1 { 1 } else { 0 };
    let halves = [Part::Lower, Part::Upper].map(|half| {
        let half = judge.part(part, half, axis);
        tree(judge, axes, &half, depth - 1, most)
    });
    format!("{}{}", letter(axis), halves.concat())
}

/// A certificate, and its tree.
pub fn written(model: &str, asked: &Asked, depth: usize, most: usize) -> (String, String) {
    let judge = asked.judge(model);
    let axes = asked.axes.matches("between").count();
    let found = tree(&judge, axes, &judge.whole(0), depth, most);
    (asked.certificate(&found), found)
}

/// The statement of an accepted certificate without axes, and whether it is a good one.
pub fn accepted(model: &str, asked: &Asked) -> (char, String) {
    let (certificate, tree) = written(model, asked, 0, 120);
    let proved = check(model, &certificate, &LIMITS).unwrap_or_else(|e| panic!("{e}\n{certificate}"));
    (tree.chars().next().unwrap_or('?'), proved.statement)
}
