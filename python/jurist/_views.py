"""A real number as text, and in other libraries."""

from __future__ import annotations

from decimal import Decimal
from fractions import Fraction
from typing import Any

from ._exact import integer_text


class Views:
    """What `Real` has for formats, SymPy, mpmath and flint."""

    __slots__ = ()

    def __format__(self: Any, spec: str) -> str:
        if not spec:
            return str(self)
        body, kind = (spec[:-1], spec[-1]) if spec[-1].isalpha() or spec[-1] == "%" else (spec, "g")
        before, point, after = body.partition(".")
        precision = int(after) if point else 6
        if kind in "eE":
            value = Decimal(self.decimal(precision + 1))
        elif kind in "gG":
            value = Decimal(self.decimal(max(precision, 1)))
        elif kind in "fF":
            value = self._scaled(precision)
        else:
            raise ValueError(f"a real number is formatted with e, f or g, not {kind!r}")
        return format(value, f"{before}.{precision}{kind}")

    def _scaled(self: Any, places: int) -> Decimal:
        count = self._rounded(places)
        text = integer_text(abs(count)).zfill(places + 1)
        whole = len(text) - places
        return Decimal(f"{'-' if count < 0 else ''}{text[:whole]}.{text[whole:]}")

    def sympy(self: Any) -> Any:
        """The same number in SymPy: a `Rational` or a `CRootOf`.

        Examples
        --------
        >>> from jurist import Real
        >>> Real("1/3").sympy()
        1/3
        """
        import sympy

        value = self.exact
        if value is not None:
            return sympy.Rational(value.numerator, value.denominator)
        if self._core is None:
            raise TypeError("a transcendental number has no polynomial")
        coefficients = self.polynomial or ()
        rank = sum(1 for root in type(self).roots(coefficients) if root < self)
        return sympy.rootof(sympy.Poly(list(reversed(coefficients)), sympy.Symbol("x")), rank, radicals=False)

    def _sympy_(self: Any) -> Any:
        return self.sympy()

    def _mpmath_(self: Any, prec: int, rounding: str) -> Any:
        import mpmath
        from mpmath.libmp import from_rational

        digits = int(prec * 0.30103) + 3
        while True:
            ends = [from_rational(x.numerator, x.denominator, prec, rounding) for x in self.enclosure(digits)]
            if ends[0] == ends[1]:
                return mpmath.mp.make_mpf(ends[0])
            digits = self._more(digits)

    def flint(self: Any, digits: int = 50) -> Any:
        """A ball of python-flint that contains the number.

        Examples
        --------
        >>> from jurist import Real
        >>> ball = Real.root((-2, 0, 1), 1, 2).flint(20)
        >>> bool(ball.contains(ball)) and abs(float(ball) - 2**0.5) < 1e-15
        True
        """
        import flint

        before = flint.ctx.prec
        flint.ctx.prec = max(before, int(digits * 3.33) + 16)
        try:
            lower, upper = (flint.arb(flint.fmpq(x.numerator, x.denominator)) for x in self.enclosure(digits))
            return lower.union(upper)
        finally:
            flint.ctx.prec = before
