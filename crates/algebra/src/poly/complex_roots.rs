//! All complex roots of a polynomial, in discs.
//!
//! Approximations come from the iteration of Aberth and Ehrlich in fixed point, from starting points on the circles of the Newton
//! polygon (Bini, Numerical Algorithms 13, 1996). What is certain comes from Smith's theorem alone (J. ACM 17, 1970): around
//! approximations `z_i` of a polynomial of degree `n` with leading coefficient `c` the discs of radius `n |p(z_i)| / |c prod (z_i - z_j)|` hold
//! all roots, and a connected part of `k` discs holds `k` of them.

use super::UniPoly;
use crate::ball::Ball;
use crate::limits::{Budget, Exhausted, checkpoint};
use crate::number::{Integer, Rational};

/// A disc in the complex plane, and the number of roots in it. Discs of one square-free polynomial do not touch.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_algebra::number::Rational;
/// use jurist_algebra::poly::{UniPoly, complex_roots};
/// let narrow = Rational::dyadic(&1.into(), 40);
/// let roots = complex_roots(&UniPoly::from_i64(&[1, 0, 1]), &narrow, &Budget::unlimited())?; // i and -i
/// assert_eq!(roots.len(), 1);
/// let upper = &roots[0];
/// assert!(upper.is_pair && upper.count == 1 && upper.radius < narrow);
/// # Ok::<(), jurist_algebra::limits::Exhausted>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RootDisc {
    /// The real part of the centre.
    pub re: Rational,
    /// The imaginary part of the centre; zero for discs that are symmetric to the real axis.
    pub im: Rational,
    /// The radius; zero for a root that is known exactly.
    pub radius: Rational,
    /// How many roots lie in it, with multiplicity.
    pub count: usize,
    /// Whether all of them are one root.
    pub is_one: bool,
    /// Whether it lies above the real axis: then its mirror image has as many roots, and is not in the list.
    pub is_pair: bool,
}

/// The roots of a polynomial that is not zero, each with its multiplicity, in discs whose radius is at most `relative` times the distance of the
/// centre from zero. Of a pair of conjugate roots the upper one is listed.
///
/// Cost: for each doubling of the bits some dozen rounds of `degree^2` products.
///
/// # Errors
/// [`Exhausted`] when the budget runs out.
pub fn complex_roots(p: &UniPoly, relative: &Rational, budget: &Budget) -> Result<Vec<RootDisc>, Exhausted> {
    /// The bits to begin with, for polynomials of low degree with short coefficients.
    const FIRST_BITS: u64 = 192;
    budget.enter(|| {
        let mut out = Vec::new();
        for (factor, multiplicity) in p.square_free_decomposition() {
            let zeros = factor.coeffs().iter().take_while(|c| c.is_zero()).count();
            if zeros > 0 {
                out.push(RootDisc { count: multiplicity, ..RootDisc::exactly(Rational::ZERO) });
            }
            let coefficients = &factor.coeffs()[zeros..];
            if coefficients.len() < 2 {
                continue;
            }
            if let [c, a] = coefficients {
                let root = Rational::new(-c, a.clone());
                out.push(RootDisc { count: multiplicity, ..RootDisc::exactly(root) });
                continue;
            }
            let mut bits = FIRST_BITS;
            let found = loop {
                budget.check()?;
                let balls: Vec<Ball> = coefficients.iter().map(|c| Ball::from_integer(c, bits)).collect();
                // The roots of a square-free polynomial are apart: at some precision the discs show it.
                match root_discs(&balls, bits).filter(|discs| discs.iter().all(|disc| disc.is_fine(relative))) {
                    Some(discs) => break discs,
                    None => bits *= 2,
                }
            };
            out.extend(found.into_iter().map(|disc| RootDisc { count: multiplicity, ..disc }));
        }
        Ok(out)
    })?
}

impl RootDisc {
    /// A real number.
    fn exactly(re: Rational) -> RootDisc {
        RootDisc { re, im: Rational::ZERO, radius: Rational::ZERO, count: 1, is_one: true, is_pair: false }
    }

    /// Whether it holds one root and is small beside its distance from zero.
    pub fn is_fine(&self, relative: &Rational) -> bool {
        self.is_one
            && &self.radius * &self.radius <= (&self.re * &self.re + &self.im * &self.im) * (relative * relative)
    }
}

/// The roots of a polynomial with enclosed coefficients, from the constant term up: discs that are apart, each with the number of its roots; of
/// discs beside the real axis the upper ones. `None` where the leading coefficient may be zero, or no two approximations are apart.
///
/// Roots that are equal, or nearer to each other than the coefficients tell, share a disc.
///
/// Cost: some dozen rounds of `degree^2` products of numbers of `bits` bits.
pub fn root_discs(coefficients: &[Ball], bits: u64) -> Option<Vec<RootDisc>> {
    let degree = coefficients.len().checked_sub(1)?;
    if coefficients[degree].contains_zero() {
        return None;
    }
    if degree == 0 {
        return Some(Vec::new());
    }
    let middles: Vec<Integer> = coefficients.iter().map(Ball::middle_units).collect();
    let points = approximations(&middles, bits);
    let discs = smith(coefficients, &points, bits)?;
    Some(parted(discs))
}

