//! Laws of matrices, determinants and characteristic polynomials.

use crate::helpers::budget::spent;
use jurist_algebra::limits::Budget;
use jurist_algebra::matrix::strategies::{
    from_roots, integer_matrix, integer_matrix_of_size, polynomial_matrix, unimodular, with_eigenvalues,
};
use jurist_algebra::matrix::{
    CharacteristicPolynomial, PolyMatrix, RationalMatrix, characteristic_over_denominator, determinant_bareiss,
    determinant_leibniz, faddeev_leverrier,
};
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{Domain, MultiPoly, Poly, RationalFunction, UniPoly};
use proptest::prelude::*;

fn charpoly<R: Domain>(m: &PolyMatrix<R>) -> Poly<R> {
    faddeev_leverrier(m, &Budget::unlimited()).unwrap().characteristic
}

/// `det(zI - M)` as a determinant over the polynomials in `z`.
fn charpoly_bareiss<R: Domain>(m: &PolyMatrix<R>) -> Poly<R> {
    determinant_bareiss(&m.characteristic_matrix(), &Budget::unlimited()).unwrap()
}

/// `p(M)` by Horner's rule.
fn at_matrix<R: Domain>(p: &Poly<R>, m: &PolyMatrix<R>) -> PolyMatrix<R> {
    p.coeffs()
        .iter()
        .rev()
        .fold(PolyMatrix::zeros(m.rows(), m.rows()), |acc, c| &(m * &acc) + &PolyMatrix::scalar(m.rows(), c))
}

/// `(zI - M) adj = det I`, checked as matrices of polynomials in `z`.
fn adjugate_is_right<R: Domain>(m: &PolyMatrix<R>) -> bool {
    let n = m.rows();
    let fl = faddeev_leverrier(m, &Budget::unlimited()).unwrap();
    let adjugate = PolyMatrix::from_fn(n, n, |i, j| fl.adjugate_entry(i, j));
    &m.characteristic_matrix() * &adjugate == PolyMatrix::scalar(n, &fl.characteristic)
}

/// The drive's closed loop `A - B K C`, variables `K_pwm` (0) and `T` (1).
fn drive() -> RationalMatrix {
    let q = |a: i64, b: i64| RationalFunction::from(Rational::new(a.into(), b.into()));
    let (k, t) = (RationalFunction::variable(0), RationalFunction::variable(1));
    let (r_a, l_a, j, b_v, k_a, e_sw) = (q(1, 1), q(46, 1000), q(93, 1000), q(8, 1000), q(55, 100), q(12, 1));
    let (k_pi, k_ii, k_ps, k_is, k_1, k_2) = (q(10, 1), q(500, 1), q(1, 1), q(5, 1), q(1, 1), q(1, 1));
    let (zero, one) = (RationalFunction::zero(), RationalFunction::one());
    let half_t = t.checked_div(&q(2, 1)).unwrap();
    let over = |a: &RationalFunction, b: &RationalFunction| a.checked_div(b).unwrap();
    let row = |entries: [&RationalFunction; 6]| entries.into_iter().cloned().collect::<Vec<_>>();
    let a = RationalMatrix::from_rows(vec![
        row([&over(&(&l_a - &(&r_a * &t)), &l_a), &over(&-(&k_a * &t), &l_a), &zero, &zero, &zero, &zero]),
        row([&over(&(&k_a * &t), &j), &over(&(&j - &(&b_v * &t)), &j), &zero, &zero, &zero, &zero]),
        row([&-&k_1, &zero, &zero, &zero, &zero, &zero]),
        row([&-(&k_1 * &half_t), &zero, &half_t, &one, &zero, &zero]),
        row([&zero, &-&k_2, &zero, &zero, &zero, &zero]),
        row([&zero, &-(&k_2 * &half_t), &zero, &zero, &half_t, &one]),
    ])
    .unwrap();
    let mut b = RationalMatrix::zeros(6, 2);
    b[(0, 1)] = over(&(&k * &t), &(&l_a * &e_sw));
    b[(2, 0)] = one.clone();
    b[(3, 0)] = half_t.clone();
    let c = RationalMatrix::from_fn(4, 6, |i, j| if j == i + 2 { one.clone() } else { zero.clone() });
    let gain = RationalMatrix::from_rows(vec![
        vec![zero.clone(), zero.clone(), -&k_ps, -&k_is],
        vec![-&k_pi, -&k_ii, zero.clone(), zero],
    ])
    .unwrap();
    &a - &(&(&b * &gain) * &c)
}

