"""Answers other than stable sets: each is a document of the program with names for its parts."""

from __future__ import annotations

import enum
import json
from collections.abc import Mapping
from fractions import Fraction
from typing import TYPE_CHECKING, Any, NamedTuple

from ._exact import fraction
from ._ends import End, Interval
from ._narrow import OfAnswer
from ._real import Real
from ._sets import StableSet

if TYPE_CHECKING:
    from ._loop import Loop

_WITHOUT_DIGITS = ("verdict", "locus", "simulate", "bode", "nyquist")
"""Commands that take no ``--digits``."""


class Verdict(str, enum.Enum):
    """What is said of a loop at a point.

    Examples
    --------
    >>> import jurist
    >>> jurist.Loop.drive().verdict().verdict
    <Verdict.STABLE: 'stable'>
    """

    STABLE = "stable"
    MARGINAL = "marginal"
    UNSTABLE = "unstable"
    UNDEFINED = "undefined"


class Document:
    """An answer as the program writes it under ``--json``."""

    __slots__ = ("_document", "_loop", "_text", "_words")

    def __init__(self, text: str, loop: Loop | None = None, words: tuple[str, ...] = ()) -> None:
        self._text = text
        self._document: dict[str, Any] = json.loads(text)
        self._loop = loop
        self._words = words

    def json(self) -> str:
        """The document, byte for byte."""
        return self._text

    def to_dict(self) -> dict[str, Any]:
        """The document as plain values."""
        copy: dict[str, Any] = json.loads(self._text)
        return copy

    def text(self, digits: int = 12) -> str:
        """The program's text."""
        if self._loop is None or not self._words:
            raise ValueError("this answer does not know its question")
        has_digits = self._words[0] not in _WITHOUT_DIGITS
        words = [*self._words, "--digits", str(digits)] if has_digits else [w for w in self._words if w != "--json"]
        return self._loop._core.command(words)[1]

    def _question(self) -> Any:
        """What the same answer is known by."""
        return None if self._loop is None else (self._loop.to_toml(), self._words)

    def _part(self, *path: Any) -> Any:
        """What stands at a place of the document; `None` where a part before it is `null`."""
        found: Any = self._document
        for key in path:
            if found is None:
                return None
            found = found[key]
        return found

    def _bounds_at(self, path: tuple[Any, ...], digits: int) -> tuple[Fraction, Fraction]:
        """Bounds of the number at a place of the document: it is written again with so many digits."""
        if self._loop is None:
            raise ValueError("this answer does not know its question")
        found = json.loads(self._loop._document(self._words, self._loop._asked(digits=digits)))
        for key in path:
            found = found[key]
        lower, upper = found["enclosure"]
        return fraction(lower), fraction(upper)

    def _narrowed(self, *path: Any) -> OfAnswer | None:
        return None if self._loop is None else OfAnswer(self, path)

    def _number(self, *path: Any) -> Real | None:
        """The number at a place of the document."""
        document = self._part(*path)
        return None if document is None else Real._from_document(document, self._narrowed(*path))

    @property
    def point(self) -> Mapping[str, Fraction]:
        """The values of the parameters that have one."""
        return {name: fraction(value) for name, value in self._document.get("set", {}).items()}

    @property
    def title(self) -> str:
        """The model's title."""
        return str(self._document.get("title") or "")

    def __eq__(self, other: object) -> bool:
        return type(other) is type(self) and isinstance(other, Document) and other._text == self._text

    def __hash__(self) -> int:
        return hash(self._text)

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.title}>" if self.title else f"<{type(self).__name__}>"

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self._text, self._loop, self._words)


