"""Stable sets: finite unions of intervals with exact ends, and exact set operations on them."""

from __future__ import annotations

import enum
import html
import json
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from fractions import Fraction
from typing import TYPE_CHECKING, Any, Literal

from ._exact import Exact, exact, fraction, fraction_text
from ._real import Real

if TYPE_CHECKING:
    from . import _jurist
    from ._loop import Loop


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
    S0 = "s=0"
    INFINITY = "infinity"
    POLE = "pole"
    NEUTRAL = "neutral"
    DOMAIN = "domain"


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

    def __init__(self, document: dict[str, Any], value: Real | None = None, refine: Any = None) -> None:
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
        """The frequency of the complex pair in hertz."""
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
        return End, (self._document, self._value)


def _end_at(value: Real, cause: str, closed: bool) -> End:
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


class StableSet(Sequence[Interval]):
    """For which values of a parameter a loop is stable: a finite union of intervals, exact.

    It is a sequence of intervals in ascending order; ``x in s`` asks for a number. ``&``, ``|``, ``-``, ``^`` and ``~`` (inside the
    parameter's domain) are exact set operations; their results know no certificate.

    Examples
    --------
    >>> import jurist
    >>> loop = jurist.Loop.drive()
    >>> s = loop.intervals("K_pwm")
    >>> s
    <StableSet K_pwm: (0.0381005333483, 550.941166687)>
    >>> 0.04 in s, 0.03 in s, len(s)
    (True, False, 1)
    >>> both = s & loop.intervals("K_pwm", {"T": "2e-4"})
    >>> print(both)
    (0.0382833039581, 274.935875780)
    >>> print(~s)
    (0, 0.0381005333483], [550.941166687, inf)
    >>> (s - both) | both == s
    True
    """

    __slots__ = ("_answer", "_asked", "_document", "_intervals", "_loop", "_text")

    def __init__(
        self,
        document: dict[str, Any],
        *,
        text: str | None = None,
        loop: Loop | None = None,
        asked: dict[str, Any] | None = None,
        answer: _jurist.Answered | None = None,
    ) -> None:
        self._document = document
        self._text = text
        self._loop = loop
        self._asked = asked
        self._answer = answer
        self._intervals: tuple[Interval, ...] | None = None

    @property
    def intervals(self) -> tuple[Interval, ...]:
        """The intervals in ascending order."""
        if self._intervals is None:
            out = []
            for k, i in enumerate(self._document["stable"]):
                lower, upper = (None if i[side] is None else End(i[side], None, self._refiner(k, side)) for side in ("lower", "upper"))
                out.append(Interval(lower, upper))
            self._intervals = tuple(out)
        return self._intervals

    def _refiner(self, k: int, side: str) -> Callable[[int], tuple[Fraction, Fraction]] | None:
        """Narrower bounds of an end: the engine's answer with more digits."""
        if self._loop is None:
            return None

        def refine(digits: int) -> tuple[Fraction, Fraction]:
            lower, upper = json.loads(self._answered().json(digits))["stable"][k][side]["enclosure"]
            return fraction(lower), fraction(upper)

        return refine

    @property
    def parameter(self) -> str:
        """What it is a set of values of."""
        return str(self._document["parameter"])

    @property
    def unit(self) -> str | None:
        """The parameter's unit."""
        return self._document.get("unit")

    @property
    def nominal(self) -> Fraction | None:
        """The parameter's nominal value."""
        text = self._document.get("nominal")
        return None if text is None else fraction(text)

    @property
    def domain(self) -> tuple[Fraction | None, Fraction | None]:
        """Where the parameter may lie, an open interval."""
        bounds = self._document["domain"]
        lower, upper = (None if bounds[side] is None else fraction(bounds[side]) for side in ("lower", "upper"))
        return lower, upper

    @property
    def point(self) -> Mapping[str, Fraction]:
        """The values of all other parameters."""
        return {name: fraction(value) for name, value in self._document["set"].items()}

    @property
    def title(self) -> str:
        """The model's title."""
        return str(self._document.get("title") or "")

    @property
    def undecided(self) -> list[dict[str, Any]]:
        """Brackets in which a touch could not be told from a crossing; mostly none."""
        return list(self._document.get("undecided") or [])

    def __len__(self) -> int:
        return len(self._document["stable"])

    def __getitem__(self, i: Any) -> Any:
        return self.intervals[i]

    def __iter__(self) -> Iterator[Interval]:
        return iter(self.intervals)

    def __contains__(self, x: object) -> bool:
        if isinstance(x, Interval):
            raise TypeError("a stable set contains numbers; compare intervals by ==")
        value = x if isinstance(x, Real) else Real(x)
        return any(value in i for i in self.intervals)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, StableSet):
            return NotImplemented
        return self.parameter == other.parameter and not any(_membership([self, other], lambda a, b: a != b)[1])

    def __hash__(self) -> int:
        return hash((self.parameter, tuple(end.value for i in self.intervals for end in (i.lower, i.upper) if end)))

    def _combined(self, other: object, rule: Callable[[bool, bool], bool]) -> StableSet:
        if not isinstance(other, StableSet):
            raise TypeError(f"{type(other).__name__} is no stable set")
        if other.parameter != self.parameter:
            raise ValueError(f"sets of '{self.parameter}' and of '{other.parameter}' are not combined")
        return self._derived([self, other], rule)

    def __and__(self, other: StableSet) -> StableSet:
        return self._combined(other, lambda a, b: a and b)

    def __or__(self, other: StableSet) -> StableSet:
        return self._combined(other, lambda a, b: a or b)

    def __sub__(self, other: StableSet) -> StableSet:
        return self._combined(other, lambda a, b: a and not b)

    def __xor__(self, other: StableSet) -> StableSet:
        return self._combined(other, lambda a, b: a != b)

    def __invert__(self) -> StableSet:
        bounds = self._document["domain"]
        ends = [None if bounds[side] is None else {**_end_at(Real(bounds[side]), "domain", False).to_dict()} for side in ("lower", "upper")]
        whole = StableSet({**self._shared(), "stable": [{"lower": ends[0], "upper": ends[1]}]})
        return whole - self

    def _shared(self) -> dict[str, Any]:
        return {key: value for key, value in self._document.items() if key not in ("schema", "stable")}

    def _derived(self, sets: list[StableSet], rule: Callable[[bool, bool], bool]) -> StableSet:
        points, member, causes = _pieces(sets, rule)
        stable = []
        start: End | None | Literal[False] = False
        # Pieces: gap 0, point 0, gap 1, point 1, ..., gap n.
        for k, inside in enumerate(member):
            point = (k - 1) // 2 if k % 2 else None
            if inside and start is False:
                if point is not None:
                    start = _end_at(points[point], causes[point], True)
                else:
                    start = None if k == 0 else _end_at(points[k // 2 - 1], causes[k // 2 - 1], False)
            elif not inside and start is not False:
                if point is not None:
                    end = _end_at(points[point], causes[point], False)
                else:
                    end = _end_at(points[k // 2 - 1], causes[k // 2 - 1], True)
                stable.append(Interval(start, end).to_dict())
                start = False
        if start is not False:
            stable.append(Interval(start, None).to_dict())
        return StableSet({**self._shared(), "stable": stable})

    def nearest_end(self, x: Exact | None = None) -> End:
        """The end that is nearest to a value, or to the nominal one.

        Raises
        ------
        ValueError
            Where there is no end, or no nominal value and none is given.

        Examples
        --------
        >>> import jurist
        >>> print(jurist.Loop.drive().intervals("K_pwm").nearest_end())
        0.0381005333483
        """
        value = self.nominal if x is None else exact(x)
        if value is None:
            raise ValueError(f"'{self.parameter}' has no nominal value: name one")
        ends = [end for i in self.intervals for end in (i.lower, i.upper) if end is not None]
        if not ends:
            raise ValueError("the set has no ends")
        return min(ends, key=lambda end: abs(end.value - value))

    def sample(self, n: int = 1) -> list[Fraction]:
        """Simple rational numbers inside: one for each interval first, then more between them.

        Examples
        --------
        >>> import jurist
        >>> jurist.Loop.drive().intervals("K_pwm").sample(3)
        [Fraction(1, 1), Fraction(1, 2), Fraction(2, 1)]
        """
        gaps: list[tuple[Real | None, Real | None]] = [
            (i.lower.value if i.lower else None, i.upper.value if i.upper else None) for i in self.intervals
        ]
        out: list[Fraction] = []
        while gaps and len(out) < max(n, len(self)):
            lower, upper = gaps.pop(0)
            middle = _simplest(lower, upper)
            if middle is None:
                continue
            out.append(middle)
            gaps += [(lower, Real(middle)), (Real(middle), upper)]
        return out

    def to_dict(self) -> dict[str, Any]:
        """The document of ``jurist intervals --json``."""
        copy: dict[str, Any] = json.loads(json.dumps(self._document))
        return copy

    def json(self, digits: int | None = None) -> str:
        """That document as the program writes it, byte for byte; with other digits where they are given."""
        if digits is not None and self._known() is not None:
            return self._answered().json(digits)
        if self._text is not None:
            return self._text
        return json.dumps(self._document, indent=2, ensure_ascii=False) + "\n"

    def _known(self) -> Loop | None:
        return self._loop

    def _answered(self) -> _jurist.Answered:
        """The engine's answer, asked again where this set came from a file or another process."""
        if self._answer is None:
            if self._loop is None or self._asked is None:
                raise ValueError("this set is not the engine's own answer: it has no certificate")
            self._answer = self._loop._core.intervals(self._asked, self.parameter)[0]
        return self._answer

    def certificate(self, timeout: float | None = None) -> str:
        """A certificate that `verify` and ``jurist verify`` re-check with independent code.

        Examples
        --------
        >>> import jurist
        >>> loop = jurist.Loop.drive()
        >>> proved = jurist.verify(loop, loop.intervals("T").certificate())
        >>> proved.kind
        'intervals'
        """
        return self._answered().certificate(timeout)

    def smt2(self, timeout: float | None = None) -> str:
        """The statement as SMT-LIB 2: a solver answers ``unsat`` if it is true."""
        return self._answered().smt2(timeout) or ""

    def coq(self, timeout: float | None = None) -> str:
        """The statement as a theorem for Coq."""
        return self._answered().coq(timeout) or ""

    def text(self, digits: int = 12) -> str:
        """The program's text."""
        return self._answered().text(digits)

    def rows(self) -> list[dict[str, Any]]:
        """One row for each end, as plain values."""
        out = []
        for k, i in enumerate(self.intervals):
            for side, end in (("lower", i.lower), ("upper", i.upper)):
                value = end.value if end is not None else None
                own = value.exact if value is not None else None
                out.append(
                    {
                        "parameter": self.parameter,
                        "interval": k,
                        "side": side,
                        "value": (-math.inf if side == "lower" else math.inf) if value is None else float(value),
                        "decimal": str(end) if end is not None else None,
                        "exact": None if own is None else fraction_text(own),
                        "causes": end.cause if end is not None else None,
                        "frequency_hz": end.frequency_hz if end is not None else None,
                        "closed": end.closed if end is not None else False,
                    }
                )
        return out

    def to_frame(self) -> Any:
        """A pandas frame with one row for each end.

        Examples
        --------
        >>> import jurist
        >>> jurist.Loop.drive().intervals("K_pwm").to_frame()[["side", "decimal", "causes"]]
            side          decimal        causes
        0  lower  0.0381005333483  complex pair
        1  upper    550.941166687  complex pair
        """
        import pandas

        return pandas.DataFrame(self.rows())

    def __arrow_c_stream__(self, requested_schema: object = None) -> object:
        import pyarrow

        texts = ("parameter", "side", "decimal", "exact", "causes")
        kinds = {**dict.fromkeys(texts, pyarrow.string()), "interval": pyarrow.int32(), "closed": pyarrow.bool_()}
        names = ("parameter", "interval", "side", "value", "decimal", "exact", "causes", "frequency_hz", "closed")
        schema = pyarrow.schema([(name, kinds.get(name, pyarrow.float64())) for name in names])
        return pyarrow.Table.from_pylist(self.rows(), schema=schema).__arrow_c_stream__(requested_schema)

    def plot(self, ax: Any = None, *, scale: Literal["auto", "linear", "log"] = "auto", **kw: Any) -> Any:
        """Draws the set on a number line.

        Parameters
        ----------
        ax : matplotlib Axes, optional
            Where; the current axes if not given.
        scale : {"auto", "linear", "log"}
            Of the axis; by default logarithmic over two decades of positive ends and more.
        **kw
            For the lines.

        Returns
        -------
        matplotlib Axes
        """
        from ._plot import plot_set

        return plot_set(self, ax, scale, kw)

    def __str__(self) -> str:
        return ", ".join(str(i) for i in self.intervals) if len(self) else "never stable"

    def __repr__(self) -> str:
        return f"<StableSet {self.parameter}: {self}>"

    def _repr_html_(self) -> str:
        from ._html import set_html

        return set_html(self)

    def _repr_latex_(self) -> str:
        name = self.parameter.replace("_", r"\_")
        body = r" \cup ".join(str(i).replace("-inf", r"-\infty").replace("inf", r"\infty") for i in self.intervals)
        return f"$\\mathrm{{{name}}} \\in {body}$" if body else f"$\\mathrm{{{name}}} \\in \\varnothing$"

    def __reduce__(self) -> tuple[Any, ...]:
        return _set_again, (self._document, self._text, self._loop, self._asked)


def _set_again(document: dict[str, Any], text: str | None, loop: Loop | None, asked: dict[str, Any] | None) -> StableSet:
    return StableSet(document, text=text, loop=loop, asked=asked)


def _membership(sets: list[StableSet], rule: Callable[[bool, bool], bool]) -> tuple[list[Real], list[bool]]:
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


def _pieces(sets: list[StableSet], rule: Callable[[bool, bool], bool]) -> tuple[list[Real], list[bool], list[str]]:
    points, member = _membership(sets, rule)
    order = list(Cause)
    causes = []
    for point in points:
        found = {c for s in sets for i in s for end in (i.lower, i.upper) if end and end.value == point for c in end.causes}
        causes.append("+".join(c.value for c in sorted(found, key=order.index)))
    return points, member, causes


def _simplest(lower: Real | None, upper: Real | None) -> Fraction | None:
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


def escaped(text: object) -> str:
    """Text for a page."""
    return html.escape(str(text))
