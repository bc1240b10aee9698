"""To and from python-control."""

from __future__ import annotations

import math
import re
from fractions import Fraction
from typing import TYPE_CHECKING, Any, Literal, Unpack

from ._builder import LoopBuilder
from ._exact import Exact, Floats, exact, fraction, warn_computed
from ._methods import Method
from ._question import Waiting

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from ._loop import Loop
    from ._margins import Margins


def _plain(polynomial: Any) -> list[Any]:
    return list(polynomial.tolist() if hasattr(polynomial, "tolist") else polynomial)


def siso_coefficients(system: Any) -> tuple[list[Any], list[Any]]:
    """Numerator and denominator, highest power first, of one input and one output."""
    num, den = system.num, system.den
    if callable(num) or not hasattr(num, "__len__"):
        # SymPy's transfer functions name their variable.
        import sympy

        parts = [sympy.Poly(side, system.var).all_coeffs() for side in (system.num, system.den)]
        return parts[0], parts[1]
    rows, columns = getattr(system, "noutputs", 1), getattr(system, "ninputs", 1)
    if (rows, columns) != (1, 1):
        raise ValueError(f"a transfer function with {columns} inputs and {rows} outputs: connect its parts by LoopBuilder")
    nested = hasattr(num[0], "__len__")
    if nested:
        num, den = num[0][0], den[0][0]
    return _plain(num), _plain(den)


def _time(system: Any, time: str | None) -> tuple[str, Any]:
    """The kind of time, and the sample time if it is a number."""
    if not all(hasattr(system, part) for part in ("num", "den")) and not all(hasattr(system, part) for part in "ABCD"):
        raise TypeError(f"{type(system).__name__} has no coefficients: give a transfer function or a system in state space")
    dt = getattr(system, "dt", 0)
    if dt is None:
        # SciPy's continuous systems have no sample time; python-control's None says that nobody knows.
        if time is None and not type(system).__module__.startswith("scipy."):
            raise ValueError("the system's time is unspecified (dt is None): say time='continuous' or time='discrete'")
        return time or "continuous", None
    if dt is True:
        return "discrete", None
    return ("continuous", None) if dt == 0 else ("discrete", dt)


def _signal(labels: Any, otherwise: str) -> str:
    """A signal's name, if it is one that a model file takes."""
    label = re.sub(r"\[0\]$", "", str(labels[0])) if labels else otherwise
    return label if re.fullmatch(r"[A-Za-z_]\w*", label) and label not in ("z", "s") else otherwise


def from_control(
    sys: Any,
    *,
    gain: str | None = None,
    floats: Floats = "shortest",
    time: Literal["continuous", "discrete"] | None = None,
    hold: Exact | None = None,
    method: Method = "zoh",
    delay: Exact | None = None,
) -> Loop:
    """A loop from a system of python-control or SciPy.

    Parameters
    ----------
    sys : TransferFunction or StateSpace, or a list of them
        With ``gain``, the open loop ``L``, not one that is closed already: negative feedback is closed around ``gain * L``, one input and one output. Without,
        the system itself: its own poles are asked about. State-space matrices are taken as they are. A list is the open loop's parts from the error to the
        output, with sample times of their own: a slower one runs at each so many samples and holds its output.
    gain : str, optional
        The name of the gain; a parameter with the nominal value 1 and values above 0.
    floats : {"shortest", "binary", "refuse"}
        What floats mean; see `exact`.
    time : {"continuous", "discrete"}, optional
        For systems whose time is unspecified (``dt`` is `None`).
    hold : exact number or expression, optional
        The sample time of a digital controller in front of a continuous plant: the loop is discrete, and exact at the samples.
    method : {"zoh", "foh", "tustin", "forward", "backward"}
        What is between the samples, with ``hold``: a constant input, a straight one, or a rule.
    delay : exact number or expression, optional
        Dead time of the plant's input: in units of time behind a hold and in continuous time, in samples in discrete time.

    Returns
    -------
    Loop

    Warns
    -----
    JuristWarning
        ``W-computed-floats``, where coefficients have so many digits that they look computed.

    Examples
    --------
    >>> import control, jurist
    >>> jurist.from_control(control.tf([1], [1, 2, 3, 0]), gain="k").intervals("k")
    <StableSet k: (0, 6)>
    >>> lag = control.tf([1], [1, 1])
    >>> jurist.from_control(lag, gain="k", delay=1).intervals("k")
    <StableSet k: (0, 2.26182633411)>
    >>> jurist.from_control(lag, gain="k", hold="1/2").intervals("k")
    <StableSet k: (0, 4.08298816507)>
    >>> slow = control.tf([1], [1, -1], 0.2)
    >>> jurist.from_control([slow, lag], gain="k", hold="1/10").intervals("k")
    <StableSet k: (0, 1)>
    """
    if isinstance(sys, (list, tuple)):
        return _in_series(sys, gain, floats, hold, method, delay)
    kind, dt = _time(sys, time)
    held: dict[str, Any] = {}
    if hold is not None:
        if kind != "continuous":
            raise ValueError("a hold stands in front of a continuous plant, and this one is discrete")
        kind, dt = "discrete", hold
        held = {"discretize": {"method": method, **({} if delay is None else {"delay": delay})}}
    if gain is None and (held or delay is not None):
        raise ValueError("name the gain around which the loop with a hold or dead time is closed")
    name = str(getattr(sys, "name", "") or "")
    title = None if re.fullmatch(r"(sys\[\d+\].*)?", name) else name
    builder = LoopBuilder(kind, sample_time=dt, title=title, floats=floats)
    is_state_space = all(hasattr(sys, part) for part in "ABCD")
    if gain is None:
        if is_state_space:
            if not len(sys.A):
                return builder.characteristic("1").build()
            return builder.matrix(sys.A).build()
        _, den = siso_coefficients(sys)
        warn_computed(den)
        variable = "z" if kind == "discrete" else "s"
        terms = [f"({builder._expression(c)})*{variable}^{len(den) - 1 - k}" for k, c in enumerate(den)]
        return builder.characteristic(" + ".join(terms)).build()
    if is_state_space and (getattr(sys, "ninputs", 1), getattr(sys, "noutputs", 1)) != (1, 1):
        raise ValueError("a gain is closed around one input and one output: connect the parts by LoopBuilder")
    builder.parameter(gain, 1, min=0)
    taken = {gain, "z", "s"}
    names = []
    for labels, otherwise in ((getattr(sys, "input_labels", None), "u"), (getattr(sys, "output_labels", None), "y")):
        label = _signal(labels, otherwise)
        while label in taken:
            label += "_"
        taken.add(label)
        names.append(label)
    u, y = names
    reference = next(r for r in ("r", "r_ref", "reference", "r_0") if r not in taken)
    builder.block("gain", f"{reference} - {y}", u, gain)
    if delay is not None and not held:
        late = next(name for name in (f"{u}_late", f"{u}_late_") if name not in taken)
        builder.block("dead time", u, late, delay=delay)
        u = late
    builder.block("plant", u, y, sys, **held)
    return builder.build(inputs=[reference], outputs=[y])


