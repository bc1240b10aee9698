"""Answers that are drawn: maps, loci, time responses."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Any

from ._answers import Document, PointVerdict
from ._exact import Exact, fraction

if TYPE_CHECKING:
    from matplotlib.axes import Axes


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

    def certificate(self, timeout: float | None = None) -> str:
        """A certificate that `verify` re-checks with independent code."""
        if self._loop is None:
            raise ValueError("this answer does not know its question")
        return self._loop._file_of(self._words, "--certificate", timeout)

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

    def plot(self, ax: Axes | None = None, *, x: Any = None, y: Any = None, columns: int = 160, **kw: Any) -> Axes:
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



class Body(Document):
    """The stable points in three parameters, by exact maps of two of them at values of the third.

    Examples
    --------
    >>> import jurist
    >>> loop = jurist.Loop.characteristic(
    ...     "(z^2 + a*z + b)*(z - c)", time="discrete", parameters={"a": 0, "b": 0, "c": 0}
    ... )
    >>> body = loop.body("a", "b", "c", "-3/2", "3/2", 4)
    >>> [(str(value), len(body.regions(k))) for k, value in enumerate(body.values)]
    [('-3/2', 0), ('-1/2', 1), ('1/2', 1), ('3/2', 0)]
    >>> body.stretches[0]["lower"]["none"], body.verdict(0, 0, "1/2").verdict
    ('-1', <Verdict.STABLE: 'stable'>)
    """

    __slots__ = ()

    @property
    def axes(self) -> tuple[str, str, str]:
        """The parameters; the slices are at values of the third."""
        x, y, z = (str(self._document[key]) for key in ("x", "y", "z"))
        return x, y, z

    @property
    def values(self) -> tuple[Fraction, ...]:
        """The values of the third parameter."""
        return tuple(fraction(piece["at"]) for piece in self.slices)

    @property
    def slices(self) -> tuple[dict[str, Any], ...]:
        """The slices as they stand in the document: the keys of a map beside the value."""
        return tuple(self._document["slices"])

    def regions(self, number: int) -> tuple[dict[str, Any], ...]:
        """The stable regions of a slice, counted from 0."""
        return tuple(self.slices[number]["regions"] or ())

    @property
    def extremes(self) -> dict[str, Any] | None:
        """The least and the greatest values of the first two over the slices; `None` where no slice has stable points."""
        found: dict[str, Any] | None = self._document["extremes"]
        return found

    @property
    def stretches(self) -> tuple[dict[str, Any], ...]:
        """Where slices with stable points follow each other, and brackets of where these begin and end."""
        return tuple(self._document["stretches"])

    def verdict(self, x: Exact, y: Exact, z: Exact) -> PointVerdict:
        """The verdict at a point, also between two slices."""
        assert self._loop is not None
        at = dict(zip(self.axes, (x, y, z)))
        return self._loop.verdict({**self.point, **at}, **self._loop._region_by(self._words))

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
        return self._curves("branches")

    @property
    def beyond(self) -> list[tuple[Any, Any]]:
        """The same of a gain outside of the range: from the poles of the open loop, and to its zeros."""
        return self._curves("beyond")

    def _curves(self, key: str) -> list[tuple[Any, Any]]:
        import numpy

        return [(numpy.array(b["values"], dtype=float), _complex(b["roots"])) for b in self._document[key]]

    @property
    def poles(self) -> Any:
        """The poles of the open loop, each once, an array; ``None`` where the parameter is no gain."""
        points = self._document["poles"]
        return None if points is None else _complex(points)

    @property
    def zeros(self) -> Any:
        """The zeros of the open loop, each once, an array; ``None`` where the parameter is no gain."""
        points = self._document["zeros"]
        return None if points is None else _complex(points)

    @property
    def crossings(self) -> tuple[dict[str, Any], ...]:
        """Where roots cross the boundary: the parameter, the points, and what a picture says there."""
        return tuple(self._document["crossings"])

    def plot(self, ax: Axes | None = None, *, grid: bool = True, **kw: Any) -> Axes:
        """Draws the branches, the boundary and the crossings on it, poles and zeros; returns the Axes."""
        from ._plot import plot_locus

        return plot_locus(self, ax, grid, kw)


def _float(x: float | None) -> float:
    return float("nan") if x is None else x


def _complex(points: list[list[float | None]]) -> Any:
    import numpy

    return numpy.array([complex(_float(re), _float(im)) for re, im in points], dtype=complex)


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

    def is_sampled(self, name: str) -> bool:
        """Whether each value of a signal holds until the next instant; else it is continuous in between."""
        return next((bool(s["sampled"]) for s in self._document["signals"] if s["name"] == name), False)

    def to_control(self) -> Any:
        """As python-control's `TimeResponseData`."""
        import control
        import numpy

        values = numpy.array([self[name] for name in self.names])
        return control.TimeResponseData(self.time, values, output_labels=self.names, title=self.title, issiso=False)

    def plot(self, ax: Axes | None = None, *, signals: list[str] | None = None, **kw: Any) -> Axes:
        """Draws signals over time, the loop's outputs where none are named; returns the Axes."""
        from ._plot import plot_simulation

        return plot_simulation(self, ax, signals, kw)