/// A complex number in fixed point; rounded, and nothing certain.
#[derive(Clone, Debug)]
struct Point {
    re: Integer,
    im: Integer,
}

impl Point {
    fn zero() -> Point {
        Point { re: Integer::ZERO, im: Integer::ZERO }
    }

    fn plus(&self, other: &Point) -> Point {
        Point { re: &self.re + &other.re, im: &self.im + &other.im }
    }

    fn minus(&self, other: &Point) -> Point {
        Point { re: &self.re - &other.re, im: &self.im - &other.im }
    }

    fn times(&self, other: &Point, bits: u64) -> Point {
        let re = &(&self.re * &other.re) - &(&self.im * &other.im);
        let im = &(&self.re * &other.im) + &(&self.im * &other.re);
        Point { re: re >> bits, im: im >> bits }
    }

    /// `None` for a divisor that is zero.
    fn over(&self, other: &Point, bits: u64) -> Option<Point> {
        let square = &(&other.re * &other.re) + &(&other.im * &other.im);
        if square.is_zero() {
            return None;
        }
        let re = &(&self.re * &other.re) + &(&self.im * &other.im);
        let im = &(&self.im * &other.re) - &(&self.re * &other.im);
        Some(Point { re: (re << bits).div_mod_floor(&square).0, im: (im << bits).div_mod_floor(&square).0 })
    }

    fn bit_length(&self) -> u64 {
        self.re.bit_length().max(self.im.bit_length())
    }
}

/// Points on the circles of the Newton polygon: as many on each as roots of that size are to be expected.
fn beginning(coefficients: &[Integer], bits: u64) -> Vec<Point> {
    let size = |i: usize| coefficients[i].bit_length() as f64;
    let known: Vec<usize> = (0..coefficients.len()).filter(|i| !coefficients[*i].is_zero()).collect();
    let mut hull: Vec<usize> = Vec::new();
    for i in known {
        let is_below =
            |a: usize, b: usize| (size(b) - size(a)) * (i - a) as f64 <= (size(i) - size(a)) * (b - a) as f64;
        while let [.., a, b] = hull.as_slice()
            && is_below(*a, *b)
        {
            hull.pop();
        }
        hull.push(i);
    }
    let mut points = vec![Point::zero(); hull.first().copied().unwrap_or(0)];
    for pair in hull.windows(2) {
        let [a, b] = [pair[0], pair[1]];
        let log = (size(a) - size(b)) / (b - a) as f64;
        for k in 0..b - a {
            // An angle off the axes, and another one on each circle.
            let angle = std::f64::consts::TAU * k as f64 / (b - a) as f64 + 0.7 + a as f64;
            points.push(Point { re: scaled(angle.cos(), log, bits), im: scaled(angle.sin(), log, bits) });
        }
    }
    points
}

/// `x 2^log` in fixed point, roughly.
fn scaled(x: f64, log: f64, bits: u64) -> Integer {
    let whole = log.floor();
    let mantissa = (x * (log - whole).exp2() * f64::from(1u32 << 30)) as i64;
    let shift = whole as i64 + bits as i64 - 30;
    let n = Integer::from(mantissa);
    if shift >= 0 { n << shift as u64 } else { n >> shift.unsigned_abs() }
}

/// Approximations of all roots.
fn approximations(coefficients: &[Integer], bits: u64) -> Vec<Point> {
    /// Rounds until the approximations are taken as they are: Smith's discs say what they are worth.
    const MOST_ROUNDS: usize = 200;
    /// Bits that rounding may take from the last ones.
    const LOST: u64 = 16;
    let mut points = beginning(coefficients, bits);
    let n = points.len();
    for _ in 0..MOST_ROUNDS {
        checkpoint((n * n) as u64 * (bits / 64 + 1));
        let mut moved = 0;
        for i in 0..n {
            let z = points[i].clone();
            let (mut value, mut slope) = (Point::zero(), Point::zero());
            for c in coefficients.iter().rev() {
                slope = slope.times(&z, bits).plus(&value);
                value = value.times(&z, bits);
                value.re += c;
            }
            let Some(newton) = value.over(&slope, bits) else { continue };
            let one = Point { re: Integer::ONE << bits, im: Integer::ZERO };
            let others = (0..n).filter(|j| *j != i).filter_map(|j| one.over(&z.minus(&points[j]), bits));
            let sum = others.fold(Point::zero(), |sum, term| sum.plus(&term));
            let Some(step) = newton.over(&one.minus(&newton.times(&sum, bits)), bits) else { continue };
            moved = moved.max(step.bit_length());
            points[i] = z.minus(&step);
        }
        if moved <= LOST {
            break;
        }
    }
    points
}

/// A disc around an approximation.
struct Around {
    re: Rational,
    im: Rational,
    radius: Rational,
}

