//! All complex roots of an exact polynomial, for pictures.

use super::fixed::Fixed;
use jurist_algebra::limits::{Precisions, until_shown};
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{Domain, UniPoly};
use nalgebra::Complex;

/// Bits after the point in the first attempt, and in the last.
const PRECISIONS: Precisions = Precisions::new(128, 4096);

/// A root is good enough when its disc is smaller than `2^-46` of it (or of 1): far below a pixel,
/// also in an inset magnified ten thousand times.
const GOOD_ENOUGH: f64 = 1.0 / (1u64 << 46) as f64;

/// A root in floating point: a picture's coordinate, not evidence.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ApproximateRoot {
    /// Where it is, to `radius`.
    pub value: Complex<f64>,
    /// A disc of this radius around `value` holds a root, up to the rounding of the final `f64`.
    pub radius: f64,
    /// Exact multiplicity.
    pub multiplicity: usize,
}

/// All complex roots of `p`, by real and then imaginary part; none for a constant.
///
/// Multiplicities are exact (square-free decomposition); the simple roots of each factor come from
/// Aberth's iteration [Aberth1973](jurist_algebra::bibliography#aberth1973), started at the radii of the Newton polygon [Bini1996](jurist_algebra::bibliography#bini1996), first in
/// floating point and then in fixed point with as many bits as it takes, so that a cluster such as four roots within 1e-3 of z = 1
/// is resolved. Real roots that are told from all others have imaginary part exactly 0. O(d^2) products per sweep.
///
/// ```
/// use jurist_algebra::poly::UniPoly;
/// let p = UniPoly::from_i64(&[-1, 3, -3, 1]); // (z - 1)^3
/// let roots = jurist_draw::simulate::roots(&p);
/// assert_eq!((roots[0].value.re, roots[0].value.im, roots[0].multiplicity), (1.0, 0.0, 3));
/// ```
pub fn roots(p: &UniPoly) -> Vec<ApproximateRoot> {
    let zeros = p.coeffs().iter().take_while(|c| c.is_zero()).count();
    let rest = UniPoly::new(p.coeffs()[zeros..].to_vec());
    let mut found = Vec::new();
    if rest.is_zero() {
        return found;
    }
    if zeros > 0 {
        found.push(ApproximateRoot { value: Complex::new(0.0, 0.0), radius: 0.0, multiplicity: zeros });
    }
    for (factor, multiplicity) in rest.square_free_decomposition() {
        for (value, radius) in simple_roots(&factor) {
            found.push(ApproximateRoot { value, radius, multiplicity });
        }
    }
    found.sort_by(|a, b| a.value.re.total_cmp(&b.value.re).then(a.value.im.total_cmp(&b.value.im)));
    found
}

/// The roots of a square-free polynomial with the radii of their discs.
fn simple_roots(p: &UniPoly) -> Vec<(Complex<f64>, f64)> {
    let Some(degree) = p.degree().filter(|d| *d > 0) else { return Vec::new() };
    if degree == 1 {
        let root = Rational::new(-p.coeff(0), p.coeff(1));
        return vec![(Complex::new(root.to_f64_approximate(), 0.0), 0.0)];
    }
    let start = starting_points(p);
    let start = in_floating_point(p, &start).unwrap_or(start);
    let mut roots: Vec<Fixed> = start.into_iter().map(|z| Fixed::from_f64(z, PRECISIONS.first)).collect();
    until_shown(PRECISIONS.first, |bits| {
        iterate(p, &mut roots, bits);
        let discs: Vec<(Complex<f64>, f64)> = roots.iter().map(|z| (z.to_f64(bits), radius(p, z, bits))).collect();
        let good = |(z, r): &(Complex<f64>, f64)| *r <= GOOD_ENOUGH * z.norm().max(1.0);
        if discs.iter().all(good) || bits >= PRECISIONS.last {
            return Some(with_real_roots_real(discs));
        }
        roots = roots.iter().map(|z| z.widened(bits)).collect();
        None
    })
}

/// Sweeps of Aberth's correction until every root stands still.
fn iterate(p: &UniPoly, roots: &mut [Fixed], bits: u64) {
    let one = Fixed::one(bits);
    let mut settled = vec![false; roots.len()];
    // A correction below 2^-(bits / 2) is followed by one below 2^-bits: the method is cubic.
    let still = bits / 2;
    for _ in 0..150 {
        for i in 0..roots.len() {
            if settled[i] {
                continue;
            }
            let (value, slope) = evaluate(p, &roots[i], bits);
            if value.is_zero() {
                settled[i] = true;
                continue;
            }
            let Some(newton) = value.over(&slope, bits) else {
                // A critical point: any step away from it will do.
                roots[i].im += &Integer::ONE << (bits - 20);
                continue;
            };
            let sum = repulsion(roots, i, bits);
            let factor = one.minus(&newton.times(&sum, bits));
            let correction = newton.over(&factor, bits).unwrap_or(newton);
            settled[i] = correction.size() <= still;
            roots[i] = roots[i].minus(&correction);
        }
        if settled.iter().all(|s| *s) {
            break;
        }
    }
}

