"""Exact real numbers: order, hash, rounding, and other libraries' views of them."""

import math
import pickle
from decimal import Decimal
from fractions import Fraction

import flint
import jurist
import mpmath
import pytest
import sympy
from hypothesis import given, settings
from hypothesis import strategies as st
from jurist import Real

SQRT2 = Real.root((-2, 0, 1), 1, 2)
POLYNOMIALS = st.lists(st.integers(-50, 50), min_size=2, max_size=6).filter(lambda c: any(c[1:]))
FRACTIONS = st.fractions(-100, 100, max_denominator=1000)


def test_rational_numbers_are_equal_to_and_hash_as_fractions():
    assert Real("1/3") == Fraction(1, 3)
    assert hash(Real("1/3")) == hash(Fraction(1, 3))
    assert {Real(2), 2, Fraction(2), Decimal(2)} == {2}
    assert Real(0.5) == 0.5


def test_a_float_is_compared_as_the_binary_number_that_it_is():
    # As Fraction(1, 10) == 0.1 is false, too.
    assert Real("1/10") != 0.1
    assert Real("1/10") < 0.1
    assert math.sqrt(2) != SQRT2
    assert SQRT2 < math.inf
    assert not SQRT2 < math.nan
    assert not SQRT2 > math.nan


@settings(deadline=None, max_examples=40)
@given(POLYNOMIALS, POLYNOMIALS)
def test_order_and_equality_of_roots_are_those_of_flint(p, q):
    """Another library's isolation of complex roots is the oracle."""
    ours = Real.roots(p) + Real.roots(q)
    theirs = []
    for c in (p, q):
        poly = flint.fmpz_poly(c)
        roots = [r for r, _ in poly.complex_roots()] if poly.degree() > 0 else []
        theirs += sorted((r.real for r in roots if r.imag.contains(0) and r.imag.is_exact()), key=lambda r: float(r.mid()))
    assert len(ours) == len(theirs)
    for x, y in zip(ours, theirs, strict=True):
        assert abs(float(x) - float(y.mid())) <= 1e-9 * max(1, abs(float(x)))
    by_us = sorted(ours)
    assert [float(x) for x in by_us] == sorted(float(x) for x in ours)
    for x in ours:
        for y in ours:
            assert (x == y) == (not x < y and not y < x)
            if x == y:
                assert hash(x) == hash(y)


@settings(deadline=None, max_examples=40)
@given(POLYNOMIALS)
def test_floats_are_correctly_rounded(p):
    with mpmath.workprec(400):
        for x in Real.roots(p):
            lower, upper = x.enclosure(80)
            assert float(lower) <= float(x) <= float(upper)
            middle = (lower + upper) / 2
            near = float(x)
            for other in (math.nextafter(near, math.inf), math.nextafter(near, -math.inf)):
                assert abs(Fraction(near) - middle) <= abs(Fraction(other) - middle) + (upper - lower)


@settings(deadline=None, max_examples=60)
@given(FRACTIONS, FRACTIONS.filter(bool))
def test_arithmetic_with_rational_numbers(a, b):
    x = b * SQRT2 + a
    assert (x - a) / b == SQRT2
    assert (x - a) * (1 / b) == SQRT2
    assert abs(float(x) - (float(b) * math.sqrt(2) + float(a))) < 1e-10 * (abs(float(a)) + abs(float(b)) + 1)
    assert 1 / (1 / (SQRT2 * b)) == SQRT2 * b
    assert a - x == -(x - a)
    assert abs(-SQRT2) == SQRT2


def test_two_irrational_numbers_are_not_computed_with_and_the_message_says_what_to_do():
    with pytest.raises(TypeError, match="sympy"):
        SQRT2 + Real.root((-3, 0, 1), 1, 2)
    with pytest.raises(TypeError):
        SQRT2 + 0.1


