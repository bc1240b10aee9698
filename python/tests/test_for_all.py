"""What holds for all values of other names, and its certificates."""

from __future__ import annotations

from fractions import Fraction

import jurist


SERVO = """
time = "discrete"
parameters = { K = { nominal = 1, min = 0, max = 20 }, T_m = { nominal = 0.05, min = 0.01 } }
[loop]
inputs = ["r"]
outputs = ["y"]
[[block]]
name = "controller"
input = "r - y"
output = "u"
gain = "K"
[[block]]
name = "motor"
input = "u"
output = "y"
transfer = "1/(s*(T_m*s + 1))"
discretize = { method = "zoh", T = 0.1 }
"""


def servo() -> jurist.Loop:
    return jurist.Loop.from_toml(SERVO)


def test_one_parameter_for_all_values_has_enclosed_ends_and_a_certificate() -> None:
    loop = jurist.Loop.characteristic("z - 1 + K*c", time="discrete", parameters={"K": 1, "c": 1})
    found = loop.intervals("K", domain=(0, 3), for_all={"c": ("1/2", 4)})
    assert len(found) == 1 and abs(float(found[0].upper) - 0.5) < 1e-7
    assert "0.5" not in found and Fraction(49, 100) in found
    proved = jurist.verify(loop, found.certificate())
    assert proved.kind == "for_all" and "for all c from 1/2 to 4" in proved.statement


def test_maps_and_tolerances_with_requirements_are_certified() -> None:
    loop = servo()
    found = loop.map(
        "K", "T_m", window={"K": (1, 6), "T_m": ("1/50", "1/10")}, method="boxes", undecided="1/5", phase_margin="45 deg", at="u"
    )
    assert "phase margin of at least 45 degrees" in jurist.verify(loop, found.certificate()).statement
    held = loop.tolerance(tol={"T_m": "20%"}, phase_margin="45 deg", at="u")
    assert held.holds and jurist.verify(loop, held.certificate()).kind == "for_all"
    plain = loop.tolerance(tol={"K": "20%"})
    assert jurist.verify(loop, plain.certificate()).kind == "tolerance"


def test_a_map_for_all_values() -> None:
    loop = jurist.Loop.characteristic("s^2 + a*s + b - c", time="continuous", parameters={"a": 1, "b": 2, "c": 0})
    window = {"a": (-1, 3), "b": (-1, 3)}
    found = loop.map("a", "b", window=window, undecided="1/10", for_all={"c": (0, 1)})
    assert not found.is_exact
    assert "for all c from 0 to 1" in jurist.verify(loop, found.certificate()).statement


def test_margins_of_a_verdict_are_certified() -> None:
    loop = servo()
    point = loop.verdict({"K": 2}, phase_margin="30 deg", at="u")
    assert point and "30 degrees" in jurist.verify(loop, point.certificate()).statement


def test_the_least_margins_for_all_values() -> None:
    found = servo().least_margins({"T_m": ("1/50", "1/10")}, values={"K": 2})
    assert found.stable and {"gain_margin", "phase_margin", "modulus_margin", "disk_margin"} <= set(found.margins)
    for one in found.margins.values():
        assert one.proved is not None and one.found is not None and one.at is not None
        exact = servo().margins(values={"K": 2, **one.at})
        if one.name == "modulus_margin":
            assert one.proved <= one.found[0] <= Fraction(exact.modulus.value.decimal(12)) + Fraction(1, 10**11)
    pole = jurist.Loop.characteristic("z - 1 + K*c", time="discrete", parameters={"K": 1, "c": 1})
    unstable = pole.least_margins({"c": (1, 4)})
    assert unstable.stable is False and unstable.margins == {}