/// The sum of `1 / (z_i - z_j)`. It only makes the method converge fast: its rounding moves no root.
fn repulsion(roots: &[Fixed], i: usize, bits: u64) -> Fixed {
    let others = || (0..roots.len()).filter(|&j| j != i).map(|j| roots[i].minus(&roots[j])).filter(|d| !d.is_zero());
    let rounded: Complex<f64> = others().map(|d| d.to_f64(bits).inv()).sum();
    if rounded.is_finite() {
        return Fixed::from_f64(rounded, bits);
    }
    let one = Fixed::one(bits);
    others().filter_map(|d| one.over(&d, bits)).fold(Fixed::zero(), |sum, term| sum.plus(&term))
}

/// The same iteration in floating point, for points nearer to the roots; `None` where numbers become too large or too small, or two points
/// the same.
fn in_floating_point(p: &UniPoly, start: &[Complex<f64>]) -> Option<Vec<Complex<f64>>> {
    let largest = p.coeffs().iter().map(Integer::bit_length).max().unwrap_or(0);
    let coefficients: Vec<f64> = p.coeffs().iter().map(|c| Rational::dyadic(c, largest).to_f64_approximate()).collect();
    if p.coeffs().iter().zip(&coefficients).any(|(c, rounded)| !c.is_zero() && !rounded.is_normal()) {
        return None;
    }
    let mut z = start.to_vec();
    for _ in 0..60 {
        let mut farthest = 0.0f64;
        for i in 0..z.len() {
            let (mut value, mut slope) = (Complex::<f64>::ZERO, Complex::<f64>::ZERO);
            for c in coefficients.iter().rev() {
                slope = slope * z[i] + value;
                value = value * z[i] + c;
            }
            let newton = value / slope;
            let sum: Complex<f64> = (0..z.len()).filter(|&j| j != i).map(|j| (z[i] - z[j]).inv()).sum();
            let correction: Complex<f64> = newton / (Complex::<f64>::ONE - newton * sum);
            if !correction.is_finite() {
                return None;
            }
            z[i] -= correction;
            farthest = farthest.max(correction.norm() / z[i].norm());
        }
        if farthest < 1e-12 {
            break;
        }
    }
    let apart = (1..z.len()).all(|i| (0..i).all(|j| z[i] != z[j]));
    (apart && z.iter().all(|z| z.is_finite())).then_some(z)
}

/// The polynomial and its derivative at `z`, by Horner's rule.
fn evaluate(p: &UniPoly, z: &Fixed, bits: u64) -> (Fixed, Fixed) {
    let (mut value, mut slope) = (Fixed::zero(), Fixed::zero());
    for c in p.coeffs().iter().rev() {
        slope = slope.times(z, bits).plus(&value);
        value = value.times(z, bits);
        value.re += c << bits;
    }
    (value, slope)
}

/// Radius of a disc around `z` that holds a root: `d |p / p'|`, with the rounding of `p` added.
fn radius(p: &UniPoly, z: &Fixed, bits: u64) -> f64 {
    let degree = p.degree().unwrap_or(0) as f64;
    let (value, slope) = evaluate(p, z, bits);
    let size = z.to_f64(bits).norm().max(1.0);
    // Each Horner step rounds by less than 2 units and hands the sum on, times |z|.
    let rounding = degree * (degree.log2() + degree * size.log2() + 1.0 - bits as f64).exp2();
    let slope = slope.to_f64(bits).norm();
    if slope > 0.0 { (degree * value.to_f64(bits).norm() + rounding) / slope } else { f64::INFINITY }
}

/// Roots whose disc meets the real axis, and no disc but its own there, are real.
fn with_real_roots_real(mut discs: Vec<(Complex<f64>, f64)>) -> Vec<(Complex<f64>, f64)> {
    for i in 0..discs.len() {
        let (z, r) = discs[i];
        let reach = r + f64::EPSILON * z.norm();
        let partner = |(j, (w, s)): (usize, &(Complex<f64>, f64))| {
            j != i && (w - z.conj()).norm() <= reach + s + f64::EPSILON * z.norm()
        };
        if z.im.abs() <= reach && !discs.iter().enumerate().any(partner) {
            discs[i].0.im = 0.0;
        }
    }
    discs
}

