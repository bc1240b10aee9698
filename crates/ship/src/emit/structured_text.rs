//! Structured text of IEC 61131-3.

use super::numbers;
use super::statements::{ARGUMENT, Code, Kind, Operator, Statement, WIDE};
use super::syntax::{Syntax, Written, assigned, harmless, indented, statements};
use jurist_algebra::number::{BinaryFormat, Integer, Rational};

pub(super) struct StructuredText {
    name: String,
}

impl StructuredText {
    pub fn new(name: &str) -> StructuredText {
        StructuredText { name: name.into() }
    }

    fn zero(&self, kind: Kind) -> String {
        match kind {
            Kind::Float(format) => self.real(format, &Rational::ZERO),
            Kind::Integer(_) => "0".into(),
        }
    }

    fn block(&self, code: &Code) -> Vec<String> {
        let kind = self.kind(code.signal);
        let zero = self.zero(code.signal);
        let plain = |names: &[String]| names.iter().map(|name| format!("{name} : {kind};")).collect::<Vec<_>>();
        let reset = format!("reset : BOOL; {}", self.remark("TRUE sets all states to zero before the sample."));
        let inputs = [vec![reset], plain(&code.inputs)].concat();
        let states = code.states.iter().map(|state| format!("{state} : {kind} := {zero};")).collect();
        let constant = |constant: &super::statements::Constant| {
            let value = match constant.kind {
                Kind::Float(format) => self.real(format, &constant.value),
                // A sign belongs to the literal: what a variable begins with need not be an expression.
                Kind::Integer(_) => self.whole(&constant.value.numerator()),
            };
            let [name, kind, remark] = [&constant.name, self.kind(constant.kind), &self.remark(&constant.remark)];
            format!("{name} : {kind} := {value}; {remark}")
        };
        let mut all = vec![format!("FUNCTION_BLOCK {}", self.name)];
        all.extend(variables("VAR_INPUT", inputs));
        all.extend(variables("VAR_OUTPUT", plain(&code.outputs)));
        all.extend(variables("VAR", states));
        all.extend(variables("VAR CONSTANT", code.constants.iter().map(constant).collect()));
        all.extend(variables("VAR_TEMP", self.made(&code.step, &code.outputs)));
        if !code.states.is_empty() {
            all.push("IF reset THEN".into());
            all.extend(code.states.iter().map(|state| format!("    {}", self.set(state, &zero))));
            all.push("END_IF;".into());
        }
        all.extend(statements(self, "", &code.step));
        all.push("END_FUNCTION_BLOCK".into());
        all
    }

    /// The variables that statements make, but for outputs.
    fn made(&self, all: &[Statement], outputs: &[String]) -> Vec<String> {
        let made = all.iter().filter_map(|statement| match statement {
            Statement::Let { name, kind, .. } => Some((name, *kind)),
            Statement::Floor { name, .. } => Some((name, WIDE)),
            _ => None,
        });
        let made = made.filter(|(name, _)| !outputs.contains(name));
        made.map(|(name, kind)| format!("{name} : {};", self.kind(kind))).collect()
    }
}

/// A section of variables, if there are some.
fn variables(section: &str, lines: Vec<String>) -> Vec<String> {
    if lines.is_empty() {
        lines
    } else {
        [vec![section.to_owned()], indented(&lines), vec!["END_VAR".to_owned()]].concat()
    }
}

impl Syntax for StructuredText {
    fn width(&self, _: u32) -> u32 {
        64
    }

    fn kind(&self, kind: Kind) -> &'static str {
        match kind {
            Kind::Integer(_) => "LINT",
            Kind::Float(BinaryFormat::Single) => "REAL",
            Kind::Float(BinaryFormat::Double) => "LREAL",
        }
    }

    /// Some compilers read a literal without a type as one of 32 bits.
    fn whole(&self, value: &Integer) -> String {
        if value.bit_length() < 32 { value.to_string() } else { format!("LINT#{value}") }
    }

    fn real(&self, format: BinaryFormat, value: &Rational) -> String {
        format!("{}#{}", self.kind(Kind::Float(format)), numbers::decimal(format, value))
    }

    fn state(&self, name: &str) -> String {
        name.to_owned()
    }

    fn function(&self, name: &str) -> String {
        format!("{}_{name}", self.name)
    }

    /// All integers are of one type.
    fn converted(&self, _: Kind, _: Kind, of: &Written) -> Written {
        Written::signed(of.operand())
    }

    fn operator(&self, operator: Operator) -> &'static str {
        match operator {
            Operator::Plus => "+",
            Operator::Minus => "-",
            Operator::Times => "*",
            Operator::Over => "/",
            Operator::Modulo => "MOD",
            Operator::Less => "<",
            Operator::Greater => ">",
            Operator::Equal => "=",
            Operator::Unequal => "<>",
            Operator::And => "AND",
        }
    }

    fn declared(&self, name: &str, _: Kind, value: &[String]) -> Vec<String> {
        assigned(format!("{name} :="), value)
    }

    /// Division drops the fraction: of negative numbers with a rest that is one too many.
    fn floor(&self, name: &str, of: &str, bits: u32) -> Vec<String> {
        let power = self.whole(&(Integer::ONE << u64::from(bits)));
        vec![
            format!("{name} := {of} / {power};"),
            format!("IF {of} MOD {power} < 0 THEN"),
            format!("    {name} := {name} - 1;"),
            "END_IF;".into(),
        ]
    }

    fn set(&self, state: &str, value: &str) -> String {
        format!("{state} := {value};")
    }

    fn branches(&self, condition: &str) -> [String; 4] {
        [format!("IF {condition} THEN"), format!("ELSIF {condition} THEN"), "ELSE".into(), "END_IF;".into()]
    }

    fn returned(&self, helper: &str, value: &str) -> String {
        format!("{helper} := {value};")
    }

    fn unused(&self, _: &str) -> Option<String> {
        None
    }

    fn comment(&self) -> [&'static str; 3] {
        ["(*", " *", " *)"]
    }

    fn escapes(&self) -> &'static [(&'static str, &'static str)] {
        &[("*)", "* )"), ("(*", "( *")]
    }

    fn remark(&self, text: &str) -> String {
        format!("(* {} *)", harmless(self, text))
    }

    fn notes(&self, code: &Code) -> Vec<String> {
        let mut notes =
            vec!["States are zero at first, and where reset is TRUE; call the block once at each sample.".to_owned()];
        if matches!(code.signal, Kind::Float(_)) {
            notes.push("The compiler must neither fuse products with sums nor compute in a wider type.".into());
        }
        notes
    }

    fn file(&self, code: &Code) -> Vec<String> {
        let mut parts = Vec::new();
        for helper in &code.helpers {
            let kind = self.kind(WIDE);
            let mut all = vec![self.remark(&helper.remark), format!("FUNCTION {} : {kind}", helper.name)];
            all.extend(variables("VAR_INPUT", vec![format!("{ARGUMENT} : {kind};")]));
            all.extend(variables("VAR", self.made(&helper.body, &[])));
            all.extend(statements(self, &helper.name, &helper.body));
            all.push("END_FUNCTION".into());
            parts.push(all);
        }
        parts.push(self.block(code));
        super::syntax::parts(parts)
    }
}
