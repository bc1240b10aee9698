//! The functions of the frequency for which a requirement asks, whatever their coefficients are.

use super::along_circle::Coefficient;
use super::requirement::Rule;
use jurist_algebra::number::{Integer, Rational};

/// When a crossing is allowed.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Allows {
    /// A crossing is allowed where the sign is positive.
    Positive,
    /// It is where both signs are the same; the open loop is real at both ends of the circle, if it is finite at `y = 0`.
    Same { at_zero: bool },
}

/// A function along the boundary of stability: the first polynomial, plus each other polynomial times its own factor.
pub(super) type Function<C, const N: usize> = [Vec<C>; N];

/// What requirements ask of an open loop along the boundary of stability, as functions whose coefficients depend on parameters.
pub(super) trait Products<C: Coefficient, const N: usize> {
    /// Twice the squares of the moduli of the denominator and of the numerator.
    fn moduli(&self) -> [Function<C, N>; 2];
    /// Twice the real part of the numerator times the conjugate of the denominator.
    fn twice_real(&self) -> Function<C, N>;
    /// Its imaginary part without a factor of the numerator, divided by something positive: where a gain is zero all frequencies would be
    /// crossings, and none of them matters.
    fn imaginary(&self) -> Function<C, N>;
    /// Twice the square of the modulus of `u D + v N`.
    fn combined(&self, u: &Integer, v: &Integer) -> Function<C, N>;
    /// The real part in place of that imaginary part, times the same; `None` where it is not asked for.
    fn real(&self) -> Option<Function<C, N>> {
        None
    }
    /// Whether the open loop is infinite at the lowest frequency.
    fn has_integrator(&self) -> bool;
}

/// The functions for which a requirement asks.
pub(super) struct Functions<C, const N: usize> {
    /// What is zero at a crossing; none where each frequency counts.
    pub crossing: Option<Function<C, N>>,
    /// What tells whether a crossing is allowed.
    pub signs: Vec<Function<C, N>>,
    /// Where both have the same sign, the open loop is so near to a right angle that it may have any modulus.
    pub upright: Vec<Function<C, N>>,
    /// Where it is positive the open loop is so large that any crossing is allowed.
    pub large: Option<Function<C, N>>,
    /// Which crossings are allowed.
    pub rule: Allows,
}

impl<C: Coefficient, const N: usize> Functions<C, N> {
    /// Of a rule; `alpha` is the number that is asked for.
    pub fn of(rule: &Rule, products: &impl Products<C, N>, alpha: &C) -> Functions<C, N> {
        Functions::without_upright(rule, products, alpha).beside(rule, products)
    }

    fn without_upright(rule: &Rule, products: &impl Products<C, N>, alpha: &C) -> Functions<C, N> {
        let times = |p: &Function<C, N>, c: &C| p.each_ref().map(|p| p.iter().map(|x| x.times(c)).collect());
        match rule {
            Rule::Factors(_) => {
                // 2 |D|^2 + k 2 Re(N conj D) at both ends of the factors.
                let ([below, _], twice_real) = (products.moduli(), products.twice_real());
                let signs = [sum(&times(&below, alpha), &twice_real), sum(&below, &times(&twice_real, alpha))];
                // With an integrator the open loop is infinite at the lowest frequency: nothing crosses there.
                let rule = Allows::Same { at_zero: !products.has_integrator() };
                let functions = Functions::new(Some(products.imaginary()), signs.into(), rule);
                // Where the open loop is infinite all of these vanish. |N| > k |D| is seen there.
                let below = times(&times(&scaled(&below, &-Integer::ONE), alpha), alpha);
                let large =
                    Functions::new(None, vec![sum(&products.moduli()[1], &below)], Allows::Positive).signs.pop();
                Functions { large, ..functions }
            }
            Rule::Circle(circle) => {
                let [u, v] = circle.combined().map(Integer::from);
                let [p, q] = [circle.least().numerator(), circle.least().denominator()];
                let (whole, part) = (products.combined(&Integer::ONE, &Integer::ONE), products.combined(&u, &v));
                let excess = sum(&scaled(&whole, &(&q * &q)), &scaled(&part, &-(&p * &p)));
                Functions::new(None, vec![excess], Allows::Positive)
            }
            _ => {
                let ([below, above], twice_real) = (products.moduli(), products.twice_real());
                let excess = sum(&above, &scaled(&below, &-Integer::ONE));
                let sign = sum(&scaled(&twice_real, &Integer::from(2)), &times(&above, alpha));
                Functions::new(Some(excess), vec![sign], Allows::Positive)
            }
        }
    }

