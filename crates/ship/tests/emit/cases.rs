//! A controller with its numbers, and its exact run.

use jurist_algebra::number::{BinaryFormat, Integer, Rational};
use jurist_ship::emit::{Arithmetic, Shipped, Target, TooWide, text};
use jurist_ship::format::Fixed;
use jurist_ship::program::{Operand, Program};
use jurist_ship::realise::Realisation;
use jurist_ship::run::{FixedProgram, FloatProgram, Overflow};

/// What a controller computes with.
#[derive(Clone, Debug)]
pub enum Numbers {
    Fixed { stored: Vec<Integer>, coefficient: Fixed, signal: Fixed, overflow: Overflow },
    Float { stored: Vec<Rational>, format: BinaryFormat },
}

#[derive(Clone, Debug)]
pub struct Case {
    pub name: String,
    pub realisation: Realisation,
    pub program: Program,
    pub numbers: Numbers,
}

/// The type of signals in all drivers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Signal {
    Integer,
    Single,
    Double,
}

impl Case {
    pub fn fixed(&self) -> Option<FixedProgram<'_>> {
        let Numbers::Fixed { stored, coefficient, signal, overflow } = &self.numbers else { return None };
        Some(FixedProgram::new(&self.program, stored.clone(), coefficient, *signal, *overflow))
    }

    pub fn float(&self) -> Option<FloatProgram<'_>> {
        let Numbers::Float { stored, format } = &self.numbers else { return None };
        Some(FloatProgram::new(&self.program, stored, *format).expect("factors are in range"))
    }

    pub fn text(&self, target: Target, remarks: &[String]) -> Result<String, TooWide> {
        let (fixed, float) = (self.fixed(), self.float());
        let arithmetic = match (&fixed, &float) {
            (Some(fixed), _) => Arithmetic::Fixed(fixed),
            (_, Some(float)) => Arithmetic::Float(float),
            _ => unreachable!("it is one of both"),
        };
        text(&Shipped { name: &self.name, realisation: self.realisation, arithmetic, remarks }, target)
    }

    pub fn signal(&self) -> Signal {
        match &self.numbers {
            Numbers::Fixed { .. } => Signal::Integer,
            Numbers::Float { format: BinaryFormat::Single, .. } => Signal::Single,
            Numbers::Float { format: BinaryFormat::Double, .. } => Signal::Double,
        }
    }

    /// A word of a driver, bits of floating point as an integer, as a number.
    pub fn value(&self, word: i64) -> Rational {
        let value = match self.signal() {
            Signal::Integer => return word.into(),
            Signal::Single => f64::from(f32::from_bits(word as u32)),
            Signal::Double => f64::from_bits(word as u64),
        };
        Rational::from_f64(value).unwrap_or_else(|| panic!("{}: {value} is no number", self.name))
    }

    /// The outputs and then the states after each sample; shorter than the inputs where a number becomes infinite.
    pub fn run(&self, inputs: &[Vec<i64>]) -> Vec<Vec<Rational>> {
        if let Some(fixed) = self.fixed() {
            let mut states = fixed.at_rest();
            let row = |sample: &Vec<i64>| {
                let sample: Vec<Integer> = sample.iter().map(|word| fitted(*word, &fixed)).collect();
                let outputs = fixed.step(&mut states, &sample);
                outputs.into_iter().chain(states.iter().cloned()).map(Rational::from).collect()
            };
            return inputs.iter().map(row).collect();
        }
        let float = self.float().expect("it is one of both");
        let mut states = float.at_rest();
        let row = |sample: &Vec<i64>| {
            let sample: Vec<Rational> = sample.iter().map(|word| self.value(*word)).collect();
            let outputs = float.step(&mut states, &sample)?;
            Some(outputs.into_iter().chain(states.iter().cloned()).collect())
        };
        inputs.iter().map_while(row).collect()
    }
}

/// What a controller reads where an input does not fit into the format of signals.
fn fitted(word: i64, fixed: &FixedProgram<'_>) -> Integer {
    let (least, greatest) = fixed.signal.integers();
    let unused = 64 - fixed.signal.bits;
    match fixed.overflow {
        Overflow::Saturate => Integer::from(word).clamp(least, greatest),
        Overflow::Wrap => Integer::from(word << unused >> unused),
    }
}

/// Random numbers of Sebastiano Vigna's SplitMix64.
pub struct Dice(pub u64);

