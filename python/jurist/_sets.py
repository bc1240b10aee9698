"""Stable sets: finite unions of intervals with exact ends, and exact set operations on them."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from fractions import Fraction
from typing import TYPE_CHECKING, Any, Literal, overload

from ._combine import membership, pieces, simplest
from ._ends import End, Interval, end_at
from ._exact import Exact, exact, fraction, fraction_text
from ._narrow import Narrower, OfAnswer
from ._real import Real

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from . import _jurist
    from ._loop import Loop


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

    __slots__ = ("_answer", "_asked", "_document", "_intervals", "_loop", "_refine", "_text", "_words")

    def __init__(
        self,
        document: dict[str, Any],
        *,
        text: str | None = None,
        loop: Loop | None = None,
        asked: dict[str, Any] | None = None,
        answer: _jurist.Answered | None = None,
        words: tuple[str, ...] = (),
        refine: Callable[[int, str], Narrower | None] | None = None,
        intervals: tuple[Interval, ...] | None = None,
    ) -> None:
        self._document = document
        self._text = text
        self._loop = loop
        self._asked = asked
        self._answer = answer
        # With words, the program's command is asked again and not the engine's answer.
        self._words = words
        self._refine = refine
        self._intervals = intervals

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

    def _refiner(self, k: int, side: str) -> Narrower | None:
        """How an end gets narrower bounds."""
        if self._refine is not None:
            return self._refine(k, side)
        return None if self._loop is None else OfAnswer(self, ("stable", k, side))

    def _bounds_at(self, path: tuple[Any, ...], digits: int) -> tuple[Fraction, Fraction]:
        """Narrower bounds of an end: the answer with more digits."""
        found = json.loads(self.json(digits))
        for key in path:
            found = found[key]
        lower, upper = found["enclosure"]
        return fraction(lower), fraction(upper)

    def _question(self) -> Any:
        """What the same answer is known by."""
        if self._loop is None:
            return None
        asked = {key: value for key, value in (self._asked or {}).items() if key not in ("timeout", "progress", "digits")}
        return self._loop.to_toml(), self.parameter, repr(asked)

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
        """Where the parameter may lie, without the ends but for those in `domain_closed`."""
        bounds = self._document["domain"]
        lower, upper = (None if bounds[side] is None else fraction(bounds[side]) for side in ("lower", "upper"))
        return lower, upper

    @property
    def domain_closed(self) -> tuple[bool, bool]:
        """Which ends of the domain belong to it."""
        closed = self._document.get("domain_closed") or {}
        return closed.get("lower", False), closed.get("upper", False)

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

    @overload
    def __getitem__(self, i: int) -> Interval: ...
    @overload
    def __getitem__(self, i: slice) -> tuple[Interval, ...]: ...
    def __getitem__(self, i: int | slice) -> Interval | tuple[Interval, ...]:
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
        return self.parameter == other.parameter and not any(membership([self, other], lambda a, b: a != b)[1])

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
        sides = zip(("lower", "upper"), self.domain_closed)
        ends = [None if bounds[side] is None else {**end_at(Real(bounds[side]), "domain", closed).to_dict()} for side, closed in sides]
        whole = StableSet({**self._shared(), "stable": [{"lower": ends[0], "upper": ends[1]}]})
        return whole - self

    def _shared(self) -> dict[str, Any]:
        return {key: value for key, value in self._document.items() if key not in ("schema", "stable")}

    def _derived(self, sets: list[StableSet], rule: Callable[[bool, bool], bool]) -> StableSet:
        points, member, causes = pieces(sets, rule)
        stable: list[Interval] = []
        start: End | None | Literal[False] = False
        # Pieces: gap 0, point 0, gap 1, point 1, ..., gap n.
        for k, inside in enumerate(member):
            point = (k - 1) // 2 if k % 2 else None
            if inside and start is False:
                if point is not None:
                    start = end_at(points[point], causes[point], True)
                else:
                    start = None if k == 0 else end_at(points[k // 2 - 1], causes[k // 2 - 1], False)
            elif not inside and start is not False:
                if point is not None:
                    end = end_at(points[point], causes[point], False)
                else:
                    end = end_at(points[k // 2 - 1], causes[k // 2 - 1], True)
                stable.append(Interval(start, end))
                start = False
        if start is not False:
            stable.append(Interval(start, None))
        document = {**self._shared(), "stable": [i.to_dict() for i in stable]}
        return StableSet(document, intervals=tuple(stable))

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
            middle = simplest(lower, upper)
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
        if digits is not None and self._loop is not None:
            if self._words:
                return self._loop._document(self._words, self._loop._asked(digits=digits))
            return self._answered().json(digits)
        if self._text is not None:
            return self._text
        return json.dumps(self._document, indent=2, ensure_ascii=False) + "\n"

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
        return self._written("--certificate", timeout) or self._answered().certificate(timeout)

    def _written(self, option: str, timeout: float | None) -> str | None:
        """What the program's command writes into a file, where it is the command that was asked."""
        if not self._words or self._loop is None:
            return None
        return self._loop._file_of(self._words, option, timeout)

    def smt2(self, timeout: float | None = None) -> str:
        """The statement as SMT-LIB 2: a solver answers ``unsat`` if it is true."""
        return self._written("--smt2", timeout) or self._answered().smt2(timeout) or ""

    def coq(self, timeout: float | None = None) -> str:
        """The statement as a theorem for Coq."""
        return self._written("--coq", timeout) or self._answered().coq(timeout) or ""

    def text(self, digits: int = 12) -> str:
        """The program's text."""
        if self._words and self._loop is not None:
            return self._loop._command([*self._words, "--digits", str(digits)], self._loop._asked())[0]
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

    def plot(self, ax: Axes | None = None, *, scale: Literal["auto", "linear", "log"] = "auto", **kw: Any) -> Axes:
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
        # Without a loop to ask again, the ends know by themselves how they are narrowed.
        own = self.intervals if self._loop is None else None
        return _set_again, (self._document, self._text, self._loop, self._asked, self._words, own)


def _set_again(
    document: dict[str, Any],
    text: str | None,
    loop: Loop | None,
    asked: dict[str, Any] | None,
    words: tuple[str, ...],
    intervals: tuple[Interval, ...] | None,
) -> StableSet:
    return StableSet(document, text=text, loop=loop, asked=asked, words=words, intervals=intervals)
