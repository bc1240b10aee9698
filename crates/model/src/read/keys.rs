//! The keys of a model file: what the reader knows, and what its JSON schema says.

use crate::discretization::{EDGES as EDGE_LIST, LIST as METHOD_LIST};
use crate::requirements::ALL as REQUIREMENTS;

/// A key of a table.
pub(super) struct Key {
    pub name: &'static str,
    pub shape: Shape,
    /// Whether the table has no meaning without it.
    pub is_needed: bool,
    /// What it says, for people.
    pub about: &'static str,
}

/// What a value looks like.
pub(super) enum Shape {
    /// Any text.
    Text,
    /// One of these words.
    OneOf(&'static [&'static str]),
    /// The name of a method of discretisation.
    Method,
    /// A number, or a formula of numbers.
    Number,
    /// An array of two numbers, the ends of a closed interval.
    Interval,
    /// `true` or `false`.
    Flag,
    /// A number, or an expression in constants and parameters.
    Expression,
    /// One of these words or an array of them.
    OneOrEach(&'static [&'static str]),
    /// One expression or an array of them.
    Expressions,
    /// One name or an array of names.
    Names,
    /// An array of rows, or the name of a constant that is one.
    Matrix,
    /// A parameter: its table, or its nominal value alone.
    Parameter,
    /// A tolerance: a width, a share, two bounds, or a range.
    Tolerance,
    /// A table of names with values of one shape.
    Named(&'static Shape),
    /// A table with these keys.
    Table(&'static [Key]),
    /// A table with these keys, or `true`.
    TableOrFlag(&'static [Key]),
    /// A table with these keys, or one word.
    TableOrWord(&'static [Key]),
    /// A table with these keys, or a number.
    TableOrNumber(&'static [Key]),
    /// A constant: a number, an expression, an array of rows, or a table.
    Constant,
    /// An array of tables with these keys.
    Tables(&'static [Key]),
}

const fn key(name: &'static str, shape: Shape, about: &'static str) -> Key {
    Key { name, shape, is_needed: false, about }
}

const fn needed(name: &'static str, shape: Shape, about: &'static str) -> Key {
    Key { name, shape, is_needed: true, about }
}

/// The words of `time`.
pub(super) const TIMES: [&str; 2] = ["discrete", "continuous"];

/// The methods of `discretize`.
pub(super) const METHODS: [&str; METHOD_LIST.len()] = {
    let mut names = [""; METHOD_LIST.len()];
    let mut k = 0;
    while k < METHOD_LIST.len() {
        names[k] = METHOD_LIST[k].name;
        k += 1;
    }
    names
};

/// The words of `edge`.
pub(super) const EDGES: [&str; EDGE_LIST.len() + 1] = {
    let mut names = [HELD; EDGE_LIST.len() + 1];
    let mut k = 0;
    while k < EDGE_LIST.len() {
        names[k] = EDGE_LIST[k].name;
        k += 1;
    }
    names
};

/// The word for an input that is held beside others that are pulses.
pub(super) const HELD: &str = "hold";

/// The whole file.
pub(super) const MODEL: [Key; 12] = [
    key("title", Shape::Text, "what the loop is, for people"),
    needed(
        "time",
        Shape::OneOf(&TIMES),
        "discrete: in z, stable inside the unit circle; continuous: in s, stable in the left half plane",
    ),
    key("sample_time", Shape::Expression, "turns angles into frequencies (discrete time)"),
    key(
        "constants",
        Shape::Named(&Shape::Constant),
        "named values and matrices, in any order, in terms of each other and of parameters",
    ),
    key("parameters", Shape::Named(&Shape::Parameter), "what stays free"),
    needed("loop", Shape::Table(&LOOP), "the loop, in exactly one form: characteristic, matrix, A B C K, or blocks"),
    key("block", Shape::Tables(&BLOCK), "the blocks of a diagram, wired by the names of their signals"),
    key("simulation", Shape::Table(&SIMULATION), "defaults of a time response"),
    key("require", Shape::Table(&REQUIRE), "what is required of the loop beyond stability"),
    key("expect", Shape::Tables(&EXPECT), "what 'jurist test' is to find"),
    key("ship", Shape::Table(&SHIP), "how the controller is stored and run, for 'jurist ship'"),
    key("tune", Shape::Table(&TUNE), "which gains are to be best, for 'jurist tune'"),
];

/// The table `[tune]`.
pub(super) const TUNE: [Key; 7] = [
    key("free", Shape::Names, "one gain or two"),
    key("bounds", Shape::Named(&Shape::Interval), "the least and the greatest value of a gain, both included"),
    key(
        "objective",
        Shape::Text,
        "'max NAME' or 'min NAME', NAME a free gain or a number of the loop such as modulus_margin; 'none' when missing",
    ),
    key("gap", Shape::Number, "a bracket is narrow enough where it is less than this share, 1e-3 when missing"),
    key("loss", Shape::Number, "what may be given up for gains of few digits: a share, or \"1%\""),
    key(
        "for_all",
        Shape::Named(&Shape::Interval),
        "ranges of other names, for all values of which the gains are to be good",
    ),
    key("robust", Shape::Flag, "whether the gains are to be good for all values within the tolerances of the model"),
];

/// The realisations of `[ship]`.
pub(super) const REALISATIONS: [&str; 7] = ["df1", "df2", "df2t", "sos", "parallel", "delta", "state"];

/// The table `[ship]`.
pub(super) const SHIP: [Key; 7] = [
    key("block", Shape::Text, "the block that is the controller"),
    key("realisation", Shape::OneOf(&REALISATIONS), "the order of its operations, df1 when missing"),
    key(
        "format",
        Shape::TableOrWord(&NUMBER_FORMAT),
        "how coefficients are stored: fixed point, \"float32\" or \"float64\"",
    ),
    key(
        "signal",
        Shape::TableOrWord(&NUMBER_FORMAT),
        "how signals are stored: fixed point; as coefficients where these are floats",
    ),
    key("inputs", Shape::Named(&Shape::Number), "bounds of the magnitude of the loop's inputs, for ranges"),
    key("saturate", Shape::Flag, "whether signals saturate; they wrap around else"),
    key("delta", Shape::Number, "the step of the delta operator: a power of two"),
];

/// How numbers are stored.
pub(super) const NUMBER_FORMAT: [Key; 5] = [
    key("bits", Shape::Number, "all bits, the sign among them"),
    key("integer", Shape::Number, "in the place of 'bits': bits before the point, the sign among them"),
    key("fraction", Shape::Number, "bits behind the point"),
    key("round", Shape::OneOf(&ROUNDINGS), "the rounding mode, nearest when missing"),
    key(
        "scale",
        Shape::Number,
        "numbers are divided by 2 to this power before they are stored; \"auto\", of coefficients, takes the least power that fits",
    ),
];

/// The rounding modes.
pub(super) const ROUNDINGS: [&str; 6] = ["nearest", "even", "half-up", "floor", "ceil", "zero"];

/// The words of an expected verdict.
pub(super) const VERDICTS: [&str; 3] = ["stable", "marginal", "unstable"];

/// The keys of `[[expect]]` that claim something.
pub(super) const CLAIMS: [&str; 7] = ["verdict", "stable", "lower", "upper", "require", "tolerance", "certificate"];

/// An entry `[[expect]]`.
pub(super) const EXPECT: [Key; 13] = [
    key("name", Shape::Text, "what it is called, for people"),
    key("model", Shape::Text, "the model file; only in a file of expectations"),
    key("set", Shape::Named(&Shape::Number), "values of parameters and constants; others are as in the model"),
    key(
        "cases",
        Shape::Text,
        "a table in CSV: each row has values of the names in its head, and everything is to hold for each",
    ),
    key("verdict", Shape::OneOf(&VERDICTS), "the verdict"),
    key("param", Shape::Text, "the parameter that 'stable', 'lower' and 'upper' speak of"),
    key(
        "stable",
        Shape::Interval,
        "a range, both ends included, in which every value is stable; \"-inf\" and \"inf\" are no ends",
    ),
    key("lower", Shape::Number, "the lower end of the stable interval; \"-inf\" where there is none"),
    key("upper", Shape::Number, "the upper end of the stable interval; \"inf\" where there is none"),
    key("within", Shape::Number, "how far these ends may be away: a share such as \"1%\", or a width"),
    key("require", Shape::TableOrFlag(&REQUIRE), "requirements beside those of the model, or true for these alone"),
    key("tolerance", Shape::Number, "stable for all values within the model's tolerances, each widened by this factor"),
    key("certificate", Shape::Text, "a certificate that is to be accepted for the model"),
];

/// A file of expectations.
pub(super) const EXPECTATIONS: [Key; 3] = [
    key("model", Shape::Text, "the model file of all that name none"),
    key("cases", Shape::Text, "the operating points of all that name none"),
    key("expect", Shape::Tables(&EXPECT), "what 'jurist test' is to find"),
];

/// A parameter.
pub(super) const PARAMETER: [Key; 10] = [
    key(
        "nominal",
        Shape::Expression,
        "the value it has when nothing else is said: a number, or a formula in constants and other parameters' nominal values",
    ),
    key("min", Shape::Number, "the lower bound of its domain, which is open unless 'closed' says otherwise"),
    key("max", Shape::Number, "the upper bound of its domain, which is open unless 'closed' says otherwise"),
    key("closed", Shape::Flag, "whether 'min' and 'max' themselves belong to the domain"),
    key("domain", Shape::Interval, "both bounds of a closed domain, in the place of 'min', 'max' and 'closed'"),
    key("unit", Shape::Text, "its unit, for people"),
    key("description", Shape::Text, "what it is, for people"),
    key("tolerance", Shape::Tolerance, "how far it may be from its nominal value"),
    key(
        "from",
        Shape::Text,
        "in the place of 'nominal': where the number stands, FILE#NAME; a C header, YAML or JSON below the model's folder",
    ),
    key(
        "as",
        Shape::OneOf(&READINGS),
        "'decimal' takes a literal of C as it is written, not as the nearest float or double",
    ),
];

/// How literals are read.
pub(super) const READINGS: [&str; 1] = ["decimal"];

/// A constant with more than its value.
pub(super) const CONSTANT: [Key; 6] = [
    key("value", Shape::Expression, "the value"),
    key("unit", Shape::Text, "its unit, for people"),
    key("description", Shape::Text, "what it is, for people"),
    key("tolerance", Shape::Tolerance, "how far it may be from its value, which is a number"),
    key(
        "from",
        Shape::Text,
        "in the place of 'value': where the number stands, FILE#NAME; a C header, YAML or JSON below the model's folder",
    ),
    key(
        "as",
        Shape::OneOf(&READINGS),
        "'decimal' takes a literal of C as it is written, not as the nearest float or double",
    ),
];

/// The table of a tolerance.
pub(super) const TOLERANCE: [Key; 2] =
    [needed("low", Shape::Number, "the least value"), needed("high", Shape::Number, "the greatest value")];

/// The table `[loop]`.
pub(super) const LOOP: [Key; 10] = [
    key("characteristic", Shape::Expression, "the characteristic polynomial in z or s, as it is written"),
    key("matrix", Shape::Matrix, "the matrix of the closed loop"),
    key("A", Shape::Matrix, "state matrix of output feedback: the closed loop is A - B*K*C"),
    key("B", Shape::Matrix, "input matrix of output feedback"),
    key("C", Shape::Matrix, "output matrix of output feedback"),
    key("K", Shape::Matrix, "feedback matrix: u = -K y"),
    key("states", Shape::Names, "names of the states"),
    key("inputs", Shape::Names, "the external signals"),
    key("E", Shape::Matrix, "how the inputs enter: a row for each state, a column for each input"),
    key("outputs", Shape::Expressions, "the responses: states, signals, or linear expressions in them"),
];

/// An entry `[[block]]`.
pub(super) const BLOCK: [Key; 17] = [
    key("name", Shape::Text, "its name, for people"),
    needed("input", Shape::Expressions, "linear expressions in signals"),
    needed("output", Shape::Names, "the signals it drives"),
    key(
        "discretize",
        Shape::TableOrWord(&DISCRETIZE),
        "how a continuous block is made discrete; the method alone takes the loop's sample_time",
    ),
    key(
        "every",
        Shape::Number,
        "once in how many of the loop's samples the block is active; it holds its outputs in between",
    ),
    key("phase", Shape::Number, "at which of these samples, from 0"),
    key("sample_time", Shape::Expression, "in the place of 'every': a whole multiple of the loop's sample_time"),
    key("pwm", Shape::Table(&PWM), "what a switched simulation needs to know of a pulse-width modulator"),
    key("transfer", Shape::Expression, "a proper rational expression in z or s"),
    key("num", Shape::Expressions, "coefficients of the numerator, highest power first"),
    key("den", Shape::Expressions, "coefficients of the denominator, highest power first"),
    key("gain", Shape::Expression, "a factor"),
    key("delay", Shape::Expression, "a whole number of samples; in continuous time dead time"),
    key("A", Shape::Matrix, "state matrix"),
    key("B", Shape::Matrix, "input matrix"),
    key("C", Shape::Matrix, "output matrix, the identity when missing"),
    key("D", Shape::Matrix, "direct matrix, zero when missing"),
];

/// The table `discretize` of a block.
pub(super) const DISCRETIZE: [Key; 9] = [
    needed("method", Shape::Method, "the rule or the hold"),
    key("T", Shape::Expression, "the sample time, that of the loop when missing"),
    key("c", Shape::Expression, "the factor of tustin, 2/T when missing"),
    key("prewarp", Shape::Expression, "the angular frequency at which tustin is exact, below half the sampling rate"),
    key("delay", Shape::Expression, "dead time of the inputs of a held block, in units of time"),
    key(
        "frame",
        Shape::Expression,
        "the speed, in radians per unit of time, at which the frame of the block's signals turns against that in which its inputs are held, or pulses with the duty ratio 1/2; the signals are then complex, d + j q",
    ),
    key("advance", Shape::Expression, "the angle by which commands are turned ahead into that frame, 0 when missing"),
    key(
        "edge",
        Shape::OneOrEach(&EDGES),
        "which edges of the pulses of pwm move; one word, or one for each input, 'hold' for one that is held",
    ),
    key(
        "duty",
        Shape::Expressions,
        "the duty ratio of the pulses of pwm, between 0 and 1; one, or one for each input; 'steady' is that of the loop at rest with the inputs of [simulation]",
    ),
];

/// The table `pwm` of a block.
pub(super) const PWM: [Key; 3] = [
    needed("amplitude", Shape::Expression, "the height of the pulses"),
    needed("carrier", Shape::Expression, "the height of the carrier"),
    needed("period", Shape::Expression, "the period"),
];

/// The table `[simulation]`.
pub(super) const SIMULATION: [Key; 4] = [
    key("inputs", Shape::Named(&Shape::TableOrNumber(&PARTS)), "constant values of inputs; others are zero"),
    key("initial", Shape::Named(&Shape::TableOrNumber(&PARTS)), "initial values of states; others are zero"),
    key("duration", Shape::Number, "seconds, or samples when the loop has no sample time"),
    key("units", Shape::Named(&Shape::Text), "units of inputs, states, signals and outputs, for people"),
];

/// The parts of a complex value.
pub(super) const PARTS: [Key; 2] =
    [key("re", Shape::Number, "the real part"), key("im", Shape::Number, "the imaginary part of a complex signal")];

/// The table `[require]`: where margins are taken, and the list of requirements.
pub(super) const REQUIRE: [Key; REQUIREMENTS.len() + 1] = {
    let mut keys = [const { key("at", Shape::Text, "where margins are taken: a signal, or a block (at its input)") };
        REQUIREMENTS.len() + 1];
    let mut k = 0;
    while k < REQUIREMENTS.len() {
        keys[k + 1] = key(REQUIREMENTS[k].name, Shape::Expression, REQUIREMENTS[k].about);
        k += 1;
    }
    keys
};
