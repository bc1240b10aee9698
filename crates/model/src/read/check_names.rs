//! Whether the names and values of a model make sense.

use super::reader::Reader;
use super::{ship, simulation, tune};
use crate::definition::{
    Block, Constant, Diagram, Discretization, Dynamics, Form, Matrix, Model, Name, Output, Parameter, Ports, Position,
    Time,
};
use crate::error::{Code, Diagnostic, Span};
use crate::text::names::{did_you_mean, known_names, nearest_name, shorten};
use crate::text::{Expression, Function, PI, UNIT, hint};
use std::collections::{HashMap, HashSet};

/// Unknown names for which a known one is looked for: no more are shown.
const HINTED: usize = 100;

/// Names with a meaning of their own.
const RESERVED: [(&str, &str); 2] =
    [("radius", "the radius of the stability region"), ("decay", "the decay rate of the stability region")];

fn reserved(name: &str, time: Time) -> Option<&'static str> {
    if name == time.variable() {
        return Some("the polynomial variable");
    }
    RESERVED.iter().find(|(reserved, _)| *reserved == name).map(|(_, meaning)| *meaning)
}

fn check_reserved(name: &str, span: Span, time: Time, reader: &mut Reader) {
    if let Some(meaning) = reserved(name, time) {
        let error = Diagnostic::error(Code::ReservedName, format!("the name '{name}' is reserved"));
        reader.report(error.at(span, format!("stands for {meaning}")).help("choose another name"));
    }
}

/// Fills the index of constants and parameters.
pub(super) fn definitions(
    constants: &[Constant],
    parameters: &[Parameter],
    time: Time,
    index: &mut HashMap<String, Position>,
    reader: &mut Reader,
) {
    let named = constants.iter().map(|c| (&c.name, c.span)).chain(parameters.iter().map(|p| (&p.name, p.span)));
    let is_known = |name: &str| name == PI || name == UNIT || Function::named(name).is_some();
    for (name, span) in named.filter(|(name, _)| is_known(name)) {
        let what = match name.as_str() {
            PI => "the circle number",
            UNIT => "the imaginary unit",
            _ => "a function",
        };
        let message = format!("here '{name}' is not {what}");
        reader.report(
            Diagnostic::warning(Code::OwnMeaningWarning, message).at(span, "has a meaning of its own in this model"),
        );
    }
    for matrix in &reader.matrices {
        if let Some(p) = parameters.iter().find(|p| p.name == matrix.name.name) {
            let message = format!("'{}' is both a constant and a parameter", shorten(&p.name));
            let error = Diagnostic::error(Code::DuplicateName, message).at(p.span, "a parameter here");
            reader.diagnostics.push(error.also(matrix.name.span, "a constant here").help("rename one of them"));
        }
    }
    for (i, c) in constants.iter().enumerate() {
        check_reserved(&c.name, c.span, time, reader);
        index.insert(c.name.clone(), Position::Constant(i));
    }
    for (i, p) in parameters.iter().enumerate() {
        check_reserved(&p.name, p.span, time, reader);
        if let Some(Position::Constant(first)) = index.insert(p.name.clone(), Position::Parameter(i)) {
            let message = format!("'{}' is both a constant and a parameter", shorten(&p.name));
            let error = Diagnostic::error(Code::DuplicateName, message).at(p.span, "a parameter here");
            let error = error.also(constants[first].span, "a constant here");
            reader.report(error.help("a constant given as a number can be varied as it is: remove the parameter"));
        }
    }
}

/// The constants, and the parameters with a formula for their nominal value, in an order in which each uses earlier ones only.
pub(super) fn order(
    constants: &[Constant],
    parameters: &[Parameter],
    index: &HashMap<String, Position>,
    reader: &mut Reader,
) -> Vec<Position> {
    #[derive(Clone, Copy, PartialEq)]
    enum State {
        New,
        Open,
        Done,
    }
    let formulas = parameters.iter().enumerate().filter_map(|(i, p)| Some((i, p, p.nominal_formula.as_ref()?)));
    let formulas =
        formulas.map(|(i, p, e)| Defined { position: Position::Parameter(i), name: &p.name, span: e.span, e });
    let defined = constants.iter().enumerate().map(|(i, c)| {
        let position = Position::Constant(i);
        Defined { position, name: &c.name, span: c.span, e: &c.expression }
    });
    let defined: Vec<Defined<'_>> = defined.chain(formulas).collect();
    let place: HashMap<Position, usize> = defined.iter().enumerate().map(|(k, one)| (one.position, k)).collect();
    let used = |name: &str| place.get(index.get(name)?).copied();
    let uses: Vec<Vec<usize>> =
        defined.iter().map(|one| one.e.names().into_iter().filter_map(used).collect()).collect();
    let mut state = vec![State::New; defined.len()];
    let mut order = Vec::new();
    for root in 0..defined.len() {
        if state[root] != State::New {
            continue;
        }
        // Depth first with a stack of its own: chains of constants may be as long as the file.
        let mut stack = vec![(root, 0)];
        state[root] = State::Open;
        while let Some((current, next)) = stack.pop() {
            let Some(&used) = uses[current].get(next) else {
                state[current] = State::Done;
                order.push(defined[current].position);
                continue;
            };
            stack.push((current, next + 1));
            match state[used] {
                State::New => {
                    state[used] = State::Open;
                    stack.push((used, 0));
                }
                State::Open => {
                    let from = stack.iter().position(|&(i, _)| i == used).unwrap_or(0);
                    let cycle: Vec<&Defined<'_>> = stack[from..].iter().map(|&(i, _)| &defined[i]).collect();
                    reader.report(cycle_error(&cycle));
                }
                State::Done => {}
            }
        }
    }
    order
}

