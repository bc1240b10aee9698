"""Questions about responses: margins, peak gains, curves over frequency and time."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import TYPE_CHECKING, Any, Unpack, cast

from ._asking import Asker
from ._curves import Locus, Simulation
from ._exact import Exact, fraction, text_of
from ._question import Asking, Bounds, Waiting

if TYPE_CHECKING:
    from ._loop import Loop
    from ._margins import LeastMargins, Margins, Norm, PeakToPeak
    from ._report import Report
    from ._response import Bode, Nyquist
    from ._roots import Roots
    from ._ship import Ship
    from ._tune import Tune


class ResponseQuestions(Asker):
    """What a loop does, and how far it is from not being stable."""

    __slots__ = ()

    @property
    def _itself(self) -> Loop:
        return cast("Loop", self)

    def margins(
        self,
        at: str | None = None,
        values: Mapping[str, Exact] | None = None,
        *,
        skew: Exact = 0,
        **question: Unpack[Waiting],
    ) -> Margins:
        """Gain, phase, delay, modulus and disk margins of the loop cut at a signal, exactly, and all crossings.

        Parameters
        ----------
        at : str, optional
            Where the loop is cut: a signal, a block (at its input), or a parameter (the loop's gain). By default where the
            model's ``[require]`` says, else the error of a single loop.
        values : mapping, optional
            Of parameters and constants.
        skew : exact number
            Of the disk margin; 0 is the balanced disk.
        **question
            ``set``, ``timeout``, ``progress`` and ``digits``; see `intervals`.

        Returns
        -------
        Margins

        Examples
        --------
        >>> import jurist
        >>> loop = jurist.Loop.characteristic([1, 3, 3, "1 + k"], time="continuous", parameters={"k": 2})
        >>> m = loop.margins("k")
        >>> m.gain, m.upper, float(m.modulus.value)
        (<StableSet k: (-0.5, 4)>, <End 4: complex pair>, 0.6)
        """
        from ._margins import Margins

        asked = self._asked(values, **question)
        words = self._words("margins", asked)
        words += [] if at is None else [f"--at={at}"]
        words += [] if skew == 0 else [f"--skew={text_of(skew)}"]
        return Margins(self._document(words, asked), self._itself, tuple(words))

    def least_margins(
        self,
        for_all: Mapping[str, Bounds],
        at: str | None = None,
        values: Mapping[str, Exact] | None = None,
        **question: Unpack[Waiting],
    ) -> LeastMargins:
        """How much of each margin the loop has for all values of up to four names, proved.

        Parameters
        ----------
        for_all : mapping from names to pairs of exact numbers
            The ranges, ends included; all values vary independently of each other.
        at : str, optional
            Where the loop is cut; see `margins`.
        values : mapping, optional
            Of other parameters and constants.

        Examples
        --------
        >>> import jurist
        >>> b = jurist.LoopBuilder("continuous")
        >>> a = b.parameter("a", 1)
        >>> b = b.block("plant", "r - y", "y", f"{a}/(s*(s + 1))")
        >>> least = b.build(inputs=["r"], outputs=["y"]).least_margins({"a": ("1/2", 1)}).margins["phase_margin"]
        >>> round(float(least.proved)), round(float(least.found[0]), 3), least.at
        (52, 51.827, {'a': Fraction(1, 1)})
        """
        from ._margins import LeastMargins
        from ._stability import _for_all

        asked = self._asked(values, **question)
        words = [*self._words("margins", asked), *_for_all(for_all)]
        words += [] if at is None else [f"--at={at}"]
        return LeastMargins(self._document(words, asked), self._itself, tuple(words))

    def norm(
        self, input: str, output: str, values: Mapping[str, Exact] | None = None, **question: Unpack[Waiting]
    ) -> Norm:
        """The peak gain (H-infinity norm) of the closed-loop transfer function from an input to an output, exactly.

        Examples
        --------
        >>> import jurist
        >>> b = jurist.LoopBuilder("continuous").block("plant", "2*r - y", "y", "1/(s^2 + s)")
        >>> n = b.build(inputs=["r"], outputs=["y"]).norm("r", "y")
        >>> n.value.polynomial, n.value.decimal(20)
        ((-16, 0, 3), '2.3094010767585030580')
        """
        from ._margins import Norm

        asked = self._asked(values, **question)
        first, dash, *options = self._words("norm", asked)
        words = [first, dash, input, output, *options]
        return Norm(self._document(words, asked), self._itself, tuple(words))

    def peak_to_peak(
        self, input: str, output: str, values: Mapping[str, Exact] | None = None, **question: Unpack[Waiting]
    ) -> PeakToPeak:
        """The peak-to-peak gain (l1 norm) from an input to an output: how far bounded inputs can drive the output.

        Examples
        --------
        >>> import jurist
        >>> b = jurist.LoopBuilder("discrete").block("plant", "r - y", "y", "1/(z^2 - 3/2*z - 3/10)")
        >>> g = b.build(inputs=["r"], outputs=["y"]).peak_to_peak("r", "y", digits=20)
        >>> g.decimal, g.exact, g.lower < g.upper
        ('9.2732747328169420907', None, True)
        """
        from ._margins import PeakToPeak

        asked = self._asked(values, **question)
        first, dash, *options = self._words("norm", asked)
        words = [first, dash, input, output, "--l1", *options]
        return PeakToPeak(self._document(words, asked), self._itself, tuple(words))

    def roots(
        self, values: Mapping[str, Exact] | None = None, *, rightmost: int | None = None, **question: Unpack[Waiting]
    ) -> Roots:
        """The roots of the closed loop (poles), the slowest first; of a pair of conjugate roots the upper one.

        Parameters
        ----------
        values : mapping, optional
        rightmost : int, optional
            Of a loop with dead time, which has infinitely many roots: how many of the rightmost are listed, a pair being one; 10 where
            nothing is given. No other root is right of the line `others_left_of` of the list.

        Examples
        --------
        >>> import jurist
        >>> loop = jurist.Loop.characteristic([1, 2, "K"], time="continuous", parameters={"K": 2})
        >>> pair = loop.roots()[0]
        >>> pair.value, pair.is_pair, round(pair.damping, 6)
        ((-1+1j), True, 0.707107)
        >>> delayed = jurist.Loop.from_toml('''
        ... time = "continuous"
        ... [parameters]
        ... K = 1
        ... [loop]
        ... characteristic = "s + K*exp(-s)"
        ... ''')
        >>> roots = delayed.roots(rightmost=2)
        >>> roots[0].re, roots[0].im, roots.others_left_of
        ('-0.318131505205', '1.33723570143', Fraction(-12, 5))
        """
        from ._roots import roots_of

        asked = self._asked(values, **question)
        words = self._words("roots", asked)
        words += [] if rightmost is None else [f"--rightmost={rightmost}"]
        return roots_of(self._document(words, asked))

    def ship(
        self,
        block: str | None = None,
        values: Mapping[str, Exact] | None = None,
        *,
        format: str | None = None,
        signal: str | None = None,
        inputs: Mapping[str, Exact] | None = None,
        realisation: str | None = None,
        round: str | None = None,
        fewest: bool = False,
        param: str | None = None,
        **question: Unpack[Asking],
    ) -> Ship:
        """The controller as it is stored and run: rounded coefficients, every rounding, fewest bits, ranges of signals.

        What is not given is as the model's ``[ship]`` says.

        Parameters
        ----------
        block : str, optional
            The block that is the controller.
        values : mapping, optional
            Of parameters and constants.
        format : str, optional
            How coefficients are stored: ``"Q2.13"`` (sign, 2 bits before and 13 behind the point), ``"float32"`` or ``"float64"``.
        signal : str, optional
            How signals are stored, such as ``"Q5.10"``.
        inputs : mapping, optional
            The greatest magnitudes of inputs of the loop, for ranges of signals.
        realisation : str, optional
            The order of operations: ``"df1"``, which is meant where nothing says it, ``"df2"``, ``"df2t"``, ``"sos"``, ``"parallel"``,
            ``"delta"`` or ``"state"``.
        round : str, optional
            How coefficients are rounded: ``"nearest"``, ``"even"``, ``"half-up"``, ``"floor"``, ``"ceil"`` or ``"zero"``.
        fewest : bool
            Also says how many bits behind the point are enough.
        param : str, optional
            Also gives the stable sets of this parameter with more and more bits.
        **question
            What every question takes; see `intervals`.

        Returns
        -------
        Ship

        Raises
        ------
        QuestionError
            Where no block is named, and for a format that is none.
        Undecided
            Where the time was not enough for a part; its ``document`` has the others.

        Examples
        --------
        >>> import jurist
        >>> b = jurist.LoopBuilder("discrete").block("controller", "r - y", "u", "(7/10*z - 3/5)/(z - 1)")
        >>> loop = b.block("plant", "u", "y", "1/5/(z - 4/5)").build(inputs=["r"], outputs=["y"])
        >>> ship = loop.ship("controller", format="Q1.6", signal="Q3.12", inputs={"r": 1}, fewest=True)
        >>> ship.stable, ship.holds, [c.integer for c in ship.coefficients["b"]]
        (True, True, [45, -38])
        >>> ship.every_rounding.holds, ship.every_rounding.factor.decimal, ship.fewest.every_rounding
        (True, '6.39950561523', 4)
        >>> [(r.node, round(float(r.bound), 5), r.holds) for r in ship.ranges]
        [('u', 2.00136, True), ('y', 1.00124, True)]
        """
        from ._ship import Ship, asked_with_files

        asked = self._asked(values, **question)
        shared = self._words("ship", asked)
        given = {"block": block, "realisation": realisation, "format": format, "signal": signal, "round": round, "param": param}
        words = [*shared, *(f"--{name}={text}" for name, text in given.items() if text is not None)]
        for name, most in (inputs or {}).items():
            words += ["--input", f"{name}={text_of(most)}"]
        words += ["--fewest"] if fewest else []
        answer, rounded, every = asked_with_files(self._itself, words, ("--rounded", "--every"), asked)
        return Ship(answer, self._itself, tuple(words), tuple(shared[2:]), rounded, every)

    def tune(
        self,
        objective: str | None = None,
        free: Sequence[str] | str | None = None,
        values: Mapping[str, Exact] | None = None,
        *,
        bounds: Mapping[str, Bounds] | None = None,
        gap: Exact | None = None,
        loss: Exact | None = None,
        for_all: Mapping[str, Bounds] | None = None,
        robust: bool = False,
        **question: Unpack[Asking],
    ) -> Tune:
        """The best gains within what is required, exactly or in a certified bracket; or that no gains meet it.

        What is not given is as the model's ``[tune]`` says. Requirements are keywords, beside those of the model.

        Parameters
        ----------
        objective : str, optional
            ``"max NAME"`` or ``"min NAME"``: a free gain, a rational expression of free gains, or ``decay``, ``radius``, ``settling_time``, ``damping``, ``gain_margin``, ``phase_margin``,
            ``modulus_margin``, ``complementary_peak``, ``disk_margin``, ``norm INPUT OUTPUT``, ``tolerance``; ``"none"`` asks whether there are any gains.
        free : sequence of str, optional
            Up to five gains.
        values : mapping, optional
            Of parameters and constants.
        bounds : mapping, optional
            The least and the greatest value of a gain, both included; `None` is no bound.
        gap : exact number, optional
            A bracket is narrow enough where it is less than this share; 1e-3 where nothing says it.
        loss : exact number, optional
            What may be given up for gains of few digits, as a share; one per cent where nothing says it.
        for_all : mapping from names to pairs of exact numbers, optional
            Gains that are good for every value of these names in their closed ranges.
        robust : bool
            Gains that are good for every value within the tolerances of the model.
        **question
            What every question takes; see `intervals`.

        Returns
        -------
        Tune

        Raises
        ------
        QuestionError
            For gains and objectives that are none.
        Undecided
            Where the time was not enough.

        Examples
        --------
        >>> import jurist
        >>> loop = jurist.Loop.from_line("K/(z*(z - 1/2))")
        >>> loop.tune("min radius", ["K"]).value
        Real('1/4')
        """
        from ._stability import _for_all
        from ._tune import Tune

        asked = self._asked(values, **question)
        words = self._words("tune", asked)
        for name in [free] if isinstance(free, str) else free or []:
            words += ["--free", name]
        for name, (low, high) in (bounds or {}).items():
            ends = ["" if end is None else text_of(end) for end in (low, high)]
            words += ["--bound", f"{name}={ends[0]}..{ends[1]}"]
        given = {"objective": objective, "gap": None if gap is None else text_of(gap), "loss": None if loss is None else text_of(loss)}
        words += [f"--{name}={text}" for name, text in given.items() if text is not None]
        words += [*_for_all(for_all), *(["--robust"] if robust else [])]
        return Tune(self._document(words, asked), self._itself, tuple(words))

    def bode(
        self,
        at: str | None = None,
        values: Mapping[str, Exact] | None = None,
        *,
        set: Mapping[str, Exact] | None = None,
        timeout: float | None = None,
    ) -> Bode:
        """Magnitude and phase of the loop cut at a signal over frequency, with the exact crossings on them.

        Parameters
        ----------
        at : str, optional
            Where the loop is cut; see `margins`.
        values : mapping, optional
        set : mapping, optional
            Values, under the name that the program's option has.
        timeout : float, optional
        """
        from ._response import Bode

        text, words = self._curve("bode", at, self._asked(values, set=set, timeout=timeout))
        return Bode(text, self._itself, words)

    def nyquist(
        self,
        at: str | None = None,
        values: Mapping[str, Exact] | None = None,
        *,
        set: Mapping[str, Exact] | None = None,
        timeout: float | None = None,
    ) -> Nyquist:
        """The curve of the loop cut at a signal around -1, with the exact crossings on it; parameters as for `bode`."""
        from ._response import Nyquist

        text, words = self._curve("nyquist", at, self._asked(values, set=set, timeout=timeout))
        return Nyquist(text, self._itself, words)

    def _curve(self, command: str, at: str | None, asked: dict[str, Any]) -> tuple[str, tuple[str, ...]]:
        words = self._words(command, asked) + ([] if at is None else [f"--at={at}"])
        return self._command([*words, "--json"], asked)[0], tuple(words)

    def locus(
        self,
        parameter: str,
        values: Mapping[str, Exact] | None = None,
        *,
        range: tuple[Exact, Exact] | None = None,
        log: bool = False,
        set: Mapping[str, Exact] | None = None,
        timeout: float | None = None,
    ) -> Locus:
        """The root locus of any parameter, with the exact crossings of the boundary.

        Parameters
        ----------
        parameter : str
        values : mapping, optional
        range : pair of exact numbers, optional
            Around the stable set and the nominal value, if not given.
        log : bool
            Lets the parameter run evenly in its logarithm.
        set : mapping, optional
            Values, under the name that the program's option has.
        timeout : float, optional
        """
        asked = self._asked(values, set=set, timeout=timeout)
        words = [*self._words("locus", asked), "--param", parameter]
        if range is not None:
            words.append(f"--range={text_of(range[0])}..{text_of(range[1])}")
        text, done, _ = self._command([*words, *(["--log"] if log else []), "--json"], asked)
        return Locus(text, self._itself, done)

    def simulate(
        self,
        values: Mapping[str, Exact] | None = None,
        *,
        inputs: Mapping[str, Exact | tuple[Exact, Exact]] | None = None,
        initial: Mapping[str, Exact] | None = None,
        duration: Exact | None = None,
        switched: bool = False,
        set: Mapping[str, Exact] | None = None,
        timeout: float | None = None,
    ) -> Simulation:
        """A time response, in floating point.

        Parameters
        ----------
        values : mapping, optional
        inputs : mapping, optional
            From signals to values, or to pairs of a value and the time from which on it holds.
        initial : mapping, optional
            Of states.
        duration : exact number, optional
            In seconds, or in samples without a sample time.
        switched : bool
            Simulates the circuit with its switches, for blocks with ``pwm``.
        set : mapping, optional
            Values, under the name that the program's option has.
        timeout : float, optional
        """
        asked = self._asked(values, set=set, timeout=timeout)
        words = self._words("simulate", asked)
        for name, value in (inputs or {}).items():
            at = f"@{text_of(value[1])}" if isinstance(value, tuple) else ""
            words += ["--input", f"{name}={text_of(value[0] if isinstance(value, tuple) else value)}{at}"]
        for name, value in (initial or {}).items():
            words += ["--initial", f"{name}={text_of(value)}"]
        words += [] if duration is None else [f"--duration={text_of(duration)}"]
        text, done, _ = self._command([*words, *(["--switched"] if switched else []), "--json"], asked)
        return Simulation(text, self._itself, done)

    def report(
        self,
        values: Mapping[str, Exact] | None = None,
        *,
        domain: Mapping[str, Bounds] | None = None,
        at: str | None = None,
        set: Mapping[str, Exact] | None = None,
        timeout: float | None = None,
    ) -> Report:
        """One page about this loop: verdict, limits and causes, margins, what moves them, the worst corner, figures.

        Parameters
        ----------
        values : mapping, optional
        domain : mapping from names to pairs, optional
            Replaces the domains of parameters by open ones.
        at : str, optional
            Where the loop is cut for margins and the Bode diagram; see `margins`.
        set : mapping, optional
            Values, under the name that the program's option has.
        timeout : float, optional

        Examples
        --------
        >>> import jurist
        >>> page = jurist.Loop.drive().report({"T": "2e-4"})
        >>> "0.0002" in page.html or "1/5000" in page.html
        True
        """
        from ._report import Report

        asked = self._asked(values, domain=domain, set=set, timeout=timeout)
        words = [*self._words("report", asked), *([] if at is None else [f"--at={at}"]), "-o", "-"]
        page = self._command(words, asked)[0]
        return Report(page, self._itself.title or self._itself.name)

    def to_control(self, input: str, output: str, values: Mapping[str, Exact] | None = None) -> Any:
        """The closed-loop transfer function from an input to an output, for python-control.

        Coefficients are rounded to floats; names and the sample time are kept.
        """
        from ._control import to_control

        return to_control(self._itself, input, output, values)

    def sample_time(self, values: Mapping[str, Exact] | None = None) -> Fraction | None:
        """The sample time at a point; `None` in continuous time and where the model gives none."""
        text = self._core.sample_time(self._asked(values))
        return None if text is None else fraction(text)
