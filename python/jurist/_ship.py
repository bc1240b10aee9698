"""Controllers as they are stored and run."""

from __future__ import annotations

import json
import os
import tempfile
import warnings
from collections.abc import Mapping
from fractions import Fraction
from typing import TYPE_CHECKING, NamedTuple

from ._answers import Document, PointVerdict
from ._errors import JuristWarning, QuestionError, Undecided
from ._exact import fraction
from ._margins import Margins
from ._sets import StableSet
from ._tolerance import Tolerance

if TYPE_CHECKING:
    from ._loop import Loop


class Coefficient(NamedTuple):
    """A number of the controller: as it is written, and as it is stored.

    ``exact`` is a pair of bounds where the number is not rational. ``name``, ``integer`` and ``hex`` are `None` where the number is
    0, 1 or -1 by the structure and nothing is stored; ``integer`` is so in floating point too. ``hex`` has the stored bits.
    """

    name: str | None
    exact: Fraction | tuple[Fraction, Fraction]
    stored: Fraction
    integer: int | None
    hex: str | None


class NumberFormat(NamedTuple):
    """How numbers are stored; ``fraction`` (bits behind the point) and ``scale`` are `None` in floating point."""

    words: str
    bits: int
    fraction: int | None
    scale: int | None
    round: str


class Required(NamedTuple):
    """What is required of the stored loop, what it has of it, and whether that is enough."""

    name: str
    required: str
    value: str | None
    met: bool


class Fewest(NamedTuple):
    """How many bits behind the point are enough.

    From ``every_rounding`` bits on every rounding within half a unit holds, and at ``refuted`` bits some does not. Below, rounding to
    nearest holds at the numbers ``nearest``. Rounding down holds at the numbers ``floor`` and from ``floor_from`` on.
    """

    every_rounding: int | None
    refuted: int | None
    nearest: tuple[int, ...]
    floor: tuple[int, ...]
    floor_from: int | None


class SignalRange(NamedTuple):
    """How far the controller's input ``u`` or an inner signal goes.

    Its magnitude is at most ``bound``, of which ``rounding`` is the part of the rounding of inputs and signals. ``greatest`` are bounds of
    its greatest magnitude without rounding, ``limit`` is the greatest number of its format, and ``holds`` says whether it stays within;
    what is not known is `None`.
    """

    node: str
    bound: Fraction | None
    greatest: tuple[Fraction, Fraction] | None
    rounding: Fraction
    limit: Fraction | None
    holds: bool | None