/// What has a value by a formula, and where that is to be seen.
struct Defined<'m> {
    position: Position,
    name: &'m str,
    span: Span,
    e: &'m Expression,
}

fn cycle_error(cycle: &[&Defined<'_>]) -> Diagnostic {
    /// Members of a cycle that are shown.
    const SHOWN: usize = 8;
    let first = cycle[0];
    let mut path: Vec<String> = cycle.iter().take(SHOWN).map(|c| shorten(c.name).into_owned()).collect();
    if cycle.len() > SHOWN {
        path.push("...".into());
    }
    path.push(shorten(first.name).into_owned());
    let is_constant = |one: &&Defined<'_>| matches!(one.position, Position::Constant(_));
    let what = match (cycle.iter().any(is_constant), cycle.iter().all(is_constant)) {
        (_, true) => "constants",
        (true, false) => "constants and nominal values",
        (false, false) => "nominal values",
    };
    let message = format!("{what} are defined by each other: {}", path.join(" -> "));
    let mut error = Diagnostic::error(Code::Cycle, message).at(first.span, "depends on itself");
    for c in cycle.iter().skip(1).take(SHOWN) {
        error = error.also(c.span, "by way of this");
    }
    error.help("give one of them a value of its own")
}

/// The names of one kind of place.
struct Allowed<'m> {
    model: &'m Model,
    /// Signals or states; the polynomial variable.
    further: Vec<&'m str>,
    what: &'static str,
}

struct Names<'m, 'r> {
    model: &'m Model,
    used: HashSet<&'m str>,
    reported: HashSet<&'m str>,
    /// Whether a signal has the name of something else: then another signal is probably missing.
    misnamed: bool,
    reader: &'r mut Reader,
}

impl<'m> Names<'m, '_> {
    fn expression(&mut self, e: &'m Expression, further: &HashSet<&'m str>, what: &'static str) {
        e.each_name(&mut |name, span| {
            if further.contains(name) || self.model.index.contains_key(name) {
                self.used.insert(name);
            } else if name == PI {
                // The circle number.
            } else if name == UNIT {
                self.reader.has_unit = true;
            } else if let Some(matrix) = self.reader.matrices.iter().find(|m| m.name.name == name) {
                let message = format!("'{}' is a matrix", shorten(name));
                let error = Diagnostic::error(Code::Type, message).at(span, "a number belongs here");
                let error = error.also(matrix.name.span, "a matrix here");
                self.reader.report(error.help("blocks take matrices by name as a whole: A = \"..\""));
            } else if !self.reader.refused.contains(name) && self.reported.insert(name) {
                if self.reported.len() > HINTED {
                    return self
                        .reader
                        .report(Diagnostic::error(Code::UnknownName, "unknown name").at(span, "not defined"));
                }
                let allowed = Allowed { model: self.model, further: further.iter().copied().collect(), what };
                let error = unknown(name, span, &allowed);
                let is_follow_up = self.misnamed && !what.is_empty() && nearest(name, &allowed).is_none();
                if !is_follow_up {
                    self.reader.report(error);
                }
            }
        });
    }

    fn matrix(&mut self, matrix: &'m Matrix, further: &HashSet<&'m str>) {
        matrix.entries().for_each(|e| self.expression(e, further, ""));
    }
}

impl<'m> Allowed<'m> {
    /// Every name that would be accepted.
    fn names(&self) -> impl Iterator<Item = &'m str> {
        let model = self.model;
        let mut further = self.further.clone();
        further.sort_unstable();
        let parameters = model.parameters.iter().map(|p| p.name.as_str());
        parameters.chain(model.constants.iter().map(|c| c.name.as_str())).chain(further)
    }
}

fn nearest<'m>(name: &str, allowed: &Allowed<'m>) -> Option<&'m str> {
    nearest_name(name, allowed.names())
}

