"""The best gains within what is required."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from ._answers import Document
from ._curves import Map
from ._exact import fraction
from ._real import Real
from ._ship import Required


if TYPE_CHECKING:
    from matplotlib.axes import Axes


class Tune(Document):
    """The best gains of a loop, or that no gains meet what is required. It is true where some gains do.

    Examples
    --------
    >>> import jurist
    >>> loop = jurist.Loop.from_line("K/(s*(s+1)*(s+2))")
    >>> best = loop.tune("max decay", ["K"])
    >>> best
    <Tune max decay: 0.422649730810>
    >>> best.value.polynomial, best.at["K"].decimal(8), best.rounded["K"]
    ((2, -6, 3), '0.38490018', Fraction(2, 5))
    >>> bool(loop.tune(None, ["K"], decay="0.43")), loop.tune(None, ["K"], decay="0.43").conflict
    (False, ('decay >= 0.43',))
    """

    __slots__ = ()

    @property
    def document(self) -> dict[str, object]:
        """The document ``jurist/tune/1`` as plain values; `json` is its text."""
        found: dict[str, object] = self.to_dict()
        return found

    def certificate(self, timeout: float | None = None) -> str:
        """A certificate that `verify` re-checks with independent code.

        It says that no gains within the bounds meet what is required, or none that are better than a value.

        Examples
        --------
        >>> import jurist
        >>> loop = jurist.Loop.from_line("K/(s*(s+1)*(s+2))")
        >>> best = loop.tune("max K", ["K"], bounds={"K": (0, 100)})
        >>> jurist.verify(loop, best.certificate()).kind
        'tune'
        """
        if self._loop is None:
            raise ValueError("this answer does not know its question")
        return self._loop._file_of(self._words, "--certificate", timeout)

    def __bool__(self) -> bool:
        return self.feasible is True

    @property
    def feasible(self) -> bool | None:
        """Whether some gains meet what is required; `None` where it is open."""
        found: bool | None = self._document["feasible"]
        return found

    @property
    def objective(self) -> str:
        """What is to be best: ``max ki``, ``min radius``, ``none``."""
        return str(self._document["objective"])

    @property
    def free(self) -> tuple[str, ...]:
        """The gains."""
        return tuple(self._document["free"])

    @property
    def value(self) -> Real | None:
        """The best value, exactly; `None` where it is known in a bracket only, has no bound, or is none of an algebraic scale (a phase margin)."""
        return _real(self._part("optimum", "value"))

    @property
    def decimal(self) -> str | None:
        """The best value as a decimal, of a phase margin in degrees; `None` where `value` is not known exactly and where it has no bound."""
        found: str | None = self._part("optimum", "decimal")
        return found

    @property
    def unbounded(self) -> bool:
        """Whether the best value grows without end, or nothing limits it, as a delay margin of a loop that bears any delay."""
        return bool(self._part("optimum", "unbounded"))

    @property
    def at(self) -> dict[str, Real | tuple[Fraction, Fraction] | None]:
        """The gains at the best value: exactly, or between two numbers; `None` where one has no bound."""
        return {name: _place(found) for name, found in (self._part("optimum", "at") or {}).items()}

    @property
    def attained(self) -> bool | None:
        """Whether gains have the best value; they come as near to it as one likes else. `None` where nothing was to be best."""
        found: bool | None = self._part("optimum", "attained")
        return found

    @property
    def binding(self) -> tuple[str, ...]:
        """What binds at the best value."""
        return tuple(self._part("optimum", "binding") or ())

    @property
    def found(self) -> dict[str, Fraction] | None:
        """Gains that meet what is required; `None` where there are none."""
        return _numbers(self._part("found", "point"))

    @property
    def found_value(self) -> str | None:
        """What these have of the objective at least, rounded."""
        found: str | None = self._part("found", "value")
        return found

    @property
    def proved(self) -> str | None:
        """No gains have this value of the objective, rounded; `None` where the best value is exact or has no bound."""
        found: str | None = self._document["proved"]
        return found

    @property
    def rounded(self) -> dict[str, Fraction] | None:
        """The gains that are typed in: the shortest decimals within the loss."""
        return _numbers(self._document["rounded"])

    @property
    def loss_percent(self) -> str | None:
        """What these lose of the best value, in per cent, rounded; `None` where it is not a number."""
        found: str | None = self._document["loss_percent"]
        return found

    @property
    def requirements(self) -> tuple[Required, ...]:
        """What is required, and what the gains that are typed in have of it."""
        return tuple(Required(found["name"], found["required"], found["value"], found["met"]) for found in self._document["requirements"])

    @property
    def conflict(self) -> tuple[str, ...]:
        """Requirements and bounds that exclude each other; empty where there are gains."""
        return tuple(self._document["conflict"])

    @property
    def for_all(self) -> dict[str, tuple[Fraction, Fraction]]:
        """Names for all of whose values, from one to another, the gains are good."""
        return {found["name"]: (fraction(found["lower"]), fraction(found["upper"])) for found in self._document["for_all"]}

    def plot(self, ax: Axes | None = None, **kw: Any) -> Axes:
        """The gains that meet what is required, with those that are typed in, or were found, as a point; of two gains.

        Parameters
        ----------
        ax : matplotlib axes, optional
        **kw
            What `Map.plot` takes.
        """
        if len(self.free) != 2 or self._loop is None:
            raise ValueError("a picture needs two free gains")
        words, axes = self._map_words()
        asked = self._loop._asked_by(words)
        words += axes
        ax = Map(self._loop._document(words, asked), self._loop, tuple(words)).plot(ax, **kw)
        point = self.rounded or self.found
        if point is not None:
            x, y = (float(point[name]) for name in self.free)
            ax.plot([x], [y], marker="*", markersize=12, color="black", linestyle="none", label=repr(self)[1:-1])
        return ax

    def _map_words(self) -> tuple[list[str], list[str]]:
        """The question of the map, and its axes."""
        words, rest = ["map"], iter(self._words[1:])
        bounds: dict[str, str] = {}
        for word in rest:
            option, is_joined, value = word.partition("=")
            if option in ("--free", "--bound"):
                name, _, range = (value if is_joined else next(rest)).partition("=")
                bounds[name] = range or bounds.get(name, "")
            elif option not in ("--objective", "--gap", "--loss", "--for-all", "--robust"):
                words.append(word)
            elif option != "--robust" and not is_joined:
                next(rest)
        words += [f"--for-all={name}={low}..{high}" for name, (low, high) in self.for_all.items()]
        axes = [f"{name}={bounds[name]}" if bounds.get(name) else name for name in self.free]
        return words, ["-x", axes[0], "-y", axes[1]]

    def __repr__(self) -> str:
        if not self:
            return f"<Tune {self.objective}: {'open' if self.feasible is None else 'no gains'}>"
        if self.objective == "none":
            return "<Tune: some gains>"
        if self.decimal is not None:
            return f"<Tune {self.objective}: {self.decimal}>"
        if self.proved is not None:
            return f"<Tune {self.objective}: between {self.found_value} and {self.proved}>"
        return f"<Tune {self.objective}: without bound>"

    def __str__(self) -> str:
        return self.text()


def _real(found: Mapping[str, Any] | None) -> Real | None:
    return None if found is None else Real._from_document(dict(found), None)


def _place(found: Mapping[str, Any] | None) -> Real | tuple[Fraction, Fraction] | None:
    if found is None:
        return None
    low, high = (fraction(x) for x in found["enclosure"])
    return _real(found["value"]) or (low, high)


def _numbers(found: Mapping[str, Any] | None) -> dict[str, Fraction] | None:
    return None if found is None else {name: fraction(x) for name, x in found.items()}
