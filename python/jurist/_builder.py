"""Loops built in Python: the builder writes the model file that says the same."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping, Sequence
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from ._exact import Exact, Floats, exact, text_of, warn_computed

if TYPE_CHECKING:
    from ._loop import Loop


def quoted(text: str) -> str:
    """A TOML string; also right as a key."""
    # JSON's escapes are TOML's, but for the control characters above them.
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007F")


def array(items: Iterable[str]) -> str:
    """A TOML array of strings."""
    return f"[{', '.join(quoted(i) for i in items)}]"


def matrix(rows: Iterable[Iterable[str]]) -> str:
    """A TOML matrix."""
    return f"[{', '.join(array(row) for row in rows)}]"


def _number(x: Any, floats: Floats) -> Fraction | None:
    """The value of a number, or of a text that is one; `None` of an expression."""
    if x is None or hasattr(x, "free_symbols"):
        return None
    try:
        return exact(x, floats)
    except ValueError:
        return None


class LoopBuilder:
    """A loop in the making: parameters and constants, blocks wired by signal names.

    Blocks take expressions, numbers, transfer functions and state spaces of python-control or SciPy, and SymPy expressions.

    Parameters
    ----------
    time : {"discrete", "continuous"}
    sample_time : exact number or expression, optional
        Turns angles into hertz.
    title : str, optional
    floats : {"shortest", "binary", "refuse"}
        What floats mean; see `exact`.

    Examples
    --------
    >>> import jurist
    >>> b = jurist.LoopBuilder("continuous")
    >>> K = b.parameter("K", 1, min=0)
    >>> b = b.block("controller", "r - y", "u", f"{K}*(s + 1)/s").block("plant", "u", "y", "1/(s^3 + 2*s^2 + 3*s + 4)")
    >>> b.build(inputs=["r"], outputs=["y"]).intervals("K")
    <StableSet K: (0, 1.12310562562)>
    """

    def __init__(
        self, time: str, *, sample_time: Exact | None = None, title: str | None = None, floats: Floats = "shortest"
    ) -> None:
        if time not in ("discrete", "continuous"):
            raise ValueError(f"time is 'discrete' or 'continuous', not {time!r}")
        self.time = time
        self.floats = floats
        self._title = title
        self._sample_time = None if sample_time is None else self._expression(sample_time)
        self._period = _number(sample_time, floats)
        self._constants: list[str] = []
        self._parameters: list[str] = []
        self._form: list[str] = []
        self._blocks: list[str] = []

    def _expression(self, x: Any) -> str:
        """A text as it is, a number by the rule for floats, a SymPy expression in the program's notation."""
        if isinstance(x, str):
            return x
        if hasattr(x, "free_symbols"):
            from ._sympy import expression

            return expression(x, self.floats)
        return text_of(x, self.floats)

    def parameter(
        self,
        name: str,
        nominal: Exact | None = None,
        *,
        min: Exact | None = None,
        max: Exact | None = None,
        closed: bool = False,
        unit: str | None = None,
        description: str | None = None,
    ) -> str:
        """Adds a parameter; gives its name, for use in expressions. The nominal value may be a formula in constants and other parameters; the domain is
        open unless it is `closed`.
        """
        parts = [] if nominal is None else [f"nominal = {quoted(self._expression(nominal))}"]
        keys = {"min": min, "max": max}
        parts += [f"{key} = {quoted(text_of(value, self.floats))}" for key, value in keys.items() if value is not None]
        parts += ["closed = true"] if closed else []
        parts += [f"{k} = {quoted(v)}" for k, v in {"unit": unit, "description": description}.items() if v]
        self._parameters.append(f"{quoted(name)} = {{ {', '.join(parts)} }}")
        return name

    def constant(self, name: str, value: Exact) -> str:
        """Adds a constant, a number or an expression; gives its name."""
        self._constants.append(f"{quoted(name)} = {quoted(self._expression(value))}")
        return name

    def characteristic(self, expression: Any) -> LoopBuilder:
        """The characteristic polynomial as it is."""
        self._form.append(f"characteristic = {quoted(self._expression(expression))}")
        return self

    def matrix(self, rows: Sequence[Sequence[Any]]) -> LoopBuilder:
        """The closed-loop matrix."""
        self._form.append(f"matrix = {matrix(self._rows(rows))}")
        return self

    def feedback(self, A: Any, B: Any, C: Any, K: Any) -> LoopBuilder:
        """``u = -K y``, ``y = C x``: the closed loop is ``A - B K C``."""
        for name, rows in {"A": A, "B": B, "C": C, "K": K}.items():
            self._form.append(f"{name} = {matrix(self._rows(rows))}")
        return self

    def _rows(self, rows: Any) -> list[list[str]]:
        plain = rows.tolist() if hasattr(rows, "tolist") else rows
        warn_computed([x for row in plain for x in row], stacklevel=5)
        return [[self._expression(x) for x in row] for row in plain]

    def block(
        self, name: str, input: str | Sequence[str], output: str | Sequence[str], system: Any = None, **keys: Any
    ) -> LoopBuilder:
        """Adds a block.

        Parameters
        ----------
        name : str
        input : str or list of str
            Linear expressions in signals.
        output : str or list of str
            The signals that it drives.
        system : str, number, or a system of python-control, SciPy or SymPy
            A transfer expression in ``z`` or ``s``, a gain, a transfer function, a state space. One that has a sample time runs at each so many
            samples of the loop and holds its outputs in between.
        **keys
            Keys of the model file instead: ``gain``, ``delay``, ``num``, ``den``, ``A`` to ``D``, ``discretize``; beside a system ``every`` and ``phase``
            for a block that runs at each so many samples.

        Raises
        ------
        ValueError
            Where the system's sample time is no whole multiple of the loop's.
        """
        inputs = [input] if isinstance(input, str) else list(input)
        outputs = [output] if isinstance(output, str) else list(output)
        lines = ["", "[[block]]", f"name = {quoted(name)}", f"input = {array(inputs)}", f"output = {array(outputs)}"]
        if system is not None:
            keys = {**self._system(system, outputs), **self._rate(name, system, keys), **keys}
        for key, value in keys.items():
            lines.append(f"{key} = {self._value(value)}")
        self._blocks.append("\n".join(lines))
        return self

    def _rate(self, name: str, system: Any, keys: Mapping[str, Any]) -> dict[str, Any]:
        """How many samples of the loop are one of the system's."""
        dt = getattr(system, "dt", None)
        own = None if dt is None or isinstance(dt, (bool, str)) or not dt else exact(dt, self.floats)
        if self.time != "discrete" or own is None or self._period is None or {"every", "sample_time", "discretize"} & keys.keys():
            return {}
        samples = own / self._period
        if samples.denominator != 1:
            raise ValueError(
                f"the sample time {own} of '{name}' is no whole multiple of the loop's, {self._period}: give the loop the greatest common divisor of all"
            )
        return {} if samples == 1 else {"every": int(samples)}

    def _system(self, system: Any, outputs: list[str]) -> dict[str, Any]:
        if isinstance(system, str):
            return {"transfer": system}
        if all(hasattr(system, name) for name in "ABCD"):
            parts = {name: self._rows(getattr(system, name)) for name in "ABCD"}
            if not parts["A"]:
                return {"D": parts["D"]}
            return parts
        if hasattr(system, "num") and hasattr(system, "den"):
            from ._control import siso_coefficients

            num, den = siso_coefficients(system)
            warn_computed([*num, *den], stacklevel=5)
            return {"num": [self._expression(c) for c in num], "den": [self._expression(c) for c in den]}
        if hasattr(system, "free_symbols"):
            return {"transfer": self._expression(system)}
        return {"gain": self._expression(system)}

    def _value(self, value: Any) -> str:
        if isinstance(value, str):
            return quoted(value)
        if isinstance(value, Mapping):
            return f"{{ {', '.join(f'{k} = {self._value(v)}' for k, v in value.items())} }}"
        if isinstance(value, bool):
            return "true" if value else "false"
        if isinstance(value, int):
            return str(value)
        if hasattr(value, "tolist"):
            value = value.tolist()
        if isinstance(value, (list, tuple)):
            return f"[{', '.join(self._value(v) for v in value)}]"
        return quoted(self._expression(value))

    def to_toml(self, *, inputs: Sequence[str] = (), outputs: Sequence[str] = ()) -> str:
        """The model file that says the same."""
        lines = [f"title = {quoted(self._title)}"] if self._title else []
        lines.append(f"time = {quoted(self.time)}")
        if self._sample_time is not None:
            lines.append(f"sample_time = {quoted(self._sample_time)}")
        for header, body in (("constants", self._constants), ("parameters", self._parameters)):
            if body:
                lines += ["", f"[{header}]", *body]
        lines += ["", "[loop]", *self._form]
        if inputs:
            lines.append(f"inputs = {array(inputs)}")
        if outputs:
            lines.append(f"outputs = {array(outputs)}")
        return "\n".join([*lines, *self._blocks]) + "\n"

    def build(self, *, inputs: Sequence[str] = (), outputs: Sequence[str] = ()) -> Loop:
        """The loop.

        Raises
        ------
        ModelError
            Pointing into the text of `to_toml`.
        """
        from ._loop import Loop

        return Loop.from_toml(self.to_toml(inputs=inputs, outputs=outputs), name="<built loop>")
