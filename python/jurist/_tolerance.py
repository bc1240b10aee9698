"""Answers about boxes of tolerances."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import TYPE_CHECKING, Any, NamedTuple

from ._answers import Document
from ._exact import fraction

if TYPE_CHECKING:
    from matplotlib.axes import Axes


class Factor(NamedTuple):
    """The largest factor of all tolerances that keeps every point stable: proved below ``lower``, not stable at ``upper``; ``open`` says why these are no nearer to each other."""

    lower: Fraction
    upper: Fraction | None
    decimal: str
    open: str | None = None


class Worst(NamedTuple):
    """The worst point: where each parameter is (``-``, ``+`` or ``inside``), its values, and what happens there."""

    signs: Mapping[str, str]
    point: Mapping[str, Fraction]
    cause: str | None
    frequency_hz: float | None


class Tolerance(Document):
    """Whether a loop is stable for every value within tolerances, and how far they can grow.

    It is true where every point is proved stable.
    """

    __slots__ = ()

    def certificate(self, timeout: float | None = None) -> str:
        """A certificate that `verify` re-checks with independent code."""
        if self._loop is None:
            raise ValueError("this answer does not know its question")
        return self._loop._file_of(self._words, "--certificate", timeout)

    @property
    def holds(self) -> bool | None:
        """`True` with a proof, `False` with a counterexample, `None` where neither was found."""
        verdict = self._document["verdict"]
        return None if verdict is None else verdict == "stable"

    def __bool__(self) -> bool:
        return self.holds is True

    @property
    def box(self) -> Mapping[str, tuple[Fraction, Fraction]]:
        """The closed box."""
        return {name: (fraction(low), fraction(high)) for name, (low, high) in self._document["box"].items()}

    @property
    def factor(self) -> Factor | None:
        """By how much all tolerances can be scaled; `None` where the nominal point is not stable."""
        found = self._document["factor"]
        if found is None:
            return None
        upper = None if found["upper"] is None else fraction(found["upper"])
        return Factor(fraction(found["lower"]), upper, found["decimal"], found.get("open", {}).get("budget"))

    @property
    def worst(self) -> Worst | None:
        """The worst point that was found."""
        found = self._document["worst"]
        if found is None:
            return None
        return Worst(dict(found["signs"]), _point(found["point"]), found["cause"], found["frequency_hz"])

    @property
    def witness(self) -> Mapping[str, Fraction] | None:
        """A point that is not stable: of the box, or just beyond the largest factor."""
        found = self._document["witness"]
        return None if found is None else _point(found["point"])

    @property
    def shares(self) -> Mapping[str, float]:
        """How much of the margin each tolerance uses; they add up to 1."""
        return {name: float(share) for name, share in (self._document["shares"] or {}).items()}

    @property
    def limit(self) -> tuple[Fraction | None, Fraction | None] | None:
        """The range of the parameter asked about that is safe for all values of the others."""
        found = self._document.get("limit")
        if found is None:
            return None
        safe = found["lower"][1], found["upper"][0]
        low, high = (None if x is None else fraction(x) for x in safe)
        return low, high

    @property
    def volume(self) -> Mapping[str, Fraction] | None:
        """Shares of the box's volume: stable, unstable, undecided."""
        found = self._document.get("volume")
        return None if found is None else {name: fraction(found[name]) for name in ("stable", "unstable", "undecided")}

    def plot(self, ax: Axes | None = None, **kw: Any) -> Axes:
        """Draws how much of the margin each tolerance uses, as bars; returns the Axes."""
        from ._plot import plot_shares

        return plot_shares(self, ax, kw)

    def __str__(self) -> str:
        return self.text().rstrip()

    def __repr__(self) -> str:
        words = {True: "stable", False: "not stable", None: "undecided"}[self.holds]
        names = ", ".join(self._document["box"])
        factor = self.factor
        return f"<Tolerance of {names}: {words}{'' if factor is None else f', factor {factor.decimal}'}>"

    def _repr_html_(self) -> str:
        from ._html import escaped, table

        rows = [[name, low, high, f"{self.shares.get(name, 0):.1%}"] for name, (low, high) in self.box.items()]
        return f"<div><b>{escaped(repr(self)[1:-1])}</b>{table(['parameter', 'from', 'to', 'share'], rows)}</div>"


def _point(document: Mapping[str, str]) -> dict[str, Fraction]:
    return {name: fraction(value) for name, value in document.items()}
