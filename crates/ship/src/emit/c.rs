//! C99.

use super::numbers;
use super::statements::{ARGUMENT, Code, Constant, Expression, Kind, WIDE};
use super::syntax::{Syntax, Written, assigned, expression, harmless, indented, statements};
use jurist_algebra::number::{BinaryFormat, Integer, Rational};

pub(super) struct C {
    name: String,
    upper: String,
}

impl C {
    pub fn new(name: &str) -> C {
        C { name: name.into(), upper: name.to_ascii_uppercase() }
    }

    fn constants(&self, code: &Code) -> Vec<String> {
        let value = |constant: &Constant| match constant.kind {
            Kind::Float(format) => self.real(format, &constant.value),
            // The least number of 32 bits is no literal of 32 bits, but its value fits.
            Kind::Integer(32) => constant.value.to_string(),
            Kind::Integer(_) => expression(self, &Expression::Whole(constant.value.numerator())).text,
        };
        let line = |constant: &Constant| {
            let [kind, name, value] =
                [self.kind(constant.kind), &self.constant(&constant.name), &value(constant)].map(str::to_owned);
            format!("static const {kind} {name} = {value}; {}", self.remark(&constant.remark))
        };
        code.constants.iter().map(line).collect()
    }

    /// The preprocessor stops where numbers of floating point are not those of the exact run.
    fn conditions(&self, format: BinaryFormat) -> Vec<String> {
        let (letters, digits, exponent) = match format {
            BinaryFormat::Single => ("FLT", 24, 128),
            BinaryFormat::Double => ("DBL", 53, 1024),
        };
        let text = format!(
            "#if !defined(FLT_EVAL_METHOD) || FLT_EVAL_METHOD != 0
#error \"intermediate results must have the precision of their type: on x86 compile with -msse2 -mfpmath=sse\"
#endif
#if FLT_RADIX != 2 || {letters}_MANT_DIG != {digits} || {letters}_MAX_EXP != {exponent}
#error \"numbers of floating point must be those of IEEE 754\"
#endif
#ifdef __FAST_MATH__
#error \"compile without -ffast-math: the order of operations and their rounding count\"
#endif"
        );
        text.lines().map(str::to_owned).collect()
    }

    fn initial(&self, code: &Code) -> Vec<String> {
        let zero = match code.signal {
            Kind::Float(format) => self.real(format, &Rational::ZERO),
            Kind::Integer(_) => "0".into(),
        };
        let mut states: Vec<String> = code.states.iter().map(|state| self.set(state, &zero)).collect();
        if states.is_empty() {
            states.push("s->none = 0;".into());
        }
        let begin = vec![
            self.remark("The controller at rest: all states are zero."),
            format!("static inline void {0}_init({0}_state *s)", self.name),
        ];
        [begin, block(&states)].concat()
    }

    fn step(&self, code: &Code) -> Vec<String> {
        let kind = self.kind(code.signal);
        let mut arguments = vec![format!("{}_state *s", self.name)];
        arguments.extend(code.inputs.iter().map(|input| format!("{kind} {input}")));
        let mut body = Vec::new();
        if matches!(code.signal, Kind::Float(_)) {
            // gcc warns of the pragma, which it does not know.
            body.extend(
                ["#if defined(__clang__) || !defined(__GNUC__)", "#pragma STDC FP_CONTRACT OFF", "#endif"]
                    .map(str::to_owned),
            );
        }
        body.extend(indented(&statements(self, "", &code.step)));
        let mut end = Vec::new();
        if !body.iter().any(|line| line.contains("s->")) {
            end.push("(void)s;".to_owned());
        }
        let returned = match code.outputs.as_slice() {
            [one] => {
                end.push(format!("return {one};"));
                kind
            }
            many => {
                end.extend(many.iter().enumerate().map(|(at, name)| format!("outputs[{at}] = {name};")));
                arguments.extend((!many.is_empty()).then(|| format!("{kind} outputs[{}]", many.len())));
                "void"
            }
        };
        body.extend(indented(&end));
        let mut all = vec![
            self.remark("One sample: the outputs from the inputs, and then the next states."),
            format!("static inline {returned} {}_step({})", self.name, arguments.join(", ")),
            "{".into(),
        ];
        all.extend(body);
        all.push("}".into());
        all
    }

