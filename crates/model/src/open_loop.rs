//! The loop cut open at one scalar signal.

use super::between::Between;
use super::closed_loop::ClosedLoop;
use super::connect::matrices::product;
use super::definition::{Block, Diagram, Form, Model, Parameter};
use super::evaluate::values::{DiscretizationValues, PortValues, Row, Values};
use super::evaluated::Answer;
use super::symbols::Symbols;
use super::text::names::{did_you_mean, list, shorten};
use crate::error::{Code, Diagnostic, Diagnostics, Error};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::RationalFunction;
use std::cell::RefCell;

/// Where a loop is cut: what returns to the cut when a signal is put in there is the open loop.
///
/// ```
/// use jurist_model::error::Code;
/// use jurist_model::{BlockBuilder, Cut, Model, Time};
/// let (model, _) = Model::builder(Time::Discrete)
///     .inputs(["r"])
///     .outputs(["y"])
///     .block(BlockBuilder::new("controller", "r - y", "u").gain("1/2"))
///     .block(BlockBuilder::new("plant", "u", "y").transfer("1/(z - 1)"))
///     .build()?;
/// assert_eq!(model.cut(None)?, Cut::Input("controller".into())); // the error of a single loop
/// assert_eq!(model.cut(Some("u"))?, Cut::Signal("u".into()));
/// assert_eq!(model.cut(Some("v")).unwrap_err().code(), Code::UnknownSignal);
/// # Ok::<(), jurist_model::error::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Cut {
    /// At a signal, before it goes to all that use it.
    Signal(String),
    /// At the only input of a block: the error that a controller is given.
    Input(String),
    /// At the plant's only input `u = -K y`.
    PlantInput,
    /// At a parameter that multiplies the loop's gain.
    Gain(String),
    /// Nowhere: the transfer function of the closed loop between two signals, which is that of a loop closed around it.
    Between(Between),
}

impl Cut {
    /// The name by which it is asked for.
    pub fn name(&self) -> &str {
        match self {
            Cut::Signal(name) | Cut::Input(name) | Cut::Gain(name) => name,
            Cut::PlantInput => PLANT_INPUT,
            Cut::Between(between) => between.name(),
        }
    }
}

/// How the plant's input of the output feedback form is called.
const PLANT_INPUT: &str = "u";

/// The open loop from the cut to the cut, and the sample time, in the kept names.
pub struct Opened {
    /// The open loop from its one input to its one output. In a complex loop either is two real signals, the real and the imaginary part. The output has
    /// the sign of the feedback.
    pub system: ClosedLoop,
    /// The sample time.
    pub sample_time: Option<RationalFunction>,
    /// What the variables beyond the kept names stand for.
    pub symbols: Symbols,
    /// Whether the system is the closed loop `L/(1 + L)` and not what comes back.
    pub is_closed: bool,
}

/// The only hold, or the only modulator, of a diagram.
pub struct OnlyHold {
    /// The block behind it.
    pub block: String,
    /// The sample time.
    pub period: Rational,
    /// Behind a sample, in samples, where what it commands begins, or where the edges of its pulse stand.
    pub places: Vec<Rational>,
}

impl OnlyHold {
    /// The next dead time beyond this one at which one of the places is a whole number of samples: another loop begins there.
    pub fn next_break(&self, more: &Rational) -> Option<Rational> {
        let next = |place: &Rational| &Rational::from((place + more).floor() + Integer::ONE) - place;
        self.places.iter().map(next).min()
    }
}

/// Dead time added at a hold, in samples.
pub enum MoreDeadTime {
    /// So much.
    Samples(Rational),
    /// A variable; near these values of the kept names and of itself.
    Near(Vec<Rational>),
}

