"""Where our answers differ from what python-control's tests expect, and why.

Each reason is confirmed at 50 digits, by mpmath and without this package, in ``tests/test_outside.py``.
"""

from __future__ import annotations

_LEAST = "python-control lists every stationary value of |1 + L|; ours is the least, which is among them"
_TOUCH = "the modulus is one at the frequency 0, which python-control leaves out: a lag of 180 degrees there leads to -1"
_UNSTABLE = "the loop is unstable as it stands, so that it has no modulus margin; all crossings agree"
_WARNING = "the test expects a warning about inaccurate polynomials; ours are exact, and the margins are those expected"

DEVIATIONS: dict[str, str] = {
    "margin_test::test_stability_margins[tsys1]": _LEAST,
    "margin_test::test_stability_margins[tsys3]": _LEAST,
    "margin_test::test_stability_margins[tsys4]": _TOUCH,
    "margin_test::test_margin_sys[tsys4]": _TOUCH,
    "margin_test::test_zmore_stability_margins[tsys_zmore0]": _UNSTABLE,
    "margin_test::test_stability_margins_discrete[cnum0-cden0-0.01-ref0-1e-05-True]": _WARNING,
    "margin_test::test_stability_margins_discrete[cnum1-cden1-0.1-ref1-0.0001-True]": _WARNING,
    "margin_test::test_stability_margins_discrete[cnum3-cden3-0.001-ref3-1e-05-True]": _WARNING,
}
"""Tests by module and name, and the reason."""
