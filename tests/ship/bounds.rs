//! Bounds of signals against the processor's own arithmetic, run exactly in the loop.

use crate::helpers::model::read;
use crate::helpers::random::Random;
use jurist::Ask;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Integer, Rational};
use jurist_engine::response::Requirements;
use jurist_ship::answer::{Beside, ShipAnswer};
use jurist_ship::asked::{Asked, Overrides};
use jurist_ship::program::{LinearSystem, Operand, Program};

/// The plant passes the controller's output on after one sample: so every signal is a number of the format.
const LOOP: &str = "time = 'discrete'\n[loop]\ninputs = ['r']\noutputs = ['y']\n\
    [[block]]\nname = 'controller'\ninput = 'r - y'\noutput = 'u'\nnum = [0.3, -0.22, 0.1]\nden = [1, -1.5, 0.61]\n\
    [[block]]\nname = 'plant'\ninput = 'u'\noutput = 'y'\ndelay = 1\n\
    [ship]\nblock = 'controller'\nformat = { bits = 24, fraction = 10 }\ninputs = { r = 2 }\n";

const BOUND: i64 = 2;

fn shipped(realisation: &str, round: &str) -> ShipAnswer {
    let signal = format!("signal = {{ bits = 24, fraction = 6, round = '{round}' }}\n");
    let model = read(&format!("{LOOP}{signal}"));
    let overrides = Overrides { realisation: Some(realisation.into()), ..Overrides::default() };
    let asked = Asked::of(&model, &overrides).unwrap();
    let problem = model.ask().problem().unwrap();
    ShipAnswer::of(&problem, asked, &Requirements::default(), &Beside::default(), &Budget::unlimited()).unwrap()
}

/// The loop without the rounding of signals, a sample at a time.
struct Unrounded {
    system: LinearSystem,
    x: Vec<Rational>,
    y: Rational,
    output: usize,
}

/// The node that is the output.
fn output_node(program: &Program) -> usize {
    let [Operand::Node(node)] = program.outputs.as_slice() else { panic!("the output is a node") };
    *node
}

impl Unrounded {
    fn of(answer: &ShipAnswer) -> Unrounded {
        let program = &answer.shipped.realised.program;
        let values: Vec<Rational> = answer.shipped.coefficients.iter().map(|c| c.value.clone()).collect();
        let system = program.system(&values);
        let x = vec![Rational::ZERO; system.a.len()];
        Unrounded { system, x, y: Rational::ZERO, output: output_node(program) }
    }

    /// The nodes, and the output of the loop before the step.
    fn step(&mut self, r: &Rational) -> (Vec<Rational>, Rational) {
        let u = r - &self.y;
        let row = |row: &[Rational], direct: &Rational, x: &[Rational]| {
            row.iter().zip(x).fold(direct * &u, |sum, (a, x)| sum + a * x)
        };
        let nodes: Vec<Rational> =
            self.system.c.iter().zip(&self.system.d).map(|(c, d)| row(c, &d[0], &self.x)).collect();
        self.x = self.system.a.iter().zip(&self.system.b).map(|(a, b)| row(a, &b[0], &self.x)).collect();
        let before = std::mem::replace(&mut self.y, nodes[self.output].clone());
        (nodes, before)
    }
}