impl Model {
    /// The cut of a name: a signal that some block drives, a block with one input, or a parameter; without a name, the `at` of
    /// the model's `[require]`, else the error of the only loop of a block diagram, the plant's only input, or the only parameter.
    ///
    /// Cost: a search through the diagram.
    ///
    /// # Errors
    /// `E-unknown-signal`; `E-cut` where no name is given and it is not clear which loop is meant, or a block has several inputs.
    pub fn cut(&self, at: Option<&str>) -> Result<Cut, Diagnostics> {
        let refused = |error: Diagnostic| Diagnostics::new(Some(self.source().clone()), vec![error]);
        let required = || self.require().iter().find(|r| r.name == "at").map(|r| r.text.as_str());
        let at = at.or_else(required);
        if let (Form::Blocks(diagram), Some(name)) = (&self.form, at) {
            if diagram.driven().any(|(signal, _)| signal.name == name) {
                return Ok(Cut::Signal(name.to_owned()));
            }
            if let Some(block) = diagram.blocks.iter().find(|b| b.name == name) {
                if block.inputs.len() == 1 {
                    return Ok(Cut::Input(name.to_owned()));
                }
                let error = Diagnostic::error(Code::Cut, format!("the block '{}' has several inputs", shorten(name)));
                return Err(refused(error.at(block.span, "which of them?").help(candidates(diagram))));
            }
        }
        match (&self.form, at) {
            (Form::OutputFeedback { b, .. }, None | Some(PLANT_INPUT)) if b.size().1 == 1 => Ok(Cut::PlantInput),
            (_, Some(name)) if self.parameter(name).is_some() || self.constant(name).is_some() => {
                self.free(name).map(|_| Cut::Gain(name.to_owned()))
            }
            (Form::Blocks(diagram), None) => only_error(diagram).ok_or_else(|| {
                let error = Diagnostic::error(
                    Code::Cut,
                    "the diagram has no single loop, so it has to be said where it is cut",
                );
                refused(error.help(candidates(diagram)))
            }),
            (_, None) => match self.parameters() {
                [only] => Ok(Cut::Gain(only.name.clone())),
                parameters => Err(refused(not_said_which(parameters))),
            },
            (_, Some(name)) => Err(refused(self.nothing_to_cut(name))),
        }
    }

    fn nothing_to_cut(&self, name: &str) -> Diagnostic {
        let message = format!("the loop has no signal '{}' to cut", shorten(name));
        let mut error = Diagnostic::error(Code::UnknownSignal, message);
        let parameters = self.parameters().iter().map(|p| p.name.as_str());
        error.help = match &self.form {
            Form::Blocks(diagram) => {
                let blocks = diagram.blocks.iter().map(|b| b.name.as_str());
                let names = diagram.driven().map(|(s, _)| s.name.as_str()).chain(blocks);
                did_you_mean(name, names.chain(parameters)).or_else(|| Some(candidates(diagram)))
            }
            _ => did_you_mean(name, parameters.clone())
                .or_else(|| Some(format!("--at one of the parameters {}", list(parameters.take(8))))),
        };
        error
    }

    /// A place to begin at where [`Model::cut`] wants a name: the input of the only block on a loop that compares with the first external
    /// input, which is the reference, else the first signal that comes back; the first of the parameters where the model is no block diagram.
    /// `None` where there is no place.
    ///
    /// ```
    /// use jurist_model::Model;
    /// let (model, _) = Model::from_bytes("two loops", br#"
    /// time = "continuous"
    /// loop = { inputs = ["r", "d"], outputs = ["y"] }
    /// block = [
    ///     { name = "C", input = "r - y - w", output = "u", transfer = "1/s" },
    ///     { name = "P", input = "u + d", output = "y", transfer = "1/(s + 1)" },
    ///     { name = "F", input = "u", output = "w", transfer = "1/(s + 2)" },
    /// ]
    /// "#)?;
    /// assert!(model.cut(None).is_err());
    /// assert_eq!(model.first_cut().as_deref(), Some("C"));
    /// # Ok::<(), jurist_model::error::Error>(())
    /// ```
    pub fn first_cut(&self) -> Option<String> {
        let Form::Blocks(diagram) = &self.form else { return self.parameters().first().map(|p| p.name.clone()) };
        let successors = successors(diagram);
        let cyclic = |(i, _): &(usize, &Block)| reached(*i, &successors)[*i];
        let blocks: Vec<_> = diagram.blocks.iter().enumerate().filter(cyclic).map(|(_, b)| b).collect();
        let compares = |b: &&&Block| match (diagram.inputs.first(), &b.inputs[..]) {
            (Some(reference), [sum]) => sum.names().contains(reference.name.as_str()),
            _ => false,
        };
        let comparing: Vec<_> = blocks.iter().filter(compares).collect();
        match comparing[..] {
            [only] => Some(only.name.clone()),
            _ => blocks.iter().flat_map(|b| &b.outputs).next().map(|o| o.name.clone()),
        }
    }

