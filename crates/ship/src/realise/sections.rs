//! Sections of order two.

use super::Realisation;
use super::direct::{Delays, one};
use super::structure::{Form, Realised, Slot, Slots, Structure};
use crate::program::{Operand, Program};
use jurist_algebra::ball::Ball;
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Enclosure, Integer, Rational};
use jurist_algebra::poly::{Domain, Poly, RootDisc, UniPoly, complex_roots, root_discs, simplest_between};

/// Bits to which roots of sections are known, where they are no rational numbers.
const ROOT_BITS: u64 = 256;

/// A chain of sections of order two, each in direct form 1, of a transfer function in z as [`direct`](super::direct()) takes it: poles by falling
/// modulus, each pair with the zeros that are nearest. `None` where enclosed coefficients do not tell roots apart.
///
/// Cost: that of [`complex_roots`] with 256 bits.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_algebra::number::{Enclosure, parse_number};
/// use jurist_ship::realise::sections;
/// let exact = |texts: &[&str]| texts.iter().map(|t| Enclosure::from_rational(parse_number(t).unwrap())).collect::<Vec<_>>();
/// // (z - 0.2)/((z - 0.5)(z^2 - z + 0.7))
/// let chain = sections(&exact(&["0", "0", "1", "-0.2"]), &exact(&["1", "-1.5", "1.2", "-0.35"]), &Budget::unlimited())?.unwrap();
/// let names: Vec<&str> = chain.program.coefficients.iter().map(|c| c.name.as_str()).collect();
/// assert_eq!(names, ["a2_1", "b1_2", "a1_2"]);
/// # Ok::<(), jurist_algebra::limits::Exhausted>(())
/// ```
///
/// # Errors
/// [`Exhausted`] when the budget runs out.
///
/// # Panics
/// When the lengths differ, or there is no coefficient.
pub fn sections(
    numerator: &[Enclosure],
    denominator: &[Enclosure],
    budget: &Budget,
) -> Result<Option<Realised>, Exhausted> {
    assert!(!denominator.is_empty() && numerator.len() == denominator.len(), "a proper fraction");
    let Some((_, poles)) = factors(denominator, budget)? else { return Ok(None) };
    let Some((gain, zeros)) = factors(numerator, budget)? else { return Ok(None) };
    let wholes = [numerator, denominator].map(whole);
    let chain = paired(grouped(poles), zeros);
    let mut slots = Slots::default();
    let mut program = Program {
        inputs: 1,
        coefficients: Vec::new(),
        states: Vec::new(),
        nodes: Vec::new(),
        updates: Vec::new(),
        outputs: Vec::new(),
    };
    let mut delays = Delays::default();
    let (mut input, mut input_name) = (Operand::Input(0), "u".to_owned());
    let mut fractions = Vec::new();
    for (at, (zeros, poles)) in chain.iter().enumerate() {
        let factor = if at == 0 { gain.clone() } else { exactly(Rational::ONE) };
        let of = |factors: &[Factor], whole: &Option<UniPoly>| {
            rational_part(polynomial(factors, poles_degree(poles)), whole.as_ref())
        };
        let b: Vec<Enclosure> = of(zeros, &wholes[0]).iter().map(|c| product(c, &factor)).collect();
        let a = of(poles, &wholes[1]);
        let mut row = |letter: &str, row: &[Enclosure]| -> Vec<Slot> {
            row.iter().enumerate().map(|(k, c)| slots.slot(format!("{letter}{k}_{}", at + 1), c)).collect()
        };
        let fraction = (row("b", &b), row("a", &a));
        let name = format!("y_{}", at + 1);
        input = one(&fraction, (&name, input, &input_name), &mut delays, &mut program);
        input_name = name;
        fractions.push(fraction);
    }
    program.coefficients = slots.coefficients;
    program.outputs = vec![input];
    Ok(Some(Realised { realisation: Realisation::Sos, program, structure: Structure(Form::Chain(fractions)) }))
}

/// A monic factor of degree one or two: its coefficients but the first, highest power first, and where its root of greatest modulus is, roughly.
#[derive(Clone, Debug)]
pub(super) struct Factor {
    rest: Vec<Enclosure>,
    near: (Rational, Rational),
}