class Ship(Document):
    """A controller as it is stored and run, in its loop. It is true where `holds` is.

    Examples
    --------
    >>> import jurist
    >>> b = jurist.LoopBuilder("discrete").block("controller", "r - y", "u", "(z/2 - 0.4999)/(z - 1)")
    >>> loop = b.block("plant", "u", "y", "1/10/(z - 9/10)").build(inputs=["r"], outputs=["y"])
    >>> ship = loop.ship("controller", format="Q2.12")
    >>> ship
    <Ship controller: marginal with 15 bits>
    >>> ship.exact_verdict.verdict.value, ship.changes[0]
    ('stable', 'integral action is lost: the numerator is 0 at z = 1, where the pole is')
    >>> bool(loop.ship("controller", format="Q2.13"))
    True
    """

    __slots__ = ("_every", "_rounded", "_shared")

    def __init__(
        self, text: str, loop: Loop | None = None, words: tuple[str, ...] = (), shared: tuple[str, ...] = (), rounded: str = "", every: str = ""
    ) -> None:
        super().__init__(text, loop, words)
        # The options of every question, and the models that the program writes beside its answer.
        self._shared = shared
        self._rounded = rounded
        self._every = every

    def __reduce__(self) -> tuple[type[Ship], tuple[str, Loop | None, tuple[str, ...], tuple[str, ...], str, str]]:
        return type(self), (self._text, self._loop, self._words, self._shared, self._rounded, self._every)

    def __bool__(self) -> bool:
        return self.holds is True

    @property
    def document(self) -> dict[str, object]:
        """The document ``jurist/ship/1`` as plain values; `json` is its text."""
        found: dict[str, object] = self.to_dict()
        return found

    @property
    def block(self) -> str:
        """The block that is the controller."""
        return str(self._document["block"])

    @property
    def realisation(self) -> str:
        """The order of operations: ``df1``, ``df2``, ``df2t``, ``sos``, ``parallel``, ``delta`` or ``state``."""
        return str(self._document["realisation"])

    @property
    def format(self) -> NumberFormat:
        """How coefficients are stored."""
        return NumberFormat(**self._document["format"])

    @property
    def signal(self) -> NumberFormat | None:
        """How signals are stored; `None` where that is not said, and in floating point."""
        found = self._document["signal"]
        return None if found is None else NumberFormat(**found)

    @property
    def overflow(self) -> str:
        """What happens to signals that do not fit: ``saturate`` or ``wrap``."""
        return str(self._document["overflow"])

    @property
    def stable(self) -> bool:
        """Whether the loop is stable with the stored coefficients."""
        return bool(self._document["rounded"]["verdict"] == "stable")

    @property
    def holds(self) -> bool | None:
        """Whether the stored loop is stable, meets what is required, and its signals stay in their ranges; `None` where a range is open."""
        if not self.stable or not all(required.met for required in self.requirements):
            return False
        states = [signal.holds for signal in self.ranges if signal.limit is not None and signal.bound is not None]
        return False if False in states else None if None in states else True

    @property
    def verdict(self) -> PointVerdict:
        """Of the loop with the stored coefficients; its certificate is about `rounded_model`."""
        return self._verdict("rounded", None if self._loop is None else self.rounded_model())

    @property
    def exact_verdict(self) -> PointVerdict:
        """Of the loop as it is written."""
        return self._verdict("exact", self._loop)

    def _verdict(self, which: str, loop: Loop | None) -> PointVerdict:
        return PointVerdict(self._answer("verdict", self._document[which]), loop, ("verdict", "-", *self._shared))

    def _answer(self, kind: str, found: Mapping[str, object]) -> str:
        """A part of the document as the document of its own kind."""
        shared = {key: value for key, value in self._document.items() if key in ("title", "time", "set", "radius", "decay")}
        return json.dumps({"schema": f"jurist/{kind}/1", **shared, **found})

    @property
    def coefficients(self) -> dict[str, list[Coefficient]]:
        """What is stored, in lists.

        ``b`` and ``a`` of a direct form by falling powers of z, or of the delta operator; ``b_1``, ``a_1`` .. of sections; ``A``, ``B``,
        ``C`` and ``D`` row by row.
        """
        return {name: list(map(_coefficient, *map(found.get, _COLUMNS))) for name, found in self._document["coefficients"].items()}

    @property
    def changes(self) -> list[str]:
        """What rounding changed in the structure, in sentences."""
        return [str(sentence) for sentence in self._document["changes"]]

    @property
    def margins(self) -> Margins | None:
        """The margins of the stored loop at the controller's output, or where the requirements take them; `None` where there are none."""
        found = self._document["margins"]
        if found is None:
            return None
        pairs = zip(self._shared, self._shared[1:], strict=False)
        values = [word for pair in pairs if pair[0] == "--set" for word in pair]
        loop = None if self._loop is None else self.rounded_model()
        return Margins(self._answer("margins", found), loop, ("margins", "-", *values, f"--at={found['at']}"))

    @property
    def requirements(self) -> list[Required]:
        """What is required of the loop beyond stability, by the question or the model, and what the stored loop has."""
        return [Required(**found) for found in self._document["requirements"]]

    @property
    def every_rounding(self) -> Tolerance | None:
        """Whether every rounding within the format's unit holds, with ``holds`` and ``factor``; `None` where nothing is rounded.

        The names in its box are those of the coefficients with ``ship_`` before them. Its text is asked from `every_rounding_model`,
        and may bracket the factor more narrowly.
        """
        found = self._document["every_rounding"]
        if found is None:
            return None
        loop = None if self._loop is None else self.every_rounding_model()
        # Tolerances of the model file are no part of this.
        others = [] if loop is None else [name for name in (*loop.parameters, *loop.constants) if name not in found["box"]]
        fixed = [word for name in others for word in ("--fix", name)]
        return Tolerance(self._answer("tolerance", found), loop, ("tolerance", "-", *self._shared, *fixed))

    @property
    def fewest(self) -> Fewest | None:
        """How many bits behind the point are enough; `None` where that was not asked for, and in floating point."""
        found = self._document["fewest"]
        if found is None:
            return None
        return Fewest(found["every_rounding"], found["refuted"], tuple(found["nearest"]), tuple(found["floor"]), found["floor_from"])

    @property
    def limits(self) -> list[tuple[int | None, StableSet]]:
        """The stable sets of the parameter that was asked for, each with its number of bits behind the point; `None` is floating point."""
        found = self._document["limits"]
        return [] if found is None else [(row["fraction"], self._set(row)) for row in found["rows"]]

    @property
    def exact_limits(self) -> StableSet | None:
        """The stable set of that parameter with the controller as it is written; `None` where none was asked for."""
        found = self._document["limits"]
        return None if found is None else self._set(found["exact"])

    def _set(self, found: Mapping[str, object]) -> StableSet:
        name = self._document["limits"]["parameter"]
        known = None if self._loop is None else self._loop.parameters.get(name)
        ends = {"lower": None if known is None else known.min, "upper": None if known is None else known.max}
        whole = {
            "parameter": name,
            "unit": None if known is None else known.unit,
            "nominal": None if known is None or known.nominal is None else str(known.nominal),
            "domain": {side: None if end is None else str(end) for side, end in ends.items()},
            "domain_closed": {side: known is not None and known.closed and end is not None for side, end in ends.items()},
        }
        values = {key: value for key, value in self._document["set"].items() if key != name}
        kept = {"title": self._document["title"], "time": self._document["time"], "set": values}
        return StableSet({**kept, **whole, "stable": found["stable"], "undecided": found.get("undecided")})

    @property
    def ranges(self) -> list[SignalRange]:
        """How far the controller's input and inner signals go; empty where nothing is said of them, and where the stored loop is not stable."""
        return [
            SignalRange(
                found["node"],
                _number(found["bound"]),
                None if found["greatest"] is None else _pair(found["greatest"]),
                fraction(found["rounding_with_inputs"]),
                _number(found["limit"]),
                found["holds"],
            )
            for found in self._document["ranges"]
        ]

    @property
    def limit_cycle(self) -> dict[str, Fraction]:
        """By how much the rounding of the controller's inputs and signals moves each output at most, limit cycles included."""
        return {name: fraction(found["with_inputs"]) for name, found in self._document["limit_cycle"].items()}

    def rounded_model(self) -> Loop:
        """The loop with the stored coefficients. Where the question gave ``values``, give them to its questions again.

        Examples
        --------
        >>> import jurist
        >>> b = jurist.LoopBuilder("discrete").block("controller", "r - y", "u", "(z/2 - 0.4999)/(z - 1)")
        >>> loop = b.block("plant", "u", "y", "1/10/(z - 9/10)").build(inputs=["r"], outputs=["y"])
        >>> ship = loop.ship("controller", format="Q2.13")
        >>> rounded = ship.rounded_model()
        >>> rounded.verdict(), jurist.verify(rounded, ship.verdict.certificate()).kind
        (<PointVerdict stable: 2 inside>, 'verdict')
        """
        return self._read(self._rounded)

    def every_rounding_model(self) -> Loop:
        """The loop in which each coefficient has the tolerance of its rounding, beside those of the model file, for `Loop.tolerance`."""
        return self._read(self._every)

    def _read(self, text: str) -> Loop:
        from ._loop import Loop

        with warnings.catch_warnings():
            # They were shown with the loop itself.
            warnings.simplefilter("ignore", JuristWarning)
            return Loop.from_toml(text, name=self._known_loop.name)

    @property
    def _known_loop(self) -> Loop:
        if self._loop is None:
            raise ValueError("this answer does not know its question")
        return self._loop

    def c(self, timeout: float | None = None) -> str:
        """The controller as code in C99: one header.

        Examples
        --------
        >>> import jurist
        >>> b = jurist.LoopBuilder("discrete").block("controller", "r - y", "u", "(z/2 - 0.4999)/(z - 1)")
        >>> loop = b.block("plant", "u", "y", "1/10/(z - 9/10)").build(inputs=["r"], outputs=["y"])
        >>> code = loop.ship("controller", format="Q2.13", signal="Q5.10").c()
        >>> [line for line in code.splitlines() if "b1 = " in line]
        ['static const int32_t CONTROLLER_B1 = -4095; /* b1 = -0.4999 */']
        """
        return self._code("--c", timeout)

    def st(self, timeout: float | None = None) -> str:
        """The controller as a function block in structured text (IEC 61131-3)."""
        return self._code("--st", timeout)

    def rust(self, timeout: float | None = None) -> str:
        """The controller as a module in Rust (``no_std``)."""
        return self._code("--rust", timeout)

    def _code(self, option: str, timeout: float | None) -> str:
        # Code does not depend on what may take long.
        words = [word for word in self._words if word != "--fewest" and not word.startswith("--param=")]
        return asked_with_files(self._known_loop, words, (option,), self._known_loop._asked(timeout=timeout))[1]

    def __str__(self) -> str:
        return self.text().rstrip()

    def __repr__(self) -> str:
        words = f"{self._document['rounded']['verdict']} with {self.format.bits} bits"
        open_or_not = "" if not self.stable or self.holds else ", open" if self.holds is None else ", does not hold"
        return f"<Ship {self.block}: {words}{open_or_not}>"

    def _repr_html_(self) -> str:
        from ._html import escaped, table

        rows = [
            [c.name, c.exact if isinstance(c.exact, Fraction) else f"{float(c.exact[0]):.12g}..", c.stored, c.integer, c.hex]
            for found in self.coefficients.values()
            for c in found
            if c.name is not None
        ]
        head = ["", "exact", "stored", "integer", "bits"]
        return f"<div><b>{escaped(repr(self)[1:-1])}</b>{table(head, [['' if x is None else x for x in row] for row in rows])}</div>"