def _in_series(
    systems: Sequence[Any], gain: str | None, floats: Floats, hold: Exact | None, method: Method, delay: Exact | None
) -> Loop:
    """A loop around systems in series, each at its own rate; one of them may be a continuous plant."""
    if gain is None or not systems:
        raise ValueError("a list is the parts of an open loop: name the gain around which it is closed")
    kinds = [_time(system, None) for system in systems]
    continuous = sum(kind == "continuous" for kind, _ in kinds)
    if continuous > 1:
        raise ValueError("two parts are continuous: what stands between two samplers is one plant, so multiply them")
    if continuous and hold is None:
        raise ValueError("a part is continuous: give 'hold', the sample time of the hold in front of it")
    times = [exact(dt, floats) for kind, dt in kinds if kind == "discrete" and dt is not None]
    if hold is not None:
        period = exact(hold, floats)
    elif times:
        period = Fraction(math.gcd(*(t.numerator for t in times)), math.lcm(*(t.denominator for t in times)))
    else:
        raise ValueError("no part says its sample time as a number")
    builder = LoopBuilder("discrete", sample_time=period, floats=floats)
    builder.parameter(gain, 1, min=0)
    builder.block("gain", "u_ref - u_last", "u_0", gain)
    for k, (system, (kind, _)) in enumerate(zip(systems, kinds, strict=True)):
        held: dict[str, Any] = {}
        if kind == "continuous":
            held = {"discretize": {"method": method, **({} if delay is None else {"delay": delay})}}
        output = "u_last" if k + 1 == len(systems) else f"u_{k + 1}"
        builder.block(f"part {k + 1}", f"u_{k}", output, system, **held)
    return builder.build(inputs=["u_ref"], outputs=["u_last"])


def margins(
    sys: Any,
    at: str | None = None,
    values: Mapping[str, Exact] | None = None,
    *,
    floats: Floats = "shortest",
    time: Literal["continuous", "discrete"] | None = None,
    **question: Unpack[Waiting],
) -> Margins:
    """The exact margins of an open loop, beside ``control.stability_margins``.

    Parameters
    ----------
    sys : TransferFunction, StateSpace, or Loop
        The open loop ``L``, closed by negative feedback; or a loop, cut at a signal.
    at : str, optional
        Where a `Loop` is cut; see `Loop.margins`.
    values : mapping, optional
        Of a loop's parameters.
    floats, time
        As for `from_control`.
    **question
        ``timeout``, ``progress``, ``digits``.

    Returns
    -------
    Margins

    Examples
    --------
    >>> import control, jurist
    >>> m = jurist.margins(control.tf([1], [1, 3, 3, 1]))
    >>> m.as_control()[0], float(control.stability_margins(control.tf([1], [1, 3, 3, 1]))[0])
    (8.0, 8.00000000...)
    """
    from ._loop import Loop

    if isinstance(sys, Loop):
        return sys.margins(at, values, **question)
    return from_control(sys, gain="k", floats=floats, time=time).margins("k", values, **question)


def to_control(loop: Loop, input: str, output: str, values: Mapping[str, Exact] | None = None) -> Any:
    """See `Loop.to_control`."""
    import json

    import control

    asked = loop._asked(values)
    set_already = {name for name, _ in asked["values"]}
    for name, parameter in loop.parameters.items():
        if name not in set_already:
            if parameter.nominal is None:
                raise ValueError(f"'{name}' has no nominal value: give it one")
            asked["values"].append((name, f"{parameter.nominal}"))
    words = [*loop._words("charpoly", asked), "--transfer", input, output, "--json"]
    document = json.loads(loop._command(words, asked)[0])
    def number(terms: list[Any]) -> Fraction:
        return sum((fraction(c) for _, c in terms), Fraction(0))

    def numbers(side: list[dict[str, Any]]) -> list[float]:
        out = [float(number(c["numerator"]) / number(c["denominator"])) for c in reversed(side)]
        while len(out) > 1 and out[0] == 0:
            out.pop(0)
        return out

    num, den = (numbers(document[side]) for side in ("numerator", "denominator"))
    if loop.time == "continuous":
        dt: Any = 0
    else:
        period = loop.sample_time(values)
        dt = True if period is None else float(period)
    return control.TransferFunction(num, den, dt, inputs=[input], outputs=[output])