/// A polynomial in `K` and `T` from terms `(power of K, power of T, p, q)` with coefficient `p/q`.
fn published(terms: &[(u32, u32, i64, i64)]) -> RationalFunction {
    terms.iter().fold(RationalFunction::zero(), |sum, &(k, t, p, q)| {
        let monomial = RationalFunction::from(MultiPoly::from_terms([(vec![k, t], Integer::ONE)]));
        &sum + &(&monomial * &RationalFunction::from(Rational::new(p.into(), q.into())))
    })
}

#[test]
fn the_drive_has_its_known_characteristic_polynomial() {
    let p = drive().characteristic_polynomial(vec!["K_pwm".into(), "T".into()], &Budget::unlimited()).unwrap();
    let expected = [
        published(&[(1, 4, 42968750, 6417), (1, 3, -18906250, 6417), (1, 2, 687500, 6417)]),
        published(&[(1, 4, 85937500, 6417), (1, 3, -250000, 6417), (1, 2, 1541250, 6417), (1, 1, -116250, 6417)]),
        published(&[
            (1, 4, 42968750, 6417),
            (1, 3, 18906250, 6417),
            (1, 2, -248750, 713),
            (0, 2, 2250, 31),
            (1, 1, 1250, 23),
            (0, 1, -46684, 2139),
            (0, 0, 1, 1),
        ]),
        published(&[
            (1, 3, 250000, 6417),
            (1, 2, -2896250, 6417),
            (0, 2, -4500, 31),
            (1, 1, -1250, 23),
            (0, 1, 46684, 713),
            (0, 0, -4, 1),
        ]),
        published(&[(1, 2, 31250, 69), (0, 2, 2250, 31), (1, 1, 1250, 69), (0, 1, -46684, 713), (0, 0, 6, 1)]),
        published(&[(0, 1, 46684, 2139), (0, 0, -4, 1)]),
        RationalFunction::one(),
    ];
    assert_eq!(p.coefficients, expected);
    assert_eq!((p.formal_degree, p.monic, p.poles.len()), (6, true, 0));
    let (numerator, denominator) = p.cleared();
    assert_eq!(denominator.as_constant(), Some(Integer::from(6417)));
    assert_eq!(numerator.leading().unwrap().as_constant(), Some(Integer::from(6417)));

    // Setting T first gives the same as setting it last.
    let t = Rational::new(1.into(), 10000.into());
    let at_t = drive().map(|e| e.substitute(1, &t).unwrap());
    let direct = at_t.characteristic_polynomial(vec!["K_pwm".into()], &Budget::unlimited()).unwrap();
    assert_eq!(p.substitute(1, &t).unwrap().coefficients, direct.coefficients);
    assert_eq!(p.substitute(1, &t).unwrap().variables, ["K_pwm"]);
    assert!(direct.univariate().is_some() && p.univariate().is_none());
    for (i, x) in [(1, t), (0, Rational::from(110)), (0, Rational::ZERO)] {
        let (slow, slow_denominator) = p.substitute(i, &x).unwrap().univariate().unwrap();
        let (fast, fast_denominator) = p.on_line(i, &x).unwrap();
        let scaled = |p: &Poly<UniPoly>, d: &UniPoly| p.map(|c| c * d);
        assert_eq!(scaled(&slow, &fast_denominator), scaled(&fast, &slow_denominator));
    }

    // The same through the adjugate, and against an elimination.
    let cleared = drive().cleared();
    assert!(adjugate_is_right(&cleared.numerators));
    assert_eq!(charpoly(&cleared.numerators), charpoly_bareiss(&cleared.numerators));
}