/// Smith's discs.
fn smith(coefficients: &[Ball], points: &[Point], bits: u64) -> Option<Vec<Around>> {
    let n = points.len();
    let exact = |units: &Integer| Ball::from_units(units.clone(), units.clone(), bits);
    let balls: Vec<[Ball; 2]> = points.iter().map(|p| [exact(&p.re), exact(&p.im)]).collect();
    let times = |[a, b]: &[Ball; 2], [c, d]: &[Ball; 2]| [a.mul(c).sub(&b.mul(d)), a.mul(d).add(&b.mul(c))];
    let square = |[a, b]: &[Ball; 2]| a.square().add(&b.square());
    let mut out = Vec::with_capacity(n);
    for i in 0..n {
        checkpoint(n as u64 * (bits / 64 + 1));
        let z = &balls[i];
        let mut value = [Ball::zero(bits), Ball::zero(bits)];
        for c in coefficients.iter().rev() {
            let [re, im] = times(&value, z);
            value = [re.add(c), im];
        }
        // Exact differences keep small ones from being lost between large ones.
        let mut radius = square(&value).upper() * Rational::from((n * n) as i64);
        let leading = coefficients.last()?;
        let least = Rational::dyadic(&leading.least_magnitude_units(), bits);
        radius = radius.checked_div(&(&least * &least))?;
        for (_, other) in points.iter().enumerate().filter(|(j, _)| *j != i) {
            let d = points[i].minus(other);
            let distance = &(&d.re * &d.re) + &(&d.im * &d.im);
            radius = rounded_up(&radius.checked_div(&Rational::dyadic(&distance, 2 * bits))?, bits);
        }
        let at = |units: &Integer| Rational::dyadic(units, bits);
        out.push(Around { re: at(&points[i].re), im: at(&points[i].im), radius: root_above(&radius) });
    }
    Some(out)
}

/// A short number that is not below one that is not negative.
fn rounded_up(x: &Rational, bits: u64) -> Rational {
    let exponent = x.numerator().bit_length() as i64 - x.denominator().bit_length() as i64;
    let shift = bits as i64 - exponent;
    let scale = Rational::from(2).pow(shift).expect("two is not zero");
    Rational::from((x * &scale).ceil()) * Rational::from(2).pow(-shift).expect("two is not zero")
}

/// A number not below the square root, and not far above.
fn root_above(x: &Rational) -> Rational {
    if x.is_zero() {
        return Rational::ZERO;
    }
    let exponent = x.numerator().bit_length() as i64 - x.denominator().bit_length() as i64;
    // An even power of two makes some digits before the point.
    let shift = (64 - exponent / 2).max(0) as u64;
    let scaled = (x * &Rational::from(&Integer::ONE << (2 * shift))).ceil();
    Rational::dyadic(&(scaled.sqrt_floor() + Integer::ONE), shift)
}

/// Discs that are apart: those that touch are one, and one that touches the real axis is made symmetric to it.
fn parted(discs: Vec<Around>) -> Vec<RootDisc> {
    let one = |Around { re, im, radius, .. }| RootDisc { re, im, radius, count: 1, is_one: true, is_pair: false };
    let mut parts: Vec<RootDisc> = discs.into_iter().map(|disc| one(disc).symmetric()).collect();
    // Joined discs may reach others.
    loop {
        let pair =
            (0..parts.len()).find_map(|i| (i + 1..parts.len()).find(|j| parts[i].touches(&parts[*j])).map(|j| (i, j)));
        let Some((i, j)) = pair else { break };
        let other = parts.swap_remove(j);
        let joined = parts[i].joined(&other).symmetric();
        parts[i] = joined;
    }
    // What is below the axis is the image of what is above.
    let mut out: Vec<RootDisc> = parts.into_iter().filter(|disc| !disc.im.is_negative()).collect();
    for disc in &mut out {
        disc.is_pair = !disc.im.is_zero();
    }
    out
}

impl RootDisc {
    /// The smallest disc about a real centre that holds it, where it touches the real axis.
    fn symmetric(self) -> RootDisc {
        if self.im.abs() > self.radius {
            return self;
        }
        let radius = &self.radius + &self.im.abs();
        RootDisc { im: Rational::ZERO, radius, ..self }
    }

    fn touches(&self, other: &RootDisc) -> bool {
        let (x, y) = (&self.re - &other.re, &self.im - &other.im);
        let reach = &self.radius + &other.radius;
        &x * &x + &y * &y <= &reach * &reach
    }

    /// A disc that holds both.
    fn joined(&self, other: &RootDisc) -> RootDisc {
        let (re, im) = (self.re.midpoint(&other.re), self.im.midpoint(&other.im));
        // The distance between centres is not more than the sum of those along the axes.
        let apart = (&self.re - &other.re).abs() + (&self.im - &other.im).abs();
        let radius = apart + self.radius.clone().max(other.radius.clone());
        RootDisc { re, im, radius, count: self.count + other.count, is_one: false, is_pair: false }
    }
}
