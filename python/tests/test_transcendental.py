"""Ends that are no algebraic numbers: behind a hold, and with dead time. mpmath computes them a second way."""

import math
import pickle
from fractions import Fraction

import jurist
import mpmath
import pytest
from jurist import Real

HELD = 'time = "discrete"\nsample_time = "1/2"\nparameters.k = { nominal = 1, min = 0 }\n[loop]\n[[block]]\nname = "gain"\ninput = "-y"\noutput = "u"\ngain = "k"\n[[block]]\nname = "lag"\ninput = "u"\noutput = "y"\nnum = [1]\nden = [1, 1]\ndiscretize = "zoh"\n'
"""1/(s + 1) behind a hold: stable up to coth(1/4)."""

DEAD = 'time = "continuous"\nparameters.k = { nominal = 1, min = 0 }\nloop.characteristic = "s + 1 + k*exp(-s)"\n'
"""Stable up to sqrt(1 + w^2) with w + atan(w) = pi."""


def held_limit():
    return mpmath.coth(mpmath.mpf(1) / 4)


def dead_limit():
    w = mpmath.findroot(lambda w: w + mpmath.atan(w) - mpmath.pi, 2)
    return mpmath.sqrt(1 + w**2)


@pytest.fixture(params=[(HELD, held_limit), (DEAD, dead_limit)], ids=["hold", "dead time"])
def case(request):
    text, limit = request.param
    with mpmath.workdps(300):
        value = limit()
    return jurist.Loop.from_toml(text).intervals("k"), value


def exactly(value):
    """The binary number that mpmath computed."""
    sign, mantissa, exponent, _ = value._mpf_
    return (-1) ** sign * Fraction(int(mantissa)) * Fraction(2) ** exponent


def test_digits_floats_and_formats_are_correctly_rounded(case):
    s, want = case
    x = s[-1].upper.value
    assert x.kind == "transcendental"
    assert (x.exact, x.polynomial, x.degree) == (None, None, None)
    with mpmath.workdps(300):
        for digits in (5, 12, 50, 120):
            assert x.decimal(digits) == mpmath.nstr(want, digits, strip_zeros=False)
        assert float(x) == float(exactly(want))
        assert f"{x:.30f}" == f"{mpmath.nstr(want, 31, strip_zeros=False)}"
        low, high = x.enclosure(80)
        assert low < exactly(want) < high
        assert high - low <= low / 10**82
        assert mpmath.almosteq(mpmath.mpf(x), want, 1e-299)
        assert x.flint(60).contains(x.flint(90))


def test_order_is_exact_against_rationals_and_other_numbers(case):
    s, want = case
    x = s[-1].upper.value
    with mpmath.workdps(300):
        near = exactly(want)
    for step in (Fraction(1, 10**k) for k in (1, 20, 200)):
        assert near - step < x < near + step
        assert near - step in s
        assert near + step not in s
    root = Real.root((-2, 0, 1), 1, 2)
    assert root < x
    assert sorted([x, root, Real(1), Real(9)]) == [1, root, x, 9]
    assert x not in s
    assert x != root
    assert x < math.inf
    assert x != float(x)


def test_equal_ends_are_equal_and_hash_alike(case):
    s, _ = case
    x = s[-1].upper.value
    again = pickle.loads(pickle.dumps(x))
    other = pickle.loads(pickle.dumps(s))[-1].upper.value
    assert x == again == other
    assert hash(x) == hash(again) == hash(other)
    assert again.decimal(100) == x.decimal(100)
    assert s == pickle.loads(pickle.dumps(s))
    assert s | s == s
    assert (s & s)[-1].upper.value == x
    assert not (s - s)


def test_arithmetic_with_rational_numbers(case):
    s, want = case
    x = s[-1].upper.value
    with mpmath.workdps(300):
        for ours, theirs in (
            (-x, -want),
            (3 * x - 7, 3 * want - 7),
            (1 / x, 1 / want),
            (5 - x / 2, 5 - want / 2),
            (x - Fraction(x.decimal(30)), want - mpmath.mpf(x.decimal(30))),
        ):
            assert ours.kind == "transcendental"
            assert ours.decimal(40) == mpmath.nstr(theirs, 40, strip_zeros=False, min_fixed=-6, max_fixed=15)
    assert (2 * x) / 2 != 2 * x
    assert 2 * x == 2 * x
    assert math.floor(x) == int(want)
    assert math.ceil(x) == int(want) + 1
    assert round(x, 3) == Fraction(round(float(want) * 1000), 1000)
    assert abs(-x) == abs(-x)
    assert x * 0 == 0
    with pytest.raises(TypeError, match="two irrational"):
        x + x


def test_sets_with_such_ends_are_combined_sampled_and_shown(case):
    s, _ = case
    wide = ~s
    assert wide[-1].lower.closed
    assert wide[-1].lower.value == s[-1].upper.value
    assert not (wide & s)
    assert all(value in s for value in s.sample(4))
    assert s.nearest_end(3).value == s[-1].upper.value
    assert repr(s[-1].upper.value).startswith("<Real ")
    assert "…" not in s._repr_html_()
    with pytest.raises(TypeError, match="no polynomial"):
        s[-1].upper.value.sympy()