fn unknown(name: &str, span: Span, allowed: &Allowed<'_>) -> Diagnostic {
    let model = allowed.model;
    let label = if allowed.what.is_empty() {
        "not defined".to_owned()
    } else {
        format!("neither defined nor {}", allowed.what)
    };
    let mut error = Diagnostic::error(Code::UnknownName, format!("unknown name '{}'", shorten(name))).at(span, label);
    error.help = hint(name).or_else(|| did_you_mean(name, allowed.names()));
    if error.help.is_none() {
        let variable = model.time.variable();
        error.help = Some(match name {
            "s" if variable == "z" => {
                "the variable of a discrete loop is z; a block in s has discretize = \"zoh\" (behind a hold) or \"tustin\"".into()
            }
            "z" if variable == "s" => "the variable of a continuous loop is s".into(),
            _ if name == variable => format!("{variable} is known in 'characteristic' and 'transfer' only"),
            _ => known_names(allowed.names()).unwrap_or_else(|| "define it in [constants] or [parameters]".into()),
        });
    }
    error
}

/// Reports every name that is not known, used twice, or not used.
pub(super) fn names(model: &Model, form_is_broken: bool, reader: &mut Reader) {
    let none = HashSet::new();
    let mut names = Names { model, used: HashSet::new(), reported: HashSet::new(), misnamed: false, reader };
    for c in &model.constants {
        names.expression(&c.expression, &none, "");
    }
    for formula in model.parameters.iter().filter_map(|p| p.nominal_formula.as_ref()) {
        names.expression(formula, &none, "");
    }
    matrices_without_use(&mut names);
    if let Some(e) = &model.sample_time {
        names.expression(e, &none, "");
        if model.time == Time::Continuous {
            let message = "a sample time says nothing in continuous time";
            names.reader.unused(message, e.span);
        }
    }
    if form_is_broken {
        return;
    }
    match &model.form {
        Form::Characteristic(e) => names.expression(e, &HashSet::from([model.time.variable()]), ""),
        Form::Matrix { matrix, ports } => {
            names.matrix(matrix, &none);
            check_ports(&mut names, ports);
        }
        Form::OutputFeedback { a, b, c, k, ports } => {
            [a, b, c, k].into_iter().for_each(|m| names.matrix(m, &none));
            check_ports(&mut names, ports);
        }
        Form::Blocks(diagram) => check_diagram(&mut names, diagram),
    }
    let Names { used, reader, .. } = names;
    simulation::check(model, reader);
    ship::check(model, reader);
    tune::check(model, reader);
    let constants = model.constants.iter().map(|c| (&c.name, c.span, "constant"));
    let parameters = model.parameters.iter().map(|p| (&p.name, p.span, "parameter"));
    for (name, span, what) in constants.chain(parameters).filter(|(name, ..)| !used.contains(name.as_str())) {
        let message = format!("the {what} '{}' is not used", shorten(name));
        reader.unused(message, span);
    }
}

/// Each signal is driven once and every external input enters somewhere.
fn check_diagram<'m>(names: &mut Names<'m, '_>, diagram: &'m Diagram) {
    let mut places: HashMap<&str, (Span, &str)> = HashMap::new();
    distinct(names, &diagram.inputs, "input");
    let mut once = HashSet::new();
    let inputs = diagram.inputs.iter().filter(|n| once.insert(n.name.as_str()));
    let external = inputs.map(|n| (n, "an external input"));
    for (name, what) in external.chain(diagram.driven().map(|(n, _)| (n, "driven by a block"))) {
        if what != "an external input" {
            own_name(names, name);
        }
        if let Some((first, before)) = places.insert(&name.name, (name.span, what)) {
            let message = format!("the signal '{}' has two drivers", shorten(&name.name));
            let error = Diagnostic::error(Code::TwoDrivers, message).at(name.span, what).also(first, before);
            names.reader.report(error.help("add the two in a block's input: input = \"a + b\""));
        }
    }
    let signals: HashSet<&str> = places.into_keys().collect();
    for block in &diagram.blocks {
        check_block(names, block, &signals);
    }
    outputs(names, &diagram.outputs, &signals);
    for input in diagram.inputs.iter().filter(|n| !names.used.contains(n.name.as_str())) {
        let message = format!("the external input '{}' enters nowhere", shorten(&input.name));
        names.reader.unused(message, input.span);
    }
}

/// Warns of matrices that no block uses. What stands in them is not unused as well.
fn matrices_without_use(names: &mut Names<'_, '_>) {
    let model = names.model;
    for matrix in names.reader.matrices.iter().filter(|m| !m.is_used) {
        for name in matrix.matrix.entries().flat_map(Expression::names) {
            names.used.extend(model.index.get_key_value(name).map(|(name, _)| name.as_str()));
        }
    }
    let unused: Vec<Name> = names.reader.matrices.iter().filter(|m| !m.is_used).map(|m| m.name.clone()).collect();
    for name in unused {
        names.reader.unused(format!("the constant '{}' is not used", shorten(&name.name)), name.span);
    }
}

