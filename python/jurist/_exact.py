"""The one rule by which numbers become exact."""

from __future__ import annotations

import math
import numbers
import operator
import warnings
from decimal import Decimal
from fractions import Fraction
from typing import Any, Literal

from . import _jurist
from ._errors import JuristWarning

Floats = Literal["shortest", "binary", "refuse"]
Exact = Any
"""An exact number: int, Fraction, Decimal, a text such as ``"1e-4"`` or ``"1/3"``, a float (by rule), NumPy and SymPy numbers."""

_CHUNK = 4000
"""Fewer digits than Python converts at once (4300 unless it is told otherwise)."""


def integer(text: str) -> int:
    """An integer of any length from its decimal text."""
    if len(text) <= _CHUNK:
        return int(text)
    if text[0] in "+-":
        return -integer(text[1:]) if text[0] == "-" else integer(text[1:])
    half = len(text) // 2
    power: int = 10**half
    return integer(text[:-half]) * power + integer(text[-half:])


def integer_text(value: int) -> str:
    """The decimal text of an integer of any length."""
    if value.bit_length() <= 3 * _CHUNK:
        return str(value)
    if value < 0:
        return "-" + integer_text(-value)
    half = int(value.bit_length() * 0.30103) // 2
    high, low = divmod(value, 10**half)
    return integer_text(high) + integer_text(low).zfill(half)


def fraction(text: str) -> Fraction:
    """A fraction from the engine's text ``p/q`` or ``p``."""
    numerator, _, denominator = text.partition("/")
    return Fraction(integer(numerator), integer(denominator) if denominator else 1)


def fraction_text(value: Fraction) -> str:
    """The engine's text of a fraction."""
    text = integer_text(value.numerator)
    return text if value.denominator == 1 else f"{text}/{integer_text(value.denominator)}"


def _shortest(x: Any) -> str:
    if isinstance(x, float):
        return float.__repr__(x)
    return str(x)


def exact(x: Exact, floats: Floats = "shortest") -> Fraction:
    """The exact value of a number.

    Parameters
    ----------
    x : int, Fraction, Decimal, str, float, or a number of NumPy or SymPy, or a rational `Real`
        Texts are read as the program reads them: ``"1e-4"``, ``"1/3"``, ``"1.5/0.3"``.
    floats : {"shortest", "binary", "refuse"}
        What a float means: the shortest decimal that is this float (what ``repr`` shows, and what a model file would say),
        the binary number itself, or nothing at all.

    Returns
    -------
    Fraction

    Raises
    ------
    TypeError
        For what is no number, and for floats that are refused.
    ValueError
        For texts that are no numbers, and for infinities and not-a-number.

    Examples
    --------
    >>> from jurist import exact
    >>> exact(0.1), exact("1e-4")
    (Fraction(1, 10), Fraction(1, 10000))
    >>> exact(0.1, "binary")
    Fraction(3602879701896397, 36028797018963968)
    """
    if floats not in ("shortest", "binary", "refuse"):
        raise ValueError(f"floats is 'shortest', 'binary' or 'refuse', not {floats!r}")
    if isinstance(x, bool):
        raise TypeError("a truth value is not a number")
    if isinstance(x, int):
        return Fraction(x)
    if isinstance(x, Fraction):
        return x
    if isinstance(x, str):
        return fraction(_jurist.Algebraic.rational(x).exact() or "")
    if isinstance(x, Decimal):
        if not x.is_finite():
            raise ValueError(f"{x} is not a number with an exact value")
        return fraction(_jurist.Algebraic.rational(str(x)).exact() or "")
    if isinstance(x, numbers.Rational):
        return Fraction(int(x.numerator), int(x.denominator))
    own = getattr(x, "_jurist_exact_", None)
    if own is not None:
        value = own()
        if value is None:
            raise ValueError(f"{x} is irrational: it has no exact fraction")
        return Fraction(value)
    try:
        return Fraction(operator.index(x))
    except TypeError:
        pass
    if isinstance(x, numbers.Real) or getattr(x, "is_Float", False):
        if floats == "refuse":
            raise TypeError(f"the float {x!r} is not taken for an exact number; write a text, an int or a Fraction")
        if not math.isfinite(float(x)):
            raise ValueError(f"{x} is not a number with an exact value")
        if floats == "binary":
            ratio = x.as_integer_ratio()
            return Fraction(int(ratio[0]), int(ratio[1]))
        return fraction(_jurist.Algebraic.rational(_shortest(x)).exact() or "")
    raise TypeError(f"{type(x).__name__} is not an exact number")


def text_of(x: Exact, floats: Floats = "shortest") -> str:
    """The exact value as the engine reads it."""
    return fraction_text(exact(x, floats))


_COMPUTED_DIGITS = 16
"""So many significant digits are rarely typed by hand."""


def looks_computed(x: Any) -> bool:
    """Whether a float has as many digits as computation leaves."""
    if not isinstance(x, float) or not math.isfinite(x):
        return False
    digits = float.__repr__(x).lstrip("-").partition("e")[0].replace(".", "").strip("0")
    return len(digits) >= _COMPUTED_DIGITS


def warn_computed(values: Any, stacklevel: int = 3) -> None:
    """Warns, once for a text, where coefficients look computed."""
    if any(looks_computed(x) for x in values):
        text = (
            "warning[W-computed-floats]: these coefficients look computed; structure such as cancelled poles and double "
            "roots may be lost; build the loop from its parameters"
        )
        warnings.warn(JuristWarning(text, "W-computed-floats"), stacklevel=stacklevel)