    /// The loop opened at a cut that is a signal.
    ///
    /// Cost: that of evaluating the expressions and of connecting the blocks.
    ///
    /// # Errors
    /// As [`Model::evaluate`]; undefined also where what is left of the diagram has an algebraic loop that is not well posed.
    pub fn opened(
        &self,
        cut: &Cut,
        kept: &[String],
        values: &[(String, Rational)],
        budget: &Budget,
    ) -> Result<Opened, Error> {
        self.opened_in(self.answer(kept, values, budget)?, cut, budget)
    }

    /// The same where numbers are all that is asked for: the exponentials of matrices behind holds stay whole.
    ///
    /// Cost: that of [`Model::opened`].
    ///
    /// # Errors
    /// As [`Model::opened`].
    pub fn opened_in_numbers(
        &self,
        cut: &Cut,
        kept: &[String],
        values: &[(String, Rational)],
        budget: &Budget,
    ) -> Result<Opened, Error> {
        let mut answer = self.answer(kept, values, budget)?;
        answer.symbols = RefCell::new(answer.symbols.into_inner().keeping_flows());
        self.opened_in(answer, cut, budget)
    }

    fn opened_in(&self, mut answer: Answer<'_>, cut: &Cut, budget: &Budget) -> Result<Opened, Error> {
        if let Cut::Between(between) = cut {
            return self.closed_between(answer, between, budget);
        }
        if let Values::Feedback { a, b, c, k, .. } = &answer.values {
            let (a, b, returned) = (a.clone(), b.clone(), product(k, c));
            let row = |i: usize| -> Row { (0..a.rows()).map(|j| (j, -&returned[(i, j)])).collect() };
            let ports = PortValues { input_matrix: Some(b), outputs: (0..returned.rows()).map(row).collect() };
            answer.values = Values::Matrix { matrix: a, ports };
            answer.wiring.inputs = answer.wiring.parts_of(PLANT_INPUT);
            return self.opened_with(answer, PLANT_INPUT, budget);
        }
        answer.start = self.start_at(cut)?;
        open_diagram(&mut answer, cut, self)?;
        self.opened_with(answer, cut.name(), budget)
    }

    /// At which sample a hyperperiod begins in which what is cut is used once: with several rates only such a loop has a transfer function
    /// from one hyperperiod to the next.
    fn start_at(&self, cut: &Cut) -> Result<Option<u64>, Error> {
        let steps = self.hyperperiod();
        let Form::Blocks(diagram) = &self.form else { return Ok(None) };
        if steps == 1 {
            return Ok(None);
        }
        let is_once = |block: &&Block| block.rate.every == steps;
        let once = match cut {
            Cut::Input(name) => diagram.blocks.iter().find(|b| b.name == *name).filter(is_once),
            _ => {
                let signal = cut.name();
                let driver = diagram.blocks.iter().find(|b| b.outputs.iter().any(|o| o.name == signal));
                let mut readers = diagram.blocks.iter().filter(|b| b.inputs.iter().any(|e| e.names().contains(signal)));
                let first = readers.next();
                let same = first.filter(|first| readers.all(|other| other.rate == first.rate));
                driver.filter(is_once).or(same.filter(is_once))
            }
        };
        if let Some(block) = once {
            return Ok(Some(block.rate.phase));
        }
        let slow: Vec<&str> =
            diagram.blocks.iter().filter(is_once).flat_map(|b| &b.outputs).map(|o| o.name.as_str()).collect();
        let message = format!(
            "'{}' is used more than once in {steps} samples: the loop has no transfer function there",
            shorten(cut.name())
        );
        let error = Diagnostic::error(Code::RateMargin, message);
        let error = error.help(match slow.is_empty() {
            true => "a gain margin is 'intervals' with a factor at that place".to_owned(),
            false => format!(
                "--at one of {}; elsewhere a gain margin is 'intervals' with a factor at that place",
                list(slow)
            ),
        });
        Err(Diagnostics::new(Some(self.source().clone()), vec![error]).into())
    }