/// Points on the circles whose radii the Newton polygon gives, none of them real.
fn starting_points(p: &UniPoly) -> Vec<Complex<f64>> {
    let logs: Vec<Option<f64>> = p.coeffs().iter().map(log2_magnitude).collect();
    let mut hull: Vec<(usize, f64)> = Vec::new();
    for (k, log) in logs.iter().enumerate().filter_map(|(k, l)| l.map(|l| (k, l))) {
        while let [.., (i, a), (j, b)] = hull[..] {
            if (b - a) * (k - i) as f64 <= (log - a) * (j - i) as f64 {
                hull.pop();
            } else {
                break;
            }
        }
        hull.push((k, log));
    }
    let mut points = Vec::new();
    for pair in hull.windows(2) {
        let ((i, a), (j, b)) = (pair[0], pair[1]);
        let count = j - i;
        let radius = ((a - b) / count as f64).clamp(-1000.0, 1000.0).exp2();
        for m in 0..count {
            let angle = std::f64::consts::TAU * m as f64 / count as f64 + 0.7 + 0.31 * i as f64;
            points.push(Complex::from_polar(radius, angle));
        }
    }
    points
}

/// `log2 |c|`; `None` for 0.
fn log2_magnitude(c: &Integer) -> Option<f64> {
    let length = c.bit_length();
    let drop = length.saturating_sub(60);
    (length > 0).then(|| (&c.abs() >> drop).to_f64_approximate().log2() + drop as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn product(roots: &[i64]) -> UniPoly {
        roots.iter().fold(UniPoly::from_i64(&[1]), |p, r| &p * &UniPoly::from_i64(&[-r, 1]))
    }

    #[test]
    fn constants_have_no_roots_and_powers_of_z_only_zero() {
        assert!(roots(&UniPoly::from_i64(&[])).is_empty());
        assert!(roots(&UniPoly::from_i64(&[7])).is_empty());
        let zero = roots(&UniPoly::from_i64(&[0, 0, 5]));
        assert_eq!((zero.len(), zero[0].multiplicity, zero[0].value.norm()), (1, 2, 0.0));
    }

    #[test]
    fn wilkinsons_twenty_roots_are_integers() {
        let found = roots(&product(&(1..=20).collect::<Vec<_>>()));
        for (root, expected) in found.iter().zip(1..) {
            assert!((root.value.re - f64::from(expected)).abs() < 1e-12 && root.value.im == 0.0);
        }
    }

    #[test]
    fn a_tight_cluster_is_resolved() {
        // (10^10 z - 10^10 - k) for k = -1, 0, 1, 2: four roots within 3e-10.
        let scale = 10_000_000_000i64;
        let p =
            [-1, 0, 1, 2].iter().fold(UniPoly::from_i64(&[1]), |p, k| &p * &UniPoly::from_i64(&[-(scale + k), scale]));
        let found = roots(&p);
        for (root, k) in found.iter().zip([-1.0, 0.0, 1.0, 2.0]) {
            assert!(((root.value.re - 1.0) * 1e10 - k).abs() < 1e-4, "{root:?}");
            assert_eq!(root.value.im, 0.0);
        }
    }

    #[test]
    fn magnitudes_far_apart_are_found() {
        // (z - 10^15)(10^12 z - 1)(z^2 + 1)
        let p = &(&UniPoly::from_i64(&[-1_000_000_000_000_000, 1]) * &UniPoly::from_i64(&[-1, 1_000_000_000_000]))
            * &UniPoly::from_i64(&[1, 0, 1]);
        let found = roots(&p);
        assert!(found.iter().any(|r| (r.value.re / 1e15 - 1.0).abs() < 1e-14));
        assert!(found.iter().any(|r| (r.value.re - 1e-12).abs() < 1e-16 && r.value.im == 0.0));
        assert!(found.iter().filter(|r| (r.value.im.abs() - 1.0).abs() < 1e-14).count() == 2);
    }

    /// `z^40 - 2 (1000 z - 1)^4`, after Mignotte: four roots within `10^-32` of each other, which the first precision does not tell apart.
    #[test]
    fn discs_of_roots_that_are_almost_one_are_small() {
        let mut c = vec![-2, 8000, -12_000_000, 8_000_000_000, -2_000_000_000_000];
        c.resize(40, 0);
        c.push(1);
        let found = roots(&UniPoly::from_i64(&c));
        assert_eq!(found.len(), 40);
        assert!(found.iter().all(|r| r.radius <= GOOD_ENOUGH * r.value.norm().max(1.0)), "{found:?}");
        assert_eq!(found.iter().filter(|r| (r.value - 0.001).norm() < 1e-12).count(), 4);
    }

    #[test]
    fn a_disc_holds_a_root_however_bad_its_middle() {
        let p = UniPoly::from_i64(&[-1, 0, 0, 0, 1]);
        for (re, im) in [(10.0, 0.0), (0.5, 0.5), (-3.0, 4.0), (0.0, 0.1), (1.1, -0.2)] {
            let z = Complex::new(re, im);
            let near = [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)];
            let distance = near.iter().map(|(x, y)| (z - Complex::new(*x, *y)).norm()).fold(f64::INFINITY, f64::min);
            assert!(radius(&p, &Fixed::from_f64(z, 60), 60) >= distance, "{z}");
        }
        // No root is known to be near a critical point.
        assert_eq!(radius(&p, &Fixed::zero(), 60), f64::INFINITY);
        // With one bit 3/2 seems to be a root of 2.
        let two = UniPoly::from_i64(&[-2, 0, 1]);
        let z = Fixed::from_f64(Complex::new(1.5, 0.0), 1);
        assert!(evaluate(&two, &z, 1).0.is_zero() && radius(&two, &z, 1) > 1.5 - 2f64.sqrt());
    }

    #[test]
    fn a_pair_beside_the_real_axis_is_no_real_root() {
        // (10^17 (z - 1))^2 + 1
        let n = Integer::from(10_i64.pow(17));
        let square = &n * &n;
        let p = UniPoly::new(vec![&square + &Integer::ONE, -(&square << 1), square]);
        let found = roots(&p);
        assert!(found.iter().all(|r| (r.value.im.abs() * 1e17 - 1.0).abs() < 1e-6), "{found:?}");
        // Of discs that may be each other's mirror images, neither is real; one alone is.
        let disc = |im: f64, r: f64| (Complex::new(1.0, im), r);
        let both = vec![disc(1e-10, 1e-9), disc(-2e-10, 1e-9)];
        assert_eq!(with_real_roots_real(both.clone()), both);
        assert_eq!(with_real_roots_real(vec![both[0]])[0].0.im, 0.0);
        assert_eq!(with_real_roots_real(vec![disc(1e-8, 1e-9)])[0].0.im, 1e-8);
    }

    #[test]
    fn a_critical_point_is_left() {
        let bits = 80;
        let mut found = [Complex::new(0.0, 0.0), Complex::new(0.5, 3.0)].map(|z| Fixed::from_f64(z, bits));
        iterate(&UniPoly::from_i64(&[-1, 0, 1]), &mut found, bits);
        let mut found = found.map(|z| z.to_f64(bits).re);
        found.sort_by(f64::total_cmp);
        assert!((found[0] + 1.0).abs() < 1e-15 && (found[1] - 1.0).abs() < 1e-15, "{found:?}");
    }

    #[test]
    fn magnitudes_beyond_floating_point_are_found() {
        // (2^1200 z - 1)(z - 3)
        let large = &Integer::ONE << 1200;
        let p = &UniPoly::new(vec![-Integer::ONE, large]) * &UniPoly::from_i64(&[-3, 1]);
        let found = roots(&p);
        assert!(found.iter().any(|r| r.value.norm() < 1e-15) && found.iter().any(|r| (r.value.re - 3.0).abs() < 1e-14));
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(48))]
        #[test]
        fn known_integer_roots_come_back(mut known in proptest::collection::vec(-6i64..7, 1..7)) {
            known.sort_unstable();
            let p = product(&known);
            let found = roots(&p);
            let mut list = Vec::new();
            for root in &found {
                prop_assert_eq!(root.value.im, 0.0);
                list.extend(std::iter::repeat_n(root.value.re.round() as i64, root.multiplicity));
                prop_assert!((root.value.re - root.value.re.round()).abs() < 1e-12);
            }
            prop_assert_eq!(list, known);
        }

        #[test]
        fn sum_and_product_follow_from_the_coefficients(c in proptest::collection::vec(-50i64..50, 2..9)) {
            let p = UniPoly::from_i64(&c);
            let Some(d) = p.degree() else { return Ok(()) };
            let found = roots(&p);
            prop_assert_eq!(found.iter().map(|r| r.multiplicity).sum::<usize>(), d);
            let lead = p.coeff(d).to_f64_approximate();
            let sum: Complex<f64> = found.iter().map(|r| r.value * r.multiplicity as f64).sum();
            let all: Complex<f64> = found.iter().map(|r| r.value.powu(r.multiplicity as u32)).product();
            if d > 0 {
                let (s, q) = (-p.coeff(d - 1).to_f64_approximate() / lead, p.coeff(0).to_f64_approximate() / lead);
                let q = if d % 2 == 0 { q } else { -q };
                prop_assert!((sum - s).norm() < 1e-9 * (1.0 + s.abs()), "{} {}", sum, s);
                prop_assert!((all - q).norm() < 1e-9 * (1.0 + q.abs()), "{} {}", all, q);
            }
        }
    }
}