    fn states(&self, code: &Code) -> Vec<String> {
        let kind = self.kind(code.signal);
        let mut fields: Vec<String> = code.states.iter().map(|state| format!("{kind} {state};")).collect();
        if fields.is_empty() {
            fields.push("char none; /* C has no empty structures. */".into());
        }
        let mut all = vec!["typedef struct {".to_owned()];
        all.extend(indented(&fields));
        all.push(format!("}} {}_state;", self.name));
        all
    }
}

/// Lines in braces.
fn block(lines: &[String]) -> Vec<String> {
    [vec!["{".to_owned()], indented(lines), vec!["}".to_owned()]].concat()
}

impl Syntax for C {
    fn kind(&self, kind: Kind) -> &'static str {
        match kind {
            Kind::Integer(16) => "int16_t",
            Kind::Integer(32) => "int32_t",
            Kind::Integer(_) => "int64_t",
            Kind::Float(BinaryFormat::Single) => "float",
            Kind::Float(BinaryFormat::Double) => "double",
        }
    }

    fn whole(&self, value: &Integer) -> String {
        format!("INT64_C({value})")
    }

    fn real(&self, format: BinaryFormat, value: &Rational) -> String {
        let suffix = if format == BinaryFormat::Single { "f" } else { "" };
        format!("{}{suffix}", numbers::hexadecimal(value))
    }

    fn constant(&self, name: &str) -> String {
        format!("{}_{name}", self.upper)
    }

    fn state(&self, name: &str) -> String {
        format!("s->{name}")
    }

    fn function(&self, name: &str) -> String {
        format!("{}_{name}", self.name)
    }

    fn converted(&self, _: Kind, to: Kind, of: &Written) -> Written {
        Written::signed(format!("({}){}", self.kind(to), of.operand()))
    }

    fn declared(&self, name: &str, kind: Kind, value: &[String]) -> Vec<String> {
        assigned(format!("const {} {name} =", self.kind(kind)), value)
    }

    /// Numbers that are not negative are shifted alike everywhere, negative ones are not; `~x` is `-x - 1`, as these types have two's complement.
    fn floor(&self, name: &str, of: &str, bits: u32) -> Vec<String> {
        vec![format!("const int64_t {name} = {of} < 0 ? ~(~{of} >> {bits}) : {of} >> {bits};")]
    }

    fn set(&self, state: &str, value: &str) -> String {
        format!("s->{state} = {value};")
    }

    fn branches(&self, condition: &str) -> [String; 4] {
        [format!("if ({condition}) {{"), format!("}} else if ({condition}) {{"), "} else {".into(), "}".into()]
    }

    fn returned(&self, _: &str, value: &str) -> String {
        format!("return {value};")
    }

    fn unused(&self, name: &str) -> Option<String> {
        Some(format!("(void){name};"))
    }

    fn comment(&self) -> [&'static str; 3] {
        ["/*", " *", " */"]
    }

    fn escapes(&self) -> &'static [(&'static str, &'static str)] {
        // The last is a backslash to compilers that know trigraphs.
        &[("*/", "* /"), ("/*", "/ *"), ("??/", "?? /")]
    }

    fn remark(&self, text: &str) -> String {
        format!("/* {} */", harmless(self, text))
    }

    fn notes(&self, code: &Code) -> Vec<String> {
        let mut notes =
            vec![format!("States are zero at first: call {0}_init once, then {0}_step at each sample.", self.name)];
        if matches!(code.signal, Kind::Float(_)) {
            notes.push("Compile with -ffp-contract=off where the compiler is gcc, which does not know the pragma STDC FP_CONTRACT.".into());
        }
        notes
    }

    fn file(&self, code: &Code) -> Vec<String> {
        let guard = format!("{}_H", self.upper);
        let mut parts = vec![vec![format!("#ifndef {guard}"), format!("#define {guard}")]];
        match code.signal {
            Kind::Integer(_) => parts.push(vec!["#include <stdint.h>".into()]),
            Kind::Float(format) => parts.extend([vec!["#include <float.h>".into()], self.conditions(format)]),
        }
        parts.extend([self.constants(code), self.states(code), self.initial(code)]);
        for helper in &code.helpers {
            let kind = self.kind(WIDE);
            let begin =
                vec![self.remark(&helper.remark), format!("static inline {kind} {}({kind} {ARGUMENT})", helper.name)];
            parts.push([begin, block(&statements(self, &helper.name, &helper.body))].concat());
        }
        parts.extend([self.step(code), vec![format!("#endif {}", self.remark(&guard))]]);
        super::syntax::parts(parts)
    }
}