class PointVerdict(Document):
    """The verdict at a point, with the exact number of roots in each place. It is true where the loop is stable.

    Examples
    --------
    >>> import jurist
    >>> loop = jurist.Loop.drive()
    >>> loop.verdict({"K_pwm": 555})
    <PointVerdict unstable: 4 inside, 2 outside>
    >>> bool(loop.verdict())
    True
    """

    __slots__ = ()

    @property
    def verdict(self) -> Verdict:
        """Stable, marginal, unstable or undefined."""
        return Verdict(self._document["verdict"])

    @property
    def degree(self) -> int:
        """The degree of the characteristic polynomial in all parameters."""
        return int(self._document["degree"])

    @property
    def inside(self) -> int | None:
        """Roots strictly inside; `None` where the loop is undefined."""
        return self._count("inside")

    @property
    def on(self) -> int | None:
        """Roots on the boundary."""
        return self._count("on")

    @property
    def outside(self) -> int | None:
        """Finite roots outside."""
        return self._count("outside")

    @property
    def infinite(self) -> int | None:
        """Roots at infinity: the degree is lost by so much."""
        return self._count("infinite")

    @property
    def requirements(self) -> list[dict[str, Any]]:
        """What is required beyond stability, as it stands in the document: name, what is required, what there is, whether it is met."""
        return list(self._document.get("requirements") or [])

    def _count(self, name: str) -> int | None:
        value = self._document[name]
        return None if value is None else int(value)

    def certificate(self, timeout: float | None = None) -> str:
        """A certificate that `verify` re-checks with independent code."""
        if self._loop is None:
            raise ValueError("this answer does not know its question")
        asked = self._loop._asked(self.point, timeout=timeout, **self._loop._region_by(self._words))
        if self._loop._has_requirements(asked):
            return self._loop._file_of(self._words, "--certificate", timeout)
        return self._loop._core.verdict(asked)[0].certificate(timeout)

    def __bool__(self) -> bool:
        return self.verdict is Verdict.STABLE

    def __str__(self) -> str:
        counts = [f"{getattr(self, name)} {name}" for name in ("inside", "on", "outside", "infinite") if getattr(self, name)]
        return f"{self.verdict.value}{': ' + ', '.join(counts) if counts else ''}"

    def __repr__(self) -> str:
        return f"<PointVerdict {self}>"


class Analysis(Document):
    """The verdict at the nominal point, and the stable set of each parameter.

    Examples
    --------
    >>> import jurist
    >>> a = jurist.Loop.drive().analyze()
    >>> a.verdict, a.sets["T"]
    (<PointVerdict stable: 6 inside>, <StableSet T: (0, 0.000496939745107)>)
    """

    __slots__ = ()

    @property
    def verdict(self) -> PointVerdict | None:
        """At the nominal point; `None` where a value is missing."""
        document = self._document["verdict"]
        return None if document is None else PointVerdict(json.dumps(document), self._loop, ("verdict", "-", *self._words[2:]))

    @property
    def sets(self) -> Mapping[str, StableSet]:
        """By parameter."""
        out = {}
        for document in self._document["parameters"]:
            asked = self._loop._asked_by(self._words) if self._loop is not None else None
            words = ("intervals", *self._words[1:], "--param", document["parameter"])
            out[document["parameter"]] = StableSet(document, loop=self._loop, asked=asked, words=words if asked and asked["require"] else ())
        return out

    def to_frame(self) -> Any:
        """A pandas frame with one row for each end."""
        import pandas

        return pandas.DataFrame([row for s in self.sets.values() for row in s.rows()])

    def __str__(self) -> str:
        return "\n".join([str(self.verdict), *(f"{name}: {s}" for name, s in self.sets.items())])

    def _repr_html_(self) -> str:
        from ._html import escaped, set_html

        return f"<div><b>{escaped(self.verdict)}</b>{''.join(set_html(s) for s in self.sets.values())}</div>"


class Condition(NamedTuple):
    """A condition of the classical table, and where it holds by itself."""

    name: str
    solution: tuple[Interval, ...] | bool


class Table(Document):
    """The table of Jury (discrete time) or Routh (continuous time) and its conditions.

    Examples
    --------
    >>> import jurist
    >>> loop = jurist.Loop.characteristic("z^2 - z + K/2", time="discrete", parameters={"K": 1})
    >>> [(c.name, str(c.solution[0])) for c in loop.jury("K").conditions]
    [('Q(1) > 0', '(0, inf)'), ('(-1)^2*Q(-1) > 0', '(-4, inf)'), ('|a_0| < a_2', '(-2, 2)')]
    """

    __slots__ = ()

    @property
    def name(self) -> str:
        """``Jury`` or ``Routh``."""
        return str(self._document["table"])

    @property
    def rows(self) -> list[dict[str, Any]]:
        """The rows as they stand in the document."""
        return list(self._document["rows"] or [])

    @property
    def conditions(self) -> list[Condition]:
        """Each with the set where it holds; without a parameter whether it holds."""
        out = []
        for c in self._document["conditions"] or []:
            if "solution" in c:
                solution: tuple[Interval, ...] | bool = _intervals(c["solution"])
            else:
                solution = bool(c["holds"])
            out.append(Condition(c["name"], solution))
        return out

    @property
    def intersection(self) -> tuple[Interval, ...] | None:
        """Where all conditions hold; `None` without a parameter."""
        found = self._document.get("intersection")
        return None if found is None else _intervals(found)

    def __str__(self) -> str:
        return self.text().rstrip()


def _intervals(documents: list[dict[str, Any]]) -> tuple[Interval, ...]:
    ends = [[None if i[side] is None else End(i[side]) for side in ("lower", "upper")] for i in documents]
    return tuple(Interval(lower, upper) for lower, upper in ends)


class Proved(NamedTuple):
    """What a certificate proves."""

    statement: str
    kind: str
