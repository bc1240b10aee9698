"""Loops and the questions about them."""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterable, Mapping
from typing import Any, Literal

from . import _jurist
from ._errors import JuristWarning
from ._exact import Exact, Floats, fraction, text_of
from ._question import Parameter, number_text, plain, warn
from ._responses import ResponseQuestions
from ._stability import StabilityQuestions


class Loop(StabilityQuestions, ResponseQuestions):
    """A control loop, and the questions about it. It is never changed.

    Loops are read (`from_line`, `from_file`, `from_toml`), built (`LoopBuilder`, `characteristic`), or taken from other libraries
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

    __slots__ = ()

    def __init__(self) -> None:
        raise TypeError("use Loop.from_line, Loop.from_file, Loop.from_toml, Loop.characteristic, LoopBuilder, from_control or from_sympy")

    @classmethod
    def _read(cls, name: str, content: bytes, said: str | None = None, folder: str | None = None) -> Loop:
        core, remarks = _jurist.Model.read(name, content, folder)
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
    def from_line(cls, line: str, *, hold: Exact | None = None, delay: Exact | None = None) -> Loop:
        """A loop in one line.

        Parameters
        ----------
        line : str
            The transfer function of an open loop, which is closed with unity negative feedback, or a characteristic polynomial. Every
            name is a parameter without a value; products need no operator.
        hold : exact number or expression, optional
            The sample time of a zero-order hold in front of the plant.
        delay : exact number or expression, optional
            Dead time of the plant, in units of time.

        Raises
        ------
        ModelError
            Where the line is no loop, or can be read in two ways.

        Examples
        --------
        >>> import jurist
        >>> jurist.Loop.from_line("K*10/(s*(s+1)*(s+2))").intervals("K")
        <StableSet K: (0, 0.6)>
        >>> jurist.Loop.from_line("K/(s(s+1))", hold=1).intervals("K")
        <StableSet K: (0, 2.39221119118)>
        >>> jurist.Loop.from_line("z^2 + z + 1/2").verdict()
        <PointVerdict stable: 2 inside>
        """
        times = {name: None if time is None else time if isinstance(time, str) else text_of(time) for name, time in (("hold", hold), ("delay", delay))}
        core, remarks = _jurist.Model.from_line(line, **times)
        warn(remarks)
        words = "".join(f", {name}={time!r}" for name, time in times.items() if time is not None)
        return cls._of(core, f"Loop.from_line({line!r}{words})")

    @classmethod
    def from_file(cls, path: str | os.PathLike[str]) -> Loop:
        """Reads a model file, with the numbers that it takes from files below its folder (``from = "params.h#PID_KP"``)."""
        name = os.fspath(path)
        with open(path, "rb") as file:
            return cls._read(name, file.read(), f"Loop.from_file({name!r})", os.path.dirname(name) or ".")

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
        for name, *numbers, unit, description, formula, closed in self._core.parameters():
            nominal, least, most = (None if text is None else fraction(text) for text in numbers)
            out[name] = Parameter(name, nominal, least, most, unit, description, formula, closed)
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
        head = ["parameter", "nominal", "from", "to", "unit", ""]
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
