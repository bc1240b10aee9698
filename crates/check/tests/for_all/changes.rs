//! Changed certificates: what is accepted is true.

use crate::samples::Plant;
use crate::truth::is_true;
use crate::writer::{Asked, LIMITS, written};
use crate::{INPUT, SIGNAL, is_thorough, loop_of, other, phase};
use jurist_check::check;
use std::collections::BTreeMap;
use std::rc::Rc;

/// Numbers that look random.
struct Draw(u64);

impl Draw {
    fn below(&mut self, bound: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % bound.max(1)
    }
}

fn third() -> Plant {
    Plant {
        model: loop_of("continuous", "K/(s*(s + a)*(s/5 + 1))", "parameters = { K = {}, a = {} }"),
        time: "continuous",
        open: Rc::new(|of| {
            let (k, a) = (of["K"], of["a"]);
            [vec![[0.0, 0.0], [a, 0.0], [1.0 + a / 5.0, 0.0], [0.2, 0.0]], vec![[k, 0.0]]]
        }),
    }
}

fn sampled() -> Plant {
    Plant {
        model: loop_of("discrete", "K/(z*(z - a))", "parameters = { K = {}, a = {} }"),
        time: "discrete",
        open: Rc::new(|of| [vec![[0.0, 0.0], [-of["a"], 0.0], [1.0, 0.0]], vec![[of["K"], 0.0]]]),
    }
}

fn complex() -> Plant {
    Plant {
        model: loop_of("continuous", "(2 + j)*K/(s + a)", "parameters = { K = {}, a = {} }"),
        time: "continuous",
        open: Rc::new(|of| [vec![[of["a"], 0.0], [1.0, 0.0]], vec![[2.0 * of["K"], of["K"]]]]),
    }
}

/// What is inside of a function depends on a name.
fn held() -> Plant {
    Plant {
        model: loop_of("discrete", "K/(s + a)", "sample_time = 1\nparameters = { K = {}, a = {} }")
            + "discretize = 'zoh'\n",
        time: "discrete",
        open: Rc::new(|of| {
            let decay = (-of["a"]).exp();
            [vec![[-decay, 0.0], [1.0, 0.0]], vec![[of["K"] * (1.0 - decay) / of["a"], 0.0]]]
        }),
    }
}

/// In the variable of a hyperperiod.
fn rates() -> Plant {
    Plant {
        model: "time = 'discrete'\nparameters = { K = {}, a = {} }\n[loop]\ninputs = ['r']\n[[block]]\nname = 'plant'\ninput = 'r - y'\noutput = 'u'\ngain = 'K'\n\
                every = 2\n[[block]]\ninput = 'u'\noutput = 'y'\ntransfer = '1/(z - a)'\n"
            .to_owned(),
        time: "discrete",
        // y goes on by a y + u, then by a y + u again.
        open: Rc::new(|of| {
            let (k, a) = (of["K"], of["a"]);
            [vec![[-a * a, 0.0], [1.0, 0.0]], vec![[(1.0 + a) * k, 0.0]]]
        }),
    }
}

const K: &str = r#"{"name": "K", "between": ["1/2", "3/4"]}"#;
const K_AND_A: &str = r#"{"name": "K", "between": ["1/2", "3/4"]}, {"name": "a", "between": ["1/2", "2/3"]}"#;
const A: &str = r#"{"name": "a", "between": ["1/2", "2/3"]}"#;
const SET: &str = r#""a": "2/3""#;

