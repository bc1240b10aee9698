//! Scripts for MATLAB's Control System Toolbox, and for Octave's package `control`.

use super::Target;
use jurist_show::notation::MATLAB_KEYWORDS;

/// A script that MATLAB and Octave read.
pub(in crate::cli) struct Matlab;

/// Keywords of Octave, and functions that scripts use.
const OWN: [&str; 30] = [
    "do",
    "endfor",
    "endfunction",
    "endif",
    "endwhile",
    "until",
    "append",
    "c2d",
    "compan",
    "conv",
    "cos",
    "disp",
    "exist",
    "exp",
    "eye",
    "feedback",
    "format",
    "inv",
    "numel",
    "pi",
    "pkg",
    "roots",
    "sin",
    "size",
    "sqrt",
    "ss",
    "tan",
    "tf",
    "zeros",
    "ans",
];

const HELPERS: [(&str, &[&str]); 5] = [
    ("gain", &["gain = @(D) ss([], [], [], D, dt);"]),
    (
        "realise",
        &[
            "% Companion form keeps common factors of numerator and denominator; a conversion of tf() may cancel them.",
            "realise = @(num, den, T) ss(compan(den), eye(numel(den) - 1, 1), ...",
            "    num(2:end)/den(1) - num(1)/den(1)*den(2:end)/den(1), num(1)/den(1), T);",
        ],
    ),
    ("forward", &["forward = @(G, T) ss(eye(size(G.a)) + T*G.a, T*G.b, G.c, G.d, dt);"]),
    (
        "backward",
        &[
            "backward = @(G, T) ss(inv(eye(size(G.a)) - T*G.a), T*((eye(size(G.a)) - T*G.a)\\G.b), ...",
            "    G.c/(eye(size(G.a)) - T*G.a), G.d + T*G.c*((eye(size(G.a)) - T*G.a)\\G.b), dt);",
        ],
    ),
    (
        "bilinear",
        &[
            "% s is replaced by c (z - 1)/(z + 1).",
            "bilinear = @(G, c) ss((c*eye(size(G.a)) - G.a)\\(c*eye(size(G.a)) + G.a), (c*eye(size(G.a)) - G.a)\\G.b, ...",
            "    2*c*(G.c/(c*eye(size(G.a)) - G.a)), G.d + G.c*((c*eye(size(G.a)) - G.a)\\G.b), dt);",
        ],
    ),
];

impl Target for Matlab {
    fn words(&self) -> &'static str {
        "MATLAB's Control System Toolbox and Octave's package control"
    }

    fn reserved(&self) -> [&'static [&'static str]; 2] {
        [MATLAB_KEYWORDS, &OWN]
    }

    fn comment(&self) -> &'static str {
        "%"
    }

    fn end(&self) -> &'static str {
        ";"
    }

    fn continued(&self) -> &'static str {
        " ..."
    }

    fn power(&self) -> &'static str {
        "^"
    }

    fn times(&self) -> &'static str {
        "*"
    }

    fn matrix(&self, rows: &[Vec<String>]) -> String {
        let rows: Vec<String> = rows.iter().map(|row| row.join(", ")).collect();
        format!("[{}]", rows.join("; "))
    }

    fn of_size(&self, function: &str, rows: usize, columns: usize) -> String {
        format!("{function}({rows}, {columns})")
    }

    fn unknown_step(&self) -> &'static str {
        "-1"
    }

    fn preamble(&self, _: &dyn Fn(&str) -> bool) -> Vec<String> {
        vec!["if exist('OCTAVE_VERSION', 'builtin'), pkg load control, end".to_owned()]
    }

    fn helpers(&self) -> &'static [(&'static str, &'static [&'static str])] {
        &HELPERS
    }

    fn print_poles(&self, is_polynomial: bool) -> Vec<String> {
        let poles = if is_polynomial { "poles" } else { "pole(closed_loop)" };
        vec!["format long".to_owned(), format!("disp({poles})")]
    }
}
