"""Loops and the questions about them."""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterable, Mapping, Sequence
from fractions import Fraction
from typing import Any, Literal, Unpack

from . import _jurist
from ._answers import Analysis, PointVerdict, Proved, Table
from ._curves import Locus, Map, Simulation
from ._errors import JuristWarning, undecided
from ._exact import Exact, Floats, fraction, text_of
from ._polynomial import Polynomial
from ._question import Asking, Bounds, Listener, Parameter, bound, listener, number_text, plain, warn
from ._sets import StableSet

class Loop:
    """A control loop, and the questions about it. It is never changed.

    Loops are read (`from_file`, `from_toml`), built (`LoopBuilder`, `characteristic`), or taken from other libraries
    (`from_control`, `from_sympy`). All questions take ``values`` of parameters and constants, and the keywords of `intervals`.

    Examples
    --------
    >>> import jurist
    >>> loop = jurist.Loop.drive()
    >>> loop.time, list(loop.parameters)
    ('discrete', ['K_pwm', 'T'])
    >>> print(loop.intervals("K_pwm"))
    (0.0381005333483, 550.941166687)
    """

    __slots__ = ("_canonical", "_core", "_said")

    _canonical: str | None
    _core: _jurist.Model
    _said: str | None

    def __init__(self) -> None:
        raise TypeError("use Loop.from_file, Loop.from_toml, Loop.characteristic, LoopBuilder, from_control or from_sympy")

    @classmethod
    def _read(cls, name: str, content: bytes, said: str | None = None) -> Loop:
        core, remarks = _jurist.Model.read(name, content)
        warn(remarks)
        return cls._of(core, said)

    @classmethod
    def _of(cls, core: _jurist.Model, said: str | None = None) -> Loop:
        self = object.__new__(cls)
        self._core, self._said, self._canonical = core, said, None
        return self

    @classmethod
    def from_toml(cls, text: str, *, name: str = "<string>") -> Loop:
        """Reads a model file that is given as text.

        Raises
        ------
        ModelError
            With every mistake, its place and what to do.

        Examples
        --------
        >>> import jurist
        >>> jurist.Loop.from_toml("time = 'discrete'\\nparameters.K = {}\\nloop.characteristic = 'z - 1 + K'").intervals("K")
        <StableSet K: (0, 2)>
        """
        return cls._read(name, text.encode())

    @classmethod
    def from_file(cls, path: str | os.PathLike[str]) -> Loop:
        """Reads a model file."""
        with open(path, "rb") as file:
            return cls._read(os.fspath(path), file.read(), f"Loop.from_file({os.fspath(path)!r})")

    @classmethod
    def drive(cls) -> Loop:
        """The built-in example: a chopper-fed DC motor with cascaded controllers."""
        return cls._of(_jurist.Model.drive(), "Loop.drive()")

    @classmethod
    def characteristic(
        cls,
        p: Any,
        *,
        time: Literal["discrete", "continuous"],
        parameters: Mapping[str, Any] | Iterable[str] = (),
        floats: Floats = "shortest",
    ) -> Loop:
        """A loop given by its characteristic polynomial.

        Parameters
        ----------
        p : str, SymPy expression, or sequence of numbers
            An expression in ``z`` or ``s``; coefficients are taken with the highest power first.
        time : {"discrete", "continuous"}
        parameters : mapping or iterable of names
            Each with its nominal value, or a pair of bounds, or `None`.
        floats : {"shortest", "binary", "refuse"}
            What floats mean; see `exact`.

        Examples
        --------
        >>> import jurist
        >>> jurist.Loop.characteristic([1, 2, 3, "K"], time="continuous", parameters=["K"]).intervals("K")
        <StableSet K: (0, 6)>
        """
        from ._builder import LoopBuilder

        builder = LoopBuilder(time, floats=floats)
        named = parameters if isinstance(parameters, Mapping) else dict.fromkeys(parameters)
        for name, what in named.items():
            if isinstance(what, tuple):
                builder.parameter(str(name), min=what[0], max=what[1])
            else:
                builder.parameter(str(name), what)
        if not isinstance(p, str) and isinstance(p, Iterable):
            from ._exact import warn_computed

            row = list(p)
            warn_computed(row, stacklevel=3)
            variable = "z" if time == "discrete" else "s"
            p = " + ".join(f"({builder._expression(c)})*{variable}^{len(row) - 1 - k}" for k, c in enumerate(row))
        return builder.characteristic(p).build()

    @property
    def title(self) -> str | None:
        """The model's title."""
        return self._core.title()

    @property
    def time(self) -> str:
        """``"discrete"`` or ``"continuous"``."""
        return self._core.time()

    @property
    def name(self) -> str:
        """Where the model was read from."""
        return self._core.name()

    @property
    def parameters(self) -> Mapping[str, Parameter]:
        """By name, in the order of the model."""
        out = {}
        for name, *numbers, unit, description in self._core.parameters():
            nominal, least, most = (None if text is None else fraction(text) for text in numbers)
            out[name] = Parameter(name, nominal, least, most, unit, description)
        return out

    @property
    def constants(self) -> tuple[str, ...]:
        """The names of the constants."""
        return tuple(name for name, _ in self._core.constants())

    @property
    def inputs(self) -> tuple[str, ...]:
        """The external signals."""
        return tuple(self._core.inputs())

    @property
    def outputs(self) -> tuple[str, ...]:
        """The responses."""
        return tuple(self._core.outputs())

    def to_toml(self) -> str:
        """The model file."""
        return self._core.text()

    def _asked(
        self,
        values: Mapping[str, Exact] | None = None,
        *,
        parameter: str | None = None,
        domain: Any = None,
        radius: Exact | None = None,
        decay: Exact | None = None,
        timeout: float | None = None,
        progress: Listener | bool = False,
        digits: int = 12,
    ) -> dict[str, Any]:
        """The question as texts."""
        if domain is None:
            domains: Mapping[str, Bounds] = {}
        elif isinstance(domain, Mapping):
            domains = domain
        elif parameter is not None:
            domains = {parameter: domain}
        else:
            raise TypeError("which parameter's domain? give a mapping of names to bounds")
        if digits < 1:
            raise ValueError("at least one digit")
        return {
            "values": [(str(name), text_of(value)) for name, value in (values or {}).items()],
            "domains": [(str(name), bound(low), bound(high)) for name, (low, high) in domains.items()],
            "radius": bound(radius),
            "decay": bound(decay),
            "timeout": timeout,
            "progress": listener(progress),
            "digits": digits,
        }

    def _words(self, command: str, asked: Mapping[str, Any]) -> list[str]:
        """The question as the program's options."""
        words = [command, "-"]
        for name, value in asked["values"]:
            words += ["--set", f"{name}={value}"]
        for name, low, high in asked["domains"]:
            words += ["--domain", f"{name}={low or ''}..{high or ''}"]
        words += [f"--{key}={asked[key]}" for key in ("radius", "decay") if asked[key] is not None]
        return words

    def _asked_by(self, words: Sequence[str]) -> dict[str, Any]:
        """The question that options say."""
        pairs = [(words[i], words[i + 1]) for i in range(2, len(words) - 1) if words[i] in ("--set", "--domain")]
        values = {name: value for word, text in pairs if word == "--set" for name, _, value in [text.partition("=")]}
        domains = {
            name: tuple(end or None for end in bounds.split(".."))
            for word, text in pairs
            if word == "--domain"
            for name, _, bounds in [text.partition("=")]
        }
        return self._asked(values, domain=domains, **self._region_by(words))

    @staticmethod
    def _region_by(words: Sequence[str]) -> dict[str, Any]:
        found = [w[2:].partition("=") for w in words if w.startswith(("--radius=", "--decay="))]
        return {name: value for name, _, value in found}

    def _command(self, words: Sequence[str], asked: Mapping[str, Any]) -> tuple[str, tuple[str, ...], int]:
        """Runs a command of the program; gives its output, the words and the status."""
        done = self._core.command(list(words), asked["timeout"], asked["progress"])
        status, output, notes, remarks = done
        warn(remarks)
        if status == 3:
            said = next((n for n in notes if n.startswith("undecided: ")), "undecided: the budget ran out")
            budget, _, reached = said.removeprefix("undecided: the budget ran out: ").partition("; reached: ")
            raise undecided(said.removeprefix("undecided: "), budget, reached, output or None)
        return output, tuple(words), status

    def command(self, name: str, *options: str, timeout: float | None = None) -> str:
        """Runs any command of the program about this loop; gives what it prints.

        Parameters
        ----------
        name : str
            Such as ``"jury"``.
        *options : str
            As on the command line.
        timeout : float, optional
            Seconds.

        Examples
        --------
        >>> import jurist
        >>> print(jurist.Loop.drive().command("charpoly", "--keep", "T", "--format", "csv").splitlines()[0])
        polynomial,z_power,part,T_power,coefficient
        """
        asked = self._asked(timeout=timeout)
        return self._command([name, "-", *options], asked)[0]

    def intervals(
        self,
        parameter: str,
        values: Mapping[str, Exact] | None = None,
        *,
        domain: Bounds | Mapping[str, Bounds] | None = None,
        radius: Exact | None = None,
        decay: Exact | None = None,
        timeout: float | None = None,
        progress: Listener | bool = False,
        digits: int = 12,
    ) -> StableSet:
        """The exact stable set of a parameter.

        Parameters
        ----------
        parameter : str
            A parameter, a constant given as a number, ``"radius"`` or ``"decay"``.
        values : mapping, optional
            Of other parameters and constants; the rest is nominal.
        domain : pair of exact numbers or None, or mapping from names to pairs
            Replaces the open domain of the parameter.
        radius, decay : exact number, optional
            Asks for all ``|z| < radius`` (discrete time), or all ``Re s < -decay`` (continuous time).
        timeout : float, optional
            Seconds.
        progress : callable or bool
            Told the name of each step and the share done; `True` prints them to standard error.
        digits : int
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
        >>> jurist.Loop.drive().intervals("T", {"K_pwm": 200})
        <StableSet T: (0, 0.000274533891101)>
        """
        asked = self._asked(
            values, parameter=parameter, domain=domain, radius=radius, decay=decay, timeout=timeout, progress=progress, digits=digits
        )
        answer, text, remarks = self._core.intervals(asked, parameter)
        warn(remarks)
        import json

        kept = {**asked, "timeout": None, "progress": None}
        return StableSet(json.loads(text), text=text, loop=self, asked=kept, answer=answer)

    def verdict(self, values: Mapping[str, Exact] | None = None, **question: Unpack[Asking]) -> PointVerdict:
        """Whether the loop is stable at a point, with the exact number of roots in each place.

        Examples
        --------
        >>> import jurist
        >>> jurist.Loop.drive().verdict({"K_pwm": 551})
        <PointVerdict unstable: 4 inside, 2 outside>
        """
        asked = self._asked(values, **question)
        _, text, remarks = self._core.verdict(asked)
        warn(remarks)
        return PointVerdict(text, self, tuple(self._words("verdict", asked)))

    def analyze(self, values: Mapping[str, Exact] | None = None, **question: Unpack[Asking]) -> Analysis:
        """The verdict at the nominal point, and the stable set of each parameter, the others nominal."""
        asked = self._asked(values, **question)
        words = self._words("analyze", asked)
        text, _, _ = self._command([*words, "--json", "--digits", str(asked["digits"])], asked)
        return Analysis(text, self, tuple(words))

    def charpoly(
        self, keep: Iterable[str] = (), values: Mapping[str, Exact] | None = None, **question: Unpack[Asking]
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
        return Polynomial(text, self, done)

    def jury(
        self, parameter: str | None = None, values: Mapping[str, Exact] | None = None, **question: Unpack[Asking]
    ) -> Table:
        """The Jury table (discrete time) or Routh table (continuous time); with a parameter, each condition solved for itself."""
        asked = self._asked(values, **question)
        words = self._words("jury", asked) + ([] if parameter is None else ["--param", parameter])
        text, _, _ = self._command([*words, "--json", "--digits", str(asked["digits"])], asked)
        return Table(text, self, tuple(words))

    def map(
        self,
        x: str,
        y: str,
        values: Mapping[str, Exact] | None = None,
        *,
        method: Literal["exact", "boxes", "auto"] = "auto",
        window: Mapping[str, Bounds] | None = None,
        undecided: Exact | None = None,
        **question: Unpack[Asking],
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
        """
        asked = self._asked(values, **question)
        words = self._words("map", asked)
        for option, name in (("-x", x), ("-y", y)):
            low, high = (window or {}).get(name, (None, None))
            bounds = ["" if b is None else text_of(b) for b in (low, high)]
            words += [option, name if bounds == ["", ""] else f"{name}={bounds[0]}..{bounds[1]}"]
        words += ["--method", method]
        if undecided is not None:
            words.append(f"--undecided={text_of(undecided)}")
        text, _, _ = self._command([*words, "--json", "--digits", str(asked["digits"])], asked)
        return Map(text, self, tuple(words))

    def locus(
        self,
        parameter: str,
        values: Mapping[str, Exact] | None = None,
        *,
        range: tuple[Exact, Exact] | None = None,
        log: bool = False,
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
        timeout : float, optional
        """
        asked = self._asked(values, timeout=timeout)
        words = [*self._words("locus", asked), "--param", parameter]
        if range is not None:
            words.append(f"--range={text_of(range[0])}..{text_of(range[1])}")
        text, done, _ = self._command([*words, *(["--log"] if log else []), "--json"], asked)
        return Locus(text, self, done)

    def simulate(
        self,
        values: Mapping[str, Exact] | None = None,
        *,
        inputs: Mapping[str, Exact | tuple[Exact, Exact]] | None = None,
        initial: Mapping[str, Exact] | None = None,
        duration: Exact | None = None,
        switched: bool = False,
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
        timeout : float, optional
        """
        asked = self._asked(values, timeout=timeout)
        words = self._words("simulate", asked)
        for name, value in (inputs or {}).items():
            at = f"@{text_of(value[1])}" if isinstance(value, tuple) else ""
            words += ["--input", f"{name}={text_of(value[0] if isinstance(value, tuple) else value)}{at}"]
        for name, value in (initial or {}).items():
            words += ["--initial", f"{name}={text_of(value)}"]
        words += [] if duration is None else [f"--duration={text_of(duration)}"]
        text, done, _ = self._command([*words, *(["--switched"] if switched else []), "--json"], asked)
        return Simulation(text, self, done)

    def to_control(self, input: str, output: str, values: Mapping[str, Exact] | None = None) -> Any:
        """The closed-loop transfer function from an input to an output, for python-control.

        Coefficients are rounded to floats; names and the sample time are kept.
        """
        from ._control import to_control

        return to_control(self, input, output, values)

    def sample_time(self, values: Mapping[str, Exact] | None = None) -> Fraction | None:
        """The sample time at a point; `None` in continuous time and where the model gives none."""
        text = self._core.sample_time(self._asked(values))
        return None if text is None else fraction(text)

    def canonical(self) -> str:
        """The content of the model file without its layout: what equality and hash go by."""
        if self._canonical is None:
            import json
            import tomllib

            text = self._core.text()
            try:
                content = tomllib.loads(text, parse_float=number_text)
                self._canonical = json.dumps(plain(content), sort_keys=True, ensure_ascii=False)
            except (tomllib.TOMLDecodeError, ValueError):
                self._canonical = text
        return self._canonical

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Loop) and self.canonical() == other.canonical()

    def __hash__(self) -> int:
        return hash(self.canonical())

    def __repr__(self) -> str:
        if self._said is not None:
            return self._said
        text = self._core.text()
        if len(text) <= 100:
            return f"Loop.from_toml({text!r})"
        return f"<Loop {self.title or self.name}: {self.time}, parameters {', '.join(self.parameters) or 'none'}>"

    def __str__(self) -> str:
        return self.to_toml()

    def _repr_html_(self) -> str:
        from ._html import escaped, table

        rows = [[p.name, *("" if x is None else x for x in (p.nominal, p.min, p.max, p.unit, p.description))] for p in self.parameters.values()]
        head = ["parameter", "nominal", "above", "below", "unit", ""]
        return f"<div><b>{escaped(self.title or self.name)}</b>, {self.time}{table(head, rows)}</div>"

    def __reduce__(self) -> tuple[Any, ...]:
        return _loop_again, (self._core.text(), self._core.name(), self._said, _jurist.__version__)


def _loop_again(text: str, name: str, said: str | None, version: str) -> Loop:
    if name == "<built-in drive>":
        return Loop.drive()
    with warnings.catch_warnings():
        # They were shown where the loop was made.
        warnings.simplefilter("ignore", JuristWarning)
        return Loop._read(name, text.encode(), said)
