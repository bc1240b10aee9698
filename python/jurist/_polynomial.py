"""Characteristic polynomials."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

from ._answers import Document
from ._exact import Exact, fraction


class Polynomial(Document):
    """The characteristic polynomial in the variable and the parameters that are kept.

    Examples
    --------
    >>> import jurist
    >>> loop = jurist.Loop.characteristic("z^2 - z + K/2", time="discrete", parameters={"K": 1})
    >>> p = loop.charpoly()
    >>> print(p)
    Q(z) = a_2*z^2 + a_1*z + a_0
    <BLANKLINE>
    a_0 = 1/2*K
    a_1 = -1
    a_2 = 1
    >>> p.numpy(K=1)
    array([ 1. , -1. ,  0.5])
    """

    __slots__ = ()

    @property
    def variable(self) -> str:
        """``z`` or ``s``."""
        return str(self._document["variable"])

    @property
    def parameters(self) -> tuple[str, ...]:
        """What is kept."""
        return tuple(self._document["parameters"])

    @property
    def degree(self) -> int:
        """In the variable."""
        return len(self._document["coefficients"]) - 1

    def coefficients(self) -> list[tuple[dict[tuple[int, ...], Fraction], dict[tuple[int, ...], Fraction]]]:
        """From the constant term up: numerator and denominator, each as powers of the parameters to numbers."""

        def side(terms: list[Any]) -> dict[tuple[int, ...], Fraction]:
            return {tuple(powers): fraction(c) for powers, c in terms}

        return [(side(c["numerator"]), side(c["denominator"])) for c in self._document["coefficients"]]

    def write(self, notation: str, digits: int | None = None) -> str:
        """In one of the program's notations: text, json, csv, latex, matlab, python, rust."""
        assert self._loop is not None
        words = [w for w in self._words if w != "--json"] + ["--format", notation]
        return self._loop._core.command(words if digits is None else [*words, "--digits", str(digits)])[1]

    def latex(self) -> str:
        """Aligned equations."""
        return self.write("latex")

    def text(self, digits: int = 0) -> str:
        """The program's text; exact unless digits are asked for."""
        return self.write("text", digits or None)

    def numpy(self, **values: Exact) -> Any:
        """Coefficients as floats, highest power first, at values of the parameters that are kept."""
        import numpy

        from ._exact import exact

        at = [exact(values[name]) for name in self.parameters]

        def side(terms: dict[tuple[int, ...], Fraction]) -> Fraction:
            total = Fraction(0)
            for powers, c in terms.items():
                for x, k in zip(at, powers, strict=True):
                    c = c * x**k
                total += c
            return total

        return numpy.array([float(side(n) / side(d)) for n, d in reversed(self.coefficients())])

    def sympy(self) -> Any:
        """A SymPy polynomial.

        Examples
        --------
        >>> import jurist
        >>> loop = jurist.Loop.characteristic("z^2 - z + K/2", time="discrete", parameters={"K": 1})
        >>> loop.charpoly().sympy()
        Poly(z**2 - z + K/2, z, domain='QQ[K]')
        """
        import sympy

        symbols = [sympy.Symbol(name) for name in self.parameters]

        def side(terms: dict[tuple[int, ...], Fraction]) -> Any:
            out = []
            for powers, c in terms.items():
                factors = (x**k for x, k in zip(symbols, powers, strict=True))
                out.append(sympy.Rational(c.numerator, c.denominator) * sympy.prod(factors))
            return sympy.Add(*out)

        variable = sympy.Symbol(self.variable)
        return sympy.Poly([side(n) / side(d) for n, d in reversed(self.coefficients())], variable)

    def __str__(self) -> str:
        return self.text().rstrip()

    def _repr_latex_(self) -> str:
        return f"$${self.latex().strip()}$$"
