"""Real numbers as the engine knows them: exact order, any number of digits."""

from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction
from typing import Any

from . import _jurist
from ._arithmetic import Arithmetic
from ._errors import undecided
from ._exact import Exact, exact, fraction, fraction_text, integer, integer_text
from ._narrow import Bounds, Narrower
from ._views import Views

_WRITTEN_DIGITS = 12
"""The digits of documents, unless more are asked for."""

_SAME_DIGITS = 50
"""Different ends of one answer have different enclosures with so many digits: each lies in a bracket of its own."""

_MOST_DIGITS = 2000
"""Transcendental numbers that are not told apart by so many digits may be equal."""


class Real(Arithmetic, Views):
    """An exact real number: a root of an integer polynomial, or a transcendental number in a certified enclosure.

    Comparisons are exact, also of two irrational numbers; equal numbers have equal hashes, as those of `int` and `Fraction`.
    Floats are compared as the binary numbers they are, as Python compares fractions.

    Parameters
    ----------
    value : exact number
        A rational number; irrational ones are made by `root` and `roots`, or come with answers.

    Examples
    --------
    >>> from jurist import Real
    >>> x = Real.root((-2, 0, 1), 1, 2)
    >>> x
    Real.root((-2, 0, 1), 1, 2)
    >>> x.decimal(30), float(x)
    ('1.41421356237309504880168872421', 1.4142135623730951)
    >>> x > 1.4142, x == Real.root((-4, 0, 0, 0, 1), 0, 2), f"{x:.20f}"
    (True, True, '1.41421356237309504880')
    >>> 2*x - 1 > x
    True
    """

    __slots__ = ("_core", "_enclosed", "_over", "_refine")

    _core: _jurist.Algebraic | None
    _enclosed: Bounds | None
    _over: Any
    _refine: Narrower | None

    def __init__(self, value: Exact = 0) -> None:
        if isinstance(value, Real):
            self._core, self._enclosed, self._over, self._refine = value._core, value._enclosed, value._over, value._refine
            return
        self._core = _jurist.Algebraic.rational(fraction_text(exact(value)))
        self._enclosed = self._over = self._refine = None

    @classmethod
    def _of(cls, core: _jurist.Algebraic) -> Real:
        self = cls.__new__(cls)
        self._core, self._enclosed, self._over, self._refine = core, None, None, None
        return self

    @classmethod
    def _transcendental(cls, bounds: Bounds, over: Any, refine: Narrower | None) -> Real:
        """A number that is not rational, in certified bounds that can be narrowed."""
        self = cls.__new__(cls)
        self._core, self._enclosed, self._over, self._refine = None, bounds, over, refine
        return self

    @classmethod
    def _from_document(cls, end: dict[str, Any], refine: Narrower | None = None) -> Real:
        """The number that stands in a document; a transcendental one is narrowed by asking for more digits."""
        if end["exact"] is not None:
            return cls._of(_jurist.Algebraic.rational(end["exact"]))
        lower, upper = end["enclosure"]
        if end["polynomial"] is not None:
            return cls._of(_jurist.Algebraic.root(end["polynomial"], lower, upper))
        return cls._transcendental((fraction(lower), fraction(upper)), end.get("over"), refine)

    @classmethod
    def root(cls, polynomial: Sequence[int], lower: Exact, upper: Exact) -> Real:
        """The only root of a polynomial in a closed interval.

        Parameters
        ----------
        polynomial : sequence of int
            Coefficients from the constant term up.
        lower, upper : exact number
            The interval.

        Raises
        ------
        ValueError
            Where there is no root, or more than one.

        Examples
        --------
        >>> from jurist import Real
        >>> print(Real.root((-2, 0, 1), 0, 2))
        1.41421356237
        """
        texts = [integer_text(int(c)) for c in polynomial]
        return cls._of(_jurist.Algebraic.root(texts, fraction_text(exact(lower)), fraction_text(exact(upper))))

    @classmethod
    def roots(cls, polynomial: Sequence[int]) -> list[Real]:
        """All real roots of a polynomial, each once, in ascending order.

        Examples
        --------
        >>> from jurist import Real
        >>> [float(x) for x in Real.roots((-2, 0, 1))]
        [-1.4142135623730951, 1.4142135623730951]
        """
        return [cls._of(core) for core in _jurist.Algebraic.roots([integer_text(int(c)) for c in polynomial])]

    @property
    def kind(self) -> str:
        """``"algebraic"`` or ``"transcendental"``."""
        return "transcendental" if self._core is None else "algebraic"

    @property
    def over(self) -> Any:
        """What a transcendental number is a root of, as the document says it."""
        return self._over

    @property
    def polynomial(self) -> tuple[int, ...] | None:
        """A square-free primitive polynomial with this root, coefficients from the constant term up."""
        return None if self._core is None else tuple(integer(c) for c in self._core.polynomial())

    @property
    def degree(self) -> int | None:
        """The degree of that polynomial."""
        return None if self._core is None else len(self._core.polynomial()) - 1

    @property
    def exact(self) -> Fraction | None:
        """The value, if it is rational."""
        text = None if self._core is None else self._core.exact()
        return None if text is None else fraction(text)

    def _jurist_exact_(self) -> Fraction | None:
        return self.exact

    def decimal(self, digits: int = 12) -> str:
        """Correctly rounded to so many significant digits: the program's text.

        Examples
        --------
        >>> from jurist import Real
        >>> Real("1/3").decimal(5)
        '0.33333'
        """
        if digits < 1:
            raise ValueError("at least one digit")
        if self._core is not None:
            return self._core.decimal(digits)
        for more in (2, 20, 200):
            lower, upper = (Real(x).decimal(digits) for x in self.enclosure(digits + more))
            if lower == upper:
                return _padded(lower, digits)
        raise undecided(f"the enclosure does not give {digits} digits", "digits", "the enclosure", None)

    def enclosure(self, digits: int = 12) -> tuple[Fraction, Fraction]:
        """Lower and upper bound, of relative width at most ``10**-(digits + 2)``; equal where the number is rational.

        Examples
        --------
        >>> from jurist import Real
        >>> lower, upper = Real.root((-2, 0, 1), 1, 2).enclosure(6)
        >>> lower**2 < 2 < upper**2
        True
        """
        if self._core is None:
            assert self._enclosed is not None
            low, high = self._enclosed
            is_enough = digits <= _WRITTEN_DIGITS and high - low <= min(abs(low), abs(high)) / 10 ** (digits + 2)
            # Narrower bounds are not kept here: so many digits give the same bounds, whatever was asked before.
            return self._enclosed if self._refine is None or is_enough else self._refine(digits)
        lower, upper = self._core.enclosure(digits)
        return fraction(lower), fraction(upper)

    def __float__(self) -> float:
        value = self.exact
        if value is not None:
            return float(value)
        digits = 17
        while True:
            lower, upper = (float(x) for x in self.enclosure(digits))
            if lower == upper:
                return lower
            digits = self._more(digits)

    def _more(self, digits: int) -> int:
        """Twice as many digits, if they can be had."""
        if self._core is None and (self._refine is None or digits > _MOST_DIGITS):
            raise undecided(f"the enclosure does not give {digits} digits", "digits", "the enclosure", None)
        return 2 * digits

    def _compare(self, other: Any) -> float | None:
        """-1, 0, 1, not-a-number as it comes, or `None` for what is no number."""
        if isinstance(other, Real):
            if self._core is not None and other._core is not None:
                return self._core.compare(other._core)
            return 0 if self._is_same(other) else _parted(self, other)
        if isinstance(other, str):
            return None
        if isinstance(other, float) and not math.isfinite(other):
            return other if math.isnan(other) else (-1 if other > 0 else 1)
        try:
            value = exact(other, "binary")
        except (TypeError, ValueError):
            return None
        if self._core is None:
            return _parted(self, Real(value))
        return self._core.compare_rational(fraction_text(value))

    def _is_same(self, other: Real) -> bool:
        """Whether both are the same end of the same answer, which is how equal transcendental numbers are known."""
        if self is other:
            return True
        if self._refine is None or other._refine is None or self._over != other._over:
            return False
        return self._refine.is_of(other._refine) and self.enclosure(_SAME_DIGITS) == other.enclosure(_SAME_DIGITS)

    def __eq__(self, other: object) -> bool:
        return self._compare(other) == 0

    def __lt__(self, other: Any) -> bool:
        order = self._compare(other)
        return NotImplemented if order is None else order < 0

    def __le__(self, other: Any) -> bool:
        order = self._compare(other)
        return NotImplemented if order is None else order <= 0

    def __gt__(self, other: Any) -> bool:
        order = self._compare(other)
        return NotImplemented if order is None else order > 0

    def __ge__(self, other: Any) -> bool:
        order = self._compare(other)
        return NotImplemented if order is None else order >= 0

    def __hash__(self) -> int:
        value = self.exact
        if value is not None:
            return hash(value)
        try:
            return hash(float(self))
        except OverflowError:
            return hash(math.floor(self))

    def __bool__(self) -> bool:
        return self != 0

    def __str__(self) -> str:
        return self.decimal(12)

    def __repr__(self) -> str:
        value = self.exact
        if value is not None:
            return f"Real({fraction_text(value)!r})" if value.denominator != 1 else f"Real({integer_text(value.numerator)})"
        if self._core is None:
            return f"<Real {self.decimal(8)}..., transcendental>"
        lower, upper = _short_bounds(self)
        polynomial = ", ".join(self._core.polynomial())
        return f"Real.root(({polynomial}), {lower}, {upper})"

    def _repr_latex_(self) -> str:
        value = self.exact
        if value is None:
            return f"${self.decimal(12)}\\ldots$"
        if value.denominator == 1:
            return f"${value.numerator}$"
        sign = "-" if value < 0 else ""
        return f"${sign}\\frac{{{abs(value.numerator)}}}{{{value.denominator}}}$"

    def __reduce__(self) -> tuple[Any, ...]:
        value = self.exact
        if value is not None:
            return Real, (value,)
        if self._core is None:
            return _enclosed, (self._enclosed, self._over, self._refine)
        return Real.root, (self.polynomial, *self.enclosure(3))