    /// The only block behind a hold or a modulator, if it has one input: what its dead time in samples is. `None` also where that depends on a kept name.
    ///
    /// Cost: that of evaluating the expressions.
    ///
    /// # Errors
    /// As [`Model::evaluate`].
    pub fn only_hold(
        &self,
        kept: &[String],
        values: &[(String, Rational)],
        budget: &Budget,
    ) -> Result<Option<OnlyHold>, Error> {
        let answer = self.answer(kept, values, budget)?;
        let Values::Blocks { blocks, .. } = &answer.values else { return Ok(None) };
        let mut holds = blocks.iter().filter_map(|b| match &b.discretization {
            Some(DiscretizationValues::Hold(hold)) => Some((b, hold)),
            _ => None,
        });
        let (Some((block, hold)), None) = (holds.next(), holds.next()) else { return Ok(None) };
        let number = |f: &RationalFunction| answer.substituted(f).and_then(|f| f.as_constant());
        let (Some(period), Some(delay)) = (number(&hold.time), number(&hold.delay)) else { return Ok(None) };
        let one_input = block.inputs.len() == answer.wiring.parts_of("").len();
        let Some(samples) = delay.checked_div(&period).filter(|_| one_input) else { return Ok(None) };
        let edges = hold.pulses.iter().flatten().flat_map(|pulse| pulse.edges.iter().flatten());
        let Some(edges) = edges.map(number).collect::<Option<Vec<Rational>>>() else { return Ok(None) };
        let edges = if edges.is_empty() { vec![Rational::ZERO] } else { edges };
        let places = edges.iter().map(|edge| edge + &samples).collect();
        Ok(Some(OnlyHold { block: block.name.clone(), period, places }))
    }

    /// The closed loop with more dead time at the only hold: a number of samples, or the variable behind those of the kept names.
    ///
    /// Cost: that of evaluating the expressions and of connecting the blocks.
    ///
    /// # Errors
    /// As [`Model::evaluate`].
    ///
    /// # Panics
    /// When there is no hold.
    pub fn with_dead_time(
        &self,
        more: &MoreDeadTime,
        free: &[String],
        values: &[(String, Rational)],
        budget: &Budget,
    ) -> Result<(ClosedLoop, Symbols), Error> {
        let mut kept = free.to_vec();
        if let MoreDeadTime::Near(_) = more {
            kept.push("more samples".to_owned());
        }
        let mut answer = self.answer(&kept, values, budget)?;
        // One more variable of the values, whose image is the number or the variable that is free.
        let variable = RationalFunction::variable(answer.images.len());
        answer.images.push(match more {
            MoreDeadTime::Samples(samples) => samples.clone().into(),
            MoreDeadTime::Near(_) => RationalFunction::variable(free.len()),
        });
        if let MoreDeadTime::Near(near) = more {
            answer.symbols = RefCell::new(answer.symbols.into_inner().near(near));
        }
        let Values::Blocks { blocks, .. } = &mut answer.values else { return Err(self.has_no_states()) };
        for block in blocks {
            if let Some(DiscretizationValues::Hold(hold)) = &mut block.discretization {
                hold.delay = &hold.delay + &(&hold.time * &variable);
            }
        }
        let (closed_loop, _, symbols) = self.connected(answer, budget)?;
        Ok((closed_loop, symbols))
    }

    fn opened_with(&self, answer: Answer<'_>, output: &str, budget: &Budget) -> Result<Opened, Error> {
        let (system, sample_time, symbols) = self.connected_with(answer, vec![output.to_owned()], budget)?;
        Ok(Opened { system, sample_time, symbols, is_closed: false })
    }
}

/// Puts a new external signal in the place of the cut one, which becomes the only output.
fn open_diagram(answer: &mut Answer<'_>, cut: &Cut, model: &Model) -> Result<(), Error> {
    let (Values::Blocks { blocks, outputs }, Form::Blocks(diagram)) = (&mut answer.values, &model.form) else {
        return Err(model.has_no_states());
    };
    let new = answer.wiring.driven + answer.wiring.inputs.len();
    let one = |i: usize| Row::from([(i, RationalFunction::one())]);
    let names = answer.wiring.parts_of("the cut");
    let parts = 0..names.len();
    *outputs = match cut {
        Cut::Input(name) => {
            let place = diagram.blocks.iter().position(|b| b.name == *name).expect("the cut is one of the diagram's");
            parts.map(|part| std::mem::replace(&mut blocks[place].inputs[part], one(new + part))).collect()
        }
        _ => {
            let cut = names.len() * answer.wiring.numbers[cut.name()];
            for row in blocks.iter_mut().flat_map(|b| &mut b.inputs) {
                for part in parts.clone() {
                    if let Some(c) = row.remove(&(cut + part)) {
                        row.insert(new + part, c);
                    }
                }
            }
            parts.map(|part| one(cut + part)).collect()
        }
    };
    answer.wiring.inputs.extend(names);
    Ok(())
}