    /// Of functions given by coefficients of powers of the variable. They are divided by powers of it, which are positive: with integrators they
    /// vanish at 0. Signs that are compared with each other are divided by the same power, so that one that vanishes at 0 alone is seen there.
    pub fn new(mut crossing: Option<Function<C, N>>, mut signs: Vec<Function<C, N>>, rule: Allows) -> Functions<C, N> {
        let of_one = |p: &Vec<C>| p.iter().take_while(|c| c.is_zero()).count();
        let zeros = |f: &Function<C, N>| {
            let most = f.iter().map(Vec::len).max().unwrap_or(1) - 1;
            f.iter().filter(|p| of_one(p) < p.len()).map(of_one).min().unwrap_or(0).min(most)
        };
        let divide = |f: &mut Function<C, N>, by: usize| {
            for p in f {
                let all = p.len().saturating_sub(1);
                p.drain(..by.min(all));
            }
        };
        let common = signs.iter().map(zeros).min().unwrap_or(0);
        signs.iter_mut().for_each(|f| divide(f, common));
        if let Some(f) = &mut crossing {
            let by = zeros(f);
            divide(f, by);
        }
        Functions { crossing, signs, upright: Vec::new(), large: None, rule }
    }

    /// With what tells where the open loop is near to a right angle.
    fn beside(mut self, rule: &Rule, products: &impl Products<C, N>) -> Functions<C, N> {
        if let (true, Some(real), Some(most)) = (products.has_integrator(), products.real(), upright(rule)) {
            let imaginary = products.imaginary();
            let (wide, below) = (scaled(&imaginary, &most.numerator()), most.denominator());
            let both = [below.clone(), -below].map(|c| sum(&wide, &scaled(&real, &c)));
            self.upright = Functions::new(None, both.into(), Allows::Positive).signs;
        }
        self
    }
}

/// The tangent of an angle by which an open loop of any modulus may be off a right angle and meets what is required; `None` where none is known.
fn upright(rule: &Rule) -> Option<Rational> {
    let positive = |x: Rational| Some(x).filter(|x| x.sign().is_gt());
    match rule {
        // |L| = 1 and 2 cos + alpha > 0.
        Rule::Turned { twice_cosine } => {
            let (lower, _) = twice_cosine.refined(&Rational::dyadic(&Integer::ONE, UPRIGHT_BITS)).enclosure();
            positive(&lower * &Rational::dyadic(&Integer::ONE, 2))
        }
        // Nothing crosses the real axis.
        Rule::Factors(_) => Some(Rational::ONE),
        // With L = r (cos + j sin), q^2 |1 + L|^2 - p^2 |u + v L|^2 = (q^2 - p^2 u^2) + (q^2 - p^2 v^2) r^2 + 2 (q^2 - p^2 u v) r cos.
        Rule::Circle(circle) => {
            let [u, v] = circle.combined().map(Rational::from);
            let square = circle.least() * circle.least();
            let [first, last] = [&u, &v].map(|x| Rational::ONE - &square * &(x * x));
            let between = Rational::ONE + &square * &(&u * &v).abs();
            let least = first.min(last);
            positive(&least.checked_div(&between)? * &Rational::dyadic(&Integer::ONE, 1))
        }
        _ => None,
    }
}

/// Bits of the number that is asked for.
const UPRIGHT_BITS: u64 = 32;

/// The sum of two functions.
pub(super) fn sum<C: Coefficient, const N: usize>(f: &Function<C, N>, g: &Function<C, N>) -> Function<C, N> {
    std::array::from_fn(|i| sum_of(&f[i], &g[i]))
}

/// A function times an integer.
pub(super) fn scaled<C: Coefficient, const N: usize>(f: &Function<C, N>, by: &Integer) -> Function<C, N> {
    f.each_ref().map(|p| p.iter().map(|c| c.scaled(by)).collect())
}

/// The sum of two polynomials.
pub(super) fn sum_of<C: Coefficient>(p: &[C], q: &[C]) -> Vec<C> {
    let (long, short) = if p.len() >= q.len() { (p, q) } else { (q, p) };
    let one = |(k, x): (usize, &C)| short.get(k).map_or_else(|| x.clone(), |y| x.plus(y));
    long.iter().enumerate().map(one).collect()
}