#[test]
fn sizes_zero_and_one_and_special_matrices() {
    let none = PolyMatrix::<Integer>::identity(0);
    let fl = faddeev_leverrier(&none, &Budget::unlimited()).unwrap();
    assert_eq!((fl.characteristic, fl.adjugate.len()), (UniPoly::one(), 0));
    assert_eq!(determinant_bareiss(&none, &Budget::unlimited()), Ok(Integer::ONE));
    assert_eq!(determinant_leibniz(&none), Integer::ONE);
    assert_eq!(charpoly(&PolyMatrix::from_i64(&[&[7]])), UniPoly::from_i64(&[-7, 1]));
    for n in 1..7 {
        let z = UniPoly::x();
        let mut nilpotent = PolyMatrix::zeros(n, n);
        for i in 1..n {
            nilpotent[(i - 1, i)] = Integer::from(3);
        }
        assert_eq!(charpoly(&PolyMatrix::<Integer>::zeros(n, n)), z.power(n as u64));
        assert_eq!(charpoly(&nilpotent), z.power(n as u64));
        assert_eq!(charpoly(&PolyMatrix::identity(n)), UniPoly::from_i64(&[-1, 1]).power(n as u64));
        assert!(adjugate_is_right(&nilpotent) && adjugate_is_right(&PolyMatrix::<Integer>::zeros(n, n)));
    }
}

#[test]
fn a_spent_budget_is_reported() {
    let budget = spent();
    let m = PolyMatrix::from_i64(&[&[1, 2], &[3, 4]]);
    assert!(faddeev_leverrier(&m, &budget).is_err() && determinant_bareiss(&m, &budget).is_err());
}

/// `K/K` is 1, but the entry `1/K` keeps its pole although it cancels from the polynomial.
#[test]
fn poles_that_cancel_are_kept() {
    let k = RationalFunction::variable(0);
    let zero = RationalFunction::zero();
    // Triangular: the eigenvalues are 1/2 and K, the pole 1/K stands above the diagonal.
    let half = RationalFunction::from(Rational::new(1.into(), 2.into()));
    let m = RationalMatrix::from_rows(vec![vec![half, k.recip().unwrap()], vec![zero, k]]).unwrap();
    let p = m.characteristic_polynomial(vec!["K".into()], &Budget::unlimited()).unwrap();
    assert!(p.coefficients.iter().all(RationalFunction::is_polynomial));
    assert_eq!(p.poles, [MultiPoly::variable(0)]);
    assert_eq!(p.at(&[Rational::ZERO]), None);
    assert_eq!(p.substitute(0, &Rational::ZERO), None);
    assert_eq!(
        p.at(&[Rational::from(2)]).unwrap(),
        [Rational::from(1), Rational::new((-5).into(), 2.into()), Rational::ONE]
    );
}

#[test]
fn substituting_a_middle_variable_moves_the_later_ones_down() {
    let p = CharacteristicPolynomial {
        variables: vec!["a".into(), "b".into(), "c".into()],
        coefficients: vec![
            RationalFunction::new(MultiPoly::variable(2), MultiPoly::variable(1)).unwrap(),
            RationalFunction::variable(0),
        ],
        formal_degree: 1,
        poles: vec![MultiPoly::variable(1)],
        monic: false,
    };
    let q = p.substitute(1, &Rational::from(3)).unwrap();
    assert_eq!(q.variables, ["a", "c"]);
    assert_eq!(q.coefficients[0].display(&q.variables).to_string(), "c/3");
    assert_eq!(q.poles, [MultiPoly::from(3)]);
}

