//! Rust, without the standard library.

use super::numbers;
use super::statements::{ARGUMENT, Code, Constant, Kind, WIDE};
use super::syntax::{Syntax, Written, assigned, harmless, indented, statements};
use jurist_algebra::number::{BinaryFormat, Integer, Rational};

pub(super) struct Rust {
    /// The type of the controller.
    kind: String,
}

impl Rust {
    /// A type is called as the controller, in the letters of types: `SpeedLoop` for `speed_loop`.
    pub fn new(name: &str) -> Rust {
        let capital = |part: &str| part[..1].to_ascii_uppercase() + &part[1..];
        Rust { kind: name.split('_').map(capital).collect() }
    }

    fn constants(&self, code: &Code) -> Vec<String> {
        let line = |constant: &Constant| {
            let value = match constant.kind {
                Kind::Float(format) => self.real(format, &constant.value),
                Kind::Integer(_) => constant.value.to_string(),
            };
            let remark = self.remark(&constant.remark);
            format!("const {}: {} = {value}; {remark}", constant.name, self.kind(constant.kind))
        };
        code.constants.iter().map(line).collect()
    }

    fn states(&self, code: &Code) -> Vec<String> {
        let kind = self.kind(code.signal);
        let begin = ["/// A controller with its states.", "#[derive(Clone, Debug, Default, PartialEq)]"];
        let mut all = begin.map(str::to_owned).to_vec();
        if code.states.is_empty() {
            all.push(format!("pub struct {} {{}}", self.kind));
            return all;
        }
        all.push(format!("pub struct {} {{", self.kind));
        all.extend(code.states.iter().map(|state| format!("    pub {state}: {kind},")));
        all.push("}".into());
        all
    }

    fn methods(&self, code: &Code) -> Vec<String> {
        let kind = self.kind(code.signal);
        let zero = if matches!(code.signal, Kind::Float(_)) { "0.0" } else { "0" };
        let zeros: Vec<String> = code.states.iter().map(|state| format!("{state}: {zero}")).collect();
        let arguments: String = code.inputs.iter().map(|input| format!(", {input}: {kind}")).collect();
        let (returned, value) = match code.outputs.as_slice() {
            [one] => (kind.to_owned(), one.clone()),
            many => (format!("[{kind}; {}]", many.len()), format!("[{}]", many.join(", "))),
        };
        let mut inner = vec![
            "/// The controller at rest: all states are zero.".to_owned(),
            "pub const fn new() -> Self {".into(),
            format!("    Self {{ {} }}", zeros.join(", ")),
            "}".into(),
            String::new(),
            "/// Brings the controller to rest.".into(),
            "pub fn reset(&mut self) {".into(),
            "    *self = Self::new();".into(),
            "}".into(),
            String::new(),
            "/// One sample: the outputs from the inputs, and then the next states.".into(),
            format!("pub fn step(&mut self{arguments}) -> {returned} {{"),
        ];
        inner.extend(indented(&statements(self, "", &code.step)));
        inner.extend([format!("    {value}"), "}".into()]);
        let begin = [
            "#[allow(dead_code, clippy::all)] // Not every program calls reset; statements are those of other languages.",
            "#[rustfmt::skip] // A line for each term.",
        ];
        let begin = begin.map(str::to_owned).to_vec();
        [begin, vec![format!("impl {} {{", self.kind)], indented(&inner), vec!["}".into()]].concat()
    }
}

impl Syntax for Rust {
    fn kind(&self, kind: Kind) -> &'static str {
        match kind {
            Kind::Integer(16) => "i16",
            Kind::Integer(32) => "i32",
            Kind::Integer(_) => "i64",
            Kind::Float(BinaryFormat::Single) => "f32",
            Kind::Float(BinaryFormat::Double) => "f64",
        }
    }

    fn whole(&self, value: &Integer) -> String {
        value.to_string()
    }

    fn real(&self, format: BinaryFormat, value: &Rational) -> String {
        let bits = numbers::bits(format, value);
        match format {
            BinaryFormat::Single => format!("f32::from_bits({bits:#010x})"),
            BinaryFormat::Double => format!("f64::from_bits({bits:#018x})"),
        }
    }

    fn state(&self, name: &str) -> String {
        format!("self.{name}")
    }

    fn function(&self, name: &str) -> String {
        name.to_owned()
    }

    fn converted(&self, from: Kind, to: Kind, of: &Written) -> Written {
        let kind = self.kind(to);
        match (from, to) {
            (Kind::Integer(less), Kind::Integer(more)) if less < more => {
                Written::atom(format!("{kind}::from({})", of.text))
            }
            _ => Written::signed(format!("{} as {kind}", of.operand())),
        }
    }

    fn declared(&self, name: &str, kind: Kind, value: &[String]) -> Vec<String> {
        assigned(format!("let {name}: {} =", self.kind(kind)), value)
    }

    /// A shift of negative numbers rounds down.
    fn floor(&self, name: &str, of: &str, bits: u32) -> Vec<String> {
        vec![format!("let {name} = {of} >> {bits};")]
    }

    fn set(&self, state: &str, value: &str) -> String {
        format!("self.{state} = {value};")
    }

    fn branches(&self, condition: &str) -> [String; 4] {
        [format!("if {condition} {{"), format!("}} else if {condition} {{"), "} else {".into(), "}".into()]
    }

    /// The value of a branch is its last expression.
    fn returned(&self, _: &str, value: &str) -> String {
        value.to_owned()
    }

    fn unused(&self, name: &str) -> Option<String> {
        Some(format!("let _ = {name};"))
    }

    fn comment(&self) -> [&'static str; 3] {
        ["", "//", ""]
    }

    fn escapes(&self) -> &'static [(&'static str, &'static str)] {
        &[]
    }

    fn remark(&self, text: &str) -> String {
        format!("// {}", harmless(self, text))
    }

    fn notes(&self, code: &Code) -> Vec<String> {
        let mut notes =
            vec![format!("States are zero in {0}::new(); call step at each sample. Only `core` is used.", self.kind)];
        if matches!(code.signal, Kind::Float(_)) {
            notes.push("Constants are made of their bits, which takes Rust 1.83 or later.".into());
        }
        notes
    }

    fn file(&self, code: &Code) -> Vec<String> {
        let mut parts = vec![self.constants(code), self.states(code), self.methods(code)];
        for helper in &code.helpers {
            let kind = self.kind(WIDE);
            let mut all = vec![
                format!("/// {}", helper.remark),
                "#[allow(clippy::all)]".into(),
                format!("fn {}({ARGUMENT}: {kind}) -> {kind} {{", helper.name),
            ];
            all.extend(indented(&statements(self, &helper.name, &helper.body)));
            all.push("}".into());
            parts.push(all);
        }
        super::syntax::parts(parts)
    }
}
