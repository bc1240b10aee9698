"""Unions of intervals cut into points and gaps, and simple numbers in them."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from fractions import Fraction

from ._ends import Cause, Interval
from ._real import Real


def membership(sets: Sequence[Iterable[Interval]], rule: Callable[[bool, bool], bool]) -> tuple[list[Real], list[bool]]:
    """All ends in ascending order; for each gap and each end in turn, whether it is a member by the rule."""
    values = sorted(end.value for s in sets for i in s for end in (i.lower, i.upper) if end is not None)
    points: list[Real] = []
    for value in values:
        if not points or points[-1] != value:
            points.append(value)
    of_set = []
    for s in sets:
        member = [False] * (2 * len(points) + 1)
        for i in s:
            low = -1 if i.lower is None else points.index(i.lower.value)
            high = len(points) if i.upper is None else points.index(i.upper.value)
            first = 2 * low + (1 if i.lower is not None and i.lower.closed else 2)
            last = 2 * high + (1 if i.upper is not None and i.upper.closed else 0)
            member[max(first, 0) : last + 1] = [True] * (last + 1 - max(first, 0))
        of_set.append(member)
    return points, [rule(a, b) for a, b in zip(*of_set, strict=True)]


def pieces(sets: Sequence[Iterable[Interval]], rule: Callable[[bool, bool], bool]) -> tuple[list[Real], list[bool], list[str]]:
    points, member = membership(sets, rule)
    order = list(Cause)
    causes = []
    for point in points:
        found = {c for s in sets for i in s for end in (i.lower, i.upper) if end and end.value == point for c in end.causes}
        causes.append("+".join(c.value for c in sorted(found, key=order.index)))
    return points, member, causes


def simplest(lower: Real | None, upper: Real | None) -> Fraction | None:
    """The rational number with the smallest denominator strictly between, of those the one nearest to 0."""
    if lower is not None and upper is not None and not lower < upper:
        return None
    if (lower is None or lower < 0) and (upper is None or upper > 0):
        return Fraction(0)
    if upper is None:
        assert lower is not None
        return Fraction(math.floor(lower) + 1)
    if lower is None:
        return Fraction(math.ceil(upper) - 1)
    digits = 2
    while True:
        # The simplest of a slightly longer interval is the simplest of this one if it is in it.
        candidate = _simplest_between(lower.enclosure(digits)[0], upper.enclosure(digits)[1])
        if lower < candidate and upper > candidate:
            return candidate
        digits *= 2


def _simplest_between(low: Fraction, high: Fraction) -> Fraction:
    if high <= 0:
        return -_simplest_between(-high, -low)
    floor = math.floor(low)
    if floor + 1 < high:
        return Fraction(floor + 1)
    low, high = low - floor, high - floor
    if low == 0:
        return floor + Fraction(1, math.floor(1 / high) + 1)
    return floor + 1 / _simplest_between(1 / high, 1 / low)