#[test]
fn no_run_of_the_processor_leaves_its_bounds() {
    let random = &mut Random::new(53);
    for (realisation, round) in [
        ("df1", "nearest"),
        ("df2", "floor"),
        ("df2t", "nearest"),
        ("delta", "floor"),
        ("sos", "zero"),
        ("state", "even"),
        ("parallel", "floor"),
    ] {
        let answer = shipped(realisation, round);
        let ranges = answer.ranges.as_ref().unwrap().as_ref().unwrap();
        let fixed = answer.shipped.fixed_program().unwrap();
        let unit = fixed.signal.unit();
        let mut unrounded = Unrounded::of(&answer);
        let (mut states, mut y) = (fixed.at_rest(), Integer::ZERO);
        let most = BOUND * 64;
        for _ in 0..250 {
            // Often at the ends, where responses add up.
            let r = [most, -most, random.below(2 * most as usize + 1) as i64 - most][random.below(3)];
            let difference = Integer::from(r) - &y;
            let before = states.clone();
            let outputs = fixed.step(&mut states, std::slice::from_ref(&difference));
            let (nodes, exact_y) = unrounded.step(&(&unit * &Rational::from(r)));
            let moved = (Rational::from(y.clone()) * &unit - exact_y).abs();
            assert!(
                moved <= ranges.moved[0].by_signals,
                "{realisation} {round}: {moved} {}",
                ranges.moved[0].by_signals
            );
            // The first range is that of the input.
            for (node, value) in ranges.nodes.iter().skip(1).zip(&nodes) {
                let [_, high] = node.greatest.as_ref().unwrap();
                assert!(value.abs() <= *high, "{realisation} {}", node.name);
            }
            let [_, high] = ranges.nodes[0].greatest.as_ref().unwrap();
            let taken = Rational::from(difference.clone()) * &unit;
            assert!(taken.abs() <= high + &ranges.nodes[0].rounding, "{realisation}: u");
            let output = &ranges.nodes[unrounded.output + 1];
            let [_, high] = output.greatest.as_ref().unwrap();
            let stored = Rational::from(outputs[0].clone()) * &unit;
            assert!(stored.abs() <= high + &output.rounding, "{realisation}");
            assert_eq!(before.len(), states.len());
            y = outputs[0].clone();
        }
    }
}

/// SHIP_STEPS=1000000 runs longer: then random inputs and the worst one, over and over.
#[test]
fn long_runs_stay_within_their_bounds() {
    let steps: usize = std::env::var("SHIP_STEPS").ok().and_then(|text| text.parse().ok()).unwrap_or(1200);
    let random = &mut Random::new(59);
    let budget = Budget::unlimited();
    for (realisation, round) in [("df1", "floor"), ("df2", "nearest"), ("df2t", "floor"), ("delta", "nearest")] {
        let answer = shipped(realisation, round);
        let ranges = answer.ranges.as_ref().unwrap().as_ref().unwrap();
        let fixed = answer.shipped.fixed_program().unwrap();
        let output = &ranges.nodes[output_node(&answer.shipped.realised.program) + 1];
        let bound = output.greatest.as_ref().unwrap()[1].clone() + &output.rounding;
        let bound = (bound / fixed.signal.unit()).floor();
        let found = ranges.problem.peak_to_peak("r", &output.output, 6, &budget).unwrap();
        let worst: Vec<i64> = found.value().signs(150, &budget).unwrap().iter().rev().map(|s| i64::from(*s)).collect();
        let (mut states, mut y, mut greatest) = (fixed.at_rest(), Integer::ZERO, Integer::ZERO);
        let most = BOUND * 64;
        for k in 0..steps {
            let r = match k / 300 % 2 {
                0 => worst[k % 150] * most,
                _ => random.below(2 * most as usize + 1) as i64 - most,
            };
            let outputs = fixed.step(&mut states, &[Integer::from(r) - &y]);
            y = outputs[0].clone();
            greatest = greatest.max(y.abs());
            assert!(y.abs() <= bound, "{realisation} {round}: {y} {bound}");
        }
        // The worst input is not far from the bound, rounding included.
        assert!(greatest * Integer::from(10) > bound * Integer::from(9), "{realisation} {round}");
    }
}

#[test]
fn the_worst_input_comes_up_to_the_bound() {
    for realisation in ["df1", "df2", "df2t", "delta", "sos", "state", "parallel"] {
        let answer = shipped(realisation, "nearest");
        let ranges = answer.ranges.as_ref().unwrap().as_ref().unwrap();
        let budget = Budget::unlimited();
        for (at, node) in ranges.nodes.iter().enumerate() {
            let found = ranges.problem.peak_to_peak("r", &node.output, 6, &budget).unwrap();
            let samples = 200;
            let signs = found.value().signs(samples, &budget).unwrap();
            let mut unrounded = Unrounded::of(&answer);
            let mut last = Rational::ZERO;
            for sign in signs.iter().rev() {
                let r = Rational::from(i64::from(*sign) * BOUND);
                let (nodes, y) = unrounded.step(&r);
                // The first range is that of the input.
                last = if at == 0 { r - y } else { nodes[at - 1].clone() };
            }
            let [low, high] = node.greatest.as_ref().unwrap();
            let share = last.checked_div(high).unwrap();
            assert!(
                last <= *high && share > Rational::new(99.into(), 100.into()),
                "{realisation} {}: {share}",
                node.name
            );
            assert!(low <= high);
        }
    }
}