def _enclosed(bounds: Bounds, over: Any, refine: Narrower | None) -> Real:
    return Real._transcendental(bounds, over, refine)


def _parted(a: Real, b: Real) -> int:
    """The order of two numbers that are not equal, or not known to be."""
    digits = 20
    while True:
        (low, high), (least, most) = a.enclosure(digits), b.enclosure(digits)
        if high < least:
            return -1
        if most < low:
            return 1
        if a._refine is None and b._refine is None or digits > _MOST_DIGITS:
            raise undecided("the enclosures do not tell the numbers apart", "digits", f"{digits} digits", None)
        digits *= 2


def _padded(text: str, digits: int) -> str:
    """A decimal with the zeros at its end that a fraction does not show."""
    mantissa, e, exponent = text.partition("e")
    shown = len(mantissa.lstrip("-0.").replace(".", ""))
    if shown < digits:
        mantissa += ("" if "." in mantissa else ".") + "0" * (digits - shown)
    return mantissa + e + exponent


def _short_bounds(x: Real) -> tuple[str, str]:
    """Bounds with few digits that hold no other root."""
    roots = Real.roots(x.polynomial or ())
    at = next(i for i, root in enumerate(roots) if root == x)
    digits = 0
    while True:
        scale = 10**digits
        low = math.floor(x * scale)
        lower, upper = Fraction(low, scale), Fraction(low + 1, scale)
        alone = (at == 0 or roots[at - 1] < lower) and (at + 1 == len(roots) or roots[at + 1] > upper)
        if alone:
            show = [integer_text(int(b)) if b.denominator == 1 else repr(fraction_text(b)) for b in (lower, upper)]
            return show[0], show[1]
        digits += 1