impl Factor {
    /// The square of the modulus of the root.
    fn size(&self) -> Rational {
        &self.near.0 * &self.near.0 + &self.near.1 * &self.near.1
    }

    fn distance(&self, other: &Factor) -> Rational {
        let [re, im] = [&self.near.0 - &other.near.0, &self.near.1 - &other.near.1];
        &re * &re + &im * &im
    }
}

pub(super) fn exactly(value: Rational) -> Enclosure {
    Enclosure::from_rational(value)
}

/// The product, exact where both are.
pub(super) fn product(a: &Enclosure, b: &Enclosure) -> Enclosure {
    let ends = [(a.lower(), b.lower()), (a.lower(), b.upper()), (a.upper(), b.lower()), (a.upper(), b.upper())]
        .map(|(x, y)| x * y);
    let low = ends.iter().min().expect("there are four").clone();
    let high = ends.iter().max().expect("there are four").clone();
    Enclosure::new(low, high)
}

/// The leading coefficient that is not zero, and the monic factors. `None` where roots are not told apart.
pub(super) fn factors(p: &[Enclosure], budget: &Budget) -> Result<Option<(Enclosure, Vec<Factor>)>, Exhausted> {
    let is_zero = |c: &&Enclosure| c.lower().is_zero() && c.upper().is_zero();
    let leading = p.iter().take_while(is_zero).count();
    let p = &p[leading..];
    let Some(first) = p.first() else { return Ok(Some((exactly(Rational::ZERO), Vec::new()))) };
    if p.len() == 1 {
        return Ok(Some((first.clone(), Vec::new())));
    }
    let narrow = Rational::dyadic(&Integer::ONE, ROOT_BITS);
    let exact = p.iter().all(|c| c.lower() == c.upper()).then(|| cleared(p));
    let discs = match &exact {
        Some(polynomial) => complex_roots(polynomial, &narrow, budget)?,
        None => {
            let bits = ROOT_BITS * 2;
            let balls: Vec<Ball> = p.iter().rev().map(|c| Ball::from_enclosure(c, bits)).collect();
            let discs = root_discs(&balls, bits).filter(|discs| discs.iter().all(|disc| disc.is_one));
            let Some(discs) = discs else { return Ok(None) };
            discs
        }
    };
    let factor = |disc: &RootDisc| {
        let found = factor_of(disc);
        exact.as_ref().and_then(|polynomial| rational_factor(&found, polynomial)).unwrap_or(found)
    };
    let factors = discs.iter().flat_map(|disc| std::iter::repeat_n(factor(disc), disc.count)).collect();
    Ok(Some((first.clone(), factors)))
}

/// The polynomial with integer coefficients.
fn cleared(p: &[Enclosure]) -> UniPoly {
    UniPoly::from_rational_poly(&Poly::new(p.iter().rev().map(|c| c.lower().clone()).collect())).1
}

/// `z - x`, or `z^2 - 2 x z + x^2 + y^2`, of the roots in a disc.
fn factor_of(disc: &RootDisc) -> Factor {
    let (x, y, r) = (&disc.re, &disc.im, &disc.radius);
    let about = |middle: Rational, width: Rational| Enclosure::new(&middle - &width, middle + width);
    let two = Rational::from(2);
    let rest = if disc.is_pair {
        let width = &two * &((x.abs() + y.abs()) * r) + r * r;
        vec![about(-(&two * x), &two * r), about(x * x + y * y, width)]
    } else {
        vec![about(-x, r.clone())]
    };
    Factor { rest, near: (x.clone(), y.clone()) }
}

/// The polynomial with integer coefficients, without zeros in front; `None` where coefficients are enclosed only.
fn whole(p: &[Enclosure]) -> Option<UniPoly> {
    let is_exact = p.iter().all(|c| c.lower() == c.upper());
    is_exact.then(|| cleared(p)).filter(|polynomial| !polynomial.is_zero())
}

