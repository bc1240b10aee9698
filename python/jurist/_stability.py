"""Questions about stability: at a point, of a parameter, in a plane, over a box of tolerances."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Literal, Unpack, cast

from ._answers import Analysis, PointVerdict, Table
from ._asking import Asker
from ._curves import Body, Map
from ._exact import Exact, text_of
from ._polynomial import Polynomial
from ._question import Asking, AskingWithin, Bounds, warn
from ._sets import StableSet

if TYPE_CHECKING:
    from ._loop import Loop
    from ._tolerance import Tolerance


class StabilityQuestions(Asker):
    """For which values a loop is stable."""

    __slots__ = ()

    @property
    def _loop(self) -> Loop:
        return cast("Loop", self)

    def intervals(
        self,
        parameter: str,
        values: Mapping[str, Exact] | None = None,
        *,
        domain: Bounds | Mapping[str, Bounds] | None = None,
        for_all: Mapping[str, Bounds] | None = None,
        **question: Unpack[Asking],
    ) -> StableSet:
        """The exact stable set of a parameter.

        Parameters
        ----------
        parameter : str
            A parameter, a constant given as a number, ``"radius"`` or ``"decay"``.
        values : mapping, optional
            Of other parameters and constants; the rest is nominal.
        domain : pair of exact numbers or None, or mapping from names to pairs
            Replaces the domain of the parameter by an open one.
        for_all : mapping from names to pairs of exact numbers, optional
            The values that are good for every value of these names in their closed ranges; the ends are enclosed then.
        **question
            What every question takes:

            ``set`` : mapping
                Values, under the name that the program's option has.
            ``radius``, ``decay`` : exact number
                Asks for all ``|z| < radius`` (discrete time), or all ``Re s < -decay`` (continuous time).
            ``phase_margin``, ``gain_margin``, and every other requirement : number or str
                As on the command line: ``"6 dB"``, ``"45 deg"``, ``"1/2"``. The set is that of the values which meet all.
            ``at`` : str
                The signal at which the loop is cut for margins.
            ``timeout`` : float
                Seconds.
            ``progress`` : callable or bool
                Told the name of each step and the share done; `True` prints them to standard error.
            ``digits`` : int
                Of decimals in the document.

        Returns
        -------
        StableSet

        Raises
        ------
        QuestionError
            For an unknown parameter, a value that is missing, an empty domain.
        Undecided
            Where the time was not enough.

        Examples
        --------
        >>> import jurist
        >>> loop = jurist.Loop.drive()
        >>> loop.intervals("T", {"K_pwm": 200})
        <StableSet T: (0, 0.000274533891101)>
        >>> b = jurist.LoopBuilder("continuous")
        >>> K = b.parameter("K", 1, min=0)
        >>> b = b.block("controller", "-y", "u", K).block("plant", "u", "y", "1/(s + 1)^3")
        >>> b.build().intervals("K", gain_margin=2, at="u")
        <StableSet K: (0, 4)>
        >>> servo = jurist.Loop.characteristic("z - 1 + K*c", time="discrete", parameters={"K": 1, "c": 1})
        >>> float(servo.intervals("K", domain=(0, 3), for_all={"c": ("1/2", 4)})[0].upper) < 1 / 2
        True
        """
        asked = self._asked(values, parameter=parameter, domain=domain, **question)
        kept = {**asked, "timeout": None, "progress": None}
        if for_all or self._has_requirements(asked):
            words = [*self._words("intervals", asked), "--param", parameter, *_for_all(for_all)]
            text = self._document(words, asked)
            return StableSet(json.loads(text), text=text, loop=self._loop, asked=kept, words=tuple(words))
        answer, text, remarks = self._core.intervals(asked, parameter)
        warn(remarks)
        return StableSet(json.loads(text), text=text, loop=self._loop, asked=kept, answer=answer)

    def verdict(self, values: Mapping[str, Exact] | None = None, **question: Unpack[AskingWithin]) -> PointVerdict:
        """Whether the loop is stable at a point, with the exact number of roots in each place.

        Examples
        --------
        >>> import jurist
        >>> jurist.Loop.drive().verdict({"K_pwm": 551})
        <PointVerdict unstable: 4 inside, 2 outside>
        """
        asked = self._asked(values, **question)
        words = self._words("verdict", asked)
        if self._has_requirements(asked):
            return PointVerdict(self._command([*words, "--json"], asked)[0], self._loop, tuple(words))
        _, text, remarks = self._core.verdict(asked)
        warn(remarks)
        return PointVerdict(text, self._loop, tuple(words))

    def analyze(self, values: Mapping[str, Exact] | None = None, **question: Unpack[AskingWithin]) -> Analysis:
        """The verdict at the nominal point, and the stable set of each parameter, the others nominal."""
        asked = self._asked(values, **question)
        words = self._words("analyze", asked)
        text = self._document(words, asked)
        return Analysis(text, self._loop, tuple(words))

    def charpoly(
        self, keep: Iterable[str] = (), values: Mapping[str, Exact] | None = None, **question: Unpack[AskingWithin]
    ) -> Polynomial:
        """The characteristic polynomial.

        Parameters
        ----------
        keep : iterable of str
            Parameters that stay symbols; all that have no value set, if none is named.
        values : mapping, optional
        """
        asked = self._asked(values, **question)
        words = self._words("charpoly", asked)
        for name in [keep] if isinstance(keep, str) else keep:
            words += ["--keep", name]
        text, done, _ = self._command([*words, "--json"], asked)
        return Polynomial(text, self._loop, done)

    def jury(
        self, parameter: str | None = None, values: Mapping[str, Exact] | None = None, **question: Unpack[AskingWithin]
    ) -> Table:
        """The Jury table (discrete time) or Routh table (continuous time); with a parameter, each condition solved for itself."""
        asked = self._asked(values, **question)
        words = self._words("jury", asked) + ([] if parameter is None else ["--param", parameter])
        text = self._document(words, asked)
        return Table(text, self._loop, tuple(words))

    def map(
        self,
        x: str,
        y: str,
        values: Mapping[str, Exact] | None = None,
        *,
        method: Literal["exact", "boxes", "auto"] = "auto",
        window: Mapping[str, Bounds] | None = None,
        undecided: Exact | None = None,
        for_all: Mapping[str, Bounds] | None = None,
        **question: Unpack[AskingWithin],
    ) -> Map:
        """The stable region in the plane of two parameters.

        Parameters
        ----------
        x, y : str
            The parameters.
        values : mapping, optional
        method : {"exact", "boxes", "auto"}
            The exact decomposition of the whole domain, boxes of a window each proved, or boxes after half of the timeout.
        window : mapping from names to pairs, optional
            What boxes are to cover.
        undecided : exact number, optional
            The share of the window that boxes may leave undecided.
        for_all : mapping from names to pairs of exact numbers, optional
            The points that are good for every value of these names in their closed ranges, by boxes.
        """
        asked = self._asked(values, **question)
        words = [*self._words("map", asked), *_for_all(for_all)]
        for option, name in (("-x", x), ("-y", y)):
            low, high = (window or {}).get(name, (None, None))
            bounds = ["" if b is None else text_of(b) for b in (low, high)]
            words += [option, name if bounds == ["", ""] else f"{name}={bounds[0]}..{bounds[1]}"]
        words += ["--method", method]
        if undecided is not None:
            words.append(f"--undecided={text_of(undecided)}")
        text = self._document(words, asked)
        return Map(text, self._loop, tuple(words))

    def body(
        self,
        x: str,
        y: str,
        z: str,
        lower: Exact,
        upper: Exact,
        count: int,
        values: Mapping[str, Exact] | None = None,
        **question: Unpack[AskingWithin],
    ) -> Body:
        """Exact maps of two parameters at equally spaced values of a third, and how far their stable regions reach together.

        Parameters
        ----------
        x, y, z : str
            The parameters; the maps are of the first two.
        lower, upper : exact numbers
            The first and the last value of the third.
        count : int
            How many values, at least two.
        values : mapping, optional
        """
        asked = self._asked(values, **question)
        words = self._words("map", asked)
        words += ["-x", x, "-y", y, "-z", f"{z}={text_of(lower)}..{text_of(upper)}:{count}"]
        text = self._document(words, asked)
        return Body(text, self._loop, tuple(words))

    def tolerance(
        self,
        values: Mapping[str, Exact] | None = None,
        *,
        tol: Mapping[str, Exact | Bounds] | None = None,
        all: Exact | None = None,
        fix: str | Iterable[str] = (),
        for_all: Mapping[str, Bounds] | None = None,
        limit: str | None = None,
        exact: bool = False,
        volume: bool = False,
        **question: Unpack[AskingWithin],
    ) -> Tolerance:
        """Whether the loop is stable for every value within tolerances, and how far they can grow: proof or counterexample.

        Parameters
        ----------
        values : mapping, optional
            Of parameters without a tolerance.
        tol : mapping from names to tolerances
            ``"10%"``, ``"-20%..+30%"``, an absolute number, or a pair of bounds. Those of the model file hold for other names.
        all : tolerance, optional
            For every number of the model.
        fix : str or iterable of str
            Names without a tolerance.
        for_all : mapping from names to pairs of exact numbers, optional
            Names for all of whose values the answer is asked, ends included; these ranges do not grow with the factor.
        limit : str, optional
            Also asks how far this parameter may go while all others have their tolerances.
        exact : bool
            Also proves the largest factor as an exact number.
        volume : bool
            Also says which share of the box is stable.
        **question
            What every question takes; see `intervals`.

        Returns
        -------
        Tolerance

        Examples
        --------
        >>> import jurist
        >>> loop = jurist.Loop.characteristic("z^2 - z + K/2", time="discrete", parameters={"K": 1})
        >>> t = loop.tolerance(tol={"K": "50%"})
        >>> t.holds, t.box["K"], t.factor.lower < 2 <= t.factor.upper
        (True, (Fraction(1, 2), Fraction(3, 2)), True)
        >>> loop = jurist.Loop.characteristic("z - a + K", time="discrete", parameters={"K": 1, "a": 1})
        >>> t = loop.tolerance(tol={"K": "10%"}, for_all={"a": ("1/2", 1)})  # 0 < K < 3/2
        >>> t.factor.lower < 5 <= t.factor.upper
        True
        """
        from ._tolerance import Tolerance

        asked = self._asked(values, **question)
        words = self._words("tolerance", asked)
        if all is not None:
            words.append(f"--all={_tolerance(all)}")
        for name, value in (tol or {}).items():
            words += ["--tol", f"{name}={_tolerance(value)}"]
        for name in [fix] if isinstance(fix, str) else fix:
            words += ["--fix", name]
        words += _for_all(for_all)
        words += [] if limit is None else ["--limit", limit]
        words += [f"--{option}" for option, wanted in (("exact", exact), ("volume", volume)) if wanted]
        more = ["--digits", str(asked["digits"])] if "digits" in question else []
        text, _, _ = self._command([*words, "--json", *more], asked)
        return Tolerance(text, self._loop, tuple(words))


def _for_all(ranges: Mapping[str, Bounds] | None) -> list[str]:
    """The options of names for all of whose values something is asked."""
    return [f"--for-all={name}={_tolerance(range)}" for name, range in (ranges or {}).items()]


def _tolerance(value: Exact | Bounds) -> str:
    """A tolerance as the program reads it."""
    if isinstance(value, str):
        return value
    if isinstance(value, tuple):
        low, high = value
        return f"{text_of(low)}..{text_of(high)}"
    return text_of(value)
