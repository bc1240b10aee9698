//! What every diagnostic code means.

/// Every code with its explanation, as `jurist explain` prints it; sorted by code.
pub const CODES: &[(&str, &str)] = &[
    (
        "E-algebraic-loop",
        r#"Around a loop of blocks that pass their input on at once, the gain is exactly 1 for all
parameters: the signals have no unique value.

    input = "r + y"  output = "y"  gain = 1

Remedy: change a gain, or put a delay or a filter into the loop."#,
    ),
    (
        "E-cycle",
        r#"Constants are defined by each other, so none of them has a value.

    a = "b + 1"
    b = "2*a"

Remedy: give one of them a value of its own."#,
    ),
    (
        "E-discretize",
        r#"The way a continuous block is to be made discrete is missing, unknown or not rational. Zero-order
hold contains exponentials of the sample time; prewarping by a frequency makes the factor c
irrational.

    discretize = { method = "tustin", T = "T" }

Remedy: use forward, backward or tustin; instead of prewarping give c itself."#,
    ),
    (
        "E-division-by-zero",
        r#"A divisor is zero whatever the parameters are.

    g = "1/(K - K)"

A divisor that is zero only for some values is no error: the model is undefined there.
Remedy: correct the divisor."#,
    ),
    (
        "E-duplicate-key",
        r#"A key or a table stands twice in the file.

    L_a = 46e-3
    L_a = 50e-3

Remedy: keep one of the two."#,
    ),
    (
        "E-duplicate-name",
        r#"One name has two meanings, such as a constant and a parameter, or a constant and a signal; or a
list names the same block, input, output or state twice.

    [constants]
    K = 1
    [parameters]
    K = { nominal = 1 }

Remedy: rename or remove one. A constant given as a number can be varied without being a parameter."#,
    ),
    (
        "E-empty-domain",
        r#"The lower bound of a domain is not below its upper bound. Both bounds are open.

    K = { min = 2, max = 2 }

Remedy: make min less than max, or leave one of them out."#,
    ),
    (
        "E-exponent",
        r#"An exponent is no whole number, contains a name, or is too large.

    characteristic = "z^0.5"

Exponents fix the order of the loop, so that they are numbers: K^n is refused even where n is a constant.
Remedy: write a whole number such as z^3; exponents from -1000 to 1000 are accepted."#,
    ),
    (
        "E-improper",
        r#"A transfer function has a numerator of higher degree than its denominator.

    transfer = "z^2/(z - 1)"

Remedy: add a delay (discrete) or a filter pole (continuous)."#,
    ),
    ("E-internal", r#"Something happened that should be impossible. Please report it together with the model."#),
    (
        "E-kept-and-set",
        r#"The same name is to stay symbolic and to have a value.

    --param K --set K=3

Remedy: leave out one of the two."#,
    ),
    (
        "E-kept-twice",
        r#"The same name is asked for twice.

    --keep K --keep K

Remedy: name it once."#,
    ),
    (
        "E-missing",
        r#"Something the model needs is not there, such as `time`, `[loop]`, or one of A, B, C, K.

    [loop]
    A = [[1]]

Remedy: add what the message names."#,
    ),
    (
        "E-name",
        r#"A name cannot be used in expressions.

    "2x" = 1

Remedy: use letters, digits and underscores, and begin with a letter or an underscore."#,
    ),
    (
        "E-no-root-locus",
        r#"A root locus in a parameter needs the characteristic polynomial in the form den + NAME num, and this
parameter enters with a higher power.

    jurist charpoly --root-locus-form T

Remedy: take a parameter that enters linearly, such as a gain."#,
    ),
    (
        "E-no-states",
        r#"A model given by its characteristic polynomial has no states, inputs or outputs, so it has no
responses and no transfer functions.

    characteristic = "z - K"

Remedy: give the loop by matrices or blocks."#,
    ),
    (
        "E-no-value",
        r#"A parameter that is not the question's own has neither a nominal value nor one that was set.

    K = { min = 0 }

Remedy: add nominal = ..., or use --set K=..."#,
    ),
    (
        "E-not-a-number",
        r#"A number is needed where a formula with names stands, or a constant given by a formula is to be varied.

    K = { nominal = "2*T" }

Remedy: write the number, or vary what the formula depends on."#,
    ),
    (
        "E-not-linear",
        r#"The input of a block, or an output, is not linear in the signals or has a constant term.

    input = "r - y*y + 1"

Remedy: use sums of signals times constants and parameters."#,
    ),
    (
        "E-not-polynomial",
        r#"The characteristic polynomial divides by the polynomial variable.

    characteristic = "1 + K/(z - 1)"

Remedy: multiply by the denominators: "z - 1 + K", or use `[[block]]`."#,
    ),
    (
        "E-number",
        r#"A number cannot be read, is not finite or not decimal, or is too long.

    K = { nominal = inf }

Remedy: write it like 12, 0.046, 46e-3 or 1_000."#,
    ),
    (
        "E-option-value",
        r#"An option's value is not of the form that the option takes.

    --set K=1/3    --domain K=0..10    --domain K=0..    --domain K=..10

Remedy: write the name, an equals sign, and a number or a range; a range has two dots."#,
    ),
    (
        "E-output-format",
        r#"The ending of the output file names no format that the command can write.

Remedy: use one of the endings the message lists."#,
    ),
    (
        "E-output-name",
        r#"Two outputs have one name, or an output has the name of the model or certificate that is read: one would
replace the other. Another spelling or a link of the same file is the same name.

    jurist intervals model.toml --param K -o answer.json --certificate ./answer.json

Remedy: give each output a name of its own."#,
    ),
    (
        "E-read",
        r#"A file cannot be read: it is not there, is no file, is closed to you, or is longer than a model may be.

    jurist analyze mode.toml

Remedy: correct the path; '-' is standard input, and no MODEL at all is the built-in drive."#,
    ),
    (
        "E-region",
        r#"The region of stability is given wrongly: --radius needs a positive number and discrete time,
--decay a positive number and continuous time.

    --radius -1

Remedy: use the option that fits the model's time."#,
    ),
    (
        "E-reserved-name",
        r#"A name has a meaning of its own: z or s is the polynomial variable, `radius` and `decay` describe
the region of stability.

    [constants]
    z = 1

Remedy: choose another name."#,
    ),
    (
        "E-set-twice",
        r#"The command line gives one name two values or two domains.

    --set K=1 --set K=2

Remedy: keep one of the two."#,
    ),
    (
        "E-simulation",
        r#"The model or the options do not fit a simulation: an input or state that does not exist, a
duration that is not positive, or a switched simulation of a model without its parts.

    jurist simulate --switched model.toml

Remedy: a switched simulation needs a model made of blocks, of which one has a 'pwm' entry and one a
'discretize' entry; inputs and states go by the names that the model gives them."#,
    ),
    (
        "E-size",
        r#"The sizes of matrices or of lists of signals do not fit together, or a loop has no states at all.

    A = [[1, 0], [0, 1]]
    B = [[1]]

Remedy: A is n x n, B n x m, C p x n, K m x p, E n x inputs."#,
    ),
    (
        "E-syntax",
        r#"An expression cannot be read.

    characteristic = "z + (K"

Remedy: expressions are made of names, numbers, + - * / ^ and parentheses; multiplication is written out."#,
    ),
    (
        "E-toml",
        r#"The file is not valid TOML.

    title = "not closed

Remedy: correct the place the message points at; see <https://toml.io>."#,
    ),
    (
        "E-too-deep",
        r#"Parentheses, signs, powers, arrays or keys are nested too deeply.

Remedy: give parts of an expression a name in `[constants]`."#,
    ),
    (
        "E-too-large",
        r#"An expression becomes too large when it is multiplied out.

    ((K + 1)^1000)^1000

Remedy: lower the exponents or the number of parameters."#,
    ),
    (
        "E-two-drivers",
        r#"Two blocks, or a block and an external input, drive the same signal.

    output = "u"  ...  output = "u"

Remedy: give the signals two names and add them: input = "u_1 + u_2"."#,
    ),
    (
        "E-two-forms",
        r#"A loop or a block is given in two ways.

    [loop]
    characteristic = "z"
    matrix = [[1]]

Remedy: keep exactly one."#,
    ),
    (
        "E-type",
        r#"A value is of the wrong kind.

    title = 5

Remedy: write what the message asks for."#,
    ),
    (
        "E-undefined",
        r#"The model is undefined for the values given: some expression divides by zero there.

    characteristic = "z - 1/K"  with --set K=0

Remedy: choose other values."#,
    ),
    (
        "E-unknown-code",
        r#"There is no diagnostic of this code.

    jurist explain E-unknwon-name

Remedy: copy the code from between the brackets of the message."#,
    ),
    (
        "E-unknown-key",
        r#"A key is not known where it stands.

    K = { nominl = 110 }

Remedy: correct the spelling; the message suggests the nearest key."#,
    ),
    (
        "E-unknown-name",
        r#"An expression uses a name that is not defined, or a signal that nothing drives.

    characteristic = "z - K_pmw"

Remedy: correct the spelling, or define the name in `[constants]` or `[parameters]`."#,
    ),
    (
        "E-unknown-parameter",
        r#"The question names a parameter that the model does not have.

    jurist intervals --param K_pmw

Remedy: name a parameter, or a constant that is given as a number."#,
    ),
    (
        "E-unknown-signal",
        r#"The loop has no input or output of this name.

    jurist charpoly --transfer omga i_a

Remedy: use the names under inputs and outputs in `[loop]`."#,
    ),
    (
        "E-usage",
        r#"The command line cannot be understood.

Remedy: jurist help, or jurist help COMMAND."#,
    ),
    (
        "E-utf8",
        r#"The file is not UTF-8.

Remedy: save it as UTF-8."#,
    ),
    (
        "E-value",
        r#"A value is not among those that are accepted, such as a sample time that is not positive.

    time = "discret"
    sample_time = 0

Remedy: write one of those the message names."#,
    ),
    (
        "E-write",
        r#"A file or standard output could not be written. What was in the file before is there still.

Remedy: check the directory, its permissions and the space that is left; a closed standard output takes no
answer (`> /dev/null` does)."#,
    ),
    (
        "W-certificate",
        r#"A certificate has been written that the independent check does not accept, mostly because it has limits of its
own (numbers of 100000 digits, time). The answer stands, but `jurist verify` does not prove it.

Remedy: write the model with shorter numbers, or give `jurist verify` more time with --timeout."#,
    ),
    (
        "W-outside-domain",
        r#"A value lies outside the open domain of its parameter. It is used all the same.

    K = { nominal = 3, max = 2 }

Remedy: correct the value or the domain."#,
    ),
    (
        "W-unused",
        r#"A constant, a parameter, an input or a key is not used.

    [constants]
    L_a = 46e-3      # and nothing mentions L_a

Remedy: remove it, or use it where it was meant."#,
    ),
];