fn asked() -> Vec<(Plant, Asked)> {
    let both = format!("{}, {}", phase(INPUT, 30.0), other("gain_margin", SIGNAL, "5/4"));
    let of = |plant: Plant| {
        let time = plant.time;
        (plant, Asked { order: 2, ..Asked::of(time) })
    };
    let mut out = Vec::new();
    let (plant, asked) = of(rates());
    out.push((plant, asked.clone().axes(K).for_all(A).require(other("gain_margin", SIGNAL, "3/2"))));
    out.push((rates(), asked.for_all(K_AND_A).beyond(r#"{"point": ["-9", "1/2"], "not": "0."}"#)));
    for (plant, asked) in [of(third()), of(sampled()), of(complex()), of(held())] {
        let model = plant.model.clone();
        let again = || Plant { model: model.clone(), time: plant.time, open: plant.open.clone() };
        out.push((again(), asked.clone().for_all(K_AND_A).require(&*both)));
        out.push((again(), asked.clone().axes(K).for_all(A)));
        out.push((again(), asked.clone().axes(K).set(SET).require(phase(INPUT, 40.0))));
        for (kind, bound) in
            [("modulus_margin", "2/5"), ("disk_margin", "1/3"), ("complementary_peak", "2"), ("gain_margin", "2")]
        {
            out.push((again(), asked.clone().set(r#""K": "1/2", "a": "1""#).require(other(kind, INPUT, bound))));
        }
        out.push((again(), asked.clone().for_all(K_AND_A).beyond(r#"{"point": ["-9", "1/2"], "not": "0."}"#)));
    }
    out
}

/// Places of the texts between quotes that begin like numbers, and of the tree.
fn texts(certificate: &str) -> Vec<(usize, usize)> {
    let quotes: Vec<usize> = certificate.match_indices('"').map(|(i, _)| i).collect();
    quotes.chunks(2).map(|pair| (pair[0] + 1, pair[1])).collect()
}

fn changed(certificate: &str, draw: &mut Draw) -> String {
    const NUMBERS: [&str; 14] =
        ["0", "1", "2", "1/2", "-1", "3/4", "-1/2", "5", "1/100", "179", "90", "9/10", "1/1000000", "100"];
    const WORDS: [&str; 12] = [
        "phase_margin",
        "gain_margin",
        "modulus_margin",
        "disk_margin",
        "complementary_peak",
        "signal",
        "input",
        "parameter",
        "K",
        "a",
        "y",
        "plant",
    ];
    let mut out = certificate.to_owned();
    let all = texts(certificate);
    let is_number = |text: &str| text.starts_with(|c: char| c.is_ascii_digit() || c == '-') && !text.contains('.');
    let numbers: Vec<_> = all.iter().filter(|(i, k)| is_number(&certificate[*i..*k])).collect();
    match draw.below(8) {
        0..=3 => {
            let (i, k) = numbers[draw.below(numbers.len())];
            let old = &certificate[*i..*k];
            let new = match draw.below(4) {
                0 => NUMBERS[draw.below(NUMBERS.len())].to_owned(),
                // A little more, or less.
                n => {
                    let (top, below) = old.split_once('/').unwrap_or((old, "1"));
                    let (top, below): (i64, i64) = (top.parse().unwrap_or(1), below.parse().unwrap_or(1));
                    let step = [100, 97, 130, 60][draw.below(4)] + n as i64;
                    format!("{}/{}", top * step, below * 100)
                }
            };
            out.replace_range(*i..*k, &new);
        }
        4 => {
            let words: Vec<_> = all.iter().filter(|(i, k)| WORDS.contains(&&certificate[*i..*k])).collect();
            let Some((i, k)) = words.get(draw.below(words.len())) else { return out };
            out.replace_range(*i..*k, WORDS[draw.below(WORDS.len())]);
        }
        _ => {
            let at = certificate.find("\"tree\": \"").expect("a tree") + 9;
            let end = at + certificate[at..].find('"').expect("its end");
            let i = at + draw.below(end - at);
            let letter =
                [".", "+", "-", "a", "b", "c", "d", "0", "1", "m", "l", "u", "<", ">", "?", "-0.", "+.", "+.."]
                    [draw.below(18)];
            match draw.below(3) {
                0 => out.replace_range(i..=i, letter),
                1 => out.insert_str(i, letter),
                _ => out.replace_range(i..=i, ""),
            }
        }
    }
    out
}

/// `JURIST_CHANGES=1000` looks at so many changes.
#[test]
#[ignore = "long: CI runs it"]
fn what_is_accepted_of_changed_certificates_is_true() {
    let count = std::env::var("JURIST_CHANGES").ok().and_then(|n| n.parse().ok()).unwrap_or(if is_thorough() {
        60
    } else {
        20
    });
    let (mut draw, mut told) = (Draw(7), 0);
    let all: Vec<(Plant, String)> = asked()
        .into_iter()
        .step_by(if is_thorough() { 1 } else { 3 })
        .map(|(plant, asked)| {
            let (certificate, tree) = written(&plant.model, &asked, 3, 90);
            let proved = check(&plant.model, &certificate, &LIMITS).unwrap_or_else(|e| panic!("{e}\n{certificate}"));
            assert!(is_true(&plant, &certificate), "{proved:?}\n{certificate}");
            told += usize::from(tree.contains(['+', '-']));
            (plant, certificate)
        })
        .collect();
    assert!(told * 5 >= all.len() * 3, "{told} of {}", all.len());
    let mut accepted = 0;
    for _ in 0..count {
        let (plant, certificate) = &all[draw.below(all.len())];
        let mut own = changed(certificate, &mut draw);
        if draw.below(3) == 0 {
            own = changed(&own, &mut draw);
        }
        if let Ok(proved) = check(&plant.model, &own, &LIMITS) {
            assert!(is_true(plant, &own), "{proved:?}\n{}\n{own}", plant.model);
            accepted += 1;
        }
    }
    println!("{accepted} of {count} are accepted");
    assert!(accepted * 20 > count, "{accepted} of {count}");
}

/// A random loop, real or complex, of up to three poles, and a requirement of some kind.
fn random(draw: &mut Draw) -> (Plant, Asked) {
    let time = ["continuous", "discrete"][draw.below(2)];
    let variable = ["s", "z"][usize::from(time == "discrete")];
    let is_complex = draw.below(3) == 0;
    // Numbers in tenths, about zero.
    let mut number = |about: i64, around: usize| about + draw.below(2 * around + 1) as i64 - around as i64;
    let n = 1 + number(1, 1) as usize;
    let mut of = |n: usize, about: i64, around: usize| -> Vec<[i64; 2]> {
        (0..n).map(|_| [number(about, around), if is_complex { number(0, 4) } else { 0 }]).collect()
    };
    let poles = if time == "discrete" { of(n, 0, 8) } else { of(n, -12, 13) };
    let zeros = if time == "discrete" { of(n - 1, 0, 9) } else { of(n - 1, -30, 29) };
    let gain = of(1, 9, 14)[0];
    let text = |[x, y]: [i64; 2]| if y == 0 { format!("({x}/10)") } else { format!("({x}/10 + {y}/10*j)") };
    let product = |all: &[[i64; 2]]| all.iter().map(|c| format!("*({variable} - {})", text(*c))).collect::<String>();
    let transfer = format!("g*{}{}/(1{})", text(gain), product(&zeros), product(&poles));
    let tenth = |c: &[i64; 2]| c.map(|x| x as f64 / 10.0);
    let expanded = move |lead: [i64; 2], roots: &[[i64; 2]]| {
        roots.iter().fold(vec![tenth(&lead)], |p, root| {
            let [a, b] = tenth(root);
            let mut out = vec![[0.0, 0.0]; p.len() + 1];
            for (k, [x, y]) in p.iter().enumerate() {
                out[k + 1] = [out[k + 1][0] + x, out[k + 1][1] + y];
                out[k] = [out[k][0] - (x * a - y * b), out[k][1] - (x * b + y * a)];
            }
            out
        })
    };
    let model = loop_of(time, &transfer, "constants.g = 1");
    let open = Rc::new(move |of: &BTreeMap<String, f64>| {
        let g = of.get("g").copied().unwrap_or(1.0);
        [expanded([10, 0], &poles), expanded(gain, &zeros).iter().map(|c| c.map(|x| g * x)).collect()]
    });
    let at = if draw.below(2) == 0 { INPUT } else { SIGNAL };
    let share = (1 + draw.below(9)) as i64;
    let ranges = ["", r#"{"name": "g", "between": ["19/20", "21/20"]}"#];
    let require = match draw.below(5) {
        0 => phase(at, 17.0 * share as f64),
        1 => other("gain_margin", at, &format!("{}/10", 10 + 3 * share)),
        2 => other("modulus_margin", at, &format!("{share}/10")),
        3 => other("disk_margin", at, &format!("{share}/5")),
        _ => other("complementary_peak", at, &format!("{}/10", 6 + 2 * share)),
    };
    (Plant { model, time, open }, Asked { order: 2, ..Asked::of(time) }.for_all(ranges[draw.below(2)]).require(require))
}

/// `JURIST_LOOPS=1000` looks at so many loops; all of the usual ones are looked at with `JURIST_THOROUGH`, as in CI.
#[test]
#[ignore = "long: CI runs it"]
fn what_is_said_of_random_loops_is_true() {
    let usual = if is_thorough() { 40 } else { 8 };
    let count = std::env::var("JURIST_LOOPS").ok().and_then(|n| n.parse().ok()).unwrap_or(usual);
    let (mut draw, mut seen) = (Draw(11), [0; 3]);
    for _ in 0..count {
        let (plant, asked) = random(&mut draw);
        let (certificate, tree) = written(&plant.model, &asked, 0, 60);
        let proved = check(&plant.model, &certificate, &LIMITS).unwrap_or_else(|e| panic!("{e}\n{certificate}"));
        assert!(is_true(&plant, &certificate), "{proved:?}\n{}\n{certificate}", plant.model);
        seen[['+', '-', '?'].iter().position(|letter| tree.starts_with(*letter)).unwrap()] += 1;
    }
    println!("{seen:?}");
    assert!(seen[0] * 8 > count && seen[1] * 8 > count && seen[2] * 3 < count, "{seen:?}");
}