impl Dice {
    pub fn word(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    pub fn below(&mut self, end: usize) -> usize {
        (self.word() % end as u64) as usize
    }
}

/// How many samples are drawn for all controllers together.
pub fn samples() -> usize {
    std::env::var("EMIT_SAMPLES").ok().and_then(|text| text.parse().ok()).unwrap_or(100_000)
}

/// So many samples: noise of all sizes, ends of the range in turns, the input that moves the first output most, what does not fit, rest.
pub fn inputs(case: &Case, samples: usize, dice: &mut Dice) -> Vec<Vec<i64>> {
    let worst = worst_signs(case, 24);
    let mut out: Vec<Vec<i64>> = Vec::new();
    while out.len() < samples {
        let kind = dice.below(7);
        let length = 8 + dice.below(40);
        for k in 0..length {
            let mut word = || match kind {
                0 | 1 => noise(case, dice),
                2 => end(case, dice.below(2) == 0),
                3 => end(case, k / 3 % 2 == 0),
                4 => end(case, worst[k % worst.len()]),
                5 => beyond(case, dice),
                _ => 0,
            };
            out.push((0..case.program.inputs).map(|_| word()).collect());
        }
    }
    out.truncate(samples);
    out
}

fn end(case: &Case, is_greatest: bool) -> i64 {
    match &case.numbers {
        Numbers::Fixed { signal, .. } => {
            let (least, greatest) = signal.integers();
            if is_greatest { greatest } else { least }.to_i64().expect("at most 63 bits")
        }
        // Large, but not so large that every sum is infinite; the other end is the least number, with either sign.
        Numbers::Float { format: BinaryFormat::Single, .. } => {
            i64::from((if is_greatest { 1e30f32 } else { -1e-45 }).to_bits())
        }
        Numbers::Float { .. } => (if is_greatest { -1e290f64 } else { 5e-324 }).to_bits() as i64,
    }
}

/// Any word of the type of signals in C and Rust, which may have more bits than the format.
fn beyond(case: &Case, dice: &mut Dice) -> i64 {
    match &case.numbers {
        Numbers::Fixed { signal, .. } => {
            let width = [16, 32, 64].into_iter().find(|width| signal.bits <= *width).expect("at most 64 bits");
            (dice.word() as i64) >> (64 - width)
        }
        Numbers::Float { .. } => noise(case, dice),
    }
}

fn noise(case: &Case, dice: &mut Dice) -> i64 {
    match &case.numbers {
        Numbers::Fixed { signal, .. } => {
            // The size is drawn first: all magnitudes are as likely.
            let bits = 1 + dice.below(signal.bits as usize) as u32;
            (dice.word() as i64) >> (64 - bits)
        }
        Numbers::Float { format: BinaryFormat::Single, .. } => {
            let exponent = [100 + dice.below(40), dice.below(30), 0][dice.below(3)] as u32;
            i64::from((dice.word() as u32 & 0x807f_ffff) | exponent << 23)
        }
        Numbers::Float { .. } => {
            let exponent = [1000 + dice.below(50), dice.below(60), 0][dice.below(3)] as u64;
            ((dice.word() & 0x800f_ffff_ffff_ffff) | exponent << 52) as i64
        }
    }
}

/// The signs of the response of the first output to the first input, last first.
fn worst_signs(case: &Case, length: usize) -> Vec<bool> {
    let program = &case.program;
    let values: Vec<Rational> = match &case.numbers {
        Numbers::Fixed { stored, coefficient, .. } => stored.iter().map(|k| coefficient.value(k)).collect(),
        Numbers::Float { stored, .. } => stored.clone(),
    };
    let (Some(&Operand::Node(node)), true) = (program.outputs.first(), program.inputs > 0) else { return vec![true] };
    let system = program.system(&values);
    let dot = |row: &[Rational], x: &[Rational]| row.iter().zip(x).fold(Rational::ZERO, |sum, (a, b)| sum + a * b);
    let mut x: Vec<Rational> = system.b.iter().map(|row| row[0].clone()).collect();
    let mut signs = vec![!system.d[node][0].is_negative()];
    for _ in 0..length {
        signs.push(!dot(&system.c[node], &x).is_negative());
        x = system.a.iter().map(|row| dot(row, &x)).collect();
    }
    signs.reverse();
    signs
}