def test_rounding_floor_and_formats():
    assert (math.floor(SQRT2), math.ceil(SQRT2), math.trunc(-SQRT2), int(SQRT2)) == (1, 2, -1, 1)
    assert (round(SQRT2), round(-SQRT2), round(SQRT2, 3)) == (1, -1, Fraction(1414, 1000))
    assert f"{SQRT2:.30f}" == "1.414213562373095048801688724210"
    assert f"{SQRT2:.3e}" == "1.414e+0"
    assert f"{SQRT2:>12.4g}" == "       1.414"
    assert f"{-SQRT2:.1f}" == "-1.4"
    assert f"{Real('1/3')}" == "0.333333333333"
    assert len(f"{SQRT2:.5000f}") == 5002
    with pytest.raises(ValueError, match="formatted"):
        format(SQRT2, "d")


def test_numbers_longer_than_python_converts_at_once():
    big = 10**6000 + 7
    assert Real(big).exact == big
    assert Real((10**5000 + 1) * Fraction(1, 3)).exact == Fraction(10**5000 + 1, 3)
    root = Real.root((-(10**10001) - 1, 0, 1), 0, 10**5001)
    assert root.polynomial == (-(10**10001) - 1, 0, 1)


def test_roots_that_are_not_there_and_roots_that_are_several():
    with pytest.raises(ValueError, match="no root"):
        Real.root((1, 0, 1), -10, 10)
    with pytest.raises(ValueError, match="several"):
        Real.root((-2, 0, 1), -2, 2)
    assert Real.root((-2, 1), 2, 2) == 2
    assert Real.root((-6, 1, 1), 2, 3) == 2


@pytest.mark.parametrize("x", [SQRT2, Real("-1/3"), Real.root((-1, -1, 0, 1), 1, 2), Real(10**50)], ids=str)
def test_pickles_and_reprs_give_the_same_number_again(x):
    assert pickle.loads(pickle.dumps(x)) == x
    assert eval(repr(x), {"Real": Real}) == x
    assert hash(pickle.loads(pickle.dumps(x))) == hash(x)


def test_the_same_number_in_sympy_mpmath_and_flint():
    x = Real.root((-1, -1, 0, 1), 1, 2)
    assert str(sympy.N(x.sympy(), 30)) == x.decimal(30)
    assert sympy.sympify(x) == x.sympy()
    with mpmath.workdps(50):
        assert mpmath.almosteq(mpmath.mpf(x) ** 3 - mpmath.mpf(x), 1, 1e-48)
    assert x.flint(60).contains(x.flint(90))
    assert float(Real.root((-2, 0, 1), -2, 0).sympy().evalf()) == float(-SQRT2)


def test_what_a_float_means_is_one_rule():
    import numpy as np

    assert jurist.exact(0.1) == Fraction(1, 10)
    assert jurist.exact(np.float64(0.1)) == Fraction(1, 10)
    assert jurist.exact(np.float32(0.1)) == Fraction(1, 10)
    assert jurist.exact(np.int64(7)) == 7
    assert jurist.exact(0.1, "binary") == Fraction(0.1)
    assert jurist.exact(sympy.Rational(1, 7)) == Fraction(1, 7)
    assert jurist.exact(sympy.Float(0.1)) == Fraction(1, 10)
    assert jurist.exact(Decimal("1e-4")) == Fraction(1, 10000)
    assert jurist.exact("1.5/0.3") == 5
    for wrong in (True, None, [1], 1j):
        with pytest.raises(TypeError):
            jurist.exact(wrong)
    for wrong in (math.nan, math.inf, "one", "1/0"):
        with pytest.raises(ValueError):
            jurist.exact(wrong)
    with pytest.raises(TypeError):
        jurist.exact(0.1, "refuse")
    with pytest.raises(ValueError, match="irrational"):
        jurist.exact(SQRT2)


@settings(deadline=None)
@given(st.floats(allow_nan=False, allow_infinity=False))
def test_the_shortest_decimal_is_reversible(x):
    assert float(jurist.exact(x)) == x