/// A signal or state must not have the name of something else.
fn own_name(names: &mut Names<'_, '_>, name: &Name) {
    check_reserved(&name.name, name.span, names.model.time, names.reader);
    let (place, what) = match names.model.index.get(&name.name) {
        Some(Position::Constant(i)) => (names.model.constants[*i].span, "a constant here"),
        Some(Position::Parameter(i)) => (names.model.parameters[*i].span, "a parameter here"),
        None => return,
    };
    names.misnamed = true;
    let message = format!("'{}' has two meanings", shorten(&name.name));
    let error = Diagnostic::error(Code::DuplicateName, message).at(name.span, "a signal here").also(place, what);
    names.reader.report(error.help("rename one of them"));
}

fn distinct(names: &mut Names<'_, '_>, list: &[Name], what: &str) {
    list.iter().for_each(|name| own_name(names, name));
    once(list.iter(), what, names.reader);
}

/// Reports every name that stands in a list again.
fn once<'n>(list: impl Iterator<Item = &'n Name>, what: &str, reader: &mut Reader) {
    let mut seen: HashMap<&str, Span> = HashMap::new();
    for name in list {
        if let Some(first) = seen.get(name.name.as_str()) {
            let message = format!("the {what} '{}' is named twice", shorten(&name.name));
            let error = Diagnostic::error(Code::DuplicateName, message).at(name.span, "here again");
            reader.report(error.also(*first, "first here").help("name it once"));
        } else {
            seen.insert(&name.name, name.span);
        }
    }
}

fn check_ports<'m>(names: &mut Names<'m, '_>, ports: &'m Ports) {
    distinct(names, &ports.states, "state");
    distinct(names, &ports.inputs, "input");
    if let Some(e) = &ports.input_matrix {
        names.matrix(e, &HashSet::new());
    }
    let states: HashSet<&str> = ports.states.iter().map(|n| n.name.as_str()).collect();
    outputs(names, &ports.outputs, &states);
}

fn outputs<'m>(names: &mut Names<'m, '_>, outputs: &'m [Output], signals: &HashSet<&'m str>) {
    once(outputs.iter().map(|o| &o.name), "output", names.reader);
    for output in outputs {
        names.expression(&output.expression, signals, "a signal or state");
    }
}

fn check_block<'m>(names: &mut Names<'m, '_>, block: &'m Block, signals: &HashSet<&'m str>) {
    let none = HashSet::new();
    for e in &block.inputs {
        names.expression(e, signals, "a signal that is driven");
    }
    let variable = if block.discretization.is_some() { "s" } else { names.model.time.variable() };
    let variables = HashSet::from([variable]);
    match &block.dynamics {
        Dynamics::Transfer(e) => {
            if let Some(position) = names.model.index.get(variable).filter(|_| variable != names.model.time.variable())
            {
                let span = match position {
                    Position::Constant(i) => names.model.constants[*i].span,
                    Position::Parameter(i) => names.model.parameters[*i].span,
                };
                let error = Diagnostic::error(Code::ReservedName, format!("the name '{variable}' is reserved"));
                let error = error.at(span, "a discretised block uses this name for its variable");
                names.reader.report(error.also(e.span, "here"));
            }
            names.expression(e, &variables, "");
        }
        Dynamics::Ratio { numerator, denominator } => {
            numerator.iter().chain(denominator).for_each(|e| names.expression(e, &none, ""));
        }
        Dynamics::Gain(e) | Dynamics::Delay(e) | Dynamics::DeadTime(e) => names.expression(e, &none, ""),
        Dynamics::StateSpace { a, b, c, d } => {
            [Some(a), Some(b), c.as_ref(), d.as_ref()].into_iter().flatten().for_each(|m| names.matrix(m, &none));
        }
        Dynamics::Static(d) => names.matrix(d, &none),
    }
    if let Some(Discretization { sample_time, factor, prewarp, delay, frame, advance, pulses, .. }) =
        &block.discretization
    {
        let duties = pulses.iter().filter(|pulses| !pulses.is_steady).flat_map(|pulses| &pulses.duties);
        let parts = [sample_time, factor, prewarp, delay, frame, advance].into_iter().flatten();
        parts.chain(duties).for_each(|e| names.expression(e, &none, ""));
    }
    block.sample_time.iter().for_each(|e| names.expression(e, &none, ""));
    if let Some(pwm) = &block.pwm {
        [&pwm.amplitude, &pwm.carrier, &pwm.period].into_iter().for_each(|e| names.expression(e, &none, ""));
    }
}
