"""How numbers that are known by bounds get narrower ones."""

from __future__ import annotations

from fractions import Fraction
from typing import Any, Protocol

Bounds = tuple[Fraction, Fraction]
"""Lower and upper bound."""


class Narrower(Protocol):
    """Gives bounds of relative width at most ``10**-(digits + 2)``."""

    def __call__(self, digits: int) -> Bounds:
        """The bounds."""

    def is_of(self, other: Any) -> bool:
        """Whether the other one gives bounds of a number of the same answer, made in the same way."""


class OfAnswer:
    """A number that stands at a place of an answer: the answer is written again with more digits."""

    __slots__ = ("answer", "known", "path")

    def __init__(self, answer: Any, path: tuple[Any, ...]) -> None:
        self.answer = answer
        self.path = path
        self.known: dict[int, Bounds] = {}

    def __call__(self, digits: int) -> Bounds:
        if digits not in self.known:
            self.known[digits] = self.answer._bounds_at(self.path, digits)
        return self.known[digits]

    def is_of(self, other: Any) -> bool:
        return isinstance(other, OfAnswer) and bool(self.answer._question() == other.answer._question())

    def __reduce__(self) -> tuple[Any, ...]:
        return OfAnswer, (self.answer, self.path)


class Moved:
    """``factor*x + term``, or its inverse."""

    __slots__ = ("factor", "inverted", "of", "term")

    def __init__(self, of: Any, factor: Fraction, term: Fraction, *, inverted: bool = False) -> None:
        self.of = of
        self.factor = factor
        self.term = term
        self.inverted = inverted

    def __call__(self, digits: int) -> Bounds:
        more = digits
        while True:
            low, high = sorted(self.factor * x + self.term for x in self.of.enclosure(more))
            # The number is not 0, so that its sign shows in the end.
            if low > 0 or high < 0:
                if self.inverted:
                    low, high = 1 / high, 1 / low
                if high - low <= min(abs(low), abs(high)) / 10 ** (digits + 2):
                    return low, high
            more = self.of._more(more + 2)

    def is_of(self, other: Any) -> bool:
        if not isinstance(other, Moved) or (self.factor, self.term, self.inverted) != (other.factor, other.term, other.inverted):
            return False
        return bool(self.of._is_same(other.of))

    def __reduce__(self) -> tuple[Any, ...]:
        return _moved, (self.of, self.factor, self.term, self.inverted)


def _moved(of: Any, factor: Fraction, term: Fraction, inverted: bool) -> Moved:
    return Moved(of, factor, term, inverted=inverted)
