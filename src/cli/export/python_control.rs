//! Scripts for the Python package python-control.

use super::Target;
use jurist_show::notation::PYTHON_KEYWORDS;

/// A Python file for the package `control`.
pub(in crate::cli) struct PythonControl;

/// Names of the script's own imports.
const OWN: [&str; 16] = [
    "append", "c2d", "conv", "control", "cos", "exp", "feedback", "np", "pi", "print", "roots", "sin", "sorted",
    "sqrt", "ss", "tan",
];

/// Functions of `control` that scripts use.
const OF_CONTROL: [&str; 4] = ["append", "c2d", "feedback", "ss"];

/// Functions of `math` that formulas use, and the circle number.
const OF_MATH: [&str; 6] = ["cos", "exp", "pi", "sin", "sqrt", "tan"];

const HELPERS: [(&str, &[&str]); 5] = [
    (
        "gain",
        &[
            "",
            "def gain(D):",
            "    D = np.array(D, float)",
            "    return ss(np.zeros((0, 0)), np.zeros((0, D.shape[1])), np.zeros((D.shape[0], 0)), D, dt)",
        ],
    ),
    (
        "realise",
        &[
            "",
            "# Companion form keeps common factors of numerator and denominator; a conversion of tf() may cancel them.",
            "def realise(num, den, dt):",
            "    num, den = np.array(num, float) / den[0], np.array(den, float) / den[0]",
            "    n = len(den) - 1",
            "    A = np.vstack([-den[1:], np.eye(n - 1, n)])",
            "    return ss(A, np.eye(n, 1), [num[1:] - num[0] * den[1:]], [[num[0]]], dt)",
        ],
    ),
    ("forward", &["", "def forward(G, T):", "    return ss(np.eye(G.nstates) + T * G.A, T * G.B, G.C, G.D, dt)"]),
    (
        "backward",
        &[
            "",
            "def backward(G, T):",
            "    M = np.linalg.inv(np.eye(G.nstates) - T * G.A)",
            "    return ss(M, T * M @ G.B, G.C @ M, G.D + T * G.C @ M @ G.B, dt)",
        ],
    ),
    (
        "bilinear",
        &[
            "",
            "# s is replaced by c (z - 1)/(z + 1).",
            "def bilinear(G, c):",
            "    M = np.linalg.inv(c * np.eye(G.nstates) - G.A)",
            "    return ss(M @ (c * np.eye(G.nstates) + G.A), M @ G.B, 2 * c * G.C @ M, G.D + G.C @ M @ G.B, dt)",
        ],
    ),
];

impl Target for PythonControl {
    fn words(&self) -> &'static str {
        "python-control 0.10"
    }

    fn reserved(&self) -> [&'static [&'static str]; 2] {
        [PYTHON_KEYWORDS, &OWN]
    }

    fn comment(&self) -> &'static str {
        "#"
    }

    fn end(&self) -> &'static str {
        ""
    }

    fn continued(&self) -> &'static str {
        ""
    }

    fn power(&self) -> &'static str {
        "**"
    }

    fn times(&self) -> &'static str {
        " @ "
    }

    fn matrix(&self, rows: &[Vec<String>]) -> String {
        let rows: Vec<String> = rows.iter().map(|row| format!("[{}]", row.join(", "))).collect();
        format!("np.array([{}])", rows.join(", "))
    }

    fn of_size(&self, function: &str, rows: usize, columns: usize) -> String {
        match function {
            "eye" => format!("np.eye({rows})"),
            _ => format!("np.{function}(({rows}, {columns}))"),
        }
    }

    fn unknown_step(&self) -> &'static str {
        "True"
    }

    fn preamble(&self, uses: &dyn Fn(&str) -> bool) -> Vec<String> {
        let from = |module: &str, names: &[&str]| {
            let names: Vec<&str> = names.iter().copied().filter(|name| uses(name)).collect();
            (!names.is_empty()).then(|| format!("from {module} import {}", names.join(", ")))
        };
        let mut lines: Vec<String> = from("math", &OF_MATH).into_iter().collect();
        lines.push(String::new());
        lines.extend(uses("np").then(|| "import numpy as np".to_owned()));
        lines.extend(from("control", &OF_CONTROL));
        let arrays = [("conv", "convolve as conv"), ("roots", "roots")];
        let arrays: Vec<&str> = arrays.into_iter().filter(|(name, _)| uses(name)).map(|(_, import)| import).collect();
        lines.extend((!arrays.is_empty()).then(|| format!("from numpy import {}", arrays.join(", "))));
        // Modules of Python's own stand in a paragraph of their own, where there are any.
        if lines.first().is_some_and(String::is_empty) {
            lines.remove(0);
        }
        lines
    }

    fn helpers(&self) -> &'static [(&'static str, &'static [&'static str])] {
        &HELPERS
    }

    fn print_poles(&self, is_polynomial: bool) -> Vec<String> {
        let poles = if is_polynomial { "poles" } else { "closed_loop.poles()" };
        vec![format!("for pole in sorted({poles}, key=abs):"), "    print(pole)".to_owned()]
    }
}