_COLUMNS = ("names", "exact", "stored", "integers", "hex")


def asked_with_files(loop: Loop, words: list[str], options: tuple[str, ...], asked: Mapping[str, object]) -> tuple[str, ...]:
    """The answer of a command, and what it writes into the files that options name.

    An answer in which only a range is open is an answer.
    """
    with tempfile.TemporaryDirectory() as folder:
        paths = [os.path.join(folder, f"written{k}") for k in range(len(options))]
        named = [word for option, path in zip(options, paths, strict=True) for word in (option, path)]
        try:
            answer = loop._document([*words, *named], asked)
        except QuestionError:
            # It is refused once more, in words that quote no file.
            answer = ""
        except Undecided as error:
            if error.document is None or json.loads(error.document).get("undecided", "") is not None:
                raise
            answer = error.document
        if not answer:
            loop._document(words, asked)
        written = []
        for path in paths:
            with open(path, encoding="utf-8") as file:
                written.append(file.read())
        return answer, *written


def _coefficient(name: str | None, exact: list[str], stored: str, integer: str | None, hex: str | None) -> Coefficient:
    low, high = _pair(exact)
    return Coefficient(name, low if low == high else (low, high), fraction(stored), None if integer is None else int(integer), hex)


def _number(text: str | None) -> Fraction | None:
    return None if text is None else fraction(text)


def _pair(texts: list[str]) -> tuple[Fraction, Fraction]:
    low, high = map(fraction, texts)
    return low, high
