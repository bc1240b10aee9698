//! The values of everything in a model.

use super::transfer::Fraction;
use super::zpoly::ZPoly;
use crate::complex::{Frame, Lift, names_of_parts};
use crate::definition::{Form, Model, Rate};
use crate::discretization::{Edges, Inputs, Rule};
use crate::error::Span;
use jurist_algebra::matrix::RationalMatrix;
use jurist_algebra::poly::RationalFunction;
use std::collections::{BTreeMap, HashMap};

/// The coefficients of a linear expression by signal.
pub(crate) type Row = BTreeMap<usize, RationalFunction>;

/// The numbers of signals or states: those that are driven first, then the external ones.
pub(crate) struct Wiring<'m> {
    pub numbers: HashMap<&'m str, usize>,
    /// How many are driven.
    pub driven: usize,
    pub inputs: Vec<String>,
    /// Whether each signal has become two, its real and its imaginary part.
    pub is_complex: bool,
}

impl<'m> Wiring<'m> {
    pub fn of(model: &'m Model) -> Self {
        let own: Vec<&str> = match &model.form {
            Form::Characteristic(_) => Vec::new(),
            Form::Matrix { ports, .. } | Form::OutputFeedback { ports, .. } => {
                ports.states.iter().map(|n| n.name.as_str()).collect()
            }
            Form::Blocks(diagram) => diagram.driven().map(|(n, _)| n.name.as_str()).collect(),
        };
        let inputs: Vec<&str> = model.inputs().iter().map(|n| n.name.as_str()).collect();
        let mut numbers: HashMap<&str, usize> = own.iter().enumerate().map(|(i, n)| (*n, i)).collect();
        if matches!(model.form, Form::Blocks(_)) {
            numbers.extend(inputs.iter().enumerate().map(|(i, n)| (*n, own.len() + i)));
        }
        let inputs = inputs.into_iter().map(str::to_owned).collect();
        Wiring { numbers, driven: own.len(), inputs, is_complex: false }
    }

    /// The names of a signal's parts: of a real one only its own.
    pub fn parts_of(&self, name: &str) -> Vec<String> {
        if self.is_complex { names_of_parts([name.to_owned()]) } else { vec![name.to_owned()] }
    }
}

/// The values of everything in a model's form.
pub(crate) enum Values {
    /// The real and the imaginary part.
    Characteristic([ZPoly; 2]),
    Matrix {
        matrix: RationalMatrix,
        ports: PortValues,
    },
    Feedback {
        a: RationalMatrix,
        b: RationalMatrix,
        c: RationalMatrix,
        k: RationalMatrix,
        ports: PortValues,
    },
    Blocks {
        blocks: Vec<BlockValues>,
        outputs: Vec<Row>,
    },
}

pub(crate) struct PortValues {
    pub input_matrix: Option<RationalMatrix>,
    pub outputs: Vec<Row>,
}

pub(crate) struct BlockValues {
    pub name: String,
    pub span: Span,
    pub inputs: Vec<Row>,
    pub outputs: usize,
    pub rate: Rate,
    /// When real and imaginary parts become signals of their own.
    pub lift: Lift,
    pub dynamics: DynamicValues,
    pub discretization: Option<DiscretizationValues>,
    /// What it says of its pulses, where it is a modulator.
    pub modulator: Option<Modulator>,
}

/// What a block says of the pulses that it commands.
pub(crate) struct Modulator {
    /// How high they are.
    pub amplitude: RationalFunction,
    /// How far one begins behind another.
    pub period: RationalFunction,
    /// Where the period stands.
    pub span: Span,
}

/// How a continuous block is made discrete.
pub(crate) enum DiscretizationValues {
    /// By a rule with the sample time, or Tustin's with its factor.
    Rule { rule: Rule, value: RationalFunction, prewarp: Option<Prewarp> },
    /// By what it does behind a hold.
    Hold(Hold),
}

/// A bilinear map that is exact at one frequency.
pub(crate) struct Prewarp {
    /// The angle `w T` of that frequency: below pi.
    pub angle: RationalFunction,
    pub span: Span,
}

/// A hold or a modulator.
pub(crate) struct Hold {
    pub inputs: Inputs,
    /// For each input the edges of its pulses; `None` for one that is held.
    pub pulses: Vec<Option<Pulse>>,
    pub time: RationalFunction,
    /// Dead time of the inputs, in units of time.
    pub delay: RationalFunction,
    /// How the block is seen, where its input is held in another frame.
    pub frame: Option<Box<Frame>>,
    pub span: Span,
}

/// The pulse of an input.
#[derive(Clone)]
pub(crate) struct Pulse {
    pub duty: RationalFunction,
    /// The places of edges in sample times: first the edges that a command at an even sample moves, then those of an odd sample. A change of
    /// the duty ratio moves all edges of a pulse by the same share of it.
    pub edges: [Vec<RationalFunction>; 2],
    /// Whether these are different.
    pub alternates: bool,
    /// Which edges these are and where that is asked for, where the duty ratio is that of the loop at rest.
    pub steady: Option<(&'static Edges, Span)>,
}

pub(crate) enum DynamicValues {
    /// Numerator and denominator. The degree of the denominator is the order of the block.
    Ratio(Fraction),
    /// Numerator and denominator with complex coefficients: first the real part, then the imaginary part.
    ComplexRatio {
        numerator: [ZPoly; 2],
        denominator: [ZPoly; 2],
    },
    StateSpace {
        a: RationalMatrix,
        b: RationalMatrix,
        c: RationalMatrix,
        d: RationalMatrix,
    },
}