/// Monic coefficients, zeros in front, as rational numbers, if the simplest ones in their enclosures divide the whole polynomial: roots that are not
/// rational may have a product that is.
fn rational_part(p: Vec<Enclosure>, whole: Option<&UniPoly>) -> Vec<Enclosure> {
    let rational = |c: &Enclosure| match c.lower() == c.upper() {
        true => Some(c.lower().clone()),
        false => simplest_between(c.lower(), c.upper()),
    };
    let found = || {
        let candidates: Vec<Enclosure> = p.iter().map(|c| rational(c).map(exactly)).collect::<Option<_>>()?;
        whole?.div_exact(&cleared(&candidates))?;
        Some(candidates)
    };
    found().unwrap_or(p)
}

/// The factor with the simplest numbers in its enclosures, if it divides the polynomial.
fn rational_factor(factor: &Factor, polynomial: &UniPoly) -> Option<Factor> {
    let rest: Vec<Rational> = factor
        .rest
        .iter()
        .map(|c| if c.lower() == c.upper() { Some(c.lower().clone()) } else { simplest_between(c.lower(), c.upper()) })
        .collect::<Option<_>>()?;
    let monic: Vec<Enclosure> = std::iter::once(Rational::ONE).chain(rest.iter().cloned()).map(exactly).collect();
    polynomial.div_exact(&cleared(&monic))?;
    Some(Factor { rest: rest.into_iter().map(exactly).collect(), near: factor.near.clone() })
}

/// Poles in groups of order two and one, by falling modulus: pairs of complex ones, real ones as they come.
pub(super) fn grouped(mut factors: Vec<Factor>) -> Vec<Vec<Factor>> {
    factors.sort_by_key(|factor| std::cmp::Reverse(factor.size()));
    let (pairs, real): (Vec<Factor>, Vec<Factor>) = factors.into_iter().partition(|factor| factor.rest.len() == 2);
    let mut groups: Vec<Vec<Factor>> = pairs.into_iter().map(|pair| vec![pair]).collect();
    groups.extend(real.chunks(2).map(<[Factor]>::to_vec));
    groups.sort_by_key(|group| std::cmp::Reverse(group[0].size()));
    if groups.is_empty() { vec![Vec::new()] } else { groups }
}

/// Each group of poles with its zeros: pairs of zeros first, each to the nearest group with room.
fn paired(groups: Vec<Vec<Factor>>, zeros: Vec<Factor>) -> Vec<(Vec<Factor>, Vec<Factor>)> {
    let mut out: Vec<(Vec<Factor>, Vec<Factor>)> = groups.into_iter().map(|poles| (Vec::new(), poles)).collect();
    let (pairs, real): (Vec<Factor>, Vec<Factor>) = zeros.into_iter().partition(|factor| factor.rest.len() == 2);
    for zero in pairs.into_iter().chain(real) {
        let has_room = |(zeros, poles): &&mut (Vec<Factor>, Vec<Factor>)| {
            poles_degree(zeros) + zero.rest.len() <= poles_degree(poles)
        };
        let nearest =
            out.iter_mut().filter(has_room).min_by_key(|(_, poles)| poles.iter().map(|p| p.distance(&zero)).min());
        nearest.expect("a proper fraction has no more zeros than poles").0.push(zero);
    }
    out
}

fn poles_degree(factors: &[Factor]) -> usize {
    factors.iter().map(|factor| factor.rest.len()).sum()
}

/// The product of monic factors, with zeros in front up to this degree.
pub(super) fn polynomial(factors: &[Factor], degree: usize) -> Vec<Enclosure> {
    let mut out = vec![exactly(Rational::ONE)];
    for factor in factors {
        let monic: Vec<Enclosure> =
            std::iter::once(exactly(Rational::ONE)).chain(factor.rest.iter().cloned()).collect();
        let mut next = vec![exactly(Rational::ZERO); out.len() + monic.len() - 1];
        for (i, x) in out.iter().enumerate() {
            for (j, y) in monic.iter().enumerate() {
                let term = product(x, y);
                next[i + j] = Enclosure::new(next[i + j].lower() + term.lower(), next[i + j].upper() + term.upper());
            }
        }
        out = next;
    }
    let missing = (degree + 1).saturating_sub(out.len());
    std::iter::repeat_n(exactly(Rational::ZERO), missing).chain(out).collect()
}