fn small_integers(n: usize) -> impl Strategy<Value = Vec<Integer>> {
    prop::collection::vec((-5i64..=5).prop_map(Integer::from), n)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn faddeev_leverrier_is_the_determinant(m in integer_matrix(6, 20)) {
        prop_assert_eq!(charpoly(&m), charpoly_bareiss(&m));
        prop_assert!(adjugate_is_right(&m));
    }

    #[test]
    fn cayley_and_hamilton(m in integer_matrix(6, 1000)) {
        prop_assert!(at_matrix(&charpoly(&m), &m).is_zero());
    }

    #[test]
    fn determinants_agree(m in integer_matrix(5, 4)) {
        let det = determinant_bareiss(&m, &Budget::unlimited()).unwrap();
        prop_assert_eq!(&det, &determinant_leibniz(&m));
        let constant = charpoly(&m).coeff(0);
        prop_assert_eq!(if m.rows() % 2 == 1 { -constant } else { constant }, det);
    }

    #[test]
    fn traces_are_newtons(m in integer_matrix_of_size(4, 30)) {
        let fl = faddeev_leverrier(&m, &Budget::unlimited()).unwrap();
        prop_assert_eq!(fl.characteristic.coeff(3), -m.trace());
        // trace adj(zI - M) is the derivative.
        let traces = UniPoly::new(fl.adjugate.iter().rev().map(PolyMatrix::trace).collect());
        prop_assert_eq!(traces, fl.characteristic.derivative());
    }

    #[test]
    fn known_eigenvalues((m, roots) in (0usize..6).prop_flat_map(small_integers).prop_flat_map(with_eigenvalues)) {
        prop_assert_eq!(charpoly(&m), from_roots(&roots));
    }

    #[test]
    fn companions_have_their_polynomial(c in (0usize..8).prop_flat_map(small_integers)) {
        let m = PolyMatrix::companion(&c);
        let mut coefficients = c;
        coefficients.push(Integer::ONE);
        prop_assert_eq!(charpoly(&m), UniPoly::new(coefficients));
    }

    #[test]
    fn block_triangular_is_the_product(
        a in integer_matrix(3, 9), d in integer_matrix(3, 9), fill in -9i64..=9
    ) {
        let b = PolyMatrix::from_fn(a.rows(), d.rows(), |i, j| Integer::from(fill * (i as i64 - j as i64)));
        let m = PolyMatrix::blocks(&a, &b, &PolyMatrix::zeros(d.rows(), a.rows()), &d);
        prop_assert_eq!(charpoly(&m), charpoly(&a).times(&charpoly(&d)));
        prop_assert_eq!(m.block(0..a.rows(), a.rows()..m.rows()), b);
    }

    #[test]
    fn similar_and_transposed_matrices(
        (m, (u, inverse)) in (0usize..5).prop_flat_map(|n| (integer_matrix_of_size(n, 9), unimodular(n)))
    ) {
        prop_assert_eq!(&u * &inverse, PolyMatrix::identity(m.rows()));
        prop_assert_eq!(charpoly(&(&(&u * &m) * &inverse)), charpoly(&m));
        prop_assert_eq!(charpoly(&m.transposed()), charpoly(&m));
    }

    #[test]
    fn products_commute_in_the_characteristic_polynomial(
        (a, b) in (1usize..5).prop_flat_map(|n| (integer_matrix_of_size(n, 9), integer_matrix_of_size(n, 9)))
    ) {
        prop_assert_eq!(charpoly(&(&a * &b)), charpoly(&(&b * &a)));
        let det = |m: &PolyMatrix<Integer>| determinant_bareiss(m, &Budget::unlimited()).unwrap();
        prop_assert_eq!(det(&(&a * &b)), &det(&a) * &det(&b));
    }

    #[test]
    fn a_common_denominator_scales(m in integer_matrix(4, 9), q in 1i64..=7) {
        let q = Integer::from(q);
        let over_q = characteristic_over_denominator(&charpoly(&m), &q);
        let expected = m.map(|e| Rational::new(e.clone(), q.clone()));
        let expected = charpoly(&expected).scaled(&Rational::from(q.pow(m.rows() as u64)));
        prop_assert_eq!(over_q.map(|c| Rational::from(c)), expected);
    }

    #[test]
    fn symbolic_matrices(m in polynomial_matrix(3, 2, 2, 2)) {
        prop_assert_eq!(charpoly(&m), charpoly_bareiss(&m));
        prop_assert!(adjugate_is_right(&m));
        // Setting the variables first or last is the same.
        let point = [Rational::new(2.into(), 3.into()), Rational::from(-5)];
        let at = |p: &MultiPoly| p.eval(&point);
        prop_assert_eq!(charpoly(&m).map(at), charpoly(&m.map(at)));
    }

    #[test]
    fn symbolic_eigenvalues(
        (m, roots) in prop::collection::vec(jurist_algebra::poly::multivariate::strategies::multi_poly(2, 1, 2), 0..4)
            .prop_flat_map(with_eigenvalues)
    ) {
        prop_assert_eq!(charpoly(&m), from_roots(&roots));
    }
}