/// For each block, the numbers of the blocks that read one of its outputs.
fn successors(diagram: &Diagram) -> Vec<Vec<usize>> {
    let reads: Vec<Vec<&str>> =
        diagram.blocks.iter().map(|b| b.inputs.iter().flat_map(|e| e.names()).collect()).collect();
    let gives = |b: &Block, names: &[&str]| b.outputs.iter().any(|o| names.contains(&o.name.as_str()));
    let after = |b| reads.iter().enumerate().filter(|(_, names)| gives(b, names)).map(|(j, _)| j).collect();
    diagram.blocks.iter().map(after).collect()
}

/// What can be reached from a block, itself only if a way leads back.
fn reached(from: usize, successors: &[Vec<usize>]) -> Vec<bool> {
    let mut seen = vec![false; successors.len()];
    let mut open = vec![from];
    while let Some(b) = open.pop() {
        for &next in &successors[b] {
            if !std::mem::replace(&mut seen[next], true) {
                open.push(next);
            }
        }
    }
    seen
}

/// The input of a block of the only cycle: of the first one that compares with an external signal, if there is one.
fn only_error(diagram: &Diagram) -> Option<Cut> {
    let successors = successors(diagram);
    let reached: Vec<Vec<bool>> = (0..successors.len()).map(|b| reached(b, &successors)).collect();
    let on_cycle: Vec<usize> = (0..successors.len()).filter(|&b| reached[b][b]).collect();
    for &b in &on_cycle {
        let back = |&&next: &&usize| next == b || reached[next][b];
        if successors[b].iter().filter(back).count() != 1 || !on_cycle.iter().all(|&c| reached[b][c]) {
            return None;
        }
    }
    let scalar: Vec<_> = on_cycle.iter().map(|&b| &diagram.blocks[b]).filter(|b| b.inputs.len() == 1).collect();
    let external = |name: &&str| diagram.inputs.iter().any(|i| i.name == *name);
    let compares = |b: &&&Block| b.inputs[0].names().iter().any(|n| external(&&**n));
    let block = scalar.iter().find(compares).or_else(|| scalar.first())?;
    Some(Cut::Input(block.name.clone()))
}

fn not_said_which(parameters: &[Parameter]) -> Diagnostic {
    let names = list(parameters.iter().take(8).map(|p| p.name.as_str()));
    let help = match names.is_empty() {
        true => {
            "the model has no parameter that is a gain: write one into it, as K in 's^2 + s + K', or give an open loop \
                 with its denominator, such as 'K/(s*(s + 1))'"
                .to_owned()
        }
        false => format!("--at one of {names}"),
    };
    Diagnostic::error(Code::Cut, "it has to be said which parameter is the loop's gain").help(help)
}

/// The places where something comes back.
fn candidates(diagram: &Diagram) -> String {
    /// Names that are listed.
    const SHOWN: usize = 12;
    let successors = successors(diagram);
    let cyclic = |b: usize| reached(b, &successors)[b];
    let blocks: Vec<_> = diagram.blocks.iter().enumerate().filter(|(i, _)| cyclic(*i)).map(|(_, b)| b).collect();
    let signals = blocks.iter().flat_map(|b| &b.outputs).map(|o| o.name.as_str());
    let signals = list(signals.take(SHOWN));
    let inputs = list(blocks.iter().filter(|b| b.inputs.len() == 1).map(|b| b.name.as_str()).take(SHOWN));
    match (signals.is_empty(), inputs.is_empty()) {
        (true, _) => "nothing is fed back in this diagram".to_owned(),
        (false, true) => format!("--at one of the signals {signals}"),
        (false, false) => format!("--at one of the signals {signals}, or at the input of a block: {inputs}"),
    }
}
