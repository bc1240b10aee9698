//! Systems whose signals stand as real and imaginary parts.

use super::{Parts, of_parts};
use crate::connect::state_space::System;
use jurist_algebra::matrix::RationalMatrix;
use jurist_algebra::poly::RationalFunction;

/// A frame that turns by an angle in each sample, from which a block is seen whose input is held in a frame that rests: rotations as cosine
/// and sine.
#[derive(Clone)]
pub(crate) struct Frame {
    /// Back by that angle.
    pub turn: [RationalFunction; 2],
    /// Back by it, and ahead by the advance of the command: how inputs enter the next state.
    pub enters: [RationalFunction; 2],
    /// Ahead by the advance: how inputs pass on at once.
    pub direct: [RationalFunction; 2],
}

impl Frame {
    /// Whether it does not turn at all, and commands are not turned either.
    pub fn is_at_rest(&self) -> bool {
        [&self.turn, &self.enters, &self.direct].into_iter().all(|[cosine, sine]| cosine.is_one() && sine.is_zero())
    }

    /// The frame with images in the place of cosines and sines.
    pub fn try_map<E>(&self, image: &dyn Fn(&RationalFunction) -> Result<RationalFunction, E>) -> Result<Frame, E> {
        let rotation = |[x, y]: &[RationalFunction; 2]| Ok([image(x)?, image(y)?]);
        Ok(Frame { turn: rotation(&self.turn)?, enters: rotation(&self.enters)?, direct: rotation(&self.direct)? })
    }
}

/// The system that does with real and imaginary parts what a real one does with each signal.
pub(crate) fn lifted_system(system: &System) -> System {
    let matrix = |m: &RationalMatrix| {
        let parts: Vec<Parts> =
            m.entries().iter().map(|f| Parts { re: f.clone(), im: RationalFunction::zero() }).collect();
        of_parts(m.rows(), m.columns(), |i, j| &parts[i * m.columns() + j])
    };
    let System { a, b, c, d } = system;
    System { a: matrix(a), b: matrix(b), c: matrix(c), d: matrix(d) }
}

/// A system of real and imaginary parts, as it is seen from a frame that turns: `exp(ja) G(z exp(jwT))`.
pub(crate) fn seen_from(system: System, frame: &Frame) -> System {
    let turned = |m: &RationalMatrix, [cosine, sine]: &[RationalFunction; 2]| {
        RationalMatrix::from_fn(m.rows(), m.columns(), |i, j| {
            let (x, y) = (&m[(i - i % 2, j)], &m[(i - i % 2 + 1, j)]);
            match i % 2 {
                0 => &(cosine * x) - &(sine * y),
                _ => &(sine * x) + &(cosine * y),
            }
        })
    };
    let System { a, b, c, d } = system;
    System { a: turned(&a, &frame.turn), b: turned(&b, &frame.enters), d: turned(&d, &frame.direct), c }
}

/// The complex ratio's controllable canonical form, in real and imaginary parts, and the square of the modulus of the denominator's leading
/// coefficient; `None` where that is zero.
pub(crate) fn realised_ratio(
    numerator: &[Vec<RationalFunction>; 2],
    denominator: &[Vec<RationalFunction>; 2],
) -> Option<(System, RationalFunction)> {
    let n = denominator[0].len() - 1;
    let at = |p: &[Vec<RationalFunction>; 2], k: usize| Parts { re: p[0][k].clone(), im: p[1][k].clone() };
    let leading = at(denominator, n);
    let square = &(&leading.re * &leading.re) + &(&leading.im * &leading.im);
    let below = square.recip()?;
    let times = |a: &Parts, b: &Parts| Parts {
        re: &(&a.re * &b.re) - &(&a.im * &b.im),
        im: &(&a.re * &b.im) + &(&a.im * &b.re),
    };
    let inverse = Parts { re: &leading.re * &below, im: -(&leading.im * &below) };
    let monic = |p: &[Vec<RationalFunction>; 2], k: usize| times(&at(p, k), &inverse);
    let real = |f: RationalFunction| Parts { re: f, im: RationalFunction::zero() };
    let (zero, one) = (real(RationalFunction::zero()), real(RationalFunction::one()));
    let direct = monic(numerator, n);
    let last: Vec<Parts> = (0..n).map(|k| monic(denominator, k)).collect();
    let negative = |p: &Parts| Parts { re: -&p.re, im: -&p.im };
    let below_diagonal: Vec<Parts> = last.iter().map(negative).collect();
    let c: Vec<Parts> = (0..n)
        .map(|k| {
            let (own, through) = (monic(numerator, k), times(&direct, &last[k]));
            Parts { re: &own.re - &through.re, im: &own.im - &through.im }
        })
        .collect();
    let a = of_parts(n, n, |i, k| match i + 1 {
        next if next == n => &below_diagonal[k],
        next if next == k => &one,
        _ => &zero,
    });
    let b = of_parts(n, 1, |i, _| if i + 1 == n { &one } else { &zero });
    let c = of_parts(1, n, |_, k| &c[k]);
    let d = of_parts(1, 1, |_, _| &direct);
    Some((System { a, b, c, d }, square))
}

/// Whether a matrix of parts is that of a real matrix.
fn is_real(m: &RationalMatrix) -> bool {
    let parts = |i: usize| (0..m.columns()).filter(move |j| i % 2 != j % 2).map(move |j| (i, j));
    (0..m.rows()).flat_map(parts).all(|at| m[at].is_zero())
}

/// The system of real signals, where no imaginary part is left in one of real and imaginary parts.
pub(crate) fn unlifted(system: &System) -> Option<System> {
    let System { a, b, c, d } = system;
    let half =
        |m: &RationalMatrix| RationalMatrix::from_fn(m.rows() / 2, m.columns() / 2, |i, j| m[(2 * i, 2 * j)].clone());
    [a, b, c, d].into_iter().all(is_real).then(|| System { a: half(a), b: half(b), c: half(c), d: half(d) })
}
