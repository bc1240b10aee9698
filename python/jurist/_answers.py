"""Answers other than stable sets: each is a document of the program with names for its parts."""

from __future__ import annotations

import enum
import json
from collections.abc import Mapping
from fractions import Fraction
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

from ._exact import Exact, fraction
from ._sets import End, Interval, StableSet

if TYPE_CHECKING:
    from . import _jurist
    from ._loop import Loop

D = TypeVar("D", bound="Document")


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
        words = [*self._words, "--digits", str(digits)] if self._words[0] != "verdict" else list(self._words)
        return self._loop._core.command(words)[1]

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

    def _count(self, name: str) -> int | None:
        value = self._document[name]
        return None if value is None else int(value)

    def certificate(self, timeout: float | None = None) -> str:
        """A certificate that `verify` re-checks with independent code."""
        if self._loop is None:
            raise ValueError("this answer does not know its question")
        asked = self._loop._asked({name: value for name, value in self.point.items()})
        asked["radius"], asked["decay"] = _region(self._words)
        return self._loop._core.verdict(asked)[0].certificate(timeout)

    def __bool__(self) -> bool:
        return self.verdict is Verdict.STABLE

    def __str__(self) -> str:
        counts = [f"{getattr(self, name)} {name}" for name in ("inside", "on", "outside", "infinite") if getattr(self, name)]
        return f"{self.verdict.value}{': ' + ', '.join(counts) if counts else ''}"

    def __repr__(self) -> str:
        return f"<PointVerdict {self}>"


def _region(words: tuple[str, ...]) -> tuple[str | None, str | None]:
    found = {name: None for name in ("radius", "decay")} | {
        word[2:].partition("=")[0]: word.partition("=")[2] for word in words if word.startswith(("--radius=", "--decay="))
    }
    return found["radius"], found["decay"]


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
            out[document["parameter"]] = StableSet(document, loop=self._loop, asked=asked)
        return out

    def to_frame(self) -> Any:
        """A pandas frame with one row for each end."""
        import pandas

        return pandas.DataFrame([row for s in self.sets.values() for row in s.rows()])

    def __str__(self) -> str:
        return "\n".join([str(self.verdict), *(f"{name}: {s}" for name, s in self.sets.items())])

    def _repr_html_(self) -> str:
        from ._html import set_html
        from ._sets import escaped

        return f"<div><b>{escaped(self.verdict)}</b>{''.join(set_html(s) for s in self.sets.values())}</div>"


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


class Map(Document):
    """The stable region in the plane of two parameters: an exact decomposition, or proved boxes of a window.

    Examples
    --------
    >>> import jurist
    >>> loop = jurist.Loop.characteristic("z^2 + a*z + b", time="discrete", parameters={"a": 0, "b": 0})
    >>> m = loop.map("a", "b")
    >>> len(m.regions), m.verdict(0, "1/2").verdict
    (1, <Verdict.STABLE: 'stable'>)
    """

    __slots__ = ()

    @property
    def x(self) -> str:
        """The first parameter."""
        return str(self._document["x"])

    @property
    def y(self) -> str:
        """The second parameter."""
        return str(self._document["y"])

    @property
    def is_exact(self) -> bool:
        """Whether it is the exact decomposition, and not boxes."""
        return "boxes" not in self._document

    @property
    def regions(self) -> tuple[dict[str, Any], ...]:
        """The stable regions as they stand in the document; empty for boxes."""
        return tuple(self._document.get("regions") or ())

    @property
    def boxes(self) -> tuple[dict[str, Any], ...]:
        """The boxes as they stand in the document; empty for an exact map."""
        return tuple(self._document.get("boxes") or ())

    def verdict(self, x: Exact, y: Exact) -> PointVerdict:
        """The verdict at a point of the plane."""
        assert self._loop is not None
        return self._loop.verdict({**self.point, self.x: x, self.y: y}, **self._loop._region_by(self._words))

    def plot(self, ax: Any = None, *, x: Any = None, y: Any = None, columns: int = 160, **kw: Any) -> Any:
        """Draws the stable region; every column of the picture is decided exactly.

        Parameters
        ----------
        ax : matplotlib Axes, optional
            Where; the current axes if not given.
        x, y : tuple of two numbers, optional
            The window.
        columns : int
            In so many places along the first axis.
        **kw
            For the filled area.

        Returns
        -------
        matplotlib Axes
        """
        from ._plot import plot_map

        return plot_map(self, ax, x, y, columns, kw)

    def __str__(self) -> str:
        return self.text().rstrip()


class Locus(Document):
    """The root locus of a parameter, in floating point, with the exact crossings of the boundary.

    Examples
    --------
    >>> import jurist
    >>> locus = jurist.Loop.drive().locus("K_pwm")
    >>> locus.parameter, len(locus.branches), round(locus.crossings[0]["value"], 6)
    ('K_pwm', 6, 550.941167)
    """

    __slots__ = ()

    @property
    def parameter(self) -> str:
        """What moves."""
        return str(self._document["parameter"])

    @property
    def branches(self) -> list[tuple[Any, Any]]:
        """Values of the parameter and complex roots, as arrays, branch by branch."""
        import numpy

        out = []
        for b in self._document["branches"]:
            points = numpy.array([[_float(re), _float(im)] for re, im in b["roots"]])
            out.append((numpy.array(b["values"], dtype=float), points[:, 0] + 1j * points[:, 1]))
        return out

    @property
    def crossings(self) -> tuple[dict[str, Any], ...]:
        """Where roots cross the boundary: the parameter, the points, and what a picture says there."""
        return tuple(self._document["crossings"])

    def plot(self, ax: Any = None, *, grid: bool = True, **kw: Any) -> Any:
        """Draws the branches, the boundary and the crossings on it; returns the Axes."""
        from ._plot import plot_locus

        return plot_locus(self, ax, grid, kw)


def _float(x: float | None) -> float:
    return float("nan") if x is None else x


class Simulation(Document):
    """A time response, in floating point.

    Examples
    --------
    >>> import jurist
    >>> r = jurist.Loop.drive().simulate(duration="0.01")
    >>> r.names[:2], len(r.time), len(r["omega"])
    (['i_a', 'omega'], 101, 101)
    """

    __slots__ = ()

    @property
    def time(self) -> Any:
        """The instants, an array."""
        import numpy

        return numpy.array(self._document["time"], dtype=float)

    @property
    def names(self) -> list[str]:
        """The signals."""
        return [s["name"] for s in self._document["signals"]]

    def __getitem__(self, name: str) -> Any:
        import numpy

        for s in self._document["signals"]:
            if s["name"] == name:
                return numpy.array(s["values"], dtype=float)
        raise KeyError(name)

    def unit(self, name: str) -> str | None:
        """The unit of a signal."""
        return next((s["unit"] for s in self._document["signals"] if s["name"] == name), None)

    def to_control(self) -> Any:
        """As python-control's `TimeResponseData`."""
        import control
        import numpy

        values = numpy.array([self[name] for name in self.names])
        return control.TimeResponseData(self.time, values, output_labels=self.names, title=self.title, issiso=False)

    def plot(self, ax: Any = None, *, signals: list[str] | None = None, **kw: Any) -> Any:
        """Draws signals over time; returns the Axes."""
        from ._plot import plot_simulation

        return plot_simulation(self, ax, signals, kw)


class Proved(NamedTuple):
    """What a certificate proves."""

    statement: str
    kind: str
