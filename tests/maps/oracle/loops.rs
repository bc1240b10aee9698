//! Random loops with the parameters `x` and `y`, over every ring of coefficients, singular ones often.

use crate::helpers::model::read;
use crate::helpers::random::Random;
use jurist_algebra::number::Rational;
use jurist_engine::error::{Diagnostics, Source};
use jurist_engine::model::Model;

/// A model text in parts: what stands before its constants, the constants, and the loop.
#[derive(Clone, Debug)]
pub struct Loop {
    head: String,
    constants: String,
    tail: String,
    /// The window for maps by boxes: the ends of `x` and of `y`.
    pub window: [[&'static str; 2]; 2],
}

impl Loop {
    pub fn text(&self) -> String {
        format!(
            "{}[constants]\n{}[parameters]\nx = {{ nominal = 1 }}\ny = {{ nominal = 1 }}\n{}",
            self.head, self.constants, self.tail
        )
    }

    /// Both parameters are free.
    pub fn plane(&self) -> Model {
        read(&self.text())
    }

    /// On the line `y = slope x + offset`, with `x` free; `None` where the text divides by zero all along it.
    pub fn along(&self, slope: &Rational, offset: &Rational) -> Option<Model> {
        let text = format!(
            "{}[constants]\n{}y = '({slope})*x + ({offset})'\n[parameters]\nx = {{ nominal = 1 }}\n{}",
            self.head, self.constants, self.tail
        );
        let model = Model::from_toml(&Source::new("model.toml", text.clone()));
        let is_undefined = |refused: &Diagnostics| refused.to_string().contains("E-division-by-zero");
        match model {
            Ok((model, _)) => Some(model),
            Err(refused) if is_undefined(&refused) => None,
            Err(refused) => panic!("{refused}\n{text}"),
        }
    }
}

fn one_of(random: &mut Random, list: &[&'static str]) -> &'static str {
    list[random.below(list.len())]
}

/// Polynomials whose zeros are lines along an axis, isolated points, cusps, nodes, and pieces that meet in one point.
const SHAPES: [&str; 24] = [
    "X",
    "(3*Y + 1)",
    "(X^2 - 1/4)",
    "(Y^2 - 2)",
    "X*(Y - 1/3)",
    "(X^2 + Y^2)",
    "(X^2 + 2*Y^2 - 1)",
    "(Y^2 - X^3)",
    "(Y^2 - X^2*(X + 1))",
    "(Y^2 - X^2*(X - 1))",
    "X*Y",
    "(X^2 - Y^2)",
    "(Y - X^2)",
    "(X*Y - 1)",
    "((X^2 + Y^2)^2 - X^2 + Y^2)",
    "(X^2*Y - 1)",
    "(Y*(X^2 + 1) - 1)",
    "X^2",
    "(X + 2*Y - 1)",
    "(Y^3 - X^2)",
    "((X^2 - 1)^2 + (Y^2 - 1)^2)",
    "(X^2 + Y^2)*(X - 1)",
    "(Y - 1)*(X^2 + Y^2 - 1)",
    "(X^3 - X - Y)",
];

/// A shape, moved along both axes.
fn shape(random: &mut Random) -> String {
    let [a, b] = [0; 2].map(|_| one_of(random, &["x", "(x - 1/3)", "(x + 1/2)", "x", "2*x"]));
    let (x, y) = (a, b.replace('x', "y"));
    one_of(random, &SHAPES).replace('X', x).replace('Y', &y)
}

/// A polynomial of few terms.
fn few_terms(random: &mut Random) -> String {
    let mut out = String::from("(0");
    for _ in 0..1 + random.below(3) {
        let (c, i, j) = (random.below(13) as i64 - 6, random.below(3), random.below(2));
        out += &format!(" + ({c}/8)*x^{i}*y^{j}");
    }
    out + ")"
}

/// Polynomials of low degree beside a shape.
const SIMPLE: [&str; 10] = [
    "x",
    "y",
    "x*y",
    "(x - 1/3)",
    "(3*y + 1)",
    "(x + 2*y - 1)",
    "(y - x^2)",
    "(x^2 - 1/4)",
    "(x - y^2)",
    "(x - a)*(y - a)",
];

/// Characteristic polynomials; in the place of `A` and `B` stand numbers.
const DISCRETE: [&str; 9] = [
    "z - 1 + A*F",
    "z + B*F",
    "(z - 1 + A*F)*(z + 1 - B*G)",
    "z^2 + A*F*z + B*G",
    "(z - A*F)*(z^2 + B*z + 1 - G)",
    "z^3 + A*F*z^2 + B*G*z + F/3",
    "z^2 - F*G*z + A*F + B*G/2",
    "F*z^2 + A*G*z + B",
    "z + (A*F + B)/G",
];
const CONTINUOUS: [&str; 6] = [
    "s^2 + A*F*s + B*G",
    "(s + A*F)*(s + B*G)",
    "(s + A*F)*(s^2 + G*s + B)",
    "s^3 + A*s^2 + F*s + B*G",
    "F*s^2 + A*s + G",
    "s^2 + A*F*s + G/(F + B)",
];

fn characteristic(random: &mut Random, constants: &[&'static str]) -> Loop {
    let is_discrete = random.below(3) > 0;
    let list: &[&'static str] = if is_discrete { &DISCRETE } else { &CONTINUOUS };
    let form = one_of(random, list);
    let numbers = [one_of(random, constants), one_of(random, constants)];
    let (f, g) =
        (shape(random), if random.below(4) == 0 { few_terms(random) } else { one_of(random, &SIMPLE).to_owned() });
    let text = form.replace('A', "a").replace('B', "b").replace('F', &f).replace('G', &g);
    Loop {
        head: format!("time = '{}'\n", if is_discrete { "discrete" } else { "continuous" }),
        constants: format!("a = '{}'\nb = '{}'\n", numbers[0], numbers[1]),
        tail: format!("[loop]\ncharacteristic = '{text}'\n"),
        window: [["-3/2", "2"], ["-2", "5/3"]],
    }
}

/// A loop without constants that are not rational.
pub fn rational(random: &mut Random) -> Loop {
    characteristic(random, &["1", "1/2", "1/3", "3/4", "1", "2"])
}

/// A loop whose polynomial has constants that are algebraic, transcendental, or rational for reasons of their own.
pub fn over_constants(random: &mut Random) -> Loop {
    characteristic(random, &["exp(-1)", "pi/4", "sqrt(2)/2", "cos(1)", "exp(-1/2)", "cos(pi/5)", "sqrt(2)", "1", "1/2"])
}

/// Plants: undamped, with poles that cancel, and usual ones.
const PLANTS: [&str; 12] = [
    "1/(s^2 + 1)",
    "1/(s*(s^2 + 1))",
    "1/(s^2 + 4)",
    "s/(s^2 + 1)",
    "(s + 1)/(s^2 + 1)",
    "(s + 1)/((s + 1)*(s^2 + 1))",
    "(s + 2)/(s*(s + 2))",
    "1/s^2",
    "1/(s*(s + 1))",
    "1/(s^2 + s + 1)",
    "1/(s + 1)",
    "1/(s - 1)",
];

const CONTROLLERS: [&str; 11] = [
    "x*(z - y)/z",
    "(x - 1/3)*(z - y)/z",
    "x*(z - y)/z",
    "x + y/(z - 1)",
    "x + y*(z - 1)/z",
    "(x*z + y)/z",
    "x*(z - y)/(z - 1/2)",
    "(x - 1/3)*(y + 1/2)",
    "x*(y - 2)/z",
    "x*y + x/z",
    "(x^2 - 1/4)*(z - y)/z",
];

const DELAYS: [&str; 7] = ["", "", "1/2*T", "1/3*T", "T", "3/2*T", "1/4*T"];

/// A plant behind a hold, its sample time a number or, with the name `y`, a parameter.
fn behind_a_hold(random: &mut Random, time: &str, controllers: &[&'static str]) -> Loop {
    let (method, delay) = (one_of(random, &["zoh", "foh"]), one_of(random, &DELAYS));
    let rule = match (delay, random.below(8)) {
        (_, 0) => "{ method = 'tustin' }".to_owned(),
        ("", _) => format!("{{ method = '{method}' }}"),
        _ => format!("{{ method = '{method}', delay = '{}' }}", delay.replace('T', time)),
    };
    let (controller, plant) = (one_of(random, controllers), one_of(random, &PLANTS));
    let constants = if time == "T" {
        format!("T = '{}'\n", one_of(random, &["1", "1", "1/2", "2", "pi/3", "3/2"]))
    } else {
        String::new()
    };
    Loop {
        head: format!("time = 'discrete'\nsample_time = '{time}'\n"),
        constants,
        tail: format!(
            "[loop]\ninputs = ['r']\noutputs = ['p']\n[[block]]\nname = 'controller'\ninput = 'r - p'\noutput = 'u'\n\
             transfer = '{controller}'\n[[block]]\nname = 'plant'\ninput = 'u'\noutput = 'p'\ntransfer = '{plant}'\n\
             discretize = {rule}\n"
        ),
        window: [["-1", "2"], ["1/10", "2"]],
    }
}

/// A plant behind a hold of constant period.
pub fn held(random: &mut Random) -> Loop {
    behind_a_hold(random, "T", &CONTROLLERS)
}

/// A plant behind a hold whose period is a parameter.
pub fn inside_of_functions(random: &mut Random) -> Loop {
    let controllers = ["x", "x*(z - 1/2)/z", "x/z", "x + 1/10/(z - 1)", "x - 1/3", "x*(z - 1/3)/(z - 1/2)"];
    behind_a_hold(random, "y", &controllers)
}

/// A loop with dead time.
pub fn with_dead_time(random: &mut Random) -> Loop {
    let forms = [
        "s + A + x*exp(-y*s)",
        "s^2 + A*s + B + x*exp(-y*s)",
        "s^2 + 1 + (x + A*s)*exp(-y*s)",
        "s^2 + A*s + (x + y*s)*exp(-s)",
        "s*(s + A) + (x*s + y)*exp(-s/2)",
        "s + x + y*exp(-s) + B*exp(-2*s)",
        "(s + x)*(s + A) + y*exp(-B*s)",
        "s^2 + y*s + x^2*exp(-s)",
        "s^2 + A*s + x*y*exp(-s)",
        "(s + x)*(s + 1 + y*exp(-s))",
    ];
    let numbers = [one_of(random, &["1", "1/2", "2", "1/3", "0"]), one_of(random, &["1", "1/2", "2", "1/3"])];
    let text = one_of(random, &forms).replace('A', numbers[0]).replace('B', numbers[1]);
    Loop {
        head: "time = 'continuous'\n".to_owned(),
        constants: String::new(),
        tail: format!("[loop]\ncharacteristic = '{text}'\n"),
        window: [["-1", "2"], ["1/10", "2"]],
    }
}
