"""Ends of intervals, and intervals: exact places, and why stability ends there."""

from __future__ import annotations

import enum
import math
from collections.abc import Iterator
from fractions import Fraction
from typing import Any

from ._exact import Exact, fraction, fraction_text
from ._narrow import Narrower
from ._real import Real


class Cause(str, enum.Enum):
    """Why stability ends.

    Examples
    --------
    >>> import jurist
    >>> jurist.Cause("complex pair")
    <Cause.PAIR: 'complex pair'>
    """

    Z1 = "z=1"
    ZM1 = "z=-1"
    PAIR = "complex pair"
    ROOT = "complex root"
    S0 = "s=0"
    INFINITY = "infinity"
    POLE = "pole"
    SQUARE_ROOT = "square root"
    NEUTRAL = "neutral"
    DUTY = "duty"
    DOMAIN = "domain"
    UNDECIDED = "undecided"


class End:
    """An end of an interval: its exact value, why stability ends there, and at which frequency.

    Examples
    --------
    >>> import jurist
    >>> end = jurist.Loop.drive().intervals("K_pwm")[0].upper
    >>> end.value.decimal(15), sorted(end.causes), end.frequency_hz
    ('550.941166686675', [<Cause.PAIR: 'complex pair'>], 1664.06519915)
    """

    __slots__ = ("_document", "_refine", "_value")

    def __init__(self, document: dict[str, Any], value: Real | None = None, refine: Narrower | None = None) -> None:
        self._document = document
        self._value = value
        self._refine = refine

    @property
    def value(self) -> Real:
        """Where it is."""
        if self._value is None:
            self._value = Real._from_document(self._document, self._refine)
        return self._value

    @property
    def causes(self) -> frozenset[Cause]:
        """Why stability ends; empty for ends of sets of which only the place is known."""
        text = self._document.get("cause")
        return frozenset(Cause(cause) for cause in text.split("+")) if text else frozenset()

    @property
    def cause(self) -> str:
        """The causes in the program's words and order."""
        return str(self._document.get("cause") or "")

    @property
    def requirement(self) -> str | None:
        """Which requirement binds, where the loop has any."""
        return self._document.get("requirement")

    @property
    def closed(self) -> bool:
        """Whether the end belongs to the set."""
        return bool(self._document.get("closed"))

    @property
    def frequency_hz(self) -> float | None:
        """The frequency of the complex pair in hertz; with its sign, of one complex root."""
        return self._document.get("frequency_hz")

    @property
    def omega(self) -> float | None:
        """The same in radians per second."""
        return self._document.get("radians_per_second")

    @property
    def angle(self) -> float | None:
        """The angle of the pair in the z plane, in radians."""
        return self._document.get("angle")

    @property
    def frequency_enclosure(self) -> tuple[Fraction, Fraction] | None:
        """Certified bounds of the frequency in hertz."""
        bounds = self._document.get("frequency_enclosure")
        return None if bounds is None else (fraction(bounds[0]), fraction(bounds[1]))

    @property
    def margin_factor(self) -> str | None:
        """The end divided by the nominal value, in the program's digits."""
        return self._document.get("margin_factor")

    @property
    def db(self) -> float | None:
        """That factor in decibels."""
        return self._document.get("margin_db")

    def to_dict(self) -> dict[str, Any]:
        """The end as it stands in documents."""
        return dict(self._document)

    def __float__(self) -> float:
        return float(self.value)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, End) and self._document == other._document

    def __hash__(self) -> int:
        return hash((self.value, self.cause, self.closed))

    def __str__(self) -> str:
        return str(self._document["decimal"])

    def __repr__(self) -> str:
        return f"<End {self._document['decimal']}{': ' + self.cause if self.cause else ''}>"

    def __reduce__(self) -> tuple[Any, ...]:
        return End, (self._document, self._value, self._refine)


def end_at(value: Real, cause: str, closed: bool) -> End:
    """An end that no document has."""
    lower, upper = value.enclosure(12)
    own = value.exact
    document = {
        "decimal": value.decimal(12),
        "kind": value.kind,
        "exact": None if own is None else fraction_text(own),
        "enclosure": [fraction_text(lower), fraction_text(upper)],
        "polynomial": None if value.polynomial is None else [str(c) for c in value.polynomial],
        "cause": cause,
        "closed": closed,
    }
    if value.over is not None:
        document["over"] = value.over
    return End(document, value)


class Interval:
    """An interval; `None` is an end at infinity. Ends do not belong to it, unless they are `End.closed`.

    Examples
    --------
    >>> import jurist
    >>> i = jurist.Loop.drive().intervals("K_pwm")[0]
    >>> 100 in i, "551" in i, [round(x, 3) for x in i]
    (True, False, [0.038, 550.941])
    """

    __slots__ = ("lower", "upper")

    lower: End | None
    upper: End | None

    def __init__(self, lower: End | None, upper: End | None) -> None:
        self.lower = lower
        self.upper = upper

    def __contains__(self, x: Real | Exact) -> bool:
        value = x if isinstance(x, Real) else Real(x)
        low, high = self.lower, self.upper
        above = low is None or low.value < value or (low.closed and low.value == value)
        return above and (high is None or value < high.value or (high.closed and high.value == value))

    def __iter__(self) -> Iterator[float]:
        yield -math.inf if self.lower is None else float(self.lower)
        yield math.inf if self.upper is None else float(self.upper)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Interval) and (self.lower, self.upper) == (other.lower, other.upper)

    def __hash__(self) -> int:
        return hash((self.lower, self.upper))

    def __str__(self) -> str:
        left = "(-inf" if self.lower is None else f"{'[' if self.lower.closed else '('}{self.lower}"
        right = "inf)" if self.upper is None else f"{self.upper}{']' if self.upper.closed else ')'}"
        return f"{left}, {right}"

    def __repr__(self) -> str:
        return f"<Interval {self}>"

    def __reduce__(self) -> tuple[Any, ...]:
        return Interval, (self.lower, self.upper)

    def to_dict(self) -> dict[str, Any]:
        """The interval as it stands in documents."""
        side = [None if end is None else end.to_dict() for end in (self.lower, self.upper)]
        return {"lower": side[0], "upper": side[1]}
