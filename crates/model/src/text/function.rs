//! The functions that expressions know.

/// The circle number, where a model gives the name no other meaning.
pub(crate) const PI: &str = "pi";

/// The imaginary unit, where a model gives the name no other meaning.
pub(crate) const UNIT: &str = "j";

/// A function of one value in an expression.
///
/// ```
/// use jurist_model::Function;
/// assert_eq!(Function::named("exp"), Some(Function::Exp));
/// assert_eq!(Function::named("ln"), None);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Function {
    /// The square root that is not negative.
    Sqrt,
    /// The exponential function.
    Exp,
    /// The sine of an angle in radians.
    Sin,
    /// The cosine of an angle in radians.
    Cos,
    /// The tangent of an angle in radians.
    Tan,
    /// The conjugate of a complex value.
    Conj,
    /// The real part of a complex value.
    Re,
    /// The imaginary part of a complex value.
    Im,
}

impl Function {
    /// All of them.
    pub const ALL: [Function; 8] = [
        Function::Sqrt,
        Function::Exp,
        Function::Sin,
        Function::Cos,
        Function::Tan,
        Function::Conj,
        Function::Re,
        Function::Im,
    ];

    /// Its name in expressions.
    pub fn name(self) -> &'static str {
        match self {
            Function::Sqrt => "sqrt",
            Function::Exp => "exp",
            Function::Sin => "sin",
            Function::Cos => "cos",
            Function::Tan => "tan",
            Function::Conj => "conj",
            Function::Re => "re",
            Function::Im => "im",
        }
    }

    /// The function of this name.
    pub fn named(name: &str) -> Option<Function> {
        Function::ALL.into_iter().find(|function| function.name() == name)
    }
}

/// What a name that is not known was probably meant to be where functions and their constants are concerned. This goes
/// before any similar name of the model, which would be another quantity.
pub(crate) fn hint(name: &str) -> Option<String> {
    if let Some(function) = Function::named(name) {
        return Some(format!("'{name}' is a function: {}(x)", function.name()));
    }
    Some(match name {
        "Pi" | "PI" | "π" | "M_PI" => "the circle number is written 'pi'".into(),
        "i" => "the imaginary unit is written 'j'".into(),
        "e" => "the base of the exponential function is written 'exp(1)'".into(),
        _ => return None,
    })
}

/// True if a name is known as a function in other programs, so that parentheses after it are no product.
pub(crate) fn is_function_elsewhere(name: &str) -> bool {
    const OTHERS: [&str; 17] = [
        "pow", "root", "cot", "sinh", "cosh", "tanh", "ln", "log", "log10", "asin", "acos", "atan", "atan2", "abs",
        "min", "max", "tf",
    ];
    let lower = name.to_lowercase();
    OTHERS.contains(&lower.as_str()) || Function::named(&lower).is_some()
}

/// What to do about a call of something that is no function.
pub(crate) fn call_hint(name: &str) -> String {
    match name.to_lowercase().as_str() {
        "exp" | "sqrt" | "sin" | "cos" | "tan" => format!("write it in small letters: '{}(..)'", name.to_lowercase()),
        "pow" => "powers are written with '^': 'x^2'".into(),
        "root" => "the square root is written 'sqrt(..)'".into(),
        "cot" => "write '1/tan(..)'".into(),
        "sinh" => "write '(exp(x) - exp(-x))/2'".into(),
        "cosh" => "write '(exp(x) + exp(-x))/2'".into(),
        "tanh" => "write '(exp(2*x) - 1)/(exp(2*x) + 1)'".into(),
        "ln" | "log" | "log10" | "asin" | "acos" | "atan" | "atan2" | "abs" | "min" | "max" => {
            "known functions: sqrt, exp, sin, cos, tan".into()
        }
        _ => "multiplication is written out: 'a*(b + c)'; functions are sqrt, exp, sin, cos, tan".into(),
    }
}
