"""The best gains, beside the program's text."""

import pickle
from fractions import Fraction

import jurist
import pytest

PI = """
time = "continuous"
parameters = { k = { nominal = 0.5, min = 0 }, ki = { nominal = 0.2, min = 0 } }
[loop]
inputs = ["r"]
outputs = ["y"]
[[block]]
name = "loop"
input = "r - y"
output = "y"
transfer = "(k*s + ki)/(s*(s + 1)^3)"
"""


@pytest.fixture
def loop() -> jurist.Loop:
    return jurist.Loop.from_toml(PI)


def test_the_largest_integral_gain_under_a_sensitivity(loop):
    best = loop.tune("max ki", ["k", "ki"], bounds={"k": (0, 5), "ki": (0, 5)}, modulus_margin=Fraction(1, 2))
    assert best.value.decimal(20) == "0.68519019419955363817"
    low, high = best.at["k"]
    assert low <= Fraction("1.22195903483199543") + Fraction(1, 10**17) and high - low < Fraction(1, 10**16)
    assert (best.attained, best.binding, bool(best)) == (True, ("modulus_margin",), True)
    assert loop.verdict(best.rounded).verdict == "stable"
    assert all(required.met for required in best.requirements)
    assert best.text().splitlines()[-1].startswith("    modulus_margin >= 1/2: met")
    assert pickle.loads(pickle.dumps(best)) == best


def test_gains_that_are_not_there(loop):
    nothing = loop.tune(None, ["k", "ki"], bounds={"ki": (0.3254, 5), "k": (0, 5)}, modulus_margin="5/7")
    assert (bool(nothing), nothing.found, nothing.conflict) == (False, None, ("modulus_margin >= 5/7", "ki >= 0.3254"))


def test_a_bracket(loop):
    best = loop.tune("max decay", "k", {"ki": "1/10"})
    assert best.proved is None and best.value is not None
    held = jurist.Loop.from_line("K/(s*(s + 1))", hold="1/10").tune("min radius", ["K"])
    assert held.value is None
    assert float(held.proved) < float(held.found_value)


def test_expressions_settling_times_and_peak_gains(loop):
    cubic = jurist.Loop.from_line("K/(s*(s+1)*(s+2))")
    best = cubic.tune("max K*(3 - K)", ["K"])
    assert (best.value.exact, best.at["K"].exact, best.objective) == (Fraction(9, 4), Fraction(3, 2), "max K*(3 - K)")
    settled = cubic.tune("min settling_time", ["K"])
    assert (settled.value, settled.decimal) == (None, "9.46410161514")
    assert float(cubic.tune("min norm r y", ["K"]).decimal) == 1


def test_what_cannot_be_asked(loop):
    with pytest.raises(jurist.QuestionError, match="asks for the worst decay"):
        loop.tune("min decay", "k")
    with pytest.raises(jurist.QuestionError, match="no gain is free"):
        loop.tune("max k")
    with pytest.raises(jurist.Undecided):
        loop.tune("max ki", ["k", "ki"], timeout=0)


def test_gains_for_all_plants():
    loop = jurist.Loop.from_toml(
        "time = 'continuous'\nparameters = { K = 1, a = { nominal = 1.5, tolerance = '1/2' } }\nloop.characteristic = 's*(s + a)*(s + 2) + K'\n"
    )
    # K < 2 a (a + 2).
    for best in (
        loop.tune("max K", ["K"], bounds={"K": (0, 100)}, for_all={"a": (1, 2)}),
        loop.tune("max K", ["K"], bounds={"K": (0, 100)}, robust=True),
    ):
        assert best.for_all == {"a": (1, 2)}
        assert best.found["K"] < 6 <= Fraction(best.proved)


def test_the_middle_of_the_good_gains():
    best = jurist.Loop.from_line("K/(s*(s+1)*(s+2))").tune("max tolerance absolute", ["K"])
    assert (best.value.exact, best.at["K"].exact) == (3, 3)


def test_a_picture_of_two_gains(loop):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    best = loop.tune("max ki", ["k", "ki"], bounds={"k": (0, 5), "ki": (0, 5)}, modulus_margin=Fraction(1, 2))
    ax = best.plot()
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("k", "ki")
    assert tuple(ax.lines[-1].get_xdata()) == (float(best.rounded["k"]),)
    with pytest.raises(ValueError, match="two free gains"):
        loop.tune("max k", "k", {"ki": "1/10"}).plot()
