"""Each reason why an answer differs from python-control's tests is confirmed at 50 digits, by mpmath and from the test's own data."""

import warnings

import control as ct
import jurist
import mpmath
import pytest
from jurist.testing.deviations import DEVIATIONS

mp = mpmath.mp


@pytest.fixture(autouse=True)
def fifty_digits():
    with mpmath.workdps(60):
        yield


@pytest.fixture(autouse=True)
def quiet():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        yield


def close(a, b, digits=50):
    return abs(a - b) <= mpmath.mpf(10) ** -digits * max(1, abs(b))


def coefficients(system):
    """Numerator and denominator as the binary numbers that they are."""
    return [[mpmath.mpf(float(c)) for c in side[0][0]] for side in (system.num, system.den)]


def response(system):
    num, den = coefficients(system)
    return lambda w: mpmath.polyval(num, 1j * w) / mpmath.polyval(den, 1j * w)


def distance_at_rest(system, near):
    """A frequency at which |1 + L|^2 is stationary, and |1 + L| there."""
    loop = response(system)

    def square(w):
        z = 1 + loop(w)
        return (z * mpmath.conj(z)).real

    at = mpmath.findroot(lambda w: mpmath.diff(square, w), near)
    return at, mpmath.sqrt(square(at))


S = ct.TransferFunction.s
CASE_1 = ct.tf([1], [1, 2, 3, 4])
CASE_3 = ((8.75 * (4 * S**2 + 0.4 * S + 1)) / ((100 * S + 1) * (S**2 + 0.22 * S + 1))) / (S**2 / 10.0**2 + 2 * 0.04 * S / 10.0 + 1)
EXAMPLE_21 = 0.002 * (S + 0.02) * (S + 0.05) * (S + 5) * (S + 10) / ((S - 0.0005) * (S + 0.0001) * (S + 0.01) * (S + 0.2) * (S + 1) * (S + 100) ** 2)


def test_every_reason_has_its_test():
    assert len(set(DEVIATIONS.values())) == 4


@pytest.mark.parametrize(("system", "places"), [(CASE_1, (0.169, 1.662)), (CASE_3, (0.4064, 9.9918))], ids=["tsys1", "tsys3"])
def test_the_modulus_margin_is_the_least_of_the_stationary_values(system, places):
    first, second = (distance_at_rest(system, near) for near in places)
    ours = jurist.margins(system, floats="binary").modulus
    assert second[1] < first[1] - mpmath.mpf("0.1")
    assert close(mpmath.mpf(ours.value), second[1])
    assert close(mpmath.mpf(ours.at.omega), second[0], 10)


def test_the_modulus_is_one_at_the_frequency_0():
    system = ct.tf([1], [1, 1])
    assert response(system)(0) == 1
    (crossing,) = jurist.margins(system).gain_crossings
    assert (crossing.at.omega, crossing.phase_margin_degrees) == (0.0, 180.0)


def test_the_loop_without_a_modulus_margin_is_unstable():
    num, den = coefficients(EXAMPLE_21)
    closed = [d + n for d, n in zip(den, [0] * (len(den) - len(num)) + num, strict=True)]
    roots = mpmath.polyroots(closed, maxsteps=500, extraprec=400)
    right = [r for r in roots if r.real > mpmath.mpf(10) ** -30]
    found = jurist.margins(EXAMPLE_21, floats="binary")
    assert not found.stable
    assert found.modulus is None
    assert found.to_dict()["outside"] == len(right) > 0
    # All crossings are those of the loop nonetheless: at each the loop is -1 times the factor's inverse.
    loop = response(EXAMPLE_21)
    for crossing in found.phase_crossings:
        low = crossing.enclosure[0]
        factor = mpmath.mpf(low.numerator) / low.denominator
        place = mpmath.findroot(lambda w: loop(w).imag, crossing.at.omega) if crossing.at.omega else mpmath.mpf(0)
        assert close(loop(place) * factor, -1, 12)


@pytest.mark.parametrize(
    ("num", "den", "dt", "expected", "digits"),
    [
        ([2], [1, 3, 2, 0], 1e-2, (2.955761, 32.398492, 0.429535), 5),
        ([2], [1, 3, 3, 1], 0.1, (3.4927, 65.4212, 0.5763), 4),
        ([5e4], [1.0, 101.0, 10101.0, 10100.0, 10000.0], 1e-3, (18.8766, 26.3564, 0.406841), 5),
    ],
    ids=["gh-465", "cubic", "gh-523b"],
)
def test_margins_of_sampled_loops_are_those_expected_and_exact(num, den, dt, expected, digits):
    """At the gain margin the closed loop has roots on the unit circle, to 50 digits."""
    system = ct.tf(num, den).sample(dt)
    found = jurist.margins(system, floats="binary")
    gm, pm, sm, *_ = found.as_control()
    for ours, theirs in zip((gm, pm, sm), expected, strict=True):
        assert ours == pytest.approx(theirs, rel=10.0**-digits)
    n, d = coefficients(system)
    factor = mpmath.mpf(found.upper.value)
    closed = [a + factor * b for a, b in zip(d, [0] * (len(d) - len(n)) + n, strict=True)]
    roots = mpmath.polyroots(closed, maxsteps=500, extraprec=400)
    assert any(close(abs(r), mpmath.mpf(1), 45) for r in roots)
    assert all(abs(r) < 1 + mpmath.mpf(10) ** -45 for r in roots)
