"""Arithmetic of a real number with rational ones, and rounding."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import TYPE_CHECKING, Any, TypeGuard

from ._exact import exact, integer
from ._narrow import Bounds, Moved

if TYPE_CHECKING:
    from . import _jurist
    from ._real import Real


class Arithmetic:
    """What `Real` has for ``+ - * /`` with rational numbers, and for `math`."""

    __slots__ = ()

    if TYPE_CHECKING:
        # What `Real` brings.
        _core: _jurist.Algebraic | None

        @property
        def exact(self) -> Fraction | None: ...
        def enclosure(self, digits: int = 12) -> Bounds: ...
        def _more(self, digits: int) -> int: ...
        def __lt__(self, other: Any) -> bool: ...

    def _sent(self, factor: Fraction, term: Fraction) -> Real:
        """``factor*self + term``."""
        value = self.exact
        real: type[Real] = type(self)  # type: ignore[assignment]
        if value is not None:
            return real(factor * value + term)
        if factor == 0:
            return real(term)
        if self._core is None:
            return real._transcendental(*_narrowed(Moved(self, factor, term)))
        # p((y - term)/factor), by Horner's rule.
        inner = (-term / factor, 1 / factor)
        zero = Fraction(0)
        out = [zero]
        for c in reversed([integer(c) for c in self._core.polynomial()]):
            out = [
                (out[k] * inner[0] if k < len(out) else zero) + (out[k - 1] * inner[1] if k else zero) for k in range(len(out) + 1)
            ]
            out[0] += c
        while len(out) > 1 and out[-1] == 0:
            out.pop()
        ends = sorted(factor * x + term for x in self.enclosure(3))
        return real.root(_cleared(out), *ends)

    def __neg__(self) -> Real:
        return self._sent(Fraction(-1), Fraction(0))

    def __pos__(self) -> Real:
        return self  # type: ignore[return-value]

    def __abs__(self) -> Real:
        return -self if self < 0 else +self

    def __add__(self, other: Any) -> Real:
        if _is_real(other) and self.exact is not None:
            return other._sent(Fraction(1), self.exact)
        value = _operand(other)
        return NotImplemented if value is None else self._sent(Fraction(1), value)

    __radd__ = __add__

    def __sub__(self, other: Any) -> Real:
        if _is_real(other) and self.exact is not None:
            return other._sent(Fraction(-1), self.exact)
        value = _operand(other)
        return NotImplemented if value is None else self._sent(Fraction(1), -value)

    def __rsub__(self, other: Any) -> Real:
        value = _operand(other)
        return NotImplemented if value is None else self._sent(Fraction(-1), value)

    def __mul__(self, other: Any) -> Real:
        if _is_real(other) and self.exact is not None:
            return other._sent(self.exact, Fraction(0))
        value = _operand(other)
        return NotImplemented if value is None else self._sent(value, Fraction(0))

    __rmul__ = __mul__

    def __truediv__(self, other: Any) -> Real:
        if _is_real(other) and self.exact is not None:
            return other._reciprocal()._sent(self.exact, Fraction(0))
        value = _operand(other)
        return NotImplemented if value is None else self._sent(1 / value, Fraction(0))

    def __rtruediv__(self, other: Any) -> Real:
        value = _operand(other)
        return NotImplemented if value is None else self._reciprocal()._sent(value, Fraction(0))

    def _reciprocal(self) -> Real:
        value = self.exact
        real: type[Real] = type(self)  # type: ignore[assignment]
        if value is not None:
            return real(1 / value)
        if self._core is None:
            return real._transcendental(*_narrowed(Moved(self, Fraction(1), Fraction(0), inverted=True)))
        coefficients = [integer(c) for c in reversed(self._core.polynomial())]
        while coefficients[-1] == 0:
            coefficients.pop()
        lower, upper = self.enclosure(3)
        return real.root(coefficients, 1 / upper, 1 / lower)

    def _rounded(self, places: int) -> int:
        """The nearest multiple of ``10**-places``, ties to even, as a count."""
        scale: int = 10**places
        digits = places + 12
        while True:
            lower, upper = (round(x * scale) for x in self.enclosure(digits))
            if lower == upper:
                return lower
            digits = self._more(digits)

    def __floor__(self) -> int:
        if self._core is not None:
            return integer(self._core.floor())
        digits = 12
        while True:
            lower, upper = (math.floor(x) for x in self.enclosure(digits))
            if lower == upper:
                return lower
            digits = self._more(digits)

    def __ceil__(self) -> int:
        return -math.floor(-self) if self._core is not None else math.floor(self) + 1

    def __trunc__(self) -> int:
        return math.ceil(self) if self < 0 else math.floor(self)

    def __int__(self) -> int:
        return math.trunc(self)

    def __round__(self, ndigits: int | None = None) -> Any:
        if ndigits is None:
            return self._rounded(0)
        if ndigits < 0:
            value = self.exact
            return round(value if value is not None else self.enclosure(40)[0], ndigits)
        return Fraction(self._rounded(ndigits), 10**ndigits)


def _narrowed(moved: Moved) -> tuple[tuple[Fraction, Fraction], Any, Moved]:
    """What a transcendental number is made from: first bounds, nothing that it is a root of, and how it is narrowed."""
    return moved(12), None, moved


def _is_real(x: Any) -> TypeGuard[Real]:
    return isinstance(x, Arithmetic)


def _operand(x: Any) -> Fraction | None:
    """A rational operand; `None` for what is no number."""
    if _is_real(x):
        value = x.exact
        if value is None:
            raise TypeError("two irrational numbers are not computed with: use .sympy() or .flint()")
        return value
    if isinstance(x, (str, float)):
        return None
    try:
        return exact(x, "refuse")
    except (TypeError, ValueError):
        return None


def _cleared(coefficients: list[Fraction]) -> list[int]:
    common = math.lcm(*(c.denominator for c in coefficients))
    return [int(c * common) for c in coefficients]
